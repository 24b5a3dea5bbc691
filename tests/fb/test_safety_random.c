/**
 * Random programs with random faults on one to three axes: every block with random, also absurd, inputs; every command
 * of the simulator's console and every fault of the frames, in any order. What must hold in each cycle:
 *
 *  - set-points neither jump nor change faster than the axis's limits, nor leave its software limits; none before the
 *    drive holds its actual position (the witness of safety_bench.h; one target is rounded to counts, so one step may
 *    be 1 count longer, and a change of steps 2 counts, than the limits in units say);
 *  - the axis's state goes only the ways of PLCopen's figure 2, and only for a reason;
 *  - outputs of blocks exclude each other (PLCopen 2.4.1), ErrorID belongs to Error;
 *  - without MC_Power.Enable, and in ErrorStop, the torque ends in time and never comes back by itself;
 *  - in ErrorStop the set-point only slows down; after MC_Reset nothing goes on;
 *  - an error has a sentence that names axis and cause.
 *
 * Seeds: seeds.h.
 */
#include "safety_bench.h"

enum { CYCLES = 22000, RUNS = 60 };

typedef enum block { BLOCK_ABSOLUTE = 0, BLOCK_RELATIVE, BLOCK_VELOCITY, BLOCK_HALT, BLOCK_STOP, BLOCK_HOME,
                     BLOCK_RESET, BLOCKS } block_t;
static const char *const block_names[BLOCKS] = {"MC_MoveAbsolute", "MC_MoveRelative", "MC_MoveVelocity", "MC_Halt",
                                                "MC_Stop", "MC_Home", "MC_Reset"};

/** Outputs of any block; MC_Reset has no Active and no CommandAborted, MC_MoveVelocity no Done. */
typedef struct outputs {
    bool execute, done, busy, active, aborted, error;
    WORD error_id;
} outputs_t;

typedef struct player {
    MC_Power_t power, second_power;
    MC_MoveAbsolute_t absolute;
    MC_MoveRelative_t relative;
    MC_MoveVelocity_t velocity;
    MC_Halt_t halt;
    MC_Stop_t stop;
    MC_Home_t home;
    MC_Reset_t reset;
    cm1e_homing_config_t homing;
    outputs_t before[BLOCKS];
    bool absurd[BLOCKS];            /**< an input of the last edge was no number at all */
    cm1e_axis_state_t state;        /**< last seen */
    bool reset_asked;               /**< since the axis is in ErrorStop */
    bool edge;                      /**< of any block in this cycle */
    bool waits_alone;               /**< a command does whose block has lost it by a new edge that was refused */
    int error_cycles, off_cycles, rest_cycles;
    unsigned enablings;
    double step_before, set_before, speed_before; /**< counts; u; u/s */
    bool found_again;               /**< the set-point, in ErrorStop, where the motor was */
    double lowest, highest;         /**< u; where the set-point may be */
    unsigned new_beginnings;
    int undisturbed_cycles;
    double top_speed;
} player_t;

static bench_t bench;
static player_t players[BENCH_AXES];
static int end_cycle;
static int64_t end_ns; /* when the stop was asked for */
static bool heard_at_end[BENCH_AXES];
static unsigned long cycles_total, errors_total, moves_total, set_points_total;

/* ---- what may happen --------------------------------------------------------------------------------------------- */

#define BIT(state) (1u << CM1E_AXIS_##state)
enum { IN_MOTION = BIT(STANDSTILL) | BIT(DISCRETE_MOTION) | BIT(CONTINUOUS_MOTION) };

