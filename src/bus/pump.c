#include "bus/bus_internal.h"

/* The blocking phases of a start: they wait until slaves have answered. */

void cm1e_bus_pump(cm1e_bus_t *bus)
{
    const int64_t now_ns = cm1e_bus_enter(bus);
    if (bus->exchanging) {
        if (bus->next_cycle_ns <= now_ns - bus->config.cycle_time_ns)
            bus->next_cycle_ns = cm1e_bus_next_start(bus, now_ns); /* at first, or much too late: no burst */
        if (bus->in_flight)
            cm1e_bus_receive(bus);
        bus->next_cycle_ns += bus->config.cycle_time_ns + cm1e_bus_pace(bus);
        cm1e_bus_send(bus);
        cm1e_clock_sleep_until(bus->clock, bus->next_cycle_ns);
        return;
    }
    cm1e_dc_keep(bus);
    cm1e_acyclic_send(bus, now_ns, CM1E_DATAGRAMS_IN_FLIGHT);
    cm1e_acyclic_receive(bus, CM1E_FRAME_LOST_NS);
    /* The pause bounds the load of a slave that always answers, but never correctly. */
    cm1e_clock_sleep_until(bus->clock, now_ns + CM1E_PUMP_PERIOD_NS);
}

static bool all_idle(const cm1e_bus_t *bus)
{
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        const cm1e_bus_slave_t *slave = &bus->slaves[i];
        if (slave->owner != OWNER_NONE || !cm1e_al_idle(&slave->al) || !cm1e_coe_idle(&slave->coe) ||
            !cm1e_recognise_idle(&slave->recognition) || !cm1e_mapping_idle(&slave->mapping) ||
            !cm1e_setup_idle(&slave->setup))
            return false;
    }
    return true;
}

bool cm1e_bus_pump_until_idle(cm1e_bus_t *bus, int64_t deadline_ns)
{
    bus->listening.paused = true;
    while (!all_idle(bus) && cm1e_clock_now(bus->clock) < deadline_ns)
        cm1e_bus_pump(bus);
    bus->listening.paused = false;
    return all_idle(bus);
}
