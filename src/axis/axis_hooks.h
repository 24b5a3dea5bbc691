/**
 * @file axis_hooks.h
 * The functions of rooms above the axis that the axis calls, as tables. Such a room adds its table when an axis is made
 * (src/assembly). An axis without the table does not have these functions. All run in the cycle unless marked
 * otherwise.
 */
#ifndef CM1E_AXIS_AXIS_HOOKS_H
#define CM1E_AXIS_AXIS_HOOKS_H

#include "axis/axis_move.h"

/** What a room keeps of an axis, for a copy of the axis whose text another thread makes (axis_watch.h). */
typedef struct own_copy {
    size_t bytes;
    /** Copies it to `place`, with all that its texts follow by pointers, and lets `copy` have that. */
    void (*make)(const cm1e_axis_t *axis, cm1e_axis_t *copy, void *place);
} own_copy_t;

/** Functions that only a motor behind a bridge has (src/bridge): modes without motion, and the way back from them. */
typedef struct motor_hooks {
    void (*free)(cm1e_axis_t *axis);               /**< @rt init */
    /** Called after the programs and before power is handled. */
    void (*step)(cm1e_axis_t *axis);
    /** Whether the motor may be enabled: it is in the axis's own mode, or switches to it. */
    bool (*is_home)(const cm1e_axis_t *axis);
    /** CM1E_OK, or why MC_Power cannot enable the motor, however long it waits. */
    cm1e_error_t (*refuses_power)(cm1e_axis_t *axis);
    /** CM1E_OK, or why MC_Home is not possible. */
    cm1e_error_t (*refuses_homing)(cm1e_axis_t *axis);
    /** At the end of a run: whether neither CML nor CMD moves the motor any more; true at the latest 2 s after the
     *  first call. */
    bool (*released)(cm1e_axis_t *axis);
    /** Explains an error of these functions; false: it is no such error. */
    bool (*text)(const cm1e_axis_t *axis, cm1e_error_t error, char *text, size_t size);
    own_copy_t own;
} motor_hooks_t;

/** Couplings (src/coupling): the masters and the slaves of the axis. The functions from `first_set_point` on are called
 *  only while the axis follows (axis_follows()). */
typedef struct coupling_hooks {
    const command_method_t *methods; /**< by command_plan_t; without `start`: not theirs */
    void (*free)(cm1e_axis_t *axis); /**< @rt init */
    own_copy_t own;
    /** Called with the inputs of every cycle, if a slave may follow the actual value (cm1e_axis_t.observed). */
    void (*observe)(cm1e_axis_t *axis);
    /** Called before the set-point, while the axis follows or awaits a master: the masters make theirs first. */
    void (*advance_masters)(cm1e_axis_t *axis);
    /** Called after the set-point, while a waiting command awaits its master (cm1e_axis_t.awaits). */
    void (*await_step)(cm1e_axis_t *axis);
    /** No master is awaited any more. */
    void (*await_nothing)(cm1e_axis_t *axis);
    /** Called after a pause of `pause_ns`, or after silence (0). Masters begin anew before their slave, slaves after
     *  their master. */
    void (*resume_masters)(cm1e_axis_t *axis, int64_t pause_ns);
    void (*resume_slaves)(cm1e_axis_t *axis);
    /** Called when the velocity of the axis has changed by a step, before its set-point: the slaves catch up. */
    void (*begin_slaves_anew)(cm1e_axis_t *axis);
    /** Called before any axis makes its set-point, while the axis follows: masters on another bus may be silent. */
    void (*look_across)(cm1e_axis_t *axis);
    /** Called in place of the set-point, while the axis follows and its bus is silent. */
    void (*held)(cm1e_axis_t *axis);
    /** Ends running and waiting phase shifts. */
    void (*phasing_end)(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error);
    /** The status of a phase shift; false: `id` neither runs nor waits. */
    bool (*phasing_status)(const cm1e_axis_t *axis, cm1e_command_id_t id, cm1e_command_status_t *status);
    /** The distance that the last ended phase shift covered; 0: `id` is another command. */
    double (*phasing_covered)(const cm1e_axis_t *axis, cm1e_command_id_t id);
    /** Explains why a command was refused (`refused`) or the axis has failed; false: it is no error of couplings.
     *  CM1E_OK: why the axis does not get in step; false: nothing keeps it from that. */
    bool (*text)(const cm1e_axis_t *axis, cm1e_error_t error, bool refused, char *text, size_t size);
    /** Explains what is wrong with the cam that was refused last. */
    void (*cam_text)(const cm1e_axis_t *axis, char *text, size_t size);

    /** Another axis follows it, or waits for it. */
    bool (*is_followed)(const cm1e_axis_t *axis);

    /** u/s: the velocity that the filter of the actual value has estimated; 0 before its first value. */
    double (*observed_velocity)(const cm1e_axis_t *axis);

    /** Makes the set-point of the cycle in which the coupling has begun, without advancing the masters. */
    void (*first_set_point)(cm1e_axis_t *axis);
    /** Whether waiting commands may begin when the command has reached its aim. */
    bool (*hands_over)(const cm1e_axis_t *axis);
    /** Makes a superimposed distance (u) a part of the base motion. */
    void (*shift)(cm1e_axis_t *axis, double way);
    /** Whether the axis follows an actual value. */
    bool (*by_actual)(const cm1e_axis_t *axis);
    /** After a pause or silence: whether it has to begin anew with its masters. */
    bool (*begins_anew)(const cm1e_axis_t *axis);
    /** Looks at the masters in a cycle in which the axis does not step with them; true: it has to stop. */
    bool (*sees_trouble)(cm1e_axis_t *axis);
    /** Whether the axis, in ErrorStop, follows its masters to their standstill. */
    bool (*stops_with_masters)(const cm1e_axis_t *axis);
    /** Called when the axis has failed: stops the other axes that have to stop. */
    void (*failed)(cm1e_axis_t *axis);
} coupling_hooks_t;

