/**
 * @file ring_watch.h
 * Whether a redundant ring is whole, and where it is broken: asked for by the supervision while the ring is broken.
 */
#ifndef CM1E_BUS_RING_WATCH_H
#define CM1E_BUS_RING_WATCH_H

#include "bus/datagram.h"
#include "cm1e/topology.h"

/** Of the bus. */
typedef struct cm1e_ring_watch {
    cm1e_bus_ring_t ring; /**< as it is told */
    int64_t due_ns;       /**< of the next question */
} cm1e_ring_watch_t;

/** After the scan, before the cycle runs. @rt block */
void cm1e_ring_watch_begin(cm1e_bus_t *bus);
/** In every cycle. true: the datagram is filled in, and asks how far either interface reaches. @rt cycle */
bool cm1e_ring_watch_ask(cm1e_bus_t *bus, cm1e_datagram_t *datagram, int64_t now_ns);
/** Takes its answer. @rt cycle */
void cm1e_ring_watch_take(cm1e_bus_t *bus);

#endif
