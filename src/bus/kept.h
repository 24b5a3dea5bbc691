/**
 * @file kept.h
 * Buses in Operational that no scheduler runs yet. Their slaves need frames, or their watchdogs end Operational. So
 * while the thread that started them waits for another bus, as in the start of a second one, their process data goes
 * on.
 */
#ifndef CM1E_BUS_KEPT_H
#define CM1E_BUS_KEPT_H

#include "core/guest_api.h"
#include "bus/bus_image.h"

/** From now on the calling thread keeps this bus, whenever it sends a frame on another one. @rt init */
void cm1e_bus_keep(cm1e_bus_t *bus);
/** Not any more: it is stopped, or its cycle is run. Again: nothing happens. @rt init */
void cm1e_bus_unkeep(cm1e_bus_t *bus);
/** The bus that this thread keeps and whose distributed clocks lead those of a bus that starts now; NULL: none.
 *  @rt init */
const cm1e_bus_t *cm1e_bus_kept_leader(const cm1e_bus_t *bus);
/** `bus` stops: the clocks of kept buses that followed its clocks lead themselves. @rt init */
void cm1e_bus_kept_lead_alone(const cm1e_bus_t *bus);
/** A scheduler makes the cycles of the bus from now on (true), or does so no more, because it has stopped the bus.
 *  Threads that wait for a file leave the cycles to it. @rt init */
void cm1e_bus_drive(cm1e_bus_t *bus, bool on);
/** A bus in Operational that has waited for its first cycle. A busy machine may take longer for that than the watchdogs
 *  of the slaves allow (100 ms): taking real time and locking memory needs tens of milliseconds of computing. No motor
 *  has torque yet, so the slaves are brought back to Operational. Returns the error of one that does not come.
 *  @rt init */
cm1e_error_t cm1e_bus_resume(cm1e_bus_t *bus, cm1e_diag_t *diag);
/** Whether the scheduler of another thread runs the bus, which must not be stopped or freed under it. It learns which
 *  function was called. @rt any */
bool cm1e_bus_refuse_end(cm1e_bus_t *bus, const char *function);
/** The function that was refused in this run; NULL: none. @rt cycle */
const char *cm1e_bus_refused_end(const cm1e_bus_t *bus);
/** Refuses what another thread would do beside the cycle of a scheduler; CM1E_OK: none runs the bus. @rt block */
cm1e_error_t cm1e_bus_refuse_driven(const cm1e_bus_t *bus, const char *function, const char *instead,
                                    cm1e_diag_t *diag);
/** Whether a scheduler makes the cycles. @rt any */
bool cm1e_bus_is_driven(const cm1e_bus_t *bus);
/** The calling thread runs a cycle (true), so that no other bus may use its time. @rt init */
void cm1e_bus_keep_none(bool none);

#endif
