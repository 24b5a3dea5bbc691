/* Looks for devices that have come: those without a station address of ours. Each gets an address for the search only,
 * its FMMUs are cleared and it is brought to Init, so that it cannot touch the process data, whoever has configured it
 * before. Then it is identified by SII, alias and explicit device ID. One that is expected gets its station address, a
 * stranger none. One datagram at a time, in place of the supervision's own. */
#include <string.h>

#include "bus/bus_internal.h"
#include "core/bytes.h"
#include "device/place.h"

/** Between two counts of the devices, between two walks while somebody is missing, and until a stranger is identified
 *  again: its switches may have been turned. */
#define COUNT_PACE_NS INT64_C(20000000)
#define WALK_PACE_NS INT64_C(300000000)
#define STRANGER_PACE_NS INT64_C(2000000000)
/** For one datagram; for the state Init; for the SII; for the explicit device ID, which comes at once or never. */
#define ANSWER_NS INT64_C(10000000)
#define INIT_NS INT64_C(500000000)
#define SCOUT_NS INT64_C(5000000000)
#define ID_NS INT64_C(100000000)

enum { APRW_WORKING_COUNTER = 3, DOUBLES_IN_A_ROW = 3 };
/** So many questions in a row without an answer, while frames come back: the device is gone. */
enum { UNANSWERED_LIMIT = 10 };
enum { PROTOCOL_COE = 0x04, PROTOCOL_FOE = 0x08, MAILBOX_OUT_CONTROL = 0x26, MAILBOX_IN_CONTROL = 0x22 };

/** A step is one datagram, which is repeated until it is answered, or a machine of several: then `bytes` is 0. */
typedef struct search_action {
    int64_t time_ns;
    cm1e_command_t command;
    uint16_t offset, bytes;
    cm1e_search_step_t then; /**< the step after an answer, if that does not depend on it */
} search_action_t;

static const search_action_t actions[] = {
    [SEARCH_COUNT] = {ANSWER_NS, COMMAND_BRD, 0, 1},
    [SEARCH_WALK] = {ANSWER_NS, COMMAND_APRD, REG_STATION_ADDRESS, 4},
    [SEARCH_ADDRESS] = {ANSWER_NS, COMMAND_APRW, REG_STATION_ADDRESS, 2},
    [SEARCH_RETURN] = {ANSWER_NS, COMMAND_FPWR, REG_STATION_ADDRESS, 2},
    [SEARCH_ALIAS] = {ANSWER_NS, COMMAND_FPRD, REG_STATION_ALIAS, 2},
    [SEARCH_CLEAR] = {ANSWER_NS, COMMAND_FPWR, REG_FMMU0, 4 * FMMU_BYTES, .then = SEARCH_INIT},
    [SEARCH_INIT] = {.time_ns = INIT_NS},
    [SEARCH_SCOUT] = {.time_ns = SCOUT_NS},
    [SEARCH_ID] = {.time_ns = ID_NS + INIT_NS},
    [SEARCH_OFFER] = {ANSWER_NS, COMMAND_FPWR, REG_EEPROM_CONFIG, 1, .then = SEARCH_MAILBOX},
    [SEARCH_MAILBOX] = {ANSWER_NS, COMMAND_FPWR, REG_SM0, 2 * SYNC_MANAGER_BYTES, .then = SEARCH_PRE_OP},
    [SEARCH_PRE_OP] = {.time_ns = CM1E_STATE_TIMEOUT_NS},
    [SEARCH_LATE_ID] = {.time_ns = ID_NS + INIT_NS},
    [SEARCH_BACK] = {.time_ns = INIT_NS},
    [SEARCH_GIVE] = {ANSWER_NS, COMMAND_FPWR, REG_STATION_ADDRESS, 2},
    [SEARCH_RELEASE] = {ANSWER_NS, COMMAND_FPWR, REG_STATION_ADDRESS, 2},
};

static bool is_machine(cm1e_search_step_t step) { return step != SEARCH_PAUSE && actions[step].bytes == 0; }

