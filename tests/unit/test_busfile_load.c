#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cm1e/config.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

static const char temporary[] = CM1E_TEST_OUTPUT "/busfile_load.yaml";
static cm1e_bus_config_t config;
static cm1e_diag_t diag;

static void write_file(const char *text, size_t size)
{
    FILE *file = fopen(temporary, "wb");
    TEST_ASSERT_NOT_NULL(file);
    TEST_ASSERT_EQUAL(size, fwrite(text, 1, size, file));
    TEST_ASSERT_EQUAL(0, fclose(file));
}

static void load(const char *text)
{
    write_file(text, strlen(text));
    cm1e_bus_config_free(&config);
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_bus_config_load(&config, temporary, &diag), diag.text);
}

/* Members and axes are equal; `expected` is freed. */
static void expect_same(cm1e_bus_config_t *expected)
{
    TEST_ASSERT_EQUAL(expected->axis_count, config.axis_count);
    TEST_ASSERT_EQUAL_MEMORY(expected->axes, config.axes, expected->axis_count * sizeof *expected->axes);
    cm1e_bus_config_free(expected);
    expected->axes = config.axes;
    expected->axis_count = config.axis_count;
    TEST_ASSERT_EQUAL_MEMORY(expected, &config, sizeof config);
}

static char *read_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    TEST_ASSERT_NOT_NULL_MESSAGE(file, path);
    char *text = calloc(1, 1 << 16);
    TEST_ASSERT_NOT_NULL(text);
    TEST_ASSERT_GREATER_THAN(0, fread(text, 1, (1 << 16) - 1, file));
    fclose(file);
    return text;
}

/* An example in docs/BUS-FILE.md, 0 the first; the caller frees it. */
static char *documented_example(int number)
{
    static const char begin_mark[] = "```yaml\n";
    char *text = read_file(CM1E_SOURCE_DIR "/docs/BUS-FILE.md");
    char *begin = text;
    for (int i = 0; i <= number; i++) {
        begin = strstr(begin, begin_mark);
        TEST_ASSERT_NOT_NULL(begin);
        begin += strlen(begin_mark);
    }
    char *end = strstr(begin, "```");
    TEST_ASSERT_NOT_NULL(end);
    *end = '\0';
    memmove(text, begin, (size_t)(end - begin) + 1);
    return text;
}

#define ASSERT_DOUBLE(expected, actual) TEST_ASSERT_TRUE_MESSAGE((expected) == (actual), #actual)

static void test_documented_example_fills_every_field_of_the_bus(void)
{
    char *text = documented_example(0);
    load(text);
    free(text);
    TEST_ASSERT_EQUAL_STRING("eth1", config.interface_name);
    TEST_ASSERT_EQUAL_STRING("eth2", config.second_interface);
    TEST_ASSERT_EQUAL_INT64(500000, config.cycle_time_ns);
    TEST_ASSERT_EQUAL_INT64(100000, config.frame_timeout_ns);
    TEST_ASSERT_EQUAL(4, config.lost_cycles_limit);
    TEST_ASSERT_EQUAL_STRING("cell.pcap", config.pcap_file);
    TEST_ASSERT_FALSE(config.virtual_time);
    TEST_ASSERT_EQUAL(CM1E_PDO_ORDER_UG_7_2, config.sim_pdo_order);
    TEST_ASSERT_EQUAL(CM1E_SIM_IO_TERMINAL, config.sim_gaps);
    TEST_ASSERT_EQUAL(3, config.axis_count);
}

