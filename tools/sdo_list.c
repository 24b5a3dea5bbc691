#include "sdo_list.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cm1e/sdo_info.h"
#include "command.h"
#include "core/bytes.h"
#include "core/json_text.h"
#include "core/text.h"
#include "description/description.h"
#include "device/devices.h"

enum { OBJECTS_MAX = 0x10000, VALUE_BYTES = 256, VALUE_TEXT = 300 };

typedef struct list {
    cm1e_bus_t *bus;
    const cm1e_slave_info_t *slave;
    uint16_t position;
    bool values;
    json_t *json;        /* array; NULL: print */
    cm1e_arena_t arena;  /* names of types */
    cm1e_diag_t diag;
} list_t;

/* ---- what the tables know --------------------------------------------------------------------------------------- */

const cm1e_entry_t *find_entry(const cm1e_slave_info_t *slave, uint16_t index, uint8_t subindex)
{
    return slave->device ? slave->device->entry(slave->device, index, subindex) : NULL;
}

const char *availability_mark(const cm1e_entry_t *entry)
{
    static const char *const marks[] = {[CM1E_AVAILABLE] = "", [CM1E_NOT_AVAILABLE] = "N/A", [CM1E_NO_PARAMETER] = "-"};
    return marks[entry ? entry->availability : CM1E_AVAILABLE];
}

/** A refusal concerns one object; every other error would repeat for the next one. */
static bool goes_on(cm1e_error_t error) { return error == CM1E_OK || error == CM1E_ERROR_SDO_ABORT; }

/* ---- values ----------------------------------------------------------------------------------------------------- */

static bool is_signed(const char *type)
{
    return strcmp(type, "SINT") == 0 || strcmp(type, "INT") == 0 || strcmp(type, "DINT") == 0 ||
           strcmp(type, "LINT") == 0;
}

static bool is_unsigned(const char *type)
{
    return strcmp(type, "BOOL") == 0 || strcmp(type, "USINT") == 0 || strcmp(type, "UINT") == 0 ||
           strcmp(type, "UDINT") == 0 || strcmp(type, "ULINT") == 0;
}

/** A number, a text, or bytes in hexadecimal. */
static json_t *value_as_json(const char *type, const uint8_t *bytes, size_t size)
{
    const cm1e_bytes_t number = {bytes, size};
    if (size >= 1 && size <= 8 && is_signed(type))
        return json_integer((json_int_t)cm1e_bytes_signed(number));
    if (size >= 1 && size <= 8 && is_unsigned(type))
        return json_integer((json_int_t)cm1e_bytes_unsigned(number));
    char text[VALUE_TEXT] = "";
    if (strncmp(type, "STRING", 6) == 0) {
        cm1e_text_of_device(text, sizeof text, bytes, size);
        return cm1e_json_text(text);
    }
    for (size_t i = 0; i < size && strlen(text) + 4 < sizeof text; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "%s%02X", i ? " " : "", bytes[i]);
    return json_string(text);
}

/** The present value; NULL: it cannot be read, or was not requested. */
static json_t *read_value(list_t *list, const cm1e_entry_info_t *entry, const char *type)
{
    uint8_t bytes[VALUE_BYTES];
    size_t size = sizeof bytes;
    cm1e_diag_t why;
    if (!list->values || !(entry->access & (CM1E_INFO_READ_PREOP | CM1E_INFO_READ_SAFEOP | CM1E_INFO_READ_OP)) ||
        cm1e_sdo_read(list->bus, list->position, entry->index, entry->subindex, bytes, &size, &why) != CM1E_OK)
        return NULL;
    return value_as_json(type, bytes, size);
}

/* ---- one entry -------------------------------------------------------------------------------------------------- */

/** "rw" for all states; "p": in Pre-Operational only; "-": never. */
static char access_letter(uint16_t access, uint16_t preop, uint16_t others, char letter)
{
    return (access & others) ? letter : (access & preop) ? 'p' : '-';
}

static void print_entry(const cm1e_entry_info_t *entry, const char *type, const char *mark, const json_t *value)
{
    const char access[] = {
        access_letter(entry->access, CM1E_INFO_READ_PREOP, CM1E_INFO_READ_SAFEOP | CM1E_INFO_READ_OP, 'r'),
        access_letter(entry->access, CM1E_INFO_WRITE_PREOP, CM1E_INFO_WRITE_SAFEOP | CM1E_INFO_WRITE_OP, 'w'), '\0'};
    printf("  :%02X  %-12s %4u  %s  %s%s  %s", entry->subindex, type, entry->bits, access,
           entry->access & CM1E_INFO_RXPDO ? "Rx" : "--", entry->access & CM1E_INFO_TXPDO ? "Tx" : "--", entry->name);
    if (json_is_integer(value) && json_integer_value(value) > 9)
        printf(" = %" JSON_INTEGER_FORMAT " (0x%llX)", json_integer_value(value),
               (unsigned long long)json_integer_value(value));
    else if (json_is_integer(value))
        printf(" = %" JSON_INTEGER_FORMAT, json_integer_value(value));
    else if (value)
        printf(" = \"%s\"", json_string_value(value));
    if (mark[0])
        printf("  (%s)", mark);
    putchar('\n');
}

