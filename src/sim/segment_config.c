#include "sim/segment.h"
#include "sim/slave.h"

enum { EXPLICIT_ID_MAX = 254 };

/* Axes with a position stand there; the others fill the places that are left, in the order of the list. */
static bool place_axes(const cm1e_bus_config_t *config, const cm1e_axis_config_t **places, cm1e_diag_t *diag)
{
    for (uint32_t i = 0; i < config->axis_count; i++) {
        const cm1e_axis_config_t *axis = &config->axes[i];
        if (axis->address_kind != CM1E_ADDRESS_POSITION)
            continue;
        const uint32_t position = axis->address ? axis->address : i + 1;
        if (position > CM1E_MAX_SLAVES || places[position - 1]) {
            cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                          "the simulated segment has no place for axis %u at position %u: it is %s", i + 1, position,
                          position > CM1E_MAX_SLAVES ? "too far away" : "taken by another axis");
            return false;
        }
        places[position - 1] = axis;
    }
    uint32_t free_place = 0;
    for (uint32_t i = 0; i < config->axis_count; i++) {
        if (config->axes[i].address_kind == CM1E_ADDRESS_POSITION)
            continue;
        while (places[free_place])
            free_place++;
        places[free_place] = &config->axes[i];
    }
    return true;
}

/* An axis at position 3 says that two slaves stand before it: where they are no axes, they are I/O modules. */
static uint32_t last_place(const cm1e_axis_config_t *const *places)
{
    uint32_t count = CM1E_MAX_SLAVES;
    while (count && !places[count - 1])
        count--;
    return count;
}

static cm1e_error_t check_axis(const cm1e_axis_config_t *axis, cm1e_diag_t *diag)
{
    if (axis->address_kind == CM1E_ADDRESS_EXPLICIT_ID && axis->address > EXPLICIT_ID_MAX)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "explicit ID %u: the rotary switches give 1 to %d",
                             axis->address, EXPLICIT_ID_MAX);
    if (!cm1e_device_motor(axis->motor))
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "motor '%s' is not known", axis->motor);
    if (axis->firmware[0] && !cm1e_firmware_from_version(axis->firmware))
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "firmware '%s' is not a version", axis->firmware);
    return CM1E_OK;
}

static cm1e_error_t add_place(cm1e_sim_segment_t *segment, const cm1e_bus_config_t *config,
                              const cm1e_axis_config_t *axis, cm1e_diag_t *diag)
{
    const uint16_t alias = axis && axis->address_kind == CM1E_ADDRESS_ALIAS ? axis->address : 0;
    const uint16_t id = axis && axis->address_kind == CM1E_ADDRESS_EXPLICIT_ID ? axis->address : 0;
    if (axis && check_axis(axis, diag) != CM1E_OK)
        return CM1E_ERROR_CONFIG;
    cm1e_sim_slave_t *slave = axis ? cm1e_sim_cm1e_create(axis, config->sim_pdo_order, alias, (uint8_t)id)
                                   : cm1e_sim_io_module_create();
    const cm1e_error_t error = cm1e_sim_segment_add(segment, slave);
    if (error != CM1E_OK) {
        cm1e_sim_slave_destroy(slave);
        return cm1e_diag_set(diag, error, 0, "the simulated slave %u cannot be made: out of memory",
                             cm1e_sim_segment_slave_count(segment) + 1);
    }
    return CM1E_OK;
}

cm1e_sim_segment_t *cm1e_sim_segment_create(const cm1e_bus_config_t *config, cm1e_diag_t *diag)
{
    const cm1e_axis_config_t *places[CM1E_MAX_SLAVES] = {NULL};
    if (config->axis_count > CM1E_MAX_AXES) {
        cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "%u axes: a bus has %d at most", config->axis_count, CM1E_MAX_AXES);
        return NULL;
    }
    if (!place_axes(config, places, diag))
        return NULL;
    cm1e_sim_segment_t *segment = cm1e_sim_segment_create_empty();
    if (!segment) {
        cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "no memory for the simulated segment");
        return NULL;
    }
    const uint32_t count = last_place(places);
    for (uint32_t i = 0; i < count; i++)
        if (add_place(segment, config, places[i], diag) != CM1E_OK) {
            cm1e_sim_segment_destroy(segment);
            return NULL;
        }
    return segment;
}
