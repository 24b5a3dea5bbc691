/** What is written into 0x1C32 and 0x1C33 of a slave with SYNC0 or SYNC1, by what it says that it supports. */
#include <string.h>

#include "bus/slave_setup.h"
#include "core/bytes.h"
#include "unity.h"

enum { OUTPUTS = 0x1C32, INPUTS = 0x1C33, NONE = -1 };

void setUp(void) { }
void tearDown(void) { }

/** A slave: what 0x1C32:04 and 0x1C33:04 read (NONE: there is no such entry), and whether :01 may be written. */
typedef struct slave {
    int supported[2];
    bool fixed, keeps_own; /**< refuses to be written; takes another value without a word */
    uint16_t type[2];
    unsigned transfers;
} slave_t;

static void refuse(cm1e_sdo_t *sdo)
{
    sdo->error = CM1E_ERROR_SDO_ABORT;
    sdo->abort_code = 0x06090011;
    sdo->state = CM1E_SDO_ERROR;
}

static void answer(slave_t *slave, cm1e_sdo_t *sdo)
{
    const unsigned i = sdo->index - OUTPUTS;
    TEST_ASSERT_TRUE(i < 2);
    slave->transfers++;
    sdo->state = CM1E_SDO_DONE;
    if (sdo->subindex == 4) {
        TEST_ASSERT_FALSE(sdo->write);
        if (slave->supported[i] == NONE) {
            refuse(sdo);
            return;
        }
        cm1e_put_u16(sdo->data, (uint16_t)slave->supported[i]);
        sdo->size = 2;
    } else if (sdo->write) {
        TEST_ASSERT_EQUAL(1, sdo->subindex);
        if (slave->fixed)
            refuse(sdo);
        else if (!slave->keeps_own)
            slave->type[i] = cm1e_get_u16(sdo->data);
    } else {
        cm1e_put_u16(sdo->data, slave->type[i]);
        sdo->size = 2;
    }
}

static cm1e_error_t set_up(slave_t *slave, cm1e_setup_pulses_t pulses)
{
    static const cm1e_slave_config_t nothing;
    cm1e_setup_job_t job;
    slave->type[0] = slave->type[1] = 1;
    TEST_ASSERT_EQUAL(pulses != CM1E_SETUP_NO_PULSES, cm1e_setup_is_needed(&nothing, pulses, false));
    TEST_ASSERT_FALSE(cm1e_setup_is_needed(&nothing, pulses, true));
    cm1e_setup_begin(&job, 1, &nothing, pulses, false, false);
    for (cm1e_sdo_t *sdo; (sdo = cm1e_setup_next(&job)) != NULL;) {
        TEST_ASSERT_LESS_THAN(10, slave->transfers);
        answer(slave, sdo);
    }
    TEST_ASSERT_TRUE(cm1e_setup_idle(&job));
    return job.error;
}

static void expect_types(int outputs, int inputs, cm1e_setup_pulses_t pulses, int outputs_support, int inputs_support)
{
    slave_t slave = {.supported = {outputs_support, inputs_support}};
    TEST_ASSERT_EQUAL(CM1E_OK, set_up(&slave, pulses));
    TEST_ASSERT_EQUAL(outputs, slave.type[0]);
    TEST_ASSERT_EQUAL(inputs, slave.type[1]);
}

static void test_sync0_asks_nothing(void)
{
    expect_types(1, 1, CM1E_SETUP_NO_PULSES, 0x0E, 0x0E);
    expect_types(2, 2, CM1E_SETUP_SYNC0, NONE, NONE);
}

static void test_with_sync1_the_slave_is_asked(void)
{
    expect_types(3, 3, CM1E_SETUP_SYNC1, 0x0E, 0x0E);
    expect_types(2, 2, CM1E_SETUP_SYNC1, 0x07, 0x0804);
    expect_types(2, 3, CM1E_SETUP_SYNC1, 0x07, 0x0B);
    expect_types(1, 3, CM1E_SETUP_SYNC1, 0x03, 0x08);
    expect_types(1, 2, CM1E_SETUP_SYNC1, NONE, 0x04);
    expect_types(3, 1, CM1E_SETUP_SYNC1, 0x08, NONE);
    expect_types(1, 1, CM1E_SETUP_SYNC1, NONE, NONE);
}

static void test_one_that_refuses_is_left_and_one_that_lies_is_told(void)
{
    slave_t fixed = {.supported = {0x0E, 0x0E}, .fixed = true}, liar = {.supported = {0x0E, 0x0E}, .keeps_own = true};
    TEST_ASSERT_EQUAL(CM1E_OK, set_up(&fixed, CM1E_SETUP_SYNC1));
    TEST_ASSERT_EQUAL(4, fixed.transfers); /* asked and written, each of the two, without a check */
    TEST_ASSERT_EQUAL(CM1E_ERROR_PDO_MAPPING, set_up(&liar, CM1E_SETUP_SYNC1));
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_sync0_asks_nothing);
    RUN_TEST(test_with_sync1_the_slave_is_asked);
    RUN_TEST(test_one_that_refuses_is_left_and_one_that_lies_is_told);
    return UNITY_END();
}
