/* The device of an axis: which it is, where it is, its motor, and the keys that it has. */
#include <stdio.h>
#include <string.h>

#include "config/ranges.h"
#include "device/place.h"
#include "device/unit.h"

/* "A, B or C" */
static void list_motors(const cm1e_device_t *device, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (size_t i = 0; device->motor(i) && used < size; i++)
        used += (size_t)snprintf(text + used, size - used, "%s%s",
                                 i == 0 ? "" : device->motor(i + 1) ? ", " : " or ", device->motor(i));
}

static bool check_motor(const check_t *check)
{
    const cm1e_axis_config_t *axis = check->axis;
    const cm1e_device_t *device = device_of(check);
    const char *name = IS_TEXT(axis->motor) ? axis->motor : "?";
    char list[120];
    if (name[0] == '\0')
        return true;
    for (size_t i = 0; device->motor(i); i++)
        if (strcmp(device->motor(i), name) == 0)
            return true;
    list_motors(device, list, sizeof list);
    return axis_wrong(check, "motor", "is '%s'; expected %s%s", name, list, device->motors_note);
}

static bool check_firmware(const check_t *check)
{
    const char *version = check->axis->firmware;
    if (version[0] == '\0')
        return true;
    const cm1e_firmware_info_t *info = IS_TEXT(check->axis->firmware) ? cm1e_firmware_from_version(version) : NULL;
    if (!info || strcmp(info->version, version) != 0) {
        char known[80] = "";
        for (int i = 0; i < CM1E_FIRMWARE_COUNT; i++)
            snprintf(known + strlen(known), sizeof known - strlen(known), "%s%s", i ? ", " : "",
                     cm1e_firmware_info((cm1e_firmware_t)i)->version);
        return axis_wrong(check, "firmware", "is '%.*s'; expected one of: %s", (int)sizeof check->axis->firmware - 1,
                          IS_TEXT(check->axis->firmware) ? version : "?", known);
    }
    const int64_t cycle_time_ns = check->config->cycle_time_ns;
    if (!info->all_cycle_times && cycle_time_ns != 0 && cycle_time_ns != 1000000)
        return axis_wrong(check, "firmware", "is %s, which runs at 1000 us only; the cycle time is %g us", version,
                          (double)cycle_time_ns / 1000);
    return true;
}

const cm1e_config_address_t cm1e_config_addresses[] = {
    [CM1E_ADDRESS_POSITION] = {"position", CM1E_MAX_SLAVES},
    [CM1E_ADDRESS_ALIAS] = {"alias", 65535},
    [CM1E_ADDRESS_EXPLICIT_ID] = {"explicit_id", 254}, /* UG 4.2.3: 0xFF cannot be used */
};

static bool at_same_address(const check_t *check, uint32_t other)
{
    const cm1e_axis_config_t *axis = &check->config->axes[other];
    return cm1e_axis_has_motor(axis) && axis->address_kind == check->axis->address_kind &&
           check->addresses[other] == check->addresses[check->index];
}

/* An earlier entry has the same address: allowed only behind one bridge, each axis at its own connector. */
static bool may_share(const check_t *check, uint32_t other)
{
    const bool shares = cm1e_device_is_shared(check->axis);
    const bool other_shares = cm1e_device_is_shared(&check->config->axes[other]);
    const unsigned channel = check->axis->channel;
    const char *key = cm1e_config_addresses[check->axis->address_kind].key;
    const unsigned address = check->addresses[check->index];
    if (!shares && !other_shares)
        return axis_wrong(check, key, "is %u, which entry %u of the list has already; expected one axis at each "
                          "address", address, other + 1);
    if (!shares || !other_shares)
        return axis_wrong(check, key, "is %u, as that of entry %u of the list, and only one of the two has a channel; "
                          "expected a channel for every axis of a bridge", address, other + 1);
    if (channel == check->config->axes[other].channel)
        return axis_wrong(check, "channel", "is %u, which entry %u of the list has already on this bridge; expected "
                          "one axis at each channel", channel, other + 1);
    return true;
}

static bool check_address(const check_t *check)
{
    const unsigned kind = check->axis->address_kind;
    if (kind > CM1E_ADDRESS_EXPLICIT_ID)
        return axis_wrong(check, "position", "is of the unknown kind %u; expected position, alias or explicit ID",
                          kind);
    const uint16_t address = check->addresses[check->index];
    if (address == 0 || address > cm1e_config_addresses[kind].maximum)
        return axis_wrong(check, cm1e_config_addresses[kind].key, "is %u; expected 1 ... %u", address,
                          cm1e_config_addresses[kind].maximum);
    for (uint32_t i = 0; i < check->index; i++)
        if (at_same_address(check, i) && !may_share(check, i))
            return false;
    return true;
}

/* The motors at this address, up to this entry. */
static bool check_model(const check_t *check)
{
    const char *motors[CM1E_BRIDGE_AXES] = {"", "", "", ""};
    for (uint32_t i = 0; i <= check->index; i++)
        if (at_same_address(check, i))
            motors[check->config->axes[i].channel - 1] = check->config->axes[i].motor;
    const cm1e_device_t *device = device_of(check);
    return device->with_motors(motors) ||
           axis_wrong(check, "motor", "is %s at channel %u, which no %s has together with the others; expected %s",
                      check->axis->motor, check->axis->channel, device->family, device->models_note);
}

