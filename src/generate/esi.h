/**
 * @file esi.h
 * EtherCAT slave information (ETG.2000 V1.0.9 and later): reader and writer. What was written by us comes back from the
 * reader as it was described. Any thread.
 *
 * Where an ESI has no place of its own for what a description holds:
 * - file->comment is the comment before the root element; comments inside of it are the writer's own and not read.
 * - Comment of a sub-index, and of an object that has no sub-indexes, is "[unit] comment", "[unit]" or "comment", of
 *   the entry; of any other object it is the object's.
 * - Names of sub-indexes are unique in a type (the schema's key). A name that comes again is the DisplayName, and Name
 *   is "SubIndex 003", as it is where there is no name.
 * - Elements of an array type have no names but those. So an ARRAY whose elements have names, units or comments of
 *   their own is written as sub-indexes one by one, as a RECORD is: TwinCAT shows them then.
 * - Data types follow from the objects; what a file called them, its sizes and offsets, are not written again.
 * - No Eeprom where its configuration is not known (config_known): there is nothing then that a tool could write into
 *   a device. A file with ConfigData is taken to know it.
 */
#ifndef CM1E_GENERATE_ESI_H
#define CM1E_GENERATE_ESI_H

#include "cm1e/generate.h"
#include "description/description.h"

/** Appends the devices and modules of an ESI. CM1E_ERROR_FILE: `diag` says what is wrong in which line. */
cm1e_error_t cm1e_esi_read(cm1e_description_file_t *file, const void *bytes, size_t size, cm1e_diag_t *diag);

/** Writes all devices and modules of the file; flat or MDP as they were described. CM1E_ERROR_CONFIG: their vendors are
 *  not the same, which an ESI cannot say. */
cm1e_error_t cm1e_esi_write(cm1e_file_t *out, const cm1e_description_file_t *file, cm1e_diag_t *diag);

#endif
