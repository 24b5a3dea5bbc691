/* Frames that come back from the wire, changed in every way that an input says: SOEM's core, unmodified, and all above
 * it scan, talk to mailboxes, read an SII, start, cycle with an axis that moves, recover and stop on them. What goes
 * out is never changed, so the simulated slaves stay honest. Time is virtual: a run repeats exactly. A run ends
 * defined, in bounded time, and on honest frames the same bus starts again.
 *
 * An input: which network, what is done on it, with how much room, then one instruction after the other, each for one
 * or more of the frames that come back. Behind the last instruction frames pass as they are. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "assembly/assembly.h"
#include "axis/axis_api.h"
#include "bus/bus_image.h"
#include "cm1e/sdo_info.h"
#include "cm1e/sii.h"
#include "cm1e/sim.h"
#include "core/bytes.h"
#include "device/place.h"
#include "fuzz.h"
#include "nic/nic.h"

enum { CYCLES = 120, SETTLE_CYCLES = 20, LONGEST_RUN_S = 900 };
/** Room for texts, for lists and for an SII, by two bits each of the input. */
static const size_t text_rooms[] = {40, 3, 300, 1500}, list_rooms[] = {64, 2, 9, 300},
                    sii_rooms[] = {2048, 512, 128, 4096};
/** Places in a frame with one datagram or more (ETG.1000.4 section 5.3). */
enum { FIRST_DATAGRAM = 16, DATAGRAM_HEADER = 10, DATAGRAM_LENGTH = 6, DATAGRAM_MORE = 0x8000 };

/** What is done beside scan and start, by bits. */
enum { DO_SDO = 1, DO_INFO = 2, DO_SII = 4, DO_AXIS = 8, DO_POWER_CYCLE = 16 };

typedef enum instruction {
    PASS = 0, DROP, TWICE, LATE, CUT, GROW, COUNTER, HEADER, DATA, MAILBOX, STATUS, FILL, REPLACE, FOREIGN, SWAP_INDEX,
    PASS_MAILBOX, /* lets answers of mailboxes pass */
    INSTRUCTIONS,
} instruction_t;

typedef struct input {
    const uint8_t *at, *end;
    instruction_t instruction;
    unsigned frames;         /**< that the instruction is still for */
    const uint8_t *operands; /**< of the instruction, read anew for each frame */
} input_t;

typedef struct run {
    input_t input;
    cm1e_bus_config_t config;
    cm1e_bus_t *bus;
    cm1e_axis_t *axes[CM1E_BRIDGE_AXES];
    cm1e_diag_t diag;
    uint8_t doing;
    uint16_t position;       /**< of a slave with a mailbox */
    size_t text_room, list_room, sii_room;
} run_t;

/* ---- instructions ----------------------------------------------------------------------------------------------- */

static unsigned take(input_t *input, unsigned bytes) { return fuzz_take(&input->at, input->end, bytes); }

/** The beginning of a datagram of the frame, the n-th or the last before; 0: there is none. */
static size_t datagram(const cm1e_tap_frame_t *frame, unsigned n)
{
    size_t at = FIRST_DATAGRAM;
    while (at + DATAGRAM_HEADER + 2 <= frame->length) {
        const unsigned word = cm1e_get_u16(frame->bytes + at + DATAGRAM_LENGTH);
        const size_t next = at + DATAGRAM_HEADER + (word & 0x7FF) + 2;
        if (n-- == 0 || !(word & DATAGRAM_MORE) || next + DATAGRAM_HEADER + 2 > frame->length)
            return next <= frame->length ? at : 0;
        at = next;
    }
    return 0;
}

/** Writes bytes of the input over what is at `at`, as far as `end`. */
static void overwrite(input_t *input, uint8_t *bytes, size_t at, size_t end, unsigned count)
{
    for (unsigned i = 0; i < count; i++, at++) {
        const uint8_t value = (uint8_t)take(input, 1);
        if (at < end)
            bytes[at] = value;
    }
}

