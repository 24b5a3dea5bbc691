/**
 * @file axis/axis.h
 * The axis as scheduler and function blocks see it. The scheduler calls cm1e_axis_inputs() before and
 * cm1e_axis_outputs() after the programs of a cycle; function blocks post commands between the two and poll them by
 * number. The axis never touches a function block's memory, so a block may vanish at any time. All in the cycle thread.
 */
#ifndef CM1E_AXIS_AXIS_H
#define CM1E_AXIS_AXIS_H

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
    CM1E_COMMAND_HOME,              /**< the drive's own routine */
    CM1E_COMMAND_HOMING_STEP,       /**< Part 5, done by the axis: see `step` */
    CM1E_COMMAND_MOVE_SUPERIMPOSED, /**< a second motion on top: never the active command, it has a record of its own */
    CM1E_COMMAND_HALT_SUPERIMPOSED,
    CM1E_COMMAND_GEAR_IN,           /**< follows a master: see `coupling`, as the next three */
    CM1E_COMMAND_GEAR_IN_POS,
    CM1E_COMMAND_CAM_IN,
    CM1E_COMMAND_COMBINE_AXES,
    CM1E_COMMAND_GEAR_OUT,          /**< leaves the master and keeps the velocity: Done at once */
    CM1E_COMMAND_CAM_OUT,
    CM1E_COMMAND_PHASING_ABSOLUTE,  /**< `position` is the phase shift, u of the master: never the active command, it
                                         has a record of its own */
    CM1E_COMMAND_PHASING_RELATIVE,
    CM1E_COMMAND_KIND_COUNT,
} cm1e_command_kind_t;

/** The steps of a homing that the axis does itself (Part 5, 3.1 ... 3.3, 3.6, 3.8). */
typedef enum cm1e_homing_step_kind {
    CM1E_STEP_ABSOLUTE_SWITCH = 0,
    CM1E_STEP_LIMIT_SWITCH, /**< the one of `direction` */
    CM1E_STEP_BLOCK,
    CM1E_STEP_DIRECT,       /**< the position is set where the axis stands; ends the homing */
    CM1E_STEP_FINISH,       /**< an optional move; ends the homing */
} cm1e_homing_step_kind_t;

/** Beside it, in the command: `velocity` of the search, and as `position` the one to set at the reference (NAN: none is
 *  set), of FINISH the distance of its move. */
typedef struct cm1e_homing_step {
    cm1e_homing_step_kind_t kind;
    MC_HOME_DIRECTION direction;    /**< 0 acts as mcPositiveDirection */
    MC_SWITCH_MODE mode;
    int input;                      /**< ABSOLUTE_SWITCH: 1 ... 4; 0: the configured home switch */
    double torque_limit;            /**< % of rated torque; 0: none. BLOCK: what shows the stop; 0: the position lag */
    double distance_limit;          /**< u, of all ways together; 0: none */
    int64_t time_limit_ns;          /**< 0: the timeout of the configured homing */
    double detection_velocity;      /**< u/s, BLOCK: slower is standing; 0: a tenth of `velocity` */
    int64_t detection_ns;           /**< BLOCK: for so long; 0: 50 ms */
} cm1e_homing_step_t;

/** A table of values over time, read pair by pair while the command is taken. */
typedef struct cm1e_axis_table {
    void (*read)(const void *reference, int index, TIME *delta_ns, LREAL *value);
    const void *reference;
    int count;
    bool absolute;                  /**< FALSE: values count from those of the set-point at the start */
    double time_scale, scale;       /**< factors; 0 acts as 1 */
    double offset;                  /**< added to all values */
} cm1e_axis_table_t;

/** A master as a slave follows it, and by which ratio (CAM_IN has none). */
typedef struct cm1e_coupling_master {
    AXIS_REF_t axis;
    MC_SOURCE source;               /**< mcSetValue, mcActualValue; an encoder has actual values only */
    int32_t numerator;              /**< not 0 */
    uint32_t denominator;           /**< not 0 */
} cm1e_coupling_master_t;

/** What a slave follows. Beside it, in the command: acceleration, deceleration, jerk of the way into step, and for
 *  GEAR_IN_POS `velocity`. */
