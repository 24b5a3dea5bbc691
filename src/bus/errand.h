/**
 * @file errand.h
 * What others read of a slave while the cycle runs, beside objects: descriptions of objects, registers, SII. One errand
 * at a time for the whole bus, handed in by any thread, done with the datagrams that a cycle sends anyway.
 */
#ifndef CM1E_BUS_ERRAND_H
#define CM1E_BUS_ERRAND_H

#include "bus/coe_client.h"
#include "core/guest_api.h"

enum {
    CM1E_ERRAND_BYTES = 128,          /**< of registers or SII at once; an SII has a multiple of it */
    CM1E_ERRAND_REGISTERS_END = 0x0900, /**< reading a register from here on changes something: latches, mailboxes */
};

typedef enum cm1e_errand_kind { ERRAND_INFO = 0, ERRAND_REGISTERS, ERRAND_SII } cm1e_errand_kind_t;

/** A step of reading the SII (ETG.1000.4 section 6.4). */
typedef enum cm1e_errand_step {
    STEP_BEGIN = 0, STEP_FORCE, STEP_OWN, STEP_READY, STEP_CLEAR, STEP_ASK, STEP_TAKE, STEP_GIVE_BACK,
} cm1e_errand_step_t;

typedef struct cm1e_errand {
    cm1e_errand_kind_t kind;
    uint16_t position;
    cm1e_info_request_t info;         /**< INFO */
    uint32_t place;                   /**< REGISTERS: address; SII: word */
    size_t size;                      /**< of `data`; a whole number of words of an SII */
    uint8_t data[CM1E_ERRAND_BYTES];
    cm1e_error_t error;               /**< valid when done; SDO abort: info.abort_code */

    bool begun;                       /**< the rest belongs to the bus */
    bool was_offered;                 /**< the slave's processor had its EEPROM before, and gets it back */
    cm1e_errand_step_t step;
    size_t taken;
    unsigned tries;
    int64_t deadline_ns;
    uint32_t done;                    /**< atomic; 1 when the errand has ended */
} cm1e_errand_t;

typedef struct cm1e_bus_slave cm1e_bus_slave_t;

/** Hands in an errand. CM1E_ERROR_BUSY: another one is under way; STATE, INVALID_ARGUMENT, UNSUPPORTED: it was not
 *  begun. @rt any */
CM1E_GUEST_API cm1e_error_t cm1e_errand_submit(cm1e_bus_t *bus, cm1e_errand_t *errand);
CM1E_GUEST_API bool cm1e_errand_done(const cm1e_errand_t *errand);

/** Begins and ends errands. @rt cycle */
void cm1e_errand_serve(cm1e_bus_t *bus, int64_t now_ns);
/** The next datagram for a slave; false: none. @rt cycle */
bool cm1e_errand_next(cm1e_bus_t *bus, cm1e_bus_slave_t *slave);
void cm1e_errand_result(cm1e_bus_t *bus, cm1e_bus_slave_t *slave, int64_t now_ns);
void cm1e_errand_cancel(cm1e_bus_t *bus);

#endif
