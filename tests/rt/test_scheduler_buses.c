/**
 * Several buses in one scheduler: started one after the other, run in one cycle, a gear from one to the other, a
 * group with axes on both, and one that is lost. On virtual time, which they share. Single lost frames are in
 * test_buses_silence.c.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cm1e/log.h"
#include "cm1e/sim.h"
#include "cm1e/trace.h"
#include "scheduler/trace_recorder.h"
#include "two_buses.h"

enum { MOST_VELOCITY = 20, MOST_ACCELERATION = 200 }; /* u/s, u/s2 */

/** A simulated segment with so many axes, the first of them X, Y ... */
static cm1e_bus_t *open_bus(const char *name, uint32_t count, int64_t cycle_time_ns, bool virtual_time)
{
    cm1e_bus_config_t config;
    cm1e_bus_t *bus;
    cm1e_bus_config_init(&config, "sim", count);
    for (uint32_t i = 0; i < count; i++)
        snprintf(config.axes[i].name, sizeof config.axes[i].name, "%s%u", name, i + 1);
    for (uint32_t i = 0; i < count; i++)
        config.axes[i].sim.no_stops = true;
    for (uint32_t i = 0; i < count; i++) {
        config.axes[i].max_velocity = MOST_VELOCITY;
        config.axes[i].max_acceleration = MOST_ACCELERATION;
        config.axes[i].max_jerk = 20000;
    }
    config.virtual_time = virtual_time;
    config.cycle_time_ns = cycle_time_ns;
    must(cm1e_bus_open(&bus, &config, &diag));
    cm1e_bus_config_free(&config);
    return bus;
}

static void start_both(void)
{
    buses[A] = open_bus("X", 1, MS_IN_NS, true);
    buses[B] = open_bus("Y", 1, MS_IN_NS, true);
    must(cm1e_bus_start(buses[A], &diag));
    must(cm1e_bus_start(buses[B], &diag));
    open_scheduler();
}

/* ---- the program ------------------------------------------------------------------------------------------------- */

static MC_Power_t powers[BUSES];
static MC_MoveAbsolute_t moves[BUSES];
static MC_MoveVelocity_t turn;
static MC_GearIn_t gear;

static struct {
    int cycle, lose_at, lost, out_of_step; /* lose_at 0: nothing is lost */
    int lost_bus;
    bool geared;
    double worst_step[BUSES], worst_change[BUSES], before[BUSES], step[BUSES]; /* u in a cycle, and its change */
} run;

static const char *text_of(int i)
{
    static char texts[BUSES][400];
    cm1e_axis_error_text(axes[i], texts[i], sizeof texts[i]);
    return texts[i];
}

static void look(void)
{
    for (int i = 0; i < BUSES; i++) {
        const cm1e_axis_info_t info = see(i);
        const double at = info.set_position, step = at - run.before[i];
        /* Without torque the set position is where the motor is. */
        if (run.cycle > 20 && (info.state != CM1E_AXIS_ERROR_STOP || info.set_velocity != 0.0)) {
            run.worst_step[i] = fmax(run.worst_step[i], fabs(step));
            run.worst_change[i] = fmax(run.worst_change[i], fabs(step - run.step[i]));
        }
        run.before[i] = at;
        run.step[i] = step;
    }
    if (gear.InGear && run.lose_at == 0 && fabs(see(B).set_velocity - 2.0 * see(A).set_velocity) > 1e-6)
        run.out_of_step++;
}

/** Both move, or the axis on the other bus follows. */
static void program(void *context)
{
    (void)context;
    run.cycle++;
    for (int i = 0; i < BUSES; i++) {
        MC_Power(&powers[i]);
        powers[i].Enable = run.cycle > 5;
    }
    turn.Execute = gear.Execute = run.geared && powers[A].Status && powers[B].Status;
    MC_MoveVelocity(&turn);
    MC_GearIn(&gear);
    for (int i = 0; i < BUSES; i++) {
        moves[i].Execute = !run.geared && powers[i].Status;
        MC_MoveAbsolute(&moves[i]);
    }
    if (run.lose_at > 0 && run.cycle == run.lose_at) {
        char line[40];
        snprintf(line, sizeof line, "lose %d", run.lost);
        simulate(run.lost_bus, line);
    }
    look();
}

