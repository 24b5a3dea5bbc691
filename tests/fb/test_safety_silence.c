/**
 * Process data frames that do not come back, in the middle of every kind of motion: at every phase of it, for 1 ... 150
 * cycles, lost on the way out, on the way back, on both, alternating, or with a wrong working counter. Nobody knows then
 * which target a drive has. The judge is physics and the configuration alone: the largest speed of the simulated shaft
 * against the axis's own maximum velocity, the step of each target that a drive hears against the step it heard before,
 * and the way that a motor goes on. The test prints the largest speed over the limit for each pattern and length.
 */
#include "safety_bench.h"

typedef enum pattern {
    LOST_OUT = 0, LOST_BACK, LOST_BOTH, LOST_BY_TURNS, LOST_EVERY_SECOND, LOST_OUT_THEN_BACK, WRONG_COUNTER, PATTERNS
} pattern_t;
static const char *const pattern_names[PATTERNS] = {
    "out", "back", "both", "out and back by turns", "every second", "out, then the first answer", "working counter"};

typedef enum motion { A_MOVE = 0, A_VELOCITY, A_GEAR, A_CAM, A_GROUP, A_DRIVE_MOVE, MOTIONS } motion_t;
static const char *const motion_names[MOTIONS] = {"MC_MoveAbsolute", "MC_MoveVelocity", "MC_GearIn", "MC_CamIn",
                                                  "MC_MoveLinearAbsolute", "motion: drive"};

static const int lengths[] = {1, 2, 3, 4, 5, 8, 13, 34, 80, 150};
enum { LENGTHS = sizeof lengths / sizeof lengths[0] };
enum { MASTER = 0, SLAVE, AXES, ENABLED = 260, LAST_PHASE = 500, LOST_LIMIT = 3 };

static const double unit = 50000;      /* one revolution */
static const double limit_u = 20;      /* u/s, of every axis: what the motions below use all of */
/* Of the limit: the simulated servo's own, when its target reaches the limit. Its profiles have 0.012 undisturbed. */
static const double SERVO_OVERSHOOT = 0.014;
/* Counts, where a motor with friction comes to rest; in CSV the position loop has no integral. */
static const double END_TOLERANCE = 75;
static const double acceleration_u = 200, way_u = 8, WATCHDOG_S = 0.1;

/** What a drive hears, whatever the master knows of it. */
typedef struct heard {
    bool any, enabled;
    int32_t target;
    double step, velocity;
} heard_t;

static bench_t bench;
static motion_t motion;
static pattern_t pattern;
static int length, begin, lost_frames, end_at;
static MC_Power_t power[AXES];
static MC_MoveAbsolute_t move;
static MC_MoveVelocity_t velocity;
static MC_GearIn_t gear;
static MC_CamTableSelect_t select_cam;
static MC_CamIn_t cam;
static const MC_CAM_POINT cam_points[] = {{0, 0, 0, 0}, {8, 1.5, 0, 0}};
static const MC_CAM_REF cam_table = {.Points = cam_points, .NumberOfPoints = 2};
static MC_AddAxisToGroup_t add[AXES];
static MC_GroupEnable_t enable_group;
static MC_MoveLinearAbsolute_t line;
static AXES_GROUP_REF_t group;
static heard_t heard[AXES];
static double undisturbed; /**< largest speed over the limit in the same motion without a fault */
static double undisturbed_end;
static double fastest[AXES], position_at_break[AXES], speed_at_break[AXES], rest_at[AXES];
static double table[PATTERNS][LENGTHS]; /**< largest speed over the limit */

/* ---- the wire ---------------------------------------------------------------------------------------------------- */

static bool broken(void) { return bench.cycle >= begin && bench.cycle < begin + length; }

