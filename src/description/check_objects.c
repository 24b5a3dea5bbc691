#include <stdio.h>
#include <string.h>

#include "description/check_private.h"

/* Checks the objects of a dictionary: the data of a sub-index must fit its type and each other. */

enum { SUBINDEXES = 256 };

static cm1e_place_t place_of(const cm1e_described_object_t *object, const cm1e_described_entry_t *entry)
{
    return entry->place ? entry->place : object->place;
}

/* ---- data -------------------------------------------------------------------------------------------------------- */

typedef enum value_kind { KIND_UNKNOWN = 0, KIND_UNSIGNED, KIND_SIGNED, KIND_REAL, KIND_TEXT } value_kind_t;

/* By the codes of ETG.1020. */
static value_kind_t kind_of(const cm1e_described_entry_t *entry)
{
    switch (cm1e_type_code(entry->type ? entry->type : "")) {
    case 0x02: case 0x03: case 0x04: case 0x10: case 0x12: case 0x13: case 0x14: case 0x15: return KIND_SIGNED;
    case 0x08: case 0x11: return KIND_REAL;
    case 0x09: case 0x0A: case 0x0B: return KIND_TEXT;
    case 0x00: case 0x0C: case 0x0D: case 0x1D: return KIND_UNKNOWN;
    default: return KIND_UNSIGNED;
    }
}

/* A text may be shorter than its size; of an unknown type only the length can be checked. */
static void check_data_size(const cm1e_check_t *check, const cm1e_described_object_t *object,
                            const cm1e_described_entry_t *entry, const char *what, cm1e_bytes_t data)
{
    const size_t bytes = ((size_t)entry->bits + 7) / 8;
    const value_kind_t kind = kind_of(entry);
    const bool exact = kind == KIND_SIGNED || kind == KIND_UNSIGNED || kind == KIND_REAL;
    if (data.size == 0 || entry->bits == 0 || data.size == bytes || (!exact && data.size < bytes))
        return;
    cm1e_check_add(check, CM1E_RULE_DATA_SIZE, place_of(object, entry),
                   "the %s of 0x%04X:%02X has %zu byte%s; the sub-index has %u bits, %zu byte%s", what, object->index,
                   entry->subindex, data.size, data.size == 1 ? "" : "s", (unsigned)entry->bits, bytes,
                   bytes == 1 ? "" : "s");
}

