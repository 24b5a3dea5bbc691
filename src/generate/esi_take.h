/**
 * @file esi_take.h
 * What a slave of the bus file takes from an ESI: identity, PDOs that are assigned by default, names and types of their
 * entries, start-up commands, pulses of its clock. What the bus file states itself stays.
 */
#ifndef CM1E_GENERATE_ESI_TAKE_H
#define CM1E_GENERATE_ESI_TAKE_H

#include "cm1e/config.h"
#include "description/description.h"

/** Takes it from an ESI in memory. `mode`: name of the OpMode whose pulses are taken, "": none. CM1E_ERROR_FILE: it
 *  cannot be read; CM1E_ERROR_NOT_FOUND: it does not describe this device, or has no such mode; CM1E_ERROR_UNSUPPORTED:
 *  a start-up command cannot be sent. @rt init */
cm1e_error_t cm1e_esi_take(cm1e_slave_config_t *slave, const void *bytes, size_t size, const char *mode,
                           int64_t cycle_time_ns, cm1e_diag_t *diag);
/** The device of the ESI that the slave names, with its modules by default. It points into the arena of `file`. Errors
 *  as above, and CM1E_ERROR_IO. @rt init */
cm1e_error_t cm1e_esi_device(cm1e_description_file_t *file, cm1e_description_t *device,
                             const cm1e_slave_config_t *slave, cm1e_diag_t *diag);
/** Makes it the reader of bus files (config/esi_reader.h). The target cm1e::generate has the linker ask for it. */
void cm1e_generate_register(void);

#endif
