#include <stdlib.h>
#include <string.h>

#include "generate/esi_read.h"

/*
 * An ESI describes an object by a type, whose items are its sub-indexes, and gives values in Info. A base type is one
 * value; a type with SubItems is a record, or, where an item of it is of a type with ArrayInfo, an array, whose
 * elements are resolved here (ETG.2000 "DataTypes", "Objects").
 */

enum { SUBINDEXES = 256, ALIAS_DEPTH = 8, NUMBER_BYTES = 4 };

typedef struct dictionary {
    cm1e_xml_reader_t *reader;
    const cm1e_type_list_t *types;
    cm1e_esi_names_t names;          /* of types -> number in `types` */
    CM1E_LIST(const xmlNode *) nodes; /* DataType, for each of `types` */
} dictionary_t;

/* A sub-index while its object is read. */
typedef struct slot {
    const char *key;     /* how Info calls it: the item's Name; NULL: an element, which has none of its own */
    int64_t offset;      /* in the whole object, in bits */
    const xmlNode *item; /* SubItem of the type */
} slot_t;

static uint32_t bits_of(int64_t bits)
{
    return bits < 0 ? 0 : bits > UINT32_MAX ? UINT32_MAX : (uint32_t)bits;
}

/* ---- types ------------------------------------------------------------------------------------------------------ */

/* Access and PdoMapping; 0 where there are no Flags. */
static uint8_t read_access(cm1e_xml_reader_t *reader, const xmlNode *node)
{
    const xmlNode *flags = cm1e_xml_child(node, "Flags"), *access = cm1e_xml_child(flags, "Access");
    const char *word = access ? cm1e_xml_text(reader, access) : "";
    const char *mapping = cm1e_xml_child_text(reader, flags, "PdoMapping", "");
    const char *restriction = cm1e_xml_attribute(reader, access, "WriteRestrictions");
    uint8_t result = 0;
    if (strcasecmp(word, "ro") == 0 || strcasecmp(word, "rw") == 0)
        result |= CM1E_ACCESS_READ;
    if (strcasecmp(word, "wo") == 0 || strcasecmp(word, "rw") == 0)
        result |= CM1E_ACCESS_WRITE;
    if ((result & CM1E_ACCESS_WRITE) && restriction && strcasecmp(restriction, "PreOP") == 0)
        result |= CM1E_ACCESS_WRITE_PREOP_ONLY;
    if (strpbrk(mapping, "Rr"))
        result |= CM1E_ACCESS_RXPDO;
    if (strpbrk(mapping, "Tt"))
        result |= CM1E_ACCESS_TXPDO;
    return result;
}

/* A size, a place or a bound, limited so that the checker can add them without overflow. */
static int64_t number_of(cm1e_xml_reader_t *reader, const xmlNode *node, const char *name)
{
    const int64_t limit = (int64_t)SUBINDEXES << 33;
    return cm1e_xml_child_number(reader, node, name, -limit, limit, 0);
}

static void read_item(cm1e_xml_reader_t *reader, const xmlNode *node, cm1e_type_definition_t *type)
{
    cm1e_type_item_t *item = CM1E_APPEND(reader->arena, &type->items);
    item->place = cm1e_xml_line(node);
    item->has_subindex = cm1e_xml_child(node, "SubIdx") != NULL;
    item->subindex = (uint8_t)cm1e_xml_child_number(reader, node, "SubIdx", 0, UINT8_MAX, 0);
    item->name = cm1e_xml_child_text(reader, node, "Name", "");
    item->type = cm1e_xml_child_text(reader, node, "Type", "");
    item->bits = number_of(reader, node, "BitSize");
    item->offset = number_of(reader, node, "BitOffs");
    item->access = read_access(reader, node);
}

/* Of several dimensions there are as many elements as they have together. */
static void read_bounds(cm1e_xml_reader_t *reader, const xmlNode *node, cm1e_type_definition_t *type)
{
    const xmlNode *bounds = cm1e_xml_child(node, "ArrayInfo");
    type->is_array = bounds != NULL;
    type->lower_bound = number_of(reader, bounds, "LBound");
    type->elements = bounds ? 1 : 0;
    for (; bounds; bounds = cm1e_xml_next(bounds, "ArrayInfo")) {
        const int64_t elements = cm1e_xml_child_number(reader, bounds, "Elements", 0, UINT16_MAX, 0);
        type->elements = type->elements > UINT32_MAX ? type->elements : type->elements * elements;
    }
}

