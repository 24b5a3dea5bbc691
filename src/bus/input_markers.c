/* Markers in the inputs of a frame: who takes part in the cycle overwrites its own. */
#include <string.h>

#include "bus/bus_internal.h"

/** Half of the bits of a byte differ from the last inputs; the other half in the next cycle. */
static const uint8_t markers[2] = {0xA5, 0x5A};

/** Bits of inputs that are all that a slave has, and of which one marker has none: a single bit. */
static uint8_t single_bit_of(const cm1e_slave_placement_t *placement)
{
    const uint8_t bits = placement->input_bytes == 1 ? placement->last_input_bits : 0;
    return (markers[0] & bits) && (markers[1] & bits) ? 0 : bits;
}

void cm1e_bus_make_markers(cm1e_bus_t *bus)
{
    for (int turn = 0; turn < 2; turn++) {
        memset(bus->silence.markers[turn], markers[turn], bus->input_bytes);
        bus->silence.single_bits = false;
        for (uint32_t i = 0; i < bus->slave_count; i++) {
            const cm1e_slave_placement_t *placement = &bus->slaves[i].placement;
            if (placement->input_bytes > 0)
                bus->silence.markers[turn][placement->input_offset + placement->input_bytes - 1u] &=
                    placement->last_input_bits;
            bus->silence.single_bits |= single_bit_of(placement) != 0;
        }
    }
}

/** A single bit that stays would be like every second marker. So its marker is the other value, as long as the slave is
 *  heard. One that seemed to be silent may have changed to just that, so the next marker is the last value: then the
 *  change shows. */
static void mark_single_bits(cm1e_bus_t *bus)
{
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        const cm1e_bus_slave_t *slave = &bus->slaves[i];
        const uint8_t bits = single_bit_of(&slave->placement);
        if (bits)
            bus->silence.markers[bus->silence.turn][slave->placement.input_offset] = slave->silent_cycles % 2 ? 0
                                                                                                              : bits;
    }
}

void cm1e_bus_turn_markers(cm1e_bus_t *bus)
{
    bus->silence.turn = !bus->silence.turn;
    if (bus->silence.single_bits)
        mark_single_bits(bus);
}

void cm1e_bus_mark_inputs(const cm1e_bus_t *bus, uint8_t *place, uint32_t input_offset, size_t bytes)
{
    const uint8_t *inputs = bus->inputs + input_offset;
    const uint8_t *marker = bus->silence.markers[bus->silence.turn] + input_offset;
    uint64_t word, change;
    size_t at = 0;
    for (; at + sizeof word <= bytes; at += sizeof word) {
        memcpy(&word, inputs + at, sizeof word);
        memcpy(&change, marker + at, sizeof change);
        word ^= change;
        memcpy(place + at, &word, sizeof word);
    }
    for (; at < bytes; at++)
        place[at] = inputs[at] ^ marker[at];
}
