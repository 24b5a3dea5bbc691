/**
 * A motor that turns in the gap of its backlash when it gets its torque: it is braked as one without a gap, its load
 * moves by a flank only, and the axis knows where that is. The witness has the load behind the gap.
 */
#include "safety_bench.h"

enum { MAPPINGS = 4, THROWN_AT = 40, MOVE = 700 /* counts */, MOVES = 4 };

typedef struct throw {
    double speed;        /* counts/s; of the motor, in the direction of the axis */
    int gap;             /* counts */
    double load_inertia; /* kgm2 */
    int pause_at, pause; /* cycles: after the first one with torque; how many are missed */
    int off_after;       /* cycles of torque; 0: MC_Power stays TRUE */
} throw_t;

static bench_t bench;
static const throw_t *thrown;
static MC_Power_t power;
static MC_MoveRelative_t move;
static double load, load_before;    /* counts, in the direction of the axis */
static double fastest, speed_at_end_of_torque, speed_when_on;
static int torque_cycles, on_cycles, moves;
static bool came_on, had_torque, ramped;
static char text_at_end[512];

static double sign(void) { return bench.config.axes[0].invert ? -1 : 1; }

static bool by_velocity(void) { return bench.witness[0].out_position < 0; }

/* counts; a servo that overshoots takes its load along, also when it makes up the last counts of its lag after it was
 * taken over. The position loop of a mapping without target position overshoots by more. */
static double near_enough(void) { return by_velocity() ? 120 : 60; }

/* A move, and the crossing of the gap with it, which has a revolution of the motor a second. */
static int cycles_of_move(void) { return 200 + thrown->gap / 40; }

static void follow(double motor) { load = fmax(motor, fmin(load, motor + thrown->gap)); }

static void watch_torque(bench_t *b, const cm1e_sim_probe_t *probe)
{
    const double speed = fabs(probe->velocity_counts_per_s);
    fastest = probe->torque_on && !came_on ? fmax(fastest, speed) : fastest;
    if (had_torque && !probe->torque_on && !came_on)
        speed_at_end_of_torque = speed;
    had_torque = probe->torque_on;
    torque_cycles += probe->torque_on;
    ramped |= bench_info(b, 0).state == CM1E_AXIS_DISABLED && bench_info(b, 0).set_velocity != 0;
    if (torque_cycles == thrown->pause_at && probe->torque_on && thrown->pause > 0 && !came_on)
        bench_miss(b, thrown->pause * b->config.cycle_time_ns);
}

/** To and fro, when all rests: each way is one of the load. */
static void move_to_and_fro(bench_t *b)
{
    on_cycles += power.Status;
    move.Execute = on_cycles % cycles_of_move() > 0;
    MC_MoveRelative(&move);
    if (on_cycles == 0 || move.Execute)
        return;
    const double way = load - load_before, shown = bench_info(b, 0).actual_position * 1000;
    MUST(b, fabs(shown - load) <= near_enough(), "the axis shows its load at %.1f, it is at %.1f", shown, load);
    MUST(b, moves == 0 || fabs(way - 1000 * move.Distance) <= near_enough(), "way %d of the load was %.1f", moves, way);
    load_before = load;
    move.Distance = (moves % 3 == 1 ? -MOVE : MOVE) / 1000.0;
    if (moves++ == MOVES)
        cm1e_scheduler_stop(b->scheduler);
}

static void program(bench_t *b)
{
    if (b->cycle == THROWN_AT - 3)
        bench_drive(b, 0)->mechanics.velocity = sign() * thrown->speed;
    power.Enable = b->cycle >= THROWN_AT && (thrown->off_after == 0 || torque_cycles < thrown->off_after);
    const cm1e_sim_probe_t probe = bench_probe(b, 0);
    follow(sign() * probe.position_counts);
    watch_torque(b, &probe);
    MC_Power(&power);
    if (power.Status && !came_on) {
        came_on = true;
        speed_when_on = fabs(probe.velocity_counts_per_s);
    }
    move_to_and_fro(b);
    if (b->cycle == THROWN_AT + 5000)
        cm1e_scheduler_stop(b->scheduler);
}

