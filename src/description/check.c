#include "description/check.h"

void cm1e_check_description(cm1e_findings_t *findings, const cm1e_description_file_t *file)
{
    (void)findings, (void)file;
}
