/**
 * @file info_answer.h
 * Parses answers of the SDO information service (ETG.1000.6 5.6.3). Pure functions; no length or value in an answer is
 * trusted.
 */
#ifndef CM1E_BUS_INFO_ANSWER_H
#define CM1E_BUS_INFO_ANSWER_H

#include "cm1e/sdo_info.h"

/** Values that can be asked for (ETG.1000.6 table 49). */
enum { INFO_VALUE_UNIT = 0x08, INFO_VALUE_DEFAULT = 0x10, INFO_VALUE_MINIMUM = 0x20, INFO_VALUE_MAXIMUM = 0x40 };

/** Returns false if the answer is shorter than its contents require. */
bool cm1e_info_take_list(uint16_t *indexes, size_t room, size_t *count, const uint8_t *answer, size_t size);
bool cm1e_info_take_object(cm1e_object_info_t *info, const uint8_t *answer, size_t size);
bool cm1e_info_take_entry(cm1e_entry_info_t *info, const uint8_t *answer, size_t size);

#endif
