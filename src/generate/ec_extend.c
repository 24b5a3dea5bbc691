#include "generate/ec_extend.h"

void cm1e_ec_extend_free(cm1e_ec_extend_t *document)
{
    (void)document;
}

cm1e_error_t cm1e_ec_extend_read(cm1e_ec_extend_t *document, const void *bytes, size_t size, cm1e_diag_t *diag)
{
    (void)document, (void)bytes, (void)size;
    return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "not there yet");
}

cm1e_error_t cm1e_ec_extend_write(cm1e_file_t *out, const cm1e_ec_extend_t *document, cm1e_diag_t *diag)
{
    (void)out, (void)document;
    return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "not there yet");
}

cm1e_error_t cm1e_ec_extend_make(cm1e_ec_extend_t *document, const cm1e_generate_options_t *options,
                                 cm1e_diag_t *diag)
{
    (void)document, (void)options;
    return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "not there yet");
}

void cm1e_ec_extend_check(cm1e_findings_t *findings, const cm1e_ec_extend_t *document)
{
    (void)findings, (void)document;
}

void cm1e_ec_extend_compare(cm1e_findings_t *findings, const cm1e_ec_extend_t *document,
                            const cm1e_description_t *device)
{
    (void)findings, (void)document, (void)device;
}
