/**
 * @file axis_private.h
 * The axis as the sources of its room see it, with the headers of its parts. Everything in them runs in the cycle
 * unless marked otherwise.
 */
#ifndef CM1E_AXIS_AXIS_PRIVATE_H
#define CM1E_AXIS_AXIS_PRIVATE_H

#include "axis/axis_device.h"
#include "axis/axis_hooks.h"
#include "axis/axis_driving.h"
#include "axis/axis_kind.h"
#include "axis/axis_move.h"
#include "device/unit.h"

#define MS_IN_NS INT64_C(1000000)

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

/** Whether the motor is where its set-point stands (axis_in_position.c). */
typedef struct in_position {
    bool inside;                /**< where it was seen last, the motor is in the window; FALSE: the set-point moves */
    bool there;                 /**< ... and has been for the time */
    bool done_waits;
    bool missed;                /**< an error ended a command that waited */
    cm1e_command_id_t settling; /**< the command that waits for the motor while it is active and the axis holds */
    int64_t inside_ns;          /**< since when */
    int64_t arrived_ns;         /**< since when the set-point of that command stands */
    double window;              /**< u, to either side */
    uint32_t time_us, timeout_us;
    float torque;               /**< % of rated torque, while it waited last: a fault takes it away; NAN: not known */
    double missed_actual, missed_by; /**< for the text; u */
} in_position_t;

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
    double ease;             /**< s3/u; by the square of an acceleration: what it adds to the velocity while it ends */
    double half_cycle, step; /**< counts in half a cycle at 1 u/s; counts beside the mean of both velocities */
    double per_count;        /**< u, signed */
} guarding_t;

/** A motor needs so many cycles to recover from one in which its target stood. */
enum { CM1E_SHAKEN_BY_SILENCE = 8 };

struct cm1e_axis {
    /* what every cycle of a motion looks at */
    cm1e_drive_t drive;
    const axis_events_t *events;    /**< what a motion tells those that command it */
    const source_t *source;         /**< of the set-point; cm1e_axis_set_source() */
    cm1e_axis_state_t state;
    cm1e_command_id_t active;       /**< 0: none */
    cm1e_command_kind_t kind;       /**< of the active one */
    cm1e_mode_t mode;               /**< of the set-points: CSP, or CSV where the mapping has no target position */
    uint16_t handle;
    uint16_t shaken;                /**< by silence not long ago: CM1E_SHAKEN_BY_SILENCE for each cycle of it, one less
                                         with each answer */
    uint16_t silent, silent_before; /**< cycles in a row without an answer; those that the present one has ended */
    bool reached, positive_before;
    bool paused;                    /**< its end is not that of its command, which waits (MC_SetOverride) */
    bool stands;                    /**< the base has come to its end, only a superimposed motion goes on */
    bool brakes_hard;               /**< the set-point is one of a ramp without limit of jerk */
    bool software_limits;           /**< one of them at least; those in force are ... */
    bool lag_monitoring;
    bool blind;                     /**< the actual position was not fresh, and the set-point goes on */
    bool frozen;                    /**< no answer to the last frame: set-points stay in this cycle (axis_pause.c) */
    bool power_enable, enable_positive, enable_negative;
    bool energized;                 /**< the axis has taken over the enabled drive */
    bool shutting_down;
    bool position_known, homed;
    bool stop_held;
    bool advanced;                  /**< its set-point is that of this cycle */
    bool observed;                  /**< somebody follows its actual value, or has; an encoder always is */
    bool resumed;                   /**< a pause or silence before this cycle has been dealt with ... */
    bool began_anew;                /**< ... by another velocity than it had */
    bool reset_sent;
    bool pushing;                   /**< a step of a homing: the set-point may be where the motor cannot go */
    bool after_stop;                /**< MC_Stop ended a step, and the motor is relieved before it is Done */
    bool finishing;                 /**< the step ends the homing: positions are valid again, software limits hold */
    bool awaits;                    /**< the first waiting command begins at a place of its master (StartSync), until
                                         when what runs goes on */
    uint16_t device_error;
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
    int64_t now_ns;
    int64_t actual_counts;          /**< the same without wrap-around */
    int32_t raw;                    /**< counts of the drive, last seen */
    cm1e_command_state_t reset_state;
    uint32_t probes_armed, probe_count;
    cm1e_command_id_t last_id;      /**< of the last command that was taken */
    cm1e_command_id_t kept;         /**< a command that halts unless it is renewed; 0: none */
    backlash_t backlash;
    in_position_t in_position;
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

