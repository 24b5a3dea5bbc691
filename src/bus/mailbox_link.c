#include "bus/mailbox_link.h"

#include <string.h>

#include "core/bytes.h"

/** Polls of the sync managers before an unconfirmed message is written again: the slave may be busy reading it. */
enum { DOUBT_LOOKS = 3, REPEAT_LOOKS = 20 };
/** Possible repetitions: the repeated answer, and one that the slave returned to its queue. */
enum { SUSPECTS_AFTER_REPEAT = 2 };

/* Places in the 8 bytes of a sync manager (ETG.1000.4 table 60). */
enum { SM_STATUS = 5, SM_ACTIVATE = 6, SM_PDI_CONTROL = 7 };

static void enter(cm1e_mailbox_t *mailbox, cm1e_mailbox_state_t state)
{
    if (mailbox->state != state)
        mailbox->tries = 0;
    mailbox->state = state;
}

void cm1e_mailbox_reset(cm1e_mailbox_t *mailbox)
{
    mailbox->state = MAILBOX_IDLE;
    mailbox->sent_counter = 0;
    mailbox->received_counter = 0;
    mailbox->repeat_bit = false;
    mailbox->write_lost = mailbox->draining = false;
    mailbox->suspects = 0;
    mailbox->counting = COUNTING_UNKNOWN;
    mailbox->tries = 0;
    mailbox->size = 0;
}

uint16_t cm1e_mailbox_room(const cm1e_mailbox_t *mailbox)
{
    return mailbox->out_length > CM1E_MAILBOX_HEADER ? (uint16_t)(mailbox->out_length - CM1E_MAILBOX_HEADER) : 0;
}

uint8_t *cm1e_mailbox_body(cm1e_mailbox_t *mailbox) { return mailbox->message + CM1E_MAILBOX_HEADER; }

void cm1e_mailbox_send(cm1e_mailbox_t *mailbox, uint8_t type, uint16_t size)
{
    mailbox->sent_counter = (uint8_t)(mailbox->sent_counter % 7 + 1); /* 1 ... 7; 0 would mean: no counter */
    cm1e_put_u16(mailbox->message, size);
    cm1e_put_u16(mailbox->message + 2, 0); /* address of the master */
    mailbox->message[4] = 0;               /* channel, priority */
    mailbox->message[5] = (uint8_t)(type | mailbox->sent_counter << 4);
    mailbox->size = (uint16_t)(CM1E_MAILBOX_HEADER + size);
    mailbox->write_lost = mailbox->draining = false;
    enter(mailbox, MAILBOX_WRITE);
}

void cm1e_mailbox_drain(cm1e_mailbox_t *mailbox)
{
    mailbox->write_lost = false;
    mailbox->draining = true;
    enter(mailbox, MAILBOX_POLL);
}

void cm1e_mailbox_listen(cm1e_mailbox_t *mailbox)
{
    mailbox->write_lost = mailbox->draining = false;
    enter(mailbox, MAILBOX_POLL);
}

void cm1e_mailbox_stop(cm1e_mailbox_t *mailbox) { enter(mailbox, MAILBOX_IDLE); }

void cm1e_mailbox_look(const cm1e_mailbox_t *mailbox, cm1e_datagram_t *d)
{
    cm1e_datagram_set(d, COMMAND_FPRD, mailbox->station, REG_SM1, SYNC_MANAGER_BYTES);
}

bool cm1e_mailbox_is_full(const cm1e_datagram_t *d) { return d->data[SM_STATUS] & SM_STATUS_FULL; }

bool cm1e_mailbox_next(cm1e_mailbox_t *mailbox, cm1e_datagram_t *d)
{
    switch (mailbox->state) {
    case MAILBOX_IDLE:
        break;
    case MAILBOX_WRITE:
        /* The whole mailbox is written: its last byte is what makes it full. */
        cm1e_datagram_set(d, COMMAND_FPWR, mailbox->station, mailbox->out_start, mailbox->out_length);
        memcpy(d->data, mailbox->message, mailbox->size);
        memset(d->data + mailbox->size, 0, (size_t)(mailbox->out_length - mailbox->size));
        return true;
    case MAILBOX_POLL:
        if (mailbox->write_lost || mailbox->draining) {
            cm1e_datagram_set(d, COMMAND_FPRD, mailbox->station, REG_SM0, 2 * SYNC_MANAGER_BYTES);
            return true;
        }
        /* fall through */
    case MAILBOX_REPEAT_WAIT:
        cm1e_mailbox_look(mailbox, d);
        return true;
    case MAILBOX_READ:
        cm1e_datagram_set(d, COMMAND_FPRD, mailbox->station, mailbox->in_start, mailbox->in_length);
        return true;
    case MAILBOX_REPEAT:
        cm1e_datagram_set(d, COMMAND_FPWR, mailbox->station, REG_SM1 + SM_ACTIVATE, 1);
        d->data[0] = (uint8_t)(SM_ACTIVATE_ENABLE | (mailbox->repeat_bit ? SM_ACTIVATE_REPEAT : 0));
        return true;
    }
    return false;
}

