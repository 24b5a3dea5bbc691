#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "cm1e/config.h"
#include "config/clock_pulses.h"
#include "config/io_types.h"
#include "unity.h"

static cm1e_bus_config_t config;
static cm1e_diag_t diag;

/* Two axes in units of 5,000 counts. */
void setUp(void)
{
    cm1e_bus_config_free(&config);
    cm1e_bus_config_init(&config, "sim", 2);
    for (int i = 0; i < 2; i++)
        config.axes[i].counts_per_unit = 5000;
}
void tearDown(void) {}

static void expect_good(void)
{
    memset(&diag, 0x5A, sizeof diag);
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_bus_config_check(&config, &diag), diag.text);
    TEST_ASSERT_EQUAL(CM1E_OK, diag.error);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_bus_config_check(&config, NULL));
}

/* Refused, and the text names the thing. */
static void expect_wrong(const char *part)
{
    memset(&diag, 0x5A, sizeof diag);
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_ERROR_CONFIG, cm1e_bus_config_check(&config, &diag), part);
    TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, diag.error);
    TEST_ASSERT_NOT_NULL(memchr(diag.text, '\0', sizeof diag.text));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, part), diag.text);
    TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, cm1e_bus_config_check(&config, NULL));
}

static void test_all_zero_configuration_is_good(void)
{
    cm1e_bus_config_free(&config);
    memset(&config, 0, sizeof config);
    expect_good();
    while (config.axis_count < CM1E_MAX_AXES)
        *cm1e_bus_config_add_axis(&config, NULL) = (cm1e_axis_config_t){0};
    expect_good();
}

static void test_only_the_four_cycle_times_are_good(void)
{
    static const int64_t good[] = {0, 200000, 250000, 500000, 1000000};
    static const int64_t wrong[] = {-1,     1,       199999,  200001,    125000,   300000,
                                    999999, 1000001, 2000000, INT64_MIN, INT64_MAX};
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        config.cycle_time_ns = good[i];
        expect_good();
    }
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        config.cycle_time_ns = wrong[i];
        expect_wrong("cycle_time_us");
    }
}

static void use_other_drive(cm1e_axis_config_t *axis)
{
    snprintf(axis->device, sizeof axis->device, "cia402");
    axis->counts_per_revolution = 10000;
    axis->max_speed_rpm = 3000;
}

/* Each device of the bus has to accept the cycle time, and no other device is asked. */
static void test_cycle_time_is_one_of_every_device_on_the_bus(void)
{
    use_other_drive(&config.axes[0]);
    config.cycle_time_ns = 2000000;
    expect_wrong("cycle_time_us is 2000; expected 200, 250, 500 or 1000, which the CM1-E accepts");
    use_other_drive(&config.axes[1]);
    expect_good();
    config.cycle_time_ns = 300000;
    expect_wrong("cycle_time_us is 300; expected 200, 250, 500, 1000, 2000 or 4000, which the CiA 402 servo drive "
                 "accepts");
    config.axes[0].type = config.axes[1].type = CM1E_AXIS_VIRTUAL;
    config.axes[0].device[0] = config.axes[1].device[0] = '\0';
    config.axes[0].counts_per_revolution = config.axes[1].counts_per_revolution = 0;
    config.axes[0].max_speed_rpm = config.axes[1].max_speed_rpm = 0;
    expect_wrong("cycle_time_us is 300; expected a cycle time that a device accepts");
    config.cycle_time_ns = 4000000;
    config.lost_cycles_limit = 10;
    expect_good();
}

static void test_frame_timeout_is_within_the_cycle(void)
{
    config.frame_timeout_ns = 1000000;
    expect_good();
    config.frame_timeout_ns = 1000001;
    expect_wrong("frame_timeout_us");
    config.frame_timeout_ns = -1;
    expect_wrong("frame_timeout_us");
    config.cycle_time_ns = 200000;
    config.frame_timeout_ns = 200000;
    expect_good();
    config.frame_timeout_ns = 200001;
    expect_wrong("frame_timeout_us");
}