static void enter(cm1e_search_t *search, cm1e_search_step_t step, int64_t now_ns)
{
    search->step = step;
    search->entered = false;
    search->deadline_ns = now_ns + actions[step].time_ns;
}

static uint16_t by_place(uint16_t place) { return (uint16_t)(1 - place); }

static bool is_missing(const cm1e_bus_slave_t *slave) { return slave->hot.away || slave->watch.lost; }

static bool any_missing(const cm1e_bus_t *bus)
{
    for (uint32_t i = 0; i < bus->slave_count; i++)
        if (is_missing(&bus->slaves[i]))
            return true;
    return false;
}

static void tell_news(cm1e_bus_t *bus) { __atomic_store_n(&bus->search.news, bus->search.news + 1, __ATOMIC_RELAXED); }

/* ---- strangers --------------------------------------------------------------------------------------------------- */

static uint32_t all_strangers(const cm1e_search_t *search, cm1e_stranger_t strangers[CM1E_STRANGERS])
{
    const uint32_t count = cm1e_strangers_count(&search->strangers);
    for (uint32_t i = 0; i < count; i++)
        strangers[i] = cm1e_strangers_at(&search->strangers, i);
    return count;
}

/** Which of them is at this place; their number: none. */
static uint32_t stranger_at(const cm1e_search_t *search, uint16_t place)
{
    uint32_t at = 0;
    while (at < cm1e_strangers_count(&search->strangers) && cm1e_strangers_at(&search->strangers, at).place != place)
        at++;
    return at;
}

static void keep_stranger(cm1e_bus_t *bus)
{
    static const cm1e_scouted_t nothing;
    cm1e_search_t *search = &bus->search;
    const cm1e_scouted_t *found = search->scout.good ? &search->scout.found : &nothing;
    cm1e_stranger_t strangers[CM1E_STRANGERS];
    const uint32_t count = all_strangers(search, strangers), at = stranger_at(search, search->place);
    if (at == CM1E_STRANGERS)
        return;
    strangers[at] = (cm1e_stranger_t){
        .place = search->place, .alias = search->alias, .explicit_id = search->al.explicit_id,
        .vendor_id = found->vendor_id, .product_code = found->product_code, .revision = found->revision,
        .serial_number = found->serial_number};
    search->seen_strangers |= 1u << at;
    if (cm1e_strangers_set(&search->strangers, strangers, at == count ? count + 1 : count))
        tell_news(bus);
}

/** After a walk: those that are gone. */
static void forget_strangers(cm1e_bus_t *bus)
{
    cm1e_search_t *search = &bus->search;
    cm1e_stranger_t strangers[CM1E_STRANGERS];
    const uint32_t count = all_strangers(search, strangers);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++)
        if (search->seen_strangers >> i & 1)
            strangers[kept++] = strangers[i];
    if (cm1e_strangers_set(&search->strangers, strangers, kept))
        tell_news(bus);
}

/** Of the devices that were refused, too. */
static void forget_refused(cm1e_bus_t *bus)
{
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        if (!slave->hot.away || !slave->hot.refused || slave->hot.refused_again)
            continue;
        slave->hot.refused = NULL;
        cm1e_hot_note(bus, slave);
    }
}

/* ---- who it is --------------------------------------------------------------------------------------------------- */

static cm1e_address_kind_t kind_of(const cm1e_bus_slave_t *slave)
{
    const cm1e_axis_config_t *axis = slave->hot.axis;
    return axis ? axis->address_kind : slave->config ? slave->config->address_kind : CM1E_ADDRESS_POSITION;
}

/** A vendor of 0: it is recognised by its objects, when it is in Pre-Operational. What is noted of a slave that never
 *  took part may be that of a device that was refused. */
static bool has_identity(const cm1e_bus_slave_t *slave, const cm1e_scouted_t *found)
{
    const uint32_t vendor_id = slave->hot.planned ? slave->hot.vendor_id : slave->info.vendor_id;
    const uint32_t product_code = slave->hot.planned ? slave->hot.product_code : slave->info.product_code;
    const bool revision = !slave->config || !slave->config->revision || slave->config->revision == found->revision;
    return vendor_id == 0 || (vendor_id == found->vendor_id && product_code == found->product_code && revision);
}

