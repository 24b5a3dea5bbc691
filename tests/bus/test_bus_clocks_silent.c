/* Distributed clocks of slaves that do not answer: while their clocks are set up, one register after the other; and a
 * reference that is lost together with the next clock, or falls back without being off. */
#include "clock_bench.h"
#include "nic/frame.h"
#include "sim/esc_chip.h"
#include "sim/segment.h"

enum { FPRD = 4, FPWR = 5, ANSWERS_AT_THE_THIRD_TIME = 2, NEVER = 1000000, ACTIVATION = 0x0981 };

/** A register of a slave, and how often the working counter says that nobody was there. */
typedef struct silence {
    uint8_t command;
    uint16_t offset;
    uint32_t slave;
    const char *words;
    unsigned times;
} silence_t;

#define SET_UP "does not answer when its clock is set up. Check its cables and its power."

static const silence_t rows[] = {
    {FPRD, 0x0008, CM1E, SET_UP, 0},
    {FPRD, 0x0900, CM1E, SET_UP, 0},
    {FPRD, 0x0900, LAST, SET_UP, 0},
    {FPWR, 0x0934, DRIVE, SET_UP, 0},
    {FPWR, 0x0920, DRIVE, SET_UP, 0},
    {FPWR, 0x0930, LAST, SET_UP, 0},
    {FPWR, 0x0980, DRIVE, SET_UP, 0},
    {FPWR, 0x09A0, DRIVE, SET_UP, 0},
    {FPWR, 0x0990, DRIVE, SET_UP, 0},
    {FPWR, ACTIVATION, DRIVE, SET_UP, 0},
    {FPRD, 0x092C, LAST, "does not answer when the deviation of its clock is read. Check its cables and its power.", 0},
};
enum { ROWS = sizeof rows / sizeof rows[0] };

static cm1e_tap_verdict_t silence(void *context, cm1e_tap_frame_t *frame)
{
    silence_t *row = context;
    datagram_t d = {.more = true};
    size_t at = FRAME_HEADER;
    for (unsigned n = 0; d.more && cm1e_frame_datagram(frame->bytes, frame->length, &at, &d); n++) {
        if (frame->direction == CM1E_TAP_SENT || row->times == 0 || d.header[0] != row->command ||
            cm1e_get_u16(d.header + 2) != 0x1000 + row->slave || cm1e_get_u16(d.header + 4) != row->offset)
            continue;
        cm1e_frame_change_working_counter(frame->bytes, frame->length, n, -1);
        row->times--;
    }
    return CM1E_TAP_PASS;
}

