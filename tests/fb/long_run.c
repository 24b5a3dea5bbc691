/**
 * A machine that runs for a long time on virtual time: a motor that turns in one direction, in gear with a virtual shaft,
 * and a virtual axis that makes one relative move after the other. `scripts/soak --virtual` runs it for hours.
 *
 *     long_run [HOURS]
 *
 * At ten times it looks whether anything grows or drifts: the motor is where the shaft is, the relative moves add up to
 * the count, no cycle is missing or late, and memory and open files are as they were at the first look.
 */
#include <dirent.h>
#include <malloc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cm1e/plcopen.h"
#include "cm1e/scheduler.h"

enum { SHAFT = 0, MOTOR, INDEX, AXES, LOOKS = 10, GROWTH_KB = 256 };
#define CYCLE_S 0.001
#define BEGIN_S 10.0           /* everything runs by then */
#define SPEED 3600.0           /* degrees/s: the drive's 32-bit position turns over every 72 minutes */
#define DISTANCE (1000.0 / 3)  /* degrees of a relative move; no whole number of counts */
#define LAG 30.0               /* degrees that the simulated motor may be behind at that speed */
#define SAME 1e-6              /* degrees: rounding */

typedef struct resources {
    size_t allocated;
    long resident_kb;
    int files;
} resources_t;

static AXIS_REF_t axes[AXES];
static MC_Power_t power[AXES];
static MC_MoveVelocity_t turn = {.Axis = &axes[SHAFT], .Velocity = SPEED, .Acceleration = 3600};
static MC_GearIn_t gear = {.Master = &axes[SHAFT], .Slave = &axes[MOTOR], .RatioNumerator = 1, .RatioDenominator = 1,
                           .Acceleration = 7200, .Deceleration = 7200};
static MC_MoveRelative_t relative = {.Axis = &axes[INDEX], .Distance = DISTANCE, .Velocity = 2000, .Acceleration = 20000,
                                     .Deceleration = 20000};
static cm1e_scheduler_t *scheduler;
static double look_s;
static uint64_t passes, moves;
static int looks;
static double angle; /* from the shaft to the motor, at the first look */
static resources_t first;

static void must(bool right, const char *what, double is)
{
    if (right)
        return;
    printf("FAILED after %.6f h: %s (%.9g)\n", (double)passes * CYCLE_S / 3600, what, is);
    exit(EXIT_FAILURE);
}

static void must_succeed(cm1e_error_t error, const cm1e_diag_t *diag)
{
    if (error == CM1E_OK)
        return;
    printf("FAILED: %s\n", diag->text);
    exit(EXIT_FAILURE);
}

static resources_t resources(void)
{
    resources_t now = {.allocated = mallinfo2().uordblks};
    FILE *file = fopen("/proc/self/statm", "r");
    long pages = 0;
    must(file && fscanf(file, "%*d %ld", &pages) == 1, "/proc/self/statm cannot be read", 0);
    fclose(file);
    now.resident_kb = pages * 4;
    DIR *folder = opendir("/proc/self/fd");
    while (folder && readdir(folder))
        now.files++;
    closedir(folder);
    return now;
}

static void look_at_memory(void)
{
    const resources_t now = resources();
    if (looks == 0)
        first = now;
    must(now.allocated == first.allocated, "bytes of the heap", (double)now.allocated);
    must(now.resident_kb <= first.resident_kb + GROWTH_KB, "kB in memory", (double)now.resident_kb);
    must(now.files == first.files, "open files", now.files);
    printf("%10.4f h %12llu cycles %9llu moves %7ld kB\n", (double)passes * CYCLE_S / 3600, (unsigned long long)passes,
           (unsigned long long)moves, now.resident_kb);
    fflush(stdout);
}

