/*
 * The actual value of an axis, as its slaves see it. The position of an encoder is a whole number of counts, a cycle
 * old, and sometimes missing. The filter (motion/observer.h) estimates the present position, as long as no more values
 * are missing than `lost_cycles_limit` allows. Velocity and acceleration are the differences of these positions,
 * because the set-points of the slave have these differences.
 */
#include <math.h>

#include "axis/axis_backlash.h"
#include "axis/axis_setpoint.h"
#include "axis/axis_signals.h"
#include "cm1e/clocks.h"
#include "core/extreme.h"
#include "coupling/coupling_private.h"

enum { DEFAULT_FILTER_CYCLES = 10 };

/* When the counts of this exchange were taken. The slave of an encoder takes them when the frame passes, which was sent
 * in the cycle before, however late that began; or with the last SYNC0 before that. What follows our set-points, or is
 * written by the program, goes on cycle by cycle. */
static int64_t taken_ns(const cm1e_axis_t *axis)
{
    const observed_t *own = &axis->followed->own;
    const int64_t sent_ns = cm1e_bus_sent_ns(axis->drive.bus), period_ns = own->sync0_ns;
    cm1e_bus_clocks_t clocks;
    if (period_ns == 0)
        return sent_ns;
    cm1e_bus_clocks(axis->drive.bus, &clocks);
    const int64_t behind_ns = (clocks.reference_ns - own->shift_ns) % period_ns; /* SYNC0: dc_pulses.c */
    return sent_ns - (behind_ns < 0 ? behind_ns + period_ns : behind_ns);
}

static void see_how_it_counts(cm1e_axis_t *axis)
{
    observed_t *own = &axis->followed->own;
    const uint16_t slave = cm1e_axis_encoder_slave(axis);
    cm1e_slave_clock_t clock = {0};
    own->counted = slave > 0;
    if (own->counted)
        cm1e_bus_slave_clock(axis->drive.bus, slave, &clock);
    own->sync0_ns = clock.sync0_ns;
    own->shift_ns = clock.shift_ns;
    own->taken_ns = taken_ns(axis);
    own->planned_ns = axis->now_ns;
}

static void look(cm1e_axis_t *axis, double since_s)
{
    observed_t *own = &axis->followed->own;
    const cm1e_observed_t seen = cm1e_observer_now(&own->filter);
    own->before = own->now;
    own->now.position = cm1e_position_plus((position_t){seen.counts, 0.0}, seen.offset);
    const double way = cm1e_position_minus(own->now.position, own->before.position) / axis->position.scale;
    own->now.velocity = way / since_s;
    own->now.acceleration = (own->now.velocity - own->before.velocity) / since_s;
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

static double filter_s(const cm1e_axis_t *axis)
{
    const double asked_s = axis->config->encoder_filter_s;
    return asked_s > 0.0 ? asked_s : DEFAULT_FILTER_CYCLES * axis->cycle_s;
}

static void begin(cm1e_axis_t *axis)
{
    observed_t *own = &axis->followed->own;
    const double velocity = first_velocity(axis), cycle_s = axis->cycle_s;
    cm1e_observer_init(&own->filter, cycle_s, filter_s(axis), cycle_s, axis_actual(axis).counts);
    own->filter.velocity = velocity;
    if (goes_as_told(axis))
        own->filter.acceleration = axis->setpoint.acceleration * axis->position.scale;
    see_how_it_counts(axis);
    look(axis, cycle_s);
    own->now = own->before = (from_t){.position = own->now.position, .velocity = velocity / axis->position.scale};
    own->before.position = cm1e_position_plus(own->now.position, -velocity * cycle_s);
    own->lost = 0;
    own->begun = axis->observed = true;
}

/* A cycle that began late is no motion of the encoder, and behind skipped cycles it has turned in all of that time. */
static void step_by_time(cm1e_axis_t *axis, bool fresh)
{
    observed_t *own = &axis->followed->own;
    const int64_t taken = taken_ns(axis), since_ns = taken - own->taken_ns, planned_ns = axis->now_ns - own->planned_ns;
    own->taken_ns = taken;
    own->planned_ns = axis->now_ns;
    cm1e_observer_step_after(&own->filter, (double)since_ns * 1e-9, (double)(axis->now_ns - taken) * 1e-9,
                             axis_actual(axis).counts, fresh);
    look(axis, planned_ns > 0 ? (double)planned_ns * 1e-9 : axis->cycle_s);
}

/* Whether the motor goes on while it gets no new targets, as it does in CSV. A motor that follows positions waits then,
 * and so does a virtual axis. */
static bool goes_by_itself(const cm1e_axis_t *axis)
{
    return axis->config->type == CM1E_AXIS_MOTOR && (axis->mode == CM1E_MODE_CSV || !goes_as_told(axis));
}

/* So long that all followers have stopped (scheduler.c), and an estimate would be far away. */
static bool was_suspended(const cm1e_axis_t *axis)
{
    static const int64_t longest_ns = INT64_C(100000000);
    const observed_t *own = &axis->followed->own;
    return own->counted && axis->now_ns - own->planned_ns > longest_ns;
}

void cm1e_coupling_observe(cm1e_axis_t *axis)
{
    observed_t *own = &axis->followed->own;
    const bool fresh = axis->drive.feedback.fresh;
    const uint32_t limit = cm1e_bus_configuration(axis->drive.bus)->lost_cycles_limit;
    if (was_suspended(axis))
        own->lost = UINT32_MAX;
    /* After a homing of the drive, or after a long silence, the position is not a motion from the last one. */
    const bool anew = !own->begun || drive_homes(axis) || own->lost > limit;
    if (anew && fresh) {
        begin(axis);
        return;
    }
    own->lost = fresh ? 0 : own->lost + (own->lost < UINT32_MAX);
    if (own->lost > limit) /* no slave sees it, and an estimate that went on for days would leave the range */
        return;
    if (own->counted || goes_by_itself(axis)) {
        step_by_time(axis, fresh);
        return;
    }
    own->taken_ns = taken_ns(axis);
    own->planned_ns = axis->now_ns;
    cm1e_observer_step(&own->filter, axis_actual(axis).counts, fresh);
    look(axis, axis->cycle_s);
}

/* An encoder of a slave turns evenly, whatever happens to frames and cycles. */
static bool is_disturbed(const link_t *link)
{
    return link->source == mcActualValue && link->master && !link->master->followed->own.counted;
}

uint32_t cm1e_coupling_settles_in(const cm1e_axis_t *axis)
{
    static const double time_constants = 10.0; /* of a filter of third order: by then 0.3 % are left */
    const follow_t *now = axis->coupling->now;
    double longest_s = 0.0;
    for (int i = 0; i < now->count; i++)
        if (is_disturbed(&now->links[i]))
            longest_s = larger(longest_s, filter_s(now->links[i].master));
    return (uint32_t)ceil(time_constants * longest_s / axis->cycle_s);
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
