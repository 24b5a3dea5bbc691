/**
 * What one block of the Execute type has of its own, on axes without anything behind them: InVelocity, the hold of
 * MC_Stop, ContinuousUpdate, CoveredDistance, and which of its inputs reach the axis. What all have in common:
 * test_fb_execute.
 */
#include <stdlib.h>

#include "execute_blocks.h"

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
                      && got->end_velocity == expected.end_velocity && got->direction == expected.direction
                      && got->buffer_mode == expected.buffer_mode
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

int main(void)
{
    Suite *suite = suite_create("Execute, one block");
    TCase *own = tcase_create("one block");
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
    for (size_t i = 0; i < sizeof single / sizeof single[0]; i++)
        tcase_add_test(own, single[i]);
    suite_add_tcase(suite, own);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
