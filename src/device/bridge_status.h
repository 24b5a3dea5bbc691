/**
 * @file bridge_status.h
 * What a Cool Muscle behind the bridge says of itself: F530:5 ... F530:8, and the answer to the query ?99 (Ux). One
 * table for each kind of motor (BR 7.4); its words are in cm1e/bridge.h.
 */
#ifndef CM1E_DEVICE_BRIDGE_STATUS_H
#define CM1E_DEVICE_BRIDGE_STATUS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "device/bridge_facts.h"

/** Several of the first three can be there together, and as one number are all that is known of a motor whose serial
 *  line is broken. */
enum {
    BRIDGE_STATUS_RUNNING = 0x00, BRIDGE_STATUS_POSITION_OVERFLOW = 0x01, BRIDGE_STATUS_OVER_SPEED = 0x02,
    BRIDGE_STATUS_OVERLOAD = 0x04, BRIDGE_STATUS_IN_POSITION = 0x08, BRIDGE_STATUS_SERIAL_ERROR = 0x0F,
    BRIDGE_STATUS_MOTOR_FREE = 0x10, BRIDGE_STATUS_PUSH = 0x20, BRIDGE_STATUS_OVER_CURRENT = 0x40,
    BRIDGE_STATUS_TEMPERATURE = 0x80,
};

/** An error or an alarm of the motor or of the serial line to it. true also for bits that the guide gives no meaning
 *  for this motor. */
bool cm1e_bridge_status_is_error(cm1e_bridge_motor_t motor, uint32_t status);
/** One of the values that the guide lists for this motor. */
bool cm1e_bridge_status_is_listed(cm1e_bridge_motor_t motor, uint32_t status);
#define CM1E_BRIDGE_STATUS_CLAUSE "BR 7.4"
/** It moves or pushes: it has not arrived, has no error and is not free. */
bool cm1e_bridge_status_is_moving(cm1e_bridge_motor_t motor, uint32_t status);

#endif
