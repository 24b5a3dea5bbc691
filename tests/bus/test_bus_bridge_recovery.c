/* A bridge that left the network comes back: for all its axes, whichever asks, and no other device in its place. */
#include "bridge_segment.h"
#include "sdo_harm.h"
#include "sim/esc_chip.h"

/* What a row of a table leaves out is 0. */
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"

/** Every axis asks for its slave, every cycle, as blind programs would; cycles until all run again; 0: never. */
static unsigned cycles_until_recovered(cm1e_bus_t *bus, unsigned limit)
{
    for (unsigned n = 1; n <= limit; n++) {
        bool all = cycle(bus) == CM1E_OK && cm1e_bus_health(bus) == CM1E_OK;
        for (uint16_t position = 1; position <= cm1e_bus_slave_count(bus); position++) {
            const cm1e_slave_watch_t watch = cm1e_bus_slave_watch(bus, position);
            all = all && !watch.lost && watch.al_state == CM1E_AL_OP;
        }
        for (uint32_t axis = 0; axis < cm1e_bus_configuration(bus)->axis_count; axis++)
            if (cm1e_bus_slave_watch(bus, cm1e_bus_axis_position(bus, axis)).al_state != CM1E_AL_OP)
                cm1e_bus_request_recovery(bus, cm1e_bus_axis_position(bus, axis));
        if (all)
            return n;
    }
    return 0;
}

static void command_all(cm1e_bus_t *bus, uint16_t position, uint16_t controlword)
{
    for (unsigned channel = 1; channel <= CM1E_BRIDGE_AXES; channel++)
        cm1e_put_u16(cm1e_bus_outputs(bus) + cm1e_bus_find_output(bus, position, on_channel(channel, 0x6040), 0).offset,
                     controlword);
}

/** What the bridge is sent while nobody knows it in Operational. */
typedef struct muted {
    cm1e_bus_t *bus;
    unsigned zeros, too_early;
} muted_t;

static cm1e_tap_verdict_t watch_words(void *context, cm1e_tap_frame_t *frame)
{
    muted_t *muted = context;
    if (frame->direction != CM1E_TAP_SENT || frame->bytes[16] != 12)
        return CM1E_TAP_PASS;
    const unsigned state = cm1e_sim_slave_al_state(cm1e_sim_segment_slave(segment_of(muted->bus), 2));
    const bool known = cm1e_bus_slave_watch(muted->bus, 2).al_state == CM1E_AL_OP;
    for (unsigned channel = 1; channel <= CM1E_BRIDGE_AXES && !known && state == CM1E_AL_OP; channel++) {
        const uint32_t at = cm1e_bus_find_output(muted->bus, 2, on_channel(channel, 0x6040), 0).offset;
        const bool zero = cm1e_get_u16(frame->bytes + 26 + at) == 0;
        muted->zeros += zero;
        muted->too_early += !zero;
    }
    return CM1E_TAP_PASS;
}

static const char *const strikes[] = {"power-cycle 2 50", "unplug 2"};

START_TEST(bridge_comes_back_for_all_its_axes_with_zeros_until_operational)
{
    cm1e_bus_t *bus = start_mixed();
    command_all(bus, 2, 0x0006);
    cycles(bus, 50);
    simulate(bus, strikes[_i]);
    for (int n = 0; n < 300; n++)
        cycle(bus);
    ck_assert(cm1e_bus_slave_watch(bus, 2).lost);
    ck_assert(!cm1e_bus_slave_watch(bus, 1).lost);
    simulate(bus, "replug 2");
    for (int n = 0; n < 32; n++) /* so that the supervision sees Operational a cycle after it is reached */
        cycle(bus);
    if (_i == 1) { /* it was not without power: its watchdog told it */
        ck_assert_uint_eq(cm1e_bus_slave_watch(bus, 2).al_state, CM1E_AL_SAFE_OP | CM1E_AL_ERROR);
        ck_assert_uint_eq(cm1e_bus_slave_watch(bus, 2).al_status_code, 0x001B);
    }
    muted_t muted = {.bus = bus};
    cm1e_nic_set_tap(cm1e_bus_nic(bus), watch_words, &muted);
    const unsigned n = cycles_until_recovered(bus, 4000);
    ck_assert_uint_gt(n, 0);
    ck_assert_uint_lt(n, 2000);
    ck_assert_uint_ge(muted.zeros, CM1E_BRIDGE_AXES);
    ck_assert_uint_eq(muted.too_early, 0);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    cycles(bus, 300);
    for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++)
        ck_assert_uint_eq(bridge_at(bus, 2)->axes[i].controlword, 6);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(bridge_is_not_brought_back_unasked)
{
    cm1e_bus_t *bus = start_mixed();
    cycles(bus, 20);
    simulate(bus, "power-cycle 2 20");
    for (int n = 0; n < 1000; n++)
        cycle(bus);
    ck_assert_uint_eq(cm1e_sim_slave_al_state(cm1e_sim_segment_slave(segment_of(bus), 2)), CM1E_AL_INIT);
    ck_assert_uint_eq(cm1e_bus_slave_watch(bus, 4).al_state, CM1E_AL_OP);
    cm1e_bus_close(bus);
}
END_TEST

