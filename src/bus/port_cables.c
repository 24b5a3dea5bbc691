/* Where the ports are whose errors are counted (port_watch.c), and what a count says of a cable. */
#include <stdio.h>

#include "bus/bus_internal.h"
#include "bus/port_watch.h"

void cm1e_port_watch_begin(cm1e_bus_t *bus)
{
    static const cm1e_slave_place_t unknown;
    cm1e_slave_place_t places[CM1E_MAX_SLAVES];
    const bool known = cm1e_bus_read_topology(bus, places, CM1E_MAX_SLAVES, NULL) == CM1E_OK;
    for (uint32_t i = 0; i < bus->slave_count; i++)
        bus->slaves[i].ports = (cm1e_port_watch_t){.place = known && i < bus->scanned ? places[i] : unknown};
}

unsigned cm1e_bus_open_ports(const cm1e_bus_t *bus, uint16_t position)
{
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    unsigned open = 0;
    const bool stays = slave && slave->ports.place.known && !slave->hot.optional;
    for (unsigned port = 0; port < CM1E_PORTS && stays; port++)
        open |= (unsigned)slave->ports.place.open[port] << port;
    return open;
}

void cm1e_port_sentence(const cm1e_bus_t *bus, uint16_t position, int port, cm1e_port_fault_t fault, uint32_t count,
                        char *text, size_t size)
{
    static const char *const words[CM1E_PORT_FAULTS] = {
        "damaged frames", "receive errors", "frames that were damaged before it", "lost links",
    };
    char cable[96];
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    const cm1e_slave_place_t unknown = {.known = false};
    cm1e_cable_text(slave ? &slave->ports.place : &unknown, position, port, cable, sizeof cable);
    snprintf(text, size, "Slave %u counts %u %s more: %s.%s", position, count,
             (unsigned)fault < CM1E_PORT_FAULTS ? words[fault] : "faults", cable,
             fault == FAULT_FORWARDED_ERRORS ? "" : " Check that cable, its plugs and its shield.");
}