static void test_texts_without_end_are_refused(void)
{
    struct {
        char *text;
        size_t size;
        const char *part;
    } texts[] = {
        {config.interface_name, sizeof config.interface_name, "interface"},
        {config.second_interface, sizeof config.second_interface, "second_interface"},
        {config.pcap_file, sizeof config.pcap_file, "pcap_file"},
        {config.axes[1].name, sizeof config.axes[1].name, "axis 2: name"},
        {config.axes[1].motor, sizeof config.axes[1].motor, "axis axis2: motor"},
        {config.axes[1].firmware, sizeof config.axes[1].firmware, "axis axis2: firmware"},
    };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        char before[256];
        memcpy(before, texts[i].text, texts[i].size);
        memset(texts[i].text, 'a', texts[i].size);
        expect_wrong(texts[i].part);
        memcpy(texts[i].text, before, texts[i].size);
        texts[i].text[0] = '\033';
        texts[i].text[1] = '\0';
        expect_wrong(texts[i].part);
        memcpy(texts[i].text, before, texts[i].size);
        expect_good();
    }
}

static void test_enumerations_out_of_range_are_refused(void)
{
    config.sim_pdo_order = (cm1e_pdo_order_t)2;
    expect_wrong("sim_pdo_order");
    setUp();
    config.sim_gaps = (cm1e_sim_io_t)3;
    expect_wrong("sim_gaps");
    setUp();
    config.axes[0].mapping = (cm1e_mapping_t)4;
    expect_wrong("mapping");
    config.axes[0].mapping = (cm1e_mapping_t)-1;
    expect_wrong("mapping");
    setUp();
    config.axes[0].motion = (cm1e_motion_backend_t)2;
    expect_wrong("motion is 2");
    config.axes[0].motion = CM1E_MOTION_DRIVE;
    expect_good();
    config.axes[0].mapping = CM1E_MAPPING_CSV;
    expect_wrong("motion is drive");
    setUp();
    config.axes[0].address_kind = (cm1e_address_kind_t)3;
    expect_wrong("position");
    config.axes[0].address_kind = (cm1e_address_kind_t)-1;
    expect_wrong("position");
    setUp();
    config.lost_cycles_limit = 51;
    expect_wrong("expected 1 ... 50");
    config.cycle_time_ns = 200000;
    expect_good();
    config.lost_cycles_limit = 251;
    expect_wrong("expected 1 ... 250");
    config.cycle_time_ns = 0;
    config.lost_cycles_limit = 50;
    expect_good();
}

static void test_recoveries_out_of_range_are_refused(void)
{
    cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(&config, "valves");
    slave->address = 3;
    for (int recover = CM1E_RECOVER_DEFAULT; recover <= CM1E_RECOVER_AUTO; recover++) {
        config.axes[1].recover = slave->recover = (cm1e_recover_t)recover;
        expect_good();
    }
    slave->recover = (cm1e_recover_t)(CM1E_RECOVER_AUTO + 1);
    expect_wrong("slave valves: recover is 4; expected one of the enumeration");
    slave->recover = (cm1e_recover_t)-1;
    expect_wrong("slave valves: recover is -1; expected one of the enumeration");
    config.axes[1].recover = (cm1e_recover_t)(CM1E_RECOVER_AUTO + 1);
    expect_wrong("axis axis2: recover is 4; expected one of the enumeration");
}

static void test_addresses_are_in_range_and_single(void)
{
    config.axes[0].address = CM1E_MAX_SLAVES + 1;
    expect_wrong("position");
    config.axes[0].address = 2;
    expect_wrong("position is 2, which entry 1");
    config.axes[0].address_kind = CM1E_ADDRESS_ALIAS;
    expect_good();
    config.axes[0].address = 0;
    expect_wrong("alias is 0");
    config.axes[0].address_kind = CM1E_ADDRESS_EXPLICIT_ID;
    expect_wrong("explicit_id is 0");
    config.axes[0].address = 255;
    expect_wrong("explicit_id is 255");
    config.axes[0].address = 254;
    expect_good();
}

