#include "sim/esc_chip.h"

#include <math.h>

#include "cm1e/bus.h"
#include "core/bytes.h"

/* A device that runs by SYNC0 (ETG.1020, DC Synchronous), where the master has activated it. What it tolerates is the
 * device maker's own. Here it waits long for process data: a machine without a real-time kernel pauses now and then. */
enum { SYNC0_ACTIVE = 0x03, CYCLE_MIN_NS = 62500, MISSED_PULSES_MAX = 4, MISSED_OUTPUTS_MAX = 50 };
#define DIFFERENCE_MAX_NS 10000.0

static bool runs_by_sync0(const cm1e_sim_slave_t *slave)
{
    return slave->ops->runs_by_sync0 && (slave->memory[ESC_DC_ACTIVATION] & SYNC0_ACTIVE) == SYNC0_ACTIVE;
}

/* Before Safe-Operational the pulses must be set, before Operational they must have come (ETG.1020). */
uint16_t cm1e_sim_esc_sync_check(const cm1e_sim_slave_t *slave, uint8_t to)
{
    if (!runs_by_sync0(slave))
        return AL_CODE_NONE;
    if (cm1e_get_u32(slave->memory + ESC_DC_CYCLE_0) < CYCLE_MIN_NS)
        return AL_CODE_SYNC0_CYCLE;
    return to == CM1E_AL_OP && slave->clock.pulses.count == 0 ? AL_CODE_NO_SYNC : AL_CODE_NONE;
}

static bool has_outputs(const cm1e_sim_slave_t *slave)
{
    uint16_t outputs = 0, inputs = 0;
    if (slave->ops->process_data_sizes)
        slave->ops->process_data_sizes(slave->app, &outputs, &inputs);
    return outputs > 0;
}

static uint16_t find_error(const cm1e_sim_slave_t *slave)
{
    const esc_pulses_t *pulses = &slave->clock.pulses;
    const int64_t cycle = cm1e_get_u32(slave->memory + ESC_DC_CYCLE_0);
    cm1e_sim_clock_t clock;
    cm1e_sim_esc_clock(slave, &clock);
    if (fabs(slave->clock.mean_ns) > DIFFERENCE_MAX_NS)
        return AL_CODE_PLL;
    if (clock.system_ns - (int64_t)pulses->next_ns > MISSED_PULSES_MAX * cycle)
        return AL_CODE_FATAL_SYNC;
    const bool misses = has_outputs(slave) && pulses->without_outputs > MISSED_OUTPUTS_MAX;
    return misses ? AL_CODE_SYNC_ERROR : AL_CODE_NONE;
}

void cm1e_sim_esc_sync_supervise(cm1e_sim_slave_t *slave)
{
    if (slave->al_state != CM1E_AL_OP || !runs_by_sync0(slave))
        return;
    const uint16_t code = find_error(slave);
    if (code != AL_CODE_NONE)
        cm1e_sim_slave_fall_back(slave, CM1E_AL_SAFE_OP, code);
}
