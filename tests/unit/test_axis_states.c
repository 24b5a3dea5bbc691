/* The state diagram of PLCopen Part 1 v2.0, 2.1: every state x command, and the transitions of power, error, reset. */
#include <string.h>

#include "../support/axis_bench.h"

/* It stands under torque, and nobody asks it anything: for what follows it. */
static cm1e_axis_t *master;

void setUp(void)
{
    cm1e_diag_t diag;
    bench_start();
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_create(&master, &bus, 0, &diag));
    master->setpoint.source = &cm1e_source_hold;
    master->advanced = true;
}

void tearDown(void)
{
    bench_end();
    cm1e_axis_destroy(master);
    master = NULL;
}

static const cm1e_homing_config_t hard_stop = {.method = -1};

static void one_pair(const void *reference, int index, TIME *delta_ns, LREAL *value)
{
    (void)reference;
    (void)index;
    *delta_ns = 2000000000;
    *value = 1.0;
}

static cm1e_axis_command_t command_of(cm1e_command_kind_t kind)
{
    static const cm1e_homing_step_t block = {.kind = CM1E_STEP_BLOCK};
    static const cm1e_axis_table_t table = {.read = one_pair, .count = 1};
    static cm1e_axis_coupling_t coupling;
    const cm1e_coupling_master_t any = {.axis = cm1e_axis_reference(master), .numerator = 1, .denominator = 1};
    MC_CAM_POINT points[] = {{0, 0, 0, 0}, {1, 1, 0, 0}};
    const MC_CAM_REF cam = {points, 2, mcCamPolynomial5};
    coupling = (cm1e_axis_coupling_t){.master = {any, any}, .start_mode = mcRampIn, .master_sync_position = 5.0,
                                       .master_start_distance = kind == CM1E_COMMAND_GEAR_IN_POS ? 1.0 : 0.0};
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_cam_select(axis, &cam, false, false, false, &coupling.cam));
    const double position = kind == CM1E_COMMAND_FOLLOW_POSITION ? cm1e_axis_place(axis, false) : 2.0;
    return (cm1e_axis_command_t){.kind = kind, .position = position, .velocity = 1.0, .homing = &hard_stop,
                                 .step = &block, .table = &table, .coupling = &coupling};
}

static void raise_error(void)
{
    fake_bus_fault(&bus, 0x2310);
    bench_cycles(2);
}

static void into(cm1e_axis_state_t state)
{
    if (state == CM1E_AXIS_DISABLED)
        return;
    bench_enable();
    cm1e_axis_command_t command;
    switch (state) {
    case CM1E_AXIS_HOMING:
        command = command_of(CM1E_COMMAND_HOME);
        bench_start_command(&command);
        break;
    case CM1E_AXIS_DISCRETE_MOTION:
        bench_move_to(50.0, 1.0);
        break;
    case CM1E_AXIS_CONTINUOUS_MOTION:
        bench_move_velocity(1.0);
        break;
    case CM1E_AXIS_SYNCHRONIZED_MOTION:
        command = command_of(CM1E_COMMAND_GEAR_IN);
        bench_start_command(&command);
        break;
    case CM1E_AXIS_STOPPING:
        bench_move_velocity(1.0);
        bench_cycles(50);
        command = command_of(CM1E_COMMAND_STOP);
        bench_start_command(&command);
        break;
    case CM1E_AXIS_ERROR_STOP:
        raise_error();
        break;
    default:
        break;
    }
    bench_cycles(3);
    TEST_ASSERT_EQUAL_STRING(cm1e_axis_state_name(state), cm1e_axis_state_name(bench_info().state));
}

/* The matrix once more, by hand from the standard, so that a slip in the table shows. M: DiscreteMotion, V:
 * ContinuousMotion, F: SynchronizedMotion, S: Stopping, H: Homing; lower case: refused. */
