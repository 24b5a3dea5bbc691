/**
 * @file sii_text.h
 * An SII image as text and as JSON, for `cm1e sii decode`.
 */
#ifndef CM1E_TOOLS_SII_TEXT_H
#define CM1E_TOOLS_SII_TEXT_H

#include <jansson.h>

#include "description/check.h"
#include "description/description.h"

/** `size` is the number of bytes of the image; `findings` are its faults. */
void print_sii(const cm1e_description_t *device, size_t size, const cm1e_findings_t *findings);
json_t *sii_as_json(const cm1e_description_t *device, size_t size, const cm1e_findings_t *findings);

#endif
