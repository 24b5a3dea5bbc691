/* How a scheduler is made, with its axes, tasks and trace, and freed. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "assembly/assembly.h"
#include "core/in_task.h"
#include "core/sized.h"
#include "core/text.h"
#include "scheduler/realtime.h"
#include "scheduler/scheduler_private.h"
#include "scheduler/signals.h"

#define DEFAULT_STOP_TIMEOUT_NS INT64_C(10000000000)

cm1e_error_t cm1e_scheduler_missing(cm1e_diag_t *diag)
{
    return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "A scheduler is missing.");
}

cm1e_error_t cm1e_scheduler_check_operation(const member_t *member, cm1e_diag_t *diag)
{
    const uint32_t present = cm1e_bus_operation(member->bus);
    if (present == 0)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "The bus is not in operation: call cm1e_bus_start() first.");
    if (present != member->operation)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0,
                             "The bus was started again since this scheduler was made: make a new one.");
    return CM1E_OK;
}

static cm1e_error_t take_config(cm1e_scheduler_t *s, const cm1e_scheduler_config_t *config, size_t size,
                                cm1e_diag_t *diag)
{
    if (config)
        cm1e_copy_sized(&s->config, sizeof s->config, config, size);
    if (s->config.realtime_priority == 0)
        s->config.realtime_priority = REALTIME_DEFAULT_PRIORITY;
    if (s->config.stop_timeout_ns == 0)
        s->config.stop_timeout_ns = DEFAULT_STOP_TIMEOUT_NS;
    if (s->config.realtime_priority < -1 || s->config.realtime_priority > 98)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0,
                             "The real-time priority is %d; expected 1 ... 98, 0 (the default) or -1 (none).",
                             s->config.realtime_priority);
    if (s->config.cpu < 0 || s->config.stop_timeout_ns < 0)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "The CPU or the stop timeout is negative; expected "
                             "0 or above.");
    return CM1E_OK;
}

static cm1e_error_t make_axes(cm1e_scheduler_t *s, member_t *member, cm1e_diag_t *diag)
{
    const uint32_t count = cm1e_bus_configuration(member->bus)->axis_count;
    member->first = member->end = s->axis_count;
    for (uint32_t i = 0; i < count; i++) { /* a bus has at most CM1E_MAX_AXES, and so have all of them together */
        const cm1e_error_t error = cm1e_axis_create(&s->axes[s->axis_count], member->bus, i, diag);
        if (error != CM1E_OK)
            return error;
        cm1e_axis_share_cycle(s->axes[s->axis_count], s);
        s->heard_apart |= s->member_count > 1 || cm1e_axis_is_heard_alone(s->axes[s->axis_count]);
        member->end = ++s->axis_count;
    }
    return CM1E_OK;
}

/** Makes the bus a member, with its axes. */
static cm1e_error_t join(cm1e_scheduler_t *s, cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    member_t *member = &s->members[s->member_count];
    *member = (member_t){.bus = bus, .operation = cm1e_bus_operation(bus)};
    const cm1e_error_t error = cm1e_scheduler_check_operation(member, diag);
    if (error != CM1E_OK)
        return error;
    s->member_count++;
    cm1e_clock_team_add(&s->clocks, bus);
    return make_axes(s, member, diag);
}

static cm1e_error_t make_trace(cm1e_scheduler_t *s, cm1e_diag_t *diag)
{
    const char *names[CM1E_MAX_AXES];
    for (uint32_t i = 0; i < s->axis_count; i++)
        names[i] = cm1e_axis_name(cm1e_axis_reference(s->axes[i]));
    return cm1e_trace_init(&s->trace, names, s->axis_count, s->config.trace_capacity, s->config.trace_every, diag);
}

cm1e_error_t cm1e_scheduler_create_sized(cm1e_scheduler_t **scheduler, cm1e_bus_t *bus,
                                         const cm1e_scheduler_config_t *config, size_t size, cm1e_diag_t *diag)
{
    if (scheduler)
        *scheduler = NULL;
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_scheduler_create()", "", diag);
    if (!scheduler)
        return cm1e_scheduler_missing(diag);
    if (!bus)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "A scheduler needs a bus.");
    cm1e_scheduler_t *s = calloc(1, sizeof *s);
    if (!s)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the scheduler.");
    s->clock = cm1e_bus_clock(bus);
    s->cycle_time_ns = cm1e_bus_configuration(bus)->cycle_time_ns;
    cm1e_error_t error = take_config(s, config, size, diag);
    if (error == CM1E_OK)
        error = join(s, bus, diag);
    if (error == CM1E_OK)
        error = make_trace(s, diag);
    if (error == CM1E_OK)
        error = cm1e_log_init(&s->log, s->clock, diag);
    if (error != CM1E_OK) {
        cm1e_scheduler_destroy(s);
        return error; /* NOLINT(clang-analyzer-unix.Malloc): destroy refuses in a task only, where nobody comes */
    }
    *scheduler = s;
    return CM1E_OK;
}

