/**
 * @file axis_private.h
 * The axis as the sources of its room see it. Everything here runs in the cycle unless marked otherwise.
 */
#ifndef CM1E_AXIS_AXIS_PRIVATE_H
#define CM1E_AXIS_AXIS_PRIVATE_H

#include <math.h>

#include "axis/axis.h"
#include "cm1e/cml.h"
#include "device/unit.h"
#include "motion/profile.h"
#include "motion/table_profile.h"

#define MS_IN_NS INT64_C(1000000)

/** A position in counts without loss: whole counts and 0 <= fraction < 1. A double would lose the fraction after days
 *  in one direction. */
typedef struct position {
    int64_t counts;
    double fraction;
} position_t;

static inline position_t cm1e_position_plus(position_t position, double counts)
{
    const int64_t whole = (int64_t)counts;
    const double sum = position.fraction + (counts - (double)whole); /* -1 < sum < 2 */
    const double carry = sum >= 1.0 ? 1.0 : sum < 0.0 ? -1.0 : 0.0, fraction = sum - carry;
    position.counts += whole + (int64_t)carry;
    /* -1e-20 + 1 is 1 */
    return fraction < 1.0 ? (position_t){position.counts, fraction} : (position_t){position.counts + 1, 0.0};
}
static inline double cm1e_position_minus(position_t a, position_t b)
{
    return (double)(a.counts - b.counts) + (a.fraction - b.fraction);
}
/** Beyond 2^52 a double no longer resolves half a count; at full speed that is 57 years away. */
#define CM1E_FARTHEST_COUNTS (INT64_C(1) << 52)
static inline bool cm1e_position_in_range(position_t position)
{
    return (uint64_t)position.counts + CM1E_FARTHEST_COUNTS - 1 < 2 * (uint64_t)CM1E_FARTHEST_COUNTS - 1;
}

/** Whether the place so many counts away is one: a way of any size, also none that can be counted. */
static inline bool cm1e_position_reaches(position_t from, double counts)
{
    return fabs(counts) < (double)CM1E_FARTHEST_COUNTS && cm1e_position_in_range(cm1e_position_plus(from, counts));
}

/** As far there as the axis counts: for what is judged by how fast it is, and found too fast. */
static inline position_t cm1e_position_towards(position_t from, double counts)
{
    const double most = (double)CM1E_FARTHEST_COUNTS;
    return cm1e_position_plus(from, fabs(counts) < most ? counts : copysign(most, counts));
}

/** Where the set-point comes from. */
typedef enum activity {
    ACTIVITY_FREE = 0, /**< nowhere: no torque, the set-point is the actual position */
    ACTIVITY_HOLD,     /**< it stands */
    ACTIVITY_PROFILE,  /**< a profile, of a command or of a stopping ramp */
    ACTIVITY_COUPLED,  /**< other axes, its masters (axis_coupling.h) */
    ACTIVITY_HOMING,   /**< the drive's own homing (axis_home.c) */
    ACTIVITY_DRIVE,    /**< the drive's own profile (axis_drive_profile.c) */
    ACTIVITY_LED,      /**< somebody above (axis_lead.c) */
} activity_t;

enum { COMMANDS_REMEMBERED = 32, HOMING_PARAMETERS = 5 };

/** How a command ended. */
typedef struct command_record {
    cm1e_command_id_t id;
    int16_t error;      /**< cm1e_error_t */
    uint8_t state;      /**< cm1e_command_state_t */
} command_record_t;

/** A command as it is kept: what it asks for, and what is known of its way. */
typedef struct move {
    cm1e_command_id_t id;
    uint8_t kind, buffer_mode, direction; /**< cm1e_command_kind_t, MC_BUFFER_MODE, MC_DIRECTION */
    bool passing;           /**< MOVE_CONTINUOUS_*: only its end velocity is left to be reached, not its position */
    double position, velocity, end_velocity, acceleration, deceleration, jerk;
    position_t origin;      /**< what a relative position counts from */
    position_t target;      /**< where it ends */
    double exit_velocity;   /**< u/s, signed: with which it passes its target, because another one goes on from there */
    bool paused;            /**< an override of velocity 0: it brakes to a standstill and waits */
} move_t;

/** Commands that wait behind the active one, in their order: a ring. */
typedef struct buffer {
    move_t moves[CM1E_AXIS_BUFFER_DEPTH];
    uint8_t first, count;
} buffer_t;

/** What a waiting MC_Home needs beside its command. */
typedef struct waiting_homing {
    cm1e_homing_config_t config;
    bool configured;    /**< that of the axis instead */
} waiting_homing_t;

/** The points of a table profile as the axis keeps them until the motion begins. */
typedef struct table_points {
    int count;
    bool absolute;
    cm1e_table_point_t points[CM1E_TABLE_POINTS_MAX];
} table_points_t;

/** Room for table profiles, made with the axis. */
typedef struct tables {
    cm1e_table_profile_t running;
    cm1e_command_id_t waiting_id;
    table_points_t waiting;
} tables_t;

enum { STEPS_WAITING = 3 };

/** What a waiting step of a homing needs beside its command. */
typedef struct waiting_step {
    cm1e_command_id_t id;
    cm1e_homing_step_t step;
} waiting_step_t;

/** Factors of MC_SetOverride; acceleration: also for the deceleration. */
typedef struct override {
    double velocity, acceleration, jerk;
} override_t;

/** Where a motion begins. */
typedef struct from {
    position_t position;
    double velocity, acceleration; /**< u/s, u/s2 */
    bool shared;                   /**< a superimposed motion goes on above it and needs its part of the limits */
} from_t;

