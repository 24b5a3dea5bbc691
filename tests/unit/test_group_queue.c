/* Commands of a group behind each other, and what it keeps of errors: which commands wait, a reset that waits for every axis,
 * refusals that are repeated. */
#include "unity.h"

#include "../support/group_bench.h"

void setUp(void) { group_begin(3); }
void tearDown(void) { group_end(); }

/** A line that replaces a halt, which still brakes, takes others behind it as any line does. */
static void test_behind_an_aborted_halt_lines_follow_each_other(void)
{
    group_line(8.0, 0.0, 2.0, mcAborting);
    axes_cycles(1000);
    const cm1e_command_id_t halt = group_command(&(cm1e_group_command_t){.kind = CM1E_GROUP_HALT, .deceleration = 2.0});
    axes_cycles(50);
    const cm1e_command_id_t first = group_line(3.0, 4.0, 2.0, mcAborting);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, group_state_of(halt));
    axes_cycles(50);
    const cm1e_command_id_t second = group_line(6.0, 8.0, 2.0, mcBuffered);
    for (int n = 0; group_state_of(first) == CM1E_COMMAND_ACTIVE; n++) {
        TEST_ASSERT_LESS_THAN(20000, n);
        axes_cycles(1);
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 3.0, group_at(0));
    TEST_ASSERT_DOUBLE_WITHIN(0.01, 4.0, group_at(1));
    group_done(second);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 8.0, group_at(1));
}

/** Of commands that wait one behind the other; no number before them, nor one that was not given yet. */
static void test_which_commands_wait(void)
{
    cm1e_command_id_t ids[4];
    for (int i = 0; i < 4; i++)
        ids[i] = group_line(i + 1.0, 0.0, 2.0, mcBuffered);
    TEST_ASSERT_FALSE(cm1e_group_waits(group_reference, 0));
    TEST_ASSERT_FALSE(cm1e_group_waits(group_reference, ids[0] - 1));
    TEST_ASSERT_FALSE(cm1e_group_waits(group_reference, ids[0])); /* it is active */
    for (int i = 1; i < 4; i++)
        TEST_ASSERT_TRUE(cm1e_group_waits(group_reference, ids[i]));
    TEST_ASSERT_FALSE(cm1e_group_waits(group_reference, ids[3] + 1));
    group_done(ids[3]);
    TEST_ASSERT_FALSE(cm1e_group_waits(group_reference, ids[3]));
}

/** Whichever of them it is that is slow, also the first or the last one. */
static void test_a_reset_waits_for_every_axis(void)
{
    for (int slow = 0; slow < 3; slow++) {
        tearDown();
        setUp();
        fake_bus_fault(axes_motor(slow), 0x2310);
        axes_cycles(5);
        group_must_be(CM1E_GROUP_ERROR_STOP);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_group_reset(group));
        for (int n = 0; cm1e_group_reset_state(group, NULL) == CM1E_COMMAND_ACTIVE; n++) {
            TEST_ASSERT_LESS_THAN(1000, n);
            group_must_be(CM1E_GROUP_ERROR_STOP);
            axes_cycles(1);
        }
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, cm1e_group_reset_state(group, NULL));
        for (int i = 0; i < 3; i++)
            TEST_ASSERT_NOT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, cm1e_axis_present_state(axes_axis(i)));
    }
}

/* As MC_GroupSetOverride does in every call with factors that are refused. */
static void refuse_factors(double velocity, double acceleration, double jerk, bool begins, const char *words)
{
    cm1e_group_refuse_override(group, CM1E_ERROR_AXIS_OVERRIDE, velocity, acceleration, jerk, begins);
    group_told(words);
}

/** The first one, and each other one of its kind, has its text; one that is only repeated takes no other text away. */
static void test_a_repeated_refusal_takes_no_other_text_away(void)
{
    const cm1e_group_command_t nowhere = {.kind = CM1E_GROUP_LINEAR_ABSOLUTE, .position = {NAN}, .velocity = 1.0};
    refuse_factors(-0.5, 1.0, 1.0, true, "-0.5");
    group_told("VelFactor must be 0 ... 1.");
    refuse_factors(1.5, 1.0, 1.0, false, "1.5");
    refuse_factors(1.0, 1.5, 1.0, false, "AccFactor must be 1 in this version.");
    refuse_factors(1.0, 1.0, 1.5, false, "JerkFactor must be 1 in this version.");
    group_refused(&nowhere, CM1E_ERROR_GROUP_PATH);
    group_told("not a finite number");
    refuse_factors(1.0, 1.0, 1.5, false, "not a finite number");
    refuse_factors(-0.5, 1.0, 1.0, false, "not a finite number");
    refuse_factors(-0.5, 1.0, 1.0, true, "VelFactor must be 0 ... 1.");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_behind_an_aborted_halt_lines_follow_each_other);
    RUN_TEST(test_which_commands_wait);
    RUN_TEST(test_a_reset_waits_for_every_axis);
    RUN_TEST(test_a_repeated_refusal_takes_no_other_text_away);
    return UNITY_END();
}
