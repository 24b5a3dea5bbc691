/* Files beside live devices: what the generator writes for a device differs in nothing from the simulated one, in every
 * variant of it; and what is changed in a file, or in a device, is found. */
#include <time.h>

#include "bus_support.h"
#include "cm1e/generate.h"
#include "cm1e/sdo_info.h"
#include "cm1e/sii.h"
#include "description/check.h"
#include "device/bridge_facts.h"
#include "generate/live.h"
#include "sim/esc_chip.h"

static cm1e_findings_t *findings;

static void generate(cm1e_file_t *file, cm1e_file_format_t format, const char *firmware)
{
    cm1e_device_options_t device = {.order = tested_order()};
    snprintf(device.firmware, sizeof device.firmware, "%s", firmware);
    const cm1e_generate_options_t options = {.format = format, .devices = &device, .device_count = 1,
                                             .network = &config};
    ck_assert_msg(cm1e_generate(file, &options, &diag) == CM1E_OK, "%s", diag.text);
}

static void compare(cm1e_bus_t *bus, uint16_t position, const void *bytes, size_t size)
{
    const cm1e_error_t error = cm1e_diff_file(&findings, bytes, size, bus, position, &diag);
    ck_assert_msg(error == CM1E_OK, "%s: %s", cm1e_strerror(error), diag.text);
}

static const char *first_text(void)
{
    static char text[1200];
    snprintf(text, sizeof text, "%zu findings", cm1e_findings_count(findings));
    if (cm1e_findings_count(findings) > 0)
        snprintf(text, sizeof text, "line %u: %s [%s]", cm1e_findings_at(findings, 0)->line,
                 cm1e_findings_at(findings, 0)->text, cm1e_findings_at(findings, 0)->rule);
    return text;
}

static void check_no_finding(void)
{
    ck_assert_msg(cm1e_findings_count(findings) == 0, "%s", first_text());
    cm1e_findings_free(findings);
}

/* ---- no difference ---------------------------------------------------------------------------------------------- */

static const cm1e_file_format_t formats[] = {CM1E_FILE_ESI, CM1E_FILE_SII, CM1E_FILE_EC_EXTEND, CM1E_FILE_ENI};

