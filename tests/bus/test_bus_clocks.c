/* Distributed clocks: reference, delays, offsets, drift compensation in the frame of the cycle, SYNC0, the cycle that
 * follows the reference clock, and what is refused. */
#include "bus/dc_pace.h"
#include "clock_bench.h"
#include "sim/esc_chip.h"

START_TEST(all_clocks_are_one_before_operational_and_stay_so)
{
    describe(1000);
    cm1e_bus_t *bus = start_drifting(30, -50, 80);
    for (uint32_t i = DRIVE; i <= LAST; i++) {
        const cm1e_slave_clock_t clock = clock_of(bus, (uint16_t)i);
        ck_assert(clock.has_clock && !clock.is_reference && !clock.lost);
        ck_assert_uint_eq(clock.delay_ns, (i - 1) * ESC_HOP_NS);
        ck_assert_msg(abs(clock.deviation_ns) <= CM1E_CLOCK_TOLERANCE_NS, "%d ns", clock.deviation_ns);
    }
    ck_assert(clock_of(bus, 1).is_reference);
    ck_assert_uint_eq(clocks_of(bus).reference, 1);
    run(bus, 20000);
    for (uint32_t i = DRIVE; i <= LAST; i++)
        ck_assert_msg(ahead_ns(bus, i) < 130 && ahead_ns(bus, i) > -130, "slave %u: %.0f ns", i, ahead_ns(bus, i));
    ck_assert_uint_eq(clocks_of(bus).sync_losses, 0);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(the_cycle_follows_the_reference_clock)
{
    describe(1000);
    cm1e_bus_t *bus = start_drifting(_i ? 200 : -200, 0, 0);
    run(bus, 10000);
    const int64_t begin_ns = plan_ns;
    run(bus, 10000);
    const double drift = ((double)(plan_ns - begin_ns) / 10000 / CYCLE_NS - 1) * 1e6;
    ck_assert_msg(fabs(drift + (_i ? 200 : -200)) < 0.2, "%g ppm", drift);
    const cm1e_bus_clocks_t clocks = clocks_of(bus);
    ck_assert_msg(fabs(clocks.rate_ppm - drift) < 0.2, "%g ppm", clocks.rate_ppm);
    ck_assert_msg(fabs(clocks.phase_mean_ns) < 10, "%g ns", clocks.phase_mean_ns);
    ck_assert_msg(clocks.phase_maximum_ns < 20000, "%d ns", (int)clocks.phase_maximum_ns);
    cm1e_bus_close(bus);
}
END_TEST

/** Crystals that are not alike: how far the clocks were apart at the start is forgotten. */
START_TEST(maxima_are_those_since_operational)
{
    describe(1000);
    cm1e_bus_t *bus = start_drifting(200, -200, 100);
    run(bus, 2);
    const cm1e_bus_clocks_t clocks = clocks_of(bus);
    ck_assert_msg((double)clocks.phase_maximum_ns < 1.1 * fabs(clocks.phase_mean_ns), "%d ns, now %g ns",
                  (int)clocks.phase_maximum_ns, clocks.phase_mean_ns);
    ck_assert_uint_le(clock_of(bus, DRIVE).maximum_ns, CM1E_CLOCK_TOLERANCE_NS);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(maxima_of_crystals_that_are_alike_are_0)
{
    describe(1000);
    cm1e_bus_t *bus = start_drifting(0, 0, 0);
    run(bus, 1000);
    ck_assert_int_eq(clocks_of(bus).phase_maximum_ns, 0);
    for (uint16_t i = DRIVE; i <= LAST; i++) {
        const cm1e_slave_clock_t clock = clock_of(bus, i);
        ck_assert(clock.has_clock && !clock.lost);
        ck_assert_uint_eq(clock.maximum_ns, 0);
    }
    cm1e_bus_close(bus);
}
END_TEST

/** Neither the first frame of the run nor the pulses of the drive come at any other phase. */
START_TEST(frames_and_pulses_have_one_phase)
{
    static const struct {
        double sync0, sync1, shift;
        int64_t expected;
    } rows[] = {{1000, 0, 0, 500000}, {500, 0, 100, 100000}, {2000, 0, -250, -250000}, {1000, 250, 300, 300000}};
    describe(rows[_i].sync0);
    config.axes[DRIVE - 1].dc.sync1_us = rows[_i].sync1;
    config.axes[DRIVE - 1].dc.shift_us = rows[_i].shift;
    cm1e_bus_t *bus = start_drifting(20, -20, 0);
    run(bus, 2000);
    ck_assert_msg(llabs((long long)clocks_of(bus).phase_error_ns) < 1000, "%d ns",
                  (int)clocks_of(bus).phase_error_ns);
    cm1e_sim_clock_t drive;
    cm1e_sim_segment_clock(segment_of(bus), DRIVE, &drive);
    ck_assert_int_eq((drive.next_sync0_ns - rows[_i].expected) % (int64_t)(rows[_i].sync0 * 1000), 0);
    ck_assert_uint_gt(drive.sync0_pulses, 900);
    ck_assert(rows[_i].sync1 > 0 ? drive.sync1_pulses > 900 : drive.sync1_pulses == 0);
    ck_assert_int_eq(clock_of(bus, DRIVE).shift_ns, rows[_i].expected);
    cm1e_bus_close(bus);
}
END_TEST

/** Each slave at another time 20 ppm up or down, in the half minute that its housing needs; stamps jitter by 10 ns. */
START_TEST(temperature_steps_are_followed)
{
    describe(1000);
    cm1e_bus_t *bus = start_drifting(35, -48, 22);
    double worst = 0;
    for (int i = 0; i < 90; i++) { /* seconds */
        char line[40];
        snprintf(line, sizeof line, "clock %d %s %d", i % SLAVES + 1, i % 30 < SLAVES ? "temperature" : "jitter",
                 i % 30 < SLAVES ? (i / 30 % 2 ? -40 : 40) : 10);
        simulate(bus, line);
        run(bus, 1000);
        worst = fmax(worst, fmax(fabs(ahead_ns(bus, DRIVE)), fabs(ahead_ns(bus, LAST))));
        ck_assert_msg(i < 10 || fabs(clocks_of(bus).phase_mean_ns) < 50, "%g ns", clocks_of(bus).phase_mean_ns);
    }
    ck_assert_msg(worst < 150, "%g ns", worst);
    ck_assert_uint_eq(clocks_of(bus).sync_losses, 0);
    cm1e_bus_close(bus);
}
END_TEST

static unsigned process_frames, with_time;

static cm1e_tap_verdict_t count_times(void *context, cm1e_tap_frame_t *frame)
{
    enum { COMMAND_AT = 16, LENGTH_AT = 22, DATA_AT = 26, LRW_NUMBER = 12, FRMW_NUMBER = 14, MORE = 0x80 };
    const uint8_t *bytes = frame->bytes;
    (void)context;
    if (frame->direction != CM1E_TAP_SENT || frame->length < DATA_AT || bytes[COMMAND_AT] != LRW_NUMBER)
        return CM1E_TAP_PASS;
    const size_t second = DATA_AT + (cm1e_get_u16(bytes + LENGTH_AT) & 0x7FFu) + 2;
    process_frames++;
    with_time += (bytes[LENGTH_AT + 1] & MORE) && bytes[second] == FRMW_NUMBER &&
                 cm1e_get_u16(bytes + second + 4) == 0x0910;
    return CM1E_TAP_PASS;
}

/** Runs so many cycles. Returns how many frames of process data carried the time. */
static unsigned frames_with_time(cm1e_bus_t *bus, unsigned count)
{
    process_frames = with_time = 0;
    cm1e_nic_set_tap(cm1e_bus_nic(bus), count_times, NULL);
    run(bus, count);
    ck_assert_uint_eq(process_frames, count);
    return with_time;
}

static int64_t first_time_ns;

static cm1e_tap_verdict_t take_first_time(void *context, cm1e_tap_frame_t *frame)
{
    enum { COMMAND_AT = 16, LENGTH_AT = 22, DATA_AT = 26, LRW_NUMBER = 12 };
    const uint8_t *bytes = frame->bytes;
    (void)context;
    if (frame->direction == CM1E_TAP_RECEIVED && first_time_ns == 0 && bytes[COMMAND_AT] == LRW_NUMBER)
        first_time_ns = (int64_t)cm1e_get_u64(bytes + DATA_AT + (cm1e_get_u16(bytes + LENGTH_AT) & 0x7FFu) + 2 + 10);
    return CM1E_TAP_PASS;
}

/** Drives in Safe-Operational see no cycles that hurry after the phase. */
START_TEST(the_first_frame_has_the_phase_already)
{
    describe(1000);
    cm1e_bus_t *bus = open_drifting(100, 0, 0);
    ck_assert(cm1e_bus_scan(bus, &diag) == CM1E_OK && cm1e_bus_identify(bus, &diag) == CM1E_OK);
    ck_assert_msg(cm1e_bus_configure(bus, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_clock_sleep_until(cm1e_bus_clock(bus), now_of(bus) + 333333);
    first_time_ns = 0;
    cm1e_nic_set_tap(cm1e_bus_nic(bus), take_first_time, NULL);
    ck_assert_msg(cm1e_bus_operate(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(llabs((long long)cm1e_dc_phase(first_time_ns, CYCLE_NS)) < 2000, "%d ns",
                  (int)cm1e_dc_phase(first_time_ns, CYCLE_NS));
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(the_time_goes_in_the_frame_of_the_process_data)
{
    describe(1000);
    cm1e_bus_t *bus = start_drifting(0, 10, 20);
    ck_assert_uint_eq(frames_with_time(bus, 100), 100);
    cm1e_bus_close(bus);
}
END_TEST

/** Without a request nothing is sent that was not sent before. */
START_TEST(clocks_that_nobody_asked_for_are_left_alone)
{
    describe(0);
    cm1e_bus_t *bus = start_drifting(0, 10, 20);
    ck_assert_uint_eq(frames_with_time(bus, 100), 0);
    ck_assert(!clocks_of(bus).used);
    ck_assert_int_eq(cm1e_bus_pace(bus), 0);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(a_bus_of_motors_may_follow_a_clock_without_sync0)
{
    sim_config(2);
    config.distributed_clocks = true;
    cm1e_bus_t *bus = start_bus();
    simulate(bus, "clock 1 drift 60");
    run(bus, 10000);
    ck_assert_msg(fabs(clocks_of(bus).phase_mean_ns) < 50, "%g ns", clocks_of(bus).phase_mean_ns);
    ck_assert_int_eq(cm1e_bus_slave_watch(bus, 1).al_state, CM1E_AL_OP);
    cm1e_bus_close(bus);
}
END_TEST

/** A device without a motor: an analog input, which has no outputs that could come in time. */
START_TEST(a_slave_without_an_axis_gets_pulses_too)
{
    sim_config(1);
    cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(&config, "encoder");
    slave->address = 2;
    slave->sim = (cm1e_sim_slave_config_t){.kind = CM1E_SIM_SLAVE_ANALOG, .inputs = 2};
    slave->dc = (cm1e_dc_config_t){.sync0_us = 250, .shift_us = -100};
    cm1e_bus_t *bus = open_bus();
    simulate(bus, "clock 2 drift -30");
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    plan_ns = 0;
    run(bus, 3000);
    cm1e_sim_clock_t clock;
    cm1e_sim_segment_clock(segment_of(bus), 2, &clock);
    ck_assert_int_eq((clock.next_sync0_ns + 100000) % 250000, 0);
    ck_assert_uint_gt(clock.sync0_pulses, 11900);
    ck_assert_uint_eq(clock_of(bus, 2).sync0_ns, 250000);
    ck_assert_uint_eq(cm1e_bus_slave_watch(bus, 2).al_state, CM1E_AL_OP);
    cm1e_bus_close(bus);
    slave->dc.sync0_us = 333;
    ck_assert_int_eq(cm1e_bus_config_check(&config, &diag), CM1E_ERROR_CONFIG);
    ck_assert_msg(strstr(diag.text, "slave encoder: dc.sync0_us") != NULL, "%s", diag.text);
}
END_TEST

static cm1e_slave_config_t *add_encoder(int64_t cycle_ns)
{
    sim_config(1);
    config.cycle_time_ns = cycle_ns;
    config.axes[0].firmware[0] = '\0'; /* an old one knows 1 ms only */
    cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(&config, "encoder");
    slave->address = 2;
    slave->sim = (cm1e_sim_slave_config_t){.kind = CM1E_SIM_SLAVE_ANALOG, .inputs = 2};
    return slave;
}

/** The pulses of a mode in the EEPROM of the slave (category 60), and the objects that say how it is synchronised. */
START_TEST(a_mode_of_the_eeprom_gives_the_pulses)
{
    static const struct {
        const char *mode;
        int64_t cycle_ns;
        double shift_us;
        uint32_t sync0_ns, sync1_ns;
        int32_t shift_ns;
        unsigned control, type; /* of 0x0980, 0x1C32:01 */
    } rows[] = {
        {"DC-Synchron", 1000000, 0, 1000000, 0, 510000, 0x0300, 2},
        {"first", 250000, -20, 250000, 0, -10000, 0x0300, 2},
        {"DC-Oversampling", 1000000, 100, 250000, 750000, 100000, 0x0730, 3},
        {"SM-Synchron", 1000000, 0, 0, 0, 0, 0, 1},
    };
    cm1e_slave_config_t *slave = add_encoder(rows[_i].cycle_ns);
    strcpy(slave->dc.mode, rows[_i].mode);
    slave->dc.shift_us = rows[_i].shift_us;
    cm1e_bus_t *bus = start_bus();
    const cm1e_slave_clock_t clock = clock_of(bus, 2);
    ck_assert_uint_eq(clock.sync0_ns, rows[_i].sync0_ns);
    ck_assert_uint_eq(clock.sync1_ns, rows[_i].sync1_ns);
    ck_assert_int_eq(clock.shift_ns, rows[_i].shift_ns);
    const uint8_t *memory = cm1e_sim_segment_slave(segment_of(bus), 2)->memory;
    ck_assert_uint_eq(memory[0x0980] & 0xF0u, rows[_i].control & 0xF0u);
    ck_assert_uint_eq(memory[0x0981], rows[_i].control >> 8);
    for (unsigned round = 0; round < 2; round++) { /* at the start, and when it comes back */
        uint8_t type[4];
        for (uint16_t index = 0x1C32; index <= 0x1C33; index++) {
            size_t size = sizeof type;
            ck_assert_int_eq(cm1e_sdo_read(bus, 2, index, 1, type, &size, &diag), CM1E_OK);
            ck_assert_uint_eq(cm1e_get_u16(type), rows[_i].type);
        }
        if (round == 0)
            simulate(bus, "power-cycle 2 20");
        for (unsigned n = 0; n < 6000; n++)
            cycle(bus);
        ck_assert_uint_eq(cm1e_bus_slave_watch(bus, 2).al_state, CM1E_AL_OP);
        ck_assert_uint_eq(memory[0x0980] & 0xF0u, rows[_i].control & 0xF0u);
    }
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(a_mode_that_there_is_not_is_told_with_those_there_are)
{
    cm1e_slave_config_t *slave = add_encoder(1000000);
    static const char *const unknown[] = {"DC-Latch", "x"};
    cm1e_bus_t *bus;
    for (int i = 0; i < 2; i++) {
        char words[40];
        snprintf(words, sizeof words, "has no mode \"%s\"", unknown[i]);
        strcpy(slave->dc.mode, unknown[i]);
        bus = open_bus();
        ck_assert_int_eq(cm1e_bus_start(bus, &diag), CM1E_ERROR_CONFIG);
        ck_assert_msg(strstr(diag.text, words) && strstr(diag.text, "\"DC-Synchron\", \"DC-Over"), "%s", diag.text);
        cm1e_bus_close(bus);
    }
    strcpy(slave->dc.mode, "DC-Oversampling"); /* 200 us / 4 is shorter than any controller can do */
    config.cycle_time_ns = 200000;
    bus = open_bus();
    ck_assert_int_eq(cm1e_bus_start(bus, &diag), CM1E_ERROR_CONFIG);
    ck_assert_msg(strstr(diag.text, "cannot be used: dc.sync0_us is 50"), "%s", diag.text);
    cm1e_bus_close(bus);
    slave->dc.sync0_us = 1000;
    ck_assert_int_eq(cm1e_bus_config_check(&config, &diag), CM1E_ERROR_CONFIG);
    ck_assert_msg(strstr(diag.text, "slave encoder: dc.mode is given together"), "%s", diag.text);
}
END_TEST

/** Junctions: a frame comes back out of one branch before it goes into the next one, so what is behind has the delay of
 *  all that was visited before. The slaves of a tree are as exact as those of a line. */
START_TEST(clocks_of_a_tree_have_the_delays_of_its_branches)
{
    enum { SLAVES_OF_TREE = 6 };
    static const struct {
        const char *quirks[3];
        unsigned hops[SLAVES_OF_TREE]; /* from slave to slave, until a frame is processed there */
    } trees[] = {
        {{"quirk 2 branch 3001", "quirk 6 branch 1001"}, {0, 1, 2, 3, 4, 9}},
        {{"quirk 3 branch 3002", "quirk 5 branch 1002", "quirk 6 branch 2002"}, {0, 1, 2, 3, 6, 8}},
        {{"quirk 4 branch 3003", "quirk 5 branch 1003", "quirk 6 branch 2002"}, {0, 1, 2, 3, 5, 8}},
    };
    sim_config(SLAVES_OF_TREE);
    config.distributed_clocks = true;
    cm1e_bus_t *bus = open_bus();
    for (unsigned i = 0; i < 3; i++)
        if (trees[_i].quirks[i])
            simulate(bus, trees[_i].quirks[i]);
    simulate(bus, "clock 3 drift 30");
    simulate(bus, "clock 6 drift -40");
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    plan_ns = 0;
    run(bus, 5000);
    for (uint32_t i = 0; i < SLAVES_OF_TREE; i++) {
        ck_assert_uint_eq(clock_of(bus, (uint16_t)(i + 1)).delay_ns, trees[_i].hops[i] * ESC_HOP_NS);
        ck_assert_msg(fabs(ahead_ns(bus, i + 1)) < 60, "slave %u: %g ns", i + 1, ahead_ns(bus, i + 1));
    }
    cm1e_bus_close(bus);
}
END_TEST

/** Pulses so far apart that the first one comes long after all clocks are together: no slave is asked for Operational
 *  before it, at the start and when it comes back. At 250 us that matters with short pulses too. */
START_TEST(no_slave_is_asked_for_operational_before_its_first_pulse)
{
    static const struct {
        uint32_t cycle_ns;
        double sync0_us;
    } rows[] = {{250000, 250}, {1000000, 300000}};
    add_encoder(rows[_i].cycle_ns)->dc.sync0_us = rows[_i].sync0_us;
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 500);
    simulate(bus, "power-cycle 2 50");
    bool seen_away = false;
    for (unsigned n = 0; n < 12000; n++) {
        cycle(bus);
        const cm1e_slave_watch_t watch = cm1e_bus_slave_watch(bus, 2);
        seen_away |= watch.lost;
        ck_assert_msg(watch.al_status_code == 0, "cycle %u: AL status code 0x%04X", n, watch.al_status_code);
    }
    ck_assert(seen_away);
    ck_assert_uint_eq(cm1e_bus_slave_watch(bus, 2).al_state, CM1E_AL_OP);
    cm1e_bus_close(bus);
}
END_TEST

static unsigned frames_until_loss, losses_in_a_row;

static cm1e_tap_verdict_t lose_some(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    if (frame->direction != CM1E_TAP_RECEIVED)
        return CM1E_TAP_PASS;
    if (frames_until_loss > 0) {
        frames_until_loss--;
        return CM1E_TAP_PASS;
    }
    if (losses_in_a_row == 0)
        return CM1E_TAP_PASS;
    losses_in_a_row--;
    return CM1E_TAP_DROP;
}

/** Two frames lost at every moment from the configuration on: the clocks are right in spite of that. */
START_TEST(a_start_with_lost_frames_gives_right_clocks)
{
    enum { MOMENTS = 200 };
    for (unsigned moment = 0; moment < MOMENTS; moment++) {
        describe(1000);
        cm1e_bus_t *bus = open_drifting(30, -50, 80);
        ck_assert(cm1e_bus_scan(bus, &diag) == CM1E_OK && cm1e_bus_identify(bus, &diag) == CM1E_OK);
        frames_until_loss = moment < 150 ? moment * 3 : moment * 40;
        losses_in_a_row = 2;
        cm1e_nic_set_tap(cm1e_bus_nic(bus), lose_some, NULL);
        ck_assert_msg(cm1e_bus_configure(bus, &diag) == CM1E_OK, "%u: %s", moment, diag.text);
        ck_assert_msg(cm1e_bus_operate(bus, &diag) == CM1E_OK, "%u: %s", moment, diag.text);
        plan_ns = 0;
        run(bus, 300);
        for (uint32_t i = DRIVE; i <= LAST; i++)
            ck_assert_msg(fabs(ahead_ns(bus, i)) < 500, "%u: slave %u: %g ns", moment, i, ahead_ns(bus, i));
        ck_assert_msg(fabs(clocks_of(bus).phase_mean_ns) < 20000, "%u: %g ns", moment, clocks_of(bus).phase_mean_ns);
        ck_assert_uint_eq(cm1e_bus_slave_watch(bus, DRIVE).al_state, CM1E_AL_OP);
        cm1e_bus_close(bus);
    }
}
END_TEST

/* ---- what is refused --------------------------------------------------------------------------------------------- */

static void expect_refused(cm1e_bus_t *bus, cm1e_error_t error, const char *part)
{
    memset(&diag, 0, sizeof diag);
    ck_assert_int_eq(cm1e_bus_start(bus, &diag), error);
    ck_assert_msg(strstr(diag.text, part) != NULL, "%s", diag.text);
    cm1e_bus_close(bus);
}

START_TEST(sync0_of_a_device_without_clocks_is_refused)
{
    describe(1000);
    cm1e_bus_t *bus = open_drifting(0, 0, 0);
    simulate(bus, "clock 2 none");
    expect_refused(bus, CM1E_ERROR_CONFIG, "has no distributed clocks");
}
END_TEST

START_TEST(a_bus_without_any_clock_is_refused)
{
    sim_config(1);
    config.distributed_clocks = true;
    cm1e_bus_t *bus = open_bus();
    simulate(bus, "clock 1 none");
    expect_refused(bus, CM1E_ERROR_CONFIG, "No slave has distributed clocks");
}
END_TEST

START_TEST(sync0_of_a_motor_that_runs_by_its_process_data_is_refused)
{
    sim_config(1);
    config.axes[0].dc.sync0_us = 1000;
    ck_assert_int_eq(cm1e_bus_config_check(&config, &diag), CM1E_ERROR_CONFIG);
    ck_assert_msg(strstr(diag.text, "takes its cycle from the process data") != NULL, "%s", diag.text);
    describe(1000);
    strcpy(config.second_interface, "sim");
    ck_assert_int_eq(cm1e_bus_config_check(&config, &diag), CM1E_ERROR_CONFIG);
    ck_assert_msg(strstr(diag.text, "broken ring") != NULL, "%s", diag.text);
    describe(300);
    ck_assert_int_eq(cm1e_bus_config_check(&config, &diag), CM1E_ERROR_CONFIG);
    ck_assert_msg(strstr(diag.text, "dc.sync0_us") != NULL, "%s", diag.text);
    describe(1000);
    config.axes[DRIVE - 1].dc.shift_us = 1000;
    ck_assert_int_eq(cm1e_bus_config_check(&config, &diag), CM1E_ERROR_CONFIG);
    ck_assert_msg(strstr(diag.text, "dc.shift_us") != NULL, "%s", diag.text);
}
END_TEST

START_TEST(a_clock_that_does_not_follow_is_told_before_operational)
{
    describe(1000);
    cm1e_bus_t *bus = open_drifting(0, 0, 200);
    simulate(bus, "clock 3 free");
    expect_refused(bus, CM1E_ERROR_BUS_CLOCKS, "does not follow the reference clock");
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus clocks");
    TCase *good = tcase_create("in step"), *refused = tcase_create("refused");
    tcase_add_test(good, all_clocks_are_one_before_operational_and_stay_so);
    tcase_add_loop_test(good, the_cycle_follows_the_reference_clock, 0, 2);
    tcase_add_test(good, maxima_are_those_since_operational);
    tcase_add_test(good, maxima_of_crystals_that_are_alike_are_0);
    tcase_add_test(good, temperature_steps_are_followed);
    tcase_add_loop_test(good, frames_and_pulses_have_one_phase, 0, 4);
    tcase_add_test(good, the_first_frame_has_the_phase_already);
    tcase_add_test(good, the_time_goes_in_the_frame_of_the_process_data);
    tcase_add_test(good, clocks_that_nobody_asked_for_are_left_alone);
    tcase_add_test(good, a_bus_of_motors_may_follow_a_clock_without_sync0);
    tcase_add_test(good, a_slave_without_an_axis_gets_pulses_too);
    tcase_add_loop_test(good, a_mode_of_the_eeprom_gives_the_pulses, 0, 4);
    tcase_add_test(good, a_mode_that_there_is_not_is_told_with_those_there_are);
    tcase_add_loop_test(good, clocks_of_a_tree_have_the_delays_of_its_branches, 0, 3);
    tcase_add_loop_test(good, no_slave_is_asked_for_operational_before_its_first_pulse, 0, 2);
    tcase_add_test(good, a_start_with_lost_frames_gives_right_clocks);
    tcase_add_test(refused, sync0_of_a_device_without_clocks_is_refused);
    tcase_add_test(refused, a_bus_without_any_clock_is_refused);
    tcase_add_test(refused, sync0_of_a_motor_that_runs_by_its_process_data_is_refused);
    tcase_add_test(refused, a_clock_that_does_not_follow_is_told_before_operational);
    suite_add_tcase(suite, good);
    suite_add_tcase(suite, refused);
    return run_suite(suite);
}
