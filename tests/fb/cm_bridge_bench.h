/**
 * @file cm_bridge_bench.h
 * A simulated bridge with four motors, and the blocks CM_SendCML, CM_SetMode, CM_Command, MC_Power and MC_MoveVelocity
 * of each, for test_cm_bridge.c and test_cm_bridge_modes.c.
 */
#ifndef CM1E_TESTS_CM_BRIDGE_BENCH_H
#define CM1E_TESTS_CM_BRIDGE_BENCH_H

#include "bridge/cool_muscle.h"
#include "axis/axis_parts.h"
#include "cm1e/plcopen.h"
#include "drive/drive_bridge.h"
#include "sim/bridge_app.h"

#include "axis_segment.h"

enum { AXES = 4 };
static AXIS_REF_t references[AXES];
static CM_SendCML_t cml[AXES];
static CM_SetMode_t set_mode[AXES];
static CM_Command_t command_of[AXES];
static MC_Power_t power_of[AXES];
static MC_MoveVelocity_t turning[AXES];

static inline void scan(int count)
{
    while (count-- > 0) {
        inputs();
        for (int i = 0; i < AXES; i++) {
            MC_Power(&power_of[i]);
            CM_SendCML(&cml[i]);
            CM_SetMode(&set_mode[i]);
            CM_Command(&command_of[i]);
            MC_MoveVelocity(&turning[i]);
        }
        outputs();
    }
}

static inline void start(void)
{
    describe("", CM1E_MAPPING_DYNAMIC, CM1E_PDO_ORDER_UG_4_4, 1000000);
    describe_up_to(AXES);
    for (int i = 0; i < AXES; i++) {
        config.axes[i] = (cm1e_axis_config_t){.address = 1, .channel = (uint8_t)(i + 1), .k37 = 10, .k37_stated = true};
        snprintf(config.axes[i].motor, sizeof config.axes[i].motor, "%s", i < 2 ? "CM1" : "CM2");
        config.axes[i].sim.no_stops = i > 0;
    }
    open_segment();
    for (int i = 0; i < AXES; i++) {
        references[i] = cm1e_axis_reference(axes[i]);
        cml[i] = (CM_SendCML_t){.Axis = &references[i]};
        set_mode[i] = (CM_SetMode_t){.Axis = &references[i]};
        command_of[i] = (CM_Command_t){.Axis = &references[i]};
        power_of[i] = (MC_Power_t){.Axis = &references[i], .EnablePositive = TRUE, .EnableNegative = TRUE};
        turning[i] = (MC_MoveVelocity_t){.Axis = &references[i], .Velocity = 2.0};
    }
    scan(50);
}

static inline cm1e_sim_bridge_axis_t *motor(int n)
{
    cm1e_sim_slave_t *slave = cm1e_sim_segment_slave(cm1e_bus_segment(bus), 1);
    return &cm1e_sim_bridge_of(slave)->axes[n];
}

static inline void begin(int n, const char *text, BOOL allow_motion)
{
    cml[n].Execute = FALSE;
    scan(1);
    snprintf(cml[n].Command, sizeof cml[n].Command, "%s", text);
    cml[n].AllowMotion = allow_motion;
    cml[n].Execute = TRUE;
    scan(1);
}

static inline void wait_for(const BOOL *busy, int most)
{
    while (*busy && most-- > 0)
        scan(1);
    ck_assert_msg(!*busy, "still busy: %s", text());
}

static inline void send(int n, const char *text, BOOL allow_motion)
{
    begin(n, text, allow_motion);
    wait_for(&cml[n].Busy, 100000);
}

#define ERROR_OF(FB) cm1e_error_from_id((FB).ErrorID)
static inline void sends(int n, const char *string, const char *response)
{
    send(n, string, FALSE);
    ck_assert_msg(cml[n].Done, "%s: %s %s", string, cm1e_strerror(ERROR_OF(cml[n])), text_of(n));
    ck_assert_str_eq(cml[n].Response, response);
}

static inline void fails(int n, const char *string, BOOL allow_motion, cm1e_error_t error, const char *words)
{
    send(n, string, allow_motion);
    ck_assert_msg(ERROR_OF(cml[n]) == error, "%s: %s", string, cm1e_strerror(ERROR_OF(cml[n])));
    ck_assert_msg(!words || strstr(text_of(n), words), "%s: %s", string, text_of(n));
}

static inline void switch_mode(int n, CM_MODE mode, BOOL insist)
{
    set_mode[n].Execute = FALSE;
    scan(1);
    set_mode[n].Mode = mode;
    set_mode[n].Insist = insist;
    set_mode[n].Execute = TRUE;
    scan(1);
    wait_for(&set_mode[n].Busy, 3000);
}

static inline void do_command(int n, CM_COMMAND what, TIME timeout)
{
    command_of[n].Execute = FALSE;
    scan(1);
    command_of[n].Command = what;
    command_of[n].Timeout = timeout;
    command_of[n].Execute = TRUE;
    scan(1);
}

static inline void enable_axis(int n)
{
    power_of[n].Enable = TRUE;
    for (int i = 0; i < 3000 && !power_of[n].Status && !power_of[n].Error; i++)
        scan(1);
    ck_assert_msg(power_of[n].Status, "%s", text_of(n));
}

#endif
