/* Digital inputs, the output, switches, and what goes off when it is not renewed, on a fake bus. */
#include "axis/axis_signals.h"

#include "../support/axis_bench.h"

void setUp(void) { bench_start(); }
void tearDown(void) { bench_end(); }

static bool output_on_wire(void) { return bus.digital_outputs & 1; }

static void set_output(bool value)
{
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_write_output(axis, 1, value));
    bench_cycles(2);
    TEST_ASSERT_EQUAL_INT(value, output_on_wire());
}

static bool read_output(void)
{
    bool value;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_read_output(axis, 1, &value));
    return value;
}

/* ---- the output -------------------------------------------------------------------------------------------------- */

static void test_output_reaches_the_wire_without_torque(void)
{
    TEST_ASSERT_FALSE(read_output());
    set_output(true);
    TEST_ASSERT_TRUE(read_output());
    TEST_ASSERT_EQUAL_HEX16(1, bus.digital_outputs);
    set_output(false);
    TEST_ASSERT_FALSE(read_output());
}

static void test_other_outputs_do_not_exist_and_change_nothing(void)
{
    static const int numbers[] = {0, 2, 3, -1, 17, 33, INT32_MAX, INT32_MIN};
    set_output(true);
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        bool value = true;
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_SIGNAL, cm1e_axis_write_output(axis, numbers[i], false));
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_SIGNAL, cm1e_axis_hold_output(axis, numbers[i], false, 1));
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_SIGNAL, cm1e_axis_read_output(axis, numbers[i], &value));
        TEST_ASSERT_FALSE(value);
        bench_cycles(3);
        TEST_ASSERT_EQUAL_HEX16(1, bus.digital_outputs);
    }
}

static void test_output_stays_over_power_modes_and_error_stop(void)
{
    set_output(true);
    bench_enable();
    TEST_ASSERT_TRUE(output_on_wire());
    bus.config.axes[0].homing.method = -3;
    bench_start_command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOME});
    for (int i = 0; i < 200; i++) {
        bench_cycles(1);
        TEST_ASSERT_TRUE(output_on_wire());
    }
    TEST_ASSERT_EQUAL_INT(CM1E_MODE_HM, bus.mode);
    fake_bus_fault(&bus, 0x2310);
    bench_cycles(50);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    TEST_ASSERT_TRUE(output_on_wire());
    bench_power(false);
    bench_cycles(50);
    TEST_ASSERT_TRUE(output_on_wire());
}

static void test_output_of_a_slave_that_left_operational_stays_off(void)
{
    static const cm1e_slave_watch_t away[] = {
        {.lost = true, .al_state = CM1E_AL_OP}, {.al_state = CM1E_AL_SAFE_OP}, {.al_state = CM1E_AL_SAFE_OP | 0x10},
        {.al_state = CM1E_AL_INIT}};
    for (size_t i = 0; i < sizeof away / sizeof away[0]; i++) {
        set_output(true);
        bus.watch = away[i];
        bench_cycles(2);
        TEST_ASSERT_FALSE(output_on_wire());
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_OFFLINE, cm1e_axis_write_output(axis, 1, true));
        bus.watch = (cm1e_slave_watch_t){.al_state = CM1E_AL_OP};
        bench_cycles(5);
        TEST_ASSERT_FALSE(output_on_wire());
        TEST_ASSERT_FALSE(read_output());
    }
}

static void test_lost_frames_leave_the_output_alone(void)
{
    set_output(true);
    received = CM1E_ERROR_BUS_LOST;
    bench_cycles(2);
    received = CM1E_OK;
    bench_cycles(2);
    TEST_ASSERT_TRUE(output_on_wire());
}

static void test_shut_down_switches_the_output_off_when_the_torque_is_gone(void)
{
    bench_enable();
    set_output(true);
    bench_move_velocity(10.0);
    bench_cycles(300);
    bool down = false;
    int cycles = 0;
    while (!down && cycles++ < 2000) {
        bench_inputs();
        TEST_ASSERT_TRUE(output_on_wire() || bus.state != OPERATION_ENABLED); /* a brake does not fall on a motion */
        down = cm1e_axis_shut_down(axis);
        bench_outputs();
    }
    TEST_ASSERT_TRUE(down);
    TEST_ASSERT_EQUAL_UINT32(0, fake_output(&bus, OBJ_60FE_DIGITAL_OUTPUTS, 1)); /* in the last frame already */
}

