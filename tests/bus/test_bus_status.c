/* What `cm1e status` reads and says of a motor whose objects are not as the guide has them. */
#include "bus_support.h"
#include "device/objects.h"
#include "status_drive.h"

enum { STATE = 0, MODE = 2, POSITION, TORQUE, SUPPLY = 6 };

static drive_status_t drive;

/** In answers to a read of an object: its size, or an abort in place of its value. */
typedef struct change {
    uint16_t index;
    uint8_t bytes;
    bool abort;
} change_t;

static cm1e_tap_verdict_t change_answer(void *context, cm1e_tap_frame_t *frame)
{
    const change_t *change = context;
    uint8_t *sdo = frame->bytes + 26 + 6; /* Ethernet, EtherCAT and datagram header; mailbox header */
    const bool mailbox = frame->direction == CM1E_TAP_RECEIVED && frame->bytes[16] == 4 && frame->length > 100;
    if (!mailbox || cm1e_get_u16(sdo) >> 12 != 3 || cm1e_get_u16(sdo + 3) != change->index || (sdo[2] & 0xE2) != 0x42)
        return CM1E_TAP_PASS;
    if (change->abort) {
        cm1e_put_u16(sdo, 2 << 12);
        sdo[2] = 0x80;
        cm1e_put_u32(sdo + 6, 0x06020000);
    } else {
        sdo[2] = (uint8_t)(0x43 | (4 - change->bytes) << 2);
    }
    return CM1E_TAP_PASS;
}

static bool read_changed(change_t change)
{
    sim_config(1);
    cm1e_bus_t *bus = open_bus();
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), change_answer, &change);
    const bool readable = read_drive(bus, 1, &drive, &diag);
    cm1e_bus_close(bus);
    return readable;
}

static const char *said(int i)
{
    static char text[DRIVE_TEXT_BYTES];
    return drive_text(&drive, i, text, sizeof text);
}

START_TEST(everything_is_read_from_a_motor)
{
    ck_assert(read_changed((change_t){0}));
    for (int i = 0; i < DRIVE_READINGS; i++) {
        ck_assert(drive.readings[i].valid);
        ck_assert_ptr_null(strstr(said(i), "in the guide"));
    }
    ck_assert_str_eq(drive_label(&drive, SUPPLY), "motor supply");
    ck_assert(strstr(said(SUPPLY), " V") && atof(said(SUPPLY)) > 20);
}
END_TEST

START_TEST(object_of_another_size_is_shown_with_it)
{
    ck_assert(read_changed((change_t){.index = OBJ_6079_DC_LINK_VOLTAGE, .bytes = 2}));
    ck_assert_msg(strstr(said(SUPPLY), " V (2 bytes; in the guide 4)") && atof(said(SUPPLY)) > 20, "%s", said(SUPPLY));
    ck_assert(read_changed((change_t){.index = OBJ_6077_TORQUE_ACTUAL_VALUE, .bytes = 4}));
    ck_assert_str_eq(said(TORQUE), "0.0 % of rated (4 bytes; in the guide 2)");
    ck_assert(read_changed((change_t){.index = OBJ_6041_STATUSWORD, .bytes = 4}));
    ck_assert_msg(strstr(said(STATE), "(4 bytes; in the guide 2)") != NULL, "%s", said(STATE));
}
END_TEST

START_TEST(what_cannot_be_read_says_why)
{
    ck_assert(read_changed((change_t){.index = OBJ_6064_POSITION_ACTUAL_VALUE, .abort = true}));
    ck_assert_msg(strstr(said(POSITION), "not readable: SDO abort 0x06020000, ") != NULL, "%s", said(POSITION));
    ck_assert(drive.readings[TORQUE].valid);
    ck_assert(read_changed((change_t){.index = OBJ_6061_MODES_OF_OPERATION_DISPLAY, .abort = true}));
    ck_assert_msg(strstr(said(MODE), "not readable") != NULL, "%s", said(MODE)); /* and not "no mode selected" */
    ck_assert(!read_changed((change_t){.index = OBJ_6041_STATUSWORD, .abort = true}));
    ck_assert_msg(strstr(said(STATE), "not readable") != NULL, "%s", said(STATE));
    ck_assert_msg(strstr(diag.text, "0x6041") != NULL, "%s", diag.text);
    json_t *json = drive_status_as_json(&(cm1e_slave_info_t){.position = 1}, &drive);
    ck_assert(json_is_null(json_object_get(json, "state")) && json_is_null(json_object_get(json, "statusword")));
    ck_assert(json_is_real(json_object_get(json, "dc_link_volt")));
    json_decref(json);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_status");
    TCase *tests = tcase_create("status");
    tcase_add_test(tests, everything_is_read_from_a_motor);
    tcase_add_test(tests, object_of_another_size_is_shown_with_it);
    tcase_add_test(tests, what_cannot_be_read_says_why);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