static const cm1e_bus_slave_t *head_of(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave)
{
    for (uint32_t i = 0; i < bus->slave_count; i++)
        if (bus->slaves[i].hot.member == 1 && strcmp(bus->slaves[i].hot.group, slave->hot.group) == 0)
            return &bus->slaves[i];
    return NULL;
}

static bool has_address(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave)
{
    const cm1e_search_t *search = &bus->search;
    const cm1e_bus_slave_t *head = slave->hot.member > 1 ? head_of(bus, slave) : NULL;
    if (slave->hot.member > 1)
        return head && !is_missing(head) && head->hot.place + slave->hot.member - 1 == search->place;
    const cm1e_axis_config_t *axis = slave->hot.axis;
    const unsigned address = axis ? axis->address : slave->config ? slave->config->address : 0;
    const bool by_alias = kind_of(slave) == CM1E_ADDRESS_ALIAS;
    return address && address == (by_alias ? search->alias : search->al.explicit_id);
}

/** The optional slave that it is; NULL: none. */
static cm1e_bus_slave_t *find_candidate(cm1e_bus_t *bus)
{
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        if (!slave->hot.optional || !slave->hot.away || !has_address(bus, slave))
            continue;
        if (has_identity(slave, &bus->search.scout.found))
            return slave;
        cm1e_hot_refuse(slave, "its vendor, product or revision is another one");
        cm1e_hot_note(bus, slave);
    }
    return NULL;
}

/** Whether a slave that is not optional can be at this place: their order on the wire does not change. */
static bool is_in_order(const cm1e_bus_t *bus, const cm1e_bus_slave_t *slave)
{
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        const cm1e_bus_slave_t *other = &bus->slaves[i];
        if (other == slave || other->hot.optional || other->watch.lost)
            continue;
        if ((other->info.position < slave->info.position) != (other->hot.place < bus->search.place))
            return false;
    }
    return true;
}

/** The slave that is not optional and that has lost its station address; NULL: none. */
static cm1e_bus_slave_t *find_lost(cm1e_bus_t *bus)
{
    const cm1e_search_t *search = &bus->search;
    const cm1e_scouted_t *found = &search->scout.found;
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        cm1e_bus_slave_t *slave = &bus->slaves[i];
        const bool same = slave->facts.alias == search->alias && slave->info.vendor_id == found->vendor_id &&
                          slave->info.product_code == found->product_code &&
                          slave->info.serial_number == found->serial_number;
        if (!slave->hot.optional && slave->watch.lost && same && is_in_order(bus, slave))
            return slave;
    }
    return NULL;
}

/** Whether its explicit device ID decides. */
static bool is_asked_for_id(const cm1e_bus_t *bus)
{
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        const cm1e_bus_slave_t *slave = &bus->slaves[i];
        if (slave->hot.away && slave->hot.member == 1 && kind_of(slave) == CM1E_ADDRESS_EXPLICIT_ID &&
            has_identity(slave, &bus->search.scout.found))
            return true;
    }
    return false;
}

static void decide(cm1e_bus_t *bus, int64_t now_ns)
{
    cm1e_search_t *search = &bus->search;
    search->candidate = search->scout.good ? find_candidate(bus) : NULL;
    if (!search->candidate && search->scout.good)
        search->candidate = find_lost(bus);
    if (!search->candidate)
        keep_stranger(bus);
    enter(search, search->candidate ? SEARCH_GIVE : SEARCH_RELEASE, now_ns);
}

/* ---- it is one of ours ------------------------------------------------------------------------------------------- */

static void put_mailbox(uint8_t *sync_manager, uint16_t start, uint16_t length, uint8_t control)
{
    memset(sync_manager, 0, SYNC_MANAGER_BYTES);
    if (length == 0)
        return; /* it has no mailbox */
    cm1e_put_u16(sync_manager, start);
    cm1e_put_u16(sync_manager + 2, length);
    sync_manager[4] = control;
    sync_manager[6] = 1;
}

