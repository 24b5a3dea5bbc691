#include "description/describe.h"

/* In SII word 0: a digital I/O process data interface, and whether the controller emulates the device (0x0141
 * bit 0). */
enum { PDI_DIGITAL_IO = 0x0004, DEVICE_EMULATION = 0x0100 };

typedef struct direction {
    uint16_t start;
    uint8_t control;
    cm1e_sync_manager_use_t use;
    cm1e_fmmu_use_t fmmu;
    cm1e_pdo_t pdo;
} direction_t;

/* As such modules have them: buffered, outputs with watchdog. */
static const direction_t bytes[2] = {
    {0x1000, 0x44, CM1E_SM_OUTPUTS, CM1E_FMMU_OUTPUTS, {0x1600, "Outputs", 1, {{0x7000, 1, 8}}}},
    {0x1100, 0x00, CM1E_SM_INPUTS, CM1E_FMMU_INPUTS, {0x1A00, "Inputs", 1, {{0x6000, 1, 8}}}},
};
static const direction_t bits[2] = {
    {0x1000, 0x44, CM1E_SM_OUTPUTS, CM1E_FMMU_OUTPUTS,
     {0x1600, "Outputs", 4, {{0x7000, 1, 1}, {0x7010, 1, 1}, {0x7020, 1, 1}, {0x7030, 1, 1}}}},
    {0x1100, 0x00, CM1E_SM_INPUTS, CM1E_FMMU_INPUTS,
     {0x1A00, "Inputs", 4, {{0x6000, 1, 1}, {0x6010, 1, 1}, {0x6020, 1, 1}, {0x6030, 1, 1}}}},
};

static const struct {
    const char *name;
    uint32_t product_code;
    uint16_t config;
    const direction_t *directions; /* two; NULL: no process data */
} models[] = {
    [CM1E_SIM_IO_MODULE] = {"Digital I/O 8+8", 0x00000808, PDI_DIGITAL_IO, bytes},
    [CM1E_SIM_IO_TERMINAL] = {"Digital terminal 4+4", 0x00000404, PDI_DIGITAL_IO | DEVICE_EMULATION, bits},
    [CM1E_SIM_IO_COUPLER] = {"Coupler", 0x00000100, PDI_DIGITAL_IO | DEVICE_EMULATION, NULL},
};

static void describe_direction(cm1e_arena_t *arena, cm1e_description_t *device, const direction_t *direction, int n)
{
    cm1e_described_sync_manager_t *manager = CM1E_APPEND(arena, &device->sync_managers);
    manager->use = direction->use;
    manager->start = direction->start;
    manager->length = 1;
    manager->length_given = true;
    manager->control = direction->control;
    manager->enable = 1;
    cm1e_described_fmmu_t *fmmu = CM1E_APPEND(arena, &device->fmmus);
    fmmu->use = direction->fmmu;
    cm1e_describe_pdo(arena, &device->pdos, &device->objects, &direction->pdo, n == 1, n);
}

void cm1e_describe_io(cm1e_description_file_t *file, cm1e_sim_io_t kind)
{
    cm1e_arena_t *arena = &file->arena;
    cm1e_description_t *device = CM1E_APPEND(arena, &file->devices);
    cm1e_description_init(device);
    device->product_code = models[kind].product_code;
    device->revision = 1;
    device->product_given = device->revision_given = true;
    device->type = device->name = models[kind].name;
    device->group = "Digital I/O";
    device->physics = "YY";
    device->eeprom.byte_size = 2048;
    device->eeprom.version = 1;
    device->eeprom.config_data = cm1e_bytes_of(arena, models[kind].config, 8);
    for (int n = 0; n < 2 && models[kind].directions; n++)
        describe_direction(arena, device, &models[kind].directions[n], n);
}
