/* Doubles for the tests of the slave controller: an application that records, a master that sends single frames. */
#ifndef SIM_FAKE_APP_H
#define SIM_FAKE_APP_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cm1e/bus.h"
#include "core/bytes.h"
#include "description/describe.h"
#include "description/sii_image.h"
#include "sim/segment.h"
#include "sim/slave.h"
#include "unity.h"

/* ---- dictionary ------------------------------------------------------------------------------------------------ */

enum { FAKE_OBJECTS = 170, FAKE_ENTRIES = 400, FAKE_VALUE_MAX = 700 };

typedef struct fake_value {
    cm1e_entry_t entry;
    uint8_t bytes[FAKE_VALUE_MAX];
    size_t size;
} fake_value_t;

typedef struct fake_app {
    uint16_t output_bytes, input_bytes;
    uint8_t veto_state;             /* a change to this state is refused with ... */
    uint16_t veto_code;
    uint8_t from, to;               /* last state change */
    unsigned state_changes, outputs_taken, watchdogs, power_ons, sdo_writes, destroyed;
    uint8_t outputs[64], inputs[64];
    uint16_t outputs_size;
    uint16_t id;
    unsigned object_count, value_count;
    cm1e_object_t objects[FAKE_OBJECTS];
    fake_value_t values[FAKE_ENTRIES];
    cm1e_entry_t entries[FAKE_ENTRIES];
} fake_app_t;

static inline fake_value_t *fake_value(fake_app_t *app, uint16_t index, uint8_t subindex)
{
    for (unsigned i = 0; i < app->value_count; i++)
        if (app->values[i].entry.index == index && app->values[i].entry.subindex == subindex)
            return &app->values[i];
    return NULL;
}

static inline void fake_object(fake_app_t *app, uint16_t index, uint8_t code, uint8_t highest, const char *name)
{
    app->objects[app->object_count++] =
        (cm1e_object_t){.index = index, .object_code = code, .highest_subindex = highest, .name = name,
                        .entries = &app->entries[app->value_count]};
}

static inline fake_value_t *fake_entry(fake_app_t *app, uint8_t subindex, uint8_t access, cm1e_data_type_t type,
                                       uint16_t bits, uint64_t value)
{
    cm1e_object_t *object = &app->objects[app->object_count - 1];
    fake_value_t *v = &app->values[app->value_count];
    v->entry = (cm1e_entry_t){.index = object->index, .subindex = subindex, .access = access, .type = type,
                              .bits = bits, .name = "entry", .unit = "", .default_value = (int64_t)value,
                              .minimum = -5, .maximum = 7};
    v->size = (bits + 7u) / 8u;
    cm1e_put_uint(v->bytes, v->size < 8 ? (unsigned)v->size : 8, value);
    app->entries[app->value_count++] = v->entry;
    object->entry_count++;
    return v;
}

enum { R = CM1E_ACCESS_READ, W = CM1E_ACCESS_WRITE };

