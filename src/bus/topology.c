#include "cm1e/topology.h"

#include <stdio.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "core/bytes.h"
#include "core/in_task.h"

/* DL status (ETG.1000.4 table 36): a link per port from bit 4 on, then two bits per port from bit 8 on. */
enum { REG_DL_STATUS = 0x0110, LINK_BIT = 4, LOOP_CLOSED_BIT = 8, COMMUNICATION_BIT = 9 };

/** The ports in the order in which a frame leaves a slave that it entered by port 0. */
static const uint8_t order_of_ports[CM1E_PORTS] = {0, 3, 1, 2};

static void find_entry(cm1e_slave_place_t *place)
{
    for (unsigned i = CM1E_PORTS; i-- > 0;)
        if (place->open[order_of_ports[i]])
            place->entry_port = order_of_ports[i];
}

static void take_ports(cm1e_slave_place_t *place, uint16_t status)
{
    *place = (cm1e_slave_place_t){0};
    for (unsigned port = 0; port < CM1E_PORTS; port++) {
        const bool closed = status >> (LOOP_CLOSED_BIT + 2 * port) & 1;
        place->link[port] = status >> (LINK_BIT + port) & 1;
        place->open[port] = !closed && (status >> (COMMUNICATION_BIT + 2 * port) & 1);
    }
    find_entry(place);
}

/** A port at which a slave is expected that has not been met yet. */
typedef struct waiting_port {
    uint16_t position;
    uint8_t port;
} waiting_port_t;

typedef struct walk {
    waiting_port_t waiting[CM1E_PORTS * CM1E_MAX_SLAVES];
    unsigned count;
} walk_t;

/** Connects a slave. Frames go as deep as they can before they come back, so a slave is at the port that was met
 *  last. */
static void connect_slave(walk_t *walk, cm1e_slave_place_t *places, uint16_t position)
{
    cm1e_slave_place_t *place = &places[position - 1];
    place->known = position == 1 || walk->count > 0;
    if (position > 1 && walk->count > 0) {
        const waiting_port_t at = walk->waiting[--walk->count];
        place->parent = at.position;
        place->parent_port = at.port;
        places[at.position - 1].next[at.port] = position;
        places[at.position - 1].next_port[at.port] = place->entry_port;
    }
    for (unsigned i = CM1E_PORTS; i-- > 0;) {
        const uint8_t port = order_of_ports[i];
        if (place->open[port] && port != place->entry_port)
            walk->waiting[walk->count++] = (waiting_port_t){position, port};
    }
}

cm1e_error_t cm1e_bus_topology(cm1e_bus_t *bus, cm1e_slave_place_t *places, size_t room, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_bus_topology()", "", diag);
    if (!bus)
        return cm1e_bus_missing("cm1e_bus_topology()", diag);
    if (!places && room > 0)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "cm1e_bus_topology() needs room for the places.");
    if (bus->phase < BUS_SCANNED || bus->phase >= BUS_OPERATING)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "cm1e_bus_topology() needs a scanned bus whose cycle does not "
                             "run.");
    cm1e_bus_enter(bus);
    return cm1e_bus_read_topology(bus, places, room, diag);
}

/** Where the slaves of a program that runs were when it began. Behind one whose ports it does not tell, none is
 *  known. */
static void connect_told(const cm1e_bus_t *bus, cm1e_slave_place_t *began)
{
    walk_t walk = {.count = 0};
    bool told = true;
    for (uint16_t position = 1; position <= bus->scanned; position++) {
        const cm1e_slave_place_t *place = &bus->slaves[position - 1].ports.place;
        began[position - 1] = (cm1e_slave_place_t){0};
        told = told && place->known;
        if (!told)
            continue;
        memcpy(began[position - 1].open, place->open, sizeof place->open);
        find_entry(&began[position - 1]);
        connect_slave(&walk, began, position);
    }
}

/** A slave of a program that runs does not answer any more. Where it `began`, it may be there without the address that
 *  it had, as after a restart, and lets frames pass, if a slave is expected at that port: then it is between those that
 *  it was between. Elsewhere no frame passes it, and the others are wired without it, as without an optional one. */
static void connect_silent(walk_t *walk, cm1e_slave_place_t *places, uint16_t position, const cm1e_slave_place_t *began)
{
    cm1e_slave_place_t *place = &places[position - 1];
    *place = (cm1e_slave_place_t){0};
    const waiting_port_t *next = walk->count > 0 ? &walk->waiting[walk->count - 1] : NULL;
    if (!began->known || !next || next->position != began->parent || next->port != began->parent_port)
        return;
    memcpy(place->open, began->open, sizeof place->open);
    place->entry_port = began->entry_port;
    connect_slave(walk, places, position);
    memset(place->open, 0, sizeof place->open); /* what they are now is not known */
    place->known = false;
}

cm1e_error_t cm1e_bus_read_topology(cm1e_bus_t *bus, cm1e_slave_place_t *places, size_t room, cm1e_diag_t *diag)
{
    walk_t walk = {.count = 0};
    cm1e_slave_place_t began[CM1E_MAX_SLAVES];
    uint32_t gone = 0;
    if (bus->remote)
        connect_told(bus, began);
    for (uint16_t position = 1; position <= bus->scanned && position <= room; position++) {
        uint8_t status[2] = {0};
        if (!cm1e_bus_read_registers(bus, position, REG_DL_STATUS, status, sizeof status)) {
            if (!bus->remote || ++gone == bus->scanned)
                return cm1e_diag_set(diag, CM1E_ERROR_TIMEOUT, 0, "Slave %u does not answer when its ports are read.",
                                     position);
            connect_silent(&walk, places, position, &began[position - 1]);
            continue;
        }
        take_ports(&places[position - 1], cm1e_get_u16(status));
        connect_slave(&walk, places, position);
    }
    return CM1E_OK;
}

static const char *port_name(int port) { return port == 0 ? ", IN" : port == 1 ? ", OUT" : ""; }
static const char *port_alone(int port) { return port == 0 ? " (IN)" : port == 1 ? " (OUT)" : ""; }

void cm1e_cable_text(const cm1e_slave_place_t *place, uint16_t position, int port, char *text, size_t size)
{
    const bool valid = place && port >= 0 && port < CM1E_PORTS;
    if (!text)
        return;
    if (!valid || !place->known)
        snprintf(text, size, "at port %d%s of slave %u", port, port_alone(port), position);
    else if (port == place->entry_port && place->parent == 0)
        snprintf(text, size, "between this computer and slave %u (port %d%s)", position, port, port_name(port));
    else if (port == place->entry_port)
        snprintf(text, size, "between slave %u (port %u%s) and slave %u (port %d%s)", place->parent, place->parent_port,
                 port_name(place->parent_port), position, port, port_name(port));
    else if (place->next[port])
        snprintf(text, size, "between slave %u (port %d%s) and slave %u (port %d%s)", position, port, port_name(port),
                 place->next[port], place->next_port[port], port_name(place->next_port[port]));
    else
        snprintf(text, size, "at port %d%s of slave %u, where no slave is", port, port_alone(port), position);
}
