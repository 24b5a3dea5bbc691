/* Profiles to a position with a velocity there, and how fast a position can be passed: over random problems. */
#include "motion_check.h"

enum { PROBLEMS = 100000 };

void setUp(void) {}
void tearDown(void) {}

static double random_velocity(const cm1e_motion_limits_t *limits)
{
    if (one_in(8))
        return one_in(2) ? limits->velocity : -limits->velocity;
    return random_between(-1, 1) * limits->velocity * (one_in(4) ? 1e-3 : 1);
}

static cm1e_profile_t to_state(const problem_t *problem, double velocity)
{
    cm1e_profile_t profile;
    CHECK(cm1e_profile_to_state(&profile, &problem->start, problem->target, velocity, &problem->limits) == CM1E_OK,
          problem);
    CHECK(profile.end.position == problem->target && profile.end.velocity == velocity, problem);
    CHECK(profile.end.acceleration == 0 && isfinite(profile.duration_s) && profile.duration_s >= 0, problem);
    check_continuity(&profile, problem);
    return profile;
}

static void test_every_profile_keeps_limits_and_ends_exactly(void)
{
    for (int i = 0; i < PROBLEMS; i++) {
        const problem_t problem = random_problem();
        const cm1e_profile_t profile = to_state(&problem, random_velocity(&problem.limits));
        check_limits(&profile, &problem);
    }
}

static void test_a_mirrored_problem_gives_the_mirrored_profile(void)
{
    for (int i = 0; i < PROBLEMS; i++) {
        const problem_t problem = random_problem();
        const double velocity = random_velocity(&problem.limits);
        const problem_t mirror = {
            {-problem.start.position, -problem.start.velocity, -problem.start.acceleration}, -problem.target,
            problem.limits};
        const cm1e_profile_t profile = to_state(&problem, velocity), mirrored = to_state(&mirror, -velocity);
        CHECK(profile.segment_count == mirrored.segment_count, &problem);
        CHECK(profile.duration_s == mirrored.duration_s, &problem);
        for (int k = 0; k < profile.segment_count; k++)
            CHECK(profile.segments[k].start.position == -mirrored.segments[k].start.position &&
                      profile.segments[k].start_s == mirrored.segments[k].start_s &&
                      profile.segments[k].jerk == -mirrored.segments[k].jerk,
                  &problem);
    }
}

/** Backwards in time, acceleration is deceleration. */
static void test_the_way_back_takes_as_long(void)
{
    for (int i = 0; i < PROBLEMS; i++) {
        problem_t problem = random_problem();
        problem.start.position = 0;
        problem.start.acceleration = 0;
        problem.target = random_between(-1, 1) * random_decade(1e-6, 10) * problem.limits.velocity *
                         problem.limits.velocity / problem.limits.acceleration;
        const double velocity = random_velocity(&problem.limits);
        const problem_t back = {{0, velocity, 0}, problem.target,
                                {problem.limits.velocity, problem.limits.deceleration, problem.limits.acceleration,
                                 problem.limits.jerk}};
        const cm1e_profile_t there = to_state(&problem, velocity), again = to_state(&back, problem.start.velocity);
        CHECK(fabs(there.duration_s - again.duration_s) <= 1e-6 * there.duration_s, &problem);
    }
}

static void test_no_random_motion_is_shorter(void)
{
    int compared = 0;
    for (int i = 0; i < 2 * PROBLEMS; i++) {
        problem_t problem = random_problem();
        problem.start.position = 0; /* a rounded target may be out of reach by a hair, and then far away in time */
        const double velocity = random_velocity(&problem.limits);
        const double duration = random_motion(&problem, velocity, &problem.target);
        if (isnan(duration))
            continue;
        compared++;
        const cm1e_profile_t profile = to_state(&problem, velocity);
        CHECK(profile.duration_s <= duration * (1 + 1e-9) + detour(&profile, &problem), &problem);
    }
    printf("%d random motions compared\n", compared);
    TEST_ASSERT_GREATER_THAN(PROBLEMS / 2, compared);
}

