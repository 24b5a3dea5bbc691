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
static uint8_t outputs[IMAGE], inputs[IMAGE], claimed[IMAGE], safe[IMAGE];
static cm1e_bus_slave_t slave = {.info = {.position = 1}, .placement = {.output_bytes = IMAGE, .input_bytes = 2}};
static cm1e_bus_t bus = {
    .slaves = &slave, .slave_count = 1, .layout = {1, 1}, .outputs = outputs, .inputs = inputs, .safe.claimed = claimed,
    .safe.values = safe, .phase = BUS_OPERATING,
};

static cm1e_io_t output_at(uint32_t place, uint16_t bits, cm1e_io_type_t type)
{
    cm1e_io_t io;
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_io_find_bits(&bus, 1, true, place, bits, type, &io, &diag), diag.text);
    return io;
}

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
        memset(read, 0, sizeof read);
        TEST_ASSERT_EQUAL_UINT(size, cm1e_io_bytes(&io, read, size));
        TEST_ASSERT_EQUAL_MEMORY(written, read, size);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, cm1e_io_set_bytes(&io, written, size + 1));
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, cm1e_io_set_integer(&io, 0));
    }
}

/** Both ends of the range of each type and number of bits, and the numbers beside them, as a whole number and as a real
 *  one. */
static void test_an_output_takes_the_whole_range_of_its_type_and_no_more(void)
{
    for (int type = CM1E_IO_BOOL; type <= CM1E_IO_ULINT; type++) {
        const cm1e_io_type_row_t *row = &cm1e_io_types[type];
        for (uint16_t bits = type == CM1E_IO_BOOL ? 1 : 2; bits <= row->bits; bits++) {
            const cm1e_io_t io = output_at(3, bits, (cm1e_io_type_t)type);
            const int magnitude = bits - row->is_signed;
            const double least = row->is_signed ? -ldexp(1, magnitude) : 0, end = ldexp(1, magnitude);
            const int64_t most = magnitude >= 63 ? INT64_MAX : (INT64_C(1) << magnitude) - 1;
            TEST_ASSERT_EQUAL(CM1E_OK, cm1e_io_set_integer(&io, most));
            TEST_ASSERT_EQUAL_INT64(most, cm1e_io_integer(&io));
            if (magnitude < 63)
                TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT, cm1e_io_set_integer(&io, most + 1));
            TEST_ASSERT_EQUAL(CM1E_OK, cm1e_io_set_integer(&io, (int64_t)least));
            TEST_ASSERT_EQUAL_INT64((int64_t)least, cm1e_io_integer(&io));
            if (least > -0x1p63)
                TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT, cm1e_io_set_integer(&io, (int64_t)least - 1));
            const double wrong[] = {end, nextafter(least, -INFINITY), 0.5, -1e300, 1e300, NAN, INFINITY, -INFINITY};
            for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
                TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT, cm1e_io_set_real(&io, wrong[i]));
            TEST_ASSERT_EQUAL_INT64((int64_t)least, cm1e_io_integer(&io));
            const double right[] = {least, end <= 0x1p53 ? end - 1 : nextafter(end, 0), end / 2, 0, 1};
            for (size_t i = 0; i < sizeof right / sizeof right[0]; i++) {
                if (right[i] >= end)
                    continue;
                TEST_ASSERT_EQUAL(CM1E_OK, cm1e_io_set_real(&io, right[i]));
                TEST_ASSERT_TRUE(cm1e_io_real(&io) == right[i]);
                TEST_ASSERT_EQUAL(right[i] != 0, cm1e_io_bool(&io));
            }
        }
    }
}

static void test_a_real_is_read_as_a_whole_number_and_written_as_one(void)
{
    static const struct {
        double value;
        int64_t whole;
    } rows[] = {{2.9, 2}, {-2.9, -2}, {0.25, 0}, {0x1p62, INT64_C(1) << 62}, {0x1p63, INT64_MAX}, {1e300, INT64_MAX},
                {-0x1p63, INT64_MIN}, {-0x1.8p63, INT64_MIN}, {-0x1p62, -(INT64_C(1) << 62)}};
    const cm1e_io_t wide = output_at(5, 64, CM1E_IO_LREAL), narrow = output_at(80, 32, CM1E_IO_REAL);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_io_set_real(&wide, rows[i].value));
        TEST_ASSERT_EQUAL_INT64(rows[i].whole, cm1e_io_integer(&wide));
        TEST_ASSERT_TRUE(cm1e_io_bool(&wide));
    }
    static const uint8_t not_a_number[8] = {0, 0, 0, 0, 0, 0, 0xF8, 0x7F};
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_io_set_bytes(&wide, not_a_number, 8));
    TEST_ASSERT_EQUAL_INT64(0, cm1e_io_integer(&wide));
    TEST_ASSERT_TRUE(isnan(cm1e_io_real(&wide)));
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_io_set_integer(&narrow, -7));
    TEST_ASSERT_TRUE(cm1e_io_real(&narrow) == -7.0);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_io_set_bool(&narrow, false));
    TEST_ASSERT_FALSE(cm1e_io_bool(&narrow));
    TEST_ASSERT_EQUAL_UINT(4, cm1e_io_bytes(&narrow, inputs, sizeof inputs));
}

