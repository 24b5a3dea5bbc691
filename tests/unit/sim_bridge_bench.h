/**
 * @file sim_bridge_bench.h
 * A simulated bridge on the test bench, without a slave controller: process data by axis, SDO, simulated time.
 */
#ifndef SIM_BRIDGE_BENCH_H
#define SIM_BRIDGE_BENCH_H

#include <stdio.h>
#include <string.h>

#include "core/bytes.h"
#include "sim/bridge_app.h"
#include "unity.h"

enum { BENCH_INIT = 1, BENCH_PREOP = 2, BENCH_SAFEOP = 4, BENCH_OP = 8 };
enum { BENCH_MS = 1000000, BENCH_BYTES = 24 };

typedef struct bench {
    cm1e_sim_bridge_t *bridge;
    const cm1e_sim_app_ops_t *ops;
    int64_t now_ns;
    struct {
        /* what the master wants */
        uint16_t controlword;
        int32_t target;
        /* what it gets */
        uint16_t statusword;
        int32_t position;
    } axes[CM1E_BRIDGE_AXES];
} bench_t;

/* The initialisation of the device is over, and it is in Operational, where nothing has been sent yet. */
static inline void bench_open(bench_t *b, cm1e_device_model_t model)
{
    *b = (bench_t){.bridge = cm1e_sim_bridge_create_app(model, NULL), .ops = &cm1e_sim_bridge_ops};
    TEST_ASSERT_NOT_NULL(b->bridge);
    b->now_ns = 1000 * (int64_t)BENCH_MS;
    b->ops->advance(b->bridge, b->now_ns);
    b->now_ns += 100 * BENCH_MS;
    b->ops->advance(b->bridge, b->now_ns);
    b->ops->state_change(b->bridge, BENCH_SAFEOP, BENCH_OP);
}

static inline void bench_close(bench_t *b)
{
    if (b->bridge)
        b->ops->destroy(b->bridge);
    b->bridge = NULL;
}

static inline void bench_wait(bench_t *b, int64_t ns)
{
    b->now_ns += ns;
    b->ops->advance(b->bridge, b->now_ns);
}

/* What the inputs are now. */
static inline void bench_look(bench_t *b)
{
    uint8_t in[BENCH_BYTES];
    b->ops->inputs(b->bridge, in, sizeof in);
    for (int i = 0; i < CM1E_BRIDGE_AXES; i++) {
        b->axes[i].statusword = cm1e_get_u16(in + 6 * i);
        b->axes[i].position = (int32_t)cm1e_get_u32(in + 6 * i + 2);
    }
}

/* One exchange of process data, after so long. */
static inline void bench_cycle_after(bench_t *b, int64_t ns)
{
    uint8_t out[BENCH_BYTES];
    for (int i = 0; i < CM1E_BRIDGE_AXES; i++) {
        cm1e_put_u16(out + 6 * i, b->axes[i].controlword);
        cm1e_put_u32(out + 6 * i + 2, (uint32_t)b->axes[i].target);
    }
    bench_wait(b, ns);
    b->ops->outputs(b->bridge, out, sizeof out, b->now_ns);
    bench_look(b);
}

static inline void bench_cycles(bench_t *b, int count)
{
    for (int i = 0; i < count; i++)
        bench_cycle_after(b, BENCH_MS);
}

static inline uint32_t bench_try_read(bench_t *b, uint16_t index, uint8_t subindex, int64_t *value)
{
    uint8_t data[128] = {0};
    size_t size = sizeof data;
    const uint32_t code = b->ops->sdo_read(b->bridge, index, subindex, b->bridge->al_state, data, &size);
    const cm1e_entry_t *entry = b->ops->entry(b->bridge, index, subindex);
    *value = code ? 0 : cm1e_sim_take_number(entry, data);
    return code;
}

static inline int64_t bench_read(bench_t *b, uint16_t index, uint8_t subindex)
{
    int64_t value;
    char where[40];
    snprintf(where, sizeof where, "reading %04X:%02X", index, subindex);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, bench_try_read(b, index, subindex, &value), where);
    return value;
}

static inline uint32_t bench_try_write(bench_t *b, uint16_t index, uint8_t subindex, int64_t value)
{
    const cm1e_entry_t *entry = b->ops->entry(b->bridge, index, subindex);
    uint8_t data[8];
    cm1e_put_uint(data, 8, (uint64_t)value);
    const size_t size = entry ? (entry->bits + 7u) / 8u : 4;
    return b->ops->sdo_write(b->bridge, index, subindex, b->bridge->al_state, data, size);
}

static inline void bench_write(bench_t *b, uint16_t index, uint8_t subindex, int64_t value)
{
    char where[40];
    snprintf(where, sizeof where, "writing %04X:%02X", index, subindex);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, bench_try_write(b, index, subindex, value), where);
}

/* Targets follow the actual position, as a careful master has it until operation is enabled. */
static inline void bench_enable(bench_t *b, int axis)
{
    static const uint16_t words[] = {0x06, 0x07, 0x0F};
    for (int i = 0; i < 3; i++) {
        b->axes[axis].target = (int32_t)cm1e_sim_bridge_position(&b->bridge->axes[axis]);
        b->axes[axis].controlword = words[i];
        bench_cycles(b, 2);
    }
    TEST_ASSERT_EQUAL(OPERATION_ENABLED, b->bridge->axes[axis].state);
}

#endif
