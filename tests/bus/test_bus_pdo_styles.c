/* Process data as makers arrange them: inputs on sync manager 2 and outputs on 3, padding inside of PDOs and behind
 * their last entry, counters of an encoder terminal, devices with modules. */
#include "bus_support.h"
#include "description/sii_image.h"
#include "sim/esc_chip.h"
#include "cm1e/hot_connect.h"
#include "cm1e/io.h"
#include "sim/segment.h"

enum { FIRST = 1, SECOND = 2, SETTLE = 4, ALIAS = 77 };

static cm1e_slave_config_t *add(const char *name, uint16_t position, cm1e_sim_slave_kind_t kind, unsigned inputs,
                                unsigned outputs)
{
    cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(&config, name);
    slave->address = position;
    slave->sim.kind = kind;
    slave->sim.inputs = (uint8_t)inputs;
    slave->sim.outputs = (uint8_t)outputs;
    return slave;
}

static cm1e_bus_t *start(void)
{
    cm1e_bus_t *bus = open_bus();
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    return bus;
}

static cm1e_io_t find(cm1e_bus_t *bus, const char *name)
{
    cm1e_io_t io;
    ck_assert_msg(cm1e_io_find(bus, name, &io, &diag) == CM1E_OK, "%s: %s", name, diag.text);
    return io;
}

/** Outputs are wired to the inputs of the same device: what is set comes back, each at its place. */
static void expect_both_channels(cm1e_bus_t *bus)
{
    const char *const outputs[] = {"both.output 1", "both.output 2"};
    const char *const objects[] = {"both.0x6000:11", "both.0x6010:11"};
    for (int n = 0; n < 2; n++) {
        const cm1e_io_t io = find(bus, outputs[n]);
        ck_assert_int_eq(cm1e_io_set_integer(&io, 1000 * n - 300), CM1E_OK);
    }
    cycles(bus, SETTLE);
    for (int n = 0; n < 2; n++) {
        const cm1e_io_t io = find(bus, objects[n]);
        ck_assert_int_eq(cm1e_io_quality(&io), CM1E_IO_GOOD);
        ck_assert_int_eq(cm1e_io_integer(&io), 1000 * n - 300);
    }
    ck_assert_uint_eq(cm1e_bus_counters(bus)->working_counter_errors, 0);
}

static void describe_swapped(void)
{
    sim_config(0);
    add("both", FIRST, CM1E_SIM_SLAVE_ANALOG, 2, 2)->sim.swapped = true;
    add("plain", SECOND, CM1E_SIM_SLAVE_ANALOG, 2, 2);
}

START_TEST(inputs_may_be_on_sync_manager_2)
{
    describe_swapped();
    cm1e_bus_t *bus = start();
    expect_both_channels(bus);
    cm1e_bus_close(bus);
}
END_TEST

