#include "description/describe.h"

#include <string.h>

#include "device/devices.h"

static cm1e_error_t wrong(cm1e_diag_t *diag, const char *what)
{
    return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "%s", what);
}

static cm1e_error_t check_common(const cm1e_device_options_t *options, cm1e_diag_t *diag)
{
    if (!cm1e_device_of_model(options->model))
        return wrong(diag, "there is no such device model; there are CM1-E, EB01, EB02 and EB12");
    if (options->config_data_size != 0 && options->config_data_size != sizeof options->config_data)
        return wrong(diag, "the configuration words of the EEPROM are words 0 to 6, 14 bytes");
    return CM1E_OK;
}

typedef cm1e_error_t describe_t(cm1e_description_file_t *file, const cm1e_device_options_t *options,
                                cm1e_esi_layout_t layout, cm1e_diag_t *diag);

static describe_t *describer_of(const cm1e_device_options_t *options)
{
    static const struct {
        const char *device;
        describe_t *describe;
    } rows[] = {{"cm1-e", cm1e_describe_cm1e}, {"bridge", cm1e_describe_bridge}, {"cia402", cm1e_describe_cia402}};
    const char *kind = cm1e_device_of_model(options->model)->kind;
    size_t n = 0;
    while (strcmp(rows[n].device, kind) != 0) /* every device has one */
        n++;
    return rows[n].describe;
}

cm1e_error_t cm1e_describe(cm1e_description_file_t *file, const cm1e_device_options_t *options,
                           cm1e_esi_layout_t layout, cm1e_diag_t *diag)
{
    cm1e_error_t error = check_common(options, diag);
    if (error == CM1E_OK)
        error = describer_of(options)(file, options, layout, diag);
    if (error == CM1E_OK && file->arena.failed)
        error = cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    return error;
}
