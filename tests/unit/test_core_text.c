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

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_texts_come_out_as_they_should);
    RUN_TEST(test_any_two_bytes_are_clean_afterwards);
    return UNITY_END();
}
