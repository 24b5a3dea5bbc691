/**
 * @file bridge_wire.h
 * What goes over the wire between a master and one bridge, seen at the tap: how many cycles each controlword stood, and
 * every SDO with its answer. For the tests of the guide's flow charts, whose branches are a table: each test says which
 * one it saw taken, and a branch that nobody took is a failure. Include it once in a test program.
 */
#ifndef CM1E_TESTS_BRIDGE_WIRE_H
#define CM1E_TESTS_BRIDGE_WIRE_H

#include <check.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bus/bus_image.h"
#include "core/bytes.h"
#include "nic/nic.h"
#include "sim/backend.h"
#include "sim/bridge_app.h"

/* ---- branches ---------------------------------------------------------------------------------------------------- */

/** One way out of a decision of a flow chart, or the whole way of a chart that has none. */
typedef struct branch {
    const char *chart, *decision, *way;
    int taken;
} branch_t;

/** Runs all tests in this process, so that the table counts for all of them; then looks at it. */
static inline int run_flows(Suite *suite, const branch_t *table, size_t count)
{
    SRunner *runner = srunner_create(suite);
    srunner_set_fork_status(runner, CK_NOFORK);
    srunner_run_all(runner, CK_ENV);
    int failed = srunner_ntests_failed(runner);
    const bool all = srunner_ntests_run(runner) > 0 && !getenv("CK_RUN_CASE");
    srunner_free(runner);
    for (size_t i = 0; i < count; i++) {
        printf("appendix %s, %s: %s, %d times\n", table[i].chart, table[i].decision, table[i].way, table[i].taken);
        failed += all && table[i].taken == 0;
        if (all && table[i].taken == 0)
            printf("NOT TAKEN\n");
    }
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}

/* ---- what is seen ------------------------------------------------------------------------------------------------ */

enum { WIRE_RUNS = 4096, WIRE_SDOS = 4096, WIRE_AXIS_BYTES = 6, WIRE_IMAGE = WIRE_AXIS_BYTES * CM1E_BRIDGE_AXES };
enum { WIRE_LRW = 12, WIRE_FPRD = 4, WIRE_FPWR = 5, WIRE_FIRST_DATAGRAM = 16, WIRE_HEADER = 10 };
enum { WIRE_MAILBOX_OUT = 0x1000, WIRE_MAILBOX_IN = 0x1080, WIRE_COE = 3, WIRE_SDO_REQUEST = 2, WIRE_SDO_RESPONSE = 3 };

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

static struct wire {
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
} wire;

static void see_outputs(const uint8_t *data, int64_t time_ns)
{
    for (unsigned axis = 0; axis < CM1E_BRIDGE_AXES; axis++, data += WIRE_AXIS_BYTES) {
        const uint16_t word = cm1e_get_u16(data);
        word_run_t *last = wire.word_count[axis] ? &wire.words[axis][wire.word_count[axis] - 1] : NULL;
        wire.target[axis] = (int32_t)cm1e_get_u32(data + 2);
        if (last && last->word == word) {
            last->cycles++;
        } else {
            ck_assert_int_lt(wire.word_count[axis], WIRE_RUNS);
            wire.words[axis][wire.word_count[axis]++] = (word_run_t){word, 1, time_ns};
        }
    }
}

static void see_inputs(uint8_t *data)
{
    for (unsigned axis = 0; axis < CM1E_BRIDGE_AXES; axis++, data += WIRE_AXIS_BYTES) {
        if (wire.forge_inputs)
            wire.forge_inputs(axis, data);
        wire.status[axis] = cm1e_get_u16(data);
        wire.position[axis] = (int32_t)cm1e_get_u32(data + 2);
    }
}

/* Places in a mailbox message: its type, the CoE header, and the SDO with command, index, sub-index, data. */
enum { MESSAGE_TYPE = 5, COE_SERVICE = 7, SDO_COMMAND = 8, SDO_INDEX = 9, SDO_SUBINDEX = 11, SDO_DATA = 12,
       SDO_LONG = 16 };
enum { SDO_EXPEDITED = 0x02, SDO_ABORT = 0x80, SDO_DOWNLOAD = 0x20, SDO_KIND = 0xE0, SDO_UPLOAD = 0x40 };

static void take_data(sdo_seen_t *sdo, const uint8_t *message)
{
    const uint8_t command = message[SDO_COMMAND];
    const bool is_short = (command & SDO_EXPEDITED) != 0;
    sdo->size = is_short ? 4u - (command >> 2 & 3u) : cm1e_get_u32(message + SDO_DATA);
    if (sdo->size >= sizeof sdo->data)
        sdo->size = sizeof sdo->data - 1;
    memcpy(sdo->data, message + (is_short ? SDO_DATA : SDO_LONG), sdo->size);
    sdo->data[sdo->size] = '\0';
}

