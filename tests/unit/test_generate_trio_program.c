/* The TrioBASIC program beside an EC_EXTEND: no compiler of that language is to be had, so it is read here: blocks that
 * end, labels that are there, words that the sources of docs/TRIO.md have, and no motion before an input. */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cm1e/generate.h"
#include "golden.h"
#include "unity.h"

static cm1e_file_t file;
static cm1e_diag_t diag;

void setUp(void) {}
void tearDown(void) { cm1e_file_free(&file); }

static const char *generate(const cm1e_device_options_t *devices, size_t count)
{
    const cm1e_generate_options_t options = {.format = CM1E_FILE_EC_EXTEND, .devices = devices, .device_count = count};
    cm1e_file_free(&file);
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_generate_trio_program(&file, &options, &diag), diag.text);
    TEST_ASSERT_EQUAL_UINT(strlen((const char *)file.bytes), file.size);
    return (const char *)file.bytes;
}

static const cm1e_device_options_t with_bridge[] = {
    {.mapping = CM1E_MAPPING_CSP},
    {.model = CM1E_DEVICE_EB01, .axes = 3, .vendor_id = 0xAA77, .product_code = 0x1234, .revision = 7}};

/* ---- a reader of TrioBASIC, as far as the program goes ---------------------------------------------------------- */

/* Words of TrioBASIC in the program; each is in UG 11.2.1 or in a source of docs/TRIO.md. */
static const char *const words[] = {
    "ACCEL",   "AND",      "ATYPE",   "AXIS",    "AXISSTATUS",   "BASE",      "DATUM",    "DECEL",  "DEFPOS",
    "DRIVE_CW_MODE", "ELSEIF", "ENDIF", "ERROR_AXIS", "ETHERCAT", "FE_LIMIT", "FOR",      "FS_LIMIT", "GOSUB",
    "IDLE",    "IF",       "IN",      "MOTION_ERROR", "MOVEABS", "NEXT",      "OFFPOS",   "OR",     "PRINT",
    "RAPIDSTOP", "RETURN", "RS_LIMIT", "SERVO",  "SPEED",        "STOP",      "SYSTEM_ERROR", "THEN", "TO",
    "UNITS",   "UNIT_CLEAR", "UNTIL", "VR",      "WA",           "WAIT",      "WDOG",     "WEND",   "WHILE",
};

/* The line without its comment and without what is in quotes; the next line, or NULL. */
static const char *next_line(const char *text, char *line, size_t room)
{
    const char *end = strchr(text, '\n');
    TEST_ASSERT_NOT_NULL_MESSAGE(end, "the last line has no end");
    TEST_ASSERT_LESS_THAN_UINT(room, (unsigned)(end - text));
    size_t n = 0;
    bool quoted = false;
    for (; text < end && (quoted || *text != '\''); text++) {
        quoted = quoted != (*text == '"');
        if (!quoted && *text != '"')
            line[n++] = *text;
    }
    TEST_ASSERT_FALSE_MESSAGE(quoted, "a text without an end");
    line[n] = '\0';
    return end[1] ? end + 1 : NULL;
}

/* The next word of letters, digits and "_" that begins with a letter; NULL: none. Moves `*at` behind it. */
static const char *next_word(const char **at, char *word)
{
    while (**at && !isalpha((unsigned char)**at)) {
        if (**at == '$') /* hexadecimal digits are no word */
            while (isalnum((unsigned char)(*at)[1]))
                (*at)++;
        (*at)++;
    }
    size_t n = 0;
    while (isalnum((unsigned char)**at) || **at == '_')
        word[n++] = *(*at)++;
    word[n] = '\0';
    return n > 0 ? word : NULL;
}

static bool is_keyword(const char *word)
{
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (strcmp(words[i], word) == 0)
            return true;
    return false;
}

