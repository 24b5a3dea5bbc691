/**
 * A drive that does not hear its master for a while, or a master that does not hear its drives, in the middle of a
 * move: frames lost on the way there or back, or both, a cable that comes off one slave or all, for 1 ... 160 cycles.
 * The motor may stop hard, run out, or be stopped by its watchdog; it never gets faster than it was, never jumps when
 * the frames come back, and nothing moves any more after ErrorStop is over.
 */
#include "safety_run.h"

typedef enum break_kind { BREAK_THERE = 0, BREAK_BACK, BREAK_BOTH_WAYS, BREAK_COUNTER, BREAK_FIRST, BREAK_SECOND,
                          BREAKS } break_kind_t;
static const char *const break_names[BREAKS] = {"lost on the way there", "lost on the way back", "lost on both ways",
                                                "wrong working counters", "cable off all", "cable off the second"};

enum { BREAK_AT = 260, REST_CYCLES = 900, LOST_LIMIT = 3 };
static const double speed_u = 300, unit = 1000; /* 300,000 counts/s */

static bench_t bench;
static MC_Power_t power[BENCH_AXES];
static MC_MoveVelocity_t move[BENCH_AXES];
static break_kind_t kind;
static int break_cycles;
static double speed_at_break[BENCH_AXES], fastest[BENCH_AXES], position_at_break[BENCH_AXES], rest_from[BENCH_AXES];
static int fastest_at[BENCH_AXES];

static bool broken(void) { return bench.cycle >= BREAK_AT && bench.cycle < BREAK_AT + break_cycles; }

static cm1e_tap_verdict_t lose(bench_t *b, cm1e_tap_frame_t *frame)
{
    if (!broken())
        return CM1E_TAP_PASS;
    const bool there = frame->direction == CM1E_TAP_SENT;
    if (kind == BREAK_BOTH_WAYS || (kind == BREAK_THERE && there) || (kind == BREAK_BACK && !there))
        return CM1E_TAP_DROP;
    if (kind == BREAK_COUNTER && !there)
        cm1e_frame_change_working_counter(frame->bytes, frame->length, 0, -1);
    (void)b;
    return CM1E_TAP_PASS;
}

static void watch(uint32_t n)
{
    const cm1e_sim_probe_t probe = bench_probe(&bench, n);
    if (bench.cycle == BREAK_AT - 1) {
        speed_at_break[n] = fabs(probe.velocity_counts_per_s);
        position_at_break[n] = probe.position_counts;
        MUST(&bench, fabs(speed_at_break[n] - speed_u * unit) < 3000, "axis %u: %.0f counts/s before the break", n,
             speed_at_break[n]);
    }
    if (bench.cycle >= BREAK_AT && fabs(probe.velocity_counts_per_s) > fastest[n]) {
        fastest[n] = fabs(probe.velocity_counts_per_s);
        fastest_at[n] = bench.cycle;
    }
    if (bench.cycle == BREAK_AT + break_cycles + REST_CYCLES)
        rest_from[n] = probe.position_counts;
}

static void program(bench_t *b)
{
    for (uint32_t n = 0; n < b->config.axis_count; n++) {
        power[n].Enable = TRUE;
        MC_Power(&power[n]);
        move[n].Execute = power[n].Status || move[n].Execute;
        MC_MoveVelocity(&move[n]);
        watch(n);
    }
    if (b->cycle == BREAK_AT && kind >= BREAK_FIRST)
        bench_console(b, "unplug %d", kind == BREAK_FIRST ? 1 : 2);
    if (b->cycle == BREAK_AT + break_cycles && kind >= BREAK_FIRST)
        bench_console(b, "replug %d", kind == BREAK_FIRST ? 1 : 2);
    if (b->cycle == BREAK_AT + break_cycles + REST_CYCLES + 200)
        cm1e_scheduler_stop(b->scheduler);
}

/** No faster than it was; what is above that is the simulated servo's overshoot when it is stopped at once. */
static double allowed_speed(uint32_t n) { return speed_at_break[n] * 1.05 + 1000; }

static void judge(uint32_t n)
{
    const cm1e_sim_probe_t probe = bench_probe(&bench, n);
    const cm1e_axis_info_t info = bench_info(&bench, n);
    char text[512];
    MUST(&bench, fastest[n] <= allowed_speed(n), "axis %u: %.0f counts/s at cycle %d, %.0f before, %.0f allowed", n,
         fastest[n], fastest_at[n], speed_at_break[n], allowed_speed(n));
    if (info.state != CM1E_AXIS_ERROR_STOP) {
        MUST(&bench, break_cycles < LOST_LIMIT, "axis %u: %s", n, cm1e_axis_state_name(info.state));
        return;
    }
    /* The ramp, twice its bare length for the jerk, or the way to the watchdog. */
    const double ramp = speed_at_break[n] * speed_at_break[n] / (2 * 5e6) * 2 + speed_at_break[n] * 0.12;
    MUST(&bench, !probe.torque_on, "axis %u: torque is still on", n);
    MUST(&bench, fabs(probe.position_counts - position_at_break[n]) < ramp + 60000, "axis %u: ran on for %.0f counts",
         n, probe.position_counts - position_at_break[n]);
    MUST(&bench, fabs(probe.position_counts - rest_from[n]) < 1, "axis %u: moves by %.1f counts after ErrorStop", n,
         probe.position_counts - rest_from[n]);
    cm1e_axis_error_text(bench.axis[n], text, sizeof text);
    MUST(&bench, strlen(text) > 60 && strstr(text, bench.config.axes[n].name), "axis %u: \"%s\"", n, text);
}

