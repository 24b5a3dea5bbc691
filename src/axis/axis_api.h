/**
 * @file axis/axis_api.h
 * The axis as scheduler and function blocks see it. The scheduler calls cm1e_axis_inputs() before and
 * cm1e_axis_outputs() after the programs of a cycle; function blocks post commands between the two and poll them by
 * number. The axis never touches a function block's memory, so a block may vanish at any time. All in the cycle thread.
 */
#ifndef CM1E_AXIS_AXIS_API_H
#define CM1E_AXIS_AXIS_API_H

#include "cm1e/axis.h"
#include "cm1e/plcopen.h"
#include "drive/drive.h"
#include "motion/profile.h"

typedef struct cm1e_axis cm1e_axis_t;

typedef enum cm1e_command_kind {
    CM1E_COMMAND_MOVE_ABSOLUTE = 0,
    CM1E_COMMAND_MOVE_RELATIVE,
    CM1E_COMMAND_MOVE_ADDITIVE,
    CM1E_COMMAND_MOVE_VELOCITY,
    CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE,
    CM1E_COMMAND_MOVE_CONTINUOUS_RELATIVE,
    CM1E_COMMAND_POSITION_PROFILE,  /**< a table of the application: see `table` */
    CM1E_COMMAND_VELOCITY_PROFILE,
    CM1E_COMMAND_ACCELERATION_PROFILE,
    CM1E_COMMAND_HALT,
    CM1E_COMMAND_STOP,
    CM1E_COMMAND_HOME,              /**< a routine of the drive */
    CM1E_COMMAND_HOMING_STEP,       /**< a step of Part 5, by the axis: see `step` */
    CM1E_COMMAND_MOVE_SUPERIMPOSED, /**< a superimposed motion: never the active command, with a record of its own */
    CM1E_COMMAND_HALT_SUPERIMPOSED,
    CM1E_COMMAND_GEAR_IN,           /**< follows a master, like the next three: see `coupling` */
    CM1E_COMMAND_GEAR_IN_POS,
    CM1E_COMMAND_CAM_IN,
    CM1E_COMMAND_COMBINE_AXES,
    CM1E_COMMAND_GEAR_OUT,          /**< leaves the master and keeps the velocity; Done at once */
    CM1E_COMMAND_CAM_OUT,
    CM1E_COMMAND_PHASING_ABSOLUTE,  /**< `position` is the phase shift, u of the master. Never the active command,
                                         with a record of its own */
    CM1E_COMMAND_PHASING_RELATIVE,
    CM1E_COMMAND_FOLLOW_POSITION,   /**< follows positions from outside: `position` is the first one, as
                                         cm1e_axis_feed() counts it */
    CM1E_COMMAND_KIND_COUNT,
} cm1e_command_kind_t;

/** The steps of a homing by the axis (Part 5, 3.1 ... 3.3, 3.6, 3.8). */
typedef enum cm1e_homing_step_kind {
    CM1E_STEP_ABSOLUTE_SWITCH = 0,
    CM1E_STEP_LIMIT_SWITCH, /**< the limit switch in `direction` */
    CM1E_STEP_BLOCK,
    CM1E_STEP_DIRECT,       /**< sets the position where the axis is; ends the homing */
    CM1E_STEP_FINISH,       /**< an optional move; ends the homing */
} cm1e_homing_step_kind_t;

/** A step of a homing. The command has in addition the `velocity` of the search and, as `position`, the position to set
 *  at the reference (NAN: none), or for FINISH the distance of its move. */
typedef struct cm1e_homing_step {
    cm1e_homing_step_kind_t kind;
    MC_HOME_DIRECTION direction;    /**< 0 acts as mcPositiveDirection */
    MC_SWITCH_MODE mode;
    int input;                      /**< ABSOLUTE_SWITCH: 1 ... 4; 0: the configured home switch */
    bool of_another_axis;           /**< ABSOLUTE_SWITCH: the input is one of another axis, which is refused */
    double torque_limit;            /**< % of rated torque; 0: none. BLOCK: it shows the stop; 0: the lag does */
    double distance_limit;          /**< u, of the whole step; 0: none */
    int64_t time_limit_ns;          /**< 0: the timeout of the configured homing */
    double detection_velocity;      /**< u/s, BLOCK: slower counts as blocked; 0: a tenth of `velocity` */
    int64_t detection_ns;           /**< BLOCK: blocked for so long; 0: 50 ms */
} cm1e_homing_step_t;

