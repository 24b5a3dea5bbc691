/* MC_Home: parameters over SDO, the bits of UG 6.2.4, the way back without a jump, and everything that goes wrong. */
#include <limits.h>
#include <math.h>

#include "../support/axis_bench.h"
#include "homing/homing_private.h"

static const int8_t methods[] = {-1, -2, -3, -4, -5, -6};

/* ---- a device that homes: the shaft runs, finds its reference, goes to the offset, and calls that 0 -------------- */

static int run_cycles, start_latency;
static int32_t reference; /* counts from where it began */
static bool homing_started, stuck;
static int homing_cycle;
static unsigned start_edges;
static bool start_before;
static int64_t shaft; /* true position of the shaft: the counts of the device are renamed by homing */

static void turn(int32_t counts)
{
    shaft += counts;
    bus.position = (int32_t)((uint32_t)bus.position + (uint32_t)counts);
}

static void show(int bit13, int bit12, int bit10)
{
    bus.mode_status = (uint16_t)((bit13 ? STATUSWORD_HOMING_ERROR : 0) | (bit12 ? STATUSWORD_HOMING_ATTAINED : 0) |
                                 (bit10 ? STATUSWORD_TARGET_REACHED : 0));
}

static void device_homing(cm1e_bus_t *b)
{
    const bool start = b->controlword & CONTROLWORD_HOMING_START;
    if (b->state != OPERATION_ENABLED) {
        homing_started = start_before = false;
        return;
    }
    if (start && !start_before) {
        start_edges++;
        homing_started = true;
        homing_cycle = 0;
    }
    start_before = start;
    if (homing_started && (b->controlword & CONTROLWORD_HALT)) {
        homing_started = false;
        show(0, 0, 1);
    }
    if (!start)
        homing_started = false;
    if (!homing_started)
        return;
    const int n = homing_cycle++ - start_latency;
    if (n < 0)
        return;
    if (n == 0)
        show(0, 0, 0);
    if (stuck)
        return;
    if (n < run_cycles)
        turn(reference / run_cycles);
    else if (n < run_cycles + 20)
        show(0, 1, 0);
    else if (n == run_cycles + 20) {
        b->position = 3; /* it stands a few counts beside its 0 */
        show(0, 1, 1);
    }
}

static void start_bench(void)
{
    bench_start();
    bus.homing = device_homing;
    run_cycles = 300;
    start_latency = 3;
    reference = -90000;
    homing_started = stuck = start_before = false;
    start_edges = 0;
    show(0, 0, 1);
    shaft = 0;
    bench_enable();
    bus.sdo_count = 0;
}

void setUp(void) { start_bench(); }
void tearDown(void) { bench_end(); }

static cm1e_command_id_t home(double position, const cm1e_homing_config_t *config)
{
    return bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOME, .position = position,
                                                      .homing = config});
}

static void cycles_until_step(cm1e_home_step_t step)
{
    for (int i = 0; i < 3000; i++) {
        if (drive_homes(axis) && axis->homing->drive.step == step)
            return;
        bench_cycles(1);
    }
    TEST_FAIL_MESSAGE("the step of homing was not reached");
}

/* ---- the good case ----------------------------------------------------------------------------------------------- */

