/**
 * @file file_request.h
 * The requests that transfer a file of a slave (FoE): its bytes come and go in pieces, the transfer goes on in the
 * cycle, and the client looks how far it is. One file for each connection.
 */
#ifndef CM1E_CONTROL_FILE_REQUEST_H
#define CM1E_CONTROL_FILE_REQUEST_H

#include "bus/foe_job.h"
#include "control/request.h"

enum { CM1E_FILE_MAX = 1 << 26, CM1E_FILE_PIECE = 1 << 14, CM1E_FILE_NAME = 256 };

/** Each returns the reply; NULL: the cycle decides. */
json_t *cm1e_file_data(control_request_t *request, control_run_t *run, const json_t *message);
json_t *cm1e_file_begin(control_request_t *request, control_run_t *run, const json_t *message);
json_t *cm1e_file_look(control_request_t *request, control_run_t *run, const json_t *message);
/** What the cycle has decided about a file that is written, unless an axis is commanded. */
json_t *cm1e_file_decided(const control_request_t *request);
/** Ends the transfer of a client that is gone, and frees what belongs to it; false: not yet, the cycle has it. */
bool cm1e_file_leave(control_run_t *run, uint32_t client);

#endif
