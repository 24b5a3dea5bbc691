/* CML strings and answers (BR 7.2, appendix 2): what each can do, what can be sent, what came back. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unity.h>

#include "chance.h"
#include "device/cml_command.h"

void setUp(void) {}
void tearDown(void) {}

/* ---- what a string can do ---------------------------------------------------------------------------------------- */

static void test_strings_have_the_kind_of_their_strongest_command(void)
{
    static const struct {
        const char *text;
        cm1e_cml_kind_t kind;
    } strings[] = {
        {"?99.1", CM1E_CML_QUERY}, {"?99", CM1E_CML_QUERY}, {"?90.4", CM1E_CML_QUERY}, {"?1000", CM1E_CML_QUERY},
        {"K53.1", CM1E_CML_QUERY}, {"K37", CM1E_CML_QUERY}, {"K53.1,K54.1,?96.1", CM1E_CML_QUERY},
        {"K53.1=100", CM1E_CML_PARAMETER}, {"K53=-100", CM1E_CML_PARAMETER}, {"?99.1,K53.1=1", CM1E_CML_PARAMETER},
        {"K25=1", CM1E_CML_PARAMETER}, {"K33=1", CM1E_CML_PARAMETER}, {"K38.1=1", CM1E_CML_PARAMETER},
        {"O1.1,O2.1,F3.1,O4.1", CM1E_CML_OUTPUT}, {"O2", CM1E_CML_OUTPUT}, {"K53.1=1,O2.1", CM1E_CML_OUTPUT},
        /* inputs that start something, pulses, resolution */
        {"K26=1", CM1E_CML_MOTION}, {"K27.1=3", CM1E_CML_MOTION}, {"K32.1=6", CM1E_CML_MOTION},
        {"K36.1=2", CM1E_CML_MOTION}, {"K37.1=30", CM1E_CML_MOTION}, {"K53.1=1,K37.1=3", CM1E_CML_MOTION},
        /* what Myostat's quick reference and BR appendix 2.4 have */
        {"|.1", CM1E_CML_MOTION}, {"(.1", CM1E_CML_MOTION}, {").1", CM1E_CML_MOTION}, {"^.1", CM1E_CML_MOTION},
        {"].1", CM1E_CML_MOTION}, {"[1.1", CM1E_CML_MOTION}, {"P.1=100", CM1E_CML_MOTION},
        {"S1.1=100", CM1E_CML_MOTION},
        {"*", CM1E_CML_MOTION}, {"|2.1", CM1E_CML_MOTION}, {"B1.1,A1.1,S1.1,P1.1", CM1E_CML_MOTION},
        {"?99.1,^.1", CM1E_CML_MOTION}, {"K53.1,|.1,K54.1", CM1E_CML_MOTION},
        /* nearly harmless is not known */
        {"k53.1", CM1E_CML_MOTION}, {"?99=1", CM1E_CML_MOTION}, {"?", CM1E_CML_MOTION}, {"O5.1", CM1E_CML_MOTION},
        {"O0", CM1E_CML_MOTION}, {"O2=1", CM1E_CML_MOTION}, {"K53.1 =100", CM1E_CML_MOTION},
        {"K53.1=1x", CM1E_CML_MOTION},
        {"K53.1.1", CM1E_CML_MOTION}, {"K53^", CM1E_CML_MOTION}, {" K53", CM1E_CML_MOTION}, {"K53.", CM1E_CML_MOTION},
        {"K53=", CM1E_CML_MOTION}, {"K53=-", CM1E_CML_MOTION}, {"K53=99999999999", CM1E_CML_MOTION},
        {"K4294967349", CM1E_CML_MOTION}, {"K53.4294967297", CM1E_CML_MOTION}, {",", CM1E_CML_MOTION},
        {"", CM1E_CML_MOTION},
    };
    for (size_t i = 0; i < sizeof strings / sizeof *strings; i++)
        TEST_ASSERT_EQUAL_MESSAGE(strings[i].kind, cm1e_cml_kind(strings[i].text), strings[i].text);
}

static void test_every_other_sign_may_move_the_motor(void)
{
    for (int sign = 1; sign < 128; sign++)
        for (int form = 0; form < 4; form++) {
            char text[16];
            snprintf(text, sizeof text, (const char *[]){"%c", "%c1", "%c1.1", "%c1.1=5"}[form], sign);
            if (sign != ',' && sign != 'K' && sign != '?' && sign != 'O' && sign != 'F')
                TEST_ASSERT_EQUAL_MESSAGE(CM1E_CML_MOTION, cm1e_cml_kind(text), text);
        }
}

/* ---- what can be sent -------------------------------------------------------------------------------------------- */

