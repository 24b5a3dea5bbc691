#include "nic/rider.h"

#include <string.h>

#include "core/bytes.h"
#include "nic/frame.h"
#include "nic/nic.h"

enum { COMMAND_LRD = 10, COMMAND_LWR = 11, COMMAND_LRW = 12, FRAME_CHECK_BYTES = 4 };

static bool carries_process_data(const uint8_t *frame)
{
    const uint8_t command = frame[FRAME_HEADER];
    return command == COMMAND_LRW || command == COMMAND_LRD || command == COMMAND_LWR;
}

/** The last datagram of a frame that SOEM made; NULL: the frame is not what its length says. */
static uint8_t *find_last(uint8_t *frame, size_t length)
{
    size_t at = FRAME_HEADER;
    while (at + DATAGRAM_OVERHEAD <= length) {
        const uint16_t field = cm1e_get_u16(frame + at + 6);
        const size_t end = at + DATAGRAM_OVERHEAD + (field & DATAGRAM_LENGTH_MASK);
        if (!(field & DATAGRAM_MORE))
            return end == length ? frame + at : NULL;
        at = end;
    }
    return NULL;
}

/** Appends a rider behind `last`, which becomes its datagram. */
static void append(ecx_portt *port, uint8 idx, cm1e_port_rider_t *rider, uint8_t **last)
{
    uint8_t *frame = port->txbuf[idx];
    rider->at = (uint16_t)port->txbuflength[idx];
    cm1e_put_u16(*last + 6, cm1e_get_u16(*last + 6) | DATAGRAM_MORE);
    cm1e_put_u16(frame + ETHERNET_HEADER, (uint16_t)(cm1e_get_u16(frame + ETHERNET_HEADER) + rider->bytes));
    rider->datagram[1] = idx;
    *last = frame + rider->at;
    memcpy(*last, rider->datagram, rider->bytes);
    port->txbuflength[idx] += rider->bytes;
    port->slots[idx].rider_bytes = (uint16_t)(port->slots[idx].rider_bytes + rider->bytes);
    rider->index = idx;
    rider->state = RIDER_ABOARD;
}

void cm1e_rider_board(ecx_portt *port, uint8 idx)
{
    uint8_t *last = find_last(port->txbuf[idx], (size_t)port->txbuflength[idx]);
    if (!carries_process_data(port->txbuf[idx]) || !last)
        return;
    for (int i = 0; i < CM1E_RIDERS; i++) {
        cm1e_port_rider_t *rider = &port->riders[i];
        if (rider->state == RIDER_WAITS && port->txbuflength[idx] + rider->bytes <= CM1E_FRAME_MAX - FRAME_CHECK_BYTES)
            append(port, idx, rider, &last);
    }
}

static bool is_aboard(const cm1e_port_rider_t *rider, uint8 idx)
{
    return rider->state == RIDER_ABOARD && rider->index == idx;
}

void cm1e_rider_return(ecx_portt *port, uint8 idx)
{
    for (int i = 0; i < CM1E_RIDERS && port->slots[idx].rider_bytes > 0; i++) {
        cm1e_port_rider_t *rider = &port->riders[i];
        if (!is_aboard(rider, idx))
            continue;
        memcpy(rider->datagram, port->rxbuf[idx] + rider->at - ETHERNET_HEADER, rider->bytes);
        rider->state = RIDER_BACK;
    }
}

void cm1e_rider_lose(ecx_portt *port, uint8 idx)
{
    for (int i = 0; i < CM1E_RIDERS && port->slots[idx].rider_bytes > 0; i++)
        if (is_aboard(&port->riders[i], idx))
            port->riders[i].state = RIDER_LOST;
}