/* The objects that the tests of SDO access use, then many more, so that lists have to be sent in fragments. */
static inline void fake_dictionary(fake_app_t *app)
{
    fake_object(app, 0x1000, CM1E_OBJECT_VAR, 0, "Device type");
    fake_entry(app, 0, R, CM1E_TYPE_UDINT, 32, 0x00040192);
    fake_object(app, 0x1008, CM1E_OBJECT_VAR, 0, "Short string");
    memcpy(fake_entry(app, 0, R, CM1E_TYPE_STRING, 40, 0)->bytes, "CM1-E", 5);
    fake_object(app, 0x1009, CM1E_OBJECT_VAR, 0, "Long string");
    fake_value_t *text = fake_entry(app, 0, R | W, CM1E_TYPE_STRING, 600 * 8, 0);
    for (unsigned i = 0; i < 600; i++)
        text->bytes[i] = (uint8_t)('a' + i % 26);
    fake_object(app, 0x2000, CM1E_OBJECT_VAR, 0, "Byte");
    fake_entry(app, 0, R | W | CM1E_ACCESS_RXPDO, CM1E_TYPE_USINT, 8, 17);
    fake_object(app, 0x2001, CM1E_OBJECT_VAR, 0, "Double word");
    fake_entry(app, 0, R | W | CM1E_ACCESS_TXPDO, CM1E_TYPE_UDINT, 32, 0x12345678);
    fake_object(app, 0x2003, CM1E_OBJECT_VAR, 0, "Write only");
    fake_entry(app, 0, W, CM1E_TYPE_UINT, 16, 0xAFFE);
    fake_object(app, 0x2010, CM1E_OBJECT_RECORD, 5, "Record with a gap");
    fake_entry(app, 0, R, CM1E_TYPE_USINT, 8, 5);
    fake_entry(app, 1, R | W, CM1E_TYPE_USINT, 8, 0x11);
    fake_entry(app, 2, R | W, CM1E_TYPE_UDINT, 32, 0x22222222);
    fake_entry(app, 4, R, CM1E_TYPE_UINT, 16, 0x4444);
    fake_entry(app, 5, W, CM1E_TYPE_UINT, 16, 0x5555);
    fake_object(app, 0x2011, CM1E_OBJECT_ARRAY, 100, "Large array");
    fake_entry(app, 0, R, CM1E_TYPE_USINT, 8, 100);
    for (unsigned sub = 1; sub <= 100; sub++)
        fake_entry(app, (uint8_t)sub, R | W, CM1E_TYPE_UDINT, 32, sub * 0x01010101u);
    fake_object(app, 0x2012, CM1E_OBJECT_ARRAY, 4, "Assignment");
    fake_entry(app, 0, R | W, CM1E_TYPE_USINT, 8, 1);
    for (unsigned sub = 1; sub <= 4; sub++)
        fake_entry(app, (uint8_t)sub, R | W, CM1E_TYPE_UINT, 16, 0x1600 + sub - 1);
    for (uint16_t index = 0x3000; app->object_count < FAKE_OBJECTS; index++) {
        fake_object(app, index, CM1E_OBJECT_VAR, 0, "One of many");
        fake_entry(app, 0, R, CM1E_TYPE_UINT, 16, index);
    }
}

/* ---- application ----------------------------------------------------------------------------------------------- */

static inline uint16_t fake_state_change(void *context, uint8_t from, uint8_t to)
{
    fake_app_t *app = context;
    app->from = from;
    app->to = to;
    app->state_changes++;
    return to == app->veto_state ? app->veto_code : 0;
}
static inline void fake_sizes(void *context, uint16_t *outputs, uint16_t *inputs)
{
    *outputs = ((fake_app_t *)context)->output_bytes;
    *inputs = ((fake_app_t *)context)->input_bytes;
}
static inline void fake_outputs(void *context, const uint8_t *data, uint16_t size, int64_t now_ns)
{
    fake_app_t *app = context;
    (void)now_ns;
    app->outputs_taken++;
    app->outputs_size = size;
    memcpy(app->outputs, data, size < sizeof app->outputs ? size : sizeof app->outputs);
}
static inline void fake_inputs(void *context, uint8_t *data, uint16_t size)
{
    fake_app_t *app = context;
    for (unsigned i = 0; i < size; i++)
        data[i] = i < sizeof app->inputs ? app->inputs[i] : 0xEE;
}
static inline void fake_watchdog(void *context) { ((fake_app_t *)context)->watchdogs++; }
static inline uint32_t fake_abort(fake_app_t *app, uint16_t index)
{
    for (unsigned i = 0; i < app->object_count; i++)
        if (app->objects[i].index == index)
            return SDO_ABORT_NO_SUBINDEX;
    return SDO_ABORT_NO_OBJECT;
}
static inline uint32_t fake_sdo_read(void *context, uint16_t index, uint8_t subindex, uint8_t al_state, uint8_t *data,
                                     size_t *size)
{
    (void)al_state;
    fake_value_t *v = fake_value(context, index, subindex);
    if (!v)
        return fake_abort(context, index);
    if (!(v->entry.access & CM1E_ACCESS_READ))
        return SDO_ABORT_WRITE_ONLY;
    if (v->size > *size)
        return SDO_ABORT_MEMORY;
    memcpy(data, v->bytes, v->size);
    *size = v->size;
    return 0;
}
static inline uint32_t fake_sdo_write(void *context, uint16_t index, uint8_t subindex, uint8_t al_state,
                                      const uint8_t *data, size_t size)
{
    (void)al_state;
    ((fake_app_t *)context)->sdo_writes++;
    fake_value_t *v = fake_value(context, index, subindex);
    if (!v)
        return fake_abort(context, index);
    if (!(v->entry.access & CM1E_ACCESS_WRITE))
        return SDO_ABORT_READ_ONLY;
    const size_t bytes = (v->entry.bits + 7u) / 8u;
    if (size > bytes)
        return SDO_ABORT_TOO_LONG;
    if (size < bytes && v->entry.type != CM1E_TYPE_STRING)
        return SDO_ABORT_TOO_SHORT;
    memcpy(v->bytes, data, size);
    v->size = size;
    return 0;
}
static inline const cm1e_object_t *fake_nth_object(void *context, size_t n)
{
    fake_app_t *app = context;
    return n < app->object_count ? &app->objects[n] : NULL;
}
static inline const cm1e_entry_t *fake_nth_entry(void *context, uint16_t index, uint8_t subindex)
{
    const fake_value_t *v = fake_value(context, index, subindex);
    return v ? &v->entry : NULL;
}
static inline uint16_t fake_id(void *context) { return ((fake_app_t *)context)->id; }
static inline void fake_power_on(void *context, int64_t now_ns)
{
    (void)now_ns;
    ((fake_app_t *)context)->power_ons++;
}
static inline void fake_destroy(void *context) { ((fake_app_t *)context)->destroyed++; }

