/* Slaves that real networks have: small controllers, slow and damaged EEPROMs, mailboxes without CoE, SDO information
 * that breaks off, ports that loop back, junctions. Each is scanned and operated, or refused in words. */
#include "cm1e/foe.h" /* before the global `diag` of the tests */

#include "bus/bus_internal.h"
#include "bus_support.h"
#include "cm1e/sdo_info.h"
#include "cm1e/topology.h"

static cm1e_bus_t *bus_with(uint32_t axes, const char *const lines[])
{
    sim_config(axes);
    cm1e_bus_t *bus = open_bus();
    for (int i = 0; lines[i]; i++)
        simulate(bus, lines[i]);
    return bus;
}
#define BUS_WITH(axes, ...) bus_with(axes, (const char *const[]){__VA_ARGS__, NULL})

static void expect_start(cm1e_bus_t *bus)
{
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    cycles(bus, 50);
    for (uint32_t i = 1; i <= cm1e_bus_slave_count(bus); i++)
        ck_assert_uint_eq(cm1e_bus_slave(bus, i)->al_state, CM1E_AL_OP);
}

static void expect_refusal(cm1e_bus_t *bus, cm1e_error_t error, const char *words)
{
    ck_assert_int_eq(cm1e_bus_start(bus, &diag), error);
    ck_assert_msg(strstr(diag.text, words) != NULL, "\"%s\" is not in: %s", words, diag.text);
    cm1e_bus_close(bus);
}

/** As many as the mapping needs is enough; one less is refused before the slave can refuse a state without a reason. */
START_TEST(small_controllers)
{
    cm1e_bus_t *bus = BUS_WITH(2, "quirk 2 fmmus 2", "quirk 2 sync-managers 4");
    expect_start(bus);
    cm1e_bus_close(bus);
    expect_refusal(BUS_WITH(2, "quirk 2 fmmus 1"), CM1E_ERROR_CONFIG, "has 1 FMMUs and 4 sync managers; its process "
                   "data needs 2 and 4");
    expect_refusal(BUS_WITH(2, "quirk 1 sync-managers 3"), CM1E_ERROR_CONFIG, "slave 1 (\"axis1\", CM1-E) has 8 FMMUs "
                   "and 3 sync managers");
    /* The simulated controller itself has no more than it says. */
    bus = BUS_WITH(1, "quirk 1 fmmus 1");
    uint8_t registers[32];
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_OK);
    memset(registers, 0xFF, sizeof registers);
    ck_assert(cm1e_soem_transfer(bus->soem, COMMAND_FPWR, 0x1001, REG_FMMU0, registers, sizeof registers) == 1);
    ck_assert(cm1e_bus_read_registers(bus, 1, REG_FMMU0, registers, sizeof registers));
    ck_assert(registers[0] == 0xFF && registers[16] == 0 && registers[28] == 0);
    cm1e_bus_close(bus);
}
END_TEST

/** A terminal without a mailbox has a sync manager for each direction, and one is not enough for both. */
START_TEST(small_terminal)
{
    for (int managers = 1; managers <= 2; managers++) {
        sim_config(1);
        cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(&config, "both");
        slave->address = 2;
        slave->sim = (cm1e_sim_slave_config_t){.kind = CM1E_SIM_SLAVE_DIGITAL, .inputs = 4, .outputs = 4};
        cm1e_bus_t *bus = open_bus();
        simulate(bus, managers == 1 ? "quirk 2 sync-managers 1" : "quirk 2 sync-managers 2");
        if (managers == 1) {
            expect_refusal(bus, CM1E_ERROR_CONFIG, "1 sync managers; its process data needs 2 and 2");
        } else {
            expect_start(bus);
            cm1e_bus_close(bus);
        }
    }
}
END_TEST

static unsigned first_lost, addressed;

/** Loses the frames that give stations their addresses, the first `first_lost` of them. */
static cm1e_tap_verdict_t lose_addresses(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    const bool gives = frame->bytes[16] == COMMAND_APWR && cm1e_get_u16(frame->bytes + 20) == 0x0010;
    return frame->direction == CM1E_TAP_SENT && gives && addressed++ < first_lost ? CM1E_TAP_DROP : CM1E_TAP_PASS;
}

/** A slave that did not take its address with all others takes it by itself. */
START_TEST(addresses_that_did_not_arrive)
{
    for (first_lost = 0; first_lost <= 2; first_lost++) {
        sim_config(3);
        cm1e_bus_t *bus = open_bus();
        addressed = 0;
        cm1e_nic_set_tap(cm1e_bus_nic(bus), lose_addresses, NULL);
        expect_start(bus);
        ck_assert_uint_eq(cm1e_bus_slave_count(bus), 3);
        ck_assert_uint_ge(addressed, first_lost ? 4 : 1); /* all at once, then each */
        cm1e_bus_close(bus);
    }
}
END_TEST

