#include <stddef.h>
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

/** Whether a struct of this size has the slaves, the last members so far. */
static bool has_slaves(size_t size) { return size >= offsetof(cm1e_bus_config_t, slaves) + sizeof(void *); }

static uint32_t slaves_of(const cm1e_bus_config_t *config)
{
    return has_slaves(size_of(config)) ? config->slave_count : 0;
}

static size_t size_of_slave(const cm1e_bus_config_t *config)
{
    return config->slave_size ? config->slave_size : sizeof *config->slaves;
}

/** Copies rows of one size into new ones of another. false: no memory. */
static bool copy_rows(void **to, size_t to_size, const void *from, size_t from_size, uint32_t count)
{
    *to = count ? calloc(count, to_size) : NULL;
    for (uint32_t i = 0; i < count && *to; i++)
        cm1e_copy_sized((char *)*to + i * to_size, to_size, (const char *)from + i * from_size, from_size);
    return *to || count == 0;
}

cm1e_error_t cm1e_config_copy_sized(cm1e_bus_config_t *to, size_t size, size_t axis_size,
                                    const cm1e_bus_config_t *from)
{
    const uint32_t slaves = slaves_of(from);
    if (from->axis_count > CM1E_MAX_AXES || (from->axis_count > 0 && !from->axes))
        return CM1E_ERROR_CONFIG;
    if (slaves > CM1E_MAX_SLAVES || (slaves > 0 && (!from->slaves || !has_slaves(size))))
        return CM1E_ERROR_CONFIG;
    void *axes = NULL, *slave_rows = NULL;
    if (!copy_rows(&axes, axis_size, from->axes, size_of_axis(from), from->axis_count) ||
        !copy_rows(&slave_rows, sizeof *from->slaves, slaves ? from->slaves : NULL, slaves ? size_of_slave(from) : 0,
                   slaves)) {
        free(axes);
        return CM1E_ERROR_NO_MEMORY;
    }
    cm1e_copy_sized(to, size, from, size_of(from));
    to->size = size;
    to->axis_size = axis_size;
    to->axes = axes;
    if (has_slaves(size)) {
        to->slave_size = slaves ? sizeof *to->slaves : 0;
        to->slaves = slave_rows;
    }
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
    if (!config)
        return CM1E_ERROR_INVALID_ARGUMENT;
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
    if (!config)
        return NULL;
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

cm1e_slave_config_t *cm1e_bus_config_add_slave_sized(cm1e_bus_config_t *config, size_t slave_size, const char *name)
{
    if (!config)
        return NULL;
    const uint32_t index = slaves_of(config);
    if (!has_slaves(size_of(config)) || index >= CM1E_MAX_SLAVES || (index > 0 && !config->slaves))
        return NULL;
    if (index == 0)
        config->slave_size = slave_size;
    const size_t size = size_of_slave(config);
    char *slaves = realloc(config->slaves, (index + 1) * size);
    if (!slaves)
        return NULL;
    config->slaves = (cm1e_slave_config_t *)(void *)slaves;
    config->slave_count = index + 1;
    cm1e_slave_config_t *slave = (cm1e_slave_config_t *)(void *)(slaves + index * size);
    memset(slave, 0, size);
    if (name && name[0])
        snprintf(slave->name, sizeof slave->name, "%s", name);
    else
        snprintf(slave->name, sizeof slave->name, "slave%u", index + 1);
    return slave;
}

cm1e_error_t cm1e_bus_config_size_slaves(cm1e_bus_config_t *config, size_t slave_size, cm1e_diag_t *diag)
{
    void *slaves = NULL;
    if (!config)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0,
                             "cm1e_bus_config_size_slaves() needs a configuration.");
    if (slaves_of(config) == 0 || size_of_slave(config) == slave_size)
        return CM1E_OK;
    if (!copy_rows(&slaves, slave_size, config->slaves, size_of_slave(config), config->slave_count)) {
        cm1e_bus_config_free(config);
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the slaves of the configuration.");
    }
    free(config->slaves);
    config->slaves = slaves;
    config->slave_size = slave_size;
    return CM1E_OK;
}

void cm1e_bus_config_free(cm1e_bus_config_t *config)
{
    if (!config)
        return;
    if (has_slaves(size_of(config))) {
        free(config->slaves);
        config->slaves = NULL;
        config->slave_count = 0;
    }
    free(config->axes);
    config->axes = NULL;
    config->axis_count = 0;
}

/* ---- checking ---------------------------------------------------------------------------------------------------- */

cm1e_error_t cm1e_bus_config_check(const cm1e_bus_config_t *config, cm1e_diag_t *diag)
{
    if (!config)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "cm1e_bus_config_check() needs a configuration.");
    cm1e_config_problem_t problem = {0};
    /* With these counts alone if it cannot be copied. */
    cm1e_bus_config_t own = {.axis_count = config->axis_count, .slave_count = slaves_of(config)};
    const cm1e_error_t error = cm1e_config_copy(&own, config);
    if (error == CM1E_ERROR_NO_MEMORY)
        return cm1e_diag_set(diag, error, 0, "No memory to check the configuration.");
    const bool good = cm1e_config_find_problem(&own, &problem);
    if (error == CM1E_OK)
        cm1e_bus_config_free(&own);
    return good ? cm1e_diag_set(diag, CM1E_OK, 0, "%s", "")
                : cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "%s", problem.text);
}
