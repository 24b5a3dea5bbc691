#include <stdio.h>
#include <string.h>

#include "cia402/cia402.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

static bool bit(uint32_t word, int number) { return (word >> number) & 1; }

/* CiA 402's command table without the quick stop bit, which the drive ignores (UG 6.1.2). */
static cm1e_fsa_command_t command_of(uint32_t controlword)
{
    const bool switch_on = bit(controlword, 0), enable_voltage = bit(controlword, 1);
    const bool enable_operation = bit(controlword, 3), fault_reset = bit(controlword, 7);
    if (fault_reset)
        return COMMAND_FAULT_RESET;
    if (!enable_voltage)
        return COMMAND_DISABLE_VOLTAGE;
    if (!switch_on)
        return COMMAND_SHUTDOWN;
    return enable_operation ? COMMAND_ENABLE_OPERATION : COMMAND_SWITCH_ON;
}

static cm1e_fsa_command_t decode(uint16_t controlword)
{
    cm1e_fsa_command_t found = CM1E_FSA_COMMAND_COUNT;
    for (int i = 0; i < CM1E_FSA_COMMAND_COUNT; i++)
        if ((controlword & cm1e_fsa_commands[i].mask) == cm1e_fsa_commands[i].value) {
            TEST_ASSERT_EQUAL_MESSAGE(CM1E_FSA_COMMAND_COUNT, found, "two commands in one controlword");
            found = cm1e_fsa_commands[i].command;
        }
    return found;
}

static void test_every_controlword_is_exactly_one_command(void)
{
    for (uint32_t word = 0; word <= 0xFFFF; word++)
        if (decode((uint16_t)word) != command_of(word)) {
            char text[40];
            snprintf(text, sizeof text, "controlword %04X", (unsigned)word);
            TEST_ASSERT_EQUAL_MESSAGE(command_of(word), decode((uint16_t)word), text);
        }
}

static void test_commands_are_sent_with_the_manuals_values_and_decode_back(void)
{
    /* UG 6.1.2 */
    TEST_ASSERT_EQUAL_HEX16(0x86, cm1e_fsa_commands[COMMAND_FAULT_RESET].controlword);
    TEST_ASSERT_EQUAL_HEX16(0x06, cm1e_fsa_commands[COMMAND_SHUTDOWN].controlword);
    TEST_ASSERT_EQUAL_HEX16(0x07, cm1e_fsa_commands[COMMAND_SWITCH_ON].controlword);
    TEST_ASSERT_EQUAL_HEX16(0x0F, cm1e_fsa_commands[COMMAND_ENABLE_OPERATION].controlword);
    for (int i = 0; i < CM1E_FSA_COMMAND_COUNT; i++) {
        TEST_ASSERT_EQUAL(i, cm1e_fsa_commands[i].command);
        TEST_ASSERT_NOT_NULL(cm1e_fsa_commands[i].name);
        if (i != COMMAND_QUICK_STOP)
            TEST_ASSERT_EQUAL(i, decode(cm1e_fsa_commands[i].controlword));
    }
    /* UG 6.1.2's 4a: with a new set-point */
    TEST_ASSERT_EQUAL(COMMAND_ENABLE_OPERATION, decode(0x1F));
    /* a missing quick stop bit is ignored */
    TEST_ASSERT_EQUAL(COMMAND_ENABLE_OPERATION, decode(0x0B));
}

