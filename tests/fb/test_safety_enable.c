/**
 * Enabling never moves a motor: every mapping, order of objects and firmware; first enabling, re-enabling, after a
 * fault and its reset, after motor power was away; with a shaft that somebody turns, at the ends of the 32-bit position,
 * with frames lost or late at every cycle of the way to Operation enabled, and with Enable toggled at random; nor does a
 * change of mode let go of a load. What goes over the wire is judged by the witness of safety_bench.h, what the shaft
 * does by the simulator's probe.
 */
#include "safety_bench.h"

enum { MAPPINGS = 4, ORDERS = 2, VARIANTS = MAPPINGS * ORDERS * CM1E_FIRMWARE_COUNT };

static bench_t bench;
static MC_Power_t power;
static MC_Reset_t reset;
static MC_MoveRelative_t move;

static void prepare(cm1e_mapping_t mapping, cm1e_pdo_order_t order, const char *firmware)
{
    cm1e_bus_config_free(&bench.config);
    memset(&bench, 0, sizeof bench);
    bench_describe(&bench, 1);
    bench.config.sim_pdo_order = order;
    bench.config.axes[0].mapping = mapping;
    snprintf(bench.config.axes[0].firmware, sizeof bench.config.axes[0].firmware, "%s", firmware);
    power = (MC_Power_t){.Axis = &bench.axis[0], .EnablePositive = TRUE, .EnableNegative = TRUE};
    reset = (MC_Reset_t){.Axis = &bench.axis[0]};
    move = (MC_MoveRelative_t){.Axis = &bench.axis[0], .Distance = 3, .Velocity = 50};
    snprintf(bench.scene, sizeof bench.scene, "mapping %d, order %d, firmware %s", (int)mapping, (int)order, firmware);
}

static void prepare_variant(int variant)
{
    prepare((cm1e_mapping_t)(variant % MAPPINGS), (cm1e_pdo_order_t)(variant / MAPPINGS % ORDERS),
            cm1e_firmware_info((cm1e_firmware_t)(variant / MAPPINGS / ORDERS))->version);
}

static void call_blocks(void)
{
    MC_Power(&power);
    MC_Reset(&reset);
    MC_MoveRelative(&move);
}

static char text_at_end[512];

static const char *axis_text(void)
{
    cm1e_axis_error_text(bench.axis[0], text_at_end, sizeof text_at_end);
    return text_at_end;
}

static void run_to_the_end(void)
{
    cm1e_diag_t diag = {0};
    const cm1e_error_t error = bench_run(&bench, &diag);
    MUST(&bench, error == CM1E_OK, "%s", diag.text);
    MUST(&bench, !bench_probe(&bench, 0).torque_on, "torque after the end");
    axis_text();
    bench_close(&bench);
}

/* ---- a shaft that nobody turns --------------------------------------------------------------------------------- */

static void enable(void) { power.Enable = TRUE; }
static void disable(void) { power.Enable = FALSE; }
static void begin_move(void) { move.Execute = TRUE; }
static void end_move(void) { move.Execute = FALSE; }
static void fault(void) { bench_console(&bench, "over-torque 1"); }
static void begin_reset(void) { reset.Execute = TRUE; }
static void power_away(void) { bench_console(&bench, "power 1 off"); }
static void power_back(void) { bench_console(&bench, "power 1 on"); }

static bool on(void) { return power.Status; }
static bool off(void) { return !bench_probe(&bench, 0).torque_on && !power.Status; }
static bool moved(void) { return move.Done; }
static bool failed(void) { return bench_info(&bench, 0).state == CM1E_AXIS_ERROR_STOP; }
static bool reset_over(void) { return reset.Done || reset.Error; }
static bool enabled_again(void)
{
    if (reset.Done)
        reset.Execute = FALSE;
    return power.Status;
}
static bool at_once(void) { return true; }

