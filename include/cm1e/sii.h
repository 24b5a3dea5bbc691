/**
 * @file sii.h
 * The SII of a live slave: the EEPROM with its identity (ETG.1000.6 5.4, ETG.2010). It is read as a whole, written word
 * by word and read back. The thread that owns the bus calls these functions before the cycle runs. No scan is needed,
 * so that a slave whose SII is damaged, and which therefore stops every scan, can be repaired.
 */
#ifndef CM1E_SII_H
#define CM1E_SII_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cm1e/api.h"
#include "cm1e/bus.h"
#include "cm1e/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Maximum size of an EEPROM, in bytes: 4 Mbit. */
#define CM1E_SII_IMAGE_MAX ((size_t)512 * 1024)

/** Reads the whole EEPROM of the slave at `position` (1 = first) into `image`. `*size` is the room, afterwards the
 *  number of bytes. Word 0x3E states the size of the EEPROM; without it 2048 bytes (16 kbit) are read. Returns
 *  CM1E_ERROR_INVALID_ARGUMENT if the image does not fit; `*size` is then the size that it needs. @rt block */
CM1E_API cm1e_error_t cm1e_sii_read_device(cm1e_bus_t *bus, uint16_t position, uint8_t *image, size_t *size,
                                           cm1e_diag_t *diag);

/** Allows writing what is refused otherwise. A zeroed struct allows nothing. Later versions add members at its end. */
typedef struct cm1e_sii_write_options {
    bool force_checksum;       /**< allow an image whose word 7 is not the checksum of words 0-6: no slave loads it */
    bool force_identity;       /**< allow a slave that is not the product of the image, or not a CM1-E */
    bool force_configuration;  /**< allow words 0-3, 5, 6 that differ from the slave's: they say how its processor is
                                    connected; and an alias beside rotary switches that are set */
    bool own_alias_and_serial; /**< write alias (word 4) and serial number (words 0x0E, 0x0F) of the image too. By
                                    default those of the slave stay, so that no two slaves become equal */
} cm1e_sii_write_options_t;

/** Does the work of cm1e_sii_write_device(), for a program with this size of the options. @rt block */
CM1E_API cm1e_error_t cm1e_sii_write_device_sized(cm1e_bus_t *bus, uint16_t position, const uint8_t *image, size_t size,
                                                  const cm1e_sii_write_options_t *options, size_t options_size,
                                                  cm1e_diag_t *diag);
/** Writes an image into the EEPROM of a slave. Only words that differ are written: categories first, then the header,
 *  words 0-7 last. Each word is read back, and at the end the whole image. The slave uses it from its next power-on.
 *  Make a backup with cm1e_sii_read_device() before: it is the only way back. Errors after which nothing was written:
 *  CM1E_ERROR_FILE: the image is not valid; CM1E_ERROR_STATE: the slave is neither in Init nor in Pre-Operational;
 *  CM1E_ERROR_BUS_IDENTITY: another product; CM1E_ERROR_CONFIG: another configuration, or an alias for a CM1-E whose
 *  rotary switches are set, which refuses to start with both (UG 4.2.4). After CM1E_ERROR_TIMEOUT and
 *  CM1E_ERROR_BUS_LOST `diag` says at which word the writing stopped. @rt block */
static inline cm1e_error_t cm1e_sii_write_device(cm1e_bus_t *bus, uint16_t position, const uint8_t *image, size_t size,
                                                 const cm1e_sii_write_options_t *options, cm1e_diag_t *diag)
{
    return cm1e_sii_write_device_sized(bus, position, image, size, options, sizeof(cm1e_sii_write_options_t), diag);
}

#ifdef __cplusplus
}
#endif
#endif
