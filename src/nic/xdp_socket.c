#include "nic/xdp_socket.h"

#include <errno.h>
#include <linux/ethtool.h>
#include <linux/if_xdp.h>
#include <linux/sockios.h>
#include <net/if.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/program.h"
#include "nic/frame.h"
#include "nic/nic.h"
#include "nic/raw_socket.h"
#include "nic/xdp_program.h"

/* A chunk holds a frame. Chunks before OUTGOING are for frames that come in: a burst of them waits there, as in the
 * buffer of a packet socket. The others are for frames that go out: drivers give them back late, some after a
 * millisecond. */
enum {
    CHUNK = 2048, OUTGOING = 256, SENT = 64, CHUNKS = OUTGOING + SENT, MEMORY = CHUNK * CHUNKS,
    SHORTEST_FRAME = 60, USUAL_MTU = 1500,
    TRIES = 50, PAUSE_US = 10000,  /* what a program that has just ended leaves behind is gone by then */
    LINK_TRIES = 500,              /* drivers that reset the link for an XDP program: it is back after 2 to 4 s */
};

typedef struct ring {
    void *memory;
    size_t bytes;
    unsigned mask;
    unsigned *producer, *consumer; /* they only grow */
    void *entries;
} ring_t;

struct cm1e_xdp_socket {
    cm1e_raw_socket_t holder; /* the lock of the interface; it receives nothing */
    int fd;
    cm1e_xdp_program_t program;
    uint8_t *chunks;
    ring_t fill, completion, in, out;
    uint64_t free[SENT];      /* addresses of chunks for frames that go out */
    unsigned free_count;
    bool failed;              /* the last send */
};

/* ---- the diagnosis ----------------------------------------------------------------------------------------------- */

static int question(int fd, const char *name, unsigned long what, void *data)
{
    struct ifreq request = {.ifr_data = data};
    snprintf(request.ifr_name, sizeof request.ifr_name, "%s", name);
    const int answer = ioctl(fd, what, &request);
    return answer == 0 && what == SIOCGIFMTU ? request.ifr_mtu : answer;
}

static cm1e_error_t no_right(const char *name, cm1e_diag_t *diag)
{
    char self[160];
    cm1e_program_path(self, sizeof self);
    return cm1e_diag_set(diag, CM1E_ERROR_PERMISSION, 0,
                         "AF_XDP on \"%s\" needs the privileges CAP_NET_RAW, CAP_NET_ADMIN and CAP_BPF, in a container "
                         "those of the host. Start the program with sudo, or give them once: sudo setcap cap_net_raw,"
                         "cap_net_admin,cap_bpf,cap_sys_nice,cap_ipc_lock+ep %s. \"%s\" without a comma needs "
                         "CAP_NET_RAW only.", name, self, name);
}

static cm1e_error_t no_socket(const char *name, int why, cm1e_diag_t *diag)
{
    if (why == EPERM || why == EACCES)
        return no_right(name, diag);
    return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "This kernel offers no AF_XDP (%s): it needs Linux 5.9 and "
                         "CONFIG_XDP_SOCKETS. Name the interface without a comma: \"%s\".", strerror(why), name);
}

static cm1e_error_t no_rings(const char *name, int why, cm1e_diag_t *diag)
{
    if (why == ENOBUFS || why == ENOMEM)
        return cm1e_diag_set(diag, CM1E_ERROR_PERMISSION, 0, "AF_XDP on \"%s\" needs %d KB of locked memory, and this "
                             "program may not lock so much. Give it CAP_IPC_LOCK, or raise memlock in "
                             "/etc/security/limits.conf (LimitMEMLOCK= of a service).", name, MEMORY / 1024);
    return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "The rings of AF_XDP for \"%s\" cannot be made: %s.", name,
                         strerror(why));
}

static cm1e_error_t not_bound(const char *name, int why, cm1e_diag_t *diag)
{
    if (why == EBUSY)
        return cm1e_diag_set(diag, CM1E_ERROR_INTERFACE_IN_USE, 0, "Another program has an AF_XDP socket on network "
                             "interface \"%s\". End that program first.", name);
    return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "The AF_XDP socket cannot be bound to \"%s\": %s.", name,
                         strerror(why));
}

