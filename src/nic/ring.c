#include "nic/ring.h"

#include <string.h>

#include "core/bytes.h"
#include "nic/frame.h"
#include "nic/nic_private.h"
#include "nic/port_private.h"

enum { COMMAND_BRD = 7, DATAGRAM_ADDRESS = FRAME_HEADER + 2, MISSES_IN_A_CUT_RING = 3 };

typedef enum action { WAIT = 0, TAKE_FIRST, TAKE_SECOND, MERGE, SEND_ON, SEND_AGAIN } action_t;

/** What follows from the companion that was sent and the halves that came back: at once, at once if the ring is known
 *  to be cut, and when the other half will not come any more. A whole answer (RING_WHOLE) is taken without asking. */
static const struct {
    uint8_t at_once, in_a_cut, at_the_end;
} decisions[RING_COMPANIONS][RING_HALVES + 1] = {
    [RING_NOTHING] = {
        [RING_FIRST_HALF]  = {TAKE_FIRST, TAKE_FIRST, TAKE_FIRST},
    },
    [RING_DUMMY] = {
        [RING_FIRST_HALF]  = {WAIT, SEND_ON, TAKE_FIRST},
        [RING_SECOND_HALF] = {WAIT, WAIT, SEND_AGAIN},
        [RING_HALVES]      = {SEND_ON, SEND_ON, SEND_ON},
    },
    [RING_COPY] = {
        [RING_FIRST_HALF]  = {WAIT, WAIT, TAKE_FIRST},
        [RING_SECOND_HALF] = {WAIT, WAIT, TAKE_SECOND},
        [RING_HALVES]      = {MERGE, MERGE, MERGE},
    },
    [RING_SENT_ON] = { /* the first half's answer is still in rxbuf: incomplete, and its working counter says so */
        [RING_FIRST_HALF]  = {WAIT, WAIT, TAKE_FIRST},
        [RING_SECOND_HALF] = {TAKE_SECOND, TAKE_SECOND, TAKE_SECOND},
        [RING_HALVES]      = {TAKE_SECOND, TAKE_SECOND, TAKE_SECOND},
    },
};

/* ---- what is known about the ring -------------------------------------------------------------------------------- */

static void learn(ecx_portt *port, ring_state_t state, uint32_t transmission)
{
    port->ring.state = (uint8_t)state;
    port->ring.misses = 0;
    port->ring.learned_from = transmission;
}

static bool half_is_dead(const ecx_portt *port, unsigned halves)
{
    return (halves == RING_FIRST_HALF && port->ring.state == RING_FIRST_ONLY) ||
           (halves == RING_SECOND_HALF && port->ring.state == RING_SECOND_ONLY);
}

/** Only one half came back. In a ring that was intact this half itself proves the break, so once is enough to know
 *  which end is dead; in one that is known to be cut, it may just be a lost frame. */
static void learn_miss(ecx_portt *port, uint32_t transmission, unsigned halves)
{
    if (half_is_dead(port, halves) || (halves != RING_FIRST_HALF && halves != RING_SECOND_HALF))
        return;
    if (port->ring.state == RING_CUT && ++port->ring.misses < MISSES_IN_A_CUT_RING)
        return;
    learn(port, halves == RING_FIRST_HALF ? RING_FIRST_ONLY : RING_SECOND_ONLY, transmission);
}

void cm1e_ring_observe(ecx_portt *port, uint32_t transmission, int arrival, int source)
{
    /* Frames that were sent before the ring changed may be read after it. */
    if ((int32_t)(transmission - port->ring.learned_from) < 0)
        return;
    if (arrival != source)
        learn(port, RING_INTACT, transmission);
    else if (port->ring.state == (arrival == 0 ? RING_SECOND_ONLY : RING_FIRST_ONLY))
        learn(port, RING_CUT, transmission);
    else
        port->ring.learned_from = transmission; /* it stays so, for more than 2^31 frames, too */
}

void cm1e_ring_dummy_answered(ecx_portt *port, int slaves) { port->ring.slaves_behind = slaves; }

void cm1e_ring_give_up(ecx_portt *port, uint8 idx)
{
    const cm1e_port_slot_t *slot = &port->slots[idx];
    if (slot->state == EC_BUF_TX && !(slot->answers & (RING_WHOLE | RING_THROUGH)))
        learn_miss(port, slot->transmission, slot->answers & RING_HALVES);
}

