#include <limits.h>

#include "bus/bus_internal.h"

/* The blocking phases of a start: they wait until slaves have answered. */

void cm1e_bus_pump_cycle(cm1e_bus_t *bus)
{
    const int64_t now_ns = cm1e_bus_enter(bus);
    if (bus->next_cycle_ns <= now_ns - bus->config.cycle_time_ns)
        bus->next_cycle_ns = cm1e_bus_next_start(bus, now_ns); /* at first, or much too late: no burst */
    if (bus->in_flight)
        cm1e_bus_receive(bus);
    bus->next_cycle_ns += bus->config.cycle_time_ns + cm1e_bus_pace(bus);
    cm1e_bus_send(bus);
}

/** Before Operational the answers of a cycle are not left until the next one: what a start waits for goes on between
 *  the cycles, one frame at a time, as far as the next process data are not kept waiting. */
static void work_between_cycles(cm1e_bus_t *bus)
{
    enum { FRAME_NS = 130000, NS_PER_SLAVE = 1500 };
    const int64_t end_ns = bus->next_cycle_ns - FRAME_NS - (int64_t)bus->slave_count * NS_PER_SLAVE;
    int64_t now_ns = cm1e_clock_now(bus->clock);
    while (bus->listening.paused && bus->phase < BUS_OPERATING && end_ns - now_ns >= US_IN_NS) {
        if (bus->acyclic.count == 0)
            cm1e_acyclic_send(bus, now_ns, CM1E_BUNDLE_DATAGRAMS);
        if (bus->acyclic.count == 0)
            return;
        const int64_t left_ns = end_ns - now_ns;
        cm1e_acyclic_receive(bus, left_ns < CM1E_FRAME_LOST_NS ? left_ns : CM1E_FRAME_LOST_NS);
        now_ns = cm1e_clock_now(bus->clock);
    }
}

void cm1e_bus_pump(cm1e_bus_t *bus)
{
    cm1e_acyclic_wake(bus); /* for what its caller has begun */
    if (bus->exchanging) {
        cm1e_bus_pump_cycle(bus);
        work_between_cycles(bus);
        cm1e_clock_sleep_until(bus->clock, bus->next_cycle_ns);
        return;
    }
    const int64_t now_ns = cm1e_bus_enter(bus);
    cm1e_dc_keep(bus);
    cm1e_acyclic_send(bus, now_ns, UINT_MAX);
    const bool waits = bus->acyclic.count > 0;
    cm1e_acyclic_receive(bus, CM1E_FRAME_LOST_NS);
    const bool eager = now_ns - bus->acyclic.progress_ns < CM1E_PUMP_PATIENCE_NS;
    if (!waits || !eager || now_ns < bus->acyclic.careful_until_ns) /* bounds the load, and lets time pass */
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
