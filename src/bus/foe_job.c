#include "bus/foe_job.h"

#include <string.h>

#include "bus/bus_internal.h"

enum { MAILBOX_MIN = 32 };

static cm1e_foe_t *present(const cm1e_bus_t *bus) { return __atomic_load_n(&bus->errands.file, __ATOMIC_ACQUIRE); }

/** The SII is not trusted. */
static bool fits(uint16_t length) { return length >= MAILBOX_MIN && length <= CM1E_DATAGRAM_MAX; }

cm1e_error_t cm1e_foe_check_mailbox(const cm1e_bus_slave_t *slave, cm1e_diag_t *diag)
{
    const cm1e_mailbox_t *mailbox = &slave->coe.mailbox;
    const unsigned position = slave->info.position;
    if (!slave->facts.foe)
        return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "Slave %u has no files: its SII announces no FoE.",
                             position);
    if (!fits(mailbox->out_length) || !fits(mailbox->in_length))
        return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "The mailbox of slave %u has %u bytes to it and %u from "
                             "it, as its SII states; expected are %d to %d.", position, mailbox->out_length,
                             mailbox->in_length, MAILBOX_MIN, CM1E_DATAGRAM_MAX);
    return CM1E_OK;
}

/* ---- handing in ------------------------------------------------------------------------------------------------- */

cm1e_error_t cm1e_foe_check(const cm1e_bus_t *bus, const cm1e_foe_t *foe, cm1e_diag_t *diag)
{
    if (__atomic_load_n(&bus->phase, __ATOMIC_SEQ_CST) != BUS_OPERATING || bus->remote)
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "The bus does not operate.");
    if (!foe->name || (foe->writing ? !foe->from && foe->size > 0 : !foe->to))
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "A file needs a name and a buffer.");
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, foe->position);
    if (!slave)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "There is no slave %u; a scan found %u.",
                             foe->position, bus->slave_count);
    return cm1e_foe_check_mailbox(slave, diag);
}

static cm1e_error_t stopped(cm1e_diag_t *diag)
{
    return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "The bus has stopped.");
}

cm1e_error_t cm1e_foe_submit(cm1e_bus_t *bus, cm1e_foe_t *foe, cm1e_diag_t *diag)
{
    cm1e_foe_t *none = NULL, *own = foe;
    const cm1e_error_t error = cm1e_foe_check(bus, foe, diag);
    if (error != CM1E_OK)
        return error;
    foe->bus = bus;
    foe->slave = cm1e_bus_at(bus, foe->position);
    foe->mailbox = &foe->slave->coe.mailbox;
    foe->begun = false;
    __atomic_store_n(&foe->given_back, 0, __ATOMIC_RELAXED);
    if (!__atomic_compare_exchange_n(&bus->errands.file, &none, foe, false, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST))
        return cm1e_diag_set(diag, CM1E_ERROR_BUSY, 0, "Another file is on its way.");
    /* A bus that stopped meanwhile either sees the transfer, or this thread sees the phase of the bus. */
    const bool late = __atomic_load_n(&bus->phase, __ATOMIC_SEQ_CST) != BUS_OPERATING;
    if (late && __atomic_compare_exchange_n(&bus->errands.file, &own, NULL, false, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST))
        return stopped(diag);
    return CM1E_OK;
}

bool cm1e_foe_done(const cm1e_foe_t *foe) { return __atomic_load_n(&foe->given_back, __ATOMIC_ACQUIRE); }

void cm1e_foe_cancel(cm1e_foe_t *foe) { __atomic_store_n(&foe->cancel, 1, __ATOMIC_RELAXED); }

cm1e_error_t cm1e_foe_result_of(const cm1e_foe_t *foe, cm1e_diag_t *diag) { return cm1e_foe_explain(foe, diag); }

/* ---- in the cycle ----------------------------------------------------------------------------------------------- */

/** Nothing of it is touched any more afterwards: it belongs to its thread. Its place is free before. */
static void give_back(cm1e_foe_t *foe) { __atomic_store_n(&foe->given_back, 1, __ATOMIC_RELEASE); }

/** A slave that is lost, or is brought back, has forgotten the file; its mailbox begins anew. */
static bool is_gone(const cm1e_bus_slave_t *slave)
{
    return slave->watch.lost || !cm1e_recovery_idle(&slave->recovery);
}

void cm1e_foe_job_serve(cm1e_bus_t *bus, int64_t now_ns)
{
    cm1e_foe_t *foe = present(bus);
    if (!foe || foe->slave->owner == OWNER_FILE)
        return;
    if (!foe->begun) {
        foe->begun = true;
        cm1e_foe_begin(foe, now_ns);
    }
    if (!cm1e_foe_ended(foe) && is_gone(foe->slave))
        cm1e_foe_give_up(foe, FOE_LOST);
    if (!cm1e_foe_ended(foe))
        return;
    __atomic_store_n(&bus->errands.file, NULL, __ATOMIC_SEQ_CST);
    give_back(foe);
}

/** A message begins when the CoE client has nothing to do; until it is answered, the client waits. Both in turn. */
bool cm1e_foe_job_next(cm1e_bus_t *bus, cm1e_bus_slave_t *slave, int64_t now_ns)
{
    cm1e_foe_t *foe = present(bus);
    if (!foe || foe->slave != slave || !foe->begun || cm1e_foe_ended(foe))
        return false;
    const bool due = foe->phase != FOE_PHASE_PAUSE || now_ns >= foe->resume_ns;
    if (!cm1e_foe_holds_mailbox(foe) && (!cm1e_coe_idle(&slave->coe) || !cm1e_mapping_idle(&slave->mapping))) {
        foe->yielded |= due;
        return false;
    }
    foe->yielded &= !due;
    return cm1e_foe_next(foe, &slave->datagram, now_ns);
}

void cm1e_foe_job_result(cm1e_bus_t *bus, cm1e_bus_slave_t *slave, int64_t now_ns)
{
    cm1e_foe_t *foe = present(bus);
    if (foe && foe->slave == slave)
        cm1e_foe_result(foe, &slave->datagram, now_ns);
}

void cm1e_foe_job_cancel(cm1e_bus_t *bus)
{
    /* Taken first: a thread that has seen the end of the bus may take it back, and frees it then. */
    cm1e_foe_t *foe = __atomic_exchange_n(&bus->errands.file, NULL, __ATOMIC_SEQ_CST);
    if (!foe)
        return;
    cm1e_foe_give_up(foe, FOE_BROKEN_OFF);
    give_back(foe);
}

bool cm1e_foe_job_holds(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave)
{
    const cm1e_foe_t *foe = present(bus);
    return foe && foe->slave == slave && foe->begun && (cm1e_foe_holds_mailbox(foe) || foe->yielded);
}
