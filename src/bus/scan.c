#include <stdio.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "core/in_task.h"
#include "core/text.h"

/** For all slaves together. A bridge answers its 15 questions within some milliseconds each. */
#define RECOGNITION_NS INT64_C(3000000000)
/** The explicit device ID comes at once or never (ETG.1020: a device without it ignores the request). */
#define ID_TIMEOUT_NS INT64_C(100000000)

static void set_device(cm1e_bus_slave_t *slave, const cm1e_device_t *device)
{
    slave->info.device = device;
    slave->info.kind = device ? device->kind : NULL;
}

static void set_up_slave(cm1e_bus_t *bus, uint16_t position)
{
    cm1e_bus_slave_t *slave = &bus->slaves[position - 1];
    memset(slave, 0, sizeof *slave);
    cm1e_slave_facts_t *facts = &slave->facts;
    cm1e_soem_facts(bus->soem, position, facts);
    slave->info = (cm1e_slave_info_t){
        .position = position,
        .vendor_id = facts->vendor_id,
        .product_code = facts->product_code,
        .revision = facts->revision,
        .serial_number = facts->serial_number,
        .alias = facts->alias,
    };
    set_device(slave, cm1e_device_of_identity(facts->vendor_id, facts->product_code));
    memcpy(slave->info.name, facts->name, sizeof slave->info.name);
    cm1e_text_clean(slave->info.name);
    slave->al.station = facts->station;
    slave->hot = (cm1e_hot_t){.counted = true, .member = 1, .place = position, .group = ""};
    const bool used = facts->coe || facts->foe;
    slave->coe.mailbox = (cm1e_mailbox_t){
        .station = facts->station,
        .out_start = facts->mailbox_out_start,
        .out_length = used ? facts->mailbox_out_length : 0,
        .in_start = facts->mailbox_in_start,
        .in_length = used ? facts->mailbox_in_length : 0,
    };
}

/** Whether the configuration finds a slave without an axis by its explicit device ID: then every device is asked. */
static bool finds_by_id(const cm1e_bus_config_t *config)
{
    for (uint32_t i = 0; i < config->slave_count; i++)
        if (config->slaves[i].address_kind == CM1E_ADDRESS_EXPLICIT_ID)
            return true;
    return false;
}

static void read_explicit_ids(cm1e_bus_t *bus)
{
    const bool by_id = finds_by_id(&bus->config);
    const int64_t deadline_ns = cm1e_clock_now(bus->clock) + ID_TIMEOUT_NS;
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        const cm1e_device_t *device = bus->slaves[i].info.device;
        if (device ? device->explicit_id : by_id)
            cm1e_al_read_id(&bus->slaves[i].al, deadline_ns);
    }
    cm1e_bus_pump_until_idle(bus, deadline_ns + CM1E_STATE_TIMEOUT_NS);
    for (uint32_t i = 0; i < bus->slave_count; i++)
        bus->slaves[i].info.explicit_id = bus->slaves[i].al.explicit_id;
}

/** Reads object 0x100A of every slave with a mailbox; "" if it does not answer. */
static void read_software_versions(cm1e_bus_t *bus)
{
    const int64_t now_ns = cm1e_clock_now(bus->clock);
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        slave->version_sdo = (cm1e_sdo_t){.position = slave->info.position, .index = OBJ_100A_SOFTWARE_VERSION,
                                          .data = slave->version, .size = sizeof slave->version - 1,
                                          .timeout_ns = CM1E_START_SDO_TIMEOUT_NS, .state = CM1E_SDO_BUSY};
        if (slave->facts.coe)
            cm1e_coe_begin(&slave->coe, &slave->version_sdo, now_ns);
    }
    cm1e_bus_pump_until_idle(bus, now_ns + 2 * CM1E_START_SDO_TIMEOUT_NS);
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        if (cm1e_sdo_state(&slave->version_sdo) != CM1E_SDO_DONE)
            continue;
        slave->version[slave->version_sdo.size] = 0;
        for (char *c = slave->version; *c; c++)
            *c = *c >= ' ' && *c <= '~' ? *c : '?';
        snprintf(slave->info.software_version, sizeof slave->info.software_version, "%.15s", slave->version);
        if (slave->info.device && slave->info.device->firmware)
            slave->firmware = slave->info.device->firmware(slave->info.software_version);
    }
}

static void take_bridge(cm1e_bus_slave_t *slave)
{
    slave->bridge = slave->recognition.facts;
    const bool known = cm1e_recognise_model(&slave->bridge, &slave->info.model);
    set_device(slave, known ? cm1e_device_of_model(slave->info.model) : &cm1e_device_unknown_bridge);
    for (unsigned axis = 0; axis < CM1E_BRIDGE_AXES; axis++) {
        const uint32_t motor = slave->bridge.motors[axis];
        slave->info.motors[axis] = motor == CM1E_BRIDGE_CM1 || motor == CM1E_BRIDGE_CM2 ? (uint8_t)motor : 0;
    }
}

