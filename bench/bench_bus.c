/**
 * A cycle of the bus beside one of bare SOEM: receive, then send, of the same simulated drives behind the same port.
 * Drives are disabled; simulated drives and port are in both figures. A figure is processor time, the least of some rounds
 * in turns, each the median of batches; under callgrind, measured_cycles() is counted, with a dump for each call
 * (bench/README.md).
 *
 *     bench_bus [DRIVES ...]           1, 16 and 128 drives
 *     bench_bus --veth,xdp [DRIVES ...]    as --veth, with the frames of the library by AF_XDP
 *     bench_bus --veth [DRIVES ...]    over a pair of network interfaces, beside SOEM with its own port, 1 and 16 drives:
 *                                      real time from before sending until the answer is taken, best of some rounds
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bus/bus_internal.h"
#include "bus/kept.h"
#include "served_drives.h"
#include "sort.h"
#include "start_soem.h"
#include "support/veth.h"

enum { BATCHES = 10, BATCH_CYCLES = 300, WARM = 300, PDO_OUTPUTS = 0x1600, PDO_INPUTS = 0x1A00, ROUNDS = 5,
       WIRE_CYCLES = 2000 };
#define WIRE_TARGET 1.05
static const unsigned usual[] = {1, 16, 128};
static const double targets[] = {1.25, 1.10, 1.05};

/** One of the two masters in Operational. */
typedef struct subject {
    void *context;
    int (*receive)(void *context);
    void (*send)(void *context);
    cm1e_clock_t *clock;
    int64_t next_ns;
    int good;
} subject_t;

#define MEASURED __attribute__((noinline, noclone, used)) void
MEASURED measured_cycles(subject_t *subject, unsigned cycles);

static void fail(const char *why)
{
    fprintf(stderr, "bench_bus: %s\n", why);
    exit(1);
}

MEASURED measured_cycles(subject_t *subject, unsigned cycles)
{
    for (unsigned i = 0; i < cycles; i++) {
        subject->next_ns += MS_IN_NS;
        cm1e_clock_sleep_until(subject->clock, subject->next_ns);
        if (subject->receive(subject->context) != subject->good)
            fail("a cycle failed");
        subject->send(subject->context);
    }
    __asm__ volatile("" ::: "memory");
}

static void keep_least(double *least, double us) { *least = *least == 0 || us < *least ? us : *least; }

static double now_us(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec * 1e6 + (double)t.tv_nsec * 1e-3;
}

static double measured_us;
static cm1e_clock_t *soem_clock;

static void measure_subject(subject_t *subject)
{
    double batches[BATCHES];
    subject->next_ns = cm1e_clock_now(subject->clock);
    measured_cycles(subject, WARM);
    for (int batch = 0; batch < BATCHES; batch++) {
        const double began = now_us();
        measured_cycles(subject, BATCH_CYCLES);
        batches[batch] = (now_us() - began) / BATCH_CYCLES;
    }
    sort_values(batches, BATCHES);
    measured_us = batches[BATCHES / 2];
}

static int receive_ours(void *bus) { return (int)cm1e_bus_receive(bus); }
static void send_ours(void *bus) { cm1e_bus_send(bus); }

static void describe(cm1e_bus_config_t *config, unsigned drives)
{
    if (cm1e_bus_config_init(config, "sim", drives) != CM1E_OK)
        fail("so many drives cannot be configured");
    config->virtual_time = true;
}

static double measure_ours(unsigned drives)
{
    cm1e_bus_config_t config;
    cm1e_bus_t *bus;
    cm1e_diag_t diag = {0};
    describe(&config, drives);
    if (cm1e_bus_open(&bus, &config, &diag) != CM1E_OK || cm1e_bus_start(bus, &diag) != CM1E_OK)
        fail(diag.text);
    cm1e_bus_keep_none(true); /* as a scheduler does */
    subject_t subject = {bus, receive_ours, send_ours, cm1e_bus_clock(bus), 0, CM1E_OK};
    measure_subject(&subject);
    cm1e_bus_keep_none(false);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&config);
    return measured_us;
}

static unsigned soem_drives;

static void operate_soem(void *soem, int (*receive)(void *), void (*send)(void *))
{
    subject_t subject = {soem, receive, send, soem_clock, 0, 3 * (int)soem_drives};
    send(soem);
    measure_subject(&subject);
    receive(soem);
}

static double measure_soem(unsigned drives)
{
    cm1e_bus_config_t config;
    cm1e_nic_t *nic;
    cm1e_diag_t diag = {0};
    describe(&config, drives);
    if (cm1e_nic_open(&nic, &config, &diag) != CM1E_OK)
        fail(diag.text);
    soem_clock = cm1e_nic_clock(nic);
    soem_drives = drives;
    cm1e_clock_make_current(soem_clock);
    const start_soem_t start = {.nic = nic, .interface = "sim", .slaves = drives, .pdos = {PDO_OUTPUTS, PDO_INPUTS},
                                .operating = operate_soem};
    const char *why = start_soem_of_the_library(&start);
    if (why)
        fail(why);
    cm1e_clock_make_current(NULL);
    cm1e_nic_close(nic);
    cm1e_bus_config_free(&config);
    return measured_us;
}

