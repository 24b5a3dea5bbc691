/**
 * @file scan_time.h
 * The time of a scan, which the timers TON, TOF and TP use. It is the same for all blocks of a scan, and a second call
 * in a scan does not advance it. The scheduler sets it before the programs of a cycle; a thread that scans blocks
 * without a scheduler sets it itself. Each thread has its own.
 */
#ifndef CM1E_SCAN_TIME_H
#define CM1E_SCAN_TIME_H

#include "cm1e/api.h"
#include "cm1e/iec_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Sets the time of the scan that begins, in ns since any moment. It must not go back: a timer whose time goes back
 *  begins anew. @rt cycle */
CM1E_API void cm1e_scan_time_set(TIME time_ns);
/** Time of the scan of this thread in ns; 0 before the first scan. In programs of a scheduler it is the planned start
 *  of the cycle, on the clock of the bus. @rt cycle */
CM1E_API TIME cm1e_scan_time(void);

#ifdef __cplusplus
}
#endif
#endif
