/**
 * Every moving block after every other one, in every buffer mode and in several phases of the first (PLCopen Part 1
 * v2.0, 2.4.1, 2.4.2, table 4): who is Busy, who is Active, how the first ends, when the second begins, and that
 * nothing exceeds a limit on the way. Then the queue: its order, its depth, and how all of it ends.
 */
#include "block_bench.h"
#include "effort.h"

static const char *const movers[] = {
    "MC_MoveAbsolute", "MC_MoveRelative", "MC_MoveAdditive", "MC_MoveVelocity", "MC_MoveContinuousAbsolute",
    "MC_MoveContinuousRelative", "MC_PositionProfile", "MC_VelocityProfile", "MC_AccelerationProfile", "MC_Halt",
    "MC_Stop", "MC_Home", "MC_GearIn", "MC_CombineAxes", "MC_CamIn",
    "MC_GearInPos"};
enum { MOVERS = sizeof movers / sizeof movers[0] };
static const int phases[] = {1, 2, 40, 200};
enum { PHASES = sizeof phases / sizeof phases[0] };

static instance_t first, second, fbs[CM1E_AXIS_BUFFER_DEPTH + 4];

static bool is(const instance_t *fb, const char *name) { return strcmp(name_of(fb), name) == 0; }
static bool is_endless_block(const instance_t *fb) { return fb->view->reached != NOWHERE; }
static bool is_one_step(const instance_t *fb)
{
    return is(fb, "MC_MoveAbsolute") || is(fb, "MC_MoveRelative") || is(fb, "MC_MoveAdditive");
}

/** Where a move ends that begins at `from`. */
static double end_of_move(const instance_t *fb, double from)
{
    return is(fb, "MC_MoveAbsolute") ? real_of(fb, "Position") : from + real_of(fb, "Distance");
}

static void check_only_one_active(void)
{
    MUST(!(first.now.active && second.now.active), "both are Active");
}

static void run_to_its_end(instance_t *fb)
{
    for (int n = 0; n < 8000 && fb->now.busy; n++) {
        cycle();
        check_only_one_active();
        if (is_endless_block(fb) && fb->now.reached)
            return;
    }
    MUST(fb->now.done || is(fb, "MC_Stop"), "%s did not end: Busy %d, Error 0x%04X", name_of(fb), fb->now.busy,
         fb->now.error_id);
}

/* ---- mcAborting -------------------------------------------------------------------------------------------------- */

static void check_aborting(void)
{
    const cm1e_axis_state_t state = judged.state;
    const block_rule_t *rule = &second.view->type->rules[state];
    const double from = bench.info.set_position;
    const bool first_moves = first.now.busy, held = is(&first, "MC_Stop");
    trigger(&second, true);
    cycle();
    if (rule->refusal != CM1E_OK || held) {
        const cm1e_error_t refusal = rule->refusal != CM1E_OK ? rule->refusal : CM1E_ERROR_AXIS_STOPPING;
        MUST(second.now.error_id == cm1e_error_id(refusal), "ErrorID 0x%04X", second.now.error_id);
        cycle();
        MUST(!first.now.aborted && !first.now.error, "the first is disturbed");
        return;
    }
    MUST(second.now.busy && second.now.active, "Busy %d, Active %d, Error 0x%04X", second.now.busy, second.now.active,
         second.now.error_id);
    cycle();
    MUST(!first_moves || first.now.aborted || first.now.done, "the first is not aborted: Busy %d", first.now.busy);
    run_to_its_end(&second);
    if (is_one_step(&second) && !is(&second, "MC_MoveAdditive"))
        MUST(fabs(bench.info.set_position - end_of_move(&second, from)) < 1e-6, "ends at %.9g",
             bench.info.set_position);
}

/* ---- the others -------------------------------------------------------------------------------------------------- */

/** Table 4: what the second waits for has come. */
static bool first_is_through(void)
{
    return !first.now.busy || (first.now.reached && !is(&first, "MC_CamIn")); /* that one waits for EndOfProfile */
}

static void check_hand_over(int mode, double velocity)
{
    MUST(!first.now.error, "the first ends with Error 0x%04X", first.now.error_id);
    MUST(is_endless_block(&first) ? first.now.aborted : first.now.done,
         "the first ends with Done %d, CommandAborted %d", first.now.done, first.now.aborted);
    MUST(second.now.active || second.now.done, "the second does not begin: Busy %d, Active %d, Error 0x%04X",
         second.now.busy, second.now.active, second.now.error_id);
    const bool one_way = is_one_step(&first) && is_one_step(&second) && !is(&second, "MC_MoveAbsolute");
    if (one_way && mode > mcBuffered)
        MUST(fabs(velocity) > 1.0, "blended with the velocity %g", velocity);
    if (one_way && mode == mcBuffered)
        MUST(fabs(velocity) < 0.2, "buffered with the velocity %g", velocity);
}