static void expect_known_words(const char *program)
{
    char line[256], word[256], mark[300];
    for (const char *at = program; at;) {
        at = next_line(at, line, sizeof line);
        for (const char *in = line; next_word(&in, word);) {
            if (isupper((unsigned char)word[0])) {
                TEST_ASSERT_TRUE_MESSAGE(is_keyword(word), word);
                continue;
            }
            snprintf(mark, sizeof mark, "\n%s = ", word);
            const bool set_at_the_top = strstr(program, mark) != NULL;
            snprintf(mark, sizeof mark, " %s = ", word);
            const bool set = strstr(program, mark) != NULL;
            snprintf(mark, sizeof mark, "\n%s:\n", word);
            TEST_ASSERT_TRUE_MESSAGE(set_at_the_top || set || strstr(program, mark), word);
        }
    }
}

static int count_in(const char *line, const char *what)
{
    int count = 0;
    for (; (line = strstr(line, what)) != NULL; line++)
        count++;
    return count;
}

static void expect_closed_blocks(const char *program)
{
    int ifs = 0, whiles = 0, fors = 0, brackets = 0;
    char line[256];
    for (const char *at = program; at;) {
        at = next_line(at, line, sizeof line);
        size_t length = strlen(line);
        while (length > 0 && line[length - 1] == ' ')
            line[--length] = '\0';
        const bool is_block = length > 5 && strcmp(line + length - 5, " THEN") == 0;
        ifs += (is_block && !strstr(line, "ELSEIF")) - count_in(line, "ENDIF");
        whiles += (strstr(line, "WHILE ") != NULL) - count_in(line, "WEND");
        fors += (strstr(line, "FOR ") != NULL) - count_in(line, "NEXT ");
        for (const char *c = line; *c; c++)
            brackets += (*c == '(') - (*c == ')');
        TEST_ASSERT_EQUAL_INT_MESSAGE(0, brackets, line);
        TEST_ASSERT_TRUE_MESSAGE(ifs >= 0 && whiles >= 0 && fors >= 0, line);
        if (strcmp(line, "RETURN") == 0) /* at the left: the end of a subroutine */
            TEST_ASSERT_TRUE_MESSAGE(ifs == 0 && whiles == 0 && fors == 0, line);
    }
    TEST_ASSERT_EQUAL_INT(0, ifs);
    TEST_ASSERT_EQUAL_INT(0, whiles);
    TEST_ASSERT_EQUAL_INT(0, fors);
    TEST_ASSERT_EQUAL_INT(count_in(program, "\nRETURN"), count_in(program, ":\n    "));
}

/* ---- tests ------------------------------------------------------------------------------------------------------ */

static void test_the_program_reads_as_one(void)
{
    const cm1e_device_options_t one = {0};
    expect_known_words(generate(&one, 1));
    expect_closed_blocks((const char *)file.bytes);
    expect_known_words(generate(with_bridge, 2));
    expect_closed_blocks((const char *)file.bytes);
}

/* What the manual's program says, in its order; each with its mark. */
static void test_the_commands_of_the_manual_are_there(void)
{
    static const char *const set_up[] = {"BASE(axis_no) '[UG]", "DRIVE_CW_MODE = 0 '[UG]", "UNITS = 1 '[UG]",
                                         "ACCEL = ramp_rate '[UG]", "DECEL = ramp_rate '[UG]",
                                         "SPEED = slow_speed '[UG]", "SERVO = 1 '[UG]", "WDOG = 1 '[UG]"};
    static const char *const move[] = {"MOVEABS(target_pos) AXIS(axis_no) '[UG]", "WAIT IDLE AXIS(axis_no) '[UG]"};
    const cm1e_device_options_t one = {0};
    const char *at = strstr(generate(&one, 1), "\nset_up:");
    for (size_t i = 0; i < sizeof set_up / sizeof set_up[0]; i++) {
        at = at ? strstr(at, set_up[i]) : NULL;
        TEST_ASSERT_NOT_NULL_MESSAGE(at, set_up[i]);
    }
    at = strstr((const char *)file.bytes, "\nmove_axes:");
    for (size_t i = 0; i < sizeof move / sizeof move[0]; i++) {
        at = at ? strstr(at, move[i]) : NULL;
        TEST_ASSERT_NOT_NULL_MESSAGE(at, move[i]);
    }
}

