/*
 * What must hold in every cycle of a scenario. The judge knows the configuration, what the program commands, and the
 * truth about the shafts; it reads the library only as a program does.
 */
#include <math.h>
#include <string.h>

#include "scenario_private.h"

/* What the simulated servo does by itself; `scenario --measure` prints it for scenarios without faults. */
#define SERVO_OVERSHOOT 0.002     /* of the maximum velocity, */
#define SERVO_FILTER_S 1e-3       /* so much time of the maximum acceleration: it smooths the velocity, */
#define COARSE_COUNTS 1000.0      /* counts/s: target velocities before firmware 1.3.3 */
#define SERVO_GAIN 1.15           /* of the maximum acceleration, within GAIN_MS */
#define SERVO_BANDWIDTH 500.0     /* rad/s, of its position loop */
#define STALL_OVERSHOOT 0.05      /* docs/SAFETY.md: 5 % above the earlier speed after a pause of the host */
#define SWING_OVERSHOOT 0.11      /* a heavy load that the drive alone swings in a long pause (docs/SAFETY.md), or whose
                                   * position was untrue in the pause */
/* Of the own motion of a drive whose load lets it lag: with torque for the acceleration A, below a of the profile, it
 * reaches the speed v behind by v^2 / 2 (1 / A - 1 / a), and A makes at most v sqrt(1 - A / a) more of that. */
#define HOMING_OVERSHOOT 1.0
#define RING_OVERSHOOT 0.12       /* where a cable of a ring breaks or is mended, targets come up to a cycle late */
#define HEAVY_OVERSHOOT 0.08      /* a lost frame, and a load that the servo cannot pull back without overshoot; */
#define COMPOSITE_OVERSHOOT 0.11  /* of a slave, a path, or what is superimposed (docs/SAFETY.md) */
#define JOLT_OVERSHOOT 0.02       /* where frames are sent late, because those of another network were waited for */
#define HOMING_SPEED 100000.0     /* counts/s, by the drive (scenario_machine.c) */
#define HOMING_ACCELERATION 2000000.0 /* counts/s2 */
#define KEPT_COUNTS 2.0
#define CAUGHT_SPEED 1000.0       /* counts/s */
#define STOP_COUNTS 240000.0      /* near a hard stop */
#define STILL_COUNTS 4.0
#define LOAD_COUNTS 100.0 /* in_position.window, and overshoot of the servo with a heavy load at the end of a crossing */
#define STEP_OVERSHOOT 1.13 /* of the simulated servo: it goes 11.5 % beyond a step of its target (seed 910146) */
#define COARSE_STILL_COUNTS 110.0 /* in CSV it hunts round its target, where friction is large (in_position.window) */
#define ROTOR_INERTIA_PER_TORQUE 3e-5 /* kg m2 for a Nm of peak torque */
#define RADIANS 6.283185307179586     /* of a revolution */
#define LOST_OF_COMPOSITE 2.0 /* cycles */
#define LOST_OF_ONE 1.25      /* cycles; with more the set-point goes after the motor */
#define LET_GO 0.1            /* of the velocity of the axis, */
#define LET_GO_SPEED 20000.0  /* counts/s; and this: friction may hold it back, and it breaks free */
#define RESTING 0.01          /* of the velocity of the axis */
/* After a pause: the inputs of its first cycle are older, the set-point of the second one is the first that knows of it, and
 * the drive has it in the third. */
enum { AFTER_STALL = 2, LATE_CYCLES = 3 };
enum { GAIN_MS = 20, STILL_MS = 60, STALL_MS = 300, CATCH_MS = 500, QUIET_MS = 200, HALT_MS = 300, SWING_MS = 50 };

static int cycles_of(const run_t *run, double ms) { return (int)(ms * 1000 / run->scenario->cycle_us); }

/* ---- what the machine shows -------------------------------------------------------------------------------------- */

static void hash(run_t *run, const void *data, size_t size)
{
    for (size_t i = 0; i < size; i++)
        run->outcome->hash = (run->outcome->hash ^ ((const unsigned char *)data)[i]) * UINT64_C(0x100000001B3);
}

static void look_at_axis(run_t *run, machine_axis_t *axis)
{
    cm1e_axis_read(axis->reference, &axis->info);
    if (is_motor(axis))
        cm1e_sim_probe_channel(run->segments[axis->network], axis->position, axis->channel, &axis->probe);
    judge_move_load(run, axis);
    hash(run, &axis->info.state, sizeof axis->info.state);
    hash(run, &axis->info.set_position, sizeof axis->info.set_position);
    hash(run, &axis->info.set_velocity, sizeof axis->info.set_velocity);
    hash(run, &axis->probe.position_counts, sizeof axis->probe.position_counts);
    if (scenario_trace)
        fprintf(scenario_trace, "%d,%s,%d,%s,%.6g,%.6g,%.9g,%.9g,%.9g,%d,%04X,%d,%04X,%d\n", run->cycle, axis->name,
                run->phase,
                cm1e_axis_state_name(axis->info.state), axis->info.set_position * axis->spec->counts_per_unit,
                axis->info.set_velocity * axis->spec->counts_per_unit,
                axis->info.actual_position * axis->spec->counts_per_unit, axis->probe.position_counts,
                axis->probe.velocity_counts_per_s, axis->probe.torque_on, axis->probe.controlword,
                run->bad[axis->network], cm1e_error_id(axis->info.error), axis->info.mode);
}

