#include "bus/overlap.h"

#include <string.h>

#include "bus/bus_internal.h"
#include "core/bytes.h"

/** Of an FMMU (ETG.1000.4 table 57). */
enum { FMMU_LOGICAL_START = 0, FMMU_TYPE = 11, FMMU_READS = 1 };
enum { WRITE_TRIES = 3 }; /* a single disturbed frame is ridden out */

static uint32_t smaller(uint32_t a, uint32_t b) { return a < b ? a : b; }
static uint32_t larger(uint32_t a, uint32_t b) { return a > b ? a : b; }

/** The inputs end where the place of the slave ends. */
static uint32_t bytes_of(const cm1e_slave_placement_t *placement)
{
    return larger(placement->input_bytes,
                  placement->output_bytes + smaller(placement->input_bytes, CM1E_OVERLAP_OWN_BYTES));
}

/* ---- the start --------------------------------------------------------------------------------------------------- */

static cm1e_error_t refuse(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, const char *why, cm1e_diag_t *diag)
{
    char label[CM1E_LABEL_LENGTH];
    return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "%s %s: remove overlap from the configuration of the bus.",
                         cm1e_bus_label_first(bus, slave, label), why);
}

/** The FMMUs of one direction go from one logical address to another. */
static void move_fmmus(cm1e_slave_placement_t *placement, bool inputs, uint32_t from, uint32_t to)
{
    for (unsigned i = 0; i < placement->fmmu_count; i++) {
        uint8_t *fmmu = placement->fmmus[i];
        if ((fmmu[FMMU_TYPE] == FMMU_READS) == inputs)
            cm1e_put_u32(fmmu + FMMU_LOGICAL_START, cm1e_get_u32(fmmu + FMMU_LOGICAL_START) - from + to);
    }
}

static void place(cm1e_slave_placement_t *placement, uint32_t at)
{
    const uint32_t outputs = at, inputs = at + bytes_of(placement) - placement->input_bytes;
    move_fmmus(placement, false, placement->wire_output, outputs);
    move_fmmus(placement, true, placement->wire_input, inputs);
    placement->wire_output = outputs;
    placement->wire_input = inputs;
}

/** One slave behind the other; none is in two frames, so that each is whole or lost. */
static cm1e_error_t place_all(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    const uint32_t room = (uint32_t)cm1e_soem_frame_room() - CM1E_OVERLAP_NUMBER_BYTES;
    cm1e_overlap_t *overlap = &bus->overlap;
    uint32_t begin = 0, at = 0;
    overlap->frames = 0;
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        const uint32_t bytes = bytes_of(&slave->placement);
        if (cm1e_soem_refuses_lrw(bus->soem, slave->info.position))
            return refuse(bus, slave, "does not let one datagram read and write its process data", diag);
        if (bytes > room)
            return refuse(bus, slave, "has more process data than one frame takes", diag);
        if (at - begin + bytes > room) {
            if (overlap->frames + 1 == CM1E_PROCESS_FRAMES_MAX)
                return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "The process data of all slaves needs more than %d "
                                     "frames a cycle.", CM1E_PROCESS_FRAMES_MAX);
            overlap->ends[overlap->frames++] = at;
            at += CM1E_OVERLAP_NUMBER_BYTES;
            begin = at;
        }
        place(&slave->placement, at);
        at += bytes;
    }
    overlap->ends[overlap->frames++] = at;
    return CM1E_OK;
}

static cm1e_error_t write_fmmus(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    char label[CM1E_LABEL_LENGTH];
    const cm1e_bus_slave_t *slaves[CM1E_MAX_SLAVES];
    cm1e_datagram_t *batch = cm1e_soem_batch(bus->soem);
    unsigned count = 0;
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        const cm1e_slave_placement_t *placement = &bus->slaves[i].placement;
        const uint16_t bytes = (uint16_t)(placement->fmmu_count * FMMU_BYTES);
        if (bytes == 0)
            continue;
        cm1e_datagram_set(&batch[count], COMMAND_FPWR, bus->slaves[i].facts.station, REG_FMMU0, bytes);
        memcpy(batch[count].data, placement->fmmus, bytes);
        slaves[count++] = &bus->slaves[i];
    }
    cm1e_soem_transfer_all(bus->soem, batch, count, WRITE_TRIES);
    for (unsigned i = 0; i < count; i++)
        if (batch[i].working_counter != 1)
            return cm1e_diag_set(diag, CM1E_ERROR_BUS_WORKING_COUNTER, 0,
                                 "%s does not accept the places of its process data. Check its cables and its power.",
                                 cm1e_bus_label_first(bus, slaves[i], label));
    return CM1E_OK;
}

