/* The velocity along the path. Joined elements are one run: one profile covers all of them, with the lowest of their
 * limits. At the beginning of a run the acceleration along the path is 0. Its velocity comes from a look-ahead from the
 * end of the path backwards, made twice: as commands and override request it, and as the limits of the axes require it.
 * If a run is entered with at most the second velocity, the next run can be entered in the same way. So every plan can
 * be followed to its end, and a new plan during the motion is used only if it keeps this condition. */
#include <math.h>

#include "core/extreme.h"
#include "motion/path_private.h"

enum { SLOWEST_STEPS = 16, WIDER_MOST = 6, MORE_TRIES = 40 };

/** By which part limits are exceeded at least where there is no plan within them: no more than by rounding. */
static const double LEAST_MORE = 1e-8;

static double factor(const cm1e_path_t *path) { return path->override > 0 ? path->override : 1; }

cm1e_path_run_t cm1e_path_run(cm1e_path_t *path, int first, int until)
{
    cm1e_path_run_t run = {0, 0, {INFINITY, INFINITY, INFINITY, INFINITY}, INFINITY};
    for (int i = first; i < until; i++) {
        const cm1e_path_element_t *element = cm1e_path_element(path, i);
        if (i > first && !element->joined)
            break;
        run.count++;
        run.length += element->length;
        run.highest = smaller(run.highest, element->highest);
        run.limits.velocity = smaller(run.limits.velocity, factor(path) * element->limits.velocity);
        run.limits.acceleration = smaller(run.limits.acceleration, element->limits.acceleration);
        run.limits.deceleration = smaller(run.limits.deceleration, element->limits.deceleration);
        run.limits.jerk = smaller(run.limits.jerk, element->limits.jerk);
    }
    run.limits.velocity = smaller(run.limits.velocity, run.highest);
    return run;
}

/* ---- looking ahead ----------------------------------------------------------------------------------------------- */

/** How fast a run may begin and end as the commands want it: beyond its own velocity only where it is of one segment,
 *  or another one would be passed too fast. */
static double most_at_ends(cm1e_path_t *path, int first, const cm1e_path_run_t *run)
{
    const bool one = cm1e_path_element(path, first)->tag == cm1e_path_element(path, first + run->count - 1)->tag;
    return one ? run->highest : run->limits.velocity;
}

/** Both in one, with the lower of their limits. */
static cm1e_path_run_t together(const cm1e_path_run_t *a, const cm1e_path_run_t *b)
{
    return (cm1e_path_run_t){
        a->count + b->count, a->length + b->length,
        {smaller(a->limits.velocity, b->limits.velocity), smaller(a->limits.acceleration, b->limits.acceleration),
         smaller(a->limits.deceleration, b->limits.deceleration), smaller(a->limits.jerk, b->limits.jerk)},
        smaller(a->highest, b->highest)};
}

/** How fast a run may be entered, of at most `most`, when it is left with `exit`; or that run and what the next one
 *  brakes over in one, without easing between them, to leave that with `wide_exit`, where this is faster. */
static double enter(const cm1e_path_run_t *run, double exit, const cm1e_path_run_t *next, double wide_exit,
                    double most, bool commanded, cm1e_path_run_t *braking)
{
    const double alone = smaller(most, cm1e_profile_entry_velocity(run->length, most, exit, &run->limits));
    *braking = *run;
    if (!next || alone >= most)
        return alone;
    const cm1e_path_run_t wide = together(run, next);
    const double limit = smaller(most, commanded ? wide.limits.velocity : wide.highest);
    const double entry = smaller(limit, cm1e_profile_entry_velocity(wide.length, limit, wide_exit, &wide.limits));
    if (!(entry > alone * (1 + CM1E_PATH_AS_LONG)))
        return alone;
    *braking = wide;
    return entry;
}

/** The velocity at which the elements before that one are left. */
static double exit_at(cm1e_path_t *path, int index, bool commanded)
{
    if (index >= path->element_count)
        return 0;
    const cm1e_path_element_t *element = cm1e_path_element(path, index);
    return commanded ? element->entry : element->hard_entry;
}

