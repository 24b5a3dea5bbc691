/* Optional slaves of every kind: absent at the start, coming, leaving and coming back at every moment, while the others
 * run and lose no cycle; strangers; who brings a slave back. */
#include "bus_support.h"
#include "cm1e/hot_connect.h"
#include "cm1e/io.h"
#include "effort.h"
#include "sim/esc.h"
#include "sim/segment.h"

/** On the wire: a motor, the optional slave or the group, inputs and outputs, a motor. */
enum { FIRST = 1, TOOL = 2, MEMBER = 3, ABSENT = 4 /* position of the first that is planned: behind the others */ };
enum { ID = 7, ALIAS = 4711, COMES = 4000 };

typedef enum kind { MOTOR, DIGITAL, OUTPUTS_ONLY, GROUP, ANALOG, DRIVE, BRIDGE, KINDS } kind_t;

static unsigned slaves_of(kind_t kind) { return kind == GROUP ? 2 : 1; }
static bool has_axis(kind_t kind) { return kind == MOTOR || kind == DRIVE || kind == BRIDGE; }

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
        : kind == ANALOG       ? add_slave(to, "tool", CM1E_SIM_SLAVE_ANALOG, 2, 2)
                               : add_slave(to, "tool", CM1E_SIM_SLAVE_COUPLER, 0, 0);
    slave->address_kind = kind == ANALOG ? CM1E_ADDRESS_EXPLICIT_ID : CM1E_ADDRESS_ALIAS;
    slave->address = kind == ANALOG ? ID : ALIAS;
    slave->optional = true;
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
    cm1e_bus_t *bus = start_machine(kind, false);
    const uint16_t position = position_of(bus, false);
    ck_assert_uint_eq(cm1e_bus_slave_count(bus), 3 + slaves_of(kind));
    for (int n = 0; n < 200; n++)
        good_cycle(bus);
    ck_assert_int_eq(cm1e_bus_presence(bus, position), CM1E_PRESENCE_ABSENT);
    for (int round = 0; round < 2; round++) {
        attach(bus, kind);
        ck_assert_msg(cycles_until_there(bus, position, kind, COMES) > 0, "kind %d round %d: %s", kind, round,
                      how(bus, position));
        for (unsigned i = 0; i < slaves_of(kind); i++)
            ck_assert_uint_eq(state_of(bus, TOOL + i), CM1E_AL_OP);
        for (int n = 0; n < 100; n++)
            good_cycle(bus);
        detach(bus, kind);
        cycle(bus); /* the frame that is on its way when the plug is pulled */
        for (int n = 0; n < 300; n++)
            good_cycle(bus);
        ck_assert_int_eq(cm1e_bus_presence(bus, position), CM1E_PRESENCE_ABSENT);
    }
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(there_at_the_start_goes_and_comes_back)
{
    const kind_t kind = (kind_t)_i;
    cm1e_bus_t *bus = start_machine(kind, true);
    const uint16_t position = position_of(bus, true);
    ck_assert(is_there(bus, position, slaves_of(kind)));
    for (int n = 0; n < 100; n++)
        good_cycle(bus);
    detach(bus, kind);
    cycle(bus);
    for (int n = 0; n < 300; n++)
        good_cycle(bus);
    attach(bus, kind);
    ck_assert_msg(cycles_until_there(bus, position, kind, COMES) > 0, "kind %d: %s", kind, how(bus, position));
    for (int n = 0; n < 100; n++)
        good_cycle(bus);
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
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
