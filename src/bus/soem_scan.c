#include <stdlib.h>
#include <string.h>

#include "bus/eeprom_interface.h"
#include "bus/sii_fetch.h"
#include "bus/soem_private.h"
#include "core/bytes.h"
#include "core/clock.h"
#include "device/devices.h"

enum { REGISTER_TRIES = 3, FRAME_TRIES = 3 };

/** Reads a register of one slave; repeats it a few times if a frame was disturbed. */
static bool read_of(cm1e_soem_t *soem, uint16_t station, uint16_t offset, uint8_t *data, uint16_t size)
{
    int answered = 0;
    for (int try = 0; try < REGISTER_TRIES && answered != 1; try++)
        answered = ecx_FPRD(&soem->port, station, offset, size, data, EC_TIMEOUTRET3);
    return answered == 1;
}

/* ---- slaves ---------------------------------------------------------------------------------------------------- */

static void write_all(cm1e_soem_t *soem, uint16_t offset, const uint8_t *data, uint16_t size)
{
    uint8_t bytes[64];
    memcpy(bytes, data, size);
    ecx_BWR(&soem->port, 0, offset, size, bytes, EC_TIMEOUTRET3);
}

/** Resets every slave to its state after power-on, as far as the bus uses it; also slaves that another master left in
 *  operation. */
static void set_defaults(cm1e_soem_t *soem)
{
    static const uint8_t zeros[64];
    static const struct {
        uint16_t offset, size;
        uint8_t bytes[2];
    } settings[] = {
        {ECT_REG_DLALIAS, 1, {0, 0}},                            /* the configured address is used, not the alias */
        {ECT_REG_STADR, 2, {0, 0}},                              /* an old address could exist twice */
        {ECT_REG_ALCTL, 2, {EC_STATE_INIT, 0}},                  /* al_machine.c acknowledges errors */
        {ECT_REG_DLPORT, 1, {0, 0}},                             /* all ports automatic */
        {ECT_REG_IRQMASK, 2, {0x04, 0}},
        {ECT_REG_DCSYNCACT, 1, {0, 0}},                          /* no SYNC signals */
        {ECT_REG_EEPCFG, 1, {2, 0}},                             /* take the SII from the devices */
        {ECT_REG_EEPCFG, 1, {0, 0}},                             /* assign the SII to the master */
    };
    for (size_t i = 0; i < sizeof settings / sizeof settings[0]; i++)
        write_all(soem, settings[i].offset, settings[i].bytes, settings[i].size);
    write_all(soem, ECT_REG_FMMU0, zeros, EC_MAXFMMU * FMMU_BYTES);
    write_all(soem, ECT_REG_SM0, zeros, 4 * SYNC_MANAGER_BYTES);
    write_all(soem, ECT_REG_RXERR, zeros, 8);
}

/** Gives a slave its address and reads its alias. */
static bool take_address(cm1e_soem_t *soem, uint16_t position)
{
    ec_slavet *slave = &soem->slaves[position];
    const uint16_t place = (uint16_t)(1 - position), station = (uint16_t)(EC_NODEOFFSET + position);
    uint8_t bytes[4];
    slave->configadr = station;
    for (int try = 0; try < REGISTER_TRIES; try++) {
        cm1e_put_u16(bytes, station);
        ecx_APWR(&soem->port, place, ECT_REG_STADR, 2, bytes, EC_TIMEOUTRET3);
        if (!read_of(soem, station, ECT_REG_STADR, bytes, sizeof bytes) || cm1e_get_u16(bytes) != station)
            continue;
        slave->aliasadr = cm1e_get_u16(bytes + 2);
        return true;
    }
    return false;
}

/** As take_address(), for all. Returns the first slave that does not take it; 0: all do. */
static uint16_t take_addresses(cm1e_soem_t *soem, uint16_t count)
{
    cm1e_datagram_t *batch = soem->batch;
    for (uint16_t i = 0; i < count; i++) {
        cm1e_datagram_set(&batch[i], COMMAND_APWR, (uint16_t)-i, ECT_REG_STADR, 2);
        cm1e_put_u16(batch[i].data, (uint16_t)(EC_NODEOFFSET + 1 + i));
    }
    cm1e_soem_transfer_all(soem, batch, count, 1);
    for (uint16_t i = 0; i < count; i++)
        cm1e_datagram_set(&batch[i], COMMAND_FPRD, (uint16_t)(EC_NODEOFFSET + 1 + i), ECT_REG_STADR, 4);
    cm1e_soem_transfer_all(soem, batch, count, 1);
    for (uint16_t i = 0; i < count; i++) {
        ec_slavet *slave = &soem->slaves[i + 1];
        slave->configadr = (uint16_t)(EC_NODEOFFSET + 1 + i);
        slave->aliasadr = cm1e_get_u16(batch[i].data + 2);
        const bool taken = batch[i].working_counter == 1 && cm1e_get_u16(batch[i].data) == slave->configadr;
        if (!taken && !take_address(soem, (uint16_t)(i + 1)))
            return (uint16_t)(i + 1);
    }
    return 0;
}

