/**
 * @file axis_parts.h
 * The data of an axis: a struct for each of its parts, and the axis, which is made of them. The functions of a part are
 * in its own header. commands_t and superimposed_t are in axis_move.h.
 */
#ifndef CM1E_AXIS_AXIS_PARTS_H
#define CM1E_AXIS_AXIS_PARTS_H

#include "axis/axis_hooks.h"
#include "axis/axis_move.h"
#include "axis/axis_place.h"
#include "device/unit.h"
#include "drive/drive.h"
#include "motion/slow_time.h"

/* ---- set-points from outside: axis_outside.h --------------------------------------------------------------------- */

enum { OUTSIDE_WAITING = 8 };

/** Positions that a program has given. Written by axis_outside.c. */
typedef struct outside {
    double lines[OUTSIDE_WAITING]; /**< u, as cm1e_axis_line() counts: those not used yet */
    double velocity;               /**< u/s; of the last one that was used */
    uint8_t first, count;
    bool overrun;                  /**< more came during a silence than can wait */
} outside_t;

/* ---- set-point: axis_setpoint.h ---------------------------------------------------------------------------------- */

/** A motor that has run ahead of its set-point: axis_pursuit.h. */
typedef struct pursuit {
    double velocity;                /**< u/s; of the set-point before the motor ran ahead */
    double speed;                   /**< u/s; of the motor then: it lags by two cycles */
    double unheard_s;               /**< without targets */
    uint16_t cycles;                /**< in which the set-point has gone after it */
    bool under_way;                 /**< it has run ahead */
    bool holds;                     /**< no motion follows: it is held near where it comes to rest */
    uint8_t waits;                  /**< for so many answers after the pause: axis_pursuit.c */
} pursuit_t;

/** The set-point: its source, its state of motion, and the profile that it follows. Written by axis_setpoint.h,
 *  axis_course.h, axis_motion.c, axis_ordinary.c and axis_pursuit.c. */
typedef struct setpoint {
    const source_t *source;         /**< cm1e_axis_set_source() */
    bool reached, positive_before;
    bool synchronizing;             /**< it follows after an approach, and was not in step yet */
    bool paused;                    /**< the profile ends before the target; the command waits (MC_SetOverride) */
    bool stands;                    /**< the base motion has ended, and only a superimposed one goes on */
    bool brakes_hard;               /**< the set-point is on a ramp without a limit of jerk */
    uint32_t ends;                  /**< ends of a cam that it passed; see cm1e_command_status_t */
    uint32_t jumps;                 /**< how often it jumped to the actual position; no slave may follow a jump */
    uint32_t course;                /**< a number for what was decided ahead: axis_course.h */
    position_t position;            /**< set position */
    double velocity, acceleration;  /**< set velocity and acceleration; u/s, u/s2 */
    double profile_next_s;          /**< time of the profile in the next cycle */
    double ordinary_until_s;        /**< time of the profile until which its cycles are ordinary (axis_ordinary.c) */
    cm1e_profile_stretch_t stretch; /**< the stretch of the profile that the set-point is in */
    position_t base, target;        /**< base: where the profile began; target: where it ends, exactly */
    double base_line;               /**< u; cm1e_axis_line() of base */
    int64_t profile_cycles;         /**< cycles since the profile began */
    double profile_offset_s;        /**< the profile began so long before the first of these cycles */
    cm1e_slow_time_t slow;          /**< of a table over time (axis_pause.c) */
    double loop_velocity;           /**< counts/s that the position loop adds in CSV */
    cm1e_profile_t profile;         /**< relative to base, in u; along a table only its duration and end */
    pursuit_t pursuit;              /**< with EXTRA_PURSUIT */
} setpoint_t;

/* ---- position: axis_position.h ----------------------------------------------------------------------------------- */

/** Counts of the drive, units, turns of a modulo axis, the origin. Written by axis_position.h and axis_position.c. */
typedef struct axis_position {
    cm1e_unit_t unit;               /**< the amount of `scale`, exactly */
    double modulo_range;            /**< u; 0: a linear axis */
    cm1e_fraction_t turn;           /**< counts per turn */
    double count;                   /**< counts of this motor on the way of one count of a CM1-E */
    /* read in every cycle */
    double origin_units;
    position_t origin;              /**< where the position is origin_units; modulo axis: 0 */
    double scale;                   /**< counts per u; negative: inverted */
    int64_t actual_counts;          /**< last known counts of the drive, without wrap-around */
    int32_t raw;                    /**< last known counts of the drive */
    bool known, homed;
} axis_position_t;

