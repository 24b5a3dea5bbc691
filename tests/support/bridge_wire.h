/**
 * @file bridge_wire.h
 * What goes over the wire between a master and one bridge, seen at the tap: how many cycles each controlword stood, and
 * every SDO with its answer. For the tests of the guide's flow charts, whose branches are a table: each test says which
 * one it saw taken, and a branch that nobody took is a failure.
 */
#ifndef CM1E_TESTS_BRIDGE_WIRE_H
#define CM1E_TESTS_BRIDGE_WIRE_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bus/bus_image.h"
#include "core/bytes.h"
#include "nic/nic.h"
#include "quick_check.h"
#include "sim/segment_backend.h"
#include "sim/bridge_app.h"

/* ---- branches ---------------------------------------------------------------------------------------------------- */

/** One way out of a decision of a flow chart, or the whole way of a chart that has none. */
typedef struct branch {
    const char *chart, *decision, *way;
    int taken;
} branch_t;

/** Runs all tests in this process, so that the table counts for all of them; then looks at it. */
int run_flows(Suite *suite, const branch_t *table, size_t count);

/* ---- what is seen ------------------------------------------------------------------------------------------------ */

enum { WIRE_RUNS = 4096, WIRE_SDOS = 4096, WIRE_AXIS_BYTES = 6, WIRE_IMAGE = WIRE_AXIS_BYTES * CM1E_BRIDGE_AXES };

typedef struct word_run {
    uint16_t word;
    int cycles;
    int64_t from_ns;
} word_run_t;

typedef struct sdo_seen {
    bool write, answered;
    uint16_t index;
    uint8_t subindex;
    uint32_t abort_code;
    size_t size;
    char data[80];               /**< written, or read; with a final 0 */
    int64_t sent_ns, answered_ns;
} sdo_seen_t;

struct bridge_wire {
    word_run_t words[CM1E_BRIDGE_AXES][WIRE_RUNS];
    int word_count[CM1E_BRIDGE_AXES];
    int32_t target[CM1E_BRIDGE_AXES], position[CM1E_BRIDGE_AXES];
    uint16_t status[CM1E_BRIDGE_AXES];   /**< as the master gets it */
    sdo_seen_t sdos[WIRE_SDOS];
    int sdo_count;
    /** Changes the inputs of an axis (statusword, position) before the master gets them. */
    void (*forge_inputs)(unsigned axis, uint8_t *inputs);
    /** Changes the up to four bytes of a short answer before the master gets it. */
    void (*forge_answer)(const sdo_seen_t *sdo, uint8_t *value);
    bool deaf;                           /**< no process data comes back */
};
extern struct bridge_wire bridge_wire;

/** To be set as the tap. */
cm1e_tap_verdict_t wire_tap(void *context, cm1e_tap_frame_t *frame);

/* ---- what tests ask ---------------------------------------------------------------------------------------------- */

/** From now on; what was forged is not forged any more. */
void wire_forget(void);

/** Number of the first run of `word` at or behind run `from`; -1: there is none. */
int find_word(unsigned axis, int from, uint16_t word);

/** The controlwords since wire_forget() in words, for messages. */
const char *words_seen(unsigned axis);

/** The next SDO at or behind number `from`, by its index on the wire; NULL: none. `*number` may be NULL. */
const sdo_seen_t *find_sdo(int from, bool write, uint16_t index, int *number);
int count_sdos(bool write, uint16_t index);

#endif
