/**
 * @file promise_bench.h
 * A machine (machine.h) whose cycle calls nothing that allocates, locks, formats, writes or sleeps. Every such function
 * that our code could call is wrapped at link time (tests/CMakeLists.txt has the list) and counted between
 * cm1e_bus_receive() and cm1e_bus_stop().
 */
#ifndef CM1E_TESTS_PROMISE_BENCH_H
#define CM1E_TESTS_PROMISE_BENCH_H

#include "machine.h"

extern machine_t machine;
extern int64_t cycle_number;

extern _Thread_local bool in_cycle;
extern bool running; /**< cm1e_scheduler_run() was called */
extern bool in_real_time; /**< the wait for the next start is where a cycle ends */
extern unsigned violations;

/** Counts the cycles. Frames are lost, slaves go and come, drives have faults. */
void acting_program(void *context);
/** Runs the machine for so long, from cycle 0 on. No cycle calls what it must not call. */
void promise_run(int64_t duration_ns);

#endif
