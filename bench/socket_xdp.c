/* AF_XDP: frames in memory of the program, taken from the driver before the network stack of the kernel. A program of eBPF at
 * the interface passes EtherCAT frames to the socket, and all others to the kernel. On interfaces whose driver does not offer
 * more, the kernel copies each frame (XDP_COPY). */
#include <errno.h>
#include <linux/bpf.h>
#include <linux/if_xdp.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "socket_ways.h"

enum { CHUNK = 2048, CHUNKS = 32, RING = 16, OUTGOING = 16 }; /* chunks from OUTGOING on are sent */

typedef struct ring {
    void *memory;
    size_t bytes;
    unsigned *producer, *consumer;
    void *entries;
} ring_t;

typedef struct xdp {
    int socket, map, program, link;
    uint8_t *chunks;
    ring_t fill, completion, in, out;
} xdp_t;

static int bpf(enum bpf_cmd command, union bpf_attr *words) { return (int)syscall(SYS_bpf, command, words, sizeof *words); }

/* ---- the program at the interface -------------------------------------------------------------------------------- */

#define OP(c, d, s, o, i) ((struct bpf_insn){.code = (c), .dst_reg = (d), .src_reg = (s), .off = (o), .imm = (i)})

/* Registers: 1 the context, 2 the frame, 3 its end. */
static bool load_program(xdp_t *x)
{
    static const char licence[] = "MIT";
    const struct bpf_insn code[] = {
        OP(BPF_LDX | BPF_MEM | BPF_W, 2, 1, 0, 0),                 /* data */
        OP(BPF_LDX | BPF_MEM | BPF_W, 3, 1, 4, 0),                 /* data_end */
        OP(BPF_ALU64 | BPF_MOV | BPF_X, 4, 2, 0, 0),
        OP(BPF_ALU64 | BPF_ADD | BPF_K, 4, 0, 0, 14),
        OP(BPF_JMP | BPF_JGT | BPF_X, 4, 3, 7, 0),                 /* no whole header: to the kernel */
        OP(BPF_LDX | BPF_MEM | BPF_H, 5, 2, 12, 0),
        OP(BPF_JMP | BPF_JNE | BPF_K, 5, 0, 5, 0xA488),            /* the EtherType, as this processor reads it */
        OP(BPF_LDX | BPF_MEM | BPF_W, 2, 1, 16, 0),                /* rx_queue_index */
        OP(BPF_LD | BPF_DW | BPF_IMM, 1, BPF_PSEUDO_MAP_FD, 0, x->map), OP(0, 0, 0, 0, 0),
        OP(BPF_ALU64 | BPF_MOV | BPF_K, 3, 0, 0, XDP_PASS),
        OP(BPF_JMP | BPF_JA, 0, 0, 2, 0),
        OP(BPF_ALU64 | BPF_MOV | BPF_K, 0, 0, 0, XDP_PASS),
        OP(BPF_JMP | BPF_EXIT, 0, 0, 0, 0),
        OP(BPF_JMP | BPF_CALL, 0, 0, 0, BPF_FUNC_redirect_map),
        OP(BPF_JMP | BPF_EXIT, 0, 0, 0, 0),
    };
    union bpf_attr words = {.prog_type = BPF_PROG_TYPE_XDP, .insns = (uintptr_t)code,
                            .insn_cnt = sizeof code / sizeof code[0], .license = (uintptr_t)licence};
    x->program = bpf(BPF_PROG_LOAD, &words);
    return x->program >= 0;
}

static bool attach(xdp_t *x, unsigned interface_index)
{
    union bpf_attr words = {.link_create = {.prog_fd = (uint32_t)x->program, .target_ifindex = interface_index,
                                            .attach_type = BPF_XDP}};
    x->link = bpf(BPF_LINK_CREATE, &words);
    return x->link >= 0;
}

static bool make_map(xdp_t *x)
{
    union bpf_attr words = {.map_type = BPF_MAP_TYPE_XSKMAP, .key_size = 4, .value_size = 4, .max_entries = 1};
    x->map = bpf(BPF_MAP_CREATE, &words);
    return x->map >= 0;
}

static bool enter_in_map(xdp_t *x)
{
    const uint32_t queue = 0, fd = (uint32_t)x->socket;
    union bpf_attr words = {.map_fd = (uint32_t)x->map, .key = (uintptr_t)&queue, .value = (uintptr_t)&fd};
    return bpf(BPF_MAP_UPDATE_ELEM, &words) == 0;
}

/* ---- rings ------------------------------------------------------------------------------------------------------- */

