/**
 * A slave whose master is on another bus, and a group with axes on two buses, while frames of one of the two buses,
 * or of both, are lost: on the way out or on the way back, 1 ... 9 in a row, at every cycle of a motion, by a gear, by
 * a cam, and along a path. Up to `lost_cycles_limit` the slave rides it out, as a slave on the bus of its master does,
 * and is in step again at the end; the group comes to rest, meets on its path, and goes on. The judge is the
 * configuration and physics alone: set-points of an axis whose drive is heard keep velocity, acceleration and jerk of
 * the axis, and no simulated shaft is faster than undisturbed. The everyday test takes a sample of the
 * combinations, and of the moments at which losses begin. All: CM1E_TEST_STRIDE=1 bin/test_buses_silence.
 */
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>

#include "cm1e/sim.h"
#include "effort.h"
#include "two_buses.h"
#include "nic/nic.h"

enum { LRW = 12, COMMAND = 16 };
enum { BEGIN = 60, FIRST_LOSS = 58, LAST_LOSS = 640, END = 2600, STRIDE = 257, SAMPLED_STRIDE = 577 };

/* Of the maximum velocity: what the servo overshoots by itself, in CSP and in CSV, and what losses may add. */
static const double overshoot[] = {1.0016, 1.0034}, braked = 1.005, added = 0.0005;
static const double most_velocity = 20, most_acceleration = 200, most_jerk = 4000, unit = 50000, cycle_s = 1e-3;

typedef enum motion { BY_GEAR = 0, BY_FAST_GEAR, BY_GEAR_IN_POS, BY_CAM, BY_STEEP_CAM, BY_GROUP, MOTIONS } motion_t;
static const char *const motions[MOTIONS] = {"MC_GearIn", "MC_GearIn of a fast slave", "MC_GearInPos", "MC_CamIn",
                                             "MC_CamIn of a steep cam", "a group"};

/** Which bus loses frames, and on which way. */
typedef struct pattern {
    const char *name;
    bool lost[BUSES][2];
} pattern_t;
static const pattern_t patterns[] = {
    {"the master's bus, out", {{true, false}, {false, false}}},
    {"the master's bus, back", {{false, true}, {false, false}}},
    {"the slave's bus, out", {{false, false}, {true, false}}},
    {"the slave's bus, back", {{false, false}, {false, true}}},
    {"both, out", {{true, false}, {true, false}}},                {"both, back", {{false, true}, {false, true}}},
    {"both, out and back", {{true, false}, {false, true}}},
};
enum { PATTERNS = sizeof patterns / sizeof patterns[0] };

typedef struct variant {
    cm1e_mapping_t mapping;
    uint32_t limit; /**< lost_cycles_limit */
} variant_t;
static const variant_t variants[] = {
    {CM1E_MAPPING_DYNAMIC, 3}, {CM1E_MAPPING_DYNAMIC, 10}, {CM1E_MAPPING_CSV, 3}, {CM1E_MAPPING_CSV, 10}};
enum { VARIANTS = sizeof variants / sizeof variants[0] };

static const struct {
    int length, times, gap, shift; /**< shift: the slave's bus loses its frames so many cycles later */
} losses[] = {{1, 1, 1, 0}, {2, 1, 1, 0}, {3, 1, 1, 0}, {5, 1, 1, 0}, {9, 1, 1, 0}, {1, 3, 1, 0}, {2, 3, 2, 1},
              {1, 6, 4, 2}, {9, 1, 1, 4}};
enum { LOSSES = sizeof losses / sizeof losses[0] };

static MC_Power_t powers[BUSES];
static MC_MoveAbsolute_t move;
static MC_GearIn_t gear;
static MC_GearInPos_t gear_in_pos;
static MC_CamTableSelect_t select_cam;
static MC_CamIn_t cam;
static MC_CAM_POINT cam_points[] = {{0, 0, 0, 0}, {2, 1, 0.9, 0}, {6, 5, 0.9, 0}, {8, 6, 0, 0}};
enum { LINES = 2 };
static const double corner[LINES][BUSES] = {{5, 6}, {8, 3}};
static AXES_GROUP_REF_t group;
static MC_AddAxisToGroup_t add[BUSES];
static MC_GroupEnable_t enable;
static MC_GroupReadStatus_t group_status;
static MC_MoveLinearAbsolute_t lines[LINES];
static const MC_CAM_REF cam_table = {.Points = cam_points, .NumberOfPoints = 4};

