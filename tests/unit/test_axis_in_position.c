/* In position: window, time and timeout, and the Done that waits for the motor. */
#include <limits.h>
#include <math.h>
#include <stdio.h>

#include "../support/axis_bench.h"
#include "../support/axis_witness.h"
#include "axis/axis_driving.h"
#include "core/clock.h"

/* The shaft behind the motor: no faster than `pace` counts a cycle, not beyond `stop`, and `off` counts beside its
 * target. Units of 50,000 counts; the default window is 10 counts, the default time 20 cycles. */
static int32_t pace, stop, off;

static void shaft(cm1e_bus_t *b)
{
    if (b->state != OPERATION_ENABLED)
        return;
    const int32_t target = b->target_position + off, goal = target < stop ? target : stop;
    const int32_t way = goal - b->position;
    b->position += way > pace ? pace : way < -pace ? -pace : way;
}

static void begin(bool done_waits)
{
    bench_end();
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.config.axes[0].in_position_done_waits = done_waits;
    bus.blocked = true;
    bus.world = shaft;
    pace = stop = INT32_MAX;
    off = 0;
    bench_create();
    bench_enable();
    watch_begin();
}

void setUp(void) { begin(true); }
void tearDown(void) { bench_end(); }

static cm1e_command_id_t post(cm1e_command_kind_t kind, double position, MC_BUFFER_MODE mode)
{
    return bench_start_command(&(cm1e_axis_command_t){.kind = kind, .position = position, .velocity = 5.0,
                                                      .buffer_mode = mode});
}

/* Cycles until the set-point stands at its end; the command is left there. */
static void until_set_point(double position)
{
    for (int i = 0; i < 5000 && (bench_info().set_position != position || bench_info().set_velocity != 0.0); i++)
        bench_cycles(1);
    TEST_ASSERT_EQUAL_DOUBLE(position, bench_info().set_position);
}

/* ---- what the axis shows ----------------------------------------------------------------------------------------- */

static void test_it_is_shown_where_done_does_not_wait(void)
{
    begin(false);
    TEST_ASSERT_FALSE(bench_info().in_position); /* enabled a moment ago */
    bench_cycles(25);
    TEST_ASSERT_TRUE(bench_info().in_position);
    const cm1e_command_id_t id = post(CM1E_COMMAND_MOVE_ABSOLUTE, 1.0, mcAborting);
    TEST_ASSERT_FALSE(bench_info().in_position); /* from the call on */
    off = -11;
    int until_done = 0;
    for (; bench_state_of(id) == CM1E_COMMAND_ACTIVE; until_done++) {
        bench_cycles(1);
        TEST_ASSERT_FALSE(bench_info().in_position);
    }
    TEST_ASSERT_INT_WITHIN(60, 320, until_done); /* as ever: with the set-point */
    bench_cycles(3000);
    TEST_ASSERT_FALSE(bench_info().in_position); /* nor is that an error */
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    off = -10;
    bench_cycles(20);
    TEST_ASSERT_FALSE(bench_info().in_position);
    bench_cycles(2);
    TEST_ASSERT_TRUE(bench_info().in_position);
    bench_power(false);
    bench_cycles(5);
    TEST_ASSERT_FALSE(bench_info().in_position);
}

static void test_window_and_time_are_settable(void)
{
    begin(false);
    bus.config.axes[0].in_position_window = 0.01; /* 500 counts */
    bus.config.axes[0].in_position_time_s = 0.1;
    bench_create();
    bench_enable();
    const cm1e_command_id_t id = post(CM1E_COMMAND_MOVE_ABSOLUTE, -1.0, mcAborting);
    off = 500;
    while (bench_state_of(id) == CM1E_COMMAND_ACTIVE)
        bench_cycles(1);
    bench_cycles(99);
    TEST_ASSERT_FALSE(bench_info().in_position);
    bench_cycles(3);
    TEST_ASSERT_TRUE(bench_info().in_position);
    off = 501;
    bench_cycles(2);
    TEST_ASSERT_FALSE(bench_info().in_position);
}