uint16_t cm1e_soem_address(cm1e_soem_t *soem, uint16_t position)
{
    static const uint8_t none[2];
    if (position < 1 || position > CM1E_MAX_SLAVES)
        return 0;
    write_all(soem, ECT_REG_STADR, none, sizeof none); /* that of an earlier scan may be another slave's now */
    return take_address(soem, position) ? soem->slaves[position].configadr : 0;
}

/** Slaves of one kind share their signals. */
void cm1e_soem_forget_siis(cm1e_soem_t *soem)
{
    for (int i = 1; i <= CM1E_MAX_SLAVES; i++) {
        cm1e_sii_signals_t *signals = soem->siis[i].signals;
        for (int other = i; signals && other <= CM1E_MAX_SLAVES; other++)
            if (soem->siis[other].signals == signals)
                soem->siis[other].signals = NULL;
        free(signals);
    }
    memset(soem->siis, 0, sizeof soem->siis);
}

const cm1e_sii_signals_t *cm1e_soem_signals(const cm1e_soem_t *soem, uint16_t position)
{
    return soem->siis[position].signals;
}

unsigned cm1e_soem_dc_modes(const cm1e_soem_t *soem, uint16_t position, const cm1e_sii_dc_mode_t **modes)
{
    *modes = soem->siis[position].dc_modes;
    return soem->siis[position].dc_mode_count;
}

/** The categories are the same for the same product and revision: they are read once. */
static const cm1e_sii_t *same_kind_before(const cm1e_soem_t *soem, uint16_t position)
{
    const cm1e_sii_t *sii = &soem->siis[position];
    for (uint16_t i = 1; i < position; i++) {
        const cm1e_sii_t *other = &soem->siis[i];
        if (other->vendor_id == sii->vendor_id && other->product_code == sii->product_code &&
            other->revision == sii->revision)
            return other;
    }
    return NULL;
}

/** What the header says stays: the serial number, and the mailbox. */
static void copy_categories(cm1e_sii_t *to, const cm1e_sii_t *from)
{
    const cm1e_sii_t header = *to;
    *to = *from;
    to->serial_number = header.serial_number;
    to->mailbox_out_start = header.mailbox_out_start;
    to->mailbox_out_length = header.mailbox_out_length;
    to->mailbox_in_start = header.mailbox_in_start;
    to->mailbox_in_length = header.mailbox_in_length;
    to->coe = header.coe;
    to->foe = header.foe;
}

/* ---- the SII of all slaves at once ------------------------------------------------------------------------------- */

/** While no datagram can be sent: a memory that was busy gets time. */
#define FETCH_PAUSE_NS INT64_C(50000)

/** The reading of one slave. */
typedef struct reading {
    cm1e_sii_result_t result;
    bool done;
    cm1e_sii_fetch_t fetch;
} reading_t;

typedef cm1e_sii_result_t (*read_part_fn)(cm1e_sii_t *sii, reading_t *reading);

static cm1e_sii_result_t read_header(cm1e_sii_t *sii, reading_t *reading)
{
    return cm1e_sii_read_header(sii, cm1e_sii_fetched, &reading->fetch);
}

/** A motor is asked for its mapping whatever its SII says, so its process data there are not needed. */
static cm1e_sii_result_t read_categories(cm1e_sii_t *sii, reading_t *reading)
{
    const cm1e_device_t *device = cm1e_device_of_identity(sii->vendor_id, sii->product_code);
    return cm1e_sii_read_categories(sii, device && device->extra_is_error, cm1e_sii_fetched, &reading->fetch);
}

/** Goes on as far as the words are there. */
static void go_on(reading_t *reading, cm1e_sii_t *sii, read_part_fn part)
{
    if (reading->done || !cm1e_sii_fetch_idle(&reading->fetch))
        return;
    reading->result = part(sii, reading);
    reading->done = cm1e_sii_fetch_idle(&reading->fetch);
}

