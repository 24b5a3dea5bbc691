/**
 * Chains of slaves (PLCopen Part 1 v2.0, chapter 4): a slave that is another's master, broken at each of its links,
 * with blocks and axes in any order; and no axis follows itself, also not by way of others.
 */

#include "quick_check.h"
#include "slave_bench.h"

static instance_t mover, other, more[8];

/* ---- chains ------------------------------------------------------------------------------------------------------ */

/** Axis 0 follows 1, which follows 2, which turns. */
static void begin_chain(void)
{
    slaves_begin(3);
    turn(2, 4);
    make_and_start(1, 2, &more[1], "MC_GearIn");
    make_and_start(0, 1, &more[0], "MC_GearIn");
    CYCLE_UNTIL(more[0].now.reached && more[1].now.reached);
}

START_TEST(test_chain_ends_where_it_is_broken)
{
    static const struct {
        const char *what;
        bool first_goes_on; /**< axis 0 still follows axis 1 */
        cm1e_axis_state_t middle;
    } breaks[] = {
        {"MC_MoveVelocity", true, CM1E_AXIS_CONTINUOUS_MOTION}, {"MC_MoveAbsolute", true, CM1E_AXIS_DISCRETE_MOTION},
        {"MC_Halt", true, CM1E_AXIS_DISCRETE_MOTION},           {"MC_GearOut", true, CM1E_AXIS_CONTINUOUS_MOTION},
        {"MC_Stop", true, CM1E_AXIS_STOPPING},                  {"power", false, CM1E_AXIS_DISABLED},
        {"fault", false, CM1E_AXIS_ERROR_STOP},                 {"master's fault", false, CM1E_AXIS_ERROR_STOP},
    };
    const bool power = strcmp(breaks[_i].what, "power") == 0;
    snprintf(judged_axes[0].scene, sizeof judged_axes[0].scene, "chain, broken by %s", breaks[_i].what);
    begin_chain();
    if (strstr(breaks[_i].what, "fault"))
        fake_bus_fault(axes_motor(strstr(breaks[_i].what, "master") ? 2 : 1), 0x2310);
    else if (power)
        axes_power(1, false);
    else
        make_and_start(1, -1, &other, breaks[_i].what);
    cycles(3);
    MUST(axes_state(1) == breaks[_i].middle, "the middle is in %s: %s", cm1e_axis_state_name(axes_state(1)),
         axes_text(1));
    MUST(breaks[_i].middle == CM1E_AXIS_ERROR_STOP ? more[1].now.error : more[1].now.aborted,
         "the middle: CommandAborted %d, Error 0x%04X", more[1].now.aborted, more[1].now.error_id);
    for (int n = 0; n < 2000; n++) {
        cycle();
        if (!breaks[_i].first_goes_on)
            continue;
        MUST(more[0].now.busy && more[0].now.reached, "the first: Busy %d, InGear %d, Error 0x%04X: %s",
             more[0].now.busy, more[0].now.reached, more[0].now.error_id, axes_text(0));
        MUST(fabs(axes_info(0).set_velocity - axes_info(1).set_velocity / 2) < 1e-9, "it is not in gear");
    }
    if (!breaks[_i].first_goes_on)
        MUST(more[0].now.error && axes_state(0) == CM1E_AXIS_ERROR_STOP && axes_info(0).set_velocity == 0.0,
             "the first: Busy %d, Error 0x%04X, in %s", more[0].now.busy, more[0].now.error_id,
             cm1e_axis_state_name(axes_state(0)));
    MUST(axes_state(2) == CM1E_AXIS_CONTINUOUS_MOTION || strstr(breaks[_i].what, "master"), "the master is disturbed");
}
END_TEST
enum { BREAKS = 8 };

/* ---- order of calls ---------------------------------------------------------------------------------------------- */

enum { RECORDED = 1500, CHAIN = 4 };
static int64_t recorded[ORDERS][CHAIN][RECORDED];

/** A chain of four that begins, turns round, changes its ratio, and comes apart, all at given cycles. */
static void record_chain(call_order_t order, bool axes_backwards)
{
    slaves_begin(CHAIN);
    for (int n = 0; n < CHAIN; n++)
        axes_bench.order[n] = axes_backwards ? CHAIN - 1 - n : n;
    call_order = order;
    for (int n = 0; n < CHAIN - 1; n++)
        made_about(n, n + 1, &more[n], "MC_GearIn");
    made_about(CHAIN - 1, -1, &mover, "MC_MoveVelocity");
    for (int i = 0; i < called_count; i++) { /* who follows goes by up to 27/8 of it */
        put(called[i], "Acceleration", 10);
        put(called[i], "Deceleration", 10);
        put(called[i], "Jerk", 200);
    }
    made_about(1, -1, &other, "MC_GearOut");
    for (int cycle_now = 0; cycle_now < RECORDED; cycle_now++) {
        trigger(&mover, cycle_now % 400 < 390);
        put(&mover, "Velocity", cycle_now < 400 ? 3 : -3);
        for (int n = 0; n < CHAIN - 1; n++) {
            trigger(&more[n], cycle_now % 700 < 690);
            put(&more[n], "RatioNumerator", cycle_now < 700 ? 1 : 3);
        }
        trigger(&other, cycle_now == 1200);
        cycle();
        for (int n = 0; n < CHAIN; n++)
            recorded[order][n][cycle_now] = axes_axis(n)->setpoint.position.counts;
    }
}

