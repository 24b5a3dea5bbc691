#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cm1e/esc.h"
#include "config/clock_pulses.h"
#include "config/places.h"
#include "description/describe.h"
#include "core/in_task.h"
#include "device/devices.h"
#include "generate/eni_slave.h"
#include "generate/file.h"
#include "generate/live.h"

/* The description from the tables of a CM1-E of this firmware with the chosen mapping, or of a bridge of this model:
 * start-up commands, sync managers, PDOs. */
static cm1e_error_t describe_by_tables(cm1e_description_file_t *file, const cm1e_slave_info_t *slave,
                                       cm1e_mapping_t mapping, cm1e_diag_t *diag)
{
    cm1e_device_options_t options = {.mapping = mapping};
    const cm1e_device_options_t by_identity = {.model = slave->model, .vendor_id = slave->vendor_id,
                                               .product_code = slave->product_code, .revision = slave->revision};
    if (!slave->device->firmware)
        return cm1e_describe(file, &by_identity, CM1E_ESI_FLAT, diag);
    const cm1e_firmware_info_t *firmware = slave->device->firmware(slave->software_version);
    if (!firmware)
        return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0,
                             "slave %u (%s) does not report its firmware version (object 0x100A), on which its "
                             "mappings depend", slave->position, slave->name);
    snprintf(options.firmware, sizeof options.firmware, "%s", firmware->version);
    return cm1e_describe(file, &options, CM1E_ESI_FLAT, diag);
}

/* Whether the tables describe the slave. The guide states no identity of a bridge, so a bridge with zeros in its
 * identity is described by its SII. */
static bool is_in_tables(const cm1e_slave_info_t *slave)
{
    const cm1e_device_t *device = slave->device;
    if (!device || !device->name || !device->described)
        return false;
    return device->recognised == CM1E_BY_IDENTITY || (slave->vendor_id && slave->product_code && slave->revision);
}

/* What the configuration has at a slave of the network. */
typedef struct known {
    const cm1e_axis_config_t *axis;   /* the axis, or the first behind it; NULL: none */
    const cm1e_slave_config_t *slave; /* of the list of slaves; NULL: none */
    char name[CM1E_SLAVE_NAME];       /* of all its axes */
} known_t;

static void recognise(known_t *known, const cm1e_bus_t *bus, const cm1e_slave_info_t *slave)
{
    const cm1e_bus_config_t *config = cm1e_bus_configuration(bus);
    const cm1e_places_t places = {config, bus, cm1e_bus_slave};
    const uint16_t place = cm1e_place_of(&places, slave);
    for (uint32_t i = 0; i < config->axis_count; i++) {
        if (!cm1e_place_is_of_axis(&places, i, slave, place))
            continue;
        known->axis = known->axis ? known->axis : &config->axes[i];
        cm1e_slave_name_add(known->name, &config->axes[i]);
    }
    for (uint32_t i = 0; i < config->slave_count && !known->axis && !known->slave; i++)
        if (cm1e_place_is_of_slave(&places, &config->slaves[i], slave, place))
            known->slave = &config->slaves[i];
}

/* The alias by which the configuration finds a slave, for the master to look for it too; 0: none. */
static uint16_t alias_of(const known_t *known)
{
    if (known->axis && known->axis->address_kind == CM1E_ADDRESS_ALIAS)
        return known->axis->address;
    return known->slave && known->slave->address_kind == CM1E_ADDRESS_ALIAS ? known->slave->address : 0;
}

/* The mode that a configuration names, by the EEPROM of the slave. */
static cm1e_error_t take_mode(cm1e_eni_slave_t *slave, const cm1e_dc_config_t *stated, int64_t cycle_time_ns,
                              cm1e_diag_t *diag)
{
    for (size_t i = 0; i < slave->device->dc_modes.count; i++) {
        const cm1e_dc_mode_t *mode = &slave->device->dc_modes.at[i];
        const cm1e_dc_facts_t facts = {mode->assign_activate, mode->sync0_cycle_ns, mode->sync0_factor,
                                       mode->sync0_shift_ns, mode->sync1_factor, mode->sync1_shift_ns};
        const bool first = strcmp(stated->mode, "first") == 0 && cm1e_config_mode_has_sync0(&facts);
        if (strcmp(mode->name, stated->mode) != 0 && !first)
            continue;
        slave->pulses = cm1e_config_pulses_of_mode(&facts, stated->shift_us, cycle_time_ns);
        slave->assign_activate = mode->assign_activate;
        return CM1E_OK;
    }
    return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "%s: its EEPROM has no mode \"%s\" for its distributed clock",
                         slave->name, stated->mode);
}

