/* AF_XDP on a veth pair of the test's own network namespace (skipped where the kernel refuses it): its rings, a burst, an
 * interface that goes down and comes up again, frames of other protocols, and what is left behind. test_nic_raw has what
 * all ways to the frames of an interface promise. */
#include <arpa/inet.h>
#include <linux/bpf.h>
#include <linux/ethtool.h>
#include <linux/if_packet.h>
#include <linux/if_xdp.h>
#include <linux/sockios.h>
#include <net/if.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <unity.h>

#include "../support/veth.h"
#include "nic/nic.h"
#include "nic/raw_socket.h"
#include "nic/xdp_socket.h"

enum { SHORTEST = 60, LONGEST = 1514, OTHER_PROTOCOL = 0x88B5, WAIT_MS = 1000 };

static bool usable;
static cm1e_diag_t diag;
static cm1e_xdp_socket_t *near_end; /* wire0 */
static cm1e_raw_socket_t far_end;   /* wire1 */
static uint8_t frame[CM1E_FRAME_MAX], got[CM1E_FRAME_MAX];

/* ---- the card ---------------------------------------------------------------------------------------------------- */

int __real_ioctl(int fd, unsigned long what, void *data);
int __wrap_ioctl(int fd, unsigned long what, void *data);

/** What the driver of a card says of its queues; below 0: it does not answer. */
typedef struct card {
    int combined, incoming, rings;
} card_t;
static const card_t one_queue = {1, 0, -1}, *card = &one_queue; /* else a wrong count would skip all tests */

int __wrap_ioctl(int fd, unsigned long what, void *data)
{
    struct ifreq *request = data;
    if (what != SIOCETHTOOL)
        return __real_ioctl(fd, what, data);
    struct ethtool_channels *channels = (void *)request->ifr_data;
    struct ethtool_rxnfc *rings = (void *)request->ifr_data;
    const bool answers = channels->cmd == ETHTOOL_GCHANNELS ? card->combined >= 0 : card->rings >= 0;
    if (channels->cmd != ETHTOOL_GCHANNELS && channels->cmd != ETHTOOL_GRXRINGS)
        return __real_ioctl(fd, what, data);
    if (answers && channels->cmd == ETHTOOL_GCHANNELS) {
        channels->combined_count = (uint32_t)card->combined;
        channels->rx_count = (uint32_t)card->incoming;
    } else if (answers)
        rings->data = (uint64_t)card->rings;
    return answers ? 0 : -1;
}

static void open_near(void)
{
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_xdp_socket_open(&near_end, "wire0", &diag), diag.text);
}

void setUp(void)
{
    if (!usable)
        TEST_IGNORE_MESSAGE("AF_XDP is refused here");
    open_near();
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_raw_socket_open(&far_end, "wire1", &diag), diag.text);
}

void tearDown(void)
{
    if (!usable)
        return;
    cm1e_xdp_socket_close(near_end);
    cm1e_raw_socket_close(&far_end);
    near_end = NULL;
}

/* ---- frames ------------------------------------------------------------------------------------------------------ */

static void fill(unsigned number, size_t length)
{
    static const uint8_t head[] = {255, 255, 255, 255, 255, 255, 1, 1, 1, 1, 1, 1, 0x88, 0xA4};
    for (size_t i = 0; i < length; i++)
        frame[i] = (uint8_t)(number * 31 + i);
    memcpy(frame, head, sizeof head);
    memcpy(frame + sizeof head, &number, sizeof number);
}

static bool waits(int fd)
{
    struct pollfd readable = {.fd = fd, .events = POLLIN};
    return poll(&readable, 1, WAIT_MS) > 0;
}

static size_t near_receives(void)
{
    size_t length = cm1e_xdp_socket_receive(near_end, got, sizeof got);
    while (length == 0 && waits(cm1e_xdp_socket_fd(near_end)))
        length = cm1e_xdp_socket_receive(near_end, got, sizeof got);
    return length;
}

