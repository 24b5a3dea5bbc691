#include <string.h>

#include "cm1e/bridge.h"
#include "core/bytes.h"
#include "core/in_task.h"
#include "device/devices.h"

/* Where a value comes from. The numbers are those of channel 1; each further channel adds the increments. */
typedef struct source {
    size_t offset;
    uint16_t index;
    uint8_t subindex, next_index, next_subindex;
} source_t;

#define OF_DEVICE(member, index, subindex) {offsetof(cm1e_bridge_info_t, member), index, subindex, 0, 0}
#define OF_CHANNEL(member, index, subindex, next_index, next_subindex)                                              \
    {offsetof(cm1e_bridge_channel_t, member), index, subindex, next_index, next_subindex}

static const source_t of_channel[] = {
    OF_CHANNEL(type, OBJ_F511_CONFIG_AXIS_1, 1, 1, 0),
    OF_CHANNEL(baud_rate, OBJ_F511_CONFIG_AXIS_1, 2, 1, 0),
    OF_CHANNEL(cycle_time_ms, OBJ_F511_CONFIG_AXIS_1, 3, 1, 0),
    OF_CHANNEL(receive_errors, OBJ_F530_SYSTEM_INFO, 1, 0, 1),
    OF_CHANNEL(status, OBJ_F530_SYSTEM_INFO, CM1E_BRIDGE_STATUS_SUBINDEX(1), 0, 1),
    OF_CHANNEL(sent, OBJ_F530_SYSTEM_INFO, 9, 0, 1),
    OF_CHANNEL(received, OBJ_F530_SYSTEM_INFO, 13, 0, 1),
    OF_CHANNEL(profile, OBJ_F010_MODULE_PROFILE_LIST, 1, 0, 1),
    OF_CHANNEL(configured_module, OBJ_F030_CONFIGURED_MODULE_IDENT_LIST, 1, 0, 1),
    OF_CHANNEL(detected_module, OBJ_F050_DETECTED_MODULE_IDENT_LIST, 1, 0, 1),
};

/* The guide calls the other sub-indexes of F540 "N/A", so they are not read. */
static const source_t of_device[] = {
    OF_DEVICE(pdo_longest_us, OBJ_F530_SYSTEM_INFO, 17), OF_DEVICE(pdo_shortest_us, OBJ_F530_SYSTEM_INFO, 18),
    OF_DEVICE(pdo_late, OBJ_F530_SYSTEM_INFO, 19),       OF_DEVICE(pdo_early, OBJ_F530_SYSTEM_INFO, 20),
    OF_DEVICE(test[0], OBJ_F530_SYSTEM_INFO, 21),        OF_DEVICE(test[1], OBJ_F530_SYSTEM_INFO, 22),
    OF_DEVICE(test[2], OBJ_F530_SYSTEM_INFO, 23),        OF_DEVICE(test[3], OBJ_F530_SYSTEM_INFO, 24),
    OF_DEVICE(maker_mode, OBJ_F540_CONFIG_SYSTEM, 1),    OF_DEVICE(master_mode, OBJ_F540_CONFIG_SYSTEM, 5),
    OF_DEVICE(serial_cycle_ms, OBJ_F540_CONFIG_SYSTEM, 6),
    OF_DEVICE(config_code, OBJ_F540_CONFIG_SYSTEM, 11),  OF_DEVICE(serial_number, OBJ_F540_CONFIG_SYSTEM, 12),
};
#define COUNT(array) (sizeof(array) / sizeof *(array))

typedef struct reading {
    cm1e_bus_t *bus;
    uint16_t position;
    cm1e_error_t error; /* no answer came: nothing else is asked for */
    cm1e_diag_t *diag;
} reading_t;

/* Reads one value. A refusal, or an answer of another size, concerns this value alone. Silence ends the whole
 * reading. */
static void read_value(reading_t *reading, uint16_t index, uint8_t subindex, cm1e_bridge_value_t *value)
{
    uint8_t data[8] = {0};
    size_t size = sizeof data;
    cm1e_diag_t diag = {0};
    value->error = reading->error;
    if (reading->error != CM1E_OK)
        return;
    value->error = cm1e_sdo_read(reading->bus, reading->position, index, subindex, data, &size, &diag);
    if (value->error == CM1E_ERROR_SDO_ABORT) {
        value->abort_code = diag.foreign_code;
    } else if (value->error != CM1E_OK) {
        reading->error = cm1e_diag_set(reading->diag, value->error, diag.foreign_code, "%s", diag.text);
    } else if (size != 4) {
        value->error = CM1E_ERROR_BUS_MAILBOX;
    } else {
        value->known = true;
        value->value = cm1e_get_u32(data);
    }
}

static void read_values(reading_t *reading, const source_t *sources, size_t count, unsigned channel, void *values)
{
    for (size_t i = 0; i < count; i++)
        read_value(reading, (uint16_t)(sources[i].index + sources[i].next_index * channel),
                   (uint8_t)(sources[i].subindex + sources[i].next_subindex * channel),
                   (cm1e_bridge_value_t *)(void *)((char *)values + sources[i].offset));
}

cm1e_error_t cm1e_bridge_read(cm1e_bus_t *bus, uint16_t position, cm1e_bridge_info_t *info, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_bridge_read()", "", diag);
    if (!info)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "cm1e_bridge_read() needs a place for the values.");
    if (!bus)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "cm1e_bridge_read() needs a bus.");
    memset(info, 0, sizeof *info);
    info->position = position;
    const cm1e_slave_info_t *slave = cm1e_bus_slave(bus, position);
    if (!slave)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "There is no slave %u; %u were found.", position,
                             cm1e_bus_slave_count(bus));
    if (!slave->device || slave->device->recognised != CM1E_BY_OBJECTS)
        return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0,
                             "Slave %u (%s) is no Cool MUSCLE Bridge; `cm1e scan` shows which slaves are.", position,
                             slave->name);
    reading_t reading = {.bus = bus, .position = position, .diag = diag};
    info->model = slave->model;
    info->model_known = cm1e_bridge_name(slave->model) != NULL;
    for (unsigned channel = 0; channel < CM1E_BRIDGE_AXES; channel++)
        read_values(&reading, of_channel, COUNT(of_channel), channel, &info->channels[channel]);
    read_values(&reading, of_device, COUNT(of_device), 0, info);
    return reading.error;
}
