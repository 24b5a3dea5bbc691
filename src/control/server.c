#include "control/server.h"

#include <errno.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "cm1e/control.h"
#include "control/message.h"
#include "control/request.h"
#include "control/runtime_dir.h"
#include "core/program.h"

enum {
    CLIENTS = CM1E_CONTROL_CLIENTS, IN_ROOM = CM1E_MESSAGE_HEADER + CM1E_REQUEST_MAX,
    FIRST_CLIENT = 2, /* of the polled descriptors */
    STACK_BYTES = 512 * 1024, BUSY_MS = 1, IDLE_MS = 500, REQUESTS_AT_ONCE = 8,
    QUEUE = 64, ACCEPT_FLAGS = SOCK_CLOEXEC | SOCK_NONBLOCK,
};
/** For a message that has begun, and for one that is not read. */
#define CLIENT_PATIENCE_NS INT64_C(5000000000)
#define FAREWELL_NS INT64_C(500000000)

typedef struct client {
    uint32_t place;            /**< among them all, 0 = first */
    int pid;                   /**< of the process that connected */
    int fd;                    /**< -1: gone; the request may still have to end */
    bool used, closing;        /**< closing: when all is sent */
    uint8_t *in, *out;
    size_t in_used, out_length, out_sent;
    int64_t moved_ns;          /**< when bytes came or went last */
    control_request_t request;
} client_t;

struct cm1e_control_server {
    control_run_t run;
    char path[CM1E_SOCKET_PATH];
    int listener, wake;
    bool full;                 /**< the process had no descriptor for one that wanted to connect */
    pthread_t thread;
    atomic_bool stop;
    client_t clients[CLIENTS];
};
typedef cm1e_control_server_t server_t;

static int64_t now_ns(void) { return cm1e_clock_now(cm1e_clock_monotonic()); }

/* ---- one client ------------------------------------------------------------------------------------------------- */

static void hang_up(client_t *client)
{
    if (client->fd >= 0)
        close(client->fd);
    client->fd = -1;
}

/** Frees the place, once nothing of it is on its way through the cycle. */
static void leave(server_t *server, client_t *client)
{
    hang_up(client);
    if (!cm1e_request_leave(&client->request, &server->run, client->place, atomic_load(&server->stop)))
        return;
    free(client->in);
    free(client->out);
    *client = (client_t){.fd = -1};
}

static void flush_out(client_t *client)
{
    while (client->fd >= 0 && client->out) {
        const ssize_t n = send(client->fd, client->out + client->out_sent, client->out_length - client->out_sent,
                               MSG_DONTWAIT | MSG_NOSIGNAL);
        if (n < 0 && (errno == EAGAIN || errno == EINTR))
            return;
        if (n < 0)
            hang_up(client);
        client->out_sent += n > 0 ? (size_t)n : 0;
        client->moved_ns = now_ns();
        if (client->out_sent < client->out_length)
            continue;
        free(client->out);
        client->out = NULL;
    }
    if (client->closing && !client->out)
        hang_up(client);
}

static void answer(client_t *client, json_t *reply)
{
    client->request.state = REQUEST_NONE;
    cm1e_request_clear(&client->request);
    client->out = cm1e_message_write(reply, &client->out_length);
    client->out_sent = 0;
    client->closing |= !client->out;
    flush_out(client);
}

/** Begins the first request that has come whole; false: there is none. */
static bool take_request(server_t *server, client_t *client)
{
    char why[JSON_ERROR_TEXT_LENGTH], text[256];
    json_t *message;
    size_t used = 0;
    const cm1e_message_state_t state =
        cm1e_message_read(client->in, client->in_used, CM1E_REQUEST_MAX, &message, &used, why);
    if (state == CM1E_MESSAGE_PART)
        return false;
    if (state == CM1E_MESSAGE_TOO_LONG) {
        client->closing = true;
        snprintf(text, sizeof text, "The message is longer than %d bytes; its length comes first, most significant "
                 "byte first.", CM1E_REQUEST_MAX);
        answer(client, cm1e_request_refuse(NULL, CM1E_ERROR_INVALID_ARGUMENT, 0, text));
        return false;
    }
    memmove(client->in, client->in + used, client->in_used - used);
    client->in_used -= used;
    if (state == CM1E_MESSAGE_NOT_JSON) {
        snprintf(text, sizeof text, "The message is not a JSON object: %s.", why);
        answer(client, cm1e_request_refuse(NULL, CM1E_ERROR_INVALID_ARGUMENT, 0, text));
        return true;
    }
    client->request.client = client->place;
    client->request.pid = client->pid;
    json_t *reply = cm1e_request_begin(&client->request, &server->run, message, now_ns());
    json_decref(message);
    if (reply)
        answer(client, reply);
    return true;
}

