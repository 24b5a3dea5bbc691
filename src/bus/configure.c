#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "bus/io_list.h"
#include "core/bytes.h"
#include "core/in_task.h"

/** Some 40 transfers of at most CM1E_START_SDO_TIMEOUT_NS each, all slaves at once; in practice some milliseconds. */
#define MAPPING_TIMEOUT_NS INT64_C(60000000000)

/** The wire at 100 Mbit/s; a frame's preamble, headers, FCS and gap; the way through a slave, there and back; and what
 *  the supervision and one mailbox of a CM1-E take beside the process data. */
enum {
    NS_PER_BYTE = 80, FRAME_OVERHEAD_BYTES = 52, NS_PER_SLAVE = 1200, NS_OF_SUPERVISION = 7000, NS_OF_MAILBOX = 14500,
};

/** UG 4.3: four cycle times; before V1.3.2 only 1 ms (UG 10.1). An unreadable version is given the benefit. Behind a
 *  bridge 1 ms (BR 6.3). */
static cm1e_error_t check_cycle_time(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, cm1e_diag_t *diag)
{
    char label[CM1E_LABEL_LENGTH], list[CM1E_CYCLE_TIMES_TEXT];
    const cm1e_device_t *device = slave->info.device;
    const int64_t cycle_ns = bus->config.cycle_time_ns;
    const bool known = cm1e_device_has_cycle_time(device, cycle_ns);
    if (!known && device->cycle_time_count == 1)
        return cm1e_diag_set(diag, CM1E_ERROR_BUS_CYCLE_TIME, 0,
                             "%s runs with a cycle time of %s us only; configured are %lld us, for all slaves.",
                             cm1e_bus_label_first(bus, slave, label), cm1e_device_cycle_times(device, "and", list),
                             (long long)(cycle_ns / 1000));
    if (!known)
        return cm1e_diag_set(diag, CM1E_ERROR_BUS_CYCLE_TIME, 0,
                             "The cycle time of %lld us is not one of %s us, which %s accepts.",
                             (long long)(cycle_ns / 1000), cm1e_device_cycle_times(device, "and", list),
                             cm1e_bus_label(bus, slave, label));
    if (slave->firmware && !slave->firmware->all_cycle_times && cycle_ns != 1000000)
        return cm1e_diag_set(diag, CM1E_ERROR_BUS_CYCLE_TIME, 0,
                             "%s has firmware %s, which accepts a cycle time of 1000 us only (V1.3.2 and later: also "
                             "200, 250, 500 us); configured are %lld us.", cm1e_bus_label_first(bus, slave, label),
                             slave->info.software_version, (long long)(cycle_ns / 1000));
    return CM1E_OK;
}

static cm1e_error_t read_mappings(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    const int64_t deadline_ns = cm1e_clock_now(bus->clock) + MAPPING_TIMEOUT_NS;
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        if (!cm1e_bus_has_motors(slave) || !cm1e_bus_was_there(slave))
            continue;
        const cm1e_pdo_choice_t choice = slave->info.device->pdos(cm1e_bus_axis_of(bus, slave, 0));
        cm1e_mapping_begin(&slave->mapping, slave->info.position, &choice);
    }
    const bool ended = cm1e_bus_pump_until_idle(bus, deadline_ns);
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        char label[CM1E_LABEL_LENGTH];
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        if (!cm1e_bus_has_motors(slave) || !cm1e_bus_was_there(slave))
            continue;
        if (!ended && !cm1e_mapping_idle(&slave->mapping)) {
            cm1e_acyclic_cancel(bus);
            return cm1e_diag_set(diag, CM1E_ERROR_TIMEOUT, 0, "%s takes too long to report its PDO mapping.",
                                 cm1e_bus_label_first(bus, slave, label));
        }
        const cm1e_error_t error = cm1e_bus_take_mapping(bus, slave, diag);
        if (error != CM1E_OK)
            return error;
    }
    return CM1E_OK;
}