/** SM0 and SM1. */
static void put_mailboxes(uint8_t *sync_managers, const cm1e_scouted_t *found)
{
    put_mailbox(sync_managers, found->mailbox_out_start, found->mailbox_out_length, MAILBOX_OUT_CONTROL);
    put_mailbox(sync_managers + SYNC_MANAGER_BYTES, found->mailbox_in_start, found->mailbox_in_length,
                MAILBOX_IN_CONTROL);
}

/** What the scan would have found. */
static void take_facts(const cm1e_bus_t *bus, cm1e_bus_slave_t *slave)
{
    const cm1e_scouted_t *found = &bus->search.scout.found;
    const bool mailbox = found->mailbox_out_length > 0 && found->mailbox_in_length > 0;
    const bool coe = mailbox && found->protocols & PROTOCOL_COE, foe = mailbox && found->protocols & PROTOCOL_FOE;
    slave->hot.scouted = *found;
    slave->info.vendor_id = slave->facts.vendor_id = found->vendor_id;
    slave->info.product_code = slave->facts.product_code = found->product_code;
    slave->info.revision = slave->facts.revision = found->revision;
    slave->info.serial_number = slave->facts.serial_number = found->serial_number;
    slave->info.alias = slave->facts.alias = bus->search.alias;
    slave->facts.coe = coe;
    slave->facts.foe = foe;
    slave->facts.swapped = cm1e_sii_is_swapped(found->sync_managers);
    slave->by_pdos = slave->hot.stated[0] || slave->hot.stated[1]; /* not as the last device, which was refused */
    slave->coe.mailbox = (cm1e_mailbox_t){
        .station = slave->facts.station, .out_start = found->mailbox_out_start,
        .out_length = coe || foe ? found->mailbox_out_length : 0, .in_start = found->mailbox_in_start,
        .in_length = coe || foe ? found->mailbox_in_length : 0,
    };
    put_mailboxes(slave->placement.sync_managers[0], found);
}

/** The serial number of a slave that may come and go is not compared: a tool is known by its address. */
static void welcome(cm1e_bus_t *bus, cm1e_bus_slave_t *slave, int64_t now_ns)
{
    slave->hot.place = bus->search.place;
    if (!slave->hot.optional)
        return; /* its recovery goes on, or waits for a request */
    slave->hot.away = false;
    slave->hot.refused = NULL;
    slave->unanswered = 0;
    if (slave->hot.planned) {
        take_facts(bus, slave);
        if (!slave->facts.coe) /* also its first sync managers carry process data; whether it fits is judged later */
            (void)cm1e_hot_place(slave);
    } else {
        slave->info.serial_number = slave->facts.serial_number = bus->search.scout.found.serial_number;
        slave->info.alias = slave->facts.alias = bus->search.alias;
    }
    slave->watch = (cm1e_slave_watch_t){.al_state = CM1E_AL_INIT};
    slave->info.al_state = CM1E_AL_INIT;
    if (cm1e_hot_may_recover(slave, false))
        cm1e_recovery_begin_found(bus, slave, now_ns);
    cm1e_hot_note(bus, slave);
}

/* ---- the walk ---------------------------------------------------------------------------------------------------- */

static void pause_search(cm1e_search_t *search, int64_t now_ns)
{
    cm1e_scout_cancel(&search->scout);
    search->step = SEARCH_PAUSE;
    search->due_ns = now_ns + COUNT_PACE_NS;
}

/** Whether a slave that does not answer at its address still runs, because its inputs come. One without inputs may run
 *  until it counts as lost. */
static bool runs(const cm1e_bus_slave_t *slave)
{
    return slave->hot.counted && (slave->placement.input_bytes > 0 ? slave->silent_cycles == 0 : !slave->watch.lost);
}

/** A device has the address of the search, and nobody knows which one it had: an answer was lost. It is the one of ours
 *  that runs and was not seen; else it is a new one, or one of ours that has to be identified again. */
