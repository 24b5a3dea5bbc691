/* Packet sockets: send and recv in four manners, and rings that the kernel and the program share (PACKET_MMAP). */
#include <arpa/inet.h>
#include <errno.h>
#include <linux/if_packet.h>
#include <net/ethernet.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include "socket_ways.h"

#ifndef SO_PREFER_BUSY_POLL
#define SO_PREFER_BUSY_POLL 69 /* Linux 5.11 */
#endif
#ifndef PACKET_IGNORE_OUTGOING
#define PACKET_IGNORE_OUTGOING 23 /* Linux 4.20 */
#endif

unsigned long way_calls;

int way_packet_socket(unsigned interface_index)
{
    const int fd = socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC, 0), on = 1;
    const struct sockaddr_ll address = {.sll_family = AF_PACKET, .sll_protocol = htons(WAY_ETHERTYPE),
                                        .sll_ifindex = (int)interface_index};
    setsockopt(fd, SOL_PACKET, PACKET_IGNORE_OUTGOING, &on, sizeof on);
    if (fd >= 0 && bind(fd, (const struct sockaddr *)&address, sizeof address) == 0)
        return fd;
    const int why = errno;
    close(fd);
    errno = why;
    return -1;
}

bool way_sleep(int fd)
{
    struct pollfd waits = {.fd = fd, .events = POLLIN};
    way_calls++;
    return poll(&waits, 1, WAY_WAIT_MS) > 0;
}

/* ---- send and recv ----------------------------------------------------------------------------------------------- */

static void *keep(int fd)
{
    int *state = fd >= 0 ? malloc(sizeof *state) : NULL;
    if (state)
        *state = fd;
    return state;
}

static void *open_plain(unsigned interface_index) { return keep(way_packet_socket(interface_index)); }

/* A descriptor with an option that it must have; NULL: errno. */
static void *open_with(unsigned interface_index, int level, int option, int value)
{
    const int fd = way_packet_socket(interface_index);
    if (fd < 0 || setsockopt(fd, level, option, &value, sizeof value) == 0)
        return keep(fd);
    const int why = errno;
    close(fd);
    errno = why;
    return NULL;
}

static void *open_bypass(unsigned interface_index)
{
    return open_with(interface_index, SOL_PACKET, PACKET_QDISC_BYPASS, 1);
}

static void *open_busy_poll(unsigned interface_index)
{
    void *state = open_with(interface_index, SOL_SOCKET, SO_BUSY_POLL, 50);
    const int on = 1;
    if (state)
        setsockopt(*(int *)state, SOL_SOCKET, SO_PREFER_BUSY_POLL, &on, sizeof on);
    return state;
}

static bool send_plain(void *state, const uint8_t *frame, size_t length)
{
    way_calls++;
    return send(*(int *)state, frame, length, MSG_DONTWAIT) == (ssize_t)length;
}

static size_t look(int fd, uint8_t *frame)
{
    way_calls++;
    const ssize_t n = recv(fd, frame, WAY_FRAME_MAX, MSG_DONTWAIT);
    return n > 0 ? (size_t)n : 0;
}

/* Without a look before the sleep. */
static size_t receive_later(void *state, uint8_t *frame)
{
    const int fd = *(int *)state;
    size_t length = 0;
    while (length == 0 && way_sleep(fd))
        length = look(fd, frame);
    return length;
}

/* As the library does it. */
static size_t receive_sleeping(void *state, uint8_t *frame)
{
    const int fd = *(int *)state;
    size_t length = look(fd, frame);
    while (length == 0 && way_sleep(fd))
        length = look(fd, frame);
    return length;
}

/* Never sleeps: it needs a processor of its own. */
static size_t receive_spinning(void *state, uint8_t *frame)
{
    size_t length = 0;
    for (long tries = 0; length == 0 && tries < 1000000; tries++)
        length = look(*(int *)state, frame);
    return length;
}

/* Sleeps in recv, which polls the driver before, where that has something to poll. */
static size_t receive_blocking(void *state, uint8_t *frame)
{
    way_calls++;
    const ssize_t n = recv(*(int *)state, frame, WAY_FRAME_MAX, 0);
    return n > 0 ? (size_t)n : 0;
}

static void close_plain(void *state)
{
    close(*(int *)state);
    free(state);
}

