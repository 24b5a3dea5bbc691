/**
 * Process data frames that do not come back, in the middle of every kind of motion: at every phase of it, for 1 ... 150
 * cycles, once or several times shortly one after the other, lost on the way out, on the way back, on both, alternating,
 * or with a wrong working counter, with every `lost_cycles_limit` from the least to the largest. Nobody knows then which
 * target a drive has. The judge is physics and the configuration alone: the largest speed of the simulated shaft against
 * the axis's own maximum velocity, the step of each target that a drive hears against the step it heard before, and the
 * way that a motor goes on. The test prints the largest speed over the limit for each pattern and silence.
 *
 * Every combination is run at moments that lie STRIDE apart, each beginning at another moment. By hand, all moments:
 * CM1E_TEST_STRIDE=1 bin/test_safety_silence.
 */
#include "safety_run.h"

typedef enum pattern {
    LOST_OUT = 0, LOST_BACK, LOST_BOTH, LOST_BY_TURNS, LOST_EVERY_SECOND, LOST_OUT_THEN_BACK, WRONG_COUNTER, PATTERNS
} pattern_t;
static const char *const pattern_names[PATTERNS] = {
    "out", "back", "both", "out and back by turns", "every second", "out, then the first answer", "working counter"};

/** Each reaches the maximum velocity of an axis: of the master, or of the slave. */
typedef enum motion {
    A_MOVE = 0, A_VELOCITY, A_GEAR, A_FAST_GEAR, A_CAM, A_FAST_CAM, A_GROUP, A_SUPERIMPOSED, A_SUPERIMPOSED_ON_GEAR,
    A_TABLE, A_DRIVE_MOVE, MOTIONS
} motion_t;
static const char *const motion_names[MOTIONS] = {
    "MC_MoveAbsolute", "MC_MoveVelocity", "MC_GearIn of a fast master", "MC_GearIn of a fast slave",
    "MC_CamIn of a fast master", "MC_CamIn of a fast slave", "MC_MoveLinearAbsolute", "MC_MoveSuperimposed",
    "MC_MoveSuperimposed on a slave", "MC_PositionProfile", "motion: drive"};

/** So many cycles, so many times, with so many good cycles between. */
typedef struct silence {
    int length, times, gap;
} silence_t;
static const silence_t silences[] = {
    {1, 1, 1},  {2, 1, 1},  {3, 1, 1},  {4, 1, 1},  {5, 1, 1},   {8, 1, 1}, {10, 1, 1},
    {13, 1, 1}, {34, 1, 1}, {49, 1, 1}, {50, 1, 1}, {80, 1, 1},  {150, 1, 1},
    {1, 2, 1},  {1, 3, 3},  {2, 2, 1},  {2, 3, 2},  {2, 3, 7},   {5, 2, 3}, {13, 2, 4}};

typedef struct variant {
    cm1e_mapping_t mapping;
    const char *firmware;
    uint32_t lost_limit; /**< lost_cycles_limit */
    double load_inertia; /**< kg m2; 0: the default */
    bool bridged;        /**< a CM1 behind a bridge */
} variant_t;
static const variant_t variants[] = {
    {CM1E_MAPPING_DYNAMIC, "1.3.5", 3, 0, false},   {CM1E_MAPPING_CSP, "1.3.0", 3, 0, false},
    {CM1E_MAPPING_DYNAMIC, "1.2.0", 3, 0, false},   {CM1E_MAPPING_CSP, "1.3.5", 3, 1.5e-5, false},
    {CM1E_MAPPING_CSV, "1.3.5", 3, 0, false},       {CM1E_MAPPING_CSV, "1.2.0", 3, 0, false},
    {CM1E_MAPPING_DYNAMIC, "", 3, 0, true},         {CM1E_MAPPING_DYNAMIC, "1.3.5", 2, 0, false},
    {CM1E_MAPPING_DYNAMIC, "1.3.5", 10, 0, false},  {CM1E_MAPPING_DYNAMIC, "1.3.5", 50, 0, false},
    {CM1E_MAPPING_CSP, "1.3.5", 50, 1.5e-5, false}, {CM1E_MAPPING_CSV, "1.3.5", 2, 0, false},
    {CM1E_MAPPING_CSV, "1.3.5", 10, 0, false},      {CM1E_MAPPING_CSV, "1.3.5", 50, 0, false},
    {CM1E_MAPPING_DYNAMIC, "", 50, 0, true},
};
enum { SILENCES = sizeof silences / sizeof silences[0], VARIANTS = sizeof variants / sizeof variants[0] };
enum { MASTER = 0, SLAVE, AXES, ENABLED = 260, LAST_PHASE = 500, ADDED_AT = ENABLED + 80 };
enum { STRIDE = 499, SAMPLED_STRIDE = 4999 };
enum { TABLE_POINTS = 13, TABLE_STEP_MS = 50 };