/** A motion on top of the commanded one (3.8), which is called the base of it. */
typedef struct superimposed {
    cm1e_command_id_t id;          /**< MC_MoveSuperimposed, or MC_HaltSuperimposed; 0: none */
    bool moving;                   /**< FALSE: it waits until the base has room for it */
    bool paused;                   /**< an override of velocity 0 */
    bool alone;                    /**< began in Standstill: there is no base to share with */
    cm1e_motion_limits_t share;    /**< what of the axis's maxima is its own; acceleration = deceleration */
    cm1e_profile_t profile;        /**< from where the command began, in u */
    int64_t cycles;
    cm1e_motion_state_t now;       /**< its part of the present set-point */
    double lowest, highest;        /**< u; of all its way */
    cm1e_command_id_t ended;       /**< the last one, and what it had covered, u */
    double covered;
    move_t move;
} superimposed_t;

/** Drives that home in different ways (axis_home.c). */
typedef enum homing_kind_id { HOMING_CM1E = 0, HOMING_CM1, HOMING_CM2 } homing_kind_id_t;

typedef enum home_step {
    HOME_READ = 0,  /**< the unit of the offset over SDO; the axis holds its position */
    HOME_REST,      /**< it holds its position until the motor stands */
    HOME_WRITE,     /**< parameters over SDO; the axis holds its position, or stands in homing mode */
    HOME_SWITCH,    /**< to homing mode */
    HOME_TAKEN,     /**< the drive takes the parameters over */
    HOME_START,     /**< start bit set; the status bits are still those of before */
    HOME_RUN,
    HOME_SETTLE,    /**< the drive has ended: until the motor stands */
    HOME_HALT,      /**< halt bit set, or start bit taken away, until the motor stands */
    HOME_RETURN,    /**< back to the axis's own mode */
} home_step_t;

/** What comes after the drive has stopped homing. */
typedef enum home_goal { HOME_GOAL_DONE = 0, HOME_GOAL_HOLD, HOME_GOAL_OFF } home_goal_t;

typedef struct homing {
    home_step_t step;
    home_goal_t goal;
    double position;       /**< u, at the reference */
    double offset;         /**< counts, as asked for */
    int32_t raw[HOMING_PARAMETERS]; /**< in the order of homing_objects (axis_home.c) */
    int32_t k45;           /**< of a CM2: its second digit says what the offset counts in; < 0: not read */
    uint8_t next;          /**< parameter to write next */
    uint8_t place;         /**< of the step in the order of its kind */
    bool submitted;
    bool away;             /**< the axis's own mode is left */
    bool unstoppable;      /**< for the text: it did not stop in time */
    cm1e_sdo_t sdo;
    uint8_t data[4];
    int64_t timeout_ns, deadline_ns, step_ns; /**< step_ns: when the step began */
    int64_t quiet_ns;      /**< since when the motor stands */
    int64_t told_ns;       /**< since when the bits say "interrupted" */
    int32_t quiet_position;
    uint8_t bits_before;   /**< statusword bits 13, 12, 10 before the start */
    cm1e_error_t refused;  /**< why the last homing could not start, for the text; with the numbers in `sdo` */
    uint8_t wrong;         /**< for the text: the last parameter that was out of its range, and its value */
    double wrong_value;
} homing_t;

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

typedef enum drive_step {
    DRIVE_WRITE = 0, /**< parameters; the axis still holds its position */
    DRIVE_SWITCH,    /**< to the mode of the motion */
    DRIVE_GO,        /**< the set-point is announced */
    DRIVE_MOVE,
    DRIVE_HALT,      /**< halt bit set, until the motor stands */
    DRIVE_RETURN,    /**< back to the axis's own mode */
} drive_step_t;

enum { DRIVE_PARAMETERS = 2 };

/** A motion that the drive does by itself. */
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

enum { OBJECT_REQUESTS = 8 };

/** A vendor parameter that is asked for (axis_object.c). */
typedef struct object_request {
    uint32_t ticket; /**< number << 16 | sequence; 0: none */
    int16_t error;   /**< cm1e_error_t */
    uint8_t state;   /**< cm1e_command_state_t */
    bool write;
    double value;
} object_request_t;

typedef struct objects {
    uint16_t head, next;                        /**< sequence of the one under way, and of the next to be asked for */
    bool submitted;
    object_request_t requests[OBJECT_REQUESTS]; /**< by sequence */
    uint8_t data[8];
    cm1e_sdo_t sdo;
} objects_t;

typedef enum not_set_what {
    NOT_SET_PARAMETER = 0, /**< `number` */
    NOT_SET_POSITION,      /**< MC_SetPosition */
    NOT_SET_OVERRIDE,      /**< MC_SetOverride; see override_refused */
    NOT_SET_OUTPUT,        /**< digital output `number` */
    NOT_SET_PROBE,         /**< a touch probe at input `number` */
    NOT_SET_CAM,           /**< MC_CamTableSelect; see cams_t */
    NOT_FINISHED,          /**< a command, of the kind `number`, that was taken and ended with the error */
} not_set_what_t;

/** What else than a command at its start was refused last, for the text. */
typedef struct not_set {
    cm1e_error_t error; /**< CM1E_OK: it was set */
    not_set_what_t what;
    int number;
    double value;
    uint32_t abort_code;
} not_set_t;

/** The gap between motor and load (axis_backlash.c); counts in the direction in which u grows. */
typedef struct backlash {
    double gap;                    /**< 0: none */
    double velocity, acceleration; /**< of its compensation; counts/s, counts/s2 */
    double offset;                 /**< -gap ... 0: of the motor as seen from the load */
    double offset_velocity, target;
} backlash_t;

typedef enum stepping_phase {
    STEPPING_SEARCH = 0, /**< it moves, or presses against a stop */
    STEPPING_STOP,       /**< decided; it brakes, or makes the move of MC_FinishHoming */
    STEPPING_SETTLE,     /**< the set-point stands: the motor comes to it, or is held up */
    STEPPING_RELIEVE,    /**< the set-point goes back from where the motor was held up */
    STEPPING_RELIEVED,
} stepping_phase_t;

