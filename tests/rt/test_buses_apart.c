/**
 * Each of several buses starts, fails and comes back without the others: a fault of one, in every cycle of enabling
 * and of a move, leaves the motion of the other as it was, to the count; the bus that failed is reset and moves again
 * while the other one never stops. And the orders in which a program may open, start and close them.
 */
#include <math.h>
#include <stdlib.h>

#include "cm1e/sim.h"
#include "effort.h"
#include "two_buses.h"

enum { FAULT_FIRST = 2, FAULT_LAST = 420, MEND_AFTER = 260, END = 2600, STRIDE = 3, SAMPLED_STRIDE = 97 };

static const struct {
    const char *breaks, *mends; /**< NULL: it mends itself */
} faults[] = {
    {"lose 40", NULL}, {"unplug 1", "replug 1"}, {"power-cycle 1 100", NULL}, {"corrupt 40", NULL},
    {"error 1 2310", NULL},
};
enum { FAULTS = sizeof faults / sizeof faults[0] };

static MC_Power_t powers[BUSES];
static MC_MoveAbsolute_t go[BUSES], back;
static MC_Reset_t reset;

static struct {
    int cycle, fault, fault_at, failing; /**< fault -1: none; failing: the bus that has it */
    bool was_reset;
    double path[END + 2];                /**< set positions of the other axis, without a fault */
} run;

static cm1e_bus_t *open_bus(const char *name)
{
    cm1e_bus_config_t config;
    cm1e_bus_t *bus;
    cm1e_bus_config_init(&config, "sim", 1);
    snprintf(config.axes[0].name, sizeof config.axes[0].name, "%s", name);
    config.axes[0].sim.no_stops = true;
    config.virtual_time = true;
    must(cm1e_bus_open(&bus, &config, &diag));
    cm1e_bus_config_free(&config);
    return bus;
}

/* ---- one fails, the other goes on -------------------------------------------------------------------------------- */

/** The axis of the failing bus is reset as long as it is in ErrorStop, then it is enabled and moved again. */
static void recover(int i)
{
    const bool down = see(i).state == CM1E_AXIS_ERROR_STOP;
    if (run.fault >= 0 && run.cycle == run.fault_at + MEND_AFTER && faults[run.fault].mends)
        simulate(i, faults[run.fault].mends);
    reset.Execute = down && run.cycle > run.fault_at + MEND_AFTER && !reset.Error;
    MC_Reset(&reset);
    run.was_reset |= reset.Done;
    powers[i].Enable = !down;
    back.Execute = powers[i].Status && run.cycle > END - 900;
    MC_MoveAbsolute(&back);
}

static void judge_other(int i)
{
    const double at = see(i).set_position;
    if (run.fault < 0)
        run.path[run.cycle] = at;
    else
        ck_assert_msg(at == run.path[run.cycle], "the other axis is at %.9f in cycle %d, without the fault at %.9f", at,
                      run.cycle, run.path[run.cycle]);
}

static void program(void *context)
{
    (void)context;
    run.cycle++;
    if (run.cycle == END)
        return;
    if (run.fault >= 0 && run.cycle == run.fault_at)
        simulate(run.failing, faults[run.fault].breaks);
    for (int i = 0; i < BUSES; i++) {
        powers[i].Enable = TRUE;
        go[i].Execute = powers[i].Status;
    }
    recover(run.failing);
    for (int i = 0; i < BUSES; i++) {
        MC_Power(&powers[i]);
        MC_MoveAbsolute(&go[i]);
    }
    if (run.cycle < END - 900) /* the moves back are compared by their ends */
        judge_other(1 - run.failing);
}

static void run_once(void)
{
    run.cycle = 0;
    run.was_reset = false;
    buses[A] = open_bus("left");
    buses[B] = open_bus("right");
    for (int i = 0; i < BUSES; i++)
        must(cm1e_bus_start(buses[i], &diag));
    open_scheduler();
    for (int i = 0; i < BUSES; i++) {
        powers[i] = (MC_Power_t){.Axis = &axes[i], .EnablePositive = TRUE, .EnableNegative = TRUE};
        go[i] = (MC_MoveAbsolute_t){.Axis = &axes[i], .Position = 6, .Velocity = 5};
    }
    reset = (MC_Reset_t){.Axis = &axes[run.failing]};
    back = (MC_MoveAbsolute_t){.Axis = &axes[run.failing], .Position = 1, .Velocity = 10};
    must(cm1e_scheduler_add_task(scheduler, &(cm1e_task_config_t){.program = program}, &diag));
    must(cm1e_scheduler_run(scheduler, END * MS_IN_NS, &diag));
    const cm1e_bus_counters_t *other = cm1e_bus_counters(buses[1 - run.failing]);
    ck_assert_msg(other->lost_frames == 0 && other->working_counter_errors == 0 && other->cycles >= END,
                  "the other bus lost %llu frames", (unsigned long long)other->lost_frames);
    ck_assert(go[1 - run.failing].Done && !go[1 - run.failing].Error);
    if (run.fault >= 0)
        ck_assert_msg(run.was_reset && back.Done, "%s at cycle %d: the axis does not move again (%s)",
                      faults[run.fault].breaks, run.fault_at, diag.text);
    cm1e_scheduler_destroy(scheduler);
    for (int i = 0; i < BUSES; i++)
        cm1e_bus_close(buses[(i + run.fault_at) % BUSES]); /* in any order */
}