static void test_default_position_counts_as_the_place_in_the_list(void)
{
    config.axes[0].address = 2;
    config.axes[1].address = 0;
    expect_wrong("axis axis2: position is 2, which entry 1");
    config.axes[0].address = 0;
    expect_good();
}

static void test_axes_without_a_motor_take_no_place(void)
{
    config.axes[0].type = CM1E_AXIS_VIRTUAL;
    config.axes[1].address = 1;
    expect_good();
    config.axes[1].type = CM1E_AXIS_ENCODER;
    expect_wrong("axis axis2: position is given");
    config.axes[1].address = 0;
    expect_good();
    config.axes[1].homing.timeout_s = 5;
    expect_wrong("homing");
    config.axes[1].homing.timeout_s = 0;
    config.axes[0].type = (cm1e_axis_type_t)3;
    expect_wrong("type is 3");
}

static void test_followers_have_room_for_so_many_points_and_a_way_to_stop(void)
{
    config.axes[1].cam_points = 4096;
    config.axes[1].coupling_stop = CM1E_COUPLING_STOP_KEEP_RATIO;
    config.axes[1].encoder_filter_s = 0.01;
    expect_good();
    config.axes[1].cam_points = 4097;
    expect_wrong("cam_points is 4097");
    config.axes[1].cam_points = 1;
    expect_wrong("cam_points is 1");
    config.axes[1].cam_points = 0;
    config.axes[1].follows = (cm1e_follows_t)3;
    expect_wrong("follows is 3");
    config.axes[1].follows = CM1E_FOLLOWS_GEARS;
    expect_good();
    config.axes[1].cam_points = 9;
    expect_wrong("cam_points is given, and the axis follows no cams (follows: gears)");
    config.axes[1].cam_points = 0;
    config.axes[1].coupling_stop = (cm1e_coupling_stop_t)3;
    expect_wrong("coupling_stop is 3");
    config.axes[1].coupling_stop = CM1E_COUPLING_STOP_THIS;
    config.axes[1].encoder_filter_s = -0.01;
    expect_wrong("encoder_filter_s is -0.01");
    config.axes[1].encoder_filter_s = NAN;
    expect_wrong("encoder_filter_s is not a finite number");
}

static void test_names_are_single_defaults_included(void)
{
    strcpy(config.axes[0].name, "axis2");
    config.axes[1].name[0] = '\0';
    expect_wrong("name");
    strcpy(config.axes[0].name, "axis1");
    expect_good();
}

#define NUMBER(member, part) {offsetof(cm1e_axis_config_t, member), part}
static const struct {
    size_t offset;
    const char *part;
} numbers[] = {
    NUMBER(counts_per_unit, "unit.counts_per_unit"),
    NUMBER(max_velocity, "limits.velocity"),
    NUMBER(max_acceleration, "limits.acceleration"),
    NUMBER(max_deceleration, "limits.deceleration"),
    NUMBER(max_jerk, "limits.jerk"),
    NUMBER(max_position_lag, "limits.position_lag"),
    NUMBER(software_limit_negative, "software_limits.negative"),
    NUMBER(software_limit_positive, "software_limits.positive"),
    NUMBER(homing.offset, "homing.offset"),
    NUMBER(homing.velocity, "homing.velocity"),
    NUMBER(homing.acceleration, "homing.acceleration"),
    NUMBER(homing.torque, "homing.torque"),
    NUMBER(homing.timeout_s, "homing.timeout_s"),
    NUMBER(sim.load_inertia, "sim.load_inertia"),
    NUMBER(sim.friction, "sim.friction"),
    NUMBER(sim.viscous_friction, "sim.viscous_friction"),
    NUMBER(sim.stop_positive, "sim.stop_positive"),
    NUMBER(sim.stop_negative, "sim.stop_negative"),
    NUMBER(sim.sensor_input2, "sim.sensor_input2"),
    NUMBER(sim.sensor_input3, "sim.sensor_input3"),
    NUMBER(jog_slow, "jog.slow"),
    NUMBER(jog_fast, "jog.fast"),
    NUMBER(modulo_range, "unit.modulo_range"),
    NUMBER(backlash, "backlash.gap"),
    NUMBER(backlash_velocity, "backlash.velocity"),
    NUMBER(in_position_window, "in_position.window"),
    NUMBER(in_position_time_s, "in_position.time_s"),
    NUMBER(in_position_timeout_s, "in_position.timeout_s"),
};
enum { NUMBERS = sizeof numbers / sizeof numbers[0] };

