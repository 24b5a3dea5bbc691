/* Axes behind a bridge: what one may be beside another, and bounds by motor and K37. */
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "cm1e/config.h"
#include "device/bridge_facts.h"
#include "unity.h"

static cm1e_bus_config_t config;
static cm1e_diag_t diag;

/* Four axes behind one bridge, in revolutions of 50,000 counts. */
void setUp(void)
{
    cm1e_bus_config_free(&config);
    cm1e_bus_config_init(&config, "sim", CM1E_BRIDGE_AXES);
    for (uint8_t i = 0; i < CM1E_BRIDGE_AXES; i++) {
        config.axes[i].address = 1;
        config.axes[i].channel = (uint8_t)(i + 1);
        config.axes[i].k37 = 10;
        config.axes[i].k37_stated = true;
    }
}
void tearDown(void) {}

static void expect_good(void)
{
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_bus_config_check(&config, &diag), diag.text);
}

static void expect_wrong(const char *part)
{
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_ERROR_CONFIG, cm1e_bus_config_check(&config, &diag), part);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, part), diag.text);
}

static void set_motor(int axis, const char *name)
{
    snprintf(config.axes[axis].motor, sizeof config.axes[axis].motor, "%s", name);
}

static void test_axes_share_an_address_by_channels(void)
{
    expect_good();
    config.axes[3].channel = 3;
    expect_wrong("channel is 3, which entry 3");
    config.axes[3].channel = 5;
    expect_wrong("channel is 5; expected 1 ... 4");
    config.axes[3].channel = 0;
    expect_wrong("only one of the two has a channel");
    config.axes[3].k37_stated = false;
    config.axes[3].address = 2;
    expect_good();
    config.axes[3].address_kind = CM1E_ADDRESS_ALIAS;
    config.axes[3].address = 1;
    expect_good();
}

static void test_the_same_channel_of_another_bridge_is_another_motor(void)
{
    config.axes[1] = config.axes[0];
    strcpy(config.axes[1].name, "other");
    expect_wrong("channel is 1");
    config.axes[1].address = 2;
    expect_good();
    config.axes[1].address_kind = CM1E_ADDRESS_ALIAS;
    config.axes[1].address = 1;
    expect_good();
}

/* Every combination of motors, stated or not: accepted as a bridge has it. */
static void test_motors_are_those_of_a_bridge(void)
{
    static const char *const names[] = {"", "CM1", "CM2"};
    int good = 0;
    for (int code = 0; code < 81; code++) {
        const char *motors[CM1E_BRIDGE_AXES];
        for (int i = 0, rest = code; i < CM1E_BRIDGE_AXES; i++, rest /= 3) {
            motors[i] = names[rest % 3];
            set_motor(i, motors[i]);
        }
        cm1e_device_model_t model;
        if (cm1e_bridge_model_with(motors, &model)) {
            good++;
            expect_good();
        } else {
            expect_wrong("which no bridge has together with the others");
        }
    }
    TEST_ASSERT_EQUAL(16 + 16 + 16 - 4 - 4, good); /* three models, less what fits two; none stated fits all */
    set_motor(0, "CM1-E-17S30D");
    expect_wrong("expected CM1 or CM2");
    memset(config.axes[0].motor, 'a', sizeof config.axes[0].motor);
    expect_wrong("motor is '?'");
}

static void test_every_k37_is_known_or_refused(void)
{
    for (int motor = 0; motor < 2; motor++)
        for (int k37 = 0; k37 <= UINT8_MAX; k37++) {
            setUp();
            for (int i = 0; i < CM1E_BRIDGE_AXES; i++)
                set_motor(i, motor ? "CM2" : "CM1");
            config.axes[2].k37 = (uint8_t)k37;
            if (cm1e_bridge_position_limit(motor ? CM1E_BRIDGE_CM2 : CM1E_BRIDGE_CM1, k37) > 0)
                expect_good();
            else
                expect_wrong("axis axis3: k37 is");
        }
    config.axes[2].k37_stated = false;
    expect_wrong("axis axis3: k37 is missing");
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "\"K37.3\""), diag.text);
}