static uint8_t stated_units[2]; /**< FMMUs and sync managers */

static cm1e_tap_verdict_t state_units(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    const bool units = cm1e_get_u16(frame->bytes + 20) == 0x0004 && (cm1e_get_u16(frame->bytes + 22) & 0x7FF) == 2;
    if (units && frame->direction == CM1E_TAP_RECEIVED && cm1e_get_u16(frame->bytes + 18) == 0x1002)
        memcpy(frame->bytes + 26, stated_units, sizeof stated_units);
    return CM1E_TAP_PASS;
}

/** A controller that states 0 does not tell the number, and it counts for each of both by itself. */
START_TEST(controllers_that_do_not_tell)
{
    static const struct {
        uint8_t units[2];
        const char *refused;
    } rows[] = {{{0, 0}, NULL}, {{2, 0}, NULL}, {{0, 4}, NULL},
                {{1, 0}, "has 1 FMMUs and 0 sync managers"}, {{0, 3}, "has 0 FMMUs and 3 sync managers"}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        sim_config(2);
        cm1e_bus_t *bus = open_bus();
        memcpy(stated_units, rows[i].units, sizeof stated_units);
        cm1e_nic_set_tap(cm1e_bus_nic(bus), state_units, NULL);
        if (rows[i].refused) {
            expect_refusal(bus, CM1E_ERROR_CONFIG, rows[i].refused);
        } else {
            expect_start(bus);
            cm1e_bus_close(bus);
        }
    }
}
END_TEST

/** Two analog inputs, whose channels the bus file orders, or one of which it maps anew. */
static void analog(bool maps)
{
    sim_config(1);
    cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(&config, "ai");
    slave->address = 2;
    slave->sim = (cm1e_sim_slave_config_t){.kind = CM1E_SIM_SLAVE_ANALOG, .inputs = 2};
    if (maps)
        slave->entries[slave->entry_count++] = (cm1e_pdo_entry_config_t){0x1A00, 0x6000, 0x11, 16};
    else
        slave->inputs_pdos[slave->inputs_pdo_count++] = 0x1A03;
}

/** Many devices let nobody write the entries of their PDOs, and some not even the list of those that are assigned. As
 *  they are they run; what the bus file wants to write there is refused with the object and the reason of the slave. */
START_TEST(fixed_pdos)
{
    static const char *const quirks[] = {"quirk 2 fixed-mapping", "quirk 2 fixed-assignment"};
    analog(false);
    cm1e_bus_t *ordered = open_bus();
    simulate(ordered, quirks[0]); /* entries that nobody may write can be assigned */
    expect_start(ordered);
    cm1e_bus_close(ordered);
    for (int fixed = 0; fixed < 2; fixed++) {
        analog(!fixed);
        cm1e_bus_t *refused = open_bus();
        simulate(refused, quirks[fixed]);
        expect_refusal(refused, CM1E_ERROR_SDO_ABORT, fixed ? "0x1C13:00: SDO abort 0x06010002"
                                                            : "0x1A00:00: SDO abort 0x06010002");
        analog(false);
        config.slaves[0].inputs_pdo_count = 0; /* as it is: the default assignment of both channels */
        cm1e_bus_t *bus = open_bus();
        simulate(bus, quirks[fixed]);
        expect_start(bus);
        ck_assert_uint_eq(cm1e_bus_slave(bus, 2)->al_state, CM1E_AL_OP);
        cm1e_bus_close(bus);
    }
}
END_TEST

/** An EEPROM that takes 15 ms more for each of its reads, of which there are some 16, delays the scan, and nothing
 *  else. */
START_TEST(a_slow_eeprom)
{
    cm1e_bus_t *bus = BUS_WITH(2, "quirk 1 slow-eeprom 15000");
    const int64_t begun_ns = now_of(bus);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    const int64_t took_ns = now_of(bus) - begun_ns;
    ck_assert_msg(took_ns > 150000000 && took_ns < INT64_C(30000000000), "%lld ns", (long long)took_ns);
    ck_assert_str_eq(cm1e_bus_slave(bus, 1)->name, cm1e_bus_slave(bus, 2)->name);
    expect_start(bus);
    cm1e_bus_close(bus);
}
END_TEST

/** A mailbox that takes each of its requests 20 ms later answers all of them. */
START_TEST(a_slow_mailbox)
{
    cm1e_bus_t *bus = BUS_WITH(2, "quirk 1 slow-mailbox 20000");
    uint32_t type = 0;
    size_t size = sizeof type;
    expect_start(bus);
    const int64_t begun_ns = now_of(bus);
    ck_assert_msg(cm1e_sdo_read(bus, 1, 0x1000, 0, &type, &size, &diag) == CM1E_OK, "%s", diag.text);
    const int64_t took_ns = now_of(bus) - begun_ns;
    ck_assert_msg(took_ns >= 20000000 && took_ns < 60000000, "%lld ns", (long long)took_ns);
    ck_assert_uint_eq(size, sizeof type);
    cm1e_bus_close(bus);
}
END_TEST

