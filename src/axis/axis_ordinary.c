/*
 * The short way of an ordinary cycle. Most axes in most cycles are in the middle of a stretch of the profile of their
 * command: nothing begins, ends or changes. Then a cycle is a sample of the stretch and nothing else, and a few tests
 * show it. All decisions of the long way (cm1e_axis_advance_any()) that depend on the profile alone are made ahead, for
 * some cycles at once: look_ahead(). Whatever could change one of them calls cm1e_axis_look_anew(). An axis that
 * follows a master or a leader is asked for nothing else either; its own source makes and checks the set-point as ever.
 * Both ways give the same bits (tests test_axis_ordinary, test_axis_ordinary_led).
 */
#include <math.h>

#include "axis/axis_commands.h"
#include "axis/axis_course.h"
#include "axis/axis_extras.h"
#include "axis/axis_in_position.h"
#include "axis/axis_setpoint.h"
#include "core/extreme.h"
#include "core/rare.h"

/* So many cycles are looked at together. */
static const double cycles_ahead = 256.0;

/* Whether no position between two times of the stretch needs more than a sample: the axis could be stopped before its
 * software limits even from the farthest one at the highest speed, and all of them can be counted from the begin of the
 * profile. The tolerance of the limits is left to rounding. */
static bool needs_no_check(const cm1e_axis_t *axis, double from_s, double until_s)
{
    const cm1e_profile_stretch_t *stretch = &axis->setpoint.stretch;
    const cm1e_motion_state_t a = cm1e_profile_stretch_state(stretch, from_s);
    const cm1e_motion_state_t b = cm1e_profile_stretch_state(stretch, until_s);
    const double highest = larger(a.position, b.position), lowest = smaller(a.position, b.position);
    const double speed = cm1e_profile_stretch_bounds(stretch, from_s, until_s).velocity;
    const double base = axis->setpoint.base_line;
    const double way = speed * speed * axis->limits.emergency_way;
    const double farthest = larger(fabs(highest), fabs(lowest)) * fabs(axis->position.scale);
    return isfinite(way) && farthest < profile_farthest_from_base &&
           cm1e_position_reaches(axis->setpoint.base, 2.0 * profile_farthest_from_base) &&
           cm1e_position_reaches(axis->setpoint.base, -2.0 * profile_farthest_from_base) &&
           (!axis->limits.software_limits ||
            (base + highest + way <= axis->limits.upper && base + lowest - way >= axis->limits.lower));
}

/* Whether the cycle at `time_s` is ordinary as far as the profile decides it, and until when the next ones are. */
CM1E_RARE static void look_ahead(cm1e_axis_t *axis, double time_s)
{
    setpoint_t *s = &axis->setpoint;
    double until_s = smaller(s->stretch.until_s, time_s + cycles_ahead * axis->cycle_s);
    if (!s->reached && !s->paused && !s->stands) /* else the end of the profile is behind */
        until_s = smaller(until_s, s->profile.duration_s - profile_same_moment * axis->cycle_s);
    if (!(time_s >= s->stretch.from_s && time_s < until_s) || !needs_no_check(axis, time_s, until_s))
        return;
    s->ordinary_until_s = until_s;
    s->course++;
}

bool cm1e_axis_course(const cm1e_axis_t *axis, course_t *course)
{
    const setpoint_t *s = &axis->setpoint;
    const double now_s = s->profile_next_s - axis->cycle_s;
    if (s->source != &cm1e_source_profile || !(s->profile_next_s < s->ordinary_until_s) || now_s < s->stretch.from_s)
        return false;
    const cm1e_motion_state_t end = cm1e_profile_stretch_state(&s->stretch, s->ordinary_until_s);
    *course = (course_t){
        .most = cm1e_profile_stretch_bounds(&s->stretch, now_s, s->ordinary_until_s),
        .time_s = s->ordinary_until_s - now_s,
        .end = cm1e_position_plus(s->base, end.position * axis->position.scale),
    };
    return isfinite(course->most.velocity);
}

/* Whether the axis has nothing to do beside its motion. */
static inline bool nothing_beside(const cm1e_axis_t *axis)
{
    return axis->extras == 0; /* EXTRA_DISTURBED is one of them */
}

/* Whether the axis has nothing to do but to follow its master or leader. */
static inline bool only_follows(const cm1e_axis_t *axis)
{
    const source_t *source = axis->setpoint.source;
    return axis->state == CM1E_AXIS_SYNCHRONIZED_MOTION && !source->find_stretch && source->moves &&
           nothing_beside(axis);
}

static inline bool led_ordinary_step(cm1e_axis_t *axis, axis_otherwise_t otherwise)
{
    const source_t *source = axis->setpoint.source;
    if (CM1E_USUALLY(axis->state == CM1E_AXIS_SYNCHRONIZED_MOTION && nothing_beside(axis) && source->ordinary))
        return source->ordinary(axis, otherwise);
    return otherwise(axis);
}

bool cm1e_axis_led_step(cm1e_axis_t *axis, bool *over)
{
    const source_t *source = axis->setpoint.source;
    if (!only_follows(axis))
        return false;
    *over = false;
    if (source->follows)
        axis->coupling_hooks->advance_masters(axis);
    cm1e_axis_in_position_leave(axis);
    const bool made = source->step(axis);
    axis->setpoint.brakes_hard = false;
    *over = axis->setpoint.source != source || axis->extras;
    if (*over)
        cm1e_axis_motion_turned(axis, made);
    return true;
}

/* Whether the axis is on the profile of a command, and has nothing to do beside it. */
static inline bool on_profile_only(const cm1e_axis_t *axis)
{
    return axis->setpoint.source == &cm1e_source_profile && axis->state >= CM1E_AXIS_DISCRETE_MOTION &&
           axis->state < CM1E_AXIS_SYNCHRONIZED_MOTION && nothing_beside(axis);
}

static inline bool decided_step(cm1e_axis_t *axis)
{
    setpoint_t *s = &axis->setpoint;
    if (!on_profile_only(axis))
        return false;
    const double time_s = s->profile_next_s;
    if (!CM1E_USUALLY(time_s < s->ordinary_until_s))
        return false;
    cm1e_axis_count_cycle(axis);
    const cm1e_motion_state_t next = cm1e_profile_stretch_state(&s->stretch, time_s);
    s->position = cm1e_position_plus(s->base, next.position * axis->position.scale);
    s->velocity = next.velocity;
    s->acceleration = next.acceleration;
    if (next.velocity > 0.0)
        s->positive_before = true;
    else if (next.velocity < 0.0)
        s->positive_before = false;
    return true;
}

bool cm1e_axis_ordinary_step(cm1e_axis_t *axis)
{
    const setpoint_t *s = &axis->setpoint;
    if (on_profile_only(axis) && !(s->profile_next_s < s->ordinary_until_s))
        look_ahead(axis, s->profile_next_s);
    return decided_step(axis);
}

static bool not_made(cm1e_axis_t *axis)
{
    (void)axis;
    return false;
}

bool cm1e_axis_led_ordinary_step(cm1e_axis_t *axis) { return led_ordinary_step(axis, not_made); }

void cm1e_axis_advance(cm1e_axis_t *axis)
{
    axis->advanced = true; /* first, as a master may be asked for its set-point on the way */
    if (!decided_step(axis))
        (void)led_ordinary_step(axis, cm1e_axis_advance_undecided);
}