static void tell_soem(cm1e_bus_t *bus)
{
    uint32_t sizes[CM1E_PROCESS_FRAMES_MAX], begin = 0;
    unsigned takers = 0, givers = 0;
    for (unsigned i = 0; i < bus->overlap.frames; i++) {
        const uint32_t end = bus->overlap.ends[i] + CM1E_OVERLAP_NUMBER_BYTES;
        sizes[i] = end - begin;
        begin = end;
    }
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        takers += bus->slaves[i].placement.output_bytes > 0;
        givers += bus->slaves[i].placement.input_bytes > 0;
    }
    cm1e_soem_set_frames(bus->soem, sizes, bus->overlap.frames, takers, givers);
}

cm1e_error_t cm1e_overlap_map(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    cm1e_error_t error = place_all(bus, diag);
    if (error == CM1E_OK)
        error = write_fmmus(bus, diag);
    if (error != CM1E_OK)
        return error;
    tell_soem(bus);
    return CM1E_OK;
}

size_t cm1e_overlap_bytes(const cm1e_bus_t *bus)
{
    return (size_t)bus->overlap.ends[bus->overlap.frames - 1] + CM1E_OVERLAP_NUMBER_BYTES;
}

/* ---- the cycle --------------------------------------------------------------------------------------------------- */

void cm1e_overlap_fill(cm1e_bus_t *bus)
{
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        const cm1e_slave_placement_t *placement = &bus->slaves[i].placement;
        cm1e_bus_mark_inputs(bus, bus->image + placement->wire_input, placement->input_offset, placement->input_bytes);
        memcpy(bus->image + placement->wire_output, bus->outputs + placement->output_offset, placement->output_bytes);
    }
}

void cm1e_overlap_seal(cm1e_bus_t *bus)
{
    bus->overlap.number++;
    for (unsigned i = 0; i < bus->overlap.frames; i++)
        cm1e_put_u32(bus->image + bus->overlap.ends[i], bus->overlap.number);
    memcpy(bus->sent, bus->image, cm1e_overlap_bytes(bus));
}

static bool is_as_sent(const cm1e_bus_t *bus, uint32_t from, uint32_t bytes)
{
    return memcmp(bus->image + from, bus->sent + from, bytes) == 0;
}

/** No slave changes the number of a frame, nor outputs that its inputs do not cover. */
bool cm1e_overlap_is_answer(const cm1e_bus_t *bus)
{
    for (unsigned i = 0; i < bus->overlap.frames; i++)
        if (!is_as_sent(bus, bus->overlap.ends[i], CM1E_OVERLAP_NUMBER_BYTES))
            return false;
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        const cm1e_slave_placement_t *placement = &bus->slaves[i].placement;
        const uint32_t before_inputs = placement->wire_input - placement->wire_output;
        if (!is_as_sent(bus, placement->wire_output, smaller(before_inputs, placement->output_bytes)))
            return false;
    }
    return true;
}

bool cm1e_overlap_is_echo(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave)
{
    const cm1e_slave_placement_t *placement = &slave->placement;
    return placement->input_bytes > 0 && is_as_sent(bus, placement->wire_input, placement->input_bytes);
}

bool cm1e_overlap_has_echo(const cm1e_bus_t *bus)
{
    for (uint32_t i = 0; i < bus->slave_count; i++)
        if (cm1e_bus_has_motors(&bus->slaves[i]) && cm1e_overlap_is_echo(bus, &bus->slaves[i]))
            return true;
    return false;
}

void cm1e_overlap_take_inputs(cm1e_bus_t *bus)
{
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        const cm1e_slave_placement_t *placement = &bus->slaves[i].placement;
        memcpy(bus->inputs + placement->input_offset, bus->image + placement->wire_input, placement->input_bytes);
    }
}