/** Into the data of a datagram, from a byte on. */
static void change_data(input_t *input, cm1e_tap_frame_t *frame, unsigned from)
{
    const unsigned operand = take(input, 1);
    const size_t at = datagram(frame, operand >> 6);
    const unsigned count = 1 + (operand & 0x1F);
    const size_t length = at ? cm1e_get_u16(frame->bytes + at + DATAGRAM_LENGTH) & 0x7FFu : 0;
    if (at)
        overwrite(input, frame->bytes, at + DATAGRAM_HEADER + from, at + DATAGRAM_HEADER + length, count);
}

/** In one or more places of an answer. */
static void change_mailbox(input_t *input, cm1e_tap_frame_t *frame)
{
    const size_t data = datagram(frame, 0) + DATAGRAM_HEADER;
    const size_t length = cm1e_get_u16(frame->bytes + data - DATAGRAM_HEADER + DATAGRAM_LENGTH) & 0x7FFu;
    for (unsigned places = 1 + take(input, 1) % 4; places > 0; places--) {
        const unsigned from = take(input, 1) % 64, count = 1 + take(input, 1) % 32;
        overwrite(input, frame->bytes, data + from, data + length, count);
    }
}

/** AL status, or a sync manager's, by what the frame reads. */
static void change_status(input_t *input, cm1e_tap_frame_t *frame)
{
    const size_t at = datagram(frame, 0);
    const unsigned value = take(input, 2);
    if (cm1e_get_u16(frame->bytes + at + 4) == 0x0130)
        cm1e_put_u16(frame->bytes + at + DATAGRAM_HEADER, (uint16_t)value);
    else
        frame->bytes[at + DATAGRAM_HEADER + 5] = (uint8_t)value;
}

/** Some instructions wait for the frames that they are about; others pass. */
static bool concerns(instruction_t instruction, const cm1e_tap_frame_t *frame)
{
    const size_t at = datagram(frame, 0);
    const unsigned offset = at ? cm1e_get_u16(frame->bytes + at + 4) : 0;
    if (instruction == MAILBOX || instruction == PASS_MAILBOX)
        return at && frame->bytes[at] == 4 && offset >= 0x1000; /* FPRD */
    if (instruction == STATUS)
        return at && (offset == 0x0130 || offset == 0x0800 || offset == 0x0808);
    return true;
}

static void change_counter(input_t *input, cm1e_tap_frame_t *frame)
{
    const unsigned operand = take(input, 1);
    const size_t at = datagram(frame, operand >> 6);
    const size_t length = at ? cm1e_get_u16(frame->bytes + at + DATAGRAM_LENGTH) & 0x7FFu : 0;
    if (at)
        cm1e_put_u16(frame->bytes + at + DATAGRAM_HEADER + length, (uint16_t)(operand & 0x3F));
}

static void replace(input_t *input, cm1e_tap_frame_t *frame, size_t from)
{
    frame->length = from + take(input, 1) * 6;
    if (frame->length > CM1E_FRAME_MAX)
        frame->length = CM1E_FRAME_MAX;
    for (size_t i = from; i < frame->length; i++)
        frame->bytes[i] = (uint8_t)take(input, 1);
}

/** Also a frame that nobody sent, beside this one. */
static void inject(input_t *input, run_t *run, const cm1e_tap_frame_t *frame)
{
    uint8_t foreign[CM1E_FRAME_MAX];
    const unsigned kept = take(input, 1);
    const size_t length = frame->length < sizeof foreign ? frame->length : sizeof foreign;
    memcpy(foreign, frame->bytes, length);
    overwrite(input, foreign, kept, length, 1 + take(input, 1) % 32);
    cm1e_nic_inject(cm1e_bus_nic(run->bus), frame->port, foreign, length, frame->time_ns + take(input, 1) * 1000);
}