/* Whether its clock is used, and which pulses it gets: as the bus does it. */
static cm1e_error_t take_clock(cm1e_eni_slave_t *made, cm1e_bus_t *bus, uint16_t position,
                               const known_t *known, cm1e_diag_t *diag)
{
    enum { FEATURES = 0x0008, FEATURE_CLOCKS = 0x04 };
    const cm1e_bus_config_t *config = cm1e_bus_configuration(bus);
    uint8_t features[2] = {0};
    if (!cm1e_config_uses_clocks(config))
        return CM1E_OK;
    const cm1e_error_t error = cm1e_esc_read(bus, position, FEATURES, features, sizeof features, diag);
    const cm1e_dc_config_t *stated = known->axis ? &known->axis->dc : known->slave ? &known->slave->dc : NULL;
    made->has_clock = features[0] & FEATURE_CLOCKS;
    if (error != CM1E_OK || !stated || !made->has_clock)
        return error;
    made->pulses = *stated;
    return stated->mode[0] ? take_mode(made, stated, config->cycle_time_ns, diag) : CM1E_OK;
}

/* An entry of the live mapping with the name and type that the tables have for it. */
static cm1e_described_pdo_entry_t named(const cm1e_described_pdo_entry_t *live, const cm1e_described_pdo_t *tables)
{
    for (size_t i = 0; i < tables->entries.count; i++) {
        const cm1e_described_pdo_entry_t *entry = &tables->entries.at[i];
        if (entry->index == live->index && entry->subindex == live->subindex && entry->bits == live->bits)
            return *entry;
    }
    return *live;
}

/* The manual has two orders of the objects in the mappings, so the order of the device is used. */
static void take_mappings(cm1e_arena_t *arena, cm1e_description_t *device, const cm1e_description_t *live)
{
    for (size_t i = 0; i < device->pdos.count; i++) {
        const cm1e_described_pdo_t tables = device->pdos.at[i];
        const cm1e_described_pdo_t *found = cm1e_description_pdo(live, tables.index);
        if (!found || found->entries.count == 0)
            continue;
        cm1e_described_pdo_t *pdo = &device->pdos.at[i];
        pdo->entries.at = NULL;
        pdo->entries.count = 0;
        for (size_t e = 0; e < found->entries.count; e++)
            *(cm1e_described_pdo_entry_t *)CM1E_APPEND(arena, &pdo->entries) = named(&found->entries.at[e], &tables);
    }
    for (unsigned n = CM1E_SM_NUMBER_OUTPUTS; n <= CM1E_SM_NUMBER_INPUTS; n++)
        device->sync_managers.at[n].length = (uint16_t)cm1e_description_process_bytes(device, n);
    device->revision = live->revision;
}

/* The device also states the protocols of its mailbox, and whether it has one in Bootstrap. */
static void take_mailbox(cm1e_description_t *device, const cm1e_description_t *live)
{
    cm1e_mailbox_protocols_t *mailbox = &device->mailbox;
    mailbox->coe = live->mailbox.coe;
    mailbox->foe = live->mailbox.foe;
    mailbox->eoe = live->mailbox.eoe;
    mailbox->soe = live->mailbox.soe;
    mailbox->voe = live->mailbox.voe;
    mailbox->aoe = live->mailbox.aoe;
    device->eeprom.bootstrap = live->eeprom.bootstrap;
}

/* Appends the slave at `position`: a CM1-E with the chosen mapping, a bridge, or another device described by its
 * SII. */
static cm1e_error_t describe_slave(cm1e_description_file_t *file, cm1e_bus_t *bus, const cm1e_slave_info_t *slave,
                                   cm1e_mapping_t mapping, cm1e_findings_t *findings, cm1e_diag_t *diag)
{
    cm1e_error_t error = cm1e_live_describe(file, bus, slave->position, findings, diag);
    if (error != CM1E_OK || !is_in_tables(slave))
        return error;
    error = describe_by_tables(file, slave, mapping, diag);
    if (error != CM1E_OK)
        return error;
    cm1e_description_t *device = &file->devices.at[file->devices.count - 1], *live = device - 1;
    take_mappings(&file->arena, device, live);
    take_mailbox(device, live);
    device->no_lrw = live->no_lrw;
    *live = *device;
    file->devices.count--;
    return CM1E_OK;
}

/* The PDOs that a configuration names for a servo drive of another maker are assigned as those of a slave without an
 * axis. */
