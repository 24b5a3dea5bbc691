/**
 * @file axis.h
 * The PLCopen axis: AXIS_REF, its state (PLCopen Motion Control Part 1 v2.0, 2.1), its values and its error texts. The
 * scheduler makes axes and drives them; programs act on them through function blocks (plcopen.h) in the cycle.
 */
#ifndef CM1E_AXIS_H
#define CM1E_AXIS_H

#include <stdbool.h>
#include <stddef.h>

#include "cm1e/api.h"
#include "cm1e/error.h"
#include "cm1e/iec_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/** A handle of an axis. It holds no axis data and may be copied. 0 names no axis. */
typedef struct AXIS_REF {
    UINT Handle;
} AXIS_REF_t;

/** The states of PLCopen Part 1 v2.0, figure 2. */
typedef enum cm1e_axis_state {
    CM1E_AXIS_DISABLED = 0,
    CM1E_AXIS_STANDSTILL,
    CM1E_AXIS_HOMING,
    CM1E_AXIS_DISCRETE_MOTION,
    CM1E_AXIS_CONTINUOUS_MOTION,
    CM1E_AXIS_SYNCHRONIZED_MOTION,
    CM1E_AXIS_STOPPING,
    CM1E_AXIS_ERROR_STOP,
    CM1E_AXIS_STATE_COUNT,
} cm1e_axis_state_t;

/** Name of a state: "Standstill" and so on. Never NULL; static storage. @rt any */
CM1E_API const char *cm1e_axis_state_name(cm1e_axis_state_t state);

/** The values of an axis, all of the same cycle. Units: u, u/s, u/s2, % of rated torque. */
typedef struct cm1e_axis_info {
    cm1e_axis_state_t state;
    double set_position, set_velocity, set_acceleration;
    double actual_position, actual_velocity, actual_torque;
    double position_lag;
    bool powered, homed, online;
    bool in_position;          /**< the motor has torque, the set-point is at standstill, and the motor has been within
                                    the window around it for the configured time (in_position) */
    /* false: the value is not in the process data of this motor, and is 0. Behind a bridge torque, temperature and DC
     * link are never known; digital inputs are known if they were read within the last second. */
    bool torque_known, digital_known, temperature_known, dc_link_known;
    cm1e_error_t error;        /**< cause of ErrorStop; CM1E_OK in any other state */
    uint16_t device_error;     /**< 0x603F of the drive at that error */
    uint16_t digital_inputs;   /**< bit 0 = IN1 ... bit 3 = IN4 */
    uint16_t statusword;
    int8_t mode;               /**< 0x6061 */
    int16_t temperature;       /**< degrees C */
    double dc_link_voltage;    /**< V */
} cm1e_axis_info_t;

/** Reads the values of an axis. Call it in a program of the scheduler that owns the axis. Returns
 *  CM1E_ERROR_FB_AXIS_REF for a handle that names no axis. @rt cycle */
CM1E_API cm1e_error_t cm1e_axis_read(AXIS_REF_t axis, cm1e_axis_info_t *info);
/** Writes the present counts of the encoder of an axis with `type: encoder`. The 32 bits may wrap; the axis counts on.
 *  Call it in every cycle, in a program of the scheduler that owns the axis: in a cycle without a call, or with `valid`
 *  false, the axis is offline. The value is used from the beginning of the next cycle on, like the positions of motors.
 *  Returns CM1E_ERROR_UNSUPPORTED if the axis is not an encoder, or its counts come from a slave. @rt cycle */
CM1E_API cm1e_error_t cm1e_axis_write_encoder(AXIS_REF_t axis, uint32_t counts, bool valid);
/** The configured name of an axis; "" for a handle that names no axis. @rt any */
CM1E_API const char *cm1e_axis_name(AXIS_REF_t axis);
/** Buffer size that is large enough for every text of cm1e_axis_error_text(). */
enum { CM1E_AXIS_ERROR_TEXT_BYTES = 1024 };
/** Writes the error of the axis as sentences: what happened, with which values, what to do. Without an error it writes
 *  why the last command was refused or the last homing could not start, and which values are allowed; else that a slave
 *  does not get in step, because its master is too fast for it; "" if there is nothing of that. A buffer that is too
 *  small gets the beginning of the text. @rt block */
CM1E_API void cm1e_axis_error_text(AXIS_REF_t axis, char *text, size_t size);

#ifdef __cplusplus
}
#endif
#endif