/** `then` is waited for, and after it the shaft is watched for a while. */
static const struct {
    const char *name;
    void (*action)(void);
    bool (*then)(void);
    int watch_cycles;
    bool moves;
} script[] = {
    {"before", disable, off, 20, false},
    {"first enabling", enable, on, 150, false},
    {"a move", begin_move, moved, 200, true},
    {"after the move", end_move, at_once, 50, false},
    {"off", disable, off, 60, false},
    {"enabling after a move", enable, on, 150, false},
    {"off and on in neighbouring cycles", disable, at_once, 0, false},
    {"on again", enable, on, 100, false},
    {"a fault", fault, failed, 60, false},
    {"reset, enabled again", begin_reset, enabled_again, 150, false},
    {"a second move", begin_move, moved, 200, true},
    {"motor power away", power_away, failed, 100, false},
    {"motor power back", power_back, at_once, 100, false},
    {"reset after it", begin_reset, reset_over, 0, false},
    {"enabled after it", end_move, enabled_again, 150, false},
    {"last off", disable, off, 50, false},
};
enum { SCENES = sizeof script / sizeof script[0], LONGEST_SCENE = 3000 };

static int scene, since, watched;

/* A mapping without target position: the last counts of a move are made up slowly, by a position loop of ours. */
static bool settling(void) { return bench.witness[0].out_position < 0 && scene > 0 && script[scene - 1].moves; }

static void script_program(bench_t *b)
{
    if (since == 0) {
        cm1e_sim_probe_reset(b->segment, 1);
        script[scene].action();
    }
    call_blocks();
    MUST(b, ++since < LONGEST_SCENE, "%s: does not come: %s", script[scene].name, axis_text());
    const cm1e_sim_probe_t probe = bench_probe(b, 0);
    if (!script[scene].moves)
        MUST(b, probe.peak_velocity_counts_per_s < 150 && probe.travel_counts < (settling() ? 25 : 2),
             "%s: the shaft moved by %.2f counts, at up to %.1f counts/s", script[scene].name, probe.travel_counts,
             probe.peak_velocity_counts_per_s);
    else
        MUST(b, probe.travel_counts < 3200, "%s: moved by %.0f counts", script[scene].name, probe.travel_counts);
    watched = watched > 0 || script[scene].then() ? watched + 1 : 0;
    if (watched <= script[scene].watch_cycles)
        return;
    since = watched = 0;
    if (++scene == SCENES)
        cm1e_scheduler_stop(b->scheduler);
}

static void play_script(void)
{
    scene = since = watched = 0;
    bench.program = script_program;
    bench_start(&bench);
    run_to_the_end();
    MUST(&bench, bench.witness[0].enablings >= 4, "enabled only %u times", bench.witness[0].enablings);
    if (bench.witness[0].out_position >= 0)
        MUST(&bench, bench.witness[0].set_points > 1000, "only %u set-points", bench.witness[0].set_points);
}

START_TEST(test_a_resting_shaft_stays_at_rest)
{
    prepare_variant(_i);
    bench_open(&bench);
    play_script();
}
END_TEST

/* The position wraps in the middle of the moves, or lies beside the wrap while the axis is enabled. */
START_TEST(test_the_end_of_32_bits_is_a_position_like_any_other)
{
    static const int64_t positions[] = {INT64_C(0x7FFFFFFF), INT64_C(0x80000000), INT64_C(0x7FFFFFFF) - 2999,
                                        INT64_C(0x7FFFFFFF) - 4000, INT64_C(0xFFFFFFFF)};
    prepare((cm1e_mapping_t)(_i % MAPPINGS), CM1E_PDO_ORDER_UG_4_4, "1.3.5");
    bench.config.axes[0].invert = _i / MAPPINGS % 2;
    bench_open(&bench);
    bench_drive(&bench, 0)->zero = -positions[_i / MAPPINGS / 2];
    play_script();
}
END_TEST

/* ---- a shaft that somebody turns ------------------------------------------------------------------------------- */

static double load_nm;
static int enable_cycle;
static double free_speed, free_position; /* of the shaft, when it had no torque last */
static double free_gain;                 /* of speed in a cycle, without us */
static double pulled_back, driven;       /* most of it since then: counts; counts/s above the free speed */
static double fastest_caught;
static int torque_cycles;