/* The default is what the axis can keep: by its resolution, and coarse where it corrects in counts/ms. */
static void test_the_default_window(void)
{
    TEST_ASSERT_EQUAL_DOUBLE(10.0 / 50000.0, axis->in_position.window);
    for (int old = 0; old < 2; old++) {
        fake_bus_init(&bus, CM1E_MAPPING_CSV, CM1E_PDO_ORDER_UG_4_4, old ? CM1E_FIRMWARE_1_2_0 : CM1E_FIRMWARE_1_3_5);
        bus.config.axes[0].counts_per_unit = 1000.0;
        bench_create();
        TEST_ASSERT_EQUAL_DOUBLE(old ? 0.03 : 0.01, axis->in_position.window);
    }
}

/* ---- Done -------------------------------------------------------------------------------------------------------- */

static const cm1e_command_kind_t moves[] = {CM1E_COMMAND_MOVE_ABSOLUTE, CM1E_COMMAND_MOVE_RELATIVE,
                                            CM1E_COMMAND_MOVE_ADDITIVE};

static void test_done_comes_when_the_motor_was_there_for_the_time(void)
{
    for (size_t k = 0; k < sizeof moves / sizeof moves[0]; k++) {
        setUp();
        pace = 100; /* slower than the set-point: 250 counts a cycle */
        const cm1e_command_id_t id = post(moves[k], 0.4, mcAborting);
        until_set_point(0.4);
        TEST_ASSERT_LESS_THAN_INT32(19000, bus.position);
        int inside = 0, cycles = 0;
        for (; bench_state_of(id) == CM1E_COMMAND_ACTIVE; cycles++) {
            TEST_ASSERT_LESS_THAN_INT(500, cycles);
            TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISCRETE_MOTION, bench_info().state);
            TEST_ASSERT_EQUAL_DOUBLE(0.4, bench_info().set_position);
            TEST_ASSERT_TRUE(bench_info().powered);
            bench_cycles(1);
            inside = bus.position >= 20000 - 10 ? inside + 1 : 0;
        }
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
        TEST_ASSERT_INT_WITHIN(1, 21, inside);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
        TEST_ASSERT_TRUE(bench_info().in_position);
    }
}

static void test_leaving_the_window_begins_the_time_anew(void)
{
    const cm1e_command_id_t id = post(CM1E_COMMAND_MOVE_ABSOLUTE, 1.0, mcAborting);
    until_set_point(1.0);
    for (int round = 0; round < 10; round++) {
        off = 0;
        bench_cycles(19);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(id));
        off = round % 2 ? 11 : -11;
        bench_cycles(1);
    }
    off = 10;
    bench_cycles(22);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
}

/* What was not seen was not there. */
static void test_lost_frames_do_not_make_it_done(void)
{
    off = -400;
    const cm1e_command_id_t id = post(CM1E_COMMAND_MOVE_ABSOLUTE, 1.0, mcAborting);
    until_set_point(1.0);
    bench_cycles(10);
    off = 0;
    bench_cycles(1);
    received = CM1E_ERROR_BUS_LOST;
    bench_cycles(40);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(id));
    TEST_ASSERT_FALSE(bench_info().in_position);
    received = CM1E_OK;
    bench_cycles(22);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
}

static void test_a_move_to_where_it_stands_is_done_too(void)
{
    for (size_t k = 0; k < sizeof moves / sizeof moves[0]; k++) {
        const cm1e_command_id_t id = post(moves[k], 0.0, mcAborting);
        TEST_ASSERT_LESS_OR_EQUAL_INT(25, bench_wait(id, 100));
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    }
}

