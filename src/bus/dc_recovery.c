/* The clock of a slave that comes back while the others run: set again by the time that the last frames brought. */
#include "bus/bus_internal.h"
#include "core/bytes.h"

/** ns; so long after its first pulse the slave may go to Operational. */
#define PULSES_NS INT64_C(30000000)

enum { TIMES_BYTES = REG_DC_DELAY + 4 - REG_DC_SYSTEM_TIME, OFFSET_AT = REG_DC_OFFSET - REG_DC_SYSTEM_TIME,
       DELAY_AT = REG_DC_DELAY - REG_DC_SYSTEM_TIME, OFFSET_AND_DELAY_BYTES = 12 };

/** The steps, in their order. Without pulses the clock is set after TOGETHER. */
enum clock_step { FILTERS = 0, TIMES, OFFSET, RESTART, TOGETHER, OFF, CYCLES, START, ON, PULSES };

static void fill(const cm1e_dc_t *dc, const cm1e_dc_slave_t *own, uint16_t station, cm1e_datagram_t *d)
{
    static const struct {
        uint8_t command;
        uint16_t offset, length;
    } registers[] = {
        [FILTERS] = {COMMAND_FPWR, REG_DC_FILTERS, 2}, [TIMES] = {COMMAND_FPRD, REG_DC_SYSTEM_TIME, TIMES_BYTES},
        [OFFSET] = {COMMAND_FPWR, REG_DC_OFFSET, OFFSET_AND_DELAY_BYTES},
        [RESTART] = {COMMAND_FPWR, REG_DC_SPEED_START, 2}, [TOGETHER] = {COMMAND_FPRD, REG_DC_DIFFERENCE, 4},
        [OFF] = {COMMAND_FPWR, REG_DC_CONTROL, 2}, [CYCLES] = {COMMAND_FPWR, REG_DC_CYCLES, 8},
        [START] = {COMMAND_FPWR, REG_DC_START, 8}, [ON] = {COMMAND_FPWR, REG_DC_ACTIVATION, 1},
    };
    uint8_t start[8], cycles[8];
    cm1e_datagram_set(d, registers[own->step].command, station, registers[own->step].offset,
                      registers[own->step].length);
    switch (own->step) {
    case FILTERS: cm1e_put_u16(d->data, DC_FILTERS); break;
    case OFFSET:
        cm1e_put_u64(d->data, own->offset);
        cm1e_put_u32(d->data + 8, own->clock.delay_ns);
        break;
    case RESTART: cm1e_put_u16(d->data, DC_SPEED_START); break;
    case OFF: cm1e_put_u16(d->data, own->control); break;
    case CYCLES:
        cm1e_dc_put_pulses(dc, &own->clock, dc->reference_ns, start, d->data);
        break;
    case START:
        cm1e_dc_put_pulses(dc, &own->clock, dc->reference_ns, d->data, cycles);
        break;
    case ON: d->data[0] = (uint8_t)cm1e_dc_activation(&own->clock); break;
    default: break;
    }
}

void cm1e_dc_recover_begin(cm1e_bus_slave_t *slave)
{
    if (slave->dc)
        slave->dc->slaves[slave->info.position - 1].step = FILTERS;
}

void cm1e_dc_was_off(cm1e_bus_slave_t *slave)
{
    if (slave->dc && slave->dc->slaves[slave->info.position - 1].clock.is_reference)
        slave->dc->abandoned = true;
}

bool cm1e_dc_recover_next(cm1e_bus_slave_t *slave, cm1e_datagram_t *d, int64_t now_ns, bool *is_set)
{
    cm1e_dc_t *dc = slave->dc;
    cm1e_dc_slave_t *own = dc ? &dc->slaves[slave->info.position - 1] : NULL;
    *is_set = !own || !own->clock.has_clock || (own->step > TOGETHER && own->clock.sync0_ns == 0) ||
              (own->step == PULSES && now_ns >= own->deadline_ns);
    if (*is_set || own->step == PULSES)
        return false;
    if (own->clock.is_reference && own->step < OFF) {
        own->step = OFF; /* it has its address, so it was not off, and still gives the time */
        return false;
    }
    fill(dc, own, slave->facts.station, d);
    return true;
}

/** Takes the times as they were read. The system time contains the offset and the delay that the slave had until
 *  now. */
static void take_times(const cm1e_dc_t *dc, cm1e_dc_slave_t *own, const cm1e_datagram_t *d)
{
    const uint64_t local = cm1e_get_u64(d->data) - cm1e_get_u64(d->data + OFFSET_AT) + cm1e_get_u32(d->data + DELAY_AT);
    const int64_t reference_ns = dc->reference_ns + (d->sent_ns - dc->sent_ns);
    own->offset = (uint64_t)reference_ns + own->clock.delay_ns - local;
}

void cm1e_dc_recovered(cm1e_bus_slave_t *slave, const cm1e_datagram_t *d, int64_t now_ns)
{
    cm1e_dc_t *dc = slave->dc;
    cm1e_dc_slave_t *own = &dc->slaves[slave->info.position - 1];
    const uint32_t difference = own->step == TOGETHER ? cm1e_get_u32(d->data) & 0x7FFFFFFFu : 0;
    if (own->step == TIMES)
        take_times(dc, own, d);
    if (own->step == START)
        own->deadline_ns = now_ns + ((int64_t)cm1e_get_u64(d->data) - dc->reference_ns) + PULSES_NS;
    if (own->step == TOGETHER && dc->reference == 0)
        dc->candidate = slave->info.position;
    if (difference <= CM1E_CLOCK_TOLERANCE_NS)
        own->step++;
}
