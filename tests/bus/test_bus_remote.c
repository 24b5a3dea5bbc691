/* A network that another program runs, seen through a table of functions: whatever that program answers, a call ends in
 * the error and the words for it. */
#include "bus/remote.h"
#include "bus_support.h"
#include "cm1e/esc.h"
#include "cm1e/sdo_info.h"
#include "description/sii_image.h"
#include "device/devices.h"

enum { SLAVES = 3, WITHOUT_COE = 3, KBIT_AT = 0x7C };

/** What the other program answers. */
static struct program {
    cm1e_error_t error;   /* it cannot be asked */
    cm1e_error_t outcome; /* of a transfer or an errand that it has made */
    unsigned fails_at;    /* number of the errand from which on `error` and `outcome` are; 0: always */
    uint16_t kbit;        /* word 0x3E of every SII */
    size_t info_bytes;    /* of a description */
    unsigned errands, closed;
    size_t bytes; /* of all errands */
    const char *kind;
    cm1e_device_model_t model;
} program;

static cm1e_error_t refused(cm1e_diag_t *told) { return cm1e_diag_set(told, program.error, 0, "The program says no."); }

static cm1e_error_t scan(void *state, cm1e_remote_slave_t *slaves, uint32_t room, uint32_t *count,
                         cm1e_remote_network_t *network, cm1e_diag_t *told)
{
    (void)state, (void)network;
    if (program.error != CM1E_OK)
        return refused(told);
    ck_assert_uint_ge(room, SLAVES);
    for (uint32_t i = 0; i < SLAVES; i++) {
        slaves[i] = (cm1e_remote_slave_t){.info = {.position = (uint16_t)(i + 1), .vendor_id = 0x99}};
        slaves[i].info.model = program.model;
        slaves[i].coe = i + 1 != WITHOUT_COE;
        snprintf(slaves[i].kind, sizeof slaves[i].kind, "%s", program.kind);
    }
    *count = SLAVES;
    return CM1E_OK;
}

static cm1e_error_t transfer(void *state, cm1e_sdo_t *sdo, cm1e_diag_t *told)
{
    (void)state;
    sdo->error = program.outcome;
    return program.error == CM1E_OK ? CM1E_OK : refused(told);
}

static cm1e_error_t run_errand(void *state, cm1e_errand_t *errand, cm1e_diag_t *told)
{
    (void)state;
    const bool fails = ++program.errands >= program.fails_at;
    if (fails && program.error != CM1E_OK)
        return refused(told);
    errand->error = fails ? program.outcome : CM1E_OK;
    program.bytes += errand->size;
    for (size_t i = 0; i < errand->size; i++)
        errand->data[i] = (uint8_t)(errand->place + i);
    if (errand->kind == ERRAND_SII && errand->place == 0)
        cm1e_put_u16(errand->data + KBIT_AT, program.kbit);
    if (errand->kind == ERRAND_INFO) {
        memset(errand->info.answer, 0x11, program.info_bytes);
        errand->info.size = program.info_bytes;
    }
    return CM1E_OK;
}

static cm1e_error_t transfer_file(void *state, cm1e_foe_t *foe, cm1e_diag_t *told)
{
    (void)state, (void)foe;
    return refused(told);
}

static void close_program(void *state) { ((struct program *)state)->closed++; }

static const cm1e_bus_remote_t remote = {scan, transfer, run_errand, transfer_file, close_program};

static cm1e_bus_t *opened(void)
{
    cm1e_bus_t *bus = NULL;
    program = (struct program){.kind = "", .kbit = 1};
    sim_config(1);
    ck_assert_msg(cm1e_bus_open_remote(&bus, &config, &remote, &program, &diag) == CM1E_OK, "%s", diag.text);
    return bus;
}

static cm1e_bus_t *scanned(void)
{
    cm1e_bus_t *bus = opened();
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    return bus;
}

/* ---- opening and scanning --------------------------------------------------------------------------------------- */