static bool is_waiting(const client_t *client) { return client->request.state != REQUEST_NONE; }

/** One request at a time, and none while the last reply is not read. */
static bool may_read(const client_t *client)
{
    return client->fd >= 0 && !client->out && !client->closing && !is_waiting(client);
}

static void read_in(client_t *client)
{
    const ssize_t n = recv(client->fd, client->in + client->in_used, IN_ROOM - client->in_used, MSG_DONTWAIT);
    if (n > 0) {
        client->in_used += (size_t)n;
        client->moved_ns = now_ns();
    } else if (n == 0 || (errno != EAGAIN && errno != EINTR)) {
        hang_up(client);
    }
}

static void serve_client(server_t *server, client_t *client, short events)
{
    if (client->fd >= 0 && (events & (POLLOUT | POLLHUP | POLLERR)))
        flush_out(client);
    if (may_read(client) && (events & (POLLIN | POLLHUP)))
        read_in(client);
    else if (client->fd >= 0 && (events & (POLLHUP | POLLERR)))
        hang_up(client); /* nobody waits for the answer */
    for (int i = 0; i < REQUESTS_AT_ONCE && may_read(client) && take_request(server, client); i++)
        ;
    const bool stuck = client->out || client->in_used > 0;
    if (stuck && !is_waiting(client) && now_ns() - client->moved_ns > CLIENT_PATIENCE_NS)
        hang_up(client);
}

/* ---- all of them ------------------------------------------------------------------------------------------------ */

/** Those first that wait for what the cycle has: the others make it begin anew. The cycle takes one order at a time:
 *  those that stop or move an axis come before those that look. */
static int rank(const client_t *client)
{
    return client->request.wanted ? 0 : client->request.order == &client->request.maintain.order ? 1 : 2;
}

/** Of this rank the one that waits longest, of those that `done` has no bit of; NULL: there is none. */
static client_t *next_waiting(server_t *server, int of_rank, uint32_t done)
{
    client_t *next = NULL;
    for (int i = 0; i < CLIENTS; i++) {
        client_t *client = &server->clients[i];
        if (is_waiting(client) && rank(client) == of_rank && !(done & UINT32_C(1) << i) &&
            (!next || client->request.begun_ns < next->request.begun_ns))
            next = client;
    }
    return next;
}

static void continue_requests(server_t *server, bool stopping)
{
    uint32_t done = 0;
    client_t *client;
    for (int of_rank = 0; of_rank < 3; of_rank++)
        while ((client = next_waiting(server, of_rank, done))) {
            json_t *reply = cm1e_request_continue(&client->request, &server->run, now_ns(), stopping);
            done |= UINT32_C(1) << client->place;
            if (reply)
                answer(client, reply);
        }
}

static bool may_connect(const server_t *server, int fd, int *pid)
{
    struct ucred peer;
    socklen_t size = sizeof peer;
    if (getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0)
        return false;
    *pid = (int)peer.pid;
    return (peer.uid == geteuid() || peer.uid == 0) &&
           (server->run.control != CM1E_CONTROL_NONE || peer.pid == getpid());
}

static void turn_away(int fd, cm1e_error_t error, const char *text)
{
    size_t length = 0;
    uint8_t *bytes = cm1e_message_write(cm1e_request_refuse(NULL, error, 0, text), &length);
    if (bytes)
        (void)send(fd, bytes, length, MSG_DONTWAIT | MSG_NOSIGNAL); /* it may be gone already */
    free(bytes);
    close(fd);
}

static void welcome(server_t *server, int fd)
{
    client_t *client = NULL;
    int pid = 0;
    for (int i = 0; i < CLIENTS && !client; i++)
        client = server->clients[i].used ? NULL : &server->clients[i];
    if (!may_connect(server, fd, &pid)) {
        turn_away(fd, CM1E_ERROR_PERMISSION, server->run.control == CM1E_CONTROL_NONE
                  ? "The program refuses connections (control: none)." : "This program belongs to another user.");
        return;
    }
    uint8_t *in = client ? malloc(IN_ROOM) : NULL;
    if (!in) {
        turn_away(fd, CM1E_ERROR_FULL, "Too many others are connected; at most 32 are served.");
        return;
    }
    *client = (client_t){.fd = fd, .used = true, .in = in, .moved_ns = now_ns(), .pid = pid,
                         .place = (uint32_t)(client - server->clients)};
}