static const cm1e_sim_app_ops_t fake_ops = {
    .state_change = fake_state_change, .process_data_sizes = fake_sizes, .outputs = fake_outputs, .inputs = fake_inputs,
    .watchdog_expired = fake_watchdog, .sdo_read = fake_sdo_read, .sdo_write = fake_sdo_write,
    .object = fake_nth_object, .entry = fake_nth_entry, .explicit_device_id = fake_id, .power_on = fake_power_on,
    .destroy = fake_destroy,
};

/* ---- segment and master ---------------------------------------------------------------------------------------- */

enum { COMMAND_NOP, APRD, APWR, APRW, FPRD, FPWR, FPRW, BRD, BWR, BRW, LRD, LWR, LRW, ARMW, FRMW };
enum { FRAME_MAX = 1514, FAKE_SLAVES_MAX = 8, STATION = 0x1001 };

typedef struct bench {
    cm1e_sim_segment_t *segment;
    fake_app_t *apps[FAKE_SLAVES_MAX];
    unsigned count;
    int64_t now_ns;
    int port, came_out;
    uint16_t events, position;   /* of the last datagram's header */
    uint8_t frame[FRAME_MAX];
    uint8_t mailbox_counter, answer[256];
} bench_t;

static inline void bench_open_with(bench_t *b, unsigned count, const uint8_t *sii, size_t size)
{
    memset(b, 0, sizeof *b);
    b->segment = cm1e_sim_segment_create_empty();
    b->count = count;
    b->now_ns = 1000000000;
    for (unsigned i = 0; i < count; i++) {
        b->apps[i] = calloc(1, sizeof *b->apps[i]);
        b->apps[i]->output_bytes = 13;
        b->apps[i]->input_bytes = 21;
        b->apps[i]->id = (uint16_t)(0x20 + i);
        fake_dictionary(b->apps[i]);
        TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_sim_segment_add(b->segment, cm1e_sim_slave_create(sii, size, &fake_ops,
                                                                                              b->apps[i])));
    }
}

/* The image of a CM1-E of the newest firmware. */
static inline void fake_sii(uint8_t image[CM1E_SII_SIZE], uint16_t alias, uint32_t serial_number)
{
    const cm1e_device_options_t options = {.alias = alias, .serial_number = serial_number};
    cm1e_description_file_t file = {0};
    TEST_ASSERT_EQUAL_INT(CM1E_OK, cm1e_describe(&file, &options, CM1E_ESI_FLAT, NULL));
    TEST_ASSERT_EQUAL_size_t(CM1E_SII_SIZE, cm1e_sii_write(image, CM1E_SII_SIZE, &file.devices.at[0], NULL));
    cm1e_description_file_free(&file);
}

static inline void bench_open(bench_t *b, unsigned count)
{
    uint8_t sii[CM1E_SII_SIZE];
    fake_sii(sii, 0x4711, 0);
    bench_open_with(b, count, sii, sizeof sii);
}

static inline void bench_close(bench_t *b)
{
    cm1e_sim_segment_destroy(b->segment);
    for (unsigned i = 0; i < b->count; i++) {
        TEST_ASSERT_EQUAL_UINT(1, b->apps[i]->destroyed);
        free(b->apps[i]);
    }
}

