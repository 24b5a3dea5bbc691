/**
 * @file sii_reader.h
 * Reads the part of a slave's SII (EEPROM; ETG.2010) that the bus needs, with bounds: no length in it is trusted, and
 * the loop over the categories always goes forward and ends. description/sii_image.h defines the meaning of the words.
 * Pure functions: a callback reads the words.
 */
#ifndef CM1E_BUS_SII_READER_H
#define CM1E_BUS_SII_READER_H

#include <stdbool.h>
#include <stdint.h>

#include "config/clock_pulses.h"

enum { CM1E_SII_DC_MODES = 4, CM1E_SII_DC_MODE_NAME = 32, CM1E_SII_SYNC_MANAGERS = 8, CM1E_SII_NAME = 48,
       CM1E_SII_SIGNAL_NAME = 64 };

/** An entry of a PDO that a sync manager carries; gaps are left out. */
typedef struct cm1e_sii_signal {
    bool input;                        /**< TxPDO */
    uint16_t index;
    uint8_t subindex, type;            /**< type: cm1e_io_type_t */
    uint16_t bits;
    uint32_t bit_offset;               /**< from the beginning of the slave's process data of its direction */
    char name[CM1E_SII_SIGNAL_NAME];   /**< "PDO entry", as far as the SII has names */
} cm1e_sii_signal_t;

/** What the process data of a slave mean. Made once, then only read. */
typedef struct cm1e_sii_signals {
    uint32_t count;
    cm1e_sii_signal_t at[];
} cm1e_sii_signals_t;

typedef struct cm1e_sii_sync_manager {
    uint16_t start, length;
    uint8_t control, enable;
    uint8_t use;                       /**< ETG.2010: 1 mailbox out, 2 in, 3 outputs, 4 inputs; 0: not stated */
} cm1e_sii_sync_manager_t;

/** Whether sync manager 2 carries the inputs and 3 the outputs, so that 0x1C12 assigns TxPDOs. */
static inline bool cm1e_sii_is_swapped(const cm1e_sii_sync_manager_t managers[CM1E_SII_SYNC_MANAGERS])
{
    enum { FIRST = 2, SECOND = 3, USE_OUTPUTS = 3, USE_INPUTS = 4 };
    return managers[FIRST].use == USE_INPUTS && managers[SECOND].use != USE_INPUTS;
}

/** An operation mode of category 60; further ones are not kept. */
typedef struct cm1e_sii_dc_mode {
    char name[CM1E_SII_DC_MODE_NAME];
    cm1e_dc_facts_t facts;
} cm1e_sii_dc_mode_t;

typedef struct cm1e_sii {
    uint32_t vendor_id, product_code, revision, serial_number;
    uint16_t mailbox_out_start, mailbox_out_length, mailbox_in_start, mailbox_in_length;
    bool coe, foe, complete_access;
    bool no_lrw;                                       /**< the slave cannot do LRW */
    char name[CM1E_SII_NAME];                          /**< printable; "": none */
    uint8_t sync_manager_count;
    cm1e_sii_sync_manager_t sync_managers[CM1E_SII_SYNC_MANAGERS];
    uint32_t bits[2][CM1E_SII_SYNC_MANAGERS];          /**< process data: [0] outputs (RxPDO), [1] inputs, by SM */
    uint8_t dc_mode_count;
    cm1e_sii_dc_mode_t dc_modes[CM1E_SII_DC_MODES];
    cm1e_sii_signals_t *signals;                       /**< NULL: none; freed by cm1e_sii_free() */
} cm1e_sii_t;

/** Reads `count` words, an even number, from word address `word`; false: the SII cannot be read. */
typedef bool (*cm1e_sii_reader)(void *context, uint16_t word, uint16_t count, uint8_t *bytes);

typedef enum cm1e_sii_result { SII_OK = 0, SII_UNREADABLE, SII_DAMAGED, SII_NO_MEMORY } cm1e_sii_result_t;

/** The fixed part: identity and mailbox. */
cm1e_sii_result_t cm1e_sii_read_header(cm1e_sii_t *sii, cm1e_sii_reader reader, void *context);
/** The categories: name, sync managers, process data with their meaning (`signals`, NULL before). `brief`: without the
 *  process data, and of the strings only the name of the device and those of the modes of its clock; for a device that
 *  is asked for its mapping anyway. */
cm1e_sii_result_t cm1e_sii_read_categories(cm1e_sii_t *sii, bool brief, cm1e_sii_reader reader, void *context);
/** Frees the signals; the rest stays. */
void cm1e_sii_free(cm1e_sii_t *sii);

#endif
