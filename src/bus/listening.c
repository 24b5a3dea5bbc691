#include "bus/bus_internal.h"

/* Slaves send emergencies on their own. So in operation the bus looks into one mailbox after the other, while nothing
 * else uses that mailbox. A look is one read of a sync manager, which rides in the frame of the process data. Only if a
 * message is there, the CoE client of the slave fetches it, in frames of its own. */

/** The mailbox of this slave is nobody's now. */
static bool may_look(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave)
{
    return slave->facts.coe && !slave->watch.lost && slave->owner == OWNER_NONE && cm1e_coe_idle(&slave->coe) &&
           cm1e_recovery_idle(&slave->recovery) && cm1e_mapping_idle(&slave->mapping) &&
           !cm1e_foe_job_holds(bus, slave);
}

/** The next slave whose mailbox may be looked into; after a lost look the same one again. NULL: there is none. */
static cm1e_bus_slave_t *choose(cm1e_bus_t *bus)
{
    cm1e_listening_t *listening = &bus->listening;
    for (uint32_t n = 0; n < bus->slave_count; n++) {
        if (!listening->again)
            listening->place = listening->place + 1 < bus->slave_count ? listening->place + 1 : 0;
        listening->again = false;
        if (may_look(bus, &bus->slaves[listening->place]))
            return &bus->slaves[listening->place];
    }
    return NULL;
}

void cm1e_listen_ask(cm1e_bus_t *bus, int64_t now_ns)
{
    cm1e_listening_t *listening = &bus->listening;
    listening->asks = false;
    if (now_ns < listening->due_ns || bus->phase != BUS_OPERATING || listening->paused || listening->sent)
        return;
    listening->due_ns = now_ns + CM1E_LISTEN_PACE_NS;
    const cm1e_bus_slave_t *slave = choose(bus);
    listening->asks = slave && cm1e_coe_look(&slave->coe, &listening->datagram);
    if (listening->asks && bus->last_error != CM1E_ERROR_BUS_LOST)
        cm1e_soem_offer(bus->soem, &listening->datagram);
}

void cm1e_listen_send(cm1e_bus_t *bus, int64_t now_ns)
{
    cm1e_listening_t *listening = &bus->listening;
    if (!listening->asks)
        return;
    listening->sent = cm1e_soem_rides(bus->soem, &listening->datagram, now_ns);
    if (!listening->sent) {
        cm1e_coe_listen(&bus->slaves[listening->place].coe, now_ns);
        cm1e_acyclic_wake(bus);
    }
}

void cm1e_listen_receive(cm1e_bus_t *bus, int64_t now_ns)
{
    cm1e_listening_t *listening = &bus->listening;
    cm1e_bus_slave_t *slave = &bus->slaves[listening->place];
    if (!listening->sent)
        return;
    if (!cm1e_soem_take(bus->soem, &listening->datagram, 0))
        cm1e_soem_drop(bus->soem, &listening->datagram);
    listening->sent = false;
    if (listening->datagram.working_counter == DATAGRAM_LOST && bus->last_error == CM1E_ERROR_BUS_LOST) {
        listening->again = true; /* once, because it has a frame of its own now: no other slave waits for long */
        listening->due_ns = now_ns;
    } else if (cm1e_coe_has_mail(&listening->datagram) && may_look(bus, slave)) {
        cm1e_coe_fetch(&slave->coe, &listening->datagram, now_ns);
        cm1e_acyclic_wake(bus);
    }
}

void cm1e_listen_forget(cm1e_bus_t *bus)
{
    if (bus->listening.sent)
        cm1e_soem_drop(bus->soem, &bus->listening.datagram);
    bus->listening.sent = bus->listening.again = false;
}
