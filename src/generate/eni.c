#include "generate/eni.h"

void cm1e_eni_free(cm1e_eni_t *document)
{
    (void)document;
}

cm1e_error_t cm1e_eni_read(cm1e_eni_t *document, const void *bytes, size_t size, cm1e_diag_t *diag)
{
    (void)document, (void)bytes, (void)size;
    return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "not there yet");
}

cm1e_error_t cm1e_eni_write(cm1e_file_t *out, const cm1e_eni_t *document, cm1e_diag_t *diag)
{
    (void)out, (void)document;
    return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "not there yet");
}

cm1e_error_t cm1e_eni_make(cm1e_eni_t *document, const cm1e_eni_slave_t *slaves, size_t count, int64_t cycle_time_ns,
                           cm1e_diag_t *diag)
{
    (void)document, (void)slaves, (void)count, (void)cycle_time_ns;
    return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "not there yet");
}

void cm1e_eni_check(cm1e_findings_t *findings, const cm1e_eni_t *document)
{
    (void)findings, (void)document;
}

void cm1e_eni_compare(cm1e_findings_t *findings, const cm1e_eni_t *document, uint16_t position,
                      const cm1e_description_t *device)
{
    (void)findings, (void)document, (void)position, (void)device;
}
