/* A simulated slave that plays the profile of a device: what it takes, and what it refuses. */
#include <string.h>

#include "cm1e/sdo_info.h"
#include "core/bytes.h"
#include "sim/cm1e_app.h"
#include "sim/coe_server.h"
#include "sim/esc_chip.h"
#include "sim/segment.h"
#include "unity.h"

static cm1e_bus_config_t config;
static cm1e_sim_segment_t *segment;
static cm1e_diag_t diag;

/* A CM1-E with an I/O module before it. */
void setUp(void)
{
    cm1e_bus_config_free(&config);
    cm1e_bus_config_init(&config, "sim", 1);
    config.axes[0].address = 2;
    segment = cm1e_sim_segment_create(&config, &diag);
    TEST_ASSERT_NOT_NULL(segment);
    diag = (cm1e_diag_t){0};
}
void tearDown(void) { cm1e_sim_segment_destroy(segment); }

static cm1e_sim_slave_t *slave(void) { return cm1e_sim_segment_slave(segment, 2); }

static cm1e_error_t play(const cm1e_sim_profile_entry_t *entries, size_t count)
{
    const cm1e_sim_profile_t profile = {.entries = entries, .entry_count = count};
    return cm1e_sim_segment_play(segment, 2, &profile, &diag);
}

/* The abort code; 0: `*value` was read. */
static uint32_t read(uint16_t index, uint8_t subindex, uint32_t *value)
{
    uint8_t data[8] = {0};
    size_t size = sizeof data;
    const uint32_t code = cm1e_sim_coe_read(slave(), index, subindex, false, data, &size);
    *value = cm1e_get_u32(data);
    return code;
}

static void test_values_entries_and_what_is_missing(void)
{
    const cm1e_sim_profile_entry_t entries[] = {
        {.index = 0x6502, .has_value = true, .value = 0x123},
        {.index = 0x5000, .subindex = 1, .described = true, .data_type = CM1E_TYPE_UINT, .bits = 16, .access = 0x0007,
         .has_value = true, .value = 77, .name = "New"},
        {.index = 0xFFFF, .described = true, .data_type = CM1E_TYPE_UDINT, .bits = 32, .access = 0x003F},
        {.index = 0x60FB, .subindex = 9, .missing = true},
        {.index = 0x2201, .missing = true},
    };
    uint32_t value;
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, play(entries, sizeof entries / sizeof entries[0]), diag.text);
    TEST_ASSERT_EQUAL_HEX32(0, read(0x6502, 0, &value));
    TEST_ASSERT_EQUAL_HEX32(0x123, value);
    TEST_ASSERT_EQUAL_HEX32(0, read(0x5000, 1, &value));
    TEST_ASSERT_EQUAL_UINT32(77, value);
    TEST_ASSERT_EQUAL_STRING("New", cm1e_sim_coe_entry(slave(), 0x5000, 1)->name);
    TEST_ASSERT_EQUAL_HEX32(0, read(0xFFFF, 0, &value));
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_NO_SUBINDEX, read(0x60FB, 9, &value));
    TEST_ASSERT_EQUAL_HEX32(0, read(0x60FB, 8, &value));
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_NO_OBJECT, read(0x2201, 0, &value));
    TEST_ASSERT_NULL(cm1e_sim_coe_object(slave(), 0x2201));
    TEST_ASSERT_EQUAL_HEX32(0, read(0x1000, 0, &value));
    TEST_ASSERT_EQUAL_HEX32(0x00040192, value);
}

/* What the drive itself says does not come from a profile, which has it as the device had it at some moment: with another
 * mode shown, the drive could never be enabled. An error code that UG 7.3.1 does not have is a word, too. */
