/**
 * @file sii.h
 * Writer of the SII image (ETG.1000.6 5.4, ETG.2010): what a slave's EEPROM holds and every master reads. Built from
 * the device tables; the simulator boots from it. Any thread.
 */
#ifndef CM1E_DESCRIPTION_SII_H
#define CM1E_DESCRIPTION_SII_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "description/check.h"
#include "description/description.h"
#include "device/device.h"

/** Bytes of an image: a 16 kbit EEPROM. */
#define CM1E_SII_SIZE 2048

/** A zeroed struct describes the oldest firmware with its default mapping, no alias. */
typedef struct cm1e_sii_options {
    cm1e_firmware_t firmware;
    cm1e_pdo_order_t order;
    cm1e_mapping_t mapping;    /**< the PDOs that sync managers 2 and 3 carry by default */
    uint16_t alias;            /**< configured station alias, 0: none */
    uint32_t serial_number;
    bool complete_access;      /**< announce SDO complete access (not known of the device, so off by default) */
    bool distributed_clocks;   /**< add the category of DC modes (the guide names none, so off by default) */
} cm1e_sii_options_t;

/** Writes the image of a CM1-E; returns CM1E_SII_SIZE, or 0 where `room` is smaller. The configuration area (words 0-3)
 *  of the real device is not known: do not write this image into a real device. @rt any */
size_t cm1e_generate_sii(uint8_t *image, size_t room, const cm1e_sii_options_t *options);

/** Writes the image of a plain I/O module without mailbox, 1 byte out and 1 byte in, vendor 0. Returns as above.
 *  @rt any */
size_t cm1e_generate_sii_io_module(uint8_t *image, size_t room);

/** Writes a device's description as an image of `eeprom.byte_size` bytes (0: 2048) into `image`. 0: it does not fit into
 *  `room`, or into the EEPROM; `diag` says why. @rt any */
size_t cm1e_sii_write(uint8_t *image, size_t room, const cm1e_description_t *device, cm1e_diag_t *diag);
/** Appends the device of an image; places are byte addresses. What is merely wrong (checksum, lengths beyond the end) is
 *  kept for the checker in `findings` (NULL: not wanted); CM1E_ERROR_FILE: there is no way to read it. @rt any */
cm1e_error_t cm1e_sii_read(cm1e_description_file_t *file, const uint8_t *image, size_t size, cm1e_findings_t *findings,
                           cm1e_diag_t *diag);

/** The checksum of words 0-6 that word 7 holds: CRC-8, polynomial 0x07, start value 0xFF (ETG.1000.6 5.4). @rt any */
uint8_t cm1e_sii_crc8(const uint8_t *bytes, size_t count);

#endif