static const char *const expected[CM1E_AXIS_STATE_COUNT] = {
    /* abs rel add vel cabs crel pprofile vprofile aprofile halt stop home step superimposed haltsuperimposed, gearin
     * gearinpos camin combine gearout camout phasing phasing follow; K: as it was */
    [CM1E_AXIS_DISABLED] = "pppppppppppppppppppppppp",
    [CM1E_AXIS_STANDSTILL] = "MMMVVVMVVMSHHMKFKFFccccF",
    [CM1E_AXIS_HOMING] = "hhhhhhhhhhShhhhhhhhhhhhh", /* that of the drive; between steps: test_axis_homing_steps */
    [CM1E_AXIS_DISCRETE_MOTION] = "MMMVVVMVVMSxxKKFKFFccccx",
    [CM1E_AXIS_CONTINUOUS_MOTION] = "MMMVVVMVVMSxxKKFKFFccccx",
    [CM1E_AXIS_SYNCHRONIZED_MOTION] = "MMMVVVMVVMSxxKKFKFFVcKKx",
    [CM1E_AXIS_STOPPING] = "ssssssssssssssssssssssss",
    [CM1E_AXIS_ERROR_STOP] = "eeeeeeeeeeeeeeeeeeeeeeee",
};

/* The diagram by its triggers, by hand from figure 2 and its notes: D: Disabled, T: Standstill, the others as above; a
 * point: it stays as it is. In the order of the states: Disabled, Standstill, Homing, Discrete, Continuous, Synchronized,
 * Stopping, ErrorStop. */
static const char *const arrows[STATE_TRIGGER_COUNT] = {
    [ON_DISCRETE] = "pMhMMMse",
    [ON_CONTINUOUS] = "pVhVVVse",
    [ON_COUPLE] = "pFhFFFse",
    [ON_DECOUPLE] = "pchccVse",
    [ON_SHIFT_PHASE] = "pchcc.se",
    [ON_FOLLOW] = "pFhxxxse",
    [ON_SUPERIMPOSE] = "pMh...se",
    [ON_HALT_SUPERIMPOSED] = "p.h...se",
    [ON_HOME] = "pHhxxxse",
    [ON_HOMING_STEP] = "pH.xxxse",
    [ON_STOP] = "pSSSSS.e",
    [ON_AT_REST] = "...TT...", /* what is led by others, stops or has failed ends in another way */
    [ON_DONE] = "..TT....",
    [ON_BROKEN_OFF] = "....MM..",
    [ON_STOP_RELEASED] = "......T.", /* note 6 */
    [ON_LED] = ".F......",
    [ON_LET_GO] = ".....T..",
    [ON_POWER_ON] = "T.......",  /* note 5 */
    [ON_POWER_OFF] = ".DDDDDD.", /* note 2 */
    [ON_ERROR] = "EEEEEEE.",     /* note 1 */
    [ON_RESET] = ".......D",     /* note 3 */
};

/* None of them aborts what runs; GEAR_IN_POS not before its master comes (4.7, note 1). */
static bool on_top(cm1e_command_kind_t kind)
{
    return kind == CM1E_COMMAND_MOVE_SUPERIMPOSED || kind == CM1E_COMMAND_HALT_SUPERIMPOSED || kind_row(kind)->plan == PLAN_PHASING ||
           kind == CM1E_COMMAND_GEAR_IN_POS;
}

static cm1e_axis_state_t accepted_state(char code, cm1e_axis_state_t state)
{
    switch (code) {
    case 'M': return CM1E_AXIS_DISCRETE_MOTION;
    case 'V': return CM1E_AXIS_CONTINUOUS_MOTION;
    case 'F': return CM1E_AXIS_SYNCHRONIZED_MOTION;
    case 'S': return CM1E_AXIS_STOPPING;
    case 'H': return CM1E_AXIS_HOMING;
    case 'D': return CM1E_AXIS_DISABLED;
    case 'T': return CM1E_AXIS_STANDSTILL;
    case 'E': return CM1E_AXIS_ERROR_STOP;
    case '.':
    case 'K': return state;
    default: return CM1E_AXIS_STATE_COUNT;
    }
}

static cm1e_error_t refusal(char code)
{
    switch (code) {
    case 'p': return CM1E_ERROR_AXIS_NOT_POWERED;
    case 'h': return CM1E_ERROR_AXIS_HOMING;
    case 'x': return CM1E_ERROR_AXIS_STATE;
    case 's': return CM1E_ERROR_AXIS_STOPPING;
    case 'c': return CM1E_ERROR_AXIS_NOT_COUPLED;
    default: return CM1E_ERROR_AXIS_ERROR_STOP;
    }
}

