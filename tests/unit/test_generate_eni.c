/* ENI: what is made for our networks, written, read and written again. */
#include <stdio.h>
#include <string.h>

#include "cm1e/config.h"
#include "core/bytes.h"
#include "description/describe.h"
#include "eni_networks.h"
#include "generate/eni.h"
#include "golden.h"
#include "unity.h"

static cm1e_diag_t diag;
static cm1e_description_file_t described;
static cm1e_eni_t document, again;
static cm1e_file_t file, second;

void setUp(void) { diag = (cm1e_diag_t){0}; }

void tearDown(void)
{
    cm1e_eni_free(&document);
    cm1e_eni_free(&again);
    cm1e_file_free(&file);
    cm1e_file_free(&second);
    cm1e_description_file_free(&described);
}

static void make(const eni_network_t *network)
{
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, eni_network_make(&document, &described, network, &diag), diag.text);
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_eni_write(&file, &document, &diag), diag.text);
}

static void test_networks_match_their_golden_files(void)
{
    for (size_t i = 0; i < ENI_NETWORKS; i++) {
        make(&eni_networks[i]);
        golden_compare(eni_networks[i].file, file.bytes, file.size);
        tearDown();
    }
}

static void test_what_was_written_comes_back_as_it_was(void)
{
    for (size_t i = 0; i < ENI_NETWORKS; i++) {
        make(&eni_networks[i]);
        TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_eni_read(&again, file.bytes, file.size, &diag), diag.text);
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_eni_write(&second, &again, &diag));
        TEST_ASSERT_EQUAL(file.size, second.size);
        TEST_ASSERT_EQUAL_STRING(file.bytes, second.bytes);
        tearDown();
    }
}

static void test_a_bus_file_gives_the_network_of_its_axes(void)
{
    static cm1e_bus_config_t config;
    const char *path = CM1E_SOURCE_DIR "/examples/three_axes.yaml";
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_bus_config_load(&config, path, &diag), diag.text);
    const cm1e_generate_options_t options = {.format = CM1E_FILE_ENI, .network = &config};
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_generate(&file, &options, &diag), diag.text);
    golden_compare(eni_networks[ENI_THREE].file, file.bytes, file.size);
}

/* ---- axes behind bridges ---------------------------------------------------------------------------------------- */

static cm1e_bus_config_t configured;

/* Axes by place: 0 a CM1-E, else the channel of a bridge. */
static void set_network(size_t count, const uint16_t (*axes)[2])
{
    cm1e_bus_config_free(&configured);
    cm1e_bus_config_init(&configured, "sim", (uint32_t)count);
    for (size_t i = 0; i < count; i++) {
        snprintf(configured.axes[i].name, sizeof configured.axes[i].name, "A%zu", i + 1);
        configured.axes[i].address = axes[i][0];
        configured.axes[i].channel = (uint8_t)axes[i][1];
        configured.axes[i].k37 = 10;
        configured.axes[i].k37_stated = axes[i][1] != 0;
    }
}

static cm1e_error_t generate_network(const cm1e_device_options_t *devices, size_t count)
{
    const cm1e_generate_options_t options = {.format = CM1E_FILE_ENI, .network = &configured, .devices = devices,
                                             .device_count = count};
    cm1e_file_free(&file);
    return cm1e_generate(&file, &options, &diag);
}

#define BRIDGE(model_, product) {.model = model_, .vendor_id = 0xAA77, .product_code = product, .revision = 1}
static const cm1e_device_options_t eb12[] = {BRIDGE(CM1E_DEVICE_EB12, 0x12)};
static const cm1e_device_options_t two_bridges[] = {BRIDGE(CM1E_DEVICE_EB01, 0x01), BRIDGE(CM1E_DEVICE_EB02, 0x02)};
static const uint16_t mixed_axes[][2] = {{1, 0}, {2, 3}, {2, 1}, {3, 0}};

