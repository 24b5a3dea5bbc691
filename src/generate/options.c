#include "generate/options.h"

#include <stdlib.h>

#include "core/sized.h"

cm1e_error_t cm1e_own_options_take(cm1e_own_options_t *own, const cm1e_generate_options_t *options, size_t size,
                                   size_t device_size, cm1e_diag_t *diag)
{
    own->devices = NULL;
    cm1e_copy_sized(&own->options, sizeof own->options, options, size);
    const size_t count = own->options.devices ? own->options.device_count : 0;
    if (count == 0 || device_size == sizeof *own->devices)
        return CM1E_OK;
    own->devices = calloc(count, sizeof *own->devices);
    if (!own->devices)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    for (size_t i = 0; i < count; i++)
        cm1e_copy_sized(&own->devices[i], sizeof *own->devices,
                        (const char *)own->options.devices + i * device_size, device_size);
    own->options.devices = own->devices;
    return CM1E_OK;
}

void cm1e_own_options_free(cm1e_own_options_t *own) { free(own->devices); }
