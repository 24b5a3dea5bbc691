#include "sim/bridge_app.h"

/* ---- what there is ---------------------------------------------------------------------------------------------- */

const cm1e_object_t *cm1e_sim_bridge_object(void *app, size_t n)
{
    return cm1e_sim_store_object(&((const cm1e_sim_bridge_t *)app)->store, n);
}

const cm1e_entry_t *cm1e_sim_bridge_entry(void *app, uint16_t index, uint8_t subindex)
{
    cm1e_sim_cell_t cell;
    cm1e_sim_store_find(&((const cm1e_sim_bridge_t *)app)->store, index, subindex, &cell);
    return cell.entry;
}

/* "N/A" is an object that cannot be used, "-" a parameter that the motor has not (docs/DEVICE.md). */
static uint32_t check_available(const cm1e_entry_t *entry)
{
    return entry->availability == CM1E_NOT_AVAILABLE  ? SDO_ABORT_UNSUPPORTED_ACCESS
           : entry->availability == CM1E_NO_PARAMETER ? SDO_ABORT_NO_SUBINDEX
                                                      : 0;
}

/* ---- K parameters ----------------------------------------------------------------------------------------------- */

enum { K_SPEED = 42, K_ACCELERATION = 43, K_OFFSET = 48 };

/* Four objects are K parameters under another name (BR 6.4.1); 0: not one of them. */
static unsigned k_behind(uint16_t index_on_first_axis, uint8_t subindex)
{
    switch (index_on_first_axis) {
    case OBJ_607C_HOME_OFFSET: return K_OFFSET;
    case OBJ_6099_HOMING_SPEEDS: return subindex > 0 ? K_SPEED : 0;
    case OBJ_609A_HOMING_ACCELERATION: return K_ACCELERATION;
    default: return 0;
    }
}

/* ---- access ----------------------------------------------------------------------------------------------------- */

/* F530: four counters or states for the axes each, then the cycle (BR 7.4). */
static int64_t system_info(const cm1e_sim_bridge_t *bridge, uint8_t subindex)
{
    const unsigned group = (subindex - 1u) / CM1E_BRIDGE_AXES;
    const cm1e_sim_bridge_axis_t *axis = &bridge->axes[(subindex - 1u) % CM1E_BRIDGE_AXES];
    const uint32_t cycle[] = {bridge->longest_us, bridge->shortest_us, bridge->late_cycles, bridge->early_cycles};
    enum { RECEIVE_ERRORS, STATUS, SENT, RECEIVED, CYCLE };
    switch (group) {
    case RECEIVE_ERRORS: return axis->sent - axis->received;
    case STATUS: return cm1e_sim_bridge_motor_status(axis);
    case SENT: return axis->sent;
    case RECEIVED: return axis->received;
    case CYCLE: return cycle[(subindex - 1u) % CM1E_BRIDGE_AXES];
    default: return 0; /* system test information */
    }
}

static int64_t value_of_axis(const cm1e_sim_bridge_t *bridge, const cm1e_sim_bridge_axis_t *axis,
                             const cm1e_sim_cell_t *cell)
{
    const uint16_t first = (uint16_t)(cell->entry->index - CM1E_BRIDGE_INDEX_INCREMENT * axis->number);
    const unsigned k = k_behind(first, cell->entry->subindex);
    switch (first) {
    case OBJ_6040_CONTROLWORD: return axis->controlword;
    case OBJ_6041_STATUSWORD: return cm1e_sim_bridge_statusword(axis);
    case OBJ_6061_MODES_OF_OPERATION_DISPLAY: return axis->mode;
    case OBJ_6064_POSITION_ACTUAL_VALUE: return cm1e_sim_bridge_shown_position(axis);
    case OBJ_607A_TARGET_POSITION: return axis->target_position;
    case OBJ_60FD_DIGITAL_INPUTS:
        return cm1e_sim_bridge_io_available(axis) ? cm1e_sim_bridge_inputs_of(axis) : 0;
    case OBJ_60FE_DIGITAL_OUTPUTS: /* "identified by Cool Muscle's CPU" (BR 6.5.2), not what was written */
        return cell->entry->subindex == 1 ? axis->outputs : *cell->value;
    default: return k ? *cm1e_sim_bridge_k(bridge, axis->number, k) : *cell->value;
    }
}

static int64_t present_value(const cm1e_sim_bridge_t *bridge, const cm1e_sim_cell_t *cell)
{
    const uint16_t index = cell->entry->index;
    const int axis = cm1e_bridge_axis_of(index);
    if (index == OBJ_1C12_RXPDO_ASSIGN || index == OBJ_1C13_TXPDO_ASSIGN)
        return cm1e_sim_bridge_assign_read(bridge, index, cell->entry->subindex);
    if (index == OBJ_F530_SYSTEM_INFO && cell->entry->subindex > 0)
        return system_info(bridge, cell->entry->subindex);
    return axis < 0 || index < 0x6000 ? *cell->value : value_of_axis(bridge, &bridge->axes[axis], cell);
}

/* The axis whose string this is, of four objects in a row; NULL: none of them. */
static cm1e_sim_bridge_axis_t *axis_of_string(cm1e_sim_bridge_t *bridge, uint16_t index, uint16_t first)
{
    return index >= first && index < first + CM1E_BRIDGE_AXES ? &bridge->axes[index - first] : NULL;
}