static cm1e_error_t set_process_data(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        const uint16_t position = slave->info.position, outputs = slave->mapped[0].bits, inputs = slave->mapped[1].bits;
        const uint16_t *room = slave->hot.room;
        const bool ok = slave->hot.planned
                            ? cm1e_soem_set_process_data(bus->soem, position, 8 * room[0], 8 * room[1])
                        : cm1e_bus_has_motors(slave)
                            ? cm1e_soem_set_process_data(bus->soem, position, outputs, inputs)
                        : slave->by_pdos ? cm1e_soem_set_process_data_by_pdos(bus->soem, position, outputs, inputs)
                                         : cm1e_soem_set_process_data_by_sii(bus->soem, position);
        char label[CM1E_LABEL_LENGTH];
        if (!ok)
            return cm1e_diag_set(diag, CM1E_ERROR_PDO_MAPPING, 0,
                                 "The process data of %s does not fit its sync managers: %s.",
                                 cm1e_bus_label(bus, slave, label),
                                 slave->by_pdos ? "assign fewer PDOs" : "its SII is damaged");
    }
    return CM1E_OK;
}

/** All that has a byte for each byte of the image. */
enum { IMAGE_PARTS = 9 };

static uint8_t **image_part(cm1e_bus_t *bus, int part)
{
    uint8_t **const parts[IMAGE_PARTS] = {&bus->image, &bus->sent, &bus->outputs, &bus->inputs,
                                          &bus->silence.markers[0],
                                          &bus->silence.markers[1], &bus->safe.values, &bus->safe.mask,
                                          &bus->safe.claimed};
    return parts[part];
}

void cm1e_bus_free_image(cm1e_bus_t *bus)
{
    for (int part = 0; part < IMAGE_PARTS; part++) {
        free(*image_part(bus, part));
        *image_part(bus, part) = NULL;
    }
    for (uint32_t i = 0; i < bus->slave_room; i++) {
        free(bus->slaves[i].signals);
        bus->slaves[i].signals = NULL;
    }
    bus->output_bytes = bus->input_bytes = 0;
    bus->layout.present = 0;
}

static bool make_image(cm1e_bus_t *bus, size_t room)
{
    bool made = true;
    cm1e_bus_free_image(bus);
    for (int part = 0; part < IMAGE_PARTS; part++) {
        *image_part(bus, part) = calloc(1, room + 1);
        made = made && *image_part(bus, part);
    }
    return made;
}

static void take_placements(cm1e_bus_t *bus)
{
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        cm1e_slave_placement_t *placement = &slave->placement;
        cm1e_soem_placement(bus->soem, slave->info.position, placement);
        placement->wire_output = placement->output_offset;
        placement->wire_input = (uint32_t)bus->output_bytes + placement->input_offset;
        slave->info.output_bytes = placement->output_bytes;
        slave->info.input_bytes = placement->input_bytes;
    }
}

static cm1e_error_t map_image(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    const size_t room = cm1e_soem_image_bytes(bus->soem);
    bus->overlap.used = false;
    if (!make_image(bus, room + (size_t)CM1E_PROCESS_FRAMES_MAX * CM1E_OVERLAP_NUMBER_BYTES))
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "Out of memory for the process image.");
    /* Overlapped process data take at least half of the bytes. */
    const unsigned most_frames = CM1E_PROCESS_FRAMES_MAX * (bus->config.overlap ? 2 : 1);
    if (!cm1e_soem_map(bus->soem, (uint16_t)bus->scanned, bus->image, most_frames, &bus->output_bytes,
                       &bus->input_bytes))
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                             "The process data of all slaves (%zu bytes) needs more than %d frames a cycle.", room,
                             CM1E_PROCESS_FRAMES_MAX);
    bus->layout.present = ++bus->layout.made;
    take_placements(bus);
    cm1e_bus_make_markers(bus);
    if (bus->config.overlap) {
        const cm1e_error_t error = cm1e_overlap_map(bus, diag);
        if (error != CM1E_OK)
            return error;
        bus->overlap.used = true;
    }
    cm1e_hot_count_begin(bus);
    return CM1E_OK;
}

