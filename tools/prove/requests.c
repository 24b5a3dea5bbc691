/* SDO requests that are refused, settings that are written and written back, error codes at rest. */
#include <stdio.h>
#include <string.h>

#include "core/bytes.h"
#include "prove/prove.h"

/* ---- refused requests -------------------------------------------------------------------------------------------- */

/** 0xFF01 overrides the LED and nothing else (UG 7.4.5): what a device takes in spite of its table is seen, and taken
 *  back. The constants are written with the values that they have. */
static const struct {
    uint16_t index;
    uint8_t subindex;
    uint8_t size;    /* 0: read */
    uint32_t value, code;
} requests[] = {
    {0x5FFF, 0x00, 0, 0, 0x06020000},
    {0x1018, 0x55, 0, 0, 0x06090011},
    {0x1018, 0x01, 4, 0, 0x06010002},
    {0xFF01, 0x00, 8, 0, 0x06070012},
    {0xFF01, 0x00, 1, 0, 0x06070013},
    {0xFF01, 0x00, 4, 0x02020204, 0x06090031},
};

void look_abort(prove_t *prove, const point_t *point)
{
    uint8_t data[8] = {0};
    size_t size = sizeof data;
    char thing[16];
    cm1e_diag_t diag = {0};
    const uint16_t index = requests[point->row].index;
    const uint8_t subindex = requests[point->row].subindex, bytes = requests[point->row].size;
    cm1e_put_u32(data, requests[point->row].value);
    const seen_entry_t *constant = index == 0x1018 ? prove_entry(prove, index, subindex) : NULL;
    if (constant && constant->error == CM1E_OK)
        memcpy(data, constant->value, bytes);
    const cm1e_error_t error =
        bytes > 0 ? cm1e_sdo_write(prove->bus, prove->position, index, subindex, data, bytes, &diag)
                  : cm1e_sdo_read(prove->bus, prove->position, index, subindex, data, &size, &diag);
    snprintf(thing, sizeof thing, "0x%04X:%02X", index, subindex);
    if (error == CM1E_OK && index == 0xFF01)
        cm1e_sdo_write(prove->bus, prove->position, index, subindex, (const uint8_t[4]){0}, 4, NULL);
    if (error == CM1E_OK || error == CM1E_ERROR_SDO_ABORT)
        prove_compare_code(prove, "aborts", thing, requests[point->row].code,
                           error == CM1E_OK ? 0 : (uint32_t)diag.foreign_code);
    else
        prove_note(prove, "%.300s", diag.text);
}

/* ---- settings ---------------------------------------------------------------------------------------------------- */

enum { ABORT_TOO_HIGH = 0x06090031, ABORT_TOO_LOW = 0x06090032 };

typedef struct setting {
    prove_t *prove;
    const cm1e_entry_t *entry;
    int64_t before;
    char name[16];
} setting_t;

/** The abort code; 0: it was taken; UINT32_MAX: another error. */
static uint32_t write_setting(const setting_t *setting, int64_t value)
{
    uint8_t data[8];
    cm1e_diag_t diag = {0};
    const unsigned size = setting->entry->bits / 8u;
    cm1e_put_uint(data, size, (uint64_t)value);
    const cm1e_error_t error = cm1e_sdo_write(setting->prove->bus, setting->prove->position, setting->entry->index,
                                              setting->entry->subindex, data, size, &diag);
    return error == CM1E_OK ? 0 : error == CM1E_ERROR_SDO_ABORT ? (uint32_t)diag.foreign_code : UINT32_MAX;
}

static bool read_setting(const setting_t *setting, int64_t *value)
{
    uint8_t data[8];
    size_t size = sizeof data;
    if (cm1e_sdo_read(setting->prove->bus, setting->prove->position, setting->entry->index, setting->entry->subindex,
                      data, &size, NULL) != CM1E_OK || size != setting->entry->bits / 8u)
        return false;
    *value = prove_number_of(data, size, prove_is_signed(setting->entry->type));
    return true;
}

/** After this answer to a write the setting may have the new value. */
static bool may_be_new(uint32_t code) { return code == 0 || code == UINT32_MAX; }

/** Writes back what was there before something else was, or may have been. A device that keeps what was tried must not go
 *  unseen. */
static void write_back(const setting_t *setting, bool changed)
{
    char thing[48], found[32] = "no answer";
    const uint32_t code = changed ? write_setting(setting, setting->before) : 0;
    if (code == 0)
        return;
    if (code != UINT32_MAX)
        snprintf(found, sizeof found, "abort 0x%08X", (unsigned)code);
    snprintf(thing, sizeof thing, "%s = %lld, as before", setting->name, (long long)setting->before);
    prove_compare(setting->prove, thing, "taken", found);
    complain("%s could not be written back (%s): it was %lld, and may have another value now", setting->name, found,
             (long long)setting->before);
}