/* ---- limits and guard: axis_limits.h, axis_guard.h --------------------------------------------------------------- */

/** How far a set-point may differ from the one before it, in the form that is compared. Computed once. Written by
 *  axis_guard.c. */
typedef struct guarding {
    double velocity;         /**< u/s */
    double up, down;         /**< u/s in a cycle */
    double acceleration;     /**< u/s2 */
    double jerk, twice_jerk; /**< u/s2 in a cycle; u/s3, 0 in a group */
    double ease;             /**< s3/u; times the square of an acceleration: the velocity that it adds until it ends */
    double half_cycle, step; /**< counts in half a cycle at 1 u/s; tolerance in counts around the mean velocity */
    double per_count;        /**< u, signed */
    double per_step;         /**< u/s for a count beside the mean velocity, in the second difference; 0 in a group */
    uint32_t own_course, leaders_course; /**< of a led axis: about which something was decided */
    uint32_t kept_course;    /**< its own_course, if all set-points on both are well within the limits */
} guarding_t;

/** The limits of the axis: dynamics, software limits, directions. Written by axis_limits.c and axis_parameter.c. */
typedef struct limits {
    /* read in every cycle */
    bool lag_monitoring;
    bool software_limits;           /**< at least one of them is in force */
    bool positive_enabled, negative_enabled;
    int32_t counts_limit;           /**< range of the motor's counts in either direction, by K37; 0: no limit */
    double max_lag;                 /**< u */
    double lower, upper;            /**< u, as cm1e_axis_line() counts: limits in force; infinite: none */
    double tolerance;               /**< u; tolerance of these limits */
    double emergency_way;           /**< s2/u; times the square of a velocity: the way of an emergency stop */
    cm1e_motion_limits_t system;    /**< u; of motor and configuration */
    cm1e_motion_limits_t maximum;   /**< u; what the application allows: the maximum of commands */
    cm1e_motion_limits_t emergency; /**< u; the ramp of an error: `system` without a limit of jerk */
    double positive, negative;      /**< u; the software limits as written */
    double counts_lower, counts_upper; /**< u, as cm1e_axis_line() counts: the ends of that range; infinite: none */
} limits_t;

/** The limits that a set-point from outside the axis (a master, a leader) could break. */
typedef enum guard_limit {
    GUARD_KEPT = 0,
    GUARD_FINITE,
    GUARD_PAUSE,       /**< after a pause: the motor has gone on without set-points (axis_pause.c) */
    GUARD_DIRECTION,
    GUARD_VELOCITY,
    GUARD_ACCELERATION,
    GUARD_DECELERATION,
    GUARD_JERK,
    GUARD_STEP,
    GUARD_SOFTWARE_LIMIT,
    GUARD_COUNT,
} guard_limit_t;

/** The limit that a set-point broke, and by how much. Written by axis_guard.c. */
typedef struct guard {
    guard_limit_t limit;
    double asked, allowed; /**< in the units of the limit */
    bool by_actual;        /**< it follows the actual value of a master */
    bool from_outside;     /**< it came from outside (axis_outside.c) */
} guard_t;

/* ---- power and errors: axis_power.h ------------------------------------------------------------------------------ */

/** What MC_Power and MC_Reset command, and its progress. Written by axis_power.h, axis_power.c and axis_free.c. */
typedef struct power {
    const void *owner;
    bool enable, enable_positive, enable_negative;
    bool energized;                 /**< the axis has taken over the enabled drive */
    bool claimed : 1;               /**< the program has called MC_Power: nobody else enables (axis_guest.h) */
    bool shutting_down : 1;
    bool letting_go : 1;            /**< the torque goes first, also if power is wanted again by now */
    bool reset_sent : 1;
    bool held : 1;                  /**< the set-point rests and the motor is to rest too, since `held_ms`: the torque
                                         is to go, or the axis to be taken over */
    uint8_t turning : 2;            /**< of a motor that turned when it got its torque: 1: it has gone away from the
                                         set-point at rest; 2 and 3: for one and more cycles it has come back */
    uint8_t reset_state : 4;        /**< cm1e_command_state_t */
    uint8_t undecided : 4;          /**< cycles in which it was not known whether the motor rests: with torque that is
                                         not taken over yet, else the last one */
    uint16_t held_ms;               /**< the lower bits of the time */
    cm1e_error_t reset_error;
    float velocity;                 /**< counts/s of the motor. Before the axis takes over: in the cycle before, 0
                                         without torque. `held`: how fast it was at first, or came back since */
    int64_t free_ns;                /**< since when no torque is commanded */
    int64_t brake_until_ns;         /**< until then the torque stays at least, to brake */
    uint64_t settled;               /**< what the owner shows while the power stage is on and it has nothing to do; 0:
                                         it has, or may have */
} power_t;

