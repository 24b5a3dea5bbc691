/**
 * @file tc2_axis.h
 * What programs for TwinCAT read of an axis without a block: members of AXIS_REF of the library Tc2_MC2, as far as
 * their meaning is one of our axes. The translator of Structured Text knows their names, the blocks their values; a
 * translated program has the numbers, so rows are added at the end only.
 */
#ifndef CM1E_CORE_TC2_AXIS_H
#define CM1E_CORE_TC2_AXIS_H

/** X(structure, member, type, how the value follows from the info `i` of the axis) */
#define CM1E_TC2_AXIS(X)                                                                                              \
    X(NcToPlc, ActPos, LREAL, i.actual_position)                                                                      \
    X(NcToPlc, ActVelo, LREAL, i.actual_velocity)                                                                     \
    X(NcToPlc, SetPos, LREAL, i.set_position)                                                                         \
    X(NcToPlc, SetVelo, LREAL, i.set_velocity)                                                                        \
    X(NcToPlc, SetAcc, LREAL, i.set_acceleration)                                                                     \
    X(NcToPlc, PosDiff, LREAL, i.position_lag)                                                                        \
    X(NcToPlc, ActTorque, LREAL, i.actual_torque)                                                                     \
    X(NcToPlc, ErrorCode, UDINT, cm1e_error_id(i.error))                                                              \
    X(Status, Error, BOOL, i.state == CM1E_AXIS_ERROR_STOP)                                                           \
    X(Status, ErrorID, UDINT, cm1e_error_id(i.error))                                                                 \
    X(Status, ErrorStop, BOOL, i.state == CM1E_AXIS_ERROR_STOP)                                                       \
    X(Status, Disabled, BOOL, i.state == CM1E_AXIS_DISABLED)                                                          \
    X(Status, Stopping, BOOL, i.state == CM1E_AXIS_STOPPING)                                                          \
    X(Status, Homing, BOOL, i.state == CM1E_AXIS_HOMING)                                                              \
    X(Status, StandStill, BOOL, i.state == CM1E_AXIS_STANDSTILL)                                                      \
    X(Status, DiscreteMotion, BOOL, i.state == CM1E_AXIS_DISCRETE_MOTION)                                             \
    X(Status, ContinuousMotion, BOOL, i.state == CM1E_AXIS_CONTINUOUS_MOTION)                                         \
    X(Status, SynchronizedMotion, BOOL, i.state == CM1E_AXIS_SYNCHRONIZED_MOTION)                                     \
    X(Status, Moving, BOOL, i.set_velocity != 0)                                                                      \
    X(Status, NotMoving, BOOL, i.set_velocity == 0)                                                                   \
    X(Status, PositiveDirection, BOOL, i.set_velocity > 0)                                                            \
    X(Status, NegativeDirection, BOOL, i.set_velocity < 0)                                                            \
    X(Status, Homed, BOOL, i.homed)                                                                                   \
    X(Status, Operational, BOOL, i.online)                                                                            \
    X(Status, InTargetPosition, BOOL, i.in_position)

#endif
