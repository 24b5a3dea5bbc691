/* The HTTP server is libmicrohttpd. Samples are printed once for all browsers, into a ring of messages; each browser
 * gets a copy of the next one when it has taken the last one. So memory is bounded, and a browser that does not read
 * finds only that messages are gone, which the page counts. */
#include "trace_server.h"

#include <stdlib.h>

#ifdef CM1E_HAVE_MICROHTTPD

#include <arpa/inet.h>
#include <microhttpd.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>
#include <sys/random.h>
#include <time.h>
#include <unistd.h>

#include "plot/plot_files.h"

enum { TOKEN_BYTES = 16, MESSAGES = 32, VIEWERS = 8, CONNECTIONS = 2 * VIEWERS, STUCK_S = 30, REQUEST_BYTES = 32768,
       BLOCK_BYTES = 65536, SHOW_NS = 100000000, END_MS = 1000 };

typedef struct message {
    char *text; /**< NULL: none yet */
    size_t bytes;
} message_t;

/** A browser that gets events. */
typedef struct viewer {
    trace_server_t *server;
    struct MHD_Connection *connection;
    char *text;        /**< the message on its way; NULL: none */
    size_t bytes, sent;
    uint64_t next;     /**< number of the next message */
    bool used, waits;  /**< it waits for the next message: its connection is suspended */
} viewer_t;

struct trace_server {
    struct MHD_Daemon *daemon;
    char host[32], url[96], path[2 * TOKEN_BYTES + 3], events[2 * TOKEN_BYTES + 16];
    char *page;
    size_t page_bytes;
    pthread_mutex_t lock; /**< of what follows */
    message_t messages[MESSAGES];
    uint64_t written;     /**< messages */
    viewer_t viewers[VIEWERS];
    bool ending;
    uint64_t samples;     /**< of the recording that have been shown */
    int64_t marked_ns, shown_ns;
};

/* ---- messages ---------------------------------------------------------------------------------------------------- */

/** Takes `text`. */
static void publish(trace_server_t *server, char *text, size_t bytes)
{
    pthread_mutex_lock(&server->lock);
    message_t *message = &server->messages[server->written % MESSAGES];
    free(message->text);
    *message = (message_t){text, bytes};
    server->written++;
    for (int i = 0; i < VIEWERS; i++) {
        if (server->viewers[i].waits)
            MHD_resume_connection(server->viewers[i].connection);
        server->viewers[i].waits = false;
    }
    pthread_mutex_unlock(&server->lock);
}

/** The next message becomes that of the viewer. false: there is none, or no memory for it. */
static bool next_message(viewer_t *viewer)
{
    trace_server_t *server = viewer->server;
    free(viewer->text);
    viewer->text = NULL;
    if (viewer->next + MESSAGES < server->written)
        viewer->next = server->written - MESSAGES;
    if (viewer->next == server->written)
        return false;
    const message_t *message = &server->messages[viewer->next % MESSAGES];
    viewer->text = malloc(message->bytes);
    if (!viewer->text)
        return false;
    memcpy(viewer->text, message->text, message->bytes);
    viewer->bytes = message->bytes;
    viewer->sent = 0;
    viewer->next++;
    return true;
}

/** Part of a response that ends with the recording. */
static ssize_t send_part(void *context, uint64_t position, char *buffer, size_t room)
{
    viewer_t *viewer = context;
    ssize_t bytes = 0;
    (void)position;
    pthread_mutex_lock(&viewer->server->lock);
    if (!viewer->text && !next_message(viewer)) {
        if (viewer->server->ending) {
            bytes = MHD_CONTENT_READER_END_OF_STREAM;
        } else {
            viewer->waits = true;
            MHD_suspend_connection(viewer->connection);
        }
    } else {
        const size_t left = viewer->bytes - viewer->sent;
        bytes = (ssize_t)(left < room ? left : room);
        memcpy(buffer, viewer->text + viewer->sent, (size_t)bytes);
        viewer->sent += (size_t)bytes;
        if (viewer->sent == viewer->bytes) {
            free(viewer->text);
            viewer->text = NULL;
        }
    }
    pthread_mutex_unlock(&viewer->server->lock);
    return bytes;
}

