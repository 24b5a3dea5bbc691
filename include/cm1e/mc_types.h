/**
 * @file mc_types.h
 * The data types of the motion function blocks. PLCopen leaves the contents of the ..._REF types to the vendor.
 * Enumerators are the standard's. Where the standard gives no numbers, 0, the value in a zeroed struct, is the usual
 * choice.
 * Generated from fb/interface/types.st by fb/interface/generate.py; change it there.
 */
#ifndef CM1E_MC_TYPES_H
#define CM1E_MC_TYPES_H

#include "cm1e/axis.h"

#ifdef __cplusplus
extern "C" {
#endif

/** When a command starts, and how it follows the one before it (Part 1, 2.4.2). */
typedef enum MC_BUFFER_MODE {
    mcAborting = 0,         /**< at once; the running and all waiting commands are aborted */
    mcBuffered = 1,         /**< when the command before has ended; a move has then come to rest */
    mcBlendingLow = 2,      /**< without a stop: the end position is passed at the lower of both velocities */
    mcBlendingPrevious = 3, /**< without a stop: at the velocity of the command before */
    mcBlendingNext = 4,     /**< without a stop: at the velocity of this command */
    mcBlendingHigh = 5,     /**< without a stop: at the higher of both velocities */
} MC_BUFFER_MODE;

/** Direction of a move. The last two are for MC_HOME_DIRECTION only. */
typedef enum MC_DIRECTION {
    mcPositiveDirection = 1,
    mcShortestWay = 2,
    mcNegativeDirection = 3,
    mcCurrentDirection = 4,
    mcSwitchPositive = 5, /**< Part 5: positive while the switch is off, negative while it is on */
    mcSwitchNegative = 7, /**< Part 5: negative while the switch is off, positive while it is on */
} MC_DIRECTION;

/** Direction of a homing step (Part 5): mcPositiveDirection, mcNegativeDirection, mcSwitchPositive,
 *  mcSwitchNegative; 0 acts as mcPositiveDirection. */
typedef MC_DIRECTION MC_HOME_DIRECTION;

/** What ends the search of a homing step (Part 5). */
typedef enum MC_SWITCH_MODE {
    mcOn = 0,                 /**< the switch is on */
    mcOff = 1,                /**< the switch is off */
    mcRisingEdge = 2,         /**< the switch goes on */
    mcFallingEdge = 3,        /**< the switch goes off */
    mcEdgeSwitchPositive = 4, /**< goes on in positive motion, goes off in negative motion */
    mcEdgeSwitchNegative = 5, /**< goes off in positive motion, goes on in negative motion */
} MC_SWITCH_MODE;

/** When an administrative block acts. */
typedef enum MC_EXECUTION_MODE {
    mcImmediately = 0, /**< at once, also in motion; the state does not change */
    mcQueued = 1,      /**< in order after the waiting commands; refused in this version */
} MC_EXECUTION_MODE;

/** Which value of an axis is used. */
typedef enum MC_SOURCE {
    mcSetValue = 0,       /**< the set-point of this cycle */
    mcActualValue = 1,    /**< measured by the motor */
    mcCommandedValue = 2, /**< the value that the active command requests */
} MC_SOURCE;

/** TwinCAT's modes of MC_Jog, in its spelling. */
typedef enum E_JogMode {
    MC_JOGMODE_STANDARD_SLOW = 0,  /**< the slow jog velocity of the bus file */
    MC_JOGMODE_STANDARD_FAST = 1,  /**< the fast jog velocity of the bus file */
    MC_JOGMODE_CONTINOUS = 2,      /**< Velocity, Acceleration, Deceleration, Jerk of the block */
    MC_JOGMODE_INCHING = 3,        /**< one step of Position at every edge */
    MC_JOGMODE_INCHING_MODULO = 4, /**< as INCHING, to the next multiple of Position */
} E_JogMode;

/** How MC_CamIn places a cam, and how the slave reaches it (4.3). */
typedef enum MC_START_MODE {
    mcAbsolute = 0, /**< as MC_CamTableSelect says; the slave must be on the cam already */
    mcRelative = 1, /**< as mcAbsolute, but the positions of the slave count from where it is at the start */
    mcRampIn = 2,   /**< as MC_CamTableSelect says; the slave approaches the cam while the master goes on */
} MC_START_MODE;

/** How MC_GearInPos synchronises (4.7). */
typedef enum MC_SYNC_MODE {
    mcShortest = 0, /**< with the smaller change of velocity */
    mcCatchUp = 1,  /**< by going faster than the ratio */
    mcSlowDown = 2, /**< by going slower than the ratio */
} MC_SYNC_MODE;

/** How MC_CombineAxes combines the motions of its masters (4.10). */
typedef enum MC_COMBINE_MODE {
    mcAddAxes = 0, /**< Master1 + Master2 */
    mcSubAxes = 1, /**< Master1 - Master2 */
} MC_COMBINE_MODE;

/** How a cam interpolates between its points (not in the standard). */
typedef enum MC_CAM_CURVE {
    mcCamPolynomial5 = 0, /**< polynomials of degree 5 through Slave, Velocity and Acceleration of each point */
    mcCamCubicSpline = 1, /**< a cubic spline through Slave, without a step of acceleration */
    mcCamLinear = 2,      /**< straight lines: a step of velocity at every point */
} MC_CAM_CURVE;

/** A point of a cam. */
typedef struct MC_CAM_POINT {
    LREAL Master;       /**< u of the master; rising from point to point */
    LREAL Slave;        /**< u of the slave */
    LREAL Velocity;     /**< u of the slave / u of the master; mcCamPolynomial5 only */
    LREAL Acceleration; /**< u of the slave / u2 of the master; mcCamPolynomial5 only */
} MC_CAM_POINT;

/** A cam. MC_CamTableSelect copies it, so it may be changed and selected again while the old copy is in use. */
typedef struct MC_CAM_REF {
    const MC_CAM_POINT *Points; /**< the first point; the application owns the points */
    UINT NumberOfPoints;        /**< 2 ... `cam_points` of the slave in the bus file */
    MC_CAM_CURVE Curve;
} MC_CAM_REF;

/** Identifies a cam that MC_CamTableSelect has prepared for its slave; 0: none. */
typedef UDINT MC_CAM_ID;

/** Digital input of an axis, for MC_ReadDigitalInput. */
typedef struct MC_INPUT_REF {
    AXIS_REF_t Axis; /**< whose input */
    INT Number;      /**< 1 ... 4; IN1 ... IN4, {11 ... 18} signals of other slaves; used if InputNumber is 0 */
} MC_INPUT_REF;

/** Digital output of an axis, for MC_ReadDigitalOutput and MC_WriteDigitalOutput; the outputs of
 *  MC_DigitalCamSwitch. */
typedef struct MC_OUTPUT_REF {
    AXIS_REF_t Axis; /**< whose output; Handle 0 (MC_DigitalCamSwitch only): no output is written, see Values */
    INT Number;      /**< 1; or {11 ... 18}, used if OutputNumber is 0; with MC_DigitalCamSwitch the output of track
                          1 */
    DWORD Values;    /**< MC_DigitalCamSwitch shows all its tracks here, bit 0 = track 1 */
} MC_OUTPUT_REF;

/** The trigger of MC_TouchProbe. */
typedef struct MC_TRIGGER_REF {
    AXIS_REF_t Axis;  /**< whose input; Handle 0: the block's Axis */
    INT InputNumber;  /**< 1 ... 4; IN1 ... IN4, {11 ... 18} signals of other slaves; 0 acts as 1 */
    BOOL FallingEdge; /**< TRUE: the input goes off; FALSE: it goes on */
} MC_TRIGGER_REF;

/** The signal of a homing step (Part 5). */
typedef struct MC_REF_SIGNAL_REF {
    AXIS_REF_t Axis; /**< whose input; Handle 0: the block's Axis */
    INT InputNumber; /**< 1 ... 4; IN1 ... IN4, {11 ... 18} signals of other slaves; 0 selects the home switch */
} MC_REF_SIGNAL_REF;

/** Maximum number of pairs of a profile, of switches and of tracks of MC_DigitalCamSwitch. */
#define CM1E_PROFILE_PAIRS 64
#define CM1E_CAM_SWITCHES 32
#define CM1E_CAM_TRACKS 32

/** A point of MC_PositionProfile (3.14). */
typedef struct MC_TP {
    TIME DeltaTime; /**< ns, > 0; the first may be 0; time since the previous point */
    LREAL Position; /**< u */
} MC_TP;

/** A position profile. */
typedef struct MC_TP_REF {
    WORD NumberOfPairs; /**< 1 ... CM1E_PROFILE_PAIRS */
    BOOL IsAbsolute;    /**< FALSE: positions count from the set position at the start */
    MC_TP MC_TP_Array[CM1E_PROFILE_PAIRS];
} MC_TP_REF;

/** A point of MC_VelocityProfile (3.15). */
typedef struct MC_TV {
    TIME DeltaTime; /**< ns, > 0; the first may be 0; time since the previous point */
    LREAL Velocity; /**< u/s */
} MC_TV;

/** A velocity profile. */
typedef struct MC_TV_REF {
    WORD NumberOfPairs; /**< 1 ... CM1E_PROFILE_PAIRS */
    BOOL IsAbsolute;    /**< FALSE: velocities count from the set velocity at the start */
    MC_TV MC_TV_Array[CM1E_PROFILE_PAIRS];
} MC_TV_REF;

/** A point of MC_AccelerationProfile (3.16). */
typedef struct MC_TA {
    TIME DeltaTime;     /**< ns, > 0; the first may be 0; time since the previous point */
    LREAL Acceleration; /**< u/s2 */
} MC_TA;

/** An acceleration profile. */
typedef struct MC_TA_REF {
    WORD NumberOfPairs; /**< 1 ... CM1E_PROFILE_PAIRS */
    BOOL IsAbsolute;    /**< FALSE: accelerations count from the set acceleration at the start */
    MC_TA MC_TA_Array[CM1E_PROFILE_PAIRS];
} MC_TA_REF;

/** One switch of MC_DigitalCamSwitch (3.32). */
typedef struct MC_CAMSWITCH {
    INT TrackNumber;       /**< 1 ... CM1E_CAM_TRACKS */
    LREAL FirstOnPosition; /**< u; the switch is on from here, in positive direction */
    LREAL LastOnPosition;  /**< u; the switch is on up to here; below FirstOnPosition on a modulo axis: over the end
                                of its range */
    INT AxisDirection;     /**< 0 both, 1 positive, 2 negative; direction of motion in which it switches */
    INT CamSwitchMode;     /**< 0 by position, 1 by time */
    TIME Duration;         /**< ns; with mode 1: how long the switch is on after FirstOnPosition */
} MC_CAMSWITCH;

/** The switches of MC_DigitalCamSwitch. */
typedef struct MC_CAMSWITCH_REF {
    UINT NumberOfSwitches; /**< 1 ... CM1E_CAM_SWITCHES */
    MC_CAMSWITCH Switches[CM1E_CAM_SWITCHES];
} MC_CAMSWITCH_REF;

/** One track of MC_DigitalCamSwitch (3.32). */
typedef struct MC_TRACK {
    TIME OnCompensation;  /**< ns; delay of switching on; negative: ahead of the position */
    TIME OffCompensation; /**< ns; delay of switching off; negative: ahead of the position */
    LREAL Hysteresis;     /**< u, >= 0; distance that the axis must leave a switching point before it switches again */
} MC_TRACK;

/** The tracks of MC_DigitalCamSwitch; element 1 is track 1. */
typedef struct MC_TRACK_REF {
    MC_TRACK Tracks[CM1E_CAM_TRACKS];
} MC_TRACK_REF;

/** Private state of a block. */
typedef struct cm1e_fb_private {
    DWORD command;          /**< number of the command of the axis; 0: none */
    UINT axis_handle;       /**< latched at the rising edge */
    WORD error_id;
    BOOL trigger_before;    /**< Execute or Enable at the last call */
    BOOL state;
    BOOL continuous_update; /**< was TRUE at the edge and in every call since */
    BOOL active;            /**< value of Active at the last call */
} cm1e_fb_private_t;

/** Private state of a block that couples a slave; `common` has latched the slave. */
typedef struct cm1e_coupling_private {
    cm1e_fb_private_t common;
    UINT master;        /**< latched at the rising edge */
    UINT second_master; /**< latched at the rising edge; of MC_CombineAxes */
    UDINT ends;         /**< number of ends of the profile that MC_CamIn has shown */
} cm1e_coupling_private_t;

/** Private state of MC_ReadMotionState. */
typedef struct cm1e_motion_private {
    cm1e_fb_private_t common;
    LREAL reference; /**< u/s; reference speed for detecting a change */
    TIME changed;    /**< time of the last change */
    BOOL rising, measuring;
} cm1e_motion_private_t;

/** Private state of MC_Jog. */
typedef struct cm1e_jog_private {
    cm1e_fb_private_t common;
    TIME called;        /**< time of the last call */
    LREAL deceleration; /**< u/s2; latched at the edge */
    LREAL jerk;         /**< u/s3; latched at the edge */
    BOOL forward_before, backwards_before;
    BOOL backwards;     /**< direction of the running jog */
    BOOL held;          /**< the jog goes on as long as its button is held */
    BOOL stopping;      /**< the jog is being stopped */
} cm1e_jog_private_t;

/** Private: a point that passes a switch of MC_DigitalCamSwitch. */
typedef struct cm1e_cam_point {
    LREAL position; /**< u; at the last call */
    BOOL inside;
    BOOL held;      /**< 1, 2: at the first or last position; nothing switches there until the hysteresis is left */
} cm1e_cam_point_t;

/** Private state of a switch of MC_DigitalCamSwitch. */
typedef struct cm1e_cam_switch {
    cm1e_cam_point_t on_point, off_point;
    BOOL wanted;       /**< switched on by position or time, before compensation */
    TIME wanted_until; /**< end of an on-time in mode 1 */
    TIME on_from;      /**< when the delayed switch goes on */
    TIME off_at;       /**< when the delayed switch goes off */
    TIME still_until;  /**< end of the previous on-time */
} cm1e_cam_switch_t;

/** Private state of MC_DigitalCamSwitch. */
typedef struct cm1e_cam_private {
    cm1e_fb_private_t common;
    TIME called;    /**< time of the last call */
    TIME seen;      /**< when the position was known last */
    LREAL position; /**< u; at the last call */
    LREAL turn;     /**< u; farthest position of the axis in its direction */
    BOOL running;   /**< the last call knew the position */
    BOOL negative;  /**< direction of the last motion */
    BOOL moved;     /**< the axis has moved */
    UINT output;    /**< handle of the axis whose outputs are written */
    WORD written;   /**< bit 0 ... 7: outputs 11 ... 18, bit 8 ... 11: outputs 1 ... 4 */
    cm1e_cam_switch_t switches[CM1E_CAM_SWITCHES];
} cm1e_cam_private_t;

/** The place of an axis in a group, 1 ... 8 (Part 4). */
typedef UINT MC_IDENT_IN_GROUP;

/** Coordinate system of the positions of a group (Part 4, 3.1). */
typedef enum MC_COORD_SYSTEM {
    mcACS = 0, /**< axis coordinates */
    mcMCS = 1, /**< machine coordinates; refused in this version */
    mcPCS = 2, /**< product coordinates; refused in this version */
} MC_COORD_SYSTEM;

/** How a motion of a group follows the one before it, with a BufferMode mcBlending... (Part 4, 11). */
typedef enum MC_TRANSITION_MODE {
    mcTMNone = 0,               /**< exactly along both segments, with a stop only where the direction breaks */
    mcTMStartVelocity = 1,      /**< refused in this version */
    mcTMConstantVelocity = 2,   /**< refused in this version */
    mcTMCornerDistance = 3,     /**< a smooth curve from TransitionParameter (u) before to as much after the corner */
    mcTMMaxCornerDeviation = 4, /**< a smooth curve within TransitionParameter (u) of the corner */
} MC_TRANSITION_MODE;

/** Meaning of AuxPoint of a circle (Part 4, 9.36). */
typedef enum MC_CIRC_MODE {
    mcBorder = 0, /**< a point on the arc */
    mcCenter = 1, /**< the centre of the circle */
    mcRadius = 2, /**< refused in this version */
} MC_CIRC_MODE;

/** Sense of rotation of a circle with mcCenter, seen against the direction of Z: from +X to +Y is
 *  mcCounterClockwise. */
typedef enum MC_CIRC_PATHCHOICE {
    mcClockwise = 0,
    mcCounterClockwise = 1,
} MC_CIRC_PATHCHOICE;

#ifdef __cplusplus
}
#endif
#endif
