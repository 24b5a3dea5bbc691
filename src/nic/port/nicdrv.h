/**
 * @file nicdrv.h
 * SOEM's port header, replaced. SOEM's core is compiled against this file instead of its own oshw/linux/nicdrv.h: the
 * members that the core touches keep SOEM's names, the rest belongs to src/nic/port.c and src/nic/ring.c.
 *
 * A port is zeroed before ecx_setupnic(). If `nic` is set by then, that one is used and stays its owner's; otherwise
 * ecx_setupnic() opens the interface by its name (ecx_setupnic(.., TRUE) reopens it with the second one) and
 * ecx_closenic() closes it. One thread owns a port: there are no mutexes.
 */
#ifndef _nicdrvh_
#define _nicdrvh_

#include <stdbool.h>
#include <stdint.h>

#include "ethercattype.h"

#ifdef __cplusplus
extern "C" {
#endif

struct cm1e_nic;

/** What happened to frames; they only grow. */
typedef struct cm1e_port_counters {
    uint64_t sent, received;
    uint64_t send_failed;   /**< the operating system did not take the frame */
    uint64_t late;          /**< answers that nobody waits for any more */
    uint64_t duplicates;    /**< second and further answers to one frame */
    uint64_t malformed;     /**< not EtherCAT, cut short, or not the frame that was sent */
    uint64_t foreign;       /**< frames that another master sent on this network */
    uint64_t unneeded;      /**< ring: frames of the second interface whose answer was not needed */
    uint64_t resent;        /**< ring: frames that needed a second trip through the other interface */
    uint64_t index_reused;  /**< ecx_getindex() found all 16 in use and took one away: somebody does not release */
} cm1e_port_counters_t;

/** One frame index between ecx_getindex() and ecx_setbufstat(EC_BUF_EMPTY). */
typedef struct cm1e_port_slot {
    int64_t sent_ns;
    uint32_t allocation;    /**< counts ecx_getindex() calls: the oldest is the smallest */
    uint32_t transmission;  /**< number of the transmission that answers are awaited for */
    uint8_t state;          /**< EC_BUF_... */
    uint8_t stamp[2];       /**< last byte of the source MAC of the frame on its way from interface 0, 1 */
    uint8_t companion;      /**< ring.h: what left on the second interface with it */
    uint8_t answers;        /**< ring.h: which frames came back where */
    uint16_t rider_bytes;   /**< at the end of the frame: datagrams that are not SOEM's (rider.h) */
} cm1e_port_slot_t;

enum { CM1E_RIDERS = 2, CM1E_RIDER_ROOM = 64 };

/** A datagram that rides behind SOEM's own in one of its frames (rider.h). */
typedef struct cm1e_port_rider {
    uint8_t state;          /**< rider.h */
    uint8_t index;          /**< of the frame that carries it */
    uint16_t bytes;
    uint16_t at;            /**< in that frame */
    uint8_t datagram[CM1E_RIDER_ROOM]; /**< header, data and working counter: as sent, and then as it came back */
} cm1e_port_rider_t;

/** Second interface of a ring. */
typedef struct ecx_redport {
    ec_bufT rxbuf[EC_MAXBUF];   /**< frames that came back to the second interface, without Ethernet header */
} ecx_redportt;

typedef struct ecx_port {
    ec_bufT txbuf[EC_MAXBUF];   /**< Ethernet frames to send; not to be changed between sending and the answer */
    int txbuflength[EC_MAXBUF];
    ec_bufT rxbuf[EC_MAXBUF];   /**< answers without Ethernet header */
    ec_bufT txbuf2;             /**< the ring's dummy frame, prepared by ecx_init_redundant() */
    int txbuflength2;
    ecx_redportt *redport;

    struct cm1e_nic *nic;
    const uint8_t *logical;     /**< the process image from logical address 0 on, which an LRD carries; NULL: zeros */
    uint16_t absent_from;       /**< nobody has a configured address from this one on; 0: not known. SOEM's mapping,
                                 *   which asks each slave for 2 s whether it is in Pre-Operational, is told so by the
                                 *   port */
    cm1e_port_counters_t counters;

    /* private */
    bool nic_is_ours, redundant;
    cm1e_port_slot_t slots[EC_MAXBUF];
    uint8 last_index;
    uint32_t allocations, transmissions;
    cm1e_port_rider_t riders[CM1E_RIDERS];
    struct {
        uint8_t state;          /**< ring.h: what is known about the ring */
        uint8_t misses;         /**< frames in a row of which one half did not come back */
        uint32_t learned_from;  /**< transmission from which it is known */
        int slaves;             /**< most slaves that answered a broadcast read */
        int slaves_behind;      /**< slaves that answered the last dummy of the second interface */
        bool reach_known;       /**< the last broadcast read tells how far either interface reaches */
        int reach[2];           /**< slaves that its halves have passed */
    } ring;
    ec_bufT scratch;
} ecx_portt;

extern const uint16 priMAC[3];
extern const uint16 secMAC[3];

void ec_setupheader(void *p);
int ecx_setupnic(ecx_portt *port, const char *ifname, int secondary);
int ecx_closenic(ecx_portt *port);
void ecx_setbufstat(ecx_portt *port, uint8 idx, int bufstat);
uint8 ecx_getindex(ecx_portt *port);
int ecx_outframe_red(ecx_portt *port, uint8 idx);
int ecx_inframe(ecx_portt *port, uint8 idx, int stacknumber);
int ecx_waitinframe(ecx_portt *port, uint8 idx, int timeout);
int ecx_srconfirm(ecx_portt *port, uint8 idx, int timeout);

#ifdef __cplusplus
}
#endif
#endif
