#include "prove/profile_file.h"

#include <ctype.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"

enum { ENTRIES_MAX = 4096, CODES_MAX = 64, SII_MAX = 65536 };

/** A file while it is read, and what it becomes. */
struct profile_file {
    const char *path; /**< while it is read */
    cm1e_sim_profile_t profile;
    cm1e_sim_profile_entry_t entries[ENTRIES_MAX];
    cm1e_sim_profile_code_t codes[CODES_MAX];
    uint8_t sii[SII_MAX];
};
typedef profile_file_t reader_t;

static bool wrong(const reader_t *reader, const char *where, const char *expected)
{
    complain("%s: %s: expected %s", reader->path, where, expected);
    return false;
}

/** Up to `most` hexadecimal digits, and nothing else; `*rest` is what is behind them. false: there are none. */
static bool parse_digits(const char *text, size_t most, uint32_t *value, const char **rest)
{
    const size_t digits = strspn(text, "0123456789abcdefABCDEF");
    *value = (uint32_t)strtoul(text, NULL, 16);
    *rest = text + digits;
    return digits > 0 && digits <= most;
}

/** "0x6084:00", "0x6084" */
static bool parse_name(const char *name, uint16_t *index, uint8_t *subindex)
{
    uint32_t first, second = 0;
    const char *rest;
    if (!name || strncmp(name, "0x", 2) != 0 || !parse_digits(name + 2, 4, &first, &rest))
        return false;
    if (*rest == ':' && !parse_digits(rest + 1, 2, &second, &rest))
        return false;
    *index = (uint16_t)first;
    *subindex = (uint8_t)second;
    return *rest == '\0';
}

/** A code as "0x0011" (of 4 digits) or "0x06090031" (of 8), or fewer. */
static bool parse_code(const char *text, size_t most, uint32_t *code)
{
    const char *rest;
    return strncmp(text, "0x", 2) == 0 && parse_digits(text + 2, most, code, &rest) && *rest == '\0';
}

static cm1e_sim_profile_entry_t *add_entry(reader_t *reader, const char *name)
{
    cm1e_sim_profile_entry_t entry = {0};
    if (reader->profile.entry_count == ENTRIES_MAX || !parse_name(name, &entry.index, &entry.subindex)) {
        wrong(reader, name ? name : "an entry without \"entry\"", "an object as \"0x6084:00\"");
        return NULL;
    }
    reader->entries[reader->profile.entry_count] = entry;
    return &reader->entries[reader->profile.entry_count++];
}

/** An optional whole number. */
static bool take_number(const reader_t *reader, const json_t *object, const char *key, bool *given, int64_t *value)
{
    const json_t *number = json_object_get(object, key);
    *given = number != NULL;
    if (number && !json_is_integer(number))
        return wrong(reader, key, "a whole number");
    *value = json_integer_value(number);
    return true;
}

static bool take_text(const reader_t *reader, const json_t *object, const char *key, char text[64])
{
    const json_t *value = json_object_get(object, key);
    if (value && (!json_is_string(value) || json_string_length(value) >= 64))
        return wrong(reader, key, "a text of up to 63 bytes");
    snprintf(text, 64, "%s", value ? json_string_value(value) : "");
    return true;
}

/** Type, bits and access: all of them, or none. */
static bool take_description(const reader_t *reader, const json_t *object, cm1e_sim_profile_entry_t *entry)
{
    bool type, bits, access;
    int64_t numbers[3];
    const char *name = json_string_value(json_object_get(object, "entry"));
    if (!take_number(reader, object, "type", &type, &numbers[0])
        || !take_number(reader, object, "bits", &bits, &numbers[1])
        || !take_number(reader, object, "access", &access, &numbers[2]))
        return false;
    if (type != bits || type != access)
        return wrong(reader, name, "type, bits and access together");
    for (int i = 0; i < 3; i++)
        if (numbers[i] < 0 || numbers[i] > UINT16_MAX)
            return wrong(reader, name, "type, bits and access up to 65535");
    entry->described = type;
    entry->data_type = (uint16_t)numbers[0];
    entry->bits = (uint16_t)numbers[1];
    entry->access = (uint16_t)numbers[2];
    return true;
}

/** Every key of an object is one of a list, which ends with NULL. */
static bool has_only(const reader_t *reader, json_t *object, const char *const *keys, const char *expected)
{
    const char *key;
    json_t *value;
    json_object_foreach(object, key, value) {
        size_t i = 0;
        while (keys[i] && strcmp(keys[i], key) != 0)
            i++;
        if (!keys[i])
            return wrong(reader, key, expected);
    }
    return true;
}

static bool take_entry(reader_t *reader, json_t *object)
{
    static const char *const keys[] = {"entry",   "type",  "bits", "access", "default", "minimum",
                                       "maximum", "value", "name", "text",   NULL};
    if (!has_only(reader, object, keys, "entry, type, bits, access, default, minimum, maximum, value, name or text"))
        return false;
    cm1e_sim_profile_entry_t *entry = add_entry(reader, json_string_value(json_object_get(object, "entry")));
    return entry && take_description(reader, object, entry)
           && take_number(reader, object, "default", &entry->has_default, &entry->default_value)
           && take_number(reader, object, "minimum", &entry->has_minimum, &entry->minimum)
           && take_number(reader, object, "maximum", &entry->has_maximum, &entry->maximum)
           && take_number(reader, object, "value", &entry->has_value, &entry->value)
           && take_text(reader, object, "name", entry->name) && take_text(reader, object, "text", entry->text);
}

