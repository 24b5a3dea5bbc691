#include "core/handle.h"

static uint8_t next_use(_Atomic uint8_t *uses)
{
    const uint8_t use = (uint8_t)(atomic_fetch_add(uses, 1) + 1);
    return use ? use : (uint8_t)(atomic_fetch_add(uses, 1) + 1); /* 0 is left to "no object" */
}

bool cm1e_handle_take(cm1e_handle_table_t *table, unsigned count, void *object, uint16_t *handle)
{
    for (unsigned i = 0; i < count; i++) {
        if (atomic_load(&table->objects[i]))
            continue;
        *handle = (uint16_t)((unsigned)next_use(&table->uses[i]) << 8 | i);
        void *none = NULL;
        if (atomic_compare_exchange_strong(&table->objects[i], &none, object))
            return true;
    }
    *handle = 0;
    return false;
}

void cm1e_handle_give_back(cm1e_handle_table_t *table, uint16_t handle)
{
    atomic_store(&table->objects[handle & 0xFF], NULL);
}
