/**
 * How long a start to Operational takes, beside bare SOEM, which goes from slave to slave.
 *
 *     bench_start [DRIVES ...]           simulated time and frames, in this process: 1, 32 and 100 drives
 *     bench_start --phases [DRIVES ...]  of each phase
 *     bench_start --cycle US DRIVES      with this cycle time, which is 1000 us otherwise
 *     bench_start --veth [DRIVES ...]    over a pair of network interfaces of a namespace of its own, simulated drives
 *                                        in another process, and SOEM with its own port: real time, best of some rounds
 *
 * SOEM does what its simple_test does, without distributed clocks, and assigns the PDOs that the library assigns. It
 * compares no identity, reads no firmware and sets no watchdog; the library does all of this.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "served_drives.h"
#include "start_soem.h"
#include "support/veth.h"

enum { ROUNDS = 5, SUBJECTS = 2, PDO_OUTPUTS = 0x1600, PDO_INPUTS = 0x1A00 };
static const unsigned usual[] = {1, 32, 100};
static const double targets[] = {1.0, 0.33, 0.33};

typedef struct cost {
    double ms;
    uint64_t frames;
} cost_t;

static cm1e_clock_t *running;
static uint64_t frames;
static cost_t phase_began;
static bool show_phases;
static long cycle_us = 1000;

static void fail(const char *why)
{
    fprintf(stderr, "bench_start: %s\n", why);
    exit(1);
}

static double now_ms(void) { return (double)cm1e_clock_now(running) * 1e-6; }

static cm1e_tap_verdict_t count(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    frames += frame->direction == CM1E_TAP_SENT;
    return CM1E_TAP_PASS;
}

static void begin(cm1e_clock_t *clock)
{
    running = clock;
    frames = 0;
    phase_began = (cost_t){now_ms(), 0};
}

static void end_of_phase(const char *name)
{
    const double ms = now_ms();
    if (show_phases)
        printf("    %-18s %9.2f ms %7llu frames\n", name, ms - phase_began.ms,
               (unsigned long long)(frames - phase_began.frames));
    phase_began = (cost_t){ms, frames};
}

static void describe(cm1e_bus_config_t *config, const char *interface, unsigned drives)
{
    if (cm1e_bus_config_init(config, interface, drives) != CM1E_OK)
        fail("so many drives cannot be configured");
    config->virtual_time = strcmp(interface, "sim") == 0;
    config->cycle_time_ns = cycle_us * 1000;
}

/* ---- the library ------------------------------------------------------------------------------------------------- */

static void run_phases(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    static const struct {
        const char *name;
        cm1e_error_t (*step)(cm1e_bus_t *, cm1e_diag_t *);
    } steps[] = {{"scan", cm1e_bus_scan}, {"identify", cm1e_bus_identify}, {"configure", cm1e_bus_configure},
                 {"operate", cm1e_bus_operate}};
    for (size_t i = 0; i < sizeof steps / sizeof steps[0]; i++) {
        if (steps[i].step(bus, diag) != CM1E_OK)
            fail(diag->text);
        end_of_phase(steps[i].name);
    }
}

static cost_t start_ours(const char *interface, unsigned drives)
{
    cm1e_bus_config_t config;
    cm1e_bus_t *bus;
    cm1e_diag_t diag = {0};
    describe(&config, interface, drives);
    if (cm1e_bus_open(&bus, &config, &diag) != CM1E_OK)
        fail(diag.text);
    cm1e_nic_set_tap(bus->nic, count, NULL);
    begin(cm1e_bus_clock(bus));
    const double began = now_ms();
    run_phases(bus, &diag);
    const cost_t cost = {now_ms() - began, frames};
    cm1e_bus_close(bus);
    cm1e_bus_config_free(&config);
    return cost;
}

/* ---- bare SOEM --------------------------------------------------------------------------------------------------- */