START_TEST(test_a_bus_fails_and_comes_back_beside_one_that_does_not_notice)
{
    run.failing = _i / FAULTS;
    run.fault = -1;
    run.fault_at = 0;
    run_once();
    run.fault = _i % FAULTS;
    const int stride = sweep_stride(STRIDE, SAMPLED_STRIDE);
    for (run.fault_at = FAULT_FIRST + sweep_first(7 * _i, stride); run.fault_at < FAULT_LAST; run.fault_at += stride)
        run_once();
}
END_TEST

/* ---- orders of calls --------------------------------------------------------------------------------------------- */

static void do_nothing(void *context) { (void)context; }

static void run_shortly(void)
{
    must(cm1e_scheduler_add_task(scheduler, &(cm1e_task_config_t){.program = do_nothing}, &diag));
    must(cm1e_scheduler_run(scheduler, 50 * MS_IN_NS, &diag));
    cm1e_scheduler_destroy(scheduler);
    for (int i = 0; i < BUSES; i++) {
        ck_assert_uint_eq(cm1e_bus_counters(buses[i])->lost_frames, 0);
        ck_assert_uint_eq(cm1e_bus_counters(buses[i])->working_counter_errors, 0);
    }
}

START_TEST(test_a_bus_is_added_late_and_after_its_start_has_failed)
{
    buses[A] = open_bus("left");
    must(cm1e_bus_start(buses[A], &diag));
    must(cm1e_scheduler_create(&scheduler, buses[A], NULL, &diag));
    buses[B] = open_bus("right");
    simulate(B, "unplug 1");
    ck_assert(cm1e_bus_start(buses[B], &diag) != CM1E_OK);
    ck_assert_int_eq(cm1e_scheduler_add_bus(scheduler, buses[B], &diag), CM1E_ERROR_STATE);
    simulate(B, "replug 1");
    must(cm1e_bus_start(buses[B], &diag));
    must(cm1e_scheduler_add_bus(scheduler, buses[B], &diag));
    run_shortly();
    for (int i = BUSES - 1; i >= 0; i--)
        cm1e_bus_close(buses[i]);
}
END_TEST

START_TEST(test_a_bus_that_cannot_start_leaves_the_other_one_alone)
{
    buses[A] = open_bus("left");
    buses[B] = open_bus("right");
    must(cm1e_bus_start(buses[A], &diag));
    simulate(B, "unplug 1");
    ck_assert(cm1e_bus_start(buses[B], &diag) != CM1E_OK);
    cm1e_bus_close(buses[B]);
    must(cm1e_scheduler_create(&scheduler, buses[A], NULL, &diag));
    must(cm1e_scheduler_run(scheduler, 50 * MS_IN_NS, &diag));
    ck_assert_uint_eq(cm1e_bus_counters(buses[A])->lost_frames, 0);
    cm1e_scheduler_destroy(scheduler);
    cm1e_bus_close(buses[A]);
}
END_TEST

START_TEST(test_both_run_again_in_the_other_order)
{
    buses[A] = open_bus("left");
    buses[B] = open_bus("right");
    for (int round = 0; round < 3; round++) {
        for (int i = 0; i < BUSES; i++)
            must(cm1e_bus_start(buses[(i + round) % BUSES], &diag));
        must(cm1e_scheduler_create(&scheduler, buses[round % BUSES], NULL, &diag));
        must(cm1e_scheduler_add_bus(scheduler, buses[(round + 1) % BUSES], &diag));
        run_shortly();
    }
    for (int i = 0; i < BUSES; i++)
        cm1e_bus_close(buses[i]);
}
END_TEST

START_TEST(test_a_bus_that_was_stopped_since_is_refused_by_its_name)
{
    buses[A] = open_bus("left");
    buses[B] = open_bus("right");
    for (int i = 0; i < BUSES; i++)
        must(cm1e_bus_start(buses[i], &diag));
    open_scheduler();
    cm1e_bus_stop(buses[B]);
    ck_assert_int_eq(cm1e_scheduler_run(scheduler, 50 * MS_IN_NS, &diag), CM1E_ERROR_STATE);
    close_all();
}
END_TEST

int main(void)
{
    TCase *all = tcase_create("buses");
    tcase_set_timeout(all, 300);
    tcase_add_loop_test(all, test_a_bus_fails_and_comes_back_beside_one_that_does_not_notice, 0, BUSES * FAULTS);
    tcase_add_test(all, test_a_bus_is_added_late_and_after_its_start_has_failed);
    tcase_add_test(all, test_a_bus_that_cannot_start_leaves_the_other_one_alone);
    tcase_add_test(all, test_both_run_again_in_the_other_order);
    tcase_add_test(all, test_a_bus_that_was_stopped_since_is_refused_by_its_name);
    Suite *suite = suite_create("each bus apart");
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
