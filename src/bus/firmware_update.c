#include "bus/firmware_update.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "cm1e/sii.h"
#include "core/bytes.h"
#include "core/in_task.h"
#include "core/text.h"
#include "description/sii.h"

/*
 * Not SOEM's ecx_FOEwrite(): it loses the error code and the text of a slave, takes "busy" as the answer to the request
 * to write for a success, and sends again at once, for ever, while a slave is busy.
 */
enum { FOE_WRITE = 2, FOE_DATA = 3, FOE_ACK = 4, FOE_ERROR = 5, FOE_BUSY = 6 };
enum { FOE_HEADER = 6, FOE_ERROR_UNDEFINED = 0x8000, PROTOCOL_FOE = 0x08, TEXT_BYTES = 80 };
enum { CONTROL_MAILBOX_OUT = 0x26, CONTROL_MAILBOX_IN = 0x22, SM_ENABLED = 1, EEPROM_OF_SLAVE = 1, MAILBOX_MIN = 32 };
#define POLL_NS INT64_C(100000)
#define BUSY_PAUSE_NS INT64_C(20000000)
#define SILENCE_NS INT64_C(1000000000)
#define STATE_NS INT64_C(10000000000)
#define LEAVE_BOOTSTRAP_NS INT64_C(60000000000) /* the device may copy its memory before it answers */

typedef struct session {
    cm1e_bus_t *bus;
    uint16_t position, station;
    const cm1e_firmware_file_t *file;
    cm1e_mailbox_t mailbox;
    cm1e_datagram_t datagram;
    size_t taken;
    cm1e_firmware_state_t *state;
    cm1e_diag_t *diag;
} session_t;

#define FAIL(session, error, ...) cm1e_diag_set((session)->diag, error, 0, __VA_ARGS__)

static int64_t now(const session_t *session) { return cm1e_clock_now(session->bus->clock); }

static void pause_for(const session_t *session, int64_t time_ns)
{
    cm1e_clock_sleep_until(session->bus->clock, now(session) + time_ns);
}

static bool read_register(const session_t *session, uint16_t offset, void *data, uint16_t length)
{
    return cm1e_soem_transfer(session->bus->soem, COMMAND_FPRD, session->station, offset, data, length) == 1;
}

static bool write_register(const session_t *session, uint16_t offset, void *data, uint16_t length)
{
    return cm1e_soem_transfer(session->bus->soem, COMMAND_FPWR, session->station, offset, data, length) == 1;
}

/* ---- states ----------------------------------------------------------------------------------------------------- */

uint8_t cm1e_firmware_all_states(cm1e_bus_t *bus)
{
    uint8_t status[2] = {0};
    cm1e_bus_enter(bus);
    const int answered = cm1e_soem_transfer(bus->soem, COMMAND_BRD, 0, REG_AL_STATUS, status, sizeof status);
    return answered > 0 ? status[0] & AL_STATE_MASK : 0;
}

static cm1e_error_t lost(const session_t *session)
{
    return FAIL(session, CM1E_ERROR_BUS_LOST, "Slave %u stopped answering, after %zu of %zu bytes: check its power and "
                "the cables up to it.", session->position, session->taken, session->file->size);
}

/** Waits for a state; the request acknowledges an error of before. A slave may be away for a moment, because it starts
 *  anew: then it has no station address, and the caller scans. */
static cm1e_error_t to_state(const session_t *session, uint8_t target, int64_t timeout_ns)
{
    uint8_t request[2] = {(uint8_t)(target | AL_ERROR_FLAG), 0}, answer[6] = {0};
    const int64_t deadline_ns = now(session) + timeout_ns;
    if (!write_register(session, REG_AL_CONTROL, request, sizeof request))
        return lost(session);
    for (;;) {
        pause_for(session, 20 * POLL_NS);
        const bool answered = read_register(session, REG_AL_STATUS, answer, sizeof answer);
        const unsigned state = answer[0] & AL_STATE_MASK, code = cm1e_get_u16(answer + 4);
        if (answered && state == target && !(answer[0] & AL_ERROR_FLAG))
            return CM1E_OK;
        if (answered && answer[0] & AL_ERROR_FLAG)
            return cm1e_diag_set(session->diag, CM1E_ERROR_BUS_STATE, code,
                                 "Slave %u refuses %s: AL status 0x%04X, %s.", session->position,
                                 cm1e_al_state_text(target), code, cm1e_al_status_text((uint16_t)code));
        if (now(session) > deadline_ns)
            return answered ? FAIL(session, CM1E_ERROR_BUS_STATE, "Slave %u did not reach %s in time; it is in %s.",
                                   session->position, cm1e_al_state_text(target), cm1e_al_state_text((uint16_t)state))
                            : lost(session);
    }
}

