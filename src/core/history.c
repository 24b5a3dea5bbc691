#include "core/history.h"

#include <stdbool.h>
#include <string.h>

/** Of a record; its first word is its number, or 0 while it is written. */
static size_t place_of(cm1e_history_shape_t shape, uint64_t number)
{
    return 1 + (size_t)(number % shape.records) * shape.words;
}

uint64_t cm1e_history_last(const uint64_t *ring) { return __atomic_load_n(&ring[0], __ATOMIC_ACQUIRE); }

void cm1e_history_go_on_after(uint64_t *ring, uint64_t last) { __atomic_store_n(&ring[0], last, __ATOMIC_RELAXED); }

/* Release and acquire at every word keep them between the two writes of the number, without fences. */
void cm1e_history_add(uint64_t *ring, cm1e_history_shape_t shape, const void *record)
{
    const uint64_t number = __atomic_load_n(&ring[0], __ATOMIC_RELAXED) + 1;
    uint64_t *place = ring + place_of(shape, number), word;
    __atomic_store_n(&place[0], 0, __ATOMIC_RELAXED);
    for (uint32_t i = 1; i < shape.words; i++) {
        memcpy(&word, (const char *)record + i * sizeof word, sizeof word);
        __atomic_store_n(&place[i], word, __ATOMIC_RELEASE);
    }
    __atomic_store_n(&place[0], number, __ATOMIC_RELEASE);
    __atomic_store_n(&ring[0], number, __ATOMIC_RELEASE);
}

/** false: the record has been overwritten meanwhile. */
static bool take(const uint64_t *place, cm1e_history_shape_t shape, uint64_t number, char *record)
{
    if (__atomic_load_n(&place[0], __ATOMIC_ACQUIRE) != number)
        return false;
    memcpy(record, &number, sizeof number);
    for (uint32_t i = 1; i < shape.words; i++) {
        const uint64_t word = __atomic_load_n(&place[i], __ATOMIC_ACQUIRE);
        memcpy(record + i * sizeof word, &word, sizeof word);
    }
    return __atomic_load_n(&place[0], __ATOMIC_RELAXED) == number;
}

size_t cm1e_history_copy(const uint64_t *ring, cm1e_history_shape_t shape, uint64_t after, void *records, size_t room,
                         uint64_t *lost)
{
    const size_t bytes = shape.words * sizeof(uint64_t);
    const uint64_t last = cm1e_history_last(ring);
    const uint64_t oldest = last > shape.records ? last - shape.records : 0;
    uint64_t missing = after < oldest ? oldest - after : 0;
    size_t count = 0;
    for (uint64_t number = after < last ? after + missing + 1 : last + 1; number <= last && count < room; number++) {
        if (take(ring + place_of(shape, number), shape, number, (char *)records + count * bytes)) {
            count++;
        } else {
            missing += 1 + count; /* only the oldest are overwritten: what was copied before them is not in a row */
            count = 0;
        }
    }
    if (lost)
        *lost = missing;
    return count;
}
