/**
 * @file edge.h
 * The edge logic of all blocks, once (PLCopen Part 1 v2.0, 2.4.1). A block of the Execute type asks cm1e_fb_execute()
 * what to do in this call, does it, reports the result and copies cm1e_fb_outputs(). Blocks of the Enable type do the
 * same with cm1e_fb_enable(). The axis is latched at the rising edge: giving a busy block another axis is an error of
 * the block and leaves both axes alone. All @rt cycle.
 */
#ifndef CM1E_FB_EDGE_H
#define CM1E_FB_EDGE_H

#include "axis/axis_api.h"
#include "cm1e/plcopen.h"
#include "core/rare.h"

/** Outputs of a block. While Execute is TRUE, exactly one of the last four is TRUE. */
typedef enum fb_state { FB_IDLE = 0, FB_BUSY, FB_DONE, FB_ABORTED, FB_ERROR } fb_state_t;

/** What a block of the Execute type has to do in this call. */
typedef enum fb_step {
    FB_STEP_NONE = 0,
    FB_STEP_START, /**< a rising edge: start, then cm1e_fb_started() */
    FB_STEP_POLL,  /**< busy: ask, then cm1e_fb_polled() */
} fb_step_t;

typedef struct cm1e_fb_outputs {
    BOOL done, busy, active, aborted, error;
    WORD error_id;
    BOOL reached;  /**< InVelocity and similar outputs (2.4.1): may rise and fall while Busy and Active */
    BOOL synchronizing; /**< StartSync */
    UDINT ends;    /**< number of ends of the cam profile so far */
    LREAL covered; /**< CoveredDistance, AbsolutePhaseShift, CoveredPhaseShift */
} fb_outputs_t;

/** The object of a block: an axis, or an axes group (group_edge.h). */
typedef struct fb_object {
    void *(*find)(UINT handle); /**< NULL: the handle names none */
    cm1e_error_t none;          /**< error if there is none */
} fb_object_t;

/** The step of this call. `handle` NULL: no object was given. `*object` is valid unless the step is FB_STEP_NONE. */
fb_step_t cm1e_fb_execute_on(cm1e_fb_private_t *fb, const fb_object_t *kind, const UINT *handle, BOOL execute,
                             void **object);
/** The step of this call for a block of an axis. `*axis` is valid unless the step is FB_STEP_NONE. */
fb_step_t cm1e_fb_execute(cm1e_fb_private_t *fb, const AXIS_REF_t *reference, BOOL execute, cm1e_axis_t **axis);
/** Reports the result of the start. */
void cm1e_fb_started(cm1e_fb_private_t *fb, cm1e_error_t error);
/** Reports the present status of the command. */
void cm1e_fb_polled(cm1e_fb_private_t *fb, cm1e_command_state_t state, cm1e_error_t error);
/** cm1e_fb_polled() for a block without CommandAborted: a command that another one replaced is CM1E_ERROR_CANCELLED. */
void cm1e_fb_polled_or_cancelled(cm1e_fb_private_t *fb, cm1e_command_state_t state, cm1e_error_t error);
fb_outputs_t cm1e_fb_outputs(const cm1e_fb_private_t *fb);

/** A whole block of the Execute type that is one motion command: starts it at the edge, hands on new inputs while
 *  ContinuousUpdate allows that (2.4.6: TRUE at the edge and ever since), and shows its status. A refused update is an
 *  error of the block; the motion goes on with the last good inputs. */
fb_outputs_t cm1e_fb_motion(cm1e_fb_private_t *fb, const AXIS_REF_t *reference, BOOL execute, BOOL continuous_update,
                            const cm1e_axis_command_t *command);
/** A whole block of a homing step that no motor has: `refusal` is its error at the edge. */
fb_outputs_t cm1e_fb_refused_step(cm1e_fb_private_t *fb, const AXIS_REF_t *reference, BOOL execute,
                                  cm1e_error_t refusal);
/** cm1e_fb_motion() for a motion along a table. It is locked to time and cannot be changed, so ContinuousUpdate TRUE is
 *  refused. */
fb_outputs_t cm1e_fb_table_motion(cm1e_fb_private_t *fb, const AXIS_REF_t *reference, BOOL execute,
                                  BOOL continuous_update, cm1e_command_kind_t kind, MC_BUFFER_MODE buffer_mode,
                                  const cm1e_axis_table_t *table);
/** Whether nothing has changed at the inputs: no edge, the same axis, no new inputs, and the command was the active
 *  one. */
static inline bool fb_same(const cm1e_fb_private_t *fb, const AXIS_REF_t *reference, BOOL execute)
{
    return CM1E_USUALLY(fb->state == FB_BUSY && fb->active == TRUE && fb->continuous_update == FALSE &&
                        fb->trigger_before == execute && reference && reference->Handle == fb->axis_handle);
}
/** Whether the command is also still active, so that the outputs do not change. Most calls are of this kind, and this
 *  check makes them cheap. */
