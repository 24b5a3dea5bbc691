/* A simulated segment on a network interface, or a ring on two: frames in, answers out, a console beside it. */
#include <errno.h>
#include <limits.h>
#include <poll.h>
#include <sched.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "cm1e/sim.h"
#include "config/interface.h"
#include "core/clock.h"
#include "nic/frame.h"
#include "nic/frame_queue.h"
#include "nic/nic.h"
#include "nic/raw_socket.h"

enum {
    PRIORITY = 60, FRAMES_AT_ONCE = 64, LINE_LENGTH = 256,
    TICK_NS = 1000000,                  /* while a motor moves */
    SLEEP_NS = 50000000,                /* while all is at rest: to look whether it is to stop, and to count time up */
    RETRY_NS = 200000000,               /* to look for an interface that is away */
    LINKS_NS = 1000000,                 /* to look whether the ends of a ring have a link */
    ANSWER_LENGTH = 1 << 17,            /* the status of 512 slaves */
};
enum { SOURCE_MAC = 6, LOCALLY_ADMINISTERED = 0x02 };
enum { CONSOLE = CM1E_NIC_PORTS, WAITED }; /* what is waited for: the ends, the console */

/** The interface at an end of the segment. */
typedef struct end {
    char interface_name[64];
    cm1e_raw_socket_t socket;
    int64_t retry_ns;                   /**< without a socket: when the interface is looked for again */
    cm1e_error_t told;                  /**< why there is none, as last said */
    bool away;                          /**< of a ring: it has no link, so the cable there is cut */
} end_t;

struct cm1e_sim_server {
    cm1e_sim_segment_t *segment;
    cm1e_clock_t *clock;
    end_t ends[CM1E_NIC_PORTS];
    int end_count;                      /**< 2: a ring */
    cm1e_sim_streams_t console;
    int64_t advanced_ns;                /**< the segment's time */
    int64_t links_due_ns;               /**< of a ring: when the links are looked at again */
    bool circulation_told;
    frame_queue_t delayed;              /**< answers that the console delays */
    uint8_t frame[CM1E_FRAME_MAX];
    char line[LINE_LENGTH], answer[ANSWER_LENGTH];
    size_t line_length;
    bool line_too_long;
};
typedef cm1e_sim_server_t server_t;

/* ---- low latency, where the system allows it --------------------------------------------------------------------- */

typedef struct scheduling {
    int policy;
    struct sched_param parameters;
    int slack_ns;
    bool locked;
} scheduling_t;

static scheduling_t ask_for_realtime(void)
{
    scheduling_t before = {.policy = sched_getscheduler(0), .slack_ns = prctl(PR_GET_TIMERSLACK)};
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
    if (before->slack_ns > 0)
        prctl(PR_SET_TIMERSLACK, (unsigned long)before->slack_ns, 0UL, 0UL, 0UL);
}

/* ---- console ----------------------------------------------------------------------------------------------------- */

/** Writes the answer as far as the reader takes it: a reader that stopped reading, or left, must not stop the segment.
 *  A pipe that is ready takes PIPE_BUF bytes without blocking. */
static void put_line(server_t *server, int fd, const char *text)
{
    const size_t length = strnlen(text, ANSWER_LENGTH - 1);
    memmove(server->answer, text, length);
    server->answer[length] = '\n';
    for (size_t done = 0; done < length + 1;) {
        struct pollfd out = {.fd = fd, .events = POLLOUT};
        if (fd < 0 || poll(&out, 1, 0) != 1 || out.revents != POLLOUT)
            return;
        const size_t rest = length + 1 - done;
        const ssize_t n = write(fd, server->answer + done, rest < PIPE_BUF ? rest : PIPE_BUF);
        if (n <= 0)
            return;
        done += (size_t)n;
    }
}

__attribute__((format(printf, 2, 3))) static void notice(server_t *server, const char *format, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    put_line(server, server->console.notices, text);
}

