#include "core/bytes.h"
#include "sim/bridge_app.h"

/* Each axis has one mapping in each direction, 16 and 32 bits (BR 6.3.1). */
enum { AXIS_BYTES = 6, POSITION_AT = 2 };
/* The data of a cycle reach the motors after one exchange of the serial lines (F511:3 ... F514:3). */
enum { ON_THE_WAY_NS = 1000000 };

/* ---- assignment ------------------------------------------------------------------------------------------------- */

static uint16_t pdo_of(unsigned axis, bool transmit)
{
    cm1e_pdo_t pdo;
    cm1e_bridge_pdo(&pdo, axis, transmit);
    return pdo.index;
}

void cm1e_sim_bridge_assign_default(cm1e_sim_bridge_t *bridge)
{
    for (unsigned transmit = 0; transmit < 2; transmit++) {
        bridge->assigned[transmit] = CM1E_BRIDGE_AXES;
        for (unsigned axis = 0; axis < CM1E_BRIDGE_AXES; axis++)
            bridge->pdos[transmit][axis] = pdo_of(axis, transmit != 0);
    }
}

uint32_t cm1e_sim_bridge_assign_read(const cm1e_sim_bridge_t *bridge, uint16_t index, uint8_t subindex)
{
    const bool transmit = index == OBJ_1C13_TXPDO_ASSIGN;
    return subindex == 0 ? bridge->assigned[transmit] : bridge->pdos[transmit][subindex - 1];
}

static bool all_different(const uint16_t *pdos, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < i; k++)
            if (pdos[i] == pdos[k])
                return false;
    return true;
}

/* Sub-index 0 to 0, the others, sub-index 0 to what it shall be; of the PDOs, those of csp. */
uint32_t cm1e_sim_bridge_assign_write(cm1e_sim_bridge_t *bridge, uint16_t index, uint8_t subindex, uint32_t value)
{
    const bool transmit = index == OBJ_1C13_TXPDO_ASSIGN;
    if (subindex == 0) {
        if (value > CM1E_BRIDGE_AXES)
            return SDO_ABORT_TOO_HIGH;
        if (!all_different(bridge->pdos[transmit], value))
            return SDO_ABORT_PDO_MAPPING;
        bridge->assigned[transmit] = (uint8_t)value;
        return 0;
    }
    const int axis = cm1e_bridge_axis_of((uint16_t)value);
    if (axis < 0 || pdo_of((unsigned)axis, transmit) != value)
        return SDO_ABORT_PDO_MAPPING;
    if (bridge->assigned[transmit])
        return SDO_ABORT_SUBINDEX_0_NOT_ZERO;
    bridge->pdos[transmit][subindex - 1] = (uint16_t)value;
    return 0;
}

void cm1e_sim_bridge_sizes(void *app, uint16_t *output_bytes, uint16_t *input_bytes)
{
    const cm1e_sim_bridge_t *bridge = app;
    *output_bytes = (uint16_t)(bridge->assigned[0] * AXIS_BYTES);
    *input_bytes = (uint16_t)(bridge->assigned[1] * AXIS_BYTES);
}

/* ---- process data ----------------------------------------------------------------------------------------------- */

static unsigned axis_at(const cm1e_sim_bridge_t *bridge, bool transmit, unsigned place)
{
    return (unsigned)cm1e_bridge_axis_of(bridge->pdos[transmit][place]);
}

/* Cycles that come faster than the lines carry them are lost. If they are far too fast, that is an error anyway
 * (bridge.c). */
void cm1e_sim_bridge_outputs(void *app, const uint8_t *data, uint16_t size, int64_t now_ns)
{
    cm1e_sim_bridge_t *bridge = app;
    cm1e_sim_serial_t *serial = &bridge->serial;
    if (size < bridge->assigned[0] * AXIS_BYTES || serial->count == SERIAL_LINE_CYCLES)
        return;
    const unsigned at = (serial->first + serial->count++) % SERIAL_LINE_CYCLES;
    serial->cycles[at].due_ns = now_ns + ON_THE_WAY_NS;
    serial->cycles[at].present = 0;
    for (unsigned place = 0; place < bridge->assigned[0]; place++, data += AXIS_BYTES) {
        const unsigned axis = axis_at(bridge, false, place);
        serial->cycles[at].present |= (uint8_t)(1u << axis);
        serial->cycles[at].controlwords[axis] = cm1e_get_u16(data);
        serial->cycles[at].targets[axis] = (int32_t)cm1e_get_u32(data + POSITION_AT);
    }
}

int64_t cm1e_sim_bridge_delivery_ns(const cm1e_sim_bridge_t *bridge)
{
    const cm1e_sim_serial_t *serial = &bridge->serial;
    return serial->count > 0 ? serial->cycles[serial->first].due_ns : INT64_MAX;
}

void cm1e_sim_bridge_deliver(cm1e_sim_bridge_t *bridge)
{
    cm1e_sim_serial_t *serial = &bridge->serial;
    while (serial->count > 0 && bridge->now_ns >= serial->cycles[serial->first].due_ns) {
        const unsigned at = serial->first;
        serial->first = (at + 1) % SERIAL_LINE_CYCLES;
        serial->count--;
        for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++) {
            cm1e_sim_bridge_axis_t *axis = &bridge->axes[i];
            if (!(serial->cycles[at].present & 1u << i))
                continue;
            axis->controlword = serial->cycles[at].controlwords[i];
            axis->target_position = serial->cycles[at].targets[i];
            cm1e_sim_bridge_axis_outputs(bridge, axis);
        }
    }
}

void cm1e_sim_bridge_inputs(void *app, uint8_t *data, uint16_t size)
{
    cm1e_sim_bridge_t *bridge = app;
    if (size < bridge->assigned[1] * AXIS_BYTES)
        return;
    for (unsigned place = 0; place < bridge->assigned[1]; place++, data += AXIS_BYTES) {
        const cm1e_sim_bridge_axis_t *axis = &bridge->axes[axis_at(bridge, true, place)];
        cm1e_put_u16(data, cm1e_sim_bridge_statusword(axis));
        cm1e_put_u32(data + POSITION_AT, (uint32_t)cm1e_sim_bridge_shown_position(axis));
    }
}
