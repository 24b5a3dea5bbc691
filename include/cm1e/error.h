/**
 * @file error.h
 * The one list of errors. Every function that can fail returns a cm1e_error_t, and function blocks show the same error
 * as ErrorID. Foreign codes (SDO abort codes, AL status codes, error codes of the drive) are passed on unchanged beside
 * it. Any thread may call the functions of this header.
 */
#ifndef CM1E_ERROR_H
#define CM1E_ERROR_H

#include <stddef.h>
#include <stdint.h>

#include "cm1e/api.h"

#ifdef __cplusplus
extern "C" {
#endif

/** ErrorID of a function block = CM1E_ERROR_ID_BASE - error. The range 0x1E01 ... 0x1EFF is outside 0x4000-0x4FFF and
 *  0x8000-0x8FFF, which are NC and ADS errors in TwinCAT. */
#define CM1E_ERROR_ID_BASE 0x1E00

/** All errors: X(name, value, text). */
#define CM1E_ERRORS(X)                                                                                              \
    X(OK, 0, "no error")                                                                                            \
    X(ERROR_INVALID_ARGUMENT, -1, "an argument is out of its range")                                                \
    X(ERROR_NO_MEMORY, -2, "out of memory")                                                                         \
    X(ERROR_NOT_FOUND, -3, "not found")                                                                             \
    X(ERROR_TIMEOUT, -4, "no answer in time")                                                                       \
    X(ERROR_PERMISSION, -5, "a privilege is missing")                                                               \
    X(ERROR_IO, -6, "the operating system refused an input or output")                                              \
    X(ERROR_FULL, -7, "a queue is full; try again in a later cycle")                                                \
    X(ERROR_BUSY, -8, "an earlier request is still being worked on")                                                \
    X(ERROR_UNSUPPORTED, -9, "the device or this library cannot do that")                                           \
    X(ERROR_CONFIG, -10, "the configuration is wrong")                                                              \
    X(ERROR_STATE, -11, "not allowed in this state")                                                                \
    X(ERROR_CANCELLED, -12, "cancelled")                                                                            \
    X(ERROR_FILE, -13, "a file is damaged or not of this format")                                                   \
    X(ERROR_PROGRAM, -14, "the program did not return in time, or stood still")                                     \
    X(ERROR_BUS_NO_SLAVES, -20, "no EtherCAT slave answers")                                                        \
    X(ERROR_BUS_IDENTITY, -21, "a slave is missing, extra, doubled or of another kind than configured")             \
    X(ERROR_BUS_STATE, -22, "a slave refused or left an EtherCAT state")                                            \
    X(ERROR_BUS_LOST, -23, "the bus does not answer: frames are lost")                                              \
    X(ERROR_BUS_WORKING_COUNTER, -24, "the working counter is wrong: a slave did not take part in the cycle")       \
    X(ERROR_BUS_MAILBOX, -25, "mailbox error")                                                                      \
    X(ERROR_SDO_ABORT, -26, "the slave aborted an SDO transfer")                                                    \
    X(ERROR_PDO_MAPPING, -27, "the PDO mapping lacks an object that the operation needs")                           \
    X(ERROR_BUS_CYCLE_TIME, -28, "the device does not accept the cycle time")                                       \
    X(ERROR_INTERFACE_IN_USE, -29, "another program has the network interface: end it, or attach to it")            \
    X(ERROR_BUS_CLOCKS, -39, "the clocks of the slaves and of this machine do not synchronise")                     \
    X(ERROR_DRIVE_FAULT, -40, "the drive reports a fault")                                                          \
    X(ERROR_DRIVE_POWER, -41, "motor power is off")                                                                 \
    X(ERROR_DRIVE_ENABLE_LOST, -42, "the drive left Operation enabled by itself")                                   \
    X(ERROR_DRIVE_ENABLE_TIMEOUT, -43, "the drive did not reach Operation enabled in time")                         \
    X(ERROR_DRIVE_MODE_TIMEOUT, -44, "the drive did not confirm the mode of operation in time")                     \
    X(ERROR_DRIVE_MODE_LOST, -45, "the drive left the commanded mode of operation")                                 \
    X(ERROR_DRIVE_RESET_TIMEOUT, -46, "the fault did not clear")                                                    \
    X(ERROR_DRIVE_POSITION, -47, "the drive shows positions that its motor cannot have reached")                    \
    X(ERROR_DRIVE_KEEPS_TORQUE, -48, "the drive keeps its torque although it was told to have none")                \
    X(ERROR_CML_STRING, -50, "the string cannot be sent to this motor: empty, too long, cut off, or for another one") \
    X(ERROR_CML_MOTION, -51, "the CML string may move the motor or change its power, and that is not allowed")      \
    X(ERROR_CML_TIMEOUT, -52, "no answer to the CML string came in time")                                           \
    X(ERROR_CML_ANSWER, -53, "an answer of the motor to a CML string is damaged")                                   \
    X(ERROR_CM_SEARCH, -54, "the motor ended its origin search without an origin")                                  \
    X(ERROR_CM_SEARCH_TIMEOUT, -55, "the origin search took too long and was aborted")                              \
    X(ERROR_CM_COMMAND, -56, "the motor did not answer a command of CMD mode")                                      \
    X(ERROR_CM_MODE, -57, "the present mode of operation does not allow a switch to this one")                      \
    X(ERROR_CM_NOT_DISABLED, -58, "allowed only while the axis is Disabled and the motor has no torque")            \
    X(ERROR_CM_NO_BRIDGE, -59, "the motor is not behind an EtherCAT Cool MUSCLE Bridge")                            \
    X(ERROR_AXIS_STATE, -60, "not allowed in the present state of the axis")                                        \
    X(ERROR_AXIS_NOT_POWERED, -61, "the axis is Disabled: enable it with MC_Power")                                 \
    X(ERROR_AXIS_ERROR_STOP, -62, "the axis is in ErrorStop: remove the cause, then MC_Reset")                      \
    X(ERROR_AXIS_STOPPING, -63, "the axis is Stopping: MC_Stop.Execute is still TRUE or the axis still moves")      \
    X(ERROR_AXIS_HOMING, -64, "the axis is Homing")                                                                 \
    X(ERROR_AXIS_POSITION_RANGE, -65, "a position is not a finite number or outside the range or software limits")  \
    X(ERROR_AXIS_VELOCITY_RANGE, -66, "the velocity is zero, not finite or above the axis's maximum")               \
    X(ERROR_AXIS_DYNAMICS_RANGE, -67, "an acceleration, deceleration or jerk is negative, not finite or too large") \
    X(ERROR_AXIS_DIRECTION, -68, "the direction is not allowed here")                                               \
    X(ERROR_AXIS_DIRECTION_DISABLED, -69, "motion in this direction is disabled by MC_Power")                       \
    X(ERROR_AXIS_BUFFER_MODE, -70, "this buffer mode is not supported here")                                        \
    X(ERROR_AXIS_LAG, -71, "the position lag is above its limit")                                                   \
    X(ERROR_AXIS_HOMING_FAILED, -72, "the drive reports a homing error")                                            \
    X(ERROR_AXIS_HOMING_TIMEOUT, -73, "homing did not end in time")                                                 \
    X(ERROR_AXIS_HOMING_METHOD, -74, "the device does not have this homing method")                                 \
    X(ERROR_AXIS_HOMING_PARAMETER, -75, "a homing parameter is out of the device's range")                          \
    X(ERROR_AXIS_OFFLINE, -76, "the axis does not take part in the bus cycle")                                      \
    X(ERROR_AXIS_NOT_AT_REST, -77, "the motor does not come to rest")                                               \
    X(ERROR_AXIS_NOT_IN_POSITION, -78, "the motor did not reach its set-point in time")                             \
    X(ERROR_AXIS_PARAMETER, -80, "the axis has no such parameter, or it is not of type BOOL")                       \
    X(ERROR_AXIS_PARAMETER_READ_ONLY, -81, "the parameter cannot be written")                                       \
    X(ERROR_AXIS_PARAMETER_RANGE, -82, "the value is out of the parameter's range")                                 \
    X(ERROR_AXIS_OVERRIDE, -83, "an override factor is out of its range")                                           \
    X(ERROR_AXIS_SIGNAL, -85, "there is no digital input or output with this number")                               \
    X(ERROR_AXIS_PROBE, -86, "a trigger came while the position was not known")                                     \
    X(ERROR_AXIS_NO_TORQUE_MODE, -87, "the drive has no torque mode, only positions and velocities")                \
    X(ERROR_AXIS_SIGNAL_AWAY, -88, "the slave with this digital signal does not take part in the bus cycle")        \
    X(ERROR_AXIS_TABLE, -100, "the table of a profile is empty, too long or not finite, or its times do not rise")  \
    X(ERROR_AXIS_TABLE_LATE, -101, "a table over time was broken off: frames were lost or not sent for too long")   \
    X(ERROR_AXIS_NO_TABLES, -117, "the axis has no memory for tables: set table_profiles in its configuration")     \
    X(ERROR_AXIS_NO_COUPLINGS, -118, "the axis has no memory to follow others: set follows in its configuration")   \
    X(ERROR_AXIS_STEP_INPUT, -110, "an input of the homing step is not valid")                                      \
    X(ERROR_AXIS_STEP_SWITCH, -111, "the switch of the homing step is not configured")                              \
    X(ERROR_AXIS_STEP_TIME, -112, "homing step: TimeLimit passed before the reference was found")                   \
    X(ERROR_AXIS_STEP_DISTANCE, -113, "homing step: DistanceLimit reached before the reference was found")          \
    X(ERROR_AXIS_STEP_TORQUE, -114, "homing step: TorqueLimit reached before the reference was found")              \
    X(ERROR_AXIS_STEP_LIMIT_SWITCH, -115, "homing step: a limit switch came before the reference")                  \
    X(ERROR_AXIS_NO_SUCH_SIGNAL, -116, "the drive has no such signal: reference pulse, coded marks, absolute encoder") \
    X(ERROR_AXIS_MASTER, -120, "the master is not an axis of this scheduler")                                       \
    X(ERROR_AXIS_COUPLING_CYCLE, -121, "an axis cannot follow itself, directly or through other axes")              \
    X(ERROR_AXIS_MASTER_LOST, -122, "the master failed, lost its position or does not answer")                      \
    X(ERROR_AXIS_COUPLING_LIMIT, -123, "the coupling commands more than the axis limits allow")                     \
    X(ERROR_AXIS_COUPLED, -124, "an axis that this one is coupled with has stopped with an error")                  \
    X(ERROR_AXIS_NOT_COUPLED, -125, "the axis is not coupled by this kind of block")                                \
    X(ERROR_AXIS_RATIO, -126, "a ratio or a scaling is zero, not finite or too large")                              \
    X(ERROR_AXIS_SYNC_WAY, -127, "the axis cannot reach the synchronisation point within its limits")               \
    X(ERROR_AXIS_CAM_TABLE, -128, "a cam table has too few or too many points, or they do not rise or are not finite") \
    X(ERROR_AXIS_CAM_ID, -129, "CamTableID names no cam table of this slave: MC_CamTableSelect first")              \
    X(ERROR_AXIS_CAM_START, -130, "the slave is not on the cam: use mcRampIn or a MasterStartDistance")             \
    X(ERROR_AXIS_IN_GROUP, -131, "the axis is moved by its axes group")                                             \
    X(ERROR_AXIS_VIRTUAL, -132, "the axis has no motor: it is virtual, or an encoder")                              \
    X(ERROR_AXIS_SET_POINT_JUMP, -133, "the first position from outside is not where the axis stands")              \
    X(ERROR_AXIS_SET_POINT_LIMIT, -134, "a position from outside asks for more than the axis limits allow")         \
    X(ERROR_AXIS_SET_POINT_MISSING, -135, "positions from outside stopped while the axis followed them")            \
    X(ERROR_GROUP_REF, -140, "AXES_GROUP_REF names no axes group")                                                  \
    X(ERROR_GROUP_STATE, -141, "not allowed in the present state of the axes group")                                \
    X(ERROR_GROUP_DISABLED, -142, "the axes group is disabled: MC_GroupEnable first")                               \
    X(ERROR_GROUP_ERROR_STOP, -143, "the axes group is in GroupErrorStop: remove the cause, then MC_GroupReset")    \
    X(ERROR_GROUP_STOPPING, -144, "the axes group is stopping: MC_GroupStop.Execute is still TRUE or it still moves") \
    X(ERROR_GROUP_MEMBER, -145, "no such member, its place is taken, or the axis is in a group already")            \
    X(ERROR_GROUP_AXIS, -146, "an axis of the group is not powered, moves by itself or has failed")                 \
    X(ERROR_GROUP_PATH, -147, "the path is not finite, no arc goes through these points, or it leaves the limits")  \
    X(ERROR_GROUP_TRANSITION, -148, "the transition mode or its parameter is not supported here")                   \
    X(ERROR_GROUP_COORD_SYSTEM, -149, "the axes group has axis coordinates (ACS) only")                             \
    X(ERROR_FB_AXIS_REF, -90, "AXIS_REF names no axis")                                                             \
    X(ERROR_FB_AXIS_CHANGED, -91, "the axis of a busy function block was changed")                                  \
    X(ERROR_FB_SECOND_POWER, -92, "another MC_Power controls this axis")                                            \
    X(ERROR_FB_CAM_SWITCH, -96, "a switch or a track of MC_DigitalCamSwitch is out of its range")

/** What a function returns: success is 0, errors are negative. */
typedef enum cm1e_error {
#define CM1E_ERROR_ENUM(name, value, text) CM1E_##name = (value),
    CM1E_ERRORS(CM1E_ERROR_ENUM)
#undef CM1E_ERROR_ENUM
} cm1e_error_t;

/** Text of an error in one line. Never NULL, also for a number that is not an error. Static storage. @rt any */
CM1E_API const char *cm1e_strerror(cm1e_error_t error);

/** ErrorID (WORD) of an error; 0 for CM1E_OK. @rt cycle */
CM1E_API uint16_t cm1e_error_id(cm1e_error_t error);

/** The error of an ErrorID; CM1E_ERROR_NOT_FOUND for a number that is not an ErrorID of this library. @rt any */
CM1E_API cm1e_error_t cm1e_error_from_id(uint16_t error_id);

/** A diagnosis: the error, its foreign code, and sentences that name cause, place and cure. The caller owns it.
 *  Functions that run before or beside the cycle fill it. */
typedef struct cm1e_diag {
    cm1e_error_t error;
    /** 0: none. CM1E_ERROR_SDO_ABORT: the SDO abort code; BUS_STATE: the AL status code; BUS_MAILBOX: the error code of
     *  FoE or of the mailbox; PDO_MAPPING, CONFIG: the index of an object; INTERFACE_IN_USE: the process; IO: errno */
    uint32_t foreign_code;
    char text[512];        /**< one or more sentences, no trailing newline */
} cm1e_diag_t;

/** Fills a diagnosis (printf style) and returns `error`. `diag` may be NULL. Control characters and bytes that are not
 *  UTF-8, for example in a name out of a file, become "?". @rt block */
CM1E_API cm1e_error_t cm1e_diag_set(cm1e_diag_t *diag, cm1e_error_t error, uint32_t foreign_code, const char *format,
                                    ...) CM1E_PRINTF(4, 5);

#ifdef __cplusplus
}
#endif
#endif
