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

/** Marks a place of the ring whose transfer ended before the bus took it over. */
static cm1e_sdo_t ended;

/** Ends a transfer that waits in a place of the ring. Returns false if another thread took it. The place stays
 *  occupied. */
static bool end_in_ring(cm1e_sdo_t **place, cm1e_sdo_t *sdo, cm1e_error_t error)
{
    if (!__atomic_compare_exchange_n(place, &sdo, &ended, false, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST))
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
    cm1e_sdo_t **place =
        &queue->ring[__atomic_fetch_add(&queue->head, 1, __ATOMIC_RELAXED) % CM1E_SDO_WAITING_MAX];
    __atomic_store_n(place, sdo, __ATOMIC_SEQ_CST); /* free: `waiting` is at most as many as there are */
    /* A bus that stopped after the check may have emptied its queue without this transfer. Either the bus sees the
     * transfer, or this thread sees the phase of the bus. */
    const bool stopped = __atomic_load_n(&bus->phase, __ATOMIC_SEQ_CST) < BUS_SCANNED;
    return stopped && end_in_ring(place, sdo, CM1E_ERROR_STATE) ? CM1E_ERROR_STATE : CM1E_OK;
}

/** Takes over what was handed in. Never overflows: `waiting` counts ring and list together. */
static void take_over(cm1e_sdo_queue_t *queue)
{
    for (cm1e_sdo_t *sdo; queue->listed < CM1E_SDO_WAITING_MAX; queue->tail++) {
        sdo = __atomic_exchange_n(&queue->ring[queue->tail % CM1E_SDO_WAITING_MAX], NULL, __ATOMIC_SEQ_CST);
        if (!sdo) /* empty, or its thread is about to fill it */
            return;
        if (sdo == &ended)
            __atomic_fetch_sub(&queue->waiting, 1, __ATOMIC_ACQ_REL);
        else
            queue->list[queue->listed++] = sdo;
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
    /* There may be filled places behind one that its thread has not filled yet. */
    for (unsigned i = 0; i < CM1E_SDO_WAITING_MAX; i++) {
        cm1e_sdo_t *sdo = __atomic_load_n(&queue->ring[i], __ATOMIC_SEQ_CST);
        if (sdo && sdo != &ended)
            end_in_ring(&queue->ring[i], sdo, error);
    }
}
