/* Reading XML of strangers: what real files do is tolerated, what is hostile is refused with its line, in silence. */
#include <fcntl.h>
#include <libxml/xmlerror.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "generate/xml_read.h"
#include "unity.h"

static cm1e_diag_t diag;
static cm1e_arena_t arena;
static cm1e_xml_reader_t reader;
static xmlDoc *doc;
static char *made;

void setUp(void)
{
    diag = (cm1e_diag_t){0};
    reader = (cm1e_xml_reader_t){.arena = &arena, .diag = &diag};
}

void tearDown(void)
{
    xmlFreeDoc(doc);
    doc = NULL;
    cm1e_arena_free(&arena);
    free(made);
    made = NULL;
}

static const xmlNode *parse_bytes(const void *bytes, size_t size)
{
    xmlFreeDoc(doc);
    doc = cm1e_xml_parse(bytes, size, &diag);
    return doc ? xmlDocGetRootElement(doc) : NULL;
}

static const xmlNode *parse(const char *text) { return parse_bytes(text, strlen(text)); }

static const xmlNode *need(const char *text)
{
    const xmlNode *root = parse(text);
    TEST_ASSERT_NOT_NULL_MESSAGE(root, diag.text);
    return root;
}

static void refused(const char *text, const char *because)
{
    diag = (cm1e_diag_t){0};
    TEST_ASSERT_NULL_MESSAGE(parse(text), text);
    TEST_ASSERT_EQUAL(CM1E_ERROR_FILE, diag.error);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, because), diag.text);
}

/* `times` times a text, between two others. */
static const char *many(const char *before, const char *text, size_t times, const char *after)
{
    const size_t length = strlen(text);
    free(made);
    made = malloc(strlen(before) + times * length + strlen(after) + 1);
    TEST_ASSERT_NOT_NULL(made);
    char *to = stpcpy(made, before);
    for (size_t i = 0; i < times; i++, to += length)
        memcpy(to, text, length);
    strcpy(to, after);
    return made;
}

/* ---- what is tolerated ------------------------------------------------------------------------------------------ */

static void test_comment_before_the_declaration_is_passed_over_and_lines_stay_right(void)
{
    const xmlNode *root = need("\xEF\xBB\xBF <!-- one\n-->\n\n<!-- > <a> -->\n"
                               "<?xml version=\"1.0\"?>\n<r>\n<a>1</a></r>");
    TEST_ASSERT_EQUAL_STRING("r", root->name);
    TEST_ASSERT_EQUAL(6, cm1e_xml_line(root));
    TEST_ASSERT_EQUAL(7, cm1e_xml_line(cm1e_xml_child(root, "a")));
    refused("<!-- x\n-->\n<?xml version=\"1.0\"?>\n<r>\n<a></b></r>", "line 5: ");
}

static void test_comment_where_xml_allows_it_is_no_reason_to_skip(void)
{
    TEST_ASSERT_EQUAL(3, cm1e_xml_line(need("<!-- x\n-->\n<r/>")));
    refused("<!-- never closed\n<?xml version=\"1.0\"?><r/>", "line ");
    refused("<!--", "line 1: ");
    refused("<!--->", "line 1: ");
}

static void test_byte_order_mark_says_utf8_whatever_the_declaration_says(void)
{
    TEST_ASSERT_EQUAL_STRING("\xC3\xA9", cm1e_xml_text(&reader, need("\xEF\xBB\xBF<r>\xC3\xA9</r>")));
    TEST_ASSERT_EQUAL_STRING("\xC3\xA9", cm1e_xml_text(&reader, need("\xEF\xBB\xBF<?xml version=\"1.0\" "
                                                                   "encoding=\"ISO-8859-1\"?><r>\xC3\xA9</r>")));
}

