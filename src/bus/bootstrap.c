#include "bus/bootstrap.h"

#include <stdlib.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "cm1e/sii.h"
#include "core/bytes.h"
#include "description/sii_image.h"

enum { PROTOCOL_FOE = 0x08 };
enum { CONTROL_MAILBOX_OUT = 0x26, CONTROL_MAILBOX_IN = 0x22, SM_ENABLED = 1, EEPROM_OF_SLAVE = 1, MAILBOX_MIN = 32 };
enum { REGISTER_TRIES = 10, STATUS_BYTES = 6 };
#define POLL_NS INT64_C(2000000)
#define STATE_NS INT64_C(10000000000)
#define LEAVE_BOOTSTRAP_NS INT64_C(60000000000)

#define FAIL(bootstrap, error, ...) cm1e_diag_set((bootstrap)->diag, error, 0, __VA_ARGS__)

static int64_t now(const cm1e_bootstrap_t *bootstrap) { return cm1e_clock_now(bootstrap->bus->clock); }

/** Sends a datagram until it is answered. false: the slave has answered none of several frames. A repeated request does
 *  no harm here. */
static bool transfer(const cm1e_bootstrap_t *bootstrap, cm1e_command_t command, uint16_t offset, void *data,
                     uint16_t length)
{
    for (int tries = 0; tries < REGISTER_TRIES; tries++) {
        if (cm1e_soem_transfer(bootstrap->bus->soem, command, bootstrap->mailbox.station, offset, data, length) == 1)
            return true;
        cm1e_clock_sleep_until(bootstrap->bus->clock, now(bootstrap) + POLL_NS);
    }
    return false;
}

static bool write_register(const cm1e_bootstrap_t *bootstrap, uint16_t offset, void *data, uint16_t length)
{
    return transfer(bootstrap, COMMAND_FPWR, offset, data, length);
}

/** Reads AL status and its code at the place of a slave that has no station address. */
static bool read_status_at_place(const cm1e_bootstrap_t *bootstrap, uint8_t answer[STATUS_BYTES])
{
    cm1e_soem_t *soem = bootstrap->bus->soem;
    const uint16_t place = (uint16_t)(1 - bootstrap->position);
    uint8_t station[2];
    return cm1e_soem_transfer(soem, COMMAND_APRD, place, REG_STATION_ADDRESS, station, sizeof station) == 1 &&
           cm1e_get_u16(station) == 0 &&
           cm1e_soem_transfer(soem, COMMAND_APRD, place, REG_AL_STATUS, answer, STATUS_BYTES) == 1;
}

static bool read_status(const cm1e_bootstrap_t *bootstrap, uint8_t answer[STATUS_BYTES])
{
    return transfer(bootstrap, COMMAND_FPRD, REG_AL_STATUS, answer, STATUS_BYTES) ||
           (bootstrap->leaves && read_status_at_place(bootstrap, answer));
}

static cm1e_error_t lost(const cm1e_bootstrap_t *bootstrap)
{
    return FAIL(bootstrap, CM1E_ERROR_BUS_LOST, "Slave %u stopped answering: check its power and the cables up to it.",
                bootstrap->position);
}

static cm1e_error_t refused(const cm1e_bootstrap_t *bootstrap, uint8_t target, unsigned code)
{
    if (code == 0)
        return cm1e_diag_set(bootstrap->diag, CM1E_ERROR_BUS_STATE, code,
                             "Slave %u refuses %s and gives no reason: its AL status code is 0.", bootstrap->position,
                             cm1e_al_state_text(target));
    return cm1e_diag_set(bootstrap->diag, CM1E_ERROR_BUS_STATE, code, "Slave %u refuses %s: AL status 0x%04X, %s.",
                         bootstrap->position, cm1e_al_state_text(target), code, cm1e_al_status_text((uint16_t)code));
}

/** Requests a state and waits for it. The request acknowledges an earlier error, which the slave shows until it has
 *  read the request. A slave that starts anew may not hear it, and has no station address; the caller scans. */
static cm1e_error_t to_state(const cm1e_bootstrap_t *bootstrap, uint8_t target, int64_t timeout_ns)
{
    uint8_t request[2] = {(uint8_t)(target | AL_ERROR_FLAG), 0}, before[STATUS_BYTES] = {0}, answer[STATUS_BYTES] = {0};
    const int64_t deadline_ns = now(bootstrap) + timeout_ns;
    (void)read_status(bootstrap, before);
    if (!write_register(bootstrap, REG_AL_CONTROL, request, sizeof request) && !bootstrap->leaves)
        return lost(bootstrap);
    for (;;) {
        cm1e_clock_sleep_until(bootstrap->bus->clock, now(bootstrap) + POLL_NS);
        const bool answered = read_status(bootstrap, answer), late = now(bootstrap) > deadline_ns;
        const bool error = answer[0] & AL_ERROR_FLAG, earlier = memcmp(answer, before, sizeof answer) == 0;
        const unsigned state = answer[0] & AL_STATE_MASK;
        if (answered && state == target && !error)
            return CM1E_OK;
        if (answered && error && (late || !earlier))
            return refused(bootstrap, target, cm1e_get_u16(answer + 4));
        if (late)
            return answered ? FAIL(bootstrap, CM1E_ERROR_BUS_STATE, "Slave %u did not reach %s in time; it is in %s.",
                                   bootstrap->position, cm1e_al_state_text(target), cm1e_al_state_text((uint16_t)state))
                            : lost(bootstrap);
    }
}

