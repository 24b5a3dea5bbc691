/*
 * Touch probes (3.33, 3.34). The CM1-E has no latch (no 0x60B8). An edge is seen as an input that differs between two
 * samples, and its position is taken as the middle of the two positions. So the uncertainty is half the way between two
 * samples, plus the delay of the input in the device, which the manual does not state.
 *
 * A trigger on another slave is compared with the position that came with the same exchange. Each such signal has its
 * own sample before, because its slave may miss a cycle in which the motor did not.
 */
#include <math.h>
#include <stdlib.h>

#include "axis/axis_backlash.h"
#include "axis/axis_device.h"
#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"
#include "axis/axis_signals.h"
#include "axis/axis_text.h"

enum { ALL_PROBES = PROBES + WIRED_PROBES };

static uint16_t bit_of(cm1e_axis_trigger_t trigger) { return (uint16_t)(1u << (trigger.input - 1)); }

/* The place of a probe states its trigger. Those on other slaves are behind those of the motor. */
static unsigned place_of(cm1e_axis_trigger_t trigger)
{
    const int n = trigger.input >= CM1E_WIRED_FIRST ? CM1E_AXIS_INPUTS + trigger.input - CM1E_WIRED_FIRST
                                                    : trigger.input - 1;
    return 2u * (unsigned)n + trigger.falling;
}

static cm1e_axis_trigger_t trigger_at(int place)
{
    const int n = place / 2;
    return (cm1e_axis_trigger_t){
        .input = n >= CM1E_AXIS_INPUTS ? n - CM1E_AXIS_INPUTS + CM1E_WIRED_FIRST : n + 1,
        .falling = place % 2,
    };
}

/* Whether the drive itself latches the position at this edge. */
static bool is_latched(const cm1e_axis_t *axis, cm1e_axis_trigger_t trigger)
{
    return !cm1e_drive_is_virtual(&axis->drive) && cm1e_drive_has_probe(&axis->drive, trigger.input, trigger.falling);
}

static probe_t *probe_at(const cm1e_axis_t *axis, unsigned place)
{
    return place < PROBES ? &axis->signals.own->probes[place] : &axis->signals.wired->probes[place - PROBES];
}

static cm1e_error_t probe_of(cm1e_axis_t *axis, cm1e_axis_trigger_t trigger, probe_t **probe)
{
    *probe = NULL;
    if (is_latched(axis, trigger)) {
        *probe = probe_at(axis, place_of(trigger));
        return CM1E_OK;
    }
    const cm1e_error_t error = cm1e_axis_check_input(axis, trigger.input);
    if (error != CM1E_OK)
        return error;
    if (!cm1e_axis_sees_input(axis, trigger.input)) /* inputs by SDO are too late for this */
        return CM1E_ERROR_PDO_MAPPING;
    *probe = probe_at(axis, place_of(trigger));
    return CM1E_OK;
}

static probe_sample_t sample(const cm1e_axis_t *axis)
{
    return (probe_sample_t){
        .time_ns = axis->drive.actual.read_ns,
        .position = axis_actual(axis),
        .inputs = axis->drive.feedback.digital_inputs,
    };
}

/* The sample of a signal of another slave. */
static probe_sample_t wired_sample(const cm1e_axis_t *axis, int input)
{
    probe_sample_t now = sample(axis);
    now.inputs = cm1e_axis_input_level(axis, input);
    return now;
}

static void end(cm1e_axis_t *axis, probe_t *probe, cm1e_command_state_t state, cm1e_error_t error)
{
    probe->state = (uint8_t)state;
    probe->error = (int16_t)error;
    axis->signals.probes_armed--;
}

/* ---- windows ----------------------------------------------------------------------------------------------------- */

static cm1e_error_t check_window(const cm1e_axis_t *axis, double first, double last)
{
    position_t unused;
    if (!cm1e_axis_position_from_units(axis, first, &unused) || !cm1e_axis_position_from_units(axis, last, &unused))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    return first <= last || axis->position.modulo_range > 0.0 ? CM1E_OK : CM1E_ERROR_AXIS_POSITION_RANGE;
}

/* Whether a position is in the window. Both ends are included, with a tolerance of a count. */
static bool in_window(const cm1e_axis_t *axis, const probe_t *probe, double position)
{
    const double few = 0.01 / fabs(axis->position.scale);
    const bool above = position >= probe->first - few, below = position <= probe->last + few;
    return probe->first <= probe->last ? above && below : above || below;
}

/* ---- triggers ---------------------------------------------------------------------------------------------------- */

/* Whether a probe waits for the other edge of this input, so that the sample before it must stay. */
static bool other_edge_waits(const cm1e_axis_t *axis, cm1e_axis_trigger_t trigger)
{
    return probe_at(axis, place_of(trigger) ^ 1u)->state == CM1E_COMMAND_ACTIVE;
}