/** Why a bus cannot be run beside the others; "": it can. */
static const char *other_bus_refused(const cm1e_scheduler_t *s, cm1e_bus_t *bus)
{
    for (uint32_t i = 0; i < s->member_count; i++)
        if (s->members[i].bus == bus)
            return "it is in this scheduler already";
    if (s->member_count == CM1E_MAX_BUSES)
        return "a scheduler has at most four buses";
    if (cm1e_bus_clock(bus) != s->clock)
        return "it runs on another time: either all buses of a scheduler have virtual_time and were opened in one "
               "thread, or none has it";
    if (cm1e_bus_configuration(bus)->cycle_time_ns != s->cycle_time_ns)
        return "its cycle_time_us differs from that of the first bus";
    if (!cm1e_bus_follow_one_clock(clock_team_leader(&s->clocks), bus))
        return "its distributed clocks and those of another bus do not follow each other: start the buses in one "
               "thread, each while those before it are in operation";
    _Static_assert(CM1E_MAX_AXES == 512, "the text says so");
    if (s->axis_count + cm1e_bus_configuration(bus)->axis_count > CM1E_MAX_AXES)
        return "a scheduler has at most 512 axes";
    return "";
}

/** NULL: every axis of the bus has a name of its own, also where upper and lower case are one, as in IEC 61131-3. */
static const char *name_taken(const cm1e_scheduler_t *s, cm1e_bus_t *bus)
{
    const cm1e_bus_config_t *config = cm1e_bus_configuration(bus);
    for (uint32_t i = 0; i < config->axis_count; i++)
        for (uint32_t other = 0; other < s->axis_count; other++)
            if (strcasecmp(cm1e_axis_name(cm1e_axis_reference(s->axes[other])), config->axes[i].name) == 0)
                return config->axes[i].name;
    return NULL;
}

cm1e_error_t cm1e_scheduler_add_bus(cm1e_scheduler_t *scheduler, cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_scheduler_add_bus()", "", diag);
    if (!scheduler || !bus)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "A scheduler or a bus is missing.");
    if (scheduler->run)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "Buses are added before the scheduler runs.");
    if (scheduler->trace.variables > 0 || scheduler->trace.trigger.kind != CM1E_TRACE_NO_TRIGGER)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "Buses are added before signals and the trigger of the trace, "
                             "whose columns begin with those of all axes.");
    const char *refused = other_bus_refused(scheduler, bus), *taken = name_taken(scheduler, bus);
    if (refused[0])
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "The bus on \"%s\" cannot be added to the "
                             "scheduler: %s.", cm1e_bus_configuration(bus)->interface_name, refused);
    if (taken)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "Two buses have an axis with the name \"%s\": give "
                             "each axis of a program a name of its own.", taken);
    const member_t before = {.first = scheduler->axis_count, .end = scheduler->member_count};
    trace_t trace = scheduler->trace; /* its columns point to where it was, and will be again after an error */
    cm1e_error_t error = join(scheduler, bus, diag);
    if (error == CM1E_OK)
        error = make_trace(scheduler, diag);
    if (error == CM1E_OK) {
        cm1e_trace_free(&trace);
        return CM1E_OK;
    }
    scheduler->trace = trace;
    while (scheduler->axis_count > before.first) {
        cm1e_axis_destroy(scheduler->axes[--scheduler->axis_count]);
        scheduler->axes[scheduler->axis_count] = NULL;
    }
    scheduler->member_count = before.end;
    cm1e_clock_team_cut(&scheduler->clocks, before.end);
    return error;
}

void cm1e_scheduler_destroy(cm1e_scheduler_t *scheduler)
{
    if (!scheduler || cm1e_in_task_note("cm1e_scheduler_destroy()"))
        return;
    cm1e_signals_detach(scheduler);
    cm1e_trace_free(&scheduler->trace);
    cm1e_log_free(&scheduler->log);
    for (uint32_t i = 0; i < scheduler->axis_count; i++)
        cm1e_axis_destroy(scheduler->axes[i]);
    free(scheduler);
}

