/* The servo drive by CiA 402 as the simulator plays it: its SII. Of a real one its maker has the description. */
#include "description/describe.h"
#include "device/cia402_drive.h"

cm1e_error_t cm1e_describe_cia402(cm1e_description_file_t *file, const cm1e_device_options_t *options,
                                  cm1e_esi_layout_t layout, cm1e_diag_t *diag)
{
    cm1e_arena_t *arena = &file->arena;
    if (layout != CM1E_ESI_FLAT)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "a generic CiA 402 servo drive has no modules");
    cm1e_description_t *device = CM1E_APPEND(arena, &file->devices);
    cm1e_description_init(device);
    device->product_code = CM1E_CIA402_SIM_PRODUCT_CODE;
    device->revision = CM1E_CIA402_SIM_REVISION;
    device->product_given = device->revision_given = true;
    device->type = device->name = cm1e_device_cia402.name;
    device->group = device->group_name = "Servo drives";
    cm1e_describe_channel(arena, device);
    size_t count;
    const cm1e_object_t *objects = cm1e_cia402_objects(&count);
    for (size_t i = 0; i < count; i++)
        cm1e_describe_object(arena, &device->objects, &objects[i], CM1E_FIRMWARE_1_2_0);
    for (int transmit = 0; transmit < 2; transmit++)
        for (unsigned n = 0; n < CM1E_CIA402_MAPPINGS; n++) {
            cm1e_pdo_t pdo;
            const int manager = transmit ? CM1E_SM_NUMBER_INPUTS : CM1E_SM_NUMBER_OUTPUTS;
            cm1e_cia402_pdo(&pdo, n, transmit);
            cm1e_describe_pdo(arena, &device->pdos, &device->objects, &pdo, transmit,
                              n == 0 ? manager : CM1E_NO_SYNC_MANAGER);
        }
    cm1e_describe_communication(arena, device, options);
    device->mailbox.foe = true; /* the simulated drive keeps a file */
    cm1e_describe_eeprom(arena, device, options, false);
    cm1e_describe_sync_managers(arena, device, cm1e_device_sync_managers, &device->pdos);
    return CM1E_OK;
}
