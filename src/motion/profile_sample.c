#include <math.h>

#include "motion/profile.h"

/** The state at a time within a segment. The last segment is reckoned backwards from the end state: so the profile runs
 *  into its end without a step, and a decelerating axis cannot pass its target by a rounding error. */
static void evaluate(const cm1e_profile_t *profile, int index, double time_s, cm1e_motion_state_t *state)
{
    const cm1e_profile_segment_t *segment = &profile->segments[index];
    cm1e_motion_state_t from = segment->start;
    double t = time_s - segment->start_s;
    if (index == profile->segment_count - 1) {
        from = profile->end;
        /* With jerk, the acceleration has come to zero at the end; with infinite jerk it drops to zero there. */
        from.acceleration = segment->jerk == 0 ? segment->start.acceleration : 0;
        t = time_s - profile->duration_s;
    }
    const double a = from.acceleration, j = segment->jerk;
    state->position = from.position + t * (from.velocity + t * (a * 0.5 + t * (j * (1.0 / 6.0))));
    state->velocity = from.velocity + t * (a + t * (j * 0.5));
    state->acceleration = a + t * j;
}

void cm1e_profile_sample(const cm1e_profile_t *profile, double time_s, cm1e_motion_state_t *state)
{
    if (!(time_s < profile->duration_s)) {
        *state = profile->end;
        state->position += profile->end.velocity * (time_s - profile->duration_s);
        return;
    }
    int index = profile->segment_count - 1;
    while (index > 0 && time_s < profile->segments[index].start_s)
        index--;
    evaluate(profile, index, fmax(time_s, 0), state);
}

void cm1e_profile_extent(const cm1e_profile_t *profile, double *lowest, double *highest)
{
    *lowest = *highest = profile->end.position;
    for (int i = 0; i < profile->segment_count; i++) {
        const cm1e_profile_segment_t *segment = &profile->segments[i];
        const double end_s = i + 1 < profile->segment_count ? segment[1].start_s : profile->duration_s;
        /* Besides its start, a segment can turn where its velocity is zero: v + a t + j t2 / 2 = 0. */
        const double v = segment->start.velocity, a = segment->start.acceleration, j = segment->jerk;
        const double root = sqrt(fmax(0, a * a - 2 * j * v)), sum = -(a + copysign(root, a));
        const double times[] = {0, 2 * v / sum, sum / j};
        for (int k = 0; k < 3; k++) {
            cm1e_motion_state_t state;
            if (!(times[k] >= 0 && times[k] < end_s - segment->start_s))
                continue;
            evaluate(profile, i, segment->start_s + times[k], &state);
            *lowest = fmin(*lowest, state.position);
            *highest = fmax(*highest, state.position);
        }
    }
}