static void test_axes_behind_a_bridge_are_one_slave(void)
{
    static const uint32_t products[] = {0x44412002, 0x12, 0x44412002};
    static const char *const names[] = {"A1", "A2, A3", "A4"};
    set_network(4, mixed_axes);
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, generate_network(eb12, 1), diag.text);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_eni_read(&document, file.bytes, file.size, &diag));
    TEST_ASSERT_EQUAL(3, document.devices.count);
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_HEX32(products[i], document.devices.at[i].product_code);
        TEST_ASSERT_EQUAL_STRING(names[i], document.devices.at[i].name);
    }
    TEST_ASSERT_EQUAL(24 * 8, document.devices.at[1].send.length); /* all four motors, whoever has an axis */
}

static void test_the_bridge_is_the_stated_one_that_has_the_motors(void)
{
    static const uint16_t axes[][2] = {{1, 1}, {2, 4}};
    set_network(2, axes);
    strcpy(configured.axes[0].motor, "CM2");
    strcpy(configured.axes[1].motor, "CM1");
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, generate_network(two_bridges, 2), diag.text);
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_eni_read(&document, file.bytes, file.size, &diag));
    TEST_ASSERT_EQUAL_HEX32(0x02, document.devices.at[0].product_code);
    TEST_ASSERT_EQUAL_HEX32(0x01, document.devices.at[1].product_code);
}

static void bridge_refused(const cm1e_device_options_t *devices, size_t count, const char *what)
{
    TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, generate_network(devices, count));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, what), diag.text);
}

static void test_identity_of_a_bridge_has_to_be_stated(void)
{
    static const cm1e_device_options_t incomplete[] = {{.model = CM1E_DEVICE_EB12, .vendor_id = 0xAA77}};
    static const cm1e_device_options_t a_motor[] = {{.model = CM1E_DEVICE_CM1E}};
    set_network(4, mixed_axes);
    bridge_refused(NULL, 0, "A2, A3: it is behind a bridge, whose guide states no identity");
    bridge_refused(a_motor, 1, "whose guide states no identity");
    bridge_refused(incomplete, 1, "missing");
    bridge_refused(two_bridges, 2, "an EB01 and an EB02 can both be the bridge there");
    strcpy(configured.axes[1].motor, "CM1");
    strcpy(configured.axes[2].motor, "CM1");
    bridge_refused(&two_bridges[1], 1, "no given device has these motors");
}

static void test_every_axis_has_process_data_in_its_bridge(void)
{
    cm1e_device_options_t of_two = eb12[0];
    of_two.axes = 2;
    set_network(4, mixed_axes); /* the channels 1 and 3 */
    bridge_refused(&of_two, 1, "A2, A3: one of its axes has channel 3, but the given EB12 has 2 axes; expected at least 3");
    of_two.axes = 3;
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, generate_network(&of_two, 1), diag.text);
}

static void test_what_a_file_of_the_bus_file_alone_leaves_out_is_a_warning(void)
{
    static const uint16_t axes[][2] = {{77, 0}, {78, 0}};
    set_network(2, axes);
    configured.axes[0].address_kind = configured.axes[1].address_kind = CM1E_ADDRESS_ALIAS;
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, generate_network(NULL, 0), diag.text);
    TEST_ASSERT_EQUAL_STRING("", file.warning);
    configured.axes[1].optional = true;
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, generate_network(NULL, 0), diag.text);
    TEST_ASSERT_EQUAL_STRING("A2 may be absent by the bus file, but a master that runs this file needs all of its slaves. "
                             "Make the ENI from a scan of the network", file.warning);
    configured.distributed_clocks = true;
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, generate_network(NULL, 0), diag.text);
    TEST_ASSERT_NOT_NULL(strstr(file.warning, "A2 may be absent"));
    TEST_ASSERT_NOT_NULL(strstr(file.warning, "The distributed clocks that the bus file asks for are not in this file"));
}

