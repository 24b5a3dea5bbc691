#include "bus/port_watch.h"

#include <string.h>

#include "bus/bus_internal.h"

/* Registers from 0x0300 on (ETG.1000.4 section 6.2): per port a byte of invalid frames and one of receive errors, then
 * a byte of forwarded errors per port, and from 0x0310 on one of lost links. */
enum { REG_RECEIVE_ERRORS = 0x0300, COUNTER_BYTES = 20, FORWARDED_AT = 8, LOST_LINKS_AT = 16 };

void cm1e_port_watch_ask(const cm1e_bus_slave_t *slave, cm1e_datagram_t *datagram)
{
    cm1e_datagram_set(datagram, COMMAND_FPRD, slave->facts.station, REG_RECEIVE_ERRORS, COUNTER_BYTES);
}

/** By how much a counter has grown. A slave that was switched off counts from 0 again. */
static uint8_t growth(uint8_t now, uint8_t before) { return now >= before ? (uint8_t)(now - before) : now; }

void cm1e_port_watch_take(cm1e_bus_t *bus, cm1e_bus_slave_t *slave, const cm1e_datagram_t *datagram)
{
    cm1e_port_watch_t *watch = &slave->ports;
    const uint8_t *data = datagram->data;
    for (unsigned port = 0; port < CM1E_PORTS; port++) {
        const uint8_t now[CM1E_PORT_FAULTS] = {data[2 * port], data[2 * port + 1], data[FORWARDED_AT + port],
                                               data[LOST_LINKS_AT + port]};
        for (unsigned fault = 0; fault < CM1E_PORT_FAULTS; fault++) {
            uint32_t *total = &watch->total[port][fault];
            const uint8_t more = watch->seen ? growth(now[fault], watch->last[port][fault]) : 0;
            __atomic_store_n(total, *total + more, __ATOMIC_RELAXED);
            bus->supervised.ports.news += more;
        }
        memcpy(watch->last[port], now, sizeof now);
    }
    watch->seen = true;
}

uint64_t cm1e_bus_port_news(const cm1e_bus_t *bus) { return bus->supervised.ports.news; }

uint32_t cm1e_bus_port_fault(const cm1e_bus_t *bus, uint32_t position, unsigned port, cm1e_port_fault_t fault)
{
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    if (!slave || port >= CM1E_PORTS)
        return 0;
    return __atomic_load_n(&slave->ports.total[port][fault], __ATOMIC_RELAXED);
}

cm1e_port_faults_t cm1e_bus_port_faults(const cm1e_bus_t *bus, uint16_t position, int port)
{
    const unsigned at = port < 0 ? CM1E_PORTS : (unsigned)port;
    return (cm1e_port_faults_t){
        .invalid_frames = cm1e_bus_port_fault(bus, position, at, FAULT_INVALID_FRAMES),
        .receive_errors = cm1e_bus_port_fault(bus, position, at, FAULT_RECEIVE_ERRORS),
        .forwarded_errors = cm1e_bus_port_fault(bus, position, at, FAULT_FORWARDED_ERRORS),
        .lost_links = cm1e_bus_port_fault(bus, position, at, FAULT_LOST_LINKS),
    };
}
