#include "generate/esi_write.h"

#include <inttypes.h>
#include <search.h>
#include <string.h>

/*
 * Data types of a dictionary (ETG.2000 "DataTypes"): base types by name and size; for every object with sub-indexes a
 * type DTxxxx with an item for each, or for alike elements an item for all of them, of an array type DTxxxxARR. Objects
 * of the same shape share the type of the first of them.
 */

enum { AFTER_SUBINDEX_0 = 16 };

typedef struct base_type {
    const char *name;
    uint32_t bits;
} base_type_t;

typedef struct definition {
    const char *name;                       /* "DT1018" */
    const cm1e_described_object_t *object;  /* the first of this shape */
    const char **item_names;                /* of its sub-indexes, each one once */
    const char **item_types;
    bool is_array;
} definition_t;

typedef struct types {
    cm1e_arena_t *arena;
    CM1E_LIST(base_type_t) base;
    CM1E_LIST(const definition_t *) definitions;
    CM1E_LIST(const definition_t *) of_objects; /* in the order of the objects; NULL: of a base type */
    void *names;                                /* trees of tsearch(): of all types ... */
    void *shapes;                               /* definitions by the shape of their object */
} types_t;

static int compare_given(const char *a, const char *b)
{
    return strcmp(a ? a : "", b ? b : "");
}

static bool same(const char *a, const char *b)
{
    return compare_given(a, b) == 0;
}

static bool is_given(const char *text)
{
    return text && text[0] != '\0';
}

/* No sub-indexes: the object is of a base type. */
static bool is_simple(const cm1e_described_object_t *object)
{
    if (object->entries.count == 0)
        return true;
    return object->entries.count == 1 && object->entries.at[0].subindex == 0 &&
           object->code != CM1E_OBJECT_ARRAY && object->code != CM1E_OBJECT_RECORD;
}

static const char *generic_name(cm1e_arena_t *arena, unsigned subindex)
{
    return cm1e_arena_format(arena, "SubIndex %03u", subindex);
}

/* An array type has one item for all elements, so it has no place for a name or unit of a single element. */
static bool is_array(cm1e_arena_t *arena, const cm1e_described_object_t *object)
{
    if (object->code != CM1E_OBJECT_ARRAY || object->entries.count < 2 || object->entries.at[0].subindex != 0)
        return false;
    const cm1e_described_entry_t *first = &object->entries.at[1];
    for (size_t i = 1; i < object->entries.count; i++) {
        const cm1e_described_entry_t *entry = &object->entries.at[i];
        if (entry->subindex != i || entry->bits != first->bits || entry->access != first->access ||
            !same(entry->type, first->type) || !same(entry->unit, first->unit) ||
            !same(entry->comment, first->comment))
            return false;
        if (is_given(entry->name) && !same(entry->name, generic_name(arena, entry->subindex)))
            return false;
    }
    return true;
}

/* A type has to have a name, also where only its size is known. */
static const char *type_name(cm1e_arena_t *arena, const char *type, uint32_t bits)
{
    if (is_given(type))
        return type;
    switch (bits) {
    case 8: return "USINT";
    case 16: return "UINT";
    case 32: return "UDINT";
    case 64: return "ULINT";
    default:
        return bits % 8 == 0 ? cm1e_arena_format(arena, "OCTET_STRING(%" PRIu32 ")", bits / 8)
                             : cm1e_arena_format(arena, "BIT%" PRIu32, bits);
    }
}

static const char *entry_type(cm1e_arena_t *arena, const cm1e_described_entry_t *entry)
{
    return type_name(arena, entry->type, entry->bits);
}

/* ---- collecting ------------------------------------------------------------------------------------------------- */

static int compare_texts(const void *a, const void *b)
{
    return strcmp(a, b);
}

/* false: the name was there already. */
static bool add_name(types_t *types, const char *name)
{
    if (tfind(name, &types->names, compare_texts))
        return false;
    types->arena->failed |= !tsearch(name, &types->names, compare_texts);
    return !types->arena->failed;
}