/** The connection belongs to the bus, also to one that does not come to be. */
START_TEST(a_bus_that_cannot_be_opened_closes_the_connection)
{
    cm1e_bus_t *bus = opened();
    cm1e_bus_close(bus);
    ck_assert_uint_eq(program.closed, 1);
    config.cycle_time_ns = -1;
    ck_assert_int_eq(cm1e_bus_open_remote(&bus, &config, &remote, &program, &diag), CM1E_ERROR_CONFIG);
    ck_assert_ptr_null(bus);
    ck_assert_uint_eq(program.closed, 2);
}
END_TEST

START_TEST(a_scan_that_the_program_refuses_can_be_made_again)
{
    cm1e_bus_t *bus = opened();
    program.error = CM1E_ERROR_IO;
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_ERROR_IO);
    ck_assert_str_eq(diag.text, "The program says no.");
    program.error = CM1E_OK;
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_OK);
    ck_assert_uint_eq(cm1e_bus_slave_count(bus), SLAVES);
    cm1e_bus_close(bus);
}
END_TEST

/** A device that its objects tell, and no identity, is what the program says. */
START_TEST(a_device_without_a_known_identity_is_of_the_kind_that_is_told)
{
    static const struct {
        const char *kind;
        cm1e_device_model_t model;
        const cm1e_device_t *device;
    } rows[] = {
        {"", CM1E_DEVICE_CM1E, NULL}, {"no kind of ours", CM1E_DEVICE_CM1E, NULL},
        {"cm1-e", CM1E_DEVICE_CM1E, NULL}, /* which has an identity */
        {"cia402", CM1E_DEVICE_CM1E, &cm1e_device_cia402}, {"bridge", CM1E_DEVICE_EB02, &cm1e_device_eb02},
        {"bridge", CM1E_DEVICE_CM1E, &cm1e_device_unknown_bridge},
    };
    for (size_t n = 0; n < sizeof rows / sizeof rows[0]; n++) {
        cm1e_bus_t *bus = opened();
        program.kind = rows[n].kind;
        program.model = rows[n].model;
        ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_OK);
        const cm1e_slave_info_t *info = cm1e_bus_slave(bus, 1);
        ck_assert_msg(info->device == rows[n].device, "row %zu", n);
        ck_assert_msg(info->device ? strcmp(info->kind, rows[n].kind) == 0 : !info->kind, "row %zu", n);
        cm1e_bus_close(bus);
    }
}
END_TEST

/* ---- transfers -------------------------------------------------------------------------------------------------- */

