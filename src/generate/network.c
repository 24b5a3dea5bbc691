#include "generate/file.h"

cm1e_error_t cm1e_generate_eni_of_bus(cm1e_file_t *file, cm1e_bus_t *bus, cm1e_mapping_t mapping, cm1e_diag_t *diag)
{
    *file = (cm1e_file_t){0};
    (void)bus, (void)mapping;
    return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "not there yet");
}