static void test_every_trigger_in_every_state(void)
{
    for (int trigger = 0; trigger < STATE_TRIGGER_COUNT; trigger++) {
        TEST_ASSERT_NOT_NULL(arrows[trigger]);
        TEST_ASSERT_EQUAL_size_t(CM1E_AXIS_STATE_COUNT, strlen(arrows[trigger]));
        for (int i = 0; i < CM1E_AXIS_STATE_COUNT; i++) {
            const cm1e_axis_state_t state = (cm1e_axis_state_t)i;
            const char code = arrows[trigger][i];
            const cm1e_axis_state_t goal = accepted_state(code, state);
            const bool taken = goal != CM1E_AXIS_STATE_COUNT;
            char where[64];
            snprintf(where, sizeof where, "%s, trigger %d", cm1e_axis_state_name(state), trigger);
            TEST_ASSERT_EQUAL_INT_MESSAGE(taken ? CM1E_OK : refusal(code),
                                          cm1e_axis_state_refusal(state, (state_trigger_t)trigger), where);
            axis->state = state;
            cm1e_axis_go(axis, (state_trigger_t)trigger);
            TEST_ASSERT_EQUAL_STRING_MESSAGE(cm1e_axis_state_name(taken ? goal : state),
                                             cm1e_axis_state_name(axis->state), where);
            TEST_ASSERT_TRUE_MESSAGE(taken || trigger < COMMAND_TRIGGERS, where);
        }
    }
}

static void test_every_command_in_every_state(void)
{
    for (int state = 0; state < CM1E_AXIS_STATE_COUNT; state++)
        for (int kind = 0; kind < CM1E_COMMAND_KIND_COUNT; kind++) {
            bench_start();
            into((cm1e_axis_state_t)state);
            const cm1e_command_id_t active = axis->commands.active;
            const cm1e_axis_command_t command = command_of((cm1e_command_kind_t)kind);
            cm1e_command_id_t id = 99;
            const cm1e_error_t error = cm1e_axis_start(axis, &command, &id);
            const char code = expected[state][kind];
            char where[64];
            snprintf(where, sizeof where, "%s, command %d", cm1e_axis_state_name((cm1e_axis_state_t)state), kind);
            const cm1e_axis_state_t goal = accepted_state(code, (cm1e_axis_state_t)state);
            const bool accepted = goal != CM1E_AXIS_STATE_COUNT;
            TEST_ASSERT_EQUAL_INT_MESSAGE(accepted ? CM1E_OK : refusal(code), error, where);
            const cm1e_axis_state_t next = accepted ? goal : (cm1e_axis_state_t)state;
            TEST_ASSERT_EQUAL_INT_MESSAGE(next, bench_info().state, where);
            TEST_ASSERT_EQUAL_INT_MESSAGE(accepted, id != 0, where);
            if (active) /* an accepted command aborts, a refused one does nothing */
                TEST_ASSERT_EQUAL_INT_MESSAGE(accepted && !on_top((cm1e_command_kind_t)kind) ? CM1E_COMMAND_ABORTED
                                                                                          : CM1E_COMMAND_ACTIVE,
                                              bench_state_of(active), where);
            bench_cycles(5);
            TEST_ASSERT_LESS_OR_EQUAL_INT64_MESSAGE(70, worst_step, where); /* 1 u/s is 50 counts a cycle */
        }
}

static void test_a_buffer_mode_that_is_none_is_refused(void)
{
    into(CM1E_AXIS_STANDSTILL);
    for (int kind = 0; kind < CM1E_COMMAND_KIND_COUNT; kind++) {
        cm1e_axis_command_t command = command_of((cm1e_command_kind_t)kind);
        command.buffer_mode = (MC_BUFFER_MODE)(mcBlendingHigh + 1);
        cm1e_command_id_t id;
        if (kind == CM1E_COMMAND_GEAR_IN_POS || kind == CM1E_COMMAND_CAM_IN) /* unknown yet */
            continue;
        const bool stop = kind == CM1E_COMMAND_STOP; /* has none */
        if (on_top((cm1e_command_kind_t)kind) || kind >= CM1E_COMMAND_GEAR_OUT)
            continue;
        TEST_ASSERT_EQUAL_INT(stop ? CM1E_OK : CM1E_ERROR_AXIS_BUFFER_MODE, cm1e_axis_start(axis, &command, &id));
        if (stop) {
            cm1e_axis_hold_stop(axis, id, false);
            bench_cycles(2);
        }
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    }
    const cm1e_axis_command_t unknown = {.kind = CM1E_COMMAND_KIND_COUNT};
    cm1e_command_id_t id = 5;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INVALID_ARGUMENT, cm1e_axis_start(axis, &unknown, &id));
    TEST_ASSERT_EQUAL_UINT32(0, id);
}

