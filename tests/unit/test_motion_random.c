/* What every profile keeps, over random problems, and that no motion found otherwise is shorter. */
#include <string.h>

#include "motion_check.h"

enum { PROBLEMS = 200000, SAMPLES = 40 };

void setUp(void) {}
void tearDown(void) {}

/** What a rounded position costs: it has to be made good by a move of that length, with any limit in its way. */
static double detour(const cm1e_profile_t *profile, const problem_t *problem)
{
    double low, high;
    cm1e_profile_extent(profile, &low, &high);
    const cm1e_motion_limits_t *limits = &problem->limits;
    const double length = 16 * DBL_EPSILON * (fabs(low) + fabs(high));
    return 4 * (cbrt(length / limits->jerk) + sqrt(length / fmin(limits->acceleration, limits->deceleration)) +
                length / limits->velocity);
}

static void check_limits(const cm1e_profile_t *profile, const problem_t *problem)
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
            cm1e_profile_sample(&profile, profile.duration_s * k / SAMPLES, &state);
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
        if (cm1e_profile_to_position(&profile, &problem.start, problem.target, &problem.limits) != CM1E_OK) {
            CHECK(size > 15, &problem);
            continue;
        }
        CHECK(isfinite(profile.duration_s) && profile.end.position == problem.target, &problem);
        if (size <= 15)
            check_continuity(&profile, &problem);
        for (int k = 0; k <= SAMPLES; k++) {
            cm1e_motion_state_t state;
            cm1e_profile_sample(&profile, profile.duration_s * k / SAMPLES, &state);
            CHECK(isfinite(state.position) && isfinite(state.velocity) && isfinite(state.acceleration), &problem);
        }
        double low, high;
        cm1e_profile_extent(&profile, &low, &high);
        CHECK(isfinite(low) && isfinite(high) && low <= high, &problem);
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
            cm1e_profile_sample(&profile, profile.duration_s * k / SAMPLES, &state);
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
            cm1e_profile_sample(&profile, profile.duration_s * k / SAMPLES, &a);
            cm1e_profile_sample(&mirrored, profile.duration_s * k / SAMPLES, &b);
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

/** Whether a profile keeps to limits that it was not made for, up to a time: checked where its segments begin and end,
 *  where the velocity is highest and where it passes zero, since in between everything is monotonic. */
static bool keeps_limits(const cm1e_profile_t *profile, double until_s, const cm1e_motion_limits_t *limits)
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

/** A random motion within the limits that ends at rest, put together from changes of velocity, some not finished, with
 *  limits of their own. Returns its duration, or NaN if it left the limits, and where it ends. */
static double random_motion(const problem_t *problem, double *end)
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
        const double velocity = i == parts ? 0 : random_between(-1, 1) * limits.velocity;
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

static void test_no_random_motion_is_shorter(void)
{
    int compared = 0;
    for (int i = 0; i < PROBLEMS; i++) {
        problem_t problem = random_problem();
        const double duration = random_motion(&problem, &problem.target);
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

int main(void)
{
    seed_random();
    UNITY_BEGIN();
    RUN_TEST(test_every_profile_keeps_limits_and_ends_exactly);
    RUN_TEST(test_start_outside_the_limits_is_brought_inside_and_stays_there);
    RUN_TEST(test_numbers_of_any_size_give_a_profile_or_a_refusal);
    RUN_TEST(test_from_rest_the_position_stays_between_start_and_target);
    RUN_TEST(test_a_mirrored_problem_gives_the_mirrored_profile);
    RUN_TEST(test_replanning_on_the_way_takes_the_remaining_time);
    RUN_TEST(test_no_random_motion_is_shorter);
    return UNITY_END();
}