typedef struct cm1e_axis_coupling {
    cm1e_coupling_master_t master[2]; /**< the second one: COMBINE_AXES only */
    MC_COMBINE_MODE combine;
    double master_sync_position;    /**< u of the master; GEAR_IN_POS, CAM_IN */
    double slave_sync_position;     /**< u; GEAR_IN_POS */
    double master_start_distance;   /**< u of the master, signed as the way it goes; 0: the axis decides */
    MC_SYNC_MODE sync_mode;
    MC_CAM_ID cam;
    MC_START_MODE start_mode;
    double master_offset, slave_offset;   /**< u of the master, u */
    double master_scaling, slave_scaling; /**< 0 acts as 1 */
} cm1e_axis_coupling_t;

/** A motion command as a function block posts it. Zero acceleration, deceleration or jerk: the axis's maximum. */
typedef struct cm1e_axis_command {
    cm1e_command_kind_t kind;
    double position;       /**< u: target, distance, or position to set */
    double velocity;       /**< u/s; MOVE_SUPERIMPOSED: VelocityDiff */
    double end_velocity;   /**< u/s, signed; MOVE_CONTINUOUS_*: EndVelocity */
    double acceleration, deceleration, jerk;
    MC_DIRECTION direction;
    MC_BUFFER_MODE buffer_mode;
    const cm1e_homing_config_t *homing; /**< HOME: parameters, copied; NULL: the axis's configured ones */
    const cm1e_homing_step_t *step;     /**< HOMING_STEP: copied */
    const cm1e_axis_table_t *table;     /**< PROFILE: copied as segments when the command is taken */
    const cm1e_axis_coupling_t *coupling; /**< GEAR_IN ... COMBINE_AXES: copied. PHASING_*: only master[0].axis */
} cm1e_axis_command_t;

/** Commands that wait behind the active one; one more is CM1E_ERROR_FULL. */
enum { CM1E_AXIS_BUFFER_DEPTH = 8 };

/** 0 is no command. */
typedef uint32_t cm1e_command_id_t;

typedef enum cm1e_command_state {
    CM1E_COMMAND_UNKNOWN = 0, /**< forgotten: too many commands since */
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
    uint32_t ends;        /**< CAM_IN: how often it came over an end of the profile; more than before is EndOfProfile */
    double covered;       /**< MOVE_SUPERIMPOSED: CoveredDistance, u; PHASING_*: the shift (absolute), or what of it was
                               covered (relative), u of the master */
} cm1e_command_status_t;

/** Makes the axis of drive `index`; then the rooms above it add what is theirs (cm1e_axis_create()). @rt init */
cm1e_error_t cm1e_axis_make(cm1e_axis_t **axis, cm1e_bus_t *bus, uint32_t index, cm1e_diag_t *diag);
/** Gives it its handle, by which any thread finds it: the last step, when all of it is written. @rt init */
cm1e_error_t cm1e_axis_publish(cm1e_axis_t *axis, cm1e_diag_t *diag);
/** After cm1e_bus_stop(): transfers of the axis that wait in the bus would end in its memory. @rt init */
void cm1e_axis_destroy(cm1e_axis_t *axis);
AXIS_REF_t cm1e_axis_reference(const cm1e_axis_t *axis);
/** NULL: the handle names no axis. @rt cycle */
cm1e_axis_t *cm1e_axis_from_reference(const AXIS_REF_t *reference);

/** Takes in the cycle's feedback and lets errors act. `health` is cm1e_bus_health(). @rt cycle */
void cm1e_axis_inputs(cm1e_axis_t *axis, cm1e_error_t received, cm1e_error_t health, int64_t now_ns);
/** Next set-point, state diagram, drive outputs. @rt cycle */
void cm1e_axis_outputs(cm1e_axis_t *axis);
/** Cycles without an answer, or in which no frame was sent, in a row or shortly one after the other, after which the
 *  motor has hardly slowed down: a motion made of several (a table over time, a superimposed motion, a group's path)
 *  goes on as it was. */
enum { CM1E_AXIS_RIDDEN_OUT_CYCLES = 2 };
/** Before cm1e_axis_outputs(): no frame was sent for so long beyond the cycle that the motor no longer moves as the
 *  set-point does. What moves begins anew from rest (CSP), or from where the motor has gone on to (CSV). @rt cycle */
void cm1e_axis_after_pause(cm1e_axis_t *axis, int64_t pause_ns);
/** Before cm1e_axis_outputs(): for a few cycles no frame was sent. The target is repeated once more, until the next
 *  answer shows whether the motor has slowed down meanwhile. @rt cycle */
void cm1e_axis_hold_cycle(cm1e_axis_t *axis, int64_t missed);