static cm1e_error_t not_attached(const cm1e_xdp_socket_t *x, const char *name, int why, cm1e_xdp_step_t step,
                                 cm1e_diag_t *diag)
{
    const int mtu = question(x->holder.fd, name, SIOCGIFMTU, NULL);
    char cure[100];
    if (why == EPERM || why == EACCES)
        return no_right(name, diag);
    if (step == CM1E_XDP_MAKE)
        return no_socket(name, why, diag);
    if (why == EBUSY || why == EEXIST)
        return cm1e_diag_set(diag, CM1E_ERROR_INTERFACE_IN_USE, 0, "There is an XDP program at network interface "
                             "\"%s\" already, of a firewall for example, and an interface has one. `ip link show %s` "
                             "shows it. End what has put it there (or: sudo ip link set %s xdp off), or name the "
                             "interface without a comma: \"%s\".", name, name, name, name);
    if (mtu > USUAL_MTU)
        snprintf(cure, sizeof cure, "its MTU is %d, try: sudo ip link set %s mtu %d", mtu, name, USUAL_MTU);
    else
        snprintf(cure, sizeof cure, "switch LRO off (sudo ethtool -K %s lro off)", name);
    return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "The driver of \"%s\" or this kernel (before Linux 5.9) "
                         "takes no XDP program: %s. Often it is a setting of the card: %s. Or name the interface "
                         "without a comma: \"%s\".", name, strerror(why), cure, name);
}

/* ---- the interface ----------------------------------------------------------------------------------------------- */

/* How many queues frames may come in on; `word` is what ethtool calls them. 1 also where the driver does not say. */
static unsigned count_queues(int fd, const char *name, const char **word)
{
    struct ethtool_channels channels = {.cmd = ETHTOOL_GCHANNELS};
    struct ethtool_rxnfc rings = {.cmd = ETHTOOL_GRXRINGS};
    *word = "combined";
    if (question(fd, name, SIOCETHTOOL, &channels) == 0 && channels.combined_count + channels.rx_count > 0) {
        if (channels.combined_count == 0)
            *word = "rx";
        return channels.combined_count + channels.rx_count;
    }
    return question(fd, name, SIOCETHTOOL, &rings) == 0 && rings.data > 0 ? (unsigned)rings.data : 1;
}

/* A socket has one queue. Cards give what is not IP to the first one as a rule, but no rule is strict. */
static cm1e_error_t check_queues(const cm1e_xdp_socket_t *x, const char *name, cm1e_diag_t *diag)
{
    const char *word;
    const unsigned count = count_queues(x->holder.fd, name, &word);
    if (count == 1)
        return CM1E_OK;
    return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "Network interface \"%s\" has %u receive queues, and AF_XDP "
                         "sees the frames of one. Leave one: sudo ethtool -L %s %s 1. Or name the interface without a "
                         "comma: \"%s\".", name, count, name, word, name);
}

/* Some drivers begin anew with a program at them, and their link with them. */
static void wait_for_link(const char *name)
{
    for (int i = 0; i < LINK_TRIES && cm1e_nic_lacks_link(name); i++)
        usleep(PAUSE_US);
}

/* ---- rings ------------------------------------------------------------------------------------------------------- */

static bool map_ring(int fd, ring_t *ring, unsigned count, const struct xdp_ring_offset *at, off_t what, size_t entry)
{
    ring->mask = count - 1;
    ring->bytes = (size_t)at->desc + count * entry;
    ring->memory = mmap(NULL, ring->bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, fd, what);
    if (ring->memory == MAP_FAILED) {
        ring->memory = NULL;
        return false;
    }
    uint8_t *bytes = ring->memory;
    ring->producer = (unsigned *)(void *)(bytes + at->producer);
    ring->consumer = (unsigned *)(void *)(bytes + at->consumer);
    ring->entries = bytes + at->desc;
    return true;
}

