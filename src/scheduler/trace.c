#include "scheduler/trace.h"

#include <locale.h>
#include <stdlib.h>
#include <string.h>

#include "core/output.h"

/* ---- recording ------------------------------------------------------------------------------------------------- */

cm1e_error_t cm1e_trace_init(trace_t *trace, cm1e_axis_t *const axes[], uint32_t count, uint32_t capacity,
                             uint32_t every, cm1e_diag_t *diag)
{
    *trace = (trace_t){.axes = count, .every = every ? every : 1};
    if (capacity == 0)
        return CM1E_OK;
    trace->names = calloc(count + 1, sizeof *trace->names);
    trace->times_ns = calloc(capacity, sizeof *trace->times_ns);
    trace->samples = calloc(capacity, ((size_t)count + 1) * sizeof *trace->samples);
    if (!trace->names || !trace->times_ns || !trace->samples) {
        cm1e_trace_free(trace);
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for a trace of %u cycles of %u axes.", capacity,
                             count);
    }
    for (uint32_t i = 0; i < count; i++)
        trace->names[i] = cm1e_axis_name(cm1e_axis_reference(axes[i]));
    trace->capacity = capacity;
    return CM1E_OK;
}

void cm1e_trace_free(trace_t *trace)
{
    free(trace->names);
    free(trace->times_ns);
    free(trace->samples);
    *trace = (trace_t){0};
}

void cm1e_trace_record(trace_t *trace, cm1e_axis_t *const axes[], int64_t time_ns)
{
    if (trace->capacity == 0 || trace->until_next-- > 0)
        return;
    trace->until_next = trace->every - 1;
    const uint32_t place = (uint32_t)(((uint64_t)trace->first + trace->used) % trace->capacity);
    if (trace->used < trace->capacity)
        trace->used++;
    else
        trace->first = (trace->first + 1) % trace->capacity;
    trace->times_ns[place] = time_ns;
    for (uint32_t i = 0; i < trace->axes; i++) {
        cm1e_axis_info_t info;
        cm1e_axis_get(axes[i], &info);
        trace->samples[(size_t)place * trace->axes + i] = (trace_sample_t){
            .set_position = info.set_position,
            .actual_position = info.actual_position,
            .set_velocity = info.set_velocity,
            .actual_velocity = info.actual_velocity,
            .torque = info.actual_torque,
            .state = info.state,
        };
    }
}

void cm1e_trace_mark(trace_t *trace, const char *text, int64_t time_ns)
{
    const uint32_t place = (trace->first_mark + trace->mark_count) % TRACE_MARKS;
    if (trace->mark_count < TRACE_MARKS)
        trace->mark_count++;
    else
        trace->first_mark = (trace->first_mark + 1) % TRACE_MARKS;
    trace->marks[place] = (trace_mark_t){time_ns, text};
}

/* ---- reading --------------------------------------------------------------------------------------------------- */

static uint32_t place_of(const trace_t *trace, uint32_t n)
{
    return (uint32_t)(((uint64_t)trace->first + n) % trace->capacity);
}

int64_t cm1e_trace_time_ns(const trace_t *trace, uint32_t n) { return trace->times_ns[place_of(trace, n)]; }

const trace_sample_t *cm1e_trace_sample(const trace_t *trace, uint32_t n, uint32_t axis)
{
    return &trace->samples[(size_t)place_of(trace, n) * trace->axes + axis];
}

const trace_mark_t *cm1e_trace_mark_at(const trace_t *trace, uint32_t n)
{
    return &trace->marks[(trace->first_mark + n) % TRACE_MARKS];
}

/* ---- writing --------------------------------------------------------------------------------------------------- */

/** A field of a CSV file (RFC 4180): quoted, quotes doubled. */
static void print_quoted(FILE *file, const char *name, const char *what)
{
    fputs(",\"", file);
    for (const char *c = name; *c; c++) {
        if (*c == '"')
            fputc('"', file);
        fputc(*c, file);
    }
    fprintf(file, " %s\"", what);
}

void cm1e_trace_print_csv(const trace_t *trace, FILE *file)
{
    static const char *const columns[] = {"state", "set position [u]", "actual position [u]", "set velocity [u/s]",
                                          "actual velocity [u/s]", "torque [%]"};
    fputs("\"time [s]\"", file);
    for (uint32_t axis = 0; axis < trace->axes; axis++)
        for (size_t i = 0; i < sizeof columns / sizeof columns[0]; i++)
            print_quoted(file, trace->names[axis], columns[i]);
    fputc('\n', file);
    for (uint32_t n = 0; n < trace->used; n++) {
        fprintf(file, "%.6f", (double)cm1e_trace_time_ns(trace, n) * 1e-9);
        for (uint32_t axis = 0; axis < trace->axes; axis++) {
            const trace_sample_t *s = cm1e_trace_sample(trace, n, axis);
            fprintf(file, ",%s,%.9g,%.9g,%.9g,%.9g,%.4g", cm1e_axis_state_name(s->state), s->set_position,
                    s->actual_position, s->set_velocity, s->actual_velocity, s->torque);
        }
        fputc('\n', file);
    }
}

static void print_in_c_locale(const trace_t *trace, FILE *file, void (*print)(const trace_t *trace, FILE *file))
{
    const locale_t locale = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    const locale_t before = locale ? uselocale(locale) : (locale_t)0;
    print(trace, file);
    if (locale) {
        uselocale(before);
        freelocale(locale);
    }
}

cm1e_error_t cm1e_trace_write_file(const trace_t *trace, const char *path,
                                   void (*print)(const trace_t *trace, FILE *file), cm1e_diag_t *diag)
{
    cm1e_output_t output;
    if (trace->capacity == 0)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "Nothing was recorded: the scheduler's trace_capacity is 0.");
    const cm1e_error_t error = cm1e_output_open(&output, path, diag);
    if (error != CM1E_OK)
        return error;
    print_in_c_locale(trace, output.file, print);
    return cm1e_output_close(&output, diag);
}