static void test_other_encodings_become_utf8(void)
{
    static const char utf16[] = "\xFF\xFE<\0r\0>\0\n\0<\0a\0>\0\xE9\0<\0/\0a\0>\0<\0/\0r\0>\0";
    static const char utf16_big[] = "\xFE\xFF\0<\0r\0>\0\n\0<\0a\0>\0\xE9\0<\0/\0a\0>\0<\0/\0r\0>";
    TEST_ASSERT_EQUAL_STRING("\xC3\xA9", cm1e_xml_text(&reader, need("<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>"
                                                                   "<r>\xE9</r>")));
    TEST_ASSERT_EQUAL_STRING("\xE2\x82\xAC", cm1e_xml_text(&reader, need("<?xml version=\"1.0\" "
                                                                       "encoding=\"windows-1252\"?><r>\x80</r>")));
    const xmlNode *root = parse_bytes(utf16, sizeof utf16 - 1);
    TEST_ASSERT_NOT_NULL_MESSAGE(root, diag.text);
    TEST_ASSERT_EQUAL_STRING("\xC3\xA9", cm1e_xml_child_text(&reader, root, "a", "?"));
    TEST_ASSERT_EQUAL(2, cm1e_xml_line(cm1e_xml_child(root, "a")));
    TEST_ASSERT_NOT_NULL_MESSAGE(parse_bytes(utf16_big, sizeof utf16_big - 1), diag.text);
}

static void test_cr_lf_and_white_space_do_not_matter(void)
{
    const xmlNode *root = need("<r>\r\n\t<a>\r\n  two words \r\n</a>\r\n<b x=' 7 '><![CDATA[ <c> ]]></b></r>\r\n");
    TEST_ASSERT_EQUAL_STRING("two words", cm1e_xml_child_text(&reader, root, "a", "?"));
    TEST_ASSERT_EQUAL(5, cm1e_xml_line(cm1e_xml_child(root, "b")));
    TEST_ASSERT_EQUAL_STRING("<c>", cm1e_xml_child_text(&reader, root, "b", "?"));
    TEST_ASSERT_EQUAL_STRING("7", cm1e_xml_attribute(&reader, cm1e_xml_child(root, "b"), "x"));
}

static void test_lines_beyond_65535_are_right(void)
{
    const xmlNode *root = need(many("<r>", "\n", 99999, "<a/><b>\n1</b>\n<c></c></r>"));
    TEST_ASSERT_EQUAL(100000, cm1e_xml_line(cm1e_xml_child(root, "a")));
    TEST_ASSERT_EQUAL(100000, cm1e_xml_line(cm1e_xml_child(root, "b")));
    TEST_ASSERT_EQUAL(100002, cm1e_xml_line(cm1e_xml_child(root, "c")));
    refused(many("<r>", "\n", 99999, "<a></r>"), "line 100000: ");
    TEST_ASSERT_EQUAL(70002, cm1e_xml_line(need(many("<!--", "\n", 70000, "-->\n<?xml version='1.0'?><r/>"))));
}

/* ---- what is refused -------------------------------------------------------------------------------------------- */

static const struct {
    const char *text, *because;
} hostile[] = {
    {"<!DOCTYPE r [\n<!ENTITY a \"aaaaaaaaaa\">\n<!ENTITY b \"&a;&a;&a;&a;\">\n]>\n<r>&b;</r>", "line 1: a DTD"},
    {"<?xml version='1.0'?>\n<!DOCTYPE r SYSTEM \"http://localhost/x.dtd\">\n<r/>", "line 2: a DTD"},
    {"<!DOCTYPE r [<!ENTITY x SYSTEM \"file:///etc/passwd\">]><r>&x;</r>", "a DTD"},
    {"<!DOCTYPE r [<!ENTITY % x SYSTEM \"file:///etc/passwd\"> %x;]><r/>", "a DTD"},
    {"<r>\n&x;</r>", "line 2: "},
    {"<r>&#0;</r>", "line 1: "},
    {"<r>&#xFFFFFFFFF;</r>", "line 1: "},
    {"", "0 bytes"},
    {" ", "line "},
    {"no XML", "line 1: "},
    {"<r>", "line 1: "},
    {"<r>\n<a>\n", "line 3: "},
    {"<r", "line 1: "},
    {"<r></r><s/>", "line 1: "},
    {"<r>\n\n<a></b></r>", "line 3: "},
    {"<r>\n<a>\n<b>\n</a>\n</r>\n\n", "line 4: Opening and ending tag mismatch: b line 3 and a"}, /* not the end */
    {"<r a='1' a='2'/>", "line 1: "},
    {"<r>\n\xE9</r>", "line 2: "},
    {"<r>\n\xF4\xBF\xBF\xBF</r>", "line 2: "},
    {"<r>\x01</r>", "line 1: "},
    {"<?xml version='1.0' encoding='no-such-thing'?>\n<r/>", "line 1: "},
    {"<?xml version='1.0' encoding='UTF-16'?>\n<r>\xE9</r>", "line "},
    {"<?xml version='1.0' encoding='US-ASCII'?>\n<r>\xE9</r>", "line "},
    {"<?xml version='1.0' encoding='SHIFT_JIS'?>\n<r>\x81</r>", "line "},
    {"\xFF\xFE<", "line "},
    {"\xFE\xFF\xD8", "line "},
};
enum { HOSTILE = sizeof hostile / sizeof hostile[0] };