static void test_peak_velocity_follows_k37(void)
{
    config.axes[1].k37 = 3; /* 1000 counts in a revolution */
    config.axes[1].max_velocity = 50;
    expect_good();
    config.axes[1].max_velocity = 50.001;
    expect_wrong("expected 2e-05 ... 50, 0.02 ... 50000 counts/s");
    config.axes[1].max_velocity = 0;
    config.axes[1].backlash = 0.1;
    config.axes[1].jog_fast = 49;
    expect_good();
    config.axes[1].jog_fast = 49.01;
    expect_wrong("jog.fast");
}

/* The least that a motor is asked for is the same part of a revolution, with 50,000 counts or with 200. */
static void test_least_motion_follows_k37(void)
{
    static const struct {
        size_t offset;
        const char *key;
        double least; /* revolutions */
    } rows[] = {
        {offsetof(cm1e_axis_config_t, max_velocity), "limits.velocity", 2e-5},
        {offsetof(cm1e_axis_config_t, max_acceleration), "limits.acceleration", 0.02},
        {offsetof(cm1e_axis_config_t, max_deceleration), "limits.deceleration", 0.02},
        {offsetof(cm1e_axis_config_t, max_jerk), "limits.jerk", 0.02},
        {offsetof(cm1e_axis_config_t, modulo_range), "unit.modulo_range", 0.02},
        {offsetof(cm1e_axis_config_t, backlash_velocity), "backlash.velocity", 2e-5},
        {offsetof(cm1e_axis_config_t, jog_slow), "jog.slow", 2e-5},
        {offsetof(cm1e_axis_config_t, jog_fast), "jog.fast", 2e-5},
    };
    static const uint8_t k37[] = {10, 0, 1, 3, 20, 40, 50};
    for (size_t k = 0; k < sizeof k37; k++)
        for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
            const double counts = cm1e_bridge_counts_per_revolution(k37[k]) * rows[i].least;
            const double below = counts < 1.0 ? 0.999 : 1.0 - 0.51 / counts; /* half a count is rounded */
            setUp();
            config.axes[0].k37 = k37[k];
            config.axes[0].backlash = strncmp(rows[i].key, "backlash", 8) == 0 ? 0.1 : 0.0;
            double *value = (double *)((char *)&config.axes[0] + rows[i].offset);
            *value = rows[i].least;
            expect_good();
            *value = rows[i].least * below;
            expect_wrong(rows[i].key);
        }
    config.axes[0].k37 = 0;
    config.axes[0].jog_fast = 0;
    config.axes[0].max_acceleration = 0.005;
    expect_wrong("limits.acceleration is 0.005, 1 counts/s2; expected 0.02 ... 500000000, 4 ... 1e+11 counts/s2");
    config.axes[0].max_acceleration = 0;
    config.axes[0].max_velocity = 1e-5;
    expect_wrong("limits.velocity is 1e-05, 0.002 counts/s; expected 2e-05 ... 50, 0.004 ... 10000 counts/s");
}

static void test_software_limits_are_where_the_motor_counts(void)
{
    config.axes[0].k37 = 3; /* 42,949,672 */
    config.axes[0].software_limit_positive = 42949.672;
    config.axes[0].software_limit_negative = -42949.672;
    expect_good();
    config.axes[0].software_limit_positive = 42949.673;
    expect_wrong("software_limits.positive is 42949.673, 42949673 counts");
    config.axes[0].software_limit_positive = INFINITY;
    expect_good();
    config.axes[0].software_limit_negative = -42949.673;
    expect_wrong("software_limits.negative");
}