static void test_what_the_drive_says_itself_is_not_played(void)
{
    static const uint16_t own[] = {0x1001, 0x603F, 0x6041, 0x6061, 0x6064, 0x606C, 0x6077, 0x60FD};
    cm1e_sim_profile_entry_t entries[2 * sizeof own / sizeof own[0]];
    const cm1e_sim_profile_code_t code = {CM1E_SIM_CODE_ERROR, 0x4502, 0x5555};
    char said[2000];
    for (size_t i = 0; i < sizeof own / sizeof own[0]; i++) {
        entries[2 * i] = (cm1e_sim_profile_entry_t){.index = own[i], .has_default = true, .default_value = 8};
        entries[2 * i + 1] = (cm1e_sim_profile_entry_t){.index = own[i], .has_value = true, .value = 9};
    }
    const cm1e_sim_profile_t profile = {.entries = entries, .entry_count = sizeof entries / sizeof entries[0],
                                        .codes = &code, .code_count = 1};
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_sim_segment_play(segment, 2, &profile, &diag), diag.text);
    const cm1e_sim_objects_t *objects = &cm1e_sim_cm1e_of(slave())->objects;
    TEST_ASSERT_EQUAL_INT(0, objects->mode_display);
    TEST_ASSERT_EQUAL_INT(0, objects->error_register);
    TEST_ASSERT_EQUAL_HEX32(0x0230, objects->statusword);
    TEST_ASSERT_EQUAL_INT(0, objects->position);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_sim_console(segment, "show 2", said, sizeof said));
    TEST_ASSERT_NOT_NULL(strstr(said, "error 0x5555"));
    TEST_ASSERT_NOT_NULL(strstr(said, "only its profile has"));
}

/* A description that no simulated value can have is left alone; of two rows the last one counts. */
static void test_odd_profiles_do_no_harm(void)
{
    const cm1e_sim_profile_entry_t entries[] = {
        {.index = 0x6502, .described = true, .data_type = CM1E_TYPE_UDINT, .bits = 4096, .access = 0xFFFF},
        {.index = 0x5001, .described = true, .data_type = 0x000A, .bits = 65535, .access = 0xFFFF},
        {.index = 0x1600, .subindex = 0, .has_value = true, .value = UINT8_MAX},
        {.index = 0x1600, .subindex = 1, .has_value = true, .value = 0},
        {.index = 0x1600, .subindex = 2, .has_value = true, .value = 0x60FE0018},
        {.index = 0x1600, .subindex = 3, .has_value = true, .value = 0xABCD00FF},
        {.index = 0x6084, .has_value = true, .value = 1},
        {.index = 0x6084, .has_value = true, .value = 2000},
        {.index = 0x6075, .described = true, .data_type = CM1E_TYPE_STRING, .bits = 64, .access = 0x0007},
        {.index = 0x5002, .has_value = true, .value = 2},
    };
    uint32_t value;
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, play(entries, sizeof entries / sizeof entries[0]), diag.text);
    TEST_ASSERT_EQUAL_UINT16(32, cm1e_sim_coe_entry(slave(), 0x6502, 0)->bits);
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_NO_OBJECT, read(0x5001, 0, &value));
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_NO_OBJECT, read(0x5002, 0, &value));
    TEST_ASSERT_EQUAL_HEX32(0, read(0x6084, 0, &value));
    TEST_ASSERT_EQUAL_UINT32(2000, value);
    TEST_ASSERT_EQUAL_HEX32(0, read(0x6075, 0, &value));
    uint16_t outputs, inputs;
    slave()->ops->process_data_sizes(slave()->app, &outputs, &inputs);
    TEST_ASSERT_EQUAL_UINT16(0 + 3 + 31 + 4 + 1, outputs); /* of five entries, two as the tables have them */
    uint8_t data[39] = {0};
    slave()->ops->outputs(slave()->app, data, outputs, 0);
}

static void test_a_profile_that_is_all_zero_changes_nothing(void)
{
    uint32_t before, after;
    TEST_ASSERT_EQUAL_HEX32(0, read(0x1018, 3, &before));
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, play(NULL, 0), diag.text);
    TEST_ASSERT_EQUAL_HEX32(0, read(0x1018, 3, &after));
    TEST_ASSERT_EQUAL_HEX32(before, after);
}

/* Numbers that the type of the entry, of the profile or of the tables, does not have; nothing of such a profile is taken,
 * its EEPROM neither. Then a good profile is played. */
static void test_numbers_beyond_their_types_are_refused(void)
{
    const cm1e_sim_profile_entry_t rows[] = {
        {.index = 0x1600, .has_value = true, .value = UINT8_MAX + 1},
        {.index = 0x6084, .has_default = true, .default_value = -1},
        {.index = 0x6084, .has_maximum = true, .maximum = INT64_C(1) << 32},
        {.index = 0x6098, .has_minimum = true, .minimum = INT8_MIN - 1},
        {.index = 0x5001, .described = true, .data_type = CM1E_TYPE_UINT, .bits = 16, .access = 7, .has_value = true,
         .value = INT64_MAX},
    };
    const cm1e_sim_profile_entry_t good = {.index = 0x6084, .has_value = true, .value = 2000};
    uint32_t value;
    const uint8_t other[512] = {0}, *const before = slave()->sii;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const cm1e_sim_profile_t profile = {.entries = &rows[i], .entry_count = 1, .sii = other, .sii_size = sizeof other};
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FILE, cm1e_sim_segment_play(segment, 2, &profile, &diag));
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "which its type does not have"), diag.text);
        TEST_ASSERT_EQUAL_PTR(before, slave()->sii);
    }
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, play(&good, 1), diag.text);
    TEST_ASSERT_EQUAL_HEX32(0, read(0x6084, 0, &value));
    TEST_ASSERT_EQUAL_UINT32(2000, value);
}

