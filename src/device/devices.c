#include "device/devices.h"

#include <stdio.h>
#include <string.h>

/* All devices; of a kind the model that can do most comes first. */
static const cm1e_device_t *const devices[] = {
    &cm1e_device_cm1e, &cm1e_device_eb02, &cm1e_device_eb01, &cm1e_device_eb12, &cm1e_device_cia402,
};
enum { DEVICES = sizeof devices / sizeof devices[0] };

const cm1e_device_t *cm1e_device_number(size_t n) { return n < DEVICES ? devices[n] : NULL; }

const cm1e_device_t *cm1e_device_of_model(cm1e_device_model_t model)
{
    for (size_t i = 0; i < DEVICES; i++)
        if (devices[i]->model == model)
            return devices[i];
    return NULL;
}

const cm1e_device_t *cm1e_device_of_identity(uint32_t vendor_id, uint32_t product_code)
{
    for (size_t i = 0; i < DEVICES; i++)
        if (devices[i]->recognised == CM1E_BY_IDENTITY && devices[i]->vendor_id == vendor_id &&
            devices[i]->product_code == product_code)
            return devices[i];
    return NULL;
}

const cm1e_device_t *cm1e_device_recognised(cm1e_recognition_kind_t recognised)
{
    for (size_t i = 0; i < DEVICES; i++)
        if (devices[i]->recognised == recognised)
            return devices[i];
    return NULL;
}

/* Where the configuration names no device, a channel tells a bridge from a CM1-E. */
static const char *kind_of(const cm1e_axis_config_t *axis)
{
    return axis->device[0] ? axis->device : axis->channel ? cm1e_device_eb01.kind : cm1e_device_cm1e.kind;
}

static bool has_motor(const cm1e_device_t *device, const cm1e_axis_config_t *axis)
{
    const cm1e_device_drive_t *drive = cm1e_device_drive(device, axis->channel);
    return !device->channels || axis->motor[0] == '\0' || (drive && strcmp(axis->motor, drive->short_name) == 0);
}

const cm1e_device_t *cm1e_device_configured(const cm1e_axis_config_t *axis)
{
    const char *kind = kind_of(axis);
    const cm1e_device_t *found = NULL;
    for (size_t i = 0; i < DEVICES; i++) {
        if (strcmp(devices[i]->kind, kind) != 0)
            continue;
        if (has_motor(devices[i], axis))
            return devices[i];
        found = found ? found : devices[i];
    }
    return found;
}

const cm1e_device_drive_t *cm1e_device_drive_configured(const cm1e_axis_config_t *axis)
{
    const cm1e_device_t *device = cm1e_device_configured(axis);
    return device ? cm1e_device_drive(device, axis->channel) : NULL;
}

bool cm1e_device_is_shared(const cm1e_axis_config_t *axis)
{
    const cm1e_device_t *device = cm1e_device_configured(axis);
    return device && device->channels > 0;
}

bool cm1e_device_has_motors(const cm1e_device_t *device, const char *const motors[CM1E_BRIDGE_AXES])
{
    for (unsigned i = 0; device && i < device->channels; i++)
        if (motors[i] && motors[i][0] && strcmp(motors[i], device->drives[i]->short_name) != 0)
            return false;
    return device && device->channels > 0;
}

const char *cm1e_device_cycle_times(const cm1e_device_t *device, const char *word, char text[CM1E_CYCLE_TIMES_TEXT])
{
    size_t used = 0;
    text[0] = 0;
    for (size_t i = 0; i < device->cycle_time_count; i++) {
        const bool last = i > 0 && i + 1 == device->cycle_time_count;
        used += (size_t)snprintf(text + used, CM1E_CYCLE_TIMES_TEXT - used, "%s%s%s%lld", last ? " " : i ? ", " : "",
                                 last ? word : "", last ? " " : "", (long long)(device->cycle_times_ns[i] / 1000));
    }
    return text;
}

bool cm1e_device_has_cycle_time(const cm1e_device_t *device, int64_t cycle_time_ns)
{
    bool known = false;
    for (size_t i = 0; i < device->cycle_time_count; i++)
        known = known || device->cycle_times_ns[i] == cycle_time_ns;
    return known;
}

bool cm1e_device_same_kind(const cm1e_device_t *a, const cm1e_device_t *b)
{
    return a && b && strcmp(a->kind, b->kind) == 0;
}

const cm1e_device_drive_t *cm1e_device_drive(const cm1e_device_t *device, unsigned channel)
{
    const unsigned place = device->channels ? channel - 1u : channel;
    return place < (device->channels ? device->channels : 1u) ? device->drives[place] : NULL;
}

const cm1e_device_mode_t *cm1e_device_mode(const cm1e_device_drive_t *drive, int8_t mode)
{
    for (size_t i = 0; i < drive->mode_count; i++)
        if (drive->modes[i].mode == mode)
            return &drive->modes[i];
    return NULL;
}
