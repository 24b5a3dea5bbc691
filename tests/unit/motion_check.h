/* Random motion problems and what every profile has to keep; for the tests of the motion room. */
#ifndef MOTION_CHECK_H
#define MOTION_CHECK_H

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "motion/profile.h"
#include "unity.h"

#include "../support/seeds.h"

typedef struct {
    cm1e_motion_state_t start;
    double target;
    cm1e_motion_limits_t limits;
} problem_t;

static uint64_t random_state;

/* The seed is printed by every program; CM1E_TEST_SEED repeats a run. */
static inline void seed_random(void)
{
    const char *seed = getenv("CM1E_TEST_SEED");
    random_state = seed ? strtoull(seed, NULL, 0) : 20260802;
    printf("CM1E_TEST_SEED=%llu\n", (unsigned long long)random_state);
}

/* All tests of a program, by the seeds of seeds.h. */
static inline void run_seeds(void (*run_tests)(void))
{
    seed_random();
    const uint64_t first = random_state;
    for (int run = 0; run < seeds_of(1); run++) {
        random_state = first + (uint64_t)run;
        if (run > 0)
            printf("CM1E_TEST_SEED=%llu\n", (unsigned long long)random_state);
        run_tests();
    }
}

static inline uint64_t random_bits(void) /* splitmix64 */
{
    uint64_t z = random_state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

static inline double random_between(double low, double high)
{
    return low + (high - low) * ((double)(random_bits() >> 11) * 0x1p-53);
}

static inline double random_decade(double low, double high) /* of its logarithm */
{
    return pow(10, random_between(log10(low), log10(high)));
}

static inline bool one_in(unsigned n) { return random_bits() % n == 0; }

static inline cm1e_motion_limits_t random_limits(void)
{
    cm1e_motion_limits_t limits = {
        .velocity = random_decade(0.1, 1000),
        .acceleration = random_decade(1, 10000),
        .deceleration = random_decade(1, 10000),
        .jerk = random_decade(10, 1000000),
    };
    if (one_in(3))
        limits.deceleration = limits.acceleration;
    if (one_in(10))
        limits.jerk = INFINITY;
    return limits;
}

/** The acceleration that a state may have when |v| grows or shrinks in this direction. */
static inline double acceleration_limit(double velocity, double acceleration, const cm1e_motion_limits_t *limits)
{
    return velocity * acceleration < 0 ? limits->deceleration : limits->acceleration;
}

/** Whether the state can go on without leaving the limits: easing the acceleration does not lead beyond the velocity
 *  limit, nor through standstill with more than the lower of the limits. */
static inline bool is_inside(const cm1e_motion_state_t *state, const cm1e_motion_limits_t *limits, double slack)
{
    const double v = state->velocity, a = state->acceleration;
    const double eased = v + fabs(a) * (a / limits->jerk) / 2;
    if (fabs(v) > limits->velocity * slack || fabs(eased) > limits->velocity * slack)
        return false;
    if (fabs(a) > acceleration_limit(v, a, limits) * slack)
        return false;
    if (v * a < 0 && v * eased < 0) { /* goes through standstill */
        const double lower = fmin(limits->acceleration, limits->deceleration);
        return a * a - 2 * limits->jerk * fabs(v) <= lower * lower * slack;
    }
    return true;
}

/** A start within the limits: at rest, cruising, at limits to the last bit, or anything. */
static inline cm1e_motion_state_t random_start(const cm1e_motion_limits_t *limits)
{
    cm1e_motion_state_t start = {.position = random_between(-1, 1) * random_decade(1e-3, one_in(4) ? 1e12 : 1e4)};
    if (one_in(4))
        return start;
    for (int i = 0; i < 100; i++) {
        start.velocity = random_between(-1, 1) * limits->velocity;
        start.acceleration = random_between(-1, 1) * fmax(limits->acceleration, limits->deceleration);
        if (one_in(6))
            start.acceleration = 0;
        if (one_in(6))
            start.velocity = copysign(limits->velocity, start.velocity);
        if (one_in(6))
            start.acceleration = copysign(limits->acceleration, start.velocity);
        if (one_in(6))
            start.acceleration = -copysign(limits->deceleration, start.velocity);
        if (one_in(6)) /* at the limit of the velocity when the acceleration is eased */
            start.velocity = copysign(
                limits->velocity - start.acceleration * (start.acceleration / limits->jerk) / 2, start.acceleration);
        if (is_inside(&start, limits, 1 + 1e-14))
            return start;
    }
    start.velocity = start.acceleration = 0;
    return start;
}

static inline problem_t random_problem(void)
{
    problem_t problem = {.limits = random_limits()};
    problem.start = random_start(&problem.limits);
    /* Distances around those in which the shape of the profile changes. */
    const double v = problem.limits.velocity, a = fmin(problem.limits.acceleration, problem.limits.deceleration);
    const double typical = v * (v / a + a / problem.limits.jerk);
    problem.target = problem.start.position + random_between(-1, 1) * typical * random_decade(1e-6, 10);
    if (one_in(50))
        problem.target = problem.start.position;
    return problem;
}

static inline const char *problem_text(const problem_t *problem)
{
    static char text[400];
    const cm1e_motion_limits_t *limits = &problem->limits;
    snprintf(text, sizeof text, "start {%.17g, %.17g, %.17g} target %.17g limits {%.17g, %.17g, %.17g, %.17g}",
             problem->start.position, problem->start.velocity, problem->start.acceleration, problem->target,
             limits->velocity, limits->acceleration, limits->deceleration, limits->jerk);
    return text;
}

#define CHECK(condition, problem)                                                                                   \
    do {                                                                                                            \
        if (!(condition)) {                                                                                         \
            printf("%s\n", problem_text(problem));                                                                  \
            TEST_FAIL_MESSAGE(#condition);                                                                          \
        }                                                                                                           \
    } while (0)

static inline double highest_speed(const problem_t *problem)
{
    const double a = problem->start.acceleration;
    return fmax(problem->limits.velocity,
                fabs(problem->start.velocity) + (isinf(problem->limits.jerk) ? 0 : a * a / problem->limits.jerk));
}

/** Whether the segments hang together: each ends where the next begins, the first begins with the start and the last
 *  ends with the end. */
static inline void check_continuity(const cm1e_profile_t *profile, const problem_t *problem)
{
    double low, high;
    cm1e_profile_extent(profile, &low, &high);
    /* Besides the scale of the motion, what the rounding of the time can make. */
    const double a_most = fmax(fabs(problem->start.acceleration),
                               fmax(problem->limits.acceleration, problem->limits.deceleration));
    const double v_most = fmax(highest_speed(problem), fabs(profile->end.velocity));
    const double p_most = fmax(fabs(low), fabs(high)) + (high - low);
    const double jerk = isinf(problem->limits.jerk) ? 0 : problem->limits.jerk;
    const double tick = 4 * DBL_EPSILON * profile->duration_s;
    const double a_slack = 1e-9 * a_most + jerk * tick, v_slack = 1e-9 * v_most + a_most * tick;
    const double p_slack = 1e-9 * p_most + v_most * tick;
    CHECK(profile->segment_count <= CM1E_PROFILE_MAX_SEGMENTS, problem);
    cm1e_motion_state_t state = problem->start;
    for (int i = 0; i < profile->segment_count; i++) {
        const cm1e_profile_segment_t *segment = &profile->segments[i];
        const double end_s = i + 1 < profile->segment_count ? segment[1].start_s : profile->duration_s;
        const double t = end_s - segment->start_s, j = segment->jerk;
        CHECK(t >= 0, problem);
        CHECK(fabs(segment->start.position - state.position) <= p_slack, problem);
        CHECK(fabs(segment->start.velocity - state.velocity) <= v_slack, problem);
        if (!isinf(problem->limits.jerk))
            CHECK(fabs(segment->start.acceleration - state.acceleration) <= a_slack, problem);
        CHECK(fabs(j) <= problem->limits.jerk, problem);
        state = segment->start;
        state.position += t * (state.velocity + t * (state.acceleration / 2 + t * (j / 6)));
        state.velocity += t * (state.acceleration + t * (j / 2));
        state.acceleration += t * j;
    }
    CHECK(fabs(profile->end.position - state.position) <= p_slack, problem);
    CHECK(fabs(profile->end.velocity - state.velocity) <= v_slack, problem);
    if (!isinf(problem->limits.jerk))
        CHECK(fabs(profile->end.acceleration - state.acceleration) <= a_slack, problem);
    CHECK(profile->end.acceleration == 0, problem);
}

enum { SAMPLES = 40 };

/* The last one is the end itself: of a profile that takes 1e15 s a rounding is a quarter of a second. */
static inline double sample_time(const cm1e_profile_t *profile, int k)
{
    return profile->duration_s * (k / (double)SAMPLES);
}

/** What a rounded position costs: it has to be made good by a move of that length, with any limit in its way. */
static inline double detour(const cm1e_profile_t *profile, const problem_t *problem)
{
    double low, high;
    cm1e_profile_extent(profile, &low, &high);
    const cm1e_motion_limits_t *limits = &problem->limits;
    const double length = 16 * DBL_EPSILON * (fabs(low) + fabs(high));
    return 4 * (cbrt(length / limits->jerk) + sqrt(length / fmin(limits->acceleration, limits->deceleration)) +
                length / limits->velocity);
}

static inline void check_limits(const cm1e_profile_t *profile, const problem_t *problem)
{
    const cm1e_motion_limits_t *limits = &problem->limits;
    cm1e_motion_state_t before = problem->start;
    double low, high;
    cm1e_profile_extent(profile, &low, &high);
    const double p_noise = 1e-12 * (fabs(low) + fabs(high));
    const double step = profile->duration_s / SAMPLES;
    for (int i = 0; i <= SAMPLES; i++) {
        cm1e_motion_state_t state;
        cm1e_profile_sample(profile, i * step, &state);
        CHECK(fabs(state.velocity) <= limits->velocity * (1 + 1e-9), problem);
        /* At standstill rounding may take one limit for the other. */
        const double a_limit = fabs(state.velocity) < 1e-9 * limits->velocity
                                   ? fmax(limits->acceleration, limits->deceleration)
                                   : acceleration_limit(state.velocity, state.acceleration, limits);
        CHECK(fabs(state.acceleration) <= a_limit * (1 + 1e-9), problem);
        CHECK(state.position >= low - p_noise && state.position <= high + p_noise, problem);
        if (i > 0 && step > 0)
            CHECK(fabs(state.acceleration - before.acceleration) <= limits->jerk * step + 1e-9 * a_limit, problem);
        before = state;
    }
    cm1e_motion_state_t last;
    cm1e_profile_sample(profile, nextafter(profile->duration_s, 0), &last);
    CHECK(fabs(last.position - profile->end.position) <= p_noise, problem);
}

/** Whether a profile keeps to limits that it was not made for, up to a time: checked where its segments begin and end,
 *  where the velocity is highest and where it passes zero, since in between everything is monotonic. */
static inline bool keeps_limits(const cm1e_profile_t *profile, double until_s, const cm1e_motion_limits_t *limits)
{
    const double slack = 1 + 1e-12, lower = fmin(limits->acceleration, limits->deceleration);
    for (int i = 0; i < profile->segment_count; i++) {
        const cm1e_profile_segment_t *segment = &profile->segments[i];
        const double end_s = i + 1 < profile->segment_count ? segment[1].start_s : profile->duration_s;
        const double length_s = fmin(end_s, until_s) - segment->start_s;
        const double v = segment->start.velocity, a = segment->start.acceleration, j = segment->jerk;
        const double root = sqrt(fmax(0, a * a - 2 * j * v));
        const double times[] = {0, length_s, -a / j, (-a + root) / j, (-a - root) / j, -v / a};
        for (int k = 0; k < 6; k++) {
            if (!(times[k] >= 0 && times[k] <= length_s))
                continue;
            const cm1e_motion_state_t state = {0, v + times[k] * (a + times[k] * j / 2), a + times[k] * j};
            if (k < 3 && !is_inside(&state, limits, slack))
                return false;
            if (k >= (j == 0 ? 5 : 3) && fabs(state.acceleration) > lower * slack && length_s > times[k])
                return false;
        }
    }
    return true;
}

/** A random motion within the limits that ends with a velocity, put together from changes of velocity, some not
 *  finished, with limits of their own. Returns its duration, or NaN if it left the limits, and where it ends. */
static inline double random_motion(const problem_t *problem, double velocity_there, double *end)
{
    cm1e_motion_state_t state = problem->start;
    double duration = 0;
    const unsigned parts = 1 + random_bits() % 4;
    for (unsigned i = 0; i <= parts; i++) {
        cm1e_motion_limits_t limits = problem->limits;
        if (one_in(3))
            limits.acceleration *= random_between(0.2, 1);
        if (one_in(3))
            limits.deceleration *= random_between(0.2, 1);
        if (one_in(3))
            limits.jerk *= random_between(0.2, 1);
        const double velocity = i == parts ? velocity_there : random_between(-1, 1) * limits.velocity;
        cm1e_profile_t profile;
        if (cm1e_profile_to_velocity(&profile, &state, velocity, &limits) != CM1E_OK)
            return NAN;
        const double time = i == parts ? profile.duration_s : random_between(0, 1.2) * profile.duration_s;
        if (!keeps_limits(&profile, time, &problem->limits))
            return NAN;
        cm1e_profile_sample(&profile, time, &state);
        duration += time;
    }
    *end = state.position;
    return duration;
}

#endif
