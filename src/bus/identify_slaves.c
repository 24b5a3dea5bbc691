/* Finds the slaves that the configuration names beside the axes, and checks their identity. */
#include <stdio.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "device/place.h"

static cm1e_bus_slave_t *find_slave(cm1e_bus_t *bus, const cm1e_slave_config_t *config, cm1e_diag_t *diag)
{
    const cm1e_expected_t expected = {"Slave", config->name, config->address_kind, config->address,
                                      cm1e_slave_is_optional(config), "slave"};
    return cm1e_bus_find_expected(bus, &expected, diag);
}

/** A member of a Hot Connect group is behind its head, at its place in the group. What else is there is none of ours,
 *  and the member is absent. */
static cm1e_bus_slave_t *find_member(cm1e_bus_t *bus, const cm1e_slave_config_t *config, cm1e_diag_t *diag)
{
    const cm1e_bus_slave_t *head = NULL;
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        const cm1e_slave_config_t *other = bus->slaves[i].config;
        if (other && !cm1e_slave_is_member(other) && strcmp(other->hot_connect, config->hot_connect) == 0)
            head = &bus->slaves[i];
    }
    const uint32_t position = head && !head->hot.planned ? head->info.position + config->address - 1u : 0;
    cm1e_bus_slave_t *slave = position <= bus->scanned ? cm1e_bus_at(bus, position) : NULL;
    const bool same = slave && !slave->config && slave->info.vendor_id == config->vendor &&
                      slave->info.product_code == config->product;
    return same ? slave : cm1e_hot_plan(bus, config->address_kind, 0, diag);
}

/** Another axis or entry has the slave, or it is a motor, which needs an axis. */
static cm1e_error_t check_free(const cm1e_bus_t *bus, const cm1e_slave_config_t *config, const cm1e_bus_slave_t *slave,
                               cm1e_diag_t *diag)
{
    char problem[256];
    if (slave->config)
        snprintf(problem, sizeof problem, "\"%s\" and \"%s\" are both slave %u.", slave->config->name, config->name,
                 slave->info.position);
    else if (cm1e_bus_is_used(slave))
        snprintf(problem, sizeof problem, "Slave \"%s\" is slave %u, which an axis of the configuration is already.",
                 config->name, slave->info.position);
    else if (cm1e_bus_has_motors(slave))
        snprintf(problem, sizeof problem, "Slave \"%s\" is slave %u, a %s: name it among the axes, not the slaves.",
                 config->name, slave->info.position, slave->info.device->label);
    else
        return CM1E_OK;
    return cm1e_bus_identity_error(bus, diag, problem);
}

static cm1e_error_t check_identity(const cm1e_bus_t *bus, const cm1e_slave_config_t *config,
                                   const cm1e_bus_slave_t *slave, cm1e_diag_t *diag)
{
    const struct {
        const char *key;
        uint32_t expected, found;
    } numbers[] = {{"vendor", config->vendor, slave->info.vendor_id},
                   {"product", config->product, slave->info.product_code},
                   {"revision", config->revision, slave->info.revision}};
    char problem[256];
    for (int i = 0; i < 3; i++) {
        if (!numbers[i].expected || numbers[i].expected == numbers[i].found)
            continue;
        snprintf(problem, sizeof problem, "Slave \"%s\" (slave %u): the configuration expects the %s 0x%08X, the "
                 "device is \"%s\" with 0x%08X. Correct \"%s\" or leave it out.", config->name, slave->info.position,
                 numbers[i].key, numbers[i].expected, slave->info.name, numbers[i].found, numbers[i].key);
        return cm1e_bus_identity_error(bus, diag, problem);
    }
    return CM1E_OK;
}

/** What the configuration writes needs a mailbox. */
static cm1e_error_t check_mailbox(const cm1e_bus_t *bus, const cm1e_slave_config_t *config,
                                  const cm1e_bus_slave_t *slave, cm1e_diag_t *diag)
{
    char label[CM1E_LABEL_LENGTH];
    if (slave->facts.coe || (!cm1e_setup_is_needed(config, CM1E_SETUP_NO_PULSES, false) &&
                              !cm1e_setup_is_needed(config, CM1E_SETUP_NO_PULSES, true)))
        return CM1E_OK;
    return cm1e_diag_set(diag, CM1E_ERROR_BUS_IDENTITY, 0, "%s has no mailbox for CoE, so SDOs and PDOs cannot be "
                         "written: leave sdo, mapping, outputs_pdos and inputs_pdos out.",
                         cm1e_bus_label_first(bus, slave, label));
}

static cm1e_error_t match_slave(cm1e_bus_t *bus, const cm1e_slave_config_t *config, cm1e_diag_t *diag)
{
    cm1e_bus_slave_t *slave = cm1e_slave_is_member(config) ? find_member(bus, config, diag)
                                                           : find_slave(bus, config, diag);
    if (!slave)
        return CM1E_ERROR_BUS_IDENTITY;
    cm1e_error_t error = check_free(bus, config, slave, diag);
    if (error == CM1E_OK)
        slave->hot.optional = cm1e_slave_is_optional(config);
    if (error == CM1E_OK && slave->hot.planned) {
        slave->config = config;
        return CM1E_OK;
    }
    if (error == CM1E_OK)
        error = check_identity(bus, config, slave, diag);
    if (error != CM1E_OK)
        return error;
    slave->config = config;
    return check_mailbox(bus, config, slave, diag);
}

cm1e_error_t cm1e_bus_identify_slaves(cm1e_bus_t *bus, bool optional, cm1e_diag_t *diag)
{
    cm1e_error_t error = CM1E_OK;
    for (uint32_t i = 0; i < bus->config.slave_count && error == CM1E_OK; i++)
        if (cm1e_slave_is_optional(&bus->config.slaves[i]) == optional)
            error = match_slave(bus, &bus->config.slaves[i], diag);
    return error;
}