static void turned_program(bench_t *b)
{
    if (b->cycle == 5)
        bench_console(b, "load 1 %g", load_nm);
    power.Enable = b->cycle >= enable_cycle;
    call_blocks();
    const cm1e_sim_probe_t probe = bench_probe(b, 0);
    const double sign = load_nm < 0 ? -1 : 1;
    if (probe.torque_on) {
        torque_cycles++;
        pulled_back = fmax(pulled_back, free_position - probe.position_counts * sign);
        driven = fmax(driven, fabs(probe.velocity_counts_per_s) - free_speed);
        fastest_caught = fmax(fastest_caught, free_speed);
    } else {
        free_speed = probe.velocity_counts_per_s * sign;
        free_position = probe.position_counts * sign;
    }
    if (b->cycle == enable_cycle + 400)
        cm1e_scheduler_stop(b->scheduler);
}

/** The shaft is caught where it was seen last, `blind_cycles` before the torque came and acts; it is never driven. */
static void turn(double torque_nm, int cycle, int blind_cycles)
{
    bench.config.axes[0].sim.no_stops = true;
    bench.program = turned_program;
    load_nm = torque_nm;
    enable_cycle = cycle;
    const cm1e_mechanics_t *mechanics = &bench_drive(&bench, 0)->mechanics;
    free_gain = fmax(fabs(torque_nm) - mechanics->friction, 0) * mechanics->gain * 1e-3;
    free_speed = free_position = pulled_back = driven = fastest_caught = 0;
    torque_cycles = 0;
    bench_start(&bench);
    run_to_the_end();
    const double most = (fastest_caught + blind_cycles * free_gain) * 0.001 * blind_cycles + 20;
    MUST(&bench, pulled_back <= most, "load %g Nm: pulled back by %.0f counts, allowed are %.0f", torque_nm,
         pulled_back, most);
    MUST(&bench, driven <= blind_cycles * free_gain + 200, "load %g Nm: driven, %.0f counts/s faster than it turned",
         torque_nm, driven);
}

START_TEST(test_a_turning_shaft_is_caught_where_it_is)
{
    static const double torques_nm[] = {0.006, -0.006, 0.02, -0.02};
    static const int cycles[] = {10, 30, 61};
    for (size_t t = 0; t < sizeof torques_nm / sizeof torques_nm[0]; t++)
        for (size_t c = 0; c < sizeof cycles / sizeof cycles[0]; c++) {
            if ((t + c) % (size_t)sweep_stride(1, 3))
                continue;
            prepare_variant(_i);
            bench_open(&bench);
            turn(torques_nm[t], cycles[c], 5);
            MUST(&bench, torque_cycles > 100, "load %g Nm: was never enabled: %s", torques_nm[t], text_at_end);
        }
}
END_TEST

/* ---- a load that turns on when the torque comes ------------------------------------------------------------------ */

enum { KICK_AT = 5, CAUGHT_AT = 55, SETTLED_CYCLES = 40 };
static double kicked_speed, speed_before; /* counts/s */
static double hardest;                    /* counts/s in a cycle, when the servo has the motor */
static double farthest, turned_back;               /* counts */
static bool came_on;

static void kicked_program(bench_t *b)
{
    if (b->cycle == KICK_AT)
        bench_console(b, "load 1 %g", load_nm);
    if (b->cycle == CAUGHT_AT)
        bench_console(b, "load 1 0");
    power.Enable = b->cycle >= CAUGHT_AT;
    call_blocks();
    const cm1e_sim_probe_t probe = bench_probe(b, 0);
    const double sign = load_nm < 0 ? -1 : 1;
    const double speed = probe.velocity_counts_per_s * sign, position = probe.position_counts * sign;
    torque_cycles += probe.torque_on;
    if (!probe.torque_on)
        kicked_speed = speed;
    if (torque_cycles > SETTLED_CYCLES)
        hardest = fmax(hardest, speed_before - speed);
    farthest = torque_cycles > 0 ? fmax(farthest, position) : position;
    turned_back = farthest - position;
    MUST(b, torque_cycles < 2 || speed < kicked_speed + 200, "driven from %.0f to %.0f counts/s", kicked_speed, speed);
    speed_before = speed;
    came_on |= power.Status;
    MUST(b, !power.Status || fabs(speed) < 0.02 * kicked_speed, "power is on at %.0f counts/s", speed);
    MUST(b, power.Status || bench_info(b, 0).state == CM1E_AXIS_DISABLED, "%s", axis_text());
    if (b->cycle == CAUGHT_AT + 600)
        cm1e_scheduler_stop(b->scheduler);
}