/** Why the axis is in ErrorStop. Written by axis_power.h and axis_power.c. */
typedef struct fault {
    cm1e_error_t error;
    uint16_t device_error;
    bool late;                      /**< the program did not stand still, but every cycle was late */
    double value, bound;            /**< numbers for the text */
    const char *task;               /**< that did not return, of the scheduler; NULL: none */
} fault_t;

/* ---- silence: axis_pause.h --------------------------------------------------------------------------------------- */

/** Cycles that a motor needs to recover from a cycle without a new target. */
enum { CM1E_SHAKEN_BY_SILENCE = 8 };

/** What was before this cycle and has been dealt with in it. */
typedef enum resumed {
    RESUMED_FROM_NOTHING = 0,
    RESUMED_FROM_SILENCE,
    RESUMED_FROM_PAUSE,             /**< the inputs are from before it: the next frame tells what the motor did
                                         meanwhile */
} resumed_t;

/** Cycles in which no answer came from the bus. Written by axis_pause.h and axis_pause.c. */
typedef struct silence {
    uint16_t shaken;                /**< recent silence: plus CM1E_SHAKEN_BY_SILENCE for each silent cycle, minus
                                         one for each answer */
    uint16_t silent, silent_before; /**< cycles in a row without an answer: until now; before this answer */
    bool blind;                     /**< the actual position was not fresh, and the set-point goes on */
    bool frozen;                    /**< no answer to the last frame: set-points stay in this cycle */
    uint8_t resumed;                /**< resumed_t */
    bool began_anew;                /**< the motion began anew after it, with another velocity */
} silence_t;

/* ---- backlash: axis_backlash.h ----------------------------------------------------------------------------------- */

/** The backlash between motor and load, in counts in the direction in which u grows. Written by axis_backlash.h and
 *  axis_backlash.c. */
typedef struct backlash {
    double velocity, acceleration; /**< of its compensation; counts/s, counts/s2 */
    double offset;                 /**< -gap ... 0: position of the motor relative to the load, as set-points have it */
    double seen;                   /**< -gap ... 0: the same by the positions of the motor, which moves its load by a
                                        flank only */
    double offset_velocity, target;
    double slip;                   /**< by how much it has changed at the last position of a motor without torque */
    double gap;                    /**< 0: no backlash */
} backlash_t;

/* ---- in position: axis_in_position.h ----------------------------------------------------------------------------- */

/** Whether the motor is at its set-point while that is at rest. Written by axis_in_position.h, axis_in_position.c and
 *  axis_parameter.c. */
typedef struct in_position {
    double missed_actual, missed_by; /**< for the text; u */
    double window;              /**< u, to either side */
    uint32_t time_us, timeout_us;
    float torque;               /**< % of rated torque during the last wait, before a fault cleared it; NAN: unknown */
    /* read in every cycle */
    bool inside;                /**< the last known position is in the window; false while the set-point moves */
    bool there;                 /**< it has been in the window for the configured time */
    bool done_waits;
    bool missed;                /**< a command that waited for it ended with an error */
    int64_t inside_ns;          /**< since when it is inside */
    int64_t arrived_ns;         /**< since when the set-point is at rest */
    cm1e_command_id_t settling; /**< the active command that waits for the motor */
} in_position_t;

/* ---- touch probes, digital signals, objects: axis_device.h ------------------------------------------------------- */

enum { PROBES = 2 * 6, WIRED_PROBES = 2 * CM1E_WIRED_SIGNALS }; /* every input, both edges */

/** A touch probe. Its place in the list states its input and edge. */
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
    position_t position;            /**< position of the load */
    uint16_t inputs;                /**< those of the motor, or bit 0: that of the one signal of another slave */
} probe_sample_t;

/** Touch probes on signals of the motor, beside the axis: most axes arm none. */
typedef struct own_probes {
    probe_t probes[PROBES];
    probe_sample_t last;            /**< the last one, while probes are armed */
} own_probes_t;

/** Touch probes on signals of other slaves. */
typedef struct wired_probes {
    probe_t probes[WIRED_PROBES];
    probe_sample_t last[CM1E_WIRED_SIGNALS]; /**< of each signal, the last one that its slave has given */
} wired_probes_t;

