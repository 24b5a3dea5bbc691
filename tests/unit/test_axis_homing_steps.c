/* Homing in steps (Part 5): every switch mode, direction and place to begin, every limit, every way to be interrupted,
 * against a switch, two limit switches and two stops on the shaft of the fake drive. */
#include <math.h>
#include <stdlib.h>

#include "../support/axis_bench.h"
#include "homing/homing_private.h"

enum { HOME_INPUT = 1, POSITIVE_INPUT, NEGATIVE_INPUT };
enum { LEFT_FLANK = -5000, RIGHT_FLANK = 5000, LIMIT_SWITCH = 40000, STOP = 60000 };

static bool switch_there, limits_there, stops_there, closed_contacts;
static int32_t before;

static bool between(int32_t position, int32_t from, int32_t to) { return position >= from && position < to; }

/* The shaft ends at the stops; what is missing to the target is torque, 0.1 % for a count. */
static void world(cm1e_bus_t *b)
{
    const int32_t wanted = b->position;
    if (stops_there)
        b->position = wanted > STOP ? STOP : wanted < -STOP ? -STOP : wanted;
    const int32_t missing = b->state == OPERATION_ENABLED ? b->target_position - b->position : 0;
    b->torque = (int16_t)(missing > 1250 ? 1250 : missing < -1250 ? -1250 : missing);
    b->velocity_raw = (b->position - before) * 1000;
    before = b->position;
    const bool home = switch_there && between(b->position, LEFT_FLANK, RIGHT_FLANK);
    const bool positive = limits_there && b->position >= LIMIT_SWITCH;
    const bool negative = limits_there && b->position <= -LIMIT_SWITCH;
    const unsigned levels = (home ? 1u : 0) | (positive ? 2u : 0) | (negative ? 4u : 0);
    b->digital_inputs = (uint16_t)(closed_contacts ? levels ^ 7u : levels);
}

static void configure(bool normally_closed)
{
    closed_contacts = normally_closed;
    bus.config.axes[0].inputs = (cm1e_input_config_t){.home = HOME_INPUT, .limit_positive = POSITIVE_INPUT,
                                                      .limit_negative = NEGATIVE_INPUT,
                                                      .limits_normally_closed = normally_closed,
                                                      .home_normally_closed = normally_closed};
}

/* The motor stands at `position` (counts), and the axis is in Standstill. */
static void begin_at(int32_t position)
{
    bus.state = READY_TO_SWITCH_ON;
    bus.error_code = 0;
    bench_create();
    bus.position = before = position;
    bus.world = world;
    bench_cycles(3);
    bench_enable();
    bench_forget_steps();
}

static cm1e_homing_step_t step;

static cm1e_axis_command_t command_of(double velocity, double position)
{
    return (cm1e_axis_command_t){.kind = CM1E_COMMAND_HOMING_STEP, .velocity = velocity, .position = position,
                                 .step = &step};
}

static cm1e_command_id_t start(double velocity, double position)
{
    const cm1e_axis_command_t command = command_of(velocity, position);
    return bench_start_command(&command);
}

static cm1e_error_t refusal(double velocity, double position)
{
    const cm1e_axis_command_t command = command_of(velocity, position);
    const cm1e_axis_info_t was = bench_info();
    cm1e_command_id_t id = 99;
    const cm1e_error_t error = cm1e_axis_start(axis, &command, &id);
    const cm1e_axis_info_t is = bench_info();
    TEST_ASSERT_EQUAL_UINT32(0, id);
    TEST_ASSERT_EQUAL_INT(was.state, is.state);
    TEST_ASSERT_EQUAL_DOUBLE(was.set_position, is.set_position);
    TEST_ASSERT_EQUAL(was.homed, is.homed);
    return error;
}

static void expect(cm1e_command_id_t id, cm1e_command_state_t state, cm1e_error_t error)
{
    const cm1e_command_status_t status = cm1e_axis_command_status(axis, id);
    TEST_ASSERT_EQUAL_INT_MESSAGE(state, status.state, cm1e_strerror(status.error));
    TEST_ASSERT_EQUAL_STRING(cm1e_strerror(error), cm1e_strerror(status.error));
}

/* The set-point kept the limits of the axis: 5,000,000 counts/s2, and the velocity. */
static void expect_smooth(double velocity)
{
    TEST_ASSERT_LESS_OR_EQUAL_INT64((int64_t)(velocity * 50.0) + 1, worst_step);
    TEST_ASSERT_LESS_OR_EQUAL_INT64(6, worst_change);
}

static void expect_standing(void)
{
    bench_cycles(2);
    const int32_t position = bus.position;
    bench_cycles(20);
    TEST_ASSERT_EQUAL_INT32(position, bus.position);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, bench_info().set_velocity);
    TEST_ASSERT_INT32_WITHIN(20, bus.position, bus.target_position); /* nothing that pushes */
}

/* `counts` of the shaft are called `units` now, but for half the way of a cycle. */
static void expect_called(int32_t counts, double units, double velocity)
{
    const double called = bench_info().actual_position - (double)(bus.position - counts) / 50000.0;
    TEST_ASSERT_DOUBLE_WITHIN(velocity * 0.0005 + 1.01 / 50000.0, units, called);
}

void setUp(void)
{
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    switch_there = limits_there = stops_there = true;
    configure(false);
    step = (cm1e_homing_step_t){0};
}

void tearDown(void) { bench_end(); }

/* ---- absolute switch --------------------------------------------------------------------------------------------- */

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

