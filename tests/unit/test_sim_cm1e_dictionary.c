/** SDO access to every entry of the device tables, on every firmware: UG chapter 7. */
#include <stdio.h>

#include "sim_cm1e_bench.h"

void setUp(void) {}
void tearDown(void) {}

static const char *const firmwares[] = {"1.2.0", "1.3.0", "1.3.2", "1.3.3", "1.3.4", "1.3.5"};
enum { FIRMWARES = 6 };

typedef void entry_check_t(bench_t *b, const cm1e_entry_t *entry);

static void for_every_entry(const char *firmware, entry_check_t *check)
{
    const cm1e_axis_config_t config = bench_firmware(firmware);
    bench_t b;
    bench_open(&b, &config, CM1E_PDO_ORDER_UG_4_4);
    b.drive->al_state = BENCH_PREOP;
    size_t count;
    const cm1e_object_t *objects = cm1e_device_objects(&count);
    for (size_t i = 0; i < count; i++)
        for (uint16_t k = 0; k < objects[i].entry_count; k++) {
            const cm1e_entry_t *entry = &objects[i].entries[k];
            UNITY_SET_DETAIL(entry->name);
            if (objects[i].since <= b.drive->firmware->firmware && entry->since <= b.drive->firmware->firmware)
                check(&b, entry);
        }
    bench_close(&b);
}

static uint32_t write_bytes(bench_t *b, const cm1e_entry_t *entry, int64_t value, size_t size)
{
    uint8_t data[16] = {0};
    cm1e_put_uint(data, 8, (uint64_t)value);
    return b->ops->sdo_write(b->drive, entry->index, entry->subindex, b->drive->al_state, data, size);
}

static size_t bytes_of(const cm1e_entry_t *entry) { return entry->bits / 8u; }

static bool is_assignment(const cm1e_entry_t *entry) { return entry->index == 0x1C12 || entry->index == 0x1C13; }

/* ---- reading ---------------------------------------------------------------------------------------------------- */

static void check_read(bench_t *b, const cm1e_entry_t *entry)
{
    uint8_t data[64];
    size_t size = sizeof data;
    TEST_ASSERT_EQUAL_HEX32(0, b->ops->sdo_read(b->drive, entry->index, entry->subindex, BENCH_PREOP, data, &size));
    TEST_ASSERT_EQUAL(bytes_of(entry), size);
    size = bytes_of(entry) - 1;
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_MEMORY,
                            b->ops->sdo_read(b->drive, entry->index, entry->subindex, BENCH_PREOP, data, &size));
}

static void test_every_entry_reads_with_its_size(void)
{
    for (int i = 0; i < FIRMWARES; i++)
        for_every_entry(firmwares[i], check_read);
}

static void test_identity_shows_firmware_and_revision(void)
{
    for (int i = 0; i < FIRMWARES; i++) {
        const cm1e_axis_config_t config = bench_firmware(firmwares[i]);
        bench_t b;
        bench_open(&b, &config, CM1E_PDO_ORDER_UG_4_4);
        char text[16] = {0};
        size_t size = sizeof text - 1;
        TEST_ASSERT_EQUAL_HEX32(0, b.ops->sdo_read(b.drive, 0x100A, 0, BENCH_OP, (uint8_t *)text, &size));
        TEST_ASSERT_EQUAL_STRING(firmwares[i], text);
        TEST_ASSERT_EQUAL_HEX32(0x4441, bench_read(&b, 0x1018, 1));
        TEST_ASSERT_EQUAL_HEX32(0x44412002, bench_read(&b, 0x1018, 2));
        TEST_ASSERT_EQUAL_HEX32(i == 0 ? 0x20020001 : 0x20020103, bench_read(&b, 0x1018, 3));
        TEST_ASSERT_EQUAL_HEX32(0x1A5, bench_read(&b, 0x6502, 0));
        const bool all_cycle_times = cm1e_firmware_from_version(firmwares[i])->all_cycle_times;
        TEST_ASSERT_EQUAL_INT32(all_cycle_times ? 200000 : 1000000, bench_read(&b, 0x1C32, 5));
        TEST_ASSERT_EQUAL_INT32(all_cycle_times ? 200000 : 1000000, bench_read(&b, 0x1C33, 5));
        bench_close(&b);
    }
}

static void test_motor_objects_are_those_of_the_motor(void)
{
    static const struct {
        const char *motor;
        int rated_ma, rated_mnm;
    } rows[] = {{"CM1-E-17S30D", 833, 94}, {"CM1-E-17L30D", 1500, 432}, {"CM1-E-23S30D", 4250, 368},
                {"CM1-E-23L20D", 2833, 992}};
    for (int i = 0; i < 4; i++) {
        cm1e_axis_config_t config = {0};
        strcpy(config.motor, rows[i].motor);
        bench_t b;
        bench_open(&b, &config, CM1E_PDO_ORDER_UG_4_4);
        TEST_ASSERT_EQUAL(rows[i].rated_ma, bench_read(&b, 0x6075, 0));
        TEST_ASSERT_EQUAL(rows[i].rated_mnm, bench_read(&b, 0x6076, 0));
        bench_close(&b);
    }
}