/* PLCopen 3.4, 3.5: these are done at velocity 0, wherever that is. */
static void test_halt_and_stop_do_not_wait(void)
{
    static const cm1e_command_kind_t stops[] = {CM1E_COMMAND_HALT, CM1E_COMMAND_STOP};
    for (int k = 0; k < 2; k++) {
        setUp();
        off = -2000;
        bench_move_velocity(5.0);
        bench_cycles(300);
        const cm1e_command_id_t id = bench_start_command(&(cm1e_axis_command_t){.kind = stops[k]});
        bench_wait(id, 1000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
        TEST_ASSERT_FALSE(bench_info().in_position);
    }
}

/* ---- not there in time ------------------------------------------------------------------------------------------- */

static void test_a_stop_ends_in_an_error_in_words(void)
{
    stop = 250000;
    bus.torque = 1500;
    const cm1e_command_id_t id = post(CM1E_COMMAND_MOVE_ABSOLUTE, 5.4, mcAborting);
    until_set_point(5.4);
    bench_cycles(1990);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(id));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISCRETE_MOTION, bench_info().state);
    bench_cycles(15);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, bench_state_of(id));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_NOT_IN_POSITION, cm1e_axis_command_status(axis, id).error);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_NOT_IN_POSITION, bench_info().error);
    static const char *const words[] = {"did not reach its set-point in time, which is 2 s",
                                        "stood at 5.4 u", "at 5 u", "0.4 u below", "150 %", "window is 0.0002 u", "mechanical stop", "MC_Reset"};
    bench_cycles(50);
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        bench_told(words[i]);
    TEST_ASSERT_NOT_EQUAL_INT(OPERATION_ENABLED, bus.state); /* it pushes no longer */
    bus.position -= 700;                                     /* and springs back, which the text does not follow */
    bus.torque = 0;
    bench_cycles(1);
    bench_told("at 5 u");
    bench_power(false);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_reset(axis));
    bench_cycles(20);
    bench_enable();
    const cm1e_command_id_t back = post(CM1E_COMMAND_MOVE_ABSOLUTE, 1.0, mcAborting);
    bench_wait(back, 3000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(back));
}

static void test_the_text_says_what_the_torque_tells(void)
{
    for (int pushes = 0; pushes < 2; pushes++) {
        begin(true);
        bus.config.axes[0].in_position_timeout_s = 0.3;
        bench_create();
        bench_enable();
        off = 30;
        bus.torque = pushes ? -900 : 120;
        const cm1e_command_id_t id = post(CM1E_COMMAND_MOVE_RELATIVE, -1.0, mcAborting);
        bench_wait(id, 1000);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, bench_state_of(id));
        bench_told(pushes ? "90 % of its rated torque" : "12 % of its rated torque");
        bench_told(pushes ? "The motor pushes" : "friction");
        bench_told("0.0006 u above");
        bench_told("which is 0.3 s");
    }
}

/* A motor whose torque is not in the process data. */
static void test_the_text_without_torque(void)
{
    fake_bus_init(&bus, CM1E_MAPPING_CSP, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    for (unsigned i = 0; i < bus.tx.entry_count; i++)
        if (bus.tx.entries[i].index == OBJ_6077_TORQUE_ACTUAL_VALUE)
            bus.tx.entries[i].index = 0; /* a gap */
    bus.config.axes[0].in_position_done_waits = true;
    bus.blocked = true;
    bus.world = shaft;
    bench_create();
    bench_enable();
    TEST_ASSERT_FALSE(bench_info().torque_known);
    stop = 0;
    bench_wait(post(CM1E_COMMAND_MOVE_RELATIVE, 0.3, mcAborting), 5000);
    bench_told("0.3 u below it; in_position");
    bench_told("torque limit");
}

/* ---- meanwhile --------------------------------------------------------------------------------------------------- */

static cm1e_command_id_t waiting_at(double position)
{
    setUp();
    off = -500;
    const cm1e_command_id_t id = post(CM1E_COMMAND_MOVE_ABSOLUTE, position, mcAborting);
    until_set_point(position);
    watch_cycles(50);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(id));
    return id;
}

static void test_other_commands_abort_it(void)
{
    static const cm1e_command_kind_t kinds[] = {CM1E_COMMAND_MOVE_ABSOLUTE, CM1E_COMMAND_MOVE_RELATIVE,
                                                CM1E_COMMAND_MOVE_VELOCITY, CM1E_COMMAND_HALT, CM1E_COMMAND_STOP};
    for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        const cm1e_command_id_t first = waiting_at(1.0);
        const cm1e_command_id_t second = post(kinds[k], 0.5, mcAborting);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, bench_state_of(first));
        off = 0;
        watch_cycles(800);
        TEST_ASSERT_EQUAL_INT(kinds[k] == CM1E_COMMAND_MOVE_VELOCITY ? CM1E_COMMAND_ACTIVE : CM1E_COMMAND_DONE,
                              bench_state_of(second));
    }
}

