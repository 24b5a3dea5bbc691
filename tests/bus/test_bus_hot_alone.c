/* Networks on which a single device answers, or whose first device is the optional one: the count of the devices is 1
 * then, like the working counter of any question to one slave. And an optional motor between others: a stranger that it
 * moves to another place, and outputs that it does not take. */
#include "bus_support.h"
#include "bus/kept.h"
#include "cm1e/hot_connect.h"
#include "effort.h"
#include "sim/esc_chip.h"
#include "sim/segment.h"

enum { ID = 7, SETTLE = 200, AWAY = 1500, COMES = 4000, AT_ONCE = 1000 };

static void make_optional(cm1e_axis_config_t *axis, uint16_t id)
{
    axis->address_kind = CM1E_ADDRESS_EXPLICIT_ID;
    axis->address = id;
    axis->optional = true;
    axis->recover = CM1E_RECOVER_AUTO;
}

static uint16_t station_of(cm1e_bus_t *bus, uint32_t place)
{
    return cm1e_get_u16(cm1e_sim_segment_slave(segment_of(bus), place)->memory + ESC_STATION_ADDRESS);
}

/** Whether the slave takes part in the cycle again. */
static bool comes(cm1e_bus_t *bus, uint16_t position)
{
    for (int n = 0; n < COMES; n++) {
        const bool good = cycle(bus) == CM1E_OK;
        if (good && cm1e_bus_presence(bus, position) == CM1E_PRESENCE_THERE &&
            cm1e_sim_slave_al_state(cm1e_sim_segment_slave(segment_of(bus), position)) == CM1E_AL_OP)
            return true;
    }
    return false;
}

/** Cycles in which no frame need come back. */
static void silent_cycles(cm1e_bus_t *bus, int count)
{
    for (int n = 0; n < count; n++)
        cycle(bus);
}

/** A motor, and a tool behind it. */
START_TEST(a_motor_alone_keeps_its_address_while_the_tool_is_away)
{
    make_optional(&sim_config(2)->axes[1], ID);
    cm1e_bus_t *bus = start_bus();
    const uint16_t station = station_of(bus, 1);
    cycles(bus, SETTLE);
    cm1e_sim_segment_detach(segment_of(bus), 2, false);
    cycle(bus); /* the frame that is on its way when the plug is pulled */
    for (int n = 0; n < AWAY; n++) {
        ck_assert_int_eq(cycle(bus), CM1E_OK);
        ck_assert_uint_eq(station_of(bus, 1), station);
    }
    ck_assert_int_eq(cm1e_bus_presence(bus, 2), CM1E_PRESENCE_ABSENT);
    cm1e_sim_segment_attach(segment_of(bus), 2);
    ck_assert(comes(bus, 2));
    ck_assert_uint_eq(station_of(bus, 1), station);
    cm1e_bus_close(bus);
}
END_TEST

/** Beside a controller that cannot do LRW, inputs are read by an LRD: it shows too that the tool has left, at once. */
START_TEST(a_tool_leaves_a_network_without_lrw)
{
    make_optional(&sim_config(3)->axes[2], ID);
    cm1e_bus_t *bus = open_bus();
    forget_lrw(bus, 1);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    cycles(bus, SETTLE);
    cm1e_sim_segment_detach(segment_of(bus), 3, false);
    cycle(bus); /* the frame that is on its way when the plug is pulled */
    for (int n = 0; n < AWAY; n++)
        ck_assert_int_eq(cycle(bus), CM1E_OK);
    cm1e_sim_segment_attach(segment_of(bus), 3);
    ck_assert(comes(bus, 3));
    cm1e_bus_close(bus);
}
END_TEST

/** The tool is all that the network has. Without it no frame comes back. */
START_TEST(a_tool_alone_comes_back)
{
    make_optional(&sim_config(1)->axes[0], ID);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, SETTLE);
    for (int round = 0; round < 2; round++) {
        cm1e_sim_segment_detach(segment_of(bus), 1, false);
        silent_cycles(bus, AWAY);
        cm1e_sim_segment_attach(segment_of(bus), 1);
        ck_assert_msg(comes(bus, 1), "round %d", round);
    }
    for (int n = 0; n < SETTLE; n++)
        ck_assert_int_eq(cycle(bus), CM1E_OK);
    cm1e_bus_close(bus);
}
END_TEST

