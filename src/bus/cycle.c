#include <string.h>

#include "bus/bus_internal.h"

bool cm1e_bus_is_silent(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave)
{
    const uint32_t offset = slave->placement.input_offset;
    const uint8_t *came = bus->image + slave->placement.wire_input, *last = bus->inputs + offset;
    const uint8_t *marker = bus->silence.markers[bus->silence.turn] + offset;
    if (bus->overlap.used)
        return cm1e_overlap_is_echo(bus, slave);
    for (unsigned i = 0; i < slave->placement.input_bytes; i++)
        if ((came[i] ^ last[i]) != marker[i])
            return false;
    return slave->placement.input_bytes > 0;
}

void cm1e_bus_find_silence(cm1e_bus_t *bus)
{
    if (bus->silence.found)
        return;
    bus->silence.found = true;
    bus->silence.any = false;
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        const bool silent = cm1e_bus_is_silent(bus, slave);
        slave->silent_cycles = silent ? slave->silent_cycles + (slave->silent_cycles < UINT32_MAX) : 0;
        bus->silence.any |= silent && slave->hot.counted;
    }
}

/** Whether some of the slaves that may be missing explain what is missing in the working counter: `inputs` of them
 *  count 1, `both` count 3, and `takers` of the others may take no outputs, which counts 2. */
static bool is_explained(int missing, int inputs, int both, int takers)
{
    for (int n = 0; n <= both; n++) {
        const int left = missing - 3 * n, most = 2 * (takers + both - n);
        const int least = left > most ? left - most : 0, first = least + (left - least) % 2;
        if (left >= 0 && first <= inputs && first <= left)
            return true;
    }
    return false;
}

/** Returns true if the silent slaves explain the working counter: 3 less for each of them (or its own share), 2 less
 *  for each slave that took no outputs. Any number of those with few inputs may only seem to be silent. */
static bool silence_explains(const cm1e_bus_t *bus, int working_counter)
{
    int missing = bus->expected_working_counter - working_counter, takers = 0, may_be[2] = {0, 0};
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        const cm1e_bus_slave_t *slave = &bus->slaves[i];
        if (!slave->hot.counted)
            continue;
        const bool silent = slave->silent_cycles > 0, takes = slave->placement.output_bytes > 0;
        if (silent && !cm1e_bus_is_unmistakable(slave))
            may_be[takes]++;
        else
            missing -= silent ? 1 + 2 * takes : 0;
        takers += takes && !silent;
    }
    return is_explained(missing, may_be[0], may_be[1], takers);
}

/** A cycle with a wrong working counter: the inputs of the slaves that took part are valid, if the others can be
 *  identified. */
static void take_slave_by_slave(cm1e_bus_t *bus, int working_counter)
{
    cm1e_bus_find_silence(bus);
    bus->silence.partly_fresh = silence_explains(bus, working_counter);
    for (uint32_t i = 0; i < bus->slave_count && bus->silence.partly_fresh; i++) {
        const cm1e_slave_placement_t *placement = &bus->slaves[i].placement;
        if (bus->slaves[i].silent_cycles == 0 && bus->slaves[i].hot.counted)
            memcpy(bus->inputs + placement->input_offset, bus->image + placement->wire_input, placement->input_bytes);
    }
}

static void forget_silence(cm1e_bus_t *bus)
{
    for (uint32_t i = 0; i < bus->slave_count && bus->silence.any; i++)
        if (bus->slaves[i].hot.counted)
            bus->slaves[i].silent_cycles = 0;
    bus->silence.any = false;
}

/** No slave changes outputs on their way. If they differ from those that were sent, the inputs are not trusted
 *  either. */
static bool is_answer(const cm1e_bus_t *bus)
{
    return bus->overlap.used ? cm1e_overlap_is_answer(bus) : memcmp(bus->image, bus->sent, bus->output_bytes) == 0;
}

/** Judges a received process image. */
static cm1e_error_t judge(cm1e_bus_t *bus, int working_counter)
{
    if (working_counter == DATAGRAM_LOST || !is_answer(bus)) {
        bus->counters.lost_frames++;
        return CM1E_ERROR_BUS_LOST;
    }
    if (!cm1e_hot_judge(bus, working_counter) || (bus->overlap.used && cm1e_overlap_has_echo(bus))) {
        bus->counters.working_counter_errors++;
        return CM1E_ERROR_BUS_WORKING_COUNTER;
    }
    return CM1E_OK;
}

