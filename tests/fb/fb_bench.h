/**
 * @file fb_bench.h
 * Two sets of all blocks on one simulated axis, scanned by hand, so that a test reads from top to bottom. Every scan
 * checks on every block what PLCopen Part 1 v2.0, 2.4.1 says of its outputs. Include it once in a test program.
 */
#ifndef CM1E_TESTS_FB_BENCH_H
#define CM1E_TESTS_FB_BENCH_H

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "axes_described.h"
#include "assembly/assembly.h"
#include "axis/axis_api.h"
#include "bus/bus_image.h"
#include "cm1e/sim.h"
#include "quick_check.h"

/** The blocks of the Execute type, in the order of cm1e_command_kind_t, then MC_Reset. */
typedef enum kind { ABSOLUTE = 0, RELATIVE, VELOCITY, HALT, STOP, HOME, RESET, KINDS } kind_t;
static const char *const kind_names[KINDS] = {"MC_MoveAbsolute", "MC_MoveRelative", "MC_MoveVelocity", "MC_Halt",
                                              "MC_Stop", "MC_Home", "MC_Reset"};

/** What a block shows, the same for all. */
typedef struct shown {
    BOOL done, busy, active, aborted, error, in_velocity;
    WORD error_id;
} shown_t;

typedef struct set {
    MC_MoveAbsolute_t absolute;
    MC_MoveRelative_t relative;
    MC_MoveVelocity_t velocity;
    MC_Halt_t halt;
    MC_Stop_t stop;
    MC_Home_t home;
    MC_Reset_t reset;
} set_t;

enum { SETS = 2 };

static struct bench {
    cm1e_bus_t *bus;
    cm1e_axis_t *axis, *master;       /**< master: NULL but with bench_open_axes(2) */
    AXIS_REF_t reference, master_reference;
    MC_Power_t power, master_power;
    MC_ReadStatus_t status;
    set_t sets[SETS];
    BOOL execute[SETS][KINDS], execute_before[SETS][KINDS];
    shown_t shown[SETS][KINDS], before[SETS][KINDS];
    BOOL backwards; /**< call the blocks in the opposite order */
    int64_t start_ns, number;
    cm1e_axis_info_t info;
} bench;

#define CALL(TYPE, MEMBER, DONE, IN_VELOCITY)                                                                        \
    static shown_t call_##MEMBER(set_t *set, BOOL execute)                                                           \
    {                                                                                                                \
        TYPE##_t *fb = &set->MEMBER;                                                                                 \
        fb->Execute = execute;                                                                                       \
        TYPE(fb);                                                                                                    \
        return (shown_t){DONE, fb->Busy, fb->Active, fb->CommandAborted, fb->Error, IN_VELOCITY, fb->ErrorID};       \
    }
CALL(MC_MoveAbsolute, absolute, fb->Done, FALSE)
CALL(MC_MoveRelative, relative, fb->Done, FALSE)
CALL(MC_MoveVelocity, velocity, FALSE, fb->InVelocity)
CALL(MC_Halt, halt, fb->Done, FALSE)
CALL(MC_Stop, stop, fb->Done, FALSE)
CALL(MC_Home, home, fb->Done, FALSE)

static shown_t call_reset(set_t *set, BOOL execute)
{
    set->reset.Execute = execute;
    MC_Reset(&set->reset);
    return (shown_t){set->reset.Done, set->reset.Busy, FALSE, FALSE, set->reset.Error, FALSE, set->reset.ErrorID};
}

static shown_t (*const calls[KINDS])(set_t *set, BOOL execute) = {
    call_absolute, call_relative, call_velocity, call_halt, call_stop, call_home, call_reset};

/* ---- rules of every scan --------------------------------------------------------------------------------------- */

#define RULE(condition, rule)                                                                                        \
    do                                                                                                               \
        if (!(condition)) /* an assertion of Check that holds costs a system call */                                 \
            ck_abort_msg("%s %d, scan %lld: %s (D%d B%d A%d C%d E%d)", kind_names[kind], set,                        \
                         (long long)bench.number, rule, now->done, now->busy, now->active, now->aborted,             \
                         now->error);                                                                                \
    while (0)

static void check_rules(int set, kind_t kind)
{
    const shown_t *now = &bench.shown[set][kind], *before = &bench.before[set][kind];
    const BOOL execute = bench.execute[set][kind], edge = execute && !bench.execute_before[set][kind];
    const int results = now->done + now->aborted + now->error;
    RULE(now->done + now->busy + now->aborted + now->error <= 1, "outputs exclude each other");
    RULE(!execute || now->busy || results, "Execute and no output");
    RULE(now->error == (now->error_id != 0), "Error and ErrorID");
    RULE(kind == RESET || now->active == now->busy || (kind == STOP && now->done), "Active goes with Busy");
    RULE(!now->in_velocity || now->busy, "InVelocity only while Busy");
    RULE(!now->busy || before->busy || edge, "Busy without an edge");
    RULE(!before->busy || now->busy || results, "Busy fell and nothing rose");
    RULE(execute || !results || before->busy || edge, "a result outlives Execute");
    RULE(!edge || !now->done, "Done at the edge");
}


