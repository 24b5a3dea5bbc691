/**
 * @file two_buses.h
 * Two simulated buses in one scheduler, on virtual time.
 */
#ifndef CM1E_TESTS_TWO_BUSES_H
#define CM1E_TESTS_TWO_BUSES_H

#include "core/clock.h"
#include "machine.h"

enum { A = 0, B, BUSES };

extern cm1e_bus_t *buses[BUSES];
extern cm1e_scheduler_t *scheduler;
extern AXIS_REF_t axes[BUSES]; /**< the first axis of each bus that has one axis */
extern cm1e_diag_t diag;

/** No error; else the text of `diag` is told. */
void must(cm1e_error_t error);
cm1e_axis_info_t see(int i);
void simulate(int bus, const char *line);
/** Puts both buses, which are started, into a scheduler. */
void open_scheduler(void);
/** Closes the scheduler and both buses. */
void close_all(void);

#endif
