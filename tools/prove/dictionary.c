/* The dictionary beside our tables: objects, sizes, types, access, defaults, ranges, constants. */
#include <stdio.h>
#include <string.h>

#include "core/text.h"
#include "prove/prove.h"

enum { ABORT_NO_OBJECT = 0x06020000, ABORT_NO_SUBINDEX = 0x06090011 };

static const char *name_of(const seen_entry_t *entry, char text[16])
{
    snprintf(text, 16, "0x%04X:%02X", entry->index, entry->subindex);
    return text;
}

/** What depends on the firmware, on the motor, or on the moment: its default in the tables is one of several. */
static bool varies(const seen_entry_t *entry)
{
    static const uint16_t indexes[] = {0x1001, 0x1009, 0x100A, 0x1C12, 0x1C13, 0x1C32, 0x1C33, 0x2301, 0x603F, 0x6041,
                                       0x6061, 0x6064, 0x606C, 0x6075, 0x6076, 0x6077, 0x6079, 0x60FD, 0xFE00};
    const uint16_t area = entry->index & 0xFE00;
    if (area == 0x1600 || area == 0x1A00 || (entry->index == 0x1018 && entry->subindex >= 3))
        return true;
    for (size_t i = 0; i < sizeof indexes / sizeof indexes[0]; i++)
        if (indexes[i] == entry->index)
            return true;
    return false;
}

/** An entry that the device tells of may refuse to be read with any abort code ("N/A" and "-" of BR appendix 6). */
bool prove_is_missing(const prove_t *prove, const seen_entry_t *entry)
{
    return prove->has_information ? !entry->told
                                  : entry->abort_code == ABORT_NO_OBJECT || entry->abort_code == ABORT_NO_SUBINDEX;
}

static void look_at_object(prove_t *prove, const seen_entry_t *entry, const char *name)
{
    if (entry->ours)
        prove_compare_truth(prove, name, !prove_is_missing(prove, entry), "there", "missing");
    else
        prove_compare(prove, name, "not in our tables", entry->info.name[0] ? entry->info.name : "there");
}

static void look_at_reading(prove_t *prove, const seen_entry_t *entry, const char *name)
{
    char found[48] = "read";
    if (!entry->ours || prove_is_missing(prove, entry) || entry->error == CM1E_ERROR_UNSUPPORTED)
        return;
    const bool readable = entry->ours->availability == CM1E_AVAILABLE && entry->ours->access & CM1E_ACCESS_READ;
    if (entry->error == CM1E_ERROR_SDO_ABORT)
        snprintf(found, sizeof found, "abort 0x%08X", (unsigned)entry->abort_code);
    else if (entry->error != CM1E_OK)
        snprintf(found, sizeof found, "%.47s", cm1e_strerror(entry->error));
    if (readable)
        prove_compare(prove, name, "read", found);
    else
        prove_compare_truth(prove, name, entry->error != CM1E_OK, "not readable", found);
}

static void look_at_size(prove_t *prove, const seen_entry_t *entry, const char *name)
{
    if (entry->ours && entry->error == CM1E_OK && entry->ours->type != CM1E_TYPE_STRING)
        prove_compare_number(prove, name, (entry->ours->bits + 7) / 8, (int64_t)entry->size, 0);
}

static void look_at_type(prove_t *prove, const seen_entry_t *entry, const char *name)
{
    if (!entry->ours || !entry->told)
        return;
    prove_compare_number(prove, name, entry->ours->type, entry->info.data_type, 4);
    if (entry->ours->type != CM1E_TYPE_STRING && entry->ours->bits != entry->info.bits)
        prove_compare_number(prove, name, entry->ours->bits, entry->info.bits, 0);
}

/** "read, write, RxPDO" */
static const char *access_text(char text[64], bool read, bool write, bool write_preop, bool rxpdo, bool txpdo)
{
    snprintf(text, 64, "%s%s%s%s", read ? "read " : "", write ? "write " : write_preop ? "write in PRE-OP " : "",
             rxpdo ? "RxPDO " : "", txpdo ? "TxPDO " : "");
    return text;
}