static void free_viewer(void *context)
{
    viewer_t *viewer = context;
    pthread_mutex_t *lock = &viewer->server->lock;
    pthread_mutex_lock(lock);
    free(viewer->text);
    *viewer = (viewer_t){0};
    pthread_mutex_unlock(lock);
}

/** It begins with the oldest message that is there. NULL: there are too many. */
static viewer_t *new_viewer(trace_server_t *server, struct MHD_Connection *connection)
{
    viewer_t *viewer = NULL;
    pthread_mutex_lock(&server->lock);
    for (int i = 0; i < VIEWERS && !viewer && !server->ending; i++)
        if (!server->viewers[i].used)
            viewer = &server->viewers[i];
    if (viewer)
        *viewer = (viewer_t){.server = server, .connection = connection, .used = true};
    pthread_mutex_unlock(&server->lock);
    return viewer;
}

/* ---- requests ---------------------------------------------------------------------------------------------------- */

/** No other page may read, frame or guess this one, and it loads nothing from elsewhere. */
static enum MHD_Result respond(struct MHD_Connection *connection, unsigned status, const char *type,
                               struct MHD_Response *response)
{
    static const char *const headers[][2] = {
        {"Cache-Control", "no-store"},
        {"Referrer-Policy", "no-referrer"},
        {"X-Content-Type-Options", "nosniff"},
        {"Cross-Origin-Resource-Policy", "same-origin"},
        {"Cross-Origin-Opener-Policy", "same-origin"},
        {"Content-Security-Policy", "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
                                    "connect-src 'self'; img-src data:; frame-ancestors 'none'; base-uri 'none'; "
                                    "form-action 'none'"},
    };
    if (!response)
        return MHD_NO;
    MHD_add_response_header(response, "Content-Type", type);
    for (size_t i = 0; i < sizeof headers / sizeof *headers; i++)
        MHD_add_response_header(response, headers[i][0], headers[i][1]);
    const enum MHD_Result result = MHD_queue_response(connection, status, response);
    MHD_destroy_response(response);
    return result;
}

static enum MHD_Result refuse(struct MHD_Connection *connection, unsigned status, const char *text)
{
    return respond(connection, status, "text/plain; charset=utf-8",
                   MHD_create_response_from_buffer(strlen(text), (void *)(uintptr_t)text, MHD_RESPMEM_PERSISTENT));
}

static enum MHD_Result send_events(trace_server_t *server, struct MHD_Connection *connection)
{
    viewer_t *viewer = new_viewer(server, connection);
    if (!viewer)
        return refuse(connection, MHD_HTTP_SERVICE_UNAVAILABLE, "Too many pages show this trace: close one.\n");
    return respond(connection, MHD_HTTP_OK, "text/event-stream",
                   MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, BLOCK_BYTES, send_part, viewer, free_viewer));
}

/** As strcmp() == 0, in a time that does not tell how much of it is right. */
static bool is_same(const char *text, const char *right)
{
    const size_t bytes = strlen(right);
    unsigned char difference = 0;
    if (strlen(text) != bytes)
        return false;
    for (size_t i = 0; i < bytes; i++)
        difference |= (unsigned char)(text[i] ^ right[i]);
    return difference == 0;
}

static const char *header(struct MHD_Connection *connection, const char *name)
{
    return MHD_lookup_connection_value(connection, MHD_HEADER_KIND, name);
}

/** A page from elsewhere whose name leads to 127.0.0.1 (DNS rebinding) sends that name as Host; one that asks across
 *  has an Origin of its own. */
