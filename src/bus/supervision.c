#include "bus/bus_internal.h"
#include "core/bytes.h"

/** The supervision reads the AL status of one slave in each cycle, in turn, and sometimes the counters of its ports
 *  instead. A slave counts as lost after three unanswered questions in a row, because a single one may be a disturbed
 *  frame. */
enum { AL_STATUS_BYTES = 6, UNANSWERED_LIMIT = 3 };

void cm1e_supervision_note(cm1e_bus_slave_t *slave, uint16_t al_state, uint16_t al_status_code)
{
    slave->unanswered = 0;
    if (al_status_code != slave->watch.al_status_code)
        cm1e_dc_note_status(slave, al_status_code);
    slave->watch = (cm1e_slave_watch_t){.al_state = al_state, .al_status_code = al_status_code,
                                        .absent = slave->hot.away};
    slave->info.al_state = al_state;
    slave->info.al_status_code = al_status_code;
}

static uint32_t next_of(const cm1e_bus_t *bus, uint32_t place) { return place + 1 < bus->slave_count ? place + 1 : 0; }

/** The next slave that may have left: it is asked first. */
static uint32_t next_in_doubt(cm1e_bus_t *bus)
{
    for (uint32_t n = 0; n < bus->slave_count; n++) {
        bus->search.doubted = next_of(bus, bus->search.doubted);
        const cm1e_bus_slave_t *slave = &bus->slaves[bus->search.doubted];
        if (slave->hot.optional && slave->hot.counted)
            return bus->search.doubted;
    }
    return next_of(bus, bus->supervised.place);
}

static void ask_state(cm1e_bus_t *bus)
{
    if (bus->search.in_doubt)
        bus->supervised.place = next_in_doubt(bus);
    else
        bus->supervised.place = next_of(bus, bus->supervised.place);
    for (uint32_t n = 0; n < bus->slave_count && bus->slaves[bus->supervised.place].hot.away; n++)
        bus->supervised.place = next_of(bus, bus->supervised.place);
    cm1e_datagram_set(&bus->supervised.datagram, COMMAND_FPRD, bus->slaves[bus->supervised.place].facts.station,
                      REG_AL_STATUS, AL_STATUS_BYTES);
}

/** The counters have a turn of their own, so that every slave gets one. */
static void ask_ports(cm1e_bus_t *bus, int64_t now_ns)
{
    bus->supervised.ports.due_ns = now_ns + CM1E_PORTS_PACE_NS;
    for (uint32_t n = 0; n < bus->slave_count; n++) {
        bus->supervised.ports.place = next_of(bus, bus->supervised.ports.place);
        if (!bus->slaves[bus->supervised.ports.place].hot.away)
            break;
    }
    cm1e_port_watch_ask(&bus->slaves[bus->supervised.ports.place], &bus->supervised.datagram);
}

/** Asks what comes before the states of the slaves and their counters. */
static bool ask_what_comes_first(cm1e_bus_t *bus, int64_t now_ns)
{
    cm1e_datagram_t *d = &bus->supervised.datagram;
    bus->search.sent = false; /* the question before may have been given up */
    if (cm1e_ring_watch_ask(bus, d, now_ns) || cm1e_dc_next_look(bus, d))
        return true;
    bus->search.sent = bus->phase == BUS_OPERATING && !bus->search.in_doubt && cm1e_search_next(bus, d, now_ns);
    return bus->search.sent;
}

void cm1e_supervision_ask(cm1e_bus_t *bus, int64_t now_ns)
{
    bus->supervised.asks = !bus->supervised.sent && bus->slave_count > 0;
    if (!bus->supervised.asks)
        return;
    bus->supervised.ports.asked = false;
    if (!ask_what_comes_first(bus, now_ns)) {
        bus->supervised.ports.asked = bus->phase == BUS_OPERATING && now_ns >= bus->supervised.ports.due_ns;
        if (bus->supervised.ports.asked)
            ask_ports(bus, now_ns);
        else
            ask_state(bus);
    }
    if (bus->last_error != CM1E_ERROR_BUS_LOST)
        cm1e_soem_offer(bus->soem, &bus->supervised.datagram);
}

void cm1e_supervision_send(cm1e_bus_t *bus, int64_t now_ns)
{
    if (!bus->supervised.asks)
        return;
    if (!cm1e_soem_rides(bus->soem, &bus->supervised.datagram, now_ns))
        cm1e_soem_post(bus->soem, &bus->supervised.datagram, now_ns);
    bus->supervised.sent = true;
}

/** Requests the recovery of a device that no axis uses. While it is missing, the working counter of all slaves is
 *  wrong. So it is brought back without a request, always with zeros as outputs. A motor is brought back without a
 *  request only if the configuration says so. */
