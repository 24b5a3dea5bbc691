/**
 * @file axis_parts.h
 * The data of an axis: a struct for each of its parts, and the axis, which is made of them. What can be done with a
 * part is in its own header. commands_t and superimposed_t are in axis_move.h.
 */
#ifndef CM1E_AXIS_AXIS_PARTS_H
#define CM1E_AXIS_AXIS_PARTS_H

#include "axis/axis_hooks.h"
#include "axis/axis_move.h"
#include "axis/axis_place.h"
#include "device/unit.h"
#include "drive/drive.h"
#include "motion/slow_time.h"

/* ---- set-point: axis_setpoint.h ---------------------------------------------------------------------------------- */

/** Where the set-point comes from, where it is, and the profile that it is on. Written by axis_setpoint.h and
 *  axis_motion.c. */
typedef struct setpoint {
    const source_t *source;         /**< cm1e_axis_set_source() */
    bool reached, positive_before;
    bool synchronizing;             /**< while it follows: not yet by what was commanded */
    bool paused;                    /**< its end is not that of its command, which waits (MC_SetOverride) */
    bool stands;                    /**< the base has come to its end, only a superimposed motion goes on */
    bool brakes_hard;               /**< the set-point is one of a ramp without limit of jerk */
    uint32_t ends;                  /**< by a cam: cm1e_command_status_t */
    position_t position;            /**< set position */
    double velocity, acceleration;  /**< set velocity and acceleration; u/s, u/s2 */
    double profile_next_s;          /**< time of the profile in the next cycle */
    cm1e_profile_stretch_t stretch; /**< of it, the one that the set-point is in */
    position_t base, target;        /**< base: where the profile began; target: where it ends, exactly */
    double base_line;               /**< u; cm1e_axis_line() of base */
    int64_t profile_cycles;         /**< since the profile began */
    double profile_offset_s;        /**< so long before the first of these cycles it began */
    cm1e_slow_time_t slow;          /**< of a table over time (axis_pause.c) */
    uint32_t jumps;                 /**< how often it was put to the actual position: nobody may follow that way */
    double loop_velocity;           /**< counts/s that the position loop adds in CSV */
    cm1e_profile_t profile;         /**< relative to base, in u; along a table only its duration and end */
} setpoint_t;

/* ---- position: axis_position.h ----------------------------------------------------------------------------------- */

/** Counts of the drive, units, turns of a modulo axis, the origin. Written by axis_position.h and axis_position.c. */
typedef struct axis_position {
    cm1e_unit_t unit;               /**< the amount of `scale`, exactly */
    double modulo_range;            /**< u; 0: a linear axis */
    cm1e_fraction_t turn;           /**< counts of it */
    double count;                   /**< counts of this motor on the way of one count of a CM1-E */
    /* what every cycle looks at */
    double origin_units;
    position_t origin;              /**< position origin_units is there; modulo: 0 */
    double scale;                   /**< counts per u; negative: inverted */
    int64_t actual_counts;          /**< counts of the drive, last seen, without wrap-around */
    int32_t raw;                    /**< counts of the drive, last seen */
    bool known, homed;
} axis_position_t;

/* ---- limits and guard: axis_limits.h, axis_guard.h --------------------------------------------------------------- */

/** What a set-point may be beside the one before it, in the numbers that are compared; made once. Written by
 *  axis_guard.c. */
typedef struct guarding {
    double velocity;         /**< u/s */
    double up, down;         /**< u/s in a cycle */
    double acceleration;     /**< u/s2 */
    double jerk;             /**< u/s2 in a cycle */
    double ease;             /**< s3/u; by the square of an acceleration: what it adds to the velocity while it ends */
    double half_cycle, step; /**< counts in half a cycle at 1 u/s; counts beside the mean of both velocities */
    double per_count;        /**< u, signed */
} guarding_t;