START_TEST(test_a_turning_load_is_braked_before_the_axis_is_on)
{
    static const double torques_nm[] = {0.06, -0.06};
    for (size_t t = 0; t < sizeof torques_nm / sizeof torques_nm[0]; t++) {
        prepare_variant(_i);
        bench.config.axes[0].sim = (cm1e_sim_axis_config_t){.no_stops = true, .load_inertia = 3e-5};
        bench.config.axes[0].max_deceleration = 2000;
        bench.program = kicked_program;
        load_nm = torques_nm[t];
        torque_cycles = 0;
        came_on = false;
        kicked_speed = speed_before = hardest = farthest = turned_back = 0;
        bench_open(&bench);
        bench_start(&bench);
        run_to_the_end();
        const cm1e_axis_config_t *axis = &bench.config.axes[0];
        const double most = axis->max_deceleration * axis->counts_per_unit * 1e-3; /* a cycle */
        MUST(&bench, kicked_speed > 50 * most, "it only turns at %.0f counts/s", kicked_speed);
        MUST(&bench, came_on, "the axis is not on: %s", text_at_end);
        MUST(&bench, hardest < 1.5 * most, "braked by %.0f counts/s in a cycle, limit %.0f", hardest, most);
        MUST(&bench, turned_back < 200, "turned back by %.0f counts", turned_back);
    }
}
END_TEST

/* ---- what comes between while a motor is braked ----------------------------------------------------------------- */

/* From so many cycles of torque on: frames that do not come back, or a pause of the master, or one in every cycle. Or a
 * software limit. */
typedef struct interruption {
    int at, lost_frames;
    double pause_ms, load_inertia, deceleration, jerk, limit;
    bool for_ever;
} interruption_t;
static const interruption_t interruptions[] = {
    {.at = 1, .lost_frames = 1}, {.at = 2, .lost_frames = 1}, {.at = 2, .lost_frames = 2}, {.at = 3, .lost_frames = 1},
    {.at = 8, .lost_frames = 2}, {.at = 3, .pause_ms = 50}, {.at = 3, .pause_ms = 5}, {.at = 20, .pause_ms = 50},
    {.at = 8, .pause_ms = 5, .jerk = 2000}, {.load_inertia = 1e-3, .deceleration = 2000},
    {.limit = 4}, {.limit = 12}, /* units; the ramp takes 8 */
    {.at = 1, .pause_ms = 5, .for_ever = true},
};
enum { INTERRUPTIONS = sizeof interruptions / sizeof interruptions[0], THROWN_AT = 40, THROWN_SPEED = 100000 };
static const interruption_t *interruption;
static double speed_when_on;
static int on_after; /* cycles of torque */
static bool ramp_began;

static cm1e_tap_verdict_t lose_answers(bench_t *b, cm1e_tap_frame_t *frame)
{
    (void)b;
    const int since_torque = torque_cycles - interruption->at;
    const bool lost = since_torque >= 0 && since_torque < interruption->lost_frames;
    return lost && frame->direction == CM1E_TAP_RECEIVED ? CM1E_TAP_DROP : CM1E_TAP_PASS;
}

