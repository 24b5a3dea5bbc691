#include "sim/esc.h"

#include "core/bytes.h"

/* Distributed clocks: the local clock starts at power-on, the system time adds the offset that the master writes. All
 * local clocks of the simulation tick alike, so the control loop has only a remaining offset to remove. */

enum { LOOP_STEP_NS = 64 };
#define SIGN 0x80000000u

static uint64_t local_time(const cm1e_sim_slave_t *slave, int64_t when_ns)
{
    return (uint64_t)(when_ns - slave->powered_on_ns);
}

static uint64_t system_time(const cm1e_sim_slave_t *slave)
{
    return local_time(slave, slave->frame_ns) + cm1e_get_u64(slave->memory + ESC_DC_OFFSET) +
           (uint64_t)slave->dc_adjustment_ns;
}

void cm1e_sim_esc_dc_refresh(cm1e_sim_slave_t *slave)
{
    cm1e_put_u64(slave->memory + ESC_DC_SYSTEM_TIME, system_time(slave));
}

/* A write to 0x0900 latches when this frame came in at every port (32 bits each) and at the processing unit. */
void cm1e_sim_esc_dc_latch(cm1e_sim_slave_t *slave)
{
    uint8_t *ports = slave->memory + ESC_DC_PORT_TIMES;
    const uint64_t arrival = local_time(slave, slave->frame_ns);
    cm1e_put_u32(ports, (uint32_t)arrival);
    if (slave->return_ns >= 0)
        cm1e_put_u32(ports + 4, (uint32_t)local_time(slave, slave->return_ns));
    cm1e_put_u64(slave->memory + ESC_DC_UNIT_TIME, arrival);
}

void cm1e_sim_esc_dc_received(cm1e_sim_slave_t *slave, const uint8_t *data)
{
    const uint32_t received = cm1e_get_u32(data) + cm1e_get_u32(slave->memory + ESC_DC_DELAY);
    const int32_t ahead = (int32_t)((uint32_t)system_time(slave) - received);
    const uint32_t size = ahead < 0 ? 0u - (uint32_t)ahead : (uint32_t)ahead;
    /* 0x092C: bit 31 is set where the local copy is behind. */
    cm1e_put_u32(slave->memory + ESC_DC_DIFFERENCE, (size & ~SIGN) | (ahead < 0 ? SIGN : 0));
    const int64_t step = size < LOOP_STEP_NS ? (int64_t)size : LOOP_STEP_NS;
    slave->dc_adjustment_ns -= ahead < 0 ? -step : step;
}
