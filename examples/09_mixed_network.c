/*
 * One program for both kinds of motor: a CM1-E, an I/O module of another maker, and a CM1 and a CM2 behind an EtherCAT
 * Cool MUSCLE Bridge. Only the description of the network knows which is which; the blocks and the sequence are the
 * same for every axis. If a bridge does not support a function, the block reports that: the last step reads the torque
 * of all axes, which a bridge does not provide.
 *
 *     09_mixed_network -i sim --svg mixed.svg
 */
#include "example.h"

enum { AXES = 3 };
typedef enum step { STEP_POWER = 0, STEP_HOME, STEP_OUT, STEP_BACK, STEP_ASK, STEP_OFF } step_t;

/* Position 2 belongs to no axis: a device of another kind may stand there, and does in the simulated segment. */
static const struct {
    const char *name;
    uint16_t position;
    uint8_t channel; /* 0: a CM1-E */
    int8_t method;   /* hard stop CW: -1 of a CM1-E (UG 6.2.4), 1 of a bridge (BR 6.4.1) */
} axes[AXES] = {{"cm1e", 1, 0, -1}, {"cm1", 3, 1, 1}, {"cm2", 3, 3, 1}};

typedef struct unit {
    AXIS_REF_t axis;
    MC_Power_t power;
    MC_Home_t home;
    MC_MoveAbsolute_t out, back;
    MC_ReadActualTorque_t torque;
    LREAL out_at;       /* u, where the motor was seen */
    cm1e_error_t error; /* of MC_ReadActualTorque */
} unit_t;

static example_t example;
static unit_t units[AXES];
static step_t step;
static WORD error_id;
static AXIS_REF_t wrong;

static void describe_network(cm1e_bus_config_t *config)
{
    for (int i = 0; i < AXES; i++) {
        cm1e_axis_config_t *axis = &config->axes[i];
        snprintf(axis->name, sizeof axis->name, "%s", axes[i].name);
        axis->address = axes[i].position;
        axis->channel = axes[i].channel;
        axis->k37 = axes[i].channel ? 10 : 0;
        axis->k37_stated = axes[i].channel != 0;
        axis->homing.method = axes[i].method;
        axis->homing.velocity = 1;
        axis->homing.acceleration = 20;
    }
}

/* ---- the same for every axis ------------------------------------------------------------------------------------ */

static void make_unit(unit_t *u, uint32_t index)
{
    u->axis = cm1e_scheduler_axis(example.scheduler, index);
    u->power = (MC_Power_t){.Axis = &u->axis, .EnablePositive = TRUE, .EnableNegative = TRUE};
    u->home = (MC_Home_t){.Axis = &u->axis};
    u->out = (MC_MoveAbsolute_t){.Axis = &u->axis, .Position = -2, .Velocity = 4, .Acceleration = 20,
                                 .Deceleration = 20};
    u->back = (MC_MoveAbsolute_t){.Axis = &u->axis, .Position = -1, .Velocity = 2};
    u->torque = (MC_ReadActualTorque_t){.Axis = &u->axis};
}

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
    cm1e_axis_info_t now;
    u->power.Enable = step < STEP_OFF;
    u->home.Execute = step == STEP_HOME;
    u->out.Execute = step == STEP_OUT;
    u->back.Execute = step == STEP_BACK;
    u->torque.Enable = step == STEP_ASK;
    MC_Power(&u->power);
    MC_Home(&u->home);
    MC_MoveAbsolute(&u->out);
    MC_MoveAbsolute(&u->back);
    MC_ReadActualTorque(&u->torque);
    fail(u, u->power.Error, u->power.ErrorID);
    fail(u, u->home.Error, u->home.ErrorID);
    fail(u, u->out.Error, u->out.ErrorID);
    fail(u, u->back.Error, u->back.ErrorID);
    if (u->torque.Error)
        u->error = cm1e_error_from_id(u->torque.ErrorID);
    if (u->out.Done && step == STEP_OUT && cm1e_axis_read(u->axis, &now) == CM1E_OK)
        u->out_at = now.actual_position;
}

static BOOL is_on(const unit_t *u) { return u->power.Status; }
static BOOL is_off(const unit_t *u) { return !u->power.Status; }
static BOOL is_homed(const unit_t *u) { return u->home.Done; }
static BOOL is_out(const unit_t *u) { return u->out.Done; }
static BOOL is_back(const unit_t *u) { return u->back.Done; }
static BOOL has_answered(const unit_t *u) { return u->torque.Valid || u->torque.Error; }

static void go_on(void)
{
    static const struct {
        const char *name;
        BOOL (*done)(const unit_t *u);
    } steps[] = {
        [STEP_POWER] = {"power", is_on}, [STEP_HOME] = {"home", is_homed}, [STEP_OUT] = {"out", is_out},
        [STEP_BACK] = {"back", is_back}, [STEP_ASK] = {"torque", has_answered}, [STEP_OFF] = {"off", is_off},
    };
    for (int i = 0; i < AXES; i++)
        if (!steps[step].done(&units[i]))
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
    go_on();
}

static void print_report(void)
{
    printf("axis   seen at       torque\n");
    for (int i = 0; i < AXES; i++) {
        printf("%-5s  %8.4f rev  ", axes[i].name, units[i].out_at);
        if (units[i].error)
            printf("%s\n", cm1e_strerror(units[i].error));
        else
            printf("%.1f %%\n", units[i].torque.Torque);
    }
}

int main(int argc, char **argv)
{
    cm1e_diag_t why = {0};
    example.axis_count = AXES;
    example.describe_network = describe_network;
    example_options(&example, argc, argv, "A CM1-E and two motors behind a bridge, by the same program.");
    cm1e_error_t error = example_open(&example, &why);
    if (error == CM1E_OK) {
        for (uint32_t i = 0; i < AXES; i++)
            make_unit(&units[i], i);
        error = example_run(&example, program, &why);
    }
    if (example_is_done(&example, error) && error_id == 0)
        print_report();
    if (error_id != 0)
        example_tell_error_of(wrong, error_id);
    return example_end(&example, error, &why, error_id == 0);
}
