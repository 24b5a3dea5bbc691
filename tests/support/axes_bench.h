/**
 * @file axes_bench.h
 * Up to four axes on the fake bus, for tests of what several axes do together: the cycle of all, ways into it, and a
 * witness of every set-point. Works with Unity and with Check.
 *
 *     axes_describe(2);                            two CM1-E, 1 u = 50,000 counts, 1 ms
 *     axes_config(1)->modulo_range = 360;          what is to be different
 *     axes_make();                                 they are Disabled
 *     axes_enable_all();                           ... and in Standstill
 *     id = axes_command(1, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_GEAR_IN, ...});
 *     axes_cycles(1000);
 *
 * A cycle is: inputs of all, axes_bench.program (where there is one), outputs of all in the order of axes_bench.order.
 * After it every axis's position, velocity and acceleration must follow from those before within its limits.
 */
#ifndef CM1E_TESTS_AXES_BENCH_H
#define CM1E_TESTS_AXES_BENCH_H

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "assembly/assembly.h"
#include "axis/axis_api.h"
#include "axis/axis_backlash.h"
#include "axis/axis_commands.h"
#include "axis/axis_guard.h"
#include "axis/axis_limits.h"
#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"
#include "coupling/coupling.h"
#include "fake_bus.h"
#include "on_coupling.h"

enum { AXES_MOST = FAKE_SLAVES };

/** How strictly a set-point is judged. */
typedef enum axes_strictness {
    AXES_SMOOTH = 0, /**< velocity, acceleration and jerk within the limits, and each the derivative of the next */
    AXES_STEEP,      /**< a master by its actual value, a linear cam: velocity within the limits, position and velocity
                          change by no more than an acceleration within them does */
    AXES_UNWATCHED,
} axes_strictness_t;

typedef struct axes_witness {
    axes_strictness_t strictness;
    bool ours;                     /**< the last set-point was the axis's own */
    on_coupling_t on_coupling;
    cm1e_axis_state_t state;
    position_t set;
    double velocity, acceleration; /**< u */
    double lowest, highest;        /**< u, along the line: how far it went since axes_make() */
    double worst_step, worst_gain, worst_jerk; /**< u; largest seen in a cycle, of limits in ..._cycle */
} axes_witness_t;

struct axes_bench {
    cm1e_bus_t bus, others[AXES_MOST - 1];
    cm1e_axis_t *axes[AXES_MOST];
    int count;
    int order[AXES_MOST];          /**< of cm1e_axis_outputs() */
    int64_t cycle_ns;
    cm1e_error_t received, health;
    int owners[AXES_MOST];
    bool on[AXES_MOST];            /**< what axes_power() last said: MC_Power is called in every cycle */
    bool positive[AXES_MOST], negative[AXES_MOST];
    void (*program)(void);
    unsigned long long cycle;
    const char *run;               /**< what to say of a failure beside the cycle */
    axes_witness_t witness[AXES_MOST];
};
extern struct axes_bench axes_bench;

/** Ends the test: the run, the cycle and these words. */
__attribute__((format(printf, 1, 2))) void axes_fail(const char *format, ...);

#define AXES_MUST(condition, ...)                                                                                    \
    do                                                                                                               \
        if (!(condition))                                                                                            \
            axes_fail(__VA_ARGS__);                                                                                  \
    while (0)

/* ---- what there is ----------------------------------------------------------------------------------------------- */

/** The motor of axis n: power, faults, position, whatever a test wants of it. */
cm1e_bus_t *axes_motor(int n);
cm1e_axis_t *axes_axis(int n);
AXIS_REF_t axes_reference(int n);
/** Its configuration, from axes_describe() until the axes are gone. */
cm1e_axis_config_t *axes_config(int n);
cm1e_axis_info_t axes_info(int n);
cm1e_axis_state_t axes_state(int n);
const char *axes_text(int n);

/** These words are in its text. */
void axes_told(int n, const char *words);
void axes_must_be(int n, cm1e_axis_state_t state);

/* ---- the cycle --------------------------------------------------------------------------------------------------- */

/** The part of a cycle before the programs. */
void axes_inputs(void);
/** The part of a cycle after the programs. */
void axes_outputs(void);
void axes_cycles(int count);

#define AXES_UNTIL(condition)                                                                                        \
    do {                                                                                                             \
        int cycles_left = 20000;                                                                                     \
        do                                                                                                           \
            axes_cycles(1);                                                                                          \
        while (!(condition) && --cycles_left);                                                                       \
        AXES_MUST(cycles_left > 0, "line %d: never " #condition, __LINE__);                                          \
    } while (0)

/* ---- beginnings -------------------------------------------------------------------------------------------------- */

void axes_end(void);

/** So many CM1-E, not made into axes yet; ends those before. */
void axes_describe(int count);

/** Makes the axes of axes_bench.bus.config. */
void axes_make(void);

/** The axis has been going on and on: its counter is so many times 2^32 counts away. While it is Disabled. */
void axes_start_far(int n, int64_t wraps);
void axes_power(int n, bool enable);
void axes_enable(int n);
void axes_enable_all(void);

/** `count` axes as they are by default, in Standstill. */
void axes_begin(int count);

/* ---- commands ---------------------------------------------------------------------------------------------------- */

/** Starts a command that is to be taken. */
cm1e_command_id_t axes_command(int n, const cm1e_axis_command_t *command);

/** Starts a command that is to be refused so. */
void axes_refused(int n, const cm1e_axis_command_t *command, cm1e_error_t expected);
cm1e_command_id_t axes_move_velocity(int n, double velocity);
cm1e_command_id_t axes_move_to(int n, double position, double velocity);
cm1e_command_status_t axes_status(int n, cm1e_command_id_t id);
cm1e_command_id_t axes_gear_in(int n, int master, int32_t numerator, uint32_t denominator);

/** Cycles until the command is no longer active, `at_most` of them; how many it took. */
int axes_wait(int n, cm1e_command_id_t id, int at_most);

/** Waits until a command has reached its goal (InGear, InSync, InVelocity). */
void axes_wait_reached(int n, cm1e_command_id_t id, int at_most);

#endif
