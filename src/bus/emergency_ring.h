/**
 * @file emergency_ring.h
 * The last emergencies of a slave (core/history.h). The thread that owns the bus writes; any thread reads.
 */
#ifndef CM1E_BUS_EMERGENCY_RING_H
#define CM1E_BUS_EMERGENCY_RING_H

#include "cm1e/emergency.h"
#include "core/history.h"

_Static_assert(sizeof(cm1e_emergency_t) % sizeof(uint64_t) == 0, "a record is whole words");
#define CM1E_EMERGENCY_SHAPE CM1E_HISTORY_SHAPE(CM1E_EMERGENCIES, cm1e_emergency_t)
typedef uint64_t cm1e_emergency_ring_t[CM1E_HISTORY_WORDS(CM1E_EMERGENCIES, cm1e_emergency_t)];

/** Emergencies of all slaves since the bus was opened. @rt cycle */
uint64_t cm1e_bus_emergency_count(const cm1e_bus_t *bus);
/** A whole sentence: 'Slave 2 ("axis2", CM1-E): emergency 0x2310, ...'. @rt block */
void cm1e_emergency_sentence(const cm1e_bus_t *bus, uint16_t position, const cm1e_emergency_t *emergency, char *text,
                             size_t size);

#endif