static void play(const throw_t *t, cm1e_mapping_t mapping, bool invert)
{
    cm1e_bus_config_free(&bench.config);
    memset(&bench, 0, sizeof bench);
    bench_describe(&bench, 1);
    thrown = t;
    cm1e_axis_config_t *axis = &bench.config.axes[0];
    axis->mapping = mapping;
    axis->invert = invert;
    axis->backlash = t->gap / 1000.0;
    axis->max_deceleration = 1000;
    axis->sim = (cm1e_sim_axis_config_t){.no_stops = true, .load_inertia = t->load_inertia};
    power = (MC_Power_t){.Axis = &bench.axis[0], .EnablePositive = TRUE, .EnableNegative = TRUE};
    move = (MC_MoveRelative_t){.Axis = &bench.axis[0], .Velocity = 20};
    load = load_before = fastest = speed_at_end_of_torque = speed_when_on = 0;
    torque_cycles = on_cycles = moves = 0;
    came_on = had_torque = ramped = false;
    snprintf(bench.scene, sizeof bench.scene, "mapping %d, invert %d, %g counts/s, gap %d, load %g, pause %d at %d, "
             "off after %d", (int)mapping, invert, t->speed, t->gap, t->load_inertia, t->pause, t->pause_at,
             t->off_after);
    bench.program = program;
    cm1e_diag_t diag = {0};
    bench_open(&bench);
    bench_start(&bench);
    const cm1e_error_t error = bench_run(&bench, &diag);
    MUST(&bench, error == CM1E_OK, "%s", diag.text);
    cm1e_axis_error_text(bench.axis[0], text_at_end, sizeof text_at_end);
    bench_close(&bench);
    MUST(&bench, fastest <= fabs(t->speed), "driven to %.0f counts/s", fastest);
}

/* counts/s; of a motor at rest (docs/SAFETY.md). */
static double rests(void) { return 3000 + bench.config.axes[0].max_deceleration * 3; }

static const double speeds[] = {100000, -100000, 30000, -30000};
static const int gaps[] = {50, 600, 20000};
static const double loads[] = {2e-6, 5e-5, 3e-4};
enum { SPEEDS = 4, GAPS = 3, LOADS = 3 };

static throw_t throw_of(int n)
{
    return (throw_t){.speed = speeds[n % SPEEDS], .gap = gaps[n / SPEEDS % GAPS],
                     .load_inertia = loads[n / SPEEDS / GAPS % LOADS]};
}

START_TEST(test_a_motor_that_turns_in_its_gap_is_braked_and_its_load_is_known)
{
    for (int mapping = 0; mapping < MAPPINGS; mapping++)
        for (int invert = 0; invert < 2; invert++) {
            const throw_t t = throw_of(_i);
            play(&t, (cm1e_mapping_t)mapping, invert);
            MUST(&bench, came_on && moves > MOVES, "not on, or %d moves: %s", moves, text_at_end);
            MUST(&bench, speed_when_on < rests(), "on at %.0f counts/s", speed_when_on);
            /* A light motor has nearly stopped before its velocity is known. */
            MUST(&bench, ramped || by_velocity() || (t.load_inertia < 1e-5 && fabs(t.speed) < 50000), "no ramp");
        }
}
END_TEST

/* The servo stops it at once, and a heavy load swings: its flank goes to and fro. */
START_TEST(test_a_load_that_swings_in_its_gap_behind_a_pause_is_known)
{
    for (int pause = 1; pause <= 20; pause += sweep_stride(1, 3))
        for (int at = 0; at < 12; at += sweep_stride(1, 2)) {
            throw_t t = throw_of(_i);
            t.pause = pause;
            t.pause_at = at;
            play(&t, CM1E_MAPPING_DYNAMIC, (pause + at) % 2);
            MUST(&bench, came_on && moves > MOVES, "not on, or %d moves: %s", moves, text_at_end);
        }
}
END_TEST

/* From the fifth cycle of torque on its velocity is known (docs/SAFETY.md): it does not lose its torque before it
 * rests. */
START_TEST(test_power_false_brakes_a_motor_that_turns_in_its_gap)
{
    for (int after = 5; after < 40; after += sweep_stride(1, 3)) {
        throw_t t = throw_of(_i);
        t.off_after = after;
        play(&t, CM1E_MAPPING_DYNAMIC, after % 2);
        MUST(&bench, torque_cycles >= after, "no torque: %s", text_at_end);
        MUST(&bench, speed_at_end_of_torque < rests(), "let go at %.0f counts/s", speed_at_end_of_torque);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("enabling in the gap of a backlash");
    TCase *cases = tcase_create("backlash");
    tcase_set_timeout(cases, 250);
    tcase_add_loop_test(cases, test_a_motor_that_turns_in_its_gap_is_braked_and_its_load_is_known, 0,
                        SPEEDS * GAPS * LOADS);
    tcase_add_loop_test(cases, test_a_load_that_swings_in_its_gap_behind_a_pause_is_known, 0, SPEEDS * GAPS * LOADS);
    tcase_add_loop_test(cases, test_power_false_brakes_a_motor_that_turns_in_its_gap, 0, SPEEDS * GAPS * LOADS);
    suite_add_tcase(suite, cases);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int count = srunner_ntests_failed(runner);
    srunner_free(runner);
    return count ? EXIT_FAILURE : EXIT_SUCCESS;
}
