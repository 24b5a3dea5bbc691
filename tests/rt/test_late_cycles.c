/**
 * Every cycle is late, and stays so: the work of a cycle takes longer than its time. No set-point moves in a late cycle, so
 * no motion, no ramp and no enabling ends. After two seconds every axis with torque is in ErrorStop, says why, and has
 * none. Until then the position loop of an axis in CSV goes on.
 */
#include <math.h>
#include <stdlib.h>

#include "cm1e/sim.h"
#include "machine.h"

#define MS INT64_C(1000000)
#define COUNTS 1000.0 /* per u */
enum { ENABLED_AT = 3, MOVED_AT = 60, LATE_AT = 120, ENOUGH_MS = 2300, SETTLED_MS = 500 };

static const double velocity = 10, acceleration = 50; /* u/s, u/s2 */
enum { IN_VELOCITY_AT = MOVED_AT + 200, RAMP_MS = 160 };

typedef enum deed { DEED_NONE = 0, DEED_POWER_OFF, DEED_STOP, DEED_HALT, DEED_HOME, DEEDS } deed_t;

typedef struct run {
    machine_t machine;
    MC_Power_t power;
    MC_MoveVelocity_t turn;
    MC_Stop_t stop;
    MC_Halt_t halt;
    MC_Home_t home;
    deed_t deed;                          /**< what the program does while the cycles are late */
    int late_at, late_ms, enough_ms, cycles, late_cycles;
    int64_t pause_ns;
    bool told;                            /**< the axis is in ErrorStop with the words of this error */
    double lag, set_velocity;             /**< u, u/s */
    double ahead, left;                   /**< u, of v * t: of the set-point at first, and the largest change since */
    void (*program)(void *context);
    cm1e_sim_probe_t probe;
} run_t;

static void look(run_t *run)
{
    cm1e_axis_info_t info = {0};
    char text[CM1E_AXIS_ERROR_TEXT_BYTES];
    cm1e_axis_read(run->machine.axis[0], &info);
    cm1e_axis_error_text(run->machine.axis[0], text, sizeof text);
    cm1e_sim_probe(cm1e_bus_segment(run->machine.bus), 1, &run->probe);
    run->lag = info.position_lag;
    run->set_velocity = info.set_velocity;
    run->told = info.state == CM1E_AXIS_ERROR_STOP && strstr(text, "every cycle ");
}

static void program(void *context)
{
    run_t *run = context;
    cm1e_clock_t *clock = cm1e_bus_clock(run->machine.bus);
    look(run);
    run->cycles++;
    run->power.Enable = run->cycles >= ENABLED_AT && !(run->deed == DEED_POWER_OFF && run->late_cycles > 5);
    MC_Power(&run->power);
    const bool moves = run->power.Status && run->cycles >= MOVED_AT;
    run->turn.Execute = moves && run->deed != DEED_HOME;
    MC_MoveVelocity(&run->turn);
    run->home.Execute = moves && run->deed == DEED_HOME;
    MC_Home(&run->home);
    run->stop.Execute = run->deed == DEED_STOP && run->late_cycles > 5;
    MC_Stop(&run->stop);
    run->halt.Execute = run->deed == DEED_HALT && run->late_cycles > 5;
    MC_Halt(&run->halt);
    if (run->cycles < run->late_at)
        return;
    run->late_cycles++;
    cm1e_clock_sleep_until(clock, cm1e_clock_now(clock) + run->late_ms * MS + MS / 2);
    if (run->late_cycles * (run->late_ms + 1) >= run->enough_ms)
        cm1e_scheduler_stop(run->machine.scheduler);
}

static run_t run_late(run_t run)
{
    machine_open(&run.machine);
    AXIS_REF_t *axis = &run.machine.axis[0];
    run.power = (MC_Power_t){.Axis = axis, .EnablePositive = TRUE, .EnableNegative = TRUE};
    run.turn = (MC_MoveVelocity_t){.Axis = axis, .Velocity = velocity, .Acceleration = acceleration};
    run.stop = (MC_Stop_t){.Axis = axis};
    run.halt = (MC_Halt_t){.Axis = axis};
    run.home = (MC_Home_t){.Axis = axis};
    machine_add(&run.machine, "turn", 0, 0, run.program, &run);
    machine_run(&run.machine, run.program == program ? 0 : 700 * MS);
    machine_close(&run.machine);
    return run;
}

