#include <stdio.h>

#include "bus/bus_internal.h"

const char *cm1e_bus_other_master(const cm1e_bus_t *bus, char text[CM1E_OTHER_MASTER_LENGTH])
{
    const uint64_t frames = cm1e_soem_foreign_frames(bus->soem);
    text[0] = 0;
    if (frames > 0)
        snprintf(text, CM1E_OTHER_MASTER_LENGTH, CM1E_OTHER_MASTER_TEXT, (unsigned long long)frames);
    return text;
}

/** Explains why a slave stays in Init. A controller that refuses its EEPROM gives its processor no access, so the
 *  device learns of no state. */
static const char *why_in_init(cm1e_bus_t *bus, const cm1e_bus_slave_t *slave)
{
    enum { REG_DL_STATUS = 0x0110, EEPROM_LOADED = 1 };
    uint8_t status[2] = {0};
    if (slave->al.state != CM1E_AL_INIT || bus->exchanging ||
        !cm1e_bus_read_registers(bus, slave->info.position, REG_DL_STATUS, status, sizeof status) ||
        status[0] & EEPROM_LOADED)
        return "";
    return " Its controller has not loaded its EEPROM: the checksum is wrong, or the EEPROM is empty. `cm1e sii "
           "decode` shows it, `cm1e sii write` writes it anew.";
}

/** What only the combination of an alias and of rotary switches is refused for (UG 4.2.4). */
static void why_both_addresses(const cm1e_bus_slave_t *slave, char *text, size_t size)
{
    const cm1e_device_t *device = slave->info.device;
    text[0] = '\0';
    if (device && device->explicit_id && slave->info.alias != 0 && slave->al.target == CM1E_AL_PRE_OP &&
        (slave->al.state & ~AL_ERROR_FLAG) == CM1E_AL_INIT)
        snprintf(text, size, " It has the alias %u: with its rotary switches set too, it has an internal error. Set "
                 "both switches to 0, and switch it off and on. `cm1e alias` takes the alias away, if the switches are "
                 "to count.", slave->info.alias);
}

cm1e_error_t cm1e_bus_diagnose_state(cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, cm1e_diag_t *diag)
{
    char label[CM1E_LABEL_LENGTH], other[CM1E_OTHER_MASTER_LENGTH], both[240];
    const cm1e_al_machine_t *al = &slave->al;
    const char *target = cm1e_al_state_text(al->target);
    cm1e_bus_label_first(bus, slave, label);
    cm1e_bus_other_master(bus, other);
    why_both_addresses(slave, both, sizeof both);
    if (cm1e_al_is_silent(al))
        return cm1e_diag_set(diag, CM1E_ERROR_BUS_STATE, 0,
                             "%s does not answer when asked to go to %s: check its power and its cable.%s",
                             label, target, other);
    if (al->state & AL_ERROR_FLAG && al->code == 0)
        return cm1e_diag_set(diag, CM1E_ERROR_BUS_STATE, al->code,
                             "%s refuses %s, is in %s, and gives no reason: its AL status code is 0.%s%s", label,
                             target, cm1e_al_state_text(al->state), both, other);
    if (al->state & AL_ERROR_FLAG)
        return cm1e_diag_set(diag, CM1E_ERROR_BUS_STATE, al->code,
                             "%s refuses %s and is in %s: AL status 0x%04X, %s.%s%s", label, target,
                             cm1e_al_state_text(al->state), al->code, cm1e_al_status_text(al->code), both, other);
    return cm1e_diag_set(diag, CM1E_ERROR_BUS_STATE, al->code, "%s did not reach %s in time; it stays in %s.%s%s",
                         label, target, cm1e_al_state_text(al->state), why_in_init(bus, slave), other);
}

cm1e_error_t cm1e_bus_all_to_state(cm1e_bus_t *bus, uint8_t target, int64_t timeout_ns, cm1e_diag_t *diag)
{
    const int64_t deadline_ns = cm1e_clock_now(bus->clock) + timeout_ns;
    for (uint32_t i = 0; i < bus->scanned; i++)
        if (!bus->slaves[i].hot.away)
            cm1e_al_request(&bus->slaves[i].al, target, deadline_ns);
    /* The machines end by themselves; the margin is for datagrams that are still on their way. */
    cm1e_bus_pump_until_idle(bus, deadline_ns + CM1E_STATE_TIMEOUT_NS);
    cm1e_supervision_forget(bus); /* it may have asked before the slave changed its state */
    cm1e_error_t first = CM1E_OK;
    for (uint32_t i = 0; i < bus->scanned; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        if (slave->hot.away)
            continue;
        if (bus->phase == BUS_OPERATING && slave->hot.optional && cm1e_al_is_silent(&slave->al)) {
            cm1e_supervision_lose(bus, slave); /* it left while nobody looked */
            continue;
        }
        slave->info.al_state = slave->al.state;
        slave->info.al_status_code = slave->al.code;
        slave->watch = (cm1e_slave_watch_t){.al_state = slave->al.state, .al_status_code = slave->al.code};
        if (slave->al.error != CM1E_OK && first == CM1E_OK)
            first = cm1e_bus_diagnose_state(bus, slave, diag);
    }
    return first;
}

cm1e_error_t cm1e_bus_diagnose_sdo(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave, const cm1e_sdo_t *sdo,
                                   const char *purpose, cm1e_diag_t *diag)
{
    char label[CM1E_LABEL_LENGTH];
    cm1e_bus_label(bus, slave, label);
    const char *verb = sdo->write ? "write" : "read";
    if (sdo->error == CM1E_ERROR_SDO_ABORT)
        return cm1e_diag_set(diag, sdo->error, sdo->abort_code,
                             "%s: %s refuses to %s object 0x%04X:%02X: SDO abort 0x%08X, %s.", purpose, label, verb,
                             sdo->index, sdo->subindex, sdo->abort_code, cm1e_sdo_abort_text(sdo->abort_code));
    return cm1e_diag_set(diag, sdo->error, slave->coe.mailbox_error, "%s: %s did not %s object 0x%04X:%02X: %s.",
                         purpose, label, verb, sdo->index, sdo->subindex, cm1e_strerror(sdo->error));
}
