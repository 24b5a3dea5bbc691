#include "bus/dc.h"

#include <stdlib.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "bus/dc_delay.h"
#include "bus/kept.h"
#include "config/clock_pulses.h"
#include "core/bytes.h"

enum {
    FEATURE_CLOCKS = 0x04, TIMES_BYTES = 32, UNIT_TIME_AT = 0x18, PORT_LOOP_BIT = 8, PORT_LINK_BIT = 9,
    DELAY_ROUNDS = 8, CHECK_EVERY = 256, OFFSET_AND_DELAY_BYTES = 12,
};
/** In which frames that only distribute the time bring the clocks together. */
#define ALIGN_NS INT64_C(3000000000)

static bool transfer(cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, cm1e_command_t command, uint16_t offset,
                     void *data, uint16_t length)
{
    for (int tries = 0; tries < 3; tries++)
        if (cm1e_soem_transfer(bus->soem, command, slave->facts.station, offset, data, length) == 1)
            return true;
    return false;
}

static cm1e_error_t no_answer(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, cm1e_diag_t *diag)
{
    char label[CM1E_LABEL_LENGTH];
    return cm1e_diag_set(diag, CM1E_ERROR_BUS_CLOCKS, 0, "%s does not answer when its clock is set up. Check its "
                         "cables and its power.", cm1e_bus_label_first(bus, slave, label));
}

/* ---- who has a clock --------------------------------------------------------------------------------------------- */

static const cm1e_dc_config_t *pulses_of(const cm1e_bus_slave_t *slave)
{
    return slave->pulses.sync0_us != 0 ? &slave->pulses : NULL;
}

static uint8_t open_ports(uint16_t dl_status)
{
    uint8_t ports = 1; /* the frame came in there */
    for (unsigned port = 1; port < CM1E_DC_PORTS; port++)
        if (dl_status >> (PORT_LINK_BIT + 2 * port) & 1 && !(dl_status >> (PORT_LOOP_BIT + 2 * port) & 1))
            ports |= (uint8_t)(1u << port);
    return ports;
}

static cm1e_error_t find_clocks(cm1e_bus_t *bus, cm1e_dc_node_t *nodes, cm1e_diag_t *diag)
{
    char label[CM1E_LABEL_LENGTH];
    for (uint32_t i = 0; i < bus->scanned; i++) {
        const cm1e_bus_slave_t *slave = &bus->slaves[i];
        uint8_t features[2], ports[2];
        if (!transfer(bus, slave, COMMAND_FPRD, REG_FEATURES, features, 2) ||
            !transfer(bus, slave, COMMAND_FPRD, REG_DL_STATUS_PORTS, ports, 2))
            return no_answer(bus, slave, diag);
        nodes[i].has_clock = features[0] & FEATURE_CLOCKS;
        nodes[i].open_ports = open_ports(cm1e_get_u16(ports));
        bus->dc.slaves[i].clock = (cm1e_slave_clock_t){.has_clock = nodes[i].has_clock};
        if (nodes[i].has_clock && bus->dc.reference == 0)
            bus->dc.reference = (uint16_t)(i + 1);
        if (!nodes[i].has_clock && pulses_of(slave))
            return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "%s has no distributed clocks (register 0x0008 says so), "
                                 "so there is no SYNC0: remove dc from its configuration.",
                                 cm1e_bus_label_first(bus, slave, label));
    }
    if (bus->dc.reference == 0)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "No slave has distributed clocks (register 0x0008 says so): "
                             "remove distributed_clocks from the configuration of the bus.");
    bus->dc.slaves[bus->dc.reference - 1].clock.is_reference = true;
    return CM1E_OK;
}

/* ---- delays and offsets ------------------------------------------------------------------------------------------ */

/** One frame is stamped by all. Returns the time by the clock of this machine, and how long the frame was away. */
static int64_t stamp(cm1e_bus_t *bus, int64_t *away_ns)
{
    uint8_t zero[4] = {0};
    const int64_t before_ns = cm1e_clock_now(bus->clock);
    cm1e_soem_transfer(bus->soem, COMMAND_BWR, 0, REG_DC_TIMES, zero, sizeof zero);
    *away_ns = cm1e_clock_now(bus->clock) - before_ns;
    return before_ns;
}