static void is_late(cm1e_mapping_t mapping, deed_t deed, int late_at, int late_ms)
{
    const run_t run = run_late((run_t){.machine = {.axis_count = 1, .mapping = mapping}, .program = program,
                                       .deed = deed, .late_at = late_at, .late_ms = late_ms,
                                       .enough_ms = ENOUGH_MS});
    ck_assert_msg(!run.probe.torque_on && (run.told || deed == DEED_POWER_OFF),
                  "mapping %d, deed %d, from cycle %d on by %d ms: torque %d, told %d", mapping, deed, late_at, late_ms,
                  run.probe.torque_on, run.told);
}

START_TEST(test_where_every_cycle_is_late_no_axis_keeps_its_torque)
{
    static const cm1e_mapping_t mappings[] = {CM1E_MAPPING_DYNAMIC, CM1E_MAPPING_CSV};
    for (int m = 0; m < 2; m++)
        for (int late_ms = 1; late_ms <= 4; late_ms++) {
            for (deed_t deed = DEED_NONE; deed < DEEDS; deed++)
                is_late(mappings[m], deed, LATE_AT, late_ms);
            for (int at = 2; at < 25; at++)
                is_late(mappings[m], DEED_NONE, at, late_ms);
        }
}
END_TEST

static run_t turn_late(int at, int late_ms)
{
    return run_late((run_t){.machine = {.axis_count = 1, .mapping = CM1E_MAPPING_CSV}, .program = program,
                            .late_at = at, .late_ms = late_ms, .enough_ms = SETTLED_MS});
}

static void goes_on(int at, int late_ms)
{
    const run_t run = turn_late(at, late_ms);
    const double speed = run.probe.velocity_counts_per_s / COUNTS;
    const double lag = run.lag + velocity * 1e-3; /* the next set-point is where the motor is now */
    ck_assert_msg(fabs(speed - velocity) <= 0.01 * velocity && fabs(lag) <= 3 / COUNTS,
                  "from cycle %d on by %d ms: %g u/s, lag %g u", at, late_ms, speed, lag);
}

/** At the end of a ramp the motor is not where its set-point is. */
START_TEST(test_the_position_loop_of_csv_goes_on_in_late_cycles)
{
    static const int late_ms[] = {3, 4, 5, 9, 13};
    for (size_t i = 0; i < sizeof late_ms / sizeof late_ms[0]; i++)
        for (int at = IN_VELOCITY_AT - 10; at < IN_VELOCITY_AT + 10; at++)
            goes_on(at, late_ms[i]);
}
END_TEST

/** The set-point stands then, and the position loop brakes the motor until it is about v / 20 beyond. */
START_TEST(test_where_each_cycle_misses_one_or_two_a_motor_in_csv_comes_to_rest)
{
    for (int late_ms = 1; late_ms <= 2; late_ms++)
        for (int at = IN_VELOCITY_AT - 10; at < IN_VELOCITY_AT + 10; at++) {
            const run_t run = turn_late(at, late_ms);
            ck_assert_msg(fabs(run.probe.velocity_counts_per_s) < 10 && run.lag < 0.0 && run.lag >= -1.1 * velocity / 20,
                          "from cycle %d on by %d ms: %g counts/s, lag %g u", at, late_ms,
                          run.probe.velocity_counts_per_s, run.lag);
        }
}
END_TEST

static void stops(deed_t deed, int at, int late_ms)
{
    const run_t run = run_late((run_t){
        .machine = {.axis_count = 1, .mapping = CM1E_MAPPING_CSV, .max_jerk = 2000}, .program = program, .deed = deed,
        .late_at = at, .late_ms = late_ms, .enough_ms = RAMP_MS * (late_ms + 1) + SETTLED_MS});
    const double speed = run.probe.velocity_counts_per_s;
    ck_assert_msg(run.set_velocity == 0.0 && fabs(speed) < 10 && fabs(run.lag) <= 3 / COUNTS && !run.told,
                  "deed %d, from cycle %d on by %d ms: set velocity %g u/s, %g counts/s, lag %g u, told %d", (int)deed,
                  at, late_ms, run.set_velocity, speed, run.lag, run.told);
}