static void test_start_outside_the_limits_is_brought_inside_and_stays_there(void)
{
    for (int i = 0; i < PROBLEMS; i++) {
        problem_t problem = random_problem();
        const cm1e_motion_limits_t *limits = &problem.limits;
        problem.start.velocity = random_between(-3, 3) * limits->velocity;
        problem.start.acceleration = random_between(-3, 3) * fmax(limits->acceleration, limits->deceleration);
        const cm1e_profile_t profile = to_state(&problem, random_velocity(limits));
        const double hair = isinf(limits->jerk) ? 0 : 1e-6;
        const cm1e_motion_limits_t tighter = {limits->velocity * (1 - 1e-6), limits->acceleration * (1 - hair),
                                              limits->deceleration * (1 - hair), limits->jerk};
        bool inside = false;
        for (int k = 0; k <= SAMPLES; k++) {
            cm1e_motion_state_t state;
            cm1e_profile_sample(&profile, sample_time(&profile, k), &state);
            if (inside)
                CHECK(is_inside(&state, limits, 1 + 1e-6), &problem);
            inside = inside || is_inside(&state, &tighter, 1);
        }
    }
}

/** How far the shortest change to a velocity goes. */
static double way(const problem_t *problem, double velocity, cm1e_profile_t *profile)
{
    cm1e_motion_limits_t limits = problem->limits;
    limits.velocity = fmax(limits.velocity, fabs(velocity));
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_profile_to_velocity(profile, &problem->start, velocity, &limits));
    return profile->end.position - problem->start.position;
}

/** Once the axis goes towards the target, it does so until the end, and the target is the end of its way. */
static void check_passes_once(const cm1e_profile_t *profile, double velocity, const problem_t *problem)
{
    const double sign = velocity > 0 ? 1 : -1;
    const double noise = 2e-9 * fabs(problem->target - problem->start.position) +
                         1e-14 * (fabs(problem->target) + fabs(problem->start.position));
    for (int i = 0; i < profile->segment_count; i++) {
        const cm1e_motion_state_t *at = &profile->segments[i].start;
        /* What the start alone makes inevitable: it is going, or being driven, away. */
        const bool begins = sign * problem->start.velocity < 0 || sign * problem->start.acceleration < 0;
        CHECK(begins || sign * at->velocity >= -1e-9 * problem->limits.velocity, problem);
        CHECK(begins || sign * (problem->target - at->position) >= -noise, problem);
    }
}

static void test_passing_velocity_is_the_highest_without_a_reversal(void)
{
    int full = 0, less = 0, none = 0;
    for (int i = 0; i < PROBLEMS; i++) {
        problem_t problem = random_problem();
        const double wish = random_velocity(&problem.limits) * (one_in(4) ? 3 : 1);
        const double sign = wish > 0 ? 1 : -1;
        problem.start.position *= one_in(2) ? 0 : 1e-3;
        problem.target = problem.start.position + (problem.target - problem.start.position) * (one_in(2) ? 1e-2 : 1);
        const double distance = sign * (problem.target - problem.start.position);
        const double noise = 1e-14 * (fabs(problem.start.position) + fabs(problem.target));
        const double velocity =
            cm1e_profile_passing_velocity(&problem.start, problem.target, wish, &problem.limits);
        CHECK(velocity * sign >= 0 && fabs(velocity) <= fabs(wish), &problem);
        cm1e_profile_t profile;
        if (velocity != 0) {
            CHECK(sign * way(&problem, velocity, &profile) <= distance + 2e-9 * fabs(distance) + noise, &problem);
            profile = to_state(&problem, velocity);
            check_passes_once(&profile, velocity, &problem);
        }
        if (velocity == wish) {
            full++;
        } else if (velocity != 0) { /* a little more needs a longer way */
            less++;
            const double more = velocity + 1e-6 * (wish - velocity) + 1e-9 * velocity;
            CHECK(sign * way(&problem, more, &profile) > distance - noise, &problem);
        } else {
            none++;
            for (int k = 1; k <= 10; k++)
                CHECK(sign * way(&problem, wish * k / 10, &profile) > distance - noise, &problem);
        }
    }
    printf("passing: %d at the velocity asked for, %d slower, %d not\n", full, less, none);
    TEST_ASSERT_GREATER_THAN(PROBLEMS / 20, full);
    TEST_ASSERT_GREATER_THAN(PROBLEMS / 20, less);
    TEST_ASSERT_GREATER_THAN(PROBLEMS / 20, none);
}

/** An axis that plans anew in every cycle passes at the same velocity and time, without a run-up. */
static void test_replanning_on_the_way_keeps_velocity_and_time(void)
{
    int checked = 0;
    for (int i = 0; i < PROBLEMS / 10; i++) {
        problem_t problem = random_problem();
        problem.start.position = 0;
        const double velocity = cm1e_profile_passing_velocity(&problem.start, problem.target,
                                                              random_velocity(&problem.limits), &problem.limits);
        if (velocity == 0)
            continue;
        checked++;
        cm1e_profile_t profile = to_state(&problem, velocity);
        const double cycle_s = profile.duration_s / SAMPLES, whole_s = profile.duration_s;
        const double tolerance = 1e-5 * whole_s + 1e3 * detour(&profile, &problem);
        double now = velocity;
        for (int k = 1; k < SAMPLES; k++) {
            cm1e_profile_sample(&profile, cycle_s, &problem.start);
            now = cm1e_profile_passing_velocity(&problem.start, problem.target, now, &problem.limits);
            CHECK(fabs(now - velocity) <= 1e-6 * fabs(velocity), &problem);
            profile = to_state(&problem, now);
            CHECK(fabs(profile.duration_s + k * cycle_s - whole_s) <= tolerance, &problem);
        }
    }
    TEST_ASSERT_GREATER_THAN(PROBLEMS / 40, checked);
}

