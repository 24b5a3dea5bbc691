/**
 * @file kept.h
 * Buses in Operational that no scheduler runs yet. Their slaves need frames, or their watchdogs end Operational. So while
 * the thread that started them waits for another bus, as in the start of a second one, their process data goes on.
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
/** Whether a scheduler makes the cycles. @rt any */
bool cm1e_bus_is_driven(const cm1e_bus_t *bus);
/** The calling thread runs a cycle (true), so that no other bus may use its time. @rt init */
void cm1e_bus_keep_none(bool none);

#endif
