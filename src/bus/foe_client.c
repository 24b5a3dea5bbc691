#include "bus/foe_client.h"

#include <string.h>

#include "bus/bus_internal.h"
#include "core/bytes.h"

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
enum { FOE_HEADER = 6, AGAIN_LIMIT = 3 };
enum { FOE_ERROR_UNDEFINED = 0x8000, FOE_ERROR_DISK_FULL = 0x8003, FOE_ERROR_PACKET = 0x8005 };
#define BUSY_PAUSE_NS INT64_C(20000000)
/** Some centuries: a time limit that can be added to every time. */
#define LONGEST_NS (INT64_MAX / 4)
/** ns; for a last message, which has no answer. */
#define FAREWELL_NS INT64_C(200000000)

/* ---- the end ---------------------------------------------------------------------------------------------------- */

static void end(cm1e_foe_t *foe)
{
    cm1e_mailbox_stop(foe->mailbox);
    foe->phase = FOE_PHASE_ENDED;
}

void cm1e_foe_give_up(cm1e_foe_t *foe, cm1e_foe_fault_kind_t fault)
{
    if (foe->fault.kind == FOE_GOOD)
        foe->fault.kind = fault;
    end(foe);
}

/* ---- messages --------------------------------------------------------------------------------------------------- */

static uint8_t *start_message(cm1e_foe_t *foe, uint8_t opcode, uint32_t value)
{
    uint8_t *body = cm1e_mailbox_body(foe->mailbox);
    body[0] = opcode;
    body[1] = 0;
    cm1e_put_u32(body + 2, value);
    foe->message_bytes = FOE_HEADER;
    return body + FOE_HEADER;
}

/** Sends a last message. It has no answer, but the slave must have read it. */
static void say_farewell(cm1e_foe_t *foe, int64_t now_ns)
{
    foe->phase = FOE_PHASE_FAREWELL;
    foe->draining = false;
    foe->farewell_until_ns = now_ns + FAREWELL_NS;
    cm1e_mailbox_send(foe->mailbox, MAILBOX_TYPE_FOE, foe->message_bytes);
}

/** Ends the transfer early, and tells the slave, which would wait for the rest. */
static void end_early(cm1e_foe_t *foe, cm1e_foe_fault_kind_t fault, uint32_t number, uint32_t code, int64_t now_ns)
{
    const bool answered = fault == FOE_NO_FOE || fault == FOE_UNEXPECTED || fault == FOE_OTHER_ACK;
    if (answered && foe->number == 0)
        foe->partly = false; /* the slave has answered the request only, and has seen nothing of the file */
    foe->fault.kind = fault;
    foe->fault.number = number;
    start_message(foe, FOE_ERROR, code);
    say_farewell(foe, now_ns);
}

size_t cm1e_foe_room(const cm1e_mailbox_t *mailbox) { return (size_t)cm1e_mailbox_room(mailbox) - FOE_HEADER; }

/** Writes the request, with the name of the file behind it. */
static void put_request(cm1e_foe_t *foe)
{
    const size_t bytes = strlen(foe->name);
    memcpy(start_message(foe, foe->writing ? FOE_WRITE : FOE_READ, foe->options.password), foe->name, bytes);
    foe->message_bytes = (uint16_t)(FOE_HEADER + bytes);
    foe->partly |= foe->writing; /* from now on it is unknown what the slave has done */
}

/** Writes a packet. One that is not full ends the file, so a file of whole packets has an empty one at its end. */
static void put_packet(cm1e_foe_t *foe)
{
    const size_t room = cm1e_foe_room(foe->mailbox);
    const size_t left = foe->size - foe->done, part = left < room ? left : room;
    uint8_t *place = start_message(foe, FOE_DATA, foe->number);
    if (part > 0)
        memcpy(place, foe->from + foe->done, part);
    foe->message_bytes = (uint16_t)(FOE_HEADER + part);
    foe->last = part < room;
    foe->partly = true;
}

/** Writes the next message, or the last one again, because others may have used the mailbox meanwhile. The
 *  acknowledgement 0 stands for a request to read that the slave has had. */
static void put_message(cm1e_foe_t *foe, bool again)
{
    if (foe->number == 0 && (foe->writing || !again))
        put_request(foe);
    else if (foe->writing)
        put_packet(foe);
    else
        start_message(foe, FOE_ACK, foe->number);
}

