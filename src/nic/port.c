/* SOEM's port functions (nicdrv.h). Beyond SOEM's own: an answer is taken only for what was sent, nothing is copied
 * beyond what was sent, waits end at their deadline, and a released index gets nothing any more.
 *
 * Slave controllers change one bit of an Ethernet header (0x02 of the first byte of the source MAC). Its last byte
 * carries the low byte of the number of the transmission, so an answer to an earlier use of the same index is told from
 * the one that is awaited. */
#include <stdlib.h>
#include <string.h>

#include "core/bytes.h"
#include "core/clock.h"
#include "nic/frame.h"
#include "nic/nic_private.h"
#include "nic/port_private.h"
#include "nic/rider.h"
#include "nic/ring.h"
#include "oshw.h"

/** Source MAC addresses by which SOEM tells the two interfaces apart: the middle word counts. */
const uint16 priMAC[3] = {0x0101, 0x0101, 0x0101};
const uint16 secMAC[3] = {0x0404, 0x0404, 0x0404};

enum {
    LOCALLY_ADMINISTERED = 0x02,
    MAC_IDENTITY_HIGH = 7, MAC_ROUTE = 8, MAC_IDENTITY_LOW = 10, MAC_STAMP = 11,
    NO_ROUTE = -1,      /* not one of our source addresses */
    FOREIGN_ROUTE = -2, /* another SOEM's, or of another program with this library */
};

/* ---- opening and closing ----------------------------------------------------------------------------------------- */

void ec_setupheader(void *p)
{
    uint8_t *frame = p;
    memset(frame, 0xFF, 6);
    memset(frame + 6, 0x01, 6);
    frame[12] = 0x88;
    frame[13] = 0xA4;
}

static bool open_nic(ecx_portt *port, const char *first, const char *second)
{
    cm1e_bus_config_t config = {0};
    memcpy(config.interface_name, first, strnlen(first, sizeof config.interface_name - 1));
    memcpy(config.second_interface, second, strnlen(second, sizeof config.second_interface - 1));
    cm1e_nic_open(&port->nic, &config, NULL);
    port->nic_is_ours = port->nic != NULL;
    return port->nic_is_ours;
}

static bool set_up_second(ecx_portt *port, const char *ifname)
{
    if (!port->redport || !port->nic)
        return false;
    if (port->nic_is_ours) {
        char first[sizeof port->nic->link.interface_name];
        memcpy(first, port->nic->link.interface_name, sizeof first);
        cm1e_nic_close(port->nic);
        port->nic = NULL;
        if (!open_nic(port, first, ifname))
            return false;
    }
    port->redundant = port->nic->link.ports > 1;
    return port->redundant;
}

int ecx_setupnic(ecx_portt *port, const char *ifname, int secondary)
{
    if (secondary)
        return set_up_second(port, ifname);
    if (!port->nic && !open_nic(port, ifname, ""))
        return 0;
    memset(&port->counters, 0, sizeof port->counters);
    memset(port->slots, 0, sizeof port->slots);
    memset(&port->ring, 0, sizeof port->ring);
    memset(port->riders, 0, sizeof port->riders);
    port->redundant = false;
    port->last_index = 0;
    for (int i = 0; i < EC_MAXBUF; i++)
        ec_setupheader(port->txbuf[i]);
    ec_setupheader(port->txbuf2);
    return 1;
}

int ecx_closenic(ecx_portt *port)
{
    if (port->nic_is_ours)
        cm1e_nic_close(port->nic);
    port->nic = NULL;
    port->nic_is_ours = false;
    port->redundant = false;
    return 0;
}

/* ---- indices ----------------------------------------------------------------------------------------------------- */

/** With all in use, the index that is missed least: an answer handed over already, one that waits to be collected, a
 *  frame on its way, one not yet sent; of these the oldest. */
static uint8 least_missed(const ecx_portt *port)
{
    static const uint8_t missed[] = {[EC_BUF_EMPTY] = 0, [EC_BUF_COMPLETE] = 1, [EC_BUF_RCVD] = 2, [EC_BUF_TX] = 3,
                                     [EC_BUF_ALLOC] = 4};
    uint8 best = 0;
    for (uint8 i = 1; i < EC_MAXBUF; i++) {
        const cm1e_port_slot_t *a = &port->slots[i], *b = &port->slots[best];
        const int more = missed[a->state] - missed[b->state];
        if (more < 0 || (more == 0 && (int32_t)(a->allocation - b->allocation) < 0))
            best = i;
    }
    return best;
}

/** Next free index in turn. With all 16 in use one is taken away from its owner (least_missed()) and counted in
 *  counters.index_reused: the contract knows no failure, and a caller that leaks indices must not stop the bus. */