/** The set-points of an axis, as differences: u, u a cycle ... */
typedef struct seen {
    double position, step, change, change_of_change;
    int heard; /**< cycles in a row whose frame was not lost */
    bool ended;
} seen_t;

static struct {
    motion_t motion;
    const variant_t *variant;
    const pattern_t *pattern; /**< NULL: nothing is lost */
    int length, times, gap, shift, lose_at, cycle, bus_of_tap;
    int lost_in_row[BUSES], longest[BUSES];
    seen_t seen[BUSES];
    double fastest[BUSES];
} run;

static double undisturbed_end;
static double path[END + 1][BUSES]; /**< of the undisturbed group, by cycle; the first axis only goes forward on it */

/* no_room: of `failed`, so many would have had to go beyond a limit of the axis to follow. */
static int followed, failed, no_room, in_gear;

__attribute__((format(printf, 1, 2), noreturn)) static void wrong(const char *format, ...)
{
    char what[300], text[CM1E_AXIS_ERROR_TEXT_BYTES];
    va_list args;
    va_start(args, format);
    vsnprintf(what, sizeof what, format, args);
    va_end(args);
    cm1e_axis_error_text(axes[B], text, sizeof text);
    ck_abort_msg("%s, %s, limit %u, %s: %d lost %d times at cycle %d, gap %d, shift %d; cycle %d: %s. %s",
                 motions[run.motion], run.variant->mapping == CM1E_MAPPING_CSV ? "CSV" : "CSP", run.variant->limit,
                 run.pattern ? run.pattern->name : "undisturbed", run.length, run.times, run.lose_at, run.gap,
                 run.shift, run.cycle, what, text);
}

/* ---- the wire ---------------------------------------------------------------------------------------------------- */

static bool is_lost_now(int bus)
{
    const int since = run.cycle - run.lose_at - (bus == B ? run.shift : 0), period = run.length + run.gap;
    return run.pattern && since >= 0 && since < run.times * period && since % period < run.length;
}

static cm1e_tap_verdict_t lose(int bus, const cm1e_tap_frame_t *frame)
{
    if (frame->bytes[COMMAND] != LRW || !is_lost_now(bus))
        return CM1E_TAP_PASS;
    return run.pattern->lost[bus][frame->direction == CM1E_TAP_RECEIVED] ? CM1E_TAP_DROP : CM1E_TAP_PASS;
}

static cm1e_tap_verdict_t tap_a(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    return lose(A, frame);
}

static cm1e_tap_verdict_t tap_b(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    return lose(B, frame);
}

static bool loses(int bus) { return run.pattern && (run.pattern->lost[bus][0] || run.pattern->lost[bus][1]); }

/* ---- the judge --------------------------------------------------------------------------------------------------- */

/** A set-point of an axis without an error. A drive that is not heard keeps its target, and the axis begins anew behind
 *  it with the velocity that the motor has left: that may be less at once, and never more. In CSV it begins where the
 *  motor has run on to. */
static void judge_set_point(int i)
{
    const double rounding = 1e-9, v = most_velocity * cycle_s, a = most_acceleration * cycle_s * cycle_s;
    const double j = 1.01 * most_jerk * cycle_s * cycle_s * cycle_s;
    seen_t *s = &run.seen[i];
    const cm1e_axis_info_t info = see(i);
    const double step = info.set_position - s->position, change = step - s->step, more = change - s->change;
    const bool lost = loses(i) && is_lost_now(i);
    s->ended |= info.state == CM1E_AXIS_ERROR_STOP;
    s->heard = lost ? 0 : s->heard + 1;
    if (run.cycle > BEGIN - 20 && !s->ended) {
        if ((s->heard > 4 || run.variant->mapping != CM1E_MAPPING_CSV) && fabs(step) > v + rounding)
            wrong("axis %d: a step of %g u, %g is allowed", i, step, v);
        if (s->heard > 4 && fabs(change) > a + rounding)
            wrong("axis %d: a step that changes by %g u, %g is allowed", i, change, a);
        if (s->heard > 5 && fabs(more) > j + rounding)
            wrong("axis %d: a step whose change changes by %g u, %g is allowed", i, more, j);
    }
    s->change_of_change = more;
    s->change = change;
    s->step = step;
    s->position = info.set_position;
}