void judge_look(run_t *run)
{
    for (int i = 0; i < run->networks; i++) {
        const cm1e_bus_counters_t *counters = cm1e_bus_counters(run->buses[i]);
        const uint64_t bad = counters->lost_frames + counters->working_counter_errors + counters->late_frames;
        run->bad[i] = bad > run->bad_before[i] ? run->bad[i] + 1 : 0;
        run->bad_before[i] = bad;
    }
    for (int n = 0; n < run->scenario->axis_count; n++)
        look_at_axis(run, &run->axes[n]);
}

/* ---- the motor --------------------------------------------------------------------------------------------------- */

/** Nm; counts of a revolution. */
static double peak_torque(const axis_spec_t *spec) { return spec->kind == AXIS_CIA402 ? 1.2 : 0.117; }
static double revolution(const axis_spec_t *spec) { return spec->kind == AXIS_CIA402 ? 131072 : 50000; }

static bool by_velocity(const axis_spec_t *spec) { return spec->kind == AXIS_CM1E && spec->mapping == MAPPING_CSV; }

/** Counts/s2 for a Nm. */
static double gain_of(const axis_spec_t *spec)
{
    const double load = spec->load_inertia > 0 ? spec->load_inertia : 2e-6;
    return revolution(spec) / RADIANS / (peak_torque(spec) * ROTOR_INERTIA_PER_TORQUE + load);
}

/** The way that a motor needs to stop from this speed by its torque. */
static double way_to_stop(const axis_spec_t *spec, double speed)
{
    return speed * speed / (2 * peak_torque(spec) * gain_of(spec));
}

/** The way of a stop with the limits of the axis, from a constant velocity. */
static double way_of_ramp(const axis_spec_t *spec, double speed)
{
    const double rounding = spec->jerk > 0 ? spec->deceleration / (2 * spec->jerk) : 0;
    return speed * (speed / (2 * spec->deceleration) + rounding);
}

/** Counts at which friction holds the shaft off its target, until the integral of the servo breaks it free. */
static double slack_of(const axis_spec_t *spec)
{
    const double stiffness = SERVO_BANDWIDTH * SERVO_BANDWIDTH / gain_of(spec);
    return (spec->friction > 0 ? spec->friction : 0.005) / stiffness;
}

/* ---- the shaft --------------------------------------------------------------------------------------------------- */

/** A load moves it, or it coasts since then. */
static bool is_pushed(const run_t *run, machine_axis_t *axis)
{
    witness_t *seen = &axis->seen;
    const bool pushed = run->cycle < seen->pushed_until + cycles_of(run, QUIET_MS);
    if (pushed && fabs(axis->probe.velocity_counts_per_s) > 1 && !axis->probe.torque_on)
        seen->pushed_until = fmax(seen->pushed_until, run->cycle);
    return pushed;
}

/** A motor that pressed against its stop gets its own position for a target: the servo throws it back from the stop. */
static bool recoils(const run_t *run, const machine_axis_t *axis)
{
    return axis->spec->stops != 0 && axis->info.error == CM1E_ERROR_AXIS_LAG &&
           run->cycle - axis->seen.error_at < cycles_of(run, QUIET_MS);
}

/** Counts/s; how much faster than its set-point a shaft gets that stood at the place of the set-point while that moved
 *  at `speed`. With all torque, for the acceleration A, it is as fast when it is speed^2 / 2 A behind. It goes on until
 *  the damping of the servo (a ratio of 1: 2 / bandwidth times the velocity) equals what is left of that way. */
static double catch_up_speed(const axis_spec_t *spec, double speed)
{
    const double acceleration = peak_torque(spec) * gain_of(spec), damping_s = 2 / SERVO_BANDWIDTH;
    const double way = speed * speed / (2 * acceleration);
    return acceleration * (sqrt(damping_s * damping_s + 2 * way / acceleration) - damping_s);
}

/** Whether the servo overshoots where it pulls a motor back that was not stopped for so many cycles: it begins to let go
 *  where the way that is left takes 2 / bandwidth, and by then it has to be slow enough to stop there. */
static bool is_heavy(const run_t *run, const axis_spec_t *spec, double cycles)
{
    const double damping_s = 2 / SERVO_BANDWIDTH, cycle_s = run->scenario->cycle_us * 1e-6;
    const double ahead = fmin(cycles * cycle_s * spec->velocity, way_to_stop(spec, spec->velocity));
    return ahead > 4 * damping_s * damping_s * peak_torque(spec) * gain_of(spec);
}

/** Whether its motion is one of several, which goes on after up to two lost cycles. */
static bool is_composite(const run_t *run, const machine_axis_t *axis)
{
    return axis->seen.superimposed || (run->grouped && axis->number < 2);
}

/** By how much of its maximum velocity a load is too fast that ran ahead while frames were lost. */
static double heavy_share(const run_t *run, const machine_axis_t *axis)
{
    const bool follows = axis->info.state == CM1E_AXIS_SYNCHRONIZED_MOTION;
    if ((is_composite(run, axis) || follows) && is_heavy(run, axis->spec, LOST_OF_COMPOSITE))
        return COMPOSITE_OVERSHOOT;
    return is_heavy(run, axis->spec, LOST_OF_ONE) ? HEAVY_OVERSHOOT : 0;
}

/** A stop has held it, while its set-point turned round: it catches up (docs/SAFETY.md). */
static bool leaves_stop(const run_t *run, const machine_axis_t *axis)
{
    return axis->seen.stopped < cycles_of(run, CATCH_MS);
}

