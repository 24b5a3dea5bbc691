/**
 * @file rider.h
 * Datagrams of the bus that ride in a frame of SOEM's process data, behind SOEM's own datagrams, where that frame has
 * room. SOEM does not see them: it gets the working counter of its own last datagram, as without them. A rider shares
 * the fate of the frame: with it, it comes back or is lost. In a ring both halves process it, so it must have a meaning
 * in any order of the slaves (FRAME_ANY_ORDER). Inside port.c's thread. @rt cycle
 */
#ifndef CM1E_NIC_RIDER_H
#define CM1E_NIC_RIDER_H

#include <stdbool.h>
#include <stdint.h>

#include "nicdrv.h"

typedef enum cm1e_rider_state {
    RIDER_NONE = 0,
    RIDER_WAITS,    /**< for the next frame of process data with room */
    RIDER_ABOARD,   /**< on its way */
    RIDER_BACK,     /**< `datagram` is the one that came back */
    RIDER_LOST,     /**< its frame did not come back, or its owner has given it up */
} rider_state_t;

static inline bool cm1e_rider_waits(const ecx_portt *port)
{
    return port->riders[0].state == RIDER_WAITS || port->riders[1].state == RIDER_WAITS;
}
/** Puts those who wait aboard the frame that is about to be sent, as far as it carries process data and has room. */
void cm1e_rider_board(ecx_portt *port, uint8 idx);
/** The answer in rxbuf[idx] is complete. */
void cm1e_rider_return(ecx_portt *port, uint8 idx);
/** Nobody waits for this frame any more. */
void cm1e_rider_lose(ecx_portt *port, uint8 idx);

#endif
