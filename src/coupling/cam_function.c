/* The coupling function of a cam (MC_CamIn): where the cam is placed, and which motion it needs from the slave
 * (coupling_cam.h). */
#include <math.h>

#include "axis/axis_limits.h"
#include "axis/axis_plan.h"
#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"
#include "core/extreme.h"
#include "coupling/coupling_private.h"

/* Tolerances: within them the slave has the position and the velocity of the cam. */
static const double same_place_counts = 10.0;
static const double same_motion_cycles = 1.0; /* cycles with the maximum acceleration of the axis */

static const double largest_scaling = 1e9;

/* ---- the coupling function --------------------------------------------------------------------------------------- */

/* A division is exact where a product with the inverse is not: a master at an end of the cam is exactly at it. */
static double place_in_cam(const cam_place_t *cam, const link_t *link, double counts)
{
    return ((counts + cam->away) / link->master->position.scale - cam->master_offset) / cam->master_scaling;
}

static double place_now(const follow_t *follow)
{
    return place_in_cam(&follow->cam, &follow->links[0], follow->links[0].seen.counts);
}

/* The place in the cam that counts. A single-shot cam that has ended stays at that end, whatever the master does
 * (4.1). */
static double place_to_be(const follow_t *follow)
{
    const cam_place_t *cam = &follow->cam;
    return cam->left == 0.0 ? place_now(follow) : cam->left * INFINITY;
}

/* The position of the slave by the cam, in u from the slave's zero. */
static double height(const cam_place_t *cam, const cm1e_cam_sample_t *sample)
{
    const cm1e_cam_t *table = &cam->slot->cam;
    const double turns = table->periodic ? sample->turn * table->advance : 0.0;
    return cam->slave_offset + cam->slave_scaling * (turns + sample->point.position);
}

/* How many ends of periods the master has passed or reached in this direction. */
static double ends_below(const cm1e_cam_t *table, const cm1e_cam_sample_t *sample, bool rising)
{
    return !table->periodic || rising || sample->phase == 0.0 ? sample->turn : sample->turn + 1.0;
}

/* Whether the master has passed an end of the profile in either direction (4.3): the end of a period, or the first or
 * last point of a single-shot cam. */
static bool came_over_end(const cam_place_t *cam, const cm1e_cam_sample_t *now)
{
    const cm1e_cam_t *table = &cam->slot->cam;
    if (!cam->sampled)
        return false;
    if (now->turn == cam->before.turn && now->phase != 0.0 && cam->before.phase != 0.0)
        return false;
    if (!table->periodic)
        return now->turn != cam->before.turn && now->turn != 0.0;
    return ends_below(table, now, true) > ends_below(table, &cam->before, true) ||
           ends_below(table, now, false) < ends_below(table, &cam->before, false);
}

/* Remembers the place for the next cycle. A single-shot cam has ended when the master leaves it at the other end than
 * that by which it came. At the end by which it came it may leave and come again. */
static void remember(cam_place_t *cam, const cm1e_cam_sample_t *now)
{
    if (!cam->sampled)
        cam->entered = now->turn;
    else if (!cam->slot->cam.periodic && cam->left == 0.0 && now->turn != 0.0 && now->turn != cam->entered)
        cam->left = now->turn;
    cam->before.turn = now->turn;
    cam->before.phase = now->phase;
    cam->sampled = true;
}

/* Called at the end of an approach. If that is an end of a single-shot cam, the master came onto the cam there. */
void cm1e_cam_in_enter(follow_t *follow, double counts)
{
    cam_place_t *cam = &follow->cam;
    const cm1e_cam_t *table = &cam->slot->cam;
    const double way = place_in_cam(cam, &follow->links[0], counts) - table->start, rounding = 1e-9 * table->length;
    if (table->periodic)
        return;
    cam->entered = cam->before.turn = way <= rounding ? -1.0 : way >= table->length - rounding ? 1.0 : 0.0;
    cam->sampled = true;
}

static inline void sample_point(const cm1e_axis_t *axis, const follow_t *follow, const cm1e_cam_sample_t *sample,
                                from_t *point)
{
    const cam_place_t *cam = &follow->cam;
    const master_view_t *seen = &follow->links[0].seen;
    const double steeper = cam->slave_scaling * cam->finer;
    const cm1e_curve_point_t here = {.slope = steeper * sample->point.slope,
                                     .curvature = steeper * sample->point.curvature * cam->finer};
    const cm1e_motion_state_t motion = cm1e_curve_motion(&here, seen->velocity, seen->acceleration);
    *point = (from_t){.position = cm1e_position_towards(cam->slave_zero, height(cam, sample) * axis->position.scale),
                      .velocity = motion.velocity, .acceleration = motion.acceleration};
}

