/* The mapping job against a dictionary made by hand: lists of one to four PDOs, every transfer refused, lost or wrong,
 * assignments that cannot be written. */
#include <stdio.h>
#include <string.h>
#include <unity.h>

#include "bus/mapping.h"
#include "core/bytes.h"

enum { ABORT_READ_ONLY = 0x06010002, ABORT_NO_SUBINDEX = 0x06090011, TRANSFERS_MAX = 400 };

/** What can be done to one transfer. */
typedef enum harm { NO_HARM = 0, ABORT, TIMEOUT, OTHER_VALUE, SHORT, EMPTY, HARMS } harm_t;

/** The device: the assignment, and an index + 0x100 of each PDO that its entries begin at. */
static struct {
    uint8_t count[2];
    uint16_t pdos[2][CM1E_BRIDGE_AXES];
    bool count_read_only, places_read_only;
    unsigned entries;            /**< of every PDO */
    unsigned unused;             /**< so many more are stated by sub-index 0 */
    bool absent;                 /**< these are no sub-indexes; else they are 0 */
    uint8_t bits;                /**< of every entry */
    unsigned transfers, harm_at; /**< from 1; 0: never */
    harm_t harm;
} device;

static cm1e_mapping_job_t job;

static const cm1e_pdo_choice_t bridge = {4, {{0x1601, 0x1611, 0x1621, 0x1631}, {0x1A01, 0x1A11, 0x1A21, 0x1A31}}};
static const cm1e_pdo_choice_t single = {1, {{0x1602}, {0x1A02}}};

void setUp(void)
{
    memset(&device, 0, sizeof device);
    memset(&job, 0, sizeof job);
    device.entries = 2;
    device.bits = 16;
}
void tearDown(void) {}

static void finish(cm1e_sdo_t *sdo, cm1e_error_t error, uint32_t abort_code)
{
    sdo->error = error;
    sdo->abort_code = abort_code;
    sdo->state = error == CM1E_OK ? CM1E_SDO_DONE : CM1E_SDO_ERROR;
}

static void write_assignment(cm1e_sdo_t *sdo)
{
    const int direction = sdo->index == OBJ_1C13_TXPDO_ASSIGN;
    const uint8_t *data = sdo->data;
    TEST_ASSERT_TRUE(direction || sdo->index == OBJ_1C12_RXPDO_ASSIGN);
    TEST_ASSERT_EQUAL_UINT(sdo->subindex ? 2 : 1, sdo->size);
    TEST_ASSERT_LESS_OR_EQUAL_UINT(CM1E_BRIDGE_AXES, sdo->subindex);
    const bool read_only = sdo->subindex ? device.places_read_only : device.count_read_only;
    if (read_only || (sdo->subindex && device.count[direction])) {
        finish(sdo, CM1E_ERROR_SDO_ABORT, ABORT_READ_ONLY);
        return;
    }
    if (sdo->subindex)
        device.pdos[direction][sdo->subindex - 1] = cm1e_get_u16(data);
    else
        device.count[direction] = data[0];
    finish(sdo, CM1E_OK, 0);
}

static void answer(cm1e_sdo_t *sdo, uint32_t value, size_t size)
{
    TEST_ASSERT_LESS_OR_EQUAL_size_t(sdo->size, size);
    cm1e_put_u32(sdo->data, value);
    sdo->size = size;
    finish(sdo, CM1E_OK, 0);
}

static void serve(cm1e_sdo_t *sdo)
{
    const int direction = sdo->index == OBJ_1C13_TXPDO_ASSIGN;
    if (sdo->write)
        write_assignment(sdo);
    else if (sdo->index >= OBJ_1C12_RXPDO_ASSIGN && sdo->subindex == 0)
        answer(sdo, device.count[direction], 1);
    else if (sdo->index >= OBJ_1C12_RXPDO_ASSIGN)
        answer(sdo, device.pdos[direction][sdo->subindex - 1], 2);
    else if (sdo->subindex == 0)
        answer(sdo, device.entries + device.unused, 1);
    else if (sdo->subindex > device.entries && device.absent)
        finish(sdo, CM1E_ERROR_SDO_ABORT, ABORT_NO_SUBINDEX);
    else if (sdo->subindex > device.entries)
        answer(sdo, 0, 4);
    else
        answer(sdo, (uint32_t)(sdo->index + 0x100 * sdo->subindex) << 16 | device.bits, 4);
}

static void serve_with_harm(cm1e_sdo_t *sdo)
{
    const harm_t harm = ++device.transfers == device.harm_at ? device.harm : NO_HARM;
    if (harm == ABORT)
        finish(sdo, CM1E_ERROR_SDO_ABORT, ABORT_READ_ONLY);
    else if (harm == TIMEOUT)
        finish(sdo, CM1E_ERROR_TIMEOUT, 0);
    else
        serve(sdo);
    if (sdo->write || sdo->state != CM1E_SDO_DONE)
        return;
    if (harm == OTHER_VALUE)
        cm1e_put_u32(sdo->data, cm1e_get_u32(sdo->data) ^ 0x5A5A5A02);
    else if (harm == SHORT || harm == EMPTY)
        sdo->size = harm == SHORT ? sdo->size - 1 : 0;
}