/** In gear means: the set-points are in the ratio in this cycle, whatever the buses lose. A master that fails is judged
 *  by the next set-point of its slave. */
static void judge_in_gear(void)
{
    const double rounding = 1e-12;
    const cm1e_axis_info_t master = see(A), slave = see(B);
    const double ratio = (double)gear.RatioNumerator / (double)gear.RatioDenominator;
    if (!gear.InGear || run.seen[A].ended || run.seen[B].ended)
        return;
    if (fabs(slave.set_velocity - ratio * master.set_velocity) > rounding)
        wrong("in gear with %g u/s, its master has %g", slave.set_velocity, master.set_velocity);
    in_gear++;
}

static void count_lost(int i)
{
    run.lost_in_row[i] = loses(i) && is_lost_now(i) ? run.lost_in_row[i] + 1 : 0;
    if (run.lost_in_row[i] > run.longest[i])
        run.longest[i] = run.lost_in_row[i];
}

static void judge_shaft(int i)
{
    cm1e_sim_probe_t probe;
    cm1e_sim_probe(cm1e_bus_segment(buses[i]), 1, &probe);
    const double part = probe.peak_velocity_counts_per_s / (unit * most_velocity);
    /* The ramp of ErrorStop has no limit of jerk. */
    const double by_itself = run.seen[i].ended ? braked : overshoot[run.variant->mapping == CM1E_MAPPING_CSV];
    if (part > by_itself + added)
        wrong("axis %d: its shaft has %.4f of the maximum velocity", i, part);
}

/** The second axis of the group where the first one is at `x`, on the undisturbed path. */
static double on_path(double x)
{
    int i = 1;
    while (i < END && path[i][A] < x)
        i++;
    const double step = path[i][A] - path[i - 1][A];
    return step > 0 ? path[i - 1][B] + (x - path[i - 1][A]) / step * (path[i][B] - path[i - 1][B]) : path[i][B];
}

/** Behind losses the axes meet on the path before they go on. */
static void judge_path(void)
{
    enum { MET = 400 };
    const double chord = 1e-3;
    const cm1e_axis_info_t first = see(A), second = see(B);
    if (!run.pattern && run.cycle <= END) {
        path[run.cycle][A] = first.set_position;
        path[run.cycle][B] = second.set_position;
        return;
    }
    const bool met = run.seen[A].heard > MET && run.seen[B].heard > MET && !run.seen[A].ended && !run.seen[B].ended;
    if (met && fabs(second.set_position - on_path(first.set_position)) > chord)
        wrong("at %.6f, %.6f it is not on its path", first.set_position, second.set_position);
}

/** While one bus is silent the other axis already brakes. What both buses lose at once leaves nobody behind, so the path
 *  does not come to rest. */
static void judge_silence(void)
{
    const double nothing = 1e-9, farther = 1e-6;
    const bool one = loses(A) != loses(B), both = loses(A) && loses(B) && run.shift == 0;
    const int other = loses(A) ? B : A, last = run.lose_at + run.length - 1;
    if (!run.pattern || run.cycle > END || run.times > 1 || run.seen[A].ended || run.seen[B].ended)
        return;
    const double way = path[run.cycle][other] - path[run.cycle - 1][other], x = see(A).set_position;
    const double late = fabs(see(other).set_position - path[run.cycle][other]);
    if (one && run.length == 9 && run.shift == 0 && run.cycle == last && fabs(way) > farther && late < nothing)
        wrong("axis %d goes on along the path, and the other one is silent", other);
    if (both && run.length <= 2 && x > 0.1 && x < corner[LINES - 1][A] - 0.1 && see(A).set_velocity < nothing)
        wrong("both lost the same cycles, and the path comes to rest");
}

