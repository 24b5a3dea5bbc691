/* Texts of others, before they are shown. */
#include <stdio.h>
#include <string.h>

#include "core/text.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

static void test_texts_come_out_as_they_should(void)
{
    static const struct {
        const char *text, *cleaned;
    } cases[] = {
        {"", ""},
        {"Target position", "Target position"},
        {"M\xC3\xBCller \xE2\x82\xAC \xF0\x9F\x98\x80", "M\xC3\xBCller \xE2\x82\xAC \xF0\x9F\x98\x80"},
        {"\x1B[31mred", "?[31mred"},
        {"a\nb\rc\td\x7F", "a?b?c?d?"},
        {"\xC2\x9B" "31m", "?31m"},           /* CSI as one character */
        {"M\xFCller", "M?ller"},              /* ISO-8859-1 */
        {"cut \xE2\x82", "cut ??"},
        {"\xC0\x8A", "??"},                   /* a line feed in two bytes */
        {"\xE0\x80\x9B", "???"},
        {"\xED\xA0\x80", "???"},              /* half of a pair of UTF-16 */
        {"\xF4\x90\x80\x80", "????"},         /* beyond the last character */
        {"\xFF\xFE", "??"},
        {"x\xE2\x80\xAEy\xE2\x81\xA6z\xE2\x80\xA8", "x?y?z?"}, /* from right to left; a line's end */
        {"\xC2\xA0", "\xC2\xA0"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[64];
        snprintf(text, sizeof text, "%s", cases[i].text);
        cm1e_text_clean(text);
        TEST_ASSERT_EQUAL_STRING(cases[i].cleaned, text);
    }
}

/* Every two bytes: what comes out is clean, so that it comes out unchanged the next time. */
static void test_any_two_bytes_are_clean_afterwards(void)
{
    for (unsigned pair = 0x0101; pair <= 0xFFFF; pair++) {
        char once[8] = {(char)(pair >> 8), (char)(pair & 0xFF), 'x', '\0'}, twice[8];
        cm1e_text_clean(once);
        memcpy(twice, once, sizeof twice);
        cm1e_text_clean(twice);
        TEST_ASSERT_EQUAL_STRING(once, twice);
        for (const char *at = once; *at; at++)
            TEST_ASSERT_FALSE((unsigned char)*at < 0x20 || *at == 0x7F);
    }
}

static void test_texts_of_devices_become_clean_utf8(void)
{
    static const struct {
        const char *told;
        size_t size, room;
        const char *text;
    } cases[] = {
        {"Position", 8, 64, "Position"},
        {"ab\0cd", 5, 64, "ab"},
        {"", 0, 64, ""},
        {"M\xC3\xBCller", 7, 64, "M\xC3\xBCller"},
        {"M\xFCller", 6, 64, "M\xC3\xBCller"},       /* ISO 8859-1 */
        {"20 \xB0" "C", 5, 64, "20 \xC2\xB0" "C"},
        {"gr\xC3", 3, 64, "gr"},                      /* UTF-8, cut in the last character */
        {"\xE2\x82", 2, 64, ""},
        {"\xE2\x82\xAC", 2, 64, ""},                  /* nothing is read beyond the size */
        {"\xC3x", 2, 64, "\xC3\x83x"},               /* so it is no UTF-8 */
        {"\xFF", 1, 64, "\xC3\xBF"},
        {"a\x1B[0m\x7F", 6, 64, "a?[0m?"},
        {"a\x9B" "b\xFC", 4, 64, "a?b\xC3\xBC"},     /* control characters of ISO 8859-1 */
        {"x\xE2\x80\xAEy", 5, 64, "x?y"},
        {"abcd", 4, 5, "abcd"},
        {"abcde", 5, 5, "abcd"},
        {"abc\xC3\xBC", 5, 5, "abc"},                /* a character is there as a whole or not at all */
        {"abc\xFC", 4, 5, "abc"},
        {"abc", 3, 1, ""},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[64];
        memset(text, 'Z', sizeof text);
        cm1e_text_of_device(text, cases[i].room, cases[i].told, cases[i].size);
        TEST_ASSERT_EQUAL_STRING(cases[i].text, text);
    }
}

/* Every two bytes and a third, at every size: clean, and the same when it is taken once more. */
static void test_any_bytes_of_a_device_are_clean_afterwards(void)
{
    for (unsigned pair = 0; pair <= 0xFFFF; pair++)
        for (size_t size = 0; size <= 3; size++) {
            const unsigned char told[3] = {(unsigned char)(pair >> 8), (unsigned char)pair, 0xA9};
            char once[8], twice[8], cleaned[8];
            cm1e_text_of_device(once, sizeof once, told, size);
            cm1e_text_of_device(twice, sizeof twice, once, strlen(once));
            TEST_ASSERT_EQUAL_STRING(once, twice);
            memcpy(cleaned, once, sizeof cleaned);
            cm1e_text_clean(cleaned);
            TEST_ASSERT_EQUAL_STRING(once, cleaned);
        }
}

static void test_width_counts_characters(void)
{
    TEST_ASSERT_EQUAL_size_t(0, cm1e_text_width(""));
    TEST_ASSERT_EQUAL_size_t(6, cm1e_text_width("M\xC3\xBCller"));
    TEST_ASSERT_EQUAL_size_t(2, cm1e_text_width("\xE2\x82\xAC\xF0\x9F\x98\x80"));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_texts_come_out_as_they_should);
    RUN_TEST(test_any_two_bytes_are_clean_afterwards);
    RUN_TEST(test_texts_of_devices_become_clean_utf8);
    RUN_TEST(test_any_bytes_of_a_device_are_clean_afterwards);
    RUN_TEST(test_width_counts_characters);
    return UNITY_END();
}
