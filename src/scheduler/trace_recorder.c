/* The recorder: its columns, its ring of samples, its trigger. */
#include "scheduler/trace_recorder.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/bytes.h"
#include "core/near.h"

static const char trigger_mark[] = "trigger: ";

/* ---- columns --------------------------------------------------------------------------------------------------- */

static trace_column_t *new_column(trace_t *trace)
{
    trace_column_t *column = &trace->columns[trace->column_count++];
    *column = (trace_column_t){.type = CM1E_TRACE_LREAL};
    return column;
}

static void add_axis_columns(trace_t *trace, const char *axis)
{
    static const struct {
        const char *what, *unit;
        trace_kind_t kind;
    } rows[TRACE_AXIS_COLUMNS] = {
        [TRACE_STATE] = {"state", "", TRACE_KIND_STATE},
        [TRACE_SET_POSITION] = {"set position", "u", TRACE_KIND_NUMBER},
        [TRACE_ACTUAL_POSITION] = {"actual position", "u", TRACE_KIND_NUMBER},
        [TRACE_SET_VELOCITY] = {"set velocity", "u/s", TRACE_KIND_NUMBER},
        [TRACE_ACTUAL_VELOCITY] = {"actual velocity", "u/s", TRACE_KIND_NUMBER},
        [TRACE_TORQUE] = {"torque", "%", TRACE_KIND_NUMBER},
    };
    for (int i = 0; i < TRACE_AXIS_COLUMNS; i++) {
        trace_column_t *column = new_column(trace);
        snprintf(column->name, sizeof column->name, "%s %s", axis, rows[i].what);
        snprintf(column->unit, sizeof column->unit, "%s", rows[i].unit);
        column->kind = rows[i].kind;
    }
}

static void add_timing_columns(trace_t *trace)
{
    trace_timing_t *timing = &trace->timing;
    *new_column(trace) = (trace_column_t){"wake-up latency", "us", .type = CM1E_TRACE_LREAL,
                                          .value = &timing->wake_up_latency_us};
    *new_column(trace) = (trace_column_t){"execution time", "us", .type = CM1E_TRACE_LREAL,
                                          .value = &timing->execution_time_us};
    *new_column(trace) = (trace_column_t){"lost frames", "", TRACE_KIND_COUNT, .type = CM1E_TRACE_ULINT,
                                          .value = &timing->lost_frames};
    *new_column(trace) = (trace_column_t){"overruns", "", TRACE_KIND_COUNT, .type = CM1E_TRACE_ULINT,
                                          .value = &timing->overruns};
}

static void add_error_columns(trace_t *trace)
{
    for (uint32_t i = 0; i < trace->axes; i++) {
        trace_column_t *column = new_column(trace);
        snprintf(column->name, sizeof column->name, "%s error", trace->names[i]);
        column->kind = TRACE_KIND_ERROR;
    }
}

enum { TIMING_COLUMNS = 4 };

cm1e_error_t cm1e_trace_init(trace_t *trace, const char *const names[], uint32_t count, uint32_t capacity,
                             uint32_t every, cm1e_diag_t *diag)
{
    *trace = (trace_t){.axes = count, .every = every ? every : 1};
    trace->column_room = count * (TRACE_AXIS_COLUMNS + 1) + TIMING_COLUMNS + CM1E_TRACE_VARIABLES;
    trace->names = calloc(count + 1, sizeof *trace->names);
    trace->columns = calloc(trace->column_room, sizeof *trace->columns);
    trace->times_ns = capacity ? calloc(capacity, sizeof *trace->times_ns) : NULL;
    if (!trace->names || !trace->columns || (capacity && !trace->times_ns)) {
        cm1e_trace_free(trace);
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for a trace of %u cycles.", capacity);
    }
    for (uint32_t i = 0; i < count; i++) {
        trace->names[i] = names[i];
        add_axis_columns(trace, names[i]);
    }
    add_timing_columns(trace);
    add_error_columns(trace);
    trace->capacity = capacity;
    return CM1E_OK;
}

void cm1e_trace_free(trace_t *trace)
{
    free(trace->names);
    free(trace->columns);
    free(trace->times_ns);
    free(trace->values);
    *trace = (trace_t){0};
}

/** column_count: none has this name. */
static uint32_t find_column(const trace_t *trace, const char *name)
{
    uint32_t i = 0;
    while (i < trace->column_count && strcmp(trace->columns[i].name, name) != 0)
        i++;
    return i;
}

/** That the trace has no such signal, and which one may have been meant. */
static cm1e_error_t unknown_column(const trace_t *trace, const char *name, cm1e_diag_t *diag)
{
    char meant[CM1E_NEAR_TEXT_BYTES];
    cm1e_near_t near = {.word = name};
    for (uint32_t i = 0; i < trace->column_count; i++)
        cm1e_near_look(&near, trace->columns[i].name);
    return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "The trace has no signal \"%s\" for a trigger%s", name,
                         cm1e_near_text(&near, meant, sizeof meant));
}