static void test_power_off_aborts_it(void)
{
    const cm1e_command_id_t id = waiting_at(1.0);
    bench_power(false);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, bench_state_of(id));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISABLED, bench_info().state);
    bench_cycles(3000);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, bench_info().error);
    TEST_ASSERT_NOT_EQUAL_INT(OPERATION_ENABLED, bus.state);
}

static void test_a_direction_that_is_disabled_does_not_end_it(void)
{
    const cm1e_command_id_t id = waiting_at(1.0);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_power(axis, &owner, true, false, false));
    watch_cycles(50);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(id));
    off = 0;
    watch_cycles(30);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
}

/* Commands behind it, before and after its set-point has arrived: they go on from there at once, and it is Done. */
static void test_what_is_buffered_is_not_kept_waiting(void)
{
    for (int mode = mcBuffered; mode <= mcBlendingHigh; mode++)
        for (int late = 0; late < 2; late++) {
            setUp();
            off = -500;
            const cm1e_command_id_t first = post(CM1E_COMMAND_MOVE_ABSOLUTE, 1.0, mcAborting);
            if (late) {
                until_set_point(1.0);
                watch_cycles(50);
            }
            const cm1e_command_id_t second = post(CM1E_COMMAND_MOVE_ABSOLUTE, 2.0, (MC_BUFFER_MODE)mode);
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(first));
            for (int i = 0; i < 2 || (!late && bench_info().set_position <= 1.0); i++)
                watch_cycles(1);
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(first));
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(second));
            TEST_ASSERT_TRUE(bench_info().set_position > 1.0);
            watch_cycles(1000);
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(second)); /* the last one waits */
            off = 0;
            watch_cycles(30);
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(second));
        }
}

/* The set-points are equal in every cycle, with and without the option. */
static void test_a_chain_moves_as_without_it(void)
{
    enum { CYCLES = 2500 };
    static position_t set[2][CYCLES];
    static const struct {
        double position;
        MC_BUFFER_MODE mode;
    } chain[] = {{1.0, mcAborting}, {2.0, mcBlendingHigh}, {1.5, mcBuffered}, {1.8, mcBlendingNext}, {0.2, mcBuffered}};
    for (int waits = 0; waits < 2; waits++) {
        begin(waits != 0);
        off = -300;
        for (size_t i = 0; i < sizeof chain / sizeof chain[0]; i++)
            post(CM1E_COMMAND_MOVE_ABSOLUTE, chain[i].position, chain[i].mode);
        for (int i = 0; i < CYCLES; i++) {
            watch_cycles(1);
            set[waits][i] = axis->setpoint.position;
        }
    }
    for (int i = 0; i < CYCLES; i++)
        TEST_ASSERT_EQUAL_DOUBLE(0.0, cm1e_position_minus(set[1][i], set[0][i]));
}

static void test_a_buffered_homing_begins_behind_it(void)
{
    const cm1e_command_id_t first = waiting_at(1.0);
    const cm1e_homing_config_t homing = {.method = -1};
    const cm1e_command_id_t home = bench_start_command(&(cm1e_axis_command_t){
        .kind = CM1E_COMMAND_HOME, .homing = &homing, .buffer_mode = mcBuffered});
    bench_cycles(3);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(first));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(home));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_HOMING, bench_info().state);
}

static void test_continuous_update_moves_it_on(void)
{
    const cm1e_command_id_t id = waiting_at(1.0);
    cm1e_axis_command_t inputs = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 1.0, .velocity = 5.0};
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_update(axis, id, &inputs)); /* as a block in every cycle */
    inputs.position = 2.0;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_update(axis, id, &inputs));
    watch_cycles(100);
    TEST_ASSERT_TRUE(bench_info().set_position > 1.1 && bench_info().set_position < 1.9);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(id));
    off = 0;
    watch_cycles(1000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
    TEST_ASSERT_EQUAL_DOUBLE(2.0, bench_info().set_position);
}

/* Neither a velocity nor an override that changes all the time puts the timeout off. */
static void test_nothing_puts_the_timeout_off(void)
{
    for (int by_override = 0; by_override < 2; by_override++) {
        const cm1e_command_id_t id = waiting_at(1.0);
        int cycles = 0;
        for (; bench_state_of(id) == CM1E_COMMAND_ACTIVE && cycles < 4000; cycles++) {
            const cm1e_axis_command_t inputs = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 1.0,
                                                .velocity = 5.0 + (by_override ? 0 : cycles % 7)};
            TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_update(axis, id, &inputs));
            TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_override(axis, by_override ? cycles % 5 * 0.25 : 1, 1, 1));
            bench_cycles(1);
        }
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, bench_state_of(id));
        TEST_ASSERT_INT_WITHIN(60, 1950, cycles);
    }
}