static double real_of(cm1e_bytes_t data)
{
    if (data.size == sizeof(float)) {
        const uint32_t bits = (uint32_t)cm1e_bytes_unsigned(data);
        float value;
        memcpy(&value, &bits, sizeof value);
        return value;
    }
    const uint64_t bits = cm1e_bytes_unsigned(data);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Whether a < b; false if they cannot be compared. */
static bool is_less(value_kind_t kind, cm1e_bytes_t a, cm1e_bytes_t b)
{
    if (a.size == 0 || a.size != b.size || a.size > sizeof(uint64_t))
        return false;
    switch (kind) {
    case KIND_SIGNED: return cm1e_bytes_signed(a) < cm1e_bytes_signed(b);
    case KIND_UNSIGNED: return cm1e_bytes_unsigned(a) < cm1e_bytes_unsigned(b);
    case KIND_REAL: return (a.size == sizeof(float) || a.size == sizeof(double)) && real_of(a) < real_of(b);
    default: return false;
    }
}

const char *cm1e_check_value_text(char *text, size_t room, const cm1e_described_entry_t *entry, cm1e_bytes_t data)
{
    const value_kind_t kind = kind_of(entry);
    if (kind == KIND_REAL)
        snprintf(text, room, "%g", real_of(data));
    else if (kind == KIND_SIGNED)
        snprintf(text, room, "%lld", (long long)cm1e_bytes_signed(data));
    else
        snprintf(text, room, "%llu", (unsigned long long)cm1e_bytes_unsigned(data));
    return text;
}

bool cm1e_check_within_range(const cm1e_described_entry_t *entry, cm1e_bytes_t data)
{
    const value_kind_t kind = kind_of(entry);
    return !is_less(kind, data, entry->minimum) && !is_less(kind, entry->maximum, data);
}

static void check_range(const cm1e_check_t *check, const cm1e_described_object_t *object,
                        const cm1e_described_entry_t *entry)
{
    char least[32], most[32], value[32];
    if (entry->minimum.size == 0 && entry->maximum.size == 0)
        return;
    cm1e_check_value_text(least, sizeof least, entry, entry->minimum);
    cm1e_check_value_text(most, sizeof most, entry, entry->maximum);
    if (is_less(kind_of(entry), entry->maximum, entry->minimum))
        cm1e_check_add(check, CM1E_RULE_RANGE_EMPTY, place_of(object, entry),
                       "0x%04X:%02X: the minimum %s is above the maximum %s", object->index, entry->subindex, least,
                       most);
    else if (!cm1e_check_within_range(entry, entry->default_data))
        cm1e_check_add(check, CM1E_RULE_DEFAULT_OUT_OF_RANGE, place_of(object, entry),
                       "the default value %s of 0x%04X:%02X is outside its range, %s to %s",
                       cm1e_check_value_text(value, sizeof value, entry, entry->default_data), object->index,
                       entry->subindex, entry->minimum.size ? least : "any", entry->maximum.size ? most : "any");
}

#define TWICE "the object 0x%04X (%s) is in the dictionary twice"

/* ---- objects ----------------------------------------------------------------------------------------------------- */

static void check_entries(const cm1e_check_t *check, const cm1e_described_object_t *object, bool types_stated)
{
    bool seen[SUBINDEXES] = {false};
    for (size_t i = 0; i < object->entries.count; i++) {
        const cm1e_described_entry_t *entry = &object->entries.at[i];
        if (seen[entry->subindex] && !types_stated) /* else the type has it twice */
            cm1e_check_add(check, CM1E_RULE_SUBINDEX_TWICE, place_of(object, entry),
                           "0x%04X has sub-index %u twice", object->index, entry->subindex);
        seen[entry->subindex] = true;
        const uint32_t bits = entry->type ? cm1e_type_bits(entry->type) : 0;
        if (!types_stated && bits > 0 && entry->bits != bits)
            cm1e_check_add(check, CM1E_RULE_OBJECT_SIZE, place_of(object, entry),
                           "0x%04X:%02X has %u bits; its type %s has %u", object->index, entry->subindex,
                           (unsigned)entry->bits, entry->type, (unsigned)bits);
        check_data_size(check, object, entry, "default value", entry->default_data);
        check_data_size(check, object, entry, "minimum", entry->minimum);
        check_data_size(check, object, entry, "maximum", entry->maximum);
        check_range(check, object, entry);
    }
}

void cm1e_check_objects(const cm1e_check_t *check, const cm1e_object_list_t *objects, const cm1e_check_types_t *known)
{
    cm1e_check_seen_t seen = {0};
    for (size_t i = 0; i < objects->count; i++) {
        const cm1e_described_object_t *object = &objects->at[i];
        if (cm1e_check_seen(&seen, object->index))
            cm1e_check_add(check, CM1E_RULE_OBJECT_TWICE, object->place, TWICE, object->index,
                           object->name ? object->name : "");
        const bool named = object->type && object->type[0] != '\0';
        if (named)
            cm1e_check_object_type(check, object, known);
        check_entries(check, object, named);
    }
}

/* ---- of a device with its slots filled --------------------------------------------------------------------------- */

/* Objects that the increments of the slots moved onto others. Those that a module has in the same place in every slot
 * may take the place of the device's, or be its own affair. */
void cm1e_check_dictionary(const cm1e_check_t *check)
{
    const cm1e_description_t *device = check->device;
    for (size_t i = 1; check->by_default && i < device->objects.count; i++) {
        const cm1e_described_object_t *before = &device->objects.at[check->objects[i - 1].order];
        const cm1e_described_object_t *object = &device->objects.at[check->objects[i].order];
        if (object->index == before->index && (object->depends_on_slot || before->depends_on_slot))
            cm1e_check_add(check, CM1E_RULE_OBJECT_TWICE, object->place, TWICE, object->index,
                           object->name ? object->name : "");
    }
}
