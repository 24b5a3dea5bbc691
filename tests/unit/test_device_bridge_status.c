#include <stdio.h>
#include <string.h>

#include "device/bridge_status.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

static char text[CM1E_BRIDGE_STATUS_TEXT];
static const char *words(cm1e_bridge_motor_t motor, uint32_t status)
{
    return cm1e_bridge_status_text(motor, status, text, sizeof text);
}

/* ---- BR 7.4, typed off the guide with its patterns -------------------------------------------------------------- */

enum { ERROR = 1, MOVING = 2 };
typedef struct pattern {
    const char *bits; /* 7 ... 0 */
    const char *name;
    int is;
} pattern_t;

static const pattern_t cm1[] = {
    {"00000xx1", "counter overflow", ERROR},
    {"00000x1x", "over speed or regenerative current", ERROR},
    {"000001xx", "overload", ERROR},
    {"00001111", "serial communication error", ERROR},
    {"00000000", "running", MOVING},
    {"00001000", "in position", 0},
    {"00010000", "motor free", 0},
    {"00100000", "in push mode", MOVING},
    {"00101000", "end of push mode", 0},
    {"10000000", "temperature alarm", ERROR},
    {0},
};
static const pattern_t cm2[] = {
    {"00000xx1", "position error overflow", ERROR},
    {"00000x1x", "over speed or regenerative voltage", ERROR},
    {"000001xx", "overload", ERROR},
    {"00001111", "serial communication error", ERROR},
    {"00000000", "running", MOVING},
    {"00001000", "in position", 0},
    {"00010000", "motor free", 0},
    {"00100000", "in push motion", MOVING},
    {"00101000", "push motion completed", 0},
    {"01000000", "power module over-current", ERROR},
    {"10000000", "temperature alarm", ERROR},
    {0},
};
static const pattern_t *table_of(cm1e_bridge_motor_t motor) { return motor == CM1E_BRIDGE_CM1 ? cm1 : cm2; }

static bool fits(const pattern_t *pattern, unsigned status)
{
    for (int i = 0; i < 8; i++)
        if (pattern->bits[i] != 'x' && pattern->bits[i] - '0' != (int)(status >> (7 - i) & 1))
            return false;
    return true;
}

static int predicates(cm1e_bridge_motor_t motor, uint32_t status)
{
    return (cm1e_bridge_status_is_error(motor, status) ? ERROR : 0) |
           (cm1e_bridge_status_is_moving(motor, status) ? MOVING : 0);
}

/* Of all values those that the guide lists, with the names of every pattern that fits and of no other. */
static int check_listed(cm1e_bridge_motor_t motor, unsigned status)
{
    char expected[CM1E_BRIDGE_STATUS_TEXT] = "";
    int is = 0, found = 0;
    for (const pattern_t *pattern = table_of(motor); pattern->bits; pattern++)
        if (fits(pattern, status)) {
            strcat(strcat(expected, found++ ? ", " : ""), pattern->name);
            is |= pattern->is;
        }
    if (found) {
        TEST_ASSERT_EQUAL_STRING_MESSAGE(expected, words(motor, status), expected);
        TEST_ASSERT_EQUAL_HEX_MESSAGE(is, predicates(motor, status), expected);
        TEST_ASSERT_EQUAL_MESSAGE((is & ERROR) != 0, cm1e_bridge_status_cure(motor, status)[0] != 0, expected);
    }
    return found > 0;
}

static void test_every_value_of_the_guide_has_its_names(void)
{
    int listed = 0;
    for (unsigned status = 0; status < 256; status++)
        listed += check_listed(CM1E_BRIDGE_CM1, status) + check_listed(CM1E_BRIDGE_CM2, status);
    TEST_ASSERT_EQUAL(14 + 15, listed); /* 7 combinations of errors, and the other rows */
}

static bool is_listed(cm1e_bridge_motor_t motor, unsigned status)
{
    for (const pattern_t *pattern = table_of(motor); pattern->bits; pattern++)
        if (fits(pattern, status))
            return true;
    return false;
}

