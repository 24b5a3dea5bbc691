/* An optional motor that comes and does not do what its configuration takes: it refuses a state, or does not let a
 * register be written. It is refused with the reason, tried again, and takes part once it is mended. Until then the
 * motor gets no output, whatever the program writes, and the others lose no cycle. */
#include "bus_support.h"
#include "cm1e/hot_connect.h"
#include "effort.h"
#include "sim/esc_chip.h"
#include "sim/segment.h"

/** On the wire: a motor, the optional one, a motor. Of the configuration the optional one is the last. */
enum { FIRST = 1, TOOL = 2, LAST = 3, ID = 7, TRIES = 4000, COMES = 4000, CONTROLWORD = 6 };

static cm1e_bus_config_t wire;

static void describe(cm1e_bus_config_t *to, bool on_the_wire, cm1e_recover_t recover)
{
    cm1e_bus_config_free(to);
    cm1e_bus_config_init(to, "sim", 3);
    to->virtual_time = true;
    to->sim_pdo_order = tested_order();
    for (uint32_t i = 0; i < 3; i++)
        snprintf(to->axes[i].firmware, sizeof to->axes[i].firmware, "%s", tested_firmware());
    to->axes[1].address_kind = CM1E_ADDRESS_EXPLICIT_ID;
    to->axes[1].address = ID;
    to->axes[1].optional = !on_the_wire;
    to->axes[1].recover = recover;
    to->axes[2].address = on_the_wire ? 3 : 2;
}

/** What the motor does not do. */
typedef struct unwilling {
    uint16_t station;
    uint16_t offset;    /**< register that cannot be written; AL control: `state` is refused */
    uint8_t state;
    const char *reason;
    unsigned kept;      /**< frames that were lost which take its address back */
} unwilling_t;

static const unwilling_t cases[] = {
    {0, 0x0120, CM1E_AL_INIT, "it does not go to Init", 0},
    {0, 0x0120, CM1E_AL_PRE_OP, "it does not go to Pre-Operational", 0},
    {0, 0x0120, CM1E_AL_SAFE_OP, "it does not go to Safe-Operational", 0},
    {0, 0x0120, CM1E_AL_OP, "it does not go to Operational", 0},
    {0, 0x0500, 0, "it cannot be configured", 0},
    {0, 0x0800, 0, "it cannot be configured", 0},
    {0, 0x0810, 0, "it cannot be configured", 0},
    {0, 0x0600, 0, "it cannot be configured", 0},
    {0, 0x0400, 0, "it cannot be configured", 0},
    {0, 0x0420, 0, "it cannot be configured", 0},
};
enum { CASES = sizeof cases / sizeof cases[0] };

/** Writes to a slave at the address of the tool are spoilt: to AL control the frame asks for an unknown state; of any
 *  other register the working counter shows that nobody took it. The search uses an address of its own. */
static cm1e_tap_verdict_t spoil(void *context, cm1e_tap_frame_t *frame)
{
    enum { COMMAND_AT = 16, STATION_AT = 18, OFFSET_AT = 20, DATA_AT = 26, FPWR = 5, UNKNOWN_STATE = 0x0F };
    const unwilling_t *motor = context;
    const uint16_t station = cm1e_get_u16(frame->bytes + STATION_AT), offset = cm1e_get_u16(frame->bytes + OFFSET_AT);
    if (frame->bytes[COMMAND_AT] != FPWR || station != motor->station || offset != motor->offset)
        return CM1E_TAP_PASS;
    if (motor->state == 0 && frame->direction == CM1E_TAP_RECEIVED)
        cm1e_frame_change_working_counter(frame->bytes, frame->length, 0, -1);
    if (motor->state && frame->direction == CM1E_TAP_SENT && frame->bytes[DATA_AT] == motor->state)
        frame->bytes[DATA_AT] = UNKNOWN_STATE;
    return CM1E_TAP_PASS;
}

static cm1e_sim_slave_t *at(cm1e_bus_t *bus, uint32_t place) { return cm1e_sim_segment_slave(segment_of(bus), place); }