static cost_t start_soem_in_process(const char *interface, unsigned drives)
{
    cm1e_bus_config_t config;
    cm1e_nic_t *nic;
    cm1e_diag_t diag = {0};
    describe(&config, interface, drives);
    if (cm1e_nic_open(&nic, &config, &diag) != CM1E_OK)
        fail(diag.text);
    cm1e_nic_set_tap(nic, count, NULL);
    cm1e_clock_make_current(cm1e_nic_clock(nic));
    begin(cm1e_nic_clock(nic));
    const double began = now_ms();
    const start_soem_t start = {.nic = nic, .interface = interface, .slaves = drives,
                                .pdos = {PDO_OUTPUTS, PDO_INPUTS}, .phase = end_of_phase};
    const char *why = start_soem_of_the_library(&start);
    if (why)
        fail(why);
    const cost_t cost = {phase_began.ms - began, phase_began.frames};
    cm1e_clock_make_current(NULL);
    cm1e_nic_close(nic);
    cm1e_bus_config_free(&config);
    return cost;
}

#ifdef START_WITH_PLAIN_SOEM
static cost_t start_soem_on_wire(const char *interface, unsigned drives)
{
    begin(cm1e_clock_monotonic());
    const double began = now_ms();
    const start_soem_t start = {.interface = interface, .slaves = drives, .pdos = {PDO_OUTPUTS, PDO_INPUTS},
                                .phase = end_of_phase};
    const char *why = start_soem_of_its_own(&start);
    if (why)
        fail(why);
    return (cost_t){phase_began.ms - began, 0};
}
#else
static cost_t start_soem_on_wire(const char *interface, unsigned drives)
{
    (void)interface, (void)drives;
    fail("the SOEM that this was built with has no port of its own");
    return (cost_t){0};
}
#endif

/* ---- the wire ---------------------------------------------------------------------------------------------------- */

static void keep_best(cost_t *best, cost_t cost)
{
    if (best->ms == 0 || cost.ms < best->ms)
        *best = cost;
}

static void measure_on_wire(unsigned drives, cost_t best[SUBJECTS])
{
    const pid_t server = served_drives_begin(drives);
    for (int round = 0; round < ROUNDS; round++) {
        keep_best(&best[0], start_ours("wire0", drives));
        keep_best(&best[1], start_soem_on_wire("wire0", drives));
    }
    served_drives_end(server);
}

static void measure_in_process(unsigned drives, cost_t costs[SUBJECTS])
{
    if (show_phases)
        printf("%u drives, cm1e\n", drives);
    costs[0] = start_ours("sim", drives);
    if (show_phases)
        printf("%u drives, SOEM\n", drives);
    costs[1] = start_soem_in_process("sim", drives);
}

static double target_of(unsigned drives)
{
    for (size_t i = 0; i < sizeof usual / sizeof usual[0]; i++)
        if (usual[i] == drives)
            return targets[i];
    return drives == 1 ? targets[0] : targets[1];
}

static bool measure(unsigned drives, bool wire)
{
    cost_t costs[SUBJECTS] = {{0}};
    (wire ? measure_on_wire : measure_in_process)(drives, costs);
    const double ratio = costs[0].ms / costs[1].ms, target = target_of(drives);
    printf("%-10s %6u %10.2f %10.2f %8.3f %8.2f  %s", wire ? "veth" : "in process", drives, costs[0].ms, costs[1].ms,
           ratio, target, ratio <= target ? "pass" : "miss");
    if (!wire)
        printf("   %llu and %llu frames", (unsigned long long)costs[0].frames, (unsigned long long)costs[1].frames);
    printf("\n");
    return ratio <= target;
}

int main(int count_of_words, char **words)
{
    bool wire = false, passed = true;
    int first = 1;
    for (; first < count_of_words && words[first][0] == '-'; first++) {
        wire |= strcmp(words[first], "--veth") == 0;
        show_phases |= strcmp(words[first], "--phases") == 0;
        if (strcmp(words[first], "--cycle") == 0 && first + 1 < count_of_words)
            cycle_us = strtol(words[++first], NULL, 10);
    }
    if (wire && !veth_make()) {
        printf("not measured: no network namespace can be made here\n");
        return 0;
    }
    printf("%-10s %6s %10s %10s %8s %8s\n", wire ? "real ms" : "sim. ms", "drives", "cm1e", "SOEM", "ratio", "target");
    if (first == count_of_words)
        for (size_t i = 0; i < sizeof usual / sizeof usual[0]; i++)
            passed &= measure(usual[i], wire);
    for (; first < count_of_words; first++)
        passed &= measure((unsigned)strtoul(words[first], NULL, 10), wire);
    return passed ? 0 : 1;
}
