/* A device and programs that do anything: states, commands and set-points stay what standard and limits allow. */
#include <math.h>

#include "axis/axis_parameters.h"

#include "../support/axis_bench.h"
#include "../support/seeds.h"
#include "../support/xorshift.h"

static uint64_t seed;
static unsigned number; /* of the run, from which the seed is made */

void setUp(void) {}
void tearDown(void)
{
    if (Unity.CurrentTestFailed)
        printf("it was seed %u\n", number);
    bench_end();
}

static uint32_t draw(uint32_t below)
{
    return (uint32_t)(xorshift(&seed) >> 33) % below;
}

static double wild(double size)
{
    static const double special[] = {0.0, -0.0, NAN, INFINITY, -INFINITY, 1e300, -1e300, 1e-300, 1e15, -1e15};
    if (draw(12) == 0)
        return special[draw(10)];
    return size * ((double)draw(2000001) / 1e6 - 1.0);
}

static double positive(double size) { return draw(3) ? fabs(wild(size)) : 0.0; }

/* ---- the device -------------------------------------------------------------------------------------------------- */

static void device(void)
{
    if (draw(400) == 0)
        fake_bus_fault(&bus, cm1e_device_errors[draw((uint32_t)cm1e_device_error_count)].code);
    if (draw(300) == 0)
        bus.power = draw(4) > 0;
    if (draw(500) == 0)
        bus.frozen = draw(4) == 0;
    if (draw(500) == 0)
        bus.position = (int32_t)draw(UINT32_MAX);
    if (draw(500) == 0)
        bus.watch = (cm1e_slave_watch_t){.al_state = draw(2) ? CM1E_AL_OP : (uint16_t)draw(32), .lost = draw(4) == 0};
    else if (draw(80) == 0)
        bus.watch = (cm1e_slave_watch_t){.al_state = CM1E_AL_OP};
    if (draw(150) == 0)
        bus.digital_inputs = (uint16_t)draw(16);
    if (draw(100) == 0)
        bus.torque = (int16_t)((int)draw(2500) - 1250);
    bus.mode_status = (uint16_t)(draw(8) << 10 & 0x3400);
    bus.sdo_abort_index = draw(30) ? 0 : 0x6099;
    bus.sdo_full = draw(10) == 0;
    bus.sdo_delay = draw(20);
    received = draw(15) ? CM1E_OK : CM1E_ERROR_BUS_LOST;
    if (draw(400) == 0)
        health = CM1E_ERROR_BUS_WORKING_COUNTER;
    else if (draw(10) == 0)
        health = CM1E_OK;
}

/* ---- the programs ------------------------------------------------------------------------------------------------ */

enum { IDS = 16 };
static cm1e_command_id_t ids[IDS];
static cm1e_command_state_t states[IDS];
static bool on_top[IDS]; /* superimposed: active besides another one */

static void wild_pair(const void *reference, int index, TIME *delta_ns, LREAL *value)
{
    (void)reference;
    (void)index;
    *delta_ns = draw(30) ? (TIME)draw(500000000) : (TIME)draw(3) - 1;
    *value = wild(10.0);
}

static cm1e_homing_step_t wild_step(void)
{
    return (cm1e_homing_step_t){
        .kind = (cm1e_homing_step_kind_t)draw(6), .direction = (MC_HOME_DIRECTION)draw(9),
        .mode = (MC_SWITCH_MODE)draw(7), .input = draw(8) ? (int)draw(5) : (int)draw(9) - 3,
        .torque_limit = draw(2) ? 0.0 : wild(60.0), .distance_limit = draw(2) ? 0.0 : wild(20.0),
        .time_limit_ns = draw(10) ? (int64_t)draw(1000000000) : -1, .detection_velocity = positive(2.0),
        .detection_ns = (int64_t)draw(50000000),
    };
}

