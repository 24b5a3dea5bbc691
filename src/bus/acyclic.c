#include "bus/bus_internal.h"

/* Datagrams in addition to the process data. Each slave has at most one on its way; `owner` says which of its state
 * machines sent it. A function waits only if it is given a time to wait. */

/** Gives the CoE client to the job of a slave when the client is idle. */
static void feed_job(const cm1e_bus_t *bus, cm1e_bus_slave_t *slave, int64_t now_ns)
{
    if (!cm1e_coe_idle(&slave->coe) || cm1e_foe_job_holds(bus, slave))
        return;
    cm1e_sdo_t *sdo = cm1e_recognise_next(&slave->recognition, now_ns);
    if (!sdo)
        sdo = cm1e_setup_next(&slave->setup);
    if (!sdo && !cm1e_mapping_idle(&slave->mapping))
        sdo = cm1e_mapping_next(&slave->mapping);
    if (sdo)
        cm1e_coe_begin(&slave->coe, sdo, now_ns);
}

/** The next datagram of this slave, by precedence. */
static bool next_datagram(cm1e_bus_t *bus, cm1e_bus_slave_t *slave, int64_t now_ns)
{
    if (!cm1e_recovery_idle(&slave->recovery)) {
        cm1e_coe_expire(&slave->coe, now_ns); /* a transfer has its own time, also where the recovery lets it wait */
        slave->owner = OWNER_RECOVERY;
        const bool sends = cm1e_recovery_next(slave, &slave->datagram, now_ns);
        cm1e_hot_note(bus, slave);
        return sends;
    }
    if (!cm1e_al_idle(&slave->al)) {
        slave->owner = OWNER_AL;
        return cm1e_al_next(&slave->al, &slave->datagram, now_ns);
    }
    feed_job(bus, slave, now_ns);
    const bool has_errand = cm1e_errand_next(bus, slave), sends_errand = has_errand && !bus->errands.sent;
    if (has_errand)
        bus->errands.sent = sends_errand;
    slave->owner = sends_errand ? OWNER_ERRAND : OWNER_FILE;
    if (sends_errand || cm1e_foe_job_next(bus, slave, now_ns))
        return true;
    slave->owner = OWNER_COE;
    return cm1e_coe_next(&slave->coe, &slave->datagram, now_ns);
}

/** Puts the datagram of a slave into the last frame, if one has been begun, or into a new one. In operation each has a
 *  frame of its own, so that a lost one concerns one slave. */
static void put(cm1e_bus_t *bus, cm1e_bus_slave_t *slave, bool begun, int64_t now_ns)
{
    cm1e_acyclic_t *acyclic = &bus->acyclic;
    cm1e_acyclic_frame_t *frame = begun ? &acyclic->frames[acyclic->count - 1] : NULL;
    if (!frame || bus->phase == BUS_OPERATING || !cm1e_soem_add(bus->soem, &frame->bundle, &slave->datagram)) {
        if (frame)
            cm1e_soem_post_bundle(bus->soem, &frame->bundle, now_ns);
        frame = &acyclic->frames[acyclic->count++];
        frame->bundle.count = 0;
        cm1e_soem_add(bus->soem, &frame->bundle, &slave->datagram);
    }
    frame->slaves[frame->bundle.count - 1] = slave;
}

/** The next datagram of this slave; notes whether it is another one than the one before. */
static bool goes_on(cm1e_bus_t *bus, cm1e_bus_slave_t *slave, int64_t now_ns)
{
    const cm1e_datagram_t *d = &slave->datagram;
    const uint16_t offset = d->offset, length = d->length;
    const uint8_t command = d->command;
    if (!next_datagram(bus, slave, now_ns)) {
        slave->owner = OWNER_NONE;
        return false;
    }
    if (d->command != command || d->offset != offset || d->length != length)
        bus->acyclic.progress_ns = now_ns;
    return true;
}

/** Nothing is to be done with this slave, apart from errands and files. In most cycles that is so of all slaves. */
static bool is_at_rest(const cm1e_bus_slave_t *slave)
{
    return cm1e_coe_idle(&slave->coe) && cm1e_recovery_idle(&slave->recovery) && cm1e_al_idle(&slave->al) &&
           cm1e_recognise_idle(&slave->recognition) && cm1e_setup_idle(&slave->setup) &&
           cm1e_mapping_idle(&slave->mapping) && !slave->eeprom_owed;
}

static bool has_errands(const cm1e_bus_t *bus)
{
    return __atomic_load_n(&bus->errands.errand, __ATOMIC_ACQUIRE) ||
           __atomic_load_n(&bus->errands.file, __ATOMIC_ACQUIRE);
}