static void test_what_no_signal_has_is_refused(void)
{
    static const struct {
        uint32_t place;
        uint16_t bits;
        int type;
        bool output;
        const char *text;
    } rows[] = {
        {0, 0, CM1E_IO_UINT, true, "A signal of type UINT has not 0 bits."},
        {0, 17, CM1E_IO_UINT, true, "A signal of type UINT has not 17 bits."},
        {0, 2, CM1E_IO_BOOL, true, "A signal of type BOOL has not 2 bits."},
        {0, 31, CM1E_IO_REAL, true, "A signal of type REAL has not 31 bits."},
        {0, 63, CM1E_IO_LREAL, true, "A signal of type LREAL has not 63 bits."},
        {0, 1, CM1E_IO_TYPE_COUNT, true, "A signal of type ? has not 1 bits."},
        {0, 1, -1, true, "A signal of type ? has not 1 bits."},
        {8 * IMAGE, 1, CM1E_IO_BOOL, true, "Slave 1 has 320 bits of outputs: bits 320 ... 320 are not among them."},
        {8 * IMAGE - 7, 8, CM1E_IO_USINT, true, "Slave 1 has 320 bits of outputs: bits 313 ... 320 are not among them."},
        {9, 8, CM1E_IO_USINT, false, "Slave 1 has 16 bits of inputs: bits 9 ... 16 are not among them."},
    };
    cm1e_io_t io;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        TEST_ASSERT_NOT_EQUAL(CM1E_OK, cm1e_io_find_bits(&bus, 1, rows[i].output, rows[i].place, rows[i].bits,
                                                         (cm1e_io_type_t)rows[i].type, &io, &diag));
        TEST_ASSERT_EQUAL_STRING(rows[i].text, diag.text);
        TEST_ASSERT_EQUAL(CM1E_IO_INVALID, cm1e_io_quality(&io));
    }
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_io_find_bits(&bus, 1, true, 8 * IMAGE - 8, 8, CM1E_IO_USINT, &io, &diag));
    TEST_ASSERT_EQUAL(CM1E_ERROR_NOT_FOUND, cm1e_io_find_bits(&bus, 2, true, 0, 1, CM1E_IO_BOOL, &io, &diag));
    TEST_ASSERT_EQUAL_STRING("There is no slave 2: the network has 1.", diag.text);
    TEST_ASSERT_EQUAL(CM1E_ERROR_NOT_FOUND, cm1e_io_find_object(&bus, 2, 0x7000, 1, true, &io, &diag));
    TEST_ASSERT_EQUAL_STRING("There is no slave 2: the network has 1.", diag.text);
    TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT, cm1e_io_find_object(NULL, 1, 0x7000, 1, true, &io, &diag));
    TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT, cm1e_io_find_bits(NULL, 1, true, 0, 1, CM1E_IO_BOOL, &io, &diag));
}

/** An input is where the inputs of its slave are, and nobody writes it. */
static void test_an_input_is_read_and_not_written(void)
{
    cm1e_io_t io;
    memset(inputs, 0, sizeof inputs);
    memset(outputs, 0xFF, sizeof outputs);
    slave.placement.input_offset = 3;
    inputs[4] = 0x50;
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_io_find_bits(&bus, 1, false, 12, 3, CM1E_IO_SINT, &io, &diag));
    TEST_ASSERT_EQUAL_INT64(-3, cm1e_io_integer(&io));
    TEST_ASSERT_TRUE(cm1e_io_bool(&io) && cm1e_io_real(&io) == -3.0);
    TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT, cm1e_io_set_integer(&io, 0));
    TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT, cm1e_io_set_real(&io, 0));
    TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT, cm1e_io_set_bytes(&io, inputs, 1));
    TEST_ASSERT_FALSE(cm1e_io_is_claimed(&io));
    cm1e_io_guest_release(&io); /* nothing to give back */
    TEST_ASSERT_EQUAL_HEX8(0x50, inputs[4]);
    TEST_ASSERT_EQUAL_HEX8(0xFF, outputs[4]);
    slave.placement.input_offset = 0;
}