static cm1e_error_t list_signals(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    cm1e_error_t error = CM1E_OK;
    for (uint32_t i = 0; i < bus->slave_count && error == CM1E_OK; i++)
        if (bus->slaves[i].config)
            error = cm1e_io_list_make(bus, &bus->slaves[i], diag);
    return error != CM1E_OK ? error : cm1e_bus_prepare_safe_outputs(bus, diag);
}

int64_t cm1e_bus_wire_ns(const cm1e_bus_t *bus)
{
    const size_t frames = cm1e_soem_process_frames(bus->soem);
    const size_t data = bus->overlap.used ? cm1e_overlap_bytes(bus) : bus->output_bytes + bus->input_bytes;
    return (int64_t)(data + frames * FRAME_OVERHEAD_BYTES) * NS_PER_BYTE + (int64_t)bus->slave_count * NS_PER_SLAVE;
}

/** A bus whose frames come back after the next cycle has begun would start, and then lose most of them. Where the
 *  process data leave little time, fewer mailboxes have their turn in a cycle. */
static cm1e_error_t share_wire_time(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    const size_t frames = cm1e_soem_process_frames(bus->soem);
    const int64_t wire_ns = cm1e_bus_wire_ns(bus);
    const int64_t mailboxes = (bus->config.cycle_time_ns - wire_ns - NS_OF_SUPERVISION) / NS_OF_MAILBOX;
    if (mailboxes >= 1) {
        bus->acyclic.per_cycle = mailboxes < CM1E_DATAGRAMS_PER_CYCLE ? (unsigned)mailboxes : CM1E_DATAGRAMS_PER_CYCLE;
        return CM1E_OK;
    }
    return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0,
                         "The process data of %u slaves (%zu frames) takes about %lld us on the wire, mailboxes and "
                         "supervision at least %d us more: too long for a cycle time of %lld us.", bus->slave_count,
                         frames, (long long)(wire_ns / 1000), (NS_OF_SUPERVISION + NS_OF_MAILBOX) / 1000,
                         (long long)(bus->config.cycle_time_ns / 1000));
}

/** Writes a word into every slave, and clears `taken` of those that do not take it. */
static void write_words(cm1e_bus_t *bus, uint16_t offset, const uint16_t *values, bool *taken)
{
    enum { FRAME_TRIES = 3 }; /* a single disturbed frame is ridden out */
    cm1e_datagram_t *batch = cm1e_soem_batch(bus->soem);
    for (uint32_t i = 0; i < bus->scanned; i++) {
        cm1e_datagram_set(&batch[i], COMMAND_FPWR, bus->slaves[i].facts.station, offset, 2);
        cm1e_put_u16(batch[i].data, values[i]);
    }
    cm1e_soem_transfer_all(bus->soem, batch, bus->scanned, FRAME_TRIES);
    for (uint32_t i = 0; i < bus->scanned; i++)
        taken[i] &= batch[i].working_counter == 1;
}

/** A motor that did not take it might go on for ever when the frames stay away. Another device may have none. */
static cm1e_error_t set_watchdogs(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    char label[CM1E_LABEL_LENGTH];
    uint16_t dividers[CM1E_MAX_SLAVES], times[CM1E_MAX_SLAVES];
    bool taken[CM1E_MAX_SLAVES];
    for (uint32_t i = 0; i < bus->scanned; i++) {
        dividers[i] = CM1E_WATCHDOG_DIVIDER;
        times[i] = cm1e_bus_watchdog(&bus->slaves[i]);
        taken[i] = true;
    }
    write_words(bus, REG_WATCHDOG_DIVIDER, dividers, taken);
    write_words(bus, REG_WATCHDOG_PROCESS_DATA, times, taken);
    for (uint32_t i = 0; i < bus->scanned; i++)
        if (!taken[i] && cm1e_bus_has_motors(&bus->slaves[i]))
            return cm1e_diag_set(diag, CM1E_ERROR_BUS_WORKING_COUNTER, 0,
                                 "%s does not accept the time of its watchdog. Check its cables and its power.",
                                 cm1e_bus_label_first(bus, &bus->slaves[i], label));
    return CM1E_OK;
}

