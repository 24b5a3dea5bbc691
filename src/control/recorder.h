/**
 * @file recorder.h
 * A recording of all signals for one client: the cycle writes samples into a ring, the thread reads them. A sample for
 * which there is no room is counted, and the recording goes on behind the gap. The thread makes it and frees it;
 * between these the cycle has it, until it says that it has let go.
 */
#ifndef CM1E_CONTROL_RECORDER_H
#define CM1E_CONTROL_RECORDER_H

#include <jansson.h>
#include <stdatomic.h>

#include "control/view.h"
#include "scheduler/trace_recorder.h"

typedef struct recorder {
    trace_t trace;             /**< of one sample */
    const trace_timing_t *timing;
    uint32_t every, until_next;
    uint32_t words, room;      /**< of a sample: its time and its values; of the ring: samples */
    uint64_t *ring;            /**< [room][words + 1]: time in ns, then doubles, then how many were lost before it */
    _Atomic uint64_t written, read, lost; /**< samples */
    uint64_t told;             /**< lost, as told to the client */
    atomic_bool ending, ended;
} recorder_t;

/** The columns are complete with this; `trace` has been made by the caller. CM1E_ERROR_NO_MEMORY. @rt init */
cm1e_error_t cm1e_recorder_init(recorder_t *recorder, const cm1e_scheduler_t *scheduler, uint32_t every,
                                int64_t cycle_ns, cm1e_diag_t *diag);
void cm1e_recorder_free(recorder_t *recorder);
/** Gives it to the cycle, as that of this client. */
void cm1e_recorder_begin(view_t *view, uint32_t client, recorder_t *recorder);
/** Takes it back and frees it. false: the cycle has it still; call again. `stopped`: the cycle does not run any
 *  more. */
bool cm1e_recorder_end(view_t *view, uint32_t client, bool stopped);
/** Every cycle. @rt cycle */
void cm1e_recorder_cycle(view_t *view);

/** What is recorded: {"cycle_ns", "every", "axes", "columns"}, all of it; NULL: no memory. */
json_t *cm1e_recorder_show(const recorder_t *recorder, int64_t cycle_ns);
/** The samples since the last call, at most as many as fit into a reply, and none behind a gap: {"samples", "lost",
 *  "data"}. `lost` are those of the time up to the end of these samples, so a gap is where it grows. */
json_t *cm1e_recorder_take(recorder_t *recorder);

#endif