/** An output that is released has its safe value, with all of its bits, and no other bit has. */
static void test_what_is_released_is_safe_bit_by_bit(void)
{
    for (int n = 0; n < TRIES / 100; n++) {
        const uint16_t bits = (uint16_t)(1 + pick(64));
        const uint32_t place = (uint32_t)pick(8 * IMAGE - bits + 1);
        uint8_t before[IMAGE];
        for (unsigned i = 0; i < IMAGE; i++) {
            before[i] = outputs[i] = (uint8_t)chance();
            safe[i] = (uint8_t)chance();
        }
        const cm1e_io_t io = output_at(place, bits, CM1E_IO_ULINT);
        cm1e_io_guest_release(&io);
        for (uint32_t bit = 0; bit < 8 * IMAGE; bit++) {
            const uint8_t *from = bit >= place && bit < place + bits ? safe : before;
            TEST_ASSERT_FALSE((from[bit / 8] ^ outputs[bit / 8]) >> bit % 8 & 1);
        }
    }
}

/** Each of these alone says how far a value can be trusted. */
static void test_the_quality_is_that_of_bus_and_slave(void)
{
    static const char *const names[] = {"good", "stale", "offline", "invalid", "?", "?"};
    for (int quality = 0; quality < 6; quality++)
        TEST_ASSERT_EQUAL_STRING(names[quality], cm1e_io_quality_name((cm1e_io_quality_t)(quality < 5 ? quality : -1)));
    bus.config.lost_cycles_limit = 3;
    slave.hot.counted = true;
    const cm1e_io_t io = output_at(0, 1, CM1E_IO_BOOL);
    const cm1e_bus_slave_t good = slave;
    TEST_ASSERT_EQUAL(CM1E_IO_GOOD, cm1e_io_quality(&io)); /* before the first look of the supervision */
    slave.watch.al_state = CM1E_AL_OP;
    TEST_ASSERT_EQUAL(CM1E_IO_GOOD, cm1e_io_quality(&io));
    slave.watch.al_state = CM1E_AL_SAFE_OP;
    TEST_ASSERT_EQUAL(CM1E_IO_OFFLINE, cm1e_io_quality(&io));
    slave.watch = (cm1e_slave_watch_t){.lost = true};
    TEST_ASSERT_EQUAL(CM1E_IO_OFFLINE, cm1e_io_quality(&io));
    slave = good;
    for (slave.silent_cycles = 1; slave.silent_cycles < 5; slave.silent_cycles++) {
        bus.last_error = CM1E_ERROR_BUS_WORKING_COUNTER;
        TEST_ASSERT_EQUAL(slave.silent_cycles < 3 ? CM1E_IO_STALE : CM1E_IO_OFFLINE, cm1e_io_quality(&io));
    }
    slave = good;
    bus.silence.partly_fresh = true; /* the slave took part, another one did not */
    TEST_ASSERT_EQUAL(CM1E_IO_GOOD, cm1e_io_quality(&io));
    bus.silence.partly_fresh = false;
    bus.last_error = CM1E_ERROR_BUS_LOST;
    for (bus.bad_cycles = 1; bus.bad_cycles < 5; bus.bad_cycles++)
        TEST_ASSERT_EQUAL(bus.bad_cycles < 3 ? CM1E_IO_STALE : CM1E_IO_OFFLINE, cm1e_io_quality(&io));
    bus.bad_cycles = 0;
    bus.last_error = CM1E_OK;
    bus.phase = BUS_CONFIGURED;
    TEST_ASSERT_EQUAL(CM1E_IO_OFFLINE, cm1e_io_quality(&io));
    bus.phase = BUS_OPERATING;
    TEST_ASSERT_EQUAL(CM1E_IO_GOOD, cm1e_io_quality(&io));
    slave.hot.relaid++; /* it came with other process data than was planned */
    TEST_ASSERT_EQUAL(CM1E_IO_INVALID, cm1e_io_quality(&io));
    TEST_ASSERT_EQUAL(CM1E_ERROR_STATE, cm1e_io_set_integer(&io, 1));
    slave.hot.relaid--;
    bus.layout.present++; /* of the next start */
    TEST_ASSERT_EQUAL(CM1E_IO_INVALID, cm1e_io_quality(&io));
    bus.layout.present = 0;
    TEST_ASSERT_EQUAL(CM1E_IO_INVALID, cm1e_io_quality(&io));
    bus.layout.present = 1;
}

