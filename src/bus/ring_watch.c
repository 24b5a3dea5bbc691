#include "bus/ring_watch.h"

#include <stdio.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "core/sized.h"

/** ns; while the ring is broken, its place is asked for again after this time, because a second cable may break, or the
 *  first be mended. A question whose halves did not both come back is repeated sooner. Between the questions the slaves
 *  are supervised as always. */
#define PLACE_PACE_NS INT64_C(20000000)
#define REPEAT_PACE_NS INT64_C(3000000)
enum { ANSWER_BYTES = 2 };

/** Takes what the frames have shown so far. Returns whether the ring is broken. */
static bool look(cm1e_bus_t *bus, int64_t now_ns)
{
    cm1e_ring_watch_t *watch = &bus->ring;
    const bool broken = cm1e_soem_ring_is_broken(bus->soem), begins = broken && !watch->ring.broken;
    if (begins)
        watch->due_ns = now_ns;
    if (begins || !broken)
        watch->ring = (cm1e_bus_ring_t){.used = bus->config.second_interface[0] != 0, .broken = broken,
                                        .breaks = watch->ring.breaks + begins};
    return broken;
}

bool cm1e_ring_watch_ask(cm1e_bus_t *bus, cm1e_datagram_t *datagram, int64_t now_ns)
{
    cm1e_ring_watch_t *watch = &bus->ring;
    const bool broken = look(bus, now_ns);
    if (!broken || now_ns < watch->due_ns)
        return false;
    watch->due_ns = now_ns + (watch->ring.placed ? PLACE_PACE_NS : REPEAT_PACE_NS);
    cm1e_datagram_set(datagram, COMMAND_BRD, 0, REG_AL_STATUS, ANSWER_BYTES);
    memset(datagram->data, 0, ANSWER_BYTES); /* slaves add their bits */
    return true;
}

void cm1e_ring_watch_take(cm1e_bus_t *bus)
{
    uint32_t reach[2];
    cm1e_bus_ring_t *ring = &bus->ring.ring;
    if (!ring->broken || !cm1e_soem_ring_reach(bus->soem, reach) || reach[0] + reach[1] > bus->slave_count)
        return;
    ring->placed = true;
    ring->behind = (uint16_t)reach[0];
    ring->before = (uint16_t)(bus->slave_count + 1 - reach[1]);
}

void cm1e_ring_watch_begin(cm1e_bus_t *bus)
{
    uint8_t answer[ANSWER_BYTES] = {0};
    if (look(bus, 0) && cm1e_soem_transfer(bus->soem, COMMAND_BRD, 0, REG_AL_STATUS, answer, ANSWER_BYTES) > 0)
        cm1e_ring_watch_take(bus);
}

/* ---- what others see -------------------------------------------------------------------------------------------- */

void cm1e_bus_ring_sized(const cm1e_bus_t *bus, cm1e_bus_ring_t *ring, size_t size)
{
    static const cm1e_bus_ring_t none;
    cm1e_copy_sized(ring, size, bus ? &bus->ring.ring : &none, sizeof none);
}

/** Names a slave, or the interface at an end of the ring. */
static void name_end(const cm1e_bus_t *bus, uint32_t position, char *text, size_t size)
{
    char label[CM1E_LABEL_LENGTH];
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    if (slave)
        snprintf(text, size, "%s", cm1e_bus_label(bus, slave, label));
    else
        snprintf(text, size, "this computer (\"%s\")",
                 position == 0 ? bus->config.interface_name : bus->config.second_interface);
}

void cm1e_bus_ring_text(const cm1e_bus_t *bus, const cm1e_bus_ring_t *ring, char *text, size_t size)
{
    char behind[CM1E_LABEL_LENGTH], before[CM1E_LABEL_LENGTH], missing[96] = "";
    if (!text)
        return;
    const bool used = ring && ring->used;
    if (!used || !ring->broken || !ring->placed) {
        snprintf(text, size, "%s", !used ? "There is no second interface, so no ring."
                 : !ring->broken ? "The ring is whole." : "The ring is broken; it is not known yet where.");
        return;
    }
    const uint32_t away = ring->before - ring->behind - 1u;
    name_end(bus, ring->behind, behind, sizeof behind);
    name_end(bus, ring->before, before, sizeof before);
    if (away == 1)
        snprintf(missing, sizeof missing, " Slave %u is reached from neither side.", ring->behind + 1u);
    else if (away > 1)
        snprintf(missing, sizeof missing, " Slaves %u to %u are reached from neither side.", ring->behind + 1u,
                 ring->before - 1u);
    snprintf(text, size, "The ring is broken between %s and %s.%s %s", behind, before, missing,
             away ? "Check the cables and the power there." :
             "All slaves are reached, from two sides: mend that cable before a second one breaks.");
}
