#include "bus/foe_client.h"

#include <stdio.h>
#include <string.h>

#include "core/bytes.h"
#include "core/text.h"

/*
 * Not SOEM's ecx_FOEread() and ecx_FOEwrite(): they lose the error code and the text of a slave, take "busy" as the
 * answer to the request to write for a success, send again at once, for ever, while a slave is busy, and do not know
 * busy when reading.
 *
 * A busy slave gets the last message again, after a pause: the packet of data, or the acknowledgement of the packet
 * before the one that it owes; 0 is the acknowledgement before the first packet. KickCAT's master does the same. SOES
 * refuses a request while an earlier transfer is open, so a transfer that ends early is ended in the slave, too.
 */
enum { FOE_READ = 1, FOE_WRITE, FOE_DATA, FOE_ACK, FOE_ERROR, FOE_BUSY };
enum { FOE_HEADER = 6, TEXT_BYTES = 80, PLACE_BYTES = 64 };
enum { FOE_ERROR_UNDEFINED = 0x8000, FOE_ERROR_DISK_FULL = 0x8003, FOE_ERROR_PACKET = 0x8005 };
#define POLL_NS INT64_C(100000)
#define BUSY_PAUSE_NS INT64_C(20000000)
#define SILENCE_NS INT64_C(1000000000)
/** For a last message without an answer. */
#define FAREWELL_NS INT64_C(200000000)

#define FAIL(foe, error, ...) cm1e_diag_set((foe)->diag, error, 0, __VA_ARGS__)

/* ---- time and place --------------------------------------------------------------------------------------------- */

static int64_t now(const cm1e_foe_t *foe) { return cm1e_clock_now(foe->bus->clock); }

static void pause_for(const cm1e_foe_t *foe, int64_t time_ns)
{
    cm1e_clock_sleep_until(foe->bus->clock, now(foe) + time_ns);
}

/** "after 100 of 2000 bytes" */
static const char *so_far(const cm1e_foe_t *foe, char text[PLACE_BYTES])
{
    if (foe->writing)
        snprintf(text, PLACE_BYTES, "after %zu of %zu bytes", foe->done, foe->size);
    else
        snprintf(text, PLACE_BYTES, "after %zu bytes", foe->done);
    return text;
}

static cm1e_error_t lost(const cm1e_foe_t *foe)
{
    char place[PLACE_BYTES];
    return FAIL(foe, CM1E_ERROR_BUS_LOST, "Slave %u stopped answering, %s: check its power and the cables up to it.",
                foe->position, so_far(foe, place));
}

/* ---- messages --------------------------------------------------------------------------------------------------- */

static uint8_t *start_message(cm1e_foe_t *foe, uint8_t opcode, uint32_t value)
{
    uint8_t *body = cm1e_mailbox_body(foe->mailbox);
    body[0] = opcode;
    body[1] = 0;
    cm1e_put_u32(body + 2, value);
    return body + FOE_HEADER;
}

/** Whether the slave is still there: an answer may take long, its controller always answers. */
static bool is_there(cm1e_foe_t *foe, int64_t *heard_ns)
{
    uint8_t status[2];
    if (foe->datagram.working_counter != 1 && now(foe) - *heard_ns < SILENCE_NS)
        return true;
    if (foe->datagram.working_counter != 1 &&
        cm1e_soem_transfer(foe->bus->soem, COMMAND_FPRD, foe->mailbox->station, REG_AL_STATUS, status,
                           sizeof status) != 1)
        return false;
    *heard_ns = now(foe);
    return true;
}

/** Sends and receives the next datagram of the mailbox. True: it brought a message. */
static bool step(cm1e_foe_t *foe)
{
    cm1e_soem_post(foe->bus->soem, &foe->datagram, now(foe));
    if (!cm1e_soem_take(foe->bus->soem, &foe->datagram, CM1E_FRAME_LOST_NS))
        cm1e_soem_drop(foe->bus->soem, &foe->datagram);
    return cm1e_mailbox_result(foe->mailbox, &foe->datagram);
}