static bool make_rings(cm1e_xdp_socket_t *x)
{
    const int incoming = OUTGOING, outgoing = SENT;
    struct xdp_mmap_offsets at;
    socklen_t bytes = sizeof at;
    const struct xdp_umem_reg memory = {.addr = (uintptr_t)x->chunks, .len = MEMORY, .chunk_size = CHUNK};
    return setsockopt(x->fd, SOL_XDP, XDP_UMEM_REG, &memory, sizeof memory) == 0 &&
           setsockopt(x->fd, SOL_XDP, XDP_UMEM_FILL_RING, &incoming, sizeof incoming) == 0 &&
           setsockopt(x->fd, SOL_XDP, XDP_UMEM_COMPLETION_RING, &outgoing, sizeof outgoing) == 0 &&
           setsockopt(x->fd, SOL_XDP, XDP_RX_RING, &incoming, sizeof incoming) == 0 &&
           setsockopt(x->fd, SOL_XDP, XDP_TX_RING, &outgoing, sizeof outgoing) == 0 &&
           getsockopt(x->fd, SOL_XDP, XDP_MMAP_OFFSETS, &at, &bytes) == 0 &&
           map_ring(x->fd, &x->fill, OUTGOING, &at.fr, XDP_UMEM_PGOFF_FILL_RING, sizeof(uint64_t)) &&
           map_ring(x->fd, &x->completion, SENT, &at.cr, (off_t)XDP_UMEM_PGOFF_COMPLETION_RING, sizeof(uint64_t)) &&
           map_ring(x->fd, &x->in, OUTGOING, &at.rx, XDP_PGOFF_RX_RING, sizeof(struct xdp_desc)) &&
           map_ring(x->fd, &x->out, SENT, &at.tx, XDP_PGOFF_TX_RING, sizeof(struct xdp_desc));
}

static void unmap(const ring_t *ring)
{
    if (ring->memory)
        munmap(ring->memory, ring->bytes);
}

/* What the other side has written, and everything that it wrote before. */
static unsigned seen(const unsigned *word) { return __atomic_load_n(word, __ATOMIC_ACQUIRE); }
static void advance(unsigned *word) { __atomic_store_n(word, *word + 1, __ATOMIC_RELEASE); }

/* Gives the kernel a chunk for a frame that comes in. There are as many places as chunks. */
static void give_chunk(cm1e_xdp_socket_t *x, uint64_t address)
{
    ((uint64_t *)x->fill.entries)[*x->fill.producer & x->fill.mask] = address;
    advance(x->fill.producer);
}

/* ---- life -------------------------------------------------------------------------------------------------------- */

static cm1e_error_t make_socket(cm1e_xdp_socket_t *x, const char *name, cm1e_diag_t *diag)
{
    void *chunks = mmap(NULL, MEMORY, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_POPULATE, -1, 0);
    if (chunks == MAP_FAILED)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the frames of \"%s\".", name);
    x->chunks = chunks;
    /* After a fork() the kernel would go on with pages that are not ours any more. */
    madvise(chunks, MEMORY, MADV_DONTFORK);
    x->fd = socket(AF_XDP, SOCK_RAW | SOCK_CLOEXEC, 0);
    if (x->fd < 0)
        return no_socket(name, errno, diag);
    if (!make_rings(x))
        return no_rings(name, errno, diag);
    for (uint64_t i = 0; i < OUTGOING; i++)
        give_chunk(x, i * CHUNK);
    for (; x->free_count < SENT; x->free_count++)
        x->free[x->free_count] = (OUTGOING + (uint64_t)x->free_count) * CHUNK;
    return CM1E_OK;
}

/* The kernel takes socket and program of a process that has ended away a moment later. */
static cm1e_error_t bind_and_attach(cm1e_xdp_socket_t *x, const char *name, cm1e_diag_t *diag)
{
    const unsigned index = if_nametoindex(name);
    const struct sockaddr_xdp address = {.sxdp_family = AF_XDP, .sxdp_flags = XDP_COPY, .sxdp_ifindex = index};
    cm1e_xdp_step_t step = CM1E_XDP_MAKE;
    int why = EBUSY;
    for (int i = 0; i < TRIES && why == EBUSY; i++, why == EBUSY ? usleep(PAUSE_US) : 0)
        why = bind(x->fd, (const struct sockaddr *)&address, sizeof address) == 0 ? 0 : errno;
    if (why != 0)
        return not_bound(name, why, diag);
    why = EBUSY;
    for (int i = 0; i < TRIES && why == EBUSY; i++, why == EBUSY ? usleep(PAUSE_US) : 0) {
        cm1e_xdp_program_close(&x->program);
        why = cm1e_xdp_program_attach(&x->program, x->fd, index, &step);
    }
    return why == 0 ? CM1E_OK : not_attached(x, name, why, step, diag);
}