/* Of the second axis. */
static double *number(int i) { return (double *)(void *)((char *)&config.axes[1] + numbers[i].offset); }

static void test_numbers_that_are_none_or_absurd_are_refused(void)
{
    static const double absurd[] = {NAN, -NAN, INFINITY, -INFINITY, 1e300, -1e300};
    for (int i = 0; i < NUMBERS; i++)
        for (size_t k = 0; k < sizeof absurd / sizeof absurd[0]; k++) {
            if ((absurd[k] == INFINITY && strstr(numbers[i].part, "_limits.positive")) ||
                (absurd[k] == -INFINITY && strstr(numbers[i].part, "_limits.negative")))
                continue; /* none on this side */
            setUp();
            *number(i) = absurd[k];
            expect_wrong(numbers[i].part);
        }
}

static void test_only_positions_may_be_negative(void)
{
    for (int i = 0; i < NUMBERS; i++) {
        setUp();
        const bool position = strstr(numbers[i].part, "offset") || strstr(numbers[i].part, "sensor") ||
                              strstr(numbers[i].part, "_limits.negative") || strstr(numbers[i].part, "stop_negative");
        *number(i) = -20;
        if (position)
            expect_good();
        else
            expect_wrong(numbers[i].part);
    }
}

/* Counts at 5,000 a unit: last good and first wrong values (UG 6.2.4, 6.3). */
static void test_bounds_are_the_devices_in_counts(void)
{
    static const struct {
        int number;
        double good, wrong;
    } bounds[] = {
        {1, 500, 500.0002},        {1, 0.0002, 0.00001},     {8, 655.34, 655.3402},  {8, -655.34, -655.3402},
        {9, 0.2, 0.1998},          {9, 100, 100.0002},       {10, 0.2, 0.1998},      {10, 1000, 1000.0002},
        {11, 10, 9.999},           {11, 100, 100.001},       {2, 0.2, 0.1998},       {3, 0.2, 0.1998},
        {12, 0.1, 0.0999},         {12, 3600, 3600.1},       {20, 500, 500.0002},    {21, 0.0002, 0.00001},
        {25, 0.0002, 0.00009},     {26, 0.001, 0.0009},      {26, 1.9, 10.1},        {27, 0.021, 0.0099},
        {27, 3600, 3600.1},
    };
    for (size_t i = 0; i < sizeof bounds / sizeof bounds[0]; i++) {
        setUp();
        *number(bounds[i].number) = bounds[i].good;
        expect_good();
        *number(bounds[i].number) = bounds[i].wrong;
        expect_wrong(numbers[bounds[i].number].part);
    }
}

static void test_peak_speed_is_the_motors(void)
{
    config.axes[0].max_velocity = 400;
    expect_good();
    strcpy(config.axes[0].motor, "CM1-E-23L20D");
    expect_wrong("expected 0.0002 ... 333.3332, 1 ... 1666666 counts/s");
    config.axes[0].max_velocity = 333.3332;
    expect_good();
    config.axes[0].counts_per_unit = 0; /* revolutions */
    config.axes[0].max_velocity = 33.33332;
    expect_good();
    config.axes[0].max_velocity = 33.34;
    expect_wrong("limits.velocity");
}

static void test_jog_velocities_are_within_the_axis_s_own_maximum(void)
{
    config.axes[0].max_velocity = 40;
    config.axes[0].jog_slow = config.axes[0].jog_fast = 40;
    expect_good();
    config.axes[0].jog_fast = 40.0002;
    expect_wrong("jog.fast is 40.0002, 200001 counts/s; expected 0.0002 ... 40");
}

