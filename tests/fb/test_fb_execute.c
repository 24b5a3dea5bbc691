/**
 * Blocks of the Execute type on axes without anything behind them: their outputs, call by call, by the rules of PLCopen
 * Part 1 v2.0, 2.4.1. One table of blocks, every rule on each of them. What one block has of its own:
 * test_fb_execute_own.
 */
#include <stdlib.h>

#include "execute_blocks.h"

static AXIS_REF_t nothing = {0}, stranger = {99};

/* ---- one command from its edge to its end ---------------------------------------------------------------------- */

START_TEST(test_never_executed_shows_nothing)
{
    const block_t *block = fresh(_i);
    for (int i = 0; i < 3; i++)
        EXPECT(block->call(&x, FALSE), NONE);
    EXPECT(block->call(NULL, FALSE), NONE);
    ck_assert_uint_eq(axis_x->starts, 0);
}
END_TEST

START_TEST(test_done_with_execute_held_stays_until_it_falls)
{
    const block_t *block = fresh(_i);
    if (block->done_is_in_velocity)
        return;
    for (int i = 0; i < 3; i++)
        EXPECT(block->call(&x, TRUE), BUSY);
    fake_finish(axis_x, CM1E_COMMAND_DONE, CM1E_OK);
    for (int i = 0; i < 3; i++)
        EXPECT(block->call(&x, TRUE), DONE);
    EXPECT(block->call(&x, FALSE), NONE);
    EXPECT(block->call(&x, FALSE), NONE);
    ck_assert_uint_eq(axis_x->starts, 1);
}
END_TEST

START_TEST(test_pulse_of_one_call_goes_on_and_shows_done_for_one_call)
{
    const block_t *block = fresh(_i);
    if (block->done_is_in_velocity)
        return;
    EXPECT(block->call(&x, TRUE), BUSY);
    for (int i = 0; i < 5; i++)
        EXPECT(block->call(&x, FALSE), BUSY);
    fake_finish(axis_x, CM1E_COMMAND_DONE, CM1E_OK);
    EXPECT(block->call(&x, FALSE), DONE);
    EXPECT(block->call(&x, FALSE), NONE);
    ck_assert_uint_eq(axis_x->starts, 1);
}
END_TEST

START_TEST(test_execute_falls_in_the_call_that_finds_done_shows_done_for_one_call)
{
    const block_t *block = fresh(_i);
    if (block->done_is_in_velocity)
        return;
    EXPECT(block->call(&x, TRUE), BUSY);
    EXPECT(block->call(&x, TRUE), BUSY);
    fake_finish(axis_x, CM1E_COMMAND_DONE, CM1E_OK);
    EXPECT(block->call(&x, FALSE), DONE);
    EXPECT(block->call(&x, FALSE), NONE);
}
END_TEST

/** Ends other than Done: {state of the command, what a block with CommandAborted shows, and one without}. */
static const struct {
    cm1e_command_state_t state;
    cm1e_error_t error;
    const char *shown;
    cm1e_error_t error_shown, error_without_aborted;
} ends[] = {
    {CM1E_COMMAND_ABORTED, CM1E_OK, ABORTED, CM1E_OK, CM1E_ERROR_CANCELLED},
    {CM1E_COMMAND_UNKNOWN, CM1E_OK, ABORTED, CM1E_OK, CM1E_ERROR_CANCELLED},
    {CM1E_COMMAND_ERROR, CM1E_ERROR_DRIVE_FAULT, "....E", CM1E_ERROR_DRIVE_FAULT, CM1E_ERROR_DRIVE_FAULT},
    {CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_LAG, "....E", CM1E_ERROR_AXIS_LAG, CM1E_ERROR_AXIS_LAG},
};
enum { ENDS = sizeof ends / sizeof ends[0] };

static void expect_end(const block_t *block, outputs_t out, int end, int line)
{
    if (block->has_aborted)
        expect(block, out, ends[end].shown, ends[end].error_shown, line);
    else
        expect(block, out, "....E", ends[end].error_without_aborted, line);
}

START_TEST(test_other_ends_are_shown_while_execute_or_for_one_call)
{
    for (int end = 0; end < ENDS; end++)
        for (int held = 0; held <= 1; held++) {
            const block_t *block = fresh(_i);
            EXPECT(block->call(&x, TRUE), BUSY);
            EXPECT(block->call(&x, (BOOL)held), BUSY);
            fake_finish(axis_x, ends[end].state, ends[end].error);
            expect_end(block, block->call(&x, (BOOL)held), end, __LINE__);
            for (int i = 0; i < 3 && held; i++)
                expect_end(block, block->call(&x, TRUE), end, __LINE__);
            EXPECT(block->call(&x, FALSE), NONE);
            EXPECT(block->call(&x, TRUE), BUSY);
        }
}
END_TEST

