/**
 * @file sii.h
 * Reads the part of a slave's SII (EEPROM; ETG.2010) that the bus needs, with bounds: no length in it is trusted, and
 * the loop over the categories always goes forward and ends. description/sii.h defines the meaning of the words. Pure
 * functions: a callback reads the words.
 */
#ifndef CM1E_BUS_SII_H
#define CM1E_BUS_SII_H

#include <stdbool.h>
#include <stdint.h>

enum { CM1E_SII_SYNC_MANAGERS = 8, CM1E_SII_NAME = 48 };

typedef struct cm1e_sii_sync_manager {
    uint16_t start, length;
    uint8_t control, enable;
} cm1e_sii_sync_manager_t;

typedef struct cm1e_sii {
    uint32_t vendor_id, product_code, revision, serial_number;
    uint16_t mailbox_out_start, mailbox_out_length, mailbox_in_start, mailbox_in_length;
    bool coe, complete_access;
    bool no_lrw;                                       /**< the slave cannot do LRW */
    char name[CM1E_SII_NAME];                          /**< printable; "": none */
    uint8_t sync_manager_count;
    cm1e_sii_sync_manager_t sync_managers[CM1E_SII_SYNC_MANAGERS];
    uint32_t bits[2][CM1E_SII_SYNC_MANAGERS];          /**< process data: [0] outputs (RxPDO), [1] inputs, by SM */
} cm1e_sii_t;

/** Reads two words (four bytes) from word address `word`; false: the SII cannot be read. */
typedef bool (*cm1e_sii_reader)(void *context, uint16_t word, uint8_t bytes[4]);

typedef enum cm1e_sii_result { SII_OK = 0, SII_UNREADABLE, SII_DAMAGED, SII_NO_MEMORY } cm1e_sii_result_t;

/** The fixed part: identity and mailbox. */
cm1e_sii_result_t cm1e_sii_read_header(cm1e_sii_t *sii, cm1e_sii_reader reader, void *context);
/** The categories: name, sync managers, process data. */
cm1e_sii_result_t cm1e_sii_read_categories(cm1e_sii_t *sii, cm1e_sii_reader reader, void *context);

#endif
