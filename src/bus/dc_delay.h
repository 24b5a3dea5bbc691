/**
 * @file dc_delay.h
 * How long a frame is on its way from the first slave to each other one, from the times at which it came in at the
 * ports of all slaves (ETG.1000.4, propagation delay measurement). Without frames and clock.
 */
#ifndef CM1E_BUS_DC_DELAY_H
#define CM1E_BUS_DC_DELAY_H

#include <stdbool.h>
#include <stdint.h>

enum { CM1E_DC_PORTS = 4 };

/** A slave, in the order in which the frame is processed. */
typedef struct cm1e_dc_node {
    uint8_t open_ports;             /**< bit n: port n has a link and is not closed */
    bool has_clock;
    uint32_t times[CM1E_DC_PORTS];  /**< receive times by its own clock; only with a clock */
    uint32_t delay_ns;              /**< result: from the first clock; 0 without a clock */
    int parent;                     /**< while computing: the slave before it, -1: none; and the port there */
    uint8_t parent_port, free_ports;
} cm1e_dc_node_t;

/** Fills in the delays. A slave without a clock counts as a part of the cable; what it branches off is not known then,
 *  and the delay behind it is a mean. */
void cm1e_dc_delays(cm1e_dc_node_t *nodes, uint32_t count);

#endif
