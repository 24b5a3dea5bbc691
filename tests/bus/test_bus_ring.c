/* A redundant ring: one cut anywhere costs nobody the bus, before and during operation, and is told with its place. */
#include "bus_support.h"
#include "cm1e/topology.h"

enum { SLAVES = 4, CABLES = SLAVES + 1, MOMENTS = 24, AFTERWARDS = 12 };

static cm1e_bus_config_t *ring_config(void)
{
    sim_config(SLAVES);
    strcpy(config.second_interface, "sim-second");
    return &config;
}

START_TEST(closed_ring_starts_and_runs)
{
    ring_config();
    cm1e_bus_t *bus = start_bus();
    ck_assert_uint_eq(cm1e_bus_slave_count(bus), SLAVES);
    cycles(bus, 300);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(ring_that_is_cut_starts_and_runs)
{
    ring_config();
    cm1e_bus_t *bus = open_bus();
    cm1e_sim_segment_cut(segment_of(bus), (uint32_t)_i, true);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_eq(cm1e_bus_slave_count(bus), SLAVES);
    cycles(bus, 300);
    cm1e_bus_close(bus);
}
END_TEST

static void expect_whole_operation(cm1e_bus_t *bus)
{
    ck_assert_int_eq(cm1e_bus_health(bus), CM1E_OK);
    for (uint16_t position = 1; position <= SLAVES; position++) {
        ck_assert_uint_eq(cm1e_bus_slave_watch(bus, position).al_state, CM1E_AL_OP);
        ck_assert(!cm1e_bus_slave_watch(bus, position).lost);
    }
}

/** 0: whole. */
static void expect_broken_at(cm1e_bus_t *bus, unsigned cable)
{
    cm1e_bus_ring_t ring;
    cm1e_bus_ring(bus, &ring);
    ck_assert(ring.used);
    ck_assert_int_eq(ring.broken, cable != 0);
    ck_assert_int_eq(ring.placed, cable != 0);
    ck_assert_uint_eq(ring.behind, cable ? cable - 1 : 0);
    ck_assert_uint_eq(ring.before, cable);
}

START_TEST(cut_and_mended_in_operation_no_slave_leaves_operational)
{
    ring_config();
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 50);
    for (int round = 0; round < 4; round++) {
        const bool cut = round % 2 == 0;
        cm1e_sim_segment_cut(segment_of(bus), (uint32_t)_i, cut);
        cycles(bus, 200);
        expect_whole_operation(bus);
        expect_broken_at(bus, cut ? (unsigned)_i : 0);
    }
    uint8_t data[16];
    size_t size = sizeof data;
    ck_assert_int_eq(cm1e_sdo_read(bus, SLAVES, 0x1008, 0, data, &size, &diag), CM1E_OK);
    cm1e_bus_close(bus);
}
END_TEST

/** While `*lose` is true, no frame comes back: what was on the cable when it broke. */
static cm1e_tap_verdict_t lose_answers(void *lose, cm1e_tap_frame_t *frame)
{
    return *(bool *)lose && frame->direction == CM1E_TAP_RECEIVED ? CM1E_TAP_DROP : CM1E_TAP_PASS;
}

/** What a cable and its moment cost: cycles that were not as they should be, over break and mending. The transfer that
 *  goes on meanwhile brings its value. */
static unsigned break_and_mend(cm1e_bus_t *bus, unsigned cable, unsigned moment, bool on_the_cable)
{
    static char name[64];
    bool lose = false;
    unsigned bad = 0;
    cm1e_sdo_t sdo = {.position = SLAVES, .index = 0x1008, .data = name, .size = sizeof name};
    ck_assert_int_eq(cm1e_sdo_submit(bus, &sdo), CM1E_OK);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), lose_answers, &lose);
    for (unsigned n = 0; n < 2 * MOMENTS; n++) {
        const bool now = n == moment || n == moment + MOMENTS;
        if (now)
            cm1e_sim_segment_cut(segment_of(bus), cable, n == moment);
        lose = now && on_the_cable;
        bad += cycle(bus) != CM1E_OK;
        lose = false;
        if (n == moment + AFTERWARDS)
            expect_broken_at(bus, cable);
    }
    for (unsigned n = 0; n < AFTERWARDS; n++)
        bad += cycle(bus) != CM1E_OK;
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    finish_sdo(bus, &sdo);
    ck_assert_msg(sdo.error == CM1E_OK && memcmp(name, "CM1-E", 5) == 0, "cable %u, moment %u: %s", cable, moment,
                  cm1e_strerror(sdo.error));
    expect_whole_operation(bus);
    expect_broken_at(bus, 0);
    return bad;
}

/** Only a frame that was on the cable at that moment is lost, and only its cycle. */
static cm1e_tap_verdict_t twice(void *context, cm1e_tap_frame_t *frame)
{
    const cm1e_tap_direction_t *direction = context;
    if (frame->direction == *direction)
        frame->copies = 2;
    return CM1E_TAP_PASS;
}

/** A switch or a driver that sends frames twice, on both ways of the ring, which is whole or broken anywhere: each cycle
 *  has the process data of all slaves, and SDO transfers give what the slave has. */