/** Both buses silent at once for longer than is ridden out: as on one bus, an axis by velocity leaves its path. */
static bool leaves_path(void)
{
    return run.variant->mapping == CM1E_MAPPING_CSV && loses(A) && loses(B) && run.length > 2;
}

/** It has done its commands, or has stopped because a bus was lost: then all axes are at rest. */
static void judge_group(void)
{
    const int limit = (int)run.variant->limit;
    const bool stopped = leaves_path() && group_status.GroupErrorStop;
    const bool lost = run.longest[A] >= limit || run.longest[B] >= limit || stopped;
    for (int i = 0; i < BUSES; i++) {
        const cm1e_axis_info_t info = see(i);
        const bool own = run.longest[i] >= limit || (stopped && info.error == CM1E_ERROR_AXIS_COUPLING_LIMIT);
        if ((info.state == CM1E_AXIS_ERROR_STOP) != own || info.set_velocity != 0.0)
            wrong("axis %d is in state %d with %g u/s, error %d", i, info.state, info.set_velocity, info.error);
        if (!lost && (fabs(info.set_position - corner[LINES - 1][i]) > 1e-9 ||
                      fabs(info.actual_position - info.set_position) > 100 / unit))
            wrong("axis %d ends at %.9f, its motor at %.9f", i, info.set_position, info.actual_position);
    }
    if (lost ? !group_status.GroupErrorStop : !(group_status.GroupStandby && lines[LINES - 1].Done))
        wrong("the group is in state %d", group_status.GroupErrorStop);
    failed += lost;
    followed += !lost;
}

static void judge_end(void)
{
    const cm1e_axis_info_t master = see(A), slave = see(B);
    const int limit = (int)run.variant->limit;
    judge_shaft(A);
    judge_shaft(B);
    if (run.motion == BY_GROUP) {
        judge_group();
        return;
    }
    if ((run.longest[A] >= limit) != (master.state == CM1E_AXIS_ERROR_STOP))
        wrong("the master is in state %d after %d cycles without an answer", master.state, run.longest[A]);
    if (slave.state == CM1E_AXIS_ERROR_STOP) {
        const bool lost = run.longest[A] >= limit || run.longest[B] >= limit;
        if (!lost && (run.motion == BY_GEAR || slave.error != CM1E_ERROR_AXIS_COUPLING_LIMIT))
            wrong("the slave stops although no bus is lost");
        failed++;
        no_room += !lost;
        return;
    }
    if (run.motion == BY_GEAR_IN_POS && run.longest[A] >= limit && slave.state == CM1E_AXIS_STANDSTILL) {
        failed++; /* the command still waited for its master */
        return;
    }
    if (run.longest[B] >= limit || slave.state != CM1E_AXIS_SYNCHRONIZED_MOTION)
        wrong("the slave is in state %d after %d cycles without an answer", slave.state, run.longest[B]);
    if (!run.pattern)
        undisturbed_end = slave.set_position;
    if (run.motion != BY_GEAR_IN_POS && fabs(slave.set_position - undisturbed_end) > 1e-6)
        wrong("the slave ends at %.9f, undisturbed at %.9f", slave.set_position, undisturbed_end);
    if (fabs(slave.actual_position - slave.set_position) > 100 / unit)
        wrong("the motor is %g u off its set-point", slave.actual_position - slave.set_position);
    followed++;
}

static bool by_cam(void) { return run.motion == BY_CAM || run.motion == BY_STEEP_CAM; }

/* ---- the program ------------------------------------------------------------------------------------------------- */

