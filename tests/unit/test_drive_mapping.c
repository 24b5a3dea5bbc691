/* Where the objects lie, units on the wire, and the mode where 0x6060 is not in the process data. */
#include <string.h>

#include "drive/drive.h"
#include "unity.h"

#include "../support/fake_bus.h"

static const int64_t cycle_ns = 1000000;
static cm1e_bus_t bus;
static cm1e_drive_t drive;
static cm1e_diag_t diag;

void setUp(void) {}
void tearDown(void) {}

static void drop(cm1e_pdo_t *pdo, uint16_t index)
{
    for (unsigned i = 0; i < pdo->entry_count; i++)
        if (pdo->entries[i].index == index)
            pdo->entries[i].index = 0; /* a gap of the same length */
}

static void cycle(void)
{
    fake_bus_cycle(&bus, cycle_ns);
    cm1e_drive_read(&drive, true, bus.clock.virtual_now_ns);
    cm1e_drive_write(&drive);
}

static void enable(cm1e_mode_t mode)
{
    drive.command.mode = mode;
    drive.command.enable = true;
    for (int i = 0; i < 400 && !drive.feedback.enabled; i++)
        cycle();
    TEST_ASSERT_TRUE(drive.feedback.enabled);
    TEST_ASSERT_EQUAL_INT8(mode, drive.feedback.mode);
}

static void test_missing_object_is_named_with_its_mapping(void)
{
    static const struct {
        cm1e_mapping_t mapping;
        uint16_t index;
        const char *name;
    } rows[] = {
        {CM1E_MAPPING_DYNAMIC, 0x6040, "dynamic"}, {CM1E_MAPPING_DYNAMIC, 0x607A, "dynamic"},
        {CM1E_MAPPING_DYNAMIC, 0x60FF, "dynamic"}, {CM1E_MAPPING_DYNAMIC, 0x6060, "dynamic"},
        {CM1E_MAPPING_DYNAMIC, 0x6041, "dynamic"}, {CM1E_MAPPING_DYNAMIC, 0x6064, "dynamic"},
        {CM1E_MAPPING_DYNAMIC, 0x6061, "dynamic"}, {CM1E_MAPPING_CSP, 0x607A, "CSP"},
        {CM1E_MAPPING_CSP, 0x6041, "CSP"},         {CM1E_MAPPING_CSV, 0x60FF, "CSV"},
        {CM1E_MAPPING_CSV, 0x6064, "CSV"},         {CM1E_MAPPING_PROFILE, 0x607A, "profile"},
        {CM1E_MAPPING_PROFILE, 0x6061, "profile"}, {CM1E_MAPPING_PROFILE, 0x6060, "profile"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        fake_bus_init(&bus, rows[i].mapping, CM1E_PDO_ORDER_UG_7_2, CM1E_FIRMWARE_1_3_5);
        drop(&bus.rx, rows[i].index);
        drop(&bus.tx, rows[i].index);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_PDO_MAPPING, cm1e_drive_init(&drive, &bus, 0, &diag));
        char object[8];
        snprintf(object, sizeof object, "0x%04X", rows[i].index);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, object), diag.text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, rows[i].name), diag.text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "slide"), diag.text);
    }
}

/* An object of so many bits in the mapping; false: it is not mapped. */
static bool resize(cm1e_pdo_t *pdo, uint16_t index, int bits)
{
    for (unsigned i = 0; i < pdo->entry_count; i++)
        if (pdo->entries[i].index == index) {
            pdo->entries[i].bits = (uint8_t)bits;
            return true;
        }
    return false;
}

