#include "bus/bus_internal.h"
#include "core/bytes.h"

/** One slave's AL status in each cycle, in turn; now and then the counters of its ports instead. A slave counts as lost
 *  after three unanswered questions in a row: a single one may be a disturbed frame. */
enum { AL_STATUS_BYTES = 6, UNANSWERED_LIMIT = 3 };

void cm1e_supervision_note(cm1e_bus_slave_t *slave, uint16_t al_state, uint16_t al_status_code)
{
    slave->unanswered = 0;
    if (al_status_code != slave->watch.al_status_code)
        cm1e_dc_note_status(slave, al_status_code);
    slave->watch = (cm1e_slave_watch_t){.al_state = al_state, .al_status_code = al_status_code};
    slave->info.al_state = al_state;
    slave->info.al_status_code = al_status_code;
}

static uint32_t next_of(const cm1e_bus_t *bus, uint32_t place) { return place + 1 < bus->slave_count ? place + 1 : 0; }

static void ask_state(cm1e_bus_t *bus)
{
    bus->supervised.place = next_of(bus, bus->supervised.place);
    cm1e_datagram_set(&bus->supervised.datagram, COMMAND_FPRD, bus->slaves[bus->supervised.place].facts.station,
                      REG_AL_STATUS, AL_STATUS_BYTES);
}

/** The counters have a turn of their own, so that every slave gets one. */
static void ask_ports(cm1e_bus_t *bus, int64_t now_ns)
{
    bus->supervised.ports.due_ns = now_ns + CM1E_PORTS_PACE_NS;
    bus->supervised.ports.place = next_of(bus, bus->supervised.ports.place);
    cm1e_port_watch_ask(&bus->slaves[bus->supervised.ports.place], &bus->supervised.datagram);
}

void cm1e_supervision_send(cm1e_bus_t *bus, int64_t now_ns)
{
    if (bus->supervised.sent || bus->slave_count == 0)
        return;
    bus->supervised.ports.asked = false;
    if (cm1e_ring_watch_ask(bus, &bus->supervised.datagram, now_ns)) {
        cm1e_soem_post(bus->soem, &bus->supervised.datagram, now_ns);
        bus->supervised.sent = true;
        return;
    }
    if (cm1e_dc_next_look(bus, &bus->supervised.datagram)) {
        cm1e_soem_post(bus->soem, &bus->supervised.datagram, now_ns);
        bus->supervised.sent = true;
        return;
    }
    bus->supervised.ports.asked = bus->phase == BUS_OPERATING && now_ns >= bus->supervised.ports.due_ns;
    if (bus->supervised.ports.asked)
        ask_ports(bus, now_ns);
    else
        ask_state(bus);
    cm1e_soem_post(bus->soem, &bus->supervised.datagram, now_ns);
    bus->supervised.sent = true;
}

/** No axis requests the recovery of a device between the axes, but while it is missing, the working counter of all is
 *  wrong. So it is brought back without a request, always with zeros as outputs. A motor is never brought back without
 *  a request. */
static void recover_unasked(cm1e_bus_t *bus, cm1e_bus_slave_t *slave)
{
    if (!cm1e_bus_has_motors(slave) && slave->watch.al_state != CM1E_AL_OP)
        cm1e_bus_request_recovery(bus, slave->info.position);
}

void cm1e_supervision_receive(cm1e_bus_t *bus, int64_t now_ns)
{
    cm1e_datagram_t *d = &bus->supervised.datagram;
    cm1e_bus_slave_t *slave = &bus->slaves[bus->supervised.place];
    if (!bus->supervised.sent)
        return;
    if (!cm1e_soem_take(bus->soem, d, 0)) {
        if (now_ns - d->sent_ns < CM1E_FRAME_LOST_NS)
            return;
        cm1e_soem_drop(bus->soem, d);
    }
    bus->supervised.sent = false;
    if (d->command == COMMAND_BRD) {
        if (d->working_counter > 0)
            cm1e_ring_watch_take(bus);
        return;
    }
    if (d->offset == REG_DC_DIFFERENCE) {
        cm1e_dc_looked(bus, d);
        return;
    }
    if (bus->supervised.ports.asked) {
        if (d->working_counter == 1)
            cm1e_port_watch_take(bus, &bus->slaves[bus->supervised.ports.place], d);
        return;
    }
    if (d->working_counter == 1) {
        cm1e_supervision_note(slave, cm1e_get_u16(d->data), cm1e_get_u16(d->data + 4));
    } else if (d->working_counter == 0 && ++slave->unanswered >= UNANSWERED_LIMIT) {
        slave->watch = (cm1e_slave_watch_t){.lost = true};
        slave->info.al_state = slave->info.al_status_code = 0;
    }
    recover_unasked(bus, slave);
}

cm1e_slave_watch_t cm1e_bus_slave_watch(const cm1e_bus_t *bus, uint16_t position)
{
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    if (!slave)
        return (cm1e_slave_watch_t){.lost = true};
    cm1e_slave_watch_t watch = slave->watch;
    watch.silent = slave->silent_cycles >= bus->config.lost_cycles_limit;
    watch.fresh = bus->last_error == CM1E_OK || (bus->partly_fresh && slave->silent_cycles == 0);
    return watch;
}

void cm1e_bus_request_recovery(cm1e_bus_t *bus, uint16_t position)
{
    cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    if (slave && bus->phase == BUS_OPERATING && cm1e_recovery_idle(&slave->recovery))
        cm1e_recovery_begin(slave);
}
