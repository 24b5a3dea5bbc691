/**
 * @file serve_lock.h
 * Who serves a simulated segment on a network interface: one process at a time. Two would answer every frame twice.
 */
#ifndef CM1E_SIM_SERVE_LOCK_H
#define CM1E_SIM_SERVE_LOCK_H

#include "cm1e/error.h"

/** CM1E_ERROR_STATE: somebody has it. The lock ends with the process, or with close(*lock). */
cm1e_error_t cm1e_serve_lock_take(int *lock, const char *interface_name, cm1e_diag_t *diag);

#endif