/* The rest is said to be unlisted, and each of its bits is named: by its row, or as unknown. */
static void check_unlisted(cm1e_bridge_motor_t motor, unsigned status)
{
    char number[40];
    snprintf(number, sizeof number, "(0x%02X is not listed in the guide)", status);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(words(motor, status), number), text);
    TEST_ASSERT_LESS_THAN_MESSAGE(sizeof text - 1, strlen(text), text);
    for (const pattern_t *pattern = table_of(motor); pattern->bits; pattern++) {
        unsigned bits = 0;
        for (int i = 0; i < 8; i++)
            bits = bits << 1 | (pattern->bits[i] == '1');
        const bool single = bits && (bits & (bits - 1)) == 0;
        const bool in_serial = (status & 0x0F) == 0x0F && bits <= 0x08;
        const bool in_push = (status & 0x28) == 0x28 && (bits == 0x08 || bits == 0x20) && (status & 0x0F) != 0x0F;
        if (single && !in_serial && !in_push)
            TEST_ASSERT_EQUAL_MESSAGE((status & bits) != 0, strstr(text, pattern->name) != NULL, text);
    }
    TEST_ASSERT_EQUAL_MESSAGE((status & 0x0F) == 0x0F, strstr(text, "serial communication error") != NULL, text);
    const bool unknown = motor == CM1E_BRIDGE_CM1 && (status & 0x40);
    TEST_ASSERT_EQUAL_MESSAGE(unknown, strstr(text, "unknown bits 0x40") != NULL, text);
    /* never taken for harmless: an error bit, or one that nobody knows */
    TEST_ASSERT_EQUAL_MESSAGE((status & 0xC7) != 0, cm1e_bridge_status_is_error(motor, status), text);
    if (status & 0xC7)
        TEST_ASSERT_TRUE_MESSAGE(cm1e_bridge_status_cure(motor, status)[0], text);
    TEST_ASSERT_FALSE_MESSAGE(cm1e_bridge_status_is_moving(motor, status) && (status & 0xDF), text);
}

static void test_every_other_value_is_named_as_unlisted(void)
{
    for (unsigned status = 0; status < 256; status++)
        for (cm1e_bridge_motor_t motor = CM1E_BRIDGE_CM1; motor <= CM1E_BRIDGE_CM2; motor++)
            if (!is_listed(motor, status))
                check_unlisted(motor, status);
    TEST_ASSERT_EQUAL_STRING("motor free, unknown bits 0x40 (0x50 is not listed in the guide)",
                             words(CM1E_BRIDGE_CM1, 0x50));
    TEST_ASSERT_EQUAL_STRING("motor free, power module over-current (0x50 is not listed in the guide)",
                             words(CM1E_BRIDGE_CM2, 0x50));
}

/* "Bit 8 ~ 31 are fixed data (0)" */
static void test_bits_above_the_eighth_are_unknown_ones(void)
{
    TEST_ASSERT_EQUAL_STRING("in position, unknown bits 0x100 (0x108 is not listed in the guide)",
                             words(CM1E_BRIDGE_CM2, 0x108));
    TEST_ASSERT_EQUAL_STRING("unknown bits 0x80000000 (0x80000000 is not listed in the guide)",
                             words(CM1E_BRIDGE_CM1, 0x80000000u));
    TEST_ASSERT_EQUAL_HEX(ERROR, predicates(CM1E_BRIDGE_CM2, 0x108));
    TEST_ASSERT_LESS_THAN(sizeof text - 1, strlen(words(CM1E_BRIDGE_CM1, 0xFFFFFFF7u)));
}

static void test_text_in_too_little_room_is_cut(void)
{
    char small[16];
    for (size_t size = 1; size <= sizeof small; size++) {
        memset(small, '#', sizeof small);
        cm1e_bridge_status_text(CM1E_BRIDGE_CM1, 0xD7, small, size);
        TEST_ASSERT_EQUAL(size - 1, strlen(small));
        TEST_ASSERT_EQUAL_INT(0, memcmp("counter overflow", small, size - 1));
    }
}

/* BR 7.3: codes 1 to 5 are "N/A" */
static void test_only_one_baud_rate_is_known(void)
{
    for (uint32_t code = 0; code < 300; code++)
        TEST_ASSERT_EQUAL(code == 6 ? 176800 : 0, cm1e_bridge_bits_per_second(code));
}

/* BR 6 */
static void test_five_modes_have_names(void)
{
    static const struct {
        int8_t mode;
        const char *name;
    } modes[] = {{6, "hm"}, {8, "csp"}, {101, "CML"}, {120, "CMD"}, {121, "CPIO"}};
    int named = 0;
    for (int mode = INT8_MIN; mode <= INT8_MAX; mode++)
        named += cm1e_bridge_mode_name((int8_t)mode) != NULL;
    TEST_ASSERT_EQUAL(5, named);
    for (int i = 0; i < 5; i++)
        TEST_ASSERT_EQUAL_STRING(modes[i].name, cm1e_bridge_mode_name(modes[i].mode));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_value_of_the_guide_has_its_names);
    RUN_TEST(test_every_other_value_is_named_as_unlisted);
    RUN_TEST(test_bits_above_the_eighth_are_unknown_ones);
    RUN_TEST(test_text_in_too_little_room_is_cut);
    RUN_TEST(test_only_one_baud_rate_is_known);
    RUN_TEST(test_five_modes_have_names);
    return UNITY_END();
}