static void set_told(json_t *object, const char *key, const char *type, const cm1e_info_value_t *value)
{
    if (value->size > 0)
        json_object_set_new(object, key, value_as_json(type, value->bytes, value->size));
}

static json_t *entry_as_json(const cm1e_entry_info_t *entry, const char *type, const char *mark, json_t *value)
{
    const uint16_t access = entry->access;
    json_t *object = json_pack(
        "{s:i, s:s, s:s, s:i, s:b, s:b, s:b, s:b, s:b}", "subindex", entry->subindex, "name", entry->name, "type", type,
        "bits", entry->bits, "read", access & 0x07, "write", access & 0x38, "write_preop_only",
        (access & CM1E_INFO_WRITE_PREOP) && !(access & (CM1E_INFO_WRITE_SAFEOP | CM1E_INFO_WRITE_OP)), "rxpdo",
        access & CM1E_INFO_RXPDO, "txpdo", access & CM1E_INFO_TXPDO);
    set_told(object, "default", type, &entry->default_value);
    set_told(object, "minimum", type, &entry->minimum);
    set_told(object, "maximum", type, &entry->maximum);
    if (value)
        json_object_set(object, "value", value);
    if (mark[0])
        json_object_set_new(object, "availability", json_string(mark));
    return object;
}

static cm1e_error_t list_entry(list_t *list, uint16_t index, uint8_t subindex, json_t *entries)
{
    cm1e_entry_info_t entry;
    const cm1e_error_t error = cm1e_sdo_info_entry(list->bus, list->position, index, subindex, &entry, &list->diag);
    if (error != CM1E_OK)
        return error; /* a gap in the sub-indexes is refused */
    const char *known = cm1e_type_name(&list->arena, entry.data_type, entry.bits);
    char number[16];
    snprintf(number, sizeof number, "type 0x%04X", entry.data_type);
    const char *type = known ? known : number;
    const char *mark = availability_mark(find_entry(list->slave, index, subindex));
    json_t *value = read_value(list, &entry, type);
    if (entries)
        json_array_append_new(entries, entry_as_json(&entry, type, mark, value));
    else
        print_entry(&entry, type, mark, value);
    json_decref(value);
    return CM1E_OK;
}

/* ---- the dictionary --------------------------------------------------------------------------------------------- */

static const char *code_name(uint8_t code)
{
    static const char *const names[] = {[CM1E_OBJECT_VAR] = "VAR", [CM1E_OBJECT_ARRAY] = "ARRAY",
                                        [CM1E_OBJECT_RECORD] = "RECORD"};
    return code < sizeof names / sizeof names[0] && names[code] ? names[code] : "?";
}

static cm1e_error_t list_object(list_t *list, uint16_t index)
{
    cm1e_object_info_t object;
    cm1e_error_t error = cm1e_sdo_info_object(list->bus, list->position, index, &object, &list->diag);
    if (error != CM1E_OK) {
        complain("%s", list->diag.text);
        return error;
    }
    json_t *entries = list->json ? json_array() : NULL;
    if (!list->json)
        printf("0x%04X  %-6s %s\n", index, code_name(object.code), object.name);
    const unsigned highest = object.code == CM1E_OBJECT_VAR ? 0 : object.highest_subindex;
    for (unsigned subindex = 0; subindex <= highest && goes_on(error); subindex++)
        error = list_entry(list, index, (uint8_t)subindex, entries);
    if (list->json)
        json_array_append_new(list->json, json_pack("{s:i, s:s, s:s, s:o}", "index", index, "name", object.name, "code",
                                                    code_name(object.code), "entries", entries));
    return error;
}

int list_dictionary(cm1e_bus_t *bus, const cm1e_slave_info_t *slave, bool values, bool json)
{
    const uint16_t position = slave->position;
    list_t list = {.bus = bus, .slave = slave, .position = position, .values = values,
                   .json = json ? json_array() : NULL};
    uint16_t *indexes = calloc(OBJECTS_MAX, sizeof *indexes);
    size_t count = indexes ? OBJECTS_MAX : 0;
    cm1e_error_t error = indexes ? cm1e_sdo_info_list(bus, position, CM1E_OBJECTS_ALL, indexes, &count, &list.diag)
                                 : cm1e_diag_set(&list.diag, CM1E_ERROR_NO_MEMORY, 0, "out of memory");
    int status = EXIT_OK;
    if (error != CM1E_OK)
        status = fail(&list.diag);
    for (size_t i = 0; i < count && status == EXIT_OK; i++)
        if (!goes_on(list_object(&list, indexes[i])))
            status = fail(&list.diag);
    if (list.json && status == EXIT_OK)
        print_json(list.json);
    else
        json_decref(list.json);
    cm1e_arena_free(&list.arena);
    free(indexes);
    return status;
}
