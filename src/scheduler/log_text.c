/* Records of the event log as sentences. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "bus/emergency_ring.h"
#include "bus/port_watch.h"
#include "bus/presence_text.h"
#include "scheduler/scheduler_window.h"
#include "scheduler/variables.h"

static const char *const kind_names[] = {
    [CM1E_LOG_RUN] = "run",
    [CM1E_LOG_STATE] = "state",
    [CM1E_LOG_ERROR] = "error",
    [CM1E_LOG_COMMAND] = "command",
    [CM1E_LOG_OVERRUN] = "overrun",
    [CM1E_LOG_LOST_FRAMES] = "lost frames",
    [CM1E_LOG_WORKING_COUNTER] = "working counter",
    [CM1E_LOG_UNSENT_FRAMES] = "unsent frames",
    [CM1E_LOG_OTHER_MASTER] = "other master",
    [CM1E_LOG_SYNC_LOST] = "sync lost",
    [CM1E_LOG_EMERGENCY] = "emergency",
    [CM1E_LOG_PORT] = "port",
    [CM1E_LOG_RING] = "ring",
    [CM1E_LOG_SLAVE] = "slave",
    [CM1E_LOG_STRANGER] = "stranger",
    [CM1E_LOG_VARIABLE] = "variable",
    [CM1E_LOG_TASK] = "task",
};
_Static_assert(sizeof kind_names / sizeof *kind_names == CM1E_LOG_KIND_COUNT, "a kind of the log has no name");

static const char *const counter_texts[] = {
    [CM1E_LOG_OVERRUN] = "cycles whose work ended after the start of the next one",
    [CM1E_LOG_LOST_FRAMES] = "cycles without an answer because frames were lost",
    [CM1E_LOG_WORKING_COUNTER] = "cycles with a wrong working counter because a slave did not take part",
    [CM1E_LOG_UNSENT_FRAMES] = "frames that the network interface did not take because it is down or too slow",
    [CM1E_LOG_OTHER_MASTER] = "frames of another master on this network, which is to be ended",
    [CM1E_LOG_SYNC_LOST] = "loss of synchronism: the clock of a slave left the reference clock, or the reference is "
                           "away",
};

const char *cm1e_log_kind_name(cm1e_log_kind_t kind)
{
    return (unsigned)kind < CM1E_LOG_KIND_COUNT ? kind_names[kind] : "unknown";
}

static void error_text(const cm1e_axis_t *axis, const char *name, const cm1e_log_event_t *event, char *text,
                       size_t size)
{
    const cm1e_device_error_t *device = event->detail ? cm1e_axis_device_error(axis, (uint16_t)event->detail) : NULL;
    char numbers[64] = "", code[400] = "";
    /* Of a set-point these are a velocity, an acceleration or a jerk; the text of the axis says which. */
    const bool of_set_point = event->code == CM1E_ERROR_AXIS_SET_POINT_LIMIT ||
                              event->code == CM1E_ERROR_AXIS_COUPLING_LIMIT;
    const char *unit = of_set_point ? "" : " u";
    if (event->bound != 0.0)
        snprintf(numbers, sizeof numbers, ": %.6g%s, allowed are %.6g%s", event->value, unit, event->bound, unit);
    if (event->detail)
        snprintf(code, sizeof code, " Device error 0x%04X: %s.%s%s%s", event->detail,
                 device ? device->text : "not a code of the manual", device ? " Cure: " : "",
                 device ? device->cure : "", device ? "." : "");
    snprintf(text, size, "%s: %s%s.%s", name, cm1e_strerror((cm1e_error_t)event->code), numbers, code);
}

static void command_text(const char *name, const cm1e_log_event_t *event, char *text, size_t size)
{
    char position[40] = "", velocity[40] = "";
    if (event->value != 0.0)
        snprintf(position, sizeof position, ", position %.10g u", event->value);
    if (event->bound != 0.0)
        snprintf(velocity, sizeof velocity, ", velocity %.10g u/s", event->bound);
    snprintf(text, size, "%s: %s%s%s", name, cm1e_command_name((cm1e_command_kind_t)event->code), position, velocity);
}