static void read_types(dictionary_t *dictionary, const xmlNode *data_types, cm1e_type_list_t *types)
{
    cm1e_xml_reader_t *reader = dictionary->reader;
    for (const xmlNode *node = cm1e_xml_child(data_types, "DataType"); node; node = cm1e_xml_next(node, "DataType")) {
        cm1e_type_definition_t *type = CM1E_APPEND(reader->arena, types);
        type->place = cm1e_xml_line(node);
        const xmlNode *name = cm1e_xml_need(reader, node, "Name");
        type->name = name ? cm1e_xml_text(reader, name) : "";
        type->base_type = cm1e_xml_child_text(reader, node, "BaseType", NULL);
        type->bits = number_of(reader, node, "BitSize");
        read_bounds(reader, node, type);
        for (const xmlNode *item = cm1e_xml_child(node, "SubItem"); item; item = cm1e_xml_next(item, "SubItem"))
            read_item(reader, item, type);
        cm1e_esi_names_add(reader, &dictionary->names, type->name, dictionary->nodes.count);
        *(const xmlNode **)CM1E_APPEND(reader->arena, &dictionary->nodes) = node;
    }
    dictionary->types = types;
    cm1e_esi_names_sort(&dictionary->names);
}

/* Number of a type in the list; its count: there is none. */
static size_t find_type(const dictionary_t *dictionary, const char *name)
{
    const size_t found = cm1e_esi_names_find(&dictionary->names, name);
    return found < dictionary->names.count ? dictionary->names.at[found].number : dictionary->nodes.count;
}

static const cm1e_type_definition_t *type_of(const dictionary_t *dictionary, const char *name)
{
    const size_t found = find_type(dictionary, name);
    return found < dictionary->nodes.count
               ? &dictionary->types->at[dictionary->types->count - dictionary->nodes.count + found]
               : NULL;
}

/* The base type behind a name: an enumeration is a number, say. "": there is none. */
static const char *base_of(const dictionary_t *dictionary, const char *name)
{
    for (int depth = 0; name && depth < ALIAS_DEPTH; depth++) {
        if (cm1e_type_code(name) != 0)
            return name;
        const cm1e_type_definition_t *type = type_of(dictionary, name);
        if (!type || type->is_array)
            return "";
        name = type->base_type;
    }
    return "";
}

/* ---- values ----------------------------------------------------------------------------------------------------- */

static cm1e_bytes_t bytes_of_number(dictionary_t *dictionary, const cm1e_described_entry_t *entry, int64_t value)
{
    const size_t bytes = entry->bits > 0 ? ((size_t)entry->bits + 7) / 8 : NUMBER_BYTES;
    return cm1e_bytes_of(dictionary->reader->arena, value, bytes < sizeof value ? bytes : sizeof value);
}

static bool real_of(dictionary_t *dictionary, const cm1e_described_entry_t *entry, const char *text,
                    cm1e_bytes_t *bytes)
{
    const bool is_single = strcmp(entry->type, "REAL") == 0;
    double number;
    if ((!is_single && strcmp(entry->type, "LREAL") != 0) || !cm1e_xml_real(text, &number))
        return false;
    const float single = (float)number;
    bytes->size = is_single ? sizeof single : sizeof number;
    bytes->data = cm1e_arena_bytes(dictionary->reader->arena, is_single ? (const void *)&single : &number, bytes->size);
    return true;
}

/* A number of up to 64 bits, with or without sign, decimal or "#x". */
static bool integer_of(const char *text, int64_t *value)
{
    const bool hexadecimal = (text[0] == '#' || text[0] == '0') && (text[1] == 'x' || text[1] == 'X');
    char *end;
    *value = hexadecimal      ? (int64_t)strtoull(text + 2, &end, 16)
             : text[0] == '-' ? strtoll(text, &end, 10)
                              : (int64_t)strtoull(text, &end, 10);
    return end != text + (hexadecimal ? 2 : 0) && *end == '\0';
}