static bool is_from_own_page(const trace_server_t *server, struct MHD_Connection *connection)
{
    static const char scheme[] = "http://";
    const char *host = header(connection, MHD_HTTP_HEADER_HOST), *origin = header(connection, MHD_HTTP_HEADER_ORIGIN);
    return host && strcmp(host, server->host) == 0 &&
           (!origin || (strncmp(origin, scheme, sizeof scheme - 1) == 0 &&
                        strcmp(origin + sizeof scheme - 1, server->host) == 0));
}

static enum MHD_Result answer(void *context, struct MHD_Connection *connection, const char *url, const char *method,
                              const char *version, const char *data, size_t *bytes, void **state)
{
    trace_server_t *server = context;
    (void)version, (void)data, (void)state;
    if (strcmp(method, MHD_HTTP_METHOD_GET) != 0) {
        *bytes = 0;
        return refuse(connection, MHD_HTTP_METHOD_NOT_ALLOWED, "Only GET.\n");
    }
    if (!is_from_own_page(server, connection))
        return refuse(connection, MHD_HTTP_FORBIDDEN, "Open the address that cm1e trace has printed.\n");
    if (is_same(url, server->events))
        return send_events(server, connection);
    if (!is_same(url, server->path))
        return refuse(connection, MHD_HTTP_NOT_FOUND, "There is nothing here: open the address that cm1e trace has "
                      "printed.\n");
    return respond(connection, MHD_HTTP_OK, "text/html; charset=utf-8",
                   MHD_create_response_from_buffer(server->page_bytes, server->page, MHD_RESPMEM_PERSISTENT));
}

/* ---- begin and end ----------------------------------------------------------------------------------------------- */

static bool make_token(trace_server_t *server)
{
    uint8_t token[TOKEN_BYTES];
    if (getrandom(token, sizeof token, 0) != sizeof token)
        return false;
    char *at = server->path;
    *at++ = '/';
    for (int i = 0; i < TOKEN_BYTES; i++)
        at += sprintf(at, "%02x", token[i]);
    *at++ = '/';
    *at = '\0';
    snprintf(server->events, sizeof server->events, "%sevents", server->path);
    return true;
}

static cm1e_error_t print_page(trace_server_t *server, const recording_t *recording, cm1e_diag_t *diag)
{
    FILE *file = open_memstream(&server->page, &server->page_bytes);
    if (!file)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for a page.");
    const cm1e_error_t error = cm1e_plot_print_live_page(&recording->trace, "events", file, diag);
    if (fclose(file) != 0 && error == CM1E_OK)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for a page.");
    return error;
}

/** libmicrohttpd complains on standard error of clients that do wrong; nobody needs that. */
static void say_nothing(void *context, const char *format, va_list arguments)
{
    (void)context, (void)format, (void)arguments;
}

static cm1e_error_t listen_on(trace_server_t *server, uint16_t port, cm1e_diag_t *diag)
{
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons(port),
                                  .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    server->daemon = MHD_start_daemon(
        MHD_USE_INTERNAL_POLLING_THREAD | MHD_USE_AUTO | MHD_ALLOW_SUSPEND_RESUME | MHD_USE_ERROR_LOG, port, NULL, NULL,
        answer, server, MHD_OPTION_EXTERNAL_LOGGER, say_nothing, NULL, MHD_OPTION_SOCK_ADDR, &address,
        MHD_OPTION_CONNECTION_LIMIT, (unsigned)CONNECTIONS, MHD_OPTION_CONNECTION_TIMEOUT, (unsigned)STUCK_S,
        MHD_OPTION_CONNECTION_MEMORY_LIMIT, (size_t)REQUEST_BYTES, MHD_OPTION_END);
    if (!server->daemon)
        return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "The page cannot be served on 127.0.0.1, port %u. Another program "
                             "may have the port: choose another one, or leave it out.", port);
    snprintf(server->host, sizeof server->host, "127.0.0.1:%u",
             MHD_get_daemon_info(server->daemon, MHD_DAEMON_INFO_BIND_PORT)->port);
    snprintf(server->url, sizeof server->url, "http://%s%s", server->host, server->path);
    return CM1E_OK;
}

