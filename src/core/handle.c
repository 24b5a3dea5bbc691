#include "core/handle.h"

/** Of the free places the one with the fewest uses; `count`: there is none. */
static unsigned least_used(cm1e_handle_table_t *table, unsigned count)
{
    unsigned best = count;
    for (unsigned i = 0; i < count; i++)
        if (!atomic_load(&table->objects[i]) &&
            (best == count || atomic_load(&table->uses[i]) < atomic_load(&table->uses[best])))
            best = i;
    return best;
}

bool cm1e_handle_take(cm1e_handle_table_t *table, unsigned count, void *object, uint16_t *handle)
{
    for (unsigned i = least_used(table, count); i < count; i = least_used(table, count)) {
        const unsigned use = 1 + atomic_fetch_add(&table->uses[i], 1) % CM1E_HANDLE_USES; /* 0 is left to "no object" */
        *handle = (uint16_t)(use << CM1E_HANDLE_PLACE_BITS | i);
        void *none = NULL;
        if (atomic_compare_exchange_strong(&table->objects[i], &none, object))
            return true;
    }
    *handle = 0;
    return false;
}

void cm1e_handle_give_back(cm1e_handle_table_t *table, uint16_t handle)
{
    atomic_store(&table->objects[cm1e_handle_place(handle)], NULL);
}