static const char *how(const cm1e_bus_t *bus, uint16_t position)
{
    static char text[CM1E_PRESENCE_TEXT];
    cm1e_bus_presence_text(bus, position, text, sizeof text);
    return text;
}

/** A program that notices nothing, and asks for the motor whenever it waits. */
static void good_cycle(cm1e_bus_t *bus, uint16_t position)
{
    cm1e_sim_probe_t probe;
    if (cm1e_bus_presence(bus, position) == CM1E_PRESENCE_WAITS)
        ck_assert_int_eq(cm1e_bus_recover(bus, position, &diag), CM1E_OK);
    cm1e_put_u16(cm1e_bus_outputs(bus) + cm1e_bus_find_output(bus, position, 0x6040, 0).offset, CONTROLWORD);
    ck_assert_int_eq(cycle(bus), CM1E_OK);
    ck_assert_uint_eq(cm1e_get_u16(at(bus, FIRST)->memory + ESC_STATION_ADDRESS), 0x1001);
    cm1e_sim_probe(segment_of(bus), TOOL, &probe);
    if (cm1e_bus_presence(bus, position) != CM1E_PRESENCE_THERE && cm1e_sim_esc_present(at(bus, TOOL)))
        ck_assert_msg(probe.controlword == 0, "%s", how(bus, position));
}

static void expect_there(cm1e_bus_t *bus, uint16_t position)
{
    cm1e_sim_probe_t probe;
    for (int n = 0; n < COMES && cm1e_bus_presence(bus, position) != CM1E_PRESENCE_THERE; n++)
        good_cycle(bus, position);
    ck_assert_msg(cm1e_bus_presence(bus, position) == CM1E_PRESENCE_THERE, "%s", how(bus, position));
    for (int n = 0; n < 10; n++)
        good_cycle(bus, position);
    cm1e_sim_probe(segment_of(bus), TOOL, &probe);
    ck_assert_uint_eq(probe.controlword, CONTROLWORD);
}

static void expect_refused(cm1e_bus_t *bus, uint16_t position, const char *reason)
{
    unsigned refused = 0, tries = 0;
    char failure[100];
    snprintf(failure, sizeof failure, " The last attempt failed: %s.", reason);
    for (int n = 0; n < TRIES; n++) {
        const bool before = cm1e_bus_presence(bus, position) == CM1E_PRESENCE_REFUSED;
        good_cycle(bus, position);
        ck_assert_int_ne(cm1e_bus_presence(bus, position), CM1E_PRESENCE_THERE);
        if (cm1e_bus_presence(bus, position) == CM1E_PRESENCE_WAITS && refused > 0)
            ck_assert_msg(strstr(how(bus, position), failure) != NULL, "%s", how(bus, position));
        if (cm1e_bus_presence(bus, position) != CM1E_PRESENCE_REFUSED)
            continue;
        refused++;
        tries += !before;
        ck_assert_msg(strstr(how(bus, position), reason) != NULL, "%s", how(bus, position));
    }
    ck_assert_msg(refused > 0 && tries > 1, "refused %u, tries %u: %s", refused, tries, how(bus, position));
}

/** `there`: it was at the start. Otherwise its process data are only planned. */
static cm1e_bus_t *start_machine(bool there, cm1e_recover_t recover)
{
    describe(&config, false, recover);
    describe(&wire, true, recover);
    cm1e_bus_t *bus = open_bus_on(&wire);
    if (!there)
        cm1e_sim_segment_detach(segment_of(bus), TOOL, false);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    return bus;
}

static void leave(cm1e_bus_t *bus, uint16_t position)
{
    cm1e_sim_segment_detach(segment_of(bus), TOOL, false);
    cycle(bus); /* the frame that is on its way when the plug is pulled */
    for (int n = 0; n < 600; n++)
        ck_assert_int_eq(cycle(bus), CM1E_OK);
    ck_assert_msg(cm1e_bus_presence(bus, position) == CM1E_PRESENCE_ABSENT, "%s", how(bus, position));
}