/* Nothing moves before the input was seen off and on: moves and enabling are in subroutines, which are called there. */
static void test_nothing_moves_before_the_input(void)
{
    const cm1e_device_options_t one = {0};
    const char *program = generate(&one, 1);
    const char *off = strstr(program, "WAIT UNTIL IN(run_input) = 0");
    const char *on = strstr(program, "ELSEIF IN(run_input) = 1");
    const char *end = strstr(program, "\nSTOP\n");
    TEST_ASSERT_NOT_NULL(off);
    TEST_ASSERT_NOT_NULL(on);
    TEST_ASSERT_TRUE(off < on && on < end);
    TEST_ASSERT_TRUE(strstr(program, "WDOG = 0") < off);
    TEST_ASSERT_TRUE(strstr(program, "WDOG = 1") > strstr(program, "\nset_up:"));
    TEST_ASSERT_TRUE(strstr(program, "MOVEABS(") > strstr(program, "\nmove_axes:"));
    TEST_ASSERT_TRUE(strstr(program, "GOSUB set_up") > on && strstr(program, "GOSUB move_axes") > on);
    TEST_ASSERT_EQUAL_INT(1, count_in(program, "WDOG = 1"));
    TEST_ASSERT_EQUAL_INT(1, count_in(program, "MOVEABS("));
    TEST_ASSERT_EQUAL_INT(1, count_in(program, "GOSUB set_up"));
    /* And limits are there before the motors are enabled. */
    TEST_ASSERT_TRUE(strstr(program, "FE_LIMIT = ") < strstr(program, "WDOG = 1"));
    TEST_ASSERT_TRUE(strstr(program, "FS_LIMIT = ") < strstr(program, "WDOG = 1"));
    TEST_ASSERT_TRUE(strstr(program, "RS_LIMIT = ") < strstr(program, "WDOG = 1"));
}

static void test_axes_are_those_of_all_devices(void)
{
    const cm1e_device_options_t one = {0};
    TEST_ASSERT_NOT_NULL(strstr(generate(&one, 1), "\nlast_axis = 0 "));
    TEST_ASSERT_NULL(strstr((const char *)file.bytes, "K37"));
    TEST_ASSERT_NOT_NULL(strstr(generate(NULL, 0), "\nlast_axis = 0 "));
    TEST_ASSERT_NOT_NULL(strstr(generate(with_bridge, 2), "\nlast_axis = 3 "));
    TEST_ASSERT_NOT_NULL(strstr((const char *)file.bytes, "EB01, revision 0x00000007: 3 axes\n"));
    TEST_ASSERT_NOT_NULL(strstr((const char *)file.bytes, "K37"));
    TEST_ASSERT_NOT_NULL(strstr(file.warning, "uncoupled"));
}

static void test_golden_files(void)
{
    const cm1e_device_options_t one = {0};
    generate(&one, 1);
    golden_compare("trio_program.bas", file.bytes, file.size);
    generate(with_bridge, 2);
    golden_compare("trio_program_with_bridge.bas", file.bytes, file.size);
}

static void expect_refused(const cm1e_device_options_t *devices, size_t count, const char *part)
{
    const cm1e_generate_options_t options = {.format = CM1E_FILE_EC_EXTEND, .devices = devices, .device_count = count};
    TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, cm1e_generate_trio_program(&file, &options, &diag));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, part), diag.text);
    TEST_ASSERT_NULL(file.bytes);
    TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, cm1e_generate_trio_program(&file, &options, NULL));
}

static void test_what_no_program_can_move_is_refused(void)
{
    const cm1e_device_options_t csv = {.mapping = CM1E_MAPPING_CSV}, profile = {.mapping = CM1E_MAPPING_PROFILE};
    const cm1e_device_options_t wrong = {.firmware = "7"};
    const cm1e_device_options_t second[] = {{.firmware = "1.2.0"}, {.mapping = CM1E_MAPPING_CSV}};
    expect_refused(&csv, 1, "gains");
    expect_refused(&profile, 1, "by itself");
    expect_refused(second, 2, "device 2");
    expect_refused(&wrong, 1, "no firmware");
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_program_reads_as_one);
    RUN_TEST(test_the_commands_of_the_manual_are_there);
    RUN_TEST(test_nothing_moves_before_the_input);
    RUN_TEST(test_axes_are_those_of_all_devices);
    RUN_TEST(test_golden_files);
    RUN_TEST(test_what_no_program_can_move_is_refused);
    return UNITY_END();
}