static void check_waiting(int mode)
{
    const bool second_homes = is(&second, "MC_Home");
    trigger(&second, true);
    cycle();
    if (is(&first, "MC_Stop")) {
        MUST(second.now.error_id == cm1e_error_id(CM1E_ERROR_AXIS_STOPPING), "ErrorID 0x%04X", second.now.error_id);
        return;
    }
    if (second_homes && is_endless_block(&first)) { /* it begins at rest, and the first never comes to it */
        MUST(second.now.error && first.now.busy, "Error %d, the first is Busy: %d", second.now.error, first.now.busy);
        return;
    }
    MUST(second.now.busy, "not Busy, Error 0x%04X", second.now.error_id);
    double velocity = bench.info.set_velocity;
    if (second.now.active) { /* what it was to wait for came in this very cycle */
        cycle();
        MUST(!first.now.busy, "the second is Active before its time");
    }
    for (int n = 0; n < 8000 && first.now.busy; n++) {
        MUST(first.now.active || !first.now.busy, "the first is no longer Active");
        MUST(!second.now.active, "the second is Active before its time");
        velocity = bench.info.set_velocity;
        cycle();
        check_only_one_active();
    }
    MUST(!first.now.busy, "the first does not end");
    check_hand_over(mode, fmin(fabs(velocity), fabs(bench.info.set_velocity)));
    run_to_its_end(&second);
    if (is_one_step(&first) && is_one_step(&second)) {
        const double end = end_of_move(&second, end_of_move(&first, 0));
        MUST(fabs(bench.info.set_position - end) < 1e-6, "ends at %.9g, %.9g is right", bench.info.set_position, end);
    }
}

/** The times of a table are its own. */
static void check_no_blending(void)
{
    const bool held = is(&first, "MC_Stop");
    trigger(&second, true);
    cycle();
    MUST(second.now.error_id == cm1e_error_id(held ? CM1E_ERROR_AXIS_STOPPING : CM1E_ERROR_AXIS_BUFFER_MODE),
         "ErrorID 0x%04X", second.now.error_id);
}

static void pair(const char *a, const char *b, int mode, int phase)
{
    snprintf(judged.scene, sizeof judged.scene, "%s after %s, mode %d, %d cycles later", b, a, mode, phase);
    into(CM1E_AXIS_STANDSTILL, &first);
    make(&first, a);
    trigger(&first, true);
    cycles(phase);
    make(&second, b);
    if (mode != mcAborting && second.view->buffer_mode == NOWHERE)
        return;
    put(&second, "BufferMode", mode);
    if (mode != mcAborting && is(&first, "MC_GearInPos"))
        put_out_of_reach_of_another(&second);
    if (mode > mcBuffered && strstr(b, "Profile") && judged.axis->commands.active)
        check_no_blending();
    else if (mode == mcAborting || first_is_through())
        check_aborting();
    else
        check_waiting(mode);
}

START_TEST(test_every_pair_in_every_buffer_mode)
{
    const int stride = sweep_stride(1, PHASES); /* a sample: each pair in each mode, in one phase of the first */
    for (int a = 0; a < MOVERS; a++)
        for (int mode = mcAborting; mode <= mcBlendingHigh; mode++)
            for (int phase = (a + _i + mode) % stride; phase < PHASES; phase += stride)
                pair(movers[a], movers[_i], mode, phases[phase]);
}
END_TEST

/* ---- triggered again --------------------------------------------------------------------------------------------- */

/** 2.4.1: nothing of the first command is shown any more, and the new inputs act. */
START_TEST(test_edge_on_a_busy_block_shows_nothing_of_the_first_command)
{
    for (int a = 0; a < MOVERS; a++) {
        snprintf(judged.scene, sizeof judged.scene, "%s again", movers[a]);
        into(CM1E_AXIS_STANDSTILL, &second);
        make(&first, movers[a]);
        trigger(&first, true);
        cycles(10);
        if (!first.now.busy)
            continue;
        trigger(&first, false);
        cycle();
        MUST(first.now.busy, "the falling edge ended it");
        trigger(&first, true);
        cycle();
        const block_rule_t *rule = &first.view->type->rules[judged.state];
        if (rule->refusal != CM1E_OK) { /* refused: the motion goes on, this block shows the error */
            MUST(first.now.error && judged.axis->commands.active, "Error %d", first.now.error);
            continue;
        }
        for (int n = 0; n < 5; n++, cycle())
            MUST(!first.now.aborted && !first.now.error && first.now.busy + first.now.done == 1, "it shows an end");
    }
}
END_TEST

/* ---- the queue --------------------------------------------------------------------------------------------------- */