/** Digital signals and touch probes. Written by axis_probe.c, axis_digital.c and axis_keep.c. */
typedef struct signals {
    own_probes_t *own;              /**< made with the axis */
    wired_probes_t *wired;          /**< NULL: no inputs on other slaves */
    int64_t inputs_asked_ns, inputs_since_ns; /**< inputs by SDO: last request; since when without an answer */
    /* read in every cycle */
    int64_t output_until_ns;        /**< the digital output goes off then unless it is written again */
    uint32_t probes_armed, probe_count;
} signals_t;

enum { OBJECT_REQUESTS = 8 };

/** A request for a vendor parameter (axis_object.c). */
typedef struct object_request {
    uint32_t ticket; /**< number << 16 | sequence; 0: none */
    int16_t error;   /**< cm1e_error_t */
    uint8_t state;   /**< cm1e_command_state_t */
    bool write : 1;
    bool again : 1;  /**< it was asked for before, and refused */
    double value;
} object_request_t;

/** Requests for vendor parameters. Written by axis_object.c. */
typedef struct objects {
    bool submitted;
    object_request_t requests[OBJECT_REQUESTS]; /**< by sequence */
    uint8_t data[8];
    cm1e_sdo_t sdo;
    /* what every cycle looks at */
    uint16_t head, next;                        /**< sequence of the one under way, and of the next to be asked for */
} objects_t;

/* ---- motions of the drive: axis_driving.h ------------------------------------------------------------------------ */

typedef enum drive_step {
    DRIVE_WRITE = 0, /**< writes the parameters; the axis still holds its position */
    DRIVE_SWITCH,    /**< switches to the mode of the motion */
    DRIVE_GO,        /**< the set-point is announced */
    DRIVE_MOVE,
    DRIVE_HALT,      /**< halt bit set, until the motor stands */
    DRIVE_RETURN,    /**< switches back to the axis's own mode */
} drive_step_t;

enum { DRIVE_PARAMETERS = 2 };

/** Watches whether a motor that is not led by set-points is at standstill. */
typedef struct standstill {
    int64_t since_ns; /**< since when the motor has been within the tolerance of `position` */
    int32_t position; /**< counts of the drive */
} standstill_t;

/** A motion that the drive does by itself. */
typedef struct driving {
    drive_step_t step;
    home_goal_t goal;
    bool velocity_mode;      /**< profile velocity instead of profile position */
    double way;              /**< sign of its direction, in u */
    int32_t target;          /**< counts of the drive */
    int32_t target_velocity; /**< counts/s */
    double speed;            /**< counts/s */
    double acceleration, braking; /**< counts/s2 */
    uint32_t raw[DRIVE_PARAMETERS];
    uint8_t next;            /**< parameter to write next */
    bool submitted;
    uint8_t data[4];
    cm1e_sdo_t sdo;
    int64_t step_ns;         /**< when the step began */
    int64_t profile_ns;      /**< how long a motion to a position takes at most */
    int64_t nearest;         /**< counts: how near to its target the motor was */
    int64_t due_ns;          /**< since when it should rest there: it comes no nearer */
    standstill_t standstill;
} driving_t;

/* ---- what was not set: axis_text.h ------------------------------------------------------------------------------- */

typedef enum not_set_what {
    NOT_SET_PARAMETER = 0, /**< `number` */
    NOT_SET_POSITION,      /**< MC_SetPosition */
    NOT_SET_OVERRIDE,      /**< MC_SetOverride; see override_refused */
    NOT_SET_OUTPUT,        /**< digital output `number` */
    NOT_SET_PROBE,         /**< a touch probe at input `number` */
    NOT_READ_INPUT,        /**< digital input `number` */
    NOT_READ_OUTPUT,       /**< digital output `number` */
    NOT_SET_CAM,           /**< MC_CamTableSelect; see cams_t */
    NOT_SET_CAM_SWITCH,    /**< MC_DigitalCamSwitch: the input of switch `number` that is `value` */
    NOT_SET_INPUT,         /**< the input of a block that is `value`; see `name` and `right` */
    NOT_FINISHED,          /**< a command of the kind `number` was accepted and ended with the error */
} not_set_what_t;

