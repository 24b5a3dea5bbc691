#include "bridge_drives.h"

static cm1e_bus_config_t config;
cm1e_bus_t *bus;
cm1e_drive_t drives[DRIVES];
void (*each_cycle)(void);

cm1e_sim_bridge_axis_t *motor(int n)
{
    cm1e_sim_bridge_t *bridge =
        cm1e_sim_bridge_of(cm1e_sim_segment_slave(cm1e_bus_segment(bus), 1));
    ck_assert_ptr_nonnull(bridge);
    return &bridge->axes[n];
}

void open_drives(void)
{
    static const char *const motors[DRIVES] = {"CM1", "CM1", "CM2", "CM2"};
    cm1e_diag_t diag = {0};
    cm1e_bus_config_free(&config);
    cm1e_bus_config_init(&config, "sim", DRIVES);
    config.virtual_time = true;
    config.cycle_time_ns = DRIVES_CYCLE_NS;
    for (int n = 0; n < DRIVES; n++) {
        cm1e_axis_config_t *axis = &config.axes[n];
        axis->address = 1;
        axis->channel = (uint8_t)(n + 1);
        axis->k37 = 10;
        axis->k37_stated = true;
        snprintf(axis->motor, sizeof axis->motor, "%s", motors[n]);
    }
    wire_forget();
    each_cycle = NULL;
    memset(drives, 0, sizeof drives);
    ck_assert_msg(cm1e_bus_open(&bus, &config, &diag) == CM1E_OK, "%s", diag.text);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    for (uint32_t n = 0; n < DRIVES; n++)
        ck_assert_msg(cm1e_drive_init(&drives[n], bus, n, &diag) == CM1E_OK, "%s", diag.text);
    cm1e_nic_set_tap(cm1e_bus_nic(bus), wire_tap, NULL);
}

void close_drives(void)
{
    for (int n = 0; n < DRIVES; n++)
        ck_assert_msg(motor(n)->broken_rules == 0, "ID%d: rules of the guide are broken: 0x%03X", n + 1,
                      motor(n)->broken_rules);
    cm1e_bus_stop(bus); /* transfers of the drives end here: before their memory goes */
    for (int n = 0; n < DRIVES; n++)
        cm1e_drive_free(&drives[n]);
    cm1e_bus_close(bus);
    bus = NULL;
}

int64_t now_ns(void) { return cm1e_clock_now(cm1e_bus_clock(bus)); }

void cycles(int count)
{
    while (count-- > 0) {
        const int64_t next_ns = now_ns() + config.cycle_time_ns;
        const cm1e_error_t received = cm1e_bus_receive(bus);
        const bool well = received == CM1E_OK && cm1e_bus_health(bus) == CM1E_OK;
        for (int n = 0; n < DRIVES; n++)
            cm1e_drive_read(&drives[n], well, now_ns());
        if (each_cycle)
            each_cycle();
        for (int n = 0; n < DRIVES; n++)
            cm1e_drive_write(&drives[n]);
        cm1e_bus_send(bus);
        cm1e_clock_sleep_until(cm1e_bus_clock(bus), next_ns);
    }
}

const char *drive_text(int n)
{
    static char text[1024];
    cm1e_drive_fault_text(&drives[n], text, sizeof text);
    return text;
}

void simulate(const char *format, int n)
{
    char line[96], answer[256] = "";
    snprintf(line, sizeof line, format, n + 1);
    ck_assert_msg(cm1e_bus_simulate(bus, line, answer, sizeof answer) == CM1E_OK, "%s: %s", line, answer);
}

void reach_mode(int n, int mode)
{
    drives[n].command.mode = (cm1e_mode_t)mode;
    for (int i = 0; i < 1500 && drives[n].feedback.mode != mode && drives[n].fault.error == CM1E_OK; i++)
        cycles(1);
    ck_assert_msg(drives[n].feedback.mode == mode, "ID%d shows mode %d, not %d: %s", n + 1, drives[n].feedback.mode,
                  mode, drive_text(n));
}

void enable_drive(int n)
{
    drives[n].command.enable = true;
    for (int i = 0; i < 1000 && !drives[n].feedback.enabled && drives[n].fault.error == CM1E_OK; i++) {
        drives[n].command.target_position = drives[n].feedback.position;
        cycles(1);
    }
    ck_assert_msg(drives[n].feedback.enabled, "ID%d is not enabled: %s", n + 1, drive_text(n));
    drives[n].command.target_position = drives[n].feedback.position;
}
