/**
 * @file sim_cm1e_bench.h
 * A simulated CM1-E on the test bench, without a slave controller: process data by object, in the layout that its
 * mapping objects state, and simulated time.
 */
#ifndef SIM_CM1E_BENCH_H
#define SIM_CM1E_BENCH_H

#include <string.h>

#include "core/bytes.h"
#include "sim/cm1e_app.h"
#include "unity.h"

enum { BENCH_INIT = 1, BENCH_PREOP = 2, BENCH_SAFEOP = 4, BENCH_OP = 8 };
enum { BENCH_MS = 1000000, BENCH_IMAGE_BYTES = 64 };

typedef struct bench {
    cm1e_sim_cm1e_t *drive;
    const cm1e_sim_app_ops_t *ops;
    int64_t now_ns, cycle_ns;
    cm1e_pdo_t rx, tx;
    /* what the master wants */
    uint16_t controlword, digital_outputs;
    int32_t target_position, target_velocity;
    uint32_t profile_velocity, profile_acceleration;
    int8_t mode;
    /* what it gets */
    uint16_t statusword, error_code, digital_inputs;
    int32_t position, velocity;
    int16_t torque, temperature, dc_link;
    int8_t mode_display;
} bench_t;

static inline int64_t bench_read(bench_t *b, uint16_t index, uint8_t subindex)
{
    uint8_t data[8] = {0};
    size_t size = sizeof data;
    const uint32_t code = b->ops->sdo_read(b->drive, index, subindex, b->drive->al_state, data, &size);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, code, "SDO read");
    return (int64_t)cm1e_get_uint(data, (unsigned)size);
}

static inline uint32_t bench_try_write(bench_t *b, uint16_t index, uint8_t subindex, int64_t value)
{
    const cm1e_entry_t *entry = b->ops->entry(b->drive, index, subindex);
    uint8_t data[8];
    cm1e_put_uint(data, 8, (uint64_t)value);
    return b->ops->sdo_write(b->drive, index, subindex, b->drive->al_state, data, entry ? entry->bits / 8u : 4);
}

static inline void bench_write(bench_t *b, uint16_t index, uint8_t subindex, int64_t value)
{
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, bench_try_write(b, index, subindex, value), "SDO write");
}

/* The layout as a master reads it from the device. */
static inline void bench_read_mapping(bench_t *b, uint16_t assign, cm1e_pdo_t *pdo)
{
    pdo->index = (uint16_t)bench_read(b, assign, 1);
    pdo->entry_count = (uint8_t)bench_read(b, pdo->index, 0);
    for (uint8_t i = 0; i < pdo->entry_count; i++) {
        const uint32_t value = (uint32_t)bench_read(b, pdo->index, (uint8_t)(i + 1));
        pdo->entries[i] = (cm1e_pdo_entry_t){(uint16_t)(value >> 16), (uint8_t)(value >> 8), (uint8_t)value};
    }
}

static inline uint64_t bench_output(const bench_t *b, uint16_t index)
{
    switch (index) {
    case 0x6040: return b->controlword;
    case 0x60FE: return b->digital_outputs;
    case 0x607A: return (uint32_t)b->target_position;
    case 0x60FF: return (uint32_t)b->target_velocity;
    case 0x6060: return (uint8_t)b->mode;
    case 0x6081: return b->profile_velocity;
    case 0x6083: return b->profile_acceleration;
    default: TEST_FAIL_MESSAGE("an output that the bench does not know"); return 0;
    }
}

static inline void bench_input(bench_t *b, uint16_t index, uint64_t value)
{
    switch (index) {
    case 0x6041: b->statusword = (uint16_t)value; break;
    case 0x603F: b->error_code = (uint16_t)value; break;
    case 0x60FD: b->digital_inputs = (uint16_t)value; break;
    case 0x6064: b->position = (int32_t)value; break;
    case 0x606C: b->velocity = (int32_t)value; break;
    case 0x6077: b->torque = (int16_t)value; break;
    case 0x2301: b->temperature = (int16_t)value; break;
    case 0x6079: b->dc_link = (int16_t)value; break;
    case 0x6061: b->mode_display = (int8_t)value; break;
    default: TEST_FAIL_MESSAGE("an input that the bench does not know");
    }
}

