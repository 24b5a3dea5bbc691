/* Distributed clocks: loss of synchronism, pulses and process data that stay away, slaves that come back, another
 * reference. */
#include "clock_bench.h"
#include "cm1e/hot_connect.h"
#include "sim/esc_chip.h"
#include "sim/segment.h"

START_TEST(a_clock_that_leaves_the_reference_is_counted_once)
{
    describe(1000);
    cm1e_bus_t *bus = start_drifting(0, 0, 5);
    simulate(bus, "clock 3 free");
    run(bus, 1000);
    ck_assert_uint_eq(clocks_of(bus).sync_losses, 1);
    ck_assert(clock_of(bus, LAST).lost);
    ck_assert_int_gt(clock_of(bus, LAST).deviation_ns, CM1E_CLOCK_TOLERANCE_NS);
    simulate(bus, "clock 3 follow");
    run(bus, 2000);
    ck_assert(!clock_of(bus, LAST).lost);
    ck_assert_uint_eq(clocks_of(bus).sync_losses, 1);
    ck_assert_uint_eq(clock_of(bus, LAST).losses, 1);
    cm1e_bus_close(bus);
}
END_TEST

/** The looks at the clocks and the search take turns with the supervision. */
START_TEST(clocks_are_looked_at_while_an_optional_slave_is_searched_for)
{
    describe(1000);
    cm1e_slave_config_t *tool = cm1e_bus_config_add_slave(&config, "tool");
    *tool = (cm1e_slave_config_t){.name = "tool", .address_kind = CM1E_ADDRESS_ALIAS, .address = 4711, .vendor = 0x4D8,
                                  .product = 1, .optional = true,
                                  .sim = {.kind = CM1E_SIM_SLAVE_DIGITAL, .inputs = 4, .outputs = 4}};
    cm1e_bus_t *bus = open_drifting(0, 0, 5);
    cm1e_sim_segment_detach(segment_of(bus), LAST + 1, false);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    plan_ns = 0;
    run(bus, 1000);
    simulate(bus, "clock 3 free");
    run(bus, 1000);
    ck_assert_uint_eq(clock_of(bus, LAST).losses, 1);
    cm1e_sim_segment_attach(segment_of(bus), LAST + 1);
    run(bus, 4000);
    ck_assert_int_eq(cm1e_bus_presence(bus, LAST + 1), CM1E_PRESENCE_THERE);
    ck_assert_uint_eq(clock_of(bus, LAST).losses, 1);
    cm1e_bus_close(bus);
}
END_TEST

static void expect_left(cm1e_bus_t *bus, uint16_t code)
{
    run(bus, 300);
    const cm1e_slave_watch_t watch = cm1e_bus_slave_watch(bus, DRIVE);
    ck_assert_uint_eq(watch.al_state, CM1E_AL_SAFE_OP | CM1E_AL_ERROR);
    ck_assert_uint_eq(watch.al_status_code, code);
}

static void expect_back(cm1e_bus_t *bus)
{
    cm1e_bus_request_recovery(bus, DRIVE);
    run(bus, 3000);
    ck_assert_uint_eq(cm1e_bus_slave_watch(bus, DRIVE).al_state, CM1E_AL_OP);
    run(bus, 1000);
    ck_assert_uint_eq(cm1e_bus_slave_watch(bus, DRIVE).al_state, CM1E_AL_OP);
    ck_assert_msg(fabs(ahead_ns(bus, DRIVE)) < 300, "%g ns", ahead_ns(bus, DRIVE));
}

START_TEST(a_drive_without_pulses_leaves_operational_and_comes_back)
{
    describe(1000);
    cm1e_bus_t *bus = start_drifting(0, 10, 0);
    simulate(bus, "clock 2 silent");
    expect_left(bus, 0x002C);
    simulate(bus, "clock 2 pulses");
    expect_back(bus);
    cm1e_bus_close(bus);
}
END_TEST

/** Only the codes that tell of the clock: 0x001A, 0x002C, 0x002D and 0x0030 ... 0x0037 (ETG.1020). */
START_TEST(other_errors_of_a_drive_are_no_loss_of_its_clock)
{
    static const struct {
        uint16_t code;
        unsigned losses;
    } rows[] = {{0x001A, 1}, {0x001B, 0}, {0x002B, 0}, {0x002C, 1}, {0x002D, 1}, {0x002E, 0},
                {0x002F, 0}, {0x0030, 1}, {0x0037, 1}, {0x0038, 0}, {0x8000, 0}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        describe(1000);
        cm1e_bus_t *bus = start_drifting(0, 10, 0);
        note_status(bus, DRIVE, rows[i].code);
        ck_assert_msg(clock_of(bus, DRIVE).losses == rows[i].losses, "0x%04X", rows[i].code);
        cm1e_bus_close(bus);
    }
}
END_TEST