/* A byte less than the shortest that can be read, and one more than the longest. */
static void test_object_of_a_wrong_size_is_refused(void)
{
    static const struct {
        uint16_t index;
        int least, most; /* bytes */
    } rows[] = {
        {0x6040, 2, 2}, {0x607A, 4, 4}, {0x60FF, 4, 4}, {0x6060, 1, 1}, {0x60FE, 2, 4}, {0x6081, 4, 4}, {0x6083, 4, 4},
        {0x6041, 2, 2}, {0x603F, 2, 2}, {0x6064, 4, 4}, {0x606C, 4, 4}, {0x6077, 2, 4}, {0x60FD, 2, 4}, {0x2301, 2, 4},
        {0x6079, 2, 4}, {0x6061, 1, 1},
    };
    unsigned tried = 0;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        for (int mapping = 0; mapping <= CM1E_MAPPING_PROFILE; mapping++)
            for (int bytes = rows[i].least - 1; bytes <= rows[i].most + 1; bytes++) {
                const bool right = bytes >= rows[i].least && bytes <= rows[i].most;
                fake_bus_init(&bus, (cm1e_mapping_t)mapping, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
                const bool out = resize(&bus.rx, rows[i].index, 8 * bytes);
                if (bytes == 0 || (!resize(&bus.tx, rows[i].index, 8 * bytes) && !out))
                    continue;
                char object[8];
                snprintf(object, sizeof object, "0x%04X", rows[i].index);
                TEST_ASSERT_EQUAL_INT_MESSAGE(right ? CM1E_OK : CM1E_ERROR_PDO_MAPPING,
                                              cm1e_drive_init(&drive, &bus, 0, &diag), object);
                TEST_ASSERT_TRUE(right || strstr(diag.text, object));
                tried += !right;
            }
    TEST_ASSERT_GREATER_THAN_UINT(50, tried);
}

static void test_digital_outputs_of_every_size_arrive_and_nothing_beside_them(void)
{
    for (int bytes = 2; bytes <= 4; bytes++) {
        fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        TEST_ASSERT_TRUE(resize(&bus.rx, 0x60FE, 8 * bytes));
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_init(&drive, &bus, 0, &diag));
        drive.command.digital_outputs = 0x8005;
        cycle();
        TEST_ASSERT_EQUAL_HEX32(0x8005, fake_output(&bus, 0x60FE, 0));
        uint8_t with[sizeof bus.outputs];
        memcpy(with, bus.outputs, sizeof with);
        drive.command.digital_outputs = 0;
        cm1e_drive_write(&drive);
        unsigned changed = 0;
        for (size_t i = 0; i < sizeof with; i++)
            changed += with[i] != bus.outputs[i];
        TEST_ASSERT_EQUAL_UINT(2, changed);
    }
}

static void test_wrong_axis_motor_or_firmware_is_an_error_in_words(void)
{
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, cm1e_drive_init(&drive, &bus, 1, &diag));
    snprintf(bus.config.axes[0].motor, sizeof bus.config.axes[0].motor, "CM2");
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_CONFIG, cm1e_drive_init(&drive, &bus, 0, &diag));
    bus.config.axes[0].motor[0] = '\0';
    bus.firmware_unreadable = true;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_CONFIG, cm1e_drive_init(&drive, &bus, 0, &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "0x100A"));
    bus.config.axes[0].velocity_unit_stated = true;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_init(&drive, &bus, 0, &diag));
}

/* Here the firmware that can be read says the other unit. */
static void test_a_stated_unit_of_velocity_counts_more_than_the_firmware(void)
{
    for (int unreadable = 0; unreadable < 2; unreadable++)
        for (int per_ms = 0; per_ms < 2; per_ms++) {
            fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4,
                          per_ms ? CM1E_FIRMWARE_1_3_5 : CM1E_FIRMWARE_1_3_0);
            bus.firmware_unreadable = unreadable;
            bus.config.axes[0].velocity_unit_stated = true;
            bus.config.axes[0].velocity_in_counts_per_ms = per_ms;
            TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_init(&drive, &bus, 0, &diag));
            enable(CM1E_MODE_CSV);
            drive.command.target_velocity = 123000;
            cm1e_drive_write(&drive);
            TEST_ASSERT_EQUAL_INT32(per_ms ? 123 : 123000, (int32_t)fake_output(&bus, 0x60FF, 0));
            drive.command.target_velocity = INT32_MAX;
            cm1e_drive_write(&drive);
            TEST_ASSERT_EQUAL_INT32(per_ms ? 2500 : 2500000, (int32_t)fake_output(&bus, 0x60FF, 0)); /* UG 6.3 */
        }
}