static void test_places_that_do_not_follow_are_refused(void)
{
    static const uint16_t gap[][2] = {{1, 1}, {1, 2}, {3, 0}}, first_missing[][2] = {{2, 1}, {2, 2}};
    set_network(3, gap);
    bridge_refused(eb12, 1, "axis 3 (A3): its place on the wire");
    set_network(2, first_missing);
    bridge_refused(eb12, 1, "axis 1 (A1): its place on the wire");
}

/* ---- what is in it ---------------------------------------------------------------------------------------------- */

static const cm1e_eni_command_t *find_command(const cm1e_eni_device_t *device, const char *comment, uint16_t transition)
{
    for (size_t i = 0; i < device->commands.count; i++)
        if (strcmp(device->commands.at[i].comment, comment) == 0 && device->commands.at[i].transitions & transition)
            return &device->commands.at[i];
    TEST_FAIL_MESSAGE(comment);
    return NULL;
}

static void test_slaves_are_addressed_in_the_order_of_the_wire(void)
{
    make(&eni_networks[ENI_MIXED]);
    for (size_t i = 0; i < document.devices.count; i++) {
        const cm1e_eni_device_t *device = &document.devices.at[i];
        TEST_ASSERT_EQUAL_HEX16(0x1001 + i, device->station);
        TEST_ASSERT_EQUAL_HEX16(0x10000 - i, i == 0 ? 0x10000 : device->position);
        TEST_ASSERT_EQUAL(i > 0, device->previous.count);
        const cm1e_eni_command_t *address = find_command(device, "set physical address", CM1E_ENI_IP);
        TEST_ASSERT_EQUAL_HEX16(device->position, address->adp);
        TEST_ASSERT_EQUAL_HEX16(device->station, cm1e_get_u16(address->data.data));
    }
}

/* Sync manager 2 of the CM1-E: 0x1100, 13 bytes (0x1600), control 0x64; its FMMU writes there (UG 11.2). */
static void test_registers_of_a_cm1e(void)
{
    static const uint8_t sm2[] = {0x00, 0x11, 13, 0, 0x64, 0, 1, 0}, sm3[] = {0x00, 0x14, 21, 0, 0x20, 0, 1, 0};
    static const uint8_t fmmu0[] = {0, 0, 0, 1, 13, 0, 0, 7, 0x00, 0x11, 0, 2, 1, 0, 0, 0};
    static const uint8_t fmmu1[] = {0, 0, 0, 1, 21, 0, 0, 7, 0x00, 0x14, 0, 1, 1, 0, 0, 0};
    static const struct {
        const char *comment;
        uint16_t reg;
        const uint8_t *bytes;
        size_t size;
    } rows[] = {{"set sm 2 (outputs)", 0x0810, sm2, sizeof sm2},
                {"set sm 3 (inputs)", 0x0818, sm3, sizeof sm3},
                {"set fmmu 0 (outputs)", 0x0600, fmmu0, sizeof fmmu0},
                {"set fmmu 1 (inputs)", 0x0610, fmmu1, sizeof fmmu1}};
    make(&eni_networks[ENI_ONE]);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const cm1e_eni_command_t *command = find_command(&document.devices.at[0], rows[i].comment, CM1E_ENI_PS);
        TEST_ASSERT_EQUAL_HEX16(rows[i].reg, command->ado);
        TEST_ASSERT_EQUAL(rows[i].size, command->data.size);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(rows[i].bytes, command->data.data, rows[i].size);
    }
}

/* A slave with device emulation copies the acknowledge bit of AL control to AL status: a check of the error bit after
 * such a request would never hold. Slaves with a mailbox have a processor, but Init is asked before anything is known
 * of them. After a request without the bit, an error has to be seen. */