static void run(const cm1e_pdo_choice_t *choice)
{
    device.transfers = 0;
    cm1e_mapping_begin(&job, 7, choice);
    cm1e_sdo_t *sdo;
    while ((sdo = cm1e_mapping_next(&job)) != NULL) {
        TEST_ASSERT_EQUAL_UINT16(7, sdo->position);
        TEST_ASSERT_EQUAL(CM1E_SDO_BUSY, sdo->state);
        TEST_ASSERT_LESS_THAN_UINT(TRANSFERS_MAX, device.transfers);
        serve_with_harm(sdo);
    }
    TEST_ASSERT_TRUE(cm1e_mapping_idle(&job));
    TEST_ASSERT_NULL(cm1e_mapping_next(&job));
}

static void check_mapped(const cm1e_pdo_choice_t *choice)
{
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, job.error, job.reason);
    for (int direction = 0; direction < 2; direction++) {
        const cm1e_mapped_direction_t *mapped = &job.mapped[direction];
        TEST_ASSERT_EQUAL_UINT(choice->count * device.entries, mapped->entry_count);
        TEST_ASSERT_EQUAL_UINT(choice->count * device.entries * device.bits, mapped->bits);
        TEST_ASSERT_EQUAL_UINT(choice->count, device.count[direction]);
        for (unsigned i = 0; i < mapped->entry_count; i++) {
            const unsigned place = i / device.entries, entry = i % device.entries + 1;
            TEST_ASSERT_EQUAL_UINT(choice->pdos[direction][place], device.pdos[direction][place]);
            TEST_ASSERT_EQUAL_HEX16(choice->pdos[direction][place] + 0x100 * entry, mapped->entries[i].index);
            TEST_ASSERT_EQUAL_UINT(i * device.bits, mapped->entries[i].bit_offset);
        }
    }
}

static void test_every_number_of_pdos_is_assigned_and_read_back_in_order(void)
{
    for (uint8_t count = 1; count <= CM1E_BRIDGE_AXES; count++) {
        for (device.entries = 1; device.entries <= 16; device.entries++) {
            cm1e_pdo_choice_t choice = bridge;
            choice.count = count;
            run(&choice);
            check_mapped(&choice);
            TEST_ASSERT_EQUAL_UINT(2 * (2 + count) + 2 * (1 + count + count * (1 + device.entries)), device.transfers);
        }
    }
    device.entries = 2;
    run(&single);
    check_mapped(&single);
}

/** What recovery does: the job once more, with its own choice. */
static void test_same_choice_again_gives_the_same_layout(void)
{
    static cm1e_mapped_direction_t before[2];
    run(&bridge);
    memcpy(before, job.mapped, sizeof before);
    memset(device.pdos, 0, sizeof device.pdos);
    memset(device.count, 0, sizeof device.count);
    const cm1e_pdo_choice_t choice = job.choice;
    run(&choice);
    check_mapped(&bridge);
    TEST_ASSERT_TRUE(cm1e_mapping_equal(&before[0], &job.mapped[0]));
    TEST_ASSERT_TRUE(cm1e_mapping_equal(&before[1], &job.mapped[1]));
    device.bits = 32;
    run(&choice);
    TEST_ASSERT_FALSE(cm1e_mapping_equal(&before[0], &job.mapped[0]));
}

static void assign_right(void)
{
    for (int direction = 0; direction < 2; direction++) {
        device.count[direction] = bridge.count;
        memcpy(device.pdos[direction], bridge.pdos[direction], sizeof device.pdos[direction]);
    }
}

static void test_assignment_that_cannot_be_written_is_right_if_it_is_the_chosen_one(void)
{
    for (unsigned n = 1; n < 4; n++) {
        assign_right();
        device.count_read_only = n & 1;
        device.places_read_only = n & 2;
        run(&bridge);
        check_mapped(&bridge);
    }
}

static void test_assignment_that_cannot_be_written_and_is_another_is_the_refusal(void)
{
    for (unsigned n = 1; n < 4; n++) {
        for (unsigned wrong = 0; wrong <= CM1E_BRIDGE_AXES; wrong++) {
            assign_right();
            device.count_read_only = n & 1;
            device.places_read_only = n & 2;
            if (wrong < CM1E_BRIDGE_AXES)
                device.pdos[1][wrong] = 0x1A00;
            else
                device.count[1] = 3;
            run(&bridge);
            if (wrong == CM1E_BRIDGE_AXES && !device.count_read_only) {
                check_mapped(&bridge); /* its number was the only thing wrong */
                continue;
            }
            TEST_ASSERT_EQUAL(CM1E_ERROR_SDO_ABORT, job.error);
            TEST_ASSERT_TRUE(job.sdo.write);
            TEST_ASSERT_EQUAL_HEX32(ABORT_READ_ONLY, job.sdo.abort_code);
            TEST_ASSERT_EQUAL_HEX16(OBJ_1C12_RXPDO_ASSIGN, job.sdo.index); /* the first one */
            TEST_ASSERT_EQUAL_UINT(device.count_read_only ? 0 : 1, job.sdo.subindex);
        }
    }
}

