/* Blending (2.4.2, figures 56-63): with which velocity a position is passed, and the moment of the change. */
#include "../support/axis_bench.h"
#include "../support/axis_witness.h"
#include "../support/xorshift.h"

static uint64_t seed;

static double uniform(double low, double high)
{
    return xorshift_between(&seed, low, high);
}

static void begin_as_described(void)
{
    bench_end();
    bench_create();
    bench_enable();
    watch_begin();
}

static void begin_with(double acceleration, double deceleration, double jerk)
{
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.config.axes[0].max_acceleration = acceleration;
    bus.config.axes[0].max_deceleration = deceleration;
    bus.config.axes[0].max_jerk = jerk;
    begin_as_described();
}

void setUp(void) { begin_with(100.0, 80.0, 2000.0); }
void tearDown(void) { bench_end(); }

static cm1e_command_id_t post(cm1e_command_kind_t kind, double position, double velocity, MC_BUFFER_MODE mode)
{
    return bench_start_command(&(cm1e_axis_command_t){.kind = kind, .position = position, .velocity = velocity,
                                                      .buffer_mode = mode});
}

static cm1e_command_id_t post_absolute(double position, double velocity, MC_BUFFER_MODE mode)
{
    return post(CM1E_COMMAND_MOVE_ABSOLUTE, position, velocity, mode);
}

/* The velocity with which the set-point passes a position: by the cycle in which it does, exactly, since the junction
 * has no acceleration and the jerk is known. Ends behind the cycle. */
static double velocity_at(double position)
{
    for (int i = 0; i < 20000; i++) {
        const double before = bench_info().set_position, v0 = axis->setpoint.velocity;
        watch_cycles(1);
        const double after = bench_info().set_position;
        if ((before < position) != (after < position) || after == position)
            return after == position ? axis->setpoint.velocity
                                     : v0 + (axis->setpoint.velocity - v0) * (position - before) / (after - before);
    }
    TEST_FAIL_MESSAGE("never got there");
    return 0.0;
}

static void test_velocity_at_the_junction_is_what_the_mode_says(void)
{
    static const double velocities[] = {2.0, 5.0, 9.0};
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            for (int mode = mcBlendingLow; mode <= mcBlendingHigh; mode++)
                for (int sign = -1; sign <= 1; sign += 2) {
                    setUp();
                    const double v1 = velocities[a], v2 = velocities[b];
                    const cm1e_command_id_t first = post_absolute(10.0 * sign, v1, mcAborting);
                    const cm1e_command_id_t second = post_absolute(20.0 * sign, v2, (MC_BUFFER_MODE)mode);
                    const double expected = mode == mcBlendingLow ? fmin(v1, v2) : mode == mcBlendingPrevious ? v1
                                            : mode == mcBlendingNext ? v2 : fmax(v1, v2);
                    double fastest = 0.0; /* the first one cruises with its own velocity */
                    while (fabs(bench_info().set_position) < 8.0) {
                        watch_cycles(1);
                        fastest = fmax(fastest, fabs(axis->setpoint.velocity));
                    }
                    TEST_ASSERT_DOUBLE_WITHIN(1e-9, v1, fastest);
                    /* without acceleration there, the velocity of a cycle differs by what a jerk can do in it */
                    TEST_ASSERT_DOUBLE_WITHIN(2000.0 * 1e-6, sign * expected, velocity_at(10.0 * sign));
                    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(first));
                    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(second));
                    watch_cycles(15000);
                    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(second));
                    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 20.0 * sign, bench_info().set_position);
                    TEST_ASSERT_TRUE(watch.highest <= 20.0 + 1e-9 && watch.lowest >= -20.0 - 1e-9);
                }
}

static void test_a_turn_is_a_stop_at_the_position(void)
{
    for (int mode = mcBuffered; mode <= mcBlendingHigh; mode++) {
        setUp();
        const cm1e_command_id_t first = post_absolute(5.0, 5.0, mcAborting);
        const cm1e_command_id_t second = post_absolute(1.0, 5.0, (MC_BUFFER_MODE)mode);
        watch_cycles(5000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(first));
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(second));
        TEST_ASSERT_TRUE(watch.highest <= 5.0 + 1e-9);
        TEST_ASSERT_TRUE(watch.highest >= 5.0 - 1e-4);
    }
}

