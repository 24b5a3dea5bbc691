/**
 * @file drive_bridge_bench.h
 * A drive whose motor stands behind the simulated bridge, on virtual time, 1 ms a cycle.
 */
#ifndef DRIVE_BRIDGE_BENCH_H
#define DRIVE_BRIDGE_BENCH_H

#include <string.h>

#include "device/bridge_status.h"
#include "drive/drive_bridge.h"
#include "drive/drive_kind.h"
#include "unity.h"

#include "../support/fake_bridge.h"

enum { CYCLE_NS = 1000000 };

static cm1e_bus_t bus;
static cm1e_drive_t drive;
static cm1e_diag_t diag;
static bool bus_ok;

static inline void bench_close(void)
{
    cm1e_drive_free(&drive);
    fake_bridge_close();
}

/* As the axis does it: the first set-point of an enabled drive is where the motor stands. */
static inline void bench_cycle(void)
{
    static bool enabled;
    fake_bus_cycle(&bus, CYCLE_NS);
    cm1e_drive_read(&drive, bus_ok && !fake_bridge.lost, bus.clock.virtual_now_ns);
    if (drive.feedback.enabled && !enabled)
        drive.command.target_position = drive.feedback.position;
    enabled = drive.feedback.enabled;
    cm1e_drive_write(&drive);
}

static inline void bench_cycles(int n)
{
    while (n-- > 0)
        bench_cycle();
}

static inline void bench_init(void)
{
    cm1e_drive_free(&drive);
    TEST_ASSERT_EQUAL_INT_MESSAGE(CM1E_OK, cm1e_drive_init(&drive, &bus, 0, &diag), diag.text);
    bus_ok = true;
}

static inline void bench_open(cm1e_device_model_t model, unsigned channel)
{
    fake_bridge_open(&bus, model, channel);
    bench_init();
    bench_cycles(3);
}

static inline uint16_t bench_word(void)
{
    return cm1e_get_u16(bus.outputs + fake_bridge.axis * FAKE_BRIDGE_AXIS_BYTES);
}

static inline int32_t bench_target(void)
{
    return (int32_t)cm1e_get_u32(bus.outputs + fake_bridge.axis * FAKE_BRIDGE_AXIS_BYTES + 2);
}

static inline void bench_enable(void)
{
    drive.command.enable = true;
    for (int i = 0; i < 100 && !drive.feedback.enabled; i++)
        bench_cycle();
    TEST_ASSERT_TRUE(drive.feedback.enabled);
    TEST_ASSERT_EQUAL_INT(CM1E_OK, drive.fault.error);
    drive.command.target_position = drive.feedback.position;
}

/* TRUE: 0x6061 shows it and the drive believes it. */
static inline bool bench_mode(int mode, int at_most)
{
    drive.command.mode = (cm1e_mode_t)mode;
    for (int i = 0; i < at_most && drive.feedback.mode != mode; i++)
        bench_cycle();
    return drive.feedback.mode == mode;
}

static inline bool bench_reset(int at_most)
{
    drive.command.reset = true;
    do {
        bench_cycle();
        drive.command.reset = false;
    } while (cm1e_drive_resetting(&drive) && at_most-- > 0);
    TEST_ASSERT_FALSE(cm1e_drive_resetting(&drive));
    return drive.fault.error == CM1E_OK;
}

static inline void bench_text_has(const char *part)
{
    char text[1024];
    cm1e_drive_fault_text(&drive, text, sizeof text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(text, part), text);
}

/* A transfer of a tool that is not this drive. */
static inline uint32_t bench_sdo(uint16_t first_index, uint8_t subindex, uint32_t value)
{
    uint8_t data[4];
    cm1e_put_u32(data, value);
    const uint16_t index = (uint16_t)(first_index + fake_bridge.axis * CM1E_BRIDGE_INDEX_INCREMENT);
    const cm1e_entry_t *entry = cm1e_bridge_entry(fake_bridge.app->model, index, subindex);
    return cm1e_sim_bridge_sdo_write(fake_bridge.app, index, subindex, CM1E_AL_OP, data, (entry->bits + 7u) / 8u);
}

#endif