/** What a shaft may have, beyond what the servo does by itself, and why. */
typedef struct allowance {
    double amount; /**< a share of its maximum velocity, or counts/s */
    speed_reason_t reason;
} allowance_t;

static allowance_t larger(allowance_t one, allowance_t other) { return other.amount > one.amount ? other : one; }

/** By how much of its maximum velocity it may be faster. */
static allowance_t allowed_share(const run_t *run, const machine_axis_t *axis)
{
    const int lately = cycles_of(run, QUIET_MS);
    if (axis->seen.rung < lately)
        return (allowance_t){RING_OVERSHOOT, SPEED_IN_RING};
    const double pause = axis->seen.pause;
    const bool long_pause = pause >= cycles_of(run, SWING_MS);
    const bool swings = (long_pause || is_caught(run, axis)) && is_heavy(run, axis->spec, pause);
    if (axis->seen.stalled < cycles_of(run, STALL_MS))
        return (allowance_t){swings ? SWING_OVERSHOOT : STALL_OVERSHOOT, SPEED_AFTER_PAUSE};
    const bool waits = run->networks > 1 && axis->seen.jolted < lately, silent = axis->seen.quiet < lately;
    const allowance_t servo = waits    ? (allowance_t){JOLT_OVERSHOOT, SPEED_OF_NETWORK}
                              : silent ? (allowance_t){SERVO_OVERSHOOT, SPEED_AFTER_SILENCE}
                                       : (allowance_t){SERVO_OVERSHOOT, SPEED_OF_SERVO};
    return silent ? larger(servo, (allowance_t){heavy_share(run, axis), SPEED_OF_LOAD}) : servo;
}

/** The drive homes, or did not long ago and may still halt: by itself, with its own speed and acceleration. */
static bool is_homing(const run_t *run, const machine_axis_t *axis)
{
    return axis->seen.homing < cycles_of(run, HALT_MS);
}

/** Counts/s, without what the servo does by itself. */
static allowance_t highest_speed(const run_t *run, const machine_axis_t *axis)
{
    const double velocity = axis->spec->velocity;
    const allowance_t share = allowed_share(run, axis);
    const allowance_t by_drive = {HOMING_SPEED * (1 + HOMING_OVERSHOOT), SPEED_OF_HOMING};
    allowance_t by_axis = {(velocity + crossing_speed(axis->spec)) * (1 + share.amount), share.reason};
    if (leaves_stop(run, axis))
        by_axis = (allowance_t){by_axis.amount + catch_up_speed(axis->spec, velocity), SPEED_FROM_STOP};
    if (!axis->seen.by_drive)
        return by_axis;
    if (axis->info.state == CM1E_AXIS_HOMING && !axis->seen.by_steps)
        return by_drive;
    return is_homing(run, axis) ? larger(by_axis, by_drive) : by_axis;
}

static void judge_speed(run_t *run, machine_axis_t *axis)
{
    const axis_spec_t *spec = axis->spec;
    const double speed = fabs(axis->probe.velocity_counts_per_s);
    if (is_pushed(run, axis) || recoils(run, axis))
        return;
    const double acceleration = fmax(spec->acceleration, spec->deceleration) + crossing_acceleration(spec);
    const double servo = SERVO_FILTER_S * acceleration + SERVO_SPEED_COUNTS + (by_velocity(spec) ? COARSE_COUNTS : 0);
    const double own = is_homing(run, axis) && axis->seen.by_drive ? HOMING_SPEED : 0, over = speed / (fmax(spec->velocity, own) + crossing_speed(spec)) - 1;
    const allowance_t highest = highest_speed(run, axis);
    double *over_speed = &run->outcome->over_speed[highest.reason];
    *over_speed = fmax(*over_speed, over);
    const double above = (speed - highest.amount - servo) / spec->velocity;
    run->outcome->over_tolerance = fmax(run->outcome->over_tolerance, above);
    if (above > 0)
        scenario_fail(run, "speed", "%s (%s): the shaft turns at %.0f counts/s, %.3f %% over the maximum of %.0f",
                      axis->name, cm1e_axis_state_name(axis->info.state), speed, 100 * over, spec->velocity);
}

bool was_disturbed(const run_t *run, const witness_t *seen)
{
    const int lately = cycles_of(run, QUIET_MS);
    return seen->quiet < lately || seen->stalled < lately || seen->rung < lately || seen->jolted < lately;
}

/** Pressed against a stop, it gains what it has stored when it may leave. */
static bool at_stop(const machine_axis_t *axis)
{
    return axis->spec->stops != 0 && fabs(axis->probe.position_counts) > STOP_COUNTS;
}