static cm1e_error_t arm(cm1e_axis_t *axis, cm1e_axis_trigger_t trigger, bool window, double first, double last,
                        uint32_t *id)
{
    *id = 0;
    probe_t *probe;
    cm1e_error_t error = probe_of(axis, trigger, &probe);
    if (error == CM1E_OK && window)
        error = check_window(axis, first, last);
    if (error == CM1E_OK && cm1e_axis_input_away(axis, trigger.input))
        error = CM1E_ERROR_AXIS_SIGNAL_AWAY;
    if (error != CM1E_OK)
        return error;
    if (!axis->drive.actual.seen || !axis->position.known)
        return CM1E_ERROR_AXIS_OFFLINE;
    if (axis->signals.probes_armed == 0)
        axis->signals.own->last = sample(axis);
    if (trigger.input >= CM1E_WIRED_FIRST && !other_edge_waits(axis, trigger))
        axis->signals.wired->last[trigger.input - CM1E_WIRED_FIRST] = wired_sample(axis, trigger.input);
    if (probe->state != CM1E_COMMAND_ACTIVE)
        axis->signals.probes_armed++;
    /* The number contains the place of the probe, by which it is found. */
    axis->signals.probe_count = axis->signals.probe_count % (UINT32_MAX / ALL_PROBES - 1) + 1;
    *id = axis->signals.probe_count * ALL_PROBES + place_of(trigger);
    *probe = (probe_t){.id = *id, .state = CM1E_COMMAND_ACTIVE, .window = window, .first = first, .last = last};
    if (is_latched(axis, trigger))
        cm1e_drive_probe_arm(&axis->drive, trigger.input, trigger.falling);
    return CM1E_OK;
}

cm1e_error_t cm1e_axis_probe(cm1e_axis_t *axis, cm1e_axis_trigger_t trigger, bool window, double first, double last,
                             uint32_t *id)
{
    const cm1e_error_t error = arm(axis, trigger, window, first, last, id);
    cm1e_axis_remember_not_set(axis, (not_set_t){.error = error, .what = NOT_SET_PROBE, .number = trigger.input});
    return error;
}

cm1e_probe_status_t cm1e_axis_probe_status(const cm1e_axis_t *axis, uint32_t id)
{
    const uint32_t place = id % ALL_PROBES;
    if (id == 0 || (place >= PROBES && !axis->signals.wired) || probe_at(axis, place)->id != id)
        return (cm1e_probe_status_t){.state = CM1E_COMMAND_UNKNOWN};
    const probe_t *probe = probe_at(axis, place);
    cm1e_probe_status_t status = {.state = (cm1e_command_state_t)probe->state, .error = (cm1e_error_t)probe->error};
    if (status.state == CM1E_COMMAND_DONE) {
        status.position = probe->position;
        status.uncertainty = probe->uncertainty;
    }
    return status;
}

cm1e_error_t cm1e_axis_probe_abort(cm1e_axis_t *axis, cm1e_axis_trigger_t trigger)
{
    probe_t *probe;
    const cm1e_error_t error = probe_of(axis, trigger, &probe);
    if (error == CM1E_OK && is_latched(axis, trigger))
        cm1e_drive_probe_disarm(&axis->drive, trigger.input, trigger.falling);
    if (error == CM1E_OK && probe->state == CM1E_COMMAND_ACTIVE)
        end(axis, probe, CM1E_COMMAND_ABORTED, CM1E_OK);
    cm1e_axis_remember_not_set(axis, (not_set_t){.error = error, .what = NOT_SET_PROBE, .number = trigger.input});
    return error;
}

/* The counts got another origin between the samples: a motor behind a bridge that CML homes, a drive that was reset. */
static bool origin_moved(const cm1e_axis_t *axis, const probe_sample_t *before, const probe_sample_t *now)
{
    const double way = fabs(cm1e_position_minus(now->position, before->position));
    return !cm1e_drive_is_virtual(&axis->drive) &&
           way > (double)cm1e_drive_farthest(&axis->drive, now->time_ns - before->time_ns);
}

/* Whether the position of the edge is unknown: inputs were missing for too long, or the counts of the motor got another
 * meaning. */
static bool position_unknown(const cm1e_axis_t *axis, const probe_sample_t *before, const probe_sample_t *now)
{
    const double cycles = (double)(now->time_ns - before->time_ns) / (axis->cycle_s * 1e9);
    const uint32_t limit = cm1e_bus_configuration(axis->drive.bus)->lost_cycles_limit;
    return cycles > (limit ? limit : 3) + 0.5 || drive_homes(axis) || origin_moved(axis, before, now);
}