static bool take_entries(reader_t *reader, const json_t *entries)
{
    bool good = !entries || json_is_array(entries) || wrong(reader, "entries", "a list");
    for (size_t i = 0; i < json_array_size(entries) && good; i++)
        good = take_entry(reader, json_array_get(entries, i));
    return good;
}

static bool take_missing(reader_t *reader, const json_t *missing)
{
    bool good = !missing || json_is_array(missing) || wrong(reader, "missing", "a list");
    for (size_t i = 0; i < json_array_size(missing) && good; i++) {
        cm1e_sim_profile_entry_t *entry = add_entry(reader, json_string_value(json_array_get(missing, i)));
        good = entry != NULL;
        if (good)
            entry->missing = true;
    }
    return good;
}

static bool take_code(reader_t *reader, cm1e_sim_code_kind_t kind, const char *ours, const json_t *theirs)
{
    const char *text = json_string_value(theirs);
    cm1e_sim_profile_code_t code = {.kind = kind};
    const size_t most = kind == CM1E_SIM_CODE_ABORT ? 8 : 4;
    if (!text || !parse_code(ours, most, &code.ours) || !parse_code(text, most, &code.theirs))
        return wrong(reader, ours, most == 8 ? "two codes as \"0x06090031\"" : "two codes as \"0x0011\"");
    if (reader->profile.code_count == CODES_MAX)
        return wrong(reader, ours, "fewer codes");
    reader->codes[reader->profile.code_count++] = code;
    return true;
}

static bool take_codes(reader_t *reader, json_t *codes)
{
    static const char *const kinds[] = {"aborts", "al_status", "errors"};
    const char *name, *ours;
    json_t *group, *theirs;
    if (codes && !json_is_object(codes))
        return wrong(reader, "codes", "aborts, al_status or errors");
    json_object_foreach(codes, name, group) {
        size_t kind = 0;
        while (kind < sizeof kinds / sizeof kinds[0] && strcmp(kinds[kind], name) != 0)
            kind++;
        if (kind == sizeof kinds / sizeof kinds[0])
            return wrong(reader, name, "aborts, al_status or errors");
        if (!json_is_object(group))
            return wrong(reader, name, "pairs of codes");
        json_object_foreach(group, ours, theirs)
            if (!take_code(reader, (cm1e_sim_code_kind_t)kind, ours, theirs))
                return false;
    }
    return true;
}

static int digit_of(char c)
{
    static const char digits[] = "0123456789ABCDEF";
    const char *at = c ? strchr(digits, toupper((unsigned char)c)) : NULL;
    return at ? (int)(at - digits) : -1;
}

static bool take_sii(reader_t *reader, const json_t *value)
{
    const char *text = json_string_value(value);
    const size_t length = text ? strlen(text) : 0;
    if (!value || (text && length == 0))
        return true;
    if (!text || length % 2 != 0 || length / 2 > SII_MAX)
        return wrong(reader, "sii", "an image as hexadecimal bytes");
    for (size_t i = 0; i < length / 2; i++) {
        const int high = digit_of(text[2 * i]), low = digit_of(text[2 * i + 1]);
        if (high < 0 || low < 0)
            return wrong(reader, "sii", "an image as hexadecimal bytes");
        reader->sii[i] = (uint8_t)(high << 4 | low);
    }
    reader->profile.sii = reader->sii;
    reader->profile.sii_size = length / 2;
    return true;
}

static bool take_profile(reader_t *reader, json_t *root)
{
    static const char *const keys[] = {"cm1e_profile", "device", "firmware", "entries",
                                       "missing",      "codes",  "sii",      NULL};
    if (json_integer_value(json_object_get(root, "cm1e_profile")) != 1)
        return wrong(reader, "the file", "a device profile, with \"cm1e_profile\": 1");
    if (!has_only(reader, root, keys, "cm1e_profile, device, firmware, entries, missing, codes or sii"))
        return false;
    reader->profile.entries = reader->entries;
    reader->profile.codes = reader->codes;
    return take_entries(reader, json_object_get(root, "entries"))
           && take_missing(reader, json_object_get(root, "missing")) && take_codes(reader, json_object_get(root, "codes")) && take_sii(reader, json_object_get(root, "sii"));
}

profile_file_t *profile_file_read(const char *path, const void *bytes, size_t size)
{
    json_error_t error;
    json_t *root = json_loadb(bytes, size, JSON_REJECT_DUPLICATES, &error);
    reader_t *reader = root ? calloc(1, sizeof *reader) : NULL;
    if (!root)
        complain("%s:%d: %s", path, error.line, error.text);
    else if (!reader)
        complain("out of memory");
    if (reader)
        reader->path = path;
    const bool good = reader && take_profile(reader, root);
    json_decref(root);
    if (good)
        return reader;
    free(reader);
    return NULL;
}

const cm1e_sim_profile_t *profile_file_content(const profile_file_t *file) { return &file->profile; }

void profile_file_free(profile_file_t *file) { free(file); }
