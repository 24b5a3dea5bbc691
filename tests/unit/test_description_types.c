/* CoE data types by name, number and size: ETG.1020 "Base data types". */
#include "description/description.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

static const struct {
    const char *name;
    uint16_t code;
    uint32_t bits;
} types[] = {
    {"BOOL", 0x01, 1}, {"SINT", 0x02, 8}, {"UINT", 0x06, 16}, {"UDINT", 0x07, 32}, {"REAL", 0x08, 32},
    {"STRING(5)", 0x09, 40}, {"STRING(0)", 0x09, 0}, {"STRING", 0x09, 0}, {"OCTET_STRING(3)", 0x0A, 24},
    {"UNICODE_STRING(3)", 0x0B, 48}, {"UINT24", 0x16, 24}, {"ULINT", 0x1B, 64}, {"GUID", 0x1D, 128}, {"BIT3", 0x32, 3},
    {"ARRAY [0..3] OF BYTE", 0x0A, 32}, {"ARRAY [0..1] OF UINT", 0x0B, 32}, {"ARRAY [1..3] OF INT", 0x0260, 48},
    {"ARRAY [0..7] OF SINT", 0x0261, 64}, {"ARRAY [0..0] OF DINT", 0x0262, 32}, {"ARRAY [0..1] OF UDINT", 0x0263, 64},
    {"ARRAY [0..-1] OF BYTE", 0x0A, 0}, {"ARRAY [0..65535] OF BYTE", 0x0A, 524288},
};
static const char *const others[] = {
    "", "uint", "UINT(2)", "UINT ", "STRING(", "STRING()", "STRING(5", "STRING(-1)", "STRING(65536)", "STRING(5) ",
    "STRING(99999999999999999999)", "DT1018", "ARRAY", "ARRAY [0..3] OF REAL", "ARRAY [0..3] OF ", "ARRAY [0..3]",
    "ARRAY [0.3] OF BYTE", "ARRAY [-1..3] OF BYTE", "ARRAY [0..65536] OF BYTE",
    "ARRAY [0..99999999999999999999] OF BYTE",
};

static void test_base_types_have_a_number_and_a_size(void)
{
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(types[i].code, cm1e_type_code(types[i].name), types[i].name);
        TEST_ASSERT_EQUAL_MESSAGE(types[i].bits, cm1e_type_bits(types[i].name), types[i].name);
    }
}

static void test_other_names_have_neither(void)
{
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        TEST_ASSERT_EQUAL_MESSAGE(0, cm1e_type_code(others[i]), others[i]);
        TEST_ASSERT_EQUAL_MESSAGE(0, cm1e_type_bits(others[i]), others[i]);
    }
}

static void test_numbers_have_a_name(void)
{
    cm1e_arena_t arena = {0};
    TEST_ASSERT_EQUAL_STRING("UINT", cm1e_type_name(&arena, 0x06, 16));
    TEST_ASSERT_EQUAL_STRING("BOOL", cm1e_type_name(&arena, 0x01, 1));
    TEST_ASSERT_EQUAL_STRING("STRING(5)", cm1e_type_name(&arena, 0x09, 40));
    TEST_ASSERT_NULL(cm1e_type_name(&arena, 0x7777, 8));
    cm1e_arena_free(&arena);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_base_types_have_a_number_and_a_size);
    RUN_TEST(test_other_names_have_neither);
    RUN_TEST(test_numbers_have_a_name);
    return UNITY_END();
}
