/* The kinds of commands, a row each. */
#include "axis/axis_kind.h"

#define ROW(kind, name, trigger, plan, target, ...) \
    [CM1E_COMMAND_##kind] = {name, ON_##trigger, PLAN_##plan, TARGET_##target, __VA_ARGS__}

const command_kind_t cm1e_axis_kinds[] = {
    /* kind, name, trigger, plan, target                                              has_buffer_mode
                                                                                      |  is_endless
                                                                                      |  |  has_velocity
                                                                                      |  |  |  is_stop
                                                                                      |  |  |  |  has_override
                                                                                      |  |  |  |  | carries_superimposed
                                                                                      |  |  |  |  |  |  drive_can */
    ROW(MOVE_ABSOLUTE, "MC_MoveAbsolute", DISCRETE, TO_TARGET, ABSOLUTE,              1, 0, 1, 0, 1, 1, 1),
    ROW(MOVE_RELATIVE, "MC_MoveRelative", DISCRETE, TO_TARGET, RELATIVE,              1, 0, 1, 0, 1, 1, 1),
    ROW(MOVE_ADDITIVE, "MC_MoveAdditive", DISCRETE, TO_TARGET, RELATIVE,              1, 0, 1, 0, 1, 1, 1),
    ROW(MOVE_VELOCITY, "MC_MoveVelocity", CONTINUOUS, VELOCITY, NONE,                 1, 1, 1, 0, 1, 1, 1),
    ROW(MOVE_CONTINUOUS_ABSOLUTE, "MC_MoveContinuousAbsolute", CONTINUOUS, THROUGH_TARGET, ABSOLUTE,
                                                                                      1, 1, 1, 0, 1, 1, 0),
    ROW(MOVE_CONTINUOUS_RELATIVE, "MC_MoveContinuousRelative", CONTINUOUS, THROUGH_TARGET, RELATIVE,
                                                                                      1, 1, 1, 0, 1, 1, 0),
    ROW(POSITION_PROFILE, "MC_PositionProfile", DISCRETE, TABLE, NONE,                1, 0, 0, 0, 0, 0, 0),
    ROW(VELOCITY_PROFILE, "MC_VelocityProfile", CONTINUOUS, TABLE, NONE,              1, 1, 0, 0, 0, 0, 0),
    ROW(ACCELERATION_PROFILE, "MC_AccelerationProfile", CONTINUOUS, TABLE, NONE,      1, 1, 0, 0, 0, 0, 0),
    ROW(HALT, "MC_Halt", DISCRETE, STOP, NONE,                                        1, 0, 0, 1, 1, 1, 1),
    ROW(STOP, "MC_Stop", STOP, STOP, NONE,                                            0, 0, 0, 1, 0, 1, 1),
    ROW(HOME, "MC_Home", HOME, HOMING, NONE,                                          1, 0, 0, 0, 0, 0, 1),
    ROW(HOMING_STEP, "a step of a homing", HOMING_STEP, HOMING_STEP, NONE,            1, 0, 1, 0, 0, 0, 1),
    ROW(MOVE_SUPERIMPOSED, "MC_MoveSuperimposed", SUPERIMPOSE, ON_TOP, NONE,          0, 0, 1, 0, 1, 0, 0),
    ROW(HALT_SUPERIMPOSED, "MC_HaltSuperimposed", HALT_SUPERIMPOSED, ON_TOP, NONE,    0, 0, 0, 1, 1, 0, 0),
    ROW(GEAR_IN, "MC_GearIn", COUPLE, COUPLING, NONE,                                 1, 0, 0, 0, 0, 1, 0),
    ROW(GEAR_IN_POS, "MC_GearInPos", COUPLE, COUPLING, NONE,                          1, 0, 1, 0, 0, 1, 0),
    ROW(CAM_IN, "MC_CamIn", COUPLE, COUPLING, NONE,                                   1, 0, 0, 0, 0, 1, 0),
    ROW(COMBINE_AXES, "MC_CombineAxes", COUPLE, COUPLING, NONE,                       1, 0, 0, 0, 0, 1, 0),
    ROW(GEAR_OUT, "MC_GearOut", DECOUPLE, KEEP_VELOCITY, NONE,                        0, 1, 0, 0, 0, 1, 0),
    ROW(CAM_OUT, "MC_CamOut", DECOUPLE, KEEP_VELOCITY, NONE,                          0, 1, 0, 0, 0, 1, 0),
    ROW(PHASING_ABSOLUTE, "MC_PhasingAbsolute", SHIFT_PHASE, PHASING, NONE,           1, 0, 1, 0, 0, 0, 0),
    ROW(PHASING_RELATIVE, "MC_PhasingRelative", SHIFT_PHASE, PHASING, NONE,           1, 0, 1, 0, 0, 0, 0),
    ROW(FOLLOW_POSITION, "CM_FollowPosition", FOLLOW, OUTSIDE, NONE,                  0, 0, 0, 0, 0, 0, 0),
};

_Static_assert(sizeof cm1e_axis_kinds / sizeof cm1e_axis_kinds[0] == CM1E_COMMAND_KIND_COUNT,
               "the last kinds of axis_api.h have no row");