    cm1e_error_t error, reset_error;
    double error_value, error_bound; /**< numbers for the text */
    guard_t guard;                  /**< with CM1E_ERROR_AXIS_COUPLING_LIMIT */
    cm1e_axis_leader_t leader;      /**< next is NULL: none */
    const void *group;              /**< that it belongs to; NULL: none */

    position_t origin;              /**< position origin_units is there; modulo: 0 */
    double origin_units;

    double loop_velocity;           /**< counts/s that the position loop adds in CSV */
    override_t override, override_refused; /**< the latter for the text; one that is good: none was */

    command_record_t records[COMMANDS_REMEMBERED];
    move_t move;                    /**< the active one, unless it is a homing */
    buffer_t waiting;
    tables_t *tables;               /**< NULL: none (cm1e_axis_config_t.table_profiles) */
    cm1e_axis_command_t refused;    /**< what it asked for */
    cm1e_error_t refusal;           /**< why the last command was refused, for the text; CM1E_OK: it was not */
    cm1e_command_id_t stop;         /**< whose MC_Stop holds the axis in Stopping */

    int64_t free_ns;                /**< since when no torque is asked for */
    int64_t brake_until_ns;         /**< so long at least the torque stays to brake */

    driving_t driving;
    not_set_t not_set;

    probe_t probes[PROBES];
    probe_sample_t probe_sample;    /**< the last one, while probes are armed */
    int64_t output_until_ns;        /**< the digital output goes off then unless it is written again */
    int64_t inputs_asked_ns, inputs_since_ns; /**< where SDOs bring them: last, and without an answer since */
    int64_t kept_until_ns;
    double kept_deceleration, kept_jerk; /**< of that halt */

    const homing_hooks_t *homing_hooks; /**< NULL: it cannot be homed */
    struct homing *homing;          /**< theirs */
    const motor_hooks_t *motor_hooks; /**< NULL: the motor is a CM1-E, or there is none */
    struct cool_muscle *muscle;     /**< theirs */
    const coupling_hooks_t *coupling_hooks; /**< NULL: it cannot follow, nor be followed */
    struct coupling *coupling;      /**< theirs */
};

/* Where the set-point comes from. */
static inline void cm1e_axis_set_source(cm1e_axis_t *axis, const source_t *source)
{
    if (axis->source != source && axis->source->leave)
        axis->source->leave(axis);
    axis->source = source;
}
static inline bool axis_free(const cm1e_axis_t *axis) { return axis->source->is_free; }
static inline bool axis_holds(const cm1e_axis_t *axis) { return axis->source->holds; }
/** A profile, or a table over time, which is one too. */
static inline bool axis_on_profile(const cm1e_axis_t *axis) { return axis->source->find_stretch != NULL; }
/** F of a coupling is what moves the axis. */
static inline bool axis_follows(const cm1e_axis_t *axis) { return axis->source->follows; }
/** Set-points of ours change from cycle to cycle. */
static inline bool set_points_move(const cm1e_axis_t *axis) { return axis->source->moves; }
/** The drive moves, or is about to, by itself. */
static inline bool drive_moves(const cm1e_axis_t *axis) { return axis->source->by_drive; }
/** ... in its homing. */
static inline bool drive_homes(const cm1e_axis_t *axis) { return axis->source->homes; }

/** Counts of this motor that are as far as so many of a CM1-E; two at least, as one is rounding. */
static inline double cm1e_axis_few(const cm1e_axis_t *axis, double counts) { return fmax(counts * axis->count, 2.0); }

/* axis.c */
/** The axis's own half of cm1e_axis_outputs(): state diagram and set-point, before they become the drive's. */
void cm1e_axis_advance(cm1e_axis_t *axis);

