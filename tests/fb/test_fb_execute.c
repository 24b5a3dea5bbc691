/**
 * Blocks of the Execute type on axes without anything behind them: their outputs, call by call, by the rules of PLCopen
 * Part 1 v2.0, 2.4.1. One table of blocks, every rule on each of them.
 */
#include <check.h>
#include <stdio.h>
#include <stdlib.h>

#include "fake_axis.h"

/* ---- the blocks behind one face -------------------------------------------------------------------------------- */

typedef struct outputs {
    BOOL done, busy, active, aborted, error;
    WORD error_id;
} outputs_t;

typedef struct block {
    const char *name;
    cm1e_command_kind_t kind;
    bool has_active, has_aborted, done_is_in_velocity;
    outputs_t (*call)(AXIS_REF_t *axis, BOOL execute);
    void (*clear)(void);
} block_t;

#define BLOCK_FUNCTIONS(TYPE, DONE, ACTIVE, ABORTED)                                                                   \
    static TYPE##_t instance_##TYPE;                                                                                   \
    static outputs_t call_##TYPE(AXIS_REF_t *axis, BOOL execute)                                                       \
    {                                                                                                                  \
        TYPE##_t *fb = &instance_##TYPE;                                                                               \
        fb->Axis = axis;                                                                                               \
        fb->Execute = execute;                                                                                         \
        TYPE(fb);                                                                                                      \
        return (outputs_t){DONE, fb->Busy, ACTIVE, ABORTED, fb->Error, fb->ErrorID};                                   \
    }                                                                                                                  \
    static void clear_##TYPE(void) { instance_##TYPE = (TYPE##_t){0}; }