static void thrown_program(bench_t *b)
{
    if (b->cycle == THROWN_AT - 3)
        bench_drive(b, 0)->mechanics.velocity = THROWN_SPEED;
    power.Enable = b->cycle >= THROWN_AT;
    call_blocks();
    const cm1e_sim_probe_t probe = bench_probe(b, 0);
    torque_cycles += probe.torque_on;
    const bool now = torque_cycles == interruption->at || (interruption->for_ever && torque_cycles > interruption->at);
    if (probe.torque_on && now && interruption->pause_ms > 0)
        bench_miss(b, (int64_t)(interruption->pause_ms * 1e6));
    const cm1e_axis_info_t info = bench_info(b, 0);
    if (info.set_velocity != 0 && !ramp_began) {
        ramp_began = true;
        MUST(b, interruption->at > 0 || fabs(info.set_position - info.actual_position) < 0.015, "the ramp begins %.0f "
             "counts from the motor", (info.set_position - info.actual_position) * 1000);
    }
    MUST(b, interruption->limit == 0 || info.actual_position < interruption->limit, "at %g", info.actual_position);
    MUST(b, probe.velocity_counts_per_s <= THROWN_SPEED, "driven to %.0f counts/s", probe.velocity_counts_per_s);
    if (power.Status && !came_on) {
        came_on = true;
        speed_when_on = probe.velocity_counts_per_s;
        on_after = torque_cycles;
    }
    if (b->cycle == THROWN_AT + 800)
        cm1e_scheduler_stop(b->scheduler);
}

/* The axis is on when the motor rests, wherever its ramp has ended; but behind a pause before the ramp, and before a
 * software limit, the motor is caught by a standing set-point. */
START_TEST(test_what_interrupts_the_braking_of_a_turning_motor)
{
    interruption = &interruptions[_i % INTERRUPTIONS];
    prepare((cm1e_mapping_t)(_i / INTERRUPTIONS), CM1E_PDO_ORDER_UG_7_2, "1.3.5");
    cm1e_axis_config_t *axis = &bench.config.axes[0];
    axis->max_deceleration = interruption->deceleration > 0 ? interruption->deceleration : 500;
    axis->max_jerk = interruption->jerk;
    axis->software_limit_positive = interruption->limit;
    axis->software_limit_negative = -interruption->limit;
    axis->sim = (cm1e_sim_axis_config_t){
        .no_stops = true, .load_inertia = interruption->load_inertia > 0 ? interruption->load_inertia : 3e-4};
    const size_t used = strlen(bench.scene);
    snprintf(bench.scene + used, sizeof bench.scene - used, ", at %d: %d frames lost, pause of %.0f ms",
             interruption->at, interruption->lost_frames, interruption->pause_ms);
    bench.program = thrown_program;
    bench.fault = lose_answers;
    torque_cycles = 0;
    came_on = ramp_began = false;
    bench_open(&bench);
    bench_start(&bench);
    run_to_the_end();
    const bool caught = (interruption->pause_ms > 0 && interruption->at < 4) || interruption->limit == 4;
    const double rests = axis->max_deceleration * 3 + 4500; /* counts/s */
    MUST(&bench, came_on, "the axis is not on: %s", text_at_end);
    MUST(&bench, caught || fabs(speed_when_on) < rests, "power is on at %.0f counts/s", speed_when_on);
    const double ramp_cycles = THROWN_SPEED / axis->max_deceleration;
    MUST(&bench, interruption->jerk == 0 || on_after < ramp_cycles + 20, "on after %d cycles", on_after);
}
END_TEST

/* ---- pauses of the master round the enabling ---------------------------------------------------------------------- */

/* Whichever cycle before, at, or behind that of the torque is so late: the axis is on when the motor rests, not before,
 * and until then nothing drives the motor. */
enum { PAUSES_FROM = -2, PAUSES_TO = 22, LONGEST_PAUSE = 20 };
static int pause_at, pause_cycles;
static double fastest_with_torque, before_now;

static void late_program(bench_t *b)
{
    if (b->cycle == THROWN_AT - 3)
        bench_drive(b, 0)->mechanics.velocity = THROWN_SPEED;
    power.Enable = b->cycle >= THROWN_AT;
    call_blocks();
    const double speed = bench_probe(b, 0).velocity_counts_per_s;
    fastest_with_torque = fmax(fastest_with_torque, fabs(speed));
    if (power.Status && !came_on) {
        came_on = true;
        speed_when_on = fmax(fabs(speed), fabs(before_now));
    }
    before_now = speed;
    if (b->cycle == pause_at)
        bench_miss(b, pause_cycles * bench.config.cycle_time_ns);
    if (came_on ? b->cycle >= pause_at + 200 : b->cycle == THROWN_AT + 1500)
        cm1e_scheduler_stop(b->scheduler);
}