/* A way in pieces, blended, is the way in one piece: at every set-point, however the junctions lie to the cycles. */
static void test_a_way_in_pieces_is_the_same_as_in_one(void)
{
    static const double ends[] = {8.01234, 9.0, 9.00071, 9.5555, 11.1, 13.7, 13.9, 16.0, 25.0};
    enum { PIECES = sizeof ends / sizeof ends[0], CYCLES = 5000 };
    static double whole[CYCLES];
    for (int mode = mcBlendingLow; mode <= mcBlendingHigh; mode++) {
        setUp();
        post_absolute(25.0, 6.0, mcAborting);
        for (int i = 0; i < CYCLES; i++) {
            watch_cycles(1);
            whole[i] = bench_info().set_position;
        }
        setUp();
        for (int i = 0; i < PIECES; i++)
            post_absolute(ends[i], 6.0, i ? (MC_BUFFER_MODE)mode : mcAborting);
        for (int i = 0; i < CYCLES; i++) {
            watch_cycles(1);
            TEST_ASSERT_DOUBLE_WITHIN(2e-9, whole[i], bench_info().set_position);
        }
    }
}

/* mcBuffered loses no time either: the second begins inside the cycle in which the first ends. */
static void test_buffered_begins_at_the_very_moment(void)
{
    const cm1e_motion_state_t rest = {0};
    const cm1e_motion_limits_t limits = {6.0, 100.0, 80.0, 2000.0};
    cm1e_profile_t profiles[4];
    const double ways[4] = {1.234, 0.0017, -3.1, 0.5};
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_profile_to_position(&profiles[i], &rest, ways[i], &limits));
        post(CM1E_COMMAND_MOVE_RELATIVE, ways[i], 6.0, i ? mcBuffered : mcAborting);
    }
    for (int n = 1; n < 3000; n++) {
        watch_cycles(1);
        double time_s = n * 1e-3, expected = 0.0;
        for (int i = 0; i < 4; i++) {
            cm1e_motion_state_t state;
            cm1e_profile_sample(&profiles[i], time_s, &state);
            if (time_s > 0.0)
                expected += state.position;
            time_s -= profiles[i].duration_s;
        }
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, expected, bench_info().set_position);
    }
}

/* Moves shorter than a cycle lasts are passed as well. */
static void test_moves_shorter_than_a_cycle(void)
{
    post_absolute(5.0, 20.0, mcAborting);
    for (int i = 0; i < CM1E_AXIS_BUFFER_DEPTH - 1; i++)
        post(CM1E_COMMAND_MOVE_RELATIVE, 0.002, 20.0, mcBlendingPrevious);
    const cm1e_command_id_t last = post_absolute(10.0, 20.0, mcBlendingPrevious);
    double slowest = 1e9;
    while (bench_info().set_position < 6.9) {
        watch_cycles(1);
        if (bench_info().set_position > 4.5)
            slowest = fmin(slowest, axis->setpoint.velocity);
    }
    TEST_ASSERT_EQUAL_DOUBLE(20.0, slowest);
    watch_cycles(2000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(last));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 10.0, bench_info().set_position);
}

/* A late successor is blended into as far as the way still allows. */
static void test_too_late_to_blend_is_as_fast_as_the_way_allows(void)
{
    double fastest_before = 1e9;
    for (int wait = 0; wait < 600; wait += 7) {
        setUp();
        const cm1e_command_id_t first = post_absolute(2.0, 5.0, mcAborting);
        watch_cycles(wait);
        const bool over = bench_state_of(first) == CM1E_COMMAND_DONE;
        const cm1e_command_id_t second = post_absolute(6.0, 5.0, mcBlendingPrevious);
        const double passed = over ? 0.0 : velocity_at(2.0);
        TEST_ASSERT_TRUE(passed <= 5.0 + 1e-9 && passed <= fastest_before + 0.05); /* later is never faster */
        TEST_ASSERT_TRUE(wait > 300 || passed > 4.9);
        fastest_before = passed;
        watch_cycles(4000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(second));
        TEST_ASSERT_TRUE(watch.highest <= 6.0 + 1e-9);
    }
}

