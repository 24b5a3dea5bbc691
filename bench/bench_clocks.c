/**
 * How exact distributed clocks are, over simulated days: four slaves whose crystals differ, follow the temperature
 * and jitter, one frame a cycle that carries the time (FRMW 0x0910), and the controller by which the cycle follows the
 * reference. The clocks are measured against each other by the exact time of the simulation, at every 100th cycle,
 * half-way between two frames. docs/CLOCKS.md has the figures.
 *
 * bench_clocks [DAYS [bus]]: simulated days of each row; default 1. bus: the whole bus only.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bus/bus_image.h"
#include "bus/dc_pace.h"
#include "cm1e/clocks.h"
#include "cm1e/sim.h"
#include "core/bytes.h"

enum { SLAVES = 4, HOP_NS = 700, STATION = 0x1001, HEADER = 16, DATAGRAM = 10, SETTLING_S = 120, BUCKETS = 20000 };
enum { APRD = 1, APWR = 2, FRMW = 14 };

typedef struct scenario {
    const char *name;
    int64_t cycle_ns;
    double daily_kelvin;  /* half of the swing from day to night */
    double step_kelvin;   /* up or down, every two hours */
    double latency_ns;    /* mean of the wake-up latency of the master, exponential, at most ten times that */
    unsigned lost;        /* one frame of so many is lost; 0: none */
} scenario_t;

/* Absolute values in whole ns; the last bucket holds all larger ones. */
typedef struct spread {
    uint64_t buckets[BUCKETS], count;
    double maximum;
} spread_t;

static cm1e_sim_segment_t *segment;
static int64_t now_ns;
static uint64_t chance = 1;

static double random_part(void)
{
    chance = chance * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(chance >> 11) / (double)(UINT64_C(1) << 53);
}

static void add(spread_t *spread, double value)
{
    const double size = fabs(value);
    spread->buckets[size < BUCKETS - 1 ? (size_t)size : BUCKETS - 1]++;
    spread->count++;
    spread->maximum = fmax(spread->maximum, size);
}

static double quantile(const spread_t *spread, double part)
{
    uint64_t below = 0;
    for (size_t i = 0; i < BUCKETS; i++)
        if ((double)(below += spread->buckets[i]) >= part * (double)spread->count)
            return (double)i;
    return BUCKETS;
}

/* ---- frames ------------------------------------------------------------------------------------------------------ */

static void transfer(uint8_t command, uint16_t address, uint16_t offset, uint8_t *data, uint16_t length)
{
    uint8_t frame[64] = {[12] = 0x88, [13] = 0xA4};
    cm1e_put_u16(frame + 14, (uint16_t)((DATAGRAM + length + 2) | 0x1000));
    frame[HEADER] = command;
    cm1e_put_u16(frame + HEADER + 2, address);
    cm1e_put_u16(frame + HEADER + 4, offset);
    cm1e_put_u16(frame + HEADER + 6, length);
    memcpy(frame + HEADER + DATAGRAM, data, length);
    cm1e_sim_segment_process(segment, CM1E_SIM_PORT_PRIMARY, frame, sizeof frame, now_ns);
    memcpy(data, frame + HEADER + DATAGRAM, length);
}

static uint64_t system_time(uint16_t slave)
{
    uint8_t data[8] = {0};
    transfer(APRD, (uint16_t)-slave, 0x0910, data, 8);
    return cm1e_get_u64(data);
}

static void console(int slave, const char *what, double value)
{
    char line[60], answer[100];
    snprintf(line, sizeof line, "clock %d %s %.6g", slave, what, value);
    cm1e_sim_console(segment, line, answer, sizeof answer);
}

static void set_up(void)
{
    static const double ppm[SLAVES] = {35, -48, 22, -7};
    segment = cm1e_sim_segment_create_empty();
    for (uint16_t i = 0; i < SLAVES; i++) {
        uint8_t data[8];
        cm1e_sim_segment_add_io(segment, CM1E_SIM_IO_COUPLER);
        console(i + 1, "drift", ppm[i]);
        console(i + 1, "jitter", 10);
        cm1e_put_u16(data, (uint16_t)(STATION + i));
        transfer(APWR, (uint16_t)-i, 0x0010, data, 2);
        cm1e_put_u64(data, system_time(0) + i * HOP_NS - system_time(i));
        transfer(APWR, (uint16_t)-i, 0x0920, data, 8);
        cm1e_put_u32(data, i * HOP_NS);
        transfer(APWR, (uint16_t)-i, 0x0928, data, 4);
    }
}