START_TEST(test_a_pause_while_a_turning_motor_gets_its_torque_turns_nothing_on)
{
    static const double loads[] = {2e-6, 3e-5, 3e-4};
    const double load = loads[_i / MAPPINGS];
    for (pause_cycles = 1; pause_cycles <= LONGEST_PAUSE; pause_cycles += sweep_stride(1, 3))
        for (pause_at = THROWN_AT + PAUSES_FROM; pause_at < THROWN_AT + PAUSES_TO; pause_at++) {
            prepare((cm1e_mapping_t)(_i % MAPPINGS), CM1E_PDO_ORDER_UG_7_2, "1.3.5");
            bench.config.axes[0].max_deceleration = 1000;
            bench.config.axes[0].sim = (cm1e_sim_axis_config_t){.no_stops = true, .load_inertia = load};
            const size_t used = strlen(bench.scene);
            snprintf(bench.scene + used, sizeof bench.scene - used, ", load %g, %d cycles late at %d", load,
                     pause_cycles, pause_at);
            came_on = false;
            fastest_with_torque = before_now = 0;
            bench.program = late_program;
            bench_open(&bench);
            bench_start(&bench);
            run_to_the_end();
            const double rests = bench.config.axes[0].max_deceleration * 3 + 4500;
            MUST(&bench, came_on, "the axis is not on: %s", text_at_end);
            MUST(&bench, speed_when_on < rests, "power is on at %.0f counts/s", speed_when_on);
            MUST(&bench, fastest_with_torque <= THROWN_SPEED, "driven to %.0f counts/s", fastest_with_torque);
        }
}
END_TEST

/* A motor that turns in the gap of its backlash while its load rests is caught where it is: no compensation pulls it. */
static void in_gap_program(bench_t *b)
{
    if (b->cycle == THROWN_AT - 3)
        bench_drive(b, 0)->mechanics.velocity = bench.config.axes[0].invert ? THROWN_SPEED / 10 : -THROWN_SPEED / 10;
    power.Enable = b->cycle >= THROWN_AT;
    call_blocks();
    torque_cycles += bench_probe(b, 0).torque_on;
    const double off = bench_info(b, 0).set_position;
    MUST(b, fabs(off) < 1e-9, "the set-point of a load that rests is at %g", off);
    if (b->cycle == THROWN_AT + 100)
        cm1e_scheduler_stop(b->scheduler);
}

START_TEST(test_a_motor_that_turns_in_its_backlash_is_caught_there)
{
    prepare((cm1e_mapping_t)(_i / 2), CM1E_PDO_ORDER_UG_7_2, "1.3.5");
    bench.config.axes[0].invert = _i % 2;
    bench.config.axes[0].backlash = 0.5;
    bench.config.axes[0].sim = (cm1e_sim_axis_config_t){.no_stops = true, .load_inertia = 3e-5};
    bench.program = in_gap_program;
    torque_cycles = 0;
    bench_open(&bench);
    bench_start(&bench);
    run_to_the_end();
    MUST(&bench, torque_cycles > 90, "not enabled: %s", text_at_end);
}
END_TEST

/* ---- frames lost or late on the way to Operation enabled ------------------------------------------------------- */

typedef enum trouble { LOST_THERE = 0, LOST_BACK, LATE_HALF, LATE_ONE, LATE_THREE, WRONG_COUNTER, TROUBLES } trouble_t;
static const int64_t late_ns[TROUBLES] = {[LATE_HALF] = 600000, [LATE_ONE] = 1100000, [LATE_THREE] = 3200000};

static trouble_t trouble;
static int trouble_cycle, trouble_cycles;

static cm1e_tap_verdict_t trouble_fault(bench_t *b, cm1e_tap_frame_t *frame)
{
    const bool now = b->cycle >= trouble_cycle && b->cycle < trouble_cycle + trouble_cycles;
    if (!now || (frame->direction == CM1E_TAP_SENT) != (trouble == LOST_THERE))
        return CM1E_TAP_PASS;
    if (trouble == LOST_THERE || trouble == LOST_BACK)
        return CM1E_TAP_DROP;
    if (trouble == WRONG_COUNTER)
        cm1e_frame_change_working_counter(frame->bytes, frame->length, 0, -1);
    frame->delay_ns = late_ns[trouble];
    return CM1E_TAP_PASS;
}

