/**
 * @file record_request.h
 * The requests of a recording (recorder.h), as the thread sees them. A recording ends with its connection.
 */
#ifndef CM1E_CONTROL_RECORD_REQUEST_H
#define CM1E_CONTROL_RECORD_REQUEST_H

#include "control/recorder.h"
#include "control/request.h"

/** They return the reply. */
json_t *cm1e_record_begin(control_request_t *request, control_run_t *run, const json_t *message);
json_t *cm1e_record_samples(control_request_t *request, control_run_t *run, const json_t *message);

#endif
