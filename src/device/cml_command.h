/**
 * @file cml_command.h
 * The commands of CML one by one: what each does, and what answers it. The letters are those of BR 7.2 and its appendix
 * 2, and of Myostat's quick reference of the CM1 (RT3), which BR refers to. What is not known to be harmless may move
 * the motor.
 */
#ifndef CM1E_DEVICE_CML_COMMAND_H
#define CM1E_DEVICE_CML_COMMAND_H

#include "cm1e/cml.h"

/** What is to be waited for after a command. */
typedef enum cm1e_cml_reply {
    CM1E_CML_SILENT = 0, /**< nothing (BR appendix 2.2, 2.6) */
    CM1E_CML_ONE_LINE,   /**< its value (2.1, 2.3) */
    CM1E_CML_LIST,       /**< lines until there are none any more (2.5) */
    CM1E_CML_SEARCH,     /**< Origin, or Ux where it failed (2.4) */
    CM1E_CML_UNKNOWN,    /**< perhaps something: a command that is not known */
} cm1e_cml_reply_t;

typedef struct cm1e_cml_command {
    cm1e_cml_kind_t kind;
    cm1e_cml_reply_t reply;
    char sign;     /**< 'K', '?', '|' ...; 0: it has not the form of a command */
    bool numbered;
    bool valued;   /**< "=..." */
    unsigned number;
    unsigned id;   /**< 0: none */
} cm1e_cml_command_t;

enum { CM1E_CML_COMMANDS = CM1E_CML_BYTES / 2 }; /**< most of one string: a sign and a comma each */

/** Reads the command that begins at `*text` and goes on behind its comma; `*text` NULL after the last one. */
cm1e_cml_command_t cm1e_cml_next(const char **text);
/** Written while an input is on, what an input does (manual feed, a jog, a program, motor enable: K26 ... K32) or what
 *  pulses do (K36) moves the motor; K37 is how far a count is. (Quick reference of the CM1, RT3.) */
bool cm1e_cml_parameter_can_move(unsigned number);
/** The line answers the command. */
bool cm1e_cml_answers(const cm1e_cml_command_t *command, const cm1e_cml_answer_t *answer);

#endif