static void look_at_same(const setting_t *setting)
{
    char found[32] = "taken";
    const uint32_t code = write_setting(setting, setting->before);
    if (code)
        snprintf(found, sizeof found, "abort 0x%08X", (unsigned)code);
    prove_compare(setting->prove, setting->name, "taken", found);
}

static bool fits(const cm1e_entry_t *entry, int64_t value)
{
    const bool is_signed = prove_is_signed(entry->type);
    const int64_t highest = (INT64_C(1) << (entry->bits - is_signed)) - 1, lowest = is_signed ? -highest - 1 : 0;
    return value >= lowest && value <= highest;
}

static void look_at_bound(const setting_t *setting, bool high)
{
    const cm1e_entry_t *entry = setting->entry;
    const int64_t bound = high ? entry->maximum : entry->minimum, beyond = high ? bound + 1 : bound - 1;
    char thing[40];
    if (!fits(entry, beyond))
        return;
    snprintf(thing, sizeof thing, "%s = %lld", setting->name, (long long)beyond);
    const uint32_t expected = high ? ABORT_TOO_HIGH : ABORT_TOO_LOW, found = write_setting(setting, beyond);
    if (expected >> 16 == found >> 16)
        prove_compare_code(setting->prove, "aborts", thing, expected, found);
    else /* another reason, of this object only */
        prove_compare_number(setting->prove, thing, expected, found, 8);
    snprintf(thing, sizeof thing, "%s = %lld", setting->name, (long long)bound);
    const uint32_t taken = write_setting(setting, bound);
    prove_compare_number(setting->prove, thing, 0, taken, 8);
    write_back(setting, may_be_new(taken) || may_be_new(found));
}

static void look_at_steps(const setting_t *setting)
{
    const cm1e_entry_t *entry = setting->entry;
    int64_t kept;
    if (entry->round_to <= 1)
        return;
    const int64_t value = entry->minimum + 4 * (int64_t)entry->round_to + entry->round_to / 2 + 1;
    const uint32_t taken = write_setting(setting, value);
    if (taken == 0 && read_setting(setting, &kept)) {
        char thing[40];
        snprintf(thing, sizeof thing, "%s = %lld", setting->name, (long long)value);
        prove_compare_number(setting->prove, thing, cm1e_entry_round(entry, value), kept, 0);
    } else {
        prove_note(setting->prove, "%s cannot be written", setting->name);
    }
    write_back(setting, may_be_new(taken));
}

/** Settings of which the guide does not say that they are kept without power. Of the K parameters of the motor itself
 *  (0x60F6) only K47 has a meaning and a range in the guide: the others are left alone. */
static bool may_be_written(const cm1e_entry_t *entry)
{
    return entry->use == CM1E_USE_SETTING && entry->bits <= 32
           && (entry->index != OBJ_60F6_K_PARAMETERS || entry->subindex == CM1E_K_PARAMETER_HOMING_TORQUE);
}

void look_write(prove_t *prove, const point_t *point)
{
    for (size_t i = 0; i < prove->entry_count && !prove_is_told_to_end(prove); i++) {
        const cm1e_entry_t *entry = prove->entries[i].ours;
        setting_t setting = {.prove = prove, .entry = entry};
        if (!entry || !may_be_written(entry) || prove->entries[i].error != CM1E_OK
            || !read_setting(&setting, &setting.before))
            continue;
        snprintf(setting.name, sizeof setting.name, "0x%04X:%02X", entry->index, entry->subindex);
        if (point->row == WRITE_KEPT)
            look_at_same(&setting);
        else if (point->row == WRITE_ROUNDED)
            look_at_steps(&setting);
        else
            look_at_bound(&setting, point->row == WRITE_TOO_HIGH);
    }
}

/* ---- error codes ------------------------------------------------------------------------------------------------- */

/** After a scan the motor is in no mode, if it has not been in one since its power-on. */
void look_error(prove_t *prove, const point_t *point)
{
    enum { NO_MODE = 0x4502 };
    int64_t mode, code, error_register;
    (void)point;
    if (!prove_value(prove, 0x6061, 0, &mode) || !prove_value(prove, 0x603F, 0, &code)
        || !prove_value(prove, 0x1001, 0, &error_register)) {
        prove_note(prove, "the objects cannot be read");
        return;
    }
    if (mode != 0) {
        prove_note(prove, "the motor is in mode %d since its power-on: switch it off and on, then look again",
                   (int)mode);
        return;
    }
    prove_compare_code(prove, "errors", "0x603F", NO_MODE, (uint32_t)code & UINT16_MAX);
    prove_compare_number(prove, "0x1001", 0, error_register, 2);
}