/** Every transfer of the list with every harm: it ends, and it is right only if what was read is. */
static void test_harm_at_every_transfer_ends_defined(void)
{
    run(&bridge);
    const unsigned all = device.transfers;
    TEST_ASSERT_EQUAL_UINT(12 + 34, all);
    for (device.harm_at = 1; device.harm_at <= all; device.harm_at++) {
        for (device.harm = ABORT; device.harm < HARMS; device.harm++) {
            char message[64];
            snprintf(message, sizeof message, "transfer %u, harm %d", device.harm_at, (int)device.harm);
            memset(device.count, 0, sizeof device.count);
            memset(device.pdos, 0, sizeof device.pdos);
            run(&bridge);
            const bool write = device.harm_at <= 12;
            if (write && device.harm >= OTHER_VALUE) {
                check_mapped(&bridge); /* a write has no answer to be harmed */
            } else if (device.harm == TIMEOUT) {
                TEST_ASSERT_EQUAL_MESSAGE(CM1E_ERROR_TIMEOUT, job.error, message);
                TEST_ASSERT_EQUAL_UINT_MESSAGE(device.harm_at, device.transfers, message);
            } else if (device.harm == ABORT) {
                /* The number that was to be cleared was 0 already: nothing was lost. */
                const bool cleared = device.harm_at == 1 || device.harm_at == 7;
                TEST_ASSERT_EQUAL_MESSAGE(cleared ? CM1E_OK : CM1E_ERROR_SDO_ABORT, job.error, message);
            } else if (job.error == CM1E_OK) { /* another entry: the layout is what the device says */
                TEST_ASSERT_TRUE_MESSAGE(device.harm == OTHER_VALUE, message);
            } else {
                TEST_ASSERT_NOT_NULL_MESSAGE(job.reason, message);
                TEST_ASSERT_EQUAL_MESSAGE(CM1E_ERROR_PDO_MAPPING, job.error, message);
            }
        }
    }
}

static void test_too_many_entries_and_entries_of_no_bits_are_refused(void)
{
    device.entries = CM1E_MAPPED_ENTRIES / CM1E_BRIDGE_AXES;
    run(&bridge);
    check_mapped(&bridge);
    device.entries++;
    run(&bridge);
    TEST_ASSERT_EQUAL(CM1E_ERROR_PDO_MAPPING, job.error);
    device.entries = 255;
    run(&single);
    TEST_ASSERT_EQUAL(CM1E_ERROR_PDO_MAPPING, job.error);
    device.entries = 0;
    run(&single);
    TEST_ASSERT_EQUAL(CM1E_ERROR_PDO_MAPPING, job.error);
    device.entries = 1;
    device.bits = 0;
    run(&single);
    TEST_ASSERT_EQUAL(CM1E_ERROR_PDO_MAPPING, job.error);
    device.entries = 16;
    device.bits = 255;
    run(&bridge);
    TEST_ASSERT_EQUAL(CM1E_ERROR_PDO_MAPPING, job.error); /* 2,040 bytes */
}

/* The tables of UG 7.2 state up to two rows more than they have. */
static void test_rows_that_are_stated_and_not_used_are_passed_over(void)
{
    for (unsigned unused = 1; unused <= 3; unused++) {
        device.unused = unused;
        for (int absent = 0; absent < 2; absent++) {
            device.absent = absent;
            run(&bridge);
            check_mapped(&bridge);
            run(&single);
            check_mapped(&single);
        }
    }
    device.entries = 0; /* nothing but such rows */
    device.absent = false;
    run(&single);
    TEST_ASSERT_EQUAL(CM1E_ERROR_PDO_MAPPING, job.error);
    TEST_ASSERT_EQUAL_STRING("its PDO is empty", job.reason);
    device.absent = true;
    run(&single);
    TEST_ASSERT_EQUAL(CM1E_ERROR_SDO_ABORT, job.error);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_number_of_pdos_is_assigned_and_read_back_in_order);
    RUN_TEST(test_same_choice_again_gives_the_same_layout);
    RUN_TEST(test_assignment_that_cannot_be_written_is_right_if_it_is_the_chosen_one);
    RUN_TEST(test_assignment_that_cannot_be_written_and_is_another_is_the_refusal);
    RUN_TEST(test_harm_at_every_transfer_ends_defined);
    RUN_TEST(test_rows_that_are_stated_and_not_used_are_passed_over);
    RUN_TEST(test_too_many_entries_and_entries_of_no_bits_are_refused);
    return UNITY_END();
}
