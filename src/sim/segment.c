#include "sim/segment.h"

#include <stdlib.h>
#include <string.h>

#include "core/bytes.h"
#include "sim/esc_chip.h"

enum {
    SOURCE_MAC = 6, ETHER_TYPE = 12, ECAT_HEADER = 14, DATAGRAMS = 16, DATAGRAM_HEADER = 10, WORKING_COUNTER = 2,
    DATAGRAM_LENGTH = 6,
};
/* Of a controller that is switched on, until it answers. */
#define START_UP_NS INT64_C(20000000)
enum { LENGTH_MASK = 0x07FF, CIRCULATED = 0x4000, MORE_FOLLOW = 0x8000, TYPE_SHIFT = 12, TYPE_COMMANDS = 1 };
enum { LOCALLY_ADMINISTERED = 0x02, LOOP_CLOSED_ALWAYS = 3, PORT_1_SHIFT = 2, PORTS = 4 };

/* A place of the segment: a slave, and the cable before it. */
typedef struct place {
    bool cut;                /* the cable */
    bool reached;            /* a frame from the first interface passes this slave */
    int64_t arrival_ns;      /* such a frame is there so long after it entered */
    int64_t return_ns[PORTS]; /* and comes back into each port so long after that; -1: it does not */
} place_t;

struct cm1e_sim_segment {
    cm1e_sim_slave_t **slaves;
    uint32_t count;
    place_t *places;         /* [0] = the master, [1] = the first slave ... [count + 1] = behind the last */
    bool ring;
    bool topology_changed;
    bool fell_back;          /* any slave, since somebody asked */
    int64_t now_ns;
    /* Where frames go, from the topology: slaves that a frame passes (first, count), and the port it comes out of. */
    struct route {
        uint32_t first, count;
        int exit_port;
        bool circulates;     /* turned around at a closed port 0: the frame is marked */
        bool branches;       /* passes only the slaves that are reached: a branch may be cut off */
    } routes[2];
    cm1e_frame_fault_t fault;
    uint32_t fault_count;
    int64_t fault_delay_ns;
};

cm1e_sim_segment_t *cm1e_sim_segment_create_empty(void)
{
    cm1e_sim_segment_t *segment = calloc(1, sizeof *segment);
    place_t *places = calloc(2, sizeof *places);
    if (!segment || !places) {
        free(segment);
        free(places);
        return NULL;
    }
    segment->places = places;
    segment->topology_changed = true;
    return segment;
}

cm1e_error_t cm1e_sim_segment_add(cm1e_sim_segment_t *segment, cm1e_sim_slave_t *slave)
{
    if (!slave)
        return CM1E_ERROR_NO_MEMORY;
    const uint32_t count = segment->count + 1;
    cm1e_sim_slave_t **slaves = realloc(segment->slaves, count * sizeof *slaves);
    if (slaves)
        segment->slaves = slaves;
    place_t *places = slaves ? realloc(segment->places, (count + 2) * sizeof *places) : NULL;
    if (!places)
        return CM1E_ERROR_NO_MEMORY;
    places[count + 1] = (place_t){.cut = false};
    segment->places = places;
    segment->slaves[segment->count] = slave;
    segment->count = count;
    slave->topology_changed = &segment->topology_changed;
    slave->segment_fell_back = &segment->fell_back;
    segment->topology_changed = true;
    return CM1E_OK;
}

void cm1e_sim_segment_destroy(cm1e_sim_segment_t *segment)
{
    if (!segment)
        return;
    for (uint32_t i = 0; i < segment->count; i++)
        cm1e_sim_slave_destroy(segment->slaves[i]);
    free(segment->slaves);
    free(segment->places);
    free(segment);
}

uint32_t cm1e_sim_segment_slave_count(const cm1e_sim_segment_t *segment) { return segment ? segment->count : 0; }

cm1e_sim_slave_t *cm1e_sim_segment_slave(cm1e_sim_segment_t *segment, uint32_t position)
{
    return position >= 1 && position <= segment->count ? segment->slaves[position - 1] : NULL;
}

uint32_t cm1e_sim_segment_fallen_back(cm1e_sim_segment_t *segment)
{
    for (uint32_t i = 0; segment->fell_back && i < segment->count; i++)
        if (segment->slaves[i]->fell_back) {
            segment->slaves[i]->fell_back = false;
            return i + 1;
        }
    segment->fell_back = false;
    return 0;
}

void cm1e_sim_segment_close_ring(cm1e_sim_segment_t *segment)
{
    if (!segment)
        return;
    segment->ring = true;
    segment->topology_changed = true;
}

