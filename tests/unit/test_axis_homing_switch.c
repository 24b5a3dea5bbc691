/* Homing in steps (Part 5): the absolute switch and the limit switches, in every switch mode and direction, from every
 * place to begin. */
#include <math.h>
#include <stdlib.h>

#include "../support/homing_bench.h"

typedef enum place { L = LEFT_FLANK, R = RIGHT_FLANK, HERE = 1 } place_t;
static const int32_t places[3] = {-20000, 100, 20000}; /* left of the switch, on it, right of it */

static const struct {
    MC_HOME_DIRECTION direction;
    MC_SWITCH_MODE mode;
    place_t found[3];
} absolute_switch[] = {
    {mcPositiveDirection, mcOn, {L, HERE, R}},
    {mcPositiveDirection, mcOff, {HERE, R, HERE}},
    {mcPositiveDirection, mcRisingEdge, {L, L, L}},
    {mcPositiveDirection, mcFallingEdge, {R, R, R}},
    {mcPositiveDirection, mcEdgeSwitchPositive, {L, L, L}},
    {mcPositiveDirection, mcEdgeSwitchNegative, {R, R, R}},
    {mcNegativeDirection, mcOn, {L, HERE, R}},
    {mcNegativeDirection, mcOff, {HERE, L, HERE}},
    {mcNegativeDirection, mcRisingEdge, {R, R, R}},
    {mcNegativeDirection, mcFallingEdge, {L, L, L}},
    {mcNegativeDirection, mcEdgeSwitchPositive, {L, L, L}},
    {mcNegativeDirection, mcEdgeSwitchNegative, {R, R, R}},
    {mcSwitchPositive, mcOn, {L, HERE, R}},
    {mcSwitchPositive, mcOff, {HERE, L, HERE}},
    {mcSwitchPositive, mcRisingEdge, {L, L, L}},
    {mcSwitchPositive, mcFallingEdge, {R, R, R}},
    {mcSwitchPositive, mcEdgeSwitchPositive, {L, L, L}},
    {mcSwitchPositive, mcEdgeSwitchNegative, {R, R, R}},
    {mcSwitchNegative, mcOn, {L, HERE, R}},
    {mcSwitchNegative, mcOff, {HERE, R, HERE}},
    {mcSwitchNegative, mcRisingEdge, {R, R, R}},
    {mcSwitchNegative, mcFallingEdge, {L, L, L}},
    {mcSwitchNegative, mcEdgeSwitchPositive, {L, L, L}},
    {mcSwitchNegative, mcEdgeSwitchNegative, {R, R, R}},
};
enum { ABSOLUTE_SWITCH_ROWS = sizeof absolute_switch / sizeof absolute_switch[0] };

static void find_absolute_switch(int row, int place, double velocity)
{
    char what[64];
    snprintf(what, sizeof what, "direction %d, mode %d, place %d", absolute_switch[row].direction,
             absolute_switch[row].mode, place);
    step = (cm1e_homing_step_t){.direction = absolute_switch[row].direction, .mode = absolute_switch[row].mode};
    begin_at(places[place]);
    const cm1e_command_id_t id = start(velocity, 12.5);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_HOMING, bench_info().state);
    bench_wait(id, 20000);
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_COMMAND_DONE, bench_state_of(id), what);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_HOMING, bench_info().state);
    TEST_ASSERT_FALSE(bench_info().homed);
    const place_t found = absolute_switch[row].found[place];
    expect_called(found == HERE ? places[place] : (int32_t)found, 12.5, velocity);
    if (found == HERE)
        TEST_ASSERT_EQUAL_INT32(places[place], bus.position);
    expect_smooth(velocity);
    expect_standing();
}

static void test_absolute_switch_in_every_mode_direction_and_place(void)
{
    for (int row = 0; row < ABSOLUTE_SWITCH_ROWS; row++)
        for (int place = 0; place < 3; place++)
            find_absolute_switch(row, place, 1.0);
}

static void test_absolute_switch_with_normally_closed_contacts(void)
{
    configure(true);
    for (int row = 0; row < ABSOLUTE_SWITCH_ROWS; row++)
        find_absolute_switch(row, row % 3, 0.8);
}

static void test_inverted_axis_finds_the_same_flanks_from_the_other_side(void)
{
    bus.config.axes[0].invert = true;
    bus.config.axes[0].inputs.limit_positive = NEGATIVE_INPUT;
    bus.config.axes[0].inputs.limit_negative = POSITIVE_INPUT;
    step.mode = mcRisingEdge;
    begin_at(places[0]);
    const cm1e_command_id_t id = start(1.0, -3.0);
    bench_wait(id, 20000);
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
    const double called = bench_info().actual_position + (double)(bus.position - RIGHT_FLANK) / 50000.0;
    TEST_ASSERT_DOUBLE_WITHIN(0.0006, -3.0, called);
}

/* The place of an edge is no worse than half the way of one cycle, at any phase of the cycle. */
static void test_accuracy_of_the_place_at_every_phase(void)
{
    double worst = 0.0;
    for (int phase = 0; phase < 50; phase++) {
        step = (cm1e_homing_step_t){.mode = mcRisingEdge};
        begin_at(-20000 - phase);
        const cm1e_command_id_t id = start(1.0, 0.0);
        bench_wait(id, 20000);
        expect(id, CM1E_COMMAND_DONE, CM1E_OK);
        const double error = bench_info().actual_position * 50000.0 - (double)(bus.position - LEFT_FLANK);
        worst = fmax(worst, fabs(error));
    }
    TEST_ASSERT_TRUE(worst <= 25.0 + 0.5); /* 50 counts a cycle */
    TEST_ASSERT_TRUE(worst > 20.0); /* and the test sees it */
}