cm1e_error_t cm1e_scheduler_add_task_sized(cm1e_scheduler_t *scheduler, const cm1e_task_config_t *task, size_t size,
                                           cm1e_diag_t *diag)
{
    cm1e_task_config_t own;
    if (!scheduler)
        return cm1e_scheduler_missing(diag);
    if (!task)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "A task is missing.");
    cm1e_copy_sized(&own, sizeof own, task, size);
    if (scheduler->run)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "Tasks are added before the scheduler runs.");
    return cm1e_tasks_add(&scheduler->tasks, &own, scheduler->cycle_time_ns, diag);
}

/* ---- what the trace records beside the axes ---------------------------------------------------------------------- */

static bool is_clean(const char *text)
{
    char clean[CM1E_TRACE_NAME_BYTES];
    snprintf(clean, sizeof clean, "%s", text);
    cm1e_text_clean(clean);
    return strcmp(clean, text) == 0;
}

cm1e_error_t cm1e_scheduler_trace_variable(cm1e_scheduler_t *scheduler, const char *name, const char *unit,
                                           cm1e_trace_type_t type, const void *variable, cm1e_diag_t *diag)
{
    trace_column_t column = {.type = type, .value = variable};
    column.kind = type == CM1E_TRACE_BOOL ? TRACE_KIND_FLAG : TRACE_KIND_NUMBER;
    if (!scheduler)
        return cm1e_scheduler_missing(diag);
    if ((name && strlen(name) >= sizeof column.name) || (unit && strlen(unit) >= sizeof column.unit))
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0,
                             "The name of a signal has at most %zu bytes, and its unit %zu.", sizeof column.name - 1,
                             sizeof column.unit - 1);
    snprintf(column.name, sizeof column.name, "%s", name ? name : "");
    snprintf(column.unit, sizeof column.unit, "%s", unit ? unit : "");
    if (!is_clean(column.name) || !is_clean(column.unit))
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "The name and the unit of a signal are expected to "
                             "be UTF-8 without control characters, so that programs can read the files of the trace.");
    return cm1e_trace_add(&scheduler->trace, &column, diag);
}

static cm1e_error_t trace_object_of(cm1e_scheduler_t *s, uint32_t axis, uint16_t index, uint8_t subindex,
                                    cm1e_diag_t *diag)
{
    const member_t *member = s->members;
    while (axis >= member->end)
        member++;
    return cm1e_trace_add_object(&s->trace, member->bus, cm1e_bus_axis_position(member->bus, axis - member->first),
                                 cm1e_axis_name(cm1e_axis_reference(s->axes[axis])), index, subindex, diag);
}

cm1e_error_t cm1e_scheduler_trace_object(cm1e_scheduler_t *scheduler, AXIS_REF_t axis, uint16_t index, uint8_t subindex,
                                         cm1e_diag_t *diag)
{
    if (!scheduler)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "A scheduler is missing.");
    for (uint32_t i = 0; i < scheduler->axis_count; i++)
        if (axis.Handle != 0 && cm1e_axis_reference(scheduler->axes[i]).Handle == axis.Handle)
            return trace_object_of(scheduler, i, index, subindex, diag);
    return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "The axis does not belong to this scheduler.");
}

cm1e_error_t cm1e_scheduler_trace_trigger(cm1e_scheduler_t *scheduler, const cm1e_trace_trigger_t *trigger,
                                          cm1e_diag_t *diag)
{
    if (!scheduler)
        return cm1e_scheduler_missing(diag);
    if (!trigger)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "A trigger is missing.");
    return cm1e_trace_set_trigger(&scheduler->trace, trigger, diag);
}

AXIS_REF_t cm1e_scheduler_axis(const cm1e_scheduler_t *scheduler, uint32_t index)
{
    return scheduler && index < scheduler->axis_count ? cm1e_axis_reference(scheduler->axes[index]) : (AXIS_REF_t){0};
}

AXIS_REF_t cm1e_scheduler_axis_by_name(const cm1e_scheduler_t *scheduler, const char *name)
{
    for (uint32_t i = 0; scheduler && name && i < scheduler->axis_count; i++) {
        const AXIS_REF_t reference = cm1e_axis_reference(scheduler->axes[i]);
        if (strcmp(cm1e_axis_name(reference), name) == 0)
            return reference;
    }
    return (AXIS_REF_t){0};
}
