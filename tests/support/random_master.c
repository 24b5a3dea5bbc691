#include "random_master.h"

random_master_t random_master_for(int axis, int follower, double ratio, double part)
{
    const cm1e_motion_limits_t *own = &axes_axis(axis)->limits.maximum, *its = &axes_axis(follower)->limits.maximum;
    const double r = fabs(ratio);
    const double a = fmin(own->acceleration, own->deceleration), b = fmin(its->acceleration, its->deceleration);
    return (random_master_t){
        .axis = axis, .seldom = 150, .far = INFINITY,
        .most = {.velocity = fmin(own->velocity, part * its->velocity / r), .acceleration = fmin(a, part * b / r),
                 .deceleration = fmin(a, part * b / r), .jerk = fmin(own->jerk, part * its->jerk / r)}};
}

random_master_t random_master_of_both(random_master_t one, const random_master_t *other)
{
    one.most.velocity = fmin(one.most.velocity, other->most.velocity);
    one.most.acceleration = fmin(one.most.acceleration, other->most.acceleration);
    one.most.deceleration = fmin(one.most.deceleration, other->most.deceleration);
    one.most.jerk = fmin(one.most.jerk, other->most.jerk);
    return one;
}

void random_master_command(const random_master_t *master)
{
    cm1e_axis_t *axis = axes_axis(master->axis);
    const cm1e_motion_limits_t *most = &master->most;
    const double now = cm1e_axis_line(axis, axis->setpoint.position) - master->middle;
    const double largest = one_in(3) ? 1.0 : one_in(4) ? uniform(0.001, 0.05) : uniform(0.05, 1.0);
    cm1e_axis_command_t command = {
        .kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = most->velocity * largest,
        .direction = one_in(2) ? mcPositiveDirection : mcNegativeDirection,
        .acceleration = most->acceleration * uniform(0.1, 1.0), .deceleration = most->deceleration * uniform(0.1, 1.0),
        .jerk = most->jerk * uniform(0.05, 1.0)};
    if (one_in(4)) {
        command.kind = CM1E_COMMAND_HALT;
    } else if (one_in(2) || isfinite(master->far)) {
        command.kind = CM1E_COMMAND_MOVE_RELATIVE;
        command.position = isfinite(master->far) ? uniform(-master->far, master->far) - now
                                                 : most->velocity * uniform(-0.5, 0.5);
    }
    cm1e_command_id_t id;
    (void)cm1e_axis_start(axis, &command, &id); /* what it refuses it does not do */
}

void random_master_drive(const random_master_t *master)
{
    if (one_in(master->seldom))
        random_master_command(master);
}
