/**
 * @file clock_bench.h
 * A bus with distributed clocks on the simulated segment, on bus_support.h: a CM1-E, a drive that runs by SYNC0, and
 * another CM1-E, whose clocks drift.
 */
#ifndef CM1E_TESTS_CLOCK_BENCH_H
#define CM1E_TESTS_CLOCK_BENCH_H

#include <math.h>

#include "bus_support.h"
#include "cm1e/clocks.h"

enum { CM1E = 1, DRIVE = 2, LAST = 3, SLAVES = 3, CYCLE_NS = 1000000 };

extern int64_t plan_ns; /**< planned start of the next cycle; 0: the bus says when */

void describe(double sync0_us);
/** The drift of each clock, in ppm. */
cm1e_bus_t *open_drifting(double first, double second, double third);
cm1e_bus_t *start_drifting(double first, double second, double third);
/** Cycles as the scheduler has them: the plan follows the reference clock. */
void run(cm1e_bus_t *bus, unsigned n);

/** How much the clock of a slave is really ahead of that of the first slave. */
double ahead_ns(cm1e_bus_t *bus, uint32_t position);
cm1e_slave_clock_t clock_of(cm1e_bus_t *bus, uint16_t position);
/** As if the slave had shown this AL status code. */
void note_status(cm1e_bus_t *bus, uint16_t position, uint16_t al_status_code);
cm1e_bus_clocks_t clocks_of(cm1e_bus_t *bus);

#endif
