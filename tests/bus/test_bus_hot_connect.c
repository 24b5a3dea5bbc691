/* Optional slaves of every kind: absent at the start, coming, leaving and coming back at every moment, while the others
 * run and lose no cycle; strangers; who brings a slave back. */
#include "bus_support.h"
#include "cm1e/hot_connect.h"
#include "cm1e/io.h"
#include "effort.h"
#include "sim/esc_chip.h"
#include "sim/segment.h"
#include "slave_settings.h"

/** On the wire: a motor, the optional slave or the group, inputs and outputs, a motor. */
enum { FIRST = 1, TOOL = 2, MEMBER = 3, ABSENT = 4 /* position of the first that is planned: behind the others */ };
enum { ID = 7, ALIAS = 4711, COMES = 4000 };

typedef enum kind { MOTOR, DIGITAL, OUTPUTS_ONLY, GROUP, ANALOG, DRIVE, BRIDGE, MODULAR, KINDS } kind_t;

static unsigned slaves_of(kind_t kind) { return kind == GROUP ? 2 : 1; }
static bool has_axis(kind_t kind) { return kind == MOTOR || kind == DRIVE || kind == BRIDGE; }

static const uint32_t modules[] = {0x205, 0x105, 0x302};
static cm1e_bus_config_t wire;

static cm1e_slave_config_t *add_slave(cm1e_bus_config_t *to, const char *name, cm1e_sim_slave_kind_t kind,
                                      unsigned inputs, unsigned outputs)
{
    cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(to, name);
    slave->sim.kind = kind;
    slave->sim.inputs = (uint8_t)inputs;
    slave->sim.outputs = (uint8_t)outputs;
    slave->vendor = 0x000004D8;
    slave->product = 0x00001000u + 100u * (unsigned)kind + 10u * inputs + outputs;
    return slave;
}

static void name_first_bit(cm1e_slave_config_t *slave, const char *name, bool output)
{
    cm1e_signal_config_t *signal = &slave->signals[slave->signal_count++];
    snprintf(signal->name, sizeof signal->name, "%s", name);
    signal->output = output;
    signal->bits = 1;
}

static void add_tool_slaves(cm1e_bus_config_t *to, kind_t kind, bool on_the_wire)
{
    cm1e_slave_config_t *slave =
        kind == DIGITAL        ? add_slave(to, "tool", CM1E_SIM_SLAVE_DIGITAL, 4, 4)
        : kind == OUTPUTS_ONLY ? add_slave(to, "tool", CM1E_SIM_SLAVE_DIGITAL, 0, 4)
        : kind == MODULAR      ? add_slave(to, "tool", CM1E_SIM_SLAVE_MODULAR, 0, 0)
        : kind == ANALOG       ? add_slave(to, "tool", CM1E_SIM_SLAVE_ANALOG, 2, 2)
                               : add_slave(to, "tool", CM1E_SIM_SLAVE_COUPLER, 0, 0);
    slave->address_kind = kind == ANALOG ? CM1E_ADDRESS_EXPLICIT_ID : CM1E_ADDRESS_ALIAS;
    slave->address = kind == ANALOG ? ID : ALIAS;
    slave->optional = true;
    if (kind == MODULAR) {
        memcpy(slave->modules, modules, sizeof modules);
        slave->module_count = sizeof modules / sizeof modules[0];
    }
    if (kind == DIGITAL || kind == OUTPUTS_ONLY)
        name_first_bit(slave, "clamp", true);
    if (kind != GROUP)
        return;
    snprintf(slave->hot_connect, sizeof slave->hot_connect, "gripper");
    cm1e_slave_config_t *member = add_slave(to, "fingers", CM1E_SIM_SLAVE_DIGITAL, 2, 3);
    snprintf(member->hot_connect, sizeof member->hot_connect, "gripper");
    member->address = on_the_wire ? MEMBER : 2;
    if (on_the_wire)
        member->hot_connect[0] = '\0';
    name_first_bit(member, "closed", false);
}

