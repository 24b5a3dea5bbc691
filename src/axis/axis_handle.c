#include "axis/axis_handle.h"
#include "axis/axis_parts.h"

_Atomic(cm1e_axis_t *) cm1e_axis_table[CM1E_AXIS_HANDLES];
static _Atomic uint8_t uses[CM1E_AXIS_HANDLES];

bool cm1e_axis_handle_take(cm1e_axis_t *axis, uint16_t *handle)
{
    for (unsigned i = 0; i < CM1E_AXIS_HANDLES; i++) {
        cm1e_axis_t *none = NULL;
        if (atomic_load(&cm1e_axis_table[i]) || !atomic_compare_exchange_strong(&cm1e_axis_table[i], &none, axis))
            continue;
        uint8_t use = (uint8_t)(atomic_fetch_add(&uses[i], 1) + 1);
        if (use == 0) /* 0 is left to "no axis" */
            use = (uint8_t)(atomic_fetch_add(&uses[i], 1) + 1);
        *handle = (uint16_t)(use << 8 | i);
        return true;
    }
    return false;
}

void cm1e_axis_handle_give_back(uint16_t handle) { atomic_store(&cm1e_axis_table[handle & 0xFF], NULL); }

cm1e_axis_t *cm1e_axis_from_reference(const AXIS_REF_t *reference)
{
    return reference ? cm1e_axis_from_handle(reference->Handle) : NULL;
}

cm1e_error_t cm1e_axis_write_encoder(AXIS_REF_t reference, uint32_t counts, bool valid)
{
    cm1e_axis_t *axis = cm1e_axis_from_reference(&reference);
    if (!axis)
        return CM1E_ERROR_FB_AXIS_REF;
    if (axis->config->type != CM1E_AXIS_ENCODER)
        return CM1E_ERROR_UNSUPPORTED;
    axis->drive.encoder = (cm1e_drive_encoder_t){.counts = counts, .valid = valid};
    return CM1E_OK;
}

const char *cm1e_axis_name(AXIS_REF_t reference)
{
    const cm1e_axis_t *axis = cm1e_axis_from_reference(&reference);
    return axis ? axis->config->name : "";
}
