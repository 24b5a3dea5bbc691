/**
 * @file scan_time.h
 * The time that timers (TON, TOF, TP) go by: one time for a whole scan, so that every block of it sees the same and a
 * second call in a scan does not advance. The scheduler sets it before the programs of a cycle; a thread that scans
 * blocks without a scheduler sets it itself. Each thread has its own.
 */
#ifndef CM1E_SCAN_TIME_H
#define CM1E_SCAN_TIME_H

#include "cm1e/api.h"
#include "cm1e/iec_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The time of the scan that begins, ns since any moment. Not before the last one: a timer that sees its time go back
 *  begins anew. @rt cycle */
CM1E_API void cm1e_scan_time_set(TIME time_ns);
/** Time of this thread's scan, ns; 0 before the first one. In programs of a scheduler: planned start of the cycle on
 *  the clock of the bus. @rt cycle */
CM1E_API TIME cm1e_scan_time(void);

#ifdef __cplusplus
}
#endif
#endif