static cm1e_error_t read_stamps(cm1e_bus_t *bus, cm1e_dc_node_t *nodes, uint64_t *local, cm1e_diag_t *diag)
{
    uint8_t times[TIMES_BYTES];
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        if (!nodes[i].has_clock)
            continue;
        if (!transfer(bus, &bus->slaves[i], COMMAND_FPRD, REG_DC_TIMES, times, sizeof times))
            return no_answer(bus, &bus->slaves[i], diag);
        for (unsigned port = 0; port < CM1E_DC_PORTS; port++)
            nodes[i].times[port] = cm1e_get_u32(times + 4 * port);
        local[i] = cm1e_get_u64(times + UNIT_TIME_AT);
    }
    return CM1E_OK;
}

/** Time stamps have a resolution of 10 ns, and some jitter: a mean of several frames. The offsets come from the frame
 *  that was back first: the moment at which it left is known best, and control loops remove an error slowly. The system
 *  time is that of the clock of this machine, or of the clocks of another bus that leads. */
static cm1e_error_t measure(cm1e_bus_t *bus, cm1e_dc_node_t *nodes, uint64_t *local, int64_t *system_ns,
                            cm1e_diag_t *diag)
{
    uint64_t sums[CM1E_MAX_SLAVES] = {0}, stamped[CM1E_MAX_SLAVES] = {0};
    int64_t away_ns, least_ns = INT64_MAX;
    for (int round = 0; round < DELAY_ROUNDS; round++) {
        const int64_t sent_ns = stamp(bus, &away_ns);
        const cm1e_error_t error = read_stamps(bus, nodes, stamped, diag);
        if (error != CM1E_OK)
            return error;
        if (away_ns < least_ns) {
            least_ns = away_ns;
            *system_ns = bus->dc.leader ? cm1e_dc_time(&bus->dc.leader->dc, sent_ns) : sent_ns;
            memcpy(local, stamped, sizeof stamped);
        }
        cm1e_dc_delays(nodes, bus->scanned);
        for (uint32_t i = 0; i < bus->slave_count; i++)
            sums[i] += nodes[i].delay_ns;
    }
    for (uint32_t i = 0; i < bus->slave_count; i++)
        bus->dc.slaves[i].clock.delay_ns = (uint32_t)(sums[i] / DELAY_ROUNDS);
    return CM1E_OK;
}

static cm1e_error_t write_clock(cm1e_bus_t *bus, uint32_t index, uint64_t offset, cm1e_diag_t *diag)
{
    const cm1e_bus_slave_t *slave = &bus->slaves[index];
    uint8_t filters[2], times[OFFSET_AND_DELAY_BYTES], start[2];
    cm1e_put_u16(filters, DC_FILTERS);
    cm1e_put_u64(times, offset);
    cm1e_put_u32(times + 8, bus->dc.slaves[index].clock.delay_ns);
    cm1e_put_u16(start, DC_SPEED_START); /* last: it begins the filters anew */
    const bool written = transfer(bus, slave, COMMAND_FPWR, REG_DC_FILTERS, filters, sizeof filters) &&
                         transfer(bus, slave, COMMAND_FPWR, REG_DC_OFFSET, times, sizeof times) &&
                         transfer(bus, slave, COMMAND_FPWR, REG_DC_SPEED_START, start, sizeof start);
    return written ? CM1E_OK : no_answer(bus, slave, diag);
}

static cm1e_error_t set_clocks(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    cm1e_dc_node_t *nodes = calloc(CM1E_MAX_SLAVES, sizeof *nodes);
    uint64_t local[CM1E_MAX_SLAVES] = {0};
    int64_t system_ns = 0;
    if (!nodes)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "Out of memory for the distributed clocks.");
    cm1e_error_t error = find_clocks(bus, nodes, diag);
    if (error == CM1E_OK)
        error = measure(bus, nodes, local, &system_ns, diag);
    for (uint32_t i = 0; i < bus->slave_count && error == CM1E_OK; i++)
        if (nodes[i].has_clock)
            error = write_clock(bus, i, (uint64_t)system_ns + bus->dc.slaves[i].clock.delay_ns - local[i], diag);
    free(nodes);
    return error;
}

/* ---- coming together --------------------------------------------------------------------------------------------- */

static bool look(cm1e_bus_t *bus, uint32_t index)
{
    cm1e_datagram_t d = {0};
    cm1e_datagram_set(&d, COMMAND_FPRD, bus->slaves[index].facts.station, REG_DC_DIFFERENCE, 4);
    bus->dc.looked = (uint16_t)(index + 1);
    const bool answered = transfer(bus, &bus->slaves[index], COMMAND_FPRD, REG_DC_DIFFERENCE, d.data, 4);
    d.working_counter = answered;
    cm1e_dc_looked(bus, &d);
    return answered && !bus->dc.slaves[index].beyond;
}

