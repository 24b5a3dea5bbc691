/* Reads everything that can be read of one slave, and compares numbers and texts. */
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "cm1e/sii.h"
#include "core/bytes.h"
#include "core/json_text.h"
#include "prove/prove.h"

/* ---- comparing --------------------------------------------------------------------------------------------------- */

void prove_compare(prove_t *prove, const char *thing, const char *expected, const char *found)
{
    prove->compared++;
    if (strcmp(expected, found) != 0)
        json_array_append_new(prove->differences, json_pack("{s:s, s:o, s:o}", "thing", thing, "expected",
                                                            cm1e_json_text(expected), "found", cm1e_json_text(found)));
}

static void write_number(char text[32], int64_t value, int digits)
{
    if (digits > 0)
        snprintf(text, 32, "0x%0*" PRIX64, digits, (uint64_t)value);
    else
        snprintf(text, 32, "%" PRId64, value);
}

void prove_compare_number(prove_t *prove, const char *thing, int64_t expected, int64_t found, int digits)
{
    char left[32], right[32];
    write_number(left, expected, digits);
    write_number(right, found, digits);
    prove_compare(prove, thing, left, right);
}

void prove_compare_truth(prove_t *prove, const char *thing, bool found, const char *expected, const char *otherwise)
{
    prove_compare(prove, thing, expected, found ? expected : otherwise);
}

void prove_compare_code(prove_t *prove, const char *kind, const char *thing, uint32_t expected, uint32_t found)
{
    char key[24];
    const int digits = expected > UINT16_MAX ? 8 : 4;
    prove_compare_number(prove, thing, expected, found, digits);
    const bool is_error = strcmp(kind, "errors") == 0;
    if (expected == found || (!is_error && (expected == 0 || found == 0)))
        return; /* accepted where it should be refused, or refused: no other code says that */
    snprintf(key, sizeof key, "0x%0*X", digits, (unsigned)expected);
    json_t *codes = json_object_get(prove->profile_codes, kind);
    if (!codes)
        json_object_set_new(prove->profile_codes, kind, codes = json_object());
    json_object_set_new(codes, key, json_sprintf("0x%0*X", digits, (unsigned)found));
}

void prove_note(prove_t *prove, const char *format, ...)
{
    va_list arguments;
    const size_t used = strlen(prove->note);
    const size_t gap = used > 0 && used + 3 < sizeof prove->note ? 2 : 0;
    if (used + 3 >= sizeof prove->note)
        return;
    memcpy(prove->note + used, "; ", gap);
    va_start(arguments, format);
    vsnprintf(prove->note + used + gap, sizeof prove->note - used - gap, format, arguments);
    va_end(arguments);
}

/* ---- numbers ----------------------------------------------------------------------------------------------------- */

bool prove_is_signed(unsigned data_type)
{
    return data_type == CM1E_TYPE_SINT || data_type == CM1E_TYPE_INT || data_type == CM1E_TYPE_DINT;
}

int64_t prove_number_of(const uint8_t *bytes, size_t size, bool is_signed)
{
    if (size == 0 || size > 8)
        return 0;
    const unsigned shift = 64 - 8 * (unsigned)size;
    const uint64_t bits = cm1e_get_uint(bytes, (unsigned)size);
    return is_signed ? (int64_t)(bits << shift) >> shift : (int64_t)bits;
}

const seen_entry_t *prove_entry(const prove_t *prove, uint16_t index, uint8_t subindex)
{
    for (size_t i = 0; i < prove->entry_count; i++)
        if (prove->entries[i].index == index && prove->entries[i].subindex == subindex)
            return &prove->entries[i];
    return NULL;
}

bool prove_value(const prove_t *prove, uint16_t index, uint8_t subindex, int64_t *value)
{
    const seen_entry_t *entry = prove_entry(prove, index, subindex);
    if (!entry || entry->error != CM1E_OK || entry->size == 0 || entry->size > 8)
        return false;
    const unsigned type = entry->told ? entry->info.data_type : entry->ours ? (unsigned)entry->ours->type : 0;
    *value = prove_number_of(entry->value, entry->size, prove_is_signed(type));
    return true;
}

