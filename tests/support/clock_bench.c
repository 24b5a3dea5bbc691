#include "bus/bus_internal.h" /* first, as bus_support.h has a global `diag` */

#include "clock_bench.h"

int64_t plan_ns;

void describe(double sync0_us)
{
    sim_config(SLAVES);
    cm1e_axis_config_t *drive = &config.axes[DRIVE - 1];
    drive->firmware[0] = '\0';
    strcpy(drive->device, "cia402");
    drive->counts_per_revolution = 131072;
    drive->max_speed_rpm = 3000;
    drive->dc.sync0_us = sync0_us;
    config.cycle_time_ns = CYCLE_NS;
}

cm1e_bus_t *open_drifting(double first, double second, double third)
{
    const double ppm[] = {first, second, third};
    cm1e_bus_t *bus = open_bus();
    for (int i = 0; i < SLAVES; i++) {
        char line[40];
        snprintf(line, sizeof line, "clock %d drift %g", i + 1, ppm[i]);
        simulate(bus, line);
    }
    return bus;
}

cm1e_bus_t *start_drifting(double first, double second, double third)
{
    cm1e_bus_t *bus = open_drifting(first, second, third);
    ck_assert_msg(cm1e_bus_start(bus, &diag) == CM1E_OK, "%s", diag.text);
    plan_ns = 0;
    return bus;
}

void run(cm1e_bus_t *bus, unsigned n)
{
    if (plan_ns == 0)
        plan_ns = cm1e_bus_next_start(bus, now_of(bus));
    for (unsigned i = 0; i < n; i++) {
        cm1e_clock_sleep_until(cm1e_bus_clock(bus), plan_ns);
        cm1e_bus_receive(bus);
        cm1e_bus_send(bus);
        plan_ns += CYCLE_NS + cm1e_bus_pace(bus);
    }
}

double ahead_ns(cm1e_bus_t *bus, uint32_t position)
{
    cm1e_sim_clock_t first, other;
    cm1e_sim_segment_advance(segment_of(bus), now_of(bus));
    cm1e_sim_segment_clock(segment_of(bus), 1, &first);
    cm1e_sim_segment_clock(segment_of(bus), position, &other);
    return (double)(other.system_ns - first.system_ns) - (double)(other.time_ns - first.time_ns);
}

cm1e_slave_clock_t clock_of(cm1e_bus_t *bus, uint16_t position)
{
    cm1e_slave_clock_t clock;
    cm1e_bus_slave_clock(bus, position, &clock);
    return clock;
}

void note_status(cm1e_bus_t *bus, uint16_t position, uint16_t al_status_code)
{
    cm1e_dc_note_status(&bus->slaves[position - 1], al_status_code);
}

cm1e_bus_clocks_t clocks_of(cm1e_bus_t *bus)
{
    cm1e_bus_clocks_t clocks;
    cm1e_bus_clocks(bus, &clocks);
    return clocks;
}
