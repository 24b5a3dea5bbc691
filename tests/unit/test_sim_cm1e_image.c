/** Process data: the four mappings in both orders on every firmware, their assignment, cycle time detection. */
#include <stdio.h>

#include "sim_cm1e_bench.h"

void setUp(void) {}
void tearDown(void) {}

static const char *const firmwares[] = {"1.2.0", "1.3.0", "1.3.2", "1.3.3", "1.3.4", "1.3.5"};
enum { FIRMWARES = 6 };

static uint64_t seed = 1;

static uint32_t random_32(void)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (uint32_t)(seed >> 32);
}

static void assign(bench_t *b, uint16_t index, uint16_t pdo)
{
    b->drive->al_state = BENCH_PREOP;
    bench_write(b, index, 0, 0);
    bench_write(b, index, 1, pdo);
    bench_write(b, index, 0, 1);
}

static int64_t as_object(uint16_t index, uint64_t raw)
{
    const cm1e_entry_t *entry = cm1e_device_entry(index, 0);
    return (int64_t)(raw & (entry->bits == 32 ? UINT32_MAX : (UINT64_C(1) << entry->bits) - 1));
}

/* Every output lands in its object; modes that no device has would be ignored, so the mode is a true one. */
static void check_outputs(bench_t *b)
{
    static const int8_t modes[] = {0, 1, 3, 6, 8, 9};
    for (int trial = 0; trial < 20; trial++) {
        b->controlword = (uint16_t)random_32() & 0xFF70; /* enables nothing */
        b->digital_outputs = (uint16_t)random_32();
        b->target_position = (int32_t)random_32();
        b->target_velocity = (int32_t)random_32();
        b->profile_velocity = random_32();
        b->profile_acceleration = random_32();
        b->mode = modes[random_32() % 6];
        b->now_ns += b->cycle_ns;
        b->ops->advance(b->drive, b->now_ns);
        bench_put_outputs(b);
        for (uint8_t i = 0; i < b->rx.entry_count; i++) {
            const uint16_t index = b->rx.entries[i].index;
            TEST_ASSERT_EQUAL_HEX64(as_object(index, bench_output(b, index)), bench_read(b, index, 0));
        }
    }
}

/* Every input is what its object reads over SDO at the same moment, cut to the mapped length. */
static void check_inputs(bench_t *b)
{
    b->drive->mechanics.velocity = 123456;
    b->drive->mechanics.position = -98765;
    b->drive->objects.temperature = -7;
    b->drive->sensors.values = b->drive->sensors.held = 0x9;
    uint8_t image[BENCH_IMAGE_BYTES];
    uint16_t out, in;
    b->ops->process_data_sizes(b->drive, &out, &in);
    memset(image, 0xEE, sizeof image);
    b->ops->inputs(b->drive, image, in);
    const uint8_t *p = image;
    for (uint8_t i = 0; i < b->tx.entry_count; i++) {
        const cm1e_pdo_entry_t *entry = &b->tx.entries[i];
        const uint64_t mask = entry->bits == 32 ? UINT32_MAX : (UINT64_C(1) << entry->bits) - 1;
        TEST_ASSERT_EQUAL_HEX64((uint64_t)bench_read(b, entry->index, 0) & mask, cm1e_get_uint(p, entry->bits / 8u));
        p += entry->bits / 8;
    }
    TEST_ASSERT_EQUAL(in, p - image);
    TEST_ASSERT_EQUAL_HEX8(0xEE, *p);
}

