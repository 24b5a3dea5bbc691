#include "axis_witness.h"

watch_t watch;

void watch_begin(void)
{
    const double now = cm1e_axis_units(axis, axis->setpoint.position);
    watch = (watch_t){.lowest = now, .highest = now, .stretch = 1.0, .run = ""};
}

/* What a cycle with acceleration within both limits can end with. */
static void watch_bounds(double t)
{
    const cm1e_motion_limits_t *most = &axis->limits.maximum;
    const double v = axis->setpoint.velocity, a = axis->setpoint.acceleration;
    const double most_a = fmax(most->acceleration, most->deceleration), slow = most_a * t;
    const double bound = fabs(v) < slow || watch.stretch > 1.0 ? most_a
                         : a * v > 0.0 ? most->acceleration : most->deceleration;
    WATCH(fabs(v) <= most->velocity * (1.0 + 1e-9), "velocity %.12g above %.12g", v, most->velocity);
    WATCH(fabs(a) <= bound * (1.0 + 1e-9), "acceleration %.12g above %.12g at %.12g u/s", a, bound, v);
}

static void watch_one(void)
{
    const bool ours = axis_holds(axis) || axis_on_profile(axis);
    const double t = axis->cycle_s, j = axis->limits.maximum.jerk;
    const double now = cm1e_axis_units(axis, axis->setpoint.position);
    watch.cycles++;
    watch.lowest = fmin(watch.lowest, now);
    watch.highest = fmax(watch.highest, now);
    if (ours && watch.ours && axis->state != CM1E_AXIS_ERROR_STOP) {
        const double step = cm1e_position_minus(axis->setpoint.position, watch.position) / axis->position.scale;
        const double v0 = watch.velocity, a0 = watch.acceleration, v = axis->setpoint.velocity;
        const double a = axis->setpoint.acceleration;
        const double noise = 1e-9 * (fabs(step) + fabs(v0) * t) + 1e-6 / fabs(axis->position.scale);
        watch_bounds(t);
        WATCH(fabs(a - a0) <= j * t * (1.0 + 1e-9) + 1e-9 * (fabs(a) + fabs(a0)), "jerk: acceleration %.12g -> %.12g",
              a0, a);
        WATCH(fabs(v - v0 - t * (a + a0) / 2) <= j * t * t / 4 * (1 + 1e-6) + 1e-9 * (fabs(v) + fabs(v0)),
              "velocity %.12g -> %.12g with acceleration %.12g -> %.12g", v0, v, a0, a);
        WATCH(fabs(step - t * v0 - t * t * a0 / 2) <= j * t * t * t / 6 * (1 + 1e-6) + noise,
              "position moved by %.12g at %.12g u/s", step, v0);
    }
    watch.ours = ours && axis->state != CM1E_AXIS_ERROR_STOP;
    watch.position = axis->setpoint.position;
    watch.velocity = axis->setpoint.velocity;
    watch.acceleration = axis->setpoint.acceleration;
}

void watch_cycles(int n)
{
    while (n-- > 0) {
        bench_cycles(1);
        watch_one();
    }
}
