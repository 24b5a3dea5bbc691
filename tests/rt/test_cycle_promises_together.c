/* Nothing in the cycle allocates, locks, formats, writes or sleeps (promise_bench.h): an axes group, slaves and
 * masters, blocks behind a bridge. */
#include <math.h>
#include <stdlib.h>

#include "core/clock.h"
#include "promise_bench.h"

enum { AXES = 3 };

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
    MC_GroupInterrupt_t interrupt;
    MC_GroupContinue_t go_on;
    unsigned done, aborted, errors, resets, interrupted;
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
    g->interrupt.Execute = (phase >= 30 && phase < 60) || (phase >= 190 && phase < 220);
    g->go_on.Execute = (phase >= 65 && phase < 70) || (phase >= 195 && phase < 200);
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
    MC_GroupInterrupt(&g->interrupt);
    MC_GroupContinue(&g->go_on);
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
    g->interrupted += g->go_on.Done;
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
        &g->relative.AxesGroup, &g->circle.AxesGroup, &g->halt.AxesGroup, &g->stop.AxesGroup,
        &g->interrupt.AxesGroup, &g->go_on.AxesGroup};
    for (size_t i = 0; i < sizeof references / sizeof *references; i++)
        *references[i] = &g->group;
    for (int i = 0; i < AXES; i++) {
        g->power[i] = (MC_Power_t){.Axis = &machine.axis[i], .EnablePositive = TRUE, .EnableNegative = TRUE};
        g->add[i] = (MC_AddAxisToGroup_t){.AxesGroup = &g->group, .Axis = &machine.axis[i]};
    }
    machine_add(&machine, "", 0, 1, group_program, g);
    machine_add(&machine, "", 0, 2, acting_program, NULL);
    promise_run(24000 * MS_IN_NS);
    ck_assert_uint_ge(g->done, 1000);
    ck_assert_uint_ge(g->aborted, 100);
    ck_assert_uint_ge(g->errors, 10);
    ck_assert_uint_ge(g->resets, 1);
    ck_assert_uint_ge(g->interrupted, 10);
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
    promise_run(16000 * MS_IN_NS);
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
    promise_run(4000 * MS_IN_NS);
    ck_assert_uint_ge(bridged.sent, 100);
    ck_assert_uint_ge(bridged.refused, 500);
    ck_assert_uint_ge(bridged.switched, 50);
    ck_assert_uint_ge(bridged.powered, 300);
    machine_close(&machine);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("promises of a cycle of axes together");
    TCase *all = tcase_create("all");
    tcase_set_timeout(all, 60);
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
