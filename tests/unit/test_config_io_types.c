/* The types of signals: their names, which one a number of bits is, and in which words a value is refused. */
#include <math.h>
#include <string.h>

#include "config/io_types.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

static void test_each_type_has_its_name(void)
{
    static const char *const names[] = {"BOOL", "SINT", "USINT", "INT", "UINT", "DINT",
                                        "UDINT", "LINT", "ULINT", "REAL", "LREAL", "BYTES"};
    TEST_ASSERT_EQUAL(CM1E_IO_TYPE_COUNT, sizeof names / sizeof names[0]);
    for (int i = 0; i < CM1E_IO_TYPE_COUNT; i++) {
        TEST_ASSERT_TRUE(cm1e_io_type_of_name(names[i]) < CM1E_IO_TYPE_COUNT);
        TEST_ASSERT_EQUAL_STRING(names[i], cm1e_io_type_name((cm1e_io_type_t)cm1e_io_type_of_name(names[i])));
    }
    TEST_ASSERT_EQUAL_STRING("?", cm1e_io_type_name((cm1e_io_type_t)CM1E_IO_TYPE_COUNT));
    TEST_ASSERT_EQUAL_STRING("?", cm1e_io_type_name((cm1e_io_type_t)-1));
    TEST_ASSERT_EQUAL(CM1E_IO_UDINT, cm1e_io_type_of_name("udint"));
    TEST_ASSERT_EQUAL(CM1E_IO_TYPE_COUNT, cm1e_io_type_of_name("WORD"));
    TEST_ASSERT_EQUAL(CM1E_IO_TYPE_COUNT, cm1e_io_type_of_name(""));
}

static void test_bits_without_a_type_are_the_smallest_one_that_holds_them(void)
{
    static const cm1e_io_type_t types[] = {CM1E_IO_BOOL, CM1E_IO_USINT, CM1E_IO_UINT, CM1E_IO_UDINT, CM1E_IO_ULINT};
    unsigned bits = 1;
    for (int i = 0; i < 5; i++)
        for (; bits <= cm1e_io_types[types[i]].bits; bits++)
            TEST_ASSERT_EQUAL(types[i], cm1e_io_type_of_bits(bits));
    TEST_ASSERT_EQUAL(65, bits);
    TEST_ASSERT_EQUAL(CM1E_IO_BYTES, cm1e_io_type_of_bits(65));
}

static void test_a_refused_value_is_told_in_words(void)
{
    static const struct {
        cm1e_io_type_t type;
        unsigned bits;
        bool output;
        double value;
        const char *words;
    } rows[] = {
        {CM1E_IO_BOOL, 1, false, 2, "it is an input"},
        {CM1E_IO_BOOL, 1, true, 1, "it belongs to a motor (MC_WriteDigitalOutput)"},
        {CM1E_IO_BYTES, 70, true, 1, "it has 70 bits, which are no number"},
        {CM1E_IO_BOOL, 1, true, 2, "its type has no such value: BOOL, 0 or 1"},
        {CM1E_IO_SINT, 8, true, 128, "its type has no such value: SINT, -128 ... 127"},
        {CM1E_IO_USINT, 8, true, -1, "its type has no such value: USINT, 0 ... 255"},
        {CM1E_IO_UINT, 12, true, 4096, "its type has no such value: UINT, 0 ... 4095"},
        {CM1E_IO_INT, 12, true, 2048, "its type has no such value: INT, -2048 ... 2047"},
        {CM1E_IO_DINT, 32, true, 0.5, "its type has no such value: DINT, -2147483648 ... 2147483647"},
        {CM1E_IO_REAL, 32, true, 1e39, "its type has no such value: REAL, a finite number up to 3.402823e+38"},
        {CM1E_IO_LREAL, 64, true, INFINITY, "its type has no such value: LREAL, a finite number"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const cm1e_io_t io = {.type = (uint8_t)rows[i].type, .bits = (uint16_t)rows[i].bits, .output = rows[i].output};
        char text[120];
        cm1e_io_say_refusal(&io, rows[i].value, text, sizeof text);
        TEST_ASSERT_EQUAL_STRING(rows[i].words, text);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_type_has_its_name);
    RUN_TEST(test_bits_without_a_type_are_the_smallest_one_that_holds_them);
    RUN_TEST(test_a_refused_value_is_told_in_words);
    return UNITY_END();
}
