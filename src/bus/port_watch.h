/**
 * @file port_watch.h
 * The error counters of the ports, read by the supervision while the cycle runs.
 */
#ifndef CM1E_BUS_PORT_WATCH_H
#define CM1E_BUS_PORT_WATCH_H

#include "bus/datagram.h"
#include "cm1e/topology.h"

/** The kinds of faults, in the order of cm1e_port_faults_t. */
typedef enum cm1e_port_fault {
    FAULT_INVALID_FRAMES = 0, FAULT_RECEIVE_ERRORS, FAULT_FORWARDED_ERRORS, FAULT_LOST_LINKS, CM1E_PORT_FAULTS,
} cm1e_port_fault_t;

/** The counters of one slave. */
typedef struct cm1e_port_watch {
    cm1e_slave_place_t place;                     /**< its place when the bus reached Operational */
    bool seen;                                    /**< `last` is known */
    uint8_t last[CM1E_PORTS][CM1E_PORT_FAULTS];   /**< as read last */
    uint32_t total[CM1E_PORTS][CM1E_PORT_FAULTS]; /**< atomic; since Operational */
} cm1e_port_watch_t;

/** Whose counters the bus reads in turn. */
typedef struct cm1e_port_turn {
    uint32_t place;
    int64_t due_ns;   /**< when the next ones are read */
    uint64_t news;    /**< faults of all ports since the bus was opened */
    bool asked;       /**< the datagram of the supervision asks for counters, not for an AL status */
} cm1e_port_turn_t;

typedef struct cm1e_bus_slave cm1e_bus_slave_t;

/** Notes the places of the slaves, before the cycle runs; a slave that does not answer has none. @rt init */
void cm1e_port_watch_begin(cm1e_bus_t *bus);
/** Fills the datagram. @rt cycle */
void cm1e_port_watch_ask(const cm1e_bus_slave_t *slave, cm1e_datagram_t *datagram);
/** Takes its answer. @rt cycle */
void cm1e_port_watch_take(cm1e_bus_t *bus, cm1e_bus_slave_t *slave, const cm1e_datagram_t *datagram);

/** Faults of all ports since the bus was opened. @rt cycle */
uint64_t cm1e_bus_port_news(const cm1e_bus_t *bus);
/** @rt any */
uint32_t cm1e_bus_port_fault(const cm1e_bus_t *bus, uint32_t position, unsigned port, cm1e_port_fault_t fault);
/** A sentence: 'Slave 2 counts 3 damaged frames more: between slave 1 (port 1, OUT) and slave 2 (port 0, IN).'
 *  @rt block */
void cm1e_port_sentence(const cm1e_bus_t *bus, uint16_t position, int port, cm1e_port_fault_t fault, uint32_t count,
                        char *text, size_t size);

#endif
