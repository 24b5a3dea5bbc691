#include "bus/dc.h"

#include <stdlib.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "core/bytes.h"

enum {
    BEYOND_LIMIT = 3,    /* looks in a row */
    SILENT_LIMIT = 3,    /* frames in a row without the time of the reference clock */
    MARK_NS = 3,         /* a prediction is wrong by this in every second frame, and by twice as much in the others. A
                            clock that follows predictions never returns just these numbers */
};
#define SIGN 0x80000000u
/** ns; no clock goes so far wrong from one frame to the next. A larger difference means that the reference was off and
 *  counts from 0. */
#define IMPLAUSIBLE_NS INT64_C(1000000000)

/* ---- in every cycle ---------------------------------------------------------------------------------------------- */

static void lose(cm1e_dc_t *dc, cm1e_dc_slave_t *slave)
{
    if (slave->clock.lost)
        return;
    slave->clock.lost = true;
    slave->clock.losses++;
    dc->losses++;
}

/** Nobody looks at the deviation of a reference, which is none, so what was seen before is over. */
static void set_reference(cm1e_bus_t *bus, uint16_t position)
{
    cm1e_dc_t *dc = &bus->dc;
    dc->silent = 0;
    dc->candidate = 0;
    dc->reference = position;
    if (position) {
        dc->slaves[position - 1].clock.is_reference = true;
        dc->slaves[position - 1].clock.lost = false;
        dc->slaves[position - 1].beyond = 0;
    }
    cm1e_soem_use_clocks(bus->soem, position);
}

/** The next clock on the wire takes over. Its delay register says when a frame passed the first clock, so the delays of
 *  the others stay right. */
static void change_reference(cm1e_bus_t *bus)
{
    cm1e_dc_t *dc = &bus->dc;
    uint32_t next = dc->reference;
    dc->abandoned = false;
    if (dc->reference == 0)
        return;
    lose(dc, &dc->slaves[dc->reference - 1]);
    dc->slaves[dc->reference - 1].clock.is_reference = false;
    while (next < bus->slave_count && !(dc->slaves[next].clock.has_clock && !bus->slaves[next].watch.lost &&
                                        bus->slaves[next].unanswered == 0))
        next++;
    set_reference(bus, next < bus->slave_count ? (uint16_t)(next + 1) : 0);
}

int64_t cm1e_dc_time(const cm1e_dc_t *dc, int64_t now_ns)
{
    const int64_t passed_ns = now_ns - dc->sent_ns;
    const double rate = dc->pace.cycle_ns ? dc->pace.rate_ns / (double)dc->pace.cycle_ns : 0;
    return dc->reference_ns + passed_ns - (int64_t)((double)passed_ns * rate);
}

static void fill_steering(const cm1e_bus_t *bus, cm1e_datagram_t *d)
{
    cm1e_datagram_set(d, COMMAND_FPWR, bus->slaves[bus->dc.reference - 1].facts.station, REG_DC_SYSTEM_TIME, 8);
    cm1e_put_u64(d->data, (uint64_t)cm1e_dc_time(&bus->dc.leader->dc, cm1e_clock_now(bus->clock)));
}

/** The reference of a bus that another one leads follows the time that it is told, as a slave follows its reference
 *  (IgH does so with the time of the machine). All others of its bus follow it, by the process data's frame. */
static void steer(cm1e_bus_t *bus, int64_t now_ns)
{
    cm1e_dc_t *dc = &bus->dc;
    if (!dc->leader || dc->reference == 0)
        return;
    if (dc->steers)
        cm1e_soem_drop(bus->soem, &dc->steering);
    fill_steering(bus, &dc->steering);
    cm1e_soem_post(bus->soem, &dc->steering, now_ns);
    dc->steers = true;
}

static void take_steering(cm1e_bus_t *bus)
{
    cm1e_dc_t *dc = &bus->dc;
    if (dc->steers && cm1e_soem_take(bus->soem, &dc->steering, 0))
        dc->steers = false;
}

/** Sends the expected time in the datagram. If the reference does not answer, the other slaves get that time. With the
 *  time of an earlier frame they would fall back a whole cycle. */
void cm1e_dc_send(cm1e_bus_t *bus, int64_t now_ns)
{
    cm1e_dc_t *dc = &bus->dc;
    if (!dc->used)
        return;
    if (dc->abandoned)
        change_reference(bus);
    if (dc->reference == 0 && dc->candidate)
        set_reference(bus, dc->candidate);
    dc->frame_ns = now_ns;
    dc->marked = !dc->marked;
    dc->predicted_ns = dc->reference_ns + (now_ns - dc->sent_ns) + (dc->marked ? MARK_NS : 2 * MARK_NS);
    cm1e_soem_set_clock_time(bus->soem, dc->predicted_ns);
    steer(bus, now_ns);
}

static void note_phase(cm1e_dc_t *dc)
{
    const int64_t mean_ns = llabs((long long)dc->pace.mean_ns);
    dc->phase_maximum_ns = mean_ns > dc->phase_maximum_ns ? mean_ns : dc->phase_maximum_ns;
}