static void test_every_method_homes_and_sets_the_position(void)
{
    static const double positions[] = {0.0, 12.5, -7.25};
    for (size_t m = 0; m < sizeof methods; m++)
        for (size_t p = 0; p < 3; p++)
            for (int invert = 0; invert < 2; invert++) {
                start_bench();
                bus.config.axes[0].invert = invert;
                bench_create();
                bench_enable();
                bus.sdo_count = 0;
                const cm1e_homing_config_t config = {.method = methods[m], .offset = 0.5, .velocity = 1.0,
                                                     .acceleration = 10.0, .torque = 42.0};
                bench_forget_steps();
                const cm1e_command_id_t id = home(positions[p], &config);
                TEST_ASSERT_EQUAL_INT(CM1E_AXIS_HOMING, bench_info().state);
                bench_wait(id, 5000);
                TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
                const cm1e_axis_info_t info = bench_info();
                TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, info.state);
                TEST_ASSERT_TRUE(info.homed && info.powered);
                TEST_ASSERT_EQUAL_INT8(CM1E_MODE_CSP, info.mode);
                /* the device stands 3 counts beside its 0, and 0 is the reference */
                TEST_ASSERT_DOUBLE_WITHIN(1e-9, positions[p] + (invert ? -3 : 3) / 50000.0, info.actual_position);
                TEST_ASSERT_EQUAL_DOUBLE(info.actual_position, info.set_position);
                TEST_ASSERT_EQUAL_INT64(0, bus.torque_step); /* nothing jumped in CSP, before or after */
                static const uint16_t order[] = {0x607C, 0x6098, 0x6099, 0x609A, 0x60F6};
                const int64_t values[] = {invert ? -25000 : 25000, methods[m], 50000, 500000, 42};
                TEST_ASSERT_EQUAL_UINT(5, bus.sdo_count);
                for (int i = 0; i < 5; i++) {
                    TEST_ASSERT_EQUAL_HEX16(order[i], bus.sdo_log[i].index);
                    TEST_ASSERT_EQUAL_INT64(values[i], bus.sdo_log[i].value);
                    TEST_ASSERT_TRUE(bus.sdo_log[i].write);
                }
                TEST_ASSERT_EQUAL_HEX8(0x1B, bus.sdo_log[4].subindex);
                TEST_ASSERT_EQUAL_UINT(1, start_edges);
                const cm1e_command_id_t move = bench_move_to(positions[p], 1.0);
                bench_wait(move, 2000);
                TEST_ASSERT_EQUAL_INT32(0, bus.position);
            }
}

static void test_default_parameters_and_rounding(void)
{
    bus.config.axes[0].homing.method = -4;
    bench_create();
    bench_enable();
    bus.sdo_count = 0;
    bench_wait(home(0.0, NULL), 5000);
    static const int64_t values[] = {0, -4, 50000, 100000, 30};
    for (int i = 0; i < 5; i++)
        TEST_ASSERT_EQUAL_INT64(values[i], bus.sdo_log[i].value);
    bus.sdo_count = 0;
    const cm1e_homing_config_t odd = {.method = -1, .offset = -0.001, .velocity = 0.05123, .acceleration = 1.2345,
                                      .torque = 29.6};
    bench_wait(home(0.0, &odd), 5000); /* -50, 2561.5, 61725 counts */
    static const int64_t rounded[] = {-100, -1, 2600, 62000, 30};
    for (int i = 0; i < 5; i++)
        TEST_ASSERT_EQUAL_INT64(rounded[i], bus.sdo_log[i].value);
}

static void test_homing_again_is_not_fooled_by_the_bits_of_the_last_one(void)
{
    for (int round = 0; round < 3; round++) {
        start_latency = 100; /* so long the old "completed" stays */
        const int64_t before = shaft;
        const cm1e_command_id_t id = home(1.0, &(cm1e_homing_config_t){.method = -2});
        bench_wait(id, 5000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
        TEST_ASSERT_EQUAL_INT64(reference, shaft - before);
    }
    TEST_ASSERT_EQUAL_UINT(3, start_edges);
}

static void test_full_queue_only_delays(void)
{
    bus.sdo_full = true;
    const cm1e_command_id_t id = home(0.0, &(cm1e_homing_config_t){.method = -1});
    bench_cycles(50);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(id));
    bus.sdo_full = false;
    bench_wait(id, 5000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
}

static void test_parameters_that_find_no_way_to_the_device_time_out(void)
{
    for (int stuck_transfer = 0; stuck_transfer < 2; stuck_transfer++) {
        start_bench();
        bus.sdo_full = !stuck_transfer;
        bus.sdo_delay = 100000;
        const cm1e_command_id_t id = home(0.0, &(cm1e_homing_config_t){.method = -1, .timeout_s = 0.2});
        const int n = bench_wait(id, 1000);
        TEST_ASSERT_INT_WITHIN(10, 200, n);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_TIMEOUT, cm1e_axis_command_status(axis, id).error);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
        bench_told("0x607C");
        bench_told("the time of the homing was over (homing.timeout_s, 0.2 s)");
        cm1e_command_id_t again; /* the buffer of a transfer under way is not touched */
        const cm1e_homing_config_t config = {.method = -1};
        TEST_ASSERT_EQUAL_INT(stuck_transfer ? CM1E_ERROR_BUSY : CM1E_OK,
                              cm1e_axis_start(axis, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOME,
                                                                           .homing = &config}, &again));
    }
}

