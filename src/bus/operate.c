#include <stdio.h>

#include "bus/bus_internal.h"
#include "bus/kept.h"
#include "core/bytes.h"
#include "core/in_task.h"

/** Exchanges in a row before Operational is requested, so that the slaves have valid outputs; and good exchanges
 *  afterwards. */
enum { EXCHANGES = 3 };
#define EXCHANGE_NS INT64_C(2000000000)
/** A bus that waited longer for its scheduler may have lost slaves to their watchdogs. */
#define WAITED_NS INT64_C(20000000)
/** ns; for each of the two steps down of cm1e_bus_stop(). */
#define STOP_STEP_NS INT64_C(500000000)
/** ns; within this time a slave takes an acknowledgement. */
#define ACKNOWLEDGE_NS INT64_C(20000000)

static void exchange_once(cm1e_bus_t *bus, bool at_once)
{
    if (!at_once) {
        cm1e_bus_pump(bus);
        return;
    }
    cm1e_bus_pump_cycle(bus);
    cm1e_clock_sleep_until(bus->clock, cm1e_clock_now(bus->clock) + cm1e_bus_wire_ns(bus));
    bus->next_cycle_ns = cm1e_clock_now(bus->clock);
}

static cm1e_error_t nothing_comes_back(const cm1e_bus_t *bus, uint64_t late, cm1e_error_t error, cm1e_diag_t *diag)
{
    char other[CM1E_OTHER_MASTER_LENGTH], how[200] = "";
    if (error == CM1E_ERROR_BUS_LOST && late > 0)
        snprintf(how, sizeof how, " %llu of them came back after the %lld us of frame_timeout_us: look for what delays "
                 "them, or make that time longer, at most a cycle.", (unsigned long long)late,
                 (long long)(bus->config.frame_timeout_ns / US_IN_NS));
    return cm1e_diag_set(diag, error == CM1E_OK ? CM1E_ERROR_TIMEOUT : error, 0,
                         "The process data does not come back as it must after configuration (working counter %d "
                         "expected): %s.%s%s", bus->expected_working_counter, cm1e_strerror(error), how,
                         cm1e_bus_other_master(bus, other));
}

/** Exchanges until the process data comes back. Whether all slaves count is asked in Operational only: a slave may keep
 *  its outputs closed until then (ETG.1000.4: sync manager deactivated by the device), and they do not count. */
static cm1e_error_t exchange(cm1e_bus_t *bus, bool operational, cm1e_diag_t *diag)
{
    const int64_t deadline_ns = cm1e_clock_now(bus->clock) + EXCHANGE_NS;
    const bool at_once = !operational && !bus->dc.used; /* nobody looks at the time between two frames yet */
    const uint64_t late = bus->counters.late_frames;
    unsigned good = 0;
    while (good < EXCHANGES) {
        const uint64_t before = bus->counters.cycles;
        exchange_once(bus, at_once);
        const cm1e_error_t error = bus->last_error;
        if (bus->counters.cycles != before)
            good = error == CM1E_OK || (!operational && error == CM1E_ERROR_BUS_WORKING_COUNTER) ? good + 1 : 0;
        if (cm1e_clock_now(bus->clock) < deadline_ns)
            continue;
        return nothing_comes_back(bus, bus->counters.late_frames - late, error, diag);
    }
    return CM1E_OK;
}

cm1e_error_t cm1e_bus_operate(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_bus_operate()", "", diag);
    if (!bus)
        return cm1e_bus_missing("cm1e_bus_operate()", diag);
    if (bus->phase != BUS_CONFIGURED)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "Configure the slaves before bringing them to Operational.");
    cm1e_bus_enter(bus);
    cm1e_port_watch_begin(bus);
    bus->next_cycle_ns = cm1e_bus_enter(bus);
    bus->exchanging = true;
    bus->bad_cycles = 0;
    cm1e_dc_begin(bus);
    cm1e_error_t error = exchange(bus, false, diag);
    if (error == CM1E_OK)
        error = cm1e_dc_wait(bus, diag);
    if (error == CM1E_OK)
        error = cm1e_bus_all_to_state(bus, CM1E_AL_OP, CM1E_STATE_TIMEOUT_NS, diag);
    if (error == CM1E_OK)
        error = exchange(bus, true, diag);
    if (error != CM1E_OK) {
        cm1e_bus_stop(bus);
        return error;
    }
    bus->operations++;
    cm1e_bus_set_phase(bus, BUS_OPERATING);
    cm1e_bus_keep(bus);
    return CM1E_OK;
}

/** Optional slaves that left while nobody looked: their inputs show it. */
static void lose_silent(cm1e_bus_t *bus)
{
    for (uint32_t i = 0; i < bus->slave_count; i++)
        if (bus->slaves[i].hot.optional && !bus->slaves[i].hot.away && !bus->slaves[i].hot.counted &&
            bus->slaves[i].silent_cycles > 0)
            cm1e_supervision_lose(bus, &bus->slaves[i]);
}