static void test_a_superimposed_motion_takes_it_as_done(void)
{
    const cm1e_command_id_t id = waiting_at(1.0);
    const cm1e_command_id_t on_top = post(CM1E_COMMAND_MOVE_SUPERIMPOSED, 0.5, mcAborting);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISCRETE_MOTION, bench_info().state);
    watch_cycles(500);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(on_top));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_EQUAL_DOUBLE(1.5, bench_info().set_position);
}

static void test_a_position_that_is_set_meanwhile_changes_nothing(void)
{
    const cm1e_command_id_t id = waiting_at(1.0);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_set_position(axis, 100.0, true));
    watch_cycles(50);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(id));
    off = 0;
    watch_cycles(30);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
    TEST_ASSERT_EQUAL_DOUBLE(101.0, bench_info().set_position);
}

/* The lag has its limit meanwhile, and its error comes first. */
static void test_the_lag_is_watched_meanwhile(void)
{
    const cm1e_command_id_t id = waiting_at(1.0);
    for (int i = 0; i < 8; i++) { /* no faster than a motor can go */
        off -= 3250;
        bench_cycles(1);
    }
    bench_cycles(2);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, bench_state_of(id));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_LAG, bench_info().error);
}

/* The motor goes on through the gap while the load stands at its target. */
static void test_a_backlash_is_taken_up_before(void)
{
    begin(true);
    bus.config.axes[0].backlash = 0.1;
    bus.config.axes[0].backlash_velocity = 0.5; /* 5,000 counts at 25 a cycle */
    bench_create();
    bench_enable();
    const cm1e_command_id_t id = post(CM1E_COMMAND_MOVE_ABSOLUTE, -0.002, mcAborting);
    bench_wait(id, 3000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
    TEST_ASSERT_INT32_WITHIN(2, -100 - 5000, bus.position);
}

/* ---- homing ------------------------------------------------------------------------------------------------------ */

static int homing_cycle;

/* UG 6.2.4: in progress, attained, completed; then the motor rests. */
static void homing(cm1e_bus_t *b)
{
    if (!(b->controlword & CONTROLWORD_HOMING_START))
        return;
    homing_cycle++;
    b->mode_status = (uint16_t)(homing_cycle < 100 ? 0
                                : homing_cycle < 120 ? STATUSWORD_HOMING_ATTAINED
                                                     : STATUSWORD_HOMING_ATTAINED | STATUSWORD_TARGET_REACHED);
    b->position = homing_cycle < 120 ? -10 * homing_cycle : 0;
}

static void test_homing_waits_for_the_motor_too(void)
{
    for (int waits = 0; waits < 2; waits++)
        for (int there = 0; there < 2; there++) {
            begin(waits);
            bus.homing = homing;
            homing_cycle = 0;
            const cm1e_homing_config_t config = {.method = -1};
            const cm1e_command_id_t id = bench_start_command(&(cm1e_axis_command_t){
                .kind = CM1E_COMMAND_HOME, .homing = &config, .position = 3.0});
            while (bus.mode != CM1E_MODE_HM || homing_cycle < 120)
                bench_cycles(1);
            while (bench_state_of(id) == CM1E_COMMAND_ACTIVE && bus.mode != CM1E_MODE_CSP)
                bench_cycles(1);
            off = there ? 0 : 200;
            int cycles = 0;
            for (; bench_state_of(id) == CM1E_COMMAND_ACTIVE && cycles < 3000; cycles++) {
                TEST_ASSERT_EQUAL_INT(CM1E_AXIS_HOMING, bench_info().state);
                bench_cycles(1);
            }
            TEST_ASSERT_EQUAL_INT(waits && !there ? CM1E_COMMAND_ERROR : CM1E_COMMAND_DONE, bench_state_of(id));
            TEST_ASSERT_INT_WITHIN(25, waits && !there ? 2000 : 0, cycles);
            if (waits && !there)
                bench_told("did not reach its set-point");
            else
                TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
            TEST_ASSERT_TRUE(bench_info().homed);
        }
}

/* ---- motions by the drive ---------------------------------------------------------------------------------------- */

static int swings_left; /* cycles */

/* A drive that says "target reached" from the beginning, and whose motor passes the target and swings around it. */
static void drive_lies(cm1e_bus_t *b)
{
    if (b->state != OPERATION_ENABLED || b->mode != CM1E_MODE_PP)
        return;
    const bool announced = b->controlword & CONTROLWORD_NEW_SET_POINT;
    b->mode_status = (uint16_t)(STATUSWORD_TARGET_REACHED | (announced ? STATUSWORD_SET_POINT_ACKNOWLEDGE : 0));
    const int32_t way = b->target_position + (int32_t)lround(300.0 * sin(0.1 * swings_left)) - b->position;
    b->position += way > 100 ? 100 : way < -100 ? -100 : way;
    swings_left -= swings_left > 0;
}

/* The mode of the axis, whose target is that of the motion, takes over from a motor at rest only. */
static void test_a_motor_that_turns_is_not_at_the_target_of_its_drive(void)
{
    for (int swings = 100; swings < 400; swings += 7) {
        bench_end();
        fake_bus_init(&bus, CM1E_MAPPING_PROFILE, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        bus.config.axes[0].motion = CM1E_MOTION_DRIVE;
        bus.world = drive_lies;
        swings_left = swings;
        bench_create();
        bench_enable();
        const cm1e_command_id_t id = bench_move_by(0.1, 10.0);
        for (int n = 0; n < 1000 && bench_state_of(id) == CM1E_COMMAND_ACTIVE; n++) {
            bench_cycles(1);
            TEST_ASSERT_TRUE_MESSAGE(swings_left == 0 || swings_left == swings || bus.mode == CM1E_MODE_PP,
                                     "the mode is switched while the motor turns");
        }
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(id));
        TEST_ASSERT_EQUAL_INT(CM1E_MODE_CSP, bus.mode);
    }
}

/* An axis with `motion: drive`, whose motor does what `world` says. */
static void begin_drive_profiles(void (*world)(cm1e_bus_t *b))
{
    bench_end();
    fake_bus_init(&bus, CM1E_MAPPING_PROFILE, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.config.axes[0].motion = CM1E_MOTION_DRIVE;
    bus.config.axes[0].in_position_timeout_s = 0.5;
    bus.world = world;
}

/* A drive that never shows its motor at rest does not keep the move Active for ever: not one that says "target reached"
 * from the beginning on, and not before the profile can have ended. */
static void test_a_motor_that_never_rests_at_the_target_of_its_drive_is_an_error(void)
{
    static const double ways[] = {0.1, 3.0};
    for (int i = 0; i < 2; i++) {
        begin_drive_profiles(drive_lies);
        swings_left = INT_MAX;
        bench_create();
        bench_enable();
        const cm1e_command_id_t id = bench_move_by(ways[i], 1.0);
        int cycles = 0;
        while (bench_state_of(id) == CM1E_COMMAND_ACTIVE && cycles < 10000) {
            bench_cycles(1);
            cycles++;
        }
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, bench_state_of(id));
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_NOT_IN_POSITION, bench_info().error);
        bench_told("did not reach its set-point");
        TEST_ASSERT_TRUE(cycles > 500 + 1000 * ways[i] && cycles < 1000 + 1000 * ways[i]);
    }
}

