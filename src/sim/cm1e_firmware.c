#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "description/sii_image.h"
#include "sim/cm1e_app.h"
#include "sim/esc_chip.h"

/*
 * A new firmware by FoE in Bootstrap (UG 4.3; since V1.2.0, UG 10.1). The format of the real files is not public. A
 * simulated one begins with a line that says what it is:
 *     CM1-E simulated firmware 1.3.4, 20000 bytes
 * The memory is erased when that line has come, so a file that breaks off leaves a device without a firmware: it can do
 * Init and Bootstrap only, until a whole file is there.
 */
enum { HEADER_BYTES = 100, VERSION_BYTES = 16 };

static uint32_t planned_fault(cm1e_sim_update_t *update, size_t offset)
{
    if (update->busy > 0) {
        update->busy--;
        return FOE_RESULT_BUSY;
    }
    return update->error && offset >= update->error_at ? update->error : 0;
}

uint32_t cm1e_sim_firmware_begin(void *app, const char *name, uint32_t password)
{
    cm1e_sim_update_t *update = &((cm1e_sim_cm1e_t *)app)->update;
    if (update->name[0] && strcmp(update->name, name) != 0)
        return FOE_CODE_NOT_FOUND;
    if (update->password && update->password != password)
        return FOE_CODE_ACCESS_DENIED;
    return planned_fault(update, 0);
}

static bool read_header(cm1e_sim_update_t *update, const uint8_t *data, size_t size)
{
    char line[HEADER_BYTES] = "", version[VERSION_BYTES] = "";
    memcpy(line, data, size < sizeof line - 1 ? size : sizeof line - 1);
    if (sscanf(line, "CM1-E simulated firmware %15[0-9.], %lu bytes", version, &update->bytes) != 2)
        return false;
    update->firmware = cm1e_firmware_from_version(version);
    return update->firmware != NULL;
}

uint32_t cm1e_sim_firmware_data(void *app, size_t offset, const uint8_t *data, size_t size, bool last)
{
    cm1e_sim_update_t *update = &((cm1e_sim_cm1e_t *)app)->update;
    const uint32_t fault = planned_fault(update, offset);
    if (fault)
        return fault;
    if (offset == 0 && !read_header(update, data, size))
        return FOE_CODE_INVALID_FIRMWARE;
    update->memory = FIRMWARE_BROKEN;
    if (last && offset + size != update->bytes)
        return FOE_CODE_FILE_INCOMPATIBLE;
    if (last)
        update->memory = FIRMWARE_NEW;
    return 0;
}

/** The EEPROM is part of the update (UG 10.1, V1.3.0). The alias is not. */
static void renew_sii(const cm1e_sim_cm1e_t *drive)
{
    uint8_t *image = drive->slave ? malloc(CM1E_SII_SIZE) : NULL;
    const size_t size = image ? cm1e_sim_write_sii(image, CM1E_SII_SIZE, drive) : 0;
    if (size == 0) {
        free(image);
        return;
    }
    free(drive->slave->sii);
    drive->slave->sii = image;
    drive->slave->sii_size = size;
}

void cm1e_sim_firmware_start(cm1e_sim_cm1e_t *drive)
{
    if (drive->update.memory != FIRMWARE_NEW)
        return;
    const cm1e_firmware_info_t *before = drive->firmware;
    drive->firmware = drive->update.firmware;
    if (!cm1e_sim_dictionary_renew(drive)) {
        drive->firmware = before;
        return;
    }
    drive->update.memory = FIRMWARE_WHOLE;
    if (drive->slave)
        drive->slave->ops = cm1e_sim_cm1e_ops(drive);
    renew_sii(drive);
    cm1e_sim_assign_default(drive);
}
