/**
 * @file plcopen.h
 * PLCopen Motion Control Part 1 v2.0 function blocks. Each block is a plain struct, valid when zeroed (see the defaults
 * beside the inputs), and a function of the same name that a program calls once a scan, also while nothing happens:
 *
 *     static MC_Power_t power = {.Axis = &axis, .EnablePositive = TRUE, .EnableNegative = TRUE};
 *     power.Enable = TRUE;
 *     MC_Power(&power);
 *
 * Inputs come first, then outputs, in the standard's order; the member `Private` is the block's own. Call them only in
 * programs of the scheduler that owns the axis (@rt cycle). Units: u, u/s, u/s2, u/s3 (config.h). Acceleration,
 * Deceleration, Jerk 0 mean the axis's maximum. ErrorID: cm1e_strerror(cm1e_error_from_id(ErrorID)).
 *
 * Said once for all: the axis is latched at the rising edge of Execute or Enable; another Axis while the block is busy
 * is CM1E_ERROR_FB_AXIS_CHANGED and touches neither axis. A motion goes on when its block is no longer called, or when
 * its re-trigger was refused. ContinuousUpdate TRUE at the edge is CM1E_ERROR_UNSUPPORTED in this version. What a
 * reading block shows is 0 while Valid is FALSE.
 */
#ifndef CM1E_PLCOPEN_H
#define CM1E_PLCOPEN_H

#include "cm1e/axis.h"
#include "cm1e/config.h"
#include "cm1e/iec_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/** 2.4.2; only mcAborting in this version, the others answer with CM1E_ERROR_AXIS_BUFFER_MODE. */
typedef enum MC_BUFFER_MODE {
    mcAborting = 0, mcBuffered, mcBlendingLow, mcBlendingPrevious, mcBlendingNext, mcBlendingHigh,
} MC_BUFFER_MODE;

typedef enum MC_DIRECTION {
    mcPositiveDirection = 1, mcShortestWay = 2, mcNegativeDirection = 3, mcCurrentDirection = 4,
} MC_DIRECTION;

/** State of a block that is not to be touched. */
typedef struct cm1e_fb_private {
    uint32_t command;      /**< what the axis was asked for; 0: nothing */
    UINT axis_handle;      /**< latched at the rising edge */
    WORD error_id;
    BOOL trigger_before;   /**< Execute or Enable at the last call */
    BOOL state;
} cm1e_fb_private_t;

/** 3.1. Controls the power stage. One per axis. Status: the stage is on and set-points act. Error also while the axis
 *  is in ErrorStop and the stage therefore stays off. Answers for the axis latched at Enable's edge until it is off. */
typedef struct MC_Power {
    AXIS_REF_t *Axis;
    BOOL Enable, EnablePositive, EnableNegative;
    BOOL Status, Valid, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_Power_t;
void MC_Power(MC_Power_t *fb);

/** 3.2 with the CM1-E's homing (UG 6.2.4). Position: the axis has this position at the reference when Done.
 *  `Parameters` NULL: the axis's configured homing. */
typedef struct MC_Home {
    AXIS_REF_t *Axis;
    BOOL Execute;
    LREAL Position;
    MC_BUFFER_MODE BufferMode;
    BOOL Done, Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    const cm1e_homing_config_t *Parameters;
    cm1e_fb_private_t Private;
} MC_Home_t;
void MC_Home(MC_Home_t *fb);

/** 3.3. The axis stays Stopping while Execute is TRUE (Done and Active together then). */
typedef struct MC_Stop {
    AXIS_REF_t *Axis;
    BOOL Execute;
    LREAL Deceleration, Jerk;
    BOOL Done, Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_Stop_t;
void MC_Stop(MC_Stop_t *fb);

/** 3.4 */
typedef struct MC_Halt {
    AXIS_REF_t *Axis;
    BOOL Execute;
    LREAL Deceleration, Jerk;
    MC_BUFFER_MODE BufferMode;
    BOOL Done, Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_Halt_t;
void MC_Halt(MC_Halt_t *fb);

/** 3.5. Direction is ignored: the axis is linear. */
typedef struct MC_MoveAbsolute {
    AXIS_REF_t *Axis;
    BOOL Execute, ContinuousUpdate;
    LREAL Position, Velocity, Acceleration, Deceleration, Jerk;
    MC_DIRECTION Direction;
    MC_BUFFER_MODE BufferMode;
    BOOL Done, Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_MoveAbsolute_t;
void MC_MoveAbsolute(MC_MoveAbsolute_t *fb);

/** 3.6. Distance is added to the set position at the start. */
typedef struct MC_MoveRelative {
    AXIS_REF_t *Axis;
    BOOL Execute, ContinuousUpdate;
    LREAL Distance, Velocity, Acceleration, Deceleration, Jerk;
    MC_BUFFER_MODE BufferMode;
    BOOL Done, Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_MoveRelative_t;
void MC_MoveRelative(MC_MoveRelative_t *fb);

/** 3.10. A negative Velocity turns the direction round. Direction 0 acts as mcPositiveDirection. */
typedef struct MC_MoveVelocity {
    AXIS_REF_t *Axis;
    BOOL Execute, ContinuousUpdate;
    LREAL Velocity, Acceleration, Deceleration, Jerk;
    MC_DIRECTION Direction;
    MC_BUFFER_MODE BufferMode;
    BOOL InVelocity, Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_MoveVelocity_t;
void MC_MoveVelocity(MC_MoveVelocity_t *fb);

/** 3.28 */
typedef struct MC_Reset {
    AXIS_REF_t *Axis;
    BOOL Execute;
    BOOL Done, Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_Reset_t;
void MC_Reset(MC_Reset_t *fb);

/** 3.25 */
typedef struct MC_ReadStatus {
    AXIS_REF_t *Axis;
    BOOL Enable;
    BOOL Valid, Busy, Error;
    WORD ErrorID;
    BOOL ErrorStop, Disabled, Stopping, Homing, Standstill, DiscreteMotion, ContinuousMotion, SynchronizedMotion;
    cm1e_fb_private_t Private;
} MC_ReadStatus_t;
void MC_ReadStatus(MC_ReadStatus_t *fb);

/** 3.22 */
typedef struct MC_ReadActualPosition {
    AXIS_REF_t *Axis;
    BOOL Enable;
    BOOL Valid, Busy, Error;
    WORD ErrorID;
    LREAL Position;
    cm1e_fb_private_t Private;
} MC_ReadActualPosition_t;
void MC_ReadActualPosition(MC_ReadActualPosition_t *fb);

/** 3.23 */
typedef struct MC_ReadActualVelocity {
    AXIS_REF_t *Axis;
    BOOL Enable;
    BOOL Valid, Busy, Error;
    WORD ErrorID;
    LREAL Velocity;
    cm1e_fb_private_t Private;
} MC_ReadActualVelocity_t;
void MC_ReadActualVelocity(MC_ReadActualVelocity_t *fb);

/** 3.27. AxisErrorID: an ErrorID of ours, or 0x603F of the drive beside it in DeviceErrorCode. */
typedef struct MC_ReadAxisError {
    AXIS_REF_t *Axis;
    BOOL Enable;
    BOOL Valid, Busy, Error;
    WORD ErrorID;
    WORD AxisErrorID;
    WORD DeviceErrorCode;
    cm1e_fb_private_t Private;
} MC_ReadAxisError_t;
void MC_ReadAxisError(MC_ReadAxisError_t *fb);

#ifdef __cplusplus
}
#endif
#endif
