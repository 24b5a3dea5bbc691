/* What browsers, and others on this machine, send to the server of `cm1e trace --live`. One server serves many inputs. It
 * tells nothing to who does not know its address, and never tells the address. Whatever was sent, a browser that does know
 * it gets the page afterwards.
 *
 * An input is what is sent. Bytes that no request has stand for what an input cannot know: 1 the host, 2 the path of the
 * page, 3 that of the events. 4: another connection, the last one stays open; 5: the recording has another sample. */
#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "fuzz.h"
#include "trace_server.h"

enum { CONNECTIONS = 4, SERVER_INPUTS = 300, ANSWER_BYTES = 1 << 20, TOKEN_DIGITS = 32 };
enum { ANSWER_MS = 300, NO_ANSWER_MS = 5, HONEST_MS = 10000, HONEST_EVERY = 16 }; /* how long a peer waits */

typedef struct peer {
    int fd;
    bool knows;  /**< it named the page or the events */
    bool hosted; /**< it named the host: a page from elsewhere names its own */
    int patience_ms;
} peer_t;

static trace_server_t *server;
static recording_t recording;
static char host[64], page[64], events[80];
static unsigned inputs;

/* Between two samples that are shown there is some time: every look at the clock is a second later than the last one. */
int __wrap_clock_gettime(clockid_t clock, struct timespec *now);
int __wrap_clock_gettime(clockid_t clock, struct timespec *now)
{
    static time_t seconds = 1000;
    (void)clock;
    *now = (struct timespec){.tv_sec = ++seconds};
    return 0;
}

/* ---- the server -------------------------------------------------------------------------------------------------- */

static void begin(void)
{
    static const char *const names[] = {"</script>", "Y"};
    cm1e_diag_t diag = {0};
    recording = (recording_t){.first_ns = -1};
    if (cm1e_trace_init(&recording.trace, names, 2, 64, 1, &diag) != CM1E_OK ||
        cm1e_trace_begin(&recording.trace, &diag) != CM1E_OK ||
        trace_server_begin(&server, &recording, 0, &diag) != CM1E_OK)
        fuzz_fail("no server: %s", diag.text);
    const char *at = trace_server_url(server) + strlen("http://"), *path = strchr(at, '/');
    snprintf(host, sizeof host, "%.*s", (int)(path - at), at);
    snprintf(page, sizeof page, "%s", path);
    snprintf(events, sizeof events, "%sevents", path);
}

static void end(void)
{
    trace_server_end(server, &recording, "the run has ended");
    recording_free(&recording);
    server = NULL;
}

static void record(void)
{
    double *values = calloc(recording.trace.column_count, sizeof *values);
    recording.last_ns += 1000000;
    if (!values || !cm1e_trace_take(&recording.trace, values, recording.last_ns))
        fuzz_fail("no sample");
    free(values);
    recording.samples++;
    trace_server_show(server, &recording);
}

/* ---- its peers --------------------------------------------------------------------------------------------------- */

static void connect_peer(peer_t *peer)
{
    const struct timeval patience = {.tv_sec = 1};
    const struct linger reset = {.l_onoff = 1}; /* no port waits for a minute */
    struct sockaddr_in address = {.sin_family = AF_INET, .sin_port = htons((uint16_t)atoi(strchr(host, ':') + 1)),
                                  .sin_addr.s_addr = htonl(INADDR_LOOPBACK)};
    bool connected = false;
    for (int tries = 0; tries < 5 && !connected; tries++) { /* libFuzzer's timer interrupts it */
        *peer = (peer_t){.fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0), .patience_ms = NO_ANSWER_MS};
        connected = peer->fd >= 0 && connect(peer->fd, (struct sockaddr *)&address, sizeof address) == 0;
        if (peer->fd >= 0 && !connected)
            close(peer->fd);
    }
    if (!connected)
        fuzz_fail("no connection: %m");
    setsockopt(peer->fd, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    setsockopt(peer->fd, SOL_SOCKET, SO_LINGER, &reset, sizeof reset);
}

/** What has no end is not answered: libmicrohttpd waits for the rest, until its time is over. */
static void send_words(peer_t *peer, const char *words, size_t length)
{
    if (memmem(words, length, "\n\r\n", 3) || memmem(words, length, "\n\n", 2))
        peer->patience_ms = ANSWER_MS;
    peer->hosted = peer->hosted || memmem(words, length, host, strlen(host));
    if (length > 0)
        (void)!send(peer->fd, words, length, MSG_NOSIGNAL); /* it may have closed */
}

/** Sends as far as the next connection begins; true: one does. */
static bool speak(peer_t *peer, const uint8_t **at, const uint8_t *last)
{
    static char words[65536];
    size_t used = 0;
    bool another = false;
    while (*at < last && !another) {
        const uint8_t byte = *(*at)++;
        const char *whole = byte == 1 ? host : byte == 2 ? page : byte == 3 ? events : NULL;
        peer->knows = peer->knows || byte == 2 || byte == 3;
        peer->hosted = peer->hosted || byte == 1;
        another = byte == 4;
        if (byte == 5) {
            send_words(peer, words, used);
            used = 0;
            record();
        } else if (whole && used + strlen(whole) < sizeof words) {
            memcpy(words + used, whole, strlen(whole));
            used += strlen(whole);
        } else if (!another && !whole && used < sizeof words) {
            words[used++] = (char)byte;
        }
    }
    send_words(peer, words, used);
    return another;
}

