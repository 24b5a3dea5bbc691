/* What every profile keeps, over random problems, and that no motion found otherwise is shorter. */
#include <string.h>

#include "motion_check.h"

enum { PROBLEMS = 200000 };

void setUp(void) {}
void tearDown(void) {}

static void test_every_profile_keeps_limits_and_ends_exactly(void)
{
    for (int i = 0; i < PROBLEMS; i++) {
        const problem_t problem = random_problem();
        cm1e_profile_t profile;
        CHECK(cm1e_profile_to_position(&profile, &problem.start, problem.target, &problem.limits) == CM1E_OK, &problem);
        CHECK(profile.end.position == problem.target && profile.end.velocity == 0, &problem);
        check_continuity(&profile, &problem);
        check_limits(&profile, &problem);

        const double velocity = random_between(-1, 1) * problem.limits.velocity;
        CHECK(cm1e_profile_to_velocity(&profile, &problem.start, velocity, &problem.limits) == CM1E_OK, &problem);
        CHECK(profile.end.velocity == velocity, &problem);
        check_continuity(&profile, &problem);
        check_limits(&profile, &problem);
    }
}

static void test_start_outside_the_limits_is_brought_inside_and_stays_there(void)
{
    for (int i = 0; i < PROBLEMS; i++) {
        problem_t problem = random_problem();
        const cm1e_motion_limits_t *limits = &problem.limits;
        problem.start.velocity = random_between(-3, 3) * limits->velocity;
        problem.start.acceleration = random_between(-3, 3) * fmax(limits->acceleration, limits->deceleration);
        cm1e_profile_t profile;
        CHECK(cm1e_profile_to_position(&profile, &problem.start, problem.target, limits) == CM1E_OK, &problem);
        CHECK(profile.end.position == problem.target && profile.end.velocity == 0, &problem);
        check_continuity(&profile, &problem);
        /* A state a hair inside; what follows may be a hair outside. (The trapezoid is always at a limit.) */
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
        CHECK(inside, &problem);
    }
}

static double any_number(double decades)
{
    return one_in(8) ? 0 : (one_in(2) ? 1 : -1) * random_decade(pow(10, -decades), pow(10, decades));
}

/* The last sample before the end is next to it: a profile that cannot be has been refused. */
static void check_arrival(const cm1e_profile_t *profile, const problem_t *problem)
{
    double fastest = fabs(profile->end.velocity), farthest = fabs(profile->end.position) + fabs(problem->start.position);
    for (int i = 0; i < profile->segment_count; i++) {
        fastest = fmax(fastest, fabs(profile->segments[i].start.velocity));
        farthest = fmax(farthest, fabs(profile->segments[i].start.position));
    }
    cm1e_motion_state_t last;
    cm1e_profile_sample(profile, nextafter(profile->duration_s, 0), &last);
    CHECK(fabs(last.position - profile->end.position) <= 1e-8 * fastest * profile->duration_s + 1e-14 * farthest,
          problem);
}

static void test_numbers_of_any_size_give_a_profile_or_a_refusal(void)
{
    static const double decades[] = {3, 6, 12, 15, 30, 300};
    for (int i = 0; i < PROBLEMS; i++) {
        const double size = decades[i % 6];
        const double jerk = one_in(8) ? INFINITY : random_decade(pow(10, -size), pow(10, size));
        const problem_t problem = {
            .start = {any_number(size), any_number(size), any_number(size)},
            .target = any_number(size),
            .limits = {random_decade(pow(10, -size), pow(10, size)), random_decade(pow(10, -size), pow(10, size)),
                       random_decade(pow(10, -size), pow(10, size)), jerk},
        };
        cm1e_profile_t profile;
        const double velocity = one_in(2) ? 0 : any_number(size);
        const double passing =
            cm1e_profile_passing_velocity(&problem.start, problem.target, velocity, &problem.limits);
        CHECK(passing * velocity >= 0 && fabs(passing) <= fabs(velocity), &problem);
        const double there = one_in(2) ? passing : velocity;
        if (cm1e_profile_to_state(&profile, &problem.start, problem.target, there, &problem.limits) != CM1E_OK) {
            CHECK(size > (there == 0 ? 15 : 6), &problem);
            continue;
        }
        CHECK(isfinite(profile.duration_s) && profile.end.position == problem.target, &problem);
        if (size <= (there == 0 ? 15 : 6))
            check_continuity(&profile, &problem);
        for (int k = 0; k <= SAMPLES; k++) {
            cm1e_motion_state_t state;
            cm1e_profile_sample(&profile, sample_time(&profile, k), &state);
            CHECK(isfinite(state.position) && isfinite(state.velocity) && isfinite(state.acceleration), &problem);
        }
        double low, high;
        cm1e_profile_extent(&profile, &low, &high);
        CHECK(isfinite(low) && isfinite(high) && low <= high, &problem);
        check_arrival(&profile, &problem);
    }
}