/** How many were left out since the last record of the slave: `one` of them, or `many`. */
static void add_left_out(const cm1e_log_event_t *event, const char *one, const char *many, char *text, size_t size)
{
    const size_t used = strlen(text);
    if (event->bound > 0.0)
        snprintf(text + used, size - used, " %.0f more%s since its last record %s not shown.", event->bound,
                 event->bound == 1.0 ? one : many, event->bound == 1.0 ? "is" : "are");
}

static void emergency_text(const cm1e_bus_t *bus, const cm1e_log_event_t *event, char *text, size_t size)
{
    cm1e_emergency_t emergency = {.code = (uint16_t)event->code, .error_register = (uint8_t)(event->detail >> 16)};
    const uint64_t bytes = (uint64_t)event->value;
    for (size_t i = 0; i < sizeof emergency.data; i++)
        emergency.data[i] = (uint8_t)(bytes >> 8 * i);
    cm1e_emergency_sentence(bus, (uint16_t)event->detail, &emergency, text, size);
    add_left_out(event, "", "", text, size);
}

static void ring_text(const cm1e_bus_t *bus, const cm1e_log_event_t *event, char *text, size_t size)
{
    const cm1e_bus_ring_t ring = {.used = true, .broken = true, .placed = bus && event->bound > 0.0,
                                  .behind = (uint16_t)event->value, .before = (uint16_t)event->bound};
    if (event->code && !ring.placed)
        snprintf(text, size, "The ring was broken for a moment, too short to see where: look for a loose plug.");
    else if (event->code)
        cm1e_bus_ring_text(bus, &ring, text, size);
    else
        snprintf(text, size, "The ring is whole again.");
}

static void stranger_text(const cm1e_log_event_t *event, char *text, size_t size)
{
    const uint32_t addresses = (uint32_t)event->bound;
    const cm1e_stranger_t stranger = {
        .place = (uint16_t)event->detail, .alias = (uint16_t)addresses, .explicit_id = (uint16_t)(addresses >> 16),
        .vendor_id = (uint32_t)event->value, .product_code = (uint32_t)event->code};
    cm1e_stranger_text(&stranger, text, size);
}

/** As a program writes it; a number with its unit. */
static void number_text(const variable_t *variable, const cm1e_log_event_t *event, char *text, size_t size)
{
    const cm1e_trace_type_t type = variable->type;
    const char *unit = variable->unit, *space = *unit ? " " : "";
    const char *name = NULL;
    if (type == CM1E_TRACE_BOOL)
        name = event->value != 0.0 ? "TRUE" : "FALSE";
    else if (variable->name_count > 0)
        name = cm1e_variable_enumerator(variable, (int64_t)event->value + (int64_t)event->bound);
    if (name)
        snprintf(text, size, "%s", name);
    else if (type == CM1E_TRACE_LINT)
        snprintf(text, size, "%" PRId64 "%s%s", (int64_t)event->value + (int64_t)event->bound, space, unit);
    else if (type == CM1E_TRACE_ULINT)
        snprintf(text, size, "%" PRIu64 "%s%s", (uint64_t)event->value + (uint64_t)event->bound, space, unit);
    else
        snprintf(text, size, "%.10g%s%s",
                 type == CM1E_TRACE_REAL ? cm1e_variable_decimal((float)event->value) : event->value, space, unit);
}

static void variable_text(const cm1e_scheduler_t *scheduler, const cm1e_log_event_t *event, char *text, size_t size)
{
    const variables_t *variables = cm1e_scheduler_variables(scheduler);
    const variable_t *variable = event->detail < variables->count ? &variables->rows[event->detail] : NULL;
    const char *name = variable ? variable->name : "a variable";
    char value[100] = "a text";
    if (!variable)
        snprintf(value, sizeof value, "%.10g", event->value);
    else if (variable->form == VARIABLE_NUMBER)
        number_text(variable, event, value, sizeof value);
    if (event->code == 0)
        snprintf(text, size, "%s is no longer forced to %s", name, value);
    else
        snprintf(text, size, "%s was %s %s from outside", name, event->code == 1 ? "forced to" : "set to", value);
}

static bool is_counter(cm1e_log_kind_t kind) { return kind >= CM1E_LOG_OVERRUN && kind <= CM1E_LOG_SYNC_LOST; }

static bool is_counter_of_bus(cm1e_log_kind_t kind)
{
    return is_counter(kind) && kind != CM1E_LOG_OVERRUN;
}

