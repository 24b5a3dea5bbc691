#include "bus/bus_internal.h"

/* Transfers that wait for the CoE client of their slave. Any thread may submit one. */

enum { SDO_MAX_BYTES = 1 << 24 };

/** Checks a transfer without asking the slave. */
static cm1e_error_t check(const cm1e_bus_t *bus, const cm1e_sdo_t *sdo)
{
    if (__atomic_load_n(&bus->phase, __ATOMIC_ACQUIRE) < BUS_SCANNED || bus->remote)
        return CM1E_ERROR_STATE;
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, sdo->position);
    if (!slave || (!sdo->data && sdo->size > 0) || sdo->size > SDO_MAX_BYTES)
        return CM1E_ERROR_INVALID_ARGUMENT;
    return slave->facts.coe ? CM1E_OK : CM1E_ERROR_UNSUPPORTED;
}

/* A place of the ring has an odd number where it is filled: the address of the transfer, plus 1. It has an even one
 * where it is free: the round in which it will be filled next, times 2. One exchange puts a transfer in, if the place
 * is free and it is its turn, so no thread ever holds a place that it has not filled; one that stands still in between
 * holds back nobody. The round keeps a thread that stood still for long from filling the place out of turn. Zeros are
 * an empty ring. The counter `head` follows: who finds its place filled moves it on, also for the thread that filled it
 * (Tsigas and Zhang 2001, "A simple, fast and scalable non-blocking concurrent FIFO queue"). */

static uintptr_t filled_with(const cm1e_sdo_t *sdo) { return (uintptr_t)sdo + 1; }
static cm1e_sdo_t *transfer_in(uintptr_t content) { return (cm1e_sdo_t *)(content - 1); }
static bool is_free(uintptr_t content) { return content % 2 == 0; }

/** What a place holds that is free for the transfer number `n`. */
static uintptr_t free_for(uint32_t n) { return (uintptr_t)(n / CM1E_SDO_WAITING_MAX) * 2; }

static uintptr_t *place_of(cm1e_sdo_queue_t *queue, uint32_t n) { return &queue->ring[n % CM1E_SDO_WAITING_MAX]; }

/** Puts a transfer into the next free place. There is one: `waiting` is at most as many as there are. */
static uintptr_t *put_in(cm1e_sdo_queue_t *queue, const cm1e_sdo_t *sdo)
{
    for (;;) {
        uint32_t n = __atomic_load_n(&queue->head, __ATOMIC_SEQ_CST);
        uintptr_t *place = place_of(queue, n), content = free_for(n);
        const bool mine = __atomic_compare_exchange_n(place, &content, filled_with(sdo), false, __ATOMIC_SEQ_CST,
                                                      __ATOMIC_SEQ_CST);
        __atomic_compare_exchange_n(&queue->head, &n, n + 1, false, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST);
        if (mine)
            return place;
    }
}

/** Ends a transfer that waits in a place of the ring. Returns false if another thread took it. The place stays filled,
 *  with no transfer. */
static bool end_in_ring(uintptr_t *place, cm1e_sdo_t *sdo, cm1e_error_t error)
{
    uintptr_t content = filled_with(sdo);
    if (!__atomic_compare_exchange_n(place, &content, filled_with(NULL), false, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST))
        return false;
    cm1e_sdo_finish(sdo, error, 0);
    return true;
}

