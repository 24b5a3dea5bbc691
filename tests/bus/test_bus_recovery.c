/* A slave that left the network comes back: reset, power cycle, replug, watchdog; while the others keep running. */
#include "bus_support.h"
#include "sim/esc_chip.h"

/** Cycles as a program would run them: whoever is not in OP is asked back. Returns how many it took until all are. */
static unsigned cycles_until_recovered(cm1e_bus_t *bus, unsigned limit)
{
    const uint32_t count = cm1e_bus_slave_count(bus);
    for (unsigned n = 1; n <= limit; n++) {
        const cm1e_error_t error = cycle(bus);
        bool all = error == CM1E_OK && cm1e_bus_health(bus) == CM1E_OK;
        for (uint16_t position = 1; position <= count; position++) {
            const cm1e_slave_watch_t watch = cm1e_bus_slave_watch(bus, position);
            if (!watch.lost && watch.al_state == CM1E_AL_OP)
                continue;
            all = false;
            cm1e_bus_request_recovery(bus, position);
        }
        if (all)
            return n;
    }
    return 0;
}

/** Whoever looks at the simulated slaves themselves. */
static unsigned state_of(cm1e_bus_t *bus, uint32_t position)
{
    return cm1e_sim_slave_al_state(cm1e_sim_segment_slave(segment_of(bus), position));
}

/** Acts on the segment and lets the frame that was already on its way come back. */
static void strike(cm1e_bus_t *bus, const char *line)
{
    simulate(bus, line);
    cycle(bus);
}

static void check_all_run(cm1e_bus_t *bus)
{
    for (uint32_t position = 1; position <= cm1e_bus_slave_count(bus); position++)
        ck_assert_uint_eq(state_of(bus, position), CM1E_AL_OP);
    cycles(bus, 200);
}

START_TEST(power_cycled_slave_comes_back)
{
    sim_config(3);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 50);
    char line[40];
    snprintf(line, sizeof line, "power-cycle %d 80", _i);
    strike(bus, line);
    bool seen_lost = false;
    for (int n = 0; n < 60; n++) {
        ck_assert_int_ne(cycle(bus), CM1E_OK);
        seen_lost = seen_lost || cm1e_bus_slave_watch(bus, (uint16_t)_i).lost;
        if (_i > 1)
            ck_assert_uint_eq(state_of(bus, 1), CM1E_AL_OP);
    }
    ck_assert(seen_lost || _i == 1); /* without the first slave all frames are lost, which says nothing of one slave */
    ck_assert_int_ne(cm1e_bus_health(bus), CM1E_OK);
    const unsigned n = cycles_until_recovered(bus, 3000);
    ck_assert_uint_gt(n, 0);
    ck_assert_uint_lt(n, 1500);
    check_all_run(bus);
    for (uint32_t position = 1; position <= 3; position++) /* its processor may read its EEPROM, as after the start */
        ck_assert_uint_eq(cm1e_sim_segment_slave(segment_of(bus), position)->memory[ESC_SII_CONFIG] & 1, 1);
    cm1e_bus_close(bus);
}
END_TEST

/** Questions for the AL status of a slave that come back unanswered: bit n of `pattern` is the n-th of them. */
typedef struct questions {
    uint16_t station;
    unsigned pattern, asked;
} questions_t;

static cm1e_tap_verdict_t leave_unanswered(void *context, cm1e_tap_frame_t *frame)
{
    enum { AL_STATUS = 0x0130 };
    questions_t *questions = context;
    uint16_t station;
    const int place = find_read(frame, AL_STATUS, &station);
    if (frame->direction != CM1E_TAP_RECEIVED || place < 0 || station != questions->station)
        return CM1E_TAP_PASS;
    if (questions->pattern >> questions->asked++ & 1)
        cm1e_frame_change_working_counter(frame->bytes, frame->length, (unsigned)place, -1);
    return CM1E_TAP_PASS;
}