BLOCK_FUNCTIONS(MC_MoveAbsolute, fb->Done, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS(MC_MoveRelative, fb->Done, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS(MC_MoveAdditive, fb->Done, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS(MC_MoveVelocity, fb->InVelocity, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS(MC_MoveContinuousAbsolute, fb->InEndVelocity, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS(MC_MoveContinuousRelative, fb->InEndVelocity, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS(MC_MoveSuperimposed, fb->Done, FALSE, fb->CommandAborted)
BLOCK_FUNCTIONS(MC_HaltSuperimposed, fb->Done, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS(MC_Halt, fb->Done, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS(MC_Stop, fb->Done, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS(MC_Home, fb->Done, fb->Active, fb->CommandAborted)
BLOCK_FUNCTIONS(MC_Reset, fb->Done, FALSE, FALSE)

#define BLOCK(TYPE, KIND, ACTIVE, ABORTED, VELOCITY)                                                                   \
    {#TYPE, KIND, ACTIVE, ABORTED, VELOCITY, call_##TYPE, clear_##TYPE}

static const block_t blocks[] = {
    BLOCK(MC_MoveAbsolute, CM1E_COMMAND_MOVE_ABSOLUTE, true, true, false),
    BLOCK(MC_MoveRelative, CM1E_COMMAND_MOVE_RELATIVE, true, true, false),
    BLOCK(MC_MoveVelocity, CM1E_COMMAND_MOVE_VELOCITY, true, true, true),
    BLOCK(MC_Halt, CM1E_COMMAND_HALT, true, true, false),
    BLOCK(MC_Stop, CM1E_COMMAND_STOP, true, true, false),
    BLOCK(MC_Home, CM1E_COMMAND_HOME, true, true, false),
    BLOCK(MC_Reset, CM1E_COMMAND_KIND_COUNT, false, false, false),
    BLOCK(MC_MoveAdditive, CM1E_COMMAND_MOVE_ADDITIVE, true, true, false),
    BLOCK(MC_MoveContinuousAbsolute, CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE, true, true, true),
    BLOCK(MC_MoveContinuousRelative, CM1E_COMMAND_MOVE_CONTINUOUS_RELATIVE, true, true, true),
    BLOCK(MC_MoveSuperimposed, CM1E_COMMAND_MOVE_SUPERIMPOSED, false, true, false),
    BLOCK(MC_HaltSuperimposed, CM1E_COMMAND_HALT_SUPERIMPOSED, true, true, false),
};
enum { BLOCKS = sizeof blocks / sizeof blocks[0] };

static AXIS_REF_t x = {1}, y = {2}, nothing = {0}, stranger = {99};
static cm1e_axis_t *const axis_x = &fake_axes[0], *const axis_y = &fake_axes[1];

/** What becomes of the last command of an axis. */
static void fake_finish(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error)
{
    axis->status[axis->id % FAKE_COMMANDS] = (cm1e_command_status_t){.state = state, .error = error};
    axis->reset_state = state;
    axis->reset_error = error;
}

static const block_t *fresh(int n)
{
    fake_reset();
    blocks[n].clear();
    return &blocks[n];
}

/** The outputs as letters: D B A C E, a dot for FALSE. */
static const char *letters(outputs_t out)
{
    static char text[8];
    snprintf(text, sizeof text, "%c%c%c%c%c", out.done ? 'D' : '.', out.busy ? 'B' : '.', out.active ? 'A' : '.',
             out.aborted ? 'C' : '.', out.error ? 'E' : '.');
    return text;
}

static void expect(const block_t *block, outputs_t out, const char *expected, cm1e_error_t error, int line)
{
    char wanted[8];
    snprintf(wanted, sizeof wanted, "%s", expected);
    if (!block->has_active)
        wanted[2] = '.';
    ck_assert_msg(strcmp(letters(out), wanted) == 0, "%s, line %d: outputs %s, expected %s", block->name, line,
                  letters(out), wanted);
    ck_assert_msg(out.error_id == cm1e_error_id(error), "%s, line %d: ErrorID %#x, expected %#x", block->name, line,
                  out.error_id, cm1e_error_id(error));
}
#define EXPECT(out, expected) expect(block, out, expected, CM1E_OK, __LINE__)
#define EXPECT_ERROR(out, error) expect(block, out, "....E", error, __LINE__)

#define BUSY ".BA.."
#define DONE "D...."
#define ABORTED "...C."
#define NONE "....."

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

/* ---- what one block has of its own ----------------------------------------------------------------------------- */

START_TEST(test_in_velocity_follows_the_set_point_and_leaves_busy_and_active)
{
    const block_t *block = fresh(2);
    static const BOOL in_velocity[] = {FALSE, TRUE, TRUE, FALSE, TRUE, FALSE};
    EXPECT(block->call(&x, TRUE), BUSY);
    for (int execute = TRUE; execute >= FALSE; execute--)
        for (size_t i = 0; i < sizeof in_velocity; i++) {
            axis_x->status[axis_x->id % FAKE_COMMANDS].reached = in_velocity[i];
            EXPECT(block->call(&x, (BOOL)execute), in_velocity[i] ? "DBA.." : BUSY);
        }
    axis_x->status[axis_x->id % FAKE_COMMANDS] =
        (cm1e_command_status_t){.state = CM1E_COMMAND_ABORTED, .reached = true};
    EXPECT(block->call(&x, FALSE), ABORTED);
    EXPECT(block->call(&x, FALSE), NONE);
}
END_TEST

START_TEST(test_stop_holds_the_axis_while_execute)
{
    const block_t *block = fresh(4);
    EXPECT(block->call(&x, TRUE), BUSY);
    ck_assert(axis_x->hold && axis_x->hold_id == axis_x->id);
    axis_x->info.state = CM1E_AXIS_STOPPING;
    EXPECT(block->call(&x, TRUE), BUSY);
    fake_finish(axis_x, CM1E_COMMAND_DONE, CM1E_OK);
    for (int i = 0; i < 3; i++) {
        EXPECT(block->call(&x, TRUE), "D.A..");
        ck_assert(axis_x->hold);
    }
    axis_x->info.state = CM1E_AXIS_DISABLED; /* power was taken away: Done stays true, control is gone */
    EXPECT(block->call(&x, TRUE), DONE);
    axis_x->info.state = CM1E_AXIS_STOPPING;
    EXPECT(block->call(&x, FALSE), NONE);
    ck_assert(!axis_x->hold);
}
END_TEST

START_TEST(test_stop_whose_execute_fell_does_not_hold)
{
    const block_t *block = fresh(4);
    EXPECT(block->call(&x, TRUE), BUSY);
    axis_x->info.state = CM1E_AXIS_STOPPING;
    EXPECT(block->call(&x, FALSE), BUSY);
    ck_assert(!axis_x->hold);
    fake_finish(axis_x, CM1E_COMMAND_DONE, CM1E_OK);
    EXPECT(block->call(&x, FALSE), DONE);
    ck_assert(!axis_x->hold);
}
END_TEST

START_TEST(test_stop_whose_axis_was_changed_still_holds_and_releases_its_axis)
{
    const block_t *block = fresh(4);
    EXPECT(block->call(&x, TRUE), BUSY);
    EXPECT_ERROR(block->call(&y, TRUE), CM1E_ERROR_FB_AXIS_CHANGED);
    ck_assert(axis_x->hold && !axis_y->hold);
    EXPECT(block->call(&y, FALSE), NONE);
    ck_assert(!axis_x->hold);
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

START_TEST(test_continuous_update_hands_on_inputs_while_it_stays_true)
{
    fake_reset();
    MC_MoveAbsolute_t fb = {.Axis = &x, .Execute = TRUE, .ContinuousUpdate = 3, .Position = 1.0, .Velocity = 2.0};
    MC_MoveAbsolute(&fb);
    ck_assert_uint_eq(axis_x->updates, 0); /* the edge has them already */
    fb.Position = 5.0;
    MC_MoveAbsolute(&fb);
    ck_assert_uint_eq(axis_x->updates, 1);
    ck_assert_uint_eq(axis_x->updated, axis_x->id);
    ck_assert_double_eq(axis_x->command.position, 5.0);
    fb.Execute = FALSE; /* does not influence the execution */
    fb.Velocity = 4.0;
    MC_MoveAbsolute(&fb);
    ck_assert_double_eq(axis_x->command.velocity, 4.0);
    fb.ContinuousUpdate = FALSE;
    MC_MoveAbsolute(&fb);
    const unsigned updates = axis_x->updates;
    fb.ContinuousUpdate = TRUE; /* too late */
    fb.Position = 6.0;
    MC_MoveAbsolute(&fb);
    ck_assert_uint_eq(axis_x->updates, updates);
    ck_assert_double_eq(axis_x->command.position, 5.0);
    ck_assert(fb.Busy && fb.Active);
    fb.Execute = TRUE; /* a new edge takes the new inputs, and updates again */
    MC_MoveAbsolute(&fb);
    MC_MoveAbsolute(&fb);
    ck_assert_uint_eq(axis_x->updates, updates + 1);
    ck_assert_double_eq(axis_x->command.position, 6.0);
    fake_finish(axis_x, CM1E_COMMAND_DONE, CM1E_OK);
    MC_MoveAbsolute(&fb);
    ck_assert(fb.Done);
    MC_MoveAbsolute(&fb);
    ck_assert_uint_le(axis_x->updates, updates + 2); /* ended with Busy */
    ck_assert_uint_eq(axis_x->starts, 2);
}
END_TEST

START_TEST(test_continuous_update_later_than_the_edge_has_no_effect)
{
    fake_reset();
    MC_MoveVelocity_t fb = {.Axis = &x, .Execute = TRUE, .Velocity = 2.0};
    MC_MoveVelocity(&fb);
    fb.ContinuousUpdate = TRUE;
    fb.Velocity = 3.0;
    for (int i = 0; i < 3; i++)
        MC_MoveVelocity(&fb);
    ck_assert_uint_eq(axis_x->updates, 0);
    ck_assert_double_eq(axis_x->command.velocity, 2.0);
}
END_TEST

START_TEST(test_refused_update_is_an_error_and_ends_the_updates)
{
    fake_reset();
    MC_MoveRelative_t fb = {.Axis = &x, .Execute = TRUE, .ContinuousUpdate = TRUE, .Distance = 1.0, .Velocity = 2.0};
    MC_MoveRelative(&fb);
    axis_x->update_error = CM1E_ERROR_AXIS_VELOCITY_RANGE;
    fb.Velocity = -1.0;
    for (int i = 0; i < 3; i++) {
        MC_MoveRelative(&fb);
        ck_assert(fb.Error && !fb.Busy && !fb.Active && !fb.Done);
        ck_assert_uint_eq(fb.ErrorID, cm1e_error_id(CM1E_ERROR_AXIS_VELOCITY_RANGE));
    }
    ck_assert_uint_eq(axis_x->updates, 1);
    fb.Execute = FALSE;
    MC_MoveRelative(&fb);
    ck_assert(!fb.Error && !fb.Busy && fb.ErrorID == 0);
}
END_TEST

START_TEST(test_covered_distance_is_shown_while_busy_and_kept)
{
    fake_reset();
    MC_MoveSuperimposed_t fb = {.Axis = &x, .Execute = TRUE, .Distance = 5.0, .VelocityDiff = 2.0};
    MC_MoveSuperimposed(&fb);
    ck_assert(fb.Busy && fb.CoveredDistance == 0.0);
    axis_x->status[axis_x->id % FAKE_COMMANDS].covered = 3.0;
    MC_MoveSuperimposed(&fb);
    ck_assert_double_eq(fb.CoveredDistance, 3.0);
    fake_finish(axis_x, CM1E_COMMAND_DONE, CM1E_OK);
    axis_x->status[axis_x->id % FAKE_COMMANDS].covered = 5.0;
    for (int i = 0; i < 3; i++) {
        MC_MoveSuperimposed(&fb);
        ck_assert(fb.Done && fb.CoveredDistance == 5.0);
    }
    fb.Execute = FALSE;
    MC_MoveSuperimposed(&fb);
    ck_assert(!fb.Done && fb.CoveredDistance == 5.0);
    fb.Execute = TRUE;
    MC_MoveSuperimposed(&fb);
    ck_assert(fb.Busy && fb.CoveredDistance == 0.0);
}
END_TEST

static void expect_command(cm1e_axis_command_t expected, int line)
{
    const cm1e_axis_command_t *got = &axis_x->command;
    ck_assert_msg(got->kind == expected.kind && got->position == expected.position
                      && got->velocity == expected.velocity && got->acceleration == expected.acceleration
                      && got->deceleration == expected.deceleration && got->jerk == expected.jerk
                      && got->end_velocity == expected.end_velocity && got->direction == expected.direction && got->buffer_mode == expected.buffer_mode
                      && got->homing == expected.homing,
                  "line %d: the command is not what the inputs say", line);
}

START_TEST(test_inputs_reach_the_axis_at_the_edge_and_not_later)
{
    fresh(0);
    static const cm1e_homing_config_t homing = {.method = -1};
    MC_MoveAbsolute_t absolute = {.Axis = &x, .Execute = TRUE, .Position = 1, .Velocity = 2, .Acceleration = 3,
                                  .Deceleration = 4, .Jerk = 5, .Direction = mcNegativeDirection,
                                  .BufferMode = mcBlendingNext};
    const cm1e_axis_command_t expected = {.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 1, .velocity = 2,
                                          .acceleration = 3, .deceleration = 4, .jerk = 5,
                                          .direction = mcNegativeDirection, .buffer_mode = mcBlendingNext};
    MC_MoveAbsolute(&absolute);
    expect_command(expected, __LINE__);
    absolute.Position = 100;
    absolute.Velocity = 200;
    MC_MoveAbsolute(&absolute);
    expect_command(expected, __LINE__);
    ck_assert_uint_eq(axis_x->starts, 1);

    MC_MoveRelative_t relative = {.Axis = &x, .Execute = TRUE, .Distance = -1, .Velocity = 2, .Acceleration = 3,
                                  .Deceleration = 4, .Jerk = 5, .BufferMode = mcBuffered};
    MC_MoveRelative(&relative);
    expect_command((cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .position = -1, .velocity = 2,
                                         .acceleration = 3, .deceleration = 4, .jerk = 5, .buffer_mode = mcBuffered},
                   __LINE__);

    MC_MoveVelocity_t velocity = {.Axis = &x, .Execute = TRUE, .Velocity = -2, .Acceleration = 3, .Deceleration = 4,
                                  .Jerk = 5, .Direction = mcCurrentDirection, .BufferMode = mcBlendingHigh};
    MC_MoveVelocity(&velocity);
    expect_command((cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_VELOCITY, .velocity = -2, .acceleration = 3,
                                         .deceleration = 4, .jerk = 5, .direction = mcCurrentDirection,
                                         .buffer_mode = mcBlendingHigh},
                   __LINE__);

    MC_MoveVelocity_t plain = {.Axis = &x, .Execute = TRUE, .Velocity = 7};
    MC_MoveVelocity(&plain);
    ck_assert_int_eq(axis_x->command.direction, mcPositiveDirection);

    MC_Halt_t halt = {.Axis = &x, .Execute = TRUE, .Deceleration = 4, .Jerk = 5, .BufferMode = mcBlendingLow};
    MC_Halt(&halt);
    expect_command((cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT, .deceleration = 4, .jerk = 5,
                                         .buffer_mode = mcBlendingLow},
                   __LINE__);

    MC_Stop_t stop = {.Axis = &x, .Execute = TRUE, .Deceleration = 6, .Jerk = 7};
    MC_Stop(&stop);
    expect_command((cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP, .deceleration = 6, .jerk = 7}, __LINE__);

    MC_MoveAdditive_t additive = {.Axis = &x, .Execute = TRUE, .Distance = -1, .Velocity = 2, .Acceleration = 3,
                                  .Deceleration = 4, .Jerk = 5, .BufferMode = mcBlendingPrevious};
    MC_MoveAdditive(&additive);
    expect_command((cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ADDITIVE, .position = -1, .velocity = 2,
                                         .acceleration = 3, .deceleration = 4, .jerk = 5,
                                         .buffer_mode = mcBlendingPrevious},
                   __LINE__);

    MC_MoveContinuousAbsolute_t through = {.Axis = &x, .Execute = TRUE, .Position = 1, .EndVelocity = -9, .Velocity = 2,
                                           .Acceleration = 3, .Deceleration = 4, .Jerk = 5,
                                           .Direction = mcNegativeDirection, .BufferMode = mcBlendingLow};
    MC_MoveContinuousAbsolute(&through);
    expect_command((cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE, .position = 1,
                                         .end_velocity = -9, .velocity = 2, .acceleration = 3, .deceleration = 4,
                                         .jerk = 5, .direction = mcNegativeDirection, .buffer_mode = mcBlendingLow},
                   __LINE__);

    MC_MoveContinuousRelative_t onward = {.Axis = &x, .Execute = TRUE, .Distance = 1, .EndVelocity = 9, .Velocity = 2,
                                          .Acceleration = 3, .Deceleration = 4, .Jerk = 5, .BufferMode = mcBuffered};
    MC_MoveContinuousRelative(&onward);
    expect_command((cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_CONTINUOUS_RELATIVE, .position = 1,
                                         .end_velocity = 9, .velocity = 2, .acceleration = 3, .deceleration = 4,
                                         .jerk = 5, .buffer_mode = mcBuffered},
                   __LINE__);

    MC_MoveSuperimposed_t more = {.Axis = &x, .Execute = TRUE, .Distance = -1, .VelocityDiff = 2, .Acceleration = 3,
                                  .Deceleration = 4, .Jerk = 5};
    MC_MoveSuperimposed(&more);
    expect_command((cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_SUPERIMPOSED, .position = -1, .velocity = 2,
                                         .acceleration = 3, .deceleration = 4, .jerk = 5},
                   __LINE__);

    MC_HaltSuperimposed_t no_more = {.Axis = &x, .Execute = TRUE, .Deceleration = 4, .Jerk = 5};
    MC_HaltSuperimposed(&no_more);
    expect_command((cm1e_axis_command_t){.kind = CM1E_COMMAND_HALT_SUPERIMPOSED, .deceleration = 4, .jerk = 5},
                   __LINE__);

    MC_Home_t home = {.Axis = &x, .Execute = TRUE, .Position = 8, .BufferMode = mcBuffered, .Parameters = &homing};
    MC_Home(&home);
    expect_command((cm1e_axis_command_t){.kind = CM1E_COMMAND_HOME, .position = 8, .buffer_mode = mcBuffered,
                                         .homing = &homing},
                   __LINE__);
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
    TCase *all = tcase_create("every block"), *own = tcase_create("one block");
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
    const TTest *const single[] = {
        test_in_velocity_follows_the_set_point_and_leaves_busy_and_active,
        test_stop_holds_the_axis_while_execute,
        test_stop_whose_execute_fell_does_not_hold,
        test_stop_whose_axis_was_changed_still_holds_and_releases_its_axis,
        test_continuous_update_hands_on_inputs_while_it_stays_true,
        test_continuous_update_later_than_the_edge_has_no_effect,
        test_refused_update_is_an_error_and_ends_the_updates,
        test_covered_distance_is_shown_while_busy_and_kept,
        test_inputs_reach_the_axis_at_the_edge_and_not_later,
    };
    for (size_t i = 0; i < sizeof every / sizeof every[0]; i++)
        tcase_add_loop_test(all, every[i], 0, BLOCKS);
    for (size_t i = 0; i < sizeof single / sizeof single[0]; i++)
        tcase_add_test(own, single[i]);
    suite_add_tcase(suite, all);
    suite_add_tcase(suite, own);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