static void look_at_axes(void)
{
    cm1e_axis_info_t shaft, motor, index;
    cm1e_axis_read(axes[SHAFT], &shaft);
    cm1e_axis_read(axes[MOTOR], &motor);
    cm1e_axis_read(axes[INDEX], &index);
    const double now = remainder(motor.set_position - shaft.set_position, 360);
    if (looks == 0)
        angle = now;
    must(turn.InVelocity && gear.InGear, "the motor is not in gear", 0);
    must(fabs(remainder(now - angle, 360)) < SAME, "degrees from the shaft to the motor", now);
    must(fabs(remainder(motor.set_position - motor.actual_position, 360)) < LAG, "the place of the motor",
         motor.actual_position);
    /* Three moves are 1000 degrees; a move may be under way, and it is ended by the next look at the latest. */
    const long double gone = (long double)(moves / 3) * 1000.0L + (long double)(moves % 3) * (long double)DISTANCE;
    const double expected = (double)fmodl(gone, 360.0L);
    if (relative.Done)
        must(fabs(remainder(index.set_position - expected, 360)) < SAME * 1000, "the sum of the relative moves",
             index.set_position - expected);
}

static void program(void *context)
{
    (void)context;
    passes++;
    bool ready = true;
    for (int i = 0; i < AXES; i++) {
        power[i].Enable = TRUE;
        MC_Power(&power[i]);
        must(!power[i].Error, "MC_Power", power[i].ErrorID);
        ready = ready && power[i].Status;
    }
    turn.Execute = gear.Execute = ready || turn.Execute;
    MC_MoveVelocity(&turn);
    MC_GearIn(&gear);
    relative.Execute = ready && !relative.Done;
    MC_MoveRelative(&relative);
    must(!turn.Error && !gear.Error && !relative.Error, "a block has an error", gear.ErrorID);
    moves += relative.Done;
    if ((double)passes * CYCLE_S >= BEGIN_S + looks * look_s && relative.Done) {
        look_at_axes();
        look_at_memory();
        looks++;
    }
}

static void open_machine(void)
{
    cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    cm1e_bus_t *bus = NULL;
    must_succeed(cm1e_bus_config_init(&config, "sim", AXES), &diag);
    for (int i = 0; i < AXES; i++) {
        config.axes[i].type = i == MOTOR ? CM1E_AXIS_MOTOR : CM1E_AXIS_VIRTUAL;
        config.axes[i].address = i == MOTOR;
        config.axes[i].units_per_revolution = config.axes[i].modulo_range = 360;
        config.axes[i].sim.no_stops = i == MOTOR;
    }
    config.virtual_time = true;
    must_succeed(cm1e_bus_open(&bus, &config, &diag), &diag);
    cm1e_bus_config_free(&config);
    must_succeed(cm1e_bus_start(bus, &diag), &diag);
    must_succeed(cm1e_scheduler_create(&scheduler, bus, &(cm1e_scheduler_config_t){0}, &diag), &diag);
    for (uint32_t i = 0; i < AXES; i++) {
        axes[i] = cm1e_scheduler_axis(scheduler, i);
        power[i] = (MC_Power_t){.Axis = &axes[i], .EnablePositive = TRUE, .EnableNegative = TRUE};
    }
}

int main(int count, char *words[])
{
    const double hours = count > 1 ? atof(words[1]) : 0.1;
    cm1e_diag_t diag = {0};
    cm1e_scheduler_statistics_t statistics;
    must(hours >= 0.01, "long_run [HOURS], from 0.01 on", hours);
    look_s = (3600 * hours - BEGIN_S - 1) / (LOOKS - 1);
    puts("      time");
    resources();  /* what printing and reading allocate is there from here on */
    open_machine();
    must_succeed(cm1e_scheduler_add_task(scheduler, &(cm1e_task_config_t){.name = "turn", .program = program}, &diag), &diag);
    must_succeed(cm1e_scheduler_run(scheduler, (int64_t)(3600e9 * hours), &diag), &diag);
    cm1e_scheduler_statistics(scheduler, &statistics);
    must(looks == LOOKS, "looks", looks);
    must(statistics.overruns == 0, "overruns", (double)statistics.overruns);
    must(statistics.bus.lost_frames == 0, "lost frames", (double)statistics.bus.lost_frames);
    must(passes >= (uint64_t)(3600 * hours / CYCLE_S) && passes <= statistics.cycles, "cycles", (double)statistics.cycles);
    printf("%.2f h of virtual time, %llu cycles: nothing grew, nothing drifted\n", hours, (unsigned long long)statistics.cycles);
    return EXIT_SUCCESS;
}