static size_t far_receives(void)
{
    int length = cm1e_raw_socket_receive(far_end.fd, got, sizeof got);
    while (length == 0 && waits(far_end.fd))
        length = cm1e_raw_socket_receive(far_end.fd, got, sizeof got);
    return length > 0 ? (size_t)length : 0;
}

static void test_frames_of_all_lengths_are_whole_round_and_round_the_rings(void)
{
    for (unsigned i = 0; i < 3000; i++) {
        const size_t length = SHORTEST + i * 7 % (LONGEST - SHORTEST + 1);
        fill(i, length);
        TEST_ASSERT_TRUE(cm1e_xdp_socket_send(near_end, frame, length));
        TEST_ASSERT_EQUAL_UINT(length, far_receives());
        TEST_ASSERT_EQUAL_MEMORY(frame, got, length);
        frame[40] ^= 0xFF;
        TEST_ASSERT_EQUAL_INT(length, send(far_end.fd, frame, length, 0));
        TEST_ASSERT_EQUAL_UINT(length, near_receives());
        TEST_ASSERT_EQUAL_MEMORY(frame, got, length);
    }
}

static void test_a_short_frame_is_made_longer_by_zeros(void)
{
    fill(1, LONGEST); /* the chunk has been used */
    for (int i = 0; i < 100; i++)
        TEST_ASSERT_TRUE(cm1e_xdp_socket_send(near_end, frame, LONGEST) && far_receives() == LONGEST);
    TEST_ASSERT_TRUE(cm1e_xdp_socket_send(near_end, frame, 30));
    TEST_ASSERT_EQUAL_UINT(SHORTEST, far_receives());
    TEST_ASSERT_EQUAL_MEMORY(frame, got, 30);
    TEST_ASSERT_EACH_EQUAL_HEX8(0, got + 30, SHORTEST - 30);
}

static void test_a_frame_is_cut_off_where_the_room_ends(void)
{
    fill(2, 600);
    memset(got, 0xEE, sizeof got);
    send(far_end.fd, frame, 600, 0);
    TEST_ASSERT_TRUE(waits(cm1e_xdp_socket_fd(near_end)));
    TEST_ASSERT_EQUAL_UINT(100, cm1e_xdp_socket_receive(near_end, got, 100));
    TEST_ASSERT_EQUAL_MEMORY(frame, got, 100);
    TEST_ASSERT_EQUAL_HEX8(0xEE, got[100]);
    TEST_ASSERT_FALSE(cm1e_xdp_socket_send(near_end, frame, CM1E_FRAME_MAX + 1));
}

static void test_a_burst_keeps_its_first_frames_in_order_and_does_no_harm(void)
{
    enum { BURST = 1000, KEPT = 256 };
    for (int round = 0; round < 3; round++) {
        for (unsigned i = 0; i < BURST; i++) {
            fill(i, 100);
            send(far_end.fd, frame, 100, 0);
        }
        usleep(20000);
        for (unsigned i = 0; i < KEPT; i++) {
            fill(i, 100);
            TEST_ASSERT_EQUAL_UINT(100, near_receives());
            TEST_ASSERT_EQUAL_MEMORY(frame, got, 100);
        }
        while (cm1e_xdp_socket_receive(near_end, got, sizeof got) > 0)
            ;
    }
    test_frames_of_all_lengths_are_whole_round_and_round_the_rings();
}

static void test_many_frames_go_out_at_once(void)
{
    for (unsigned round = 0; round < 100; round++) {
        for (unsigned i = 0; i < 16; i++) { /* EC_MAXBUF */
            fill(round * 16 + i, 200);
            TEST_ASSERT_TRUE(cm1e_xdp_socket_send(near_end, frame, 200));
        }
        for (unsigned i = 0; i < 16; i++) {
            fill(round * 16 + i, 200);
            TEST_ASSERT_EQUAL_UINT(200, far_receives());
            TEST_ASSERT_EQUAL_MEMORY(frame, got, 200);
        }
    }
}

