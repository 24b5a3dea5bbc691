/**
 * @file cml.h
 * CML is the language of the Cool Muscle motors, which the EtherCAT Cool MUSCLE Bridge passes on (BR 7.2). The
 * functions here classify a string, parse an answer, and exchange strings over a bus whose cycle does not run. A
 * program uses CM_SendCML instead.
 *
 * A string has one or more commands, separated by commas: "K53.1=100", "O1.1,O2.1". A command is a sign and usually a
 * number, and may name its motor: ".1" is the one at connector 1. The bridge adds CR and LF. An answer is one line, or
 * a list of lines (?90); a line is "K53.1=100", "Ux.1=8", "Origin.1=0", or another text.
 */
#ifndef CM1E_CML_H
#define CM1E_CML_H

#include "cm1e/api.h"
#include "cm1e/bus.h"

#ifdef __cplusplus
extern "C" {
#endif

#define CM1E_CML_BYTES 64  /**< maximum length of a string and of an answer line (BR 7.2.2) */
#define CM1E_CML_LINES 128 /**< maximum number of lines of an answer that are kept */

/** What a string can do, in rising order of effect. */
typedef enum cm1e_cml_kind {
    CM1E_CML_QUERY = 0, /**< reads a value: "?99.1", "K53.1" */
    CM1E_CML_PARAMETER, /**< writes a K parameter, which the motor keeps when its power is off: "K53.1=100" */
    CM1E_CML_OUTPUT,    /**< switches an output: "O2.1", "F2.1" */
    CM1E_CML_MOTION,    /**< may move the motor, or change its power or the meaning of its positions; or is unknown */
} cm1e_cml_kind_t;

/** Kind of a string: that of its command with the strongest effect. @rt cycle */
CM1E_API cm1e_cml_kind_t cm1e_cml_kind(const char *text);

/** Checks whether a string can be sent to the motor at connector `id` (1 ... 4). Returns NULL if it can. Otherwise
 *  returns the reason, to be read after "the string": "is empty", "is longer than 64 bytes" ... Static storage.
 *  @rt cycle */
CM1E_API const char *cm1e_cml_check(const char *text, unsigned id);

/** What a line from a motor is. */
typedef enum cm1e_cml_what {
    CM1E_CML_NOTHING = 0, /**< "Null": no answer has come yet */
    CM1E_CML_K,           /**< "K53.1=100" */
    CM1E_CML_STATUS,      /**< "Ux.1=8": the state of the motor, as in object F530:5 ... 8 */
    CM1E_CML_ORIGIN,      /**< "Origin.1=0": an origin search has succeeded */
    CM1E_CML_VALUE,       /**< another name with a value: "Px.1=-1200" */
    CM1E_CML_TEXT,        /**< any other line */
} cm1e_cml_what_t;

/** A line from a motor, taken apart. */
typedef struct cm1e_cml_answer {
    cm1e_cml_what_t what;
    char name[16];   /**< "K", "Ux", "Origin", "Px" ...; "" for NOTHING and TEXT */
    unsigned number; /**< number of a K parameter */
    unsigned id;     /**< connector of the motor that answers */
    int32_t value;
} cm1e_cml_answer_t;

/** Parses one line, which must have its CR or LF at the end: without it the line was cut. `bytes` need no final 0;
 *  bytes behind a 0 are ignored. Returns CM1E_ERROR_CML_ANSWER if the line is damaged. @rt cycle */
CM1E_API cm1e_error_t cm1e_cml_parse(cm1e_cml_answer_t *answer, const void *bytes, size_t size);

/** A string for a motor behind a bridge, and its answer. Zero the struct, then fill in the first part. */
typedef struct cm1e_cml_exchange_t {
    uint16_t position;   /**< position of the bridge, 1 = first */
    uint8_t channel;     /**< connector, 1 ... 4 */
    const char *text;
    int64_t timeout_ns;  /**< time for the answer, up to 1e6 s; 0 selects 1 s, for an origin search 70 s */
    bool allow_motion;   /**< true: strings of the kind CM1E_CML_MOTION are allowed */
    bool (*cancelled)(void *context); /**< called every few ms; true ends the exchange. NULL: never */
    void *context;       /**< argument of `cancelled` */

    /* the answer */
    unsigned count;      /**< number of lines */
    unsigned lost;       /**< number of lines beyond the 128th, which were dropped */
    char lines[CM1E_CML_LINES][CM1E_CML_BYTES + 1]; /**< without CR and LF */
    unsigned strays;     /**< number of lines that do not belong to this query: of an earlier query, or unsolicited */
    char stray[CM1E_CML_BYTES + 1]; /**< the last of these lines */
} cm1e_cml_exchange_t;

/** Sends a string and waits for its answer: none for a parameter or an output, the value of each query, all lines of a
 *  list, the end of an origin search. It first brings the axis to CML mode (0x6060, BR appendix 3.2) and leaves it
 *  there, see cm1e_cml_leave(). The bus must be scanned, in Pre-Operational or higher, and its cycle must not run.
 *  After CM1E_ERROR_CML_STRING and CM1E_ERROR_CML_MOTION nothing was sent. CM1E_ERROR_CM_SEARCH: the motor answered
 *  "Ux" instead of "Origin". If an error ends a string that may have moved the motor, the motor is freed. @rt block */
CM1E_API cm1e_error_t cm1e_cml_exchange(cm1e_bus_t *bus, cm1e_cml_exchange_t *exchange, cm1e_diag_t *diag);

/** Brings an axis from CML mode back to csp; the motor must be at standstill for that (BR appendix 3.3). An axis in
 *  another mode stays in it. `free_motor` true frees the motor first; use it after strings that may have moved the
 *  motor. @rt block */
CM1E_API cm1e_error_t cm1e_cml_leave(cm1e_bus_t *bus, uint16_t position, uint8_t channel, bool free_motor,
                                     cm1e_diag_t *diag);

#ifdef __cplusplus
}
#endif
#endif
