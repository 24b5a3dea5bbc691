/* Two motors move by the scheduler while a third one, whose slave is optional, comes, leaves and comes back at swept
 * moments: they keep their velocity to the count, the third is in ErrorStop, and has no torque before MC_Power gets a
 * new edge after MC_Reset. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cm1e/hot_connect.h"
#include "cm1e/log.h"
#include "cm1e/plcopen.h"
#include "cm1e/scheduler.h"
#include "cm1e/sim.h"
#include "core/bytes.h"
#include "effort.h"
#include "nic/nic.h"
#include "quick_check.h"
#include "sim/esc_chip.h"
#include "sim/segment.h"
#include "sim/segment_backend.h"

enum { TOOL = 3 /* place of the tool on the simulated wire, behind the others */, AXES = 3 };

typedef struct machine machine_t;
struct machine {
    cm1e_bus_t *bus;
    cm1e_scheduler_t *scheduler;
    AXIS_REF_t axis[AXES];
    MC_Power_t power[AXES];
    MC_MoveVelocity_t move[AXES];
    MC_Reset_t reset;
    void (*script)(machine_t *machine); /**< at the beginning of each cycle */
    int step, moment;
    unsigned since;                     /**< cycles since the last step */
    bool wants_power, wants_reset;
    double last[2];
    unsigned cycles, at_velocity, disturbed, torque_unasked, errors;
};

static cm1e_bus_config_t config;
static int variant; /* of the third motor: order of its process data, firmware with another unit of velocity */
static cm1e_diag_t diag;

static bool has_torque(const machine_t *machine)
{
    cm1e_sim_probe_t probe;
    cm1e_sim_probe(cm1e_bus_segment(machine->bus), TOOL, &probe);
    return probe.torque_on;
}

static cm1e_axis_info_t info_of(const machine_t *machine, int axis)
{
    cm1e_axis_info_t info;
    ck_assert_int_eq(cm1e_axis_read(machine->axis[axis], &info), CM1E_OK);
    return info;
}

/** While both turn at constant velocity, each cycle brings the same way. */
static void watch_the_others(machine_t *machine)
{
    for (int i = 0; i < 2; i++) {
        const cm1e_axis_info_t info = info_of(machine, i);
        const double way = fmod(info.set_position - machine->last[i] + 1000.0, 1000.0);
        if (machine->move[i].InVelocity) {
            machine->at_velocity++;
            machine->disturbed += machine->at_velocity > 4 && fabs(way - 0.01) > 1e-6;
        }
        machine->last[i] = info.set_position;
        machine->errors += info.error != CM1E_OK;
    }
}

static void program(void *context)
{
    machine_t *machine = context;
    const int step = machine->step;
    machine->since++;
    machine->script(machine);
    if (machine->step != step)
        machine->since = 0;
    for (int i = 0; i < AXES; i++) {
        const bool on = i < 2 || machine->wants_power;
        machine->power[i].Enable = machine->power[i].EnablePositive = machine->power[i].EnableNegative = on;
        machine->power[i].Axis = machine->move[i].Axis = &machine->axis[i];
        MC_Power(&machine->power[i]);
        machine->move[i].Execute = machine->power[i].Status;
        machine->move[i].Velocity = 10.0;
        machine->move[i].Acceleration = machine->move[i].Deceleration = 100.0;
        MC_MoveVelocity(&machine->move[i]);
    }
    machine->reset.Execute = machine->wants_reset;
    machine->reset.Axis = &machine->axis[2];
    MC_Reset(&machine->reset);
    machine->cycles++;
    watch_the_others(machine);
    machine->torque_unasked += !machine->wants_power && has_torque(machine);
}

