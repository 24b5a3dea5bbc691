/**
 * @file recovery.h
 * Brings one slave that left Operational (watchdog, reset, power cycle, replug) back while the others keep running. The
 * slave is found by its place, verified to be the same device, and configured as before. One datagram or SDO transfer
 * at a time, no clock inside. After a failure it tries again, after a pause.
 */
#ifndef CM1E_BUS_RECOVERY_H
#define CM1E_BUS_RECOVERY_H

#include "bus/datagram.h"
#include "cm1e/bus.h"

struct cm1e_bus_slave;

typedef enum cm1e_recovery_step {
    RECOVERY_IDLE = 0,
    RECOVERY_PAUSE,
    RECOVERY_FIND,           /**< station address and alias at its place on the wire */
    RECOVERY_ADDRESS,        /**< give it its station address again */
    RECOVERY_RETURN,         /**< after a move of places a running slave has this address: it gets its own */
    RECOVERY_LOOK,           /**< reads AL status, which shows how much is left of the configuration */
    RECOVERY_EEPROM,         /**< gives the SII to the device */
    RECOVERY_INIT,
    RECOVERY_UNMAP,          /**< takes its FMMUs away: where its sync managers are off, they reach its memory, and it
                                  would seem to take part in the process data */
    RECOVERY_CLEAR,          /**< deactivates the sync managers: an active one takes no other values */
    RECOVERY_MAILBOX,        /**< SM0, SM1 */
    RECOVERY_PRE_OP,
    RECOVERY_ID,             /**< rotary switches */
    RECOVERY_VENDOR,
    RECOVERY_PRODUCT,
    RECOVERY_SERIAL,
    RECOVERY_OBJECTS,         /**< checks that it is still a bridge of the same revision with the same motors */
    RECOVERY_VERSION,         /**< the firmware: of a slave that comes for the first time, and of a motor */
    RECOVERY_SETUP,           /**< what the configuration writes into it in Pre-Operational */
    RECOVERY_MAPPING,
    RECOVERY_PLACE,          /**< places the process data, if the slave comes for the first time */
    RECOVERY_PROCESS_DATA,   /**< SM2, SM3 */
    RECOVERY_FMMUS,
    RECOVERY_WATCHDOG_DIVIDER,
    RECOVERY_WATCHDOG,
    RECOVERY_CLOCK,          /**< its distributed clock, and its pulses */
    RECOVERY_SAFE_OP,
    RECOVERY_SETUP_OP,       /**< what the configuration writes into it in Safe-Operational */
    RECOVERY_OP,
    RECOVERY_RELEASE,        /**< remove the station address from a device that is not the expected one */
    RECOVERY_STEPS,
} cm1e_recovery_step_t;

typedef struct cm1e_recovery {
    cm1e_recovery_step_t step;
    bool entered;            /**< the sub-machine of this step has been started */
    bool address_given;      /**< in this attempt */
    int64_t deadline_ns;     /**< of the step; in RECOVERY_PAUSE: its end */
    unsigned unanswered;     /**< questions for registers in a row, while frames come back */
    bool doubts;             /**< a mailbox took nothing: the next question is one for a register */
    uint32_t attempts, successes; /**< only grow */
    cm1e_recovery_step_t failed_at; /**< of the last attempt; RECOVERY_IDLE: it did not fail */
    cm1e_sdo_t sdo;
    uint8_t data[4];
} cm1e_recovery_t;

/** Whether the slave is out of Operational and was not seen there again. It gets outputs of zeros meanwhile, so that no
 *  stale command acts in the cycle in which it reaches Operational. */
static inline bool cm1e_recovery_mutes(const cm1e_recovery_t *recovery) { return recovery->step >= RECOVERY_EEPROM; }
static inline bool cm1e_recovery_idle(const cm1e_recovery_t *recovery) { return recovery->step == RECOVERY_IDLE; }
void cm1e_recovery_begin(cm1e_bus_t *bus, struct cm1e_bus_slave *slave);
/** Begins with the configuration of a slave that the search has just identified. */
void cm1e_recovery_begin_found(cm1e_bus_t *bus, struct cm1e_bus_slave *slave, int64_t now_ns);
void cm1e_recovery_cancel(struct cm1e_bus_slave *slave);
/** Fills the datagram to be sent next; false: none in this cycle. The recovery must not be idle. */
bool cm1e_recovery_next(struct cm1e_bus_slave *slave, cm1e_datagram_t *datagram, int64_t now_ns);
void cm1e_recovery_result(struct cm1e_bus_slave *slave, const cm1e_datagram_t *datagram, int64_t now_ns);

/* recovery_device.c */
bool cm1e_recovery_is_recognised(struct cm1e_bus_slave *slave);
bool cm1e_recovery_has_firmware(const struct cm1e_bus_slave *slave);
bool cm1e_recovery_takes_version(struct cm1e_bus_slave *slave);
bool cm1e_recovery_takes_mapping(struct cm1e_bus_slave *slave);

/* recovery_text.c */
/** What an attempt that fails at this step says of a slave that answers. */
const char *cm1e_recovery_reason(cm1e_recovery_step_t step);
/** Why the last attempt with a slave that answers has failed: "it does not go to Operational"; NULL: it has not. */
const char *cm1e_recovery_failure(const cm1e_recovery_t *recovery);

#endif
