/* MC_SetOverride (3.18): factors on the dynamics of what moves the axis. */
#include "axis/axis_parameters.h"

#include "../support/effort.h"
#include "../support/axis_bench.h"
#include "../support/axis_witness.h"
#include "../support/xorshift.h"

static uint64_t seed;

static double draw(double low, double high)
{
    return xorshift_between(&seed, low, high);
}

void setUp(void)
{
    bench_end();
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.config.axes[0].max_acceleration = 100.0;
    bus.config.axes[0].max_deceleration = 80.0;
    bus.config.axes[0].max_jerk = 2000.0;
    bus.config.axes[0].software_limit_negative = -50.0;
    bus.config.axes[0].software_limit_positive = 50.0;
    bench_create();
    bench_enable();
    watch_begin();
}
void tearDown(void) { bench_end(); }

static void override(double velocity, double acceleration, double jerk)
{
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axis, velocity, acceleration, jerk));
}

static cm1e_command_id_t post(cm1e_command_kind_t kind, double position, double velocity, MC_BUFFER_MODE mode)
{
    return bench_start_command(&(cm1e_axis_command_t){.kind = kind, .position = position, .velocity = velocity,
                                                      .end_velocity = 2.0, .buffer_mode = mode});
}

static void test_velocity_factor_acts_on_the_motion_and_on_the_next(void)
{
    const cm1e_command_id_t first = bench_move_to(20.0, 10.0);
    watch_cycles(500);
    TEST_ASSERT_EQUAL_DOUBLE(10.0, axis->setpoint.velocity);
    override(0.5, 1.0, 1.0);
    watch_cycles(300);
    TEST_ASSERT_EQUAL_DOUBLE(5.0, axis->setpoint.velocity);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISCRETE_MOTION, bench_info().state);
    override(1.0, 1.0, 1.0);
    watch_cycles(300);
    TEST_ASSERT_EQUAL_DOUBLE(10.0, axis->setpoint.velocity);
    override(0.3, 1.0, 1.0);
    watch_cycles(6000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(first));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 20.0, bench_info().set_position);
    const cm1e_command_id_t second = bench_move_velocity(10.0); /* kept until it is set anew */
    watch_cycles(300);
    TEST_ASSERT_EQUAL_DOUBLE(3.0, axis->setpoint.velocity);
    TEST_ASSERT_TRUE(cm1e_axis_command_status(axis, second).reached);
}

static void test_acceleration_and_jerk_factors_bound_what_follows(void)
{
    override(1.0, 0.25, 0.5);
    bench_move_to(20.0, 10.0);
    double most = 0.0, jerk = 0.0, before = 0.0;
    for (int i = 0; i < 4000; i++) {
        watch_cycles(1);
        most = fmax(most, fabs(axis->setpoint.acceleration));
        jerk = fmax(jerk, fabs(axis->setpoint.acceleration - before) / 1e-3);
        before = axis->setpoint.acceleration;
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 25.0, most);
    TEST_ASSERT_TRUE(jerk <= 1000.0 + 1e-6);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 20.0, bench_info().set_position);
}

static void test_velocity_0_stands_without_standstill_and_goes_on(void)
{
    static const cm1e_command_kind_t kinds[] = {CM1E_COMMAND_MOVE_ABSOLUTE, CM1E_COMMAND_MOVE_VELOCITY,
                                                CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE};
    for (int k = 0; k < 3; k++)
        for (int wait = 0; wait < 1200; wait += 97) {
            setUp();
            const cm1e_command_id_t id = post(kinds[k], 8.0, 10.0, mcAborting);
            watch_cycles(wait);
            const bool over = bench_state_of(id) == CM1E_COMMAND_DONE;
            override(0.0, 1.0, 1.0);
            watch_cycles(400);
            TEST_ASSERT_EQUAL_DOUBLE(0.0, axis->setpoint.velocity);
            TEST_ASSERT_FALSE(cm1e_axis_command_status(axis, id).reached);
            const double at = bench_info().set_position;
            watch_cycles(100);
            TEST_ASSERT_EQUAL_DOUBLE(at, bench_info().set_position);
            if (!over) {
                TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(id));
                TEST_ASSERT_EQUAL_INT(k == 0 ? CM1E_AXIS_DISCRETE_MOTION : CM1E_AXIS_CONTINUOUS_MOTION,
                                      bench_info().state);
            }
            override(1.0, 1.0, 1.0);
            watch_cycles(2500);
            if (k == 0) {
                TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
                TEST_ASSERT_DOUBLE_WITHIN(1e-9, 8.0, bench_info().set_position);
                TEST_ASSERT_TRUE(watch.highest <= 8.0 + 1e-9);
            } else {
                TEST_ASSERT_TRUE(cm1e_axis_command_status(axis, id).reached);
            }
        }
}