static void post(void)
{
    const cm1e_homing_step_t step = wild_step();
    const cm1e_axis_table_t table = {.read = wild_pair, .count = draw(10) ? (int)draw(12) : (int)draw(70),
                                     .absolute = draw(2), .time_scale = positive(5.0), .scale = positive(2.0),
                                     .offset = draw(2) ? 0.0 : wild(2.0)};
    const cm1e_homing_config_t homing = {.method = (int8_t)((int)draw(9) - 7), .velocity = positive(2.0),
                                         .torque = positive(90.0), .timeout_s = 0.3};
    const cm1e_axis_command_t command = {
        .kind = (cm1e_command_kind_t)draw(CM1E_COMMAND_KIND_COUNT), .position = wild(5.0),
        .end_velocity = wild(20.0), .velocity = draw(4) ? positive(40.0) : wild(60.0), .acceleration = positive(90.0),
        .deceleration = positive(90.0), .jerk = positive(1900.0), .direction = (MC_DIRECTION)draw(6),
        .buffer_mode = draw(3) ? mcAborting : (MC_BUFFER_MODE)draw(7), .homing = draw(2) ? &homing : NULL,
        .step = draw(50) ? &step : NULL, .table = draw(50) ? &table : NULL,
    };
    cm1e_command_id_t id;
    const cm1e_error_t error = cm1e_axis_start(axis, &command, &id);
    TEST_ASSERT_EQUAL_INT(error == CM1E_OK, id != 0);
    if (id) {
        ids[id % IDS] = id;
        on_top[id % IDS] = command.kind >= CM1E_COMMAND_MOVE_SUPERIMPOSED;
        states[id % IDS] = CM1E_COMMAND_BUFFERED;
    }
}

/* What moves nothing: coordinates, limits, maxima, the drive's objects. */
static void administrate(void)
{
    uint32_t ticket;
    double value;
    if (draw(100) == 0)
        (void)cm1e_axis_set_position(axis, wild(5.0), draw(2));
    if (draw(60) == 0)
        (void)cm1e_axis_write_parameter(axis, (int)draw(8), draw(2) ? wild(25.0) : (double)draw(2));
    if (draw(200) == 0) { /* a maximum, up to all of it */
        const int which = 9 + 2 * (int)draw(5);
        if (cm1e_axis_read_parameter(axis, which - 1, &value) == CM1E_OK)
            (void)cm1e_axis_write_parameter(axis, which, value * (double)(draw(12) + 5) / 16.0);
    }
    if (draw(150) == 0)
        (void)cm1e_axis_object_start(axis, 990 + (int)draw(800), draw(2), wild(100.0), &ticket);
}

static void programs(void)
{
    administrate();
    if (draw(25) == 0)
        post();
    if (draw(30) == 0)
        cm1e_axis_hold_stop(axis, ids[draw(IDS)], draw(4) == 0);
    if (draw(60) == 0)
        cm1e_axis_power(axis, draw(20) ? (void *)&owner : (void *)&number, draw(5) > 0, draw(8) > 0, draw(8) > 0);
    if (draw(80) == 0)
        cm1e_axis_reset(axis);
    if (draw(3000) == 0)
        (void)cm1e_axis_shut_down(axis);
}

/* ---- what must hold ---------------------------------------------------------------------------------------------- */

static const source_t *source_before;
static position_t set_before;

static void check_commands(void)
{
    int active = 0, moving_on_top = 0;
    for (int i = 0; i < IDS; i++) {
        if (!ids[i])
            continue;
        const cm1e_command_state_t state = cm1e_axis_command_status(axis, ids[i]).state;
        active += state == CM1E_COMMAND_ACTIVE && !on_top[i];
        moving_on_top += state == CM1E_COMMAND_ACTIVE && on_top[i];
        if (states[i] > CM1E_COMMAND_ACTIVE) /* what has ended stays as it ended */
            TEST_ASSERT_EQUAL_INT(states[i], state);
        TEST_ASSERT_TRUE(state >= states[i]); /* and what waits was not active */
        TEST_ASSERT_NOT_EQUAL_INT(CM1E_COMMAND_UNKNOWN, state);
        states[i] = state;
    }
    TEST_ASSERT_LESS_OR_EQUAL_INT(1, active);
    TEST_ASSERT_LESS_OR_EQUAL_INT(1, moving_on_top);
    const cm1e_axis_state_t state = axis->state;
    if (state == CM1E_AXIS_DISABLED || state == CM1E_AXIS_ERROR_STOP || state == CM1E_AXIS_STANDSTILL)
        TEST_ASSERT_EQUAL_INT(0, active + moving_on_top);
    if (state == CM1E_AXIS_CONTINUOUS_MOTION)
        TEST_ASSERT_EQUAL_INT(1, active);
}