/** A homing in steps (axis_homing_steps.c), in force while CM1E_COMMAND_HOMING_STEP is the active command. */
typedef struct stepping {
    cm1e_homing_step_t step;
    cm1e_motion_limits_t limits;
    stepping_phase_t phase;
    cm1e_error_t outcome;           /**< from STEPPING_STOP on */
    double position;                /**< u, to set at the reference; NAN: none */
    position_t reference;           /**< where the event was */
    double search, way;             /**< +-1: direction of the search, and the one it goes now */
    double travel;                  /**< u */
    double pace;                    /**< u/s, of the set-point while the motor is pressed */
    int64_t deadline_ns, pressed_ns;
    int64_t settled_ns;             /**< a motor that is not at its set-point by then is held up */
    position_t actual_before;       /**< at the last look */
    bool level, seen_on, pressed;
    bool turned_positive, turned_negative; /**< at a limit switch */
    bool pushing;                   /**< the set-point may be where the motor cannot go */
    bool after_stop;                /**< MC_Stop ended the step, and the motor is relieved before it is Done */
    bool referenced;                /**< the last step set a position */
    bool finishing;                 /**< positions are valid again: software limits hold */
} stepping_t;

/** Something that a block asked for and polls. */
typedef struct asked {
    uint32_t ticket;            /**< of the last one; 0: none yet */
    cm1e_command_state_t state;
    cm1e_error_t error;
} asked_t;

/** What a motor behind a bridge does beside motion (axis_cool_muscle.c). */
typedef struct cool_muscle {
    int8_t mode, next;          /**< commanded while the axis is Disabled, and what is to be so as soon as it can */
    bool insist;
    bool moved;                 /**< since CML was entered, a string was taken that may have moved the motor */
    bool must_free;             /**< it is to lose its torque before anything else */
    bool failed;                /**< ErrorStop, as of the last cycle */
    bool away;                  /**< the slave was, and its mode is not known since */
    uint32_t freeing;           /**< ticket of the string that does that; 0: none is under way */
    uint32_t last;              /**< ticket of the last string that a block sent; its end is not told yet; 0: it is */
    int64_t release_ns;         /**< shut down is waited for since then; 0: it is not */
    asked_t switching, command;
    const char *why;            /**< of the last refusal, for the text: a sentence; NULL: none */
    char text[CM1E_CML_BYTES + 1]; /**< ... and the string */
} cool_muscle_t;

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

typedef struct guard {
    guard_limit_t limit;
    double asked, allowed; /**< in the units of the limit */
    bool by_actual;        /**< what asked for it was the actual value of a master */
} guard_t;

/** What a set-point may be beside the one before it, in the numbers that are compared; made once. */
typedef struct guarding {
    double velocity;         /**< u/s */
    double up, down;         /**< u/s in a cycle */
    double acceleration;     /**< u/s2 */
    double jerk;             /**< u/s2 in a cycle */
    double half_cycle, step; /**< counts in half a cycle at 1 u/s; counts beside the mean of both velocities */
    double per_count;        /**< u, signed */
} guarding_t;

struct cm1e_axis {
    /* what every cycle of a motion looks at */
    cm1e_drive_t drive;
    activity_t activity;
    cm1e_axis_state_t state;
    cm1e_command_id_t active;       /**< 0: none */
    cm1e_command_kind_t kind;       /**< of the active one */
    cm1e_mode_t mode;               /**< of the set-points: CSP, or CSV where the mapping has no target position */
    uint16_t handle;
    bool reached, positive_before;
    bool paused;                    /**< its end is not that of its command, which waits (MC_SetOverride) */
    bool stands;                    /**< the base has come to its end, only a superimposed motion goes on */
    bool along_table;               /**< tables->running is what moves it */
    bool software_limits;           /**< one of them at least; those in force are ... */
    bool lag_monitoring;
    bool blind;                     /**< they are not, and the set-point goes on */
    bool power_enable, enable_positive, enable_negative;
    bool energized;                 /**< the axis has taken over the enabled drive */
    bool shutting_down;
    bool position_known, homed;
    bool stop_held;
    bool advanced;                  /**< its set-point is that of this cycle */
    bool observed;                  /**< somebody follows its actual value, or has; an encoder always is */
    bool resumed;                   /**< a pause before this cycle has been dealt with */
    const void *power_owner;
    double cycle_s;
    int64_t profile_cycles;         /**< since it began ... */
    double profile_offset_s;        /**< ... so long before the first of them */
    double profile_next_s;          /**< its time in the next cycle */
    cm1e_profile_stretch_t stretch; /**< of it, the one that the set-point is in */
    position_t set, base, target;   /**< base: where the profile began; target: where it ends, exactly */
    double base_line;               /**< u; cm1e_axis_line() of base */
    double set_velocity, set_acceleration; /**< u/s, u/s2 */
    double scale;                   /**< counts per u; negative: inverted */
    double count;                   /**< counts of this motor on the way of one count of a CM1-E */
    double lower, upper;            /**< u, as cm1e_axis_line() counts; infinite: none on that side */
    double tolerance;               /**< u; which they are kept with */
    double emergency_way;           /**< s2/u; times the square of a velocity: that it goes */
    guarding_t guarding;
    double max_lag;                 /**< u */
    double lag_seen;                /**< counts; amount, when the inputs were fresh last */
    int64_t now_ns;
    int64_t actual_counts;          /**< the same without wrap-around */
    int32_t raw;                    /**< counts of the drive, last seen */
    cm1e_command_state_t reset_state;
    uint32_t probes_armed, probe_count;
    cm1e_command_id_t kept;         /**< a command that halts unless it is renewed; 0: none */
    backlash_t backlash;
    superimposed_t superimposed;
    objects_t objects;
    cm1e_profile_t profile;         /**< relative to base, in u; along a table only its duration and end */

    /* the rest */
    const cm1e_axis_config_t *config;

    cm1e_unit_t unit;               /**< its amount, exactly */
    double modulo_range;            /**< u; 0: a linear axis */
    cm1e_fraction_t turn;           /**< counts of it */
    cm1e_motion_limits_t system;    /**< u; of motor and configuration */
    cm1e_motion_limits_t maximum;   /**< u; what the application allows of it: the bounds of commands */
    cm1e_motion_limits_t emergency; /**< u; the ramp of an error: that of `system` without a limit of jerk */
    double limit_positive, limit_negative; /**< u */
    bool limit_positive_enabled, limit_negative_enabled;
    int32_t counts_limit;           /**< of the motor's own counts in either direction, by its K37; 0: none */
    double counts_lower, counts_upper; /**< u, as cm1e_axis_line() counts; where that is; infinite: none */

