/**
 * @file firmware_update.h
 * A new firmware for one slave: FoE (ETG.1000.6 section 5.8) in the state Bootstrap (UG 4.3, 10.1). Blocking, before
 * the bus is configured. The slave needs no valid firmware for it, and the bus no scan.
 */
#ifndef CM1E_BUS_FIRMWARE_UPDATE_H
#define CM1E_BUS_FIRMWARE_UPDATE_H

#include "cm1e/foe.h"

typedef struct cm1e_firmware_file {
    const char *name;        /**< by which the slave knows the file */
    const uint8_t *bytes;
    size_t size;
    cm1e_foe_options_t options; /**< a slave may erase its memory before an answer */
} cm1e_firmware_file_t;

/** What became of the slave. */
typedef enum cm1e_firmware_state {
    CM1E_FIRMWARE_UNTOUCHED = 0, /**< nothing was written: it keeps the firmware that it had */
    CM1E_FIRMWARE_PARTLY,        /**< a part of the file was sent to it: its firmware may be incomplete */
    CM1E_FIRMWARE_WRITTEN,       /**< it has taken all of the file */
} cm1e_firmware_state_t;

/** The states of all slaves in one number, before a scan changes them: bit n is set if a slave has bit n in its AL
 *  status. 0: no slave answers. */
uint8_t cm1e_firmware_all_states(cm1e_bus_t *bus);

/** Writes the file and leaves Bootstrap. The bus is to be scanned again afterwards. @rt init */
cm1e_error_t cm1e_firmware_update(cm1e_bus_t *bus, uint16_t position, const cm1e_firmware_file_t *file,
                                  cm1e_firmware_state_t *state, cm1e_diag_t *diag);

#endif
