/* The creation of an axis, and its cycle: inputs, then (after the programs) outputs. */
#include "axis/axis_api.h"

#include <math.h>
#include <stdlib.h>

#include "axis/axis_backlash.h"
#include "axis/axis_commands.h"
#include "axis/axis_device.h"
#include "axis/axis_driving.h"
#include "axis/axis_events.h"
#include "axis/axis_extras.h"
#include "axis/axis_guard.h"
#include "axis/axis_handle.h"
#include "axis/axis_in_position.h"
#include "axis/axis_lead.h"
#include "axis/axis_limits.h"
#include "axis/axis_pause.h"
#include "axis/axis_pursuit.h"
#include "axis/axis_position.h"
#include "axis/axis_power.h"
#include "axis/axis_setpoint.h"
#include "axis/axis_table.h"
#include "core/cache_line.h"
#include "core/clock.h"
#include "core/rare.h"

cm1e_error_t cm1e_axis_make(cm1e_axis_t **result, cm1e_bus_t *bus, uint32_t index, cm1e_diag_t *diag)
{
    *result = NULL;
    cm1e_axis_t *axis = cm1e_cache_lines(sizeof *axis);
    if (!axis)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for axis %u.", (unsigned)index);
    static const axis_events_t events = {cm1e_axis_error_stop, cm1e_axis_begin_next, cm1e_axis_methods};
    axis->events = &events;
    cm1e_axis_setpoint_init(axis);
    cm1e_error_t error = cm1e_drive_init(&axis->drive, bus, index, diag);
    if (error == CM1E_OK) {
        axis->config = axis->drive.config;
        error = cm1e_axis_limits_init(axis, diag);
    }
    if (error == CM1E_OK)
        error = cm1e_axis_table_init(axis, diag);
    if (error == CM1E_OK)
        error = cm1e_axis_drive_profile_init(axis, diag);
    if (error == CM1E_OK)
        error = cm1e_axis_probe_init(axis, diag);
    axis->override = axis->override_refused = (override_t){1.0, 1.0, 1.0};
    axis->mode = error == CM1E_OK && !cm1e_drive_supports(&axis->drive, CM1E_MODE_CSP) ? CM1E_MODE_CSV : CM1E_MODE_CSP;
    if (error != CM1E_OK) {
        cm1e_drive_free(&axis->drive);
        free(axis->set_aside.tables);
        free(axis->set_aside.driving);
        cm1e_axis_probe_free(axis);
        free(axis);
        return error;
    }
    cm1e_axis_signals_changed(axis);
    cm1e_axis_note_disturbed(axis);
    const int64_t cycle_ns = cm1e_bus_configuration(bus)->cycle_time_ns;
    axis->cycle_s = (double)(cycle_ns > 0 ? cycle_ns : MS_IN_NS) * 1e-9;
    cm1e_axis_guard_renew(axis);
    cm1e_axis_in_position_init(axis);
    cm1e_axis_steps_init(axis);
    axis->drive.command.mode = axis->mode;
    cm1e_axis_power_init(axis);
    *result = axis;
    return CM1E_OK;
}

void cm1e_axis_destroy(cm1e_axis_t *axis)
{
    if (!axis)
        return;
    cm1e_axis_lead_end(axis, CM1E_ERROR_FB_AXIS_REF);
    if (axis->handle)
        cm1e_handle_give_back(&cm1e_axis_places, axis->handle);
    cm1e_drive_free(&axis->drive);
    free(axis->set_aside.tables);
    free(axis->set_aside.driving);
    cm1e_axis_probe_free(axis);
    if (axis->motor_hooks)
        axis->motor_hooks->free(axis);
    if (axis->coupling_hooks)
        axis->coupling_hooks->free(axis);
    if (axis->homing_hooks)
        axis->homing_hooks->free(axis);
    free(axis);
}

AXIS_REF_t cm1e_axis_reference(const cm1e_axis_t *axis) { return (AXIS_REF_t){.Handle = axis->handle}; }

bool cm1e_axis_is_heard_alone(const cm1e_axis_t *axis) { return axis->config->optional; }

bool cm1e_axis_is_heard_with(const cm1e_axis_t *axis, const cm1e_axis_t *other)
{
    const bool alone = cm1e_axis_is_heard_alone(axis) || cm1e_axis_is_heard_alone(other);
    return axis->drive.bus == other->drive.bus && (!alone || axis->drive.position == other->drive.position);
}

void cm1e_axis_share_cycle(cm1e_axis_t *axis, const void *cycle) { axis->belongs.cycle = cycle; }

bool cm1e_axis_shares_cycle(const cm1e_axis_t *axis, const cm1e_axis_t *other)
{
    return axis->drive.bus == other->drive.bus || (axis->belongs.cycle && axis->belongs.cycle == other->belongs.cycle);
}

const cm1e_axis_config_t *cm1e_axis_configuration(const cm1e_axis_t *axis) { return axis->config; }

static bool powered_state(cm1e_axis_state_t state)
{
    return state != CM1E_AXIS_DISABLED && state != CM1E_AXIS_ERROR_STOP;
}

