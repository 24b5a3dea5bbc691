/* The device profile: what the device is, in the words of our tables, for the simulator (`cm1e sim --profile`). */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "core/text.h"
#include "core/json_text.h"
#include "prove/prove.h"

static json_t *hex_of(const uint8_t *bytes, size_t size)
{
    static char text[2 * SEEN_SII + 1];
    for (size_t i = 0; i < size; i++)
        snprintf(text + 2 * i, 3, "%02X", bytes[i]);
    text[2 * size] = '\0';
    return json_string(text);
}

/** Values that come from the motor and its surroundings belong to the moment, not to the device. */
static bool is_of_the_moment(const prove_t *prove, const seen_entry_t *entry)
{
    static const uint16_t indexes[] = {0x1001, 0x1C12, 0x1C13, 0x1C32, 0x1C33, 0x603F, 0x6040, 0x6060, 0xFE00};
    const unsigned mapped = entry->told ? entry->info.access & (CM1E_INFO_RXPDO | CM1E_INFO_TXPDO)
                            : entry->ours ? entry->ours->access & (CM1E_ACCESS_RXPDO | CM1E_ACCESS_TXPDO) : 0;
    const bool setting = entry->ours && entry->ours->use != CM1E_USE_COMMAND;
    if (mapped && !setting && entry->index != 0x6072 && entry->index != 0x6076)
        return true;
    if (prove->device->channels > 0 && entry->index >= 0x2000)
        return true;
    for (size_t i = 0; i < sizeof indexes / sizeof indexes[0]; i++)
        if (indexes[i] == entry->index)
            return true;
    return false;
}

/** So many bytes are a number of this size; what has others is a difference of the report, and no number for the simulator. */
static bool fits(size_t size, unsigned bits) { return size > 0 && size <= 8 && size <= (bits + 7) / 8; }

static void set_told(json_t *object, const char *key, const cm1e_info_value_t *value, unsigned bits, bool is_signed)
{
    if (fits(value->size, bits))
        json_object_set_new(object, key, json_integer(prove_number_of(value->bytes, value->size, is_signed)));
}

static json_t *entry_as_json(const prove_t *prove, const seen_entry_t *entry)
{
    char name[16], text[sizeof entry->value + 1];
    const unsigned type = entry->told ? entry->info.data_type : entry->ours ? (unsigned)entry->ours->type : 0;
    const unsigned bits = entry->told ? entry->info.bits : entry->ours ? entry->ours->bits : 64u;
    snprintf(name, sizeof name, "0x%04X:%02X", entry->index, entry->subindex);
    json_t *object = json_pack("{s:s}", "entry", name);
    if (entry->told) {
        json_object_set_new(object, "name", cm1e_json_text(entry->info.name));
        json_object_set_new(object, "type", json_integer(entry->info.data_type));
        json_object_set_new(object, "bits", json_integer(entry->info.bits));
        json_object_set_new(object, "access", json_integer(entry->info.access));
        set_told(object, "default", &entry->info.default_value, bits, prove_is_signed(type));
        set_told(object, "minimum", &entry->info.minimum, bits, prove_is_signed(type));
        set_told(object, "maximum", &entry->info.maximum, bits, prove_is_signed(type));
    }
    if (entry->error != CM1E_OK || is_of_the_moment(prove, entry))
        return object;
    cm1e_text_of_device(text, sizeof text, entry->value, entry->size);
    if (type == CM1E_TYPE_STRING)
        json_object_set_new(object, "text", cm1e_json_text(text));
    else if (fits(entry->size, bits))
        json_object_set_new(object, "value", json_integer(prove_number_of(entry->value, entry->size,
                                                                          prove_is_signed(type))));
    return object;
}

json_t *prove_profile(const prove_t *prove)
{
    json_t *entries = json_array(), *missing = json_array();
    for (size_t i = 0; i < prove->entry_count; i++) {
        const seen_entry_t *entry = &prove->entries[i];
        if (prove_is_missing(prove, entry))
            json_array_append_new(missing, json_sprintf("0x%04X:%02X", entry->index, entry->subindex));
        else
            json_array_append_new(entries, entry_as_json(prove, entry));
    }
    return json_pack("{s:i, s:s, s:o, s:o, s:o, s:o, s:O}", "cm1e_profile", 1, "device",
                     prove->device->name ? prove->device->name : prove->device->kind, "firmware",
                     cm1e_json_text(prove->slave->software_version), "sii", hex_of(prove->sii, prove->sii_size),
                     "entries", entries, "missing", missing, "codes", prove->profile_codes);
}