static void test_other_protocols_go_to_the_kernel(void)
{
    const int other = socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC, 0);
    const struct sockaddr_ll address = {.sll_family = AF_PACKET, .sll_protocol = htons(OTHER_PROTOCOL),
                                        .sll_ifindex = (int)if_nametoindex("wire0")};
    TEST_ASSERT_EQUAL_INT(0, bind(other, (const struct sockaddr *)&address, sizeof address));
    fill(3, 80);
    frame[13] = OTHER_PROTOCOL & 0xFF;
    send(far_end.fd, frame, 80, 0);
    TEST_ASSERT_TRUE(waits(other));
    TEST_ASSERT_EQUAL_INT(80, recv(other, got, sizeof got, 0));
    TEST_ASSERT_EQUAL_MEMORY(frame, got, 80);
    TEST_ASSERT_EQUAL_UINT(0, cm1e_xdp_socket_receive(near_end, got, sizeof got));
    close(other);
}

/* ---- the interface ----------------------------------------------------------------------------------------------- */

/* A drive that gets frames again must not get targets of the time before. */
static void test_no_old_frame_is_sent_when_the_interface_is_up_again(void)
{
    TEST_ASSERT_EQUAL_INT(0, system("ip link set wire0 down"));
    for (unsigned i = 100; i < 200; i++) {
        fill(i, 100);
        frame[15] |= 0x10; /* EtherCAT: datagrams */
        TEST_ASSERT_FALSE(cm1e_xdp_socket_send(near_end, frame, 100));
    }
    TEST_ASSERT_EQUAL_INT(0, system("ip link set wire0 up"));
    usleep(100000);
    far_receives(); /* the error of the link */
    fill(7, 100);
    TEST_ASSERT_TRUE(cm1e_xdp_socket_send(near_end, frame, 100));
    for (bool came = false; !came;) {
        TEST_ASSERT_GREATER_THAN_UINT_MESSAGE(0, far_receives(), "the new frame does not come");
        came = memcmp(frame, got, 100) == 0;
        TEST_ASSERT_TRUE_MESSAGE(came || (got[14] == 0 && got[15] == 0), "an old frame with datagrams");
    }
    test_many_frames_go_out_at_once();
}

static void test_without_a_link_nothing_is_kept_for_later(void)
{
    TEST_ASSERT_EQUAL_INT(0, system("ip link set wire1 down"));
    for (unsigned i = 100; i < 300; i++) {
        fill(i, 100);
        cm1e_xdp_socket_send(near_end, frame, 100);
    }
    TEST_ASSERT_EQUAL_INT(0, system("ip link set wire1 up"));
    usleep(100000);
    far_receives(); /* the error of the link */
    fill(8, 100);
    TEST_ASSERT_TRUE(cm1e_xdp_socket_send(near_end, frame, 100));
    TEST_ASSERT_GREATER_THAN_UINT(0, far_receives());
    if (memcmp(frame, got, 100) != 0) {
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(0, got[14] | got[15], "an old frame with datagrams");
        TEST_ASSERT_EQUAL_UINT(100, far_receives());
        TEST_ASSERT_EQUAL_MEMORY(frame, got, 100);
    }
}

static bool has_program(void) { return system("ip link show wire0 | grep -q xdp") == 0; }

static void test_a_process_that_was_forked_off_keeps_nothing(void)
{
    TEST_ASSERT_TRUE(has_program());
    const pid_t child = fork();
    if (child == 0) {
        pause();
        _exit(0);
    }
    for (unsigned i = 0; i < 600; i++) { /* our memory and that of the kernel are still one */
        fill(i, 300);
        TEST_ASSERT_TRUE(cm1e_xdp_socket_send(near_end, frame, 300));
        TEST_ASSERT_EQUAL_UINT(300, far_receives());
        TEST_ASSERT_EQUAL_MEMORY(frame, got, 300);
        send(far_end.fd, frame, 300, 0);
        TEST_ASSERT_EQUAL_UINT(300, near_receives());
        TEST_ASSERT_EQUAL_MEMORY(frame, got, 300);
    }
    cm1e_xdp_socket_close(near_end);
    near_end = NULL;
    TEST_ASSERT_FALSE(has_program());
    kill(child, SIGKILL);
    waitpid(child, NULL, 0);
    open_near();
}