/* axis_position.c */
double cm1e_axis_units(const cm1e_axis_t *axis, position_t position);
/** Set and actual position, as they are shown. */
void cm1e_axis_shown(const cm1e_axis_t *axis, double *set, double *actual);
/** Without the turns of a modulo axis: what limits are compared with. */
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
/** MC_SetPosition: what the actual position `now` becomes; FALSE: out of range. */
bool cm1e_axis_new_position(const cm1e_axis_t *axis, double now, double position, bool relative, double *value);
/** From now on the axis is at `units` when it is at `at`; on a modulo axis `units` is less than a turn. */
void cm1e_axis_set_origin(cm1e_axis_t *axis, position_t at, double units);
/** Whether a way of so many u can be counted; what is not a number cannot. */
static inline bool cm1e_axis_can_count(const cm1e_axis_t *axis, double units)
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
/** Those of a superimposed motion: what it asks for with these factors, cut to its share. */
cm1e_error_t cm1e_axis_limits_on_top(const cm1e_axis_t *axis, const superimposed_t *on_top,
                                     const override_t *override, cm1e_motion_limits_t *limits);
/** A target inside the software limits, or not farther outside than where the way there begins; with a superimposed
 *  motion on top where `from` has one. */
bool cm1e_axis_limits_contain_target(const cm1e_axis_t *axis, const from_t *from, position_t target);
/** The same for a way between two positions, counted from there in u. */
bool cm1e_axis_limits_contain_way(const cm1e_axis_t *axis, const from_t *from, double lowest, double highest);
/** Whether a profile that begins there stays inside the software limits. */
bool cm1e_axis_limits_contain(const cm1e_axis_t *axis, const from_t *from, const cm1e_profile_t *profile);
/** The same, also while a homing in steps makes positions mean nothing. */
bool cm1e_axis_limits_keep_within(const cm1e_axis_t *axis, const from_t *from, const cm1e_profile_t *profile);
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
static inline bool cm1e_axis_limits_hold(const cm1e_axis_t *axis, double lower, double upper)
{
    return !axis->source->keeps || axis->source->keeps(axis, lower, upper);
}
/** The same of a profile. */
bool cm1e_axis_profile_keeps(const cm1e_axis_t *axis, double lower, double upper);

/** What the drive may be given in a cycle: cm1e_drive_command_t. @rt init; after the limits */
void cm1e_axis_steps_init(cm1e_axis_t *axis);

/* axis_limits.c: when limits are written, and when positions get another meaning */
void cm1e_axis_apply_limits(cm1e_axis_t *axis);

/* axis_record.c */
/** For the text: what was refused last is told. A success takes back only what was told of the same. */
void cm1e_axis_remember_not_set(cm1e_axis_t *axis, not_set_t what);
void cm1e_axis_parameter_text(const cm1e_axis_t *axis, char *text, size_t size);
void cm1e_axis_not_set_text(const cm1e_axis_t *axis, char *text, size_t size);      /* axis_text_not_set.c */
void cm1e_axis_not_finished_text(const cm1e_axis_t *axis, char *text, size_t size); /* axis_text.c */

/* axis_plan.c */
/** The set-point, all that moves taken together. What takes over from a ramp without limit of jerk ends its acceleration
 *  with the step that the ramp would have ended with: a limited jerk would carry the axis through standstill and back. */
static inline from_t from_set(const cm1e_axis_t *axis)
{
    return (from_t){axis->set, axis->set_velocity, axis->brakes_hard ? 0.0 : axis->set_acceleration, false};
}
/** Without what is superimposed. */
static inline from_t from_base(const cm1e_axis_t *axis)
{
    const cm1e_motion_state_t *on_top = &axis->superimposed.now;
    if (!axis->superimposed.id)
        return from_set(axis);
    return (from_t){cm1e_position_plus(axis->set, -on_top->position * axis->scale),
                    axis->set_velocity - on_top->velocity,
                    axis->brakes_hard ? 0.0 : axis->set_acceleration - on_top->acceleration,
                    axis->superimposed.moving && !axis->superimposed.alone};
}
/** Fills `target` and `origin` of a command that begins there. */
cm1e_error_t cm1e_axis_resolve(const cm1e_axis_t *axis, const from_t *from, move_t *move);
/** u/s; MC_MoveVelocity: with its direction. */
cm1e_error_t cm1e_axis_signed_velocity(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                                       double *velocity);
/** The profile of a command whose target is resolved, relative to where it begins. Refuses what leaves the limits.
 *  `before_others`: those that wait come behind it, and its exit velocity is theirs to take over. */
