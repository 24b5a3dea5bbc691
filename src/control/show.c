#include "control/show.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cm1e/emergency.h"
#include "cm1e/hot_connect.h"
#include "config/switches.h"
#include "core/json_text.h"

enum { EVENTS_OF_REPLY = 256, EVENT_TEXT = 512 };

json_t *cm1e_show_real(double value) { return isfinite(value) ? json_real(value) : json_null(); }

static json_t *number(uint64_t value) { return json_integer((json_int_t)value); }
static json_t *known(bool is_known, double value) { return is_known ? cm1e_show_real(value) : json_null(); }

/* ---- axes ------------------------------------------------------------------------------------------------------- */

static const char *const types[] = {
    [CM1E_AXIS_MOTOR] = "motor", [CM1E_AXIS_VIRTUAL] = "virtual", [CM1E_AXIS_ENCODER] = "encoder",
};

static void add_values(json_t *axis, const cm1e_axis_info_t *info)
{
    json_object_set_new(axis, "set_position", cm1e_show_real(info->set_position));
    json_object_set_new(axis, "set_velocity", cm1e_show_real(info->set_velocity));
    json_object_set_new(axis, "set_acceleration", cm1e_show_real(info->set_acceleration));
    json_object_set_new(axis, "position", cm1e_show_real(info->actual_position));
    json_object_set_new(axis, "velocity", cm1e_show_real(info->actual_velocity));
    json_object_set_new(axis, "lag", cm1e_show_real(info->position_lag));
    json_object_set_new(axis, "torque", known(info->torque_known, info->actual_torque));
    json_object_set_new(axis, "temperature", known(info->temperature_known, info->temperature));
    json_object_set_new(axis, "dc_link", known(info->dc_link_known, info->dc_link_voltage));
    json_object_set_new(axis, "inputs", info->digital_known ? json_integer(info->digital_inputs) : json_null());
    json_object_set_new(axis, "powered", json_boolean(info->powered));
    json_object_set_new(axis, "homed", json_boolean(info->homed));
    json_object_set_new(axis, "online", json_boolean(info->online));
    json_object_set_new(axis, "in_position", json_boolean(info->in_position));
    json_object_set_new(axis, "statusword", json_integer(info->statusword));
    json_object_set_new(axis, "mode", json_integer(info->mode));
}

/** What the values are measured by; null: there is no such limit. */
static json_t *limits_of(const view_t *view, uint32_t index)
{
    const cm1e_axis_measures_t *measures = &view->measures[index];
    return json_pack("{s:o, s:o, s:o, s:o}", "lower", cm1e_show_real(measures->lower), "upper",
                     cm1e_show_real(measures->upper), "velocity", cm1e_show_real(measures->max_velocity), "lag",
                     cm1e_show_real(measures->max_lag));
}

/** Inputs of the motor to which a switch is wired. */
static json_t *switches_of(const cm1e_input_config_t *inputs)
{
    cm1e_switch_t switches[CM1E_SWITCHES];
    json_t *all = json_array();
    cm1e_switches_of(inputs, switches);
    for (int i = 0; i < CM1E_SWITCHES; i++)
        if (switches[i].input > 0)
            json_array_append_new(all, json_pack("{s:i, s:s, s:b}", "input", switches[i].input, "name",
                                                 switches[i].name, "normally_closed", switches[i].closed));
    return all;
}

static void add_error(json_t *axis, const view_t *view, uint32_t index)
{
    const cm1e_axis_info_t *info = &view->infos[index];
    char text[CM1E_AXIS_ERROR_TEXT_BYTES], id[8];
    json_t *error = json_null();
    if (info->error != CM1E_OK) {
        snprintf(id, sizeof id, "0x%04X", cm1e_error_id(info->error));
        error = json_pack("{s:i, s:s, s:s, s:i}", "code", (int)info->error, "id", id, "name",
                          cm1e_strerror(info->error), "device_error", (int)info->device_error);
    }
    json_object_set_new(axis, "error", error);
    cm1e_view_text(view, index, text, sizeof text);
    json_object_set_new(axis, "text", cm1e_json_text(text));
}

