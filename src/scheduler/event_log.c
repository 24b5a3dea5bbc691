#include "scheduler/event_log.h"
#include "core/clock.h"

#include <stdlib.h>
#include <string.h>

/** Between two records of one counter. */
#define QUIET_NS INT64_C(100000000)
/** So many records of one kind about one slave are written one by one, then one in this time. */
enum { BURST = 8 };
#define PACE_NS INT64_C(1000000000)
/** Between two looks at the ports: one damaged cable is counted by every slave behind it. */
#define PORTS_QUIET_NS INT64_C(1000000000)

_Static_assert(sizeof(cm1e_log_event_t) % sizeof(uint64_t) == 0, "a record is whole words");
static const cm1e_history_shape_t shape = {CM1E_LOG_EVENTS, sizeof(cm1e_log_event_t) / sizeof(uint64_t)};

cm1e_error_t cm1e_log_init(log_t *log, const cm1e_clock_t *clock, cm1e_diag_t *diag)
{
    log->clock = clock;
    log->ring = calloc(CM1E_HISTORY_WORDS(CM1E_LOG_EVENTS, cm1e_log_event_t), sizeof *log->ring);
    return log->ring ? CM1E_OK : cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the event log.");
}

void cm1e_log_free(log_t *log)
{
    free(log->ring);
    log->ring = NULL;
}

/* ---- writing ---------------------------------------------------------------------------------------------------- */

static void write_event(log_t *log, cm1e_log_event_t event, int64_t run_ns)
{
    event.time_ns = cm1e_clock_wall(log->clock);
    event.run_ns = run_ns;
    cm1e_history_add(log->ring, shape, &event);
}

void cm1e_log_run(log_t *log, bool begins, int64_t run_ns)
{
    write_event(log, (cm1e_log_event_t){.kind = CM1E_LOG_RUN, .axis = -1, .code = begins}, run_ns);
}

void cm1e_log_variable(log_t *log, int what, uint32_t row, double value, double rest, int64_t run_ns)
{
    write_event(log, (cm1e_log_event_t){.kind = CM1E_LOG_VARIABLE, .axis = -1, .code = what, .detail = row,
                                        .value = value, .bound = rest}, run_ns);
}

void cm1e_log_task(log_t *log, uint32_t task, int64_t limit_ns, int64_t run_ns)
{
    write_event(log, (cm1e_log_event_t){.kind = CM1E_LOG_TASK, .axis = -1, .code = (int32_t)task,
                                        .value = (double)limit_ns * 1e-6}, run_ns);
}

static void look_at_axis(log_t *log, const cm1e_axis_t *axis, uint32_t index, int64_t run_ns)
{
    cm1e_axis_news_t *seen = &log->seen[index], now;
    cm1e_axis_news(axis, &now);
    if (now.command && now.command != seen->command)
        write_event(log, (cm1e_log_event_t){.kind = CM1E_LOG_COMMAND, .axis = (int32_t)index, .code = (int32_t)now.kind,
                                            .value = now.position, .bound = now.velocity}, run_ns);
    if (now.state != seen->state)
        write_event(log, (cm1e_log_event_t){.kind = CM1E_LOG_STATE, .axis = (int32_t)index, .code = (int32_t)now.state,
                                            .detail = (uint32_t)seen->state}, run_ns);
    /* The code of the drive may come a cycle after the error. */
    if (now.error != CM1E_OK && (now.error != seen->error || now.device_error != seen->device_error))
        write_event(log, (cm1e_log_event_t){.kind = CM1E_LOG_ERROR, .axis = (int32_t)index, .code = (int32_t)now.error,
                                            .detail = now.device_error, .value = now.value, .bound = now.bound},
                                            run_ns);
    *seen = now;
}

