/* The path of every frame between port and backend. Without tap, pcap and held frames it is a plain call. */
#include <stdatomic.h>
#include <string.h>

#include "nic/nic_private.h"

/** Frames that one receive looks at: a flood that the tap drops must not keep the caller beyond its deadline. */
enum { RECEIVE_BUDGET = 256 };

void cm1e_nic_set_tap(cm1e_nic_t *nic, cm1e_tap_fn tap, void *context)
{
    nic->tap = tap;
    nic->tap_context = context;
}

cm1e_error_t cm1e_nic_pcap(cm1e_nic_t *nic, const char *path, cm1e_diag_t *diag)
{
    cm1e_pcap_close(nic->pcap);
    nic->pcap = NULL;
    return cm1e_pcap_open(&nic->pcap, path, diag);
}

static bool hold(cm1e_nic_t *nic, int port, const uint8_t *frame, size_t length, int64_t at_ns, bool tapped)
{
    queued_frame_t *place = cm1e_frame_queue_place(&nic->held);
    if (!place || length > sizeof place->bytes)
        return false;
    memcpy(place->bytes, frame, length);
    place->length = length;
    place->port = port;
    place->tapped = tapped;
    cm1e_frame_queue_insert(&nic->held, place, at_ns);
    return true;
}

bool cm1e_nic_inject(cm1e_nic_t *nic, int port, const uint8_t *frame, size_t length, int64_t at_ns)
{
    return length > 0 && port >= 0 && port < CM1E_NIC_PORTS && hold(nic, port, frame, length, at_ns, false);
}

/** Shows a frame to the tap; false: it is gone. */
static bool pass_tap(cm1e_nic_t *nic, cm1e_tap_frame_t *t)
{
    t->number = nic->frames[t->direction]++;
    t->time_ns = cm1e_clock_now(nic->link.clock);
    t->copies = 1;
    if (nic->tap && nic->tap(nic->tap_context, t) == CM1E_TAP_DROP)
        return false;
    if (t->length > CM1E_FRAME_MAX)
        t->length = CM1E_FRAME_MAX;
    return t->length > 0 && t->copies > 0;
}

typedef void (*before_send_t)(const cm1e_nic_t *nic);
static _Atomic(before_send_t) before_send;

void cm1e_nic_before_send(before_send_t function)
{
    atomic_store_explicit(&before_send, function, memory_order_relaxed);
}

bool cm1e_nic_send(cm1e_nic_t *nic, int port, const uint8_t *frame, size_t length)
{
    const before_send_t before = atomic_load_explicit(&before_send, memory_order_relaxed);
    if (length == 0 || length > CM1E_FRAME_MAX || port >= nic->link.ports)
        return false;
    if (before)
        before(nic);
    if (!nic->tap && !nic->pcap)
        return nic->backend->send(&nic->link, port, frame, length);

    memcpy(nic->scratch, frame, length);
    cm1e_tap_frame_t t = {.direction = CM1E_TAP_SENT, .port = port, .bytes = nic->scratch, .length = length};
    if (!pass_tap(nic, &t))
        return true; /* the frame is lost on the wire, which the sender does not notice */
    bool sent = false;
    for (unsigned i = 0; i < t.copies; i++) {
        if (nic->pcap)
            cm1e_pcap_write(nic->pcap, t.time_ns, t.bytes, t.length);
        sent = nic->backend->send(&nic->link, port, t.bytes, t.length);
    }
    return sent;
}

/** A frame that just came in, through the tap. Returns the length that goes to the caller now, 0: nothing. */
static size_t take(cm1e_nic_t *nic, int port, uint8_t *frame, size_t length)
{
    cm1e_tap_frame_t t = {.direction = CM1E_TAP_RECEIVED, .port = port, .bytes = frame, .length = length};
    if (!pass_tap(nic, &t))
        return 0;
    const bool later = t.delay_ns > 0;
    for (unsigned i = later ? 0 : 1; i < t.copies; i++)
        hold(nic, port, t.bytes, t.length, t.time_ns + (later ? t.delay_ns : 0), true);
    return later ? 0 : t.length;
}

size_t cm1e_nic_receive(cm1e_nic_t *nic, int *port, uint8_t *frame, int64_t deadline_ns)
{
    if (!nic->tap && !nic->pcap && nic->held.count == 0)
        return nic->backend->receive(&nic->link, port, frame, deadline_ns);

    for (int i = 0; i < RECEIVE_BUDGET; i++) {
        size_t length;
        bool tapped = false;
        queued_frame_t *held = frame_queue_first(&nic->held);
        if (held && held->ready_ns <= cm1e_clock_now(nic->link.clock)) {
            length = held->length;
            *port = held->port;
            tapped = held->tapped;
            memcpy(frame, held->bytes, length);
            cm1e_frame_queue_remove_first(&nic->held);
        } else {
            const int64_t until = held && held->ready_ns < deadline_ns ? held->ready_ns : deadline_ns;
            length = nic->backend->receive(&nic->link, port, frame, until);
            if (length == 0) {
                if (until < deadline_ns)
                    continue;
                return 0;
            }
        }
        if (!tapped)
            length = take(nic, *port, frame, length);
        if (length > 0) {
            if (nic->pcap)
                cm1e_pcap_write(nic->pcap, cm1e_clock_now(nic->link.clock), frame, length);
            return length;
        }
    }
    return 0;
}
