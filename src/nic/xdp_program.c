#include "nic/xdp_program.h"

#include <arpa/inet.h>
#include <errno.h>
#include <linux/bpf.h>
#include <stdbool.h>
#include <stdint.h>
#include <sys/syscall.h>
#include <unistd.h>

enum { ETHERTYPE_ETHERCAT = 0x88A4 };

static int bpf(enum bpf_cmd command, union bpf_attr *words)
{
    return (int)syscall(SYS_bpf, command, words, sizeof *words);
}

#define OP(c, d, s, o, i) ((struct bpf_insn){.code = (c), .dst_reg = (d), .src_reg = (s), .off = (o), .imm = (i)})

/* Registers: 1 the context, 2 the frame, 3 its end. A queue without a socket gives its frames to the kernel. */
static int load_program(int map)
{
    static const char licence[] = "MIT";
    const struct bpf_insn code[] = {
        OP(BPF_LDX | BPF_MEM | BPF_W, 2, 1, 0, 0),                 /* data */
        OP(BPF_LDX | BPF_MEM | BPF_W, 3, 1, 4, 0),                 /* data_end */
        OP(BPF_ALU64 | BPF_MOV | BPF_X, 4, 2, 0, 0),
        OP(BPF_ALU64 | BPF_ADD | BPF_K, 4, 0, 0, 14),
        OP(BPF_JMP | BPF_JGT | BPF_X, 4, 3, 7, 0),                 /* no whole header: to the kernel */
        OP(BPF_LDX | BPF_MEM | BPF_H, 5, 2, 12, 0),
        OP(BPF_JMP | BPF_JNE | BPF_K, 5, 0, 5, htons(ETHERTYPE_ETHERCAT)),
        OP(BPF_LDX | BPF_MEM | BPF_W, 2, 1, 16, 0),                /* rx_queue_index */
        OP(BPF_LD | BPF_DW | BPF_IMM, 1, BPF_PSEUDO_MAP_FD, 0, map), OP(0, 0, 0, 0, 0),
        OP(BPF_ALU64 | BPF_MOV | BPF_K, 3, 0, 0, XDP_PASS),
        OP(BPF_JMP | BPF_JA, 0, 0, 2, 0),
        OP(BPF_ALU64 | BPF_MOV | BPF_K, 0, 0, 0, XDP_PASS),
        OP(BPF_JMP | BPF_EXIT, 0, 0, 0, 0),
        OP(BPF_JMP | BPF_CALL, 0, 0, 0, BPF_FUNC_redirect_map),
        OP(BPF_JMP | BPF_EXIT, 0, 0, 0, 0),
    };
    union bpf_attr words = {.prog_type = BPF_PROG_TYPE_XDP, .insns = (uintptr_t)code,
                            .insn_cnt = sizeof code / sizeof code[0], .license = (uintptr_t)licence,
                            .prog_name = "cm1e_ethercat"}; /* as `ip link` and `bpftool` show it */
    return bpf(BPF_PROG_LOAD, &words);
}

static bool make(cm1e_xdp_program_t *made, int socket)
{
    union bpf_attr map = {.map_type = BPF_MAP_TYPE_XSKMAP, .key_size = 4, .value_size = 4, .max_entries = 1,
                          .map_name = "cm1e_sockets"};
    made->map = bpf(BPF_MAP_CREATE, &map);
    if (made->map < 0)
        return false;
    const uint32_t queue = 0, fd = (uint32_t)socket;
    union bpf_attr entry = {.map_fd = (uint32_t)made->map, .key = (uintptr_t)&queue, .value = (uintptr_t)&fd};
    if (bpf(BPF_MAP_UPDATE_ELEM, &entry) != 0)
        return false;
    made->program = load_program(made->map);
    return made->program >= 0;
}

int cm1e_xdp_program_attach(cm1e_xdp_program_t *made, int socket, unsigned interface_index, cm1e_xdp_step_t *step)
{
    *made = CM1E_XDP_NO_PROGRAM;
    *step = CM1E_XDP_MAKE;
    if (!make(made, socket))
        return errno;
    *step = CM1E_XDP_ATTACH;
    union bpf_attr link = {.link_create = {.prog_fd = (uint32_t)made->program, .target_ifindex = interface_index,
                                           .attach_type = BPF_XDP}};
    made->link = bpf(BPF_LINK_CREATE, &link);
    return made->link >= 0 ? 0 : errno;
}

void cm1e_xdp_program_close(cm1e_xdp_program_t *closed)
{
    union bpf_attr link = {.link_detach = {.link_fd = (uint32_t)closed->link}};
    if (closed->link >= 0)
        bpf(BPF_LINK_DETACH, &link); /* at once, also if a process that was forked off has the descriptor too */
    const int all[] = {closed->link, closed->program, closed->map};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        if (all[i] >= 0)
            close(all[i]);
    *closed = CM1E_XDP_NO_PROGRAM;
}