static void test_hostile_documents_are_refused_with_their_line(void)
{
    for (int i = 0; i < HOSTILE; i++)
        refused(hostile[i].text, hostile[i].because);
}

static void test_depth_is_bounded(void)
{
    char deep[1024] = "";
    for (int i = 0; i < 99; i++)
        strcat(deep, "<a>");
    strcat(deep, "<b/>");
    for (int i = 0; i < 99; i++)
        strcat(deep, "</a>");
    need(deep);
    refused(many("<r>\n", "<a>", 150, ""), "line 2: elements within elements deeper");
    refused(many("<r>\n", "<a>", 1000000, ""), "line 2: elements within elements deeper");
}

static void test_number_of_elements_attributes_and_comments_is_bounded(void)
{
    need(many("<r>", "<a b=''/>", 100000, "</r>"));
    refused(many("<r>\n", "<a/>", CM1E_XML_MAX_PARTS, "</r>"), "line 2: more elements");
    refused(many("<r>\n", "<a b='' c=''/>", CM1E_XML_MAX_PARTS / 3, "</r>"), "line 2: more elements");
    refused(many("<r>\n", "<!---->", CM1E_XML_MAX_PARTS, "</r>"), "line 2: more elements");
    refused(many("<r>\n", "<?a?>", CM1E_XML_MAX_PARTS, "</r>"), "line 2: more elements");
}

static void test_endless_tags_are_refused(void)
{
    char attributes[60000];
    char *to = stpcpy(attributes, "<r");
    for (int i = 0; i < 5000; i++)
        to += sprintf(to, " a%d=''", i);
    strcpy(to, "/>");
    need(attributes);
    refused(many("<r>\n<a b='", "x", 70000, "'/></r>"), "line 2: a tag without an end");
    need(many("<r><!--", "x", 70000, "--></r>"));
    need(many("<r>", "x", 70000, "</r>"));
    need(many("<r><![CDATA[", "x", 70000, "]]></r>"));
}

static void test_size_is_bounded(void)
{
    char *big = malloc(CM1E_XML_MAX_BYTES + 1);
    TEST_ASSERT_NOT_NULL(big);
    memset(big, ' ', CM1E_XML_MAX_BYTES + 1);
    memcpy(big, "<r/>", 4);
    TEST_ASSERT_NULL(cm1e_xml_parse(big, CM1E_XML_MAX_BYTES + 1, &diag));
    TEST_ASSERT_NOT_NULL(strstr(diag.text, "33554433 bytes"));
    free(big);
    char line[1025];
    memset(line, 'x', sizeof line);
    memcpy(line, "<a>", 3);
    memcpy(line + sizeof line - 5, "</a>", 5);
    need(many("<r>", line, CM1E_XML_MAX_BYTES / 1024 - 1, "</r>"));
}

static void test_nothing_is_printed(void)
{
    char path[] = CM1E_TEST_OUTPUT "/cm1e_xml_XXXXXX";
    const int kept = dup(STDERR_FILENO), file = mkstemp(path);
    TEST_ASSERT_GREATER_OR_EQUAL(0, file);
    fflush(stderr);
    dup2(file, STDERR_FILENO);
    for (int i = 0; i < HOSTILE; i++)
        parse(hostile[i].text);
    fflush(stderr);
    dup2(kept, STDERR_FILENO);
    const off_t printed = lseek(file, 0, SEEK_END);
    close(kept);
    close(file);
    unlink(path);
    TEST_ASSERT_EQUAL(0, printed);
}

