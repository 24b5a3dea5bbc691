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

static bool is_signed(const cm1e_entry_t *entry)
{
    return entry && entry->type >= CM1E_TYPE_SINT && entry->type <= CM1E_TYPE_DINT;
}

/** The dictionary says the sign, the mapping the size (0x6079 has 32 bits in one and 16 in the other). */
static cm1e_trace_type_t type_of(bool with_sign, unsigned bytes)
{
    if (bytes == 1)
        return with_sign ? CM1E_TRACE_SINT : CM1E_TRACE_USINT;
    if (bytes == 2)
        return with_sign ? CM1E_TRACE_INT : CM1E_TRACE_UINT;
    return with_sign ? CM1E_TRACE_DINT : CM1E_TRACE_UDINT;
}

/** Where the object lies in the process data of the slave; NULL: it is in neither direction. */
static const uint8_t *find(cm1e_bus_t *bus, uint16_t position, uint16_t index, uint8_t subindex, unsigned *bytes)
{
    cm1e_image_slot_t slot = cm1e_bus_find_input(bus, position, index, subindex);
    const uint8_t *image = cm1e_bus_inputs(bus);
    if (slot.bytes == 0) {
        slot = cm1e_bus_find_output(bus, position, index, subindex);
        image = cm1e_bus_outputs(bus);
    }
    *bytes = slot.bytes;
    return slot.bytes ? image + slot.offset : NULL;
}

cm1e_error_t cm1e_trace_add_object(trace_t *trace, cm1e_bus_t *bus, uint16_t position, const char *axis, uint16_t index,
                                   uint8_t subindex, cm1e_diag_t *diag)
{
    unsigned bytes;
    const uint8_t *place = find(bus, position, index, subindex, &bytes);
    if (!place)
        return cm1e_diag_set(diag, CM1E_ERROR_PDO_MAPPING, index,
                             "Object 0x%04X:%02X is not in the process data of axis \"%s\" (slave %u), so that no "
                             "cycle can record it. Choose a mapping that has it.", index, subindex, axis, position);
    const cm1e_entry_t *entry = known_entry(cm1e_bus_slave(bus, position), index, subindex);
    trace_column_t column = {.type = type_of(is_signed(entry), bytes), .value = place, .little_endian = true};
    if (cm1e_bus_slave_watch(bus, position).out) /* what is planned for it may not be what it has */
        column.absent = (trace_object_t){bus, position, index, subindex};
    snprintf(column.name, sizeof column.name, "%s 0x%04X:%02X%s%s", axis, index, subindex, entry ? " " : "",
             entry ? entry->name : "");
    snprintf(column.unit, sizeof column.unit, "%s", entry && entry->unit ? entry->unit : "");
    return cm1e_trace_add(trace, &column, diag);
}

const uint8_t *cm1e_trace_find_object(const trace_object_t *object, cm1e_trace_type_t *type)
{
    unsigned bytes;
    const uint8_t *place = find(object->bus, object->position, object->index, object->subindex, &bytes);
    *type = type_of(*type >= CM1E_TRACE_SINT && *type <= CM1E_TRACE_DINT, bytes);
    return place;
}