static void test_held_output_goes_off_unless_it_is_renewed(void)
{
    for (int i = 0; i < 50; i++) {
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_hold_output(axis, 1, true, 10 * cycle_ns));
        bench_cycles(5);
        TEST_ASSERT_TRUE(output_on_wire());
    }
    bench_cycles(4);
    TEST_ASSERT_EQUAL_UINT32(1, fake_output(&bus, OBJ_60FE_DIGITAL_OUTPUTS, 0));
    bench_cycles(1);
    TEST_ASSERT_EQUAL_UINT32(0, fake_output(&bus, OBJ_60FE_DIGITAL_OUTPUTS, 1));
    bench_cycles(100);
    TEST_ASSERT_FALSE(output_on_wire());
    set_output(true); /* one that is written once stays */
    bench_cycles(3000);
    TEST_ASSERT_TRUE(output_on_wire());
}

static void without(cm1e_pdo_t *pdo, uint16_t index)
{
    for (unsigned i = 0; i < pdo->entry_count; i++)
        if (pdo->entries[i].index == index)
            pdo->entries[i].index = 0; /* a gap of the same size */
}

static void test_mapping_without_the_objects_is_told(void)
{
    bool value;
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.config.axes[0].inputs.home = 2;
    without(&bus.rx, OBJ_60FE_DIGITAL_OUTPUTS);
    without(&bus.tx, OBJ_60FD_DIGITAL_INPUTS);
    bench_create();
    uint32_t id = 7;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_PDO_MAPPING, cm1e_axis_write_output(axis, 1, true));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_PDO_MAPPING, cm1e_axis_read_output(axis, 1, &value));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_PDO_MAPPING, cm1e_axis_read_input(axis, 1, &value));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_PDO_MAPPING,
                          cm1e_axis_probe(axis, (cm1e_axis_trigger_t){.input = 1}, false, 0.0, 0.0, &id));
    TEST_ASSERT_EQUAL_UINT32(0, id);
    TEST_ASSERT_FALSE(cm1e_axis_has_switch(axis, CM1E_SWITCH_HOME));
    TEST_ASSERT_FALSE(cm1e_axis_switch_active(axis, CM1E_SWITCH_HOME));
}

/* Every mapping of the device, in both orders, has both objects. */
static void test_every_mapping_reaches_the_signals(void)
{
    for (int mapping = CM1E_MAPPING_DYNAMIC; mapping <= CM1E_MAPPING_PROFILE; mapping++)
        for (int order = 0; order < 2; order++) {
            bool value;
            fake_bus_init(&bus, (cm1e_mapping_t)mapping, (cm1e_pdo_order_t)order, CM1E_FIRMWARE_1_3_5);
            bench_create();
            bus.digital_inputs = 0x0008;
            set_output(true);
            TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_read_input(axis, 4, &value));
            TEST_ASSERT_TRUE(value);
        }
}

/* ---- inputs ------------------------------------------------------------------------------------------------------ */

static void test_every_input_shows_its_bit_alone(void)
{
    for (unsigned word = 0; word < 0x10; word++) {
        bus.digital_inputs = (uint16_t)(word | 0xFFF0); /* bits that the manual does not name count for nothing */
        bench_cycles(1);
        for (int n = -1; n <= 17; n++) {
            bool value = true;
            const cm1e_error_t error = cm1e_axis_read_input(axis, n, &value);
            TEST_ASSERT_EQUAL_INT(n >= 1 && n <= 4 ? CM1E_OK : CM1E_ERROR_AXIS_SIGNAL, error);
            TEST_ASSERT_EQUAL_INT(n >= 1 && n <= 4 && (word >> (n - 1) & 1), value);
        }
    }
}

static void test_old_inputs_are_told_as_old(void)
{
    bool value = false;
    bus.digital_inputs = 1;
    bench_cycles(1);
    bus.digital_inputs = 0;
    received = CM1E_ERROR_BUS_LOST;
    bench_cycles(1);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_OFFLINE, cm1e_axis_read_input(axis, 1, &value));
    TEST_ASSERT_TRUE(value);
    received = CM1E_OK;
    bench_cycles(1);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_read_input(axis, 1, &value));
    TEST_ASSERT_FALSE(value);
}