static void test_documented_example_fills_every_field_of_an_axis(void)
{
    char *text = documented_example(0);
    load(text);
    free(text);
    const cm1e_axis_config_t *axis = &config.axes[0];
    TEST_ASSERT_EQUAL_STRING("gripper", axis->name);
    TEST_ASSERT_EQUAL(CM1E_ADDRESS_POSITION, axis->address_kind);
    TEST_ASSERT_EQUAL(1, axis->address);
    TEST_ASSERT_EQUAL_STRING("CM1-E-23L20D", axis->motor);
    TEST_ASSERT_EQUAL_STRING("1.3.5", axis->firmware);
    TEST_ASSERT_EQUAL(CM1E_MAPPING_DYNAMIC, axis->mapping);
    ASSERT_DOUBLE(5000, axis->counts_per_unit);
    TEST_ASSERT_TRUE(axis->invert);
    ASSERT_DOUBLE(250, axis->max_velocity);
    ASSERT_DOUBLE(900, axis->max_acceleration);
    ASSERT_DOUBLE(950.5, axis->max_deceleration);
    ASSERT_DOUBLE(20000, axis->max_jerk);
    ASSERT_DOUBLE(4, axis->max_position_lag);
    ASSERT_DOUBLE(0.01, axis->in_position_window);
    ASSERT_DOUBLE(0.05, axis->in_position_time_s);
    ASSERT_DOUBLE(1.5, axis->in_position_timeout_s);
    TEST_ASSERT_TRUE(axis->in_position_done_waits);
    ASSERT_DOUBLE(-20, axis->software_limit_negative);
    ASSERT_DOUBLE(180, axis->software_limit_positive);
    TEST_ASSERT_EQUAL(-1, axis->homing.method);
    ASSERT_DOUBLE(7.5, axis->homing.offset);
    ASSERT_DOUBLE(20, axis->homing.velocity);
    ASSERT_DOUBLE(400, axis->homing.acceleration);
    ASSERT_DOUBLE(35, axis->homing.torque);
    ASSERT_DOUBLE(30, axis->homing.timeout_s);
    TEST_ASSERT_TRUE(axis->table_profiles);
    ASSERT_DOUBLE(5.5, axis->jog_slow);
    ASSERT_DOUBLE(60, axis->jog_fast);
    TEST_ASSERT_EQUAL(2, axis->inputs.limit_positive);
    TEST_ASSERT_EQUAL(3, axis->inputs.limit_negative);
    TEST_ASSERT_EQUAL(4, axis->inputs.home);
    TEST_ASSERT_TRUE(axis->inputs.limits_normally_closed);
    TEST_ASSERT_FALSE(axis->inputs.home_normally_closed);
    TEST_ASSERT_TRUE(axis->velocity_unit_stated);
    TEST_ASSERT_FALSE(axis->velocity_in_counts_per_ms);
    TEST_ASSERT_TRUE(axis->acceleration_in_kpulses);
    ASSERT_DOUBLE(4e-6, axis->sim.load_inertia);
    ASSERT_DOUBLE(0.01, axis->sim.friction);
    ASSERT_DOUBLE(2e-5, axis->sim.viscous_friction);
    ASSERT_DOUBLE(-400000, axis->sim.stop_negative);
    ASSERT_DOUBLE(500000, axis->sim.stop_positive);
    ASSERT_DOUBLE(300000, axis->sim.sensor_input2);
    ASSERT_DOUBLE(-200000, axis->sim.sensor_input3);
    TEST_ASSERT_FALSE(axis->sim.no_stops);
    TEST_ASSERT_FALSE(axis->sim.no_sensors);
}

static void test_documented_example_fills_the_other_addresses_and_units(void)
{
    char *text = documented_example(0);
    load(text);
    free(text);
    TEST_ASSERT_EQUAL(CM1E_ADDRESS_ALIAS, config.axes[1].address_kind);
    TEST_ASSERT_EQUAL(1001, config.axes[1].address);
    TEST_ASSERT_EQUAL(CM1E_MAPPING_CSP, config.axes[1].mapping);
    TEST_ASSERT_EQUAL(CM1E_MOTION_HOST, config.axes[1].motion);
    TEST_ASSERT_EQUAL(CM1E_MOTION_DRIVE, config.axes[2].motion);
    TEST_ASSERT_TRUE(config.axes[1].velocity_unit_stated);
    TEST_ASSERT_TRUE(config.axes[1].velocity_in_counts_per_ms);
    TEST_ASSERT_FALSE(config.axes[1].acceleration_in_kpulses);
    TEST_ASSERT_TRUE(config.axes[1].sim.no_stops);
    TEST_ASSERT_TRUE(config.axes[1].sim.no_sensors);
    TEST_ASSERT_EQUAL(7, config.axes[1].gear_numerator);
    TEST_ASSERT_EQUAL(3, config.axes[1].gear_denominator);
    ASSERT_DOUBLE(360, config.axes[1].units_per_revolution);
    ASSERT_DOUBLE(360, config.axes[1].modulo_range);
    ASSERT_DOUBLE(0.25, config.axes[1].backlash);
    ASSERT_DOUBLE(90, config.axes[1].backlash_velocity);
    TEST_ASSERT_EQUAL_STRING("axis3", config.axes[2].name);
    TEST_ASSERT_EQUAL(CM1E_ADDRESS_EXPLICIT_ID, config.axes[2].address_kind);
    TEST_ASSERT_EQUAL(181, config.axes[2].address);
    TEST_ASSERT_FALSE(config.axes[2].velocity_unit_stated);
}

