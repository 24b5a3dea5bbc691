/*
 * MC_SetPosition while commands wait (3.17): the coordinates shift and nothing else. A command that was given before
 * ends at the place that its Position had then; a Position given later is meant in the new coordinates.
 * CM1E_TEST_SEED=<n> repeats one run, CM1E_TEST_SEEDS=<count> as many from there on.
 */
#include "../support/axis_bench.h"
#include "../support/axis_witness.h"
#include "../support/chance.h"

enum { RUNS = 300, CYCLES = 9000, CHAIN = 4 };

void setUp(void) { bench_end(); }
void tearDown(void) { bench_end(); }

static cm1e_command_id_t post(cm1e_command_kind_t kind, double position, double velocity, MC_BUFFER_MODE mode)
{
    return bench_start_command(&(cm1e_axis_command_t){.kind = kind, .position = position, .velocity = velocity,
                                                      .buffer_mode = mode});
}

static void begin(double modulo_range, bool invert)
{
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.config.axes[0].modulo_range = modulo_range;
    bus.config.axes[0].invert = invert;
    bench_create();
    bench_enable();
    watch_begin();
}

static void set_position(double position, bool relative)
{
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_position(axis, position, relative));
}

/* ---- the place --------------------------------------------------------------------------------------------------- */

static void test_waiting_target_keeps_its_place(void)
{
    static const double shifts[] = {0.5, -0.5, 3.95, -20.0};
    for (int mode = mcBuffered; mode <= mcBlendingHigh; mode++)
        for (int k = 0; k < 4; k++) {
            begin(0.0, false);
            post(CM1E_COMMAND_MOVE_ABSOLUTE, 5.0, 6.0, mcAborting);
            const cm1e_command_id_t second = post(CM1E_COMMAND_MOVE_ABSOLUTE, 9.0, 10.0, (MC_BUFFER_MODE)mode);
            bench_cycles(300);
            set_position(shifts[k], true);
            bench_cycles(6000);
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(second));
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, 9.0 + shifts[k], bench_info().set_position);
            TEST_ASSERT_EQUAL_INT32(450000, bus.position);
            bench_end();
        }
}

/* What the motor is told, cycle by cycle, with shifts at random moments and without. */
static int32_t run(unsigned seed, bool shifted, int32_t *targets)
{
    chance_seed(seed);
    const double range = one_in(2) ? 0.0 : uniform(0.5, 3.0);
    begin(range, one_in(2));
    cm1e_command_id_t last = 0;
    for (int i = 0; i < CHAIN; i++) {
        const bool absolute = one_in(2);
        const double position = absolute && range > 0.0 ? uniform(0.0, 1.0) * range : uniform(-3.0, 3.0);
        const cm1e_axis_command_t command = {
            .kind = absolute ? CM1E_COMMAND_MOVE_ABSOLUTE : CM1E_COMMAND_MOVE_RELATIVE, .position = position,
            .velocity = uniform(4.0, 20.0), .acceleration = uniform(20.0, 100.0), .jerk = uniform(500.0, 2000.0),
            .direction = (MC_DIRECTION)(mcPositiveDirection + pick(4)),
            .buffer_mode = i ? (MC_BUFFER_MODE)(mcBuffered + pick(5)) : mcAborting};
        last = bench_start_command(&command);
    }
    for (int i = 0; i < CYCLES; i++) {
        const bool now = one_in(100), relative = one_in(2);
        const double to = range > 0.0 && !relative ? uniform(0.0, 1.0) * range : uniform(-5.0, 5.0);
        if (now && shifted)
            set_position(to, relative);
        bench_cycles(1);
        targets[i] = bus.target_position;
    }
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(last));
    bench_end();
    return targets[CYCLES - 1];
}

