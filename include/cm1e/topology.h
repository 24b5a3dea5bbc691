/**
 * @file topology.h
 * How the slaves of a bus are wired: which port of which slave each of them is connected to. It is read from the port
 * states that the slave controllers show (register 0x0110, ETG.1000.4) and from the order of the slaves.
 */
#ifndef CM1E_TOPOLOGY_H
#define CM1E_TOPOLOGY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cm1e/api.h"
#include "cm1e/bus.h"
#include "cm1e/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The place of one slave. A zeroed struct is one whose place is not known. */
typedef struct cm1e_slave_place {
    bool known;                 /**< false: the port states do not explain the order of the slaves */
    uint16_t parent;            /**< position of the slave before it; 0: this computer */
    uint8_t parent_port;        /**< the port of the parent at which it is */
    uint8_t entry_port;         /**< the port by which frames enter: 0, unless that is closed */
    bool link[CM1E_PORTS];      /**< there is a link */
    bool open[CM1E_PORTS];      /**< frames pass; a port with a link that is closed loops back */
    uint16_t next[CM1E_PORTS];  /**< position of the slave that is connected there; 0: none. Not of the entry port */
    uint8_t next_port[CM1E_PORTS]; /**< the entry port of that slave */
} cm1e_slave_place_t;

/** Reads the places of all slaves after cm1e_bus_scan(): while no cycle runs, or through the program that runs the
 *  network (cm1e_bus_open_attached()). `places[0]` is that of the first slave; at most `room` are written. Returns
 *  CM1E_ERROR_TIMEOUT if a slave does not answer; but while a program runs the network, only the place of that slave is
 *  not known, if others answer. Where those behind it answer, it has `parent` and `next` of the program's start.
 *  Returns CM1E_ERROR_STATE before a scan or in a task. @rt block */
CM1E_API cm1e_error_t cm1e_bus_topology(cm1e_bus_t *bus, cm1e_slave_place_t *places, size_t room, cm1e_diag_t *diag);
/** Names the cable at a port in words: "between slave 1 (port 1, OUT) and slave 2 (port 0, IN)". `place` is that of the
 *  slave at `position`. 96 bytes are enough. @rt block */
CM1E_API void cm1e_cable_text(const cm1e_slave_place_t *place, uint16_t position, int port, char *text, size_t size);

/** What the ports of a slave have counted since the bus reached Operational. The bus reads one slave every 20 ms while
 *  the cycle runs. A counter of a slave stops at 255 since its power-on; what follows is not seen. */
typedef struct cm1e_port_faults {
    uint32_t invalid_frames, receive_errors; /**< damaged on the cable at this port */
    uint32_t forwarded_errors;               /**< damaged before, at another slave */
    uint32_t lost_links;
} cm1e_port_faults_t;

/** The faults of one port; zeros if there is no such slave or port. @rt any */
CM1E_API cm1e_port_faults_t cm1e_bus_port_faults(const cm1e_bus_t *bus, uint16_t position, int port);

/** A redundant ring (cm1e_bus_config_t.second_interface): whether it is whole, and where it is broken. */
typedef struct cm1e_bus_ring_t {
    bool used;       /**< false: there is no second interface, and the other members are zero */
    bool broken;     /**< frames do not pass from one interface to the other */
    bool placed;     /**< it is known where; some cycles after it broke */
    uint16_t behind; /**< position of the last slave that the first interface reaches; 0: none */
    uint16_t before; /**< position of the first slave that the second interface reaches; behind the last slave: none.
                          Slaves between the two are reached from neither side: a second cable is broken, or they have
                          no power */
    uint64_t breaks; /**< times that it was found broken since the bus was opened; only grows */
} cm1e_bus_ring_t;

/** Does the work of cm1e_bus_ring(), for a program with this size of the struct. @rt cycle */
CM1E_API void cm1e_bus_ring_sized(const cm1e_bus_t *bus, cm1e_bus_ring_t *ring, size_t size);
/** The ring of an Operational bus, as the last frames have shown it. Belongs to the thread that owns the bus.
 *  @rt cycle */
static inline void cm1e_bus_ring(const cm1e_bus_t *bus, cm1e_bus_ring_t *ring)
{
    cm1e_bus_ring_sized(bus, ring, sizeof *ring);
}
/** Writes it as sentences: 'The ring is broken between slave 2 ("Y", CM1-E) and slave 3 ("Z", CM1-E). ...'. 512 bytes
 *  are enough. @rt block */
CM1E_API void cm1e_bus_ring_text(const cm1e_bus_t *bus, const cm1e_bus_ring_t *ring, char *text, size_t size);

#ifdef __cplusplus
}
#endif
#endif