cm1e_error_t cm1e_bus_configure(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_bus_configure()", "", diag);
    if (!bus)
        return cm1e_bus_missing("cm1e_bus_configure()", diag);
    cm1e_error_t error = cm1e_bus_refuse_attached(bus, "Configuring the slaves", diag);
    if (error != CM1E_OK)
        return error;
    if (bus->phase < BUS_IDENTIFIED || bus->phase >= BUS_OPERATING)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "Identify the slaves before configuring them.");
    if (bus->phase == BUS_CONFIGURED)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "The slaves are configured already: scan again to start anew.");
    cm1e_bus_enter(bus);
    for (uint32_t i = 0; i < bus->slave_count && error == CM1E_OK; i++) {
        if (cm1e_bus_has_motors(&bus->slaves[i]))
            error = check_cycle_time(bus, &bus->slaves[i], diag);
    }
    if (error == CM1E_OK)
        error = cm1e_dc_find_pulses(bus, diag);
    if (error == CM1E_OK)
        error = read_mappings(bus, diag);
    if (error == CM1E_OK)
        error = cm1e_bus_set_up_slaves(bus, false, diag);
    if (error == CM1E_OK)
        error = cm1e_bus_read_pdos(bus, diag);
    for (uint32_t i = bus->scanned; i < bus->slave_count && error == CM1E_OK; i++)
        error = cm1e_hot_reserve(bus, &bus->slaves[i], diag);
    if (error == CM1E_OK)
        error = set_process_data(bus, diag);
    if (error == CM1E_OK)
        error = map_image(bus, diag);
    if (error == CM1E_OK)
        error = cm1e_bus_check_resources(bus, diag);
    if (error == CM1E_OK)
        error = list_signals(bus, diag);
    if (error == CM1E_OK)
        error = share_wire_time(bus, diag);
    if (error == CM1E_OK)
        error = set_watchdogs(bus, diag);
    if (error == CM1E_OK)
        error = cm1e_dc_set_up(bus, diag);
    if (error == CM1E_OK)
        error = cm1e_bus_all_to_state(bus, CM1E_AL_SAFE_OP, CM1E_STATE_TIMEOUT_NS, diag);
    if (error == CM1E_OK)
        error = cm1e_bus_set_up_slaves(bus, true, diag);
    if (error == CM1E_OK)
        cm1e_bus_set_phase(bus, BUS_CONFIGURED);
    return error;
}

/* ---- the image, for the drive room ----------------------------------------------------------------------------- */

static cm1e_image_slot_t find_slot(const cm1e_bus_t *bus, uint16_t position, int direction, uint16_t index,
                                   uint8_t subindex)
{
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    if (!slave || !bus->image)
        return (cm1e_image_slot_t){0};
    const cm1e_mapped_entry_t *entry = cm1e_mapping_find(&slave->mapped[direction], index, subindex);
    if (!entry)
        return (cm1e_image_slot_t){0};
    const uint32_t base = direction ? slave->placement.input_offset : slave->placement.output_offset;
    return (cm1e_image_slot_t){.offset = (base + entry->bit_offset / 8u) & 0xFFFFFF,
                               .bytes = (uint8_t)(entry->bits / 8)};
}

cm1e_image_slot_t cm1e_bus_find_output(const cm1e_bus_t *bus, uint16_t position, uint16_t index, uint8_t subindex)
{
    return find_slot(bus, position, 0, index, subindex);
}

cm1e_image_slot_t cm1e_bus_find_input(const cm1e_bus_t *bus, uint16_t position, uint16_t index, uint8_t subindex)
{
    return find_slot(bus, position, 1, index, subindex);
}

uint8_t *cm1e_bus_outputs(cm1e_bus_t *bus) { return bus->outputs; }
const uint8_t *cm1e_bus_inputs(const cm1e_bus_t *bus) { return bus->inputs; }