static void test_entry_velocity_is_the_highest_that_comes_down_in_time(void)
{
    for (int i = 0; i < PROBLEMS; i++) {
        const cm1e_motion_limits_t limits = random_limits();
        const double wish = random_between(0, 1) * limits.velocity, exit = one_in(4) ? 0 : random_between(0, 1) * wish;
        problem_t problem = {.limits = limits};
        problem.start.velocity = wish;
        cm1e_profile_t profile;
        const double distance = way(&problem, exit, &profile) * random_between(0, 1.2);
        problem.target = distance;
        const double entry = cm1e_profile_entry_velocity(distance, wish, exit, &limits);
        CHECK(entry >= exit && entry <= wish, &problem);
        problem.start.velocity = entry;
        CHECK(way(&problem, exit, &profile) <= distance * (1 + 2e-9), &problem);
        CHECK(exit == 0 || cm1e_profile_passing_velocity(&problem.start, distance, exit, &limits) == exit, &problem);
        problem.start.velocity = entry + 1e-6 * (wish - entry) + 1e-9 * entry;
        CHECK(entry == wish || way(&problem, exit, &profile) > distance * (1 - 1e-12), &problem);
        CHECK(cm1e_profile_entry_velocity(distance, exit, wish, &limits) == exit, &problem);
    }
    TEST_ASSERT_TRUE(cm1e_profile_entry_velocity(0, 10, 3, &(cm1e_motion_limits_t){10, 1, 1, 1}) == 3);
}

/** PLCopen's BlendingHigh: the limit of the velocity until the end, where the axis gets up to what comes next. */
static void test_target_velocity_beyond_the_limit_is_reached_at_the_end_only(void)
{
    int cruised = 0;
    for (int i = 0; i < PROBLEMS; i++) {
        const problem_t problem = random_problem();
        const cm1e_motion_limits_t *limits = &problem.limits;
        const double wish = (one_in(2) ? 1 : -1) * random_between(1, 3) * limits->velocity;
        const double velocity = one_in(2)
                                    ? wish
                                    : cm1e_profile_passing_velocity(&problem.start, problem.target, wish, limits);
        const cm1e_profile_t profile = to_state(&problem, velocity);
        const double sign = velocity < 0 ? -1 : 1;
        bool beyond = false;
        cm1e_motion_state_t before = problem.start;
        for (int k = 0; k < SAMPLES; k++) {
            cm1e_motion_state_t state;
            cm1e_profile_sample(&profile, sample_time(&profile, k), &state);
            CHECK(!beyond || sign * (state.velocity - before.velocity) >= -1e-9 * fabs(wish), &problem);
            beyond = beyond || fabs(state.velocity) > limits->velocity * (1 + 1e-9);
            before = state;
        }
        for (int k = 0; k < profile.segment_count; k++)
            cruised += profile.segments[k].jerk == 0 && profile.segments[k].start.acceleration == 0 &&
                       fabs(profile.segments[k].start.velocity) == limits->velocity;
    }
    TEST_ASSERT_GREATER_THAN(PROBLEMS / 20, cruised);
}

int main(void)
{
    seed_random();
    UNITY_BEGIN();
    RUN_TEST(test_every_profile_keeps_limits_and_ends_exactly);
    RUN_TEST(test_a_mirrored_problem_gives_the_mirrored_profile);
    RUN_TEST(test_the_way_back_takes_as_long);
    RUN_TEST(test_no_random_motion_is_shorter);
    RUN_TEST(test_start_outside_the_limits_is_brought_inside_and_stays_there);
    RUN_TEST(test_passing_velocity_is_the_highest_without_a_reversal);
    RUN_TEST(test_replanning_on_the_way_keeps_velocity_and_time);
    RUN_TEST(test_entry_velocity_is_the_highest_that_comes_down_in_time);
    RUN_TEST(test_target_velocity_beyond_the_limit_is_reached_at_the_end_only);
    return UNITY_END();
}
