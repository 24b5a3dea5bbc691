#include "control/recorder.h"

#include <stdlib.h>
#include <string.h>

#include "control/show.h"
#include "core/json_text.h"

enum { RING_BYTES = 1 << 24, LEAST_SAMPLES = 16, DATA_BYTES = 1 << 20, DIGITS = 16 /* of 8 bytes */ };
#define RING_NS INT64_C(4000000000)

/* ---- the ring --------------------------------------------------------------------------------------------------- */

static uint32_t stride(const recorder_t *recorder) { return recorder->words + 1; }

static uint64_t *sample_at(const recorder_t *recorder, uint64_t number)
{
    return recorder->ring + number % recorder->room * stride(recorder);
}

cm1e_error_t cm1e_recorder_init(recorder_t *recorder, const cm1e_scheduler_t *scheduler, uint32_t every,
                                int64_t cycle_ns, cm1e_diag_t *diag)
{
    recorder->timing = &cm1e_scheduler_trace(scheduler)->timing;
    recorder->every = every;
    recorder->words = recorder->trace.column_count + 1;
    const int64_t wanted = RING_NS / (cycle_ns * every), most = RING_BYTES / (int64_t)(stride(recorder) * 8);
    recorder->room = (uint32_t)(wanted < most ? wanted : most);
    if (recorder->room < LEAST_SAMPLES)
        recorder->room = LEAST_SAMPLES;
    const size_t bytes = (size_t)recorder->room * stride(recorder) * sizeof *recorder->ring;
    recorder->ring = malloc(bytes);
    if (!recorder->ring)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for a recording.");
    memset(recorder->ring, 0, bytes); /* so that the cycle does not wait for its pages */
    return cm1e_trace_begin(&recorder->trace, diag);
}

void cm1e_recorder_free(recorder_t *recorder)
{
    if (!recorder)
        return;
    cm1e_trace_free(&recorder->trace);
    free(recorder->ring);
    free(recorder);
}

void cm1e_recorder_begin(view_t *view, uint32_t client, recorder_t *recorder)
{
    view->recorders[client] = recorder;
    atomic_fetch_or_explicit(&view->recording, UINT32_C(1) << client, memory_order_release);
}

bool cm1e_recorder_end(view_t *view, uint32_t client, bool stopped)
{
    recorder_t *recorder = view->recorders[client];
    if (!recorder)
        return true;
    atomic_store_explicit(&recorder->ending, true, memory_order_release);
    if (!stopped && !atomic_load_explicit(&recorder->ended, memory_order_acquire))
        return false;
    atomic_fetch_and(&view->recording, ~(UINT32_C(1) << client));
    view->recorders[client] = NULL;
    cm1e_recorder_free(recorder);
    return true;
}

/* ---- the cycle -------------------------------------------------------------------------------------------------- */

static void record(recorder_t *recorder, const view_t *view)
{
    if (recorder->until_next > 0) {
        recorder->until_next--;
        return;
    }
    recorder->until_next = recorder->every - 1;
    const uint64_t written = atomic_load_explicit(&recorder->written, memory_order_relaxed);
    if (written - atomic_load_explicit(&recorder->read, memory_order_acquire) == recorder->room) {
        atomic_fetch_add_explicit(&recorder->lost, 1, memory_order_release);
        return;
    }
    const int64_t time_ns = cm1e_scheduler_time_ns(view->scheduler);
    uint64_t *sample = sample_at(recorder, written);
    recorder->trace.timing = *recorder->timing;
    cm1e_trace_record(&recorder->trace, view->axes, time_ns);
    sample[0] = (uint64_t)time_ns;
    memcpy(sample + 1, recorder->trace.values, recorder->trace.column_count * sizeof *recorder->trace.values);
    sample[recorder->words] = atomic_load_explicit(&recorder->lost, memory_order_relaxed);
    atomic_store_explicit(&recorder->written, written + 1, memory_order_release);
}