START_TEST(test_refused_start_is_an_error_at_once_and_never_busy)
{
#define REFUSAL(name, value, text) CM1E_##name,
    static const cm1e_error_t refusals[] = {CM1E_ERRORS(REFUSAL)};
    for (size_t i = 1; i < sizeof refusals / sizeof refusals[0]; i++) {
        const block_t *block = fresh(_i);
        axis_x->start_error = refusals[i];
        EXPECT_ERROR(block->call(&x, TRUE), refusals[i]);
        axis_x->start_error = CM1E_OK;
        for (int n = 0; n < 3; n++)
            EXPECT_ERROR(block->call(&x, TRUE), refusals[i]);
        ck_assert_uint_eq(axis_x->starts, 1);
        EXPECT(block->call(&x, FALSE), NONE);
        EXPECT(block->call(&x, TRUE), BUSY);
        ck_assert_uint_eq(axis_x->starts, 2);
    }
}
END_TEST

START_TEST(test_refused_pulse_shows_the_error_for_one_call)
{
    const block_t *block = fresh(_i);
    axis_x->start_error = CM1E_ERROR_AXIS_NOT_POWERED;
    EXPECT_ERROR(block->call(&x, TRUE), CM1E_ERROR_AXIS_NOT_POWERED);
    EXPECT(block->call(&x, FALSE), NONE);
}
END_TEST

START_TEST(test_buffered_is_busy_but_not_active)
{
    const block_t *block = fresh(_i);
    if (!block->has_active || block->kind == CM1E_COMMAND_STOP)
        return;
    EXPECT(block->call(&x, TRUE), BUSY);
    axis_x->status[axis_x->id % FAKE_COMMANDS].state = CM1E_COMMAND_BUFFERED;
    for (int i = 0; i < 3; i++)
        EXPECT(block->call(&x, TRUE), ".B...");
    EXPECT(block->call(&x, FALSE), ".B...");
    axis_x->status[axis_x->id % FAKE_COMMANDS] = (cm1e_command_status_t){.state = CM1E_COMMAND_ACTIVE};
    EXPECT(block->call(&x, FALSE), BUSY);
    axis_x->status[axis_x->id % FAKE_COMMANDS].state = CM1E_COMMAND_ABORTED;
    EXPECT(block->call(&x, FALSE), ABORTED);
}
END_TEST

/* ---- edges ----------------------------------------------------------------------------------------------------- */

START_TEST(test_any_non_zero_execute_is_true_and_no_second_edge)
{
    const block_t *block = fresh(_i);
    for (int i = 0; i < 255; i++)
        EXPECT(block->call(&x, (BOOL)(i + 1)), BUSY);
    ck_assert_uint_eq(axis_x->starts, 1);
}
END_TEST

START_TEST(test_retrigger_while_busy_shows_nothing_of_the_first_command)
{
    const block_t *block = fresh(_i);
    EXPECT(block->call(&x, TRUE), BUSY);
    EXPECT(block->call(&x, FALSE), BUSY);
    EXPECT(block->call(&x, TRUE), BUSY); /* the fake axis aborts the first command here */
    ck_assert_uint_eq(axis_x->starts, 2);
    EXPECT(block->call(&x, TRUE), BUSY);
    if (block->done_is_in_velocity)
        return;
    fake_finish(axis_x, CM1E_COMMAND_DONE, CM1E_OK);
    EXPECT(block->call(&x, TRUE), DONE);
}
END_TEST

START_TEST(test_retrigger_in_the_call_that_would_find_done_shows_no_done)
{
    const block_t *block = fresh(_i);
    EXPECT(block->call(&x, TRUE), BUSY);
    EXPECT(block->call(&x, FALSE), BUSY);
    fake_finish(axis_x, CM1E_COMMAND_DONE, CM1E_OK);
    EXPECT(block->call(&x, TRUE), BUSY);
    ck_assert_uint_eq(axis_x->starts, 2);
}
END_TEST