/** 0x1C12 assigns the inputs of such a device, 0x1C13 its outputs. */
START_TEST(pdos_of_swapped_sync_managers_are_assigned_by_the_other_object)
{
    uint8_t pdos[2][2] = {{0}};
    describe_swapped();
    cm1e_slave_config_t *slave = &config.slaves[0];
    slave->inputs_pdos[0] = 0x1A01;
    slave->inputs_pdos[1] = 0x1A03;
    slave->inputs_pdo_count = 2;
    slave->outputs_pdos[0] = 0x1601;
    slave->outputs_pdos[1] = 0x1600;
    slave->outputs_pdo_count = 2;
    cm1e_bus_t *bus = open_bus();
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    for (unsigned n = 0; n < 2; n++) {
        size_t size = 2;
        ck_assert_int_eq(cm1e_sdo_read(bus, FIRST, (uint16_t)(0x1C12 + n), 1, pdos[n], &size, &diag), CM1E_OK);
    }
    ck_assert_uint_eq(pdos[0][0] | pdos[0][1] << 8, 0x1A01);
    ck_assert_uint_eq(pdos[1][0] | pdos[1][1] << 8, 0x1601);
    ck_assert_uint_eq(cm1e_bus_slave(bus, FIRST)->input_bytes, 4);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(swapped_sync_managers_are_written_again_after_the_slave_was_away)
{
    describe_swapped();
    cm1e_bus_t *bus = start();
    simulate(bus, "power-cycle 1 100");
    for (int n = 0; n < 3000; n++)
        cycle(bus);
    ck_assert_int_eq(cm1e_bus_presence(bus, FIRST), CM1E_PRESENCE_THERE);
    const cm1e_io_t io = find(bus, "both.output 1");
    ck_assert_int_eq(cm1e_io_set_integer(&io, 77), CM1E_OK);
    cycles(bus, SETTLE);
    const cm1e_io_t back = find(bus, "both.0x6000:11");
    ck_assert_int_eq(cm1e_io_quality(&back), CM1E_IO_GOOD);
    ck_assert_int_eq(cm1e_io_integer(&back), 77);
    cm1e_bus_close(bus);
}
END_TEST

/** It was never seen before it comes: its sync managers are known by the search only. */
START_TEST(swapped_sync_managers_of_a_slave_that_comes_later)
{
    describe_swapped();
    cm1e_slave_config_t *slave = &config.slaves[0];
    slave->address_kind = CM1E_ADDRESS_ALIAS;
    slave->address = ALIAS;
    slave->vendor = 0x4D8;
    slave->product = 0x5A0202;
    slave->optional = true;
    slave->sim_absent = true;
    slave->signals[0] = (cm1e_signal_config_t){.name = "set", .output = true, .bits = 16, .type = CM1E_IO_INT,
                                               .type_stated = true};
    slave->signals[1] = (cm1e_signal_config_t){.name = "is", .bit = 16, .bits = 16, .type = CM1E_IO_INT,
                                               .type_stated = true};
    slave->signal_count = 2;
    config.slaves[1].address = 1;
    cm1e_bus_t *bus = start();
    cm1e_sim_segment_attach(segment_of(bus), 2);
    for (int n = 0; n < 4000 && cm1e_bus_presence(bus, 2) != CM1E_PRESENCE_THERE; n++)
        cycle(bus);
    char text[CM1E_PRESENCE_TEXT];
    cm1e_bus_presence_text(bus, 2, text, sizeof text);
    ck_assert_msg(cm1e_bus_presence(bus, 2) == CM1E_PRESENCE_THERE, "%s", text);
    const cm1e_io_t set = find(bus, "both.set"), is = find(bus, "both.is");
    ck_assert_int_eq(cm1e_io_set_integer(&set, -5), CM1E_OK);
    cycles(bus, SETTLE);
    ck_assert_int_eq(cm1e_io_integer(&is), -5);
    cm1e_bus_close(bus);
}
END_TEST

/** Entries of object 0 have bits and no value: between others, and behind the last one, where they fill up bytes. */
START_TEST(padding_inside_and_at_the_end_of_pdos)
{
    static const cm1e_pdo_entry_config_t entries[] = {
        {0x1600, 0, 0, 3}, {0x1600, 0x7000, 0x11, 16}, {0x1600, 0, 0, 13},
        {0x1A00, 0x6000, 1, 1}, {0x1A00, 0, 0, 6}, {0x1A00, 0x6000, 0x11, 16}, {0x1A00, 0, 0, 9},
        {0x1A03, 0x6010, 0x11, 16}, {0x1A03, 0, 0, 8},
    };
    sim_config(0);
    cm1e_slave_config_t *slave = add("both", FIRST, CM1E_SIM_SLAVE_ANALOG, 2, 2);
    memcpy(slave->entries, entries, sizeof entries);
    slave->entry_count = sizeof entries / sizeof entries[0];
    slave->outputs_pdos[0] = 0x1600;
    slave->outputs_pdos[1] = 0x1601;
    slave->inputs_pdos[0] = 0x1A00;
    slave->inputs_pdos[1] = 0x1A03;
    slave->outputs_pdo_count = slave->inputs_pdo_count = 2;
    cm1e_bus_t *bus = start();
    ck_assert_uint_eq(cm1e_bus_slave(bus, FIRST)->input_bytes, 7);
    ck_assert_uint_eq(cm1e_bus_slave(bus, FIRST)->output_bytes, 6);
    expect_both_channels(bus);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(counters_of_an_encoder_terminal_turn_and_wrap)
{
    sim_config(0);
    cm1e_slave_config_t *slave = add("counters", FIRST, CM1E_SIM_SLAVE_ENCODER, 2, 0);
    slave->sim.counts_per_s = -100000;
    cm1e_bus_t *bus = start();
    const cm1e_io_t first = find(bus, "counters.0x6000:11"), second = find(bus, "counters.0x6010:11");
    cycles(bus, SETTLE);
    const int64_t before = cm1e_io_integer(&first);
    cycles(bus, 1000);
    ck_assert_uint_eq(first.bits, 32);
    ck_assert_int_eq(cm1e_io_integer(&first) - before, -100000);
    ck_assert_int_gt(before, INT64_C(1) << 31); /* below 0 */
    ck_assert_int_eq(cm1e_io_integer(&second), cm1e_io_integer(&first));
    cm1e_bus_close(bus);
}
END_TEST

/* ---- modular devices (ETG.5001) ---------------------------------------------------------------------------------- */

static const uint32_t modules[] = {0x205, 0x105, 0x402, 0x302, 0x108};
enum { MODULES = sizeof modules / sizeof modules[0] };
static cm1e_bus_config_t wire;

static void describe_modular(cm1e_bus_config_t *to)
{
    cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(to, "io");
    slave->address = FIRST;
    slave->sim.kind = CM1E_SIM_SLAVE_MODULAR;
    memcpy(slave->modules, modules, sizeof modules);
    slave->module_count = MODULES;
}

/** The segment has the modules above; the configuration may name others. */
static void describe_both(void)
{
    cm1e_bus_config_free(&wire);
    sim_config(0);
    describe_modular(&config);
    cm1e_bus_config_init(&wire, "sim", 0);
    wire.virtual_time = true;
    describe_modular(&wire);
}

static cm1e_bus_t *start_on_wire(cm1e_error_t expected, const char *words)
{
    cm1e_bus_t *bus = open_bus_on(&wire);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == expected, "%s", diag.text);
    ck_assert_msg(!words || strstr(diag.text, words), "%s", diag.text);
    return bus;
}

static unsigned read_object(cm1e_bus_t *bus, uint16_t index, uint8_t subindex)
{
    uint8_t data[4] = {0};
    size_t size = sizeof data;
    ck_assert_msg(cm1e_sdo_read(bus, FIRST, index, subindex, data, &size, &diag) == CM1E_OK, "%s", diag.text);
    return data[0] | (unsigned)data[1] << 8;
}

/** Objects and PDOs of a slot are moved by its number; inputs are wired to the outputs before them. */
START_TEST(modules_have_their_objects_by_slot)
{
    describe_both();
    cm1e_bus_t *bus = start_on_wire(CM1E_OK, NULL);
    ck_assert_uint_eq(read_object(bus, 0xF030, 0), MODULES);
    for (unsigned n = 1; n <= MODULES; n++)
        ck_assert_uint_eq(read_object(bus, 0xF030, (uint8_t)n), modules[n - 1]);
    ck_assert_uint_eq(read_object(bus, 0x1C13, 1), 0x1A01);
    ck_assert_uint_eq(cm1e_bus_slave(bus, FIRST)->output_bytes, 5);
    ck_assert_uint_eq(cm1e_bus_slave(bus, FIRST)->input_bytes, 6);
    const cm1e_io_t bit = find(bus, "io.0x7000:03"), word = find(bus, "io.0x7020:02");
    ck_assert_int_eq(cm1e_io_set_bool(&bit, true), CM1E_OK);
    ck_assert_int_eq(cm1e_io_set_integer(&word, -4711), CM1E_OK);
    cycles(bus, SETTLE);
    for (unsigned n = 1; n <= 5; n++) {
        char name[20], other[20];
        snprintf(name, sizeof name, "io.0x6010:%02X", n);
        snprintf(other, sizeof other, "io.0x6040:%02X", n);
        const cm1e_io_t first = find(bus, name), second = find(bus, other);
        ck_assert_int_eq(cm1e_io_bool(&first), n == 3);
        ck_assert_int_eq(cm1e_io_bool(&second), n == 3);
    }
    const cm1e_io_t back = find(bus, "io.0x6030:02"), zero = find(bus, "io.0x6030:01");
    ck_assert_int_eq(cm1e_io_integer(&back), -4711);
    ck_assert_int_eq(cm1e_io_integer(&zero), 0);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(another_module_is_told_with_its_slot)
{
    describe_both();
    config.slaves[0].modules[2] = 0x302;
    cm1e_bus_close(start_on_wire(CM1E_ERROR_BUS_IDENTITY, "has the module 0x00000402 in slot 3 (0xF050:03), and the "
                                 "configuration names 0x00000302 there"));
    config.slaves[0].module_count = 4;
    config.slaves[0].modules[2] = 0x402;
    cm1e_bus_close(start_on_wire(CM1E_ERROR_BUS_IDENTITY, "has 5 modules (0xF050:00), and the configuration names 4"));
    config.slaves[0].module_count = 0; /* not stated: it runs with what it has */
    config.slaves[0].sim.kind = CM1E_SIM_SLAVE_GAP;
    cm1e_bus_close(start_on_wire(CM1E_OK, NULL));
}
END_TEST

/** The device compares the two lists too, on the way to Safe-Operational. */
START_TEST(wrong_configured_list_is_refused_by_the_device)
{
    static const cm1e_sdo_config_t wrong[] = {{.index = 0xF030, .subindex = 1, .bytes = 4, .value = 0x208},
                                              {.index = 0xF030, .subindex = 0, .bytes = 1, .value = 1}};
    describe_both();
    config.slaves[0].module_count = 0;
    config.slaves[0].sim.kind = CM1E_SIM_SLAVE_GAP;
    memcpy(config.slaves[0].sdos, wrong, sizeof wrong);
    config.slaves[0].sdo_count = 2;
    cm1e_bus_close(start_on_wire(CM1E_ERROR_BUS_STATE, "0x0070"));
}
END_TEST

START_TEST(modules_are_configured_again_after_the_slave_was_away)
{
    describe_both();
    cm1e_bus_t *bus = start_on_wire(CM1E_OK, NULL);
    simulate(bus, "power-cycle 1 100");
    for (int n = 0; n < 3000; n++)
        cycle(bus);
    ck_assert_int_eq(cm1e_bus_presence(bus, FIRST), CM1E_PRESENCE_THERE);
    const cm1e_io_t bit = find(bus, "io.0x7000:05"), back = find(bus, "io.0x6010:05");
    ck_assert_int_eq(cm1e_io_set_bool(&bit, true), CM1E_OK);
    cycles(bus, SETTLE);
    ck_assert(cm1e_io_bool(&back));
    cm1e_bus_close(bus);
}
END_TEST

/** Where the SII has the place of a sync manager. */
static uint8_t *sync_manager_of_sii(cm1e_bus_t *bus, uint32_t position, unsigned number)
{
    enum { SYNC_MANAGERS = 41 };
    cm1e_sim_slave_t *slave = cm1e_sim_segment_slave(segment_of(bus), position);
    cm1e_sii_category_t category = {0};
    size_t at = CM1E_SII_HEADER_BYTES;
    while (cm1e_sii_category_at(&category, slave->sii, slave->sii_size, at) && category.type != SYNC_MANAGERS)
        at = category.start + category.bytes;
    ck_assert_uint_eq(category.type, SYNC_MANAGERS);
    return slave->sii + category.start + 8 * (size_t)number;
}

static cm1e_error_t configure(cm1e_bus_t *bus)
{
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK && cm1e_bus_identify(bus, &diag) == CM1E_OK, "%s", diag.text);
    return cm1e_bus_configure(bus, &diag);
}

/** Three buffers each, within the memory of the controller, and not in one another. */
START_TEST(process_data_have_their_room_in_the_controller)
{
    static const struct {
        int outputs, inputs; /* bytes beyond the last place that is right: of the outputs before the inputs, ... */
        unsigned kind;
    } rows[] = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 1}, {0, 0, 2}, {1, 0, 2}, {0, 0, 3}, {0, 1, 3}};
    sim_config(1);
    cm1e_bus_t *bus = start_bus();
    const unsigned outputs = cm1e_bus_slave(bus, 1)->output_bytes, inputs = cm1e_bus_slave(bus, 1)->input_bytes;
    cm1e_bus_close(bus);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const unsigned places[4][2] = {{0x1400u - 3 * outputs, 0x1400}, {0x1400, 0x1400u - 3 * inputs},
                                       {0x10000u - 3 * outputs, 0x1400}, {0x1400, 0x10000u - 3 * inputs}};
        const bool right = rows[i].outputs == 0 && rows[i].inputs == 0;
        bus = open_bus();
        cm1e_put_u16(sync_manager_of_sii(bus, 1, 2), (uint16_t)(places[rows[i].kind][0] + (unsigned)rows[i].outputs));
        cm1e_put_u16(sync_manager_of_sii(bus, 1, 3), (uint16_t)(places[rows[i].kind][1] + (unsigned)rows[i].inputs));
        const cm1e_error_t error = configure(bus);
        ck_assert_msg((error != CM1E_ERROR_PDO_MAPPING) == right, "row %zu: %s", i, diag.text);
        if (!right)
            ck_assert_str_eq(diag.text, "The process data of slave 1 (\"axis1\", CM1-E) does not fit its sync managers: "
                                        "its SII is damaged.");
        ck_assert(right || diag.foreign_code == 0);
        cm1e_bus_close(bus);
    }
}
END_TEST

