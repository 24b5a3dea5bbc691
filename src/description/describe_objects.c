/* Objects and PDOs of the device tables as a description has them. */
#include "description/describe.h"

#include <inttypes.h>
#include <string.h>

enum { FIRST_PARAMETER = 0x2000 };

static const char *type_name(cm1e_arena_t *arena, const cm1e_entry_t *entry)
{
    return cm1e_type_name(arena, (uint16_t)entry->type, entry->bits);
}

/* A range is stated if the value can be written and the type would allow more. */
static bool range_matters(const cm1e_entry_t *entry)
{
    const bool is_signed =
        entry->type == CM1E_TYPE_SINT || entry->type == CM1E_TYPE_INT || entry->type == CM1E_TYPE_DINT;
    const int64_t least = is_signed ? -((int64_t)1 << (entry->bits - 1)) : 0;
    const int64_t most = ((int64_t)1 << (is_signed ? entry->bits - 1 : entry->bits)) - 1;
    return (entry->access & CM1E_ACCESS_WRITE) && (entry->minimum > least || entry->maximum < most);
}

void cm1e_describe_range(cm1e_arena_t *arena, cm1e_described_entry_t *described, int64_t minimum, int64_t maximum)
{
    const size_t bytes = (described->bits + 7u) / 8;
    described->minimum = cm1e_bytes_of(arena, minimum, bytes);
    described->maximum = cm1e_bytes_of(arena, maximum, bytes);
    described->comment = cm1e_arena_format(arena, "%" PRId64 " ... %" PRId64, minimum, maximum);
}

/* Comment for a user who writes the value: its range, and its rounding. */
static void describe_range(cm1e_arena_t *arena, cm1e_described_entry_t *described, const cm1e_entry_t *entry)
{
    cm1e_describe_range(arena, described, entry->minimum, entry->maximum);
    if (entry->index < FIRST_PARAMETER)
        described->comment = NULL; /* PDO assignment: set by masters */
    else if (entry->round_to > 1)
        described->comment = cm1e_arena_format(arena, "%s, rounded to %" PRIu32, described->comment, entry->round_to);
}

static const char *const availabilities[] = {
    [CM1E_AVAILABLE] = NULL,
    [CM1E_NOT_AVAILABLE] = "N/A: access is answered with an abort",
    [CM1E_NO_PARAMETER] = "The motor has no such parameter: access is answered with an abort",
};

static void describe_entry(cm1e_arena_t *arena, cm1e_described_entry_t *described, const cm1e_entry_t *entry)
{
    const size_t bytes = (entry->bits + 7u) / 8;
    described->subindex = entry->subindex;
    described->name = entry->name;
    described->type = type_name(arena, entry);
    described->bits = entry->bits;
    described->access = entry->access;
    described->unit = entry->unit;
    described->comment = availabilities[entry->availability];
    if (entry->default_string) {
        const size_t length = entry->default_string[0] == '\0' ? 0 : bytes; /* "": not known */
        described->default_data = (cm1e_bytes_t){cm1e_arena_bytes(arena, entry->default_string, length), length};
        return;
    }
    described->default_data = cm1e_bytes_of(arena, entry->default_value, bytes);
    if (range_matters(entry))
        describe_range(arena, described, entry);
}

void cm1e_describe_object(cm1e_arena_t *arena, cm1e_object_list_t *list, const cm1e_object_t *object,
                          cm1e_firmware_t firmware)
{
    if (object->since > firmware)
        return;
    cm1e_described_object_t *described = CM1E_APPEND(arena, list);
    described->index = object->index;
    described->code = object->object_code;
    described->name = object->name;
    described->type = "";
    for (unsigned i = 0; i < object->entry_count; i++)
        if (object->entries[i].since <= firmware)
            describe_entry(arena, CM1E_APPEND(arena, &described->entries), &object->entries[i]);
}

/* The type on the wire: that of the dictionary, unless the mapping has another length (0x6079: UG 7.2). */
static const char *mapped_type(cm1e_arena_t *arena, const cm1e_described_entry_t *entry, unsigned bits)
{
    if (entry && entry->bits == bits)
        return entry->type;
    const bool is_signed = entry && (strcmp(entry->type, "DINT") == 0 || strcmp(entry->type, "INT") == 0);
    if (bits == 1)
        return "BOOL";
    const cm1e_data_type_t type = bits == 8    ? is_signed ? CM1E_TYPE_SINT : CM1E_TYPE_USINT
                                  : bits == 16 ? is_signed ? CM1E_TYPE_INT : CM1E_TYPE_UINT
                                               : is_signed ? CM1E_TYPE_DINT : CM1E_TYPE_UDINT;
    return cm1e_type_name(arena, (uint16_t)type, bits);
}

cm1e_described_pdo_t *cm1e_describe_pdo(cm1e_arena_t *arena, cm1e_pdo_list_t *list, const cm1e_object_list_t *objects,
                                        const cm1e_pdo_t *pdo, bool transmit, int sync_manager)
{
    cm1e_described_pdo_t *described = CM1E_APPEND(arena, list);
    described->transmit = transmit;
    described->index = pdo->index;
    described->name = cm1e_arena_text(arena, pdo->name);
    described->sync_manager = sync_manager;
    described->fixed = true;
    for (unsigned i = 0; i < pdo->entry_count; i++) {
        const cm1e_pdo_entry_t *mapped = &pdo->entries[i];
        const cm1e_described_entry_t *entry =
            mapped->index ? cm1e_describe_entry_of(objects, mapped->index, mapped->subindex) : NULL;
        cm1e_described_pdo_entry_t *into = CM1E_APPEND(arena, &described->entries);
        into->index = mapped->index;
        into->subindex = mapped->subindex;
        into->bits = mapped->bits;
        into->name = entry ? entry->name : NULL;
        into->comment = entry && entry->unit[0] != '\0' ? entry->unit : NULL;
        into->type = mapped->index ? mapped_type(arena, entry, mapped->bits) : "";
    }
    return described;
}
