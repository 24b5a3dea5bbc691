/*
 * Approaches over the master's position: MC_GearInPos (4.7), and MC_CamIn with a MasterStartDistance. Until the master
 * reaches the place where the approach begins, the slave goes on with what it does (4.7, note 1). The command waits as
 * the first one, and its masters are looked at in every cycle. Then the coupling function is the curve of the approach,
 * and after the end of the curve it is the gear or the cam.
 */
#include <math.h>
#include <stdio.h>

#include "axis/axis_commands.h"
#include "axis/axis_events.h"
#include "axis/axis_limits.h"
#include "axis/axis_plan.h"
#include "axis/axis_position.h"
#include "core/extreme.h"
#include "coupling/coupling_private.h"

/* Tolerances for rounding: counts of a master, and a part of a limit. */
static const double same_place = 1e-3;
static const double relative_tolerance = 1e-6;

/* How many repetitions of the meeting place are tried. Each is farther away and leaves the slave more distance. */
enum { REPETITIONS = 4 };

/* ---- the coupling function --------------------------------------------------------------------------------------- */

static void arrive(follow_t *follow)
{
    link_t *link = &follow->links[0];
    const approach_t *approach = &follow->approach;
    follow->function = approach->then;
    follow->in_step = true;
    if (follow->cam.slot) {
        cm1e_cam_in_enter(follow, approach->sync);
        return;
    }
    follow->anchor = approach->end; /* the gear counts from the place where they met */
    link->origin = cm1e_position_plus(link->origin, approach->sync);
    link->seen.counts -= approach->sync;
}

/* The sign of the way of the master from the beginning of the curve to its end. */
static double way_sign(const approach_t *approach) { return approach->first < 0.0 ? 1.0 : -1.0; }

/* The point of the curve. A master that turns round, or goes away from the end, leaves the curve by its beginning.
 * There the curvature fades to 0, because a step of it would be a step of the acceleration. Beyond that the slave goes
 * on in a straight line. */
static cm1e_curve_point_t point_at(const approach_t *approach, double master)
{
    const double sign = way_sign(approach), back = (approach->first - master) * sign, fade = approach->fade;
    if (back <= 0.0)
        return cm1e_curve_at(&approach->curve, master);
    const cm1e_curve_point_t first = cm1e_curve_at(&approach->curve, approach->first);
    const double left = back < fade ? 1.0 - back / fade : 0.0;
    const double change = first.curvature * fade / 2.0; /* of the slope, over the whole fade */
    return (cm1e_curve_point_t){
        .position = first.position - sign * first.slope * back +
                    change * (back - fade / 3.0 * (1.0 - left * left * left)),
        .slope = first.slope - sign * change * (1.0 - left * left),
        .curvature = first.curvature * left,
    };
}

static void evaluate(cm1e_axis_t *axis, follow_t *follow, from_t *point)
{
    const approach_t *approach = &follow->approach;
    const link_t *link = &follow->links[0];
    const double counts = link->seen.counts - approach->sync, master = counts / link->master->position.scale;
    const double left = -master * way_sign(approach) * fabs(link->master->position.scale);
    if (left <= same_place) {
        arrive(follow);
        follow->function->evaluate(axis, follow, point);
        return;
    }
    const cm1e_curve_point_t here = point_at(approach, master);
    const cm1e_motion_state_t motion = cm1e_curve_motion(&here, link->seen.velocity, link->seen.acceleration);
    *point = (from_t){.position = cm1e_position_towards(approach->begin, motion.position * axis->position.scale),
                      .velocity = motion.velocity, .acceleration = motion.acceleration};
}

static double steepest(const cm1e_axis_t *axis, const follow_t *follow, int link)
{
    return larger(follow->approach.steepest, follow->approach.then->steepest(axis, follow, link));
}

static const coupling_function_t approach_kind = {.evaluate = evaluate, .steepest = steepest};

/* ---- its beginning ----------------------------------------------------------------------------------------------- */