/* ---- the mailbox of Bootstrap ----------------------------------------------------------------------------------- */

static bool is_mailbox(uint16_t start, uint16_t length)
{
    return start >= 0x1000 && length >= MAILBOX_MIN && length <= CM1E_DATAGRAM_MAX;
}

static cm1e_error_t take_mailbox(session_t *session, const uint8_t *sii)
{
    cm1e_mailbox_t *mailbox = &session->mailbox;
    const uint8_t *words = sii + CM1E_SII_BOOTSTRAP;
    if (!(cm1e_get_u16(sii + CM1E_SII_PROTOCOLS) & PROTOCOL_FOE))
        return FAIL(session, CM1E_ERROR_UNSUPPORTED, "Slave %u takes no files: its SII announces no FoE. A CM1-E does "
                    "from firmware 1.2.0 on (UG 10.1); before, ask its maker.", session->position);
    mailbox->station = session->station;
    mailbox->out_start = cm1e_get_u16(words);
    mailbox->out_length = cm1e_get_u16(words + 2);
    mailbox->in_start = cm1e_get_u16(words + 4);
    mailbox->in_length = cm1e_get_u16(words + 6);
    if (!is_mailbox(mailbox->out_start, mailbox->out_length) || !is_mailbox(mailbox->in_start, mailbox->in_length))
        return FAIL(session, CM1E_ERROR_UNSUPPORTED, "Slave %u has no Bootstrap: its SII states no mailbox for it "
                    "(words 0x14-0x17).", session->position);
    return CM1E_OK;
}

static cm1e_error_t set_sync_managers(const session_t *session)
{
    const cm1e_mailbox_t *mailbox = &session->mailbox;
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
    const bool good = write_register(session, REG_SM0 + 6, &off, 1) && write_register(session, REG_SM1 + 6, &off, 1) &&
                      write_register(session, REG_SM0, both, sizeof both) &&
                      write_register(session, REG_EEPROM_CONFIG, &eeprom, 1);
    return good ? CM1E_OK : lost(session);
}

/* ---- messages --------------------------------------------------------------------------------------------------- */

static const char *foe_text(uint32_t code)
{
    static const char *const texts[] = { /* ETG.1000.6 section 5.8, from 0x8000 on */
        "not defined", "file not found", "access denied (wrong password?)", "memory full", "illegal request",
        "wrong packet number", "the file exists already", "no user", "in Bootstrap only", "not in Bootstrap",
        "no rights", "error of the program", "wrong checksum", "not a firmware for this device", "unknown",
        "no file to read", "the header of the file is missing", "fault of the flash memory", "the file does not fit",
    };
    const uint32_t n = code - FOE_ERROR_UNDEFINED;
    return n < sizeof texts / sizeof texts[0] ? texts[n] : "unknown";
}

/** Whether the slave is still there: an answer may take long, its controller always answers. */
static bool is_there(const session_t *session, int64_t *heard_ns)
{
    uint8_t status[2];
    if (session->datagram.working_counter != 1 && now(session) - *heard_ns < SILENCE_NS)
        return true;
    if (session->datagram.working_counter != 1 && !read_register(session, REG_AL_STATUS, status, sizeof status))
        return false;
    *heard_ns = now(session);
    return true;
}

/** An answer of FoE; false: the message is something else, such as an emergency. */
static bool is_answer(const session_t *session, const uint8_t **body, size_t *length)
{
    const uint8_t *message = session->datagram.data;
    *body = message + CM1E_MAILBOX_HEADER;
    *length = cm1e_get_u16(message);
    const bool fits = *length <= (size_t)(session->mailbox.in_length - CM1E_MAILBOX_HEADER);
    return fits && *length >= 2 && (message[5] & 0x0F) == MAILBOX_TYPE_FOE;
}

static bool is_refusal(const session_t *session) { return (session->datagram.data[5] & 0x0F) == MAILBOX_TYPE_ERROR; }