/** The low word of 0x1000 is the profile (ETG.1000.6). */
static const cm1e_device_t *device_of_profile(uint32_t device_type)
{
    const cm1e_device_t *device = cm1e_device_recognised(CM1E_BY_PROFILE);
    return device && (device_type & 0xFFFF) == device->profile ? device : NULL;
}

/** Asks every slave with a mailbox that was not recognised by its identity. */
static void recognise_by_objects(cm1e_bus_t *bus)
{
    const int64_t deadline_ns = cm1e_clock_now(bus->clock) + RECOGNITION_NS;
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        if (slave->facts.coe && !slave->info.device)
            cm1e_recognise_begin(&slave->recognition, slave->info.position, deadline_ns);
    }
    cm1e_bus_pump_until_idle(bus, deadline_ns + CM1E_START_SDO_TIMEOUT_NS);
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        if (slave->recognition.recognised)
            take_bridge(slave);
        else if (!slave->info.device)
            set_device(slave, device_of_profile(slave->recognition.device_type));
    }
}

static cm1e_error_t diagnose_scan(const cm1e_bus_t *bus, int result, uint16_t position, cm1e_diag_t *diag)
{
    const char *name = bus->config.interface_name;
    if (result == SCAN_TOO_MANY)
        return cm1e_diag_set(diag, CM1E_ERROR_BUS_IDENTITY, 0, "More than %d slaves answer on %s.", CM1E_MAX_SLAVES,
                             name);
    if (result == SCAN_NO_MEMORY)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "Out of memory while reading the SII of slave %u on %s.",
                             position, name);
    if (result == SCAN_LOST)
        return cm1e_diag_set(diag, CM1E_ERROR_BUS_LOST, 0,
                             "Slave %u on %s stopped answering during the scan: check its power and the cables up to "
                             "it.", position, name);
    if (result == SCAN_NO_ADDRESS)
        return cm1e_diag_set(diag, CM1E_ERROR_BUS_LOST, 0,
                             "Slave %u on %s answers, but not at the station address that it was given: another device "
                             "may answer there too, or its controller is damaged.", position, name);
    return cm1e_diag_set(diag, CM1E_ERROR_BUS_IDENTITY, 0,
                         "The SII (EEPROM) of slave %u on %s %s. Write it anew, or take the slave off the bus.",
                         position, name,
                         result == SCAN_SII_DAMAGED ? "is damaged: its categories have no end" : "cannot be read");
}

static cm1e_error_t nobody_answers(const cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    const char *name = bus->config.interface_name;
    if (cm1e_nic_lacks_link(name))
        return cm1e_diag_set(diag, CM1E_ERROR_BUS_NO_SLAVES, 0,
                             "No EtherCAT slave answers on %s: the interface has no link. Plug the cable from it into "
                             "IN of the first slave, and switch the control power of that slave on.", name);
    return cm1e_diag_set(diag, CM1E_ERROR_BUS_NO_SLAVES, 0,
                         "No EtherCAT slave answers on %s. Check the cable to IN of the first slave, the power of "
                         "the slaves and the name of the interface.", name);
}

cm1e_error_t cm1e_bus_scan(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_bus_scan()", "", diag);
    if (!bus)
        return cm1e_bus_missing("cm1e_bus_scan()", diag);
    if (bus->phase >= BUS_OPERATING)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "The bus is in operation: stop it before scanning.");
    cm1e_bus_enter(bus);
    if (bus->remote)
        return cm1e_bus_scan_remote(bus, diag);
    cm1e_acyclic_cancel(bus);
    cm1e_bus_free_image(bus);
    cm1e_bus_set_phase(bus, BUS_OPEN);
    bus->slave_count = bus->scanned = 0;
    bus->search = (cm1e_search_t){0};
    bus->dc.used = false; /* set up anew by cm1e_bus_configure() */
    memset(bus->axis_position, 0, sizeof bus->axis_position);
    uint16_t position;
    const int found = cm1e_soem_scan(bus->soem, &position);
    if (found < 0)
        return diagnose_scan(bus, found, position, diag);
    if (found == 0)
        return nobody_answers(bus, diag);
    cm1e_error_t error = cm1e_bus_make_room(bus, (uint32_t)found, diag);
    if (error != CM1E_OK)
        return error;
    for (position = 1; position <= found; position++)
        set_up_slave(bus, position);
    bus->slave_count = bus->scanned = (uint32_t)found;
    cm1e_ring_watch_begin(bus);
    error = cm1e_bus_all_to_state(bus, CM1E_AL_INIT, CM1E_STATE_TIMEOUT_NS, diag);
    if (error == CM1E_OK) {
        cm1e_soem_set_up_mailboxes(bus->soem);
        error = cm1e_bus_all_to_state(bus, CM1E_AL_PRE_OP, CM1E_STATE_TIMEOUT_NS, diag);
    }
    if (error != CM1E_OK)
        return error;
    read_explicit_ids(bus);
    read_software_versions(bus);
    recognise_by_objects(bus);
    cm1e_bus_set_phase(bus, BUS_SCANNED);
    return CM1E_OK;
}