/** PLCopen Part 1, figure 2, by cause: from which states a change is allowed, and to where. */
typedef struct change {
    unsigned from, to;
} change_t;
static const change_t by_block[BLOCKS][1] = {
    [BLOCK_ABSOLUTE] = {{IN_MOTION, BIT(DISCRETE_MOTION)}},
    [BLOCK_RELATIVE] = {{IN_MOTION, BIT(DISCRETE_MOTION)}},
    [BLOCK_VELOCITY] = {{IN_MOTION, BIT(CONTINUOUS_MOTION)}},
    [BLOCK_HALT] = {{IN_MOTION, BIT(DISCRETE_MOTION)}},
    [BLOCK_STOP] = {{IN_MOTION | BIT(HOMING), BIT(STOPPING)}},
    [BLOCK_HOME] = {{BIT(STANDSTILL), BIT(HOMING)}},
    [BLOCK_RESET] = {{0, 0}},
};
static const change_t by_power_off[] = {{0xFF & ~BIT(ERROR_STOP), BIT(DISABLED)}};
/* A motion whose direction is disabled ends like one that MC_Halt ends; homing is aborted. */
static const change_t by_direction[] = {{BIT(CONTINUOUS_MOTION), BIT(DISCRETE_MOTION)}, {BIT(HOMING), BIT(STANDSTILL)}};
static const change_t by_cycle[] = {
    {0xFF, BIT(ERROR_STOP)},
    {BIT(DISABLED), BIT(STANDSTILL)},
    {BIT(DISCRETE_MOTION) | BIT(HOMING) | BIT(STOPPING), BIT(STANDSTILL)},
    {BIT(ERROR_STOP), BIT(DISABLED) | BIT(STANDSTILL)}, /* and then only after MC_Reset */
};

/* MC_MoveAbsolute waits behind a motion or a homing, and may begin when that ends, or is InVelocity. */
static const change_t by_waiting[] = {{BIT(CONTINUOUS_MOTION) | BIT(HOMING), BIT(DISCRETE_MOTION)}};

static bool waits(const player_t *p) { return p->before[BLOCK_ABSOLUTE].busy && !p->before[BLOCK_ABSOLUTE].active; }

static void judge_change(uint32_t n, const change_t *changes, size_t count, const char *cause)
{
    player_t *p = &players[n];
    const cm1e_axis_info_t info = bench_info(&bench, n);
    if (info.state == p->state)
        return;
    bool legal = (waits(p) || p->waits_alone) && (by_waiting[0].from >> p->state & 1) &&
                 (by_waiting[0].to >> info.state & 1);
    for (size_t i = 0; i < count; i++)
        legal = legal || ((changes[i].from >> p->state & 1) && (changes[i].to >> info.state & 1));
    MUST(&bench, legal, "axis %u: from %s to %s by %s", n, cm1e_axis_state_name(p->state),
         cm1e_axis_state_name(info.state), cause);
    MUST(&bench, p->state != CM1E_AXIS_ERROR_STOP || p->reset_asked, "axis %u: left ErrorStop without MC_Reset", n);
    p->state = info.state;
    p->reset_asked = p->waits_alone = false;
    p->error_cycles = 0;
}
#define JUDGE(n, changes, cause) judge_change(n, changes, sizeof changes / sizeof changes[0], cause)

static void judge_outputs(uint32_t n, block_t block, const outputs_t *now)
{
    player_t *p = &players[n];
    const outputs_t *before = &p->before[block];
    const char *name = block_names[block];
    const int shown = now->done + now->busy + now->aborted + now->error;
    MUST(&bench, shown <= 1 && (!now->execute || shown == 1),
         "axis %u: %s: Execute %d, Done %d, Busy %d, CommandAborted %d, Error %d", n, name, now->execute, now->done,
         now->busy, now->aborted, now->error);
    MUST(&bench, !now->active || (!now->aborted && !now->error && (!now->done || block == BLOCK_STOP)),
         "axis %u: %s: Active with another", n, name);
    MUST(&bench, now->error == (now->error_id != 0) && (!now->error || cm1e_error_from_id(now->error_id) < 0),
         "axis %u: %s: Error %d, ErrorID 0x%04X", n, name, now->error, now->error_id);
    const bool edge = now->execute && !before->execute;
    const bool ended = before->busy && !now->busy; /* 2.4.1: a result after Execute fell is shown once */
    MUST(&bench, now->execute || ended || shown == now->busy, "axis %u: %s: shows a result without Execute", n, name);
    MUST(&bench, !ended || shown == 1 || edge, "axis %u: %s: ended without a result", n, name);
    MUST(&bench, !edge || !p->absurd[block] || now->error, "axis %u: %s: took an input that is no number", n, name);
    MUST(&bench, edge || !now->busy || before->busy, "axis %u: %s: began without an edge", n, name);
    if (edge) {
        p->edge = true;
        if (block != BLOCK_RESET)
            p->waits_alone = now->error && (p->waits_alone || (block == BLOCK_ABSOLUTE && waits(p)));
        moves_total += now->busy;
    }
    p->before[block] = *now;
}

