/* What others read of a slave while the bus operates: its SII and its registers. The EEPROM interface that is busy for
 * ever, has errors, or does not acknowledge; lost frames; a slave that is lost, and a bus that stops, in every cycle. Each
 * errand ends, the EEPROM goes back to its slave, and the process data go on. */
#include "bus/errand.h"
#include "bus_support.h"
#include "description/sii_image.h"
#include "nic/frame.h"

enum { SLAVES = 3, LAST = 3, REGISTER_0500 = 0x0500, OFFERED = 1, SETTLE = 50, CYCLES_MAX = 5000, CYCLES_BACK = 5000 };
static cm1e_errand_t errand;

static cm1e_bus_t *operating(void)
{
    sim_config(SLAVES);
    config.axes[LAST - 1].recover = CM1E_RECOVER_AUTO;
    cm1e_bus_t *bus = start_bus();
    cycles(bus, SETTLE);
    return bus;
}

static cm1e_error_t submit_sii(cm1e_bus_t *bus, uint32_t word)
{
    errand = (cm1e_errand_t){.kind = ERRAND_SII, .position = LAST, .place = word, .size = CM1E_ERRAND_BYTES};
    return cm1e_errand_submit(bus, &errand);
}

/** Makes cycles until the errand has ended; returns their number. */
static unsigned finish(cm1e_bus_t *bus)
{
    unsigned n = 0;
    for (; !cm1e_errand_done(&errand); n++) {
        cycle(bus);
        ck_assert_uint_lt(n, CYCLES_MAX);
    }
    return n;
}

/** The errand reads what is in the EEPROM, and the slave has it back. */
static unsigned check_reads(cm1e_bus_t *bus, uint32_t word)
{
    ck_assert_int_eq(submit_sii(bus, word), CM1E_OK);
    const unsigned n = finish(bus);
    ck_assert_msg(errand.error == CM1E_OK, "%s", cm1e_strerror(errand.error));
    ck_assert_mem_eq(errand.data, sii_memory_of(bus, LAST) + 2 * (size_t)word, CM1E_ERRAND_BYTES);
    ck_assert_uint_eq(register_memory_of(bus, LAST)[REGISTER_0500], OFFERED);
    return n;
}

static void check_undisturbed(cm1e_bus_t *bus)
{
    cycles(bus, 10);
    ck_assert_uint_eq(cm1e_bus_counters(bus)->working_counter_errors, 0);
    for (uint16_t position = 1; position <= SLAVES; position++)
        ck_assert_uint_eq(cm1e_bus_slave_watch(bus, position).al_state, CM1E_AL_OP);
}

/* ---- the EEPROM interface --------------------------------------------------------------------------------------- */

START_TEST(an_sii_is_read_whoever_has_the_eeprom)
{
    cm1e_bus_t *bus = operating();
    check_reads(bus, 0);
    check_reads(bus, CM1E_SII_SIZE / 2 - CM1E_ERRAND_BYTES / 2);
    register_memory_of(bus, LAST)[REGISTER_0500] = 0; /* nobody has offered it to the slave */
    ck_assert_int_eq(submit_sii(bus, 0), CM1E_OK);
    finish(bus);
    ck_assert_int_eq(errand.error, CM1E_OK);
    ck_assert_uint_eq(register_memory_of(bus, LAST)[REGISTER_0500], 0);
    check_undisturbed(bus);
    cm1e_bus_close(bus);
}
END_TEST

/** Behind its end an EEPROM does not acknowledge. The error stays until it is cleared, and the next errand does that. */
START_TEST(an_eeprom_that_does_not_acknowledge_ends_the_errand_and_is_read_again)
{
    cm1e_bus_t *bus = operating();
    for (int round = 0; round < 3; round++) {
        ck_assert_int_eq(submit_sii(bus, CM1E_SII_SIZE / 2), CM1E_OK);
        finish(bus);
        ck_assert_int_eq(errand.error, CM1E_ERROR_TIMEOUT);
        ck_assert_uint_eq(errand.taken, 0);
        ck_assert_uint_eq(register_memory_of(bus, LAST)[REGISTER_0500], OFFERED);
        check_reads(bus, 32 * (uint32_t)round);
    }
    ck_assert_int_eq(submit_sii(bus, CM1E_SII_SIZE / 2 - CM1E_ERRAND_BYTES / 4), CM1E_OK); /* its second half is there not */
    finish(bus);
    ck_assert_int_eq(errand.error, CM1E_ERROR_TIMEOUT);
    ck_assert_uint_eq(errand.taken, CM1E_ERRAND_BYTES / 2);
    check_undisturbed(bus);
    cm1e_bus_close(bus);
}
END_TEST

