/**
 * @file mc_group.h
 * The blocks of axes groups (PLCopen Part 4 v2.0, chapter 9): several axes along one path. cm1e_group_create() makes a
 * group. Positions are arrays; array element IdentInGroup - 1 belongs to the axis with that IdentInGroup. Lengths,
 * velocities and accelerations along the path are those of the first up to three axes of the group, X, Y and Z; further
 * axes move along in proportion. TransitionVelocity, OrientationMode and Tolerance of the standard, of its level E, are
 * not implemented.
 * Generated from fb/interface/group.st by fb/interface/generate.py; change it there.
 */
#ifndef CM1E_MC_GROUP_H
#define CM1E_MC_GROUP_H

#include "cm1e/api.h"
#include "cm1e/group.h"
#include "cm1e/mc_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Part 4 v2.0, 9.1. Makes an axis a member of a group. Axes on several buses need one scheduler that runs them
 *  all. @rt cycle */
typedef struct MC_AddAxisToGroup_t {
    AXES_GROUP_REF_t *AxesGroup;
    AXIS_REF_t *Axis;
    BOOL Execute;
    MC_IDENT_IN_GROUP IdentInGroup; /**< 0 ... 8; its place; 0 selects the first free one */
    /* outputs */
    BOOL Done, Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_AddAxisToGroup_t;
CM1E_API void MC_AddAxisToGroup(MC_AddAxisToGroup_t *fb);

/** Part 4 v2.0, 9.2. Takes an axis out of a group. @rt cycle */
typedef struct MC_RemoveAxisFromGroup_t {
    AXES_GROUP_REF_t *AxesGroup;
    BOOL Execute;
    MC_IDENT_IN_GROUP IdentInGroup; /**< 1 ... 8 */
    /* outputs */
    BOOL Done, Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_RemoveAxisFromGroup_t;
CM1E_API void MC_RemoveAxisFromGroup(MC_RemoveAxisFromGroup_t *fb);

/** Part 4 v2.0, 9.3. Takes all axes out of a group. A moving group is stopped along its path first. @rt cycle */
typedef struct MC_UngroupAllAxes_t {
    AXES_GROUP_REF_t *AxesGroup;
    BOOL Execute;
    /* outputs */
    BOOL Done, Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_UngroupAllAxes_t;
CM1E_API void MC_UngroupAllAxes(MC_UngroupAllAxes_t *fb);

/** Part 4 v2.0, 9.4. Reads which axis has a place in a group. @rt cycle */
typedef struct MC_GroupReadConfiguration_t {
    AXES_GROUP_REF_t *AxesGroup;
    BOOL Enable;
    MC_IDENT_IN_GROUP IdentInGroup; /**< 1 ... 8 */
    MC_COORD_SYSTEM CoordSystem;    /**< only mcACS is supported */
    /* outputs */
    BOOL Valid, Busy, Error;
    WORD ErrorID;
    AXIS_REF_t Axis;
    UINT AxisID;                    /**< handle of the axis */
    cm1e_fb_private_t Private;
} MC_GroupReadConfiguration_t;
CM1E_API void MC_GroupReadConfiguration(MC_GroupReadConfiguration_t *fb);

/** Part 4 v2.0, 9.6. Enables a group, which is then in GroupStandby. The block neither moves nor powers an axis.
 *  @rt cycle */
typedef struct MC_GroupEnable_t {
    AXES_GROUP_REF_t *AxesGroup;
    BOOL Execute;
    /* outputs */
    BOOL Done, Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_GroupEnable_t;
CM1E_API void MC_GroupEnable(MC_GroupEnable_t *fb);

/** Part 4 v2.0, 9.7. Disables a group. Its commands are aborted, and a moving group is stopped along its path.
 *  @rt cycle */
typedef struct MC_GroupDisable_t {
    AXES_GROUP_REF_t *AxesGroup;
    BOOL Execute;
    /* outputs */
    BOOL Done, Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_GroupDisable_t;
CM1E_API void MC_GroupDisable(MC_GroupDisable_t *fb);

/** Part 4 v2.0, 9.31. Resets a group in GroupErrorStop, and those of its axes that are in ErrorStop as MC_Reset
 *  does. @rt cycle */
typedef struct MC_GroupReset_t {
    AXES_GROUP_REF_t *AxesGroup;
    BOOL Execute;
    /* outputs */
    BOOL Done; /**< no axis is in ErrorStop */
    BOOL Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_GroupReset_t;
CM1E_API void MC_GroupReset(MC_GroupReset_t *fb);

/** Part 4 v2.0, 9.29. Reads the state of a group: one of the six outputs is TRUE while Valid is. @rt cycle */
typedef struct MC_GroupReadStatus_t {
    AXES_GROUP_REF_t *AxesGroup;
    BOOL Enable;
    /* outputs */
    BOOL Valid, Busy, Error;
    WORD ErrorID;
    BOOL GroupMoving;
    BOOL GroupHoming; /**< never TRUE in this version */
    BOOL GroupErrorStop, GroupStandby, GroupStopping, GroupDisabled;
    cm1e_fb_private_t Private;
} MC_GroupReadStatus_t;
CM1E_API void MC_GroupReadStatus(MC_GroupReadStatus_t *fb);

/** Part 4 v2.0, 9.30. Reads why a group is in GroupErrorStop; cm1e_group_error_text() describes it in sentences.
 *  @rt cycle */
typedef struct MC_GroupReadError_t {
    AXES_GROUP_REF_t *AxesGroup;
    BOOL Enable;
    /* outputs */
    BOOL Valid, Busy, Error;
    WORD ErrorID;
    WORD GroupErrorID; /**< the cause; 0: none */
    cm1e_fb_private_t Private;
} MC_GroupReadError_t;
CM1E_API void MC_GroupReadError(MC_GroupReadError_t *fb);

/** Part 4 v2.0, 9.25. Stops a group along its path and holds it: it stays in GroupStopping while Execute is TRUE.
 *  @rt cycle */
typedef struct MC_GroupStop_t {
    AXES_GROUP_REF_t *AxesGroup;
    BOOL Execute;
    LREAL Deceleration; /**< u/s2, >= 0; 0, or a higher value, selects as much as the axes allow */
    LREAL Jerk;         /**< u/s3, >= 0; 0, or a higher value, selects as much as the axes allow */
    /* outputs */
    BOOL Done;          /**< the set velocity is 0 */
    BOOL Busy, CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_GroupStop_t;
CM1E_API void MC_GroupStop(MC_GroupStop_t *fb);

/** Part 4 v2.0, 9.26. Stops a group along its path; any motion may abort it. @rt cycle */
typedef struct MC_GroupHalt_t {
    AXES_GROUP_REF_t *AxesGroup;
    BOOL Execute;
    LREAL Deceleration;        /**< u/s2, >= 0; 0, or a higher value, selects as much as the axes allow */
    LREAL Jerk;                /**< u/s3, >= 0; 0, or a higher value, selects as much as the axes allow */
    MC_BUFFER_MODE BufferMode; /**< mcAborting, mcBuffered */
    /* outputs */
    BOOL Done;                 /**< the set velocity is 0 */
    BOOL Busy, Active;
    BOOL CommandAccepted;      /**< the group has accepted the command, and it was not aborted */
    UDINT CommandID;           /**< number of the command; 0: none */
    BOOL CommandAborted, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_GroupHalt_t;
CM1E_API void MC_GroupHalt(MC_GroupHalt_t *fb);

/** Part 4 v2.0, 9.27. Interrupts the motion of a group: it comes to rest along its path, and keeps path and
 *  commands until MC_GroupContinue. @rt cycle */
typedef struct MC_GroupInterrupt_t {
    AXES_GROUP_REF_t *AxesGroup;
    BOOL Execute;
    LREAL Deceleration; /**< u/s2, >= 0; 0, or a higher value, selects as much as the axes allow */
    LREAL Jerk;         /**< u/s3, >= 0; 0, or a higher value, selects as much as the axes allow */
    /* outputs */
    BOOL Done;          /**< the set velocity is 0 */
    BOOL Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_GroupInterrupt_t;
CM1E_API void MC_GroupInterrupt(MC_GroupInterrupt_t *fb);

/** Part 4 v2.0, 9.28. Goes on with what MC_GroupInterrupt has interrupted. @rt cycle */
typedef struct MC_GroupContinue_t {
    AXES_GROUP_REF_t *AxesGroup;
    BOOL Execute;
    /* outputs */
    BOOL Done; /**< the commands of the group have control of it again */
    BOOL Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_GroupContinue_t;
CM1E_API void MC_GroupContinue(MC_GroupContinue_t *fb);

/** Part 4 v2.0, 9.34. Moves a group along a straight line to Position. @rt cycle */
typedef struct MC_MoveLinearAbsolute_t {
    AXES_GROUP_REF_t *AxesGroup;
    BOOL Execute;
    LREAL Position[8];                 /**< u; target, by IdentInGroup */
    LREAL Velocity;                    /**< u/s, >= 0; along the path; 0 selects as much as the axes allow */
    LREAL Acceleration;                /**< u/s2, >= 0; along the path; 0 selects as much as the axes allow */
    LREAL Deceleration;                /**< u/s2, >= 0; along the path; 0 selects as much as the axes allow */
    LREAL Jerk;                        /**< u/s3, >= 0; along the path; 0 selects as much as the axes allow */
    MC_COORD_SYSTEM CoordSystem;       /**< only mcACS is supported */
    MC_BUFFER_MODE BufferMode;
    MC_TRANSITION_MODE TransitionMode; /**< with BufferMode mcBlending... */
    LREAL TransitionParameter;         /**< u, > 0; used by mcTMCornerDistance and mcTMMaxCornerDeviation */
    /* outputs */
    BOOL Done;                         /**< the group has reached the end of this part of the path */
    BOOL Busy;
    BOOL Active;                       /**< the command moves the group */
    BOOL CommandAccepted;              /**< the group has accepted the command, and it was not aborted */
    BOOL CommandAborted, Error;
    WORD ErrorID;
    UDINT CommandID;                   /**< number of the command; 0: none */
    cm1e_fb_private_t Private;
} MC_MoveLinearAbsolute_t;
CM1E_API void MC_MoveLinearAbsolute(MC_MoveLinearAbsolute_t *fb);

/** Part 4 v2.0, 9.35. Moves a group along a straight line by Distance. @rt cycle */
typedef struct MC_MoveLinearRelative_t {
    AXES_GROUP_REF_t *AxesGroup;
    BOOL Execute;
    LREAL Distance[8];                 /**< u; distance, by IdentInGroup */
    LREAL Velocity;                    /**< u/s, >= 0; along the path; 0 selects as much as the axes allow */
    LREAL Acceleration;                /**< u/s2, >= 0; along the path; 0 selects as much as the axes allow */
    LREAL Deceleration;                /**< u/s2, >= 0; along the path; 0 selects as much as the axes allow */
    LREAL Jerk;                        /**< u/s3, >= 0; along the path; 0 selects as much as the axes allow */
    MC_COORD_SYSTEM CoordSystem;       /**< only mcACS is supported */
    MC_BUFFER_MODE BufferMode;
    MC_TRANSITION_MODE TransitionMode; /**< with BufferMode mcBlending... */
    LREAL TransitionParameter;         /**< u, > 0; used by mcTMCornerDistance and mcTMMaxCornerDeviation */
    /* outputs */
    BOOL Done;                         /**< the group has reached the end of this part of the path */
    BOOL Busy;
    BOOL Active;                       /**< the command moves the group */
    BOOL CommandAccepted;              /**< the group has accepted the command, and it was not aborted */
    BOOL CommandAborted, Error;
    WORD ErrorID;
    UDINT CommandID;                   /**< number of the command; 0: none */
    cm1e_fb_private_t Private;
} MC_MoveLinearRelative_t;
CM1E_API void MC_MoveLinearRelative(MC_MoveLinearRelative_t *fb);

/** Part 4 v2.0, 9.36. Moves a group along an arc to EndPoint; further axes move along. @rt cycle */
typedef struct MC_MoveCircularAbsolute_t {
    AXES_GROUP_REF_t *AxesGroup;
    BOOL Execute;
    MC_CIRC_MODE CircMode;             /**< what AuxPoint is */
    LREAL AuxPoint[8];                 /**< u; a point of the arc, or its centre */
    LREAL EndPoint[8];                 /**< u; target, by IdentInGroup */
    MC_CIRC_PATHCHOICE PathChoice;     /**< with mcCenter */
    LREAL Velocity;                    /**< u/s, >= 0; along the path; 0 selects as much as the axes allow */
    LREAL Acceleration;                /**< u/s2, >= 0; along the path; 0 selects as much as the axes allow */
    LREAL Deceleration;                /**< u/s2, >= 0; along the path; 0 selects as much as the axes allow */
    LREAL Jerk;                        /**< u/s3, >= 0; along the path; 0 selects as much as the axes allow */
    MC_COORD_SYSTEM CoordSystem;       /**< only mcACS is supported */
    MC_BUFFER_MODE BufferMode;
    MC_TRANSITION_MODE TransitionMode; /**< with BufferMode mcBlending... */
    LREAL TransitionParameter;         /**< u, > 0; used by mcTMCornerDistance and mcTMMaxCornerDeviation */
    /* outputs */
    BOOL Done;                         /**< the group has reached the end of this part of the path */
    BOOL Busy;
    BOOL Active;                       /**< the command moves the group */
    BOOL CommandAccepted;              /**< the group has accepted the command, and it was not aborted */
    BOOL CommandAborted, Error;
    WORD ErrorID;
    UDINT CommandID;                   /**< number of the command; 0: none */
    cm1e_fb_private_t Private;
} MC_MoveCircularAbsolute_t;
CM1E_API void MC_MoveCircularAbsolute(MC_MoveCircularAbsolute_t *fb);

/** Part 4 v2.0, 9.37. Moves a group along an arc by EndPoint; both points count from where the arc begins.
 *  @rt cycle */
typedef struct MC_MoveCircularRelative_t {
    AXES_GROUP_REF_t *AxesGroup;
    BOOL Execute;
    MC_CIRC_MODE CircMode;             /**< what AuxPoint is */
    LREAL AuxPoint[8];                 /**< u; a point of the arc, or its centre */
    LREAL EndPoint[8];                 /**< u; distance, by IdentInGroup */
    MC_CIRC_PATHCHOICE PathChoice;     /**< with mcCenter */
    LREAL Velocity;                    /**< u/s, >= 0; along the path; 0 selects as much as the axes allow */
    LREAL Acceleration;                /**< u/s2, >= 0; along the path; 0 selects as much as the axes allow */
    LREAL Deceleration;                /**< u/s2, >= 0; along the path; 0 selects as much as the axes allow */
    LREAL Jerk;                        /**< u/s3, >= 0; along the path; 0 selects as much as the axes allow */
    MC_COORD_SYSTEM CoordSystem;       /**< only mcACS is supported */
    MC_BUFFER_MODE BufferMode;
    MC_TRANSITION_MODE TransitionMode; /**< with BufferMode mcBlending... */
    LREAL TransitionParameter;         /**< u, > 0; used by mcTMCornerDistance and mcTMMaxCornerDeviation */
    /* outputs */
    BOOL Done;                         /**< the group has reached the end of this part of the path */
    BOOL Busy;
    BOOL Active;                       /**< the command moves the group */
    BOOL CommandAccepted;              /**< the group has accepted the command, and it was not aborted */
    BOOL CommandAborted, Error;
    WORD ErrorID;
    UDINT CommandID;                   /**< number of the command; 0: none */
    cm1e_fb_private_t Private;
} MC_MoveCircularRelative_t;
CM1E_API void MC_MoveCircularRelative(MC_MoveCircularRelative_t *fb);

/** Part 4 v2.0. Moves a group to Position as fast as its axes can; all axes reach their targets together. @rt cycle */
typedef struct MC_MoveDirectAbsolute_t {
    AXES_GROUP_REF_t *AxesGroup;
    BOOL Execute;
    LREAL Position[8];                 /**< u; target, by IdentInGroup */
    MC_COORD_SYSTEM CoordSystem;       /**< only mcACS is supported */
    MC_BUFFER_MODE BufferMode;
    MC_TRANSITION_MODE TransitionMode; /**< with BufferMode mcBlending... */
    LREAL TransitionParameter;         /**< u, > 0; used by mcTMCornerDistance and mcTMMaxCornerDeviation */
    /* outputs */
    BOOL Done;                         /**< the group has reached the end of this part of the path */
    BOOL Busy;
    BOOL Active;                       /**< the command moves the group */
    BOOL CommandAccepted;              /**< the group has accepted the command, and it was not aborted */
    BOOL CommandAborted, Error;
    WORD ErrorID;
    UDINT CommandID;                   /**< number of the command; 0: none */
    cm1e_fb_private_t Private;
} MC_MoveDirectAbsolute_t;
CM1E_API void MC_MoveDirectAbsolute(MC_MoveDirectAbsolute_t *fb);

/** Part 4 v2.0. Moves a group by Distance as fast as its axes can; all axes reach their targets together. @rt cycle */
typedef struct MC_MoveDirectRelative_t {
    AXES_GROUP_REF_t *AxesGroup;
    BOOL Execute;
    LREAL Distance[8];                 /**< u; distance, by IdentInGroup */
    MC_COORD_SYSTEM CoordSystem;       /**< only mcACS is supported */
    MC_BUFFER_MODE BufferMode;
    MC_TRANSITION_MODE TransitionMode; /**< with BufferMode mcBlending... */
    LREAL TransitionParameter;         /**< u, > 0; used by mcTMCornerDistance and mcTMMaxCornerDeviation */
    /* outputs */
    BOOL Done;                         /**< the group has reached the end of this part of the path */
    BOOL Busy;
    BOOL Active;                       /**< the command moves the group */
    BOOL CommandAccepted;              /**< the group has accepted the command, and it was not aborted */
    BOOL CommandAborted, Error;
    WORD ErrorID;
    UDINT CommandID;                   /**< number of the command; 0: none */
    cm1e_fb_private_t Private;
} MC_MoveDirectRelative_t;
CM1E_API void MC_MoveDirectRelative(MC_MoveDirectRelative_t *fb);

/** Part 4 v2.0, 9.14. Reads the positions of the axes of a group, all taken in the same cycle. @rt cycle */
typedef struct MC_GroupReadPosition_t {
    AXES_GROUP_REF_t *AxesGroup;
    BOOL Enable;
    MC_COORD_SYSTEM CoordSystem; /**< only mcACS is supported */
    MC_SOURCE Source;            /**< mcSetValue, mcActualValue */
    /* outputs */
    BOOL Valid, Busy, Error;
    WORD ErrorID;
    LREAL Position[8];           /**< u; by IdentInGroup; 0 where there is no axis */
    cm1e_fb_private_t Private;
} MC_GroupReadPosition_t;
CM1E_API void MC_GroupReadPosition(MC_GroupReadPosition_t *fb);

/** Part 4 v2.0, 9.15. Reads the velocities of the axes of a group, and the velocity along the path. @rt cycle */
typedef struct MC_GroupReadVelocity_t {
    AXES_GROUP_REF_t *AxesGroup;
    BOOL Enable;
    MC_COORD_SYSTEM CoordSystem; /**< only mcACS is supported */
    MC_SOURCE Source;            /**< mcSetValue, mcActualValue */
    /* outputs */
    BOOL Valid, Busy, Error;
    WORD ErrorID;
    LREAL Velocity[8];           /**< u/s; by IdentInGroup; 0 where there is no axis */
    LREAL PathVelocity;          /**< u/s */
    cm1e_fb_private_t Private;
} MC_GroupReadVelocity_t;
CM1E_API void MC_GroupReadVelocity(MC_GroupReadVelocity_t *fb);

/** Part 4 v2.0, 9.43. Sets a factor for the velocities of all motions of a group; it is kept until it is changed.
 *  @rt cycle */
typedef struct MC_GroupSetOverride_t {
    AXES_GROUP_REF_t *AxesGroup;
    BOOL Enable;
    LREAL VelFactor;  /**< 0 ... 1 */
    LREAL AccFactor;  /**< 1; other values are refused in this version */
    LREAL JerkFactor; /**< 1; other values are refused in this version */
    /* outputs */
    BOOL Enabled;     /**< the factors are in force */
    BOOL Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_GroupSetOverride_t;
/** Its initial values: `MC_GroupSetOverride_t fb = {.AxesGroup = &axis, MC_GROUPSETOVERRIDE_DEFAULTS};` */
#define MC_GROUPSETOVERRIDE_DEFAULTS .VelFactor = 1.0, .AccFactor = 1.0, .JerkFactor = 1.0
CM1E_API void MC_GroupSetOverride(MC_GroupSetOverride_t *fb);

#ifdef __cplusplus
}
#endif
#endif
