/**
 * @file foe_client.h
 * One transfer of a file over the mailbox of a slave (FoE, ETG.1000.6 section 5.8): a state machine that fills one
 * datagram at a time and judges its answer, without waiting and without a text. cm1e_foe_send() and cm1e_foe_receive()
 * run it for code that owns a bus whose cycle does not run; foe_job.h runs it beside the process data.
 */
#ifndef CM1E_BUS_FOE_CLIENT_H
#define CM1E_BUS_FOE_CLIENT_H

#include "bus/mailbox_link.h"
#include "cm1e/foe.h"

typedef struct cm1e_bus_slave cm1e_bus_slave_t;

/** The default of `answer_ns` of cm1e_foe_options_t. */
#define CM1E_FOE_ANSWER_NS INT64_C(5000000000)

/** What ended a transfer early. */
typedef enum cm1e_foe_fault_kind {
    FOE_GOOD = 0,
    FOE_LOST,         /**< the slave stopped answering */
    FOE_NO_FOE,       /**< its mailbox refuses FoE */
    FOE_SILENT,       /**< no answer in time */
    FOE_UNEXPECTED,   /**< `number`: the service that it answered with */
    FOE_REFUSED,      /**< `number`: its error code, `said`: its text */
    FOE_ALWAYS_BUSY,
    FOE_OTHER_ACK,    /**< it acknowledges packet `number`, and not `expected` */
    FOE_OTHER_PACKET, /**< it sends packet `number`, and not `expected` */
    FOE_SAME_PACKET,  /**< it sends packet `number` again and again */
    FOE_TOO_LARGE,    /**< the file has more than `room` bytes */
    FOE_BROKEN_OFF,
    FOE_BAD_NAME,
} cm1e_foe_fault_kind_t;

enum { CM1E_FOE_SAID = 80 };
typedef struct cm1e_foe_fault {
    cm1e_foe_fault_kind_t kind;
    uint32_t number, expected;
    uint8_t said[CM1E_FOE_SAID]; /**< as the slave sent it */
    size_t said_bytes;
} cm1e_foe_fault_t;

typedef enum cm1e_foe_phase {
    FOE_PHASE_READY = 0, /**< the next message may be sent */
    FOE_PHASE_ASKED,     /**< the slave owes an answer */
    FOE_PHASE_PAUSE,     /**< it is busy: the last message goes again */
    FOE_PHASE_FAREWELL,  /**< a last message that has no answer */
    FOE_PHASE_ENDED,
} cm1e_foe_phase_t;

typedef struct cm1e_foe {
    cm1e_bus_t *bus;             /**< and position: of the waiting functions, and for texts */
    uint16_t position;
    cm1e_mailbox_t *mailbox;     /**< with its addresses */
    cm1e_bus_slave_t *slave;     /**< takes emergencies that come meanwhile; NULL: it sends none in this state */
    cm1e_foe_options_t options;
    cm1e_diag_t *diag;           /**< of the waiting functions */

    bool writing;
    const char *name;
    const uint8_t *from;         /**< writing */
    uint8_t *to;                 /**< reading */
    size_t room;                 /**< in `to` */
    bool partly;                 /**< of a file that is written, the slave may have taken a part */
    size_t done;                 /**< bytes; atomic: others may look */
    size_t size;                 /**< bytes; 0: not known */
    uint32_t cancel;             /**< atomic; another thread wants the transfer to end */

    bool begun;                  /**< foe_job.c: the cycle has it */
    bool yielded;                /**< foe_job.c: the CoE client has had its turn since the last message */
    uint32_t given_back;         /**< foe_job.c: atomic; it is done */

    cm1e_foe_phase_t phase;      /**< the rest belongs to the machine */
    uint16_t message_bytes;      /**< of the body that is in the mailbox */
    uint32_t number;             /**< of the packet that was sent, or taken, last */
    unsigned again;              /**< times in a row that the same packet came */
    bool last;                   /**< the packet in the mailbox, or the one taken, ends the file */
    bool draining;
    int64_t answer_until_ns, busy_until_ns, farewell_until_ns, resume_ns;
    cm1e_foe_fault_t fault;
} cm1e_foe_t;

/** CM1E_ERROR_UNSUPPORTED: the slave has no FoE, or no mailbox for it. */
cm1e_error_t cm1e_foe_check_mailbox(const cm1e_bus_slave_t *slave, cm1e_diag_t *diag);
/** Bytes of a packet, and the longest name. */
size_t cm1e_foe_room(const cm1e_mailbox_t *mailbox);
/** Begins; the members up to `room`, and `size` of a file that is written, are given. */
void cm1e_foe_begin(cm1e_foe_t *foe, int64_t now_ns);
static inline bool cm1e_foe_ended(const cm1e_foe_t *foe) { return foe->phase == FOE_PHASE_ENDED; }
/** Between two messages nobody needs the mailbox: other protocols may use it. */
static inline bool cm1e_foe_holds_mailbox(const cm1e_foe_t *foe)
{
    return foe->phase == FOE_PHASE_ASKED || foe->phase == FOE_PHASE_FAREWELL;
}
/** Fills the datagram that is to be sent next; false: none now. */
bool cm1e_foe_next(cm1e_foe_t *foe, cm1e_datagram_t *datagram, int64_t now_ns);
/** Takes a datagram that is back, or lost. */
void cm1e_foe_result(cm1e_foe_t *foe, const cm1e_datagram_t *datagram, int64_t now_ns);
/** Ends it without another message: the slave is gone. */
void cm1e_foe_give_up(cm1e_foe_t *foe, cm1e_foe_fault_kind_t fault);
/** The result of a transfer that has ended, in words. */
cm1e_error_t cm1e_foe_explain(const cm1e_foe_t *foe, cm1e_diag_t *diag);

/** These wait. */
cm1e_error_t cm1e_foe_send(cm1e_foe_t *foe, const char *name, const uint8_t *bytes, size_t size);
cm1e_error_t cm1e_foe_receive(cm1e_foe_t *foe, const char *name, uint8_t *bytes, size_t *size);

#endif
