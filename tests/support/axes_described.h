/**
 * @file axes_described.h
 * The simulated axes of the tests of scheduler and function blocks.
 */
#ifndef CM1E_TESTS_AXES_DESCRIBED_H
#define CM1E_TESTS_AXES_DESCRIBED_H

#include "cm1e/config.h"

/** Axes of 1000 counts a unit, hard stops 10 u to either side, homing on the negative one. */
void describe_axes(cm1e_bus_config_t *config, uint32_t axis_count);

#endif