static void test_checks_of_a_state_go_with_what_was_requested(void)
{
    for (size_t n = 0; n < ENI_NETWORKS; n++) {
        make(&eni_networks[n]);
        for (size_t d = 0; d < document.devices.count; d++) {
            const cm1e_eni_command_list_t *list = &document.devices.at[d].commands;
            uint8_t requested[16] = {0}, checks = 0; /* AL control by transition (its bit) */
            for (size_t i = 0; i < list->count; i++) {
                const cm1e_eni_command_t *command = &list->at[i];
                for (unsigned t = 0; t < 16; t++) {
                    if (!(command->transitions & 1u << t))
                        continue;
                    if (command->ado == 0x0120)
                        requested[t] = command->data.data[0];
                    if (command->ado != 0x0130)
                        continue;
                    checks++;
                    TEST_ASSERT_EQUAL_HEX8(requested[t] & 0x0F, command->expected.data[0]);
                    const bool forward = command->count == 1, processor = document.devices.at[d].mailbox.present;
                    const bool may_copy = requested[t] & 0x10 && (requested[t] == 0x11 || !processor);
                    TEST_ASSERT_EQUAL_HEX8(forward && !may_copy ? 0x1F : 0x0F, command->mask.data[0]);
                }
            }
            TEST_ASSERT_GREATER_OR_EQUAL_UINT8(9, checks);
        }
        tearDown();
    }
}

static void test_start_up_commands_of_the_description_go_through_the_mailbox(void)
{
    make(&eni_networks[ENI_ONE]);
    const cm1e_eni_mailbox_t *mailbox = &document.devices.at[0].mailbox;
    TEST_ASSERT_TRUE(mailbox->coe && mailbox->foe && mailbox->has_bootstrap);
    TEST_ASSERT_EQUAL(described.devices.at[0].init_commands.count, mailbox->sdos.count);
    for (size_t i = 0; i < mailbox->sdos.count; i++) {
        const cm1e_eni_sdo_t *sdo = &mailbox->sdos.at[i];
        TEST_ASSERT_EQUAL_HEX16(CM1E_ENI_PS, sdo->transitions);
        TEST_ASSERT_EQUAL(1, sdo->specifier);
        TEST_ASSERT_TRUE(sdo->timeout_ms > 0 && sdo->data.size > 0);
    }
    const cm1e_eni_sdo_t *mode = &mailbox->sdos.at[mailbox->sdos.count - 1];
    TEST_ASSERT_EQUAL_HEX16(0x6060, mode->index);
    TEST_ASSERT_EQUAL(8, mode->data.data[0]);
}

static void test_an_io_module_has_no_mailbox_and_no_sdo(void)
{
    make(&eni_networks[ENI_MIXED]);
    const cm1e_eni_device_t *io = &document.devices.at[1];
    TEST_ASSERT_FALSE(io->mailbox.present);
    TEST_ASSERT_EQUAL(0, io->sync_managers.at[0].number);
    find_command(io, "set sm 0 (outputs)", CM1E_ENI_PS);
    find_command(io, "set sm 1 (inputs)", CM1E_ENI_PS);
}

static void test_variables_lie_where_their_slaves_data_do(void)
{
    make(&eni_networks[ENI_MIXED]);
    const cm1e_eni_image_t *images[] = {&document.outputs, &document.inputs};
    for (int n = 0; n < 2; n++)
        for (size_t i = 0; i < images[n]->variables.count; i++) {
            const cm1e_eni_variable_t *variable = &images[n]->variables.at[i];
            const cm1e_eni_device_t *device = NULL;
            for (size_t d = 0; d < document.devices.count; d++)
                if (strncmp(variable->name, document.devices.at[d].name, strlen(document.devices.at[d].name)) == 0)
                    device = &document.devices.at[d];
            TEST_ASSERT_NOT_NULL(device);
            const cm1e_eni_range_t *range = n == 0 ? &device->send : &device->receive;
            TEST_ASSERT_TRUE(variable->offset >= range->start);
            TEST_ASSERT_TRUE(variable->offset + variable->bits <= range->start + range->length);
            for (size_t j = 0; j < i; j++)
                TEST_ASSERT_TRUE(strcmp(variable->name, images[n]->variables.at[j].name) != 0);
        }
}

