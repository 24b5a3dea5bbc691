#include "bus/kept.h"

#include <pthread.h>
#include <stdatomic.h>

#include "bus/bus_internal.h"
#include "nic/nic.h"

/* A bus has one thread, but any thread may close it. */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
typedef struct place {
    cm1e_bus_t *bus;
    pthread_t thread;
    int64_t sent_ns; /**< its last frame, as far as it is ours or of its start: a later one is the program's own */
} place_t;
static place_t kept[CM1E_MAX_BUSES];
static atomic_int count;

static _Thread_local bool busy, none_here;

/* Distributed clocks need their frames at the phase of their cycle. Else it is enough that the watchdogs get some, and
 * a program that makes the cycles itself has left one out. */
static bool is_due(const place_t *place, int64_t now_ns)
{
    const cm1e_bus_t *bus = place->bus;
    if (bus->dc.used && bus->sent_ns == place->sent_ns)
        return now_ns >= bus->next_cycle_ns;
    return now_ns >= bus->sent_ns + 2 * bus->config.cycle_time_ns;
}

/* One exchange. */
static void exchange(place_t *place)
{
    cm1e_bus_t *bus = place->bus;
    const int64_t now_ns = cm1e_bus_enter(bus);
    if (!is_due(place, now_ns))
        return;
    if (bus->in_flight)
        cm1e_bus_receive(bus);
    cm1e_bus_send(bus);
    place->sent_ns = bus->sent_ns;
    bus->next_cycle_ns += bus->config.cycle_time_ns + cm1e_bus_pace(bus);
    if (bus->next_cycle_ns <= now_ns)
        bus->next_cycle_ns = cm1e_bus_next_start(bus, now_ns + 1);
}

/* Before every frame of a nic. In a cycle, and without such buses, it costs two comparisons. */
static void keep_others(const cm1e_nic_t *nic)
{
    if (busy || none_here || atomic_load_explicit(&count, memory_order_relaxed) == 0)
        return;
    cm1e_clock_t *clock = cm1e_clock_current();
    busy = true;
    pthread_mutex_lock(&lock);
    for (int i = 0; i < CM1E_MAX_BUSES; i++)
        if (kept[i].bus && kept[i].bus->nic != nic && pthread_equal(kept[i].thread, pthread_self()))
            exchange(&kept[i]);
    pthread_mutex_unlock(&lock);
    busy = false;
    cm1e_clock_make_current(clock);
}

void cm1e_bus_keep(cm1e_bus_t *bus)
{
    cm1e_nic_before_send(keep_others);
    cm1e_bus_unkeep(bus);
    pthread_mutex_lock(&lock);
    for (int i = 0; i < CM1E_MAX_BUSES; i++) {
        if (kept[i].bus)
            continue;
        kept[i] = (place_t){.bus = bus, .thread = pthread_self(), .sent_ns = bus->sent_ns};
        atomic_fetch_add_explicit(&count, 1, memory_order_relaxed);
        break;
    }
    pthread_mutex_unlock(&lock);
}

void cm1e_bus_unkeep(cm1e_bus_t *bus)
{
    pthread_mutex_lock(&lock);
    for (int i = 0; i < CM1E_MAX_BUSES; i++) {
        if (kept[i].bus != bus)
            continue;
        kept[i].bus = NULL;
        atomic_fetch_sub_explicit(&count, 1, memory_order_relaxed);
    }
    pthread_mutex_unlock(&lock);
}

const cm1e_bus_t *cm1e_bus_kept_leader(const cm1e_bus_t *bus)
{
    const cm1e_bus_t *leader = NULL;
    pthread_mutex_lock(&lock);
    for (int i = 0; i < CM1E_MAX_BUSES && !leader; i++)
        if (kept[i].bus && kept[i].bus != bus && pthread_equal(kept[i].thread, pthread_self()) &&
            kept[i].bus->dc.used && !kept[i].bus->dc.leader && kept[i].bus->clock == bus->clock)
            leader = kept[i].bus;
    pthread_mutex_unlock(&lock);
    return leader;
}

void cm1e_bus_kept_lead_alone(const cm1e_bus_t *bus)
{
    pthread_mutex_lock(&lock);
    for (int i = 0; i < CM1E_MAX_BUSES; i++)
        if (kept[i].bus && kept[i].bus->dc.leader == bus)
            kept[i].bus->dc.leader = NULL;
    pthread_mutex_unlock(&lock);
}

void cm1e_bus_keep_none(bool none) { none_here = none; }

/** Its address is another one in each thread. */
static _Thread_local char here;

void cm1e_bus_drive(cm1e_bus_t *bus, bool on)
{
    __atomic_store_n(&bus->errands.refused, NULL, __ATOMIC_RELAXED);
    __atomic_store_n(&bus->errands.driver, on ? &here : NULL, __ATOMIC_SEQ_CST);
}

static const void *driver_of(const cm1e_bus_t *bus) { return __atomic_load_n(&bus->errands.driver, __ATOMIC_SEQ_CST); }

bool cm1e_bus_is_driven(const cm1e_bus_t *bus) { return driver_of(bus) != NULL; }

bool cm1e_bus_refuse_end(cm1e_bus_t *bus, const char *function)
{
    const void *driver = driver_of(bus);
    if (!driver || driver == &here)
        return false;
    __atomic_store_n(&bus->errands.refused, function, __ATOMIC_RELAXED);
    return true;
}

const char *cm1e_bus_refused_end(const cm1e_bus_t *bus)
{
    return __atomic_load_n(&bus->errands.refused, __ATOMIC_RELAXED);
}

cm1e_error_t cm1e_bus_refuse_driven(const cm1e_bus_t *bus, const char *function, const char *instead,
                                    cm1e_diag_t *diag)
{
    if (!bus || !cm1e_bus_is_driven(bus))
        return CM1E_OK;
    return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "%s is refused while a scheduler runs the bus: it would send "
                         "frames beside the cycle.%s%s", function, instead[0] ? " " : "", instead);
}
