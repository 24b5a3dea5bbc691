/* What the configuration writes into a slave at its start: the transfers in their order, what is read back, and every
 * one of them refused or answered with another value. */
#include <string.h>

#include "bus/slave_setup.h"
#include "core/bytes.h"
#include "unity.h"

static cm1e_slave_config_t config;
static cm1e_setup_job_t job;
static bool by_sync0, swapped;

void setUp(void)
{
    config = (cm1e_slave_config_t){
        .outputs_pdos = {0x1601}, .inputs_pdos = {0x1A03, 0x1A00}, .outputs_pdo_count = 1, .inputs_pdo_count = 2,
        .entries = {{0x1A00, 0x6000, 1, 1}, {0x1A00, 0, 0, 7}, {0x1601, 0x7000, 0x11, 16}}, .entry_count = 3,
        .sdos = {{.index = 0x8000, .subindex = 0x12, .bytes = 2, .value = 0xFF9C},
                 {.index = 0x8000, .subindex = 1, .bytes = 4, .before_op = true, .value = 0x3FC00000},
                 {.index = 0x8010, .bytes = 1, .value = 1}},
        .sdo_count = 3,
    };
}
void tearDown(void) { by_sync0 = swapped = false; }

typedef struct transfer {
    bool write;
    unsigned index, subindex, bytes;
    uint64_t value;
} transfer_t;

static const transfer_t before_safe_op[] = {
    {true, 0x8000, 0x12, 2, 0xFF9C}, {true, 0x8010, 0, 1, 1},
    {true, 0x1C12, 0, 1, 0}, {true, 0x1C13, 0, 1, 0},
    {true, 0x1A00, 0, 1, 0}, {true, 0x1A00, 1, 4, 0x60000101}, {true, 0x1A00, 2, 4, 0x00000007},
    {true, 0x1A00, 0, 1, 2},
    {true, 0x1601, 0, 1, 0}, {true, 0x1601, 1, 4, 0x70001110}, {true, 0x1601, 0, 1, 1},
    {true, 0x1C12, 1, 2, 0x1601}, {true, 0x1C12, 0, 1, 1},
    {true, 0x1C13, 1, 2, 0x1A03}, {true, 0x1C13, 2, 2, 0x1A00}, {true, 0x1C13, 0, 1, 2},
    {false, 0x1A00, 1, 4, 0x60000101}, {false, 0x1A00, 2, 4, 0x00000007}, {false, 0x1A00, 0, 1, 2},
    {false, 0x1601, 1, 4, 0x70001110}, {false, 0x1601, 0, 1, 1},
    {false, 0x1C12, 1, 2, 0x1601}, {false, 0x1C12, 0, 1, 1},
    {false, 0x1C13, 1, 2, 0x1A03}, {false, 0x1C13, 2, 2, 0x1A00}, {false, 0x1C13, 0, 1, 2},
};
enum { TRANSFERS = sizeof before_safe_op / sizeof before_safe_op[0] };

static uint16_t excluded; /* by the PDO 0x1A00, among others; 0: the slave has no such objects */

/* Whether the transfer asks which PDOs one excludes; it is answered then. Others than those that are assigned exclude
 * nothing. */
static bool answers_excludes(cm1e_sdo_t *sdo)
{
    if (sdo->write || sdo->subindex != 6 || sdo->index < 0x1800 || sdo->index >= 0x1A00)
        return false;
    TEST_ASSERT_TRUE(sdo->index == 0x1803 || sdo->index == 0x1800);
    cm1e_put_u16(sdo->data, 0x1A07);
    cm1e_put_u16((uint8_t *)sdo->data + 2, excluded);
    sdo->size = sdo->index == 0x1800 ? 4 : 2;
    sdo->error = excluded ? CM1E_OK : CM1E_ERROR_SDO_ABORT;
    sdo->state = excluded ? CM1E_SDO_DONE : CM1E_SDO_ERROR;
    return true;
}

typedef enum harm { NOTHING = 0, REFUSED, OTHER_VALUE } harm_t;