static void take_orphan(cm1e_bus_t *bus, int64_t now_ns)
{
    cm1e_search_t *search = &bus->search;
    search->place = search->orphan;
    search->orphan = 0;
    search->ends = true; /* all places have been seen */
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        const cm1e_bus_slave_t *slave = &bus->slaves[i];
        if (slave->hot.seen || slave->hot.away || !runs(slave))
            continue;
        search->returned = slave->facts.station;
        enter(search, SEARCH_RETURN, now_ns);
        return;
    }
    enter(search, SEARCH_ALIAS, now_ns);
}

/** At once, from the beginning. A device may have the address of the search: until it is known which one, no other
 *  gets it. */
static void walk_again(cm1e_search_t *search, int64_t now_ns)
{
    pause_search(search, now_ns);
    search->due_ns = now_ns;
    search->count = 0;
    search->only_looks = true;
}

static void next_place(cm1e_bus_t *bus, int64_t now_ns)
{
    cm1e_search_t *search = &bus->search;
    if (search->place < search->count && !search->ends) {
        search->place++;
        enter(search, SEARCH_WALK, now_ns);
        return;
    }
    if (search->crowded) { /* each of them is met without an address in the next walk */
        search->crowded = false;
        search->orphan = 0;
        enter(search, SEARCH_RELEASE, now_ns);
        return;
    }
    if (search->orphan) {
        take_orphan(bus, now_ns);
        return;
    }
    if (search->only_looks) {
        walk_again(search, now_ns);
        search->only_looks = false;
        return;
    }
    forget_strangers(bus);
    if (search->again)
        forget_refused(bus);
    search->doubles = 0;
    search->walk_ns = now_ns + (any_missing(bus) ? WALK_PACE_NS : STRANGER_PACE_NS);
    pause_search(search, now_ns);
}

static void take_count(cm1e_bus_t *bus, int working_counter, int64_t now_ns)
{
    cm1e_search_t *search = &bus->search;
    const uint16_t count = working_counter > CM1E_MAX_SLAVES ? CM1E_MAX_SLAVES : (uint16_t)working_counter;
    const bool changed = count != search->count;
    const bool due = now_ns >= search->walk_ns && (any_missing(bus) || cm1e_strangers_count(&search->strangers) > 0);
    search->count = count;
    if (!changed && !due) {
        pause_search(search, now_ns);
        return;
    }
    if (changed)
        search->strangers_ns = 0;
    search->again = now_ns >= search->strangers_ns;
    if (search->again)
        search->strangers_ns = now_ns + STRANGER_PACE_NS;
    search->seen_strangers = 0;
    search->place = search->orphan = 0;
    search->ends = search->crowded = false;
    for (uint32_t i = 0; i < bus->slave_count; i++) {
        bus->slaves[i].hot.seen = false;
        bus->slaves[i].hot.refused_again &= !search->again;
    }
    next_place(bus, now_ns);
}

/** The slave of ours with this station address; NULL: none. */
static cm1e_bus_slave_t *find_known(cm1e_bus_t *bus, uint16_t station)
{
    for (uint32_t i = 0; i < bus->slave_count; i++)
        if (bus->slaves[i].facts.station == station && !bus->slaves[i].hot.away)
            return &bus->slaves[i];
    return NULL;
}

/** One of ours is where it answers. If it seems to be there twice, a slave has come meanwhile, and it was met again at
 *  its next place; or there are two with its address, and the second one is none of ours. */
static bool take_known(cm1e_bus_t *bus, int64_t now_ns)
{
    cm1e_search_t *search = &bus->search;
    cm1e_bus_slave_t *slave = search->station ? find_known(bus, search->station) : NULL;
    if (!slave)
        return false;
    if (!slave->hot.seen) {
        slave->hot.seen = true;
        slave->hot.place = search->place;
        next_place(bus, now_ns);
        return true;
    }
    if (++search->doubles > DOUBLES_IN_A_ROW)
        return false;
    walk_again(search, now_ns);
    return true;
}

