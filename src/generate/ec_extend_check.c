#include "generate/ec_extend.h"

void cm1e_ec_extend_check(cm1e_findings_t *findings, const cm1e_ec_extend_t *document)
{
    (void)findings, (void)document;
}

void cm1e_ec_extend_compare(cm1e_findings_t *findings, const cm1e_ec_extend_t *document,
                            const cm1e_description_t *device)
{
    (void)findings, (void)document, (void)device;
}
