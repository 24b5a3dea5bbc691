/*
 * The actual value of an axis, as its slaves see it. The position of an encoder is a whole number of counts, a cycle
 * old, and sometimes missing. The filter (motion/observer.h) estimates the present position, as long as no more values
 * are missing than `lost_cycles_limit` allows. Velocity and acceleration are the differences of these positions,
 * because the set-points of the slave have these differences.
 */
#include <math.h>

#include "axis/axis_backlash.h"
#include "axis/axis_setpoint.h"
#include "coupling/coupling_private.h"

enum { DEFAULT_FILTER_CYCLES = 10 };

static void look(cm1e_axis_t *axis)
{
    observed_t *own = &axis->followed->own;
    const cm1e_observed_t seen = cm1e_observer_now(&own->filter);
    own->before = own->now;
    own->now.position = cm1e_position_plus((position_t){seen.counts, 0.0}, seen.offset);
    const double way = cm1e_position_minus(own->now.position, own->before.position) / axis->position.scale;
    own->now.velocity = way / axis->cycle_s;
    own->now.acceleration = (own->now.velocity - own->before.velocity) / axis->cycle_s;
}

/* Whether our set-points move the axis. Else a hand or its drive may move it. */
static bool goes_as_told(const cm1e_axis_t *axis)
{
    return !axis_free(axis) && axis->setpoint.source != &cm1e_source_drive;
}

/* Counts/s: the velocity with which the filter begins. It is the set velocity of a motor that follows set-points, or
 * the velocity that the drive reports. An encoder begins with its first counts. */
static double first_velocity(const cm1e_axis_t *axis)
{
    if (axis->config->type == CM1E_AXIS_ENCODER)
        return 0.0;
    return !goes_as_told(axis) ? axis_actual_velocity(axis)
                                           : axis->setpoint.velocity * axis->position.scale;
}

static void begin(cm1e_axis_t *axis)
{
    observed_t *own = &axis->followed->own;
    const double constant_s = axis->config->encoder_filter_s, cycle_s = axis->cycle_s;
    const double velocity = first_velocity(axis);
    cm1e_observer_init(&own->filter, cycle_s, constant_s > 0.0 ? constant_s : DEFAULT_FILTER_CYCLES * cycle_s, cycle_s,
                       axis_actual(axis).counts);
    own->filter.velocity = velocity;
    if (goes_as_told(axis))
        own->filter.acceleration = axis->setpoint.acceleration * axis->position.scale;
    look(axis);
    own->now = own->before = (from_t){.position = own->now.position, .velocity = velocity / axis->position.scale};
    own->before.position = cm1e_position_plus(own->now.position, -velocity * cycle_s);
    own->lost = 0;
    own->begun = axis->observed = true;
}

void cm1e_coupling_observe(cm1e_axis_t *axis)
{
    observed_t *own = &axis->followed->own;
    const bool fresh = axis->drive.feedback.fresh;
    const uint32_t limit = cm1e_bus_configuration(axis->drive.bus)->lost_cycles_limit;
    /* After a homing of the drive, or after a long silence, the position is not a motion from the last one. */
    const bool anew = !own->begun || drive_homes(axis) || own->lost > limit;
    if (anew && fresh) {
        begin(axis);
        return;
    }
    own->lost = fresh ? 0 : own->lost + (own->lost < UINT32_MAX);
    if (own->lost > limit) /* no slave sees it, and an estimate that went on for days would leave the range */
        return;
    cm1e_observer_step(&own->filter, axis_actual(axis).counts, fresh);
    look(axis);
}

double cm1e_coupling_observed_velocity(const cm1e_axis_t *axis)
{
    return axis->followed->own.begun ? axis->followed->own.now.velocity : 0.0;
}

master_trouble_t cm1e_coupling_see_actual(cm1e_axis_t *master, bool of_this_cycle, from_t *seen)
{
    const observed_t *own = &master->followed->own;
    if (master->state == CM1E_AXIS_ERROR_STOP)
        return MASTER_ERROR_STOP;
    if (drive_homes(master))
        return MASTER_HOMING;
    if (!own->begun && master->drive.feedback.fresh)
        begin(master);
    if (!own->begun || own->lost > cm1e_bus_configuration(master->drive.bus)->lost_cycles_limit)
        return MASTER_UNSEEN;
    *seen = of_this_cycle ? own->now : own->before;
    return MASTER_GOOD;
}
