/**
 * @file block_bench.h
 * Any block of the block table on one axis, with a drive without frames (fake_bus.h) behind it: fast enough for every
 * pair of blocks in every buffer mode, and for millions of cycles.
 */
#ifndef CM1E_TESTS_BLOCK_BENCH_H
#define CM1E_TESTS_BLOCK_BENCH_H

#include "block_judge.h"
#include "fake_bus.h"

struct bench {
    cm1e_bus_t bus, master_bus;
    bool with_master;               /**< a second axis, which its slaves' blocks name as their master */
    cm1e_axis_t *master;            /**< NULL: there is none */
    MC_Power_t power, master_power;
    cm1e_error_t received, health;
    cm1e_axis_info_t info;          /**< after the last cycle */
    int homing_cycles;              /**< what the drive's own homing takes */
    int homing_cycle;               /**< -1: none runs */
};
extern struct bench bench;

/* ---- the cycle --------------------------------------------------------------------------------------------------- */

void cycle_begin(void);
void cycle_end(void);

/** A whole cycle: MC_Power, then all blocks that were made, in the order of their making. */
void cycle(void);
void cycles(int count);

/* ---- beginnings -------------------------------------------------------------------------------------------------- */

/** Brings the axis into a state, where need be by a block of that name, `mover`. */
void into_by(cm1e_axis_state_t state, instance_t *mover, const char *name);
void into(cm1e_axis_state_t state, instance_t *mover);

#endif
