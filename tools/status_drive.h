/**
 * @file status_drive.h
 * Reads a device that is one axis, for `cm1e status`.
 */
#ifndef CM1E_TOOLS_STATUS_DRIVE_H
#define CM1E_TOOLS_STATUS_DRIVE_H

#include <jansson.h>
#include <stdbool.h>

#include "cm1e/bus.h"
#include "device/devices.h"

enum { DRIVE_READINGS = 8, DRIVE_TEXT_BYTES = 320 };

/** One object: its value, or the reason why it is missing. A firmware may have another size than the guide. */
typedef struct reading {
    bool valid;
    double value;
    size_t bytes;
    cm1e_error_t error;
    uint32_t abort_code;
} reading_t;

typedef struct drive_status {
    const cm1e_device_drive_t *device; /**< NULL: the slave is not known */
    reading_t readings[DRIVE_READINGS];
} drive_status_t;

/** Returns false, with the reason in `diag`, if the statusword cannot be read. */
bool read_drive(cm1e_bus_t *bus, uint16_t position, drive_status_t *drive, cm1e_diag_t *diag);
/** The actual position in counts; NAN: it cannot be read. */
double drive_position(const drive_status_t *drive);
enum { DRIVE_POSITION = 3 };
/** Name of the n-th reading; for 0x603F "error", or "note" if the code is not an error. */
const char *drive_label(const drive_status_t *drive, int i);
/** Writes the value as text, or the reason why it cannot be read. Returns `text`. */
const char *drive_text(const drive_status_t *drive, int i, char *text, size_t size);
json_t *drive_status_as_json(const cm1e_slave_info_t *slave, const drive_status_t *drive);

#endif