/* Three motors; the slave controller of the middle one cannot do LRW. */
static void test_a_slave_without_lrw_has_commands_of_its_own(void)
{
    static const struct {
        uint8_t code;
        uint32_t address, length;
        int32_t count;
    } rows[] = {{CM1E_ENI_LRW, 0x01000000, 21, 3}, {CM1E_ENI_LWR, 0x01000015, 13, 1}, {CM1E_ENI_LRD, 0x01000022, 21, 1},
                {CM1E_ENI_LRW, 0x01000037, 21, 3}, {CM1E_ENI_BRD, 0, 2, 3}};
    enum { COMMANDS = sizeof rows / sizeof rows[0] };
    static const char *const names[] = {"a", "b", "c"};
    const cm1e_device_options_t options = {0};
    cm1e_eni_slave_t slaves[3];
    for (int i = 0; i < 3; i++)
        TEST_ASSERT_EQUAL(CM1E_OK, cm1e_describe(&described, &options, CM1E_ESI_FLAT, &diag));
    described.devices.at[1].no_lrw = true;
    for (int i = 0; i < 3; i++)
        slaves[i] = (cm1e_eni_slave_t){.device = &described.devices.at[i], .name = names[i]};
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, cm1e_eni_make(&document, slaves, 3, 1000000, &diag), diag.text);
    const cm1e_eni_command_list_t *list = &document.cyclics.at[0].frames.at[0].commands;
    TEST_ASSERT_EQUAL(1, document.cyclics.at[0].frames.count);
    TEST_ASSERT_EQUAL(COMMANDS, list->count);
    for (uint32_t i = 0, at = 16; i < COMMANDS; at += rows[i++].length + 12) {
        TEST_ASSERT_EQUAL(rows[i].code, list->at[i].code);
        TEST_ASSERT_EQUAL_HEX32(rows[i].address, list->at[i].address);
        TEST_ASSERT_EQUAL(rows[i].length, list->at[i].length);
        TEST_ASSERT_EQUAL(rows[i].count, list->at[i].count);
        TEST_ASSERT_EQUAL(at, list->at[i].input_offset);
    }
    const cm1e_eni_device_t *middle = &document.devices.at[1];
    TEST_ASSERT_EQUAL_HEX32(0x01000015,
                            cm1e_get_u32(find_command(middle, "set fmmu 0 (outputs)", CM1E_ENI_PS)->data.data));
    TEST_ASSERT_EQUAL_HEX32(0x01000022, cm1e_get_u32(find_command(middle, "set fmmu 1 (inputs)", CM1E_ENI_PS)->data.data));
    TEST_ASSERT_EQUAL((list->at[1].input_offset + 10) * 8, middle->send.start);
    TEST_ASSERT_EQUAL((list->at[2].input_offset + 10) * 8, middle->receive.start);
    cm1e_findings_t *findings = cm1e_findings_create();
    cm1e_eni_check(findings, &document);
    TEST_ASSERT_EQUAL(0, cm1e_findings_count(findings));
    cm1e_findings_free(findings);
}

static void test_the_alias_is_asked_for(void)
{
    static const eni_network_t network = {.slaves = {ENI_CM1E}, .count = 1, .alias = 7};
    make(&network);
    const cm1e_eni_command_t *check = find_command(&document.devices.at[0], "check station alias", CM1E_ENI_IP);
    TEST_ASSERT_EQUAL_HEX16(0x0012, check->ado);
    TEST_ASSERT_TRUE(check->validates);
    TEST_ASSERT_EQUAL(7, cm1e_get_u16(check->expected.data));
}

/* 1498 bytes of datagrams a frame: 70 axes of 21 bytes are 1470 and an LRW, and leave 16 for 14 of the BRD; the 71st is
 * in the second frame. */