static void own_handler(void *context, xmlError *error) { (void)context, (void)error; }

static void test_handler_of_the_application_comes_back(void)
{
    int context;
    xmlSetStructuredErrorFunc(&context, own_handler);
    parse("<r>");
    TEST_ASSERT_TRUE(xmlStructuredError == own_handler && xmlStructuredErrorContext == &context);
    xmlSetStructuredErrorFunc(NULL, NULL);
}

static void *parse_in_a_thread(void *argument)
{
    (void)argument;
    size_t good = 0;
    for (int i = 0; i < 50; i++) {
        cm1e_diag_t own = {0};
        xmlDoc *one = cm1e_xml_parse("<r>\n<a/></r>", 12, &own), *other = cm1e_xml_parse("<r>\n<a></r>", 11, &own);
        good += one && !other && strstr(own.text, "line 2: ") != NULL;
        xmlFreeDoc(one);
        xmlFreeDoc(other);
    }
    return (void *)good;
}

static void test_any_thread_may_read(void)
{
    pthread_t threads[4];
    for (int i = 0; i < 4; i++)
        TEST_ASSERT_EQUAL(0, pthread_create(&threads[i], NULL, parse_in_a_thread, NULL));
    for (int i = 0; i < 4; i++) {
        void *good;
        pthread_join(threads[i], &good);
        TEST_ASSERT_EQUAL_PTR((void *)50, good);
    }
}

static void test_every_prefix_of_a_document_is_refused(void)
{
    static const char whole[] = "\xEF\xBB\xBF<!-- a --><?xml version='1.0' encoding='UTF-8'?>\n<r a='1'>\n"
                                "<b>\xC3\xA9</b>"
                                "<![CDATA[x]]>&amp;<c/></r>";
    need(whole);
    for (size_t size = 0; size < sizeof whole - 1; size++) {
        char *exactly = malloc(size + 1); /* so that a sanitizer sees what is read behind it */
        memcpy(exactly, whole, size);
        char *tight = realloc(exactly, size ? size : 1);
        TEST_ASSERT_NULL(cm1e_xml_parse(tight, size, &diag));
        free(tight);
    }
}

/* ---- what is read ----------------------------------------------------------------------------------------------- */

static void test_numbers(void)
{
    static const struct {
        const char *text;
        bool good;
        int64_t value;
    } numbers[] = {
        {"0", true, 0}, {"26", true, 26}, {"-5", true, -5}, {"+5", true, 5}, {"#x1A", true, 26}, {"#X1a", true, 26},
        {"0x1A", true, 26}, {" \n7\t", true, 7}, {"007", true, 7}, {"-1000", true, -1000}, {"1000", true, 1000},
        {"", false, 0}, {"x", false, 0}, {"1A", false, 0}, {"#x", false, 0}, {"#xG", false, 0}, {"0x", false, 0},
        {"1.5", false, 0}, {"1 2", false, 0}, {"- 5", false, 0}, {"#x-5", false, 0}, {"--5", false, 0},
        {"#5", false, 0},
        {"1001", false, 0}, {"-1001", false, 0}, {"9223372036854775808", false, 0},
        {"99999999999999999999999", false, 0},
        {"#xFFFFFFFFFFFFFFFFF", false, 0}, {"#xFFFFFFFFFFFFFFFF", false, 0}, {"-99999999999999999999999", false, 0},
        {"00000000000000000000000000000000000000000000000000000000000000000000000000000001", false, 0},
    };
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        char text[512];
        snprintf(text, sizeof text, "<r>\n<n>%s</n><m n='%s'/></r>", numbers[i].text, numbers[i].text);
        const xmlNode *root = need(text);
        reader.failed = false;
        diag = (cm1e_diag_t){0};
        const int64_t expected = numbers[i].good ? numbers[i].value : 99;
        TEST_ASSERT_EQUAL_INT64_MESSAGE(expected, cm1e_xml_child_number(&reader, root, "n", -1000, 1000, 99), text);
        TEST_ASSERT_EQUAL_MESSAGE(!numbers[i].good, reader.failed, text);
        TEST_ASSERT_EQUAL_MESSAGE(!numbers[i].good, strncmp(diag.text, "line 2: n is ", 13) == 0, diag.text);
        reader.failed = false;
        TEST_ASSERT_EQUAL_INT64_MESSAGE(
            expected, cm1e_xml_attribute_number(&reader, cm1e_xml_child(root, "m"), "n", -1000, 1000, 99), text);
        TEST_ASSERT_EQUAL_MESSAGE(!numbers[i].good, reader.failed, text);
    }
}