/** One axis asks for its slave, which is well: the set-points and the SDO transfers of the others go on. */
START_TEST(request_of_one_axis_does_not_disturb_the_others)
{
    cm1e_bus_t *bus = start_mixed();
    command_all(bus, 2, 0x0006);
    cycles(bus, 20);
    unsigned transfers = 0;
    uint8_t data[8];
    cm1e_sdo_t sdo = {.position = 2, .index = 0x6861, .data = data, .size = sizeof data};
    for (int n = 0; n < 400; n++) {
        if (n % 2 == 0)
            cm1e_bus_request_recovery(bus, 2);
        if (cm1e_sdo_state(&sdo) != CM1E_SDO_BUSY) {
            ck_assert_msg(cm1e_sdo_state(&sdo) != CM1E_SDO_ERROR, "%s", cm1e_strerror(sdo.error));
            transfers += cm1e_sdo_state(&sdo) == CM1E_SDO_DONE;
            sdo.size = sizeof data;
            ck_assert_int_eq(cm1e_sdo_submit(bus, &sdo), CM1E_OK);
        }
        ck_assert_int_eq(cycle(bus), CM1E_OK);
        for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++)
            ck_assert_uint_eq(bridge_at(bus, 2)->axes[i].controlword, 6);
    }
    ck_assert_uint_gt(transfers, 5);
    cm1e_bus_close(bus);
}
END_TEST

/** While the bridge was away, another device took its place, or it became another. */
static const struct {
    const char *name;
    device_kind_t device;
    harm_t harm;
} strangers[] = {
    {"another model", AN_EB01, {0}},
    {"a CM1-E", A_MOTOR, {0}},
    {"an I/O module", AN_IO_MODULE, {0}},
    {"one with other motors", AN_EB12, {.kind = OTHER_VALUE, .index = 0xF513, .subindex = 1}},
    {"one of another revision", AN_EB12, {.kind = OTHER_VALUE, .index = 0x1018, .subindex = 3}},
    {"one of another product", AN_EB12, {.kind = OTHER_VALUE, .index = 0x1018, .subindex = 2}},
    {"one of another vendor", AN_EB12, {.kind = OTHER_VALUE, .index = 0x1018, .subindex = 1}},
    {"one that detects no module", AN_EB12, {.kind = OTHER_VALUE, .index = 0xF050, .subindex = 4}},
    {"one with another mapping", AN_EB12, {.kind = OTHER_VALUE, .index = 0x1A11, .subindex = 2}},
};
enum { STRANGERS = sizeof strangers / sizeof strangers[0] };

static cm1e_sim_segment_t *mixed_segment(device_kind_t second)
{
    const device_kind_t devices[] = {mixed[0], second, mixed[2], mixed[3]};
    return make_segment(devices, 4);
}

START_TEST(stranger_in_the_place_of_a_bridge_is_not_taken_for_it)
{
    cm1e_bus_t *bus = start_mixed();
    harm_t harm = strangers[_i].harm;
    cycles(bus, 20);
    cm1e_sim_replace_segment(cm1e_bus_nic(bus), mixed_segment(strangers[_i].device)); /* all without power meanwhile */
    harm.station = 0x1002;
    set_harm(bus, &harm);
    for (int n = 0; n < 20; n++)
        cycle(bus);
    unsigned without_address = 0;
    for (int n = 0; n < 4000; n++) {
        ck_assert_msg(cycles_until_recovered(bus, 1) == 0, "%s", strangers[_i].name);
        const cm1e_sim_slave_t *foreign = cm1e_sim_segment_slave(segment_of(bus), 2);
        without_address += cm1e_get_u16(foreign->memory + ESC_STATION_ADDRESS) == 0;
        ck_assert_msg(cm1e_sim_slave_al_state(foreign) <= CM1E_AL_PRE_OP, "%s", strangers[_i].name);
    }
    ck_assert_uint_eq(cm1e_bus_slave_watch(bus, 4).al_state, CM1E_AL_OP); /* the other bridge is back */
    if (strangers[_i].harm.index != 0x1A11) /* which is ours, but cannot run in this image */
        ck_assert_msg(without_address > 100, "%s: %u", strangers[_i].name, without_address);
    harm_t none = {.kind = NO_HARM};
    set_harm(bus, &none);
    cm1e_sim_replace_segment(cm1e_bus_nic(bus), mixed_segment(AN_EB12));
    for (int n = 0; n < 20; n++)
        cycle(bus);
    ck_assert_uint_gt(cycles_until_recovered(bus, 5000), 0);
    cycles(bus, 100);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(power_cycle_at_every_moment_of_a_recovery_ends_in_operational)
{
    cm1e_bus_t *bus = start_mixed();
    simulate(bus, "power-cycle 2 10");
    for (int n = 0; n < 20 + _i * 10; n++)
        cycles_until_recovered(bus, 1);
    simulate(bus, "power-cycle 2 10");
    for (int n = 0; n < 60; n++)
        cycle(bus);
    ck_assert_uint_gt(cycles_until_recovered(bus, 8000), 0);
    cycles(bus, 100);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_bridge_recovery");
    TCase *tests = tcase_create("recovery");
    tcase_set_timeout(tests, 60);
    tcase_add_loop_test(tests, bridge_comes_back_for_all_its_axes_with_zeros_until_operational, 0, 2);
    tcase_add_test(tests, bridge_is_not_brought_back_unasked);
    tcase_add_test(tests, request_of_one_axis_does_not_disturb_the_others);
    tcase_add_loop_test(tests, stranger_in_the_place_of_a_bridge_is_not_taken_for_it, 0, STRANGERS);
    tcase_add_loop_test(tests, power_cycle_at_every_moment_of_a_recovery_ends_in_operational, 0, 40);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