static void look_at_counter(log_t *log, log_counters_t counters, cm1e_log_kind_t kind, uint64_t total, uint32_t number,
                            int64_t run_ns)
{
    log_counter_t *counter = &counters[kind - CM1E_LOG_OVERRUN];
    if (total == counter->told || run_ns < counter->quiet_until_ns)
        return;
    write_event(log, (cm1e_log_event_t){.kind = kind, .axis = -1, .code = (int32_t)(total - counter->told),
                                        .detail = (uint32_t)total, .value = number}, run_ns);
    *counter = (log_counter_t){.told = total, .quiet_until_ns = run_ns + QUIET_NS};
}

void cm1e_log_look(log_t *log, cm1e_axis_t *const axes[], uint32_t count, uint64_t overruns, int64_t run_ns)
{
    for (uint32_t i = 0; i < count; i++)
        look_at_axis(log, axes[i], i, run_ns);
    look_at_counter(log, log->counters, CM1E_LOG_OVERRUN, overruns, 0, run_ns);
}

void cm1e_log_bus(log_t *log, const cm1e_bus_counters_t *bus, uint64_t sync_losses, uint32_t number, int64_t run_ns)
{
    log_counter_t *counters = log->slaves[number].counters;
    look_at_counter(log, counters, CM1E_LOG_LOST_FRAMES, bus->lost_frames, number, run_ns);
    look_at_counter(log, counters, CM1E_LOG_WORKING_COUNTER, bus->working_counter_errors, number, run_ns);
    look_at_counter(log, counters, CM1E_LOG_UNSENT_FRAMES, bus->unsent_frames, number, run_ns);
    look_at_counter(log, counters, CM1E_LOG_OTHER_MASTER, bus->foreign_frames, number, run_ns);
    look_at_counter(log, counters, CM1E_LOG_SYNC_LOST, sync_losses, number, run_ns);
}

static void write_emergency(log_t *log, uint32_t number, uint32_t position, const cm1e_emergency_t *emergency,
                            uint64_t left_out, int64_t run_ns)
{
    uint64_t bytes = 0;
    for (size_t i = sizeof emergency->data; i-- > 0;)
        bytes = bytes << 8 | emergency->data[i];
    write_event(log, (cm1e_log_event_t){.kind = CM1E_LOG_EMERGENCY, .axis = -1, .code = emergency->code,
                                        .detail = number << 24 | (uint32_t)emergency->error_register << 16 | position,
                                        .value = (double)bytes, .bound = (double)left_out}, run_ns);
}

/** How many records there may be now; at the end of the run one at least. Where there may be none, the time from which
 *  on there may be one is noted. */
static size_t records_left(const log_slaves_t *slaves, const log_pace_t *pace, int64_t run_ns, int64_t *due_ns)
{
    const int64_t most_ns = BURST * PACE_NS, ahead_ns = pace->paid_until_ns - run_ns;
    const int64_t left_ns = ahead_ns > 0 ? most_ns - ahead_ns : most_ns, next_ns = run_ns + PACE_NS - left_ns;
    if (left_ns >= PACE_NS)
        return (size_t)(left_ns / PACE_NS);
    *due_ns = next_ns < *due_ns ? next_ns : *due_ns;
    return slaves->ended;
}

static void note_records(log_pace_t *pace, size_t count, int64_t run_ns)
{
    pace->paid_until_ns = (pace->paid_until_ns > run_ns ? pace->paid_until_ns : run_ns) + (int64_t)count * PACE_NS;
}

/** The newest ones of a slave, as many as it may have, and the number of those before them. */
static void tell_emergencies(log_t *log, const cm1e_bus_t *bus, uint32_t number, uint32_t slave, int64_t run_ns)
{
    log_slaves_t *slaves = &log->slaves[number];
    cm1e_emergency_t news[CM1E_EMERGENCIES];
    uint64_t lost = 0;
    const size_t count = cm1e_bus_emergencies(bus, (uint16_t)(slave + 1), slaves->told[slave], news, CM1E_EMERGENCIES,
                                              &lost);
    log_pace_t *pace = &slaves->emergency_pace[slave];
    const size_t left = count > 0 ? records_left(slaves, pace, run_ns, &slaves->emergencies_due_ns) : 0;
    const size_t first = count > left ? count - left : 0;
    if (left == 0)
        return;
    for (size_t n = first; n < count; n++)
        write_emergency(log, number, slave + 1, &news[n], n == first ? lost + first : 0, run_ns);
    note_records(pace, count - first, run_ns);
    slaves->told[slave] = news[count - 1].number;
}

