#include <math.h>
#include <stdbool.h>

#include "core/extreme.h"
#include "motion/profile.h"

/** The last segment is computed backwards from the end state, so the profile reaches its end without a step, and a
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

cm1e_motion_bounds_t cm1e_profile_stretch_bounds(const cm1e_profile_stretch_t *stretch, double from_s, double until_s)
{
    const cm1e_motion_state_t a = cm1e_profile_stretch_state(stretch, from_s);
    const cm1e_motion_state_t b = cm1e_profile_stretch_state(stretch, until_s);
    double v = a.velocity;
    if (a.acceleration * b.acceleration < 0) { /* the velocity has an extremum in between */
        const double t = -stretch->origin.acceleration / stretch->jerk;
        v = cm1e_profile_stretch_state(stretch, stretch->origin_s + t).velocity;
    }
    const bool turns = a.velocity * b.velocity < 0 || a.velocity * v < 0 || b.velocity * v < 0;
    return (cm1e_motion_bounds_t){
        .velocity = turns ? INFINITY : larger(fabs(v), larger(fabs(a.velocity), fabs(b.velocity))),
        .acceleration = larger(fabs(a.acceleration), fabs(b.acceleration)),
        .jerk = fabs(stretch->jerk),
    };
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
    time_s = larger(0, time_s);
    cm1e_profile_stretch_at(profile, time_s, &stretch);
    *state = cm1e_profile_stretch_state(&stretch, time_s);
}

enum { PLACES = 3 };

/** Whether the motion may turn round between two states of constant jerk: the velocity has different signs there, or it
 *  comes nearer to zero at first, and goes away from it later. */
static inline bool may_turn(double v, double v_end, double a, double a_end)
{
    return v * v_end < 0 || (a * a_end < 0 && v * a <= 0);
}

/** Where a segment begins, and where it turns: besides its start it can do so where its velocity is zero, v + a t + j
 *  t2 / 2 = 0. In order; a missing one equals the one before. */
static void turning_places(const cm1e_profile_t *profile, int index, double begin, double position[PLACES])
{
    const cm1e_profile_segment_t *segment = &profile->segments[index];
    const cm1e_profile_stretch_t stretch = stretch_of(profile, index);
    const double v = segment->start.velocity, a = segment->start.acceleration, j = segment->jerk;
    const double root = sqrt(larger(0, a * a - 2 * j * v)), sum = -(a + copysign(root, a));
    const double one = 2 * v / sum, other = sum / j, times[PLACES] = {0, smaller(one, other), larger(one, other)};
    position[0] = begin;
    for (int i = 1; i < PLACES; i++) {
        const bool inside = times[i] >= 0 && times[i] < stretch.until_s - stretch.from_s;
        position[i] = inside ? cm1e_profile_stretch_state(&stretch, stretch.from_s + times[i]).position
                             : position[i - 1];
    }
}

/** Calls turning_places() for a segment that may turn; else returns false, and `*begin` is its only place. */
static inline bool places(const cm1e_profile_t *profile, int index, double *begin, double position[PLACES])
{
    const cm1e_profile_segment_t *segment = &profile->segments[index];
    const double v = segment->start.velocity, a = segment->start.acceleration;
    bool turns;
    if (index < profile->segment_count - 1) {
        *begin = segment->start.position;
        turns = may_turn(v, segment[1].start.velocity, a, a + (segment[1].start_s - segment->start_s) * segment->jerk);
    } else {
        /* With jerk its acceleration comes to zero exactly at the end, so in between it does not change its sign. */
        const cm1e_profile_stretch_t stretch = stretch_of(profile, index);
        *begin = cm1e_profile_stretch_state(&stretch, stretch.from_s).position;
        turns = may_turn(v, profile->end.velocity, a, segment->jerk == 0 ? a : 0);
    }
    if (turns)
        turning_places(profile, index, *begin, position);
    return turns;
}

void cm1e_profile_extent(const cm1e_profile_t *profile, double *lowest, double *highest)
{
    double least = profile->end.position, most = least;
    for (int i = 0; i < profile->segment_count; i++) {
        double begin, position[PLACES];
        const bool turns = places(profile, i, &begin, position);
        least = begin < least ? begin : least;
        most = begin > most ? begin : most;
        for (int k = 1; turns && k < PLACES; k++) {
            least = smaller(least, position[k]);
            most = larger(most, position[k]);
        }
    }
    *lowest = least;
    *highest = most;
}

double cm1e_profile_way_back(const cm1e_profile_t *profile, double sign)
{
    double back = 0, after = profile->end.position;
    for (int i = profile->segment_count - 1; i >= 0; i--) {
        double begin, position[PLACES];
        const bool turns = places(profile, i, &begin, position);
        for (int k = PLACES - 1; turns && k > 0; k--) {
            back += larger(0, copysign(1, sign) * (position[k] - after));
            after = position[k];
        }
        back += larger(0, copysign(1, sign) * (begin - after));
        after = begin;
    }
    return back;
}