/** The register description advises thousands of frames that only distribute the time, before anything depends on it.
 *  What is not together by then is waited for in cm1e_dc_wait(). */
static void align(cm1e_bus_t *bus)
{
    const int64_t deadline_ns = cm1e_clock_now(bus->clock) + ALIGN_NS;
    bool together = false;
    for (unsigned n = 1; !together && cm1e_clock_now(bus->clock) < deadline_ns; n++) {
        cm1e_dc_keep(bus);
        if (n % CHECK_EVERY)
            continue;
        together = n >= 8 * CHECK_EVERY;
        for (uint32_t i = 0; i < bus->slave_count; i++)
            together &= !bus->dc.slaves[i].clock.has_clock || look(bus, i);
    }
}

/* ---- SYNC0 and SYNC1 --------------------------------------------------------------------------------------------- */

static int64_t ns_of(double us) { return (int64_t)(us * 1000 + (us < 0 ? -0.5 : 0.5)); }

static cm1e_error_t set_pulses(cm1e_bus_t *bus, uint32_t index, const cm1e_dc_config_t *config, cm1e_diag_t *diag)
{
    const cm1e_bus_slave_t *slave = &bus->slaves[index];
    cm1e_slave_clock_t *clock = &bus->dc.slaves[index].clock;
    uint8_t off[2] = {slave->dc_control, 0}, start[8], cycles[8];
    bus->dc.slaves[index].control = slave->dc_control;
    clock->sync0_ns = (uint32_t)ns_of(config->sync0_us);
    clock->sync1_ns = (uint32_t)ns_of(config->sync1_us);
    clock->shift_ns = config->shift_us != 0 ? (int32_t)ns_of(config->shift_us)
                                            : (int32_t)(bus->config.cycle_time_ns / 2);
    uint8_t on = (uint8_t)cm1e_dc_activation(clock);
    cm1e_dc_keep(bus); /* tells the time */
    cm1e_dc_put_pulses(&bus->dc, clock, bus->dc.reference_ns, start, cycles);
    const int64_t first_ns = (int64_t)cm1e_get_u64(start);
    bus->dc.pulses_ns = first_ns > bus->dc.pulses_ns ? first_ns : bus->dc.pulses_ns;
    const bool written = transfer(bus, slave, COMMAND_FPWR, REG_DC_CONTROL, off, 2) &&
                         transfer(bus, slave, COMMAND_FPWR, REG_DC_CYCLES, cycles, 8) &&
                         transfer(bus, slave, COMMAND_FPWR, REG_DC_START, start, 8) &&
                         transfer(bus, slave, COMMAND_FPWR, REG_DC_ACTIVATION, &on, 1);
    return written ? CM1E_OK : no_answer(bus, slave, diag);
}

cm1e_error_t cm1e_dc_set_up(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    const cm1e_dc_pace_t pace = bus->dc.pace;
    memset(&bus->dc, 0, sizeof bus->dc);
    bus->dc.pace = pace;
    for (uint32_t i = 0; i < bus->slave_count; i++)
        bus->slaves[i].dc = NULL;
    if (!cm1e_config_uses_clocks(&bus->config))
        return CM1E_OK;
    bus->dc.leader = cm1e_bus_kept_leader(bus);
    cm1e_error_t error = set_clocks(bus, diag);
    if (error != CM1E_OK)
        return error;
    bus->dc.used = true;
    cm1e_dc_pace_begin(&bus->dc.pace, bus->config.cycle_time_ns);
    for (uint32_t i = 0; i < bus->slave_count; i++)
        bus->slaves[i].dc = &bus->dc;
    align(bus);
    for (uint32_t i = 0; i < bus->scanned && error == CM1E_OK; i++) {
        const cm1e_dc_config_t *pulses = pulses_of(&bus->slaves[i]);
        if (pulses)
            error = set_pulses(bus, i, pulses, diag);
    }
    cm1e_soem_use_clocks(bus->soem, bus->dc.reference);
    return error;
}

void cm1e_dc_stop(cm1e_bus_t *bus)
{
    uint8_t off = 0;
    if (!bus->dc.used)
        return;
    cm1e_soem_transfer(bus->soem, COMMAND_BWR, 0, REG_DC_ACTIVATION, &off, 1);
    bus->dc.used = false;
    bus->dc.leader = NULL;
}