void cm1e_log_emergencies(log_t *log, const cm1e_bus_t *bus, uint32_t number, int64_t run_ns)
{
    log_slaves_t *slaves = &log->slaves[number];
    if (slaves->emergencies == cm1e_bus_emergency_count(bus) && run_ns < slaves->emergencies_due_ns &&
        !slaves->ended)
        return;
    slaves->emergencies = cm1e_bus_emergency_count(bus);
    if (slaves->operation != cm1e_bus_operation(bus)) /* after another scan they count from 1 again */
        memset(slaves->told, 0, sizeof slaves->told);
    slaves->operation = cm1e_bus_operation(bus);
    slaves->emergencies_due_ns = INT64_MAX;
    for (uint32_t i = 0; i < cm1e_bus_slave_count(bus); i++)
        tell_emergencies(log, bus, number, i, run_ns);
}

static void look_at_port(log_t *log, const cm1e_bus_t *bus, uint32_t number, uint32_t position, unsigned port,
                         int64_t run_ns)
{
    for (unsigned fault = 0; fault < CM1E_PORT_FAULTS; fault++) {
        uint32_t *told = &log->slaves[number].port_faults[position - 1][port][fault];
        const uint32_t total = cm1e_bus_port_fault(bus, position, port, (cm1e_port_fault_t)fault);
        if (total > *told)
            write_event(log, (cm1e_log_event_t){.kind = CM1E_LOG_PORT, .axis = -1, .code = (int32_t)(total - *told),
                                                .detail = fault << 24 | number << 20 | port << 16 | position}, run_ns);
        *told = total;
    }
}

void cm1e_log_ports(log_t *log, const cm1e_bus_t *bus, uint32_t number, int64_t run_ns)
{
    log_slaves_t *slaves = &log->slaves[number];
    if (slaves->port_news == cm1e_bus_port_news(bus) || run_ns < slaves->ports_quiet_until_ns)
        return;
    slaves->port_news = cm1e_bus_port_news(bus);
    slaves->ports_quiet_until_ns = run_ns + PORTS_QUIET_NS;
    for (uint32_t position = 1; position <= cm1e_bus_slave_count(bus); position++)
        for (unsigned port = 0; port < CM1E_PORTS; port++)
            look_at_port(log, bus, number, position, port, run_ns);
}

static bool was_told(const log_slaves_t *slaves, const cm1e_stranger_t *stranger)
{
    for (size_t n = 0; n < slaves->stranger_count; n++)
        if (memcmp(&slaves->strangers[n], stranger, sizeof *stranger) == 0)
            return true;
    return false;
}

/** One that comes and goes has to wait, and is told if it is there then. */
static void look_at_strangers(log_t *log, const cm1e_bus_t *bus, uint32_t number, int64_t run_ns)
{
    log_slaves_t *slaves = &log->slaves[number];
    cm1e_stranger_t now[CM1E_STRANGERS], told[CM1E_STRANGERS];
    const size_t count = cm1e_bus_strangers(bus, now, CM1E_STRANGERS);
    size_t told_count = 0;
    for (size_t i = 0; i < count; i++) {
        const bool is_new = !was_told(slaves, &now[i]);
        if (is_new && records_left(slaves, &slaves->stranger_pace, run_ns, &slaves->presence_due_ns) == 0)
            continue;
        told[told_count++] = now[i];
        if (!is_new)
            continue;
        write_event(log, (cm1e_log_event_t){.kind = CM1E_LOG_STRANGER, .axis = -1,
                                            .code = (int32_t)now[i].product_code,
                                            .detail = number << 24 | now[i].place, .value = now[i].vendor_id,
                                            .bound = 65536.0 * now[i].explicit_id + now[i].alias}, run_ns);
        note_records(&slaves->stranger_pace, 1, run_ns);
    }
    memcpy(slaves->strangers, told, told_count * sizeof *told);
    slaves->stranger_count = told_count;
}