uint8 ecx_getindex(ecx_portt *port)
{
    uint8 idx = port->last_index;
    int tried = 0;
    do
        idx = (uint8)((idx + 1) % EC_MAXBUF);
    while (port->slots[idx].state != EC_BUF_EMPTY && ++tried < EC_MAXBUF);
    if (port->slots[idx].state != EC_BUF_EMPTY) {
        idx = least_missed(port);
        port->counters.index_reused++;
    }
    port->last_index = idx;
    cm1e_rider_lose(port, idx);
    port->slots[idx] = (cm1e_port_slot_t){.state = EC_BUF_ALLOC, .allocation = ++port->allocations};
    return idx;
}

void ecx_setbufstat(ecx_portt *port, uint8 idx, int bufstat)
{
    if (idx >= EC_MAXBUF || bufstat < EC_BUF_EMPTY || bufstat > EC_BUF_COMPLETE)
        return;
    if (port->redundant)
        cm1e_ring_give_up(port, idx);
    cm1e_rider_lose(port, idx);
    port->slots[idx].state = (uint8_t)bufstat;
    port->slots[idx].answers = 0;
}

/* ---- sending ----------------------------------------------------------------------------------------------------- */

void cm1e_port_stamp(ecx_portt *port, uint8_t *frame, uint8 idx, int source, uint32_t transmission)
{
    const uint16 route = source ? secMAC[1] : priMAC[1];
    frame[MAC_IDENTITY_HIGH] = (uint8_t)(port->nic->link.identity >> 8);
    frame[MAC_IDENTITY_LOW] = (uint8_t)port->nic->link.identity;
    frame[MAC_ROUTE] = (uint8_t)(route >> 8);
    frame[MAC_ROUTE + 1] = (uint8_t)route;
    frame[MAC_STAMP] = (uint8_t)transmission;
    port->slots[idx].stamp[source] = (uint8_t)transmission;
    port->slots[idx].transmission = transmission;
}

bool cm1e_port_send(ecx_portt *port, int interface, const uint8_t *frame, int length)
{
    const bool sent = cm1e_nic_send(port->nic, interface, frame, (size_t)length);
    if (sent)
        port->counters.sent++;
    else
        port->counters.send_failed++;
    return sent;
}

static bool can_send(const ecx_portt *port, uint8 idx)
{
    return port->nic && idx < EC_MAXBUF && port->txbuflength[idx] >= FRAME_MINIMUM &&
           port->txbuflength[idx] <= EC_BUFSIZE;
}

static void send_companion(ecx_portt *port, uint8 idx, uint32_t transmission)
{
    cm1e_port_slot_t *slot = &port->slots[idx];
    slot->companion = (uint8_t)cm1e_ring_companion(port, idx);
    if (slot->companion == RING_COPY) {
        cm1e_port_stamp(port, port->txbuf[idx], idx, 1, transmission);
        cm1e_port_send(port, 1, port->txbuf[idx], port->txbuflength[idx]);
    } else if (slot->companion == RING_DUMMY) {
        port->txbuf2[FRAME_HEADER + 1] = idx;
        cm1e_port_stamp(port, port->txbuf2, idx, 1, transmission);
        cm1e_port_send(port, 1, port->txbuf2, port->txbuflength2);
    }
}

/** Sends txbuf[idx]. `again`: a repetition to which an answer to the first try is as good. */
static int send_frame(ecx_portt *port, uint8 idx, bool again)
{
    if (!can_send(port, idx))
        return -1;
    cm1e_port_slot_t *slot = &port->slots[idx];
    if (port->redundant) {
        cm1e_ring_give_up(port, idx);
        again = false;
    }
    if (!again) {
        slot->answers = 0;
        cm1e_port_stamp(port, port->txbuf[idx], idx, 0, ++port->transmissions);
    }
    slot->state = EC_BUF_TX;
    const bool sent = cm1e_port_send(port, 0, port->txbuf[idx], port->txbuflength[idx]);
    if (port->redundant) {
        slot->sent_ns = cm1e_clock_now(port->nic->link.clock);
        send_companion(port, idx, port->transmissions);
    }
    return sent ? port->txbuflength[idx] : -1;
}

/** SOEM puts zeros into an LRD. Slaves overwrite what they give, so what the image has there shows who gave nothing. */
static void fill_logical_read(ecx_portt *port, uint8 idx)
{
    enum { COMMAND_LRD = 10, ADDRESS = 2, LENGTH = 6, LENGTH_MASK = 0x07FF };
    if (!port->logical || !can_send(port, idx))
        return;
    uint8_t *datagram = port->txbuf[idx] + FRAME_HEADER;
    if (datagram[0] == COMMAND_LRD)
        memcpy(datagram + DATAGRAM_HEADER, port->logical + cm1e_get_u32(datagram + ADDRESS),
               cm1e_get_u16(datagram + LENGTH) & LENGTH_MASK);
}