/** An answer of FoE; false: the message is something else, such as an emergency, which is kept. */
static bool is_answer(cm1e_foe_t *foe, const uint8_t **body, size_t *length)
{
    const uint8_t *message = foe->datagram.data;
    *body = message + CM1E_MAILBOX_HEADER;
    *length = cm1e_get_u16(message);
    const bool fits = *length <= (size_t)(foe->mailbox->in_length - CM1E_MAILBOX_HEADER);
    if (fits && foe->slave && cm1e_coe_take_emergency(&foe->slave->coe, message))
        cm1e_bus_keep_emergency(foe->bus, foe->slave);
    return fits && *length >= 2 && (message[5] & 0x0F) == MAILBOX_TYPE_FOE;
}

static bool is_refusal(const cm1e_foe_t *foe) { return (foe->datagram.data[5] & 0x0F) == MAILBOX_TYPE_ERROR; }

/** Sends what is in the mailbox, with `size` bytes, and waits for the answer. */
static cm1e_error_t exchange(cm1e_foe_t *foe, size_t size, const uint8_t **answer, size_t *length)
{
    char place[PLACE_BYTES];
    int64_t heard_ns = now(foe);
    const int64_t deadline_ns = heard_ns + foe->options.answer_ns;
    cm1e_mailbox_send(foe->mailbox, MAILBOX_TYPE_FOE, (uint16_t)size);
    while (cm1e_mailbox_next(foe->mailbox, &foe->datagram)) {
        const bool message = step(foe);
        if (!is_there(foe, &heard_ns))
            return lost(foe);
        if (message && is_answer(foe, answer, length))
            return CM1E_OK;
        if (message && is_refusal(foe))
            return FAIL(foe, CM1E_ERROR_BUS_MAILBOX, "Slave %u refuses FoE in its mailbox.", foe->position);
        if (now(foe) > deadline_ns)
            return FAIL(foe, CM1E_ERROR_TIMEOUT, "Slave %u did not answer for %g s, %s.", foe->position,
                        (double)foe->options.answer_ns * 1e-9, so_far(foe, place));
        pause_for(foe, POLL_NS);
    }
    return FAIL(foe, CM1E_ERROR_BUS_MAILBOX, "The mailbox of slave %u is not in use.", foe->position);
}

/** Sends a message that has no answer, and waits until the slave has read it. */
static void say(cm1e_foe_t *foe, size_t size)
{
    const int64_t deadline_ns = now(foe) + FAREWELL_NS;
    bool draining = false;
    cm1e_mailbox_send(foe->mailbox, MAILBOX_TYPE_FOE, (uint16_t)size);
    while (now(foe) < deadline_ns && !(draining && cm1e_mailbox_drained(foe->mailbox)) &&
           cm1e_mailbox_next(foe->mailbox, &foe->datagram)) {
        step(foe);
        if (!draining && cm1e_mailbox_delivered(foe->mailbox)) {
            draining = true;
            cm1e_mailbox_drain(foe->mailbox);
        }
        pause_for(foe, POLL_NS);
    }
}

/** The slave must not wait for the rest. Returns `error`. */
static cm1e_error_t end_early(cm1e_foe_t *foe, cm1e_error_t error, uint32_t code)
{
    if (error != CM1E_ERROR_BUS_LOST) {
        start_message(foe, FOE_ERROR, code);
        say(foe, FOE_HEADER);
    }
    return error;
}

static cm1e_error_t diagnose(const cm1e_foe_t *foe, const uint8_t *answer, size_t length)
{
    char text[TEXT_BYTES] = "", place[PLACE_BYTES];
    const uint32_t code = length >= FOE_HEADER ? cm1e_get_u32(answer + 2) : 0;
    if (answer[0] != FOE_ERROR || length < FOE_HEADER)
        return FAIL(foe, CM1E_ERROR_BUS_MAILBOX, "Slave %u answered with FoE service %u, which is not expected, %s.",
                    foe->position, answer[0], so_far(foe, place));
    cm1e_text_of_device(text, sizeof text, answer + FOE_HEADER, length - FOE_HEADER);
    return cm1e_diag_set(foe->diag, CM1E_ERROR_BUS_MAILBOX, code,
                         "Slave %u refuses the file %s: FoE error 0x%04X, %s%s%s%s.", foe->position,
                         so_far(foe, place), (unsigned)code, cm1e_foe_error_text(code), text[0] ? " (\"" : "", text,
                         text[0] ? "\")" : "");
}