static const char *present_text(cm1e_sim_bridge_t *bridge, const cm1e_entry_t *entry)
{
    cm1e_sim_bridge_axis_t *axis = axis_of_string(bridge, entry->index, OBJ_F591_CML_RESPONSE_AXIS_1);
    const bool is_version = entry->index == OBJ_1009_HARDWARE_VERSION || entry->index == OBJ_100A_SOFTWARE_VERSION;
    return axis ? cm1e_sim_bridge_cml_read(bridge, axis) : is_version ? "simulated" : entry->default_string;
}

uint32_t cm1e_sim_bridge_sdo_read(void *app, uint16_t index, uint8_t subindex, uint8_t al_state, uint8_t *data,
                                  size_t *size)
{
    (void)al_state; /* the mailbox is there from Pre-Operational on (BR 5.2) */
    cm1e_sim_bridge_t *bridge = app;
    cm1e_sim_cell_t cell;
    const uint32_t missing = cm1e_sim_store_find(&bridge->store, index, subindex, &cell);
    const uint32_t abort_code = missing ? missing : check_available(cell.entry);
    if (abort_code)
        return abort_code;
    return cell.entry->type == CM1E_TYPE_STRING
               ? cm1e_sim_give_text(present_text(bridge, cell.entry), data, size)
               : cm1e_sim_give_number(cell.entry, present_value(bridge, &cell), data, size);
}

/* NOLINTBEGIN(clang-analyzer-core.NullDereference): the store has the objects of each axis, an app its bridge */

/* An output that the mask excludes is off (BR 6.5.2). */
static void set_outputs(cm1e_sim_bridge_t *bridge, cm1e_sim_bridge_axis_t *axis)
{
    const int64_t wanted = *cm1e_sim_bridge_value(bridge, axis->number, OBJ_60FE_DIGITAL_OUTPUTS, 1);
    const int64_t mask = *cm1e_sim_bridge_value(bridge, axis->number, OBJ_60FE_DIGITAL_OUTPUTS, 2);
    axis->outputs = (uint8_t)(wanted & mask & cm1e_bridge_output_mask(axis->motor));
}

static void take_value(cm1e_sim_bridge_t *bridge, const cm1e_sim_cell_t *cell, int64_t value)
{
    const int axis = cm1e_bridge_axis_of(cell->entry->index);
    if (axis < 0) {
        *cell->value = value;
        return;
    }
    const uint16_t first = (uint16_t)(cell->entry->index - CM1E_BRIDGE_INDEX_INCREMENT * axis);
    const unsigned k = k_behind(first, cell->entry->subindex);
    if (first == OBJ_6040_CONTROLWORD)
        bridge->axes[axis].controlword = (uint16_t)value;
    else if (first == OBJ_607A_TARGET_POSITION)
        bridge->axes[axis].target_position = (int32_t)value;
    else
        *(k ? cm1e_sim_bridge_k(bridge, (unsigned)axis, k) : cell->value) = value;
    if (first == OBJ_6060_MODES_OF_OPERATION)
        cm1e_sim_bridge_request_mode(bridge, &bridge->axes[axis], (int8_t)value);
    if (k || first == OBJ_6098_HOMING_METHOD)
        bridge->axes[axis].settings_ns = bridge->now_ns;
    if (first != OBJ_60FE_DIGITAL_OUTPUTS)
        return;
    if (cm1e_sim_bridge_io_available(&bridge->axes[axis]))
        set_outputs(bridge, &bridge->axes[axis]);
    else if (cell->entry->subindex == 1)
        bridge->axes[axis].broken_rules |= CM1E_SIM_OUTPUT_IN_VAIN;
}

/* NOLINTEND(clang-analyzer-core.NullDereference) */

uint32_t cm1e_sim_bridge_sdo_write(void *app, uint16_t index, uint8_t subindex, uint8_t al_state, const uint8_t *data,
                                   size_t size)
{
    cm1e_sim_bridge_t *bridge = app;
    cm1e_sim_cell_t cell;
    const uint32_t missing = cm1e_sim_store_find(&bridge->store, index, subindex, &cell);
    uint32_t abort_code = missing ? missing : check_available(cell.entry);
    cm1e_sim_bridge_axis_t *sender = axis_of_string(bridge, index, OBJ_F581_CML_COMMAND_AXIS_1);
    if (!abort_code && sender)
        return cm1e_sim_bridge_cml_write(bridge, sender, data, size);
    if (!abort_code && cell.entry->type == CM1E_TYPE_STRING)
        abort_code = SDO_ABORT_READ_ONLY;
    if (!abort_code)
        abort_code = cm1e_sim_check_write(cell.entry, al_state, size);
    if (abort_code)
        return abort_code;
    const int64_t value = cm1e_sim_take_number(cell.entry, data);
    if (index == OBJ_1C12_RXPDO_ASSIGN || index == OBJ_1C13_TXPDO_ASSIGN)
        return cm1e_sim_bridge_assign_write(bridge, index, subindex, (uint32_t)value);
    abort_code = cm1e_sim_check_range(cell.entry, value);
    if (!abort_code)
        take_value(bridge, &cell, value);
    return abort_code;
}