/** docs/SAFETY.md: a slave is called lost after 3 unanswered questions in a row, neither sooner nor later. */
START_TEST(three_unanswered_questions_in_a_row_make_a_slave_lost)
{
    sim_config(3);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 10);
    questions_t questions = {.station = 0x1002, .pattern = 1 | 3 << 2 | 7 << 5};
    const unsigned lost_after = 8;
    cm1e_nic_set_tap(cm1e_bus_nic(bus), leave_unanswered, &questions);
    while (questions.asked < lost_after) {
        cycle(bus);
        ck_assert_int_eq(cm1e_bus_slave_watch(bus, 2).lost, questions.asked == lost_after);
    }
    while (questions.asked == lost_after)
        cycle(bus);
    ck_assert(!cm1e_bus_slave_watch(bus, 2).lost); /* the next answer says that it is there */
    cm1e_bus_close(bus);
}
END_TEST

/** With its watchdog too, whatever is in that register before. */
START_TEST(without_request_nothing_is_recovered)
{
    sim_config(2);
    cm1e_bus_t *bus = start_bus();
    strike(bus, "power-cycle 2 20");
    for (int n = 0; n < 500; n++)
        cycle(bus);
    uint8_t *watchdog = cm1e_sim_segment_slave(segment_of(bus), 2)->memory + ESC_WATCHDOG_DATA;
    cm1e_put_u16(watchdog, 7);
    ck_assert_uint_eq(state_of(bus, 2), CM1E_AL_INIT);
    ck_assert_uint_eq(state_of(bus, 1), CM1E_AL_OP);
    ck_assert(cm1e_bus_slave_watch(bus, 2).lost);
    ck_assert_uint_gt(cycles_until_recovered(bus, 3000), 0);
    ck_assert_uint_eq(cm1e_get_u16(watchdog), 1000);
    check_all_run(bus);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(unplugged_slaves_trip_their_watchdog_and_come_back_with_the_cable)
{
    sim_config(3);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 20);
    strike(bus, "unplug 2");
    for (int n = 0; n < 300; n++)
        ck_assert_int_ne(cycle(bus), CM1E_OK);
    ck_assert(cm1e_bus_slave_watch(bus, 2).lost);
    ck_assert(cm1e_bus_slave_watch(bus, 3).lost);
    ck_assert(!cm1e_bus_slave_watch(bus, 1).lost);
    simulate(bus, "replug 2");
    for (int n = 0; n < 20; n++)
        cycle(bus);
    const cm1e_slave_watch_t watch = cm1e_bus_slave_watch(bus, 3);
    if (!cm1e_firmware_from_version(tested_firmware())->watchdog) { /* before V1.3.0: it noticed nothing */
        ck_assert_uint_eq(watch.al_state, CM1E_AL_OP);
        check_all_run(bus);
        cm1e_bus_close(bus);
        return;
    }
    ck_assert_uint_eq(watch.al_state, CM1E_AL_SAFE_OP | CM1E_AL_ERROR);
    ck_assert_uint_eq(watch.al_status_code, 0x001B);
    const unsigned n = cycles_until_recovered(bus, 1000);
    ck_assert_uint_gt(n, 0);
    ck_assert_uint_lt(n, 300);
    check_all_run(bus);
    cm1e_bus_close(bus);
}
END_TEST

typedef struct disturbance {
    unsigned one_in;
    uint64_t dropped;
} disturbance_t;

/** Loses one in n frames that are not process data (LRW, command 12), by chance. */
static cm1e_tap_verdict_t lose_some(void *context, cm1e_tap_frame_t *frame)
{
    disturbance_t *d = context;
    if (frame->bytes[16] == 12 || rand() % (int)d->one_in)
        return CM1E_TAP_PASS;
    d->dropped++;
    return CM1E_TAP_DROP;
}

START_TEST(recovery_survives_lost_frames)
{
    sim_config(2);
    cm1e_bus_t *bus = start_bus();
    disturbance_t disturbance = {.one_in = (unsigned)_i};
    srand((unsigned)_i);
    printf("seed %d\n", _i);
    strike(bus, "power-cycle 1 30");
    cm1e_nic_set_tap(cm1e_bus_nic(bus), lose_some, &disturbance);
    ck_assert_uint_gt(cycles_until_recovered(bus, 20000), 0);
    ck_assert_uint_gt(disturbance.dropped, 5);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    check_all_run(bus);
    cm1e_bus_close(bus);
}
END_TEST

