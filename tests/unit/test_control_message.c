/* Messages of the control socket: every cut, every length, and bytes that are none. */
#include <stdlib.h>
#include <string.h>

#include <unity.h>

#include "../support/chance.h"
#include "control/message.h"

static char why[JSON_ERROR_TEXT_LENGTH];
static json_t *message;
static size_t used;

void setUp(void) { used = 77; }

void tearDown(void)
{
    json_decref(message);
    message = NULL;
}

static cm1e_message_state_t read_from(const void *bytes, size_t length)
{
    return cm1e_message_read(bytes, length, CM1E_REQUEST_MAX, &message, &used, why);
}

static void test_what_is_written_is_read(void)
{
    size_t length;
    uint8_t *bytes = cm1e_message_write(json_pack("{s:s, s:i}", "request", "hello", "id", 5), &length);
    TEST_ASSERT_NOT_NULL(bytes);
    TEST_ASSERT_EQUAL_HEX8(0, bytes[0]);
    TEST_ASSERT_EQUAL_HEX8(length - 4, bytes[3]); /* most significant byte first */
    for (size_t part = 0; part < length; part++) {
        TEST_ASSERT_EQUAL_INT(CM1E_MESSAGE_PART, read_from(bytes, part));
        TEST_ASSERT_NULL(message);
    }
    TEST_ASSERT_EQUAL_INT(CM1E_MESSAGE_WHOLE, read_from(bytes, length));
    TEST_ASSERT_EQUAL_size_t(length, used);
    TEST_ASSERT_EQUAL_STRING("hello", json_string_value(json_object_get(message, "request")));
    free(bytes);
}

static void test_a_length_beyond_the_limit_is_refused_at_once(void)
{
    static const uint8_t lengths[][4] = {{0, 1, 0, 1}, {0x7F, 0xFF, 0xFF, 0xFF}, {0xFF, 0xFF, 0xFF, 0xFF},
                                         {0, 2, 0, 0}};
    for (size_t i = 0; i < sizeof lengths / sizeof *lengths; i++)
        TEST_ASSERT_EQUAL_INT(CM1E_MESSAGE_TOO_LONG, read_from(lengths[i], 4));
    TEST_ASSERT_EQUAL_INT(CM1E_MESSAGE_PART, read_from((const uint8_t[]){0, 1, 0, 0}, 4));
    TEST_ASSERT_NULL(cm1e_message_write(NULL, &used));
}

static void test_what_is_no_object_is_named_and_skipped(void)
{
    static const char *const wrong[] = {"", "{", "[]", "5", "null", "{} {}", "{\"a\": 1, \"a\": 2}", "\"\xff\"",
                                        "{'a': 1}"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        uint8_t bytes[64] = {0, 0, 0, (uint8_t)strlen(wrong[i])};
        strcpy((char *)bytes + 4, wrong[i]);
        why[0] = 0;
        TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_MESSAGE_NOT_JSON, read_from(bytes, 4 + strlen(wrong[i])), wrong[i]);
        TEST_ASSERT_EQUAL_size_t(4 + strlen(wrong[i]), used);
        TEST_ASSERT_NOT_EQUAL_MESSAGE(0, why[0], wrong[i]);
        TEST_ASSERT_NULL(message);
    }
}

/** 16 levels are read, the object among them; what is within texts is none. Each level of a library needs stack. */
static void test_what_is_too_deep_is_refused(void)
{
    enum { MOST = 15 };
    static const struct {
        const char *open, *close;
        unsigned levels;
        cm1e_message_state_t state;
    } rows[] = {
        {"[", "]", MOST, CM1E_MESSAGE_WHOLE}, {"[", "]", MOST + 1, CM1E_MESSAGE_NOT_JSON},
        {"[", "]", 30000, CM1E_MESSAGE_NOT_JSON}, {"{\"a\":", "}", 9000, CM1E_MESSAGE_NOT_JSON},
        {"[[],", "]", MOST - 1, CM1E_MESSAGE_WHOLE}, {"\"[[[[[[[[[[[[[[[[[[[[\\\"[[[[[[[[", "\"", 1, CM1E_MESSAGE_WHOLE},
    };
    static uint8_t bytes[CM1E_MESSAGE_HEADER + CM1E_REQUEST_MAX + 1];
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char *text = (char *)bytes + CM1E_MESSAGE_HEADER;
        size_t length = (size_t)sprintf(text, "{\"a\":");
        for (unsigned level = 0; level < rows[i].levels; level++)
            length += (size_t)sprintf(text + length, "%s", rows[i].open);
        if (rows[i].levels > 1) /* what the innermost one has */
            length += (size_t)sprintf(text + length, "1");
        for (unsigned level = 0; level < rows[i].levels; level++)
            length += (size_t)sprintf(text + length, "%s", rows[i].close);
        length += (size_t)sprintf(text + length, "}");
        memcpy(bytes, (uint8_t[]){0, 0, (uint8_t)(length >> 8), (uint8_t)length}, CM1E_MESSAGE_HEADER);
        TEST_ASSERT_EQUAL_INT_MESSAGE(rows[i].state, read_from(bytes, CM1E_MESSAGE_HEADER + length), why);
        if (rows[i].state == CM1E_MESSAGE_NOT_JSON)
            TEST_ASSERT_NOT_NULL_MESSAGE(strstr(why, "more than 16 deep"), why);
        json_decref(message);
        message = NULL;
    }
}

static void test_random_bytes_do_no_harm(void)
{
    chance_seed(1);
    for (int i = 0; i < 20000; i++) {
        uint8_t bytes[256];
        const size_t length = 4 + (size_t)pick(sizeof bytes - 4);
        for (size_t b = 0; b < length; b++)
            bytes[b] = (uint8_t)(b < 3 ? 0 : !one_in(3) ? "{}[]\":,a0 \\u"[pick(12)] : pick(256));
        bytes[3] = (uint8_t)pick((int)length);
        if (read_from(bytes, length) == CM1E_MESSAGE_WHOLE)
            TEST_ASSERT_TRUE(json_is_object(message));
        json_decref(message);
        message = NULL;
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_what_is_written_is_read);
    RUN_TEST(test_a_length_beyond_the_limit_is_refused_at_once);
    RUN_TEST(test_what_is_no_object_is_named_and_skipped);
    RUN_TEST(test_what_is_too_deep_is_refused);
    RUN_TEST(test_random_bytes_do_no_harm);
    return UNITY_END();
}
