/**
 * @file server.h
 * The control socket of a run: one thread, which is not real-time, serves all that are connected. Nothing that they
 * send or leave unread holds up the thread, and nothing that the thread does holds up the cycle.
 */
#ifndef CM1E_CONTROL_SERVER_H
#define CM1E_CONTROL_SERVER_H

#include "control/view.h"

typedef struct cm1e_control_server cm1e_control_server_t;

/** What cm1e_control_serve_own() has said. */
bool cm1e_control_serves_own(void);

/** Makes the socket and starts the thread; `path` is where others connect. @rt init */
cm1e_error_t cm1e_control_server_start(cm1e_control_server_t **server, cm1e_scheduler_t *scheduler, uint32_t bus,
                                       char *path, size_t path_size, cm1e_diag_t *diag);
view_t *cm1e_control_server_view(cm1e_control_server_t *server);
/** Ends the thread, after the stop of the bus has ended all transfers, and removes the socket. @rt init */
void cm1e_control_server_stop(cm1e_control_server_t *server);

#endif