static void test_every_other_index_and_subindex_is_refused(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    uint8_t data[64] = {0};
    for (uint32_t index = 0; index <= 0xFFFF; index++) {
        const bool exists = cm1e_device_entry((uint16_t)index, 0) != NULL;
        for (uint32_t sub = 0; sub <= (exists ? 0xFFu : 1u); sub++) {
            if (cm1e_device_entry((uint16_t)index, (uint8_t)sub))
                continue;
            size_t size = sizeof data;
            const uint32_t expected = exists ? SDO_ABORT_NO_SUBINDEX : SDO_ABORT_NO_OBJECT;
            TEST_ASSERT_EQUAL_HEX32(expected, b.ops->sdo_read(b.drive, (uint16_t)index, (uint8_t)sub, 2, data, &size));
            TEST_ASSERT_EQUAL_HEX32(expected, b.ops->sdo_write(b.drive, (uint16_t)index, (uint8_t)sub, 2, data, 4));
            TEST_ASSERT_NULL(b.ops->entry(b.drive, (uint16_t)index, (uint8_t)sub));
        }
    }
    bench_close(&b);
}

static void test_objects_of_later_firmware_are_absent_before(void)
{
    for (int i = 0; i < FIRMWARES; i++) {
        const cm1e_axis_config_t config = bench_firmware(firmwares[i]);
        bench_t b;
        bench_open(&b, &config, CM1E_PDO_ORDER_UG_4_4);
        uint8_t data[64];
        size_t size = sizeof data;
        TEST_ASSERT_EQUAL_HEX32(i < CM1E_FIRMWARE_1_3_4 ? SDO_ABORT_NO_OBJECT : 0,
                                b.ops->sdo_read(b.drive, 0x2201, 1, BENCH_OP, data, &size));
        size = sizeof data;
        TEST_ASSERT_EQUAL_HEX32(i < CM1E_FIRMWARE_1_3_0 ? SDO_ABORT_NO_SUBINDEX : 0,
                                b.ops->sdo_read(b.drive, 0x1603, 7, BENCH_OP, data, &size));
        TEST_ASSERT_EQUAL(i < CM1E_FIRMWARE_1_3_0 ? 6 : 7, bench_read(&b, 0x1603, 0));
        TEST_ASSERT_EQUAL(i < CM1E_FIRMWARE_1_3_0 ? 8 : 9, bench_read(&b, 0x1A03, 0));
        bench_close(&b);
    }
}

static void test_object_list_is_in_order_and_complete(void)
{
    for (int i = 0; i < FIRMWARES; i++) {
        const cm1e_axis_config_t config = bench_firmware(firmwares[i]);
        bench_t b;
        bench_open(&b, &config, CM1E_PDO_ORDER_UG_4_4);
        size_t count, n = 0;
        cm1e_device_objects(&count);
        uint16_t last = 0;
        for (const cm1e_object_t *object; (object = b.ops->object(b.drive, n)); n++) {
            TEST_ASSERT_TRUE(object->index > last);
            last = object->index;
        }
        TEST_ASSERT_EQUAL(i < CM1E_FIRMWARE_1_3_4 ? count - 1 : count, n);
        TEST_ASSERT_NULL(b.ops->object(b.drive, SIZE_MAX));
        bench_close(&b);
    }
}

/* ---- writing ---------------------------------------------------------------------------------------------------- */

static void check_read_only(bench_t *b, const cm1e_entry_t *entry)
{
    if (entry->access & CM1E_ACCESS_WRITE)
        return;
    const size_t size = bytes_of(entry) > 8 ? 8 : bytes_of(entry);
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_READ_ONLY, write_bytes(b, entry, entry->default_value, size));
}

static void check_size(bench_t *b, const cm1e_entry_t *entry)
{
    if (!(entry->access & CM1E_ACCESS_WRITE))
        return;
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_TOO_LONG, write_bytes(b, entry, entry->default_value, bytes_of(entry) + 1));
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_TOO_LONG, write_bytes(b, entry, entry->default_value, 16));
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_TOO_SHORT, write_bytes(b, entry, entry->default_value, bytes_of(entry) - 1));
    TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_TOO_SHORT, write_bytes(b, entry, entry->default_value, 0));
}

