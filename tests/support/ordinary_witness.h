/**
 * @file ordinary_witness.h
 * A witness of the short ways of an ordinary cycle (axis_ordinary.c, coupling_ordinary.c, drive_ordinary.c): whenever
 * an axis takes one, a copy of the axis takes the long way, and afterwards every byte of both, and of the outputs on the
 * wire, must be the same. The benches of axes call it in place of cm1e_axis_inputs() and cm1e_axis_outputs(), so that
 * all tests of the axis look at it. Where the guard of a led axis was decided ahead, the witness asks the guard.
 */
#ifndef CM1E_TESTS_ORDINARY_WITNESS_H
#define CM1E_TESTS_ORDINARY_WITNESS_H

#include "axis/axis_api.h"

/** How many cycles of a profile were advanced, and how many of them in the short way. How many inputs were read, and how
 *  many of them in the short way. */
extern unsigned long long cycles_advanced, cycles_ordinary, inputs_seen, inputs_ordinary;
/** How many cycles of followers were advanced, and how many of those compared in the short way. Of axes of a group: how many were
 *  decided ahead too. */
extern unsigned long long cycles_followed, cycles_followed_ordinary, cycles_led, cycles_led_ordinary, cycles_led_short;

/** One in so many calls is compared: all of axes, except in tests of a million cycles
 *  and more and with AddressSanitizer; of followers and of axes of a group
 *  one in 23, because couplings and groups are large. Of followers 1 in tests of the short way itself. */
extern unsigned axes_compared_every, followers_compared_every, led_compared_every;

/** cm1e_axis_inputs() and cm1e_axis_outputs(). If the ways differ, they say where and end the program. */
void ordinary_inputs(cm1e_axis_t *axis, cm1e_error_t received, cm1e_error_t health, int64_t now_ns);
void ordinary_outputs(cm1e_axis_t *axis);

#endif
