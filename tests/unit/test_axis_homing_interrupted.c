/* Homing in steps (Part 5): every way to be interrupted, at every cycle of a sequence of steps. */
#include "../support/homing_bench.h"
#include "effort.h"

/* The sequence: the switch by way of a limit switch, the stop, a move away. Ends with the last command. */
static cm1e_command_id_t sequence_id;
static int sequence_step;

static void sequence_next(void)
{
    static const cm1e_homing_step_t steps[] = {
        {.kind = CM1E_STEP_ABSOLUTE_SWITCH, .mode = mcFallingEdge},
        {.kind = CM1E_STEP_BLOCK, .direction = mcNegativeDirection, .torque_limit = 20.0},
        {.kind = CM1E_STEP_FINISH},
    };
    if (sequence_step > 0 && bench_state_of(sequence_id) != CM1E_COMMAND_DONE)
        return;
    if (sequence_step == 3)
        return;
    if (sequence_step == 1)
        limits_there = false; /* so that the stop is reached */
    step = steps[sequence_step];
    sequence_id = start(1.5, sequence_step == 2 ? 0.2 : -1.0);
    sequence_step++;
}

static bool sequence_done(void) { return sequence_step == 3 && bench_state_of(sequence_id) == CM1E_COMMAND_DONE; }

/* `n` cycles of the sequence from its beginning; FALSE: it is shorter. */
static bool sequence_until(int n)
{
    limits_there = true;
    begin_at(30000);
    sequence_step = 0;
    sequence_next();
    for (int i = 0; i < n; i++) {
        bench_cycles(1);
        sequence_next();
        if (sequence_done())
            return false;
    }
    return true;
}

/** Of the cycles that are interrupted. */
static int stride(void) { return sweep_stride(3, 10); }

/* 1.5 u/s brakes within 0.1 s. */
static const int32_t braking_counts = 7500;

static void settle(int at_most, cm1e_axis_state_t state, int32_t from)
{
    for (int i = 0; i < at_most && bench_info().state != state; i++)
        bench_cycles(1);
    TEST_ASSERT_EQUAL_STRING(cm1e_axis_state_name(state), cm1e_axis_state_name(bench_info().state));
    TEST_ASSERT_INT32_WITHIN(braking_counts, from, bus.position);
}

static void test_mc_stop_at_every_cycle(void)
{
    int n = 0;
    for (; sequence_until(n); n += stride()) {
        const int32_t from = bus.position;
        const cm1e_command_id_t running = sequence_id;
        const bool was_active = bench_state_of(running) == CM1E_COMMAND_ACTIVE;
        const cm1e_command_id_t stop = bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP});
        if (was_active)
            expect(running, CM1E_COMMAND_ABORTED, CM1E_OK);
        cm1e_axis_hold_stop(axis, stop, false);
        settle(2000, CM1E_AXIS_STANDSTILL, from);
        expect(stop, CM1E_COMMAND_DONE, CM1E_OK);
        expect_standing(); /* and does not push */
        TEST_ASSERT_FALSE(bench_info().homed);
    }
    TEST_ASSERT_GREATER_THAN_INT(1000, n);
    TEST_ASSERT_TRUE(bench_info().homed); /* the sequence itself was right */
}

/* Power that comes back within the ramp, before the torque was gone: the motor is relieved with it, and a later MC_Stop
 * has nothing to take back. */
static void test_power_back_within_the_ramp_relieves_the_motor(void)
{
    for (int gap = 1; gap <= 40; gap++) {
        limits_there = false;
        step = block(1, 60.0);
        step.detection_ns = 5000 * MS_IN_NS;
        begin_at(59000);
        start(0.2, 0.0);
        for (int i = 0; i < 2000 && bus.torque < 300; i++)
            bench_cycles(1);
        TEST_ASSERT_GREATER_OR_EQUAL_INT(300, bus.torque);
        bench_power(false);
        bench_cycles(gap);
        bench_power(true);
        bench_cycles(50); /* of the ramp, and of a drive that is being disabled meanwhile */
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
        expect_standing();
        const int32_t target = bus.target_position;
        cm1e_axis_hold_stop(axis, bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP}), false);
        bench_cycles(200);
        TEST_ASSERT_EQUAL_INT32(target, bus.target_position);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
        bench_end();
        configure(false);
    }
}

/* Behind a soft drive, or with a long lag, the set-point is far beyond the stop. Its way back to the motor is no jump: no
 * target goes farther in a cycle than a motor can, also where answers are missing meanwhile. */
