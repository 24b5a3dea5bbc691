#include "axis/axis_handle.h"
#include "axis/axis_parts.h"

cm1e_handle_table_t cm1e_axis_places;

cm1e_error_t cm1e_axis_publish(cm1e_axis_t *axis, cm1e_diag_t *diag)
{
    if (cm1e_handle_take(&cm1e_axis_places, CM1E_AXIS_HANDLES, axis, &axis->handle))
        return CM1E_OK;
    return cm1e_diag_set(diag, CM1E_ERROR_FULL, 0, "There are already %d axes in this process.", CM1E_AXIS_HANDLES);
}

cm1e_axis_t *cm1e_axis_from_reference(const AXIS_REF_t *reference)
{
    return reference ? cm1e_axis_from_handle(reference->Handle) : NULL;
}

cm1e_error_t cm1e_axis_write_encoder(AXIS_REF_t reference, uint32_t counts, bool valid)
{
    cm1e_axis_t *axis = cm1e_axis_from_reference(&reference);
    if (!axis)
        return CM1E_ERROR_FB_AXIS_REF;
    if (axis->config->type != CM1E_AXIS_ENCODER || axis->config->wiring.encoder[0])
        return CM1E_ERROR_UNSUPPORTED;
    axis->drive.encoder = (cm1e_drive_encoder_t){.counts = counts, .valid = valid};
    return CM1E_OK;
}

const char *cm1e_axis_name(AXIS_REF_t reference)
{
    const cm1e_axis_t *axis = cm1e_axis_from_reference(&reference);
    return axis ? axis->config->name : "";
}
