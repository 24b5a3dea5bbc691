/**
 * @file stream_types.h
 * What a control wants and what it is told, as plain data for C and C++. The control is LinuxCNC, ROS 2, or another
 * program with a servo loop of its own.
 */
#ifndef CM1E_STREAM_TYPES_H
#define CM1E_STREAM_TYPES_H

#include <stdbool.h>
#include <stdint.h>

enum {
    STREAM_AXES = 16,      /**< bits of a mask fit 32 */
    STREAM_SIGNALS = 128,  /**< of slaves without a motor, each way */
    STREAM_INPUTS = 6,     /**< of a motor */
    STREAM_OUTPUTS = 4,    /**< of a motor */
};

/** What the control wants, in one of its periods. Masks have bit 0 for the first axis. */
typedef struct stream_command {
    uint32_t enable;       /**< torque; a rising edge also acknowledges a fault */
    uint32_t reset;        /**< a rising edge acknowledges a fault */
    uint32_t home;         /**< a rising edge homes a disabled axis by its drive, as the bus file says */
    bool stop;             /**< no axis may have torque: all ramp down, and a homing ends */
    uint32_t digital[STREAM_AXES];   /**< outputs of the motors; bit 0: output 1 */
    double positions[STREAM_AXES];   /**< u of each axis; of this moment */
    double outputs[STREAM_SIGNALS];  /**< of slaves without a motor */
} stream_command_t;

/** What an axis is doing. */
typedef enum stream_flag {
    STREAM_ENABLED = 1,    /**< it follows the positions */
    STREAM_FAULT = 2,      /**< it does not, until a rising edge of enable or reset */
    STREAM_HOMED = 4,      /**< the drive knows its zero */
    STREAM_HOMING = 8,
    STREAM_POWERED = 16,   /**< there is torque */
    STREAM_ONLINE = 32,    /**< the drive answers */
} stream_flag_t;

typedef struct stream_axis_state {
    double position, velocity;  /**< u, u/s; of the motor */
    double set_position;        /**< u; that the motor follows now */
    double lag;                 /**< u; between the two, at the same moment */
    double torque;              /**< % of rated torque; 0: unknown */
    uint32_t flags;             /**< stream_flag_t */
    uint32_t inputs;            /**< of the motor; bit 0: input 1 */
    int32_t error;              /**< cm1e_error_t; 0: none */
} stream_axis_state_t;

typedef struct stream_state {
    uint64_t cycles, overruns, lost_frames;
    double delay;               /**< periods of the control: how old the positions are that the axes follow */
    bool lost;                  /**< the control gave nothing for too long: all axes were stopped */
    stream_axis_state_t axes[STREAM_AXES];
    double inputs[STREAM_SIGNALS];
} stream_state_t;

#endif