ring_companion_t cm1e_ring_companion(const ecx_portt *port, uint8 idx)
{
    static const uint8_t orders_for_copy[] = {
        [RING_CUT] = 1 << FRAME_ANY_ORDER,
        [RING_SECOND_ONLY] = 1 << FRAME_ANY_ORDER | 1 << FRAME_IN_ORDER,
    };
    if (port->ring.state != RING_CUT && port->ring.state != RING_SECOND_ONLY)
        return RING_DUMMY;
    const frame_order_t order = cm1e_frame_order(port->txbuf[idx], (size_t)port->txbuflength[idx]);
    return orders_for_copy[port->ring.state] & 1 << order ? RING_COPY : RING_DUMMY;
}

/* ---- one frame --------------------------------------------------------------------------------------------------- */

/** Slaves that an answer passed: every one adds 1 to the address of a broadcast and of a frame by position. */
static int slaves_passed(const ecx_portt *port, uint8 idx, const uint8_t *answer)
{
    const uint8_t *sent = port->txbuf[idx] + DATAGRAM_ADDRESS;
    return (uint16_t)(cm1e_get_u16(answer + DATAGRAM_ADDRESS - ETHERNET_HEADER) - cm1e_get_u16(sent));
}

static int slaves_in_first_half(const ecx_portt *port, uint8 idx) { return slaves_passed(port, idx, port->rxbuf[idx]); }

/** With slaves out of reach between the halves, or in a first half that is merely not heard, a frame by position would
 *  reach slaves that are not meant, and an ordered one slaves too early. So all slaves must be known to be in reach. */
static bool all_in_reach(const ecx_portt *port, uint8 idx, action_t action)
{
    const frame_order_t order = cm1e_frame_order(port->txbuf[idx], (size_t)port->txbuflength[idx]);
    if (order == FRAME_ANY_ORDER || (order == FRAME_IN_ORDER && action == SEND_ON))
        return true;
    if (!(port->slots[idx].answers & RING_SECOND_HALF))
        return false; /* only this frame's own dummy tells how many are behind the break now */
    const int before = action == SEND_ON ? slaves_in_first_half(port, idx) : 0;
    return before + port->ring.slaves_behind >= port->ring.slaves;
}

static action_t decide(const ecx_portt *port, uint8 idx, bool ended)
{
    const cm1e_port_slot_t *slot = &port->slots[idx];
    if (slot->state != EC_BUF_TX)
        return WAIT;
    if (slot->answers & RING_WHOLE)
        return TAKE_FIRST;
    const unsigned halves = slot->answers & RING_HALVES;
    action_t action = (action_t)decisions[slot->companion][halves].at_once;
    if (action == WAIT && port->ring.state == RING_CUT)
        action = (action_t)decisions[slot->companion][halves].in_a_cut;
    if (action == WAIT && ended)
        action = (action_t)decisions[slot->companion][halves].at_the_end;
    if (action == SEND_AGAIN && !all_in_reach(port, idx, action))
        action = WAIT;
    if (action == SEND_ON && !all_in_reach(port, idx, action))
        action = ended || halves == RING_HALVES ? TAKE_FIRST : WAIT;
    /* Both halves processed it although only the second one was thought alive. */
    if (action == MERGE && cm1e_frame_order(port->txbuf[idx], (size_t)port->txbuflength[idx]) != FRAME_ANY_ORDER)
        action = TAKE_SECOND;
    return action;
}

/** Sends once more, on the second interface: what the first half made of the frame, or the frame itself. */
static void send_second(ecx_portt *port, uint8 idx, action_t action)
{
    cm1e_port_slot_t *slot = &port->slots[idx];
    const size_t length = (size_t)port->txbuflength[idx];
    memcpy(port->scratch, port->txbuf[idx], length);
    if (action == SEND_ON)
        memcpy(port->scratch + ETHERNET_HEADER, port->rxbuf[idx], length - ETHERNET_HEADER);
    slot->companion = action == SEND_ON ? RING_SENT_ON : RING_COPY;
    slot->answers &= (uint8_t)~(RING_SECOND_HALF | RING_THROUGH);
    cm1e_port_stamp(port, port->scratch, idx, 1, ++port->transmissions);
    cm1e_port_send(port, 1, port->scratch, (int)length);
    slot->sent_ns = cm1e_clock_now(port->nic->link.clock);
    port->counters.resent++;
}

/** A broadcast whose halves are those that the ring is known to have tells where it is broken. A half that got lost
 *  tells nothing. */