/* ---- the dictionary ---------------------------------------------------------------------------------------------- */

static seen_entry_t *add(prove_t *prove, uint16_t index, uint8_t subindex)
{
    const seen_entry_t *known = prove_entry(prove, index, subindex);
    if (known)
        return &prove->entries[known - prove->entries];
    if (prove->entry_count == SEEN_ENTRIES)
        return NULL;
    seen_entry_t *entry = &prove->entries[prove->entry_count++];
    *entry = (seen_entry_t){.index = index, .subindex = subindex};
    return entry;
}

static bool is_of_firmware(const prove_t *prove, cm1e_firmware_t since)
{
    return !prove->firmware || since <= prove->firmware->firmware;
}

/** Our tables, as far as they are of this firmware. */
static void add_ours(prove_t *prove)
{
    const cm1e_object_t *object;
    for (size_t n = 0; (object = prove->device->object(prove->device, n)) != NULL; n++)
        for (unsigned i = 0; i < object->entry_count && is_of_firmware(prove, object->since); i++) {
            const cm1e_entry_t *ours = &object->entries[i];
            seen_entry_t *entry = is_of_firmware(prove, ours->since) ? add(prove, ours->index, ours->subindex) : NULL;
            if (entry)
                entry->ours = ours;
        }
}

/** What the device tells of itself; false: it has no such service. */
static bool add_told(prove_t *prove)
{
    prove->object_count = SEEN_OBJECTS;
    if (cm1e_sdo_info_list(prove->bus, prove->position, CM1E_OBJECTS_ALL, prove->objects, &prove->object_count, NULL)
        != CM1E_OK) {
        prove->object_count = 0;
        return false;
    }
    for (size_t i = 0; i < prove->object_count; i++) {
        cm1e_object_info_t *object = &prove->object_infos[i];
        if (cm1e_sdo_info_object(prove->bus, prove->position, prove->objects[i], object, NULL) != CM1E_OK)
            *object = (cm1e_object_info_t){.index = prove->objects[i]};
        for (unsigned subindex = 0; subindex <= object->highest_subindex; subindex++) {
            cm1e_entry_info_t info;
            if (cm1e_sdo_info_entry(prove->bus, prove->position, prove->objects[i], (uint8_t)subindex, &info, NULL)
                != CM1E_OK)
                continue;
            seen_entry_t *entry = add(prove, prove->objects[i], (uint8_t)subindex);
            if (entry) {
                entry->told = true;
                entry->info = info;
            }
        }
    }
    return true;
}

static void read_entry(const prove_t *prove, seen_entry_t *entry)
{
    cm1e_diag_t diag = {0};
    entry->size = sizeof entry->value;
    entry->error = cm1e_sdo_read(prove->bus, prove->position, entry->index, entry->subindex, entry->value, &entry->size,
                                 &diag);
    entry->abort_code = entry->error == CM1E_ERROR_SDO_ABORT ? (uint32_t)diag.foreign_code : 0;
}

static void read_sii(prove_t *prove)
{
    prove->sii_size = sizeof prove->sii;
    if (cm1e_sii_read_device(prove->bus, prove->position, prove->sii, &prove->sii_size, NULL) != CM1E_OK)
        prove->sii_size = 0;
}

/** CML answers are taken by reading, and belong to nobody here (BR 7.2). */
static bool is_dialogue(const prove_t *prove, uint16_t index)
{
    return prove->device->channels > 0 && index >= 0xF581 && index <= 0xF594;
}

void prove_read_all(prove_t *prove)
{
    read_sii(prove);
    prove->entry_count = 0;
    add_ours(prove);
    prove->has_information = add_told(prove);
    for (size_t i = 0; i < prove->entry_count; i++) {
        if (is_dialogue(prove, prove->entries[i].index))
            prove->entries[i].error = CM1E_ERROR_UNSUPPORTED;
        else
            read_entry(prove, &prove->entries[i]);
    }
}