/** A table of values over time. It is read while the command is started. */
typedef struct cm1e_axis_table {
    void (*read)(const void *reference, int index, TIME *delta_ns, LREAL *value);
    const void *reference;
    int count;
    bool absolute;                  /**< false: values count from those of the set-point at the start */
    double time_scale, scale;       /**< factors; 0 acts as 1 */
    double offset;                  /**< added to all values */
} cm1e_axis_table_t;

/** A master of a slave, and the ratio of the two (none for CAM_IN). */
typedef struct cm1e_coupling_master {
    AXIS_REF_t axis;
    MC_SOURCE source;               /**< mcSetValue, mcActualValue; an encoder has actual values only */
    int32_t numerator;              /**< not 0 */
    uint32_t denominator;           /**< not 0 */
} cm1e_coupling_master_t;

/** The coupling of a slave. The command has in addition the acceleration, deceleration and jerk until it is in step,
 *  and for GEAR_IN_POS the `velocity`. */
typedef struct cm1e_axis_coupling {
    cm1e_coupling_master_t master[2]; /**< the second one: COMBINE_AXES only */
    MC_COMBINE_MODE combine;
    double master_sync_position;    /**< u of the master; GEAR_IN_POS, CAM_IN */
    double slave_sync_position;     /**< u; GEAR_IN_POS */
    double master_start_distance;   /**< u of the master, in its direction; 0: the axis decides */
    MC_SYNC_MODE sync_mode;
    MC_CAM_ID cam;
    MC_START_MODE start_mode;
    double master_offset, slave_offset;   /**< u of the master, u */
    double master_scaling, slave_scaling; /**< 0 acts as 1 */
} cm1e_axis_coupling_t;

/** A motion command as a function block posts it. Acceleration, deceleration or jerk 0 select the maximum of the axis.
 *  */
typedef struct cm1e_axis_command {
    cm1e_command_kind_t kind;
    double position;       /**< u: target, distance, or position to set */
    double velocity;       /**< u/s; MOVE_SUPERIMPOSED: VelocityDiff */
    double end_velocity;   /**< u/s, signed; MOVE_CONTINUOUS_*: EndVelocity */
    double acceleration, deceleration, jerk;
    MC_DIRECTION direction;
    MC_BUFFER_MODE buffer_mode;
    const cm1e_homing_config_t *homing; /**< HOME: parameters, copied; NULL: those of the configuration */
    const cm1e_homing_step_t *step;     /**< HOMING_STEP: copied */
    const cm1e_axis_table_t *table;     /**< PROFILE: copied as segments when the command is taken */
    const cm1e_axis_coupling_t *coupling; /**< GEAR_IN ... COMBINE_AXES: copied. PHASING_*: only master[0].axis */
} cm1e_axis_command_t;

/** The maximum number of waiting commands; for one more, CM1E_ERROR_FULL. */
enum { CM1E_AXIS_BUFFER_DEPTH = 8 };

/** The number of a command; 0: none. */
typedef uint32_t cm1e_command_id_t;

typedef enum cm1e_command_state {
    CM1E_COMMAND_UNKNOWN = 0, /**< forgotten after too many later commands */
    CM1E_COMMAND_BUFFERED,    /**< waits behind others: Busy, not Active */
    CM1E_COMMAND_ACTIVE,
    CM1E_COMMAND_DONE,
    CM1E_COMMAND_ABORTED,
    CM1E_COMMAND_ERROR,
} cm1e_command_state_t;

typedef struct cm1e_command_status {
    cm1e_command_state_t state;
    cm1e_error_t error;   /**< with CM1E_COMMAND_ERROR */
    bool reached;         /**< InVelocity, InEndVelocity, ProfileCompleted, InGear, InSync: set value =
                               commanded value */
    bool synchronizing;   /**< GEAR_IN_POS: StartSync */
    uint32_t ends;        /**< CAM_IN: number of ends of the profile passed; a larger one is EndOfProfile */
    double covered;       /**< MOVE_SUPERIMPOSED: CoveredDistance, u. PHASING_*: the shift (absolute) or the covered
                               part of it (relative), u of the master */
} cm1e_command_status_t;

/** Makes the axis of drive `index`. Then the rooms above it add their functions (cm1e_axis_create()). @rt init */
cm1e_error_t cm1e_axis_make(cm1e_axis_t **axis, cm1e_bus_t *bus, uint32_t index, cm1e_diag_t *diag);
/** Gives the axis its handle, by which any thread finds it. This is the last step, when the axis is complete. @rt init
 *  */
