#include "sim/esc_chip.h"

#include <math.h>

#include "core/bytes.h"

/* Distributed clocks (ETG.1000.4, and the register description of the controllers). The local time counts from power-on
 * by a crystal. The control loop makes it faster or slower, so that local time plus offset follows the system time of
 * the reference clock, which a master distributes by writing to 0x0910:
 *
 *   difference = (local time + offset - delay) - received system time
 *
 * The registers state what comes out: the mean difference (0x092C), and the deviation of the clock period (0x0932). How
 * a chip gets there is not published. Here the mean difference is removed by a part of it with every frame, limited to
 * LOOP_STEP_NS, and the mean deviation of the period becomes the speed of the clock. */

enum {
    LOOP_STEP_NS = 64, SPEED_MARGIN = 0x7F, DEPTH_MASK = 0x0F, SIGN_BIT = 31, INTERVAL_MAX_NS = 2000000000,
    ESC_DC_PORTS = 4, ACTIVATE = 0x01, SYNC0 = 0x02, SYNC1 = 0x04, PENDING_0 = 0x01, PENDING_1 = 0x02,
};
#define SIGN (1u << SIGN_BIT)
/* Warming or cooling reaches the crystal through its housing. */
#define HOUSING_NS 30e9

/* ---- the clock --------------------------------------------------------------------------------------------------- */

/* Deviation of the period for a value of 0x0932, by the formula of the register description: of ten ns in a tick, one
 * is left out or added each (start -+ diff + 2) ticks. */
static double deviation_of(double start, double diff)
{
    return diff / (5 * (start + diff + 2) * (start - diff + 2));
}

/* The other way round: the root of a quadratic equation. */
static double speed_diff_of(double start, double deviation)
{
    const double a = 5 * deviation, c = a * (start + 2) * (start + 2), most = start - SPEED_MARGIN;
    return round(fmin(fmax(2 * c / (1 + sqrt(1 + 4 * a * c)), -most), most));
}

static double speed_start(const cm1e_sim_slave_t *slave)
{
    return fmax(cm1e_get_u16(slave->memory + ESC_DC_SPEED_START) & 0x7FFF, SPEED_MARGIN + 1);
}

/* Lets the clock run to a moment. */
static void run_to(cm1e_sim_slave_t *slave, int64_t when_ns)
{
    esc_clock_t *clock = &slave->clock;
    esc_crystal_t *crystal = &clock->crystal;
    const double passed_ns = (double)(when_ns - clock->now_ns);
    const int16_t diff = (int16_t)cm1e_get_u16(slave->memory + ESC_DC_SPEED_DIFF);
    double gained_ns = passed_ns * (crystal->drift + crystal->warm);
    if (passed_ns <= 0)
        return;
    if (crystal->warming != 0) {
        const double left = exp(-passed_ns / HOUSING_NS);
        gained_ns -= crystal->warming * HOUSING_NS * (1 - left);
        crystal->warming = fabs(crystal->warming * left) < 1e-12 ? 0 : crystal->warming * left;
    }
    clock->crystal_ns += gained_ns;
    if (diff != 0 && !clock->troubles.free)
        clock->loop_ns -= (passed_ns + gained_ns) * deviation_of(speed_start(slave), diff);
    clock->now_ns = when_ns;
}

/* The local time of a moment shortly before or behind the time of the clock. */
static uint64_t local_time(const cm1e_sim_slave_t *slave, int64_t when_ns)
{
    const esc_clock_t *clock = &slave->clock;
    return (uint64_t)(when_ns - slave->powered_on_ns + llround(clock->crystal_ns + clock->loop_ns));
}

static uint64_t frame_time(const cm1e_sim_slave_t *slave)
{
    return local_time(slave, slave->frame_ns) + (uint64_t)(int64_t)slave->clock.jitter_ns;
}

static uint64_t system_time(const cm1e_sim_slave_t *slave, uint64_t local)
{
    return local + cm1e_get_u64(slave->memory + ESC_DC_OFFSET);
}

/* A frame arrives: all that it does to the clock is stamped with one time. */
void cm1e_sim_esc_dc_frame(cm1e_sim_slave_t *slave, int64_t frame_ns, const int64_t *returns_ns)
{
    esc_crystal_t *crystal = &slave->clock.crystal;
    slave->frame_ns = frame_ns;
    slave->returns_ns = returns_ns;
    run_to(slave, frame_ns);
    if (!crystal->jitter_ns)
        return;
    crystal->random = crystal->random * 1664525u + 1013904223u;
    slave->clock.jitter_ns = (int32_t)((crystal->random >> 8) % (2 * crystal->jitter_ns + 1)) -
                             (int32_t)crystal->jitter_ns;
}

/* ---- registers --------------------------------------------------------------------------------------------------- */