static cm1e_bytes_t read_value(dictionary_t *dictionary, const cm1e_described_entry_t *entry, const xmlNode *node)
{
    const char *text = cm1e_xml_text(dictionary->reader, node);
    cm1e_bytes_t bytes = {0};
    int64_t value;
    if (!text || *text == '\0' || real_of(dictionary, entry, text, &bytes))
        return bytes;
    if (integer_of(text, &value))
        return bytes_of_number(dictionary, entry, value);
    cm1e_xml_fail(dictionary->reader, node, "%s is \"%.60s\", which is no number: 26, #x1A and 0x1A are",
                  (const char *)node->name, text);
    return bytes;
}

static cm1e_bytes_t read_string(dictionary_t *dictionary, const xmlNode *node)
{
    const char *text = cm1e_xml_text(dictionary->reader, node);
    return (cm1e_bytes_t){(const uint8_t *)text, text ? strlen(text) : 0};
}

/* Bytes; a single digit is a number. */
static cm1e_bytes_t read_data(dictionary_t *dictionary, const xmlNode *node)
{
    const char *text = cm1e_xml_text(dictionary->reader, node);
    int64_t digit;
    if (text && strlen(text) == 1 && integer_of(text, &digit))
        return cm1e_bytes_of(dictionary->reader->arena, digit, 1);
    return cm1e_xml_hex(dictionary->reader, node);
}

static void take(cm1e_bytes_t *into, cm1e_bytes_t bytes)
{
    if (bytes.data && bytes.size > 0)
        *into = bytes;
}

/* `node` is an Info, or a SubItem of a type, where values stood before there was Info. */
static void read_values(dictionary_t *dictionary, const xmlNode *node, cm1e_described_entry_t *entry)
{
    take(&entry->default_data, read_string(dictionary, cm1e_xml_child(node, "DefaultString")));
    take(&entry->default_data, read_value(dictionary, entry, cm1e_xml_child(node, "DefaultValue")));
    take(&entry->default_data, read_data(dictionary, cm1e_xml_child(node, "DefaultData")));
    take(&entry->minimum, read_value(dictionary, entry, cm1e_xml_child(node, "MinValue")));
    take(&entry->minimum, read_data(dictionary, cm1e_xml_child(node, "MinData")));
    take(&entry->maximum, read_value(dictionary, entry, cm1e_xml_child(node, "MaxValue")));
    take(&entry->maximum, read_data(dictionary, cm1e_xml_child(node, "MaxData")));
}

/* ---- sub-indexes ------------------------------------------------------------------------------------------------ */

/* "[unit] comment", as our writer puts it. */
static void read_comment(dictionary_t *dictionary, const xmlNode *node, cm1e_described_entry_t *entry)
{
    const char *text = cm1e_esi_text(dictionary->reader, node, "Comment", NULL);
    const char *end = text && text[0] == '[' ? strchr(text, ']') : NULL;
    entry->unit = "";
    if (end && end > text + 1 && (end[1] == '\0' || (end[1] == ' ' && end[2] != '\0' && end[2] != ' '))) {
        entry->unit = cm1e_arena_format(dictionary->reader->arena, "%.*s", (int)(end - text - 1), text + 1);
        text = end[1] == '\0' ? NULL : end + 2;
    }
    entry->comment = text;
}

static void add_slot(dictionary_t *dictionary, cm1e_described_object_t *object, slot_t *slots,
                     const cm1e_described_entry_t *entry, slot_t slot)
{
    if (object->entries.count >= SUBINDEXES)
        return;
    slots[object->entries.count] = slot;
    *(cm1e_described_entry_t *)CM1E_APPEND(dictionary->reader->arena, &object->entries) = *entry;
}

