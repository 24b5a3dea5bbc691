/* What an optional slave that is absent at the start needs in the configuration, because nothing can be read of it: where
 * it is missing, the start is refused in words, and with the slave plugged in it succeeds. */
#include "bus_support.h"
#include "cm1e/hot_connect.h"
#include "cm1e/io.h"
#include "sim/segment.h"

enum { ALIAS = 4711, TOOL = 2 };

static cm1e_bus_config_t wire;

/** The same network twice: a motor, and an optional analog device with two inputs and outputs. */
static void describe(cm1e_bus_config_t *to)
{
    cm1e_bus_config_free(to);
    cm1e_bus_config_init(to, "sim", 1);
    to->virtual_time = true;
    to->sim_pdo_order = tested_order();
    snprintf(to->axes[0].firmware, sizeof to->axes[0].firmware, "%s", tested_firmware());
    cm1e_slave_config_t *tool = cm1e_bus_config_add_slave(to, "tool");
    tool->sim = (cm1e_sim_slave_config_t){.kind = CM1E_SIM_SLAVE_ANALOG, .inputs = 2, .outputs = 2};
    tool->vendor = 0x000004D8;
    tool->product = 0x00001234;
    tool->address_kind = CM1E_ADDRESS_ALIAS;
    tool->address = ALIAS;
    tool->optional = true;
}

static void has_pulses(void) { config.slaves[0].dc.sync0_us = 1000; }

static void add_signal(bool output)
{
    cm1e_signal_config_t *signal = &config.slaves[0].signals[config.slaves[0].signal_count++];
    snprintf(signal->name, sizeof signal->name, "level");
    signal->output = output;
    signal->index = output ? 0x7000 : 0x6000;
    signal->subindex = 0x11;
}

static void names_an_input(void) { add_signal(false); }
static void names_an_output(void) { add_signal(true); }

/** Which entries they have is not stated. */
static void assigns_pdos(void)
{
    config.slaves[0].inputs_pdo_count = 1;
    config.slaves[0].inputs_pdos[0] = 0x1A00;
    add_signal(false);
}

static const struct {
    void (*change)(void);
    cm1e_error_t error;
    const char *words;
} cases[] = {
    {has_pulses, CM1E_ERROR_CONFIG, "is absent, and it has dc: its clock is set up only at the start. Start with the slave "
     "plugged in."},
    {names_an_input, CM1E_ERROR_PDO_MAPPING, "is absent, so where its object 0x6000:11 will be is not known (signal "
     "\"level\"): state its bit, or inputs_pdos and mapping, or start with the slave plugged in."},
    {names_an_output, CM1E_ERROR_PDO_MAPPING, "is absent, so where its object 0x7000:11 will be is not known (signal "
     "\"level\"): state its bit, or outputs_pdos and mapping, or start with the slave plugged in."},
    {assigns_pdos, CM1E_ERROR_PDO_MAPPING, "is absent, so where its object 0x6000:11 will be is not known (signal "
     "\"level\"): state its bit, or inputs_pdos and mapping, or start with the slave plugged in."},
};

START_TEST(what_is_not_known_of_an_absent_slave_is_said)
{
    describe(&config);
    describe(&wire);
    cases[_i].change();
    cm1e_bus_t *bus = open_bus_on(&wire);
    cm1e_sim_segment_detach(segment_of(bus), TOOL, true);
    ck_assert_int_eq(cm1e_bus_start(bus, &diag), cases[_i].error);
    ck_assert_msg(strstr(diag.text, "\"tool\"") && strstr(diag.text, cases[_i].words), "%s", diag.text);
    ck_assert_uint_eq(cm1e_sim_slave_al_state(cm1e_sim_segment_slave(segment_of(bus), 1)), CM1E_AL_INIT);
    cm1e_sim_segment_attach(segment_of(bus), TOOL);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_int_eq(cm1e_bus_presence(bus, TOOL), CM1E_PRESENCE_THERE);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&wire);
}
END_TEST

/** The network has as many as a bus may have, and the optional one would be one more. */
START_TEST(more_slaves_than_a_bus_may_have_are_refused_in_words)
{
    describe(&config);
    describe(&wire);
    config.axes[0].address = wire.axes[0].address = CM1E_MAX_SLAVES;
    wire.slave_count = 0;
    wire.sim_gaps = CM1E_SIM_IO_COUPLER;
    cm1e_bus_t *bus = open_bus_on(&wire);
    const cm1e_error_t error = cm1e_bus_start(bus, &diag);
    ck_assert_int_eq(error, CM1E_ERROR_BUS_IDENTITY);
    ck_assert_int_eq(diag.error, error);
    ck_assert_str_eq(diag.text, "Together with the optional slaves that are absent there are more than 512 slaves.");
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&wire);
}
END_TEST