static inline bool fb_stands(const cm1e_fb_private_t *fb, const AXIS_REF_t *reference, BOOL execute)
{
    return CM1E_USUALLY(fb_same(fb, reference, execute) && cm1e_axis_runs(*reference, fb->command));
}

/* Common code of the motion blocks: inputs and outputs with the names of the standard. */
#define FB_STANDS(fb) fb_stands(&(fb)->Private, (fb)->Axis, (fb)->Execute)
#define FB_DYNAMICS(fb)                                                                                              \
    .acceleration = (fb)->Acceleration, .deceleration = (fb)->Deceleration, .jerk = (fb)->Jerk
#define FB_TABLE(table, pair)                                                                                        \
    .read = (table) ? (pair) : NULL, .reference = (table), .count = (table) ? (table)->NumberOfPairs : 0,            \
    .absolute = (table) && (table)->IsAbsolute
/* Inputs of homing steps. */
#define FB_STEP_LIMITS(fb)                                                                                           \
    .torque_limit = (fb)->TorqueLimit, .distance_limit = (fb)->DistanceLimit, .time_limit_ns = (fb)->TimeLimit
#define FB_STEP_COMMAND(fb, described)                                                                               \
    .kind = CM1E_COMMAND_HOMING_STEP, .position = (fb)->SetPosition, .buffer_mode = (fb)->BufferMode,                 \
    .step = (described)
/* Outputs of motion blocks. */
#define FB_SHOW(fb, out)                                                                                             \
    ((fb)->Busy = (out).busy, (fb)->CommandAborted = (out).aborted, (fb)->Error = (out).error,                       \
     (fb)->ErrorID = (out).error_id)
#define FB_SHOW_ACTIVE(fb, out) (FB_SHOW(fb, out), (fb)->Active = (out).active)
/* Outputs of blocks without Active and CommandAborted. */
#define FB_SHOW_DONE(fb, out)                                                                                        \
    ((fb)->Done = (out).done, (fb)->Busy = (out).busy, (fb)->Error = (out).error, (fb)->ErrorID = (out).error_id)
#define FB_SHOW_READING(fb, out)                                                                                     \
    ((fb)->Valid = (out).valid, (fb)->Busy = (out).busy, (fb)->Error = (out).error, (fb)->ErrorID = (out).error_id)

/** The axis of the block, latched at its last rising edge; NULL: none. */
cm1e_axis_t *cm1e_fb_axis(const cm1e_fb_private_t *fb);
/** An error of the block itself, shown until Execute or Enable falls. */
void cm1e_fb_fail(cm1e_fb_private_t *fb, cm1e_error_t error);

/** A block of the Enable type: the object to read, or NULL if the block is disabled or in error. */
void *cm1e_fb_enable_on(cm1e_fb_private_t *fb, const fb_object_t *kind, const UINT *handle, BOOL enable);
/** A block of the Enable type: the axis to read, or NULL if the block is disabled or in error (2.2.3: such an error
 *  needs a new edge). */
const cm1e_axis_t *cm1e_fb_enable(cm1e_fb_private_t *fb, const AXIS_REF_t *reference, BOOL enable);
/** A block that reads: returns true and a copy of the values of the axis, if it can be read. */
BOOL cm1e_fb_read(cm1e_fb_private_t *fb, const AXIS_REF_t *reference, BOOL enable, cm1e_axis_info_t *info);

/** Outputs of a block that reads. A `passing` error keeps Busy TRUE, and Valid returns by itself (2.2.3, figure 5). */
typedef struct cm1e_fb_reading {
    BOOL valid, busy, error;
    WORD error_id;
} fb_reading_t;
/** Sets the outputs; `axis` is the result of cm1e_fb_enable(). */
fb_reading_t cm1e_fb_reading(const cm1e_fb_private_t *fb, const void *axis, cm1e_error_t passing);

/** For a block whose inputs are judged in every call, before it shows its error: one that is over need not be told any
 *  more. */
static inline void fb_reads_right(const cm1e_fb_private_t *fb, WORD shown, BOOL error)
{
    cm1e_axis_t *axis = shown && !error ? cm1e_fb_axis(fb) : NULL;
    if (axis)
        cm1e_axis_reads_right(axis);
}

/** Administrative commands are not queued in this version (2.4.2). */
static inline cm1e_error_t fb_refuse_execution_mode(cm1e_axis_t *axis, MC_EXECUTION_MODE mode)
{
    return mode == mcImmediately ? CM1E_OK : cm1e_axis_refuse_input(axis, CM1E_ERROR_UNSUPPORTED, "ExecutionMode",
                                                                    (int)mode, "0 (mcImmediately)");
}

#endif
