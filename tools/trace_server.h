/**
 * @file trace_server.h
 * Serves the page of a recording that goes on, to browsers on this machine: on 127.0.0.1 only, under an address with a
 * random token, without which nothing is told. A browser that is slow or gets stuck loses samples; nobody waits for it.
 */
#ifndef CM1E_TOOLS_TRACE_SERVER_H
#define CM1E_TOOLS_TRACE_SERVER_H

#include "recording.h"

typedef struct trace_server trace_server_t;

/** Serves the page of a recording that has begun; `port` 0: a free one. Its own thread answers the browsers. Errors:
 *  CM1E_ERROR_UNSUPPORTED: this build has no HTTP server, or no chart library; CM1E_ERROR_IO: the port is in use. */
cm1e_error_t trace_server_begin(trace_server_t **server, const recording_t *recording, uint16_t port,
                                cm1e_diag_t *diag);
/** The address of the page. */
const char *trace_server_url(const trace_server_t *server);
/** Shows the browsers what the recording has taken since the last call, at most about ten times a second. */
void trace_server_show(trace_server_t *server, const recording_t *recording);
/** Tells the browsers what is left and why there is no more, and ends. NULL is allowed. */
void trace_server_end(trace_server_t *server, const recording_t *recording, const char *why);

#endif
