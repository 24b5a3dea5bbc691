/* Stops along the path: as soon as the deceleration and jerk that were told allow, within what the axes allow on every
 * element that the stop leads over. */
#include <math.h>

#include "core/extreme.h"
#include "motion/path_private.h"

enum { GENTLE_STEPS = 6 };

/** How much longer than without a limit of jerk a stop may last that need not be sooner. */
static const double NEARLY_SOONEST = 1.02;

/** The velocity at a position that is not before those of the segments before `*segment`. */
static double velocity_at(const cm1e_profile_t *profile, double position, int *segment)
{
    while (*segment + 1 < profile->segment_count && profile->segments[*segment + 1].start.position <= position)
        ++*segment;
    const cm1e_profile_segment_t *at = &profile->segments[*segment];
    const bool last = *segment + 1 == profile->segment_count;
    const double most_s = (last ? profile->duration_s : at[1].start_s) - at->start_s;
    const double t = cm1e_path_time_of(&at->start, at->jerk, most_s, position - at->start.position);
    return at->start.velocity + t * (at->start.acceleration + t * (at->jerk / 2));
}

/** Whether it is not faster than the motion under way has to be. An acceleration under way has to come to 0 first. */
static bool is_slow_enough(const cm1e_profile_t *stop, const cm1e_motion_state_t *start, double length,
                           const cm1e_path_run_t *run)
{
    const double eased_to = smaller(cm1e_path_eased(start, run->limits.jerk), run->highest);
    return cm1e_path_keeps(stop, start, length, larger(run->limits.velocity, larger(start->velocity, eased_to)));
}

/** Whether a stop over so many elements keeps what they allow. */
static bool stop_keeps(cm1e_path_t *path, const cm1e_profile_t *stop, const cm1e_motion_state_t *start, int count,
                       double length, const cm1e_path_run_t *run)
{
    if (!is_slow_enough(stop, start, length, run))
        return false;
    double begin = run->length, slowest, fastest;
    int segment = 0;
    cm1e_path_velocities(stop, &slowest, &fastest);
    for (int i = run->count; i < count; i++) {
        const cm1e_path_element_t *element = cm1e_path_element(path, i);
        const double most = smaller(element->highest, element->passed) * (1 + 1e-9);
        /* With an acceleration it may yet get faster. */
        if (fastest > most && (start->acceleration > 0 || velocity_at(stop, begin, &segment) > most))
            return false;
        begin += element->length;
    }
    return true;
}

/** In one go, with the lowest of the limits of the motion itself. Lower limits make no stop shorter: one that ends
 *  behind an element is planned again only when the elements reach its end. `as_told`: it brakes as hard as it may. */
static bool find_even_stop(cm1e_path_t *path, double deceleration, double jerk, cm1e_profile_t *stop,
                           const cm1e_motion_state_t *start, const cm1e_path_run_t *run, bool *as_told)
{
    cm1e_motion_limits_t limits = {run->highest, run->limits.acceleration, deceleration, jerk};
    double length = 0, at_least = 0;
    *as_told = false;
    for (int i = 0; i < path->element_count; i++) {
        const cm1e_path_element_t *element = cm1e_path_element(path, i);
        if (i >= run->count && element->passed == 0)
            return false;
        limits.velocity = smaller(limits.velocity, element->highest);
        limits.acceleration = smaller(limits.acceleration, element->limits.acceleration);
        limits.deceleration = smaller(limits.deceleration, element->limits.deceleration);
        limits.jerk = smaller(limits.jerk, element->limits.jerk);
        length += element->length;
        if (at_least > length)
            continue;
        if (cm1e_profile_to_velocity(stop, start, 0, &limits) != CM1E_OK)
            return false;
        *as_told = limits.deceleration == deceleration && limits.jerk == jerk;
        if (stop->end.position <= length)
            return stop_keeps(path, stop, start, i + 1, length, run);
        if (-start->acceleration <= limits.deceleration)
            at_least = stop->end.position;
    }
    return false;
}

/** In one go, or in stages where this is over sooner: not where it brakes as hard as told nearly all the time. */
static bool find_soonest(cm1e_path_t *path, double deceleration, double jerk, cm1e_profile_t *stop,
                         const cm1e_motion_state_t *start)
{
    const cm1e_path_run_t run = cm1e_path_run(path, 0, path->element_count);
    cm1e_profile_t other;
    double end;
    bool as_told;
    const bool found = find_even_stop(path, deceleration, jerk, stop, start, &run, &as_told);
    if (as_told || (found && stop->duration_s * deceleration <= NEARLY_SOONEST * start->velocity))
        return found;
    if (cm1e_path_brake_in_stages(path, deceleration, jerk, start, &other, &end) &&
        (!found || other.duration_s < stop->duration_s) && is_slow_enough(&other, start, end, &run))
        *stop = other;
    else if (!found)
        return false;
    return true;
}

/** Of the limits between two, as far from the first one, by their logarithm. */
static double between(double gentle, double hard, double part)
{
    return hard > gentle ? gentle * pow(hard / gentle, part) : gentle;
}

/** As gentle as fits, where what was told does not fit into the way that is left: between that, or what the way needs
 *  at least, and the limits of the motion itself. */
static bool find_gentlest(cm1e_path_t *path, double deceleration, double jerk, cm1e_profile_t *stop,
                          const cm1e_motion_state_t *start)
{
    const cm1e_motion_limits_t most = cm1e_path_run(path, 0, path->element_count).limits;
    if (!find_soonest(path, larger(deceleration, most.deceleration), larger(jerk, most.jerk), stop, start))
        return false;
    double left = -start->position;
    for (int i = 0; i < path->element_count; i++)
        left += cm1e_path_element(path, i)->length;
    deceleration = larger(deceleration, start->velocity * start->velocity / 2 / left);
    double low = 0, high = 1;
    for (int i = 0; i < GENTLE_STEPS; i++) {
        const double middle = (low + high) / 2;
        cm1e_profile_t gentler;
        if (find_soonest(path, between(deceleration, most.deceleration, middle), between(jerk, most.jerk, middle),
                         &gentler, start)) {
            *stop = gentler;
            high = middle;
        } else {
            low = middle;
        }
    }
    return true;
}

bool cm1e_path_plan_stop(cm1e_path_t *path)
{
    const cm1e_motion_state_t start = {cm1e_path_here(path), path->along.velocity, path->along.acceleration};
    const double deceleration = path->stop.deceleration, jerk = path->stop.jerk;
    cm1e_profile_t stop;
    const bool as_told = find_soonest(path, deceleration, jerk, &stop, &start);
    if (!as_told && path->stopping) /* the one under way is over sooner, as what is left has its length */
        return true;
    if (!as_told && !find_gentlest(path, deceleration, jerk, &stop, &start))
        return false;
    cm1e_path_follow(path, &stop, &start);
    path->stopping = true;
    return true;
}