    cm1e_error_t error;
    uint16_t device_error;
    double error_value, error_bound; /**< numbers for the text */
    guard_t guard;                  /**< with CM1E_ERROR_AXIS_COUPLING_LIMIT */
    cm1e_axis_leader_t leader;      /**< next is NULL: none */
    const void *group;              /**< that it belongs to; NULL: none */

    position_t origin;              /**< position origin_units is there; modulo: 0 */
    double origin_units;

    double loop_velocity;           /**< counts/s that the position loop adds in CSV */
    override_t override, override_refused; /**< the latter for the text; one that is good: none was */

    command_record_t records[COMMANDS_REMEMBERED];
    cm1e_command_id_t last_id;
    move_t move;                    /**< the active one, unless it is a homing */
    buffer_t waiting;
    waiting_homing_t waiting_homing;
    waiting_step_t waiting_steps[STEPS_WAITING];
    tables_t *tables;               /**< NULL: none (cm1e_axis_config_t.table_profiles) */
    cm1e_error_t refusal;           /**< why the last command was refused, for the text; CM1E_OK: it was not */
    cm1e_axis_command_t refused;    /**< what it asked for */
    cm1e_command_id_t stop;         /**< whose MC_Stop holds the axis in Stopping */

    int64_t free_ns;                /**< since when no torque is asked for */
    int64_t brake_until_ns;         /**< so long at least the torque stays to brake */

    cm1e_error_t reset_error;
    bool reset_sent;

    driving_t driving;
    not_set_t not_set;
    homing_t home;

    probe_t probes[PROBES];
    probe_sample_t probe_sample;    /**< the last one, while probes are armed */
    int64_t output_until_ns;        /**< the digital output goes off then unless it is written again */
    int64_t inputs_asked_ns, inputs_since_ns; /**< where SDOs bring them: last, and without an answer since */
    int64_t kept_until_ns;
    double kept_deceleration, kept_jerk; /**< of that halt */

    stepping_t stepping;
    cool_muscle_t *muscle;          /**< NULL: the motor is a CM1-E */
    struct coupling *coupling;      /**< what it follows */
    struct link *slaves;            /**< who follows it */
    struct cams *cams;              /**< that it may follow (axis_cam.h) */
};

/** Counts of this motor that are as far as so many of a CM1-E; two at least, as one is rounding. */
static inline double cm1e_axis_few(const cm1e_axis_t *axis, double counts) { return fmax(counts * axis->count, 2.0); }

/* axis.c */
/** The axis's own half of cm1e_axis_outputs(): state diagram and set-point, before they become the drive's. */
void cm1e_axis_advance(cm1e_axis_t *axis);

/* axis_position.c */
double cm1e_axis_units(const cm1e_axis_t *axis, position_t position);
/** The same without the turns of a modulo axis: what limits are compared with. */
double cm1e_axis_line(const cm1e_axis_t *axis, position_t position);
/** The way back; FALSE: not finite, or farther away than the axis counts. */
bool cm1e_axis_position_from_line(const cm1e_axis_t *axis, double line, position_t *position);
/** FALSE: not finite, or farther away than the axis counts. */
bool cm1e_axis_position_from_units(const cm1e_axis_t *axis, double units, position_t *position);
/** Where a command to `position` (u) ends that begins at `from` with `velocity` (u/s): on a linear axis there, whatever
 *  the direction; on a modulo axis the first repetition in that direction, seen from the point where the axis can stop,
 *  `stop` (u, signed) after `from`. The shortest way is judged at `from`. */
cm1e_error_t cm1e_axis_resolve_target(const cm1e_axis_t *axis, double position, MC_DIRECTION direction,
                                      position_t from, double velocity, double stop, position_t *target);
/** From now on the axis is at `units` when it is at `at`; on a modulo axis `units` is less than a turn. */
void cm1e_axis_set_origin(cm1e_axis_t *axis, position_t at, double units);
/** Whether a way of so many u can be counted; what is not a number cannot. */
static inline bool cm1e_axis_counts_as_far(const cm1e_axis_t *axis, double units)
{
    return fabs(units * axis->scale) < (double)CM1E_FARTHEST_COUNTS;
}
/** u; about where that range ends. */
double cm1e_axis_farthest(const cm1e_axis_t *axis);
void cm1e_axis_track(cm1e_axis_t *axis);
void cm1e_axis_set_to_actual(cm1e_axis_t *axis);

/* axis_backlash.c */
void cm1e_axis_backlash_init(cm1e_axis_t *axis); /* @rt init; after the limits */
/** Counts of the motor beyond its load; 0 without backlash. */
double cm1e_axis_backlash_offset(const cm1e_axis_t *axis);
/** Where the load is while the motor is there. */
static inline position_t cm1e_axis_load(const cm1e_axis_t *axis, int64_t motor_counts)
{
    const position_t motor = {motor_counts, 0.0};
    return axis->backlash.gap > 0.0 ? cm1e_position_plus(motor, -cm1e_axis_backlash_offset(axis)) : motor;
}
/** Actual position, of the load. */
static inline position_t axis_actual(const cm1e_axis_t *axis) { return cm1e_axis_load(axis, axis->actual_counts); }
/** Where the motor has to be for the set-point; whole counts. */
static inline int64_t cm1e_axis_motor_target(const cm1e_axis_t *axis)
{
    const position_t target = axis->backlash.gap > 0.0 ? cm1e_position_plus(axis->set, cm1e_axis_backlash_offset(axis))
                                                       : axis->set;
    return target.counts + (target.fraction >= 0.5);
}
/** Counts/s of the motor that its load does not do. */
double cm1e_axis_backlash_velocity(const cm1e_axis_t *axis);
bool cm1e_axis_backlash_at_rest(const cm1e_axis_t *axis);
/* Both only where there is a gap. */
void cm1e_axis_backlash_track(cm1e_axis_t *axis, int32_t moved_counts);
void cm1e_axis_backlash_step(cm1e_axis_t *axis);