static void test_more_than_a_frame_holds_goes_into_the_next(void)
{
    static const struct {
        size_t axes, frames, commands_of_last;
    } rows[] = {{1, 1, 2}, {70, 1, 2}, {71, 2, 2}, {128, 2, 2}, {512, 8, 2}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        eni_network_t network = {.count = rows[i].axes};
        make(&network);
        const cm1e_eni_cyclic_t *cyclic = &document.cyclics.at[0];
        TEST_ASSERT_EQUAL(rows[i].frames, cyclic->frames.count);
        int32_t counted = 0;
        for (size_t f = 0; f < cyclic->frames.count; f++) {
            const cm1e_eni_frame_t *frame = &cyclic->frames.at[f];
            uint32_t bytes = 0;
            for (size_t c = 0; c < frame->commands.count; c++) {
                const cm1e_eni_command_t *command = &frame->commands.at[c];
                TEST_ASSERT_EQUAL(f * 1536 + 16 + bytes, command->input_offset);
                bytes += command->length + 12;
                counted += command->code == CM1E_ENI_LRW ? command->count : 0;
            }
            TEST_ASSERT_TRUE(bytes <= 1498);
        }
        TEST_ASSERT_EQUAL(3 * rows[i].axes, counted);
        const cm1e_eni_frame_t *last = &cyclic->frames.at[cyclic->frames.count - 1];
        TEST_ASSERT_EQUAL(rows[i].commands_of_last, last->commands.count);
        TEST_ASSERT_EQUAL(rows[i].axes, last->commands.at[last->commands.count - 1].count);
        TEST_ASSERT_EQUAL(rows[i].frames * 1536, document.inputs.bytes);
        tearDown();
    }
}

/* ---- distributed clocks ------------------------------------------------------------------------------------------ */

static const cm1e_eni_command_t *find_of_master(uint16_t ado)
{
    for (size_t i = 0; i < document.commands.count; i++)
        if (document.commands.at[i].ado == ado)
            return &document.commands.at[i];
    return NULL;
}

static bool writes(const cm1e_eni_device_t *device, uint16_t ado)
{
    for (size_t i = 0; i < device->commands.count; i++)
        if (device->commands.at[i].ado == ado)
            return true;
    return false;
}

static void expect_bytes(const cm1e_eni_device_t *device, const char *comment, uint16_t ado, const void *bytes, size_t size)
{
    const cm1e_eni_command_t *command = find_command(device, comment, CM1E_ENI_PS);
    TEST_ASSERT_NOT_NULL_MESSAGE(command, comment);
    TEST_ASSERT_EQUAL_HEX16(ado, command->ado);
    TEST_ASSERT_EQUAL(CM1E_ENI_FPWR, command->code);
    TEST_ASSERT_EQUAL(size, command->data.size);
    TEST_ASSERT_EQUAL_MEMORY(bytes, command->data.data, size);
}