static bool map_ring(xdp_t *x, ring_t *ring, const struct xdp_ring_offset *at, off_t what, size_t entry)
{
    ring->bytes = (size_t)at->desc + RING * entry;
    ring->memory = mmap(NULL, ring->bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, x->socket, what);
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

static bool make_rings(xdp_t *x)
{
    const int size = RING;
    struct xdp_mmap_offsets at;
    socklen_t bytes = sizeof at;
    const struct xdp_umem_reg memory = {.addr = (uintptr_t)x->chunks, .len = CHUNK * CHUNKS, .chunk_size = CHUNK};
    return setsockopt(x->socket, SOL_XDP, XDP_UMEM_REG, &memory, sizeof memory) == 0 &&
           setsockopt(x->socket, SOL_XDP, XDP_UMEM_FILL_RING, &size, sizeof size) == 0 &&
           setsockopt(x->socket, SOL_XDP, XDP_UMEM_COMPLETION_RING, &size, sizeof size) == 0 &&
           setsockopt(x->socket, SOL_XDP, XDP_RX_RING, &size, sizeof size) == 0 &&
           setsockopt(x->socket, SOL_XDP, XDP_TX_RING, &size, sizeof size) == 0 &&
           getsockopt(x->socket, SOL_XDP, XDP_MMAP_OFFSETS, &at, &bytes) == 0 &&
           map_ring(x, &x->fill, &at.fr, XDP_UMEM_PGOFF_FILL_RING, sizeof(uint64_t)) &&
           map_ring(x, &x->completion, &at.cr, (off_t)XDP_UMEM_PGOFF_COMPLETION_RING, sizeof(uint64_t)) &&
           map_ring(x, &x->in, &at.rx, XDP_PGOFF_RX_RING, sizeof(struct xdp_desc)) &&
           map_ring(x, &x->out, &at.tx, XDP_PGOFF_TX_RING, sizeof(struct xdp_desc));
}

static unsigned seen(const unsigned *word) { return __atomic_load_n(word, __ATOMIC_ACQUIRE); }
static void advance(unsigned *word) { __atomic_store_n(word, *word + 1, __ATOMIC_RELEASE); }

/* Gives the kernel a chunk for a frame that comes in. */
static void give_chunk(xdp_t *x, uint64_t address)
{
    ((uint64_t *)x->fill.entries)[*x->fill.producer % RING] = address;
    advance(x->fill.producer);
}

/* ---- the way ----------------------------------------------------------------------------------------------------- */

static void unmap(const ring_t *ring)
{
    if (ring->memory)
        munmap(ring->memory, ring->bytes);
}

static void close_xdp(void *state)
{
    xdp_t *x = state;
    const int all[] = {x->link, x->program, x->map, x->socket};
    unmap(&x->fill), unmap(&x->completion), unmap(&x->in), unmap(&x->out);
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        if (all[i] >= 0)
            close(all[i]);
    if (x->chunks)
        munmap(x->chunks, CHUNK * CHUNKS);
    free(x);
}

static bool set_up(xdp_t *x, unsigned interface_index)
{
    const struct sockaddr_xdp address = {.sxdp_family = AF_XDP, .sxdp_flags = XDP_COPY, .sxdp_ifindex = interface_index};
    void *chunks = mmap(NULL, CHUNK * CHUNKS, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_POPULATE, -1, 0);
    x->chunks = chunks != MAP_FAILED ? chunks : NULL;
    x->socket = x->chunks ? socket(AF_XDP, SOCK_RAW | SOCK_CLOEXEC, 0) : -1;
    if (x->socket < 0 || !make_rings(x))
        return false;
    for (uint64_t i = 0; i < RING; i++)
        give_chunk(x, i * CHUNK);
    return bind(x->socket, (const struct sockaddr *)&address, sizeof address) == 0 && make_map(x) && load_program(x) &&
           enter_in_map(x) && attach(x, interface_index);
}

static void *open_xdp(unsigned interface_index)
{
    xdp_t *x = calloc(1, sizeof *x);
    if (!x)
        return NULL;
    x->socket = x->map = x->program = x->link = -1;
    if (set_up(x, interface_index))
        return x;
    const int why = errno;
    close_xdp(x);
    errno = why;
    return NULL;
}

static bool send_by_xdp(void *state, const uint8_t *frame, size_t length)
{
    xdp_t *x = state;
    while (*x->completion.consumer != seen(x->completion.producer)) /* chunks that have been sent */
        advance(x->completion.consumer);
    const unsigned number = *x->out.producer;
    if (number - *x->completion.consumer >= CHUNKS - OUTGOING)
        return false;
    const uint64_t address = (OUTGOING + number % (CHUNKS - OUTGOING)) * (uint64_t)CHUNK;
    memcpy(x->chunks + address, frame, length);
    ((struct xdp_desc *)x->out.entries)[number % RING] = (struct xdp_desc){.addr = address, .len = (uint32_t)length};
    advance(x->out.producer);
    way_calls++;
    return sendto(x->socket, NULL, 0, MSG_DONTWAIT, NULL, 0) >= 0 || errno == EAGAIN || errno == EBUSY;
}

static size_t receive_by_xdp(void *state, uint8_t *frame)
{
    xdp_t *x = state;
    while (*x->in.consumer == seen(x->in.producer))
        if (!way_sleep(x->socket))
            return 0;
    const struct xdp_desc came = ((const struct xdp_desc *)x->in.entries)[*x->in.consumer % RING];
    const size_t length = came.len < WAY_FRAME_MAX ? came.len : WAY_FRAME_MAX;
    memcpy(frame, x->chunks + came.addr, length);
    advance(x->in.consumer);
    give_chunk(x, came.addr - came.addr % CHUNK);
    return length;
}

const way_t way_xdp = {"AF_XDP, copied", open_xdp, send_by_xdp, receive_by_xdp, close_xdp};
