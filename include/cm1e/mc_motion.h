/**
 * @file mc_motion.h
 * The blocks that move an axis (PLCopen Part 1 v2.0, chapter 3), and TwinCAT's MC_Jog.
 * Generated from fb/interface/motion.st by fb/interface/generate.py; change it there.
 */
#ifndef CM1E_MC_MOTION_H
#define CM1E_MC_MOTION_H

#include "cm1e/api.h"
#include "cm1e/config.h"
#include "cm1e/mc_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/** 3.1. Controls the power stage; an axis has one MC_Power. Status is TRUE while the power stage is on and set-
 *  points act. Error is TRUE also while the axis is in ErrorStop and the power stage therefore stays off. The block
 *  controls the axis that was latched at Enable's edge until the power stage is off. @rt cycle */
typedef struct MC_Power_t {
    AXIS_REF_t *Axis;
    BOOL Enable;         /**< TRUE: power on, FALSE: off; a level */
    BOOL EnablePositive; /**< permits motion in positive direction; a level */
    BOOL EnableNegative; /**< permits motion in negative direction; a level */
    /* outputs */
    BOOL Status;         /**< the power stage is on and set-points act */
    BOOL Valid;          /**< Enable is TRUE and there is no error */
    BOOL Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_Power_t;
CM1E_API void MC_Power(MC_Power_t *fb);

/** 3.2. Homes by the motor's own routine (UG 6.2.4). When Done, the axis has the position Position at the
 *  reference. @rt cycle */
typedef struct MC_Home_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    LREAL Position;                         /**< u; position of the axis at the reference */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL Done;                              /**< the reference is known and set */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    const cm1e_homing_config_t *Parameters; /**< NULL selects the configured homing of the axis (not in the standard) */
    cm1e_fb_private_t Private;
} MC_Home_t;
CM1E_API void MC_Home(MC_Home_t *fb);

/** 3.3. Stops the axis and holds it in Stopping while Execute is TRUE. Done and Active are TRUE together then.
 *  @rt cycle */
typedef struct MC_Stop_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    LREAL Deceleration; /**< u/s2, >= 0; 0, or a value above the axis maximum, selects the axis maximum */
    LREAL Jerk;         /**< u/s3, >= 0; 0, or a value above the axis maximum, selects the axis maximum */
    /* outputs */
    BOOL Done;          /**< the set velocity is 0 */
    BOOL Busy;
    BOOL Active;        /**< (not in the standard) */
    BOOL CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_Stop_t;
CM1E_API void MC_Stop(MC_Stop_t *fb);

/** 3.4. Stops the axis; any motion may abort it. @rt cycle */
typedef struct MC_Halt_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    LREAL Deceleration; /**< u/s2, >= 0; 0, or a value above the axis maximum, selects the axis maximum */
    LREAL Jerk;         /**< u/s3, >= 0; 0, or a value above the axis maximum, selects the axis maximum */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL Done;          /**< the set velocity is 0 */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_Halt_t;
CM1E_API void MC_Halt(MC_Halt_t *fb);

