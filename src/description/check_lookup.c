/* What the rules of the cross-checker share: adding a finding, and searching what a file may have many of. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "description/check_private.h"

void cm1e_check_add(const cm1e_check_t *check, cm1e_rule_t rule, cm1e_place_t place, const char *format, ...)
{
    char text[1024];
    if (check->findings->list.count >= CM1E_FINDINGS_MAX ||
        (check->is_modular && cm1e_findings_has(check->findings, rule, place)))
        return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    cm1e_findings_add(check->findings, rule, place, "%s", text);
}

static int by_number(const void *left, const void *right)
{
    const cm1e_check_key_t *a = left, *b = right;
    return a->number != b->number ? (a->number < b->number ? -1 : 1) : (a->order > b->order) - (a->order < b->order);
}

void cm1e_check_sort(void *items, size_t count, size_t item_size)
{
    if (count > 0)
        qsort(items, count, item_size, by_number);
}

size_t cm1e_check_first(const void *items, size_t count, size_t item_size, uint32_t number)
{
    const uint8_t *bytes = items;
    size_t low = 0, high = count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (((const cm1e_check_key_t *)(const void *)(bytes + middle * item_size))->number < number)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Order of the first of an index; -1: there is none. */
static ptrdiff_t find_index(const cm1e_check_key_t *keys, size_t count, uint16_t index)
{
    const size_t found = cm1e_check_first(keys, count, sizeof *keys, index);
    return found < count && keys[found].number == index ? (ptrdiff_t)keys[found].order : -1;
}

const cm1e_check_entry_t *cm1e_check_find_entry(const cm1e_check_t *check, uint16_t index, uint8_t subindex)
{
    const uint32_t key = (uint32_t)index << 8 | subindex;
    /* The last of several: that of a module replaces that of the device. */
    const size_t behind = cm1e_check_first(check->entries, check->entry_count, sizeof *check->entries, key + 1);
    return behind > 0 && check->entries[behind - 1].key.number == key ? &check->entries[behind - 1] : NULL;
}

const cm1e_described_object_t *cm1e_check_find_object(const cm1e_check_t *check, uint16_t index)
{
    const ptrdiff_t found = find_index(check->objects, check->device->objects.count, index);
    return found >= 0 ? &check->device->objects.at[found] : NULL;
}

const cm1e_described_pdo_t *cm1e_check_find_pdo(const cm1e_check_t *check, uint16_t index)
{
    const ptrdiff_t found = find_index(check->pdos, check->device->pdos.count, index);
    return found >= 0 ? &check->device->pdos.at[found] : NULL;
}

const cm1e_described_pdo_t *cm1e_check_only_pdo(const cm1e_check_t *check, uint16_t index)
{
    const size_t count = check->device->pdos.count;
    const size_t found = cm1e_check_first(check->pdos, count, sizeof *check->pdos, index);
    if (found + 1 < count && check->pdos[found + 1].number == index)
        return NULL;
    return cm1e_check_find_pdo(check, index);
}

bool cm1e_check_default(const cm1e_check_t *check, uint16_t index, uint8_t subindex, uint32_t *value,
                        cm1e_place_t *place)
{
    const cm1e_check_entry_t *found = cm1e_check_find_entry(check, index, subindex);
    if (!found || found->entry->default_data.size == 0)
        return false;
    *value = (uint32_t)cm1e_bytes_unsigned(found->entry->default_data);
    *place = found->entry->place ? found->entry->place : found->object->place;
    return true;
}