/* axis_limits.c */
cm1e_error_t cm1e_axis_limits_init(cm1e_axis_t *axis, cm1e_diag_t *diag); /* @rt init */
/** The dynamics of a command that begins there; MC_Halt and MC_Stop have too large ones cut to the axis's instead of
 *  refused. */
cm1e_error_t cm1e_axis_limits_of(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                                 cm1e_motion_limits_t *limits);
/** The same with these factors instead of the axis's override. */
cm1e_error_t cm1e_axis_limits_with(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                                   const override_t *override, cm1e_motion_limits_t *limits);
/** More jerk, where what is left of another motion's acceleration would else overshoot the maximum velocity. */
void cm1e_axis_keep_below_maximum(const cm1e_axis_t *axis, const from_t *from, cm1e_motion_limits_t *limits);
/** Those of a superimposed motion: what it asks for, cut to its share. */
cm1e_error_t cm1e_axis_limits_on_top(const cm1e_axis_t *axis, const superimposed_t *on_top,
                                     cm1e_motion_limits_t *limits);
/** A target inside the software limits, or not farther outside than where the way there begins; with a superimposed
 *  motion on top where `from` has one. */
bool cm1e_axis_limits_contain_target(const cm1e_axis_t *axis, const from_t *from, position_t target);
/** The same for a way between two positions, counted from there in u. */
bool cm1e_axis_limits_contain_way(const cm1e_axis_t *axis, const from_t *from, double lowest, double highest);
/** Whether a profile that begins there stays inside the software limits. */
bool cm1e_axis_limits_contain(const cm1e_axis_t *axis, const from_t *from, const cm1e_profile_t *profile);
/** The same, and no disabled direction in it. */
cm1e_error_t cm1e_axis_limits_check(const cm1e_axis_t *axis, const from_t *from, const cm1e_profile_t *profile);
/** Whether the emergency ramp from `next` (its position counted from `base`, u) would end inside the software
 *  limits. */
static inline bool cm1e_axis_limits_can_stop(const cm1e_axis_t *axis, double base, cm1e_motion_state_t next)
{
    if (!axis->software_limits)
        return true;
    /* Without a limit of jerk the way of a stop is known in closed form, whatever the acceleration is. */
    const double end = base + next.position + next.velocity * fabs(next.velocity) * axis->emergency_way;
    return next.velocity > 0.0 ? end <= axis->upper + axis->tolerance
           : next.velocity < 0.0 ? end >= axis->lower - axis->tolerance : true;
}
bool cm1e_axis_direction_enabled(const cm1e_axis_t *axis, double velocity);

/** Whether the motion under way, and a stop from it, would keep these software limits (u). */
bool cm1e_axis_limits_hold(const cm1e_axis_t *axis, double lower, double upper);

/* axis_limits.c: when limits are written, and when positions get another meaning */
void cm1e_axis_apply_limits(cm1e_axis_t *axis);

/* axis_parameter.c, axis_object.c */
/** For the text: what was refused last is told. A success takes back only what was told of the same. */
void cm1e_axis_remember_not_set(cm1e_axis_t *axis, not_set_t what);
void cm1e_axis_not_set_text(const cm1e_axis_t *axis, char *text, size_t size);
void cm1e_axis_not_finished_text(const cm1e_axis_t *axis, char *text, size_t size); /* axis_text.c */
const char *cm1e_axis_kind_name(cm1e_command_kind_t kind);                            /* axis_text.c */
void cm1e_axis_object_text(const cm1e_axis_t *axis, char *text, size_t size);
int cm1e_axis_number_of_object(uint16_t index, uint8_t subindex);
/** While one waits or is under way. */
void cm1e_axis_objects_step(cm1e_axis_t *axis);

/* axis_state.c */
typedef struct state_rule {
    cm1e_error_t refusal; /**< CM1E_OK: accepted */
    cm1e_axis_state_t next;
} state_rule_t;
const state_rule_t *cm1e_axis_state_rule(cm1e_axis_state_t state, cm1e_command_kind_t kind);