static void see_request(const uint8_t *message, int64_t time_ns)
{
    if ((message[MESSAGE_TYPE] & 0x0F) != WIRE_COE || message[COE_SERVICE] >> 4 != WIRE_SDO_REQUEST)
        return;
    ck_assert_int_lt(wire.sdo_count, WIRE_SDOS);
    sdo_seen_t *sdo = &wire.sdos[wire.sdo_count++];
    *sdo = (sdo_seen_t){.index = cm1e_get_u16(message + SDO_INDEX), .subindex = message[SDO_SUBINDEX],
                        .write = (message[SDO_COMMAND] & SDO_KIND) == SDO_DOWNLOAD, .sent_ns = time_ns};
    if (sdo->write)
        take_data(sdo, message);
}

static void see_answer(uint8_t *message, int64_t time_ns)
{
    sdo_seen_t *sdo = wire.sdo_count ? &wire.sdos[wire.sdo_count - 1] : NULL;
    const uint8_t command = message[SDO_COMMAND], service = message[COE_SERVICE] >> 4;
    if (!sdo || sdo->answered || (message[MESSAGE_TYPE] & 0x0F) != WIRE_COE)
        return;
    if (service != WIRE_SDO_RESPONSE && command != SDO_ABORT)
        return;
    sdo->answered = true;
    sdo->answered_ns = time_ns;
    if (command == SDO_ABORT) {
        sdo->abort_code = cm1e_get_u32(message + SDO_DATA);
    } else if ((command & SDO_KIND) == SDO_UPLOAD) {
        if (wire.forge_answer && (command & SDO_EXPEDITED))
            wire.forge_answer(sdo, message + SDO_DATA);
        take_data(sdo, message);
    }
}

static void see_datagram(uint8_t *datagram, size_t length, const cm1e_tap_frame_t *frame)
{
    const uint8_t command = datagram[0];
    const uint16_t offset = cm1e_get_u16(datagram + 4);
    uint8_t *data = datagram + WIRE_HEADER;
    const bool heard = frame->direction == CM1E_TAP_RECEIVED && cm1e_get_u16(data + length) > 0;
    if (command == WIRE_LRW && length == 2 * WIRE_IMAGE) {
        if (frame->direction == CM1E_TAP_SENT)
            see_outputs(data, frame->time_ns);
        else
            see_inputs(data + WIRE_IMAGE);
    } else if (command == WIRE_FPWR && offset == WIRE_MAILBOX_OUT && frame->direction == CM1E_TAP_SENT) {
        see_request(data, frame->time_ns);
    } else if (command == WIRE_FPRD && offset == WIRE_MAILBOX_IN && heard) {
        see_answer(data, frame->time_ns);
    }
}

static cm1e_tap_verdict_t wire_tap(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    uint8_t *at = frame->bytes + WIRE_FIRST_DATAGRAM, *end = frame->bytes + frame->length;
    if (wire.deaf && frame->direction == CM1E_TAP_RECEIVED)
        return CM1E_TAP_DROP;
    while (at + WIRE_HEADER + 2 <= end) {
        const size_t length = cm1e_get_u16(at + 6) & 0x7FFu;
        const bool more = (cm1e_get_u16(at + 6) & 0x8000u) != 0;
        if (at + WIRE_HEADER + length + 2 > end)
            break;
        see_datagram(at, length, frame);
        at += WIRE_HEADER + length + 2;
        if (!more)
            break;
    }
    return CM1E_TAP_PASS;
}

/* ---- what tests ask ---------------------------------------------------------------------------------------------- */

/** From now on; what was forged is not forged any more. */
static inline void wire_forget(void) { memset(&wire, 0, sizeof wire); }

/** Number of the first run of `word` at or behind run `from`; -1: there is none. */
static inline int find_word(unsigned axis, int from, uint16_t word)
{
    for (int i = from; i < wire.word_count[axis]; i++)
        if (wire.words[axis][i].word == word)
            return i;
    return -1;
}

/** The controlwords since wire_forget() in words, for messages. */
static inline const char *words_seen(unsigned axis)
{
    static char text[1024];
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; i < wire.word_count[axis] && used + 24 < sizeof text; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, " %04Xh x %d", wire.words[axis][i].word,
                                 wire.words[axis][i].cycles);
    return text;
}

/** The next SDO at or behind number `from`, by its index on the wire; NULL: none. `*number` may be NULL. */
static inline const sdo_seen_t *find_sdo(int from, bool write, uint16_t index, int *number)
{
    for (int i = from; i < wire.sdo_count; i++)
        if (wire.sdos[i].write == write && wire.sdos[i].index == index) {
            if (number)
                *number = i;
            return &wire.sdos[i];
        }
    return NULL;
}

static inline int count_sdos(bool write, uint16_t index)
{
    int count = 0;
    for (int i = 0; i < wire.sdo_count; i++)
        count += wire.sdos[i].write == write && wire.sdos[i].index == index;
    return count;
}

#endif
