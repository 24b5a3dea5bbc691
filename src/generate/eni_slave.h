/**
 * @file eni_slave.h
 * Slaves without an axis in an ENI: described by the ESI or the simulated device that the bus file names, or by the
 * live device, and configured as the bus file says. So another master writes what the bus of this library writes.
 */
#ifndef CM1E_GENERATE_ENI_SLAVE_H
#define CM1E_GENERATE_ENI_SLAVE_H

#include "cm1e/config.h"
#include "description/description.h"

/** Appends the device of a slave to the file. CM1E_ERROR_UNSUPPORTED: the bus file does not say what it is. */
cm1e_error_t cm1e_eni_describe_slave(cm1e_description_file_t *file, const cm1e_slave_config_t *slave, bool simulated,
                                     cm1e_diag_t *diag);
/** Gives the last device of the file the PDOs, the names and the start-up commands of the bus file. CM1E_ERROR_CONFIG:
 *  the device does not have what they need. */
cm1e_error_t cm1e_eni_configure_slave(cm1e_description_file_t *file, const cm1e_slave_config_t *slave,
                                      cm1e_diag_t *diag);
/** Writes how a device with pulses is synchronised: `type` to 0x1C32:01 (`inputs`: 0x1C33:01), where it can be written
 *  and the bus file (`slave`, NULL: none) does not write it. */
void cm1e_eni_synchronise(cm1e_arena_t *arena, cm1e_description_t *device, const cm1e_slave_config_t *slave,
                          bool inputs, unsigned type);
/** Writes the mode of operation of a servo drive whose process data do not have it: CSP, or CSV without target
 *  position. */
void cm1e_eni_start_mode(cm1e_arena_t *arena, cm1e_description_t *device);

#endif