START_TEST(a_file_of_every_format_that_is_made_for_the_device_differs_in_nothing)
{
    cm1e_bus_t *bus = open_scanned_bus(2);
    cm1e_file_t file = {0};
    generate(&file, formats[_i], tested_firmware());
    compare(bus, 2, file.bytes, file.size);
    check_no_finding();
    cm1e_file_free(&file);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(the_esi_of_every_firmware_differs_in_nothing)
{
    sim_config(CM1E_FIRMWARE_COUNT);
    for (int f = 0; f < CM1E_FIRMWARE_COUNT; f++)
        snprintf(config.axes[f].firmware, sizeof config.axes[f].firmware, "%s",
                 cm1e_firmware_info((cm1e_firmware_t)f)->version);
    cm1e_bus_t *bus = open_bus();
    ck_assert_int_eq(cm1e_bus_scan(bus, &diag), CM1E_OK);
    for (int f = 0; f < CM1E_FIRMWARE_COUNT; f++) {
        cm1e_file_t file = {0};
        generate(&file, CM1E_FILE_ESI, config.axes[f].firmware);
        compare(bus, (uint16_t)(f + 1), file.bytes, file.size);
        check_no_finding();
        cm1e_file_free(&file);
    }
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(the_sii_of_the_device_itself_differs_in_nothing)
{
    static uint8_t image[4096];
    size_t size = sizeof image;
    cm1e_bus_t *bus = open_scanned_bus(1);
    ck_assert_int_eq(cm1e_sii_read_device(bus, 1, image, &size, &diag), CM1E_OK);
    compare(bus, 1, image, size);
    check_no_finding();
    cm1e_bus_close(bus);
}
END_TEST

/* Bridges that no file describes wrongly: every model in every format, and in both layouts of an ESI. */
static cm1e_bus_t *bridged_bus(cm1e_device_model_t model)
{
    sim_config(CM1E_BRIDGE_AXES);
    for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++) {
        cm1e_axis_config_t *axis = &config.axes[i];
        axis->firmware[0] = 0;
        axis->address = 1;
        axis->channel = (uint8_t)(i + 1);
        axis->k37 = 10;
        axis->k37_stated = true;
        snprintf(axis->motor, sizeof axis->motor, "%s", cm1e_bridge_motor_name(cm1e_bridge_motor(model, i)));
    }
    cm1e_bus_t *bus = open_bus();
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    return bus;
}

static void generate_for_bridge(cm1e_file_t *file, cm1e_device_model_t model, cm1e_file_format_t format,
                                cm1e_esi_layout_t layout)
{
    const cm1e_device_options_t device = {.model = model, .vendor_id = CM1E_SIM_BRIDGE_VENDOR_ID,
                                          .product_code = cm1e_sim_bridge_product_code(model),
                                          .revision = CM1E_SIM_BRIDGE_REVISION};
    const cm1e_generate_options_t options = {.format = format, .layout = layout, .devices = &device,
                                             .device_count = 1, .network = &config};
    ck_assert_msg(cm1e_generate(file, &options, &diag) == CM1E_OK, "%s", diag.text);
}

START_TEST(a_file_of_every_format_that_is_made_for_a_bridge_differs_in_nothing)
{
    const cm1e_device_model_t model = (cm1e_device_model_t)(CM1E_DEVICE_EB01 + _i);
    cm1e_bus_t *bus = bridged_bus(model);
    cm1e_file_t file = {0};
    for (size_t f = 0; f < sizeof formats / sizeof formats[0]; f++) {
        generate_for_bridge(&file, model, formats[f], CM1E_ESI_FLAT);
        compare(bus, 1, file.bytes, file.size);
        check_no_finding();
        cm1e_file_free(&file);
    }
    generate_for_bridge(&file, model, CM1E_FILE_ESI, CM1E_ESI_MDP);
    compare(bus, 1, file.bytes, file.size);
    check_no_finding();
    cm1e_file_free(&file);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(the_eni_of_a_scan_is_that_of_the_configuration_of_a_bridge)
{
    const cm1e_device_model_t model = (cm1e_device_model_t)(CM1E_DEVICE_EB01 + _i);
    cm1e_bus_t *bus = bridged_bus(model);
    cm1e_file_t configured = {0}, scanned = {0};
    generate_for_bridge(&configured, model, CM1E_FILE_ENI, CM1E_ESI_FLAT);
    ck_assert_int_eq(cm1e_generate_eni_of_bus(&scanned, bus, CM1E_MAPPING_DYNAMIC, &diag), CM1E_OK);
    ck_assert_uint_eq(scanned.size, configured.size);
    ck_assert(!memcmp(scanned.bytes, configured.bytes, scanned.size));
    cm1e_file_free(&configured);
    cm1e_file_free(&scanned);
    cm1e_bus_close(bus);
}
END_TEST

static bool contains(const cm1e_file_t *file, const char *text)
{
    return memmem(file->bytes, file->size, text, strlen(text)) != NULL;
}

START_TEST(the_eni_of_a_scan_has_the_protocols_of_the_sii)
{
    enum { PROTOCOLS = 0x38, FOE = 0x08 };
    cm1e_bus_t *bus = open_scanned_bus(1);
    cm1e_file_t file = {0};
    cm1e_sim_slave_t *slave = cm1e_sim_segment_slave(segment_of(bus), 1);
    const bool has_foe = slave->sii[PROTOCOLS] & FOE;
    ck_assert_int_eq(cm1e_generate_eni_of_bus(&file, bus, CM1E_MAPPING_DYNAMIC, &diag), CM1E_OK);
    ck_assert(has_foe == contains(&file, "<Protocol>FoE</Protocol>"));
    cm1e_file_free(&file);
    slave->sii[PROTOCOLS] &= (uint8_t)~FOE;
    ck_assert_int_eq(cm1e_generate_eni_of_bus(&file, bus, CM1E_MAPPING_DYNAMIC, &diag), CM1E_OK);
    ck_assert(contains(&file, "<Protocol>CoE</Protocol>"));
    ck_assert(!contains(&file, "FoE") && !contains(&file, "Bootstrap"));
    cm1e_file_free(&file);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(the_eni_of_a_scan_is_that_of_the_configuration_of_motors_with_aliases)
{
    sim_config(2);
    for (unsigned i = 0; i < 2; i++) {
        config.axes[i].address_kind = CM1E_ADDRESS_ALIAS;
        config.axes[i].address = (uint16_t)(77 + i);
    }
    cm1e_bus_t *bus = open_bus();
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    const cm1e_generate_options_t options = {.format = CM1E_FILE_ENI, .network = &config};
    cm1e_file_t configured = {0}, scanned = {0};
    ck_assert_msg(cm1e_generate(&configured, &options, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_generate_eni_of_bus(&scanned, bus, CM1E_MAPPING_DYNAMIC, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert(contains(&scanned, "check station alias"));
    ck_assert_uint_eq(scanned.size, configured.size);
    ck_assert(!memcmp(scanned.bytes, configured.bytes, scanned.size));
    cm1e_file_free(&configured);
    cm1e_file_free(&scanned);
    cm1e_bus_close(bus);
}
END_TEST

/* The drive has 0x1600 and 0x1A00 assigned itself. */
START_TEST(the_eni_of_a_scan_has_the_pdos_that_the_bus_file_names_for_a_drive)
{
    sim_config(1);
    cm1e_axis_config_t *axis = &config.axes[0];
    axis->firmware[0] = 0;
    strcpy(axis->device, "cia402");
    axis->counts_per_revolution = 131072;
    axis->max_speed_rpm = 3000;
    axis->outputs_pdo = 0x1601;
    axis->inputs_pdo = 0x1A01;
    cm1e_bus_t *bus = open_bus();
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_file_t file = {0};
    ck_assert_msg(cm1e_generate_eni_of_bus(&file, bus, CM1E_MAPPING_DYNAMIC, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert(contains(&file, "<Pdo>5633</Pdo>") && contains(&file, "<Pdo>6657</Pdo>")); /* in the sync managers */
    ck_assert(!contains(&file, "<Pdo>5632</Pdo>") && !contains(&file, "<Pdo>6656</Pdo>"));
    ck_assert(contains(&file, "<Data>0116</Data>") && contains(&file, "<Data>011A</Data>")); /* assigned by SDO */
    ck_assert(contains(&file, "<DataLength>12</DataLength>")); /* of the LRW: the inputs are longer */
    ck_assert(contains(&file, "<Index>24672</Index>")); /* 0x6060, which 0x1601 does not have */
    cm1e_file_free(&file);
    cm1e_bus_close(bus);
}
END_TEST

static cm1e_slave_config_t *add_slave(cm1e_bus_config_t *to, const char *name, cm1e_address_kind_t kind,
                                      uint16_t address, uint8_t outputs)
{
    cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(to, name);
    slave->address_kind = kind;
    slave->address = address;
    slave->vendor = 0x2;
    slave->product = 0x1000u + outputs;
    slave->sim.kind = outputs ? CM1E_SIM_SLAVE_DIGITAL : CM1E_SIM_SLAVE_COUPLER;
    slave->sim.outputs = outputs;
    return slave;
}

/* On the wire: an optional motor, a motor, a group of two slaves, a motor. A position of the configuration counts without
 * the optional ones, and that of a member of a group counts in the group. */
START_TEST(the_eni_of_a_scan_knows_the_others_beside_optional_slaves)
{
    static const char *const names[] = {"lift", "Y", "changer", "fingers", "Z"};
    static cm1e_bus_config_t wire;
    cm1e_bus_config_init(&wire, "sim", 3);
    wire.axes[0].address_kind = CM1E_ADDRESS_ALIAS;
    wire.axes[0].address = 7;
    wire.axes[1].address = 2;
    wire.axes[2].address = 5;
    add_slave(&wire, "a", CM1E_ADDRESS_ALIAS, 4711, 0);
    add_slave(&wire, "b", CM1E_ADDRESS_POSITION, 4, 3);
    sim_config(3);
    const uint16_t addresses[] = {7, 1, 2};
    for (int i = 0; i < 3; i++) {
        config.axes[i].address_kind = i ? CM1E_ADDRESS_POSITION : CM1E_ADDRESS_ALIAS;
        config.axes[i].address = addresses[i];
        config.axes[i].optional = i == 0;
        snprintf(config.axes[i].name, sizeof config.axes[i].name, "%s", i == 0 ? "lift" : i == 1 ? "Y" : "Z");
    }
    snprintf(add_slave(&config, "changer", CM1E_ADDRESS_ALIAS, 4711, 0)->hot_connect, CM1E_NAME_LENGTH, "gripper");
    snprintf(add_slave(&config, "fingers", CM1E_ADDRESS_POSITION, 2, 3)->hot_connect, CM1E_NAME_LENGTH, "gripper");
    cm1e_bus_t *bus = open_bus_on(&wire);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_file_t file = {0};
    ck_assert_msg(cm1e_generate_eni_of_bus(&file, bus, CM1E_MAPPING_DYNAMIC, &diag) == CM1E_OK, "%s", diag.text);
    const char *at = (const char *)file.bytes;
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        char element[40];
        snprintf(element, sizeof element, "<Slave>\n      <Info>\n        <Name>%s</Name>", names[i]);
        at = strstr(at, element);
        ck_assert_msg(at != NULL, "slave %zu is not %s", i + 1, names[i]);
    }
    cm1e_file_free(&file);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&wire);
}
END_TEST

/* Devices with a sync manager that carries nothing: one has inputs only, one outputs only. */
START_TEST(the_eni_of_a_scan_of_terminals_differs_in_nothing)
{
    sim_config(1);
    for (uint16_t place = 2; place <= 4; place++) {
        char name[8];
        snprintf(name, sizeof name, "s%u", place);
        cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(&config, name);
        slave->address = place;
        slave->sim.kind = place == 4 ? CM1E_SIM_SLAVE_DIGITAL : CM1E_SIM_SLAVE_ANALOG;
        slave->sim.inputs = place != 3;
        slave->sim.outputs = place != 2;
    }
    cm1e_bus_t *bus = open_bus();
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_file_t file = {0};
    ck_assert_msg(cm1e_generate_eni_of_bus(&file, bus, CM1E_MAPPING_DYNAMIC, &diag) == CM1E_OK, "%s", diag.text);
    for (uint16_t place = 1; place <= 4; place++) {
        compare(bus, place, file.bytes, file.size);
        check_no_finding();
    }
    cm1e_file_free(&file);
    cm1e_bus_close(bus);
}
END_TEST

static void compare_modular(cm1e_bus_t *bus, const char *firmware)
{
    cm1e_file_t file = {0};
    cm1e_device_options_t device = {.order = tested_order()};
    snprintf(device.firmware, sizeof device.firmware, "%s", firmware);
    const cm1e_generate_options_t options = {.format = CM1E_FILE_ESI, .layout = CM1E_ESI_MDP, .devices = &device,
                                             .device_count = 1};
    ck_assert_msg(cm1e_generate(&file, &options, &diag) == CM1E_OK, "%s", diag.text);
    compare(bus, 1, file.bytes, file.size);
    cm1e_file_free(&file);
}

START_TEST(a_modular_file_differs_in_nothing)
{
    cm1e_bus_t *bus = open_scanned_bus(1);
    compare_modular(bus, tested_firmware());
    check_no_finding();
    cm1e_bus_close(bus);
}
END_TEST

/* ---- differences ------------------------------------------------------------------------------------------------ */

static bool has(const char *rule, const char *words)
{
    for (size_t i = 0; i < cm1e_findings_count(findings); i++)
        if (strcmp(cm1e_findings_at(findings, i)->rule, rule) == 0 &&
            strstr(cm1e_findings_at(findings, i)->text, words))
            return true;
    return false;
}

/** Also in a module that nobody has chosen. */
START_TEST(a_modular_file_for_another_firmware_differs_in_its_modules)
{
    cm1e_bus_t *bus = open_scanned_bus(1);
    compare_modular(bus, strcmp(tested_firmware(), "1.2.0") == 0 ? "1.3.5" : "1.2.0");
    ck_assert_msg(has("differs-identity", "revision") && has("differs-pdo", "RxPDO 0x1603"), "%s", first_text());
    cm1e_findings_free(findings);
    cm1e_bus_close(bus);
}
END_TEST

/** Changes the ESI of the device at the first place where `old` stands, to a text of the same length. */
static void compare_changed(cm1e_bus_t *bus, const char *old, const char *changed)
{
    cm1e_file_t file = {0};
    generate(&file, CM1E_FILE_ESI, tested_firmware());
    char *at = strstr((char *)file.bytes, old);
    ck_assert_msg(at != NULL && strlen(old) == strlen(changed), "%s", old);
    memcpy(at, changed, strlen(changed));
    compare(bus, 1, file.bytes, file.size);
    unsigned line = 1;
    for (const char *c = (char *)file.bytes; c < at; c++)
        line += *c == '\n';
    bool there = false;
    for (size_t i = 0; i < cm1e_findings_count(findings); i++)
        there |= cm1e_findings_at(findings, i)->line + 12 > line && cm1e_findings_at(findings, i)->line <= line;
    ck_assert_msg(there, "%s -> %s in line %u: %s", old, changed, line, first_text());
    cm1e_file_free(&file);
}

static const struct {
    const char *old, *changed, *rule, *words;
} changes[] = {
    {"StartAddress=\"#x1100\"", "StartAddress=\"#x1180\"", "differs-sync-manager", "0x1180"},
    {"ControlByte=\"#x64\"", "ControlByte=\"#x24\"", "differs-sync-manager", "0x24"},
    {"<Index>#x607A</Index>", "<Index>#x607F</Index>", "differs-", "0x607F"},
};

START_TEST(what_is_changed_in_a_file_is_found_in_its_line)
{
    cm1e_bus_t *bus = open_scanned_bus(1);
    for (size_t i = 0; i < sizeof changes / sizeof changes[0]; i++) {
        compare_changed(bus, changes[i].old, changes[i].changed);
        bool found = has(changes[i].rule, changes[i].words);
        if (strcmp(changes[i].rule, "differs-") == 0)
            found = has("differs-pdo", changes[i].words) || has("differs-object", changes[i].words);
        ck_assert_msg(found, "%s: %s", changes[i].changed, first_text());
        cm1e_findings_free(findings);
    }
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(a_file_for_another_firmware_differs_in_revision_and_dictionary)
{
    cm1e_bus_t *bus = open_scanned_bus(1);
    cm1e_file_t file = {0};
    const bool old = strcmp(tested_firmware(), "1.2.0") == 0;
    generate(&file, CM1E_FILE_ESI, old ? "1.3.5" : "1.2.0");
    compare(bus, 1, file.bytes, file.size);
    ck_assert_msg(has("differs-identity", "revision"), "%s", first_text());
    ck_assert_msg(has("differs-object", "0x2201"), "%s", first_text());
    ck_assert_msg(has("differs-pdo", "0x1603"), "%s", first_text());
    cm1e_findings_free(findings);
    cm1e_file_free(&file);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(a_file_with_other_revisions_names_them)
{
    cm1e_bus_t *bus = open_scanned_bus(1);
    cm1e_file_t file = {0};
    const cm1e_device_options_t devices[2] = {{.firmware = "1.2.0", .order = tested_order()},
                                              {.firmware = "1.3.5", .order = tested_order()}};
    const cm1e_generate_options_t options = {.format = CM1E_FILE_ESI, .devices = devices, .device_count = 2};
    ck_assert_msg(cm1e_generate(&file, &options, &diag) == CM1E_OK, "%s", diag.text);
    compare(bus, 1, file.bytes, file.size); /* the right one is chosen */
    check_no_finding();
    cm1e_put_u32(cm1e_sim_segment_slave(segment_of(bus), 1)->sii + 0x18, 0x20029999);
    compare(bus, 1, file.bytes, file.size);
    ck_assert_msg(has("differs-identity", "it has 0x20020001, 0x20020103"), "%s", first_text());
    ck_assert_msg(has("differs-identity", "The device contradicts itself: the revision is 0x20029999"), "%s",
                  first_text());
    cm1e_findings_free(findings);
    cm1e_file_free(&file);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(the_other_order_of_the_mappings_is_found)
{
    cm1e_bus_t *bus = open_scanned_bus(1);
    cm1e_file_t file = {0};
    cm1e_device_options_t device = {.order = tested_order() == CM1E_PDO_ORDER_UG_4_4 ? CM1E_PDO_ORDER_UG_7_2
                                                                                    : CM1E_PDO_ORDER_UG_4_4};
    snprintf(device.firmware, sizeof device.firmware, "%s", tested_firmware());
    const cm1e_generate_options_t options = {.format = CM1E_FILE_ESI, .devices = &device, .device_count = 1};
    ck_assert_int_eq(cm1e_generate(&file, &options, &diag), CM1E_OK);
    compare(bus, 1, file.bytes, file.size);
    ck_assert_msg(has("differs-pdo", "RxPDO 0x1600"), "%s", first_text());
    cm1e_findings_free(findings);
    cm1e_file_free(&file);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(another_assignment_is_a_warning)
{
    static const uint8_t csp[] = {0x01, 0x16}, zero[] = {0}, one[] = {1};
    cm1e_bus_t *bus = open_scanned_bus(1);
    cm1e_file_t file = {0};
    generate(&file, CM1E_FILE_ESI, tested_firmware());
    ck_assert_int_eq(cm1e_sdo_write(bus, 1, 0x1C12, 0, zero, 1, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_sdo_write(bus, 1, 0x1C12, 1, csp, 2, &diag), CM1E_OK);
    ck_assert_int_eq(cm1e_sdo_write(bus, 1, 0x1C12, 0, one, 1, &diag), CM1E_OK);
    compare(bus, 1, file.bytes, file.size);
    ck_assert_uint_eq(cm1e_findings_count(findings), 2);
    ck_assert(has("differs-assignment", "0x1600 is assigned by default") && has("differs-assignment", "0x1601"));
    ck_assert(!cm1e_findings_at(findings, 0)->is_error);
    cm1e_findings_free(findings);
    cm1e_file_free(&file);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(a_file_about_something_else_is_not_compared)
{
    static const char text[] = "this is no file", other[] = "<EtherCATInfo><Vendor><Id>1</Id></Vendor></EtherCATInfo>";
    cm1e_bus_t *bus = open_scanned_bus(1);
    ck_assert_int_eq(cm1e_diff_file(&findings, text, sizeof text - 1, bus, 1, &diag), CM1E_ERROR_FILE);
    ck_assert_ptr_null(findings);
    ck_assert_int_ne(cm1e_diff_file(&findings, other, sizeof other - 1, bus, 1, &diag), CM1E_OK);
    cm1e_file_t file = {0};
    generate(&file, CM1E_FILE_ESI, tested_firmware());
    ck_assert_int_ne(cm1e_diff_file(&findings, file.bytes, file.size, bus, 2, &diag), CM1E_OK);
    ck_assert_ptr_nonnull(strstr(diag.text, "no slave 2"));
    cm1e_sim_segment_slave(segment_of(bus), 1)->sii[0x14] ^= 1; /* another product */
    ck_assert_int_eq(cm1e_diff_file(&findings, file.bytes, file.size, bus, 1, &diag), CM1E_ERROR_NOT_FOUND);
    ck_assert_ptr_nonnull(strstr(diag.text, "does not describe"));
    cm1e_file_free(&file);
    generate(&file, CM1E_FILE_EC_EXTEND, tested_firmware());
    ck_assert_int_eq(cm1e_diff_file(&findings, file.bytes, file.size, bus, 1, &diag), CM1E_ERROR_NOT_FOUND);
    cm1e_file_free(&file);
    cm1e_bus_close(bus);
    bus = open_scanned_bus(2);
    config.axis_count = 1; /* a network of one slave */
    generate(&file, CM1E_FILE_ENI, tested_firmware());
    ck_assert_int_eq(cm1e_diff_file(&findings, file.bytes, file.size, bus, 2, &diag), CM1E_ERROR_NOT_FOUND);
    ck_assert_ptr_nonnull(strstr(diag.text, "none at position 2"));
    cm1e_file_free(&file);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- the device as a description --------------------------------------------------------------------------------- */

START_TEST(the_live_device_is_described_by_what_it_tells)
{
    cm1e_bus_t *bus = open_scanned_bus(1);
    cm1e_description_file_t file = {0};
    findings = cm1e_findings_create();
    ck_assert_msg(cm1e_live_describe(&file, bus, 1, findings, &diag) == CM1E_OK, "%s", diag.text);
    check_no_finding();
    const cm1e_description_t *device = &file.devices.at[0];
    ck_assert_uint_eq(device->pdos.count, 8);
    ck_assert_int_eq(cm1e_description_pdo(device, 0x1600)->sync_manager, 2);
    ck_assert_int_eq(cm1e_description_pdo(device, 0x1A00)->sync_manager, 3);
    ck_assert_int_eq(cm1e_description_pdo(device, 0x1A01)->sync_manager, CM1E_NO_SYNC_MANAGER);
    const cm1e_described_entry_t *entry = cm1e_description_entry(device, 0x1C12, 1);
    ck_assert_uint_eq(entry->access, CM1E_ACCESS_READ | CM1E_ACCESS_WRITE | CM1E_ACCESS_WRITE_PREOP_ONLY);
    ck_assert_str_eq(cm1e_description_entry(device, 0x6060, 0)->type, "SINT");
    cm1e_entry_info_t info; /* a range, and a default value */
    ck_assert_int_eq(cm1e_sdo_info_entry(bus, 1, 0x6060, 0, &info, &diag), CM1E_OK);
    entry = cm1e_description_entry(device, 0x6060, 0);
    ck_assert(info.minimum.size == 1 && info.maximum.size == 1 && info.minimum.bytes[0] != info.maximum.bytes[0]);
    ck_assert(entry->minimum.size == 1 && entry->minimum.data[0] == info.minimum.bytes[0]);
    ck_assert(entry->maximum.size == 1 && entry->maximum.data[0] == info.maximum.bytes[0]);
    ck_assert_uint_eq(entry->default_data.size, info.default_value.size);
    cm1e_description_file_free(&file);
    cm1e_bus_close(bus);
}
END_TEST

/** SDO information is asked for in a service that there is not: a device that has none. */
static cm1e_tap_verdict_t no_information(void *context, cm1e_tap_frame_t *frame)
{
    enum { DATA = 26, COE = DATA + 6 };
    (void)context;
    if (frame->direction == CM1E_TAP_SENT && frame->bytes[16] == 5 /* FPWR */ && frame->length > COE + 2 &&
        cm1e_get_u16(frame->bytes + 22) == 128 && cm1e_get_u16(frame->bytes + COE) == 8 << 12)
        cm1e_put_u16(frame->bytes + COE, 15 << 12);
    return CM1E_TAP_PASS;
}

START_TEST(a_device_without_sdo_information_is_compared_by_the_rest)
{
    cm1e_bus_t *bus = open_scanned_bus(1);
    cm1e_file_t file = {0};
    generate(&file, CM1E_FILE_ESI, tested_firmware());
    cm1e_nic_set_tap(cm1e_bus_nic(bus), no_information, NULL);
    compare(bus, 1, file.bytes, file.size);
    ck_assert_msg(cm1e_findings_count(findings) == 1 && has("not-compared", "dictionary is not compared"), "%s",
                  first_text());
    cm1e_findings_free(findings);
    cm1e_file_free(&file);
    const bool old = strcmp(tested_firmware(), "1.2.0") == 0;
    generate(&file, CM1E_FILE_ESI, old ? "1.3.5" : "1.2.0"); /* its mapping objects are read by SDO */
    compare(bus, 1, file.bytes, file.size);
    ck_assert_msg(has("differs-pdo", "0x1603"), "%s", first_text());
    cm1e_findings_free(findings);
    cm1e_file_free(&file);
    cm1e_bus_close(bus);
}
END_TEST

START_TEST(a_device_without_mailbox_is_compared_by_its_sii)
{
    sim_config(1);
    cm1e_bus_t *bus = open_bus();
    cm1e_sim_segment_t *segment = cm1e_sim_segment_create_empty();
    ck_assert_int_eq(cm1e_sim_segment_add(segment, cm1e_sim_io_module_create()), CM1E_OK);
    cm1e_sim_replace_segment(cm1e_bus_nic(bus), segment);
    ck_assert_msg(cm1e_bus_scan(bus, &diag) == CM1E_OK, "%s", diag.text);
    static uint8_t image[4096];
    size_t size = sizeof image;
    ck_assert_int_eq(cm1e_sii_read_device(bus, 1, image, &size, &diag), CM1E_OK);
    compare(bus, 1, image, size);
    check_no_finding();
    cm1e_sim_segment_slave(segment, 1)->sii[0x18] ^= 1;
    compare(bus, 1, image, size);
    ck_assert_msg(cm1e_findings_count(findings) == 1 && has("differs-identity", "revision"), "%s", first_text());
    cm1e_findings_free(findings);
    cm1e_bus_close(bus);
}
END_TEST

static unsigned lost, seen;
static cm1e_tap_verdict_t lose_one(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    return frame->direction == CM1E_TAP_RECEIVED && seen++ == lost ? CM1E_TAP_DROP : CM1E_TAP_PASS;
}

START_TEST(a_lost_frame_changes_no_finding)
{
    cm1e_bus_t *bus = open_scanned_bus(1);
    cm1e_file_t file = {0};
    generate(&file, CM1E_FILE_ESI, tested_firmware());
    cm1e_nic_set_tap(cm1e_bus_nic(bus), lose_one, NULL);
    for (lost = 0, seen = 1; seen > lost; lost += 97) {
        seen = 0;
        compare(bus, 1, file.bytes, file.size);
        check_no_finding();
    }
    cm1e_file_free(&file);
    cm1e_bus_close(bus);
}
END_TEST

static int one_of;

/** What a slave answers is changed at random: mailbox messages behind their header, words of the SII. */
static cm1e_tap_verdict_t lie(void *context, cm1e_tap_frame_t *frame)
{
    enum { DATA = 26, SERVICE = DATA + 6, EEPROM_STATUS = 0x0502, EEPROM_GROUP = 6, GROUP_BYTES = 8 };
    (void)context;
    if (frame->direction != CM1E_TAP_RECEIVED || frame->bytes[16] != 4 /* FPRD */ || rand() % one_of != 0)
        return CM1E_TAP_PASS;
    const unsigned length = cm1e_get_u16(frame->bytes + 22) & 0x7FF;
    if (length == 128 && SERVICE + 24 <= frame->length)
        for (int n = rand() % 4; n >= 0; n--)
            frame->bytes[SERVICE + rand() % 24] = (uint8_t)rand();
    else if (cm1e_get_u16(frame->bytes + 20) == EEPROM_STATUS && length > EEPROM_GROUP)
        frame->bytes[DATA + EEPROM_GROUP + rand() % GROUP_BYTES] = (uint8_t)rand();
    return CM1E_TAP_PASS;
}

START_TEST(a_device_that_lies_ends_in_findings_or_an_error_in_bounded_time)
{
    const unsigned seed = (unsigned)time(NULL);
    unsigned good = 0;
    printf("seed %u\n", seed);
    srand(seed);
    for (int i = 0; i < 60; i++) {
        cm1e_bus_t *bus = open_scanned_bus(1);
        cm1e_file_t file = {0};
        generate(&file, formats[i % 4], tested_firmware());
        one_of = i % 2 ? 50 : 2000;
        cm1e_nic_set_tap(cm1e_bus_nic(bus), lie, NULL);
        const int64_t start_ns = now_of(bus);
        if (cm1e_diff_file(&findings, file.bytes, file.size, bus, 1, &diag) == CM1E_OK)
            good++;
        else
            ck_assert(diag.text[0] && !findings);
        ck_assert_int_lt(now_of(bus) - start_ns, INT64_C(60000000000));
        cm1e_findings_free(findings);
        cm1e_file_free(&file);
        cm1e_bus_close(bus);
    }
    printf("%u of 60 comparisons came to their end\n", good);
}
END_TEST

START_TEST(a_device_that_goes_away_ends_the_comparison_soon)
{
    cm1e_bus_t *bus = open_scanned_bus(1);
    cm1e_file_t file = {0};
    generate(&file, CM1E_FILE_ESI, tested_firmware());
    cm1e_sim_segment_cut(segment_of(bus), 1, true);
    const int64_t start_ns = now_of(bus);
    ck_assert_int_eq(cm1e_diff_file(&findings, file.bytes, file.size, bus, 1, &diag), CM1E_ERROR_BUS_NO_SLAVES);
    ck_assert_int_lt(now_of(bus) - start_ns, INT64_C(5000000000));
    cm1e_file_free(&file);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("bus_diff");
    TCase *equal = tcase_create("equal");
    tcase_add_loop_test(equal, a_file_of_every_format_that_is_made_for_the_device_differs_in_nothing, 0,
                        sizeof formats / sizeof formats[0]);
    tcase_add_test(equal, the_esi_of_every_firmware_differs_in_nothing);
    tcase_add_loop_test(equal, a_file_of_every_format_that_is_made_for_a_bridge_differs_in_nothing, 0, 3);
    tcase_add_loop_test(equal, the_eni_of_a_scan_is_that_of_the_configuration_of_a_bridge, 0, 3);
    tcase_add_test(equal, the_eni_of_a_scan_has_the_protocols_of_the_sii);
    tcase_add_test(equal, the_eni_of_a_scan_is_that_of_the_configuration_of_motors_with_aliases);
    tcase_add_test(equal, the_eni_of_a_scan_has_the_pdos_that_the_bus_file_names_for_a_drive);
    tcase_add_test(equal, the_eni_of_a_scan_of_terminals_differs_in_nothing);
    tcase_add_test(equal, the_eni_of_a_scan_knows_the_others_beside_optional_slaves);
    tcase_add_test(equal, the_sii_of_the_device_itself_differs_in_nothing);
    tcase_add_test(equal, a_modular_file_differs_in_nothing);
    tcase_add_test(equal, a_lost_frame_changes_no_finding);
    suite_add_tcase(suite, equal);
    TCase *different = tcase_create("different");
    tcase_add_test(different, what_is_changed_in_a_file_is_found_in_its_line);
    tcase_add_test(different, a_file_for_another_firmware_differs_in_revision_and_dictionary);
    tcase_add_test(different, a_file_with_other_revisions_names_them);
    tcase_add_test(different, a_modular_file_for_another_firmware_differs_in_its_modules);
    tcase_add_test(different, the_other_order_of_the_mappings_is_found);
    tcase_add_test(different, another_assignment_is_a_warning);
    tcase_add_test(different, a_file_about_something_else_is_not_compared);
    suite_add_tcase(suite, different);
    TCase *live = tcase_create("live");
    tcase_add_test(live, the_live_device_is_described_by_what_it_tells);
    tcase_add_test(live, a_device_without_sdo_information_is_compared_by_the_rest);
    tcase_add_test(live, a_device_without_mailbox_is_compared_by_its_sii);
    tcase_add_test(live, a_device_that_lies_ends_in_findings_or_an_error_in_bounded_time);
    tcase_add_test(live, a_device_that_goes_away_ends_the_comparison_soon);
    suite_add_tcase(suite, live);
    return run_suite(suite);
}