static const double unit = 50000;      /* one revolution */
static const double limit_u = 20;      /* u/s, of every axis: what the motions below use all of */
/* Of the limit: targets are whole counts, and at the limit one cycle is 1000 of them. */
static const double ROUNDING = 0.0005;
/* Counts, where a motor with friction comes to rest; in CSV the position loop has no integral. */
static const double END_TOLERANCE = 75;
/* Of the speed of one step of a target: what the simulated servo makes of it from rest until the next step. */
static const double KICK = 0.4;
static const double acceleration_u = 200, jerk_u = 4000, way_u = 8, added_u = 1.5, WATCHDOG_S = 0.1;

/** What a drive hears, whatever the master knows of it. */
typedef struct heard {
    bool any, enabled;
    int32_t target;
    double step, velocity;
} heard_t;

static bench_t bench;
static motion_t motion;
static pattern_t pattern;
static silence_t silence; /**< length 0: none */
static const variant_t *variant;
static int begin, end_at;
static int bad_cycles, longest_bad; /**< in a row, without an answer that counts */
static MC_Power_t power[AXES];
static MC_MoveAbsolute_t move;
static MC_MoveVelocity_t velocity;
static MC_GearIn_t gear;
static MC_CamTableSelect_t select_cam;
static MC_CamIn_t cam;
static MC_CAM_POINT cam_points[] = {{0, 0, 0, 0}, {8, 0, 0, 0}};
static const MC_CAM_REF cam_table = {.Points = cam_points, .NumberOfPoints = 2};
static MC_AddAxisToGroup_t add[AXES];
static MC_GroupEnable_t enable_group;
static MC_MoveLinearAbsolute_t line;
static AXES_GROUP_REF_t group;
static MC_MoveSuperimposed_t on_top;
static MC_TP_REF points;
static MC_PositionProfile_t profile;
static heard_t heard[AXES];
/** Largest speed over the limit without a fault, which is the servo's own: in this motion, and in MC_MoveVelocity with
 *  all of the acceleration and jerk of the axis. */
static double undisturbed;
static double undisturbed_end[AXES];
static int done_at, undisturbed_done_at; /**< cycles; of the table */
static double on_line[AXES], farthest_off; /**< u; set positions that were on the line; of motors that went on */
static double fastest[AXES], position_at_break[AXES], lag_at_break[AXES], speed_at_break[AXES], rest_at[AXES];
static double table[PATTERNS][SILENCES]; /**< largest speed over the limit */

/* ---- the wire ---------------------------------------------------------------------------------------------------- */

static int period(void) { return silence.length + silence.gap; }

/** Cycles since the last silence began; -1: there was none yet, or the gap after the last one is over too. */
static int since_beginning(void)
{
    const int since = bench.cycle - begin;
    return since >= 0 && since < silence.times * period() ? since % period() : -1;
}

static bool broken(void) { return since_beginning() >= 0 && since_beginning() < silence.length; }