static bool fits(const cm1e_entry_t *entry, int64_t value)
{
    const cm1e_data_type_t type = entry->type;
    const bool is_signed = type == CM1E_TYPE_SINT || type == CM1E_TYPE_INT || type == CM1E_TYPE_DINT;
    const int64_t most = (INT64_C(1) << (entry->bits - (is_signed ? 1 : 0))) - 1;
    return value <= most && value >= (is_signed ? -most - 1 : 0);
}

static void check_range(bench_t *b, const cm1e_entry_t *entry)
{
    if (!(entry->access & CM1E_ACCESS_WRITE) || is_assignment(entry))
        return;
    const int64_t before = bench_read(b, entry->index, entry->subindex);
    if (fits(entry, entry->maximum + 1))
        TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_TOO_HIGH, write_bytes(b, entry, entry->maximum + 1, bytes_of(entry)));
    if (fits(entry, entry->minimum - 1))
        TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_TOO_LOW, write_bytes(b, entry, entry->minimum - 1, bytes_of(entry)));
    TEST_ASSERT_EQUAL_MESSAGE(before, bench_read(b, entry->index, entry->subindex), "a refused value was kept");
}

static int64_t sign_extended(const cm1e_entry_t *entry, int64_t value)
{
    return entry->minimum < 0 ? (int64_t)((uint64_t)value << (64 - entry->bits)) >> (64 - entry->bits) : value;
}

static void check_values(bench_t *b, const cm1e_entry_t *entry)
{
    if (!(entry->access & CM1E_ACCESS_WRITE) || is_assignment(entry) || entry->index == 0x6060)
        return;
    const int64_t span = entry->maximum - entry->minimum;
    const int64_t values[] = {entry->minimum, entry->maximum, entry->minimum + 1, entry->maximum - 1,
                              entry->minimum + span / 3, entry->minimum + span / 7, entry->minimum + span / 2};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
        if (values[i] < entry->minimum || values[i] > entry->maximum)
            continue;
        TEST_ASSERT_EQUAL_HEX32(0, write_bytes(b, entry, values[i], bytes_of(entry)));
        const int64_t kept = sign_extended(entry, bench_read(b, entry->index, entry->subindex));
        if (kept != cm1e_entry_round(entry, values[i])) {
            char text[100];
            snprintf(text, sizeof text, "%04X:%02X wrote %lld, reads %lld", entry->index, entry->subindex,
                     (long long)values[i], (long long)kept);
            TEST_FAIL_MESSAGE(text);
        }
    }
}

static void test_writing_respects_access_size_and_range(void)
{
    for (int i = 0; i < FIRMWARES; i++) {
        for_every_entry(firmwares[i], check_read_only);
        for_every_entry(firmwares[i], check_size);
        for_every_entry(firmwares[i], check_range);
        for_every_entry(firmwares[i], check_values);
    }
}

/* UG 6.2.2, 6.2.4, restated. */
static void test_values_are_rounded_as_the_guide_says(void)
{
    static const struct {
        uint16_t index;
        uint8_t subindex;
        int32_t written, kept;
    } rows[] = {
        {0x607C, 0, 149, 100}, {0x607C, 0, 150, 200}, {0x607C, 0, -149, -100}, {0x607C, 0, -150, -200},
        {0x607C, 0, 3276700, 3276700}, {0x6099, 1, 1049, 1000}, {0x6099, 1, 1050, 1100}, {0x6099, 1, 499951, 500000},
        {0x609A, 0, 1499, 1000}, {0x609A, 0, 1500, 2000}, {0x6083, 0, 0, 1000}, {0x6083, 0, 999, 1000},
        {0x6083, 0, 1499, 1000}, {0x6083, 0, 1500, 2000}, {0x6084, 0, 1, 1000}, {0x6084, 0, 32767000, 32767000},
        {0x60F6, 0x1B, 10, 10}, {0x60F6, 0x1B, 100, 100},
    };
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        bench_write(&b, rows[i].index, rows[i].subindex, rows[i].written);
        TEST_ASSERT_EQUAL_INT32(rows[i].kept, (int32_t)bench_read(&b, rows[i].index, rows[i].subindex));
    }
    bench_close(&b);
}

static void test_kpulses_device_takes_kpulses(void)
{
    const cm1e_axis_config_t config = {.acceleration_in_kpulses = true};
    bench_t b;
    bench_open(&b, &config, CM1E_PDO_ORDER_UG_4_4);
    for (uint16_t index = 0x6083; index <= 0x6084; index++) {
        bench_write(&b, index, 0, 1234);
        TEST_ASSERT_EQUAL(1234, bench_read(&b, index, 0));
        bench_write(&b, index, 0, 0);
        TEST_ASSERT_EQUAL(1, bench_read(&b, index, 0));
        TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_TOO_HIGH, bench_try_write(&b, index, 0, 32768));
    }
    bench_close(&b);
}