static cm1e_tap_verdict_t execute(run_t *run, cm1e_tap_frame_t *frame)
{
    input_t *input = &run->input;
    switch (input->instruction) {
    case DROP:
        return CM1E_TAP_DROP;
    case TWICE:
        frame->copies = 2;
        break;
    case LATE:
        frame->delay_ns = (int64_t)take(input, 1) * 20000;
        break;
    case CUT:
        frame->length = frame->length * take(input, 1) / 256;
        break;
    case GROW:
        frame->length += take(input, 1);
        break;
    case COUNTER:
        change_counter(input, frame);
        break;
    case HEADER: {
        const unsigned from = take(input, 1);
        overwrite(input, frame->bytes, from % 64, frame->length, 1);
        break;
    }
    case DATA:
        change_data(input, frame, 0);
        break;
    case MAILBOX:
        change_mailbox(input, frame);
        break;
    case STATUS:
        change_status(input, frame);
        break;
    case FILL:
        memset(frame->bytes + FIRST_DATAGRAM, (int)take(input, 1),
               frame->length > FIRST_DATAGRAM ? frame->length - FIRST_DATAGRAM : 0);
        break;
    case REPLACE:
        replace(input, frame, take(input, 1) % 2 ? FIRST_DATAGRAM : 0);
        break;
    case FOREIGN:
        inject(input, run, frame);
        break;
    case SWAP_INDEX: /* SOEM's index of the frame, in its first datagram */
        frame->bytes[FIRST_DATAGRAM + 1] = (uint8_t)take(input, 1) & 0x0F;
        break;
    case PASS:
    case PASS_MAILBOX:
    case INSTRUCTIONS:
        break;
    }
    return CM1E_TAP_PASS;
}

/** The next instruction: 1 byte what, 1 byte for how many frames; its operands follow. */
static void next_instruction(input_t *input)
{
    if (input->at >= input->end) {
        input->frames = ~0u;
        input->instruction = PASS;
        return;
    }
    input->instruction = (instruction_t)(take(input, 1) % INSTRUCTIONS);
    const unsigned frames = take(input, 1);
    /* To leave frames as they are costs an input little; what stops every frame for long would end each run early. */
    input->frames = input->instruction == PASS ? frames + 1 : frames % 8 + 1;
    input->operands = input->at;
}

static cm1e_tap_verdict_t on_frame(void *context, cm1e_tap_frame_t *frame)
{
    run_t *run = context;
    input_t *input = &run->input;
    if (frame->direction != CM1E_TAP_RECEIVED)
        return CM1E_TAP_PASS;
    if (input->frames == 0)
        next_instruction(input);
    if (!concerns(input->instruction, frame))
        return CM1E_TAP_PASS;
    input->at = input->operands ? input->operands : input->at;
    const cm1e_tap_verdict_t verdict = execute(run, frame);
    if (input->instruction != PASS || input->frames != ~0u)
        input->frames--;
    return verdict;
}

/* ---- what is done ----------------------------------------------------------------------------------------------- */

static int64_t now_of(const run_t *run) { return cm1e_clock_now(cm1e_bus_clock(run->bus)); }

/** What failed says so in words. */
static void check_result(const run_t *run, cm1e_error_t error, const char *what)
{
    if (error != CM1E_OK && (run->diag.error != error || strlen(run->diag.text) < 10))
        fuzz_fail("%s fails (%d) and says %d, \"%s\"", what, error, run->diag.error, run->diag.text);
    if (now_of(run) > LONGEST_RUN_S * INT64_C(1000000000))
        fuzz_fail("%s: %lld s have passed", what, (long long)(now_of(run) / 1000000000));
}

/** Memory of exactly this size: the sanitizer sees a byte beyond. */
static void *room_of(size_t bytes)
{
    void *room = malloc(bytes);
    if (!room)
        fuzz_fail("no memory");
    memset(room, 0, bytes);
    return room;
}

static void read_and_write(run_t *run)
{
    const struct {
        uint16_t index;
        uint8_t subindex;
        size_t room;
    } objects[] = {{0x1018, 1, 4}, {0x1008, 0, run->text_room}, {0x1C13, 0, 1}, {0x603F, 0, 2}};
    for (size_t i = 0; i < sizeof objects / sizeof objects[0]; i++) {
        uint8_t *data = room_of(objects[i].room);
        size_t size = objects[i].room;
        cm1e_error_t error =
            cm1e_sdo_read(run->bus, run->position, objects[i].index, objects[i].subindex, data, &size, &run->diag);
        if (error == CM1E_OK && size > objects[i].room)
            fuzz_fail("%zu bytes read into %zu", size, objects[i].room);
        check_result(run, error, "a read");
        if (objects[i].index == 0x1C13) {
            error = cm1e_sdo_write(run->bus, run->position, 0x6081, 0, data, 1, &run->diag);
            check_result(run, error, "a write");
        }
        free(data);
    }
}