void cm1e_sim_segment_cut(cm1e_sim_segment_t *segment, uint32_t position, bool cut)
{
    if (!segment || position < 1 || position > segment->count + 1)
        return;
    segment->places[position].cut = cut;
    segment->topology_changed = true;
}

void cm1e_sim_segment_detach(cm1e_sim_segment_t *segment, uint32_t position, bool keeps_power)
{
    cm1e_sim_slave_t *slave = cm1e_sim_segment_slave(segment, position);
    if (!slave)
        return;
    slave->detached = true;
    slave->attaching = false;
    if (!keeps_power)
        cm1e_sim_slave_reset(slave, ESC_NEVER);
    segment->topology_changed = true;
}

void cm1e_sim_segment_attach(cm1e_sim_segment_t *segment, uint32_t position)
{
    cm1e_sim_slave_t *slave = cm1e_sim_segment_slave(segment, position);
    if (!slave)
        return;
    if (slave->detached && !cm1e_sim_esc_present(slave)) {
        slave->attaching = true;
        cm1e_sim_slave_reset(slave, segment->now_ns + START_UP_NS);
        return;
    }
    slave->detached = false;
    segment->topology_changed = true;
}

/* ---- topology -------------------------------------------------------------------------------------------------- */

/* The slave that a slave is connected to: the one before it that is not pulled out, or that of its branch; 0: the
 * master. */
static uint32_t parent_of(const cm1e_sim_segment_t *segment, uint32_t position)
{
    const cm1e_sim_slave_t *slave = position <= segment->count ? segment->slaves[position - 1] : NULL;
    const bool branch = slave && slave->quirks.branch_of > 0 && slave->quirks.branch_of < position;
    uint32_t parent = branch ? slave->quirks.branch_of : position - 1;
    while (!branch && parent > 0 && segment->slaves[parent - 1]->detached)
        parent--;
    return parent;
}

/* The first slave that is not pulled out: the cable of the master leads to it. */
static uint32_t first_of(const cm1e_sim_segment_t *segment)
{
    uint32_t position = 1;
    while (position < segment->count && segment->slaves[position - 1]->detached)
        position++;
    return position;
}

static int port_of_parent(const cm1e_sim_segment_t *segment, uint32_t position)
{
    const cm1e_sim_slave_t *slave = position <= segment->count ? segment->slaves[position - 1] : NULL;
    return slave && slave->quirks.branch_of > 0 && slave->quirks.branch_of < position ? slave->quirks.branch_port : 1;
}

/* Whether the cable before slave `position` connects two partners that are switched on (count + 1: the ring's last). */
static bool cable_connects(const cm1e_sim_segment_t *segment, uint32_t position)
{
    const uint32_t count = segment->count;
    if (segment->places[position].cut || (position == count + 1 && !segment->ring))
        return false;
    const uint32_t parent = parent_of(segment, position);
    const bool before = parent == 0 || cm1e_sim_esc_present(segment->slaves[parent - 1]);
    const cm1e_sim_slave_t *slave = position <= count ? segment->slaves[position - 1] : NULL;
    const bool behind = !slave || (cm1e_sim_esc_present(slave) && !slave->detached);
    return before && behind;
}

/* The master may order port 1 closed (0x0101); port 0 follows its link. */
static bool port_1_ordered_closed(const cm1e_sim_slave_t *slave)
{
    return slave->quirks.loops || (slave->memory[ESC_DL_PORTS] >> PORT_1_SHIFT & 3) == LOOP_CLOSED_ALWAYS;
}

static bool port_1_open(const cm1e_sim_segment_t *segment, uint32_t position)
{
    return cable_connects(segment, position + 1) && !port_1_ordered_closed(segment->slaves[position - 1]);
}

/* Frames come to a slave if they come to its parent, and if the port there is open. */
static bool is_reached(const cm1e_sim_segment_t *segment, uint32_t position)
{
    const uint32_t parent = parent_of(segment, position);
    const bool closed = parent > 0 && port_of_parent(segment, position) == 1 &&
                        port_1_ordered_closed(segment->slaves[parent - 1]);
    return cable_connects(segment, position) && !closed && (parent == 0 || segment->places[parent].reached);
}

/* A frame goes from slave to slave in their order, and so out of the branches that it has been through. One time from a
 * slave to the next is as long as the way back. */
static void time_frame(cm1e_sim_segment_t *segment, bool returns)
{
    uint32_t at = 0;
    int64_t now_ns = -ESC_HOP_NS;
    for (uint32_t next = 1; next <= segment->count + 1; next++) {
        const bool out = next > segment->count;
        if (!out && !segment->places[next].reached)
            continue;
        const uint32_t parent = out ? 0 : parent_of(segment, next);
        for (; at && at != parent && (returns || !out); at = parent_of(segment, at)) {
            place_t *before = &segment->places[parent_of(segment, at)];
            now_ns += ESC_HOP_NS;
            before->return_ns[port_of_parent(segment, at)] = now_ns - before->arrival_ns;
        }
        if (out)
            break;
        now_ns += ESC_HOP_NS;
        segment->places[next].arrival_ns = now_ns;
        for (int port = 0; port < PORTS; port++)
            segment->places[next].return_ns[port] = -1;
        at = next;
    }
}

