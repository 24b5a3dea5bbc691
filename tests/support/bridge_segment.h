/**
 * @file bridge_segment.h
 * Segments with bridges, CM1-Es and I/O modules in any order, and the objects of an axis behind a bridge by the index
 * that the first one has.
 */
#ifndef CM1E_TESTS_BRIDGE_SEGMENT_H
#define CM1E_TESTS_BRIDGE_SEGMENT_H

#include "bus_support.h"
#include "device/bridge.h"
#include "sim/bridge_app.h"

typedef enum device_kind { NO_DEVICE = 0, A_MOTOR, AN_IO_MODULE, AN_EB01, AN_EB02, AN_EB12 } device_kind_t;

static inline cm1e_sim_slave_t *make_device(device_kind_t kind, uint16_t alias)
{
    static cm1e_axis_config_t motor;
    memset(&motor, 0, sizeof motor);
    strcpy(motor.firmware, tested_firmware());
    switch (kind) {
    case NO_DEVICE: return NULL;
    case A_MOTOR: return cm1e_sim_cm1e_create(&motor, tested_order(), alias, 0);
    case AN_IO_MODULE: return cm1e_sim_io_module_create();
    case AN_EB01: return cm1e_sim_bridge_create(CM1E_DEVICE_EB01, NULL, alias);
    case AN_EB02: return cm1e_sim_bridge_create(CM1E_DEVICE_EB02, NULL, alias);
    case AN_EB12: return cm1e_sim_bridge_create(CM1E_DEVICE_EB12, NULL, alias);
    }
    return NULL;
}

/** A bus that expects `config`, on these devices. */
static inline cm1e_bus_t *open_bus_on_devices(const device_kind_t *devices, size_t count)
{
    /* The segment that the nic makes of the configuration is replaced, so it must not depend on it. */
    static cm1e_bus_config_t kept;
    kept = config;
    sim_config(1);
    cm1e_bus_t *bus = open_bus();
    config = kept;
    cm1e_bus_config_t *own = (void *)(uintptr_t)cm1e_bus_configuration(bus);
    memcpy(own->axes, config.axes, sizeof config.axes);
    own->axis_count = config.axis_count;
    if (config.cycle_time_ns)
        own->cycle_time_ns = config.cycle_time_ns;
    cm1e_sim_segment_t *segment = cm1e_sim_segment_create_empty();
    for (size_t i = 0; i < count && devices[i] != NO_DEVICE; i++)
        ck_assert_int_eq(cm1e_sim_segment_add(segment, make_device(devices[i], 0)), CM1E_OK);
    cm1e_nic_replace_segment(cm1e_bus_nic(bus), segment);
    return bus;
}

/** Axis `n` of the configuration (from 0) is the motor at a connector of the bridge at a position. */
static inline void expect_bridged(uint32_t n, uint16_t position, uint8_t channel, const char *motor)
{
    cm1e_axis_config_t *axis = &config.axes[n];
    axis->address_kind = CM1E_ADDRESS_POSITION;
    axis->address = position;
    axis->channel = channel;
    axis->firmware[0] = 0;
    snprintf(axis->motor, sizeof axis->motor, "%s", motor);
    axis->k37 = 10;
    axis->k37_stated = true;
}

static inline uint16_t on_channel(unsigned channel, uint16_t index)
{
    return (uint16_t)(index + (channel - 1) * CM1E_BRIDGE_INDEX_INCREMENT);
}

static inline cm1e_sim_bridge_t *bridge_at(cm1e_bus_t *bus, uint32_t position)
{
    cm1e_sim_bridge_t *bridge = cm1e_sim_bridge_of(cm1e_sim_segment_slave(segment_of(bus), position));
    ck_assert_ptr_nonnull(bridge);
    return bridge;
}

#endif
