/**
 * @file bootstrap.h
 * One slave in the state Bootstrap, with the mailbox that its SII states for it. The slave needs no valid firmware for
 * it, and the bus no scan. Afterwards nothing is known of the other slaves: the bus is to be scanned again.
 */
#ifndef CM1E_BUS_BOOTSTRAP_H
#define CM1E_BUS_BOOTSTRAP_H

#include "bus/mailbox_link.h"
#include "cm1e/bus.h"

typedef struct cm1e_bootstrap {
    cm1e_bus_t *bus;
    uint16_t position;
    cm1e_diag_t *diag;
    cm1e_mailbox_t mailbox; /**< valid after cm1e_bootstrap_enter() */
    bool leaves;            /**< the slave may start anew and forget its station address */
} cm1e_bootstrap_t;

/** Brings the slave from any state to Init and then to Bootstrap. */
cm1e_error_t cm1e_bootstrap_enter(cm1e_bootstrap_t *bootstrap);
/** Brings the slave to Init. A device may copy its memory before it answers, or start anew: then it is in Init without
 *  a station address. */
cm1e_error_t cm1e_bootstrap_leave(cm1e_bootstrap_t *bootstrap);

#endif