static cm1e_error_t configure_drive(cm1e_description_file_t *file, const cm1e_axis_config_t *axis, cm1e_diag_t *diag)
{
    cm1e_slave_config_t slave = {.outputs_pdos = {axis->outputs_pdo}, .outputs_pdo_count = 1,
                                 .inputs_pdos = {axis->inputs_pdo}, .inputs_pdo_count = 1};
    snprintf(slave.name, sizeof slave.name, "%s", axis->name);
    const cm1e_error_t error = axis->outputs_pdo ? cm1e_eni_configure_slave(file, &slave, diag) : CM1E_OK;
    if (error == CM1E_OK)
        cm1e_eni_start_mode(&file->arena, &file->devices.at[file->devices.count - 1]);
    return error;
}

/* What 0x1C32:01 and 0x1C33:01 get for its pulses, as the bus does it: of SYNC1 only what the slave says that it
 * can. */
static void synchronise(cm1e_arena_t *arena, cm1e_description_t *device, cm1e_bus_t *bus, uint16_t position,
                        const cm1e_eni_slave_t *slave, const known_t *known)
{
    enum { SUPPORTED = 4, BY_SYNC0 = 2, BY_SYNC1 = 3, CAN_SYNC0 = 0x04, CAN_SYNC1 = 0x08 }; /* ETG.1020 */
    for (int inputs = 0; inputs < 2 && slave->pulses.sync0_us != 0 && device->mailbox.coe; inputs++) {
        uint8_t can[2] = {CAN_SYNC0, 0};
        size_t size = sizeof can;
        if (slave->pulses.sync1_us != 0 &&
            cm1e_sdo_read(bus, position, (uint16_t)(OBJ_1C32_SM_OUTPUT_PARAMETER + inputs), SUPPORTED, can, &size,
                          NULL) != CM1E_OK)
            continue;
        cm1e_eni_synchronise(arena, device, known->slave, inputs != 0,
                             can[0] & CAN_SYNC1 ? BY_SYNC1 : can[0] & CAN_SYNC0 ? BY_SYNC0 : 0);
    }
}

cm1e_error_t cm1e_generate_eni_of_bus(cm1e_file_t *file, cm1e_bus_t *bus, cm1e_mapping_t mapping, cm1e_diag_t *diag)
{
    const uint32_t count = cm1e_bus_slave_count(bus);
    if (!file || !bus)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0,
                             "cm1e_generate_eni_of_bus() needs a place for the file, and a bus.");
    *file = (cm1e_file_t){0};
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_generate_eni_of_bus()", "", diag);
    if (count == 0)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "no slave is known: scan the network first");
    cm1e_description_file_t described = {0};
    cm1e_findings_t *findings = cm1e_findings_create();
    cm1e_eni_slave_t *slaves = calloc(count, sizeof *slaves);
    known_t *known = calloc(count, sizeof *known);
    cm1e_error_t error = findings && slaves && known
                             ? CM1E_OK : cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    for (uint32_t position = 1; error == CM1E_OK && position <= count; position++) {
        const cm1e_slave_info_t *slave = cm1e_bus_slave(bus, position);
        known_t *one = &known[position - 1];
        recognise(one, bus, slave);
        error = describe_slave(&described, bus, slave, one->axis ? one->axis->mapping : mapping, findings, diag);
        if (error == CM1E_OK && one->slave)
            error = cm1e_eni_configure_slave(&described, one->slave, diag);
        if (error == CM1E_OK && one->axis && cm1e_device_configured(one->axis)->motor_stated)
            error = configure_drive(&described, one->axis, diag);
        slaves[position - 1].alias = alias_of(one);
        slaves[position - 1].name = one->slave ? one->slave->name
                                    : one->axis ? one->name
                                                : cm1e_arena_format(&described.arena, "%s %u",
                                                                    slave->name[0] ? slave->name : "Slave",
                                                                    (unsigned)position);
    }
    if (error == CM1E_OK && described.arena.failed)
        error = cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    /* Set at the end, because the list of devices moves while it grows. */
    for (uint32_t i = 0; error == CM1E_OK && i < count; i++) {
        slaves[i].device = &described.devices.at[i];
        error = take_clock(&slaves[i], bus, (uint16_t)(i + 1), &known[i], diag);
        if (error == CM1E_OK && (known[i].slave || !is_in_tables(cm1e_bus_slave(bus, i + 1))))
            synchronise(&described.arena, &described.devices.at[i], bus, (uint16_t)(i + 1), &slaves[i], &known[i]);
    }
    if (error == CM1E_OK)
        error = cm1e_file_of_eni(file, slaves, count, cm1e_bus_configuration(bus)->cycle_time_ns, diag);
    cm1e_description_file_free(&described);
    cm1e_findings_free(findings);
    free(known);
    free(slaves);
    return error;
}
