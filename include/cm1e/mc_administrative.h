/**
 * @file mc_administrative.h
 * The blocks that move nothing: parameters, signals, what the axis shows (PLCopen Part 1 v2.0, chapter 3).
 * Generated from fb/interface/administrative.st by fb/interface/generate.py; change it there.
 */
#ifndef CM1E_MC_ADMINISTRATIVE_H
#define CM1E_MC_ADMINISTRATIVE_H

#include "cm1e/api.h"
#include "cm1e/mc_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/** 3.17. Shifts the coordinates of the axis: set and actual position change alike, and nothing moves. It works
 *  during a motion too. @rt cycle */
typedef struct MC_SetPosition_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    LREAL Position; /**< u; new actual position, or the distance to shift by */
    BOOL Relative;  /**< TRUE: Position is added */
    MC_EXECUTION_MODE ExecutionMode;
    /* outputs */
    BOOL Done;      /**< the position is set */
    BOOL Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_SetPosition_t;
CM1E_API void MC_SetPosition(MC_SetPosition_t *fb);

/** 3.18. Sets factors for velocity, acceleration and jerk of all motions of the axis. They are kept when Enable
 *  falls. @rt cycle */
typedef struct MC_SetOverride_t {
    AXIS_REF_t *Axis;
    BOOL Enable;
    LREAL VelFactor;  /**< 0 ... 1; 0: the axis is at rest, but not in Standstill */
    LREAL AccFactor;  /**< > 0 ... 1; acceleration and deceleration */
    LREAL JerkFactor; /**< > 0 ... 1 */
    /* outputs */
    BOOL Enabled;     /**< the factors are in force */
    BOOL Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_SetOverride_t;
/** Its initial values: `MC_SetOverride_t fb = {.Axis = &axis, MC_SETOVERRIDE_DEFAULTS};` */
#define MC_SETOVERRIDE_DEFAULTS .VelFactor = 1.0, .AccFactor = 1.0, .JerkFactor = 1.0
CM1E_API void MC_SetOverride(MC_SetOverride_t *fb);

/** 3.19. Reads a parameter of the axis. @rt cycle */
typedef struct MC_ReadParameter_t {
    AXIS_REF_t *Axis;
    BOOL Enable;
    INT ParameterNumber; /**< 1 ... 17, vendor numbers from 1000; table 5 */
    /* outputs */
    BOOL Valid, Busy, Error;
    WORD ErrorID;
    LREAL Value;         /**< in the parameter's unit */
    cm1e_fb_private_t Private;
} MC_ReadParameter_t;
CM1E_API void MC_ReadParameter(MC_ReadParameter_t *fb);

/** 3.19. Reads a parameter of the axis of type BOOL. @rt cycle */
typedef struct MC_ReadBoolParameter_t {
    AXIS_REF_t *Axis;
    BOOL Enable;
    INT ParameterNumber; /**< 1 ... 17, vendor numbers from 1000; table 5 */
    /* outputs */
    BOOL Valid, Busy, Error;
    WORD ErrorID;
    BOOL Value;
    cm1e_fb_private_t Private;
} MC_ReadBoolParameter_t;
CM1E_API void MC_ReadBoolParameter(MC_ReadBoolParameter_t *fb);

/** 3.20. Writes a parameter of the axis. @rt cycle */
typedef struct MC_WriteParameter_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    INT ParameterNumber; /**< those of table 5 that may be written, vendor numbers from 1000 */
    LREAL Value;         /**< in the parameter's unit */
    MC_EXECUTION_MODE ExecutionMode;
    /* outputs */
    BOOL Done;           /**< the parameter is written */
    BOOL Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_WriteParameter_t;
CM1E_API void MC_WriteParameter(MC_WriteParameter_t *fb);

/** 3.20. Writes a parameter of the axis of type BOOL. @rt cycle */
typedef struct MC_WriteBoolParameter_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    INT ParameterNumber; /**< those of table 5 that may be written, vendor numbers from 1000 */
    BOOL Value;
    MC_EXECUTION_MODE ExecutionMode;
    /* outputs */
    BOOL Done;           /**< the parameter is written */
    BOOL Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_WriteBoolParameter_t;
CM1E_API void MC_WriteBoolParameter(MC_WriteBoolParameter_t *fb);

/** 3.21. Reads a digital input of a motor. @rt cycle */
typedef struct MC_ReadDigitalInput_t {
    const MC_INPUT_REF *Input;
    BOOL Enable;
    INT InputNumber; /**< 1 ... 4; IN1 ... IN4, {11 ... 18} signals of other slaves; 0: Input.Number */
    /* outputs */
    BOOL Valid, Busy, Error;
    WORD ErrorID;
    BOOL Value;      /**< the input is on */
    cm1e_fb_private_t Private;
} MC_ReadDigitalInput_t;
CM1E_API void MC_ReadDigitalInput(MC_ReadDigitalInput_t *fb);

/** 3.22. Reads back a digital output of a motor. @rt cycle */
typedef struct MC_ReadDigitalOutput_t {
    const MC_OUTPUT_REF *Output;
    BOOL Enable;
    INT OutputNumber; /**< 1; or {11 ... 18} of other slaves; 0: Output.Number */
    /* outputs */
    BOOL Valid, Busy, Error;
    WORD ErrorID;
    BOOL Value;       /**< the output is on */
    cm1e_fb_private_t Private;
} MC_ReadDigitalOutput_t;
CM1E_API void MC_ReadDigitalOutput(MC_ReadDigitalOutput_t *fb);

/** 3.23. Writes a digital output of a motor, once. @rt cycle */
typedef struct MC_WriteDigitalOutput_t {
    const MC_OUTPUT_REF *Output;
    BOOL Execute;
    INT OutputNumber; /**< 1; or {11 ... 18} of other slaves; 0: Output.Number */
    BOOL Value;
    MC_EXECUTION_MODE ExecutionMode;
    /* outputs */
    BOOL Done;        /**< the output is written */
    BOOL Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_WriteDigitalOutput_t;
CM1E_API void MC_WriteDigitalOutput(MC_WriteDigitalOutput_t *fb);

/** 3.24. Reads the actual position. @rt cycle */
typedef struct MC_ReadActualPosition_t {
    AXIS_REF_t *Axis;
    BOOL Enable;
    /* outputs */
    BOOL Valid, Busy, Error;
    WORD ErrorID;
    LREAL Position; /**< u */
    cm1e_fb_private_t Private;
} MC_ReadActualPosition_t;
CM1E_API void MC_ReadActualPosition(MC_ReadActualPosition_t *fb);

/** 3.25. Reads the actual velocity. @rt cycle */
typedef struct MC_ReadActualVelocity_t {
    AXIS_REF_t *Axis;
    BOOL Enable;
    /* outputs */
    BOOL Valid, Busy, Error;
    WORD ErrorID;
    LREAL Velocity; /**< u/s; signed */
    cm1e_fb_private_t Private;
} MC_ReadActualVelocity_t;
CM1E_API void MC_ReadActualVelocity(MC_ReadActualVelocity_t *fb);

/** 3.26. Reads the actual torque. @rt cycle */
typedef struct MC_ReadActualTorque_t {
    AXIS_REF_t *Axis;
    BOOL Enable;
    /* outputs */
    BOOL Valid, Busy, Error;
    WORD ErrorID;
    LREAL Torque; /**< % of rated torque; signed */
    cm1e_fb_private_t Private;
} MC_ReadActualTorque_t;
CM1E_API void MC_ReadActualTorque(MC_ReadActualTorque_t *fb);

/** 3.27. Reads the state of the axis. While Valid is TRUE, exactly one of the eight state outputs is TRUE.
 *  @rt cycle */
typedef struct MC_ReadStatus_t {
    AXIS_REF_t *Axis;
    BOOL Enable;
    /* outputs */
    BOOL Valid, Busy, Error;
    WORD ErrorID;
    BOOL ErrorStop, Disabled, Stopping, Homing, Standstill, DiscreteMotion, ContinuousMotion, SynchronizedMotion;
    cm1e_fb_private_t Private;
} MC_ReadStatus_t;
CM1E_API void MC_ReadStatus(MC_ReadStatus_t *fb);

/** 3.28. Reads how the axis moves. While Valid is TRUE, exactly one of the first three values is TRUE. @rt cycle */
typedef struct MC_ReadMotionState_t {
    AXIS_REF_t *Axis;
    BOOL Enable;
    MC_SOURCE Source;       /**< which velocity is evaluated */
    /* outputs */
    BOOL Valid, Busy, Error;
    WORD ErrorID;
    BOOL ConstantVelocity;  /**< the velocity does not change; also TRUE at velocity 0 */
    BOOL Accelerating;      /**< the amount of the velocity grows */
    BOOL Decelerating;      /**< the amount of the velocity falls */
    BOOL DirectionPositive; /**< the position grows */
    BOOL DirectionNegative; /**< the position falls */
    cm1e_motion_private_t Private;
} MC_ReadMotionState_t;
CM1E_API void MC_ReadMotionState(MC_ReadMotionState_t *fb);

/** 3.29. Reads inputs and conditions of the axis. @rt cycle */
typedef struct MC_ReadAxisInfo_t {
    AXIS_REF_t *Axis;
    BOOL Enable;
    /* outputs */
    BOOL Valid, Busy, Error;
    WORD ErrorID;
    BOOL HomeAbsSwitch;      /**< the home switch is on */
    BOOL LimitSwitchPos;     /**< the positive limit switch is on */
    BOOL LimitSwitchNeg;     /**< the negative limit switch is on */
    BOOL Simulation;         /**< the motor is a simulated one */
    BOOL CommunicationReady; /**< the motor takes part in the bus cycle */
    BOOL ReadyForPowerOn;    /**< the drive can be enabled */
    BOOL PowerOn;            /**< the power stage is on */
    BOOL IsHomed;            /**< the absolute position is known */
    BOOL AxisWarning;        /**< the drive warns */
    cm1e_fb_private_t Private;
} MC_ReadAxisInfo_t;
CM1E_API void MC_ReadAxisInfo(MC_ReadAxisInfo_t *fb);

/** 3.30. Reads the error of the axis: the reason why it is in ErrorStop. @rt cycle */
typedef struct MC_ReadAxisError_t {
    AXIS_REF_t *Axis;
    BOOL Enable;
    /* outputs */
    BOOL Valid, Busy, Error;
    WORD ErrorID;
    WORD AxisErrorID;     /**< ErrorID of the cause; 0: none */
    WORD DeviceErrorCode; /**< 0x603F of the drive at that error (not in the standard) */
    cm1e_fb_private_t Private;
} MC_ReadAxisError_t;
CM1E_API void MC_ReadAxisError(MC_ReadAxisError_t *fb);

/** 3.31. Takes the axis out of ErrorStop. @rt cycle */
typedef struct MC_Reset_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    /* outputs */
    BOOL Done; /**< the axis is in Disabled or Standstill */
    BOOL Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_Reset_t;
CM1E_API void MC_Reset(MC_Reset_t *fb);

/** 3.32. Switches outputs by the position of the axis, like cams on its shaft. @rt cycle */
typedef struct MC_DigitalCamSwitch_t {
    AXIS_REF_t *Axis;
    const MC_CAMSWITCH_REF *Switches;
    MC_OUTPUT_REF *Outputs;
    const MC_TRACK_REF *TrackOptions; /**< NULL: no compensation and no hysteresis */
    BOOL Enable;
    DWORD EnableMask;                 /**< bit 0 = track 1; a track whose bit is 0 is off */
    MC_SOURCE ValueSource;            /**< mcSetValue or mcActualValue */
    /* outputs */
    BOOL InOperation;                 /**< the tracks are switched */
    BOOL Busy, Error;
    WORD ErrorID;
    cm1e_cam_private_t Private;
} MC_DigitalCamSwitch_t;
CM1E_API void MC_DigitalCamSwitch(MC_DigitalCamSwitch_t *fb);

/** 3.33. Records the position at the first trigger event after the edge. @rt cycle */
typedef struct MC_TouchProbe_t {
    AXIS_REF_t *Axis;
    const MC_TRIGGER_REF *TriggerInput; /**< NULL: the rising edge of input 1 of the axis */
    BOOL Execute;
    BOOL WindowOnly;                    /**< TRUE: only events between the two positions, both included */
    LREAL FirstPosition;                /**< u; beginning of the window */
    LREAL LastPosition;                 /**< u; end of the window */
    /* outputs */
    BOOL Done;                          /**< an event is recorded */
    BOOL Busy;
    BOOL CommandAborted;                /**< by MC_AbortTrigger */
    BOOL Error;
    WORD ErrorID;
    LREAL RecordedPosition;             /**< u; actual position at the event */
    LREAL Uncertainty;                  /**< u; maximum distance of the event from RecordedPosition (not in the
                                             standard) */
    cm1e_fb_private_t Private;
} MC_TouchProbe_t;
CM1E_API void MC_TouchProbe(MC_TouchProbe_t *fb);

/** 3.34. Disarms the trigger of an MC_TouchProbe. @rt cycle */
typedef struct MC_AbortTrigger_t {
    AXIS_REF_t *Axis;
    const MC_TRIGGER_REF *TriggerInput; /**< as for MC_TouchProbe */
    BOOL Execute;
    /* outputs */
    BOOL Done;                          /**< the trigger is no longer armed */
    BOOL Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_AbortTrigger_t;
CM1E_API void MC_AbortTrigger(MC_AbortTrigger_t *fb);

#ifdef __cplusplus
}
#endif
#endif