static bool is_lost(bool out)
{
    switch (pattern) {
    case LOST_OUT: return broken() && out;
    case LOST_BACK: return broken() && !out;
    case LOST_BOTH: return broken();
    case LOST_BY_TURNS: return broken() && out == (bench.cycle % 2 == 0);
    case LOST_EVERY_SECOND: return broken() && !out && bench.cycle % 2 == 0;
    case LOST_OUT_THEN_BACK: return (broken() && out) || (bench.cycle == begin + length && !out);
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
    if (is_lost(out)) {
        lost_frames++;
        return CM1E_TAP_DROP;
    }
    for (uint32_t n = 0; out && n < b->config.axis_count; n++)
        hear(n, frame->bytes + LRW_DATA);
    if (pattern == WRONG_COUNTER && broken() && !out)
        cm1e_frame_change_working_counter(frame->bytes, frame->length, 0, -1);
    return CM1E_TAP_PASS;
}

/* ---- the program ------------------------------------------------------------------------------------------------- */

static void begin_motion(void)
{
    move.Execute = motion == A_MOVE || motion == A_CAM || motion == A_DRIVE_MOVE;
    velocity.Execute = motion == A_VELOCITY || motion == A_GEAR;
    line.Execute = motion == A_GROUP;
}

static void call_blocks(void)
{
    MC_MoveAbsolute(&move);
    MC_MoveVelocity(&velocity);
    if (motion == A_GEAR)
        MC_GearIn(&gear);
    if (motion == A_CAM) {
        MC_CamTableSelect(&select_cam);
        cam.CamTableID = select_cam.CamTableID;
        MC_CamIn(&cam);
    }
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
}

static void watch(uint32_t n)
{
    const cm1e_sim_probe_t probe = bench_probe(&bench, n);
    if (bench.cycle == begin) {
        position_at_break[n] = probe.position_counts;
        speed_at_break[n] = fabs(probe.velocity_counts_per_s);
    }
    fastest[n] = fmax(fastest[n], fabs(probe.peak_velocity_counts_per_s));
    if (bench.cycle == end_at - 200)
        rest_at[n] = probe.position_counts;
}

/** Counts. A motor goes on while frames are ridden out. Then its target is held, and it goes as far as its torque needs
 *  to stop it; or it is ramped down; or it hears nothing until its watchdog trips, and without torque friction stops it. */
static double allowed_way(uint32_t n)
{
    const cm1e_mechanics_t *m = &bench_drive(&bench, n)->mechanics;
    const double silence_s = length * 1e-3, before = speed_at_break[n];
    const bool holds = bench.witness[n].out_position >= 0 && motion != A_DRIVE_MOVE;
    const bool has_watchdog = strcmp(bench.config.axes[n].firmware, "1.2.0") != 0;
    const double unheard_s = has_watchdog ? fmin(silence_s, WATCHDOG_S) : silence_s;
    /* Unheard, a profile of the drive goes on with its acceleration. */
    const double v = holds ? before : fmin(limit_u * unit, before + acceleration_u * unit * (unheard_s + 0.005));
    const double ramp_s = v / (acceleration_u * unit), ridden_out = v * (LOST_LIMIT + 2) * 1e-3, same = 1000;
    const double by_torque = v * v / (2 * bench_drive(&bench, n)->servo.torque_limit * m->gain);
    const double by_friction = v * v / (2 * m->friction * m->gain);
    if (holds)
        return ridden_out + by_torque + same;
    const bool runs_out = silence_s >= ramp_s || (has_watchdog && silence_s >= WATCHDOG_S);
    return 1.2 * (ridden_out + v * unheard_s + (runs_out ? by_friction : v * ramp_s / 2)) + same;
}

static void judge(uint32_t n)
{
    const cm1e_sim_probe_t probe = bench_probe(&bench, n);
    const cm1e_axis_info_t info = bench_info(&bench, n);
    char text[CM1E_AXIS_ERROR_TEXT_BYTES];
    const double ratio = fastest[n] / (limit_u * unit);
    if (length == 0) {
        undisturbed = fmax(undisturbed, ratio);
        undisturbed_end = n == MASTER ? info.actual_position : undisturbed_end;
        MUST(&bench, ratio > 0.3 && ratio < 1.02, "axis %u: undisturbed it has %.3f of its maximum velocity",
             n, ratio);
        return;
    }
    int row = 0;
    while (lengths[row] != length)
        row++;
    table[pattern][row] = fmax(table[pattern][row], ratio);
    MUST(&bench, ratio <= fmax(1, undisturbed) + SERVO_OVERSHOOT, "axis %u: %.0f counts/s, limit %.0f; undisturbed %.3f "
         "of it", n, fastest[n], limit_u * unit, undisturbed);
    const bool must_fail = length >= LOST_LIMIT && pattern != LOST_EVERY_SECOND;
    if (must_fail)
        MUST(&bench, info.state == CM1E_AXIS_ERROR_STOP, "axis %u: %s", n, cm1e_axis_state_name(info.state));
    if (info.state == CM1E_AXIS_ERROR_STOP) {
        const double way = fabs(probe.position_counts - position_at_break[n]);
        cm1e_axis_error_text(bench.axis[n], text, sizeof text);
        MUST(&bench, length >= LOST_LIMIT || pattern == LOST_OUT_THEN_BACK, "axis %u: %s", n, text);
        MUST(&bench, way <= allowed_way(n), "axis %u: goes on for %.0f counts, %.0f are explained", n, way,
             allowed_way(n));
        MUST(&bench, !probe.torque_on, "axis %u: torque in ErrorStop", n);
        MUST(&bench, fabs(probe.position_counts - rest_at[n]) < 1, "axis %u: moves by %.1f counts after it", n,
             probe.position_counts - rest_at[n]);
    } else if (n == MASTER && motion != A_VELOCITY && motion != A_GEAR) {
        MUST(&bench, fabs(info.actual_position - undisturbed_end) < END_TOLERANCE / unit, "axis %u: ends at %.5f, undisturbed at "
             "%.5f", n, info.actual_position, undisturbed_end);
    }
}

static void program(bench_t *b)
{
    for (uint32_t n = 0; n < b->config.axis_count; n++) {
        power[n].Enable = TRUE;
        MC_Power(&power[n]);
        watch(n);
    }
    prepare_followers();
    if (b->cycle == ENABLED)
        begin_motion();
    call_blocks();
    if (b->cycle != end_at)
        return;
    for (uint32_t n = 0; n < b->config.axis_count; n++)
        judge(n);
    cm1e_scheduler_stop(b->scheduler);
}

/* ---- runs -------------------------------------------------------------------------------------------------------- */

typedef struct variant {
    cm1e_mapping_t mapping;
    const char *firmware;
    double load_inertia; /**< kg m2; 0: the default */
} variant_t;

static void describe(const variant_t *variant)
{
    memset(&bench, 0, sizeof bench);
    bench_describe(&bench, motion == A_GEAR || motion == A_CAM || motion == A_GROUP ? 2 : 1);
    for (uint32_t n = 0; n < bench.config.axis_count; n++) {
        cm1e_axis_config_t *axis = &bench.config.axes[n];
        axis->mapping = motion == A_DRIVE_MOVE ? CM1E_MAPPING_PROFILE : variant->mapping;
        axis->motion = motion == A_DRIVE_MOVE ? CM1E_MOTION_DRIVE : CM1E_MOTION_HOST;
        axis->counts_per_unit = unit;
        axis->max_velocity = limit_u;
        axis->max_acceleration = axis->max_deceleration = acceleration_u;
        axis->max_jerk = 4000; /* more, and the simulated servo overshoots the maximum by itself */
        axis->sim.no_stops = true;
        axis->sim.load_inertia = variant->load_inertia;
        axis->homing = (cm1e_homing_config_t){0};
        snprintf(axis->firmware, sizeof axis->firmware, "%s", variant->firmware);
    }
    bench.program = program;
    bench.fault = lose;
}

static void make_blocks(void)
{
    AXIS_REF_t *first = &bench.axis[MASTER], *second = &bench.axis[SLAVE];
    for (int n = 0; n < AXES; n++) {
        power[n] = (MC_Power_t){.Axis = &bench.axis[n], .EnablePositive = TRUE, .EnableNegative = TRUE};
        add[n] = (MC_AddAxisToGroup_t){.AxesGroup = &group, .Axis = &bench.axis[n], .IdentInGroup = (MC_IDENT_IN_GROUP)(n + 1)};
        heard[n] = (heard_t){0};
        fastest[n] = speed_at_break[n] = 0;
    }
    move = (MC_MoveAbsolute_t){.Axis = first, .Position = way_u, .Velocity = limit_u,
                             .Acceleration = 0.75 * acceleration_u, .Jerk = motion == A_DRIVE_MOVE ? 0 : 2000};
    velocity = (MC_MoveVelocity_t){.Axis = first, .Velocity = motion == A_GEAR ? 0.5 * limit_u : limit_u,
                                   .Acceleration = motion == A_GEAR ? 0.4 * acceleration_u : 0, .Jerk = 1000};
    gear = (MC_GearIn_t){.Master = first, .Slave = second, .RatioNumerator = -19, .RatioDenominator = 10};
    select_cam = (MC_CamTableSelect_t){.Master = first, .Slave = second, .CamTable = &cam_table};
    cam = (MC_CamIn_t){.Master = first, .Slave = second};
    enable_group = (MC_GroupEnable_t){.AxesGroup = &group};
    line = (MC_MoveLinearAbsolute_t){.AxesGroup = &group, .Position = {way_u, -0.5 * way_u}, .Velocity = limit_u};
}

static void run(const variant_t *variant)
{
    cm1e_diag_t diag = {0};
    describe(variant);
    snprintf(bench.scene, sizeof bench.scene, "%s%s, mapping %d, firmware %s, lost: %s, %d cycles from %d",
             variant->load_inertia > 0 ? "heavy load, " : "", motion_names[motion], (int)bench.config.axes[0].mapping, variant->firmware, pattern_names[pattern],
             length, begin - ENABLED);
    lost_frames = 0;
    end_at = begin + length + 700;
    make_blocks();
    bench_open(&bench);
    bench_start(&bench);
    if (motion == A_GROUP)
        MUST(&bench, cm1e_group_create(&group, NULL, &diag) == CM1E_OK, "%s", diag.text);
    const cm1e_error_t error = bench_run(&bench, &diag);
    MUST(&bench, error == CM1E_OK, "%s", diag.text);
    MUST(&bench, lost_frames > 0 || length == 0 || pattern == WRONG_COUNTER || (pattern == LOST_EVERY_SECOND && length == 1),
         "no frame was lost");
    bench_close(&bench);
    if (motion == A_GROUP)
        (void)cm1e_group_destroy(group);
}

static const variant_t variants[] = {
    {CM1E_MAPPING_DYNAMIC, "1.3.5", 0}, {CM1E_MAPPING_CSP, "1.3.0", 0}, {CM1E_MAPPING_DYNAMIC, "1.2.0", 0},
    {CM1E_MAPPING_CSP, "1.3.5", 1.5e-5},  {CM1E_MAPPING_CSV, "1.3.5", 0}, {CM1E_MAPPING_CSV, "1.2.0", 0},
};
enum { VARIANTS = sizeof variants / sizeof variants[0], STRIDE = 47, SAMPLED_STRIDE = 997 };

/** The motion without a fault shows what the servo does by itself. */
static void run_undisturbed(const variant_t *variant)
{
    length = 0;
    begin = ENABLED + LAST_PHASE;
    undisturbed = 0;
    run(variant);
}

static void print_table(void)
{
    printf("%s: largest speed over the axis's maximum velocity\n  %-28s", motion_names[motion], "cycles");
    for (int l = 0; l < LENGTHS; l++)
        printf("%6d", lengths[l]);
    for (int p = 0; p < PATTERNS; p++) {
        printf("\n  %-28s", pattern_names[p]);
        for (int l = 0; l < LENGTHS; l++)
            printf("%6.2f", table[p][l]);
    }
    printf("\n");
}

START_TEST(test_no_frame_that_is_heard_again_makes_a_motor_leap)
{
    int moment = 0;
    const int stride = sweep_stride(STRIDE, SAMPLED_STRIDE);
    motion = (motion_t)_i;
    memset(table, 0, sizeof table);
    for (int v = 0; v < (motion == A_DRIVE_MOVE ? 1 : VARIANTS); v++) {
        run_undisturbed(&variants[v]);
        for (int p = 0; p < PATTERNS; p++)
            for (int l = 0; l < LENGTHS; l++, moment++)
                for (begin = ENABLED + 1 + moment * 7 % stride; begin < ENABLED + LAST_PHASE; begin += stride) {
                    pattern = (pattern_t)p;
                    length = lengths[l];
                    run(&variants[v]);
                }
    }
    print_table();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("frames that do not come back");
    TCase *cases = tcase_create("silence");
    tcase_set_timeout(cases, 250);
    tcase_add_loop_test(cases, test_no_frame_that_is_heard_again_makes_a_motor_leap, 0, MOTIONS);
    suite_add_tcase(suite, cases);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int count = srunner_ntests_failed(runner);
    srunner_free(runner);
    return count ? EXIT_FAILURE : EXIT_SUCCESS;
}
