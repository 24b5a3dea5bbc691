/**
 * @file axis_hooks.h
 * What the axis asks of rooms above it, as tables of functions. Such a room adds itself to an axis when that is made
 * (src/assembly); an axis without it does the rest. All of it runs in the cycle unless marked otherwise.
 */
#ifndef CM1E_AXIS_AXIS_HOOKS_H
#define CM1E_AXIS_AXIS_HOOKS_H

#include "axis/axis_move.h"

/** What only a motor behind a bridge has (src/bridge): other modes than those of motion, and the way back from them. */
typedef struct motor_hooks {
    void (*free)(cm1e_axis_t *axis);               /**< @rt init */
    /** Between the programs and what is done about power. */
    void (*step)(cm1e_axis_t *axis);
    /** The motor is in the axis's own mode, or on its way there: it may be enabled. */
    bool (*is_home)(const cm1e_axis_t *axis);
    /** CM1E_OK, or why MC_Power cannot enable the motor, however long it waits. */
    cm1e_error_t (*refuses_power)(cm1e_axis_t *axis);
    /** CM1E_OK, or why MC_Home cannot be. */
    cm1e_error_t (*refuses_homing)(cm1e_axis_t *axis);
    /** At the end of a run: neither CML nor CMD moves the motor any more. TRUE 2 s after the first call. */
    bool (*released)(cm1e_axis_t *axis);
    /** What was refused or has failed; FALSE: this error is not one of those. */
    bool (*text)(const cm1e_axis_t *axis, cm1e_error_t error, char *text, size_t size);
} motor_hooks_t;

/** Couplings (src/coupling): what the axis follows, and who follows it. Those from `first_set_point` on are called
 *  only while the axis follows (axis_follows()). */
typedef struct coupling_hooks {
    const command_method_t *methods; /**< by command_plan_t; without `start`: not theirs */
    void (*free)(cm1e_axis_t *axis); /**< @rt init */
    /** With the inputs of every cycle in which somebody may follow its actual value (cm1e_axis_t.observed). */
    void (*observe)(cm1e_axis_t *axis);
    /** Before the set-point, while it follows or awaits: those that it follows make theirs first. */
    void (*advance_masters)(cm1e_axis_t *axis);
    /** After the set-point, while a waiting command awaits its master (cm1e_axis_t.awaits). */
    void (*await_step)(cm1e_axis_t *axis);
    /** Nothing is awaited any more. */
    void (*await_nothing)(cm1e_axis_t *axis);
    /** After a pause of so long, or silence (0): masters begin anew before their slave, slaves after their master. */
    void (*resume_masters)(cm1e_axis_t *axis, int64_t pause_ns);
    void (*resume_slaves)(cm1e_axis_t *axis);
    /** Running and waiting phase shifts end. */
    void (*phasing_end)(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error);
    /** FALSE: `id` is not a phase shift that runs or waits. */
    bool (*phasing_status)(const cm1e_axis_t *axis, cm1e_command_id_t id, cm1e_command_status_t *status);
    /** Of the last one that has ended; 0: it was another command. */
    double (*phasing_covered)(const cm1e_axis_t *axis, cm1e_command_id_t id);
    /** What was refused (`refused`), or has failed; FALSE: this error is not one of couplings. */
    bool (*text)(const cm1e_axis_t *axis, cm1e_error_t error, bool refused, char *text, size_t size);
    /** What is wrong with the cam that was refused last. */
    void (*cam_text)(const cm1e_axis_t *axis, char *text, size_t size);

    /** The set-point of the cycle in which the coupling has begun, without going on. */
    void (*first_set_point)(cm1e_axis_t *axis);
    /** Commands that wait may begin now that the command has reached what it was to reach. */
    bool (*hands_over)(const cm1e_axis_t *axis);
    /** What was superimposed for so long has become part of the way; u. */
    void (*shift)(cm1e_axis_t *axis, double way);
    /** What is followed is an actual value. */
    bool (*by_actual)(const cm1e_axis_t *axis);
    /** After a pause or silence: whether it has to begin anew with its masters. */
    bool (*begins_anew)(const cm1e_axis_t *axis);
    /** In ErrorStop it follows its masters to their standstill. */
    bool (*stops_with_masters)(const cm1e_axis_t *axis);
    /** It has failed: what else stops. */
    void (*failed)(cm1e_axis_t *axis);
} coupling_hooks_t;

/** Homings (src/homing): by the drive, a source of set-points, and in steps (Part 5), which move by profiles. */
typedef struct homing_hooks {
    const command_method_t *methods; /**< by command_plan_t; without `start`: not theirs */
    void (*free)(cm1e_axis_t *axis); /**< @rt init */
    /** While the drive homes: the axis's own mode is left. */
    bool (*is_away)(const cm1e_axis_t *axis);
    /** Before every set-point of a step, and of the MC_Stop that ended one: decides what the profile is. */
    void (*step_cycle)(cm1e_axis_t *axis);
    /** The profile of a step, or of that MC_Stop, has come to its end. TRUE: what comes next is decided. */
    bool (*step_ended)(cm1e_axis_t *axis);
    /** After a pause: the step goes on from the present set-point as it was about to. */
    cm1e_error_t (*step_anew)(cm1e_axis_t *axis);
    /** What has failed, was refused, or has ended with an error; FALSE: it was not a homing. */
    bool (*failed_text)(const cm1e_axis_t *axis, char *text, size_t size);
    bool (*refused_text)(const cm1e_axis_t *axis, char *text, size_t size);
    bool (*not_finished_text)(const cm1e_axis_t *axis, char *text, size_t size);
} homing_hooks_t;

/** What a homing in steps tells the axis of the step that runs. Written by homing_steps.c, axis_free.c and
 *  axis_power.c. */
typedef struct homing_step {
    bool pushing;    /**< the set-point may be where the motor cannot go */
    bool after_stop; /**< MC_Stop ended a step, and the motor is relieved before it is Done */
    bool finishing;  /**< the step ends the homing: positions are valid again, software limits hold */
} homing_step_t;

/** What motions tell those that command them (axis.c has the one table): so a motion need not know commands. */
typedef struct axis_events {
    /** It cannot go on: ErrorStop, braked no harder than by this ramp. */
    void (*failed)(cm1e_axis_t *axis, cm1e_error_t error, double value, double bound, const cm1e_motion_limits_t *ramp);
    /** The first waiting command that can begin there does; those before it fail. FALSE: none could. */
    bool (*begin_waiting)(cm1e_axis_t *axis, const from_t *from, double offset_s);
    const command_method_t *methods; /**< by command_plan_t; of the axis itself */
} axis_events_t;

#endif
