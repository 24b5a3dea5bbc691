/**
 * @file scheduler/event_log.h
 * The event log from within: the cycle compares what it sees with what it saw last, and writes what changed.
 */
#ifndef CM1E_SCHEDULER_EVENT_LOG_H
#define CM1E_SCHEDULER_EVENT_LOG_H

#include "axis/axis_watch.h"
#include "bus/emergency_ring.h"
#include "bus/port_watch.h"
#include "cm1e/hot_connect.h"
#include "cm1e/log.h"
#include "core/clock.h"
#include "core/history.h"

/** A number that only grows and is looked at in every cycle. */
typedef struct log_counter {
    uint64_t told;
    int64_t quiet_until_ns;
} log_counter_t;
enum { CM1E_LOG_COUNTERS = CM1E_LOG_SYNC_LOST + 1 - CM1E_LOG_OVERRUN };
typedef log_counter_t log_counters_t[CM1E_LOG_COUNTERS];

/** Of records of one kind about one slave: each of them moves it on. */
typedef struct log_pace {
    int64_t paid_until_ns;
} log_pace_t;

/** What was told of a bus and its slaves. */
typedef struct log_slaves {
    log_counters_t counters;
    uint64_t emergencies;       /**< of all slaves */
    uint32_t operation;         /**< of the bus, in which they were counted */
    uint64_t told[CM1E_MAX_SLAVES];
    log_pace_t emergency_pace[CM1E_MAX_SLAVES];
    int64_t emergencies_due_ns; /**< when those that wait for a record of their slave are looked at */
    uint64_t presence_news;     /**< of all slaves, told */
    uint8_t presence[CM1E_MAX_SLAVES];
    uint32_t changes[CM1E_MAX_SLAVES]; /**< of it, since the last record */
    log_pace_t presence_pace[CM1E_MAX_SLAVES];
    int64_t presence_due_ns;
    cm1e_stranger_t strangers[CM1E_STRANGERS];
    size_t stranger_count;
    log_pace_t stranger_pace;
    bool ended;                 /**< the run: nothing waits any more */
    uint64_t port_news;         /**< faults of all ports, told */
    int64_t ports_quiet_until_ns;
    bool ring_broken;           /**< told */
    uint64_t ring_breaks;       /**< told */
    int64_t ring_quiet_until_ns;
    uint32_t port_faults[CM1E_MAX_SLAVES][CM1E_PORTS][CM1E_PORT_FAULTS]; /**< told */
} log_slaves_t;

typedef struct log {
    uint64_t *ring;             /**< core/history.h */
    const cm1e_clock_t *clock;
    cm1e_axis_news_t seen[CM1E_MAX_AXES];
    log_counters_t counters;    /**< of no bus alone */
    log_slaves_t slaves[CM1E_MAX_BUSES];
} log_t;

/** CM1E_ERROR_NO_MEMORY. @rt init */
cm1e_error_t cm1e_log_init(log_t *log, const cm1e_clock_t *clock, cm1e_diag_t *diag);
void cm1e_log_free(log_t *log);
/** @rt cycle */
void cm1e_log_run(log_t *log, bool begins, int64_t run_ns);
/** Called in every cycle, after its work. @rt cycle */
void cm1e_log_look(log_t *log, cm1e_axis_t *const axes[], uint32_t count, uint64_t overruns, int64_t run_ns);
/** What a bus has counted in this run. `number`: of the bus, below CM1E_MAX_BUSES. @rt cycle */
void cm1e_log_bus(log_t *log, const cm1e_bus_counters_t *bus, uint64_t sync_losses, uint32_t number, int64_t run_ns);
/** The emergencies of a bus that came since the last call. `number`: of the bus, below CM1E_MAX_BUSES. @rt cycle */
void cm1e_log_emergencies(log_t *log, const cm1e_bus_t *bus, uint32_t number, int64_t run_ns);
/** What the ports of its slaves have counted since the last call. @rt cycle */
void cm1e_log_ports(log_t *log, const cm1e_bus_t *bus, uint32_t number, int64_t run_ns);
/** Where its ring is broken, or that it is whole again. @rt cycle */
void cm1e_log_ring(log_t *log, const cm1e_bus_t *bus, uint32_t number, int64_t run_ns);
/** The slaves of a bus that came or went since the last call, and the strangers. @rt cycle */
void cm1e_log_presence(log_t *log, const cm1e_bus_t *bus, uint32_t number, int64_t run_ns);
/** The run has ended: what these tell of next does not wait until the last record of its kind is old. @rt cycle */
void cm1e_log_wait_no_longer(log_t *log);
/** A variable of the program was released (0), forced (1) or written (2) from outside. `row`: of the table
 *  (variables.h); `rest`: what `value` lacks of 64 bits. @rt cycle */
void cm1e_log_variable(log_t *log, int what, uint32_t row, double value, double rest, int64_t run_ns);
/** A task, the first one is 0, did not return within its limit. @rt cycle */
void cm1e_log_task(log_t *log, uint32_t task, int64_t limit_ns, int64_t run_ns);
size_t cm1e_log_copy(const log_t *log, uint64_t after, cm1e_log_event_t *events, size_t room, uint64_t *lost);

#endif
