/**
 * @file segment.h
 * The segment as its own sources and our tests see it; what others may do with it is in cm1e/sim.h.
 */
#ifndef CM1E_SIM_SEGMENT_H
#define CM1E_SIM_SEGMENT_H

#include "cm1e/sim.h"

typedef struct cm1e_sim_slave cm1e_sim_slave_t;
typedef struct cm1e_sim_cm1e cm1e_sim_cm1e_t;
typedef struct cm1e_sim_bridge cm1e_sim_bridge_t;

/** Adds a slave behind the last one; the segment owns it. On an error it stays the caller's. */
cm1e_error_t cm1e_sim_segment_add(cm1e_sim_segment_t *segment, cm1e_sim_slave_t *slave);
/** 1 = first; NULL: none. */
cm1e_sim_slave_t *cm1e_sim_segment_slave(cm1e_sim_segment_t *segment, uint32_t position);
/** Pulls a slave out of the line: its neighbours are connected to each other, as when a tool leaves its changer. It
 *  loses its control power, unless `keeps_power`. Places stay those of the slaves as they were added. */
void cm1e_sim_segment_detach(cm1e_sim_segment_t *segment, uint32_t position, bool keeps_power);
void cm1e_sim_segment_attach(cm1e_sim_segment_t *segment, uint32_t position);
/** The place of a slave that fell back since it was asked last; 0: none. */
uint32_t cm1e_sim_segment_fallen_back(cm1e_sim_segment_t *segment);

#endif