json_t *cm1e_show_axes(const view_t *view)
{
    json_t *all = json_array();
    for (uint32_t i = 0; i < view->axis_count; i++) {
        const cm1e_axis_config_t *config = cm1e_axis_configuration(view->axes[i]);
        const cm1e_axis_news_t *news = &view->news[i];
        json_t *axis = json_object();
        json_object_set_new(axis, "number", json_integer(i + 1));
        json_object_set_new(axis, "name", cm1e_json_text(config->name));
        json_object_set_new(axis, "type", json_string(types[config->type]));
        json_object_set_new(axis, "slave", json_integer(cm1e_bus_axis_position(view->bus, i)));
        json_object_set_new(axis, "channel", json_integer(config->channel));
        json_object_set_new(axis, "state", json_string(cm1e_axis_state_name(view->infos[i].state)));
        json_object_set_new(axis, "command", news->command ? json_string(cm1e_command_name(news->kind)) : json_null());
        json_object_set_new(axis, "modulo_range", cm1e_show_real(config->modulo_range));
        json_object_set_new(axis, "limits", limits_of(view, i));
        json_object_set_new(axis, "switches", switches_of(&config->inputs));
        json_object_set_new(axis, "held", json_boolean(view->holders[i] >= 0));
        json_object_set_new(axis, "resetting", json_boolean(view->resetting[i]));
        add_values(axis, &view->infos[i]);
        add_error(axis, view, i);
        json_array_append_new(all, axis);
    }
    return all;
}

/* ---- slaves ----------------------------------------------------------------------------------------------------- */

static json_t *emergencies_of(const cm1e_bus_t *bus, uint16_t position)
{
    cm1e_emergency_t emergencies[CM1E_EMERGENCIES];
    char text[CM1E_EMERGENCY_TEXT_BYTES];
    json_t *all = json_array();
    const size_t count = cm1e_bus_emergencies(bus, position, 0, emergencies, CM1E_EMERGENCIES, NULL);
    for (size_t i = 0; i < count; i++) {
        const cm1e_emergency_t *one = &emergencies[i];
        json_t *data = json_array();
        for (size_t n = 0; n < sizeof one->data; n++)
            json_array_append_new(data, json_integer(one->data[n]));
        cm1e_emergency_text(bus, position, one, text, sizeof text);
        json_array_append_new(all, json_pack("{s:I, s:I, s:i, s:i, s:o, s:o}", "number", (json_int_t)one->number,
                                             "time_ns", (json_int_t)one->time_ns, "code", one->code, "error_register",
                                             one->error_register, "data", data, "text", cm1e_json_text(text)));
    }
    return all;
}

static json_t *clock_of(const cm1e_slave_clock_t *clock)
{
    return json_pack("{s:b, s:b, s:i, s:i, s:i, s:i, s:i, s:i, s:I}", "is_reference", clock->is_reference, "lost",
                     clock->lost, "delay_ns", (int)clock->delay_ns, "sync0_ns", (int)clock->sync0_ns, "sync1_ns",
                     (int)clock->sync1_ns, "shift_ns", (int)clock->shift_ns, "deviation_ns", (int)clock->deviation_ns,
                     "maximum_ns", (int)clock->maximum_ns, "losses", (json_int_t)clock->losses);
}

/* Nothing of a slave that takes part. */
static void tell_presence(json_t *slave, const view_t *view, uint32_t position)
{
    char text[CM1E_PRESENCE_TEXT];
    const cm1e_presence_t presence = cm1e_bus_presence(view->bus, position);
    if (presence == CM1E_PRESENCE_THERE)
        return;
    cm1e_bus_presence_text(view->bus, position, text, sizeof text);
    json_object_set_new(slave, "presence", json_integer(presence));
    json_object_set_new(slave, "presence_text", cm1e_json_text(text));
}

