#include <stdio.h>
#include <string.h>

#include "device/device.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

/* UG 7.3.1: code, error register, fault bit ("0", "1", "0/1"), description. */
static const struct {
    uint16_t code;
    uint8_t error_register;
    const char *fault;
    const char *description;
} manual[] = {
    {0x0000, 0x00, "0", "No error"},
    {0x2310, 0x03, "1", "Continuous over current error (torque overload)"},
    {0x4310, 0x09, "1", "Drive over temperature"},
    {0x4502, 0x00, "0", "No mode selected (0x6060=0)"},
    {0x7310, 0x81, "1", "Over speed error"},
    {0x7320, 0x81, "1", "Position Error overflow"},
    {0x7500, 0x11, "1", "Motor communication error"},
    {0x7510, 0x11, "1", "Motor drive to EtherCAT slave communication error"},
    {0x8611, 0x00, "0", "Motor not currently following commanded position"},
    {0xFF01, 0x00, "0", "Motor disabled by command"},
    {0xFF04, 0x81, "1", "Emergency stop active"},
    {0xFF05, 0x11, "0/1", "24V drive power not present"},
};
enum { ROWS = sizeof manual / sizeof manual[0] };

static void test_error_rows_are_the_manuals(void)
{
    TEST_ASSERT_EQUAL(ROWS, cm1e_device_error_count);
    for (int i = 0; i < ROWS; i++) {
        const cm1e_device_error_t *error = cm1e_device_error(manual[i].code);
        TEST_ASSERT_NOT_NULL(error);
        TEST_ASSERT_EQUAL_PTR(&cm1e_device_errors[i], error);
        TEST_ASSERT_EQUAL_HEX8(manual[i].error_register, error->error_register);
        TEST_ASSERT_EQUAL_STRING(manual[i].description, error->text);
        TEST_ASSERT_EQUAL(strchr(manual[i].fault, '1') != NULL, error->fault);
        TEST_ASSERT_EQUAL(strcmp(manual[i].fault, "0/1") == 0, error->fault_only_when_enabled);
        TEST_ASSERT_GREATER_THAN(5, strlen(error->cure));
    }
}

static void test_every_other_code_is_not_found(void)
{
    int found = 0;
    for (uint32_t code = 0; code <= 0xFFFF; code++) {
        const cm1e_device_error_t *error = cm1e_device_error((uint16_t)code);
        if (!error)
            continue;
        TEST_ASSERT_EQUAL_HEX16(code, error->code);
        found++;
    }
    TEST_ASSERT_EQUAL(ROWS, found);
}

/* UG 7.1.2: "The generic error bit is set on all errors." */
static void test_generic_bit_is_set_on_all_errors(void)
{
    for (size_t i = 0; i < cm1e_device_error_count; i++)
        TEST_ASSERT_EQUAL(cm1e_device_errors[i].fault, cm1e_device_errors[i].error_register & 1);
}

/* UG 3.2 table 1 and UG 6.3 */
static void test_motors_are_the_manuals(void)
{
    static const struct {
        const char *name;
        double torque, current;
        int32_t pulses_per_s, rpm;
    } motors[4] = {
        {"CM1-E-17S30D", 0.117, 1.0, 2500000, 3000},
        {"CM1-E-17L30D", 0.54, 1.8, 2500000, 3000},
        {"CM1-E-23S30D", 0.46, 5.1, 2500000, 3000},
        {"CM1-E-23L20D", 1.24, 3.4, 1666666, 2000},
    };
    for (int i = 0; i < 4; i++) {
        const cm1e_motor_t *motor = cm1e_device_motor(motors[i].name);
        TEST_ASSERT_EQUAL_PTR(&cm1e_device_motors[i], motor);
        TEST_ASSERT_TRUE(motors[i].torque == motor->peak_torque_nm);
        TEST_ASSERT_TRUE(motors[i].current == motor->peak_current_a);
        TEST_ASSERT_EQUAL_INT32(motors[i].pulses_per_s, motor->max_velocity_counts_per_s);
        TEST_ASSERT_EQUAL_INT32((int64_t)motors[i].rpm * CM1E_COUNTS_PER_REVOLUTION / 60,
                                motor->max_velocity_counts_per_s);
    }
}

static void test_motor_without_name_is_the_first_and_unknown_is_none(void)
{
    TEST_ASSERT_EQUAL_PTR(&cm1e_device_motors[0], cm1e_device_motor(""));
    TEST_ASSERT_EQUAL_PTR(&cm1e_device_motors[0], cm1e_device_motor(NULL));
    TEST_ASSERT_NULL(cm1e_device_motor("CM1-E-17S30"));
    TEST_ASSERT_NULL(cm1e_device_motor("CM1-E-17S30D "));
    TEST_ASSERT_NULL(cm1e_device_motor("cm1-e-17s30d"));
}

static void test_cycle_times_are_the_manuals(void)
{
    static const int64_t microseconds[4] = {200, 250, 500, 1000};
    for (int i = 0; i < 4; i++)
        TEST_ASSERT_EQUAL_INT64(microseconds[i] * 1000, cm1e_device_cycle_times_ns[i]);
}

