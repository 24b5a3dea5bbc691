#include "bus/errand.h"

#include <string.h>

#include "bus/bus_internal.h"
#include "core/bytes.h"

/* Registers, commands and status of the EEPROM interface (ETG.1000.4 section 6.4). */
enum {
    REG_EEPROM_CONTROL = 0x0502, EEPROM_READ = 0x0100, EEPROM_READS_8 = 0x0040, EEPROM_ERRORS = 0x7800,
    EEPROM_NACK = 0x2000, EEPROM_BUSY = 0x8000, STATUS_AND_DATA = 14, DATA_AT = 6,
    CONFIG_MASTER = 0, CONFIG_OFFERED = 1, CONFIG_FORCE = 2,
    TRIES = 5,
};
#define ERRAND_TIMEOUT_NS INT64_C(2000000000)

static cm1e_errand_t *present(const cm1e_bus_t *bus) { return __atomic_load_n(&bus->errands.errand, __ATOMIC_ACQUIRE); }

static cm1e_error_t check(const cm1e_bus_t *bus, const cm1e_errand_t *errand)
{
    if (__atomic_load_n(&bus->phase, __ATOMIC_SEQ_CST) < BUS_SCANNED || bus->remote)
        return CM1E_ERROR_STATE;
    const cm1e_bus_slave_t *slave = cm1e_bus_at(bus, errand->position);
    if (!slave)
        return CM1E_ERROR_INVALID_ARGUMENT;
    if (errand->kind == ERRAND_INFO)
        return slave->facts.coe ? CM1E_OK : CM1E_ERROR_UNSUPPORTED;
    const bool fits = errand->size >= 1 && errand->size <= CM1E_ERRAND_BYTES;
    const bool there = errand->kind == ERRAND_SII ? errand->size % 2 == 0
                                                  : errand->place + errand->size <= CM1E_ERRAND_REGISTERS_END;
    return fits && there ? CM1E_OK : CM1E_ERROR_INVALID_ARGUMENT;
}

cm1e_error_t cm1e_errand_submit(cm1e_bus_t *bus, cm1e_errand_t *errand)
{
    cm1e_errand_t *none = NULL, *own = errand;
    const cm1e_error_t error = check(bus, errand);
    if (error != CM1E_OK)
        return error;
    errand->begun = false;
    errand->error = CM1E_OK;
    __atomic_store_n(&errand->done, 0, __ATOMIC_RELAXED);
    if (!__atomic_compare_exchange_n(&bus->errands.errand, &none, errand, false, __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST))
        return CM1E_ERROR_BUSY;
    /* A bus that stopped meanwhile either sees the errand, or this thread sees the phase of the bus. */
    const bool stopped = __atomic_load_n(&bus->phase, __ATOMIC_SEQ_CST) < BUS_SCANNED;
    if (stopped && __atomic_compare_exchange_n(&bus->errands.errand, &own, NULL, false, __ATOMIC_SEQ_CST,
                                               __ATOMIC_SEQ_CST))
        return CM1E_ERROR_STATE;
    return CM1E_OK;
}

bool cm1e_errand_done(const cm1e_errand_t *errand) { return __atomic_load_n(&errand->done, __ATOMIC_ACQUIRE); }

/** Whether the processor of the slave had its EEPROM before the errand, and does not have it now. */
static bool owes_eeprom(const cm1e_errand_t *errand)
{
    return errand->kind == ERRAND_SII && errand->begun && errand->step >= STEP_FORCE && errand->was_offered;
}

/** Ends an errand whose place is free again. Afterwards it belongs to the thread that submitted it, and the bus does
 *  not touch it any more. */
static void give_back(cm1e_bus_t *bus, cm1e_errand_t *errand, cm1e_error_t error)
{
    if (errand->error == CM1E_OK)
        errand->error = error;
    cm1e_bus_slave_t *slave = cm1e_bus_at(bus, errand->position);
    if (slave)
        slave->eeprom_owed |= owes_eeprom(errand);
    __atomic_store_n(&errand->done, 1, __ATOMIC_RELEASE);
}

/** While the bus runs nobody else takes an errand from its place. */
static void finish(cm1e_bus_t *bus, cm1e_errand_t *errand, cm1e_error_t error)
{
    __atomic_store_n(&bus->errands.errand, NULL, __ATOMIC_SEQ_CST);
    give_back(bus, errand, error);
}