static void evaluate(cm1e_axis_t *axis, follow_t *follow, from_t *point)
{
    cam_place_t *cam = &follow->cam;
    cm1e_cam_sample_t sample;
    cm1e_cam_sample(&cam->slot->cam, &cam->place, place_to_be(follow), &sample);
    if (came_over_end(cam, &sample)) {
        axis->coupling->end_of_profile = true;
        cm1e_axis_set_ends(axis, axis->setpoint.ends + 1);
    }
    remember(cam, &sample);
    sample_point(axis, follow, &sample, point);
}

static double steepest(const cm1e_axis_t *axis, const follow_t *follow, int link)
{
    (void)axis, (void)link;
    const cm1e_curve_extremes_t *e = &follow->cam.slot->cam.extremes;
    return larger(fabs(e->least_slope), fabs(e->most_slope)) *
           fabs(follow->cam.slave_scaling / follow->cam.master_scaling);
}

/* Whether slope and curvature are the same at both ends of a period. */
static bool is_seamless(const cm1e_cam_t *table)
{
    const cm1e_cam_knot_t *first = &table->knots[0], *last = &table->knots[table->count - 1];
    return table->periodic && first->slope == last->slope && first->curvature == last->curvature;
}

/* Whether the master comes over no end of the cam on its course. */
static bool stays_inside(const follow_t *follow, const course_t *master)
{
    const cm1e_cam_t *table = &follow->cam.slot->cam;
    const double end = cm1e_position_minus(master->end, follow->links[0].origin);
    const double a = (place_now(follow) - table->start) / table->length;
    const double b = (place_in_cam(&follow->cam, &follow->links[0], end) - table->start) / table->length;
    const double turn = floor(smaller(a, b)), rounding = 1e-9 * (1.0 + fabs(turn));
    return smaller(a, b) > turn + rounding && larger(a, b) < turn + 1.0 - rounding && (table->periodic || turn == 0.0);
}

/* The largest slope, curvature and third derivative of the cam as it is placed. */
static cm1e_curve_point_t steepest_point(const cam_place_t *cam)
{
    const cm1e_curve_extremes_t *e = &cam->slot->cam.extremes;
    const double finer = fabs(cam->finer), steep = fabs(cam->slave_scaling) * finer;
    return (cm1e_curve_point_t){.slope = steep * larger(fabs(e->least_slope), fabs(e->most_slope)),
                                .curvature = steep * finer * e->curvature, .third = steep * finer * finer * e->third};
}

/* Those of the cam anywhere, because a cam is passed within a few courses. The ends of a cam may be corners. Straight
 * lines have corners: of those, the master passes at most one in a cycle. */
static bool bounds(const cm1e_axis_t *axis, const follow_t *follow, const course_t *master, cm1e_motion_bounds_t *most)
{
    const cam_place_t *cam = &follow->cam;
    const cm1e_cam_t *table = &cam->slot->cam;
    const bool lines = table->curve == mcCamLinear;
    const cm1e_curve_point_t here = steepest_point(cam);
    const cm1e_motion_bounds_t *m = &master->most;
    if (!((lines && table->periodic) || is_seamless(table)) && !stays_inside(follow, master))
        return false;
    if (lines && m->velocity * fabs(cam->finer) * axis->cycle_s >= table->shortest)
        return false;
    const cm1e_motion_state_t motion = cm1e_curve_motion(&here, m->velocity, m->acceleration);
    const double corner = fabs(cam->slave_scaling * cam->finer) * table->corner * m->velocity / axis->cycle_s;
    *most = (cm1e_motion_bounds_t){motion.velocity, motion.acceleration + (lines ? corner : 0.0),
                              lines ? INFINITY : cm1e_curve_jerk(&here, m->velocity, m->acceleration, m->jerk)};
    return true;
}

static bool ordinary_anywhere(cm1e_axis_t *axis, follow_t *follow)
{
    from_t f;
    evaluate(axis, follow, &f);
    cm1e_coupling_put(axis, &f);
    return true;
}