static void test_power_off_in_every_state(void)
{
    for (int state = 0; state < CM1E_AXIS_STATE_COUNT; state++) {
        bench_start();
        into((cm1e_axis_state_t)state);
        const cm1e_command_id_t active = axis->commands.active;
        bench_power(false);
        const bool error = state == CM1E_AXIS_ERROR_STOP;
        TEST_ASSERT_EQUAL_INT(error ? CM1E_AXIS_ERROR_STOP : CM1E_AXIS_DISABLED, bench_info().state);
        if (active)
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, bench_state_of(active));
        bench_cycles(500);
        TEST_ASSERT_FALSE(cm1e_axis_powered(axis));
        TEST_ASSERT_NOT_EQUAL_INT(OPERATION_ENABLED, bus.state);
        TEST_ASSERT_LESS_OR_EQUAL_INT64(70, worst_step);
        TEST_ASSERT_EQUAL_INT(error ? CM1E_AXIS_ERROR_STOP : CM1E_AXIS_DISABLED, bench_info().state);
    }
}

static void test_power_off_while_moving_ramps_before_torque_goes(void)
{
    bench_enable();
    bench_move_velocity(10.0);
    bench_cycles(500);
    TEST_ASSERT_EQUAL_DOUBLE(10.0, bench_info().set_velocity);
    bench_power(false);
    int ramp = 0;
    while (cm1e_axis_powered(axis) && ramp < 2000) {
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISABLED, bench_info().state);
        bench_cycles(1);
        ramp++;
    }
    TEST_ASSERT_GREATER_THAN_INT(90, ramp); /* 10 u/s at 100 u/s2 */
    TEST_ASSERT_LESS_THAN_INT(300, ramp);
    TEST_ASSERT_EQUAL_INT64(500, worst_step);
    TEST_ASSERT_LESS_OR_EQUAL_INT64(7, worst_change); /* 100 u/s2 is 5 counts a cycle each cycle */
}

static void test_power_on_again_during_the_ramp_goes_on_to_standstill(void)
{
    bench_enable();
    bench_move_velocity(10.0);
    bench_cycles(500);
    bench_power(false);
    bench_cycles(20);
    bench_power(true);
    cm1e_command_id_t id;
    const cm1e_axis_command_t move = command_of(CM1E_COMMAND_MOVE_ABSOLUTE);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_NOT_POWERED, cm1e_axis_start(axis, &move, &id));
    bench_cycles(300);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_LESS_OR_EQUAL_INT64(7, worst_change);
    TEST_ASSERT_EQUAL_INT(OPERATION_ENABLED, bus.state);
}

static void test_error_in_every_state_leads_to_error_stop_and_shows_as_error(void)
{
    for (int state = 0; state < CM1E_AXIS_ERROR_STOP; state++) {
        bench_start();
        into((cm1e_axis_state_t)state);
        const cm1e_command_id_t active = axis->commands.active;
        raise_error();
        const cm1e_axis_info_t info = bench_info();
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, info.state);
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_FAULT, info.error);
        TEST_ASSERT_EQUAL_HEX16(0x2310, info.device_error);
        TEST_ASSERT_FALSE(info.powered);
        if (active) { /* 2.2.2: Error, not CommandAborted */
            const cm1e_command_status_t status = cm1e_axis_command_status(axis, active);
            TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, status.state);
            TEST_ASSERT_EQUAL_INT(CM1E_ERROR_AXIS_ERROR_STOP, status.error);
        }
        char text[512];
        cm1e_axis_error_text(cm1e_axis_reference(axis), text, sizeof text);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, "torque overload"), text);
    }
}

static void test_reset_leads_to_disabled_and_on_to_standstill_only_with_enable(void)
{
    for (int enable = 0; enable < 2; enable++) {
        bench_start();
        into(CM1E_AXIS_ERROR_STOP);
        bench_cycles(100);
        TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
        bench_power(enable);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_reset(axis));
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, cm1e_axis_reset_state(axis, NULL));
        bench_cycles(100);
        cm1e_error_t error = CM1E_ERROR_STATE;
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, cm1e_axis_reset_state(axis, &error));
        TEST_ASSERT_EQUAL_INT(CM1E_OK, error);
        TEST_ASSERT_EQUAL_INT(enable ? CM1E_AXIS_STANDSTILL : CM1E_AXIS_DISABLED, bench_info().state);
        TEST_ASSERT_EQUAL_INT(enable, bus.state == OPERATION_ENABLED);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, bench_info().error);
        TEST_ASSERT_EQUAL_UINT(1, bus.reset_edges);
    }
}