/** A slave that is again as it was told last has changed all the same. */
static void look_at_presence(log_t *log, const cm1e_bus_t *bus, uint32_t number, uint32_t slave, int64_t run_ns)
{
    log_slaves_t *slaves = &log->slaves[number];
    const uint8_t now = (uint8_t)cm1e_bus_presence(bus, slave + 1);
    uint32_t *changes = &slaves->changes[slave];
    *changes += now != slaves->presence[slave];
    slaves->presence[slave] = now;
    if (*changes == 0 || records_left(slaves, &slaves->presence_pace[slave], run_ns, &slaves->presence_due_ns) == 0)
        return;
    write_event(log, (cm1e_log_event_t){.kind = CM1E_LOG_SLAVE, .axis = -1, .code = (int32_t)now,
                                        .detail = number << 24 | (slave + 1), .bound = *changes - 1}, run_ns);
    note_records(&slaves->presence_pace[slave], 1, run_ns);
    *changes = 0;
}

void cm1e_log_presence(log_t *log, const cm1e_bus_t *bus, uint32_t number, int64_t run_ns)
{
    log_slaves_t *slaves = &log->slaves[number];
    if (slaves->presence_news == cm1e_bus_presence_news(bus) && run_ns < slaves->presence_due_ns && !slaves->ended)
        return;
    slaves->presence_news = cm1e_bus_presence_news(bus);
    slaves->presence_due_ns = INT64_MAX;
    for (uint32_t i = 0; i < cm1e_bus_slave_count(bus); i++)
        look_at_presence(log, bus, number, i, run_ns);
    look_at_strangers(log, bus, number, run_ns);
}

/** A break is told when its place is known. One that was mended before that is told without. */
void cm1e_log_ring(log_t *log, const cm1e_bus_t *bus, uint32_t number, int64_t run_ns)
{
    log_slaves_t *told = &log->slaves[number];
    cm1e_bus_ring_t ring;
    cm1e_bus_ring(bus, &ring);
    const bool news = ring.breaks != told->ring_breaks || ring.broken != told->ring_broken;
    if (!news || run_ns < told->ring_quiet_until_ns || (ring.broken && !ring.placed))
        return;
    const uint32_t detail = number << 24;
    if (ring.breaks != told->ring_breaks)
        write_event(log, (cm1e_log_event_t){.kind = CM1E_LOG_RING, .axis = -1, .code = 1, .detail = detail,
                                            .value = ring.behind, .bound = ring.before}, run_ns);
    if (!ring.broken)
        write_event(log, (cm1e_log_event_t){.kind = CM1E_LOG_RING, .axis = -1, .detail = detail}, run_ns);
    told->ring_broken = ring.broken;
    told->ring_breaks = ring.breaks;
    told->ring_quiet_until_ns = run_ns + QUIET_NS;
}

static void wait_no_longer(log_counters_t counters)
{
    for (int i = 0; i < CM1E_LOG_COUNTERS; i++)
        counters[i].quiet_until_ns = INT64_MIN;
}

void cm1e_log_wait_no_longer(log_t *log)
{
    wait_no_longer(log->counters);
    for (int i = 0; i < CM1E_MAX_BUSES; i++) {
        wait_no_longer(log->slaves[i].counters);
        log->slaves[i].ended = true;
        log->slaves[i].ports_quiet_until_ns = log->slaves[i].ring_quiet_until_ns = INT64_MIN;
    }
}

/* ---- reading ---------------------------------------------------------------------------------------------------- */

size_t cm1e_log_copy(const log_t *log, uint64_t after, cm1e_log_event_t *events, size_t room, uint64_t *lost)
{
    return cm1e_history_copy(log->ring, shape, after, events, room, lost);
}
