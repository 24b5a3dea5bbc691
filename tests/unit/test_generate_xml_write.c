/* Writing XML: the same bytes every time, whatever texts are given. */
#include <stdlib.h>
#include <string.h>

#include "generate/xml_read.h"
#include "generate/xml_write.h"
#include "unity.h"

static cm1e_xml_writer_t xml;
static cm1e_file_t file;
static cm1e_diag_t diag;

void setUp(void) { cm1e_xml_begin(&xml); }
void tearDown(void) { cm1e_file_free(&file); }

#define DECLARATION "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"

static void finish(const char *expected)
{
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_xml_finish(&xml, &file, &diag));
    TEST_ASSERT_EQUAL_STRING(expected, file.bytes);
    TEST_ASSERT_EQUAL(strlen(expected), file.size);
    xmlDoc *doc = cm1e_xml_parse(file.bytes, file.size, &diag);
    TEST_ASSERT_NOT_NULL_MESSAGE(doc, diag.text);
    xmlFreeDoc(doc);
}

static void test_one_element_a_line_two_spaces_an_indent(void)
{
    static const uint8_t bytes[] = {0x00, 0xAB};
    cm1e_xml_open(&xml, "r");
    cm1e_xml_put_attribute(&xml, "n", "#x%04X", 0x1A);
    cm1e_xml_open(&xml, "a");
    cm1e_xml_put(&xml, "b", "%d", 7);
    cm1e_xml_put(&xml, "c", "%s", "");
    cm1e_xml_close(&xml);
    cm1e_xml_put_hex(&xml, "d", (cm1e_bytes_t){bytes, 2});
    cm1e_xml_put_hex(&xml, "e", (cm1e_bytes_t){0});
    cm1e_xml_put_hex(&xml, "e", (cm1e_bytes_t){bytes, 0});
    cm1e_xml_close(&xml);
    finish(DECLARATION "<r n=\"#x001A\">\n  <a>\n    <b>7</b>\n    <c></c>\n  </a>\n  <d>00AB</d>\n</r>\n");
}

static void test_markup_in_texts_is_text(void)
{
    cm1e_xml_open(&xml, "r");
    cm1e_xml_put_attribute(&xml, "a", "%s", "<&\"'>");
    cm1e_xml_put_text(&xml, "%s", "<a>&amp;]]>");
    cm1e_xml_close(&xml);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_xml_finish(&xml, &file, &diag));
    cm1e_arena_t arena = {0};
    cm1e_xml_reader_t reader = {.arena = &arena, .diag = &diag};
    xmlDoc *doc = cm1e_xml_parse(file.bytes, file.size, &diag);
    TEST_ASSERT_NOT_NULL_MESSAGE(doc, diag.text);
    TEST_ASSERT_EQUAL_STRING("<a>&amp;]]>", cm1e_xml_text(&reader, xmlDocGetRootElement(doc)));
    TEST_ASSERT_EQUAL_STRING("<&\"'>", cm1e_xml_attribute(&reader, xmlDocGetRootElement(doc), "a"));
    xmlFreeDoc(doc);
    cm1e_arena_free(&arena);
}

static void test_control_characters_are_left_out(void)
{
    char text[40];
    for (int c = 1; c < 0x20; c++)
        text[c - 1] = (char)c;
    strcpy(text + 31, "\x7F!");
    cm1e_xml_put(&xml, "r", "%s", text);
    finish(DECLARATION "<r>\t\n&#13;\x7F!</r>\n");
}

static void test_bytes_that_are_no_utf8_count_as_latin_1(void)
{
    cm1e_xml_open(&xml, "r");
    cm1e_xml_put(&xml, "a", "%s", "\xE9 50\xB5m");
    cm1e_xml_put(&xml, "b", "%s", "\xC3\xA9 \xE2\x82\xAC");
    cm1e_xml_put(&xml, "c", "%s", "\xC3\xA9\xFF");
    cm1e_xml_close(&xml);
    finish(DECLARATION "<r>\n  <a>\xC3\xA9 50\xC2\xB5m</a>\n  <b>\xC3\xA9 \xE2\x82\xAC</b>\n"
                       "  <c>\xC3\x83\xC2\xA9\xC3\xBF</c>\n</r>\n");
}

/* UTF-8 by its form, but characters that XML does not have. */
static void test_characters_that_xml_lacks_do_not_break_the_file(void)
{
    static const char *const texts[] = {"\xEF\xBF\xBE", "\xEF\xBF\xBF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xC0\x80",
                                        "\xF8\x88\x80\x80\x80", "\xE2\x82"};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        cm1e_xml_put(&xml, "r", "a%sb", texts[i]);
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_xml_finish(&xml, &file, &diag));
        xmlDoc *doc = cm1e_xml_parse(file.bytes, file.size, &diag);
        TEST_ASSERT_NOT_NULL_MESSAGE(doc, diag.text);
        xmlFreeDoc(doc);
        cm1e_file_free(&file);
        cm1e_xml_begin(&xml);
    }
    cm1e_xml_put(&xml, "r", "%s", "");
    finish(DECLARATION "<r></r>\n");
}

static void test_comments_never_end_early(void)
{
    cm1e_xml_put_comment(&xml, "a--b --> c ---- d-");
    cm1e_xml_put_comment(&xml, "-");
    cm1e_xml_put_comment(&xml, "");
    cm1e_xml_put(&xml, "r", "%s", "");
    finish(DECLARATION "<!-- a- -b - -> c - - - - d- -->\n<!-- - -->\n<!--  -->\n<r></r>\n");
}

/* The first error stays: what is asked for after it does nothing. */
static void test_errors_are_told_at_the_end(void)
{
    cm1e_xml_close(&xml);
    cm1e_xml_open(&xml, "r");
    cm1e_xml_put(&xml, "a", "%d", 1);
    cm1e_xml_put_comment(&xml, "x");
    TEST_ASSERT_EQUAL(CM1E_ERROR_NO_MEMORY, cm1e_xml_finish(&xml, &file, &diag));
    TEST_ASSERT_NULL(file.bytes);
    cm1e_xml_begin(&xml);
    cm1e_xml_put(&xml, "r", "%s", "");
    finish(DECLARATION "<r></r>\n");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_one_element_a_line_two_spaces_an_indent);
    RUN_TEST(test_markup_in_texts_is_text);
    RUN_TEST(test_control_characters_are_left_out);
    RUN_TEST(test_bytes_that_are_no_utf8_count_as_latin_1);
    RUN_TEST(test_characters_that_xml_lacks_do_not_break_the_file);
    RUN_TEST(test_comments_never_end_early);
    RUN_TEST(test_errors_are_told_at_the_end);
    return UNITY_END();
}
