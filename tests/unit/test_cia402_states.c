#include <stdio.h>
#include <string.h>

#include "cia402/cia402.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

/* UG 6.1.3: state and statusword bits, copied from the manual's table as text. */
static const struct {
    cm1e_fsa_state_t state;
    const char *name, *bits;
} manual[] = {
    {NOT_READY_TO_SWITCH_ON, "Not ready to switch on", "xxxx xxxx x0xx 0000"},
    {SWITCH_ON_DISABLED, "Switch on disabled", "xxxx xxxx x100 0000"},
    {READY_TO_SWITCH_ON, "Ready to switch on", "xxxx xxxx x01x 0001"},
    {SWITCHED_ON, "Switched on", "xxxx xxxx x01x 0011"},
    {OPERATION_ENABLED, "Operation enabled", "xxxx xxxx x01x 0111"},
    {FAULT_REACTION_ACTIVE, "Fault reaction active", "xxxx xxxx x0xx 1111"},
    {FAULT, "Fault", "xxxx xxxx x0xx 1000"},
    {QUICK_STOP_ACTIVE, "Quick stop active", "xxxx xxxx x00x 0111"},
};
enum { ROWS = sizeof manual / sizeof manual[0] };

static bool bits_match(const char *pattern, uint16_t word)
{
    int bit = 15;
    for (const char *p = pattern; *p; p++) {
        if (*p == ' ')
            continue;
        const bool set = (word >> bit) & 1;
        if ((*p == '0' && set) || (*p == '1' && !set))
            return false;
        bit--;
    }
    TEST_ASSERT_EQUAL(-1, bit);
    return true;
}

static void test_every_statusword_decodes_as_the_manual_says(void)
{
    unsigned known = 0;
    for (uint32_t word = 0; word <= 0xFFFF; word++) {
        cm1e_fsa_state_t expected = CM1E_FSA_UNKNOWN;
        int matches = 0;
        for (int i = 0; i < ROWS; i++)
            if (bits_match(manual[i].bits, (uint16_t)word)) {
                expected = manual[i].state;
                matches++;
            }
        TEST_ASSERT_LESS_OR_EQUAL(1, matches);
        if (expected != cm1e_fsa_decode((uint16_t)word)) {
            char text[80];
            snprintf(text, sizeof text, "statusword %04X", (unsigned)word);
            TEST_ASSERT_EQUAL_MESSAGE(expected, cm1e_fsa_decode((uint16_t)word), text);
        }
        known += (unsigned)matches;
    }
    unsigned expected_known = 0;
    for (int i = 0; i < ROWS; i++) {
        unsigned words = 1;
        for (const char *p = manual[i].bits; *p; p++)
            words *= *p == 'x' ? 2 : 1;
        expected_known += words;
    }
    TEST_ASSERT_EQUAL(expected_known, known);
}

static void test_table_is_in_order_of_states_with_the_manuals_names(void)
{
    for (int i = 0; i < CM1E_FSA_STATE_COUNT; i++) {
        TEST_ASSERT_EQUAL(i, cm1e_fsa_table[i].state);
        TEST_ASSERT_EQUAL_HEX16(0, cm1e_fsa_table[i].value & ~cm1e_fsa_table[i].mask);
    }
    for (int i = 0; i < ROWS; i++)
        TEST_ASSERT_EQUAL_STRING(manual[i].name, cm1e_fsa_name(manual[i].state));
}

static void test_name_of_no_state_is_a_text(void)
{
    TEST_ASSERT_EQUAL_STRING("unknown state", cm1e_fsa_name(CM1E_FSA_UNKNOWN));
    TEST_ASSERT_EQUAL_STRING("unknown state", cm1e_fsa_name((cm1e_fsa_state_t)-1));
    TEST_ASSERT_EQUAL_STRING("unknown state", cm1e_fsa_name((cm1e_fsa_state_t)1000));
}

/* BR 6.1.3: bits 6 and 3 ... 0, in the order of the states; there is no quick stop. */
static const int bridge_bits[CM1E_FSA_STATE_COUNT] = {0x00, 0x40, 0x01, 0x03, 0x07, -1, 0x0F, 0x08};

static void test_every_statusword_of_the_bridge_decodes_as_its_guide_says(void)
{
    for (uint32_t word = 0; word <= 0xFFFF; word++) {
        cm1e_fsa_state_t csp = CM1E_FSA_UNKNOWN, cpio = CM1E_FSA_UNKNOWN;
        for (int i = 0; i < CM1E_FSA_STATE_COUNT; i++) {
            if ((int)(word & 0x4F) == bridge_bits[i])
                csp = (cm1e_fsa_state_t)i;
            /* BR 7.1.3: the lower four bits, behind 1100b; 0 is Switch on disabled */
            if (word >> 12 == 0xC && i != NOT_READY_TO_SWITCH_ON && (int)(word & 0x0F) == (bridge_bits[i] & ~0x40))
                cpio = (cm1e_fsa_state_t)i;
        }
        TEST_ASSERT_EQUAL(csp, cm1e_fsa_decode_by(cm1e_fsa_bridge_table, (uint16_t)word));
        TEST_ASSERT_EQUAL(cpio, cm1e_fsa_decode_by(cm1e_fsa_cpio_table, (uint16_t)word));
    }
    for (int i = 0; i < CM1E_FSA_STATE_COUNT; i++) {
        TEST_ASSERT_EQUAL(i, cm1e_fsa_bridge_table[i].state);
        TEST_ASSERT_EQUAL(i, cm1e_fsa_cpio_table[i].state);
    }
}

/* What a drive shows: UG 7.5's screenshot and common values. */
static void test_statuswords_seen_on_drives_decode(void)
{
    TEST_ASSERT_EQUAL(NOT_READY_TO_SWITCH_ON, cm1e_fsa_decode(0x0230));
    TEST_ASSERT_EQUAL(READY_TO_SWITCH_ON, cm1e_fsa_decode(0x0231));
    TEST_ASSERT_EQUAL(SWITCHED_ON, cm1e_fsa_decode(0x0233));
    TEST_ASSERT_EQUAL(OPERATION_ENABLED, cm1e_fsa_decode(0x1637));
    TEST_ASSERT_EQUAL(FAULT, cm1e_fsa_decode(0x0218));
    TEST_ASSERT_EQUAL(CM1E_FSA_UNKNOWN, cm1e_fsa_decode(0xFFFF));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_statusword_decodes_as_the_manual_says);
    RUN_TEST(test_table_is_in_order_of_states_with_the_manuals_names);
    RUN_TEST(test_every_statusword_of_the_bridge_decodes_as_its_guide_says);
    RUN_TEST(test_name_of_no_state_is_a_text);
    RUN_TEST(test_statuswords_seen_on_drives_decode);
    return UNITY_END();
}