static cm1e_error_t check_column(const trace_t *trace, const trace_column_t *column, cm1e_diag_t *diag)
{
    if (trace->begun)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "Signals of the trace are chosen before the scheduler runs.");
    if (!column->name[0] || !column->value || (unsigned)column->type > CM1E_TRACE_LREAL)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0,
                             "A signal of the trace needs a name, a type and a variable.");
    if (strcmp(column->name, "time") == 0 || find_column(trace, column->name) < trace->column_count)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "The trace has a signal \"%s\" already.",
                             column->name);
    if (trace->variables == CM1E_TRACE_VARIABLES)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "The trace has %d variables and objects already.",
                             CM1E_TRACE_VARIABLES);
    return CM1E_OK;
}

cm1e_error_t cm1e_trace_add(trace_t *trace, const trace_column_t *column, cm1e_diag_t *diag)
{
    const cm1e_error_t error = check_column(trace, column, diag);
    if (error != CM1E_OK)
        return error;
    *new_column(trace) = *column;
    trace->variables++;
    return CM1E_OK;
}

/* ---- trigger --------------------------------------------------------------------------------------------------- */

static cm1e_error_t check_trigger(const trace_t *trace, const cm1e_trace_trigger_t *trigger, cm1e_diag_t *diag)
{
    if (trace->capacity == 0 || trace->begun)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0,
                             "Set the trigger of a trace before the scheduler runs, and with a trace_capacity above "
                             "0.");
    if ((unsigned)trigger->kind > CM1E_TRACE_ON_CHANGE || !isfinite(trigger->level))
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0,
                             "The kind of the trigger is unknown, or its level is not a number.");
    if (trigger->samples_before >= trace->capacity)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0,
                             "The trigger of the trace keeps %u samples before it, but trace_capacity is %u.",
                             trigger->samples_before, trace->capacity);
    return CM1E_OK;
}

cm1e_error_t cm1e_trace_set_trigger(trace_t *trace, const cm1e_trace_trigger_t *trigger, cm1e_diag_t *diag)
{
    const cm1e_error_t error = check_trigger(trace, trigger, diag);
    if (error != CM1E_OK)
        return error;
    trace_trigger_t t = {.kind = trigger->kind, .level = trigger->level, .before = NAN,
                         .samples_before = trigger->samples_before};
    const char *signal = trigger->kind == CM1E_TRACE_ON_ERROR_STOP ? "ErrorStop" : trigger->signal;
    if (trigger->kind > CM1E_TRACE_ON_ERROR_STOP) {
        t.column = signal ? find_column(trace, signal) : trace->column_count;
        if (t.column == trace->column_count)
            return unknown_column(trace, signal ? signal : "", diag);
    }
    snprintf(t.text, sizeof t.text, "%s%s", trigger_mark, signal ? signal : "");
    trace->trigger = t;
    return CM1E_OK;
}

/** A value that is not a number is neither above nor below a level. */
static bool comes(const trace_trigger_t *trigger, double value)
{
    switch (trigger->kind) {
    case CM1E_TRACE_ON_ERROR_STOP: return value > 0 && !isnan(trigger->before);
    case CM1E_TRACE_ON_RISING: return trigger->before < trigger->level && value >= trigger->level;
    case CM1E_TRACE_ON_FALLING: return trigger->before > trigger->level && value <= trigger->level;
    case CM1E_TRACE_ON_CHANGE: return !isnan(trigger->before) && value != trigger->before;
    default: return false;
    }
}

/** For CM1E_TRACE_ON_ERROR_STOP the number of axes that have entered it since the last sample. */
static double watched_value(trace_t *trace, const double *sample)
{
    if (trace->trigger.kind != CM1E_TRACE_ON_ERROR_STOP)
        return sample[trace->trigger.column];
    double entered = 0;
    for (uint32_t i = 0; i < trace->axes; i++) {
        const bool stopped = (cm1e_axis_state_t)sample[i * TRACE_AXIS_COLUMNS + TRACE_STATE] == CM1E_AXIS_ERROR_STOP;
        entered += stopped && !trace->trigger.stopped[i];
        trace->trigger.stopped[i] = stopped;
    }
    return entered;
}

static void watch(trace_t *trace, const double *sample, int64_t time_ns)
{
    trace_trigger_t *trigger = &trace->trigger;
    if (trigger->kind == CM1E_TRACE_NO_TRIGGER)
        return;
    if (trigger->seen) {
        trigger->left--;
        return;
    }
    const double value = watched_value(trace, sample);
    if (comes(trigger, value)) {
        trigger->seen = true;
        trigger->left = trace->capacity - trigger->samples_before - 1;
        cm1e_trace_mark(trace, trigger->text, time_ns);
    }
    trigger->before = value;
}

/* ---- recording ------------------------------------------------------------------------------------------------- */

cm1e_error_t cm1e_trace_begin(trace_t *trace, cm1e_diag_t *diag)
{
    trace->begun = true;
    if (trace->capacity == 0)
        return CM1E_OK;
    trace->values = calloc(trace->capacity, trace->column_count * sizeof *trace->values);
    if (!trace->values)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for a trace of %u cycles of %u signals.",
                             trace->capacity, trace->column_count);
    return CM1E_OK;
}