/** Each time from the first step on: without power the controller has forgotten all of it. */
START_TEST(a_clock_is_set_at_every_recovery)
{
    describe(1000);
    cm1e_bus_t *bus = start_drifting(0, 10, 0);
    for (int n = 0; n < 2; n++) {
        simulate(bus, "power-cycle 2 20");
        run(bus, 300);
        expect_back(bus);
    }
    cm1e_bus_close(bus);
}
END_TEST

/** From its first cycle on, before the controller of the slave has corrected anything. */
START_TEST(a_clock_that_was_off_is_set_with_the_delay_of_its_cables)
{
    describe(1000);
    cm1e_bus_t *bus = start_drifting(0, 0, 0);
    simulate(bus, "power-cycle 2 20");
    run(bus, 300);
    cm1e_bus_request_recovery(bus, DRIVE);
    for (int n = 0; n < 3000 && fabs(ahead_ns(bus, DRIVE)) > ESC_HOP_NS * 100; n++)
        run(bus, 1);
    ck_assert_msg(fabs(ahead_ns(bus, DRIVE)) < ESC_HOP_NS / 5.0, "%g ns", ahead_ns(bus, DRIVE));
    cm1e_bus_close(bus);
}
END_TEST

/** Shorter than the watchdog of the process data: what acts is the supervision by SYNC0. */
START_TEST(a_drive_without_process_data_at_its_pulses_leaves_operational)
{
    describe(1000);
    cm1e_bus_t *bus = start_drifting(0, 10, 0);
    run(bus, 100);
    cm1e_clock_sleep_until(cm1e_bus_clock(bus), now_of(bus) + 40 * CYCLE_NS);
    plan_ns += 40 * CYCLE_NS;
    run(bus, 300);
    ck_assert_uint_eq(cm1e_bus_slave_watch(bus, DRIVE).al_state, CM1E_AL_OP);
    cm1e_clock_sleep_until(cm1e_bus_clock(bus), now_of(bus) + 70 * CYCLE_NS);
    plan_ns += 70 * CYCLE_NS;
    expect_left(bus, 0x001A);
    cm1e_bus_close(bus);
}
END_TEST

/** The plan that the bus makes for a program goes on in the raster of the reference clock. */
START_TEST(the_next_cycle_after_a_pause_is_in_the_raster_of_the_ones_before)
{
    describe(1000);
    cm1e_bus_t *bus = start_drifting(0, 0, 0);
    const int64_t first_ns = cm1e_bus_next_start(bus, now_of(bus));
    for (int64_t pause_ns = 0; pause_ns < 9 * CYCLE_NS; pause_ns += CYCLE_NS / 4) {
        const int64_t now_ns = first_ns + pause_ns, next_ns = cm1e_bus_next_start(bus, now_ns);
        ck_assert_int_eq((next_ns - first_ns) % CYCLE_NS, 0);
        ck_assert_int_ge(next_ns, now_ns);
        ck_assert_int_lt(next_ns, now_ns + CYCLE_NS);
    }
    cm1e_bus_close(bus);
}
END_TEST