static void test_firmware_rows_are_in_order_and_parse_back(void)
{
    for (int i = 0; i < CM1E_FIRMWARE_COUNT; i++) {
        const cm1e_firmware_info_t *info = cm1e_firmware_info((cm1e_firmware_t)i);
        TEST_ASSERT_NOT_NULL(info);
        TEST_ASSERT_EQUAL(i, info->firmware);
        TEST_ASSERT_EQUAL_PTR(info, cm1e_firmware_from_version(info->version));
    }
    TEST_ASSERT_NULL(cm1e_firmware_info(CM1E_FIRMWARE_COUNT));
    TEST_ASSERT_NULL(cm1e_firmware_info((cm1e_firmware_t)-1));
}

/* UG 10.1: the first firmware that has each feature; a feature never goes away again. */
static void test_firmware_features_begin_where_the_manual_says(void)
{
    for (int i = 0; i < CM1E_FIRMWARE_COUNT; i++) {
        const cm1e_firmware_info_t *info = cm1e_firmware_info((cm1e_firmware_t)i);
        TEST_ASSERT_EQUAL_HEX32(i >= CM1E_FIRMWARE_1_3_0 ? 0x20020103 : 0x20020001, info->revision);
        TEST_ASSERT_EQUAL(i < CM1E_FIRMWARE_1_3_3, info->velocity_in_counts_per_ms);
        TEST_ASSERT_EQUAL(i < CM1E_FIRMWARE_1_3_0, info->velocity_quarter_in_hm_pp);
        TEST_ASSERT_EQUAL(i >= CM1E_FIRMWARE_1_3_0, info->watchdog);
        TEST_ASSERT_EQUAL(i >= CM1E_FIRMWARE_1_3_0, info->mode_in_profile_pdo);
        TEST_ASSERT_EQUAL(i >= CM1E_FIRMWARE_1_3_0, info->following_bit);
        TEST_ASSERT_EQUAL(i >= CM1E_FIRMWARE_1_3_2, info->all_cycle_times);
        TEST_ASSERT_EQUAL_UINT32(i >= CM1E_FIRMWARE_1_3_2 ? 200000 : 1000000, info->shortest_cycle_ns);
        TEST_ASSERT_EQUAL(i >= CM1E_FIRMWARE_1_3_4, info->user_variables);
        TEST_ASSERT_EQUAL(i >= CM1E_FIRMWARE_1_3_5, info->communication_fault_resets);
        TEST_ASSERT_EQUAL(i >= CM1E_FIRMWARE_1_3_5, info->fault_bit_on_7510);
    }
}

static void test_dictionary_shows_the_newest_firmware(void)
{
    const cm1e_firmware_info_t *newest = cm1e_firmware_info((cm1e_firmware_t)(CM1E_FIRMWARE_COUNT - 1));
    TEST_ASSERT_EQUAL_STRING(newest->version, cm1e_device_entry(0x100A, 0)->default_string);
    TEST_ASSERT_EQUAL_HEX32(newest->revision, cm1e_device_entry(0x1018, 3)->default_value);
    TEST_ASSERT_EQUAL_UINT32(newest->shortest_cycle_ns, cm1e_device_entry(0x1C32, 5)->default_value);
}

static void test_firmware_version_is_parsed(void)
{
    static const struct {
        const char *text, *found; /* NULL: not a version */
    } versions[] = {
        {"1.3.5", "1.3.5"},   {"V1.3.5", "1.3.5"}, {"v1.3.5", "1.3.5"},   {"1.3.7", "1.3.5"},  {"1.4.0", "1.3.5"},
        {"2.0.0", "1.3.5"},   {"1.3.1", "1.3.0"},  {"1.3.4  ", "1.3.4"},  {"1.3", "1.3.0"},    {"1.2.9", "1.2.0"},
        {"1.10.0", "1.3.5"},  {"1.1.3", "1.2.0"},  {"1.0.0", "1.2.0"},    {"0.0.0", "1.2.0"},  {"999.999.999", "1.3.5"},
        {"01.03.02", "1.3.2"}, {"", NULL},         {"V", NULL},           {"1", NULL},         {"1.", NULL},
        {"1.3.", NULL},       {".1.3", NULL},      {"1.3.5.1", NULL},     {"1.3.5b", NULL},    {"1.3.x", NULL},
        {"-1.3.5", NULL},     {"1.-3.5", NULL},    {" 1.3.5", NULL},      {"VV1.3.5", NULL},   {"1.3.1000", NULL},
        {"99999999999999999999.1.1", NULL},        {"\xff\xfe", NULL},    {"1..3", NULL},      {"1.3.5 x", NULL},
    };
    for (size_t i = 0; i < sizeof versions / sizeof versions[0]; i++) {
        const cm1e_firmware_info_t *info = cm1e_firmware_from_version(versions[i].text);
        TEST_ASSERT_EQUAL_STRING_MESSAGE(versions[i].found ? versions[i].found : "none", info ? info->version : "none",
                                         versions[i].text);
    }
    TEST_ASSERT_NULL(cm1e_firmware_from_version(NULL));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_error_rows_are_the_manuals);
    RUN_TEST(test_every_other_code_is_not_found);
    RUN_TEST(test_generic_bit_is_set_on_all_errors);
    RUN_TEST(test_motors_are_the_manuals);
    RUN_TEST(test_motor_without_name_is_the_first_and_unknown_is_none);
    RUN_TEST(test_cycle_times_are_the_manuals);
    RUN_TEST(test_firmware_rows_are_in_order_and_parse_back);
    RUN_TEST(test_firmware_features_begin_where_the_manual_says);
    RUN_TEST(test_dictionary_shows_the_newest_firmware);
    RUN_TEST(test_firmware_version_is_parsed);
    return UNITY_END();
}
