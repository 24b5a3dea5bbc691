/* Signals of any slave: found by name, object and place; read and written in the cycle; what they tell while the slave
 * is away. The simulated terminals have each input wired to the output of its number. */
#include "bus/io_guest.h"
#include "bus_support.h"
#include "cm1e/hot_connect.h"
#include "cm1e/io.h"
#include "sim/esc_chip.h"

enum { MODULE = 1, MOTOR = 2, SECOND = 3, SLAVES = 4, SETTLE = 4, UNPOWERED = 400 /* cycles, at least */ };

/** Simple devices at 1 and 3, motors at 2 and 4. */
static cm1e_bus_t *open_with(cm1e_sim_io_t kind)
{
    sim_config(2);
    config.sim_gaps = kind;
    config.axes[0].address = MOTOR;
    config.axes[1].address = SLAVES;
    return open_bus();
}

static cm1e_bus_t *start_with(cm1e_sim_io_t kind)
{
    cm1e_bus_t *bus = open_with(kind);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    return bus;
}

static cm1e_io_t find(cm1e_bus_t *bus, const char *name)
{
    cm1e_io_t io;
    ck_assert_msg(cm1e_io_find(bus, name, &io, &diag) == CM1E_OK, "%s: %s", name, diag.text);
    return io;
}