/* ---- inputs of blocks -------------------------------------------------------------------------------------------- */

static bool absurd_value;

static double value(double low, double high)
{
    static const double odd[] = {NAN, INFINITY, -INFINITY, 0, -1, 1e300, -1e300, 1e-300, 4e9, -4e9, 1e18, 0x1p53};
    if (!one_in(25))
        return uniform(low, high);
    const double chosen = odd[pick(sizeof odd / sizeof odd[0])];
    absurd_value = absurd_value || !isfinite(chosen);
    return chosen;
}

static double dynamics(double most) { return one_in(3) ? 0 : value(most * 0.05, most * 1.02); }
static BOOL odd_bool(void) { return one_in(300); }

/** Of an axis's own ranges, in units. */
static double reach(uint32_t n) { return 200000.0 / bench.config.axes[n].counts_per_unit; }

#define SET_DYNAMICS(fb, axis)                                                                                      \
    (fb).Deceleration = dynamics((axis)->max_deceleration), (fb).Jerk = dynamics((axis)->max_jerk)

static void set_homing(uint32_t n)
{
    player_t *p = &players[n];
    const double unit = bench.config.axes[n].counts_per_unit;
    p->home.Position = value(-reach(n), reach(n));
    p->homing = (cm1e_homing_config_t){
        .method = (int8_t)(one_in(6) ? pick(256) : -1 - pick(6)),
        .offset = one_in(2) ? 0 : uniform(-20000, 20000) / unit,
        .velocity = uniform(20000, 150000) / unit,
        .acceleration = uniform(500000, 3000000) / unit,
        .torque = one_in(6) ? value(0, 200) : uniform(20, 60),
        .timeout_s = uniform(0.1, 6),
    };
    p->home.Parameters = one_in(4) ? NULL : &p->homing;
    if (!p->home.Parameters)
        absurd_value = !isfinite(p->home.Position);
}

static void set_inputs(uint32_t n, block_t block)
{
    player_t *p = &players[n];
    const cm1e_axis_config_t *axis = &bench.config.axes[n];
    absurd_value = false;
    switch (block) {
    case BLOCK_ABSOLUTE:
        p->absolute.Position = value(-reach(n), reach(n));
        p->absolute.Velocity = value(axis->max_velocity * 0.02, axis->max_velocity);
        p->absolute.Acceleration = dynamics(axis->max_acceleration);
        SET_DYNAMICS(p->absolute, axis);
        p->absolute.ContinuousUpdate = odd_bool();
        p->absolute.BufferMode = odd_bool() ? (MC_BUFFER_MODE)pick(9) : mcAborting;
        break;
    case BLOCK_RELATIVE:
        p->relative.Distance = value(-reach(n), reach(n)) * (one_in(3) ? 0.01 : 1);
        p->relative.Velocity = value(axis->max_velocity * 0.02, axis->max_velocity);
        p->relative.Acceleration = dynamics(axis->max_acceleration);
        SET_DYNAMICS(p->relative, axis);
        break;
    case BLOCK_VELOCITY:
        p->velocity.Velocity = value(-axis->max_velocity, axis->max_velocity);
        p->velocity.Acceleration = dynamics(axis->max_acceleration);
        SET_DYNAMICS(p->velocity, axis);
        p->velocity.Direction = (MC_DIRECTION)(one_in(20) ? pick(9) : 0);
        break;
    case BLOCK_HALT: SET_DYNAMICS(p->halt, axis); break;
    case BLOCK_STOP: SET_DYNAMICS(p->stop, axis); break;
    case BLOCK_HOME: set_homing(n); break;
    default: break;
    }
    p->absurd[block] = absurd_value;
}

/* ---- one cycle of the program ------------------------------------------------------------------------------------ */