static void prepare(void)
{
    memset(&run, 0, sizeof run);
    run.lost_bus = B;
    run.lost = 100000;
    for (int i = 0; i < BUSES; i++) {
        powers[i] = (MC_Power_t){.Axis = &axes[i], .EnablePositive = TRUE, .EnableNegative = TRUE};
        moves[i] = (MC_MoveAbsolute_t){.Axis = &axes[i], .Position = 2.0 + i, .Velocity = 5};
    }
    turn = (MC_MoveVelocity_t){.Axis = &axes[A], .Velocity = 3, .Acceleration = 20, .Deceleration = 20, .Jerk = 500};
    gear = (MC_GearIn_t){.Master = &axes[A], .Slave = &axes[B], .RatioNumerator = 2, .RatioDenominator = 1};
    start_both();
    const cm1e_task_config_t task = {.name = "both", .program = program};
    must(cm1e_scheduler_add_task(scheduler, &task, &diag));
}

/* ---- tests ------------------------------------------------------------------------------------------------------- */

START_TEST(test_the_first_bus_stays_operational_while_the_second_starts)
{
    buses[A] = open_bus("X", 2, MS_IN_NS, true);
    buses[B] = open_bus("Y", 1, MS_IN_NS, true);
    must(cm1e_bus_start(buses[A], &diag));
    must(cm1e_bus_start(buses[B], &diag));
    char answer[200];
    for (int slave = 1; slave <= 2; slave++) {
        char line[40];
        snprintf(line, sizeof line, "status %d", slave);
        must(cm1e_bus_simulate(buses[A], line, answer, sizeof answer));
        ck_assert_msg(strstr(answer, ", OP,"), "%s", answer);
    }
    ck_assert_uint_gt(cm1e_bus_counters(buses[A])->cycles, 10);
    ck_assert_uint_eq(cm1e_bus_counters(buses[A])->lost_frames, 0);
    for (int i = 0; i < BUSES; i++)
        cm1e_bus_close(buses[i]);
}
END_TEST

START_TEST(test_axes_of_both_buses_move_in_one_program)
{
    prepare();
    must(cm1e_scheduler_run(scheduler, 1500 * MS_IN_NS, &diag));
    ck_assert(moves[A].Done && moves[B].Done);
    ck_assert_double_eq_tol(see(A).actual_position, 2.0, 0.002);
    ck_assert_double_eq_tol(see(B).actual_position, 3.0, 0.002);
    cm1e_scheduler_statistics_t statistics;
    cm1e_scheduler_statistics(scheduler, &statistics);
    ck_assert_uint_eq(statistics.bus.lost_frames, 0);
    ck_assert_uint_eq(statistics.overruns, 0);
    close_all();
}
END_TEST

/** Both axes are at place 1 of their bus. The recorded counts are those of the axis that has the name. */
START_TEST(test_objects_of_both_buses_are_recorded)
{
    const cm1e_scheduler_config_t config = {.trace_capacity = 1500};
    prepare();
    cm1e_scheduler_destroy(scheduler);
    must(cm1e_scheduler_create(&scheduler, buses[A], &config, &diag));
    must(cm1e_scheduler_add_bus(scheduler, buses[B], &diag));
    const cm1e_task_config_t task = {.name = "both", .program = program};
    must(cm1e_scheduler_add_task(scheduler, &task, &diag));
    const trace_t *trace = cm1e_scheduler_trace(scheduler);
    uint32_t column[BUSES];
    for (int i = 0; i < BUSES; i++) {
        axes[i] = cm1e_scheduler_axis(scheduler, (uint32_t)i);
        must(cm1e_scheduler_trace_object(scheduler, axes[i], 0x6064, 0, &diag));
        column[i] = trace->column_count - 1;
        ck_assert_msg(strncmp(trace->columns[column[i]].name, i == A ? "X1 0x6064" : "Y1 0x6064", 9) == 0, "%s",
                      trace->columns[column[i]].name);
    }
    must(cm1e_scheduler_run(scheduler, 1500 * MS_IN_NS, &diag));
    ck_assert(moves[A].Done && moves[B].Done);
    const double *last = cm1e_trace_sample(trace, trace->used - 1);
    ck_assert_double_gt(last[column[A]], 0);
    ck_assert_double_eq_tol(last[column[B]] / last[column[A]], 3.0 / 2.0, 0.003);
    close_all();
}
END_TEST

