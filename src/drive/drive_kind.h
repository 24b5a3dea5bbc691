/**
 * @file drive_kind.h
 * The code that one kind of device needs in addition to its table (device/devices.h), at start-up and in every cycle.
 * The other sources of this room use the table and name no device, except those whose names say so.
 */
#ifndef CM1E_DRIVE_DRIVE_KIND_H
#define CM1E_DRIVE_DRIVE_KIND_H

#include "device/devices.h"
#include "drive/drive_bridge.h"

typedef struct cm1e_drive_kind {
    const char *device;             /**< the kind of the device */
    cm1e_error_t (*init)(cm1e_drive_t *drive, cm1e_diag_t *diag); /**< what the configuration has to state */
    void (*step)(cm1e_drive_t *drive); /**< in every cycle, after the inputs; NULL: nothing */
    /** The device was absent at the start and has come: what init() could not know. In the cycle; NULL: nothing. */
    cm1e_error_t (*bind)(cm1e_drive_t *drive);
} cm1e_drive_kind_t;

/** NULL: no such device. */
const cm1e_drive_kind_t *cm1e_drive_kind(const cm1e_device_t *device);

#endif