/** Soon, too: it is not waited for a state of a slave that has no power. */
START_TEST(power_cycle_at_every_moment_of_a_recovery_ends_in_operational)
{
    sim_config(2);
    cm1e_bus_t *bus = start_bus();
    strike(bus, "power-cycle 2 10");
    for (int n = 0; n < _i * 3; n++) { /* some way into the first recovery */
        cycle(bus);
        if (cm1e_bus_slave_watch(bus, 2).al_state != CM1E_AL_OP)
            cm1e_bus_request_recovery(bus, 2);
    }
    strike(bus, "power-cycle 2 10");
    for (int n = 0; n < 60; n++)
        cycle(bus);
    ck_assert_uint_gt(cycles_until_recovered(bus, 1600), 0);
    check_all_run(bus);
    cm1e_bus_close(bus);
}
END_TEST

/** Keeps an eye on what slave 2 is sent, and in which state it was then. */
typedef struct watch_outputs {
    cm1e_bus_t *bus;
    uint32_t offset;
    unsigned muted, let_through_too_early;
} watch_outputs_t;

static cm1e_tap_verdict_t watch_outputs(void *context, cm1e_tap_frame_t *frame)
{
    watch_outputs_t *watch = context;
    if (frame->direction != CM1E_TAP_SENT || frame->bytes[16] != 12)
        return CM1E_TAP_PASS;
    const uint16_t controlword = cm1e_get_u16(frame->bytes + 26 + watch->offset);
    const bool known_in_op = cm1e_bus_slave_watch(watch->bus, 2).al_state == CM1E_AL_OP;
    if (state_of(watch->bus, 2) == CM1E_AL_OP)
        watch->muted += controlword == 0;
    watch->let_through_too_early += controlword != 0 && !known_in_op && state_of(watch->bus, 2) >= CM1E_AL_SAFE_OP;
    return CM1E_TAP_PASS;
}