void cm1e_foe_begin(cm1e_foe_t *foe, int64_t now_ns)
{
    foe->phase = FOE_PHASE_READY;
    foe->number = 0;
    foe->again = 0;
    foe->last = foe->partly = false;
    __atomic_store_n(&foe->done, 0, __ATOMIC_RELAXED);
    foe->fault = (cm1e_foe_fault_t){.kind = FOE_GOOD};
    if (foe->options.answer_ns <= 0)
        foe->options.answer_ns = CM1E_FOE_ANSWER_NS;
    if (foe->options.answer_ns > LONGEST_NS)
        foe->options.answer_ns = LONGEST_NS;
    foe->busy_until_ns = now_ns + foe->options.answer_ns;
    const size_t name = strlen(foe->name);
    if (name == 0 || name > cm1e_foe_room(foe->mailbox))
        cm1e_foe_give_up(foe, FOE_BAD_NAME);
}

/* ---- progress --------------------------------------------------------------------------------------------------- */

/** Reports the progress; false: the user breaks the transfer off. */
static bool goes_on(const cm1e_foe_t *foe)
{
    return !__atomic_load_n(&foe->cancel, __ATOMIC_RELAXED) &&
           (!foe->options.progress || foe->options.progress(foe->options.context, foe->done, foe->size));
}

static void count(cm1e_foe_t *foe, size_t bytes)
{
    __atomic_store_n(&foe->done, foe->done + bytes, __ATOMIC_RELAXED);
}

/** Goes on with the next message, unless the user breaks the transfer off. */
static void go_on(cm1e_foe_t *foe, int64_t now_ns)
{
    if (!goes_on(foe)) {
        end_early(foe, FOE_BROKEN_OFF, 0, FOE_ERROR_UNDEFINED, now_ns);
        return;
    }
    foe->phase = FOE_PHASE_READY;
    foe->busy_until_ns = now_ns + foe->options.answer_ns;
    cm1e_mailbox_stop(foe->mailbox);
}

/* ---- answers ---------------------------------------------------------------------------------------------------- */

/** Takes an acknowledgement of the request or of a packet. */
static void on_acknowledge(cm1e_foe_t *foe, uint32_t number, int64_t now_ns)
{
    const size_t bytes = (size_t)foe->message_bytes - FOE_HEADER;
    if (number != foe->number) {
        foe->fault.expected = foe->number;
        end_early(foe, FOE_OTHER_ACK, number, FOE_ERROR_PACKET, now_ns);
        return;
    }
    if (foe->number == 0)
        foe->partly = false; /* it has not seen any of the file */
    else
        count(foe, bytes);
    if (foe->number > 0 && foe->last) {
        (void)goes_on(foe);
        end(foe);
        return;
    }
    foe->number++;
    go_on(foe, now_ns);
}

/** Takes a packet; one that comes again is acknowledged again. */
static void on_packet(cm1e_foe_t *foe, const uint8_t *answer, size_t bytes, int64_t now_ns)
{
    const size_t full = (size_t)(foe->mailbox->in_length - CM1E_MAILBOX_HEADER - FOE_HEADER);
    const uint32_t got = cm1e_get_u32(answer + 2);
    const bool same = got == foe->number && got > 0;
    foe->fault.expected = foe->number + 1;
    if (!same && got != foe->number + 1) {
        end_early(foe, FOE_OTHER_PACKET, got, FOE_ERROR_PACKET, now_ns);
        return;
    }
    if (!same && bytes > foe->room - foe->done) {
        end_early(foe, FOE_TOO_LARGE, 0, FOE_ERROR_DISK_FULL, now_ns);
        return;
    }
    foe->again = same ? foe->again + 1 : 0;
    if (foe->again > AGAIN_LIMIT) {
        end_early(foe, FOE_SAME_PACKET, got, FOE_ERROR_PACKET, now_ns);
        return;
    }
    if (!same)
        memcpy(foe->to + foe->done, answer + FOE_HEADER, bytes);
    count(foe, same ? 0 : bytes);
    foe->number = got;
    foe->last = !same && bytes < full; /* a file that has ended gets no packet again */
    go_on(foe, now_ns);
    if (foe->last && foe->fault.kind == FOE_GOOD) {
        start_message(foe, FOE_ACK, got);
        say_farewell(foe, now_ns);
    }
}

static void on_refusal(cm1e_foe_t *foe, const uint8_t *answer, size_t length)
{
    const size_t said = length - FOE_HEADER;
    foe->fault.kind = FOE_REFUSED;
    foe->fault.number = cm1e_get_u32(answer + 2);
    foe->fault.said_bytes = said < CM1E_FOE_SAID ? said : CM1E_FOE_SAID;
    memcpy(foe->fault.said, answer + FOE_HEADER, foe->fault.said_bytes);
    if (foe->number == 0)
        foe->partly = false; /* it has refused the file */
    end(foe);
}

static void on_busy(cm1e_foe_t *foe, int64_t now_ns)
{
    if (now_ns > foe->busy_until_ns) {
        end_early(foe, FOE_ALWAYS_BUSY, 0, FOE_ERROR_UNDEFINED, now_ns);
        return;
    }
    foe->phase = FOE_PHASE_PAUSE;
    foe->resume_ns = now_ns + BUSY_PAUSE_NS;
    cm1e_mailbox_stop(foe->mailbox);
}