/** Process data on a sync manager that there is not. */
START_TEST(a_sync_manager_without_a_place_carries_nothing)
{
    for (unsigned number = 0; number < 2; number++) {
        for (unsigned kind = 0; kind < 2; kind++) { /* without a mailbox; with CoE, where the PDOs are asked of it */
            sim_config(0);
            cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(&config, "terminal");
            slave->address = 1;
            slave->sim.kind = kind ? CM1E_SIM_SLAVE_ANALOG : CM1E_SIM_SLAVE_DIGITAL;
            slave->sim.inputs = slave->sim.outputs = 4;
            cm1e_bus_t *bus = open_bus();
            ck_assert_msg(configure(bus) == CM1E_OK, "%s", diag.text);
            cm1e_put_u16(sync_manager_of_sii(bus, 1, number + (kind ? 2 : 0)), 0);
            ck_assert_int_eq(configure(bus), CM1E_ERROR_PDO_MAPPING);
            ck_assert_msg(strstr(diag.text, kind ? "assign fewer PDOs." : "its SII is damaged."), "%s", diag.text);
            cm1e_bus_close(bus);
        }
    }
}
END_TEST

/** What devices of one kind share is read once; each has its own mailbox, and what it is for. */
START_TEST(mailboxes_of_two_devices_of_one_kind_are_their_own)
{
    static const uint16_t own[4] = {0x1010, 112, 0x1090, 96}; /* out, in: start and length */
    uint16_t before[4];
    sim_config(0);
    for (unsigned i = 1; i <= 2; i++)
        add(i == 1 ? "first" : "second", (uint16_t)i, CM1E_SIM_SLAVE_ANALOG, 2, 2);
    cm1e_bus_t *bus = open_bus();
    for (unsigned n = 0; n < 4; n++) {
        before[n] = cm1e_get_u16(sii_memory_of(bus, 1) + CM1E_SII_MAILBOX + 2 * n);
        cm1e_put_u16(sii_memory_of(bus, 2) + CM1E_SII_MAILBOX + 2 * n, own[n]);
    }
    cm1e_put_u16(sii_memory_of(bus, 2) + CM1E_SII_PROTOCOLS, 0x0008); /* FoE alone */
    (void)cm1e_bus_scan(bus, &diag); /* the simulated device has another mailbox, and may refuse this one */
    for (unsigned n = 0; n < 4; n++) {
        const size_t at = 0x0800 + 8 * (n / 2) + 2 * (n % 2);
        ck_assert_uint_eq(cm1e_get_u16(register_memory_of(bus, 1) + at), before[n]);
        ck_assert_uint_eq(cm1e_get_u16(register_memory_of(bus, 2) + at), own[n]);
    }
    ck_assert(cm1e_bus_slave_has_coe(bus, 1) && !cm1e_bus_slave_has_coe(bus, 2));
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("PDO styles");
    TCase *tests = tcase_create("styles");
    tcase_add_test(tests, inputs_may_be_on_sync_manager_2);
    tcase_add_test(tests, pdos_of_swapped_sync_managers_are_assigned_by_the_other_object);
    tcase_add_test(tests, swapped_sync_managers_are_written_again_after_the_slave_was_away);
    tcase_add_test(tests, swapped_sync_managers_of_a_slave_that_comes_later);
    tcase_add_test(tests, padding_inside_and_at_the_end_of_pdos);
    tcase_add_test(tests, counters_of_an_encoder_terminal_turn_and_wrap);
    tcase_add_test(tests, modules_have_their_objects_by_slot);
    tcase_add_test(tests, another_module_is_told_with_its_slot);
    tcase_add_test(tests, wrong_configured_list_is_refused_by_the_device);
    tcase_add_test(tests, modules_are_configured_again_after_the_slave_was_away);
    tcase_add_test(tests, mailboxes_of_two_devices_of_one_kind_are_their_own);
    tcase_add_test(tests, process_data_have_their_room_in_the_controller);
    tcase_add_test(tests, a_sync_manager_without_a_place_carries_nothing);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
