/* One slave on its way to an EtherCAT state, and the question for its explicit device ID: what is written, and how each
 * of them ends when the slave does not answer, or answers something else. Without frames. */
#include <string.h>
#include <unity.h>

#include "bus/al_machine.h"
#include "core/bytes.h"

enum { STATION = 0x1003, DEADLINE_NS = 100000000 };

static cm1e_al_machine_t machine;
static cm1e_datagram_t datagram;

enum { ROUND_TRIP_NS = 100000 };
static int64_t time_ns; /* of the last datagram */

void setUp(void)
{
    memset(&machine, 0xFF, sizeof machine); /* a request forgets all that was before */
    machine.station = STATION;
    cm1e_al_cancel(&machine);
    time_ns = 0;
}
void tearDown(void) {}

/* One datagram to the slave and its answer: AL status and code, for a read. */
static void answered(unsigned offset, unsigned status, unsigned code)
{
    memset(&datagram, 0, sizeof datagram);
    time_ns = time_ns + ROUND_TRIP_NS < DEADLINE_NS ? time_ns + ROUND_TRIP_NS : DEADLINE_NS - 1;
    TEST_ASSERT_TRUE(cm1e_al_next(&machine, &datagram, time_ns));
    TEST_ASSERT_EQUAL_HEX16(STATION, datagram.address);
    TEST_ASSERT_EQUAL_HEX16(offset, datagram.offset);
    TEST_ASSERT_EQUAL(offset == REG_AL_STATUS ? 6 : 2, datagram.length);
    TEST_ASSERT_EQUAL(offset == REG_AL_STATUS ? COMMAND_FPRD : COMMAND_FPWR, datagram.command);
    if (offset == REG_AL_STATUS) {
        cm1e_put_u16(datagram.data, (uint16_t)status);
        cm1e_put_u16(datagram.data + 4, (uint16_t)code);
    } else {
        TEST_ASSERT_EQUAL_HEX16(status, cm1e_get_u16(datagram.data));
    }
    datagram.working_counter = 1;
    cm1e_al_result(&machine, &datagram, time_ns);
}

/* A datagram that does not come back. */
static void lost(int64_t now_ns)
{
    TEST_ASSERT_TRUE(cm1e_al_next(&machine, &datagram, now_ns));
    datagram.working_counter = DATAGRAM_LOST;
    cm1e_al_result(&machine, &datagram, now_ns);
}

static void ended_with(cm1e_error_t error)
{
    TEST_ASSERT_TRUE(cm1e_al_idle(&machine));
    TEST_ASSERT_EQUAL_INT(error, machine.error);
    TEST_ASSERT_FALSE(cm1e_al_next(&machine, &datagram, 10 * DEADLINE_NS));
    TEST_ASSERT_EQUAL_INT(error, machine.error);
}

static void test_a_slave_is_brought_to_a_state(void)
{
    TEST_ASSERT_FALSE(cm1e_al_next(&machine, &datagram, 0));
    cm1e_al_request(&machine, CM1E_AL_SAFE_OP, DEADLINE_NS);
    lost(0);
    answered(REG_AL_STATUS, CM1E_AL_PRE_OP, 0);
    answered(REG_AL_CONTROL, CM1E_AL_SAFE_OP, 0);
    answered(REG_AL_STATUS, CM1E_AL_PRE_OP, 0);
    TEST_ASSERT_FALSE(cm1e_al_idle(&machine));
    answered(REG_AL_STATUS, CM1E_AL_SAFE_OP, 0);
    ended_with(CM1E_OK);
}

