/**
 * @file units_log.h
 * What the axes of axes_bench.h do in each cycle, for tests that run the same program in other units of length. A power
 * of two changes no digit, so every count and every number has to be the same. The test gets its own cbrt() with this.
 *
 *     for (int run = 0; run < UNITS_COUNT; run++) {
 *         units_begin(run);            then a revolution of a motor is `in_units` u
 *         axes_describe(2);
 *         units_describe();
 *         ...
 *         units_note(error);           what else has to be the same in this cycle
 *         units_cycle();               the first run is written down, the others are compared with it
 *     }
 */
#ifndef CM1E_TESTS_UNITS_LOG_H
#define CM1E_TESTS_UNITS_LOG_H

#include "axes_bench.h"

enum { UNITS_COUNT = 4, UNITS_NOTES = 24 };

/** u in one revolution of a motor, a power of 64. */
extern double in_units;

void units_begin(int run);

/** The unit of all axes, between axes_describe() and axes_make(). */
void units_describe(void);

void units_note(double number);

void units_cycle(void);

/** Numbers of revolutions, 1/s and so on in u. */
double in(double base);

/** Evenly over the decades. */
double decade(double low, double high);

/** An input that is not given, or this in u. */
double or_default(double base);

#endif
