#include "bus/kept.h"

#include <pthread.h>
#include <stdatomic.h>

#include "bus/bus_internal.h"
#include "nic/nic.h"

/* A bus has one thread, but any thread may close it. */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static struct {
    cm1e_bus_t *bus;
    pthread_t thread;
} kept[CM1E_MAX_BUSES];
static atomic_int count;

static _Thread_local bool busy, none_here;

/* One exchange, where the program itself has left out a cycle. */
static void exchange(cm1e_bus_t *bus)
{
    if (cm1e_bus_enter(bus) < bus->sent_ns + 2 * bus->config.cycle_time_ns)
        return;
    if (bus->in_flight)
        cm1e_bus_receive(bus);
    cm1e_bus_send(bus);
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
            exchange(kept[i].bus);
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
        kept[i].bus = bus;
        kept[i].thread = pthread_self();
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

void cm1e_bus_keep_none(bool none) { none_here = none; }