static void test_three_axes_example_loads(void)
{
    cm1e_bus_config_free(&config);
    TEST_ASSERT_EQUAL_MESSAGE(
        CM1E_OK, cm1e_bus_config_load(&config, CM1E_SOURCE_DIR "/examples/three_axes.yaml", &diag), diag.text);
    static const char *const names[3] = {"X", "Y", "Z"};
    static const int8_t methods[3] = {-2, -6, -3};
    TEST_ASSERT_EQUAL_STRING("sim", config.interface_name);
    TEST_ASSERT_EQUAL(3, config.axis_count);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_STRING(names[i], config.axes[i].name);
        TEST_ASSERT_EQUAL(CM1E_ADDRESS_POSITION, config.axes[i].address_kind);
        TEST_ASSERT_EQUAL(i + 1, config.axes[i].address);
        TEST_ASSERT_EQUAL(methods[i], config.axes[i].homing.method);
        ASSERT_DOUBLE(5000, config.axes[i].counts_per_unit);
    }
}

static void test_documented_axes_without_a_motor(void)
{
    char *text = documented_example(2);
    load(text);
    free(text);
    const cm1e_axis_config_t *line = &config.axes[0], *wheel = &config.axes[1], *knife = &config.axes[2];
    TEST_ASSERT_EQUAL(3, config.axis_count);
    TEST_ASSERT_EQUAL(CM1E_AXIS_VIRTUAL, line->type);
    TEST_ASSERT_EQUAL(0, line->address);
    ASSERT_DOUBLE(360, line->modulo_range);
    ASSERT_DOUBLE(1080, line->max_velocity);
    TEST_ASSERT_EQUAL(CM1E_FOLLOWS_NOTHING, line->follows);
    TEST_ASSERT_EQUAL(CM1E_AXIS_ENCODER, wheel->type);
    ASSERT_DOUBLE(20.48, wheel->counts_per_unit);
    ASSERT_DOUBLE(0.004, wheel->encoder_filter_s);
    TEST_ASSERT_EQUAL(CM1E_AXIS_MOTOR, knife->type);
    TEST_ASSERT_EQUAL(1, knife->address); /* those before it are not on the bus */
    TEST_ASSERT_EQUAL(CM1E_FOLLOWS_ANY, knife->follows);
    TEST_ASSERT_EQUAL(361, knife->cam_points);
    TEST_ASSERT_EQUAL(CM1E_COUPLING_STOP_KEEP_RATIO, knife->coupling_stop);
}

static void test_one_software_limit_leaves_the_other_side_open(void)
{
    load("axes: [{software_limits: {positive: 0}}, {software_limits: {negative: -3.5}}, {software_limits: {}}]");
    ASSERT_DOUBLE(0, config.axes[0].software_limit_positive);
    ASSERT_DOUBLE(-INFINITY, config.axes[0].software_limit_negative);
    ASSERT_DOUBLE(INFINITY, config.axes[1].software_limit_positive);
    ASSERT_DOUBLE(-3.5, config.axes[1].software_limit_negative);
    ASSERT_DOUBLE(0, config.axes[2].software_limit_positive);
    ASSERT_DOUBLE(0, config.axes[2].software_limit_negative);
}

static void test_smallest_file_gives_defaults(void)
{
    cm1e_bus_config_t expected;
    cm1e_bus_config_init(&expected, NULL, 2);
    expected.axes[0].address = 1;
    expected.axes[1].address = 2;
    load("axes: [{}, {}]");
    expect_same(&expected);
    TEST_ASSERT_EQUAL_STRING("sim", config.interface_name);
    TEST_ASSERT_EQUAL_STRING("axis2", config.axes[1].name);
    TEST_ASSERT_EQUAL(2, config.axes[1].address);
}

static void test_unset_fields_are_zero_after_an_earlier_load(void)
{
    cm1e_bus_config_free(&config);
    memset(&config, 0xA5, sizeof config);
    config.axes = NULL;
    config.slaves = NULL;
    cm1e_bus_config_t expected;
    cm1e_bus_config_init(&expected, "sim", 1);
    expected.axes[0].address = 1;
    load("axes:\n- {}\n");
    expect_same(&expected);
}