/* The time at which this frame passed the reference clock: a master that reads it from all slaves gets one time. */
void cm1e_sim_esc_dc_refresh(cm1e_sim_slave_t *slave)
{
    cm1e_put_u64(slave->memory + ESC_DC_SYSTEM_TIME,
                 system_time(slave, frame_time(slave)) - cm1e_get_u32(slave->memory + ESC_DC_DELAY));
}

/* A write to 0x0900 latches when this frame came in at every port (32 bits each) and at the processing unit. */
void cm1e_sim_esc_dc_latch(cm1e_sim_slave_t *slave)
{
    uint8_t *ports = slave->memory + ESC_DC_PORT_TIMES;
    const uint64_t arrival = frame_time(slave);
    cm1e_put_u32(ports, (uint32_t)arrival);
    for (int port = 1; slave->returns_ns && port < ESC_DC_PORTS; port++)
        if (slave->returns_ns[port] >= 0)
            cm1e_put_u32(ports + 4 * port, (uint32_t)(arrival + (uint64_t)slave->returns_ns[port]));
    cm1e_put_u64(slave->memory + ESC_DC_UNIT_TIME, arrival);
}

static void show_difference(cm1e_sim_slave_t *slave)
{
    const double size = fmin(fabs(slave->clock.mean_ns), INT32_MAX);
    const uint32_t whole = (uint32_t)llround(size);
    /* Bit 31 is set where the local copy is behind. */
    cm1e_put_u32(slave->memory + ESC_DC_DIFFERENCE, whole | (slave->clock.mean_ns < 0 && whole ? SIGN : 0));
}

/* A write to 0x0930 begins the two means anew. */
void cm1e_sim_esc_dc_restart(cm1e_sim_slave_t *slave)
{
    esc_clock_t *clock = &slave->clock;
    clock->mean_ns = clock->deviation = clock->gained_ns = clock->interval_ns = 0;
    clock->measuring = false;
    cm1e_put_u16(slave->memory + ESC_DC_SPEED_DIFF, 0);
    show_difference(slave);
}

static double part(const cm1e_sim_slave_t *slave, uint16_t address)
{
    return 1.0 / (1u << (slave->memory[address] & DEPTH_MASK));
}

/* The crystal, without what the loop adds, against the reference clock. Positive in 0x0932: the crystal is fast. It is
 * the mean of what was gained over the mean of the intervals. A mean of the ratios would be too high where the received
 * times are uneven, as those of a program are that tells its own time: 1 / interval grows more than it falls. */
static void take_period(cm1e_sim_slave_t *slave, uint32_t received)
{
    esc_clock_t *clock = &slave->clock;
    const int64_t crystal_ns = slave->frame_ns + clock->jitter_ns + llround(clock->crystal_ns);
    const uint32_t interval = received - clock->last_received_ns;
    if (clock->measuring && interval > 0 && interval < INTERVAL_MAX_NS) {
        const double gained_ns = (double)(crystal_ns - clock->last_crystal_ns) - interval;
        clock->interval_ns = clock->interval_ns > 0 ? clock->interval_ns : interval;
        clock->interval_ns += (interval - clock->interval_ns) * part(slave, ESC_DC_SPEED_DEPTH);
        clock->gained_ns += (gained_ns - clock->gained_ns) * part(slave, ESC_DC_SPEED_DEPTH);
        clock->deviation = clock->gained_ns / clock->interval_ns;
        const double diff = speed_diff_of(speed_start(slave), clock->deviation);
        cm1e_put_u16(slave->memory + ESC_DC_SPEED_DIFF, (uint16_t)(int16_t)diff);
    }
    clock->measuring = true;
    clock->last_crystal_ns = crystal_ns;
    clock->last_received_ns = received;
}

void cm1e_sim_esc_dc_received(cm1e_sim_slave_t *slave, const uint8_t *data)
{
    esc_clock_t *clock = &slave->clock;
    const uint32_t received = cm1e_get_u32(data), delay = cm1e_get_u32(slave->memory + ESC_DC_DELAY);
    const int32_t difference = (int32_t)((uint32_t)system_time(slave, frame_time(slave)) - delay - received);
    const double gain = part(slave, ESC_DC_DEPTH);
    clock->mean_ns += (difference - clock->mean_ns) * gain;
    show_difference(slave);
    if (clock->troubles.free)
        return;
    take_period(slave, received);
    /* Half of the gain of the mean: the two lags together do not overshoot, whatever the depth. */
    clock->loop_ns -= fmin(fmax(clock->mean_ns * gain / 2, -LOOP_STEP_NS), LOOP_STEP_NS);
}

/* ---- SYNC0 and SYNC1 --------------------------------------------------------------------------------------------- */

