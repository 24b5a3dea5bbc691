/**
 * @file drive_command.h
 * CMD mode of a motor behind a bridge (BR 7.1, flows of appendix 1): 0007h for five cycles, the command for five
 * cycles, its answer in the high byte of the statusword, 0007h at the end. One command at a time; the cycle thread owns
 * it. It works in CMD only, while 0x6061 shows it; in every other mode no such word reaches the wire.
 *
 * A search moves the motor. It is ended (F607h, then F107h if that has no answer) when its time is over, when it is not
 * known to have been heard, and as soon as the bus is back after it was away.
 */
#ifndef CM1E_DRIVE_DRIVE_COMMAND_H
#define CM1E_DRIVE_DRIVE_COMMAND_H

#include <stdbool.h>
#include <stdint.h>

#include "cm1e/error.h"

struct cm1e_drive;

/** The high byte of the controlword, and of the statusword that answers it (BR 7.1.2, 7.1.3). */
typedef enum cm1e_drive_cmd {
    CM1E_DRIVE_CMD_NONE = 0,
    CM1E_DRIVE_CMD_MOTOR_FREE = 0xF1,
    CM1E_DRIVE_CMD_MOTOR_ENABLE = 0xF2,
    CM1E_DRIVE_CMD_ORIGIN_SEARCH = 0xF3,
    CM1E_DRIVE_CMD_RESET_COUNTER = 0xF4,
    CM1E_DRIVE_CMD_ORIGIN_SEARCH_ABORT = 0xF6,
} cm1e_drive_cmd_t;

typedef enum cm1e_drive_cmd_state {
    CM1E_DRIVE_CMD_IDLE = 0,        /**< none was started */
    CM1E_DRIVE_CMD_SENDING,         /**< 0007h, the command, waiting for its answer */
    CM1E_DRIVE_CMD_SEARCHING,       /**< F3: the search is under way */
    CM1E_DRIVE_CMD_DONE,            /**< answered; a search: F8, the origin is found */
    CM1E_DRIVE_CMD_NOT_SENT,        /**< "sending error": no answer in time */
    CM1E_DRIVE_CMD_SEARCH_TIME_OUT, /**< F9: the motor found no origin in its time */
    CM1E_DRIVE_CMD_GIVEN_UP,        /**< our own time for the search is over: it is being aborted */
    CM1E_DRIVE_CMD_LOST,            /**< the bus was away or CMD was left meanwhile: nobody knows */
} cm1e_drive_cmd_state_t;

/** The state of the last command. `timeout_ns` of cm1e_drive_cmd_start() is for the search alone. */
typedef struct cm1e_drive_cmd_run {
    cm1e_drive_cmd_state_t state;
    cm1e_drive_cmd_t command;       /**< what the caller started */
    /* private: drive_command.c */
    cm1e_drive_cmd_t sending;       /**< what is on the wire: the command, or what ends a search */
    uint8_t phase, cycles, before;  /**< before: high byte of the statusword ahead of the command */
    uint8_t attempts;               /**< to end a search that may be under way */
    bool ending;                    /**< `sending` is such an attempt */
    bool may_search;                /**< a search may be under way, whatever the state */
    bool ready;                     /**< 0007h is the word between commands */
    int64_t heard_ns, deadline_ns, timeout_ns, release_ns;
} cm1e_drive_cmd_run_t;

/** Starts a command. CM1E_ERROR_STATE: the motor is not in CMD; CM1E_ERROR_AXIS_OFFLINE: it does not answer;
 *  CM1E_ERROR_BUSY: another one is under way, or a search that has not ended (Motor free and Origin search abort take
 *  the place of any). `timeout_ns`: of an origin search; 0: 90 s. @rt cycle */
cm1e_error_t cm1e_drive_cmd_start(struct cm1e_drive *drive, cm1e_drive_cmd_t command, int64_t timeout_ns);
/** @rt cycle */
cm1e_drive_cmd_state_t cm1e_drive_cmd_state(const struct cm1e_drive *drive);
/** A command is on its way, or a search under way. @rt cycle */
static inline bool cm1e_drive_cmd_busy(cm1e_drive_cmd_state_t state)
{
    return state == CM1E_DRIVE_CMD_SENDING || state == CM1E_DRIVE_CMD_SEARCHING;
}
/** At the end of a run: ends a search and frees the motor (F607h, F107h); call it in every cycle until true. In other
 *  modes, and if the motor does not answer, it is true at once; never later than 2 s after the first call.
 *  @rt cycle */
bool cm1e_drive_cmd_release(struct cm1e_drive *drive);

#endif