static bool beyond(cm1e_axis_t *axis, const char *what, const char *unit, double asked, double allowed, double now)
{
    if (asked <= larger(allowed, fabs(now)) * (1.0 + relative_tolerance))
        return false;
    axis->coupling->approach_refused = (approach_refused_t){what, unit, asked, allowed};
    return true;
}

/* Whether the curve keeps the limits of the slave at the present velocity of the master. It may begin with the
 * acceleration that the slave has, if that may be an acceleration and a deceleration of the axis. */
static bool keeps_limits(cm1e_axis_t *axis, const follow_t *follow, const from_t *from,
                         const cm1e_motion_limits_t *limits, const cm1e_curve_extremes_t *extremes)
{
    cm1e_motion_limits_t demand;
    const double either = smaller(axis->limits.maximum.acceleration, axis->limits.maximum.deceleration);
    const bool both = fabs(from->acceleration) <= either * (1.0 + relative_tolerance);
    cm1e_approach_demand(extremes, follow->links[0].seen.velocity, &demand);
    return !beyond(axis, "velocity", "u/s", demand.velocity, limits->velocity, from->velocity) &&
           !beyond(axis, "acceleration", "u/s2", demand.acceleration,
                   smaller(limits->acceleration, limits->deceleration), both ? from->acceleration : 0.0) &&
           !beyond(axis, "jerk", "u/s3", demand.jerk, limits->jerk, 0.0);
}

/* The curvature before the beginning fades with half of the jerk, at the present velocity of the master. The other half
 * is for the acceleration of the master. */
static void begin_fade(approach_t *approach, const cm1e_curve_point_t *begin, double master_velocity, double jerk)
{
    const double speed = fabs(master_velocity);
    approach->fade = 2.0 * fabs(begin->curvature) * speed * speed * speed / jerk;
    approach->steepest = fabs(begin->slope - way_sign(approach) * begin->curvature * approach->fade / 2.0);
}

static cm1e_error_t plan(cm1e_axis_t *axis, follow_t *follow, const from_t *from, const cm1e_motion_limits_t *limits,
                         double sync)
{
    approach_t *approach = &follow->approach;
    const link_t *link = &follow->links[0];
    const cm1e_motion_state_t slave = {0.0, from->velocity, from->acceleration};
    const double first = (link->seen.counts - sync) / link->master->position.scale;
    cm1e_curve_point_t begin, end = {.slope = link->ratio};
    cm1e_curve_t curve;
    cm1e_curve_extremes_t extremes;
    position_t meeting = approach->end;
    if (follow->cam.slot)
        cm1e_cam_in_point(axis, follow, sync, &meeting, &end);
    const double place = cm1e_position_minus(meeting, from->position) / axis->position.scale;
    axis->coupling->approach_refused = (approach_refused_t){0};
    if (!cm1e_curve_point_of(&begin, &slave, link->seen.velocity, link->seen.acceleration))
        return CM1E_ERROR_AXIS_SYNC_WAY;
    end.position = cm1e_approach_end(approach->mode, 0.0, begin.slope, place, end.slope, -first, approach->turn);
    if (!cm1e_curve_between(&curve, first, &begin, 0.0, &end))
        return CM1E_ERROR_AXIS_SYNC_WAY;
    cm1e_curve_extremes(&curve, &extremes);
    if (!keeps_limits(axis, follow, from, limits, &extremes))
        return CM1E_ERROR_AXIS_SYNC_WAY;
    if (!cm1e_axis_limits_contain_way(axis, from, extremes.lowest, extremes.highest))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    const double shift = (end.position - place) * axis->position.scale; /* turns of a modulo slave */
    if (!cm1e_position_reaches(meeting, shift))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    approach->curve = curve;
    approach->first = first;
    begin_fade(approach, &begin, link->seen.velocity, limits->jerk);
    approach->steepest = larger(approach->steepest, larger(fabs(extremes.least_slope), fabs(extremes.most_slope)));
    approach->sync = sync;
    approach->begin = from->position;
    approach->end = cm1e_position_plus(meeting, shift);
    follow->cam.slave_zero = cm1e_position_plus(follow->cam.slave_zero, shift);
    return CM1E_OK;
}