/* Answers every transfer as a good slave does, but for one. Returns how many there were. */
static int run(bool before_op, const transfer_t *expected, int harmed, harm_t harm)
{
    int count = 0;
    cm1e_setup_begin(&job, 3, &config, by_sync0, before_op, swapped);
    for (cm1e_sdo_t *sdo; (sdo = cm1e_setup_next(&job)) != NULL; count++) {
        if (answers_excludes(sdo)) {
            count--;
            continue;
        }
        const transfer_t *one = &expected[count];
        const bool hit = harm != NOTHING && count == harmed;
        TEST_ASSERT_EQUAL(3, sdo->position);
        TEST_ASSERT_EQUAL_HEX16(one->index, sdo->index);
        TEST_ASSERT_EQUAL_HEX8(one->subindex, sdo->subindex);
        TEST_ASSERT_EQUAL(one->write, sdo->write);
        if (one->write) {
            TEST_ASSERT_EQUAL(one->bytes, sdo->size);
            TEST_ASSERT_EQUAL_HEX64(one->value, cm1e_get_uint(sdo->data, (unsigned)sdo->size));
        } else {
            cm1e_put_uint(sdo->data, one->bytes, one->value ^ (hit && harm == OTHER_VALUE));
            sdo->size = one->bytes;
        }
        sdo->error = hit && harm == REFUSED ? CM1E_ERROR_SDO_ABORT : CM1E_OK;
        sdo->state = sdo->error != CM1E_OK ? CM1E_SDO_ERROR : CM1E_SDO_DONE;
    }
    TEST_ASSERT_TRUE(cm1e_setup_idle(&job));
    return count;
}

static void test_all_is_written_in_order_and_pdos_are_read_back(void)
{
    static const transfer_t before_op = {true, 0x8000, 1, 4, 0x3FC00000};
    TEST_ASSERT_EQUAL(TRANSFERS, run(false, before_safe_op, 0, NOTHING));
    TEST_ASSERT_EQUAL(CM1E_OK, job.error);
    TEST_ASSERT_EQUAL(1, run(true, &before_op, 0, NOTHING));
    TEST_ASSERT_EQUAL(CM1E_OK, job.error);
}

static void test_every_refusal_ends_the_job_there(void)
{
    for (int i = 0; i < TRANSFERS; i++) {
        TEST_ASSERT_EQUAL(i + 1, run(false, before_safe_op, i, REFUSED));
        TEST_ASSERT_EQUAL(CM1E_ERROR_SDO_ABORT, job.error);
        TEST_ASSERT_EQUAL_HEX16(before_safe_op[i].index, job.sdo.index);
        TEST_ASSERT_FALSE(job.differs);
    }
}

static void test_every_other_value_is_noticed(void)
{
    for (int i = 0; i < TRANSFERS; i++) {
        if (before_safe_op[i].write)
            continue;
        TEST_ASSERT_EQUAL(i + 1, run(false, before_safe_op, i, OTHER_VALUE));
        TEST_ASSERT_EQUAL(CM1E_ERROR_PDO_MAPPING, job.error);
        TEST_ASSERT_TRUE(job.differs);
        TEST_ASSERT_EQUAL_HEX64(before_safe_op[i].value, job.expected);
        TEST_ASSERT_EQUAL_HEX64(before_safe_op[i].value ^ 1, job.shown);
    }
}

static void test_an_assignment_of_two_that_exclude_each_other_is_not_written(void)
{
    excluded = 0x1A05;
    TEST_ASSERT_EQUAL(TRANSFERS, run(false, before_safe_op, 0, NOTHING));
    TEST_ASSERT_EQUAL(CM1E_OK, job.error);
    excluded = 0x1A03;
    TEST_ASSERT_EQUAL(2, run(false, before_safe_op, 0, NOTHING)); /* the start-up SDOs, and no PDO */
    TEST_ASSERT_EQUAL(CM1E_ERROR_PDO_MAPPING, job.error);
    TEST_ASSERT_EQUAL_HEX16(0x1A00, job.pdo);
    TEST_ASSERT_EQUAL_HEX16(0x1A03, job.excluded);
    excluded = 0;
}