/* What means nothing for the device. */
static bool check_absent(const check_t *check)
{
    const cm1e_axis_config_t *axis = check->axis;
    const struct {
        const char *key;
        bool given;
    } keys[] = {
        {"explicit_id", axis->address_kind == CM1E_ADDRESS_EXPLICIT_ID},
        {"k37", axis->k37_stated},
        {"firmware", axis->firmware[0] != '\0'},
        {"mapping", axis->mapping != CM1E_MAPPING_DYNAMIC},
        {"motion", axis->motion != CM1E_MOTION_HOST},
        {"wire.velocity_unit", axis->velocity_unit_stated},
        {"wire.acceleration_unit", axis->acceleration_in_kpulses},
        {"dc", cm1e_config_has_pulses(&axis->dc)},
    };
    for (const cm1e_absent_key_t *absent = device_of(check)->absent; absent->key; absent++)
        for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
            if (keys[i].given && strcmp(keys[i].key, absent->key) == 0)
                return axis_wrong(check, keys[i].key, "%s", absent->text);
    return true;
}

/* A slave that several axes share. */
static bool check_shared(const check_t *check)
{
    const cm1e_device_t *device = device_of(check);
    const int64_t cycle_time_ns = check->config->cycle_time_ns;
    char list[CM1E_CYCLE_TIMES_TEXT];
    if (!cm1e_device_is_shared(check->axis))
        return true;
    if (cycle_time_ns != 0 && !cm1e_device_has_cycle_time(device, cycle_time_ns))
        return axis_wrong(check, "channel", "is given, and a %s runs at %s us only; the cycle time is %g us",
                          device->family, cm1e_device_cycle_times(device, "and", list), (double)cycle_time_ns / 1000);
    return check_model(check);
}

static bool check_kind(const check_t *check)
{
    const cm1e_axis_config_t *axis = check->axis;
    const cm1e_device_t *device = IS_TEXT(axis->device) ? device_of(check) : NULL;
    if (!device)
        return axis_wrong(check, "device", "is '%.*s'; expected cm1-e, bridge or cia402", (int)sizeof axis->device - 1,
                          IS_TEXT(axis->device) ? axis->device : "?");
    if (device->channels && axis->channel == 0)
        return axis_wrong(check, "channel", "is missing; expected 1 ... %u, the connector of the bridge",
                          device->channels);
    return device->channels || axis->channel == 0 ||
           axis_wrong(check, "channel", "is %u, and the device %s is one axis; expected no channel", axis->channel,
                      device->kind);
}

/* A motor that the library does not know is stated. */
static bool check_stated_motor(const check_t *check)
{
    const cm1e_axis_config_t *axis = check->axis;
    const bool needed = device_of(check)->motor_stated;
    const struct {
        const char *key;
        bool given, needed;
    } keys[] = {{"drive.counts_per_revolution", axis->counts_per_revolution != 0, true},
                {"drive.max_speed_rpm", axis->max_speed_rpm != 0, true},
                {"drive.outputs_pdo", axis->outputs_pdo != 0, axis->inputs_pdo != 0},
                {"drive.inputs_pdo", axis->inputs_pdo != 0, axis->outputs_pdo != 0}};
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++)
        if (keys[i].given && !needed)
            return axis_wrong(check, keys[i].key, "is given, and the device %s is known without it; expected it with "
                              "the device cia402 only", device_of(check)->kind);
        else if (needed && keys[i].needed && !keys[i].given)
            return axis_wrong(check, keys[i].key, "is missing; expected it with the device %s",
                              device_of(check)->kind);
    return true;
}

static bool check_pulses(const check_t *check)
{
    char text[CM1E_WRONG_PULSES];
    const char *key = cm1e_config_wrong_pulses(check->config, &check->axis->dc, text);
    return !key || axis_wrong(check, key, "%s", text);
}

/* Keys that only this device has. */
static bool check_own_keys(const check_t *check)
{
    cm1e_wrong_key_t wrong;
    const cm1e_device_t *device = device_of(check);
    return !device->check_axis || device->check_axis(check->axis, &wrong) ||
           axis_wrong(check, wrong.key, "%s", wrong.text);
}

static bool check_channel(const check_t *check)
{
    return check->axis->channel <= CM1E_BRIDGE_AXES ||
           axis_wrong(check, "channel", "is %u; expected 1 ... %d", check->axis->channel, CM1E_BRIDGE_AXES);
}

bool cm1e_config_check_device(const check_t *check)
{
    if (!cm1e_axis_has_motor(check->axis))
        return cm1e_config_check_without_motor(check);
    return check_channel(check) && check_kind(check) && check_address(check) && check_motor(check) &&
           check_absent(check) && check_pulses(check) && check_shared(check) && check_stated_motor(check) &&
           check_own_keys(check) && check_firmware(check);
}