static void test_bits_have_the_manuals_places(void)
{
    static const uint16_t control[][2] = {
        {CONTROLWORD_SWITCH_ON, 0}, {CONTROLWORD_ENABLE_VOLTAGE, 1}, {CONTROLWORD_QUICK_STOP, 2},
        {CONTROLWORD_ENABLE_OPERATION, 3}, {CONTROLWORD_NEW_SET_POINT, 4}, {CONTROLWORD_HOMING_START, 4},
        {CONTROLWORD_FAULT_RESET, 7}, {CONTROLWORD_HALT, 8},
    };
    static const uint16_t status[][2] = {
        {STATUSWORD_READY_TO_SWITCH_ON, 0}, {STATUSWORD_SWITCHED_ON, 1}, {STATUSWORD_OPERATION_ENABLED, 2},
        {STATUSWORD_FAULT, 3}, {STATUSWORD_VOLTAGE_ENABLED, 4}, {STATUSWORD_QUICK_STOP, 5},
        {STATUSWORD_SWITCH_ON_DISABLED, 6}, {STATUSWORD_WARNING, 7}, {STATUSWORD_REMOTE, 9},
        {STATUSWORD_TARGET_REACHED, 10}, {STATUSWORD_INTERNAL_LIMIT, 11}, {STATUSWORD_HOMING_ATTAINED, 12},
        {STATUSWORD_HOMING_ERROR, 13},
    };
    for (size_t i = 0; i < sizeof control / sizeof control[0]; i++)
        TEST_ASSERT_EQUAL_HEX16(1u << control[i][1], control[i][0]);
    for (size_t i = 0; i < sizeof status / sizeof status[0]; i++)
        TEST_ASSERT_EQUAL_HEX16(1u << status[i][1], status[i][0]);
}

/* A drive that follows the table: one commanded or automatic transition; an error (13) never happens. */
static cm1e_fsa_state_t step(cm1e_fsa_state_t state, cm1e_fsa_command_t command)
{
    for (const cm1e_fsa_transition_t *t = cm1e_fsa_transitions; t->number != 0xFF; t++)
        if (t->from == state && t->number != 13 && (t->command == command || t->command == CM1E_FSA_COMMAND_COUNT))
            return t->to;
    return state;
}

static void walk(cm1e_fsa_state_t start, bool enable, cm1e_fsa_state_t goal)
{
    cm1e_fsa_state_t state = start;
    bool fault_was_reset = false;
    for (int i = 0; i < 8; i++) {
        const cm1e_fsa_command_t command = cm1e_fsa_next_command(state, enable);
        TEST_ASSERT_TRUE((unsigned)command < CM1E_FSA_COMMAND_COUNT);
        fault_was_reset = fault_was_reset || command == COMMAND_FAULT_RESET;
        const cm1e_fsa_state_t next = step(state, command);
        if (!enable) /* no way to disabled leads over torque */
            TEST_ASSERT_TRUE(next != OPERATION_ENABLED || state == OPERATION_ENABLED);
        state = next;
    }
    TEST_ASSERT_EQUAL_MESSAGE(goal, state, cm1e_fsa_name(start));
    TEST_ASSERT_EQUAL_MESSAGE(start == FAULT || start == FAULT_REACTION_ACTIVE, fault_was_reset, cm1e_fsa_name(start));
}

static void test_next_commands_reach_the_goal_from_every_state(void)
{
    for (int state = 0; state < CM1E_FSA_STATE_COUNT; state++) {
        if (state == QUICK_STOP_ACTIVE) /* the CM1-E has no way in or out */
            continue;
        walk((cm1e_fsa_state_t)state, true, OPERATION_ENABLED);
        walk((cm1e_fsa_state_t)state, false, READY_TO_SWITCH_ON);
    }
}

static void test_unknown_state_is_never_enabled(void)
{
    static const int states[] = {CM1E_FSA_UNKNOWN, CM1E_FSA_UNKNOWN + 1, 1000, -1};
    for (size_t i = 0; i < sizeof states / sizeof states[0]; i++)
        for (int enable = 0; enable < 2; enable++)
            TEST_ASSERT_EQUAL(COMMAND_SHUTDOWN, cm1e_fsa_next_command((cm1e_fsa_state_t)states[i], enable));
}

static void test_enable_operation_alone_reaches_operation_enabled(void)
{
    cm1e_fsa_state_t state = READY_TO_SWITCH_ON;
    state = step(state, COMMAND_ENABLE_OPERATION);
    TEST_ASSERT_EQUAL(SWITCHED_ON, state);
    TEST_ASSERT_EQUAL(OPERATION_ENABLED, step(state, COMMAND_ENABLE_OPERATION));
}