cm1e_error_t cm1e_axis_plan(cm1e_axis_t *axis, const from_t *from, move_t *move, bool before_others,
                            cm1e_profile_t *profile);
/** Where that profile ends: at the target, exactly, if the command has one. */
position_t cm1e_axis_profile_end(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                                 const cm1e_profile_t *profile);
/** Whether a profile that begins there goes beyond its target (NULL: it has none), or back where its way lies ahead. */
bool cm1e_axis_strays(const cm1e_axis_t *axis, const cm1e_motion_state_t *start, const double *target,
                      const cm1e_profile_t *profile);
/** The same of a command's. */
bool cm1e_axis_profile_strays(const cm1e_axis_t *axis, const from_t *from, const move_t *move,
                              const cm1e_profile_t *profile);
/** Whether a profile that begins there stays inside the software limits, with no disabled direction in it. */
cm1e_error_t cm1e_axis_limits_check(const cm1e_axis_t *axis, const from_t *from, const cm1e_profile_t *profile);
/** A stop; one that would run over a software limit brakes as an error does instead. */
cm1e_error_t cm1e_axis_plan_stop(const cm1e_axis_t *axis, const from_t *from, const cm1e_motion_limits_t *limits,
                                 cm1e_profile_t *profile);

/** The first of those that wait is 0. */
static inline move_t *waiting_move(cm1e_axis_t *axis, int index)
{
    return &axis->waiting.moves[(axis->waiting.first + index) % CM1E_AXIS_BUFFER_DEPTH];
}

/** A superimposed motion goes on above the base and has its share of the limits. */
static inline bool axis_shares(const cm1e_axis_t *axis)
{
    return axis->superimposed.moving && !axis->superimposed.alone;
}
/** A command moves it: a single motion, or a continuous one. */
static inline bool axis_moves_by_command(const cm1e_axis_t *axis)
{
    const bool moving = axis->state == CM1E_AXIS_DISCRETE_MOTION || axis->state == CM1E_AXIS_CONTINUOUS_MOTION;
    return moving && ((axis->active && axis->kind != CM1E_COMMAND_HALT) || axis->superimposed.id);
}
/** Of a room above the axis, or its own; without `start`: the axis cannot do it. */
static inline const command_method_t *cm1e_axis_method(const cm1e_axis_t *axis, command_plan_t plan)
{
    const command_method_t *coupling = axis->coupling_hooks ? &axis->coupling_hooks->methods[plan] : NULL;
    const command_method_t *homing = axis->homing_hooks ? &axis->homing_hooks->methods[plan] : NULL;
    return coupling && coupling->start ? coupling : homing && homing->start ? homing : &axis->events->methods[plan];
}
/** At the end of a motion: see cm1e_axis_begin_next(). */
static inline bool cm1e_axis_begin_waiting(cm1e_axis_t *axis, const from_t *from, double offset_s)
{
    return axis->events->begin_waiting(axis, from, offset_s);
}

/* axis_power.c */
static inline bool cm1e_axis_wants_enable(const cm1e_axis_t *axis)
{
    return axis->power_enable && !axis->shutting_down && axis->state != CM1E_AXIS_ERROR_STOP &&
           (!axis->motor_hooks || axis->motor_hooks->is_home(axis));
}
/** Set-points of ours reach the motor. */
static inline bool axis_acts(const cm1e_axis_t *axis)
{
    return axis->drive.feedback.enabled && axis->drive.feedback.mode == (int8_t)axis->mode;
}
void cm1e_axis_become_free(cm1e_axis_t *axis); /* axis_free.c */
void cm1e_axis_error_stop(cm1e_axis_t *axis, cm1e_error_t error, double value, double bound,
                          const cm1e_motion_limits_t *ramp);
static inline void cm1e_axis_fail(cm1e_axis_t *axis, cm1e_error_t error, double value, double bound)
{
    axis->events->failed(axis, error, value, bound, &axis->emergency);
}
/** The same; it brakes no harder than this, u/s2. */
static inline void cm1e_axis_fail_gently(cm1e_axis_t *axis, cm1e_error_t error, double deceleration)
{
    cm1e_motion_limits_t ramp = axis->emergency;
    ramp.deceleration = fmin(ramp.deceleration, deceleration);
    axis->events->failed(axis, error, 0.0, 0.0, &ramp);
}
/** A ramp of ErrorStop begins anew, from the motor's own position and speed. */
void cm1e_axis_brake_from_actual(cm1e_axis_t *axis);
/** The set velocity falls by `velocity` (u/s) at once: the torque stays until the motor has had time to follow. */
void cm1e_axis_keep_torque(cm1e_axis_t *axis, double velocity);
/** The bus is lost. In CSP the set-point stays where it is, under torque for as long as the ramp of an error would take:
 *  a drive that still hears, and one that does not, both stop there. */