#define PLAY(fb, function, done, active, aborted)                                                                   \
    do {                                                                                                            \
        if ((fb).Execute ? one_in(60) : one_in(seldom)) {                                                           \
            (fb).Execute = !(fb).Execute;                                                                           \
            if ((fb).Execute)                                                                                       \
                set_inputs(n, block);                                                                               \
        }                                                                                                           \
        function(&(fb));                                                                                            \
        const outputs_t now = {(fb).Execute, (done), (fb).Busy, (active), (aborted), (fb).Error, (fb).ErrorID};     \
        judge_outputs(n, block, &now);                                                                              \
    } while (0)

static void play_block(uint32_t n, block_t block)
{
    static const unsigned how_seldom[BLOCKS] = {900, 900, 900, 3000, 4000, 5000, 2500};
    player_t *p = &players[n];
    const unsigned seldom = block == BLOCK_RESET && p->state == CM1E_AXIS_ERROR_STOP ? 300 : how_seldom[block];
    const bool execute_before = p->before[block].execute;
    switch (block) {
    case BLOCK_ABSOLUTE:
        PLAY(p->absolute, MC_MoveAbsolute, p->absolute.Done, p->absolute.Active, p->absolute.CommandAborted);
        break;
    case BLOCK_RELATIVE:
        PLAY(p->relative, MC_MoveRelative, p->relative.Done, p->relative.Active, p->relative.CommandAborted);
        break;
    case BLOCK_VELOCITY:
        PLAY(p->velocity, MC_MoveVelocity, false, p->velocity.Active, p->velocity.CommandAborted);
        MUST(&bench, !p->velocity.InVelocity || p->velocity.Active, "axis %u: InVelocity without Active", n);
        break;
    case BLOCK_HALT: PLAY(p->halt, MC_Halt, p->halt.Done, p->halt.Active, p->halt.CommandAborted); break;
    case BLOCK_STOP: PLAY(p->stop, MC_Stop, p->stop.Done, p->stop.Active, p->stop.CommandAborted); break;
    case BLOCK_HOME: PLAY(p->home, MC_Home, p->home.Done, p->home.Active, p->home.CommandAborted); break;
    default: PLAY(p->reset, MC_Reset, p->reset.Done, false, false); break;
    }
    const outputs_t *now = &p->before[block];
    const bool began = now->execute && !execute_before && !now->error;
    if (block == BLOCK_RESET && began && p->state == CM1E_AXIS_ERROR_STOP)
        p->reset_asked = true;
    judge_change(n, by_block[block], began ? 1 : 0, block_names[block]);
}

static void play_power(uint32_t n)
{
    player_t *p = &players[n];
    MC_Power_t *power = &p->power;
    if (power->Enable ? one_in(4000) : one_in(100))
        power->Enable = !power->Enable;
    if (power->EnablePositive ? one_in(6000) : one_in(200))
        power->EnablePositive = !power->EnablePositive;
    if (power->EnableNegative ? one_in(6000) : one_in(200))
        power->EnableNegative = !power->EnableNegative;
    MC_Power(power);
    MUST(&bench, !(power->Valid && power->Error) && power->Error == (power->ErrorID != 0) &&
                     (power->Enable || (!power->Valid && !power->Error)),
         "axis %u: MC_Power: Enable %d, Valid %d, Error %d, ErrorID 0x%04X", n, power->Enable, power->Valid,
         power->Error, power->ErrorID);
    if (!power->Enable)
        JUDGE(n, by_power_off, "MC_Power");
    else
        JUDGE(n, by_direction, "MC_Power");
    if (!power->Enable)
        return;
    p->second_power.Enable = one_in(50);
    MC_Power(&p->second_power);
    MUST(&bench, p->second_power.Error == p->second_power.Enable && !p->second_power.Status,
         "axis %u: a second MC_Power is taken", n);
    judge_change(n, NULL, 0, "a second MC_Power");
}

static void judge_active(uint32_t n)
{
    const player_t *p = &players[n];
    int active = 0;
    for (int i = 0; i < BLOCKS; i++)
        active += p->before[i].active;
    MUST(&bench, p->edge || active <= 1, "axis %u: %d blocks are Active", n, active);
}

/* ---- what must hold in each cycle -------------------------------------------------------------------------------- */

