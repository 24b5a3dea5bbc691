/**
 * @file stream_axis.h
 * One axis that follows the positions of a control: power, faults, homing by the drive, and the take-over without a
 * jump. It is made of function blocks. All functions run in the cycle unless marked otherwise.
 */
#ifndef CM1E_STREAM_AXIS_H
#define CM1E_STREAM_AXIS_H

#include <cm1e/plcopen.h>

#include "stream_link.h"

/** Why an axis was stopped by us, and not by an error of its own. */
typedef enum stream_reason {
    STREAM_NO_REASON = 0,
    STREAM_AWAY,         /**< the control's position is not where the axis stands */
    STREAM_REFUSED,      /**< a block refused; `error` */
    STREAM_NOT_RESET,    /**< MC_Reset failed; `error` */
    STREAM_NOT_HOMED,    /**< the homing failed; `error` */
    STREAM_SILENT,       /**< the control gives no positions */
} stream_reason_t;

/** Why an axis was stopped, for a text. */
typedef struct stream_notice {
    uint32_t axis;
    stream_reason_t reason;
    cm1e_error_t error;  /**< CM1E_OK: it is told elsewhere */
    double asked, found, tolerance; /**< u; with STREAM_AWAY: the control, the axis, and how near is right */
    char text[CM1E_AXIS_ERROR_TEXT_BYTES]; /**< of the axis; "": it has none */
} stream_notice_t;

/** What the axis gets in a cycle. */
typedef struct stream_wish {
    bool enable, reset, home;
    bool stop;           /**< it may have no torque, also not for a homing */
    bool alive;          /**< `position` is that of this cycle; else the control is silent */
    bool rests;          /**< `position` is not changing */
    double position;     /**< u */
    uint32_t digital;
} stream_wish_t;

typedef struct stream_axis {
    AXIS_REF_t reference;
    double cycle_s;
    uint32_t digital_outputs;
    MC_Power_t power;
    MC_Reset_t clear;
    MC_Home_t homing;
    CM_FollowPosition_t follow;
    bool enable_before, reset_before, home_before;
    double offset, offset_s; /**< u; between the axis and the control when it took over; time since then */
    stream_notice_t notice; /**< reason STREAM_NO_REASON: it was not stopped by us */
    uint32_t notices;    /**< grows with each notice */
    MC_WriteDigitalOutput_t outputs[STREAM_OUTPUTS];
} stream_axis_t;

/** @rt init */
void stream_axis_init(stream_axis_t *axis, AXIS_REF_t reference, double tolerance, double cycle_s,
                      uint32_t digital_outputs);
/** Does the work of a cycle, and tells what the axis is doing. */
void stream_axis_step(stream_axis_t *axis, const stream_wish_t *wish, stream_axis_state_t *state);
/** Writes a notice as a sentence. @rt block */
void stream_notice_text(const stream_notice_t *notice, const char *name, char *text, size_t size);

#endif