/** What poll() is asked for: no more than there are, as a process with few descriptors may not ask for more. */
typedef struct polled {
    struct pollfd of[FIRST_CLIENT + CLIENTS];
    nfds_t count;
    client_t *clients[FIRST_CLIENT + CLIENTS]; /**< whose it is */
} polled_t;

/** Milliseconds until somebody has to be looked at, whether or not something comes. */
static int fill_polled(server_t *server, polled_t *polled)
{
    int wait_ms = -1;
    polled->count = FIRST_CLIENT;
    polled->of[0] = (struct pollfd){.fd = atomic_load(&server->stop) ? -1 : server->wake, .events = POLLIN};
    polled->of[1] = (struct pollfd){.fd = server->full ? -1 : server->listener, .events = POLLIN};
    for (int i = 0; i < CLIENTS; i++) {
        client_t *client = &server->clients[i];
        const short events = (short)((may_read(client) ? POLLIN : 0) | (client->out ? POLLOUT : 0));
        if (client->used && client->fd >= 0) {
            polled->clients[polled->count] = client;
            polled->of[polled->count++] = (struct pollfd){.fd = client->fd, .events = events};
        }
        if (is_waiting(client) || (client->used && client->fd < 0)) /* or has to be let go of */
            wait_ms = BUSY_MS;
        else if ((client->out || client->in_used > 0) && wait_ms < 0)
            wait_ms = IDLE_MS;
    }
    return server->full && wait_ms < 0 ? IDLE_MS : wait_ms;
}

/** Takes those that want to connect. Without a descriptor for one it waits, and the listener is left alone for a
 *  while. */
static void welcome_all(server_t *server)
{
    /* cppcheck-suppress nullPointer ; accept4() needs no place for an address that nobody wants */
    for (int fd, n = 0; n < QUEUE && (fd = accept4(server->listener, NULL, NULL, ACCEPT_FLAGS)) >= 0; n++) {
        welcome(server, fd);
        errno = 0;
    }
    server->full = errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM;
}

static bool is_anybody_there(const server_t *server)
{
    for (int i = 0; i < CLIENTS; i++)
        if (server->clients[i].used)
            return true;
    return false;
}

/** After the stop the last records of the log can still be read for a moment. The bus has stopped then: every transfer
 *  has ended. */
static void *serve(void *context)
{
    server_t *server = context;
    polled_t polled;
    int64_t end_ns = INT64_MAX;
    while (now_ns() < end_ns) {
        const bool stopping = atomic_load(&server->stop);
        const int wait_ms = fill_polled(server, &polled);
        if (stopping && end_ns == INT64_MAX)
            end_ns = now_ns() + FAREWELL_NS;
        if (stopping && !is_anybody_there(server))
            break;
        if (poll(polled.of, polled.count, stopping ? BUSY_MS : wait_ms) < 0 && errno != EINTR)
            break;
        server->full = false;
        if (polled.of[1].revents)
            welcome_all(server);
        for (nfds_t i = FIRST_CLIENT; i < polled.count; i++)
            serve_client(server, polled.clients[i], polled.of[i].revents);
        continue_requests(server, stopping);
        for (int i = 0; i < CLIENTS; i++)
            if (server->clients[i].used && server->clients[i].fd < 0)
                leave(server, &server->clients[i]);
    }
    for (int i = 0; i < CLIENTS; i++)
        if (server->clients[i].used)
            leave(server, &server->clients[i]);
    return NULL;
}

/* ---- begin and end ---------------------------------------------------------------------------------------------- */

/** Several schedulers of a program may begin or end at the same time: one after the other looks for a number that none
 *  of them has, and removes what is left at its path, which must not be the socket of another one. */
static pthread_mutex_t sockets_of_process = PTHREAD_MUTEX_INITIALIZER;