/** Longest stop in cycles: a ramp with jerk, the end of a homing, the drive's watchdog; and some to spare. */
static int longest_stop(uint32_t n)
{
    const cm1e_axis_config_t *axis = &bench.config.axes[n];
    const double v = axis->max_velocity, d = axis->max_deceleration, j = axis->max_jerk;
    return (int)((v / d + d / j + 2 * sqrt(v / j) + 1.5 + 0.2) * 1e9 / (double)bench.config.cycle_time_ns);
}

static bool reachable(uint32_t n);

static void judge_torque(uint32_t n, bool torque_on, cm1e_axis_state_t now)
{
    player_t *p = &players[n];
    const witness_t *w = &bench.witness[n];
    const bool error = p->state == CM1E_AXIS_ERROR_STOP && now == CM1E_AXIS_ERROR_STOP; /* no reset came to its end */
    const bool off = error || !p->power.Enable;
    const bool deaf = !bench_drive(&bench, n)->firmware->watchdog && !reachable(n); /* UG 10.1: nobody can stop it */
    MUST(&bench, !off || p->off_cycles == 0 || w->enablings == p->enablings,
         "axis %u, %s: torque is asked for without Enable or in ErrorStop", n, cm1e_axis_state_name(p->state));
    p->enablings = w->enablings;
    p->off_cycles = off && !deaf ? p->off_cycles + 1 : 0;
    MUST(&bench, p->off_cycles <= longest_stop(n) || !torque_on, "axis %u, %s: torque is on for %d cycles", n,
         cm1e_axis_state_name(p->state), p->off_cycles);
}

/** By the state that the program left the axis in, and the frame that followed. */
static void judge_motion(uint32_t n)
{
    player_t *p = &players[n];
    const witness_t *w = &bench.witness[n];
    if (!w->holding) {
        p->step_before = 0;
        p->rest_cycles = 0;
        return;
    }
    if (p->state == CM1E_AXIS_STANDSTILL && p->rest_cycles++ > 1)
        MUST(&bench, w->step == 0, "axis %u: Standstill, but the target moved by %.0f counts", n, w->step);
    if (p->state != CM1E_AXIS_STANDSTILL)
        p->rest_cycles = 0;
    const bool anew = p->new_beginnings != w->new_beginnings;
    p->new_beginnings = w->new_beginnings;
    if (p->state == CM1E_AXIS_ERROR_STOP && p->error_cycles > 1 && !anew)
        MUST(&bench, fabs(w->step) <= fabs(p->step_before) + 1, "axis %u: ErrorStop, but steps of %.0f, %.0f counts",
             n, p->step_before, w->step);
    p->step_before = w->step;
}

/** An axis that stands outside, pushed there or by its homing, may come back, but go no farther. So may one that brakes
 *  from where it is. */
static void judge_limits(uint32_t n, const cm1e_axis_info_t *info)
{
    const cm1e_axis_config_t *axis = &bench.config.axes[n];
    const witness_t *w = &bench.witness[n];
    player_t *p = &players[n];
    const double lower = axis->software_limit_negative, upper = axis->software_limit_positive, set = info->set_position;
    if (lower == 0 && upper == 0)
        return;
    const double tolerance = (info->set_velocity == 0 ? 50 : 0.02) / axis->counts_per_unit;
    const bool braking_anew = info->state == CM1E_AXIS_ERROR_STOP && info->error != CM1E_ERROR_AXIS_POSITION_RANGE;
    const bool not_yet = info->state == CM1E_AXIS_DISABLED && info->set_velocity == 0; /* shows the actual position */
    const double cycle_s = 1e-9 * (double)bench.config.cycle_time_ns, count = 1.0 / axis->counts_per_unit;
    const double step = fmax(fabs(info->set_velocity), p->speed_before) * cycle_s; /* by which it goes on as it was */
    p->found_again = info->state == CM1E_AXIS_ERROR_STOP &&
                     (p->found_again || fabs(set - p->set_before) > 1.01 * step + 2.0 * count);
    p->speed_before = fabs(info->set_velocity);
    const bool homing = info->state == CM1E_AXIS_HOMING || info->mode != w->mode;
    const bool ours = w->holding && !homing && !braking_anew && !not_yet && !p->found_again;
    p->set_before = set;
    const bool at_rest = info->state == CM1E_AXIS_STANDSTILL && info->set_velocity == 0;
    if (!ours || at_rest) {
        MUST(&bench, !ours || !w->step || (set >= p->lowest && set <= p->highest), "axis %u: ended at %.6f u", n, set);
        p->lowest = fmin(lower, set) - tolerance;
        p->highest = fmax(upper, set) + tolerance;
    }
    MUST(&bench, set >= p->lowest && set <= p->highest, "axis %u, %s: set position %.6f u, limits %.6f ... %.6f", n,
         cm1e_axis_state_name(info->state), set, p->lowest, p->highest);
}