double *cm1e_trace_next_sample(trace_t *trace, int64_t time_ns)
{
    if (!trace->values || (trace->trigger.seen && trace->trigger.left == 0))
        return NULL;
    const uint32_t place = (uint32_t)(((uint64_t)trace->first + trace->used) % trace->capacity);
    if (trace->used < trace->capacity)
        trace->used++;
    else
        trace->first = (trace->first + 1) % trace->capacity;
    trace->times_ns[place] = time_ns;
    double *sample = &trace->values[(size_t)place * trace->column_count];
    memset(sample, 0, trace->column_count * sizeof *sample);
    return sample;
}

static void record_axis(trace_t *trace, double *sample, const cm1e_axis_t *axis, uint32_t i)
{
    cm1e_axis_info_t info;
    cm1e_axis_get(axis, &info);
    double *columns = sample + (size_t)i * TRACE_AXIS_COLUMNS;
    columns[TRACE_STATE] = info.state;
    columns[TRACE_SET_POSITION] = info.set_position;
    columns[TRACE_ACTUAL_POSITION] = info.actual_position;
    columns[TRACE_SET_VELOCITY] = info.set_velocity;
    columns[TRACE_ACTUAL_VELOCITY] = info.actual_velocity;
    columns[TRACE_TORQUE] = info.actual_torque;
    sample[trace->axes * TRACE_AXIS_COLUMNS + TIMING_COLUMNS + i] = info.error;
}

/** A variable of the program has the byte order of this machine, and lies anywhere. */
double cm1e_trace_value(const trace_column_t *column)
{
    union {
        int8_t sint; int16_t i; int32_t dint; int64_t lint;
        uint8_t usint; uint16_t u; uint32_t udint; uint64_t ulint;
        float real; double lreal;
    } v;
#define READ(member) (memcpy(&v.member, column->value, sizeof v.member), (double)v.member)
    switch (column->type) {
    case CM1E_TRACE_BOOL: return ((unsigned)READ(usint) & (column->bit ? 1u << (column->bit - 1) : UINT8_MAX)) != 0;
    case CM1E_TRACE_SINT: return READ(sint);
    case CM1E_TRACE_INT: return READ(i);
    case CM1E_TRACE_DINT: return READ(dint);
    case CM1E_TRACE_LINT: return READ(lint);
    case CM1E_TRACE_USINT: return READ(usint);
    case CM1E_TRACE_UINT: return READ(u);
    case CM1E_TRACE_UDINT: return READ(udint);
    case CM1E_TRACE_ULINT: return READ(ulint);
    case CM1E_TRACE_REAL: return READ(real);
    default: return READ(lreal);
    }
#undef READ
}

/** In the process image an integer is little-endian; its type says its size and its sign. */
static double value_in_image(const trace_column_t *column)
{
    cm1e_trace_type_t type = column->type;
    const uint8_t *place = column->value;
    if (column->absent.bus)
        place = cm1e_trace_find_object(&column->absent, &type);
    if (!place)
        return NAN;
    switch (type) {
    case CM1E_TRACE_SINT: return (int8_t)cm1e_get_uint(place, 1);
    case CM1E_TRACE_INT: return (int16_t)cm1e_get_uint(place, 2);
    case CM1E_TRACE_DINT: return (int32_t)cm1e_get_uint(place, 4);
    case CM1E_TRACE_UINT: return (double)cm1e_get_uint(place, 2);
    case CM1E_TRACE_UDINT: return (double)cm1e_get_uint(place, 4);
    default: return (double)cm1e_get_uint(place, 1);
    }
}

void cm1e_trace_record(trace_t *trace, cm1e_axis_t *const axes[], int64_t time_ns)
{
    if (trace->capacity == 0 || trace->until_next-- > 0)
        return;
    trace->until_next = trace->every - 1;
    double *sample = cm1e_trace_next_sample(trace, time_ns);
    if (!sample)
        return;
    for (uint32_t i = 0; i < trace->axes; i++)
        record_axis(trace, sample, axes[i], i);
    for (uint32_t i = trace->axes * TRACE_AXIS_COLUMNS; i < trace->column_count; i++) {
        const trace_column_t *column = &trace->columns[i];
        if (column->value)
            sample[i] = column->little_endian ? value_in_image(column) : cm1e_trace_value(column);
    }
    watch(trace, sample, time_ns);
}

bool cm1e_trace_take(trace_t *trace, const double *values, int64_t time_ns)
{
    double *sample = cm1e_trace_next_sample(trace, time_ns);
    if (!sample)
        return false;
    memcpy(sample, values, trace->column_count * sizeof *sample);
    watch(trace, sample, time_ns);
    return true;
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

const double *cm1e_trace_sample(const trace_t *trace, uint32_t n)
{
    return &trace->values[(size_t)place_of(trace, n) * trace->column_count];
}

const trace_mark_t *cm1e_trace_mark_at(const trace_t *trace, uint32_t n)
{
    return &trace->marks[(trace->first_mark + n) % TRACE_MARKS];
}