/** Each output of a terminal comes back at its input and nowhere else, beside the neighbours' bits. */
START_TEST(each_bit_of_a_terminal_is_its_own)
{
    cm1e_bus_t *bus = start_with(CM1E_SIM_IO_TERMINAL);
    for (unsigned on = 0; on < 16; on++) {
        cm1e_io_t inputs[4], outputs[4];
        for (unsigned bit = 0; bit < 4; bit++) {
            char name[32];
            snprintf(name, sizeof name, "%u.output %u", SECOND, bit + 1);
            outputs[bit] = find(bus, name);
            snprintf(name, sizeof name, "SLAVE %u.INPUT %u", SECOND, bit + 1);
            inputs[bit] = find(bus, name);
            ck_assert_int_eq(cm1e_io_set_bool(&outputs[bit], on >> bit & 1), CM1E_OK);
        }
        cycles(bus, SETTLE);
        for (unsigned bit = 0; bit < 4; bit++) {
            ck_assert_int_eq(cm1e_io_bool(&inputs[bit]), on >> bit & 1);
            ck_assert_int_eq(cm1e_io_bool(&outputs[bit]), on >> bit & 1);
            ck_assert_int_eq(cm1e_io_quality(&inputs[bit]), CM1E_IO_GOOD);
        }
        const cm1e_io_t other = find(bus, "1.input 1"); /* the terminal before the motor has got nothing */
        ck_assert_int_eq(cm1e_io_integer(&other), 0);
    }
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(signals_are_listed_with_name_object_and_type)
{
    cm1e_bus_t *bus = open_with(CM1E_SIM_IO_TERMINAL);
    ck_assert_uint_eq(cm1e_io_count(bus), 0); /* nothing is known yet */
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_io_info_t info;
    unsigned of_terminals = 0, of_axes = 0;
    for (uint32_t n = 0; n < cm1e_io_count(bus); n++) {
        ck_assert(cm1e_io_at(bus, n, &info));
        cm1e_io_t io, by_object;
        char name[96];
        snprintf(name, sizeof name, "%u.%s %u", info.position, info.output ? "output" : "input", info.number);
        ck_assert_msg(cm1e_io_find(bus, name, &io, &diag) == CM1E_OK, "%s: %s", name, diag.text);
        ck_assert_int_eq(cm1e_io_find_object(bus, info.position, info.index, info.subindex, info.output, &by_object,
                                             &diag), CM1E_OK);
        ck_assert_uint_eq(io.byte, by_object.byte);
        ck_assert_uint_eq(io.shift, by_object.shift);
        of_terminals += !info.of_axis;
        of_axes += info.of_axis;
    }
    ck_assert(!cm1e_io_at(bus, cm1e_io_count(bus), &info));
    ck_assert_uint_eq(of_terminals, 2 * 8);
    ck_assert_uint_gt(of_axes, 2 * 4);
    ck_assert(cm1e_io_at(bus, 1, &info)); /* the second input of the first terminal */
    ck_assert_uint_eq(info.position, MODULE);
    ck_assert_uint_eq(info.index, 0x6010);
    ck_assert_int_eq(info.type, CM1E_IO_BOOL);
    ck_assert_uint_eq(info.bit_offset, 1);
    cm1e_bus_close(bus);
}
END_TEST

/** Guests see the same signals in the same order, and the handle of each is of its place. */
START_TEST(guests_see_the_same_signals)
{
    cm1e_bus_t *bus = open_with(CM1E_SIM_IO_TERMINAL);
    cm1e_io_info_t info = {0}, listed;
    ck_assert(!cm1e_io_guest_next(bus, &info)); /* nothing is known yet */
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    info = (cm1e_io_info_t){0};
    uint32_t n = 0;
    for (; cm1e_io_guest_next(bus, &info); n++) {
        cm1e_io_t io;
        ck_assert(cm1e_io_at(bus, n, &listed));
        ck_assert(info.position == listed.position && info.number == listed.number && info.output == listed.output);
        ck_assert_int_eq(cm1e_io_guest_take(bus, &info, &io, &diag), CM1E_OK);
        ck_assert(io.position == info.position && io.bits == info.bits && io.shift == info.bit_offset % 8);
    }
    ck_assert_uint_eq(n, cm1e_io_count(bus));
    cm1e_bus_close(bus);
}
END_TEST

/** A slave that no other has the name of is found by it, at any place. */
START_TEST(the_name_of_the_only_terminal_is_its_own)
{
    sim_config(2);
    config.sim_gaps = CM1E_SIM_IO_TERMINAL;
    config.axes[0].address = (uint16_t)(_i == 1 ? 2 : 1);
    config.axes[1].address = (uint16_t)(_i == 2 ? 3 : 2 + (_i == 1));
    cm1e_bus_t *bus = start_bus();
    ck_assert_uint_eq(cm1e_bus_slave_count(bus), 3);
    const cm1e_io_t output = find(bus, "digital TERMINAL 4+4.output 2");
    ck_assert_uint_eq(output.position, _i);
    cm1e_bus_close(bus);
}
END_TEST

/** The statusword by its object; its controlword cannot be written past the axis. */
START_TEST(signals_of_a_motor_are_read_and_never_written)
{
    cm1e_bus_t *bus = start_with(CM1E_SIM_IO_MODULE);
    cycles(bus, SETTLE);
    const cm1e_io_t status = find(bus, "2.Statusword"), control = find(bus, "2.0x6040:00");
    ck_assert_int_ne(cm1e_io_integer(&status), 0);
    ck_assert_int_eq(cm1e_io_set_integer(&control, 15), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_io_set_bytes(&control, "\017", 2), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_io_set_integer(&status, 0), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_io_integer(&control), 0);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(wrong_names_are_told_what_there_is)
{
    static const struct {
        const char *name, *told;
        cm1e_error_t error;
    } cases[] = {
        {"3.output 9", "Slave 3 has no signal \"output 9\". It has: ", CM1E_ERROR_NOT_FOUND},
        {"3.", "Slave 3 has no signal \"\"", CM1E_ERROR_NOT_FOUND},
        {"9.output 1", "names no slave of the network, which has 4", CM1E_ERROR_NOT_FOUND},
        {"valve", "names no slave", CM1E_ERROR_NOT_FOUND},
        {"", "names no slave", CM1E_ERROR_NOT_FOUND},
        {"Digital terminal 4+4.output 1", "names no slave", CM1E_ERROR_NOT_FOUND}, /* two have this name */
        {"3.Outputs", "has 4 signals with the name \"Outputs\": choose one by its number",
         CM1E_ERROR_INVALID_ARGUMENT},
    };
    cm1e_bus_t *bus = start_with(CM1E_SIM_IO_TERMINAL);
    cm1e_io_t io;
    ck_assert_int_eq(cm1e_io_find(bus, NULL, &io, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_io_find(NULL, "1.input 1", &io, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_io_quality(&io), CM1E_IO_INVALID);
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        ck_assert_int_eq(cm1e_io_find(bus, cases[i].name, &io, &diag), cases[i].error);
        ck_assert_msg(strstr(diag.text, cases[i].told), "%s: %s", cases[i].name, diag.text);
        ck_assert_uint_eq(diag.foreign_code, 0);
        ck_assert_int_eq(cm1e_io_quality(&io), CM1E_IO_INVALID);
        ck_assert_int_eq(cm1e_io_set_bool(&io, true), CM1E_ERROR_STATE);
        ck_assert_int_eq(cm1e_io_integer(&io), 0);
    }
    ck_assert_int_eq(cm1e_io_find_bits(bus, SECOND, true, 0, 1, CM1E_IO_BOOL, &io, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_io_find_bits(bus, SECOND, true, 8, 1, CM1E_IO_BOOL, &io, &diag), CM1E_ERROR_NOT_FOUND);
    ck_assert_int_eq(cm1e_io_find_bits(bus, SECOND, true, UINT32_MAX, 1, CM1E_IO_BOOL, &io, &diag),
                     CM1E_ERROR_NOT_FOUND);
    ck_assert_int_eq(cm1e_io_find_bits(bus, SECOND, true, 0, 2, CM1E_IO_BOOL, &io, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_io_find_bits(bus, SECOND, true, 0, 0, CM1E_IO_UINT, &io, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_io_find_bits(bus, 0, true, 0, 1, CM1E_IO_BOOL, &io, &diag), CM1E_ERROR_NOT_FOUND);
    ck_assert_int_eq(cm1e_io_find_object(bus, SECOND, 0x6041, 0, false, &io, &diag), CM1E_ERROR_NOT_FOUND);
    cm1e_bus_close(bus);
}
END_TEST

/** Without power its last inputs stay and are told as old; when it is back its outputs are set again. */
START_TEST(slave_that_is_away_says_so_and_comes_back_with_its_outputs)
{
    cm1e_bus_t *bus = start_with(CM1E_SIM_IO_TERMINAL);
    const cm1e_io_t output = find(bus, "3.output 2"), input = find(bus, "3.input 2"), near = find(bus, "1.input 1");
    ck_assert_int_eq(cm1e_io_set_bool(&output, true), CM1E_OK);
    cycles(bus, SETTLE);
    ck_assert(cm1e_io_bool(&input));
    simulate(bus, "power-cycle 3");
    bool was_away = false;
    for (unsigned n = 0; n < 3000; n++) {
        cycle(bus);
        const cm1e_io_quality_t quality = cm1e_io_quality(&input);
        was_away = was_away || quality == CM1E_IO_OFFLINE || quality == CM1E_IO_STALE;
        ck_assert_msg(n >= UNPOWERED || cm1e_io_bool(&input), "cycle %u: %s, and its last value is lost", n,
                      cm1e_io_quality_name(quality));
        ck_assert_int_eq(cm1e_io_quality(&near), CM1E_IO_GOOD);
    }
    ck_assert(was_away);
    ck_assert_int_eq(cm1e_io_quality(&input), CM1E_IO_GOOD);
    ck_assert(cm1e_io_bool(&input));
    cm1e_bus_close(bus);
}
END_TEST

/** The outputs of its neighbours in the process image stay, to either side. */
START_TEST(outputs_of_the_neighbours_of_a_lost_terminal_stay)
{
    sim_config(0);
    const char *const names[] = {"first", "second", "third"};
    for (int i = 0; i < 3; i++) {
        cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(&config, names[i]);
        slave->address = (uint16_t)(i + 1);
        slave->sim = (cm1e_sim_slave_config_t){.kind = CM1E_SIM_SLAVE_DIGITAL, .outputs = 8};
    }
    cm1e_bus_t *bus = start_bus();
    cm1e_io_t outputs[3][8];
    for (int i = 0; i < 3; i++)
        for (int n = 0; n < 8; n++) {
            char name[40];
            snprintf(name, sizeof name, "%s.output %d", names[i], n + 1);
            outputs[i][n] = find(bus, name);
            ck_assert_int_eq(cm1e_io_set_bool(&outputs[i][n], true), CM1E_OK);
        }
    cycles(bus, SETTLE);
    static const uint8_t safe_op[] = {CM1E_AL_SAFE_OP, 0};
    ck_assert(cm1e_sim_esc_write(cm1e_sim_segment_slave(segment_of(bus), 2), ESC_AL_CONTROL, safe_op, sizeof safe_op));
    bool were_safe = false;
    for (unsigned n = 0; n < 100; n++) {
        cycle(bus);
        for (int bit = 0; bit < 8; bit++)
            ck_assert(cm1e_io_bool(&outputs[0][bit]) && cm1e_io_bool(&outputs[2][bit]));
        were_safe = were_safe || (!cm1e_io_bool(&outputs[1][0]) && !cm1e_io_bool(&outputs[1][7]));
    }
    ck_assert(were_safe);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(lost_frame_makes_inputs_stale_for_a_cycle)
{
    cm1e_bus_t *bus = start_with(CM1E_SIM_IO_MODULE);
    const cm1e_io_t input = find(bus, "1.input 1");
    cycles(bus, SETTLE);
    ck_assert_int_eq(cm1e_io_quality(&input), CM1E_IO_GOOD);
    cm1e_sim_segment_cut(segment_of(bus), 1, true);
    cycle(bus);
    cycle(bus);
    ck_assert_int_ne(cm1e_io_quality(&input), CM1E_IO_GOOD);
    for (unsigned n = 0; n < 10; n++)
        cycle(bus);
    ck_assert_int_eq(cm1e_io_quality(&input), CM1E_IO_OFFLINE);
    cm1e_sim_segment_cut(segment_of(bus), 1, false);
    for (unsigned n = 0; n < 100; n++)
        cycle(bus);
    ck_assert_int_eq(cm1e_io_quality(&input), CM1E_IO_GOOD);
    cm1e_bus_close(bus);
}
END_TEST

static cm1e_slave_config_t *add_digital(const char *name, uint16_t address, uint8_t inputs, uint8_t outputs)
{
    cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(&config, name);
    slave->sim = (cm1e_sim_slave_config_t){.kind = CM1E_SIM_SLAVE_DIGITAL, .inputs = inputs, .outputs = outputs};
    slave->address = address;
    return slave;
}

enum { NETWORKS = 4, WIDTHS = 4 };
static const uint8_t widths[WIDTHS] = {8, 4, 2, 1};

/** So many inputs, a motor and outputs: (0) with an optional slave that is absent, (1) an optional slave themselves; with
 *  nothing else (2) and with overlapped process data (3), where the outputs lose their power. */
static cm1e_bus_t *start_switches(int network, uint8_t width)
{
    sim_config(1);
    config.axes[0].address = MOTOR;
    config.overlap = network == 3;
    add_digital("switches", 1, width, 0);
    add_digital("valves", 3, 0, 4);
    if (network == 0)
        add_digital("lamp", 4711, 4, 4);
    if (network < 2) {
        cm1e_slave_config_t *optional = &config.slaves[network == 0 ? 2 : 0]; /* not before: the list moves as it grows */
        optional->address = 4711;
        optional->address_kind = CM1E_ADDRESS_ALIAS;
        optional->vendor = 0x000004D8;
        optional->product = 0x00001235;
        optional->optional = true;
        optional->sim_absent = network == 0;
    }
    if (network == 1) {
        config.axes[0].address--;
        config.slaves[1].address--;
    }
    cm1e_bus_t *bus = start_bus();
    if (network > 1)
        simulate(bus, "power-cycle 3 60000");
    for (unsigned n = 0; n < 50; n++)
        cycle(bus);
    return bus;
}

static uint16_t find_switches(cm1e_bus_t *bus, uint8_t width, cm1e_io_t *io)
{
    for (uint16_t position = 1; position <= cm1e_bus_slave_count(bus); position++)
        if (strcmp(cm1e_bus_slave_name(bus, position), "switches") == 0) {
            ck_assert_msg(cm1e_io_find_bits(bus, position, false, 0, width, CM1E_IO_USINT, io, &diag) == CM1E_OK, "%s",
                          diag.text);
            return position;
        }
    return 0;
}

/** By its inputs the bus knows whether a slave takes part: none of their values, and no change of them, means that it does
 *  not. Where another slave is missing, the values of a few inputs may be late. */
START_TEST(every_value_of_the_inputs_is_a_value)
{
    const int network = _i % NETWORKS, changes = 1000, place = network == 1 ? 3 : 1; /* optional ones are the last */
    const uint8_t width = widths[_i / NETWORKS];
    cm1e_bus_t *bus = start_switches(network, width);
    const cm1e_error_t result = network < 2 ? CM1E_OK : CM1E_ERROR_BUS_WORKING_COUNTER;
    unsigned random = 1, stale = 0;
    char line[32];
    cm1e_io_t io, beyond;
    const uint16_t position = find_switches(bus, width, &io);
    ck_assert_uint_gt(position, 0);
    for (int n = 0; n < changes; n++) {
        random = random * 1103515245u + 12345u;
        const int all = (1 << width) - 1, value = n <= all ? all - n : (int)(random >> 16) & all;
        for (int bit = 0; bit < width; bit++) {
            snprintf(line, sizeof line, "input %d %d %s", place, bit + 1, value >> bit & 1 ? "on" : "off");
            simulate(bus, line);
        }
        for (int i = 0; i < 4 + n % 3; i++) { /* a change in any cycle of the markers */
            ck_assert_msg(cycle(bus) == result, "value %02X", value);
            stale += cm1e_io_quality(&io) == CM1E_IO_STALE;
            ck_assert(cm1e_io_quality(&io) == CM1E_IO_GOOD || (network > 1 && cm1e_io_quality(&io) == CM1E_IO_STALE));
        }
        ck_assert_int_eq(cm1e_io_integer(&io), value);
        ck_assert_int_eq(cm1e_io_find_bits(bus, position, false, 0, 8, CM1E_IO_USINT, &beyond, &diag), CM1E_OK);
        ck_assert_int_eq(cm1e_io_integer(&beyond), value); /* of bits that it does not have none is on */
    }
    ck_assert_uint_le(stale, (unsigned)changes);
    cm1e_bus_close(bus);
}
END_TEST

static void add_optional(const char *name, uint16_t alias, uint8_t inputs, uint8_t outputs)
{
    cm1e_slave_config_t *slave = add_digital(name, alias, inputs, outputs);
    slave->address_kind = CM1E_ADDRESS_ALIAS;
    slave->vendor = 0x000004D8;
    slave->product = 0x00001235;
    slave->optional = true;
}

/** Two inputs lose their power for a moment, beside an optional slave with outputs, which may stop to take them, and another one with few
 *  inputs that has left: no cycle takes what is in the place of the inputs then for their value. */
START_TEST(few_inputs_that_are_gone_have_no_value)
{
    sim_config(1);
    config.axes[0].address = MOTOR;
    add_digital("switches", 1, 2, 0)->recover = CM1E_RECOVER_NEVER;
    add_optional("lamp", 4711, 4, 4);
    add_optional("tool", 4712, 2, 0);
    cm1e_bus_t *bus = start_bus();
    const cm1e_io_t input = find(bus, "switches.input 1"), neighbour = find(bus, "switches.input 2");
    cycles(bus, 50);
    simulate(bus, "detach 4");
    for (unsigned n = 0; n < 50 + (unsigned)_i; n++) /* an even and an odd number, for both markers */
        cycle(bus);
    simulate(bus, "power-cycle 1 5"); /* it is in Init then, where it has no inputs */
    for (unsigned n = 0; n < 100; n++) {
        cycle(bus);
        ck_assert_msg(!cm1e_io_bool(&input) && !cm1e_io_bool(&neighbour), "cycle %u", n);
        ck_assert_msg(n < 2 || cm1e_io_quality(&input) != CM1E_IO_GOOD, "cycle %u", n);
    }
    cm1e_bus_close(bus);
}
END_TEST

/** Where places move, a device may have got the address of another one. It gives it back, although it fails before it can
 *  be identified: the other one has no mailbox. */
START_TEST(a_device_with_the_address_of_another_one_gives_it_back)
{
    enum { ANALOG = 3, COMES = 5000 };
    sim_config(1);
    config.axes[0].address = MOTOR;
    add_digital("switches", 1, 8, 0);
    add_digital("levels", ANALOG, 2, 0)->sim.kind = CM1E_SIM_SLAVE_ANALOG;
    add_optional("lamp", 4711, 4, 4);
    config.slaves[2].sim_absent = true;
    cm1e_bus_t *bus = start_bus();
    uint8_t *first = register_memory_of(bus, 1), *other = register_memory_of(bus, ANALOG);
    const uint8_t station[2] = {first[0x10], first[0x11]};
    simulate(bus, "power-cycle 1 20");
    simulate(bus, "power-cycle 3 20");
    for (unsigned n = 0; n < 25; n++)
        cycle(bus);
    memcpy(other + 0x10, station, sizeof station);
    for (unsigned n = 0; n < COMES; n++) {
        cycle(bus);
        if (cm1e_bus_slave_watch(bus, MOTOR).al_state != CM1E_AL_OP)
            cm1e_bus_request_recovery(bus, MOTOR);
    }
    cycles(bus, 100);
    ck_assert_int_eq(memcmp(first + 0x10, station, sizeof station), 0);
    cm1e_bus_close(bus);
}
END_TEST

/** A motor, a terminal that is always needed, and two optional ones: the first is there. */
static cm1e_bus_t *start_beside_optional(uint8_t inputs, cm1e_io_t *io)
{
    sim_config(1);
    config.axes[0].address = 1;
    add_digital("switches", 2, inputs, 0);
    add_optional("lamp 1", 4711, 4, 4);
    add_optional("lamp 2", 4712, 4, 4);
    config.slaves[2].sim_absent = true;
    cm1e_bus_t *bus = start_bus();
    ck_assert_uint_eq(find_switches(bus, inputs, io), 2);
    cycles(bus, 50);
    return bus;
}

/** Also while an optional one comes, whose few inputs may be there or not: at each of these moments. */
START_TEST(few_inputs_of_a_slave_that_is_gone_are_not_good)
{
    bool comes = false;
    for (unsigned moment = 160; moment < 280; moment += 4) {
        cm1e_io_t io;
        cm1e_bus_t *bus = start_beside_optional(widths[_i], &io);
        simulate(bus, "attach 4");
        for (unsigned n = 0; n < moment; n++)
            ck_assert_int_eq(cycle(bus), CM1E_OK);
        comes |= cm1e_bus_presence(bus, 4) == CM1E_PRESENCE_COMING;
        simulate(bus, "detach 2");
        cycle(bus); /* the frame that is on its way */
        for (int n = 0; n < 30; n++) {
            ck_assert_int_eq(cycle(bus), CM1E_ERROR_BUS_WORKING_COUNTER);
            ck_assert_msg(cm1e_io_quality(&io) != CM1E_IO_GOOD, "moment %u: %d", moment, (int)cm1e_io_integer(&io));
        }
        cm1e_bus_close(bus);
    }
    ck_assert(comes);
}
END_TEST

/** Whoever is away makes the working counter wrong, and not those whose few inputs change. */
START_TEST(an_optional_slave_stays_while_another_one_is_away)
{
    char line[32];
    cm1e_io_t io, lamp;
    cm1e_bus_t *bus = start_beside_optional(4, &io);
    ck_assert_int_eq(cm1e_io_find_bits(bus, 3, false, 0, 4, CM1E_IO_USINT, &lamp, &diag), CM1E_OK);
    snprintf(line, sizeof line, "detach %d", _i + 1);
    simulate(bus, line);
    cycle(bus); /* the frame that is on its way */
    unsigned random = 1;
    for (int n = 0; n < 300; n++) {
        random = random * 1103515245u + 12345u;
        for (int bit = 0; bit < 4; bit++) {
            snprintf(line, sizeof line, "input 3 %d %s", bit + 1, random >> (16 + bit) & 1 ? "on" : "off");
            simulate(bus, line);
        }
        for (int i = 0; i < 4 + n % 3; i++) {
            ck_assert_int_eq(cycle(bus), CM1E_ERROR_BUS_WORKING_COUNTER);
            ck_assert_int_eq(cm1e_bus_presence(bus, 3), CM1E_PRESENCE_THERE);
        }
        ck_assert_int_eq(cm1e_io_integer(&lamp), random >> 16 & 15);
    }
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(handle_ends_with_the_start_of_the_bus_that_it_was_found_in)
{
    cm1e_bus_t *bus = start_with(CM1E_SIM_IO_MODULE);
    const cm1e_io_t output = find(bus, "1.output 1");
    cm1e_bus_stop(bus);
    ck_assert_int_ne(cm1e_io_quality(&output), CM1E_IO_GOOD);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_int_eq(cm1e_io_quality(&output), CM1E_IO_INVALID);
    ck_assert_int_eq(cm1e_io_set_integer(&output, 1), CM1E_ERROR_STATE);
    const cm1e_io_t again = find(bus, "1.output 1");
    ck_assert_int_eq(cm1e_io_integer(&again), 0);
    ck_assert_int_eq(cm1e_io_set_integer(&again, 255), CM1E_OK);
    ck_assert_int_eq(cm1e_io_set_integer(&again, 256), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_io_set_integer(&again, -1), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(cm1e_io_integer(&again), 255);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus io");
    TCase *tests = tcase_create("io");
    tcase_set_timeout(tests, 120);
    tcase_add_test(tests, each_bit_of_a_terminal_is_its_own);
    tcase_add_test(tests, signals_are_listed_with_name_object_and_type);
    tcase_add_test(tests, guests_see_the_same_signals);
    tcase_add_loop_test(tests, the_name_of_the_only_terminal_is_its_own, 1, 3);
    tcase_add_test(tests, signals_of_a_motor_are_read_and_never_written);
    tcase_add_test(tests, wrong_names_are_told_what_there_is);
    tcase_add_test(tests, slave_that_is_away_says_so_and_comes_back_with_its_outputs);
    tcase_add_test(tests, outputs_of_the_neighbours_of_a_lost_terminal_stay);
    tcase_add_test(tests, lost_frame_makes_inputs_stale_for_a_cycle);
    tcase_add_loop_test(tests, few_inputs_that_are_gone_have_no_value, 0, 2);
    tcase_add_test(tests, a_device_with_the_address_of_another_one_gives_it_back);
    tcase_add_loop_test(tests, every_value_of_the_inputs_is_a_value, 0, NETWORKS * WIDTHS);
    tcase_add_loop_test(tests, few_inputs_of_a_slave_that_is_gone_are_not_good, 0, WIDTHS);
    tcase_add_loop_test(tests, an_optional_slave_stays_while_another_one_is_away, 0, 2);
    tcase_add_test(tests, handle_ends_with_the_start_of_the_bus_that_it_was_found_in);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