static void test_switches_are_where_the_configuration_says(void)
{
    for (unsigned setting = 0; setting < 5 * 5 * 4; setting++) {
        const cm1e_input_config_t inputs = {
            .limit_positive = (uint8_t)(setting % 5), .limit_negative = (uint8_t)((setting % 5 + 1) % 5),
            .home = (uint8_t)(setting / 5 % 5), .limits_normally_closed = setting / 25 & 1,
            .home_normally_closed = setting / 50 & 1};
        const int numbers[] = {inputs.limit_positive, inputs.limit_negative, inputs.home};
        bus.config.axes[0].inputs = inputs;
        for (unsigned word = 0; word < 0x10; word++) {
            bus.digital_inputs = (uint16_t)word;
            bench_cycles(1);
            for (int which = 0; which < CM1E_SWITCH_COUNT; which++) {
                const int number = numbers[which];
                const bool closed = which == CM1E_SWITCH_HOME ? inputs.home_normally_closed
                                                              : inputs.limits_normally_closed;
                const bool on = number && (word >> (number - 1) & 1);
                TEST_ASSERT_EQUAL_INT(number != 0, cm1e_axis_has_switch(axis, (cm1e_axis_switch_t)which));
                TEST_ASSERT_EQUAL_INT(number != 0 && on != closed,
                                      cm1e_axis_switch_active(axis, (cm1e_axis_switch_t)which));
            }
        }
    }
}

static void test_condition_follows_bus_power_state_and_error_code(void)
{
    cm1e_axis_condition_t c = cm1e_axis_condition(axis);
    TEST_ASSERT_TRUE(c.simulation && c.communication && c.ready_for_power_on && !c.warning);
    strcpy(bus.config.interface_name, "eth1");
    static const uint16_t off_codes[] = {0x4502, 0x8611, 0xFF01};
    for (int i = 0; i < 3; i++) { /* a drive that is off and says so warns of nothing */
        bus.error_code = off_codes[i];
        bench_cycles(1);
        TEST_ASSERT_FALSE(cm1e_axis_condition(axis).warning);
    }
    bus.error_code = 0xFF05;
    bench_cycles(1);
    c = cm1e_axis_condition(axis);
    TEST_ASSERT_TRUE(!c.simulation && c.communication && c.ready_for_power_on && c.warning);
    bus.error_code = 0;
    bus.power = false;
    bench_cycles(1);
    c = cm1e_axis_condition(axis);
    TEST_ASSERT_TRUE(c.communication && !c.ready_for_power_on && !c.warning);
    bus.power = true;
    strcpy(bus.config.interface_name, "sim:cell.yaml");
    received = CM1E_ERROR_BUS_LOST;
    bench_cycles(1);
    c = cm1e_axis_condition(axis);
    TEST_ASSERT_TRUE(c.simulation && !c.communication && !c.ready_for_power_on);
    received = CM1E_OK;
    bench_cycles(10); /* it was not seen, and is to rest for 20 ms */
    bench_enable();
    TEST_ASSERT_FALSE(cm1e_axis_condition(axis).ready_for_power_on); /* it is on */
    bus.error_code = 0x8611;
    bench_cycles(1);
    TEST_ASSERT_TRUE(cm1e_axis_condition(axis).warning);
    fake_bus_fault(&bus, 0x2310);
    bench_cycles(5);
    c = cm1e_axis_condition(axis);
    TEST_ASSERT_TRUE(c.communication && !c.ready_for_power_on && !c.warning); /* a fault is more than a warning */
}

/* ---- a motion that somebody has to want -------------------------------------------------------------------------- */

static void test_kept_motion_goes_on_while_it_is_renewed_and_halts_after(void)
{
    bench_enable();
    const cm1e_command_id_t id = bench_move_velocity(20.0);
    for (int i = 0; i < 100; i++) {
        cm1e_axis_keep(axis, id, 20 * cycle_ns, 50.0, 0.0);
        bench_cycles(10);
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(id));
    }
    bench_cycles(9);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(id));
    bench_cycles(1);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, bench_state_of(id));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISCRETE_MOTION, bench_info().state);
    int n = 0;
    while (bench_info().state != CM1E_AXIS_STANDSTILL && n++ < 2000)
        bench_cycles(1);
    TEST_ASSERT_INT_WITHIN(60, 400, n); /* 20 u/s at 50 u/s2, and the jerk */
    TEST_ASSERT_EQUAL_DOUBLE(0.0, bench_info().set_velocity);
}