/* BR 6.4.1, notes 1 to 3. */
static void test_homing_bounds_are_those_of_the_motor(void)
{
    static const struct {
        const char *motor, *part;
        double velocity, acceleration, offset;
    } bounds[] = {
        {"CM1", "100 ... 500000 counts/s", 500000, 5000000, 3276700},
        {"CM2", "100 ... 3276700 counts/s", 3276700, 32767000, 3276700},
    };
    for (int i = 0; i < 2; i++) {
        setUp();
        cm1e_axis_config_t *axis = &config.axes[i == 0 ? 0 : 2];
        axis->counts_per_unit = 1;
        axis->max_velocity = 1e6;
        strcpy(axis->motor, bounds[i].motor);
        axis->homing = (cm1e_homing_config_t){.method = 3, .velocity = bounds[i].velocity,
                                              .acceleration = bounds[i].acceleration, .offset = bounds[i].offset};
        expect_good();
        axis->homing.velocity += 1;
        expect_wrong(bounds[i].part);
        axis->homing.velocity = 99;
        expect_wrong(bounds[i].part);
        axis->homing.velocity = 100;
        axis->homing.acceleration += 1;
        expect_wrong("homing.acceleration");
        axis->homing.acceleration = 999;
        expect_wrong("homing.acceleration");
        axis->homing.acceleration = 1000;
        axis->homing.offset += 1;
        expect_wrong("homing.offset");
        axis->homing.offset *= -1;
        expect_wrong("homing.offset");
    }
}

static void test_homing_methods_are_1_to_4(void)
{
    for (int method = INT8_MIN; method <= INT8_MAX; method++) {
        config.axes[3].homing.method = (int8_t)method;
        if (method >= 0 && method <= 4)
            expect_good();
        else
            expect_wrong("homing.method");
    }
    for (int method = 0; method <= 4; method++)
        for (int code = 0; code < 4; code++) {
            const int sign = code & 1 ? 1 : -1;
            config.axes[3].homing.method = (int8_t)method;
            config.axes[3].homing.offset = sign * 3.0;
            config.axes[3].invert = code & 2;
            const int counts_sign = config.axes[3].invert ? -sign : sign;
            if ((method == 1 && counts_sign > 0) || (method == 2 && counts_sign < 0))
                expect_wrong("beyond the hard stop");
            else
                expect_good();
        }
}

static void test_a_cm1_has_no_input_1(void)
{
    config.axes[0].inputs.home = 1;
    expect_good(); /* may be a CM2 */
    set_motor(0, "CM1");
    expect_wrong("inputs.home is 1, through which a CM1 talks to the bridge");
    config.axes[0].inputs.home = 2;
    expect_good();
    config.axes[0].inputs.home = 0;
    config.axes[2].inputs.limit_negative = 1;
    set_motor(2, "CM2");
    expect_good();
}

static void test_1_ms_only(void)
{
    static const int64_t cycles[] = {200000, 250000, 500000};
    for (int i = 0; i < 3; i++) {
        config.cycle_time_ns = cycles[i];
        expect_wrong("a bridge runs at 1000 us only");
    }
    config.cycle_time_ns = 1000000;
    expect_good();
}

static void test_a_cm1e_has_none_of_it(void)
{
    config.axis_count = 1;
    config.axes[0].channel = 0;
    expect_wrong("k37 is given without a channel");
    config.axes[0].k37_stated = false;
    expect_good();
    set_motor(0, "CM2");
    expect_wrong("motor is 'CM2'");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_axes_share_an_address_by_channels);
    RUN_TEST(test_the_same_channel_of_another_bridge_is_another_motor);
    RUN_TEST(test_motors_are_those_of_a_bridge);
    RUN_TEST(test_every_k37_is_known_or_refused);
    RUN_TEST(test_peak_velocity_follows_k37);
    RUN_TEST(test_least_motion_follows_k37);
    RUN_TEST(test_software_limits_are_where_the_motor_counts);
    RUN_TEST(test_homing_bounds_are_those_of_the_motor);
    RUN_TEST(test_homing_methods_are_1_to_4);
    RUN_TEST(test_a_cm1_has_no_input_1);
    RUN_TEST(test_1_ms_only);
    RUN_TEST(test_a_cm1e_has_none_of_it);
    return UNITY_END();
}