/* Without a switch each limit switch is met once, then the search gives up. */
static void test_switch_that_is_not_there_ends_at_the_second_limit_switch(void)
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

/* ---- block ------------------------------------------------------------------------------------------------------- */

static cm1e_homing_step_t block(int sign, double torque)
{
    return (cm1e_homing_step_t){.kind = CM1E_STEP_BLOCK, .torque_limit = torque,
                                .direction = sign > 0 ? mcPositiveDirection : mcNegativeDirection};
}

static void find_block(int sign, double torque, int32_t from)
{
    step = block(sign, torque);
    begin_at(from);
    const cm1e_command_id_t id = start(0.2, sign * 3.0);
    bench_wait(id, 20000);
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
    expect_called(sign * STOP, sign * 3.0, 0.0);
    expect_smooth(0.2);
    expect_standing(); /* with the set-point where the motor is: it no longer pushes */
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_HOMING, bench_info().state);
}

static void test_block_by_torque_and_by_lag_from_afar_and_from_the_stop_itself(void)
{
    limits_there = false;
    for (int sign = -1; sign <= 1; sign += 2) {
        find_block(sign, 30.0, 0);
        find_block(sign, 30.0, sign * STOP);
        find_block(sign, 0.0, 0);
        find_block(sign, 0.0, sign * STOP);
    }
}

/* The set-point stops soon after the torque limit: the force does not grow while the time passes. */
static void test_block_presses_no_harder_than_the_torque_limit_and_the_ramp_need(void)
{
    limits_there = false;
    step = block(1, 20.0);
    step.detection_ns = 500 * MS_IN_NS;
    begin_at(59000);
    const cm1e_command_id_t id = start(0.2, 0.0);
    int most = 0;
    while (bench_state_of(id) == CM1E_COMMAND_ACTIVE) {
        bench_cycles(1);
        most = bus.torque > most ? bus.torque : most;
    }
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
    TEST_ASSERT_GREATER_OR_EQUAL_INT(200, most);
    TEST_ASSERT_LESS_OR_EQUAL_INT(200 + 150, most); /* 10 counts a cycle for the cycles that stopping takes */
}

static bool gives_way;

static void soft_world(cm1e_bus_t *b)
{
    world(b);
    const bool held = !gives_way && b->target_position > 20000;
    if (held) {
        b->position = 20000;
        b->velocity_raw = 0;
        b->torque = 500;
    }
}

/* Something that gives way before the time is over is no stop. */
static void test_block_goes_on_when_the_motor_comes_free(void)
{
    limits_there = false;
    gives_way = false;
    step = block(1, 30.0);
    step.detection_ns = 200 * MS_IN_NS;
    begin_at(19000);
    bus.world = soft_world;
    const cm1e_command_id_t id = start(0.2, 0.0);
    while (bus.torque < 500)
        bench_cycles(1);
    bench_cycles(100);
    gives_way = true;
    bench_wait(id, 20000);
    gives_way = false;
    bus.world = world;
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
    expect_called(STOP, 0.0, 0.0);
}

enum { COMES_FREE, MC_STOP, DIRECTION_OFF, OTHER_STEP, TAKE_OVERS };

static void take_over(int how)
{
    if (how == COMES_FREE) {
        gives_way = true;
    } else if (how == MC_STOP) {
        cm1e_axis_hold_stop(axis, bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP}), false);
    } else if (how == DIRECTION_OFF) {
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_power(axis, &owner, true, false, true));
    } else {
        step = (cm1e_homing_step_t){.mode = mcRisingEdge};
        start(0.2, 0.0);
    }
}

/* A set-point that presses has no limit of jerk. What takes over, at the axis's jerk, does not take its acceleration
 * along: to take that back would need a velocity far beyond all limits. */
static void test_what_takes_over_from_pressing_does_not_run_away(void)
{
    limits_there = false;
    bus.config.axes[0].max_jerk = 20.0;
    for (int n = 0; n < 20 * TAKE_OVERS; n++) {
        gives_way = false;
        step = block(1, 30.0);
        begin_at(18000);
        bus.world = soft_world;
        start(0.2, 0.0);
        while (bus.torque < 500)
            bench_cycles(1);
        bench_cycles(n / TAKE_OVERS);
        take_over(n % TAKE_OVERS);
        bench_cycles(500);
        TEST_ASSERT_LESS_OR_EQUAL_INT64(11, worst_step); /* 0.2 u/s */
    }
}

static void test_block_ends_at_a_limit_switch(void)
{
    step = block(1, 30.0);
    begin_at(0);
    const cm1e_command_id_t id = start(0.2, 0.0);
    bench_wait(id, 20000);
    expect(id, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_STEP_LIMIT_SWITCH);
}

static int still_cycles;

/* Nothing is in the way of the motor. Friction catches it 30 counts short of a set-point that has come to rest, until
 * its controller has summed up enough to go there. */
static void sticky_world(cm1e_bus_t *b)
{
    static int32_t target_before_this;
    enum { SHORT = 30, CAUGHT_CYCLES = 12, PACE = 2 };
    const int32_t target = b->target_position, missing = target - before;
    still_cycles = target == target_before_this ? still_cycles + 1 : 0;
    target_before_this = target;
    if (still_cycles < CAUGHT_CYCLES)
        b->position = missing > SHORT ? target - SHORT : before;
    else
        b->position = missing > PACE ? before + PACE : target;
    world(b);
}