static void test_shifts_move_nothing(void)
{
    static int32_t plain[CYCLES], shifted[CYCLES];
    const int runs = seed_count(RUNS);
    for (int i = 0; i < runs; i++) {
        const unsigned seed = seed_of(i);
        char text[96];
        run(seed, false, plain);
        run(seed, true, shifted);
        for (int n = 0; n < CYCLES; n++) {
            snprintf(text, sizeof text, "cycle %d of CM1E_TEST_SEED=%u", n, seed);
            /* the half of a count that is rounded to the one or the other side */
            TEST_ASSERT_INT32_WITHIN_MESSAGE(1, plain[n], shifted[n], text);
        }
    }
}

/* ---- a Position given later -------------------------------------------------------------------------------------- */

static void test_continuous_update_means_the_new_coordinates_only_with_another_position(void)
{
    for (int active = 0; active < 2; active++)
        for (int changed = 0; changed < 2; changed++) {
            begin(0.0, false);
            cm1e_axis_command_t command = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 9.0, .velocity = 10.0,
                                           .buffer_mode = active ? mcAborting : mcBlendingHigh};
            if (!active)
                post(CM1E_COMMAND_MOVE_ABSOLUTE, 5.0, 6.0, mcAborting);
            const cm1e_command_id_t id = bench_start_command(&command);
            for (int n = 0; n < 4000; n++) {
                if (n == 100)
                    set_position(2.0, true);
                if (n == 110 && changed)
                    command.position = 9.5;
                if (n == 120)
                    command.velocity = 8.0;
                TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_update(axis, id, &command));
                bench_cycles(1);
            }
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, changed ? 9.5 : 11.0, bench_info().set_position);
            bench_end();
        }
}

/* ---- software limits --------------------------------------------------------------------------------------------- */

static void limits(double negative, double positive)
{
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.config.axes[0].software_limit_negative = negative;
    bus.config.axes[0].software_limit_positive = positive;
    bench_create();
    bench_enable();
    watch_begin();
}

static void test_shift_that_takes_a_waiting_target_outside_is_refused(void)
{
    for (int relative = 0; relative < 2; relative++) {
        limits(-10.0, 10.0);
        post(CM1E_COMMAND_MOVE_ABSOLUTE, 5.0, 6.0, mcAborting);
        const cm1e_command_id_t second = post(relative ? CM1E_COMMAND_MOVE_RELATIVE : CM1E_COMMAND_MOVE_ABSOLUTE,
                                              relative ? 4.0 : 9.0, 6.0, mcBlendingLow);
        bench_cycles(200);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_set_position(axis, 1.01, true));
        const double before = bench_info().set_position;
        set_position(1.0, true);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, before + 1.0, bench_info().set_position);
        bench_cycles(6000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(second));
        TEST_ASSERT_EQUAL_DOUBLE(10.0, bench_info().set_position);
        bench_end();
    }
}

/* Behind the corner lies a command that has no target: it may go on only as far as the axis can be braked. */
static void test_shift_is_taken_up_by_the_corner_or_refused(void)
{
    int taken = 0, refused = 0;
    for (int when = 0; when < 1400; when += 7)
        for (int k = 0; k < 3; k++) {
            limits(-10.0, 10.0);
            post(CM1E_COMMAND_MOVE_ABSOLUTE, 8.0, 12.0, mcAborting);
            post(CM1E_COMMAND_MOVE_VELOCITY, 0.0, 12.0, mcBlendingHigh);
            bench_cycles(when % 1000);
            const double shift = 0.6 + 0.6 * k;
            if (cm1e_axis_set_position(axis, shift, true) == CM1E_OK)
                taken++;
            else
                refused++;
            watch_begin();
            for (int n = 0; n < 2000; n++) {
                watch_cycles(1);
                TEST_ASSERT_TRUE(watch.highest <= 10.0 + 1e-9);
            }
            bench_end();
        }
    TEST_ASSERT_TRUE(taken > 10 && refused > 10);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_waiting_target_keeps_its_place);
    RUN_TEST(test_shifts_move_nothing);
    RUN_TEST(test_continuous_update_means_the_new_coordinates_only_with_another_position);
    RUN_TEST(test_shift_that_takes_a_waiting_target_outside_is_refused);
    RUN_TEST(test_shift_is_taken_up_by_the_corner_or_refused);
    return UNITY_END();
}
