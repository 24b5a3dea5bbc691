#include "cm1e/bus.h"
#include "core/bytes.h"
#include "sim/esc_chip.h"

/* The process data watchdog (0x0400, 0x0420, 0x0440): triggered by writes to a sync manager that says so, counted in
 * units of (divider + 2) * 40 ns. */

enum { TICK_NS = 40, STATUS_RUNNING = 0x01 };

static int64_t period_ns(const cm1e_sim_slave_t *slave)
{
    const int64_t unit = ((int64_t)cm1e_get_u16(slave->memory + ESC_WATCHDOG_DIVIDER) + 2) * TICK_NS;
    return unit * cm1e_get_u16(slave->memory + ESC_WATCHDOG_DATA);
}

void cm1e_sim_al_watchdog_trigger(cm1e_sim_slave_t *slave)
{
    const int64_t period = period_ns(slave);
    slave->watchdog_due_ns = period ? slave->now_ns + period : ESC_NEVER;
    slave->memory[ESC_WATCHDOG_STATUS] |= STATUS_RUNNING;
}

void cm1e_sim_al_watchdog_changed(cm1e_sim_slave_t *slave)
{
    /* A time of 0 switches it off; a new time counts from now where it runs. */
    if (period_ns(slave) == 0) {
        slave->watchdog_due_ns = ESC_NEVER;
        slave->memory[ESC_WATCHDOG_STATUS] |= STATUS_RUNNING;
    } else if (slave->watchdog_due_ns != ESC_NEVER) {
        cm1e_sim_al_watchdog_trigger(slave);
    }
}

/* Nothing triggers the watchdog of a device without outputs. */
static bool has_outputs(const cm1e_sim_slave_t *slave)
{
    uint16_t outputs = 0, inputs = 0;
    slave->ops->process_data_sizes(slave->app, &outputs, &inputs);
    return outputs > 0;
}

void cm1e_sim_al_watchdog_due(cm1e_sim_slave_t *slave)
{
    slave->watchdog_due_ns = ESC_NEVER;
    slave->memory[ESC_WATCHDOG_STATUS] &= (uint8_t)~STATUS_RUNNING;
    cm1e_sim_esc_count(slave, ESC_WATCHDOG_COUNTERS);
    /* A device without a function for it takes no notice (firmware before V1.3.0, UG 10.1). */
    if (slave->al_state != CM1E_AL_OP || !slave->ops->watchdog_expired || !has_outputs(slave))
        return;
    slave->ops->watchdog_expired(slave->app);
    cm1e_sim_slave_fall_back(slave, CM1E_AL_SAFE_OP, AL_CODE_SM_WATCHDOG);
}