static void test_text_names_the_cause_until_the_reset_is_done(void)
{
    char text[CM1E_AXIS_ERROR_TEXT_BYTES];
    int cycles_in_error = 0;
    into(CM1E_AXIS_ERROR_STOP);
    bench_cycles(100);
    cm1e_axis_reset(axis);
    for (int n = 0; n < 100; n++) {
        bench_inputs();
        cm1e_axis_error_text(cm1e_axis_reference(axis), text, sizeof text);
        const bool in_error = bench_info().state == CM1E_AXIS_ERROR_STOP;
        cycles_in_error += in_error;
        TEST_ASSERT_EQUAL_MESSAGE(in_error, strstr(text, "torque overload") != NULL, text);
        bench_outputs();
    }
    TEST_ASSERT_GREATER_THAN_INT(1, cycles_in_error);
    TEST_ASSERT_LESS_THAN_INT(100, cycles_in_error);
}

static void test_reset_outside_error_stop_is_done_and_harmless(void)
{
    for (int state = 0; state < CM1E_AXIS_ERROR_STOP; state++) {
        bench_start();
        into((cm1e_axis_state_t)state);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_reset(axis));
        TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, cm1e_axis_reset_state(axis, NULL));
        TEST_ASSERT_EQUAL_INT(state, bench_info().state);
        bench_cycles(3);
        TEST_ASSERT_EQUAL_UINT(0, bus.reset_edges);
    }
}

static void test_reset_that_fails_says_so_and_may_be_repeated(void)
{
    into(CM1E_AXIS_ERROR_STOP);
    bus.fault_stays = true;
    cm1e_axis_reset(axis);
    bench_cycles(2500);
    cm1e_error_t error;
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ERROR, cm1e_axis_reset_state(axis, &error));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_RESET_TIMEOUT, error);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_DRIVE_RESET_TIMEOUT, bench_info().error);
    bus.fault_stays = false;
    cm1e_axis_reset(axis);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, cm1e_axis_reset_state(axis, &error));
    TEST_ASSERT_EQUAL_INT(CM1E_OK, error); /* that of the reset before is no longer shown */
    bench_cycles(100);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, cm1e_axis_reset_state(axis, &error));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
}

static void test_reset_during_the_error_ramp_waits_for_its_end(void)
{
    bench_enable();
    bench_move_velocity(10.0);
    bench_cycles(500);
    bench_forget_steps();
    health = CM1E_ERROR_BUS_WORKING_COUNTER;
    received = CM1E_ERROR_BUS_WORKING_COUNTER;
    bench_cycles(1);
    health = received = CM1E_OK;
    cm1e_axis_reset(axis);
    bench_cycles(20);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ACTIVE, cm1e_axis_reset_state(axis, NULL));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_ERROR_STOP, bench_info().state);
    bench_cycles(300);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, cm1e_axis_reset_state(axis, NULL));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    TEST_ASSERT_EQUAL_INT64(0, worst_step); /* the target stays where a drive that hears nothing holds it */
}

static void test_stop_holds_until_done_and_released(void)
{
    into(CM1E_AXIS_STOPPING);
    const cm1e_command_id_t stop = axis->commands.active;
    bench_cycles(300);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(stop));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STOPPING, bench_info().state);
    cm1e_axis_hold_stop(axis, stop + 1, false); /* somebody else's */
    bench_cycles(3);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STOPPING, bench_info().state);
    cm1e_axis_hold_stop(axis, stop, false);
    bench_cycles(1);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
}

static void test_stop_released_early_ends_when_done(void)
{
    into(CM1E_AXIS_STOPPING);
    const cm1e_command_id_t stop = axis->commands.active;
    cm1e_axis_hold_stop(axis, stop, false);
    bench_cycles(1);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STOPPING, bench_info().state);
    const cm1e_axis_command_t command = command_of(CM1E_COMMAND_STOP); /* triggered again while it still brakes */
    const cm1e_command_id_t again = bench_start_command(&command);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, bench_state_of(stop));
    cm1e_axis_hold_stop(axis, again, false);
    bench_wait(again, 500);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(again));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
}