START_TEST(test_a_gear_from_one_bus_to_the_other_is_in_step)
{
    prepare();
    run.geared = true;
    must(cm1e_scheduler_run(scheduler, 1500 * MS_IN_NS, &diag));
    ck_assert_msg(gear.InGear && turn.InVelocity, "%s; %s", text_of(A), text_of(B));
    ck_assert_int_eq(run.out_of_step, 0);
    close_all();
}
END_TEST

/** An axis that is heard changes its velocity within its limits; one that is not heard keeps its target, and goes on with
 *  at most its maximum velocity. */
static void expect_no_leap(void)
{
    for (int i = 0; i < BUSES; i++) {
        ck_assert_msg(run.worst_step[i] <= MOST_VELOCITY * 1e-3 * (1 + 1e-6), "a step of %g u", run.worst_step[i]);
        ck_assert_msg(i == run.lost_bus || run.worst_change[i] <= MOST_ACCELERATION * 1e-6 * (1 + 1e-6),
                      "axis %d: a step that is %g u longer than the one before", i, run.worst_change[i]);
    }
}

START_TEST(test_a_lost_bus_concerns_its_own_axes)
{
    prepare();
    moves[A].Position = moves[B].Position = 10;
    run.lose_at = 300; /* both are on their way */
    must(cm1e_scheduler_run(scheduler, 4000 * MS_IN_NS, &diag));
    ck_assert(moves[A].Done && !moves[A].Error);
    ck_assert_double_eq_tol(see(A).actual_position, 10.0, 0.002);
    ck_assert_msg(see(B).state == CM1E_AXIS_ERROR_STOP, "%s", text_of(B));
    ck_assert_uint_eq(cm1e_bus_counters(buses[A])->lost_frames, 0);
    ck_assert_uint_ge(cm1e_bus_counters(buses[A])->cycles, 3900);
    expect_no_leap();
    close_all();
}
END_TEST

START_TEST(test_what_cannot_run_together_is_refused)
{
    prepare();
    ck_assert_int_eq(cm1e_scheduler_add_bus(scheduler, buses[B], &diag), CM1E_ERROR_INVALID_ARGUMENT);
    ck_assert_ptr_nonnull(strstr(diag.text, "in this scheduler already"));
    static const struct {
        const char *name;
        int64_t cycle_time_ns;
        bool virtual_time, started;
        const char *says;
    } others[] = {
        {"Z", MS_IN_NS / 2, true, true, "cycle_time_us differs"},
        {"Z", MS_IN_NS, false, true, "another time"},
        {"X", MS_IN_NS, true, true, "name \"X1\""},
        {"x", MS_IN_NS, true, true, "name \"x1\""},
        {"Z", MS_IN_NS, true, false, "not in operation"},
    };
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        cm1e_bus_t *bus = open_bus(others[i].name, 1, others[i].cycle_time_ns, others[i].virtual_time);
        if (others[i].started)
            must(cm1e_bus_start(bus, &diag));
        ck_assert(cm1e_scheduler_add_bus(scheduler, bus, &diag) != CM1E_OK);
        ck_assert_msg(strstr(diag.text, others[i].says), "%s", diag.text);
        cm1e_bus_close(bus);
    }
    ck_assert_int_eq(cm1e_scheduler_add_bus(scheduler, NULL, &diag), CM1E_ERROR_INVALID_ARGUMENT);
    run.cycle = 0; /* what was refused has changed nothing */
    must(cm1e_scheduler_run(scheduler, 1500 * MS_IN_NS, &diag));
    ck_assert(moves[A].Done && moves[B].Done);
    ck_assert_int_eq(cm1e_scheduler_add_bus(scheduler, buses[B], &diag), CM1E_ERROR_STATE);
    close_all();
}
END_TEST