static void run_line(server_t *server)
{
    server->line[server->line_length] = 0;
    if (server->line_too_long)
        put_line(server, server->console.answers, "error: the line is too long");
    else if (server->line_length > 0) {
        server->answer[0] = 0;
        cm1e_sim_console(server->segment, server->line, server->answer, sizeof server->answer);
        put_line(server, server->console.answers, server->answer);
    }
    server->line_length = 0;
    server->line_too_long = false;
}

/** Reads what is there; false: end of the console. */
static bool read_console(server_t *server)
{
    char bytes[LINE_LENGTH];
    const ssize_t n = read(server->console.lines, bytes, sizeof bytes);
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

static void reply(const server_t *server, int end, const uint8_t *frame, size_t length)
{
    /* A full transmit queue loses the answer, as a wire would. */
    const ssize_t sent = send(server->ends[end].socket.fd, frame, length, MSG_DONTWAIT | MSG_NOSIGNAL);
    (void)sent;
}

/* The reason is reported by cm1e_sim_server_run(). */
static bool goes_round(server_t *server, const end_t *end, size_t length)
{
    if (!(server->frame[SOURCE_MAC] & LOCALLY_ADMINISTERED) || !cm1e_frame_has_circulated(server->frame, length))
        return false;
    if (!server->circulation_told)
        notice(server, "A frame came back to \"%s\" from another simulated segment and was destroyed: two segments "
               "face each other. At the other end there has to be a master.", end->interface_name);
    server->circulation_told = true;
    return true;
}

static void answer_frame(server_t *server, int end, size_t length, int64_t now_ns)
{
    if (length < ETHERNET_HEADER || goes_round(server, &server->ends[end], length))
        return;
    const bool again = server->frame[SOURCE_MAC] & LOCALLY_ADMINISTERED;
    const bool counted = cm1e_frame_is_counted(server->frame, length);
    server->advanced_ns = now_ns;
    const int out = cm1e_sim_segment_process(server->segment, end, server->frame, length, now_ns);
    if (out < 0 || out >= server->end_count)
        return;
    if (again && (counted || !cm1e_frame_is_counted(server->frame, length)))
        cm1e_frame_mark_circulated(server->frame, length);
    int64_t delay_ns = 0;
    queued_frame_t *place;
    switch (cm1e_sim_segment_next_frame_fault(server->segment, &delay_ns)) {
    case CM1E_FRAME_OK:
        break;
    case CM1E_FRAME_LOSE:
        return;
    case CM1E_FRAME_CORRUPT:
        cm1e_frame_corrupt(server->frame, length);
        break;
    case CM1E_FRAME_DELAY:
        place = cm1e_frame_queue_place(&server->delayed);
        if (place) {
            memcpy(place->bytes, server->frame, length);
            place->length = length;
            place->port = out;
            cm1e_frame_queue_insert(&server->delayed, place, now_ns + delay_ns);
        }
        return;
    }
    reply(server, out, server->frame, length);
}

/* false: the socket is of no use any more. */
static bool answer_frames(server_t *server, int end)
{
    for (int i = 0; i < FRAMES_AT_ONCE; i++) {
        const int n = cm1e_raw_socket_receive(server->ends[end].socket.fd, server->frame, sizeof server->frame);
        if (n <= 0)
            return n == 0;
        answer_frame(server, end, (size_t)n, cm1e_clock_now(server->clock));
    }
    return true;
}

static void release_delayed(server_t *server, int64_t now_ns)
{
    for (queued_frame_t *f; (f = frame_queue_first(&server->delayed)) && f->ready_ns <= now_ns;) {
        reply(server, f->port, f->bytes, f->length);
        cm1e_frame_queue_remove_first(&server->delayed);
    }
}

/* ---- the interface ----------------------------------------------------------------------------------------------- */

/* A socket is bound to the interface that was there. One that went down, or was made anew, needs another socket. */
static void lose_interface(end_t *end)
{
    cm1e_raw_socket_close(&end->socket);
    end->retry_ns = 0;
    end->told = CM1E_OK;
}

static void find_interface(server_t *server, end_t *end, int64_t now_ns)
{
    cm1e_diag_t why = {0};
    if (end->socket.fd >= 0 || now_ns < end->retry_ns)
        return;
    const cm1e_error_t error = cm1e_raw_socket_open(&end->socket, end->interface_name, &why);
    if (error != CM1E_OK && error != end->told)
        notice(server, "The simulated segment waits for its network interface. %s", why.text);
    if (error == CM1E_OK && end->told != CM1E_OK)
        notice(server, "Network interface \"%s\" is there again.", end->interface_name);
    end->told = error;
    end->retry_ns = now_ns + RETRY_NS;
}

/* In a ring the slave behind an end without a link closes its port there, so that frames of the other end turn around
 * at it. A line has nobody else who would send frames. */
static void look_at_links(server_t *server, int64_t now_ns)
{
    if (server->end_count < 2 || now_ns < server->links_due_ns)
        return;
    server->links_due_ns = now_ns + LINKS_NS;
    for (int i = 0; i < server->end_count; i++) {
        end_t *end = &server->ends[i];
        const bool away = end->socket.fd < 0 || cm1e_nic_lacks_link(end->interface_name);
        if (away != end->away)
            cm1e_sim_segment_cut(server->segment, i == 0 ? 1 : cm1e_sim_segment_slave_count(server->segment) + 1, away);
        end->away = away;
    }
}

/* ---- time -------------------------------------------------------------------------------------------------------- */

static int64_t earlier(int64_t a, int64_t b) { return a < b ? a : b; }

/* Sleeps until a frame or a line arrives, or as long as the segment needs no step. */
static int wait(server_t *server, struct pollfd fds[WAITED])
{
    const queued_frame_t *delayed = frame_queue_first(&server->delayed);
    const int64_t tick_ns = server->advanced_ns + TICK_NS, due_ns = cm1e_sim_segment_due(server->segment);
    int64_t until_ns = earlier(due_ns > tick_ns ? due_ns : tick_ns, server->advanced_ns + SLEEP_NS);
    if (delayed)
        until_ns = earlier(until_ns, delayed->ready_ns);
    int64_t left_ns = until_ns - cm1e_clock_now(server->clock);
    if (left_ns < 0)
        left_ns = 0;
    const struct timespec left = {.tv_sec = left_ns / S_IN_NS, .tv_nsec = left_ns % S_IN_NS};
    for (int i = 0; i < server->end_count; i++)
        fds[i].fd = server->ends[i].socket.fd;
    return ppoll(fds, WAITED, &left, NULL);
}

static void tell_news(server_t *server)
{
    char text[400];
    while (cm1e_sim_segment_news(server->segment, text, sizeof text))
        notice(server, "%s", text);
}

/* What came on the interfaces, and whether they are there. */
static void serve_ends(server_t *server, const struct pollfd fds[WAITED], int64_t now_ns)
{
    for (int i = 0; i < server->end_count; i++) {
        /* A socket in error would be reported without end. */
        if (fds[i].revents && (!answer_frames(server, i) || !(fds[i].revents & POLLIN)))
            lose_interface(&server->ends[i]);
        find_interface(server, &server->ends[i], now_ns);
    }
    look_at_links(server, now_ns);
}

void cm1e_sim_server_run(cm1e_sim_server_t *server, const cm1e_sim_streams_t *console, const volatile int *stop)
{
    static const cm1e_sim_streams_t nowhere = {-1, -1, -1};
    if (!server || !stop)
        return;
    if (!console)
        console = &nowhere;
    struct pollfd fds[WAITED] = {{.fd = -1, .events = POLLIN}, {.fd = -1, .events = POLLIN},
                                 [CONSOLE] = {.fd = console->lines, .events = POLLIN}};
    const scheduling_t before = ask_for_realtime();
    server->console = *console;
    server->advanced_ns = cm1e_clock_now(server->clock);
    while (!*stop) {
        const int ready = wait(server, fds);
        for (int i = 0; i < WAITED && ready <= 0; i++)
            fds[i].revents = 0;
        const int64_t now_ns = cm1e_clock_now(server->clock);
        serve_ends(server, fds, now_ns);
        release_delayed(server, now_ns);
        const bool line = fds[CONSOLE].revents != 0;
        if (ready == 0 || line || now_ns >= server->advanced_ns + TICK_NS) {
            cm1e_sim_segment_advance(server->segment, now_ns);
            server->advanced_ns = now_ns;
        }
        if (line && !read_console(server))
            fds[CONSOLE].fd = -1;
        tell_news(server);
    }
    restore(&before);
}

/* ---- life -------------------------------------------------------------------------------------------------------- */

void cm1e_sim_server_close(cm1e_sim_server_t *server)
{
    for (int i = 0; server && i < server->end_count; i++)
        cm1e_raw_socket_close(&server->ends[i].socket);
    free(server);
}

static cm1e_error_t check_way(const char *name, cm1e_diag_t *diag)
{
    char wrong[300];
    const cm1e_interface_way_t way = cm1e_interface_way(name, wrong, sizeof wrong);
    if (way == CM1E_WAY_UNKNOWN)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "Interface \"%s\" %s.", name, wrong);
    if (way != CM1E_WAY_PACKET)
        return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "Interface \"%s\": a simulated segment answers through a "
                             "packet socket only. Name the interface without a comma: \"%.*s\".", name,
                             (int)cm1e_interface_length(name), name);
    return CM1E_OK;
}

