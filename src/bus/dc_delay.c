#include "bus/dc_delay.h"

/* A frame enters by port 0, and visits what is connected to the ports in this order. */
static const uint8_t port_order[CM1E_DC_PORTS] = {0, 3, 1, 2};

static bool is_open(const cm1e_dc_node_t *node, unsigned port) { return node->open_ports >> port & 1; }

/** The open port that the frame passes before `port`. */
static unsigned port_before(const cm1e_dc_node_t *node, unsigned port)
{
    unsigned before = 0;
    for (unsigned i = 0; i < CM1E_DC_PORTS && port_order[i] != port; i++)
        if (is_open(node, port_order[i]))
            before = port_order[i];
    return before;
}

static unsigned last_port(const cm1e_dc_node_t *node)
{
    unsigned last = 0;
    for (unsigned i = 1; i < CM1E_DC_PORTS; i++)
        if (is_open(node, port_order[i]))
            last = port_order[i];
    return last;
}

/** Takes the next port to which nothing is connected so far; false: there is none. */
static bool take_port(cm1e_dc_node_t *node, uint8_t *port)
{
    for (unsigned i = 1; i < CM1E_DC_PORTS; i++)
        if (node->free_ports >> port_order[i] & 1) {
            *port = port_order[i];
            node->free_ports &= (uint8_t) ~(1u << *port);
            return true;
        }
    return false;
}

/** Finds the parent of every slave. The slaves stand in the order of the frame, so each is connected to the last slave
 *  before it that has a port left. */
static void connect(cm1e_dc_node_t *nodes, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        int parent = (int)i - 1;
        nodes[i].free_ports = nodes[i].open_ports & 0x0E;
        while (parent >= 0 && !take_port(&nodes[parent], &nodes[i].parent_port))
            parent = nodes[parent].parent;
        nodes[i].parent = parent;
    }
}

/** Replaces parents without a clock by the nearest one with a clock. */
static bool find_clock_before(const cm1e_dc_node_t *nodes, const cm1e_dc_node_t *node, int *parent, unsigned *port)
{
    *parent = node->parent;
    *port = node->parent_port;
    while (*parent >= 0 && !nodes[*parent].has_clock) {
        *port = nodes[*parent].parent_port;
        *parent = nodes[*parent].parent;
    }
    return *parent >= 0;
}

void cm1e_dc_delays(cm1e_dc_node_t *nodes, uint32_t count)
{
    connect(nodes, count);
    for (uint32_t i = 0; i < count; i++) {
        cm1e_dc_node_t *node = &nodes[i];
        int at;
        unsigned port;
        node->delay_ns = 0;
        if (!node->has_clock || !find_clock_before(nodes, node, &at, &port))
            continue;
        const cm1e_dc_node_t *parent = &nodes[at];
        const uint32_t out = parent->times[port_before(parent, port)];
        const uint32_t behind = parent->times[port] - out;                        /* there and back, and all behind */
        const uint32_t own = node->times[last_port(node)] - node->times[0];       /* all slaves behind this one */
        const uint32_t before = out - parent->times[0];                           /* branches visited before */
        node->delay_ns = parent->delay_ns + before + (behind > own ? (behind - own) / 2 : 0);
    }
}