/** The ramp, with its limit of jerk, goes on by a cycle in each: it takes as many times longer. */
START_TEST(test_a_stop_in_csv_ends_also_where_each_cycle_misses_more)
{
    static const int late_ms[] = {3, 4, 5};
    static const deed_t deeds[] = {DEED_STOP, DEED_HALT, DEED_POWER_OFF};
    for (size_t i = 0; i < sizeof late_ms / sizeof late_ms[0]; i++)
        for (size_t d = 0; d < sizeof deeds / sizeof deeds[0]; d++)
            for (int at = IN_VELOCITY_AT - 3; at < IN_VELOCITY_AT + 3; at++)
                stops(deeds[d], at, late_ms[i]);
}
END_TEST

/** Every tenth cycle takes too long. u: by how much the set-point has left v * t until now. */
static void pause_now_and_then(void *context)
{
    run_t *run = context;
    cm1e_clock_t *clock = cm1e_bus_clock(run->machine.bus);
    run->cycles++;
    run->power.Enable = run->cycles >= ENABLED_AT;
    MC_Power(&run->power);
    run->turn.Execute = run->power.Status && run->cycles >= MOVED_AT;
    MC_MoveVelocity(&run->turn);
    if ((run->late_cycles == 0 && !run->turn.InVelocity) || run->cycles % 10 != 0)
        return;
    cm1e_axis_info_t info = {0};
    cm1e_axis_read(run->machine.axis[0], &info);
    const double ahead = info.set_position - velocity * (double)cm1e_clock_now(clock) * 1e-9;
    if (run->late_cycles++ == 0)
        run->ahead = ahead;
    run->left = fmax(run->left, fabs(ahead - run->ahead));
    cm1e_clock_sleep_until(clock, cm1e_clock_now(clock) + run->pause_ns);
}

/** Also where it ends just when a cycle begins: in that cycle the late frame is sent, and no second one. */
START_TEST(test_a_pause_of_csv_that_ends_anywhere_in_a_cycle_shifts_the_set_point_by_whole_cycles)
{
    static const int64_t percent[] = {301, 350, 400, 499, 500, 501, 590, 700, 1200, 2999, 3000};
    static const int64_t cycles_ns[] = {250 * MS / 1000, MS};
    for (size_t c = 0; c < sizeof cycles_ns / sizeof cycles_ns[0]; c++)
        for (size_t p = 0; p < sizeof percent / sizeof percent[0]; p++) {
            const run_t run = run_late((run_t){.machine = {.axis_count = 1, .mapping = CM1E_MAPPING_CSV,
                                                           .cycle_time_ns = cycles_ns[c]},
                                               .pause_ns = percent[p] * cycles_ns[c] / 100,
                                               .program = pause_now_and_then});
            ck_assert_int_gt(run.late_cycles, 5);
            ck_assert_msg(run.left < 1e-6, "%d %% of %d us: the set-point has left its course by %g u", (int)percent[p],
                          (int)(cycles_ns[c] / 1000), run.left);
        }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("cycles that are late for ever");
    TCase *cases = tcase_create("late");
    tcase_set_timeout(cases, 60);
    tcase_add_test(cases, test_the_position_loop_of_csv_goes_on_in_late_cycles);
    tcase_add_test(cases, test_where_each_cycle_misses_one_or_two_a_motor_in_csv_comes_to_rest);
    tcase_add_test(cases, test_a_stop_in_csv_ends_also_where_each_cycle_misses_more);
    tcase_add_test(cases, test_a_pause_of_csv_that_ends_anywhere_in_a_cycle_shifts_the_set_point_by_whole_cycles);
    tcase_add_test(cases, test_where_every_cycle_is_late_no_axis_keeps_its_torque);
    suite_add_tcase(suite, cases);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