static void test_kept_motion_with_impossible_values_halts_all_the_same(void)
{
    static const double values[] = {-1.0, 1e30, 0.0 / 0.0};
    for (int i = 0; i < 3; i++) {
        bench_start();
        bench_enable();
        const cm1e_command_id_t id = bench_move_velocity(20.0);
        bench_cycles(500);
        cm1e_axis_keep(axis, id, cycle_ns, values[i], values[i]);
        bench_cycles(2000);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    }
}

static void test_what_is_kept_does_not_touch_another_motion(void)
{
    bench_enable();
    const cm1e_command_id_t id = bench_move_velocity(20.0);
    cm1e_axis_keep(axis, id, 20 * cycle_ns, 0.0, 0.0);
    bench_cycles(5);
    const cm1e_command_id_t other = bench_move_velocity(5.0);
    bench_cycles(500);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(other));
    cm1e_axis_keep(axis, other, 20 * cycle_ns, 0.0, 0.0);
    cm1e_axis_keep(axis, 0, 0, 0.0, 0.0); /* nothing any more */
    bench_cycles(500);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, bench_state_of(other));
}

/* ---- cam switches ------------------------------------------------------------------------------------------------ */

static void test_a_refused_cam_switch_is_told_with_its_value_and_what_is_right(void)
{
    static const struct {
        cm1e_cam_switch_input_t input;
        double value;
        const char *words;
    } cases[] = {
        {CM1E_CAM_SWITCH_COUNT, 33.0, "MC_DigitalCamSwitch: NumberOfSwitches is 33; 1 ... 32 is right."},
        {CM1E_CAM_SWITCH_TRACK, 0.0, "switch 7: TrackNumber is 0; 1 ... 32 is right."},
        {CM1E_CAM_SWITCH_FIRST_ON, 2.5, "switch 7: FirstOnPosition is 2.5; a number is right, on a linear axis not above"},
        {CM1E_CAM_SWITCH_LAST_ON, NAN, "switch 7: LastOnPosition is nan; a number is right, on a modulo axis less than a turn"},
        {CM1E_CAM_SWITCH_DIRECTION, -1.0, "switch 7: AxisDirection is -1; 0, 1 or 2 is right."},
        {CM1E_CAM_SWITCH_MODE, 2.0, "switch 7: CamSwitchMode is 2; 0 or 1 is right."},
        {CM1E_CAM_SWITCH_DURATION, -1500000.0, "switch 7: Duration in ms is -1.5; 0 or more is right."},
        {CM1E_CAM_SWITCH_ON_COMPENSATION, 3600001e6, "OnCompensation of its track in ms is 3600001; up to an hour is right"},
        {CM1E_CAM_SWITCH_OFF_COMPENSATION, -3600001e6, "OffCompensation of its track in ms is -3600001; up to"},
        {CM1E_CAM_SWITCH_HYSTERESIS, -0.1, "Hysteresis of its track is -0.1; 0 or more is right."},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        cm1e_axis_refuse_cam_switch(axis, cases[i].input, 7, cases[i].value);
        bench_told(cases[i].words);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_output_reaches_the_wire_without_torque);
    RUN_TEST(test_other_outputs_do_not_exist_and_change_nothing);
    RUN_TEST(test_output_stays_over_power_modes_and_error_stop);
    RUN_TEST(test_output_of_a_slave_that_left_operational_stays_off);
    RUN_TEST(test_lost_frames_leave_the_output_alone);
    RUN_TEST(test_shut_down_switches_the_output_off_when_the_torque_is_gone);
    RUN_TEST(test_held_output_goes_off_unless_it_is_renewed);
    RUN_TEST(test_mapping_without_the_objects_is_told);
    RUN_TEST(test_every_mapping_reaches_the_signals);
    RUN_TEST(test_every_input_shows_its_bit_alone);
    RUN_TEST(test_old_inputs_are_told_as_old);
    RUN_TEST(test_switches_are_where_the_configuration_says);
    RUN_TEST(test_condition_follows_bus_power_state_and_error_code);
    RUN_TEST(test_kept_motion_goes_on_while_it_is_renewed_and_halts_after);
    RUN_TEST(test_kept_motion_with_impossible_values_halts_all_the_same);
    RUN_TEST(test_what_is_kept_does_not_touch_another_motion);
    RUN_TEST(test_a_refused_cam_switch_is_told_with_its_value_and_what_is_right);
    return UNITY_END();
}
