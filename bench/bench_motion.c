/**
 * What a trajectory costs: the plan, by kind of problem, and the sample. Every plan is timed alone, as the best of some
 * repetitions, so that the median and the 99th percentile are those of the problems and not of the machine's
 * interruptions. One cbrt() of the C library, timed in the same run, is the yardstick that makes two machines
 * comparable.
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "motion/profile.h"
#include "motion/table_profile.h"
#include "sort.h"

enum { PROBLEMS = 20000, BATCHES = 7, BATCH = 8 };

typedef struct {
    cm1e_motion_state_t start;
    double target, target_velocity;
    cm1e_motion_limits_t limits;
} problem_t;

static problem_t problems[PROBLEMS];
static double costs[PROBLEMS];
static volatile double sink;
static uint64_t random_state = 1;

static double now_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e9 + (double)t.tv_nsec;
}

static double random_between(double low, double high) /* splitmix64 */
{
    uint64_t z = random_state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return low + (high - low) * ((double)((z ^ (z >> 31)) >> 11) * 0x1p-53);
}

static double random_decade(double low, double high) { return pow(10, random_between(log10(low), log10(high))); }

static problem_t from_rest(void)
{
    problem_t problem = {.limits = {random_decade(1, 1000), random_decade(10, 10000), random_decade(10, 10000),
                                    random_decade(100, 1e6)}};
    const cm1e_motion_limits_t *limits = &problem.limits;
    const double slower = fmin(limits->acceleration, limits->deceleration);
    problem.target = random_between(-1, 1) * limits->velocity *
                     (limits->velocity / slower + slower / limits->jerk) * random_decade(1e-3, 10);
    return problem;
}

static problem_t from_rest_without_jerk_limit(void)
{
    problem_t problem = from_rest();
    problem.limits.jerk = INFINITY;
    return problem;
}

/** A new target for a motion that is under way. */
static problem_t from_motion(void)
{
    problem_t problem = from_rest();
    cm1e_profile_t profile;
    cm1e_profile_to_position(&profile, &problem.start, problem.target, &problem.limits);
    cm1e_profile_sample(&profile, random_between(0, 1) * profile.duration_s, &problem.start);
    problem.target *= random_between(-2, 2);
    return problem;
}

/** A move that passes its target: as blending asks for it. */
static problem_t from_rest_to_pass(void)
{
    problem_t problem = from_rest();
    problem.target_velocity = copysign(random_between(0.1, 1) * problem.limits.velocity, problem.target);
    return problem;
}

static problem_t from_motion_to_any_state(void)
{
    problem_t problem = from_motion();
    problem.target_velocity = random_between(-1, 1) * problem.limits.velocity;
    return problem;
}

static void passing(cm1e_profile_t *profile, const problem_t *problem)
{
    profile->duration_s = cm1e_profile_passing_velocity(&problem->start, problem->target, problem->target_velocity,
                                                        &problem->limits);
}

static void to_passed_state(cm1e_profile_t *profile, const problem_t *problem)
{
    const double velocity = cm1e_profile_passing_velocity(&problem->start, problem->target, problem->target_velocity,
                                                          &problem->limits);
    cm1e_profile_to_state(profile, &problem->start, problem->target, velocity, &problem->limits);
}

static void to_state(cm1e_profile_t *profile, const problem_t *problem)
{
    cm1e_profile_to_state(profile, &problem->start, problem->target, problem->target_velocity, &problem->limits);
}

static void along_a_table(cm1e_profile_t *profile, const problem_t *problem)
{
    static cm1e_table_profile_t table;
    cm1e_table_point_t points[CM1E_TABLE_POINTS_MAX];
    for (int i = 0; i < CM1E_TABLE_POINTS_MAX; i++)
        points[i] = (cm1e_table_point_t){i + 1, problem->target * i};
    cm1e_table_extremes_t extremes;
    cm1e_table_profile(&table, CM1E_TABLE_POSITION, &problem->start, points, CM1E_TABLE_POINTS_MAX, INFINITY,
                       &extremes);
    profile->duration_s = extremes.velocity;
}

static void to_position(cm1e_profile_t *profile, const problem_t *problem)
{
    cm1e_profile_to_position(profile, &problem->start, problem->target, &problem->limits);
}

static void to_velocity(cm1e_profile_t *profile, const problem_t *problem)
{
    cm1e_profile_to_velocity(profile, &problem->start, 0, &problem->limits);
}