static void add_base_type(types_t *types, const char *name, uint32_t bits)
{
    const uint32_t known_bits = cm1e_type_bits(name);
    if (add_name(types, name))
        *(base_type_t *)CM1E_APPEND(types->arena, &types->base) = (base_type_t){name, known_bits ? known_bits : bits};
}

static int compare_numbers(int64_t a, int64_t b)
{
    return (a > b) - (a < b);
}

/* Written in addition to the Name of an item, if the sub-index has another name. */
static const char *display_name(const definition_t *definition, size_t item)
{
    const char *name = definition->object->entries.at[item].name;
    return is_given(name) && strcmp(name, definition->item_names[item]) != 0 ? name : "";
}

/* Compares by the written form, because a file that is read again must give the same shapes. */
static int compare_items(const definition_t *a, const definition_t *b, size_t item)
{
    const cm1e_described_entry_t *left = &a->object->entries.at[item], *right = &b->object->entries.at[item];
    int order = compare_numbers(left->subindex, right->subindex);
    order = order ? order : compare_numbers(left->bits, right->bits);
    order = order ? order : compare_numbers(left->access, right->access);
    order = order ? order : strcmp(a->item_types[item], b->item_types[item]);
    order = order ? order : strcmp(a->item_names[item], b->item_names[item]);
    order = order ? order : strcmp(display_name(a, item), display_name(b, item));
    order = order ? order : compare_given(left->unit, right->unit);
    return order ? order : compare_given(left->comment, right->comment);
}

static int compare_shapes(const void *left, const void *right)
{
    const definition_t *a = left, *b = right;
    int order = compare_numbers((int64_t)a->object->entries.count, (int64_t)b->object->entries.count);
    order = order ? order : compare_numbers(a->is_array, b->is_array);
    for (size_t i = 0; !order && i < a->object->entries.count; i++)
        order = compare_items(a, b, i);
    return order;
}

static bool name_is_taken(const char *const *names, size_t count, const char *name)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(names[i], name) == 0)
            return true;
    return false;
}

/* The names by which items of the type and what an object says of them find each other: each one once. */
static const char **unique_item_names(cm1e_arena_t *arena, const cm1e_described_object_t *object)
{
    CM1E_LIST(const char *) names = {0};
    for (size_t i = 0; i < object->entries.count; i++) {
        const unsigned subindex = object->entries.at[i].subindex;
        const char *name = object->entries.at[i].name;
        if (!is_given(name) || name_is_taken(names.at, names.count, name))
            name = generic_name(arena, subindex);
        for (size_t n = i + 1; !arena->failed && name_is_taken(names.at, names.count, name); n++)
            name = cm1e_arena_format(arena, "SubIndex %03u (%zu)", subindex, n);
        *(const char **)CM1E_APPEND(arena, &names) = name;
    }
    return names.at;
}

static const char **item_types(cm1e_arena_t *arena, const cm1e_described_object_t *object)
{
    CM1E_LIST(const char *) names = {0};
    for (size_t i = 0; i < object->entries.count; i++)
        *(const char **)CM1E_APPEND(arena, &names) = entry_type(arena, &object->entries.at[i]);
    return names.at;
}

/* Two objects with the same index and different contents are wrong, but are written unchanged. */
static const char *definition_name(types_t *types, uint16_t index)
{
    const char *name = cm1e_arena_format(types->arena, "DT%04X", index);
    const char *of_elements = cm1e_arena_format(types->arena, "%sARR", name);
    for (size_t n = types->definitions.count + 1;
         !types->arena->failed && !(add_name(types, name) && add_name(types, of_elements)); n++) {
        name = cm1e_arena_format(types->arena, "DT%04X_%zu", index, n);
        of_elements = cm1e_arena_format(types->arena, "%sARR", name);
    }
    return name;
}

