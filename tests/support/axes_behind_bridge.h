/**
 * @file axes_behind_bridge.h
 * The axes of an EB12 on axis_segment.h: CM1 at connectors 1 and 2, CM2 at 3 and 4. Through the real bus and the real
 * frames, on virtual time.
 */
#ifndef CM1E_TESTS_AXES_BEHIND_BRIDGE_H
#define CM1E_TESTS_AXES_BEHIND_BRIDGE_H

#include "sim/bridge_app.h"

#include "axis_segment.h" /* behind the others: it makes a macro of `axis` */

enum { AXES = CM1E_BRIDGE_AXES, CM1 = 0, CM2 = 2 }; /**< CM1, CM2: an axis with each kind of motor */

void describe_bridge(void);
void open_enabled(void);
void enable_all(void);
void power_of(int n, bool on);

cm1e_sim_bridge_axis_t *motor(int n);
/** Counts. */
double shaft(int n);

cm1e_command_id_t start_of(int n, const cm1e_axis_command_t *c);
cm1e_command_id_t move_of(int n, double position, double velocity);
cm1e_command_id_t home_of(int n, double position, const cm1e_homing_config_t *homing);
cm1e_command_status_t status_of(int n, cm1e_command_id_t id);
/** Cycles until the command is no longer active, or the time is over. */
cm1e_command_status_t wait_for(int n, cm1e_command_id_t id, double seconds);
/** The command is Done within this time. */
void finish(int n, cm1e_command_id_t id, double seconds);
/** These words are in the text of the axis. */
void told(int n, const char *words);

/** Ways in which a motor fails, 0 ... FAULTS - 1, and the way back to Standstill. */
enum { FAULTS = 5 };
void fault_of(int n, int fault);
void repair(int n, int fault);

#endif
