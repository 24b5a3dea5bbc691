/**
 * @file sii_scout.h
 * Reads of the SII of one slave (EEPROM; ETG.2010) what it takes to recognise it and to place its process data, while
 * the cycle runs: identity, mailbox, sync managers, and the bits that each of them carries. One datagram at a time, no
 * clock and no memory inside. No length that it reads is trusted: the number of words is bounded.
 */
#ifndef CM1E_BUS_SII_SCOUT_H
#define CM1E_BUS_SII_SCOUT_H

#include "bus/datagram.h"
#include "bus/sii_reader.h"

typedef enum cm1e_scout_step {
    SCOUT_IDLE = 0,
    SCOUT_FORCE,       /**< take the EEPROM away from the device */
    SCOUT_OWN,
    SCOUT_READY,       /**< until the interface is idle */
    SCOUT_CLEAR,       /**< errors of an earlier command */
    SCOUT_ASK,
    SCOUT_TAKE,        /**< status and data in one datagram */
} cm1e_scout_step_t;

/** What was read. */
typedef struct cm1e_scouted {
    uint32_t vendor_id, product_code, revision, serial_number;
    uint16_t mailbox_out_start, mailbox_out_length, mailbox_in_start, mailbox_in_length;
    uint16_t protocols;                                  /**< word 0x1C */
    uint8_t sync_manager_count;
    cm1e_sii_sync_manager_t sync_managers[CM1E_SII_SYNC_MANAGERS];
    uint16_t bits[2][CM1E_SII_SYNC_MANAGERS];            /**< [0] outputs, [1] inputs, by sync manager */
} cm1e_scouted_t;

typedef struct cm1e_scout {
    uint16_t station;
    cm1e_scout_step_t step;
    int64_t deadline_ns;
    uint8_t phase, item;                                 /**< where the reading is (sii_scout.c) */
    uint16_t word, next_category, items, reads;
    uint8_t sync_manager;                                /**< of the present PDO */
    bool good;                                           /**< result, valid when idle */
    cm1e_scouted_t found;
} cm1e_scout_t;

void cm1e_scout_begin(cm1e_scout_t *scout, uint16_t station, int64_t deadline_ns);
static inline bool cm1e_scout_idle(const cm1e_scout_t *scout) { return scout->step == SCOUT_IDLE; }
static inline void cm1e_scout_cancel(cm1e_scout_t *scout) { scout->step = SCOUT_IDLE; }
/** Fills the datagram to be sent next; false: it has ended. */
bool cm1e_scout_next(cm1e_scout_t *scout, cm1e_datagram_t *datagram, int64_t now_ns);
void cm1e_scout_result(cm1e_scout_t *scout, const cm1e_datagram_t *datagram);

#endif
