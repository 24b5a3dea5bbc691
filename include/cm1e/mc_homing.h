/**
 * @file mc_homing.h
 * Homing in steps (PLCopen Motion Control Part 5 v2.0, Homing Procedures).
 * Generated from fb/interface/homing.st by fb/interface/generate.py; change it there.
 */
#ifndef CM1E_MC_HOMING_H
#define CM1E_MC_HOMING_H

#include "cm1e/api.h"
#include "cm1e/mc_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Part 5, 3.1. Searches an absolute switch, reverses at a limit switch, and uses the place of the switch as
 *  reference. @rt cycle */
typedef struct MC_StepAbsoluteSwitch_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    MC_HOME_DIRECTION Direction;
    MC_SWITCH_MODE SwitchMode;
    MC_REF_SIGNAL_REF ReferenceSignal;
    LREAL Velocity;      /**< u/s, > 0 ... maximum; of the search */
    LREAL SetPosition;   /**< u; position of the axis at the reference; NaN: positions are not changed */
    LREAL TorqueLimit;   /**< % of rated torque, >= 0; the step fails above this torque; 0: no limit */
    TIME TimeLimit;      /**< ns, >= 0; 0 selects homing.timeout_s of the axis */
    LREAL DistanceLimit; /**< u, >= 0; of all movements together; 0: no limit */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL Done;           /**< the reference is found and set */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_StepAbsoluteSwitch_t;
CM1E_API void MC_StepAbsoluteSwitch(MC_StepAbsoluteSwitch_t *fb);

/** Part 5, 3.2. Searches a limit switch and uses its place as reference. @rt cycle */
typedef struct MC_StepLimitSwitch_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    MC_HOME_DIRECTION Direction;    /**< positive or negative */
    MC_SWITCH_MODE LimitSwitchMode; /**< one of the four modes without a direction */
    LREAL Velocity;                 /**< u/s, > 0 ... maximum; of the search */
    LREAL SetPosition;              /**< u; position of the axis at the reference; NaN: positions are not changed */
    LREAL TorqueLimit;              /**< % of rated torque, >= 0; the step fails above this torque; 0: no limit */
    TIME TimeLimit;                 /**< ns, >= 0; 0 selects homing.timeout_s of the axis */
    LREAL DistanceLimit;            /**< u, >= 0; of all movements together; 0: no limit */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL Done;                      /**< the reference is found and set */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_StepLimitSwitch_t;
CM1E_API void MC_StepLimitSwitch(MC_StepLimitSwitch_t *fb);

/** Part 5, 3.3. Moves against a hard stop and uses its place as reference. @rt cycle */
typedef struct MC_StepBlock_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    MC_HOME_DIRECTION Direction;  /**< positive or negative */
    LREAL Velocity;               /**< u/s, > 0 ... maximum; of the search */
    LREAL SetPosition;            /**< u; position of the axis at the reference; NaN: positions are not changed */
    LREAL DetectionVelocityLimit; /**< u/s, >= 0; below this velocity a pressing motor counts as blocked; 0 selects a
                                       tenth of Velocity */
    TIME DetectionVelocityTime;   /**< ns, >= 0; time for which that must last; 0 selects 50 ms */
    LREAL TorqueLimit;            /**< % of rated torque, >= 0; at this torque the stop is found; 0: the position lag
                                       shows the stop */
    TIME TimeLimit;               /**< ns, >= 0; 0 selects homing.timeout_s of the axis */
    LREAL DistanceLimit;          /**< u, >= 0; of all movements together; 0: no limit */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL Done;                    /**< the stop is found and set */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_StepBlock_t;
CM1E_API void MC_StepBlock(MC_StepBlock_t *fb);

/** Part 5, 3.4. Searches the reference pulse of an encoder. @rt cycle */
typedef struct MC_StepReferencePulse_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    MC_HOME_DIRECTION Direction; /**< positive or negative */
    MC_REF_SIGNAL_REF ReferenceSignal;
    LREAL Velocity;              /**< u/s, > 0 ... maximum; of the search */
    LREAL SetPosition;           /**< u; position of the axis at the reference; NaN: positions are not changed */
    LREAL TorqueLimit;           /**< % of rated torque, >= 0; 0: no limit */
    TIME TimeLimit;              /**< ns, >= 0; 0 selects homing.timeout_s of the axis */
    LREAL DistanceLimit;         /**< u, >= 0; of all movements together; 0: no limit */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL Done;                   /**< the reference is found and set */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_StepReferencePulse_t;
