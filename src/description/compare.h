/**
 * @file compare.h
 * Two descriptions of one device beside each other: what a file says, and what the device says of itself.
 */
#ifndef CM1E_DESCRIPTION_COMPARE_H
#define CM1E_DESCRIPTION_COMPARE_H

#include "description/check.h"
#include "description/description.h"

/** Findings with the places of `file`, about everything that both sides speak of: identity, EEPROM, mailbox, sync
 *  managers, PDO mapping and assignment, dictionary (objects and sub-indexes on one side only, type, size, access,
 *  names). What one side does not state is no difference. */
void cm1e_compare(cm1e_findings_t *findings, const cm1e_description_t *file, const cm1e_description_t *device);

/** The same for a file that offers modules: `variants[0]` is the device with those that stand in its slots when nobody
 *  chooses, the others with those that can stand there. The first `compared` of them are compared; that something is
 *  missing in the file is said only if it is in none of the `count`. */
void cm1e_compare_variants(cm1e_findings_t *findings, const cm1e_description_t *variants, size_t compared, size_t count,
                           const cm1e_description_t *device);

#endif
