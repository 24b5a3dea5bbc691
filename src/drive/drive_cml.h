/**
 * @file drive_cml.h
 * CML strings to one motor behind a bridge (BR 7.2, flows of appendix 2), one after the other: controlword 0000h and
 * CML mode, the string to 0xF581 ... 0xF584, the answer from 0xF591 ... 0xF594. Its owner advances it in steps, without
 * a clock. A caller polls its request by ticket, and may stop polling at any time.
 *
 * Before a string is sent, the lines that wait in the mailbox are taken out, because they answer earlier strings. Later
 * lines that belong to another query are set aside. Both are counted and shown as strays, never as an answer. A string
 * is never sent twice, because it may move the motor.
 */
#ifndef CM1E_DRIVE_DRIVE_CML_H
#define CM1E_DRIVE_DRIVE_CML_H

#include "cm1e/cml.h"
#include "device/cml_command.h"

enum { CM1E_DRIVE_CML_QUEUE = 4 };
#define CM1E_DRIVE_LONGEST_NS (INT64_C(1000000000) * 1000000) /**< maximum of a timeout: times can be added to it */

typedef enum cm1e_drive_cml_state {
    CM1E_DRIVE_CML_FORGOTTEN = 0, /**< no such ticket, or so many came after it */
    CM1E_DRIVE_CML_WAITING,
    CM1E_DRIVE_CML_ACTIVE,
    CM1E_DRIVE_CML_DONE,
    CM1E_DRIVE_CML_ERROR,
} cm1e_drive_cml_state_t;

/** A string and how it went. */
typedef struct cm1e_drive_cml_request {
    uint32_t ticket;
    cm1e_drive_cml_state_t state;
    cm1e_error_t error;
    uint32_t abort_code;          /**< with CM1E_ERROR_SDO_ABORT */
    int64_t timeout_ns;
    unsigned lines, strays, lost; /**< lost: lines of its answer that found no room */
    bool sent;                    /**< it may have reached the motor */
    char text[CM1E_CML_BYTES + 1];
    char first[CM1E_CML_BYTES + 1]; /**< the first line of its answer; with CM1E_ERROR_CML_ANSWER the damaged one */
} cm1e_drive_cml_request_t;

typedef enum cm1e_drive_cml_phase {
    CML_IDLE = 0,
    CML_PREPARE,  /**< until mode and controlword are right */
    CML_DRAIN,    /**< takes out what waits in the mailbox */
    CML_SEND,
    CML_WAIT,     /**< before the mailbox is looked at (again) */
    CML_RECEIVE,
} cm1e_drive_cml_phase_t;

typedef struct cm1e_drive_cml {
    uint8_t channel;              /**< 1 ... 4 */
    /* private */
    uint16_t position;
    cm1e_error_t (*submit)(void *context, cm1e_sdo_t *sdo);
    void *context;
    cm1e_drive_cml_phase_t phase;
    bool submitted;
    cm1e_sdo_t sdo;
    char data[CM1E_CML_BYTES + 32];
    int64_t now_ns, due_ns, deadline_ns;
    int64_t free_ns;              /**< the next string may be sent then */
    uint32_t open;                /**< commands whose answer is missing, by bit */
    bool list, unknown;           /**< one of the commands is */
    unsigned drained;
    cm1e_cml_command_t commands[CM1E_CML_COMMANDS];
    unsigned command_count;
    uint32_t head, next;          /**< tickets: of the one under way, and of the next to come */
    cm1e_drive_cml_request_t requests[CM1E_DRIVE_CML_QUEUE];
    uint32_t lines_of;            /**< ticket that the lines below belong to */
    char lines[CM1E_CML_LINES][CM1E_CML_BYTES + 1];
    char stray[CM1E_CML_BYTES + 1];
} cm1e_drive_cml_t;

/** `submit` hands a transfer over as cm1e_sdo_submit() does. @rt init */
void cm1e_drive_cml_init(cm1e_drive_cml_t *cml, uint16_t position, uint8_t channel,
                         cm1e_error_t (*submit)(void *context, cm1e_sdo_t *sdo), void *context);
/** Puts a string behind those that wait. `timeout_ns` is the time between the string, or a line of its answer, and the
 *  next line; 0 selects 1 s, for an origin search 70 s. CM1E_ERROR_INVALID_ARGUMENT: it is negative, or above
 *  CM1E_DRIVE_LONGEST_NS. CM1E_ERROR_CML_STRING: see cm1e_cml_check(). CM1E_ERROR_FULL: four strings wait. The caller
 *  decides whether a string may move the motor. @rt cycle */
cm1e_error_t cm1e_drive_cml_send(cm1e_drive_cml_t *cml, const char *text, int64_t timeout_ns, uint32_t *ticket);
/** Makes one step. `ready`: 0x6061 shows CML, and the controlword has been 0000h for five cycles of process data. @rt
 *  cycle */
void cm1e_drive_cml_step(cm1e_drive_cml_t *cml, int64_t now_ns, bool ready);
/** The request with this ticket; NULL: it is forgotten. @rt cycle */
const cm1e_drive_cml_request_t *cm1e_drive_cml_request(const cm1e_drive_cml_t *cml, uint32_t ticket);
/** A line of its answer, 0 = first; NULL: there is none, or another string has come since (the first line is in the
 *  request). @rt cycle */
const char *cm1e_drive_cml_line(const cm1e_drive_cml_t *cml, uint32_t ticket, unsigned line);
/** Whether no string waits or is under way. @rt cycle */
static inline bool cm1e_drive_cml_idle(const cm1e_drive_cml_t *cml)
{
    return cml->phase == CML_IDLE && !cml->submitted && cml->head == cml->next;
}
/** Ends a string that waits or is under way. What was sent cannot be taken back. @rt cycle */
void cm1e_drive_cml_cancel(cm1e_drive_cml_t *cml, uint32_t ticket, cm1e_error_t error);
/** Ends all strings that wait or are under way. @rt cycle */
void cm1e_drive_cml_cancel_all(cm1e_drive_cml_t *cml, cm1e_error_t error);
/** The string that takes the torque from the motor. Returns `text`. @rt cycle */
const char *cm1e_drive_cml_motor_free(const cm1e_drive_cml_t *cml, char text[8]);

#endif