/** One datagram for each slave that needs one. false: all are done. */
static bool fetch_some(cm1e_soem_t *soem, reading_t *readings, unsigned count)
{
    reading_t *sent[CM1E_MAX_SLAVES];
    unsigned used = 0;
    bool done = true;
    cm1e_clock_t *clock = cm1e_clock_current();
    for (unsigned i = 0; i < count; i++) {
        done &= readings[i].done;
        if (!readings[i].done && cm1e_sii_fetch_next(&readings[i].fetch, &soem->batch[used], cm1e_clock_now(clock)))
            sent[used++] = &readings[i];
    }
    if (used == 0 && !done)
        cm1e_clock_sleep_until(clock, cm1e_clock_now(clock) + FETCH_PAUSE_NS);
    cm1e_soem_transfer_all(soem, soem->batch, used, 1);
    for (unsigned i = 0; i < used; i++)
        cm1e_sii_fetch_result(&sent[i]->fetch, &soem->batch[i], cm1e_clock_now(clock));
    return !done;
}

static void read_part(cm1e_soem_t *soem, reading_t *readings, unsigned count, read_part_fn part)
{
    do
        for (unsigned i = 0; i < count; i++)
            go_on(&readings[i], &soem->siis[i + 1], part);
    while (fetch_some(soem, readings, count));
}

static int scan_error(const reading_t *reading)
{
    switch (reading->result) {
    case SII_OK:
        return 0;
    case SII_UNREADABLE:
        return reading->fetch.lost ? SCAN_LOST : SCAN_SII_UNREADABLE;
    case SII_DAMAGED:
        return SCAN_SII_DAMAGED;
    case SII_NO_MEMORY:
        break;
    }
    return SCAN_NO_MEMORY;
}

/** Headers of all, then the categories of the first of each kind. 0, or the error of the first slave that has one. */
static int read_siis(cm1e_soem_t *soem, uint16_t count, uint16_t *position)
{
    reading_t *readings = calloc(count, sizeof *readings);
    int error = 0;
    *position = 1;
    if (!readings)
        return SCAN_NO_MEMORY;
    for (unsigned i = 0; i < count; i++)
        readings[i].fetch.station = soem->slaves[i + 1].configadr;
    read_part(soem, readings, count, read_header);
    for (unsigned i = 0; i < count; i++)
        readings[i].done = readings[i].result != SII_OK || same_kind_before(soem, (uint16_t)(i + 1));
    read_part(soem, readings, count, read_categories);
    for (unsigned i = 0; i < count && !error; i++) {
        *position = (uint16_t)(i + 1);
        error = scan_error(&readings[i]);
        const cm1e_sii_t *known = error ? NULL : same_kind_before(soem, *position);
        if (known)
            copy_categories(&soem->siis[*position], known);
    }
    free(readings);
    return error;
}

static void set_sync_manager(ec_slavet *slave, int sm, const cm1e_sii_sync_manager_t *from)
{
    slave->SM[sm].StartAddr = htoes(from->start);
    slave->SM[sm].SMlength = htoes(from->length);
    slave->SM[sm].SMflags = htoel(from->control | (uint32)from->enable << 16);
}

/** Data of a slave that SOEM's mapping needs. */
static void fill_slave(cm1e_soem_t *soem, uint16_t position)
{
    ec_slavet *slave = &soem->slaves[position];
    const cm1e_sii_t *sii = &soem->siis[position];
    for (int sm = 0; sm < sii->sync_manager_count; sm++)
        set_sync_manager(slave, sm, &sii->sync_managers[sm]);
    slave->eep_man = sii->vendor_id;
    slave->eep_id = sii->product_code;
    slave->eep_rev = sii->revision;
    slave->eep_sn = sii->serial_number;
    slave->CoEdetails = sii->complete_access ? ECT_COEDET_SDOCA : 0;
    slave->blockLRW = sii->no_lrw;
    memcpy(slave->name, sii->name, EC_MAXNAME);
    slave->mbx_l = sii->mailbox_out_length;
    if (!slave->mbx_l)
        return;
    const cm1e_sii_sync_manager_t out = {sii->mailbox_out_start, sii->mailbox_out_length, 0x26, 1, 1};
    const cm1e_sii_sync_manager_t in = {sii->mailbox_in_start, sii->mailbox_in_length, 0x22, 1, 2};
    set_sync_manager(slave, 0, &out);
    set_sync_manager(slave, 1, &in);
    slave->mbx_wo = sii->mailbox_out_start;
    slave->mbx_rl = sii->mailbox_in_length;
    slave->mbx_ro = sii->mailbox_in_start;
    slave->mbx_proto = sii->coe ? ECT_MBXPROT_COE : 0;
    for (uint8 sm = 0; sm < 4; sm++)
        slave->SMtype[sm] = (uint8)(sm + 1);
}