/** Sends what is in the mailbox, with `size` bytes, and waits for the answer. */
static cm1e_error_t exchange(session_t *session, uint16_t size, const uint8_t **answer, size_t *length)
{
    cm1e_datagram_t *datagram = &session->datagram;
    int64_t heard_ns = now(session);
    const int64_t deadline_ns = heard_ns + session->file->answer_ns;
    cm1e_mailbox_send(&session->mailbox, MAILBOX_TYPE_FOE, size);
    while (cm1e_mailbox_next(&session->mailbox, datagram)) {
        cm1e_soem_post(session->bus->soem, datagram, now(session));
        if (!cm1e_soem_take(session->bus->soem, datagram, CM1E_FRAME_LOST_NS))
            cm1e_soem_drop(session->bus->soem, datagram);
        if (!is_there(session, &heard_ns))
            return lost(session);
        if (cm1e_mailbox_result(&session->mailbox, datagram)) {
            if (is_answer(session, answer, length))
                return CM1E_OK;
            if (is_refusal(session))
                return FAIL(session, CM1E_ERROR_BUS_MAILBOX, "Slave %u refuses FoE in its mailbox.", session->position);
        }
        if (now(session) > deadline_ns)
            return FAIL(session, CM1E_ERROR_TIMEOUT, "Slave %u did not answer for %g s, after %zu of %zu bytes.",
                        session->position, (double)session->file->answer_ns * 1e-9, session->taken,
                        session->file->size);
        pause_for(session, POLL_NS);
    }
    return FAIL(session, CM1E_ERROR_BUS_MAILBOX, "The mailbox of slave %u is not in use.", session->position);
}

static cm1e_error_t diagnose(const session_t *session, const uint8_t *answer, size_t length)
{
    char text[TEXT_BYTES] = "";
    const uint32_t code = length >= FOE_HEADER ? cm1e_get_u32(answer + 2) : 0;
    if (answer[0] != FOE_ERROR || length < FOE_HEADER)
        return FAIL(session, CM1E_ERROR_BUS_MAILBOX, "Slave %u answered with FoE service %u, which is not expected, "
                    "after %zu of %zu bytes.", session->position, answer[0], session->taken, session->file->size);
    cm1e_text_of_device(text, sizeof text, answer + FOE_HEADER, length - FOE_HEADER);
    return cm1e_diag_set(session->diag, CM1E_ERROR_BUS_MAILBOX, code,
                         "Slave %u refuses the file after %zu of %zu bytes: FoE error 0x%04X, %s%s%s%s.",
                         session->position, session->taken, session->file->size, (unsigned)code, foe_text(code),
                         text[0] ? " (\"" : "", text, text[0] ? "\")" : "");
}

/** Sends one packet until the slave acknowledges it; a busy slave is asked again. */
static cm1e_error_t send_packet(session_t *session, uint16_t size, uint32_t number)
{
    const int64_t deadline_ns = now(session) + session->file->answer_ns;
    const uint8_t *answer = NULL;
    size_t length = 0;
    for (;;) {
        const cm1e_error_t error = exchange(session, size, &answer, &length);
        if (error != CM1E_OK)
            return error;
        if (answer[0] == FOE_ACK && length >= FOE_HEADER && cm1e_get_u32(answer + 2) == number)
            return CM1E_OK;
        if (answer[0] == FOE_ACK && length >= FOE_HEADER)
            return FAIL(session, CM1E_ERROR_BUS_MAILBOX, "Slave %u acknowledges packet %u of the file, packet %u was "
                        "sent.", session->position, (unsigned)cm1e_get_u32(answer + 2), (unsigned)number);
        if (answer[0] != FOE_BUSY)
            return diagnose(session, answer, length);
        if (now(session) > deadline_ns)
            return FAIL(session, CM1E_ERROR_TIMEOUT, "Slave %u says for %g s that it is busy, after %zu of %zu bytes.",
                        session->position, (double)session->file->answer_ns * 1e-9, session->taken,
                        session->file->size);
        pause_for(session, BUSY_PAUSE_NS);
    }
}

static uint8_t *start_message(session_t *session, uint8_t opcode, uint32_t value)
{
    uint8_t *body = cm1e_mailbox_body(&session->mailbox);
    body[0] = opcode;
    body[1] = 0;
    cm1e_put_u32(body + 2, value);
    return body + FOE_HEADER;
}

/** The user breaks off: the slave is told, and does not answer. */
static cm1e_error_t break_off(session_t *session)
{
    start_message(session, FOE_ERROR, FOE_ERROR_UNDEFINED);
    cm1e_mailbox_send(&session->mailbox, MAILBOX_TYPE_FOE, FOE_HEADER);
    if (cm1e_mailbox_next(&session->mailbox, &session->datagram)) {
        cm1e_soem_post(session->bus->soem, &session->datagram, now(session));
        if (!cm1e_soem_take(session->bus->soem, &session->datagram, CM1E_FRAME_LOST_NS))
            cm1e_soem_drop(session->bus->soem, &session->datagram);
    }
    return FAIL(session, CM1E_ERROR_CANCELLED, "Broken off after %zu of %zu bytes.", session->taken,
                session->file->size);
}

