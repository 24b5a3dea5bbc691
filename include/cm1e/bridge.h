/**
 * @file bridge.h
 * Reads what an EtherCAT Cool MUSCLE Bridge shows of itself, of its serial lines and of the motors behind them (BR 7.3,
 * 7.4). The thread that owns the bus calls these functions after a scan, before the cycle runs. In a program
 * MC_ReadParameter reads the values that belong to an axis.
 */
#ifndef CM1E_BRIDGE_H
#define CM1E_BRIDGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cm1e/api.h"
#include "cm1e/bus.h"
#include "cm1e/config.h"
#include "cm1e/error.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Motors behind one bridge, at most. */
#define CM1E_BRIDGE_AXES 4

/** The motor at a connector; the numbers are those of F511:1 ... F514:1 (BR 7.3). */
typedef enum cm1e_bridge_motor {
    CM1E_BRIDGE_CM1 = 1,
    CM1E_BRIDGE_CM2 = 2,
} cm1e_bridge_motor_t;

/** One value of the bridge. All zero: it was not read. */
typedef struct cm1e_bridge_value {
    bool known;
    uint32_t value;        /**< valid if `known` is true */
    cm1e_error_t error;    /**< valid if `known` is false; CM1E_ERROR_SDO_ABORT: the bridge refused */
    uint32_t abort_code;   /**< valid with CM1E_ERROR_SDO_ABORT */
} cm1e_bridge_value_t;

/** The values of one connector (ID). */
typedef struct cm1e_bridge_channel {
    cm1e_bridge_value_t type;              /**< F511:1 ... F514:1: cm1e_bridge_motor_t */
    cm1e_bridge_value_t baud_rate;         /**< F511:2 ...: code, see cm1e_bridge_bits_per_second() */
    cm1e_bridge_value_t cycle_time_ms;     /**< F511:3 ...: cycle of the serial line, ms */
    cm1e_bridge_value_t receive_errors;    /**< F530:1 ... 4: broken or missing answers of the motor */
    cm1e_bridge_value_t status;            /**< F530:5 ... 8: see cm1e_bridge_status_text() */
    cm1e_bridge_value_t sent, received;    /**< F530:9 ... 12, 13 ... 16: messages on the serial line */
    cm1e_bridge_value_t profile;           /**< F010:1 ... 4: 0x00040192 */
    cm1e_bridge_value_t configured_module; /**< F030:1 ... 4: 0x00219800 */
    cm1e_bridge_value_t detected_module;   /**< F050:1 ... 4: 0x00219800 */
} cm1e_bridge_channel_t;

/** What a bridge shows of itself and of its motors, as cm1e_bridge_read() found it. */
typedef struct cm1e_bridge_info {
    uint16_t position;                     /**< position of the slave, 1 = first */
    bool model_known;                      /**< true: the motors are those of a known model */
    cm1e_device_model_t model;
    cm1e_bridge_channel_t channels[CM1E_BRIDGE_AXES];
    cm1e_bridge_value_t pdo_longest_us, pdo_shortest_us; /**< F530:17, 18: times between the outputs of two cycles */
    cm1e_bridge_value_t pdo_late, pdo_early;             /**< F530:19, 20: number of times above 1300 us, below 700
                                                              us */
    cm1e_bridge_value_t test[4];           /**< F530:21 ... 24: test values of the maker */
    cm1e_bridge_value_t maker_mode;        /**< F540:1, "Musclecorp Mode" */
    cm1e_bridge_value_t master_mode;       /**< F540:5 */
    cm1e_bridge_value_t serial_cycle_ms;   /**< F540:6 */
    cm1e_bridge_value_t config_code;       /**< F540:11 */
    cm1e_bridge_value_t serial_number;     /**< F540:12 */
} cm1e_bridge_info_t;

/** Reads all values of the bridge at `position`. Returns CM1E_OK if they were read; each value then says whether it is
 *  known. Returns CM1E_ERROR_UNSUPPORTED if the slave is not a bridge. The first missing answer ends the reading, so
 *  that a bridge that falls silent costs one time-out and not seventy. Its error is returned; the values before it are
 *  known, the values after it have that error too. @rt block */
CM1E_API cm1e_error_t cm1e_bridge_read(cm1e_bus_t *bus, uint16_t position, cm1e_bridge_info_t *info, cm1e_diag_t *diag);

/** Bits per second of a baud rate code; 0 for a code that the guide does not have. @rt any */
CM1E_API uint32_t cm1e_bridge_bits_per_second(uint32_t baud_rate);

#define CM1E_BRIDGE_STATUS_TEXT 240 /**< buffer size for the longest text of cm1e_bridge_status_text() */

/** Writes the status of a motor as text: "in position", "counter overflow, overload". A status that the guide does not
 *  list is described bit by bit and marked: "motor free, unknown bits 0x40 (0x50 is not listed in the guide)". Returns
 *  `text`. @rt block */
CM1E_API const char *cm1e_bridge_status_text(cm1e_bridge_motor_t motor, uint32_t status, char *text, size_t size);
/** What the user should do about a status; of several errors it describes the first. "" if the status is no error.
 *  Static storage. @rt any */
CM1E_API const char *cm1e_bridge_status_cure(cm1e_bridge_motor_t motor, uint32_t status);

#ifdef __cplusplus
}
#endif
#endif