static const definition_t *define(types_t *types, const cm1e_described_object_t *object)
{
    definition_t *definition = cm1e_arena_take(types->arena, sizeof *definition);
    definition->object = object;
    definition->item_names = unique_item_names(types->arena, object);
    definition->item_types = item_types(types->arena, object);
    definition->is_array = is_array(types->arena, object);
    definition_t **found = types->arena->failed ? NULL : tsearch(definition, &types->shapes, compare_shapes);
    types->arena->failed |= !found;
    if (!found || *found != definition)
        return found ? *found : NULL;
    definition->name = definition_name(types, object->index);
    *(const definition_t **)CM1E_APPEND(types->arena, &types->definitions) = definition;
    return definition;
}

static void collect(types_t *types, const cm1e_object_list_t *objects)
{
    for (size_t i = 0; i < objects->count; i++) {
        const cm1e_described_object_t *object = &objects->at[i];
        if (object->entries.count == 0)
            add_base_type(types, type_name(types->arena, "", object->bits), object->bits);
        for (size_t j = 0; j < object->entries.count; j++)
            add_base_type(types, entry_type(types->arena, &object->entries.at[j]), object->entries.at[j].bits);
    }
    for (size_t i = 0; i < objects->count; i++)
        *(const definition_t **)CM1E_APPEND(types->arena, &types->of_objects) =
            is_simple(&objects->at[i]) ? NULL : define(types, &objects->at[i]);
}

static void keep(void *node)
{
    (void)node; /* is in the arena */
}

static void forget(types_t *types)
{
    tdestroy(types->names, keep);
    tdestroy(types->shapes, keep);
}

/* ---- sizes ------------------------------------------------------------------------------------------------------ */

/* Where a sub-index lies in the whole object when the ones before it end at `end`: sub-index 0 takes 16 bits at least
 * (ETG.1000.6 5.6.2, complete access), whole bytes begin at a byte. Sub-indexes that do not exist take no room. */
static int64_t offset_of(const cm1e_described_entry_t *entry, int64_t end)
{
    if (entry->subindex != 0 && end < AFTER_SUBINDEX_0)
        end = AFTER_SUBINDEX_0;
    return entry->bits % 8 == 0 ? (end + 7) / 8 * 8 : end;
}

static int64_t bits_of(const cm1e_described_object_t *object)
{
    if (object->entries.count == 0)
        return object->bits;
    if (is_simple(object))
        return object->entries.at[0].bits;
    int64_t end = 0;
    for (size_t i = 0; i < object->entries.count; i++)
        end = offset_of(&object->entries.at[i], end) + object->entries.at[i].bits;
    return (end + 7) / 8 * 8;
}

static int64_t elements_bits(const cm1e_described_object_t *object)
{
    return (int64_t)(object->entries.count - 1) * object->entries.at[1].bits;
}

/* ---- writing ---------------------------------------------------------------------------------------------------- */

static void put_number(cm1e_xml_writer_t *xml, const char *name, int64_t number)
{
    cm1e_xml_put(xml, name, "%" PRId64, number);
}

static void put_comment(cm1e_xml_writer_t *xml, const char *unit, const char *comment)
{
    if (is_given(unit))
        cm1e_xml_put(xml, "Comment", "[%s]%s%s", unit, is_given(comment) ? " " : "", comment ? comment : "");
    else if (is_given(comment))
        cm1e_xml_put(xml, "Comment", "%s", comment);
}

static void put_flags(cm1e_xml_writer_t *xml, uint8_t access)
{
    static const char *const words[] = {NULL, "ro", "wo", "rw"};
    static const char *const mappings[] = {NULL, "R", "T", "RT"};
    const char *word = words[access & (CM1E_ACCESS_READ | CM1E_ACCESS_WRITE)];
    const char *mapping = mappings[(access & CM1E_ACCESS_RXPDO ? 1 : 0) + (access & CM1E_ACCESS_TXPDO ? 2 : 0)];
    if (!word && !mapping)
        return;
    cm1e_xml_open(xml, "Flags");
    if (word) {
        cm1e_xml_open(xml, "Access");
        if (access & CM1E_ACCESS_WRITE_PREOP_ONLY)
            cm1e_xml_put_attribute(xml, "WriteRestrictions", "PreOP");
        cm1e_xml_put_text(xml, "%s", word);
        cm1e_xml_close(xml);
    }
    if (mapping)
        cm1e_xml_put(xml, "PdoMapping", "%s", mapping);
    cm1e_xml_close(xml);
}

