/**
 * @file sii_image.h
 * The SII image (ETG.1000.6 5.4, ETG.2010): the contents of a slave's EEPROM, which every master reads. An image is
 * written from a description and read into one; the simulator boots from it. Any thread.
 *
 * A description holds what masters use: identity, mailboxes, strings, General, FMMU, SyncM, TxPDO, RxPDO, DC. What else
 * an image has (categories of the maker, pictures, current on the E-bus, strings nobody refers to) is skipped on
 * reading, so an image of another maker's tool does not come back byte for byte; one that was written here does. To
 * keep an image as it is, keep its bytes.
 */
#ifndef CM1E_DESCRIPTION_SII_IMAGE_H
#define CM1E_DESCRIPTION_SII_IMAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "description/check.h"
#include "description/description.h"

enum {
    CM1E_SII_SIZE = 2048,          /**< bytes where a description states none: a 16 kbit EEPROM */
    CM1E_SII_SIZE_MAX = 8 << 20,   /**< the most that the size word can state */
    CM1E_SII_HEADER_BYTES = 0x80,  /**< the fixed part; the categories follow */
    CM1E_SII_CATEGORY_END = 0xFFFF,
};
/** Byte addresses of the fixed words (ETG.1000.6 table 16, ETG.2010 table 2). */
enum {
    CM1E_SII_CONFIG = 0x00, CM1E_SII_ALIAS = 0x08, CM1E_SII_CHECKSUM = 0x0E, CM1E_SII_VENDOR = 0x10,
    CM1E_SII_PRODUCT = 0x14, CM1E_SII_REVISION = 0x18, CM1E_SII_SERIAL = 0x1C, CM1E_SII_BOOTSTRAP = 0x28,
    CM1E_SII_MAILBOX = 0x30, CM1E_SII_PROTOCOLS = 0x38, CM1E_SII_KBIT = 0x7C, CM1E_SII_VERSION = 0x7E,
};
enum {
    CM1E_SII_CONFIG_BYTES = 14,    /**< words 0-6, which the checksum covers */
    CM1E_SII_BOOTSTRAP_BYTES = 8,  /**< start and length of the mailbox out, then in */
    CM1E_SII_BYTES_PER_KBIT = 128, /**< the size word counts kbit, less one */
};

/** Writes a device's description as an image of `eeprom.byte_size` bytes (0: CM1E_SII_SIZE) into `image`. 0: it does
 *  not fit into `room`, into the EEPROM or into the format, `diag` says why, and what is in `image` is of no use. A
 *  mailbox that `eeprom` does not state is that of the sync managers; DC modes are written where one of them switches a
 *  signal on. Texts become ISO 8859-1, a letter that it lacks "?". Of an MDP device only what is in the device itself:
 *  expand its slots before. @rt any */
size_t cm1e_sii_write(uint8_t *image, size_t room, const cm1e_description_t *device, cm1e_diag_t *diag);

/** Appends the device of an image, which may end behind its last category; places are byte addresses. What is merely
 *  wrong is left to the checker in `findings` (NULL: not wanted) and read as far as it makes sense. CM1E_ERROR_FILE: no
 *  image of an SII has this size. @rt init */
cm1e_error_t cm1e_sii_read(cm1e_description_file_t *file, const uint8_t *image, size_t size, cm1e_findings_t *findings,
                           cm1e_diag_t *diag);

typedef struct cm1e_sii_category {
    uint16_t type;  /**< CM1E_SII_CATEGORY_END: this is the end mark */
    size_t start;   /**< byte address of its content */
    size_t bytes;   /**< as it states them, perhaps beyond the end of the image; the next one begins behind */
} cm1e_sii_category_t;
/** The category whose header begins at byte `at`. false: the image ends before. @rt any */
bool cm1e_sii_category_at(cm1e_sii_category_t *category, const uint8_t *image, size_t size, size_t at);
/** Whether cm1e_sii_read() takes anything from categories of this type. @rt any */
bool cm1e_sii_category_is_read(uint16_t type);

/** The checksum of words 0-6 that word 7 holds: CRC-8, polynomial 0x07, start value 0xFF (ETG.1000.6 5.4). @rt any */
uint8_t cm1e_sii_crc8(const uint8_t *bytes, size_t count);

#endif