/** Sends what is in the mailbox until the slave gives another answer than "busy". An answer that nobody expects ends
 *  the transfer. */
static cm1e_error_t ask(cm1e_foe_t *foe, size_t size, uint8_t expected, const uint8_t **answer, size_t *length)
{
    char place[PLACE_BYTES];
    const int64_t deadline_ns = now(foe) + foe->options.answer_ns;
    for (;;) {
        const cm1e_error_t error = exchange(foe, size, answer, length);
        if (error != CM1E_OK)
            return end_early(foe, error, FOE_ERROR_UNDEFINED);
        if ((*answer)[0] == expected && *length >= FOE_HEADER)
            return CM1E_OK;
        if ((*answer)[0] == FOE_ERROR)
            return diagnose(foe, *answer, *length);
        if ((*answer)[0] != FOE_BUSY)
            return end_early(foe, diagnose(foe, *answer, *length), FOE_ERROR_UNDEFINED);
        if (now(foe) > deadline_ns)
            return end_early(foe, FAIL(foe, CM1E_ERROR_TIMEOUT, "Slave %u says for %g s that it is busy, %s.",
                                       foe->position, (double)foe->options.answer_ns * 1e-9, so_far(foe, place)),
                             FOE_ERROR_UNDEFINED);
        pause_for(foe, BUSY_PAUSE_NS);
        if (!foe->writing && cm1e_mailbox_body(foe->mailbox)[0] == FOE_READ) {
            start_message(foe, FOE_ACK, 0);
            size = FOE_HEADER;
        }
    }
}

/** false: the user breaks off. */
static bool goes_on(const cm1e_foe_t *foe)
{
    return !foe->options.progress || foe->options.progress(foe->options.context, foe->done, foe->size);
}

static cm1e_error_t break_off(cm1e_foe_t *foe)
{
    char place[PLACE_BYTES];
    return end_early(foe, FAIL(foe, CM1E_ERROR_CANCELLED, "Broken off %s.", so_far(foe, place)), FOE_ERROR_UNDEFINED);
}

/** The name of the file behind its request. `*size`: bytes of the message. */
static cm1e_error_t put_name(cm1e_foe_t *foe, uint8_t opcode, const char *name, size_t *size)
{
    const size_t bytes = strlen(name), room = (size_t)cm1e_mailbox_room(foe->mailbox) - FOE_HEADER;
    if (bytes == 0 || bytes > room)
        return FAIL(foe, CM1E_ERROR_INVALID_ARGUMENT, "The name \"%s\" is %s: expected are 1 to %zu characters.", name,
                    bytes ? "too long" : "empty", room);
    memcpy(start_message(foe, opcode, foe->options.password), name, bytes);
    *size = FOE_HEADER + bytes;
    return CM1E_OK;
}

/* ---- writing ---------------------------------------------------------------------------------------------------- */

/** Sends one packet until the slave acknowledges it. */
static cm1e_error_t send_packet(cm1e_foe_t *foe, size_t size, uint32_t number)
{
    const uint8_t *answer = NULL;
    size_t length = 0;
    const cm1e_error_t error = ask(foe, size, FOE_ACK, &answer, &length);
    if (error != CM1E_OK || cm1e_get_u32(answer + 2) == number)
        return error;
    FAIL(foe, CM1E_ERROR_BUS_MAILBOX, "Slave %u acknowledges packet %u of the file, packet %u was sent.", foe->position,
         (unsigned)cm1e_get_u32(answer + 2), (unsigned)number);
    return end_early(foe, CM1E_ERROR_BUS_MAILBOX, FOE_ERROR_PACKET);
}