static cm1e_error_t find_path(server_t *server, const char *directory, cm1e_diag_t *diag)
{
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    server->listener = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (server->listener < 0)
        return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "A control socket cannot be made: %s.", strerror(errno));
    for (int n = 0; n < CM1E_SOCKETS_OF_PROCESS; n++) {
        char taken[CM1E_SOCKET_PATH];
        int other = n;
        const cm1e_error_t error = cm1e_runtime_socket(server->path, directory, n, diag);
        if (error != CM1E_OK)
            return error;
        if (cm1e_runtime_find(getpid(), &other, taken) && other == n + 1)
            continue; /* of another scheduler of this program */
        unlink(server->path); /* left behind by a process that had this number */
        memcpy(address.sun_path, server->path, sizeof address.sun_path);
        if (bind(server->listener, (const struct sockaddr *)&address, sizeof address) == 0 &&
            chmod(server->path, 0600) == 0 && listen(server->listener, QUEUE) == 0)
            return CM1E_OK;
        return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "The control socket %s cannot be made: %s.", server->path,
                             strerror(errno));
    }
    close(server->listener); /* the path is that of another scheduler */
    server->listener = -1;
    return cm1e_diag_set(diag, CM1E_ERROR_IO, 0,
                         "This program has %d control sockets already, as many as there can be.",
                         CM1E_SOCKETS_OF_PROCESS);
}

static cm1e_error_t listen_at(server_t *server, const char *directory, cm1e_diag_t *diag)
{
    pthread_mutex_lock(&sockets_of_process);
    const cm1e_error_t error = find_path(server, directory, diag);
    pthread_mutex_unlock(&sockets_of_process);
    return error;
}

/** An ordinary thread, whatever the one that starts it is; signals are for the program's own threads. */
static int start_thread(server_t *server)
{
    const struct sched_param ordinary = {.sched_priority = 0};
    pthread_attr_t attributes;
    sigset_t all, before;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, STACK_BYTES);
    pthread_attr_setschedpolicy(&attributes, SCHED_OTHER);
    pthread_attr_setschedparam(&attributes, &ordinary);
    pthread_attr_setinheritsched(&attributes, PTHREAD_EXPLICIT_SCHED);
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    const int failed = pthread_create(&server->thread, &attributes, serve, server);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    pthread_attr_destroy(&attributes);
    return failed;
}

static void free_server(server_t *server)
{
    pthread_mutex_lock(&sockets_of_process);
    if (server->listener >= 0) {
        close(server->listener);
        unlink(server->path);
    }
    pthread_mutex_unlock(&sockets_of_process);
    if (server->wake >= 0)
        close(server->wake);
    cm1e_view_free(&server->run.view);
    free(server);
}

cm1e_error_t cm1e_control_server_start(cm1e_control_server_t **server, cm1e_scheduler_t *scheduler, uint32_t bus,
                                       char *path, size_t path_size, cm1e_diag_t *diag)
{
    char directory[CM1E_SOCKET_PATH];
    *server = NULL;
    cm1e_error_t error = cm1e_runtime_dir(directory, sizeof directory, diag);
    server_t *made = error == CM1E_OK ? calloc(1, sizeof *made) : NULL;
    if (error != CM1E_OK)
        return error;
    if (!made)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the control socket.");
    made->listener = -1;
    made->wake = eventfd(0, EFD_CLOEXEC);
    made->run.since = time(NULL);
    made->run.control = cm1e_bus_configuration(cm1e_scheduler_bus_at(scheduler, bus))->control;
    made->run.serves_own = cm1e_control_serves_own();
    cm1e_program_name(made->run.program, sizeof made->run.program);
    for (int i = 0; i < CLIENTS; i++)
        made->clients[i].fd = -1;
    cm1e_runtime_dir_tidy(directory);
    if (cm1e_view_init(&made->run.view, scheduler, bus) != CM1E_OK || made->wake < 0)
        error = cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the control socket.");
    if (error == CM1E_OK)
        error = listen_at(made, directory, diag);
    if (error == CM1E_OK && start_thread(made) != 0)
        error = cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "The thread of the control socket cannot be started.");
    if (error != CM1E_OK) {
        free_server(made);
        return error;
    }
    snprintf(path, path_size, "%s", made->path);
    *server = made;
    return CM1E_OK;
}

view_t *cm1e_control_server_view(cm1e_control_server_t *server) { return &server->run.view; }

void cm1e_control_server_stop(cm1e_control_server_t *server)
{
    const uint64_t one = 1;
    atomic_store(&server->stop, true);
    if (write(server->wake, &one, sizeof one) == sizeof one)
        pthread_join(server->thread, NULL);
    free_server(server);
}
