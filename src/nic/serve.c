/* A simulated segment on a network interface: frames in, answers out, a console beside it. */
#include <errno.h>
#include <limits.h>
#include <poll.h>
#include <sched.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "nic/frame.h"
#include "nic/frame_queue.h"
#include "nic/nic.h"
#include "nic/raw_socket.h"

enum {
    NS_PER_S = 1000000000, TICK_NS = 1000000, PRIORITY = 60, FRAMES_AT_ONCE = 64, LINE_LENGTH = 256,
    ANSWER_LENGTH = 1 << 15,            /* the status of 128 slaves */
};

typedef struct server {
    cm1e_sim_segment_t *segment;
    cm1e_clock_t *clock;
    int socket_fd, console_fd, answer_fd;
    frame_queue_t delayed;              /**< answers that the console delays */
    uint8_t frame[CM1E_FRAME_MAX];
    char line[LINE_LENGTH], answer[ANSWER_LENGTH];
    size_t line_length;
    bool line_too_long;
} server_t;

/* ---- console ----------------------------------------------------------------------------------------------------- */

/** Writes the answer as far as the reader takes it: a reader that stopped reading, or left, must not stop the segment.
 *  A pipe that is ready takes PIPE_BUF bytes without blocking. */
static void put_answer(server_t *server, const char *answer)
{
    const size_t length = strnlen(answer, ANSWER_LENGTH - 1);
    memmove(server->answer, answer, length);
    server->answer[length] = '\n';
    for (size_t done = 0; done < length + 1;) {
        struct pollfd out = {.fd = server->answer_fd, .events = POLLOUT};
        if (server->answer_fd < 0 || poll(&out, 1, 0) != 1 || out.revents != POLLOUT)
            return;
        const size_t rest = length + 1 - done;
        const ssize_t n = write(server->answer_fd, server->answer + done, rest < PIPE_BUF ? rest : PIPE_BUF);
        if (n <= 0)
            return;
        done += (size_t)n;
    }
}

static void run_line(server_t *server)
{
    server->line[server->line_length] = 0;
    if (server->line_too_long)
        put_answer(server, "error: the line is too long");
    else if (server->line_length > 0) {
        server->answer[0] = 0;
        cm1e_sim_console(server->segment, server->line, server->answer, sizeof server->answer);
        put_answer(server, server->answer);
    }
    server->line_length = 0;
    server->line_too_long = false;
}

/** Reads what is there; false: end of the console. */
static bool read_console(server_t *server)
{
    char bytes[LINE_LENGTH];
    const ssize_t n = read(server->console_fd, bytes, sizeof bytes);
    if (n < 0)
        return errno == EAGAIN || errno == EINTR;
    for (ssize_t i = 0; i < n; i++) {
        if (bytes[i] == '\n')
            run_line(server);
        else if (bytes[i] == '\r' || bytes[i] == 0)
            continue;
        else if (server->line_length + 1 < sizeof server->line)
            server->line[server->line_length++] = bytes[i];
        else
            server->line_too_long = true;
    }
    if (n == 0 && server->line_length > 0)
        run_line(server);
    return n > 0;
}

/* ---- frames ------------------------------------------------------------------------------------------------------ */

static void reply(const server_t *server, const uint8_t *frame, size_t length)
{
    /* A full transmit queue loses the answer, as a wire would. */
    const ssize_t sent = send(server->socket_fd, frame, length, MSG_DONTWAIT | MSG_NOSIGNAL);
    (void)sent;
}

static void answer_frame(server_t *server, size_t length, int64_t now_ns)
{
    if (length < ETHERNET_HEADER)
        return;
    const int out = cm1e_sim_segment_process(server->segment, CM1E_SIM_PORT_PRIMARY, server->frame, length, now_ns);
    if (out != CM1E_SIM_PORT_PRIMARY)
        return;
    int64_t delay_ns = 0;
    queued_frame_t *place;
    switch (cm1e_sim_segment_next_frame_fault(server->segment, &delay_ns)) {
    case CM1E_FRAME_OK:
        break;
    case CM1E_FRAME_LOSE:
        return;
    case CM1E_FRAME_CORRUPT:
        frame_corrupt(server->frame, length);
        break;
    case CM1E_FRAME_DELAY:
        place = frame_queue_place(&server->delayed);
        if (place) {
            memcpy(place->bytes, server->frame, length);
            place->length = length;
            frame_queue_insert(&server->delayed, place, now_ns + delay_ns);
        }
        return;
    }
    reply(server, server->frame, length);
}