/** The set-point itself knows no tolerance but that of its numbers. */
static void judge_set_point(run_t *run, machine_axis_t *axis)
{
    const axis_spec_t *spec = axis->spec;
    const double velocity = axis->info.set_velocity * spec->counts_per_unit, before = axis->seen.set_velocity;
    const bool braked_first = is_braked_first(axis, velocity);
    const double change = braked_first ? 0 : fabs(velocity - before);
    const double most = fmax(spec->acceleration, spec->deceleration) * run->scenario->cycle_us * 1e-6;
    const bool by_drive = axis->info.state == CM1E_AXIS_HOMING && axis->seen.by_drive;
    /* Nobody can brake a motor that has no torque, that its bridge does not reach, or that a hard stop holds. */
    /* In CSV, after an untrue position, the ramp begins where the motor is. */
    const bool lied_to = by_velocity(spec) && axis->seen.caught < cycles_of(run, QUIET_MS);
    const bool gone = is_motor(axis) && axis->info.state == CM1E_AXIS_ERROR_STOP && velocity == 0 &&
                      (!axis->probe.torque_on || axis->channel > 0 || at_stop(axis));
    /* Whatever has disturbed it: an axis that got its torque not long ago begins nothing in Disabled but to brake. A ramp
     * that a pause or a silence had held goes on. */
    const bool rested = axis->seen.unmoved > cycles_of(run, GAIN_MS);
    const bool begins = is_caught(run, axis) && axis->info.state == CM1E_AXIS_DISABLED && rested && velocity != 0;
    axis->seen.unmoved = velocity == 0 ? axis->seen.unmoved + 1 : 0;
    axis->seen.set_velocity = velocity;
    if (begins && !braked_first)
        scenario_fail(run, "set-point", "%s: the set velocity of an axis that is Disabled is %.0f counts/s, its shaft turns at "
                      "%.0f", axis->name, velocity, axis->probe.velocity_counts_per_s);
    if (change > most * (1 + 1e-6) + 1e-3 && !was_disturbed(run, &axis->seen) && !by_drive && !gone &&
        !lied_to)
        scenario_fail(run, "set-point", "%s (%s): the set velocity changes from %.3f to %.3f counts/s in a cycle, its limits "
                      "allow %.3f", axis->name, cm1e_axis_state_name(axis->info.state), before, velocity, most);
    if (fabs(velocity) > axis->spec->velocity * (1 + 1e-6) + 1e-3 && !by_drive)
        scenario_fail(run, "set-point", "%s (%s): the set velocity is %.3f counts/s, the maximum %.3f", axis->name,
                      cm1e_axis_state_name(axis->info.state), velocity, axis->spec->velocity);
}

/** A turning shaft was enabled not long ago: the servo catches it, as hard as it can. */
bool is_caught(const run_t *run, const machine_axis_t *axis)
{
    return axis->seen.caught < cycles_of(run, CATCH_MS);
}

/** Counts/s; while friction holds a shaft, its set-point gets faster: when it breaks free, it gains that too. */
static double speed_held_back(const machine_axis_t *axis)
{
    const double longest = 2.5 * slack_of(axis->spec) + (by_velocity(axis->spec) ? COARSE_STILL_COUNTS : 0);
    const double most = sqrt(2 * fmax(axis->spec->acceleration, axis->spec->deceleration) * longest);
    const bool held = fabs(axis->probe.velocity_counts_per_s) < 1;
    return held ? fmin(fabs(axis->info.set_velocity) * axis->spec->counts_per_unit, most) : 0;
}

/** How much faster it has become within some cycles. */
static void judge_gain(run_t *run, machine_axis_t *axis)
{
    witness_t *seen = &axis->seen;
    const int window = cycles_of(run, GAIN_MS);
    const double speed = fabs(axis->probe.velocity_counts_per_s);
    memmove(seen->speeds + 1, seen->speeds, sizeof seen->speeds - sizeof seen->speeds[0]);
    seen->shaft[2] = seen->shaft[1];
    seen->shaft[1] = seen->shaft[0];
    seen->shaft[0] = signed_speed(axis);
    seen->speeds[0] = fmax(speed, speed_held_back(axis));
    const double homing = is_homing(run, axis) && axis->seen.by_drive ? HOMING_ACCELERATION : 0;
    const double most = fmax(fmax(axis->spec->acceleration, axis->spec->deceleration), homing) * window *
                        run->scenario->cycle_us * 1e-6 + crossing_speed(axis->spec); /* within some 20 ms */
    double before = 0; /* a short silence stops a motor and lets it go on: it gets no faster than it was */
    const int seen_speeds = window < SPEEDS_SEEN ? SPEEDS_SEEN : SPEEDS; /* cycles of 250 us need more of them */
    for (int i = window; i < seen_speeds; i++)
        before = fmax(before, seen->speeds[i]);
    const double gain = speed - before, noise = 1500 + 0.4 * SERVO_BANDWIDTH * slack_of(axis->spec);
    if (is_pushed(run, axis) || !axis->probe.torque_on || recoils(run, axis) || is_caught(run, axis) ||
        leaves_stop(run, axis))
        return;
    if (gain / most - 1 > run->outcome->over_gain && most > 5 * noise)
        run->outcome->over_gain = gain / most - 1;
    /* A motor that was held for a moment gets back to the speed that its set-point has by now, or a heavy load has run
     * on and comes back. Its maximum velocity holds all the same. */
    if (was_disturbed(run, seen))
        return;
    if (gain > most * SERVO_GAIN + noise)
        scenario_fail(run, "gain", "%s (%s): the shaft gains %.0f counts/s in %d cycles, its limits allow %.0f",
                      axis->name, cm1e_axis_state_name(axis->info.state), gain, window, most);
}

bool at_rest(const machine_axis_t *axis)
{
    const cm1e_axis_state_t state = axis->info.state;
    return (state == CM1E_AXIS_DISABLED || state == CM1E_AXIS_STANDSTILL || state == CM1E_AXIS_ERROR_STOP) &&
           axis->info.set_velocity == 0;
}

