#include "generate/esi.h"

cm1e_error_t cm1e_esi_read(cm1e_description_file_t *file, const void *bytes, size_t size, cm1e_diag_t *diag)
{
    (void)file, (void)bytes, (void)size;
    return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "not there yet");
}
