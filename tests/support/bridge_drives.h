/**
 * @file bridge_drives.h
 * The four drives behind one simulated bridge (EB12: CM1 at ID1 and ID2, CM2 at ID3 and ID4) through the real bus, with
 * bridge_wire.h at the tap, on virtual time.
 */
#ifndef CM1E_TESTS_BRIDGE_DRIVES_H
#define CM1E_TESTS_BRIDGE_DRIVES_H

#include <math.h>

#include "bridge_wire.h"
#include "drive/drive.h"

enum { DRIVES = CM1E_BRIDGE_AXES, DRIVES_CYCLE_NS = 1000000 };
extern cm1e_bus_t *bus;
extern cm1e_drive_t drives[DRIVES];
extern void (*each_cycle)(void); /**< after the inputs; NULL: nothing */

cm1e_sim_bridge_axis_t *motor(int n);
void open_drives(void);
void close_drives(void);
int64_t now_ns(void);
void cycles(int count);
const char *drive_text(int n);
void simulate(const char *format, int n);

/** Commands a mode and waits for it. */
void reach_mode(int n, int mode);
void enable_drive(int n);

#endif