/* Cycles until the command has ended; the set-point never goes back. */
static void wait_for_the_motor(cm1e_command_id_t id)
{
    int32_t farthest = bus.target_position;
    for (int i = 0; i < 20000 && bench_state_of(id) == CM1E_COMMAND_ACTIVE; i++) {
        bench_cycles(1);
        TEST_ASSERT_GREATER_OR_EQUAL_INT32(farthest, bus.target_position);
        farthest = bus.target_position;
    }
    TEST_ASSERT_INT32_WITHIN(20, bus.target_position, bus.position);
    expect_smooth(0.5);
}

/* A motor that comes late is not held up: a step that gives up, and MC_Stop, wait for it instead of going back. */
static void test_free_motor_that_comes_late_is_waited_for_and_not_relieved(void)
{
    stops_there = false;
    step = block(1, 30.0);
    begin_at(0);
    bus.world = sticky_world;
    const cm1e_command_id_t id = start(0.5, 0.0);
    wait_for_the_motor(id);
    expect(id, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_STEP_LIMIT_SWITCH);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_HOMING, bench_info().state);

    begin_at(0);
    bus.world = sticky_world;
    start(0.5, 0.0);
    bench_cycles(500);
    const cm1e_command_id_t stop = bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP});
    cm1e_axis_hold_stop(axis, stop, false);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STOPPING, bench_info().state);
    wait_for_the_motor(stop);
    expect(stop, CM1E_COMMAND_DONE, CM1E_OK);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
}

/* No torque limit, and a lag so small that a free motor could have it: that the motor does not come shows the stop. */
static void test_motor_held_up_with_a_small_lag_is_relieved(void)
{
    switch_there = limits_there = false;
    step = (cm1e_homing_step_t){.mode = mcRisingEdge, .distance_limit = 0.022};
    begin_at(59000);
    const cm1e_command_id_t id = start(0.2, 0.0);
    int32_t most = 0;
    while (bench_state_of(id) == CM1E_COMMAND_ACTIVE) {
        bench_cycles(1);
        most = bus.target_position > most ? bus.target_position : most;
    }
    expect(id, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_STEP_DISTANCE);
    TEST_ASSERT_INT32_WITHIN(100, STOP + 120, most);
    expect_standing();
}

/* ---- limits of a step -------------------------------------------------------------------------------------------- */

static void expect_limit(cm1e_error_t error, double velocity)
{
    begin_at(-20000);
    const cm1e_command_id_t id = start(velocity, 0.0);
    bench_wait(id, 30000);
    expect(id, CM1E_COMMAND_ERROR, error);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_HOMING, bench_info().state);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, bench_info().error);
    TEST_ASSERT_FALSE(bench_info().homed);
    expect_smooth(velocity);
    expect_standing();
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, bus.position / 50000.0, bench_info().actual_position); /* nothing was set */
}

static void test_limits_of_time_distance_and_torque(void)
{
    switch_there = limits_there = stops_there = false;
    step = (cm1e_homing_step_t){.mode = mcRisingEdge, .time_limit_ns = 300 * MS_IN_NS};
    expect_limit(CM1E_ERROR_AXIS_STEP_TIME, 0.5);
    TEST_ASSERT_INT32_WITHIN(1500, -20000 + 7500, bus.position);

    step = (cm1e_homing_step_t){.mode = mcRisingEdge, .distance_limit = 0.3};
    expect_limit(CM1E_ERROR_AXIS_STEP_DISTANCE, 0.5);
    TEST_ASSERT_INT32_WITHIN(1000, -20000 + 15000, bus.position);

    step = (cm1e_homing_step_t){.mode = mcRisingEdge}; /* none given: the configured timeout */
    bus.config.axes[0].homing.timeout_s = 2.0;
    expect_limit(CM1E_ERROR_AXIS_STEP_TIME, 0.5);
    TEST_ASSERT_INT32_WITHIN(1500, -20000 + 50000, bus.position);

    bus.config.axes[0].homing.timeout_s = 10.0;
    stops_there = true; /* it runs into a stop, and does not go on pushing */
    step = (cm1e_homing_step_t){.mode = mcRisingEdge, .torque_limit = 25.0};
    expect_limit(CM1E_ERROR_AXIS_STEP_TORQUE, 0.5);
    TEST_ASSERT_INT32_WITHIN(50, STOP, bus.position);

    step = block(1, 90.0);
    step.time_limit_ns = 300 * MS_IN_NS;
    expect_limit(CM1E_ERROR_AXIS_STEP_TIME, 0.5);
    step = block(1, 90.0);
    step.distance_limit = 0.5;
    expect_limit(CM1E_ERROR_AXIS_STEP_DISTANCE, 0.5);
}

static void test_distance_counts_both_ways_together(void)
{
    switch_there = false;
    step = (cm1e_homing_step_t){.mode = mcRisingEdge, .distance_limit = 1.0};
    begin_at(20000); /* 0.4 u to the limit switch, and 0.6 u back */
    const cm1e_command_id_t id = start(0.5, 0.0);
    bench_wait(id, 30000);
    expect(id, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_STEP_DISTANCE);
    TEST_ASSERT_INT32_WITHIN(3000, 40000 - 30000, bus.position);
}

