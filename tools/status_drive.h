/**
 * @file status_drive.h
 * What `cm1e status` reads and says of a CM1-E.
 */
#ifndef CM1E_TOOLS_STATUS_DRIVE_H
#define CM1E_TOOLS_STATUS_DRIVE_H

#include <jansson.h>
#include <stdbool.h>

#include "cm1e/bus.h"

enum { DRIVE_READINGS = 8, DRIVE_TEXT_BYTES = 320 };

/** One object: its value, or why there is none. A firmware may have it in another size than the guide. */
typedef struct reading {
    bool valid;
    double value;
    size_t bytes;
    cm1e_error_t error;
    uint32_t abort_code;
} reading_t;

typedef struct drive_status {
    reading_t readings[DRIVE_READINGS];
} drive_status_t;

/** FALSE, with the reason in `diag`: the statusword cannot be read. */
bool read_drive(cm1e_bus_t *bus, uint16_t position, drive_status_t *drive, cm1e_diag_t *diag);
/** What the n-th reading is about; of 0x603F "error", or "note" where its code is no error. */
const char *drive_label(const drive_status_t *drive, int i);
/** Its value in words, or why it cannot be read; `text`. */
const char *drive_text(const drive_status_t *drive, int i, char *text, size_t size);
json_t *drive_status_as_json(const cm1e_slave_info_t *slave, const drive_status_t *drive);

#endif