/** Two tools: the first one leaves, and the cable leads to the second one. */
START_TEST(the_second_of_two_tools_goes_on_when_the_first_one_leaves)
{
    sim_config(2);
    make_optional(&config.axes[0], ID);
    make_optional(&config.axes[1], ID + 1);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, SETTLE);
    cm1e_sim_segment_detach(segment_of(bus), 1, false);
    cycle(bus);
    for (int n = 0; n < AWAY; n++)
        ck_assert_int_eq(cycle(bus), CM1E_OK);
    ck_assert_int_eq(cm1e_bus_presence(bus, 2), CM1E_PRESENCE_THERE);
    cm1e_sim_segment_attach(segment_of(bus), 1);
    ck_assert(comes(bus, 1));
    cm1e_bus_close(bus);
}
END_TEST

/** The tool comes at the place of a stranger, which then answers one place farther. Every change of the number of slaves
 * makes the search look at all of them again, not only when it is time to look at known strangers again (2 s). */
START_TEST(a_tool_that_comes_at_the_place_of_a_stranger_is_found_at_once)
{
    cm1e_bus_config_t wire = *sim_config(3);
    cm1e_stranger_t stranger[CM1E_STRANGERS];
    make_optional(&wire.axes[1], ID);
    make_optional(&wire.axes[2], ID + 1);
    config = (cm1e_bus_config_t){0}; /* the other one has its memory now */
    make_optional(&sim_config(2)->axes[1], ID);
    cm1e_bus_t *bus = open_bus_on(&wire);
    cm1e_sim_segment_detach(segment_of(bus), 2, false);
    cm1e_sim_segment_detach(segment_of(bus), 3, false);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    cycles(bus, SETTLE);
    cm1e_sim_segment_attach(segment_of(bus), 3);
    for (int n = 0; n < AWAY && cm1e_bus_strangers(bus, stranger, CM1E_STRANGERS) == 0; n++)
        ck_assert_int_eq(cycle(bus), CM1E_OK);
    ck_assert_uint_eq(cm1e_bus_strangers(bus, stranger, CM1E_STRANGERS), 1);
    ck_assert_uint_eq(stranger[0].place, 2);
    cm1e_sim_segment_attach(segment_of(bus), 2);
    for (int n = 0; n < AT_ONCE && cm1e_bus_presence(bus, 2) != CM1E_PRESENCE_THERE; n++)
        ck_assert_int_eq(cycle(bus), CM1E_OK);
    ck_assert_int_eq(cm1e_bus_presence(bus, 2), CM1E_PRESENCE_THERE);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&wire);
}
END_TEST

/** It says that it is in Operational, and takes no outputs: the others go on for as many cycles as three questions and
 * an answer take, and not longer. */
START_TEST(an_operational_tool_that_takes_no_outputs_is_an_error_after_seven_cycles)
{
    enum { FMMU_BYTES = 16, TYPE = 11, ACTIVATE = 12, WRITES = 2 };
    make_optional(&sim_config(2)->axes[1], ID);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, SETTLE);
    cm1e_sim_slave_t *tool = cm1e_sim_segment_slave(segment_of(bus), 2);
    uint8_t *fmmu = tool->memory + ESC_FMMU;
    while (!(fmmu[ACTIVATE] && fmmu[TYPE] == WRITES))
        fmmu += FMMU_BYTES;
    fmmu[ACTIVATE] = 0;
    cm1e_sim_esc_fmmu_decode(tool);
    unsigned good = 0;
    while (good < 60 && cycle(bus) == CM1E_OK)
        good++;
    ck_assert_uint_eq(cm1e_sim_slave_al_state(tool), CM1E_AL_OP);
    ck_assert_uint_eq(good, 1 + 7); /* the frame of the first cycle was on its way already */
    cm1e_bus_close(bus);
}
END_TEST

/** Whenever it is pulled while it is identified, it is no stranger whose EEPROM cannot be read, and comes back as quickly
 *  as ever. */
