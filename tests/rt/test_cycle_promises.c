/* Nothing in the cycle allocates, locks, formats, writes or sleeps (promise_bench.h): enabling, homing, moves, stops,
 * faults and resets of three axes, a lost bus, the orderly end, and others at the control socket. */
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <unistd.h>

#include "cm1e/control.h"
#include "cm1e/iec.h"
#include "core/clock.h"
#include "promise_bench.h"

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

static blocks_t axes[AXES];

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
        .on = {.PT = 3 * MS_IN_NS},
        .pulse = {.PT = 5 * MS_IN_NS},
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
    promise_run(30000 * MS_IN_NS);
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
    in_real_time = true;
    promise_run(4000 * MS_IN_NS);
    over = true;
    pthread_join(thread, NULL);
    ck_assert_uint_ge(answered, 200);
    ck_assert_uint_ge(moved, 10);
    machine_close(&machine);
    rmdir(folder);
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
    suite_add_tcase(suite, all);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