/* ---- the wire ---------------------------------------------------------------------------------------------------- */

/** Microseconds of a cycle. */
typedef struct round {
    double median, late; /* late: 99 % are below */
} round_t;

static double between_us(struct timespec from, struct timespec to)
{
    return (double)(to.tv_sec - from.tv_sec) * 1e6 + (double)(to.tv_nsec - from.tv_nsec) * 1e-3;
}

static round_t last_round;
static const char *wire_name = "wire0"; /* of the library */

/** A cycle each millisecond. */
static void measure_wire(void *master, int (*receive)(void *), void (*send)(void *))
{
    static double us[WIRE_CYCLES];
    struct timespec due, began, ended;
    clock_gettime(CLOCK_MONOTONIC, &due);
    for (int n = -WARM; n < WIRE_CYCLES; n++) {
        due.tv_nsec += MS_IN_NS;
        due.tv_sec += due.tv_nsec / 1000000000;
        due.tv_nsec %= 1000000000;
        clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, NULL);
        clock_gettime(CLOCK_MONOTONIC, &began);
        send(master);
        receive(master);
        clock_gettime(CLOCK_MONOTONIC, &ended);
        if (n >= 0)
            us[n] = between_us(began, ended);
    }
    sort_values(us, WIRE_CYCLES);
    last_round = (round_t){us[WIRE_CYCLES / 2], us[WIRE_CYCLES * 99 / 100]};
}

static round_t ours_on_wire(unsigned drives)
{
    cm1e_bus_config_t config;
    cm1e_bus_t *bus;
    cm1e_diag_t diag = {0};
    if (cm1e_bus_config_init(&config, wire_name, drives) != CM1E_OK)
        fail("so many drives cannot be configured");
    if (cm1e_bus_open(&bus, &config, &diag) != CM1E_OK || cm1e_bus_start(bus, &diag) != CM1E_OK)
        fail(diag.text);
    cm1e_bus_keep_none(true);
    measure_wire(bus, receive_ours, send_ours);
    cm1e_bus_keep_none(false);
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&config);
    return last_round;
}

static round_t soem_on_wire(unsigned drives)
{
#ifdef START_WITH_PLAIN_SOEM
    const start_soem_t start = {.interface = "wire0", .slaves = drives, .pdos = {PDO_OUTPUTS, PDO_INPUTS},
                                .operating = measure_wire};
    const char *why = start_soem_of_its_own(&start);
    if (why)
        fail(why);
#else
    (void)drives;
    fail("the SOEM that this was built with has no port of its own");
#endif
    return last_round;
}

static void keep_best(round_t *best, round_t now)
{
    keep_least(&best->median, now.median);
    keep_least(&best->late, now.late);
}

static void tell_wire(unsigned drives, const char *what, double ours, double soem)
{
    printf("%6u %-7s %10.2f %10.2f %8.3f %8.2f  %s\n", drives, what, ours, soem, ours / soem, WIRE_TARGET,
           ours / soem <= WIRE_TARGET ? "pass" : "miss");
}

static void measure_veth(unsigned drives)
{
    round_t ours = {0}, soem = {0};
    const pid_t server = served_drives_begin(drives);
    for (int round = 0; round < ROUNDS; round++) {
        keep_best(&ours, ours_on_wire(drives));
        keep_best(&soem, soem_on_wire(drives));
    }
    served_drives_end(server);
    tell_wire(drives, "median", ours.median, soem.median);
    tell_wire(drives, "99 %", ours.late, soem.late);
}

static int veth(int words, char **word)
{
    if (!veth_make()) {
        printf("not measured: no network namespace can be made here\n");
        return 0;
    }
    printf("%6s %-7s %10s %10s %8s %8s\n", "drives", "veth", "cm1e, us", "SOEM, us", "ratio", "target");
    for (size_t i = 0; words == 2 && i < 2; i++)
        measure_veth(usual[i]);
    for (int i = 2; i < words; i++)
        measure_veth((unsigned)strtoul(word[i], NULL, 10));
    return 0;
}

/* ---- the table --------------------------------------------------------------------------------------------------- */

static void measure(unsigned drives, double target)
{
    double ours = 0, soem = 0;
    for (int round = 0; round < ROUNDS; round++) {
        keep_least(&ours, measure_ours(drives));
        keep_least(&soem, measure_soem(drives));
    }
    const double ratio = ours / soem;
    printf("%6u %10.3f %10.3f %8.3f %8.2f  %s\n", drives, ours, soem, ratio, target, ratio <= target ? "pass" : "miss");
}

int main(int words, char **word)
{
    if (words > 1 && strcmp(word[1], "--veth,xdp") == 0)
        wire_name = "wire0,xdp";
    if (words > 1 && strncmp(word[1], "--veth", 6) == 0)
        return veth(words, word);
    printf("%6s %10s %10s %8s %8s\n", "drives", "cm1e, us", "SOEM, us", "ratio", "target");
    for (size_t i = 0; words == 1 && i < sizeof usual / sizeof usual[0]; i++)
        measure(usual[i], targets[i]);
    for (int i = 1; i < words; i++)
        measure((unsigned)strtoul(word[i], NULL, 10), targets[0]);
    return 0;
}
