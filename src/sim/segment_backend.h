/**
 * @file segment_backend.h
 * The simulated segment as a backend of the nic, for the interfaces "sim" and "sim:<bus file>".
 */
#ifndef CM1E_SIM_SEGMENT_BACKEND_H
#define CM1E_SIM_SEGMENT_BACKEND_H

#include "nic/nic.h"
#include "sim/segment.h"

/** The simulated segment behind a nic; NULL: the nic is a network interface. */
cm1e_sim_segment_t *cm1e_sim_segment_of(const cm1e_nic_t *nic);
/** Takes the place of the segment that cm1e_nic_open() made (tests with slaves of their own); the nic owns it. */
void cm1e_sim_replace_segment(cm1e_nic_t *nic, cm1e_sim_segment_t *segment);

#endif