/** The start is refused in words, and leaves no slave in operation and no pulses behind. Then it succeeds. */
START_TEST(a_slave_that_does_not_answer_ends_the_start_in_words)
{
    silence_t row = rows[_i];
    char slave[16];
    describe(1000);
    cm1e_bus_t *bus = open_drifting(0, 10, -10);
    row.times = NEVER;
    cm1e_nic_set_tap(cm1e_bus_nic(bus), silence, &row);
    ck_assert_int_eq(cm1e_bus_start(bus, &diag), CM1E_ERROR_BUS_CLOCKS);
    snprintf(slave, sizeof slave, "Slave %u ", (unsigned)row.slave);
    ck_assert_msg(strncmp(diag.text, slave, strlen(slave)) == 0 && strstr(diag.text, row.words), "%s", diag.text);
    for (uint32_t i = 1; i <= SLAVES; i++) {
        const cm1e_sim_slave_t *own = cm1e_sim_segment_slave(segment_of(bus), i);
        ck_assert_uint_eq(cm1e_sim_slave_al_state(own), CM1E_AL_INIT);
        ck_assert_uint_eq(own->memory[ACTIVATION], 0);
    }
    row.times = 0;
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(a_slave_that_answers_at_the_third_time_is_set_up)
{
    silence_t row = rows[_i];
    describe(1000);
    cm1e_bus_t *bus = open_drifting(0, 10, -10);
    row.times = ANSWERS_AT_THE_THIRD_TIME;
    cm1e_nic_set_tap(cm1e_bus_nic(bus), silence, &row);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_eq(row.times, 0);
    plan_ns = 0;
    run(bus, 1000);
    ck_assert_uint_eq(clocks_of(bus).sync_losses, 0);
    ck_assert_uint_eq(cm1e_bus_slave_watch(bus, DRIVE).al_state, CM1E_AL_OP);
    cm1e_bus_close(bus);
}
END_TEST

/** The clock behind the reference is known to be away too, so the one after it takes over at once. */
START_TEST(a_clock_that_is_away_does_not_take_over)
{
    describe(1000);
    cm1e_bus_t *bus = start_drifting(0, 10, -10);
    run(bus, 5000);
    cm1e_put_u16(cm1e_sim_segment_slave(segment_of(bus), DRIVE)->memory + ESC_STATION_ADDRESS, 0);
    run(bus, 100);
    ck_assert(cm1e_bus_slave_watch(bus, DRIVE).lost);
    cm1e_put_u16(cm1e_sim_segment_slave(segment_of(bus), CM1E)->memory + ESC_STATION_ADDRESS, 0);
    for (int n = 0; n < 1000; n++) {
        run(bus, 1);
        ck_assert_uint_ne(clocks_of(bus).reference, DRIVE);
    }
    ck_assert_uint_eq(clocks_of(bus).reference, LAST);
    ck_assert(clock_of(bus, LAST).is_reference && !clock_of(bus, LAST).lost);
    ck_assert_msg(fabs(clocks_of(bus).phase_mean_ns) < 50, "%g ns", clocks_of(bus).phase_mean_ns);
    cm1e_bus_close(bus);
}
END_TEST

/** The reference gives no time in so many frames of each period. */
typedef struct quiet_reference {
    unsigned quiet, period, frames;
    bool asked;
    uint8_t sent[8];
} quiet_reference_t;

static cm1e_tap_verdict_t quieten(void *context, cm1e_tap_frame_t *frame)
{
    enum { FRMW = 14 };
    quiet_reference_t *quiet = context;
    datagram_t d = {.more = true};
    size_t at = FRAME_HEADER;
    for (unsigned n = 0; d.more && cm1e_frame_datagram(frame->bytes, frame->length, &at, &d); n++) {
        if (d.header[0] != FRMW || cm1e_get_u16(d.header + 4) != 0x0910)
            continue;
        if (frame->direction == CM1E_TAP_SENT) {
            memcpy(quiet->sent, d.header + 10, 8);
            quiet->asked = true;
        } else if (quiet->asked && quiet->frames++ % quiet->period < quiet->quiet) {
            memcpy(frame->bytes + (d.header - frame->bytes) + 10, quiet->sent, 8);
        }
    }
    return CM1E_TAP_PASS;
}

/** A few frames without its time are disturbances, however often they come; three in a row are one that is away. */
START_TEST(a_reference_that_is_silent_in_three_frames_in_a_row_is_away)
{
    for (unsigned quiet = 1; quiet <= 5; quiet++) { /* the next clock is judged anew */
        describe(1000);
        cm1e_bus_t *bus = start_drifting(0, 0, 0);
        quiet_reference_t reference = {.quiet = quiet, .period = quiet + (quiet <= 3 ? 1 : 100)};
        run(bus, 100);
        const uint16_t before = clocks_of(bus).reference;
        cm1e_nic_set_tap(cm1e_bus_nic(bus), quieten, &reference);
        run(bus, quiet < 3 ? 50 : quiet == 3 ? 5 : 20);
        ck_assert_uint_ge(reference.frames, quiet < 3 ? 49 : 4);
        ck_assert_msg((clocks_of(bus).reference == before) == (quiet < 3), "%u of %u: %u", quiet, quiet + 1,
                      clocks_of(bus).reference);
        ck_assert_uint_eq(clock_of(bus, before).losses, quiet >= 3);
        ck_assert_uint_eq(clocks_of(bus).sync_losses, quiet >= 3);
        cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
        run(bus, 500);
        ck_assert(!clock_of(bus, clocks_of(bus).reference).lost);
        cm1e_bus_close(bus);
    }
}
END_TEST

/** It kept its power and its address, so it still gives the time: nothing of its clock is set anew but its pulses. */
START_TEST(a_reference_that_falls_back_to_init_stays_the_reference)
{
    enum { IN_INIT = 100, RECOVERED = 2000 };
    describe(1000);
    config.axes[DRIVE - 1].dc.sync0_us = 0;
    config.distributed_clocks = true;
    cm1e_bus_t *bus = start_drifting(30, 10, -40);
    run(bus, 20000);
    cm1e_sim_slave_fall_back(cm1e_sim_segment_slave(segment_of(bus), CM1E), CM1E_AL_INIT, 0x0011);
    run(bus, IN_INIT);
    cm1e_bus_request_recovery(bus, CM1E);
    for (int n = 0; n < RECOVERED; n++) {
        run(bus, 1);
        ck_assert_uint_eq(clocks_of(bus).reference, CM1E);
        ck_assert_msg(fabs(ahead_ns(bus, LAST)) < 200, "cycle %d: %g ns", n, ahead_ns(bus, LAST));
        ck_assert_msg(fabs(clocks_of(bus).phase_mean_ns) < 50, "%g ns", clocks_of(bus).phase_mean_ns);
    }
    ck_assert_uint_eq(cm1e_bus_slave_watch(bus, CM1E).al_state, CM1E_AL_OP);
    ck_assert_uint_eq(clocks_of(bus).sync_losses, 0);
    cm1e_bus_close(bus);
}
END_TEST

/** Somebody has asked for it while no frame came back: it has its address again in the first cycles in which frames
 *  return, before its silence tells that it was off. Its clock counts from 0, and the others do not follow it. */
START_TEST(a_reference_that_is_asked_for_while_it_is_off_does_not_take_the_others_along)
{
    enum { ASKED_AT = 100, BACK = 1500 };
    char line[32];
    describe(1000);
    cm1e_bus_t *bus = start_drifting(20, 60, -40);
    run(bus, 20000);
    snprintf(line, sizeof line, "power-cycle 1 %d", 200 + 17 * _i);
    simulate(bus, line);
    run(bus, ASKED_AT);
    for (uint16_t i = 1; i <= SLAVES; i++)
        cm1e_bus_request_recovery(bus, i);
    for (int n = 0; n < BACK; n++) {
        run(bus, 1);
        if (n > BACK / 2)
            cm1e_bus_request_recovery(bus, DRIVE); /* its pulses stayed away */
        ck_assert_msg(fabs(ahead_ns(bus, LAST) - ahead_ns(bus, DRIVE)) < 100000, "cycle %d: %g ns", n,
                      ahead_ns(bus, LAST) - ahead_ns(bus, DRIVE));
    }
    ck_assert_uint_eq(clocks_of(bus).reference, DRIVE);
    run(bus, 20000);
    for (uint16_t i = 1; i <= SLAVES; i++)
        ck_assert_msg(cm1e_bus_slave_watch(bus, i).al_state == CM1E_AL_OP && !clock_of(bus, i).lost, "slave %u: AL status 0x%02X 0x%04X%s", i,
                      cm1e_bus_slave_watch(bus, i).al_state, cm1e_bus_slave_watch(bus, i).al_status_code,
                      clock_of(bus, i).lost ? ", no synchronism" : "");
    ck_assert_msg(fabs(ahead_ns(bus, DRIVE)) < 200 && fabs(ahead_ns(bus, LAST)) < 200, "%g %g ns", ahead_ns(bus, DRIVE),
                  ahead_ns(bus, LAST));
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("silent clocks");
    TCase *tests = tcase_create("silent");
    tcase_set_timeout(tests, 60);
    tcase_add_loop_test(tests, a_slave_that_does_not_answer_ends_the_start_in_words, 0, ROWS);
    tcase_add_loop_test(tests, a_slave_that_answers_at_the_third_time_is_set_up, 0, ROWS);
    tcase_add_test(tests, a_clock_that_is_away_does_not_take_over);
    tcase_add_test(tests, a_reference_that_falls_back_to_init_stays_the_reference);
    tcase_add_loop_test(tests, a_reference_that_is_asked_for_while_it_is_off_does_not_take_the_others_along, 0, 12);
    tcase_add_test(tests, a_reference_that_is_silent_in_three_frames_in_a_row_is_away);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