static void test_velocity_has_the_unit_of_the_firmware_and_is_limited(void)
{
    static const char *const motors[] = {"CM1-E-17S30D", "CM1-E-17L30D", "CM1-E-23S30D", "CM1-E-23L20D"};
    static const int32_t wanted[] = {0, 1, 499, 501, 123456, 1666666, 1666667, 2500000, 2500001, INT32_MAX, INT32_MIN,
                                     -1, -1666667, -2500001};
    for (int firmware = 0; firmware < CM1E_FIRMWARE_COUNT; firmware++)
        for (int m = 0; m < 4; m++)
            for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; i++) {
                fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, (cm1e_firmware_t)firmware);
                snprintf(bus.config.axes[0].motor, sizeof bus.config.axes[0].motor, "%s", motors[m]);
                TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_init(&drive, &bus, 0, &diag));
                enable(CM1E_MODE_CSV);
                drive.command.target_velocity = wanted[i];
                cm1e_drive_write(&drive);
                const int32_t raw = (int32_t)fake_output(&bus, 0x60FF, 0);
                const int64_t peak = m == 3 ? 1666666 : 2500000; /* UG 6.3 */
                int64_t expected = wanted[i];
                expected = expected > peak ? peak : expected < -peak ? -peak : expected;
                if (firmware < CM1E_FIRMWARE_1_3_3) {
                    TEST_ASSERT_INT64_WITHIN(999, expected, INT64_C(1000) * raw);
                    TEST_ASSERT_TRUE(INT64_C(1000) * raw <= peak && INT64_C(1000) * raw >= -peak);
                } else {
                    TEST_ASSERT_EQUAL_INT64(expected, raw);
                }
            }
}

static void test_actual_velocity_has_counts_per_second_in_every_firmware(void)
{
    for (int firmware = 0; firmware < CM1E_FIRMWARE_COUNT; firmware++) {
        fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, (cm1e_firmware_t)firmware);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_init(&drive, &bus, 0, &diag));
        bus.velocity_raw = -2000;
        cycle();
        TEST_ASSERT_EQUAL_INT32(firmware < CM1E_FIRMWARE_1_3_3 ? -2000000 : -2000, drive.feedback.velocity);
        bus.velocity_raw = INT32_MIN; /* garbage must not overflow */
        cycle();
        TEST_ASSERT_EQUAL_INT32(INT32_MIN, drive.feedback.velocity);
    }
}

static void test_velocity_below_1_3_0_in_homing_comes_from_positions(void)
{
    for (int firmware = 0; firmware < CM1E_FIRMWARE_COUNT; firmware++) {
        fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, (cm1e_firmware_t)firmware);
        bus.position = INT32_MAX - 100; /* across the wrap */
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_init(&drive, &bus, 0, &diag));
        fake_bus_show(&bus);
        enable(CM1E_MODE_HM);
        bus.velocity_raw = 50;
        for (int i = 0; i < 3; i++) {
            bus.position = (int32_t)((uint32_t)bus.position + 200u);
            cycle();
        }
        const int32_t shown = firmware < CM1E_FIRMWARE_1_3_3 ? 50000 : 50;
        TEST_ASSERT_EQUAL_INT32(firmware < CM1E_FIRMWARE_1_3_0 ? 200000 : shown, drive.feedback.velocity);
    }
}

/* Behind a pause the next frame comes a planned cycle after the last one, and brings the way of the whole pause. */
static void test_velocity_from_positions_has_the_time_of_any_pause(void)
{
    for (int64_t pause_s = 1; pause_s < 100; pause_s++) {
        fake_bus_init(&bus, CM1E_MAPPING_CSP, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        drop(&bus.tx, 0x606C);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_init(&drive, &bus, 0, &diag));
        fake_bus_show(&bus);
        cycle();
        bus.position += (int32_t)(pause_s * 10000);
        fake_bus_show(&bus);
        bus.sent_ns += pause_s * 1000000000;
        cm1e_drive_read(&drive, true, drive.now_ns + cycle_ns);
        TEST_ASSERT_EQUAL_INT32(10000, drive.feedback.velocity);
    }
}

