/*
 * MC_PhasingAbsolute, MC_PhasingRelative (4.8, 4.9): the slave sees its master shifted. The shift is a motion of its
 * own, in u of the master, from its present state to the commanded one. The coupling function transfers it to the
 * slave.
 *
 * A phasing is never the active command: it has a record of its own, and other phasings may wait behind it. The shift
 * belongs to the first master. It stays while the axis follows that master, also by another gear or cam.
 */
#include <math.h>
#include <stdio.h>

#include "axis/axis_commands.h"
#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"
#include "axis/axis_text.h"
#include "coupling/coupling_private.h"

static const double same_moment = 1e-6; /* cycles */
static const double relative_tolerance = 1e-9;

/* ---- what the slave can follow ----------------------------------------------------------------------------------- */

/* The maximum slope of the coupling function; 1 for a cam that does not move its slave. */
static double steepest(const cm1e_axis_t *axis)
{
    const follow_t *now = axis->coupling->now;
    const double slope = fabs(now->function->steepest(axis, now, 0));
    return slope > 0.0 ? slope : 1.0;
}

/* The limits of the shift in u of the master, if the slave has all its own limits for it. */
static cm1e_motion_limits_t most_of(const cm1e_axis_t *axis)
{
    const cm1e_motion_limits_t *most = &axis->limits.maximum;
    const double slope = steepest(axis);
    return (cm1e_motion_limits_t){most->velocity / slope, most->acceleration / slope, most->deceleration / slope,
                                  most->jerk / slope};
}

/* The default, 0, is half of the maximum: the other half is for the motion of the master. */
static bool choose(double asked, double most, double *value)
{
    *value = asked == 0.0 ? most / 2.0 : asked;
    return isfinite(asked) && asked >= 0.0 && asked <= most * (1.0 + relative_tolerance);
}

static cm1e_error_t limits_of(const cm1e_axis_t *axis, const move_t *move, cm1e_motion_limits_t *limits)
{
    const cm1e_motion_limits_t most = most_of(axis);
    if (!isfinite(move->velocity) || !(move->velocity > 0.0) ||
        move->velocity > most.velocity * (1.0 + relative_tolerance))
        return CM1E_ERROR_AXIS_VELOCITY_RANGE;
    limits->velocity = move->velocity;
    if (!choose(move->acceleration, most.acceleration, &limits->acceleration) ||
        !choose(move->deceleration, most.deceleration, &limits->deceleration) ||
        !choose(move->jerk, most.jerk, &limits->jerk))
        return CM1E_ERROR_AXIS_DYNAMICS_RANGE;
    return CM1E_OK;
}

/* In u of the master. */
static bool has_small(const cm1e_axis_t *axis, const move_t *move, small_input_t *found)
{
    static const override_t none = {1.0, 1.0, 1.0};
    const cm1e_motion_limits_t most = most_of(axis);
    return cm1e_axis_find_small(move, &most, &none, axis->coupling->now->links[0].master->position.scale, found);
}

static cm1e_error_t check(const cm1e_axis_t *axis, const move_t *move)
{
    const cm1e_axis_t *master = axis->coupling->now->links[0].master;
    cm1e_motion_limits_t unused;
    if (!cm1e_axis_can_count(master, move->position))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    return limits_of(axis, move, &unused);
}

/* Whether the slave keeps its maximum velocity with this shift, at the present velocity of the master. If the master or
 * the slope of the cam changes later, the guard checks every set-point. */
static bool fits_beside_master(const cm1e_axis_t *axis, const cm1e_profile_t *profile)
{
    const coupling_t *c = axis->coupling;
    const double slope = steepest(axis), most = axis->limits.maximum.velocity * (1.0 + relative_tolerance);
    const double master = c->now->links[0].seen.velocity - c->phase.velocity;
    const double before = fabs(c->now->links[0].seen.velocity) * slope;
    for (int i = 0; i < profile->segment_count; i++) {
        const double together = fabs(master + profile->segments[i].start.velocity) * slope;
        if (together > most && together > before * (1.0 + relative_tolerance))
            return false;
    }
    return true;
}

/* ---- one after the other ----------------------------------------------------------------------------------------- */