static void test_position_counter_renamed_by_homing_near_the_wrap(void)
{
    bench_start();
    bus.homing = device_homing;
    bus.position = INT32_MAX - 1000;
    bench_create();
    bench_enable();
    reference = 60000;
    const cm1e_command_id_t id = home(5.0, &(cm1e_homing_config_t){.method = -3});
    bench_wait(id, 5000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 5.0 + 3 / 50000.0, bench_info().actual_position);
    TEST_ASSERT_EQUAL_INT64(0, bus.torque_step);
}

static void test_homing_in_the_fixed_csp_mapping_switches_over_sdo(void)
{
    fake_bus_init(&bus, CM1E_MAPPING_CSP, CM1E_PDO_ORDER_UG_7_2, CM1E_FIRMWARE_1_2_0);
    bus.homing = device_homing;
    bus.sdo_delay = 4;
    bench_create();
    bench_enable();
    const cm1e_command_id_t id = home(2.0, &(cm1e_homing_config_t){.method = -5});
    bench_wait(id, 5000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
    TEST_ASSERT_EQUAL_INT8(CM1E_MODE_CSP, bus.mode);
    TEST_ASSERT_EQUAL_INT64(0, bus.torque_step);
}

/* ---- refused before anything happens ----------------------------------------------------------------------------- */

static void test_parameters_outside_the_device_are_refused_before_the_wire(void)
{
    static const struct {
        cm1e_homing_config_t config;
        cm1e_error_t error;
        const char *words;
    } rows[] = {
        {{.method = 0}, CM1E_ERROR_AXIS_HOMING_METHOD,
         "homing.method is 0; -6 ... -1 is right"},
        {{.method = 1}, CM1E_ERROR_AXIS_HOMING_METHOD,
         "homing.method is 1;"},
        {{.method = -7}, CM1E_ERROR_AXIS_HOMING_METHOD,
         "homing.method is -7;"},
        {{.method = 35}, CM1E_ERROR_AXIS_HOMING_METHOD,
         "homing.method is 35;"},
        {{.method = -1, .offset = 3276800 / 50000.0}, CM1E_ERROR_AXIS_HOMING_PARAMETER,
         "homing.offset is 65.536 u; -65.534 ... 65.534 u is right"},
        {{.method = -1, .offset = -3276800 / 50000.0}, CM1E_ERROR_AXIS_HOMING_PARAMETER,
         "homing.offset is -65.536 u;"},
        {{.method = -1, .offset = NAN}, CM1E_ERROR_AXIS_HOMING_PARAMETER,
         "homing.offset is nan"},
        {{.method = -1, .velocity = 900 / 50000.0}, CM1E_ERROR_AXIS_HOMING_PARAMETER,
         "homing.velocity is 0.018 u/s; 0.02 ... 10 u/s is right, or 0"},
        {{.method = -1, .velocity = 500100 / 50000.0}, CM1E_ERROR_AXIS_HOMING_PARAMETER,
         "homing.velocity is 10.002 u/s;"},
        {{.method = -1, .velocity = -1.0}, CM1E_ERROR_AXIS_HOMING_PARAMETER,
         "homing.velocity is -1 u/s;"},
        {{.method = -1, .velocity = INFINITY}, CM1E_ERROR_AXIS_HOMING_PARAMETER,
         "homing.velocity is inf"},
        {{.method = -1, .acceleration = 400 / 50000.0}, CM1E_ERROR_AXIS_HOMING_PARAMETER,
         "homing.acceleration is 0.008 u/s2; 0.02 ... 100 u/s2"},
        {{.method = -1, .acceleration = 5001000 / 50000.0}, CM1E_ERROR_AXIS_HOMING_PARAMETER,
         "homing.acceleration is 100.02 u/s2;"},
        {{.method = -1, .torque = 9.0}, CM1E_ERROR_AXIS_HOMING_PARAMETER,
         "homing.torque is 9 %; 10 ... 100 % is right"},
        {{.method = -1, .torque = 101.0}, CM1E_ERROR_AXIS_HOMING_PARAMETER,
         "homing.torque is 101 %;"},
        {{.method = -1, .torque = NAN}, CM1E_ERROR_AXIS_HOMING_PARAMETER,
         "homing.torque is nan"},
        {{.method = -1, .timeout_s = -1.0}, CM1E_ERROR_AXIS_HOMING_PARAMETER,
         "homing.timeout_s is -1 s; 0 ... 1e+06 s"},
        {{.method = -1, .timeout_s = NAN}, CM1E_ERROR_AXIS_HOMING_PARAMETER,
         "homing.timeout_s is nan"},
        {{.method = -1, .timeout_s = 1e300}, CM1E_ERROR_AXIS_HOMING_PARAMETER,
         "homing.timeout_s is 1e+300 s;"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        cm1e_command_id_t id;
        const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_HOME, .homing = &rows[i].config};
        TEST_ASSERT_EQUAL_INT(rows[i].error, cm1e_axis_start(axis, &command, &id));
        bench_told(rows[i].words);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    }
    cm1e_command_id_t id;
    const cm1e_homing_config_t good = {.method = -1};
    const cm1e_axis_command_t nowhere = {.kind = CM1E_COMMAND_HOME, .homing = &good, .position = INFINITY};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, cm1e_axis_start(axis, &nowhere, &id));
    bench_cycles(10);
    TEST_ASSERT_EQUAL_UINT(0, bus.sdo_count);
}

