#include <stdio.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "core/in_task.h"
#include "device/place.h"

/** "alias 17", "position 3" ...: how the configuration finds an axis. */
static const char *address_text(cm1e_address_kind_t kind, uint16_t address, char text[32])
{
    static const char *const kinds[] = {"position", "alias", "explicit device ID"};
    snprintf(text, 32, "%s %u", kinds[kind], address);
    return text;
}

static uint32_t address_of(const cm1e_bus_slave_t *slave, cm1e_address_kind_t kind)
{
    switch (kind) {
    case CM1E_ADDRESS_POSITION:
        return slave->hot.optional ? 0 : slave->info.position - slave->hot.before;
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
    for (uint32_t i = 0; i < bus->slave_count && used + 1 < size; i++) {
        const cm1e_slave_info_t *info = &bus->slaves[i].info;
        char kind[CM1E_KIND_LENGTH];
        const int n = snprintf(text + used, size - used, "%s%u: %s (0x%08X/0x%08X, alias %u, ID %u)", i ? "; " : "",
                               info->position, cm1e_bus_kind(&bus->slaves[i], kind), info->vendor_id,
                               info->product_code, info->alias, info->explicit_id);
        used += n > 0 ? (size_t)n : 0;
    }
    return text;
}

cm1e_error_t cm1e_bus_identity_error(const cm1e_bus_t *bus, cm1e_diag_t *diag, const char *problem)
{
    char found[300] = "";
    return cm1e_diag_set(diag, CM1E_ERROR_BUS_IDENTITY, 0, "%s Found %u slave%s: %s.", problem, bus->slave_count,
                         bus->slave_count == 1 ? "" : "s", found_text(bus, found, sizeof found));
}

/** Why a slave is not what its objects would have to say: behind "found slave 2 of another kind". */
static const char *other_kind_text(const cm1e_bus_slave_t *slave, const cm1e_device_t *expected, char text[112])
{
    const cm1e_recognition_t *job = &slave->recognition;
    if (slave->info.device && slave->info.device->recognised == CM1E_BY_IDENTITY)
        snprintf(text, 112, "it is a %s, whose entry names no device", slave->info.device->label);
    else if (expected->recognised == CM1E_BY_PROFILE && slave->facts.coe)
        snprintf(text, 112, "its object 0x1000 is 0x%08X, whose low word is not the profile %u", job->device_type,
                 expected->profile);
    else if (!slave->facts.coe)
        snprintf(text, 112, "it has no mailbox for CoE");
    else if (job->sdo.error != CM1E_OK)
        snprintf(text, 112, "its object 0x%04X:%02X cannot be read: %s", job->sdo.index, job->sdo.subindex,
                 cm1e_strerror(job->sdo.error));
    else
        snprintf(text, 112, "its object 0x%04X:%02X is 0x%08X, that of a %s 0x%08X", job->sdo.index,
                 job->sdo.subindex, job->shown, expected->family, job->wanted);
    return text;
}

/** Writes what the axis expects and which other kind of device was found. `text` stays "" if the kind is right. */
static void wrong_kind(const cm1e_axis_config_t *axis, const cm1e_bus_slave_t *slave, char *text, size_t size)
{
    char why[112], kind[CM1E_KIND_LENGTH];
    const unsigned position = slave->info.position;
    const cm1e_device_t *expected = cm1e_device_configured(axis), *found = slave->info.device;
    if (cm1e_device_same_kind(expected, found))
        return;
    if (found && expected->channels && !found->channels && found->recognised == CM1E_BY_IDENTITY)
        snprintf(text, size, "expected a %s, found slave %u, a %s. It is one axis: remove the key channel.",
                 expected->label, position, found->label);
    else if (found && found->channels && !expected->channels)
        snprintf(text, size, "expected a %s, found slave %u, the %s. An axis behind it needs a channel, 1 ... %d.",
                 expected->label, position, cm1e_bus_kind(slave, kind), found->channels);
    else if (expected->recognised == CM1E_BY_IDENTITY)
        snprintf(text, size, "expected a %s (vendor 0x%08X, product 0x%08X), found slave %u of another kind.",
                 expected->label, expected->vendor_id, expected->product_code, position);
    else
        snprintf(text, size, "expected a %s, found slave %u of another kind: %s.", expected->label, position,
                 other_kind_text(slave, expected, why));
}

static cm1e_error_t check_kind(const cm1e_bus_t *bus, const cm1e_axis_config_t *axis, const cm1e_bus_slave_t *slave,
                               cm1e_diag_t *diag)
{
    char where[32], wrong[288] = "", problem[400];
    wrong_kind(axis, slave, wrong, sizeof wrong);
    if (!wrong[0])
        return CM1E_OK;
    snprintf(problem, sizeof problem, "Axis \"%s\" at %s: %s", axis->name,
             address_text(axis->address_kind, axis->address, where), wrong);
    return cm1e_bus_identity_error(bus, diag, problem);
}

/** A bridge whose motors nobody knows together: neither its dictionary nor its limits are known. */
static cm1e_error_t check_model(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, cm1e_diag_t *diag)
{
    char problem[320];
    const uint32_t *motors = slave->bridge.motors;
    if (slave->info.device->name)
        return CM1E_OK;
    snprintf(problem, sizeof problem,
             "Slave %u is a bridge that reports the motors %u, %u, %u, %u (objects 0xF511:01 ... 0xF514:01), which no "
             "known model has: EB01 has 1, 1, 1, 1 (CM1), EB02 2, 2, 2, 2 (CM2), EB12 1, 1, 2, 2.",
             slave->info.position, motors[0], motors[1], motors[2], motors[3]);
    return cm1e_bus_identity_error(bus, diag, problem);
}

static cm1e_error_t check_motor(const cm1e_bus_t *bus, const cm1e_axis_config_t *axis, const cm1e_bus_slave_t *slave,
                                cm1e_diag_t *diag)
{
    char problem[320];
    if (!axis->channel || !axis->motor[0])
        return CM1E_OK;
    const char *motor = cm1e_device_drive(slave->info.device, axis->channel)->short_name;
    if (strcmp(motor, axis->motor) == 0)
        return CM1E_OK;
    snprintf(problem, sizeof problem,
             "Axis \"%s\": the configuration expects the motor %s at channel %u of slave %u, the bridge has a %s there "
             "(object 0x%04X:01). Correct \"motor\" or leave it out.", axis->name, axis->motor, axis->channel,
             slave->info.position, motor, OBJ_F511_CONFIG_AXIS_1 + axis->channel - 1u);
    return cm1e_bus_identity_error(bus, diag, problem);
}

/** The version without a leading V. */
static const char *plain_version(const char *version) { return version + (*version == 'V' || *version == 'v'); }

/** What to do about an object that could not be read. */
static const char *cure_of_unread(cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, cm1e_error_t error)
{
    uint8_t status[2];
    if (error == CM1E_ERROR_BUS_MAILBOX)
        return "It answers, but not as CoE says: switch it off and on";
    if (cm1e_bus_read_registers(bus, slave->info.position, REG_AL_STATUS, status, sizeof status))
        return "It answers, but its mailbox does not: switch it off and on";
    return "Check its power and the cables up to it";
}

static cm1e_error_t check_firmware(cm1e_bus_t *bus, const cm1e_axis_config_t *axis,
                                   const cm1e_bus_slave_t *slave, cm1e_diag_t *diag)
{
    char problem[256];
    if (!axis->firmware[0] || !strcmp(plain_version(axis->firmware), plain_version(slave->info.software_version)))
        return CM1E_OK;
    const cm1e_error_t unread = slave->info.software_version[0] ? CM1E_OK : slave->version_sdo.error;
    if (unread != CM1E_OK && unread != CM1E_ERROR_SDO_ABORT)
        snprintf(problem, sizeof problem, "Axis \"%s\" (slave %u): the configuration expects firmware %s, and that of "
                 "the device (object 0x100A) could not be read: %s. %s.", axis->name, slave->info.position,
                 axis->firmware, cm1e_strerror(unread), cure_of_unread(bus, slave, unread));
    else
        snprintf(problem, sizeof problem,
                 "Axis \"%s\" (slave %u): the configuration expects firmware %s, the device reports \"%s\" (object "
                 "0x100A). Correct \"firmware\" or leave it out.", axis->name, slave->info.position, axis->firmware,
                 slave->info.software_version);
    return cm1e_bus_identity_error(bus, diag, problem);
}

cm1e_bus_slave_t *cm1e_bus_find_expected(cm1e_bus_t *bus, const cm1e_expected_t *expected, cm1e_diag_t *diag)
{
    char where[32], problem[256];
    cm1e_bus_slave_t *match = NULL;
    address_text(expected->kind, expected->address, where);
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        if (address_of(slave, expected->kind) != expected->address)
            continue;
        if (match) {
            snprintf(problem, sizeof problem, "%s \"%s\": %s is doubled, slaves %u and %u both have it.",
                     expected->what, expected->name, where, match->info.position, slave->info.position);
            cm1e_bus_identity_error(bus, diag, problem);
            return NULL;
        }
        match = slave;
    }
    if (match)
        return match;
    if (expected->optional)
        return cm1e_hot_plan(bus, expected->kind, expected->address, diag);
    snprintf(problem, sizeof problem, "%s \"%s\": expected a %s at %s, which is missing.", expected->what,
             expected->name, expected->device, where);
    cm1e_bus_identity_error(bus, diag, problem);
    return NULL;
}

