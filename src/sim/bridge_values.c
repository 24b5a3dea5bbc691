/* The values of the dictionary: objects of an axis, K parameters, what stays without power. */
#include <stdlib.h>

#include "sim/bridge_app.h"

enum { K_FIRST = 21, K_RESOLUTION = 37, K_50000_PULSES_PER_REVOLUTION = 10 };

static uint16_t on_axis(unsigned axis, uint16_t index)
{
    return (uint16_t)(index + CM1E_BRIDGE_INDEX_INCREMENT * axis);
}

int64_t *cm1e_sim_bridge_value(const cm1e_sim_bridge_t *bridge, unsigned axis, uint16_t index, uint8_t subindex)
{
    cm1e_sim_cell_t cell;
    cm1e_sim_store_find(&bridge->store, on_axis(axis, index), subindex, &cell);
    return cell.value;
}

int64_t *cm1e_sim_bridge_k(const cm1e_sim_bridge_t *bridge, unsigned axis, unsigned number)
{
    return cm1e_sim_bridge_value(bridge, axis, OBJ_60F6_K_PARAMETERS, (uint8_t)(number - K_FIRST + 1));
}

uint32_t cm1e_sim_bridge_product_code(cm1e_device_model_t model)
{
    return (uint32_t)strtoul(cm1e_bridge_name(model), NULL, 16);
}

bool cm1e_sim_bridge_dictionary_create(cm1e_sim_bridge_t *bridge)
{
    if (!cm1e_sim_store_create(&bridge->store, cm1e_device_of_model(bridge->model), CM1E_FIRMWARE_1_2_0))
        return false;
    cm1e_sim_store_set(&bridge->store, OBJ_1018_IDENTITY, 1, CM1E_SIM_BRIDGE_VENDOR_ID);
    cm1e_sim_store_set(&bridge->store, OBJ_1018_IDENTITY, 2, cm1e_sim_bridge_product_code(bridge->model));
    cm1e_sim_store_set(&bridge->store, OBJ_1018_IDENTITY, 3, CM1E_SIM_BRIDGE_REVISION);
    for (unsigned axis = 0; axis < CM1E_BRIDGE_AXES; axis++)
        *cm1e_sim_bridge_k(bridge, axis, K_RESOLUTION) = K_50000_PULSES_PER_REVOLUTION;
    return true;
}

/* "Each data is saved in EEPROM of Cool Muscle" (BR 7.5), which includes what is K by another name. */
static bool non_volatile(uint16_t index)
{
    const int axis = cm1e_bridge_axis_of(index);
    const unsigned first = axis < 0 ? index : index - CM1E_BRIDGE_INDEX_INCREMENT * (unsigned)axis;
    return index == OBJ_1018_IDENTITY || first == OBJ_60F6_K_PARAMETERS || first == OBJ_60FB_H_PARAMETERS;
}

void cm1e_sim_bridge_dictionary_reset(cm1e_sim_bridge_t *bridge)
{
    const cm1e_sim_store_t *store = &bridge->store;
    for (size_t i = 0; i < store->object_count; i++)
        for (uint16_t k = 0; k < store->objects[i]->entry_count && !non_volatile(store->objects[i]->index); k++)
            store->values[store->first_entry[i] + k] = store->objects[i]->entries[k].default_value;
    cm1e_sim_store_set_profile_values(&bridge->store);
}