/** Along two lines with a rounded corner. */
static void move_group(bool powered)
{
    for (int i = 0; i < BUSES; i++) {
        add[i].Execute = TRUE;
        MC_AddAxisToGroup(&add[i]);
    }
    enable.Execute = add[A].Done && add[B].Done;
    MC_GroupEnable(&enable);
    group_status.Enable = TRUE;
    MC_GroupReadStatus(&group_status);
    for (int i = 0; i < LINES; i++) {
        lines[i].Execute = powered && enable.Done && run.cycle >= BEGIN;
        MC_MoveLinearAbsolute(&lines[i]);
    }
    judge_path();
    judge_silence();
}

static void program(void *context)
{
    (void)context;
    run.cycle++;
    for (int i = 0; i < BUSES; i++) {
        powers[i].Enable = TRUE;
        MC_Power(&powers[i]);
        count_lost(i);
    }
    const bool powered = powers[A].Status && powers[B].Status;
    gear.Execute = gear_in_pos.Execute = cam.Execute = powered;
    select_cam.Execute = TRUE;
    move.Execute = run.cycle >= BEGIN;
    if (run.motion == BY_GROUP)
        move_group(powered);
    else if (run.motion == BY_GEAR || run.motion == BY_FAST_GEAR)
        MC_GearIn(&gear);
    else if (run.motion == BY_GEAR_IN_POS)
        MC_GearInPos(&gear_in_pos);
    else
        MC_CamTableSelect(&select_cam);
    cam.CamTableID = select_cam.CamTableID;
    if (by_cam())
        MC_CamIn(&cam);
    if (run.motion != BY_GROUP)
        MC_MoveAbsolute(&move);
    for (int i = 0; i < BUSES; i++)
        judge_set_point(i);
    if (run.motion == BY_GEAR || run.motion == BY_FAST_GEAR)
        judge_in_gear();
    if (run.cycle == END)
        judge_end();
}

static void make_blocks(void)
{
    AXIS_REF_t *first = &axes[A], *second = &axes[B];
    const bool fast = run.motion == BY_FAST_GEAR;                                  /* at the limit of the slave */
    const bool hard = run.motion == BY_GEAR || run.motion == BY_STEEP_CAM;
    for (int i = 0; i < BUSES; i++)
        powers[i] = (MC_Power_t){.Axis = &axes[i], .EnablePositive = TRUE, .EnableNegative = TRUE};
    move = (MC_MoveAbsolute_t){.Axis = first, .Position = 8, .Velocity = hard ? 15 : 10,
                               .Acceleration = hard ? 120 : 80, .Deceleration = hard ? 120 : 80,
                               .Jerk = hard ? 1500 : 1000};
    gear = (MC_GearIn_t){.Master = first, .Slave = second, .RatioNumerator = fast ? -2 : 1, .RatioDenominator = 1};
    gear_in_pos = (MC_GearInPos_t){.Master = first, .Slave = second, .RatioNumerator = 1, .RatioDenominator = 1,
                                   .MasterSyncPosition = 4, .SlaveSyncPosition = 3, .MasterStartDistance = 3.8,
                                   .Velocity = most_velocity};
    select_cam = (MC_CamTableSelect_t){.Master = first, .Slave = second, .CamTable = &cam_table};
    cam = (MC_CamIn_t){.Master = first, .Slave = second};
}

static void make_group(void)
{
    must(cm1e_group_create(&group, NULL, &diag));
    for (int i = 0; i < BUSES; i++)
        add[i] = (MC_AddAxisToGroup_t){.AxesGroup = &group, .Axis = &axes[i], .IdentInGroup = (UINT)(i + 1)};
    enable = (MC_GroupEnable_t){.AxesGroup = &group};
    group_status = (MC_GroupReadStatus_t){.AxesGroup = &group};
    for (int i = 0; i < LINES; i++)
        lines[i] = (MC_MoveLinearAbsolute_t){
            .AxesGroup = &group, .Position = {corner[i][A], corner[i][B]}, .Velocity = 15, .Acceleration = 120,
            .Deceleration = 120, .Jerk = 2000, .BufferMode = i ? mcBlendingLow : mcAborting,
            .TransitionMode = i ? mcTMCornerDistance : mcTMNone, .TransitionParameter = 1};
}

