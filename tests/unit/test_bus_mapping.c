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
    uint16_t pdos[2][CM1E_ASSIGNED_PDOS + 1];
    bool count_read_only, places_read_only;
    bool no_assignment;          /**< it has neither 0x1C12 nor 0x1C13 */
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
    else if (sdo->index >= OBJ_1C12_RXPDO_ASSIGN && device.no_assignment)
        finish(sdo, CM1E_ERROR_SDO_ABORT, ABORT_READ_ONLY);
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
        answer(sdo, (uint32_t)(sdo->index + 0x100 * sdo->subindex) << 16 | (uint32_t)sdo->subindex << 8 | device.bits,
               4);
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

static void run_begun(void)
{
    cm1e_sdo_t *sdo;
    device.transfers = 0;
    TEST_ASSERT_FALSE(cm1e_mapping_idle(&job));
    while ((sdo = cm1e_mapping_next(&job)) != NULL) {
        TEST_ASSERT_EQUAL_UINT16(7, sdo->position);
        TEST_ASSERT_EQUAL(CM1E_SDO_BUSY, sdo->state);
        TEST_ASSERT_LESS_THAN_UINT(TRANSFERS_MAX, device.transfers);
        serve_with_harm(sdo);
    }
    TEST_ASSERT_TRUE(cm1e_mapping_idle(&job));
    TEST_ASSERT_NULL(cm1e_mapping_next(&job));
}

