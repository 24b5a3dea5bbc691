/* How it stands with the slaves that come and go, in words; and who brings them back. */
#include <stdio.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "bus/presence_text.h"

static cm1e_presence_t presence_of(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave)
{
    const bool recovers = !cm1e_recovery_idle(&slave->recovery);
    const unsigned state = slave->watch.al_state;
    if (slave->hot.away)
        return slave->hot.refused ? CM1E_PRESENCE_REFUSED : CM1E_PRESENCE_ABSENT;
    if (bus->phase != BUS_OPERATING)
        return CM1E_PRESENCE_THERE;
    if (recovers)
        return slave->watch.lost && slave->recovery.step <= RECOVERY_FIND ? CM1E_PRESENCE_ABSENT
                                                                         : CM1E_PRESENCE_COMING;
    if (slave->watch.lost)
        return CM1E_PRESENCE_ABSENT;
    if (state == CM1E_AL_OP || state == CM1E_AL_NONE)
        return slave->hot.counted || !slave->hot.optional ? CM1E_PRESENCE_THERE : CM1E_PRESENCE_COMING;
    return slave->hot.policy == CM1E_RECOVER_NEVER  ? CM1E_PRESENCE_STAYS_OUT
           : slave->hot.policy == CM1E_RECOVER_AUTO ? CM1E_PRESENCE_COMING : CM1E_PRESENCE_WAITS;
}

void cm1e_hot_note(cm1e_bus_t *bus, cm1e_bus_slave_t *slave)
{
    const uint32_t now = (uint32_t)presence_of(bus, slave);
    slave->watch.absent = slave->hot.away;
    if (now == slave->hot.presence)
        return;
    __atomic_store_n(&slave->hot.presence, now, __ATOMIC_RELAXED);
    __atomic_store_n(&bus->search.news, bus->search.news + 1, __ATOMIC_RELAXED);
}

bool cm1e_hot_may_recover(cm1e_bus_slave_t *slave, bool asked)
{
    if (slave->hot.away || slave->hot.policy == CM1E_RECOVER_NEVER)
        return false;
    const bool allowed = __atomic_exchange_n(&slave->hot.allowed, 0, __ATOMIC_RELAXED);
    return asked || allowed || slave->hot.policy == CM1E_RECOVER_AUTO;
}

void cm1e_hot_lose(cm1e_bus_slave_t *slave)
{
    slave->hot.away = true;
    slave->watch = (cm1e_slave_watch_t){.lost = true, .absent = true};
    slave->info.al_state = slave->info.al_status_code = 0;
}

void cm1e_hot_refuse(cm1e_bus_slave_t *slave, const char *reason)
{
    slave->hot.refused = reason;
    slave->hot.refused_again = true;
}

/* ---- for others -------------------------------------------------------------------------------------------------- */

cm1e_presence_t cm1e_bus_presence(const cm1e_bus_t *bus, uint32_t position)
{
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    return slave ? (cm1e_presence_t)__atomic_load_n(&slave->hot.presence, __ATOMIC_RELAXED) : CM1E_PRESENCE_ABSENT;
}

const char *cm1e_presence_name(cm1e_presence_t presence)
{
    static const char *const names[] = {"there", "absent", "waits", "coming", "refused", "stays out"};
    return (unsigned)presence < sizeof names / sizeof names[0] ? names[presence] : "?";
}

/** "alias 17", "explicit device ID 3", "place 2 of the group "tool"". */
static void address_text(const cm1e_bus_slave_t *slave, char *text, size_t size)
{
    const cm1e_axis_config_t *axis = slave->hot.axis;
    const unsigned kind = axis ? axis->address_kind : slave->config ? slave->config->address_kind : 0;
    const unsigned address = axis ? axis->address : slave->config ? slave->config->address : slave->info.position;
    if (slave->hot.member > 1)
        snprintf(text, size, "place %u of the group \"%s\"", slave->hot.member, slave->hot.group);
    else
        snprintf(text, size, "%s %u", kind == CM1E_ADDRESS_ALIAS         ? "alias"
                                      : kind == CM1E_ADDRESS_EXPLICIT_ID ? "explicit device ID" : "position", address);
}

/** Somebody who asks again and again wants to know why it is in vain. */
static void add_failure(const cm1e_bus_slave_t *slave, char *text, size_t size)
{
    const char *why = cm1e_recovery_failure(&slave->recovery);
    const size_t used = strnlen(text, size);
    if (why)
        snprintf(text + used, size - used, " The last attempt failed: %s.", why);
}

