#include "motion/slow_time.h"

#include <math.h>

#include "core/extreme.h"

/* What is left of it then is a step of the velocity by this part. */
static const double NOTHING = 1e-9;

void cm1e_slow_time_begin(cm1e_slow_time_t *slow, double factor)
{
    slow->missing = 1 - (1 - slow->missing) * factor;
    slow->rate = INFINITY;
}

void cm1e_slow_time_keep(cm1e_slow_time_t *slow, const cm1e_motion_limits_t *limits)
{
    const double m = slow->missing, v = limits->velocity, a = limits->acceleration, j = limits->jerk;
    const double b = 3 * larger(a, limits->deceleration), c = 3 * (1 - m) * j;
    const double by_jerk = isinf(j) ? INFINITY : 2 * c / (b + sqrt(b * b + 4 * v * c));
    slow->rate = smaller(slow->rate, smaller((2 - m) * a / v, by_jerk));
}

double cm1e_slow_time_step(cm1e_slow_time_t *slow, double time_s)
{
    if (slow->missing == 0)
        return time_s;
    const double m = slow->missing, fallen = -expm1(-slow->rate * time_s);
    slow->missing = m - m * fallen > NOTHING ? m - m * fallen : 0;
    return time_s - m * fallen / slow->rate;
}

void cm1e_slow_time_apply(const cm1e_slow_time_t *slow, cm1e_motion_state_t *state)
{
    const double pace = 1 - slow->missing;
    state->acceleration = pace * pace * state->acceleration + slow->rate * slow->missing * state->velocity;
    state->velocity *= pace;
}