cm1e_error_t cm1e_bus_receive(cm1e_bus_t *bus)
{
    if (!bus)
        return CM1E_ERROR_INVALID_ARGUMENT;
    if (!bus->in_flight)
        return CM1E_ERROR_STATE;
    cm1e_clock_make_current(bus->clock);
    bus->in_flight = bus->silence.found = false;
    const int working_counter = cm1e_soem_receive_process_data(bus->soem, bus->config.frame_timeout_ns);
    const cm1e_error_t error = judge(bus, working_counter);
    cm1e_dc_receive(bus, error != CM1E_ERROR_BUS_LOST);
    bus->counters.cycles++;
    bus->silence.partly_fresh = false;
    if (error == CM1E_ERROR_BUS_WORKING_COUNTER)
        take_slave_by_slave(bus, working_counter);
    if (error == CM1E_OK) {
        forget_silence(bus);
        if (bus->overlap.used)
            cm1e_overlap_take_inputs(bus);
        else
            cm1e_hot_take_inputs(bus);
        bus->bad_cycles = 0;
    } else {
        bus->bad_cycles += bus->bad_cycles < UINT32_MAX;
    }
    bus->last_error = error;
    bus->counters.late_frames = cm1e_soem_late_frames(bus->soem);
    /* Another thread may make the text of a fault, which tells these two. */
    __atomic_store_n(&bus->counters.foreign_frames, cm1e_soem_foreign_frames(bus->soem), __ATOMIC_RELAXED);
    __atomic_store_n(&bus->counters.unsent_frames, cm1e_soem_unsent_frames(bus->soem), __ATOMIC_RELAXED);
    cm1e_acyclic_receive(bus, 0);
    const int64_t now_ns = cm1e_clock_now(bus->clock);
    cm1e_supervision_receive(bus, now_ns);
    cm1e_listen_receive(bus, now_ns);
    return error;
}

/** Slaves of the configuration get their safe values instead: cm1e_bus_make_outputs_safe(). An optional slave that is
 *  away may still take outputs, because its recovery has failed or its answers were lost. */
static void mute_recovering(cm1e_bus_t *bus)
{
    const bool none = bus->acyclic.rests && !bus->search.used;
    for (uint32_t i = 0; i < bus->slave_count && !none; i++) {
        const cm1e_bus_slave_t *slave = &bus->slaves[i];
        if ((cm1e_recovery_mutes(&slave->recovery) || slave->hot.away) && !slave->config)
            memset(bus->image + slave->placement.wire_output, 0, slave->placement.output_bytes);
    }
}

static void fill_image(cm1e_bus_t *bus)
{
    cm1e_bus_turn_markers(bus);
    if (bus->overlap.used) {
        cm1e_overlap_fill(bus);
        mute_recovering(bus);
        cm1e_overlap_seal(bus);
        return;
    }
    memcpy(bus->image, bus->outputs, bus->output_bytes);
    mute_recovering(bus);
    memcpy(bus->sent, bus->image, bus->output_bytes);
    cm1e_bus_mark_inputs(bus, bus->image + bus->output_bytes, 0, bus->input_bytes);
}

void cm1e_bus_send(cm1e_bus_t *bus)
{
    if (!bus || !bus->exchanging)
        return;
    const int64_t now_ns = cm1e_bus_enter(bus);
    if (bus->in_flight) /* never two frames: the old one is given up */
        cm1e_soem_receive_process_data(bus->soem, 0);
    cm1e_bus_make_outputs_safe(bus);
    fill_image(bus);
    cm1e_dc_send(bus, now_ns);
    cm1e_supervision_ask(bus, now_ns);
    cm1e_listen_ask(bus, now_ns);
    cm1e_soem_send_process_data(bus->soem);
    bus->in_flight = true;
    bus->sent_ns = now_ns;
    cm1e_listen_send(bus, now_ns);
    cm1e_acyclic_send(bus, now_ns, bus->acyclic.per_cycle - bus->listening.sent); /* a look takes the turn of one */
    cm1e_supervision_send(bus, now_ns);
}

cm1e_error_t cm1e_bus_health(const cm1e_bus_t *bus)
{
    if (!bus)
        return CM1E_ERROR_INVALID_ARGUMENT;
    return bus->bad_cycles >= bus->config.lost_cycles_limit ? bus->last_error : CM1E_OK;
}
