/**
 * @file recognise.h
 * Whether a slave is an EtherCAT Cool MUSCLE Bridge, and with which motors. Its guide states no vendor and no product
 * code; what it states is its modular objects (BR appendix 6). A list of SDO reads, one after the other, which ends at
 * the first answer that no bridge gives, and in any case at its deadline; who runs it owns the CoE client. Reading
 * changes nothing in a device of another kind.
 */
#ifndef CM1E_BUS_RECOGNISE_H
#define CM1E_BUS_RECOGNISE_H

#include "cm1e/bus.h"
#include "device/devices.h"

/** What is kept of the answers of a bridge. */
typedef struct cm1e_bridge_facts {
    uint32_t motors[CM1E_BRIDGE_AXES]; /**< F511:1 ... F514:1: cm1e_bridge_motor_t or anything; 0: unreadable */
    uint32_t revision;                 /**< 0x1018:3; 0: unreadable */
} cm1e_bridge_facts_t;

typedef struct cm1e_recognition {
    bool busy;
    bool started;            /**< `sdo` is in work or done */
    uint8_t question;
    int64_t deadline_ns;
    cm1e_sdo_t sdo;          /**< the last transfer; if the slave is no bridge, the one that showed it */
    uint8_t data[4];
    uint32_t device_type;    /**< 0x1000; 0: not read */
    bool recognised;         /**< result, valid when idle */
    uint32_t shown, wanted;  /**< if the slave is no bridge: what it answered, and what a bridge answers */
    cm1e_bridge_facts_t facts;
} cm1e_recognition_t;

void cm1e_recognise_begin(cm1e_recognition_t *job, uint16_t position, int64_t deadline_ns);
void cm1e_recognise_cancel(cm1e_recognition_t *job);
static inline bool cm1e_recognise_idle(const cm1e_recognition_t *job) { return !job->busy; }
/** The transfer to begin now; NULL: the job has ended, or is idle. The transfer that was returned before must have
 *  ended. */
cm1e_sdo_t *cm1e_recognise_next(cm1e_recognition_t *job, int64_t now_ns);
/** Finds the model with these motors. false: there is none, and `*model` is CM1E_DEVICE_CM1E. */
bool cm1e_recognise_model(const cm1e_bridge_facts_t *facts, cm1e_device_model_t *model);

#endif
