#include "description/describe.h"

void cm1e_describe_io_module(cm1e_description_file_t *file)
{
    /* As such modules have them: buffered, outputs with watchdog. */
    static const struct {
        uint16_t start;
        uint8_t control;
        cm1e_sync_manager_use_t use;
        cm1e_fmmu_use_t fmmu;
        cm1e_pdo_t pdo;
    } directions[2] = {
        {0x1000, 0x44, CM1E_SM_OUTPUTS, CM1E_FMMU_OUTPUTS, {0x1600, "Outputs", 1, {{0x7000, 1, 8}}}},
        {0x1100, 0x00, CM1E_SM_INPUTS, CM1E_FMMU_INPUTS, {0x1A00, "Inputs", 1, {{0x6000, 1, 8}}}},
    };
    cm1e_arena_t *arena = &file->arena;
    cm1e_description_t *device = CM1E_APPEND(arena, &file->devices);
    cm1e_description_init(device);
    device->product_code = 0x00000808;
    device->revision = 1;
    device->product_given = device->revision_given = true;
    device->type = device->name = "Digital I/O 8+8";
    device->group = "Digital I/O";
    device->physics = "YY";
    device->eeprom.byte_size = 2048;
    device->eeprom.version = 1;
    device->eeprom.config_data = cm1e_bytes_of(arena, 0x0004, 8); /* PDI: digital I/O */
    for (int n = 0; n < 2; n++) {
        cm1e_described_sync_manager_t *manager = CM1E_APPEND(arena, &device->sync_managers);
        manager->use = directions[n].use;
        manager->start = directions[n].start;
        manager->length = 1;
        manager->length_given = true;
        manager->control = directions[n].control;
        manager->enable = 1;
        cm1e_described_fmmu_t *fmmu = CM1E_APPEND(arena, &device->fmmus);
        fmmu->use = directions[n].fmmu;
        cm1e_describe_pdo(arena, &device->pdos, &device->objects, &directions[n].pdo, n == 1, n);
    }
}
