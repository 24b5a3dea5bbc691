#include "generate/esi.h"

cm1e_error_t cm1e_esi_write(cm1e_file_t *out, const cm1e_description_file_t *file, cm1e_diag_t *diag)
{
    (void)out, (void)file;
    return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "not there yet");
}