static void recover_unasked(cm1e_bus_t *bus, cm1e_bus_slave_t *slave)
{
    if (bus->phase == BUS_OPERATING && slave->watch.al_state != CM1E_AL_OP && cm1e_hot_may_recover(slave, false))
        cm1e_recovery_begin(bus, slave);
}

void cm1e_supervision_lose(cm1e_bus_t *bus, cm1e_bus_slave_t *slave)
{
    slave->watch = (cm1e_slave_watch_t){.lost = true, .absent = slave->hot.away};
    slave->info.al_state = slave->info.al_status_code = 0;
    if (!slave->hot.optional)
        return;
    cm1e_recovery_cancel(slave);
    cm1e_coe_cancel(&slave->coe, CM1E_ERROR_BUS_LOST);
    slave->hot.refused = NULL;
    cm1e_hot_lose(slave);
    cm1e_hot_note(bus, slave);
}

void cm1e_supervision_forget(cm1e_bus_t *bus)
{
    if (bus->supervised.sent)
        cm1e_soem_drop(bus->soem, &bus->supervised.datagram);
    bus->supervised.sent = false;
}

static bool takes_no_part(const cm1e_bus_slave_t *slave)
{
    const cm1e_slave_watch_t *watch = &slave->watch;
    return !watch->absent && (watch->lost || (watch->al_state != CM1E_AL_OP && watch->al_state != CM1E_AL_NONE));
}

void cm1e_supervision_receive(cm1e_bus_t *bus, int64_t now_ns)
{
    cm1e_datagram_t *d = &bus->supervised.datagram;
    if (!bus->supervised.sent)
        return;
    cm1e_bus_slave_t *slave = &bus->slaves[bus->supervised.place];
    if (!cm1e_soem_take(bus->soem, d, 0)) {
        if (now_ns - d->sent_ns < CM1E_FRAME_LOST_NS)
            return;
        cm1e_soem_drop(bus->soem, d);
    }
    bus->supervised.sent = false;
    if (bus->search.sent) {
        cm1e_search_result(bus, d, now_ns);
        return;
    }
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
        slave->looks++;
        cm1e_supervision_note(slave, cm1e_get_u16(d->data), cm1e_get_u16(d->data + 4));
    } else if (d->working_counter == 0 && ++slave->unanswered >= UNANSWERED_LIMIT) {
        cm1e_supervision_lose(bus, slave);
    }
    if (takes_no_part(slave))
        bus->supervised.missing = slave->info.position;
    recover_unasked(bus, slave);
    cm1e_hot_note(bus, slave);
}

uint16_t cm1e_bus_missing_slave(const cm1e_bus_t *bus)
{
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, bus->supervised.missing);
    return slave && takes_no_part(slave) ? slave->info.position : 0;
}

cm1e_slave_watch_t cm1e_bus_slave_watch(const cm1e_bus_t *bus, uint16_t position)
{
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    if (!slave)
        return (cm1e_slave_watch_t){.lost = true};
    cm1e_slave_watch_t watch = slave->watch;
    watch.silent = slave->silent_cycles >= bus->config.lost_cycles_limit;
    watch.fresh = slave->hot.counted &&
                  (bus->last_error == CM1E_OK || (bus->silence.partly_fresh && slave->silent_cycles == 0));
    watch.out = !slave->hot.counted;
    watch.bound = slave->hot.bound;
    const bool seems_there = watch.al_state == CM1E_AL_NONE || watch.al_state == CM1E_AL_OP;
    const uint64_t out_cycles = bus->counters.cycles - slave->hot.out_since;
    if (!slave->hot.counted && seems_there && out_cycles >= bus->config.lost_cycles_limit)
        watch.lost = true; /* its inputs showed the loss long before the supervision has asked three times */
    return watch;
}

uint32_t cm1e_bus_slave_looks(const cm1e_bus_t *bus, uint16_t position)
{
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    return slave ? slave->looks : 0;
}

bool cm1e_bus_slave_goes_on(const cm1e_bus_t *bus, uint16_t position, const cm1e_slave_watch_t *seen)
{
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    return slave && bus->last_error == CM1E_OK && slave->hot.counted && slave->hot.bound == seen->bound &&
           slave->silent_cycles < bus->config.lost_cycles_limit && slave->watch.al_state == seen->al_state &&
           slave->watch.al_status_code == seen->al_status_code && !slave->watch.lost && !seen->lost && !seen->silent &&
           !seen->out && seen->fresh && slave->watch.absent == seen->absent;
}

void cm1e_bus_request_recovery(cm1e_bus_t *bus, uint16_t position)
{
    cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    if (slave && bus->phase == BUS_OPERATING && cm1e_recovery_idle(&slave->recovery) &&
        cm1e_hot_may_recover(slave, true))
        cm1e_recovery_begin(bus, slave);
}