/* Where the master stays between two points of the cam, it comes over no end. */
static bool ordinary(cm1e_axis_t *axis, follow_t *follow)
{
    cam_place_t *cam = &follow->cam;
    cm1e_cam_sample_t sample;
    if (!cam->sampled || cam->left != 0.0 || cam->before.phase == 0.0 ||
        !cm1e_cam_sample_again(&cam->slot->cam, &cam->place, place_now(follow), &sample) ||
        sample.turn != cam->before.turn)
        return ordinary_anywhere(axis, follow);
    cam->before.phase = sample.phase;
    from_t f;
    sample_point(axis, follow, &sample, &f);
    cm1e_coupling_put(axis, &f);
    return true;
}

/* A cam is rarely steep all the way: what counts is the way to where the master stands. */
static double braking(const cm1e_axis_t *axis, const follow_t *follow, const coupling_braking_t *asked)
{
    const cam_place_t *cam = &follow->cam;
    const double finer = fabs(cam->finer);
    if (cam->left != 0.0)
        return asked->hard; /* the slave stands */
    const cm1e_cam_braking_t in_cam = {.master = place_now(follow), .own = asked->own / fabs(cam->slave_scaling),
                                       .velocity = follow->links[0].master->setpoint.velocity * cam->finer,
                                       .gentle = asked->gentle * finer, .hard = asked->hard * finer,
                                       .cycle_s = axis->cycle_s, .steps = asked->steps};
    return larger(asked->gentle, cm1e_cam_hardest_braking(&cam->slot->cam, &in_cam) / finer);
}

static const coupling_function_t cam_kind = {evaluate, steepest, ordinary, bounds, braking};

/* At the ends of a single-shot cam it uses the slope inside the cam, because the master is about to be there. */
void cm1e_cam_in_point(const cm1e_axis_t *axis, const follow_t *follow, double counts, position_t *position,
                         cm1e_curve_point_t *point)
{
    const cam_place_t *cam = &follow->cam;
    const cm1e_cam_t *table = &cam->slot->cam;
    const double within = 1e-12 * table->length, once = 1.0 / cam->master_scaling;
    double place = place_in_cam(cam, &follow->links[0], counts);
    cm1e_cam_place_t unused = {0};
    cm1e_cam_sample_t sample;
    if (!table->periodic && place >= table->start - within && place <= table->start + table->length + within)
        place = larger(table->start + within, smaller(place, table->start + table->length - within));
    cm1e_cam_sample(table, &unused, place, &sample);
    *position = cm1e_position_towards(cam->slave_zero, height(cam, &sample) * axis->position.scale);
    *point = (cm1e_curve_point_t){.slope = cam->slave_scaling * once * sample.point.slope,
                                  .curvature = cam->slave_scaling * once * once * sample.point.curvature};
}

/* ---- where it is placed ------------------------------------------------------------------------------------------ */

static bool take_scaling(double asked, double *scaling)
{
    *scaling = asked == 0.0 ? 1.0 : asked;
    return fabs(*scaling) <= largest_scaling && fabs(*scaling) >= 1.0 / largest_scaling;
}

static cm1e_error_t take_numbers(const cm1e_axis_t *axis, const cm1e_axis_t *master,
                                 const cm1e_axis_coupling_t *coupling, cam_place_t *cam)
{
    if (!master)
        return CM1E_ERROR_AXIS_MASTER;
    if (!take_scaling(coupling->master_scaling, &cam->master_scaling) ||
        !take_scaling(coupling->slave_scaling, &cam->slave_scaling))
        return CM1E_ERROR_AXIS_RATIO;
    if (!cm1e_axis_can_count(axis, coupling->slave_offset) ||
        !cm1e_axis_can_count(master, coupling->master_offset) ||
        !cm1e_axis_can_count(master, coupling->master_start_distance) ||
        !cm1e_axis_can_count(master, coupling->master_sync_position))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    cam->finer = 1.0 / cam->master_scaling;
    cam->master_offset = coupling->master_offset;
    cam->slave_offset = coupling->slave_offset;
    return CM1E_OK;
}

/* A buffered cam begins at the end of the cam before it, and that end is usually inside a cycle. Then `*beyond` becomes
 * the distance of the master from that end (counts of the master), and `*slave` the slave's position at that end. In
 * all other cases both keep their values. */