/* The second slave has no clock, the third one is the first with SYNC0. The first clock is the reference. */
static void test_clocks_are_set_up_and_kept_together(void)
{
    static const uint8_t zeros[8], cycles[8] = {0x90, 0xD0, 3, 0, 0x48, 0xE8, 1, 0}, by_both[2] = {0x30, 7};
    TEST_ASSERT_EQUAL(CM1E_OK, eni_describe(&described, ENI_CM1E, &diag));
    const cm1e_description_t *device = &described.devices.at[0];
    const cm1e_eni_slave_t slaves[] = {
        {.device = device, .name = "first", .has_clock = true}, {.device = device, .name = "none"},
        {.device = device, .name = "last", .has_clock = true, .assign_activate = 0x0730,
         .pulses = {.sync0_us = 250, .sync1_us = 125}},
    };
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_eni_make(&document, slaves, 3, 1000000, &diag));
    const cm1e_eni_device_t *devices = document.devices.at;
    TEST_ASSERT_TRUE(devices[0].dc.present && devices[0].dc.reference && devices[0].dc.cycle0_ns == 0);
    TEST_ASSERT_TRUE(!devices[1].dc.present && !writes(&devices[1], 0x0920));
    TEST_ASSERT_TRUE(devices[2].dc.present && !devices[2].dc.reference);
    TEST_ASSERT_EQUAL(250000, devices[2].dc.cycle0_ns);
    TEST_ASSERT_EQUAL(125000, devices[2].dc.cycle1_ns);
    TEST_ASSERT_EQUAL(500000, devices[2].dc.shift_ns); /* half a cycle, as with our own master */
    expect_bytes(&devices[0], "set dc system time offset (of the master)", 0x0920, zeros, 8);
    expect_bytes(&devices[2], "set dc propagation delay (of the master)", 0x0928, zeros, 4);
    expect_bytes(&devices[2], "set dc cycle time", 0x09A0, cycles, 8);
    expect_bytes(&devices[2], "set dc start time (of the master)", 0x0990, zeros, 8);
    expect_bytes(&devices[2], "set dc activation", 0x0980, by_both, 2);
    TEST_ASSERT_FALSE(writes(&devices[0], 0x0980));
    TEST_ASSERT_EQUAL(CM1E_ENI_PS, find_of_master(0x0900)->transitions);
    TEST_ASSERT_TRUE(find_of_master(0x0900)->before_slave);
    const cm1e_eni_frame_t *frame = &document.cyclics.at[0].frames.at[0];
    const cm1e_eni_command_t *time = &frame->commands.at[frame->commands.count - 2];
    TEST_ASSERT_EQUAL(CM1E_ENI_ARMW, time->code);
    TEST_ASSERT_EQUAL_HEX16(devices[0].position, time->adp);
    TEST_ASSERT_EQUAL_HEX16(0x0910, time->ado);
    TEST_ASSERT_EQUAL(CM1E_ENI_PREOP | CM1E_ENI_SAFEOP | CM1E_ENI_OPERATIONAL, time->states);
}

/* ---- what cannot be made ---------------------------------------------------------------------------------------- */

static void refused(const cm1e_eni_slave_t *slaves, size_t count, int64_t cycle_time_ns, const char *what)
{
    TEST_ASSERT_EQUAL(CM1E_ERROR_CONFIG, cm1e_eni_make(&document, slaves, count, cycle_time_ns, &diag));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, what), diag.text);
}

static void test_networks_that_no_file_can_describe_are_refused(void)
{
    TEST_ASSERT_EQUAL(CM1E_OK, eni_describe(&described, ENI_CM1E, &diag));
    const cm1e_eni_slave_t twice[] = {{.device = &described.devices.at[0], .name = "x"},
                                      {.device = &described.devices.at[0], .name = "x"}};
    const cm1e_eni_slave_t nameless = {.device = &described.devices.at[0], .name = ""};
    refused(twice, 0, 1000000, "1 to 512");
    refused(twice, 2, 1000000, "twice");
    refused(&nameless, 1, 1000000, "name");
    refused(twice, 1, 1500, "microseconds");
    refused(twice, 1, 0, "microseconds");
    cm1e_description_t large = described.devices.at[0];
    large.pdos = (cm1e_pdo_list_t){0};
    cm1e_described_pdo_t *pdo = CM1E_APPEND(&described.arena, &large.pdos);
    pdo->sync_manager = 2;
    cm1e_described_pdo_entry_t *entry = CM1E_APPEND(&described.arena, &pdo->entries);
    entry->index = 0x7000;
    entry->bits = 1487 * 8;
    const cm1e_eni_slave_t too_large = {.device = &large, .name = "x"};
    refused(&too_large, 1, 1000000, "1486");
    /* Two sync managers of one direction count together. */
    large.sync_managers.at = NULL;
    large.sync_managers.count = 0;
    for (int n = 0; n < 4; n++) {
        cm1e_described_sync_manager_t *manager = CM1E_APPEND(&described.arena, &large.sync_managers);
        *manager = (cm1e_described_sync_manager_t){.use = CM1E_SM_OUTPUTS, .enable = 1};
    }
    entry->bits = 1000 * 8;
    const cm1e_described_pdo_t first = large.pdos.at[0];
    pdo = CM1E_APPEND(&described.arena, &large.pdos);
    *pdo = first;
    pdo->sync_manager = 3;
    refused(&too_large, 1, 1000000, "1486");
    large.pdos.count = 0;
    while (large.sync_managers.count < 17)
        CM1E_APPEND(&described.arena, &large.sync_managers);
    refused(&too_large, 1, 1000000, "16 sync managers");
}