static void test_inputs_of_both_orders_are_decoded(void)
{
    for (int mapping = CM1E_MAPPING_DYNAMIC; mapping <= CM1E_MAPPING_PROFILE; mapping++)
        for (int order = CM1E_PDO_ORDER_UG_4_4; order <= CM1E_PDO_ORDER_UG_7_2; order++) {
            fake_bus_init(&bus, (cm1e_mapping_t)mapping, (cm1e_pdo_order_t)order, CM1E_FIRMWARE_1_3_5);
            TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_init(&drive, &bus, 0, &diag));
            bus.position = -7654321;
            bus.velocity_raw = 4321;
            bus.digital_inputs = 0x000B;
            bus.error_code = 0x8611;
            fake_bus_show(&bus);
            fake_input(&bus, OBJ_6077_TORQUE_ACTUAL_VALUE, (uint32_t)-250);
            fake_input(&bus, OBJ_2301_TEMPERATURE, (uint32_t)-12);
            fake_input(&bus, OBJ_6079_DC_LINK_VOLTAGE, 241);
            cm1e_drive_read(&drive, true, cycle_ns);
            TEST_ASSERT_EQUAL_INT32(-7654321, drive.feedback.position);
            TEST_ASSERT_EQUAL_INT32(4321, drive.feedback.velocity);
            TEST_ASSERT_EQUAL_HEX16(0x000B, drive.feedback.digital_inputs);
            TEST_ASSERT_EQUAL_HEX16(0x8611, drive.feedback.error_code);
            TEST_ASSERT_EQUAL_INT16(drive.image.in_torque.bytes ? -250 : 0, drive.feedback.torque);
            TEST_ASSERT_EQUAL_INT16(drive.image.in_temperature.bytes ? -12 : 0, drive.feedback.temperature);
            TEST_ASSERT_EQUAL_INT32(drive.image.in_dc.bytes ? 241 : 0, drive.feedback.dc_link_decivolt);
            TEST_ASSERT_TRUE(drive.feedback.voltage);
            TEST_ASSERT_TRUE(drive.feedback.digital_known);
        }
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    drop(&bus.tx, OBJ_60FD_DIGITAL_INPUTS);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_init(&drive, &bus, 0, &diag));
    TEST_ASSERT_FALSE(drive.feedback.digital_known);
}

static void test_32_bit_torque_saturates(void)
{
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    for (unsigned i = 0; i < bus.tx.entry_count; i++)
        if (bus.tx.entries[i].index == OBJ_6077_TORQUE_ACTUAL_VALUE)
            bus.tx.entries[i].bits = 32; /* UG 7.2 */
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_init(&drive, &bus, 0, &diag));
    fake_bus_show(&bus);
    fake_input(&bus, OBJ_6077_TORQUE_ACTUAL_VALUE, 1000000);
    cm1e_drive_read(&drive, true, 1);
    TEST_ASSERT_EQUAL_INT16(INT16_MAX, drive.feedback.torque);
    fake_input(&bus, OBJ_6077_TORQUE_ACTUAL_VALUE, (uint32_t)-999);
    cm1e_drive_read(&drive, true, 2);
    TEST_ASSERT_EQUAL_INT16(-999, drive.feedback.torque);
}

/* Sizes that the manual leaves open are read with their sign. */
static void test_24_bit_torque_has_a_sign(void)
{
    fake_bus_init(&bus, CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    TEST_ASSERT_TRUE(resize(&bus.tx, OBJ_6077_TORQUE_ACTUAL_VALUE, 24));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_init(&drive, &bus, 0, &diag));
    fake_bus_show(&bus);
    for (int value = -1000; value <= 1000; value += 250) {
        fake_input(&bus, OBJ_6077_TORQUE_ACTUAL_VALUE, (uint32_t)value & 0xFFFFFF);
        cm1e_drive_read(&drive, true, cycle_ns);
        TEST_ASSERT_EQUAL_INT16(value, drive.feedback.torque);
    }
}

static void test_profile_objects_carry_the_limits_of_the_configuration(void)
{
    static const struct {
        double counts_per_unit, velocity, acceleration;
        bool kilo;
        uint32_t velocity_raw, acceleration_raw;
    } rows[] = {
        {0, 0, 0, false, 2500000, 5000000},        {0, 10, 20, false, 500000, 1000000},
        {1000, 100, 50000, true, 100000, 50000 < 32767 ? 50000 : 32767},
        {0, 1000, 1e-9, false, 2500000, 1000},     {0, 1, 1e9, true, 50000, 32767},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        fake_bus_init(&bus, CM1E_MAPPING_PROFILE, CM1E_PDO_ORDER_UG_7_2, CM1E_FIRMWARE_1_3_5);
        bus.config.axes[0].counts_per_unit = rows[i].counts_per_unit;
        bus.config.axes[0].max_velocity = rows[i].velocity;
        bus.config.axes[0].max_acceleration = rows[i].acceleration;
        bus.config.axes[0].acceleration_in_kpulses = rows[i].kilo;
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_init(&drive, &bus, 0, &diag));
        cm1e_drive_write(&drive);
        cycle();
        TEST_ASSERT_EQUAL_UINT32(rows[i].velocity_raw, bus.profile_velocity);
        TEST_ASSERT_EQUAL_UINT32(rows[i].acceleration_raw, bus.profile_acceleration);
    }
}

