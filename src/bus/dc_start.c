/* The clocks before Operational: the cycle gets its phase, and all are waited for. */
#include "bus/bus_internal.h"

#define WAIT_NS INT64_C(10000000000)

void cm1e_dc_begin(cm1e_bus_t *bus)
{
    cm1e_dc_t *dc = &bus->dc;
    if (!dc->used)
        return;
    cm1e_dc_pace_begin(&dc->pace, bus->config.cycle_time_ns);
    cm1e_dc_keep(bus);
    const int64_t phase_ns = cm1e_dc_phase(dc->reference_ns, bus->config.cycle_time_ns);
    bus->next_cycle_ns = dc->sent_ns - phase_ns + bus->config.cycle_time_ns;
    if (bus->next_cycle_ns < cm1e_clock_now(bus->clock))
        bus->next_cycle_ns += bus->config.cycle_time_ns;
    cm1e_clock_sleep_until(bus->clock, bus->next_cycle_ns);
}

/** A slave whose clock is beyond its tolerance; NULL: there is none. */
static const cm1e_bus_slave_t *find_apart(const cm1e_bus_t *bus)
{
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        const cm1e_dc_slave_t *slave = &bus->dc.slaves[i];
        const bool follows = slave->clock.has_clock && (!slave->clock.is_reference || bus->dc.leader);
        if (follows && (!slave->seen || slave->beyond > 0))
            return &bus->slaves[i];
    }
    return NULL;
}

/** A slave may refuse Operational before its first pulse (AL status code 0x002D). */
static bool pulses_are_to_come(const cm1e_dc_t *dc)
{
    return dc->reference_ns < dc->pulses_ns + dc->pace.cycle_ns;
}

static void forget_maxima(cm1e_dc_t *dc)
{
    dc->phase_maximum_ns = 0;
    for (unsigned i = 0; i < CM1E_MAX_SLAVES; i++)
        dc->slaves[i].clock.maximum_ns = 0;
}

cm1e_error_t cm1e_dc_wait(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    const int64_t deadline_ns = cm1e_clock_now(bus->clock) + WAIT_NS;
    char label[CM1E_LABEL_LENGTH];
    cm1e_dc_t *dc = &bus->dc;
    while (dc->used && (find_apart(bus) || !cm1e_dc_pace_settled(&dc->pace) || pulses_are_to_come(dc))) {
        const cm1e_bus_slave_t *apart = find_apart(bus);
        cm1e_bus_pump(bus);
        if (cm1e_clock_now(bus->clock) < deadline_ns)
            continue;
        if (apart && !dc->slaves[apart->info.position - 1].seen)
            return cm1e_diag_set(diag, CM1E_ERROR_BUS_CLOCKS, 0, "%s does not answer when the deviation of its clock "
                                 "is read. Check its cables and its power.", cm1e_bus_label_first(bus, apart, label));
        if (apart)
            return cm1e_diag_set(diag, CM1E_ERROR_BUS_CLOCKS, 0,
                                 "The clock of %s does not follow the reference clock: it deviates by %d ns, allowed "
                                 "are %u ns. Its controller may be damaged, or frames are lost.",
                                 cm1e_bus_label(bus, apart, label),
                                 (int)dc->slaves[apart->info.position - 1].clock.deviation_ns,
                                 (unsigned)cm1e_dc_tolerance(dc, &dc->slaves[apart->info.position - 1].clock));
        return cm1e_diag_set(diag, CM1E_ERROR_BUS_CLOCKS, 0,
                             "The cycle of this machine does not follow the reference clock: frames arrive %.0f us off "
                             "on average. Look at its wake-up latency (cm1e doctor).", dc->pace.mean_ns * 1e-3);
    }
    forget_maxima(dc);
    return CM1E_OK;
}