cm1e_error_t cm1e_sdo_submit(cm1e_bus_t *bus, cm1e_sdo_t *sdo)
{
    if (!bus || !sdo)
        return CM1E_ERROR_INVALID_ARGUMENT;
    if (cm1e_sdo_state(sdo) == CM1E_SDO_BUSY)
        return CM1E_ERROR_BUSY;
    const cm1e_error_t error = check(bus, sdo);
    if (error != CM1E_OK) {
        cm1e_sdo_finish(sdo, error, 0);
        return error;
    }
    cm1e_sdo_queue_t *queue = &bus->queue;
    if (__atomic_fetch_add(&queue->waiting, 1, __ATOMIC_ACQ_REL) >= CM1E_SDO_WAITING_MAX) {
        __atomic_fetch_sub(&queue->waiting, 1, __ATOMIC_ACQ_REL);
        return CM1E_ERROR_FULL;
    }
    sdo->error = CM1E_OK;
    sdo->abort_code = 0;
    __atomic_store_n(&sdo->state, CM1E_SDO_BUSY, __ATOMIC_RELAXED);
    uintptr_t *place = put_in(queue, sdo);
    /* A bus that stopped after the check may have emptied its queue without this transfer. Either the bus sees the
     * transfer, or this thread sees the phase of the bus. */
    const bool stopped = __atomic_load_n(&bus->phase, __ATOMIC_SEQ_CST) < BUS_SCANNED;
    return stopped && end_in_ring(place, sdo, CM1E_ERROR_STATE) ? CM1E_ERROR_STATE : CM1E_OK;
}

/** Takes over what was handed in. Never overflows: `waiting` counts ring and list together. */
static void take_over(cm1e_sdo_queue_t *queue)
{
    for (; queue->listed < CM1E_SDO_WAITING_MAX; queue->tail++) {
        uintptr_t *place = place_of(queue, queue->tail);
        if (is_free(__atomic_load_n(place, __ATOMIC_SEQ_CST)))
            return;
        const uintptr_t content =
            __atomic_exchange_n(place, free_for(queue->tail + CM1E_SDO_WAITING_MAX), __ATOMIC_SEQ_CST);
        if (transfer_in(content))
            queue->list[queue->listed++] = transfer_in(content);
        else
            __atomic_fetch_sub(&queue->waiting, 1, __ATOMIC_ACQ_REL);
    }
}

/** A recovery that was requested without a known fault ends after three datagrams, so other axes of the slave are not
 *  affected. */
static bool may_be_well(const cm1e_bus_slave_t *slave)
{
    return cm1e_recovery_idle(&slave->recovery) || slave->watch.al_state == CM1E_AL_OP;
}

/** Begins a transfer, or ends it at once if the slave cannot answer. Returns false if the slave is busy with another
 *  transfer. */
static bool dispatch(cm1e_bus_t *bus, cm1e_sdo_t *sdo, int64_t now_ns)
{
    const cm1e_error_t error = check(bus, sdo);
    cm1e_bus_slave_t *slave = cm1e_bus_at(bus, sdo->position);
    if (error != CM1E_OK)
        cm1e_sdo_finish(sdo, error, 0);
    else if (slave->watch.lost || cm1e_recovery_mutes(&slave->recovery) || !may_be_well(slave))
        cm1e_sdo_finish(sdo, CM1E_ERROR_BUS_LOST, 0);
    else if (cm1e_recovery_idle(&slave->recovery) && cm1e_coe_idle(&slave->coe) && cm1e_mapping_idle(&slave->mapping) &&
             !cm1e_foe_job_holds(bus, slave)) {
        cm1e_coe_begin(&slave->coe, sdo, now_ns);
        cm1e_acyclic_wake(bus);
    } else {
        return false;
    }
    return true;
}

void cm1e_sdo_queue_serve(cm1e_bus_t *bus, int64_t now_ns)
{
    cm1e_sdo_queue_t *queue = &bus->queue;
    take_over(queue);
    unsigned kept = 0;
    for (unsigned i = 0; i < queue->listed; i++) {
        cm1e_sdo_t *sdo = queue->list[i];
        if (dispatch(bus, sdo, now_ns))
            __atomic_fetch_sub(&queue->waiting, 1, __ATOMIC_ACQ_REL);
        else
            queue->list[kept++] = sdo;
    }
    queue->listed = kept;
}

void cm1e_sdo_queue_cancel(cm1e_bus_t *bus, cm1e_error_t error)
{
    cm1e_sdo_queue_t *queue = &bus->queue;
    take_over(queue);
    for (unsigned i = 0; i < queue->listed; i++) {
        cm1e_sdo_finish(queue->list[i], error, 0);
        __atomic_fetch_sub(&queue->waiting, 1, __ATOMIC_ACQ_REL);
    }
    queue->listed = 0;
}