static void put_item(cm1e_xml_writer_t *xml, cm1e_arena_t *arena, const cm1e_described_entry_t *entry,
                     const char *name, int64_t offset)
{
    cm1e_xml_open(xml, "SubItem");
    cm1e_xml_put(xml, "SubIdx", "%u", entry->subindex);
    cm1e_xml_put(xml, "Name", "%s", name);
    if (is_given(entry->name) && strcmp(entry->name, name) != 0)
        cm1e_xml_put(xml, "DisplayName", "%s", entry->name);
    cm1e_xml_put(xml, "Type", "%s", entry_type(arena, entry));
    put_comment(xml, entry->unit, entry->comment);
    put_number(xml, "BitSize", entry->bits);
    put_number(xml, "BitOffs", offset);
    put_flags(xml, entry->access);
    cm1e_xml_close(xml);
}

static void put_array_type(cm1e_xml_writer_t *xml, cm1e_arena_t *arena, const definition_t *definition)
{
    const cm1e_described_object_t *object = definition->object;
    cm1e_xml_open(xml, "DataType");
    cm1e_xml_put(xml, "Name", "%sARR", definition->name);
    cm1e_xml_put(xml, "BaseType", "%s", entry_type(arena, &object->entries.at[1]));
    put_number(xml, "BitSize", elements_bits(object));
    cm1e_xml_open(xml, "ArrayInfo");
    cm1e_xml_put(xml, "LBound", "1");
    put_number(xml, "Elements", (int64_t)object->entries.count - 1);
    cm1e_xml_close(xml);
    cm1e_xml_close(xml);
}

static void put_elements(cm1e_xml_writer_t *xml, const definition_t *definition)
{
    const cm1e_described_object_t *object = definition->object;
    const cm1e_described_entry_t *first = &object->entries.at[1];
    cm1e_xml_open(xml, "SubItem");
    cm1e_xml_put(xml, "Name", "Elements");
    cm1e_xml_put(xml, "Type", "%sARR", definition->name);
    put_comment(xml, first->unit, first->comment);
    put_number(xml, "BitSize", elements_bits(object));
    put_number(xml, "BitOffs", offset_of(first, object->entries.at[0].bits));
    put_flags(xml, first->access);
    cm1e_xml_close(xml);
}

static void put_definition(cm1e_xml_writer_t *xml, cm1e_arena_t *arena, const definition_t *definition)
{
    const cm1e_described_object_t *object = definition->object;
    if (definition->is_array)
        put_array_type(xml, arena, definition);
    cm1e_xml_open(xml, "DataType");
    cm1e_xml_put(xml, "Name", "%s", definition->name);
    put_number(xml, "BitSize", bits_of(object));
    int64_t end = 0;
    for (size_t i = 0; i < (definition->is_array ? 1 : object->entries.count); i++) {
        const int64_t offset = offset_of(&object->entries.at[i], end);
        put_item(xml, arena, &object->entries.at[i], definition->item_names[i], offset);
        end = offset + object->entries.at[i].bits;
    }
    if (definition->is_array)
        put_elements(xml, definition);
    cm1e_xml_close(xml);
}

static bool has_values(const cm1e_described_entry_t *entry)
{
    return entry->default_data.data || entry->minimum.data || entry->maximum.data;
}

