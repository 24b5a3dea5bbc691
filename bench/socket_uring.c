/* A packet socket behind io_uring: a receive always waits in the kernel; one call sends and waits for the answer. */
#include <errno.h>
#include <linux/io_uring.h>
#include <linux/time_types.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "socket_ways.h"

enum { ENTRIES = 8, OF_SEND = 1, OF_RECEIVE = 2 };

typedef struct uring {
    int socket, ring;
    struct io_uring_params params;
    uint8_t *queues;
    size_t queue_bytes;
    struct io_uring_sqe *entries;
    unsigned unsent;                /* entries that the kernel has not been told of */
    bool receiving;
    int received;
    uint8_t outgoing[WAY_FRAME_MAX], incoming[WAY_FRAME_MAX];
} uring_t;

static unsigned *word_of(const uring_t *u, unsigned offset) { return (unsigned *)(void *)(u->queues + offset); }

static void close_uring(void *state)
{
    uring_t *u = state;
    if (u->entries)
        munmap(u->entries, ENTRIES * sizeof *u->entries);
    if (u->queues)
        munmap(u->queues, u->queue_bytes);
    if (u->ring >= 0)
        close(u->ring);
    close(u->socket);
    free(u);
}

static void *map(const uring_t *u, size_t bytes, off_t what)
{
    void *at = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, u->ring, what);
    return at != MAP_FAILED ? at : NULL;
}

static bool make_ring(uring_t *u)
{
    u->ring = (int)syscall(SYS_io_uring_setup, ENTRIES, &u->params);
    if (u->ring < 0)
        return false;
    if (!(u->params.features & IORING_FEAT_SINGLE_MMAP) || !(u->params.features & IORING_FEAT_EXT_ARG)) {
        errno = ENOSYS; /* before Linux 5.11 */
        return false;
    }
    const size_t sent = u->params.sq_off.array + u->params.sq_entries * sizeof(unsigned);
    const size_t done = u->params.cq_off.cqes + u->params.cq_entries * sizeof(struct io_uring_cqe);
    u->queue_bytes = sent > done ? sent : done;
    u->queues = map(u, u->queue_bytes, IORING_OFF_SQ_RING);
    u->entries = map(u, ENTRIES * sizeof *u->entries, IORING_OFF_SQES);
    return u->queues && u->entries;
}

static void *open_uring(unsigned interface_index)
{
    const int fd = way_packet_socket(interface_index);
    uring_t *u = fd >= 0 ? calloc(1, sizeof *u) : NULL;
    if (!u)
        return NULL;
    u->socket = fd;
    u->ring = -1;
    if (make_ring(u))
        return u;
    const int why = errno;
    close_uring(u);
    errno = why;
    return NULL;
}

static void post(uring_t *u, uint8_t operation, uint8_t *data, size_t length)
{
    unsigned *tail = word_of(u, u->params.sq_off.tail);
    const unsigned place = *tail & *word_of(u, u->params.sq_off.ring_mask);
    u->entries[place] = (struct io_uring_sqe){.opcode = operation, .fd = u->socket, .addr = (uintptr_t)data,
                                              .len = (uint32_t)length,
                                              .user_data = operation == IORING_OP_SEND ? OF_SEND : OF_RECEIVE};
    word_of(u, u->params.sq_off.array)[place] = place;
    __atomic_store_n(tail, *tail + 1, __ATOMIC_RELEASE);
    u->unsent++;
}

static void take_completions(uring_t *u)
{
    unsigned *head = word_of(u, u->params.cq_off.head);
    const unsigned tail = __atomic_load_n(word_of(u, u->params.cq_off.tail), __ATOMIC_ACQUIRE);
    const struct io_uring_cqe *all = (const struct io_uring_cqe *)(const void *)(u->queues + u->params.cq_off.cqes);
    for (; *head != tail; __atomic_store_n(head, *head + 1, __ATOMIC_RELEASE)) {
        const struct io_uring_cqe *done = &all[*head & *word_of(u, u->params.cq_off.ring_mask)];
        if (done->user_data == OF_RECEIVE) {
            u->received = done->res;
            u->receiving = false;
        }
    }
}

/* Both wait for the call of the receive: that of the send is in it. */
static bool send_by_uring(void *state, const uint8_t *frame, size_t length)
{
    uring_t *u = state;
    if (!u->receiving)
        post(u, IORING_OP_RECV, u->incoming, sizeof u->incoming);
    u->receiving = true;
    memcpy(u->outgoing, frame, length);
    post(u, IORING_OP_SEND, u->outgoing, length);
    return true;
}

static size_t receive_by_uring(void *state, uint8_t *frame)
{
    uring_t *u = state;
    struct __kernel_timespec longest = {.tv_nsec = WAY_WAIT_MS * 1000000L};
    const struct io_uring_getevents_arg waits = {.ts = (uintptr_t)&longest};
    while (u->receiving) {
        way_calls++;
        if (syscall(SYS_io_uring_enter, u->ring, u->unsent, 1, IORING_ENTER_GETEVENTS | IORING_ENTER_EXT_ARG, &waits,
                    sizeof waits) < 0 && errno != EINTR)
            return 0;
        u->unsent = 0;
        take_completions(u);
    }
    if (u->received <= 0)
        return 0;
    memcpy(frame, u->incoming, (size_t)u->received);
    return (size_t)u->received;
}

const way_t way_uring = {"io_uring, one call for both", open_uring, send_by_uring, receive_by_uring, close_uring};