static void take_device(cm1e_bus_t *bus, const cm1e_datagram_t *d, int64_t now_ns)
{
    cm1e_search_t *search = &bus->search;
    search->station = cm1e_get_u16(d->data);
    search->alias = cm1e_get_u16(d->data + 2);
    if (take_known(bus, now_ns))
        return;
    const uint32_t known = stranger_at(search, search->place);
    if (search->station == 0 && !search->again && known < cm1e_strangers_count(&search->strangers)) {
        search->seen_strangers |= 1u << known;
        next_place(bus, now_ns);
        return;
    }
    search->al = (cm1e_al_machine_t){.station = CM1E_SEARCH_STATION};
    search->scout.found = (cm1e_scouted_t){0};
    if (search->station == CM1E_SEARCH_STATION || search->only_looks) {
        if (search->station == CM1E_SEARCH_STATION) {
            search->crowded |= search->orphan != 0;
            search->orphan = search->place;
        }
        next_place(bus, now_ns);
    } else {
        enter(search, SEARCH_ADDRESS, now_ns);
    }
}

/** Between two datagrams a slave before this place may have come or gone: then one that runs got the address of the
 *  search, and gets its own back before anything else is written to it. */
static void take_address(cm1e_search_t *search, const cm1e_datagram_t *d, int64_t now_ns)
{
    const uint16_t before = cm1e_get_u16(d->data);
    search->returned = before;
    if (before == search->station)
        enter(search, SEARCH_ALIAS, now_ns);
    else if (before != CM1E_SEARCH_STATION)
        enter(search, SEARCH_RETURN, now_ns);
    else
        walk_again(search, now_ns);
}

/* ---- one datagram at a time -------------------------------------------------------------------------------------- */

static uint16_t address_of(const cm1e_search_t *search, cm1e_command_t command)
{
    if (command == COMMAND_BRD)
        return 0;
    return command == COMMAND_APRD || command == COMMAND_APRW ? by_place(search->place) : CM1E_SEARCH_STATION;
}

/** The datagram of a step. Zeros are written where nothing else is put in. */
static void fill(const cm1e_search_t *search, cm1e_datagram_t *d)
{
    const search_action_t *action = &actions[search->step];
    cm1e_datagram_set(d, action->command, address_of(search, action->command), action->offset, action->bytes);
    memset(d->data, 0, action->bytes);
    if (search->step == SEARCH_ADDRESS)
        cm1e_put_u16(d->data, CM1E_SEARCH_STATION);
    else if (search->step == SEARCH_RETURN)
        cm1e_put_u16(d->data, search->returned);
    else if (search->step == SEARCH_OFFER)
        d->data[0] = 1;
    else if (search->step == SEARCH_MAILBOX)
        put_mailboxes(d->data, &search->scout.found);
    else if (search->step == SEARCH_GIVE)
        cm1e_put_u16(d->data, search->candidate->facts.station);
}

/** ETG.1020 leaves open in which states a device tells its ID; all that do tell it in Pre-Operational. */
static void after_state(cm1e_bus_t *bus, int64_t now_ns)
{
    cm1e_search_t *search = &bus->search;
    const bool good = search->al.error == CM1E_OK, mailbox = search->scout.found.mailbox_out_length > 0;
    switch (search->step) {
    case SEARCH_INIT: /* a device that does not reach it is still starting up */
        enter(search, good ? SEARCH_SCOUT : SEARCH_RELEASE, now_ns);
        break;
    case SEARCH_PRE_OP:
        enter(search, good ? SEARCH_LATE_ID : SEARCH_BACK, now_ns);
        break;
    case SEARCH_LATE_ID:
        enter(search, SEARCH_BACK, now_ns);
        break;
    case SEARCH_BACK:
        decide(bus, now_ns);
        break;
    default:
        if (search->al.explicit_id == 0 && mailbox)
            enter(search, SEARCH_OFFER, now_ns);
        else
            decide(bus, now_ns);
        break;
    }
}