/** A checksum that is wrong keeps its bit in the status of the interface, whatever is read. */
START_TEST(an_sii_with_a_wrong_checksum_is_read_as_it_is)
{
    cm1e_bus_t *bus = operating();
    simulate(bus, "quirk 3 wrong-checksum");
    check_reads(bus, 0);
    check_undisturbed(bus);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(an_interface_that_stays_busy_ends_the_errand_in_time)
{
    cm1e_bus_t *bus = operating();
    simulate(bus, "quirk 3 slow-eeprom 1000000");
    for (int round = 0; round < 2; round++) { /* the second one finds it busy from the first one */
        const int64_t begun_ns = now_of(bus);
        ck_assert_int_eq(submit_sii(bus, 0), CM1E_OK);
        finish(bus);
        ck_assert_int_eq(errand.error, CM1E_ERROR_TIMEOUT);
        ck_assert_int_lt(now_of(bus) - begun_ns, INT64_C(2500000000));
        ck_assert_uint_eq(register_memory_of(bus, LAST)[REGISTER_0500], OFFERED);
    }
    simulate(bus, "quirk 3 nothing");
    cycles(bus, 1100);
    check_reads(bus, 0);
    check_undisturbed(bus);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- descriptions of objects ------------------------------------------------------------------------------------ */

static void submit_info(cm1e_bus_t *bus, uint16_t index)
{
    static uint8_t answer[64];
    errand = (cm1e_errand_t){.kind = ERRAND_INFO, .position = LAST,
                             .info = {.kind = INFO_OBJECT, .index = index, .answer = answer, .size = sizeof answer}};
    ck_assert_int_eq(cm1e_errand_submit(bus, &errand), CM1E_OK);
}

/** The errand ends with the answer of the slave, not before. */
START_TEST(an_object_is_described_or_refused)
{
    enum { STATUSWORD = 0x6041, NO_OBJECT = 0x5FFF, UNSIGNED16 = 6, NOT_THERE = 0x06020000 };
    cm1e_bus_t *bus = operating();
    for (int round = 0; round < 2; round++) {
        submit_info(bus, STATUSWORD);
        ck_assert_uint_gt(finish(bus), 2);
        ck_assert_msg(errand.error == CM1E_OK, "%s", cm1e_strerror(errand.error));
        ck_assert_uint_gt(errand.info.size, 6);
        ck_assert_uint_eq(cm1e_get_u16(errand.info.answer), STATUSWORD);
        ck_assert_uint_eq(cm1e_get_u16(errand.info.answer + 2), UNSIGNED16);
        submit_info(bus, NO_OBJECT);
        finish(bus);
        ck_assert_int_eq(errand.error, CM1E_ERROR_SDO_ABORT);
        ck_assert_uint_eq(errand.info.abort_code, NOT_THERE);
    }
    check_undisturbed(bus);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- lost frames ------------------------------------------------------------------------------------------------ */

typedef struct loss {
    cm1e_tap_direction_t direction;
    unsigned from, count, seen;
} loss_t;

/** Loses frames whose first datagram is about the EEPROM. */
static cm1e_tap_verdict_t lose(void *context, cm1e_tap_frame_t *frame)
{
    loss_t *loss = context;
    const uint16_t offset = cm1e_get_u16(frame->bytes + 20);
    if (frame->direction != loss->direction || offset < REGISTER_0500 || offset > 0x050F)
        return CM1E_TAP_PASS;
    const unsigned n = loss->seen++;
    return n >= loss->from && n < loss->from + loss->count ? CM1E_TAP_DROP : CM1E_TAP_PASS;
}

/** One frame at every place, and four in a row: the same words are read. */
START_TEST(lost_frames_lose_no_word)
{
    cm1e_bus_t *bus = operating();
    loss_t loss = {.direction = _i % 2 ? CM1E_TAP_RECEIVED : CM1E_TAP_SENT, .count = _i < 2 ? 1 : 4};
    cm1e_nic_set_tap(cm1e_bus_nic(bus), lose, &loss);
    for (loss.seen = UINT32_MAX; loss.seen >= loss.from; loss.from++) {
        loss.seen = 0;
        check_reads(bus, loss.from % 100);
    }
    ck_assert_uint_gt(loss.from, 36);
    check_undisturbed(bus);
    cm1e_bus_close(bus);
}
END_TEST

/** Registers are read with one datagram, which is repeated four times. */
START_TEST(registers_are_read_or_the_slave_is_lost)
{
    cm1e_bus_t *bus = operating();
    loss_t loss = {.direction = CM1E_TAP_RECEIVED};
    cm1e_nic_set_tap(cm1e_bus_nic(bus), lose, &loss);
    for (loss.count = 0; loss.count < 8; loss.count++) {
        loss.seen = 0;
        errand = (cm1e_errand_t){.kind = ERRAND_REGISTERS, .position = LAST, .place = 0x0508, .size = 8};
        ck_assert_int_eq(cm1e_errand_submit(bus, &errand), CM1E_OK);
        finish(bus);
        ck_assert_int_eq(errand.error, loss.count < 5 ? CM1E_OK : CM1E_ERROR_BUS_LOST);
        ck_assert(loss.count >= 5 || memcmp(errand.data, register_memory_of(bus, LAST) + 0x0508, 8) == 0);
    }
    check_undisturbed(bus);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- a slave that is lost, a bus that stops --------------------------------------------------------------------- */

static bool is_back(cm1e_bus_t *bus)
{
    for (int n = 0; n < CYCLES_BACK; n++)
        if (cycle(bus) == CM1E_OK && !cm1e_bus_slave_watch(bus, LAST).lost &&
            cm1e_bus_slave_watch(bus, LAST).al_state == CM1E_AL_OP && cm1e_bus_health(bus) == CM1E_OK)
            return true;
    return false;
}

static const struct fate {
    const char *goes, *comes;
    unsigned away; /* cycles; 0: it is not in time for the errand */
} fates[] = {
    {"unplug 3", "replug 3", 2500}, {"unplug 3", "replug 3", 25}, {"power-cycle 3 300", NULL, 0},
    {"detach 3 powered", "attach 3", 300},
};
enum { FATES = sizeof fates / sizeof fates[0] };

/** In each cycle of an errand. A slave that was away for a short time comes back without a new start: its EEPROM must be
 *  its own again, too. */
START_TEST(a_slave_that_is_lost_in_any_cycle_ends_the_errand_and_gets_its_eeprom_back)
{
    const struct fate *fate = &fates[_i];
    unsigned lost = 0;
    for (unsigned at = 1;; at++) {
        cm1e_bus_t *bus = operating();
        ck_assert_int_eq(submit_sii(bus, 0), CM1E_OK);
        for (unsigned n = 0; n < at; n++)
            cycle(bus);
        if (cm1e_errand_done(&errand)) {
            cm1e_bus_close(bus);
            break;
        }
        simulate(bus, fate->goes);
        for (unsigned n = 0; n < fate->away; n++)
            cycle(bus);
        if (fate->comes)
            simulate(bus, fate->comes);
        finish(bus);
        ck_assert_msg(errand.error == CM1E_OK || errand.error == CM1E_ERROR_BUS_LOST ||
                      errand.error == CM1E_ERROR_TIMEOUT, "cycle %u: %s", at, cm1e_strerror(errand.error));
        lost += errand.error == CM1E_ERROR_BUS_LOST;
        ck_assert_msg(is_back(bus), "cycle %u", at);
        cycles(bus, 10);
        ck_assert_msg(register_memory_of(bus, LAST)[REGISTER_0500] == OFFERED, "cycle %u: the EEPROM is not given back", at);
        check_reads(bus, 0);
        cm1e_bus_close(bus);
    }
    ck_assert_uint_gt(lost, 10);
}
END_TEST

START_TEST(a_bus_that_stops_in_any_cycle_ends_the_errand)
{
    for (unsigned at = 0; at < 36; at++) {
        cm1e_bus_t *bus = operating();
        ck_assert_int_eq(submit_sii(bus, 0), CM1E_OK);
        for (unsigned n = 0; n < at; n++)
            cycle(bus);
        ck_assert(!cm1e_errand_done(&errand));
        cm1e_bus_stop(bus);
        ck_assert_msg(cm1e_errand_done(&errand), "cycle %u", at);
        ck_assert_int_eq(errand.error, CM1E_ERROR_CANCELLED);
        ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
        ck_assert_uint_eq(register_memory_of(bus, LAST)[REGISTER_0500], OFFERED);
        cm1e_bus_close(bus);
    }
}
END_TEST

/** An SDO transfer with a slave whose SII is read has every second turn, however many other slaves there are. */
START_TEST(an_object_is_read_beside_an_errand_of_the_same_slave)
{
    cm1e_bus_t *bus = operating();
    uint8_t data[4];
    unsigned alone = 0;
    for (unsigned beside = 0; beside < 2; beside++) {
        cm1e_sdo_t sdo = {.position = LAST, .index = 0x1018, .subindex = 1, .data = data, .size = sizeof data};
        unsigned n = 0;
        if (beside)
            ck_assert_int_eq(submit_sii(bus, 0), CM1E_OK);
        ck_assert_int_eq(cm1e_sdo_submit(bus, &sdo), CM1E_OK);
        for (; cm1e_sdo_state(&sdo) == CM1E_SDO_BUSY; n++)
            cycle(bus);
        ck_assert_int_eq(cm1e_sdo_state(&sdo), CM1E_SDO_DONE);
        if (!beside)
            alone = n;
        else
            ck_assert_msg(n <= 2 * alone + 2 && !cm1e_errand_done(&errand), "%u cycles, alone %u", n, alone);
    }
    finish(bus);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(an_errand_that_cannot_be_done_is_refused)
{
    static const struct {
        cm1e_errand_kind_t kind;
        uint16_t position;
        uint32_t place;
        size_t size;
        cm1e_error_t error;
    } rows[] = {
        {ERRAND_SII, 0, 0, 2, CM1E_ERROR_INVALID_ARGUMENT}, {ERRAND_SII, SLAVES + 1, 0, 2, CM1E_ERROR_INVALID_ARGUMENT},
        {ERRAND_SII, 1, 0, 0, CM1E_ERROR_INVALID_ARGUMENT}, {ERRAND_SII, 1, 0, 3, CM1E_ERROR_INVALID_ARGUMENT},
        {ERRAND_SII, 1, 0, CM1E_ERRAND_BYTES + 2, CM1E_ERROR_INVALID_ARGUMENT},
        {ERRAND_REGISTERS, 1, CM1E_ERRAND_REGISTERS_END - 1, 2, CM1E_ERROR_INVALID_ARGUMENT},
        {ERRAND_REGISTERS, 1, 0, 0, CM1E_ERROR_INVALID_ARGUMENT},
        {ERRAND_REGISTERS, 1, CM1E_ERRAND_REGISTERS_END - 2, 2, CM1E_OK},
    };
    sim_config(SLAVES);
    cm1e_bus_t *bus = open_bus();
    errand = (cm1e_errand_t){.kind = ERRAND_SII, .position = 1, .size = 2};
    ck_assert_int_eq(cm1e_errand_submit(bus, &errand), CM1E_ERROR_STATE);
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_errand_submit(bus, &errand), CM1E_OK);
    cm1e_bus_stop(bus);
    ck_assert(cm1e_errand_done(&errand));
    ck_assert_int_eq(errand.error, CM1E_ERROR_CANCELLED);
    cm1e_bus_close(bus);
    bus = operating();
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        errand = (cm1e_errand_t){.kind = rows[i].kind, .position = rows[i].position, .place = rows[i].place,
                                 .size = rows[i].size};
        ck_assert_msg(cm1e_errand_submit(bus, &errand) == rows[i].error, "row %zu", i);
    }
    finish(bus);
    ck_assert_int_eq(errand.error, CM1E_OK);
    for (size_t size = 1; size <= CM1E_ERRAND_BYTES; size += CM1E_ERRAND_BYTES - 1) { /* the smallest and the largest */
        errand = (cm1e_errand_t){.kind = ERRAND_REGISTERS, .position = SLAVES, .place = 0x0010, .size = size};
        memset(errand.data, 0xEE, sizeof errand.data);
        ck_assert_int_eq(cm1e_errand_submit(bus, &errand), CM1E_OK);
        finish(bus);
        ck_assert_int_eq(errand.error, CM1E_OK);
        ck_assert_mem_eq(errand.data, register_memory_of(bus, SLAVES) + 0x0010, size);
        ck_assert(size == CM1E_ERRAND_BYTES || errand.data[size] == 0xEE);
    }
    errand = (cm1e_errand_t){.kind = ERRAND_SII, .position = SLAVES, .place = CM1E_SII_VENDOR / 2, .size = 2};
    ck_assert_int_eq(cm1e_errand_submit(bus, &errand), CM1E_OK);
    cm1e_errand_t second = {.kind = ERRAND_SII, .position = 1, .size = 2};
    ck_assert_int_eq(cm1e_errand_submit(bus, &second), CM1E_ERROR_BUSY);
    finish(bus);
    ck_assert_int_eq(errand.error, CM1E_OK);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_errand");
    TCase *tests = tcase_create("errand");
    tcase_add_test(tests, an_sii_is_read_whoever_has_the_eeprom);
    tcase_add_test(tests, an_eeprom_that_does_not_acknowledge_ends_the_errand_and_is_read_again);
    tcase_add_test(tests, an_sii_with_a_wrong_checksum_is_read_as_it_is);
    tcase_add_test(tests, an_interface_that_stays_busy_ends_the_errand_in_time);
    tcase_add_test(tests, an_object_is_described_or_refused);
    tcase_add_loop_test(tests, lost_frames_lose_no_word, 0, 4);
    tcase_add_test(tests, registers_are_read_or_the_slave_is_lost);
    tcase_add_loop_test(tests, a_slave_that_is_lost_in_any_cycle_ends_the_errand_and_gets_its_eeprom_back, 0, FATES);
    tcase_add_test(tests, a_bus_that_stops_in_any_cycle_ends_the_errand);
    tcase_add_test(tests, an_object_is_read_beside_an_errand_of_the_same_slave);
    tcase_add_test(tests, an_errand_that_cannot_be_done_is_refused);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