/** The bus of a record that is about one; NULL: the scheduler does not have it. */
static const cm1e_bus_t *bus_of(const cm1e_scheduler_t *scheduler, const cm1e_log_event_t *event)
{
    const uint32_t number = is_counter_of_bus(event->kind)  ? (uint32_t)event->value
                            : event->kind == CM1E_LOG_PORT ? event->detail >> 20 & 0x0F : event->detail >> 24;
    return cm1e_scheduler_bus_at(scheduler, number);
}

/** Which of several buses, because each has a "slave 1". Returns the bytes written. */
static size_t print_bus(const cm1e_scheduler_t *scheduler, const cm1e_bus_t *bus, char *text, size_t size)
{
    if (!bus || !cm1e_scheduler_bus_at(scheduler, 1))
        return 0;
    const cm1e_bus_config_t *config = cm1e_bus_configuration(bus);
    const int bytes = snprintf(text, size, "network %s: ", config->name[0] ? config->name : config->interface_name);
    return (size_t)bytes < size ? (size_t)bytes : size - 1;
}

static void bus_text(const cm1e_bus_t *bus, const cm1e_log_event_t *event, char *text, size_t size)
{
    const uint16_t position = (uint16_t)event->detail;
    if (event->kind == CM1E_LOG_EMERGENCY)
        emergency_text(bus, event, text, size);
    else if (event->kind == CM1E_LOG_SLAVE) {
        cm1e_presence_sentence(bus, position, (cm1e_presence_t)event->code, text, size);
        add_left_out(event, " change", " changes", text, size);
    } else if (event->kind == CM1E_LOG_STRANGER)
        stranger_text(event, text, size);
    else if (event->kind == CM1E_LOG_PORT)
        cm1e_port_sentence(bus, position, event->detail >> 16 & 0x0F, (cm1e_port_fault_t)(event->detail >> 24),
                           (uint32_t)event->code, text, size);
    else
        ring_text(bus, event, text, size);
}

static bool is_of_bus(cm1e_log_kind_t kind)
{
    return kind >= CM1E_LOG_EMERGENCY && kind <= CM1E_LOG_STRANGER;
}

void cm1e_log_text(const cm1e_scheduler_t *scheduler, const cm1e_log_event_t *event, char *text, size_t size)
{
    uint32_t count;
    if (!text || size == 0)
        return;
    text[0] = 0;
    if (!scheduler || !event)
        return;
    cm1e_axis_t *const *axes = cm1e_scheduler_axes(scheduler, &count);
    const bool of_axis = event->axis >= 0 && (uint32_t)event->axis < count;
    const char *name = of_axis ? cm1e_axis_configuration(axes[event->axis])->name : "";
    if (event->kind == CM1E_LOG_RUN)
        snprintf(text, size, event->code ? "the run began" : "the run ended");
    else if (is_counter(event->kind)) {
        const cm1e_bus_t *bus = is_counter_of_bus(event->kind) ? bus_of(scheduler, event) : NULL;
        const size_t used = print_bus(scheduler, bus, text, size);
        snprintf(text + used, size - used, "%s: %" PRId32 " (%" PRIu32 " since the start)", counter_texts[event->kind],
                 event->code, event->detail);
    } else if (event->kind == CM1E_LOG_VARIABLE)
        variable_text(scheduler, event, text, size);
    else if (event->kind == CM1E_LOG_TASK)
        snprintf(text, size, "task \"%s\" did not return within %g ms and was ended; all axes were stopped",
                 cm1e_scheduler_task_name(scheduler, (uint32_t)event->code), event->value);
    else if (is_of_bus(event->kind)) {
        const cm1e_bus_t *bus = bus_of(scheduler, event);
        const size_t used = print_bus(scheduler, bus, text, size);
        bus_text(bus, event, text + used, size - used);
    } else if (of_axis && event->kind == CM1E_LOG_STATE)
        snprintf(text, size, "%s: %s (was %s)", name, cm1e_axis_state_name((cm1e_axis_state_t)event->code),
                 cm1e_axis_state_name((cm1e_axis_state_t)event->detail));
    else if (of_axis && event->kind == CM1E_LOG_ERROR)
        error_text(axes[event->axis], name, event, text, size);
    else if (of_axis && event->kind == CM1E_LOG_COMMAND)
        command_text(name, event, text, size);
}