const way_t way_poll_first = {"send, poll, recv", open_plain, send_plain, receive_later, close_plain};
const way_t way_send_recv = {"send, recv, poll (the library)", open_plain, send_plain, receive_sleeping, close_plain};
const way_t way_spin = {"send, recv without a pause", open_plain, send_plain, receive_spinning, close_plain};
const way_t way_bypass = {"send, recv, PACKET_QDISC_BYPASS", open_bypass, send_plain, receive_sleeping, close_plain};
const way_t way_busy_poll = {"send, blocking recv, SO_BUSY_POLL", open_busy_poll, send_plain, receive_blocking, close_plain};

/* ---- rings ------------------------------------------------------------------------------------------------------- */

enum { SLOT = 2048, SLOTS = 16, RING_BYTES = SLOT * SLOTS };

typedef struct rings {
    int fd;
    uint8_t *memory; /* slots that come in, then slots that go out */
    unsigned in, out;
} rings_t;

static void close_rings(void *state)
{
    rings_t *rings = state;
    if (rings->memory)
        munmap(rings->memory, 2 * RING_BYTES);
    close(rings->fd);
    free(rings);
}

static bool make_rings(rings_t *rings)
{
    const int version = TPACKET_V2, on = 1;
    const struct tpacket_req request = {.tp_block_size = RING_BYTES, .tp_block_nr = 1, .tp_frame_size = SLOT,
                                        .tp_frame_nr = SLOTS};
    if (setsockopt(rings->fd, SOL_PACKET, PACKET_VERSION, &version, sizeof version) != 0 ||
        setsockopt(rings->fd, SOL_PACKET, PACKET_RX_RING, &request, sizeof request) != 0 ||
        setsockopt(rings->fd, SOL_PACKET, PACKET_TX_RING, &request, sizeof request) != 0 ||
        setsockopt(rings->fd, SOL_PACKET, PACKET_QDISC_BYPASS, &on, sizeof on) != 0)
        return false;
    void *memory = mmap(NULL, 2 * RING_BYTES, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, rings->fd, 0);
    rings->memory = memory != MAP_FAILED ? memory : NULL;
    return rings->memory != NULL;
}

static void *open_rings(unsigned interface_index)
{
    const int fd = way_packet_socket(interface_index);
    rings_t *rings = fd >= 0 ? calloc(1, sizeof *rings) : NULL;
    if (!rings)
        return NULL;
    rings->fd = fd;
    if (make_rings(rings))
        return rings;
    const int why = errno;
    close_rings(rings);
    errno = why;
    return NULL;
}

static struct tpacket2_hdr *slot_of(const rings_t *rings, bool out, unsigned number)
{
    return (struct tpacket2_hdr *)(void *)(rings->memory + (out ? RING_BYTES : 0) + number % SLOTS * SLOT);
}

static bool send_by_ring(void *state, const uint8_t *frame, size_t length)
{
    rings_t *rings = state;
    struct tpacket2_hdr *slot = slot_of(rings, true, rings->out);
    if (__atomic_load_n(&slot->tp_status, __ATOMIC_ACQUIRE) != TP_STATUS_AVAILABLE)
        return false;
    memcpy((uint8_t *)slot + TPACKET2_HDRLEN - sizeof(struct sockaddr_ll), frame, length);
    slot->tp_len = (uint32_t)length;
    __atomic_store_n(&slot->tp_status, TP_STATUS_SEND_REQUEST, __ATOMIC_RELEASE);
    rings->out++;
    way_calls++;
    return send(rings->fd, NULL, 0, MSG_DONTWAIT) >= 0;
}

static size_t receive_by_ring(void *state, uint8_t *frame)
{
    rings_t *rings = state;
    struct tpacket2_hdr *slot = slot_of(rings, false, rings->in);
    while (!(__atomic_load_n(&slot->tp_status, __ATOMIC_ACQUIRE) & TP_STATUS_USER))
        if (!way_sleep(rings->fd))
            return 0;
    const size_t length = slot->tp_snaplen < WAY_FRAME_MAX ? slot->tp_snaplen : WAY_FRAME_MAX;
    memcpy(frame, (const uint8_t *)slot + slot->tp_mac, length);
    __atomic_store_n(&slot->tp_status, TP_STATUS_KERNEL, __ATOMIC_RELEASE);
    rings->in++;
    return length;
}

const way_t way_mmap = {"PACKET_MMAP, both rings", open_rings, send_by_ring, receive_by_ring, close_rings};