/* ---- scanning -------------------------------------------------------------------------------------------------- */

static void call_blocks(void)
{
    for (int n = 0; n < SETS * KINDS; n++) {
        const int place = bench.backwards ? SETS * KINDS - 1 - n : n, set = place / KINDS, kind = place % KINDS;
        bench.before[set][kind] = bench.shown[set][kind];
        bench.shown[set][kind] = calls[kind](&bench.sets[set], bench.execute[set][kind]);
        check_rules(set, (kind_t)kind);
        bench.execute_before[set][kind] = bench.execute[set][kind];
    }
}

static void scan(void)
{
    cm1e_clock_t *clock = cm1e_bus_clock(bench.bus);
    const int64_t planned_ns = bench.start_ns + bench.number++ * 1000000;
    cm1e_clock_sleep_until(clock, planned_ns);
    const cm1e_error_t received = cm1e_bus_receive(bench.bus);
    cm1e_axis_inputs(bench.axis, received, cm1e_bus_health(bench.bus), planned_ns);
    MC_Power(&bench.power);
    if (bench.master) {
        cm1e_axis_inputs(bench.master, received, cm1e_bus_health(bench.bus), planned_ns);
        MC_Power(&bench.master_power);
    }
    call_blocks();
    bench.status.Enable = TRUE;
    MC_ReadStatus(&bench.status);
    cm1e_axis_outputs(bench.axis);
    if (bench.master)
        cm1e_axis_outputs(bench.master);
    cm1e_bus_send(bench.bus);
    cm1e_axis_get(bench.axis, &bench.info);
}

static void scans(int count)
{
    while (count-- > 0)
        scan();
}

/** Scans until a condition holds, for at most 20 s. */
#define SCAN_UNTIL(condition)                                                                                        \
    do {                                                                                                             \
        int scans_left = 20000;                                                                                      \
        do                                                                                                           \
            scan();                                                                                                  \
        while (!(condition) && --scans_left);                                                                        \
        ck_assert_msg(scans_left > 0, "line %d: never " #condition ", state %s", __LINE__,                           \
                      cm1e_axis_state_name(bench.info.state));                                                       \
    } while (0)

static void simulate(const char *line)
{
    char answer[160];
    ck_assert_msg(cm1e_bus_simulate(bench.bus, line, answer, sizeof answer) == CM1E_OK, "%s: %s", line, answer);
}

/* ---- beginning and end ----------------------------------------------------------------------------------------- */

static void reset_inputs(set_t *set)
{
    AXIS_REF_t *axis = &bench.reference;
    *set = (set_t){
        .absolute = {.Axis = axis, .Position = 5, .Velocity = 10, .Acceleration = 200},
        .relative = {.Axis = axis, .Distance = 3, .Velocity = 10, .Acceleration = 200},
        .velocity = {.Axis = axis, .Velocity = 4, .Acceleration = 200},
        .halt = {.Axis = axis, .Deceleration = 50},
        .stop = {.Axis = axis, .Deceleration = 50},
        .home = {.Axis = axis},
        .reset = {.Axis = axis},
    };
}

/** One axis; with two, the second one is a master, enabled at once. */
static void bench_open_axes(uint32_t count)
{
    static cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    memset(&bench, 0, sizeof bench);
    describe_axes(&config, count);
    ck_assert_msg(cm1e_bus_open(&bench.bus, &config, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_bus_start(bench.bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_axis_create(&bench.axis, bench.bus, 0, &diag) == CM1E_OK, "%s", diag.text);
    bench.reference = cm1e_axis_reference(bench.axis);
    bench.power = (MC_Power_t){.Axis = &bench.reference, .EnablePositive = TRUE, .EnableNegative = TRUE};
    if (count > 1) {
        ck_assert_msg(cm1e_axis_create(&bench.master, bench.bus, 1, &diag) == CM1E_OK, "%s", diag.text);
        bench.master_reference = cm1e_axis_reference(bench.master);
        bench.master_power = bench.power;
        bench.master_power.Axis = &bench.master_reference;
        bench.master_power.Enable = TRUE;
    }
    bench.status = (MC_ReadStatus_t){.Axis = &bench.reference};
    for (int i = 0; i < SETS; i++)
        reset_inputs(&bench.sets[i]);
    bench.start_ns = cm1e_clock_now(cm1e_bus_clock(bench.bus));
    scan();
}

static void bench_power_on(void)
{
    bench.power.Enable = TRUE;
    SCAN_UNTIL(bench.power.Status && (!bench.master || bench.master_power.Status));
    ck_assert_int_eq(bench.info.state, CM1E_AXIS_STANDSTILL);
}

static inline void bench_open(void) { bench_open_axes(1); }
static inline void bench_open_powered(void)
{
    bench_open();
    bench_power_on();
}

static void bench_close(void)
{
    cm1e_bus_stop(bench.bus);
    cm1e_axis_destroy(bench.axis);
    if (bench.master)
        cm1e_axis_destroy(bench.master);
    cm1e_bus_close(bench.bus);
}

#endif