static void test_what_can_be_sent_and_what_not(void)
{
    static const struct {
        const char *text, *wrong; /* a part of the sentence; NULL: good */
    } strings[] = {
        {"?99.2", NULL}, {"?99", NULL}, {"O1.2,O2.2,F3.2,O4.2", NULL}, {"(.2", NULL}, {"|.2", NULL}, {"*", NULL},
        {"K53.2=100", NULL}, {"K53=-1", NULL},
        {"1234567890123456789012345678901234567890123456789012345678901234", NULL},
        {"", "is empty"}, {"12345678901234567890123456789012345678901234567890123456789012345", "64"},
        {"K53.2\r\n", "CR or LF"}, {"K53\n", "CR or LF"}, {"K53.2\t", "printable"}, {"K53\x80", "printable"},
        {"\x1b[2J", "printable"}, {"K53,", "commas"}, {",K53", "commas"}, {"K53,,K54", "commas"}, {",", "commas"},
        {"K53.2=", "cut off"}, {"K53.", "cut off"}, {"K", "cut off"}, {"?", "cut off"}, {"K53.2=-", "cut off"},
        {"?99.2,O", "cut off"}, {"?99.1", "another motor"}, {"?99.3", "another motor"}, {"K53.20=1", "another motor"},
        {"?99.2,O2.1", "another motor"}, {"(.1", "another motor"},
    };
    for (size_t i = 0; i < sizeof strings / sizeof *strings; i++) {
        const char *wrong = cm1e_cml_check(strings[i].text, 2);
        TEST_ASSERT_MESSAGE(!wrong == !strings[i].wrong, strings[i].text);
        TEST_ASSERT_MESSAGE(!wrong || strstr(wrong, strings[i].wrong), wrong);
    }
}

static void test_commands_say_what_answers_them(void)
{
    static const struct {
        const char *text;
        cm1e_cml_reply_t reply;
    } commands[] = {
        {"K53.1", CM1E_CML_ONE_LINE}, {"?99.1", CM1E_CML_ONE_LINE}, {"?96.1", CM1E_CML_ONE_LINE},
        {"?90.1", CM1E_CML_LIST}, {"?97.1", CM1E_CML_LIST}, {"?1000", CM1E_CML_LIST}, {"K53.1=1", CM1E_CML_SILENT},
        {"K37.1=1", CM1E_CML_SILENT}, {"O2.1", CM1E_CML_SILENT}, {"F2.1", CM1E_CML_SILENT}, {"|.1", CM1E_CML_SEARCH},
        {"(.1", CM1E_CML_SILENT}, {").1", CM1E_CML_SILENT}, {"^.1", CM1E_CML_UNKNOWN}, {"%87", CM1E_CML_UNKNOWN},
        {"|2.1", CM1E_CML_UNKNOWN}, {"K", CM1E_CML_UNKNOWN}, {"bad text", CM1E_CML_UNKNOWN},
    };
    for (size_t i = 0; i < sizeof commands / sizeof *commands; i++) {
        const char *at = commands[i].text;
        TEST_ASSERT_EQUAL_MESSAGE(commands[i].reply, cm1e_cml_next(&at).reply, commands[i].text);
        TEST_ASSERT_NULL(at);
    }
}

/* ---- what comes back --------------------------------------------------------------------------------------------- */

static void test_answers_are_read(void)
{
    static const struct {
        const char *line;
        cm1e_cml_answer_t answer;
    } lines[] = {
        {"K53.1=100\r\n", {CM1E_CML_K, "K", 53, 1, 100}}, {"K53.1=-7\r", {CM1E_CML_K, "K", 53, 1, -7}},
        {"K99.4=2147483647\n", {CM1E_CML_K, "K", 99, 4, INT32_MAX}},
        {"K21.4=-2147483648\r\n", {CM1E_CML_K, "K", 21, 4, INT32_MIN}},
        {"Ux.1=8\r\n", {CM1E_CML_STATUS, "Ux", 0, 1, 8}},
        {"Origin.3=12\r\n", {CM1E_CML_ORIGIN, "Origin", 0, 3, 12}}, {"Px.1=-5\r\n", {CM1E_CML_VALUE, "Px", 0, 1, -5}},
        {"Null\r\n", {.what = CM1E_CML_NOTHING}}, {"NULL\r\n", {.what = CM1E_CML_NOTHING}},
        {"null", {.what = CM1E_CML_NOTHING}}, {"\r\n", {.what = CM1E_CML_NOTHING}}, {"", {.what = CM1E_CML_NOTHING}},
        {"Nullx\r\n", {.what = CM1E_CML_TEXT}}, {"S1.1,P1.1\r\n", {.what = CM1E_CML_TEXT}},
        {"Ready\r\n", {.what = CM1E_CML_TEXT}}, {"S1.1=4\r\n", {.what = CM1E_CML_TEXT}},
    };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        cm1e_cml_answer_t answer;
        const char *line = lines[i].line;
        TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_cml_parse(&answer, line, strlen(line)), line);
        TEST_ASSERT_EQUAL_MESSAGE(lines[i].answer.what, answer.what, lines[i].line);
        TEST_ASSERT_EQUAL_STRING(lines[i].answer.name, answer.name);
        TEST_ASSERT_EQUAL(lines[i].answer.number, answer.number);
        TEST_ASSERT_EQUAL(lines[i].answer.id, answer.id);
        TEST_ASSERT_EQUAL(lines[i].answer.value, answer.value);
    }
}

