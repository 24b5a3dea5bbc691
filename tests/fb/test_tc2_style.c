/* A program as it comes from TwinCAT (docs/TWINCAT.md), on the simulated segment: enable, move, jog at a velocity, add a
 * superimposed motion and take it away again, stop. Its names are Tc2_MC2's. */
#include <math.h>

#include "axes_described.h"
#include "cm1e/bus.h"
#include "cm1e/scheduler.h"
#include "cm1e/tc2_mc2.h"
#include "quick_check.h"

enum { SECOND = 1000 };

typedef enum step { ENABLE = 0, MOVE, TURN, ADD, TAKE_AWAY, STOP, READY } step_t;

static struct program {
    cm1e_scheduler_t *scheduler;
    step_t step;
    AXIS_REF Axis1;
    MC_Power_t fbPower;
    MC_MoveAbsolute_t fbMove;
    MC_MoveVelocity_t fbTurn;
    MC_MoveSuperImposed_t fbAdd;
    MC_AbortSuperposition_t fbTakeAway;
    MC_Stop_t fbStop;
    MC_ReadStatus_t fbStatus;
    TON_t tTurning;
    double added;
} plc;

static void next_if(BOOL condition)
{
    if (condition)
        plc.step++;
}

static void call_blocks(void)
{
    plc.fbMove.Execute = plc.step == MOVE;
    plc.fbTurn.Execute = plc.step == TURN || plc.step == ADD || plc.step == TAKE_AWAY;
    plc.fbAdd.Execute = plc.step == ADD;
    plc.fbTakeAway.Execute = plc.step == TAKE_AWAY;
    plc.fbStop.Execute = plc.step == STOP;
    plc.tTurning.IN = plc.fbTurn.InVelocity && plc.step == ADD;
    MC_Power(&plc.fbPower);
    MC_MoveAbsolute(&plc.fbMove);
    MC_MoveVelocity(&plc.fbTurn);
    MC_MoveSuperImposed(&plc.fbAdd);
    MC_AbortSuperposition(&plc.fbTakeAway);
    MC_Stop(&plc.fbStop);
    MC_ReadStatus(&plc.fbStatus);
    TON(&plc.tTurning);
    ck_assert(!plc.fbPower.Error && !plc.fbMove.Error && !plc.fbTurn.Error && !plc.fbAdd.Error);
    ck_assert(!plc.fbTakeAway.Error && !plc.fbStop.Error && !plc.fbStatus.Error);
}

static void MAIN(void *context)
{
    (void)context;
    call_blocks();
    switch (plc.step) {
    case ENABLE: next_if(plc.fbPower.Status); break;
    case MOVE: next_if(plc.fbMove.Done); break;
    case TURN: next_if(plc.fbTurn.InVelocity); break;
    case ADD:
        plc.added = plc.fbAdd.CoveredDistance;
        next_if(plc.tTurning.Q);
        break;
    case TAKE_AWAY: next_if(plc.fbTakeAway.Done); break;
    case STOP: next_if(plc.fbStop.Done); break;
    case READY: cm1e_scheduler_stop(plc.scheduler); break;
    }
}

static void declare(AXIS_REF axis)
{
    AXIS_REF *const Axis1 = &plc.Axis1;
    plc.Axis1 = axis;
    plc.fbPower = (MC_Power_t){.Axis = Axis1, .Enable = TRUE, .Enable_Positive = TRUE, .Enable_Negative = TRUE};
    plc.fbMove = (MC_MoveAbsolute_t){.Axis = Axis1, .Position = -8, .Velocity = 20, .BufferMode = MC_Aborting};
    plc.fbTurn = (MC_MoveVelocity_t){.Axis = Axis1, .Velocity = 2, .Direction = MC_Positive_Direction};
    plc.fbAdd = (MC_MoveSuperImposed_t){.Axis = Axis1, .Distance = 100, .VelocityDiff = 1};
    plc.fbTakeAway = (MC_AbortSuperposition_t){.Axis = Axis1};
    plc.fbStop = (MC_Stop_t){.Axis = Axis1};
    plc.fbStatus = (MC_ReadStatus_t){.Axis = Axis1, .Enable = TRUE};
    plc.tTurning = (TON_t){.PT = 500000000};
}