static cm1e_error_t write_file(session_t *session)
{
    const cm1e_firmware_file_t *file = session->file;
    const size_t name_bytes = strlen(file->name), room = (size_t)cm1e_mailbox_room(&session->mailbox) - FOE_HEADER;
    if (name_bytes > room)
        return FAIL(session, CM1E_ERROR_INVALID_ARGUMENT, "The name \"%s\" is too long: at most %zu characters.",
                    file->name, room);
    memcpy(start_message(session, FOE_WRITE, file->password), file->name, name_bytes);
    *session->state = CM1E_FIRMWARE_PARTLY; /* from here on nobody knows what the slave has done */
    cm1e_error_t error = send_packet(session, (uint16_t)(FOE_HEADER + name_bytes), 0);
    if (error == CM1E_OK || error == CM1E_ERROR_BUS_MAILBOX) /* it has not seen any of the file, or has refused it */
        *session->state = CM1E_FIRMWARE_UNTOUCHED;
    /* A packet that is not full ends the file, so a file of whole packets has an empty one at its end. */
    bool more = true;
    for (uint32_t number = 1; error == CM1E_OK && more; number++) {
        const size_t left = file->size - session->taken, bytes = left < room ? left : room;
        if (file->progress && !file->progress(file->context, session->taken, file->size))
            return break_off(session);
        if (bytes > 0)
            memcpy(start_message(session, FOE_DATA, number), file->bytes + session->taken, bytes);
        else
            start_message(session, FOE_DATA, number);
        *session->state = CM1E_FIRMWARE_PARTLY;
        error = send_packet(session, (uint16_t)(FOE_HEADER + bytes), number);
        session->taken += error == CM1E_OK ? bytes : 0;
        more = bytes == room;
    }
    if (error == CM1E_OK && file->progress)
        file->progress(file->context, session->taken, file->size);
    return error;
}

/* ---- the update ------------------------------------------------------------------------------------------------- */

static cm1e_error_t begin(session_t *session)
{
    cm1e_bus_t *bus = session->bus;
    uint8_t *sii = malloc(CM1E_SII_IMAGE_MAX);
    size_t size = CM1E_SII_IMAGE_MAX;
    if (!sii)
        return FAIL(session, CM1E_ERROR_NO_MEMORY, "Out of memory for the SII of slave %u.", session->position);
    cm1e_error_t error = cm1e_sii_read_device(bus, session->position, sii, &size, session->diag);
    const cm1e_bus_slave_t *slave = bus->phase >= BUS_SCANNED ? cm1e_bus_at(bus, session->position) : NULL;
    session->station = slave ? slave->facts.station : cm1e_soem_address(bus->soem, session->position);
    if (error == CM1E_OK)
        error = session->station ? take_mailbox(session, sii) : lost(session);
    free(sii);
    return error;
}

cm1e_error_t cm1e_firmware_update(cm1e_bus_t *bus, uint16_t position, const cm1e_firmware_file_t *file,
                                  cm1e_firmware_state_t *state, cm1e_diag_t *diag)
{
    session_t session = {.bus = bus, .position = position, .file = file, .state = state, .diag = diag};
    *state = CM1E_FIRMWARE_UNTOUCHED;
    if (cm1e_in_task())
        return cm1e_in_task_refuse("cm1e_firmware_update()", "", diag);
    if (bus->phase < BUS_OPEN || bus->phase >= BUS_CONFIGURED || bus->remote)
        return FAIL(&session, CM1E_ERROR_STATE, "An update of the firmware needs a bus of its own, before its start.");
    cm1e_bus_enter(bus);
    cm1e_error_t error = begin(&session);
    if (error == CM1E_OK)
        error = to_state(&session, CM1E_AL_INIT, STATE_NS);
    if (error == CM1E_OK)
        error = set_sync_managers(&session);
    if (error == CM1E_OK)
        error = to_state(&session, CM1E_AL_BOOT, STATE_NS);
    if (error == CM1E_OK)
        error = write_file(&session);
    if (error == CM1E_OK) {
        *state = CM1E_FIRMWARE_WRITTEN;
        error = to_state(&session, CM1E_AL_INIT, LEAVE_BOOTSTRAP_NS);
    }
    cm1e_bus_set_phase(bus, BUS_OPEN); /* of the other slaves nothing is known any more */
    return error;
}