static void look_at_run(cm1e_path_t *path, int start, int last)
{
    cm1e_path_element_t *element = cm1e_path_element(path, start);
    cm1e_path_element_t *next = last < path->element_count ? cm1e_path_element(path, last) : NULL;
    const cm1e_path_run_t run = cm1e_path_run(path, start, last);
    const double ends = most_at_ends(path, start, &run), most = smaller(element->passed, run.highest);
    const double wanted = smaller(smaller(most, ends), factor(path) * element->junction);
    const bool stops = !next || next->passed == 0;
    const cm1e_path_run_t *soft = stops ? NULL : &next->braking, *hard = stops ? NULL : &next->hard_braking;
    element->hard_entry = enter(&run, smaller(exit_at(path, last, false), run.highest), hard,
                                hard ? smaller(exit_at(path, last + hard->count, false), run.highest) : 0, most, false,
                                &element->hard_braking);
    element->entry = enter(&run, smaller(exit_at(path, last, true), ends), soft,
                           soft ? smaller(exit_at(path, last + soft->count, true),
                                       smaller(run.limits.velocity, soft->limits.velocity)) : 0,
                           smaller(wanted, element->hard_entry), true, &element->braking);
}

/** For the runs behind the one it is on, which is `first` long. Elements before `changed` are as they were: as soon as
 *  one of them is to be entered as before, so are all before it. */
static void look_ahead(cm1e_path_t *path, int first, int changed)
{
    if (changed >= path->element_count)
        return;
    for (int last = path->element_count; last > first;) {
        int start = last - 1;
        while (cm1e_path_element(path, start)->joined)
            start--;
        if (start < first)
            break;
        cm1e_path_element_t *element = cm1e_path_element(path, start);
        const double soft = element->entry, hard = element->hard_entry;
        const int count = element->braking.count, hard_count = element->hard_braking.count;
        look_at_run(path, start, last);
        if (start < changed && element->entry == soft && element->hard_entry == hard &&
            element->braking.count == count && element->hard_braking.count == hard_count)
            break;
        last = start;
    }
}

/* ---- one run ----------------------------------------------------------------------------------------------------- */

void cm1e_path_velocities(const cm1e_profile_t *profile, double *lowest, double *highest)
{
    *lowest = *highest = profile->end.velocity;
    for (int i = 0; i < profile->segment_count; i++) {
        const cm1e_profile_segment_t *segment = &profile->segments[i];
        const double end_s = i + 1 < profile->segment_count ? segment[1].start_s : profile->duration_s;
        const double v = segment->start.velocity, a = segment->start.acceleration, j = segment->jerk;
        const bool turns = a * j < 0 && -a / j < end_s - segment->start_s;
        const double turn = turns ? v - a * a / j / 2 : v;
        *lowest = smaller(*lowest, smaller(v, turn));
        *highest = larger(*highest, larger(v, turn));
    }
}

bool cm1e_path_keeps(const cm1e_profile_t *profile, const cm1e_motion_state_t *start, double end, double highest)
{
    double low, high, slowest, fastest;
    cm1e_profile_extent(profile, &low, &high);
    cm1e_path_velocities(profile, &slowest, &fastest);
    const double slack = CM1E_PATH_AS_LONG * (end - start->position);
    return high <= end + slack && slowest >= -CM1E_PATH_AS_LONG * highest &&
           fastest <= highest * (1 + CM1E_PATH_AS_LONG);
}

static bool plan_to(cm1e_profile_t *profile, const cm1e_motion_state_t *start, const cm1e_path_run_t *run, double exit,
                    double highest)
{
    return cm1e_profile_to_state(profile, start, run->length, exit, &run->limits) == CM1E_OK &&
           cm1e_path_keeps(profile, start, run->length, highest);
}

/** From a state on the run to its end, to leave it with `soft`, or as near to that as can be, but not beyond `hard`.
 *  `faster`: it may get faster than the command says as long as its acceleration is brought to 0. */
static bool plan_run(cm1e_profile_t *profile, const cm1e_motion_state_t *start, const cm1e_path_run_t *run, double soft,
                     double hard, bool faster)
{
    const double ease = cm1e_path_eased(start, run->limits.jerk), commanded = larger(run->limits.velocity, soft);
    const double highest = larger(larger(commanded, start->velocity), faster ? smaller(ease, run->highest) : 0);
    const double exit = cm1e_profile_passing_velocity(start, run->length, soft, &run->limits);
    if (plan_to(profile, start, run, exit, highest))
        return true;
    /* Too fast to come down to that. */
    double high = smaller(hard, larger(ease, soft)), low = soft;
    if (!plan_to(profile, start, run, high, highest)) {
        high = smaller(hard, start->velocity);
        if (!plan_to(profile, start, run, high, highest))
            return false;
    }
    for (int i = 0; i < SLOWEST_STEPS && high - low > 1e-3 * high; i++) {
        const double middle = (low + high) / 2;
        cm1e_profile_t slower;
        if (plan_to(&slower, start, run, middle, highest)) {
            *profile = slower;
            high = middle;
        } else {
            low = middle;
        }
    }
    return true;
}