static void test_limits_of_the_device_are_accepted(void)
{
    static const cm1e_homing_config_t rows[] = {
        {.method = -1, .offset = 3276700 / 50000.0, .velocity = 0.02, .acceleration = 0.02, .torque = 10.0},
        {.method = -6, .offset = -3276700 / 50000.0, .velocity = 10.0, .acceleration = 100.0, .torque = 100.0},
    };
    for (int i = 0; i < 2; i++)
        bench_wait(home(0.0, &rows[i]), 5000);
    TEST_ASSERT_EQUAL_UINT(10, bus.sdo_count);
}

static void test_homing_needs_both_directions(void)
{
    const cm1e_homing_config_t config = {.method = -1};
    const cm1e_axis_command_t command = {.kind = CM1E_COMMAND_HOME, .homing = &config};
    cm1e_command_id_t id;
    for (int i = 0; i < 3; i++) {
        cm1e_axis_power(axis, &owner, true, i & 1, i & 2);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DIRECTION_DISABLED, cm1e_axis_start(axis, &command, &id));
    }
}

static void test_sdo_abort_of_each_parameter_refuses_without_moving(void)
{
    static const uint16_t objects[] = {0x607C, 0x6098, 0x6099, 0x609A, 0x60F6};
    for (int i = 0; i < 5; i++) {
        start_bench();
        bus.sdo_abort_index = objects[i];
        const cm1e_command_id_t id = home(0.0, &(cm1e_homing_config_t){.method = -1});
        bench_wait(id, 100);
        const cm1e_command_status_t status = cm1e_axis_command_status(axis, id);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, status.state);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_SDO_ABORT, status.error);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, bench_info().error);
        char object[8];
        snprintf(object, sizeof object, "0x%04X", objects[i]);
        bench_told(object);
        bench_told("0x06090030");
        TEST_ASSERT_EQUAL_INT64(0, shaft);
    }
}

/* ---- going wrong on the way -------------------------------------------------------------------------------------- */

static void assert_homing_error(cm1e_command_id_t id, cm1e_error_t error)
{
    const cm1e_command_status_t status = cm1e_axis_command_status(axis, id);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, status.state);
    TEST_ASSERT_EQUAL_INT(error, status.error);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    TEST_ASSERT_EQUAL_INT(error, bench_info().error);
    TEST_ASSERT_FALSE(bench_info().homed);
    bench_cycles(200); /* halted by the drive, then without torque */
    TEST_ASSERT_NOT_EQUAL_INT(OPERATION_ENABLED, bus.state);
    TEST_ASSERT_EQUAL_INT64(0, bus.torque_step);
    TEST_ASSERT_EQUAL_UINT(1, start_edges);
    cm1e_axis_reset(axis);
    bench_cycles(100);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_EQUAL_INT8(CM1E_MODE_CSP, bus.mode);
}

static void test_homing_that_never_begins(void)
{
    for (int completed = 0; completed < 2; completed++) {
        start_bench();
        start_latency = 1000000;
        show(0, completed, 1);
        const cm1e_command_id_t id = home(0.0, &(cm1e_homing_config_t){.method = -1});
        bench_wait(id, 1000);
        bench_told("homing began");
        assert_homing_error(id, CM1E_ERROR_AXIS_HOMING_FAILED);
    }
}