/** Starts a command or refuses it (then *id is 0 and nothing has changed). CM1E_ERROR_UNSUPPORTED: not by the profiles
 *  of a drive (`motion: drive`). @rt cycle */
cm1e_error_t cm1e_axis_start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
/** ContinuousUpdate (2.4.6): the present inputs of a command; the same ones cost a comparison. Relative values count
 *  from where the command began; the buffer mode stays what it was. A refused update changes nothing: the motion goes
 *  on by the last good inputs, and the error is for the block to show. After the command's end nothing happens.
 *  CM1E_ERROR_INVALID_ARGUMENT: another kind of command, or one that has no inputs to change. @rt cycle */
cm1e_error_t cm1e_axis_update(cm1e_axis_t *axis, cm1e_command_id_t id, const cm1e_axis_command_t *command);
/** MC_SetOverride: factors on the velocity (0 ... 1; 0: the axis stands, but not in Standstill), on acceleration and
 *  deceleration, and on jerk (above 0 ... 1) of the commands. Kept until changed. @rt cycle */
cm1e_error_t cm1e_axis_set_override(cm1e_axis_t *axis, double velocity, double acceleration, double jerk);
/** MC_SetPosition (3.17): from now on the axis is at `position` (u), or `relative` that much farther. Set and actual
 *  position shift alike and keep their lag; nothing moves, what runs ends where it would have ended, and software
 *  limits and positions asked for later are meant in the new coordinates. CM1E_ERROR_AXIS_POSITION_RANGE: not
 *  finite, outside the range of a modulo axis, or outside the software limits, also on the way of a running motion;
 *  CM1E_ERROR_AXIS_HOMING; CM1E_ERROR_AXIS_OFFLINE: the actual position is not known. Refused: nothing has changed.
 *  @rt cycle */
cm1e_error_t cm1e_axis_set_position(cm1e_axis_t *axis, double position, bool relative);
cm1e_command_status_t cm1e_axis_command_status(const cm1e_axis_t *axis, cm1e_command_id_t id);
/** TRUE while this is the active command of an axis that exists: the short question of a block to which nothing has
 *  happened. @rt cycle */
bool cm1e_axis_runs(AXIS_REF_t reference, cm1e_command_id_t id);
/** For a block that follows a master: true while this is the command that the axis follows by. Then `reached`,
 *  `synchronizing` and `ends` are as cm1e_axis_command_status() has them, and nothing else is. @rt cycle */
bool cm1e_axis_follows_by(AXIS_REF_t reference, cm1e_command_id_t id, cm1e_command_status_t *status);
/** MC_Stop.Execute is (still) TRUE: while it is, the axis stays Stopping. @rt cycle */
void cm1e_axis_hold_stop(cm1e_axis_t *axis, cm1e_command_id_t id, bool hold);

/** MC_Power, called every cycle by its one owner (any non-NULL pointer that identifies the block).
 *  CM1E_ERROR_FB_SECOND_POWER: another one owns it. @rt cycle */
cm1e_error_t cm1e_axis_power(cm1e_axis_t *axis, const void *owner, bool enable, bool enable_positive,
                             bool enable_negative);
/** TRUE while another cm1e_axis_power() with these values, enabled, would change nothing and the power stage is on.
 *  @rt cycle */
bool cm1e_axis_power_stands(AXIS_REF_t reference, const void *owner, bool enable_positive, bool enable_negative);
/** Power stage on: MC_Power.Status. @rt cycle */
bool cm1e_axis_powered(const cm1e_axis_t *axis);
/** MC_Reset: starts; poll with cm1e_axis_reset_state(). @rt cycle */
cm1e_error_t cm1e_axis_reset(cm1e_axis_t *axis);
cm1e_command_state_t cm1e_axis_reset_state(const cm1e_axis_t *axis, cm1e_error_t *error);

/** What a leader has for a cycle. */
typedef enum cm1e_lead {
    CM1E_LEAD_NONE = 0, /**< there is none: the axis stops by itself, as after an error, unless it was let go */
    CM1E_LEAD_ON,
    CM1E_LEAD_LAST,     /**< the last one: the axis is let go with it, to Standstill if it is at rest then */
} cm1e_lead_t;

/** Set-points that somebody above gives, cycle by cycle: the axis is in SynchronizedMotion and asks for the next one
 *  while its own half of cm1e_axis_outputs() runs. One that it could not follow is not given to the motor: the axis
 *  stops with CM1E_ERROR_AXIS_COUPLING_LIMIT. */