static void test_an_old_error_is_acknowledged_with_the_bit_and_without_it_in_turn(void)
{
    cm1e_al_request(&machine, CM1E_AL_OP, DEADLINE_NS);
    answered(REG_AL_STATUS, CM1E_AL_SAFE_OP | CM1E_AL_ERROR, 0x1B);
    for (int turn = 0; turn < 3; turn++) {
        answered(REG_AL_CONTROL, turn % 2 ? CM1E_AL_SAFE_OP : CM1E_AL_SAFE_OP | AL_ERROR_FLAG, 0);
        for (int look = 0; look < 10; look++)
            answered(REG_AL_STATUS, CM1E_AL_SAFE_OP | CM1E_AL_ERROR, 0x1B);
    }
    answered(REG_AL_CONTROL, CM1E_AL_SAFE_OP, 0);
    answered(REG_AL_STATUS, CM1E_AL_SAFE_OP, 0);
    answered(REG_AL_CONTROL, CM1E_AL_OP, 0);
    answered(REG_AL_STATUS, CM1E_AL_SAFE_OP | CM1E_AL_ERROR, 0x1D);
    ended_with(CM1E_ERROR_BUS_STATE);
    TEST_ASSERT_EQUAL_HEX16(0x1D, machine.code);
}

static void test_at_the_deadline_it_matters_whether_the_slave_ever_answered(void)
{
    for (int n = 0; n < 3; n++) { /* what was answered to an earlier request does not matter */
        const bool answers = n == 1;
        time_ns = 0;
        cm1e_al_request(&machine, CM1E_AL_OP, DEADLINE_NS);
        if (answers)
            answered(REG_AL_STATUS, CM1E_AL_SAFE_OP, 0);
        lost(DEADLINE_NS - 1);
        TEST_ASSERT_FALSE(cm1e_al_next(&machine, &datagram, DEADLINE_NS));
        ended_with(answers ? CM1E_ERROR_BUS_STATE : CM1E_ERROR_TIMEOUT);
    }
}

static void test_an_explicit_id_is_read_and_the_request_is_taken_back(void)
{
    cm1e_al_read_id(&machine, DEADLINE_NS);
    answered(REG_AL_STATUS, CM1E_AL_PRE_OP, 0);
    answered(REG_AL_CONTROL, CM1E_AL_PRE_OP | AL_ID_REQUEST, 0);
    answered(REG_AL_STATUS, CM1E_AL_PRE_OP, 0);
    answered(REG_AL_STATUS, CM1E_AL_PRE_OP | AL_ID_REQUEST, 42);
    answered(REG_AL_CONTROL, CM1E_AL_PRE_OP, 0);
    ended_with(CM1E_OK);
    TEST_ASSERT_EQUAL_UINT16(42, machine.explicit_id);
}

/* It is no error, and the slave is not left with a request in AL control. */
static void test_a_slave_without_an_explicit_id_has_none(void)
{
    for (int heard = 0; heard < 2; heard++) {
        cm1e_al_read_id(&machine, DEADLINE_NS);
        answered(REG_AL_STATUS, CM1E_AL_PRE_OP, 0);
        answered(REG_AL_CONTROL, CM1E_AL_PRE_OP | AL_ID_REQUEST, 0);
        answered(REG_AL_STATUS, CM1E_AL_PRE_OP, 7);
        TEST_ASSERT_TRUE(cm1e_al_next(&machine, &datagram, DEADLINE_NS));
        TEST_ASSERT_EQUAL_HEX16(REG_AL_CONTROL, datagram.offset);
        TEST_ASSERT_EQUAL_HEX16(CM1E_AL_PRE_OP, cm1e_get_u16(datagram.data));
        datagram.working_counter = heard ? 1 : DATAGRAM_LOST;
        cm1e_al_result(&machine, &datagram, DEADLINE_NS);
        if (!heard)
            TEST_ASSERT_FALSE(cm1e_al_next(&machine, &datagram, DEADLINE_NS));
        ended_with(CM1E_OK);
        TEST_ASSERT_EQUAL_UINT16(0, machine.explicit_id);
    }
    cm1e_al_read_id(&machine, DEADLINE_NS);
    lost(DEADLINE_NS - 1);
    TEST_ASSERT_FALSE(cm1e_al_next(&machine, &datagram, DEADLINE_NS));
    ended_with(CM1E_OK);
}

