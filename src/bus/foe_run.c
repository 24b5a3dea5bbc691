/* Transfers of files that wait, and their results in words. */
#include <stdio.h>
#include <string.h>

#include "bus/bus_internal.h"
#include "bus/foe_client.h"
#include "core/text.h"

enum { PLACE_BYTES = 64 };
#define POLL_NS INT64_C(100000)
#define SILENCE_NS INT64_C(1000000000)

#define FAIL(error, ...) cm1e_diag_set(diag, error, 0, __VA_ARGS__)

/* ---- in words --------------------------------------------------------------------------------------------------- */

/** "after 100 of 2000 bytes" */
static const char *so_far(const cm1e_foe_t *foe, char text[PLACE_BYTES])
{
    if (foe->writing)
        snprintf(text, PLACE_BYTES, "after %zu of %zu bytes", foe->done, foe->size);
    else
        snprintf(text, PLACE_BYTES, "after %zu bytes", foe->done);
    return text;
}

static cm1e_error_t refused(const cm1e_foe_t *foe, const char *place, cm1e_diag_t *diag)
{
    char text[CM1E_FOE_SAID] = "";
    const unsigned code = (unsigned)foe->fault.number;
    cm1e_text_of_device(text, sizeof text, foe->fault.said, foe->fault.said_bytes);
    return cm1e_diag_set(diag, CM1E_ERROR_BUS_MAILBOX, code,
                         "Slave %u refuses the file %s: FoE error 0x%04X, %s%s%s%s.", foe->position, place, code,
                         cm1e_foe_error_text(code), text[0] ? " (\"" : "", text, text[0] ? "\")" : "");
}

/** A name that is empty or too long. */
static cm1e_error_t bad_name(const cm1e_foe_t *foe, cm1e_diag_t *diag)
{
    return FAIL(CM1E_ERROR_INVALID_ARGUMENT, "The name \"%s\" is %s: expected are 1 to %zu characters.", foe->name,
                foe->name[0] ? "too long" : "empty", cm1e_foe_room(foe->mailbox));
}

/** What the slave did wrong. */
static cm1e_error_t misbehaved(const cm1e_foe_t *foe, const char *place, cm1e_diag_t *diag)
{
    const unsigned position = foe->position, number = (unsigned)foe->fault.number;
    const unsigned expected = (unsigned)foe->fault.expected;
    switch (foe->fault.kind) {
    case FOE_NO_FOE: return FAIL(CM1E_ERROR_BUS_MAILBOX, "Slave %u refuses FoE in its mailbox.", position);
    case FOE_OTHER_ACK:
        return FAIL(CM1E_ERROR_BUS_MAILBOX, "Slave %u acknowledges packet %u of the file, packet %u was sent.",
                    position, number, expected);
    case FOE_OTHER_PACKET:
        return FAIL(CM1E_ERROR_BUS_MAILBOX, "Slave %u sends packet %u of the file, packet %u was expected.", position,
                    number, expected);
    case FOE_SAME_PACKET:
        return FAIL(CM1E_ERROR_BUS_MAILBOX, "Slave %u sends packet %u again and again.", position, number);
    default:
        return FAIL(CM1E_ERROR_BUS_MAILBOX, "Slave %u answered with FoE service %u, which is not expected, %s.",
                    position, number, place);
    }
}

cm1e_error_t cm1e_foe_explain(const cm1e_foe_t *foe, cm1e_diag_t *diag)
{
    char place[PLACE_BYTES];
    const double answer_s = (double)foe->options.answer_ns * 1e-9;
    so_far(foe, place);
    switch (foe->fault.kind) {
    case FOE_GOOD: return CM1E_OK;
    case FOE_LOST:
        return FAIL(CM1E_ERROR_BUS_LOST, "Slave %u stopped answering, %s: check its power and the cables up to it.",
                    foe->position, place);
    case FOE_SILENT:
        return FAIL(CM1E_ERROR_TIMEOUT, "Slave %u did not answer for %g s, %s.", foe->position, answer_s, place);
    case FOE_ALWAYS_BUSY:
        return FAIL(CM1E_ERROR_TIMEOUT, "Slave %u says for %g s that it is busy, %s.", foe->position, answer_s, place);
    case FOE_REFUSED: return refused(foe, place, diag);
    case FOE_TOO_LARGE:
        return FAIL(CM1E_ERROR_FULL, "The file of slave %u has more than %zu bytes.", foe->position, foe->room);
    case FOE_BROKEN_OFF: return FAIL(CM1E_ERROR_CANCELLED, "Broken off %s.", place);
    case FOE_BAD_NAME: return bad_name(foe, diag);
    case FOE_NO_FOE:
    case FOE_UNEXPECTED:
    case FOE_OTHER_ACK:
    case FOE_OTHER_PACKET:
    case FOE_SAME_PACKET: break;
    }
    return misbehaved(foe, place, diag);
}

/* ---- waiting ---------------------------------------------------------------------------------------------------- */

static int64_t now(const cm1e_foe_t *foe) { return cm1e_clock_now(foe->bus->clock); }

/** Whether the slave is still there: an answer may take long, its controller always answers. */
static bool is_there(const cm1e_foe_t *foe, int working_counter, int64_t *heard_ns)
{
    uint8_t status[2];
    if (working_counter != 1 && now(foe) - *heard_ns < SILENCE_NS)
        return true;
    if (working_counter != 1 && cm1e_soem_transfer(foe->bus->soem, COMMAND_FPRD, foe->mailbox->station, REG_AL_STATUS,
                                                   status, sizeof status) != 1)
        return false;
    *heard_ns = now(foe);
    return true;
}

static cm1e_error_t run(cm1e_foe_t *foe)
{
    cm1e_datagram_t datagram;
    int64_t heard_ns = now(foe);
    cm1e_foe_begin(foe, heard_ns);
    while (!cm1e_foe_ended(foe)) {
        if (cm1e_foe_next(foe, &datagram, now(foe))) {
            cm1e_soem_post(foe->bus->soem, &datagram, now(foe));
            if (!cm1e_soem_take(foe->bus->soem, &datagram, CM1E_FRAME_LOST_NS))
                cm1e_soem_drop(foe->bus->soem, &datagram);
            cm1e_foe_result(foe, &datagram, now(foe));
            if (!cm1e_foe_ended(foe) && !is_there(foe, datagram.working_counter, &heard_ns))
                cm1e_foe_give_up(foe, FOE_LOST);
        }
        cm1e_clock_sleep_until(foe->bus->clock, now(foe) + POLL_NS);
    }
    return cm1e_foe_explain(foe, foe->diag);
}

cm1e_error_t cm1e_foe_send(cm1e_foe_t *foe, const char *name, const uint8_t *bytes, size_t size)
{
    foe->writing = true;
    foe->name = name;
    foe->from = bytes;
    foe->size = size;
    return run(foe);
}

cm1e_error_t cm1e_foe_receive(cm1e_foe_t *foe, const char *name, uint8_t *bytes, size_t *size)
{
    foe->writing = false;
    foe->name = name;
    foe->to = bytes;
    foe->room = *size;
    const cm1e_error_t error = run(foe);
    *size = foe->done;
    return error;
}