START_TEST(a_tool_that_is_pulled_while_it_is_identified_comes_back_at_once)
{
    enum { IDENTIFIED = 900, AGAIN = 100 };
    make_optional(&sim_config(2)->axes[1], ID);
    cm1e_bus_t *bus = start_bus();
    const int stride = sweep_stride(1, 12);
    cycles(bus, SETTLE);
    for (int moment = sweep_first(0, stride); moment < IDENTIFIED; moment += stride) {
        cm1e_sim_segment_detach(segment_of(bus), 2, false);
        silent_cycles(bus, SETTLE);
        cm1e_sim_segment_attach(segment_of(bus), 2);
        silent_cycles(bus, moment);
        cm1e_sim_segment_detach(segment_of(bus), 2, false);
        silent_cycles(bus, AGAIN);
        cm1e_sim_segment_attach(segment_of(bus), 2);
        for (int n = 0; n < AWAY && cm1e_bus_presence(bus, 2) != CM1E_PRESENCE_THERE; n++) {
            cycle(bus);
            ck_assert_msg(cm1e_bus_strangers(bus, NULL, 0) == 0, "moment %d", moment);
        }
        ck_assert_msg(cm1e_bus_presence(bus, 2) == CM1E_PRESENCE_THERE, "moment %d", moment);
    }
    cm1e_bus_close(bus);
}
END_TEST

/** The second of two tools is being identified when the first one loses its power, and with it the way to the second one,
 *  which keeps the address of the search. Then both are there again. */
START_TEST(two_tools_come_whenever_the_first_one_loses_its_power)
{
    const int stride = sweep_stride(3, 13);
    for (int moment = sweep_first(0, stride); moment < 500; moment += stride) {
        sim_config(3);
        make_optional(&config.axes[1], ID);
        make_optional(&config.axes[2], ID + 1);
        cm1e_bus_t *bus = start_bus();
        cycles(bus, SETTLE);
        cm1e_sim_segment_detach(segment_of(bus), 3, false);
        silent_cycles(bus, SETTLE);
        cm1e_sim_segment_attach(segment_of(bus), 3);
        silent_cycles(bus, moment);
        simulate(bus, "power-cycle 2 150");
        silent_cycles(bus, SETTLE);
        ck_assert_msg(comes(bus, 2) && comes(bus, 3), "moment %d", moment);
        cm1e_bus_close(bus);
    }
}
END_TEST

static int counter_change;

static cm1e_tap_verdict_t change_counter(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    if (frame->direction == CM1E_TAP_RECEIVED && counter_change != 0)
        cm1e_frame_change_working_counter(frame->bytes, frame->length, 0, counter_change);
    return CM1E_TAP_PASS;
}

/** A motor that is always there has lost its power, and two tools behind it answer again. Whatever the working counter is
 *  then, no cycle is a good one, and its inputs are never taken from the frame. Afterwards it is found all the same. */
START_TEST(no_working_counter_makes_up_for_a_motor_that_is_always_there)
{
    sim_config(3);
    make_optional(&config.axes[1], ID);
    make_optional(&config.axes[2], ID + 1);
    config.axes[0].recover = CM1E_RECOVER_AUTO;
    cm1e_bus_t *bus = start_bus();
    cm1e_nic_set_tap(cm1e_bus_nic(bus), change_counter, NULL);
    cycles(bus, SETTLE);
    uint8_t before[2];
    memcpy(before, cm1e_bus_inputs(bus), sizeof before);
    cm1e_sim_segment_detach(segment_of(bus), 1, false);
    cycle(bus);
    for (int n = 0; n < 200; n++) {
        counter_change = n % 19 - 9;
        ck_assert_int_ne(cycle(bus), CM1E_OK);
        ck_assert_mem_eq(cm1e_bus_inputs(bus), before, sizeof before);
    }
    counter_change = 0;
    cm1e_sim_segment_attach(segment_of(bus), 1);
    ck_assert(comes(bus, 1) && comes(bus, 2) && comes(bus, 3));
    cm1e_bus_close(bus);
}
END_TEST

/** As on a network without optional slaves: each silent cycle counts once. The optional one, which is behind it, may even be away. */
START_TEST(a_motor_beside_an_optional_one_is_silent_after_the_tolerated_cycles)
{
    const uint32_t tolerated = (uint32_t)_i % 6 + 1;
    make_optional(&sim_config(3)->axes[2], ID);
    config.lost_cycles_limit = tolerated;
    cm1e_bus_t *bus = start_bus();
    cycles(bus, SETTLE);
    if (_i >= 6) {
        cm1e_sim_segment_detach(segment_of(bus), 3, false);
        cycle(bus);
        cycles(bus, SETTLE);
    }
    simulate(bus, "unplug 2");
    cycle(bus); /* the frame that is on its way */
    for (uint32_t n = 1; n <= tolerated + 1; n++) {
        ck_assert_msg(cycle(bus) != CM1E_OK, "cycle %u", n);
        ck_assert_msg(cm1e_bus_slave_watch(bus, 2).silent == (n >= tolerated), "cycle %u of %u", n, tolerated);
        ck_assert(!cm1e_bus_slave_watch(bus, 1).silent && cm1e_bus_slave_watch(bus, 1).fresh);
    }
    cm1e_bus_close(bus);
}
END_TEST

