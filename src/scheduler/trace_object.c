/* An object in the process data of a drive as a signal of the trace. */
#include "bus/bus_image.h"
#include "device/devices.h"
#include "scheduler/trace_recorder.h"

/** NULL: the dictionary of the device does not know it. */
static const cm1e_entry_t *known_entry(const cm1e_slave_info_t *slave, uint16_t index, uint8_t subindex)
{
    const cm1e_device_t *device = slave ? slave->device : NULL;
    return device && device->entry ? device->entry(device, index, subindex) : NULL;
}

/** The dictionary says the sign, the mapping the size (0x6079 has 32 bits in one and 16 in the other). */
static cm1e_trace_type_t type_of(const cm1e_entry_t *entry, unsigned bytes)
{
    const bool is_signed = entry && entry->type >= CM1E_TYPE_SINT && entry->type <= CM1E_TYPE_DINT;
    if (bytes == 1)
        return is_signed ? CM1E_TRACE_SINT : CM1E_TRACE_USINT;
    if (bytes == 2)
        return is_signed ? CM1E_TRACE_INT : CM1E_TRACE_UINT;
    return is_signed ? CM1E_TRACE_DINT : CM1E_TRACE_UDINT;
}

cm1e_error_t cm1e_trace_add_object(trace_t *trace, cm1e_bus_t *bus, uint16_t position, const char *axis, uint16_t index,
                                   uint8_t subindex, cm1e_diag_t *diag)
{
    const uint8_t *image = cm1e_bus_inputs(bus);
    cm1e_image_slot_t slot = cm1e_bus_find_input(bus, position, index, subindex);
    if (slot.bytes == 0) {
        image = cm1e_bus_outputs(bus);
        slot = cm1e_bus_find_output(bus, position, index, subindex);
    }
    if (slot.bytes == 0)
        return cm1e_diag_set(diag, CM1E_ERROR_PDO_MAPPING, index,
                             "Object 0x%04X:%02X is not in the process data of axis \"%s\" (slave %u), so that no cycle "
                             "can record it. Choose a mapping that has it.", index, subindex, axis, position);
    const cm1e_entry_t *entry = known_entry(cm1e_bus_slave(bus, position), index, subindex);
    trace_column_t column = {.type = type_of(entry, slot.bytes), .value = image + slot.offset, .little_endian = true};
    snprintf(column.name, sizeof column.name, "%s 0x%04X:%02X%s%s", axis, index, subindex, entry ? " " : "",
             entry ? entry->name : "");
    snprintf(column.unit, sizeof column.unit, "%s", entry && entry->unit ? entry->unit : "");
    return cm1e_trace_add(trace, &column, diag);
}