static void test_wrong_inputs_are_refused_and_change_nothing(void)
{
    begin_at(0);
    const struct {
        cm1e_homing_step_t step;
        double velocity, position;
        cm1e_error_t error;
    } wrong[] = {
        {{.mode = (MC_SWITCH_MODE)6}, 1.0, 0.0, CM1E_ERROR_AXIS_STEP_INPUT},
        {{.kind = CM1E_STEP_LIMIT_SWITCH, .mode = mcEdgeSwitchPositive}, 1.0, 0.0, CM1E_ERROR_AXIS_STEP_INPUT},
        {{.direction = mcShortestWay}, 1.0, 0.0, CM1E_ERROR_AXIS_DIRECTION},
        {{.direction = (MC_HOME_DIRECTION)8}, 1.0, 0.0, CM1E_ERROR_AXIS_DIRECTION},
        {{.kind = CM1E_STEP_BLOCK, .direction = mcSwitchPositive}, 1.0, 0.0, CM1E_ERROR_AXIS_DIRECTION},
        {{.kind = CM1E_STEP_LIMIT_SWITCH, .direction = mcSwitchNegative}, 1.0, 0.0, CM1E_ERROR_AXIS_DIRECTION},
        {{.input = 5}, 1.0, 0.0, CM1E_ERROR_AXIS_STEP_INPUT},
        {{.input = -1}, 1.0, 0.0, CM1E_ERROR_AXIS_STEP_INPUT},
        {{.torque_limit = -1.0}, 1.0, 0.0, CM1E_ERROR_AXIS_STEP_INPUT},
        {{.torque_limit = NAN}, 1.0, 0.0, CM1E_ERROR_AXIS_STEP_INPUT},
        {{.distance_limit = -1.0}, 1.0, 0.0, CM1E_ERROR_AXIS_STEP_INPUT},
        {{.distance_limit = INFINITY}, 1.0, 0.0, CM1E_ERROR_AXIS_STEP_INPUT},
        {{.time_limit_ns = -1}, 1.0, 0.0, CM1E_ERROR_AXIS_STEP_INPUT},
        {{.kind = CM1E_STEP_BLOCK, .detection_velocity = -1.0}, 1.0, 0.0, CM1E_ERROR_AXIS_STEP_INPUT},
        {{.kind = CM1E_STEP_BLOCK, .detection_ns = -1}, 1.0, 0.0, CM1E_ERROR_AXIS_STEP_INPUT},
        {{0}, 0.0, 0.0, CM1E_ERROR_AXIS_VELOCITY_RANGE},
        {{0}, -1.0, 0.0, CM1E_ERROR_AXIS_VELOCITY_RANGE},
        {{0}, 1000.0, 0.0, CM1E_ERROR_AXIS_VELOCITY_RANGE},
        {{0}, NAN, 0.0, CM1E_ERROR_AXIS_VELOCITY_RANGE},
        {{0}, 1.0, INFINITY, CM1E_ERROR_AXIS_POSITION_RANGE},
        {{0}, 1.0, 1e300, CM1E_ERROR_AXIS_POSITION_RANGE},
        {{.kind = CM1E_STEP_DIRECT}, 0.0, NAN, CM1E_ERROR_AXIS_POSITION_RANGE},
        {{.kind = CM1E_STEP_DIRECT}, 0.0, -INFINITY, CM1E_ERROR_AXIS_POSITION_RANGE},
        {{.kind = CM1E_STEP_FINISH}, 1.0, NAN, CM1E_ERROR_AXIS_POSITION_RANGE},
        {{.kind = CM1E_STEP_FINISH}, 1.0, 0.1, CM1E_ERROR_AXIS_STATE}, /* there is no homing to finish */
        {{.kind = (cm1e_homing_step_kind_t)5}, 1.0, 0.0, CM1E_ERROR_INVALID_ARGUMENT},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        step = wrong[i].step;
        TEST_ASSERT_EQUAL_STRING(cm1e_strerror(wrong[i].error),
                                 cm1e_strerror(refusal(wrong[i].velocity, wrong[i].position)));
    }
    const cm1e_axis_command_t none = {.kind = CM1E_COMMAND_HOMING_STEP, .velocity = 1.0};
    cm1e_command_id_t id;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, cm1e_axis_start(axis, &none, &id));
}

static void test_switches_that_are_not_configured_are_an_error(void)
{
    bus.config.axes[0].inputs = (cm1e_input_config_t){0};
    begin_at(0);
    step = (cm1e_homing_step_t){0};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_STEP_SWITCH, refusal(1.0, 0.0));
    for (int sign = -1; sign <= 1; sign += 2) {
        step = (cm1e_homing_step_t){.kind = CM1E_STEP_LIMIT_SWITCH,
                                    .direction = sign > 0 ? mcPositiveDirection : mcNegativeDirection};
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_STEP_SWITCH, refusal(1.0, 0.0));
    }
}

static void test_steps_are_refused_in_every_other_state(void)
{
    static const struct {
        cm1e_axis_state_t state;
        cm1e_error_t error;
    } states[] = {
        {CM1E_AXIS_DISABLED, CM1E_ERROR_AXIS_NOT_POWERED},  {CM1E_AXIS_DISCRETE_MOTION, CM1E_ERROR_AXIS_STATE},
        {CM1E_AXIS_CONTINUOUS_MOTION, CM1E_ERROR_AXIS_STATE}, {CM1E_AXIS_STOPPING, CM1E_ERROR_AXIS_STOPPING},
        {CM1E_AXIS_ERROR_STOP, CM1E_ERROR_AXIS_ERROR_STOP},
    };
    begin_at(0);
    for (size_t i = 0; i < sizeof states / sizeof states[0]; i++)
        for (int kind = CM1E_STEP_ABSOLUTE_SWITCH; kind <= CM1E_STEP_FINISH; kind++) {
            axis->state = states[i].state;
            step = (cm1e_homing_step_t){.kind = (cm1e_homing_step_kind_t)kind};
            TEST_ASSERT_EQUAL_STRING(cm1e_strerror(states[i].error), cm1e_strerror(refusal(1.0, 0.0)));
        }
    axis->state = CM1E_AXIS_HOMING; /* the drive's own homing is under way */
    axis->setpoint.source = &cm1e_source_homing;
    step = (cm1e_homing_step_t){.kind = CM1E_STEP_DIRECT};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_HOMING, refusal(1.0, 0.0));
}