static bool is_lost(bool out)
{
    switch (pattern) {
    case LOST_OUT: return broken() && out;
    case LOST_BACK: return broken() && !out;
    case LOST_BOTH: return broken();
    case LOST_BY_TURNS: return broken() && out == (bench.cycle % 2 == 0);
    case LOST_EVERY_SECOND: return broken() && !out && bench.cycle % 2 == 0;
    case LOST_OUT_THEN_BACK: return (broken() && out) || (since_beginning() == silence.length && !out);
    default: return false;
    }
}

/** A drive that takes targets never hears a larger step than the one before it and what its limits add to that. */
static void hear(uint32_t n, const uint8_t *data)
{
    const witness_t *w = &bench.witness[n];
    heard_t *h = &heard[n];
    const bool enabled = (word_at(data, w->out_controlword) & 0x0F) == 0x0F && takes_targets(w);
    if (w->out_position >= 0) {
        const int32_t target = long_at(data, w->out_position);
        const double step = h->any ? (double)(int32_t)((uint32_t)target - (uint32_t)h->target) : 0;
        if (enabled && h->enabled && motion != A_DRIVE_MOVE) {
            MUST(&bench, fabs(step) <= w->max_step + 1, "axis %u: hears a step of %.0f counts, limit %.1f", n, step,
                 w->max_step);
            MUST(&bench, fabs(step) <= fmax(fabs(h->step), fabs(w->step)) + fmax(w->max_gain, w->max_loss) + 2,
                 "axis %u: hears a step of %.0f counts after one of %.0f", n, step, h->step);
        }
        h->step = fmax(fabs(step), fabs(h->step) - w->max_loss); /* where it was held, as fast again is no faster */
        h->target = target;
    }
    if (w->out_velocity >= 0) {
        const double v = long_at(data, w->out_velocity) * w->velocity_unit;
        MUST(&bench, fabs(v) <= limit_u * unit + w->velocity_unit, "axis %u: hears %.0f counts/s", n, v);
        h->velocity = v;
    }
    h->any = true;
    h->enabled = enabled;
}

static cm1e_tap_verdict_t lose(bench_t *b, cm1e_tap_frame_t *frame)
{
    const bool out = frame->direction == CM1E_TAP_SENT;
    if (is_lost(out))
        return CM1E_TAP_DROP;
    for (uint32_t n = 0; out && n < b->config.axis_count; n++)
        hear(n, frame->bytes + LRW_DATA);
    if (pattern == WRONG_COUNTER && broken() && !out)
        cm1e_frame_change_working_counter(frame->bytes, frame->length, 0, -1);
    return CM1E_TAP_PASS;
}

static bool by_gear(void) { return motion == A_GEAR || motion == A_FAST_GEAR || motion == A_SUPERIMPOSED_ON_GEAR; }
static bool by_cam(void) { return motion == A_CAM || motion == A_FAST_CAM; }
static bool superimposes(void) { return motion == A_SUPERIMPOSED || motion == A_SUPERIMPOSED_ON_GEAR; }

/* ---- the program ------------------------------------------------------------------------------------------------- */

static void begin_motion(void)
{
    move.Execute = motion == A_MOVE || by_cam() || motion == A_SUPERIMPOSED || motion == A_DRIVE_MOVE;
    velocity.Execute = motion == A_VELOCITY || by_gear();
    line.Execute = motion == A_GROUP;
    profile.Execute = motion == A_TABLE;
}

static void call_blocks(void)
{
    MC_MoveAbsolute(&move);
    MC_MoveVelocity(&velocity);
    if (by_gear())
        MC_GearIn(&gear);
    if (by_cam()) {
        MC_CamTableSelect(&select_cam);
        cam.CamTableID = select_cam.CamTableID;
        MC_CamIn(&cam);
    }
    if (superimposes())
        MC_MoveSuperimposed(&on_top);
    if (motion == A_TABLE)
        MC_PositionProfile(&profile);
    if (motion != A_GROUP)
        return;
    for (int n = 0; n < AXES; n++)
        MC_AddAxisToGroup(&add[n]);
    MC_GroupEnable(&enable_group);
    MC_MoveLinearAbsolute(&line);
}

