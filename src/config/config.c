#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "config/copy.h"
#include "config/interface.h"
#include "config/problem.h"
#include "core/sized.h"

/* ---- sizes: the program may have been compiled with fewer or more members than the library ----------------------- */

static size_t size_of(const cm1e_bus_config_t *config) { return config->size ? config->size : sizeof *config; }

static size_t size_of_axis(const cm1e_bus_config_t *config)
{
    return config->axis_size ? config->axis_size : sizeof *config->axes;
}

static void *axis_at(const cm1e_bus_config_t *config, uint32_t index)
{
    return (char *)config->axes + index * size_of_axis(config);
}

cm1e_error_t cm1e_config_copy_sized(cm1e_bus_config_t *to, size_t size, size_t axis_size,
                                    const cm1e_bus_config_t *from)
{
    if (from->axis_count > CM1E_MAX_AXES || (from->axis_count > 0 && !from->axes))
        return CM1E_ERROR_CONFIG;
    cm1e_bus_config_t copy = {.size = size, .axis_size = axis_size, .axis_count = from->axis_count};
    copy.axes = from->axis_count ? calloc(from->axis_count, axis_size) : NULL;
    if (from->axis_count && !copy.axes)
        return CM1E_ERROR_NO_MEMORY;
    for (uint32_t i = 0; i < from->axis_count; i++)
        cm1e_copy_sized(axis_at(&copy, i), axis_size, axis_at(from, i), size_of_axis(from));
    cm1e_copy_sized(to, size, from, size_of(from));
    to->size = size;
    to->axis_size = axis_size;
    to->axes = copy.axes;
    return CM1E_OK;
}

cm1e_error_t cm1e_config_copy(cm1e_bus_config_t *to, const cm1e_bus_config_t *from)
{
    return cm1e_config_copy_sized(to, sizeof *to, sizeof *to->axes, from);
}

/* ---- making ------------------------------------------------------------------------------------------------------ */

cm1e_error_t cm1e_bus_config_init_sized(cm1e_bus_config_t *config, size_t size, size_t axis_size,
                                        const char *interface_name, uint32_t axis_count)
{
    memset(config, 0, size);
    config->size = size;
    config->axis_size = axis_size;
    snprintf(config->interface_name, sizeof config->interface_name, "%s",
             interface_name ? interface_name : CM1E_SIM_INTERFACE);
    for (uint32_t i = 0; i < axis_count; i++)
        if (!cm1e_bus_config_add_axis(config, NULL)) {
            const bool full = config->axis_count == CM1E_MAX_AXES;
            cm1e_bus_config_free(config);
            config->axis_count = axis_count; /* without axes: cm1e_bus_config_check() refuses it */
            return full ? CM1E_ERROR_CONFIG : CM1E_ERROR_NO_MEMORY;
        }
    return CM1E_OK;
}

cm1e_axis_config_t *cm1e_bus_config_add_axis(cm1e_bus_config_t *config, const char *name)
{
    const uint32_t index = config->axis_count;
    const size_t size = size_of_axis(config);
    if (index >= CM1E_MAX_AXES || (index > 0 && !config->axes))
        return NULL;
    cm1e_axis_config_t *axes = realloc(config->axes, (index + 1) * size);
    if (!axes)
        return NULL;
    config->axes = axes;
    config->axis_count = index + 1;
    cm1e_axis_config_t *axis = axis_at(config, index);
    memset(axis, 0, size);
    if (name && name[0])
        snprintf(axis->name, sizeof axis->name, "%s", name);
    else
        snprintf(axis->name, sizeof axis->name, "axis%u", index + 1);
    return axis;
}

void cm1e_bus_config_free(cm1e_bus_config_t *config)
{
    if (!config)
        return;
    free(config->axes);
    config->axes = NULL;
    config->axis_count = 0;
}

/* ---- checking ---------------------------------------------------------------------------------------------------- */

cm1e_error_t cm1e_bus_config_check(const cm1e_bus_config_t *config, cm1e_diag_t *diag)
{
    cm1e_config_problem_t problem = {0};
    cm1e_bus_config_t own = {.axis_count = config->axis_count}; /* with this count alone if it cannot be copied */
    const cm1e_error_t error = cm1e_config_copy(&own, config);
    if (error == CM1E_ERROR_NO_MEMORY)
        return cm1e_diag_set(diag, error, 0, "No memory to check the configuration.");
    const bool good = cm1e_config_find_problem(&own, &problem);
    if (error == CM1E_OK)
        cm1e_bus_config_free(&own);
    return good ? cm1e_diag_set(diag, CM1E_OK, 0, "%s", "")
                : cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "%s", problem.text);
}