static void test_numbers_with_a_point(void)
{
    double number;
    TEST_ASSERT_TRUE(cm1e_xml_real("-0.25", &number));
    TEST_ASSERT_EQUAL_DOUBLE(-0.25, number);
    TEST_ASSERT_TRUE(cm1e_xml_real("1.5e2", &number));
    TEST_ASSERT_EQUAL_DOUBLE(150, number);
    TEST_ASSERT_FALSE(cm1e_xml_real("1,5", &number));
    TEST_ASSERT_FALSE(cm1e_xml_real("", &number));
    TEST_ASSERT_FALSE(cm1e_xml_real("x", &number));
}

static void test_comment_before_the_root(void)
{
    TEST_ASSERT_EQUAL_STRING("a b", cm1e_xml_comment(&reader, need("<?xml version='1.0'?><!-- a b --><!--c--><r/>")));
    TEST_ASSERT_NULL(cm1e_xml_comment(&reader, need("<r><!-- inside --></r><!-- behind -->")));
    TEST_ASSERT_EQUAL_STRING("", cm1e_xml_comment(&reader, need("<!----><r/>")));
}

static void test_flags(void)
{
    static const struct {
        const char *text;
        int value; /* -1: none */
    } flags[] = {{"1", 1}, {"0", 0}, {"true", 1}, {"FALSE", 0}, {" True ", 1}, {"", -1}, {"2", -1}, {"yes", -1}};
    for (size_t i = 0; i < sizeof flags / sizeof flags[0]; i++) {
        char text[128];
        snprintf(text, sizeof text, "<r f='%s'><f>%s</f></r>", flags[i].text, flags[i].text);
        const xmlNode *root = need(text);
        reader.failed = false;
        TEST_ASSERT_EQUAL_MESSAGE(flags[i].value != 0, cm1e_xml_attribute_flag(&reader, root, "f", true), text);
        TEST_ASSERT_EQUAL_MESSAGE(flags[i].value < 0, reader.failed, text);
        reader.failed = false;
        TEST_ASSERT_EQUAL_MESSAGE(flags[i].value == 1, cm1e_xml_child_flag(&reader, root, "f", false), text);
        TEST_ASSERT_EQUAL_MESSAGE(flags[i].value < 0, reader.failed, text);
    }
}

static void test_hexadecimal_bytes(void)
{
    const xmlNode *root = need("<r><a>01fF 0\nA</a><b/><c>0</c><d>0g</d><e>#x01</e></r>");
    static const uint8_t expected[] = {0x01, 0xFF, 0x0A};
    const cm1e_bytes_t bytes = cm1e_xml_hex(&reader, cm1e_xml_child(root, "a"));
    TEST_ASSERT_EQUAL(3, bytes.size);
    TEST_ASSERT_EQUAL_MEMORY(expected, bytes.data, 3);
    TEST_ASSERT_NULL(cm1e_xml_hex(&reader, cm1e_xml_child(root, "b")).data);
    TEST_ASSERT_NULL(cm1e_xml_hex(&reader, NULL).data);
    TEST_ASSERT_FALSE(reader.failed);
    for (const char *name = "cde"; *name; name++) {
        reader.failed = false;
        TEST_ASSERT_NULL(cm1e_xml_hex(&reader, cm1e_xml_child(root, (char[]){*name, 0})).data);
        TEST_ASSERT_TRUE(reader.failed);
    }
}