static void open_bus(int i)
{
    cm1e_bus_config_t config;
    cm1e_bus_config_init(&config, "sim", 1);
    cm1e_axis_config_t *axis = &config.axes[0];
    snprintf(axis->name, sizeof axis->name, "%s", i == A ? "master" : "slave");
    axis->sim.no_stops = true;
    axis->mapping = run.variant->mapping;
    axis->max_velocity = most_velocity;
    axis->max_acceleration = most_acceleration;
    axis->max_jerk = most_jerk;
    axis->counts_per_unit = unit;
    config.lost_cycles_limit = run.variant->limit;
    config.virtual_time = true;
    config.cycle_time_ns = MS_IN_NS;
    must(cm1e_bus_open(&buses[i], &config, &diag));
    cm1e_bus_config_free(&config);
    must(cm1e_bus_start(buses[i], &diag));
}

static void run_once(void)
{
    run.cycle = 0;
    memset(run.lost_in_row, 0, sizeof run.lost_in_row);
    memset(run.longest, 0, sizeof run.longest);
    memset(run.seen, 0, sizeof run.seen);
    for (int i = 0; i < BUSES; i++)
        open_bus(i);
    must(cm1e_scheduler_create(&scheduler, buses[A], NULL, &diag));
    must(cm1e_scheduler_add_bus(scheduler, buses[B], &diag));
    for (int i = 0; i < BUSES; i++)
        axes[i] = cm1e_scheduler_axis(scheduler, (uint32_t)i);
    make_blocks();
    make_group();
    must(cm1e_scheduler_add_task(scheduler, &(cm1e_task_config_t){.program = program}, &diag));
    cm1e_nic_set_tap(cm1e_bus_nic(buses[A]), tap_a, NULL);
    cm1e_nic_set_tap(cm1e_bus_nic(buses[B]), tap_b, NULL);
    must(cm1e_scheduler_run(scheduler, END * MS_IN_NS, &diag));
    ck_assert_int_ge(run.cycle, END);
    must(cm1e_group_destroy(group));
    cm1e_scheduler_destroy(scheduler);
    for (int i = 0; i < BUSES; i++)
        cm1e_bus_close(buses[i]);
}

static void lose_everywhere(int number)
{
    const int stride = sweep_stride(STRIDE, SAMPLED_STRIDE);
    for (run.lose_at = FIRST_LOSS + number % stride; run.lose_at < LAST_LOSS; run.lose_at += stride)
        run_once();
}

START_TEST(test_a_slave_rides_out_what_either_bus_loses)
{
    memset(&run, 0, sizeof run);
    run.motion = (motion_t)(_i % MOTIONS);
    run.variant = &variants[_i / MOTIONS];
    run_once();
    ck_assert_int_ge(in_gear, run.motion == BY_GEAR || run.motion == BY_FAST_GEAR ? END / 2 : 0);
    int number = _i;
    for (int p = 0; p < PATTERNS; p++)
        for (int l = 0; l < LOSSES; l++) {
            number += 17;
            if (number % slowness() != 0 && stated_stride() == 0)
                continue;
            run.pattern = &patterns[p];
            run.length = losses[l].length;
            run.times = losses[l].times;
            run.gap = losses[l].gap;
            run.shift = losses[l].shift;
            lose_everywhere(number);
        }
    printf("%s, %s, limit %u: %d runs in step at the end, %d in ErrorStop, %d of these because of a limit\n",
           motions[run.motion], run.variant->mapping == CM1E_MAPPING_CSV ? "CSV" : "CSP", run.variant->limit, followed,
           failed, no_room);
    ck_assert_int_ge(followed, run.motion == BY_STEEP_CAM ? no_room : 5 * no_room);
}
END_TEST

int main(void)
{
    TCase *all = tcase_create("buses");
    tcase_set_timeout(all, 600);
    tcase_add_loop_test(all, test_a_slave_rides_out_what_either_bus_loses, 0, MOTIONS * VARIANTS);
    Suite *suite = suite_create("silence beside several buses");
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int not_good = srunner_ntests_failed(runner);
    srunner_free(runner);
    return not_good == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