static void test_homing_without_end_times_out(void)
{
    stuck = true;
    const cm1e_command_id_t id = home(0.0, &(cm1e_homing_config_t){.method = -3, .timeout_s = 1.5});
    const int n = bench_wait(id, 5000);
    TEST_ASSERT_INT_WITHIN(50, 1500, n);
    bench_told("sensor");
    assert_homing_error(id, CM1E_ERROR_AXIS_HOMING_TIMEOUT);
}

static void test_every_pattern_of_the_bits_while_running(void)
{
    for (int pattern = 0; pattern < 8; pattern++) {
        start_bench();
        stuck = true;
        const cm1e_command_id_t id = home(0.0, &(cm1e_homing_config_t){.method = -1});
        cycles_until_step(HOME_RUN);
        show(pattern & 4, pattern & 2, pattern & 1);
        bench_cycles(20);
        switch (pattern) {
        case 0: /* in progress */
        case 2: /* attained */
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(id));
            bench_cycles(1000);
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(id));
            break;
        case 1: /* interrupted: not by a moment of it */
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(id));
            bench_cycles(200);
            assert_homing_error(id, CM1E_ERROR_AXIS_HOMING_FAILED);
            break;
        case 3:
            bench_cycles(60); /* the motor has to stand */
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
            break;
        default:
            bench_told("drive reports");
            assert_homing_error(id, CM1E_ERROR_AXIS_HOMING_FAILED);
            break;
        }
    }
}

static int turns_for; /* cycles */

/* It says that the homing is completed, and turns on. */
static void device_lies(cm1e_bus_t *b)
{
    if (b->mode != CM1E_MODE_HM || !(b->controlword & CONTROLWORD_HOMING_START || homing_started))
        return;
    start_edges += !homing_started;
    homing_started = true;
    show(0, 1, 1);
    if (turns_for-- > 0)
        turn(100);
}

/** A drive that says too early that it has homed: the mode is switched when its motor is at rest, whatever comes meanwhile.
 *  A target that is held during the switch would else be far behind the motor. */
static void test_homing_that_ends_while_the_motor_turns_keeps_its_mode_until_that_rests(void)
{
    for (int ended = 0; ended < 4; ended++)
        for (int n = 1; n < 40; n += 3) {
            start_bench();
            bus.homing = device_lies;
            turns_for = 200;
            const cm1e_command_id_t id = home(0.0, &(cm1e_homing_config_t){.method = -1});
            cycles_until_step(HOME_RUN);
            bench_cycles(n);
            if (ended == 1)
                bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP});
            else if (ended == 2)
                bench_power(false);
            else if (ended == 3)
                cm1e_axis_fail(axis, CM1E_ERROR_PROGRAM, 0.0, 0.0);
            while (turns_for > 0 && bus.state == OPERATION_ENABLED) {
                bench_cycles(1);
                TEST_ASSERT_EQUAL_INT8(CM1E_MODE_HM, bus.mode);
            }
            TEST_ASSERT_TRUE(turns_for <= 0);
            bench_cycles(300);
            TEST_ASSERT_EQUAL_INT8(CM1E_MODE_CSP, bus.mode);
            if (ended == 0)
                TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
        }
}

/** It never rests: the homing has failed. */
static void test_homing_that_ends_while_the_motor_turns_for_ever_has_failed(void)
{
    start_bench();
    bus.homing = device_lies;
    turns_for = INT_MAX;
    const cm1e_command_id_t id = home(0.0, &(cm1e_homing_config_t){.method = -1});
    cycles_until_step(HOME_RUN);
    bench_cycles(1100);
    bench_told("although its motor still turned");
    turns_for = 0;
    bench_cycles(200);
    assert_homing_error(id, CM1E_ERROR_AXIS_HOMING_FAILED);
}

/* It says that the homing is completed, and takes that back. */
static void device_fails_late(cm1e_bus_t *b)
{
    device_lies(b);
    if (b->mode == CM1E_MODE_HM && homing_started && turns_for <= 80)
        show(1, 0, 0);
}

