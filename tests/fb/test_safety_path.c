/**
 * A path of which one motor has a heavy load, and a master that pauses, or frames that do not come back, at every phase
 * of it. The load turns that motor on: its axis leaves the path, goes after its motor, comes to rest and comes back. No
 * shaft is faster than its axis may be, no command is done before all axes are on the path, a stop is done where they
 * are, and the next line begins there. Of motors without a load none leaves the path where a cycle or two are lost.
 * What the drives hear is judged by the witness of safety_bench.h. By hand, all moments: CM1E_TEST_STRIDE=1
 * bin/test_safety_path.
 */
#include "safety_run.h"

typedef enum loss { PAUSE = 0, LOST_OUT, LOST_BACK, LOSSES } loss_t;
static const char *const loss_names[LOSSES] = {"pause", "frames lost on the way out", "frames lost on the way back"};

/** What comes after it. */
typedef enum order {
    GO_ON = 0, LOSS_AGAIN, INTERRUPT, GROUP_STOP, GROUP_HALT, AXIS_STOP, POWER_OFF, NEXT_LINE, ORDERS
} order_t;
static const char *const order_names[ORDERS] = {"nothing", "the same again", "MC_GroupInterrupt", "MC_GroupStop",
                                                "MC_GroupHalt", "MC_Stop of the heavy axis", "MC_Power FALSE",
                                                "another line"};
static bool keeps_the_line(order_t given) { return given <= INTERRUPT; }

enum { HEAVY = 0, OTHER, AXES, GROUPED = 240, ENABLED = 260, LAST = 900, ORDERED = 2100, END = 3600, STOP_HELD = 300 };
static const double unit = 1000, acceleration_u = 3285, jerk_u = 127965; /* counts a unit; u/s2, u/s3 */
static const double way_u = 400, back_u = -100;
static const double limits_u[] = {400, 700, 1000};                 /* u/s: 8, 14 and 20 rev/s */
static const double loads[] = {2e-5, 4.3e-5, 6e-5};                /* kg m2: 6, 12 and 17 times the rotor */
static const cm1e_mapping_t mappings[] = {CM1E_MAPPING_CSP, CM1E_MAPPING_DYNAMIC};
enum { LIMITS = 3, LOADS = 3, MAPPINGS = 2 };

static bench_t bench;
static loss_t loss;
static order_t order;
static int loss_cycles, loss_at, order_after;
static double limit_u, slope, fastest[AXES]; /**< slope: of the line, OTHER by HEAVY */
static MC_Power_t power[AXES];
static MC_AddAxisToGroup_t add[AXES];
static MC_GroupEnable_t enable_group;
static MC_GroupReset_t reset_group;
static MC_MoveLinearAbsolute_t line, next_line;
static MC_GroupStop_t stop_group;
static MC_GroupHalt_t halt_group;
static MC_GroupInterrupt_t interrupt_group;
static MC_GroupContinue_t continue_group;
static MC_Stop_t stop_axis;
static AXES_GROUP_REF_t group;
static int left_path; /**< cycles in which the heavy axis was off its line, of all runs */

static int order_at(void) { return loss_at + loss_cycles + order_after; }

static bool is_lost(int cycle)
{
    const bool again = order == LOSS_AGAIN && cycle >= order_at() && cycle < order_at() + loss_cycles;
    return again || (cycle >= loss_at && cycle < loss_at + loss_cycles);
}

static cm1e_tap_verdict_t lose(bench_t *b, cm1e_tap_frame_t *frame)
{
    const bool out = frame->direction == CM1E_TAP_SENT;
    return loss != PAUSE && is_lost(b->cycle) && out == (loss == LOST_OUT) ? CM1E_TAP_DROP : CM1E_TAP_PASS;
}

/* ---- the program ------------------------------------------------------------------------------------------------- */

