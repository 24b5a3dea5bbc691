/* Is it a bridge? Every question of the list answered wrongly, refused, not at all. */
#include <stdio.h>
#include <string.h>
#include <unity.h>

#include "bus/recognise.h"
#include "core/bytes.h"

enum { QUESTIONS = 15, MUST_BE = 10, SECOND_NS = 1000000000 };

typedef enum harm { NO_HARM = 0, ABORT, TIMEOUT, OTHER_VALUE, ZERO, EMPTY, HARMS } harm_t;
static cm1e_device_model_t model;
static unsigned questions, harm_at; /* from 1 */
static harm_t harm;
static int64_t now_ns, answer_ns;
static cm1e_recognition_t job;

void setUp(void)
{
    model = CM1E_DEVICE_EB12;
    questions = harm_at = 0;
    now_ns = 5;
    answer_ns = 1000000;
    memset(&job, 0, sizeof job);
}
void tearDown(void) {}

/** What the dictionary of a bridge has. The identity is not in it: the revision is one. */
static void serve(cm1e_sdo_t *sdo)
{
    const cm1e_entry_t *entry = cm1e_bridge_entry(model, sdo->index, sdo->subindex);
    TEST_ASSERT_NOT_NULL(entry);
    TEST_ASSERT_EQUAL(CM1E_AVAILABLE, entry->availability);
    TEST_ASSERT_FALSE(sdo->write);
    TEST_ASSERT_GREATER_OR_EQUAL_size_t(entry->bits / 8u, sdo->size);
    const bool revision = sdo->index == OBJ_1018_IDENTITY;
    sdo->size = entry->bits / 8u;
    cm1e_put_uint(sdo->data, (unsigned)sdo->size, revision ? 0x00010002 : (uint64_t)entry->default_value);
    sdo->error = CM1E_OK;
    sdo->state = CM1E_SDO_DONE;
}

static void serve_with_harm(cm1e_sdo_t *sdo)
{
    now_ns += answer_ns;
    serve(sdo);
    const harm_t present = ++questions == harm_at ? harm : NO_HARM;
    if (present == ABORT || present == TIMEOUT) {
        sdo->error = present == ABORT ? CM1E_ERROR_SDO_ABORT : CM1E_ERROR_TIMEOUT;
        sdo->state = CM1E_SDO_ERROR;
    } else if (present == OTHER_VALUE) {
        ((uint8_t *)sdo->data)[0] ^= 0x40;
    } else if (present == ZERO) {
        memset(sdo->data, 0, sdo->size);
    } else if (present == EMPTY) {
        sdo->size = 0;
    }
}

static void run(void)
{
    questions = 0;
    const int64_t began_ns = now_ns;
    cm1e_recognise_begin(&job, 3, now_ns + 3 * (int64_t)SECOND_NS);
    cm1e_sdo_t *sdo;
    while ((sdo = cm1e_recognise_next(&job, now_ns)) != NULL) {
        TEST_ASSERT_EQUAL_UINT16(3, sdo->position);
        TEST_ASSERT_GREATER_THAN_INT64(0, sdo->timeout_ns);
        TEST_ASSERT_LESS_OR_EQUAL_INT64(SECOND_NS, sdo->timeout_ns);
        TEST_ASSERT_LESS_OR_EQUAL_INT64(began_ns + 3 * (int64_t)SECOND_NS, now_ns + sdo->timeout_ns);
        serve_with_harm(sdo);
        TEST_ASSERT_LESS_OR_EQUAL_UINT(QUESTIONS, questions);
    }
    TEST_ASSERT_TRUE(cm1e_recognise_idle(&job));
    TEST_ASSERT_NULL(cm1e_recognise_next(&job, now_ns));
}

static void test_every_model_is_a_bridge_with_its_motors(void)
{
    for (model = CM1E_DEVICE_EB01; model <= CM1E_DEVICE_EB12; model++) {
        cm1e_device_model_t found;
        run();
        TEST_ASSERT_TRUE(job.recognised);
        TEST_ASSERT_EQUAL_UINT(QUESTIONS, questions);
        for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++)
            TEST_ASSERT_EQUAL_UINT(cm1e_bridge_motor(model, i), job.facts.motors[i]);
        TEST_ASSERT_EQUAL_HEX32(0x00010002, job.facts.revision);
        TEST_ASSERT_TRUE(cm1e_recognise_model(&job.facts, &found));
        TEST_ASSERT_EQUAL(model, found);
    }
}

static void test_harm_at_every_question_ends_defined(void)
{
    for (harm_at = 1; harm_at <= QUESTIONS; harm_at++) {
        for (harm = ABORT; harm < HARMS; harm++) {
            char message[64];
            snprintf(message, sizeof message, "question %u, harm %d", harm_at, (int)harm);
            run();
            /* The facts that make a bridge must all be right; what it is made of may be anything but silence. */
            const bool still = harm_at > MUST_BE && harm != TIMEOUT;
            TEST_ASSERT_EQUAL_MESSAGE(still, job.recognised, message);
            TEST_ASSERT_EQUAL_UINT_MESSAGE(still ? QUESTIONS : harm_at, questions, message);
            if (!still && (harm == OTHER_VALUE || harm == ZERO || harm == EMPTY))
                TEST_ASSERT_NOT_EQUAL_MESSAGE(job.wanted, job.shown, message);
            cm1e_device_model_t found = CM1E_DEVICE_EB01;
            if (still && harm_at < QUESTIONS) { /* one motor of no kind */
                TEST_ASSERT_FALSE_MESSAGE(cm1e_recognise_model(&job.facts, &found), message);
                TEST_ASSERT_EQUAL_MESSAGE(CM1E_DEVICE_CM1E, found, message);
            }
        }
    }
}

/** Each answer in time, all of them not. */
static void test_slow_slave_ends_at_the_deadline(void)
{
    answer_ns = 900000000;
    run();
    TEST_ASSERT_FALSE(job.recognised);
    TEST_ASSERT_EQUAL_UINT(4, questions);
}

static void test_only_the_three_combinations_of_motors_are_a_model(void)
{
    unsigned known = 0;
    for (unsigned n = 0; n < 256; n++) {
        const cm1e_bridge_facts_t facts = {.motors = {n & 3, n >> 2 & 3, n >> 4 & 3, n >> 6 & 3}};
        cm1e_device_model_t found = CM1E_DEVICE_EB02;
        if (!cm1e_recognise_model(&facts, &found)) {
            TEST_ASSERT_EQUAL(CM1E_DEVICE_CM1E, found);
            continue;
        }
        known++;
        for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++)
            TEST_ASSERT_EQUAL_UINT(cm1e_bridge_motor(found, i), facts.motors[i]);
    }
    TEST_ASSERT_EQUAL_UINT(3, known);
}

static void test_cancelled_asks_nothing_more(void)
{
    cm1e_recognise_begin(&job, 3, SECOND_NS);
    TEST_ASSERT_NOT_NULL(cm1e_recognise_next(&job, now_ns));
    cm1e_recognise_cancel(&job);
    TEST_ASSERT_NULL(cm1e_recognise_next(&job, now_ns));
    TEST_ASSERT_FALSE(job.recognised);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_model_is_a_bridge_with_its_motors);
    RUN_TEST(test_harm_at_every_question_ends_defined);
    RUN_TEST(test_slow_slave_ends_at_the_deadline);
    RUN_TEST(test_only_the_three_combinations_of_motors_are_a_model);
    RUN_TEST(test_cancelled_asks_nothing_more);
    return UNITY_END();
}