/* ---- the end of a homing ----------------------------------------------------------------------------------------- */

static void find_left_flank(double set_position)
{
    step = (cm1e_homing_step_t){.mode = mcRisingEdge};
    const cm1e_command_id_t id = start(1.0, set_position);
    bench_wait(id, 20000);
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
}

static void test_finish_moves_away_and_ends_in_standstill_homed(void)
{
    begin_at(-20000);
    find_left_flank(0.0);
    TEST_ASSERT_FALSE(bench_info().homed);
    const double from = bench_info().set_position;
    step = (cm1e_homing_step_t){.kind = CM1E_STEP_FINISH};
    const cm1e_command_id_t id = start(0.5, -0.75);
    bench_wait(id, 20000);
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_TRUE(bench_info().homed);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, from - 0.75, bench_info().set_position);
    expect_called(LEFT_FLANK, 0.0, 1.0);
    bench_wait(bench_move_to(0.25, 1.0), 10000); /* and moves are taken again */
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.25, bench_info().set_position);
}

static void test_finish_in_the_middle_of_a_search_stops_smoothly_and_is_not_homed(void)
{
    begin_at(-30000);
    find_left_flank(0.0);
    step = (cm1e_homing_step_t){.mode = mcFallingEdge};
    const cm1e_command_id_t search = start(1.0, 0.0);
    bench_cycles(40);
    step = (cm1e_homing_step_t){.kind = CM1E_STEP_FINISH};
    const cm1e_command_id_t id = start(0.0, 0.0);
    expect(search, CM1E_COMMAND_ABORTED, CM1E_OK);
    bench_wait(id, 1000);
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_FALSE(bench_info().homed); /* what the last step was to find it did not */
    expect_smooth(1.0);
    expect_standing();
}

static void test_direct_sets_the_position_without_motion_and_ends_the_homing(void)
{
    begin_at(12345);
    step = (cm1e_homing_step_t){.kind = CM1E_STEP_DIRECT};
    cm1e_command_id_t id = start(0.0, 100.0);
    bench_wait(id, 10);
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_TRUE(bench_info().homed);
    TEST_ASSERT_EQUAL_DOUBLE(100.0, bench_info().set_position);
    TEST_ASSERT_EQUAL_INT32(12345, bus.position);
    TEST_ASSERT_EQUAL_INT64(0, worst_step);

    step = (cm1e_homing_step_t){.mode = mcRisingEdge}; /* in the middle of a search it stops first */
    const cm1e_command_id_t search = start(1.0, 0.0);
    TEST_ASSERT_FALSE(bench_info().homed);
    bench_cycles(50);
    step = (cm1e_homing_step_t){.kind = CM1E_STEP_DIRECT};
    id = start(0.0, -2.0);
    expect(search, CM1E_COMMAND_ABORTED, CM1E_OK);
    bench_wait(id, 1000);
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
    TEST_ASSERT_EQUAL_DOUBLE(-2.0, bench_info().set_position);
    TEST_ASSERT_TRUE(bench_info().homed);
    expect_smooth(1.0);
}

static void test_step_over_a_running_step_takes_over_smoothly(void)
{
    begin_at(-20000);
    step = (cm1e_homing_step_t){.mode = mcRisingEdge};
    const cm1e_command_id_t first = start(1.0, 0.0);
    bench_cycles(100);
    step = (cm1e_homing_step_t){.kind = CM1E_STEP_LIMIT_SWITCH, .direction = mcNegativeDirection};
    const cm1e_command_id_t second = start(0.6, -1.0);
    expect(first, CM1E_COMMAND_ABORTED, CM1E_OK);
    bench_wait(second, 20000);
    expect(second, CM1E_COMMAND_DONE, CM1E_OK);
    expect_called(-LIMIT_SWITCH, -1.0, 0.6);
    expect_smooth(1.0);
}

static cm1e_command_id_t buffer(cm1e_homing_step_t what, double velocity, double position)
{
    cm1e_axis_command_t command = command_of(velocity, position);
    step = what;
    command.buffer_mode = mcBuffered;
    return bench_start_command(&command);
}

static void test_a_whole_homing_may_wait_in_the_buffer(void)
{
    begin_at(-30000);
    const cm1e_command_id_t move = bench_move_to(-0.5, 1.0);
    const cm1e_command_id_t ids[] = {
        buffer((cm1e_homing_step_t){.mode = mcRisingEdge}, 1.0, 5.0),
        buffer((cm1e_homing_step_t){.mode = mcFallingEdge, .direction = mcSwitchNegative}, 0.1, 0.0),
        buffer((cm1e_homing_step_t){.kind = CM1E_STEP_FINISH}, 0.5, 0.25),
    };
    cm1e_axis_command_t one_more = command_of(1.0, 0.0);
    one_more.buffer_mode = mcBuffered;
    cm1e_command_id_t id;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FULL, cm1e_axis_start(axis, &one_more, &id));
    const cm1e_command_id_t last = bench_start_command(&(cm1e_axis_command_t){
        .kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = 1.0, .velocity = 1.0, .buffer_mode = mcBuffered});
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_BUFFERED, bench_state_of(ids[0]));
    bench_wait(move, 20000);
    for (size_t i = 0; i < sizeof ids / sizeof ids[0]; i++) {
        bench_wait(ids[i], 20000);
        expect(ids[i], CM1E_COMMAND_DONE, CM1E_OK);
    }
    TEST_ASSERT_TRUE(bench_info().homed);
    expect_called(LEFT_FLANK, 0.0, 0.1);
    bench_wait(last, 20000);
    expect(last, CM1E_COMMAND_DONE, CM1E_OK);
    TEST_ASSERT_EQUAL_DOUBLE(1.0, bench_info().set_position);
    expect_smooth(1.0);
}