/** Signals and a trigger of the trace would be thrown away: its columns begin with those of all axes. */
START_TEST(test_buses_come_before_the_signals_of_the_trace)
{
    static double level;
    const cm1e_scheduler_config_t with_trace = {.trace_capacity = 10};
    const cm1e_trace_trigger_t trigger = {.kind = CM1E_TRACE_ON_ERROR_STOP};
    for (int signal = 0; signal < 2; signal++) {
        cm1e_bus_t *first = open_bus("A", 1, MS_IN_NS, true), *second = open_bus("B", 1, MS_IN_NS, true);
        must(cm1e_bus_start(first, &diag));
        must(cm1e_bus_start(second, &diag));
        must(cm1e_scheduler_create(&scheduler, first, &with_trace, &diag));
        must(signal ? cm1e_scheduler_trace_variable(scheduler, "level", "mm", CM1E_TRACE_LREAL, &level, &diag)
                    : cm1e_scheduler_trace_trigger(scheduler, &trigger, &diag));
        ck_assert_int_eq(cm1e_scheduler_add_bus(scheduler, second, &diag), CM1E_ERROR_STATE);
        ck_assert_msg(strstr(diag.text, "before signals and the trigger"), "%s", diag.text);
        must(cm1e_scheduler_run(scheduler, 10 * MS_IN_NS, &diag));
        cm1e_scheduler_destroy(scheduler);
        cm1e_bus_close(first);
        cm1e_bus_close(second);
    }
}
END_TEST

/* ---- a group with an axis on each bus ---------------------------------------------------------------------------- */

static struct {
    AXES_GROUP_REF_t reference;
    MC_AddAxisToGroup_t add[BUSES];
    MC_GroupEnable_t enable;
    MC_MoveLinearAbsolute_t line, behind;
    MC_GroupStop_t stop;
    MC_GroupHalt_t halt;
    MC_GroupInterrupt_t interrupt;
    MC_GroupContinue_t go_on;
    int stop_at, halt_at, behind_at, interrupt_at, go_on_at, rest_at; /* cycles; 0: never */
    bool rested;                   /* MC_GroupInterrupt was Done before MC_GroupContinue */
    cm1e_group_info_t info;
    cm1e_axis_info_t seen[BUSES];  /* in the last cycle of the program */
    double at_rest[BUSES], latest; /* u; the position in cycle rest_at, and how far an axis went after it */
} grouped;

static void watch_rest(void)
{
    const bool rests = run.cycle >= grouped.rest_at && !(grouped.go_on_at && run.cycle > grouped.go_on_at);
    for (int i = 0; i < BUSES && rests; i++) {
        const double at = see(i).set_position;
        if (run.cycle == grouped.rest_at)
            grouped.at_rest[i] = at;
        grouped.latest = fmax(grouped.latest, fabs(at - grouped.at_rest[i]));
    }
}

static void grouped_program(void *context)
{
    (void)context;
    char line[40], answer[200];
    run.cycle++;
    for (int i = 0; i < BUSES; i++) {
        powers[i].Enable = TRUE;
        MC_Power(&powers[i]);
        grouped.add[i].Execute = TRUE;
        MC_AddAxisToGroup(&grouped.add[i]);
    }
    grouped.enable.Execute = grouped.add[A].Done && grouped.add[B].Done;
    MC_GroupEnable(&grouped.enable);
    grouped.line.Execute = grouped.enable.Done && powers[A].Status && powers[B].Status;
    MC_MoveLinearAbsolute(&grouped.line);
    grouped.stop.Execute = run.cycle == grouped.stop_at;
    MC_GroupStop(&grouped.stop);
    grouped.halt.Execute = run.cycle == grouped.halt_at;
    MC_GroupHalt(&grouped.halt);
    grouped.behind.Execute = grouped.behind_at && run.cycle >= grouped.behind_at;
    MC_MoveLinearAbsolute(&grouped.behind);
    grouped.interrupt.Execute = run.cycle == grouped.interrupt_at;
    MC_GroupInterrupt(&grouped.interrupt);
    grouped.rested = grouped.rested || grouped.interrupt.Done;
    grouped.go_on.Execute = run.cycle == grouped.go_on_at;
    MC_GroupContinue(&grouped.go_on);
    snprintf(line, sizeof line, "lose %d", run.lost);
    if (run.cycle == run.lose_at)
        must(cm1e_bus_simulate(buses[run.lost_bus], line, answer, sizeof answer));
    look();
    watch_rest();
    for (int i = 0; i < BUSES; i++)
        grouped.seen[i] = see(i);
    must(cm1e_group_read(grouped.reference, &grouped.info));
}