START_TEST(test_program_with_the_names_of_tc2_mc2_runs)
{
    static cm1e_bus_config_t config;
    cm1e_bus_t *bus;
    cm1e_diag_t diag = {0};
    describe_axes(&config, 1);
    ck_assert_msg(cm1e_bus_open(&bus, &config, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_int_eq(cm1e_scheduler_create(&plc.scheduler, bus, NULL, &diag), CM1E_OK);
    declare(cm1e_scheduler_axis(plc.scheduler, 0));
    ck_assert_int_eq(cm1e_scheduler_add_task(plc.scheduler, &(cm1e_task_config_t){.program = MAIN}, &diag), CM1E_OK);
    ck_assert_msg(cm1e_scheduler_run(plc.scheduler, 10 * SECOND * 1000000LL, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(plc.step == READY, "it came to step %d only", plc.step);
    ck_assert_msg(plc.added > 0.4 && plc.added < 0.6, "0.5 s at 1 u/s added %g u", plc.added);
    cm1e_scheduler_destroy(plc.scheduler);
    cm1e_bus_close(bus);
}
END_TEST

/* ---- a cam ------------------------------------------------------------------------------------------------------- */

static struct cam_program {
    AXIS_REF Master, Slave;
    MC_Power_t fbPowerMaster, fbPowerSlave;
    MC_CamTableSelect_t fbSelect;
    MC_CamIn_t fbCamIn;
    MC_MoveRelative_t fbMove;
    int ends;
    cm1e_scheduler_t *scheduler;
} cam;

static const MC_CAM_POINT out_and_back[] = {{0, 0, 0, 0}, {1, 0.5, 0, 0}, {2, 0, 0, 0}};
static const MC_CAM_REF table = {.Points = out_and_back, .NumberOfPoints = 3};

static void MAIN_OF_CAM(void *context)
{
    (void)context;
    MC_Power(&cam.fbPowerMaster);
    MC_Power(&cam.fbPowerSlave);
    cam.fbSelect.Execute = cam.fbPowerMaster.Status && cam.fbPowerSlave.Status;
    MC_CamTableSelect(&cam.fbSelect);
    cam.fbCamIn.CamTableID = cam.fbSelect.CamTableID;
    cam.fbCamIn.Execute = cam.fbSelect.Done;
    MC_CamIn(&cam.fbCamIn);
    cam.fbMove.Execute = cam.fbCamIn.InSync || cam.fbMove.Busy || cam.fbMove.Done;
    MC_MoveRelative(&cam.fbMove);
    cam.ends += cam.fbCamIn.EndOfProfile;
    ck_assert_msg(!cam.fbSelect.Error && !cam.fbCamIn.Error && !cam.fbMove.Error, "%#x, %#x, %#x", cam.fbSelect.ErrorID,
                  cam.fbCamIn.ErrorID, cam.fbMove.ErrorID);
    if (cam.fbMove.Done)
        cm1e_scheduler_stop(cam.scheduler);
}

static void declare_cam(void)
{
    cam.Slave = cm1e_scheduler_axis(cam.scheduler, 0);
    cam.Master = cm1e_scheduler_axis(cam.scheduler, 1);
    cam.fbPowerMaster = (MC_Power_t){.Axis = &cam.Master, .Enable = TRUE, .Enable_Positive = TRUE,
                                     .Enable_Negative = TRUE};
    cam.fbPowerSlave = cam.fbPowerMaster;
    cam.fbPowerSlave.Axis = &cam.Slave;
    cam.fbSelect = (MC_CamTableSelect_t){.Slave = &cam.Slave, .CamTable = &table, .Periodic = TRUE};
    cam.fbCamIn = (MC_CamIn_t){.Master = &cam.Master, .Slave = &cam.Slave, .StartMode = MC_STARTMODE_RELATIVE};
    cam.fbMove = (MC_MoveRelative_t){.Axis = &cam.Master, .Distance = 7, .Velocity = 4};
}

/** In a task that runs in every tenth cycle only: the slave follows in all of them, and no end of the cam is lost. */
START_TEST(test_cam_is_followed_and_its_ends_are_seen_by_a_slow_task)
{
    static cm1e_bus_config_t config;
    cm1e_bus_t *bus;
    cm1e_diag_t diag = {0};
    describe_axes(&config, 2);
    ck_assert_msg(cm1e_bus_open(&bus, &config, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_int_eq(cm1e_scheduler_create(&cam.scheduler, bus, NULL, &diag), CM1E_OK);
    declare_cam();
    const cm1e_task_config_t slow = {.program = MAIN_OF_CAM, .interval_ns = 10000000};
    ck_assert_msg(cm1e_scheduler_add_task(cam.scheduler, &slow, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_scheduler_run(cam.scheduler, 20 * SECOND * 1000000LL, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert(cam.fbMove.Done);
    ck_assert_int_eq(cam.ends, 3); /* 7 u are three periods and a half */
    cm1e_scheduler_destroy(cam.scheduler);
    cm1e_bus_close(bus);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("Tc2_MC2");
    TCase *test = tcase_create("Tc2_MC2");
    tcase_add_test(test, test_program_with_the_names_of_tc2_mc2_runs);
    tcase_add_test(test, test_cam_is_followed_and_its_ends_are_seen_by_a_slow_task);
    suite_add_tcase(suite, test);
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_NORMAL);
    const int failures = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failures != 0;
}