static void test_mappings_support_the_modes_whose_targets_they_have(void)
{
    static const struct {
        cm1e_mapping_t mapping;
        bool pp, pv, hm, csp, csv;
    } rows[] = {
        {CM1E_MAPPING_DYNAMIC, true, true, true, true, true},
        {CM1E_MAPPING_CSP, true, false, true, true, false},
        {CM1E_MAPPING_CSV, false, true, true, false, true},
        {CM1E_MAPPING_PROFILE, true, true, true, true, true},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        fake_bus_init(&bus, rows[i].mapping, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_init(&drive, &bus, 0, &diag));
        TEST_ASSERT_EQUAL_INT(rows[i].pp, cm1e_drive_supports(&drive, CM1E_MODE_PP));
        TEST_ASSERT_EQUAL_INT(rows[i].pv, cm1e_drive_supports(&drive, CM1E_MODE_PV));
        TEST_ASSERT_EQUAL_INT(rows[i].hm, cm1e_drive_supports(&drive, CM1E_MODE_HM));
        TEST_ASSERT_EQUAL_INT(rows[i].csp, cm1e_drive_supports(&drive, CM1E_MODE_CSP));
        TEST_ASSERT_EQUAL_INT(rows[i].csv, cm1e_drive_supports(&drive, CM1E_MODE_CSV));
        TEST_ASSERT_FALSE(cm1e_drive_supports(&drive, CM1E_MODE_NONE));
    }
}

static void test_mode_over_sdo_is_set_before_and_switched_in_the_cycle(void)
{
    fake_bus_init(&bus, CM1E_MAPPING_CSP, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.mode = bus.sdo_mode = CM1E_MODE_NONE;
    bus.sdo_delay = 7;
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_init(&drive, &bus, 0, &diag));
    TEST_ASSERT_EQUAL_HEX16(0x6060, bus.sdo_log[0].index);
    TEST_ASSERT_EQUAL_INT64(CM1E_MODE_CSP, bus.sdo_log[0].value);
    fake_bus_show(&bus);
    enable(CM1E_MODE_CSP);
    drive.command.target_position = bus.position;
    for (int round = 0; round < 3; round++) {
        bus.mode_delay = bus.mode_wait = 30;
        drive.command.mode = CM1E_MODE_HM;
        drive.command.homing_start = true;
        for (int i = 0; i < 500 && !(drive.feedback.enabled && drive.feedback.mode == CM1E_MODE_HM); i++) {
            cycle();
            if (bus.mode != CM1E_MODE_HM)
                TEST_ASSERT_EQUAL_HEX16(0x000F, fake_output(&bus, 0x6040, 0)); /* no start before the mode */
        }
        TEST_ASSERT_EQUAL_INT8(CM1E_MODE_HM, bus.mode);
        TEST_ASSERT_EQUAL_HEX16(0x001F, fake_output(&bus, 0x6040, 0));
        drive.command.homing_start = false;
        bus.position += 1000000; /* homing gave the position another value, and the caller follows it */
        drive.command.target_position = bus.position;
        drive.command.mode = CM1E_MODE_CSP;
        bus.torque_step = 0;
        for (int i = 0; i < 500 && !(drive.feedback.enabled && drive.feedback.mode == CM1E_MODE_CSP); i++)
            cycle();
        TEST_ASSERT_TRUE(drive.feedback.enabled);
        TEST_ASSERT_EQUAL_INT64(0, bus.torque_step);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
    }
}

