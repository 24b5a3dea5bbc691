/**
 * @file axis_private.h
 * The axis as the sources of its room see it, with the headers of its parts. Everything in them runs in the cycle
 * unless marked otherwise.
 */
#ifndef CM1E_AXIS_AXIS_PRIVATE_H
#define CM1E_AXIS_AXIS_PRIVATE_H

#include "axis/axis_backlash.h"
#include "axis/axis_device.h"
#include "axis/axis_driving.h"
#include "axis/axis_guard.h"
#include "axis/axis_hooks.h"
#include "axis/axis_in_position.h"
#include "axis/axis_limits.h"
#include "axis/axis_pause.h"
#include "axis/axis_position.h"
#include "axis/axis_power.h"
#include "axis/axis_setpoint.h"

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

struct cm1e_axis {
    /* what every cycle of a motion looks at */
    cm1e_drive_t drive;
    const axis_events_t *events;    /**< what a motion tells those that command it */
    cm1e_axis_state_t state;        /**< cm1e_axis_go() */
    cm1e_mode_t mode;               /**< of the set-points: CSP, or CSV where the mapping has no target position */
    uint16_t handle;
    bool advanced;                  /**< its set-point is that of this cycle */
    bool observed;                  /**< somebody follows its actual value, or has; an encoder always is */
    silence_t silence;
    double cycle_s;
    int64_t now_ns;
    power_t power;
    setpoint_t setpoint;
    axis_position_t position;
    limits_t limits;
    backlash_t backlash;
    in_position_t in_position;
    superimposed_t superimposed;
    commands_t commands;
    signals_t signals;
    objects_t objects;

    /* the rest */
    const cm1e_axis_config_t *config;
    fault_t fault;
    not_set_t not_set;
    override_t override, override_refused; /**< the latter for the text; one that is good: none was */
    cm1e_axis_leader_t leader;      /**< next is NULL: none */
    const void *group;              /**< that it belongs to; NULL: none */
    tables_t *tables;               /**< NULL: none (cm1e_axis_config_t.table_profiles) */
    driving_t driving;
    homing_step_t homing_step;
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
    if (axis->setpoint.source != source && axis->setpoint.source->leave)
        axis->setpoint.source->leave(axis);
    axis->setpoint.source = source;
}
static inline bool axis_free(const cm1e_axis_t *axis) { return axis->setpoint.source->is_free; }
static inline bool axis_holds(const cm1e_axis_t *axis) { return axis->setpoint.source->holds; }
/** A profile, or a table over time, which is one too. */
static inline bool axis_on_profile(const cm1e_axis_t *axis) { return axis->setpoint.source->find_stretch != NULL; }
/** F of a coupling is what moves the axis. */
static inline bool axis_follows(const cm1e_axis_t *axis) { return axis->setpoint.source->follows; }
/** Set-points of ours change from cycle to cycle. */
static inline bool set_points_move(const cm1e_axis_t *axis) { return axis->setpoint.source->moves; }
/** The drive moves, or is about to, by itself. */
static inline bool drive_moves(const cm1e_axis_t *axis) { return axis->setpoint.source->by_drive; }
/** ... in its homing. */
static inline bool drive_homes(const cm1e_axis_t *axis) { return axis->setpoint.source->homes; }

/** Counts of this motor that are as far as so many of a CM1-E; two at least, as one is rounding. */
static inline double cm1e_axis_few(const cm1e_axis_t *axis, double counts)
{
    return fmax(counts * axis->position.count, 2.0);
}

/* axis.c */
/** The axis's own half of cm1e_axis_outputs(): state diagram and set-point, before they become the drive's. */
void cm1e_axis_advance(cm1e_axis_t *axis);

/* axis_position.c */
/** Whether a way of so many u can be counted; what is not a number cannot. */
static inline bool cm1e_axis_can_count(const cm1e_axis_t *axis, double units)
{
    return fabs(units * axis->position.scale) < (double)CM1E_FARTHEST_COUNTS;
}

/* axis_backlash.c */
/** Where the load is while the motor is there. */
static inline position_t cm1e_axis_load(const cm1e_axis_t *axis, int64_t motor_counts)
{
    const position_t motor = {motor_counts, 0.0};
    return axis->backlash.gap > 0.0 ? cm1e_position_plus(motor, -cm1e_axis_backlash_offset(axis)) : motor;
}
/** Actual position, of the load. */
static inline position_t axis_actual(const cm1e_axis_t *axis)
{
    return cm1e_axis_load(axis, axis->position.actual_counts);
}
/** Where the motor has to be for the set-point; whole counts. */
static inline int64_t cm1e_axis_motor_target(const cm1e_axis_t *axis)
{
    const position_t target = axis->backlash.gap > 0.0
                              ? cm1e_position_plus(axis->setpoint.position, cm1e_axis_backlash_offset(axis))
                                                       : axis->setpoint.position;
    return target.counts + (target.fraction >= 0.5);
}

/* axis_limits.c */
/** Whether the emergency ramp from `next` (its position counted from `base`, u) would end inside the software
 *  limits. */
