/*
 * What happens to frames that the console of the simulator does not offer: lost on the way out or back only, a wrong
 * working counter, an actual position that is not true. And a host that stands still, and a slave that leaves
 * Operational by itself. Only this source of a scenario includes headers of the library's rooms: they are hooks of the
 * simulation, and the judge knows nothing of them.
 */
#include <string.h>

#include "bus/bus_image.h"
#include "core/clock.h"
#include "cm1e/io.h"
#include "nic/nic.h"
#include "scenario_private.h"
#include "sim/esc_chip.h"
#include "sim/segment.h"

enum { LRW = 12, COMMAND_AT = 16, DATA_AT = 26, ACTUAL_POSITION = 0x6064, NEXT_CHANNEL = 0x800 };

/** An actual position that is not true. */
typedef struct lie {
    bool on, freeze;
    int axis;            /**< its number */
    size_t place;        /**< of its four bytes in the frame */
    int32_t offset, frozen;
} lie_t;

static unsigned faults[SCENARIO_NETWORKS];
static lie_t lies[SCENARIO_NETWORKS];
static int numbers[SCENARIO_NETWORKS] = {0, 1};

static bool is_process_data(const cm1e_tap_frame_t *frame)
{
    return frame->length > COMMAND_AT && frame->bytes[COMMAND_AT] == LRW;
}

static void tell(lie_t *lie, cm1e_tap_frame_t *frame)
{
    if (lie->place + 4 > frame->length)
        return;
    int32_t truth;
    memcpy(&truth, frame->bytes + lie->place, sizeof truth); /* little endian, as this machine */
    if (!lie->on)
        lie->frozen = truth;
    const int32_t told = lie->freeze ? lie->frozen : (int32_t)((uint32_t)truth + (uint32_t)lie->offset);
    if (lie->on)
        memcpy(frame->bytes + lie->place, &told, sizeof told);
}

static cm1e_tap_verdict_t tap(void *context, cm1e_tap_frame_t *frame)
{
    const unsigned set = faults[*(const int *)context];
    lie_t *lie = &lies[*(const int *)context];
    if ((set == 0 && lie->place == 0) || !is_process_data(frame))
        return CM1E_TAP_PASS;
    const bool out = frame->direction == CM1E_TAP_SENT;
    if (!out && lie->place > 0)
        tell(lie, frame);
    if (set & (out ? WIRE_OUT : WIRE_BACK))
        return CM1E_TAP_DROP;
    if (!out && (set & WIRE_COUNTER))
        cm1e_frame_change_working_counter(frame->bytes, frame->length, 0, -1);
    return CM1E_TAP_PASS;
}

void wire_forget(void)
{
    memset(faults, 0, sizeof faults);
    memset(lies, 0, sizeof lies);
}

/** Where the actual position of a motor is in the inputs of its slave; -1: it is not mapped to a byte. */
static int place_in_slave(const cm1e_bus_t *bus, const machine_axis_t *axis)
{
    const unsigned index = ACTUAL_POSITION + (axis->channel > 0 ? (axis->channel - 1) * NEXT_CHANNEL : 0);
    cm1e_io_info_t info;
    for (uint32_t n = 0; cm1e_io_at(bus, n, &info); n++)
        if (info.position == axis->position && !info.output && info.index == index && info.bit_offset % 8 == 0)
            return (int)(info.bit_offset / 8);
    return -1;
}

/** The image has the outputs of all slaves, then their inputs. */
void wire_watch(run_t *run, const machine_axis_t *axis)
{
    const cm1e_bus_t *bus = run->buses[axis->network];
    const int inside = is_motor(axis) ? place_in_slave(bus, axis) : -1;
    size_t place = DATA_AT;
    /* Bits of terminals share bytes; overlapped inputs are in other places. */
    if (inside < 0 || run->scenario->io > 0 || run->scenario->overlap != 0)
        return;
    for (uint32_t n = 1; n <= cm1e_bus_slave_count(bus); n++)
        place += cm1e_bus_slave(bus, n)->output_bytes + (n < axis->position ? cm1e_bus_slave(bus, n)->input_bytes : 0u);
    lies[axis->network] = (lie_t){.axis = axis->number, .place = place + (size_t)inside};
}

bool wire_watches(const machine_axis_t *axis)
{
    return lies[axis->network].place > 0 && lies[axis->network].axis == axis->number;
}

void wire_lie(const machine_axis_t *axis, bool on, bool freeze, double offset)
{
    if (!wire_watches(axis))
        return;
    lies[axis->network].on = on;
    lies[axis->network].freeze = freeze;
    lies[axis->network].offset = (int32_t)offset;
}

void wire_attach(run_t *run)
{
    wire_forget();
    for (int i = 0; i < run->networks; i++)
        cm1e_nic_set_tap(cm1e_bus_nic(run->buses[i]), tap, &numbers[i]);
}

void wire_set(int network, wire_fault_t fault, bool on)
{
    faults[network] = on ? faults[network] | fault : faults[network] & ~(unsigned)fault;
}

void wire_stall(run_t *run, double cycles)
{
    cm1e_clock_t *clock = cm1e_bus_clock(run->buses[0]);
    cm1e_clock_sleep_until(clock, cm1e_clock_now(clock) + (int64_t)(cycles * run->scenario->cycle_us * 1000));
}

void wire_fall_back(run_t *run, int network, uint32_t position)
{
    cm1e_sim_slave_fall_back(cm1e_sim_segment_slave(run->segments[network], position), CM1E_AL_SAFE_OP, 0x001B);
}
