#include "drive/drive_kind.h"

#include <string.h>

#include "drive/drive_private.h"

static const cm1e_drive_kind_t kinds[] = {
    {"cm1-e", cm1e_drive_init_cm1e, NULL, cm1e_drive_bind_cm1e},
    {"bridge", cm1e_drive_init_bridge, cm1e_drive_bridge_step, NULL},
    {"cia402", cm1e_drive_init_cia402, cm1e_drive_cia402_step, NULL},
};

const cm1e_drive_kind_t *cm1e_drive_kind(const cm1e_device_t *device)
{
    for (size_t i = 0; device && i < sizeof kinds / sizeof kinds[0]; i++)
        if (strcmp(kinds[i].device, device->kind) == 0)
            return &kinds[i];
    return NULL;
}
