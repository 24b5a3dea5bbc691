/* Start-up of a CM1-E: its motor, its firmware, and the unit of velocities that follows from it. */
#include "drive/drive_private.h"

/* If the firmware is unknown, a drive with this unit is taken for an old one in all other respects. */
static void set_velocity_unit(cm1e_drive_t *drive, bool in_counts_per_ms)
{
    drive->range.velocity_unit = in_counts_per_ms ? 1000 : 1;
    drive->range.velocity_most = (int32_t)(drive->motor->max_velocity_counts_per_s / drive->range.velocity_unit);
    drive->range.velocity_quarter = drive->firmware ? drive->firmware->velocity_quarter_in_hm_pp : in_counts_per_ms;
}

static cm1e_error_t velocity_unit(cm1e_drive_t *drive, cm1e_diag_t *diag)
{
    const cm1e_axis_config_t *config = drive->config;
    if (config->velocity_unit_stated) {
        set_velocity_unit(drive, config->velocity_in_counts_per_ms);
        return CM1E_OK;
    }
    if (!drive->firmware)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, OBJ_100A_SOFTWARE_VERSION,
                             "Axis \"%s\" (slave %u): the firmware version (object 0x100A) cannot be read, and the "
                             "unit of velocities depends on it (counts/ms before V1.3.3). State the unit in the "
                             "configuration of the axis.", config->name, drive->position);
    set_velocity_unit(drive, drive->firmware->velocity_in_counts_per_ms);
    return CM1E_OK;
}

cm1e_error_t cm1e_drive_init_cm1e(cm1e_drive_t *drive, cm1e_diag_t *diag)
{
    drive->motor = cm1e_device_motor(drive->config->motor);
    if (!drive->motor)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "Axis \"%s\": there is no motor \"%s\".",
                             drive->config->name, drive->config->motor);
    drive->firmware = cm1e_bus_slave_firmware(drive->bus, drive->position);
    if (!drive->firmware && cm1e_drive_is_absent(drive)) {
        set_velocity_unit(drive, drive->config->velocity_unit_stated && drive->config->velocity_in_counts_per_ms);
        return CM1E_OK; /* until it comes */
    }
    return velocity_unit(drive, diag);
}

cm1e_error_t cm1e_drive_bind_cm1e(cm1e_drive_t *drive)
{
    drive->firmware = cm1e_bus_slave_firmware(drive->bus, drive->position);
    return velocity_unit(drive, NULL);
}
