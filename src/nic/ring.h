/**
 * @file ring.h
 * Cable redundancy: a line of slaves with a network interface at either end. What left on the second interface beside a
 * frame, which frames came back where, and what follows from it. Inside port.c's thread. @rt cycle
 *
 * A frame leaves the first interface marked PRI in its source MAC, a companion leaves the second one marked SEC:
 *
 *  | the ring is            | PRI comes back at    | SEC comes back at    | the whole answer is                     |
 *  |------------------------|----------------------|----------------------|-----------------------------------------|
 *  | intact                 | second, all slaves   | first, no slave      | PRI                                     |
 *  | dead at the second     | first, all slaves    | nowhere              | PRI                                     |
 *  | dead at the first      | nowhere              | second, all slaves   | SEC, if it was a copy; else send again  |
 *  | cut between two slaves | first, slaves 1 ... k| second, k + 1 ... n  | both merged, if SEC was a copy;         |
 *  |                        |                      |                      | else PRI's answer sent on at the second |
 *
 * On the way back, from a slave's port 1 to its port 0, frames are not processed: hence "no slave". In an intact ring
 * the companion is SOEM's dummy, a broadcast read, which shows where the ring is broken once it is. In a broken one it
 * is a copy of the frame, so that one trip is enough, for all frames that slaves may process in any order; for the
 * others (by position; ARMW, FRMW, BRW) the dummy stays and a second trip is made, but never with a frame by position
 * that might reach other slaves than those that are meant.
 *
 * A frame that came back where it left proves a break. Its other half is awaited for RING_HALF_WAIT_NS after sending
 * (or as long as the caller's timeout allows), and not at all once it is known to be dead. What is known changes by
 * frames alone: both interfaces send in every cycle, so a mended cable shows itself within one frame.
 */
#ifndef CM1E_NIC_RING_H
#define CM1E_NIC_RING_H

#include <stdbool.h>

#include "nicdrv.h"

/** Longest time that the second half of a broken ring may need after sending: 1,518 bytes on the wire (122 us), 128
 *  slaves (154 us), and two network interfaces that do not deliver at the same time. */
enum { RING_HALF_WAIT_NS = 500000 };

typedef enum ring_state { RING_INTACT = 0, RING_CUT, RING_FIRST_ONLY, RING_SECOND_ONLY } ring_state_t;

/** What left on the second interface last. */
typedef enum cm1e_ring_companion {
    RING_NOTHING = 0,
    RING_DUMMY,
    RING_COPY,
    RING_SENT_ON,   /**< the first half's answer */
    RING_COMPANIONS,
} ring_companion_t;

/** Bits: which frame came back where. */
enum {
    RING_FIRST_HALF = 1,   /**< PRI at the first interface */
    RING_SECOND_HALF = 2,  /**< SEC at the second */
    RING_HALVES = 3,
    RING_THROUGH = 4,      /**< SEC at the first: the ring is intact */
    RING_WHOLE = 8,        /**< PRI at the second: all slaves processed it */
};

/** What to send on the second interface beside the frame in txbuf[idx]. */
ring_companion_t cm1e_ring_companion(const ecx_portt *port, uint8 idx);
/** A frame of ours, sent as number `transmission`, came back; also one that nobody waits for. */
void cm1e_ring_observe(ecx_portt *port, uint32_t transmission, int arrival, int source);
/** The dummy of the second interface was answered by so many slaves. */
void cm1e_ring_dummy_answered(ecx_portt *port, int slaves);
/** The owner of a frame gives up waiting or sends anew: what the half that did come back says about the ring. */
void cm1e_ring_give_up(ecx_portt *port, uint8 idx);
/** As ecx_waitinframe() with a deadline; NIC_NOW: only what is here. */
int cm1e_ring_wait(ecx_portt *port, uint8 idx, int64_t deadline_ns);

#endif
