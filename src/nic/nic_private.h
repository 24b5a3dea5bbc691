/**
 * @file nic_private.h
 * Inside the nic room: what nic.c, tap.c, port.c and backend_raw.c share.
 */
#ifndef CM1E_NIC_NIC_PRIVATE_H
#define CM1E_NIC_NIC_PRIVATE_H

#include "nic/backend.h"
#include "nic/frame_queue.h"
#include "nic/pcap.h"

struct cm1e_nic {
    const cm1e_nic_backend_t *backend;
    cm1e_nic_link_t link;

    cm1e_tap_fn tap;
    void *tap_context;
    pcap_file_t *pcap;
    uint64_t frames[2];              /**< seen by the tap, by direction */
    frame_queue_t held;              /**< received frames that the tap delayed or doubled, and injected ones */
    uint8_t scratch[CM1E_FRAME_MAX]; /**< a frame to send while the tap has it */
};

extern const cm1e_nic_backend_t cm1e_backend_raw;

/** cm1e_nic_open() with a given backend (tests bring their own). */
cm1e_error_t cm1e_nic_open_backend(cm1e_nic_t **nic, const cm1e_nic_backend_t *backend, const cm1e_bus_config_t *config,
                                   cm1e_diag_t *diag);

/** The path of every frame: backend, tap, pcap. Parameters as in backend.h. @rt cycle */
bool cm1e_nic_send(cm1e_nic_t *nic, int port, const uint8_t *frame, size_t length);
size_t cm1e_nic_receive(cm1e_nic_t *nic, int *port, uint8_t *frame, int64_t deadline_ns);

/** A deadline that is in the past on every clock: takes only what is here already. */
#define NIC_NOW INT64_MIN

#endif