/* Plans the motion of the shift from its present state. */
static cm1e_error_t plan(const cm1e_axis_t *axis, const move_t *move, double *origin, cm1e_profile_t *profile)
{
    const coupling_t *c = axis->coupling;
    cm1e_motion_limits_t limits;
    *origin = move->kind == CM1E_COMMAND_PHASING_RELATIVE ? c->phase.position : 0.0;
    const cm1e_error_t error = limits_of(axis, move, &limits);
    if (error != CM1E_OK)
        return error;
    small_input_t small;
    if (cm1e_profile_to_position(profile, &c->phase, *origin + move->position, &limits) != CM1E_OK)
        return has_small(axis, move, &small) ? small.error : CM1E_ERROR_AXIS_DYNAMICS_RANGE;
    return fits_beside_master(axis, profile) ? CM1E_OK : CM1E_ERROR_AXIS_VELOCITY_RANGE;
}

static void begin(cm1e_axis_t *axis, cm1e_command_id_t id, double origin, const cm1e_profile_t *profile)
{
    phasing_t *phasing = &axis->coupling->phasing;
    phasing->id = id;
    phasing->origin = origin;
    phasing->profile = *profile;
    phasing->cycles = 0;
    phasing->moving = true;
    cm1e_axis_look_anew(axis);
}

static void record(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error)
{
    phasing_t *phasing = &axis->coupling->phasing;
    if (!phasing->id)
        return;
    phasing->ended = phasing->id;
    phasing->covered = axis->coupling->phase.position - phasing->origin;
    cm1e_axis_record(axis, phasing->id, state, error);
    phasing->id = 0;
}

/* Begins the next waiting phasing. One that cannot begin fails, and the one after it is tried (2.2.2, case 2). */
static void begin_waiting(cm1e_axis_t *axis)
{
    phasing_t *phasing = &axis->coupling->phasing;
    while (phasing->count > 0 && !phasing->id) {
        const move_t move = phasing->waiting[0];
        phasing->count--;
        for (int i = 0; i < phasing->count; i++)
            phasing->waiting[i] = phasing->waiting[i + 1];
        double origin;
        cm1e_profile_t profile;
        const cm1e_error_t error = plan(axis, &move, &origin, &profile);
        if (error != CM1E_OK) {
            cm1e_axis_record(axis, move.id, CM1E_COMMAND_ERROR, error);
            cm1e_axis_remember_end(axis, (cm1e_command_kind_t)move.kind, error);
        } else {
            begin(axis, move.id, origin, &profile);
        }
    }
}

/* Buffers a phasing. The blending modes act like mcBuffered, because a shift ends at rest. */
static cm1e_error_t buffer(cm1e_axis_t *axis, move_t *move)
{
    phasing_t *phasing = &axis->coupling->phasing;
    if (phasing->count == PHASINGS_WAITING)
        return CM1E_ERROR_FULL;
    move->id = cm1e_axis_next_id(axis);
    phasing->waiting[phasing->count++] = *move;
    return CM1E_OK;
}

static void forget_waiting(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error)
{
    phasing_t *phasing = &axis->coupling->phasing;
    for (int i = 0; i < phasing->count; i++)
        cm1e_axis_record(axis, phasing->waiting[i].id, state, error);
    phasing->count = 0;
}

