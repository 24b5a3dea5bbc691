/* An answer of a transfer that was given up comes in the middle of the next one. What the CoE client asks first to know
 * it by (an object that every device should have) may be refused. */
#include <stdio.h>
#include <string.h>
#include <unity.h>

#include "../support/mailbox_slave.h"
#include "bus/coe_client.h"

enum { STEP_NS = 100000, VALUE_BYTES = 4 };

static slave_t slave;
static cm1e_coe_client_t client;
static uint8_t buffer[VALUE_BYTES], kept_answer[MAILBOX];
static int64_t now_ns;

void setUp(void)
{
    slave = (slave_t){.latency = 2, .size = VALUE_BYTES};
    client = (cm1e_coe_client_t){.mailbox = {.station = STATION, .out_start = OUT, .out_length = MAILBOX,
                                             .in_start = IN, .in_length = MAILBOX}};
}
void tearDown(void) {}

/** Reads the value until the transfer ends. */
static cm1e_error_t read_value(int64_t timeout_ns)
{
    static cm1e_datagram_t d;
    cm1e_sdo_t sdo = {.position = 1, .index = 0x2000, .subindex = 1, .data = buffer, .size = VALUE_BYTES,
                      .timeout_ns = timeout_ns, .state = CM1E_SDO_BUSY};
    cm1e_coe_begin(&client, &sdo, now_ns);
    for (unsigned n = 0; cm1e_sdo_state(&sdo) == CM1E_SDO_BUSY; n++) {
        now_ns += STEP_NS;
        TEST_ASSERT_TRUE_MESSAGE(n < 20000, "endless");
        if (!cm1e_coe_next(&client, &d, now_ns))
            continue;
        handle(&slave, &d);
        cm1e_coe_result(&client, &d, now_ns);
    }
    return sdo.error;
}

static bool keep_back(slave_t *s, uint8_t *answer)
{
    (void)s;
    memcpy(kept_answer, answer, MAILBOX);
    return false;
}

/** All objects but the one that is read are refused. */
static bool refuse_others(slave_t *s, uint8_t *answer)
{
    (void)s;
    if (cm1e_get_u16(answer + 9) == 0x2000)
        return true;
    cm1e_put_u16(answer + 6, 2 << 12);
    answer[8] = 0x80;
    cm1e_put_u32(answer + 12, 0x06020000);
    return true;
}

static void check_next_value(bool refuses)
{
    memset(slave.store, 1, VALUE_BYTES);
    slave.lie = keep_back;
    slave.lie_from = 1;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_TIMEOUT, read_value(50 * STEP_NS));
    memset(slave.store, 99, VALUE_BYTES); /* the value changes, then the old answer comes, to the very same question */
    slave.lie = refuses ? refuse_others : NULL;
    slave.requests = 0;
    put_in(&slave, kept_answer);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, read_value(0));
    TEST_ASSERT_EQUAL_INT(0, memcmp(slave.store, buffer, VALUE_BYTES));
    TEST_ASSERT_EQUAL_UINT(3, slave.requests); /* the end of the old one, an object that every device has, the value */
}

static void test_old_answer_is_not_taken_for_the_next_one(void) { check_next_value(false); }

static void test_old_answer_is_known_by_a_refusal_as_well(void) { check_next_value(true); }

/** Each time another object is asked for, and every refusal counts. */
static void test_refusals_in_a_row_count_as_well(void)
{
    for (int n = 0; n < 12; n++)
        check_next_value(true);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_old_answer_is_not_taken_for_the_next_one);
    RUN_TEST(test_old_answer_is_known_by_a_refusal_as_well);
    RUN_TEST(test_refusals_in_a_row_count_as_well);
    return UNITY_END();
}
