/**
 * @file emergency.h
 * The emergencies that the slaves of a bus have sent (CoE, ETG.1000.6 section 5.6.4): a device sends one when an error
 * occurs, and one with the code 0 when all errors are gone. The bus keeps the last ones of each slave, with the time at
 * which they arrived. While the cycle runs, it looks into one mailbox every 5 ms, in turn; before, emergencies arrive
 * with the answers to SDO transfers. Any thread may read them at any time.
 */
#ifndef CM1E_EMERGENCY_H
#define CM1E_EMERGENCY_H

#include "cm1e/api.h"
#include "cm1e/bus.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Number of emergencies that are kept for each slave, and buffer size that is large enough for every text. */
enum { CM1E_EMERGENCIES = 16, CM1E_EMERGENCY_TEXT_BYTES = 400 };

/** An emergency as a slave has sent it. */
typedef struct cm1e_emergency {
    uint64_t number;        /**< counts from 1 for each slave since the scan, without gaps */
    int64_t time_ns;        /**< since 1970 (UTC); on virtual time since its beginning */
    uint16_t code;          /**< the error code; 0: no error any more */
    uint8_t error_register; /**< object 0x1001 */
    uint8_t data[5];        /**< what it means is in the manual of the device */
} cm1e_emergency_t;

/** Copies the emergencies of a slave after the one with number `after` (0: all that there are), oldest first, at most
 *  `room`. Returns how many there are in `emergencies`. `*lost`, if not NULL, is the number of those after `after` that
 *  are no longer kept. A slave that does not exist has none. @rt any */
CM1E_API size_t cm1e_bus_emergencies(const cm1e_bus_t *bus, uint16_t position, uint64_t after,
                                     cm1e_emergency_t *emergencies, size_t room, uint64_t *lost);
/** Writes an emergency of the slave at `position` in words, without slave and time: the text of the device for its
 *  code, else that of its class (CiA 301, CiA 402), the error register, the bytes, and a cure if there is one. A buffer
 *  that is too small gets the beginning; CM1E_EMERGENCY_TEXT_BYTES are enough. @rt block */
CM1E_API void cm1e_emergency_text(const cm1e_bus_t *bus, uint16_t position, const cm1e_emergency_t *emergency,
                                  char *text, size_t size);

#ifdef __cplusplus
}
#endif
#endif