static void free_server(trace_server_t *server)
{
    if (server->daemon)
        MHD_stop_daemon(server->daemon);
    for (int i = 0; i < MESSAGES; i++)
        free(server->messages[i].text);
    free(server->page);
    pthread_mutex_destroy(&server->lock);
    free(server);
}

cm1e_error_t trace_server_begin(trace_server_t **server, const recording_t *recording, uint16_t port,
                                cm1e_diag_t *diag)
{
    *server = calloc(1, sizeof **server);
    if (!*server)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for a page.");
    pthread_mutex_init(&(*server)->lock, NULL);
    (*server)->marked_ns = -1;
    cm1e_error_t error = print_page(*server, recording, diag);
    if (error == CM1E_OK && !make_token(*server))
        error = cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "The system has no random numbers for the address of the page.");
    if (error == CM1E_OK)
        error = listen_on(*server, port, diag);
    if (error != CM1E_OK) {
        free_server(*server);
        *server = NULL;
    }
    return error;
}

const char *trace_server_url(const trace_server_t *server) { return server->url; }

static void show_now(trace_server_t *server, const recording_t *recording)
{
    const uint64_t more = recording->samples - server->samples;
    const uint32_t used = recording->trace.used, count = more < used ? (uint32_t)more : used;
    char *text = NULL;
    size_t bytes = 0;
    FILE *file = more > 0 ? open_memstream(&text, &bytes) : NULL;
    if (!file)
        return;
    fputs("data: ", file);
    cm1e_plot_print_live_samples(&recording->trace, count, recording->samples - count, server->marked_ns, file);
    fputs("\n\n", file);
    server->samples = recording->samples;
    server->marked_ns = recording->last_ns;
    if (fclose(file) == 0)
        publish(server, text, bytes);
    else
        free(text);
}

void trace_server_show(trace_server_t *server, const recording_t *recording)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    const int64_t now_ns = now.tv_sec * INT64_C(1000000000) + now.tv_nsec;
    if (now_ns - server->shown_ns < SHOW_NS)
        return;
    server->shown_ns = now_ns;
    show_now(server, recording);
}

/** Some time for browsers to take what is left. */
static void wait_for_viewers(trace_server_t *server)
{
    bool left = true;
    for (int ms = 0; ms < END_MS && left; ms += 10) {
        left = false;
        usleep(10000);
        pthread_mutex_lock(&server->lock);
        for (int i = 0; i < VIEWERS; i++)
            left = left || server->viewers[i].used;
        pthread_mutex_unlock(&server->lock);
    }
}

void trace_server_end(trace_server_t *server, const recording_t *recording, const char *why)
{
    char *text;
    if (!server)
        return;
    show_now(server, recording);
    pthread_mutex_lock(&server->lock);
    server->ending = true;
    pthread_mutex_unlock(&server->lock);
    const int bytes = asprintf(&text, "event: end\ndata: %s\n\n", why);
    if (bytes > 0)
        publish(server, text, (size_t)bytes);
    wait_for_viewers(server);
    free_server(server);
}

#else

cm1e_error_t trace_server_begin(trace_server_t **server, const recording_t *recording, uint16_t port,
                                cm1e_diag_t *diag)
{
    (void)recording, (void)port;
    *server = NULL;
    return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0,
                         "This build of cm1e serves no pages: it was configured without libmicrohttpd (Debian package "
                         "libmicrohttpd-dev). Install it and build again, or record into a file.");
}

const char *trace_server_url(const trace_server_t *server) { (void)server; return ""; }
void trace_server_show(trace_server_t *server, const recording_t *recording) { (void)server, (void)recording; }

void trace_server_end(trace_server_t *server, const recording_t *recording, const char *why)
{
    (void)server, (void)recording, (void)why;
}

#endif