static void prepare_followers(void)
{
    for (int n = 0; n < AXES; n++)
        add[n].Execute = bench.cycle > ENABLED - 40;
    enable_group.Execute = bench.cycle > ENABLED - 30;
    gear.Execute = cam.Execute = bench.cycle > ENABLED - 20;
    select_cam.Execute = bench.cycle > ENABLED - 40;
    on_top.Execute = bench.cycle >= ADDED_AT;
}

static void watch(uint32_t n)
{
    const cm1e_sim_probe_t probe = bench_probe(&bench, n);
    if (bench.cycle < begin || (bench.answered && bench_info(&bench, n).state != CM1E_AXIS_ERROR_STOP)) {
        position_at_break[n] = probe.position_counts;
        speed_at_break[n] = fabs(probe.velocity_counts_per_s);
        lag_at_break[n] = fabs(bench_info(&bench, n).set_position * unit - probe.position_counts);
    }
    fastest[n] = fmax(fastest[n], fabs(probe.peak_velocity_counts_per_s));
    if (bench.cycle == end_at - 200)
        rest_at[n] = probe.position_counts;
}

/** Counts. A motor goes on while frames are ridden out. Then its target is held, and it goes as far as its torque needs
 *  to stop it; or it is ramped down; or it hears nothing until its watchdog trips, and without torque friction stops it. */
static double allowed_way(uint32_t n)
{
    const cm1e_sim_bridge_axis_t *motor = variant->bridged ? bench_motor(&bench, n) : NULL;
    const cm1e_mechanics_t *m = motor ? &motor->mechanics : &bench_drive(&bench, n)->mechanics;
    const double torque = motor ? motor->servo.torque_limit : bench_drive(&bench, n)->servo.torque_limit;
    const double silence_s = silence.times * period() * 1e-3, before = speed_at_break[n];
    const bool holds = bench.witness[n].out_position >= 0 && motion != A_DRIVE_MOVE;
    const bool has_watchdog = strcmp(bench.config.axes[n].firmware, "1.2.0") != 0;
    const double unheard_s = has_watchdog ? fmin(silence_s, WATCHDOG_S) : silence_s;
    /* Unheard, a profile of the drive goes on with its acceleration. */
    const double v = holds ? before : fmin(limit_u * unit, before + acceleration_u * unit * (unheard_s + 0.005));
    /* The axes of a group brake in the same time, that of the fastest. */
    const double fastest_v = motion == A_GROUP ? fmax(v, fmax(speed_at_break[MASTER], speed_at_break[SLAVE])) : v;
    const double ramp_s = fastest_v / (acceleration_u * unit), same = 1000;
    const double by_torque = v * v / (2 * torque * m->gain), by_friction = v * v / (2 * m->friction * m->gain);
    /* A target stands from the first missing answer on: the motor has its lag to go, and the step of one frame, whatever
     * lost_cycles_limit is. If that frame is heard at last by a motor that stands, and the next one takes the torque
     * away, the motor coasts with the part KICK of the speed of that step. */
    if (holds)
        return lag_at_break[n] + v * 1e-3 + by_torque + KICK * KICK * by_friction + same;
    /* A velocity goes on until the bus counts as lost: the frame of the last answer, the cycles of the limit, one whose
     * frame is heard although its answer is not, and the one in which the ramp is sent. The halt of a drive's own
     * profile takes one more, as measured. */
    const double ridden_out = v * (variant->lost_limit + (motion == A_DRIVE_MOVE ? 4 : 3)) * 1e-3;
    const bool runs_out = silence_s >= ramp_s || (has_watchdog && silence_s >= WATCHDOG_S);
    return 1.2 * (ridden_out + v * unheard_s + (runs_out ? by_friction : v * ramp_s / 2)) + same;
}