static void begins_at_end(const cm1e_axis_t *axis, const follow_t *follow, double *beyond, position_t *slave)
{
    const follow_t *before = axis->coupling->now;
    if (!axis->coupling->at_end || before->function != &cam_kind || before->links[0].master != follow->links[0].master)
        return;
    const cam_place_t *cam = &before->cam;
    const cm1e_cam_t *table = &cam->slot->cam;
    const cm1e_cam_knot_t *first = &table->knots[0], *last = &table->knots[table->count - 1];
    const bool upper = table->periodic ? cam->before.phase > table->length / 2.0 : cam->before.turn > 0.0;
    const double turns = !table->periodic ? 0.0 : cam->before.turn + (upper ? 1.0 : 0.0);
    const double end = table->start + (table->periodic ? turns * table->length : upper ? table->length : 0.0);
    const double place = table->periodic || !upper ? first->slave : last->slave;
    *beyond = (place_now(before) - end) * cam->master_scaling * before->links[0].master->position.scale;
    *slave = cm1e_position_plus(cam->slave_zero, (cam->slave_offset + cam->slave_scaling *
                                                  (turns * table->advance + place)) * axis->position.scale);
}

static void find_master_zero(const follow_t *follow, cam_place_t *cam, double beyond)
{
    const link_t *link = &follow->links[0];
    const double units = cm1e_axis_units(link->master, link->origin);
    cam->away = cam->slot->master_absolute ? units * link->master->position.scale : beyond - link->seen.counts;
}

/* Decides where the slave position 0 of the cam is. On a modulo axis it is the turn in which the slave is nearest to
 * its position by the cam. */
static cm1e_error_t find_slave_zero(const cm1e_axis_t *axis, const cm1e_axis_coupling_t *coupling, const from_t *from,
                                    cam_place_t *cam, double here)
{
    if (coupling->start_mode == mcRelative || !cam->slot->slave_absolute) {
        const double way = (cam->slave_offset - here) * axis->position.scale;
        if (!cm1e_position_reaches(from->position, way))
            return CM1E_ERROR_AXIS_POSITION_RANGE;
        cam->slave_zero = cm1e_position_plus(from->position, way);
        return CM1E_OK;
    }
    if (axis->position.modulo_range == 0.0)
        return cm1e_axis_position_from_units(axis, 0.0, &cam->slave_zero) ? CM1E_OK : CM1E_ERROR_AXIS_POSITION_RANGE;
    const double way = here - cm1e_axis_units(axis, from->position);
    const double turns = round(way / axis->position.modulo_range);
    if (!cm1e_position_reaches(from->position, fabs(way * axis->position.scale) + fabs(here * axis->position.scale)))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    cam->slave_zero = cm1e_position_plus(from->position,
                                         (way - turns * axis->position.modulo_range - here) * axis->position.scale);
    return CM1E_OK;
}

/* Whether the software limits contain the whole cam, wherever the master goes. A cam that advances with every period
 * passes this check, because its end is not known. */
static bool contained(const cm1e_axis_t *axis, const from_t *from, const cam_place_t *cam)
{
    const cm1e_cam_t *table = &cam->slot->cam;
    if (table->periodic && table->advance != 0.0)
        return true;
    const double zero = cm1e_position_minus(cam->slave_zero, from->position) / axis->position.scale + cam->slave_offset;
    const double a = zero + cam->slave_scaling * table->extremes.lowest;
    const double b = zero + cam->slave_scaling * table->extremes.highest;
    return cm1e_axis_limits_contain_way(axis, from, smaller(a, b), larger(a, b));
}

static bool on_it(cm1e_axis_t *axis, const from_t *from, const from_t *wanted)
{
    cam_refused_t *refused = &axis->coupling->cams->refused;
    const double way = cm1e_position_minus(wanted->position, from->position);
    const double velocity = wanted->velocity - from->velocity;
    *refused = (cam_refused_t){cm1e_axis_units(axis, from->position), cm1e_axis_units(axis, wanted->position),
                               from->velocity, wanted->velocity};
    return fabs(way) <= cm1e_axis_tolerance_counts(axis, same_place_counts) &&
           fabs(velocity) <= same_motion_cycles * axis->cycle_s * smaller(axis->limits.maximum.acceleration,
                                                                       axis->limits.maximum.deceleration);
}

/* Prepares an approach to MasterSyncPosition, which is a place in the cam. In a periodic cam it repeats. */
static cm1e_error_t by_approach(cm1e_axis_t *axis, follow_t *follow, const move_t *move,
                           const cm1e_axis_coupling_t *coupling, const from_t *from)
{
    const cam_place_t *cam = &follow->cam;
    const cm1e_cam_t *table = &cam->slot->cam;
    const bool absolute = cam->slot->slave_absolute && coupling->start_mode != mcRelative;
    const double scale = follow->links[0].master->position.scale;
    approach_t *approach = &follow->approach;
    approach->then = follow->function;
    approach->mode = mcShortest;
    approach->turn = absolute ? axis->position.modulo_range : 0.0;
    approach->start_distance = coupling->master_start_distance * scale;
    approach->sync = (coupling->master_sync_position * cam->master_scaling + cam->master_offset) * scale - cam->away;
    approach->again = table->periodic ? fabs(table->length * cam->master_scaling * scale) : 0.0;
    return cm1e_coupling_approach_prepare(axis, follow, move, from);
}