static void test_switches_are_on_inputs_of_the_motor_and_the_limit_switches_on_two(void)
{
    cm1e_input_config_t *inputs = &config.axes[0].inputs;
    *inputs = (cm1e_input_config_t){.limit_positive = 4, .limit_negative = 1, .home = 4};
    expect_good(); /* a limit switch may be the home switch */
    inputs->limit_negative = 4;
    expect_wrong("inputs.limit_negative is 4, which is the input of the other");
    *inputs = (cm1e_input_config_t){.limit_positive = 5};
    expect_wrong("inputs.limit_positive is 5");
    *inputs = (cm1e_input_config_t){.limit_negative = 255};
    expect_wrong("inputs.limit_negative is 255");
    *inputs = (cm1e_input_config_t){.home = 5};
    expect_wrong("inputs.home is 5; expected 1 ... 4");
}

static void test_unit_by_revolutions_is_within_bounds(void)
{
    cm1e_axis_config_t *axis = &config.axes[0];
    axis->counts_per_unit = 0;
    *axis = (cm1e_axis_config_t){.gear_numerator = 7, .gear_denominator = 3, .units_per_revolution = 360};
    expect_good();
    axis->modulo_range = 360;
    expect_good();
    axis->modulo_range = INFINITY;
    expect_wrong("unit.modulo_range");
    axis->modulo_range = 0;
    axis->gear_numerator = 1000001;
    expect_wrong("unit.gear_numerator");
    axis->gear_numerator = 1;
    axis->gear_denominator = UINT32_MAX;
    expect_wrong("unit.gear_denominator");
    axis->gear_denominator = 1;
    axis->units_per_revolution = NAN;
    expect_wrong("unit.units_per_revolution");
    axis->units_per_revolution = -INFINITY;
    expect_wrong("unit.units_per_revolution");
}

static void test_one_software_limit_alone_is_good(void)
{
    config.axes[0].software_limit_negative = -INFINITY;
    expect_good();
    config.axes[0].software_limit_positive = INFINITY;
    expect_good();
    config.axes[0].software_limit_negative = 7;
    expect_good();
    config.axes[0].software_limit_positive = -INFINITY;
    expect_wrong("software_limits.positive");
    config.axes[0].software_limit_negative = INFINITY;
    expect_wrong("software_limits.negative");
}

static void test_software_limits_both_zero_are_none(void)
{
    expect_good();
    config.axes[0].software_limit_positive = 1;
    expect_good(); /* 0 ... 1 */
    config.axes[0].software_limit_negative = 1;
    expect_wrong("software_limits.positive");
    config.axes[0].software_limit_positive = -1;
    expect_wrong("software_limits.positive");
}

/* UG 6.2.4: for each method, which sign of the offset leads into the hard stop. */
static void test_offset_into_the_hard_stop_is_refused(void)
{
    for (int method = -6; method <= 0; method++)
        for (int invert = 0; invert < 2; invert++)
            for (int sign = -1; sign <= 1; sign++) {
                setUp();
                config.axes[1].homing.method = (int8_t)method;
                config.axes[1].homing.offset = sign * 3.0;
                config.axes[1].invert = invert;
                const int counts_sign = invert ? -sign : sign;
                if ((method == -1 && counts_sign > 0) || (method == -2 && counts_sign < 0))
                    expect_wrong("homing.offset");
                else
                    expect_good();
            }
    for (int method = INT8_MIN; method <= INT8_MAX; method++) {
        setUp();
        config.axes[1].homing.method = (int8_t)method;
        if (method >= -6 && method <= 0)
            expect_good();
        else
            expect_wrong("homing.method");
    }
}

