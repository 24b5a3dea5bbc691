/**
 * @file nic.h
 * The network interface below SOEM. The interface name chooses a backend (backend.h): the packet socket, or one that
 * was registered, as the simulator. Every frame passes a tap. SOEM's port functions (ecx_setupnic, ecx_outframe_red,
 * ecx_waitinframe ... : port/nicdrv.h) are implemented once, in port.c, on this. One thread owns a nic.
 */
#ifndef CM1E_NIC_NIC_H
#define CM1E_NIC_NIC_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cm1e/config.h"
#include "core/clock.h"

typedef struct cm1e_nic cm1e_nic_t;
typedef struct cm1e_nic_backend cm1e_nic_backend_t;

enum { CM1E_FRAME_MAX = 1518, CM1E_NIC_PORTS = 2 };

/** Opens config->interface_name (and second_interface). Nothing is sent. */
cm1e_error_t cm1e_nic_open(cm1e_nic_t **nic, const cm1e_bus_config_t *config, cm1e_diag_t *diag);
cm1e_error_t cm1e_nic_close(cm1e_nic_t *nic);
/** The clock that runs on this nic: monotonic, or one of the backend. */
cm1e_clock_t *cm1e_nic_clock(cm1e_nic_t *nic);

/** `function` runs before every frame that the library sends, in the thread that sends it; the last one given counts.
 *  What it sends itself on other nics passes it too. @rt any */
void cm1e_nic_before_send(void (*function)(const cm1e_nic_t *nic));

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

/** An interface of this name (with or without a way) exists, and has no link: cable out, or the other end has no power.
 *  @rt block */
bool cm1e_nic_lacks_link(const char *interface_name);

#endif