cm1e_error_t cm1e_bus_resume(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    if (cm1e_bus_enter(bus) - bus->sent_ns < WAITED_NS)
        return CM1E_OK;
    cm1e_error_t error = exchange(bus, false, diag);
    lose_silent(bus);
    if (error == CM1E_OK)
        error = cm1e_bus_all_to_state(bus, CM1E_AL_OP, CM1E_STATE_TIMEOUT_NS, diag);
    if (error == CM1E_OK)
        error = exchange(bus, true, diag);
    return error;
}

cm1e_error_t cm1e_bus_start(cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_bus_start()", "", diag);
    if (!bus)
        return cm1e_bus_missing("cm1e_bus_start()", diag);
    cm1e_error_t error = cm1e_bus_scan(bus, diag);
    if (error == CM1E_OK)
        error = cm1e_bus_identify(bus, diag);
    if (error == CM1E_OK)
        error = cm1e_bus_configure(bus, diag);
    if (error == CM1E_OK)
        error = cm1e_bus_operate(bus, diag);
    if (error != CM1E_OK && bus->phase != BUS_OPERATING)
        cm1e_bus_stop(bus);
    return error;
}

static void request_of_all(cm1e_bus_t *bus, unsigned al_control)
{
    uint8_t control[2];
    cm1e_put_u16(control, (uint16_t)al_control);
    cm1e_soem_transfer(bus->soem, COMMAND_BWR, 0, REG_AL_CONTROL, control, sizeof control);
}

/** Waits until no slave shows one of these bits of AL status, or the time is over. Returns what they show, ORed. */
static unsigned wait_for_all(cm1e_bus_t *bus, unsigned bits, int64_t time_ns)
{
    const int64_t deadline_ns = cm1e_clock_now(bus->clock) + time_ns;
    uint8_t status[2];
    while (cm1e_soem_transfer(bus->soem, COMMAND_BRD, 0, REG_AL_STATUS, status, sizeof status) > 0) {
        if (!(status[0] & bits) || cm1e_clock_now(bus->clock) >= deadline_ns)
            return status[0];
        cm1e_clock_sleep_until(bus->clock, cm1e_clock_now(bus->clock) + CM1E_PUMP_PERIOD_NS);
    }
    return 0;
}

/** Requests a state of all slaves in one broadcast, also of those that the scan does not know, and waits until none is
 *  above `state`. A slave that shows an error may keep its state until the error is acknowledged. One with device
 *  emulation shows the acknowledge bit as an error, so the last request comes without it. */
static void all_down_to(cm1e_bus_t *bus, uint8_t state)
{
    const unsigned above = AL_STATE_MASK & ~(2u * state - 1u);
    request_of_all(bus, state);
    if (wait_for_all(bus, above | AL_ERROR_FLAG, ACKNOWLEDGE_NS) & AL_ERROR_FLAG) {
        request_of_all(bus, state | AL_ERROR_FLAG);
        wait_for_all(bus, above | AL_ERROR_FLAG, ACKNOWLEDGE_NS);
        request_of_all(bus, state);
    }
    wait_for_all(bus, above, STOP_STEP_NS);
}

/** Looks at the state of each slave. It ends at the first lost frame, because then nothing is known of the other slaves
 *  either. */
static void look_at_states(cm1e_bus_t *bus)
{
    uint8_t status[6];
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        const int answered = cm1e_soem_transfer(bus->soem, COMMAND_FPRD, slave->facts.station, REG_AL_STATUS, status,
                                                sizeof status);
        if (answered == DATAGRAM_LOST)
            return;
        if (answered == 1)
            cm1e_supervision_note(slave, cm1e_get_u16(status), cm1e_get_u16(status + 4));
    }
}

/** Sends the safe outputs more than once, because a frame may be lost. */
static void send_safe_outputs(cm1e_bus_t *bus)
{
    cm1e_bus_release_outputs(bus);
    for (unsigned i = 0; i < EXCHANGES; i++)
        cm1e_bus_pump(bus);
}

void cm1e_bus_stop(cm1e_bus_t *bus)
{
    /* Whose bus it is comes first: the thread that drives it changes all the rest. */
    if (!bus || cm1e_in_task_note("cm1e_bus_stop()") || cm1e_bus_refuse_end(bus, "cm1e_bus_stop()") ||
        bus->phase < BUS_OPEN || !bus->soem)
        return;
    cm1e_bus_unkeep(bus);
    cm1e_bus_kept_lead_alone(bus);
    cm1e_bus_enter(bus);
    if (bus->phase == BUS_OPERATING && bus->safe.any)
        send_safe_outputs(bus);
    if (bus->in_flight)
        cm1e_soem_receive_process_data(bus->soem, bus->config.frame_timeout_ns);
    bus->in_flight = bus->exchanging = false;
    const bool configured = bus->phase >= BUS_CONFIGURED;
    cm1e_bus_set_phase(bus, BUS_OPEN); /* from now on transfers are refused */
    cm1e_acyclic_cancel(bus);
    cm1e_sdo_queue_cancel(bus, CM1E_ERROR_CANCELLED);
    if (bus->slave_count > 0) {
        if (configured)
            all_down_to(bus, CM1E_AL_SAFE_OP);
        all_down_to(bus, CM1E_AL_INIT);
        cm1e_dc_stop(bus);
        look_at_states(bus);
    }
}