/** A table that goes on is late by the cycles that were lost, and by the way back to its full pace (SAFETY.md). */
static void judge_end_of_table(void)
{
    const double slow_s = 0.08 * (limit_u / acceleration_u + acceleration_u / jerk_u + sqrt(limit_u / jerk_u));
    const double most = silence.times * (silence.length + 1) * (1 + slow_s * 1e3) + 1;
    MUST(&bench, done_at > 0 && done_at - undisturbed_done_at <= most,
         "the table is done %d cycles late, up to %.0f are right", done_at - undisturbed_done_at, most);
}

/** Whether a motor may have gone on so far that its set-point goes after it where the path begins again from rest. */
static bool may_leave_line(void)
{
    const bool several = silence.times > 1 || pattern == LOST_EVERY_SECOND;
    return several || (variant->load_inertia > 0 && longest_bad > CM1E_AXIS_RIDDEN_OUT_CYCLES);
}

/** Along its line, as long as both axes are led. A set-point that goes after its motor, which is a cycle behind it, leaves
 *  the line no farther than the motor has gone on from there, and comes back. */
static void watch_line(void)
{
    const cm1e_axis_info_t x = bench_info(&bench, MASTER), y = bench_info(&bench, SLAVE);
    if (x.state != CM1E_AXIS_SYNCHRONIZED_MOTION || y.state != CM1E_AXIS_SYNCHRONIZED_MOTION)
        return;
    const double off = fabs(y.set_position + x.set_position / 2);
    const double x_on = bench_probe(&bench, MASTER).position_counts / unit - on_line[MASTER];
    const double y_on = bench_probe(&bench, SLAVE).position_counts / unit - on_line[SLAVE];
    if (off < 1e-9) {
        on_line[MASTER] = x.set_position;
        on_line[SLAVE] = y.set_position;
        farthest_off = 0;
        return;
    }
    farthest_off = fmax(farthest_off, fabs(x_on) / 2 + fabs(y_on) + limit_u * 1e-3);
    MUST(&bench, may_leave_line() && off < farthest_off, "off the line: %.9f, %.9f; motors up to %.9f", x.set_position,
         y.set_position, farthest_off);
}

static void judge_rest(uint32_t n)
{
    const cm1e_sim_probe_t probe = bench_probe(&bench, n);
    MUST(&bench, !probe.torque_on, "axis %u: torque in ErrorStop", n);
    MUST(&bench, fabs(probe.position_counts - rest_at[n]) < 1, "axis %u: moves by %.1f counts after it", n,
         probe.position_counts - rest_at[n]);
}

static void judge_error(uint32_t n)
{
    const double way = fabs(bench_probe(&bench, n).position_counts - position_at_break[n]);
    MUST(&bench, way <= allowed_way(n), "axis %u: goes on for %.0f counts, %.0f are explained", n, way, allowed_way(n));
    judge_rest(n);
}

/** Without an error a motion ends where it does undisturbed. What is superimposed may be aborted, a table may end. */
static void judge_end(uint32_t n)
{
    const cm1e_axis_info_t info = bench_info(&bench, n);
    if (motion == A_VELOCITY || by_gear())
        return;
    if (motion == A_TABLE && profile.Error) {
        MUST(&bench, longest_bad > 0 && profile.ErrorID == 0x1E65, "the table ends with %X", profile.ErrorID);
        return;
    }
    if (motion == A_TABLE)
        judge_end_of_table();
    const double left = motion == A_SUPERIMPOSED && on_top.CommandAborted ? added_u - on_top.CoveredDistance : 0;
    MUST(&bench, fabs(info.actual_position - undisturbed_end[n] + left) < END_TOLERANCE / unit,
         "axis %u: ends at %.5f, undisturbed at %.5f, with %.5f left to add", n, info.actual_position,
         undisturbed_end[n], left);
}