START_TEST(frames_that_come_twice_disturb_no_ring)
{
    cm1e_tap_direction_t direction = _i % 2 ? CM1E_TAP_RECEIVED : CM1E_TAP_SENT;
    const unsigned cable = (unsigned)_i / 2;
    ring_config();
    cm1e_bus_t *bus = open_bus();
    if (cable > 0)
        cm1e_sim_segment_cut(segment_of(bus), cable, true);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), twice, &direction);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    for (unsigned round = 0; round < 20; round++) {
        uint8_t vendor[4] = {0};
        const uint16_t position = (uint16_t)(1 + round % SLAVES);
        cm1e_sdo_t sdo = {.position = position, .index = 0x1018, .subindex = 1, .data = vendor, .size = sizeof vendor};
        ck_assert_int_eq(cm1e_sdo_submit(bus, &sdo), CM1E_OK);
        finish_sdo(bus, &sdo);
        ck_assert_int_eq(cm1e_sdo_state(&sdo), CM1E_SDO_DONE);
        ck_assert_uint_eq(cm1e_get_u32(vendor), CM1E_VENDOR_ID);
        cycles(bus, 10);
    }
    expect_whole_operation(bus);
    expect_broken_at(bus, cable);
    ck_assert_uint_eq(cm1e_bus_counters(bus)->working_counter_errors, 0);
    ck_assert_uint_eq(cm1e_bus_counters(bus)->lost_frames, 0);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(every_cable_breaks_and_is_mended_at_every_moment)
{
    ring_config();
    config.cycle_time_ns = _i ? 250000 : 1000000;
    if (_i && strcmp(tested_firmware(), "1.3.5") != 0)
        return; /* old firmware knows 1 ms only */
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 20);
    for (unsigned cable = 1; cable <= CABLES; cable++)
        for (unsigned moment = 0; moment < MOMENTS; moment++) {
            const unsigned between = break_and_mend(bus, cable, moment, false);
            ck_assert_msg(between == 0, "cable %u, moment %u: %u cycles", cable, moment, between);
            const unsigned within = break_and_mend(bus, cable, moment, true);
            ck_assert_msg(within <= 2, "cable %u, moment %u, a frame on the cable: %u cycles", cable, moment, within);
        }
    cm1e_bus_ring_t ring;
    cm1e_bus_ring(bus, &ring);
    ck_assert_uint_eq(ring.breaks, 2 * CABLES * MOMENTS);
    cm1e_bus_close(bus);
}
END_TEST

static void expect_text(cm1e_bus_t *bus, const char *expected)
{
    char text[512];
    cm1e_bus_ring_t ring;
    cm1e_bus_ring(bus, &ring);
    cm1e_bus_ring_text(bus, &ring, text, sizeof text);
    ck_assert_str_eq(text, expected);
}

#define ALL_REACHED " All slaves are reached, from two sides: mend that cable before a second one breaks."

START_TEST(the_place_of_a_break_is_told_in_words)
{
    ring_config();
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 20);
    expect_text(bus, "The ring is whole.");
    cm1e_sim_segment_cut(segment_of(bus), 1, true);
    cycles(bus, 20);
    expect_text(bus, "The ring is broken between this computer (\"sim\") and slave 1 (\"axis1\", CM1-E)." ALL_REACHED);
    cm1e_sim_segment_cut(segment_of(bus), 1, false);
    cm1e_sim_segment_cut(segment_of(bus), CABLES, true);
    cycles(bus, 30);
    expect_text(bus, "The ring is broken between slave 4 (\"axis4\", CM1-E) and this computer (\"sim-second\")."
                ALL_REACHED);
    cm1e_sim_segment_cut(segment_of(bus), 3, true);
    for (unsigned n = 0; n < 60; n++)
        cycle(bus);
    expect_text(bus, "The ring is broken between slave 2 (\"axis2\", CM1-E) and this computer (\"sim-second\"). Slaves 3 "
                "to 4 are reached from neither side. Check the cables and the power there.");
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(the_place_is_known_after_a_scan)
{
    ring_config();
    cm1e_bus_t *bus = open_bus();
    cm1e_sim_segment_cut(segment_of(bus), (uint32_t)_i, true);
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_OK);
    expect_broken_at(bus, (unsigned)_i);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(a_line_is_no_ring)
{
    sim_config(SLAVES);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 20);
    cm1e_bus_ring_t ring;
    cm1e_bus_ring(bus, &ring);
    ck_assert(!ring.used && !ring.broken && ring.breaks == 0);
    expect_text(bus, "There is no second interface, so no ring.");
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_ring");
    TCase *tests = tcase_create("ring");
    tcase_add_test(tests, closed_ring_starts_and_runs);
    tcase_add_loop_test(tests, ring_that_is_cut_starts_and_runs, 1, SLAVES + 2);
    tcase_add_loop_test(tests, cut_and_mended_in_operation_no_slave_leaves_operational, 1, SLAVES + 2);
    tcase_add_loop_test(tests, every_cable_breaks_and_is_mended_at_every_moment, 0, 2);
    tcase_add_loop_test(tests, frames_that_come_twice_disturb_no_ring, 0, 2 * (CABLES + 1));
    tcase_add_test(tests, the_place_of_a_break_is_told_in_words);
    tcase_add_loop_test(tests, the_place_is_known_after_a_scan, 1, SLAVES + 2);
    tcase_add_test(tests, a_line_is_no_ring);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
