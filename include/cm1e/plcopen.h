/**
 * @file plcopen.h
 * The function blocks of PLCopen Motion Control: Part 1 v2.0, the core of Part 4 v2.0 (axes groups) and Part 5 v2.0,
 * and blocks for motors behind a bridge (CM_...). Each block is a plain struct, valid when zeroed (the comments of the
 * inputs give the defaults), and a function of the same name. A program calls the function once a scan, also while
 * nothing happens:
 *
 *     static MC_Power_t power = {.Axis = &axis, .EnablePositive = TRUE, .EnableNegative = TRUE};
 *     power.Enable = TRUE;
 *     MC_Power(&power);
 *
 * Inputs come first, then outputs, in the standard's order; the member `Private` belongs to the block. Call blocks only
 * in programs of the scheduler that owns the axis (@rt cycle). Units: u, u/s, u/s2, u/s3 (config.h). Acceleration,
 * Deceleration, Jerk 0 select the axis maximum. Text of an ErrorID: cm1e_strerror(cm1e_error_from_id(ErrorID)).
 *
 * Rules of all blocks: the axis (a slave and its masters too) is latched at the rising edge of Execute or Enable.
 * Another axis while the block is busy is CM1E_ERROR_FB_AXIS_CHANGED, and no axis is affected. A motion goes on if its
 * block is no longer called, or if a new edge is refused. The values of a reading block are 0 while Valid is FALSE.
 * docs/blocks/ has a page for each block, with its timing diagram. The standard blocks of IEC 61131-3 (TON, R_TRIG, CTU
 * ...) are in iec.h.
 */
#ifndef CM1E_PLCOPEN_H
#define CM1E_PLCOPEN_H

#include "cm1e/cm_bridge.h"
#include "cm1e/mc_administrative.h"
#include "cm1e/mc_group.h"
#include "cm1e/mc_homing.h"
#include "cm1e/mc_motion.h"
#include "cm1e/mc_multi_axis.h"
#include "cm1e/mc_types.h"

#endif