static void judge_at_the_end(bench_t *b)
{
    program(b);
    if (b->cycle == BREAK_AT + break_cycles + REST_CYCLES + 200)
        for (uint32_t n = 0; n < b->config.axis_count; n++)
            judge(n);
}

static void run(uint32_t axes, cm1e_mapping_t mapping, const char *firmware, break_kind_t which, int cycles)
{
    bench_free_axes(&bench, axes, mapping, firmware);
    kind = which;
    break_cycles = cycles;
    for (uint32_t n = 0; n < axes; n++) {
        snprintf(bench.config.axes[n].name, sizeof bench.config.axes[n].name, "axle%u", n);
        power[n] = (MC_Power_t){.Axis = &bench.axis[n], .EnablePositive = TRUE, .EnableNegative = TRUE};
        move[n] = (MC_MoveVelocity_t){.Axis = &bench.axis[n], .Velocity = n == 1 ? -speed_u : speed_u};
        speed_at_break[n] = fastest[n] = 0;
    }
    bench.program = judge_at_the_end;
    bench.fault = lose;
    snprintf(bench.scene, sizeof bench.scene, "mapping %d, firmware %s, %s for %d cycles", (int)mapping, firmware,
             break_names[kind], cycles);
    bench_play(&bench);
}

START_TEST(test_bus_away_for_a_while_makes_nothing_jump)
{
    static const struct {
        cm1e_mapping_t mapping;
        const char *firmware;
    } variants[] = {{CM1E_MAPPING_DYNAMIC, "1.3.5"}, {CM1E_MAPPING_CSP, "1.3.0"}, {CM1E_MAPPING_CSV, "1.3.5"},
                    {CM1E_MAPPING_CSV, "1.3.2"}, {CM1E_MAPPING_DYNAMIC, "1.2.0"}};
    const int step = sweep_stride(1, 13);
    for (int cycles = 1; cycles < 160; cycles += cycles < 6 ? 1 : 4 + step)
        run(_i % BREAKS == BREAK_SECOND ? 3 : 2, variants[_i / BREAKS].mapping, variants[_i / BREAKS].firmware, (break_kind_t)(_i % BREAKS), cycles);
}
END_TEST

/* ---- a set-point that a blocked motor has lost ---------------------------------------------------------------------- */

enum { FREED_LATEST = 400 };
static int freed_after;        /**< cycles, since the lag was called an error */
static int error_at;

static void blocked_program(bench_t *b)
{
    power[0].Enable = TRUE;
    MC_Power(&power[0]);
    move[0].Execute = power[0].Status || move[0].Execute;
    MC_MoveVelocity(&move[0]);
    const cm1e_sim_probe_t probe = bench_probe(b, 0);
    const cm1e_axis_info_t info = bench_info(b, 0);
    if (info.state == CM1E_AXIS_ERROR_STOP && error_at == 0) {
        error_at = b->cycle;
        MUST(b, info.error == CM1E_ERROR_AXIS_LAG, "another error: %d", info.error);
    }
    if (error_at && b->cycle == error_at + freed_after) {
        bench_drive(b, 0)->mechanics.stop_positive = INFINITY;
        cm1e_sim_probe_reset(b->segment, 1);
    }
    if (error_at == 0 || b->cycle < error_at + freed_after + 300)
        return;
    MUST(b, probe.travel_counts < 4000, "freed, the motor jumped by %.0f counts, at %.0f counts/s", probe.travel_counts,
         probe.peak_velocity_counts_per_s);
    MUST(b, !probe.torque_on, "torque in ErrorStop");
    cm1e_scheduler_stop(b->scheduler);
}

START_TEST(test_blocked_motor_does_not_jump_when_it_is_freed)
{
    static const cm1e_mapping_t mappings[] = {CM1E_MAPPING_DYNAMIC, CM1E_MAPPING_CSP, CM1E_MAPPING_CSV};
    for (freed_after = 1; freed_after < FREED_LATEST; freed_after += 1 + freed_after / 8 * slowness()) {
        bench_free_axes(&bench, 1, mappings[_i], "1.3.5");
        bench.config.axes[0].sim.no_stops = false;
        bench.config.axes[0].max_position_lag = 10;
        bench.config.axes[0].max_deceleration = 1000;
        bench.config.axes[0].sim.stop_positive = 20000;
        power[0] = (MC_Power_t){.Axis = &bench.axis[0], .EnablePositive = TRUE, .EnableNegative = TRUE};
        move[0] = (MC_MoveVelocity_t){.Axis = &bench.axis[0], .Velocity = speed_u};
        error_at = 0;
        bench.program = blocked_program;
        snprintf(bench.scene, sizeof bench.scene, "mapping %d, freed %d cycles after the error", (int)mappings[_i],
                 freed_after);
        bench_play(&bench);
    }
}
END_TEST

int main(void)
{
    return bench_main("a bus that is away for a while", 250,
                      (bench_test_t[]){{test_bus_away_for_a_while_makes_nothing_jump, 5 * BREAKS},
                                       {test_blocked_motor_does_not_jump_when_it_is_freed, 3}, {0}});
}
