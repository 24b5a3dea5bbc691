/**
 * @file esi.h
 * EtherCAT slave information (ETG.2000 V1.0.9 and later): reader and writer. What was written by us comes back from the
 * reader as it was described. Any thread.
 */
#ifndef CM1E_GENERATE_ESI_H
#define CM1E_GENERATE_ESI_H

#include "cm1e/generate.h"
#include "description/description.h"

/** Appends the devices and modules of an ESI. CM1E_ERROR_FILE: `diag` says what is wrong in which line. */
cm1e_error_t cm1e_esi_read(cm1e_description_file_t *file, const void *bytes, size_t size, cm1e_diag_t *diag);

/** Writes all devices and modules of the file; flat or MDP as they were described. */
cm1e_error_t cm1e_esi_write(cm1e_file_t *out, const cm1e_description_file_t *file, cm1e_diag_t *diag);

#endif
