/**
 * @file blocks_subject.h
 * What bench_blocks asks of an implementation of function blocks, so that it can time this library and another one with
 * the same moves in one process. The other one comes as a shared library that exports `blocks_subject`.
 * Units: u, s; the cycle is 1 ms.
 */
#ifndef CM1E_BENCH_BLOCKS_SUBJECT_H
#define CM1E_BENCH_BLOCKS_SUBJECT_H

#include <stdbool.h>
#include <stddef.h>

typedef struct blocks_move {
    double position, velocity, acceleration, deceleration, jerk;
} blocks_move_t;

/** The largest values of the bench's moves. */
enum { BLOCKS_VELOCITY = 300, BLOCKS_ACCELERATION = 3000, BLOCKS_JERK = 60000, BLOCKS_MAX_AXES = 256 };

typedef struct blocks_subject {
    const char *name;
    /** Makes the axes, each with its MC_Power and MC_MoveAbsolute, powered, at rest at 0. */
    bool (*make)(unsigned axes);
    /** Inputs of an axis's MC_MoveAbsolute; the next cycle sees a rising edge of Execute. */
    void (*give)(unsigned axis, const blocks_move_t *move);
    /** That many cycles of the first `axes` axes: MC_Power and MC_MoveAbsolute called, then the axis's own work. */
    void (*run)(unsigned axes, unsigned cycles);
    bool (*done)(unsigned axis);
    bool (*failed)(unsigned axis);
    /** Bytes taken from the heap since the start of the process. */
    size_t (*heap_bytes)(void);
    size_t axis_bytes, power_bytes, move_bytes;
} blocks_subject_t;

#endif