cm1e_error_t cm1e_cam_in_prepare(cm1e_axis_t *axis, const move_t *move, const cm1e_axis_coupling_t *coupling,
                                   const from_t *from)
{
    follow_t *follow = cm1e_coupling_spare(axis);
    const cam_slot_t *slot = cm1e_cam_memory_find(axis, coupling->cam);
    *follow = (follow_t){.function = &cam_kind, .cam.slot = slot, .to_position = true, .in_step = true,
                         .waits_for_end = true};
    cam_place_t *cam = &follow->cam;
    if (!slot)
        return CM1E_ERROR_AXIS_CAM_ID;
    if ((unsigned)coupling->start_mode > mcRampIn)
        return CM1E_ERROR_INVALID_ARGUMENT;
    cm1e_error_t error = take_numbers(axis, cm1e_axis_from_reference(&coupling->master[0].axis), coupling, cam);
    if (error == CM1E_OK)
        error = cm1e_coupling_link(axis, follow, &coupling->master[0]);
    if (error != CM1E_OK)
        return error;
    cm1e_cam_sample_t sample;
    from_t wanted, start = *from;
    double beyond = 0.0;
    follow->linear = slot->cam.curve == mcCamLinear;
    if (!slot->master_absolute)
        begins_at_end(axis, follow, &beyond, &start.position);
    find_master_zero(follow, cam, 0.0);
    cm1e_cam_sample(&slot->cam, &cam->place, place_now(follow), &sample);
    error = find_slave_zero(axis, coupling, &start, cam, height(cam, &sample));
    if (error != CM1E_OK)
        return error;
    if (beyond != 0.0) {
        find_master_zero(follow, cam, beyond);
        cm1e_cam_sample(&slot->cam, &cam->place, place_now(follow), &sample);
    }
    sample_point(axis, follow, &sample, &wanted);
    if (!cm1e_position_in_range(wanted.position) || !contained(axis, from, cam))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    if (coupling->master_start_distance != 0.0)
        return by_approach(axis, follow, move, coupling, from);
    return coupling->start_mode == mcRampIn || on_it(axis, from, &wanted) ? CM1E_OK : CM1E_ERROR_AXIS_CAM_START;
}

static bool same_numbers(const cm1e_axis_coupling_t *a, const cm1e_axis_coupling_t *b)
{
    return a->master_offset == b->master_offset && a->slave_offset == b->slave_offset &&
           a->master_scaling == b->master_scaling && a->slave_scaling == b->slave_scaling;
}

cm1e_error_t cm1e_cam_in_update(cm1e_axis_t *axis, const cm1e_axis_coupling_t *coupling)
{
    cm1e_axis_coupling_t *inputs = &axis->coupling->inputs;
    const follow_t *now = axis->coupling->now;
    if (now->function != &cam_kind || same_numbers(inputs, coupling))
        return CM1E_OK;
    const from_t from = from_base(axis);
    cam_place_t cam = now->cam; /* with its zeros: relative values count from the start of the command (2.4.6) */
    cm1e_motion_limits_t limits;
    cm1e_error_t error = take_numbers(axis, now->links[0].master, coupling, &cam);
    if (error == CM1E_OK)
        error = cm1e_axis_limits_of(axis, &from, &axis->commands.move, &limits);
    if (error != CM1E_OK)
        return error;
    if (!contained(axis, &from, &cam))
        return CM1E_ERROR_AXIS_POSITION_RANGE;
    follow_t *follow = cm1e_coupling_spare(axis);
    *follow = *now;
    follow->links[0].listed = false;
    follow->cam = cam;
    follow->cam.sampled = false; /* a period that ends only by the new numbers is no end of profile */
    inputs->master_offset = coupling->master_offset;
    inputs->slave_offset = coupling->slave_offset;
    inputs->master_scaling = coupling->master_scaling;
    inputs->slave_scaling = coupling->slave_scaling;
    cm1e_coupling_follow(axis, follow, &from, &limits);
    return CM1E_OK;
}