cm1e_error_t cm1e_xdp_socket_open(cm1e_xdp_socket_t **made, const char *interface_name, cm1e_diag_t *diag)
{
    *made = NULL;
    cm1e_xdp_socket_t *x = calloc(1, sizeof *x);
    if (!x)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the network interface.");
    x->fd = -1;
    x->program = CM1E_XDP_NO_PROGRAM;
    cm1e_error_t error = cm1e_raw_socket_hold(&x->holder, interface_name, diag);
    if (error == CM1E_ERROR_PERMISSION)
        error = no_right(interface_name, diag);
    if (error == CM1E_OK)
        error = check_queues(x, interface_name, diag);
    if (error == CM1E_OK)
        error = make_socket(x, interface_name, diag);
    if (error == CM1E_OK)
        error = bind_and_attach(x, interface_name, diag);
    if (error != CM1E_OK) {
        cm1e_xdp_socket_close(x);
        return error;
    }
    wait_for_link(interface_name);
    *made = x;
    return CM1E_OK;
}

void cm1e_xdp_socket_close(cm1e_xdp_socket_t *closed)
{
    if (!closed)
        return;
    cm1e_xdp_program_close(&closed->program);
    unmap(&closed->fill);
    unmap(&closed->completion);
    unmap(&closed->in);
    unmap(&closed->out);
    if (closed->fd >= 0)
        close(closed->fd);
    if (closed->chunks)
        munmap(closed->chunks, MEMORY);
    cm1e_raw_socket_close(&closed->holder); /* last: nothing of ours is sent any more */
    free(closed);
}

int cm1e_xdp_socket_fd(const cm1e_xdp_socket_t *x) { return x->fd; }

/* ---- frames ------------------------------------------------------------------------------------------------------ */

/* Chunks of frames that have been sent. */
static void take_back(cm1e_xdp_socket_t *x)
{
    while (*x->completion.consumer != seen(x->completion.producer)) {
        if (x->free_count < SENT)
            x->free[x->free_count++] =
                ((const uint64_t *)x->completion.entries)[*x->completion.consumer & x->completion.mask];
        advance(x->completion.consumer);
    }
}

static struct xdp_desc *place(const cm1e_xdp_socket_t *x, unsigned number)
{
    return &((struct xdp_desc *)x->out.entries)[number & x->out.mask];
}

/* Has the kernel send what is in the ring. */
static bool send_all(cm1e_xdp_socket_t *x)
{
    /* cppcheck-suppress nullPointer ; the frames are in the ring */
    x->failed = sendto(x->fd, NULL, 0, MSG_DONTWAIT | MSG_NOSIGNAL, NULL, 0) < 0;
    return !x->failed;
}

/* A frame that the interface did not take, because it was down, is still in the ring and leaves before the next one.
 * Its targets are old by then: it leaves as a frame without datagrams, which no slave processes. false: it is still
 * there. */
static bool clear_unsent(cm1e_xdp_socket_t *x)
{
    if (*x->out.producer == seen(x->out.consumer))
        return true;
    memset(x->chunks + place(x, *x->out.producer - 1)->addr + ETHERNET_HEADER, 0, FRAME_HEADER - ETHERNET_HEADER);
    return send_all(x);
}

bool cm1e_xdp_socket_send(cm1e_xdp_socket_t *x, const uint8_t *frame, size_t length)
{
    if (x->failed && !clear_unsent(x))
        return false;
    take_back(x);
    if (x->free_count == 0 || length > CM1E_FRAME_MAX)
        return false;
    const uint64_t address = x->free[--x->free_count];
    size_t sent = length;
    memcpy(x->chunks + address, frame, length);
    for (; sent < SHORTEST_FRAME; sent++) /* not every driver makes a short frame longer */
        x->chunks[address + sent] = 0;
    *place(x, *x->out.producer) = (struct xdp_desc){.addr = address, .len = (uint32_t)sent};
    advance(x->out.producer);
    return send_all(x);
}

size_t cm1e_xdp_socket_receive(cm1e_xdp_socket_t *x, uint8_t *frame, size_t room)
{
    if (*x->in.consumer == seen(x->in.producer))
        return 0;
    const struct xdp_desc came = ((const struct xdp_desc *)x->in.entries)[*x->in.consumer & x->in.mask];
    const size_t length = came.len < room ? came.len : room;
    memcpy(frame, x->chunks + came.addr, length);
    advance(x->in.consumer);
    give_chunk(x, came.addr - came.addr % CHUNK);
    return length;
}