/** `tool_velocity`: maximum of the tool, u/s; 0: as the motor has it. */
static void open_machine_of(machine_t *machine, cm1e_recover_t policy, bool absent, double tool_velocity,
                            void (*script)(machine_t *))
{
    *machine = (machine_t){.script = script};
    cm1e_bus_config_free(&config);
    cm1e_bus_config_init(&config, "sim", AXES);
    config.virtual_time = true;
    for (int i = 0; i < AXES; i++)
        config.axes[i].sim.no_stops = true;
    config.sim_pdo_order = variant & 1 ? CM1E_PDO_ORDER_UG_7_2 : CM1E_PDO_ORDER_UG_4_4;
    snprintf(config.axes[2].firmware, sizeof config.axes[2].firmware, "%s", variant & 2 ? "1.2.0" : "");
    config.axes[2].modulo_range = 1;
    config.axes[0].modulo_range = config.axes[1].modulo_range = 1000;
    config.axes[2].address_kind = CM1E_ADDRESS_EXPLICIT_ID;
    config.axes[2].address = 9;
    config.axes[2].optional = true;
    config.axes[2].recover = policy;
    config.axes[2].sim_absent = absent;
    config.axes[2].max_velocity = tool_velocity;
    ck_assert_msg(cm1e_bus_open(&machine->bus, &config, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_bus_start(machine->bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_scheduler_create(&machine->scheduler, machine->bus, NULL, &diag) == CM1E_OK, "%s", diag.text);
    for (uint32_t i = 0; i < AXES; i++)
        machine->axis[i] = cm1e_scheduler_axis(machine->scheduler, i);
    const cm1e_task_config_t task = {.name = "program", .interval_ns = 1000000, .program = program, .context = machine};
    ck_assert_int_eq(cm1e_scheduler_add_task(machine->scheduler, &task, &diag), CM1E_OK);
}

static void open_machine(machine_t *machine, cm1e_recover_t policy, bool absent, void (*script)(machine_t *))
{
    open_machine_of(machine, policy, absent, 0, script);
}

static void run(machine_t *machine, int ms)
{
    ck_assert_msg(cm1e_scheduler_run(machine->scheduler, ms * INT64_C(1000000), &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_uint_gt(machine->at_velocity, 2u * (unsigned)ms - 1000u);
    ck_assert_uint_eq(machine->disturbed, 0);
    ck_assert_uint_eq(machine->errors, 0);
}

static void close_machine(machine_t *machine)
{
    cm1e_scheduler_destroy(machine->scheduler);
    cm1e_bus_close(machine->bus);
}

static cm1e_sim_segment_t *segment(machine_t *machine) { return cm1e_bus_segment(machine->bus); }
static void pull(machine_t *machine)
{
    char answer[100];
    ck_assert_int_eq(cm1e_bus_simulate(machine->bus, "detach 3", answer, sizeof answer), CM1E_OK);
}
static cm1e_presence_t tool_is(const machine_t *machine) { return cm1e_bus_presence(machine->bus, TOOL); }

/* ---- it turns, is pulled, and comes back at a swept moment of its reset ------------------------------------------ */

enum { TURN, PULLED, BACK, RESET, PULLED_AGAIN, BACK_AGAIN, RESET_AGAIN, POWER, TURNS_AGAIN };

static void pull_and_bring_back(machine_t *machine)
{
    const cm1e_axis_info_t info = info_of(machine, 2);
    switch (machine->step) {
    case TURN:
        machine->wants_power = true;
        if (machine->since == 400) {
            ck_assert(has_torque(machine) && machine->move[2].InVelocity);
            pull(machine);
            machine->step = PULLED;
        }
        break;
    case PULLED:
    case PULLED_AGAIN:
        if (machine->since < 60)
            break;
        ck_assert(!info.online);
        ck_assert(machine->step != PULLED || (info.state == CM1E_AXIS_ERROR_STOP && machine->power[2].Error));
        machine->wants_power = machine->wants_reset = false;
        cm1e_sim_segment_attach(segment(machine), TOOL);
        machine->step++;
        break;
    case BACK:
    case BACK_AGAIN: /* in ErrorStop, or Disabled if the reset had ended before */
        ck_assert(machine->step != BACK || info.state == CM1E_AXIS_ERROR_STOP);
        if (tool_is(machine) == CM1E_PRESENCE_WAITS || tool_is(machine) == CM1E_PRESENCE_THERE) {
            machine->wants_reset = true;
            machine->step++;
        }
        break;
    case RESET: /* at every moment of coming */
        if (machine->since >= (unsigned)machine->moment) {
            pull(machine);
            machine->step = PULLED_AGAIN;
        }
        break;
    case RESET_AGAIN:
        if (machine->reset.Done) {
            machine->wants_power = true;
            machine->step = POWER;
        }
        break;
    case POWER:
        if (machine->move[2].InVelocity)
            machine->step = TURNS_AGAIN;
        break;
    default:
        break;
    }
}

START_TEST(motor_is_pulled_at_every_moment_of_its_return_and_the_others_turn_on)
{
    static const cm1e_recover_t policies[] = {CM1E_RECOVER_ASK, CM1E_RECOVER_AUTO};
    const int stride = sweep_stride(5, 31);
    for (int moment = sweep_first(_i, stride); moment < 200; moment += stride) {
        machine_t machine;
        open_machine(&machine, policies[_i], false, pull_and_bring_back);
        machine.moment = moment;
        run(&machine, 3000);
        ck_assert_msg(machine.step == TURNS_AGAIN, "moment %d: step %d", moment, machine.step);
        ck_assert_uint_eq(machine.torque_unasked, 0);
        close_machine(&machine);
    }
}
END_TEST

/* ---- its cable is loose -------------------------------------------------------------------------------------------- */

#define TOOL_VELOCITY 10.0 /* u/s: what it is commanded, and its maximum */
#define OVERSHOOT 1.0034   /* of the simulated servo by itself (docs/SAFETY.md) */

enum { LOOSE_AT = 300 /* the tool begins to turn some cycles before, and is at its velocity 100 ms later */ };

static int silent_cycles;
static double held, fastest;
static unsigned held_cycles;
static bool unheard;

/** From this moment on its slave misses some cycles, fewer than lost_cycles_limit. */
static void shake_the_cable(machine_t *machine)
{
    char answer[100];
    const cm1e_axis_info_t info = info_of(machine, 2);
    cm1e_sim_probe_t probe;
    cm1e_sim_probe(segment(machine), TOOL, &probe);
    machine->wants_power = machine->cycles > LOOSE_AT - 20;
    if (machine->cycles == (unsigned)(LOOSE_AT + machine->moment))
        ck_assert_int_eq(cm1e_bus_simulate(machine->bus, "unplug 3", answer, sizeof answer), CM1E_OK);
    if (machine->cycles == (unsigned)(LOOSE_AT + machine->moment + silent_cycles))
        ck_assert_int_eq(cm1e_bus_simulate(machine->bus, "replug 3", answer, sizeof answer), CM1E_OK);
    if (unheard) /* in the cycle before: its drive may hold the last target */
        ck_assert_double_eq(info.set_position, held);
    unheard = info.state == CM1E_AXIS_CONTINUOUS_MOTION && !info.online;
    held_cycles += unheard;
    ck_assert_int_eq(info.error, CM1E_OK);
    held = info.set_position;
    fastest = fmax(fastest, fabs(probe.velocity_counts_per_s) / 50000.0);
}

/** Its time stands still while it is not heard, so that it has nothing to catch up; the others go on. */
START_TEST(motor_with_a_loose_cable_waits_and_never_leaps)
{
    const int stride = sweep_stride(7, 29);
    silent_cycles = 1 + _i;
    for (int moment = sweep_first(_i, stride); moment < 160; moment += stride) {
        machine_t machine;
        open_machine_of(&machine, CM1E_RECOVER_ASK, false, TOOL_VELOCITY, shake_the_cable);
        machine.moment = moment;
        fastest = 0;
        held_cycles = 0;
        unheard = false;
        run(&machine, 800);
        ck_assert_msg(machine.move[2].InVelocity, "moment %d", moment);
        ck_assert_msg(held_cycles >= (unsigned)silent_cycles, "moment %d: not held", moment);
        ck_assert_msg(fastest <= TOOL_VELOCITY * OVERSHOOT, "moment %d: the shaft turns at %.4f u/s", moment, fastest);
        close_machine(&machine);
    }
}
END_TEST

/* ---- it is absent at the start ----------------------------------------------------------------------------------- */

static void power_an_absent_one(machine_t *machine)
{
    char text[CM1E_AXIS_ERROR_TEXT_BYTES];
    switch (machine->step) {
    case 0:
        ck_assert(machine->since > 1 || !info_of(machine, 2).online);
        if (machine->since == 50) { /* nobody uses it: no error */
            ck_assert_int_eq(info_of(machine, 2).state, CM1E_AXIS_DISABLED);
            machine->wants_power = true;
            machine->step = 1;
        }
        break;
    case 1:
        if (machine->since < 10)
            break;
        ck_assert(machine->power[2].Error && !machine->power[2].Status);
        cm1e_axis_error_text(machine->axis[2], text, sizeof text);
        ck_assert_msg(strstr(text, "optional and absent") != NULL, "%s", text);
        machine->wants_power = false;
        machine->wants_reset = true;
        machine->step = 2;
        break;
    case 2: /* there is nothing to reset */
        if (machine->since < 20)
            break;
        ck_assert(machine->reset.Error && !machine->reset.Busy);
        machine->wants_reset = false;
        cm1e_sim_segment_attach(segment(machine), TOOL);
        machine->step = 3;
        break;
    case 3:
        if (tool_is(machine) == CM1E_PRESENCE_WAITS) {
            machine->wants_reset = true;
            machine->step = 4;
        }
        break;
    case 4:
        if (machine->reset.Done) {
            machine->wants_power = true;
            machine->step = 5;
        }
        break;
    case 5:
        if (machine->move[2].InVelocity)
            machine->step = 6;
        break;
    default:
        break;
    }
}

static bool log_tells(const machine_t *machine, const char *words)
{
    static cm1e_log_event_t events[CM1E_LOG_EVENTS];
    const size_t count = cm1e_log_read(machine->scheduler, 0, events, CM1E_LOG_EVENTS, NULL);
    for (size_t i = 0; i < count; i++) {
        char text[512];
        cm1e_log_text(machine->scheduler, &events[i], text, sizeof text);
        if (strstr(text, words))
            return true;
    }
    return false;
}

static void reset_without_an_error(machine_t *machine)
{
    if (machine->step == 0 && machine->since == 50) {
        cm1e_sim_segment_attach(segment(machine), TOOL);
        machine->step = 1;
    } else if (machine->step == 1 && tool_is(machine) == CM1E_PRESENCE_WAITS) {
        ck_assert_int_eq(info_of(machine, 2).state, CM1E_AXIS_DISABLED);
        machine->wants_reset = true;
        machine->step = 2;
    } else if (machine->step == 2 && machine->reset.Done) {
        ck_assert_int_ne(tool_is(machine), CM1E_PRESENCE_WAITS);
        machine->wants_power = true;
        machine->step = 3;
    } else if (machine->step == 3 && machine->move[2].InVelocity) {
        machine->step = 4;
    }
}

START_TEST(reset_brings_a_motor_that_waits_to_operational_without_an_error_before)
{
    machine_t machine;
    open_machine(&machine, CM1E_RECOVER_ASK, true, reset_without_an_error);
    run(&machine, 2000);
    ck_assert_int_eq(machine.step, 4);
    ck_assert_uint_eq(machine.torque_unasked, 0);
    close_machine(&machine);
}
END_TEST

/** What it has is read when it has come: which order, which firmware. */
START_TEST(motor_that_is_absent_at_the_start_says_so_and_turns_when_it_has_come)
{
    machine_t machine;
    variant = _i;
    open_machine(&machine, CM1E_RECOVER_DEFAULT, true, power_an_absent_one);
    run(&machine, 3000);
    ck_assert_int_eq(machine.step, 6);
    ck_assert_uint_eq(machine.torque_unasked, 0);
    ck_assert(log_tells(&machine, "is optional and absent: no device with explicit device ID 9 is on the wire."));
    ck_assert(log_tells(&machine, "answers and waits for being asked: MC_Reset of its axis"));
    ck_assert(log_tells(&machine, "takes part."));
    close_machine(&machine);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("hot_connect_axes");
    TCase *tests = tcase_create("axes");
    tcase_set_timeout(tests, 120);
    tcase_add_loop_test(tests, motor_is_pulled_at_every_moment_of_its_return_and_the_others_turn_on, 0, 2);
    tcase_add_loop_test(tests, motor_with_a_loose_cable_waits_and_never_leaps, 0, 2);
    tcase_add_test(tests, reset_brings_a_motor_that_waits_to_operational_without_an_error_before);
    tcase_add_loop_test(tests, motor_that_is_absent_at_the_start_says_so_and_turns_when_it_has_come, 0, 4);
    suite_add_tcase(suite, tests);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