static void answer_frames(server_t *server)
{
    for (int i = 0; i < FRAMES_AT_ONCE; i++) {
        const int n = raw_socket_receive(server->socket_fd, server->frame, sizeof server->frame);
        if (n <= 0)
            return;
        answer_frame(server, (size_t)n, cm1e_clock_now(server->clock));
    }
}

static void release_delayed(server_t *server, int64_t now_ns)
{
    for (queued_frame_t *f; (f = frame_queue_first(&server->delayed)) && f->ready_ns <= now_ns;) {
        reply(server, f->bytes, f->length);
        frame_queue_remove_first(&server->delayed);
    }
}

static void run(server_t *server, const volatile int *stop)
{
    struct pollfd fds[2] = {{.fd = server->socket_fd, .events = POLLIN}, {.fd = server->console_fd, .events = POLLIN}};
    int64_t tick_ns = cm1e_clock_now(server->clock);
    while (!*stop) {
        const queued_frame_t *next = frame_queue_first(&server->delayed);
        const int64_t until = next && next->ready_ns < tick_ns ? next->ready_ns : tick_ns;
        int64_t left_ns = until - cm1e_clock_now(server->clock);
        if (left_ns < 0)
            left_ns = 0;
        const struct timespec left = {.tv_sec = left_ns / NS_PER_S, .tv_nsec = left_ns % NS_PER_S};
        const int ready = ppoll(fds, 2, &left, NULL);
        if (ready > 0 && fds[0].revents)
            answer_frames(server);
        const int64_t now_ns = cm1e_clock_now(server->clock);
        release_delayed(server, now_ns);
        if (now_ns >= tick_ns) {
            cm1e_sim_segment_advance(server->segment, now_ns);
            tick_ns = now_ns + TICK_NS;
            /* An interface that is gone reports errors without end. */
            if (ready > 0 && (fds[0].revents & (POLLERR | POLLHUP | POLLNVAL)) && !(fds[0].revents & POLLIN))
                cm1e_clock_sleep_until(server->clock, tick_ns);
        }
        if (ready > 0 && fds[1].revents && !read_console(server))
            fds[1].fd = -1;
    }
}

/* ---- low latency, where the system allows it --------------------------------------------------------------------- */

typedef struct scheduling {
    int policy;
    struct sched_param parameters;
    bool locked;
} scheduling_t;

static scheduling_t ask_for_realtime(void)
{
    scheduling_t before = {.policy = sched_getscheduler(0)};
    sched_getparam(0, &before.parameters);
    const struct sched_param realtime = {.sched_priority = PRIORITY};
    sched_setscheduler(0, SCHED_FIFO | SCHED_RESET_ON_FORK, &realtime);
    /* Only pages that are used: locking whatever is mapped costs gigabytes under a sanitizer. */
    before.locked = mlockall(MCL_CURRENT | MCL_ONFAULT) == 0;
    prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
    return before;
}

static void restore(const scheduling_t *before)
{
    if (before->locked)
        munlockall();
    sched_setscheduler(0, before->policy, &before->parameters);
}

cm1e_error_t cm1e_nic_serve(cm1e_sim_segment_t *segment, const char *interface_name, int console_fd, int answer_fd,
                            const volatile int *stop, cm1e_diag_t *diag)
{
    server_t *server = calloc(1, sizeof *server);
    if (!server)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the simulated segment's server.");
    server->segment = segment;
    server->clock = cm1e_clock_monotonic();
    server->console_fd = console_fd;
    server->answer_fd = answer_fd;
    const cm1e_error_t error = raw_socket_open(&server->socket_fd, interface_name, diag);
    if (!error) {
        const scheduling_t before = ask_for_realtime();
        run(server, stop);
        restore(&before);
        close(server->socket_fd);
    }
    free(server);
    return error;
}