/** Nobody has commanded it: it does not move. */
static void judge_still(run_t *run, machine_axis_t *axis)
{
    witness_t *seen = &axis->seen;
    const bool switched = seen->torque_on != axis->probe.torque_on;
    seen->caught++;
    if (switched && axis->probe.torque_on && fabs(axis->probe.velocity_counts_per_s) > CAUGHT_SPEED)
        seen->caught = 0;
    seen->torque_on = axis->probe.torque_on;
    /* In CSV a drive that hears nothing goes on with what the position loop has asked for last (docs/SAFETY.md), also in a
     * pause of the host. */
    const bool goes_on = by_velocity(axis->spec) && (run->bad[axis->network] > 0 || seen->stalled == AFTER_STALL);
    /* In CSV a position that is not true moves the motor at the speed of the position loop (docs/SAFETY.md). */
    const bool deceived = by_velocity(axis->spec) && seen->caught < cycles_of(run, QUIET_MS);
    /* A target that was lost on its way out is not the place of rest until a frame arrives again, which has it too. */
    const bool settled = seen->quiet == cycles_of(run, QUIET_MS);
    if (!at_rest(axis) || switched || goes_on || deceived || settled || is_pushed(run, axis)) {
        seen->rest_cycles = 0;
        return;
    }
    if (seen->rest_cycles < cycles_of(run, STILL_MS)) {
        seen->rest_cycles = fabs(axis->probe.velocity_counts_per_s) < 1 ? seen->rest_cycles + 1 : 0;
        seen->rest_at = axis->probe.position_counts;
    }
    double most = STILL_COUNTS + (by_velocity(axis->spec) ? COARSE_STILL_COUNTS : 0);
    if (axis->probe.torque_on)
        most += 2.5 * slack_of(axis->spec);
    /* The last target may have been lost on its way out: the next frame that arrives has it too (docs/SAFETY.md). */
    if (axis->probe.torque_on && seen->quiet < cycles_of(run, QUIET_MS))
        most += STEP_OVERSHOOT * axis->spec->velocity * run->scenario->cycle_us * 1e-6;
    if (fabs(axis->probe.position_counts - seen->rest_at) > most)
        scenario_fail(run, "still", "%s (%s): the shaft has moved by %.1f counts, and nobody commanded it", axis->name,
                      cm1e_axis_state_name(axis->info.state), axis->probe.position_counts - seen->rest_at);
}

/** They switch software limits off. */
static const char *const limit_switches[] = {"MC_WriteBoolParameter", NULL};

/** In a pause of the host a motor runs on that has a velocity for a target, or a profile of the drive, and the drive may
 *  accelerate by it (docs/SAFETY.md). It has to stop with its own limits from where it is when it hears of that, and has
 *  stopped when it stands or comes back. */
static void note_pause(const run_t *run, machine_axis_t *axis, double place, double velocity)
{
    const axis_spec_t *spec = axis->spec;
    witness_t *seen = &axis->seen;
    const bool runs_on = by_velocity(spec) || spec->motion != 0;
    if (seen->stalled == AFTER_STALL && runs_on && axis->probe.torque_on && velocity != 0) {
        const double late_s = LATE_CYCLES * run->scenario->cycle_us * 1e-6;
        const double gain = spec->motion != 0 ? spec->acceleration * late_s : 0;
        const double speed = fmax(fabs(velocity), fmin(fabs(velocity) + gain, spec->velocity));
        seen->runs = velocity > 0 ? 1 : -1;
        seen->runs_to = place + seen->runs * (speed * late_s + way_of_ramp(spec, speed));
    } else if (velocity * seen->runs <= spec->velocity * RESTING) {
        seen->runs = 0;
    }
}

static void judge_place(run_t *run, machine_axis_t *axis)
{
    const axis_spec_t *spec = axis->spec;
    const double place = axis->seen.load;
    note_pause(run, axis, place, axis->probe.velocity_counts_per_s * (spec->invert != 0 ? -1 : 1));
    const bool inside = place >= spec->limit_negative && place <= spec->limit_positive;
    axis->seen.coasted = !inside && (axis->seen.coasted || !axis->probe.torque_on);
    if ((spec->limit_negative == 0 && spec->limit_positive == 0) || !axis->seen.kept || axis->seen.shifted ||
        program_has(run->scenario, axis->number, limit_switches) || axis->seen.coasted || is_caught(run, axis) || !axis->probe.torque_on ||
        axis->info.state == CM1E_AXIS_ERROR_STOP)
        return;
    const double cycle_s = run->scenario->cycle_us * 1e-6;
    double margin = 30 + spec->velocity * cycle_s;
    if (axis->seen.quiet < cycles_of(run, QUIET_MS)) /* it went on while nobody could tell it anything */
        margin += way_to_stop(spec, spec->velocity) + spec->velocity * cycle_s * (run->scenario->lost_limit + 3);
    const double beyond = fmax(place - spec->limit_positive, spec->limit_negative - place);
    const double outwards = place > spec->limit_positive ? 1 : -1;
    const double velocity = axis->probe.velocity_counts_per_s * (spec->invert != 0 ? -1 : 1) * outwards;
    const bool runs_on = axis->seen.runs == outwards && (axis->seen.runs_to - place) * outwards >= -margin;
    if (!runs_on && beyond > margin && velocity > spec->velocity * RESTING)
        scenario_fail(run, "place", "%s (%s): the shaft is %.0f counts beyond its software limit and goes on",
                      axis->name, cm1e_axis_state_name(axis->info.state), beyond);
}

