#include "core/handle.h"

static uint8_t next_use(cm1e_handle_place_t *place)
{
    const uint8_t use = (uint8_t)(atomic_fetch_add(&place->uses, 1) + 1);
    return use ? use : (uint8_t)(atomic_fetch_add(&place->uses, 1) + 1); /* 0 is left to "no object" */
}

bool cm1e_handle_take(cm1e_handle_place_t *places, unsigned count, void *object, uint16_t *handle)
{
    for (unsigned i = 0; i < count; i++) {
        if (atomic_load(&places[i].object))
            continue;
        *handle = (uint16_t)((unsigned)next_use(&places[i]) << 8 | i);
        void *none = NULL;
        if (atomic_compare_exchange_strong(&places[i].object, &none, object))
            return true;
    }
    *handle = 0;
    return false;
}

void cm1e_handle_give_back(cm1e_handle_place_t *places, uint16_t handle)
{
    atomic_store(&places[handle & 0xFF].object, NULL);
}
