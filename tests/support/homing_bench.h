/**
 * @file homing_bench.h
 * Homing in steps (Part 5) on axis_bench.h: a switch, two limit switches and two stops on the shaft of the fake drive.
 * It has setUp() and tearDown() of its tests: every switch and stop is there, with normally open contacts.
 */
#ifndef CM1E_TESTS_HOMING_BENCH_H
#define CM1E_TESTS_HOMING_BENCH_H

#include "axis_bench.h"

enum { HOME_INPUT = 1, POSITIVE_INPUT, NEGATIVE_INPUT };
/** Places on the shaft, in counts. LIMIT_SWITCH and STOP are there on the negative side too. */
enum { LEFT_FLANK = -5000, RIGHT_FLANK = 5000, LIMIT_SWITCH = 40000, STOP = 60000 };

extern bool switch_there, limits_there, stops_there;
extern int32_t before; /**< position of the shaft in the cycle before */
extern cm1e_homing_step_t step; /**< what start(), refusal() and command_of() take */

/** The shaft ends at the stops. The torque is 0.1 % for each count that is missing to the target. */
void world(cm1e_bus_t *b);
void configure(bool normally_closed);
/** The motor stands at `position` (counts), and the axis is in Standstill. */
void begin_at(int32_t position);

cm1e_homing_step_t block(int sign, double torque);
cm1e_axis_command_t command_of(double velocity, double position);
cm1e_command_id_t start(double velocity, double position);
/** The error with which the axis refuses the step, which changes nothing. */
cm1e_error_t refusal(double velocity, double position);
/** A search for the left flank of the switch, to its end. */
void find_left_flank(double set_position);

void expect(cm1e_command_id_t id, cm1e_command_state_t state, cm1e_error_t error);
/** The set-point kept the limits of the axis: 5,000,000 counts/s2, and the velocity. */
void expect_smooth(double velocity);
/** The motor rests, and nothing pushes. */
void expect_standing(void);
/** `counts` of the shaft are called `units` now, but for half the way of a cycle. */
void expect_called(int32_t counts, double units, double velocity);

#endif
