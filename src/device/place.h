/**
 * @file place.h
 * Where the configuration has an axis on the wire. Pure functions of the configuration.
 */
#ifndef CM1E_DEVICE_PLACE_H
#define CM1E_DEVICE_PLACE_H

#include <stdbool.h>
#include <stdint.h>

#include "cm1e/config.h"

/** false: it is virtual, or an encoder, and has no slave. */
static inline bool cm1e_axis_has_motor(const cm1e_axis_config_t *axis) { return axis->type == CM1E_AXIS_MOTOR; }

/** Motors among the first `count` entries of the list. */
static inline uint32_t cm1e_motors_before(const cm1e_bus_config_t *config, uint32_t count)
{
    uint32_t motors = 0;
    for (uint32_t i = 0; i < count && i < CM1E_MAX_AXES; i++)
        motors += cm1e_axis_has_motor(&config->axes[i]);
    return motors;
}

/** What the slave of an axis is found by; of a position that is not stated its place among the motors of the list.
 *  Optional slaves are no part of the count: a position is that of a slave while all of them are absent. */
static inline uint16_t cm1e_axis_address(const cm1e_bus_config_t *config, uint32_t index)
{
    const cm1e_axis_config_t *axis = &config->axes[index];
    uint32_t optional = 0;
    if (axis->address != 0 || axis->address_kind != CM1E_ADDRESS_POSITION || !cm1e_axis_has_motor(axis))
        return axis->address;
    for (uint32_t i = 0; i < index && i < CM1E_MAX_AXES; i++)
        optional += cm1e_axis_has_motor(&config->axes[i]) && config->axes[i].optional;
    return (uint16_t)(cm1e_motors_before(config, index) - optional + 1);
}

/** Whether a slave of the list may be absent: it is optional, or in a Hot Connect group. */
static inline bool cm1e_slave_is_optional(const cm1e_slave_config_t *slave)
{
    return slave->optional || slave->hot_connect[0];
}
/** Whether its position counts in its Hot Connect group, and not on the wire. */
static inline bool cm1e_slave_is_member(const cm1e_slave_config_t *slave)
{
    return slave->hot_connect[0] && slave->address_kind == CM1E_ADDRESS_POSITION;
}

#endif