/** All it answers: until it closes, or, where it goes on for ever, until a sample has come. */
static size_t listen_to(const peer_t *peer, char *answer)
{
    size_t used = 0;
    bool shown = false;
    struct pollfd poll_fd = {.fd = peer->fd, .events = POLLIN};
    shutdown(peer->fd, SHUT_WR);
    while (used + 1 < ANSWER_BYTES) {
        const int ready = poll(&poll_fd, 1, peer->patience_ms);
        if (ready < 0 && errno == EINTR)
            continue;
        if (ready <= 0)
            break;
        const ssize_t got = recv(peer->fd, answer + used, ANSWER_BYTES - 1 - used, 0);
        if (got <= 0)
            break;
        used += (size_t)got;
        answer[used] = 0;
        const char *stream = strstr(answer, "text/event-stream");
        if (stream && strstr(stream, "data:"))
            break;
        if (stream && !shown)
            record();
        shown = stream;
    }
    answer[used] = 0;
    return used;
}

static void judge(const peer_t *peer, const char *answer, size_t used)
{
    static const int own[] = {200, 403, 404, 405, 503};
    int status = 0;
    if (used == 0)
        return;
    if (sscanf(answer, "HTTP/1.%*d %d", &status) != 1)
        fuzz_fail("an answer that is none of HTTP: %.100s", answer);
    if (status == 200 && !peer->knows)
        fuzz_fail("somebody who does not know the address gets: %.300s", answer);
    if (status == 200 && !peer->hosted)
        fuzz_fail("a page under another name gets: %.300s", answer);
    if (memmem(answer, used, page + 1, TOKEN_DIGITS))
        fuzz_fail("the server tells its address");
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        if (status == own[i] && !strstr(answer, "frame-ancestors 'none'"))
            fuzz_fail("other pages may show this one: %.300s", answer);
}

static void be_honest(char *answer)
{
    static const uint8_t request[] = "GET \2 HTTP/1.1\r\nHost: \1\r\nConnection: close\r\n\r\n";
    const uint8_t *at = request;
    peer_t peer;
    connect_peer(&peer);
    speak(&peer, &at, request + sizeof request - 1);
    peer.patience_ms = HONEST_MS;
    listen_to(&peer, answer);
    if (strncmp(answer, "HTTP/1.1 200", 12) != 0 || !strstr(answer, "</html>"))
        fuzz_fail("an honest browser does not get the page but: %.400s", answer);
    close(peer.fd);
}

bool fuzz_rewrite(cm1e_file_t *written, const uint8_t *bytes, size_t size, bool must)
{
    (void)written, (void)must;
    static char answer[ANSWER_BYTES];
    peer_t peers[CONNECTIONS];
    int count = 0;
    const uint8_t *at = bytes, *last = size ? bytes + size : bytes;
    if (!server)
        begin();
    bool more = true;
    while (more && count < CONNECTIONS) {
        connect_peer(&peers[count]);
        more = speak(&peers[count++], &at, last);
    }
    for (int i = 0; i < count; i++)
        judge(&peers[i], answer, listen_to(&peers[i], answer));
    for (int i = 0; i < count; i++)
        close(peers[i].fd);
    record(); /* those that have gone are noticed */
    if (++inputs % HONEST_EVERY == 0)
        be_honest(answer);
    if (inputs % SERVER_INPUTS == 0)
        end();
    return false;
}

void fuzz_seeds(void)
{
    static const char *const texts[] = {
        "GET \2 HTTP/1.1\r\nHost: \1\r\n\r\n",
        "GET \3 HTTP/1.1\r\nHost: \1\r\nOrigin: http://\1\r\n\r\n\5\5",
        "GET \2 HTTP/1.1\r\nHost: \1\r\nOrigin: http://elsewhere\r\n\r\n",
        "GET \2 HTTP/1.1\r\nHost: localhost:80\r\n\r\n",
        "GET \2 HTTP/1.0\r\n\r\n",
        "GET / HTTP/1.1\r\nHost: \1\r\n\r\nGET \2 HTTP/1.1\r\nHost: \1\r\nConnection: close\r\n\r\n",
        "POST \2 HTTP/1.1\r\nHost: \1\r\nContent-Length: 5\r\n\r\nabcde",
        "PUT \2 HTTP/1.1\r\nHost: \1\r\nTransfer-Encoding: chunked\r\n\r\n3\r\nabc\r\n0\r\n\r\n",
        "HEAD \2 HTTP/1.1\r\nHost: \1\r\n\r\n",
        "GET http://\1\2 HTTP/1.1\r\nHost: \1\r\nCookie: a=b\r\nExpect: 100-continue\r\nUpgrade: h2c\r\n\r\n",
        "GET \2%00?a=b&c HTTP/1.1\r\nHost: \1\r\nRange: bytes=0-1\r\n\r\n",
        "GET \3 HTTP/1.1\r\nHost: \1\r\n\r\n\4GET \3 HTTP/1.1\r\nHost: \1\r\n\r\n\5\4GET \2",
        "\x16\x03\x01 not a request\r\n\r\n", "GET",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        char name[24];
        snprintf(name, sizeof name, "request_%zu", i);
        fuzz_seed(name, texts[i], strlen(texts[i]));
    }
}
