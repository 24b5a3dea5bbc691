/**
 * @file mailbox.h
 * The slave's side of the EtherCAT mailbox (ETG.1000.4 mailbox, ETG.1000.6 5.6): takes requests out of the write
 * mailbox, gives them to the protocol's server, queues answers and emergencies, loads the read mailbox, repeats the
 * last answer on request. Private to this room.
 */
#ifndef CM1E_SIM_MAILBOX_H
#define CM1E_SIM_MAILBOX_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct cm1e_sim_slave cm1e_sim_slave_t;

enum {
    MAILBOX_HEADER = 6,
    MAILBOX_MIN_BYTES = 34,   /**< minimum size of a mailbox, as most slave stacks require */
    MAILBOX_MAX_BYTES = 1486, /**< maximum size, limited by a frame */
    MAILBOX_EMERGENCIES = 8,
    EMERGENCY_BYTES = 8,
};
enum { MAILBOX_TYPE_ERROR = 0, MAILBOX_TYPE_COE = 3, MAILBOX_TYPE_FOE = 4 };
/** Details of a mailbox error (ETG.1000.4 table 30). */
enum {
    MAILBOX_ERROR_UNSUPPORTED_PROTOCOL = 0x02, MAILBOX_ERROR_SERVICE_NOT_SUPPORTED = 0x04,
    MAILBOX_ERROR_INVALID_HEADER = 0x05, MAILBOX_ERROR_SIZE_TOO_SHORT = 0x06, MAILBOX_ERROR_INVALID_SIZE = 0x08,
};

/** A message behind its mailbox header. `length` 0: none. */
typedef struct mailbox_message {
    uint8_t type;
    uint16_t length;
    uint8_t data[MAILBOX_MAX_BYTES - MAILBOX_HEADER];
} mailbox_message_t;

typedef struct mailbox {
    bool running;              /**< from Pre-Operational on */
    int64_t request_due_ns;    /**< time at which the request in the write mailbox is processed */
    uint8_t request_counter;   /**< of the last request taken; 0: none yet */
    uint8_t answer_counter;
    mailbox_message_t answer;  /**< waits for the read mailbox */
    /* Whole mailboxes from the RAM, for repeat requests: the last loaded one, the one read before it, and one that a
     * repeated one replaced. Length 0: none. */
    uint8_t loaded;            /**< which of the two was loaded last */
    uint16_t kept_length[2], held_length;
    uint8_t kept[2][MAILBOX_MAX_BYTES];
    uint8_t held[MAILBOX_MAX_BYTES];
    uint8_t emergencies[MAILBOX_EMERGENCIES][EMERGENCY_BYTES];
    unsigned emergency_first, emergency_count;
} mailbox_t;

void cm1e_sim_mailbox_start(cm1e_sim_slave_t *slave);
void cm1e_sim_mailbox_stop(cm1e_sim_slave_t *slave);
/** Handles a write, a read or a repeat request of the master. */
void cm1e_sim_mailbox_written(cm1e_sim_slave_t *slave);
void cm1e_sim_mailbox_read(cm1e_sim_slave_t *slave);
void cm1e_sim_mailbox_repeat(cm1e_sim_slave_t *slave);
void cm1e_sim_mailbox_due(cm1e_sim_slave_t *slave);

#endif