static inline void bench_wait(bench_t *b, int64_t ns)
{
    b->now_ns += ns;
    cm1e_sim_segment_advance(b->segment, b->now_ns);
}

/* A frame with nothing in it yet. */
static inline size_t frame_begin(uint8_t *frame)
{
    memset(frame, 0, FRAME_MAX);
    memset(frame, 0xFF, 6);
    memset(frame + 6, 0x01, 6);
    frame[12] = 0x88;
    frame[13] = 0xA4;
    cm1e_put_u16(frame + 14, 0x1000);
    return 16;
}

/* Adds a datagram behind `at`; returns the new end. */
static inline size_t frame_add(uint8_t *frame, size_t at, uint8_t command, uint32_t address, const void *data,
                               uint16_t length)
{
    /* The one before it is followed by another. */
    for (size_t before = 16; before < at;) {
        const uint16_t l = cm1e_get_u16(frame + before + 6);
        const size_t next = before + 12 + (l & 0x7FF);
        if (next == at)
            cm1e_put_u16(frame + before + 6, l | 0x8000);
        before = next;
    }
    frame[at] = command;
    frame[at + 1] = 0x55;
    cm1e_put_u32(frame + at + 2, address);
    cm1e_put_u16(frame + at + 6, length);
    memcpy(frame + at + 10, data, length);
    const size_t end = at + 12 + length;
    cm1e_put_u16(frame + 14, (uint16_t)(0x1000 | (end - 16)));
    return end;
}

/* Sends one datagram and takes the data back; the working counter, -1: the frame is lost. */
static inline int send_logical(bench_t *b, uint8_t command, uint32_t address, void *data, uint16_t length)
{
    const size_t end = frame_add(b->frame, frame_begin(b->frame), command, address, data, length);
    b->came_out = cm1e_sim_segment_process(b->segment, b->port, b->frame, end, b->now_ns);
    if (b->came_out == CM1E_SIM_PORT_LOST)
        return -1;
    memcpy(data, b->frame + 26, length);
    b->position = cm1e_get_u16(b->frame + 18);
    b->events = cm1e_get_u16(b->frame + 24);
    return cm1e_get_u16(b->frame + end - 2);
}

static inline int send_to(bench_t *b, uint8_t command, uint16_t adp, uint16_t ado, void *data, uint16_t length)
{
    return send_logical(b, command, adp | (uint32_t)ado << 16, data, length);
}

static inline uint16_t read_u16(bench_t *b, unsigned slave, uint16_t ado)
{
    uint8_t data[2] = {0};
    TEST_ASSERT_EQUAL_INT(1, send_to(b, APRD, (uint16_t)-slave, ado, data, 2));
    return cm1e_get_u16(data);
}
static inline uint8_t read_u8(bench_t *b, unsigned slave, uint16_t ado)
{
    uint8_t data[1] = {0};
    TEST_ASSERT_EQUAL_INT(1, send_to(b, APRD, (uint16_t)-slave, ado, data, 1));
    return data[0];
}
static inline uint32_t read_u32(bench_t *b, unsigned slave, uint16_t ado)
{
    uint8_t data[4] = {0};
    TEST_ASSERT_EQUAL_INT(1, send_to(b, APRD, (uint16_t)-slave, ado, data, 4));
    return cm1e_get_u32(data);
}
static inline int write_bytes(bench_t *b, unsigned slave, uint16_t ado, const void *data, uint16_t length)
{
    uint8_t copy[FRAME_MAX];
    memcpy(copy, data, length);
    return send_to(b, APWR, (uint16_t)-slave, ado, copy, length);
}
static inline int write_u16(bench_t *b, unsigned slave, uint16_t ado, uint16_t value)
{
    uint8_t data[2];
    cm1e_put_u16(data, value);
    return write_bytes(b, slave, ado, data, 2);
}
static inline int write_u8(bench_t *b, unsigned slave, uint16_t ado, uint8_t value)
{
    return write_bytes(b, slave, ado, &value, 1);
}

static inline void write_sm(bench_t *b, unsigned slave, unsigned number, uint16_t start, uint16_t length,
                            uint8_t control, uint8_t activate)
{
    uint8_t sm[8] = {0};
    cm1e_put_u16(sm, start);
    cm1e_put_u16(sm + 2, length);
    sm[4] = control;
    sm[6] = activate;
    TEST_ASSERT_EQUAL_INT(1, write_bytes(b, slave, (uint16_t)(0x800 + 8 * number), sm, 8));
}

