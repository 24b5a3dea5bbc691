#include <math.h>

#include "motion/profile.h"

/** The last segment is reckoned backwards from the end state: so the profile runs into its end without a step, and a
 *  decelerating axis cannot pass its target by a rounding error. */
static cm1e_profile_stretch_t stretch_of(const cm1e_profile_t *profile, int index)
{
    const cm1e_profile_segment_t *segment = &profile->segments[index];
    cm1e_profile_stretch_t stretch = {segment->start_s, profile->duration_s, segment->start_s, segment->start,
                                      segment->jerk};
    if (index < profile->segment_count - 1) {
        stretch.until_s = segment[1].start_s;
    } else {
        stretch.origin_s = profile->duration_s;
        stretch.origin = profile->end;
        /* With jerk, the acceleration has come to zero at the end; with infinite jerk it drops to zero there. */
        stretch.origin.acceleration = segment->jerk == 0 ? segment->start.acceleration : 0;
    }
    return stretch;
}

void cm1e_profile_stretch_at(const cm1e_profile_t *profile, double time_s, cm1e_profile_stretch_t *stretch)
{
    if (!(time_s < profile->duration_s)) {
        *stretch = (cm1e_profile_stretch_t){profile->duration_s, INFINITY, profile->duration_s, profile->end, 0};
        stretch->origin.acceleration = 0;
        return;
    }
    int index = profile->segment_count - 1;
    while (index > 0 && time_s < profile->segments[index].start_s)
        index--;
    *stretch = stretch_of(profile, index);
}

void cm1e_profile_sample(const cm1e_profile_t *profile, double time_s, cm1e_motion_state_t *state)
{
    cm1e_profile_stretch_t stretch;
    time_s = fmax(time_s, 0);
    cm1e_profile_stretch_at(profile, time_s, &stretch);
    *state = cm1e_profile_stretch_state(&stretch, time_s);
}

void cm1e_profile_extent(const cm1e_profile_t *profile, double *lowest, double *highest)
{
    *lowest = *highest = profile->end.position;
    for (int i = 0; i < profile->segment_count; i++) {
        const cm1e_profile_segment_t *segment = &profile->segments[i];
        const cm1e_profile_stretch_t stretch = stretch_of(profile, i);
        /* Besides its start, a segment can turn where its velocity is zero: v + a t + j t2 / 2 = 0. */
        const double v = segment->start.velocity, a = segment->start.acceleration, j = segment->jerk;
        const double root = sqrt(fmax(0, a * a - 2 * j * v)), sum = -(a + copysign(root, a));
        const double times[] = {0, 2 * v / sum, sum / j};
        for (int k = 0; k < 3; k++) {
            if (!(times[k] >= 0 && times[k] < stretch.until_s - stretch.from_s))
                continue;
            const double position = cm1e_profile_stretch_state(&stretch, stretch.from_s + times[k]).position;
            *lowest = fmin(*lowest, position);
            *highest = fmax(*highest, position);
        }
    }
}