static void test_the_same_names_of_entries_get_numbers(void)
{
    TEST_ASSERT_EQUAL(CM1E_OK, eni_describe(&described, ENI_CM1E, &diag));
    cm1e_description_t device = described.devices.at[0];
    device.pdos = (cm1e_pdo_list_t){0};
    cm1e_described_pdo_t *pdo = CM1E_APPEND(&described.arena, &device.pdos);
    *pdo = (cm1e_described_pdo_t){.index = 0x1600, .sync_manager = 2, .name = ""};
    for (int i = 0; i < 3; i++) {
        cm1e_described_pdo_entry_t *entry = CM1E_APPEND(&described.arena, &pdo->entries);
        *entry = (cm1e_described_pdo_entry_t){.index = 0x7000, .subindex = 1, .bits = 8, .type = ""};
    }
    const cm1e_eni_slave_t slave = {.device = &device, .name = "x"};
    TEST_ASSERT_EQUAL(CM1E_OK, cm1e_eni_make(&document, &slave, 1, 1000000, &diag));
    TEST_ASSERT_EQUAL_STRING("x.0x1600.0x7000:01", document.outputs.variables.at[0].name);
    TEST_ASSERT_EQUAL_STRING("x.0x1600.0x7000:01 (2)", document.outputs.variables.at[1].name);
    TEST_ASSERT_EQUAL_STRING("x.0x1600.0x7000:01 (3)", document.outputs.variables.at[2].name);
}

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_networks_match_their_golden_files);
    RUN_TEST(test_what_was_written_comes_back_as_it_was);
    RUN_TEST(test_a_bus_file_gives_the_network_of_its_axes);
    RUN_TEST(test_slaves_are_addressed_in_the_order_of_the_wire);
    RUN_TEST(test_registers_of_a_cm1e);
    RUN_TEST(test_checks_of_a_state_go_with_what_was_requested);
    RUN_TEST(test_start_up_commands_of_the_description_go_through_the_mailbox);
    RUN_TEST(test_an_io_module_has_no_mailbox_and_no_sdo);
    RUN_TEST(test_variables_lie_where_their_slaves_data_do);
    RUN_TEST(test_clocks_are_set_up_and_kept_together);
    RUN_TEST(test_a_slave_without_lrw_has_commands_of_its_own);
    RUN_TEST(test_the_alias_is_asked_for);
    RUN_TEST(test_more_than_a_frame_holds_goes_into_the_next);
    RUN_TEST(test_axes_behind_a_bridge_are_one_slave);
    RUN_TEST(test_the_bridge_is_the_stated_one_that_has_the_motors);
    RUN_TEST(test_identity_of_a_bridge_has_to_be_stated);
    RUN_TEST(test_every_axis_has_process_data_in_its_bridge);
    RUN_TEST(test_what_a_file_of_the_bus_file_alone_leaves_out_is_a_warning);
    RUN_TEST(test_places_that_do_not_follow_are_refused);
    RUN_TEST(test_networks_that_no_file_can_describe_are_refused);
    RUN_TEST(test_the_same_names_of_entries_get_numbers);
    return UNITY_END();
}