/** Homings (src/homing): by the drive, a source of set-points, and in steps (Part 5), which move by profiles. */
typedef struct homing_hooks {
    const command_method_t *methods; /**< by command_plan_t; without `start`: not theirs */
    void (*free)(cm1e_axis_t *axis); /**< @rt init */
    own_copy_t own;
    /** While the drive homes: whether it has left the axis's own mode. */
    bool (*is_away)(const cm1e_axis_t *axis);
    /** Called before every set-point of a step, and of the MC_Stop that ended it: decides the profile. */
    void (*step_cycle)(cm1e_axis_t *axis);
    /** Called when the profile of a step, or of that MC_Stop, has ended. true: the step has decided what follows. */
    bool (*step_ended)(cm1e_axis_t *axis);
    /** Continues the step from the present set-point, after a pause. */
    cm1e_error_t (*step_anew)(cm1e_axis_t *axis);
    /** Explains why a homing has failed, was refused, or was not finished; false: it was no homing. */
    bool (*failed_text)(const cm1e_axis_t *axis, char *text, size_t size);
    bool (*refused_text)(const cm1e_axis_t *axis, char *text, size_t size);
    bool (*not_finished_text)(const cm1e_axis_t *axis, char *text, size_t size);
} homing_hooks_t;

/** What the axis has to know of a step of a homing. Written by homing_steps.c, axis_free.c and axis_power.c. */
typedef struct homing_step {
    bool pushing;    /**< the set-point may be beyond a stop, where the motor cannot go */
    bool after_stop; /**< MC_Stop ended a step, and the motor is relieved before it is Done */
    bool finishing;  /**< the step ends the homing: positions are valid again, software limits hold */
} homing_step_t;

/** How motions report to the commands. axis.c has the only table of this type. So a motion need not know commands. */
typedef struct axis_events {
    /** The motion cannot go on: ErrorStop, with a ramp no harder than this one. */
    void (*failed)(cm1e_axis_t *axis, cm1e_error_t error, double value, double bound, const cm1e_motion_limits_t *ramp);
    /** Begins the first waiting command that can begin at `from`. The commands before it fail. false: none could begin.
     *  */
    bool (*begin_waiting)(cm1e_axis_t *axis, const from_t *from, double offset_s);
    const command_method_t *methods; /**< by command_plan_t; of the axis itself */
} axis_events_t;

#endif
