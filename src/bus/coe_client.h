/**
 * @file coe_client.h
 * The CoE client of one slave (ETG.1000.6 section 5.6): one SDO transfer at a time, expedited, normal or segmented,
 * with or without complete access, or one request of SDO information; one datagram at a time; no clock inside, no
 * waiting. Nothing a slave sends is trusted: type, service, command, index, sub-index, toggle, fragments and every
 * length are checked before a byte is taken. If a transfer is given up while the slave may still hold it open, the
 * slave gets an SDO abort: at once, or before the next transfer if the time is over.
 */
#ifndef CM1E_BUS_COE_CLIENT_H
#define CM1E_BUS_COE_CLIENT_H

#include "bus/mailbox_link.h"
#include "cm1e/emergency.h"

typedef enum cm1e_coe_phase {
    COE_IDLE = 0,
    COE_DRAIN, /**< until the slave has read the last message of the earlier transfer */
    COE_FENCE, /**< an upload whose answer proves that no answer of an earlier transfer can follow */
    COE_UPLOAD,
    COE_UPLOAD_SEGMENT,
    COE_DOWNLOAD,
    COE_DOWNLOAD_SEGMENT,
    COE_INFORMATION,
    COE_ABORT, /**< aborts a transfer that is given up: this one, or the one before */
    COE_LISTEN, /**< takes what the slave sends without being asked */
} cm1e_coe_phase_t;

/** A transfer that was given up while the slave may still hold it open (ETG.1000.6 section 5.6.2.7). */
typedef struct cm1e_owed_abort {
    bool owed;
    uint16_t index;
    uint8_t subindex;
    uint32_t code;
} cm1e_owed_abort_t;

/** What SDO information is asked for (ETG.1000.6 table 43); the answer has the next number. */
typedef enum cm1e_info_kind { INFO_LIST = 1, INFO_OBJECT = 3, INFO_ENTRY = 5 } cm1e_info_kind_t;

/** One request of SDO information. The answer is the data behind its header, of all fragments in order. */
typedef struct cm1e_info_request {
    cm1e_info_kind_t kind;
    uint16_t index;          /**< of the object; INFO_LIST: which list */
    uint8_t subindex, values;/**< INFO_ENTRY: requested values in addition to those of every answer */
    uint8_t *answer;
    size_t size;             /**< room, then bytes */
    size_t taken;
    uint16_t fragments_left; /**< as the last fragment said */
    bool done;
    cm1e_error_t error;      /**< valid when done */
    uint32_t abort_code;     /**< valid with CM1E_ERROR_SDO_ABORT */
} cm1e_info_request_t;

typedef struct cm1e_coe_client {
    cm1e_mailbox_t mailbox;
    cm1e_sdo_t *sdo;              /**< in work; NULL: none */
    cm1e_info_request_t *info;    /**< in work in place of `sdo`; NULL: none */
    cm1e_coe_phase_t phase;
    int64_t deadline_ns;
    size_t done, total;           /**< bytes */
    bool toggle;
    bool doubtful;                /**< the last transfer was given up: its answer may still come */
    uint16_t last_index;          /**< of that transfer */
    cm1e_owed_abort_t abort;      /**< not yet delivered */
    bool abort_sent;              /**< since the last answer: a mailbox error may refer to it */
    cm1e_error_t failure;         /**< in COE_ABORT: result of this transfer; CM1E_OK: it has not begun */
    uint8_t fence;                /**< which of the fences was used last */
    uint16_t awaited_index;
    uint8_t awaited_subindex;
    unsigned discarded;           /**< messages that were not for this transfer */
    uint16_t mailbox_error;       /**< detail of the last mailbox error reply */
    uint32_t lost_frames;         /**< only grows */
    cm1e_emergency_t emergency;   /**< the last one; its number counts them */
} cm1e_coe_client_t;

/** Resets everything except the addresses, as after Init -> Pre-Operational; a running transfer ends with `error`. */
void cm1e_coe_reset(cm1e_coe_client_t *client, cm1e_error_t error);
/** Gives up the running transfer, if there is one. */
void cm1e_coe_cancel(cm1e_coe_client_t *client, cm1e_error_t error);
static inline bool cm1e_coe_idle(const cm1e_coe_client_t *client)
{
    return !client->sdo && !client->info && client->phase != COE_LISTEN;
}
/** Starts a transfer; the client must be idle. */
void cm1e_coe_begin(cm1e_coe_client_t *client, cm1e_sdo_t *sdo, int64_t now_ns);
/** Starts a request of SDO information; the client must be idle. */
void cm1e_coe_begin_info(cm1e_coe_client_t *client, cm1e_info_request_t *info, int64_t now_ns);
/** Takes a message that came while others used the mailbox. True: it was an emergency. */
bool cm1e_coe_take_emergency(cm1e_coe_client_t *client, const uint8_t *message);
/** Looks into the mailbox of the slave once, and takes the messages that are in it; the client must be idle. */
void cm1e_coe_listen(cm1e_coe_client_t *client, int64_t now_ns);
/** Fills a datagram that looks into the mailbox of the slave beside the client; false: there is no mailbox. */
bool cm1e_coe_look(const cm1e_coe_client_t *client, cm1e_datagram_t *datagram);
/** Whether such a datagram, which is back, shows a message. */
bool cm1e_coe_has_mail(const cm1e_datagram_t *datagram);
/** Takes the messages that it showed; the client must be idle. */
void cm1e_coe_fetch(cm1e_coe_client_t *client, const cm1e_datagram_t *datagram, int64_t now_ns);
/** Ends a transfer whose time is over, without another datagram: for cycles in which the client gets none. */
void cm1e_coe_expire(cm1e_coe_client_t *client, int64_t now_ns);
/** Fills the datagram to be sent next; false: none. Ends a transfer whose time is over. */
bool cm1e_coe_next(cm1e_coe_client_t *client, cm1e_datagram_t *datagram, int64_t now_ns);
/** Takes a datagram that is back or lost. */
void cm1e_coe_result(cm1e_coe_client_t *client, const cm1e_datagram_t *datagram, int64_t now_ns);

/** Ends a transfer: everything in it is written before its state (release). */
void cm1e_sdo_finish(cm1e_sdo_t *sdo, cm1e_error_t error, uint32_t abort_code);

#endif
