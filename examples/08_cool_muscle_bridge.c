/*
 * Four Cool Muscle motors behind one EtherCAT Cool MUSCLE Bridge, an EB12: CM1 at connectors 1 and 2, CM2 at 3 and 4.
 * All are homed at a hard stop by the bridge's own homing. Then they move together: ways of different length that
 * begin and end at the same moment, because velocity, acceleration and jerk are in proportion to the way. On the way
 * back three of them move; the fourth rests without torque, and a CML string asks it meanwhile for its K37 and its
 * status. Strings go to a motor in CML mode only, so never to one that moves by set-points (BR 7.1.1).
 *
 *     08_cool_muscle_bridge -i sim --svg bridge.svg
 *     08_cool_muscle_bridge -i eth1      an EB12 as first slave; check K37 and the hard stops below, the motors turn!
 */
#include <string.h>

#include "example.h"

#include <cm1e/cm_bridge.h>

enum { AXES = 4, RESTING = 3 };

/* Revolutions from the hard stop, away from it. */
static const struct {
    const char *name;
    int8_t method; /* 1: hard stop CW, 2: hard stop CCW (BR 6.4.1) */
    LREAL way;
} axes[AXES] = {{"left", 1, -3}, {"right", 2, 4}, {"feed", 1, -2}, {"lift", 2, 1}};

typedef enum step { STEP_POWER = 0, STEP_HOME, STEP_OUT, STEP_REST, STEP_BACK, STEP_OFF } step_t;

typedef struct unit {
    AXIS_REF_t axis;
    MC_Power_t power;
    MC_Home_t home;
    MC_MoveAbsolute_t out, back;
    LREAL homed_at, out_at; /* s */
} unit_t;

static example_t example;
static unit_t units[AXES];
static CM_SendCML_t ask = {.Axis = &units[RESTING].axis, .Command = "K37,?99"};
static step_t step;
static char answers[2][sizeof(STRING80)];
static LREAL velocity_meanwhile; /* of the first motor, u/s */
static WORD error_id;
static AXIS_REF_t wrong;

static void describe_network(cm1e_bus_config_t *config)
{
    for (int i = 0; i < AXES; i++) {
        cm1e_axis_config_t *axis = &config->axes[i];
        snprintf(axis->name, sizeof axis->name, "%s", axes[i].name);
        axis->address = 1;
        axis->channel = (uint8_t)(i + 1);
        axis->k37 = 10; /* 50,000 counts a revolution; ask yours: cm1e cml "K37.1" */
        axis->k37_stated = true;
        axis->homing.method = axes[i].method;
        axis->homing.velocity = 1;
        axis->homing.acceleration = 20;
    }
}

static void make_units(void)
{
    for (int i = 0; i < AXES; i++) {
        unit_t *u = &units[i];
        const LREAL way = axes[i].way, length = way < 0 ? -way : way;
        const MC_MoveAbsolute_t move = {.Axis = &u->axis, .Velocity = 2 * length, .Acceleration = 10 * length,
                                        .Deceleration = 10 * length, .Jerk = 200 * length};
        u->axis = cm1e_scheduler_axis(example.scheduler, (uint32_t)i);
        u->power = (MC_Power_t){.Axis = &u->axis, .EnablePositive = TRUE, .EnableNegative = TRUE};
        u->home = (MC_Home_t){.Axis = &u->axis};
        u->out = u->back = move;
        u->out.Position = way;
    }
}

static LREAL now_s(void) { return (LREAL)cm1e_scheduler_time_ns(example.scheduler) * 1e-9; }

static void fail(const unit_t *u, BOOL error, WORD id)
{
    if (!error || error_id != 0)
        return;
    error_id = id;
    wrong = u->axis;
    step = STEP_OFF;
}