/** 3.5. Moves to a position and stops there. @rt cycle */
typedef struct MC_MoveAbsolute_t {
    AXIS_REF_t *Axis;
    BOOL Execute, ContinuousUpdate;
    LREAL Position;         /**< u; target */
    LREAL Velocity;         /**< u/s, > 0 ... maximum; maximum of the motion, not necessarily reached */
    LREAL Acceleration;     /**< u/s2, 0 ... maximum; 0 selects the axis maximum */
    LREAL Deceleration;     /**< u/s2, 0 ... maximum; 0 selects the axis maximum */
    LREAL Jerk;             /**< u/s3, 0 ... maximum; 0 selects the axis maximum */
    MC_DIRECTION Direction; /**< modulo axes only; 0: mcShortestWay */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL Done;              /**< the set position is the target */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_MoveAbsolute_t;
CM1E_API void MC_MoveAbsolute(MC_MoveAbsolute_t *fb);

/** 3.6. Moves by a distance from the set position at the start. @rt cycle */
typedef struct MC_MoveRelative_t {
    AXIS_REF_t *Axis;
    BOOL Execute, ContinuousUpdate;
    LREAL Distance;     /**< u */
    LREAL Velocity;     /**< u/s, > 0 ... maximum; maximum of the motion, not necessarily reached */
    LREAL Acceleration; /**< u/s2, 0 ... maximum; 0 selects the axis maximum */
    LREAL Deceleration; /**< u/s2, 0 ... maximum; 0 selects the axis maximum */
    LREAL Jerk;         /**< u/s3, 0 ... maximum; 0 selects the axis maximum */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL Done;          /**< the set position has gone the distance */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_MoveRelative_t;
CM1E_API void MC_MoveRelative(MC_MoveRelative_t *fb);

/** 3.7. Moves by a distance from the most recent commanded position, which may be that of an aborted move. In
 *  ContinuousMotion it counts from the set position. @rt cycle */
typedef struct MC_MoveAdditive_t {
    AXIS_REF_t *Axis;
    BOOL Execute, ContinuousUpdate;
    LREAL Distance;     /**< u */
    LREAL Velocity;     /**< u/s, > 0 ... maximum; maximum of the motion, not necessarily reached */
    LREAL Acceleration; /**< u/s2, 0 ... maximum; 0 selects the axis maximum */
    LREAL Deceleration; /**< u/s2, 0 ... maximum; 0 selects the axis maximum */
    LREAL Jerk;         /**< u/s3, 0 ... maximum; 0 selects the axis maximum */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL Done;          /**< the set position is the new target */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_MoveAdditive_t;
CM1E_API void MC_MoveAdditive(MC_MoveAdditive_t *fb);

/** 3.8. Adds a motion over a distance to the running motion, which is not interrupted. @rt cycle */
typedef struct MC_MoveSuperimposed_t {
    AXIS_REF_t *Axis;
    BOOL Execute, ContinuousUpdate;
    LREAL Distance;        /**< u; distance to be added */
    LREAL VelocityDiff;    /**< u/s, > 0 ... maximum; maximum difference to the velocity of the running motion */
    LREAL Acceleration;    /**< u/s2, 0 ... maximum; in addition to that of the running motion; 0 selects what that
                                leaves */
    LREAL Deceleration;    /**< u/s2, 0 ... maximum; as Acceleration */
    LREAL Jerk;            /**< u/s3, 0 ... maximum; as Acceleration */
    /* outputs */
    BOOL Done;             /**< the distance has been added */
    BOOL Busy, CommandAborted, Error;
    WORD ErrorID;
    LREAL CoveredDistance; /**< u; added by this block since its start */
    cm1e_fb_private_t Private;
} MC_MoveSuperimposed_t;
CM1E_API void MC_MoveSuperimposed(MC_MoveSuperimposed_t *fb);

/** 3.9. Ends a superimposed motion; the base motion goes on. @rt cycle */
typedef struct MC_HaltSuperimposed_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    LREAL Deceleration; /**< u/s2, 0 ... maximum; 0 selects what the base motion leaves */
    LREAL Jerk;         /**< u/s3, 0 ... maximum; as Deceleration */
    /* outputs */
    BOOL Done;          /**< nothing is superimposed any more */
    BOOL Busy;
    BOOL Active;        /**< (in the standard's drawing, not in its table) */
    BOOL CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_HaltSuperimposed_t;
CM1E_API void MC_HaltSuperimposed(MC_HaltSuperimposed_t *fb);

/** 3.10. Moves at a velocity until another command ends it. A negative Velocity reverses Direction. @rt cycle */
typedef struct MC_MoveVelocity_t {
    AXIS_REF_t *Axis;
    BOOL Execute, ContinuousUpdate;
    LREAL Velocity;         /**< u/s, +-maximum, not 0; a negative value reverses Direction */
    LREAL Acceleration;     /**< u/s2, 0 ... maximum; 0 selects the axis maximum */
    LREAL Deceleration;     /**< u/s2, 0 ... maximum; 0 selects the axis maximum */
    LREAL Jerk;             /**< u/s3, 0 ... maximum; 0 selects the axis maximum */
    MC_DIRECTION Direction; /**< 0: mcPositiveDirection; not mcShortestWay */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL InVelocity;        /**< the set velocity equals the commanded velocity */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_MoveVelocity_t;
CM1E_API void MC_MoveVelocity(MC_MoveVelocity_t *fb);

/** 3.11. Moves to a position, arrives there with EndVelocity and continues at that velocity. @rt cycle */
typedef struct MC_MoveContinuousAbsolute_t {
    AXIS_REF_t *Axis;
    BOOL Execute, ContinuousUpdate;
    LREAL Position;         /**< u; target */
    LREAL EndVelocity;      /**< u/s, +-maximum; signed */
    LREAL Velocity;         /**< u/s, > 0 ... maximum; maximum of the motion */
    LREAL Acceleration;     /**< u/s2, 0 ... maximum; 0 selects the axis maximum */
    LREAL Deceleration;     /**< u/s2, 0 ... maximum; 0 selects the axis maximum */
    LREAL Jerk;             /**< u/s3, 0 ... maximum; 0 selects the axis maximum */
    MC_DIRECTION Direction; /**< modulo axes only; 0: mcShortestWay */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL InEndVelocity;     /**< the target was passed and the set velocity is EndVelocity */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_MoveContinuousAbsolute_t;
CM1E_API void MC_MoveContinuousAbsolute(MC_MoveContinuousAbsolute_t *fb);

/** 3.12. Moves by a distance, ends it with EndVelocity and continues at that velocity. @rt cycle */
typedef struct MC_MoveContinuousRelative_t {
    AXIS_REF_t *Axis;
    BOOL Execute, ContinuousUpdate;
    LREAL Distance;     /**< u; from the set position at the start */
    LREAL EndVelocity;  /**< u/s, +-maximum; signed */
    LREAL Velocity;     /**< u/s, > 0 ... maximum; maximum of the motion */
    LREAL Acceleration; /**< u/s2, 0 ... maximum; 0 selects the axis maximum */
    LREAL Deceleration; /**< u/s2, 0 ... maximum; 0 selects the axis maximum */
    LREAL Jerk;         /**< u/s3, 0 ... maximum; 0 selects the axis maximum */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL InEndVelocity; /**< the distance was covered and the set velocity is EndVelocity */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_MoveContinuousRelative_t;
CM1E_API void MC_MoveContinuousRelative(MC_MoveContinuousRelative_t *fb);

/** 3.13. Exerts a torque. The CM1-E has no torque mode (0x6502 = 0x1A5), so the block always shows
 *  CM1E_ERROR_AXIS_NO_TORQUE_MODE. @rt cycle */
typedef struct MC_TorqueControl_t {
    AXIS_REF_t *Axis;
    BOOL Execute, ContinuousUpdate;
    LREAL Torque;       /**< % of rated torque; signed */
    LREAL TorqueRamp;   /**< %/s */
    LREAL Velocity;     /**< u/s */
    LREAL Acceleration; /**< u/s2 */
    LREAL Deceleration; /**< u/s2 */
    LREAL Jerk;         /**< u/s3 */
    MC_DIRECTION Direction;
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL InTorque, Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_TorqueControl_t;
CM1E_API void MC_TorqueControl(MC_TorqueControl_t *fb);

/** 3.14. Runs through a table of positions over time. @rt cycle */
typedef struct MC_PositionProfile_t {
    AXIS_REF_t *Axis;
    const MC_TP_REF *TimePosition; /**< copied at the edge */
    BOOL Execute, ContinuousUpdate;
    LREAL TimeScale;               /**< > 0; factor for all times; 0 acts as 1 */
    LREAL PositionScale;           /**< factor for all positions; 0 acts as 1 */
    LREAL Offset;                  /**< u; added to all positions */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL Done;                     /**< the profile's end is reached */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_PositionProfile_t;
CM1E_API void MC_PositionProfile(MC_PositionProfile_t *fb);

/** 3.15. Runs through a table of velocities over time and keeps the last one. @rt cycle */
typedef struct MC_VelocityProfile_t {
    AXIS_REF_t *Axis;
    const MC_TV_REF *TimeVelocity; /**< copied at the edge */
    BOOL Execute, ContinuousUpdate;
    LREAL TimeScale;               /**< > 0; factor for all times; 0 acts as 1 */
    LREAL VelocityScale;           /**< factor for all velocities; 0 acts as 1 */
    LREAL Offset;                  /**< u/s; added to all velocities */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL ProfileCompleted;         /**< the profile's end is reached; its last velocity is kept */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_VelocityProfile_t;
CM1E_API void MC_VelocityProfile(MC_VelocityProfile_t *fb);

/** 3.16. Runs through a table of accelerations over time and keeps the velocity at its end. @rt cycle */
typedef struct MC_AccelerationProfile_t {
    AXIS_REF_t *Axis;
    const MC_TA_REF *TimeAcceleration; /**< copied at the edge */
    BOOL Execute, ContinuousUpdate;
    LREAL TimeScale;                   /**< > 0; factor for all times; 0 acts as 1 */
    LREAL AccelerationScale;           /**< factor for all accelerations; 0 acts as 1 */
    LREAL Offset;                      /**< u/s2; added to all accelerations */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL ProfileCompleted;             /**< the profile's end is reached; the velocity there is kept */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_AccelerationProfile_t;
CM1E_API void MC_AccelerationProfile(MC_AccelerationProfile_t *fb);

/** Tc2_MC2. Moves the axis by push-buttons, like TwinCAT's block of this name. @rt cycle */
typedef struct MC_Jog_t {
    AXIS_REF_t *Axis;
    BOOL JogForward;    /**< moves in positive direction from its rising edge on; both buttons TRUE: stop */
    BOOL JogBackwards;  /**< as JogForward, in negative direction */
    E_JogMode Mode;
    LREAL Position;     /**< u, > 0; step of the inching modes */
    LREAL Velocity;     /**< u/s, > 0 ... maximum; this and the next three are not used in the two standard modes */
    LREAL Acceleration; /**< u/s2, 0 ... maximum; 0 selects the axis maximum */
    LREAL Deceleration; /**< u/s2, 0 ... maximum; 0 selects the axis maximum */
    LREAL Jerk;         /**< u/s3, 0 ... maximum; 0 selects the axis maximum */
    /* outputs */
    BOOL Done;          /**< the jog has ended and the axis is at standstill */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_jog_private_t Private;
} MC_Jog_t;
CM1E_API void MC_Jog(MC_Jog_t *fb);

/** CODESYS: SMC_FollowPosition; TwinCAT: MC_ExtSetPointGenFeed. Follows positions that another planner has
 *  computed: that of a numerical control, of a robot, of a simulation. Execute begins at the position where the
 *  axis stands; from then on Position is read in every call. @rt cycle */
typedef struct CM_FollowPosition_t {
    AXIS_REF_t *Axis;
    BOOL Execute;
    LREAL Position; /**< u; of this cycle; read in every call */
    /* outputs */
    BOOL Busy;
    BOOL Active;    /**< the positions move the axis */
    BOOL CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} CM_FollowPosition_t;
CM1E_API void CM_FollowPosition(CM_FollowPosition_t *fb);

#ifdef __cplusplus
}
#endif
#endif