/* ---- days -------------------------------------------------------------------------------------------------------- */

/* Each slave stands in another place: its temperature comes an hour after that of the one before. */
static void change_temperature(const scenario_t *scenario, double seconds)
{
    for (int i = 0; i < SLAVES; i++) {
        const double hours = seconds / 3600 + i;
        const double step = (int)(hours / 2) % 2 ? scenario->step_kelvin : -scenario->step_kelvin;
        console(i + 1, "temperature", scenario->daily_kelvin * sin(hours / 24 * 2 * 3.14159265358979) + step);
    }
}

static double ahead_ns(const cm1e_sim_clock_t *reference, uint32_t position)
{
    cm1e_sim_clock_t clock;
    cm1e_sim_segment_clock(segment, position, &clock);
    return (double)(clock.system_ns - reference->system_ns) - (double)(clock.time_ns - reference->time_ns);
}

static double worst_ns(spread_t *clocks)
{
    cm1e_sim_clock_t reference;
    double worst = 0;
    cm1e_sim_segment_clock(segment, 1, &reference);
    for (uint32_t i = 2; i <= SLAVES; i++) {
        const double ahead = ahead_ns(&reference, i);
        worst = fmax(worst, fabs(ahead));
        if (clocks)
            add(clocks, ahead);
    }
    return worst;
}

static double wake_up(const scenario_t *scenario)
{
    return scenario->latency_ns > 0 ? fmin(-log(1 - random_part()), 10) * scenario->latency_ns : 0;
}

static void run(const scenario_t *scenario, double days)
{
    static spread_t clocks, phases, periods;
    cm1e_dc_pace_t pace = {0};
    memset(&clocks, 0, sizeof clocks);
    memset(&phases, 0, sizeof phases);
    memset(&periods, 0, sizeof periods);
    now_ns = 1000000;
    set_up();
    cm1e_dc_pace_begin(&pace, scenario->cycle_ns);
    int64_t planned_ns = now_ns + scenario->cycle_ns * 4 / 10; /* any phase */
    double together_s = -1, in_phase_s = -1;
    const int64_t cycles = (int64_t)(days * 86400e9 / (double)scenario->cycle_ns);
    const int64_t settling = SETTLING_S * INT64_C(1000000000) / scenario->cycle_ns;
    for (int64_t n = 0; n < cycles; n++) {
        const double seconds = (double)n * (double)scenario->cycle_ns * 1e-9;
        uint8_t time[8] = {0};
        if (n % (60000000000 / scenario->cycle_ns) == 0)
            change_temperature(scenario, seconds);
        const int64_t latency_ns = (int64_t)wake_up(scenario);
        now_ns = planned_ns + latency_ns;
        int64_t later_ns;
        const bool lost = scenario->lost && random_part() * scenario->lost < 1;
        if (lost) {
            later_ns = cm1e_dc_pace_coast(&pace);
        } else {
            transfer(FRMW, STATION, 0x0910, time, 8);
            later_ns = cm1e_dc_pace_step(&pace, (int64_t)cm1e_get_u64(time));
        }
        if (n % 100 == 0) /* between two frames */
            cm1e_sim_segment_advance(segment, now_ns += scenario->cycle_ns / 2);
        const double worst = n % 100 == 0 ? worst_ns(n > settling ? &clocks : NULL) : -1;
        if (worst > 100)
            together_s = n > settling ? together_s : -1;
        else if (worst >= 0 && together_s < 0)
            together_s = seconds;
        if (in_phase_s < 0 && cm1e_dc_pace_settled(&pace))
            in_phase_s = seconds;
        if (n > settling && !lost) {
            /* The plan without this cycle's latency; its mean is compensated. */
            add(&phases, (double)(pace.error_ns - latency_ns) + scenario->latency_ns);
            add(&periods, (double)later_ns - pace.rate_ns);
        }
        planned_ns += scenario->cycle_ns + later_ns;
    }
    printf("| %s | %lld | %.2f | %.2f | %.0f | %.0f | %.0f | %.0f | %.0f | %.0f |\n", scenario->name,
           (long long)(scenario->cycle_ns / 1000), together_s, in_phase_s, quantile(&clocks, 0.5),
           quantile(&clocks, 0.999), clocks.maximum, quantile(&phases, 0.999), phases.maximum, periods.maximum);
    fflush(stdout);
    cm1e_sim_segment_destroy(segment);
}

/* ---- the bus itself ---------------------------------------------------------------------------------------------- */