static inline void bench_get_inputs(bench_t *b)
{
    uint8_t image[BENCH_IMAGE_BYTES] = {0};
    uint16_t out, in;
    b->ops->process_data_sizes(b->drive, &out, &in);
    b->ops->inputs(b->drive, image, in);
    const uint8_t *p = image;
    for (uint8_t i = 0; i < b->tx.entry_count; p += b->tx.entries[i++].bits / 8)
        bench_input(b, b->tx.entries[i].index, cm1e_get_uint(p, b->tx.entries[i].bits / 8u));
    TEST_ASSERT_EQUAL(in, p - image);
}

static inline void bench_put_outputs(bench_t *b)
{
    uint8_t image[BENCH_IMAGE_BYTES] = {0}, *p = image;
    for (uint8_t i = 0; i < b->rx.entry_count; p += b->rx.entries[i++].bits / 8)
        cm1e_put_uint(p, b->rx.entries[i].bits / 8u, bench_output(b, b->rx.entries[i].index));
    b->ops->outputs(b->drive, image, (uint16_t)(p - image), b->now_ns);
}

/* Time passes, then a frame takes outputs to the drive and inputs back. */
static inline void bench_cycle(bench_t *b)
{
    b->now_ns += b->cycle_ns;
    b->ops->advance(b->drive, b->now_ns);
    bench_put_outputs(b);
    bench_get_inputs(b);
}

static inline void bench_run(bench_t *b, double seconds)
{
    for (const int64_t end_ns = b->now_ns + (int64_t)(seconds * 1e9); b->now_ns < end_ns;)
        bench_cycle(b);
}

/* Runs until bits of the statusword are as wanted; FALSE: not within the time. */
static inline bool bench_until(bench_t *b, uint16_t mask, uint16_t value, double seconds)
{
    for (const int64_t end_ns = b->now_ns + (int64_t)(seconds * 1e9); b->now_ns < end_ns;) {
        bench_cycle(b);
        if ((b->statusword & mask) == value)
            return true;
    }
    return false;
}

static inline void bench_to_op(bench_t *b)
{
    TEST_ASSERT_EQUAL_HEX16(0, b->ops->state_change(b->drive, BENCH_INIT, BENCH_PREOP));
    TEST_ASSERT_EQUAL_HEX16(0, b->ops->state_change(b->drive, BENCH_PREOP, BENCH_SAFEOP));
    TEST_ASSERT_EQUAL_HEX16(0, b->ops->state_change(b->drive, BENCH_SAFEOP, BENCH_OP));
    bench_read_mapping(b, 0x1C12, &b->rx);
    bench_read_mapping(b, 0x1C13, &b->tx);
}

/* In OP, with the default mapping; NULL configuration: all defaults. */
static inline void bench_open(bench_t *b, const cm1e_axis_config_t *config, cm1e_pdo_order_t order)
{
    static const cm1e_axis_config_t defaults;
    memset(b, 0, sizeof *b);
    b->drive = cm1e_sim_cm1e_create_app(config ? config : &defaults, order, 0, 0);
    TEST_ASSERT_NOT_NULL(b->drive);
    b->ops = cm1e_sim_cm1e_ops(b->drive);
    b->now_ns = 1000 * (int64_t)BENCH_MS;
    b->cycle_ns = BENCH_MS;
    b->ops->power_on(b->drive, b->now_ns);
    bench_to_op(b);
}

static inline void bench_close(bench_t *b) { b->ops->destroy(b->drive); }

static inline cm1e_axis_config_t bench_firmware(const char *version)
{
    cm1e_axis_config_t config = {0};
    strncpy(config.firmware, version, sizeof config.firmware - 1);
    return config;
}

/* Opens the bench on an axis without stops and sensors. */
static inline void bench_open_endless(bench_t *b, const char *firmware)
{
    cm1e_axis_config_t config = bench_firmware(firmware);
    config.sim.no_stops = config.sim.no_sensors = true;
    bench_open(b, &config, CM1E_PDO_ORDER_UG_4_4);
}

static inline cm1e_fsa_state_t bench_state(const bench_t *b) { return cm1e_fsa_decode(b->statusword); }

/* Mode shown and Operation enabled, targets at the actual position. */
static inline void bench_enable(bench_t *b, int8_t mode)
{
    b->mode = mode;
    b->controlword = 0x06;
    TEST_ASSERT_TRUE_MESSAGE(bench_until(b, 0x6F, 0x21, 0.1), "Ready to switch on");
    for (int i = 0; i < 100 && b->drive->objects.mode_display != mode; i++)
        bench_cycle(b);
    b->target_position = b->position;
    b->target_velocity = 0;
    b->controlword = 0x0F;
    TEST_ASSERT_TRUE_MESSAGE(bench_until(b, 0x6F, 0x27, 0.1), "Operation enabled");
}

#endif
