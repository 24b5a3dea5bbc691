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
#include "sim/bridge_app.h"
#include "sim/cia402_app.h"
#include "sim/cm1e_app.h"
#include "sim/esc_chip.h"
#include "sim/segment.h"

enum { LRW = 12, COMMAND_AT = 16, DATA_AT = 26, ACTUAL_POSITION = 0x6064, TARGET_POSITION = 0x607A, NEXT_CHANNEL = 0x800 };

/** An actual position that is not true. */
typedef struct lie {
    bool on, freeze;
    int axis;            /**< its number */
    size_t place;        /**< of its four bytes in the frame */
    int32_t offset, frozen;
} lie_t;

/** A motor whose counter did not begin at 0 at its power-on. */
typedef struct origin {
    size_t actual, target; /**< places in the frame; 0: none */
    uint32_t offset;
    int network;
} origin_t;

static origin_t origins[SCENARIO_AXES];
static int origin_count;
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

static void add_to(cm1e_tap_frame_t *frame, size_t place, uint32_t more)
{
    uint32_t value;
    if (place + sizeof value > frame->length)
        return;
    memcpy(&value, frame->bytes + place, sizeof value); /* little endian, as this machine */
    value += more;
    memcpy(frame->bytes + place, &value, sizeof value);
}

/** What goes out, in the counts of the motor; what comes back, in those that the master sees. In a broken ring a frame that
 *  came back goes out again, to the other side, with the positions that it has. */
static void move_origins(cm1e_tap_frame_t *frame, const int *network)
{
    for (int i = 0; i < origin_count; i++) {
        const origin_t *origin = &origins[i];
        const uint32_t more = frame->direction == CM1E_TAP_SENT ? -origin->offset : origin->offset;
        if (origin->network != *network)
            continue;
        add_to(frame, origin->actual, more);
        add_to(frame, origin->target, more);
    }
}

static cm1e_tap_verdict_t tap(void *context, cm1e_tap_frame_t *frame)
{
    const unsigned set = faults[*(const int *)context];
    lie_t *lie = &lies[*(const int *)context];
    if ((set == 0 && lie->place == 0 && origin_count == 0) || !is_process_data(frame))
        return CM1E_TAP_PASS;
    move_origins(frame, context);
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

/** Where the object of a motor is in the inputs, or outputs, of its slave; -1: it is not mapped to a byte. */
static int place_in_slave(const cm1e_bus_t *bus, const machine_axis_t *axis, unsigned object, bool output)
{
    const unsigned index = object + (axis->channel > 0 ? (axis->channel - 1) * NEXT_CHANNEL : 0);
    cm1e_io_info_t info;
    for (uint32_t n = 0; cm1e_io_at(bus, n, &info); n++)
        if (info.position == axis->position && info.output == output && info.index == index && info.bit_offset % 8 == 0)
            return (int)(info.bit_offset / 8);
    return -1;
}

/** Where it is in the frame, which has the outputs of all slaves, then their inputs; 0: nowhere. */
static size_t place_in_frame(const run_t *run, const machine_axis_t *axis, unsigned object, bool output)
{
    const cm1e_bus_t *bus = run->buses[axis->network];
    const int inside = is_motor(axis) ? place_in_slave(bus, axis, object, output) : -1;
    size_t place = DATA_AT;
    /* Bits of terminals share bytes; overlapped inputs are in other places. */
    if (inside < 0 || run->scenario->io > 0 || run->scenario->overlap != 0)
        return 0;
    for (uint32_t n = 1; n <= cm1e_bus_slave_count(bus); n++) {
        const cm1e_slave_info_t *slave = cm1e_bus_slave(bus, n);
        place += !output || n < axis->position ? slave->output_bytes : 0u;
        place += !output && n < axis->position ? slave->input_bytes : 0u;
    }
    return place + (size_t)inside;
}

void wire_watch(run_t *run, const machine_axis_t *axis)
{
    const size_t place = place_in_frame(run, axis, ACTUAL_POSITION, false);
    if (place > 0)
        lies[axis->network] = (lie_t){.axis = axis->number, .place = place};
}

static void attach_origin(run_t *run, const machine_axis_t *axis)
{
    const double counts = axis->spec->start * (axis->spec->invert != 0 ? -1 : 1);
    const origin_t origin = {.actual = place_in_frame(run, axis, ACTUAL_POSITION, false), .network = axis->network,
                             .target = place_in_frame(run, axis, TARGET_POSITION, true),
                             .offset = (uint32_t)(int64_t)counts};
    if (origin.actual == 0 || origin.target == 0)
        scenario_fail(run, "start", "%s: its position is not in a frame of its own", axis->name);
    else
        origins[origin_count++] = origin;
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
    origin_count = 0;
    for (int n = 0; n < run->scenario->axis_count; n++)
        if (run->axes[n].spec->start != 0)
            attach_origin(run, &run->axes[n]);
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

void wire_shove(const run_t *run, const machine_axis_t *axis, double velocity)
{
    cm1e_sim_slave_t *slave = cm1e_sim_segment_slave(run->segments[axis->network], axis->position);
    cm1e_sim_cm1e_t *drive = cm1e_sim_cm1e_of(slave);
    cm1e_sim_cia402_t *other = cm1e_sim_cia402_of(slave);
    cm1e_sim_bridge_t *bridge = cm1e_sim_bridge_of(slave);
    if (axis->probe.torque_on)
        return;
    if (drive)
        drive->mechanics.velocity = velocity;
    else if (other)
        other->mechanics.velocity = velocity / other->scale;
    else if (bridge && axis->channel > 0)
        bridge->axes[axis->channel - 1].mechanics.velocity = velocity / bridge->axes[axis->channel - 1].scale;
}

void wire_fall_back(run_t *run, int network, uint32_t position)
{
    cm1e_sim_slave_fall_back(cm1e_sim_segment_slave(run->segments[network], position), CM1E_AL_SAFE_OP, 0x001B);
}