/** Takes the time of the reference from a frame that came back. */
void cm1e_dc_receive(cm1e_bus_t *bus, bool returned)
{
    cm1e_dc_t *dc = &bus->dc;
    if (!dc->used)
        return;
    take_steering(bus);
    const int64_t time_ns = cm1e_soem_clock_time(bus->soem);
    const bool is_answer = time_ns != dc->predicted_ns && llabs(time_ns - dc->predicted_ns) < IMPLAUSIBLE_NS;
    if (!returned || dc->reference == 0 || !is_answer) {
        dc->correction_ns += cm1e_dc_pace_coast(&dc->pace);
        if (returned && dc->reference && ++dc->silent >= SILENT_LIMIT)
            change_reference(bus);
        return;
    }
    dc->silent = 0;
    dc->reference_ns = time_ns;
    dc->sent_ns = dc->frame_ns;
    dc->correction_ns += cm1e_dc_pace_step(&dc->pace, time_ns);
    note_phase(dc);
}

int64_t cm1e_bus_pace(cm1e_bus_t *bus)
{
    const int64_t correction_ns = bus->dc.used ? bus->dc.correction_ns : 0;
    bus->dc.correction_ns = 0;
    return correction_ns;
}

/** Goes on with the plan of the cycle that the blocking phases have kept. */
int64_t cm1e_bus_next_start(const cm1e_bus_t *bus, int64_t now_ns)
{
    const int64_t cycle_ns = bus->config.cycle_time_ns, passed_ns = now_ns - bus->next_cycle_ns;
    if (!bus->dc.used)
        return now_ns;
    return bus->next_cycle_ns + (passed_ns > 0 ? (passed_ns + cycle_ns - 1) / cycle_ns * cycle_ns : 0);
}

/* ---- looks at the clocks, one slave in every second cycle -------------------------------------------------------- */

void cm1e_dc_note_status(cm1e_bus_slave_t *slave, uint16_t al_status_code)
{
    enum { SYNC_ERROR = 0x001A, FATAL = 0x002C, NO_SYNC = 0x002D, FIRST_OF_CLOCKS = 0x0030, LAST_OF_CLOCKS = 0x0037 };
    const bool of_clocks = al_status_code >= FIRST_OF_CLOCKS && al_status_code <= LAST_OF_CLOCKS;
    cm1e_dc_slave_t *own = slave->dc ? &slave->dc->slaves[slave->info.position - 1] : NULL;
    if (own && own->clock.sync0_ns &&
        (of_clocks || al_status_code == SYNC_ERROR || al_status_code == FATAL || al_status_code == NO_SYNC))
        lose(slave->dc, own);
    else if (own && al_status_code == 0 && own->clock.is_reference && !slave->dc->leader)
        own->clock.lost = false; /* nobody looks at its deviation */
}

bool cm1e_dc_next_look(cm1e_bus_t *bus, cm1e_datagram_t *d)
{
    cm1e_dc_t *dc = &bus->dc;
    dc->turn = dc->used && !dc->turn;
    if (!dc->turn)
        return false;
    for (uint32_t n = 0; n < bus->slave_count; n++) {
        dc->looked = (uint16_t)(dc->looked < bus->slave_count ? dc->looked + 1 : 1);
        const cm1e_slave_clock_t *clock = &dc->slaves[dc->looked - 1].clock;
        if (!clock->has_clock || (clock->is_reference && !dc->leader))
            continue;
        cm1e_datagram_set(d, COMMAND_FPRD, bus->slaves[dc->looked - 1].facts.station, REG_DC_DIFFERENCE, 4);
        return true;
    }
    return false;
}

/** A reference that another bus leads gets its time from this machine, whose frames are less even than a slave's. */
uint32_t cm1e_dc_tolerance(const cm1e_dc_t *dc, const cm1e_slave_clock_t *clock)
{
    const uint32_t phase_ns = (uint32_t)(dc->pace.cycle_ns / CM1E_PACE_SETTLED);
    return clock->is_reference && phase_ns > CM1E_CLOCK_TOLERANCE_NS ? phase_ns : CM1E_CLOCK_TOLERANCE_NS;
}

void cm1e_dc_looked(cm1e_bus_t *bus, const cm1e_datagram_t *d)
{
    cm1e_dc_slave_t *slave = &bus->dc.slaves[bus->dc.looked - 1];
    if (d->working_counter != 1)
        return; /* a slave that is away is noticed by its AL status */
    const uint32_t value = cm1e_get_u32(d->data), size = value & ~SIGN;
    slave->seen = true;
    slave->clock.deviation_ns = value & SIGN ? -(int32_t)size : (int32_t)size;
    slave->clock.maximum_ns = size > slave->clock.maximum_ns ? size : slave->clock.maximum_ns;
    if (size <= cm1e_dc_tolerance(&bus->dc, &slave->clock)) {
        slave->beyond = 0;
        slave->clock.lost = false;
    } else if (slave->beyond < BEYOND_LIMIT && ++slave->beyond == BEYOND_LIMIT && bus->phase == BUS_OPERATING) {
        lose(&bus->dc, slave);
    }
}

/* ---- without a cycle --------------------------------------------------------------------------------------------- */

void cm1e_dc_keep(cm1e_bus_t *bus)
{
    cm1e_dc_t *dc = &bus->dc;
    uint8_t time[8] = {0};
    if (!dc->used || dc->reference == 0)
        return;
    const cm1e_bus_slave_t *reference = &bus->slaves[dc->reference - 1];
    if (dc->leader) {
        fill_steering(bus, &dc->steering);
        cm1e_soem_transfer(bus->soem, COMMAND_FPWR, reference->facts.station, REG_DC_SYSTEM_TIME, dc->steering.data, 8);
    }
    dc->sent_ns = cm1e_clock_now(bus->clock);
    if (cm1e_soem_transfer(bus->soem, COMMAND_FRMW, reference->facts.station, REG_DC_SYSTEM_TIME, time, 8) > 0)
        dc->reference_ns = (int64_t)cm1e_get_u64(time);
}