/** Runs a machine of several datagrams; the step after it follows when it has ended. */
static bool run_machine(cm1e_bus_t *bus, cm1e_datagram_t *d, int64_t now_ns)
{
    cm1e_search_t *search = &bus->search;
    const bool begins = !search->entered;
    search->entered = true;
    if (search->step == SEARCH_SCOUT) {
        if (begins)
            cm1e_scout_begin(&search->scout, CM1E_SEARCH_STATION, search->deadline_ns);
        if (cm1e_scout_next(&search->scout, d, now_ns))
            return true;
        if (search->scout.good && is_asked_for_id(bus))
            enter(search, SEARCH_ID, now_ns);
        else
            decide(bus, now_ns);
        return false;
    }
    if (begins && (search->step == SEARCH_ID || search->step == SEARCH_LATE_ID))
        cm1e_al_read_id(&search->al, now_ns + ID_NS);
    else if (begins)
        cm1e_al_request(&search->al, search->step == SEARCH_PRE_OP ? CM1E_AL_PRE_OP : CM1E_AL_INIT,
                        search->deadline_ns);
    if (cm1e_al_next(&search->al, d, now_ns))
        return true;
    if (cm1e_al_idle(&search->al))
        after_state(bus, now_ns);
    return false;
}

/** A machine of several datagrams repeats a question until its own deadline, which is long: the one of the SII is
 *  5 s. */
static bool is_gone(cm1e_search_t *search, const cm1e_datagram_t *d)
{
    if (d->working_counter != 0)
        search->unanswered = 0;
    else
        search->unanswered += is_machine(search->step);
    return search->unanswered >= UNANSWERED_LIMIT;
}

/** What is on the wire now is found by the next walk. */
static void give_up(cm1e_search_t *search, int64_t now_ns)
{
    search->unanswered = 0;
    walk_again(search, now_ns);
    search->due_ns = now_ns + COUNT_PACE_NS;
}

bool cm1e_search_next(cm1e_bus_t *bus, cm1e_datagram_t *d, int64_t now_ns)
{
    cm1e_search_t *search = &bus->search;
    if (!search->used || (search->step == SEARCH_PAUSE && now_ns < search->due_ns))
        return false;
    search->turn = !search->turn; /* every second look is the supervision's own */
    if (search->turn)
        return false;
    if (search->step == SEARCH_PAUSE)
        enter(search, SEARCH_COUNT, now_ns);
    if (is_machine(search->step))
        return run_machine(bus, d, now_ns);
    if (now_ns >= search->deadline_ns) { /* it is gone */
        give_up(search, now_ns);
        return false;
    }
    fill(search, d);
    return true;
}

/** The device has answered. */
static void take_answer(cm1e_bus_t *bus, const cm1e_datagram_t *d, int64_t now_ns)
{
    cm1e_search_t *search = &bus->search;
    switch (search->step) {
    case SEARCH_WALK: take_device(bus, d, now_ns); break;
    case SEARCH_ADDRESS: take_address(search, d, now_ns); break;
    case SEARCH_RETURN: walk_again(search, now_ns); break;
    case SEARCH_ALIAS:
        search->alias = cm1e_get_u16(d->data);
        enter(search, SEARCH_CLEAR, now_ns);
        break;
    case SEARCH_GIVE:
        welcome(bus, search->candidate, now_ns);
        next_place(bus, now_ns);
        break;
    case SEARCH_RELEASE: next_place(bus, now_ns); break;
    default: enter(search, actions[search->step].then, now_ns); break;
    }
}

void cm1e_search_result(cm1e_bus_t *bus, const cm1e_datagram_t *d, int64_t now_ns)
{
    cm1e_search_t *search = &bus->search;
    if (is_gone(search, d)) {
        give_up(search, now_ns);
    } else if (search->step == SEARCH_SCOUT) {
        cm1e_scout_result(&search->scout, d);
    } else if (is_machine(search->step)) {
        cm1e_al_result(&search->al, d, now_ns);
    } else if (search->step == SEARCH_COUNT) {
        if (d->working_counter >= 0)
            take_count(bus, d->working_counter, now_ns);
    } else if (d->working_counter == (search->step == SEARCH_ADDRESS ? APRW_WORKING_COUNTER : 1) ||
               (search->step == SEARCH_RELEASE && d->working_counter > 1)) { /* there were several */
        take_answer(bus, d, now_ns);
    } /* else it is repeated until the deadline */
}