/** What the axis may do: dynamics, software limits, directions. Written by axis_limits.c and axis_parameter.c. */
typedef struct limits {
    /* what every cycle looks at */
    bool lag_monitoring;
    bool software_limits;           /**< one of them is in force at least */
    bool positive_enabled, negative_enabled;
    int32_t counts_limit;           /**< of the motor's own counts in either direction, by its K37; 0: none */
    double max_lag;                 /**< u */
    double lower, upper;            /**< u, as cm1e_axis_line() counts; in force; infinite: none on that side */
    double tolerance;               /**< u; which they are kept with */
    double emergency_way;           /**< s2/u; times the square of a velocity: that it goes */
    cm1e_motion_limits_t system;    /**< u; of motor and configuration */
    cm1e_motion_limits_t maximum;   /**< u; what the application allows of it: the bounds of commands */
    cm1e_motion_limits_t emergency; /**< u; the ramp of an error: that of `system` without a limit of jerk */
    double positive, negative;      /**< u; the software limits as they are written */
    double counts_lower, counts_upper; /**< u, as cm1e_axis_line() counts; where that limit is; infinite: none */
} limits_t;

/** What a set-point that is not of the axis's own making would break. */
typedef enum guard_limit {
    GUARD_KEPT = 0,
    GUARD_FINITE,
    GUARD_PAUSE,       /**< the motor has gone on without it (axis_pause.c) */
    GUARD_DIRECTION,
    GUARD_VELOCITY,
    GUARD_ACCELERATION,
    GUARD_DECELERATION,
    GUARD_JERK,
    GUARD_STEP,
    GUARD_SOFTWARE_LIMIT,
    GUARD_COUNT,
} guard_limit_t;

/** What a set-point broke, and by how much. Written by axis_guard.c. */
typedef struct guard {
    guard_limit_t limit;
    double asked, allowed; /**< in the units of the limit */
    bool by_actual;        /**< what asked for it was the actual value of a master */
} guard_t;

/* ---- power and errors: axis_power.h ------------------------------------------------------------------------------ */

/** What MC_Power and MC_Reset ask for, and how far it has come. Written by axis_power.h, axis_power.c and
 *  axis_free.c. */
typedef struct power {
    const void *owner;
    bool enable, enable_positive, enable_negative;
    bool energized;                 /**< the axis has taken over the enabled drive */
    bool shutting_down;
    bool reset_sent;
    cm1e_command_state_t reset_state;
    cm1e_error_t reset_error;
    int64_t free_ns;                /**< since when no torque is asked for */
    int64_t brake_until_ns;         /**< so long at least the torque stays to brake */
} power_t;

/** Why the axis is in ErrorStop. Written by axis_power.h and axis_power.c. */
typedef struct fault {
    cm1e_error_t error;
    uint16_t device_error;
    double value, bound;            /**< numbers for the text */
} fault_t;

/* ---- silence: axis_pause.h --------------------------------------------------------------------------------------- */

/** A motor needs so many cycles to recover from one in which its target stood. */
enum { CM1E_SHAKEN_BY_SILENCE = 8 };

/** Cycles without an answer of the bus. Written by axis_pause.h and axis_pause.c. */
typedef struct silence {
    uint16_t shaken;                /**< by silence not long ago: CM1E_SHAKEN_BY_SILENCE for each cycle of it, one less
                                         with each answer */
    uint16_t silent, silent_before; /**< cycles in a row without an answer; those that the present one has ended */
    bool blind;                     /**< the actual position was not fresh, and the set-point goes on */
    bool frozen;                    /**< no answer to the last frame: set-points stay in this cycle */
    bool resumed;                   /**< a pause or silence before this cycle has been dealt with */
    bool began_anew;                /**< after it the motion began anew, with another velocity */
} silence_t;

/* ---- backlash: axis_backlash.h ----------------------------------------------------------------------------------- */