static void test_another_input_than_the_configured_one(void)
{
    bus.config.axes[0].inputs = (cm1e_input_config_t){0};
    step = (cm1e_homing_step_t){.mode = mcRisingEdge, .input = HOME_INPUT};
    begin_at(places[0]);
    const cm1e_command_id_t id = start(1.0, 0.0);
    bench_wait(id, 20000);
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
    expect_called(LEFT_FLANK, 0.0, 1.0);
}

static void test_no_position_is_set_without_one(void)
{
    step = (cm1e_homing_step_t){.mode = mcRisingEdge};
    begin_at(places[0]);
    const cm1e_command_id_t id = start(1.0, NAN);
    bench_wait(id, 20000);
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
    expect_called(LEFT_FLANK, LEFT_FLANK / 50000.0, 0.0);
    step = (cm1e_homing_step_t){.kind = CM1E_STEP_FINISH};
    const cm1e_command_id_t last = start(0.0, 0.0);
    bench_wait(last, 100);
    expect(last, CM1E_COMMAND_DONE, CM1E_OK);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_FALSE(bench_info().homed); /* nothing was found out */
}

/* Without a switch the search turns once at each limit switch, and gives up where it meets the first one again. */
static void test_switch_that_is_not_there_ends_at_the_first_limit_switch_again(void)
{
    switch_there = false;
    for (int direction = mcPositiveDirection; direction <= mcSwitchNegative; direction += 2) {
        step = (cm1e_homing_step_t){.direction = (MC_HOME_DIRECTION)direction, .mode = mcRisingEdge};
        begin_at(0);
        const cm1e_command_id_t id = start(1.0, 0.0);
        bench_wait(id, 20000);
        expect(id, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_STEP_LIMIT_SWITCH);
        bench_told("a step of a homing, running or waiting, was ended: ");
        bench_told(cm1e_strerror(CM1E_ERROR_AXIS_STEP_LIMIT_SWITCH));
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_HOMING, bench_info().state);
        TEST_ASSERT_FALSE(bench_info().homed);
        const bool positive = direction == mcPositiveDirection || direction == mcSwitchPositive;
        TEST_ASSERT_GREATER_OR_EQUAL_INT32(LIMIT_SWITCH, positive ? bus.position : -bus.position);
        expect_smooth(1.0);
        expect_standing();
    }
}

/* ---- limit switch ------------------------------------------------------------------------------------------------ */

static void test_limit_switch_in_every_mode_direction_and_place(void)
{
    static const int32_t begins[] = {-45000, 0, 45000};
    for (int mode = mcOn; mode <= mcFallingEdge; mode++)
        for (int sign = -1; sign <= 1; sign += 2)
            for (int place = 0; place < 3; place++) {
                step = (cm1e_homing_step_t){.kind = CM1E_STEP_LIMIT_SWITCH, .mode = (MC_SWITCH_MODE)mode,
                                            .direction = sign > 0 ? mcPositiveDirection : mcNegativeDirection};
                begin_at(begins[place]);
                const cm1e_command_id_t id = start(0.5, sign * 7.0);
                bench_wait(id, 20000);
                expect(id, CM1E_COMMAND_DONE, CM1E_OK);
                expect_called(sign * LIMIT_SWITCH, sign * 7.0, 0.5);
                const bool on = mode == mcOn || mode == mcRisingEdge; /* it stops where the mode says it is */
                TEST_ASSERT_EQUAL(on, bus.position * sign >= LIMIT_SWITCH);
                expect_smooth(0.5);
                expect_standing();
            }
}

/* The axis leaves its own limit switch, but the other one does not let it through. */
static void test_limit_switch_step_between_two_active_switches_gives_up(void)
{
    step = (cm1e_homing_step_t){.kind = CM1E_STEP_LIMIT_SWITCH};
    bus.config.axes[0].inputs.limit_negative = 4;
    bus.config.axes[0].inputs.limits_normally_closed = false;
    begin_at(45000);
    const cm1e_command_id_t id = start(0.5, 0.0);
    bus.world = NULL;
    bus.digital_inputs = 2u | 8u;
    bench_wait(id, 1000);
    expect(id, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_STEP_LIMIT_SWITCH);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_absolute_switch_in_every_mode_direction_and_place);
    RUN_TEST(test_absolute_switch_with_normally_closed_contacts);
    RUN_TEST(test_inverted_axis_finds_the_same_flanks_from_the_other_side);
    RUN_TEST(test_accuracy_of_the_place_at_every_phase);
    RUN_TEST(test_another_input_than_the_configured_one);
    RUN_TEST(test_no_position_is_set_without_one);
    RUN_TEST(test_switch_that_is_not_there_ends_at_the_first_limit_switch_again);
    RUN_TEST(test_limit_switch_in_every_mode_direction_and_place);
    RUN_TEST(test_limit_switch_step_between_two_active_switches_gives_up);
    return UNITY_END();
}