static void test_it_opens_and_closes_again_and_again(void)
{
    for (int i = 0; i < 30; i++) {
        cm1e_xdp_socket_close(near_end);
        TEST_ASSERT_FALSE(has_program());
        open_near();
    }
}

static void test_an_interface_has_one_owner_whichever_way(void)
{
    cm1e_xdp_socket_t *second;
    cm1e_raw_socket_t third;
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INTERFACE_IN_USE, cm1e_xdp_socket_open(&second, "wire0", &diag));
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INTERFACE_IN_USE, cm1e_xdp_socket_open(&second, "wire1", &diag));
    TEST_ASSERT_NULL(second);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INTERFACE_IN_USE, cm1e_raw_socket_open(&third, "wire0", &diag));
    TEST_ASSERT_TRUE_MESSAGE(has_program(), "a refused one has taken the program of the first away");
}

/* A program that knows no lock. */
static int open_foreign(void *memory, size_t bytes)
{
    const struct xdp_umem_reg umem = {.addr = (uintptr_t)memory, .len = bytes, .chunk_size = 2048};
    const struct sockaddr_xdp address = {.sxdp_family = AF_XDP, .sxdp_flags = XDP_COPY,
                                         .sxdp_ifindex = if_nametoindex("wire0")};
    const int size = 8, fd = socket(AF_XDP, SOCK_RAW | SOCK_CLOEXEC, 0);
    TEST_ASSERT_EQUAL_INT(0, setsockopt(fd, SOL_XDP, XDP_UMEM_REG, &umem, sizeof umem));
    TEST_ASSERT_EQUAL_INT(0, setsockopt(fd, SOL_XDP, XDP_UMEM_FILL_RING, &size, sizeof size));
    TEST_ASSERT_EQUAL_INT(0, setsockopt(fd, SOL_XDP, XDP_UMEM_COMPLETION_RING, &size, sizeof size));
    TEST_ASSERT_EQUAL_INT(0, setsockopt(fd, SOL_XDP, XDP_RX_RING, &size, sizeof size));
    for (int i = 0; bind(fd, (const struct sockaddr *)&address, sizeof address) != 0; i++) {
        TEST_ASSERT_LESS_THAN_INT(100, i); /* the kernel takes ours away a moment later */
        usleep(10000);
    }
    return fd;
}

static void test_a_socket_of_another_program_is_told(void)
{
    enum { BYTES = 1 << 16 };
    cm1e_xdp_socket_close(near_end);
    near_end = NULL;
    void *memory = mmap(NULL, BYTES, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    const int foreign = open_foreign(memory, BYTES);
    TEST_ASSERT_EQUAL_INT(CM1E_ERROR_INTERFACE_IN_USE, cm1e_xdp_socket_open(&near_end, "wire0", &diag));
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, "Another program has an AF_XDP socket"), diag.text);
    TEST_ASSERT_FALSE(has_program());
    close(foreign);
    munmap(memory, BYTES);
    open_near();
}

/* ---- queues ------------------------------------------------------------------------------------------------------ */