static void test_power_back_within_the_ramp_goes_back_to_the_motor_without_a_jump(void)
{
    static const int32_t far = 12000;
    for (int n = 0; n < 5 * 4; n++) {
        const int gap = 1 + n / 4, lost = n % 4;
        limits_there = false;
        bus.config.axes[0].max_position_lag = 1.0;
        step = block(1, 0.0);
        step.detection_ns = 5000 * MS_IN_NS;
        begin_at(55000);
        start(1.5, 0.0);
        for (int i = 0; i < 2000 && bus.target_position < STOP + far; i++)
            bench_cycles(1);
        TEST_ASSERT_GREATER_OR_EQUAL_INT32(STOP + far, bus.target_position);
        bench_cycles(100);
        bench_forget_steps();
        bench_power(false);
        bench_cycles(gap);
        bench_power(true);
        for (int i = 0; i < 50; i++) {
            received = i % (lost + 1) > 0 ? CM1E_ERROR_BUS_LOST : CM1E_OK;
            bench_cycles(1);
        }
        received = CM1E_OK;
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
        expect_standing();
        TEST_ASSERT_LESS_OR_EQUAL_INT64((int64_t)(cm1e_unit_peak_velocity(axis->config) * 1e-3), worst_step);
        bench_end();
    }
}

/* Whatever ends a step that presses is not done while the motor presses on, also where answers are missing. */
static void test_what_ends_a_step_that_presses_relieves_the_motor(void)
{
    enum { BY_STOP, BY_FINISH, BY_DIRECT, BY_SECOND_FINISH, ENDS };
    for (int n = 0; n < ENDS * 3; n++) {
        const int end = n % ENDS, lost = n / ENDS;
        limits_there = false;
        step = block(1, 60.0);
        step.detection_ns = 5000 * MS_IN_NS;
        begin_at(59000);
        const cm1e_command_id_t pressing = start(0.2, 0.0);
        for (int i = 0; i < 2000 && bus.torque < 300; i++)
            bench_cycles(1);
        TEST_ASSERT_GREATER_OR_EQUAL_INT(300, bus.torque);
        step = (cm1e_homing_step_t){.kind = end == BY_DIRECT ? CM1E_STEP_DIRECT : CM1E_STEP_FINISH};
        if (end == BY_SECOND_FINISH)
            start(0.2, 0.0);
        const cm1e_axis_command_t stop = {.kind = CM1E_COMMAND_STOP};
        const cm1e_command_id_t id = end == BY_STOP ? bench_start_command(&stop) : start(0.2, 0.0);
        expect(pressing, CM1E_COMMAND_ABORTED, CM1E_OK);
        for (int i = 1; i < 1000 && bench_state_of(id) == CM1E_COMMAND_ACTIVE; i++) {
            received = i % (lost + 1) > 0 ? CM1E_ERROR_BUS_LOST : CM1E_OK;
            bench_cycles(1);
        }
        received = CM1E_OK;
        expect(id, CM1E_COMMAND_DONE, CM1E_OK);
        expect_standing();
        TEST_ASSERT_EQUAL_INT(end == BY_STOP ? CM1E_AXIS_STOPPING : CM1E_AXIS_STANDSTILL, bench_info().state);
        bench_end();
    }
}

/* The motor stands and loses its torque, and the axis has no position of its home. */
static void expect_no_torque(cm1e_axis_state_t state, int32_t from)
{
    for (int i = 0; i < 500 && bus.state == OPERATION_ENABLED; i++)
        bench_cycles(1);
    TEST_ASSERT_NOT_EQUAL_INT(OPERATION_ENABLED, bus.state);
    settle(0, state, from);
    TEST_ASSERT_FALSE(bench_info().homed);
}

/* What a stop had to relieve is forgotten without torque: a later MC_Stop is one as any other. */
static void test_power_off_while_a_stop_relieves_leaves_nothing_behind(void)
{
    limits_there = false;
    step = block(1, 30.0);
    step.detection_ns = 5000 * MS_IN_NS;
    begin_at(59000);
    start(0.2, 0.0);
    for (int i = 0; i < 2000 && bus.torque < 300; i++)
        bench_cycles(1);
    TEST_ASSERT_GREATER_OR_EQUAL_INT(300, bus.torque);
    const cm1e_axis_command_t stop = {.kind = CM1E_COMMAND_STOP};
    cm1e_axis_hold_stop(axis, bench_start_command(&stop), false);
    for (int i = 0; i < 200 && !axis->homing_step.after_stop; i++)
        bench_cycles(1);
    TEST_ASSERT_TRUE(axis->homing_step.after_stop);
    bench_power(false);
    bench_cycles(200);
    stops_there = false;
    bench_enable();
    const cm1e_command_id_t move = bench_move_velocity(-1.0);
    bench_cycles(500);
    expect(move, CM1E_COMMAND_ACTIVE, CM1E_OK);
    const cm1e_axis_command_t gentle = {.kind = CM1E_COMMAND_STOP, .deceleration = 1.0};
    const cm1e_command_id_t later = bench_start_command(&gentle);
    cm1e_axis_hold_stop(axis, later, false);
    bench_cycles(500); /* of the second that it takes */
    TEST_ASSERT_DOUBLE_WITHIN(0.05, -0.5, bench_info().set_velocity);
    bench_cycles(700);
    expect(later, CM1E_COMMAND_DONE, CM1E_OK);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
}

