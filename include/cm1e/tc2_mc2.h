/**
 * @file tc2_mc2.h
 * Names of TwinCAT's library Tc2_MC2 that differ from PLCopen's, for programs that are ported. A name is here only if
 * its meaning is the same; docs/TWINCAT.md describes the rest. Include this header instead of plcopen.h, after all
 * other headers, because the names are macros. All rules are those of plcopen.h (@rt cycle).
 */
#ifndef CM1E_TC2_MC2_H
#define CM1E_TC2_MC2_H

#include "cm1e/iec.h"
#include "cm1e/plcopen.h"

/** The axis, by TwinCAT's name. */
typedef AXIS_REF_t AXIS_REF;

/** MC_Power. TwinCAT's Override is MC_SetOverride.VelFactor here, 0 ... 1 instead of 0 ... 100 %. */
#define Enable_Positive EnablePositive
#define Enable_Negative EnableNegative

/** The buffer modes. */
typedef MC_BUFFER_MODE MC_BufferMode;
#define MC_Aborting mcAborting
#define MC_Buffered mcBuffered
#define MC_BlendingLow mcBlendingLow
#define MC_BlendingPrevious mcBlendingPrevious
#define MC_BlendingNext mcBlendingNext
#define MC_BlendingHigh mcBlendingHigh

/** Use the names, not the numbers. For TwinCAT's MC_Undefined_Direction leave Direction at 0. */
typedef MC_DIRECTION MC_Direction;
#define MC_Positive_Direction mcPositiveDirection
#define MC_Shortest_Way mcShortestWay
#define MC_Negative_Direction mcNegativeDirection
#define MC_Current_Direction mcCurrentDirection

/** C tells upper and lower case apart. */
typedef MC_MoveSuperimposed_t MC_MoveSuperImposed_t;
#define MC_MoveSuperImposed MC_MoveSuperimposed

/** Deceleration and Jerk are not inputs of TwinCAT's block; leave them at 0, which selects the axis maximum. */
typedef MC_HaltSuperimposed_t MC_AbortSuperposition_t;
#define MC_AbortSuperposition MC_HaltSuperimposed

/** TF5050 (cams). For its modes that are absolute for only one of the two axes use mcRampIn, with MasterAbsolute and
 * SlaveAbsolute of MC_CamTableSelect. */
typedef MC_START_MODE MC_StartMode;
#define MC_STARTMODE_ABSOLUTE mcAbsolute
#define MC_STARTMODE_RELATIVE mcRelative

/** Part 5 as in Tc3_MC2_AdvancedHoming; the enumerators are PLCopen's in both. */
typedef MC_HOME_DIRECTION MC_Home_Direction;
typedef MC_SWITCH_MODE MC_Switch_Mode;
typedef MC_REF_SIGNAL_REF MC_Ref_Signal_Ref;

#endif