static void test_halt_is_discrete_motion_and_may_be_aborted(void)
{
    into(CM1E_AXIS_CONTINUOUS_MOTION);
    bench_cycles(50);
    const cm1e_axis_command_t command = command_of(CM1E_COMMAND_HALT);
    const cm1e_command_id_t halt = bench_start_command(&command);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_DISCRETE_MOTION, bench_info().state);
    bench_cycles(2);
    const cm1e_command_id_t move = bench_move_to(3.0, 2.0);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, bench_state_of(halt));
    bench_wait(move, 5000);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(move));
    TEST_ASSERT_EQUAL_DOUBLE(3.0, bench_info().set_position);
    const cm1e_command_id_t standing = bench_start_command(&command);
    bench_cycles(1);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_DONE, bench_state_of(standing));
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
}

static void test_power_has_one_owner(void)
{
    int other;
    bench_enable();
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FB_SECOND_POWER, cm1e_axis_power(axis, &other, false, false, false));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FB_SECOND_POWER, cm1e_axis_power(axis, &other, true, true, true));
    bench_cycles(5);
    TEST_ASSERT_EQUAL_INT(CM1E_AXIS_STANDSTILL, bench_info().state);
    bench_move_velocity(5.0);
    bench_cycles(200);
    bench_power(false); /* still ramping: not free yet */
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FB_SECOND_POWER, cm1e_axis_power(axis, &other, true, true, true));
    bench_cycles(300);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_axis_power(axis, &other, true, true, true));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FB_SECOND_POWER, cm1e_axis_power(axis, &owner, true, true, true));
}

static void test_commands_are_remembered_for_a_while_and_then_unknown(void)
{
    bench_enable();
    const cm1e_command_id_t first = bench_move_to(1.0, 1.0);
    for (int i = 1; i < COMMANDS_REMEMBERED; i++)
        bench_move_to(1.0 + i, 1.0);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, bench_state_of(first));
    bench_move_to(0.5, 1.0);
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_ABORTED, bench_state_of(first));
    bench_move_to(0.25, 1.0); /* what has not ended needs no memory */
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_UNKNOWN, bench_state_of(first));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_UNKNOWN, bench_state_of(0));
    TEST_ASSERT_EQUAL_INT(CM1E_COMMAND_UNKNOWN, bench_state_of(4000000000u));
    axis->commands.last_id = UINT32_MAX; /* the number after the last one is not 0 */
    TEST_ASSERT_EQUAL_UINT32(1, bench_move_to(0.6, 1.0));
}

static void test_handles_name_their_axis_only(void)
{
    const AXIS_REF_t reference = cm1e_axis_reference(axis);
    TEST_ASSERT_EQUAL_PTR(axis, cm1e_axis_from_reference(&reference));
    TEST_ASSERT_EQUAL_STRING("slide", cm1e_axis_name(reference));
    cm1e_axis_info_t info;
    for (unsigned handle = 0; handle <= UINT16_MAX; handle++) {
        const AXIS_REF_t any = {.Handle = (UINT)handle};
        if (handle == reference.Handle || handle == cm1e_axis_reference(master).Handle)
            continue;
        TEST_ASSERT_NULL(cm1e_axis_from_reference(&any));
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_FB_AXIS_REF, cm1e_axis_read(any, &info));
        TEST_ASSERT_EQUAL_STRING("", cm1e_axis_name(any));
    }
    TEST_ASSERT_NULL(cm1e_axis_from_reference(NULL));
    bench_end();
    cm1e_axis_destroy(master);
    master = NULL;
    TEST_ASSERT_NULL(cm1e_axis_from_reference(&reference));
    for (int i = 0; i < 600; i++) { /* an old handle names no newer axis, but for one turn of the count in 255 */
        bench_create();
        const AXIS_REF_t newer = cm1e_axis_reference(axis);
        TEST_ASSERT_NOT_EQUAL_UINT16(0, newer.Handle);
        TEST_ASSERT_EQUAL_PTR(axis, cm1e_axis_from_reference(&newer));
        if (i < 250)
            TEST_ASSERT_NULL(cm1e_axis_from_reference(&reference));
        bench_end();
    }
}

static void test_the_table_of_axes_is_bounded(void)
{
    static cm1e_axis_t *many[CM1E_MAX_AXES];
    cm1e_diag_t diag;
    int made = 0;
    while (made < CM1E_MAX_AXES && cm1e_axis_create(&many[made], &bus, 0, &diag) == CM1E_OK)
        made++;
    TEST_ASSERT_EQUAL_INT(CM1E_MAX_AXES - 2, made); /* and the two of the bench */
    TEST_ASSERT_NULL(many[made]);
    for (int i = 0; i < made; i++)
        cm1e_axis_destroy(many[i]);
}