static void judge_error(uint32_t n, const cm1e_axis_info_t *info)
{
    player_t *p = &players[n];
    char text[1024];
    MUST(&bench, (info->error != CM1E_OK) == (info->state == CM1E_AXIS_ERROR_STOP), "axis %u: %s with error %d", n,
         cm1e_axis_state_name(info->state), info->error);
    if (info->state != CM1E_AXIS_ERROR_STOP || ++p->error_cycles != 10)
        return;
    errors_total++;
    cm1e_axis_error_text(bench.axis[n], text, sizeof text);
    const size_t length = strlen(text);
    MUST(&bench, length > 60 && text[length - 1] == '.' && strstr(text, cm1e_axis_name(bench.axis[n])) &&
                     strstr(text, "MC_Reset"),
         "axis %u, error %d: \"%s\"", n, info->error, text);
    char code[16];
    snprintf(code, sizeof code, "0x%04X", info->device_error);
    MUST(&bench, !info->device_error || strstr(text, code),
         "axis %u: device error %s is not in \"%s\"", n, code, text);
}

/** Under torque nothing gets faster than the axis may be; a shaft that was turned faster by others is braked. Loads may
 *  hold an axis back or turn it, and so may its stops: what comes after those is not judged. */
static void judge_shaft(uint32_t n, const cm1e_sim_probe_t *probe)
{
    player_t *p = &players[n];
    const cm1e_axis_config_t *axis = &bench.config.axes[n];
    const double most = axis->max_velocity * axis->counts_per_unit, speed = fabs(probe->velocity_counts_per_s);
    const cm1e_sim_cm1e_t *drive = bench_drive(&bench, n);
    const double two_ms = 2e-3 * drive->motor->peak_torque_nm * drive->mechanics.gain; /* a set-point found again */
    const bool disturbed = drive->mechanics.load_torque != 0 || cm1e_mechanics_at_stop(&drive->mechanics) ||
                           p->state == CM1E_AXIS_HOMING;
    p->undisturbed_cycles = disturbed ? 0 : p->undisturbed_cycles + 1;
    p->top_speed = probe->torque_on ? fmax(p->top_speed, most) : speed;
    MUST(&bench, p->undisturbed_cycles < 3000 || !probe->torque_on || speed < 1.1 * p->top_speed + two_ms + 3000,
         "axis %u, %s: the shaft runs at %.0f counts/s, limit %.0f", n, cm1e_axis_state_name(p->state),
         probe->velocity_counts_per_s, most);
}

static void play_axis(uint32_t n)
{
    player_t *p = &players[n];
    const cm1e_axis_info_t info = bench_info(&bench, n);
    const cm1e_sim_probe_t probe = bench_probe(&bench, n);
    judge_motion(n);
    judge_torque(n, probe.torque_on, info.state);
    JUDGE(n, by_cycle, "the cycle");
    judge_error(n, &info);
    judge_limits(n, &info);
    judge_shaft(n, &probe);
    p->edge = false;
    play_power(n);
    const int first = pick(BLOCKS); /* the order of the calls is the program's own affair */
    for (int i = 0; i < BLOCKS; i++)
        play_block(n, (block_t)((first + i) % BLOCKS));
    judge_active(n);
}

/* ---- faults ------------------------------------------------------------------------------------------------------ */

static int frames_lost_there, frames_lost_back, counters_wrong, frames_cut, frames_doubled;
static bool unplugged[BENCH_AXES];
static int unheard_until;

static bool reachable(uint32_t n)
{
    for (uint32_t i = 0; i <= n; i++)
        if (unplugged[i] || !cm1e_sim_esc_present(cm1e_sim_segment_slave(bench.segment, i + 1)))
            return false;
    return bench.cycle > unheard_until && frames_lost_there == 0;
}

