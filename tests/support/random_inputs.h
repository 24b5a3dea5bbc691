/**
 * @file random_inputs.h
 * Random inputs of any block: mostly what makes sense on the axis, now and then what makes none at all.
 */
#ifndef CM1E_TESTS_RANDOM_INPUTS_H
#define CM1E_TESTS_RANDOM_INPUTS_H

#include "block_judge.h"

/** What makes sense on an axis, in its units. */
typedef struct ranges {
    double reach, velocity, acceleration, deceleration, jerk;
} ranges_t;

double absurd(double sensible);

/** Inputs of `fb` but its trigger: all of them, or one. */
void random_inputs(instance_t *fb, const ranges_t *axis, bool all);

#endif