/** A socket sees the frames of one queue: a card with more is refused, with their number and what to do. */
static void test_a_card_with_several_queues_is_refused(void)
{
    static const struct {
        card_t card;
        const char *says; /* NULL: it is taken */
    } rows[] = {
        {{1, 0, -1}, NULL}, {{0, 1, -1}, NULL}, {{0, 0, -1}, NULL}, {{0, 0, 1}, NULL}, {{-1, 0, 1}, NULL}, {{-1, 0, 0}, NULL},
        {{-1, 0, -1}, NULL},
        {{2, 0, -1}, "has 2 receive queues, and AF_XDP sees the frames of one. Leave one: sudo ethtool -L wire0 combined 1."},
        {{0, 4, -1}, "has 4 receive queues, and AF_XDP sees the frames of one. Leave one: sudo ethtool -L wire0 rx 1."},
        {{1, 2, 1}, "has 3 receive queues"}, {{0, 0, 5}, "has 5 receive queues"}, {{-1, 0, 2}, "has 2 receive queues"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        cm1e_xdp_socket_close(near_end);
        near_end = NULL;
        card = &rows[i].card;
        const cm1e_error_t error = cm1e_xdp_socket_open(&near_end, "wire0", &diag);
        card = &one_queue;
        TEST_ASSERT_EQUAL_INT_MESSAGE(rows[i].says ? CM1E_ERROR_UNSUPPORTED : CM1E_OK, error, diag.text);
        TEST_ASSERT_TRUE_MESSAGE(!rows[i].says || strstr(diag.text, rows[i].says), diag.text);
    }
    open_near();
}

/** The kernel takes a program at the pair, and has such sockets: then it is ours that is wrong if it refuses that. */
static bool kernel_would_do_it(void)
{
    static const struct bpf_insn code[] = {{.code = BPF_ALU64 | BPF_MOV | BPF_K, .imm = XDP_PASS},
                                           {.code = BPF_JMP | BPF_EXIT}};
    union bpf_attr program = {.prog_type = BPF_PROG_TYPE_XDP, .insns = (uintptr_t)code, .insn_cnt = 2,
                              .license = (uintptr_t)"MIT"}, link = {0};
    const int loaded = (int)syscall(__NR_bpf, BPF_PROG_LOAD, &program, sizeof program);
    const int s = socket(AF_XDP, SOCK_RAW | SOCK_CLOEXEC, 0);
    link.link_create.prog_fd = (uint32_t)loaded;
    link.link_create.target_ifindex = if_nametoindex("wire0");
    link.link_create.attach_type = BPF_XDP;
    const int attached = loaded < 0 ? -1 : (int)syscall(__NR_bpf, BPF_LINK_CREATE, &link, sizeof link);
    const int fds[] = {loaded, s, attached};
    bool all = true;
    for (int i = 0; i < 3; i++) {
        all &= fds[i] >= 0;
        if (fds[i] >= 0)
            close(fds[i]);
    }
    return all;
}

int main(void)
{
    if (veth_make()) {
        usable = cm1e_xdp_socket_open(&near_end, "wire0", &diag) == CM1E_OK;
        cm1e_xdp_socket_close(near_end);
        if (!usable && kernel_would_do_it()) {
            printf("AF_XDP would work here: %s\n", diag.text);
            return EXIT_FAILURE;
        }
    }
    if (!usable)
        printf("SKIPPED: AF_XDP: %s\n", diag.text[0] ? diag.text : "no network namespace can be made here");
    UNITY_BEGIN();
    RUN_TEST(test_frames_of_all_lengths_are_whole_round_and_round_the_rings);
    RUN_TEST(test_a_short_frame_is_made_longer_by_zeros);
    RUN_TEST(test_a_frame_is_cut_off_where_the_room_ends);
    RUN_TEST(test_a_burst_keeps_its_first_frames_in_order_and_does_no_harm);
    RUN_TEST(test_many_frames_go_out_at_once);
    RUN_TEST(test_other_protocols_go_to_the_kernel);
    RUN_TEST(test_no_old_frame_is_sent_when_the_interface_is_up_again);
    RUN_TEST(test_without_a_link_nothing_is_kept_for_later);
    RUN_TEST(test_a_process_that_was_forked_off_keeps_nothing);
    RUN_TEST(test_it_opens_and_closes_again_and_again);
    RUN_TEST(test_an_interface_has_one_owner_whichever_way);
    RUN_TEST(test_a_socket_of_another_program_is_told);
    RUN_TEST(test_a_card_with_several_queues_is_refused);
    return UNITY_END();
}
