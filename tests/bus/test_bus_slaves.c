/* Slaves of the configuration beside the axes: found and identified, written and read back, named signals, safe
 * outputs; and all of it again after a slave was away. */
#include "bus_support.h"
#include "cm1e/esc.h"
#include "cm1e/io.h"

enum { COUPLER = 1, VALVES, SWITCHES, ANALOG_IN, ANALOG_OUT, MOTOR, SETTLE = 5, BACK = 3000 };

static cm1e_slave_config_t *add(const char *name, unsigned position, cm1e_sim_slave_kind_t kind, unsigned inputs,
                                unsigned outputs)
{
    cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(&config, name);
    slave->address = (uint16_t)position;
    slave->sim.kind = kind;
    slave->sim.inputs = (uint8_t)inputs;
    slave->sim.outputs = (uint8_t)outputs;
    return slave;
}

static cm1e_signal_config_t *name_bits(unsigned slave, const char *name, bool output, unsigned bit, unsigned bits)
{
    cm1e_slave_config_t *of = &config.slaves[slave - 1];
    cm1e_signal_config_t *signal = &of->signals[of->signal_count++];
    snprintf(signal->name, sizeof signal->name, "%s", name);
    signal->output = output;
    signal->bit = (uint16_t)bit;
    signal->bits = (uint16_t)bits;
    return signal;
}

static cm1e_signal_config_t *name_object(unsigned slave, const char *name, bool output, unsigned index,
                                         unsigned subindex)
{
    cm1e_signal_config_t *signal = name_bits(slave, name, output, 0, 0);
    signal->index = (uint16_t)index;
    signal->subindex = (uint8_t)subindex;
    return signal;
}

static void write_object(unsigned slave, unsigned index, unsigned subindex, int value, bool before_op)
{
    cm1e_slave_config_t *of = &config.slaves[slave - 1];
    of->sdos[of->sdo_count++] = (cm1e_sdo_config_t){
        .index = (uint16_t)index, .subindex = (uint8_t)subindex, .bytes = 2, .before_op = before_op,
        .value = (uint64_t)(int64_t)value};
}

static void map(unsigned slave, unsigned pdo, unsigned index, unsigned subindex, unsigned bits)
{
    cm1e_slave_config_t *of = &config.slaves[slave - 1];
    of->entries[of->entry_count++] = (cm1e_pdo_entry_config_t){(uint16_t)pdo, (uint16_t)index, (uint8_t)subindex,
                                                               (uint8_t)bits};
}

/** A coupler, four valves wired to eight switches, two analog outputs wired to two analog inputs, a motor. */
static void machine(void)
{
    sim_config(1);
    config.axes[0].address = MOTOR;
    add("coupler", COUPLER, CM1E_SIM_SLAVE_COUPLER, 0, 0);
    add("valves", VALVES, CM1E_SIM_SLAVE_DIGITAL, 0, 4);
    add("switches", SWITCHES, CM1E_SIM_SLAVE_DIGITAL, 8, 0);
    add("analog in", ANALOG_IN, CM1E_SIM_SLAVE_ANALOG, 2, 0);
    add("analog out", ANALOG_OUT, CM1E_SIM_SLAVE_ANALOG, 0, 2);
    strcpy(config.slaves[SWITCHES - 1].sim.wired_to, "valves");
    strcpy(config.slaves[ANALOG_IN - 1].sim.wired_to, "analog out");
    name_object(VALVES, "clamp", true, 0x7000, 1);
    name_bits(VALVES, "lamp", true, 1, 1)->safe = 1;
    name_bits(VALVES, "blower", true, 2, 1)->hold = true;
    name_bits(SWITCHES, "curtain", false, 0, 1);
    name_bits(SWITCHES, "upper", false, 4, 4);
}

static cm1e_bus_t *start_machine(void)
{
    cm1e_bus_t *bus = open_bus();
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    return bus;
}

static void expect_refused(cm1e_error_t error, const char *part)
{
    cm1e_bus_t *bus = open_bus();
    ck_assert_int_eq(cm1e_bus_start(bus, &diag), error);
    ck_assert_msg(strstr(diag.text, part), "%s", diag.text);
    cm1e_bus_close(bus);
}

