/* Network interfaces: a packet socket for each port. Waits end exactly at the deadline. */
#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/clock.h"
#include "nic/nic_private.h"
#include "nic/raw_socket.h"

enum { USELESS_WAKE_UPS = 16 };

typedef struct raw {
    cm1e_raw_socket_t sockets[CM1E_NIC_PORTS];
    struct pollfd fds[CM1E_NIC_PORTS];
} raw_t;

static bool raw_matches(const char *name) { return name[0] != 0; }

static void raw_close(cm1e_nic_link_t *link)
{
    raw_t *raw = link->state;
    for (int i = 0; i < link->ports; i++)
        cm1e_raw_socket_close(&raw->sockets[i]);
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

static cm1e_error_t raw_open(cm1e_nic_link_t *link, const cm1e_bus_config_t *config, cm1e_diag_t *diag)
{
    raw_t *raw = calloc(1, sizeof *raw);
    if (!raw)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the network interface.");
    link->state = raw;
    for (int i = 0; i < CM1E_NIC_PORTS; i++)
        raw->sockets[i] = CM1E_RAW_SOCKET_CLOSED;
    const char *names[CM1E_NIC_PORTS] = {link->interface_name, config->second_interface};
    if (link->ports > 1 && strcmp(names[0], names[1]) == 0) {
        raw_close(link);
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                             "Both interfaces of the ring are \"%s\": a ring needs two network interfaces.", names[0]);
    }
    for (int i = 0; i < link->ports; i++) {
        /* NOLINTNEXTLINE(clang-analyzer-core.CallAndMessage): a link has two ports at most */
        const cm1e_error_t error = cm1e_raw_socket_open(&raw->sockets[i], names[i], diag);
        if (error != CM1E_OK) {
            raw_close(link);
            return error;
        }
        raw->fds[i] = (struct pollfd){.fd = raw->sockets[i].fd, .events = POLLIN};
    }
    link->identity = make_identity();
    /* A thread without real-time priority is woken up to 50 us late by default; this is the thread that waits. */
    prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
    return CM1E_OK;
}

static bool raw_send(cm1e_nic_link_t *link, int port, const uint8_t *frame, size_t length)
{
    const raw_t *raw = link->state;
    return send(raw->sockets[port].fd, frame, length, MSG_DONTWAIT | MSG_NOSIGNAL) == (ssize_t)length;
}

static size_t look(cm1e_nic_link_t *link, int *port, uint8_t *frame)
{
    const raw_t *raw = link->state;
    for (int i = 0; i < link->ports; i++) {
        const int n = cm1e_raw_socket_receive(raw->sockets[i].fd, frame, CM1E_FRAME_MAX);
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