static cm1e_tap_verdict_t frame_fault(bench_t *b, cm1e_tap_frame_t *frame)
{
    (void)b;
    if (frame->direction == CM1E_TAP_SENT)
        return frames_lost_there > 0 && frames_lost_there-- > 0 ? CM1E_TAP_DROP : CM1E_TAP_PASS;
    if (frames_lost_back > 0 && frames_lost_back-- > 0)
        return CM1E_TAP_DROP;
    if (counters_wrong > 0 && counters_wrong-- > 0)
        cm1e_frame_change_working_counter(frame->bytes, frame->length, 0, one_in(2) ? 1 : -1);
    if (frames_cut > 0 && frames_cut-- > 0)
        frame->length -= 1 + (size_t)pick((int)frame->length - 1);
    if (frames_doubled > 0 && frames_doubled-- > 0)
        frame->copies = 2;
    return CM1E_TAP_PASS;
}

/** Mostly few: three bad cycles in a row stop everything. */
static int some_frames(void) { return one_in(4) ? 1 + pick(300) : 1 + pick(4); }

static void make_fault(bench_t *b)
{
    const uint32_t n = (uint32_t)pick((int)b->config.axis_count), slave = n + 1;
    const int frames = some_frames(), number = pick(1000); /* in this order, whatever the compiler's is */
    const double load = uniform(-1, 1);
    switch (pick(18)) {
    case 0: bench_console(b, "power %u off", slave); break;
    case 1:
        bench_console(b, "error %u %04X%s", slave, cm1e_device_errors[(size_t)number % cm1e_device_error_count].code,
                      load > 0.3 ? " hold" : "");
        break;
    case 2: bench_console(b, "over-torque %u", slave); break;
    case 3: bench_console(b, "temperature %u %d", slave, number % 120); break;
    case 4: bench_console(b, "sensor %u %d %s", slave, 1 + number % 4, load > 0 ? "on" : "off"); break;
    case 5: bench_console(b, "load %u %g", slave, 0.1 * load); break;
    case 6: bench_console(b, "load %u %g", slave, 5 * load); break;
    case 7: bench_console(b, "switches %u %02X", slave, number % 256); break;
    case 8: bench_console(b, "lose %d", frames); break;
    case 9: bench_console(b, "corrupt %d", frames); break;
    case 10: bench_console(b, "delay %d %d", frames, 1 + 3 * number); break;
    case 11: bench_console(b, "unplug %u", slave); unplugged[n] = true; break;
    case 12:
        if (load > 0)
            bench_console(b, "power-up-fault %u %d", slave, number % 3);
        bench_console(b, "power-cycle %u %d", slave, 1 + number * 3 / 2);
        break;
    case 13: frames_lost_there = frames; break;
    case 14: frames_lost_back = frames; break;
    case 15: counters_wrong = frames; break;
    case 16: frames_cut = frames; break;
    default: frames_doubled = frames; break;
    }
}

static void heal(bench_t *b)
{
    const uint32_t n = (uint32_t)pick((int)b->config.axis_count), slave = n + 1;
    bench_console(b, "power %u on", slave);
    bench_console(b, "error %u clear", slave);
    bench_console(b, "temperature %u 25", slave);
    bench_console(b, "load %u 0", slave);
    bench_console(b, "sensor %u %d auto", slave, 1 + pick(4));
    bench_console(b, "replug %u", slave);
    unplugged[n] = false;
}

static void program(bench_t *b)
{
    for (uint32_t n = 0; n < b->config.axis_count; n++)
        play_axis(n);
    if (frames_lost_there > 0)
        unheard_until = b->cycle + (int)(INT64_C(200000000) / b->config.cycle_time_ns);
    if (one_in(1500))
        make_fault(b);
    if (one_in(300))
        heal(b);
    if (b->cycle < end_cycle)
        return;
    end_ns = cm1e_clock_now(cm1e_bus_clock(b->bus));
    for (uint32_t n = 0; n < b->config.axis_count; n++)
        heard_at_end[n] = reachable(n);
    cm1e_scheduler_stop(b->scheduler);
}