static void add_tool_axis(cm1e_bus_config_t *to, kind_t kind)
{
    cm1e_axis_config_t *axis = cm1e_bus_config_add_axis(to, "tool");
    snprintf(axis->firmware, sizeof axis->firmware, "%s", kind == MOTOR ? tested_firmware() : "");
    axis->address_kind = kind == MOTOR ? CM1E_ADDRESS_EXPLICIT_ID : CM1E_ADDRESS_ALIAS;
    axis->address = kind == MOTOR ? ID : ALIAS;
    axis->optional = true;
    if (kind == DRIVE) {
        snprintf(axis->device, sizeof axis->device, "cia402");
        axis->counts_per_revolution = 10000;
        axis->max_speed_rpm = 3000;
    }
    if (kind == BRIDGE) {
        axis->channel = 1;
        axis->k37 = 10;
        axis->k37_stated = true;
        snprintf(axis->motor, sizeof axis->motor, "CM1");
    }
}

/** `on_the_wire`: with the places as they are while the tool is there. */
static void describe(cm1e_bus_config_t *to, kind_t kind, bool on_the_wire)
{
    const uint16_t more = on_the_wire ? (uint16_t)slaves_of(kind) : 0;
    cm1e_bus_config_free(to);
    cm1e_bus_config_init(to, "sim", 2);
    to->virtual_time = true;
    to->sim_pdo_order = tested_order();
    for (uint32_t i = 0; i < 2; i++)
        snprintf(to->axes[i].firmware, sizeof to->axes[i].firmware, "%s", tested_firmware());
    to->axes[0].address = FIRST;
    to->axes[1].address = (uint16_t)(3 + more);
    add_slave(to, "valves", CM1E_SIM_SLAVE_DIGITAL, 4, 4)->address = (uint16_t)(2 + more);
    if (has_axis(kind))
        add_tool_axis(to, kind);
    else
        add_tool_slaves(to, kind, on_the_wire);
}

static void attach(cm1e_bus_t *bus, kind_t kind)
{
    for (unsigned i = 0; i < slaves_of(kind); i++)
        cm1e_sim_segment_attach(segment_of(bus), TOOL + i);
}

static void detach(cm1e_bus_t *bus, kind_t kind)
{
    for (unsigned i = 0; i < slaves_of(kind); i++)
        cm1e_sim_segment_detach(segment_of(bus), TOOL + i, false);
}

static cm1e_bus_t *open_machine(kind_t kind, bool there)
{
    describe(&config, kind, false);
    describe(&wire, kind, true);
    cm1e_bus_t *bus = open_bus_on(&wire);
    if (!there)
        detach(bus, kind);
    return bus;
}

static cm1e_bus_t *start_machine(kind_t kind, bool there)
{
    cm1e_bus_t *bus = open_machine(kind, there);
    const cm1e_error_t error = cm1e_bus_start(bus, &diag);
    ck_assert_msg(error == CM1E_OK, "kind %d: %s: %s", kind, cm1e_strerror(error), diag.text);
    return bus;
}

/** Positions of the tool: as scanned if it was there, else behind the others. */
static uint16_t position_of(const cm1e_bus_t *bus, bool there)
{
    ck_assert_ptr_nonnull(bus);
    return there ? TOOL : ABSENT;
}

/** A cycle in which every slave but the tool takes part, with the answer of each. */
static void good_cycle(cm1e_bus_t *bus)
{
    ck_assert_int_eq(cycle(bus), CM1E_OK);
    ck_assert_uint_eq(cm1e_bus_counters(bus)->working_counter_errors, 0);
}

static bool is_there(const cm1e_bus_t *bus, uint16_t position, unsigned count)
{
    for (unsigned i = 0; i < count; i++)
        if (cm1e_bus_presence(bus, position + i) != CM1E_PRESENCE_THERE)
            return false;
    return true;
}

/** Good cycles until the tool takes part, which somebody asks for; 0: it does not. */
static unsigned cycles_until_there(cm1e_bus_t *bus, uint16_t position, kind_t kind, unsigned limit)
{
    for (unsigned n = 1; n <= limit; n++) {
        good_cycle(bus);
        for (unsigned i = 0; i < slaves_of(kind); i++)
            if (cm1e_bus_presence(bus, position + i) == CM1E_PRESENCE_WAITS)
                ck_assert_int_eq(cm1e_bus_recover(bus, position + i, &diag), CM1E_OK);
        if (is_there(bus, position, slaves_of(kind)))
            return n;
    }
    return 0;
}