static void test_every_mapping_in_both_orders_carries_every_object(void)
{
    for (int f = 0; f < FIRMWARES; f++)
        for (int order = 0; order < 2; order++)
            for (uint16_t rx = 0; rx < 4; rx++)
                for (uint16_t tx = 0; tx < 4; tx++) {
                    const cm1e_axis_config_t config = bench_firmware(firmwares[f]);
                    bench_t b;
                    bench_open(&b, &config, (cm1e_pdo_order_t)order);
                    assign(&b, 0x1C12, (uint16_t)(0x1600 + rx));
                    assign(&b, 0x1C13, (uint16_t)(0x1A00 + tx));
                    bench_to_op(&b);
                    TEST_ASSERT_EQUAL_HEX16(0x1600 + rx, b.rx.index);
                    check_outputs(&b);
                    check_inputs(&b);
                    bench_close(&b);
                }
}

/* UG 4.4 and 7.2, counted by hand. */
static void test_sizes_are_those_of_the_guide(void)
{
    static const uint16_t out[2][4] = {{13, 8, 8, 20}, {13, 8, 8, 21}}, in[2][4] = {{21, 16, 16, 20}, {21, 16, 16, 21}};
    for (int f = 0; f < FIRMWARES; f++)
        for (int order = 0; order < 2; order++)
            for (uint16_t mapping = 0; mapping < 4; mapping++) {
                const cm1e_axis_config_t config = bench_firmware(firmwares[f]);
                bench_t b;
                bench_open(&b, &config, (cm1e_pdo_order_t)order);
                assign(&b, 0x1C12, (uint16_t)(0x1600 + mapping));
                assign(&b, 0x1C13, (uint16_t)(0x1A00 + mapping));
                uint16_t output_bytes, input_bytes;
                b.ops->process_data_sizes(b.drive, &output_bytes, &input_bytes);
                TEST_ASSERT_EQUAL(out[f >= CM1E_FIRMWARE_1_3_0][mapping], output_bytes);
                TEST_ASSERT_EQUAL(in[f >= CM1E_FIRMWARE_1_3_0][mapping], input_bytes);
                bench_close(&b);
            }
}

static void test_orders_differ_as_the_guide_has_them(void)
{
    static const uint16_t rows[2][5] = {{0x6040, 0x60FE, 0x607A, 0x60FF, 0x6060},
                                         {0x6040, 0x607A, 0x60FF, 0x60FE, 0x6060}};
    for (int order = 0; order < 2; order++) {
        bench_t b;
        bench_open(&b, NULL, (cm1e_pdo_order_t)order);
        TEST_ASSERT_EQUAL(5, b.rx.entry_count);
        for (int i = 0; i < 5; i++)
            TEST_ASSERT_EQUAL_HEX16(rows[order][i], b.rx.entries[i].index);
        TEST_ASSERT_EQUAL_HEX16(order == 0 ? 0x603F : 0x6064, b.tx.entries[1].index);
        bench_close(&b);
    }
}

static void test_wrong_assignments_are_refused_and_change_nothing(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    b.drive->al_state = BENCH_PREOP;
    for (uint16_t index = 0x1C12; index <= 0x1C13; index++) {
        const uint16_t first = index == 0x1C12 ? 0x1600 : 0x1A00;
        TEST_ASSERT_EQUAL_HEX32_MESSAGE(0x06010003, bench_try_write(&b, index, 1, first + 1), "count is not 0");
        TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_TOO_HIGH, bench_try_write(&b, index, 0, 2));
        bench_write(&b, index, 0, 0);
        for (uint32_t pdo = 0; pdo <= 0xFFFF; pdo++)
            if (pdo < first || pdo > first + 3u)
                TEST_ASSERT_EQUAL_HEX32(SDO_ABORT_PDO_MAPPING, bench_try_write(&b, index, 1, pdo));
        TEST_ASSERT_EQUAL_HEX16(first, bench_read(&b, index, 1));
        TEST_ASSERT_EQUAL(0, bench_read(&b, index, 0));
    }
    uint16_t out, in;
    b.ops->process_data_sizes(b.drive, &out, &in);
    TEST_ASSERT_EQUAL_MESSAGE(0, out + in, "nothing is assigned");
    bench_close(&b);
}

