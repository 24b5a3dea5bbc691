/**
 * What others cost who are attached to a running program: one run at 250 us on the simulated segment, four axes turning,
 * in turns alone and with three readers of objects, a screen that asks for axes, slaves and statistics, and a recorder
 * of every cycle of 64 signals, half of them variables of the program, each a process of its own. Real time: the
 * figures are those of this machine at this time. Overruns are rare and come by chance, so their difference is told with
 * its standard error.
 *
 *     bench_control [TURNS]      of 3 s each, alone and attached; default 10
 */
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "cm1e/control.h"
#include "cm1e/plcopen.h"
#include "cm1e/scheduler.h"
#include "cm1e/trace.h"

enum { AXES = 4, READERS = 3, SCREEN = READERS, RECORDER, CLIENTS, SCREEN_US = 50000, RECORDER_US = 20000 };
enum { VARIABLES = 32 /* with those of the axes and of the timing 64 signals */ };
enum { TURNS = 10, TURNS_MAX = 1000, TURN_S = 3, LATE_BUCKET = 8 /* from 128 us on */ };

/** Shared with the clients. */
typedef struct shared {
    atomic_bool go, end;
    atomic_uint requests[CLIENTS];
    atomic_uint columns, samples, gaps; /**< of the recorder */
} shared_t;

typedef struct side {
    uint64_t cycles, overruns, late, lost, requests;
} side_t;

static cm1e_bus_t *bus;
static cm1e_scheduler_t *scheduler;
static MC_Power_t powers[AXES];
static MC_MoveVelocity_t moves[AXES];
static AXIS_REF_t axes[AXES];
static double variables[VARIABLES];

static void fail(const char *text)
{
    fprintf(stderr, "%s\n", text);
    exit(1);
}

/* ---- the clients ------------------------------------------------------------------------------------------------- */

static void ask_all(cm1e_control_t *control)
{
    static const char *const requests[] = {"{\"request\": \"axes\"}", "{\"request\": \"slaves\"}",
                                           "{\"request\": \"statistics\"}"};
    for (size_t i = 0; i < sizeof requests / sizeof *requests; i++) {
        char *reply;
        if (cm1e_control_ask(control, requests[i], &reply, NULL) != CM1E_OK)
            exit(0); /* the run has ended */
        free(reply);
    }
}

/** A number of a reply, "name": number; 0: it has none. */
static unsigned number_of(const char *reply, const char *name)
{
    const char *place = strstr(reply, name);
    return place ? (unsigned)strtoul(place + strlen(name), NULL, 10) : 0;
}

static void record(shared_t *shared, cm1e_control_t *control, bool first)
{
    char *reply;
    if (cm1e_control_ask(control, first ? "{\"request\": \"record\"}" : "{\"request\": \"samples\"}", &reply, NULL) !=
        CM1E_OK)
        exit(0);
    unsigned columns = 0;
    for (const char *at = reply; first && (at = strstr(at, "\"unit\"")) != NULL; at++)
        columns++;
    if (first)
        atomic_store(&shared->columns, columns);
    atomic_fetch_add(&shared->samples, number_of(reply, "\"samples\":{\"samples\":"));
    atomic_fetch_add(&shared->gaps, number_of(reply, "\"lost\":") > 0);
    free(reply);
    usleep(RECORDER_US);
}

static void read_object(cm1e_bus_t *attached, uint16_t position)
{
    uint8_t data[8];
    size_t size = sizeof data;
    if (cm1e_sdo_read(attached, position, 0x1018, 1, data, &size, NULL) != CM1E_OK)
        exit(0);
}

static void run_client(shared_t *shared, int number, pid_t program)
{
    char target[16];
    cm1e_control_t *control = NULL;
    cm1e_bus_t *attached = NULL;
    cm1e_bus_config_t config;
    snprintf(target, sizeof target, "%d", (int)program);
    cm1e_bus_config_init(&config, NULL, 0);
    while (!atomic_load(&shared->go))
        usleep(1000);
    if (number != RECORDER && cm1e_control_connect(&control, target, NULL, NULL) != CM1E_OK)
        fail("a client cannot connect");
    if (number < READERS && (cm1e_bus_open_attached(&attached, &config, control, NULL) != CM1E_OK ||
                             cm1e_bus_scan(attached, NULL) != CM1E_OK))
        fail("a client cannot attach");
    while (!atomic_load(&shared->end)) {
        if (!atomic_load(&shared->go)) {
            if (number == RECORDER) { /* a recording goes on as long as its connection */
                cm1e_control_close(control);
                control = NULL;
            }
            usleep(1000);
            continue;
        }
        const bool first = !control;
        if (first && cm1e_control_connect(&control, target, NULL, NULL) != CM1E_OK)
            exit(0);
        if (attached)
            read_object(attached, (uint16_t)(1 + number));
        else if (number == RECORDER)
            record(shared, control, first);
        else
            ask_all(control);
        atomic_fetch_add(&shared->requests[number], number == SCREEN ? 3 : 1);
        if (number == SCREEN)
            usleep(SCREEN_US);
    }
    exit(0);
}

/* ---- the program ------------------------------------------------------------------------------------------------- */

static void program(void *context)
{
    (void)context;
    for (int i = 0; i < VARIABLES; i++)
        variables[i] += i;
    for (int i = 0; i < AXES; i++) {
        powers[i].Axis = moves[i].Axis = &axes[i];
        powers[i].Enable = powers[i].EnablePositive = powers[i].EnableNegative = TRUE;
        MC_Power(&powers[i]);
        moves[i].Execute = powers[i].Status;
        moves[i].Velocity = 2.0;
        MC_MoveVelocity(&moves[i]);
    }
}

