/* Network interfaces: for each port the way that its name states. Waits end exactly at the deadline. */
#include <errno.h>
#include <poll.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <unistd.h>

#include "config/interface.h"
#include "core/clock.h"
#include "nic/nic_private.h"
#include "nic/raw_socket.h"
#include "nic/xdp_socket.h"

enum { USELESS_WAKE_UPS = 16 };

/** A port, open by one of the ways. */
typedef struct end {
    const struct way *way;      /**< NULL: not open */
    cm1e_raw_socket_t packet;
    cm1e_xdp_socket_t *xdp;
} end_t;

typedef struct way {
    cm1e_error_t (*open)(end_t *end, int *fd, const char *interface_name, cm1e_diag_t *diag);
    bool (*send)(const end_t *end, const uint8_t *frame, size_t length);
    int (*look)(const end_t *end, uint8_t *frame, size_t room); /* a frame that is here; 0: none; -1: an error */
    void (*close)(end_t *end);
} way_t;

typedef struct raw {
    end_t ends[CM1E_NIC_PORTS];
    struct pollfd fds[CM1E_NIC_PORTS];
    bool wakes_opener;      /**< the timer slack of this thread was changed */
    pthread_t opener;
} raw_t;

/** Of this thread: the interfaces that need it awake in time, and its timer slack without them. */
static _Thread_local struct {
    unsigned interfaces;
    int slack_ns;
} awake;

/* ---- the ways ---------------------------------------------------------------------------------------------------- */

static cm1e_error_t packet_open(end_t *end, int *fd, const char *interface_name, cm1e_diag_t *diag)
{
    const cm1e_error_t error = cm1e_raw_socket_open(&end->packet, interface_name, diag);
    *fd = end->packet.fd;
    return error;
}

static bool packet_send(const end_t *end, const uint8_t *frame, size_t length)
{
    return send(end->packet.fd, frame, length, MSG_DONTWAIT | MSG_NOSIGNAL) == (ssize_t)length;
}

static int packet_look(const end_t *end, uint8_t *frame, size_t room)
{
    return cm1e_raw_socket_receive(end->packet.fd, frame, room);
}

static void packet_close(end_t *end) { cm1e_raw_socket_close(&end->packet); }

static cm1e_error_t xdp_open(end_t *end, int *fd, const char *interface_name, cm1e_diag_t *diag)
{
    const cm1e_error_t error = cm1e_xdp_socket_open(&end->xdp, interface_name, diag);
    *fd = error == CM1E_OK ? cm1e_xdp_socket_fd(end->xdp) : -1;
    return error;
}

static bool xdp_send(const end_t *end, const uint8_t *frame, size_t length)
{
    return cm1e_xdp_socket_send(end->xdp, frame, length);
}

static int xdp_look(const end_t *end, uint8_t *frame, size_t room)
{
    return (int)cm1e_xdp_socket_receive(end->xdp, frame, room);
}

static void xdp_close(end_t *end) { cm1e_xdp_socket_close(end->xdp); }

static const way_t ways[CM1E_WAYS] = {
    [CM1E_WAY_PACKET] = {packet_open, packet_send, packet_look, packet_close},
    [CM1E_WAY_XDP] = {xdp_open, xdp_send, xdp_look, xdp_close},
};

/* ---- the backend ------------------------------------------------------------------------------------------------- */

static bool raw_matches(const char *name) { return name[0] != 0; }

/** A thread without real-time priority is woken up to 50 us late by default; this is the thread that waits. */
static void wake_in_time(raw_t *raw)
{
    raw->wakes_opener = true;
    raw->opener = pthread_self();
    if (awake.interfaces++ == 0)
        awake.slack_ns = prctl(PR_GET_TIMERSLACK, 0UL, 0UL, 0UL, 0UL);
    prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
}

/** Where the last interface of the thread goes. */
static void sleep_as_before(const raw_t *raw)
{
    if (!raw->wakes_opener || !pthread_equal(raw->opener, pthread_self()) || awake.interfaces == 0)
        return; /* another thread closes it: only a thread itself has a timer slack */
    if (--awake.interfaces == 0 && awake.slack_ns > 0)
        prctl(PR_SET_TIMERSLACK, (unsigned long)awake.slack_ns, 0UL, 0UL, 0UL);
}