void cm1e_axis_hold_unheard(cm1e_axis_t *axis);
void cm1e_axis_power_step(cm1e_axis_t *axis);
void cm1e_axis_enable_step(cm1e_axis_t *axis);
void cm1e_axis_reset_step(cm1e_axis_t *axis); /* while a reset is under way */

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
    if (kept_jerk && !(fabs(a - axis->set_acceleration) <= g->jerk &&
                       (a * v <= 0.0 || speed + a * a * g->ease <= g->velocity)))
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
/** Whether a motion that keeps acceleration and jerk at every moment of the cycle leads to the next set-point. Then the
 *  differences of the set positions keep them too, whatever adds up in it. */
bool cm1e_axis_guard_smooth(const cm1e_axis_t *axis, const from_t *next);
/** When the axis begins to follow or to be led, and when its limits are written. */
void cm1e_axis_guard_renew(cm1e_axis_t *axis);
/** ErrorStop with CM1E_ERROR_AXIS_COUPLING_LIMIT, which tells what was asked for and allowed. */
void cm1e_axis_guard_fail(cm1e_axis_t *axis, guard_t broken);
void cm1e_axis_guard_text(const cm1e_axis_t *axis, char *text, size_t size);

/* axis_pause.c */
/** Before the set-point of the first cycle in which a frame has come back again. */
void cm1e_axis_after_silence(cm1e_axis_t *axis);
/** Counts by which a motor has gone on in a silence that ended just now (CSV). */
double cm1e_axis_ran_on(const cm1e_axis_t *axis);

/* axis_lead.c */
static inline bool axis_led(const cm1e_axis_t *axis) { return axis->leader.next != NULL; }
/** What leads the axis is told that it does so no longer. */
void cm1e_axis_lead_end(cm1e_axis_t *axis, cm1e_error_t error); /* axis_free.c */
/** ErrorStop by a lost bus: in CSV all that are led together brake in the same time, which keeps them on a line. */
void cm1e_axis_lead_fail(cm1e_axis_t *axis, cm1e_error_t error);

/* axis_in_position.c */
void cm1e_axis_in_position_init(cm1e_axis_t *axis); /* @rt init; after limits and mode */
/** The set-point stands, and the motor has been there for the time that is asked for. */
bool cm1e_axis_in_position(const cm1e_axis_t *axis);
/** In every cycle in which the axis holds. */
void cm1e_axis_in_position_step(cm1e_axis_t *axis);
/** The set-point of the active command has arrived and stands. TRUE: the command stays active until the motor is
 *  there, in its state of the diagram. */
bool cm1e_axis_settle(cm1e_axis_t *axis);
/** A command stays active for the motor alone. */
static inline bool axis_settling(const cm1e_axis_t *axis)
{
    return axis->active != 0 && axis->active == axis->in_position.settling && axis_holds(axis);
}
/** Such a command is Done now, also where the motor is not there yet: another one goes on from its end. */
void cm1e_axis_settled(cm1e_axis_t *axis);
/** All commands end. */
void cm1e_axis_in_position_ended(cm1e_axis_t *axis, bool by_error);
void cm1e_axis_in_position_text(const cm1e_axis_t *axis, char *text, size_t size);
/** Behind the text of a fault: where the motor was, if something waited for it. */
void cm1e_axis_in_position_add(const cm1e_axis_t *axis, char *text, size_t size);

/** A step is the active command. */
static inline bool axis_stepping(const cm1e_axis_t *axis)
{
    return axis->active != 0 && axis->kind == CM1E_COMMAND_HOMING_STEP;
}

/** The axis's motions are the drive's: `motion: drive`. */
static inline bool drive_profiles(const cm1e_axis_t *axis) { return axis->config->motion == CM1E_MOTION_DRIVE; }

#endif