static const char *how(const cm1e_bus_t *bus, uint16_t position)
{
    static char text[320];
    cm1e_bus_presence_text(bus, position, text, sizeof text);
    return text;
}

static unsigned state_of(cm1e_bus_t *bus, uint32_t place)
{
    return cm1e_sim_slave_al_state(cm1e_sim_segment_slave(segment_of(bus), place));
}

START_TEST(absent_at_the_start_then_comes_goes_and_comes_back)
{
    const kind_t kind = (kind_t)_i;
    slave_settings_t there[2];
    cm1e_bus_t *bus = start_machine(kind, true);
    take_settings(bus, TOOL, slaves_of(kind), there);
    cm1e_bus_close(bus);
    bus = start_machine(kind, false);
    const uint16_t position = position_of(bus, false);
    ck_assert_uint_eq(cm1e_bus_slave_count(bus), 3 + slaves_of(kind));
    for (int n = 0; n < 200; n++)
        good_cycle(bus);
    ck_assert_int_eq(cm1e_bus_presence(bus, position), CM1E_PRESENCE_ABSENT);
    for (int round = 0; round < 2; round++) {
        attach(bus, kind);
        ck_assert_msg(cycles_until_there(bus, position, kind, COMES) > 0, "kind %d round %d: %s", kind, round,
                      how(bus, position));
        ck_assert_uint_eq(cm1e_bus_slave(bus, position)->al_state, CM1E_AL_OP);
        for (unsigned i = 0; i < slaves_of(kind); i++)
            ck_assert_uint_eq(state_of(bus, TOOL + i), CM1E_AL_OP);
        expect_settings(bus, TOOL, slaves_of(kind), there, true);
        for (int n = 0; n < 100; n++)
            good_cycle(bus);
        detach(bus, kind);
        cycle(bus); /* the frame that is on its way when the plug is pulled */
        for (int n = 0; n < 300; n++)
            good_cycle(bus);
        ck_assert_int_eq(cm1e_bus_presence(bus, position), CM1E_PRESENCE_ABSENT);
        ck_assert_uint_eq(cm1e_bus_slave(bus, position)->al_state, 0); /* not known */
    }
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(there_at_the_start_goes_and_comes_back)
{
    const kind_t kind = (kind_t)_i;
    cm1e_bus_t *bus = start_machine(kind, true);
    const uint16_t position = position_of(bus, true);
    slave_settings_t before[2];
    take_settings(bus, TOOL, slaves_of(kind), before);
    ck_assert(is_there(bus, position, slaves_of(kind)));
    for (int n = 0; n < 100; n++)
        good_cycle(bus);
    detach(bus, kind);
    cycle(bus);
    for (int n = 0; n < 300; n++)
        good_cycle(bus);
    attach(bus, kind);
    ck_assert_msg(cycles_until_there(bus, position, kind, COMES) > 0, "kind %d: %s", kind, how(bus, position));
    expect_settings(bus, TOOL, slaves_of(kind), before, false);
    for (int n = 0; n < 100; n++)
        good_cycle(bus);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- moments ----------------------------------------------------------------------------------------------------- */

/** Off the wire until the bus has seen it. */
static void leave(cm1e_bus_t *bus, kind_t kind, uint16_t position)
{
    detach(bus, kind);
    cycle(bus);
    for (int n = 0; n < 60 && cm1e_bus_presence(bus, position) != CM1E_PRESENCE_ABSENT; n++)
        good_cycle(bus);
    ck_assert_int_eq(cm1e_bus_presence(bus, position), CM1E_PRESENCE_ABSENT);
}

static void allow(cm1e_bus_t *bus, kind_t kind, uint16_t position)
{
    for (unsigned i = 0; i < slaves_of(kind); i++)
        if (cm1e_bus_presence(bus, position + i) == CM1E_PRESENCE_WAITS)
            ck_assert_int_eq(cm1e_bus_recover(bus, position + i, &diag), CM1E_OK);
}

/** Every moment of coming is one at which it leaves again. Whoever is half configured does no harm to the others. */
START_TEST(leaving_at_every_moment_of_coming)
{
    const kind_t kind = (kind_t)(_i % KINDS);
    const bool there = _i >= KINDS;
    cm1e_bus_t *bus = start_machine(kind, there);
    const uint16_t position = position_of(bus, there);
    const int stride = sweep_stride(1, 8);
    if (there)
        leave(bus, kind, position);
    for (int moment = sweep_first(_i, stride), comes = 1; comes; moment += stride) {
        attach(bus, kind);
        for (int n = 0; n < moment; n++) {
            good_cycle(bus);
            allow(bus, kind, position);
        }
        comes = !is_there(bus, position, slaves_of(kind));
        ck_assert_msg(moment < COMES, "%s", how(bus, position));
        leave(bus, kind, position);
    }
    attach(bus, kind);
    ck_assert_uint_gt(cycles_until_there(bus, position, kind, COMES), 0);
    cm1e_bus_close(bus);
}
END_TEST

/** Frames of the start, and the one at which the tool is pulled. */
typedef struct pull {
    cm1e_bus_t *bus;
    kind_t kind;
    unsigned frames, at;
} pull_t;

static cm1e_tap_verdict_t pull_at(void *context, cm1e_tap_frame_t *frame)
{
    pull_t *pull = context;
    if (frame->direction == CM1E_TAP_SENT && pull->frames++ == pull->at)
        detach(pull->bus, pull->kind);
    return CM1E_TAP_PASS;
}

/** The start succeeds without it, or ends with an error; the next start succeeds without it, and with it. */
START_TEST(leaving_at_every_moment_of_the_start)
{
    const kind_t kind = (kind_t)_i;
    const int stride = sweep_stride_everyday(11, 388, 997); /* every frame takes many minutes */
    unsigned frames = 1;
    for (unsigned at = (unsigned)sweep_first(_i, stride); at < frames; at += (unsigned)stride) {
        cm1e_bus_t *bus = open_machine(kind, true);
        pull_t pull = {.bus = bus, .kind = kind, .at = at};
        cm1e_nic_set_tap(cm1e_bus_nic(bus), pull_at, &pull);
        const cm1e_error_t error = cm1e_bus_start(bus, &diag);
        ck_assert(error == CM1E_OK || diag.text[0]);
        cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
        frames = pull.frames > frames ? pull.frames : frames;
        detach(bus, kind);
        cm1e_bus_stop(bus);
        ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "at %u: %s", at, diag.text);
        attach(bus, kind);
        ck_assert_uint_gt(cycles_until_there(bus, ABSENT, kind, COMES), 0);
        cm1e_bus_close(bus);
    }
}
END_TEST

/** One in n frames that are not process data (LRW, command 12) is lost while it comes. */
typedef struct disturbance {
    int one_in;
    unsigned lost;
} disturbance_t;

static cm1e_tap_verdict_t lose_some(void *context, cm1e_tap_frame_t *frame)
{
    disturbance_t *d = context;
    if (frame->bytes[16] == 12 || rand() % d->one_in)
        return CM1E_TAP_PASS;
    d->lost++;
    return CM1E_TAP_DROP;
}

START_TEST(comes_although_frames_are_lost)
{
    const kind_t kind = (kind_t)(_i % KINDS);
    disturbance_t disturbance = {.one_in = 4 + _i / KINDS};
    cm1e_bus_t *bus = start_machine(kind, false);
    srand((unsigned)_i);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), lose_some, &disturbance);
    attach(bus, kind);
    ck_assert_msg(cycles_until_there(bus, ABSENT, kind, 40000) > 0, "%s", how(bus, ABSENT));
    ck_assert_uint_gt(disturbance.lost, 5);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- who it is --------------------------------------------------------------------------------------------------- */