static cm1e_error_t replace(cm1e_axis_t *axis, move_t *move)
{
    double origin;
    cm1e_profile_t profile;
    const cm1e_error_t error = plan(axis, move, &origin, &profile);
    if (error != CM1E_OK)
        return error;
    record(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    forget_waiting(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    move->id = cm1e_axis_next_id(axis);
    begin(axis, move->id, origin, &profile);
    return CM1E_OK;
}

cm1e_error_t cm1e_phasing_start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id)
{
    const coupling_t *c = axis->coupling;
    const cm1e_axis_t *master = command->coupling ? cm1e_axis_from_reference(&command->coupling->master[0].axis) : NULL;
    move_t move = cm1e_axis_move_of(command);
    if (!axis_follows(axis))
        return CM1E_ERROR_AXIS_NOT_COUPLED;
    if (!master || master != c->now->links[0].master)
        return CM1E_ERROR_AXIS_MASTER;
    if ((unsigned)command->buffer_mode > mcBlendingHigh)
        return CM1E_ERROR_AXIS_BUFFER_MODE;
    cm1e_error_t error = check(axis, &move);
    if (error == CM1E_OK)
        error = command->buffer_mode != mcAborting && c->phasing.id ? buffer(axis, &move) : replace(axis, &move);
    if (error == CM1E_OK)
        *id = move.id;
    return error;
}

/* ---- the cycle --------------------------------------------------------------------------------------------------- */

void cm1e_phasing_step(cm1e_axis_t *axis)
{
    coupling_t *c = axis->coupling;
    phasing_t *phasing = &c->phasing;
    const double time_s = (double)++phasing->cycles * axis->cycle_s;
    cm1e_profile_sample(&phasing->profile, time_s, &c->phase);
    if (time_s < phasing->profile.duration_s - same_moment * axis->cycle_s)
        return;
    c->phase = (cm1e_motion_state_t){phasing->profile.end.position, 0.0, 0.0};
    phasing->moving = false;
    record(axis, CM1E_COMMAND_DONE, CM1E_OK);
    begin_waiting(axis);
}

void cm1e_phasing_end(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error)
{
    if (!axis->coupling || !axis->coupling->phasing.id)
        return;
    phasing_t *phasing = &axis->coupling->phasing;
    record(axis, state, error);
    forget_waiting(axis, state, error);
    if (!axis_follows(axis))
        return;
    cm1e_axis_look_anew(axis);
    const cm1e_motion_limits_t most = most_of(axis);
    cm1e_motion_limits_t limits = {most.velocity, most.acceleration / 2.0, most.deceleration / 2.0, most.jerk / 2.0};
    phasing->cycles = 0;
    phasing->moving = cm1e_profile_to_velocity(&phasing->profile, &axis->coupling->phase, 0.0, &limits) == CM1E_OK;
}

void cm1e_phasing_stand(cm1e_axis_t *axis)
{
    coupling_t *c = axis->coupling;
    record(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    forget_waiting(axis, CM1E_COMMAND_ABORTED, CM1E_OK);
    cm1e_axis_look_anew(axis);
    c->phasing.moving = false;
    c->phase.velocity = c->phase.acceleration = 0.0;
}

void cm1e_phasing_forget(cm1e_axis_t *axis)
{
    cm1e_phasing_stand(axis);
    axis->coupling->phase.position = 0.0;
}

/* ---- what is told of it ------------------------------------------------------------------------------------------ */

bool cm1e_phasing_status(const cm1e_axis_t *axis, cm1e_command_id_t id, cm1e_command_status_t *status)
{
    const coupling_t *c = axis->coupling;
    if (!c || id == 0 || !c->phasing.id)
        return false;
    if (id == c->phasing.id) {
        *status = (cm1e_command_status_t){.state = CM1E_COMMAND_ACTIVE,
                                          .covered = c->phase.position - c->phasing.origin};
        return true;
    }
    for (int i = 0; i < c->phasing.count; i++)
        if (c->phasing.waiting[i].id == id) {
            *status = (cm1e_command_status_t){.state = CM1E_COMMAND_BUFFERED};
            return true;
        }
    return false;
}

double cm1e_phasing_covered(const cm1e_axis_t *axis, cm1e_command_id_t id)
{
    const coupling_t *c = axis->coupling;
    return c && id == c->phasing.ended ? c->phasing.covered : 0.0;
}

bool cm1e_phasing_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    const cm1e_axis_command_t *refused = &axis->commands.refused;
    if (kind_row(refused->kind)->plan != PLAN_PHASING || !axis_follows(axis))
        return false;
    const link_t *link = &axis->coupling->now->links[0];
    const cm1e_motion_limits_t most = most_of(axis);
    const move_t move = cm1e_axis_move_of(refused);
    small_input_t small;
    if (has_small(axis, &move, &small) && small.error == axis->commands.refusal) {
        cm1e_axis_small_text(axis, &small, text, size);
        return true;
    }
    snprintf(text, size, "Axis \"%s\": a phase shift of %.6g with velocity %.6g, acceleration %.6g, deceleration %.6g, "
             "jerk %.6g was commanded, in u of the master. The shift must be finite. The velocity must be above 0, and "
             "with that of the master (%.6g now) not above %.6g u/s. The others must be 0 (half of what the axis can "
             "do), or up to %.6g u/s2, %.6g u/s2 and %.6g u/s3.", axis->config->name, refused->position,
             refused->velocity,
             refused->acceleration, refused->deceleration, refused->jerk,
             link->seen.velocity - axis->coupling->phase.velocity, most.velocity, most.acceleration, most.deceleration,
             most.jerk);
    return true;
}