static void play_group(int lost)
{
    prepare();
    must(cm1e_group_create(&grouped.reference, NULL, &diag));
    for (int i = 0; i < BUSES; i++)
        grouped.add[i] = (MC_AddAxisToGroup_t){.AxesGroup = &grouped.reference, .Axis = &axes[i],
                                               .IdentInGroup = (MC_IDENT_IN_GROUP)(i + 1)};
    grouped.enable.AxesGroup = grouped.stop.AxesGroup = grouped.halt.AxesGroup = &grouped.reference;
    grouped.interrupt.AxesGroup = grouped.go_on.AxesGroup = &grouped.reference;
    grouped.line = (MC_MoveLinearAbsolute_t){.AxesGroup = &grouped.reference, .Position = {10, 5}, .Velocity = 8,
                                             .Acceleration = 50, .Deceleration = 50};
    grouped.behind = grouped.line;
    grouped.behind.Position[A] = 2;
    grouped.behind.BufferMode = mcBuffered;
    run.lost = lost;
    run.lose_at = lost ? 500 : 0;
    cm1e_scheduler_destroy(scheduler); /* that of prepare() has the other program */
    must(cm1e_scheduler_create(&scheduler, buses[A], NULL, &diag));
    must(cm1e_scheduler_add_bus(scheduler, buses[B], &diag));
    for (int i = 0; i < BUSES; i++)
        axes[i] = cm1e_scheduler_axis(scheduler, (uint32_t)i);
    must(cm1e_scheduler_add_task(scheduler, &(cm1e_task_config_t){.program = grouped_program}, &diag));
    must(cm1e_scheduler_run(scheduler, 4000 * MS_IN_NS, &diag));
    expect_no_leap();
}

static void run_group(int lost, int stop_at, int rest_at)
{
    memset(&grouped, 0, sizeof grouped);
    grouped.stop_at = stop_at;
    grouped.rest_at = rest_at;
    play_group(lost);
}

static void close_group(void)
{
    must(cm1e_group_destroy(grouped.reference));
    close_all();
}

START_TEST(test_a_group_across_buses_makes_up_what_one_of_them_loses)
{
    const int lost[] = {0, 1, 2};
    run_group(lost[_i], 0, 4000);
    ck_assert_msg(grouped.line.Done && grouped.info.state == CM1E_GROUP_STANDBY, "%s; %s", text_of(A), text_of(B));
    ck_assert_double_eq_tol(grouped.seen[A].set_position, 10.0, 1e-9);
    ck_assert_double_eq_tol(grouped.seen[B].set_position, 5.0, 1e-9);
    close_group();
}
END_TEST

START_TEST(test_behind_a_stop_no_axis_goes_back_to_the_path)
{
    run_group(2, 505, 800);
    ck_assert(grouped.line.CommandAborted && grouped.info.state == CM1E_GROUP_STANDBY);
    ck_assert_double_lt(grouped.seen[A].set_position, 9.0);
    const double off_path = grouped.seen[A].set_position - 2 * grouped.seen[B].set_position;
    ck_assert_double_gt(fabs(off_path), 1e-3);
    ck_assert_double_lt(grouped.latest, 1e-12);
    close_group();
}
END_TEST

/* Interrupted before one bus is silent, and after it. */
START_TEST(test_in_an_interruption_no_axis_goes_back_to_the_path)
{
    static const int moments[] = {490, 499, 501, 505, 530};
    memset(&grouped, 0, sizeof grouped);
    grouped.interrupt_at = moments[_i];
    grouped.rest_at = 800;
    grouped.go_on_at = 1500;
    play_group(2);
    ck_assert(grouped.rested);
    ck_assert_double_lt(grouped.at_rest[A], 9.0);
    ck_assert_double_gt(fabs(grouped.at_rest[A] - 2 * grouped.at_rest[B]), 1e-3); /* off the path */
    ck_assert_double_lt(grouped.latest, 1e-12);
    ck_assert_msg(grouped.line.Done && grouped.info.state == CM1E_GROUP_STANDBY, "%s; %s", text_of(A), text_of(B));
    ck_assert_double_eq_tol(grouped.seen[A].set_position, 10.0, 1e-9);
    ck_assert_double_eq_tol(grouped.seen[B].set_position, 5.0, 1e-9);
    close_group();
}
END_TEST

