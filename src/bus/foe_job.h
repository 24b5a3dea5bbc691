/**
 * @file foe_job.h
 * The transfer of a file while the cycle runs: one at a time for the whole bus, handed in by any thread, done with the
 * datagrams that a cycle sends anyway. Between two packets the slave has its SDO transfers.
 */
#ifndef CM1E_BUS_FOE_JOB_H
#define CM1E_BUS_FOE_JOB_H

#include "bus/foe_client.h"
#include "core/guest_api.h"

/** Hands in a transfer: `position`, `writing`, `name`, `from` and `size` or `to` and `room`, `options` without
 *  `progress` and `bootstrap` are given, and stay until it is done. CM1E_ERROR_BUSY: another one is under way; STATE,
 *  INVALID_ARGUMENT, UNSUPPORTED: not begun. @rt any */
CM1E_GUEST_API cm1e_error_t cm1e_foe_submit(cm1e_bus_t *bus, cm1e_foe_t *foe, cm1e_diag_t *diag);
/** What cm1e_foe_submit() refuses. @rt any */
CM1E_GUEST_API cm1e_error_t cm1e_foe_check(const cm1e_bus_t *bus, const cm1e_foe_t *foe, cm1e_diag_t *diag);
/** It belongs to its thread again; cm1e_foe_result_of() says what came of it. @rt any */
CM1E_GUEST_API bool cm1e_foe_done(const cm1e_foe_t *foe);
/** Ends it early; it is done a moment later. @rt any */
CM1E_GUEST_API void cm1e_foe_cancel(cm1e_foe_t *foe);
CM1E_GUEST_API cm1e_error_t cm1e_foe_result_of(const cm1e_foe_t *foe, cm1e_diag_t *diag);

/** Begins and ends it. @rt cycle */
void cm1e_foe_job_serve(cm1e_bus_t *bus, int64_t now_ns);
/** The next datagram for a slave; false: none. @rt cycle */
bool cm1e_foe_job_next(cm1e_bus_t *bus, cm1e_bus_slave_t *slave, int64_t now_ns);
void cm1e_foe_job_result(cm1e_bus_t *bus, cm1e_bus_slave_t *slave, int64_t now_ns);
void cm1e_foe_job_cancel(cm1e_bus_t *bus);
/** The mailbox of the slave is in the middle of a message of FoE: nothing else may begin there. @rt cycle */
bool cm1e_foe_job_holds(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave);

#endif
