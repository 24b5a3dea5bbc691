#include "description/describe.h"

cm1e_error_t cm1e_describe_bridge(cm1e_description_file_t *file, const cm1e_device_options_t *options,
                                  cm1e_esi_layout_t layout, cm1e_diag_t *diag)
{
    (void)file, (void)options, (void)layout;
    return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "the bridge has no description yet");
}
