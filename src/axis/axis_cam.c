/* Cams in the memory of their slave. */
#include "axis/axis_private.h"

cm1e_error_t cm1e_axis_cam_select(cm1e_axis_t *slave, const MC_CAM_REF *cam, bool periodic, bool master_absolute,
                                  bool slave_absolute, MC_CAM_ID *id)
{
    (void)slave, (void)cam, (void)periodic, (void)master_absolute, (void)slave_absolute;
    *id = 0;
    return CM1E_ERROR_UNSUPPORTED;
}