/* A gentle interruption would lead the axis that is heard far from the path that the other one has left. */
START_TEST(test_in_a_gentle_interruption_the_axes_that_are_heard_brake_with_their_limits)
{
    static const int moments[] = {490, 505};
    memset(&grouped, 0, sizeof grouped);
    grouped.interrupt_at = moments[_i];
    grouped.interrupt.Deceleration = 5;
    grouped.rest_at = 800;
    grouped.go_on_at = 1500;
    play_group(2);
    ck_assert_double_lt(fabs(grouped.at_rest[A] - 2 * grouped.at_rest[B]), 0.5);
    ck_assert_double_lt(grouped.latest, 1e-12);
    ck_assert_msg(grouped.line.Done && grouped.info.state == CM1E_GROUP_STANDBY, "%s; %s", text_of(A), text_of(B));
    close_group();
}
END_TEST

/* Stopped and halted before one bus is silent, and after it. */
START_TEST(test_in_a_gentle_stop_the_axes_that_are_heard_brake_with_their_limits)
{
    static const int moments[] = {490, 505};
    memset(&grouped, 0, sizeof grouped);
    *(_i < 2 ? &grouped.stop_at : &grouped.halt_at) = moments[_i % 2];
    grouped.stop.Deceleration = grouped.halt.Deceleration = 5;
    grouped.rest_at = 800;
    play_group(2);
    ck_assert(grouped.line.CommandAborted && grouped.info.state == CM1E_GROUP_STANDBY);
    ck_assert_double_lt(fabs(grouped.at_rest[A] - 2 * grouped.at_rest[B]), 0.5);
    ck_assert_double_lt(grouped.latest, 1e-12);
    close_group();
}
END_TEST

/* What waits behind a halt goes on when the axis is back on the path. */
START_TEST(test_what_waits_behind_a_gentle_halt_goes_on_from_the_path)
{
    static const int moments[] = {490, 505};
    memset(&grouped, 0, sizeof grouped);
    grouped.halt_at = moments[_i];
    grouped.behind_at = grouped.halt_at + 3;
    grouped.halt.Deceleration = 5;
    play_group(2);
    ck_assert(grouped.line.CommandAborted && grouped.behind.Done && grouped.info.state == CM1E_GROUP_STANDBY);
    ck_assert_double_eq_tol(grouped.seen[A].set_position, 2.0, 1e-9);
    ck_assert_double_eq_tol(grouped.seen[B].set_position, 5.0, 1e-9);
    close_group();
}
END_TEST

/* From cycle 549 to 595 the axis goes back by 0.06 u. Stop, halt and interruption come meanwhile. */
START_TEST(test_an_axis_on_its_way_back_stops_too)
{
    memset(&grouped, 0, sizeof grouped);
    *(_i == 0 ? &grouped.stop_at : _i == 1 ? &grouped.halt_at : &grouped.interrupt_at) = 557;
    grouped.rest_at = 800;
    grouped.go_on_at = 1500;
    play_group(2);
    ck_assert_double_gt(grouped.at_rest[A] - 2 * grouped.at_rest[B], 0.04); /* off the path */
    ck_assert_double_lt(grouped.latest, 1e-12);
    ck_assert(grouped.info.state == CM1E_GROUP_STANDBY);
    ck_assert(_i < 2 ? grouped.line.CommandAborted : grouped.rested && grouped.line.Done);
    if (grouped.line.Done)
        ck_assert_double_eq_tol(grouped.seen[B].set_position, 5.0, 1e-9);
    close_group();
}
END_TEST