/** The controller does not load it, so the device hears of no state: it stays in Init, and the reason is said. */
START_TEST(a_wrong_checksum)
{
    cm1e_bus_t *bus = BUS_WITH(2, "quirk 2 wrong-checksum");
    ck_assert_int_eq(cm1e_bus_start(bus, &diag), CM1E_ERROR_BUS_STATE);
    ck_assert_msg(strstr(diag.text, "Slave 2 (CM1-E) did not reach PRE-OP") != NULL, "%s", diag.text);
    ck_assert_msg(strstr(diag.text, "has not loaded its EEPROM: the checksum is wrong") != NULL, "%s", diag.text);
    simulate(bus, "quirk 2 wrong-checksum"); /* right again */
    cm1e_bus_stop(bus);
    expect_start(bus);
    cm1e_bus_close(bus);
}
END_TEST

/** The list of objects breaks off behind a fragment: an error with the code of the slave, then transfers go on. */
START_TEST(information_that_breaks_off)
{
    static uint16_t indexes[4096];
    cm1e_bus_t *bus = BUS_WITH(1, "quirk 1 abort-info 1");
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_OK);
    for (int i = 0; i < 5; i++) {
        uint8_t data[4];
        size_t count = sizeof indexes / sizeof *indexes, size = sizeof data;
        ck_assert_int_eq(cm1e_sdo_info_list(bus, 1, CM1E_OBJECTS_ALL, indexes, &count, &diag), CM1E_ERROR_SDO_ABORT);
        ck_assert_uint_eq(diag.foreign_code, SDO_ABORT_GENERAL);
        ck_assert_msg(cm1e_sdo_read(bus, 1, 0x1018, 1, data, &size, &diag) == CM1E_OK, "%s", diag.text);
    }
    simulate(bus, "quirk 1 nothing");
    size_t count = sizeof indexes / sizeof *indexes;
    ck_assert_msg(cm1e_sdo_info_list(bus, 1, CM1E_OBJECTS_ALL, indexes, &count, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_gt(count, 40);
    expect_start(bus);
    cm1e_bus_close(bus);
}
END_TEST

/** A foreign drive whose mailbox carries files, but no objects, between two motors. */
START_TEST(a_mailbox_without_coe)
{
    static cm1e_bus_config_t foreign;
    uint8_t data[64];
    size_t size = sizeof data;
    sim_config(3);
    cm1e_axis_config_t *axis = &config.axes[1];
    strcpy(axis->device, "cia402");
    axis->firmware[0] = 0;
    axis->counts_per_revolution = 10000;
    axis->max_speed_rpm = 3000;
    foreign = config;
    foreign.axes = malloc(3 * sizeof *foreign.axes);
    ck_assert_ptr_nonnull(foreign.axes);
    memcpy(foreign.axes, config.axes, 3 * sizeof *foreign.axes);
    config.axes[1] = config.axes[2];
    config.axis_count = 2;
    config.axes[1].address = 3;
    cm1e_bus_t *bus = open_bus_on(&foreign);
    free(foreign.axes);
    simulate(bus, "quirk 2 no-coe");
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert(!bus->slaves[1].facts.coe && bus->slaves[1].facts.foe);
    ck_assert_int_eq(cm1e_sdo_read(bus, 2, 0x1018, 1, data, &size, &diag), CM1E_ERROR_UNSUPPORTED);
    ck_assert_msg(cm1e_foe_write(bus, 2, "f", data, 64, NULL, &diag) == CM1E_OK, "%s", diag.text);
    expect_start(bus);
    cm1e_bus_close(bus);
}
END_TEST

/** Behind a port that sends frames back nothing is found, although there is a link. */
START_TEST(a_port_that_loops_back)
{
    cm1e_slave_place_t places[4];
    cm1e_bus_t *bus = BUS_WITH(4, "quirk 2 loop 1");
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_eq(cm1e_bus_slave_count(bus), 2);
    ck_assert_int_eq(cm1e_bus_topology(bus, places, 4, &diag), CM1E_OK);
    ck_assert(places[1].link[1] && !places[1].open[1] && places[1].next[1] == 0);
    simulate(bus, "quirk 2 nothing");
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_OK);
    ck_assert_uint_eq(cm1e_bus_slave_count(bus), 4);
    expect_start(bus);
    simulate(bus, "quirk 2 loop 1"); /* in operation: the slaves behind it are lost, the others go on */
    for (int i = 0; i < 100; i++)
        cycle(bus);
    ck_assert(cm1e_bus_slave_watch(bus, 3).lost && cm1e_bus_slave_watch(bus, 4).lost);
    ck_assert(!cm1e_bus_slave_watch(bus, 1).lost && !cm1e_bus_slave_watch(bus, 2).lost);
    ck_assert(cm1e_bus_slave_watch(bus, 1).fresh && cm1e_bus_slave_watch(bus, 2).fresh);
    cm1e_bus_close(bus);
}
END_TEST

