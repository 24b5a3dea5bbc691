#include <math.h>

#include "motion/observer.h"

/* Counts: an estimate that is this close to rest counts as at rest. */
static const double at_rest = 1e-9;

void cm1e_observer_init(cm1e_observer_t *observer, double cycle_s, double time_constant_s, double delay_s,
                        int64_t counts)
{
    /* The three poles at t, so that the sum of all errors before, each weighted by t to its age, is least. */
    const double t = time_constant_s > 0 ? exp(-cycle_s / time_constant_s) : 0, rest = 1 - t;
    *observer = (cm1e_observer_t){
        .cycle_s = cycle_s,
        .delay_s = delay_s,
        .position_gain = 1 - t * t * t,
        .velocity_gain = 1.5 * rest * rest * (1 + t) / cycle_s,
        .acceleration_gain = rest * rest * rest / (cycle_s * cycle_s),
        .counts = counts,
    };
}

void cm1e_observer_reset(cm1e_observer_t *observer, int64_t counts)
{
    observer->counts = counts;
    observer->offset = observer->velocity = observer->acceleration = 0;
}

static void correct(cm1e_observer_t *observer, double error)
{
    observer->offset += observer->position_gain * error;
    observer->velocity += observer->velocity_gain * error;
    observer->acceleration += observer->acceleration_gain * error;
}

void cm1e_observer_step(cm1e_observer_t *observer, int64_t counts, bool valid)
{
    cm1e_observer_step_after(observer, observer->cycle_s, observer->delay_s, counts, valid);
}

void cm1e_observer_step_after(cm1e_observer_t *observer, double t, double delay_s, int64_t counts, bool valid)
{
    observer->delay_s = delay_s;
    observer->offset += t * (observer->velocity + t * (observer->acceleration / 2));
    observer->velocity += t * observer->acceleration;
    if (valid)
        correct(observer, (double)(counts - observer->counts) - observer->offset);
    const double whole = round(observer->offset);
    observer->counts += (int64_t)whole;
    observer->offset -= whole;
    if (valid && counts == observer->counts && fabs(observer->offset) < at_rest &&
        fabs(observer->velocity) * t < at_rest && fabs(observer->acceleration) * t * t < at_rest)
        cm1e_observer_reset(observer, counts); /* instead of continuing with ever smaller numbers */
}

cm1e_observed_t cm1e_observer_now(const cm1e_observer_t *observer)
{
    const double t = observer->delay_s, a = observer->acceleration;
    return (cm1e_observed_t){observer->counts, observer->offset + t * (observer->velocity + t * (a / 2)),
                             observer->velocity + t * a, a};
}