static void test_what_is_not_there_has_its_fallback(void)
{
    const xmlNode *root = need("<r><a/></r>");
    TEST_ASSERT_NULL(cm1e_xml_child(root, "b"));
    TEST_ASSERT_NULL(cm1e_xml_child(NULL, "b"));
    TEST_ASSERT_NULL(cm1e_xml_next(NULL, NULL));
    TEST_ASSERT_NULL(cm1e_xml_text(&reader, NULL));
    TEST_ASSERT_NULL(cm1e_xml_attribute(&reader, root, "b"));
    TEST_ASSERT_NULL(cm1e_xml_attribute(&reader, NULL, "b"));
    TEST_ASSERT_EQUAL_STRING("x", cm1e_xml_child_text(&reader, root, "b", "x"));
    TEST_ASSERT_EQUAL_STRING("", cm1e_xml_child_text(&reader, root, "a", "x"));
    TEST_ASSERT_EQUAL(5, cm1e_xml_child_number(&reader, root, "b", 0, 9, 5));
    TEST_ASSERT_EQUAL(5, cm1e_xml_attribute_number(&reader, NULL, "b", 0, 9, 5));
    TEST_ASSERT_TRUE(cm1e_xml_child_flag(&reader, NULL, "b", true));
    TEST_ASSERT_TRUE(cm1e_xml_attribute_flag(&reader, root, "b", true));
    TEST_ASSERT_EQUAL(0, cm1e_xml_line(NULL));
    TEST_ASSERT_NULL(cm1e_xml_need(&reader, NULL, "b"));
    TEST_ASSERT_FALSE(reader.failed);
    TEST_ASSERT_NULL(cm1e_xml_need(&reader, root, "b"));
    TEST_ASSERT_EQUAL_STRING("line 1: <r> has no <b>", diag.text);
}

static void test_elements_are_walked_by_name(void)
{
    const xmlNode *root = need("<r><a>1</a>text<!-- x --><b>2</b><?x y?><a>3</a></r>");
    const xmlNode *a = cm1e_xml_child(root, "a");
    TEST_ASSERT_EQUAL_STRING("1", cm1e_xml_text(&reader, a));
    TEST_ASSERT_EQUAL_STRING("3", cm1e_xml_text(&reader, cm1e_xml_next(a, "a")));
    TEST_ASSERT_EQUAL_STRING("2", cm1e_xml_text(&reader, cm1e_xml_next(a, NULL)));
    TEST_ASSERT_NULL(cm1e_xml_next(cm1e_xml_next(a, "a"), NULL));
}

static void test_first_error_stays(void)
{
    const xmlNode *root = need("<r>\n<a/>\n<b/></r>");
    cm1e_xml_fail(&reader, cm1e_xml_child(root, "a"), "%s", "first");
    cm1e_xml_fail(&reader, cm1e_xml_child(root, "b"), "%s", "second");
    TEST_ASSERT_EQUAL_STRING("line 2: first", diag.text);
    TEST_ASSERT_EQUAL(CM1E_ERROR_FILE, diag.error);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_any_thread_may_read);
    RUN_TEST(test_comment_before_the_declaration_is_passed_over_and_lines_stay_right);
    RUN_TEST(test_comment_where_xml_allows_it_is_no_reason_to_skip);
    RUN_TEST(test_byte_order_mark_says_utf8_whatever_the_declaration_says);
    RUN_TEST(test_other_encodings_become_utf8);
    RUN_TEST(test_cr_lf_and_white_space_do_not_matter);
    RUN_TEST(test_lines_beyond_65535_are_right);
    RUN_TEST(test_hostile_documents_are_refused_with_their_line);
    RUN_TEST(test_depth_is_bounded);
    RUN_TEST(test_number_of_elements_attributes_and_comments_is_bounded);
    RUN_TEST(test_endless_tags_are_refused);
    RUN_TEST(test_size_is_bounded);
    RUN_TEST(test_nothing_is_printed);
    RUN_TEST(test_handler_of_the_application_comes_back);
    RUN_TEST(test_every_prefix_of_a_document_is_refused);
    RUN_TEST(test_numbers);
    RUN_TEST(test_numbers_with_a_point);
    RUN_TEST(test_comment_before_the_root);
    RUN_TEST(test_flags);
    RUN_TEST(test_hexadecimal_bytes);
    RUN_TEST(test_what_is_not_there_has_its_fallback);
    RUN_TEST(test_elements_are_walked_by_name);
    RUN_TEST(test_first_error_stays);
    return UNITY_END();
}