enum { SPARE = 1, MOTOR = 2, HEAD = 3, MEMBER = 4 };

static cm1e_slave_config_t *add_fingers(cm1e_bus_config_t *to, const char *name, uint16_t address)
{
    cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(to, name);
    slave->sim = (cm1e_sim_slave_config_t){.kind = CM1E_SIM_SLAVE_DIGITAL, .inputs = 2, .outputs = 3};
    slave->vendor = 0x000004D8;
    slave->product = 0x00001235;
    slave->address = address;
    return slave;
}

/** A motor, and an optional group of a coupler and a device. On the wire the same device is before the motor, too. */
static void describe_group(cm1e_bus_config_t *to, bool on_the_wire)
{
    describe(to);
    to->axes[0].address = MOTOR;
    to->slaves[0].sim = (cm1e_sim_slave_config_t){.kind = CM1E_SIM_SLAVE_COUPLER};
    snprintf(to->slaves[0].hot_connect, sizeof to->slaves[0].hot_connect, "gripper");
    cm1e_slave_config_t *fingers = add_fingers(to, "fingers", on_the_wire ? MEMBER : 2);
    if (on_the_wire)
        (void)add_fingers(to, "spare", SPARE);
    else
        snprintf(fingers->hot_connect, sizeof fingers->hot_connect, "gripper");
}

/** Slave 1 is the device of a member, and no entry of the configuration has it. */
START_TEST(a_slave_elsewhere_is_not_the_member_of_an_absent_group)
{
    describe_group(&config, false);
    describe_group(&wire, true);
    cm1e_bus_t *bus = open_bus_on(&wire);
    for (uint32_t position = HEAD; position <= MEMBER; position++)
        cm1e_sim_segment_detach(segment_of(bus), position, false);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_str_eq(cm1e_bus_slave_name(bus, SPARE), "");
    ck_assert_str_eq(cm1e_bus_slave_name(bus, MEMBER), "fingers");
    ck_assert_int_ne(cm1e_bus_presence(bus, MEMBER), CM1E_PRESENCE_THERE);
    for (uint32_t position = HEAD; position <= MEMBER; position++)
        cm1e_sim_segment_attach(segment_of(bus), position);
    for (int n = 0; n < 4000 && cm1e_bus_presence(bus, MEMBER) != CM1E_PRESENCE_THERE; n++)
        cycles(bus, 1);
    ck_assert_int_eq(cm1e_bus_presence(bus, MEMBER), CM1E_PRESENCE_THERE);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&wire);
}
END_TEST

/** There is nobody in front of its head. */
START_TEST(a_group_that_is_the_first_on_the_wire_comes_back)
{
    enum { FIRST = 1, SECOND = 2 };
    describe_group(&config, false);
    describe_group(&wire, true);
    config.axes[0].address = 1; /* optional slaves do not count */
    wire.axes[0].address = 3;
    wire.slaves[1].address = SECOND;
    wire.slave_count = 2;
    cm1e_bus_t *bus = open_bus_on(&wire);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_str_eq(cm1e_bus_slave_name(bus, FIRST), "tool");
    ck_assert_str_eq(cm1e_bus_slave_name(bus, SECOND), "fingers");
    cycles(bus, 50);
    for (int round = 0; round < 2; round++) {
        for (uint32_t position = FIRST; position <= SECOND; position++)
            cm1e_sim_segment_detach(segment_of(bus), position, false);
        for (int n = 0; n < 300; n++)
            cycle(bus);
        ck_assert_int_eq(cm1e_bus_presence(bus, SECOND), CM1E_PRESENCE_ABSENT);
        for (uint32_t position = FIRST; position <= SECOND; position++)
            cm1e_sim_segment_attach(segment_of(bus), position);
        for (int n = 0; n < 4000 && cm1e_bus_presence(bus, SECOND) != CM1E_PRESENCE_THERE; n++)
            cycle(bus);
        ck_assert_int_eq(cm1e_bus_presence(bus, FIRST), CM1E_PRESENCE_THERE);
        ck_assert_int_eq(cm1e_bus_presence(bus, SECOND), CM1E_PRESENCE_THERE);
    }
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&wire);
}
END_TEST