START_TEST(slave_gets_zeros_until_it_is_known_to_be_operational_again)
{
    sim_config(2);
    cm1e_bus_t *bus = start_bus();
    watch_outputs_t watch = {.bus = bus, .offset = cm1e_bus_find_output(bus, 2, 0x6040, 0).offset};
    cm1e_put_u16(cm1e_bus_outputs(bus) + watch.offset, 0x0006); /* a program that does not notice anything */
    cycles(bus, 10);
    strike(bus, "power-cycle 2 20");
    for (int n = 0; n < 100; n++)
        cycle(bus);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), watch_outputs, &watch);
    ck_assert_uint_gt(cycles_until_recovered(bus, 1500), 0);
    ck_assert_uint_ge(watch.muted, 1);
    ck_assert_uint_eq(watch.let_through_too_early, 0);
    cycles(bus, 10);
    cm1e_sim_probe_t probe;
    cm1e_sim_probe(segment_of(bus), 2, &probe);
    ck_assert_uint_eq(probe.controlword, 6);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(request_for_a_slave_that_runs_disturbs_nothing)
{
    sim_config(2);
    cm1e_bus_t *bus = start_bus();
    const uint32_t offset = cm1e_bus_find_output(bus, 1, 0x6040, 0).offset;
    cm1e_put_u16(cm1e_bus_outputs(bus) + offset, 0x0006);
    cycles(bus, 10);
    for (int n = 0; n < 300; n++) {
        cm1e_bus_request_recovery(bus, 1);
        ck_assert_int_eq(cycle(bus), CM1E_OK);
        cm1e_sim_probe_t probe;
        cm1e_sim_probe(segment_of(bus), 1, &probe);
        ck_assert_uint_eq(probe.controlword, 6);
    }
    cm1e_bus_request_recovery(bus, 0);
    cm1e_bus_request_recovery(bus, 3);
    cycles(bus, 10);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(slave_with_other_switches_is_not_taken_for_the_old_one)
{
    sim_config(2);
    config.axes[1].address_kind = CM1E_ADDRESS_EXPLICIT_ID;
    config.axes[1].address = 5;
    cm1e_bus_t *bus = start_bus();
    simulate(bus, "switches 2 07");
    strike(bus, "power-cycle 2 20");
    ck_assert_uint_eq(cycles_until_recovered(bus, 1500), 0);
    ck_assert_uint_le(state_of(bus, 2), CM1E_AL_PRE_OP);
    unsigned without_address = 0;
    const cm1e_sim_slave_t *foreign = cm1e_sim_segment_slave(segment_of(bus), 2);
    for (int n = 0; n < 400; n++) { /* it has ours only while it is asked who it is */
        cycle(bus);
        without_address += cm1e_get_u16(foreign->memory + ESC_STATION_ADDRESS) == 0;
    }
    ck_assert_uint_gt(without_address, 100);
    simulate(bus, "switches 2 05");
    ck_assert_uint_gt(cycles_until_recovered(bus, 1500), 0);
    check_all_run(bus);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(sdo_to_a_lost_slave_ends_and_works_again_after_recovery)
{
    sim_config(2);
    cm1e_bus_t *bus = start_bus();
    uint8_t data[4];
    cm1e_sdo_t sdo = {.position = 2, .index = 0x1000, .data = data, .size = 4};
    ck_assert_int_eq(cm1e_sdo_submit(bus, &sdo), CM1E_OK);
    strike(bus, "power-cycle 2 300");
    ck_assert_uint_le(finish_sdo(bus, &sdo), 1001);
    ck_assert_int_eq(cm1e_sdo_state(&sdo), CM1E_SDO_ERROR);
    ck_assert(sdo.error == CM1E_ERROR_TIMEOUT || sdo.error == CM1E_ERROR_BUS_LOST);
    ck_assert_uint_gt(cycles_until_recovered(bus, 3000), 0);
    sdo = (cm1e_sdo_t){.position = 2, .index = 0x1000, .data = data, .size = 4};
    ck_assert_int_eq(cm1e_sdo_submit(bus, &sdo), CM1E_OK);
    finish_sdo(bus, &sdo);
    ck_assert_int_eq(cm1e_sdo_state(&sdo), CM1E_SDO_DONE);
    ck_assert_uint_eq(cm1e_get_u32(data), 0x00040192);
    cm1e_bus_close(bus);
}
END_TEST

/** The supervision sees it before the working counter does: the slave goes on to send its inputs. */
START_TEST(the_only_slave_of_a_bus_is_supervised)
{
    sim_config(1);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 10);
    ck_assert_uint_eq(cm1e_bus_slave_watch(bus, 1).al_state, CM1E_AL_OP);
    cm1e_sim_slave_fall_back(cm1e_sim_segment_slave(segment_of(bus), 1), CM1E_AL_SAFE_OP, 0x001B);
    cycles(bus, 10);
    ck_assert_uint_eq(cm1e_bus_slave_watch(bus, 1).al_state, CM1E_AL_SAFE_OP | CM1E_AL_ERROR);
    ck_assert_uint_eq(cm1e_bus_slave_watch(bus, 1).al_status_code, 0x001B);
    cm1e_bus_close(bus);
}
END_TEST

/** The others still give their inputs. So it is silent from the tolerated number of cycles on, long before the
 *  supervision has asked it three times. */
START_TEST(a_slave_without_inputs_is_silent_after_the_tolerated_cycles)
{
    sim_config(3);
    config.lost_cycles_limit = (uint32_t)_i;
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 10);
    strike(bus, "unplug 3");
    for (int n = 1; n <= _i + 1; n++) {
        ck_assert_msg(cycle(bus) != CM1E_OK, "cycle %d", n);
        ck_assert_msg(cm1e_bus_slave_watch(bus, 3).silent == (n >= _i), "cycle %d of %d", n, _i);
        ck_assert(!cm1e_bus_slave_watch(bus, 2).silent && cm1e_bus_slave_watch(bus, 2).fresh);
    }
    cm1e_bus_close(bus);
}
END_TEST

/** A slave that after an error goes to no higher state before it has been in Init, as its AL status code tells. */
typedef struct stubborn {
    uint16_t station;
    bool was_in_init;
} stubborn_t;