static void begin(const cm1e_bus_t *bus, cm1e_bus_slave_t *slave, cm1e_errand_t *errand, int64_t now_ns)
{
    const bool info = errand->kind == ERRAND_INFO;
    if (info && (!cm1e_coe_idle(&slave->coe) || !cm1e_mapping_idle(&slave->mapping) ||
                 cm1e_foe_job_holds(bus, slave)))
        return;
    errand->begun = true;
    errand->step = STEP_BEGIN;
    errand->taken = 0;
    errand->tries = 0;
    errand->was_offered = false;
    if (errand->kind == ERRAND_SII) {
        errand->was_offered = slave->eeprom_owed;
        slave->eeprom_owed = false;
    }
    errand->deadline_ns = now_ns + ERRAND_TIMEOUT_NS;
    if (info)
        cm1e_coe_begin_info(&slave->coe, &errand->info, now_ns); /* the errand keeps the bus awake */
}

void cm1e_errand_serve(cm1e_bus_t *bus, int64_t now_ns)
{
    cm1e_errand_t *errand = present(bus);
    if (!errand)
        return;
    cm1e_bus_slave_t *slave = cm1e_bus_at(bus, errand->position);
    if (errand->begun && errand->kind == ERRAND_INFO) {
        if (errand->info.done)
            finish(bus, errand, errand->info.error);
        return;
    }
    if (slave->owner == OWNER_ERRAND)
        return;
    if (slave->watch.lost || !cm1e_recovery_idle(&slave->recovery))
        finish(bus, errand, CM1E_ERROR_BUS_LOST);
    else if (!errand->begun)
        begin(bus, slave, errand, now_ns);
}

void cm1e_errand_cancel(cm1e_bus_t *bus)
{
    /* Taken first: a thread that has seen the end of the bus may take it back, and frees it then. */
    cm1e_errand_t *errand = __atomic_exchange_n(&bus->errands.errand, NULL, __ATOMIC_SEQ_CST);
    if (errand)
        give_back(bus, errand, CM1E_ERROR_CANCELLED);
}

/* ---- datagrams -------------------------------------------------------------------------------------------------- */

static void configure(cm1e_datagram_t *datagram, uint16_t station, uint8_t value)
{
    cm1e_datagram_set(datagram, COMMAND_FPWR, station, REG_EEPROM_CONFIG, 1);
    datagram->data[0] = value;
}

static void fill_sii(const cm1e_errand_t *errand, uint16_t station, cm1e_datagram_t *datagram)
{
    switch (errand->step) {
    case STEP_BEGIN: cm1e_datagram_set(datagram, COMMAND_FPRD, station, REG_EEPROM_CONFIG, 1); break;
    case STEP_FORCE: configure(datagram, station, CONFIG_FORCE); break; /* ends also an access that never ended */
    case STEP_OWN: configure(datagram, station, CONFIG_MASTER); break;
    case STEP_READY: cm1e_datagram_set(datagram, COMMAND_FPRD, station, REG_EEPROM_CONTROL, 2); break;
    case STEP_CLEAR:
        cm1e_datagram_set(datagram, COMMAND_FPWR, station, REG_EEPROM_CONTROL, 2);
        cm1e_put_u16(datagram->data, 0);
        break;
    case STEP_ASK:
        cm1e_datagram_set(datagram, COMMAND_FPWR, station, REG_EEPROM_CONTROL, DATA_AT);
        cm1e_put_u16(datagram->data, EEPROM_READ);
        cm1e_put_u32(datagram->data + 2, errand->place + (uint32_t)(errand->taken / 2));
        break;
    case STEP_TAKE: cm1e_datagram_set(datagram, COMMAND_FPRD, station, REG_EEPROM_CONTROL, STATUS_AND_DATA); break;
    case STEP_GIVE_BACK: configure(datagram, station, CONFIG_OFFERED); break;
    }
}