/** Whether the next cycle takes the inputs of a slave: none of the bytes put there is left. */
static bool takes_inputs(cm1e_bus_t *bus, uint16_t position)
{
    const cm1e_slave_placement_t *placement = &bus->slaves[position - 1].placement;
    memset(bus->inputs + placement->input_offset, 0x5A, placement->input_bytes);
    cycle(bus);
    return !memchr(bus->inputs + placement->input_offset, 0x5A, placement->input_bytes);
}

/** Slave 2 is a junction: slaves 3 and 4 are at its port 3, slave 5 at port 1, slave 6 at port 2. A branch that is cut
 *  off leaves the others in operation. */
START_TEST(a_junction_whose_branch_is_cut_off)
{
    static const uint16_t parents[] = {0, 1, 2, 3, 2, 2}, ports[] = {0, 1, 3, 1, 1, 2};
    cm1e_slave_place_t places[6];
    char text[96];
    cm1e_bus_t *bus = BUS_WITH(6, "quirk 3 branch 3002", "quirk 5 branch 1002", "quirk 6 branch 2002");
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_eq(cm1e_bus_slave_count(bus), 6);
    ck_assert_int_eq(cm1e_bus_topology(bus, places, 6, &diag), CM1E_OK);
    for (int i = 0; i < 6; i++)
        ck_assert_msg(places[i].known && places[i].parent == parents[i] && places[i].parent_port == ports[i],
                      "slave %d is at port %u of slave %u", i + 1, places[i].parent_port, places[i].parent);
    cm1e_cable_text(&places[2], 3, 0, text, sizeof text);
    ck_assert_str_eq(text, "between slave 2 (port 3) and slave 3 (port 0, IN)");
    expect_start(bus);
    simulate(bus, "unplug 3");
    for (int i = 0; i < 100; i++)
        cycle(bus);
    for (uint16_t position = 1; position <= 6; position++)
        ck_assert_msg(cm1e_bus_slave_watch(bus, position).lost == (position == 3 || position == 4), "slave %u",
                      position);
    ck_assert(cm1e_bus_slave_watch(bus, 5).fresh && cm1e_bus_slave_watch(bus, 6).fresh);
    for (uint16_t position = 1; position <= 6; position++)
        ck_assert_msg(takes_inputs(bus, position) == (position != 3 && position != 4), "slave %u", position);
    ck_assert_uint_eq(cm1e_bus_port_faults(bus, 2, 3).lost_links, 1);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(the_console_says_what_it_expects)
{
    char answer[300];
    cm1e_bus_t *bus = BUS_WITH(1, "quirk 1 nothing");
    ck_assert_int_eq(cm1e_bus_simulate(bus, "quirk 1 warp", answer, sizeof answer), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_ptr_nonnull(strstr(answer, "fmmus <number> sync-managers <number>"));
    ck_assert_int_eq(cm1e_bus_simulate(bus, "quirk 1 fmmus 9", answer, sizeof answer), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_ptr_nonnull(strstr(answer, "expected a number, 1 to 8"));
    ck_assert_int_eq(cm1e_bus_simulate(bus, "quirk 1 fmmus", answer, sizeof answer), CM1E_ERROR_INVALID_ARGUMENT);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("quirks");
    TCase *tests = tcase_create("quirks");
    tcase_set_timeout(tests, 60);
    tcase_add_test(tests, small_controllers);
    tcase_add_test(tests, small_terminal);
    tcase_add_test(tests, addresses_that_did_not_arrive);
    tcase_add_test(tests, controllers_that_do_not_tell);
    tcase_add_test(tests, fixed_pdos);
    tcase_add_test(tests, a_slow_eeprom);
    tcase_add_test(tests, a_slow_mailbox);
    tcase_add_test(tests, a_wrong_checksum);
    tcase_add_test(tests, information_that_breaks_off);
    tcase_add_test(tests, a_mailbox_without_coe);
    tcase_add_test(tests, a_port_that_loops_back);
    tcase_add_test(tests, a_junction_whose_branch_is_cut_off);
    tcase_add_test(tests, the_console_says_what_it_expects);
    suite_add_tcase(suite, tests);
    return run_suite(suite);
}
