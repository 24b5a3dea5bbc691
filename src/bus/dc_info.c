/* What the clocks tell others. */
#include "bus/bus_internal.h"
#include "core/sized.h"

void cm1e_bus_clocks_sized(const cm1e_bus_t *bus, cm1e_bus_clocks_t *clocks, size_t size)
{
    cm1e_bus_clocks_t all = {0};
    const cm1e_dc_t *dc = bus ? &bus->dc : NULL;
    if (dc && dc->used)
        all = (cm1e_bus_clocks_t){
            .used = true, .reference = dc->reference, .reference_ns = dc->reference_ns,
            .rate_ppm = dc->pace.cycle_ns ? dc->pace.rate_ns / (double)dc->pace.cycle_ns * 1e6 : 0,
            .phase_error_ns = dc->pace.error_ns, .phase_mean_ns = dc->pace.mean_ns,
            .phase_maximum_ns = dc->phase_maximum_ns, .sync_losses = dc->losses,
            .led = dc->leader != NULL};
    cm1e_copy_sized(clocks, size, &all, sizeof all);
}

static const cm1e_bus_t *leader_of(const cm1e_bus_t *bus) { return bus->dc.leader ? bus->dc.leader : bus; }

bool cm1e_bus_leads_clocks(const cm1e_bus_t *bus, const cm1e_bus_t *other)
{
    return bus->dc.used && (!other->dc.used || leader_of(other) == bus);
}

bool cm1e_bus_follow_one_clock(const cm1e_bus_t *bus, const cm1e_bus_t *other)
{
    return !bus->dc.used || !other->dc.used || leader_of(bus) == leader_of(other);
}

void cm1e_bus_follow_clock(cm1e_bus_t *bus, const cm1e_bus_t *leader) { bus->dc.leader = leader; }

void cm1e_bus_slave_clock_sized(const cm1e_bus_t *bus, uint16_t position, cm1e_slave_clock_t *clock, size_t size)
{
    static const cm1e_slave_clock_t none;
    const bool known = bus && bus->dc.used && position >= 1 && position <= bus->slave_count;
    cm1e_copy_sized(clock, size, known ? &bus->dc.slaves[position - 1].clock : &none, sizeof none);
}