/** The gap between motor and load; counts in the direction in which u grows. Written by axis_backlash.h and
 *  axis_backlash.c. */
typedef struct backlash {
    double velocity, acceleration; /**< of its compensation; counts/s, counts/s2 */
    double offset;                 /**< -gap ... 0: of the motor as seen from the load */
    double offset_velocity, target;
    double gap;                    /**< 0: none; every cycle looks at it */
} backlash_t;

/* ---- in position: axis_in_position.h ----------------------------------------------------------------------------- */

/** Whether the motor is where its set-point stands. Written by axis_in_position.h, axis_in_position.c and
 *  axis_parameter.c. */
typedef struct in_position {
    double missed_actual, missed_by; /**< for the text; u */
    double window;              /**< u, to either side */
    uint32_t time_us, timeout_us;
    float torque;               /**< % of rated torque, while it waited last: a fault takes it away; NAN: not known */
    /* what every cycle looks at */
    bool inside;                /**< where it was seen last, the motor is in the window; FALSE: the set-point moves */
    bool there;                 /**< it has been in the window for the time */
    bool done_waits;
    bool missed;                /**< an error ended a command that waited */
    int64_t inside_ns;          /**< since when */
    int64_t arrived_ns;         /**< since when the set-point of that command stands */
    cm1e_command_id_t settling; /**< the command that waits for the motor while it is active and the axis holds */
} in_position_t;

/* ---- touch probes, digital signals, objects: axis_device.h ------------------------------------------------------- */

enum { PROBES = 2 * 6 }; /* every input, both edges */

/** A touch probe: what it waits for stands in its place in the list. */
typedef struct probe {
    uint32_t id;
    int16_t error;      /**< cm1e_error_t */
    uint8_t state;      /**< cm1e_command_state_t */
    bool window;
    union {
        struct { double first, last; };           /**< u; the window, while it waits */
        struct { double position, uncertainty; }; /**< u; when it is done */
    };
} probe_t;

typedef struct probe_sample {
    int64_t time_ns;
    position_t position;            /**< of the load */
    uint16_t inputs;
} probe_sample_t;

/** Digital signals and touch probes. Written by axis_probe.c, axis_digital.c and axis_keep.c. */
typedef struct signals {
    probe_t probes[PROBES];
    probe_sample_t probe_sample;    /**< the last one, while probes are armed */
    int64_t inputs_asked_ns, inputs_since_ns; /**< where SDOs bring them: last, and without an answer since */
    /* what every cycle looks at */
    int64_t output_until_ns;        /**< the digital output goes off then unless it is written again */
    uint32_t probes_armed, probe_count;
} signals_t;

enum { OBJECT_REQUESTS = 8 };

/** A vendor parameter that is asked for (axis_object.c). */
typedef struct object_request {
    uint32_t ticket; /**< number << 16 | sequence; 0: none */
    int16_t error;   /**< cm1e_error_t */
    uint8_t state;   /**< cm1e_command_state_t */
    bool write;
    double value;
} object_request_t;

/** Vendor parameters that are asked for. Written by axis_object.c. */
typedef struct objects {
    uint16_t head, next;                        /**< sequence of the one under way, and of the next to be asked for */
    bool submitted;
    object_request_t requests[OBJECT_REQUESTS]; /**< by sequence */
    uint8_t data[8];
    cm1e_sdo_t sdo;
} objects_t;

/* ---- motions of the drive: axis_driving.h ------------------------------------------------------------------------ */

typedef enum drive_step {
    DRIVE_WRITE = 0, /**< parameters; the axis still holds its position */
    DRIVE_SWITCH,    /**< to the mode of the motion */
    DRIVE_GO,        /**< the set-point is announced */
    DRIVE_MOVE,
    DRIVE_HALT,      /**< halt bit set, until the motor stands */
    DRIVE_RETURN,    /**< back to the axis's own mode */
} drive_step_t;

enum { DRIVE_PARAMETERS = 2 };

