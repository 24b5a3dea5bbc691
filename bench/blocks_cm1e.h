/** @file blocks_cm1e.h This library as subjects of bench_blocks, which work on the same axes. */
#ifndef CM1E_BENCH_BLOCKS_CM1E_H
#define CM1E_BENCH_BLOCKS_CM1E_H

#include "blocks_subject.h"

/** Function blocks, state machine and trajectory; and with the drive below; and with the buses, frames included. */
extern const blocks_subject_t blocks_cm1e, blocks_cm1e_whole, blocks_cm1e_cycle;

/** Bytes taken from the heap since the start of the process: count_heap.c counts them. */
size_t blocks_heap_bytes(void);

#endif
