#include "recording.h"

#include <stdlib.h>
#include <string.h>

#include "attach.h"

/** Without a duration the last of these samples are kept. */
enum { KEPT_SAMPLES = 600000, WORD_DIGITS = 16 };

static const char gap_mark[] = "samples were lost";

/* ---- columns ----------------------------------------------------------------------------------------------------- */

static const char *text_or_empty(const json_t *value)
{
    const char *text = json_string_value(value);
    return text ? text : "";
}

/** Columns behind those of the axes and of the timing. */
static cm1e_error_t add_column(trace_t *trace, const json_t *told, cm1e_diag_t *diag)
{
    static const double unused;
    trace_column_t column = {.kind = (trace_kind_t)json_integer_value(json_object_get(told, "kind")),
                             .type = (cm1e_trace_type_t)json_integer_value(json_object_get(told, "type")),
                             .value = &unused};
    snprintf(column.name, sizeof column.name, "%s", text_of(told, "name"));
    snprintf(column.unit, sizeof column.unit, "%s", text_of(told, "unit"));
    if ((unsigned)column.kind > TRACE_KIND_COUNT)
        column.kind = TRACE_KIND_NUMBER;
    return cm1e_trace_add(trace, &column, diag);
}

/** The same columns as the program's; a program that has others is another version. */
static cm1e_error_t make_trace(recording_t *recording, uint32_t capacity, cm1e_diag_t *diag)
{
    const json_t *axes = json_object_get(recording->told, "axes"),
                 *columns = json_object_get(recording->told, "columns");
    const char *names[CM1E_MAX_AXES];
    const size_t count = json_array_size(axes);
    for (size_t i = 0; i < count && i < CM1E_MAX_AXES; i++)
        names[i] = text_or_empty(json_array_get(axes, i));
    cm1e_error_t error = count > CM1E_MAX_AXES
                             ? cm1e_diag_set(diag, CM1E_ERROR_FILE, 0, "The program has too many axes.")
                             : cm1e_trace_init(&recording->trace, names, (uint32_t)count, capacity, 1, diag);
    for (size_t i = 0; i < json_array_size(columns) && error == CM1E_OK; i++) {
        const json_t *column = json_array_get(columns, i);
        if (i >= recording->trace.column_count)
            error = add_column(&recording->trace, column, diag);
        else if (strcmp(recording->trace.columns[i].name, text_of(column, "name")) != 0)
            error = cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "The program is of another version: its signal %zu "
                                  "is \"%s\", here it is \"%s\".", i + 1, text_of(column, "name"),
                                  recording->trace.columns[i].name);
    }
    return error;
}

static cm1e_error_t prepare(recording_t *recording, const cm1e_trace_trigger_t *trigger, cm1e_diag_t *diag)
{
    const double period_s = (double)json_integer_value(json_object_get(recording->told, "cycle_ns")) *
                            (double)json_integer_value(json_object_get(recording->told, "every")) * 1e-9;
    const double kept = recording->kept ? recording->kept : KEPT_SAMPLES;
    const double wanted = recording->seconds > 0 && period_s > 0 ? recording->seconds / period_s + 1 : kept;
    cm1e_trace_trigger_t own = *trigger;
    if (wanted > KEPT_SAMPLES)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "%.6g s are %.0f samples; at most %d are kept: "
                             "record less time, or fewer cycles with --every.", recording->seconds, wanted, KEPT_SAMPLES);
    own.samples_before = (uint32_t)(recording->before_s / (period_s > 0 ? period_s : 1e-3));
    cm1e_error_t error = make_trace(recording, (uint32_t)wanted, diag);
    if (error == CM1E_OK && trigger->kind != CM1E_TRACE_NO_TRIGGER)
        error = cm1e_trace_set_trigger(&recording->trace, &own, diag);
    return error == CM1E_OK ? cm1e_trace_begin(&recording->trace, diag) : error;
}

bool recording_begin(recording_t *recording, cm1e_control_t *control, uint32_t every, json_t *objects, json_t *paths,
                     const cm1e_trace_trigger_t *trigger, cm1e_diag_t *diag)
{
    recording->told = ask_program(control, json_pack("{s:s, s:i, s:o, s:o*}", "request", "record", "every", (int)every,
                                                     "objects", objects, "variables", paths), "record", diag);
    recording->first_ns = -1;
    return recording->told && prepare(recording, trigger, diag) == CM1E_OK;
}

void recording_free(recording_t *recording)
{
    cm1e_trace_free(&recording->trace);
    json_decref(recording->told);
}

/* ---- samples ----------------------------------------------------------------------------------------------------- */

static uint64_t word_of(const char *digits)
{
    uint64_t word = 0;
    for (int i = 0; i < 8; i++) {
        const char high = digits[2 * i], low = digits[2 * i + 1];
        const unsigned byte = (unsigned)((high <= '9' ? high - '0' : high - 'a' + 10) << 4 |
                                         (low <= '9' ? low - '0' : low - 'a' + 10));
        word |= (uint64_t)(byte & 0xFF) << (8 * i);
    }
    return word;
}

static void take_sample(recording_t *recording, const char *digits, double *values)
{
    const int64_t time_ns = (int64_t)word_of(digits);
    for (uint32_t i = 0; i < recording->trace.column_count; i++) {
        const uint64_t bits = word_of(digits + (size_t)(i + 1) * WORD_DIGITS);
        memcpy(&values[i], &bits, sizeof bits);
    }
    if (recording->first_ns < 0)
        recording->first_ns = time_ns;
    const bool ends_by_trigger = recording->trace.trigger.kind != CM1E_TRACE_NO_TRIGGER;
    if (!cm1e_trace_take(&recording->trace, values, time_ns)) {
        recording->full = true;
        return;
    }
    recording->last_ns = time_ns;
    recording->samples++;
    if (!ends_by_trigger && recording->seconds > 0 &&
             (double)(time_ns - recording->first_ns) * 1e-9 >= recording->seconds)
        recording->full = true;
}

/** A gap is marked where it is: a reply ends before it. */
static void note_gap(recording_t *recording, uint64_t lost)
{
    if (lost > recording->lost)
        cm1e_trace_mark(&recording->trace, gap_mark, recording->last_ns);
    recording->lost = lost;
}

bool recording_take(recording_t *recording, cm1e_control_t *control, cm1e_diag_t *diag)
{
    const size_t digits = (size_t)(recording->trace.column_count + 1) * WORD_DIGITS;
    json_t *told = ask_program(control, json_pack("{s:s}", "request", "samples"), "samples", diag);
    const char *data = text_of(told, "data");
    const size_t length = strlen(data);
    double *values = malloc(digits);
    if (told && (length % digits != 0 || strspn(data, "0123456789abcdef") != length || !values)) {
        cm1e_diag_set(diag, CM1E_ERROR_FILE, 0, "The answer of the program has no samples that can be read.");
        json_decref(told);
        told = NULL;
    }
    for (size_t at = 0; told && at < length && !recording->full; at += digits)
        take_sample(recording, data + at, values);
    if (told)
        note_gap(recording, (uint64_t)json_integer_value(json_object_get(told, "lost")));
    free(values);
    const bool answered = told != NULL;
    json_decref(told);
    return answered;
}