/** A slave that is out counts as lost after the tolerated cycles, if nothing else is known of it. */
static void test_a_slave_that_is_out_is_lost_after_the_tolerated_cycles(void)
{
    bus.config.lost_cycles_limit = 3;
    bus.counters.cycles = 100;
    for (unsigned state = CM1E_AL_NONE; state <= CM1E_AL_OP; state++) {
        for (unsigned since = 95; since <= 100; since++) {
            for (int counted = 0; counted < 2; counted++) {
                slave.hot = (cm1e_hot_t){.counted = counted, .out_since = since, .bound = 7};
                slave.watch = (cm1e_slave_watch_t){.al_state = (uint16_t)state};
                const cm1e_slave_watch_t watch = cm1e_bus_slave_watch(&bus, 1);
                const bool lost = !counted && since <= 97 && (state == CM1E_AL_NONE || state == CM1E_AL_OP);
                TEST_ASSERT_EQUAL(lost, watch.lost);
                TEST_ASSERT_TRUE(watch.out == !counted && watch.fresh == counted && !watch.silent && watch.bound == 7);
            }
        }
    }
    TEST_ASSERT_TRUE(cm1e_bus_slave_watch(&bus, 2).lost);
    slave.hot = (cm1e_hot_t){.counted = true};
    slave.watch = (cm1e_slave_watch_t){.al_state = 0};
}

/** Nothing has changed since it was seen: each of these is a change. */
static void test_a_slave_goes_on_only_as_it_was_seen(void)
{
    enum { CHANGES = 14 };
    for (int change = 0; change <= CHANGES; change++) {
        bus.config.lost_cycles_limit = 3;
        bus.last_error = CM1E_OK;
        slave.silent_cycles = 2;
        slave.hot = (cm1e_hot_t){.counted = true, .bound = 5};
        slave.watch = (cm1e_slave_watch_t){.al_state = CM1E_AL_OP, .al_status_code = 9};
        cm1e_slave_watch_t seen = {.al_state = CM1E_AL_OP, .al_status_code = 9, .fresh = true, .bound = 5};
        bus.last_error = change == 1 ? CM1E_ERROR_BUS_LOST : CM1E_OK;
        slave.hot.counted = change != 2;
        slave.hot.bound += change == 3;
        slave.silent_cycles += change == 4;
        slave.watch.al_state ^= change == 5 ? 4 : 0;
        slave.watch.al_status_code += change == 6;
        slave.watch.lost = change == 7;
        seen.lost = change == 8;
        seen.silent = change == 9;
        seen.out = change == 10;
        seen.fresh = change != 11;
        slave.watch.absent = change == 12;
        seen.absent = change == 13;
        TEST_ASSERT_EQUAL(change == 0 || change == CHANGES, cm1e_bus_slave_goes_on(&bus, 1, &seen));
        TEST_ASSERT_FALSE(cm1e_bus_slave_goes_on(&bus, 2, &seen));
    }
    slave.silent_cycles = 0;
    slave.hot = (cm1e_hot_t){.counted = true};
    slave.watch = (cm1e_slave_watch_t){.al_state = 0};
}

int main(void)
{
    chance_seed(1);
    UNITY_BEGIN();
    RUN_TEST(test_an_output_takes_the_whole_range_of_its_type_and_no_more);
    RUN_TEST(test_a_real_is_read_as_a_whole_number_and_written_as_one);
    RUN_TEST(test_what_no_signal_has_is_refused);
    RUN_TEST(test_an_input_is_read_and_not_written);
    RUN_TEST(test_what_is_released_is_safe_bit_by_bit);
    RUN_TEST(test_the_quality_is_that_of_bus_and_slave);
    RUN_TEST(test_a_slave_that_is_out_is_lost_after_the_tolerated_cycles);
    RUN_TEST(test_a_slave_goes_on_only_as_it_was_seen);
    RUN_TEST(test_what_is_found_is_claimed_bit_by_bit);
    RUN_TEST(test_every_value_of_every_type_lies_anywhere);
    RUN_TEST(test_a_real_output_takes_finite_numbers_of_its_type);
    RUN_TEST(test_bytes_of_any_length_lie_anywhere);
    return UNITY_END();
}
