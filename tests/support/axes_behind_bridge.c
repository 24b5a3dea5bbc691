#include "axes_behind_bridge.h"

void describe_bridge(void)
{
    cm1e_bus_config_free(&config);
    cm1e_bus_config_init(&config, "sim", AXES);
    config.virtual_time = true;
    config.cycle_time_ns = CM1E_BRIDGE_CYCLE_TIME_NS;
    for (int i = 0; i < AXES; i++) {
        cm1e_axis_config_t *a = &config.axes[i];
        a->address = 1;
        a->channel = (uint8_t)(i + 1);
        snprintf(a->motor, sizeof a->motor, "%s", i < CM2 ? "CM1" : "CM2");
        a->k37 = 10;
        a->k37_stated = true;
        a->homing = (cm1e_homing_config_t){.method = 3, .velocity = 4.0, .acceleration = 40.0};
    }
}

cm1e_sim_bridge_axis_t *motor(int n)
{
    cm1e_sim_bridge_t *bridge = cm1e_sim_bridge_of(cm1e_sim_segment_slave(cm1e_bus_segment(bus), 1));
    return &bridge->axes[n];
}

double shaft(int n) { return motor(n)->mechanics.position; }

void power_of(int n, bool on) { ck_assert_int_eq(cm1e_axis_power(axes[n], &owner, on, true, true), CM1E_OK); }

void enable_all(void)
{
    for (int n = 0; n < AXES; n++)
        power_of(n, true);
    cycles(500);
    for (int n = 0; n < AXES; n++)
        ck_assert_msg(info_of(n).state == CM1E_AXIS_STANDSTILL, "axis %d: %s %s", n,
                      cm1e_axis_state_name(info_of(n).state), text_of(n));
}

void open_enabled(void)
{
    open_segment();
    enable_all();
}

cm1e_command_id_t start_of(int n, const cm1e_axis_command_t *c)
{
    cm1e_command_id_t id;
    const cm1e_error_t error = cm1e_axis_start(axes[n], c, &id);
    ck_assert_msg(error == CM1E_OK, "axis %d: %s: %s", n, cm1e_strerror(error), text_of(n));
    return id;
}

cm1e_command_status_t status_of(int n, cm1e_command_id_t id) { return cm1e_axis_command_status(axes[n], id); }

cm1e_command_status_t wait_for(int n, cm1e_command_id_t id, double seconds)
{
    for (int i = cycles_of(seconds); i > 0 && status_of(n, id).state == CM1E_COMMAND_ACTIVE; i--)
        cycles(1);
    return status_of(n, id);
}

void finish(int n, cm1e_command_id_t id, double seconds)
{
    const cm1e_command_status_t status = wait_for(n, id, seconds);
    ck_assert_msg(status.state == CM1E_COMMAND_DONE, "axis %d: command %d, %s: %s", n, status.state,
                  cm1e_strerror(status.error), text_of(n));
}

cm1e_command_id_t move_of(int n, double position, double velocity)
{
    return start_of(n, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = position,
                                              .velocity = velocity});
}

cm1e_command_id_t home_of(int n, double position, const cm1e_homing_config_t *homing)
{
    return start_of(n, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_HOME, .position = position, .homing = homing});
}

void told(int n, const char *words) { ck_assert_msg(strstr(text_of(n), words) != NULL, "%s", text_of(n)); }

static const char *const faults[FAULTS] = {
    "motor 1 %d unplug", "motor 1 %d error overload", "motor 1 %d error position", "motor 1 %d error temperature",
    "motor 1 %d broken 60",
};

void fault_of(int n, int fault)
{
    char line[60];
    snprintf(line, sizeof line, faults[fault], n + 1);
    simulate(line);
}

void repair(int n, int fault)
{
    char line[60];
    if (fault == 0) {
        snprintf(line, sizeof line, "motor 1 %d replug", n + 1);
        simulate(line);
        cycles(50);
    }
    ck_assert_int_eq(cm1e_axis_reset(axes[n]), CM1E_OK);
    cm1e_error_t error = CM1E_OK;
    for (int i = 0; i < 3000 && cm1e_axis_reset_state(axes[n], &error) == CM1E_COMMAND_ACTIVE; i++)
        cycles(1);
    ck_assert_msg(error == CM1E_OK, "%s: %s", cm1e_strerror(error), text_of(n));
    cycles(500);
    ck_assert_msg(info_of(n).state == CM1E_AXIS_STANDSTILL, "%s %s", cm1e_axis_state_name(info_of(n).state),
                  text_of(n));
}