/** How fast to leave the run that begins with that element. */
static void exits(cm1e_path_t *path, int first, const cm1e_path_run_t *run, double *soft, double *hard)
{
    const int next = first + run->count;
    *soft = *hard = 0;
    if (next < path->element_count) {
        *soft = smaller(cm1e_path_element(path, next)->entry, most_at_ends(path, first, run));
        *hard = smaller(cm1e_path_element(path, next)->hard_entry, run->highest);
    }
}

void cm1e_path_follow(cm1e_path_t *path, const cm1e_profile_t *profile, const cm1e_motion_state_t *start)
{
    path->profile = *profile;
    path->time_s = 0;
    path->begin = 0;
    path->along = *start;
    path->stretch.until_s = -1;
    cm1e_path_look_anew(path);
}

/** Plans it in one with what follows, where it is within the limits of that already. */
static bool plan_wide(cm1e_path_t *path, const cm1e_motion_state_t *start, const cm1e_path_run_t *wide,
                      double velocity, cm1e_profile_t *profile)
{
    const double a = start->acceleration;
    if (larger(start->velocity, cm1e_path_eased(start, wide->limits.jerk)) > velocity ||
        a > wide->limits.acceleration || -a > wide->limits.deceleration)
        return false;
    double soft, hard;
    exits(path, 0, wide, &soft, &hard);
    return plan_run(profile, start, wide, soft, hard, false);
}

/** The time over a run of its own that begins with that element. */
static double time_over(cm1e_path_t *path, int first, const cm1e_path_run_t *run, double velocity)
{
    const cm1e_motion_state_t start = {0, velocity, 0};
    double soft, hard;
    cm1e_profile_t profile;
    exits(path, first, run, &soft, &hard);
    return plan_run(&profile, &start, run, soft, hard, false) ? profile.duration_s : INFINITY;
}

/** The run that it is on takes in what follows as long as that is no later: where it gets faster or slower over more
 *  than one run, its acceleration need not come to 0 between them. `planned`: there is a profile as it is. If not, it
 *  was entered with a velocity that it can only come down from over more. */
static bool widen(cm1e_path_t *path, const cm1e_motion_state_t *start, cm1e_path_run_t *run, cm1e_profile_t *profile,
                  bool planned)
{
    for (int i = 0; i < WIDER_MOST && run->count < path->element_count; i++) {
        const cm1e_path_element_t *next = cm1e_path_element(path, run->count);
        const bool at_pace = planned && profile->end.velocity >= smaller(run->limits.velocity, next->highest) * 0.999;
        if (next->passed == 0 || at_pace)
            break;
        cm1e_path_run_t wide = together(run, &next->braking);
        cm1e_profile_t wider;
        if (!plan_wide(path, start, &wide, wide.limits.velocity, &wider)) {
            wide = together(run, &next->hard_braking);
            if (planned || !plan_wide(path, start, &wide, wide.highest, &wider))
                break;
        }
        if (planned) {
            const double over_s = time_over(path, run->count, &next->braking, profile->end.velocity);
            if (wider.duration_s > (profile->duration_s + over_s) * (1 + CM1E_PATH_AS_LONG))
                break;
        }
        *profile = wider;
        *run = wide;
        planned = true;
    }
    return planned;
}

/** Returns false if nothing has changed. */
static bool plan_anew(cm1e_path_t *path, const cm1e_path_run_t *on, double soft, double hard, bool faster)
{
    const cm1e_motion_state_t start = {cm1e_path_here(path), path->along.velocity, path->along.acceleration};
    cm1e_path_run_t run = *on;
    cm1e_profile_t profile;
    const bool planned = plan_run(&profile, &start, &run, soft, hard, faster);
    if (!widen(path, &start, &run, &profile, planned))
        return false;
    for (int i = 1; i < run.count; i++)
        cm1e_path_element(path, i)->joined = true;
    cm1e_path_follow(path, &profile, &start);
    path->stopping = false;
    return true;
}

bool cm1e_path_plan(cm1e_path_t *path, int changed)
{
    const cm1e_path_run_t run = cm1e_path_run(path, 0, path->element_count);
    look_ahead(path, run.count, changed);
    if (path->stopping || run.count == 0)
        return true;
    double soft, hard;
    exits(path, 0, &run, &soft, &hard);
    return plan_anew(path, &run, soft, hard, false) ||
           (fabs(path->profile.end.position - path->begin - run.length) <= CM1E_PATH_AS_LONG * run.length &&
            path->profile.end.velocity <= hard * (1 + CM1E_PATH_AS_LONG));
}