/* ---- torque and states ------------------------------------------------------------------------------------------- */

#define BIT(state) (1u << CM1E_AXIS_##state)

/** An error of bus or drive, and none of the faults until now concerns this axis and is long enough. An optional slave that leaves concerns
 *  only its own axis. */
static bool is_groundless(const run_t *run, const machine_axis_t *axis)
{
    const cm1e_error_t error = axis->info.error;
    const bool of_bus = (error <= CM1E_ERROR_BUS_NO_SLAVES && error >= CM1E_ERROR_INTERFACE_IN_USE) ||
                        error == CM1E_ERROR_BUS_CLOCKS || error == CM1E_ERROR_AXIS_OFFLINE;
    const bool of_drive = error <= CM1E_ERROR_DRIVE_FAULT && error >= CM1E_ERROR_DRIVE_KEEPS_TORQUE &&
                          axis->spec->stops == 0; /* a motor that presses against its stop is overloaded */
    /* Without any fault, a motor that nothing holds follows its set-point, but where its program has led it back from CMD
     * or CPIO by CML, and insisted (docs/BRIDGE.md). */
    const bool follows = axis->spec->stops == 0 && (axis->probe.broken_rules & CM1E_SIM_MODE_NO_WAY) == 0;
    if (error == CM1E_ERROR_AXIS_LAG && follows && run->scenario->fault_count == 0)
        return true;
    return (of_bus || of_drive) && run->phase == PHASE_PROGRAM && !fault_explains(run, axis, of_bus);
}

/** Figure 2 of PLCopen Part 1, without its causes. Two changes may happen between two cycles. */
static void judge_state(run_t *run, machine_axis_t *axis)
{
    static const unsigned to[CM1E_AXIS_STATE_COUNT] = {
        [CM1E_AXIS_DISABLED] = BIT(STANDSTILL) | BIT(ERROR_STOP),
        [CM1E_AXIS_STANDSTILL] = 0xFF,
        [CM1E_AXIS_HOMING] = 0xFF,
        [CM1E_AXIS_DISCRETE_MOTION] = 0xFF,
        [CM1E_AXIS_CONTINUOUS_MOTION] = 0xFF,
        [CM1E_AXIS_SYNCHRONIZED_MOTION] = 0xFF,
        [CM1E_AXIS_STOPPING] = 0xFF,
        [CM1E_AXIS_ERROR_STOP] = BIT(DISABLED) | BIT(STANDSTILL),
    };
    const cm1e_axis_state_t before = axis->seen.state, now = axis->info.state;
    axis->seen.state = now;
    axis->seen.fails_off = before == CM1E_AXIS_DISABLED && now == CM1E_AXIS_ERROR_STOP;
    if (before == now)
        return;
    if (!(to[before] >> now & 1))
        scenario_fail(run, "state", "%s: from %s to %s", axis->name, cm1e_axis_state_name(before),
                      cm1e_axis_state_name(now));
    if (now != CM1E_AXIS_ERROR_STOP)
        return;
    axis->seen.error_at = run->cycle;
    char text[CM1E_AXIS_ERROR_TEXT_BYTES];
    cm1e_axis_error_text(axis->reference, text, sizeof text);
    if (is_groundless(run, axis))
        scenario_fail(run, "groundless", "%s is in ErrorStop, error 0x%04X, and nothing has happened to it: %.200s",
                      axis->name, cm1e_error_id(axis->info.error), text);
    if (axis->info.error == CM1E_OK || !strstr(text, axis->name))
        scenario_fail(run, "text", "%s: ErrorStop with error 0x%04X, and a text that does not name the axis: %.200s",
                      axis->name, cm1e_error_id(axis->info.error), text);
}

/** Without MC_Power.Enable, or in ErrorStop, the torque ends: after a ramp, and it does not come back. */
static void judge_torque(run_t *run, machine_axis_t *axis)
{
    if (axis->seen.stranger && run->cycle > axis->seen.stranger_from && axis->probe.torque_on)
        scenario_fail(run, "stranger", "%s: another device is in the place of its slave, and its motor has torque",
                      axis->name);
    const axis_spec_t *spec = axis->spec;
    witness_t *seen = &axis->seen;
    const bool off = !axis->power.Enable || axis->info.state == CM1E_AXIS_ERROR_STOP;
    const bool deaf = run->bad[axis->network] > 0 || !axis->info.online;
    seen->off_cycles = !off ? 0 : axis->probe.torque_on && !deaf ? seen->off_cycles + 1 : seen->off_cycles;
    const double ramp_s = spec->velocity / spec->deceleration + spec->acceleration / spec->jerk +
                          spec->deceleration / spec->jerk;
    /* Where the drive homes or moves by itself it halts by itself; a motor behind a bridge may hold its place. */
    const double longest_s = ramp_s + (seen->by_drive || spec->motion != 0 ? 11 : 2.5);
    if (axis->channel == 0 && axis->info.state != CM1E_AXIS_HOMING && axis->probe.torque_on &&
        seen->off_cycles > cycles_of(run, 1000 * longest_s))
        scenario_fail(run, "torque", "%s (%s): under torque %d cycles after it was to be switched off", axis->name,
                      cm1e_axis_state_name(axis->info.state), seen->off_cycles);
}

/** Whether the master knows how fast a motor turns that has just got its torque: some cycles of torque show it, behind a
 *  pause in these once more, and one more then, because the first frame behind it may come at once (docs/SAFETY.md). */