static void test_values_at_the_bounds_are_accepted(void)
{
    load("bus: {cycle_time_us: 200, frame_timeout_us: 200, lost_cycles_limit: 250}\n"
         "axes:\n"
         "- position: 128\n"
         "  name: 1234567890123456789012345678901\n" /* 31 bytes */
         "  unit: {counts_per_unit: 5000}\n"
         "  limits: {velocity: 500}\n"
         "  homing: {method: -6, offset: -655.34, velocity: 0.2, acceleration: 1000, torque: 10, timeout_s: 0.1}\n"
         "- explicit_id: 254\n"
         "  motor: CM1-E-23L20D\n"
         "  limits: {velocity: 33.33332}\n"
         "  homing: {method: 0, offset: 65.534, velocity: 10, acceleration: 0.02, torque: 1.0e+2, timeout_s: 3600}\n"
         "- alias: 65535\n"
         "  software_limits: {negative: 0, positive: 0.00002}\n");
    TEST_ASSERT_EQUAL(3, config.axis_count);
}

static void test_numbers_in_every_spelling_are_read(void)
{
    load("axes:\n"
         "- {unit: {counts_per_unit: +5000}, software_limits: {negative: -.5, positive: 5.}}\n"
         "- {unit: {counts_per_unit: 5E3, invert: YES}, software_limits: {negative: -1e-1, positive: 1.5e1}}\n"
         "- {unit: {counts_per_unit: 5.000e+03, invert: off}, software_limits: {negative: -0, positive: 007.5}}\n");
    ASSERT_DOUBLE(-0.5, config.axes[0].software_limit_negative);
    ASSERT_DOUBLE(5, config.axes[0].software_limit_positive);
    ASSERT_DOUBLE(15, config.axes[1].software_limit_positive);
    ASSERT_DOUBLE(7.5, config.axes[2].software_limit_positive);
    TEST_ASSERT_TRUE(config.axes[1].invert);
    TEST_ASSERT_FALSE(config.axes[2].invert);
}

static void test_text_may_be_quoted_and_utf_8(void)
{
    load("axes: [{name: \"Hub \xc3\xbc""ber\", motor: 'CM1-E-17L30D', firmware: \"1.2.0\"}]");
    TEST_ASSERT_EQUAL_STRING("Hub \xc3\xbc""ber", config.axes[0].name);
}

static void test_most_axes_load(void)
{
    char text[8 * CM1E_MAX_AXES + 16] = "axes:\n";
    for (int i = 0; i < CM1E_MAX_AXES; i++)
        strcat(text, "- {}\n");
    load(text);
    TEST_ASSERT_EQUAL(CM1E_MAX_AXES, config.axis_count);
    TEST_ASSERT_EQUAL_STRING("axis128", config.axes[127].name);
    TEST_ASSERT_EQUAL(CM1E_MAX_AXES, config.axes[CM1E_MAX_AXES - 1].address);
}

static void test_decimal_point_is_a_point_where_the_locale_has_a_comma(void)
{
    static const char *const locales[] = {"de_DE.UTF-8", "de_DE", "fr_FR.UTF-8", "fr_FR", "it_IT.UTF-8", "pl_PL.UTF-8"};
    bool tried = false;
    for (size_t i = 0; i < sizeof locales / sizeof locales[0]; i++) {
        if (!setlocale(LC_ALL, locales[i]))
            continue;
        tried = true;
        load("axes: [{unit: {counts_per_unit: 4.5}}]");
        TEST_ASSERT_EQUAL_STRING(",", localeconv()->decimal_point); /* the caller's locale is back */
        setlocale(LC_ALL, "C");
        ASSERT_DOUBLE(4.5, config.axes[0].counts_per_unit);
    }
    if (!tried)
        TEST_IGNORE_MESSAGE("no locale with a decimal comma on this machine");
}

static void test_init_makes_default_axes_that_pass_the_check(void)
{
    for (uint32_t count = 0; count <= CM1E_MAX_AXES; count += count < 128 ? 1 : 64) {
        cm1e_bus_config_free(&config);
        cm1e_bus_config_init(&config, "eth7", count);
        TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_bus_config_check(&config, &diag), diag.text);
        TEST_ASSERT_EQUAL(CM1E_OK, diag.error);
        TEST_ASSERT_EQUAL(count, config.axis_count);
        TEST_ASSERT_EQUAL_STRING("eth7", config.interface_name);
    }
}

static void test_init_with_too_many_axes_is_refused_by_the_check(void)
{
    static const uint32_t counts[] = {CM1E_MAX_AXES + 1, 1000, UINT32_MAX};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        cm1e_bus_config_free(&config);
        TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, cm1e_bus_config_init(&config, "sim", counts[i]));
        TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, cm1e_bus_config_check(&config, &diag));
        TEST_ASSERT_NOT_NULL(strstr(diag.text, "axis_count"));
    }
}

