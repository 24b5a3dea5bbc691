/**
 * @file guest_api.h
 * Marks what libcm1e.so exports for the shared libraries of guests (libcm1e_sim.so ...), beside what is public:
 * functions that share a state with the rest of the library. It is no interface for programs and changes without
 * notice.
 */
#ifndef CM1E_CORE_GUEST_API_H
#define CM1E_CORE_GUEST_API_H

#include "cm1e/api.h"

#define CM1E_GUEST_API CM1E_API

#endif
