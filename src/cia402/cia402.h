/**
 * @file cia402.h
 * The tables of CiA 402 (IEC 61800-7-201): states of the finite state automaton, transitions, controlword and
 * statusword bits, modes of operation. Lookup only; @rt cycle throughout.
 */
#ifndef CM1E_CIA402_CIA402_H
#define CM1E_CIA402_CIA402_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum cm1e_fsa_state {
    NOT_READY_TO_SWITCH_ON = 0,
    SWITCH_ON_DISABLED,
    READY_TO_SWITCH_ON,
    SWITCHED_ON,
    OPERATION_ENABLED,
    QUICK_STOP_ACTIVE,
    FAULT_REACTION_ACTIVE,
    FAULT,
    CM1E_FSA_STATE_COUNT,
    CM1E_FSA_UNKNOWN = CM1E_FSA_STATE_COUNT, /**< a statusword that matches no row */
} cm1e_fsa_state_t;

/** One row of the state table: the statusword AND mask equals value. */
typedef struct cm1e_fsa_row {
    cm1e_fsa_state_t state;
    uint16_t mask, value;
    const char *name; /**< "Operation enabled" */
} cm1e_fsa_row_t;

/** CM1-E: UG 6.1.3. */
extern const cm1e_fsa_row_t cm1e_fsa_table[CM1E_FSA_STATE_COUNT];
/** A drive that keeps to the standard: the states of CiA 402 with quick stop. */
extern const cm1e_fsa_row_t cm1e_fsa_cia402_table[CM1E_FSA_STATE_COUNT];
/** Motor behind a Cool MUSCLE Bridge: BR 6.1.3. */
extern const cm1e_fsa_row_t cm1e_fsa_bridge_table[CM1E_FSA_STATE_COUNT];
/** Motor behind a Cool MUSCLE Bridge in CPIO, where the statusword has only its lower four bits, and 1100b in front:
 *  BR 7.1.3. */
extern const cm1e_fsa_row_t cm1e_fsa_cpio_table[CM1E_FSA_STATE_COUNT];
cm1e_fsa_state_t cm1e_fsa_decode_by(const cm1e_fsa_row_t *table, uint16_t statusword);
/** By the table of the CM1-E. */
cm1e_fsa_state_t cm1e_fsa_decode(uint16_t statusword);
const char *cm1e_fsa_name(cm1e_fsa_state_t state);

enum {
    CONTROLWORD_SWITCH_ON = 0x0001, CONTROLWORD_ENABLE_VOLTAGE = 0x0002, CONTROLWORD_QUICK_STOP = 0x0004,
    CONTROLWORD_ENABLE_OPERATION = 0x0008, CONTROLWORD_NEW_SET_POINT = 0x0010, CONTROLWORD_HOMING_START = 0x0010,
    CONTROLWORD_CHANGE_IMMEDIATELY = 0x0020, CONTROLWORD_FAULT_RESET = 0x0080, CONTROLWORD_HALT = 0x0100,
};
enum {
    STATUSWORD_READY_TO_SWITCH_ON = 0x0001, STATUSWORD_SWITCHED_ON = 0x0002, STATUSWORD_OPERATION_ENABLED = 0x0004,
    STATUSWORD_FAULT = 0x0008, STATUSWORD_VOLTAGE_ENABLED = 0x0010, STATUSWORD_QUICK_STOP = 0x0020,
    STATUSWORD_SWITCH_ON_DISABLED = 0x0040, STATUSWORD_WARNING = 0x0080, STATUSWORD_REMOTE = 0x0200,
    STATUSWORD_TARGET_REACHED = 0x0400, STATUSWORD_INTERNAL_LIMIT = 0x0800, STATUSWORD_BIT12 = 0x1000,
    STATUSWORD_HOMING_ATTAINED = 0x1000, STATUSWORD_SET_POINT_ACKNOWLEDGE = 0x1000, STATUSWORD_BIT13 = 0x2000,
    STATUSWORD_HOMING_ERROR = 0x2000, STATUSWORD_FOLLOWING_ERROR = 0x2000,
};

/** Commands: the controlword bits 0-3 and 7 that ask for them. */
typedef enum cm1e_fsa_command {
    COMMAND_DISABLE_VOLTAGE = 0, COMMAND_SHUTDOWN, COMMAND_SWITCH_ON, COMMAND_ENABLE_OPERATION, COMMAND_QUICK_STOP,
    COMMAND_FAULT_RESET, CM1E_FSA_COMMAND_COUNT,
} cm1e_fsa_command_t;

typedef struct cm1e_fsa_command_row {
    cm1e_fsa_command_t command;
    uint16_t mask, value; /**< decoding a controlword */
    uint16_t controlword; /**< sending it: UG 6.1.2's values 0x06, 0x07, 0x0F, 0x86 */
    const char *name;
} cm1e_fsa_command_row_t;
extern const cm1e_fsa_command_row_t cm1e_fsa_commands[CM1E_FSA_COMMAND_COUNT];

/** One transition of the automaton with its number in the standard. */
typedef struct cm1e_fsa_transition {
    uint8_t number;
    cm1e_fsa_state_t from, to;
    cm1e_fsa_command_t command; /**< CM1E_FSA_COMMAND_COUNT: automatic */
} cm1e_fsa_transition_t;
/** As the CM1-E has them: no quick stop; fault reset ends in Ready to switch on; a jump from Ready to switch on to
 *  Operation enabled is allowed (number 3, then 4). Ends with number 0xFF. */
extern const cm1e_fsa_transition_t cm1e_fsa_transitions[];

/** What a controlword commands by CiA 402 (bits 3 ... 0), but for a fault reset. */
cm1e_fsa_command_t cm1e_fsa_command_of(uint16_t controlword);
/** The next command on the way from `state` to Operation enabled (enable) or to Ready to switch on (not enable). */
cm1e_fsa_command_t cm1e_fsa_next_command(cm1e_fsa_state_t state, bool enable);

/** Modes of operation 0x6060 (CiA 402). */
typedef enum cm1e_mode {
    CM1E_MODE_NONE = 0, CM1E_MODE_PP = 1, CM1E_MODE_PV = 3, CM1E_MODE_HM = 6, CM1E_MODE_CSP = 8, CM1E_MODE_CSV = 9,
} cm1e_mode_t;
typedef struct cm1e_mode_row {
    cm1e_mode_t mode;
    uint8_t supported_bit; /**< in 0x6502 */
    const char *abbreviation, *name;
} cm1e_mode_row_t;
/** NULL: not a mode of the CM1-E. */
const cm1e_mode_row_t *cm1e_mode_find(int8_t mode);

#endif