static void learn_reach(ecx_portt *port, uint8 idx)
{
    static const uint8_t halves_of[] = {
        [RING_CUT] = RING_HALVES, [RING_FIRST_ONLY] = RING_FIRST_HALF, [RING_SECOND_ONLY] = RING_SECOND_HALF,
    };
    const cm1e_port_slot_t *slot = &port->slots[idx];
    const unsigned halves = slot->answers & RING_HALVES;
    const bool second_is_dead = port->ring.state == RING_FIRST_ONLY;
    port->ring.reach_known = port->ring.state != RING_INTACT && halves == halves_of[port->ring.state] &&
                             (second_is_dead || slot->companion == RING_COPY);
    port->ring.reach[0] = halves & RING_FIRST_HALF ? slaves_in_first_half(port, idx) : 0;
    port->ring.reach[1] = halves & RING_SECOND_HALF ? slaves_passed(port, idx, port->redport->rxbuf[idx]) : 0;
}

static int take(ecx_portt *port, uint8 idx, action_t action, bool complete)
{
    if (port->txbuf[idx][FRAME_HEADER] == COMMAND_BRD)
        learn_reach(port, idx);
    const size_t body = (size_t)port->txbuflength[idx] - ETHERNET_HEADER;
    if (action == TAKE_SECOND)
        memcpy(port->rxbuf[idx], port->redport->rxbuf[idx], body);
    else if (action == MERGE)
        cm1e_frame_merge(port->rxbuf[idx], port->redport->rxbuf[idx], port->txbuf[idx] + ETHERNET_HEADER, body);
    const bool whole = (port->slots[idx].answers & RING_WHOLE) != 0;
    const int wkc = cm1e_port_complete(port, idx);
    if (complete && port->txbuf[idx][FRAME_HEADER] == COMMAND_BRD && (whole || wkc > port->ring.slaves))
        port->ring.slaves = wkc;
    return wkc;
}

/** Until when the other half is awaited. If the frame must be sent again without it, that needs time too: half of what
 *  is left. */
static int64_t half_deadline(const ecx_portt *port, uint8 idx, int64_t deadline_ns)
{
    const cm1e_port_slot_t *slot = &port->slots[idx];
    const unsigned halves = slot->answers & RING_HALVES;
    if (halves == 0 || slot->state != EC_BUF_TX)
        return INT64_MAX;
    if (half_is_dead(port, halves))
        return NIC_NOW;
    const int64_t half_ns = slot->sent_ns + RING_HALF_WAIT_NS;
    if (decisions[slot->companion][halves].at_the_end != SEND_AGAIN || deadline_ns == NIC_NOW)
        return half_ns;
    const int64_t now_ns = cm1e_clock_now(port->nic->link.clock), middle_ns = now_ns + (deadline_ns - now_ns) / 2;
    return middle_ns < half_ns ? middle_ns : half_ns;
}

int cm1e_ring_wait(ecx_portt *port, uint8 idx, int64_t deadline_ns)
{
    cm1e_port_slot_t *slot = &port->slots[idx];
    bool ended = false; /* the other half will not come any more */
    int64_t half_ns = INT64_MAX;
    for (int frames = 0;;) {
        const action_t action = decide(port, idx, ended);
        if ((slot->answers & RING_HALVES) == RING_HALVES && slot->state == EC_BUF_TX)
            learn(port, RING_CUT, slot->transmission);
        if (action == SEND_ON || action == SEND_AGAIN) {
            send_second(port, idx, action);
            ended = false;
            half_ns = INT64_MAX;
            continue;
        }
        if (action != WAIT)
            return take(port, idx, action, !ended);
        if (ended)
            half_ns = INT64_MAX;
        else if (half_ns == INT64_MAX)
            half_ns = half_deadline(port, idx, deadline_ns);
        if (cm1e_port_take_in(port, half_ns < deadline_ns ? half_ns : deadline_ns)) {
            if (++frames >= PORT_FRAME_BUDGET && cm1e_clock_now(port->nic->link.clock) >= deadline_ns)
                return EC_NOFRAME;
            continue;
        }
        /* A look without waiting leaves the half its time; a wait that ends takes what there is. */
        if (half_ns == INT64_MAX || (deadline_ns == NIC_NOW && cm1e_clock_now(port->nic->link.clock) < half_ns))
            return EC_NOFRAME;
        ended = true;
        learn_miss(port, slot->transmission, slot->answers & RING_HALVES);
    }
}