START_TEST(test_refused_retrigger_is_an_error)
{
    const block_t *block = fresh(_i);
    EXPECT(block->call(&x, TRUE), BUSY);
    EXPECT(block->call(&x, FALSE), BUSY);
    axis_x->start_error = CM1E_ERROR_AXIS_VELOCITY_RANGE;
    EXPECT_ERROR(block->call(&x, TRUE), CM1E_ERROR_AXIS_VELOCITY_RANGE);
    EXPECT(block->call(&x, FALSE), NONE);
}
END_TEST

START_TEST(test_new_edge_right_after_the_end_starts_again)
{
    const block_t *block = fresh(_i);
    for (int i = 0; i < 5; i++) {
        EXPECT(block->call(&x, TRUE), BUSY);
        fake_finish(axis_x, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_LAG);
        EXPECT_ERROR(block->call(&x, FALSE), CM1E_ERROR_AXIS_LAG);
    }
    ck_assert_uint_eq(axis_x->starts, 5);
}
END_TEST

/* ---- the axis -------------------------------------------------------------------------------------------------- */

START_TEST(test_axis_that_names_none_is_an_error)
{
    AXIS_REF_t *const references[] = {NULL, &nothing, &stranger};
    for (int i = 0; i < 3; i++) {
        const block_t *block = fresh(_i);
        EXPECT_ERROR(block->call(references[i], TRUE), CM1E_ERROR_FB_AXIS_REF);
        EXPECT_ERROR(block->call(references[i], TRUE), CM1E_ERROR_FB_AXIS_REF);
        EXPECT_ERROR(block->call(&x, TRUE), CM1E_ERROR_FB_AXIS_REF);
        EXPECT(block->call(&x, FALSE), NONE);
        EXPECT(block->call(&x, TRUE), BUSY);
    }
}
END_TEST

START_TEST(test_axis_changed_while_busy_is_an_error_and_touches_neither_axis)
{
    AXIS_REF_t *const others[] = {&y, NULL, &nothing, &stranger};
    for (int edge = 0; edge <= 1; edge++)
        for (int i = 0; i < 4; i++) {
            const block_t *block = fresh(_i);
            EXPECT(block->call(&x, TRUE), BUSY);
            if (edge)
                EXPECT(block->call(&x, FALSE), BUSY);
            EXPECT_ERROR(block->call(others[i], TRUE), CM1E_ERROR_FB_AXIS_CHANGED);
            EXPECT_ERROR(block->call(others[i], TRUE), CM1E_ERROR_FB_AXIS_CHANGED);
            EXPECT_ERROR(block->call(&x, TRUE), CM1E_ERROR_FB_AXIS_CHANGED);
            EXPECT(block->call(&x, FALSE), NONE);
            ck_assert_uint_eq(axis_x->starts, 1);
            ck_assert_uint_eq(axis_y->starts, 0);
            EXPECT(block->call(&y, TRUE), BUSY);
            ck_assert_uint_eq(axis_y->starts, 1);
        }
}
END_TEST

START_TEST(test_copy_of_the_axis_reference_is_the_same_axis)
{
    const block_t *block = fresh(_i);
    AXIS_REF_t copy = x;
    EXPECT(block->call(&x, TRUE), BUSY);
    EXPECT(block->call(&copy, TRUE), BUSY);
}
END_TEST

START_TEST(test_instance_is_used_again_on_another_axis)
{
    const block_t *block = fresh(_i);
    EXPECT(block->call(&x, TRUE), BUSY);
    fake_finish(axis_x, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_LAG);
    EXPECT_ERROR(block->call(&x, TRUE), CM1E_ERROR_AXIS_LAG);
    EXPECT_ERROR(block->call(&y, TRUE), CM1E_ERROR_AXIS_LAG); /* over: another axis is no error, and no edge */
    EXPECT(block->call(&y, FALSE), NONE);
    EXPECT(block->call(&y, TRUE), BUSY);
    ck_assert_uint_eq(axis_x->starts, 1);
    ck_assert_uint_eq(axis_y->starts, 1);
}
END_TEST

/* ---- random sequences against the rules ------------------------------------------------------------------------ */

static unsigned random_state;
static unsigned random_below(unsigned n)
{
    random_state = random_state * 1664525u + 1013904223u;
    return (random_state >> 10) % n;
}

/** An assertion of Check that holds costs a system call: too much for so many. */
#define RULE(condition, rule)                                                                                        \
    do                                                                                                               \
        if (!(condition))                                                                                            \
            ck_abort_msg("%s, step %u: %s: %s, ErrorID %#x", block->name, step, rule, letters(now), now.error_id);   \
    while (0)