/* Whether a lag (counts) is larger than that of a motor that followed the ramp while it was offline. */
static bool was_offline(const cm1e_axis_t *axis, double lag)
{
    const double tolerance_counts = 50.0;
    return fabs(lag) > 2.0 * fabs(axis->setpoint.velocity * axis->position.scale) * axis->cycle_s +
           cm1e_axis_tolerance_counts(axis, tolerance_counts);
}

/* Monitors the lag. If the motor has lost the set-point, the set-point would make it jump later. So braking begins anew
 * at the position of the motor. In CSV an offline motor goes on, so a ramp of ErrorStop begins anew at the position
 * that it has reached. */
static void watch_lag(cm1e_axis_t *axis)
{
    const bool own = axis_holds(axis) || set_points_move(axis);
    const bool blind_before = axis->silence.blind;
    if (cm1e_axis_note_blind(axis, own && !axis->drive.feedback.fresh) || cm1e_axis_catches(axis))
        return;
    /* counts */
    const double lag = own ? cm1e_position_minus(axis->setpoint.position, axis_actual(axis)) + cm1e_axis_ran_on(axis)
                       : 0.0;
    const bool lost = fabs(lag) > axis->limits.max_lag * fabs(axis->position.scale);
    if (axis->state == CM1E_AXIS_ERROR_STOP && blind_before && axis->mode == CM1E_MODE_CSV && was_offline(axis, lag)) {
        cm1e_axis_brake_from_actual(axis);
    } else if (lost && axis->state != CM1E_AXIS_ERROR_STOP) { /* in Disabled: the ramp before torque off */
        if (!axis->limits.lag_monitoring)
            return;
        cm1e_axis_fail(axis, CM1E_ERROR_AXIS_LAG, lag / axis->position.scale, axis->limits.max_lag);
        if (!cm1e_drive_contradicts_itself(&axis->drive)) /* else the motor may have followed: the ramp goes on */
            cm1e_axis_brake_from_actual(axis);
    } else if (lost && (cm1e_drive_contradicts_itself(&axis->drive) || cm1e_axis_may_lead(axis))) {
        return;
    } else if (lost) {
        cm1e_axis_become_free(axis); /* the motor does not follow this ramp either */
    }
}

static bool asks_for_torque(const cm1e_axis_t *axis) { return axis->power.enable && !axis->power.shutting_down; }

/* Whether the loss of the bus is an error of this axis. It is none for an axis that has no torque and is not to get
 * any, nor for one without a device. */
static bool depends_on_bus(const cm1e_axis_t *axis)
{
    if (cm1e_drive_is_virtual(&axis->drive))
        return false;
    return axis->drive.command.enable || asks_for_torque(axis) || axis->state != CM1E_AXIS_DISABLED;
}

/* The short way of the inputs. Nothing was silent lately, and the drive is enabled, without a fault: of all that
 * cm1e_axis_inputs_any() looks at, only the measured values are new. */
bool cm1e_axis_inputs_ordinary(cm1e_axis_t *axis, cm1e_error_t received, cm1e_error_t health, int64_t now_ns)
{
    if (received != CM1E_OK || health != CM1E_OK || !cm1e_axis_hears_well(axis) ||
        axis->power.reset_state == CM1E_COMMAND_ACTIVE || !cm1e_drive_read_ordinary(&axis->drive, now_ns))
        return false;
    axis->now_ns = now_ns;
    axis->advanced = false;
    cm1e_axis_track(axis);
    if (axis->observed)
        axis->coupling_hooks->observe(axis);
    if (axis->signals.probes_armed > 0)
        cm1e_axis_probe_step(axis);
    if (fabs(cm1e_position_minus(axis->setpoint.position, axis_actual(axis))) >
        axis->limits.max_lag * fabs(axis->position.scale))
        watch_lag(axis);
    return true;
}

