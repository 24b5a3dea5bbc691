/**
 * @file mailbox_link.h
 * The link layer of one slave's mailbox (ETG.1000.4 section 5.6 and 6.7): hands over one message, fetches the answers,
 * one datagram at a time. A lost frame never loses or doubles a message: a write is repeated with the same counter, and
 * the repeat bit requests a read again. It knows neither CoE nor a clock; its user bounds the time.
 */
#ifndef CM1E_BUS_MAILBOX_LINK_H
#define CM1E_BUS_MAILBOX_LINK_H

#include "bus/datagram.h"

enum { CM1E_MAILBOX_HEADER = 6 };

/** Types in the mailbox header. */
enum { MAILBOX_TYPE_ERROR = 0, MAILBOX_TYPE_COE = 3, MAILBOX_TYPE_FOE = 4 };

typedef enum cm1e_mailbox_state {
    MAILBOX_IDLE = 0,
    MAILBOX_WRITE,  /**< the message goes into SM0 */
    MAILBOX_POLL,   /**< looks whether SM1 is full, and after a lost write also whether SM0 is */
    MAILBOX_READ,
    MAILBOX_REPEAT, /**< requests the answer again, because its frame was lost */
    MAILBOX_REPEAT_WAIT,
} cm1e_mailbox_state_t;

typedef struct cm1e_mailbox {
    uint16_t station;                 /**< configured station address */
    uint16_t out_start, out_length;   /**< SM0: master to slave */
    uint16_t in_start, in_length;     /**< SM1: slave to master */
    cm1e_mailbox_state_t state;
    uint8_t sent_counter;             /**< 1 ... 7, of the last message sent; 0: none yet */
    uint8_t received_counter;         /**< of the last message accepted */
    bool repeat_bit;                  /**< as last written to SM1 activate */
    bool draining;                    /**< looks until the slave has read what is in SM0 */
    bool write_lost;                  /**< it is unknown whether the message was delivered */
    unsigned suspects;                /**< number of following answers that may be repetitions */
    enum { COUNTING_UNKNOWN = 0, COUNTING, NOT_COUNTING } counting; /**< whether the slave numbers its answers */
    unsigned tries;                   /**< in the present state */
    uint16_t size;                    /**< of `message` with its header */
    uint8_t message[CM1E_DATAGRAM_MAX];
} cm1e_mailbox_t;

/** A fresh mailbox, as after the transition Init -> Pre-Operational. */
void cm1e_mailbox_reset(cm1e_mailbox_t *mailbox);
/** Room for the body of a message. */
uint16_t cm1e_mailbox_room(const cm1e_mailbox_t *mailbox);
/** Where the body of the next message is to be written before cm1e_mailbox_send(). */
uint8_t *cm1e_mailbox_body(cm1e_mailbox_t *mailbox);
/** Starts sending the message, whose body has `size` bytes; afterwards answers are fetched until
 *  cm1e_mailbox_stop(). */
void cm1e_mailbox_send(cm1e_mailbox_t *mailbox, uint8_t type, uint16_t size);
void cm1e_mailbox_stop(cm1e_mailbox_t *mailbox);
/** Fetches messages without having sent one, until cm1e_mailbox_stop(). */
void cm1e_mailbox_listen(cm1e_mailbox_t *mailbox);
/** Polls, and fetches answers, until the slave has read the message in its mailbox; otherwise a lost write of the next
 *  message could not be detected. Then cm1e_mailbox_drained() is true. */
void cm1e_mailbox_drain(cm1e_mailbox_t *mailbox);
static inline bool cm1e_mailbox_drained(const cm1e_mailbox_t *mailbox)
{
    return mailbox->state == MAILBOX_POLL && !mailbox->draining;
}
/** Whether the message is certainly in the mailbox of the slave. */
static inline bool cm1e_mailbox_delivered(const cm1e_mailbox_t *mailbox)
{
    return mailbox->state == MAILBOX_POLL && !mailbox->write_lost;
}

/** Fills a datagram that reads whether the slave has a message for us. */
void cm1e_mailbox_look(const cm1e_mailbox_t *mailbox, cm1e_datagram_t *datagram);
/** What its answer says. */
bool cm1e_mailbox_is_full(const cm1e_datagram_t *datagram);

/** Fills the datagram that is to be sent next; false: none. */
bool cm1e_mailbox_next(cm1e_mailbox_t *mailbox, cm1e_datagram_t *datagram);
/** Takes a datagram that is back (or lost). Returns true if its data is a new message, header included. */
bool cm1e_mailbox_result(cm1e_mailbox_t *mailbox, const cm1e_datagram_t *datagram);

#endif