static void on_answer(cm1e_foe_t *foe, const uint8_t *answer, size_t length, int64_t now_ns)
{
    const uint8_t expected = foe->writing ? FOE_ACK : FOE_DATA;
    if (answer[0] == expected && length >= FOE_HEADER && foe->writing) {
        on_acknowledge(foe, cm1e_get_u32(answer + 2), now_ns);
    } else if (answer[0] == expected && length >= FOE_HEADER) {
        on_packet(foe, answer, length - FOE_HEADER, now_ns);
    } else if (answer[0] == FOE_ERROR && length >= FOE_HEADER) {
        on_refusal(foe, answer, length);
    } else if (answer[0] == FOE_BUSY) {
        on_busy(foe, now_ns);
    } else {
        end_early(foe, FOE_UNEXPECTED, answer[0], FOE_ERROR_UNDEFINED, now_ns);
    }
}

/** Takes a message of the slave. One that is no answer of FoE may be an emergency, which is kept. */
static void on_message(cm1e_foe_t *foe, const uint8_t *message, int64_t now_ns)
{
    const size_t length = cm1e_get_u16(message);
    const unsigned type = message[5] & 0x0F;
    if (length > (size_t)(foe->mailbox->in_length - CM1E_MAILBOX_HEADER))
        return;
    if (foe->slave && cm1e_coe_take_emergency(&foe->slave->coe, message))
        cm1e_bus_keep_emergency(foe->bus, foe->slave);
    if (foe->phase != FOE_PHASE_ASKED)
        return;
    if (type == MAILBOX_TYPE_FOE && length >= 2)
        on_answer(foe, message + CM1E_MAILBOX_HEADER, length, now_ns);
    else if (type == MAILBOX_TYPE_ERROR)
        end_early(foe, FOE_NO_FOE, 0, FOE_ERROR_UNDEFINED, now_ns);
}

/* ---- one datagram at a time ------------------------------------------------------------------------------------- */

/** Sends the next message, if it is time for one. */
static void send_next(cm1e_foe_t *foe, int64_t now_ns)
{
    const bool again = foe->phase == FOE_PHASE_PAUSE;
    if (again && now_ns < foe->resume_ns)
        return;
    if (__atomic_load_n(&foe->cancel, __ATOMIC_RELAXED)) {
        end_early(foe, FOE_BROKEN_OFF, 0, FOE_ERROR_UNDEFINED, now_ns);
        return;
    }
    put_message(foe, again);
    foe->phase = FOE_PHASE_ASKED;
    foe->answer_until_ns = now_ns + foe->options.answer_ns;
    cm1e_mailbox_send(foe->mailbox, MAILBOX_TYPE_FOE, foe->message_bytes);
}

static void check_time(cm1e_foe_t *foe, int64_t now_ns)
{
    if (foe->phase == FOE_PHASE_FAREWELL && now_ns >= foe->farewell_until_ns)
        end(foe);
    const bool broken_off = __atomic_load_n(&foe->cancel, __ATOMIC_RELAXED);
    if (foe->phase != FOE_PHASE_ASKED)
        return;
    if (broken_off && foe->answer_until_ns > now_ns + FAREWELL_NS)
        foe->answer_until_ns = now_ns + FAREWELL_NS; /* a slave that answers at once has the end of its message */
    if (now_ns > foe->answer_until_ns)
        end_early(foe, broken_off ? FOE_BROKEN_OFF : FOE_SILENT, 0, FOE_ERROR_UNDEFINED, now_ns);
}

bool cm1e_foe_next(cm1e_foe_t *foe, cm1e_datagram_t *datagram, int64_t now_ns)
{
    check_time(foe, now_ns);
    if (foe->phase == FOE_PHASE_READY || foe->phase == FOE_PHASE_PAUSE)
        send_next(foe, now_ns);
    return cm1e_foe_holds_mailbox(foe) && cm1e_mailbox_next(foe->mailbox, datagram);
}

void cm1e_foe_result(cm1e_foe_t *foe, const cm1e_datagram_t *datagram, int64_t now_ns)
{
    if (!cm1e_foe_holds_mailbox(foe)) /* ended while the datagram was on its way */
        return;
    if (cm1e_mailbox_result(foe->mailbox, datagram))
        on_message(foe, datagram->data, now_ns);
    if (foe->phase == FOE_PHASE_FAREWELL && foe->draining && cm1e_mailbox_drained(foe->mailbox)) {
        end(foe);
    } else if (foe->phase == FOE_PHASE_FAREWELL && !foe->draining && cm1e_mailbox_delivered(foe->mailbox)) {
        foe->draining = true;
        cm1e_mailbox_drain(foe->mailbox);
    }
}