static void test_what_waits_behind_a_step_that_fails_is_aborted(void)
{
    switch_there = false;
    begin_at(0);
    step = (cm1e_homing_step_t){.mode = mcRisingEdge, .distance_limit = 0.2};
    const cm1e_command_id_t search = start(1.0, 0.0);
    const cm1e_command_id_t next = buffer((cm1e_homing_step_t){.kind = CM1E_STEP_FINISH}, 1.0, 1.0);
    bench_wait(search, 20000);
    expect(search, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_STEP_DISTANCE);
    expect(next, CM1E_COMMAND_ABORTED, CM1E_OK);
    expect_standing();
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_HOMING, bench_info().state);
}

static void test_blending_with_a_step_is_refused_and_a_move_that_blends_behind_one_waits(void)
{
    begin_at(-20000);
    cm1e_axis_command_t command = command_of(1.0, 0.0);
    cm1e_command_id_t id;
    for (int mode = mcBlendingLow; mode <= mcBlendingHigh; mode++) {
        command.buffer_mode = (MC_BUFFER_MODE)mode;
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_BUFFER_MODE, cm1e_axis_start(axis, &command, &id));
    }
    step = (cm1e_homing_step_t){.mode = mcRisingEdge};
    const cm1e_command_id_t search = start(1.0, 0.0);
    bench_cycles(20);
    const cm1e_command_id_t move = bench_start_command(&(cm1e_axis_command_t){
        .kind = CM1E_COMMAND_MOVE_RELATIVE, .position = 1.0, .velocity = 1.0, .buffer_mode = mcBlendingHigh});
    bench_wait(search, 20000);
    expect(search, CM1E_COMMAND_DONE, CM1E_OK);
    bench_cycles(3);
    expect(move, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_HOMING); /* a step ends in Homing: no move begins there */
    expect_smooth(1.0);
}

static void test_homing_takes_no_move_between_its_steps(void)
{
    begin_at(-20000);
    find_left_flank(0.0);
    for (int kind = CM1E_COMMAND_MOVE_ABSOLUTE; kind <= CM1E_COMMAND_HOME; kind++) {
        if (kind == CM1E_COMMAND_STOP)
            continue;
        cm1e_command_id_t id;
        const cm1e_axis_command_t move = {.kind = (cm1e_command_kind_t)kind, .velocity = 1.0, .position = 1.0};
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_HOMING, cm1e_axis_start(axis, &move, &id));
    }
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_HOMING, bench_info().state);
}

/* Positions mean nothing before the reference is found: the way to it may lead out of the software limits, the move of
 * MC_FinishHoming not. */
static void test_software_limits_hold_for_the_last_move_only(void)
{
    bus.config.axes[0].software_limit_positive = 0.1;
    bus.config.axes[0].software_limit_negative = -0.35;
    begin_at(-17000); /* -0.34 u */
    step = (cm1e_homing_step_t){.kind = CM1E_STEP_LIMIT_SWITCH};
    const cm1e_command_id_t id = start(0.5, 0.0);
    bench_wait(id, 20000);
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
    expect_called(LIMIT_SWITCH, 0.0, 0.5);
    step = (cm1e_homing_step_t){.kind = CM1E_STEP_FINISH};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, refusal(0.5, -0.5));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_POSITION_RANGE, refusal(0.5, 0.2));
    const cm1e_command_id_t last = start(0.5, -0.2);
    bench_wait(last, 20000);
    expect(last, CM1E_COMMAND_DONE, CM1E_OK);
}

/* ---- interruptions, at every cycle of a sequence ----------------------------------------------------------------- */

/* The sequence: the switch by way of a limit switch, the stop, a move away. Ends with the last command. */
static cm1e_command_id_t sequence_id;
static int sequence_step;

static void sequence_next(void)
{
    static const cm1e_homing_step_t steps[] = {
        {.kind = CM1E_STEP_ABSOLUTE_SWITCH, .mode = mcFallingEdge},
        {.kind = CM1E_STEP_BLOCK, .direction = mcNegativeDirection, .torque_limit = 20.0},
        {.kind = CM1E_STEP_FINISH},
    };
    if (sequence_step > 0 && bench_state_of(sequence_id) != CM1E_COMMAND_DONE)
        return;
    if (sequence_step == 3)
        return;
    if (sequence_step == 1)
        limits_there = false; /* so that the stop is reached */
    step = steps[sequence_step];
    sequence_id = start(1.5, sequence_step == 2 ? 0.2 : -1.0);
    sequence_step++;
}

static bool sequence_done(void) { return sequence_step == 3 && bench_state_of(sequence_id) == CM1E_COMMAND_DONE; }