static void make_blocks(void)
{
    for (int n = 0; n < AXES; n++) {
        power[n] = (MC_Power_t){.Axis = &bench.axis[n], .EnablePositive = TRUE, .EnableNegative = TRUE};
        add[n] = (MC_AddAxisToGroup_t){.AxesGroup = &group, .Axis = &bench.axis[n],
                                       .IdentInGroup = (MC_IDENT_IN_GROUP)(n + 1)};
        fastest[n] = 0;
    }
    enable_group = (MC_GroupEnable_t){.AxesGroup = &group};
    reset_group = (MC_GroupReset_t){.AxesGroup = &group};
    line = (MC_MoveLinearAbsolute_t){.AxesGroup = &group, .Position = {way_u, way_u * slope},
                                     .Velocity = 1.96 * limit_u};
    next_line = (MC_MoveLinearAbsolute_t){.AxesGroup = &group, .Position = {back_u, back_u}, .Velocity = limit_u,
                                          .BufferMode = mcAborting};
    stop_group = (MC_GroupStop_t){.AxesGroup = &group};
    halt_group = (MC_GroupHalt_t){.AxesGroup = &group};
    interrupt_group = (MC_GroupInterrupt_t){.AxesGroup = &group};
    continue_group = (MC_GroupContinue_t){.AxesGroup = &group};
    stop_axis = (MC_Stop_t){.Axis = &bench.axis[HEAVY]};
}

static void give_order(int cycle)
{
    const bool now = cycle >= order_at(), held = now && cycle < order_at() + STOP_HELD;
    stop_group.Execute = order == GROUP_STOP && held;
    halt_group.Execute = order == GROUP_HALT && now;
    interrupt_group.Execute = order == INTERRUPT && held;
    continue_group.Execute = order == INTERRUPT && now && !held;
    stop_axis.Execute = order == AXIS_STOP && held;
    power[HEAVY].Enable = !(order == POWER_OFF && held);
    next_line.Execute = order == NEXT_LINE ? now : cycle > ORDERED && !keeps_the_line(order);
    reset_group.Execute = cycle > ORDERED - 10 && (order == AXIS_STOP || order == POWER_OFF);
}

static void call_blocks(int cycle)
{
    for (int n = 0; n < AXES; n++) {
        power[n].Enable = TRUE;
        add[n].Execute = cycle > GROUPED - 20;
    }
    enable_group.Execute = cycle > GROUPED;
    line.Execute = cycle > ENABLED;
    give_order(cycle);
    for (int n = 0; n < AXES; n++) {
        MC_Power(&power[n]);
        MC_AddAxisToGroup(&add[n]);
    }
    MC_GroupEnable(&enable_group);
    MC_GroupReset(&reset_group);
    MC_MoveLinearAbsolute(&line);
    MC_GroupStop(&stop_group);
    MC_GroupHalt(&halt_group);
    MC_GroupInterrupt(&interrupt_group);
    MC_GroupContinue(&continue_group);
    MC_Stop(&stop_axis);
    MC_MoveLinearAbsolute(&next_line);
}

/* ---- the judge --------------------------------------------------------------------------------------------------- */

static bool is_on_line(void)
{
    return fabs(bench_info(&bench, OTHER).set_position - bench_info(&bench, HEAVY).set_position * slope) < 1e-6;
}

/* From Done of MC_GroupInterrupt until MC_GroupContinue no set-point moves, also where an axis has left the path. */
static void watch_rest(void)
{
    static double rest[AXES];
    static bool rests;
    for (uint32_t n = 0; n < AXES; n++) {
        const double at = bench_info(&bench, n).set_position;
        MUST(&bench, !rests || at == rest[n], "interrupted, axis %u moves by %g", n, at - rest[n]);
        rest[n] = at;
    }
    rests = interrupt_group.Done && !continue_group.Execute;
}

static void watch(void)
{
    watch_rest();
    for (uint32_t n = 0; n < AXES; n++)
        fastest[n] = fmax(fastest[n], fabs(bench_probe(&bench, n).peak_velocity_counts_per_s));
    const bool on_line = is_on_line();
    left_path += !on_line && !next_line.Execute;
    MUST(&bench, !line.Done || next_line.Execute || on_line, "done, and off the line: %.6f, %.6f",
         bench_info(&bench, HEAVY).set_position, bench_info(&bench, OTHER).set_position);
}

static void judge_place(uint32_t n, double place)
{
    const cm1e_axis_info_t info = bench_info(&bench, n);
    MUST(&bench, info.state == CM1E_AXIS_STANDSTILL, "axis %u is in %s, error %d", n, cm1e_axis_state_name(info.state),
         info.error);
    MUST(&bench, fabs(info.set_position - place) < 1e-6, "axis %u ends at %.6f, not at %.6f", n, info.set_position, place);
}