static void read_dictionary(run_t *run)
{
    uint16_t *indexes = room_of(run->list_room * sizeof *indexes);
    size_t count = run->list_room;
    cm1e_object_info_t object;
    cm1e_entry_info_t entry;
    cm1e_error_t error = cm1e_sdo_info_list(run->bus, run->position, CM1E_OBJECTS_RXPDO, indexes, &count, &run->diag);
    check_result(run, error, "a list of objects");
    if (error == CM1E_OK && count > run->list_room)
        fuzz_fail("%zu objects in a list of %zu", count, run->list_room);
    free(indexes);
    error = cm1e_sdo_info_object(run->bus, run->position, 0x1018, &object, &run->diag);
    check_result(run, error, "the description of an object");
    error = cm1e_sdo_info_entry(run->bus, run->position, 0x6040, 0, &entry, &run->diag);
    check_result(run, error, "the description of an entry");
}

static void read_sii(run_t *run)
{
    uint8_t *image = room_of(run->sii_room);
    size_t size = run->sii_room;
    check_result(run, cm1e_sii_read_device(run->bus, run->position, image, &size, &run->diag), "an SII");
    free(image);
}

static void check_axis(const cm1e_axis_t *axis)
{
    cm1e_axis_info_t info;
    cm1e_axis_get(axis, &info);
    const double shown[] = {info.set_position, info.set_velocity, info.set_acceleration, info.actual_position,
                            info.actual_velocity, info.actual_torque, info.position_lag};
    for (size_t i = 0; i < sizeof shown / sizeof shown[0]; i++)
        if (!isfinite(shown[i]))
            fuzz_fail("value %zu of an axis is no number", i);
}

/** What a program would ask for in this cycle: power, then motion to and fro; a reset now and then. */
static void command_axis(cm1e_axis_t *axis, int cycle)
{
    static const int owner;
    cm1e_axis_info_t info;
    cm1e_command_id_t id;
    cm1e_axis_get(axis, &info);
    cm1e_axis_power(axis, &owner, true, true, true);
    if (info.state == CM1E_AXIS_STANDSTILL)
        cm1e_axis_start(axis, &(cm1e_axis_command_t){.kind = CM1E_COMMAND_MOVE_RELATIVE, .velocity = 5,
                                                     .position = cycle % 2 ? 1 : -1}, &id);
    else if (info.state == CM1E_AXIS_ERROR_STOP && cycle % 16 == 0)
        cm1e_axis_reset(axis);
    check_axis(axis);
}

static void one_cycle(run_t *run, int number)
{
    const int64_t now_ns = now_of(run);
    const bool with_axes = run->axes[0] != NULL;
    const cm1e_error_t received = cm1e_bus_receive(run->bus);
    for (uint32_t i = 0; with_axes && i < run->config.axis_count; i++) {
        cm1e_axis_inputs(run->axes[i], received, cm1e_bus_health(run->bus), now_ns);
        command_axis(run->axes[i], number);
    }
    for (uint32_t i = 0; with_axes && i < run->config.axis_count; i++)
        cm1e_axis_outputs(run->axes[i]);
    cm1e_bus_send(run->bus);
    cm1e_clock_sleep_until(cm1e_bus_clock(run->bus), now_ns + run->config.cycle_time_ns);
}

/** Cycles, with a transfer under way in them. */
static void operate(run_t *run)
{
    uint8_t *data = room_of(run->text_room);
    cm1e_sdo_t sdo = {.position = run->position, .index = 0x1008, .data = data, .size = run->text_room,
                      .timeout_ns = 20000000};
    bool submitted = cm1e_sdo_submit(run->bus, &sdo) == CM1E_OK;
    char line[64], answer[256];
    snprintf(line, sizeof line, "power-cycle %u 10", run->position);
    for (int i = 0; i < CYCLES; i++) {
        one_cycle(run, i);
        if (submitted && cm1e_sdo_state(&sdo) != CM1E_SDO_BUSY) {
            if (sdo.size > run->text_room)
                fuzz_fail("%zu bytes read into %zu", sdo.size, run->text_room);
            sdo.size = run->text_room;
            submitted = cm1e_sdo_submit(run->bus, &sdo) == CM1E_OK;
        }
        if (i == CYCLES / 3 && run->doing & DO_POWER_CYCLE)
            cm1e_bus_simulate(run->bus, line, answer, sizeof answer);
        if (i == CYCLES / 2)
            cm1e_bus_request_recovery(run->bus, run->position);
    }
    cm1e_bus_stop(run->bus); /* ends every transfer */
    if (submitted && cm1e_sdo_state(&sdo) == CM1E_SDO_BUSY)
        fuzz_fail("a transfer goes on after the bus has stopped");
    free(data);
}