static void test_old_firmware_runs_at_1_ms_only(void)
{
    static const char *const versions[] = {"1.2.0", "1.3.0", "1.3.2", "1.3.3", "1.3.4", "1.3.5"};
    for (int i = 0; i < 6; i++) {
        strcpy(config.axes[0].firmware, versions[i]);
        config.cycle_time_ns = 0;
        expect_good();
        config.cycle_time_ns = 1000000;
        expect_good();
        config.cycle_time_ns = 500000;
        if (i < 2)
            expect_wrong("firmware");
        else
            expect_good();
    }
}

static void test_virtual_time_needs_the_simulated_segment(void)
{
    static const char *const simulated[] = {"", "sim", "sim:cell.yaml"};
    static const char *const wired[] = {"eth1", "sim0", "simulator", "veth:sim"};
    config.virtual_time = true;
    for (size_t i = 0; i < sizeof simulated / sizeof simulated[0]; i++) {
        strcpy(config.interface_name, simulated[i]);
        expect_good();
    }
    for (size_t i = 0; i < sizeof wired / sizeof wired[0]; i++) {
        strcpy(config.interface_name, wired[i]);
        expect_wrong("virtual_time");
    }
}

static void test_only_listed_axes_are_checked(void)
{
    cm1e_bus_config_add_axis(&config, NULL)->max_velocity = NAN;
    config.axis_count = 2;
    expect_good();
    config.axis_count = 3;
    expect_wrong("axis axis3: limits.velocity");
}

/* At a cycle time of 2 ms; ETG.2000, OpMode, and ETG.1000.4 for SYNC1. */
static void test_the_range_of_a_signal_is_that_of_its_bits(void)
{
    for (int type = 0; type < CM1E_IO_TYPE_COUNT; type++)
        for (unsigned bits = 1; bits <= 64; bits++) {
            const cm1e_io_type_t t = (cm1e_io_type_t)type;
            const bool is_signed = cm1e_io_types[type].is_signed;
            const double end = ldexp(1, (int)bits - is_signed), least = is_signed ? -end : 0;
            if (cm1e_io_types[type].is_real || t == CM1E_IO_BYTES)
                continue;
            TEST_ASSERT_TRUE(cm1e_io_fits(t, bits, least));
            TEST_ASSERT_TRUE(cm1e_io_fits(t, bits, floor(nextafter(end, 0))));
            TEST_ASSERT_FALSE(cm1e_io_fits(t, bits, end));
            TEST_ASSERT_FALSE(cm1e_io_fits(t, bits, bits < 53 ? least - 1 : nextafter(least, -INFINITY)));
            TEST_ASSERT_FALSE(cm1e_io_fits(t, bits, 0.5) || cm1e_io_fits(t, bits, NAN));
        }
    TEST_ASSERT_FALSE(cm1e_io_fits(CM1E_IO_BYTES, 8, 0));
    TEST_ASSERT_TRUE(cm1e_io_fits(CM1E_IO_REAL, 32, 0.5) && cm1e_io_fits(CM1E_IO_LREAL, 64, 1e308));
    TEST_ASSERT_TRUE(cm1e_io_fits(CM1E_IO_REAL, 32, -3.4028234e38));
    TEST_ASSERT_FALSE(cm1e_io_fits(CM1E_IO_REAL, 32, 3.5e38) || cm1e_io_fits(CM1E_IO_LREAL, 64, INFINITY));
}

static void test_pulses_of_any_axis_or_slave_need_clocks(void)
{
    TEST_ASSERT_FALSE(cm1e_config_uses_clocks(&config));
    config.distributed_clocks = true;
    TEST_ASSERT_TRUE(cm1e_config_uses_clocks(&config));
    config.distributed_clocks = false;
    for (int i = 0; i < 2; i++) {
        config.axes[i].dc.sync0_us = 1000;
        TEST_ASSERT_TRUE(cm1e_config_uses_clocks(&config));
        config.axes[i].dc.sync0_us = 0;
    }
    for (int i = 0; i < 2; i++)
        cm1e_bus_config_add_slave(&config, NULL);
    TEST_ASSERT_FALSE(cm1e_config_uses_clocks(&config));
    for (int i = 0; i < 2; i++) {
        config.slaves[i].dc.sync0_us = 1000;
        TEST_ASSERT_TRUE(cm1e_config_uses_clocks(&config));
        config.slaves[i].dc.sync0_us = 0;
    }
}

