/**
 * @file status_bridge.h
 * A bridge and its motors, for `cm1e status`.
 */
#ifndef CM1E_TOOLS_STATUS_BRIDGE_H
#define CM1E_TOOLS_STATUS_BRIDGE_H

#include "cm1e/bridge.h"
#include "command.h"

/** The values of its motors, by connector. */
typedef struct bridge_motor_reading {
    cm1e_bridge_value_t statusword, mode, position; /**< 0x6041, 0x6061, 0x6064 of the axis */
} bridge_motor_reading_t;

typedef struct bridge_status {
    cm1e_bridge_info_t info;
    bridge_motor_reading_t motors[CM1E_BRIDGE_AXES];
} bridge_status_t;

/** Returns false if the bridge does not answer, or the statusword of a motor cannot be read. */
bool read_bridge(cm1e_bus_t *bus, uint16_t position, bridge_status_t *status, cm1e_diag_t *diag);
/** `config` names the axes. */
void print_bridge(const cm1e_bus_t *bus, const cm1e_bus_config_t *config, const cm1e_slave_info_t *slave,
                  const bridge_status_t *status);
json_t *bridge_status_as_json(const cm1e_bus_t *bus, const cm1e_bus_config_t *config, const cm1e_slave_info_t *slave,
                              const bridge_status_t *status);

#endif