static void fail(cm1e_axis_t *axis, probe_t *probe, int input)
{
    end(axis, probe, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_PROBE);
    cm1e_axis_remember_not_set(axis, (not_set_t){.error = CM1E_ERROR_AXIS_PROBE, .what = NOT_SET_PROBE,
                                                 .number = input});
}

static void triggered(cm1e_axis_t *axis, probe_t *probe, int input, const probe_sample_t *before,
                      const probe_sample_t *now)
{
    if (position_unknown(axis, before, now)) {
        fail(axis, probe, input);
        return;
    }
    const double way = cm1e_position_minus(now->position, before->position);
    const position_t middle = cm1e_position_plus(before->position, way / 2.0);
    const double position = cm1e_axis_units(axis, middle);
    if (probe->window && !in_window(axis, probe, position))
        return;
    probe->position = position;
    probe->uncertainty = fabs(way / 2.0 / axis->position.scale);
    end(axis, probe, CM1E_COMMAND_DONE, CM1E_OK);
}

/* Takes the position from the latch of the drive, which is exact to the count. */
static void take_latched(cm1e_axis_t *axis, probe_t *probe, cm1e_axis_trigger_t trigger)
{
    int32_t raw;
    if (!cm1e_drive_probe_taken(&axis->drive, trigger.input, trigger.falling, &raw))
        return;
    if (drive_homes(axis)) {
        fail(axis, probe, trigger.input);
        return;
    }
    const int64_t way = (int32_t)((uint32_t)raw - (uint32_t)axis->position.raw);
    const double position = cm1e_axis_units(axis, cm1e_axis_load(axis, axis->position.actual_counts + way));
    if (probe->window && !in_window(axis, probe, position)) {
        cm1e_drive_probe_arm(&axis->drive, trigger.input, trigger.falling);
        return;
    }
    probe->position = position;
    probe->uncertainty = 0.5 / fabs(axis->position.scale);
    end(axis, probe, CM1E_COMMAND_DONE, CM1E_OK);
}

static void step_own(cm1e_axis_t *axis, int place, const probe_sample_t *before, const probe_sample_t *now)
{
    probe_t *probe = &axis->signals.own->probes[place];
    const cm1e_axis_trigger_t trigger = trigger_at(place);
    const unsigned bit = bit_of(trigger);
    if (is_latched(axis, trigger))
        take_latched(axis, probe, trigger);
    else if ((before->inputs ^ now->inputs) & bit && !(now->inputs & bit) == trigger.falling)
        triggered(axis, probe, trigger.input, before, now);
}

/* Both edges of a signal of another slave, if its slave took part in this exchange. */
static void step_wired(cm1e_axis_t *axis, int place)
{
    const int input = trigger_at(place).input;
    probe_sample_t *last = &axis->signals.wired->last[input - CM1E_WIRED_FIRST];
    const probe_sample_t before = *last, now = wired_sample(axis, input);
    if (!cm1e_axis_input_fresh(axis, input))
        return;
    *last = now;
    probe_t *probe = probe_at(axis, (unsigned)place + (now.inputs == 0));
    if (before.inputs != now.inputs && probe->state == CM1E_COMMAND_ACTIVE)
        triggered(axis, probe, input, &before, &now);
}

void cm1e_axis_probe_step(cm1e_axis_t *axis)
{
    const probe_sample_t before = axis->signals.own->last, now = sample(axis);
    const probe_t *probes = axis->signals.own->probes;
    const wired_probes_t *wired = axis->signals.wired;
    axis->signals.own->last = now;
    for (int i = 0; i < PROBES; i++)
        if (probes[i].state == CM1E_COMMAND_ACTIVE)
            step_own(axis, i, &before, &now);
    for (int i = 0; wired && i < WIRED_PROBES; i += 2)
        if (wired->probes[i].state == CM1E_COMMAND_ACTIVE || wired->probes[i + 1].state == CM1E_COMMAND_ACTIVE)
            step_wired(axis, PROBES + i);
}

cm1e_error_t cm1e_axis_probe_init(cm1e_axis_t *axis, cm1e_diag_t *diag)
{
    const bool wired = axis->config->wiring.input_count > 0;
    axis->signals.own = calloc(1, sizeof *axis->signals.own);
    axis->signals.wired = wired ? calloc(1, sizeof *axis->signals.wired) : NULL;
    if (axis->signals.own && (axis->signals.wired || !wired))
        return CM1E_OK;
    return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the touch probes of axis \"%s\".",
                         axis->config->name);
}

void cm1e_axis_probe_free(cm1e_axis_t *axis)
{
    free(axis->signals.own);
    free(axis->signals.wired);
}