static int32_t short_of; /* counts */

/* A drive that never says "target reached": its motor stops at the target or before it. */
static void drive_is_mute(cm1e_bus_t *b)
{
    if (b->state != OPERATION_ENABLED || b->mode != CM1E_MODE_PP)
        return;
    b->mode_status = b->controlword & CONTROLWORD_NEW_SET_POINT ? STATUSWORD_SET_POINT_ACKNOWLEDGE : 0;
    const int32_t way = b->target_position - short_of - b->position;
    b->position += way > 10 ? 10 : way < -10 ? -10 : way; /* slower than its profile */
}

static void test_a_drive_that_never_says_that_it_is_there_is_an_error(void)
{
    for (int elsewhere = 0; elsewhere < 2; elsewhere++) {
        begin_drive_profiles(drive_is_mute);
        short_of = elsewhere ? 10000 : 0;
        bench_create();
        bench_enable();
        const cm1e_command_id_t id = bench_move_by(1.0, 10.0);
        const int way = (50000 - short_of) / 10, cycles = bench_wait(id, 10000);
        TEST_ASSERT_INT_WITHIN(20, way + 500, cycles);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, bench_state_of(id));
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_NOT_IN_POSITION, bench_info().error);
        bench_told(elsewhere ? "0.2 u below it" : "the drive did not say that its target is reached");
    }
}