static void test_nothing_to_write_is_no_job(void)
{
    TEST_ASSERT_TRUE(cm1e_setup_is_needed(&config, false, false));
    TEST_ASSERT_TRUE(cm1e_setup_is_needed(&config, false, true));
    config.sdo_count = 0;
    TEST_ASSERT_FALSE(cm1e_setup_is_needed(&config, false, true));
    TEST_ASSERT_TRUE(cm1e_setup_is_needed(&config, false, false));
    config.entry_count = config.outputs_pdo_count = config.inputs_pdo_count = 0;
    TEST_ASSERT_FALSE(cm1e_setup_is_needed(&config, false, false));
    TEST_ASSERT_FALSE(cm1e_setup_is_needed(NULL, false, false));
    TEST_ASSERT_EQUAL(0, run(false, before_safe_op, 0, NOTHING));
    TEST_ASSERT_EQUAL(CM1E_OK, job.error);
}

/* 0x1C32:01 and 0x1C33:01 of a slave that has them, of one that refuses them, and of one that takes another value. */
static void test_synchronisation_by_sync0_is_written_where_the_slave_lets_it(void)
{
    static const transfer_t expected[] = {
        {true, 0x1C32, 1, 2, 2}, {false, 0x1C32, 1, 2, 2}, {true, 0x1C33, 1, 2, 2}, {false, 0x1C33, 1, 2, 2},
    };
    static const transfer_t refused[] = {{true, 0x1C32, 1, 2, 2}, {true, 0x1C33, 1, 2, 2}, {false, 0x1C33, 1, 2, 2}};
    by_sync0 = true;
    config = (cm1e_slave_config_t){.sdo_count = 0};
    TEST_ASSERT_TRUE(cm1e_setup_is_needed(&config, true, false));
    TEST_ASSERT_FALSE(cm1e_setup_is_needed(&config, true, true));
    TEST_ASSERT_EQUAL(4, run(false, expected, 0, NOTHING));
    TEST_ASSERT_EQUAL(CM1E_OK, job.error);
    TEST_ASSERT_EQUAL(3, run(false, refused, 0, REFUSED));
    TEST_ASSERT_EQUAL(CM1E_OK, job.error);
    TEST_ASSERT_EQUAL(2, run(false, expected, 1, OTHER_VALUE));
    TEST_ASSERT_EQUAL(CM1E_ERROR_PDO_MAPPING, job.error);
    TEST_ASSERT_EQUAL_HEX16(0x1C32, job.sdo.index);
    TEST_ASSERT_EQUAL(2, run(false, expected, 1, REFUSED)); /* one that lets it be written lets it be read */
    TEST_ASSERT_EQUAL(CM1E_ERROR_SDO_ABORT, job.error);
    config.sdos[0] = (cm1e_sdo_config_t){.index = 0x1C32, .subindex = 1, .bytes = 2, .value = 3};
    config.sdo_count = 1;
    static const transfer_t stated[] = {{true, 0x1C32, 1, 2, 3}, {true, 0x1C33, 1, 2, 2}, {false, 0x1C33, 1, 2, 2}};
    TEST_ASSERT_EQUAL(3, run(false, stated, 0, NOTHING));
}