/* ---- the mailbox of Bootstrap ----------------------------------------------------------------------------------- */

static bool is_mailbox(uint16_t start, uint16_t length)
{
    return start >= 0x1000 && length >= MAILBOX_MIN && length <= CM1E_DATAGRAM_MAX;
}

static cm1e_error_t take_mailbox(cm1e_bootstrap_t *bootstrap, const uint8_t *sii)
{
    cm1e_mailbox_t *mailbox = &bootstrap->mailbox;
    const uint8_t *words = sii + CM1E_SII_BOOTSTRAP;
    if (!(cm1e_get_u16(sii + CM1E_SII_PROTOCOLS) & PROTOCOL_FOE))
        return FAIL(bootstrap, CM1E_ERROR_UNSUPPORTED, "Slave %u takes no files: its SII announces no FoE. A CM1-E "
                    "does from firmware 1.2.0 on (UG 10.1); before, ask its maker.", bootstrap->position);
    mailbox->out_start = cm1e_get_u16(words);
    mailbox->out_length = cm1e_get_u16(words + 2);
    mailbox->in_start = cm1e_get_u16(words + 4);
    mailbox->in_length = cm1e_get_u16(words + 6);
    if (!is_mailbox(mailbox->out_start, mailbox->out_length) || !is_mailbox(mailbox->in_start, mailbox->in_length))
        return FAIL(bootstrap, CM1E_ERROR_UNSUPPORTED, "Slave %u has no Bootstrap: its SII states no mailbox for it "
                    "(words 0x14-0x17).", bootstrap->position);
    return CM1E_OK;
}

static cm1e_error_t set_sync_managers(const cm1e_bootstrap_t *bootstrap)
{
    const cm1e_mailbox_t *mailbox = &bootstrap->mailbox;
    uint8_t off = 0, both[2 * SYNC_MANAGER_BYTES] = {0}, eeprom = EEPROM_OF_SLAVE;
    cm1e_put_u16(both, mailbox->out_start);
    cm1e_put_u16(both + 2, mailbox->out_length);
    both[4] = CONTROL_MAILBOX_OUT;
    both[6] = SM_ENABLED;
    cm1e_put_u16(both + SYNC_MANAGER_BYTES, mailbox->in_start);
    cm1e_put_u16(both + SYNC_MANAGER_BYTES + 2, mailbox->in_length);
    both[SYNC_MANAGER_BYTES + 4] = CONTROL_MAILBOX_IN;
    both[SYNC_MANAGER_BYTES + 6] = SM_ENABLED;
    /* A sync manager takes a new place only while it is off. The EEPROM is part of the update. */
    const bool good = write_register(bootstrap, REG_SM0 + 6, &off, 1) &&
                      write_register(bootstrap, REG_SM1 + 6, &off, 1) &&
                      write_register(bootstrap, REG_SM0, both, sizeof both) &&
                      write_register(bootstrap, REG_EEPROM_CONFIG, &eeprom, 1);
    return good ? CM1E_OK : lost(bootstrap);
}

/* ---- in and out -------------------------------------------------------------------------------------------------- */

static cm1e_error_t find(cm1e_bootstrap_t *bootstrap)
{
    cm1e_bus_t *bus = bootstrap->bus;
    uint8_t *sii = malloc(CM1E_SII_IMAGE_MAX);
    size_t size = CM1E_SII_IMAGE_MAX;
    if (!sii)
        return FAIL(bootstrap, CM1E_ERROR_NO_MEMORY, "Out of memory for the SII of slave %u.", bootstrap->position);
    cm1e_error_t error = cm1e_sii_read_device(bus, bootstrap->position, sii, &size, bootstrap->diag);
    const cm1e_bus_slave_t *slave = bus->phase >= BUS_SCANNED ? cm1e_bus_at(bus, bootstrap->position) : NULL;
    bootstrap->mailbox.station = slave ? slave->facts.station : cm1e_soem_address(bus->soem, bootstrap->position);
    if (error == CM1E_OK)
        error = bootstrap->mailbox.station ? take_mailbox(bootstrap, sii) : lost(bootstrap);
    free(sii);
    return error;
}

cm1e_error_t cm1e_bootstrap_enter(cm1e_bootstrap_t *bootstrap)
{
    cm1e_error_t error = find(bootstrap);
    if (error == CM1E_OK)
        error = to_state(bootstrap, CM1E_AL_INIT, STATE_NS);
    if (error == CM1E_OK)
        error = set_sync_managers(bootstrap);
    return error == CM1E_OK ? to_state(bootstrap, CM1E_AL_BOOT, STATE_NS) : error;
}

cm1e_error_t cm1e_bootstrap_leave(cm1e_bootstrap_t *bootstrap)
{
    bootstrap->leaves = true;
    return to_state(bootstrap, CM1E_AL_INIT, LEAVE_BOOTSTRAP_NS);
}