static void test_the_pulses_of_a_mode(void)
{
    static const struct { cm1e_dc_facts_t facts; double shift_us, sync0_us, sync1_us, shifted_us; } rows[] = {
        {{.assign_activate = 0x0000, .sync0_factor = 2, .sync1_factor = 2}, 300, 0, 0, 0},
        {{.assign_activate = 0x0300}, 0, 2000, 0, 1000},
        {{.assign_activate = 0x0300, .sync0_factor = 1, .sync0_shift_ns = 50000}, 0, 2000, 0, 1050},
        {{.assign_activate = 0x0300, .sync0_factor = 3, .sync0_shift_ns = -50000}, 300, 6000, 0, 250},
        {{.assign_activate = 0x0300, .sync0_factor = -4, .sync1_factor = 4, .sync1_shift_ns = 9000}, 300, 500, 0, 300},
        {{.assign_activate = 0x0700, .sync0_factor = -4, .sync1_factor = 4}, 300, 500, 1500, 300},
        {{.assign_activate = 0x0700, .sync0_factor = 1, .sync1_factor = 2, .sync1_shift_ns = 9000}, 300, 2000, 2009, 300},
        {{.assign_activate = 0x0700, .sync0_factor = 1, .sync1_factor = 1, .sync1_shift_ns = 9000}, 300, 2000, 9, 300},
        {{.assign_activate = 0x0700, .sync0_factor = 1, .sync1_shift_ns = 9000}, 300, 2000, 9, 300},
        {{.assign_activate = 0x0700, .sync0_cycle_ns = 250000, .sync0_factor = 7, .sync1_factor = 3}, 300, 250, 500, 300},
        {{.assign_activate = 0x0400, .sync0_factor = 1, .sync1_factor = 2}, 300, 0, 0, 0}, /* SYNC1 comes of SYNC0 */
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const cm1e_dc_config_t pulses = cm1e_config_pulses_of_mode(&rows[i].facts, rows[i].shift_us, 2000000);
        TEST_ASSERT_EQUAL_DOUBLE(rows[i].sync0_us, pulses.sync0_us);
        TEST_ASSERT_EQUAL_DOUBLE(rows[i].sync1_us, pulses.sync1_us);
        TEST_ASSERT_EQUAL_DOUBLE(rows[i].shifted_us, pulses.shift_us);
        TEST_ASSERT_EQUAL(rows[i].sync0_us != 0, cm1e_config_mode_has_sync0(&rows[i].facts));
    }
}

