/* Signals in a process image, without a network: any type, any number of bits, at any place. */
#include <math.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "bus/io_guest.h"
#include "chance.h"
#include "cm1e/io.h"
#include "config/io_types.h"
#include "unity.h"

static cm1e_diag_t diag;

void setUp(void) {}
void tearDown(void) {}

enum { IMAGE = 40, TRIES = 200000 };
static uint8_t outputs[IMAGE], claimed[IMAGE];
static cm1e_bus_slave_t slave = {.info = {.position = 1}, .placement = {.output_bytes = IMAGE}};
static cm1e_bus_t bus = {
    .slaves = &slave, .slave_count = 1, .layout = {1, 1}, .outputs = outputs, .safe.claimed = claimed,
    .phase = BUS_OPERATING,
};

/** A signal that was found belongs to the program with all of its bits, and no other bit does. */
static void test_what_is_found_is_claimed_bit_by_bit(void)
{
    for (int n = 0; n < TRIES / 100; n++) {
        const uint16_t bits = (uint16_t)(1 + pick(64));
        const uint32_t place = (uint32_t)pick(8 * IMAGE - bits + 1), looked = (uint32_t)pick(8 * IMAGE);
        cm1e_io_t io, other;
        memset(claimed, 0, sizeof claimed);
        const cm1e_io_info_t listed = {.position = 1, .output = true, .bits = 1, .bit_offset = looked};
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_io_guest_take(&bus, &listed, &other, &diag));
        TEST_ASSERT_FALSE(cm1e_io_is_claimed(&other));
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_io_find_bits(&bus, 1, true, place, bits, CM1E_IO_ULINT, &io, &diag));
        TEST_ASSERT_EQUAL(looked >= place && looked < place + bits, cm1e_io_is_claimed(&other));
    }
}

/** Any type at any place keeps its value, and leaves every other bit alone. */
static void test_every_value_of_every_type_lies_anywhere(void)
{
    for (int n = 0; n < TRIES; n++) {
        uint8_t before[IMAGE];
        for (unsigned i = 0; i < IMAGE; i++)
            before[i] = outputs[i] = (uint8_t)chance();
        const cm1e_io_type_t type = (cm1e_io_type_t)pick(CM1E_IO_BYTES);
        static const uint8_t widest[] = {1, 8, 8, 16, 16, 32, 32, 64, 64, 32, 64};
        const bool exact = type == CM1E_IO_BOOL || type >= CM1E_IO_REAL;
        const uint16_t bits = (uint16_t)(exact ? widest[type] : 1 + pick(widest[type]));
        const uint32_t place = (uint32_t)pick(8 * IMAGE - bits + 1);
        cm1e_io_t io;
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_io_find_bits(&bus, 1, true, place, bits, type, &io, &diag));
        const bool is_signed = type < CM1E_IO_REAL && type % 2 == CM1E_IO_SINT % 2;
        if (type >= CM1E_IO_REAL) {
            const double real = type == CM1E_IO_REAL ? (double)(float)uniform(-1e9, 1e9) : uniform(-1e9, 1e9);
            TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_io_set_real(&io, real));
            TEST_ASSERT_TRUE(cm1e_io_real(&io) == real);
            TEST_ASSERT_EQUAL_INT64((int64_t)real, cm1e_io_integer(&io));
        } else {
            uint64_t value = (uint64_t)chance() << 32 ^ (uint64_t)chance();
            value = bits < 64 ? value & ((UINT64_C(1) << bits) - 1) : is_signed ? value : value >> 1;
            int64_t number = (int64_t)value;
            if (is_signed && bits < 64 && value >> (bits - 1))
                number = (int64_t)value - (INT64_C(1) << (bits - 1)) - (INT64_C(1) << (bits - 1));
            TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_io_set_integer(&io, number));
            TEST_ASSERT_EQUAL_INT64(number, cm1e_io_integer(&io));
            TEST_ASSERT_EQUAL_INT(number != 0, cm1e_io_bool(&io));
            TEST_ASSERT_TRUE(cm1e_io_real(&io) == (double)number);
        }
        for (uint32_t bit = 0; bit < 8 * IMAGE; bit++)
            if (bit < place || bit >= place + bits)
                TEST_ASSERT_FALSE_MESSAGE((before[bit / 8] ^ outputs[bit / 8]) >> bit % 8 & 1, "a bit beside it");
    }
}

/** What would be infinite, or no number, on the wire is refused, in words, and the output stays. */
static void test_a_real_output_takes_finite_numbers_of_its_type(void)
{
    static const struct {
        cm1e_io_type_t type;
        double value;
        bool right;
    } rows[] = {
        {CM1E_IO_REAL, 3.4028234663852886e38, true}, {CM1E_IO_REAL, -3.4028234663852886e38, true}, {CM1E_IO_REAL, 1e-50, true},
        {CM1E_IO_REAL, 3.5e38, false}, {CM1E_IO_REAL, -1e39, false}, {CM1E_IO_REAL, NAN, false}, {CM1E_IO_REAL, INFINITY, false},
        {CM1E_IO_LREAL, 1e300, true}, {CM1E_IO_LREAL, NAN, false}, {CM1E_IO_LREAL, -INFINITY, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char text[120];
        cm1e_io_t io;
        const uint16_t bits = rows[i].type == CM1E_IO_REAL ? 32 : 64;
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_io_find_bits(&bus, 1, true, 8, bits, rows[i].type, &io, &diag));
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_io_set_real(&io, 0.5));
        TEST_ASSERT_EQUAL_INT(rows[i].right ? CM1E_OK : CM1E_ERROR_INVALID_ARGUMENT, cm1e_io_set_real(&io, rows[i].value));
        TEST_ASSERT_EQUAL_INT(!rows[i].right, cm1e_io_real(&io) == 0.5);
        cm1e_io_say_refusal(&io, rows[i].value, text, sizeof text);
        TEST_ASSERT_EQUAL_INT(!rows[i].right, strstr(text, "a finite number") != NULL);
    }
}

static void test_bytes_of_any_length_lie_anywhere(void)
{
    for (int n = 0; n < TRIES / 10; n++) {
        const uint16_t bits = (uint16_t)(1 + pick(8 * (IMAGE - 1)));
        const uint32_t place = (uint32_t)pick(8 * IMAGE - bits + 1);
        const size_t size = (bits + 7u) / 8u;
        uint8_t written[IMAGE], read[IMAGE];
        for (size_t i = 0; i < size; i++)
            written[i] = (uint8_t)chance();
        if (bits % 8)
            written[size - 1] &= (uint8_t)((1u << bits % 8) - 1u);
        cm1e_io_t io;
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_io_find_bits(&bus, 1, true, place, bits, CM1E_IO_BYTES, &io, &diag));
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_io_set_bytes(&io, written, size));
        TEST_ASSERT_EQUAL_UINT(size, cm1e_io_bytes(&io, read, sizeof read));
        TEST_ASSERT_EQUAL_MEMORY(written, read, size);
        TEST_ASSERT_EQUAL_UINT(0, cm1e_io_bytes(&io, read, size - 1));
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, cm1e_io_set_bytes(&io, written, size + 1));
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, cm1e_io_set_integer(&io, 0));
    }
}

int main(void)
{
    chance_seed(1);
    UNITY_BEGIN();
    RUN_TEST(test_what_is_found_is_claimed_bit_by_bit);
    RUN_TEST(test_every_value_of_every_type_lies_anywhere);
    RUN_TEST(test_a_real_output_takes_finite_numbers_of_its_type);
    RUN_TEST(test_bytes_of_any_length_lie_anywhere);
    return UNITY_END();
}