static void test_power_off_at_every_cycle(void)
{
    for (int n = 0; sequence_until(n); n += stride()) {
        const int32_t from = bus.position;
        bench_power(false);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISABLED, bench_info().state);
        expect(sequence_id, CM1E_COMMAND_ABORTED, CM1E_OK);
        expect_no_torque(CM1E_AXIS_DISABLED, from);
    }
}

/* A step that goes, or is to go, where it may not any more gives up; any other goes on. */
static void test_direction_disabled_at_every_cycle(void)
{
    for (int positive = 0; positive <= 1; positive++)
        for (int n = 0; sequence_until(n); n += stride()) {
            const int32_t from = bus.position;
            TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_power(axis, &owner, true, positive, !positive));
            const int allowed = positive ? 1 : -1;
            bench_wait(sequence_id, 5000);
            const cm1e_command_status_t status = cm1e_axis_command_status(axis, sequence_id);
            if (status.state == CM1E_COMMAND_ERROR)
                TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DIRECTION_DISABLED, status.error);
            else
                TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, status.state);
            /* Against the enabled direction it went no farther than its braking, or than pressing needs to relax. */
            TEST_ASSERT_LESS_OR_EQUAL_INT(braking_counts, (from - bus.position) * allowed);
            expect_standing();
        }
}

static void test_bus_lost_at_every_cycle(void)
{
    for (int n = 0; sequence_until(n); n += stride()) {
        const int32_t from = bus.position;
        const bool was_active = bench_state_of(sequence_id) == CM1E_COMMAND_ACTIVE;
        received = health = CM1E_ERROR_BUS_LOST;
        bench_cycles(1);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
        if (was_active)
            expect(sequence_id, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_ERROR_STOP);
        expect_no_torque(CM1E_AXIS_ERROR_STOP, from);
    }
}

static void test_drive_fault_at_every_cycle(void)
{
    for (int n = 0; sequence_until(n); n += stride()) {
        fake_bus_fault(&bus, 0x2310);
        const int32_t from = bus.position;
        bench_cycles(3);
        settle(0, CM1E_AXIS_ERROR_STOP, from);
        TEST_ASSERT_FALSE(bench_info().homed);
        TEST_ASSERT_TRUE(axis_free(axis));
    }
}

/* Cycles without inputs while the axes still run (fewer than the limit of lost cycles): nothing is found in them, and
 * what lies between two looks is halved all the same. */
static void test_missing_inputs_widen_the_error_and_nothing_else(void)
{
    for (int gap = 1; gap <= 2; gap++) {
        begin_at(-20000);
        step = (cm1e_homing_step_t){.mode = mcRisingEdge};
        const cm1e_command_id_t id = start(1.0, 0.0);
        for (int i = 0; i < 15000 && bench_state_of(id) == CM1E_COMMAND_ACTIVE; i++) { /* time stands meanwhile */
            received = i % 3 < gap ? CM1E_ERROR_BUS_LOST : CM1E_OK;
            bench_cycles(1);
        }
        received = CM1E_OK;
        bench_cycles(2);
        expect(id, CM1E_COMMAND_DONE, CM1E_OK);
        expect_called(LEFT_FLANK, 0.0, 1.0 * (gap + 1));
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_mc_stop_at_every_cycle);
    RUN_TEST(test_power_back_within_the_ramp_relieves_the_motor);
    RUN_TEST(test_power_back_within_the_ramp_goes_back_to_the_motor_without_a_jump);
    RUN_TEST(test_what_ends_a_step_that_presses_relieves_the_motor);
    RUN_TEST(test_power_off_while_a_stop_relieves_leaves_nothing_behind);
    RUN_TEST(test_power_off_at_every_cycle);
    RUN_TEST(test_direction_disabled_at_every_cycle);
    RUN_TEST(test_bus_lost_at_every_cycle);
    RUN_TEST(test_drive_fault_at_every_cycle);
    RUN_TEST(test_missing_inputs_widen_the_error_and_nothing_else);
    return UNITY_END();
}