/* From the first slave on, into every branch, until a port is closed. */
static struct route primary_route(cm1e_sim_segment_t *segment)
{
    struct route route = {.exit_port = CM1E_SIM_PORT_LOST, .branches = true};
    if (!cable_connects(segment, first_of(segment)))
        return route;
    for (uint32_t position = 1; position <= segment->count; position++) {
        segment->places[position].reached = is_reached(segment, position);
        route.count = segment->places[position].reached ? position : route.count;
    }
    /* Out of the last open port the ring's end is reached. */
    const bool through = segment->count == 0 || (segment->places[segment->count].reached &&
                                                 port_1_open(segment, segment->count));
    route.exit_port = through && cable_connects(segment, segment->count + 1) ? CM1E_SIM_PORT_SECONDARY
                                                                             : CM1E_SIM_PORT_PRIMARY;
    time_frame(segment, route.exit_port == CM1E_SIM_PORT_PRIMARY);
    return route;
}

/* Backwards a frame passes no processing unit. Where port 0 of a slave is closed it turns around and is processed from
 * there to the end of the ring. */
static struct route secondary_route(const cm1e_sim_segment_t *segment)
{
    struct route route = {.exit_port = CM1E_SIM_PORT_LOST};
    uint32_t position = segment->count;
    if (!cable_connects(segment, position + 1) || (position && port_1_ordered_closed(segment->slaves[position - 1])))
        return route;
    while (position >= 1 && cable_connects(segment, position)) {
        position--;
        /* Frames do not enter by a port that is ordered closed. */
        if (position >= 1 && port_1_ordered_closed(segment->slaves[position - 1]))
            return route;
    }
    if (position == 0) {
        route.exit_port = CM1E_SIM_PORT_PRIMARY;
        return route;
    }
    route.first = position - 1;
    route.count = segment->count - route.first;
    route.exit_port = CM1E_SIM_PORT_SECONDARY;
    route.circulates = true;
    return route;
}

static void update_topology(cm1e_sim_segment_t *segment)
{
    segment->topology_changed = false;
    for (uint32_t position = 1; position <= segment->count; position++) {
        cm1e_sim_slave_t *slave = segment->slaves[position - 1];
        if (!cm1e_sim_esc_present(slave))
            continue;
        bool link[PORTS] = {cable_connects(segment, position)};
        for (uint32_t child = position + 1; child <= segment->count + 1; child++)
            if (parent_of(segment, child) == position)
                link[port_of_parent(segment, child)] |= cable_connects(segment, child);
        const bool open[PORTS] = {link[0], link[1] && !port_1_ordered_closed(slave), link[2], link[3]};
        cm1e_sim_esc_links(slave, link, open);
    }
    segment->routes[CM1E_SIM_PORT_PRIMARY] = primary_route(segment);
    segment->routes[CM1E_SIM_PORT_SECONDARY] = secondary_route(segment);
}

void cm1e_sim_segment_advance(cm1e_sim_segment_t *segment, int64_t now_ns)
{
    if (!segment)
        return;
    if (now_ns > segment->now_ns)
        segment->now_ns = now_ns;
    for (uint32_t i = 0; i < segment->count; i++)
        cm1e_sim_esc_advance(segment->slaves[i], segment->now_ns);
    if (segment->topology_changed)
        update_topology(segment);
}

int64_t cm1e_sim_segment_due(const cm1e_sim_segment_t *segment)
{
    int64_t first = ESC_NEVER;
    for (uint32_t i = 0; segment && i < segment->count; i++) {
        const int64_t due = cm1e_sim_esc_due(segment->slaves[i]);
        first = due < first ? due : first;
    }
    return first;
}

/* ---- frames ---------------------------------------------------------------------------------------------------- */

/* Walks the datagrams; returns the end of the last one that is whole, 0 where not even the first is. */
static size_t whole_datagrams(const uint8_t *frame, size_t end)
{
    size_t at = DATAGRAMS, whole = 0;
    while (end - at >= DATAGRAM_HEADER + WORKING_COUNTER) {
        const uint16_t length = cm1e_get_u16(frame + at + DATAGRAM_LENGTH);
        const size_t bytes = DATAGRAM_HEADER + (size_t)(length & LENGTH_MASK) + WORKING_COUNTER;
        if (bytes > end - at)
            return whole;
        at += bytes;
        whole = at;
        if (!(length & MORE_FOLLOW))
            break;
    }
    return whole;
}