static void check_rules(const block_t *block, outputs_t now, outputs_t before, BOOL execute, BOOL execute_before,
                        unsigned step)
{
    const int results = now.done + now.aborted + now.error;
    const bool velocity = block->done_is_in_velocity, edge = execute && !execute_before;
    const int shown = (velocity ? 0 : now.done) + now.busy + now.aborted + now.error;
    RULE(shown <= 1, "outputs exclude each other");
    RULE(!execute || shown == 1, "Execute and no output");
    RULE(!velocity || !now.done || now.busy, "InVelocity without Busy");
    RULE(now.error == (now.error_id != 0), "Error and ErrorID");
    RULE(!block->has_active || block->kind == CM1E_COMMAND_STOP || now.busy || !now.active, "Active goes with Busy");
    RULE(velocity || results == 0 || before.busy || edge || execute, "a result outlived Execute");
    RULE(!before.busy || edge || now.busy || results >= 1, "Busy fell and nothing rose");
    RULE(before.busy || !now.busy || edge, "Busy rose without an edge");
    RULE(!edge || velocity || (!now.done && !now.aborted), "a result of the past at the edge");
}

START_TEST(test_random_calls_keep_the_rules)
{
    static const cm1e_command_state_t states[] = {CM1E_COMMAND_ACTIVE, CM1E_COMMAND_BUFFERED, CM1E_COMMAND_DONE,
                                                  CM1E_COMMAND_ABORTED, CM1E_COMMAND_ERROR, CM1E_COMMAND_UNKNOWN};
    AXIS_REF_t *const references[] = {&x, &x, &x, &x, &x, &x, &y, NULL};
    const block_t *block = fresh(_i);
    const unsigned seed = 20250300u + (unsigned)_i;
    random_state = seed;
    printf("%s: seed %u\n", block->name, seed);
    outputs_t before = {0};
    BOOL execute_before = FALSE;
    for (unsigned step = 0; step < 200000; step++) {
        const BOOL execute = (BOOL)(random_below(3) ? execute_before : random_below(2));
        for (int i = 0; i < FAKE_AXES; i++) {
            cm1e_command_state_t state = states[random_below(6)];
            if (block->done_is_in_velocity && state == CM1E_COMMAND_DONE)
                state = CM1E_COMMAND_ACTIVE; /* a velocity command has no end of its own */
            fake_finish(&fake_axes[i], state, state == CM1E_COMMAND_ERROR ? CM1E_ERROR_AXIS_LAG : CM1E_OK);
            fake_axes[i].status[fake_axes[i].id % FAKE_COMMANDS].reached = random_below(2);
            fake_axes[i].start_error = random_below(5) ? CM1E_OK : CM1E_ERROR_AXIS_STATE;
            fake_axes[i].info.state = random_below(2) ? CM1E_AXIS_STOPPING : CM1E_AXIS_STANDSTILL;
        }
        const outputs_t now = block->call(references[random_below(8)], execute);
        check_rules(block, now, before, execute, execute_before, step);
        before = now;
        execute_before = execute;
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("Execute");
    TCase *all = tcase_create("every block");
    const TTest *const every[] = {
        test_never_executed_shows_nothing,
        test_done_with_execute_held_stays_until_it_falls,
        test_pulse_of_one_call_goes_on_and_shows_done_for_one_call,
        test_execute_falls_in_the_call_that_finds_done_shows_done_for_one_call,
        test_other_ends_are_shown_while_execute_or_for_one_call,
        test_refused_start_is_an_error_at_once_and_never_busy,
        test_refused_pulse_shows_the_error_for_one_call,
        test_any_non_zero_execute_is_true_and_no_second_edge,
        test_retrigger_while_busy_shows_nothing_of_the_first_command,
        test_retrigger_in_the_call_that_would_find_done_shows_no_done,
        test_refused_retrigger_is_an_error,
        test_new_edge_right_after_the_end_starts_again,
        test_axis_that_names_none_is_an_error,
        test_axis_changed_while_busy_is_an_error_and_touches_neither_axis,
        test_copy_of_the_axis_reference_is_the_same_axis,
        test_instance_is_used_again_on_another_axis,
        test_buffered_is_busy_but_not_active,
        test_random_calls_keep_the_rules,
    };
    for (size_t i = 0; i < sizeof every / sizeof every[0]; i++)
        tcase_add_loop_test(all, every[i], 0, BLOCKS);
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