static void judge(uint32_t n)
{
    const cm1e_axis_info_t info = bench_info(&bench, n);
    char text[CM1E_AXIS_ERROR_TEXT_BYTES];
    const double ratio = fastest[n] / (limit_u * unit);
    if (silence.length == 0) {
        undisturbed = fmax(undisturbed, ratio);
        undisturbed_end[n] = info.actual_position;
        undisturbed_done_at = done_at;
        MUST(&bench, ratio > 0.3 && ratio < 1.005, "axis %u: undisturbed it has %.3f of its maximum velocity",
             n, ratio);
        return;
    }
    int column = 0;
    while (memcmp(&silences[column], &silence, sizeof silence) != 0)
        column++;
    table[pattern][column] = fmax(table[pattern][column], ratio);
    MUST(&bench, ratio <= fmax(1, undisturbed) + ROUNDING, "axis %u: %.0f counts/s, limit %.0f; undisturbed %.3f "
         "of it", n, fastest[n], limit_u * unit, undisturbed);
    cm1e_axis_error_text(bench.axis[n], text, sizeof text);
    /* Motors that ran on by themselves are off their path. */
    const bool off_path = motion == A_GROUP && bench.witness[n].out_position < 0 &&
                          longest_bad > CM1E_AXIS_RIDDEN_OUT_CYCLES;
    /* A cam that needs all of the slave's velocity leaves nothing to catch up with. */
    const bool no_room = motion == A_FAST_CAM && n == SLAVE;
    if (off_path && info.error == CM1E_ERROR_AXIS_COUPLING_LIMIT) {
        judge_error(n);
        return;
    }
    if (no_room && info.error == CM1E_ERROR_AXIS_COUPLING_LIMIT) {
        judge_rest(n);
        return;
    }
    MUST(&bench, (longest_bad >= (int)variant->lost_limit) == (info.state == CM1E_AXIS_ERROR_STOP),
         "axis %u: %s after %d cycles in a row without an answer. %s", n, cm1e_axis_state_name(info.state), longest_bad,
         text);
    if (info.state == CM1E_AXIS_ERROR_STOP)
        judge_error(n);
    else
        judge_end(n);
}

static void program(bench_t *b)
{
    bad_cycles = b->answered || b->cycle < begin ? 0 : bad_cycles + 1;
    longest_bad = bad_cycles > longest_bad ? bad_cycles : longest_bad;
    for (uint32_t n = 0; n < b->config.axis_count; n++) {
        power[n].Enable = TRUE;
        MC_Power(&power[n]);
        MUST(b, b->cycle != ENABLED || power[n].Status, "axis %u has no torque yet", n);
        watch(n);
    }
    prepare_followers();
    if (b->cycle == ENABLED)
        begin_motion();
    call_blocks();
    if (motion == A_GROUP)
        watch_line();
    done_at = done_at == 0 && profile.Done ? b->cycle : done_at;
    if (b->cycle != end_at)
        return;
    for (uint32_t n = 0; n < b->config.axis_count; n++)
        judge(n);
    cm1e_scheduler_stop(b->scheduler);
}

/* ---- runs -------------------------------------------------------------------------------------------------------- */

static void describe(void)
{
    const uint32_t axes = by_gear() || by_cam() || motion == A_GROUP ? 2 : 1;
    bench_free_axes(&bench, axes, motion == A_DRIVE_MOVE ? CM1E_MAPPING_PROFILE : variant->mapping, variant->firmware);
    /* More jerk, and the simulated servo overshoots the maximum by itself. */
    bench_limit_axes(&bench, unit, limit_u, acceleration_u, jerk_u);
    bench.config.lost_cycles_limit = variant->lost_limit;
    for (uint32_t n = 0; n < axes; n++) {
        cm1e_axis_config_t *axis = &bench.config.axes[n];
        axis->motion = motion == A_DRIVE_MOVE ? CM1E_MOTION_DRIVE : CM1E_MOTION_HOST;
        axis->table_profiles = motion == A_TABLE;
        axis->sim.load_inertia = variant->load_inertia;
        if (!variant->bridged)
            continue;
        axis->address = 1;
        axis->channel = (uint8_t)(n + 1);
        axis->k37 = 10;
        axis->k37_stated = true;
        strcpy(axis->motor, "CM1");
    }
    bench.program = program;
    bench.fault = lose;
}