START_TEST(test_order_of_calls_and_of_axes_does_not_matter)
{
    snprintf(judged_axes[0].scene, sizeof judged_axes[0].scene, "order of calls");
    record_chain(ORDER_MADE, false);
    for (int order = ORDER_BACKWARDS; order < ORDERS; order++) {
        record_chain((call_order_t)order, order == ORDER_MIXED);
        for (int n = 0; n < CHAIN; n++)
            for (int i = 0; i < RECORDED; i++)
                MUST(recorded[order][n][i] == recorded[0][n][i], "order %d: axis %d is elsewhere in cycle %d", order,
                     n, i);
    }
    for (int n = 0; n < CHAIN; n++)
        MUST(recorded[0][n][1400] != recorded[0][n][1300], "axis %d has not moved: %s", n, axes_text(n));
}
END_TEST

/* ---- circles ----------------------------------------------------------------------------------------------------- */

START_TEST(test_nobody_follows_itself)
{
    static const char *const names[] = {"MC_GearIn", "MC_CombineAxes", "MC_CamIn", "MC_GearInPos"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        snprintf(judged_axes[0].scene, sizeof judged_axes[0].scene, "%s in a circle", names[i]);
        slaves_begin(4);
        make_and_start(0, 0, &other, names[i]);
        expect_error(&other, CM1E_ERROR_AXIS_COUPLING_CYCLE);
        make_and_start(0, 1, &more[0], "MC_GearIn");
        make_and_start(1, 2, &more[1], "MC_GearIn");
        make_and_start(1, 0, &more[2], names[i]);
        expect_error(&more[2], CM1E_ERROR_AXIS_COUPLING_CYCLE);
        make_and_start(2, 0, &more[3], names[i]);
        expect_error(&more[3], CM1E_ERROR_AXIS_COUPLING_CYCLE);
        cycles(5);
        MUST(more[0].now.reached && more[1].now.reached, "who is in gear is disturbed");
        MUST(axes_state(2) == CM1E_AXIS_STANDSTILL, "the last is in %s", cm1e_axis_state_name(axes_state(2)));
        made_about(2, 3, &more[4], "MC_CombineAxes"); /* by way of its second master */
        point_at(&more[4], "Master2", &judged_axes[0].reference);
        trigger(&more[4], true);
        cycle();
        expect_error(&more[4], CM1E_ERROR_AXIS_COUPLING_CYCLE);
        make_and_start(2, 3, &more[5], names[i]); /* no circle */
        MUST(more[5].now.busy, "Error 0x%04X", more[5].now.error_id);
        cycles(50);
    }
}
END_TEST

/** A circle that closes only when what waits begins: one of them ends with the error, nothing hangs. */
START_TEST(test_circle_of_waiting_commands_ends_with_an_error)
{
    snprintf(judged_axes[0].scene, sizeof judged_axes[0].scene, "a circle of commands that wait");
    slaves_begin(2);
    for (int n = 0; n < 2; n++) {
        make_and_start(n, -1, &more[n], "MC_MoveAbsolute");
        made_about(n, 1 - n, &more[2 + n], "MC_GearIn");
        put(&more[2 + n], "BufferMode", mcBuffered);
        trigger(&more[2 + n], true);
        cycle();
    }
    cycles(2000);
    MUST(more[2].now.error + more[3].now.error == 1, "Error 0x%04X, 0x%04X", more[2].now.error_id,
         more[3].now.error_id);
    const instance_t *refused = more[2].now.error ? &more[2] : &more[3];
    expect_error(refused, CM1E_ERROR_AXIS_COUPLING_CYCLE);
    MUST(axes_state(0) != CM1E_AXIS_ERROR_STOP && axes_state(1) != CM1E_AXIS_ERROR_STOP, "ErrorStop");
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("conformance: chains");
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 60);
    tcase_add_loop_test(all, test_chain_ends_where_it_is_broken, 0, BREAKS);
    tcase_add_test(all, test_order_of_calls_and_of_axes_does_not_matter);
    tcase_add_test(all, test_nobody_follows_itself);
    tcase_add_test(all, test_circle_of_waiting_commands_ends_with_an_error);
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