typedef struct cm1e_axis_leader {
    /** Position (u, as cm1e_axis_get() counts it, without the turns of a modulo axis), velocity, acceleration of this
     *  cycle. */
    cm1e_lead_t (*next)(void *context, uint32_t index, double *position, double *velocity, double *acceleration);
    /** The axis is led no longer, by MC_Stop, MC_Power, an error of it: `error` as its commands end with, CM1E_OK
     *  where they would be aborted. */
    void (*lost)(void *context, uint32_t index, cm1e_error_t error);
    /** The motor has come to rest at its last set-point, because no frame was sent for a while:
     *  cm1e_axis_after_pause(), before the next set-point is asked for. The next ones begin there, from rest. */
    void (*paused)(void *context, uint32_t index);
    /** A silence of few cycles has ended: all that are led together go on along their path with the part of their
     *  velocity that cm1e_axis_part_left() leaves each of them. The velocity and the acceleration that the axis has
     *  now, at its last set-point. Asked before the next one is. NULL: as fast as before. */
    void (*slow)(void *context, uint32_t index, double *velocity, double *acceleration);
    /** The silence was too long for one of all that are led together (cm1e_axis_begins_anew()): then all of them begin
     *  anew, each as its mode permits. NULL: each by itself. */
    bool (*begins_anew)(void *context);
    /** s; how long the slowest of all that are led together needs to brake: the ramp that they have in common when the
     *  bus is lost. NULL: each has its own. */
    double (*stop_time)(void *context);
    void *context;
    uint32_t index;                 /**< of the axis, as the leader counts */
} cm1e_axis_leader_t;
/** While an axis has a leader, other motion commands than MC_Stop are CM1E_ERROR_AXIS_IN_GROUP, as is
 *  MC_SetPosition. From Standstill only, also where it stands already: CM1E_ERROR_AXIS_STATE. The leader must outlive
 *  that. @rt cycle */
cm1e_error_t cm1e_axis_lead(cm1e_axis_t *axis, const cm1e_axis_leader_t *leader);
/** The leader lets it go: at rest to Standstill, else it ramps down with its own limits. @rt cycle */
void cm1e_axis_release(cm1e_axis_t *axis);
/** The axis belongs to this group from now on. FALSE: to another one already. @rt cycle */
bool cm1e_axis_join(cm1e_axis_t *axis, const void *group);
/** @rt cycle */
void cm1e_axis_leave(cm1e_axis_t *axis, const void *group);
/** TRUE while a leader with this context leads the axis. @rt cycle */
bool cm1e_axis_led_by(const cm1e_axis_t *axis, const void *context);
/** u, as a leader gives positions: where the set-point is, or the motor. @rt cycle */
double cm1e_axis_place(const cm1e_axis_t *axis, bool actual);
/** The bus that the axis belongs to. @rt cycle */
const cm1e_bus_t *cm1e_axis_bus(const cm1e_axis_t *axis);
/** After a silence: the part of its set velocity (0 ... 1) that the motor can go on with. Faster, it would exceed the
 *  axis's maximum velocity while it catches up. @rt cycle */
double cm1e_axis_part_left(const cm1e_axis_t *axis);
/** After a silence: it cannot go on as it was. In CSP the motor has stood too often shortly one after the other, in CSV
 *  it has run on too far. @rt cycle */
bool cm1e_axis_begins_anew(const cm1e_axis_t *axis);
/** s; how far apart its set-points are. @rt cycle */
double cm1e_axis_cycle(const cm1e_axis_t *axis);
/** What MC_Power permits. @rt cycle */
bool cm1e_axis_may_go(const cm1e_axis_t *axis, bool positive);
/** u, u/s, u/s2, u/s3: what commands may ask of the axis at present, and where its software limits are (infinite: none
 *  on that side). @rt cycle */
void cm1e_axis_bounds(const cm1e_axis_t *axis, cm1e_motion_limits_t *limits, double *lower, double *upper);

CM1E_GUEST_API void cm1e_axis_get(const cm1e_axis_t *axis, cm1e_axis_info_t *info);
CM1E_GUEST_API const cm1e_axis_config_t *cm1e_axis_configuration(const cm1e_axis_t *axis);

/** Orderly end: ramp down whatever runs, then disable. TRUE when the drive is disabled (or gone). Call every cycle
 *  instead of the programs. @rt cycle */
bool cm1e_axis_shut_down(cm1e_axis_t *axis);

#endif
