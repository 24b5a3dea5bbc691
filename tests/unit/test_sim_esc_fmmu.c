/* FMMUs: logical addressing by bytes and bits, against a plain model. */
#include "sim_fake_app.h"

enum { RAM = 0x2000, RAM_BYTES = 64, LOGICAL = 0x00010000, LOGICAL_BYTES = 96 };

static bench_t b;

void setUp(void) { bench_open(&b, 2); }
void tearDown(void) { bench_close(&b); }

static void test_lrw_counts_three_for_a_slave_that_reads_and_writes(void)
{
    uint8_t data[8] = {1, 2, 3, 4, 5, 6, 7, 8};
    TEST_ASSERT_EQUAL_INT(0, send_logical(&b, LRW, LOGICAL, data, 8));
    write_fmmu(&b, 0, 0, LOGICAL, 4, 0, 7, RAM, 0, 2);
    TEST_ASSERT_EQUAL_INT(2, send_logical(&b, LRW, LOGICAL, data, 8));
    TEST_ASSERT_EQUAL_INT(1, send_logical(&b, LWR, LOGICAL, data, 8));
    TEST_ASSERT_EQUAL_INT(0, send_logical(&b, LRD, LOGICAL, data, 8));
    write_fmmu(&b, 0, 1, LOGICAL + 4, 4, 0, 7, RAM + 4, 0, 1);
    TEST_ASSERT_EQUAL_INT(3, send_logical(&b, LRW, LOGICAL, data, 8));
    TEST_ASSERT_EQUAL_INT(1, send_logical(&b, LWR, LOGICAL, data, 8));
    TEST_ASSERT_EQUAL_INT(1, send_logical(&b, LRD, LOGICAL, data, 8));
    /* several FMMUs of one slave in one datagram count once */
    write_fmmu(&b, 0, 2, LOGICAL + 2, 1, 0, 7, RAM + 20, 0, 2);
    write_fmmu(&b, 0, 3, LOGICAL + 3, 1, 0, 7, RAM + 30, 0, 3);
    TEST_ASSERT_EQUAL_INT(3, send_logical(&b, LRW, LOGICAL, data, 8));
    write_fmmu(&b, 1, 0, LOGICAL + 7, 1, 0, 7, RAM, 0, 3);
    TEST_ASSERT_EQUAL_INT(6, send_logical(&b, LRW, LOGICAL, data, 8));
    TEST_ASSERT_EQUAL_INT(4, send_logical(&b, LRW, LOGICAL + 7, data, 1)); /* slave 0 reads there */
    TEST_ASSERT_EQUAL_INT(0, send_logical(&b, LRW, LOGICAL + 8, data, 8));
    TEST_ASSERT_EQUAL_INT(0, send_logical(&b, LRW, LOGICAL - 8, data, 8));
}

static void test_bytes_written_and_read_at_the_same_address_are_exchanged(void)
{
    uint8_t data[4] = {0xA1, 0xA2, 0xA3, 0xA4};
    uint8_t old[4] = {0x11, 0x12, 0x13, 0x14}, now[4] = {0};
    write_bytes(&b, 0, RAM + 8, old, 4);
    write_fmmu(&b, 0, 0, LOGICAL, 4, 0, 7, RAM, 0, 2);
    write_fmmu(&b, 0, 1, LOGICAL, 4, 0, 7, RAM + 8, 0, 1);
    TEST_ASSERT_EQUAL_INT(3, send_logical(&b, LRW, LOGICAL, data, 4));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(old, data, 4);
    TEST_ASSERT_EQUAL_INT(1, send_to(&b, APRD, 0, RAM, now, 4));
    TEST_ASSERT_EQUAL_HEX8(0xA1, now[0]);
    TEST_ASSERT_EQUAL_HEX8(0xA4, now[3]);
}

static void test_an_fmmu_that_is_off_maps_nothing(void)
{
    uint8_t data[4] = {0};
    write_fmmu(&b, 0, 0, LOGICAL, 4, 0, 7, RAM, 0, 3);
    TEST_ASSERT_EQUAL_INT(3, send_logical(&b, LRW, LOGICAL, data, 4));
    write_u8(&b, 0, 0x60C, 0);
    TEST_ASSERT_EQUAL_INT(0, send_logical(&b, LRW, LOGICAL, data, 4));
}

static void test_a_register_can_be_mapped(void)
{
    uint8_t data[2] = {0};
    write_fmmu(&b, 0, 0, LOGICAL, 2, 0, 7, 0x130, 0, 1);
    TEST_ASSERT_EQUAL_INT(1, send_logical(&b, LRD, LOGICAL, data, 2));
    TEST_ASSERT_EQUAL_HEX8(0x01, data[0]);
}