/* MinData, MaxData, DefaultData rather than ...Value: the same for numbers and texts, and never a question of sign. */
static void put_values(cm1e_xml_writer_t *xml, const cm1e_described_entry_t *entry)
{
    cm1e_xml_open(xml, "Info");
    cm1e_xml_put_hex(xml, "MinData", entry->minimum);
    cm1e_xml_put_hex(xml, "MaxData", entry->maximum);
    cm1e_xml_put_hex(xml, "DefaultData", entry->default_data);
    cm1e_xml_close(xml);
}

static size_t values_end(const cm1e_described_object_t *object)
{
    size_t end = object->entries.count;
    while (end > 0 && !has_values(&object->entries.at[end - 1]))
        end--;
    return end;
}

/* Found by their names (ETG.2000) or, by some readers, by their order: so those without values are listed too, but not
 * behind the last one that has some. */
static void put_values_of_items(cm1e_xml_writer_t *xml, const cm1e_described_object_t *object,
                                const definition_t *definition)
{
    const size_t end = values_end(object);
    if (end == 0)
        return;
    cm1e_xml_open(xml, "Info");
    for (size_t i = 0; i < end; i++) {
        cm1e_xml_open(xml, "SubItem");
        cm1e_xml_put(xml, "Name", "%s", definition->item_names[i]);
        put_values(xml, &object->entries.at[i]);
        cm1e_xml_close(xml);
    }
    cm1e_xml_close(xml);
}

static void put_simple_object(cm1e_xml_writer_t *xml, cm1e_arena_t *arena, const cm1e_described_object_t *object)
{
    const cm1e_described_entry_t *entry = object->entries.count > 0 ? &object->entries.at[0] : NULL;
    if (entry && (is_given(entry->unit) || is_given(entry->comment)))
        put_comment(xml, entry->unit, entry->comment);
    else
        put_comment(xml, NULL, object->comment);
    cm1e_xml_put(xml, "Type", "%s", entry ? entry_type(arena, entry) : type_name(arena, "", object->bits));
    put_number(xml, "BitSize", bits_of(object));
    if (entry && has_values(entry))
        put_values(xml, entry);
    if (entry)
        put_flags(xml, entry->access);
}

static void put_object(cm1e_xml_writer_t *xml, const types_t *types, const cm1e_described_object_t *object,
                       const definition_t *definition)
{
    cm1e_xml_open(xml, "Object");
    cm1e_esi_put_index(xml, "Index", object->index, object->depends_on_slot);
    cm1e_xml_put(xml, "Name", "%s", object->name ? object->name : "");
    if (!definition) {
        put_simple_object(xml, types->arena, object);
    } else {
        put_comment(xml, NULL, object->comment);
        cm1e_xml_put(xml, "Type", "%s", definition->name);
        put_number(xml, "BitSize", bits_of(object));
        put_values_of_items(xml, object, definition);
    }
    cm1e_xml_close(xml);
}

void cm1e_esi_put_dictionary(cm1e_xml_writer_t *xml, cm1e_arena_t *scratch, const cm1e_object_list_t *objects)
{
    types_t types = {.arena = scratch};
    collect(&types, objects);
    forget(&types);
    if (scratch->failed) {
        xml->failed = true;
        return;
    }
    cm1e_xml_open(xml, "Dictionary");
    cm1e_xml_open(xml, "DataTypes");
    for (size_t i = 0; i < types.base.count; i++) {
        cm1e_xml_open(xml, "DataType");
        cm1e_xml_put(xml, "Name", "%s", types.base.at[i].name);
        put_number(xml, "BitSize", types.base.at[i].bits);
        cm1e_xml_close(xml);
    }
    for (size_t i = 0; i < types.definitions.count; i++)
        put_definition(xml, scratch, types.definitions.at[i]);
    cm1e_xml_close(xml);
    cm1e_xml_open(xml, "Objects");
    for (size_t i = 0; i < objects->count; i++)
        put_object(xml, &types, &objects->at[i], types.of_objects.at[i]);
    cm1e_xml_close(xml);
    cm1e_xml_close(xml);
}
