#include "bridge_wire.h"

enum { WIRE_LRW = 12, WIRE_FPRD = 4, WIRE_FPWR = 5, WIRE_FIRST_DATAGRAM = 16, WIRE_HEADER = 10 };
enum { WIRE_MAILBOX_OUT = 0x1000, WIRE_MAILBOX_IN = 0x1080, WIRE_COE = 3, WIRE_SDO_REQUEST = 2, WIRE_SDO_RESPONSE = 3 };

struct bridge_wire bridge_wire;

/* ---- branches ---------------------------------------------------------------------------------------------------- */

int run_flows(Suite *suite, const branch_t *table, size_t count)
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

static void see_outputs(const uint8_t *data, int64_t time_ns)
{
    for (unsigned axis = 0; axis < CM1E_BRIDGE_AXES; axis++, data += WIRE_AXIS_BYTES) {
        const uint16_t word = cm1e_get_u16(data);
        const int count = bridge_wire.word_count[axis];
        word_run_t *last = count ? &bridge_wire.words[axis][count - 1] : NULL;
        bridge_wire.target[axis] = (int32_t)cm1e_get_u32(data + 2);
        if (last && last->word == word) {
            last->cycles++;
        } else {
            ck_assert_int_lt(bridge_wire.word_count[axis], WIRE_RUNS);
            bridge_wire.words[axis][bridge_wire.word_count[axis]++] = (word_run_t){word, 1, time_ns};
        }
    }
}

static void see_inputs(uint8_t *data)
{
    for (unsigned axis = 0; axis < CM1E_BRIDGE_AXES; axis++, data += WIRE_AXIS_BYTES) {
        if (bridge_wire.forge_inputs)
            bridge_wire.forge_inputs(axis, data);
        bridge_wire.status[axis] = cm1e_get_u16(data);
        bridge_wire.position[axis] = (int32_t)cm1e_get_u32(data + 2);
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
    ck_assert_int_lt(bridge_wire.sdo_count, WIRE_SDOS);
    sdo_seen_t *sdo = &bridge_wire.sdos[bridge_wire.sdo_count++];
    *sdo = (sdo_seen_t){.index = cm1e_get_u16(message + SDO_INDEX), .subindex = message[SDO_SUBINDEX],
                        .write = (message[SDO_COMMAND] & SDO_KIND) == SDO_DOWNLOAD, .sent_ns = time_ns};
    if (sdo->write)
        take_data(sdo, message);
}

static void see_answer(uint8_t *message, int64_t time_ns)
{
    sdo_seen_t *sdo = bridge_wire.sdo_count ? &bridge_wire.sdos[bridge_wire.sdo_count - 1] : NULL;
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
        if (bridge_wire.forge_answer && (command & SDO_EXPEDITED))
            bridge_wire.forge_answer(sdo, message + SDO_DATA);
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

cm1e_tap_verdict_t wire_tap(void *context, cm1e_tap_frame_t *frame)
{
    (void)context;
    uint8_t *at = frame->bytes + WIRE_FIRST_DATAGRAM, *end = frame->bytes + frame->length;
    if (bridge_wire.deaf && frame->direction == CM1E_TAP_RECEIVED)
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

void wire_forget(void) { memset(&bridge_wire, 0, sizeof bridge_wire); }

int find_word(unsigned axis, int from, uint16_t word)
{
    for (int i = from; i < bridge_wire.word_count[axis]; i++)
        if (bridge_wire.words[axis][i].word == word)
            return i;
    return -1;
}

const char *words_seen(unsigned axis)
{
    static char text[1024];
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; i < bridge_wire.word_count[axis] && used + 24 < sizeof text; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, " %04Xh x %d", bridge_wire.words[axis][i].word,
                                 bridge_wire.words[axis][i].cycles);
    return text;
}

const sdo_seen_t *find_sdo(int from, bool write, uint16_t index, int *number)
{
    for (int i = from; i < bridge_wire.sdo_count; i++)
        if (bridge_wire.sdos[i].write == write && bridge_wire.sdos[i].index == index) {
            if (number)
                *number = i;
            return &bridge_wire.sdos[i];
        }
    return NULL;
}

int count_sdos(bool write, uint16_t index)
{
    int count = 0;
    for (int i = 0; i < bridge_wire.sdo_count; i++)
        count += bridge_wire.sdos[i].write == write && bridge_wire.sdos[i].index == index;
    return count;
}
