/**
 * @file ordinary_witness.h
 * A witness of the short way of an ordinary cycle (axis_ordinary.c): whenever an axis takes it, a copy of the axis takes
 * the long way, and afterwards every byte of both must be the same. The benches of axes call it in place of
 * cm1e_axis_outputs(), so that all tests of the axis look at it.
 */
#ifndef CM1E_TESTS_ORDINARY_WITNESS_H
#define CM1E_TESTS_ORDINARY_WITNESS_H

#include "axis/axis_api.h"

/** How many cycles of a profile were advanced, and how many of them in the short way. */
extern unsigned long long cycles_advanced, cycles_ordinary;

/** cm1e_axis_outputs(). If both ways differ, it says where and ends the program. */
void ordinary_outputs(cm1e_axis_t *axis);

#endif
