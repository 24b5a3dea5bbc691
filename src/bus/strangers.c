/* The devices on the wire that are none of the slaves: what any thread reads while the cycle changes it. */
#include <string.h>

#include "bus/bus_internal.h"

_Static_assert(sizeof(cm1e_stranger_t) % sizeof(uint64_t) == 0, "a stranger is whole words");

uint32_t cm1e_strangers_count(const cm1e_stranger_list_t *list)
{
    return __atomic_load_n(&list->count, __ATOMIC_ACQUIRE);
}

cm1e_stranger_t cm1e_strangers_at(const cm1e_stranger_list_t *list, uint32_t place)
{
    cm1e_stranger_t stranger;
    for (size_t i = 0; i < CM1E_STRANGER_WORDS; i++) {
        const uint64_t word = __atomic_load_n(&list->words[place][i], __ATOMIC_ACQUIRE);
        memcpy((char *)&stranger + i * sizeof word, &word, sizeof word);
    }
    return stranger;
}

static bool is_same(const cm1e_stranger_list_t *list, const cm1e_stranger_t *strangers, uint32_t count)
{
    for (uint32_t i = 0; i < count && list->count == count; i++) {
        const cm1e_stranger_t before = cm1e_strangers_at(list, i);
        if (memcmp(&before, &strangers[i], sizeof before) != 0)
            return false;
    }
    return list->count == count;
}

/* Release and acquire at every word keep them between the two changes of the version, without fences. */
bool cm1e_strangers_set(cm1e_stranger_list_t *list, const cm1e_stranger_t *strangers, uint32_t count)
{
    if (is_same(list, strangers, count))
        return false;
    const uint32_t version = list->version;
    __atomic_store_n(&list->version, version + 1, __ATOMIC_RELAXED);
    for (uint32_t n = 0; n < count; n++)
        for (size_t i = 0; i < CM1E_STRANGER_WORDS; i++) {
            uint64_t word;
            memcpy(&word, (const char *)&strangers[n] + i * sizeof word, sizeof word);
            __atomic_store_n(&list->words[n][i], word, __ATOMIC_RELEASE);
        }
    __atomic_store_n(&list->count, count, __ATOMIC_RELEASE);
    __atomic_store_n(&list->version, version + 2, __ATOMIC_RELEASE);
    return true;
}

/** A list that is changed again and again meanwhile is none: the next look shows it. The owner of the bus always gets
 *  it. */
size_t cm1e_bus_strangers(const cm1e_bus_t *bus, cm1e_stranger_t *strangers, size_t room)
{
    enum { TRIES = 100 };
    const cm1e_stranger_list_t *list = bus && strangers ? &bus->search.strangers : NULL;
    for (int tries = 0; list && tries < TRIES; tries++) {
        const uint32_t version = __atomic_load_n(&list->version, __ATOMIC_ACQUIRE);
        const uint32_t count = cm1e_strangers_count(list);
        const size_t copied = count < room ? count : room;
        for (uint32_t i = 0; i < copied; i++)
            strangers[i] = cm1e_strangers_at(list, i);
        if (version % 2 == 0 && __atomic_load_n(&list->version, __ATOMIC_RELAXED) == version)
            return copied;
    }
    return 0;
}