cm1e_error_t cm1e_axis_publish(cm1e_axis_t *axis, cm1e_diag_t *diag);
/** Frees an axis. Call it after cm1e_bus_stop(), because waiting transfers would write into its memory. @rt init */
void cm1e_axis_destroy(cm1e_axis_t *axis);
AXIS_REF_t cm1e_axis_reference(const cm1e_axis_t *axis);
/** The axis of a handle; NULL: there is none. @rt cycle */
cm1e_axis_t *cm1e_axis_from_reference(const AXIS_REF_t *reference);

/** Reads the feedback of the cycle and handles errors. `health` is cm1e_bus_health(). @rt cycle */
void cm1e_axis_inputs(cm1e_axis_t *axis, cm1e_error_t received, cm1e_error_t health, int64_t now_ns);
/** Computes the next set-point and the state, and writes the outputs of the drive. @rt cycle */
void cm1e_axis_outputs(cm1e_axis_t *axis);
/** So many cycles without an answer, or without a frame, in a row or shortly one after the other, hardly slow the motor
 *  down. After them a motion made of several (a table over time, a superimposed motion, the path of a group) goes on.
 *  */
enum { CM1E_AXIS_RIDDEN_OUT_CYCLES = 2 };
/** Called before cm1e_axis_outputs() after a pause in which no frame was sent for so long that the motor no longer
 *  follows the set-point. The motion begins anew from rest (CSP), or from where the motor has gone on to (CSV). @rt
 *  cycle */
void cm1e_axis_after_pause(cm1e_axis_t *axis, int64_t pause_ns);
/** Called before cm1e_axis_outputs() after a few cycles without a frame. The target is repeated until the next answer
 *  shows whether the motor has slowed down. @rt cycle */
void cm1e_axis_hold_cycle(cm1e_axis_t *axis, int64_t missed);
/** Whether the slave of the axis may be silent while the others of its bus go on: it is optional. @rt cycle */
bool cm1e_axis_is_heard_alone(const cm1e_axis_t *axis);
/** Whether a silence of one of them is always one of the other too: they are on one bus, or have one slave.
 *  @rt cycle */
bool cm1e_axis_is_heard_with(const cm1e_axis_t *axis, const cm1e_axis_t *other);
/** Called before cm1e_axis_outputs() where axes of one cycle are not all heard together: some may have been silent
 *  while the others were not, and all slaves see it before any axis goes on. @rt cycle */
void cm1e_axis_meet(cm1e_axis_t *const *axes, uint32_t count);

/** Starts a command, or refuses it; then *id is 0 and nothing has changed. CM1E_ERROR_UNSUPPORTED: the profiles of a
 *  drive (`motion: drive`) cannot do it. @rt cycle */
cm1e_error_t cm1e_axis_start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
/** A block refuses a command by itself: remembered for the text in place of an earlier refusal. Returns `error`.
 *  @rt cycle */
cm1e_error_t cm1e_axis_refuse(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_error_t error);
/** A block refuses one of its inputs, as "MC_Jog: Mode", for its value; `right` says which are allowed. Both are
 *  constants. Returns `error`. @rt cycle */
cm1e_error_t cm1e_axis_refuse_input(cm1e_axis_t *axis, cm1e_error_t error, const char *input, double value,
                                    const char *right);
/** cm1e_axis_refuse_input() of a block that is called with the same input in every cycle: it is remembered when the
 *  error `begins`, for another value, and where nothing else is to be told, so that it does not hide the text of a
 *  later refusal. Returns `error`. @rt cycle */
cm1e_error_t cm1e_axis_refuse_level(cm1e_axis_t *axis, cm1e_error_t error, const char *input, int value,
                                    const char *right, bool begins);
/** A block that is called in every cycle is refused no longer: forgets what the text has of such a block. @rt cycle */
void cm1e_axis_reads_right(cm1e_axis_t *axis);
/** ContinuousUpdate (2.4.6): gives the present inputs of a command. Unchanged inputs cost one comparison. Relative
 *  values count from the begin of the command, and the buffer mode stays. A refused update changes nothing: the motion
 *  goes on with the last accepted inputs, and the block shows the error. After the end of the command nothing happens.
 *  CM1E_ERROR_INVALID_ARGUMENT: another kind of command, or one without inputs to change. @rt cycle */
cm1e_error_t cm1e_axis_update(cm1e_axis_t *axis, cm1e_command_id_t id, const cm1e_axis_command_t *command);
/** MC_SetOverride: factors on the velocity of commands (0 ... 1; 0: the axis comes to rest, but not to Standstill), on
 *  their acceleration and deceleration, and on their jerk (above 0 ... 1). They hold until changed. @rt cycle */