/** `count` moves by 0.5 u, one behind the other. */
static void make_queue(int count, int mode)
{
    into(CM1E_AXIS_STANDSTILL, &first);
    for (int i = 0; i < count; i++) {
        make(&fbs[i], "MC_MoveRelative");
        put(&fbs[i], "Distance", 0.5);
        put(&fbs[i], "BufferMode", mode);
        trigger(&fbs[i], true);
    }
    cycle();
}

START_TEST(test_queue_keeps_its_order_and_refuses_what_is_too_much)
{
    enum { TAKEN = CM1E_AXIS_BUFFER_DEPTH + 1 };
    for (int mode = mcBuffered; mode <= mcBlendingHigh; mode++) {
        snprintf(judged.scene, sizeof judged.scene, "queue, mode %d", mode);
        make_queue(TAKEN + 1, mode);
        MUST(fbs[TAKEN].now.error_id == cm1e_error_id(CM1E_ERROR_FULL), "ErrorID 0x%04X", fbs[TAKEN].now.error_id);
        for (int at = 0; at < TAKEN;) {
            for (int i = 0; i < TAKEN; i++)
                MUST(fbs[i].now.done == (i < at) && fbs[i].now.active == (i == at) && fbs[i].now.busy == (i >= at),
                     "%d of %d: Done %d, Active %d, Busy %d", i, at, fbs[i].now.done, fbs[i].now.active,
                     fbs[i].now.busy);
            cycle();
            at += fbs[at].now.done;
        }
        MUST(fabs(bench.info.set_position - 0.5 * TAKEN) < 1e-6, "ends at %.9g", bench.info.set_position);
        MUST(judged.state == CM1E_AXIS_STANDSTILL, "%s", cm1e_axis_state_name(judged.state));
    }
}
END_TEST

typedef enum end { END_ABORT = 0, END_HALT, END_STOP, END_POWER, END_FAULT, END_DIRECTION, ENDS } end_t;

static void strike(end_t end)
{
    static const char *const names[] = {"MC_MoveVelocity", "MC_Halt", "MC_Stop"};
    if (end <= END_STOP) {
        make(&second, names[end]);
        trigger(&second, true);
    } else if (end == END_POWER) {
        bench.power.Enable = FALSE;
    } else if (end == END_FAULT) {
        fake_bus_fault(&bench.bus, 0x2310);
    } else {
        bench.power.EnablePositive = FALSE;
    }
    cycles(2);
}

/** 2.2.2, 2.4.2: an aborting command or power off aborts all that wait; an axis error is an error of all. */
START_TEST(test_all_that_wait_end_as_the_running_one_does)
{
    for (int mode = mcBuffered; mode <= mcBlendingHigh; mode++)
        for (int at = 0; at < 120; at += 7) {
            snprintf(judged.scene, sizeof judged.scene, "queue, mode %d, end %d after %d cycles", mode, _i, at);
            make_queue(4, mode);
            cycles(at);
            bool busy[4];
            for (int i = 0; i < 4; i++)
                busy[i] = fbs[i].now.busy;
            strike((end_t)_i);
            for (int i = 0; i < 4; i++) {
                const bool error = _i >= END_FAULT;
                MUST(!fbs[i].now.busy || _i == END_DIRECTION, "%d is still Busy", i);
                MUST(!busy[i] || fbs[i].now.busy || fbs[i].now.done || (error ? fbs[i].now.error : fbs[i].now.aborted),
                     "%d: CommandAborted %d, Error 0x%04X", i, fbs[i].now.aborted, fbs[i].now.error_id);
                MUST(!fbs[i].now.done || i <= 1 || at > 0, "%d is Done", i);
            }
            const double position = bench.info.set_position;
            cycles(1500);
            MUST(judged.state != CM1E_AXIS_DISCRETE_MOTION, "it moves on");
            if (_i == END_DIRECTION) /* braking may end in one of them, but it takes no more way than that */
                MUST(bench.info.set_position - position < 0.8, "it went on by %g", bench.info.set_position - position);
        }
}
END_TEST

/** A waiting block may be forgotten: no call, Execute fallen, memory gone. */
START_TEST(test_waiting_command_needs_no_block)
{
    snprintf(judged.scene, sizeof judged.scene, "forgotten");
    make_queue(3, mcBuffered);
    called_count = 0;
    memset(fbs, 0xA5, sizeof fbs);
    cycles(4000);
    MUST(fabs(bench.info.set_position - 1.5) < 1e-6, "ends at %.9g", bench.info.set_position);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("conformance: pairs");
    bench.with_master = true;
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 60);
    tcase_add_loop_test(all, test_every_pair_in_every_buffer_mode, 0, MOVERS);
    tcase_add_test(all, test_edge_on_a_busy_block_shows_nothing_of_the_first_command);
    tcase_add_test(all, test_queue_keeps_its_order_and_refuses_what_is_too_much);
    tcase_add_loop_test(all, test_all_that_wait_end_as_the_running_one_does, 0, ENDS);
    tcase_add_test(all, test_waiting_command_needs_no_block);
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