/* CiA 402's numbers: where each transition starts and ends; on the CM1-E 15 ends elsewhere than in the standard. */
static void test_transitions_have_the_standards_numbers(void)
{
    static const struct {
        int number;
        int from, to; /* -1: any */
    } standard[] = {
        {1, NOT_READY_TO_SWITCH_ON, SWITCH_ON_DISABLED}, {2, SWITCH_ON_DISABLED, READY_TO_SWITCH_ON},
        {3, READY_TO_SWITCH_ON, SWITCHED_ON},            {4, SWITCHED_ON, OPERATION_ENABLED},
        {5, OPERATION_ENABLED, SWITCHED_ON},             {6, SWITCHED_ON, READY_TO_SWITCH_ON},
        {8, OPERATION_ENABLED, READY_TO_SWITCH_ON},      {9, OPERATION_ENABLED, SWITCH_ON_DISABLED},
        {10, SWITCHED_ON, SWITCH_ON_DISABLED},           {13, -1, FAULT_REACTION_ACTIVE},
        {14, FAULT_REACTION_ACTIVE, FAULT},              {15, FAULT, READY_TO_SWITCH_ON},
    };
    bool seen[sizeof standard / sizeof standard[0]] = {false};
    int last = 0;
    for (const cm1e_fsa_transition_t *t = cm1e_fsa_transitions; t->number != 0xFF; t++) {
        bool found = false;
        for (size_t i = 0; i < sizeof standard / sizeof standard[0]; i++)
            if (standard[i].number == t->number && (standard[i].from == -1 || standard[i].from == (int)t->from) &&
                standard[i].to == (int)t->to)
                found = seen[i] = true;
        TEST_ASSERT_TRUE(found);
        TEST_ASSERT_GREATER_OR_EQUAL(last, t->number);
        last = t->number;
    }
    for (size_t i = 0; i < sizeof standard / sizeof standard[0]; i++)
        TEST_ASSERT_TRUE(seen[i]);
}

static void test_no_state_has_two_ways_for_one_command(void)
{
    for (const cm1e_fsa_transition_t *a = cm1e_fsa_transitions; a->number != 0xFF; a++)
        for (const cm1e_fsa_transition_t *b = a + 1; b->number != 0xFF; b++)
            TEST_ASSERT_FALSE(a->from == b->from && a->command == b->command && a->command != CM1E_FSA_COMMAND_COUNT);
}

static void test_modes_are_the_manuals(void)
{
    static const struct {
        int number;
        const char *abbreviation;
    } manual[] = {{1, "PP"}, {3, "PV"}, {6, "HM"}, {8, "CSP"}, {9, "CSV"}};
    uint32_t supported = 0;
    for (size_t i = 0; i < sizeof manual / sizeof manual[0]; i++) {
        const cm1e_mode_row_t *row = cm1e_mode_find((int8_t)manual[i].number);
        TEST_ASSERT_NOT_NULL(row);
        TEST_ASSERT_EQUAL(manual[i].number, row->mode);
        TEST_ASSERT_EQUAL_STRING(manual[i].abbreviation, row->abbreviation);
        supported |= 1u << row->supported_bit;
    }
    TEST_ASSERT_EQUAL_HEX32(0x1A5, supported); /* UG 7.3.27 */
    int found = 0;
    for (int mode = INT8_MIN; mode <= INT8_MAX; mode++)
        found += cm1e_mode_find((int8_t)mode) != NULL;
    TEST_ASSERT_EQUAL(5, found);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_controlword_is_exactly_one_command);
    RUN_TEST(test_commands_are_sent_with_the_manuals_values_and_decode_back);
    RUN_TEST(test_bits_have_the_manuals_places);
    RUN_TEST(test_next_commands_reach_the_goal_from_every_state);
    RUN_TEST(test_unknown_state_is_never_enabled);
    RUN_TEST(test_enable_operation_alone_reaches_operation_enabled);
    RUN_TEST(test_transitions_have_the_standards_numbers);
    RUN_TEST(test_no_state_has_two_ways_for_one_command);
    RUN_TEST(test_modes_are_the_manuals);
    return UNITY_END();
}