static void judge_end(void)
{
    const bool goes_on = keeps_the_line(order);
    for (uint32_t n = 0; n < AXES; n++)
        MUST(&bench, fastest[n] < 1.01 * limit_u * unit, "axis %u: %.0f counts/s, %.2f of its maximum", n, fastest[n],
             fastest[n] / (limit_u * unit));
    MUST(&bench, goes_on ? line.Done : next_line.Done, "the last line is not done: %X, %X", line.ErrorID,
         next_line.ErrorID);
    MUST(&bench, !stop_group.Error && !halt_group.Error && !stop_axis.Error, "a stop has an error: %X, %X, %X",
         stop_group.ErrorID, halt_group.ErrorID, stop_axis.ErrorID);
    judge_place(HEAVY, goes_on ? way_u : back_u);
    judge_place(OTHER, goes_on ? way_u * slope : back_u);
}

static void program(bench_t *b)
{
    call_blocks(b->cycle);
    watch();
    if (loss == PAUSE && (b->cycle == loss_at || (order == LOSS_AGAIN && b->cycle == order_at())))
        bench_miss(b, loss_cycles * INT64_C(1000000));
    if (b->cycle != END)
        return;
    judge_end();
    cm1e_scheduler_stop(b->scheduler);
}

/* ---- runs -------------------------------------------------------------------------------------------------------- */

static void make_group(bench_t *b)
{
    cm1e_diag_t diag = {0};
    MUST(b, cm1e_group_create(&group, NULL, &diag) == CM1E_OK, "%s", diag.text);
}

static void run(cm1e_mapping_t mapping, double load)
{
    bench_free_axes(&bench, AXES, mapping, "1.3.5");
    bench_limit_axes(&bench, unit, limit_u, acceleration_u, jerk_u);
    bench.config.axes[HEAVY].sim.load_inertia = load;
    bench.config.lost_cycles_limit = 40;
    bench.program = program;
    bench.fault = lose;
    bench.started = make_group;
    snprintf(bench.scene, sizeof bench.scene, "%.0f u/s, %g kg m2, mapping %d, %s, %d cycles in cycle %d, after %d: %s",
             limit_u, load, (int)mapping, loss_names[loss], loss_cycles, loss_at, order_after, order_names[order]);
    make_blocks();
    bench_play(&bench);
    (void)cm1e_group_destroy(group);
}

START_TEST(test_an_axis_with_a_heavy_load_leaves_its_path_and_comes_back)
{
    static const int lengths[] = {3, 4, 8, 13}, moments[] = {0, 1, 2, 3, 5, 8, 13, 21, 34, 55, 89, 144};
    enum { LENGTHS = 4, MOMENTS = 12 };
    int number = 0;
    order = (order_t)_i;
    left_path = 0;
    slope = 0.5;
    const int stride = sweep_stride(263, 1571);
    for (int l = 0; l < LOSSES * LENGTHS; l++)
        for (int m = 0; m < MOMENTS; m++, number++)
            for (loss_at = ENABLED + 40 + number * 7 % stride; loss_at < LAST; loss_at += stride) {
                const int which = number + loss_at;
                loss = (loss_t)(l / LENGTHS);
                loss_cycles = lengths[l % LENGTHS];
                order_after = moments[m];
                limit_u = limits_u[which % LIMITS];
                run(mappings[which % MAPPINGS], loads[which / 2 % LOADS]);
            }
    MUST(&bench, left_path > 0, "no axis has left its path: this tests nothing");
}
END_TEST

/* Both axes use all of their acceleration, so a set-point that one of them had a step before the other is refused. */
START_TEST(test_a_path_goes_on_after_a_cycle_or_two)
{
    order = GO_ON;
    order_after = left_path = 0;
    slope = 1.0;
    limit_u = limits_u[0];
    const int stride = sweep_stride(13, 101);
    for (int l = 0; l < LOSSES; l++)
        for (loss_cycles = 1; loss_cycles <= 2; loss_cycles++)
            for (loss_at = ENABLED + 5 + l; loss_at < LAST; loss_at += stride) {
                loss = (loss_t)l;
                run(mappings[loss_at % MAPPINGS], 2e-6);
            }
    MUST(&bench, left_path == 0, "an axis has left its path");
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("a path with a heavy load");
    for (int i = 0; i < ORDERS; i++)
        bench_add(suite, order_names[i], 120, test_an_axis_with_a_heavy_load_leaves_its_path_and_comes_back, i, i + 1);
    bench_add(suite, "a cycle or two", 120, test_a_path_goes_on_after_a_cycle_or_two, 0, 1);
    return bench_run_suite(suite);
}