/* A slave with a processor may take a while to see an acknowledgement: it gets a millisecond, and ten looks, both. */
static void test_the_next_acknowledgement_comes_after_ten_looks_and_a_millisecond(void)
{
    for (int round = 0; round < 2; round++) {
        const int64_t pace_ns = round ? 300000 : 20000;
        const int looks = round ? 10 : 50;
        cm1e_al_request(&machine, CM1E_AL_OP, DEADLINE_NS);
        answered(REG_AL_STATUS, CM1E_AL_SAFE_OP | CM1E_AL_ERROR, 0x1B);
        answered(REG_AL_CONTROL, CM1E_AL_SAFE_OP | AL_ERROR_FLAG, 0);
        for (int look = 1; look <= looks; look++) {
            time_ns += pace_ns - ROUND_TRIP_NS;
            answered(REG_AL_STATUS, CM1E_AL_SAFE_OP | CM1E_AL_ERROR, 0x1B);
        }
        answered(REG_AL_CONTROL, CM1E_AL_SAFE_OP, 0);
        cm1e_al_cancel(&machine);
        ended_with(CM1E_ERROR_CANCELLED);
        time_ns = 0;
    }
    cm1e_al_request(&machine, CM1E_AL_INIT, DEADLINE_NS); /* which needs no configuration, so it is requested at once */
    answered(REG_AL_STATUS, CM1E_AL_SAFE_OP | CM1E_AL_ERROR, 0x1B);
    answered(REG_AL_CONTROL, CM1E_AL_INIT | AL_ERROR_FLAG, 0);
}

/* Five datagrams in a row, whatever it answered before. */
static void test_a_slave_is_silent_that_never_answers_or_does_not_any_more(void)
{
    cm1e_al_request(&machine, CM1E_AL_OP, DEADLINE_NS);
    TEST_ASSERT_TRUE(cm1e_al_is_silent(&machine));
    TEST_ASSERT_EQUAL_HEX16(0, machine.state);
    TEST_ASSERT_EQUAL_HEX16(0, machine.code);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, machine.error);
    answered(REG_AL_STATUS, CM1E_AL_PRE_OP, 0);
    for (int round = 0; round < 2; round++) {
        answered(round ? REG_AL_STATUS : REG_AL_CONTROL, round ? CM1E_AL_PRE_OP : CM1E_AL_OP, 0);
        for (int n = 1; n < 8; n++) {
            TEST_ASSERT_EQUAL(n > 5, cm1e_al_is_silent(&machine));
            lost(time_ns);
        }
    }
    cm1e_al_read_id(&machine, DEADLINE_NS);
    TEST_ASSERT_TRUE(cm1e_al_is_silent(&machine));
    TEST_ASSERT_EQUAL_UINT16(0, machine.explicit_id);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, machine.error);
}

static void test_states_have_names(void)
{
    static const struct {
        unsigned state;
        const char *text;
    } rows[] = {{0, "no state"}, {1, "INIT"}, {2, "PRE-OP"}, {3, "BOOT"}, {4, "SAFE-OP"}, {8, "OP"}, {0x10, "no state + ERROR"},
                {0x11, "INIT + ERROR"}, {0x12, "PRE-OP + ERROR"}, {0x13, "BOOT + ERROR"}, {0x14, "SAFE-OP + ERROR"},
                {0x18, "OP + ERROR"}, {5, "an unknown state"}, {7, "an unknown state"}, {9, "an unknown state"},
                {15, "an unknown state"}, {0x16, "an unknown state"}, {0x1F, "an unknown state"}, {0x28, "OP"}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        TEST_ASSERT_EQUAL_STRING(rows[i].text, cm1e_al_state_text((uint16_t)rows[i].state));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_the_next_acknowledgement_comes_after_ten_looks_and_a_millisecond);
    RUN_TEST(test_a_slave_is_silent_that_never_answers_or_does_not_any_more);
    RUN_TEST(test_states_have_names);
    RUN_TEST(test_a_slave_is_brought_to_a_state);
    RUN_TEST(test_an_old_error_is_acknowledged_with_the_bit_and_without_it_in_turn);
    RUN_TEST(test_at_the_deadline_it_matters_whether_the_slave_ever_answered);
    RUN_TEST(test_an_explicit_id_is_read_and_the_request_is_taken_back);
    RUN_TEST(test_a_slave_without_an_explicit_id_has_none);
    return UNITY_END();
}