static inline void write_fmmu(bench_t *b, unsigned slave, unsigned number, uint32_t logical, uint16_t length,
                              uint8_t start_bit, uint8_t end_bit, uint16_t physical, uint8_t physical_bit, uint8_t type)
{
    uint8_t fmmu[16] = {0};
    cm1e_put_u32(fmmu, logical);
    cm1e_put_u16(fmmu + 4, length);
    fmmu[6] = start_bit;
    fmmu[7] = end_bit;
    cm1e_put_u16(fmmu + 8, physical);
    fmmu[10] = physical_bit;
    fmmu[11] = type;
    fmmu[12] = 1;
    TEST_ASSERT_EQUAL_INT(1, write_bytes(b, slave, (uint16_t)(0x600 + 16 * number), fmmu, 16));
}

/* Requests a state and waits; AL status afterwards. */
static inline uint16_t request_state(bench_t *b, unsigned slave, uint16_t control)
{
    write_u16(b, slave, 0x120, control);
    bench_wait(b, 1000000);
    return read_u16(b, slave, 0x130);
}

static inline void configure_mailboxes(bench_t *b, unsigned slave)
{
    write_sm(b, slave, 0, 0x1000, 128, 0x26, 1);
    write_sm(b, slave, 1, 0x1080, 128, 0x22, 1);
}
static inline void configure_process_data(bench_t *b, unsigned slave)
{
    write_sm(b, slave, 2, 0x1100, b->apps[slave]->output_bytes, 0x64, 1);
    write_sm(b, slave, 3, 0x1400, b->apps[slave]->input_bytes, 0x20, 1);
}

/* From power-on to a state, everything configured as it should be. */
static inline void bring_to(bench_t *b, unsigned slave, uint8_t state)
{
    if (state >= CM1E_AL_PRE_OP) {
        configure_mailboxes(b, slave);
        TEST_ASSERT_EQUAL_HEX16(CM1E_AL_PRE_OP, request_state(b, slave, CM1E_AL_PRE_OP));
    }
    if (state >= CM1E_AL_SAFE_OP) {
        configure_process_data(b, slave);
        TEST_ASSERT_EQUAL_HEX16(CM1E_AL_SAFE_OP, request_state(b, slave, CM1E_AL_SAFE_OP));
    }
    if (state >= CM1E_AL_OP)
        TEST_ASSERT_EQUAL_HEX16(CM1E_AL_OP, request_state(b, slave, CM1E_AL_OP));
}

/* ---- mailbox --------------------------------------------------------------------------------------------------- */

/* Writes a mailbox with the given counter; the working counter. */
static inline int mailbox_put(bench_t *b, uint8_t type, uint8_t counter, const void *data, uint16_t length)
{
    uint8_t box[128] = {0};
    cm1e_put_u16(box, length);
    box[5] = (uint8_t)(type | counter << 4);
    memcpy(box + 6, data, length);
    return write_bytes(b, 0, 0x1000, box, sizeof box);
}

/* Reads the mailbox when there is something in it; its type and counter byte, -1: nothing for 5 ms. The data behind the
 * mailbox header is in b->answer. */
static inline int mailbox_get(bench_t *b, uint16_t *length)
{
    for (int i = 0; i < 50; i++) {
        bench_wait(b, 100000);
        if (!(read_u8(b, 0, 0x080D) & 0x08))
            continue;
        uint8_t box[128] = {0};
        TEST_ASSERT_EQUAL_INT(1, send_to(b, APRD, 0, 0x1080, box, sizeof box));
        *length = cm1e_get_u16(box);
        TEST_ASSERT_LESS_OR_EQUAL_UINT16(122, *length);
        memset(b->answer, 0, sizeof b->answer);
        memcpy(b->answer, box + 6, *length);
        return box[5];
    }
    return -1;
}

/* Request and answer with a fresh counter; the mailbox type of the answer, -1: none. */
static inline int mailbox_ask(bench_t *b, uint8_t type, const void *data, uint16_t length, uint16_t *answer_length)
{
    b->mailbox_counter = (uint8_t)(b->mailbox_counter % 7 + 1);
    TEST_ASSERT_EQUAL_INT(1, mailbox_put(b, type, b->mailbox_counter, data, length));
    const int got = mailbox_get(b, answer_length);
    return got < 0 ? got : got & 0x0F;
}

#endif