CM1E_API void MC_StepReferencePulse(MC_StepReferencePulse_t *fb);

/** Part 5, 3.5. Searches two marks of a distance coded encoder. @rt cycle */
typedef struct MC_StepDistanceCoded_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    MC_HOME_DIRECTION Direction; /**< positive or negative */
    LREAL Velocity;              /**< u/s, > 0 ... maximum; of the search */
    LREAL TorqueLimit;           /**< % of rated torque, >= 0; 0: no limit */
    TIME TimeLimit;              /**< ns, >= 0; 0 selects homing.timeout_s of the axis */
    LREAL DistanceLimit;         /**< u, >= 0; of all movements together; 0: no limit */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL Done;                   /**< the position is known and set */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_StepDistanceCoded_t;
CM1E_API void MC_StepDistanceCoded(MC_StepDistanceCoded_t *fb);

/** Part 5, 3.6. Sets the position of the axis at standstill, and ends the homing. @rt cycle */
typedef struct MC_HomeDirect_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    LREAL SetPosition; /**< u; new actual position */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL Done;         /**< the position is set */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_HomeDirect_t;
CM1E_API void MC_HomeDirect(MC_HomeDirect_t *fb);

/** Part 5, 3.7. Sets the position from an absolute encoder, and ends the homing. @rt cycle */
typedef struct MC_HomeAbsolute_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL Done; /**< the position is set */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_HomeAbsolute_t;
CM1E_API void MC_HomeAbsolute(MC_HomeAbsolute_t *fb);

/** Part 5, 3.8. Ends a homing of several steps, after an optional move away from the reference. @rt cycle */
typedef struct MC_FinishHoming_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    LREAL Distance;     /**< u; distance to move; 0: no move */
    LREAL Velocity;     /**< u/s, > 0 ... maximum */
    LREAL Acceleration; /**< u/s2, 0 ... maximum; 0 selects the axis maximum */
    LREAL Deceleration; /**< u/s2, 0 ... maximum; 0 selects the axis maximum */
    LREAL Jerk;         /**< u/s3, 0 ... maximum; 0 selects the axis maximum */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL Done;          /**< the axis is homed and in Standstill */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_FinishHoming_t;
CM1E_API void MC_FinishHoming(MC_FinishHoming_t *fb);

/** Part 5, 3.9. Uses the place of a switch as reference while another block moves the axis. @rt cycle */
typedef struct MC_StepReferenceFlyingSwitch_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    MC_SWITCH_MODE SwitchMode;
    MC_REF_SIGNAL_REF ReferenceSignal;
    LREAL SetPosition;   /**< u; position of the axis at the reference */
    TIME TimeLimit;      /**< ns, >= 0; 0 selects homing.timeout_s of the axis */
    LREAL DistanceLimit; /**< u, >= 0; of all movements together; 0: no limit */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL Done;           /**< the reference is found and set */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_StepReferenceFlyingSwitch_t;
CM1E_API void MC_StepReferenceFlyingSwitch(MC_StepReferenceFlyingSwitch_t *fb);

/** Part 5, 3.10. Uses the reference pulse of an encoder while another block moves the axis. @rt cycle */
typedef struct MC_StepReferenceFlyingRefPulse_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    MC_REF_SIGNAL_REF ReferenceSignal;
    LREAL SetPosition;   /**< u; position of the axis at the reference */
    TIME TimeLimit;      /**< ns, >= 0; 0 selects homing.timeout_s of the axis */
    LREAL DistanceLimit; /**< u, >= 0; of all movements together; 0: no limit */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL Done;           /**< the reference is found and set */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_StepReferenceFlyingRefPulse_t;
CM1E_API void MC_StepReferenceFlyingRefPulse(MC_StepReferenceFlyingRefPulse_t *fb);

/** Part 5, 3.11. Cancels the two flying steps; the motion goes on. @rt cycle */
typedef struct MC_AbortPassiveHoming_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    /* outputs */
    BOOL Done; /**< no flying step waits any more */
    BOOL Busy, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_AbortPassiveHoming_t;
CM1E_API void MC_AbortPassiveHoming(MC_AbortPassiveHoming_t *fb);

#ifdef __cplusplus
}
#endif
#endif
