/**
 * @file sii_device.h
 * The SII of a live slave for the commands that read and write it.
 */
#ifndef CM1E_TOOLS_SII_DEVICE_H
#define CM1E_TOOLS_SII_DEVICE_H

#include "cm1e/sii.h"
#include "files.h"

/** The whole SII; the caller frees it. False: `diag` says why. */
bool read_device(cm1e_bus_t *bus, uint16_t position, input_t *image, cm1e_diag_t *diag);

/** Writes an image. The present one goes to the file `backup` before, which must not exist; it is removed if nothing
 *  was written. Returns the exit status, with a complaint. */
int write_device(cm1e_bus_t *bus, uint16_t position, const input_t *image, const input_t *present, const char *backup,
                 const cm1e_sii_write_options_t *options);

#endif