/* The data of start-up SDOs of more than 8 bytes are those of the slave, from `value` on. */
static void test_the_data_of_an_sdo_are_those_of_its_slave(void)
{
    static const struct { unsigned bytes, there, from, size; bool good; } rows[] = {
        {1, 0, 0, 0, true},    {8, 0, 0, 0, true},    {9, 0, 0, 0, false},  {0, 0, 0, 0, false},  {0, 10, 0, 0, false},
        {0, 10, 0, 10, true},  {0, 10, 0, 11, false}, {0, 10, 3, 7, true},  {0, 10, 4, 7, false}, {0, 10, 9, 1, true},
        {0, 10, 10, 1, false}, {0, CM1E_SLAVE_SDO_DATA, 0, CM1E_SLAVE_SDO_DATA, true},
        {0, CM1E_SLAVE_SDO_DATA + 1, 0, 1, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        setUp();
        cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(&config, "valves");
        slave->address = 3;
        slave->sdo_count = 1;
        slave->sdo_data_count = (uint16_t)rows[i].there;
        slave->sdos[0] = (cm1e_sdo_config_t){.index = 0x8000, .bytes = (uint8_t)rows[i].bytes,
                                             .size = (uint16_t)rows[i].size, .value = rows[i].from};
        if (rows[i].good)
            expect_good();
        else
            expect_wrong("expected 1 ... 8, or data of its own");
    }
}

/* What a bus file cannot have. */
static void test_texts_and_signals_of_slaves(void)
{
    cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(&config, "valves");
    slave = cm1e_bus_config_add_slave(&config, NULL);
    config.slaves[0].address = 3;
    slave->address = 4;
    slave->name[0] = '\0'; /* "slave2" */
    snprintf(config.axes[0].wiring.inputs[0], CM1E_SIGNAL_LENGTH, "slave2.end");
    config.axes[0].wiring.input_count = 1;
    config.axes[0].inputs.home = CM1E_WIRED_FIRST;
    expect_good();
    config.axes[0].inputs.home = CM1E_WIRED_FIRST + 1;
    expect_wrong("inputs.home is 12; expected 1 ... 4, or the name of a signal");
    config.axes[0].inputs.home = 0;
    snprintf(config.axes[0].wiring.inputs[0], CM1E_SIGNAL_LENGTH, "slave1.end");
    expect_wrong("has 'slave1.end'; expected the name of a slave");
    config.axes[0].wiring.input_count = 0;
    slave->signal_count = 1;
    slave->signals[0] = (cm1e_signal_config_t){.name = "data", .type = CM1E_IO_BYTES, .type_stated = true, .bits = 80};
    expect_good();
    slave->signals[0].bits = 0;
    expect_wrong("inputs[0] is of type BYTES; expected its number of bits too");
    slave->signal_count = 0;
    memset(slave->hot_connect, 'a', sizeof slave->hot_connect);
    expect_wrong("slave slave2: hot_connect is not a text of less than 32 bytes");
    slave->hot_connect[0] = '\0';
    memset(slave->name, 'a', sizeof slave->name);
    expect_wrong("slave 2: name is not a text of less than 32 bytes");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_all_zero_configuration_is_good);
    RUN_TEST(test_only_the_four_cycle_times_are_good);
    RUN_TEST(test_cycle_time_is_one_of_every_device_on_the_bus);
    RUN_TEST(test_frame_timeout_is_within_the_cycle);
    RUN_TEST(test_texts_without_end_are_refused);
    RUN_TEST(test_enumerations_out_of_range_are_refused);
    RUN_TEST(test_recoveries_out_of_range_are_refused);
    RUN_TEST(test_addresses_are_in_range_and_single);
    RUN_TEST(test_default_position_counts_as_the_place_in_the_list);
    RUN_TEST(test_axes_without_a_motor_take_no_place);
    RUN_TEST(test_followers_have_room_for_so_many_points_and_a_way_to_stop);
    RUN_TEST(test_names_are_single_defaults_included);
    RUN_TEST(test_numbers_that_are_none_or_absurd_are_refused);
    RUN_TEST(test_only_positions_may_be_negative);
    RUN_TEST(test_bounds_are_the_devices_in_counts);
    RUN_TEST(test_peak_speed_is_the_motors);
    RUN_TEST(test_jog_velocities_are_within_the_axis_s_own_maximum);
    RUN_TEST(test_switches_are_on_inputs_of_the_motor_and_the_limit_switches_on_two);
    RUN_TEST(test_unit_by_revolutions_is_within_bounds);
    RUN_TEST(test_one_software_limit_alone_is_good);
    RUN_TEST(test_software_limits_both_zero_are_none);
    RUN_TEST(test_offset_into_the_hard_stop_is_refused);
    RUN_TEST(test_old_firmware_runs_at_1_ms_only);
    RUN_TEST(test_virtual_time_needs_the_simulated_segment);
    RUN_TEST(test_only_listed_axes_are_checked);
    RUN_TEST(test_the_range_of_a_signal_is_that_of_its_bits);
    RUN_TEST(test_pulses_of_any_axis_or_slave_need_clocks);
    RUN_TEST(test_the_pulses_of_a_mode);
    RUN_TEST(test_the_data_of_an_sdo_are_those_of_its_slave);
    RUN_TEST(test_texts_and_signals_of_slaves);
    return UNITY_END();
}