static cm1e_bus_slave_t *find_slave(cm1e_bus_t *bus, const cm1e_axis_config_t *axis, cm1e_diag_t *diag)
{
    const cm1e_expected_t expected = {"Axis", axis->name, axis->address_kind, axis->address, axis->optional,
                                      cm1e_device_configured(axis)->label};
    return cm1e_bus_find_expected(bus, &expected, diag);
}

/** Two axes are one motor. */
static cm1e_error_t check_alone(const cm1e_bus_t *bus, const cm1e_axis_config_t *axis, const cm1e_bus_slave_t *slave,
                                cm1e_diag_t *diag)
{
    char problem[256], channel[24] = "";
    const cm1e_axis_config_t *other = cm1e_bus_axis_of(bus, slave, axis->channel);
    if (!other)
        return CM1E_OK;
    if (axis->channel)
        snprintf(channel, sizeof channel, "channel %u of ", axis->channel);
    snprintf(problem, sizeof problem, "Axes \"%s\" and \"%s\" are both %sslave %u.", other->name, axis->name, channel,
             slave->info.position);
    return cm1e_bus_identity_error(bus, diag, problem);
}

static cm1e_error_t match_axis(cm1e_bus_t *bus, uint32_t axis_index, cm1e_diag_t *diag)
{
    const cm1e_axis_config_t *axis = &bus->config.axes[axis_index];
    cm1e_bus_slave_t *slave = find_slave(bus, axis, diag);
    if (!slave)
        return CM1E_ERROR_BUS_IDENTITY;
    cm1e_error_t error = check_alone(bus, axis, slave, diag);
    slave->hot.optional = axis->optional;
    if (error == CM1E_OK && slave->hot.planned) {
        slave->axes[axis->channel] = (uint16_t)(axis_index + 1);
        bus->axis_position[axis_index] = slave->info.position;
        return CM1E_OK;
    }
    if (error == CM1E_OK)
        error = check_kind(bus, axis, slave, diag);
    if (error == CM1E_OK)
        error = check_model(bus, slave, diag);
    if (error == CM1E_OK)
        error = check_motor(bus, axis, slave, diag);
    if (error == CM1E_OK)
        error = check_firmware(bus, axis, slave, diag);
    slave->axes[axis->channel] = (uint16_t)(axis_index + 1);
    bus->axis_position[axis_index] = slave->info.position;
    return error;
}