static cm1e_path_run_t harder(const cm1e_path_run_t *run, double more)
{
    cm1e_path_run_t harder = *run;
    harder.highest *= 1 + more;
    harder.limits.acceleration *= 1 + more;
    harder.limits.deceleration *= 1 + more;
    harder.limits.jerk *= (1 + more) * (1 + more);
    return harder;
}

static bool keep_going_with(cm1e_path_t *path, const cm1e_motion_state_t *start, const cm1e_path_run_t *run, bool alone)
{
    cm1e_profile_t profile;
    double soft, hard;
    exits(path, 0, run, &soft, &hard);
    if (!(alone ? plan_run(&profile, start, run, soft, hard, false)
                : plan_wide(path, start, run, run->highest, &profile)))
        return false;
    for (int i = 1; i < run->count; i++)
        cm1e_path_element(path, i)->joined = true;
    cm1e_path_follow(path, &profile, start);
    return true;
}

/* The run may have been entered with a velocity that it can only come down from over more than itself. */
void cm1e_path_keep_going(cm1e_path_t *path)
{
    const cm1e_path_run_t alone = cm1e_path_run(path, 0, path->element_count);
    const cm1e_motion_state_t start = {cm1e_path_here(path), path->along.velocity, path->along.acceleration};
    const cm1e_path_element_t *first = cm1e_path_element(path, 0);
    const bool over_more = (first->braking.count > alone.count || first->hard_braking.count > alone.count) &&
                           alone.count < path->element_count && cm1e_path_element(path, alone.count)->passed > 0;
    const cm1e_path_element_t *next = cm1e_path_element(path, over_more ? alone.count : 0);
    const cm1e_path_run_t runs[] = {alone, together(&alone, &next->braking), together(&alone, &next->hard_braking)};
    double more = LEAST_MORE;
    for (int i = 0; i < MORE_TRIES; i++, more *= 3)
        for (int k = 0; k < (over_more ? 3 : 1); k++) {
            const cm1e_path_run_t run = harder(&runs[k], more);
            if (keep_going_with(path, &start, &run, k == 0))
                return;
        }
}

void cm1e_path_change_pace(cm1e_path_t *path)
{
    const cm1e_path_run_t run = cm1e_path_run(path, 0, path->element_count);
    look_ahead(path, run.count, 0);
    double soft, hard;
    exits(path, 0, &run, &soft, &hard);
    (void)plan_anew(path, &run, soft, hard, true);
}

/* ---- cutting off ------------------------------------------------------------------------------------------------- */

static void cut_at(cm1e_path_t *path, double position)
{
    int last = 0;
    double begin = 0;
    while (last < path->element_count - 1 &&
           begin + cm1e_path_element(path, last)->length * (1 + CM1E_PATH_AS_LONG) < position)
        begin += cm1e_path_element(path, last++)->length;
    cm1e_path_element_t *element = cm1e_path_element(path, last);
    element->length = smaller(element->length, position - begin);
    element->last_of_tag = element->dropped = true;
    path->element_count = last + 1;
    path->segment_count = 0;
    for (int i = 0; i <= last; i++)
        path->segment_count += cm1e_path_element(path, i)->last_of_tag;
    cm1e_path_point_t point;
    cm1e_path_point_at(element->piece, path->config.axes, element->skipped + element->length, &point);
    for (int i = 0; i < path->config.axes; i++)
        path->end[i] = point.position[i];
}

void cm1e_path_cut(cm1e_path_t *path)
{
    if (path->stopping) {
        cut_at(path, path->profile.end.position - path->begin);
        (void)cm1e_path_plan(path, 0); /* the stop stays; what was known of the way behind it is not true any more */
        return;
    }
    /* It cannot stop before the end of this run: soonest in one that it enters slowly enough. */
    const cm1e_path_run_t current = cm1e_path_run(path, 0, path->element_count);
    cm1e_motion_state_t start = {0, path->profile.end.velocity, 0};
    double begin = current.length;
    for (int next = current.count; next < path->element_count;) {
        const cm1e_path_run_t run = cm1e_path_element(path, next)->hard_braking;
        cm1e_profile_t profile;
        if (cm1e_profile_to_velocity(&profile, &start, 0, &run.limits) == CM1E_OK &&
            profile.end.position <= run.length) {
            cut_at(path, begin + profile.end.position * (1 + CM1E_PATH_AS_LONG));
            break;
        }
        double soft, hard;
        exits(path, next, &run, &soft, &hard);
        next += run.count;
        begin += run.length;
        if (!plan_run(&profile, &start, &run, soft, hard, false))
            return;
        start.velocity = profile.end.velocity;
    }
    (void)cm1e_path_plan(path, 0);
}
