#include <stdlib.h>

#include "description/check_private.h"

/* Compares the identity of the device, 0x1000 and 0x1018, with the head of the description. */

enum { OBJECT_DEVICE_TYPE = 0x1000, OBJECT_IDENTITY = 0x1018, OBJECT_SM_TYPES = 0x1C00, PROFILE_MODULAR = 5001 };

/* Files state the default 0 for a value that the device fills in itself. */
static bool stated(const cm1e_check_t *check, uint16_t index, uint8_t subindex, uint32_t *value, cm1e_place_t *place)
{
    return cm1e_check_default(check, index, subindex, value, place) && *value != 0;
}

static void check_identity_object(const cm1e_check_t *check)
{
    const cm1e_description_t *device = check->device;
    /* Files that describe many revisions of a device often have one dictionary for all of them. */
    const struct {
        uint8_t subindex;
        const char *what;
        uint32_t value;
        bool given;
        cm1e_rule_t rule;
    } parts[] = {{1, "vendor", device->vendor_id, device->vendor_id != 0, CM1E_RULE_IDENTITY_OBJECT},
                 {2, "product code", device->product_code, device->product_given, CM1E_RULE_IDENTITY_OBJECT},
                 {3, "revision", device->revision, device->revision_given, CM1E_RULE_IDENTITY_REVISION}};
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        uint32_t value;
        cm1e_place_t place;
        if (parts[i].given && stated(check, OBJECT_IDENTITY, parts[i].subindex, &value, &place) &&
            value != parts[i].value)
            cm1e_check_add(check, parts[i].rule, place,
                           "0x1018:%02X gives the %s 0x%08X; the device is described with 0x%08X", parts[i].subindex,
                           parts[i].what, (unsigned)value, (unsigned)parts[i].value);
    }
}

/* One channel: 0x1000 is its profile with the additional information above it. Several channels have each their own in
 * 0xF010; then 0x1000 has one of their profiles, or that of modular devices (ETG.5001), with any value above it. With
 * slots that profile is also right for one channel. */
static void check_device_type(const cm1e_check_t *check)
{
    const cm1e_description_t *device = check->device;
    uint32_t value;
    cm1e_place_t place;
    if (device->channels.count == 0 || !stated(check, OBJECT_DEVICE_TYPE, 0, &value, &place))
        return;
    const cm1e_channel_t *first = &device->channels.at[0];
    const uint32_t expected = ((uint32_t)first->profile_no & 0xFFFF) | (uint32_t)first->add_info << 16;
    if (check->is_modular && (value & 0xFFFF) == PROFILE_MODULAR && first->profile_no != PROFILE_MODULAR)
        return;
    if (device->channels.count == 1) {
        const bool right = first->add_info >= 0 ? value == expected : (value & 0xFFFF) == (expected & 0xFFFF);
        if (!right)
            cm1e_check_add(check, CM1E_RULE_DEVICE_TYPE, place,
                           "0x1000 is 0x%08X; profile %d with the additional information %d is 0x%08X",
                           (unsigned)value, (int)first->profile_no, (int)(first->add_info < 0 ? 0 : first->add_info),
                           (unsigned)(first->add_info < 0 ? expected & 0xFFFF : expected));
        return;
    }
    bool known = (value & 0xFFFF) == PROFILE_MODULAR;
    for (size_t i = 0; i < device->channels.count; i++)
        known = known || (value & 0xFFFF) == ((uint32_t)device->channels.at[i].profile_no & 0xFFFF);
    if (!known)
        cm1e_check_add(check, CM1E_RULE_DEVICE_TYPE, place, "0x1000 is 0x%08X, profile %u, which no channel has",
                       (unsigned)value, (unsigned)(value & 0xFFFF));
}

static void check_sync_manager_types(const cm1e_check_t *check)
{
    const cm1e_description_t *device = check->device;
    for (size_t n = 0; n < device->sync_managers.count && n < 32; n++) {
        uint32_t value;
        cm1e_place_t place;
        if (stated(check, OBJECT_SM_TYPES, (uint8_t)(n + 1), &value, &place) &&
            device->sync_managers.at[n].use != CM1E_SM_UNUSED && value != (uint32_t)device->sync_managers.at[n].use)
            cm1e_check_add(check, CM1E_RULE_SYNC_MANAGER_TYPES, place,
                           "0x1C00:%02X gives sync manager %zu the type %u; it is described as type %u",
                           (unsigned)n + 1, n, (unsigned)value, (unsigned)device->sync_managers.at[n].use);
    }
}

void cm1e_check_identity(const cm1e_check_t *check)
{
    check_identity_object(check);
    check_device_type(check);
    check_sync_manager_types(check);
}

/* ---- beside the other devices of the file ----------------------------------------------------------------------- */

static int by_identity(const void *left, const void *right)
{
    const cm1e_description_t *a = *(const cm1e_description_t *const *)left;
    const cm1e_description_t *b = *(const cm1e_description_t *const *)right;
    if (a->vendor_id != b->vendor_id)
        return a->vendor_id < b->vendor_id ? -1 : 1;
    if (a->product_code != b->product_code)
        return a->product_code < b->product_code ? -1 : 1;
    if (a->revision != b->revision)
        return a->revision < b->revision ? -1 : 1;
    return (a > b) - (a < b); /* in the order of the file */
}

/* Masters find a description by vendor, product and revision (ETG.2000). */
void cm1e_check_devices(const cm1e_check_t *check, const cm1e_description_file_t *file)
{
    const cm1e_description_t **devices = NULL;
    size_t count = 0;
    if (file->devices.count > 1 && file->devices.count <= CM1E_ARENA_LIMIT / sizeof *devices)
        devices = cm1e_arena_take(check->arena, file->devices.count * sizeof *devices);
    if (!devices || check->arena->failed)
        return;
    for (size_t i = 0; i < file->devices.count; i++)
        if (file->devices.at[i].product_given && file->devices.at[i].revision_given)
            devices[count++] = &file->devices.at[i];
    qsort(devices, count, sizeof *devices, by_identity);
    for (size_t i = 1; i < count; i++) {
        const cm1e_description_t *device = devices[i], *before = devices[i - 1];
        if (device->vendor_id == before->vendor_id && device->product_code == before->product_code &&
            device->revision == before->revision)
            cm1e_check_add(check, CM1E_RULE_DEVICE_TWICE, device->identity_place,
                           "there is a device of product code 0x%08X and revision 0x%08X before this one: which of "
                           "them a master takes is not defined",
                           (unsigned)device->product_code, (unsigned)device->revision);
    }
}