/** Between the configuration and the first cycle, too, as long as a program works with the slaves. */
START_TEST(clocks_stay_together_while_a_configured_bus_is_asked)
{
    describe(1000);
    cm1e_bus_t *bus = open_drifting(0, 100, -100);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK && cm1e_bus_identify(bus, &diag) == CM1E_OK &&
                  cm1e_bus_configure(bus, &diag) == CM1E_OK, "%s", diag.text);
    const int64_t end_ns = now_of(bus) + 2000 * INT64_C(1000000);
    while (now_of(bus) < end_ns) {
        uint8_t type[4];
        size_t size = sizeof type;
        ck_assert_int_eq(cm1e_sdo_read(bus, CM1E, 0x1000, 0, type, &size, &diag), CM1E_OK);
        ck_assert_msg(fabs(ahead_ns(bus, DRIVE)) < CM1E_CLOCK_TOLERANCE_NS && fabs(ahead_ns(bus, LAST)) < CM1E_CLOCK_TOLERANCE_NS,
                      "%g and %g ns", ahead_ns(bus, DRIVE), ahead_ns(bus, LAST));
    }
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(a_drive_whose_clock_runs_away_leaves_operational)
{
    describe(1000);
    cm1e_bus_t *bus = start_drifting(0, 10, 0);
    simulate(bus, "clock 2 step 50000");
    expect_left(bus, 0x0032);
    run(bus, 3000);
    expect_back(bus);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(the_clock_of_a_drive_that_was_off_is_set_again)
{
    describe(1000);
    cm1e_bus_t *bus = start_drifting(20, 60, 0);
    simulate(bus, "power-cycle 2 200");
    run(bus, 400);
    ck_assert_uint_ne(cm1e_bus_slave_watch(bus, DRIVE).al_state, CM1E_AL_OP);
    expect_back(bus);
    cm1e_sim_clock_t drive;
    cm1e_sim_segment_clock(segment_of(bus), DRIVE, &drive);
    ck_assert_int_eq((drive.next_sync0_ns - CYCLE_NS / 2) % CYCLE_NS, 0);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(lost_frames_do_not_disturb_the_clocks)
{
    describe(1000);
    cm1e_bus_t *bus = start_drifting(100, 0, -100);
    run(bus, 5000);
    for (int i = 0; i < 50; i++) {
        simulate(bus, "lose 9");
        run(bus, 100);
    }
    ck_assert_uint_eq(clocks_of(bus).sync_losses, 0);
    /* Waiting for a lost frame delays the next one by a quarter of a cycle: that is no reason to change the rate. */
    ck_assert_msg(fabs(clocks_of(bus).rate_ppm + 100) < 1, "%g ppm", clocks_of(bus).rate_ppm);
    run(bus, 1000);
    ck_assert_msg(fabs(clocks_of(bus).phase_mean_ns) < 30, "%g ns", clocks_of(bus).phase_mean_ns);
    cm1e_bus_close(bus);
}
END_TEST

/** The controller of the reference no longer answers at its address; its cables still lead on. */
START_TEST(another_clock_takes_over_from_a_reference_that_is_away)
{
    describe(1000);
    cm1e_bus_t *bus = start_drifting(0, 10, -10);
    run(bus, 20000);
    cm1e_put_u16(cm1e_sim_segment_slave(segment_of(bus), CM1E)->memory + ESC_STATION_ADDRESS, 0);
    run(bus, 1000);
    ck_assert_uint_eq(clocks_of(bus).reference, DRIVE);
    ck_assert(clock_of(bus, DRIVE).is_reference && !clock_of(bus, CM1E).is_reference);
    ck_assert_uint_eq(clocks_of(bus).sync_losses, 1);
    ck_assert_uint_eq(cm1e_bus_slave_watch(bus, DRIVE).al_state, CM1E_AL_OP);
    ck_assert(!clock_of(bus, LAST).lost);
    ck_assert_msg(fabs(ahead_ns(bus, LAST) - ahead_ns(bus, DRIVE)) < 100, "%g ns",
                  ahead_ns(bus, LAST) - ahead_ns(bus, DRIVE));
    cm1e_bus_close(bus);
}
END_TEST

/** The first slave of a line was off: no frame came back meanwhile, and its clock counts from 0 again. */
START_TEST(a_reference_that_was_off_comes_back_as_one_of_the_others)
{
    describe(1000);
    cm1e_bus_t *bus = start_drifting(20, 60, -40);
    run(bus, 5000);
    simulate(bus, "power-cycle 1 300");
    run(bus, 400);
    for (uint16_t i = 1; i <= SLAVES; i++)
        cm1e_bus_request_recovery(bus, i);
    run(bus, 4000);
    for (uint16_t i = 1; i <= SLAVES; i++)
        ck_assert_uint_eq(cm1e_bus_slave_watch(bus, i).al_state, CM1E_AL_OP);
    ck_assert_uint_eq(clocks_of(bus).reference, DRIVE);
    run(bus, 20000);
    ck_assert_msg(fabs(ahead_ns(bus, DRIVE)) < 200 && fabs(ahead_ns(bus, LAST)) < 200, "%g %g ns", ahead_ns(bus, DRIVE),
                  ahead_ns(bus, LAST));
    ck_assert_msg(fabs(clocks_of(bus).phase_mean_ns) < 50, "%g ns", clocks_of(bus).phase_mean_ns);
    ck_assert(!clock_of(bus, CM1E).lost);
    cm1e_bus_close(bus);
}
END_TEST

/** A coupler is brought back without a request: it has its address again in the first cycles in which frames return. */
START_TEST(a_coupler_that_was_off_does_not_take_the_others_along)
{
    sim_config(2);
    config.sim_gaps = CM1E_SIM_IO_COUPLER;
    config.distributed_clocks = true;
    config.axes[0].address = 2;
    config.axes[1].address = 3;
    cm1e_bus_t *bus = open_drifting(20, -50, 80);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    plan_ns = 0;
    run(bus, 20000);
    ck_assert_uint_eq(clocks_of(bus).reference, 1);
    simulate(bus, "power-cycle 1 300");
    for (int i = 0; i < 1000; i++) {
        run(bus, 1);
        ck_assert_msg(fabs(ahead_ns(bus, 3) - ahead_ns(bus, 2)) < 20000, "%d: %g ns", i,
                      ahead_ns(bus, 3) - ahead_ns(bus, 2));
    }
    ck_assert_uint_eq(clocks_of(bus).reference, 2);
    run(bus, 5000);
    ck_assert_uint_eq(cm1e_bus_slave_watch(bus, 1).al_state, CM1E_AL_OP);
    ck_assert_msg(fabs(ahead_ns(bus, 3)) < 200, "%g ns", ahead_ns(bus, 3));
    ck_assert(!clock_of(bus, 1).lost && !clock_of(bus, 3).lost);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(the_only_clock_is_the_reference_again)
{
    sim_config(1);
    config.distributed_clocks = true;
    cm1e_bus_t *bus = start_bus();
    plan_ns = 0;
    simulate(bus, "clock 1 drift 100");
    run(bus, 5000);
    for (unsigned round = 1; round <= 2; round++) { /* each time when it is set, and not before */
        simulate(bus, "power-cycle 1 300");
        run(bus, 400);
        ck_assert_uint_eq(clocks_of(bus).reference, 0);
        cm1e_bus_request_recovery(bus, 1);
        run(bus, 200);
        const int64_t before_ns = clocks_of(bus).reference_ns;
        run(bus, 3000);
        ck_assert_uint_eq(cm1e_bus_slave_watch(bus, 1).al_state, CM1E_AL_OP);
        ck_assert_uint_eq(clocks_of(bus).reference, 1);
        ck_assert_msg(fabs(clocks_of(bus).phase_mean_ns) < 50, "%g ns", clocks_of(bus).phase_mean_ns);
        ck_assert_int_gt(clocks_of(bus).reference_ns, before_ns);
        ck_assert(!clock_of(bus, 1).lost && clock_of(bus, 1).losses == round);
    }
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("lost clocks");
    TCase *lost = tcase_create("lost");
    tcase_add_test(lost, a_clock_that_leaves_the_reference_is_counted_once);
    tcase_add_test(lost, clocks_are_looked_at_while_an_optional_slave_is_searched_for);
    tcase_add_test(lost, a_drive_without_pulses_leaves_operational_and_comes_back);
    tcase_add_test(lost, other_errors_of_a_drive_are_no_loss_of_its_clock);
    tcase_add_test(lost, a_clock_is_set_at_every_recovery);
    tcase_add_test(lost, a_clock_that_was_off_is_set_with_the_delay_of_its_cables);
    tcase_add_test(lost, a_drive_without_process_data_at_its_pulses_leaves_operational);
    tcase_add_test(lost, the_next_cycle_after_a_pause_is_in_the_raster_of_the_ones_before);
    tcase_add_test(lost, clocks_stay_together_while_a_configured_bus_is_asked);
    tcase_add_test(lost, a_drive_whose_clock_runs_away_leaves_operational);
    tcase_add_test(lost, the_clock_of_a_drive_that_was_off_is_set_again);
    tcase_add_test(lost, lost_frames_do_not_disturb_the_clocks);
    tcase_add_test(lost, another_clock_takes_over_from_a_reference_that_is_away);
    tcase_add_test(lost, a_reference_that_was_off_comes_back_as_one_of_the_others);
    tcase_add_test(lost, a_coupler_that_was_off_does_not_take_the_others_along);
    tcase_add_test(lost, the_only_clock_is_the_reference_again);
    suite_add_tcase(suite, lost);
    return run_suite(suite);
}
