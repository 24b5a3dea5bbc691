/**
 * @file remote.h
 * A bus that another program runs: slaves and transfers come through a table of functions, and no frame is sent.
 */
#ifndef CM1E_BUS_REMOTE_H
#define CM1E_BUS_REMOTE_H

#include "bus/errand.h"
#include "bus/foe_job.h"
#include "cm1e/clocks.h"
#include "cm1e/emergency.h"
#include "cm1e/hot_connect.h"
#include "cm1e/topology.h"
#include "core/guest_api.h"

/** A slave as the other program found it. */
typedef struct cm1e_remote_slave {
    cm1e_slave_info_t info; /**< without `device` and `kind` */
    char kind[24];          /**< "": none of ours */
    bool coe;
    cm1e_presence_t presence;
    char presence_text[CM1E_PRESENCE_TEXT]; /**< "": it takes part */
    uint8_t open_ports;     /**< cm1e_bus_open_ports() */
    bool has_clock;         /**< distributed clocks are used there */
    cm1e_slave_clock_t clock;
    uint32_t emergency_count;
    cm1e_emergency_t emergencies[CM1E_EMERGENCIES]; /**< in the order of their numbers */
} cm1e_remote_slave_t;

/** What the other program tells beside its slaves. */
typedef struct cm1e_remote_network {
    cm1e_bus_ring_t ring;
    uint32_t stranger_count;
    cm1e_stranger_t strangers[CM1E_STRANGERS];
} cm1e_remote_network_t;

typedef struct cm1e_bus_remote {
    cm1e_error_t (*scan)(void *state, cm1e_remote_slave_t *slaves, uint32_t room, uint32_t *count,
                         cm1e_remote_network_t *network, cm1e_diag_t *diag);
    /** Executes a transfer; an error is in `sdo` as after any other transfer. Returns CM1E_OK, or why it could not even
     *  be tried, with `diag`. */
    cm1e_error_t (*transfer)(void *state, cm1e_sdo_t *sdo, cm1e_diag_t *diag);
    /** Executes an errand; errors as for `transfer`. */
    cm1e_error_t (*errand)(void *state, cm1e_errand_t *errand, cm1e_diag_t *diag);
    /** Transfers a file as `foe` says; `done` is set after reading. */
    cm1e_error_t (*file)(void *state, cm1e_foe_t *foe, cm1e_diag_t *diag);
    void (*close)(void *state);
} cm1e_bus_remote_t;

/** As cm1e_bus_open(). `state` belongs to the bus from then on, after an error too. @rt init */
CM1E_GUEST_API cm1e_error_t cm1e_bus_open_remote(cm1e_bus_t **bus, const cm1e_bus_config_t *config,
                                                 const cm1e_bus_remote_t *remote, void *state, cm1e_diag_t *diag);

#endif
