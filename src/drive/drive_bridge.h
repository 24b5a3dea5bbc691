/**
 * @file drive_bridge.h
 * The data that only the drive of a motor behind a bridge has; made by cm1e_drive_init(). The cycle thread owns it.
 */
#ifndef CM1E_DRIVE_DRIVE_BRIDGE_H
#define CM1E_DRIVE_DRIVE_BRIDGE_H

#include "drive/drive.h"
#include "drive/drive_cml.h"

/** Digital signals by SDO (drive_digital.c). */
typedef struct cm1e_drive_digital {
    cm1e_sdo_t in_sdo, out_sdo;
    uint8_t in_data[4], out_data[4];
    bool reading, writing, writing_mask;
    bool cleared;                   /**< 60FE:1 was written since the start: nothing of another master is in it */
    bool mask_written;              /**< 60FE:2 says which outputs are ours */
    bool outputs_known;             /**< 60FE:1 is `outputs` */
    bool failed;
    uint16_t outputs, writing_outputs, inputs;
    int64_t wanted_until_ns, read_next_ns, fresh_until_ns, write_next_ns;
} cm1e_drive_digital_t;

typedef struct cm1e_drive_bridge {
    int32_t rest_position, rest_target; /**< where the motor stands; also its target */
    int64_t rest_since_ns;          /**< since when the motor has stood there */
    int64_t rest_ns;                /**< so long without motion is rest; depends on the resolution of the motor (K37) */
    int32_t rest_counts;            /**< a change by so many pulses is no motion */
    cm1e_sdo_t status_sdo;          /**< F530:5 ... 8 */
    uint8_t status_data[4], status_tries;
    bool status_reading;
    bool status_wanted, status_sound; /**< the answer to the last question, and until when it holds */
    int64_t status_until_ns;
    cm1e_drive_cmd_run_t cmd;
    cm1e_drive_digital_t digital;
    cm1e_drive_cml_t cml;           /**< strings are sent while CML is shown */
} cm1e_drive_bridge_t;

#endif