static void test_what_is_behind_a_final_0_does_not_count(void)
{
    cm1e_cml_answer_t answer;
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_cml_parse(&answer, "K53.1=9\r\n\0rubbish", 17));
    TEST_ASSERT_EQUAL(9, answer.value);
}

static void test_damaged_answers_are_errors(void)
{
    static const char *const lines[] = {
        "K53.1=100", "K53.1=10", "Ux.1=8", "K53.1=1\x01" "0\r\n", "K53.1=1\xff\r\n", "K53.1=\r\n", "K53.1\r\n",
        "K53.=1\r\n",
        "K53=1\r\n", "K53.1=1.5\r\n", "K53.1=2147483648\r\n", "K53.1=99999999999\r\n", "K53.5=1\r\n", "K53.0=1\r\n",
        "K53.11=1\r\n", "Ux.1=\r\n", "Ux.9=8\r\n", "Origin.1=x\r\n", "K53.1=1\r\nK54.1=1\r\n", "K53.1=1 \r\n",
        "K1234567890.1=1\r\n", "Ux.1=8\rx", "Nul", "N",
        "1234567890123456789012345678901234567890123456789012345678901234\r\n",
    };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        cm1e_cml_answer_t answer;
        const cm1e_error_t error = cm1e_cml_parse(&answer, lines[i], strlen(lines[i]));
        TEST_ASSERT_EQUAL_MESSAGE(CM1E_ERROR_CML_ANSWER, error, lines[i]);
    }
}

/* Whatever was cut from, changed in or put into a good answer: no byte beyond it is looked at (the copy ends where it
 * ends), and what is called good has a value that stands there. */
static void test_random_damage_is_never_read_beyond_its_end(void)
{
    static const char *const good[] = {"K53.1=100\r\n", "Ux.1=8\r\n", "Origin.1=-20\r\n", "Null\r\n", "Px.1=7\r\n"};
    for (int run = 0; run < seed_count(50000); run++) {
        char line[80];
        chance_seed(seed_of(run));
        const char *text = good[pick(5)];
        size_t size = strlen(text);
        memcpy(line, text, size);
        for (int n = pick(4); n > 0; n--)
            line[pick((int)size)] = (char)pick(256);
        if (one_in(3))
            size = (size_t)pick((int)size + 1);
        char *copy = malloc(size ? size : 1);
        memcpy(copy, line, size);
        cm1e_cml_answer_t answer;
        if (cm1e_cml_parse(&answer, copy, size) == CM1E_OK && answer.what == CM1E_CML_K) {
            char again[80], because[24];
            const size_t length = (size_t)snprintf(again, sizeof again, "=%d", answer.value);
            snprintf(because, sizeof because, "seed %u", seed_of(run));
            TEST_ASSERT_TRUE_MESSAGE(answer.id >= 1 && answer.id <= 4, because);
            TEST_ASSERT_TRUE_MESSAGE(length < size && line[0] == 'K', because);
        }
        free(copy);
    }
}

static void test_an_answer_to_another_query_is_not_taken(void)
{
    static const struct {
        const char *command, *line;
        bool answers;
    } pairs[] = {
        {"K53.1", "K53.1=1\r\n", true},   {"K53.1", "K54.1=1\r\n", false},   {"K53.1", "Ux.1=8\r\n", false},
        {"?99.1", "Ux.1=8\r\n", true},    {"?99.1", "K99.1=8\r\n", false},   {"?99.1", "Px.1=8\r\n", false},
        {"?96.1", "Px.1=8\r\n", true},    {"?96.1", "Ux.1=8\r\n", false},    {"|.1", "Origin.1=0\r\n", true},
        {"|.1", "Ux.1=1\r\n", true},      {"|.1", "K53.1=1\r\n", false},     {"K53.1=1", "K53.1=1\r\n", false},
        {"?90.1", "K21.1=1\r\n", true},   {"?90.1", "Null\r\n", false},      {"^.1", "Ux.1=0\r\n", true},
        {"O2.1", "Ux.1=8\r\n", false},    {"K53.1", "Ready\r\n", false},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        const char *at = pairs[i].command;
        const cm1e_cml_command_t command = cm1e_cml_next(&at);
        cm1e_cml_answer_t answer;
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_cml_parse(&answer, pairs[i].line, strlen(pairs[i].line)));
        TEST_ASSERT_EQUAL_MESSAGE(pairs[i].answers, cm1e_cml_answers(&command, &answer), pairs[i].command);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_strings_have_the_kind_of_their_strongest_command);
    RUN_TEST(test_every_other_sign_may_move_the_motor);
    RUN_TEST(test_what_can_be_sent_and_what_not);
    RUN_TEST(test_commands_say_what_answers_them);
    RUN_TEST(test_answers_are_read);
    RUN_TEST(test_what_is_behind_a_final_0_does_not_count);
    RUN_TEST(test_damaged_answers_are_errors);
    RUN_TEST(test_random_damage_is_never_read_beyond_its_end);
    RUN_TEST(test_an_answer_to_another_query_is_not_taken);
    return UNITY_END();
}