static bool velocity_is_known(const witness_t *seen)
{
    enum { UNKNOWN = 5 };
    const bool paused = seen->caught - seen->stalled <= UNKNOWN && seen->stalled <= UNKNOWN + 1;
    return seen->caught > UNKNOWN && !paused;
}

/** The master takes the torque off a motor that still turns, although it could brake it: it knows that it turns. */
static void judge_let_go(run_t *run, machine_axis_t *axis)
{
    enum { ENABLED_BITS = 0x0F };
    witness_t *seen = &axis->seen;
    const unsigned told = axis->probe.controlword; /* 0: the drive is not in operation */
    const bool enabled = (told & ENABLED_BITS) == ENABLED_BITS, taken = seen->enabled && !enabled && told != 0;
    const double speed = fabs(axis->probe.velocity_counts_per_s);
    const bool had_torque = seen->had_torque;
    seen->enabled = enabled;
    seen->had_torque = axis->probe.torque_on;
    const bool heard = seen->quiet >= cycles_of(run, QUIET_MS); /* else the drive may have swung meanwhile */
    if (taken && heard && velocity_is_known(seen) && !recoils(run, axis) && had_torque && !axis->probe.torque_on && speed > LET_GO * axis->spec->velocity + LET_GO_SPEED)
        scenario_fail(run, "let-go", "%s (%s): without torque at %.0f counts/s, error %04X, number %d", axis->name,
                      cm1e_axis_state_name(axis->info.state), speed, cm1e_error_id(axis->info.error), axis->info.error);
}

static void judge_power(run_t *run, machine_axis_t *axis)
{
    const MC_Power_t *power = &axis->power;
    if ((power->Valid && power->Error) || power->Error != (power->ErrorID != 0) || (power->Status && power->Error))
        scenario_fail(run, "block", "%s: MC_Power: Status %d, Valid %d, Error %d, ErrorID 0x%04X", axis->name,
                      power->Status, power->Valid, power->Error, power->ErrorID);
    if (power->Enable && axis->info.state == CM1E_AXIS_ERROR_STOP && !axis->info.powered && !power->Error)
        scenario_fail(run, "block", "%s is in ErrorStop, and MC_Power does not show it", axis->name);
}

/* ---- the log ----------------------------------------------------------------------------------------------------- */

static void judge_event(run_t *run, const cm1e_log_event_t *event)
{
    if (event->number != run->logged + 1 || event->run_ns < run->logged_ns)
        scenario_fail(run, "log", "record %llu at %lld ns follows %llu at %lld ns", (unsigned long long)event->number,
                      (long long)event->run_ns, (unsigned long long)run->logged, (long long)run->logged_ns);
    if (scenario_trace) {
        char text[512];
        cm1e_log_text(run->scheduler, event, text, sizeof text);
        fprintf(scenario_trace, "# %.6f s %s\n", (double)event->run_ns * 1e-9, text);
    }
    run->logged = event->number;
    run->logged_ns = event->run_ns;
    if (event->axis < 0 || event->axis >= run->scenario->axis_count)
        return;
    machine_axis_t *axis = NULL;
    for (int n = 0, place = 0; n < SCENARIO_NETWORKS; n++) /* the axes of the first network come first */
        for (int i = 0; i < run->scenario->axis_count; i++)
            if (run->axes[i].network == n && place++ == event->axis)
                axis = &run->axes[i];
    witness_t *seen = &axis->seen;
    if (event->kind == CM1E_LOG_ERROR && event->code != 0)
        seen->told = true;
    if (event->kind != CM1E_LOG_STATE)
        return;
    if (seen->logged == CM1E_AXIS_ERROR_STOP && !seen->told)
        scenario_fail(run, "log", "%s: the log does not say why it was in ErrorStop", axis->name);
    seen->told = false;
    if ((cm1e_axis_state_t)event->detail != seen->logged)
        scenario_fail(run, "log", "%s: the log tells of a way out of %s, but it was in %s", axis->name,
                      cm1e_axis_state_name((cm1e_axis_state_t)event->detail), cm1e_axis_state_name(seen->logged));
    seen->logged = (cm1e_axis_state_t)event->code;
}

static void judge_log(run_t *run)
{
    cm1e_log_event_t events[64];
    uint64_t lost = 0;
    size_t count;
    while (!run->outcome->failed && (count = cm1e_log_read(run->scheduler, run->logged, events, 64, &lost)) > 0) {
        if (lost > 0)
            run->logged = events[0].number - 1;
        for (size_t i = 0; i < count; i++)
            judge_event(run, &events[i]);
    }
}

/* ---- each cycle -------------------------------------------------------------------------------------------------- */

static const char *const drive_homings[] = {"MC_Home", NULL}, *const shifts[] = {"MC_SetPosition", NULL};
static const char *const superimposed[] = {"MC_MoveSuperimposed", NULL};

