/**
 * @file nic.h
 * The network interface below SOEM: a table of backends (raw socket, simulated segment) chosen by the interface name,
 * with a tap through which every frame passes. SOEM's port functions (ecx_setupnic, ecx_outframe_red, ecx_waitinframe
 * ... : port/nicdrv.h) are implemented once, in port.c, on this. One thread owns a nic.
 */
#ifndef CM1E_NIC_NIC_H
#define CM1E_NIC_NIC_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cm1e/config.h"
#include "core/clock.h"
#include "sim/segment.h"

typedef struct cm1e_nic cm1e_nic_t;

enum { CM1E_FRAME_MAX = 1518, CM1E_NIC_PORTS = 2 };

/** One backend: open, send, receive, close. */
typedef struct cm1e_nic_backend {
    const char *name;
    bool (*matches)(const char *interface_name);
    cm1e_error_t (*open)(cm1e_nic_t *nic, const cm1e_bus_config_t *config, cm1e_diag_t *diag);
    /** Sends one frame on a port; false: not sent. Never blocks. */
    bool (*send)(cm1e_nic_t *nic, int port, const uint8_t *frame, size_t length);
    /** Next frame received on any port, until `deadline_ns` (clock of the nic) has passed; 0: none. `*port` says where
     *  it came in. A deadline in the past means: only what is here already. Waits exactly, to the deadline and not
     *  beyond. `frame` has room for CM1E_FRAME_MAX. */
    size_t (*receive)(cm1e_nic_t *nic, int *port, uint8_t *frame, int64_t deadline_ns);
    void (*close)(cm1e_nic_t *nic);
} cm1e_nic_backend_t;

/** Opens config->interface_name (and second_interface). Nothing is sent. */
cm1e_error_t cm1e_nic_open(cm1e_nic_t **nic, const cm1e_bus_config_t *config, cm1e_diag_t *diag);
cm1e_error_t cm1e_nic_close(cm1e_nic_t *nic);
/** The clock that runs on this nic: monotonic, or the segment's virtual one. */
cm1e_clock_t *cm1e_nic_clock(cm1e_nic_t *nic);
/** The simulated segment behind it; NULL on a network interface. */
cm1e_sim_segment_t *cm1e_nic_segment(cm1e_nic_t *nic);
/** Takes the place of the segment that cm1e_nic_open() made for "sim" (tests with slaves of their own); owns it. */
void cm1e_nic_replace_segment(cm1e_nic_t *nic, cm1e_sim_segment_t *segment);

/* ---- tap --------------------------------------------------------------------------------------------------------- */

typedef enum cm1e_tap_direction { CM1E_TAP_SENT = 0, CM1E_TAP_RECEIVED } cm1e_tap_direction_t;

/** What happens to a frame that the tap saw. */
typedef enum cm1e_tap_verdict { CM1E_TAP_PASS = 0, CM1E_TAP_DROP } cm1e_tap_verdict_t;

/** A frame on its way; the tap may change its bytes and length (truncate), drop it, delay it, double it. */
typedef struct cm1e_tap_frame {
    cm1e_tap_direction_t direction;
    int port;
    uint8_t *bytes;          /**< room for CM1E_FRAME_MAX */
    size_t length;
    int64_t time_ns;
    uint64_t number;         /**< counts frames of this direction from 0 */
    int64_t delay_ns;        /**< set: received frames are handed over that much later (others may overtake) */
    unsigned copies;         /**< 1; set 2 to duplicate */
} cm1e_tap_frame_t;

typedef cm1e_tap_verdict_t (*cm1e_tap_fn)(void *context, cm1e_tap_frame_t *frame);

/** At most one tap function; NULL removes it. It runs inside send and receive. */
void cm1e_nic_set_tap(cm1e_nic_t *nic, cm1e_tap_fn tap, void *context);
/** Puts a frame into the receive path of a port, as if it had come from the wire. */
bool cm1e_nic_inject(cm1e_nic_t *nic, int port, const uint8_t *frame, size_t length, int64_t at_ns);
/** Changes the working counter of datagram `n` (0 = first) of an EtherCAT frame by `delta`; false: no such datagram. */
bool cm1e_frame_change_working_counter(uint8_t *frame, size_t length, unsigned n, int delta);
/** Starts to write every frame (after the tap) to a pcap file (nanosecond pcap, Ethernet). */
cm1e_error_t cm1e_nic_pcap(cm1e_nic_t *nic, const char *path, cm1e_diag_t *diag);

/* ---- serving a segment on a network interface (`cm1e sim -i`) ---------------------------------------------------- */

typedef struct cm1e_nic_server cm1e_nic_server_t;

/** Where a server reads lines of the console, and writes answers and what happens unasked; -1: nowhere. */
typedef struct cm1e_nic_console {
    int lines, answers, notices;
} cm1e_nic_console_t;

/** Takes a network interface, on which frames are answered with `segment`. CM1E_ERROR_STATE: another server has it.
 *  @rt init */
cm1e_error_t cm1e_nic_server_open(cm1e_nic_server_t **server, cm1e_sim_segment_t *segment, const char *interface_name,
                                  cm1e_diag_t *diag);
/** Serves until `*stop` is not 0. An interface that goes down, or away, is said in a notice and waited for.
 *
 *  A frame that came from another simulated segment, where the two face each other, would go round for ever. Slave
 *  controllers break that with the circulating bit, where a port has no link. Here a frame that slaves have processed
 *  already (source address 0x02, ETG.1000.4) passes once: it leaves marked as circulated, and one that arrives so is
 *  destroyed. Masters send neither mark. One whose own address has that bit is told apart by its working counters: they
 *  are 0 in a new frame, and not in what a segment gave back. */
void cm1e_nic_server_run(cm1e_nic_server_t *server, const cm1e_nic_console_t *console, const volatile int *stop);
/** NULL-safe. */
void cm1e_nic_server_close(cm1e_nic_server_t *server);

#endif