/* Elements of an array; sub-index 0 is their number and not one of them. */
static void add_elements(dictionary_t *dictionary, cm1e_described_object_t *object, slot_t *slots,
                         cm1e_described_entry_t *entry, slot_t slot, const cm1e_type_definition_t *array)
{
    const int64_t first = array->lower_bound < 1 ? 1 : array->lower_bound;
    const char *name = array->base_type ? array->base_type : "";
    const cm1e_type_definition_t *base = type_of(dictionary, name);
    entry->type = base_of(dictionary, name);
    entry->bits = cm1e_type_bits(entry->type);
    if (entry->bits == 0)
        entry->bits = bits_of(base ? base->bits : array->elements > 0 ? array->bits / array->elements : 0);
    for (int64_t i = 0; i < array->elements && first + i < SUBINDEXES; i++) {
        entry->subindex = (uint8_t)(first + i);
        entry->name = cm1e_arena_format(dictionary->reader->arena, "SubIndex %03u", (unsigned)entry->subindex);
        add_slot(dictionary, object, slots, entry, slot);
        slot.offset += entry->bits;
    }
}

/* The sub-indexes that a type has, as entries of the object. */
static void resolve(dictionary_t *dictionary, size_t number, cm1e_described_object_t *object, uint8_t access,
                    slot_t *slots)
{
    const cm1e_type_definition_t *type =
        &dictionary->types->at[dictionary->types->count - dictionary->nodes.count + number];
    const xmlNode *node = cm1e_xml_child(dictionary->nodes.at[number], "SubItem");
    object->code = CM1E_OBJECT_RECORD;
    for (size_t i = 0; i < type->items.count && object->entries.count < SUBINDEXES; i++) {
        const cm1e_type_item_t *item = &type->items.at[i];
        cm1e_described_entry_t entry = {.place = item->place, .subindex = item->subindex};
        slot_t slot = {.key = item->name, .offset = item->offset, .item = node};
        const cm1e_type_definition_t *of = type_of(dictionary, item->type);
        entry.access = item->access ? item->access : access;
        entry.bits = bits_of(item->bits);
        read_comment(dictionary, node, &entry);
        if (item->has_subindex) {
            entry.name = cm1e_esi_text(dictionary->reader, node, "DisplayName", item->name);
            entry.type = base_of(dictionary, item->type);
            add_slot(dictionary, object, slots, &entry, slot);
        } else if (of && of->is_array) { /* no sub-index and no array: a gap */
            object->code = CM1E_OBJECT_ARRAY;
            slot.key = NULL;
            add_elements(dictionary, object, slots, &entry, slot, of);
        }
        node = cm1e_xml_next(node, "SubItem");
    }
}

/* Which entry a SubItem of Info means: the one of that name; an element, which has none in the type, by its turn. */
static size_t entry_meant(const cm1e_described_object_t *object, const slot_t *slots, size_t turn, const char *name)
{
    for (size_t n = 0; n < object->entries.count; n++) {
        const size_t i = (turn + n) % object->entries.count;
        if (strcmp(slots[i].key ? slots[i].key : object->entries.at[i].name, name) == 0)
            return i;
    }
    return turn;
}

static void read_items_of_info(dictionary_t *dictionary, const xmlNode *info, cm1e_described_object_t *object,
                               const slot_t *slots)
{
    size_t turn = 0;
    for (const xmlNode *item = cm1e_xml_child(info, "SubItem"); item; item = cm1e_xml_next(item, "SubItem")) {
        const char *name = cm1e_xml_child_text(dictionary->reader, item, "Name", "");
        const size_t meant = entry_meant(object, slots, turn, name);
        if (meant >= object->entries.count)
            continue;
        cm1e_described_entry_t *entry = &object->entries.at[meant];
        entry->place = cm1e_xml_line(item);
        /* NOLINTNEXTLINE(clang-analyzer-core.uninitialized.Branch): resolve() fills a slot for each entry */
        if (!slots[meant].key && *name)
            entry->name = name;
        read_values(dictionary, cm1e_xml_child(item, "Info"), entry);
        turn = meant + 1;
    }
}

