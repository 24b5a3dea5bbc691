#include "ordinary_witness.h"

#include "axis_segment.h" /* it has macros with short names: last */

cm1e_bus_config_t config;
cm1e_diag_t diag;
cm1e_bus_t *bus;
cm1e_axis_t *axes[8];
int owner;

void describe(const char *firmware, cm1e_mapping_t mapping, cm1e_pdo_order_t order, int64_t cycle_ns)
{
    cm1e_bus_config_free(&config);
    cm1e_bus_config_init(&config, "sim", 1);
    config.virtual_time = true;
    config.cycle_time_ns = cycle_ns;
    config.sim_pdo_order = order;
    config.axes[0].mapping = mapping;
    snprintf(config.axes[0].firmware, sizeof config.axes[0].firmware, "%s", firmware);
}

void describe_up_to(uint32_t count)
{
    while (config.axis_count < count)
        *cm1e_bus_config_add_axis(&config, NULL) = (cm1e_axis_config_t){0};
}

void open_segment(void)
{
    memset(&diag, 0, sizeof diag);
    ck_assert_msg(cm1e_bus_open(&bus, &config, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    for (uint32_t i = 0; i < config.axis_count; i++)
        ck_assert_msg(cm1e_axis_create(&axes[i], bus, i, &diag) == CM1E_OK, "%s", diag.text);
}

void close_segment(void)
{
    cm1e_bus_stop(bus);
    for (uint32_t i = 0; i < config.axis_count; i++) {
        cm1e_axis_destroy(axes[i]);
        axes[i] = NULL;
    }
    cm1e_bus_close(bus);
    bus = NULL;
}

cm1e_axis_info_t info_of(int n)
{
    cm1e_axis_info_t shown;
    cm1e_axis_get(axes[n], &shown);
    return shown;
}

cm1e_axis_info_t info(void) { return info_of(0); }

const char *text_of(int n)
{
    static char words[1024];
    cm1e_axis_error_text(cm1e_axis_reference(axes[n]), words, sizeof words);
    return words;
}

const char *text(void) { return text_of(0); }

cm1e_sim_probe_t probe_of(int n)
{
    cm1e_sim_probe_t p;
    cm1e_sim_probe(cm1e_bus_segment(bus), (uint32_t)n + 1, &p);
    return p;
}

cm1e_sim_probe_t probe(void) { return probe_of(0); }

void simulate(const char *line)
{
    char answer[256] = "";
    ck_assert_msg(cm1e_bus_simulate(bus, line, answer, sizeof answer) == CM1E_OK, "%s: %s", line, answer);
}

static int64_t next_ns;

void inputs(void)
{
    const int64_t now_ns = cm1e_clock_now(cm1e_bus_clock(bus));
    next_ns = now_ns + config.cycle_time_ns;
    const cm1e_error_t received = cm1e_bus_receive(bus);
    for (uint32_t i = 0; i < config.axis_count; i++)
        ordinary_inputs(axes[i], received, cm1e_bus_health(bus), now_ns);
}

void outputs(void)
{
    for (uint32_t i = 0; i < config.axis_count; i++)
        ordinary_outputs(axes[i]);
    cm1e_bus_send(bus);
    cm1e_clock_sleep_until(cm1e_bus_clock(bus), next_ns);
}

void cycles(int n)
{
    while (n-- > 0) {
        inputs();
        outputs();
    }
}

int cycles_of(double seconds) { return (int)(seconds * 1e9 / (double)config.cycle_time_ns); }

void power(bool enable) { ck_assert_int_eq(cm1e_axis_power(axis, &owner, enable, true, true), CM1E_OK); }

void enable(void)
{
    power(true);
    for (int i = 0; i < cycles_of(3.0) && info().state == CM1E_AXIS_DISABLED; i++)
        cycles(1);
    ck_assert_msg(info().state == CM1E_AXIS_STANDSTILL, "%s %s", cm1e_axis_state_name(info().state), text());
}

cm1e_command_id_t command(const cm1e_axis_command_t *c)
{
    cm1e_command_id_t id;
    const cm1e_error_t error = cm1e_axis_start(axis, c, &id);
    ck_assert_msg(error == CM1E_OK, "%s", cm1e_strerror(error));
    return id;
}

void await(cm1e_command_id_t id, double seconds)
{
    int n = cycles_of(seconds);
    while (n-- > 0 && cm1e_axis_command_status(axis, id).state == CM1E_COMMAND_ACTIVE)
        cycles(1);
    const cm1e_command_status_t status = cm1e_axis_command_status(axis, id);
    ck_assert_msg(status.state == CM1E_COMMAND_DONE, "command %d, error %s, axis: %s", status.state,
                  cm1e_strerror(status.error), text());
}

void move_to(double position, double velocity)
{
    await(command(&(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_ABSOLUTE, .position = position,
                                         .velocity = velocity}), 30.0);
}