static void test_from_rest_the_position_stays_between_start_and_target(void)
{
    for (int i = 0; i < PROBLEMS; i++) {
        problem_t problem = random_problem();
        problem.start.velocity = problem.start.acceleration = 0;
        if (one_in(5))
            problem.limits.jerk = INFINITY;
        cm1e_profile_t profile;
        CHECK(cm1e_profile_to_position(&profile, &problem.start, problem.target, &problem.limits) == CM1E_OK, &problem);
        double low, high;
        cm1e_profile_extent(&profile, &low, &high);
        const double least = fmin(problem.start.position, problem.target);
        const double most = fmax(problem.start.position, problem.target);
        if (profile.segment_count == 0) /* nothing but the rounding of the positions lies between */
            CHECK(most - least <= 8 * DBL_EPSILON * (fabs(most) + fabs(least)), &problem);
        else
            CHECK(low == least && high == most, &problem);
        for (int k = 0; k <= SAMPLES; k++) {
            cm1e_motion_state_t state;
            cm1e_profile_sample(&profile, sample_time(&profile, k), &state);
            CHECK(state.position >= low && state.position <= high, &problem);
            CHECK((problem.target - problem.start.position) * state.velocity >= 0, &problem);
        }
    }
}

static void test_a_mirrored_problem_gives_the_mirrored_profile(void)
{
    for (int i = 0; i < PROBLEMS; i++) {
        const problem_t problem = random_problem();
        const cm1e_motion_state_t start = {-problem.start.position, -problem.start.velocity,
                                           -problem.start.acceleration};
        cm1e_profile_t profile, mirrored;
        CHECK(cm1e_profile_to_position(&profile, &problem.start, problem.target, &problem.limits) == CM1E_OK, &problem);
        CHECK(cm1e_profile_to_position(&mirrored, &start, -problem.target, &problem.limits) == CM1E_OK, &problem);
        CHECK(profile.segment_count == mirrored.segment_count, &problem);
        CHECK(profile.duration_s == mirrored.duration_s, &problem);
        for (int k = 0; k < SAMPLES; k++) {
            cm1e_motion_state_t a, b;
            cm1e_profile_sample(&profile, sample_time(&profile, k), &a);
            cm1e_profile_sample(&mirrored, sample_time(&profile, k), &b);
            CHECK(a.position == -b.position && a.velocity == -b.velocity && a.acceleration == -b.acceleration,
                  &problem);
        }
    }
}

static void test_replanning_on_the_way_takes_the_remaining_time(void)
{
    for (int i = 0; i < PROBLEMS; i++) {
        problem_t problem = random_problem();
        cm1e_profile_t profile;
        CHECK(cm1e_profile_to_position(&profile, &problem.start, problem.target, &problem.limits) == CM1E_OK, &problem);
        const double time = random_between(0, 1) * profile.duration_s, remaining = profile.duration_s - time;
        cm1e_profile_sample(&profile, time, &problem.start);
        const double tolerance = 1e-6 * profile.duration_s + detour(&profile, &problem);
        CHECK(cm1e_profile_to_position(&profile, &problem.start, problem.target, &problem.limits) == CM1E_OK, &problem);
        CHECK(fabs(profile.duration_s - remaining) <= tolerance, &problem);
    }
}

static void test_no_random_motion_is_shorter(void)
{
    int compared = 0;
    for (int i = 0; i < PROBLEMS; i++) {
        problem_t problem = random_problem();
        const double duration = random_motion(&problem, 0, &problem.target);
        if (isnan(duration))
            continue;
        compared++;
        cm1e_profile_t profile;
        CHECK(cm1e_profile_to_position(&profile, &problem.start, problem.target, &problem.limits) == CM1E_OK, &problem);
        CHECK(profile.duration_s <= duration * (1 + 1e-9) + detour(&profile, &problem), &problem);
    }
    printf("%d random motions compared\n", compared);
    TEST_ASSERT_GREATER_THAN(PROBLEMS / 4, compared);
}

static void run_tests(void)
{
    RUN_TEST(test_every_profile_keeps_limits_and_ends_exactly);
    RUN_TEST(test_start_outside_the_limits_is_brought_inside_and_stays_there);
    RUN_TEST(test_numbers_of_any_size_give_a_profile_or_a_refusal);
    RUN_TEST(test_from_rest_the_position_stays_between_start_and_target);
    RUN_TEST(test_a_mirrored_problem_gives_the_mirrored_profile);
    RUN_TEST(test_replanning_on_the_way_takes_the_remaining_time);
    RUN_TEST(test_no_random_motion_is_shorter);
}

int main(void)
{
    UNITY_BEGIN();
    run_seeds(run_tests);
    return UNITY_END();
}