void cm1e_presence_sentence(const cm1e_bus_t *bus, uint32_t position, cm1e_presence_t presence, char *text,
                            size_t size)
{
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    char label[CM1E_LABEL_LENGTH], address[64];
    if (size)
        text[0] = '\0';
    if (!slave)
        return;
    cm1e_bus_label_first(bus, slave, label);
    address_text(slave, address, sizeof address);
    switch (presence) {
    case CM1E_PRESENCE_COUNT:
        break;
    case CM1E_PRESENCE_THERE:
        snprintf(text, size, "%s takes part.", label);
        break;
    case CM1E_PRESENCE_ABSENT:
        if (slave->hot.optional)
            snprintf(text, size, "%s is optional and absent: no device with %s is on the wire.", label, address);
        else if (cm1e_recovery_failure(&slave->recovery)) /* it gave its address back */
            snprintf(text, size, "%s is tried again.", label);
        else
            snprintf(text, size, "%s does not answer: check its power and the cables up to it.", label);
        if (!slave->hot.optional)
            add_failure(slave, text, size);
        break;
    case CM1E_PRESENCE_WAITS:
        snprintf(text, size, "%s answers and waits for being asked: %s`cm1e recover %u` or cm1e_bus_recover() brings "
                 "it back to Operational.", label, cm1e_bus_is_used(slave) ? "MC_Reset of its axis, " : "",
                 (unsigned)position);
        add_failure(slave, text, size);
        break;
    case CM1E_PRESENCE_COMING:
        snprintf(text, size, "%s is on its way to Operational.", label);
        add_failure(slave, text, size);
        break;
    case CM1E_PRESENCE_REFUSED:
        snprintf(text, size, "%s is absent: a device with %s was refused, %s.", label, address,
                 slave->hot.refused ? slave->hot.refused : "it is another one");
        break;
    case CM1E_PRESENCE_STAYS_OUT:
        snprintf(text, size, "%s answers and stays out of Operational (recover: never): start the bus again.", label);
        break;
    }
}

void cm1e_bus_presence_text(const cm1e_bus_t *bus, uint32_t position, char *text, size_t size)
{
    const cm1e_presence_t presence = cm1e_bus_presence(bus, position);
    if (!text || size == 0)
        return;
    text[0] = '\0';
    if (bus && bus->remote && bus->remote_texts && position >= 1 && position <= bus->slave_count)
        snprintf(text, size, "%s", bus->remote_texts[position - 1]);
    else if (presence != CM1E_PRESENCE_THERE)
        cm1e_presence_sentence(bus, position, presence, text, size);
}

void cm1e_stranger_text(const cm1e_stranger_t *stranger, char *text, size_t size)
{
    if (!text || size == 0)
        return;
    text[0] = '\0';
    if (!stranger)
        return;
    if (stranger->vendor_id == 0)
        snprintf(text, size, "A device at place %u of the wire was refused: its EEPROM cannot be read.",
                 stranger->place);
    else
        snprintf(text, size, "A device at place %u of the wire was refused: vendor 0x%08X, product 0x%08X, alias %u, "
                 "explicit device ID %u are not those of a slave that is missing.", stranger->place,
                 stranger->vendor_id, stranger->product_code, stranger->alias, stranger->explicit_id);
}

cm1e_error_t cm1e_bus_recover(cm1e_bus_t *bus, uint32_t position, cm1e_diag_t *diag)
{
    char text[CM1E_PRESENCE_TEXT];
    if (!bus)
        return cm1e_bus_missing("cm1e_bus_recover()", diag);
    cm1e_bus_slave_t *slave = cm1e_bus_at(bus, position);
    if (!slave)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "There is no slave %u.", (unsigned)position);
    if (cm1e_bus_presence(bus, position) != CM1E_PRESENCE_WAITS) {
        cm1e_bus_presence_text(bus, position, text, sizeof text);
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "%s", text[0] ? text : "The slave takes part already.");
    }
    __atomic_store_n(&slave->hot.allowed, 1, __ATOMIC_RELAXED);
    return CM1E_OK;
}

uint64_t cm1e_bus_presence_news(const cm1e_bus_t *bus)
{
    return bus ? __atomic_load_n(&bus->search.news, __ATOMIC_RELAXED) : 0;
}