static const double trouble_loads_nm[] = {0, 0.02, -0.02};
enum { TROUBLE_LOADS = 3, ENABLE_AT = 40, ENABLE_WAY = 20 };

static void sweep_trouble(int variant, double torque_nm, int cycles)
{
    for (int cycle = ENABLE_AT - 2; cycle < ENABLE_AT + ENABLE_WAY; cycle += sweep_stride(1, 3)) {
        prepare_variant(variant);
        bench.fault = trouble_fault;
        trouble_cycle = cycle;
        trouble_cycles = cycles;
        bench_open(&bench);
        const size_t used = strlen(bench.scene);
        snprintf(bench.scene + used, sizeof bench.scene - used, ", trouble %d for %d cycles at %d", (int)trouble,
                 cycles, cycle);
        turn(torque_nm, ENABLE_AT, 6 + cycles);
        MUST(&bench, torque_cycles > 100 || strlen(text_at_end) > 20, "load %g: neither enabled nor an error",
             torque_nm);
        MUST(&bench, cycles > 2 || torque_cycles > 100, "load %g: not enabled: %s", torque_nm, text_at_end);
    }
}

START_TEST(test_trouble_with_frames_while_enabling_moves_nothing)
{
    trouble = (trouble_t)(_i % TROUBLES);
    const double torque_nm = trouble_loads_nm[_i / TROUBLES];
    static const int variants[] = {0, 1, 2, 3, VARIANTS - 4, VARIANTS - 3, VARIANTS - 2, VARIANTS - 1};
    for (size_t v = 0; v < sizeof variants / sizeof variants[0]; v += (size_t)sweep_stride(1, 3))
        for (int cycles = 1; cycles <= 4; cycles += cycles == 2 ? 2 : 1) /* 1, 2, 4: above the limit of 3 */
            sweep_trouble(variants[v], torque_nm, cycles);
}
END_TEST

/* ---- a load that hangs on the shaft while the mode changes ----------------------------------------------------------- */

static MC_Home_t home;
static double held_at, sunk;

/** From holding in the axis's own mode to homing mode, over the process data or over SDO, which takes its time. */
static void hanging_program(bench_t *b)
{
    power.Enable = TRUE;
    MC_Power(&power);
    if (b->cycle == 200)
        bench_console(b, "load 1 %g", load_nm);
    home.Execute = b->cycle >= 500;
    MC_Home(&home);
    const cm1e_sim_probe_t probe = bench_probe(b, 0);
    if (b->cycle == 499)
        held_at = probe.position_counts;
    MUST(b, b->cycle < 500 || probe.torque_on || home.Error, "no torque: %s", axis_text());
    if (b->cycle >= 500)
        sunk = fmax(sunk, fabs(probe.position_counts - held_at));
    if (probe.mode == CM1E_MODE_HM || b->cycle == 2000)
        cm1e_scheduler_stop(b->scheduler);
}

START_TEST(test_a_load_is_held_while_the_mode_changes)
{
    static const double torques_nm[] = {0.02, -0.06, 0.1};
    for (size_t t = 0; t < sizeof torques_nm / sizeof torques_nm[0]; t++) {
        prepare_variant(_i);
        bench.config.axes[0].homing = (cm1e_homing_config_t){.method = -2, .velocity = 1, .acceleration = 1000};
        home = (MC_Home_t){.Axis = &bench.axis[0]};
        load_nm = torques_nm[t];
        sunk = 0;
        bench.program = hanging_program;
        bench_open(&bench);
        bench_start(&bench);
        run_to_the_end();
        MUST(&bench, bench.cycle > 500 && bench.cycle < 1500, "homing mode was not reached: %s", text_at_end);
        MUST(&bench, sunk < (bench.witness[0].out_position < 0 ? 200 : 20), "load %g Nm: the axis sank by %.0f counts", load_nm, sunk);
    }
}
END_TEST

