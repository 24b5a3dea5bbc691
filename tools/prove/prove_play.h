/**
 * @file prove_play.h
 * Device profiles as files (JSON, written by `cm1e prove`): a simulated slave behaves as the device of one.
 */
#ifndef CM1E_TOOLS_PROVE_PLAY_H
#define CM1E_TOOLS_PROVE_PLAY_H

#include <stdbool.h>
#include <stdint.h>

#include "cm1e/sim.h"

/** Makes the slave at `position` play the profile in a file; false after a complaint that names what is wrong. */
bool play_profile(cm1e_sim_segment_t *segment, uint32_t position, const char *path);

#endif