static void test_example_files_are_loaded(void)
{
    static const struct {
        const char *name;
        uint32_t axes, behind_bridges;
    } examples[] = {{"three_axes", 3, 0}, {"bridge", 4, 4}, {"mixed", 4, 2}, {"machine", 1, 0}};
    for (size_t i = 0; i < sizeof examples / sizeof examples[0]; i++) {
        char path[200];
        snprintf(path, sizeof path, CM1E_SOURCE_DIR "/examples/%s.yaml", examples[i].name);
        cm1e_bus_config_free(&config);
        TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_bus_config_load(&config, path, &diag), diag.text);
        uint32_t behind_bridges = 0;
        for (uint32_t n = 0; n < config.axis_count; n++)
            behind_bridges += config.axes[n].channel != 0;
        TEST_ASSERT_EQUAL(examples[i].axes, config.axis_count);
        TEST_ASSERT_EQUAL(examples[i].behind_bridges, behind_bridges);
    }
}

static void test_documented_example_of_a_bridge(void)
{
    char *text = documented_example(1);
    load(text);
    free(text);
    TEST_ASSERT_EQUAL(3, config.axis_count);
    for (uint8_t i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL(2, config.axes[i].address);
        TEST_ASSERT_EQUAL(i + 1, config.axes[i].channel);
        TEST_ASSERT_EQUAL(i < 2 ? 10 : 3, config.axes[i].k37);
        TEST_ASSERT_TRUE(config.axes[i].k37_stated);
        TEST_ASSERT_EQUAL_STRING(i < 2 ? "CM1" : "CM2", config.axes[i].motor);
    }
    TEST_ASSERT_EQUAL(4, config.axes[2].homing.method);
    load("axes: [{channel: 1, k37: 0}, {}]");
    TEST_ASSERT_TRUE(config.axes[0].k37_stated);
    TEST_ASSERT_EQUAL(0, config.axes[0].k37);
    TEST_ASSERT_FALSE(config.axes[1].k37_stated);
    TEST_ASSERT_EQUAL(0, config.axes[1].channel);
}

static void test_pulses_of_axes_and_slaves(void)
{
    load("bus: {distributed_clocks: true}\n"
         "axes:\n"
         "  - {device: cia402, drive: {counts_per_revolution: 4096, max_speed_rpm: 3000},\n"
         "     dc: {sync0_us: 500, sync1_us: 125, shift_us: -62.5}}\n"
         "slaves:\n"
         "  - {name: encoder, position: 2, dc: {sync0_us: 2000}}\n"
         "  - {name: scale, position: 3, dc: {mode: DC-Synchron, shift_us: 20}}\n");
    TEST_ASSERT_TRUE(config.distributed_clocks);
    TEST_ASSERT_EQUAL_DOUBLE(500, config.axes[0].dc.sync0_us);
    TEST_ASSERT_EQUAL_DOUBLE(125, config.axes[0].dc.sync1_us);
    TEST_ASSERT_EQUAL_DOUBLE(-62.5, config.axes[0].dc.shift_us);
    TEST_ASSERT_EQUAL_STRING("", config.axes[0].dc.mode);
    TEST_ASSERT_EQUAL_DOUBLE(2000, config.slaves[0].dc.sync0_us);
    TEST_ASSERT_EQUAL_STRING("DC-Synchron", config.slaves[1].dc.mode);
    TEST_ASSERT_EQUAL_DOUBLE(20, config.slaves[1].dc.shift_us);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_documented_example_fills_every_field_of_the_bus);
    RUN_TEST(test_documented_example_fills_every_field_of_an_axis);
    RUN_TEST(test_documented_example_of_a_bridge);
    RUN_TEST(test_example_files_are_loaded);
    RUN_TEST(test_documented_example_fills_the_other_addresses_and_units);
    RUN_TEST(test_three_axes_example_loads);
    RUN_TEST(test_documented_axes_without_a_motor);
    RUN_TEST(test_one_software_limit_leaves_the_other_side_open);
    RUN_TEST(test_smallest_file_gives_defaults);
    RUN_TEST(test_unset_fields_are_zero_after_an_earlier_load);
    RUN_TEST(test_values_at_the_bounds_are_accepted);
    RUN_TEST(test_numbers_in_every_spelling_are_read);
    RUN_TEST(test_text_may_be_quoted_and_utf_8);
    RUN_TEST(test_most_axes_load);
    RUN_TEST(test_decimal_point_is_a_point_where_the_locale_has_a_comma);
    RUN_TEST(test_init_makes_default_axes_that_pass_the_check);
    RUN_TEST(test_init_with_too_many_axes_is_refused_by_the_check);
    RUN_TEST(test_pulses_of_axes_and_slaves);
    return UNITY_END();
}