/* Default data of the whole object, as it would come by complete access. */
static void split_default(dictionary_t *dictionary, cm1e_bytes_t whole, cm1e_described_object_t *object,
                          const slot_t *slots)
{
    for (size_t i = 0; i < object->entries.count; i++) {
        cm1e_described_entry_t *entry = &object->entries.at[i];
        /* NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): resolve() fills a slot for each entry */
        const size_t bits = entry->bits, at = slots[i].offset < 0 ? SIZE_MAX / 2 : (size_t)slots[i].offset;
        if (bits == 0 || at + bits > 8 * whole.size)
            continue;
        uint8_t *bytes = cm1e_arena_take(dictionary->reader->arena, (bits + 7) / 8);
        if (dictionary->reader->arena->failed)
            return;
        for (size_t bit = 0; bit < bits; bit++)
            bytes[bit / 8] |= (uint8_t)((whole.data[(at + bit) / 8] >> (at + bit) % 8 & 1) << bit % 8);
        entry->default_data = (cm1e_bytes_t){bytes, (bits + 7) / 8};
    }
}

/* ---- objects ---------------------------------------------------------------------------------------------------- */

static void read_record(dictionary_t *dictionary, const xmlNode *node, size_t type, uint8_t access,
                        cm1e_described_object_t *object)
{
    slot_t slots[SUBINDEXES];
    const xmlNode *info = cm1e_xml_child(node, "Info");
    resolve(dictionary, type, object, access, slots);
    if (dictionary->reader->arena->failed)
        return;
    for (size_t i = 0; i < object->entries.count; i++)
        /* NOLINTNEXTLINE(clang-analyzer-core.uninitialized.Branch): resolve() fills a slot for each entry */
        if (slots[i].key)
            read_values(dictionary, slots[i].item, &object->entries.at[i]);
    const cm1e_bytes_t whole = read_data(dictionary, cm1e_xml_child(info, "DefaultData"));
    if (whole.data)
        split_default(dictionary, whole, object, slots);
    read_items_of_info(dictionary, info, object, slots);
    object->comment = cm1e_esi_text(dictionary->reader, node, "Comment", NULL);
}

static void read_variable(dictionary_t *dictionary, const xmlNode *node, uint8_t access,
                          cm1e_described_object_t *object)
{
    cm1e_described_entry_t *entry = CM1E_APPEND(dictionary->reader->arena, &object->entries);
    entry->place = object->place;
    entry->name = object->name;
    entry->type = base_of(dictionary, object->type);
    entry->bits = object->bits ? object->bits : cm1e_type_bits(entry->type);
    entry->access = access;
    object->code = entry->type[0] ? CM1E_OBJECT_VAR : 0;
    read_comment(dictionary, node, entry);
    read_values(dictionary, cm1e_xml_child(node, "Info"), entry);
}

static void read_object(dictionary_t *dictionary, const xmlNode *node, cm1e_object_list_t *objects)
{
    cm1e_xml_reader_t *reader = dictionary->reader;
    cm1e_described_object_t *object = CM1E_APPEND(reader->arena, objects);
    const uint8_t access = read_access(reader, node);
    object->place = cm1e_xml_line(node);
    object->index = cm1e_esi_index(reader, cm1e_xml_need(reader, node, "Index"), &object->depends_on_slot);
    object->name = cm1e_esi_text(reader, node, "Name", "");
    object->type = cm1e_xml_child_text(reader, node, "Type", "");
    object->bits = bits_of(number_of(reader, node, "BitSize"));
    const cm1e_type_definition_t *type = type_of(dictionary, object->type);
    if (type && type->items.count > 0)
        read_record(dictionary, node, find_type(dictionary, object->type), access, object);
    else
        read_variable(dictionary, node, access, object);
}

void cm1e_esi_read_dictionary(cm1e_xml_reader_t *reader, const xmlNode *dictionary, cm1e_type_list_t *types,
                              cm1e_object_list_t *objects)
{
    dictionary_t read = {.reader = reader};
    const xmlNode *list = cm1e_xml_child(dictionary, "Objects");
    read_types(&read, cm1e_xml_child(dictionary, "DataTypes"), types);
    for (const xmlNode *object = cm1e_xml_child(list, "Object"); object && !reader->arena->failed;
         object = cm1e_xml_next(object, "Object"))
        read_object(&read, object, objects);
}
