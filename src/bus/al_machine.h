/**
 * @file al_machine.h
 * Brings one slave to an EtherCAT state (ETG.1000.6 section 6.4): acknowledges an error where AL status shows one,
 * requests, waits; and reads the explicit device ID (ETG.1020). One datagram at a time, no clock inside.
 */
#ifndef CM1E_BUS_AL_MACHINE_H
#define CM1E_BUS_AL_MACHINE_H

#include "bus/datagram.h"
#include "cm1e/bus.h"

typedef enum cm1e_al_step {
    AL_IDLE = 0,
    AL_LOOK,        /**< is an old error to be acknowledged? */
    AL_ACKNOWLEDGE,
    AL_ACKNOWLEDGED,
    AL_REQUEST,
    AL_WAIT,
    AL_ID_ASK,
    AL_ID_WAIT,
    AL_ID_END,
} cm1e_al_step_t;

enum { CM1E_AL_SILENT = 5 };

typedef struct cm1e_al_machine {
    uint16_t station;
    cm1e_al_step_t step;
    uint8_t target;
    int64_t deadline_ns;
    bool answered;          /**< the slave has answered at its address since the start */
    unsigned unanswered;    /**< datagrams in a row that nobody answered */
    bool without_bit;       /**< the next acknowledgement has no acknowledge bit */
    unsigned looks;         /**< since the last acknowledgement */
    int64_t acknowledged_ns;
    uint16_t state, code;   /**< AL status and status code, as last read */
    uint16_t explicit_id;   /**< result of cm1e_al_read_id(); 0: none or not supported */
    cm1e_error_t error;     /**< result, valid when idle */
} cm1e_al_machine_t;

/** Nobody answers, or nobody any more: several datagrams in a row. `state` is of before then. */
static inline bool cm1e_al_is_silent(const cm1e_al_machine_t *machine)
{
    return !machine->answered || machine->unanswered >= CM1E_AL_SILENT;
}
static inline bool cm1e_al_idle(const cm1e_al_machine_t *machine) { return machine->step == AL_IDLE; }
void cm1e_al_request(cm1e_al_machine_t *machine, uint8_t target, int64_t deadline_ns);
/** A slave that does not support the request does not answer before the deadline: ID 0, no error. */
void cm1e_al_read_id(cm1e_al_machine_t *machine, int64_t deadline_ns);
void cm1e_al_cancel(cm1e_al_machine_t *machine);
bool cm1e_al_next(cm1e_al_machine_t *machine, cm1e_datagram_t *datagram, int64_t now_ns);
void cm1e_al_result(cm1e_al_machine_t *machine, const cm1e_datagram_t *datagram, int64_t now_ns);

/** "INIT", "PRE-OP", "SAFE-OP + ERROR" ... for an AL status; never NULL. */
const char *cm1e_al_state_text(uint16_t al_state);

#endif
