#include "sim/store.h"

#include <stdlib.h>
#include <string.h>

#include "core/bytes.h"
#include "sim/slave.h"

/* ---- the values ------------------------------------------------------------------------------------------------- */

static const cm1e_object_t *next_object(const cm1e_sim_store_t *store, const cm1e_device_t *device, size_t *n)
{
    const cm1e_object_t *object;
    while ((object = device->object(device, (*n)++)) != NULL && object->since > store->firmware)
        ;
    return object;
}

static void set_defaults(cm1e_sim_store_t *store)
{
    for (size_t i = 0; i < store->object_count; i++)
        /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): all objects were filled in */
        for (uint16_t k = 0; k < store->objects[i]->entry_count; k++)
            store->values[store->first_entry[i] + k] = store->objects[i]->entries[k].default_value;
}

bool cm1e_sim_store_create(cm1e_sim_store_t *store, const cm1e_device_t *device, cm1e_firmware_t firmware)
{
    const cm1e_object_t *object;
    uint32_t entries = 0;
    *store = (cm1e_sim_store_t){.firmware = firmware};
    for (size_t n = 0; (object = next_object(store, device, &n)) != NULL; store->object_count++)
        entries += object->entry_count;
    store->objects = calloc(store->object_count, sizeof *store->objects);
    store->first_entry = calloc(store->object_count, sizeof *store->first_entry);
    store->values = calloc(entries, sizeof *store->values);
    if (!store->objects || !store->first_entry || !store->values)
        return false;
    entries = 0;
    size_t i = 0;
    for (size_t n = 0; (object = next_object(store, device, &n)) != NULL; i++) {
        store->objects[i] = object;
        store->first_entry[i] = entries;
        entries += object->entry_count;
    }
    set_defaults(store);
    return true;
}

void cm1e_sim_store_destroy(cm1e_sim_store_t *store)
{
    free(store->objects);
    free(store->first_entry);
    free(store->values);
    free(store->own_objects);
    free(store->own_entries);
    *store = (cm1e_sim_store_t){0};
}

const cm1e_object_t *cm1e_sim_store_object(const cm1e_sim_store_t *store, size_t n)
{
    return n < store->object_count ? store->objects[n] : NULL;
}

static bool find_object(const cm1e_sim_store_t *store, uint16_t index, size_t *found)
{
    size_t low = 0, high = store->object_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (store->objects[middle]->index < index)
            low = middle + 1;
        else
            high = middle;
    }
    *found = low;
    return low < store->object_count && store->objects[low]->index == index;
}

uint32_t cm1e_sim_store_find(const cm1e_sim_store_t *store, uint16_t index, uint8_t subindex, cm1e_sim_cell_t *cell)
{
    size_t place;
    *cell = (cm1e_sim_cell_t){0};
    if (!find_object(store, index, &place))
        return SDO_ABORT_NO_OBJECT;
    const cm1e_object_t *object = store->objects[place];
    for (uint16_t k = 0; k < object->entry_count; k++) {
        const cm1e_entry_t *entry = &object->entries[k];
        if (entry->subindex == subindex && entry->since <= store->firmware) {
            *cell = (cm1e_sim_cell_t){entry, &store->values[store->first_entry[place] + k]};
            return 0;
        }
    }
    return SDO_ABORT_NO_SUBINDEX;
}

uint32_t cm1e_sim_store_find_readable(const cm1e_sim_store_t *store, uint16_t index, uint8_t subindex,
                                      cm1e_sim_cell_t *cell)
{
    const uint32_t missing = cm1e_sim_store_find(store, index, subindex, cell);
    if (missing)
        return missing;
    return cell->entry->access & CM1E_ACCESS_READ ? 0 : (uint32_t)SDO_ABORT_WRITE_ONLY;
}

void cm1e_sim_store_set(cm1e_sim_store_t *store, uint16_t index, uint8_t subindex, int64_t value)
{
    cm1e_sim_cell_t cell;
    if (cm1e_sim_store_find(store, index, subindex, &cell) == 0)
        *cell.value = value;
}

/* ---- on the wire ------------------------------------------------------------------------------------------------ */

static unsigned entry_bytes(const cm1e_entry_t *entry) { return (entry->bits + 7u) / 8u; }

bool cm1e_sim_is_signed(cm1e_data_type_t type)
{
    return type == CM1E_TYPE_SINT || type == CM1E_TYPE_INT || type == CM1E_TYPE_DINT;
}

uint32_t cm1e_sim_give_number(const cm1e_entry_t *entry, int64_t value, uint8_t *data, size_t *size)
{
    const unsigned bytes = entry_bytes(entry);
    if (*size < bytes)
        return SDO_ABORT_MEMORY;
    cm1e_put_uint(data, bytes, (uint64_t)value);
    *size = bytes;
    return 0;
}

uint32_t cm1e_sim_give_text(const char *text, uint8_t *data, size_t *size)
{
    const size_t length = strlen(text);
    if (*size < length)
        return SDO_ABORT_MEMORY;
    /* NOLINTNEXTLINE(bugprone-not-null-terminated-result): strings of CoE have no end 0 */
    memcpy(data, text, length);
    *size = length;
    return 0;
}

uint32_t cm1e_sim_check_write(const cm1e_entry_t *entry, uint8_t al_state, size_t size)
{
    enum { PRE_OPERATIONAL = 2 };
    if (!(entry->access & CM1E_ACCESS_WRITE))
        return SDO_ABORT_READ_ONLY;
    if (size > entry_bytes(entry))
        return SDO_ABORT_TOO_LONG;
    if (size < entry_bytes(entry))
        return SDO_ABORT_TOO_SHORT;
    if ((entry->access & CM1E_ACCESS_WRITE_PREOP_ONLY) && al_state != PRE_OPERATIONAL)
        return SDO_ABORT_STATE;
    return 0;
}

int64_t cm1e_sim_take_number(const cm1e_entry_t *entry, const uint8_t *data)
{
    const uint64_t value = cm1e_get_uint(data, entry_bytes(entry));
    if (!cm1e_sim_is_signed(entry->type))
        return (int64_t)value;
    const uint64_t sign = UINT64_C(1) << (entry->bits - 1);
    return (int64_t)((value ^ sign) - sign);
}

uint32_t cm1e_sim_check_range(const cm1e_entry_t *entry, int64_t value)
{
    return value > entry->maximum ? SDO_ABORT_TOO_HIGH : value < entry->minimum ? SDO_ABORT_TOO_LOW : 0;
}