/* Around a pause two frames may follow each other at once, many cycles apart by number. */
static void test_a_pause_is_no_standstill(void)
{
    standstill_t standstill;
    cm1e_axis_watch_standstill(axis, &standstill);
    axis->now_ns += 60 * MS_IN_NS;
    TEST_ASSERT_FALSE(cm1e_axis_is_at_standstill(axis, &standstill));
    bus.sent_ns += 60 * MS_IN_NS;
    TEST_ASSERT_TRUE(cm1e_axis_is_at_standstill(axis, &standstill));
}

/* Also where the profile is shorter than a cycle, the motor has its time to come to rest. */
static void test_a_tiny_move_of_the_drive_has_that_time_too(void)
{
    for (int counts = 1; counts < 12; counts++) {
        bench_end();
        fake_bus_init(&bus, CM1E_MAPPING_PROFILE, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        bus.config.axes[0].motion = CM1E_MOTION_DRIVE;
        bus.config.axes[0].max_acceleration = bus.config.axes[0].max_deceleration = 600.0;
        bus.world = drive_lies;
        swings_left = 0;
        bench_create();
        bench_enable();
        bench_cycles(2500);
        const cm1e_command_id_t id = bench_move_by(counts / 50000.0, 0.1);
        for (int n = 0; n < 1000 && bench_state_of(id) == CM1E_COMMAND_ACTIVE; n++)
            bench_cycles(1);
        char text[64];
        snprintf(text, sizeof text, "%d counts", counts);
        TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_COMMAND_DONE, bench_state_of(id), text);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_it_is_shown_where_done_does_not_wait);
    RUN_TEST(test_window_and_time_are_settable);
    RUN_TEST(test_the_default_window);
    RUN_TEST(test_done_comes_when_the_motor_was_there_for_the_time);
    RUN_TEST(test_leaving_the_window_begins_the_time_anew);
    RUN_TEST(test_lost_frames_do_not_make_it_done);
    RUN_TEST(test_a_move_to_where_it_stands_is_done_too);
    RUN_TEST(test_halt_and_stop_do_not_wait);
    RUN_TEST(test_a_stop_ends_in_an_error_in_words);
    RUN_TEST(test_the_text_says_what_the_torque_tells);
    RUN_TEST(test_the_text_without_torque);
    RUN_TEST(test_other_commands_abort_it);
    RUN_TEST(test_power_off_aborts_it);
    RUN_TEST(test_a_direction_that_is_disabled_does_not_end_it);
    RUN_TEST(test_what_is_buffered_is_not_kept_waiting);
    RUN_TEST(test_a_chain_moves_as_without_it);
    RUN_TEST(test_a_buffered_homing_begins_behind_it);
    RUN_TEST(test_continuous_update_moves_it_on);
    RUN_TEST(test_nothing_puts_the_timeout_off);
    RUN_TEST(test_a_superimposed_motion_takes_it_as_done);
    RUN_TEST(test_a_position_that_is_set_meanwhile_changes_nothing);
    RUN_TEST(test_the_lag_is_watched_meanwhile);
    RUN_TEST(test_a_backlash_is_taken_up_before);
    RUN_TEST(test_homing_waits_for_the_motor_too);
    RUN_TEST(test_a_motor_that_turns_is_not_at_the_target_of_its_drive);
    RUN_TEST(test_a_motor_that_never_rests_at_the_target_of_its_drive_is_an_error);
    RUN_TEST(test_a_drive_that_never_says_that_it_is_there_is_an_error);
    RUN_TEST(test_a_pause_is_no_standstill);
    RUN_TEST(test_a_tiny_move_of_the_drive_has_that_time_too);
    return UNITY_END();
}