/* SYNC1 comes 0x09A4 behind a SYNC0; the next one waits for the first SYNC0 behind that. */
static uint64_t sync1_period(const cm1e_sim_slave_t *slave)
{
    const uint64_t cycle = cm1e_get_u32(slave->memory + ESC_DC_CYCLE_0);
    return cycle ? (cm1e_get_u32(slave->memory + ESC_DC_CYCLE_1) / cycle + 1) * cycle : 0;
}

/* 0x0981 was written. A start time that is past never comes. */
void cm1e_sim_esc_dc_activated(cm1e_sim_slave_t *slave)
{
    esc_pulses_t *pulses = &slave->clock.pulses;
    const uint8_t bits = slave->memory[ESC_DC_ACTIVATION];
    *pulses = (esc_pulses_t){0};
    slave->memory[ESC_DC_ACTIVATION_STATUS] = 0;
    if (slave->ops->sync0)
        slave->ops->sync0(slave->app, INT64_MAX);
    if ((bits & (ACTIVATE | SYNC0)) != (ACTIVATE | SYNC0))
        return;
    pulses->next_ns = cm1e_get_u64(slave->memory + ESC_DC_START);
    pulses->next_sync1_ns = pulses->next_ns + cm1e_get_u32(slave->memory + ESC_DC_CYCLE_1);
    pulses->running = pulses->next_ns >= system_time(slave, frame_time(slave));
    slave->memory[ESC_DC_ACTIVATION_STATUS] = (uint8_t)(PENDING_0 | (bits & SYNC1 ? PENDING_1 : 0));
}

static uint64_t pulses_until(uint64_t now, uint64_t next, uint64_t period)
{
    if ((int64_t)(now - next) < 0)
        return 0;
    return period ? (now - next) / period + 1 : 1;
}

static void advance_sync1(cm1e_sim_slave_t *slave, uint64_t now)
{
    esc_pulses_t *pulses = &slave->clock.pulses;
    const uint64_t period = sync1_period(slave), count = pulses_until(now, pulses->next_sync1_ns, period);
    if (!(slave->memory[ESC_DC_ACTIVATION] & SYNC1) || count == 0)
        return;
    pulses->count_sync1 += count;
    pulses->next_sync1_ns += count * period;
    slave->memory[ESC_DC_ACTIVATION_STATUS] &= (uint8_t)~PENDING_1;
    cm1e_put_u64(slave->memory + ESC_DC_NEXT_SYNC1, pulses->next_sync1_ns);
}

void cm1e_sim_esc_dc_advance(cm1e_sim_slave_t *slave, int64_t now_ns)
{
    esc_pulses_t *pulses = &slave->clock.pulses;
    run_to(slave, now_ns);
    if (!pulses->running)
        return;
    const uint64_t now = system_time(slave, local_time(slave, now_ns));
    const uint64_t cycle = cm1e_get_u32(slave->memory + ESC_DC_CYCLE_0);
    const uint64_t count = pulses_until(now, pulses->next_ns, cycle);
    if (count == 0 || slave->clock.troubles.no_pulses)
        return;
    pulses->count += count;
    pulses->without_outputs += count;
    pulses->next_ns += count * cycle;
    if (slave->ops->sync0)
        slave->ops->sync0(slave->app, now_ns - (int64_t)(now - (pulses->next_ns - cycle)));
    pulses->running = cycle > 0; /* a cycle of 0: a single pulse */
    slave->memory[ESC_DC_ACTIVATION_STATUS] &= (uint8_t)~PENDING_0;
    cm1e_put_u64(slave->memory + ESC_DC_START, pulses->next_ns);
    advance_sync1(slave, now);
}

/* ---- life -------------------------------------------------------------------------------------------------------- */

void cm1e_sim_esc_dc_power_on(cm1e_sim_slave_t *slave, int64_t now_ns)
{
    const esc_crystal_t crystal = slave->clock.crystal; /* what was soldered on remains */
    const esc_clock_troubles_t troubles = slave->clock.troubles;
    slave->clock = (esc_clock_t){.crystal = crystal, .troubles = troubles, .now_ns = now_ns};
}

void cm1e_sim_esc_clock(const cm1e_sim_slave_t *slave, cm1e_sim_clock_t *result)
{
    const esc_clock_t *clock = &slave->clock;
    *result = (cm1e_sim_clock_t){
        .time_ns = clock->now_ns,
        .system_ns = (int64_t)system_time(slave, local_time(slave, clock->now_ns)),
        .drift_ppm = (clock->crystal.drift + clock->crystal.warm - clock->crystal.warming) * 1e6,
        .sync0_pulses = clock->pulses.count,
        .sync1_pulses = clock->pulses.count_sync1,
        .next_sync0_ns = clock->pulses.running ? (int64_t)clock->pulses.next_ns : 0,
    };
}