/** An error of the drive counts until its motor is at rest. */
static void test_homing_that_fails_behind_its_end_has_failed(void)
{
    start_bench();
    bus.homing = device_fails_late;
    turns_for = 100;
    const cm1e_command_id_t id = home(0.0, &(cm1e_homing_config_t){.method = -1});
    cycles_until_step(HOME_RUN);
    bench_cycles(400);
    assert_homing_error(id, CM1E_ERROR_AXIS_HOMING_FAILED);
    TEST_ASSERT_FALSE(bench_info().homed);
}

static void test_stop_at_every_cycle_of_homing(void)
{
    for (int n = 0; n < 400; n += n < 30 ? 1 : 7) {
        start_bench();
        const cm1e_command_id_t id = home(0.0, &(cm1e_homing_config_t){.method = -1});
        bench_cycles(n);
        if (bench_state_of(id) == CM1E_COMMAND_DONE)
            break;
        const cm1e_command_id_t stop = bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP});
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, bench_state_of(id));
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STOPPING, bench_info().state);
        const int64_t at_stop = shaft;
        bench_wait(stop, 3000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(stop));
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STOPPING, bench_info().state);
        TEST_ASSERT_INT64_WITHIN(700, at_stop, shaft); /* the cycle until the halt arrives */
        TEST_ASSERT_EQUAL_INT64(0, bus.torque_step);
        TEST_ASSERT_LESS_OR_EQUAL_UINT(1, start_edges);
        TEST_ASSERT_EQUAL_INT8(CM1E_MODE_CSP, bus.mode);
        cm1e_axis_hold_stop(axis, stop, false);
        bench_cycles(2);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
        bench_wait(bench_move_to(bench_info().set_position + 0.1, 1.0), 2000);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, bench_info().error);
    }
}

static void test_power_off_at_every_cycle_of_homing(void)
{
    for (int n = 0; n < 400; n += n < 30 ? 1 : 7) {
        start_bench();
        const cm1e_command_id_t id = home(0.0, &(cm1e_homing_config_t){.method = -2});
        bench_cycles(n);
        const bool done = bench_state_of(id) == CM1E_COMMAND_DONE;
        bench_power(false);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISABLED, bench_info().state);
        const int64_t at_stop = shaft;
        bench_cycles(200);
        TEST_ASSERT_NOT_EQUAL_INT(OPERATION_ENABLED, bus.state);
        TEST_ASSERT_INT64_WITHIN(700, at_stop, shaft);
        TEST_ASSERT_EQUAL_INT(done ? CM1E_COMMAND_DONE : CM1E_COMMAND_ABORTED, bench_state_of(id));
        bench_power(true);
        bench_cycles(100);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
        TEST_ASSERT_EQUAL_INT8(CM1E_MODE_CSP, bus.mode);
        TEST_ASSERT_EQUAL_INT64(0, bus.torque_step);
        TEST_ASSERT_INT64_WITHIN(700, at_stop, shaft);
    }
}

static void test_fault_at_every_cycle_of_homing(void)
{
    for (int n = 0; n < 400; n += n < 30 ? 1 : 7) {
        start_bench();
        const cm1e_command_id_t id = home(0.0, &(cm1e_homing_config_t){.method = -2});
        bench_cycles(n);
        if (bench_state_of(id) == CM1E_COMMAND_DONE)
            break;
        fake_bus_fault(&bus, 0x2310);
        bench_cycles(3);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_FAULT, bench_info().error);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, bench_state_of(id));
        const int64_t at_fault = shaft;
        bench_power(true);
        cm1e_axis_reset(axis);
        bench_cycles(1000);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
        TEST_ASSERT_EQUAL_INT64(at_fault, shaft); /* and homing does not go on by itself */
        TEST_ASSERT_EQUAL_INT8(CM1E_MODE_CSP, bus.mode);
    }
}

static void test_direction_disabled_during_homing_stops_it(void)
{
    const cm1e_command_id_t id = home(0.0, &(cm1e_homing_config_t){.method = -2});
    bench_cycles(100);
    cm1e_axis_power(axis, &owner, true, true, false);
    const int64_t at_stop = shaft;
    bench_cycles(200);
    const cm1e_command_status_t status = cm1e_axis_command_status(axis, id);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DIRECTION_DISABLED, status.error);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_INT64_WITHIN(700, at_stop, shaft);
}