static void destroy_axes(run_t *run)
{
    for (unsigned i = 0; i < CM1E_BRIDGE_AXES; i++) {
        if (run->axes[i])
            cm1e_axis_destroy(run->axes[i]);
        run->axes[i] = NULL;
    }
}

/** All axes or none: one at a bridge asks by SDO, which may fail. */
static bool create_axes(run_t *run)
{
    cm1e_error_t error = CM1E_OK;
    for (uint32_t i = 0; i < run->config.axis_count && run->doing & DO_AXIS && error == CM1E_OK; i++)
        error = cm1e_axis_create(&run->axes[i], run->bus, i, &run->diag);
    check_result(run, error, "an axis");
    return error == CM1E_OK;
}

static void use_bus(run_t *run)
{
    cm1e_error_t error = cm1e_bus_scan(run->bus, &run->diag);
    check_result(run, error, "a scan");
    if (error == CM1E_OK && run->doing & DO_SDO)
        read_and_write(run);
    if (error == CM1E_OK && run->doing & DO_INFO)
        read_dictionary(run);
    if (error == CM1E_OK && run->doing & DO_SII)
        read_sii(run);
    if (error == CM1E_OK)
        check_result(run, error = cm1e_bus_identify(run->bus, &run->diag), "identification");
    if (error == CM1E_OK)
        check_result(run, error = cm1e_bus_configure(run->bus, &run->diag), "configuration");
    if (error == CM1E_OK)
        check_result(run, error = cm1e_bus_operate(run->bus, &run->diag), "the way to Operational");
    if (error == CM1E_OK && create_axes(run))
        operate(run);
    cm1e_bus_stop(run->bus);
    destroy_axes(run);
    check_result(run, CM1E_OK, "the stop");
}

/** Nothing that was heard may last. A motor whose supply was switched off has to start first. */
static void use_it_honestly(run_t *run)
{
    cm1e_nic_set_tap(cm1e_bus_nic(run->bus), NULL, NULL);
    cm1e_clock_sleep_until(cm1e_bus_clock(run->bus), now_of(run) + INT64_C(5000000000));
    if (cm1e_bus_start(run->bus, &run->diag) != CM1E_OK)
        fuzz_fail("on honest frames the bus does not start: %s", run->diag.text);
    for (int i = 0; i < SETTLE_CYCLES; i++)
        one_cycle(run, i);
    if (cm1e_bus_health(run->bus) != CM1E_OK)
        fuzz_fail("on honest frames the bus is not well: %s", cm1e_strerror(cm1e_bus_health(run->bus)));
}

/* ---- the network ------------------------------------------------------------------------------------------------ */

/** By the first byte: a motor of two firmwares, one beside simple slaves, a bridge with four; as a line or a ring; a line
 *  also with overlapped process data. */