/* ---- Enable at random ------------------------------------------------------------------------------------------ */

enum { RANDOM_CYCLES = 20000, LOAD_REST_CYCLES = 400 };
static int quiet_cycles;

/** After a load the shaft runs out and settles; from then on nothing but Enable changes, and nothing may move. */
static void random_program(bench_t *b)
{
    if (one_in(20))
        power.Enable = !power.Enable;
    if (one_in(50))
        power.EnablePositive = !power.EnablePositive;
    if (one_in(50))
        power.EnableNegative = !power.EnableNegative;
    if (one_in(3000)) {
        bench_console(b, "load 1 %g", uniform(-0.03, 0.03));
        quiet_cycles = -pick(200) - LOAD_REST_CYCLES;
    }
    reset.Execute = one_in(3) ? !reset.Execute : reset.Execute;
    call_blocks();
    if (quiet_cycles == -LOAD_REST_CYCLES)
        bench_console(b, "load 1 0");
    if (quiet_cycles++ == 0)
        cm1e_sim_probe_reset(b->segment, 1);
    const cm1e_sim_probe_t probe = bench_probe(b, 0);
    if (quiet_cycles > 0)
        MUST(b, probe.peak_velocity_counts_per_s < 100 && probe.travel_counts < 30,
             "the shaft moved by %.2f counts, at up to %.1f counts/s", probe.travel_counts,
             probe.peak_velocity_counts_per_s);
    if (b->cycle == RANDOM_CYCLES)
        cm1e_scheduler_stop(b->scheduler);
}

START_TEST(test_enable_at_random_moves_nothing)
{
    const unsigned seed = seed_of(_i);
    chance_seed(seed);
    prepare_variant(pick(VARIANTS));
    const size_t used = strlen(bench.scene);
    snprintf(bench.scene + used, sizeof bench.scene - used, ", seed %u", seed);
    bench.config.axes[0].sim.no_stops = true;
    bench.config.axes[0].max_position_lag = 1e6; /* a shaft turned without torque is no error */
    bench.program = random_program;
    quiet_cycles = 0;
    bench_open(&bench);
    bench_start(&bench);
    run_to_the_end();
    printf("seed %u: enabled %u times\n", seed, bench.witness[0].enablings);
    MUST(&bench, bench.witness[0].enablings > 50, "enabled only %u times", bench.witness[0].enablings);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("enabling never moves");
    TCase *cases = tcase_create("enable");
    tcase_set_timeout(cases, 250);
    tcase_add_loop_test(cases, test_a_resting_shaft_stays_at_rest, 0, VARIANTS);
    tcase_add_loop_test(cases, test_the_end_of_32_bits_is_a_position_like_any_other, 0, 5 * 2 * MAPPINGS);
    tcase_add_loop_test(cases, test_a_turning_shaft_is_caught_where_it_is, 0, VARIANTS);
    tcase_add_loop_test(cases, test_a_turning_load_is_braked_before_the_axis_is_on, 0, VARIANTS);
    tcase_add_loop_test(cases, test_what_interrupts_the_braking_of_a_turning_motor, 0, INTERRUPTIONS * MAPPINGS);
    tcase_add_loop_test(cases, test_a_pause_while_a_turning_motor_gets_its_torque_turns_nothing_on, 0, 3 * MAPPINGS);
    tcase_add_loop_test(cases, test_a_motor_that_turns_in_its_backlash_is_caught_there, 0, 2 * MAPPINGS);
    tcase_add_loop_test(cases, test_trouble_with_frames_while_enabling_moves_nothing, 0, TROUBLES * TROUBLE_LOADS);
    tcase_add_loop_test(cases, test_a_load_is_held_while_the_mode_changes, 0, VARIANTS);
    tcase_add_loop_test(cases, test_enable_at_random_moves_nothing, 0, seed_count(24));
    suite_add_tcase(suite, cases);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int count = srunner_ntests_failed(runner);
    srunner_free(runner);
    return count ? EXIT_FAILURE : EXIT_SUCCESS;
}