int ecx_outframe_red(ecx_portt *port, uint8 idx)
{
    fill_logical_read(port, idx);
    if (cm1e_rider_waits(port) && can_send(port, idx))
        cm1e_rider_board(port, idx);
    return send_frame(port, idx, false);
}

/* ---- receiving --------------------------------------------------------------------------------------------------- */

/** Which of our interfaces a frame was sent by, or NO_ROUTE, FOREIGN_ROUTE. */
static int route(const ecx_portt *port, const uint8_t *frame)
{
    const unsigned word = (unsigned)frame[MAC_ROUTE] << 8 | frame[MAC_ROUTE + 1];
    if ((frame[6] & ~LOCALLY_ADMINISTERED) != 0x01 || (word != priMAC[1] && word != secMAC[1]))
        return NO_ROUTE;
    if ((frame[MAC_IDENTITY_HIGH] << 8 | frame[MAC_IDENTITY_LOW]) != port->nic->link.identity)
        return FOREIGN_ROUTE;
    return word == priMAC[1] ? 0 : 1;
}

/** An answer to a frame that is not ours. Only another master makes whole EtherCAT frames. */
static bool is_foreign(const uint8_t *frame, size_t length, int source)
{
    return source == FOREIGN_ROUTE || (source == NO_ROUTE && cm1e_frame_is_ethercat(frame, length));
}

static void not_awaited(ecx_portt *port, const cm1e_port_slot_t *slot, int source, uint8_t stamp)
{
    if (source == 1)
        port->counters.unneeded++;
    else if ((slot->state == EC_BUF_RCVD || slot->state == EC_BUF_COMPLETE) && slot->stamp[0] == stamp)
        port->counters.duplicates++;
    else
        port->counters.late++;
}

/** Keeps what a frame brought; its structure has been checked against what was sent. */
static void store(ecx_portt *port, uint8 idx, int arrival, int source, const uint8_t *frame)
{
    cm1e_port_slot_t *slot = &port->slots[idx];
    const size_t body = (size_t)port->txbuflength[idx] - ETHERNET_HEADER;
    const uint8_t bit = source == 0 ? (arrival == 0 ? RING_FIRST_HALF : RING_WHOLE)
                                    : (arrival == 1 ? RING_SECOND_HALF : RING_THROUGH);
    if ((slot->answers & bit) || (slot->answers & RING_WHOLE)) {
        if (source == 0)
            port->counters.duplicates++;
        else
            port->counters.unneeded++;
        return;
    }
    if (source == 0)
        memcpy(port->rxbuf[idx], frame + ETHERNET_HEADER, body);
    else if (bit == RING_SECOND_HALF && slot->companion != RING_DUMMY)
        memcpy(port->redport->rxbuf[idx], frame + ETHERNET_HEADER, body);
    else if (bit == RING_SECOND_HALF)
        cm1e_ring_dummy_answered(port, frame[port->txbuflength2 - 2] | frame[port->txbuflength2 - 1] << 8);
    slot->answers |= bit;
    if (!port->redundant)
        slot->state = EC_BUF_RCVD;
}

static bool is_awaited(const ecx_portt *port, uint8 idx, const uint8_t *frame, size_t length)
{
    return idx < EC_MAXBUF && port->slots[idx].state == EC_BUF_TX &&
           cm1e_frame_is_reply(frame, length, port->txbuf[idx], (size_t)port->txbuflength[idx], idx);
}

static void accept_frame(ecx_portt *port, int arrival, const uint8_t *frame, size_t length)
{
    port->counters.received++;
    const uint8 idx = length >= FRAME_MINIMUM ? frame[FRAME_HEADER + 1] : EC_MAXBUF;
    int source = length >= FRAME_MINIMUM ? route(port, frame) : NO_ROUTE;
    const bool stamped = source >= 0;
    /* A software slave may put its own source address into our frames. Without a ring that does no harm. */
    if (source == NO_ROUTE && !port->redundant && is_awaited(port, idx, frame, length))
        source = 0;
    if (idx >= EC_MAXBUF || source < 0 || (source == 1 && !port->redundant)) {
        if (is_foreign(frame, length, source))
            port->counters.foreign++;
        else
            port->counters.malformed++;
        return;
    }
    cm1e_port_slot_t *slot = &port->slots[idx];
    const uint8_t stamp = stamped ? frame[MAC_STAMP] : slot->stamp[0];
    const uint32_t transmission = port->transmissions - (uint8_t)(port->transmissions - stamp);
    if (slot->state != EC_BUF_TX || slot->stamp[source] != stamp) {
        not_awaited(port, slot, source, stamp);
        if (port->redundant)
            cm1e_ring_observe(port, transmission, arrival, source);
        return;
    }
    const bool dummy = source == 1 && slot->companion == RING_DUMMY;
    const uint8_t *sent = dummy ? port->txbuf2 : port->txbuf[idx];
    const int sent_length = dummy ? port->txbuflength2 : port->txbuflength[idx];
    if (!cm1e_frame_is_reply(frame, length, sent, (size_t)sent_length, idx)) {
        port->counters.malformed++;
        return;
    }
    store(port, idx, arrival, source, frame);
    if (port->redundant)
        cm1e_ring_observe(port, transmission, arrival, source);
}