static const cm1e_sim_slave_t *device(cm1e_bus_t *bus) { return cm1e_sim_segment_slave(segment_of(bus), TOOL); }

static uint16_t station_of(cm1e_bus_t *bus) { return cm1e_get_u16(device(bus)->memory + ESC_STATION_ADDRESS); }

/** Cycles with the stranger on the wire: it is named, is in Init without FMMUs, and has no address of ours for long. */
static void expect_refused(cm1e_bus_t *bus, cm1e_presence_t presence, const char *part)
{
    static const uint8_t none[64];
    cm1e_stranger_t stranger[CM1E_STRANGERS];
    unsigned with_ours = 0, without = 0;
    for (int n = 0; n < 1500; n++) {
        good_cycle(bus);
        with_ours += station_of(bus) > 0x1000 && station_of(bus) < 0x1100;
        without += station_of(bus) == 0;
    }
    ck_assert_uint_eq(with_ours, 0);
    ck_assert_uint_gt(without, 1000);
    ck_assert_uint_eq(cm1e_bus_strangers(bus, stranger, CM1E_STRANGERS), 1);
    ck_assert_uint_eq(stranger[0].place, TOOL);
    ck_assert_int_eq(cm1e_bus_presence(bus, ABSENT), presence);
    ck_assert_msg(strstr(how(bus, ABSENT), part) != NULL, "%s", how(bus, ABSENT));
    ck_assert_uint_eq(state_of(bus, TOOL), CM1E_AL_INIT);
    ck_assert_mem_eq(device(bus)->memory + 0x0600, none, sizeof none);
}

