/**
 * @file phasing_bench.h
 * MC_PhasingAbsolute and MC_PhasingRelative (Part 1 4.8 and 4.9) on axes_bench.h: the slave sees its master shifted.
 */
#ifndef CM1E_TESTS_PHASING_BENCH_H
#define CM1E_TESTS_PHASING_BENCH_H

#include "axes_bench.h"

enum { MASTER = 0, SLAVE = 1, OTHER = 2 };

extern cm1e_axis_coupling_t seen; /**< the master that the last command of shift() names */

/** The command, with 0 for what it is not asked for. */
cm1e_axis_command_t shift(bool relative, double position, double velocity);
cm1e_command_id_t to_shift(double position, double velocity);
cm1e_command_id_t by_shift(double position, double velocity);
cm1e_command_state_t state_of(cm1e_command_id_t id);

/** A gear of this ratio, to the cycle in which the slave is in step. off() counts from here. */
void in_step(int32_t numerator, uint32_t denominator);
/** Counts of the slave between where it is and where it would be with the master at `shifted` (u) more. */
double off(double shifted);

#endif