cm1e_error_t cm1e_axis_set_override(cm1e_axis_t *axis, double velocity, double acceleration, double jerk);
/** cm1e_axis_refuse_level() for factors that were refused. @rt cycle */
void cm1e_axis_refuse_override(cm1e_axis_t *axis, cm1e_error_t error, double velocity, double acceleration, double jerk,
                               bool begins);
/** MC_SetPosition (3.17): the present position becomes `position` (u), or `relative` that much more. Set and actual
 *  position shift alike and keep their lag. Nothing moves, and the present motion ends at the same place as without the
 *  shift. Software limits and later positions are in the new coordinates. CM1E_ERROR_AXIS_POSITION_RANGE: not finite,
 *  outside the range of a modulo axis, or outside the software limits, also on the way of the present motion.
 *  CM1E_ERROR_AXIS_HOMING: the axis is homing. CM1E_ERROR_AXIS_OFFLINE: the actual position is not known. After an
 *  error nothing has changed. @rt cycle */
cm1e_error_t cm1e_axis_set_position(cm1e_axis_t *axis, double position, bool relative);
cm1e_command_status_t cm1e_axis_command_status(const cm1e_axis_t *axis, cm1e_command_id_t id);
/** Gives the position of this cycle to an axis that follows positions from outside by this command: u, on a modulo axis
 *  without its turns. Call it once in every cycle, also in that of the start: without a position the axis stops with
 *  CM1E_ERROR_AXIS_SET_POINT_MISSING, and at one that it could not follow with CM1E_ERROR_AXIS_SET_POINT_LIMIT. After
 *  the end of the command nothing happens. @rt cycle */
void cm1e_axis_feed(AXIS_REF_t reference, cm1e_command_id_t id, double position);
/** Whether this is still the active command of an axis that exists. This cheap test suffices for a block while nothing
 *  changes. @rt cycle */
bool cm1e_axis_runs(AXIS_REF_t reference, cm1e_command_id_t id);
/** What a block of a slave shows of its command: the members have the meaning that they have in
 *  cm1e_command_status_t. */
typedef struct cm1e_following {
    bool follows;       /**< the axis follows by this command; false: the others mean nothing */
    bool reached, synchronizing;
    uint32_t ends;
} cm1e_following_t;
/** For a block of a slave: what cm1e_axis_command_status() says, as far as it follows by this command. @rt cycle */
cm1e_following_t cm1e_axis_follows_by(AXIS_REF_t reference, cm1e_command_id_t id);
/** Holds the axis in Stopping while MC_Stop.Execute is TRUE. True: it is this command that holds it there now, and not
 *  a later MC_Stop. @rt cycle */
bool cm1e_axis_hold_stop(cm1e_axis_t *axis, cm1e_command_id_t id, bool hold);

/** MC_Power, called every cycle by its one owner (any non-NULL pointer that identifies the block).
 *  CM1E_ERROR_FB_SECOND_POWER: another one owns it. @rt cycle */
cm1e_error_t cm1e_axis_power(cm1e_axis_t *axis, const void *owner, bool enable, bool enable_positive,
                             bool enable_negative);
/** The owner has enabled the axis, and the power stage is on: nothing is left to do for it while it shows what it shows
 *  now, and nothing of the power changes. `shown` is anything by which the owner recognises its inputs and outputs, but
 *  not 0. @rt cycle */
void cm1e_axis_power_settle(cm1e_axis_t *axis, const void *owner, uint64_t shown);
/** Whether that is still so. @rt cycle */
bool cm1e_axis_power_settled(AXIS_REF_t reference, const void *owner, uint64_t shown);
/** Whether the power stage is on: MC_Power.Status. @rt cycle */
bool cm1e_axis_powered(const cm1e_axis_t *axis);
/** MC_Reset: starts a reset. Poll it with cm1e_axis_reset_state(). @rt cycle */
cm1e_error_t cm1e_axis_reset(cm1e_axis_t *axis);
CM1E_GUEST_API cm1e_command_state_t cm1e_axis_reset_state(const cm1e_axis_t *axis, cm1e_error_t *error);

/** The set-point that a leader gives for a cycle. */
typedef enum cm1e_lead {
    CM1E_LEAD_NONE = 0, /**< none: the axis stops by itself as after an error, unless the leader let it go */
    CM1E_LEAD_ON,
    CM1E_LEAD_LAST,     /**< the last one: the leader lets the axis go with it; at rest, to Standstill */
} cm1e_lead_t;