/* The direction of the master during the approach: the sign of its way in counts. */
static double direction(const follow_t *follow)
{
    const double distance = follow->approach.start_distance;
    const link_t *link = &follow->links[0];
    return copysign(1.0, distance != 0.0 ? distance : link->seen.velocity * link->master->position.scale);
}

/* Counts of the master since the place where the approach begins; if that place repeats, since the last repetition. */
static double since_start(const follow_t *follow, double counts)
{
    const approach_t *approach = &follow->approach;
    const double since = (counts - (approach->sync - approach->start_distance)) * direction(follow);
    return approach->again > 0.0 ? since - floor(since / approach->again + 1e-12) * approach->again : since;
}

/* Counts that the master has to go, in its direction, to the place where the approach ends. */
static double ahead(const follow_t *follow)
{
    const approach_t *approach = &follow->approach;
    const double left = (approach->sync - follow->links[0].seen.counts) * direction(follow);
    const double next = approach->again > 0.0 ? left - floor(left / approach->again) * approach->again : left;
    return approach->again > 0.0 && next <= same_place ? next + approach->again : next;
}

cm1e_error_t cm1e_coupling_approach_begin(cm1e_axis_t *axis, follow_t *follow, const move_t *move, const from_t *from)
{
    const approach_t *approach = &follow->approach;
    const double counts = follow->links[0].seen.counts, sign = direction(follow);
    cm1e_motion_limits_t limits;
    cm1e_error_t error = cm1e_axis_limits_of(axis, from, move, &limits);
    if (error != CM1E_OK)
        return error;
    if (approach->start_distance != 0.0) {
        const double left = fabs(approach->start_distance) - since_start(follow, counts);
        if (left > same_place)
            return plan(axis, follow, from, &limits, counts + sign * left);
        axis->coupling->approach_refused = (approach_refused_t){0}; /* the master passed it in one cycle */
        return CM1E_ERROR_AXIS_SYNC_WAY;
    }
    const double next = ahead(follow);
    error = CM1E_ERROR_AXIS_SYNC_WAY;
    for (int i = 0; i < REPETITIONS && error == CM1E_ERROR_AXIS_SYNC_WAY && (i == 0 || approach->again > 0.0); i++)
        error = plan(axis, follow, from, &limits, counts + sign * (next + i * approach->again));
    return error;
}

/* ---- until it begins --------------------------------------------------------------------------------------------- */

/* Whether both axes are at standstill at the place where they are to meet. */
static bool met_already(const cm1e_axis_t *axis, follow_t *follow, const from_t *from)
{
    const approach_t *approach = &follow->approach;
    const link_t *link = &follow->links[0];
    const double tolerance_counts = 2.0, left = approach->sync - link->seen.counts;
    const double master = approach->again > 0.0 ? remainder(left, approach->again) : left;
    const double u = cm1e_position_minus(approach->end, from->position) / axis->position.scale;
    const double slave = (approach->turn > 0.0 ? remainder(u, approach->turn) : u);
    if (fabs(master) > tolerance_counts || fabs(slave * axis->position.scale) > tolerance_counts ||
        link->seen.velocity != 0.0 || from->velocity != 0.0)
        return false;
    follow->approach.sync = link->seen.counts + master;
    follow->approach.end = cm1e_position_plus(from->position, slave * axis->position.scale);
    return true;
}

cm1e_error_t cm1e_coupling_approach_prepare(cm1e_axis_t *axis, follow_t *follow, const move_t *move, const from_t *from)
{
    approach_t *approach = &follow->approach;
    const link_t *link = &follow->links[0];
    follow->function = &approach_kind;
    follow->in_step = false;
    follow->to_position = true;
    if (approach->start_distance != 0.0) {
        const double since = since_start(follow, link->seen.counts), all = fabs(approach->start_distance);
        const bool under_way = approach->again > 0.0 ? since <= same_place
                                                : since >= -same_place && since < all - same_place;
        approach->awaited = under_way ? AWAIT_NOTHING : AWAIT_PLACE;
    } else if (met_already(axis, follow, from)) {
        arrive(follow);
        return CM1E_OK;
    } else {
        approach->awaited = link->seen.velocity == 0.0 || ahead(follow) <= same_place ? AWAIT_MOTION : AWAIT_NOTHING;
    }
    return approach->awaited ? CM1E_OK : cm1e_coupling_approach_begin(axis, follow, move, from);
}