static void check_axis(void)
{
    const cm1e_axis_info_t info = bench_info();
    TEST_ASSERT_LESS_THAN_INT(CM1E_AXIS_STATE_COUNT, info.state);
    TEST_ASSERT_NOT_EQUAL_INT(CM1E_AXIS_SYNCHRONIZED_MOTION, info.state);
    TEST_ASSERT_EQUAL_INT(info.state == CM1E_AXIS_ERROR_STOP, info.error != CM1E_OK);
    TEST_ASSERT_TRUE(isfinite(info.set_position) && isfinite(info.actual_position));
    TEST_ASSERT_TRUE(fabs(info.set_velocity) <= axis->limits.system.velocity + 1e-6);
    if (axis->position.modulo_range > 0.0) {
        TEST_ASSERT_TRUE(info.set_position >= 0.0 && info.set_position < axis->position.modulo_range);
        TEST_ASSERT_TRUE(info.actual_position >= 0.0 && info.actual_position < axis->position.modulo_range);
    }
    if (info.state == CM1E_AXIS_STANDSTILL)
        TEST_ASSERT_EQUAL_DOUBLE(0.0, info.set_velocity);
    const bool ours = axis_holds(axis) || axis_on_profile(axis);
    const bool was_ours = source_before == &cm1e_source_hold || source_before->find_stretch;
    /* A ramp of ErrorStop whose set-points were not heard begins anew where the motor is. */
    const bool anew = axis->state == CM1E_AXIS_ERROR_STOP &&
                      fabs(cm1e_position_minus(axis->setpoint.position, axis_actual(axis))) < 2501.0;
    if (ours && was_ours && !anew) /* peak speed: 2500 counts a cycle */
        TEST_ASSERT_TRUE(fabs(cm1e_position_minus(axis->setpoint.position, set_before)) < 2501.0);
    if (axis_free(axis)) {
        TEST_ASSERT_EQUAL_DOUBLE(0.0, cm1e_position_minus(axis->setpoint.position, axis_actual(axis)));
        TEST_ASSERT_TRUE(!axis->drive.command.enable || cm1e_axis_wants_enable(axis));
    }
    TEST_ASSERT_TRUE(axis->setpoint.position.fraction >= 0.0 && axis->setpoint.position.fraction < 1.0);
    TEST_ASSERT_EQUAL_INT32(axis->position.raw, (int32_t)(uint32_t)(uint64_t)axis->position.actual_counts);
    source_before = axis->setpoint.source;
    set_before = axis->setpoint.position;
}

static unsigned moving_cycles;

static void run(void)
{
    seed = UINT64_C(0x9E3779B97F4A7C15) * (number + 1);
    fake_bus_init(&bus, draw(2) ? CM1E_MAPPING_DYNAMIC : CM1E_MAPPING_CSP, (cm1e_pdo_order_t)draw(2),
                  (cm1e_firmware_t)draw(CM1E_FIRMWARE_COUNT));
    bus.config.axes[0].invert = draw(2);
    bus.config.axes[0].inputs = (cm1e_input_config_t){.limit_positive = (uint8_t)draw(2), .limit_negative = 2,
                                                      .home = 3, .limits_normally_closed = draw(2),
                                                      .home_normally_closed = draw(2)};
    bus.config.axes[0].table_profiles = draw(2);
    bus.config.axes[0].homing.method = -1;
    if (draw(3) == 0) {
        bus.config.axes[0].backlash = draw(2) ? 0.01 : 0.2;
        bus.config.axes[0].backlash_velocity = draw(2) ? 0.0 : 5.0;
    }
    if (draw(3) == 0) {
        bus.config.axes[0].modulo_range = draw(2) ? 1.0 / 3.0 : 2.5;
    } else if (draw(2)) {
        bus.config.axes[0].software_limit_negative = -20.0;
        bus.config.axes[0].software_limit_positive = 20.0;
    }
    if (bus.config.axes[0].mapping == CM1E_MAPPING_DYNAMIC && bus.config.axes[0].backlash == 0.0 && draw(3) == 0)
        bus.config.axes[0].motion = CM1E_MOTION_DRIVE;
    memset(ids, 0, sizeof ids);
    bench_create();
    bench_power(true);
    source_before = &cm1e_source_free;
    char text[400];
    for (int i = 0; i < 5000; i++) {
        device();
        bench_inputs();
        programs();
        bench_outputs();
        check_commands();
        check_axis();
        moving_cycles += axis_on_profile(axis) || axis->setpoint.source == &cm1e_source_drive;
        if (i % 100 == 0)
            cm1e_axis_error_text(cm1e_axis_reference(axis), text, sizeof text);
    }
}

static void test_anything_keeps_states_commands_and_set_points_legal(void)
{
    for (int i = 0; i < seeds_of(400); i++) {
        number = seed_of(i);
        run();
    }
    TEST_ASSERT_TRUE(seeds_given() || moving_cycles > 20000); /* else it was too wild to test anything */
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_anything_keeps_states_commands_and_set_points_legal);
    return UNITY_END();
}