/* The display of a drive changes some cycles after it has taken a mode, and is that of the mode before until then. */
static void test_mode_over_sdo_that_is_taken_back_at_any_moment_is_not_left_behind(void)
{
    enum { MOMENTS = 40 };
    for (int moment = 0; moment < MOMENTS; moment++) {
        fake_bus_init(&bus, CM1E_MAPPING_CSP, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
        bus.sdo_delay = 2;
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_init(&drive, &bus, 0, &diag));
        fake_bus_show(&bus);
        enable(CM1E_MODE_CSP);
        bus.mode_delay = bus.mode_wait = 20;
        drive.command.mode = CM1E_MODE_HM;
        for (int i = 0; i < moment; i++)
            cycle();
        drive.command.enable = false;
        drive.command.mode = CM1E_MODE_CSP;
        for (int i = 0; i < 300; i++)
            cycle();
        TEST_ASSERT_EQUAL_INT8_MESSAGE(CM1E_MODE_CSP, bus.mode, "the drive homes, and its axis takes it for in CSP");
        enable(CM1E_MODE_CSP);
        TEST_ASSERT_EQUAL_INT8(CM1E_MODE_CSP, bus.mode);
    }
}

static void answer_without_data(cm1e_bus_t *slave, cm1e_sdo_t *sdo)
{
    (void)slave;
    sdo->size = sdo->write ? sdo->size : 0;
    sdo->state = CM1E_SDO_DONE;
}

static void test_mode_that_cannot_be_read_is_an_error_in_words(void)
{
    fake_bus_init(&bus, CM1E_MAPPING_CSP, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.device_sdo = answer_without_data;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_BUS_MAILBOX, cm1e_drive_init(&drive, &bus, 0, &diag));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "object 0x6061 was read with 0 bytes instead of 1"), diag.text);
}

static void test_mode_over_sdo_that_is_refused_ends_in_a_timeout(void)
{
    fake_bus_init(&bus, CM1E_MAPPING_CSP, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_drive_init(&drive, &bus, 0, &diag));
    fake_bus_show(&bus);
    const unsigned transfers = bus.sdo_count;
    enable(CM1E_MODE_CSP);
    TEST_ASSERT_EQUAL_UINT(transfers, bus.sdo_count); /* it was shown at the start */
    drive.command.target_position = bus.position;
    bus.sdo_abort_index = 0x6060;
    drive.command.mode = CM1E_MODE_HM;
    for (int i = 0; i < 1100; i++)
        cycle();
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_MODE_TIMEOUT, drive.fault.error);
    TEST_ASSERT_EQUAL_HEX16(0x0006, fake_output(&bus, 0x6040, 0));

    fake_bus_init(&bus, CM1E_MAPPING_CSP, CM1E_PDO_ORDER_UG_4_4, CM1E_FIRMWARE_1_3_5);
    bus.sdo_abort_index = 0x6060;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_SDO_ABORT, cm1e_drive_init(&drive, &bus, 0, &diag));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_missing_object_is_named_with_its_mapping);
    RUN_TEST(test_object_of_a_wrong_size_is_refused);
    RUN_TEST(test_digital_outputs_of_every_size_arrive_and_nothing_beside_them);
    RUN_TEST(test_wrong_axis_motor_or_firmware_is_an_error_in_words);
    RUN_TEST(test_a_stated_unit_of_velocity_counts_more_than_the_firmware);
    RUN_TEST(test_velocity_has_the_unit_of_the_firmware_and_is_limited);
    RUN_TEST(test_actual_velocity_has_counts_per_second_in_every_firmware);
    RUN_TEST(test_velocity_below_1_3_0_in_homing_comes_from_positions);
    RUN_TEST(test_velocity_from_positions_has_the_time_of_any_pause);
    RUN_TEST(test_inputs_of_both_orders_are_decoded);
    RUN_TEST(test_32_bit_torque_saturates);
    RUN_TEST(test_24_bit_torque_has_a_sign);
    RUN_TEST(test_profile_objects_carry_the_limits_of_the_configuration);
    RUN_TEST(test_mappings_support_the_modes_whose_targets_they_have);
    RUN_TEST(test_mode_that_cannot_be_read_is_an_error_in_words);
    RUN_TEST(test_mode_over_sdo_is_set_before_and_switched_in_the_cycle);
    RUN_TEST(test_mode_over_sdo_that_is_taken_back_at_any_moment_is_not_left_behind);
    RUN_TEST(test_mode_over_sdo_that_is_refused_ends_in_a_timeout);
    return UNITY_END();
}