static void call_blocks(unit_t *u)
{
    const BOOL rests = u == &units[RESTING] && step >= STEP_REST;
    u->power.Enable = step < STEP_OFF && !rests;
    u->home.Execute = step == STEP_HOME;
    u->out.Execute = step == STEP_OUT;
    u->back.Execute = step == STEP_BACK && !rests;
    MC_Power(&u->power);
    MC_Home(&u->home);
    MC_MoveAbsolute(&u->out);
    MC_MoveAbsolute(&u->back);
    fail(u, u->power.Error, u->power.ErrorID);
    fail(u, u->home.Error, u->home.ErrorID);
    fail(u, u->out.Error, u->out.ErrorID);
    fail(u, u->back.Error, u->back.ErrorID);
    if (u->home.Done && u->homed_at == 0)
        u->homed_at = now_s();
    if (u->out.Done && u->out_at == 0)
        u->out_at = now_s();
}

/* One line of the answer a cycle; the block keeps them until its next command. */
static void ask_the_resting_motor(void)
{
    cm1e_axis_info_t first;
    ask.Execute = step == STEP_BACK;
    CM_SendCML(&ask);
    fail(&units[RESTING], ask.Error, ask.ErrorID);
    if (!ask.Done)
        return;
    if (!answers[0][0] && cm1e_axis_read(units[0].axis, &first) == CM1E_OK)
        velocity_meanwhile = first.actual_velocity;
    const int line = ask.Line == 2;
    memcpy(answers[line], ask.Response, sizeof answers[line]);
    ask.Line = line ? 1 : 2;
}

static BOOL all(BOOL (*condition)(const unit_t *u))
{
    for (int i = 0; i < AXES; i++)
        if (!condition(&units[i]))
            return FALSE;
    return TRUE;
}
static BOOL is_on(const unit_t *u) { return u->power.Status; }
static BOOL is_off(const unit_t *u) { return !u->power.Status; }
static BOOL is_homed(const unit_t *u) { return u->home.Done; }
static BOOL is_out(const unit_t *u) { return u->out.Done; }
static BOOL rests_if_it_should(const unit_t *u) { return u != &units[RESTING] || is_off(u); }
static BOOL is_back_or_has_answered(const unit_t *u) { return u == &units[RESTING] ? answers[1][0] : u->back.Done; }

static void go_on(void)
{
    static const struct {
        const char *name;
        BOOL (*done)(const unit_t *u);
    } steps[] = {
        [STEP_POWER] = {"power", is_on}, [STEP_HOME] = {"home", is_homed}, [STEP_OUT] = {"out", is_out},
        [STEP_REST] = {"rest", rests_if_it_should}, [STEP_BACK] = {"back", is_back_or_has_answered},
        [STEP_OFF] = {"off", is_off},
    };
    if (!all(steps[step].done))
        return;
    if (step == STEP_OFF)
        example_finish(&example);
    else
        cm1e_scheduler_mark(example.scheduler, steps[++step].name);
}

static void program(void *context)
{
    (void)context;
    for (int i = 0; i < AXES; i++)
        call_blocks(&units[i]);
    ask_the_resting_motor();
    go_on();
}

static void print_report(void)
{
    printf("motor   homed after   way        arrived after\n");
    for (int i = 0; i < AXES; i++)
        printf("%-7s %8.3f s  %+5.1f rev  %10.3f s\n", axes[i].name, units[i].homed_at, axes[i].way, units[i].out_at);
    printf("%s answers %s and %s; %s moves with %.2f rev/s just then\n", axes[RESTING].name, answers[0], answers[1],
           axes[0].name, velocity_meanwhile);
}

int main(int argc, char **argv)
{
    cm1e_diag_t why = {0};
    example.axis_count = AXES;
    example.describe_network = describe_network;
    example_options(&example, argc, argv, "Four motors behind an EtherCAT Cool MUSCLE Bridge.");
    cm1e_error_t error = example_open(&example, &why);
    if (error == CM1E_OK) {
        make_units();
        error = example_run(&example, program, &why);
    }
    const bool well = example_is_done(&example, error) && error_id == 0 && answers[1][0];
    if (well)
        print_report();
    if (error_id != 0)
        example_tell_error_of(wrong, error_id);
    return example_end(&example, error, &why, well);
}