static cm1e_error_t send_file(cm1e_foe_t *foe, const char *name, const uint8_t *bytes)
{
    const size_t room = (size_t)cm1e_mailbox_room(foe->mailbox) - FOE_HEADER;
    size_t request = 0;
    cm1e_error_t error = put_name(foe, FOE_WRITE, name, &request);
    if (error != CM1E_OK)
        return error;
    foe->partly = true; /* from here on nobody knows what the slave has done */
    error = send_packet(foe, request, 0);
    if (error == CM1E_OK || error == CM1E_ERROR_BUS_MAILBOX) /* it has not seen any of the file, or has refused it */
        foe->partly = false;
    /* A packet that is not full ends the file, so a file of whole packets has an empty one at its end. */
    bool more = true;
    for (uint32_t number = 1; error == CM1E_OK && more; number++) {
        const size_t left = foe->size - foe->done, part = left < room ? left : room;
        if (!goes_on(foe))
            return break_off(foe);
        uint8_t *place = start_message(foe, FOE_DATA, number);
        if (part > 0)
            memcpy(place, bytes + foe->done, part);
        foe->partly = true;
        error = send_packet(foe, FOE_HEADER + part, number);
        foe->done += error == CM1E_OK ? part : 0;
        more = part == room;
    }
    if (error == CM1E_OK)
        (void)goes_on(foe);
    return error;
}

cm1e_error_t cm1e_foe_send(cm1e_foe_t *foe, const char *name, const uint8_t *bytes, size_t size)
{
    foe->writing = true;
    foe->size = size;
    const cm1e_error_t error = send_file(foe, name, bytes);
    cm1e_mailbox_stop(foe->mailbox);
    return error;
}

/* ---- reading ---------------------------------------------------------------------------------------------------- */

/** Takes a packet. `*number` is that of the last one taken; one that comes again is acknowledged again. */
static cm1e_error_t take_packet(cm1e_foe_t *foe, const uint8_t *answer, size_t bytes, uint32_t *number, uint8_t *file,
                                size_t room)
{
    const uint32_t got = cm1e_get_u32(answer + 2);
    if (got == *number && got > 0)
        return CM1E_OK;
    if (got != *number + 1)
        return end_early(foe, FAIL(foe, CM1E_ERROR_BUS_MAILBOX, "Slave %u sends packet %u of the file, packet %u was "
                                   "expected.", foe->position, (unsigned)got, (unsigned)*number + 1),
                         FOE_ERROR_PACKET);
    if (bytes > room - foe->done)
        return end_early(foe, FAIL(foe, CM1E_ERROR_FULL, "The file of slave %u has more than %zu bytes.",
                                   foe->position, room), FOE_ERROR_DISK_FULL);
    memcpy(file + foe->done, answer + FOE_HEADER, bytes);
    foe->done += bytes;
    *number = got;
    return goes_on(foe) ? CM1E_OK : break_off(foe);
}

static cm1e_error_t receive_file(cm1e_foe_t *foe, const char *name, uint8_t *file, size_t room)
{
    const size_t full = (size_t)(foe->mailbox->in_length - CM1E_MAILBOX_HEADER - FOE_HEADER);
    size_t request = 0, length = 0;
    const uint8_t *answer = NULL;
    uint32_t number = 0;
    cm1e_error_t error = put_name(foe, FOE_READ, name, &request);
    for (unsigned again = 0; error == CM1E_OK; request = FOE_HEADER) {
        const uint32_t before = number;
        error = ask(foe, request, FOE_DATA, &answer, &length);
        const bool last = error == CM1E_OK && length - FOE_HEADER < full;
        if (error == CM1E_OK)
            error = take_packet(foe, answer, length - FOE_HEADER, &number, file, room);
        if (error != CM1E_OK)
            return error;
        again = number == before ? again + 1 : 0;
        if (again > 3)
            return end_early(foe, FAIL(foe, CM1E_ERROR_BUS_MAILBOX, "Slave %u sends packet %u again and again.",
                                       foe->position, (unsigned)number), FOE_ERROR_PACKET);
        start_message(foe, FOE_ACK, number);
        if (last) {
            say(foe, FOE_HEADER);
            return CM1E_OK;
        }
    }
    return error;
}

cm1e_error_t cm1e_foe_receive(cm1e_foe_t *foe, const char *name, uint8_t *bytes, size_t *size)
{
    foe->writing = false;
    const cm1e_error_t error = receive_file(foe, name, bytes, *size);
    cm1e_mailbox_stop(foe->mailbox);
    *size = foe->done;
    return error;
}
