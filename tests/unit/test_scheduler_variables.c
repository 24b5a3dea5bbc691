/** The table of variables: how a name finds one, and that reading and writing take its bytes and no others. */
#include <stdio.h>
#include <string.h>

#include "scheduler/variables.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

/* ---- names ------------------------------------------------------------------------------------------------------- */

static void test_a_name_finds_its_variable_without_regard_to_case(void)
{
    static const variable_t rows[] = {{.name = "Main.n"}, {.name = "Main.n2"}, {.name = "Main.table[3].speed"}};
    static const char *const names[] = {"Main.n", "MAIN.N2", "main.Table[3].speed", "Main", "Main.n3", "", "Main.n2 "};
    static const uint32_t expected[] = {0, 1, 2, 3, 3, 3, 3};
    const variables_t all = {rows, 3}, none = {rows, 0};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(expected[i], cm1e_variables_find(&all, names[i]), names[i]);
        TEST_ASSERT_EQUAL_UINT32(0, cm1e_variables_find(&none, names[i]));
    }
}

static void test_members_and_elements_are_within_a_path_and_longer_names_are_not(void)
{
    static const struct {
        const char *name, *path;
        bool within;
    } rows[] = {
        {"Main.t", "Main.t", true}, {"Main.t.x", "main.T", true}, {"Main.t[3].x", "Main.t", true},
        {"Main.t[3].x", "Main.t[3]", true}, {"Main.t2", "Main.t", false}, {"Main.t_x", "Main.t", false},
        {"Main.t", "Main.t.x", false}, {"Main.u", "Main.t", false}, {"Main.u.x", "Main.t", false},
        {"Main.t]", "Main.t", false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        TEST_ASSERT_EQUAL_MESSAGE(rows[i].within, cm1e_variable_is_within(rows[i].name, rows[i].path), rows[i].name);
}

static void test_an_enumerator_is_found_by_its_value(void)
{
    static const char *const names[] = {"OFF", "SLOW", "FAST"};
    static const int64_t values[] = {-1, 2, INT64_MAX};
    const variable_t mode = {.names = names, .values = values, .name_count = 3};
    for (int i = 0; i < 3; i++)
        TEST_ASSERT_EQUAL_STRING(names[i], cm1e_variable_enumerator(&mode, values[i]));
    TEST_ASSERT_NULL(cm1e_variable_enumerator(&mode, 0));
    TEST_ASSERT_NULL(cm1e_variable_enumerator(&(variable_t){.name = "n"}, 0));
}

/* ---- bytes ------------------------------------------------------------------------------------------------------- */

enum { GUARD = 0xA5, LARGEST = 16 };

static const struct {
    cm1e_trace_type_t type;
    size_t size;
} types[] = {
    {CM1E_TRACE_BOOL, 1}, {CM1E_TRACE_SINT, 1}, {CM1E_TRACE_INT, 2}, {CM1E_TRACE_DINT, 4}, {CM1E_TRACE_LINT, 8},
    {CM1E_TRACE_USINT, 1}, {CM1E_TRACE_UINT, 2}, {CM1E_TRACE_UDINT, 4}, {CM1E_TRACE_ULINT, 8}, {CM1E_TRACE_REAL, 4},
    {CM1E_TRACE_LREAL, 8},
};

/** The first `size` bytes are those of the source, and the others are as they were. */
static void expect_copied(const uint8_t *copy, const uint8_t *source, size_t size, const char *what)
{
    for (size_t i = 0; i < LARGEST; i++)
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(i < size ? source[i] : GUARD, copy[i], what);
}

static void test_a_number_is_copied_with_its_bytes_and_no_others(void)
{
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
        uint8_t data[LARGEST];
        variable_value_t value;
        const variable_t variable = {.type = types[i].type, .data = data, .bytes = (uint32_t)types[i].size};
        char what[32];
        snprintf(what, sizeof what, "type %d", (int)types[i].type);
        for (int n = 0; n < LARGEST; n++)
            data[n] = (uint8_t)(n + 1);
        memset(value.bytes, GUARD, sizeof value.bytes);
        cm1e_variable_read(&variable, &value);
        expect_copied(value.bytes, data, types[i].size, what);
        for (int n = 0; n < LARGEST; n++)
            value.bytes[n] = (uint8_t)(0xF0 + n);
        memset(data, GUARD, sizeof data);
        cm1e_variable_write(&variable, &value);
        expect_copied(data, value.bytes, types[i].size, what);
    }
}

static void test_a_bit_is_read_by_itself(void)
{
    for (unsigned byte = 0; byte < 256; byte++)
        for (uint8_t bit = 1; bit <= 8; bit++) {
            uint8_t data = (uint8_t)byte;
            const variable_t variable = {.type = CM1E_TRACE_BOOL, .data = &data, .bytes = 1, .bit = bit};
            variable_value_t value;
            memset(value.bytes, GUARD, sizeof value.bytes);
            cm1e_variable_read(&variable, &value);
            TEST_ASSERT_EQUAL_HEX8(byte >> (bit - 1) & 1, value.bytes[0]);
            TEST_ASSERT_EQUAL_HEX8(GUARD, value.bytes[1]);
            TEST_ASSERT_EQUAL_DOUBLE(byte >> (bit - 1) & 1, cm1e_variable_number(&variable));
        }
}

/* ---- texts ------------------------------------------------------------------------------------------------------- */

/** A text of at most four characters: what is behind its end is not read, and one without an end is cut off. */
static void test_a_text_is_read_up_to_its_end(void)
{
    static const struct {
        const char *bytes;
        uint32_t size, used;
        variable_form_t form;
    } rows[] = {
        {"\0bcd\0", 5, 0, VARIABLE_STRING}, {"a\0cd\0", 5, 1, VARIABLE_STRING}, {"abcd\0", 5, 4, VARIABLE_STRING},
        {"abcde", 5, 4, VARIABLE_STRING},
        {"\0\0b\0\0\0", 6, 0, VARIABLE_WSTRING}, {"a\0\0\0c\0", 6, 2, VARIABLE_WSTRING},
        {"a\0b\0\0\0", 6, 4, VARIABLE_WSTRING}, {"\0\1b\0\0\0", 6, 4, VARIABLE_WSTRING}, /* U+0100: its low byte is 0 */
        {"a\0\0\1\0\0", 6, 4, VARIABLE_WSTRING}, {"a\0b\0c\0", 6, 4, VARIABLE_WSTRING},
        {"a\1\0\0c\0", 6, 2, VARIABLE_WSTRING},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        uint8_t data[8];
        variable_value_t value;
        char what[16];
        snprintf(what, sizeof what, "row %zu", i);
        memcpy(data, rows[i].bytes, rows[i].size);
        memset(value.bytes, GUARD, sizeof value.bytes);
        const variable_t variable = {.form = rows[i].form, .data = data, .bytes = rows[i].size};
        cm1e_variable_read(&variable, &value);
        uint8_t expected[LARGEST];
        memcpy(expected, data, rows[i].used);
        expected[rows[i].used] = expected[rows[i].used + 1] = 0;
        expect_copied(value.bytes, expected, rows[i].used + 2, what);
        TEST_ASSERT_EQUAL_DOUBLE(0, cm1e_variable_number(&variable));
    }
}

static void test_a_text_is_written_whole(void)
{
    uint8_t data[LARGEST];
    variable_value_t value = {.bytes = "abcd"};
    memset(data, GUARD, sizeof data);
    cm1e_variable_write(&(variable_t){.form = VARIABLE_STRING, .data = data, .bytes = 7}, &value);
    expect_copied(data, value.bytes, 7, "STRING[6]");
}

/* ---- in a trace -------------------------------------------------------------------------------------------------- */

static void test_a_number_becomes_a_signal_and_a_text_is_refused(void)
{
    static uint8_t data;
    char name[CM1E_TRACE_NAME_BYTES + 1];
    trace_t trace;
    cm1e_diag_t diag;
    const variable_t text = {.name = "Main.text", .form = VARIABLE_STRING, .data = &data},
                     lamp = {.name = name, .unit = "mm", .type = CM1E_TRACE_BOOL, .data = &data, .bit = 3};
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_trace_init(&trace, NULL, 0, 1, 1, &diag));
    TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT, cm1e_variable_trace(&text, &trace, &diag));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "\"Main.text\" is a text"), diag.text);
    memset(name, 'n', sizeof name);
    name[CM1E_TRACE_NAME_BYTES] = '\0';
    TEST_ASSERT_EQUAL(CM1E_ERROR_INVALID_ARGUMENT, cm1e_variable_trace(&lamp, &trace, &diag));
    char most[40];
    snprintf(most, sizeof most, "longer than the %d bytes", CM1E_TRACE_NAME_BYTES - 1);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, most), diag.text);
    name[CM1E_TRACE_NAME_BYTES - 1] = '\0';
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_variable_trace(&lamp, &trace, &diag));
    TEST_ASSERT_EQUAL(1, trace.variables);
    const trace_column_t *column = &trace.columns[trace.column_count - 1];
    TEST_ASSERT_EQUAL_STRING(name, column->name);
    TEST_ASSERT_EQUAL_STRING("mm", column->unit);
    data = 1 << 2;
    TEST_ASSERT_EQUAL_DOUBLE(1, cm1e_trace_value(column));
    data = (uint8_t)~data;
    TEST_ASSERT_EQUAL_DOUBLE(0, cm1e_trace_value(column));
    cm1e_trace_free(&trace);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_a_name_finds_its_variable_without_regard_to_case);
    RUN_TEST(test_members_and_elements_are_within_a_path_and_longer_names_are_not);
    RUN_TEST(test_an_enumerator_is_found_by_its_value);
    RUN_TEST(test_a_number_is_copied_with_its_bytes_and_no_others);
    RUN_TEST(test_a_bit_is_read_by_itself);
    RUN_TEST(test_a_text_is_read_up_to_its_end);
    RUN_TEST(test_a_text_is_written_whole);
    RUN_TEST(test_a_number_becomes_a_signal_and_a_text_is_refused);
    return UNITY_END();
}