static void raw_close(cm1e_nic_link_t *link)
{
    raw_t *raw = link->state;
    for (int i = 0; i < link->ports; i++)
        if (raw->ends[i].way)
            raw->ends[i].way->close(&raw->ends[i]);
    sleep_as_before(raw);
    free(raw);
}

/** By chance, so that no two programs have the same, whatever their process numbers. */
static uint16_t make_identity(void)
{
    uint16_t identity;
    if (getrandom(&identity, sizeof identity, GRND_NONBLOCK) != sizeof identity)
        identity = (uint16_t)getpid();
    return identity != CM1E_SOEM_IDENTITY ? identity : 0;
}

static cm1e_error_t open_end(end_t *end, struct pollfd *fd, const char *name, cm1e_diag_t *diag)
{
    char wrong[300], own_name[64];
    const cm1e_interface_way_t way = cm1e_interface_way(name, wrong, sizeof wrong);
    if (way == CM1E_WAY_UNKNOWN)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "Interface \"%s\" %s.", name, wrong);
    cm1e_interface_own_name(own_name, sizeof own_name, name);
    fd->events = POLLIN;
    const cm1e_error_t error = ways[way].open(end, &fd->fd, own_name, diag);
    end->way = error == CM1E_OK ? &ways[way] : NULL;
    return error;
}

static cm1e_error_t raw_open(cm1e_nic_link_t *link, const cm1e_bus_config_t *config, cm1e_diag_t *diag)
{
    raw_t *raw = calloc(1, sizeof *raw);
    if (!raw)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the network interface.");
    link->state = raw;
    const char *names[CM1E_NIC_PORTS] = {link->interface_name, config->second_interface};
    if (link->ports > 1 && cm1e_interface_is_same(names[0], names[1])) {
        raw_close(link);
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                             "Both interfaces of the ring are \"%s\": a ring needs two network interfaces.", names[0]);
    }
    for (int i = 0; i < link->ports; i++) {
        /* NOLINTNEXTLINE(clang-analyzer-core.CallAndMessage): a link has two ports at most */
        const cm1e_error_t error = open_end(&raw->ends[i], &raw->fds[i], names[i], diag);
        if (error != CM1E_OK) {
            raw_close(link);
            return error;
        }
    }
    link->identity = make_identity();
    wake_in_time(raw);
    return CM1E_OK;
}

static bool raw_send(cm1e_nic_link_t *link, int port, const uint8_t *frame, size_t length)
{
    const raw_t *raw = link->state;
    return raw->ends[port].way->send(&raw->ends[port], frame, length);
}

static size_t look(cm1e_nic_link_t *link, int *port, uint8_t *frame)
{
    const raw_t *raw = link->state;
    for (int i = 0; i < link->ports; i++) {
        const int n = raw->ends[i].way->look(&raw->ends[i], frame, CM1E_FRAME_MAX);
        if (n > 0) {
            *port = i;
            return (size_t)n;
        }
    }
    return 0;
}

static size_t raw_receive(cm1e_nic_link_t *link, int *port, uint8_t *frame, int64_t deadline_ns)
{
    raw_t *raw = link->state;
    /* A look before the first sleep is a call for nothing where the frame was sent a moment ago. Leaving it out was
     * tried: the answer is not taken sooner, because the call is made while the frame is on its way (bench_socket). */
    for (int useless = 0;;) {
        const size_t length = look(link, port, frame);
        if (length > 0 || deadline_ns == NIC_NOW)
            return length;
        const int64_t left_ns = deadline_ns - cm1e_clock_now(link->clock);
        if (left_ns <= 0)
            return 0;
        const struct timespec left = {.tv_sec = left_ns / S_IN_NS, .tv_nsec = left_ns % S_IN_NS};
        const int ready = ppoll(raw->fds, (nfds_t)link->ports, &left, NULL);
        /* An interface that was removed reports errors without end, which would make this a busy loop. */
        if (ready > 0 && ++useless > USELESS_WAKE_UPS)
            cm1e_clock_sleep_until(link->clock, deadline_ns);
    }
}

const cm1e_nic_backend_t cm1e_backend_raw = {"raw", raw_matches, raw_open, raw_send, raw_receive, raw_close};
