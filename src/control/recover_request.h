/**
 * @file recover_request.h
 * A client asks for a slave that waits (`recover: ask` of the bus file).
 */
#ifndef CM1E_CONTROL_RECOVER_REQUEST_H
#define CM1E_CONTROL_RECOVER_REQUEST_H

#include "control/request.h"

/** Allows the bus to bring back the slave that "slave" names: its position, its name, or that of an axis. The reply has
 *  its position. The run lets clients do that; the caller has checked it. */
json_t *cm1e_recover_slave(control_request_t *request, control_run_t *run, const json_t *message);

#endif
