/**
 * @file sdo_harm.h
 * A tap that lets SDO answers of a slave arrive as something else than the slave said.
 */
#ifndef CM1E_TESTS_SDO_HARM_H
#define CM1E_TESTS_SDO_HARM_H

#include "bus_support.h"

typedef enum harm_kind { NO_HARM = 0, ABORT, OTHER_VALUE, STRANGER, LONG, GARBAGE, LATE, HARMS } harm_kind_t;

/** Which SDO answers of which slave (by station address; 0: of every one) arrive as something else. */
typedef struct harm {
    harm_kind_t kind;
    uint16_t station, index;   /**< index 0: by number */
    uint8_t subindex;
    unsigned at, seen;
    cm1e_bus_t *bus;
    int64_t asked_ns;          /**< LATE: the last request */
} harm_t;

enum { SDO_DATA = 12, ABORT_READ_ONLY = 0x06010002, ANSWER_AT = 0x1080, QUESTION_AT = 0x1000 };

void spoil(const harm_t *harm, uint8_t *mailbox);

cm1e_tap_verdict_t do_harm(void *context, cm1e_tap_frame_t *frame);

void set_harm(cm1e_bus_t *bus, harm_t *harm);

#endif