/** A leader of a room above, which gives the set-point of every cycle. The axis is in SynchronizedMotion and asks for
 *  the next set-point in cm1e_axis_outputs(). A set-point that it could not follow is not sent to the motor: the axis
 *  stops with CM1E_ERROR_AXIS_COUPLING_LIMIT. */
typedef struct cm1e_axis_leader {
    /** The short way of an ordinary cycle, if `bounds` is not NULL. It is taken while the number of `course` stays and
     *  the set-points were found to be well within the limits ahead. Then next() would do nothing but give the
     *  set-point. Bits of the axes that have had the present set-point, and that of this one: */
    uint32_t *asked;
    uint32_t bit;
    const double *position, *velocity, *acceleration; /**< of this axis in the present set-point */
    const uint32_t *course;         /**< see bounds() */
    /** Written by the axis: u, where the line of `position` has the origin of the counts; counts of its unit, with the
     *  sign of the motor. */
    double line_origin, line_counts;
    /** Makes the next set-point of all axes. false, and nothing has changed: the cycle is not an ordinary one. */
    bool (*ordinary)(void *context);
    void *context;
    uint32_t index;                 /**< number of the axis for the leader */
    /** Position (u, as cm1e_axis_get() counts it, without the turns of a modulo axis), velocity, acceleration of this
     *  cycle. */
    cm1e_lead_t (*next)(void *context, uint32_t index, double *position, double *velocity, double *acceleration);
    /** `course` is a number that stays as long as what `bounds` has told of the axis holds: its largest velocity,
     *  acceleration and jerk from the last set-point on, and for how long at most. The number is that of the set-point
     *  which next() gave last. false: nothing is known ahead. NULL, both: nothing ever is. */
    bool (*bounds)(void *context, uint32_t index, cm1e_motion_bounds_t *most, double *left_s);
    /** The lead has ended, by MC_Stop, MC_Power or an error of the axis. `error` is that with which commands end;
     *  CM1E_OK: they are aborted. */
    void (*lost)(void *context, uint32_t index, cm1e_error_t error);
    /** The motor has come to rest at its last set-point, because no frame was sent for a while. Called by
     *  cm1e_axis_after_pause(), before the next set-point. The next set-points begin there, from rest. */
    void (*paused)(void *context, uint32_t index);
    /** A silence of a few cycles has ended. All axes of the leader go on along their path, with the part of the
     *  velocity that cm1e_axis_part_left() allows each of them. It returns the velocity and acceleration that the axis
     *  has now, at its last set-point. Called before the next set-point. NULL: as fast as before. */
    void (*slow)(void *context, uint32_t index, double *velocity, double *acceleration);
    /** Whether the silence was too long for one axis of the leader (cm1e_axis_begins_anew()). Then all of them begin
     *  anew, each as its mode permits. NULL: each axis decides by itself. */
    bool (*begins_anew)(void *context);
    /** s; the time that the slowest axis of the leader needs to brake, for the common ramp when the bus is lost. NULL:
     *  each axis has its own ramp. */
    double (*stop_time)(void *context);
    /** The set-point of the axis goes after its motor, which a load has turned on in a pause or silence, with this
     *  velocity (u/s). Called in place of next(), in every cycle of that. Then next() gives set-points from there on.
     *  NULL: it does not go after it. */
    void (*strays)(void *context, uint32_t index, double velocity);
    /** The bus of the axis is silent: its set-point stays in this cycle. Called in place of next(). NULL: nothing. */
    void (*held)(void *context, uint32_t index);
    /** Called after a silence, before the next set-point: whether the axis is not where its leader has the others,
     *  because these were not silent, or because it strays. Then the axis goes on by itself: the next set-point begins
     *  at its last one, with the velocity that the motor has left. NULL: it is. */
    bool (*alone)(void *context, uint32_t index);
} cm1e_axis_leader_t;
/** Gives an axis a leader. Until the lead ends, motion commands other than MC_Stop, and MC_SetPosition, are refused
 *  with CM1E_ERROR_AXIS_IN_GROUP. A lead begins only in Standstill: else CM1E_ERROR_AXIS_STATE. The leader must exist
 *  until the lead ends. @rt cycle */