static inline bool cm1e_axis_limits_can_stop(const cm1e_axis_t *axis, double base, cm1e_motion_state_t next)
{
    if (!axis->limits.software_limits)
        return true;
    /* Without a limit of jerk the way of a stop is known in closed form, whatever the acceleration is. */
    const double end = base + next.position + next.velocity * fabs(next.velocity) * axis->limits.emergency_way;
    return next.velocity > 0.0 ? end <= axis->limits.upper + axis->limits.tolerance
           : next.velocity < 0.0 ? end >= axis->limits.lower - axis->limits.tolerance : true;
}
/** Whether the motion under way, and a stop from it, would keep these software limits (u). */
static inline bool cm1e_axis_limits_hold(const cm1e_axis_t *axis, double lower, double upper)
{
    return !axis->setpoint.source->keeps || axis->setpoint.source->keeps(axis, lower, upper);
}

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
    return (from_t){axis->setpoint.position, axis->setpoint.velocity,
                    axis->setpoint.brakes_hard ? 0.0 : axis->setpoint.acceleration, false};
}
/** Without what is superimposed. */
static inline from_t from_base(const cm1e_axis_t *axis)
{
    const cm1e_motion_state_t *on_top = &axis->superimposed.now;
    if (!axis->superimposed.id)
        return from_set(axis);
    return (from_t){cm1e_position_plus(axis->setpoint.position, -on_top->position * axis->position.scale),
                    axis->setpoint.velocity - on_top->velocity,
                    axis->setpoint.brakes_hard ? 0.0 : axis->setpoint.acceleration - on_top->acceleration,
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
    return &axis->commands.waiting.moves[(axis->commands.waiting.first + index) % CM1E_AXIS_BUFFER_DEPTH];
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
    return moving && ((axis->commands.active && axis->commands.kind != CM1E_COMMAND_HALT) || axis->superimposed.id);
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
    return axis->power.enable && !axis->power.shutting_down && axis->state != CM1E_AXIS_ERROR_STOP &&
           (!axis->motor_hooks || axis->motor_hooks->is_home(axis));
}
/** Set-points of ours reach the motor. */
static inline bool axis_acts(const cm1e_axis_t *axis)
{
    return axis->drive.feedback.enabled && axis->drive.feedback.mode == (int8_t)axis->mode;
}
static inline void cm1e_axis_fail(cm1e_axis_t *axis, cm1e_error_t error, double value, double bound)
{
    axis->events->failed(axis, error, value, bound, &axis->limits.emergency);
}
/** The same; it brakes no harder than this, u/s2. */
static inline void cm1e_axis_fail_gently(cm1e_axis_t *axis, cm1e_error_t error, double deceleration)
{
    cm1e_motion_limits_t ramp = axis->limits.emergency;
    ramp.deceleration = fmin(ramp.deceleration, deceleration);
    axis->events->failed(axis, error, 0.0, 0.0, &ramp);
}

/* axis_guard.c */
/** Within the limits without any slack: nearly every set-point is, and this costs next to nothing. What is not a number
 *  is not. */
static inline bool cm1e_axis_well_within(const cm1e_axis_t *axis, const from_t *next, bool kept_jerk)
{
    const guarding_t *g = &axis->limits.guarding;
    const double v0 = axis->setpoint.velocity, v = next->velocity, a = next->acceleration, speed = fabs(v);
    const double step = cm1e_position_minus(next->position, axis->setpoint.position) - (v0 + v) * g->half_cycle;
    if (!(speed <= g->velocity && fabs(v - v0) <= (speed >= fabs(v0) ? g->up : g->down) &&
          fabs(a) <= g->acceleration && fabs(step) <= g->step && axis->power.enable_positive &&
              axis->power.enable_negative))
        return false;
    if (kept_jerk && !(fabs(a - axis->setpoint.acceleration) <= g->jerk &&
                       (a * v <= 0.0 || speed + a * a * g->ease <= g->velocity)))
        return false;
    if (!axis->limits.software_limits)
        return true;
    const double line = axis->position.origin_units + cm1e_position_minus(next->position, axis->position.origin) *
                        g->per_count;
    const double way = speed * speed * axis->limits.emergency_way;
    return line + way <= axis->limits.upper && line - way >= axis->limits.lower;
}
/** Whether the next set-point may follow the present one. `kept_jerk`: the limit of jerk counts too. */
static inline guard_t cm1e_axis_guard(const cm1e_axis_t *axis, const from_t *next, bool kept_jerk)
{
    return cm1e_axis_well_within(axis, next, kept_jerk) ? (guard_t){.limit = GUARD_KEPT}
                                                        : cm1e_axis_look_closely(axis, next, kept_jerk);
}

/* axis_lead.c */
static inline bool axis_led(const cm1e_axis_t *axis) { return axis->leader.next != NULL; }
/** What leads the axis is told that it does so no longer. */
void cm1e_axis_lead_end(cm1e_axis_t *axis, cm1e_error_t error); /* axis_free.c */
/** ErrorStop by a lost bus: in CSV all that are led together brake in the same time, which keeps them on a line. */
void cm1e_axis_lead_fail(cm1e_axis_t *axis, cm1e_error_t error);

/* axis_in_position.c */
/** A command stays active for the motor alone. */
static inline bool axis_settling(const cm1e_axis_t *axis)
{
    return axis->commands.active != 0 && axis->commands.active == axis->in_position.settling && axis_holds(axis);
}

/** A step is the active command. */
static inline bool axis_stepping(const cm1e_axis_t *axis)
{
    return axis->commands.active != 0 && axis->commands.kind == CM1E_COMMAND_HOMING_STEP;
}

/** The axis's motions are the drive's: `motion: drive`. */
static inline bool drive_profiles(const cm1e_axis_t *axis) { return axis->config->motion == CM1E_MOTION_DRIVE; }

#endif