json_t *cm1e_show_slaves(const view_t *view)
{
    json_t *all = json_array();
    for (uint32_t i = 0; i < view->slave_count; i++) {
        const cm1e_slave_info_t *info = cm1e_bus_slave(view->bus, i + 1);
        json_t *slave = json_object(), *motors = json_array();
        json_object_set_new(slave, "position", json_integer(info->position));
        json_object_set_new(slave, "name", cm1e_json_text(info->name));
        json_object_set_new(slave, "vendor_id", number(info->vendor_id));
        json_object_set_new(slave, "product_code", number(info->product_code));
        json_object_set_new(slave, "revision", number(info->revision));
        json_object_set_new(slave, "serial_number", number(info->serial_number));
        json_object_set_new(slave, "alias", json_integer(info->alias));
        json_object_set_new(slave, "explicit_id", json_integer(info->explicit_id));
        json_object_set_new(slave, "al_state", json_integer(view->slaves[i].al_state));
        json_object_set_new(slave, "al_status_code", json_integer(view->slaves[i].al_status_code));
        json_object_set_new(slave, "kind", info->kind ? json_string(info->kind) : json_null());
        json_object_set_new(slave, "model", json_integer(info->model));
        for (size_t m = 0; m < sizeof info->motors; m++)
            json_array_append_new(motors, json_integer(info->motors[m]));
        json_object_set_new(slave, "motors", motors);
        json_object_set_new(slave, "software_version", cm1e_json_text(info->software_version));
        json_object_set_new(slave, "coe", json_boolean(cm1e_bus_slave_has_coe(view->bus, info->position)));
        json_object_set_new(slave, "open_ports", json_integer(cm1e_bus_open_ports(view->bus, info->position)));
        json_object_set_new(slave, "emergencies", emergencies_of(view->bus, info->position));
        tell_presence(slave, view, i + 1);
        if (view->slaves[i].clock.has_clock)
            json_object_set_new(slave, "clock", clock_of(&view->slaves[i].clock));
        json_array_append_new(all, slave);
    }
    return all;
}

json_t *cm1e_show_ring(const view_t *view)
{
    char text[EVENT_TEXT];
    const cm1e_bus_ring_t *ring = &view->ring;
    cm1e_bus_ring_text(view->bus, ring, text, sizeof text);
    return json_pack("{s:b, s:i, s:i, s:I, s:o}", "broken", ring->broken, "behind", ring->behind, "before",
                     ring->before, "breaks", (json_int_t)ring->breaks, "text", cm1e_json_text(text));
}

json_t *cm1e_show_strangers(const view_t *view)
{
    cm1e_stranger_t strangers[CM1E_STRANGERS];
    char text[EVENT_TEXT];
    json_t *all = json_array();
    const size_t count = cm1e_bus_strangers(view->bus, strangers, CM1E_STRANGERS);
    for (size_t i = 0; i < count; i++) {
        const cm1e_stranger_t *one = &strangers[i];
        cm1e_stranger_text(one, text, sizeof text);
        json_array_append_new(all, json_pack("{s:i, s:i, s:i, s:o, s:o, s:o, s:o, s:o}", "place", one->place, "alias",
                                             one->alias, "explicit_id", one->explicit_id, "vendor_id",
                                             number(one->vendor_id), "product_code", number(one->product_code),
                                             "revision", number(one->revision), "serial_number",
                                             number(one->serial_number), "text", cm1e_json_text(text)));
    }
    return all;
}

/* ---- statistics ------------------------------------------------------------------------------------------------- */

static json_t *distribution(const cm1e_distribution_t *d)
{
    json_t *histogram = json_array();
    unsigned used = CM1E_HISTOGRAM_BUCKETS;
    while (used > 0 && d->histogram[used - 1] == 0)
        used--;
    for (unsigned i = 0; i < used; i++)
        json_array_append_new(histogram, number(d->histogram[i]));
    return json_pack("{s:I, s:I, s:f, s:I, s:o}", "minimum_ns", (json_int_t)d->minimum_ns, "maximum_ns",
                     (json_int_t)d->maximum_ns, "mean_ns", d->count ? (double)d->sum_ns / (double)d->count : 0.0,
                     "count", (json_int_t)d->count, "histogram", histogram);
}

static json_t *clocks_of(const cm1e_bus_clocks_t *clocks)
{
    return json_pack("{s:i, s:f, s:I, s:f, s:I, s:I}", "reference", clocks->reference, "rate_ppm", clocks->rate_ppm,
                     "phase_error_ns", (json_int_t)clocks->phase_error_ns, "phase_mean_ns", clocks->phase_mean_ns,
                     "phase_maximum_ns", (json_int_t)clocks->phase_maximum_ns, "sync_losses",
                     (json_int_t)clocks->sync_losses);
}