START_TEST(a_transfer_has_the_error_of_the_program_or_of_the_slave)
{
    cm1e_bus_t *bus = scanned();
    uint8_t data[4];
    size_t size = sizeof data;
    program.error = CM1E_ERROR_STATE;
    ck_assert_int_eq(cm1e_sdo_read(bus, 1, 0x1018, 1, data, &size, &diag), CM1E_ERROR_STATE);
    ck_assert_str_eq(diag.text, "The program says no.");
    ck_assert_int_eq(cm1e_sdo_read(bus, 1, 0x1018, 1, data, &size, NULL), CM1E_ERROR_STATE); /* without words, too */
    program.error = CM1E_OK;
    program.outcome = CM1E_ERROR_BUS_LOST;
    ck_assert_int_eq(cm1e_sdo_read(bus, 1, 0x1018, 1, data, &size, &diag), CM1E_ERROR_BUS_LOST);
    program.outcome = CM1E_OK;
    ck_assert_int_eq(cm1e_sdo_read(bus, 1, 0x1018, 1, data, &size, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_sdo_read(bus, WITHOUT_COE, 0x1018, 1, data, &size, &diag), CM1E_ERROR_UNSUPPORTED);
    ck_assert_msg(strstr(diag.text, "lave 3") != NULL, "%s", diag.text);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(what_needs_the_network_for_itself_is_refused)
{
    cm1e_bus_t *bus = scanned();
    uint8_t value = 0;
    const uint8_t image[128] = {0};
    cm1e_al_answer_t answer;
    const cm1e_sii_write_options_t all = {true, true, true, true};
    ck_assert_int_eq(cm1e_esc_write(bus, 1, 0x0200, &value, 1, &diag), CM1E_ERROR_INTERFACE_IN_USE);
    ck_assert_str_eq(diag.text, "cm1e_esc_write() needs the network for itself, and another program runs it: end that "
                     "program first.");
    ck_assert_int_eq(cm1e_esc_request_state(bus, 1, 1, 1, &answer, &diag), CM1E_ERROR_INTERFACE_IN_USE);
    ck_assert_msg(strncmp(diag.text, "cm1e_esc_request_state() needs", 30) == 0, "%s", diag.text);
    ck_assert_int_ne(cm1e_sii_write_device(bus, 1, image, sizeof image, &all, &diag), CM1E_OK);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- registers -------------------------------------------------------------------------------------------------- */

/** In pieces of CM1E_ERRAND_BYTES, each of which may fail: all that was asked for, and nothing behind it. */
START_TEST(registers_say_whether_the_slave_or_the_program_does_not_answer)
{
    cm1e_bus_t *bus = scanned();
    uint8_t data[300];
    ck_assert_int_eq(cm1e_esc_read(bus, 1, 0x0100, data, sizeof data, &diag), CM1E_OK);
    ck_assert_uint_eq(program.errands, 3);
    ck_assert_uint_eq(program.bytes, sizeof data);
    for (size_t i = 0; i < sizeof data; i++)
        ck_assert_uint_eq(data[i], (uint8_t)(0x0100 + i));
    for (unsigned at = 1; at <= 3; at++) {
        program = (struct program){.kind = "", .fails_at = at, .outcome = CM1E_ERROR_BUS_LOST};
        ck_assert_int_eq(cm1e_esc_read(bus, 2, 0x0100, data, sizeof data, &diag), CM1E_ERROR_TIMEOUT);
        ck_assert_str_eq(diag.text, "Slave 2 does not answer at register 0x0100.");
        ck_assert_uint_eq(program.errands, at);
        program = (struct program){.kind = "", .fails_at = at, .error = CM1E_ERROR_IO};
        ck_assert_int_eq(cm1e_esc_read(bus, 2, 0x0100, data, sizeof data, &diag), CM1E_ERROR_IO);
        ck_assert_str_eq(diag.text, "The program says no.");
    }
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(registers_that_change_something_are_not_read)
{
    cm1e_bus_t *bus = scanned();
    uint8_t data[8];
    static const struct {
        uint16_t position, address, size;
    } rows[] = {{0, 0, 1}, {SLAVES + 1, 0, 1}, {1, 0, 0}, {1, 0x08FF, 2}, {1, 0x1000, 1}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        ck_assert_int_eq(cm1e_esc_read(bus, rows[i].position, rows[i].address, data, rows[i].size, &diag),
                         CM1E_ERROR_INVALID_ARGUMENT);
        ck_assert_msg(strstr(diag.text, "only slaves 1 ... 3 and registers up to 0x08FF can be read") != NULL, "%s", diag.text);
    }
    ck_assert_uint_eq(program.errands, 0);
    ck_assert_int_eq(cm1e_esc_read(bus, 1, 0x08FF, data, 1, &diag), CM1E_OK);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- SII -------------------------------------------------------------------------------------------------------- */

/** 2 kbit, 256 bytes, in two pieces. */
START_TEST(an_sii_that_cannot_be_read_names_the_word)
{
    cm1e_bus_t *bus = scanned();
    static uint8_t image[CM1E_SII_SIZE];
    char words[120];
    size_t size = 256;
    ck_assert_msg(cm1e_sii_read_device(bus, 1, image, &size, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_eq(size, 256);
    ck_assert_uint_eq(program.errands, 2);
    for (unsigned at = 1; at <= 2; at++) {
        program = (struct program){.kind = "", .kbit = 1, .fails_at = at, .outcome = CM1E_ERROR_TIMEOUT};
        ck_assert_int_eq(cm1e_sii_read_device(bus, 1, image, &size, &diag), CM1E_ERROR_TIMEOUT);
        snprintf(words, sizeof words, "Slave 1: its SII cannot be read at word 0x%04X: %s.", 64 * (at - 1),
                 cm1e_strerror(CM1E_ERROR_TIMEOUT));
        ck_assert_str_eq(diag.text, words);
        program = (struct program){.kind = "", .kbit = 1, .fails_at = at, .error = CM1E_ERROR_IO};
        size = 256;
        ck_assert_int_eq(cm1e_sii_read_device(bus, 1, image, &size, &diag), CM1E_ERROR_IO);
        ck_assert_str_eq(diag.text, "The program says no.");
        size = 256;
    }
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(an_sii_that_states_no_size_is_read_as_16_kbit)
{
    static const uint16_t not_stated[] = {0, 0xFFFF};
    static uint8_t image[CM1E_SII_SIZE];
    cm1e_bus_t *bus = scanned();
    for (int i = 0; i < 2; i++) {
        size_t size = sizeof image;
        program.kbit = not_stated[i];
        ck_assert_msg(cm1e_sii_read_device(bus, 1, image, &size, &diag) == CM1E_OK, "%s", diag.text);
        ck_assert_uint_eq(size, CM1E_SII_SIZE);
        size = CM1E_SII_SIZE - 1;
        ck_assert_int_eq(cm1e_sii_read_device(bus, 1, image, &size, &diag), CM1E_ERROR_INVALID_ARGUMENT);
        ck_assert_uint_eq(size, CM1E_SII_SIZE);
        ck_assert_str_eq(diag.text, "The SII of slave 1 has 2048 bytes, there is room for 2047.");
    }
    cm1e_bus_close(bus);
}
END_TEST

/* ---- descriptions ----------------------------------------------------------------------------------------------- */

/** Every length from nothing on: the objects that are there, or words that say that the answer is no good. */
START_TEST(a_description_of_any_length_is_taken_or_told)
{
    cm1e_bus_t *bus = scanned();
    for (program.info_bytes = 0; program.info_bytes < 12; program.info_bytes++) {
        const size_t bytes = program.info_bytes;
        uint16_t indexes[8];
        size_t count = 8;
        cm1e_object_info_t object;
        const cm1e_error_t list = cm1e_sdo_info_list(bus, 1, CM1E_OBJECTS_ALL, indexes, &count, &diag);
        const bool good = bytes >= 2 && bytes % 2 == 0;
        ck_assert_msg(list == (good ? CM1E_OK : CM1E_ERROR_BUS_MAILBOX), "%zu bytes: %s", bytes, diag.text);
        if (good)
            ck_assert_uint_eq(count, (bytes - 2) / 2);
        else
            ck_assert_str_eq(diag.text, "Slave 1: its description of its objects is shorter than it says.");
        ck_assert_int_eq(cm1e_sdo_info_object(bus, 1, 0x1111, &object, &diag),
                         bytes >= 6 ? CM1E_OK : CM1E_ERROR_BUS_MAILBOX);
    }
    program.info_bytes = 2 + 2 * 9;
    size_t count = 8;
    uint16_t indexes[8];
    ck_assert_int_eq(cm1e_sdo_info_list(bus, 1, CM1E_OBJECTS_ALL, indexes, &count, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_str_eq(diag.text, "Slave 1 has 9 objects, there is room for 8.");
    ck_assert_int_eq(cm1e_sdo_info_list(bus, WITHOUT_COE, CM1E_OBJECTS_ALL, indexes, &count, &diag),
                     CM1E_ERROR_UNSUPPORTED);
    ck_assert_msg(strstr(diag.text, "has no object dictionary: its SII announces no CoE") != NULL, "%s", diag.text);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_remote");
    TCase *tests = tcase_create("remote");
    tcase_add_test(tests, a_bus_that_cannot_be_opened_closes_the_connection);
    tcase_add_test(tests, a_scan_that_the_program_refuses_can_be_made_again);
    tcase_add_test(tests, a_device_without_a_known_identity_is_of_the_kind_that_is_told);
    tcase_add_test(tests, a_transfer_has_the_error_of_the_program_or_of_the_slave);
    tcase_add_test(tests, what_needs_the_network_for_itself_is_refused);
    tcase_add_test(tests, registers_say_whether_the_slave_or_the_program_does_not_answer);
    tcase_add_test(tests, registers_that_change_something_are_not_read);
    tcase_add_test(tests, an_sii_that_cannot_be_read_names_the_word);
    tcase_add_test(tests, an_sii_that_states_no_size_is_read_as_16_kbit);
    tcase_add_test(tests, a_description_of_any_length_is_taken_or_told);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