static void make_points(void)
{
    const int last = TABLE_POINTS - 1;
    points = (MC_TP_REF){.NumberOfPairs = TABLE_POINTS};
    for (int i = 0; i <= last; i++)
        points.MC_TP_Array[i] = (MC_TP){
            .DeltaTime = i ? TABLE_STEP_MS * INT64_C(1000000) : 0,
            .Position = 0.75 * way_u * ((double)i / last - sin(2 * M_PI * i / last) / (2 * M_PI)),
        };
}

static void make_blocks(void)
{
    AXIS_REF_t *first = &bench.axis[MASTER], *second = &bench.axis[SLAVE];
    const bool shares = motion == A_SUPERIMPOSED;
    /* Of the limit: the velocity of the first axis, and what a slave does of it. */
    const bool fast_slave = motion == A_FAST_GEAR || motion == A_FAST_CAM || motion == A_SUPERIMPOSED_ON_GEAR;
    const double master = shares ? 0.6 : fast_slave ? 0.5 : 1;
    const int tenths = motion == A_FAST_GEAR ? -20 : motion == A_SUPERIMPOSED_ON_GEAR ? -12 : -9;
    for (int n = 0; n < AXES; n++) {
        power[n] = (MC_Power_t){.Axis = &bench.axis[n], .EnablePositive = TRUE, .EnableNegative = TRUE};
        add[n] = (MC_AddAxisToGroup_t){.AxesGroup = &group, .Axis = &bench.axis[n],
                                       .IdentInGroup = (MC_IDENT_IN_GROUP)(n + 1)};
        heard[n] = (heard_t){0};
        fastest[n] = speed_at_break[n] = 0;
    }
    /* The slave of a fast cam has to follow its master's acceleration where the cam is steep too. */
    const bool steep = motion == A_FAST_CAM;
    move = (MC_MoveAbsolute_t){.Axis = first, .Position = shares ? 0.6 * way_u : steep ? 0.8 * way_u : way_u,
                               .Velocity = master * limit_u,
                               .Acceleration = (shares ? 0.5 : steep ? 0.25 : 0.75) * acceleration_u,
                               .Jerk = motion == A_DRIVE_MOVE ? 0 : steep ? 600 : 2000};
    velocity = (MC_MoveVelocity_t){.Axis = first, .Velocity = master * limit_u,
                                   .Acceleration = by_gear() ? 0.4 * acceleration_u : 0,
                                   .Jerk = by_gear() ? 1000 : 0};
    gear = (MC_GearIn_t){.Master = first, .Slave = second, .RatioNumerator = (DINT)tenths, .RatioDenominator = 10};
    cam_points[1] = steep ? (MC_CAM_POINT){.Master = 0.8 * way_u, .Slave = 0.8 * way_u / 0.9375}
                          : (MC_CAM_POINT){.Master = way_u, .Slave = 1.5};
    select_cam = (MC_CamTableSelect_t){.Master = first, .Slave = second, .CamTable = &cam_table};
    cam = (MC_CamIn_t){.Master = first, .Slave = second};
    enable_group = (MC_GroupEnable_t){.AxesGroup = &group};
    line = (MC_MoveLinearAbsolute_t){.AxesGroup = &group, .Position = {way_u, -0.5 * way_u},
                                        .Velocity = 2 * limit_u}; /* as fast as the first axis can */
    on_top = (MC_MoveSuperimposed_t){.Axis = shares ? first : second, .Distance = shares ? added_u : -added_u,
                                     .VelocityDiff = 0.4 * limit_u};
    profile = (MC_PositionProfile_t){.Axis = first, .TimePosition = &points};
}