/* ---- a run ------------------------------------------------------------------------------------------------------- */

static void prepare(unsigned seed)
{
    cm1e_bus_config_free(&bench.config);
    memset(&bench, 0, sizeof bench);
    memset(players, 0, sizeof players);
    memset(unplugged, 0, sizeof unplugged);
    frames_lost_there = frames_lost_back = counters_wrong = frames_cut = frames_doubled = 0;
    unheard_until = -1;
    chance_seed(seed);
    bench_describe(&bench, 1 + (uint32_t)pick(BENCH_AXES));
    bench.config.sim_pdo_order = (cm1e_pdo_order_t)pick(2);
    if (one_in(3)) /* UG 10.1: other cycle times than 1 ms came with V1.3.2 */
        bench.config.cycle_time_ns = cm1e_device_cycle_times_ns[pick(4)];
    for (uint32_t n = 0; n < bench.config.axis_count; n++) {
        bench_random_axis(&bench.config.axes[n], bench.config.cycle_time_ns == 1000000 ? 0 : CM1E_FIRMWARE_1_3_2);
        AXIS_REF_t *axis = &bench.axis[n];
        players[n] = (player_t){
            .power = {.Axis = axis, .EnablePositive = TRUE, .EnableNegative = TRUE}, .second_power = {.Axis = axis},
            .absolute = {.Axis = axis}, .relative = {.Axis = axis}, .velocity = {.Axis = axis}, .halt = {.Axis = axis},
            .stop = {.Axis = axis}, .home = {.Axis = axis}, .reset = {.Axis = axis},
        };
    }
    bench.program = program;
    bench.fault = frame_fault;
    bench.frames_late = true;
    end_cycle = 1000 + pick(2 * CYCLES - 2000);
    snprintf(bench.scene, sizeof bench.scene, "seed %u, %u axes", seed, (unsigned)bench.config.axis_count);
}

/** However it was stopped: no torque, Init, and soon. */
static void judge_end(cm1e_error_t error, const cm1e_diag_t *diag, double took_s)
{
    MUST(&bench, error == CM1E_OK, "at the end: %s", diag->text);
    MUST(&bench, took_s < 6.0, "the stop took %.3f s", took_s);
    for (uint32_t n = 0; n < bench.config.axis_count; n++) {
        const cm1e_sim_cm1e_t *drive = bench_drive(&bench, n);
        /* A slave that comes back after the end was not there to hear it. */
        const bool heard = (heard_at_end[n] && reachable(n)) || drive->firmware->watchdog;
        const uint8_t state = cm1e_sim_slave_al_state(cm1e_sim_segment_slave(bench.segment, n + 1));
        MUST(&bench, !heard || !bench_probe(&bench, n).torque_on, "axis %u: torque after the end", n);
        MUST(&bench, !reachable(n) || !heard_at_end[n] || state <= CM1E_AL_INIT,
             "axis %u: EtherCAT state %u after the end", n, state);
    }
}

START_TEST(test_random_program_with_random_faults)
{
    const unsigned seed = seed_of(_i);
    cm1e_diag_t diag = {0};
    prepare(seed);
    bench_open(&bench);
    bench_start(&bench);
    const cm1e_error_t error = bench_run(&bench, &diag);
    judge_end(error, &diag, (double)(cm1e_clock_now(cm1e_bus_clock(bench.bus)) - end_ns) * 1e-9);
    bench_close(&bench);
    cycles_total += (unsigned long)bench.cycle;
    for (uint32_t n = 0; n < bench.config.axis_count; n++)
        set_points_total += bench.witness[n].set_points;
    printf("seed %u: %u axes, %d cycles, %lu motions, %lu errors, %lu set-points\n", seed,
           (unsigned)bench.config.axis_count, bench.cycle, moves_total, errors_total, set_points_total);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("random programs, random faults");
    TCase *cases = tcase_create("random");
    tcase_set_timeout(cases, 250);
    tcase_add_loop_test(cases, test_random_program_with_random_faults, 0, seed_count(RUNS));
    suite_add_tcase(suite, cases);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int count = srunner_ntests_failed(runner);
    srunner_free(runner);
    return count ? EXIT_FAILURE : EXIT_SUCCESS;
}