/* `n` cycles of the sequence from its beginning; FALSE: it is shorter. */
static bool sequence_until(int n)
{
    limits_there = true;
    begin_at(30000);
    sequence_step = 0;
    sequence_next();
    for (int i = 0; i < n; i++) {
        bench_cycles(1);
        sequence_next();
        if (sequence_done())
            return false;
    }
    return true;
}

enum { STRIDE = 3 }; /* of the cycles that are interrupted */
/* 1.5 u/s brakes within 0.1 s. */
static const int32_t braking_counts = 7500;

static void settle(int at_most, cm1e_axis_state_t state, int32_t from)
{
    for (int i = 0; i < at_most && bench_info().state != state; i++)
        bench_cycles(1);
    TEST_ASSERT_EQUAL_STRING(cm1e_axis_state_name(state), cm1e_axis_state_name(bench_info().state));
    TEST_ASSERT_INT32_WITHIN(braking_counts, from, bus.position);
}

static void test_mc_stop_at_every_cycle(void)
{
    int n = 0;
    for (; sequence_until(n); n += STRIDE) {
        const int32_t from = bus.position;
        const cm1e_command_id_t running = sequence_id;
        const bool was_active = bench_state_of(running) == CM1E_COMMAND_ACTIVE;
        const cm1e_command_id_t stop = bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP});
        if (was_active)
            expect(running, CM1E_COMMAND_ABORTED, CM1E_OK);
        cm1e_axis_hold_stop(axis, stop, false);
        settle(2000, CM1E_AXIS_STANDSTILL, from);
        expect(stop, CM1E_COMMAND_DONE, CM1E_OK);
        expect_standing(); /* and does not push */
        TEST_ASSERT_FALSE(bench_info().homed);
    }
    TEST_ASSERT_GREATER_THAN_INT(1000, n);
    TEST_ASSERT_TRUE(bench_info().homed); /* the sequence itself was right */
}

/* Power that comes back within the ramp, before the torque was gone: the motor is relieved with it, and a later MC_Stop
 * has nothing to take back. */
static void test_power_back_within_the_ramp_relieves_the_motor(void)
{
    for (int gap = 1; gap <= 40; gap++) {
        limits_there = false;
        step = block(1, 60.0);
        step.detection_ns = 5000 * MS_IN_NS;
        begin_at(59000);
        start(0.2, 0.0);
        for (int i = 0; i < 2000 && bus.torque < 300; i++)
            bench_cycles(1);
        TEST_ASSERT_GREATER_OR_EQUAL_INT(300, bus.torque);
        bench_power(false);
        bench_cycles(gap);
        bench_power(true);
        bench_cycles(50); /* of the ramp, and of a drive that is being disabled meanwhile */
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
        expect_standing();
        const int32_t target = bus.target_position;
        cm1e_axis_hold_stop(axis, bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_STOP}), false);
        bench_cycles(200);
        TEST_ASSERT_EQUAL_INT32(target, bus.target_position);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
        bench_end();
        configure(false);
    }
}

/* What a stop had to relieve is forgotten without torque: a later MC_Stop is one as any other. */
static void test_power_off_while_a_stop_relieves_leaves_nothing_behind(void)
{
    limits_there = false;
    step = block(1, 30.0);
    step.detection_ns = 5000 * MS_IN_NS;
    begin_at(59000);
    start(0.2, 0.0);
    for (int i = 0; i < 2000 && bus.torque < 300; i++)
        bench_cycles(1);
    TEST_ASSERT_GREATER_OR_EQUAL_INT(300, bus.torque);
    const cm1e_axis_command_t stop = {.kind = CM1E_COMMAND_STOP};
    cm1e_axis_hold_stop(axis, bench_start_command(&stop), false);
    for (int i = 0; i < 200 && !axis->homing_step.after_stop; i++)
        bench_cycles(1);
    TEST_ASSERT_TRUE(axis->homing_step.after_stop);
    bench_power(false);
    bench_cycles(200);
    stops_there = false;
    bench_enable();
    const cm1e_command_id_t move = bench_move_velocity(-1.0);
    bench_cycles(500);
    expect(move, CM1E_COMMAND_ACTIVE, CM1E_OK);
    const cm1e_axis_command_t gentle = {.kind = CM1E_COMMAND_STOP, .deceleration = 1.0};
    const cm1e_command_id_t later = bench_start_command(&gentle);
    cm1e_axis_hold_stop(axis, later, false);
    bench_cycles(500); /* of the second that it takes */
    TEST_ASSERT_DOUBLE_WITHIN(0.05, -0.5, bench_info().set_velocity);
    bench_cycles(700);
    expect(later, CM1E_COMMAND_DONE, CM1E_OK);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
}

static void test_power_off_at_every_cycle(void)
{
    for (int n = 0; sequence_until(n); n += STRIDE) {
        const int32_t from = bus.position;
        bench_power(false);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISABLED, bench_info().state);
        expect(sequence_id, CM1E_COMMAND_ABORTED, CM1E_OK);
        for (int i = 0; i < 500 && bus.state == OPERATION_ENABLED; i++)
            bench_cycles(1);
        TEST_ASSERT_NOT_EQUAL_INT(OPERATION_ENABLED, bus.state);
        settle(0, CM1E_AXIS_DISABLED, from);
        TEST_ASSERT_FALSE(bench_info().homed);
    }
}