static void test_outputs_that_are_too_short_are_ignored(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    uint8_t image[13];
    memset(image, 0x0F, sizeof image);
    for (uint16_t size = 0; size < 13; size++) {
        b.ops->outputs(b.drive, image, size, b.now_ns);
        TEST_ASSERT_EQUAL(0, bench_read(&b, 0x6040, 0));
        memset(image, 0x0F, sizeof image);
        b.ops->inputs(b.drive, image, size);
        for (size_t i = 0; i < sizeof image; i++)
            TEST_ASSERT_EQUAL_HEX8(0x0F, image[i]);
    }
    bench_close(&b);
}

/* ---- cycle time (UG 4.3) ---------------------------------------------------------------------------------------- */

static int64_t detected(const char *firmware, int64_t cycle_ns, double jitter)
{
    const cm1e_axis_config_t config = bench_firmware(firmware);
    bench_t b;
    bench_open(&b, &config, CM1E_PDO_ORDER_UG_4_4);
    const int64_t start_ns = b.now_ns;
    for (int i = 1; i <= 400; i++) {
        const double shift = jitter * ((double)random_32() / UINT32_MAX * 2 - 1);
        b.now_ns = start_ns + i * cycle_ns + (int64_t)(shift * (double)cycle_ns);
        b.ops->advance(b.drive, b.now_ns);
        bench_put_outputs(&b);
    }
    const int64_t us = bench_read(&b, 0xFE00, 1);
    TEST_ASSERT_EQUAL(us * 1000, bench_read(&b, 0x1C32, 2));
    bench_close(&b);
    return us;
}

static void test_the_four_cycle_times_are_detected_in_spite_of_jitter(void)
{
    static const int us[] = {200, 250, 500, 1000};
    for (int i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL(us[i], detected("1.3.5", us[i] * 1000, 0));
        TEST_ASSERT_EQUAL(us[i], detected("1.3.2", us[i] * 1000, 0.04));
        TEST_ASSERT_EQUAL(us[i] == 1000 ? 1000 : 0, detected("1.3.0", us[i] * 1000, 0.04));
    }
    TEST_ASSERT_EQUAL(500, detected("1.3.5", 500000, 0.12));
    TEST_ASSERT_EQUAL(1000, detected("1.3.5", 1000000, 0.12));
}

static void test_other_cycle_times_are_not_shown(void)
{
    static const int64_t others[] = {50000, 100000, 2000000, 4000000, 10000000};
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
        TEST_ASSERT_EQUAL(0, detected("1.3.5", others[i], 0));
}

static void test_a_change_of_the_cycle_time_and_a_pause_are_handled(void)
{
    bench_t b;
    bench_open(&b, NULL, CM1E_PDO_ORDER_UG_4_4);
    bench_run(&b, 0.02);
    TEST_ASSERT_EQUAL(1000, bench_read(&b, 0xFE00, 1));
    b.now_ns += 50 * BENCH_MS;
    bench_cycle(&b);
    TEST_ASSERT_EQUAL_MESSAGE(1000, bench_read(&b, 0xFE00, 1), "one lost stretch is no new cycle time");
    b.cycle_ns = 250000;
    bench_run(&b, 0.02);
    TEST_ASSERT_EQUAL(250, bench_read(&b, 0xFE00, 1));
    bench_close(&b);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_mapping_in_both_orders_carries_every_object);
    RUN_TEST(test_sizes_are_those_of_the_guide);
    RUN_TEST(test_orders_differ_as_the_guide_has_them);
    RUN_TEST(test_wrong_assignments_are_refused_and_change_nothing);
    RUN_TEST(test_outputs_that_are_too_short_are_ignored);
    RUN_TEST(test_the_four_cycle_times_are_detected_in_spite_of_jitter);
    RUN_TEST(test_other_cycle_times_are_not_shown);
    RUN_TEST(test_a_change_of_the_cycle_time_and_a_pause_are_handled);
    return UNITY_END();
}
