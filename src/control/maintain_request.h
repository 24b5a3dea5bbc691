/**
 * @file maintain_request.h
 * The requests that move, enable or reset an axis (maintain.h), as the thread sees them.
 */
#ifndef CM1E_CONTROL_MAINTAIN_REQUEST_H
#define CM1E_CONTROL_MAINTAIN_REQUEST_H

#include "control/request.h"

/** Takes the members of the message of a request that has its name already; NULL: the order is complete, and waits for
 *  the cycle. Else the sentence that says what is wrong with it. */
const char *cm1e_maintain_take(control_request_t *request, const control_run_t *run, const json_t *message);
/** The reply to an order that is decided. */
json_t *cm1e_maintain_reply(control_request_t *request, control_run_t *run);

#endif