/* Whether the approach begins in this cycle: the master has passed its beginning, or has begun to move towards its
 * end. */
static bool due(const follow_t *follow, double before)
{
    const approach_t *approach = &follow->approach;
    const link_t *link = &follow->links[0];
    if (approach->awaited == AWAIT_MOTION)
        return link->seen.velocity != 0.0 && ahead(follow) > same_place;
    const double moved = (link->seen.counts - before) * direction(follow);
    const double since = since_start(follow, link->seen.counts);
    return since >= 0.0 && since < moved * (1.0 + relative_tolerance);
}

void cm1e_coupling_await_step(cm1e_axis_t *axis)
{
    coupling_t *c = axis->coupling;
    follow_t *next = axis->coupling->awaited;
    const double before = next->links[0].seen.counts;
    const from_t from = from_base(axis);
    const master_trouble_t trouble = cm1e_coupling_look(axis, next);
    if (!trouble && !due(next, before))
        return;
    const bool may_come = !trouble && next->approach.awaited == AWAIT_MOTION && next->links[0].seen.acceleration != 0.0;
    const move_t move = move_of_waiting(waiting_move(axis, 0));
    if (may_come && cm1e_coupling_approach_begin(axis, next, &move, &from) == CM1E_ERROR_AXIS_SYNC_WAY)
        return; /* the velocity of the master still changes; it may be right in a later cycle */
    c->due = true;
    c->due_error = trouble ? CM1E_ERROR_AXIS_MASTER_LOST : CM1E_OK;
    (void)cm1e_axis_begin_waiting(axis, &from, 0.0);
}

/* ---- MC_GearInPos ------------------------------------------------------------------------------------------------ */

static bool is_place(const cm1e_axis_t *axis, double units)
{
    position_t unused;
    return isfinite(units) && cm1e_axis_position_from_units(axis, units, &unused);
}

cm1e_error_t cm1e_gear_in_pos_prepare(cm1e_axis_t *axis, const move_t *move,
                                           const cm1e_axis_coupling_t *coupling, const from_t *from)
{
    follow_t *follow = cm1e_coupling_spare(axis);
    const cm1e_error_t error = cm1e_gear_prepare(axis, move, coupling, from);
    if (error != CM1E_OK)
        return error;
    if ((unsigned)coupling->sync_mode > mcSlowDown)
        return CM1E_ERROR_INVALID_ARGUMENT;
    const link_t *link = &follow->links[0];
    const cm1e_axis_t *master = link->master;
    approach_t *approach = &follow->approach;
    if (!is_place(master, coupling->master_sync_position) ||
        !cm1e_axis_can_count(master, coupling->master_start_distance) ||
        !cm1e_axis_position_from_units(axis, coupling->slave_sync_position, &approach->end))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    approach->then = follow->function;
    approach->mode = coupling->sync_mode;
    approach->turn = axis->position.modulo_range;
    approach->start_distance = coupling->master_start_distance * master->position.scale;
    approach->sync = (coupling->master_sync_position - cm1e_axis_units(master, link->origin)) * master->position.scale;
    approach->again = master->position.modulo_range * fabs(master->position.scale);
    return cm1e_coupling_approach_prepare(axis, follow, move, from);
}

void cm1e_coupling_approach_text(const cm1e_axis_t *axis, char *text, size_t size)
{
    const approach_refused_t *r = &axis->coupling->approach_refused;
    if (r->what)
        snprintf(text, size, "Axis \"%s\": the approach needs a %s of %.6g %s at the master's present velocity; up to "
                 "%.6g is allowed. Use a larger MasterStartDistance, or a slower master.",
                 axis->config->name, r->what, r->asked, r->unit, r->allowed);
    else
        snprintf(text, size, "Axis \"%s\": no approach is possible, because the master is at standstill while the "
                 "slave moves, or the master passes the whole distance within a cycle.", axis->config->name);
}