static cm1e_tap_verdict_t refuse_before_init(void *context, cm1e_tap_frame_t *frame)
{
    stubborn_t *slave = context;
    const uint16_t offset = cm1e_get_u16(frame->bytes + 20);
    if (frame->bytes[16] < 4 || frame->bytes[16] > 5 || cm1e_get_u16(frame->bytes + 18) != slave->station)
        return CM1E_TAP_PASS;
    if (frame->direction == CM1E_TAP_SENT && frame->bytes[16] == 5 && offset == 0x0120) {
        slave->was_in_init = slave->was_in_init || (frame->bytes[26] & 0x0F) == CM1E_AL_INIT;
        if (!slave->was_in_init && frame->bytes[26] == CM1E_AL_OP)
            frame->bytes[26] = 0x1F; /* a state that the slave refuses */
    }
    return CM1E_TAP_PASS;
}

START_TEST(slave_that_wants_to_be_led_up_from_init_comes_back)
{
    stubborn_t stubborn = {.station = 0x1002};
    sim_config(2);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 20);
    cm1e_sim_slave_fall_back(cm1e_sim_segment_slave(segment_of(bus), 2), CM1E_AL_SAFE_OP, 0x0021);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), refuse_before_init, &stubborn);
    for (int n = 0; n < 10; n++)
        cycle(bus);
    ck_assert_uint_gt(cycles_until_recovered(bus, 3000), 0);
    ck_assert(stubborn.was_in_init);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    check_all_run(bus);
    cm1e_bus_close(bus);
}
END_TEST

/** It has its FMMUs from before, and without active sync managers they reach its memory. */
START_TEST(slave_that_is_led_up_from_init_seems_to_take_part_in_no_cycle_before_safe_op)
{
    stubborn_t stubborn = {.station = 0x1002};
    int below = 0;
    sim_config(2);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 20);
    cm1e_sim_slave_fall_back(cm1e_sim_segment_slave(segment_of(bus), 2), CM1E_AL_SAFE_OP, 0x0021);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), refuse_before_init, &stubborn);
    for (int n = 0; n < 3000 && state_of(bus, 2) != CM1E_AL_OP; n++) {
        const bool was_below = state_of(bus, 2) < CM1E_AL_SAFE_OP;
        const cm1e_error_t error = cycle(bus);
        cm1e_bus_request_recovery(bus, 2);
        if (!was_below || state_of(bus, 2) >= CM1E_AL_SAFE_OP)
            continue;
        below++;
        ck_assert_msg(error == CM1E_ERROR_BUS_WORKING_COUNTER, "cycle %d below Safe-Operational: %d", below, error);
    }
    ck_assert_int_gt(below, 20);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    ck_assert_uint_gt(cycles_until_recovered(bus, 3000), 0);
    check_all_run(bus);
    cm1e_bus_close(bus);
}
END_TEST

/** The slave takes the request for Operational and stays in Safe-Operational. */
static cm1e_tap_verdict_t stay_in_safe_op(void *context, cm1e_tap_frame_t *frame)
{
    uint8_t *b = frame->bytes;
    (void)context;
    const bool asks = b[16] == 5 && cm1e_get_u16(b + 18) == 0x1002 && cm1e_get_u16(b + 20) == 0x0120;
    if (frame->direction == CM1E_TAP_SENT && asks && (b[26] & 0x0F) == CM1E_AL_OP)
        b[26] = (uint8_t)((b[26] & 0xF0) | CM1E_AL_SAFE_OP);
    return CM1E_TAP_PASS;
}

/** Its recovery waits for Operational, for 3 s at most, and asks for nothing else meanwhile: a transfer that runs in any
 *  of its parts has its own time all the same, and the next one works when the slave is back. */
START_TEST(sdo_keeps_its_time_while_its_slave_stays_in_safe_op)
{
    sim_config(2);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 20);
    uint8_t data[4];
    for (int begun = 0; begun < 6; begun++) {
        cm1e_sdo_t sdo = {.position = 2, .index = 0x1000, .data = data, .size = 4, .timeout_ns = INT64_C(200000000)};
        cm1e_sim_slave_fall_back(cm1e_sim_segment_slave(segment_of(bus), 2), CM1E_AL_SAFE_OP, 0x001B);
        cm1e_nic_set_tap(cm1e_bus_nic(bus), stay_in_safe_op, NULL);
        ck_assert_int_eq(cm1e_sdo_submit(bus, &sdo), CM1E_OK);
        for (int n = 0; n < begun; n++)
            cycle(bus);
        cm1e_bus_request_recovery(bus, 2);
        ck_assert_uint_le(finish_sdo(bus, &sdo), 210);
        cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
        ck_assert_uint_gt(cycles_until_recovered(bus, 8000), 0);
        sdo = (cm1e_sdo_t){.position = 2, .index = 0x1000, .data = data, .size = 4};
        ck_assert_int_eq(cm1e_sdo_submit(bus, &sdo), CM1E_OK);
        finish_sdo(bus, &sdo);
        ck_assert_int_eq(cm1e_sdo_state(&sdo), CM1E_SDO_DONE);
        ck_assert_uint_eq(cm1e_get_u32(data), 0x00040192);
        check_all_run(bus);
    }
    cm1e_bus_close(bus);
}
END_TEST