static void run(const cm1e_pdo_choice_t *choice)
{
    cm1e_mapping_begin(&job, 7, choice);
    run_begun();
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
            TEST_ASSERT_EQUAL_UINT(entry, mapped->entries[i].subindex);
            TEST_ASSERT_EQUAL_UINT(device.bits, mapped->entries[i].bits);
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
        memset(device.pdos[direction], 0, sizeof device.pdos[direction]);
        memcpy(device.pdos[direction], bridge.pdos[direction], sizeof bridge.pdos[direction]);
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

static void expect_refused(const cm1e_pdo_choice_t *choice, unsigned entries, unsigned bits, const char *reason)
{
    device.entries = entries;
    device.bits = (uint8_t)bits;
    run(choice);
    TEST_ASSERT_EQUAL(CM1E_ERROR_PDO_MAPPING, job.error);
    TEST_ASSERT_EQUAL_STRING(reason, job.reason);
}

static void test_too_many_entries_and_entries_of_no_bits_are_refused(void)
{
    static const char *const too_many = "its PDO has too many entries or an entry of no bits";
    static const struct {
        const cm1e_pdo_choice_t *choice;
        unsigned entries, bits;
    } most[] = {{&bridge, CM1E_MAPPED_ENTRIES / CM1E_BRIDGE_AXES, 16}, {&single, CM1E_MAPPED_ENTRIES, 1},
                {&bridge, 16, 128} /* 1,024 bytes */};
    for (size_t i = 0; i < sizeof most / sizeof most[0]; i++) {
        device.entries = most[i].entries;
        device.bits = (uint8_t)most[i].bits;
        run(most[i].choice);
        check_mapped(most[i].choice);
    }
    expect_refused(&bridge, CM1E_MAPPED_ENTRIES / CM1E_BRIDGE_AXES + 1, 16, too_many);
    expect_refused(&single, CM1E_MAPPED_ENTRIES + 1, 1, too_many);
    expect_refused(&single, 255, 16, too_many);
    expect_refused(&single, 1, 0, too_many);
    expect_refused(&bridge, 16, 255, too_many); /* 2,040 bytes */
    expect_refused(&single, 41, 200, too_many); /* 1,025 bytes */
    device.absent = true;
    expect_refused(&single, 0, 16, "its PDO is empty");
}

/* The tables of UG 7.2 state up to two rows more than they have. */
static void test_rows_that_are_stated_and_not_used_are_passed_over(void)
{
    for (unsigned n = 0; n < 3 * 2 * 2; n++) {
        device.unused = 1 + n % 3;
        device.absent = n / 3 % 2;
        device.entries = 1 + n / 6;
        const unsigned rows = device.entries + (device.absent ? 1 : device.unused); /* behind the first none is read */
        run(&bridge);
        check_mapped(&bridge);
        TEST_ASSERT_EQUAL_UINT(12 + 2 * (1 + 4 * (2 + rows)), device.transfers);
        run(&single);
        check_mapped(&single);
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

/** What the device has assigned itself, in the object of the sync manager that has the direction. */
static void assign_own(unsigned outputs, unsigned inputs, bool swapped)
{
    const unsigned counts[2] = {outputs, inputs};
    for (int direction = 0; direction < 2; direction++) {
        const int object = direction ^ (int)swapped;
        device.count[object] = (uint8_t)counts[direction];
        for (unsigned i = 0; i <= CM1E_ASSIGNED_PDOS; i++)
            device.pdos[object][i] = (uint16_t)((direction ? 0x1A00 : 0x1600) + i);
    }
}

static void check_own(int direction, unsigned count)
{
    const cm1e_mapped_direction_t *mapped = &job.mapped[direction];
    TEST_ASSERT_EQUAL_UINT(count * device.entries, mapped->entry_count);
    TEST_ASSERT_EQUAL_UINT(count * device.entries * device.bits, mapped->bits);
    for (unsigned i = 0; i < mapped->entry_count; i++) {
        const unsigned pdo = (direction ? 0x1A00u : 0x1600u) + i / device.entries;
        TEST_ASSERT_EQUAL_HEX16(pdo + 0x100 * (i % device.entries + 1), mapped->entries[i].index);
        TEST_ASSERT_EQUAL_UINT(i * device.bits, mapped->entries[i].bit_offset);
    }
}

/** Every slave may have its own assignment, which may be empty in a direction; a drive needs process data in both. */
static void test_own_assignment_is_read_as_it_is(void)
{
    for (unsigned n = 0; n < 5 * 5 * 3 * 3; n++) {
        const unsigned outputs = n % 5, inputs = n / 5 % 5, reader = n / 75; /* a drive, a slave, a swapped one */
        device.entries = n / 25 % 3;
        assign_own(outputs, inputs, reader == 2);
        if (reader == 0)
            cm1e_mapping_begin(&job, 7, &(cm1e_pdo_choice_t){0});
        else
            cm1e_mapping_begin_any(&job, 7, reader == 2);
        run_begun();
        if (reader == 0 && (outputs == 0 || inputs == 0 || device.entries == 0)) {
            const bool none = outputs == 0 || (device.entries > 0 && inputs == 0);
            TEST_ASSERT_EQUAL(CM1E_ERROR_PDO_MAPPING, job.error);
            TEST_ASSERT_EQUAL_STRING(none ? "it has no PDO assigned; name PDOs in the bus file" : "its PDO is empty",
                                     job.reason);
            continue;
        }
        TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, job.error, job.reason);
        TEST_ASSERT_EQUAL_UINT(0, job.unknown);
        TEST_ASSERT_EQUAL_UINT(2 + (outputs + inputs) * (2 + device.entries), device.transfers);
        check_own(0, outputs);
        check_own(1, inputs);
    }
}

static void test_own_assignment_of_more_pdos_than_there_is_room_for_is_refused(void)
{
    for (unsigned more = 0; more < 2; more++) {
        for (int any = 0; any < 2; any++) {
            assign_own(CM1E_ASSIGNED_PDOS, CM1E_ASSIGNED_PDOS + more, false);
            if (any)
                cm1e_mapping_begin_any(&job, 7, false);
            else
                cm1e_mapping_begin(&job, 7, &(cm1e_pdo_choice_t){0});
            run_begun();
            TEST_ASSERT_EQUAL(more ? CM1E_ERROR_PDO_MAPPING : CM1E_OK, job.error);
            if (more)
                TEST_ASSERT_EQUAL_STRING("it has more PDOs assigned than are understood; name PDOs in the bus file",
                                         job.reason);
        }
    }
}

/** A slave without these objects has the process data of its SII. */
static void test_assignment_that_cannot_be_read_is_unknown(void)
{
    device.no_assignment = true;
    cm1e_mapping_begin_any(&job, 7, false);
    run_begun();
    TEST_ASSERT_EQUAL(CM1E_OK, job.error);
    TEST_ASSERT_EQUAL_UINT(2, job.unknown);
    TEST_ASSERT_EQUAL_UINT(0, job.mapped[0].entry_count + job.mapped[1].entry_count);
    cm1e_mapping_begin(&job, 7, &(cm1e_pdo_choice_t){0});
    run_begun();
    TEST_ASSERT_EQUAL(CM1E_ERROR_SDO_ABORT, job.error);
    device.no_assignment = false;
    assign_own(1, 1, false);
    for (device.harm_at = 1; device.harm_at <= 10; device.harm_at++) { /* only the two counts may be refused */
        device.harm = ABORT;
        cm1e_mapping_begin_any(&job, 7, false);
        run_begun();
        const bool of_count = device.harm_at == 1 || device.harm_at == 6;
        TEST_ASSERT_EQUAL(of_count ? CM1E_OK : CM1E_ERROR_SDO_ABORT, job.error);
        TEST_ASSERT_EQUAL_UINT(of_count, job.unknown);
        for (int direction = 0; direction < 2 && of_count; direction++)
            check_own(direction, device.harm_at == (direction ? 6 : 1) ? 0 : 1);
        device.harm = TIMEOUT;
        cm1e_mapping_begin_any(&job, 7, false);
        run_begun();
        TEST_ASSERT_EQUAL(CM1E_ERROR_TIMEOUT, job.error);
    }
}

/** Two layouts are equal only if all of it is; what the axes use lies in whole bytes. */
static void test_layouts_are_compared_and_searched_entry_by_entry(void)
{
    static const cm1e_mapped_direction_t right = {
        .bits = 88, .entry_count = 6,
        .entries = {{0x6040, 0, 0, 16}, {0x60FF, 16, 0, 32}, {0x6060, 48, 0, 8}, {0x7000, 56, 1, 4}, {0x7000, 60, 2, 8},
                    {0, 80, 0, 8}}};
    static const struct {
        uint16_t index;
        uint8_t subindex;
        int found; /* -1: not */
    } rows[] = {{0x6040, 0, 0}, {0x60FF, 0, 1}, {0x6060, 0, 2}, {0x6060, 1, -1}, {0x7000, 1, -1}, {0x7000, 2, -1},
                {0, 0, -1}, {0x6041, 0, -1}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const cm1e_mapped_entry_t *found = cm1e_mapping_find(&right, rows[i].index, rows[i].subindex);
        TEST_ASSERT_TRUE(found == (rows[i].found < 0 ? NULL : &right.entries[rows[i].found]));
    }
    const cm1e_mapped_direction_t wide = {.bits = 64, .entry_count = 1, .entries = {{0x6064, 0, 0, 64}}};
    TEST_ASSERT_NULL(cm1e_mapping_find(&wide, 0x6064, 0));
    TEST_ASSERT_TRUE(cm1e_mapping_equal(&right, &right));
    for (int part = 0; part < 5; part++) {
        for (unsigned i = 0; i < right.entry_count; i++) {
            cm1e_mapped_direction_t other = right;
            other.bits ^= part == 0;
            other.entry_count = (uint8_t)(other.entry_count - (part == 1));
            other.entries[i].index ^= part == 2;
            other.entries[i].subindex ^= part == 3;
            other.entries[i].bits ^= part == 4;
            TEST_ASSERT_FALSE(cm1e_mapping_equal(&right, &other));
        }
    }
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_own_assignment_is_read_as_it_is);
    RUN_TEST(test_own_assignment_of_more_pdos_than_there_is_room_for_is_refused);
    RUN_TEST(test_assignment_that_cannot_be_read_is_unknown);
    RUN_TEST(test_layouts_are_compared_and_searched_entry_by_entry);
    RUN_TEST(test_every_number_of_pdos_is_assigned_and_read_back_in_order);
    RUN_TEST(test_same_choice_again_gives_the_same_layout);
    RUN_TEST(test_assignment_that_cannot_be_written_is_right_if_it_is_the_chosen_one);
    RUN_TEST(test_assignment_that_cannot_be_written_and_is_another_is_the_refusal);
    RUN_TEST(test_harm_at_every_transfer_ends_defined);
    RUN_TEST(test_rows_that_are_stated_and_not_used_are_passed_over);
    RUN_TEST(test_too_many_entries_and_entries_of_no_bits_are_refused);
    return UNITY_END();
}