static void look_at_access(prove_t *prove, const seen_entry_t *entry, const char *name)
{
    char expected[64], found[64];
    if (!entry->ours || !entry->told)
        return;
    const unsigned ours = entry->ours->access, theirs = entry->info.access;
    const bool preop_only = ours & CM1E_ACCESS_WRITE_PREOP_ONLY, write = ours & CM1E_ACCESS_WRITE;
    access_text(expected, ours & CM1E_ACCESS_READ, write && !preop_only, write && preop_only, ours & CM1E_ACCESS_RXPDO,
                ours & CM1E_ACCESS_TXPDO);
    access_text(found, theirs & CM1E_INFO_READ_PREOP, theirs & CM1E_INFO_WRITE_OP, theirs & CM1E_INFO_WRITE_PREOP,
                theirs & CM1E_INFO_RXPDO, theirs & CM1E_INFO_TXPDO);
    prove_compare(prove, name, expected, found);
}

static void compare_told(prove_t *prove, const seen_entry_t *entry, const char *thing, int64_t ours,
                         const cm1e_info_value_t *told)
{
    if (told->size > 0 && told->size == (entry->ours->bits + 7) / 8)
        prove_compare_number(prove, thing, ours, prove_number_of(told->bytes, told->size,
                                                                 prove_is_signed(entry->ours->type)), 0);
}

static void look_at_default(prove_t *prove, const seen_entry_t *entry, const char *name)
{
    if (entry->ours && entry->told && !varies(entry) && entry->ours->type != CM1E_TYPE_STRING)
        compare_told(prove, entry, name, entry->ours->default_value, &entry->info.default_value);
}

static void look_at_range(prove_t *prove, const seen_entry_t *entry, const char *name)
{
    char thing[32];
    if (!entry->ours || !entry->told || entry->ours->type == CM1E_TYPE_STRING)
        return;
    snprintf(thing, sizeof thing, "%s minimum", name);
    compare_told(prove, entry, thing, entry->ours->minimum, &entry->info.minimum);
    snprintf(thing, sizeof thing, "%s maximum", name);
    compare_told(prove, entry, thing, entry->ours->maximum, &entry->info.maximum);
}

static void look_at_constant(prove_t *prove, const seen_entry_t *entry, const char *name)
{
    if (!entry->ours || entry->error != CM1E_OK || varies(entry) || entry->ours->access & CM1E_ACCESS_WRITE)
        return;
    if (entry->ours->type == CM1E_TYPE_STRING) {
        char found[sizeof entry->value + 1];
        cm1e_text_of_device(found, sizeof found, entry->value, entry->size);
        prove_compare(prove, name, entry->ours->default_string, found);
    } else if (entry->size <= 8) {
        prove_compare_number(prove, name, entry->ours->default_value,
                             prove_number_of(entry->value, entry->size, prove_is_signed(entry->ours->type)), 0);
    }
}

void look_dictionary(prove_t *prove, const point_t *point)
{
    static const struct {
        void (*look)(prove_t *prove, const seen_entry_t *entry, const char *name);
        bool needs_information;
    } looks[] = {
        [DICT_OBJECTS] = {look_at_object, false}, [DICT_READABLE] = {look_at_reading, false},
        [DICT_SIZES] = {look_at_size, false},     [DICT_TYPES] = {look_at_type, true},
        [DICT_ACCESS] = {look_at_access, true},   [DICT_DEFAULTS] = {look_at_default, true},
        [DICT_RANGES] = {look_at_range, true},    [DICT_VALUES] = {look_at_constant, false},
    };
    char name[16];
    if (!prove->has_information && (looks[point->row].needs_information || point->row == DICT_OBJECTS))
        prove_note(prove, "the device has no SDO information%s",
                   point->row == DICT_OBJECTS ? ": objects that our tables lack are not found" : "");
    for (size_t i = 0; i < prove->entry_count; i++)
        looks[point->row].look(prove, &prove->entries[i], name_of(&prove->entries[i], name));
}