/* axis_plan.c */
/** The set-point, all that moves taken together. */
static inline from_t from_set(const cm1e_axis_t *axis)
{
    return (from_t){axis->set, axis->set_velocity, axis->set_acceleration, false};
}
/** Without what is superimposed. */
static inline from_t from_base(const cm1e_axis_t *axis)
{
    const cm1e_motion_state_t *on_top = &axis->superimposed.now;
    if (!axis->superimposed.id)
        return from_set(axis);
    return (from_t){cm1e_position_plus(axis->set, -on_top->position * axis->scale),
                    axis->set_velocity - on_top->velocity, axis->set_acceleration - on_top->acceleration,
                    axis->superimposed.moving && !axis->superimposed.alone};
}
static inline bool is_continuous_move(cm1e_command_kind_t kind)
{
    return kind == CM1E_COMMAND_MOVE_CONTINUOUS_ABSOLUTE || kind == CM1E_COMMAND_MOVE_CONTINUOUS_RELATIVE;
}
static inline bool is_coupling(cm1e_command_kind_t kind)
{
    return kind == CM1E_COMMAND_GEAR_IN || kind == CM1E_COMMAND_GEAR_IN_POS || kind == CM1E_COMMAND_CAM_IN ||
           kind == CM1E_COMMAND_COMBINE_AXES;
}
/** As an active command: the velocity that is kept, as `end_velocity`. */
static inline bool is_decoupling(cm1e_command_kind_t kind)
{
    return kind == CM1E_COMMAND_GEAR_OUT || kind == CM1E_COMMAND_CAM_OUT;
}
static inline bool is_phasing(cm1e_command_kind_t kind)
{
    return kind == CM1E_COMMAND_PHASING_ABSOLUTE || kind == CM1E_COMMAND_PHASING_RELATIVE;
}
/** F of a coupling is what moves the axis. */
static inline bool axis_follows(const cm1e_axis_t *axis) { return axis->activity == ACTIVITY_COUPLED; }
/** Goes on when it has reached what it was to reach. */
static inline bool is_endless(cm1e_command_kind_t kind)
{
    return is_continuous_move(kind) || kind == CM1E_COMMAND_MOVE_VELOCITY ||
           kind == CM1E_COMMAND_VELOCITY_PROFILE || kind == CM1E_COMMAND_ACCELERATION_PROFILE || is_decoupling(kind);
}
static inline bool is_table(cm1e_command_kind_t kind)
{
    return kind == CM1E_COMMAND_POSITION_PROFILE || kind == CM1E_COMMAND_VELOCITY_PROFILE ||
           kind == CM1E_COMMAND_ACCELERATION_PROFILE;
}
/** The other moves to a position. */
static inline bool is_discrete_move(cm1e_command_kind_t kind)
{
    return kind == CM1E_COMMAND_MOVE_ABSOLUTE || kind == CM1E_COMMAND_MOVE_RELATIVE ||
           kind == CM1E_COMMAND_MOVE_ADDITIVE;
}
bool cm1e_axis_can_plan(cm1e_command_kind_t kind);
/** Fills `target` and `origin` of a command that begins there. */
cm1e_error_t cm1e_axis_resolve(const cm1e_axis_t *axis, const from_t *from, move_t *move);
/** u/s; MC_MoveVelocity: with its direction. */
cm1e_error_t cm1e_axis_signed_velocity(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                                       double *velocity);
/** The profile of a command whose target is resolved, relative to where it begins. Refuses what leaves the limits. */
cm1e_error_t cm1e_axis_plan(const cm1e_axis_t *axis, const from_t *from, move_t *move, cm1e_profile_t *profile);
/** Where that profile ends: at the target, exactly, if the command has one. */
position_t cm1e_axis_profile_end(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                                 const cm1e_profile_t *profile);
/** Whether it goes beyond the target on the way. */
bool cm1e_axis_profile_passes(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                              const cm1e_profile_t *profile);
/** A stop; one that would run over a software limit brakes as an error does instead. */
cm1e_error_t cm1e_axis_plan_stop(const cm1e_axis_t *axis, const from_t *from, const cm1e_motion_limits_t *limits,
                                 cm1e_profile_t *profile);

/* axis_motion.c */
/** A profile takes over that began at `from`, `offset_s` before the present set-point. */
void cm1e_axis_run(cm1e_axis_t *axis, const from_t *from, const cm1e_profile_t *profile, position_t target,
                   double offset_s);
void cm1e_axis_run_table(cm1e_axis_t *axis, const from_t *from, const cm1e_table_profile_t *table, position_t target,
                         double offset_s);
void cm1e_axis_ramp_down(cm1e_axis_t *axis, const cm1e_motion_limits_t *limits);
/** Motion in the direction of `sign` is no longer enabled (MC_Power, 3.1): a command that goes there fails, the next
 *  one begins, or the axis stops. */
void cm1e_axis_direction_disabled(cm1e_axis_t *axis, double sign);
/** The set-point stands at the end of its profile. */
void cm1e_axis_stand(cm1e_axis_t *axis);
void cm1e_axis_motion_step(cm1e_axis_t *axis);
void cm1e_axis_write_set_point(cm1e_axis_t *axis);

/* axis_command.c */
/** Of a command or an update, for the text: what was refused last is told. CM1E_OK: it was accepted. */
void cm1e_axis_remember_refusal(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_error_t error);
/** The active command ends; those that wait are for cm1e_axis_begin_waiting(). */
void cm1e_axis_command_end(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error);
/** All end, the waiting ones with CM1E_ERROR_AXIS_ERROR_STOP where `state` is an error. */
void cm1e_axis_waiting_end(cm1e_axis_t *axis, cm1e_command_state_t state);
void cm1e_axis_commands_end(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error);
/** For the text: one that was taken ended with this error. That of ErrorStop is told by the axis's own. */
void cm1e_axis_remember_end(cm1e_axis_t *axis, cm1e_command_kind_t kind, cm1e_error_t error);
void cm1e_axis_record(cm1e_axis_t *axis, cm1e_command_id_t id, cm1e_command_state_t state, cm1e_error_t error);
cm1e_command_id_t cm1e_axis_next_id(cm1e_axis_t *axis);
/** A command that has been planned becomes the active one; the one before, if any, is aborted. */
void cm1e_axis_take(cm1e_axis_t *axis, const move_t *move, const from_t *from, const cm1e_profile_t *profile,
                    double offset_s);
cm1e_error_t cm1e_axis_begin_homing(cm1e_axis_t *axis, const move_t *move);
cm1e_error_t cm1e_axis_begin_step(cm1e_axis_t *axis, const move_t *move);

/* axis_buffer.c */
static inline move_t *waiting_move(cm1e_axis_t *axis, int index)
{
    return &axis->waiting.moves[(axis->waiting.first + index) % CM1E_AXIS_BUFFER_DEPTH];
}
/** The waiting command of that number; NULL: none. */
move_t *cm1e_axis_find_waiting(cm1e_axis_t *axis, cm1e_command_id_t id);
/** Takes it in behind the others and gives it its number. */
cm1e_error_t cm1e_axis_buffer(cm1e_axis_t *axis, move_t *move);
/** A waiting command with this number, if there is one, gets these inputs. */
cm1e_error_t cm1e_axis_update_waiting(cm1e_axis_t *axis, const move_t *move);
/** The velocity with which a move that begins there shall pass its target, for the sake of those that wait. */
double cm1e_axis_exit_velocity(cm1e_axis_t *axis, const from_t *from, const move_t *move);
/** The first waiting command that can begin there does; those before it fail. FALSE: none could. */
bool cm1e_axis_begin_waiting(cm1e_axis_t *axis, const from_t *from, double offset_s);
/** Something that the active command's profile depends on has changed: it is planned anew from the present set-point.
 *  Where that is refused, it goes on as it was. */