static void take_inputs(cm1e_axis_t *axis, cm1e_error_t received, cm1e_error_t health, int64_t now_ns)
{
    cm1e_drive_t *drive = &axis->drive;
    axis->now_ns = now_ns;
    axis->advanced = false;
    cm1e_drive_read(drive, received == CM1E_OK, now_ns);
    /* A good cycle may be one of the others, where the slave of this axis may come and go. */
    const bool alone = cm1e_axis_is_heard_alone(axis);
    cm1e_axis_note_answer(axis, received == CM1E_OK && (!alone || drive->answered),
                          health != CM1E_OK || (alone && drive->watch.lost));
    if (drive->feedback.fresh)
        cm1e_axis_track(axis);
    if (axis->observed)
        axis->coupling_hooks->observe(axis);
    if (axis->signals.probes_armed > 0 && drive->feedback.fresh)
        cm1e_axis_probe_step(axis);
    if (drive->watch.lost || (drive->watch.al_state & 0x0F) == CM1E_AL_INIT)
        cm1e_axis_set_homed(axis, false); /* it may have been switched off, and its counts may have another origin */
    /* The reset ends here, so that no program sees an axis in error whose drive has cleared its error already. */
    if (axis->power.reset_state == CM1E_COMMAND_ACTIVE)
        cm1e_axis_reset_step(axis);
    if (cm1e_drive_resetting(drive))
        return;
    if (health != CM1E_OK && depends_on_bus(axis))
        cm1e_drive_fail(drive, health);
    else if (asks_for_torque(axis) && !cm1e_drive_operational(drive)) /* although its frames are good */
        cm1e_drive_fail(drive, drive->watch.lost ? CM1E_ERROR_AXIS_OFFLINE : CM1E_ERROR_BUS_STATE);
    else if (powered_state(axis->state) && !drive_moves(axis) && !drive->feedback.enabled)
        cm1e_drive_fail(drive, CM1E_ERROR_DRIVE_ENABLE_LOST); /* an earlier reason stays, because it says more */
    if (drive->fault.error != CM1E_OK) {
        if (health != CM1E_OK && axis_led(axis))
            cm1e_axis_lead_fail(axis, drive->fault.error);
        else
            cm1e_axis_fail(axis, drive->fault.error, 0.0, 0.0);
        if (axis->fault.error == drive->fault.error)
            cm1e_axis_tell_device_error(axis, drive->fault.device_code);
    }
    if (health != CM1E_OK)
        cm1e_axis_hold_unheard(axis);
    watch_lag(axis);
}

CM1E_APART void cm1e_axis_inputs_any(cm1e_axis_t *axis, cm1e_error_t received, cm1e_error_t health, int64_t now_ns)
{
    take_inputs(axis, received, health, now_ns);
    cm1e_axis_note_disturbed(axis);
    cm1e_axis_power_check(axis);
}

void cm1e_axis_inputs(cm1e_axis_t *axis, cm1e_error_t received, cm1e_error_t health, int64_t now_ns)
{
    if (!cm1e_axis_inputs_ordinary(axis, received, health, now_ns))
        cm1e_axis_inputs_any(axis, received, health, now_ns);
}

/* The common case, tested at once: a motion goes on, and nothing has happened that could change it. */
static bool moves_on(const cm1e_axis_t *axis)
{
    return set_points_move(axis) && axis->state != CM1E_AXIS_DISABLED && axis_acts(axis);
}

/* The bus is silent, or the slave of this axis is, so the set-point stays. Axes that are heard may go on. */
static void stay(cm1e_axis_t *axis)
{
    const cm1e_axis_leader_t *leader = axis->leader;
    if (axis_follows(axis))
        axis->coupling_hooks->held(axis);
    else if (axis_led(axis) && leader->held)
        leader->held(leader->context, leader->index);
}

/* What is beside the motion, after it. */
CM1E_RARE static void step_extras(cm1e_axis_t *axis)
{
    if (axis_awaits(axis) && !axis->silence.frozen)
        axis->coupling_hooks->await_step(axis);
    if (axis_has_extra(axis, EXTRA_BACKLASH) && !axis->silence.frozen)
        cm1e_axis_backlash_step(axis);
    if (axis_has_extra(axis, EXTRA_OBJECTS))
        cm1e_axis_objects_step(axis);
}

static void after_motion(cm1e_axis_t *axis, bool undisturbed)
{
    if (axis->extras)
        step_extras(axis);
    if (!undisturbed || !set_points_move(axis))
        cm1e_axis_enable_step(axis);
}

void cm1e_axis_advance_any(cm1e_axis_t *axis)
{
    axis->advanced = true;
    cm1e_axis_look_anew(axis); /* those that follow it know nothing of this cycle ahead */
    if (axis->silence.silent_before > 0)
        cm1e_axis_after_silence(axis);
    if (axis_follows(axis) || axis_awaits(axis))
        axis->coupling_hooks->advance_masters(axis);
    if (axis_has_extra(axis, EXTRA_SIGNALS))
        cm1e_axis_signals_step(axis);
    const bool undisturbed = moves_on(axis);
    if (!undisturbed) {
        if (axis->motor_hooks)
            axis->motor_hooks->step(axis);
        cm1e_axis_power_step(axis);
    }
    if (axis->silence.frozen && set_points_move(axis))
        stay(axis);
    else if (!axis_has_extra(axis, EXTRA_PURSUIT) || !cm1e_axis_pursue(axis))
        cm1e_axis_motion_step(axis);
    after_motion(axis, undisturbed);
}

CM1E_APART bool cm1e_axis_advance_undecided(cm1e_axis_t *axis)
{
    bool over = false;
    if (cm1e_axis_ordinary_step(axis))
        return true;
    if (!cm1e_axis_led_step(axis, &over))
        cm1e_axis_advance_any(axis);
    else if (over)
        after_motion(axis, true);
    return true;
}

void cm1e_axis_outputs(cm1e_axis_t *axis)
{
    if (!axis->advanced) /* else a slave has advanced it already */
        cm1e_axis_advance(axis);
    cm1e_axis_write_set_point(axis);
    if (!cm1e_drive_write_ordinary(&axis->drive))
        cm1e_drive_write(&axis->drive);
}