/** Each bus has a slave 1. */
START_TEST(test_the_event_log_says_on_which_bus_it_was)
{
    static const cm1e_log_event_t events[] = {
        {.kind = CM1E_LOG_PORT, .axis = -1, .code = 1, .detail = 1u << 20 | 1},
        {.kind = CM1E_LOG_RING, .axis = -1, .code = 0, .detail = 1u << 24},
        {.kind = CM1E_LOG_EMERGENCY, .axis = -1, .code = 0x8110, .detail = 1u << 24 | 1},
        {.kind = CM1E_LOG_SLAVE, .axis = -1, .code = 0, .detail = 1, .bound = 3},
        {.kind = CM1E_LOG_STRANGER, .axis = -1, .code = 0x1234, .detail = 1u << 24 | 3},
        {.kind = CM1E_LOG_LOST_FRAMES, .axis = -1, .code = 1, .detail = 1, .value = 1},
    };
    char text[512], part[512];
    start_both();
    for (size_t i = 0; i < sizeof events / sizeof events[0]; i++) {
        cm1e_log_text(scheduler, &events[i], text, sizeof text);
        ck_assert_msg(strncmp(text, "network sim: ", 13) == 0 && strlen(text) > 20, "%s", text);
        for (size_t size = 1; size <= strlen(text) + 1; size++) { /* there is room for the beginning of it only */
            memset(part, '~', sizeof part - 1);
            part[sizeof part - 1] = '\0';
            cm1e_log_text(scheduler, &events[i], part, size);
            ck_assert_msg(strncmp(part, text, size - 1) == 0 && part[size - 1] == '\0' && part[size] == '~', "%s", part);
        }
    }
    close_all();
}
END_TEST

/** The records say which bus it was that lost frames, with the numbers of that bus. */
START_TEST(test_a_lost_bus_stops_the_whole_group)
{
    cm1e_log_event_t records[64];
    run_group(100000, 0, 1000);
    const size_t count = cm1e_log_read(scheduler, 0, records, 64, NULL);
    uint64_t told[BUSES] = {0};
    for (size_t i = 0; i < count; i++)
        if (records[i].kind == CM1E_LOG_LOST_FRAMES) {
            ck_assert(records[i].value == A || records[i].value == B);
            told[(int)records[i].value] += (uint64_t)records[i].code;
            ck_assert_uint_eq(records[i].detail, told[(int)records[i].value]);
        }
    ck_assert_uint_eq(told[A], cm1e_bus_counters(buses[A])->lost_frames);
    ck_assert_uint_eq(told[B], cm1e_bus_counters(buses[B])->lost_frames);
    ck_assert(told[A] > 0 || told[B] > 0);
    ck_assert(grouped.info.state == CM1E_GROUP_ERROR_STOP && grouped.info.error == CM1E_ERROR_GROUP_AXIS);
    ck_assert_msg(grouped.seen[A].state == CM1E_AXIS_STANDSTILL && grouped.seen[A].powered, "%s", text_of(A));
    ck_assert_msg(grouped.seen[B].state == CM1E_AXIS_ERROR_STOP, "%s", text_of(B));
    ck_assert_double_lt(grouped.seen[A].set_position, 9.0);
    ck_assert_double_lt(grouped.latest, 1e-12);
    close_group();
}
END_TEST

int main(void)
{
    TCase *all = tcase_create("several buses");
    tcase_add_test(all, test_the_first_bus_stays_operational_while_the_second_starts);
    tcase_add_test(all, test_axes_of_both_buses_move_in_one_program);
    tcase_add_test(all, test_objects_of_both_buses_are_recorded);
    tcase_add_test(all, test_a_gear_from_one_bus_to_the_other_is_in_step);
    tcase_add_test(all, test_a_lost_bus_concerns_its_own_axes);
    tcase_add_test(all, test_what_cannot_run_together_is_refused);
    tcase_add_test(all, test_buses_come_before_the_signals_of_the_trace);
    tcase_add_test(all, test_the_event_log_says_on_which_bus_it_was);
    tcase_add_loop_test(all, test_a_group_across_buses_makes_up_what_one_of_them_loses, 0, 3);
    tcase_add_test(all, test_behind_a_stop_no_axis_goes_back_to_the_path);
    tcase_add_loop_test(all, test_in_an_interruption_no_axis_goes_back_to_the_path, 0, 5);
    tcase_add_loop_test(all, test_in_a_gentle_interruption_the_axes_that_are_heard_brake_with_their_limits, 0, 2);
    tcase_add_loop_test(all, test_in_a_gentle_stop_the_axes_that_are_heard_brake_with_their_limits, 0, 4);
    tcase_add_loop_test(all, test_what_waits_behind_a_gentle_halt_goes_on_from_the_path, 0, 2);
    tcase_add_loop_test(all, test_an_axis_on_its_way_back_stops_too, 0, 3);
    tcase_add_test(all, test_a_lost_bus_stops_the_whole_group);
    Suite *suite = suite_create("scheduler with several buses");
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