static cm1e_error_t open_ends(cm1e_sim_server_t *server, const char *const names[], int count, cm1e_diag_t *diag)
{
    if (count > 1 && cm1e_interface_is_same(names[0], names[1]))
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0,
                             "Both interfaces of the ring are \"%s\": a ring needs two network interfaces.", names[0]);
    for (int i = 0; i < count; i++) {
        end_t *end = &server->ends[i];
        cm1e_error_t error = check_way(names[i], diag);
        cm1e_interface_own_name(end->interface_name, sizeof end->interface_name, names[i]);
        if (error == CM1E_OK)
            error = cm1e_raw_socket_open(&end->socket, end->interface_name, diag);
        if (error != CM1E_OK)
            return error;
        server->end_count++;
    }
    return CM1E_OK;
}

static cm1e_error_t open_server(cm1e_sim_server_t **server, cm1e_sim_segment_t *segment, const char *const names[],
                                int count, cm1e_diag_t *diag)
{
    if (!server || !segment || !names[0] || !names[count - 1])
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "A simulated segment on a network interface needs a "
                             "place for its server, a segment and the name of each interface.");
    cm1e_sim_server_t *made = calloc(1, sizeof *made);
    *server = NULL;
    if (!made)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the simulated segment's server.");
    made->segment = segment;
    made->clock = cm1e_clock_monotonic();
    const cm1e_error_t error = open_ends(made, names, count, diag);
    if (error != CM1E_OK)
        cm1e_sim_server_close(made);
    else
        *server = made;
    return error;
}

cm1e_error_t cm1e_sim_server_open(cm1e_sim_server_t **server, cm1e_sim_segment_t *segment, const char *interface_name,
                                  cm1e_diag_t *diag)
{
    return open_server(server, segment, &interface_name, 1, diag);
}

cm1e_error_t cm1e_sim_server_open_ring(cm1e_sim_server_t **server, cm1e_sim_segment_t *segment, const char *first,
                                       const char *second, cm1e_diag_t *diag)
{
    const char *const names[] = {first, second};
    const cm1e_error_t error = open_server(server, segment, names, 2, diag);
    if (error == CM1E_OK)
        cm1e_sim_segment_close_ring(segment);
    return error;
}