static cm1e_bus_t *start_bus(void)
{
    cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    cm1e_bus_t *bus = NULL;
    cm1e_bus_config_init(&config, "sim", 3);
    config.virtual_time = true;
    snprintf(config.axes[1].device, sizeof config.axes[1].device, "cia402");
    config.axes[1].counts_per_revolution = 131072;
    config.axes[1].max_speed_rpm = 3000;
    config.axes[1].dc.sync0_us = 1000;
    if (cm1e_bus_open(&bus, &config, &diag) == CM1E_OK) {
        segment = cm1e_bus_segment(bus);
        console(1, "drift", 35);
        console(2, "drift", -48);
        console(3, "drift", 22);
        cm1e_bus_start(bus, &diag);
    }
    cm1e_bus_config_free(&config);
    if (diag.error != CM1E_OK) {
        fprintf(stderr, "%s\n", diag.text);
        exit(1);
    }
    return bus;
}

/* A CM1-E, a drive by SYNC0, a CM1-E; all that the library does in a cycle. */
static void run_bus(double days)
{
    static spread_t clocks;
    const scenario_t steps = {.step_kelvin = 10};
    cm1e_bus_t *bus = start_bus();
    cm1e_clock_t *clock = cm1e_bus_clock(bus);
    int64_t planned_ns = cm1e_bus_next_start(bus, cm1e_clock_now(clock));
    double phase_ns = 0, apart_ns = 0;
    uint64_t bad = 0;
    for (int64_t n = 0; n < (int64_t)(days * 86400e3); n++) {
        cm1e_bus_clocks_t all;
        cm1e_slave_clock_t drive;
        cm1e_sim_clock_t reference;
        cm1e_clock_sleep_until(clock, planned_ns);
        bad += cm1e_bus_receive(bus) != CM1E_OK && n > 0;
        cm1e_bus_send(bus);
        planned_ns += 1000000 + cm1e_bus_pace(bus);
        if (n % 60000 == 0)
            for (int i = 1; i <= 3; i++) {
                const int hours = (int)(n / 3600000) + i;
                console(i, "temperature", hours / 2 % 2 ? steps.step_kelvin : -steps.step_kelvin);
            }
        if (n % 100 || n < 60000)
            continue;
        cm1e_sim_segment_clock(segment, 1, &reference);
        for (uint32_t i = 2; i <= 3; i++)
            add(&clocks, ahead_ns(&reference, i));
        cm1e_bus_clocks(bus, &all);
        cm1e_bus_slave_clock(bus, 2, &drive);
        phase_ns = fmax(phase_ns, fabs(all.phase_mean_ns));
        apart_ns = drive.maximum_ns;
        bad += all.sync_losses;
    }
    printf("\nThe whole bus, 1 ms, steps of 20 K, %g days: clocks apart %.0f ns (median), %.0f ns (99.9 %%), %.0f ns "
           "(largest); 0x092C of the drive up to %.0f ns; phase of the cycle up to %.0f ns; %llu lost frames and losses "
           "of synchronism\n", days, quantile(&clocks, 0.5), quantile(&clocks, 0.999), clocks.maximum, apart_ns, phase_ns,
           (unsigned long long)bad);
    cm1e_bus_close(bus);
}

int main(int argc, char **argv)
{
    static const scenario_t scenarios[] = {
        {"constant temperature", 1000000, 0, 0, 0, 0},
        {"10 K from day to night", 1000000, 5, 0, 0, 0},
        {"steps of 20 K every two hours", 1000000, 0, 10, 0, 0},
        {"the same, at 250 us", 250000, 0, 10, 0, 0},
        {"steps, wake-up latency 20 us on average", 1000000, 0, 10, 20000, 0},
        {"steps, latency, one frame of 10,000 lost", 1000000, 0, 10, 20000, 10000},
    };
    const double days = argc > 1 ? atof(argv[1]) : 1;
    const bool bus_only = argc > 2 && strcmp(argv[2], "bus") == 0;
    if (!bus_only)
        printf("| %g simulated days each | cycle, us | clocks together, s | cycle in phase, s | clocks apart, ns: median "
               "| 99.9 %% | largest | plan of the cycle off its phase, ns: 99.9 %% | largest | jitter of the period, ns "
               "|\n|---|---|---|---|---|---|---|---|---|---|\n", days);
    for (size_t i = 0; !bus_only && i < sizeof scenarios / sizeof scenarios[0]; i++)
        run(&scenarios[i], days);
    run_bus(days);
    return 0;
}