/* A step that goes, or is to go, where it may not any more gives up; any other goes on. */
static void test_direction_disabled_at_every_cycle(void)
{
    for (int positive = 0; positive <= 1; positive++)
        for (int n = 0; sequence_until(n); n += STRIDE) {
            const int32_t from = bus.position;
            TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_power(axis, &owner, true, positive, !positive));
            const int allowed = positive ? 1 : -1;
            bench_wait(sequence_id, 5000);
            const cm1e_command_status_t status = cm1e_axis_command_status(axis, sequence_id);
            if (status.state == CM1E_COMMAND_ERROR)
                TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_DIRECTION_DISABLED, status.error);
            else
                TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, status.state);
            /* Against the enabled direction it went no farther than its braking, or than pressing needs to relax. */
            TEST_ASSERT_LESS_OR_EQUAL_INT(braking_counts, (from - bus.position) * allowed);
            expect_standing();
        }
}

static void test_bus_lost_at_every_cycle(void)
{
    for (int n = 0; sequence_until(n); n += STRIDE) {
        const int32_t from = bus.position;
        const bool was_active = bench_state_of(sequence_id) == CM1E_COMMAND_ACTIVE;
        received = health = CM1E_ERROR_BUS_LOST;
        bench_cycles(1);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
        if (was_active)
            expect(sequence_id, CM1E_COMMAND_ERROR, CM1E_ERROR_AXIS_ERROR_STOP);
        for (int i = 0; i < 500 && bus.state == OPERATION_ENABLED; i++)
            bench_cycles(1);
        TEST_ASSERT_NOT_EQUAL_INT(OPERATION_ENABLED, bus.state);
        settle(0, CM1E_AXIS_ERROR_STOP, from);
        TEST_ASSERT_FALSE(bench_info().homed);
    }
}

static void test_drive_fault_at_every_cycle(void)
{
    for (int n = 0; sequence_until(n); n += STRIDE) {
        fake_bus_fault(&bus, 0x2310);
        const int32_t from = bus.position;
        bench_cycles(3);
        settle(0, CM1E_AXIS_ERROR_STOP, from);
        TEST_ASSERT_FALSE(bench_info().homed);
        TEST_ASSERT_TRUE(axis_free(axis));
    }
}

/* Cycles without inputs while the axes still run (fewer than the limit of lost cycles): nothing is found in them, and
 * what lies between two looks is halved all the same. */
static void test_missing_inputs_widen_the_error_and_nothing_else(void)
{
    for (int gap = 1; gap <= 2; gap++) {
        begin_at(-20000);
        step = (cm1e_homing_step_t){.mode = mcRisingEdge};
        const cm1e_command_id_t id = start(1.0, 0.0);
        for (int i = 0; i < 15000 && bench_state_of(id) == CM1E_COMMAND_ACTIVE; i++) { /* time stands meanwhile */
            received = i % 3 < gap ? CM1E_ERROR_BUS_LOST : CM1E_OK;
            bench_cycles(1);
        }
        received = CM1E_OK;
        bench_cycles(2);
        expect(id, CM1E_COMMAND_DONE, CM1E_OK);
        expect_called(LEFT_FLANK, 0.0, 1.0 * (gap + 1));
    }
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
    RUN_TEST(test_switch_that_is_not_there_ends_at_the_second_limit_switch);
    RUN_TEST(test_limit_switch_in_every_mode_direction_and_place);
    RUN_TEST(test_limit_switch_step_between_two_active_switches_gives_up);
    RUN_TEST(test_block_by_torque_and_by_lag_from_afar_and_from_the_stop_itself);
    RUN_TEST(test_block_presses_no_harder_than_the_torque_limit_and_the_ramp_need);
    RUN_TEST(test_block_goes_on_when_the_motor_comes_free);
    RUN_TEST(test_what_takes_over_from_pressing_does_not_run_away);
    RUN_TEST(test_block_ends_at_a_limit_switch);
    RUN_TEST(test_free_motor_that_comes_late_is_waited_for_and_not_relieved);
    RUN_TEST(test_motor_held_up_with_a_small_lag_is_relieved);
    RUN_TEST(test_limits_of_time_distance_and_torque);
    RUN_TEST(test_distance_counts_both_ways_together);
    RUN_TEST(test_wrong_inputs_are_refused_and_change_nothing);
    RUN_TEST(test_switches_that_are_not_configured_are_an_error);
    RUN_TEST(test_steps_are_refused_in_every_other_state);
    RUN_TEST(test_finish_moves_away_and_ends_in_standstill_homed);
    RUN_TEST(test_finish_in_the_middle_of_a_search_stops_smoothly_and_is_not_homed);
    RUN_TEST(test_direct_sets_the_position_without_motion_and_ends_the_homing);
    RUN_TEST(test_step_over_a_running_step_takes_over_smoothly);
    RUN_TEST(test_a_whole_homing_may_wait_in_the_buffer);
    RUN_TEST(test_what_waits_behind_a_step_that_fails_is_aborted);
    RUN_TEST(test_blending_with_a_step_is_refused_and_a_move_that_blends_behind_one_waits);
    RUN_TEST(test_homing_takes_no_move_between_its_steps);
    RUN_TEST(test_software_limits_hold_for_the_last_move_only);
    RUN_TEST(test_mc_stop_at_every_cycle);
    RUN_TEST(test_power_back_within_the_ramp_relieves_the_motor);
    RUN_TEST(test_power_off_while_a_stop_relieves_leaves_nothing_behind);
    RUN_TEST(test_power_off_at_every_cycle);
    RUN_TEST(test_direction_disabled_at_every_cycle);
    RUN_TEST(test_bus_lost_at_every_cycle);
    RUN_TEST(test_drive_fault_at_every_cycle);
    RUN_TEST(test_missing_inputs_widen_the_error_and_nothing_else);
    return UNITY_END();
}
