#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "description/check_private.h"

/* Type definitions of an ESI (ETG.2000, DataTypes): sizes, offsets and names that have to fit together. */

/* ---- by name ----------------------------------------------------------------------------------------------------- */

static const char *text_of(const char *text) { return text ? text : ""; }

static int by_name(const void *left, const void *right)
{
    const cm1e_type_definition_t *const *a = left, *const *b = right;
    const int order = strcmp(text_of((*a)->name), text_of((*b)->name));
    return order != 0 ? order : (*a > *b) - (*a < *b);
}

cm1e_check_sorted_types_t cm1e_check_sort_types(const cm1e_check_t *check, const cm1e_type_list_t *types)
{
    cm1e_check_sorted_types_t sorted = {0};
    if (types->count == 0 || types->count > CM1E_ARENA_LIMIT / sizeof *sorted.at)
        return sorted;
    const cm1e_type_definition_t **at = cm1e_arena_take(check->arena, types->count * sizeof *at);
    if (check->arena->failed)
        return sorted;
    for (size_t i = 0; i < types->count; i++)
        at[i] = &types->at[i];
    qsort(at, types->count, sizeof *at, by_name);
    sorted.at = at;
    sorted.count = types->count;
    return sorted;
}

static const cm1e_type_definition_t *find_in(const cm1e_check_sorted_types_t *types, const char *name)
{
    size_t low = 0, high = types->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (strcmp(text_of(types->at[middle]->name), name) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return low < types->count && strcmp(text_of(types->at[low]->name), name) == 0 ? types->at[low] : NULL;
}

/* Bits of a type by name: a base type, or a definition. -1: there is no such type; 0: known, but not its size. */
static int64_t bits_of(const cm1e_check_types_t *types, const char *name)
{
    const cm1e_type_definition_t *definition = find_in(&types->own, name);
    if (!definition)
        definition = find_in(&types->common, name);
    const uint32_t base = cm1e_type_bits(name);
    if (base > 0)
        return base;
    if (definition)
        return definition->bits;
    return cm1e_type_code(name) != 0 ? 0 : -1;
}

/* "ARRAY [0..3] OF BYTE" and their like say what they are by their name. */
static bool explains_itself(const char *name)
{
    return name[0] == '\0' || strncmp(name, "ARRAY ", 6) == 0 || strncmp(name, "ARRAY[", 6) == 0;
}

static void unknown_type(const cm1e_check_t *check, cm1e_place_t place, const char *name, const char *user)
{
    if (!explains_itself(name))
        cm1e_check_add(check, CM1E_RULE_TYPE_UNKNOWN, place,
                       "%s is of the type %s, which is neither defined in the dictionary nor a base type", user, name);
}

/* ---- one definition ---------------------------------------------------------------------------------------------- */

static void check_base_type(const cm1e_check_t *check, const cm1e_type_definition_t *type)
{
    const uint32_t bits = cm1e_type_bits(text_of(type->name));
    if (bits > 0 && type->bits != bits)
        cm1e_check_add(check, CM1E_RULE_TYPE_SIZE, type->place, "the type %s is defined with %lld bits; it has %u",
                       type->name, (long long)type->bits, (unsigned)bits);
}

/* Arrays of bits may fill their last byte. */
static bool is_array_size(int64_t bits, int64_t needed) { return bits == needed || bits == (needed + 7) / 8 * 8; }

static void check_array(const cm1e_check_t *check, const cm1e_type_definition_t *type, const cm1e_check_types_t *types)
{
    const int64_t element = bits_of(types, text_of(type->base_type));
    if (element < 0)
        unknown_type(check, type->place, text_of(type->base_type), text_of(type->name));
    else if (element > 0 && type->elements >= 0 && type->elements <= INT32_MAX && element <= INT32_MAX &&
             !is_array_size(type->bits, type->elements * element))
        cm1e_check_add(check, CM1E_RULE_TYPE_SIZE, type->place,
                       "the array type %s has %lld bits; its %lld elements of type %s with %lld bits make %lld",
                       type->name, (long long)type->bits, (long long)type->elements, type->base_type,
                       (long long)element, (long long)(type->elements * element));
}

/* Another name for a type, or an enumeration, which needs no more bits than its values. */
static void check_alias(const cm1e_check_t *check, const cm1e_type_definition_t *type, const cm1e_check_types_t *types)
{
    const int64_t base = bits_of(types, text_of(type->base_type));
    if (base < 0)
        unknown_type(check, type->place, text_of(type->base_type), text_of(type->name));
    else if (base > 0 && type->bits > base)
        cm1e_check_add(check, CM1E_RULE_TYPE_SIZE, type->place,
                       "the type %s has %lld bits; its base type %s has only %lld", type->name, (long long)type->bits,
                       type->base_type, (long long)base);
}

static int by_offset(const void *left, const void *right)
{
    const cm1e_type_item_t *const *a = left, *const *b = right;
    if ((*a)->offset != (*b)->offset)
        return (*a)->offset < (*b)->offset ? -1 : 1;
    return (*a > *b) - (*a < *b);
}

static const char *name_of(const cm1e_type_item_t *item) { return text_of(item->name); }

/* Items must be in order, must not overlap, and must not exceed the end. Gaps are usual: behind sub-index 0, before
 * words, in place of sub-indexes that a device does not have. */
static void check_layout(const cm1e_check_t *check, const cm1e_type_definition_t *type)
{
    const size_t count = type->items.count;
    if (count == 0 || count > CM1E_ARENA_LIMIT / sizeof(void *))
        return;
    const cm1e_type_item_t **items = cm1e_arena_take(check->arena, count * sizeof *items);
    if (check->arena->failed)
        return;
    for (size_t i = 0; i < count; i++)
        items[i] = &type->items.at[i];
    qsort(items, count, sizeof *items, by_offset);
    int64_t end = 0;
    const cm1e_type_item_t *last = NULL;
    for (size_t i = 0; i < count; i++) {
        const cm1e_type_item_t *item = items[i];
        const bool absurd = item->bits < 0 || item->bits > INT32_MAX || item->offset < 0 || item->offset > INT32_MAX;
        if (absurd || item->offset + item->bits > type->bits)
            cm1e_check_add(check, CM1E_RULE_TYPE_ITEM_OFFSET, item->place,
                           "%s in the type %s begins at bit %lld and has %lld bits; the type ends behind %lld bits",
                           name_of(item), type->name, (long long)item->offset, (long long)item->bits,
                           (long long)type->bits);
        else if (item->offset < end && item->bits > 0)
            cm1e_check_add(check, CM1E_RULE_TYPE_ITEM_OFFSET, item->place,
                           "%s in the type %s begins at bit %lld, within %s, which ends before bit %lld",
                           name_of(item), type->name, (long long)item->offset, name_of(last), (long long)end);
        if (!absurd && item->offset + item->bits > end) {
            end = item->offset + item->bits;
            last = item;
        }
    }
}

static void check_item(const cm1e_check_t *check, const cm1e_type_definition_t *type, const cm1e_type_item_t *item,
                       const cm1e_check_types_t *types)
{
    const int64_t bits = bits_of(types, text_of(item->type));
    if (bits < 0)
        unknown_type(check, item->place, text_of(item->type), name_of(item));
    else if (bits > 0 && item->bits != bits)
        cm1e_check_add(check, CM1E_RULE_TYPE_ITEM_SIZE, item->place,
                       "%s in the type %s has %lld bits; its type %s has %lld", name_of(item), type->name,
                       (long long)item->bits, item->type, (long long)bits);
}

static void check_record(const cm1e_check_t *check, const cm1e_type_definition_t *type, const cm1e_check_types_t *types)
{
    bool seen[256] = {false};
    for (size_t i = 0; i < type->items.count; i++) {
        const cm1e_type_item_t *item = &type->items.at[i];
        check_item(check, type, item, types);
        if (item->has_subindex && seen[item->subindex])
            cm1e_check_add(check, CM1E_RULE_SUBINDEX_TWICE, item->place, "the type %s has sub-index %u twice",
                           type->name, item->subindex);
        if (item->has_subindex)
            seen[item->subindex] = true;
    }
    check_layout(check, type);
}

/* ---- loops ------------------------------------------------------------------------------------------------------- */

typedef enum visit { NEW = 0, OPEN, DONE } visit_t;
typedef struct step {
    const cm1e_type_definition_t *type;
    size_t next; /* item to follow; the number of items: the base type */
} step_t;

static size_t number_of(const cm1e_check_sorted_types_t *types, const char *name)
{
    const cm1e_type_definition_t *found = find_in(types, name);
    size_t low = 0, high = types->count;
    while (found && low < high) {
        const size_t middle = low + (high - low) / 2;
        if (by_name(&types->at[middle], &found) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return found ? low : SIZE_MAX;
}

/* Follows the members of a type with its own stack, because the file decides the depth. */
static void follow(const cm1e_check_t *check, const cm1e_check_sorted_types_t *types, uint8_t *visits, step_t *stack,
                   size_t first)
{
    size_t depth = 0;
    stack[depth++] = (step_t){types->at[first], 0};
    visits[first] = OPEN;
    while (depth > 0) {
        step_t *top = &stack[depth - 1];
        const size_t items = top->type->items.count;
        if (top->next > items) {
            visits[number_of(types, text_of(top->type->name))] = DONE;
            depth--;
            continue;
        }
        const char *name = top->next < items ? top->type->items.at[top->next].type : top->type->base_type;
        const cm1e_place_t place = top->next < items ? top->type->items.at[top->next].place : top->type->place;
        top->next++;
        const size_t to = name && strcmp(name, text_of(top->type->name)) != 0 ? number_of(types, name) : SIZE_MAX;
        const bool itself = name && strcmp(name, text_of(top->type->name)) == 0 && cm1e_type_code(name) == 0;
        if (itself || (to != SIZE_MAX && visits[to] == OPEN))
            cm1e_check_add(check, CM1E_RULE_TYPE_LOOP, place, "the type %s is made of the type %s, which is made of it",
                           top->type->name, name);
        else if (to != SIZE_MAX && visits[to] == NEW) {
            visits[to] = OPEN;
            stack[depth++] = (step_t){types->at[to], 0};
        }
    }
}

static void check_loops(const cm1e_check_t *check, const cm1e_check_sorted_types_t *types)
{
    if (types->count == 0 || types->count > CM1E_ARENA_LIMIT / sizeof(step_t))
        return;
    uint8_t *visits = cm1e_arena_take(check->arena, types->count);
    step_t *stack = cm1e_arena_take(check->arena, types->count * sizeof *stack);
    for (size_t i = 0; i < types->count && !check->arena->failed; i++) {
        /* Of two types with one name the first counts, as in every search. */
        if (visits[i] == NEW && (i == 0 || strcmp(text_of(types->at[i]->name), text_of(types->at[i - 1]->name)) != 0))
            follow(check, types, visits, stack, i);
    }
}

/* ---- all --------------------------------------------------------------------------------------------------------- */

void cm1e_check_types(const cm1e_check_t *check, const cm1e_type_list_t *types, const cm1e_check_types_t *known)
{
    for (size_t i = 0; i < types->count; i++) {
        const cm1e_type_definition_t *type = &types->at[i];
        if (cm1e_type_code(text_of(type->name)) != 0)
            check_base_type(check, type);
        else if (type->is_array)
            check_array(check, type, known);
        else if (type->items.count > 0)
            check_record(check, type, known);
        else if (type->base_type && type->base_type[0] != '\0')
            check_alias(check, type, known);
    }
    for (size_t i = 1; i < known->own.count; i++)
        if (strcmp(text_of(known->own.at[i]->name), text_of(known->own.at[i - 1]->name)) == 0)
            cm1e_check_add(check, CM1E_RULE_TYPE_TWICE, known->own.at[i]->place, "the type %s is defined twice",
                           text_of(known->own.at[i]->name));
    check_loops(check, &known->own);
}

void cm1e_check_object_type(const cm1e_check_t *check, const cm1e_described_object_t *object,
                            const cm1e_check_types_t *types)
{
    char user[16];
    snprintf(user, sizeof user, "0x%04X", object->index);
    const int64_t bits = bits_of(types, object->type);
    if (bits < 0)
        unknown_type(check, object->place, object->type, user);
    else if (bits > 0 && object->bits > 0 && object->bits != bits)
        cm1e_check_add(check, CM1E_RULE_OBJECT_SIZE, object->place, "0x%04X has %u bits; its type %s has %lld",
                       object->index, (unsigned)object->bits, object->type, (long long)bits);
}

void cm1e_check_pdo_types(const cm1e_check_t *check, const cm1e_pdo_list_t *pdos, const cm1e_check_types_t *types)
{
    for (size_t i = 0; i < pdos->count; i++)
        for (size_t j = 0; j < pdos->at[i].entries.count; j++) {
            const cm1e_described_pdo_entry_t *entry = &pdos->at[i].entries.at[j];
            char user[48];
            snprintf(user, sizeof user, "0x%04X:%02X in %s 0x%04X", entry->index, entry->subindex,
                     cm1e_pdo_kind(&pdos->at[i]), pdos->at[i].index);
            if (entry->index != 0 && entry->type && bits_of(types, entry->type) < 0)
                unknown_type(check, entry->place, entry->type, user);
        }
}