START_TEST(stranger_with_another_product_is_refused_and_named)
{
    describe(&config, DIGITAL, false);
    describe(&wire, DIGITAL, true);
    wire.slaves[1].product++;
    cm1e_bus_t *bus = open_bus_on(&wire);
    detach(bus, DIGITAL);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    attach(bus, DIGITAL);
    expect_refused(bus, CM1E_PRESENCE_REFUSED, "its vendor, product or revision is another one");
    detach(bus, DIGITAL);
    cycle(bus);
    for (int n = 0; n < 100; n++)
        good_cycle(bus);
    ck_assert_uint_eq(cm1e_bus_strangers(bus, NULL, 0), 0);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(stranger_with_another_address_is_refused_and_named)
{
    const kind_t kind = _i == 0 ? DIGITAL : _i == 1 ? ANALOG : MOTOR;
    describe(&config, kind, false);
    describe(&wire, kind, true);
    if (has_axis(kind))
        wire.axes[2].address++;
    else
        wire.slaves[1].address++;
    cm1e_bus_t *bus = open_bus_on(&wire);
    detach(bus, kind);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    attach(bus, kind);
    expect_refused(bus, CM1E_PRESENCE_ABSENT, "is optional and absent");
    cm1e_stranger_t stranger;
    ck_assert_uint_eq(cm1e_bus_strangers(bus, &stranger, 1), 1);
    ck_assert_uint_eq(kind == DIGITAL ? stranger.alias : stranger.explicit_id, kind == DIGITAL ? ALIAS + 1 : ID + 1);
    if (kind == MOTOR) { /* its switches are turned to what is expected */
        simulate(bus, "switches 2 07");
        ck_assert_uint_gt(cycles_until_there(bus, ABSENT, kind, COMES), 0);
    }
    cm1e_bus_close(bus);
}
END_TEST

/** Its power stayed on, with its address and the FMMUs of whoever had configured it. */
START_TEST(device_that_kept_its_power_is_identified_again)
{
    cm1e_bus_t *bus = start_machine(DIGITAL, true);
    for (int n = 0; n < 20; n++)
        good_cycle(bus);
    cm1e_sim_segment_detach(segment_of(bus), TOOL, true);
    cycle(bus);
    for (int n = 0; n < 40; n++)
        good_cycle(bus);
    ck_assert_int_eq(cm1e_bus_presence(bus, TOOL), CM1E_PRESENCE_ABSENT);
    attach(bus, DIGITAL);
    ck_assert_uint_gt(cycles_until_there(bus, TOOL, DIGITAL, COMES), 0);
    cm1e_bus_close(bus);
}
END_TEST

/** Not every device tells its ID in Init. A stranger that does not is in Init again when it is refused. */
START_TEST(explicit_device_id_is_asked_for_in_pre_operational_too)
{
    const kind_t kind = _i % 2 ? ANALOG : MOTOR;
    describe(&config, kind, false);
    describe(&wire, kind, true);
    if (has_axis(kind))
        wire.axes[2].address += _i / 2;
    else
        wire.slaves[1].address += _i / 2;
    cm1e_bus_t *bus = open_bus_on(&wire);
    simulate(bus, "quirk 2 late-id 1");
    detach(bus, kind);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    attach(bus, kind);
    if (_i / 2)
        expect_refused(bus, CM1E_PRESENCE_ABSENT, "is optional and absent");
    else
        ck_assert_msg(cycles_until_there(bus, ABSENT, kind, COMES) > 0, "%s", how(bus, ABSENT));
    cm1e_bus_close(bus);
}
END_TEST

/* ---- who brings it back ------------------------------------------------------------------------------------------ */

static cm1e_bus_t *start_with_policy(kind_t kind, cm1e_recover_t policy)
{
    describe(&config, kind, false);
    describe(&wire, kind, true);
    if (has_axis(kind))
        config.axes[2].recover = policy;
    else
        config.slaves[1].recover = policy;
    cm1e_bus_t *bus = open_bus_on(&wire);
    detach(bus, kind);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    attach(bus, kind);
    return bus;
}

/** Good cycles in which nobody asks. */
static cm1e_presence_t presence_unasked(cm1e_bus_t *bus)
{
    for (int n = 0; n < 1500; n++)
        good_cycle(bus);
    return cm1e_bus_presence(bus, ABSENT);
}

START_TEST(policy_says_who_brings_it_back)
{
    static const struct {
        kind_t kind;
        cm1e_recover_t policy;
        cm1e_presence_t unasked;
        const char *words;
    } cases[] = {
        {MOTOR, CM1E_RECOVER_DEFAULT, CM1E_PRESENCE_WAITS, "MC_Reset of its axis, `cm1e recover 4` or"},
        {MOTOR, CM1E_RECOVER_ASK, CM1E_PRESENCE_WAITS, "MC_Reset of its axis, `cm1e recover 4` or"},
        {MOTOR, CM1E_RECOVER_AUTO, CM1E_PRESENCE_THERE, ""},
        {MOTOR, CM1E_RECOVER_NEVER, CM1E_PRESENCE_STAYS_OUT, "recover: never"},
        {DIGITAL, CM1E_RECOVER_DEFAULT, CM1E_PRESENCE_THERE, ""},
        {DIGITAL, CM1E_RECOVER_ASK, CM1E_PRESENCE_WAITS, "waits for being asked: `cm1e recover 4` or"},
        {DIGITAL, CM1E_RECOVER_AUTO, CM1E_PRESENCE_THERE, ""},
        {DIGITAL, CM1E_RECOVER_NEVER, CM1E_PRESENCE_STAYS_OUT, "recover: never"},
        {BRIDGE, CM1E_RECOVER_AUTO, CM1E_PRESENCE_THERE, ""},
        {DRIVE, CM1E_RECOVER_AUTO, CM1E_PRESENCE_THERE, ""},
    };
    cm1e_bus_t *bus = start_with_policy(cases[_i].kind, cases[_i].policy);
    ck_assert_int_eq(cm1e_bus_recover(bus, ABSENT, &diag), CM1E_ERROR_STATE); /* not there yet: nothing is kept */
    ck_assert_msg(strstr(diag.text, "absent") != NULL, "%s", diag.text);
    ck_assert_int_eq(presence_unasked(bus), cases[_i].unasked);
    ck_assert_msg(strstr(how(bus, ABSENT), cases[_i].words) != NULL, "%s", how(bus, ABSENT));
    if (cases[_i].unasked == CM1E_PRESENCE_WAITS)
        ck_assert_uint_gt(cycles_until_there(bus, ABSENT, cases[_i].kind, COMES), 0);
    if (cases[_i].unasked == CM1E_PRESENCE_STAYS_OUT) {
        cm1e_bus_request_recovery(bus, ABSENT);
        ck_assert_int_eq(presence_unasked(bus), CM1E_PRESENCE_STAYS_OUT);
        ck_assert_uint_eq(state_of(bus, TOOL), CM1E_AL_INIT);
    }
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(policy_counts_for_a_slave_that_is_always_there_too)
{
    static const cm1e_recover_t policies[] = {CM1E_RECOVER_NEVER, CM1E_RECOVER_ASK, CM1E_RECOVER_AUTO};
    sim_config(2);
    config.axes[1].recover = policies[_i];
    cm1e_bus_t *bus = start_bus();
    simulate(bus, "power-cycle 2 20");
    for (int n = 0; n < 1500; n++)
        cycle(bus);
    ck_assert_uint_eq(state_of(bus, 2) == CM1E_AL_OP, policies[_i] == CM1E_RECOVER_AUTO);
    for (int n = 0; n < 1500; n++) {
        cycle(bus);
        cm1e_bus_request_recovery(bus, 2);
    }
    ck_assert_uint_eq(state_of(bus, 2) == CM1E_AL_OP, policies[_i] != CM1E_RECOVER_NEVER);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- the others -------------------------------------------------------------------------------------------------- */

/** The places behind the tool move when it comes and goes; who loses its power there is found all the same. */
START_TEST(slave_behind_the_tool_comes_back_with_and_without_it)
{
    cm1e_bus_t *bus = start_machine(DIGITAL, false);
    const uint16_t behind = 3; /* as scanned without the tool */
    for (int round = 0; round < 4; round++) {
        const bool tool = round % 2;
        if (tool) {
            attach(bus, DIGITAL);
            for (int n = 0; n < 1000; n++)
                cycle(bus);
        }
        simulate(bus, "power-cycle 4 20");
        bool lost = false, back = false;
        for (int n = 0; n < 3000 && !back; n++) {
            cycle(bus);
            const cm1e_slave_watch_t watch = cm1e_bus_slave_watch(bus, behind);
            lost = lost || watch.lost;
            back = lost && watch.al_state == CM1E_AL_OP;
            if (lost)
                cm1e_bus_request_recovery(bus, behind);
        }
        ck_assert_msg(back, "round %d", round);
        for (int n = 0; n < 100; n++)
            ck_assert_int_eq(cycle(bus), CM1E_OK);
        detach(bus, DIGITAL);
        for (int n = 0; n < 100; n++)
            cycle(bus);
    }
    cm1e_bus_close(bus);
}
END_TEST

/** A wrong working counter is still an error if it is not the optional slave's. */
START_TEST(others_that_leave_are_noticed)
{
    cm1e_bus_t *bus = start_machine((kind_t)(_i / 2), _i % 2);
    simulate(bus, "power-cycle 1 60000");
    cycle(bus);
    unsigned errors = 0;
    for (int n = 0; n < 40; n++)
        errors += cycle(bus) != CM1E_OK;
    ck_assert_uint_ge(errors, 35);
    ck_assert_int_ne(cm1e_bus_health(bus), CM1E_OK);
    cm1e_bus_close(bus);
}
END_TEST

/** A slave that goes on giving inputs and takes no outputs, in Safe-Operational: of the others it is an error. */
START_TEST(slave_without_outputs_is_an_error_unless_it_is_optional)
{
    cm1e_bus_t *bus = start_machine(ANALOG, true);
    cycles(bus, 20);
    cm1e_sim_slave_fall_back(cm1e_sim_segment_slave(segment_of(bus), _i ? TOOL : MEMBER + 1), CM1E_AL_SAFE_OP, 0x001B);
    unsigned seen = 0;
    for (int n = 0; n < 60; n++) {
        const cm1e_error_t error = cycle(bus);
        ck_assert(!_i || error == CM1E_OK);
        seen += cm1e_bus_slave_watch(bus, _i ? TOOL : MEMBER + 1).al_state != CM1E_AL_OP;
    }
    ck_assert_uint_gt(seen, 0);
    cm1e_bus_close(bus);
}
END_TEST

/** Transfers to the others go on while the tool is configured, and each cycle carries its process data. */
START_TEST(configuration_of_the_tool_stops_nothing)
{
    cm1e_bus_t *bus = start_machine(ANALOG, false);
    uint8_t data[4];
    cm1e_sdo_t sdo = {.position = 1, .index = 0x1000, .data = data, .size = 4};
    attach(bus, ANALOG);
    const uint64_t before = cm1e_bus_counters(bus)->cycles;
    unsigned transfers = 0, n = 0;
    while (!is_there(bus, ABSENT, 1)) {
        if (cm1e_sdo_state(&sdo) != CM1E_SDO_BUSY) {
            sdo = (cm1e_sdo_t){.position = 1, .index = 0x1000, .data = data, .size = 4};
            ck_assert_int_eq(cm1e_sdo_submit(bus, &sdo), CM1E_OK);
            transfers++;
        }
        good_cycle(bus);
        ck_assert_uint_lt(++n, COMES);
    }
    ck_assert_uint_eq(cm1e_bus_counters(bus)->cycles - before, n);
    ck_assert_uint_gt(transfers, n / 12);
    finish_sdo(bus, &sdo);
    cm1e_bus_close(bus);
}
END_TEST

/** Handles are found while the slave is away. */
START_TEST(signals_of_an_absent_slave_have_a_quality)
{
    cm1e_bus_t *bus = start_machine(GROUP, false);
    cm1e_io_t closed, valve;
    ck_assert_msg(cm1e_io_find(bus, "fingers.closed", &closed, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_io_find(bus, "valves.output 1", &valve, &diag) == CM1E_OK, "%s", diag.text);
    cycles(bus, 20);
    ck_assert_int_eq(cm1e_io_quality(&closed), CM1E_IO_OFFLINE);
    ck_assert_int_eq(cm1e_io_quality(&valve), CM1E_IO_GOOD);
    simulate(bus, "input 3 1 on");
    attach(bus, GROUP);
    ck_assert_uint_gt(cycles_until_there(bus, ABSENT, GROUP, COMES), 0);
    cycles(bus, 5);
    ck_assert_int_eq(cm1e_io_quality(&closed), CM1E_IO_GOOD);
    ck_assert(cm1e_io_bool(&closed));
    detach(bus, GROUP);
    cycle(bus);
    cycle(bus);
    ck_assert_int_eq(cm1e_io_quality(&closed), CM1E_IO_STALE); /* the last good value stays */
    ck_assert(cm1e_io_bool(&closed));
    for (int n = 0; n < 40; n++)
        good_cycle(bus);
    ck_assert_int_eq(cm1e_io_quality(&closed), CM1E_IO_OFFLINE);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_hot_connect");
    TCase *tests = tcase_create("hot_connect");
    tcase_set_timeout(tests, 60);
    tcase_add_loop_test(tests, absent_at_the_start_then_comes_goes_and_comes_back, 0, KINDS);
    tcase_add_loop_test(tests, there_at_the_start_goes_and_comes_back, 0, KINDS);
    tcase_add_loop_test(tests, leaving_at_every_moment_of_coming, 0, 2 * KINDS);
    tcase_add_loop_test(tests, comes_although_frames_are_lost, 0, 2 * KINDS);
    tcase_add_test(tests, stranger_with_another_product_is_refused_and_named);
    tcase_add_loop_test(tests, stranger_with_another_address_is_refused_and_named, 0, 3);
    tcase_add_loop_test(tests, explicit_device_id_is_asked_for_in_pre_operational_too, 0, 4);
    tcase_add_test(tests, device_that_kept_its_power_is_identified_again);
    tcase_add_loop_test(tests, policy_says_who_brings_it_back, 0, 10);
    tcase_add_loop_test(tests, policy_counts_for_a_slave_that_is_always_there_too, 0, 3);
    tcase_add_test(tests, slave_behind_the_tool_comes_back_with_and_without_it);
    tcase_add_loop_test(tests, others_that_leave_are_noticed, 0, 2 * KINDS);
    tcase_add_loop_test(tests, slave_without_outputs_is_an_error_unless_it_is_optional, 0, 2);
    tcase_add_test(tests, configuration_of_the_tool_stops_nothing);
    tcase_add_test(tests, signals_of_an_absent_slave_have_a_quality);
    suite_add_tcase(suite, tests);
    TCase *sweep = tcase_create("start");
    tcase_set_timeout(sweep, 600);
    tcase_add_loop_test(sweep, leaving_at_every_moment_of_the_start, 0, KINDS);
    suite_add_tcase(suite, sweep);
    return run_suite(suite);
}
