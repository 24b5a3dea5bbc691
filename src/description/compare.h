/**
 * @file compare.h
 * Compares two descriptions of one device: that of a file, and that of the device itself.
 */
#ifndef CM1E_DESCRIPTION_COMPARE_H
#define CM1E_DESCRIPTION_COMPARE_H

#include "description/check.h"
#include "description/description.h"

/** Adds findings with the places of `file`, about everything that both sides state: identity, EEPROM, mailbox, sync
 *  managers, PDO mapping and assignment, dictionary (objects and sub-indexes on one side only, type, size, access,
 *  names). What one side does not state is no difference. */
void cm1e_compare(cm1e_findings_t *findings, const cm1e_description_t *file, const cm1e_description_t *device);

/** cm1e_compare() for a file with modules: `variants[0]` is the device with its default modules, the others are the
 *  alternatives. The first `compared` of them are compared; an item counts as missing in the file only if none of the
 *  `count` variants has it. */
void cm1e_compare_variants(cm1e_findings_t *findings, const cm1e_description_t *variants, size_t compared, size_t count,
                           const cm1e_description_t *device);

#endif
