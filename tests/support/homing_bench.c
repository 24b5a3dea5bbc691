#include "homing_bench.h"

bool switch_there, limits_there, stops_there;
static bool closed_contacts;
int32_t before;

static bool between(int32_t position, int32_t from, int32_t to) { return position >= from && position < to; }

void world(cm1e_bus_t *b)
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

void configure(bool normally_closed)
{
    closed_contacts = normally_closed;
    bus.config.axes[0].inputs = (cm1e_input_config_t){.home = HOME_INPUT, .limit_positive = POSITIVE_INPUT,
                                                      .limit_negative = NEGATIVE_INPUT,
                                                      .limits_normally_closed = normally_closed,
                                                      .home_normally_closed = normally_closed};
}

void begin_at(int32_t position)
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

cm1e_homing_step_t step;

cm1e_axis_command_t command_of(double velocity, double position)
{
    return (cm1e_axis_command_t){.kind = CM1E_COMMAND_HOMING_STEP, .velocity = velocity, .position = position,
                                 .step = &step};
}

cm1e_command_id_t start(double velocity, double position)
{
    const cm1e_axis_command_t command = command_of(velocity, position);
    return bench_start_command(&command);
}

cm1e_error_t refusal(double velocity, double position)
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

void expect(cm1e_command_id_t id, cm1e_command_state_t state, cm1e_error_t error)
{
    const cm1e_command_status_t status = cm1e_axis_command_status(axis, id);
    TEST_ASSERT_EQUAL_INT_MESSAGE(state, status.state, cm1e_strerror(status.error));
    TEST_ASSERT_EQUAL_STRING(cm1e_strerror(error), cm1e_strerror(status.error));
}

void expect_smooth(double velocity)
{
    TEST_ASSERT_LESS_OR_EQUAL_INT64((int64_t)(velocity * 50.0) + 1, worst_step);
    TEST_ASSERT_LESS_OR_EQUAL_INT64(6, worst_change);
}

void expect_standing(void)
{
    bench_cycles(2);
    const int32_t position = bus.position;
    bench_cycles(20);
    TEST_ASSERT_EQUAL_INT32(position, bus.position);
    TEST_ASSERT_EQUAL_DOUBLE(0.0, bench_info().set_velocity);
    TEST_ASSERT_INT32_WITHIN(20, bus.position, bus.target_position); /* nothing that pushes */
}

void expect_called(int32_t counts, double units, double velocity)
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

cm1e_homing_step_t block(int sign, double torque)
{
    return (cm1e_homing_step_t){.kind = CM1E_STEP_BLOCK, .torque_limit = torque,
                                .direction = sign > 0 ? mcPositiveDirection : mcNegativeDirection};
}

void find_left_flank(double set_position)
{
    step = (cm1e_homing_step_t){.mode = mcRisingEdge};
    const cm1e_command_id_t id = start(1.0, set_position);
    bench_wait(id, 20000);
    expect(id, CM1E_COMMAND_DONE, CM1E_OK);
}