static void name_variables(void)
{
    cm1e_diag_t diag = {0};
    char name[32];
    for (int i = 0; i < VARIABLES; i++) {
        snprintf(name, sizeof name, "variable %d", i);
        if (cm1e_scheduler_trace_variable(scheduler, name, "", CM1E_TRACE_LREAL, &variables[i], &diag) != CM1E_OK)
            fail(diag.text);
    }
}

static void *run(void *context)
{
    cm1e_diag_t diag = {0};
    (void)context;
    if (cm1e_scheduler_run(scheduler, 0, &diag) != CM1E_OK)
        fail(diag.text);
    return NULL;
}

static void start(void)
{
    cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    const cm1e_task_config_t task = {.program = program};
    cm1e_bus_config_init(&config, "sim", AXES);
    config.cycle_time_ns = 250000;
    config.lost_cycles_limit = 200;
    for (int i = 0; i < AXES; i++)
        config.axes[i].sim.no_stops = config.axes[i].sim.no_sensors = true;
    if (cm1e_bus_open(&bus, &config, &diag) != CM1E_OK || cm1e_bus_start(bus, &diag) != CM1E_OK ||
        cm1e_scheduler_create(&scheduler, bus, NULL, &diag) != CM1E_OK ||
        cm1e_scheduler_add_task(scheduler, &task, &diag) != CM1E_OK)
        fail(diag.text);
    name_variables();
    for (uint32_t i = 0; i < AXES; i++)
        axes[i] = cm1e_scheduler_axis(scheduler, i);
}

static void add(side_t *side, const cm1e_scheduler_statistics_t *after, const cm1e_scheduler_statistics_t *before)
{
    side->cycles += after->cycles - before->cycles;
    side->overruns += after->overruns - before->overruns;
    side->lost += after->bus.lost_frames - before->bus.lost_frames;
    for (int i = LATE_BUCKET; i < CM1E_HISTOGRAM_BUCKETS; i++)
        side->late += after->wake_up_latency.histogram[i] - before->wake_up_latency.histogram[i];
}

static void print(const char *name, const side_t *side, int turns)
{
    printf("%-10s %10llu %10llu %14.1f %18llu %12llu %14.0f\n", name, (unsigned long long)side->cycles,
           (unsigned long long)side->overruns, 1e6 * (double)side->overruns / (double)side->cycles,
           (unsigned long long)side->late, (unsigned long long)side->lost,
           (double)side->requests / (double)(turns * TURN_S));
}

/** The variance of a sum of turns is that of the turns, which the run itself shows: overruns come in bursts. */
static void print_difference(const double *differences, int turns)
{
    double sum = 0, squares = 0;
    for (int i = 0; i < turns; i++)
        sum += differences[i];
    for (int i = 0; i < turns; i++)
        squares += (differences[i] - sum / turns) * (differences[i] - sum / turns);
    const double error = sqrt(squares * turns / (turns - 1));
    printf("attached - alone: %+.0f overruns, standard error %.0f: %s\n", sum, error,
           sum <= 2 * error ? "no more than chance makes" : "more than chance makes");
}

int main(int count, char *words[])
{
    const int turns = count > 1 ? atoi(words[1]) : TURNS;
    static double differences[TURNS_MAX];
    if (turns < 2 || turns > TURNS_MAX)
        fail("bench_control [TURNS]: 2 to 1000 turns");
    shared_t *shared = mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    const pid_t self = getpid();
    pthread_t thread;
    side_t sides[2] = {0};
    cm1e_scheduler_statistics_t before, after;
    if (shared == MAP_FAILED)
        fail("no memory");
    for (int i = 0; i < CLIENTS; i++)
        if (fork() == 0)
            run_client(shared, i, self);
    start();
    if (pthread_create(&thread, NULL, run, NULL) != 0)
        fail("no thread");
    sleep(1);
    for (int turn = 0; turn < 2 * turns; turn++) {
        const int side = turn % 2;
        atomic_store(&shared->go, side == 1);
        usleep(100000); /* the others begin or end */
        uint64_t requests = 0;
        for (int i = 0; i < CLIENTS; i++)
            requests -= atomic_load(&shared->requests[i]);
        cm1e_scheduler_statistics(scheduler, &before);
        sleep(TURN_S);
        cm1e_scheduler_statistics(scheduler, &after);
        for (int i = 0; i < CLIENTS; i++)
            requests += atomic_load(&shared->requests[i]);
        add(&sides[side], &after, &before);
        differences[turn / 2] += (side == 1 ? 1.0 : -1.0) * (double)(after.overruns - before.overruns);
        sides[side].requests += requests;
    }
    atomic_store(&shared->end, true);
    for (int i = 0; i < CLIENTS; i++)
        wait(NULL);
    cm1e_scheduler_stop(scheduler);
    pthread_join(thread, NULL);
    printf("%d axes at 250 us, %s\n", AXES, after.realtime ? "real time" : "not real time");
    printf("%-10s %10s %10s %14s %18s %12s %14s\n", "", "cycles", "overruns", "per million", "later than 128 us",
           "lost frames", "requests/s");
    print("alone", &sides[0], turns);
    print("attached", &sides[1], turns);
    print_difference(differences, turns);
    printf("recorded: %u signals, %u samples, losses in %u replies\n", atomic_load(&shared->columns),
           atomic_load(&shared->samples), atomic_load(&shared->gaps));
    cm1e_scheduler_destroy(scheduler);
    cm1e_bus_close(bus);
    return 0;
}
