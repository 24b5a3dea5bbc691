#include "description/compare.h"

void cm1e_compare(cm1e_findings_t *findings, const cm1e_description_t *file, const cm1e_description_t *device)
{
    if (file->vendor_id != device->vendor_id)
        cm1e_findings_add(findings, CM1E_RULE_DIFFERS, file->identity_place,
                          "the vendor is 0x%08X in the file, 0x%08X in the device", (unsigned)file->vendor_id,
                          (unsigned)device->vendor_id);
}
