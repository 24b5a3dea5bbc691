#include "generate/generate_options.h"

#include <stdlib.h>

#include "core/sized.h"

static cm1e_device_options_t *own_devices(const cm1e_generate_options_t *options, size_t device_size)
{
    cm1e_device_options_t *devices = calloc(options->device_count, sizeof *devices);
    for (size_t i = 0; devices && i < options->device_count; i++)
        cm1e_copy_sized(&devices[i], sizeof *devices, (const char *)options->devices + i * device_size, device_size);
    return devices;
}

cm1e_error_t cm1e_generate_with(cm1e_generator_t *generator, cm1e_file_t *file, const cm1e_generate_options_t *options,
                                size_t size, size_t device_size, cm1e_diag_t *diag)
{
    cm1e_generate_options_t own;
    cm1e_device_options_t *devices = NULL;
    if (!file || !options)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "A file that is written needs a place and options.");
    *file = (cm1e_file_t){0};
    cm1e_copy_sized(&own, sizeof own, options, size);
    if (own.devices && own.device_count > 0 && device_size != sizeof *devices) {
        devices = own_devices(&own, device_size);
        if (!devices)
            return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
        own.devices = devices;
    }
    const cm1e_error_t error = generator(file, &own, diag);
    free(devices);
    return error;
}