static void make_group(bench_t *b)
{
    cm1e_diag_t diag = {0};
    MUST(b, cm1e_group_create(&group, NULL, &diag) == CM1E_OK, "%s", diag.text);
}

static void run(void)
{
    describe();
    snprintf(bench.scene, sizeof bench.scene,
             "%s%s, mapping %d, firmware %s, limit %u, lost: %s, %d cycles from %d, %d times with %d between",
             variant->load_inertia > 0 ? "heavy load, " : variant->bridged ? "behind a bridge, " : "",
             motion_names[motion], (int)bench.config.axes[0].mapping, variant->firmware, (unsigned)variant->lost_limit,
             pattern_names[pattern], silence.length, begin - ENABLED, silence.times, silence.gap);
    bad_cycles = longest_bad = done_at = 0;
    end_at = begin + silence.times * period() + (motion == A_FAST_CAM || motion == A_GROUP ? 1100 : 700);
    make_blocks();
    bench.started = motion == A_GROUP ? make_group : NULL;
    bench_play(&bench);
    const bool must_lose = silence.length > 1 || (silence.length == 1 && pattern != LOST_EVERY_SECOND);
    MUST(&bench, longest_bad > 0 || !must_lose, "no answer was missing");
    if (motion == A_GROUP)
        (void)cm1e_group_destroy(group);
}

static double run_alone(motion_t alone)
{
    motion = alone;
    silence = (silence_t){0, 1, 1};
    begin = ENABLED + LAST_PHASE;
    undisturbed = 0;
    run();
    MUST(&bench, undisturbed > 0.997, "undisturbed it has %.4f of the maximum velocity only", undisturbed);
    return undisturbed;
}

/** The drive's own motion has another servo, in a way: its profile is known exactly. */
static void run_undisturbed(void)
{
    const motion_t asked = motion;
    const double steepest = asked == A_DRIVE_MOVE ? 0 : run_alone(A_VELOCITY);
    undisturbed = fmax(run_alone(asked), steepest);
}

static void print_table(void)
{
    printf("%s: largest speed over the axis's maximum velocity\n", motion_names[motion]);
    printf("  %-28s", "cycles, times / between");
    for (int l = 0; l < SILENCES; l++) {
        char name[16];
        snprintf(name, sizeof name, silences[l].times > 1 ? "%dx%d/%d" : "%d", silences[l].length, silences[l].times,
                 silences[l].gap);
        printf("%7s", name);
    }
    for (int p = 0; p < PATTERNS; p++) {
        printf("\n  %-28s", pattern_names[p]);
        for (int l = 0; l < SILENCES; l++)
            printf("%7.3f", table[p][l]);
    }
    printf("\n");
}

/** The drive's own motion needs another mapping, and there is none behind a bridge. */
static bool is_possible(void)
{
    return motion != A_DRIVE_MOVE ||
           (variant->mapping == CM1E_MAPPING_DYNAMIC && variant->load_inertia == 0 && !variant->bridged);
}

START_TEST(test_no_frame_that_is_heard_again_makes_a_motor_leap)
{
    int moment = 0;
    const int stride = sweep_stride(STRIDE, SAMPLED_STRIDE);
    motion = (motion_t)_i;
    memset(table, 0, sizeof table);
    make_points();
    for (variant = variants; variant < variants + VARIANTS; variant++) {
        if (!is_possible())
            continue;
        run_undisturbed();
        for (int p = 0; p < PATTERNS; p++)
            for (int l = 0; l < SILENCES; l++, moment++)
                for (begin = ENABLED + 1 + moment * 7 % stride; begin < ENABLED + LAST_PHASE; begin += stride) {
                    pattern = (pattern_t)p;
                    silence = silences[l];
                    run();
                }
    }
    print_table();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("frames that do not come back");
    for (int m = 0; m < MOTIONS; m++)
        bench_add(suite, motion_names[m], 250, test_no_frame_that_is_heard_again_makes_a_motor_leap, m, m + 1);
    return bench_run_suite(suite);
}