/** Of a modular device: what it has detected is compared; what it is to have is written where it lets it be. */
static void test_modules_are_compared_and_written(void)
{
    static const transfer_t expected[] = {
        {false, 0xF050, 0, 1, 2}, {false, 0xF050, 1, 4, 0x00219800}, {false, 0xF050, 2, 4, 0x80000029},
        {true, 0xF030, 0, 1, 0}, {false, 0xF030, 0, 1, 0}, {true, 0xF030, 1, 4, 0x00219800},
        {false, 0xF030, 1, 4, 0x00219800}, {true, 0xF030, 2, 4, 0x80000029}, {false, 0xF030, 2, 4, 0x80000029},
        {true, 0xF030, 0, 1, 2}, {false, 0xF030, 0, 1, 2}, {true, 0x1C12, 0, 1, 0}, {true, 0x1C12, 1, 2, 0x1601},
        {true, 0x1C12, 0, 1, 1}, {false, 0x1C12, 1, 2, 0x1601}, {false, 0x1C12, 0, 1, 1},
    };
    enum { ALL = sizeof expected / sizeof expected[0], OF_MODULES = 11 };
    config = (cm1e_slave_config_t){.modules = {0x00219800, 0x80000029}, .module_count = 2, .outputs_pdos = {0x1601},
                                   .outputs_pdo_count = 1};
    TEST_ASSERT_TRUE(cm1e_setup_is_needed(&config, false, false));
    TEST_ASSERT_EQUAL(ALL, run(false, expected, 0, NOTHING));
    TEST_ASSERT_EQUAL(CM1E_OK, job.error);
    for (int i = 0; i < OF_MODULES; i++) {
        transfer_t without[ALL];
        if (expected[i].write) { /* its check is left out */
            memcpy(without, expected, (size_t)(i + 1) * sizeof *expected);
            memcpy(without + i + 1, expected + i + 2, (size_t)(ALL - i - 2) * sizeof *expected);
            TEST_ASSERT_EQUAL(ALL - 1, run(false, without, i, REFUSED));
            TEST_ASSERT_EQUAL(CM1E_OK, job.error);
            continue;
        }
        TEST_ASSERT_EQUAL(i + 1, run(false, expected, i, REFUSED));
        TEST_ASSERT_EQUAL(CM1E_ERROR_SDO_ABORT, job.error);
        TEST_ASSERT_EQUAL(i + 1, run(false, expected, i, OTHER_VALUE));
        TEST_ASSERT_TRUE(job.differs);
        TEST_ASSERT_EQUAL_HEX64(expected[i].value, job.expected);
    }
}

/** Where the inputs are on sync manager 2, its object assigns them. */
static void test_a_swapped_slave_has_its_assignments_swapped(void)
{
    static const transfer_t expected[] = {
        {true, 0x1C13, 0, 1, 0}, {true, 0x1C12, 0, 1, 0}, {true, 0x1C13, 1, 2, 0x1601}, {true, 0x1C13, 0, 1, 1},
        {true, 0x1C12, 1, 2, 0x1A03}, {true, 0x1C12, 2, 2, 0x1A00}, {true, 0x1C12, 0, 1, 2},
        {false, 0x1C13, 1, 2, 0x1601}, {false, 0x1C13, 0, 1, 1}, {false, 0x1C12, 1, 2, 0x1A03},
        {false, 0x1C12, 2, 2, 0x1A00}, {false, 0x1C12, 0, 1, 2},
    };
    config.entry_count = config.sdo_count = 0;
    swapped = true;
    TEST_ASSERT_EQUAL(sizeof expected / sizeof expected[0], run(false, expected, 0, NOTHING));
    TEST_ASSERT_EQUAL(CM1E_OK, job.error);
}

/** A value of more than eight bytes lies in the data of the configuration. */
static void test_long_values_are_written_from_where_they_lie(void)
{
    config = (cm1e_slave_config_t){.sdo_count = 2,
                                   .sdos = {{.index = 0x8000, .size = 20, .value = 30, .complete_access = true},
                                            {.index = 0x8001, .subindex = 3, .bytes = 1, .value = 7}}};
    cm1e_setup_begin(&job, 3, &config, CM1E_SETUP_NO_PULSES, false, false);
    cm1e_sdo_t *sdo = cm1e_setup_next(&job);
    TEST_ASSERT_NOT_NULL(sdo);
    TEST_ASSERT_TRUE(sdo->write && sdo->complete_access && sdo->data == config.sdo_data + 30);
    TEST_ASSERT_EQUAL(20, sdo->size);
    sdo->state = CM1E_SDO_DONE;
    sdo = cm1e_setup_next(&job);
    TEST_ASSERT_NOT_NULL(sdo);
    TEST_ASSERT_TRUE(sdo->write && !sdo->complete_access && sdo->size == 1 && *(uint8_t *)sdo->data == 7);
    sdo->state = CM1E_SDO_DONE;
    TEST_ASSERT_NULL(cm1e_setup_next(&job));
    TEST_ASSERT_EQUAL(CM1E_OK, job.error);
}

