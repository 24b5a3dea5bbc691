/**
 * @file block_judge.h
 * Any block of the block table on one axis, and what every call of it is judged by: what PLCopen Part 1 v2.0, 2.4.1
 * says of its outputs, and the block's rules of states.
 */
#ifndef CM1E_TESTS_BLOCK_JUDGE_H
#define CM1E_TESTS_BLOCK_JUDGE_H

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assembly/assembly.h"
#include "axis/axis_api.h"
#include "axis/axis_backlash.h"
#include "axis/axis_plan.h"
#include "axis/axis_position.h"
#include "axis/axis_setpoint.h"
#include "coupling/coupling_private.h"
#include "block_table.h"
#include "group/group_private.h"
#include "quick_check.h"
#include "on_coupling.h"

enum { BLOCK_BYTES = 4096, BLOCKS_MOST = 160, JUDGED_MOST = 4, INSTANCES_MOST = JUDGED_MOST * BLOCKS_MOST };

/** Where the members are that many blocks have; NOWHERE: this one has not. */
enum { NOWHERE = 0xFFFF };
typedef struct block_view {
    const block_t *type;
    uint16_t execute, enable, done, reached, busy, active, aborted, error, error_id, valid, axis, group, buffer_mode;
} block_view_t;

/** What a block shows after a call. */
typedef struct shown {
    bool trigger, done, reached, busy, active, aborted, error, valid;
    WORD error_id;
} shown_t;

/** One block that a program calls. */
typedef struct instance {
    const block_view_t *view;
    shown_t now, before;
    bool refused;             /**< the last edge was refused */
    int of;                   /**< which axis it is about; see judged_at */
    _Alignas(16) unsigned char memory[BLOCK_BYTES];
} instance_t;

/** The axes that are judged. */
struct judged_axis {
    cm1e_axis_t *axis;
    AXIS_REF_t reference;
    AXIS_REF_t master;              /**< what its slaves' blocks name as their masters */
    cm1e_axis_state_t state;        /**< last judged */
    bool reset_asked;               /**< since ErrorStop */
    bool searched;                  /**< a call of this cycle found or left it in Homing, which may end in the cycle */
    bool kept;                      /**< it goes on for as long as a block renews it (MC_Jog) */
    bool stopped;                   /**< the calls of this cycle left it in a stop, which may end in the cycle too */
    bool waited;                    /**< a command did, maybe of a block that has lost it by an error of its own */
    bool led;                       /**< by an axes group, when it was judged last */
    long long number;               /**< of the cycle */
    int64_t cycle_ns;
    char scene[200];                /**< which run this is, for messages */
};
extern struct judged_axis judged_axes[JUDGED_MOST];
/** The present one: call() selects the one of its block. Most tests have only the first one. */
extern int judged_at;
#define judged judged_axes[judged_at]

extern instance_t *called[INSTANCES_MOST];
extern int called_count;

__attribute__((format(printf, 1, 2), noreturn)) void bench_fail(const char *format, ...);

/** An assertion of Check that holds costs a system call; this one does not. */
#define MUST(condition, ...)                                                                                         \
    do {                                                                                                             \
        if (!(condition))                                                                                            \
            bench_fail(__VA_ARGS__);                                                                                 \
    } while (0)

/* ---- members ----------------------------------------------------------------------------------------------------- */

const block_member_t *member_of(const block_t *type, const char *name);
uint16_t place_of(const block_t *type, const char *name);
const block_view_t *view_of(const char *name);
bool flag(const instance_t *fb, uint16_t place);
const char *name_of(const instance_t *fb);

/** Sets an input whatever its type; a block without it is left alone. */
void put(instance_t *fb, const char *name, double value);
double real_of(const instance_t *fb, const char *name);
void point_at(instance_t *fb, const char *name, const void *what);

/* ---- judging one call -------------------------------------------------------------------------------------------- */

/** The axes group of a block of Part 4; NULL: it is a block of an axis, or names none. */
const cm1e_group_t *group_of(const instance_t *fb);
void call(instance_t *fb);

/* ---- watching the set-point -------------------------------------------------------------------------------------- */

struct watched_axis {
    on_coupling_t on_coupling;
    bool ours;                 /**< the set-point was the axis's own */
    position_t set;
    double velocity, acceleration;
    bool searched;             /**< a homing, or the stop that ended it */
    bool rough;                /**< it followed roughly, and has not been at rest since */
    bool hard;                 /**< it had no limit of jerk */
    bool resting;
    cm1e_motion_limits_t maximum, most; /**< of the axis; largest since it was at rest */
    bool lost;                 /**< the motor did not follow it */
    bool disabled;
    double units;              /**< u; what its position was called */
    double far;                /**< u; largest_number() */
    double lower, upper;       /**< u; software limits */
    double lowest, highest;    /**< u; where it may be */
    unsigned long long moving; /**< cycles */
    unsigned long long ramps;  /**< of motors that turned when they got their torque */
};
extern struct watched_axis watched_axes[JUDGED_MOST];
#define watched watched_axes[judged_at]

bool set_point_is_ours(void);

/** The master was late by so much: the motor stands, or in CSV has gone on. */
void pause_of_master(int64_t pause_ns);

/** No limit of the axis is exceeded, nothing jumps: position, velocity and acceleration of two cycles fit together. A
 *  ramp of ErrorStop has no limit of jerk, and may begin anew where the motor is; nor has a stop that would else run
 *  over a software limit. A set-point that the motor has lost may be found again where the motor is; so may that of an
 *  axis that is enabled again before its torque was gone. */
void watch_set_point(void);

/* ---- the cycle --------------------------------------------------------------------------------------------------- */

/** The transitions of figure 2 that happen between calls; a command that waited may begin there too. */
void judge_cycle(void);

/* ---- making blocks ----------------------------------------------------------------------------------------------- */

extern const MC_CAM_POINT cam_points[];

/** No blocks yet, all to come on judged.reference. */
void begin_blocks(void);

/** What a slave needs before it can follow: a cam, and a point of synchronisation that lies before both axes. */
void put_in_reach(instance_t *fb, const char *name);

/** For what waits behind another one that has its point there: a point of synchronisation farther on. */
void put_out_of_reach_of_another(instance_t *fb);

/** The axis that it is about. */
void point_at_axis(instance_t *fb, const AXIS_REF_t *axis);

/** A block with inputs that make sense, zeroed beside; it is called in every cycle from now on. */
void make(instance_t *fb, const char *name);
void trigger(instance_t *fb, bool on);

#endif
