/**
 * @file emergency_ring.h
 * The last emergencies of a slave. The thread that owns the bus writes; readers in other threads see by the sequence
 * whether a place was overwritten meanwhile, as in the event log.
 */
#ifndef CM1E_BUS_EMERGENCY_RING_H
#define CM1E_BUS_EMERGENCY_RING_H

#include "cm1e/emergency.h"
#include "core/guest_api.h"

typedef struct cm1e_emergency_place {
    uint64_t sequence; /**< atomic; number of the emergency, 0: it is being written */
    uint64_t words[2]; /**< atomic; time, then the eight bytes of the message */
} cm1e_emergency_place_t;

typedef struct cm1e_emergency_ring {
    uint64_t last; /**< atomic; number of the newest */
    cm1e_emergency_place_t places[CM1E_EMERGENCIES];
} cm1e_emergency_ring_t;

/** Adds an emergency; its number is given here. @rt cycle */
void cm1e_emergency_add(cm1e_emergency_ring_t *ring, cm1e_emergency_t emergency);
/** As cm1e_bus_emergency(). @rt any */
size_t cm1e_emergency_copy(const cm1e_emergency_ring_t *ring, uint64_t after, cm1e_emergency_t *emergencies,
                           size_t room, uint64_t *lost);

/** Emergencies of all slaves since the bus was opened. @rt cycle */
uint64_t cm1e_bus_emergencies(const cm1e_bus_t *bus);
/** A whole sentence: 'Slave 2 ("axis2", CM1-E): emergency 0x2310, ...'. @rt block */
void cm1e_emergency_sentence(const cm1e_bus_t *bus, uint16_t position, const cm1e_emergency_t *emergency, char *text,
                             size_t size);

#endif
