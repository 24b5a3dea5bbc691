/* SDO information of the simulated CM1-E over the bus: the dictionary that it tells is that of the device tables. */
#include "bus_support.h"
#include "cm1e/sdo_info.h"

enum { OBJECTS_MAX = 512 };

static uint16_t indexes[OBJECTS_MAX];

static cm1e_firmware_t firmware(void) { return cm1e_firmware_from_version(tested_firmware())->firmware; }

START_TEST(the_list_holds_every_object_of_the_firmware)
{
    cm1e_bus_t *bus = open_scanned_bus(2);
    size_t count, told = OBJECTS_MAX, n = 0;
    const cm1e_object_t *objects = cm1e_device_objects(&count);
    ck_assert_msg(cm1e_sdo_info_list(bus, 2, CM1E_OBJECTS_ALL, indexes, &told, &diag) == CM1E_OK, "%s", diag.text);
    for (size_t i = 0; i < count; i++)
        if (objects[i].since <= firmware())
            ck_assert_uint_eq(indexes[n++], objects[i].index);
    ck_assert_uint_eq(n, told);
    size_t room = told - 1;
    ck_assert_int_eq(cm1e_sdo_info_list(bus, 2, CM1E_OBJECTS_ALL, indexes, &room, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_ptr_nonnull(strstr(diag.text, "room for"));
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(the_lists_of_mappable_objects_are_shorter)
{
    cm1e_bus_t *bus = open_scanned_bus(1);
    size_t sizes[6];
    for (int list = CM1E_OBJECTS_ALL; list <= CM1E_OBJECTS_SETTINGS; list++) {
        sizes[list] = OBJECTS_MAX;
        ck_assert_int_eq(cm1e_sdo_info_list(bus, 1, (cm1e_info_list_t)list, indexes, &sizes[list], &diag), CM1E_OK);
    }
    ck_assert(sizes[CM1E_OBJECTS_RXPDO] > 3 && sizes[CM1E_OBJECTS_TXPDO] > 3);
    ck_assert(sizes[CM1E_OBJECTS_RXPDO] < sizes[CM1E_OBJECTS_ALL] && sizes[CM1E_OBJECTS_BACKUP] == 0);
    cm1e_bus_close(bus);
}
END_TEST

static void check_entry(cm1e_bus_t *bus, const cm1e_entry_t *entry)
{
    cm1e_entry_info_t info;
    const cm1e_error_t error = cm1e_sdo_info_entry(bus, 1, entry->index, entry->subindex, &info, &diag);
    if (error == CM1E_ERROR_SDO_ABORT) { /* what the firmware does not have (UG 10.1) */
        ck_assert(entry->since > firmware() || entry->index == 0x1603 || entry->index == 0x1A03);
        return;
    }
    ck_assert_msg(error == CM1E_OK, "%s", diag.text);
    ck_assert(info.index == entry->index && info.subindex == entry->subindex);
    ck_assert_uint_eq(info.data_type, entry->type);
    ck_assert_uint_eq(info.bits, entry->bits);
    ck_assert_int_eq((info.access & CM1E_INFO_READ_OP) != 0, (entry->access & CM1E_ACCESS_READ) != 0);
    ck_assert_int_eq((info.access & CM1E_INFO_WRITE_PREOP) != 0, (entry->access & CM1E_ACCESS_WRITE) != 0);
    ck_assert_int_eq((info.access & CM1E_INFO_RXPDO) != 0, (entry->access & CM1E_ACCESS_RXPDO) != 0);
    ck_assert_int_eq((info.access & CM1E_INFO_TXPDO) != 0, (entry->access & CM1E_ACCESS_TXPDO) != 0);
    if (entry->type != CM1E_TYPE_STRING) {
        ck_assert_uint_eq(info.maximum.size, entry->bits / 8);
        ck_assert(cm1e_get_uint(info.maximum.bytes, 8) ==
                  ((uint64_t)entry->maximum & (UINT64_MAX >> (64 - entry->bits))));
    }
}

START_TEST(every_object_and_entry_is_described_as_in_the_tables)
{
    cm1e_bus_t *bus = open_scanned_bus(1);
    size_t count;
    const cm1e_object_t *objects = cm1e_device_objects(&count);
    for (size_t i = 0; i < count; i++) {
        cm1e_object_info_t info;
        if (objects[i].since > firmware())
            continue;
        ck_assert_int_eq(cm1e_sdo_info_object(bus, 1, objects[i].index, &info, &diag), CM1E_OK);
        ck_assert_uint_eq(info.index, objects[i].index);
        ck_assert_uint_eq(info.code, objects[i].object_code);
        ck_assert_uint_eq(info.highest_subindex, objects[i].highest_subindex);
        ck_assert_str_eq(info.name, objects[i].name);
        for (unsigned n = 0; n < objects[i].entry_count; n++)
            check_entry(bus, &objects[i].entries[n]);
    }
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(what_is_not_there_is_named)
{
    cm1e_object_info_t object;
    cm1e_entry_info_t entry;
    size_t room = OBJECTS_MAX;
    cm1e_bus_t *bus = open_scanned_bus(1);
    ck_assert_int_eq(cm1e_sdo_info_object(bus, 1, 0x5FFF, &object, &diag), CM1E_ERROR_SDO_ABORT);
    ck_assert_msg(strstr(diag.text, "0x5FFF") && strstr(diag.text, "does not exist"), "%s", diag.text);
    ck_assert_int_eq(cm1e_sdo_info_entry(bus, 1, 0x1018, 9, &entry, &diag), CM1E_ERROR_SDO_ABORT);
    ck_assert_msg(strstr(diag.text, "0x1018:09") != NULL, "%s", diag.text);
    ck_assert_int_eq(cm1e_sdo_info_object(bus, 2, 0x1000, &object, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_sdo_info_list(bus, 1, CM1E_OBJECTS_ALL, NULL, &room, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_sdo_info_list(bus, 1, (cm1e_info_list_t)0, indexes, &room, &diag),
                     CM1E_ERROR_INVALID_ARGUMENT);
    cm1e_bus_close(bus);
    bus = open_bus();
    ck_assert_int_eq(cm1e_sdo_info_list(bus, 1, CM1E_OBJECTS_ALL, indexes, &room, &diag), CM1E_ERROR_STATE);
    cm1e_bus_close(bus);
}
END_TEST

/** One frame lost, whichever: the answers are the same. */
static unsigned lost, seen;
static cm1e_tap_verdict_t lose_one(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    return frame->direction == CM1E_TAP_RECEIVED && seen++ == lost ? CM1E_TAP_DROP : CM1E_TAP_PASS;
}

START_TEST(a_lost_frame_changes_no_answer)
{
    static uint16_t again[OBJECTS_MAX];
    cm1e_bus_t *bus = open_scanned_bus(1);
    size_t count = OBJECTS_MAX;
    ck_assert_int_eq(cm1e_sdo_info_list(bus, 1, CM1E_OBJECTS_ALL, indexes, &count, &diag), CM1E_OK);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), lose_one, NULL);
    for (lost = 0, seen = 1; seen > lost; lost++) {
        size_t n = OBJECTS_MAX;
        seen = 0;
        ck_assert_msg(cm1e_sdo_info_list(bus, 1, CM1E_OBJECTS_ALL, again, &n, &diag) == CM1E_OK, "%s", diag.text);
        ck_assert_uint_eq(n, count);
        ck_assert_mem_eq(again, indexes, 2 * n);
    }
    ck_assert_uint_gt(lost, 3);
    cm1e_bus_close(bus);
}
END_TEST

/** In operation, too, while nobody else runs the cycle. */
START_TEST(transfers_and_descriptions_take_turns)
{
    sim_config(1);
    cm1e_bus_t *bus = start_bus();
    uint8_t value[4];
    cm1e_sdo_t sdo = {.position = 1, .index = 0x1000, .data = value, .size = sizeof value};
    ck_assert_int_eq(cm1e_sdo_submit(bus, &sdo), CM1E_OK);
    size_t count = OBJECTS_MAX;
    ck_assert_msg(cm1e_sdo_info_list(bus, 1, CM1E_OBJECTS_ALL, indexes, &count, &diag) == CM1E_OK, "%s", diag.text);
    finish_sdo(bus, &sdo);
    ck_assert_int_eq(cm1e_sdo_state(&sdo), CM1E_SDO_DONE);
    ck_assert_uint_eq(cm1e_bus_counters(bus)->working_counter_errors, 0);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- answers that are too short ---------------------------------------------------------------------------------- */

enum { COMMAND_FPRD_OF_FRAME = 4, MESSAGE_AT = 26, BODY = 6, SERVICE_INFORMATION = 8, HEADER_OF_INFORMATION = 6 };
static unsigned bytes_left; /* of the first answer; behind its header */

static cm1e_tap_verdict_t cut_short(void *context, cm1e_tap_frame_t *frame)
{
    unsigned *answers = context;
    uint8_t *message = frame->bytes + MESSAGE_AT;
    const bool mailbox = frame->direction == CM1E_TAP_RECEIVED && frame->bytes[16] == COMMAND_FPRD_OF_FRAME &&
                         frame->length > 100 && (message[5] & 0x0F) == 3;
    if (mailbox && cm1e_get_u16(message + BODY) >> 12 == SERVICE_INFORMATION && (*answers)++ == 0)
        cm1e_put_u16(message, (uint16_t)(HEADER_OF_INFORMATION + bytes_left));
    return CM1E_TAP_PASS;
}

static cm1e_error_t ask_object(cm1e_bus_t *bus)
{
    cm1e_object_info_t info;
    return cm1e_sdo_info_object(bus, 1, 0x1018, &info, &diag);
}

static cm1e_error_t ask_list(cm1e_bus_t *bus)
{
    size_t room = OBJECTS_MAX;
    return cm1e_sdo_info_list(bus, 1, CM1E_OBJECTS_ALL, indexes, &room, &diag);
}

static cm1e_error_t ask_entry(cm1e_bus_t *bus)
{
    cm1e_entry_info_t info;
    return cm1e_sdo_info_entry(bus, 1, 0x1018, 1, &info, &diag);
}

/** What is too short to say what it is about is no answer, and the right one does not come; a description that ends in the
 *  middle is told as such. An entry whose values are not there is asked for again without them. */
START_TEST(an_answer_that_is_cut_short_is_told_and_the_next_one_is_right)
{
    static const struct {
        cm1e_error_t (*ask)(cm1e_bus_t *bus);
        unsigned answer, whole; /* bytes from which on it is an answer, and a whole one */
        const char *words;
    } rows[] = {
        {ask_object, 2, 6, "Slave 1: its description of an object is shorter than it says."},
        {ask_entry, 3, 3, ""},
        {ask_list, 2, 100, "Slave 1: its description of its objects is shorter than it says."},
    };
    cm1e_bus_t *bus = open_scanned_bus(1);
    for (bytes_left = 0; bytes_left < 12; bytes_left++) {
        unsigned answers = 0;
        const bool is_list = rows[_i].ask == ask_list;
        const bool whole = is_list ? bytes_left >= 2 && bytes_left % 2 == 0 : bytes_left >= rows[_i].whole;
        cm1e_nic_set_tap(cm1e_bus_nic(bus), cut_short, &answers);
        const cm1e_error_t error = rows[_i].ask(bus);
        if (bytes_left < rows[_i].answer)
            ck_assert_msg(error == CM1E_ERROR_TIMEOUT || (is_list && error == CM1E_ERROR_BUS_MAILBOX), "%u: %s",
                          bytes_left, cm1e_strerror(error));
        else
            ck_assert_msg(error == (whole ? CM1E_OK : CM1E_ERROR_BUS_MAILBOX), "%u: %s", bytes_left, diag.text);
        if (bytes_left >= rows[_i].answer && !whole)
            ck_assert_str_eq(diag.text, rows[_i].words);
        ck_assert_uint_ge(answers, 1);
        cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
        ck_assert_msg(rows[_i].ask(bus) == CM1E_OK, "%u: %s", bytes_left, diag.text);
    }
    cm1e_bus_close(bus);
}
END_TEST

/** Every answer to a question for an entry is cut, so that asking without the values does not help. */
static cm1e_tap_verdict_t cut_all(void *context, cm1e_tap_frame_t *frame)
{
    unsigned none = 0;
    (void)context;
    return cut_short(&none, frame);
}

START_TEST(an_entry_that_is_never_whole_is_told)
{
    cm1e_bus_t *bus = open_scanned_bus(1);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), cut_all, NULL);
    for (bytes_left = 3; bytes_left < 10; bytes_left++) {
        ck_assert_int_eq(ask_entry(bus), CM1E_ERROR_BUS_MAILBOX);
        ck_assert_str_eq(diag.text, "Slave 1: its description of a sub-index is shorter than it says.");
    }
    bytes_left = 10; /* without values it is a description, though it has no name */
    ck_assert_msg(ask_entry(bus) == CM1E_OK, "%s", diag.text);
    cm1e_bus_close(bus);
}
END_TEST

/** A transfer of another part of the program has the mailbox. */
START_TEST(a_description_waits_for_a_transfer_that_is_under_way)
{
    sim_config(1);
    cm1e_bus_t *bus = start_bus();
    uint8_t data[4];
    for (unsigned at = 0; at < 12; at++) {
        cm1e_sdo_t sdo = {.position = 1, .index = 0x1018, .subindex = 1, .data = data, .size = sizeof data};
        ck_assert_int_eq(cm1e_sdo_submit(bus, &sdo), CM1E_OK);
        for (unsigned n = 0; n < at; n++)
            cycle(bus);
        ck_assert_msg(ask_object(bus) == CM1E_OK, "%s", diag.text);
        ck_assert(at == 0 || cm1e_sdo_state(&sdo) == CM1E_SDO_DONE); /* 0: the transfer had not begun */
        finish_sdo(bus, &sdo);
        ck_assert_int_eq(cm1e_sdo_state(&sdo), CM1E_SDO_DONE);
        ck_assert_uint_eq(cm1e_get_u32(data), CM1E_VENDOR_ID);
    }
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_dictionary");
    TCase *cases = tcase_create("information");
    tcase_add_test(cases, the_list_holds_every_object_of_the_firmware);
    tcase_add_test(cases, the_lists_of_mappable_objects_are_shorter);
    tcase_add_test(cases, every_object_and_entry_is_described_as_in_the_tables);
    tcase_add_test(cases, what_is_not_there_is_named);
    tcase_add_test(cases, a_lost_frame_changes_no_answer);
    tcase_add_test(cases, transfers_and_descriptions_take_turns);
    tcase_add_loop_test(cases, an_answer_that_is_cut_short_is_told_and_the_next_one_is_right, 0, 3);
    tcase_add_test(cases, an_entry_that_is_never_whole_is_told);
    tcase_add_test(cases, a_description_waits_for_a_transfer_that_is_under_way);
    suite_add_tcase(suite, cases);
    return run_suite(suite);
}
