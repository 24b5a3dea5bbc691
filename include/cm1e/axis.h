/**
 * @file axis.h
 * The PLCopen axis: AXIS_REF, its state (PLCopen Motion Control Part 1 v2.0, 2.1) and what happened to it in words.
 * Axes are made and driven by the scheduler; programs act on them through function blocks (plcopen.h) in the cycle.
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

/** A handle, not axis data: it may be copied. 0 names no axis. */
typedef struct AXIS_REF {
    UINT Handle;
} AXIS_REF_t;

/** PLCopen Part 1 v2.0, figure 2. */
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

/** "Standstill" ... ; never NULL. @rt any */
CM1E_API const char *cm1e_axis_state_name(cm1e_axis_state_t state);

/** What an axis shows; one consistent copy. Units: u, u/s, % of rated torque. */
typedef struct cm1e_axis_info {
    cm1e_axis_state_t state;
    double set_position, set_velocity, set_acceleration;
    double actual_position, actual_velocity, actual_torque;
    double position_lag;
    bool powered, homed, online;
    bool in_position;          /**< under torque, the set-point stands, and the motor has been within the window around
                                    it for the time that the configuration states (in_position) */
    /* FALSE: not in the process data of this motor, the value is 0. Behind a bridge torque, temperature and DC link
     * never are, and digital inputs are known while somebody has read them within the last second. */
    bool torque_known, digital_known, temperature_known, dc_link_known;
    cm1e_error_t error;        /**< why the axis is in ErrorStop; CM1E_OK otherwise */
    uint16_t device_error;     /**< 0x603F with it */
    uint16_t digital_inputs;   /**< bit 0 = IN1 ... bit 3 = IN4 */
    uint16_t statusword;
    int8_t mode;               /**< 0x6061 */
    int16_t temperature;       /**< degrees C */
    double dc_link_voltage;    /**< V */
} cm1e_axis_info_t;

/** CM1E_ERROR_FB_AXIS_REF for a handle that names no axis. @rt cycle (call it in a program of the axis's scheduler) */
CM1E_API cm1e_error_t cm1e_axis_read(AXIS_REF_t axis, cm1e_axis_info_t *info);
/** What the encoder shows now, of an axis with `type: encoder`; 32 bits that wrap around are counted on. A program of
 *  the axis's scheduler calls it in every cycle: in a cycle without a call, or with `valid` FALSE, the axis is offline.
 *  It is taken in at the beginning of the next cycle, as are the positions of motors. CM1E_ERROR_UNSUPPORTED: the axis
 *  is no encoder. @rt cycle */
CM1E_API cm1e_error_t cm1e_axis_write_encoder(AXIS_REF_t axis, uint32_t counts, bool valid);
/** The configured name; "" for a handle that names no axis. @rt any */
CM1E_API const char *cm1e_axis_name(AXIS_REF_t axis);
/** Large enough for every text of cm1e_axis_error_text(). */
enum { CM1E_AXIS_ERROR_TEXT_BYTES = 1024 };
/** The axis's error as sentences: what happened, with which numbers, what to do. Without an error: why the last command
 *  was refused or the last homing could not start, and what would be right; "" where nothing was. A buffer that is
 *  too small gets the beginning. @rt block */
CM1E_API void cm1e_axis_error_text(AXIS_REF_t axis, char *text, size_t size);

#ifdef __cplusplus
}
#endif
#endif
