/* A dictionary that is one table, in order of index. */
#include "device/device_rows.h"

const cm1e_object_t *cm1e_device_table_object(const cm1e_device_t *device, size_t n)
{
    size_t count;
    const cm1e_object_t *objects = device->objects(&count);
    return n < count ? &objects[n] : NULL;
}

const cm1e_entry_t *cm1e_device_table_entry(const cm1e_device_t *device, uint16_t index, uint8_t subindex)
{
    size_t count;
    const cm1e_object_t *objects = device->objects(&count);
    const cm1e_object_t *object = cm1e_object_find(objects, count, index);
    return object ? cm1e_object_entry(object, subindex) : NULL;
}

const cm1e_object_t *cm1e_object_find(const cm1e_object_t *objects, size_t count, uint16_t index)
{
    size_t low = 0, high = count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (objects[middle].index < index)
            low = middle + 1;
        else
            high = middle;
    }
    return low < count && objects[low].index == index ? &objects[low] : NULL;
}

const cm1e_entry_t *cm1e_object_entry(const cm1e_object_t *object, uint8_t subindex)
{
    for (uint16_t i = 0; i < object->entry_count; i++)
        if (object->entries[i].subindex == subindex)
            return &object->entries[i];
    return NULL;
}