cm1e_error_t cm1e_axis_replan(cm1e_axis_t *axis);
/** The same; FALSE, and nothing has changed: refused, or it would run over its target. */
bool cm1e_axis_replan_if(cm1e_axis_t *axis);
/** The same with other inputs, which are in force when it is not refused. */
cm1e_error_t cm1e_axis_replan_as(cm1e_axis_t *axis, const move_t *move);

/* axis_superimpose.c */
cm1e_error_t cm1e_axis_superimpose(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
cm1e_error_t cm1e_axis_superimpose_update(cm1e_axis_t *axis, const move_t *inputs);
/** Adds its part to the base's of this cycle. */
void cm1e_axis_superimposed_step(cm1e_axis_t *axis, cm1e_motion_state_t *next);
/** Instead of that: its part is what was `before`, without jerk, and it goes on from there. */
void cm1e_axis_superimposed_hold(cm1e_axis_t *axis, const cm1e_motion_state_t *before);
/** After the set-point: where it has come to its end, the base has all the limits again. */
void cm1e_axis_superimposed_after(cm1e_axis_t *axis);
/** What is superimposed becomes part of the one motion that is then planned from the set-point. */
void cm1e_axis_superimposed_end(cm1e_axis_t *axis, cm1e_command_state_t state, cm1e_error_t error);
void cm1e_axis_superimposed_replan(cm1e_axis_t *axis);
/** Whether it goes that way, now or later. */
bool cm1e_axis_superimposed_goes(const cm1e_axis_t *axis, double sign);

/* axis_update.c */
bool cm1e_axis_same_inputs(const move_t *a, const move_t *b);
move_t cm1e_axis_move_of(const cm1e_axis_command_t *command);

/* axis_power.c */
bool cm1e_axis_wants_enable(const cm1e_axis_t *axis);
/** Set-points of ours reach the motor. */
static inline bool axis_acts(const cm1e_axis_t *axis)
{
    return axis->drive.feedback.enabled && axis->drive.feedback.mode == (int8_t)axis->mode;
}
void cm1e_axis_become_free(cm1e_axis_t *axis);
void cm1e_axis_fail(cm1e_axis_t *axis, cm1e_error_t error, double value, double bound);
/** The same; it brakes no harder than this, u/s2. */
void cm1e_axis_fail_gently(cm1e_axis_t *axis, cm1e_error_t error, double deceleration);
/** A ramp of ErrorStop begins anew, from the motor's own position and speed. */
void cm1e_axis_brake_from_actual(cm1e_axis_t *axis);
void cm1e_axis_power_step(cm1e_axis_t *axis);
void cm1e_axis_enable_step(cm1e_axis_t *axis);
void cm1e_axis_reset_step(cm1e_axis_t *axis); /* while a reset is under way */

/* axis_home.c */
/** A method that looks for a switch and not for a stop. */
bool cm1e_axis_homes_by_switch(const cm1e_axis_t *axis, int method);
cm1e_error_t cm1e_axis_home_prepare(cm1e_axis_t *axis, const cm1e_axis_command_t *command);
/** In words: what cm1e_axis_home_prepare() refused for its method or another parameter. */
void cm1e_axis_home_wrong_text(const cm1e_axis_t *axis, char *text, size_t size);
void cm1e_axis_home_begin(cm1e_axis_t *axis);
void cm1e_axis_home_abort(cm1e_axis_t *axis, home_goal_t goal);
void cm1e_axis_home_step(cm1e_axis_t *axis);

/* axis_cool_muscle.c; they do nothing where the motor is a CM1-E */
cm1e_error_t cm1e_axis_cool_muscle_init(cm1e_axis_t *axis, cm1e_diag_t *diag); /* @rt init; after its mode is set */
/** Between the programs and what is done about power. */
void cm1e_axis_cool_muscle_step(cm1e_axis_t *axis);
/** The motor is in the axis's own mode, or on its way there: it may be enabled. */
static inline bool cm1e_axis_cool_muscle_at_home(const cm1e_axis_t *axis)
{
    const cool_muscle_t *muscle = axis->muscle;
    return !muscle || (muscle->mode == (int8_t)axis->mode && muscle->next == (int8_t)axis->mode);
}
/** CM1E_OK, or why MC_Power cannot enable the motor, however long it waits. */
cm1e_error_t cm1e_axis_cool_muscle_refuses_power(cm1e_axis_t *axis);
/** CM1E_OK, or why MC_Home cannot be. */
cm1e_error_t cm1e_axis_cool_muscle_refuses_homing(cm1e_axis_t *axis);
/** At the end of a run: nothing of CML or CMD moves the motor any more; never later than 2 s after the first call. */
bool cm1e_axis_cool_muscle_released(cm1e_axis_t *axis);
/** What was refused or has failed; FALSE: this error is not one of those. */
bool cm1e_axis_cool_muscle_text(const cm1e_axis_t *axis, cm1e_error_t error, char *text, size_t size);

/* axis_probe.c */
void cm1e_axis_probe_step(cm1e_axis_t *axis); /* with fresh inputs, while probes are armed */

/* axis_digital.c */
/** CM1E_ERROR_AXIS_SIGNAL, CM1E_ERROR_PDO_MAPPING as cm1e_axis_read_input(). */
cm1e_error_t cm1e_axis_check_input(const cm1e_axis_t *axis, int number);
/** What was not renewed goes off or halts, before the set-point of the cycle. Called while there is something. */
void cm1e_axis_signals_step(cm1e_axis_t *axis);
void cm1e_axis_outputs_off(cm1e_axis_t *axis);
/** Behind a bridge: a sentence on what it has to do with such an error of a signal, after a space; "" elsewhere. */
const char *cm1e_axis_signals_advice(const cm1e_axis_t *axis, cm1e_error_t error);
/** Behind a bridge outputs are reached while there is torque only. TRUE: they are off, or have had their time. */
bool cm1e_axis_outputs_off_first(cm1e_axis_t *axis);

/* axis_table.c */
cm1e_error_t cm1e_axis_table_init(cm1e_axis_t *axis, cm1e_diag_t *diag); /* @rt init */
cm1e_error_t cm1e_axis_table_start(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
cm1e_error_t cm1e_axis_table_buffer(cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_command_id_t *id);
cm1e_error_t cm1e_axis_table_begin(cm1e_axis_t *axis, const move_t *move, const from_t *from, double offset_s);
/** What a table that was refused would have needed, for the text. */
void cm1e_axis_table_needs(const cm1e_axis_t *axis, const cm1e_axis_command_t *command, cm1e_axis_command_t *needs);
/** Whether the running one still goes in that direction after `from_s`. */
bool cm1e_axis_table_goes(cm1e_axis_t *axis, double from_s, double sign);

/* axis_guard.c */
/** Within the limits without any slack: nearly every set-point is, and this costs next to nothing. What is not a number
 *  is not. */
static inline bool cm1e_axis_well_within(const cm1e_axis_t *axis, const from_t *next, bool kept_jerk)
{
    const guarding_t *g = &axis->guarding;
    const double v0 = axis->set_velocity, v = next->velocity, a = next->acceleration, speed = fabs(v);
    const double step = cm1e_position_minus(next->position, axis->set) - (v0 + v) * g->half_cycle;
    if (!(speed <= g->velocity && fabs(v - v0) <= (speed >= fabs(v0) ? g->up : g->down) &&
          fabs(a) <= g->acceleration && fabs(step) <= g->step && axis->enable_positive && axis->enable_negative))
        return false;
    if (kept_jerk && !(fabs(a - axis->set_acceleration) <= g->jerk))
        return false;
    if (!axis->software_limits)
        return true;
    const double line = axis->origin_units + cm1e_position_minus(next->position, axis->origin) * g->per_count;
    const double way = speed * speed * axis->emergency_way;
    return line + way <= axis->upper && line - way >= axis->lower;
}
guard_t cm1e_axis_look_closely(const cm1e_axis_t *axis, const from_t *next, bool kept_jerk);
/** Whether the next set-point may follow the present one. `kept_jerk`: the limit of jerk counts too. */
static inline guard_t cm1e_axis_guard(const cm1e_axis_t *axis, const from_t *next, bool kept_jerk)
{
    return cm1e_axis_well_within(axis, next, kept_jerk) ? (guard_t){.limit = GUARD_KEPT}
                                                        : cm1e_axis_look_closely(axis, next, kept_jerk);
}
void cm1e_axis_guard_init(cm1e_axis_t *axis); /* @rt init */
/** ErrorStop with CM1E_ERROR_AXIS_COUPLING_LIMIT, which tells what was asked for and allowed. */
void cm1e_axis_guard_fail(cm1e_axis_t *axis, guard_t broken);
void cm1e_axis_guard_text(const cm1e_axis_t *axis, char *text, size_t size);

/* axis_lead.c */
static inline bool axis_led(const cm1e_axis_t *axis) { return axis->leader.next != NULL; }
/** What leads the axis is told that it does so no longer. */
void cm1e_axis_lead_end(cm1e_axis_t *axis, cm1e_error_t error);
/** The set-point of the cycle; FALSE: the leader has none that the axis may follow, and a ramp has begun. */
bool cm1e_axis_lead_step(cm1e_axis_t *axis);
void cm1e_axis_lead_after_pause(cm1e_axis_t *axis);

/* axis_homing_steps.c */
/** What is wrong with a step whatever the state of the axis. */
cm1e_error_t cm1e_axis_step_check(const cm1e_axis_t *axis, const cm1e_homing_step_t *step, const move_t *move);
/** Decides how a step begins: `*next` and `*profile`, nothing else. It is in force with cm1e_axis_step_begin(). */
cm1e_error_t cm1e_axis_step_prepare(const cm1e_axis_t *axis, const cm1e_homing_step_t *step, const move_t *move,
                                    stepping_t *next, cm1e_profile_t *profile);
void cm1e_axis_step_begin(cm1e_axis_t *axis, const stepping_t *next, const cm1e_profile_t *profile);
/** Before every set-point: looks, and decides what the profile is. */
void cm1e_axis_step_cycle(cm1e_axis_t *axis);
/** The profile of a step, or of the MC_Stop that ended one, has come to its end. TRUE: what comes next is decided. */
bool cm1e_axis_step_profile_ended(cm1e_axis_t *axis);
/** A step is the active command. */
static inline bool axis_stepping(const cm1e_axis_t *axis)
{
    return axis->active != 0 && axis->kind == CM1E_COMMAND_HOMING_STEP;
}

/* axis_drive_profile.c */
/** The axis's motions are the drive's: `motion: drive`. */
static inline bool drive_profiles(const cm1e_axis_t *axis) { return axis->config->motion == CM1E_MOTION_DRIVE; }
bool cm1e_axis_drive_takes(cm1e_command_kind_t kind);
/** Checks a command that begins at standstill; nothing has changed then. */
cm1e_error_t cm1e_axis_drive_prepare(cm1e_axis_t *axis, const from_t *from, move_t *move, driving_t *d);
void cm1e_axis_drive_begin(cm1e_axis_t *axis, const driving_t *d);
void cm1e_axis_drive_abort(cm1e_axis_t *axis, home_goal_t goal);
void cm1e_axis_drive_direction_disabled(cm1e_axis_t *axis, double sign);
void cm1e_axis_drive_step(cm1e_axis_t *axis);
void cm1e_axis_drive_write(cm1e_axis_t *axis);
/** Set-points of ours change from cycle to cycle. */
static inline bool set_points_move(const cm1e_axis_t *axis)
{
    return axis->activity == ACTIVITY_PROFILE || axis->activity == ACTIVITY_COUPLED || axis->activity == ACTIVITY_LED;
}
/** The drive moves, or is about to, by itself. */
static inline bool drive_moves(const cm1e_axis_t *axis)
{
    return axis->activity == ACTIVITY_HOMING || axis->activity == ACTIVITY_DRIVE;
}

#endif