static void test_mode_that_does_not_come_ends_in_error_stop(void)
{
    for (int back = 0; back < 2; back++) {
        start_bench();
        const cm1e_command_id_t id = home(0.0, &(cm1e_homing_config_t){.method = -2});
        if (back)
            cycles_until_step(HOME_RUN);
        bus.mode_delay = bus.mode_wait = 1000000;
        bench_wait(id, 3000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, bench_state_of(id));
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_MODE_TIMEOUT, bench_info().error);
        bench_cycles(10);
        TEST_ASSERT_NOT_EQUAL_INT(OPERATION_ENABLED, bus.state);
    }
}

static void test_lost_frames_during_homing_do_not_disturb(void)
{
    for (int n = 0; n < 400; n += n < 40 ? 1 : 11) {
        start_bench();
        const cm1e_command_id_t id = home(4.0, &(cm1e_homing_config_t){.method = -2});
        bench_cycles(n);
        received = CM1E_ERROR_BUS_LOST;
        bench_cycles(2);
        received = CM1E_OK;
        bench_wait(id, 5000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
        TEST_ASSERT_EQUAL_INT64(0, bus.torque_step);
        TEST_ASSERT_DOUBLE_WITHIN(1e-9, 4.0 + 3 / 50000.0, bench_info().actual_position);
    }
}

static void test_bus_lost_during_homing_halts_and_disables_in_bounded_time(void)
{
    static const struct {
        cm1e_homing_config_t config;
        int longest;
    } rows[] = {
        {{.method = -2, .velocity = 2.0, .acceleration = 40.0}, 150},
        {{.method = -2, .velocity = 10.0, .acceleration = 10.0}, 1100},
        {{.method = -2, .velocity = 10.0, .acceleration = 0.02}, 10100},
    };
    for (int row = 0; row < 3; row++) {
        start_bench();
        run_cycles = 100000;
        reference = -100000 * 100;
        const cm1e_command_id_t id = home(0.0, &rows[row].config);
        bench_cycles(100);
        received = health = CM1E_ERROR_BUS_WORKING_COUNTER;
        bench_cycles(2);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, bench_state_of(id));
        TEST_ASSERT_TRUE(bus.controlword & CONTROLWORD_HALT); /* it may still listen */
        int n = 0;
        while (bus.state == OPERATION_ENABLED && n++ < 20000)
            bench_cycles(1);
        TEST_ASSERT_INT_WITHIN(rows[row].longest / 4, rows[row].longest * 3 / 4, n);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_method_homes_and_sets_the_position);
    RUN_TEST(test_default_parameters_and_rounding);
    RUN_TEST(test_homing_again_is_not_fooled_by_the_bits_of_the_last_one);
    RUN_TEST(test_full_queue_only_delays);
    RUN_TEST(test_parameters_that_find_no_way_to_the_device_time_out);
    RUN_TEST(test_position_counter_renamed_by_homing_near_the_wrap);
    RUN_TEST(test_homing_in_the_fixed_csp_mapping_switches_over_sdo);
    RUN_TEST(test_parameters_outside_the_device_are_refused_before_the_wire);
    RUN_TEST(test_limits_of_the_device_are_accepted);
    RUN_TEST(test_homing_needs_both_directions);
    RUN_TEST(test_sdo_abort_of_each_parameter_refuses_without_moving);
    RUN_TEST(test_homing_that_never_begins);
    RUN_TEST(test_homing_without_end_times_out);
    RUN_TEST(test_every_pattern_of_the_bits_while_running);
    RUN_TEST(test_homing_that_ends_while_the_motor_turns_keeps_its_mode_until_that_rests);
    RUN_TEST(test_homing_that_ends_while_the_motor_turns_for_ever_has_failed);
    RUN_TEST(test_homing_that_fails_behind_its_end_has_failed);
    RUN_TEST(test_stop_at_every_cycle_of_homing);
    RUN_TEST(test_power_off_at_every_cycle_of_homing);
    RUN_TEST(test_fault_at_every_cycle_of_homing);
    RUN_TEST(test_direction_disabled_during_homing_stops_it);
    RUN_TEST(test_mode_that_does_not_come_ends_in_error_stop);
    RUN_TEST(test_lost_frames_during_homing_do_not_disturb);
    RUN_TEST(test_bus_lost_during_homing_halts_and_disables_in_bounded_time);
    return UNITY_END();
}