static void describe_network(cm1e_bus_config_t *config, unsigned kind)
{
    enum { MOTOR, OLD_MOTOR, TERMINALS, BRIDGE };
    const unsigned network = kind % 4;
    cm1e_bus_config_init(config, "sim", network == BRIDGE ? CM1E_BRIDGE_AXES : 1);
    config->virtual_time = true;
    config->sim_pdo_order = kind & 8 ? CM1E_PDO_ORDER_UG_7_2 : CM1E_PDO_ORDER_UG_4_4;
    config->sim_gaps = kind & 16 ? CM1E_SIM_IO_TERMINAL : CM1E_SIM_IO_COUPLER;
    if (kind & 4)
        strcpy(config->second_interface, "sim-second");
    config->overlap = kind & 32 && !(kind & 4);
    cm1e_axis_config_t *axis = &config->axes[0];
    strcpy(axis->firmware, network == OLD_MOTOR ? "1.2.0" : network == BRIDGE ? "" : "1.3.5");
    if (network == OLD_MOTOR)
        axis->mapping = CM1E_MAPPING_CSP;
    if (network == TERMINALS)
        axis->address = 2;
    for (uint32_t i = 0; network == BRIDGE && i < CM1E_BRIDGE_AXES; i++) {
        axis = &config->axes[i];
        axis->address = 1;
        axis->channel = (uint8_t)(i + 1);
        axis->k37 = 10;
        axis->k37_stated = true;
        strcpy(axis->motor, i < 2 ? "CM1" : "CM2");
        axis->firmware[0] = 0;
    }
}

bool fuzz_rewrite(cm1e_file_t *written, const uint8_t *bytes, size_t size, bool must)
{
    (void)written;
    (void)must;
    run_t *run = room_of(sizeof *run);
    run->input = (input_t){.at = bytes, .end = bytes + size};
    describe_network(&run->config, take(&run->input, 1));
    run->doing = (uint8_t)take(&run->input, 1);
    const unsigned rooms = take(&run->input, 1);
    run->text_room = text_rooms[rooms % 4];
    run->list_room = list_rooms[rooms / 4 % 4];
    run->sii_room = sii_rooms[rooms / 16 % 4];
    run->position = (uint16_t)cm1e_axis_address(&run->config, 0);
    if (cm1e_bus_open(&run->bus, &run->config, &run->diag) != CM1E_OK)
        fuzz_fail("no bus: %s", run->diag.text);
    cm1e_nic_set_tap(cm1e_bus_nic(run->bus), on_frame, run);
    use_bus(run);
    use_it_honestly(run);
    cm1e_bus_close(run->bus);
    cm1e_bus_config_free(&run->config);
    free(run);
    return false;
}

/** The answers to a read as a slave would give them that sends a text of 300 bytes in segments. */
static void seed_segments(void)
{
    uint8_t script[] = {
        0, DO_SDO, 2, PASS_MAILBOX, 1, /* firmware and identity */
        MAILBOX, 0, 1, 0, 1, 122, 0, 8, 7, 0x41, 0x08, 0x10, 0, 44, 1, 0, 0, /* 112 of 300 bytes */
        MAILBOX, 0, 1, 0, 1, 115, 0, 6, 2, 0, 0x30, 0x00,
        MAILBOX, 0, 1, 0, 1, 79, 0, 6, 2, 0, 0x30, 0x11,
    };
    fuzz_seed("segments.bin", script, sizeof script);
    script[sizeof script - 7] = 122; /* more than are left */
    fuzz_seed("segments_too_long.bin", script, sizeof script);
}

/** Every network with everything done on it, and each instruction at some moments of a start. */
void fuzz_seeds(void)
{
    char name[32];
    for (unsigned kind = 0; kind < 8; kind++) {
        const uint8_t whole[] = {(uint8_t)kind, DO_SDO | DO_INFO | DO_AXIS | (kind % 2 ? DO_SII : DO_POWER_CYCLE),
                                 (uint8_t)(kind * 5)};
        snprintf(name, sizeof name, "network_%u.bin", kind);
        fuzz_seed(name, whole, sizeof whole);
    }
    for (unsigned instruction = DROP; instruction < INSTRUCTIONS; instruction++) {
        uint8_t script[200] = {(uint8_t)(instruction % 4), (uint8_t)(DO_AXIS | 1 << instruction % 3)};
        size_t size = 3;
        for (unsigned n = 0; n < 12; n++) {
            const uint8_t step[] = {PASS, (uint8_t)(n * 37), (uint8_t)instruction, (uint8_t)(n % 3), (uint8_t)(n * 29),
                                    (uint8_t)(n * 5), (uint8_t)n, 1, 2, 3};
            memcpy(script + size, step, sizeof step);
            size += sizeof step;
        }
        snprintf(name, sizeof name, "instruction_%u.bin", instruction);
        fuzz_seed(name, script, size);
    }
    seed_segments();
}
