/* Whether a slave that is brought back is the expected one, by what it answers; what is taken of one that comes for the
 * first time. */
#include <string.h>

#include "bus/bus_internal.h"
#include "bus/recovery.h"

/** Whether its objects are those of the expected device. A device that comes for the first time is compared with the
 *  configuration; one that has come back is compared with what it was. */
bool cm1e_recovery_is_recognised(cm1e_bus_slave_t *slave)
{
    const cm1e_recognition_t *job = &slave->recognition;
    cm1e_device_model_t model;
    if (slave->info.device->recognised == CM1E_BY_PROFILE)
        return (job->device_type & 0xFFFF) == slave->info.device->profile;
    if (!slave->hot.planned)
        return job->recognised && memcmp(&job->facts, &slave->bridge, sizeof job->facts) == 0;
    if (!job->recognised || !cm1e_recognise_model(&job->facts, &model) || model != slave->info.model)
        return false;
    slave->bridge = job->facts;
    for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++)
        slave->info.motors[i] = (uint8_t)job->facts.motors[i];
    return true;
}

/** Whether the firmware of a device makes a difference. */
bool cm1e_recovery_has_firmware(const cm1e_bus_slave_t *slave)
{
    return slave->info.device && slave->info.device->firmware;
}

/** Takes the firmware of a motor that comes for the first time, because its units depend on it. One that has come back
 *  may be another motor with the same address: its firmware has to behave as before. */
bool cm1e_recovery_takes_version(cm1e_bus_slave_t *slave)
{
    const cm1e_axis_config_t *axis = slave->hot.axis;
    const size_t longest = sizeof slave->info.software_version - 1;
    const size_t size = slave->version_sdo.size < longest ? slave->version_sdo.size : longest;
    slave->version[slave->version_sdo.error == CM1E_OK ? size : 0] = '\0';
    for (char *c = slave->version; *c; c++)
        *c = *c >= ' ' && *c <= '~' ? *c : '?';
    if (!slave->hot.planned)
        return slave->info.device->firmware(slave->version) == slave->firmware;
    memcpy(slave->info.software_version, slave->version, longest);
    if (cm1e_recovery_has_firmware(slave))
        slave->firmware = slave->info.device->firmware(slave->info.software_version);
    const char *shown = slave->info.software_version + (slave->info.software_version[0] == 'V');
    return !axis || !axis->firmware[0] || strcmp(axis->firmware, shown) == 0;
}

/** Takes the mapping. A slave that comes for the first time may have any layout that fits into its room and has the
 *  signals of the configuration. */
bool cm1e_recovery_takes_mapping(cm1e_bus_slave_t *slave)
{
    const cm1e_mapping_job_t *job = &slave->mapping;
    const bool motors = cm1e_bus_has_motors(slave);
    for (int direction = 0; direction < 2; direction++) {
        const bool free = slave->hot.planned && (motors || !slave->hot.stated[direction]);
        if (!free && !cm1e_mapping_equal(&job->mapped[direction], &slave->mapped[direction]))
            return false;
    }
    if (!slave->hot.planned)
        return true;
    for (int direction = 0; direction < 2; direction++)
        slave->hot.relaid += motors && !cm1e_mapping_equal(&job->mapped[direction], &slave->mapped[direction]);
    slave->by_pdos = !motors && job->unknown < 2;
    memcpy(slave->mapped, job->mapped, sizeof slave->mapped);
    return true;
}