START_TEST(a_motor_that_cannot_be_configured_is_refused_until_it_is_mended)
{
    unwilling_t motor = cases[_i / 4];
    const bool there = _i % 2;
    const uint16_t position = there ? TOOL : LAST;
    cm1e_bus_t *bus = start_machine(there, _i / 2 % 2 ? CM1E_RECOVER_AUTO : CM1E_RECOVER_ASK);
    motor.station = (uint16_t)(0x1000 + position);
    if (there)
        leave(bus, position);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), spoil, &motor);
    cm1e_sim_segment_attach(segment_of(bus), TOOL);
    expect_refused(bus, position, motor.reason);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    expect_there(bus, position);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&wire);
}
END_TEST

/** No answer says that it is in Operational. */
static cm1e_tap_verdict_t hide_state(void *context, cm1e_tap_frame_t *frame)
{
    enum { AL_STATUS = 0x0130 };
    cm1e_bus_t *bus = context;
    uint16_t station;
    const int place = find_read(frame, AL_STATUS, &station);
    if (frame->direction == CM1E_TAP_RECEIVED && place >= 0 && station == 0x1000 + LAST &&
        cm1e_sim_slave_al_state(at(bus, TOOL)) == CM1E_AL_OP)
        cm1e_frame_change_working_counter(frame->bytes, frame->length, (unsigned)place, -1);
    return CM1E_TAP_PASS;
}

/** It counts as absent then, and takes part in the process data until the search has met it. */
START_TEST(a_motor_that_is_in_operational_without_being_known_to_be_gets_no_outputs)
{
    unsigned in_operational = 0, absent = 0;
    cm1e_bus_t *bus = start_machine(false, CM1E_RECOVER_AUTO);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), hide_state, bus);
    cm1e_sim_segment_attach(segment_of(bus), TOOL);
    for (int n = 0; n < TRIES; n++) {
        good_cycle(bus, LAST);
        const bool runs = cm1e_sim_slave_al_state(at(bus, TOOL)) == CM1E_AL_OP;
        in_operational += runs;
        absent += runs && cm1e_bus_presence(bus, LAST) == CM1E_PRESENCE_ABSENT;
    }
    ck_assert_uint_gt(in_operational, 20);
    ck_assert_uint_gt(absent, 10);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    expect_there(bus, LAST);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&wire);
}
END_TEST

/** The frames that take its address back are lost, too, so the search meets a device that has one of ours. */
static cm1e_tap_verdict_t spoil_and_keep_address(void *context, cm1e_tap_frame_t *frame)
{
    enum { COMMAND_AT = 16, STATION_AT = 18, OFFSET_AT = 20, FPWR = 5, STATION_ADDRESS = 0x0010 };
    unwilling_t *motor = context;
    const bool takes_back = frame->direction == CM1E_TAP_SENT && frame->bytes[COMMAND_AT] == FPWR &&
                            cm1e_get_u16(frame->bytes + STATION_AT) == motor->station &&
                            cm1e_get_u16(frame->bytes + OFFSET_AT) == STATION_ADDRESS;
    motor->kept += takes_back;
    return takes_back ? CM1E_TAP_DROP : spoil(context, frame);
}

START_TEST(a_motor_that_keeps_its_address_is_identified_again)
{
    unwilling_t motor = cases[_i];
    cm1e_bus_t *bus = start_machine(false, CM1E_RECOVER_AUTO);
    motor.station = 0x1000 + LAST;
    cm1e_nic_set_tap(cm1e_bus_nic(bus), spoil_and_keep_address, &motor);
    cm1e_sim_segment_attach(segment_of(bus), TOOL);
    for (int n = 0; n < TRIES; n++) {
        good_cycle(bus, LAST);
        ck_assert_int_ne(cm1e_bus_presence(bus, LAST), CM1E_PRESENCE_THERE);
    }
    ck_assert_uint_gt(motor.kept, 0);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    expect_there(bus, LAST);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&wire);
}
END_TEST