static void test_addresses_at_the_end_of_the_logical_space_do_not_wrap(void)
{
    uint8_t data[16] = {0};
    write_fmmu(&b, 0, 0, 0xFFFFFFF0, 8, 0, 7, RAM, 0, 3);
    TEST_ASSERT_EQUAL_INT(3, send_logical(&b, LRW, 0xFFFFFFF0, data, 16));
    TEST_ASSERT_EQUAL_INT(0, send_logical(&b, LRW, 0, data, 16));
    write_fmmu(&b, 0, 0, 0xFFFFFFF0, 0xFFFF, 0, 7, RAM, 0, 3);
    TEST_ASSERT_EQUAL_INT(0, send_logical(&b, LRW, 0, data, 16));
}

/* ---- model: bit by bit ----------------------------------------------------------------------------------------- */

typedef struct map {
    uint32_t logical;
    uint16_t length, physical;
    uint8_t start_bit, end_bit, physical_bit, type;
} map_t;

static bool get_bit(const uint8_t *bytes, size_t bit) { return bytes[bit / 8] >> bit % 8 & 1; }
static void set_bit(uint8_t *bytes, size_t bit, bool value)
{
    bytes[bit / 8] = (uint8_t)((bytes[bit / 8] & ~(1u << bit % 8)) | (unsigned)value << bit % 8);
}

/* What an LRW over one FMMU does to the frame and the memory of the slave. */
static void model_exchange(const map_t *map, uint8_t *ram, uint8_t *data, uint32_t address, uint32_t length, bool write)
{
    size_t physical = (map->physical - RAM) * 8u + map->physical_bit;
    for (uint32_t byte = map->logical; byte < map->logical + map->length; byte++) {
        const unsigned first = byte == map->logical ? map->start_bit : 0;
        const unsigned last = byte == map->logical + map->length - 1 ? map->end_bit : 7;
        for (unsigned bit = first; bit <= last; bit++, physical++) {
            if (byte < address || byte >= address + length)
                continue;
            const size_t logical = (byte - address) * 8u + bit;
            if (write)
                set_bit(ram, physical, get_bit(data, logical));
            else
                set_bit(data, logical, get_bit(ram, physical));
        }
    }
}

static unsigned pick(unsigned range) { return (unsigned)rand() % range; }

static void test_random_bit_maps_do_what_the_model_does(void)
{
    const unsigned seed = 20250301;
    printf("seed %u\n", seed);
    srand(seed);
    for (int round = 0; round < 3000; round++) {
        uint8_t ram[RAM_BYTES], data[LOGICAL_BYTES], expected[LOGICAL_BYTES];
        for (int i = 0; i < RAM_BYTES; i++)
            ram[i] = (uint8_t)rand();
        for (int i = 0; i < LOGICAL_BYTES; i++)
            expected[i] = data[i] = (uint8_t)rand();
        const map_t map = {
            .logical = LOGICAL + pick(20), .length = (uint16_t)(1 + pick(24)), .physical = (uint16_t)(RAM + pick(24)),
            .start_bit = (uint8_t)pick(8), .end_bit = (uint8_t)pick(8), .physical_bit = (uint8_t)pick(8),
            .type = (uint8_t)(1 + pick(2)),
        };
        write_bytes(&b, 0, RAM, ram, RAM_BYTES);
        write_fmmu(&b, 0, 0, map.logical, map.length, map.start_bit, map.end_bit, map.physical, map.physical_bit,
                   map.type);
        const uint32_t address = LOGICAL + pick(30), length = 1 + pick(LOGICAL_BYTES - 1);
        model_exchange(&map, ram, expected, address, length, map.type == 2);
        send_logical(&b, LRW, address, data, (uint16_t)length);
        uint8_t now[RAM_BYTES] = {0};
        TEST_ASSERT_EQUAL_INT(1, send_to(&b, APRD, 0, RAM, now, RAM_BYTES));
        TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(ram, now, RAM_BYTES, "memory");
        TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(expected, data, LOGICAL_BYTES, "frame");
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_lrw_counts_three_for_a_slave_that_reads_and_writes);
    RUN_TEST(test_bytes_written_and_read_at_the_same_address_are_exchanged);
    RUN_TEST(test_an_fmmu_that_is_off_maps_nothing);
    RUN_TEST(test_a_register_can_be_mapped);
    RUN_TEST(test_addresses_at_the_end_of_the_logical_space_do_not_wrap);
    RUN_TEST(test_random_bit_maps_do_what_the_model_does);
    return UNITY_END();
}
