/* Markers in the inputs of a frame: who takes part in the cycle overwrites its own. */
#include <string.h>

#include "bus/bus_internal.h"

/** Half of the bits of a byte differ from the last inputs; the other half in the next cycle. */
static const uint8_t markers[2] = {0xA5, 0x5A};

void cm1e_bus_make_markers(cm1e_bus_t *bus)
{
    for (int turn = 0; turn < 2; turn++) {
        memset(bus->silence.markers[turn], markers[turn], bus->input_bytes);
        for (uint32_t i = 0; i < bus->slave_count; i++) {
            const cm1e_slave_placement_t *placement = &bus->slaves[i].placement;
            if (placement->input_bytes > 0)
                bus->silence.markers[turn][placement->input_offset + placement->input_bytes - 1u] &=
                    placement->last_input_bits;
        }
    }
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
