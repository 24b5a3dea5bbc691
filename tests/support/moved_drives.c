#include "moved_drives.h"

#include <math.h>

#include "bus/bus_image.h"
#include "cm1e/plcopen.h"
#include "cm1e/scheduler.h"
#include "cm1e/sim.h"
#include "core/bytes.h"
#include "nic/nic.h"

/** From the destination address on; what is around the data of a datagram; what an interface puts around a frame. */
enum { AT_COMMAND = 16, AT_LENGTH = 22, LENGTH_MASK = 0x07FF, AROUND_DATA = 28, AROUND_FRAME = 24, LRW = 12 };
enum { SETTLING_CYCLES = 100 };
#define VELOCITY 10.0
#define ACCELERATION 200.0
#define US_PER_BYTE 0.08

static AXIS_REF_t axes[CM1E_MAX_AXES];
static MC_Power_t powers[CM1E_MAX_AXES];
static MC_MoveAbsolute_t moves[CM1E_MAX_AXES];
static struct {
    cm1e_bus_t *bus;
    cm1e_scheduler_t *scheduler;
    uint32_t count;
    unsigned left, settled;
    unsigned frames, bytes;      /* since the programs ran last */
    cm1e_bus_counters_t before;
    moved_drives_t *result;
} run;

/** Units; no two neighbours go the same way or as far. */
static double target_of(uint32_t axis) { return (axis % 2 ? -0.1 : 0.1) * (1 + axis % 10); }

static cm1e_tap_verdict_t count(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    if (frame->direction != CM1E_TAP_SENT || frame->bytes[AT_COMMAND] != LRW)
        return CM1E_TAP_PASS;
    run.frames++;
    run.bytes += (cm1e_get_u16(frame->bytes + AT_LENGTH) & LENGTH_MASK) + AROUND_DATA + AROUND_FRAME;
    return CM1E_TAP_PASS;
}

static void take_last_cycle(moved_drives_t *result)
{
    result->frames = run.frames;
    result->bytes = run.bytes;
    run.frames = run.bytes = 0;
    result->cycles++;
}

static void program(void *context)
{
    (void)context;
    take_last_cycle(run.result);
    bool powered = true, done = true;
    for (uint32_t i = 0; i < run.count; i++) {
        powers[i].Enable = TRUE;
        MC_Power(&powers[i]);
        powered &= powers[i].Status;
    }
    for (uint32_t i = 0; i < run.count; i++) {
        moves[i].Execute |= powered;
        MC_MoveAbsolute(&moves[i]);
        done &= moves[i].Done;
    }
    run.settled += done;
    if (run.settled == SETTLING_CYCLES || --run.left == 0)
        cm1e_scheduler_stop(run.scheduler);
}

static void prepare(void)
{
    for (uint32_t i = 0; i < run.count; i++) {
        axes[i] = cm1e_scheduler_axis(run.scheduler, i);
        powers[i] = (MC_Power_t){.Axis = &axes[i], .EnablePositive = TRUE, .EnableNegative = TRUE};
        moves[i] = (MC_MoveAbsolute_t){.Axis = &axes[i], .Position = target_of(i), .Velocity = VELOCITY,
                                       .Acceleration = ACCELERATION, .Deceleration = ACCELERATION};
        cm1e_sim_probe_reset(cm1e_bus_segment(run.bus), cm1e_bus_axis_position(run.bus, i));
    }
    run.before = *cm1e_bus_counters(run.bus);
    cm1e_nic_set_tap(cm1e_bus_nic(run.bus), count, NULL);
}

/** Stands at its target, and was never much faster than commanded. */
static bool has_moved(const cm1e_axis_config_t *axis, uint32_t index)
{
    cm1e_sim_probe_t probe;
    cm1e_sim_probe(cm1e_bus_segment(run.bus), cm1e_bus_axis_position(run.bus, index), &probe);
    const double scale = axis->counts_per_unit, target = target_of(index) * scale;
    return moves[index].Done && fabs(probe.position_counts - target) < 0.01 * scale &&
           probe.travel_counts < fabs(target) + 0.05 * scale && probe.peak_velocity_counts_per_s < 1.2 * VELOCITY * scale;
}

static void judge(const cm1e_bus_config_t *config)
{
    const cm1e_bus_counters_t *now = cm1e_bus_counters(run.bus);
    run.result->bad_cycles = now->lost_frames - run.before.lost_frames + now->working_counter_errors -
                             run.before.working_counter_errors;
    for (uint32_t i = 0; i < run.count; i++)
        run.result->moved += has_moved(&config->axes[i], i);
}

static cm1e_error_t run_bus(const cm1e_bus_config_t *config)
{
    cm1e_diag_t *diag = &run.result->diag;
    const cm1e_task_config_t task = {.program = program};
    cm1e_error_t error = cm1e_bus_start(run.bus, diag);
    if (error == CM1E_OK)
        error = cm1e_scheduler_create(&run.scheduler, run.bus, NULL, diag);
    if (error != CM1E_OK)
        return error;
    error = cm1e_scheduler_add_task(run.scheduler, &task, diag);
    prepare();
    if (error == CM1E_OK)
        error = cm1e_scheduler_run(run.scheduler, 0, diag);
    judge(config);
    cm1e_scheduler_destroy(run.scheduler);
    return error;
}

cm1e_error_t moved_drives_run(const cm1e_bus_config_t *config, unsigned cycles_at_most, moved_drives_t *result)
{
    *result = (moved_drives_t){0};
    run.count = config->axis_count;
    run.left = cycles_at_most;
    run.settled = 0;
    run.result = result;
    cm1e_error_t error = cm1e_bus_open(&run.bus, config, &result->diag);
    if (error == CM1E_OK)
        error = run_bus(config);
    cm1e_bus_close(run.bus);
    return error;
}

double moved_drives_wire_us(const moved_drives_t *result, uint32_t slaves, double us_per_slave)
{
    return result->bytes * US_PER_BYTE + slaves * us_per_slave;
}
