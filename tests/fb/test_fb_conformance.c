/**
 * The blocks on a whole simulated axis: what each shows, and the state of the axis, when it is done, aborted by each
 * other block, refused in each state, hit by an error (PLCopen Part 1 v2.0, 2.1 figure 2, 2.2.2, 2.4.1, 3.1 - 3.10).
 */
#include <stdlib.h>

#include "fb_bench.h"

#define EXPECT_STATE(name)                                                                                           \
    ck_assert_str_eq(cm1e_axis_state_name(bench.info.state), cm1e_axis_state_name(CM1E_AXIS_##name))
#define EXPECT_ERROR(set, kind, expected) expect_error(set, (kind_t)(kind), expected, __LINE__)

static void expect_error(int set, kind_t kind, cm1e_error_t expected, int line)
{
    const shown_t *now = &bench.shown[set][kind];
    ck_assert_msg(now->error && now->error_id == cm1e_error_id(expected), "line %d: %s shows %#x instead of %#x", line,
                  kind_names[kind], now->error_id, cm1e_error_id(expected));
}

/** The state in which a block holds the axis, a while after its start. */
static const cm1e_axis_state_t state_of[RESET] = {
    [ABSOLUTE] = CM1E_AXIS_DISCRETE_MOTION,   [RELATIVE] = CM1E_AXIS_DISCRETE_MOTION,
    [VELOCITY] = CM1E_AXIS_CONTINUOUS_MOTION, [HALT] = CM1E_AXIS_DISCRETE_MOTION,
    [STOP] = CM1E_AXIS_STOPPING,              [HOME] = CM1E_AXIS_HOMING,
};

/** Brings the axis into the middle of a command of the first set. Halt and Stop need a motion to end. */
static void begin(kind_t kind)
{
    bench_open_powered();
    if (kind == HALT || kind == STOP) {
        bench.execute[1][VELOCITY] = TRUE;
        SCAN_UNTIL(bench.shown[1][VELOCITY].in_velocity);
        bench.execute[1][VELOCITY] = FALSE;
    }
    bench.execute[0][kind] = TRUE;
    scans(kind == HOME ? 200 : 20);
    ck_assert(bench.shown[0][kind].busy);
    ck_assert_int_eq(bench.info.state, state_of[kind]);
}

/* ---- done ------------------------------------------------------------------------------------------------------ */

START_TEST(test_command_ends_in_standstill_and_done)
{
    const kind_t kind = (kind_t)(_i / 2);
    const BOOL held = (BOOL)(_i % 2);
    if (kind == VELOCITY)
        return;
    begin(kind);
    bench.execute[0][kind] = held;
    int done_scans = 0;
    SCAN_UNTIL(bench.shown[0][kind].done);
    for (int i = 0; i < 10; i++, scan())
        done_scans += bench.shown[0][kind].done;
    ck_assert_int_eq(done_scans, held ? 10 : 1);
    ck_assert_int_eq(bench.info.state, kind == STOP && held ? CM1E_AXIS_STOPPING : CM1E_AXIS_STANDSTILL);
    bench.execute[0][kind] = FALSE;
    scan();
    ck_assert(!bench.shown[0][kind].done && !bench.shown[0][kind].busy);
    EXPECT_STATE(STANDSTILL);
    bench_close();
}
END_TEST

START_TEST(test_moves_reach_their_targets)
{
    bench_open_powered();
    bench.execute[0][ABSOLUTE] = TRUE;
    SCAN_UNTIL(bench.shown[0][ABSOLUTE].done);
    ck_assert_double_eq_tol(bench.info.set_position, 5, 1e-6);
    bench.execute[0][RELATIVE] = TRUE;
    SCAN_UNTIL(bench.shown[0][RELATIVE].done);
    ck_assert_double_eq_tol(bench.info.set_position, 8, 1e-6);
    bench.execute[0][RELATIVE] = FALSE;
    bench.sets[0].relative.Distance = -6;
    scan();
    bench.execute[0][RELATIVE] = TRUE;
    SCAN_UNTIL(bench.shown[0][RELATIVE].done);
    ck_assert_double_eq_tol(bench.info.set_position, 2, 1e-6);
    bench.execute[0][HOME] = TRUE;
    bench.sets[0].home.Position = -1.5;
    SCAN_UNTIL(bench.shown[0][HOME].done);
    ck_assert(bench.info.homed);
    ck_assert_double_eq_tol(bench.info.actual_position, -1.5, 0.05);
    bench_close();
}
END_TEST

START_TEST(test_velocity_is_in_velocity_until_it_is_given_another)
{
    bench_open_powered();
    bench.execute[0][VELOCITY] = TRUE;
    SCAN_UNTIL(bench.shown[0][VELOCITY].in_velocity);
    ck_assert_double_eq_tol(bench.info.set_velocity, 4, 1e-9);
    bench.execute[0][VELOCITY] = FALSE;
    scans(50);
    ck_assert(bench.shown[0][VELOCITY].busy && bench.shown[0][VELOCITY].in_velocity);
    bench.sets[0].velocity.Velocity = -3;
    bench.execute[0][VELOCITY] = TRUE;
    scan();
    ck_assert(bench.shown[0][VELOCITY].busy && !bench.shown[0][VELOCITY].in_velocity);
    SCAN_UNTIL(bench.shown[0][VELOCITY].in_velocity);
    ck_assert_double_eq_tol(bench.info.set_velocity, -3, 1e-9);
    EXPECT_STATE(CONTINUOUS_MOTION);
    bench_close();
}
END_TEST

START_TEST(test_stop_holds_stopping_until_execute_falls)
{
    begin(STOP);
    SCAN_UNTIL(bench.shown[0][STOP].done);
    for (int i = 0; i < 100; i++, scan()) {
        ck_assert(bench.shown[0][STOP].done && bench.shown[0][STOP].active && bench.status.Stopping);
        ck_assert_double_eq_tol(bench.info.set_velocity, 0, 1e-9);
    }
    bench.execute[0][STOP] = FALSE;
    scan();
    EXPECT_STATE(STANDSTILL);
    bench.execute[0][ABSOLUTE] = TRUE;
    scan();
    ck_assert(bench.shown[0][ABSOLUTE].busy);
    bench_close();
}
END_TEST

START_TEST(test_stop_is_aborted_by_power_off_alone)
{
    begin(STOP);
    bench.power.Enable = FALSE;
    scan();
    ck_assert(bench.shown[0][STOP].aborted);
    EXPECT_STATE(DISABLED);
    bench_close();
}
END_TEST

START_TEST(test_stop_triggered_again_while_it_brakes_brakes_on)
{
    begin(STOP);
    bench.execute[0][STOP] = FALSE;
    scan();
    ck_assert(bench.shown[0][STOP].busy);
    bench.execute[0][STOP] = TRUE;
    scan();
    ck_assert(bench.shown[0][STOP].busy);
    SCAN_UNTIL(bench.shown[0][STOP].done);
    scans(5);
    EXPECT_STATE(STOPPING);
    bench_close();
}
END_TEST

/* ---- one block aborts another ---------------------------------------------------------------------------------- */

/** What figure 2 says of a command in the state that another one made. CM1E_OK: it takes the axis. */
static cm1e_error_t verdict(cm1e_axis_state_t state, kind_t kind)
{
    switch (state) {
    case CM1E_AXIS_DISABLED: return CM1E_ERROR_AXIS_NOT_POWERED;
    case CM1E_AXIS_ERROR_STOP: return CM1E_ERROR_AXIS_ERROR_STOP;
    case CM1E_AXIS_STOPPING: return CM1E_ERROR_AXIS_STOPPING;
    case CM1E_AXIS_HOMING: return kind == STOP ? CM1E_OK : CM1E_ERROR_AXIS_HOMING;
    case CM1E_AXIS_STANDSTILL: return CM1E_OK;
    default: return kind == HOME ? CM1E_ERROR_AXIS_STATE : CM1E_OK;
    }
}

START_TEST(test_every_block_against_every_running_one)
{
    const kind_t first = (kind_t)(_i / RESET), second = (kind_t)(_i % RESET);
    for (BOOL backwards = FALSE; backwards <= TRUE; backwards++) {
        begin(first);
        bench.backwards = backwards;
        const cm1e_error_t expected = verdict(bench.info.state, second);
        const double velocity_before = bench.info.set_velocity;
        bench.execute[1][second] = TRUE;
        scan();
        if (expected != CM1E_OK) {
            EXPECT_ERROR(1, second, expected);
            scan();
            ck_assert_msg(bench.shown[0][first].busy, "%s was disturbed by %s", kind_names[first], kind_names[second]);
            ck_assert_int_eq(bench.info.state, state_of[first]);
        } else {
            ck_assert_msg(bench.shown[1][second].busy, "%s does not take the axis from %s", kind_names[second],
                          kind_names[first]);
            scan(); /* at the latest one scan later, whichever is called first */
            ck_assert_msg(bench.shown[0][first].aborted, "%s does not notice %s", kind_names[first],
                          kind_names[second]);
            ck_assert_int_eq(bench.info.state, state_of[second]);
            ck_assert_double_le(fabs(bench.info.set_velocity - velocity_before), 5000 * 0.003);
        }
        bench_close();
    }
}
END_TEST

START_TEST(test_second_instance_of_the_same_block_aborts_the_first)
{
    const kind_t kinds[] = {ABSOLUTE, RELATIVE, VELOCITY, HALT};
    begin(kinds[_i]);
    bench.sets[1].absolute.Position = -4;
    bench.execute[1][kinds[_i]] = TRUE;
    scans(2);
    ck_assert(bench.shown[0][kinds[_i]].aborted && bench.shown[1][kinds[_i]].busy);
    for (int i = 0; i < 5; i++, scan())
        ck_assert(bench.shown[0][kinds[_i]].aborted);
    bench.execute[0][kinds[_i]] = FALSE;
    scan();
    ck_assert(!bench.shown[0][kinds[_i]].aborted);
    bench_close();
}
END_TEST

START_TEST(test_pulse_aborted_later_shows_it_for_one_scan)
{
    begin(ABSOLUTE);
    bench.execute[0][ABSOLUTE] = FALSE;
    scans(5);
    bench.execute[1][VELOCITY] = TRUE;
    int aborted = 0;
    for (int i = 0; i < 10; i++) {
        scan();
        aborted += bench.shown[0][ABSOLUTE].aborted;
    }
    ck_assert_int_eq(aborted, 1);
    bench_close();
}
END_TEST

START_TEST(test_retrigger_shows_nothing_of_the_first_command_and_takes_the_new_inputs)
{
    begin(ABSOLUTE);
    bench.sets[0].absolute.Position = 2; /* no edge: ignored */
    scans(3);
    bench.execute[0][ABSOLUTE] = FALSE;
    scan();
    bench.execute[0][ABSOLUTE] = TRUE;
    scan();
    ck_assert(bench.shown[0][ABSOLUTE].busy);
    SCAN_UNTIL(!bench.shown[0][ABSOLUTE].busy);
    ck_assert(bench.shown[0][ABSOLUTE].done);
    ck_assert_double_eq_tol(bench.info.set_position, 2, 1e-6);
    bench_close();
}
END_TEST

/* ---- refused --------------------------------------------------------------------------------------------------- */

START_TEST(test_refused_in_disabled)
{
    bench_open();
    EXPECT_STATE(DISABLED);
    bench.execute[0][_i] = TRUE;
    scan();
    EXPECT_ERROR(0, _i, CM1E_ERROR_AXIS_NOT_POWERED);
    EXPECT_STATE(DISABLED);
    bench_close();
}
END_TEST

START_TEST(test_refused_in_error_stop_until_reset)
{
    bench_open_powered();
    simulate("over-torque 1");
    SCAN_UNTIL(bench.info.state == CM1E_AXIS_ERROR_STOP);
    bench.execute[0][_i] = TRUE;
    scan();
    EXPECT_ERROR(0, _i, CM1E_ERROR_AXIS_ERROR_STOP);
    bench.execute[0][RESET] = TRUE;
    SCAN_UNTIL(!bench.shown[0][RESET].busy);
    ck_assert(bench.shown[0][RESET].done);
    SCAN_UNTIL(bench.info.state == CM1E_AXIS_STANDSTILL); /* MC_Power.Enable is still TRUE */
    EXPECT_ERROR(0, _i, CM1E_ERROR_AXIS_ERROR_STOP);      /* and nothing starts by itself */
    scans(50);
    EXPECT_STATE(STANDSTILL);
    bench.execute[0][_i] = FALSE;
    scan();
    bench.execute[0][_i] = TRUE;
    scan();
    ck_assert(bench.shown[0][_i].busy);
    bench_close();
}
END_TEST

START_TEST(test_wrong_inputs_are_errors_and_move_nothing)
{
    bench_open_powered();
    const double nan_value = NAN, infinite = INFINITY;
    const struct {
        kind_t kind;
        LREAL *input, value;
        cm1e_error_t error;
    } wrong[] = {
        {ABSOLUTE, &bench.sets[0].absolute.Position, nan_value, CM1E_ERROR_AXIS_POSITION_RANGE},
        {ABSOLUTE, &bench.sets[0].absolute.Position, infinite, CM1E_ERROR_AXIS_POSITION_RANGE},
        {ABSOLUTE, &bench.sets[0].absolute.Position, 1e300, CM1E_ERROR_AXIS_POSITION_RANGE},
        {ABSOLUTE, &bench.sets[0].absolute.Velocity, 0, CM1E_ERROR_AXIS_VELOCITY_RANGE},
        {ABSOLUTE, &bench.sets[0].absolute.Velocity, nan_value, CM1E_ERROR_AXIS_VELOCITY_RANGE},
        {ABSOLUTE, &bench.sets[0].absolute.Velocity, 1e9, CM1E_ERROR_AXIS_VELOCITY_RANGE},
        {ABSOLUTE, &bench.sets[0].absolute.Acceleration, -1, CM1E_ERROR_AXIS_DYNAMICS_RANGE},
        {ABSOLUTE, &bench.sets[0].absolute.Deceleration, nan_value, CM1E_ERROR_AXIS_DYNAMICS_RANGE},
        {ABSOLUTE, &bench.sets[0].absolute.Jerk, -5, CM1E_ERROR_AXIS_DYNAMICS_RANGE},
        {RELATIVE, &bench.sets[0].relative.Distance, nan_value, CM1E_ERROR_AXIS_POSITION_RANGE},
        {RELATIVE, &bench.sets[0].relative.Velocity, 0, CM1E_ERROR_AXIS_VELOCITY_RANGE},
        {VELOCITY, &bench.sets[0].velocity.Velocity, infinite, CM1E_ERROR_AXIS_VELOCITY_RANGE},
        {VELOCITY, &bench.sets[0].velocity.Jerk, infinite, CM1E_ERROR_AXIS_DYNAMICS_RANGE},
        {HALT, &bench.sets[0].halt.Deceleration, -1, CM1E_ERROR_AXIS_DYNAMICS_RANGE},
        {STOP, &bench.sets[0].stop.Deceleration, nan_value, CM1E_ERROR_AXIS_DYNAMICS_RANGE},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        const double good = *wrong[i].input, position = bench.info.set_position;
        *wrong[i].input = wrong[i].value;
        bench.execute[0][wrong[i].kind] = TRUE;
        scan();
        EXPECT_ERROR(0, wrong[i].kind, wrong[i].error);
        scans(3);
        ck_assert_double_eq(bench.info.set_position, position);
        EXPECT_STATE(STANDSTILL); /* 2.4.1: an error of a block does not bring the axis into ErrorStop */
        bench.execute[0][wrong[i].kind] = FALSE;
        *wrong[i].input = good;
        scan();
    }
    bench_close();
}
END_TEST

START_TEST(test_a_buffer_mode_that_is_none_is_refused)
{
    bench_open_powered();
    MC_BUFFER_MODE *const modes[RESET] = {
        [ABSOLUTE] = &bench.sets[0].absolute.BufferMode, [RELATIVE] = &bench.sets[0].relative.BufferMode,
        [VELOCITY] = &bench.sets[0].velocity.BufferMode, [HALT] = &bench.sets[0].halt.BufferMode,
        [HOME] = &bench.sets[0].home.BufferMode};
    for (int kind = 0; kind < RESET; kind++) {
        if (!modes[kind])
            continue;
        *modes[kind] = (MC_BUFFER_MODE)(mcBlendingHigh + 1);
        bench.execute[0][kind] = TRUE;
        scan();
        EXPECT_ERROR(0, kind, CM1E_ERROR_AXIS_BUFFER_MODE);
        bench.execute[0][kind] = FALSE;
        scan();
    }
    bench_close();
}
END_TEST

/* ---- errors and power ------------------------------------------------------------------------------------------ */

START_TEST(test_axis_error_is_an_error_of_the_running_block)
{
    begin((kind_t)_i);
    simulate("over-torque 1");
    SCAN_UNTIL(bench.info.state == CM1E_AXIS_ERROR_STOP);
    scan();
    ck_assert(bench.shown[0][_i].error && !bench.shown[0][_i].aborted);
    SCAN_UNTIL(!bench.power.Status);
    scan();
    ck_assert(bench.power.Error && bench.power.ErrorID == cm1e_error_id(CM1E_ERROR_DRIVE_FAULT));
    MC_ReadAxisError_t reader = {.Axis = &bench.reference, .Enable = TRUE};
    MC_ReadAxisError(&reader);
    ck_assert_uint_eq(reader.AxisErrorID, cm1e_error_id(CM1E_ERROR_DRIVE_FAULT));
    ck_assert_uint_eq(reader.DeviceErrorCode, 0x2310);
    char text[512];
    cm1e_axis_error_text(bench.reference, text, sizeof text);
    ck_assert_msg(strlen(text) > 20, "%s", text);
    bench_close();
}
END_TEST

START_TEST(test_reset_with_power_disabled_leads_to_disabled)
{
    bench_open_powered();
    simulate("over-torque 1");
    SCAN_UNTIL(bench.info.state == CM1E_AXIS_ERROR_STOP);
    bench.power.Enable = FALSE;
    scans(10);
    EXPECT_STATE(ERROR_STOP); /* note 2: Enable FALSE does not leave ErrorStop */
    bench.execute[0][RESET] = TRUE;
    SCAN_UNTIL(bench.shown[0][RESET].done);
    scans(300);
    EXPECT_STATE(DISABLED);
    ck_assert(!bench.power.Status);
    bench_close();
}
END_TEST

START_TEST(test_reset_without_error_does_nothing)
{
    begin(VELOCITY);
    bench.execute[1][RESET] = TRUE;
    SCAN_UNTIL(bench.shown[1][RESET].done);
    EXPECT_STATE(CONTINUOUS_MOTION);
    ck_assert(bench.shown[0][VELOCITY].busy);
    bench_close();
}
END_TEST

START_TEST(test_reset_whose_cause_stays_is_an_error)
{
    bench_open_powered();
    simulate("error 1 7500 hold");
    SCAN_UNTIL(bench.info.state == CM1E_AXIS_ERROR_STOP);
    bench.execute[0][RESET] = TRUE;
    SCAN_UNTIL(!bench.shown[0][RESET].busy);
    ck_assert(bench.shown[0][RESET].error);
    EXPECT_STATE(ERROR_STOP);
    simulate("error 1 clear");
    bench.execute[0][RESET] = FALSE;
    scan();
    bench.execute[0][RESET] = TRUE;
    SCAN_UNTIL(!bench.shown[0][RESET].busy);
    ck_assert(bench.shown[0][RESET].done);
    bench_close();
}
END_TEST

START_TEST(test_power_off_aborts_the_running_block_and_ramps_down)
{
    begin((kind_t)_i);
    bench.power.Enable = FALSE;
    scan();
    ck_assert(bench.shown[0][_i].aborted);
    EXPECT_STATE(DISABLED);
    SCAN_UNTIL(!bench.power.Status);
    scans(100);
    ck_assert_double_eq_tol(bench.info.actual_velocity, 0, 0.1);
    ck_assert(!bench.info.powered);
    bench_close();
}
END_TEST

START_TEST(test_block_that_is_no_longer_called_moves_on)
{
    static MC_MoveAbsolute_t forgotten;
    bench_open_powered();
    forgotten = (MC_MoveAbsolute_t){.Axis = &bench.reference, .Execute = TRUE, .Position = 3, .Velocity = 20};
    MC_MoveAbsolute(&forgotten);
    ck_assert(forgotten.Busy);
    memset(&forgotten, 0xA5, sizeof forgotten); /* gone, and its memory used for something else */
    SCAN_UNTIL(bench.info.state == CM1E_AXIS_STANDSTILL && bench.info.set_position > 2.9);
    ck_assert_double_eq_tol(bench.info.set_position, 3, 1e-6);
    bench_close();
}
END_TEST

START_TEST(test_block_called_after_very_many_other_commands_shows_aborted)
{
    static MC_MoveAbsolute_t sleeper;
    bench_open_powered();
    sleeper = (MC_MoveAbsolute_t){.Axis = &bench.reference, .Execute = TRUE, .Position = 3, .Velocity = 20};
    MC_MoveAbsolute(&sleeper);
    for (int i = 0; i < 500; i++) {
        bench.execute[0][RELATIVE] = (BOOL)(i % 2);
        scan();
    }
    MC_MoveAbsolute(&sleeper);
    ck_assert(sleeper.CommandAborted && !sleeper.Done && !sleeper.Busy);
    bench_close();
}
END_TEST

START_TEST(test_direction_that_is_not_enabled_is_refused)
{
    bench_open_powered();
    bench.power.EnablePositive = FALSE;
    bench.execute[0][RELATIVE] = bench.execute[0][VELOCITY] = TRUE;
    scan();
    EXPECT_ERROR(0, RELATIVE, CM1E_ERROR_AXIS_DIRECTION_DISABLED);
    EXPECT_ERROR(0, VELOCITY, CM1E_ERROR_AXIS_DIRECTION_DISABLED);
    bench.execute[0][RELATIVE] = FALSE;
    bench.sets[0].relative.Distance = -1;
    scan();
    bench.execute[0][RELATIVE] = TRUE;
    SCAN_UNTIL(bench.shown[0][RELATIVE].done);
    bench_close();
}
END_TEST

/* ---- whatever a program does ----------------------------------------------------------------------------------- */

static unsigned random_state;
static unsigned random_below(unsigned n)
{
    random_state = random_state * 1664525u + 1013904223u;
    return (random_state >> 9) % n;
}

static void random_inputs(set_t *set)
{
    set->absolute.Position = (double)random_below(16) - 8;
    set->absolute.Velocity = 1 + random_below(30);
    set->absolute.Jerk = random_below(2) * 50000.0;
    set->relative.Distance = (double)random_below(5) - 2;
    set->relative.Velocity = 1 + random_below(30);
    set->velocity.Velocity = ((double)random_below(9) - 4) * 3;
    set->velocity.Direction = (MC_DIRECTION)(1 + random_below(4));
    set->halt.Deceleration = random_below(2) * 100.0;
}

/** Random edges on all blocks with faults in between: the rules hold in every scan, and the set-point never jumps. */
START_TEST(test_random_program_keeps_the_rules_and_the_set_point_smooth)
{
    static const char *const faults[] = {"power 1 off", "over-torque 1", "lose 1", "lose 10", "error 1 4310"};
    const unsigned seed = 471100u + (unsigned)_i;
    printf("seed %u\n", seed);
    random_state = seed;
    bench_open_powered();
    unsigned seen[CM1E_AXIS_STATE_COUNT] = {0};
    for (int i = 0; i < 30000; i++) {
        const cm1e_axis_info_t before = bench.info;
        const int set = (int)random_below(SETS), kind = (int)random_below(KINDS);
        random_inputs(&bench.sets[set]);
        if (random_below(20) == 0 && (kind != HOME || random_below(3) == 0))
            bench.execute[set][kind] = !bench.execute[set][kind];
        bench.power.Enable = (BOOL)(bench.power.Enable ? random_below(3000) != 0 : random_below(100) == 0);
        bench.backwards = (BOOL)random_below(2);
        if (random_below(3000) == 0)
            simulate(faults[random_below(5)]);
        if (bench.info.state == CM1E_AXIS_ERROR_STOP && random_below(100) == 0) {
            simulate("power 1 on");
            simulate("error 1 clear");
            bench.execute[0][RESET] = !bench.execute[0][RESET];
        }
        scan();
        seen[bench.info.state]++;
        if (before.state == bench.info.state && before.powered && bench.info.powered && !bench.status.Homing)
            if (fabs(bench.info.set_position - before.set_position) > 2500 * 0.001)
                ck_abort_msg("scan %d: set-point jumps", i);
    }
    for (int state = 0; state < CM1E_AXIS_STATE_COUNT; state++)
        ck_assert_msg(seen[state] > 0 || state == CM1E_AXIS_SYNCHRONIZED_MOTION, "never in %s",
                      cm1e_axis_state_name((cm1e_axis_state_t)state));
    bench_close();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("conformance");
    const struct {
        const TTest *test;
        int loops; /* 0: a plain test */
    } tests[] = {
        {test_command_ends_in_standstill_and_done, 2 * RESET},
        {test_moves_reach_their_targets, 0},
        {test_velocity_is_in_velocity_until_it_is_given_another, 0},
        {test_stop_holds_stopping_until_execute_falls, 0},
        {test_stop_is_aborted_by_power_off_alone, 0},
        {test_stop_triggered_again_while_it_brakes_brakes_on, 0},
        {test_every_block_against_every_running_one, RESET * RESET},
        {test_second_instance_of_the_same_block_aborts_the_first, 4},
        {test_pulse_aborted_later_shows_it_for_one_scan, 0},
        {test_retrigger_shows_nothing_of_the_first_command_and_takes_the_new_inputs, 0},
        {test_refused_in_disabled, RESET},
        {test_refused_in_error_stop_until_reset, RESET},
        {test_wrong_inputs_are_errors_and_move_nothing, 0},
        {test_a_buffer_mode_that_is_none_is_refused, 0},
        {test_axis_error_is_an_error_of_the_running_block, RESET},
        {test_reset_with_power_disabled_leads_to_disabled, 0},
        {test_reset_without_error_does_nothing, 0},
        {test_reset_whose_cause_stays_is_an_error, 0},
        {test_power_off_aborts_the_running_block_and_ramps_down, RESET},
        {test_block_that_is_no_longer_called_moves_on, 0},
        {test_block_called_after_very_many_other_commands_shows_aborted, 0},
        {test_direction_that_is_not_enabled_is_refused, 0},
        {test_random_program_keeps_the_rules_and_the_set_point_smooth, 4},
    };
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 60);
    for (size_t i = 0; i < sizeof tests / sizeof tests[0]; i++)
        tcase_add_loop_test(all, tests[i].test, 0, tests[i].loops ? tests[i].loops : 1);
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