/** Each PDO of a direction that has several tells which others it excludes, of either direction. It may have no such
 *  object, and one that tells of itself says nothing. */
static void test_each_pdo_is_asked_which_others_it_excludes(void)
{
    enum { PDOS = 4, NOBODY = PDOS, HAS_NO_OBJECT, NO_ANSWER, ANSWERS };
    static const uint16_t pdos[PDOS + 1] = {0x1600, 0x1603, 0x1A00, 0x1A05, 0x1A09};
    config = (cm1e_slave_config_t){.outputs_pdos = {pdos[0], pdos[1]}, .inputs_pdos = {pdos[2], pdos[3]},
                                   .outputs_pdo_count = 2, .inputs_pdo_count = 2};
    for (int n = 0; n < PDOS * ANSWERS; n++) {
        const int asked = n / ANSWERS, answer = n % ANSWERS;
        cm1e_setup_begin(&job, 3, &config, CM1E_SETUP_NO_PULSES, false, false);
        for (int i = 0; i <= asked; i++) {
            cm1e_sdo_t *sdo = cm1e_setup_next(&job);
            TEST_ASSERT_TRUE(sdo && !sdo->write && sdo->index == pdos[i] - 0x200 && sdo->subindex == 6);
            const int told = i == asked ? answer : NOBODY;
            cm1e_put_u16(sdo->data, pdos[NOBODY]);
            cm1e_put_u16((uint8_t *)sdo->data + 2, pdos[told <= NOBODY ? told : NOBODY]);
            sdo->size = 4;
            sdo->error = told == HAS_NO_OBJECT ? CM1E_ERROR_SDO_ABORT
                         : told == NO_ANSWER   ? CM1E_ERROR_TIMEOUT : CM1E_OK;
            sdo->state = sdo->error == CM1E_OK ? CM1E_SDO_DONE : CM1E_SDO_ERROR;
        }
        const cm1e_sdo_t *next = cm1e_setup_next(&job);
        const bool excludes = answer < PDOS && answer != asked;
        TEST_ASSERT_EQUAL(excludes || answer == NO_ANSWER, next == NULL);
        TEST_ASSERT_EQUAL(excludes              ? CM1E_ERROR_PDO_MAPPING
                          : answer == NO_ANSWER ? CM1E_ERROR_TIMEOUT : CM1E_OK, job.error);
        TEST_ASSERT_EQUAL_HEX16(excludes ? pdos[answer] : 0, job.excluded);
        if (excludes)
            TEST_ASSERT_EQUAL_HEX16(pdos[asked], job.pdo);
        else if (next && asked == PDOS - 1) /* all were asked, and writing begins */
            TEST_ASSERT_TRUE(next->write && next->index == 0x1C12 && next->subindex == 0);
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_each_pdo_is_asked_which_others_it_excludes);
    RUN_TEST(test_modules_are_compared_and_written);
    RUN_TEST(test_a_swapped_slave_has_its_assignments_swapped);
    RUN_TEST(test_long_values_are_written_from_where_they_lie);
    RUN_TEST(test_all_is_written_in_order_and_pdos_are_read_back);
    RUN_TEST(test_every_refusal_ends_the_job_there);
    RUN_TEST(test_every_other_value_is_noticed);
    RUN_TEST(test_an_assignment_of_two_that_exclude_each_other_is_not_written);
    RUN_TEST(test_nothing_to_write_is_no_job);
    RUN_TEST(test_synchronisation_by_sync0_is_written_where_the_slave_lets_it);
    return UNITY_END();
}