/* After MC_MoveVelocity: from InVelocity on, whatever the mode. */
static void test_blending_after_a_velocity_is_previous(void)
{
    for (int mode = mcBuffered; mode <= mcBlendingHigh; mode++) {
        setUp();
        const cm1e_command_id_t first = post(CM1E_COMMAND_MOVE_VELOCITY, 0.0, 7.0, mcAborting);
        const cm1e_command_id_t second = post(CM1E_COMMAND_MOVE_RELATIVE, 3.0, 2.0, (MC_BUFFER_MODE)mode);
        double fastest = 0.0, before = 0.0;
        while (bench_state_of(second) == CM1E_COMMAND_BUFFERED) {
            before = bench_info().set_position;
            watch_cycles(1);
            fastest = fmax(fastest, axis->setpoint.velocity);
        }
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, bench_state_of(first));
        TEST_ASSERT_DOUBLE_WITHIN(2e-3, 7.0, fastest);
        watch_cycles(5000);
        TEST_ASSERT_DOUBLE_WITHIN(7e-3, before + 3.0, bench_info().set_position);
    }
}

static void test_a_velocity_after_a_move_counts_for_the_junction(void)
{
    post_absolute(3.0, 4.0, mcAborting);
    const cm1e_command_id_t second = post(CM1E_COMMAND_MOVE_VELOCITY, 0.0, 8.0, mcBlendingHigh);
    TEST_ASSERT_DOUBLE_WITHIN(2e-3, 8.0, velocity_at(3.0));
    watch_cycles(1);
    TEST_ASSERT_TRUE(cm1e_axis_command_status(axis, second).reached);
    post(CM1E_COMMAND_HALT, 0.0, 0.0, mcBuffered);
    watch_cycles(2000);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
}

/* Blended into a halt: its velocity is 0, so only Previous and High pass the position. */
static void test_a_halt_blended_behind_a_move(void)
{
    for (int mode = mcBuffered; mode <= mcBlendingHigh; mode++) {
        setUp();
        post_absolute(3.0, 4.0, mcAborting);
        const cm1e_command_id_t halt = post(CM1E_COMMAND_HALT, 0.0, 0.0, (MC_BUFFER_MODE)mode);
        watch_cycles(3000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(halt));
        if (mode == mcBlendingPrevious || mode == mcBlendingHigh)
            TEST_ASSERT_TRUE(bench_info().set_position > 3.05);
        else
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, 3.0, bench_info().set_position);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    }
}

/* The next command may not be able to begin so close to a software limit: the axis is not so fast there that it would
 * run over it, nor into ErrorStop on a way that is allowed. Behind it a velocity meets the limit as it always does. */
