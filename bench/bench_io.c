/**
 * What signals of I/O terminals cost in a cycle: 32 inputs and 32 outputs on eight digital terminals beside four motors,
 * first unused, then every input read and every output written in each cycle. Virtual time, so nothing sleeps; the
 * figures are processor time, and include the simulated segment.
 */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "bus/bus_image.h"
#include "cm1e/io.h"
#include "sort.h"

enum { TERMINALS = 8, CHANNELS = 8, SIGNALS = TERMINALS * CHANNELS, AXES = 4, BATCHES = 40, BATCH_CYCLES = 5000 };
enum { CALLS = 1000000 };

static cm1e_io_t signals[SIGNALS];

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + (double)t.tv_nsec * 1e-9;
}

static double median(double *values, size_t count)
{
    sort_values(values, count);
    return values[count / 2];
}

static void fail(const char *text)
{
    fprintf(stderr, "%s\n", text);
    exit(1);
}

/** Terminals with 8 outputs and with 8 inputs in turn, then the motors. */
static cm1e_bus_t *start_bus(int64_t cycle_ns)
{
    cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    cm1e_bus_t *bus = NULL;
    cm1e_bus_config_init(&config, "sim", AXES);
    config.virtual_time = true;
    config.cycle_time_ns = cycle_ns;
    for (unsigned i = 0; i < AXES; i++)
        config.axes[i].address = (uint16_t)(TERMINALS + 1 + i);
    for (unsigned i = 0; i < TERMINALS; i++) {
        cm1e_slave_config_t *slave = cm1e_bus_config_add_slave(&config, NULL);
        slave->address = (uint16_t)(i + 1);
        slave->sim = (cm1e_sim_slave_config_t){.kind = CM1E_SIM_SLAVE_DIGITAL, .inputs = i % 2 ? CHANNELS : 0,
                                               .outputs = i % 2 ? 0 : CHANNELS};
    }
    if (cm1e_bus_open(&bus, &config, &diag) != CM1E_OK || cm1e_bus_start(bus, &diag) != CM1E_OK)
        fail(diag.text);
    cm1e_bus_config_free(&config);
    return bus;
}

static void find_signals(cm1e_bus_t *bus)
{
    cm1e_diag_t diag = {0};
    for (unsigned i = 0; i < SIGNALS; i++) {
        char name[32];
        snprintf(name, sizeof name, "%u.%s %u", i / CHANNELS + 1, i / CHANNELS % 2 ? "input" : "output",
                 i % CHANNELS + 1);
        if (cm1e_io_find(bus, name, &signals[i], &diag) != CM1E_OK)
            fail(diag.text);
    }
}

/** All 64; the outputs go on and off one behind the other. */
static unsigned use_signals(unsigned cycle)
{
    unsigned on = 0;
    for (unsigned i = 0; i < SIGNALS; i++)
        if (signals[i].output)
            cm1e_io_set_bool(&signals[i], cycle >> i % 16 & 1);
        else
            on += cm1e_io_bool(&signals[i]);
    return on;
}

/** us per cycle, median of the batches; those with and without signals take turns, so that both see the same machine. */
static void bench_cycles(cm1e_bus_t *bus, int64_t cycle_ns, double us[2])
{
    static double batches[2][BATCHES];
    static volatile unsigned seen;
    cm1e_clock_t *clock = cm1e_bus_clock(bus);
    int64_t next = cm1e_clock_now(clock);
    for (int batch = 0; batch < 2 * BATCHES; batch++) {
        const int used = batch % 2;
        const double start = now_s();
        for (unsigned i = 0; i < BATCH_CYCLES; i++) {
            next += cycle_ns;
            cm1e_clock_sleep_until(clock, next);
            if (cm1e_bus_receive(bus) != CM1E_OK)
                fail("a cycle failed");
            if (used)
                seen += use_signals(i);
            cm1e_bus_send(bus);
        }
        batches[used][batch / 2] = (now_s() - start) / BATCH_CYCLES * 1e6;
    }
    us[0] = median(batches[0], BATCHES);
    us[1] = median(batches[1], BATCHES);
}

/** ns of one call, over and over. */
static double bench_call(const char *what, const cm1e_io_t *io)
{
    static volatile int64_t sum;
    const double start = now_s();
    for (int i = 0; i < CALLS; i++)
        switch (what[0]) {
        case 'r': sum += cm1e_io_bool(io); break;
        case 'w': cm1e_io_set_bool(io, i & 1); break;
        default: sum += (int64_t)cm1e_io_quality(io); break;
        }
    return (now_s() - start) / CALLS * 1e9;
}

int main(void)
{
    printf("%-10s %18s %18s %20s\n", "cycle us", "without us/cycle", "with 64 us/cycle", "a signal ns");
    for (int c = 0; c < 2; c++) {
        const int64_t cycle_ns = c ? 250000 : 1000000;
        cm1e_bus_t *bus = start_bus(cycle_ns);
        double us[2];
        find_signals(bus);
        bench_cycles(bus, cycle_ns, us);
        printf("%-10d %18.2f %18.2f %20.1f\n", (int)(cycle_ns / 1000), us[0], us[1], (us[1] - us[0]) / SIGNALS * 1e3);
        if (c)
            printf("\none call: read %.1f ns, write %.1f ns, quality %.1f ns\n", bench_call("read", &signals[CHANNELS]),
                   bench_call("write", &signals[0]), bench_call("quality", &signals[CHANNELS]));
        cm1e_bus_close(bus);
    }
    return 0;
}
