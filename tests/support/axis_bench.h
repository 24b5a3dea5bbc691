/**
 * @file axis_bench.h
 * One axis on the fake bus, for unit tests of the axis room: the cycle, and ways into each state.
 */
#ifndef CM1E_TESTS_AXIS_BENCH_H
#define CM1E_TESTS_AXIS_BENCH_H

#include <string.h>

#include "assembly/assembly.h"
#include "axis/axis_api.h"
#include "axis/axis_backlash.h"
#include "axis/axis_commands.h"
#include "axis/axis_device.h"
#include "axis/axis_events.h"
#include "axis/axis_guard.h"
#include "axis/axis_limits.h"
#include "axis/axis_plan.h"
#include "axis/axis_position.h"
#include "axis/axis_power.h"
#include "axis/axis_setpoint.h"
#include "coupling/coupling.h"
#include "unity.h"

#include "fake_bus.h"

extern const int64_t cycle_ns;
extern cm1e_bus_t bus;
extern cm1e_axis_t *axis;
extern cm1e_error_t received, health;
extern int owner;

/** The largest since bench_forget_steps(), in counts: a step of the target between two cycles, and its change. */
extern int64_t worst_step, worst_change;

void bench_forget_steps(void);

/** The part of a cycle before the programs. */
void bench_inputs(void);
/** The part of a cycle after the programs. */
void bench_outputs(void);
void bench_cycles(int n);
void bench_end(void);

/** Makes the axis from bus.config. */
void bench_create(void);
void bench_start(void);
cm1e_axis_info_t bench_info(void);

/** These words are in the axis's text. */
void bench_told(const char *words);
void bench_power(bool enable);
void bench_enable(void);
/** Makes the axis with these software limits (u) and enables it. */
void bench_enable_within(double negative, double positive);
cm1e_command_id_t bench_start_command(const cm1e_axis_command_t *command);
/** The error of a command that may be refused. */
cm1e_error_t bench_try_command(const cm1e_axis_command_t *command);
cm1e_command_id_t bench_move_to(double position, double velocity);
cm1e_command_id_t bench_move_by(double distance, double velocity);
cm1e_command_id_t bench_move_velocity(double velocity);
cm1e_command_state_t bench_state_of(cm1e_command_id_t id);

/** Cycles until the command is no longer active, `at_most` of them; how many it took. */
int bench_wait(cm1e_command_id_t id, int at_most);

#endif