/** A motor that nobody configured could move unexpectedly; a device of another kind may stand between the axes. Beside
 *  the axes of a bridge its other motors stay as they are from power-on: their controlword is 0. */
static cm1e_error_t check_extra(const cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    for (uint32_t i = 0; i < bus->slave_count && bus->config.axis_count + bus->config.slave_count > 0; i++) {
        char problem[256];
        const cm1e_bus_slave_t *slave = &bus->slaves[i];
        if (!cm1e_bus_has_motors(slave) || cm1e_bus_is_used(slave))
            continue;
        snprintf(problem, sizeof problem,
                 "Slave %u is a %s that is extra: %u axes with a motor are configured and none is %sit.",
                 slave->info.position, slave->info.device->label,
                 cm1e_motors_before(&bus->config, bus->config.axis_count),
                 slave->info.device->channels ? "behind " : "");
        return cm1e_bus_identity_error(bus, diag, problem);
    }
    return CM1E_OK;
}

/** The optional ones first: they have no position, and positions count without them. */
static cm1e_error_t match_all(cm1e_bus_t *bus, bool optional, cm1e_diag_t *diag)
{
    cm1e_error_t error = CM1E_OK;
    for (uint32_t axis = 0; axis < bus->config.axis_count && error == CM1E_OK; axis++)
        if (cm1e_axis_has_motor(&bus->config.axes[axis]) && bus->config.axes[axis].optional == optional)
            error = match_axis(bus, axis, diag);
    return error == CM1E_OK ? cm1e_bus_identify_slaves(bus, optional, diag) : error;
}

static void count_optional(cm1e_bus_t *bus)
{
    uint16_t before = 0;
    for (uint32_t i = 0; i < bus->scanned; i++) {
        bus->slaves[i].hot.before = before;
        before = (uint16_t)(before + bus->slaves[i].hot.optional);
    }
}

cm1e_error_t cm1e_bus_identify(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_bus_identify()", "", diag);
    if (!bus)
        return cm1e_bus_missing("cm1e_bus_identify()", diag);
    if (bus->phase < BUS_SCANNED || bus->phase >= BUS_OPERATING)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "Scan the bus before identifying the slaves.");
    cm1e_bus_set_phase(bus, BUS_SCANNED);
    memset(bus->axis_position, 0, sizeof bus->axis_position);
    cm1e_hot_forget(bus);
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        memset(bus->slaves[i].axes, 0, sizeof bus->slaves[i].axes);
        bus->slaves[i].config = NULL;
    }
    cm1e_error_t error = match_all(bus, true, diag);
    count_optional(bus);
    if (error == CM1E_OK)
        error = match_all(bus, false, diag);
    if (error == CM1E_OK)
        error = cm1e_hot_describe(bus, diag);
    if (error == CM1E_OK)
        error = check_extra(bus, diag);
    if (error == CM1E_OK)
        cm1e_bus_set_phase(bus, BUS_IDENTIFIED);
    return error;
}
