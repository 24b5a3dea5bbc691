/**
 * @file sii_fetch.h
 * Fetches words of the SII (EEPROM; ETG.1000.4 section 6.4) of one slave, one datagram at a time, so that those of many
 * slaves come at the same time. cm1e_sii_fetched() is a reader for sii_reader.h: what it does not have yet it notes,
 * and the reading is repeated when that has come. No clock inside.
 */
#ifndef CM1E_BUS_SII_FETCH_H
#define CM1E_BUS_SII_FETCH_H

#include "bus/datagram.h"

/** Words that a reading may ask for, and behind them the rest of a group. */
enum { CM1E_FETCH_WORDS = 0x2000 + 8 };

typedef enum cm1e_fetch_step {
    FETCH_IDLE = 0,
    FETCH_READY, /**< until the interface is idle */
    FETCH_CLEAR, /**< errors of an earlier command */
    FETCH_ASK,
    FETCH_TAKE,  /**< status and data in one datagram */
} cm1e_fetch_step_t;

typedef struct cm1e_sii_fetch {
    uint16_t station;
    cm1e_fetch_step_t step;
    uint16_t word, end;         /**< what is to be fetched now */
    unsigned tries, silent;     /**< of one group; datagrams in a row that the slave did not answer */
    int64_t looked_ns;          /**< when it was looked at last for this group; 0: not yet */
    int64_t waited_ns;          /**< for this group, without the times in which the master stood still */
    int64_t not_before_ns;
    bool failed;                /**< it cannot be read */
    bool lost;                  /**< because its controller does not answer */
    uint8_t image[2 * CM1E_FETCH_WORDS];
    uint8_t known[CM1E_FETCH_WORDS / 8];
} cm1e_sii_fetch_t;

/** Words that have been fetched (cm1e_sii_reader). false: they will be, or `failed`. */
bool cm1e_sii_fetched(void *context, uint16_t word, uint16_t count, uint8_t *bytes);
/** Fills the datagram to be sent next; false: none now. */
bool cm1e_sii_fetch_next(cm1e_sii_fetch_t *fetch, cm1e_datagram_t *datagram, int64_t now_ns);
void cm1e_sii_fetch_result(cm1e_sii_fetch_t *fetch, const cm1e_datagram_t *datagram, int64_t now_ns);
static inline bool cm1e_sii_fetch_idle(const cm1e_sii_fetch_t *fetch) { return fetch->step == FETCH_IDLE; }

#endif