static double yardstick_ns(void)
{
    double best = INFINITY;
    for (int batch = 0; batch < BATCHES; batch++) {
        double sum = 0;
        const double start = now_ns();
        for (int i = 0; i < PROBLEMS; i++)
            sum += cbrt(problems[i].limits.velocity);
        best = fmin(best, (now_ns() - start) / PROBLEMS);
        sink = sum;
    }
    return best;
}

static void report_plan(const char *name, problem_t (*make)(void), void (*plan)(cm1e_profile_t *, const problem_t *))
{
    for (int i = 0; i < PROBLEMS; i++)
        problems[i] = make();
    const double yardstick = yardstick_ns();
    cm1e_profile_t profile = {0};
    for (int i = 0; i < PROBLEMS; i++) {
        costs[i] = INFINITY;
        for (int batch = 0; batch < BATCHES; batch++) {
            const double start = now_ns();
            for (int k = 0; k < BATCH; k++)
                plan(&profile, &problems[i]);
            costs[i] = fmin(costs[i], (now_ns() - start) / BATCH);
        }
        sink = profile.duration_s;
    }
    sort_values(costs, PROBLEMS);
    printf("plan   %-34s median %6.0f ns  p99 %6.0f ns  worst %6.0f ns  median / cbrt %5.1f\n", name,
           costs[PROBLEMS / 2], costs[PROBLEMS * 99 / 100], costs[PROBLEMS - 1], costs[PROBLEMS / 2] / yardstick);
}

static cm1e_motion_state_t sample(const cm1e_profile_t *profile, double time_s)
{
    cm1e_motion_state_t state;
    cm1e_profile_sample(profile, time_s, &state);
    return state;
}

static cm1e_motion_state_t sample_by_stretches(const cm1e_profile_t *profile, double time_s)
{
    static cm1e_profile_stretch_t stretch;
    if (time_s == 0 || time_s >= stretch.until_s)
        cm1e_profile_stretch_at(profile, time_s, &stretch);
    return cm1e_profile_stretch_state(&stretch, time_s);
}

/** As an axis does it: one profile sampled from its beginning to its end. */
static void report_sample(const char *name, cm1e_motion_state_t (*state_at)(const cm1e_profile_t *, double))
{
    enum { STEPS = 1000, PROFILES = 200 };
    static double batches[PROFILES];
    const double yardstick = yardstick_ns();
    for (int i = 0; i < PROFILES; i++) {
        const problem_t problem = from_motion();
        cm1e_profile_t profile;
        to_position(&profile, &problem);
        batches[i] = INFINITY;
        for (int batch = 0; batch < BATCHES; batch++) {
            double sum = 0;
            const double start = now_ns();
            const double step = profile.duration_s / STEPS;
            for (int k = 0; k < STEPS; k++) {
                const cm1e_motion_state_t state = state_at(&profile, step * k);
                sum += state.position + state.velocity + state.acceleration;
            }
            batches[i] = fmin(batches[i], (now_ns() - start) / STEPS);
            sink = sum;
        }
    }
    sort_values(batches, PROFILES);
    printf("sample %-34s median %6.1f ns  p99 %6.1f ns  worst %6.1f ns  median / cbrt %5.1f\n", name,
           batches[PROFILES / 2], batches[PROFILES * 99 / 100], batches[PROFILES - 1],
           batches[PROFILES / 2] / yardstick);
}

int main(void)
{
    report_plan("to a position, from rest", from_rest, to_position);
    report_plan("to a position, on the way", from_motion, to_position);
    report_plan("to a position, infinite jerk", from_rest_without_jerk_limit, to_position);
    report_plan("to standstill, on the way", from_motion, to_velocity);
    report_plan("to a position passed, from rest", from_rest_to_pass, to_passed_state);
    report_plan("to any state, on the way", from_motion_to_any_state, to_state);
    report_plan("how fast a position can be passed", from_rest_to_pass, passing);
    report_plan("along a table of 64 positions", from_rest, along_a_table);
    report_sample("all along a motion", sample);
    report_sample("the same by stretches", sample_by_stretches);
    printf("cbrt   %43s %6.1f ns\n", "", yardstick_ns());
    printf("bytes  cm1e_profile_t %zu, cm1e_table_profile_t %zu\n", sizeof(cm1e_profile_t),
           sizeof(cm1e_table_profile_t));
    return 0;
}