static json_t *counters_of(const cm1e_bus_counters_t *counters)
{
    json_t *bus = json_object();
    json_object_set_new(bus, "cycles", number(counters->cycles));
    json_object_set_new(bus, "lost_frames", number(counters->lost_frames));
    json_object_set_new(bus, "working_counter_errors", number(counters->working_counter_errors));
    json_object_set_new(bus, "late_frames", number(counters->late_frames));
    json_object_set_new(bus, "unsent_frames", number(counters->unsent_frames));
    json_object_set_new(bus, "foreign_frames", number(counters->foreign_frames));
    json_object_set_new(bus, "mailbox_retries", number(counters->mailbox_retries));
    return bus;
}

static json_t *networks_of(const cm1e_scheduler_t *scheduler)
{
    json_t *networks = json_array();
    const cm1e_bus_t *bus;
    for (uint32_t i = 0; (bus = cm1e_scheduler_bus_at(scheduler, i)); i++) {
        cm1e_bus_counters_t counters;
        const uint64_t sync_losses = cm1e_scheduler_counted(scheduler, i, &counters);
        const cm1e_bus_config_t *config = cm1e_bus_configuration(bus);
        json_t *network = counters_of(&counters);
        json_object_set_new(network, "network", cm1e_json_text(config->name));
        json_object_set_new(network, "interface", cm1e_json_text(config->interface_name));
        json_object_set_new(network, "sync_losses", number(sync_losses));
        json_array_append_new(networks, network);
    }
    return networks;
}

json_t *cm1e_show_statistics(const cm1e_scheduler_t *scheduler)
{
    cm1e_scheduler_statistics_t s;
    cm1e_scheduler_statistics(scheduler, &s);
    json_t *shown = json_object();
    json_object_set_new(shown, "cycles", number(s.cycles));
    json_object_set_new(shown, "overruns", number(s.overruns));
    json_object_set_new(shown, "cycle_time", distribution(&s.cycle_time));
    json_object_set_new(shown, "wake_up_latency", distribution(&s.wake_up_latency));
    json_object_set_new(shown, "execution_time", distribution(&s.execution_time));
    json_object_set_new(shown, "bus", counters_of(&s.bus));
    json_object_set_new(shown, "networks", networks_of(scheduler));
    if (s.clocks.used)
        json_object_set_new(shown, "clocks", clocks_of(&s.clocks));
    json_object_set_new(shown, "realtime", json_boolean(s.realtime));
    json_object_set_new(shown, "advice", cm1e_json_text(s.advice));
    return shown;
}

/* ---- log -------------------------------------------------------------------------------------------------------- */

static json_t *event_of(const view_t *view, const cm1e_log_event_t *event)
{
    char text[EVENT_TEXT];
    json_t *shown = json_object();
    const int64_t axis = (int64_t)event->axis - view->first_axis;
    const bool own = event->axis >= 0 && axis >= 0 && axis < view->axis_count;
    cm1e_log_text(view->scheduler, event, text, sizeof text);
    json_object_set_new(shown, "number", number(event->number));
    json_object_set_new(shown, "time_ns", json_integer(event->time_ns));
    json_object_set_new(shown, "run_ns", json_integer(event->run_ns));
    json_object_set_new(shown, "kind", json_string(cm1e_log_kind_name(event->kind)));
    json_object_set_new(shown, "axis", own ? json_integer(axis + 1) : json_null());
    json_object_set_new(shown, "code", json_integer(event->code));
    json_object_set_new(shown, "detail", json_integer(event->detail));
    json_object_set_new(shown, "value", cm1e_show_real(event->value));
    json_object_set_new(shown, "bound", cm1e_show_real(event->bound));
    json_object_set_new(shown, "text", cm1e_json_text(text));
    return shown;
}

json_t *cm1e_show_log(const view_t *view, uint64_t after)
{
    cm1e_log_event_t events[EVENTS_OF_REPLY];
    uint64_t lost = 0;
    const size_t count = cm1e_log_read(view->scheduler, after, events, EVENTS_OF_REPLY, &lost);
    json_t *shown = json_array();
    for (size_t i = 0; i < count; i++)
        json_array_append_new(shown, event_of(view, &events[i]));
    return json_pack("{s:o, s:I, s:I}", "events", shown, "lost", (json_int_t)lost, "last",
                     (json_int_t)(count ? events[count - 1].number : after));
}