static void test_a_junction_at_a_software_limit(void)
{
    static const double rooms[] = {0.0, 1e-5, 0.01, 0.2};
    static const cm1e_command_kind_t thirds[] = {CM1E_COMMAND_MOVE_VELOCITY, CM1E_COMMAND_HALT,
                                                 CM1E_COMMAND_MOVE_CONTINUOUS_RELATIVE};
    for (int n = 0; n < 4 * 3 * 20; n++) {
        const double end = 10.0 - rooms[n % 4];
        const cm1e_command_kind_t kind = thirds[n / 4 % 3];
        bus.config.axes[0].software_limit_positive = 10.0;
        bus.config.axes[0].software_limit_negative = -10.0;
        begin_as_described();
        post_absolute(end - 0.5, 9.0, mcAborting);
        const cm1e_command_id_t second = post_absolute(end, 0.2 + n * 0.04, mcBlendingPrevious);
        const cm1e_command_id_t third = bench_start_command(&(cm1e_axis_command_t){
            .kind = kind, .position = rooms[n % 4] / 2.0, .velocity = 9.0, .end_velocity = 9.0,
            .buffer_mode = mcBlendingPrevious});
        watch_cycles(6000);
        TEST_ASSERT_TRUE(watch.highest <= 10.0 + 1e-6 && watch.highest >= end - 1e-4);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(second));
        TEST_ASSERT_EQUAL_INT(kind == CM1E_COMMAND_HALT ? CM1E_COMMAND_DONE : CM1E_COMMAND_ERROR,
                              bench_state_of(third));
        const bool runs_up = kind == CM1E_COMMAND_MOVE_CONTINUOUS_RELATIVE; /* from behind, then meets the limit */
        if ((rooms[n % 4] == 0.0 && !runs_up) || kind == CM1E_COMMAND_HALT)
            TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_AXIS_STANDSTILL, axis->state, cm1e_axis_state_name(axis->state));
    }
}

/* Random chains one way: never beyond an end before its turn, never back, never a stop without need, and in a time not
 * longer than with stops. */
static void test_random_chains_never_stop_and_never_overrun(void)
{
    for (unsigned run = 0; run < 300; run++) {
        seed = 0x9E3779B97F4A7C15u * (run + 1);
        char name[32];
        snprintf(name, sizeof name, "of run %u", run);
        begin_with(uniform(20, 200), uniform(20, 200), uniform(300, 9000));
        watch.run = name;
        const double sign = uniform(0, 1) < 0.5 ? -1.0 : 1.0;
        double end = 0.0;
        int posted = 0, n = 0;
        cm1e_command_id_t id = 0;
        for (; n < 40000; n++) {
            if (posted < 20 && axis->commands.waiting.count < CM1E_AXIS_BUFFER_DEPTH &&
                (posted < 5 || uniform(0, 1) < 0.02)) {
                end += sign * pow(10.0, uniform(-3, 0.7));
                id = bench_start_command(&(cm1e_axis_command_t){
                    .kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = end, .velocity = uniform(0.5, 20),
                    .acceleration = uniform(0.3, 1) * axis->limits.maximum.acceleration,
                    .deceleration = uniform(0.3, 1) * axis->limits.maximum.deceleration,
                    .jerk = uniform(0.3, 1) * axis->limits.maximum.jerk,
                    .buffer_mode = posted ? (MC_BUFFER_MODE)(mcBlendingLow + (int)uniform(0, 4)) : mcAborting});
                posted++;
            }
            const double before = bench_info().set_position;
            watch_cycles(1);
            const double step = sign * (bench_info().set_position - before);
            WATCH(step >= -1e-9, "backwards by %g", step);
            WATCH(sign * (bench_info().set_position - end) <= 1e-9, "beyond the last end by %g",
                  sign * (bench_info().set_position - end));
            WATCH(axis->commands.waiting.count == 0 || n < 2 || step > 1e-9,
                  "a stop with %d to go, exit %g", axis->commands.waiting.count,
                  axis->commands.move.exit_velocity);
            if (posted == 20 && axis_holds(axis))
                break;
        }
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, end, bench_info().set_position);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_velocity_at_the_junction_is_what_the_mode_says);
    RUN_TEST(test_a_turn_is_a_stop_at_the_position);
    RUN_TEST(test_a_way_in_pieces_is_the_same_as_in_one);
    RUN_TEST(test_buffered_begins_at_the_very_moment);
    RUN_TEST(test_moves_shorter_than_a_cycle);
    RUN_TEST(test_too_late_to_blend_is_as_fast_as_the_way_allows);
    RUN_TEST(test_blending_after_a_velocity_is_previous);
    RUN_TEST(test_a_velocity_after_a_move_counts_for_the_junction);
    RUN_TEST(test_a_halt_blended_behind_a_move);
    RUN_TEST(test_a_junction_at_a_software_limit);
    RUN_TEST(test_random_chains_never_stop_and_never_overrun);
    return UNITY_END();
}
