#include "sdo_harm.h"

#include "nic/frame.h"

enum { NOBODY = 0x0FFF };

void spoil(const harm_t *harm, uint8_t *mailbox)
{
    switch (harm->kind) {
    case ABORT:
        cm1e_put_u16(mailbox, 10);
        cm1e_put_u16(mailbox + 6, 2 << 12);
        mailbox[8] = 0x80;
        cm1e_put_u32(mailbox + SDO_DATA, ABORT_READ_ONLY);
        break;
    case OTHER_VALUE:
        mailbox[SDO_DATA] ^= 0x40;
        break;
    case STRANGER: /* answers something that nobody asked */
        mailbox[9] ^= 0x55;
        break;
    case LONG:     /* so many bytes are to come */
        mailbox[8] = 0x41;
        cm1e_put_u32(mailbox + SDO_DATA, 0x00FFFFFF);
        break;
    case GARBAGE:
        for (unsigned i = 8; i < SDO_DATA + 4; i++)
            mailbox[i] = (uint8_t)rand();
        break;
    case NO_HARM:
    case LATE:
    case HARMS:
        break;
    }
}

/** LATE: nothing can be read of the mailbox until an answer is nearly too late. */
static void hold_back(harm_t *harm, const cm1e_tap_frame_t *frame, const datagram_t *d)
{
    const uint16_t offset = cm1e_get_u16(d->header + 4);
    if (d->header[0] == 5 && offset == QUESTION_AT)
        harm->asked_ns = now_of(harm->bus);
    const bool read = d->header[0] == 4 && offset >= 0x0808;
    if (read && now_of(harm->bus) - harm->asked_ns < 900000000 && frame->direction == CM1E_TAP_SENT)
        cm1e_put_u16(d->header + 2, NOBODY);
}

static void harm_datagram(harm_t *harm, const cm1e_tap_frame_t *frame, const datagram_t *d)
{
    const uint16_t station = cm1e_get_u16(d->header + 2);
    if (harm->kind == LATE) {
        if (station == harm->station)
            hold_back(harm, frame, d);
        return;
    }
    const uint8_t *mailbox = d->data;
    const bool ours = d->data_length > SDO_DATA && (!harm->station || station == harm->station);
    const bool answer = frame->direction == CM1E_TAP_RECEIVED && d->header[0] == 4 &&
                        cm1e_get_u16(d->header + 4) == ANSWER_AT;
    if (!ours || !answer || (mailbox[5] & 0x0F) != 3 || cm1e_get_u16(mailbox + 6) >> 12 != 3)
        return;
    const unsigned number = ++harm->seen;
    const bool meant = harm->index ? harm->index == cm1e_get_u16(mailbox + 9) && harm->subindex == mailbox[11]
                                   : number == harm->at;
    if (meant)
        spoil(harm, d->data);
}

cm1e_tap_verdict_t do_harm(void *context, cm1e_tap_frame_t *frame)
{
    datagram_t d = {.more = true};
    size_t offset = FRAME_HEADER;
    while (d.more && cm1e_frame_datagram(frame->bytes, frame->length, &offset, &d))
        harm_datagram(context, frame, &d);
    return CM1E_TAP_PASS;
}

void set_harm(cm1e_bus_t *bus, harm_t *harm)
{
    harm->bus = bus;
    cm1e_nic_set_tap(cm1e_bus_nic(bus), harm->kind ? do_harm : NULL, harm);
}