/** Of a slave that is not optional, and of one that there is not. */
START_TEST(a_slave_that_does_not_answer_is_named)
{
    enum { LOST = 2, NONE = 3 };
    char text[CM1E_PRESENCE_TEXT];
    sim_config(2);
    cm1e_bus_t *bus = start_bus();
    cycles(bus, 20);
    simulate(bus, "power-cycle 2 60000");
    for (int n = 0; n < 100; n++)
        cycle(bus);
    ck_assert_int_eq(cm1e_bus_presence(bus, LOST), CM1E_PRESENCE_ABSENT);
    cm1e_bus_presence_text(bus, LOST, text, sizeof text);
    ck_assert_str_eq(text, "Slave 2 (\"axis2\", CM1-E) does not answer: check its power and the cables up to it.");
    ck_assert_int_eq(cm1e_bus_recover(bus, LOST, &diag), CM1E_ERROR_STATE);
    ck_assert_str_eq(diag.text, text);
    ck_assert_int_eq(cm1e_bus_presence(bus, NONE), CM1E_PRESENCE_ABSENT);
    cm1e_bus_presence_text(bus, NONE, text, sizeof text);
    ck_assert_str_eq(text, "");
    ck_assert_int_eq(cm1e_bus_recover(bus, NONE, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_str_eq(diag.text, "There is no slave 3.");
    ck_assert(cm1e_bus_slave_watch(bus, 0).lost && cm1e_bus_slave_watch(bus, NONE).lost);
    cm1e_bus_close(bus);
}
END_TEST

/** A motor may come with another order of its objects than was planned. A handle of the planned place does not show what
 *  is there instead. */
START_TEST(signals_of_a_motor_that_comes_are_found_where_it_has_them)
{
    static const char *const names[] = {"2.0x6041:00", "2.0x6064:00", "2.0x60FD:00", "2.0x607A:00"};
    enum { NAMES = sizeof names / sizeof names[0], COMES = 4000 };
    sim_config(2);
    config.axes[1].address_kind = CM1E_ADDRESS_ALIAS;
    config.axes[1].address = ALIAS;
    config.axes[1].optional = config.axes[1].sim_absent = true;
    cm1e_bus_t *bus = start_bus();
    cm1e_io_t before[NAMES], after;
    unsigned invalid = 0, n = 0;
    for (int i = 0; i < NAMES; i++)
        ck_assert_msg(cm1e_io_find(bus, names[i], &before[i], &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_int_eq(cm1e_io_quality(&before[0]), CM1E_IO_OFFLINE);
    simulate(bus, "attach 2");
    for (; cm1e_bus_presence(bus, 2) != CM1E_PRESENCE_THERE && n < COMES; n++) {
        cycles(bus, 1);
        if (cm1e_bus_presence(bus, 2) == CM1E_PRESENCE_WAITS)
            ck_assert_int_eq(cm1e_bus_recover(bus, 2, &diag), CM1E_OK);
    }
    ck_assert_uint_lt(n, COMES);
    cycles(bus, 5);
    for (int i = 0; i < NAMES; i++) {
        ck_assert_msg(cm1e_io_find(bus, names[i], &after, &diag) == CM1E_OK, "%s", diag.text);
        ck_assert_int_eq(cm1e_io_quality(&after), CM1E_IO_GOOD);
        const bool valid = cm1e_io_quality(&before[i]) == CM1E_IO_GOOD;
        ck_assert_int_eq(cm1e_io_integer(&before[i]), valid ? cm1e_io_integer(&after) : 0);
        ck_assert(valid || cm1e_io_quality(&before[i]) == CM1E_IO_INVALID);
        invalid += !valid;
    }
    ck_assert_uint_eq(invalid, tested_order() == CM1E_PDO_ORDER_UG_7_2 ? NAMES : 0);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_hot_planned");
    TCase *tests = tcase_create("planned");
    tcase_set_timeout(tests, 60);
    tcase_add_loop_test(tests, what_is_not_known_of_an_absent_slave_is_said, 0, sizeof cases / sizeof cases[0]);
    tcase_add_test(tests, a_slave_that_does_not_answer_is_named);
    tcase_add_test(tests, more_slaves_than_a_bus_may_have_are_refused_in_words);
    tcase_add_test(tests, a_group_that_is_the_first_on_the_wire_comes_back);
    tcase_add_test(tests, a_slave_elsewhere_is_not_the_member_of_an_absent_group);
    tcase_add_test(tests, signals_of_a_motor_that_comes_are_found_where_it_has_them);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