/** Two axes with an I/O module between them, which no axis asks back. */
static cm1e_bus_t *start_bus_with_io_module(void)
{
    sim_config(2);
    config.axes[1].address = 3;
    cm1e_bus_t *bus = open_bus();
    cm1e_sim_segment_t *segment = cm1e_sim_segment_create_empty();
    cm1e_sim_segment_add(segment, cm1e_sim_cm1e_create(&config.axes[0], tested_order(), 0, 0));
    cm1e_sim_segment_add(segment, cm1e_sim_io_module_create());
    cm1e_sim_segment_add(segment, cm1e_sim_cm1e_create(&config.axes[1], tested_order(), 0, 0));
    cm1e_sim_replace_segment(cm1e_bus_nic(bus), segment);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    return bus;
}

START_TEST(io_module_comes_back_without_being_asked)
{
    static const char *const strikes[] = {"power-cycle 2 50", "unplug 2", "lose 300"};
    cm1e_bus_t *bus = start_bus_with_io_module();
    cycles(bus, 20);
    strike(bus, strikes[_i]);
    for (int n = 0; n < 300; n++)
        cycle(bus);
    simulate(bus, "replug 2");
    const unsigned motor = state_of(bus, 3);
    for (int n = 0; n < 1000; n++)
        cycle(bus);
    ck_assert_uint_eq(cm1e_bus_slave_watch(bus, 2).al_state, CM1E_AL_OP);
    ck_assert_uint_eq(state_of(bus, 2), CM1E_AL_OP);
    ck_assert_uint_eq(state_of(bus, 3), motor); /* a motor stays as it is until it is asked */
    ck_assert_uint_gt(cycles_until_recovered(bus, 3000), 0);
    check_all_run(bus);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_recovery");
    TCase *tests = tcase_create("recovery");
    tcase_add_loop_test(tests, power_cycled_slave_comes_back, 1, 4);
    tcase_add_test(tests, three_unanswered_questions_in_a_row_make_a_slave_lost);
    tcase_add_test(tests, the_only_slave_of_a_bus_is_supervised);
    tcase_add_loop_test(tests, a_slave_without_inputs_is_silent_after_the_tolerated_cycles, 1, 6);
    tcase_add_test(tests, without_request_nothing_is_recovered);
    tcase_add_test(tests, unplugged_slaves_trip_their_watchdog_and_come_back_with_the_cable);
    tcase_add_loop_test(tests, recovery_survives_lost_frames, 3, 13);
    tcase_add_loop_test(tests, power_cycle_at_every_moment_of_a_recovery_ends_in_operational, 0, 60);
    tcase_add_test(tests, slave_gets_zeros_until_it_is_known_to_be_operational_again);
    tcase_add_test(tests, request_for_a_slave_that_runs_disturbs_nothing);
    tcase_add_test(tests, slave_with_other_switches_is_not_taken_for_the_old_one);
    tcase_add_test(tests, sdo_to_a_lost_slave_ends_and_works_again_after_recovery);
    tcase_add_test(tests, sdo_keeps_its_time_while_its_slave_stays_in_safe_op);
    tcase_add_test(tests, slave_that_wants_to_be_led_up_from_init_comes_back);
    tcase_add_test(tests, slave_that_is_led_up_from_init_seems_to_take_part_in_no_cycle_before_safe_op);
    tcase_add_loop_test(tests, io_module_comes_back_without_being_asked, 0, 3);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
