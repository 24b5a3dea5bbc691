/**
 * @file client.h
 * The other end of a control socket: finds the program that runs a network, connects, asks.
 */
#ifndef CM1E_CONTROL_CLIENT_H
#define CM1E_CONTROL_CLIENT_H

#include <jansson.h>

#include "cm1e/control.h"

/** Asks and waits; takes the reference to `request`. `*reply` is the caller's; it is NULL if none came, and set where
 *  the program refuses: then its error is returned, with its foreign code and text in `diag`. */
cm1e_error_t cm1e_control_call(cm1e_control_t *control, json_t *request, json_t **reply, cm1e_diag_t *diag);

#endif