/* The end of the datagrams to process; 0: not a frame for slaves. Padding behind the EtherCAT length is ignored. */
static size_t frame_end(const uint8_t *frame, size_t length)
{
    if (length < DATAGRAMS || frame[ETHER_TYPE] != 0x88 || frame[ETHER_TYPE + 1] != 0xA4)
        return 0;
    const uint16_t header = cm1e_get_u16(frame + ECAT_HEADER);
    if (header >> TYPE_SHIFT != TYPE_COMMANDS)
        return 0;
    const size_t end = DATAGRAMS + (size_t)(header & LENGTH_MASK);
    return end <= length ? whole_datagrams(frame, end) : 0;
}

static void mark_circulated(uint8_t *frame, size_t end)
{
    for (size_t at = DATAGRAMS; at < end;) {
        const uint16_t length = cm1e_get_u16(frame + at + DATAGRAM_LENGTH);
        cm1e_put_u16(frame + at + DATAGRAM_LENGTH, (uint16_t)(length | CIRCULATED));
        at += DATAGRAM_HEADER + (size_t)(length & LENGTH_MASK) + WORKING_COUNTER;
    }
}

/* From the second interface they are a line. */
static void stamp_frame(cm1e_sim_segment_t *segment, const struct route *route, uint32_t i)
{
    static const int64_t no_returns[PORTS] = {-1, -1, -1, -1};
    const place_t *place = &segment->places[route->first + i + 1];
    const int64_t arrival_ns = route->branches ? place->arrival_ns : (int64_t)i * ESC_HOP_NS;
    cm1e_sim_esc_dc_frame(segment->slaves[route->first + i], segment->now_ns + arrival_ns,
                          route->branches ? place->return_ns : no_returns);
}

static void pass_slaves(cm1e_sim_segment_t *segment, const struct route *route, uint8_t *frame, size_t end)
{
    for (uint32_t i = 0; i < route->count; i++) {
        if (route->branches && !segment->places[route->first + i + 1].reached)
            continue;
        stamp_frame(segment, route, i);
        cm1e_sim_esc_frame(segment->slaves[route->first + i], frame + DATAGRAMS, frame + end);
    }
    if (route->count)
        frame[SOURCE_MAC] |= LOCALLY_ADMINISTERED;
}

int cm1e_sim_segment_process(cm1e_sim_segment_t *segment, int entry_port, uint8_t *frame, size_t length, int64_t now_ns)
{
    cm1e_sim_segment_advance(segment, now_ns);
    if (!segment || !frame)
        return CM1E_SIM_PORT_LOST;
    if (entry_port != CM1E_SIM_PORT_PRIMARY && entry_port != CM1E_SIM_PORT_SECONDARY)
        return CM1E_SIM_PORT_LOST;
    const struct route route = segment->routes[entry_port];
    if (route.exit_port == CM1E_SIM_PORT_LOST)
        return CM1E_SIM_PORT_LOST;
    const size_t end = frame_end(frame, length);
    if (end == 0) {
        /* The first processing unit counts frames that it cannot read. */
        if (route.count)
            cm1e_sim_esc_count(segment->slaves[route.first], ESC_UNIT_ERRORS);
        return CM1E_SIM_PORT_LOST;
    }
    if (route.circulates) {
        /* A frame that passes a second time would circulate for ever: it is destroyed. */
        if (cm1e_get_u16(frame + DATAGRAMS + DATAGRAM_LENGTH) & CIRCULATED)
            return CM1E_SIM_PORT_LOST;
        mark_circulated(frame, end);
    }
    pass_slaves(segment, &route, frame, end);
    return route.exit_port;
}

/* ---- faults on frames ------------------------------------------------------------------------------------------ */

void cm1e_sim_segment_set_frame_fault(cm1e_sim_segment_t *segment, cm1e_frame_fault_t kind, uint32_t count,
                                      int64_t delay_ns)
{
    if (!segment)
        return;
    segment->fault = kind;
    segment->fault_count = count;
    segment->fault_delay_ns = delay_ns;
}

cm1e_frame_fault_t cm1e_sim_segment_next_frame_fault(cm1e_sim_segment_t *segment, int64_t *delay_ns)
{
    if (delay_ns)
        *delay_ns = 0;
    if (!segment || segment->fault_count == 0)
        return CM1E_FRAME_OK;
    segment->fault_count--;
    if (segment->fault == CM1E_FRAME_DELAY && delay_ns)
        *delay_ns = segment->fault_delay_ns;
    return segment->fault;
}
