/**
 * @file sii.h
 * The SII of a live slave: the EEPROM that says who it is (ETG.1000.6 5.4, ETG.2010). Read as a whole, written word by
 * word and read back. Before the cycle runs, by the thread that owns the bus; no scan is needed, so that a slave whose
 * SII is damaged, which no scan gets past, can be given a good one.
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

/** The largest EEPROM that a slave controller reaches: 4 Mbit. */
#define CM1E_SII_IMAGE_MAX ((size_t)512 * 1024)

/** Reads the whole EEPROM of the slave at `position` (1 = first) into `image`; `*size`: room, then bytes. Its size is
 *  what word 0x3E states; 2048 bytes (16 kbit) where that states none. CM1E_ERROR_INVALID_ARGUMENT: it does not fit,
 *  `*size` is what it needs. @rt block */
CM1E_API cm1e_error_t cm1e_sii_read_device(cm1e_bus_t *bus, uint16_t position, uint8_t *image, size_t *size,
                                           cm1e_diag_t *diag);

/** What may be written that is refused otherwise. Zeroed: nothing. */
typedef struct cm1e_sii_write_options {
    bool force_checksum;       /**< an image whose word 7 is not the checksum of words 0-6: no slave loads it */
    bool force_identity;       /**< into a slave that is not the image's product, or that is not a CM1-E */
    bool force_configuration;  /**< words 0-3, 5, 6 unlike the slave's: they say how its processor is connected */
    bool own_alias_and_serial; /**< alias (word 4) and serial number (words 0x0E, 0x0F) of the image, too; by default
                                    those of the slave stay: one slave's image makes no twin of another */
} cm1e_sii_write_options_t;

/** Writes an image into the slave's EEPROM, only the words that differ: categories first, then the header, words 0-7
 *  last. Each word is read back, at the end the whole image. The slave takes it over when it is switched on anew.
 *  CM1E_ERROR_FILE: the image is not one; CM1E_ERROR_STATE: the slave is neither in Init nor in Pre-Operational;
 *  CM1E_ERROR_BUS_IDENTITY: another product; CM1E_ERROR_CONFIG: another configuration. In these cases nothing was
 *  written. CM1E_ERROR_TIMEOUT, CM1E_ERROR_BUS_LOST: `diag` says at which word it stopped. Take a backup before, with
 *  cm1e_sii_read_device(): it is the way back. @rt block */
CM1E_API cm1e_error_t cm1e_sii_write_device(cm1e_bus_t *bus, uint16_t position, const uint8_t *image, size_t size,
                                            const cm1e_sii_write_options_t *options, cm1e_diag_t *diag);

#ifdef __cplusplus
}
#endif
#endif