cm1e_error_t cm1e_axis_lead(cm1e_axis_t *axis, cm1e_axis_leader_t *leader);
/** Ends the lead: an axis at rest goes to Standstill; else it ramps down with its own limits. @rt cycle */
void cm1e_axis_release(cm1e_axis_t *axis);
/** Makes the axis a member of this group. false: it belongs to another one already. @rt cycle */
bool cm1e_axis_join(cm1e_axis_t *axis, const void *group);
/** @rt cycle */
void cm1e_axis_leave(cm1e_axis_t *axis, const void *group);
/** The set or actual position in u, as a leader gives positions. @rt cycle */
double cm1e_axis_place(const cm1e_axis_t *axis, bool actual);
/** Axes with the same `cycle` may follow each other, even on different buses: one thread advances all of them in the
 *  same cycle. @rt init */
void cm1e_axis_share_cycle(cm1e_axis_t *axis, const void *cycle);
/** Whether one of the two may follow the other. @rt cycle */
bool cm1e_axis_shares_cycle(const cm1e_axis_t *axis, const cm1e_axis_t *other);
/** After a silence: the part of the set velocity (0 ... 1) with which the motor can go on. With more it would exceed
 *  the maximum velocity of the axis while it catches up. @rt cycle */
double cm1e_axis_part_left(const cm1e_axis_t *axis);
/** After a silence: whether the motion has to begin anew. In CSP the motor has stopped too often in a short time; in
 *  CSV it has gone on too far. @rt cycle */
bool cm1e_axis_begins_anew(const cm1e_axis_t *axis);
/** Whether the bus of the axis is silent, so that its set-point stays in this cycle. @rt cycle */
bool cm1e_axis_held(const cm1e_axis_t *axis);
/** Cycles of the silence that ended with this cycle; 0: none did. @rt cycle */
uint32_t cm1e_axis_was_silent(const cm1e_axis_t *axis);
/** s; the time between two set-points. @rt cycle */
double cm1e_axis_cycle(const cm1e_axis_t *axis);
/** Whether MC_Power permits a direction. @rt cycle */
bool cm1e_axis_may_go(const cm1e_axis_t *axis, bool positive);
/** The present maximum values of commands (u/s, u/s2, u/s3), and the software limits (u; infinite: none on that side).
 *  @rt cycle */
void cm1e_axis_bounds(const cm1e_axis_t *axis, cm1e_motion_limits_t *limits, double *lower, double *upper);

/** The state of the axis alone: a member of what cm1e_axis_get() gives, without the work for the others. @rt cycle */
cm1e_axis_state_t cm1e_axis_present_state(const cm1e_axis_t *axis);
CM1E_GUEST_API void cm1e_axis_get(const cm1e_axis_t *axis, cm1e_axis_info_t *info);
CM1E_GUEST_API const cm1e_axis_config_t *cm1e_axis_configuration(const cm1e_axis_t *axis);

/** The program of the axis is gone: `task` did not return within `limit_ns`. The axis is in ErrorStop and brakes, also
 *  if it has no torque, because blocks of that program may have begun what needs none. MC_Power.Enable is taken back:
 *  it acts again when a living program calls it. `task` must outlive the axis. @rt cycle */
void cm1e_axis_lose_program(cm1e_axis_t *axis, const char *task, int64_t limit_ns);
/** For so long no frame was sent that a drive with a watchdog has taken its torque off by itself. So does one without:
 *  ErrorStop, if the axis has torque or is about to get it. `now_ns`: the end of that time. Called after
 *  cm1e_axis_after_pause(). @rt cycle */
void cm1e_axis_stood_still(cm1e_axis_t *axis, int64_t pause_ns, int64_t now_ns);
/** For so long every cycle was late. In none of them a set-point moves, so no motion, and no ramp either, would ever
 *  end: ErrorStop, as above, and the torque goes at once, also in the ramp of an error before. Called after
 *  cm1e_axis_after_pause() or cm1e_axis_hold_cycle(). @rt cycle */
void cm1e_axis_ran_late(cm1e_axis_t *axis, int64_t late_ns);
/** Ends the axis in order: it ramps down, then the drive is disabled. true when the drive is disabled, or gone. Call it
 *  in every cycle instead of the programs. @rt cycle */
bool cm1e_axis_shut_down(cm1e_axis_t *axis);
enum { CM1E_AXIS_LONGEST_SWING_MS = 2000 };
/** Whether its ramp has ended and only the rest of the motor is waited for, CM1E_AXIS_LONGEST_SWING_MS at most.
 *  @rt cycle */
bool cm1e_axis_swings(const cm1e_axis_t *axis);

#endif