static void test_only_modes_of_the_device_can_be_written(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    for (int mode = -128; mode <= 127; mode++) {
        const bool good = mode == 0 || mode == 1 || mode == 3 || mode == 6 || mode == 8 || mode == 9;
        const uint32_t refusal = mode < 0 ? SDO_ABORT_TOO_LOW : mode > 9 ? SDO_ABORT_TOO_HIGH : SDO_ABORT_RANGE;
        TEST_ASSERT_EQUAL_HEX32(good ? 0 : refusal, bench_try_write(&b, 0x6060, 0, mode));
    }
    bench_close(&b);
}

static void test_assignment_is_written_in_preop_only(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    static const uint8_t states[] = {BENCH_INIT, BENCH_SAFEOP, BENCH_OP};
    for (int i = 0; i < 3; i++) {
        b.drive->al_state = states[i];
        for (uint16_t index = 0x1C12; index <= 0x1C13; index++) {
            TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_STATE, bench_try_write(&b, index, 0, 0));
            TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_STATE, bench_try_write(&b, index, 1, index == 0x1C12 ? 0x1601 : 0x1A01));
        }
    }
    bench_close(&b);
}

static void test_power_cycle_keeps_what_is_non_volatile_only(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    bench_write(&b, 0x60FB, 3, -1234);
    bench_write(&b, 0xFF00, 0, 16);
    bench_write(&b, 0x2201, 1, 0x4000);
    bench_write(&b, 0x2201, 2, 77);
    bench_write(&b, 0x6098, 0, -3);
    bench_write(&b, 0x60F6, 0x1B, 55);
    b.ops->power_on(b.drive, b.now_ns + BENCH_MS);
    TEST_ASSERT_EQUAL_INT16(-1234, bench_read(&b, 0x60FB, 3));
    TEST_ASSERT_EQUAL(16, bench_read(&b, 0xFF00, 0));
    TEST_ASSERT_EQUAL(0, bench_read(&b, 0x2201, 1));
    TEST_ASSERT_EQUAL(0, bench_read(&b, 0x2201, 2));
    TEST_ASSERT_EQUAL(0, bench_read(&b, 0x6098, 0));
    TEST_ASSERT_EQUAL(30, bench_read(&b, 0x60F6, 0x1B));
    bench_close(&b);
}

static void test_random_access_never_overruns(void)
{
    uint64_t seed = 42;
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_7_2);
    for (int i = 0; i < 300000; i++) {
        seed = seed * UINT64_C(6364136223846793005) + 1442695040888963407u;
        const uint32_t r = (uint32_t)(seed >> 32);
        size_t count;
        const cm1e_object_t *objects = cm1e_device_objects(&count);
        const uint16_t index = r & 1 ? objects[(r >> 8) % count].index : (uint16_t)(r >> 8);
        const uint8_t sub = (uint8_t)(seed >> 24), state = (uint8_t)(1u << (r >> 28 & 3));
        uint8_t data[16];
        size_t size = (size_t)(seed >> 20 & 15);
        cm1e_put_u64(data, seed);
        if (r & 2) {
            b.ops->sdo_write(b.drive, index, sub, state, data, size);
        } else {
            uint8_t guarded[17];
            memset(guarded, 0xA5, sizeof guarded);
            const size_t room = size;
            if (b.ops->sdo_read(b.drive, index, sub, state, guarded, &size) == 0)
                TEST_ASSERT_TRUE(size <= room);
            TEST_ASSERT_EQUAL_HEX8_MESSAGE(0xA5, guarded[room], "wrote behind the room given");
        }
        if (i % 64 == 0) {
            b.now_ns += BENCH_MS;
            b.ops->advance(b.drive, b.now_ns);
        }
    }
    bench_close(&b);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_entry_reads_with_its_size);
    RUN_TEST(test_identity_shows_firmware_and_revision);
    RUN_TEST(test_motor_objects_are_those_of_the_motor);
    RUN_TEST(test_every_other_index_and_subindex_is_refused);
    RUN_TEST(test_objects_of_later_firmware_are_absent_before);
    RUN_TEST(test_object_list_is_in_order_and_complete);
    RUN_TEST(test_writing_respects_access_size_and_range);
    RUN_TEST(test_values_are_rounded_as_the_guide_says);
    RUN_TEST(test_kpulses_device_takes_kpulses);
    RUN_TEST(test_only_modes_of_the_device_can_be_written);
    RUN_TEST(test_assignment_is_written_in_preop_only);
    RUN_TEST(test_power_cycle_keeps_what_is_non_volatile_only);
    RUN_TEST(test_random_access_never_overruns);
    return UNITY_END();
}
