/**
 * @file describe.h
 * Descriptions of our own devices, made from the tables of src/device. Any thread.
 */
#ifndef CM1E_DESCRIPTION_DESCRIBE_H
#define CM1E_DESCRIPTION_DESCRIBE_H

#include "cm1e/generate.h"
#include "description/description.h"

/** Appends the device of the options to the file, in MDP layout its modules too. CM1E_ERROR_CONFIG: the options do not
 *  fit together. */
cm1e_error_t cm1e_describe(cm1e_description_file_t *file, const cm1e_device_options_t *options,
                           cm1e_esi_layout_t layout, cm1e_diag_t *diag);

/** Appends the plain I/O module of the simulator: no mailbox, 1 byte out and 1 byte in, vendor 0. */
void cm1e_describe_io_module(cm1e_description_file_t *file);

/* ---- private to this room: one model each, `options` already checked by cm1e_describe() --------------------------- */

cm1e_error_t cm1e_describe_cm1e(cm1e_description_file_t *file, const cm1e_device_options_t *options,
                                cm1e_esi_layout_t layout, cm1e_diag_t *diag);
cm1e_error_t cm1e_describe_bridge(cm1e_description_file_t *file, const cm1e_device_options_t *options,
                                  cm1e_esi_layout_t layout, cm1e_diag_t *diag);

/** An object of the device tables as a description has it; entries that the firmware does not have are left out. */
void cm1e_describe_object(cm1e_arena_t *arena, cm1e_object_list_t *list, const cm1e_object_t *object,
                          cm1e_firmware_t firmware);
/** A PDO of the device tables; names and types come from the objects that are already in `device`. */
cm1e_described_pdo_t *cm1e_describe_pdo(cm1e_arena_t *arena, cm1e_pdo_list_t *list, const cm1e_object_list_t *objects,
                                        const cm1e_pdo_t *pdo, bool transmit, int sync_manager);
/** Process data sync managers get the length of the PDOs that are assigned to them. */
void cm1e_describe_sync_managers(cm1e_arena_t *arena, cm1e_description_t *device,
                                 const cm1e_sync_manager_t managers[4], const cm1e_pdo_list_t *assigned);

#endif
