/* What a frame carries in the place of inputs, until slaves write theirs. */
#include <string.h>

#include "bus/bus_internal.h"

/** Half of the bits of a byte differ from the last inputs; the other half in the next cycle. Inputs that change by just
 *  these bits are taken for a marker in one cycle, and not in the next one. */
enum { MARKER = 0xA5 };

void cm1e_bus_choose_marker(cm1e_bus_t *bus)
{
    bus->silence.marker = bus->silence.marker == MARKER ? (uint8_t)~MARKER : MARKER;
}

void cm1e_bus_mark_inputs(const cm1e_bus_t *bus, uint8_t *place, uint32_t input_offset, size_t bytes)
{
    const uint8_t *inputs = bus->inputs + input_offset;
    const uint64_t markers = bus->silence.marker * UINT64_C(0x0101010101010101);
    uint64_t word;
    for (; bytes >= sizeof word; bytes -= sizeof word) {
        memcpy(&word, inputs, sizeof word);
        word ^= markers;
        memcpy(place, &word, sizeof word);
        inputs += sizeof word;
        place += sizeof word;
    }
    for (size_t i = 0; i < bytes; i++)
        place[i] = inputs[i] ^ bus->silence.marker;
}