void judge_begin(run_t *run)
{
    run->outcome->hash = UINT64_C(0xCBF29CE484222325);
    for (int n = 0; n < run->scenario->axis_count; n++) {
        witness_t *seen = &run->axes[n].seen;
        *seen = (witness_t){.kept = true, .stalled = 1000000, .rung = 1000000, .caught = 1000000, .homing = 1000000,
                            .stopped = 1000000, .quiet = 1000000, .jolted = 1000000, .pushed_until = -1000000, .shoved_at = -1000000};
        seen->by_steps = program_has(run->scenario, n, step_homings);
        seen->by_drive = program_has(run->scenario, n, drive_homings);
        seen->shifted = seen->by_steps || seen->by_drive || program_has(run->scenario, n, shifts);
        seen->superimposed = program_has(run->scenario, n, superimposed);
        seen->by_itself = program_has(run->scenario, n, own_motions);
        for (int i = 0; i < run->scenario->step_count; i++) /* its place in the gap is mended slowly */
            seen->unseen = seen->unseen || (run->scenario->steps[i].source != 0 && (int)run->scenario->steps[i].master == n);
    }
}

/** A distance of a modulo axis counts in the nearer direction. */
static double apart(const axis_spec_t *spec, double distance)
{
    return spec->modulo > 0 ? remainder(distance, spec->modulo) : distance;
}

/** At rest in position, with a flank of its gear closed, an axis shows where its load is. A motor that lags behind the
 *  crossing when that turns round has not got to the flank. */
static void judge_load(run_t *run, machine_axis_t *axis)
{
    const axis_spec_t *spec = axis->spec;
    const witness_t *seen = &axis->seen;
    const double gap = seen->load - axis->probe.position_counts * (spec->invert != 0 ? -1 : 1);
    const bool closed = gap <= 0 || gap >= spec->backlash;
    const double lag = 4 * run->scenario->cycle_us * 1e-6 * crossing_speed(spec) + 2.5 * slack_of(spec);
    const double off = spec->start + seen->load - axis->info.actual_position * spec->counts_per_unit;
    if (spec->backlash > 0 && closed && seen->kept && !seen->unseen && !seen->cut && !seen->shifted && at_rest(axis) && axis->info.in_position &&
        axis->probe.torque_on && !is_pushed(run, axis) && !was_disturbed(run, seen) &&
        fabs(apart(spec, off)) > LOAD_COUNTS + lag)
        scenario_fail(run, "load", "%s (%s): its load is %.1f counts from where the axis shows it", axis->name,
                      cm1e_axis_state_name(axis->info.state), off);
}

void judge_cycle(run_t *run)
{
    for (int n = 0; n < run->scenario->axis_count; n++) {
        machine_axis_t *axis = &run->axes[n];
        judge_state(run, axis);
        judge_power(run, axis);
        axis->seen.stalled++;
        axis->seen.rung++;
        axis->seen.stopped = at_stop(axis) && fabs(axis->probe.velocity_counts_per_s) < 1 ? 0 : axis->seen.stopped + 1;
        axis->seen.homing = axis->info.state == CM1E_AXIS_HOMING ? 0 : axis->seen.homing + 1;
        axis->seen.jolted = run->bad[0] > 0 || run->bad[SCENARIO_NETWORKS - 1] > 0 ? 0 : axis->seen.jolted + 1;
        /* An optional slave may be silent alone. */
        const bool unheard = run->bad[axis->network] > 0 || (axis->spec->optional != 0 && !axis->info.online);
        axis->seen.quiet = unheard ? 0 : axis->seen.quiet + 1;
        judge_set_point(run, axis);
        if (!is_motor(axis))
            continue;
        judge_bridge(run, axis);
        judge_load(run, axis);
        judge_enable(run, axis);
        judge_still(run, axis);
        judge_speed(run, axis);
        judge_gain(run, axis);
        judge_place(run, axis);
        judge_torque(run, axis);
        judge_let_go(run, axis);
    }
    fault_judge(run);
    if (run->cycle % 64 == 0)
        judge_log(run);
}

/** The last move of all axes. */
static void judge_test(run_t *run, machine_axis_t *axis)
{
    const double by = axis->seen.load - axis->test_from;
    /* A load stays where the servo has pushed it on its way into position. Where a motor was without power, or turned while
     * nobody saw it, its place in the gap is unknown. */
    const bool known = axis->seen.kept && !axis->seen.unseen && !axis->seen.cut;
    const double geared = axis->spec->backlash > 0 ? LOAD_COUNTS : 0;
    const double most = STILL_COUNTS + slack_of(axis->spec) + (by_velocity(axis->spec) ? COARSE_STILL_COUNTS : 0) + geared;
    if (is_motor(axis) && fabs(by - axis->test_by) > most + (known ? 0 : axis->spec->backlash))
        scenario_fail(run, "end", "%s: the last move was %.0f counts, its load has gone %.1f", axis->name,
                      axis->test_by, by);
    /* Where nothing made the device forget its position, the coordinates are those of the start. */
    const double place = axis->spec->start + axis->seen.load;
    const double shown = axis->info.actual_position * axis->spec->counts_per_unit;
    if (is_motor(axis) && axis->seen.kept && !axis->seen.shifted &&
        fabs(apart(axis->spec, place - shown)) > KEPT_COUNTS + geared + (known ? 0 : axis->spec->backlash))
        scenario_fail(run, "position", "%s is at %.1f counts, and shows %.1f", axis->name, place, shown);
}

void judge_end(run_t *run)
{
    judge_log(run);
    for (int n = 0; n < run->scenario->axis_count; n++) {
        const witness_t *seen = &run->axes[n].seen;
        if (seen->logged != seen->state)
            scenario_fail(run, "log", "%s is in %s, the log ends with %s", run->axes[n].name,
                          cm1e_axis_state_name(seen->state), cm1e_axis_state_name(seen->logged));
        judge_test(run, &run->axes[n]);
    }
}