/** Sends datagrams of slaves in turn. Returns whether all slaves were met, and none of them has work left. */
static bool serve_slaves(cm1e_bus_t *bus, int64_t now_ns, unsigned limit)
{
    uint32_t place = bus->acyclic.next, n = 0;
    const unsigned before = bus->acyclic.count;
    const bool errands = has_errands(bus);
    bool rest = !errands;
    for (; n < bus->slave_count && limit > 0 && bus->acyclic.count < CM1E_FRAMES_IN_FLIGHT; n++) {
        place = place + 1 < bus->slave_count ? place + 1 : 0;
        cm1e_bus_slave_t *slave = &bus->slaves[place];
        if (slave->owner == OWNER_NONE && !errands && is_at_rest(slave))
            continue;
        rest = false;
        if (slave->owner != OWNER_NONE || !goes_on(bus, slave, now_ns))
            continue;
        put(bus, slave, bus->acyclic.count > before, now_ns);
        bus->acyclic.next = place;
        limit--;
    }
    return rest && n == bus->slave_count;
}

void cm1e_acyclic_send(cm1e_bus_t *bus, int64_t now_ns, unsigned limit)
{
    const unsigned before = bus->acyclic.count;
    cm1e_errand_serve(bus, now_ns);
    cm1e_foe_job_serve(bus, now_ns);
    cm1e_sdo_queue_serve(bus, now_ns);
    if (bus->acyclic.rests && bus->phase == BUS_OPERATING && !has_errands(bus))
        return;
    bus->acyclic.rests = serve_slaves(bus, now_ns, limit);
    if (bus->acyclic.count > before)
        cm1e_soem_post_bundle(bus->soem, &bus->acyclic.frames[bus->acyclic.count - 1].bundle, now_ns);
}

static void deliver(cm1e_bus_t *bus, cm1e_bus_slave_t *slave, int64_t now_ns)
{
    const cm1e_datagram_owner_t owner = slave->owner;
    slave->owner = OWNER_NONE;
    switch (owner) {
    case OWNER_NONE:
        break;
    case OWNER_AL:
        cm1e_al_result(&slave->al, &slave->datagram, now_ns);
        break;
    case OWNER_COE:
        cm1e_coe_result(&slave->coe, &slave->datagram, now_ns);
        cm1e_bus_keep_emergency(bus, slave);
        break;
    case OWNER_RECOVERY:
        cm1e_recovery_result(slave, &slave->datagram, now_ns);
        cm1e_bus_keep_emergency(bus, slave); /* one that came before the answer to a transfer of the recovery */
        cm1e_hot_note(bus, slave);
        break;
    case OWNER_ERRAND:
        cm1e_errand_result(bus, slave, now_ns);
        break;
    case OWNER_FILE:
        cm1e_foe_job_result(bus, slave, now_ns);
        break;
    }
}

void cm1e_acyclic_receive(cm1e_bus_t *bus, int64_t wait_ns)
{
    cm1e_acyclic_t *acyclic = &bus->acyclic;
    unsigned kept = 0;
    for (unsigned i = 0; i < acyclic->count; i++) {
        cm1e_acyclic_frame_t *frame = &acyclic->frames[i];
        const bool back = cm1e_soem_take_bundle(bus->soem, &frame->bundle, wait_ns);
        const int64_t now_ns = cm1e_clock_now(bus->clock);
        if (!back && now_ns - frame->bundle.sent_ns < CM1E_FRAME_LOST_NS) {
            if (kept++ != i)
                acyclic->frames[kept - 1] = *frame;
            continue;
        }
        if (!back)
            cm1e_soem_drop_bundle(bus->soem, &frame->bundle);
        for (unsigned n = 0; n < frame->bundle.count; n++) {
            if (frame->slaves[n]->datagram.working_counter == DATAGRAM_LOST) {
                bus->counters.mailbox_retries++;
                acyclic->careful_until_ns = now_ns + CM1E_PUMP_CAREFUL_NS;
            }
            deliver(bus, frame->slaves[n], now_ns);
        }
    }
    acyclic->count = kept;
}

void cm1e_acyclic_cancel(cm1e_bus_t *bus)
{
    for (unsigned i = 0; i < bus->acyclic.count; i++) {
        const cm1e_acyclic_frame_t *frame = &bus->acyclic.frames[i];
        cm1e_soem_drop_bundle(bus->soem, &frame->bundle);
        for (unsigned n = 0; n < frame->bundle.count; n++)
            frame->slaves[n]->owner = OWNER_NONE;
    }
    bus->acyclic.count = 0;
    cm1e_acyclic_wake(bus);
    cm1e_supervision_forget(bus);
    cm1e_listen_forget(bus);
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        cm1e_recovery_cancel(slave);
        cm1e_coe_cancel(&slave->coe, CM1E_ERROR_CANCELLED);
    }
    cm1e_errand_cancel(bus);
    cm1e_foe_job_cancel(bus);
}