bool cm1e_errand_next(cm1e_bus_t *bus, cm1e_bus_slave_t *slave)
{
    const cm1e_errand_t *errand = present(bus);
    if (slave->eeprom_owed && !slave->watch.lost) {
        configure(&slave->datagram, slave->facts.station, CONFIG_OFFERED);
        return true;
    }
    if (!errand || !errand->begun || errand->kind == ERRAND_INFO || cm1e_bus_at(bus, errand->position) != slave)
        return false;
    if (errand->kind == ERRAND_SII)
        /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): the slave is one of the bus */
        fill_sii(errand, slave->facts.station, &slave->datagram);
    else
        /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): the slave is one of the bus */
        cm1e_datagram_set(&slave->datagram, COMMAND_FPRD, slave->facts.station, (uint16_t)errand->place,
                          (uint16_t)errand->size);
    return true;
}

/* ---- answers ---------------------------------------------------------------------------------------------------- */

/** Ends an errand on the EEPROM. The EEPROM goes back to the processor of the slave, if that had it before. */
static void end_sii(cm1e_bus_t *bus, cm1e_errand_t *errand, cm1e_error_t error)
{
    const bool taken = errand->step != STEP_GIVE_BACK && owes_eeprom(errand);
    errand->tries = 0;
    if (errand->error == CM1E_OK)
        errand->error = error;
    if (taken)
        errand->step = STEP_GIVE_BACK;
    else
        finish(bus, errand, error);
}

static void take_group(cm1e_bus_t *bus, cm1e_errand_t *errand, const uint8_t *answer)
{
    const uint16_t status = cm1e_get_u16(answer);
    const size_t group = status & EEPROM_READS_8 ? 8 : 4, left = errand->size - errand->taken;
    const size_t bytes = left < group ? left : group;
    if (status & EEPROM_BUSY)
        return;
    errand->step = STEP_READY;
    if (status & EEPROM_NACK) { /* the memory itself was busy */
        if (++errand->tries >= TRIES)
            end_sii(bus, errand, CM1E_ERROR_TIMEOUT);
        return;
    }
    memcpy(errand->data + errand->taken, answer + DATA_AT, bytes);
    errand->taken += bytes;
    errand->step = STEP_ASK;
    errand->tries = 0;
    if (errand->taken == errand->size)
        end_sii(bus, errand, CM1E_OK);
}

static void take_sii(cm1e_bus_t *bus, cm1e_errand_t *errand, const uint8_t *answer)
{
    const uint16_t status = cm1e_get_u16(answer);
    switch (errand->step) {
    case STEP_BEGIN:
        errand->was_offered |= answer[0] & CONFIG_OFFERED;
        errand->step = STEP_FORCE;
        break;
    case STEP_FORCE: errand->step = STEP_OWN; break;
    case STEP_OWN: errand->step = STEP_READY; break;
    case STEP_READY:
        if (!(status & EEPROM_BUSY))
            errand->step = status & EEPROM_ERRORS ? STEP_CLEAR : STEP_ASK;
        break;
    case STEP_CLEAR: errand->step = STEP_ASK; break;
    case STEP_ASK: errand->step = STEP_TAKE; break;
    case STEP_TAKE: take_group(bus, errand, answer); break;
    case STEP_GIVE_BACK:
        errand->was_offered = false; /* done */
        finish(bus, errand, CM1E_OK);
        break;
    }
}

void cm1e_errand_result(cm1e_bus_t *bus, cm1e_bus_slave_t *slave, int64_t now_ns)
{
    cm1e_errand_t *errand = present(bus);
    const cm1e_datagram_t *datagram = &slave->datagram;
    if (slave->eeprom_owed) { /* repeated until it is answered */
        slave->eeprom_owed = datagram->working_counter != 1;
        return;
    }
    if (!errand || cm1e_bus_at(bus, errand->position) != slave)
        return;
    /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): the slave is one of the bus */
    const bool answered = datagram->working_counter == 1;
    if (!answered && ++errand->tries >= TRIES) {
        end_sii(bus, errand, CM1E_ERROR_BUS_LOST);
    } else if (!answered) {
        if (errand->step == STEP_ASK) /* perhaps accepted: a busy interface ignores another request */
            errand->step = STEP_READY;
    } else if (errand->kind == ERRAND_REGISTERS) {
        memcpy(errand->data, datagram->data, errand->size);
        finish(bus, errand, CM1E_OK);
    } else {
        take_sii(bus, errand, datagram->data);
        errand = present(bus); /* perhaps another one, which has just come */
        if (errand && errand->begun && errand->step != STEP_GIVE_BACK && now_ns > errand->deadline_ns)
            end_sii(bus, errand, CM1E_ERROR_TIMEOUT);
    }
}
