/* The search for optional slaves, and the recovery, address devices by their places on the wire, which move when a device
 * comes or leaves. Whatever moves between two of their datagrams, and whichever answer of the search is lost: a slave that
 * runs gets its own station address back, no two devices have the same one, and a stranger never has one of ours. */
#include "bus_support.h"
#include "cm1e/hot_connect.h"
#include "effort.h"
#include "nic/frame.h"
#include "sim/esc_chip.h"
#include "sim/segment.h"

enum { APRD = 1, APRW = 3, STATION = 0x0010, SEARCH_ADDRESS = 0x2FFE, ID = 7, COMES = 6000 };

static cm1e_bus_config_t wire;

/** Whether a frame has a datagram with this command for the station address of the device at a place. Slaves count the
 *  place up, so a frame that is back tells no place: 0. */
static bool asks_station(const cm1e_tap_frame_t *frame, unsigned command, uint16_t place)
{
    datagram_t d = {.more = true};
    size_t at = FRAME_HEADER;
    while (d.more && cm1e_frame_datagram(frame->bytes, frame->length, &at, &d))
        if (d.header[0] == command && cm1e_get_u16(d.header + 4) == STATION &&
            (place == 0 || cm1e_get_u16(d.header + 2) == (uint16_t)(1 - place)))
            return true;
    return false;
}

static cm1e_sim_slave_t *at(cm1e_bus_t *bus, uint32_t number) { return cm1e_sim_segment_slave(segment_of(bus), number); }

static uint16_t station_of(cm1e_bus_t *bus, uint32_t number)
{
    return cm1e_get_u16(at(bus, number)->memory + ESC_STATION_ADDRESS);
}

/** No two devices that are on the wire have the same address. */
static void expect_no_doubles(cm1e_bus_t *bus)
{
    const uint32_t count = cm1e_sim_segment_slave_count(segment_of(bus));
    for (uint32_t a = 1; a <= count; a++)
        for (uint32_t b = a + 1; b <= count; b++)
            ck_assert_msg(station_of(bus, a) == 0 || at(bus, a)->detached || at(bus, b)->detached ||
                              station_of(bus, a) != station_of(bus, b),
                          "%u and %u have 0x%04X", a, b, station_of(bus, a));
}

/* ---- a running slave --------------------------------------------------------------------------------------------- */

/** On the wire: a motor, the tool, a motor that runs, a stranger. */
enum { TOOL = 2, RUNS = 3, STRANGER = 4, PLACE_OF_STRANGER = 3 };

/** The tool comes just before a datagram to the place of the stranger, at which the running motor is then. */
typedef struct arrival {
    cm1e_bus_t *bus;
    unsigned command;
    bool loses_answer, come;
} arrival_t;

/** Once. */
static bool loses(arrival_t *arrival, const cm1e_tap_frame_t *frame)
{
    const bool lost = arrival->loses_answer && arrival->come && asks_station(frame, arrival->command, 0);
    arrival->loses_answer = arrival->loses_answer && !lost;
    return lost;
}

static cm1e_tap_verdict_t arrive(void *context, cm1e_tap_frame_t *frame)
{
    arrival_t *arrival = context;
    if (frame->direction == CM1E_TAP_RECEIVED)
        return loses(arrival, frame) ? CM1E_TAP_DROP : CM1E_TAP_PASS;
    if (!arrival->come && asks_station(frame, arrival->command, PLACE_OF_STRANGER)) {
        cm1e_sim_segment_attach(segment_of(arrival->bus), TOOL);
        arrival->come = true;
    }
    return CM1E_TAP_PASS;
}

static cm1e_bus_t *start_with_stranger(void)
{
    sim_config(3);
    config.axes[1].address_kind = CM1E_ADDRESS_EXPLICIT_ID;
    config.axes[1].address = ID;
    config.axes[1].recover = CM1E_RECOVER_AUTO;
    config.axes[2].address = 3;
    wire = config;
    config = (cm1e_bus_config_t){0}; /* the other one has its memory now */
    sim_config(3);
    config.axes[1] = wire.axes[1];
    config.axes[1].optional = true;
    config.axes[2].address = 2;
    snprintf(cm1e_bus_config_add_axis(&wire, "stranger")->firmware, 8, "1.3.5");
    wire.axes[3].address = 4;
    cm1e_bus_t *bus = open_bus_on(&wire);
    cm1e_sim_segment_detach(segment_of(bus), TOOL, true);
    cm1e_sim_segment_detach(segment_of(bus), STRANGER, true);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    cycles(bus, 200);
    return bus;
}

/** The motor runs on, has its own address but for a short time, and the tool comes all the same. */
START_TEST(a_running_slave_that_moves_gets_its_address_back)
{
    enum { RETURNED = 60 };
    cm1e_bus_t *bus = start_with_stranger();
    arrival_t arrival = {.bus = bus, .command = _i / 2 ? APRD : APRW, .loses_answer = _i % 2};
    const uint16_t own = station_of(bus, RUNS);
    unsigned without = 0;
    cm1e_nic_set_tap(cm1e_bus_nic(bus), arrive, &arrival);
    cm1e_sim_segment_attach(segment_of(bus), STRANGER);
    for (int n = 0; n < COMES; n++) {
        ck_assert_int_eq(cycle(bus), CM1E_OK);
        expect_no_doubles(bus);
        ck_assert_uint_eq(cm1e_sim_slave_al_state(at(bus, RUNS)), CM1E_AL_OP);
        ck_assert(station_of(bus, STRANGER) == 0 || station_of(bus, STRANGER) == SEARCH_ADDRESS);
        without += station_of(bus, RUNS) != own;
    }
    ck_assert(arrival.come && !arrival.loses_answer);
    ck_assert_uint_le(without, RETURNED);
    ck_assert_int_eq(cm1e_bus_presence(bus, 3), CM1E_PRESENCE_THERE);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&wire);
}
END_TEST

