/**
 * @file mc_multi_axis.h
 * The blocks of slaves that follow masters (PLCopen Part 1 v2.0, chapter 4).
 * Generated from fb/interface/multi_axis.st by fb/interface/generate.py; change it there.
 */
#ifndef CM1E_MC_MULTI_AXIS_H
#define CM1E_MC_MULTI_AXIS_H

#include "cm1e/api.h"
#include "cm1e/mc_types.h"

#ifdef __cplusplus
extern "C" {
#endif

/** 4.2. Prepares a cam for a slave. When Done, CamTableID is the value for MC_CamIn. @rt cycle */
typedef struct MC_CamTableSelect_t {
    AXIS_REF_t *Master;         /**< (not needed here; it may be NULL) */
    AXIS_REF_t *Slave;          /**< the axis whose memory takes the cam */
    const MC_CAM_REF *CamTable; /**< copied at the edge */
    BOOL Execute;
    BOOL Periodic;              /**< TRUE: the cam begins again at its end; FALSE: it is run once */
    BOOL MasterAbsolute;        /**< TRUE: the master positions of the cam are positions of the master; FALSE: they
                                     count from the start */
    BOOL SlaveAbsolute;         /**< TRUE: the slave positions of the cam are positions of the slave; FALSE: they
                                     count from the start */
    MC_EXECUTION_MODE ExecutionMode;
    /* outputs */
    BOOL Done;                  /**< CamTableID is valid */
    BOOL Busy, Error;
    WORD ErrorID;
    MC_CAM_ID CamTableID;       /**< 0: none */
    cm1e_fb_private_t Private;
} MC_CamTableSelect_t;
CM1E_API void MC_CamTableSelect(MC_CamTableSelect_t *fb);

/** 4.3. Lets the slave follow its master by a cam. @rt cycle */
typedef struct MC_CamIn_t {
    AXIS_REF_t *Master;
    AXIS_REF_t *Slave;
    BOOL Execute, ContinuousUpdate;
    LREAL MasterOffset;          /**< u of the master; added to the master positions of the cam */
    LREAL SlaveOffset;           /**< u; added to the slave positions of the cam */
    LREAL MasterScaling;         /**< factor of the master positions; 0 acts as 1 */
    LREAL SlaveScaling;          /**< factor of the slave positions; 0 acts as 1 */
    LREAL MasterStartDistance;   /**< u of the master; distance of the master in which the slave synchronises; 0:
                                      none */
    LREAL MasterSyncPosition;    /**< u of the master; position in the cam where that distance ends */
    MC_START_MODE StartMode;
    MC_SOURCE MasterValueSource; /**< mcSetValue or mcActualValue */
    MC_CAM_ID CamTableID;        /**< of MC_CamTableSelect, for this slave */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL InSync;                 /**< the set position is that of the cam */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    BOOL EndOfProfile;           /**< TRUE in the first call after the master passed an end of the cam */
    cm1e_coupling_private_t Private;
} MC_CamIn_t;
CM1E_API void MC_CamIn(MC_CamIn_t *fb);

/** 4.4. Ends the coupling by a cam; the slave continues at its present velocity. @rt cycle */
typedef struct MC_CamOut_t {
    AXIS_REF_t *Slave;
    BOOL Execute;
    /* outputs */
    BOOL Done; /**< the slave no longer follows */
    BOOL Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_CamOut_t;
CM1E_API void MC_CamOut(MC_CamOut_t *fb);

/** 4.5. Lets the slave follow its master by a ratio of their velocities; from InGear on also of their positions.
 *  @rt cycle */
typedef struct MC_GearIn_t {
    AXIS_REF_t *Master;
    AXIS_REF_t *Slave;
    BOOL Execute, ContinuousUpdate;
    DINT RatioNumerator;         /**< not 0; u of the slave that correspond to RatioDenominator */
    UDINT RatioDenominator;      /**< not 0; u of the master */
    MC_SOURCE MasterValueSource; /**< mcSetValue or mcActualValue */
    LREAL Acceleration;          /**< u/s2, 0 ... maximum; of the approach; 0 selects the axis maximum */
    LREAL Deceleration;          /**< u/s2, 0 ... maximum; as Acceleration */
    LREAL Jerk;                  /**< u/s3, 0 ... maximum; as Acceleration */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL InGear;                 /**< the set velocity follows the ratio */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_coupling_private_t Private;
} MC_GearIn_t;
/** Its initial values: `MC_GearIn_t fb = {.Master = &axis, MC_GEARIN_DEFAULTS};` */
#define MC_GEARIN_DEFAULTS .RatioNumerator = 1, .RatioDenominator = 1
CM1E_API void MC_GearIn(MC_GearIn_t *fb);

/** 4.6. Ends the coupling by a ratio; the slave continues at its present velocity. @rt cycle */
typedef struct MC_GearOut_t {
    AXIS_REF_t *Slave;
    BOOL Execute;
    /* outputs */
    BOOL Done; /**< the slave no longer follows */
    BOOL Busy, Error;
    WORD ErrorID;
    cm1e_fb_private_t Private;
} MC_GearOut_t;
CM1E_API void MC_GearOut(MC_GearOut_t *fb);

/** 4.7. Lets the slave follow its master by a ratio of their positions, from a point at which both have given
 *  positions. @rt cycle */
typedef struct MC_GearInPos_t {
    AXIS_REF_t *Master;
    AXIS_REF_t *Slave;
    BOOL Execute;
    DINT RatioNumerator;         /**< not 0; u of the slave that correspond to RatioDenominator */
    UDINT RatioDenominator;      /**< not 0; u of the master */
    MC_SOURCE MasterValueSource; /**< mcSetValue or mcActualValue */
    LREAL MasterSyncPosition;    /**< u of the master; position of the master from which on both are in synchronism */
    LREAL SlaveSyncPosition;     /**< u; position of the slave at MasterSyncPosition */
    MC_SYNC_MODE SyncMode;
    LREAL MasterStartDistance;   /**< u of the master; distance before MasterSyncPosition at which the approach
                                      begins; 0: at once */
    LREAL Velocity;              /**< u/s, > 0 ... maximum; maximum of the approach */
    LREAL Acceleration;          /**< u/s2, 0 ... maximum; of the approach; 0 selects the axis maximum */
    LREAL Deceleration;          /**< u/s2, 0 ... maximum; as Acceleration */
    LREAL Jerk;                  /**< u/s3, 0 ... maximum; as Acceleration */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL StartSync;              /**< the approach has begun, and InSync has not come yet */
    BOOL InSync;                 /**< the set position follows the ratio */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_coupling_private_t Private;
} MC_GearInPos_t;
/** Its initial values: `MC_GearInPos_t fb = {.Master = &axis, MC_GEARINPOS_DEFAULTS};` */
#define MC_GEARINPOS_DEFAULTS .RatioNumerator = 1, .RatioDenominator = 1
CM1E_API void MC_GearInPos(MC_GearInPos_t *fb);

/** 4.8. Shifts the position of the master, as this slave sees it, until the phase shift is PhaseShift. @rt cycle */
typedef struct MC_PhasingAbsolute_t {
    AXIS_REF_t *Master;
    AXIS_REF_t *Slave;
    BOOL Execute;
    LREAL PhaseShift;         /**< u of the master; added to the master's position for this slave */
    LREAL Velocity;           /**< u/s of the master, > 0; maximum of the shift */
    LREAL Acceleration;       /**< u/s2 of the master, 0 ... maximum; 0 selects half of what the slave can follow */
    LREAL Deceleration;       /**< u/s2 of the master, 0 ... maximum; as Acceleration */
    LREAL Jerk;               /**< u/s3 of the master, 0 ... maximum; as Acceleration */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL Done;                /**< the phase shift is reached; it is kept */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    LREAL AbsolutePhaseShift; /**< u of the master; the phase shift, while Busy */
    cm1e_coupling_private_t Private;
} MC_PhasingAbsolute_t;
CM1E_API void MC_PhasingAbsolute(MC_PhasingAbsolute_t *fb);

/** 4.9. Shifts the position of the master, as this slave sees it, further by PhaseShift. @rt cycle */
typedef struct MC_PhasingRelative_t {
    AXIS_REF_t *Master;
    AXIS_REF_t *Slave;
    BOOL Execute;
    LREAL PhaseShift;        /**< u of the master; added to the present phase shift */
    LREAL Velocity;          /**< u/s of the master, > 0; maximum of the shift */
    LREAL Acceleration;      /**< u/s2 of the master, 0 ... maximum; 0 selects half of what the slave can follow */
    LREAL Deceleration;      /**< u/s2 of the master, 0 ... maximum; as Acceleration */
    LREAL Jerk;              /**< u/s3 of the master, 0 ... maximum; as Acceleration */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL Done;               /**< the phase shift is added; it is kept */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    LREAL CoveredPhaseShift; /**< u of the master; added by this block since its start */
    cm1e_coupling_private_t Private;
} MC_PhasingRelative_t;
CM1E_API void MC_PhasingRelative(MC_PhasingRelative_t *fb);

/** 4.10. Lets the slave follow the sum, or the difference, of the motions of two masters. @rt cycle */
typedef struct MC_CombineAxes_t {
    AXIS_REF_t *Master1;
    AXIS_REF_t *Master2;
    AXIS_REF_t *Slave;
    BOOL Execute, ContinuousUpdate;
    MC_COMBINE_MODE CombineMode;
    DINT GearRatioNumeratorM1;     /**< not 0; u of the slave that correspond to the denominator */
    DINT GearRatioDenominatorM1;   /**< not 0; u of Master1 */
    DINT GearRatioNumeratorM2;     /**< not 0; u of the slave that correspond to the denominator */
    DINT GearRatioDenominatorM2;   /**< not 0; u of Master2 */
    MC_SOURCE MasterValueSourceM1; /**< mcSetValue or mcActualValue */
    MC_SOURCE MasterValueSourceM2; /**< mcSetValue or mcActualValue */
    MC_BUFFER_MODE BufferMode;
    /* outputs */
    BOOL InSync;                   /**< the set velocity follows both masters by their ratios */
    BOOL Busy, Active, CommandAborted, Error;
    WORD ErrorID;
    cm1e_coupling_private_t Private;
} MC_CombineAxes_t;
/** Its initial values: `MC_CombineAxes_t fb = {.Master1 = &axis, MC_COMBINEAXES_DEFAULTS};` */
#define MC_COMBINEAXES_DEFAULTS .GearRatioNumeratorM1 = 1, .GearRatioDenominatorM1 = 1, .GearRatioNumeratorM2 = 1, \
    .GearRatioDenominatorM2 = 1
CM1E_API void MC_CombineAxes(MC_CombineAxes_t *fb);

#ifdef __cplusplus
}
#endif
#endif
