/*
 * Round trips of a frame over a pair of network interfaces, by each way that Linux has to send and receive one: to another
 * process that sends it back, always in the same way. One round trip each millisecond, then without a pause. "next cycle" is
 * what the scheduler does: it sends, sleeps, and takes the answer of the cycle before, which is there; only the time of the
 * two calls counts. The ways take turns. "refused" is what the kernel does not offer here.
 *
 *     bench_socket [BYTES ...]    usually frames of 64, 512 and 1514 bytes
 *
 * It needs the right to make a network namespace. The sender runs on the last processor, the answering process on the first.
 */
#include <errno.h>
#include <net/if.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "socket_ways.h"
#include "sort.h"
#include "veth.h"

enum { ROUNDS = 5, PACED = 1000, QUICK = 4000, ALL = ROUNDS * (QUICK > PACED ? QUICK : PACED), WARM_UP = 20, PAUSE_NS = 1000000 };

static const way_t *const ways[] = {&way_send_recv, &way_poll_first, &way_spin, &way_bypass, &way_busy_poll, &way_mmap, &way_uring, &way_xdp};
enum { WAYS = sizeof ways / sizeof ways[0] };

typedef enum manner { EACH_MS, NEXT_CYCLE, AT_ONCE, MANNERS } manner_t;
static const char *const manners[MANNERS] = {"each 1 ms", "next cycle", "at once"};
static const int counts[MANNERS] = {PACED, PACED, QUICK};

typedef struct result {
    double us[ALL];
    int count, lost;
    unsigned long calls;
    int refused; /* errno */
} result_t;

static result_t results[WAYS];

static void pin(int processor)
{
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(processor, &one);
    sched_setaffinity(0, sizeof one, &one);
}

static int processors(void) { return (int)sysconf(_SC_NPROCESSORS_ONLN); }

/* Sends back what comes, for ever. */
static void answer(void)
{
    uint8_t frame[WAY_FRAME_MAX];
    void *state = way_spin.open(if_nametoindex("wire1"));
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    pin(0);
    while (state) {
        const size_t length = way_send_recv.receive(state, frame);
        if (length > 0)
            way_send_recv.send(state, frame, length);
    }
    _exit(1);
}

static int64_t now_ns(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * INT64_C(1000000000) + now.tv_nsec;
}

static void sleep_until(int64_t ns)
{
    const struct timespec then = {.tv_sec = ns / 1000000000, .tv_nsec = ns % 1000000000};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &then, NULL);
}

static bool round_trip(const way_t *way, void *state, uint8_t *sent, size_t bytes, uint32_t number)
{
    uint8_t got[WAY_FRAME_MAX];
    memcpy(sent + 20, &number, sizeof number);
    return way->send(state, sent, bytes) && way->receive(state, got) == bytes && memcmp(sent, got, bytes) == 0;
}

/* Nanoseconds of the calls; < 0: the frame was lost. */
static int64_t time_calls(const way_t *way, void *state, uint8_t *sent, size_t bytes, uint32_t number, int64_t next_ns)
{
    uint8_t got[WAY_FRAME_MAX];
    memcpy(sent + 20, &number, sizeof number);
    const int64_t begin = now_ns();
    const bool left = way->send(state, sent, bytes);
    const int64_t gone = now_ns();
    sleep_until(next_ns);
    const int64_t look = now_ns();
    const bool came = left && way->receive(state, got) == bytes;
    const int64_t end = now_ns();
    return came && memcmp(sent, got, bytes) == 0 ? gone - begin + end - look : -1;
}

static void one_round(const way_t *way, result_t *result, size_t bytes, manner_t manner)
{
    uint8_t sent[WAY_FRAME_MAX] = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, [12] = WAY_ETHERTYPE >> 8, WAY_ETHERTYPE & 0xFF};
    void *state = way->open(if_nametoindex("wire0"));
    result->refused = state ? 0 : errno;
    for (uint32_t i = 0; state && i < WARM_UP; i++)
        round_trip(way, state, sent, bytes, UINT32_MAX - i);
    int64_t next = now_ns();
    for (uint32_t i = 0; state && i < (uint32_t)counts[manner]; i++) {
        if (manner == EACH_MS)
            sleep_until(next += PAUSE_NS);
        const unsigned long before = way_calls;
        const int64_t begin = now_ns();
        int64_t took = -1;
        if (manner == NEXT_CYCLE)
            took = time_calls(way, state, sent, bytes, i, next += PAUSE_NS);
        else if (round_trip(way, state, sent, bytes, i))
            took = now_ns() - begin;
        result->calls += way_calls - before;
        if (took >= 0)
            result->us[result->count++] = (double)took / 1000.0;
        else
            result->lost++;
    }
    if (state)
        way->close(state);
}

static double part(const result_t *result, double of) { return result->us[(int)((result->count - 1) * of)]; }

static void print(size_t bytes, manner_t manner)
{
    const double usual = results[0].count > 0 ? part(&results[0], 0.5) : 0.0;
    for (int w = 0; w < WAYS; w++) {
        const result_t *result = &results[w];
        printf("%5zu  %-10s %-34s", bytes, manners[manner], ways[w]->name);
        if (result->refused || result->count == 0)
            printf(" refused: %s\n", result->refused ? strerror(result->refused) : "no frame comes back");
        else
            printf(" %8.2f %8.2f %8.2f %7.3f %6.2f %5d\n", part(result, 0.5), part(result, 0.99), part(result, 0.999),
                   part(result, 0.5) / usual, (double)result->calls / (result->count + result->lost), result->lost);
    }
}

static void measure(size_t bytes, manner_t manner)
{
    memset(results, 0, sizeof results);
    for (int round = 0; round < ROUNDS; round++)
        for (int w = 0; w < WAYS; w++)
            one_round(ways[w], &results[w], bytes, manner);
    for (int w = 0; w < WAYS; w++)
        sort_values(results[w].us, (size_t)results[w].count);
    print(bytes, manner);
}

int main(int words, char **word)
{
    static const char *const usual[] = {"64", "512", "1514"};
    const int given = words > 1 ? words - 1 : 3;
    if (!veth_make()) {
        fprintf(stderr, "bench_socket: no network namespace can be made here\n");
        return 1;
    }
    usleep(200000); /* until both ends have a link */
    const pid_t other = fork();
    if (other == 0)
        answer();
    pin(processors() - 1);
    printf("%5s  %-10s %-34s %8s %8s %8s %7s %6s %5s\n", "bytes", "", "way", "median", "99 %", "99.9 %", "ratio", "calls", "lost");
    for (int i = 0; i < given; i++) {
        const size_t bytes = strtoul(words > 1 ? word[i + 1] : usual[i], NULL, 10);
        if (bytes < 60 || bytes > WAY_FRAME_MAX) {
            fprintf(stderr, "bench_socket: a frame has 60 to %d bytes\n", WAY_FRAME_MAX);
            break;
        }
        for (int manner = 0; manner < MANNERS; manner++)
            measure(bytes, (manner_t)manner);
    }
    kill(other, SIGKILL);
    waitpid(other, NULL, 0);
    return 0;
}
