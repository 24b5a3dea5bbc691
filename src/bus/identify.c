#include <stdio.h>
#include <string.h>

#include "bus/bus_internal.h"

/** "alias 17", "position 3" ...: how the configuration finds an axis. */
static const char *address_text(const cm1e_axis_config_t *axis, char text[32])
{
    static const char *const kinds[] = {"position", "alias", "explicit device ID"};
    snprintf(text, 32, "%s %u", kinds[axis->address_kind], axis->address);
    return text;
}

static uint32_t address_of(const cm1e_bus_slave_t *slave, cm1e_address_kind_t kind)
{
    switch (kind) {
    case CM1E_ADDRESS_POSITION:
        return slave->info.position;
    case CM1E_ADDRESS_ALIAS:
        return slave->info.alias;
    case CM1E_ADDRESS_EXPLICIT_ID:
        return slave->info.explicit_id;
    }
    return 0;
}

/** "1: CM1-E (0x00004441/0x44412002, alias 0, ID 3); 2: ...": what the scan found, for the diagnosis. */
static const char *found_text(const cm1e_bus_t *bus, char *text, size_t size)
{
    size_t used = 0;
    text[0] = 0;
    for (uint32_t i = 0; i < bus->slave_count && used + 1 < size; i++) {
        const cm1e_slave_info_t *info = &bus->slaves[i].info;
        const int n = snprintf(text + used, size - used, "%s%u: %s (0x%08X/0x%08X, alias %u, ID %u)", i ? "; " : "",
                               info->position, info->name, info->vendor_id, info->product_code, info->alias,
                               info->explicit_id);
        used += n > 0 ? (size_t)n : 0;
    }
    return text;
}

static cm1e_error_t identity_error(const cm1e_bus_t *bus, cm1e_diag_t *diag, const char *problem)
{
    char found[300];
    return cm1e_diag_set(diag, CM1E_ERROR_BUS_IDENTITY, 0, "%s Found %u slave%s: %s.", problem, bus->slave_count,
                         bus->slave_count == 1 ? "" : "s", found_text(bus, found, sizeof found));
}

static cm1e_error_t check_kind(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, cm1e_diag_t *diag)
{
    char where[32], problem[256];
    const cm1e_axis_config_t *axis = cm1e_bus_axis_of(bus, slave);
    if (slave->info.is_cm1e)
        return CM1E_OK;
    snprintf(problem, sizeof problem,
             "Axis \"%s\" at %s: expected a CM1-E (vendor 0x%08X, product 0x%08X), found slave %u of another kind.",
             axis->name, address_text(axis, where), CM1E_VENDOR_ID, CM1E_PRODUCT_CODE, slave->info.position);
    return identity_error(bus, diag, problem);
}

/** The version without a leading V. */
static const char *plain_version(const char *version) { return version + (*version == 'V' || *version == 'v'); }

static cm1e_error_t check_firmware(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, cm1e_diag_t *diag)
{
    char problem[256];
    const cm1e_axis_config_t *axis = cm1e_bus_axis_of(bus, slave);
    if (!axis->firmware[0] || !strcmp(plain_version(axis->firmware), plain_version(slave->info.software_version)))
        return CM1E_OK;
    snprintf(problem, sizeof problem,
             "Axis \"%s\" (slave %u): the configuration expects firmware %s, the device tells \"%s\" (object 0x100A). "
             "Correct \"firmware\" or leave it out.", axis->name, slave->info.position, axis->firmware,
             slave->info.software_version);
    return identity_error(bus, diag, problem);
}

/** The one slave of an axis. */
static cm1e_error_t match_axis(cm1e_bus_t *bus, uint32_t axis_index, cm1e_diag_t *diag)
{
    char where[32], problem[256];
    const cm1e_axis_config_t *axis = &bus->config.axes[axis_index];
    cm1e_bus_slave_t *match = NULL;
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        if (address_of(slave, axis->address_kind) != axis->address)
            continue;
        if (match) {
            snprintf(problem, sizeof problem, "Axis \"%s\": %s is doubled, slaves %u and %u both have it.", axis->name,
                     address_text(axis, where), match->info.position, slave->info.position);
            return identity_error(bus, diag, problem);
        }
        match = slave;
    }
    if (!match) {
        snprintf(problem, sizeof problem, "Axis \"%s\": expected a CM1-E at %s, which is missing.", axis->name,
                 address_text(axis, where));
        return identity_error(bus, diag, problem);
    }
    if (match->axis >= 0) {
        snprintf(problem, sizeof problem, "Axes \"%s\" and \"%s\" are both slave %u.",
                 bus->config.axes[match->axis].name, axis->name, match->info.position);
        return identity_error(bus, diag, problem);
    }
    match->axis = (int)axis_index;
    bus->axis_position[axis_index] = match->info.position;
    const cm1e_error_t error = check_kind(bus, match, diag);
    return error != CM1E_OK ? error : check_firmware(bus, match, diag);
}

cm1e_error_t cm1e_bus_identify(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    if (bus->phase < BUS_SCANNED || bus->phase >= BUS_OPERATING)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "Identifying the slaves needs a scan before.");
    cm1e_bus_set_phase(bus, BUS_SCANNED);
    memset(bus->axis_position, 0, sizeof bus->axis_position);
    for (uint32_t i = 0; i < bus->slave_count; i++)
        bus->slaves[i].axis = -1;
    for (uint32_t axis = 0; axis < bus->config.axis_count; axis++) {
        const cm1e_error_t error = match_axis(bus, axis, diag);
        if (error != CM1E_OK)
            return error;
    }
    /* A motor that nobody configured could move unexpectedly; a device of another kind may stand between the axes. */
    for (uint32_t i = 0; i < bus->slave_count && bus->config.axis_count > 0; i++) {
        const cm1e_bus_slave_t *slave = &bus->slaves[i];
        if (slave->info.is_cm1e && slave->axis < 0) {
            char problem[256];
            snprintf(problem, sizeof problem,
                     "Slave %u is a CM1-E that is extra: %u axes are configured and none is it.",
                     slave->info.position, bus->config.axis_count);
            return identity_error(bus, diag, problem);
        }
    }
    cm1e_bus_set_phase(bus, BUS_IDENTIFIED);
    return CM1E_OK;
}