int cm1e_soem_scan(cm1e_soem_t *soem, uint16_t *position)
{
    uint16 type;
    *position = 0;
    soem->slave_count = 0;
    soem->port.logical = NULL; /* the image of the last start is gone */
    memset(soem->slaves, 0, sizeof soem->slaves);
    memset(soem->groups, 0, sizeof soem->groups);
    cm1e_soem_forget_siis(soem);
    const int count = ecx_BRD(&soem->port, 0, ECT_REG_TYPE, sizeof type, &type, EC_TIMEOUTSAFE);
    if (count <= 0)
        return 0;
    if (count > CM1E_MAX_SLAVES)
        return SCAN_TOO_MANY;
    set_defaults(soem);
    *position = take_addresses(soem, (uint16_t)count);
    if (*position) {
        const uint16_t place = (uint16_t)(1 - *position);
        return ecx_APRD(&soem->port, place, ECT_REG_TYPE, sizeof type, &type, EC_TIMEOUTRET3) > 0 ? SCAN_NO_ADDRESS
                                                                                               : SCAN_LOST;
    }
    const int error = read_siis(soem, (uint16_t)count, position);
    if (error)
        return error;
    for (uint16_t i = 1; i <= count; i++)
        fill_slave(soem, i);
    soem->slave_count = count;
    return count;
}

void cm1e_soem_set_count(cm1e_soem_t *soem, uint16_t count)
{
    for (uint16_t position = (uint16_t)(soem->slave_count + 1); position <= count; position++) {
        memset(&soem->slaves[position], 0, sizeof soem->slaves[position]);
        memset(&soem->siis[position], 0, sizeof soem->siis[position]);
        soem->slaves[position].configadr = (uint16)(EC_NODEOFFSET + position);
        soem->slaves[position].eep_pdi = 1; /* SOEM need not offer its EEPROM */
    }
    soem->slave_count = count;
}

void cm1e_soem_set_up_mailboxes(cm1e_soem_t *soem)
{
    cm1e_datagram_t *batch = soem->batch;
    unsigned used = 0;
    for (int i = 1; i <= soem->slave_count; i++) {
        if (!soem->slaves[i].mbx_l)
            continue;
        cm1e_datagram_set(&batch[used], COMMAND_FPWR, soem->slaves[i].configadr, ECT_REG_SM0, 2 * SYNC_MANAGER_BYTES);
        memcpy(batch[used++].data, &soem->slaves[i].SM[0], 2 * SYNC_MANAGER_BYTES);
    }
    cm1e_soem_transfer_all(soem, batch, used, FRAME_TRIES);
    for (int i = 0; i < soem->slave_count; i++) {
        soem->slaves[i + 1].eep_pdi = 1; /* SOEM need not do it */
        cm1e_datagram_set(&batch[i], COMMAND_FPWR, soem->slaves[i + 1].configadr, ECT_REG_EEPCFG, 1);
        batch[i].data[0] = CONFIG_OFFERED;
    }
    cm1e_soem_transfer_all(soem, batch, (unsigned)soem->slave_count, FRAME_TRIES);
}

void cm1e_soem_facts(const cm1e_soem_t *soem, uint16_t position, cm1e_slave_facts_t *facts)
{
    const ec_slavet *slave = &soem->slaves[position];
    const cm1e_sii_t *sii = &soem->siis[position];
    *facts = (cm1e_slave_facts_t){
        .station = slave->configadr,
        .alias = slave->aliasadr,
        .vendor_id = sii->vendor_id,
        .product_code = sii->product_code,
        .revision = sii->revision,
        .serial_number = sii->serial_number,
        .mailbox_out_start = sii->mailbox_out_start,
        .mailbox_out_length = sii->mailbox_out_length,
        .mailbox_in_start = sii->mailbox_in_start,
        .mailbox_in_length = sii->mailbox_in_length,
        .coe = sii->mailbox_out_length > 0 && sii->mailbox_in_length > 0 && sii->coe,
        .foe = sii->mailbox_out_length > 0 && sii->mailbox_in_length > 0 && sii->foe,
        .complete_access = sii->complete_access,
        .swapped = cm1e_sii_is_swapped(sii->sync_managers),
    };
    memcpy(facts->name, sii->name, sizeof facts->name);
}