static void test_commands_given_while_velocity_is_0_begin_when_it_is_not(void)
{
    override(0.0, 1.0, 1.0);
    const cm1e_command_id_t first = post(CM1E_COMMAND_MOVE_ABSOLUTE, 2.0, 5.0, mcAborting);
    const cm1e_command_id_t second = post(CM1E_COMMAND_MOVE_ADDITIVE, 3.0, 5.0, mcBlendingHigh);
    watch_cycles(500);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, bench_info().set_position);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISCRETE_MOTION, bench_info().state);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(first));
    const cm1e_axis_command_t bad = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 51.0, .velocity = 1.0};
    cm1e_command_id_t id;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_start(axis, &bad, &id));
    const cm1e_command_id_t third = post(CM1E_COMMAND_MOVE_ADDITIVE, 4.0, 5.0, mcAborting); /* to 2 + 4 */
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, bench_state_of(second));
    override(0.5, 1.0, 1.0);
    watch_cycles(4000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(third));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 6.0, bench_info().set_position);
}

/* The software limit was moved before the target meanwhile. The axis stands, and other commands move it. */
static void test_a_command_that_cannot_go_on_after_velocity_0_ends(void)
{
    for (int wait = 50; wait < 900; wait += 200) { /* from while it brakes on */
        setUp();
        const cm1e_command_id_t id = post(CM1E_COMMAND_MOVE_ABSOLUTE, 40.0, 10.0, mcAborting);
        watch_cycles(600);
        override(0.0, 1.0, 1.0);
        watch_cycles(wait);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_parameter(axis, CM1E_PARAMETER_SW_LIMIT_POS, 20.0));
        override(1.0, 1.0, 1.0);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, bench_state_of(id));
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_command_status(axis, id).error);
        watch_cycles(400);
        TEST_ASSERT_EQUAL_DOUBLE(0.0, axis->setpoint.velocity);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
        const cm1e_command_id_t next = bench_move_to(19.0, 10.0);
        watch_cycles(4000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(next));
    }
}

/* As MC_SetOverride does in every call with factors that are refused. */
static void refused(double velocity, double acceleration, double jerk, bool begins)
{
    const cm1e_error_t error = cm1e_axis_set_override(axis, velocity, acceleration, jerk);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_OVERRIDE, error);
    cm1e_axis_refuse_override(axis, error, velocity, acceleration, jerk, begins);
}

/* 3.18, note 4, figure 36. */
static void test_factors_out_of_range_change_nothing(void)
{
    bench_move_to(20.0, 10.0);
    watch_cycles(300);
    const int64_t cycles = axis->setpoint.profile_cycles;
    static const double bad[][3] = {{1, 0, 1}, {1, 1, 0}, {-0.1, 1, 1}, {1.1, 1, 1}, {1, 1.1, 1}, {1, 1, -1},
                                    {NAN, 1, 1}, {1, NAN, 1}, {1, 1, NAN}, {INFINITY, 1, 1}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        refused(bad[i][0], bad[i][1], bad[i][2], i == 0);
    bench_told("MC_SetOverride to VelFactor inf, AccFactor 1, JerkFactor 1: ");
    bench_told("VelFactor 0 ... 1, AccFactor and JerkFactor above 0, up to 1 are right");
    /* The block asks again in every cycle; what is refused later is told all the same. */
    TEST_ASSERT_NOT_EQUAL_INT(CM1E_OK, cm1e_axis_set_position(axis, NAN, false));
    refused(INFINITY, 1, 1, false);
    bench_told("MC_SetPosition");
    refused(2, 1, 1, true);
    bench_told("MC_SetOverride to VelFactor 2,");
    override(1.0, 1.0, 1.0); /* no change: no new plan */
    cm1e_axis_reads_right(axis);
    char text[CM1E_AXIS_ERROR_TEXT_BYTES];
    cm1e_axis_error_text(cm1e_axis_reference(axis), text, sizeof text);
    TEST_ASSERT_EQUAL_STRING("", text);
    TEST_ASSERT_EQUAL_INT64(cycles, axis->setpoint.profile_cycles);
}

/* MC_MoveContinuousRelative by 0 of an axis that moves: its run-up leads back first, as slowly as the factors say. */
static void test_factors_act_on_a_run_up_to_the_present_position(void)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        setUp();
        bench_move_velocity(sign * 4.0);
        watch_cycles(500);
        override(1.0, 0.25, 1.0);
        const double at = bench_info().set_position;
        const cm1e_command_id_t id = bench_start_command(&(cm1e_axis_command_t){
            .kind = CM1E_COMMAND_MOVE_CONTINUOUS_RELATIVE, .velocity = 4.0, .end_velocity = sign * 2.0});
        double most = 0.0;
        for (int i = 0; i < 5000 && !cm1e_axis_command_status(axis, id).reached; i++) {
            watch_cycles(1);
            most = fmax(most, fabs(axis->setpoint.acceleration));
        }
        TEST_ASSERT_TRUE(cm1e_axis_command_status(axis, id).reached);
        TEST_ASSERT_DOUBLE_WITHIN(2e-3, at, bench_info().set_position);
        TEST_ASSERT_EQUAL_DOUBLE(sign * 2.0, axis->setpoint.velocity);
        TEST_ASSERT_DOUBLE_WITHIN(1e-6, 25.0, most);
    }
}

