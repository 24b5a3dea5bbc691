#include "bus/bus_internal.h"
#include "core/bytes.h"

/** One slave's AL status in each cycle, in turn. A slave counts as lost after three unanswered questions in a row: a
 *  single one may be a disturbed frame. */
enum { AL_STATUS_BYTES = 6, UNANSWERED_LIMIT = 3 };

void cm1e_supervision_note(cm1e_bus_slave_t *slave, uint16_t al_state, uint16_t al_status_code)
{
    slave->unanswered = 0;
    if (al_status_code != slave->watch.al_status_code)
        cm1e_dc_note_status(slave, al_status_code);
    slave->watch = (cm1e_slave_watch_t){.al_state = al_state, .al_status_code = al_status_code};
    slave->info.al_state = al_state;
    slave->info.al_status_code = al_status_code;
}

void cm1e_supervision_send(cm1e_bus_t *bus, int64_t now_ns)
{
    if (bus->watching.sent || bus->slave_count == 0)
        return;
    if (cm1e_dc_next_look(bus, &bus->watching.datagram)) {
        cm1e_soem_post(bus->soem, &bus->watching.datagram, now_ns);
        bus->watching.sent = true;
        return;
    }
    bus->watching.slave = bus->watching.slave + 1 < bus->slave_count ? bus->watching.slave + 1 : 0;
    cm1e_datagram_set(&bus->watching.datagram, COMMAND_FPRD, bus->slaves[bus->watching.slave].facts.station, REG_AL_STATUS,
                      AL_STATUS_BYTES);
    cm1e_soem_post(bus->soem, &bus->watching.datagram, now_ns);
    bus->watching.sent = true;
}

/** No axis requests the recovery of a device between the axes, but while it is missing, the working counter of all is
 *  wrong. So it is brought back without a request, always with zeros as outputs. A motor is never brought back without
 *  a request. */
static void recover_unasked(cm1e_bus_t *bus, cm1e_bus_slave_t *slave)
{
    if (!cm1e_bus_has_motors(slave) && slave->watch.al_state != CM1E_AL_OP)
        cm1e_bus_request_recovery(bus, slave->info.position);
}

void cm1e_supervision_receive(cm1e_bus_t *bus, int64_t now_ns)
{
    cm1e_datagram_t *d = &bus->watching.datagram;
    cm1e_bus_slave_t *slave = &bus->slaves[bus->watching.slave];
    if (!bus->watching.sent)
        return;
    if (!cm1e_soem_take(bus->soem, d, 0)) {
        if (now_ns - d->sent_ns < CM1E_FRAME_LOST_NS)
            return;
        cm1e_soem_drop(bus->soem, d);
    }
    bus->watching.sent = false;
    if (d->offset == REG_DC_DIFFERENCE) {
        cm1e_dc_looked(bus, d);
        return;
    }
    if (d->working_counter == 1) {
        cm1e_supervision_note(slave, cm1e_get_u16(d->data), cm1e_get_u16(d->data + 4));
    } else if (d->working_counter == 0 && ++slave->unanswered >= UNANSWERED_LIMIT) {
        slave->watch = (cm1e_slave_watch_t){.lost = true};
        slave->info.al_state = slave->info.al_status_code = 0;
    }
    recover_unasked(bus, slave);
}

cm1e_slave_watch_t cm1e_bus_slave_watch(const cm1e_bus_t *bus, uint16_t position)
{
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    if (!slave)
        return (cm1e_slave_watch_t){.lost = true};
    cm1e_slave_watch_t watch = slave->watch;
    watch.silent = slave->silent_cycles >= bus->config.lost_cycles_limit;
    watch.fresh = bus->last_error == CM1E_OK || (bus->partly_fresh && slave->silent_cycles == 0);
    return watch;
}

void cm1e_bus_request_recovery(cm1e_bus_t *bus, uint16_t position)
{
    cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    if (slave && bus->phase == BUS_OPERATING && cm1e_recovery_idle(&slave->recovery))
        cm1e_recovery_begin(slave);
}
