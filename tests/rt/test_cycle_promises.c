/**
 * Nothing in the cycle allocates, locks, formats, writes or sleeps: every such function that our code could call is
 * wrapped at link time (the list is in tests/CMakeLists.txt) and counted between cm1e_bus_receive() and
 * cm1e_bus_stop(). Enabling, homing, moves, stops, faults and resets of three axes, a lost bus and the orderly end.
 */
#include <math.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include "cm1e/control.h"
#include "cm1e/iec.h"
#include "cm1e/sim.h"
#include "machine.h"

#define MS INT64_C(1000000)

static bool running; /* cm1e_scheduler_run() was called */
static _Thread_local bool in_cycle;
static unsigned violations;
static const char *violator;
static const void *caller;

static void note(const char *name, const void *from)
{
    if (!in_cycle)
        return;
    if (violations++ == 0) {
        violator = name;
        caller = from;
    }
}
#define NOTE(name) note(name, __builtin_return_address(0))

/* ---- what must not be called ----------------------------------------------------------------------------------- */

#define WRAP(TYPE, NAME, PARAMETERS, ARGUMENTS)                                                                      \
    TYPE __real_##NAME PARAMETERS;                                                                                   \
    TYPE __wrap_##NAME PARAMETERS;                                                                                   \
    TYPE __wrap_##NAME PARAMETERS                                                                                    \
    {                                                                                                                \
        NOTE(#NAME);                                                                                                 \
        return __real_##NAME ARGUMENTS;                                                                              \
    }

WRAP(void *, malloc, (size_t size), (size))
WRAP(void *, calloc, (size_t count, size_t size), (count, size))
WRAP(void *, realloc, (void *memory, size_t size), (memory, size))
WRAP(char *, strdup, (const char *text), (text))
WRAP(int, pthread_mutex_lock, (pthread_mutex_t *mutex), (mutex))
WRAP(int, pthread_cond_wait, (pthread_cond_t *condition, pthread_mutex_t *mutex), (condition, mutex))
WRAP(int, pthread_create, (pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *context),
     (thread, attributes, run, context))
WRAP(int, vsnprintf, (char *text, size_t size, const char *format, va_list args), (text, size, format, args))
WRAP(int, vfprintf, (FILE *file, const char *format, va_list args), (file, format, args))
WRAP(int, puts, (const char *text), (text))
WRAP(int, fputs, (const char *text, FILE *file), (text, file))
WRAP(size_t, fwrite, (const void *data, size_t size, size_t count, FILE *file), (data, size, count, file))
WRAP(int, fflush, (FILE *file), (file))
WRAP(ssize_t, write, (int fd, const void *data, size_t size), (fd, data, size))
WRAP(ssize_t, read, (int fd, void *data, size_t size), (fd, data, size))
WRAP(int, nanosleep, (const struct timespec *time, struct timespec *rest), (time, rest))
WRAP(int, usleep, (useconds_t us), (us))
/** In real time the wait for the next start is where a cycle ends. */
static bool in_real_time;
int __real_clock_nanosleep(clockid_t clock, int flags, const struct timespec *time, struct timespec *rest);
int __wrap_clock_nanosleep(clockid_t clock, int flags, const struct timespec *time, struct timespec *rest);
int __wrap_clock_nanosleep(clockid_t clock, int flags, const struct timespec *time, struct timespec *rest)
{
    if (in_real_time && flags == TIMER_ABSTIME)
        in_cycle = false;
    NOTE("clock_nanosleep");
    return __real_clock_nanosleep(clock, flags, time, rest);
}

void __real_free(void *memory);
void __wrap_free(void *memory);
void __wrap_free(void *memory)
{
    NOTE("free");
    __real_free(memory);
}

int __wrap_snprintf(char *text, size_t size, const char *format, ...) __attribute__((format(printf, 3, 4)));
int __wrap_snprintf(char *text, size_t size, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    NOTE("snprintf");
    const int length = __real_vsnprintf(text, size, format, args);
    va_end(args);
    return length;
}

int __wrap_printf(const char *format, ...) __attribute__((format(printf, 1, 2)));
int __wrap_printf(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    NOTE("printf");
    const int length = __real_vfprintf(stdout, format, args);
    va_end(args);
    return length;
}

int __wrap_fprintf(FILE *file, const char *format, ...) __attribute__((format(printf, 2, 3)));
int __wrap_fprintf(FILE *file, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    NOTE("fprintf");
    const int length = __real_vfprintf(file, format, args);
    va_end(args);
    return length;
}

/* ---- what the cycle is ----------------------------------------------------------------------------------------- */

cm1e_error_t __real_cm1e_bus_receive(cm1e_bus_t *bus);
cm1e_error_t __wrap_cm1e_bus_receive(cm1e_bus_t *bus);
cm1e_error_t __wrap_cm1e_bus_receive(cm1e_bus_t *bus)
{
    in_cycle = running;
    return __real_cm1e_bus_receive(bus);
}

void __real_cm1e_bus_stop(cm1e_bus_t *bus);
void __wrap_cm1e_bus_stop(cm1e_bus_t *bus);
void __wrap_cm1e_bus_stop(cm1e_bus_t *bus)
{
    running = in_cycle = false;
    __real_cm1e_bus_stop(bus);
}

/** The simulator's console formats its answer: that is the test's doing, not the cycle's. */
static void act(cm1e_bus_t *bus, const char *line)
{
    char answer[128];
    in_cycle = false;
    ck_assert_msg(cm1e_bus_simulate(bus, line, answer, sizeof answer) == CM1E_OK, "%s: %s", line, answer);
    in_cycle = true;
}

/* ---- a busy machine -------------------------------------------------------------------------------------------- */

enum { AXES = 3 };

typedef struct blocks {
    MC_Power_t power;
    MC_Reset_t reset;
    MC_Home_t home;
    MC_MoveAbsolute_t absolute;
    MC_MoveRelative_t relative;
    MC_MoveVelocity_t velocity;
    MC_Halt_t halt;
    MC_Stop_t stop;
    MC_ReadStatus_t status;
    MC_ReadActualPosition_t position;
    MC_ReadActualVelocity_t actual_velocity;
    MC_ReadAxisError_t error;
    unsigned homed, done, aborted, errors, resets;
} blocks_t;

static machine_t machine;
static blocks_t axes[AXES];
static int64_t cycle_number;

static void make_blocks(blocks_t *b, AXIS_REF_t *axis)
{
    *b = (blocks_t){
        .power = {.Axis = axis, .Enable = TRUE, .EnablePositive = TRUE, .EnableNegative = TRUE},
        .reset = {.Axis = axis},
        .home = {.Axis = axis},
        .absolute = {.Axis = axis, .Position = 6, .Velocity = 50, .Acceleration = 900},
        .relative = {.Axis = axis, .Distance = -2, .Velocity = 30, .Jerk = 90000},
        .velocity = {.Axis = axis, .Velocity = 8, .Acceleration = 500},
        .halt = {.Axis = axis},
        .stop = {.Axis = axis},
        .status = {.Axis = axis, .Enable = TRUE},
        .position = {.Axis = axis, .Enable = TRUE},
        .actual_velocity = {.Axis = axis, .Enable = TRUE},
        .error = {.Axis = axis, .Enable = TRUE},
    };
}

/** A second of every kind of motion after homing, each aborting the one before; reset whenever it helps. */
static void busy_program(void *context)
{
    blocks_t *b = context;
    const int64_t phase = cycle_number % 1000;
    b->home.Execute = b->power.Status && b->homed < 2 && !b->home.Done && !b->home.CommandAborted && !b->home.Error;
    const BOOL homed = b->homed >= 2;
    b->absolute.Execute = homed && phase < 200;
    b->relative.Execute = homed && phase >= 180 && phase < 400;
    b->velocity.Execute = homed && phase >= 400 && phase < 600;
    b->halt.Execute = homed && phase >= 600 && phase < 800;
    b->stop.Execute = homed && phase >= 850 && phase < 950;
    b->reset.Execute = b->status.ErrorStop && cycle_number % 100 < 50;
    b->power.Enable = cycle_number % 7000 != 6990;
    MC_Power(&b->power);
    MC_ReadStatus(&b->status);
    MC_Reset(&b->reset);
    MC_Home(&b->home);
    MC_MoveAbsolute(&b->absolute);
    MC_MoveRelative(&b->relative);
    MC_MoveVelocity(&b->velocity);
    MC_Halt(&b->halt);
    MC_Stop(&b->stop);
    MC_ReadActualPosition(&b->position);
    MC_ReadActualVelocity(&b->actual_velocity);
    MC_ReadAxisError(&b->error);
    b->homed += b->home.Done;
    b->done += b->absolute.Done + b->relative.Done + b->halt.Done + b->stop.Done;
    b->aborted += b->absolute.CommandAborted + b->velocity.CommandAborted;
    b->errors += b->status.ErrorStop;
    b->resets += b->reset.Done;
}

/* What moves nothing but reads, waits and switches; and a jog in what is left of the second. */
typedef struct signals {
    MC_Jog_t jog;
    MC_TouchProbe_t probe;
    MC_AbortTrigger_t abort;
    MC_DigitalCamSwitch_t cams;
    MC_ReadDigitalInput_t input;
    MC_ReadDigitalOutput_t output;
    MC_WriteDigitalOutput_t write;
    MC_ReadActualTorque_t torque;
    MC_ReadMotionState_t motion;
    MC_ReadAxisInfo_t information;
    MC_TRIGGER_REF trigger;
    MC_INPUT_REF input_ref;
    MC_OUTPUT_REF output_ref, cam_output;
    MC_CAMSWITCH_REF switches;
    TON_t on;
    TP_t pulse;
    CTU_t counter;
    unsigned jogged, recorded, written, switched;
} signals_t;

static signals_t signals[AXES];

static void make_signals(signals_t *s, AXIS_REF_t *axis)
{
    *s = (signals_t){
        .jog = {.Axis = axis},
        .probe = {.Axis = axis, .TriggerInput = &s->trigger},
        .abort = {.Axis = axis, .TriggerInput = &s->trigger},
        .cams = {.Axis = axis, .Switches = &s->switches, .Outputs = &s->cam_output, .Enable = TRUE, .EnableMask = 1,
                 .ValueSource = mcActualValue},
        .input = {.Input = &s->input_ref, .Enable = TRUE},
        .output = {.Output = &s->output_ref, .Enable = TRUE},
        .write = {.Output = &s->output_ref},
        .torque = {.Axis = axis, .Enable = TRUE},
        .motion = {.Axis = axis, .Enable = TRUE, .Source = mcActualValue},
        .information = {.Axis = axis, .Enable = TRUE},
        .trigger = {.InputNumber = 4},
        .input_ref = {.Axis = *axis, .Number = 4},
        .output_ref = {.Axis = *axis, .Number = 1},
        .switches = {.NumberOfSwitches = 1,
                     .Switches = {{.TrackNumber = 1, .FirstOnPosition = -100, .LastOnPosition = 6.01}}},
        .on = {.PT = 3 * MS},
        .pulse = {.PT = 5 * MS},
    };
}

static void signal_program(void *context)
{
    signals_t *s = context;
    const int64_t phase = cycle_number % 1000;
    s->jog.JogBackwards = phase >= 955 && phase < 990;
    s->probe.Execute = phase % 100 < 90;
    s->abort.Execute = phase % 300 == 77;
    s->write.Execute = phase % 10 < 5;
    s->write.Value = phase % 20 < 10;
    MC_Jog(&s->jog);
    MC_TouchProbe(&s->probe);
    MC_AbortTrigger(&s->abort);
    MC_DigitalCamSwitch(&s->cams);
    MC_ReadDigitalInput(&s->input);
    MC_ReadDigitalOutput(&s->output);
    MC_WriteDigitalOutput(&s->write);
    MC_ReadActualTorque(&s->torque);
    MC_ReadMotionState(&s->motion);
    MC_ReadAxisInfo(&s->information);
    s->on.IN = s->motion.ConstantVelocity;
    TON(&s->on);
    s->pulse.IN = s->on.Q;
    TP(&s->pulse);
    s->counter.CU = s->pulse.Q;
    CTU(&s->counter);
    s->jogged += s->jog.Active;
    s->recorded += s->probe.Done;
    s->written += s->write.Done;
    s->switched += s->cam_output.Values;
}

static const struct {
    int64_t cycle;
    const char *line;
} acts[] = {
    {20, "lose 1"}, {7050, "sensor 1 4 on"}, {7060, "sensor 2 4 on"}, {7070, "sensor 3 4 on"}, {8000, "power 1 off"},
    {8300, "power 1 on"}, {9050, "over-torque 2"}, {10100, "lose 2"}, {11300, "lose 40"}, {12500, "corrupt 20"},
    {13600, "delay 30 800"}, {15000, "unplug 2"}, {15500, "replug 2"}, {18000, "power-cycle 3"},
    {21000, "error 1 7500"}, {21500, "error 1 clear"}, {23000, "error 2 4310"}, {23400, "error 2 clear"},
};

static void acting_program(void *context)
{
    (void)context;
    for (size_t i = 0; i < sizeof acts / sizeof acts[0]; i++)
        if (acts[i].cycle == cycle_number)
            act(machine.bus, acts[i].line);
    cm1e_scheduler_statistics_t statistics;
    cm1e_scheduler_statistics(machine.scheduler, &statistics);
    cycle_number++;
}

START_TEST(test_cycle_calls_nothing_that_allocates_locks_formats_or_sleeps)
{
    machine = (machine_t){.axis_count = AXES, .config = {.trace_capacity = 2000}};
    machine_open(&machine);
    for (int i = 0; i < AXES; i++) {
        make_blocks(&axes[i], &machine.axis[i]);
        make_signals(&signals[i], &machine.axis[i]);
        machine_add(&machine, "", 0, 1, busy_program, &axes[i]);
        machine_add(&machine, "", 0, 1, signal_program, &signals[i]);
    }
    machine_add(&machine, "", 0, 2, acting_program, NULL);
    cycle_number = 0;
    running = true;
    machine_run(&machine, 30000 * MS);
    ck_assert_msg(violations == 0, "%u calls in the cycle; the first: %s from %p", violations, violator, caller);
    ck_assert_int_eq(cycle_number, 30000);
    unsigned errors = 0;
    for (int i = 0; i < AXES; i++) {
        ck_assert_uint_ge(axes[i].homed, 2);
        ck_assert_uint_ge(axes[i].done, 20);
        ck_assert_uint_ge(axes[i].aborted, 5);
        ck_assert_uint_ge(axes[i].resets, 1);
        errors += axes[i].errors > 0;
        ck_assert_uint_ge(signals[i].jogged, 200);
        ck_assert_uint_ge(signals[i].recorded, 1);
        ck_assert_uint_ge(signals[i].written, 1000);
        ck_assert_uint_ge(signals[i].switched, 1000);
        ck_assert_int_ge(signals[i].counter.CV, 10);
    }
    ck_assert_uint_eq(errors, AXES);
    machine_close(&machine);
}
END_TEST

/* ---- others at the control socket -------------------------------------------------------------------------------- */

enum { OWN = 0, THEIRS = 1 }; /* axes of the program, and of the others */

static atomic_bool over;
static atomic_uint answered, moved;

static bool ask(cm1e_control_t *control, const char *request)
{
    char *reply = NULL;
    const bool good = cm1e_control_ask(control, request, &reply, NULL) == CM1E_OK;
    free(reply);
    answered += good;
    return good;
}

/** Does everything that can be asked for, again and again. */
static void *guest(void *path)
{
    static const char *const requests[] = {
        "{\"request\": \"axes\"}", "{\"request\": \"slaves\"}", "{\"request\": \"statistics\"}",
        "{\"request\": \"log\"}", "{\"request\": \"record\"}", "{\"request\": \"samples\"}",
        "{\"request\": \"keep\"}", "{\"request\": \"sdo_read\", \"slave\": 2, \"index\": 4120, \"subindex\": 2}",
        "{\"request\": \"jog\", \"axis\": 1, \"velocity\": 1}", /* refused: the program moves it */
        "{\"request\": \"reset\", \"axis\": 2}",
    };
    cm1e_control_t *control = NULL;
    for (int round = 0; !over; round++) {
        if (!control && cm1e_control_connect(&control, path, NULL, NULL) != CM1E_OK)
            continue;
        ask(control, "{\"request\": \"enable\", \"axis\": 2}");
        for (size_t i = 0; i < sizeof requests / sizeof *requests; i++)
            ask(control, requests[i]);
        moved += ask(control, round % 2 ? "{\"request\": \"jog\", \"axis\": 2, \"velocity\": 1}"
                                        : "{\"request\": \"jog\", \"axis\": 2, \"velocity\": -1, \"keep_ms\": 50}");
        if (round % 16 == 7)
            ask(control, "{\"request\": \"stop\", \"axis\": 2}");
        if (round % 16 == 14)
            ask(control, "{\"request\": \"home\", \"axis\": 2}");
        if (round % 16 == 11)
            ask(control, "{\"request\": \"disable\", \"axis\": 2}");
        if (round % 16 == 15) { /* lost while the motor moves */
            cm1e_control_close(control);
            control = NULL;
        }
        usleep(round % 4 == 3 ? 60000 : 5000);
    }
    cm1e_control_close(control);
    return NULL;
}

static void turning_program(void *context)
{
    blocks_t *b = context;
    b->velocity.Execute = b->power.Status;
    MC_Power(&b->power);
    MC_MoveVelocity(&b->velocity);
}

START_TEST(test_cycle_calls_nothing_of_that_while_others_are_at_its_control_socket)
{
    static char path[128], folder[] = "/tmp/cm1e-promises-XXXXXX";
    pthread_t thread;
    ck_assert_ptr_nonnull(mkdtemp(folder));
    setenv("CM1E_RUNTIME_DIR", folder, 1);
    cm1e_control_serve_own(true);
    snprintf(path, sizeof path, "%s/cm1e-%d-0.sock", folder, (int)getpid());
    over = false;
    machine = (machine_t){.axis_count = 2, .real_time = true, .config = {.realtime_priority = -1}};
    machine_open(&machine);
    make_blocks(&axes[OWN], &machine.axis[OWN]);
    machine_add(&machine, "", 0, 1, turning_program, &axes[OWN]);
    ck_assert_int_eq(pthread_create(&thread, NULL, guest, path), 0);
    running = in_real_time = true;
    machine_run(&machine, 4000 * MS);
    over = true;
    pthread_join(thread, NULL);
    ck_assert_msg(violations == 0, "%u calls in the cycle; the first: %s from %p", violations, violator, caller);
    ck_assert_uint_ge(answered, 200);
    ck_assert_uint_ge(moved, 10);
    machine_close(&machine);
    rmdir(folder);
}
END_TEST

/* ---- an axes group ----------------------------------------------------------------------------------------------- */

static struct grouped {
    AXES_GROUP_REF_t group;
    MC_Power_t power[AXES];
    MC_AddAxisToGroup_t add[AXES];
    MC_GroupEnable_t enable;
    MC_GroupDisable_t disable;
    MC_GroupReset_t reset;
    MC_GroupReadStatus_t status;
    MC_GroupReadPosition_t position;
    MC_GroupReadVelocity_t velocity;
    MC_GroupSetOverride_t override;
    MC_MoveLinearAbsolute_t line, blended;
    MC_MoveLinearRelative_t relative;
    MC_MoveCircularRelative_t circle;
    MC_GroupHalt_t halt;
    MC_GroupStop_t stop;
    unsigned done, aborted, errors, resets;
} grouped;

/** A second of every kind of motion, each waiting for, blended with or aborting the one before. */
static void group_program(void *context)
{
    struct grouped *g = context;
    const int64_t phase = cycle_number % 1000;
    for (int i = 0; i < AXES; i++) {
        g->power[i].Enable = TRUE;
        MC_Power(&g->power[i]);
        g->add[i].Execute = TRUE;
        MC_AddAxisToGroup(&g->add[i]);
    }
    g->enable.Execute = phase >= 5 && phase < 990;
    g->disable.Execute = phase >= 995 && cycle_number % 3000 > 2900;
    g->line.Execute = phase >= 10 && phase < 600;
    g->blended.Execute = phase >= 12 && phase < 600;
    g->relative.Execute = phase >= 150 && phase < 600;
    g->circle.Execute = phase >= 160 && phase < 600;
    g->halt.Execute = phase >= 400 && phase < 600;
    g->stop.Execute = phase >= 700 && phase < 800;
    g->reset.Execute = g->status.GroupErrorStop && phase % 100 < 50;
    g->override.Enable = TRUE;
    g->override.VelFactor = phase % 200 < 100 ? 1.0 : 0.7;
    MC_GroupEnable(&g->enable);
    MC_GroupReset(&g->reset);
    MC_GroupSetOverride(&g->override);
    MC_MoveLinearAbsolute(&g->line);
    MC_MoveLinearAbsolute(&g->blended);
    MC_MoveLinearRelative(&g->relative);
    MC_MoveCircularRelative(&g->circle);
    MC_GroupHalt(&g->halt);
    MC_GroupStop(&g->stop);
    MC_GroupDisable(&g->disable);
    MC_GroupReadStatus(&g->status);
    MC_GroupReadPosition(&g->position);
    MC_GroupReadVelocity(&g->velocity);
    g->done += g->line.Done + g->blended.Done + g->halt.Done + g->stop.Done;
    g->aborted += g->relative.CommandAborted + g->circle.CommandAborted;
    g->errors += g->status.GroupErrorStop;
    g->resets += g->reset.Done;
}

START_TEST(test_an_axes_group_calls_nothing_of_that)
{
    struct grouped *g = &grouped;
    machine = (machine_t){.axis_count = AXES};
    machine_open(&machine);
    *g = (struct grouped){
        .line = {.Position = {1, 0.5}, .Velocity = 20},
        .blended = {.Position = {1, 1.5}, .Velocity = 20, .BufferMode = mcBlendingHigh,
                    .TransitionMode = mcTMMaxCornerDeviation, .TransitionParameter = 0.05},
        .relative = {.Distance = {-1, -1.5}, .Velocity = 20},
        .circle = {.AuxPoint = {1, 1}, .EndPoint = {2, 0}, .Velocity = 8, .BufferMode = mcBuffered},
        .override = {MC_GROUPSETOVERRIDE_DEFAULTS},
        .status = {.Enable = TRUE}, .position = {.Enable = TRUE}, .velocity = {.Enable = TRUE},
    };
    ck_assert_int_eq(cm1e_group_create(&g->group, NULL, NULL), CM1E_OK);
    AXES_GROUP_REF_t **const references[] = {
        &g->enable.AxesGroup, &g->disable.AxesGroup, &g->reset.AxesGroup, &g->status.AxesGroup, &g->position.AxesGroup,
        &g->velocity.AxesGroup, &g->override.AxesGroup, &g->line.AxesGroup, &g->blended.AxesGroup,
        &g->relative.AxesGroup, &g->circle.AxesGroup, &g->halt.AxesGroup, &g->stop.AxesGroup};
    for (size_t i = 0; i < sizeof references / sizeof *references; i++)
        *references[i] = &g->group;
    for (int i = 0; i < AXES; i++) {
        g->power[i] = (MC_Power_t){.Axis = &machine.axis[i], .EnablePositive = TRUE, .EnableNegative = TRUE};
        g->add[i] = (MC_AddAxisToGroup_t){.AxesGroup = &g->group, .Axis = &machine.axis[i]};
    }
    machine_add(&machine, "", 0, 1, group_program, g);
    machine_add(&machine, "", 0, 2, acting_program, NULL);
    cycle_number = 0;
    violations = 0;
    running = true;
    machine_run(&machine, 24000 * MS);
    ck_assert_msg(violations == 0, "%u calls in the cycle; the first: %s from %p", violations, violator, caller);
    ck_assert_uint_ge(g->done, 1000);
    ck_assert_uint_ge(g->aborted, 100);
    ck_assert_uint_ge(g->errors, 10);
    ck_assert_uint_ge(g->resets, 1);
    machine_close(&machine);
    ck_assert_int_eq(cm1e_group_destroy(g->group), CM1E_OK);
}
END_TEST

/* ---- slaves and masters ------------------------------------------------------------------------------------------ */

enum { WHEEL = 0, LINE, GEARED, CAMMED };
static struct coupled {
    MC_Power_t power[3];
    MC_MoveAbsolute_t line, home[2];
    MC_GearIn_t gear;
    MC_GearInPos_t gear_at;
    MC_GearOut_t gear_out;
    MC_CombineAxes_t combine;
    MC_PhasingRelative_t phasing, phasing_behind;
    MC_PhasingAbsolute_t phasing_back;
    MC_CamTableSelect_t table;
    MC_CamIn_t cam;
    MC_CamOut_t cam_out;
    MC_Reset_t reset[2];
    unsigned in_gear, in_sync, shifted, cams, lost, ended;
} coupled;

/* Four seconds: a gear and a cam of the same master, shifted, and out again; then two masters, one of them an encoder,
 * which is silent in the end. */
static void coupled_program(void *context)
{
    struct coupled *c = context;
    const int64_t phase = cycle_number++ % 4000;
    if (phase < 3800)
        (void)cm1e_axis_write_encoder(machine.axis[WHEEL], (uint32_t)(int32_t)(500.0 * sin((double)phase * 4e-3)),
                                      true);
    for (int i = 0; i < 3; i++) {
        c->power[i].Enable = TRUE;
        MC_Power(&c->power[i]);
    }
    c->line.Position = phase < 2000 ? 4.0 : 0.0;
    c->line.Execute = phase % 2000 > 60 && phase % 2000 < 1900;
    c->gear.Execute = phase > 50 && phase < 1000;
    c->gear.RatioNumerator = phase < 500 ? 1 : -1;
    c->gear.ContinuousUpdate = TRUE;
    c->phasing.Execute = phase > 300 && phase < 900;
    c->phasing_behind.Execute = phase > 301 && phase < 900;
    c->phasing_back.Execute = phase > 700 && phase < 900;
    c->gear_out.Execute = phase > 1000 && phase < 1100;
    c->home[0].Execute = (phase > 1150 && phase < 1500) || phase > 3900;
    c->gear_at.Execute = phase > 1500 && phase < 1600;
    c->combine.Execute = phase > 2100 && phase < 2500;
    c->table.Execute = phase > 20;
    c->cam.Execute = phase > 100 && phase < 3000;
    c->cam.CamTableID = c->table.CamTableID;
    c->cam_out.Execute = phase > 3000 && phase < 3100;
    c->home[1].Execute = phase > 3100;
    MC_MoveAbsolute(&c->line);
    MC_GearIn(&c->gear);
    MC_PhasingRelative(&c->phasing);
    MC_PhasingRelative(&c->phasing_behind);
    MC_PhasingAbsolute(&c->phasing_back);
    MC_GearOut(&c->gear_out);
    MC_GearInPos(&c->gear_at);
    MC_CombineAxes(&c->combine);
    MC_CamTableSelect(&c->table);
    MC_CamIn(&c->cam);
    MC_CamOut(&c->cam_out);
    for (int i = 0; i < 2; i++) {
        MC_MoveAbsolute(&c->home[i]);
        c->reset[i].Execute = phase % 500 > 450;
        MC_Reset(&c->reset[i]);
    }
    c->in_gear += c->gear.InGear;
    c->in_sync += c->combine.InSync;
    c->shifted += c->phasing_behind.Done;
    c->cams += c->cam.InSync;
    c->lost += c->combine.Error;
    c->ended += c->gear_out.Done + c->cam_out.Done;
}

START_TEST(test_slaves_and_masters_call_nothing_of_that)
{
    static const MC_CAM_POINT points[] = {{0, 0, 0, 0}, {2, 1, 0, 0}, {4, -0.5, 0, 0}, {8, 0, 0, 0}};
    static const MC_CAM_REF table = {points, 4, mcCamCubicSpline};
    struct coupled *c = &coupled;
    machine = (machine_t){.axis_count = 4, .types = {CM1E_AXIS_ENCODER, CM1E_AXIS_VIRTUAL}};
    machine_open(&machine);
    AXIS_REF_t *wheel = &machine.axis[WHEEL], *line = &machine.axis[LINE], *geared = &machine.axis[GEARED],
               *cammed = &machine.axis[CAMMED];
    *c = (struct coupled){
        .line = {.Axis = line, .Velocity = 8, .Acceleration = 100, .Jerk = 5000},
        .home = {{.Axis = geared, .Velocity = 5}, {.Axis = cammed, .Velocity = 5}},
        .gear = {.Master = line, .Slave = geared, .RatioDenominator = 2},
        .gear_at = {.Master = line, .Slave = geared, .RatioNumerator = 1, .RatioDenominator = 2, .Velocity = 5},
        .gear_out = {.Slave = geared},
        .combine = {.Master1 = line, .Master2 = wheel, .Slave = geared, .GearRatioNumeratorM1 = 1,
                    .GearRatioDenominatorM1 = 2, .GearRatioNumeratorM2 = 1, .GearRatioDenominatorM2 = 4},
        .phasing = {.Master = line, .Slave = geared, .PhaseShift = 1, .Velocity = 5},
        .phasing_behind = {.Master = line, .Slave = geared, .PhaseShift = -0.5, .Velocity = 5,
                           .BufferMode = mcBuffered},
        .phasing_back = {.Master = line, .Slave = geared, .Velocity = 5},
        .table = {.Master = line, .Slave = cammed, .CamTable = &table, .Periodic = TRUE, .MasterAbsolute = TRUE,
                  .SlaveAbsolute = TRUE},
        .cam = {.Master = line, .Slave = cammed, .StartMode = mcRampIn},
        .cam_out = {.Slave = cammed},
        .reset = {{.Axis = geared}, {.Axis = cammed}},
    };
    for (int i = 0; i < 3; i++)
        c->power[i] = (MC_Power_t){.Axis = &machine.axis[LINE + i], .EnablePositive = TRUE, .EnableNegative = TRUE};
    machine_add(&machine, "", 0, 1, coupled_program, c);
    cycle_number = 0;
    violations = 0;
    running = true;
    machine_run(&machine, 16000 * MS);
    ck_assert_msg(violations == 0, "%u calls in the cycle; the first: %s from %p", violations, violator, caller);
    ck_assert_uint_ge(c->in_gear, 1000);
    ck_assert_uint_ge(c->in_sync, 1000);
    ck_assert_uint_ge(c->shifted, 100);
    ck_assert_uint_ge(c->cams, 4000);
    ck_assert_uint_ge(c->lost, 1);
    ck_assert_uint_ge(c->ended, 100);
    machine_close(&machine);
}
END_TEST

/* ---- behind a bridge --------------------------------------------------------------------------------------------- */

static struct bridged {
    CM_SendCML_t cml;
    CM_SetMode_t mode;
    CM_Command_t command;
    MC_Power_t power;
    unsigned sent, refused, switched, powered;
} bridged;

/* Strings without an answer alone: the simulated bridge writes answers with what is counted here. */
static void bridge_program(void *context)
{
    static const char *const strings[] = {"K53.1=1", "^.1", "", "K37.1=3", "?99.2", "O2.1,F2.1"};
    const int64_t phase = cycle_number++ % 1000;
    (void)context;
    bridged.cml.Execute = phase < 600 && phase % 60 > 5;
    memcpy(bridged.cml.Command, strings[phase / 60 % 6], strlen(strings[phase / 60 % 6]) + 1);
    bridged.mode.Execute = phase > 620 && phase < 680;
    bridged.power.Enable = phase > 700 && phase < 900;
    bridged.command.Execute = phase > 950;
    CM_SendCML(&bridged.cml);
    CM_SetMode(&bridged.mode);
    CM_Command(&bridged.command);
    MC_Power(&bridged.power);
    bridged.sent += bridged.cml.Done;
    bridged.refused += bridged.cml.Error;
    bridged.switched += bridged.mode.Done;
    bridged.powered += bridged.power.Status;
}

START_TEST(test_blocks_behind_a_bridge_call_nothing_of_that)
{
    machine = (machine_t){.axis_count = 2, .bridged = true};
    machine_open(&machine);
    AXIS_REF_t *axis = &machine.axis[0];
    bridged = (struct bridged){.cml.Axis = axis, .mode.Axis = axis, .command.Axis = axis, .power.Axis = axis};
    machine_add(&machine, "", 0, 1, bridge_program, NULL);
    cycle_number = 0;
    violations = 0;
    running = true;
    machine_run(&machine, 4000 * MS);
    ck_assert_msg(violations == 0, "%u calls in the cycle; the first: %s from %p", violations, violator, caller);
    ck_assert_uint_ge(bridged.sent, 100);
    ck_assert_uint_ge(bridged.refused, 500);
    ck_assert_uint_ge(bridged.switched, 50);
    ck_assert_uint_ge(bridged.powered, 300);
    machine_close(&machine);
}
END_TEST

START_TEST(test_wrapping_works)
{
    in_cycle = true;
    char text[8];
    void *volatile memory = malloc(1);
    free(memory);
    snprintf(text, sizeof text, "%d", rand());
    in_cycle = false;
    ck_assert_uint_eq(violations, 3);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("promises of the cycle");
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 60);
    tcase_add_test(all, test_wrapping_works);
    tcase_add_test(all, test_cycle_calls_nothing_that_allocates_locks_formats_or_sleeps);
    tcase_add_test(all, test_cycle_calls_nothing_of_that_while_others_are_at_its_control_socket);
    tcase_add_test(all, test_an_axes_group_calls_nothing_of_that);
    tcase_add_test(all, test_slaves_and_masters_call_nothing_of_that);
    tcase_add_test(all, test_blocks_behind_a_bridge_call_nothing_of_that);
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
