/**
 * @file units_log.h
 * What the axes of axes_bench.h do in each cycle, for tests that run the same program in other units of length. A power
 * of two changes no digit, so every count and every number has to be the same. The test gets its own cbrt() with this.
 * A unit below 0 is the mirror: each axis is inverted, and so are all positions of the program, while sizes stay. Then
 * the counts are the same but for rounding.
 *
 *     for (int run = 0; run < UNITS_COUNT; run++) {
 *         units_begin(run, units[run]); then a revolution of a motor is `in_units` u
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

/** u in one revolution of a motor. */
extern double in_units;

/** A program of some cycles. */
typedef struct units_program {
    void (*begin)(void);
    void (*cycle)(void);
    int cycles;
} units_program_t;

/** Runs it with this seed in each of the units, or, as `mirror`, in one and its negative: all has to be as in the first. */
void units_compare(const units_program_t *program, int seed, bool mirror);

bool mirrored(void);

/** The unit of all axes, between axes_describe() and axes_make(). */
void units_describe(void);

void units_note(double number);

void units_cycle(void);

/** Positions, and velocities with a sign: revolutions, 1/s and so on in u. */
double in(double base);

/** Limits, tolerances and velocities without a sign. */
double size(double base);

/** Evenly over the decades. */
double decade(double low, double high);

/** A size that is not given, or this. */
double or_default(double base);

#endif