static void test_shut_down_from_every_state_ends_without_torque(void)
{
    for (int state = 0; state < CM1E_AXIS_STATE_COUNT; state++) {
        bench_start();
        into((cm1e_axis_state_t)state);
        int n = 0;
        bool done = false;
        while (!done && n++ < 2000) {
            bench_inputs();
            done = cm1e_axis_shut_down(axis);
            bench_outputs();
        }
        TEST_ASSERT_TRUE(done);
        TEST_ASSERT_NOT_EQUAL_INT(OPERATION_ENABLED, bus.state);
        TEST_ASSERT_LESS_OR_EQUAL_INT64(70, worst_step);
        TEST_ASSERT_LESS_OR_EQUAL_INT64(7, worst_change);
    }
}

static void test_shut_down_of_a_dead_bus_ends(void)
{
    for (int moves = 0; moves < 2; moves++) {
        bench_start();
        bus.frozen = false;
        bench_enable();
        if (moves)
            bench_move_velocity(10.0);
        bench_cycles(500);
        received = health = CM1E_ERROR_BUS_LOST;
        bus.frozen = true;
        int n = 0;
        bool done = false;
        while (!done && n++ < 1000) {
            bench_inputs();
            done = cm1e_axis_shut_down(axis);
            bench_outputs();
        }
        TEST_ASSERT_TRUE(done);
        TEST_ASSERT_GREATER_OR_EQUAL_INT(100, n); /* ms without torque: a frame with its end may still come */
        TEST_ASSERT_EQUAL_INT(CM1E_ERROR_BUS_LOST, bench_info().error);
    }
}

static void test_state_names(void)
{
    TEST_ASSERT_EQUAL_STRING("Standstill", cm1e_axis_state_name(CM1E_AXIS_STANDSTILL));
    TEST_ASSERT_EQUAL_STRING("ErrorStop", cm1e_axis_state_name(CM1E_AXIS_ERROR_STOP));
    TEST_ASSERT_EQUAL_STRING("unknown", cm1e_axis_state_name(CM1E_AXIS_STATE_COUNT));
    TEST_ASSERT_EQUAL_STRING("unknown", cm1e_axis_state_name((cm1e_axis_state_t)-1));
}

static void test_an_axis_is_small(void) { TEST_ASSERT_LESS_THAN_size_t(5300, sizeof *axis); }

int main(void)
{
    UNITY_BEGIN();
    RUN_TEST(test_every_trigger_in_every_state);
    RUN_TEST(test_every_command_in_every_state);
    RUN_TEST(test_a_buffer_mode_that_is_none_is_refused);
    RUN_TEST(test_power_off_in_every_state);
    RUN_TEST(test_power_off_while_moving_ramps_before_torque_goes);
    RUN_TEST(test_power_on_again_during_the_ramp_goes_on_to_standstill);
    RUN_TEST(test_error_in_every_state_leads_to_error_stop_and_shows_as_error);
    RUN_TEST(test_reset_leads_to_disabled_and_on_to_standstill_only_with_enable);
    RUN_TEST(test_text_names_the_cause_until_the_reset_is_done);
    RUN_TEST(test_reset_outside_error_stop_is_done_and_harmless);
    RUN_TEST(test_reset_that_fails_says_so_and_may_be_repeated);
    RUN_TEST(test_reset_during_the_error_ramp_waits_for_its_end);
    RUN_TEST(test_stop_holds_until_done_and_released);
    RUN_TEST(test_stop_released_early_ends_when_done);
    RUN_TEST(test_halt_is_discrete_motion_and_may_be_aborted);
    RUN_TEST(test_power_has_one_owner);
    RUN_TEST(test_commands_are_remembered_for_a_while_and_then_unknown);
    RUN_TEST(test_handles_name_their_axis_only);
    RUN_TEST(test_the_table_of_axes_is_bounded);
    RUN_TEST(test_shut_down_from_every_state_ends_without_torque);
    RUN_TEST(test_shut_down_of_a_dead_bus_ends);
    RUN_TEST(test_state_names);
    RUN_TEST(test_an_axis_is_small);
    return UNITY_END();
}