static void after_write(cm1e_mailbox_t *mailbox, int working_counter)
{
    if (working_counter == 1) {
        mailbox->write_lost = false;
        enter(mailbox, MAILBOX_POLL);
    } else if (working_counter != 0) {
        mailbox->write_lost = true;
        enter(mailbox, MAILBOX_POLL);
    } else if (mailbox->write_lost) {
        enter(mailbox, MAILBOX_POLL); /* refused because full, perhaps with the message that is being repeated */
    }
}

/** A full SM1 does not prove that a lost write arrived: it may be an emergency, or a repeated answer. */
static void after_poll(cm1e_mailbox_t *mailbox, const cm1e_datagram_t *d)
{
    if (d->working_counter != 1)
        return;
    const bool both = mailbox->write_lost || mailbox->draining;
    const uint8_t *in = both ? d->data + SYNC_MANAGER_BYTES : d->data;
    const bool out_full = both && d->data[SM_STATUS] & SM_STATUS_FULL;
    if (out_full)
        mailbox->write_lost = false; /* the message is there, and the slave will read it */
    else
        mailbox->draining = false;
    if (in[SM_STATUS] & SM_STATUS_FULL)
        enter(mailbox, MAILBOX_READ);
    else if (mailbox->write_lost && ++mailbox->tries >= DOUBT_LOOKS)
        enter(mailbox, MAILBOX_WRITE); /* with the same counter: a slave that has had it drops the second one */
}

static bool after_read(cm1e_mailbox_t *mailbox, const cm1e_datagram_t *d)
{
    /* Lost; or not answered although SM1 was full: it is unknown whether it was emptied. */
    if (d->working_counter != 1) {
        mailbox->repeat_bit = !mailbox->repeat_bit;
        mailbox->suspects = SUSPECTS_AFTER_REPEAT;
        enter(mailbox, MAILBOX_REPEAT);
        return false;
    }
    enter(mailbox, MAILBOX_POLL);
    const uint8_t counter = d->data[5] >> 4 & 7;
    const bool same = counter && counter == mailbox->received_counter, suspected = mailbox->suspects > 0;
    mailbox->suspects -= suspected;
    /* A repetition: the lost frame had not reached the slave, or the answer was repeated twice. A slave that gives
     * every answer the same number is not judged by the number. */
    if (same && (mailbox->counting == COUNTING || (mailbox->counting == COUNTING_UNKNOWN && suspected)))
        return false;
    if (mailbox->counting == COUNTING_UNKNOWN && mailbox->received_counter)
        mailbox->counting = same ? NOT_COUNTING : COUNTING;
    mailbox->received_counter = counter;
    return true;
}

bool cm1e_mailbox_result(cm1e_mailbox_t *mailbox, const cm1e_datagram_t *d)
{
    switch (mailbox->state) {
    case MAILBOX_IDLE:
        break;
    case MAILBOX_WRITE:
        after_write(mailbox, d->working_counter);
        break;
    case MAILBOX_POLL:
        after_poll(mailbox, d);
        break;
    case MAILBOX_READ:
        return after_read(mailbox, d);
    case MAILBOX_REPEAT:
        if (d->working_counter == 1)
            enter(mailbox, MAILBOX_REPEAT_WAIT);
        break;
    case MAILBOX_REPEAT_WAIT: {
        const bool acknowledged = d->working_counter == 1 &&
                                  !(d->data[SM_PDI_CONTROL] & SM_ACTIVATE_REPEAT) == !mailbox->repeat_bit;
        /* A slave without repeat requests never acknowledges: go on polling until the time of the caller is over. */
        if (acknowledged || ++mailbox->tries >= REPEAT_LOOKS)
            enter(mailbox, MAILBOX_POLL);
        break;
    }
    }
    return false;
}