void cm1e_recorder_cycle(view_t *view)
{
    uint32_t recording = atomic_load_explicit(&view->recording, memory_order_acquire);
    for (uint32_t client = 0; recording; client++, recording >>= 1) {
        recorder_t *recorder = recording & 1 ? view->recorders[client] : NULL;
        if (!recorder)
            continue;
        if (!atomic_load_explicit(&recorder->ending, memory_order_acquire)) {
            record(recorder, view);
            continue;
        }
        atomic_fetch_and_explicit(&view->recording, ~(UINT32_C(1) << client), memory_order_relaxed);
        atomic_store_explicit(&recorder->ended, true, memory_order_release);
    }
}

/* ---- what is told ----------------------------------------------------------------------------------------------- */

/** NULL: no memory. */
static json_t *names_of(const trace_t *trace)
{
    json_t *axes = json_array();
    bool whole = axes;
    for (uint32_t i = 0; i < trace->axes && whole; i++)
        whole = json_array_append_new(axes, cm1e_json_text(trace->names[i])) == 0;
    if (!whole)
        json_decref(axes);
    return whole ? axes : NULL;
}

static json_t *columns_of(const trace_t *trace)
{
    json_t *columns = json_array();
    bool whole = columns;
    for (uint32_t i = 0; i < trace->column_count && whole; i++) {
        const trace_column_t *column = &trace->columns[i];
        whole = json_array_append_new(columns, json_pack("{s:o, s:o, s:i, s:i}", "name", cm1e_json_text(column->name),
                                                         "unit", cm1e_json_text(column->unit), "kind",
                                                         (int)column->kind, "type", (int)column->type)) == 0;
    }
    if (!whole)
        json_decref(columns);
    return whole ? columns : NULL;
}

json_t *cm1e_recorder_show(const recorder_t *recorder, int64_t cycle_ns)
{
    return json_pack("{s:I, s:i, s:o, s:o}", "cycle_ns", (json_int_t)cycle_ns, "every", (int)recorder->every, "axes",
                     names_of(&recorder->trace), "columns", columns_of(&recorder->trace));
}

/** The bytes of a sample as hexadecimal digits, each word with its least significant byte first. */
static char *print_sample(char *at, const uint64_t *sample, uint32_t words)
{
    static const char digits[] = "0123456789abcdef";
    for (uint32_t i = 0; i < words; i++)
        for (int shift = 0; shift < 64; shift += 8) {
            *at++ = digits[sample[i] >> (shift + 4) & 0xF];
            *at++ = digits[sample[i] >> shift & 0xF];
        }
    return at;
}

/** How many of `ready` samples are in a row with what the client has, at most `most`. */
static uint64_t count_to_gap(const recorder_t *recorder, uint64_t read, uint64_t ready, uint64_t most)
{
    uint64_t count = 0;
    while (count < ready && count < most && sample_at(recorder, read + count)[recorder->words] == recorder->told)
        count++;
    return count;
}

json_t *cm1e_recorder_take(recorder_t *recorder)
{
    /* In this order: what was lost by then was lost behind all that is ready, or is counted in one of these. */
    const uint64_t lost = atomic_load_explicit(&recorder->lost, memory_order_acquire);
    const uint64_t read = atomic_load_explicit(&recorder->read, memory_order_relaxed);
    const uint64_t ready = atomic_load_explicit(&recorder->written, memory_order_acquire) - read;
    const uint64_t most = DATA_BYTES / (DIGITS * recorder->words) + 1;
    const uint64_t count = count_to_gap(recorder, read, ready, most);
    const uint64_t up_to_end = count == ready ? lost : count < most ? sample_at(recorder, read + count)[recorder->words]
                                                                    : recorder->told;
    char *text = malloc((size_t)count * recorder->words * DIGITS + 1), *at = text;
    for (uint64_t i = 0; text && i < count; i++)
        at = print_sample(at, sample_at(recorder, read + i), recorder->words);
    json_t *told = text ? json_pack("{s:I, s:I, s:s#}", "samples", (json_int_t)count, "lost", (json_int_t)up_to_end,
                                    "data", text, (int)(at - text)) : NULL;
    free(text);
    if (told) {
        recorder->told = up_to_end;
        atomic_store_explicit(&recorder->read, read + count, memory_order_release);
    }
    return told;
}
