/**
 * @file cml.h
 * CML, the language of the Cool Muscle motors, as the EtherCAT Cool MUSCLE Bridge passes it on (BR 7.2): what a string
 * can do to a motor, what an answer says, and an exchange over a bus whose cycle does not run. In a program:
 * CM_SendCML.
 *
 * A string has one or more commands between commas: "K53.1=100", "O1.1,O2.1". A command is a sign, mostly a number, and
 * may name its motor: ".1" is the one at connector 1. The bridge adds CR and LF. An answer is one line, or a list of
 * lines (?90), each of them "K53.1=100", "Ux.1=8", "Origin.1=0", or another text.
 */
#ifndef CM1E_CML_H
#define CM1E_CML_H

#include "cm1e/api.h"
#include "cm1e/bus.h"

#ifdef __cplusplus
extern "C" {
#endif

#define CM1E_CML_BYTES 64  /**< longest string, and longest answer (BR 7.2.2) */
#define CM1E_CML_LINES 128 /**< most lines of an answer that are kept */

/** What a string can do. */
typedef enum cm1e_cml_kind {
    CM1E_CML_QUERY = 0, /**< asks: "?99.1", "K53.1" */
    CM1E_CML_PARAMETER, /**< writes a K parameter, which the motor keeps without power: "K53.1=100" */
    CM1E_CML_OUTPUT,    /**< switches an output: "O2.1", "F2.1" */
    CM1E_CML_MOTION,    /**< may move the motor, change its power or what its positions mean; or is not known */
} cm1e_cml_kind_t;

/** The kind of its strongest command, in the order above. @rt cycle */
CM1E_API cm1e_cml_kind_t cm1e_cml_kind(const char *text);

/** NULL: can be sent to the motor at connector `id` (1 ... 4). Otherwise what is wrong, to be read after "the string":
 *  "is empty", "is longer than 64 bytes" ... Static storage. @rt cycle */
CM1E_API const char *cm1e_cml_check(const char *text, unsigned id);

typedef enum cm1e_cml_what {
    CM1E_CML_NOTHING = 0, /**< "Null": no answer has come yet */
    CM1E_CML_K,           /**< "K53.1=100" */
    CM1E_CML_STATUS,      /**< "Ux.1=8": the state of the motor, as in object F530:5 ... 8 */
    CM1E_CML_ORIGIN,      /**< "Origin.1=0": an origin search has ended well */
    CM1E_CML_VALUE,       /**< another name with a value: "Px.1=-1200" */
    CM1E_CML_TEXT,        /**< any other line */
} cm1e_cml_what_t;

typedef struct cm1e_cml_answer {
    cm1e_cml_what_t what;
    char name[16];   /**< "K", "Ux", "Origin", "Px" ...; "" of NOTHING and TEXT */
    unsigned number; /**< of a K parameter */
    unsigned id;     /**< connector of the motor that says it */
    int32_t value;
} cm1e_cml_answer_t;

/** Reads one line with its CR or LF at the end, which is how a line that was cut is known. `bytes` need no final 0, and
 *  what is behind one does not count. CM1E_ERROR_CML_ANSWER: it is damaged. @rt cycle */
CM1E_API cm1e_error_t cm1e_cml_parse(cm1e_cml_answer_t *answer, const void *bytes, size_t size);

/** A string for a motor behind a bridge, and what came back. Zero it, then fill in the first part. */
typedef struct cm1e_cml_exchange {
    uint16_t position;   /**< slave, 1 = first */
    uint8_t channel;     /**< connector, 1 ... 4 */
    const char *text;
    int64_t timeout_ns;  /**< until an answer, up to 1e6 s; 0: 1 s, for an origin search 70 s */
    bool allow_motion;   /**< strings of the kind CM1E_CML_MOTION are sent too */
    bool (*cancelled)(void *context); /**< asked every few ms; NULL: nobody cancels */
    void *context;       /**< of `cancelled` */

    /* what came back */
    unsigned count;      /**< lines */
    unsigned lost;       /**< lines beyond the 128th, which were dropped */
    char lines[CM1E_CML_LINES][CM1E_CML_BYTES + 1]; /**< without CR and LF */
    unsigned strays;     /**< lines that answer nothing that was asked now: of an earlier query, or sent unasked */
    char stray[CM1E_CML_BYTES + 1]; /**< the last of them */
} cm1e_cml_exchange_t;

/** Sends a string and waits for what it says is to come: nothing after a parameter or an output; the value of each
 *  query; all lines of a list; the end of an origin search. Brings the axis to CML mode before (0x6060, BR appendix
 *  3.2) and leaves it there: see cm1e_cml_leave(). For a scanned bus whose cycle does not run, Pre-Operational or
 *  higher. CM1E_ERROR_CML_STRING, _MOTION: nothing was sent; CM1E_ERROR_CM_SEARCH: the motor said "Ux" instead of
 *  "Origin". Where an error ends a string that may have moved the motor, the motor is freed. @rt block */
CM1E_API cm1e_error_t cm1e_cml_exchange(cm1e_bus_t *bus, cm1e_cml_exchange_t *exchange, cm1e_diag_t *diag);

/** Brings an axis that is in CML mode back to csp, for which the motor must stand (BR appendix 3.3); an axis in another
 *  mode stays in it. `free_motor`: frees the motor before, as after strings that may have moved it. @rt block */
CM1E_API cm1e_error_t cm1e_cml_leave(cm1e_bus_t *bus, uint16_t position, uint8_t channel, bool free_motor,
                                     cm1e_diag_t *diag);

#ifdef __cplusplus
}
#endif
#endif
