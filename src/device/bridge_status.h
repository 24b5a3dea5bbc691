/**
 * @file bridge_status.h
 * What a Cool Muscle behind the bridge says of itself: F530:5 ... F530:8, the answer to the query ?99 (Ux), and in CPIO
 * four bits of the statusword. One table for each kind of motor (BR 7.4); its words are in cm1e/bridge.h.
 */
#ifndef CM1E_DEVICE_BRIDGE_STATUS_H
#define CM1E_DEVICE_BRIDGE_STATUS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "device/bridge.h"

/** An error or an alarm of the motor or of the serial line to it. TRUE also for bits that the guide gives no meaning
 *  for this motor. */
bool cm1e_bridge_status_is_error(cm1e_bridge_motor_t motor, uint32_t status);
/** The error is that of the serial line: of the motor itself nothing is known. */
bool cm1e_bridge_status_is_serial(uint32_t status);
/** It holds no torque. */
bool cm1e_bridge_status_is_free(uint32_t status);
/** It moves or pushes: has neither arrived nor an error, nor is it free. */
bool cm1e_bridge_status_is_moving(cm1e_bridge_motor_t motor, uint32_t status);
/** It stands where it was sent; not at the end of a push, where it stands elsewhere. */
bool cm1e_bridge_status_is_in_position(uint32_t status);

/** The status in a statusword of CPIO, its bits 8 ... 11 (BR 7.1.3): the four lowest bits of F530. Motor free, push
 *  modes and alarms are not among them. */
static inline uint8_t cm1e_bridge_status_of_cpio(uint16_t statusword) { return statusword >> 8 & 0x0F; }

#endif