/* ---- a stranger, while one of ours is lost ----------------------------------------------------------------------- */

/** On the wire: a motor, a stranger, a motor that is lost. */
enum { INTRUDER = 2, LOST = 3 };

/** The answer is lost when the stranger gets the address of the search. */
static cm1e_tap_verdict_t lose_answer(void *context, cm1e_tap_frame_t *frame)
{
    return frame->direction == CM1E_TAP_RECEIVED && loses(context, frame) ? CM1E_TAP_DROP : CM1E_TAP_PASS;
}

static cm1e_bus_t *start_with_intruder(void)
{
    sim_config(2);
    config.axes[1].address = LOST;
    cm1e_slave_config_t *intruder = cm1e_bus_config_add_slave(&config, "intruder");
    intruder->sim = (cm1e_sim_slave_config_t){.kind = CM1E_SIM_SLAVE_DIGITAL, .inputs = 4, .outputs = 4};
    intruder->address = INTRUDER;
    wire = config;
    config = (cm1e_bus_config_t){0}; /* the other one has its memory now */
    sim_config(3);
    config.axes[1].address = 2;
    config.axes[1].recover = CM1E_RECOVER_AUTO;
    config.axes[2].address_kind = CM1E_ADDRESS_EXPLICIT_ID; /* which never comes */
    config.axes[2].address = ID;
    config.axes[2].optional = true;
    cm1e_bus_t *bus = open_bus_on(&wire);
    cm1e_sim_segment_detach(segment_of(bus), INTRUDER, true);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    cycles(bus, 200);
    return bus;
}

/** The motor has lost its power, or its cable was pulled and it has kept its address. It comes back at its own. */
START_TEST(a_stranger_never_gets_the_address_of_a_slave_that_is_lost)
{
    const int run = _i * sweep_stride(1, 7); /* odd: both ways to leave take turns */
    static const char *const leaves[] = {"power-cycle 3 3000", "unplug 3"};
    cm1e_bus_t *bus = start_with_intruder();
    arrival_t arrival = {.bus = bus, .command = APRW, .loses_answer = true, .come = true};
    const uint16_t own = station_of(bus, LOST);
    cm1e_sim_segment_attach(segment_of(bus), INTRUDER);
    cycle(bus);
    simulate(bus, leaves[run % 2]);
    for (int n = 0; n < run / 2; n++)
        cycle(bus);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), lose_answer, &arrival);
    for (int n = 0; n < COMES; n++) {
        cycle(bus);
        ck_assert_msg(station_of(bus, INTRUDER) != own, "cycle %d", n);
        expect_no_doubles(bus);
        if (n == COMES / 2)
            simulate(bus, "replug 3");
    }
    ck_assert(!arrival.loses_answer);
    ck_assert_uint_eq(station_of(bus, LOST), own);
    ck_assert_uint_eq(cm1e_sim_slave_al_state(at(bus, LOST)), CM1E_AL_OP);
    cycles(bus, 100);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&wire);
}
END_TEST

/* ---- the recovery ------------------------------------------------------------------------------------------------ */

enum { RECOVERED = 2, BEHIND = 3 };

/** The slave that is to get its address leaves just before: the next one is at its place. */
static cm1e_tap_verdict_t leave(void *context, cm1e_tap_frame_t *frame)
{
    arrival_t *arrival = context;
    if (frame->direction == CM1E_TAP_SENT && !arrival->come && asks_station(frame, APRW, RECOVERED)) {
        cm1e_sim_segment_detach(segment_of(arrival->bus), RECOVERED, false);
        arrival->come = true;
    }
    return CM1E_TAP_PASS;
}

START_TEST(a_running_slave_that_the_recovery_meets_gets_its_address_back)
{
    enum { RETURNED = 5 };
    sim_config(3);
    config.axes[1].recover = CM1E_RECOVER_AUTO;
    cm1e_bus_t *bus = start_bus();
    arrival_t arrival = {.bus = bus};
    unsigned without = 0;
    cycles(bus, 20);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), leave, &arrival);
    simulate(bus, "power-cycle 2 50");
    for (int n = 0; n < COMES; n++) {
        cycle(bus);
        without += station_of(bus, BEHIND) != 0x1003;
        ck_assert(cm1e_sim_slave_al_state(at(bus, BEHIND)) != CM1E_AL_INIT);
        expect_no_doubles(bus);
        if (n == COMES / 2)
            cm1e_sim_segment_attach(segment_of(bus), RECOVERED);
    }
    ck_assert(arrival.come);
    ck_assert_uint_gt(without, 0);
    ck_assert_uint_le(without, RETURNED);
    ck_assert_uint_eq(station_of(bus, RECOVERED), 0x1002);
    ck_assert_uint_eq(cm1e_sim_slave_al_state(at(bus, RECOVERED)), CM1E_AL_OP);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_hot_places");
    TCase *tests = tcase_create("places");
    tcase_set_timeout(tests, 60);
    tcase_add_loop_test(tests, a_running_slave_that_moves_gets_its_address_back, 0, 4);
    tcase_add_loop_test(tests, a_stranger_never_gets_the_address_of_a_slave_that_is_lost, 0,
                        2 * 40 / sweep_stride(1, 7));
    tcase_add_test(tests, a_running_slave_that_the_recovery_meets_gets_its_address_back);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
