/**
 * @file file.h
 * What the public functions of this room share.
 */
#ifndef CM1E_GENERATE_FILE_H
#define CM1E_GENERATE_FILE_H

#include <stdio.h>
#include <string.h>

#include "cm1e/generate.h"
#include "description/description.h"
#include "generate/eni.h"

/** The SII image of a device of `described` as a file; a modular one with the modules that stand in it by default. */
cm1e_error_t cm1e_file_of_sii(cm1e_file_t *file, const cm1e_description_file_t *described, size_t device,
                              cm1e_diag_t *diag);
/** Warns where the configuration words of the device are not those of a real one. */
void cm1e_file_warn_of_eeprom(cm1e_file_t *file, const cm1e_description_t *device);
/** What is said of bytes of no known format; CM1E_ERROR_FILE. */
cm1e_error_t cm1e_file_not_recognised(cm1e_diag_t *diag);
/** The ENI of a network as a file. */
cm1e_error_t cm1e_file_of_eni(cm1e_file_t *file, const cm1e_eni_slave_t *slaves, size_t count, int64_t cycle_time_ns,
                              cm1e_diag_t *diag);

/** Room for the names of the four axes of a bridge. */
#define CM1E_SLAVE_NAME (CM1E_NAME_LENGTH * 4 + 8)
/** What a slave is called by its axes: "X", behind a bridge "left, right". */
static inline void cm1e_slave_name_add(char name[CM1E_SLAVE_NAME], const cm1e_axis_config_t *axis)
{
    const size_t length = strlen(name);
    snprintf(name + length, CM1E_SLAVE_NAME - length, "%s%s", length ? ", " : "", axis->name);
}

#endif
