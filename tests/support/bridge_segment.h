/**
 * @file bridge_segment.h
 * Segments with bridges, CM1-Es and I/O modules in any order, and the objects of an axis behind a bridge by the index
 * that the first one has.
 */
#ifndef CM1E_TESTS_BRIDGE_SEGMENT_H
#define CM1E_TESTS_BRIDGE_SEGMENT_H

#include "bus_support.h"
#include "device/bridge_facts.h"
#include "sim/bridge_app.h"

typedef enum device_kind { NO_DEVICE = 0, A_MOTOR, AN_IO_MODULE, AN_EB01, AN_EB02, AN_EB12 } device_kind_t;

/** The alias of the slave at a position, where it has one. */
uint16_t alias_at(uint16_t position);

/** Up to `count` devices, in the order of the line. */
cm1e_sim_segment_t *make_segment(const device_kind_t *devices, size_t count);

/** A bus that expects `config`, on these devices. */
cm1e_bus_t *open_bus_on_devices(const device_kind_t *devices, size_t count);

/** Axis `n` of the configuration (from 0) is the motor at a connector of the bridge at a position. */
void expect_bridged(uint32_t n, uint16_t position, uint8_t channel, const char *motor);

uint16_t on_channel(unsigned channel, uint16_t index);

cm1e_sim_bridge_t *bridge_at(cm1e_bus_t *bus, uint32_t position);

/** A network of everything. */
static const device_kind_t mixed[4] = {A_MOTOR, AN_EB12, AN_IO_MODULE, AN_EB01};

cm1e_bus_t *start_mixed(void);

#endif