static cm1e_io_t find(cm1e_bus_t *bus, const char *name)
{
    cm1e_io_t io;
    ck_assert_msg(cm1e_io_find(bus, name, &io, &diag) == CM1E_OK, "%s: %s", name, diag.text);
    return io;
}

static int64_t value_of(cm1e_bus_t *bus, const char *name)
{
    const cm1e_io_t io = find(bus, name);
    return cm1e_io_integer(&io);
}

/** Cycles whose frames may be lost. */
static void any_cycles(cm1e_bus_t *bus, unsigned n)
{
    while (n-- > 0)
        cycle(bus);
}

static void set(cm1e_bus_t *bus, const char *name, int64_t value)
{
    const cm1e_io_t io = find(bus, name);
    ck_assert_int_eq(cm1e_io_set_integer(&io, value), CM1E_OK);
}

START_TEST(signals_have_the_names_of_the_configuration)
{
    machine();
    config.slaves[COUPLER - 1].name[0] = '\0';
    cm1e_bus_t *bus = start_machine();
    ck_assert_str_eq(cm1e_bus_slave_name(bus, VALVES), "valves");
    ck_assert_str_eq(cm1e_bus_slave_name(bus, COUPLER), "slave1"); /* it has no name of its own */
    ck_assert_str_eq(cm1e_bus_slave_name(bus, MOTOR), "");
    ck_assert_str_eq(cm1e_bus_slave_name(bus, 99), "");
    for (unsigned on = 0; on < 16; on++) {
        set(bus, "VALVES.Clamp", on & 1);
        set(bus, "valves.lamp", on >> 1 & 1);
        set(bus, "valves.blower", on >> 2 & 1);
        set(bus, "valves.output 4", on >> 3 & 1);
        cycles(bus, SETTLE);
        ck_assert_int_eq(value_of(bus, "switches.curtain"), on & 1);
        ck_assert_int_eq(value_of(bus, "3.input 2"), on >> 1 & 1);
        ck_assert_int_eq(value_of(bus, "switches.0x6020:01"), on >> 2 & 1);
        ck_assert_int_eq(value_of(bus, "switches.input 4"), on >> 3);
        ck_assert_int_eq(value_of(bus, "switches.upper"), 0);
    }
    cm1e_io_info_t info;
    unsigned extra = 0;
    for (uint32_t n = 0; cm1e_io_at(bus, n, &info); n++) /* four bits together are one more than the eight */
        extra += info.position == SWITCHES && info.number == 9 && strcmp(info.name, "upper") == 0;
    ck_assert_uint_eq(extra, 1);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(signal_that_the_slave_does_not_have_is_told)
{
    machine();
    name_object(VALVES, "no object", true, 0x7090, 1);
    expect_refused(CM1E_ERROR_PDO_MAPPING, "\"no object\" is not there: object 0x7090:01 is not among the outputs of "
                                           "slave 2 (\"valves\", Digital terminal 4+0)");
    machine();
    name_bits(SWITCHES, "no bit", false, 7, 2);
    expect_refused(CM1E_ERROR_PDO_MAPPING, "\"no bit\" is not there: it ends with bit 8, and slave 3");
    machine();
    name_object(ANALOG_OUT, "speed", true, 0x7000, 0x11)->safe = 32768;
    expect_refused(CM1E_ERROR_CONFIG, "The safe value 32768 of \"speed\" of slave 5");
    machine();
    cm1e_signal_config_t *signal = name_object(ANALOG_IN, "level", false, 0x6000, 0x11);
    signal->type_stated = true;
    signal->type = CM1E_IO_REAL;
    expect_refused(CM1E_ERROR_PDO_MAPPING, "has 16 bits: it is no REAL");
}
END_TEST

START_TEST(identity_and_address_are_checked)
{
    static const struct {
        cm1e_address_kind_t kind;
        unsigned address, product, revision;
        const char *told; /* NULL: it starts */
        unsigned vendor;
    } cases[] = {
        {CM1E_ADDRESS_POSITION, VALVES, 0xD0400, 1, NULL, 0},
        {CM1E_ADDRESS_POSITION, VALVES, 0xD0401, 0, "expects the product 0x000D0401, the device is \"Digital", 0},
        {CM1E_ADDRESS_POSITION, VALVES, 0xD0400, 2, "expects the revision 0x00000002", 0},
        {CM1E_ADDRESS_POSITION, VALVES, 0xD0400, 1, "expects the vendor 0x00000009", 9},
        {CM1E_ADDRESS_POSITION, 9, 0, 0, "\"valves\": expected a slave at position 9, which is missing", 0},
        {CM1E_ADDRESS_ALIAS, 77, 0, 0, "expected a slave at alias 77", 0},
        {CM1E_ADDRESS_EXPLICIT_ID, 7, 0, 0, "expected a slave at explicit device ID 7", 0},
        {CM1E_ADDRESS_POSITION, 7, 0, 0, "is slave 7, a CM1-E: name it among the axes", 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        machine();
        cm1e_bus_config_t segment = config;
        cm1e_axis_config_t axes[2] = {config.axes[0], config.axes[0]};
        axes[1].address = 7; /* one motor more in the segment */
        segment.axes = axes;
        segment.axis_count = cases[i].address == 7 && cases[i].kind == CM1E_ADDRESS_POSITION ? 2 : 1;
        cm1e_slave_config_t slaves[ANALOG_OUT];
        memcpy(slaves, config.slaves, sizeof slaves);
        segment.slaves = slaves;
        config.slaves[VALVES - 1].address_kind = cases[i].kind;
        config.slaves[VALVES - 1].address = (uint16_t)cases[i].address;
        config.slaves[VALVES - 1].product = cases[i].product;
        config.slaves[VALVES - 1].revision = cases[i].revision;
        if (cases[i].vendor)
            config.slaves[VALVES - 1].vendor = cases[i].vendor;
        cm1e_bus_t *bus = open_bus_on(&segment);
        ck_assert_int_eq(cm1e_bus_start(bus, &diag), cases[i].told ? CM1E_ERROR_BUS_IDENTITY : CM1E_OK);
        ck_assert_msg(!cases[i].told || strstr(diag.text, cases[i].told), "%s", diag.text);
        cm1e_bus_close(bus);
    }
}
END_TEST

START_TEST(slave_is_found_by_alias_and_by_explicit_id)
{
    machine();
    config.slaves[VALVES - 1].address_kind = CM1E_ADDRESS_ALIAS;
    config.slaves[VALVES - 1].address = 1001;
    config.slaves[ANALOG_OUT - 1].address_kind = CM1E_ADDRESS_EXPLICIT_ID;
    config.slaves[ANALOG_OUT - 1].address = 7;
    cm1e_bus_t *bus = start_machine();
    ck_assert_str_eq(cm1e_bus_slave_name(bus, VALVES), "valves");
    set(bus, "analog out.AO Output Channel 2 Value", -77);
    cycles(bus, SETTLE);
    ck_assert_int_eq(value_of(bus, "analog in.AI Standard Channel 2 Value"), -77);
    cm1e_bus_close(bus);
}
END_TEST

/** PDOs in another order, one of them written anew with a gap that moves the others off their bytes; settings. */
static void rearrange(void)
{
    machine();
    cm1e_slave_config_t *analog = &config.slaves[ANALOG_IN - 1];
    map(ANALOG_IN, 0x1A00, 0x6000, 1, 1);
    map(ANALOG_IN, 0x1A00, 0, 0, 2);
    map(ANALOG_IN, 0x1A00, 0x6000, 0x11, 16);
    analog->inputs_pdos[0] = 0x1A03;
    analog->inputs_pdos[1] = 0x1A00;
    analog->inputs_pdo_count = 2;
    name_object(ANALOG_IN, "level", false, 0x6000, 0x11);
    write_object(ANALOG_IN, 0x8000, 0x12, 1000, false);
    write_object(ANALOG_IN, 0x8010, 0x12, -3, true);
}

static void expect_rearranged(cm1e_bus_t *bus)
{
    const cm1e_io_t level = find(bus, "analog in.level"), other = find(bus, "analog in.0x6010:11");
    set(bus, "5.output 1", -1234);
    set(bus, "5.output 2", 31000);
    cycles(bus, SETTLE);
    ck_assert_int_eq(cm1e_io_integer(&level), -234);
    ck_assert_int_eq(cm1e_io_integer(&other), 30997);
    ck_assert_uint_eq(other.shift, 0);
    ck_assert_uint_eq(level.shift, 3);
    set(bus, "5.output 1", -32768);
    set(bus, "5.output 2", 0);
    cycles(bus, SETTLE);
    ck_assert_int_eq(cm1e_io_integer(&level), -31768);
    ck_assert_int_eq(value_of(bus, "analog in.AI Standard Channel 1 Underrange"), 0);
}

START_TEST(what_is_written_at_the_start_is_written_again_after_the_slave_was_away)
{
    rearrange();
    cm1e_bus_t *bus = start_machine();
    expect_rearranged(bus);
    simulate(bus, "power-cycle 4");
    any_cycles(bus, BACK);
    const cm1e_io_t level = find(bus, "analog in.level");
    ck_assert_int_eq(cm1e_io_quality(&level), CM1E_IO_GOOD);
    expect_rearranged(bus);
    cm1e_bus_close(bus);
}
END_TEST

/** The state and value of a channel, and its value alone, exclude each other. We see it in the slave's own objects
 *  before anything is written; a slave that is told so all the same refuses it. */
START_TEST(pdos_that_exclude_each_other_are_refused)
{
    static const uint8_t counts[] = {0, 2};
    static const uint16_t pdos[] = {0x1A00, 0x1A01};
    machine();
    config.slaves[ANALOG_IN - 1].inputs_pdo_count = 2;
    config.slaves[ANALOG_IN - 1].inputs_pdos[0] = 0x1A00;
    config.slaves[ANALOG_IN - 1].inputs_pdos[1] = 0x1A03; /* of another channel */
    cm1e_bus_t *bus = start_machine();
    cm1e_bus_close(bus);
    config.slaves[ANALOG_IN - 1].inputs_pdos[1] = 0x1A01;
    expect_refused(CM1E_ERROR_PDO_MAPPING, "The PDOs 0x1A00 and 0x1A01 of slave 4 (\"analog in\"");
    ck_assert_msg(strstr(diag.text, "exclude each other (object 0x1800:06)") && strstr(diag.text, "inputs_pdos"), "%s",
                  diag.text);
    ck_assert_uint_eq(diag.foreign_code, 0);
    bus = open_bus();
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_sdo_write(bus, ANALOG_IN, 0x1C13, 0, &counts[0], 1, &diag), CM1E_OK);
    for (unsigned i = 0; i < 2; i++)
        ck_assert_int_eq(cm1e_sdo_write(bus, ANALOG_IN, 0x1C13, (uint8_t)(i + 1), &pdos[i], 2, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_sdo_write(bus, ANALOG_IN, 0x1C13, 0, &counts[1], 1, &diag), CM1E_ERROR_SDO_ABORT);
    ck_assert_uint_eq(diag.foreign_code, 0x06040043);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(what_a_slave_refuses_is_told)
{
    rearrange();
    write_object(ANALOG_IN, 0x8020, 0x12, 1, false);
    expect_refused(CM1E_ERROR_SDO_ABORT, "Start-up as the configuration states it: slave 4 (\"analog in\", Analog "
                                         "terminal 0+2) refuses to write object 0x8020:12");
    rearrange();
    map(ANALOG_IN, 0x1A00, 0x6000, 0x11, 8);
    expect_refused(CM1E_ERROR_SDO_ABORT, "refuses to write object 0x1A00:00: SDO abort 0x06040041");
    rearrange();
    config.slaves[ANALOG_IN - 1].inputs_pdos[1] = 0x1A09;
    expect_refused(CM1E_ERROR_SDO_ABORT, "refuses to write object 0x1C13:02");
    rearrange();
    write_object(ANALOG_IN, 0x8000, 0x12, 1, true);
    config.slaves[ANALOG_IN - 1].sdos[2].bytes = 4;
    expect_refused(CM1E_ERROR_SDO_ABORT, "refuses to write object 0x8000:12");
    machine();
    write_object(VALVES, 0x8000, 1, 1, false);
    expect_refused(CM1E_ERROR_BUS_IDENTITY, "Slave 2 (\"valves\", Digital terminal 4+0) has no mailbox for CoE");
}
END_TEST

/** Each message to a mailbox is on its way for 0.9 s: no transfer takes too long, all of them together do. */
static cm1e_tap_verdict_t take_time(void *context, cm1e_tap_frame_t *frame)
{
    enum { COMMAND_AT = 16, OFFSET_AT = 20, FPWR_NUMBER = 5, FIRST_MAILBOX = 0x1000 };
    cm1e_bus_t *bus = context;
    if (frame->direction == CM1E_TAP_SENT && frame->bytes[COMMAND_AT] == FPWR_NUMBER &&
        cm1e_get_u16(frame->bytes + OFFSET_AT) >= FIRST_MAILBOX)
        cm1e_clock_sleep_until(cm1e_bus_clock(bus), now_of(bus) + 900000000);
    return CM1E_TAP_PASS;
}

START_TEST(a_slave_that_tells_its_pdos_slowly_ends_the_start)
{
    sim_config(0);
    add("analog", 1, CM1E_SIM_SLAVE_ANALOG, 8, 8);
    cm1e_bus_t *bus = open_bus();
    ck_assert(cm1e_bus_scan(bus, &diag) == CM1E_OK && cm1e_bus_identify(bus, &diag) == CM1E_OK);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), take_time, bus);
    const int64_t begun_ns = now_of(bus);
    ck_assert_int_eq(cm1e_bus_configure(bus, &diag), CM1E_ERROR_TIMEOUT);
    ck_assert_str_eq(diag.text, "A slave takes too long to report its PDO mapping.");
    ck_assert_uint_eq(diag.foreign_code, 0);
    ck_assert_int_lt(now_of(bus) - begun_ns, INT64_C(62000000000));
    cm1e_nic_set_tap(cm1e_bus_nic(bus), NULL, NULL);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_bus_close(bus);
}
END_TEST

/** What the switches see of the valves: lamp has the safe value 1, blower keeps its value, the others have 0. */
enum { LAMP = 2, BLOWER = 4, ALL = 15 };

static unsigned switches(cm1e_bus_t *bus)
{
    cm1e_io_t io;
    ck_assert_int_eq(cm1e_io_find_bits(bus, SWITCHES, false, 0, 4, CM1E_IO_USINT, &io, &diag), CM1E_OK);
    return (unsigned)cm1e_io_integer(&io);
}

static cm1e_io_t all_valves(cm1e_bus_t *bus)
{
    cm1e_io_t io;
    ck_assert_int_eq(cm1e_io_find_bits(bus, VALVES, true, 0, 4, CM1E_IO_USINT, &io, &diag), CM1E_OK);
    return io;
}

START_TEST(outputs_are_safe_before_the_program_and_after_it)
{
    machine();
    cm1e_bus_t *bus = start_machine();
    cycles(bus, SETTLE);
    ck_assert_uint_eq(switches(bus), LAMP);
    const cm1e_io_t valves = all_valves(bus);
    ck_assert_int_eq(cm1e_io_set_integer(&valves, ALL & ~LAMP), CM1E_OK);
    cycles(bus, SETTLE);
    ck_assert_uint_eq(switches(bus), ALL & ~LAMP);
    cm1e_bus_release_outputs(bus);
    for (int n = 0; n < SETTLE; n++) {
        cm1e_io_set_integer(&valves, ALL); /* too late */
        cycle(bus);
    }
    ck_assert_uint_eq(switches(bus), LAMP | BLOWER);
    cm1e_bus_close(bus);
}
END_TEST

/** Each bit of several bytes has its own safe value, or keeps its value; the neighbours' are not touched. */
START_TEST(every_bit_has_its_own_safe_value)
{
    static const uint8_t safe[3] = {0xB2, 0x4D, 0xF0}, held[3] = {0x0F, 0xAA, 0x3C}, written[3] = {0x69, 0xD3, 0x95};
    cm1e_io_t bytes[3], last;
    sim_config(0);
    for (unsigned i = 0; i < 3; i++) {
        add("valves", i + 1, CM1E_SIM_SLAVE_DIGITAL, 0, 8)->name[0] = (char)('a' + i);
        for (unsigned bit = 0; bit < 8; bit++) {
            char name[16];
            snprintf(name, sizeof name, "bit %u", bit);
            cm1e_signal_config_t *signal = name_bits(i + 1, name, true, bit, 1);
            signal->hold = held[i] >> bit & 1;
            signal->safe = signal->hold ? 0 : safe[i] >> bit & 1;
        }
    }
    add("last", 4, CM1E_SIM_SLAVE_DIGITAL, 0, 8); /* whose other bits have no name, so they are 0 when they are safe */
    cm1e_signal_config_t *first = name_bits(4, "first", true, 0, 1);
    first->hold = _i == 0;
    first->safe = _i;
    cm1e_bus_t *bus = start_bus();
    ck_assert_int_eq(cm1e_io_find_bits(bus, 4, true, 0, 8, CM1E_IO_USINT, &last, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_io_set_integer(&last, 0xFF), CM1E_OK);
    for (unsigned i = 0; i < 3; i++) {
        ck_assert_int_eq(cm1e_io_find_bits(bus, (uint16_t)(i + 1), true, 0, 8, CM1E_IO_USINT, &bytes[i], &diag), CM1E_OK);
        ck_assert_int_eq(cm1e_io_integer(&bytes[i]), safe[i] & ~held[i]);
        ck_assert_int_eq(cm1e_io_set_integer(&bytes[i], written[i]), CM1E_OK);
    }
    cycles(bus, SETTLE);
    cm1e_bus_release_outputs(bus);
    cycles(bus, SETTLE);
    for (unsigned i = 0; i < 3; i++)
        ck_assert_int_eq(cm1e_io_integer(&bytes[i]), (safe[i] & ~held[i]) | (written[i] & held[i]));
    ck_assert_int_eq(cm1e_io_integer(&last), 1);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(outputs_are_safe_after_the_bus_was_lost)
{
    machine();
    cm1e_bus_t *bus = start_machine();
    const cm1e_io_t valves = all_valves(bus);
    ck_assert_int_eq(cm1e_io_set_integer(&valves, ALL & ~LAMP), CM1E_OK);
    cycles(bus, SETTLE);
    simulate(bus, "lose 2"); /* fewer than the limit: nothing happens */
    any_cycles(bus, SETTLE);
    ck_assert_uint_eq(switches(bus), ALL & ~LAMP);
    simulate(bus, "lose 20");
    any_cycles(bus, 40);
    ck_assert_uint_eq(switches(bus), LAMP | BLOWER);
    ck_assert_int_eq(cm1e_io_integer(&valves), LAMP | BLOWER);
    cm1e_bus_close(bus);
}
END_TEST

/** Slaves behind the one without power are away too. */
START_TEST(outputs_of_a_slave_that_was_away_are_safe_and_those_of_others_stay)
{
    machine();
    name_object(ANALOG_OUT, "speed", true, 0x7000, 0x11)->safe = -9;
    cm1e_bus_t *bus = start_machine();
    const cm1e_io_t valves = all_valves(bus), speed = find(bus, "analog out.speed");
    ck_assert_int_eq(cm1e_io_set_integer(&valves, ALL & ~LAMP), CM1E_OK);
    ck_assert_int_eq(cm1e_io_set_integer(&speed, 500), CM1E_OK);
    cycles(bus, SETTLE);
    ck_assert_int_eq(value_of(bus, "analog in.input 3"), 500);
    simulate(bus, "power-cycle 5");
    for (unsigned n = 0; n < BACK; n++) {
        cycle(bus);
        ck_assert_uint_eq(switches(bus), ALL & ~LAMP);
    }
    ck_assert_int_eq(cm1e_io_quality(&speed), CM1E_IO_GOOD);
    ck_assert_int_eq(cm1e_io_integer(&speed), -9);
    ck_assert_int_eq(value_of(bus, "analog in.input 3"), -9);
    ck_assert_int_eq(cm1e_io_set_integer(&speed, 501), CM1E_OK);
    cycles(bus, SETTLE);
    ck_assert_int_eq(value_of(bus, "analog in.input 3"), 501);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(console_holds_an_input_until_it_is_wired_again)
{
    static const char *const wrong[] = {"input 3 9 on", "input 3 0 on", "input 3 1 2", "input 2 1 on",
                                        "input 4 1 40000"};
    char answer[200];
    machine();
    cm1e_bus_t *bus = start_machine();
    set(bus, "valves.clamp", 0);
    simulate(bus, "input 3 1 on");
    simulate(bus, "input 4 2 -77");
    cycles(bus, SETTLE);
    ck_assert_int_eq(value_of(bus, "switches.curtain"), 1);
    ck_assert_int_eq(value_of(bus, "analog in.AI Standard Channel 2 Value"), -77);
    set(bus, "valves.clamp", 1);
    simulate(bus, "input 3 1 off");
    cycles(bus, SETTLE);
    ck_assert_int_eq(value_of(bus, "switches.curtain"), 0);
    simulate(bus, "input 3 1 wire");
    simulate(bus, "input 4 2 wire");
    cycles(bus, SETTLE);
    ck_assert_int_eq(value_of(bus, "switches.curtain"), 1);
    ck_assert_int_eq(value_of(bus, "analog in.AI Standard Channel 2 Value"), 0);
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        ck_assert_int_eq(cm1e_bus_simulate(bus, wrong[i], answer, sizeof answer), CM1E_ERROR_INVALID_ARGUMENT);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(watchdog_has_the_time_of_the_configuration)
{
    machine();
    config.slaves[VALVES - 1].watchdog_ms = 20;
    cm1e_bus_t *bus = open_bus();
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_bus_identify(bus, &diag), CM1E_OK);
    ck_assert_msg(cm1e_bus_configure(bus, &diag) == CM1E_OK, "%s", diag.text);
    uint8_t time[2];
    ck_assert_int_eq(cm1e_esc_read(bus, VALVES, 0x0420, time, sizeof time, &diag), CM1E_OK);
    ck_assert_uint_eq(cm1e_get_u16(time), 200);
    ck_assert_int_eq(cm1e_esc_read(bus, SWITCHES, 0x0420, time, sizeof time, &diag), CM1E_OK);
    ck_assert_uint_eq(cm1e_get_u16(time), 1000);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus slaves");
    TCase *tests = tcase_create("slaves");
    tcase_set_timeout(tests, 120);
    tcase_add_test(tests, signals_have_the_names_of_the_configuration);
    tcase_add_test(tests, signal_that_the_slave_does_not_have_is_told);
    tcase_add_test(tests, identity_and_address_are_checked);
    tcase_add_test(tests, slave_is_found_by_alias_and_by_explicit_id);
    tcase_add_test(tests, what_is_written_at_the_start_is_written_again_after_the_slave_was_away);
    tcase_add_test(tests, pdos_that_exclude_each_other_are_refused);
    tcase_add_test(tests, what_a_slave_refuses_is_told);
    tcase_add_test(tests, a_slave_that_tells_its_pdos_slowly_ends_the_start);
    tcase_add_test(tests, outputs_are_safe_before_the_program_and_after_it);
    tcase_add_loop_test(tests, every_bit_has_its_own_safe_value, 0, 2);
    tcase_add_test(tests, outputs_are_safe_after_the_bus_was_lost);
    tcase_add_test(tests, outputs_of_a_slave_that_was_away_are_safe_and_those_of_others_stay);
    tcase_add_test(tests, console_holds_an_input_until_it_is_wired_again);
    tcase_add_test(tests, watchdog_has_the_time_of_the_configuration);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