static void detach_second(cm1e_bus_t *bus, bool noticed)
{
    cm1e_sim_segment_detach(segment_of(bus), 2, false);
    if (noticed) {
        silent_cycles(bus, SETTLE);
        ck_assert_int_eq(cm1e_bus_presence(bus, 2), CM1E_PRESENCE_ABSENT);
    }
}

/** A program that lets the bus wait for longer than its scheduler may: the tool is there, leaves meanwhile, or has left. */
START_TEST(a_run_begins_whether_the_tool_has_left_or_not)
{
    enum { THERE, LEAVES, HAS_LEFT };
    const int64_t waits_ns = 50000000, most_ns = 500000000;
    make_optional(&sim_config(2)->axes[1], ID);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, SETTLE);
    if (_i != THERE)
        detach_second(bus, _i == HAS_LEFT);
    cm1e_clock_t *clock = cm1e_bus_clock(bus);
    cm1e_clock_sleep_until(clock, cm1e_clock_now(clock) + waits_ns);
    const int64_t began_ns = cm1e_clock_now(clock);
    const cm1e_error_t error = cm1e_bus_resume(bus, &diag);
    ck_assert_msg(error == CM1E_OK, "%s", diag.text);
    ck_assert_int_lt(cm1e_clock_now(clock) - began_ns, most_ns);
    for (int n = 0; n < SETTLE; n++)
        ck_assert_int_eq(cycle(bus), CM1E_OK);
    ck_assert_int_eq(cm1e_bus_presence(bus, 2), _i == THERE ? CM1E_PRESENCE_THERE : CM1E_PRESENCE_ABSENT);
    cm1e_sim_segment_attach(segment_of(bus), 2);
    ck_assert(comes(bus, 2));
    cm1e_bus_close(bus);
}
END_TEST

/* Frames to slaves that are not there take some time, but nobody waits for them. */
START_TEST(start_does_not_wait_for_absent_slaves)
{
    int64_t took_ns[2];
    for (int absent = 0; absent < 2; absent++) {
        cm1e_bus_config_t *to = sim_config(4);
        for (uint32_t i = 1; i < 4; i++) {
            make_optional(&to->axes[i], (uint16_t)(ID + i));
            to->axes[i].sim_absent = absent;
        }
        cm1e_bus_t *bus = open_bus();
        const int64_t began_ns = cm1e_clock_now(cm1e_bus_clock(bus));
        ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
        took_ns[absent] = cm1e_clock_now(cm1e_bus_clock(bus)) - began_ns;
        cm1e_bus_close(bus);
    }
    ck_assert_int_le(took_ns[1], took_ns[0] + 1000000);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_hot_alone");
    TCase *tests = tcase_create("alone");
    tcase_set_timeout(tests, 60);
    tcase_add_test(tests, a_motor_alone_keeps_its_address_while_the_tool_is_away);
    tcase_add_test(tests, a_tool_leaves_a_network_without_lrw);
    tcase_add_test(tests, a_tool_alone_comes_back);
    tcase_add_test(tests, the_second_of_two_tools_goes_on_when_the_first_one_leaves);
    tcase_add_test(tests, a_tool_that_comes_at_the_place_of_a_stranger_is_found_at_once);
    tcase_add_test(tests, an_operational_tool_that_takes_no_outputs_is_an_error_after_seven_cycles);
    tcase_add_loop_test(tests, a_motor_beside_an_optional_one_is_silent_after_the_tolerated_cycles, 0, 12);
    tcase_add_test(tests, no_working_counter_makes_up_for_a_motor_that_is_always_there);
    tcase_add_test(tests, a_tool_that_is_pulled_while_it_is_identified_comes_back_at_once);
    tcase_add_test(tests, two_tools_come_whenever_the_first_one_loses_its_power);
    tcase_add_loop_test(tests, a_run_begins_whether_the_tool_has_left_or_not, 0, 3);
    tcase_add_test(tests, start_does_not_wait_for_absent_slaves);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
