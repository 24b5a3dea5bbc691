/* Scenarios of cm_bridge.h. */
#include "diagram.h"

#include <string.h>

/* A CM1 at connector 1 of a bridge. */
static void behind_a_bridge(cm1e_axis_config_t *config)
{
    config->firmware[0] = '\0';
    config->channel = 1;
    config->k37 = 10;
    config->k37_stated = true;
    strcpy(config->motor, "CM1");
    config->homing.method = 0;
}

static void send_cml(void)
{
    CM_SendCML_t query = {AXIS, .Command = "?99.1"}, list = {AXIS, .Command = "?90.1"};
    CM_SendCML_t motion = {AXIS, .Command = "|.1"};
    trace_configure(behind_a_bridge);
    trace_begin_disabled("CM_SendCML", "The state; the list of K parameters; an origin search without AllowMotion. "
                                       "MC_Power leaves CML.");
    trace_block("CM_SendCML", "CM_SendCML, ?99.1", &query);
    trace_block("CM_SendCML", "CM_SendCML, ?90.1", &list);
    trace_block("CM_SendCML", "CM_SendCML, |.1", &motion);
    trace_block("MC_Power", "MC_Power", &bench.power);
    bench.power.Axis = &bench.axis;
    UNTIL(1400) {
        query.Execute = during(20, 150);
        list.Execute = during(100, 1050);
        motion.Execute = during(1080, 1120);
        bench.power.Enable = bench.power.EnablePositive = bench.power.EnableNegative = during(1150, 1400);
        CM_SendCML(&query);
        CM_SendCML(&list);
        CM_SendCML(&motion);
    }
    trace_end();
}

static void set_mode(void)
{
    CM_SetMode_t cmd = {AXIS, .Mode = cmCMD}, csp = {AXIS, .Mode = cmCSP};
    trace_configure(behind_a_bridge);
    trace_begin_disabled("CM_SetMode", "To CMD; from there no way leads back to CSP.");
    trace_block("CM_SetMode", "CM_SetMode, cmCMD", &cmd);
    trace_block("CM_SetMode", "CM_SetMode, cmCSP", &csp);
    UNTIL(200) {
        cmd.Execute = during(20, 100);
        csp.Execute = during(130, 170);
        CM_SetMode(&cmd);
        CM_SetMode(&csp);
    }
    trace_end();
}

static void command(void)
{
    CM_SetMode_t cmd = {AXIS, .Mode = cmCMD};
    CM_Command_t enable = {AXIS, .Command = cmMotorEnable}, motor_free = {AXIS, .Command = cmMotorFree};
    trace_configure(behind_a_bridge);
    trace_begin_disabled("CM_Command", "Refused before CMD mode is there; then motor enable and motor free.");
    trace_block("CM_SetMode", "CM_SetMode, cmCMD", &cmd);
    trace_block("CM_Command", "CM_Command, enable", &enable);
    trace_block("CM_Command", "CM_Command, free", &motor_free);
    UNTIL(300) {
        cmd.Execute = during(40, 120);
        enable.Execute = during(10, 30) || during(100, 170);
        motor_free.Execute = during(200, 270);
        CM_SetMode(&cmd);
        CM_Command(&enable);
        CM_Command(&motor_free);
    }
    trace_end();
}

const scenario_t bridge_scenarios[] = {
    {"CM_SendCML", send_cml}, {"CM_SetMode", set_mode}, {"CM_Command", command}, {NULL, NULL},
};