static void test_refusals_say_why(void)
{
    const uint8_t sii[16] = {0};
    const cm1e_sim_profile_t nothing = {0}, cut = {.sii = sii, .sii_size = sizeof sii};
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_NOT_FOUND, cm1e_sim_segment_play(segment, 3, &nothing, &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "2 slaves"));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_UNSUPPORTED, cm1e_sim_segment_play(segment, 1, &nothing, &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "only a CM1-E, a bridge and a drive by CiA 402"));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FILE, cm1e_sim_segment_play(segment, 2, &cut, &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "16 bytes"));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_sim_segment_play(segment, 2, &nothing, &diag));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_STATE, cm1e_sim_segment_play(segment, 2, &nothing, &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "already"));
}

/* A drive by CiA 402: values, defaults and mappings of the profile, and odd ones do no harm. */
static void test_a_drive_by_cia402_plays(void)
{
    const cm1e_sim_profile_entry_t entries[] = {
        {.index = 0x6065, .has_default = true, .default_value = 4711},
        {.index = 0x6502, .has_value = true, .value = 0x25},
        {.index = 0x100A, .text = "7.3"},
        {.index = 0x1600, .subindex = 0, .has_value = true, .value = 4},
        {.index = 0x1600, .subindex = 1, .has_value = true, .value = 0x60400010},
        {.index = 0x1600, .subindex = 2, .has_value = true, .value = 0x607A0040}, /* more than an object has */
        {.index = 0x1600, .subindex = 3, .has_value = true, .value = 0xABCD00FF}, /* not there */
        {.index = 0x1600, .subindex = 4, .has_value = true, .value = 0x60600003}, /* less than a byte */
        {.index = 0x1A00, .subindex = 0, .has_value = true, .value = UINT8_MAX},
    };
    uint32_t value;
    uint16_t outputs, inputs;
    uint8_t data[256] = {0x0F};
    cm1e_sim_segment_destroy(segment);
    strcpy(config.axes[0].device, "cia402");
    config.axes[0].counts_per_revolution = 131072;
    config.axes[0].max_speed_rpm = 3000;
    segment = cm1e_sim_segment_create(&config, &diag);
    TEST_ASSERT_NOT_NULL_MESSAGE(segment, diag.text);
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, play(entries, sizeof entries / sizeof entries[0]), diag.text);
    TEST_ASSERT_EQUAL_HEX32(0, read(0x6065, 0, &value));
    TEST_ASSERT_EQUAL_UINT32(4711, value);
    TEST_ASSERT_EQUAL_HEX32(0, read(0x6502, 0, &value));
    TEST_ASSERT_EQUAL_HEX32(0x25, value);
    TEST_ASSERT_EQUAL_STRING("7.3", cm1e_sim_coe_entry(slave(), 0x100A, 0)->default_string);
    slave()->ops->process_data_sizes(slave()->app, &outputs, &inputs);
    TEST_ASSERT_EQUAL_UINT16(2 + 8 + 31 + 0, outputs);
    slave()->ops->outputs(slave()->app, data, outputs, 0);
    slave()->ops->inputs(slave()->app, data, inputs);
    TEST_ASSERT_EQUAL_HEX32(0, read(0x6040, 0, &value));
    TEST_ASSERT_EQUAL_HEX32(0x0F, value);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_values_entries_and_what_is_missing);
    RUN_TEST(test_what_the_drive_says_itself_is_not_played);
    RUN_TEST(test_odd_profiles_do_no_harm);
    RUN_TEST(test_a_profile_that_is_all_zero_changes_nothing);
    RUN_TEST(test_numbers_beyond_their_types_are_refused);
    RUN_TEST(test_refusals_say_why);
    RUN_TEST(test_a_drive_by_cia402_plays);
    return UNITY_END();
}