/* Less deceleration in the middle of braking does not lead beyond the target (note 9 warns of it). */
static void test_less_deceleration_never_passes_the_target(void)
{
    for (int wait = 0; wait < 1000; wait += 13 * slowness()) {
        setUp();
        const cm1e_command_id_t id = bench_move_to(5.0, 15.0);
        watch_cycles(wait);
        override(wait % 2 ? 1.0 : 0.2, 0.1, 0.2);
        watch_cycles(8000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
        TEST_ASSERT_TRUE(watch.highest <= 5.0 + 1e-9);
    }
}

/* Less jerk while the axis brakes: to end the braking takes longer than the axis has until it stands, which would lead
 * it back for a long way, and, planned anew on that, beyond the target. */
static void test_less_jerk_while_braking_leads_neither_back_nor_beyond(void)
{
    for (int change = 900; change < 1200; change += 3 * slowness()) {
        fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        bench_create();
        bench_enable();
        watch_begin();
        const cm1e_command_id_t id = bench_start_command(&(cm1e_axis_command_t){
            .kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 10.0, .velocity = 12.0, .acceleration = 20.0,
            .deceleration = 100.0, .jerk = 1200.0});
        double before = 0.0;
        for (int i = 0; i < 3000; i++) {
            if (i == change)
                override(0.25, 1.0, 0.1);
            if (i == change + 30)
                override(0.0, 1.0, 0.28);
            if (i == 2000)
                override(1.0, 1.0, 1.0);
            watch_cycles(1);
            WATCH(bench_info().set_position >= before - 1e-9, "back to %.9g", bench_info().set_position);
            before = bench_info().set_position;
        }
        WATCH(watch.highest <= 10.0 + 1e-9, "changed at %d: %.9g", change, watch.highest);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
        bench_end();
    }
}

static void test_stop_is_not_slowed(void)
{
    bench_move_velocity(10.0);
    watch_cycles(500);
    override(1.0, 0.1, 0.1);
    const cm1e_command_id_t stop = post(CM1E_COMMAND_STOP, 0.0, 0.0, mcAborting);
    const int took = bench_wait(stop, 3000);
    TEST_ASSERT_TRUE(took < 200); /* 10 / 80 + 80 / 2000 s */
}

/* Any change at any time, over chains with and without blending: limits hold, and each end is reached exactly. */
static void test_random_changes_over_random_chains(void)
{
    for (unsigned run = 0; run < 150u / (unsigned)slowness(); run++) {
        setUp();
        seed = 0x9E3779B97F4A7C15u * (run + 1);
        char name[32];
        snprintf(name, sizeof name, "of run %u", run);
        watch.run = name;
        cm1e_command_id_t id = 0;
        double end = 0.0;
        for (int i = 0; i < 6; i++) {
            end = draw(-20.0, 20.0);
            id = bench_start_command(&(cm1e_axis_command_t){
                .kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = end, .velocity = draw(1.0, 20.0),
                .acceleration = draw(20.0, 100.0), .deceleration = draw(20.0, 80.0), .jerk = draw(300.0, 2000.0),
                .buffer_mode = i ? (MC_BUFFER_MODE)draw(mcBuffered, mcBlendingHigh + 0.99) : mcAborting});
        }
        for (int i = 0; i < 5000; i++) {
            if (draw(0.0, 1.0) < 0.01)
                override(draw(0.0, 1.0) < 0.3 ? 0.0 : draw(0.01, 1.0), draw(0.05, 1.0), draw(0.05, 1.0));
            watch_cycles(1);
            WATCH(fabs(bench_info().set_position) <= 50.0 + 1e-9, "outside at %g", bench_info().set_position);
            TEST_ASSERT_NOT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
        }
        override(1.0, 1.0, 1.0);
        watch_cycles(80000 / (1 + (int)run % 3));
        if (run % 3 == 0) {
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
            TEST_ASSERT_DOUBLE_WITHIN(1e-9, end, bench_info().set_position);
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_velocity_factor_acts_on_the_motion_and_on_the_next);
    RUN_TEST(test_acceleration_and_jerk_factors_bound_what_follows);
    RUN_TEST(test_factors_act_on_a_run_up_to_the_present_position);
    RUN_TEST(test_velocity_0_stands_without_standstill_and_goes_on);
    RUN_TEST(test_commands_given_while_velocity_is_0_begin_when_it_is_not);
    RUN_TEST(test_a_command_that_cannot_go_on_after_velocity_0_ends);
    RUN_TEST(test_factors_out_of_range_change_nothing);
    RUN_TEST(test_less_deceleration_never_passes_the_target);
    RUN_TEST(test_less_jerk_while_braking_leads_neither_back_nor_beyond);
    RUN_TEST(test_stop_is_not_slowed);
    RUN_TEST(test_random_changes_over_random_chains);
    return UNITY_END();
}