/** A motion that the drive does by itself. Written by axis_drive_profile.c. */
typedef struct driving {
    drive_step_t step;
    home_goal_t goal;
    bool velocity_mode;      /**< profile velocity instead of profile position */
    double way;              /**< sign of its direction, in u */
    int32_t target;          /**< counts of the drive */
    int32_t target_velocity; /**< counts/s */
    double speed, braking;   /**< counts/s, counts/s2 */
    uint32_t raw[DRIVE_PARAMETERS];
    uint8_t next;            /**< parameter to write next */
    bool submitted;
    uint8_t data[4];
    cm1e_sdo_t sdo;
    int64_t step_ns, quiet_ns; /**< when the step began; since when the motor stands */
    int32_t quiet_position;
} driving_t;

/* ---- what was not set: axis_text.h ------------------------------------------------------------------------------- */

typedef enum not_set_what {
    NOT_SET_PARAMETER = 0, /**< `number` */
    NOT_SET_POSITION,      /**< MC_SetPosition */
    NOT_SET_OVERRIDE,      /**< MC_SetOverride; see override_refused */
    NOT_SET_OUTPUT,        /**< digital output `number` */
    NOT_SET_PROBE,         /**< a touch probe at input `number` */
    NOT_SET_CAM,           /**< MC_CamTableSelect; see cams_t */
    NOT_FINISHED,          /**< a command, of the kind `number`, that was taken and ended with the error */
} not_set_what_t;

/** What else than a command at its start was refused last, for the text. Written by axis_text.h and axis_record.c. */
typedef struct not_set {
    cm1e_error_t error; /**< CM1E_OK: it was set */
    not_set_what_t what;
    int number;
    double value;
    uint32_t abort_code;
} not_set_t;

/* ---- the axis ---------------------------------------------------------------------------------------------------- */

/** Everything in its room runs in the cycle unless marked otherwise. The order is that of the memory: what every cycle
 *  looks at stands together, at the end of one part and the begin of the next. */
struct cm1e_axis {
    cm1e_drive_t drive;
    cm1e_axis_state_t state;        /**< cm1e_axis_go() */
    cm1e_mode_t mode;               /**< of the set-points: CSP, or CSV where the mapping has no target position */
    uint16_t handle;
    bool advanced;                  /**< its set-point is that of this cycle */
    bool observed;                  /**< somebody follows its actual value, or has; an encoder always is */
    power_t power;
    silence_t silence;
    homing_step_t homing_step;
    double cycle_s;
    int64_t now_ns;
    const axis_events_t *events;    /**< what a motion tells those that command it */
    const motor_hooks_t *motor_hooks; /**< NULL: the motor is a CM1-E, or there is none */
    const coupling_hooks_t *coupling_hooks; /**< NULL: it cannot follow, nor be followed */
    struct coupling *coupling;      /**< theirs */
    commands_t commands;
    signals_t signals;
    objects_t objects;
    backlash_t backlash;
    setpoint_t setpoint;
    guarding_t guarding;
    axis_position_t position;
    limits_t limits;
    in_position_t in_position;
    superimposed_t superimposed;
    /* not in every cycle */
    cm1e_axis_leader_t leader;      /**< next is NULL: none */
    const cm1e_axis_config_t *config;
    fault_t fault;
    guard_t broken;                 /**< with CM1E_ERROR_AXIS_COUPLING_LIMIT */
    not_set_t not_set;
    override_t override, override_refused; /**< the latter for the text; one that is good: none was */
    const void *group;              /**< that it belongs to; NULL: none */
    tables_t *tables;               /**< NULL: none (cm1e_axis_config_t.table_profiles) */
    driving_t driving;
    const homing_hooks_t *homing_hooks; /**< NULL: it cannot be homed */
    struct homing *homing;          /**< theirs */
    struct cool_muscle *muscle;     /**< of the motor's hooks */
};

#endif