bool cm1e_port_take_in(ecx_portt *port, int64_t deadline_ns)
{
    int arrival = 0;
    const size_t length = cm1e_nic_receive(port->nic, &arrival, port->scratch, deadline_ns);
    if (length == 0)
        return false;
    accept_frame(port, arrival, port->scratch, length);
    return true;
}

int cm1e_port_complete(ecx_portt *port, uint8 idx)
{
    port->slots[idx].state = EC_BUF_COMPLETE;
    cm1e_rider_return(port, idx);
    const int length = port->txbuflength[idx] - port->slots[idx].rider_bytes; /* SOEM's part */
    const uint8_t *counter = port->rxbuf[idx] + length - ETHERNET_HEADER - 2;
    return counter[0] | counter[1] << 8;
}

static int wait_until(ecx_portt *port, uint8 idx, int64_t deadline_ns)
{
    if (!port->nic || idx >= EC_MAXBUF)
        return EC_NOFRAME;
    if (port->redundant)
        return cm1e_ring_wait(port, idx, deadline_ns);
    for (int frames = 0; port->slots[idx].state != EC_BUF_RCVD; frames++) {
        if (frames >= PORT_FRAME_BUDGET && cm1e_clock_now(port->nic->link.clock) >= deadline_ns)
            return EC_NOFRAME;
        if (!cm1e_port_take_in(port, deadline_ns))
            return EC_NOFRAME;
    }
    return cm1e_port_complete(port, idx);
}

static int64_t deadline_after(const ecx_portt *port, int timeout_us)
{
    if (!port->nic || timeout_us <= 0)
        return NIC_NOW;
    return cm1e_clock_now(port->nic->link.clock) + (int64_t)timeout_us * US_IN_NS;
}

/** Takes in what is here already; EC_OTHERFRAME: a frame came, but not this one. */
int ecx_inframe(ecx_portt *port, uint8 idx, int stacknumber)
{
    (void)stacknumber; /* answers are sorted by index, whichever interface they arrived at */
    const uint64_t before = port->counters.received;
    const int wkc = wait_until(port, idx, NIC_NOW);
    return wkc == EC_NOFRAME && port->counters.received != before ? EC_OTHERFRAME : wkc;
}

int ecx_waitinframe(ecx_portt *port, uint8 idx, int timeout)
{
    return wait_until(port, idx, deadline_after(port, timeout));
}

/** Puts the answer in the place of a slave that is absent, if SOEM asks for its AL status. */
static bool answer_for_absent(ecx_portt *port, uint8 idx)
{
    enum { COMMAND_FPRD = 4, ADDRESS = 2, OFFSET = 4, AL_STATUS = 0x0130, PRE_OPERATIONAL = 2 };
    if (!port->absent_from || !can_send(port, idx))
        return false;
    const uint8_t *datagram = port->txbuf[idx] + FRAME_HEADER;
    if (datagram[0] != COMMAND_FPRD || cm1e_get_u16(datagram + ADDRESS) < port->absent_from ||
        cm1e_get_u16(datagram + OFFSET) != AL_STATUS)
        return false;
    memcpy(port->rxbuf[idx], port->txbuf[idx] + ETHERNET_HEADER, (size_t)port->txbuflength[idx] - ETHERNET_HEADER);
    port->rxbuf[idx][FRAME_HEADER - ETHERNET_HEADER + DATAGRAM_HEADER] = PRE_OPERATIONAL;
    port->slots[idx].state = EC_BUF_COMPLETE;
    return true;
}

int ecx_srconfirm(ecx_portt *port, uint8 idx, int timeout)
{
    if (!port->nic)
        return EC_NOFRAME;
    if (answer_for_absent(port, idx))
        return 1;
    const int64_t end = deadline_after(port, timeout);
    int wkc;
    int64_t now = cm1e_clock_now(port->nic->link.clock);
    bool again = false;
    do {
        if (send_frame(port, idx, again) < 0 && !can_send(port, idx))
            return EC_NOFRAME;
        again = true;
        const int64_t part = now + (int64_t)EC_TIMEOUTRET * US_IN_NS;
        wkc = wait_until(port, idx, part < end ? part : end);
        now = cm1e_clock_now(port->nic->link.clock);
    } while (wkc <= EC_NOFRAME && now < end);
    return wkc;
}
