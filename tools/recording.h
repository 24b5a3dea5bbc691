/**
 * @file recording.h
 * A recording of the signals of a running program, which comes through its control socket and becomes the same trace as
 * that of a scheduler.
 */
#ifndef CM1E_TOOLS_RECORDING_H
#define CM1E_TOOLS_RECORDING_H

#include <jansson.h>

#include "cm1e/control.h"
#include "scheduler/trace_recorder.h"

typedef struct recording {
    trace_t trace;
    json_t *told;            /**< what the program records: names are its texts */
    int64_t first_ns, last_ns; /**< of the program's run */
    uint64_t samples, lost;  /**< taken, and lost for want of room */
    double seconds;          /**< to record; 0: until it is ended */
    double before_s;         /**< of the trigger */
    uint32_t kept;           /**< samples to keep without `seconds`; 0: many */
    bool full;               /**< the trigger has ended it, or the time is over */
} recording_t;

/** Begins; `trigger->samples_before` follows from `before_s`. `paths` names the variables; NULL: those that
 *  the program chose. Takes the references to `objects` and `paths`. false: `diag` says why. */
bool recording_begin(recording_t *recording, cm1e_control_t *control, uint32_t every, json_t *objects, json_t *paths,
                     const cm1e_trace_trigger_t *trigger, cm1e_diag_t *diag);
/** Takes what has come since. false: the program has ended, or does not answer: `diag` says why. */
bool recording_take(recording_t *recording, cm1e_control_t *control, cm1e_diag_t *diag);
void recording_free(recording_t *recording);

#endif
