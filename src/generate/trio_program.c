#include "cm1e/generate.h"

cm1e_error_t cm1e_generate_trio_program(cm1e_file_t *file, const cm1e_generate_options_t *options, cm1e_diag_t *diag)
{
    *file = (cm1e_file_t){0};
    (void)options;
    return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "not there yet");
}