/** Somebody turns its switches, whenever that is, and turns them back. It takes part with the ID that it had when it was
 *  asked last; if that was the wrong one, it has no address of ours. */
START_TEST(a_motor_whose_switches_are_turned_while_it_comes_is_refused_or_takes_part)
{
    enum { BEGIN = 280, END = 440, TURNED = 3000 };
    const int stride = sweep_stride(1, 12);
    unsigned refused = 0, taken = 0;
    cm1e_bus_t *bus = start_machine(true, CM1E_RECOVER_AUTO);
    for (int moment = BEGIN + sweep_first(0, stride); moment < END; moment += stride) {
        leave(bus, TOOL);
        cm1e_sim_segment_attach(segment_of(bus), TOOL);
        for (int n = 0; n < moment; n++)
            good_cycle(bus, TOOL);
        simulate(bus, "switches 2 08");
        for (int n = 0; n < TURNED; n++)
            good_cycle(bus, TOOL);
        const bool there = cm1e_bus_presence(bus, TOOL) == CM1E_PRESENCE_THERE;
        const uint16_t station = cm1e_get_u16(at(bus, TOOL)->memory + ESC_STATION_ADDRESS);
        ck_assert_msg(there ? station == 0x1002 : station == 0 || station == 0x2FFE, "moment %d: 0x%04X", moment, station);
        refused += !there;
        taken += there;
        simulate(bus, "switches 2 07");
        expect_there(bus, TOOL);
    }
    ck_assert_msg(refused > 0 && taken > 0, "%u, %u", refused, taken);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&wire);
}
END_TEST

/** A motor that is always there is tried again for as long as it answers, and its text says why in vain. */
START_TEST(a_motor_that_is_always_there_and_cannot_be_configured_is_tried_again)
{
    unwilling_t motor = cases[_i];
    char text[200];
    cm1e_sim_probe_t probe;
    unsigned told = 0;
    sim_config(3);
    config.axes[TOOL - 1].recover = CM1E_RECOVER_AUTO;
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 20);
    motor.station = 0x1000 + TOOL;
    cm1e_nic_set_tap(cm1e_bus_nic(bus), spoil, &motor);
    simulate(bus, "power-cycle 2 20");
    for (int n = 0; n < 20; n++)
        cycle(bus);
    cm1e_put_u16(cm1e_bus_outputs(bus) + cm1e_bus_find_output(bus, TOOL, 0x6040, 0).offset, CONTROLWORD);
    snprintf(text, sizeof text, " The last attempt failed: %s.", motor.reason);
    for (int n = 0; n < TRIES; n++) {
        cycle(bus);
        cm1e_sim_probe(segment_of(bus), TOOL, &probe);
        ck_assert_uint_eq(probe.controlword, 0);
        ck_assert_uint_ne(cm1e_sim_slave_al_state(at(bus, TOOL)), CM1E_AL_OP);
        told += strstr(how(bus, TOOL), text) != NULL;
    }
    ck_assert_msg(told > TRIES * 3 / 4, "%u: %s", told, how(bus, TOOL));
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    for (int n = 0; n < COMES && cm1e_bus_presence(bus, TOOL) != CM1E_PRESENCE_THERE; n++)
        cycle(bus);
    ck_assert_str_eq(how(bus, TOOL), "");
    cycles(bus, 100);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_hot_unwilling");
    TCase *tests = tcase_create("unwilling");
    tcase_set_timeout(tests, 60);
    tcase_add_loop_test(tests, a_motor_that_cannot_be_configured_is_refused_until_it_is_mended, 0, 4 * CASES);
    tcase_add_loop_test(tests, a_motor_that_is_always_there_and_cannot_be_configured_is_tried_again, 0, CASES);
    tcase_add_loop_test(tests, a_motor_that_keeps_its_address_is_identified_again, 0, CASES);
    tcase_add_test(tests, a_motor_whose_switches_are_turned_while_it_comes_is_refused_or_takes_part);
    tcase_add_test(tests, a_motor_that_is_in_operational_without_being_known_to_be_gets_no_outputs);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