/** The last refusal that was not the start of a command, for the text. Written by axis_text.h and axis_record.c. */
typedef struct not_set {
    cm1e_error_t error; /**< CM1E_OK: it was set */
    uint8_t what;       /**< not_set_what_t */
    bool repeated;      /**< by a block that is refused in every call */
    union {
        int number;
        const char *name;    /**< of an input */
    };
    double value;
    union {
        uint32_t abort_code; /**< of a parameter */
        uint32_t input;      /**< of a switch: cm1e_cam_switch_input_t */
        const char *right;   /**< of an input: which values are right */
    };
} not_set_t;

/* ---- beside the motion: axis_extras.h ---------------------------------------------------------------------------- */

/** What an axis may have to do in a cycle beside its motion. Most axes have nothing of it in most cycles, which one
 *  test shows. */
typedef enum extra {
    EXTRA_SIGNALS = 1,  /**< a digital output is on, a motion has to be kept, or other slaves have its signals */
    EXTRA_AWAITS = 2,   /**< the first waiting command begins at a place of its master (StartSync); until then the
                             active one goes on */
    EXTRA_ON_TOP = 4,   /**< a superimposed motion is a part of the set-point, or waits for room */
    EXTRA_BACKLASH = 8, /**< there is a gap between motor and load */
    EXTRA_OBJECTS = 16, /**< vendor parameters are asked for */
    EXTRA_PURSUIT = 32, /**< the motor has run ahead of its set-point, or perhaps has */
    EXTRA_DISTURBED = 64, /**< our set-points do not act on the motor, or no answer came in this cycle or before it */
} extra_t;

/** What the axis is a part of. Written by axis.c and axis_lead.c. */
typedef struct belongs {
    const void *group; /**< the group of the axis; NULL: none */
    const void *cycle; /**< what runs its cycle: cm1e_axis_share_cycle(); NULL: its bus alone */
} belongs_t;

/** Memory that is set aside when the axis is made, where the configuration asks for it. Written by axis_table.c,
 *  axis_table_text.c and axis_drive_profile.c. */
typedef struct set_aside {
    tables_t *tables;   /**< NULL: none (cm1e_axis_config_t.table_profiles) */
    driving_t *driving; /**< NULL: the host makes the motions (cm1e_axis_config_t.motion) */
} set_aside_t;

/* ---- the axis ---------------------------------------------------------------------------------------------------- */

/** The axis. All functions of this room run in the cycle unless marked otherwise. The order of the members keeps those
 *  together in memory that every cycle reads: they are at the end of one part and at the beginning of the next, and an
 *  axis begins at a cache line. */
struct cm1e_axis {
    cm1e_drive_t drive;
    /* not in every cycle: it fills a cache line up */
    not_set_t not_set;
    belongs_t belongs;
    struct followed *followed;      /**< data of coupling_hooks about its slaves */
    const axis_events_t *events;    /**< how a motion reports its end and its failure */
    /* in every cycle */
    signals_t signals;
    cm1e_axis_state_t state;        /**< cm1e_axis_go() */
    cm1e_mode_t mode;               /**< mode of the set-points: CSP, or CSV if the mapping has no target position */
    uint16_t handle;
    bool advanced;                  /**< its set-point is that of this cycle */
    uint8_t extras;                 /**< extra_t; cm1e_axis_set_extra() */
    bool observed;                  /**< a slave follows its actual value, or has followed it; an encoder: always */
    power_t power;
    silence_t silence;
    homing_step_t homing_step;
    double cycle_s;
    int64_t now_ns;
    const motor_hooks_t *motor_hooks; /**< NULL: the motor is a CM1-E, or there is none */
    const coupling_hooks_t *coupling_hooks; /**< NULL: it can neither follow nor be followed */
    struct coupling *coupling;      /**< data of these hooks; NULL: it follows nothing */
    commands_t commands;
    objects_t objects;
    in_position_t in_position;
    guarding_t guarding;
    axis_position_t position;
    limits_t limits;
    fault_t fault;
    superimposed_t superimposed;
    setpoint_t setpoint;            /**< begins at a cache line, which has all that others ask of it in every cycle */
    backlash_t backlash;
    /* not in every cycle */
    cm1e_axis_leader_t *leader;     /**< NULL: none */
    const cm1e_axis_config_t *config;
    guard_t broken;                 /**< with CM1E_ERROR_AXIS_COUPLING_LIMIT */
    override_t override, override_refused; /**< the second: the last refused one, for the text */
    outside_t outside;
    set_aside_t set_aside;
    const homing_hooks_t *homing_hooks; /**< NULL: it cannot be homed */
    struct homing *homing;          /**< data of homing_hooks */
    struct cool_muscle *muscle;     /**< data of motor_hooks */
};

#endif
