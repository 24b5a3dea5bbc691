/* Generated from fb/interface/ by fb/interface/generate.py; change it there. */
#include "block_table.h"

#include <stddef.h>
#include <stdint.h>

/* The layout that an ST compiler gives the declarations: order of declaration, natural alignment. */
#define AT(TYPE, NAME, OFFSET) _Static_assert(offsetof(TYPE##_t, NAME) == OFFSET, #TYPE "." #NAME)
#if UINTPTR_MAX == UINT64_MAX
_Static_assert(sizeof(AXIS_REF_t) == 2, "AXIS_REF_t");
_Static_assert(sizeof(cm1e_homing_config_t) == 48, "cm1e_homing_config_t");
_Static_assert(sizeof(MC_CAM_POINT) == 32, "MC_CAM_POINT");
_Static_assert(sizeof(MC_CAM_REF) == 16, "MC_CAM_REF");
_Static_assert(sizeof(MC_INPUT_REF) == 4, "MC_INPUT_REF");
_Static_assert(sizeof(MC_OUTPUT_REF) == 8, "MC_OUTPUT_REF");
_Static_assert(sizeof(MC_TRIGGER_REF) == 6, "MC_TRIGGER_REF");
_Static_assert(sizeof(MC_REF_SIGNAL_REF) == 4, "MC_REF_SIGNAL_REF");
_Static_assert(sizeof(MC_TP) == 16, "MC_TP");
_Static_assert(sizeof(MC_TP_REF) == 1032, "MC_TP_REF");
_Static_assert(sizeof(MC_TV) == 16, "MC_TV");
_Static_assert(sizeof(MC_TV_REF) == 1032, "MC_TV_REF");
_Static_assert(sizeof(MC_TA) == 16, "MC_TA");
_Static_assert(sizeof(MC_TA_REF) == 1032, "MC_TA_REF");
_Static_assert(sizeof(MC_CAMSWITCH) == 40, "MC_CAMSWITCH");
_Static_assert(sizeof(MC_CAMSWITCH_REF) == 1288, "MC_CAMSWITCH_REF");
_Static_assert(sizeof(MC_TRACK) == 24, "MC_TRACK");
_Static_assert(sizeof(MC_TRACK_REF) == 768, "MC_TRACK_REF");
_Static_assert(sizeof(cm1e_fb_private_t) == 12, "cm1e_fb_private_t");
_Static_assert(sizeof(cm1e_coupling_private_t) == 20, "cm1e_coupling_private_t");
_Static_assert(sizeof(cm1e_motion_private_t) == 40, "cm1e_motion_private_t");
_Static_assert(sizeof(cm1e_jog_private_t) == 48, "cm1e_jog_private_t");
_Static_assert(sizeof(cm1e_cam_point_t) == 16, "cm1e_cam_point_t");
_Static_assert(sizeof(cm1e_cam_switch_t) == 72, "cm1e_cam_switch_t");
_Static_assert(sizeof(cm1e_cam_private_t) == 2360, "cm1e_cam_private_t");
_Static_assert(sizeof(AXES_GROUP_REF_t) == 2, "AXES_GROUP_REF_t");
_Static_assert(sizeof(cm1e_iec_timer_t) == 16, "cm1e_iec_timer_t");
_Static_assert(sizeof(cm1e_iec_edges_t) == 2, "cm1e_iec_edges_t");
_Static_assert(sizeof(MC_Power_t) == 32, "MC_Power");
AT(MC_Power, Axis, 0);
AT(MC_Power, Enable, 8);
AT(MC_Power, EnablePositive, 9);
AT(MC_Power, EnableNegative, 10);
AT(MC_Power, Status, 11);
AT(MC_Power, Valid, 12);
AT(MC_Power, Error, 13);
AT(MC_Power, ErrorID, 14);
AT(MC_Power, Private, 16);
_Static_assert(sizeof(MC_Home_t) == 64, "MC_Home");
AT(MC_Home, Axis, 0);
AT(MC_Home, Execute, 8);
AT(MC_Home, Position, 16);
AT(MC_Home, BufferMode, 24);
AT(MC_Home, Done, 28);
AT(MC_Home, Busy, 29);
AT(MC_Home, Active, 30);
AT(MC_Home, CommandAborted, 31);
AT(MC_Home, Error, 32);
AT(MC_Home, ErrorID, 34);
AT(MC_Home, Parameters, 40);
AT(MC_Home, Private, 48);
_Static_assert(sizeof(MC_Stop_t) == 56, "MC_Stop");
AT(MC_Stop, Axis, 0);
AT(MC_Stop, Execute, 8);
AT(MC_Stop, Deceleration, 16);
AT(MC_Stop, Jerk, 24);
AT(MC_Stop, Done, 32);
AT(MC_Stop, Busy, 33);
AT(MC_Stop, Active, 34);
AT(MC_Stop, CommandAborted, 35);
AT(MC_Stop, Error, 36);
AT(MC_Stop, ErrorID, 38);
AT(MC_Stop, Private, 40);
_Static_assert(sizeof(MC_Halt_t) == 56, "MC_Halt");
AT(MC_Halt, Axis, 0);
AT(MC_Halt, Execute, 8);
AT(MC_Halt, Deceleration, 16);
AT(MC_Halt, Jerk, 24);
AT(MC_Halt, BufferMode, 32);
AT(MC_Halt, Done, 36);
AT(MC_Halt, Busy, 37);
AT(MC_Halt, Active, 38);
AT(MC_Halt, CommandAborted, 39);
AT(MC_Halt, Error, 40);
AT(MC_Halt, ErrorID, 42);
AT(MC_Halt, Private, 44);
_Static_assert(sizeof(MC_MoveAbsolute_t) == 88, "MC_MoveAbsolute");
AT(MC_MoveAbsolute, Axis, 0);
AT(MC_MoveAbsolute, Execute, 8);
AT(MC_MoveAbsolute, ContinuousUpdate, 9);
AT(MC_MoveAbsolute, Position, 16);
AT(MC_MoveAbsolute, Velocity, 24);
AT(MC_MoveAbsolute, Acceleration, 32);
AT(MC_MoveAbsolute, Deceleration, 40);
AT(MC_MoveAbsolute, Jerk, 48);
AT(MC_MoveAbsolute, Direction, 56);
AT(MC_MoveAbsolute, BufferMode, 60);
AT(MC_MoveAbsolute, Done, 64);
AT(MC_MoveAbsolute, Busy, 65);
AT(MC_MoveAbsolute, Active, 66);
AT(MC_MoveAbsolute, CommandAborted, 67);
AT(MC_MoveAbsolute, Error, 68);
AT(MC_MoveAbsolute, ErrorID, 70);
AT(MC_MoveAbsolute, Private, 72);
_Static_assert(sizeof(MC_MoveRelative_t) == 80, "MC_MoveRelative");
AT(MC_MoveRelative, Axis, 0);
AT(MC_MoveRelative, Execute, 8);
AT(MC_MoveRelative, ContinuousUpdate, 9);
AT(MC_MoveRelative, Distance, 16);
AT(MC_MoveRelative, Velocity, 24);
AT(MC_MoveRelative, Acceleration, 32);
AT(MC_MoveRelative, Deceleration, 40);
AT(MC_MoveRelative, Jerk, 48);
AT(MC_MoveRelative, BufferMode, 56);
AT(MC_MoveRelative, Done, 60);
AT(MC_MoveRelative, Busy, 61);
AT(MC_MoveRelative, Active, 62);
AT(MC_MoveRelative, CommandAborted, 63);
AT(MC_MoveRelative, Error, 64);
AT(MC_MoveRelative, ErrorID, 66);
AT(MC_MoveRelative, Private, 68);
_Static_assert(sizeof(MC_MoveAdditive_t) == 80, "MC_MoveAdditive");
AT(MC_MoveAdditive, Axis, 0);
AT(MC_MoveAdditive, Execute, 8);
AT(MC_MoveAdditive, ContinuousUpdate, 9);
AT(MC_MoveAdditive, Distance, 16);
AT(MC_MoveAdditive, Velocity, 24);
AT(MC_MoveAdditive, Acceleration, 32);
AT(MC_MoveAdditive, Deceleration, 40);
AT(MC_MoveAdditive, Jerk, 48);
AT(MC_MoveAdditive, BufferMode, 56);
AT(MC_MoveAdditive, Done, 60);
AT(MC_MoveAdditive, Busy, 61);
AT(MC_MoveAdditive, Active, 62);
AT(MC_MoveAdditive, CommandAborted, 63);
AT(MC_MoveAdditive, Error, 64);
AT(MC_MoveAdditive, ErrorID, 66);
AT(MC_MoveAdditive, Private, 68);
_Static_assert(sizeof(MC_MoveSuperimposed_t) == 88, "MC_MoveSuperimposed");
AT(MC_MoveSuperimposed, Axis, 0);
AT(MC_MoveSuperimposed, Execute, 8);
AT(MC_MoveSuperimposed, ContinuousUpdate, 9);
AT(MC_MoveSuperimposed, Distance, 16);
AT(MC_MoveSuperimposed, VelocityDiff, 24);
AT(MC_MoveSuperimposed, Acceleration, 32);
AT(MC_MoveSuperimposed, Deceleration, 40);
AT(MC_MoveSuperimposed, Jerk, 48);
AT(MC_MoveSuperimposed, Done, 56);
AT(MC_MoveSuperimposed, Busy, 57);
AT(MC_MoveSuperimposed, CommandAborted, 58);
AT(MC_MoveSuperimposed, Error, 59);
AT(MC_MoveSuperimposed, ErrorID, 60);
AT(MC_MoveSuperimposed, CoveredDistance, 64);
AT(MC_MoveSuperimposed, Private, 72);
_Static_assert(sizeof(MC_HaltSuperimposed_t) == 56, "MC_HaltSuperimposed");
AT(MC_HaltSuperimposed, Axis, 0);
AT(MC_HaltSuperimposed, Execute, 8);
AT(MC_HaltSuperimposed, Deceleration, 16);
AT(MC_HaltSuperimposed, Jerk, 24);
AT(MC_HaltSuperimposed, Done, 32);
AT(MC_HaltSuperimposed, Busy, 33);
AT(MC_HaltSuperimposed, Active, 34);
AT(MC_HaltSuperimposed, CommandAborted, 35);
AT(MC_HaltSuperimposed, Error, 36);
AT(MC_HaltSuperimposed, ErrorID, 38);
AT(MC_HaltSuperimposed, Private, 40);
_Static_assert(sizeof(MC_MoveVelocity_t) == 80, "MC_MoveVelocity");
AT(MC_MoveVelocity, Axis, 0);
AT(MC_MoveVelocity, Execute, 8);
AT(MC_MoveVelocity, ContinuousUpdate, 9);
AT(MC_MoveVelocity, Velocity, 16);
AT(MC_MoveVelocity, Acceleration, 24);
AT(MC_MoveVelocity, Deceleration, 32);
AT(MC_MoveVelocity, Jerk, 40);
AT(MC_MoveVelocity, Direction, 48);
AT(MC_MoveVelocity, BufferMode, 52);
AT(MC_MoveVelocity, InVelocity, 56);
AT(MC_MoveVelocity, Busy, 57);
AT(MC_MoveVelocity, Active, 58);
AT(MC_MoveVelocity, CommandAborted, 59);
AT(MC_MoveVelocity, Error, 60);
AT(MC_MoveVelocity, ErrorID, 62);
AT(MC_MoveVelocity, Private, 64);
_Static_assert(sizeof(MC_MoveContinuousAbsolute_t) == 96, "MC_MoveContinuousAbsolute");
AT(MC_MoveContinuousAbsolute, Axis, 0);
AT(MC_MoveContinuousAbsolute, Execute, 8);
AT(MC_MoveContinuousAbsolute, ContinuousUpdate, 9);
AT(MC_MoveContinuousAbsolute, Position, 16);
AT(MC_MoveContinuousAbsolute, EndVelocity, 24);
AT(MC_MoveContinuousAbsolute, Velocity, 32);
AT(MC_MoveContinuousAbsolute, Acceleration, 40);
AT(MC_MoveContinuousAbsolute, Deceleration, 48);
AT(MC_MoveContinuousAbsolute, Jerk, 56);
AT(MC_MoveContinuousAbsolute, Direction, 64);
AT(MC_MoveContinuousAbsolute, BufferMode, 68);
AT(MC_MoveContinuousAbsolute, InEndVelocity, 72);
AT(MC_MoveContinuousAbsolute, Busy, 73);
AT(MC_MoveContinuousAbsolute, Active, 74);
AT(MC_MoveContinuousAbsolute, CommandAborted, 75);
AT(MC_MoveContinuousAbsolute, Error, 76);
AT(MC_MoveContinuousAbsolute, ErrorID, 78);
AT(MC_MoveContinuousAbsolute, Private, 80);
_Static_assert(sizeof(MC_MoveContinuousRelative_t) == 88, "MC_MoveContinuousRelative");
AT(MC_MoveContinuousRelative, Axis, 0);
AT(MC_MoveContinuousRelative, Execute, 8);
AT(MC_MoveContinuousRelative, ContinuousUpdate, 9);
AT(MC_MoveContinuousRelative, Distance, 16);
AT(MC_MoveContinuousRelative, EndVelocity, 24);
AT(MC_MoveContinuousRelative, Velocity, 32);
AT(MC_MoveContinuousRelative, Acceleration, 40);
AT(MC_MoveContinuousRelative, Deceleration, 48);
AT(MC_MoveContinuousRelative, Jerk, 56);
AT(MC_MoveContinuousRelative, BufferMode, 64);
AT(MC_MoveContinuousRelative, InEndVelocity, 68);
AT(MC_MoveContinuousRelative, Busy, 69);
AT(MC_MoveContinuousRelative, Active, 70);
AT(MC_MoveContinuousRelative, CommandAborted, 71);
AT(MC_MoveContinuousRelative, Error, 72);
AT(MC_MoveContinuousRelative, ErrorID, 74);
AT(MC_MoveContinuousRelative, Private, 76);
_Static_assert(sizeof(MC_TorqueControl_t) == 96, "MC_TorqueControl");
AT(MC_TorqueControl, Axis, 0);
AT(MC_TorqueControl, Execute, 8);
AT(MC_TorqueControl, ContinuousUpdate, 9);
AT(MC_TorqueControl, Torque, 16);
AT(MC_TorqueControl, TorqueRamp, 24);
AT(MC_TorqueControl, Velocity, 32);
AT(MC_TorqueControl, Acceleration, 40);
AT(MC_TorqueControl, Deceleration, 48);
AT(MC_TorqueControl, Jerk, 56);
AT(MC_TorqueControl, Direction, 64);
AT(MC_TorqueControl, BufferMode, 68);
AT(MC_TorqueControl, InTorque, 72);
AT(MC_TorqueControl, Busy, 73);
AT(MC_TorqueControl, Active, 74);
AT(MC_TorqueControl, CommandAborted, 75);
AT(MC_TorqueControl, Error, 76);
AT(MC_TorqueControl, ErrorID, 78);
AT(MC_TorqueControl, Private, 80);
_Static_assert(sizeof(MC_PositionProfile_t) == 72, "MC_PositionProfile");
AT(MC_PositionProfile, Axis, 0);
AT(MC_PositionProfile, TimePosition, 8);
AT(MC_PositionProfile, Execute, 16);
AT(MC_PositionProfile, ContinuousUpdate, 17);
AT(MC_PositionProfile, TimeScale, 24);
AT(MC_PositionProfile, PositionScale, 32);
AT(MC_PositionProfile, Offset, 40);
AT(MC_PositionProfile, BufferMode, 48);
AT(MC_PositionProfile, Done, 52);
AT(MC_PositionProfile, Busy, 53);
AT(MC_PositionProfile, Active, 54);
AT(MC_PositionProfile, CommandAborted, 55);
AT(MC_PositionProfile, Error, 56);
AT(MC_PositionProfile, ErrorID, 58);
AT(MC_PositionProfile, Private, 60);
_Static_assert(sizeof(MC_VelocityProfile_t) == 72, "MC_VelocityProfile");
AT(MC_VelocityProfile, Axis, 0);
AT(MC_VelocityProfile, TimeVelocity, 8);
AT(MC_VelocityProfile, Execute, 16);
AT(MC_VelocityProfile, ContinuousUpdate, 17);
AT(MC_VelocityProfile, TimeScale, 24);
AT(MC_VelocityProfile, VelocityScale, 32);
AT(MC_VelocityProfile, Offset, 40);
AT(MC_VelocityProfile, BufferMode, 48);
AT(MC_VelocityProfile, ProfileCompleted, 52);
AT(MC_VelocityProfile, Busy, 53);
AT(MC_VelocityProfile, Active, 54);
AT(MC_VelocityProfile, CommandAborted, 55);
AT(MC_VelocityProfile, Error, 56);
AT(MC_VelocityProfile, ErrorID, 58);
AT(MC_VelocityProfile, Private, 60);
_Static_assert(sizeof(MC_AccelerationProfile_t) == 72, "MC_AccelerationProfile");
AT(MC_AccelerationProfile, Axis, 0);
AT(MC_AccelerationProfile, TimeAcceleration, 8);
AT(MC_AccelerationProfile, Execute, 16);
AT(MC_AccelerationProfile, ContinuousUpdate, 17);
AT(MC_AccelerationProfile, TimeScale, 24);
AT(MC_AccelerationProfile, AccelerationScale, 32);
AT(MC_AccelerationProfile, Offset, 40);
AT(MC_AccelerationProfile, BufferMode, 48);
AT(MC_AccelerationProfile, ProfileCompleted, 52);
AT(MC_AccelerationProfile, Busy, 53);
AT(MC_AccelerationProfile, Active, 54);
AT(MC_AccelerationProfile, CommandAborted, 55);
AT(MC_AccelerationProfile, Error, 56);
AT(MC_AccelerationProfile, ErrorID, 58);
AT(MC_AccelerationProfile, Private, 60);
_Static_assert(sizeof(MC_Jog_t) == 112, "MC_Jog");
AT(MC_Jog, Axis, 0);
AT(MC_Jog, JogForward, 8);
AT(MC_Jog, JogBackwards, 9);
AT(MC_Jog, Mode, 12);
AT(MC_Jog, Position, 16);
AT(MC_Jog, Velocity, 24);
AT(MC_Jog, Acceleration, 32);
AT(MC_Jog, Deceleration, 40);
AT(MC_Jog, Jerk, 48);
AT(MC_Jog, Done, 56);
AT(MC_Jog, Busy, 57);
AT(MC_Jog, Active, 58);
AT(MC_Jog, CommandAborted, 59);
AT(MC_Jog, Error, 60);
AT(MC_Jog, ErrorID, 62);
AT(MC_Jog, Private, 64);
_Static_assert(sizeof(CM_FollowPosition_t) == 48, "CM_FollowPosition");
AT(CM_FollowPosition, Axis, 0);
AT(CM_FollowPosition, Execute, 8);
AT(CM_FollowPosition, Position, 16);
AT(CM_FollowPosition, Busy, 24);
AT(CM_FollowPosition, Active, 25);
AT(CM_FollowPosition, CommandAborted, 26);
AT(CM_FollowPosition, Error, 27);
AT(CM_FollowPosition, ErrorID, 28);
AT(CM_FollowPosition, Private, 32);
_Static_assert(sizeof(MC_CamTableSelect_t) == 56, "MC_CamTableSelect");
AT(MC_CamTableSelect, Master, 0);
AT(MC_CamTableSelect, Slave, 8);
AT(MC_CamTableSelect, CamTable, 16);
AT(MC_CamTableSelect, Execute, 24);
AT(MC_CamTableSelect, Periodic, 25);
AT(MC_CamTableSelect, MasterAbsolute, 26);
AT(MC_CamTableSelect, SlaveAbsolute, 27);
AT(MC_CamTableSelect, ExecutionMode, 28);
AT(MC_CamTableSelect, Done, 32);
AT(MC_CamTableSelect, Busy, 33);
AT(MC_CamTableSelect, Error, 34);
AT(MC_CamTableSelect, ErrorID, 36);
AT(MC_CamTableSelect, CamTableID, 40);
AT(MC_CamTableSelect, Private, 44);
_Static_assert(sizeof(MC_CamIn_t) == 120, "MC_CamIn");
AT(MC_CamIn, Master, 0);
AT(MC_CamIn, Slave, 8);
AT(MC_CamIn, Execute, 16);
AT(MC_CamIn, ContinuousUpdate, 17);
AT(MC_CamIn, MasterOffset, 24);
AT(MC_CamIn, SlaveOffset, 32);
AT(MC_CamIn, MasterScaling, 40);
AT(MC_CamIn, SlaveScaling, 48);
AT(MC_CamIn, MasterStartDistance, 56);
AT(MC_CamIn, MasterSyncPosition, 64);
AT(MC_CamIn, StartMode, 72);
AT(MC_CamIn, MasterValueSource, 76);
AT(MC_CamIn, CamTableID, 80);
AT(MC_CamIn, BufferMode, 84);
AT(MC_CamIn, InSync, 88);
AT(MC_CamIn, Busy, 89);
AT(MC_CamIn, Active, 90);
AT(MC_CamIn, CommandAborted, 91);
AT(MC_CamIn, Error, 92);
AT(MC_CamIn, ErrorID, 94);
AT(MC_CamIn, EndOfProfile, 96);
AT(MC_CamIn, Private, 100);
_Static_assert(sizeof(MC_CamOut_t) == 32, "MC_CamOut");
AT(MC_CamOut, Slave, 0);
AT(MC_CamOut, Execute, 8);
AT(MC_CamOut, Done, 9);
AT(MC_CamOut, Busy, 10);
AT(MC_CamOut, Error, 11);
AT(MC_CamOut, ErrorID, 12);
AT(MC_CamOut, Private, 16);
_Static_assert(sizeof(MC_GearIn_t) == 88, "MC_GearIn");
AT(MC_GearIn, Master, 0);
AT(MC_GearIn, Slave, 8);
AT(MC_GearIn, Execute, 16);
AT(MC_GearIn, ContinuousUpdate, 17);
AT(MC_GearIn, RatioNumerator, 20);
AT(MC_GearIn, RatioDenominator, 24);
AT(MC_GearIn, MasterValueSource, 28);
AT(MC_GearIn, Acceleration, 32);
AT(MC_GearIn, Deceleration, 40);
AT(MC_GearIn, Jerk, 48);
AT(MC_GearIn, BufferMode, 56);
AT(MC_GearIn, InGear, 60);
AT(MC_GearIn, Busy, 61);
AT(MC_GearIn, Active, 62);
AT(MC_GearIn, CommandAborted, 63);
AT(MC_GearIn, Error, 64);
AT(MC_GearIn, ErrorID, 66);
AT(MC_GearIn, Private, 68);
_Static_assert(sizeof(MC_GearOut_t) == 32, "MC_GearOut");
AT(MC_GearOut, Slave, 0);
AT(MC_GearOut, Execute, 8);
AT(MC_GearOut, Done, 9);
AT(MC_GearOut, Busy, 10);
AT(MC_GearOut, Error, 11);
AT(MC_GearOut, ErrorID, 12);
AT(MC_GearOut, Private, 16);
_Static_assert(sizeof(MC_GearInPos_t) == 128, "MC_GearInPos");
AT(MC_GearInPos, Master, 0);
AT(MC_GearInPos, Slave, 8);
AT(MC_GearInPos, Execute, 16);
AT(MC_GearInPos, RatioNumerator, 20);
AT(MC_GearInPos, RatioDenominator, 24);
AT(MC_GearInPos, MasterValueSource, 28);
AT(MC_GearInPos, MasterSyncPosition, 32);
AT(MC_GearInPos, SlaveSyncPosition, 40);
AT(MC_GearInPos, SyncMode, 48);
AT(MC_GearInPos, MasterStartDistance, 56);
AT(MC_GearInPos, Velocity, 64);
AT(MC_GearInPos, Acceleration, 72);
AT(MC_GearInPos, Deceleration, 80);
AT(MC_GearInPos, Jerk, 88);
AT(MC_GearInPos, BufferMode, 96);
AT(MC_GearInPos, StartSync, 100);
AT(MC_GearInPos, InSync, 101);
AT(MC_GearInPos, Busy, 102);
AT(MC_GearInPos, Active, 103);
AT(MC_GearInPos, CommandAborted, 104);
AT(MC_GearInPos, Error, 105);
AT(MC_GearInPos, ErrorID, 106);
AT(MC_GearInPos, Private, 108);
_Static_assert(sizeof(MC_PhasingAbsolute_t) == 112, "MC_PhasingAbsolute");
AT(MC_PhasingAbsolute, Master, 0);
AT(MC_PhasingAbsolute, Slave, 8);
AT(MC_PhasingAbsolute, Execute, 16);
AT(MC_PhasingAbsolute, PhaseShift, 24);
AT(MC_PhasingAbsolute, Velocity, 32);
AT(MC_PhasingAbsolute, Acceleration, 40);
AT(MC_PhasingAbsolute, Deceleration, 48);
AT(MC_PhasingAbsolute, Jerk, 56);
AT(MC_PhasingAbsolute, BufferMode, 64);
AT(MC_PhasingAbsolute, Done, 68);
AT(MC_PhasingAbsolute, Busy, 69);
AT(MC_PhasingAbsolute, Active, 70);
AT(MC_PhasingAbsolute, CommandAborted, 71);
AT(MC_PhasingAbsolute, Error, 72);
AT(MC_PhasingAbsolute, ErrorID, 74);
AT(MC_PhasingAbsolute, AbsolutePhaseShift, 80);
AT(MC_PhasingAbsolute, Private, 88);
_Static_assert(sizeof(MC_PhasingRelative_t) == 112, "MC_PhasingRelative");
AT(MC_PhasingRelative, Master, 0);
AT(MC_PhasingRelative, Slave, 8);
AT(MC_PhasingRelative, Execute, 16);
AT(MC_PhasingRelative, PhaseShift, 24);
AT(MC_PhasingRelative, Velocity, 32);
AT(MC_PhasingRelative, Acceleration, 40);
AT(MC_PhasingRelative, Deceleration, 48);
AT(MC_PhasingRelative, Jerk, 56);
AT(MC_PhasingRelative, BufferMode, 64);
AT(MC_PhasingRelative, Done, 68);
AT(MC_PhasingRelative, Busy, 69);
AT(MC_PhasingRelative, Active, 70);
AT(MC_PhasingRelative, CommandAborted, 71);
AT(MC_PhasingRelative, Error, 72);
AT(MC_PhasingRelative, ErrorID, 74);
AT(MC_PhasingRelative, CoveredPhaseShift, 80);
AT(MC_PhasingRelative, Private, 88);
_Static_assert(sizeof(MC_CombineAxes_t) == 88, "MC_CombineAxes");
AT(MC_CombineAxes, Master1, 0);
AT(MC_CombineAxes, Master2, 8);
AT(MC_CombineAxes, Slave, 16);
AT(MC_CombineAxes, Execute, 24);
AT(MC_CombineAxes, ContinuousUpdate, 25);
AT(MC_CombineAxes, CombineMode, 28);
AT(MC_CombineAxes, GearRatioNumeratorM1, 32);
AT(MC_CombineAxes, GearRatioDenominatorM1, 36);
AT(MC_CombineAxes, GearRatioNumeratorM2, 40);
AT(MC_CombineAxes, GearRatioDenominatorM2, 44);
AT(MC_CombineAxes, MasterValueSourceM1, 48);
AT(MC_CombineAxes, MasterValueSourceM2, 52);
AT(MC_CombineAxes, BufferMode, 56);
AT(MC_CombineAxes, InSync, 60);
AT(MC_CombineAxes, Busy, 61);
AT(MC_CombineAxes, Active, 62);
AT(MC_CombineAxes, CommandAborted, 63);
AT(MC_CombineAxes, Error, 64);
AT(MC_CombineAxes, ErrorID, 66);
AT(MC_CombineAxes, Private, 68);
_Static_assert(sizeof(MC_AddAxisToGroup_t) == 40, "MC_AddAxisToGroup");
AT(MC_AddAxisToGroup, AxesGroup, 0);
AT(MC_AddAxisToGroup, Axis, 8);
AT(MC_AddAxisToGroup, Execute, 16);
AT(MC_AddAxisToGroup, IdentInGroup, 18);
AT(MC_AddAxisToGroup, Done, 20);
AT(MC_AddAxisToGroup, Busy, 21);
AT(MC_AddAxisToGroup, Error, 22);
AT(MC_AddAxisToGroup, ErrorID, 24);
AT(MC_AddAxisToGroup, Private, 28);
_Static_assert(sizeof(MC_RemoveAxisFromGroup_t) == 32, "MC_RemoveAxisFromGroup");
AT(MC_RemoveAxisFromGroup, AxesGroup, 0);
AT(MC_RemoveAxisFromGroup, Execute, 8);
AT(MC_RemoveAxisFromGroup, IdentInGroup, 10);
AT(MC_RemoveAxisFromGroup, Done, 12);
AT(MC_RemoveAxisFromGroup, Busy, 13);
AT(MC_RemoveAxisFromGroup, Error, 14);
AT(MC_RemoveAxisFromGroup, ErrorID, 16);
AT(MC_RemoveAxisFromGroup, Private, 20);
_Static_assert(sizeof(MC_UngroupAllAxes_t) == 32, "MC_UngroupAllAxes");
AT(MC_UngroupAllAxes, AxesGroup, 0);
AT(MC_UngroupAllAxes, Execute, 8);
AT(MC_UngroupAllAxes, Done, 9);
AT(MC_UngroupAllAxes, Busy, 10);
AT(MC_UngroupAllAxes, Error, 11);
AT(MC_UngroupAllAxes, ErrorID, 12);
AT(MC_UngroupAllAxes, Private, 16);
_Static_assert(sizeof(MC_GroupReadConfiguration_t) == 40, "MC_GroupReadConfiguration");
AT(MC_GroupReadConfiguration, AxesGroup, 0);
AT(MC_GroupReadConfiguration, Enable, 8);
AT(MC_GroupReadConfiguration, IdentInGroup, 10);
AT(MC_GroupReadConfiguration, CoordSystem, 12);
AT(MC_GroupReadConfiguration, Valid, 16);
AT(MC_GroupReadConfiguration, Busy, 17);
AT(MC_GroupReadConfiguration, Error, 18);
AT(MC_GroupReadConfiguration, ErrorID, 20);
AT(MC_GroupReadConfiguration, Axis, 22);
AT(MC_GroupReadConfiguration, AxisID, 24);
AT(MC_GroupReadConfiguration, Private, 28);
_Static_assert(sizeof(MC_GroupEnable_t) == 32, "MC_GroupEnable");
AT(MC_GroupEnable, AxesGroup, 0);
AT(MC_GroupEnable, Execute, 8);
AT(MC_GroupEnable, Done, 9);
AT(MC_GroupEnable, Busy, 10);
AT(MC_GroupEnable, Error, 11);
AT(MC_GroupEnable, ErrorID, 12);
AT(MC_GroupEnable, Private, 16);
_Static_assert(sizeof(MC_GroupDisable_t) == 32, "MC_GroupDisable");
AT(MC_GroupDisable, AxesGroup, 0);
AT(MC_GroupDisable, Execute, 8);
AT(MC_GroupDisable, Done, 9);
AT(MC_GroupDisable, Busy, 10);
AT(MC_GroupDisable, Error, 11);
AT(MC_GroupDisable, ErrorID, 12);
AT(MC_GroupDisable, Private, 16);
_Static_assert(sizeof(MC_GroupReset_t) == 32, "MC_GroupReset");
AT(MC_GroupReset, AxesGroup, 0);
AT(MC_GroupReset, Execute, 8);
AT(MC_GroupReset, Done, 9);
AT(MC_GroupReset, Busy, 10);
AT(MC_GroupReset, Error, 11);
AT(MC_GroupReset, ErrorID, 12);
AT(MC_GroupReset, Private, 16);
_Static_assert(sizeof(MC_GroupReadStatus_t) == 32, "MC_GroupReadStatus");
AT(MC_GroupReadStatus, AxesGroup, 0);
AT(MC_GroupReadStatus, Enable, 8);
AT(MC_GroupReadStatus, Valid, 9);
AT(MC_GroupReadStatus, Busy, 10);
AT(MC_GroupReadStatus, Error, 11);
AT(MC_GroupReadStatus, ErrorID, 12);
AT(MC_GroupReadStatus, GroupMoving, 14);
AT(MC_GroupReadStatus, GroupHoming, 15);
AT(MC_GroupReadStatus, GroupErrorStop, 16);
AT(MC_GroupReadStatus, GroupStandby, 17);
AT(MC_GroupReadStatus, GroupStopping, 18);
AT(MC_GroupReadStatus, GroupDisabled, 19);
AT(MC_GroupReadStatus, Private, 20);
_Static_assert(sizeof(MC_GroupReadError_t) == 32, "MC_GroupReadError");
AT(MC_GroupReadError, AxesGroup, 0);
AT(MC_GroupReadError, Enable, 8);
AT(MC_GroupReadError, Valid, 9);
AT(MC_GroupReadError, Busy, 10);
AT(MC_GroupReadError, Error, 11);
AT(MC_GroupReadError, ErrorID, 12);
AT(MC_GroupReadError, GroupErrorID, 14);
AT(MC_GroupReadError, Private, 16);
_Static_assert(sizeof(MC_GroupStop_t) == 56, "MC_GroupStop");
AT(MC_GroupStop, AxesGroup, 0);
AT(MC_GroupStop, Execute, 8);
AT(MC_GroupStop, Deceleration, 16);
AT(MC_GroupStop, Jerk, 24);
AT(MC_GroupStop, Done, 32);
AT(MC_GroupStop, Busy, 33);
AT(MC_GroupStop, CommandAborted, 34);
AT(MC_GroupStop, Error, 35);
AT(MC_GroupStop, ErrorID, 36);
AT(MC_GroupStop, Private, 40);
_Static_assert(sizeof(MC_GroupHalt_t) == 64, "MC_GroupHalt");
AT(MC_GroupHalt, AxesGroup, 0);
AT(MC_GroupHalt, Execute, 8);
AT(MC_GroupHalt, Deceleration, 16);
AT(MC_GroupHalt, Jerk, 24);
AT(MC_GroupHalt, BufferMode, 32);
AT(MC_GroupHalt, Done, 36);
AT(MC_GroupHalt, Busy, 37);
AT(MC_GroupHalt, Active, 38);
AT(MC_GroupHalt, CommandAccepted, 39);
AT(MC_GroupHalt, CommandID, 40);
AT(MC_GroupHalt, CommandAborted, 44);
AT(MC_GroupHalt, Error, 45);
AT(MC_GroupHalt, ErrorID, 46);
AT(MC_GroupHalt, Private, 48);
_Static_assert(sizeof(MC_GroupInterrupt_t) == 56, "MC_GroupInterrupt");
AT(MC_GroupInterrupt, AxesGroup, 0);
AT(MC_GroupInterrupt, Execute, 8);
AT(MC_GroupInterrupt, Deceleration, 16);
AT(MC_GroupInterrupt, Jerk, 24);
AT(MC_GroupInterrupt, Done, 32);
AT(MC_GroupInterrupt, Busy, 33);
AT(MC_GroupInterrupt, Error, 34);
AT(MC_GroupInterrupt, ErrorID, 36);
AT(MC_GroupInterrupt, Private, 40);
_Static_assert(sizeof(MC_GroupContinue_t) == 32, "MC_GroupContinue");
AT(MC_GroupContinue, AxesGroup, 0);
AT(MC_GroupContinue, Execute, 8);
AT(MC_GroupContinue, Done, 9);
AT(MC_GroupContinue, Busy, 10);
AT(MC_GroupContinue, Error, 11);
AT(MC_GroupContinue, ErrorID, 12);
AT(MC_GroupContinue, Private, 16);
_Static_assert(sizeof(MC_MoveLinearAbsolute_t) == 160, "MC_MoveLinearAbsolute");
AT(MC_MoveLinearAbsolute, AxesGroup, 0);
AT(MC_MoveLinearAbsolute, Execute, 8);
AT(MC_MoveLinearAbsolute, Position, 16);
AT(MC_MoveLinearAbsolute, Velocity, 80);
AT(MC_MoveLinearAbsolute, Acceleration, 88);
AT(MC_MoveLinearAbsolute, Deceleration, 96);
AT(MC_MoveLinearAbsolute, Jerk, 104);
AT(MC_MoveLinearAbsolute, CoordSystem, 112);
AT(MC_MoveLinearAbsolute, BufferMode, 116);
AT(MC_MoveLinearAbsolute, TransitionMode, 120);
AT(MC_MoveLinearAbsolute, TransitionParameter, 128);
AT(MC_MoveLinearAbsolute, Done, 136);
AT(MC_MoveLinearAbsolute, Busy, 137);
AT(MC_MoveLinearAbsolute, Active, 138);
AT(MC_MoveLinearAbsolute, CommandAccepted, 139);
AT(MC_MoveLinearAbsolute, CommandAborted, 140);
AT(MC_MoveLinearAbsolute, Error, 141);
AT(MC_MoveLinearAbsolute, ErrorID, 142);
AT(MC_MoveLinearAbsolute, CommandID, 144);
AT(MC_MoveLinearAbsolute, Private, 148);
_Static_assert(sizeof(MC_MoveLinearRelative_t) == 160, "MC_MoveLinearRelative");
AT(MC_MoveLinearRelative, AxesGroup, 0);
AT(MC_MoveLinearRelative, Execute, 8);
AT(MC_MoveLinearRelative, Distance, 16);
AT(MC_MoveLinearRelative, Velocity, 80);
AT(MC_MoveLinearRelative, Acceleration, 88);
AT(MC_MoveLinearRelative, Deceleration, 96);
AT(MC_MoveLinearRelative, Jerk, 104);
AT(MC_MoveLinearRelative, CoordSystem, 112);
AT(MC_MoveLinearRelative, BufferMode, 116);
AT(MC_MoveLinearRelative, TransitionMode, 120);
AT(MC_MoveLinearRelative, TransitionParameter, 128);
AT(MC_MoveLinearRelative, Done, 136);
AT(MC_MoveLinearRelative, Busy, 137);
AT(MC_MoveLinearRelative, Active, 138);
AT(MC_MoveLinearRelative, CommandAccepted, 139);
AT(MC_MoveLinearRelative, CommandAborted, 140);
AT(MC_MoveLinearRelative, Error, 141);
AT(MC_MoveLinearRelative, ErrorID, 142);
AT(MC_MoveLinearRelative, CommandID, 144);
AT(MC_MoveLinearRelative, Private, 148);
_Static_assert(sizeof(MC_MoveCircularAbsolute_t) == 232, "MC_MoveCircularAbsolute");
AT(MC_MoveCircularAbsolute, AxesGroup, 0);
AT(MC_MoveCircularAbsolute, Execute, 8);
AT(MC_MoveCircularAbsolute, CircMode, 12);
AT(MC_MoveCircularAbsolute, AuxPoint, 16);
AT(MC_MoveCircularAbsolute, EndPoint, 80);
AT(MC_MoveCircularAbsolute, PathChoice, 144);
AT(MC_MoveCircularAbsolute, Velocity, 152);
AT(MC_MoveCircularAbsolute, Acceleration, 160);
AT(MC_MoveCircularAbsolute, Deceleration, 168);
AT(MC_MoveCircularAbsolute, Jerk, 176);
AT(MC_MoveCircularAbsolute, CoordSystem, 184);
AT(MC_MoveCircularAbsolute, BufferMode, 188);
AT(MC_MoveCircularAbsolute, TransitionMode, 192);
AT(MC_MoveCircularAbsolute, TransitionParameter, 200);
AT(MC_MoveCircularAbsolute, Done, 208);
AT(MC_MoveCircularAbsolute, Busy, 209);
AT(MC_MoveCircularAbsolute, Active, 210);
AT(MC_MoveCircularAbsolute, CommandAccepted, 211);
AT(MC_MoveCircularAbsolute, CommandAborted, 212);
AT(MC_MoveCircularAbsolute, Error, 213);
AT(MC_MoveCircularAbsolute, ErrorID, 214);
AT(MC_MoveCircularAbsolute, CommandID, 216);
AT(MC_MoveCircularAbsolute, Private, 220);
_Static_assert(sizeof(MC_MoveCircularRelative_t) == 232, "MC_MoveCircularRelative");
AT(MC_MoveCircularRelative, AxesGroup, 0);
AT(MC_MoveCircularRelative, Execute, 8);
AT(MC_MoveCircularRelative, CircMode, 12);
AT(MC_MoveCircularRelative, AuxPoint, 16);
AT(MC_MoveCircularRelative, EndPoint, 80);
AT(MC_MoveCircularRelative, PathChoice, 144);
AT(MC_MoveCircularRelative, Velocity, 152);
AT(MC_MoveCircularRelative, Acceleration, 160);
AT(MC_MoveCircularRelative, Deceleration, 168);
AT(MC_MoveCircularRelative, Jerk, 176);
AT(MC_MoveCircularRelative, CoordSystem, 184);
AT(MC_MoveCircularRelative, BufferMode, 188);
AT(MC_MoveCircularRelative, TransitionMode, 192);
AT(MC_MoveCircularRelative, TransitionParameter, 200);
AT(MC_MoveCircularRelative, Done, 208);
AT(MC_MoveCircularRelative, Busy, 209);
AT(MC_MoveCircularRelative, Active, 210);
AT(MC_MoveCircularRelative, CommandAccepted, 211);
AT(MC_MoveCircularRelative, CommandAborted, 212);
AT(MC_MoveCircularRelative, Error, 213);
AT(MC_MoveCircularRelative, ErrorID, 214);
AT(MC_MoveCircularRelative, CommandID, 216);
AT(MC_MoveCircularRelative, Private, 220);
_Static_assert(sizeof(MC_MoveDirectAbsolute_t) == 128, "MC_MoveDirectAbsolute");
AT(MC_MoveDirectAbsolute, AxesGroup, 0);
AT(MC_MoveDirectAbsolute, Execute, 8);
AT(MC_MoveDirectAbsolute, Position, 16);
AT(MC_MoveDirectAbsolute, CoordSystem, 80);
AT(MC_MoveDirectAbsolute, BufferMode, 84);
AT(MC_MoveDirectAbsolute, TransitionMode, 88);
AT(MC_MoveDirectAbsolute, TransitionParameter, 96);
AT(MC_MoveDirectAbsolute, Done, 104);
AT(MC_MoveDirectAbsolute, Busy, 105);
AT(MC_MoveDirectAbsolute, Active, 106);
AT(MC_MoveDirectAbsolute, CommandAccepted, 107);
AT(MC_MoveDirectAbsolute, CommandAborted, 108);
AT(MC_MoveDirectAbsolute, Error, 109);
AT(MC_MoveDirectAbsolute, ErrorID, 110);
AT(MC_MoveDirectAbsolute, CommandID, 112);
AT(MC_MoveDirectAbsolute, Private, 116);
_Static_assert(sizeof(MC_MoveDirectRelative_t) == 128, "MC_MoveDirectRelative");
AT(MC_MoveDirectRelative, AxesGroup, 0);
AT(MC_MoveDirectRelative, Execute, 8);
AT(MC_MoveDirectRelative, Distance, 16);
AT(MC_MoveDirectRelative, CoordSystem, 80);
AT(MC_MoveDirectRelative, BufferMode, 84);
AT(MC_MoveDirectRelative, TransitionMode, 88);
AT(MC_MoveDirectRelative, TransitionParameter, 96);
AT(MC_MoveDirectRelative, Done, 104);
AT(MC_MoveDirectRelative, Busy, 105);
AT(MC_MoveDirectRelative, Active, 106);
AT(MC_MoveDirectRelative, CommandAccepted, 107);
AT(MC_MoveDirectRelative, CommandAborted, 108);
AT(MC_MoveDirectRelative, Error, 109);
AT(MC_MoveDirectRelative, ErrorID, 110);
AT(MC_MoveDirectRelative, CommandID, 112);
AT(MC_MoveDirectRelative, Private, 116);
_Static_assert(sizeof(MC_GroupReadPosition_t) == 112, "MC_GroupReadPosition");
AT(MC_GroupReadPosition, AxesGroup, 0);
AT(MC_GroupReadPosition, Enable, 8);
AT(MC_GroupReadPosition, CoordSystem, 12);
AT(MC_GroupReadPosition, Source, 16);
AT(MC_GroupReadPosition, Valid, 20);
AT(MC_GroupReadPosition, Busy, 21);
AT(MC_GroupReadPosition, Error, 22);
AT(MC_GroupReadPosition, ErrorID, 24);
AT(MC_GroupReadPosition, Position, 32);
AT(MC_GroupReadPosition, Private, 96);
_Static_assert(sizeof(MC_GroupReadVelocity_t) == 120, "MC_GroupReadVelocity");
AT(MC_GroupReadVelocity, AxesGroup, 0);
AT(MC_GroupReadVelocity, Enable, 8);
AT(MC_GroupReadVelocity, CoordSystem, 12);
AT(MC_GroupReadVelocity, Source, 16);
AT(MC_GroupReadVelocity, Valid, 20);
AT(MC_GroupReadVelocity, Busy, 21);
AT(MC_GroupReadVelocity, Error, 22);
AT(MC_GroupReadVelocity, ErrorID, 24);
AT(MC_GroupReadVelocity, Velocity, 32);
AT(MC_GroupReadVelocity, PathVelocity, 96);
AT(MC_GroupReadVelocity, Private, 104);
_Static_assert(sizeof(MC_GroupSetOverride_t) == 64, "MC_GroupSetOverride");
AT(MC_GroupSetOverride, AxesGroup, 0);
AT(MC_GroupSetOverride, Enable, 8);
AT(MC_GroupSetOverride, VelFactor, 16);
AT(MC_GroupSetOverride, AccFactor, 24);
AT(MC_GroupSetOverride, JerkFactor, 32);
AT(MC_GroupSetOverride, Enabled, 40);
AT(MC_GroupSetOverride, Busy, 41);
AT(MC_GroupSetOverride, Error, 42);
AT(MC_GroupSetOverride, ErrorID, 44);
AT(MC_GroupSetOverride, Private, 48);
_Static_assert(sizeof(MC_SetPosition_t) == 56, "MC_SetPosition");
AT(MC_SetPosition, Axis, 0);
AT(MC_SetPosition, Execute, 8);
AT(MC_SetPosition, Position, 16);
AT(MC_SetPosition, Relative, 24);
AT(MC_SetPosition, ExecutionMode, 28);
AT(MC_SetPosition, Done, 32);
AT(MC_SetPosition, Busy, 33);
AT(MC_SetPosition, Error, 34);
AT(MC_SetPosition, ErrorID, 36);
AT(MC_SetPosition, Private, 40);
_Static_assert(sizeof(MC_SetOverride_t) == 64, "MC_SetOverride");
AT(MC_SetOverride, Axis, 0);
AT(MC_SetOverride, Enable, 8);
AT(MC_SetOverride, VelFactor, 16);
AT(MC_SetOverride, AccFactor, 24);
AT(MC_SetOverride, JerkFactor, 32);
AT(MC_SetOverride, Enabled, 40);
AT(MC_SetOverride, Busy, 41);
AT(MC_SetOverride, Error, 42);
AT(MC_SetOverride, ErrorID, 44);
AT(MC_SetOverride, Private, 48);
_Static_assert(sizeof(MC_ReadParameter_t) == 48, "MC_ReadParameter");
AT(MC_ReadParameter, Axis, 0);
AT(MC_ReadParameter, Enable, 8);
AT(MC_ReadParameter, ParameterNumber, 10);
AT(MC_ReadParameter, Valid, 12);
AT(MC_ReadParameter, Busy, 13);
AT(MC_ReadParameter, Error, 14);
AT(MC_ReadParameter, ErrorID, 16);
AT(MC_ReadParameter, Value, 24);
AT(MC_ReadParameter, Private, 32);
_Static_assert(sizeof(MC_ReadBoolParameter_t) == 32, "MC_ReadBoolParameter");
AT(MC_ReadBoolParameter, Axis, 0);
AT(MC_ReadBoolParameter, Enable, 8);
AT(MC_ReadBoolParameter, ParameterNumber, 10);
AT(MC_ReadBoolParameter, Valid, 12);
AT(MC_ReadBoolParameter, Busy, 13);
AT(MC_ReadBoolParameter, Error, 14);
AT(MC_ReadBoolParameter, ErrorID, 16);
AT(MC_ReadBoolParameter, Value, 18);
AT(MC_ReadBoolParameter, Private, 20);
_Static_assert(sizeof(MC_WriteParameter_t) == 48, "MC_WriteParameter");
AT(MC_WriteParameter, Axis, 0);
AT(MC_WriteParameter, Execute, 8);
AT(MC_WriteParameter, ParameterNumber, 10);
AT(MC_WriteParameter, Value, 16);
AT(MC_WriteParameter, ExecutionMode, 24);
AT(MC_WriteParameter, Done, 28);
AT(MC_WriteParameter, Busy, 29);
AT(MC_WriteParameter, Error, 30);
AT(MC_WriteParameter, ErrorID, 32);
AT(MC_WriteParameter, Private, 36);
_Static_assert(sizeof(MC_WriteBoolParameter_t) == 40, "MC_WriteBoolParameter");
AT(MC_WriteBoolParameter, Axis, 0);
AT(MC_WriteBoolParameter, Execute, 8);
AT(MC_WriteBoolParameter, ParameterNumber, 10);
AT(MC_WriteBoolParameter, Value, 12);
AT(MC_WriteBoolParameter, ExecutionMode, 16);
AT(MC_WriteBoolParameter, Done, 20);
AT(MC_WriteBoolParameter, Busy, 21);
AT(MC_WriteBoolParameter, Error, 22);
AT(MC_WriteBoolParameter, ErrorID, 24);
AT(MC_WriteBoolParameter, Private, 28);
_Static_assert(sizeof(MC_ReadDigitalInput_t) == 32, "MC_ReadDigitalInput");
AT(MC_ReadDigitalInput, Input, 0);
AT(MC_ReadDigitalInput, Enable, 8);
AT(MC_ReadDigitalInput, InputNumber, 10);
AT(MC_ReadDigitalInput, Valid, 12);
AT(MC_ReadDigitalInput, Busy, 13);
AT(MC_ReadDigitalInput, Error, 14);
AT(MC_ReadDigitalInput, ErrorID, 16);
AT(MC_ReadDigitalInput, Value, 18);
AT(MC_ReadDigitalInput, Private, 20);
_Static_assert(sizeof(MC_ReadDigitalOutput_t) == 32, "MC_ReadDigitalOutput");
AT(MC_ReadDigitalOutput, Output, 0);
AT(MC_ReadDigitalOutput, Enable, 8);
AT(MC_ReadDigitalOutput, OutputNumber, 10);
AT(MC_ReadDigitalOutput, Valid, 12);
AT(MC_ReadDigitalOutput, Busy, 13);
AT(MC_ReadDigitalOutput, Error, 14);
AT(MC_ReadDigitalOutput, ErrorID, 16);
AT(MC_ReadDigitalOutput, Value, 18);
AT(MC_ReadDigitalOutput, Private, 20);
_Static_assert(sizeof(MC_WriteDigitalOutput_t) == 40, "MC_WriteDigitalOutput");
AT(MC_WriteDigitalOutput, Output, 0);
AT(MC_WriteDigitalOutput, Execute, 8);
AT(MC_WriteDigitalOutput, OutputNumber, 10);
AT(MC_WriteDigitalOutput, Value, 12);
AT(MC_WriteDigitalOutput, ExecutionMode, 16);
AT(MC_WriteDigitalOutput, Done, 20);
AT(MC_WriteDigitalOutput, Busy, 21);
AT(MC_WriteDigitalOutput, Error, 22);
AT(MC_WriteDigitalOutput, ErrorID, 24);
AT(MC_WriteDigitalOutput, Private, 28);
_Static_assert(sizeof(MC_ReadActualPosition_t) == 40, "MC_ReadActualPosition");
AT(MC_ReadActualPosition, Axis, 0);
AT(MC_ReadActualPosition, Enable, 8);
AT(MC_ReadActualPosition, Valid, 9);
AT(MC_ReadActualPosition, Busy, 10);
AT(MC_ReadActualPosition, Error, 11);
AT(MC_ReadActualPosition, ErrorID, 12);
AT(MC_ReadActualPosition, Position, 16);
AT(MC_ReadActualPosition, Private, 24);
_Static_assert(sizeof(MC_ReadActualVelocity_t) == 40, "MC_ReadActualVelocity");
AT(MC_ReadActualVelocity, Axis, 0);
AT(MC_ReadActualVelocity, Enable, 8);
AT(MC_ReadActualVelocity, Valid, 9);
AT(MC_ReadActualVelocity, Busy, 10);
AT(MC_ReadActualVelocity, Error, 11);
AT(MC_ReadActualVelocity, ErrorID, 12);
AT(MC_ReadActualVelocity, Velocity, 16);
AT(MC_ReadActualVelocity, Private, 24);
_Static_assert(sizeof(MC_ReadActualTorque_t) == 40, "MC_ReadActualTorque");
AT(MC_ReadActualTorque, Axis, 0);
AT(MC_ReadActualTorque, Enable, 8);
AT(MC_ReadActualTorque, Valid, 9);
AT(MC_ReadActualTorque, Busy, 10);
AT(MC_ReadActualTorque, Error, 11);
AT(MC_ReadActualTorque, ErrorID, 12);
AT(MC_ReadActualTorque, Torque, 16);
AT(MC_ReadActualTorque, Private, 24);
_Static_assert(sizeof(MC_ReadStatus_t) == 40, "MC_ReadStatus");
AT(MC_ReadStatus, Axis, 0);
AT(MC_ReadStatus, Enable, 8);
AT(MC_ReadStatus, Valid, 9);
AT(MC_ReadStatus, Busy, 10);
AT(MC_ReadStatus, Error, 11);
AT(MC_ReadStatus, ErrorID, 12);
AT(MC_ReadStatus, ErrorStop, 14);
AT(MC_ReadStatus, Disabled, 15);
AT(MC_ReadStatus, Stopping, 16);
AT(MC_ReadStatus, Homing, 17);
AT(MC_ReadStatus, Standstill, 18);
AT(MC_ReadStatus, DiscreteMotion, 19);
AT(MC_ReadStatus, ContinuousMotion, 20);
AT(MC_ReadStatus, SynchronizedMotion, 21);
AT(MC_ReadStatus, Private, 24);
_Static_assert(sizeof(MC_ReadMotionState_t) == 72, "MC_ReadMotionState");
AT(MC_ReadMotionState, Axis, 0);
AT(MC_ReadMotionState, Enable, 8);
AT(MC_ReadMotionState, Source, 12);
AT(MC_ReadMotionState, Valid, 16);
AT(MC_ReadMotionState, Busy, 17);
AT(MC_ReadMotionState, Error, 18);
AT(MC_ReadMotionState, ErrorID, 20);
AT(MC_ReadMotionState, ConstantVelocity, 22);
AT(MC_ReadMotionState, Accelerating, 23);
AT(MC_ReadMotionState, Decelerating, 24);
AT(MC_ReadMotionState, DirectionPositive, 25);
AT(MC_ReadMotionState, DirectionNegative, 26);
AT(MC_ReadMotionState, Private, 32);
_Static_assert(sizeof(MC_ReadAxisInfo_t) == 40, "MC_ReadAxisInfo");
AT(MC_ReadAxisInfo, Axis, 0);
AT(MC_ReadAxisInfo, Enable, 8);
AT(MC_ReadAxisInfo, Valid, 9);
AT(MC_ReadAxisInfo, Busy, 10);
AT(MC_ReadAxisInfo, Error, 11);
AT(MC_ReadAxisInfo, ErrorID, 12);
AT(MC_ReadAxisInfo, HomeAbsSwitch, 14);
AT(MC_ReadAxisInfo, LimitSwitchPos, 15);
AT(MC_ReadAxisInfo, LimitSwitchNeg, 16);
AT(MC_ReadAxisInfo, Simulation, 17);
AT(MC_ReadAxisInfo, CommunicationReady, 18);
AT(MC_ReadAxisInfo, ReadyForPowerOn, 19);
AT(MC_ReadAxisInfo, PowerOn, 20);
AT(MC_ReadAxisInfo, IsHomed, 21);
AT(MC_ReadAxisInfo, AxisWarning, 22);
AT(MC_ReadAxisInfo, Private, 24);
_Static_assert(sizeof(MC_ReadAxisError_t) == 32, "MC_ReadAxisError");
AT(MC_ReadAxisError, Axis, 0);
AT(MC_ReadAxisError, Enable, 8);
AT(MC_ReadAxisError, Valid, 9);
AT(MC_ReadAxisError, Busy, 10);
AT(MC_ReadAxisError, Error, 11);
AT(MC_ReadAxisError, ErrorID, 12);
AT(MC_ReadAxisError, AxisErrorID, 14);
AT(MC_ReadAxisError, DeviceErrorCode, 16);
AT(MC_ReadAxisError, Private, 20);
_Static_assert(sizeof(MC_Reset_t) == 32, "MC_Reset");
AT(MC_Reset, Axis, 0);
AT(MC_Reset, Execute, 8);
AT(MC_Reset, Done, 9);
AT(MC_Reset, Busy, 10);
AT(MC_Reset, Error, 11);
AT(MC_Reset, ErrorID, 12);
AT(MC_Reset, Private, 16);
_Static_assert(sizeof(MC_DigitalCamSwitch_t) == 2416, "MC_DigitalCamSwitch");
AT(MC_DigitalCamSwitch, Axis, 0);
AT(MC_DigitalCamSwitch, Switches, 8);
AT(MC_DigitalCamSwitch, Outputs, 16);
AT(MC_DigitalCamSwitch, TrackOptions, 24);
AT(MC_DigitalCamSwitch, Enable, 32);
AT(MC_DigitalCamSwitch, EnableMask, 36);
AT(MC_DigitalCamSwitch, ValueSource, 40);
AT(MC_DigitalCamSwitch, InOperation, 44);
AT(MC_DigitalCamSwitch, Busy, 45);
AT(MC_DigitalCamSwitch, Error, 46);
AT(MC_DigitalCamSwitch, ErrorID, 48);
AT(MC_DigitalCamSwitch, Private, 56);
_Static_assert(sizeof(MC_TouchProbe_t) == 80, "MC_TouchProbe");
AT(MC_TouchProbe, Axis, 0);
AT(MC_TouchProbe, TriggerInput, 8);
AT(MC_TouchProbe, Execute, 16);
AT(MC_TouchProbe, WindowOnly, 17);
AT(MC_TouchProbe, FirstPosition, 24);
AT(MC_TouchProbe, LastPosition, 32);
AT(MC_TouchProbe, Done, 40);
AT(MC_TouchProbe, Busy, 41);
AT(MC_TouchProbe, CommandAborted, 42);
AT(MC_TouchProbe, Error, 43);
AT(MC_TouchProbe, ErrorID, 44);
AT(MC_TouchProbe, RecordedPosition, 48);
AT(MC_TouchProbe, Uncertainty, 56);
AT(MC_TouchProbe, Private, 64);
_Static_assert(sizeof(MC_AbortTrigger_t) == 40, "MC_AbortTrigger");
AT(MC_AbortTrigger, Axis, 0);
AT(MC_AbortTrigger, TriggerInput, 8);
AT(MC_AbortTrigger, Execute, 16);
AT(MC_AbortTrigger, Done, 17);
AT(MC_AbortTrigger, Busy, 18);
AT(MC_AbortTrigger, Error, 19);
AT(MC_AbortTrigger, ErrorID, 20);
AT(MC_AbortTrigger, Private, 24);
_Static_assert(sizeof(MC_StepAbsoluteSwitch_t) == 88, "MC_StepAbsoluteSwitch");
AT(MC_StepAbsoluteSwitch, Axis, 0);
AT(MC_StepAbsoluteSwitch, Execute, 8);
AT(MC_StepAbsoluteSwitch, Direction, 12);
AT(MC_StepAbsoluteSwitch, SwitchMode, 16);
AT(MC_StepAbsoluteSwitch, ReferenceSignal, 20);
AT(MC_StepAbsoluteSwitch, Velocity, 24);
AT(MC_StepAbsoluteSwitch, SetPosition, 32);
AT(MC_StepAbsoluteSwitch, TorqueLimit, 40);
AT(MC_StepAbsoluteSwitch, TimeLimit, 48);
AT(MC_StepAbsoluteSwitch, DistanceLimit, 56);
AT(MC_StepAbsoluteSwitch, BufferMode, 64);
AT(MC_StepAbsoluteSwitch, Done, 68);
AT(MC_StepAbsoluteSwitch, Busy, 69);
AT(MC_StepAbsoluteSwitch, Active, 70);
AT(MC_StepAbsoluteSwitch, CommandAborted, 71);
AT(MC_StepAbsoluteSwitch, Error, 72);
AT(MC_StepAbsoluteSwitch, ErrorID, 74);
AT(MC_StepAbsoluteSwitch, Private, 76);
_Static_assert(sizeof(MC_StepLimitSwitch_t) == 88, "MC_StepLimitSwitch");
AT(MC_StepLimitSwitch, Axis, 0);
AT(MC_StepLimitSwitch, Execute, 8);
AT(MC_StepLimitSwitch, Direction, 12);
AT(MC_StepLimitSwitch, LimitSwitchMode, 16);
AT(MC_StepLimitSwitch, Velocity, 24);
AT(MC_StepLimitSwitch, SetPosition, 32);
AT(MC_StepLimitSwitch, TorqueLimit, 40);
AT(MC_StepLimitSwitch, TimeLimit, 48);
AT(MC_StepLimitSwitch, DistanceLimit, 56);
AT(MC_StepLimitSwitch, BufferMode, 64);
AT(MC_StepLimitSwitch, Done, 68);
AT(MC_StepLimitSwitch, Busy, 69);
AT(MC_StepLimitSwitch, Active, 70);
AT(MC_StepLimitSwitch, CommandAborted, 71);
AT(MC_StepLimitSwitch, Error, 72);
AT(MC_StepLimitSwitch, ErrorID, 74);
AT(MC_StepLimitSwitch, Private, 76);
_Static_assert(sizeof(MC_StepBlock_t) == 96, "MC_StepBlock");
AT(MC_StepBlock, Axis, 0);
AT(MC_StepBlock, Execute, 8);
AT(MC_StepBlock, Direction, 12);
AT(MC_StepBlock, Velocity, 16);
AT(MC_StepBlock, SetPosition, 24);
AT(MC_StepBlock, DetectionVelocityLimit, 32);
AT(MC_StepBlock, DetectionVelocityTime, 40);
AT(MC_StepBlock, TorqueLimit, 48);
AT(MC_StepBlock, TimeLimit, 56);
AT(MC_StepBlock, DistanceLimit, 64);
AT(MC_StepBlock, BufferMode, 72);
AT(MC_StepBlock, Done, 76);
AT(MC_StepBlock, Busy, 77);
AT(MC_StepBlock, Active, 78);
AT(MC_StepBlock, CommandAborted, 79);
AT(MC_StepBlock, Error, 80);
AT(MC_StepBlock, ErrorID, 82);
AT(MC_StepBlock, Private, 84);
_Static_assert(sizeof(MC_StepReferencePulse_t) == 88, "MC_StepReferencePulse");
AT(MC_StepReferencePulse, Axis, 0);
AT(MC_StepReferencePulse, Execute, 8);
AT(MC_StepReferencePulse, Direction, 12);
AT(MC_StepReferencePulse, ReferenceSignal, 16);
AT(MC_StepReferencePulse, Velocity, 24);
AT(MC_StepReferencePulse, SetPosition, 32);
AT(MC_StepReferencePulse, TorqueLimit, 40);
AT(MC_StepReferencePulse, TimeLimit, 48);
AT(MC_StepReferencePulse, DistanceLimit, 56);
AT(MC_StepReferencePulse, BufferMode, 64);
AT(MC_StepReferencePulse, Done, 68);
AT(MC_StepReferencePulse, Busy, 69);
AT(MC_StepReferencePulse, Active, 70);
AT(MC_StepReferencePulse, CommandAborted, 71);
AT(MC_StepReferencePulse, Error, 72);
AT(MC_StepReferencePulse, ErrorID, 74);
AT(MC_StepReferencePulse, Private, 76);
_Static_assert(sizeof(MC_StepDistanceCoded_t) == 72, "MC_StepDistanceCoded");
AT(MC_StepDistanceCoded, Axis, 0);
AT(MC_StepDistanceCoded, Execute, 8);
AT(MC_StepDistanceCoded, Direction, 12);
AT(MC_StepDistanceCoded, Velocity, 16);
AT(MC_StepDistanceCoded, TorqueLimit, 24);
AT(MC_StepDistanceCoded, TimeLimit, 32);
AT(MC_StepDistanceCoded, DistanceLimit, 40);
AT(MC_StepDistanceCoded, BufferMode, 48);
AT(MC_StepDistanceCoded, Done, 52);
AT(MC_StepDistanceCoded, Busy, 53);
AT(MC_StepDistanceCoded, Active, 54);
AT(MC_StepDistanceCoded, CommandAborted, 55);
AT(MC_StepDistanceCoded, Error, 56);
AT(MC_StepDistanceCoded, ErrorID, 58);
AT(MC_StepDistanceCoded, Private, 60);
_Static_assert(sizeof(MC_HomeDirect_t) == 48, "MC_HomeDirect");
AT(MC_HomeDirect, Axis, 0);
AT(MC_HomeDirect, Execute, 8);
AT(MC_HomeDirect, SetPosition, 16);
AT(MC_HomeDirect, BufferMode, 24);
AT(MC_HomeDirect, Done, 28);
AT(MC_HomeDirect, Busy, 29);
AT(MC_HomeDirect, Active, 30);
AT(MC_HomeDirect, CommandAborted, 31);
AT(MC_HomeDirect, Error, 32);
AT(MC_HomeDirect, ErrorID, 34);
AT(MC_HomeDirect, Private, 36);
_Static_assert(sizeof(MC_HomeAbsolute_t) == 40, "MC_HomeAbsolute");
AT(MC_HomeAbsolute, Axis, 0);
AT(MC_HomeAbsolute, Execute, 8);
AT(MC_HomeAbsolute, BufferMode, 12);
AT(MC_HomeAbsolute, Done, 16);
AT(MC_HomeAbsolute, Busy, 17);
AT(MC_HomeAbsolute, Active, 18);
AT(MC_HomeAbsolute, CommandAborted, 19);
AT(MC_HomeAbsolute, Error, 20);
AT(MC_HomeAbsolute, ErrorID, 22);
AT(MC_HomeAbsolute, Private, 24);
_Static_assert(sizeof(MC_FinishHoming_t) == 80, "MC_FinishHoming");
AT(MC_FinishHoming, Axis, 0);
AT(MC_FinishHoming, Execute, 8);
AT(MC_FinishHoming, Distance, 16);
AT(MC_FinishHoming, Velocity, 24);
AT(MC_FinishHoming, Acceleration, 32);
AT(MC_FinishHoming, Deceleration, 40);
AT(MC_FinishHoming, Jerk, 48);
AT(MC_FinishHoming, BufferMode, 56);
AT(MC_FinishHoming, Done, 60);
AT(MC_FinishHoming, Busy, 61);
AT(MC_FinishHoming, Active, 62);
AT(MC_FinishHoming, CommandAborted, 63);
AT(MC_FinishHoming, Error, 64);
AT(MC_FinishHoming, ErrorID, 66);
AT(MC_FinishHoming, Private, 68);
_Static_assert(sizeof(MC_StepReferenceFlyingSwitch_t) == 72, "MC_StepReferenceFlyingSwitch");
AT(MC_StepReferenceFlyingSwitch, Axis, 0);
AT(MC_StepReferenceFlyingSwitch, Execute, 8);
AT(MC_StepReferenceFlyingSwitch, SwitchMode, 12);
AT(MC_StepReferenceFlyingSwitch, ReferenceSignal, 16);
AT(MC_StepReferenceFlyingSwitch, SetPosition, 24);
AT(MC_StepReferenceFlyingSwitch, TimeLimit, 32);
AT(MC_StepReferenceFlyingSwitch, DistanceLimit, 40);
AT(MC_StepReferenceFlyingSwitch, BufferMode, 48);
AT(MC_StepReferenceFlyingSwitch, Done, 52);
AT(MC_StepReferenceFlyingSwitch, Busy, 53);
AT(MC_StepReferenceFlyingSwitch, Active, 54);
AT(MC_StepReferenceFlyingSwitch, CommandAborted, 55);
AT(MC_StepReferenceFlyingSwitch, Error, 56);
AT(MC_StepReferenceFlyingSwitch, ErrorID, 58);
AT(MC_StepReferenceFlyingSwitch, Private, 60);
_Static_assert(sizeof(MC_StepReferenceFlyingRefPulse_t) == 64, "MC_StepReferenceFlyingRefPulse");
AT(MC_StepReferenceFlyingRefPulse, Axis, 0);
AT(MC_StepReferenceFlyingRefPulse, Execute, 8);
AT(MC_StepReferenceFlyingRefPulse, ReferenceSignal, 10);
AT(MC_StepReferenceFlyingRefPulse, SetPosition, 16);
AT(MC_StepReferenceFlyingRefPulse, TimeLimit, 24);
AT(MC_StepReferenceFlyingRefPulse, DistanceLimit, 32);
AT(MC_StepReferenceFlyingRefPulse, BufferMode, 40);
AT(MC_StepReferenceFlyingRefPulse, Done, 44);
AT(MC_StepReferenceFlyingRefPulse, Busy, 45);
AT(MC_StepReferenceFlyingRefPulse, Active, 46);
AT(MC_StepReferenceFlyingRefPulse, CommandAborted, 47);
AT(MC_StepReferenceFlyingRefPulse, Error, 48);
AT(MC_StepReferenceFlyingRefPulse, ErrorID, 50);
AT(MC_StepReferenceFlyingRefPulse, Private, 52);
_Static_assert(sizeof(MC_AbortPassiveHoming_t) == 32, "MC_AbortPassiveHoming");
AT(MC_AbortPassiveHoming, Axis, 0);
AT(MC_AbortPassiveHoming, Execute, 8);
AT(MC_AbortPassiveHoming, Done, 9);
AT(MC_AbortPassiveHoming, Busy, 10);
AT(MC_AbortPassiveHoming, CommandAborted, 11);
AT(MC_AbortPassiveHoming, Error, 12);
AT(MC_AbortPassiveHoming, ErrorID, 14);
AT(MC_AbortPassiveHoming, Private, 16);
_Static_assert(sizeof(CM_SendCML_t) == 216, "CM_SendCML");
AT(CM_SendCML, Axis, 0);
AT(CM_SendCML, Execute, 8);
AT(CM_SendCML, Command, 9);
AT(CM_SendCML, Timeout, 96);
AT(CM_SendCML, AllowMotion, 104);
AT(CM_SendCML, Line, 106);
AT(CM_SendCML, Done, 108);
AT(CM_SendCML, Busy, 109);
AT(CM_SendCML, Error, 110);
AT(CM_SendCML, ErrorID, 112);
AT(CM_SendCML, Response, 114);
AT(CM_SendCML, Lines, 196);
AT(CM_SendCML, Strays, 198);
AT(CM_SendCML, Private, 200);
_Static_assert(sizeof(CM_SetMode_t) == 40, "CM_SetMode");
AT(CM_SetMode, Axis, 0);
AT(CM_SetMode, Execute, 8);
AT(CM_SetMode, Mode, 12);
AT(CM_SetMode, Insist, 16);
AT(CM_SetMode, Done, 17);
AT(CM_SetMode, Busy, 18);
AT(CM_SetMode, Error, 19);
AT(CM_SetMode, ErrorID, 20);
AT(CM_SetMode, Private, 24);
_Static_assert(sizeof(CM_Command_t) == 48, "CM_Command");
AT(CM_Command, Axis, 0);
AT(CM_Command, Execute, 8);
AT(CM_Command, Command, 12);
AT(CM_Command, Timeout, 16);
AT(CM_Command, Done, 24);
AT(CM_Command, Busy, 25);
AT(CM_Command, Error, 26);
AT(CM_Command, ErrorID, 28);
AT(CM_Command, Private, 32);
_Static_assert(sizeof(TON_t) == 48, "TON");
AT(TON, IN, 0);
AT(TON, PT, 8);
AT(TON, Q, 16);
AT(TON, ET, 24);
AT(TON, Private, 32);
_Static_assert(sizeof(TOF_t) == 48, "TOF");
AT(TOF, IN, 0);
AT(TOF, PT, 8);
AT(TOF, Q, 16);
AT(TOF, ET, 24);
AT(TOF, Private, 32);
_Static_assert(sizeof(TP_t) == 48, "TP");
AT(TP, IN, 0);
AT(TP, PT, 8);
AT(TP, Q, 16);
AT(TP, ET, 24);
AT(TP, Private, 32);
_Static_assert(sizeof(R_TRIG_t) == 4, "R_TRIG");
AT(R_TRIG, CLK, 0);
AT(R_TRIG, Q, 1);
AT(R_TRIG, Private, 2);
_Static_assert(sizeof(F_TRIG_t) == 4, "F_TRIG");
AT(F_TRIG, CLK, 0);
AT(F_TRIG, Q, 1);
AT(F_TRIG, Private, 2);
_Static_assert(sizeof(SR_t) == 3, "SR");
AT(SR, S1, 0);
AT(SR, R, 1);
AT(SR, Q1, 2);
_Static_assert(sizeof(RS_t) == 3, "RS");
AT(RS, S, 0);
AT(RS, R1, 1);
AT(RS, Q1, 2);
_Static_assert(sizeof(CTU_t) == 10, "CTU");
AT(CTU, CU, 0);
AT(CTU, R, 1);
AT(CTU, PV, 2);
AT(CTU, Q, 4);
AT(CTU, CV, 6);
AT(CTU, Private, 8);
_Static_assert(sizeof(CTD_t) == 10, "CTD");
AT(CTD, CD, 0);
AT(CTD, LD, 1);
AT(CTD, PV, 2);
AT(CTD, Q, 4);
AT(CTD, CV, 6);
AT(CTD, Private, 8);
_Static_assert(sizeof(CTUD_t) == 12, "CTUD");
AT(CTUD, CU, 0);
AT(CTUD, CD, 1);
AT(CTUD, R, 2);
AT(CTUD, LD, 3);
AT(CTUD, PV, 4);
AT(CTUD, QU, 6);
AT(CTUD, QD, 7);
AT(CTUD, CV, 8);
AT(CTUD, Private, 10);
#endif

#define MEMBER(TYPE, NAME, SECTION, KIND) \
    {#NAME, BLOCK_##SECTION, BLOCK_##KIND, offsetof(TYPE##_t, NAME), sizeof(((TYPE##_t *)0)->NAME)}
#define BLOCK(TYPE, RULES) \
    {#TYPE, sizeof(TYPE##_t), call_##TYPE, members_of_##TYPE, sizeof members_of_##TYPE / sizeof *members_of_##TYPE, \
     RULES, errors_of_##TYPE}

static const block_rule_t rules_discrete[CM1E_AXIS_STATE_COUNT] = {
    [CM1E_AXIS_DISABLED] = {.refusal = CM1E_ERROR_AXIS_NOT_POWERED},
    [CM1E_AXIS_STANDSTILL] = {.next = CM1E_AXIS_DISCRETE_MOTION},
    [CM1E_AXIS_HOMING] = {.refusal = CM1E_ERROR_AXIS_HOMING},
    [CM1E_AXIS_DISCRETE_MOTION] = {.next = CM1E_AXIS_DISCRETE_MOTION},
    [CM1E_AXIS_CONTINUOUS_MOTION] = {.next = CM1E_AXIS_DISCRETE_MOTION},
    [CM1E_AXIS_SYNCHRONIZED_MOTION] = {.next = CM1E_AXIS_DISCRETE_MOTION},
    [CM1E_AXIS_STOPPING] = {.refusal = CM1E_ERROR_AXIS_STOPPING},
    [CM1E_AXIS_ERROR_STOP] = {.refusal = CM1E_ERROR_AXIS_ERROR_STOP},
};
static const block_rule_t rules_continuous[CM1E_AXIS_STATE_COUNT] = {
    [CM1E_AXIS_DISABLED] = {.refusal = CM1E_ERROR_AXIS_NOT_POWERED},
    [CM1E_AXIS_STANDSTILL] = {.next = CM1E_AXIS_CONTINUOUS_MOTION},
    [CM1E_AXIS_HOMING] = {.refusal = CM1E_ERROR_AXIS_HOMING},
    [CM1E_AXIS_DISCRETE_MOTION] = {.next = CM1E_AXIS_CONTINUOUS_MOTION},
    [CM1E_AXIS_CONTINUOUS_MOTION] = {.next = CM1E_AXIS_CONTINUOUS_MOTION},
    [CM1E_AXIS_SYNCHRONIZED_MOTION] = {.next = CM1E_AXIS_CONTINUOUS_MOTION},
    [CM1E_AXIS_STOPPING] = {.refusal = CM1E_ERROR_AXIS_STOPPING},
    [CM1E_AXIS_ERROR_STOP] = {.refusal = CM1E_ERROR_AXIS_ERROR_STOP},
};
static const block_rule_t rules_halt[CM1E_AXIS_STATE_COUNT] = {
    [CM1E_AXIS_DISABLED] = {.refusal = CM1E_ERROR_AXIS_NOT_POWERED},
    [CM1E_AXIS_STANDSTILL] = {.next = CM1E_AXIS_STANDSTILL},
    [CM1E_AXIS_HOMING] = {.refusal = CM1E_ERROR_AXIS_HOMING},
    [CM1E_AXIS_DISCRETE_MOTION] = {.next = CM1E_AXIS_DISCRETE_MOTION},
    [CM1E_AXIS_CONTINUOUS_MOTION] = {.next = CM1E_AXIS_DISCRETE_MOTION},
    [CM1E_AXIS_SYNCHRONIZED_MOTION] = {.next = CM1E_AXIS_DISCRETE_MOTION},
    [CM1E_AXIS_STOPPING] = {.refusal = CM1E_ERROR_AXIS_STOPPING},
    [CM1E_AXIS_ERROR_STOP] = {.refusal = CM1E_ERROR_AXIS_ERROR_STOP},
};
static const block_rule_t rules_stop[CM1E_AXIS_STATE_COUNT] = {
    [CM1E_AXIS_DISABLED] = {.refusal = CM1E_ERROR_AXIS_NOT_POWERED},
    [CM1E_AXIS_STANDSTILL] = {.next = CM1E_AXIS_STOPPING},
    [CM1E_AXIS_HOMING] = {.next = CM1E_AXIS_STOPPING},
    [CM1E_AXIS_DISCRETE_MOTION] = {.next = CM1E_AXIS_STOPPING},
    [CM1E_AXIS_CONTINUOUS_MOTION] = {.next = CM1E_AXIS_STOPPING},
    [CM1E_AXIS_SYNCHRONIZED_MOTION] = {.next = CM1E_AXIS_STOPPING},
    [CM1E_AXIS_STOPPING] = {.refusal = CM1E_ERROR_AXIS_STOPPING},
    [CM1E_AXIS_ERROR_STOP] = {.refusal = CM1E_ERROR_AXIS_ERROR_STOP},
};
static const block_rule_t rules_home[CM1E_AXIS_STATE_COUNT] = {
    [CM1E_AXIS_DISABLED] = {.refusal = CM1E_ERROR_AXIS_NOT_POWERED},
    [CM1E_AXIS_STANDSTILL] = {.next = CM1E_AXIS_HOMING},
    [CM1E_AXIS_HOMING] = {.refusal = CM1E_ERROR_AXIS_HOMING},
    [CM1E_AXIS_DISCRETE_MOTION] = {.refusal = CM1E_ERROR_AXIS_STATE},
    [CM1E_AXIS_CONTINUOUS_MOTION] = {.refusal = CM1E_ERROR_AXIS_STATE},
    [CM1E_AXIS_SYNCHRONIZED_MOTION] = {.refusal = CM1E_ERROR_AXIS_STATE},
    [CM1E_AXIS_STOPPING] = {.refusal = CM1E_ERROR_AXIS_STOPPING},
    [CM1E_AXIS_ERROR_STOP] = {.refusal = CM1E_ERROR_AXIS_ERROR_STOP},
};
static const block_rule_t rules_step[CM1E_AXIS_STATE_COUNT] = {
    [CM1E_AXIS_DISABLED] = {.refusal = CM1E_ERROR_AXIS_NOT_POWERED},
    [CM1E_AXIS_STANDSTILL] = {.next = CM1E_AXIS_HOMING},
    [CM1E_AXIS_HOMING] = {.next = CM1E_AXIS_HOMING},
    [CM1E_AXIS_DISCRETE_MOTION] = {.refusal = CM1E_ERROR_AXIS_STATE},
    [CM1E_AXIS_CONTINUOUS_MOTION] = {.refusal = CM1E_ERROR_AXIS_STATE},
    [CM1E_AXIS_SYNCHRONIZED_MOTION] = {.refusal = CM1E_ERROR_AXIS_STATE},
    [CM1E_AXIS_STOPPING] = {.refusal = CM1E_ERROR_AXIS_STOPPING},
    [CM1E_AXIS_ERROR_STOP] = {.refusal = CM1E_ERROR_AXIS_ERROR_STOP},
};
static const block_rule_t rules_direct[CM1E_AXIS_STATE_COUNT] = {
    [CM1E_AXIS_DISABLED] = {.refusal = CM1E_ERROR_AXIS_NOT_POWERED},
    [CM1E_AXIS_STANDSTILL] = {.next = CM1E_AXIS_STANDSTILL},
    [CM1E_AXIS_HOMING] = {.next = CM1E_AXIS_HOMING},
    [CM1E_AXIS_DISCRETE_MOTION] = {.refusal = CM1E_ERROR_AXIS_STATE},
    [CM1E_AXIS_CONTINUOUS_MOTION] = {.refusal = CM1E_ERROR_AXIS_STATE},
    [CM1E_AXIS_SYNCHRONIZED_MOTION] = {.refusal = CM1E_ERROR_AXIS_STATE},
    [CM1E_AXIS_STOPPING] = {.refusal = CM1E_ERROR_AXIS_STOPPING},
    [CM1E_AXIS_ERROR_STOP] = {.refusal = CM1E_ERROR_AXIS_ERROR_STOP},
};
static const block_rule_t rules_finish[CM1E_AXIS_STATE_COUNT] = {
    [CM1E_AXIS_DISABLED] = {.refusal = CM1E_ERROR_AXIS_NOT_POWERED},
    [CM1E_AXIS_STANDSTILL] = {.refusal = CM1E_ERROR_AXIS_STATE},
    [CM1E_AXIS_HOMING] = {.next = CM1E_AXIS_HOMING},
    [CM1E_AXIS_DISCRETE_MOTION] = {.refusal = CM1E_ERROR_AXIS_STATE},
    [CM1E_AXIS_CONTINUOUS_MOTION] = {.refusal = CM1E_ERROR_AXIS_STATE},
    [CM1E_AXIS_SYNCHRONIZED_MOTION] = {.refusal = CM1E_ERROR_AXIS_STATE},
    [CM1E_AXIS_STOPPING] = {.refusal = CM1E_ERROR_AXIS_STOPPING},
    [CM1E_AXIS_ERROR_STOP] = {.refusal = CM1E_ERROR_AXIS_ERROR_STOP},
};
static const block_rule_t rules_no_such_signal[CM1E_AXIS_STATE_COUNT] = {
    [CM1E_AXIS_DISABLED] = {.refusal = CM1E_ERROR_AXIS_NO_SUCH_SIGNAL},
    [CM1E_AXIS_STANDSTILL] = {.refusal = CM1E_ERROR_AXIS_NO_SUCH_SIGNAL},
    [CM1E_AXIS_HOMING] = {.refusal = CM1E_ERROR_AXIS_NO_SUCH_SIGNAL},
    [CM1E_AXIS_DISCRETE_MOTION] = {.refusal = CM1E_ERROR_AXIS_NO_SUCH_SIGNAL},
    [CM1E_AXIS_CONTINUOUS_MOTION] = {.refusal = CM1E_ERROR_AXIS_NO_SUCH_SIGNAL},
    [CM1E_AXIS_SYNCHRONIZED_MOTION] = {.refusal = CM1E_ERROR_AXIS_NO_SUCH_SIGNAL},
    [CM1E_AXIS_STOPPING] = {.refusal = CM1E_ERROR_AXIS_NO_SUCH_SIGNAL},
    [CM1E_AXIS_ERROR_STOP] = {.refusal = CM1E_ERROR_AXIS_NO_SUCH_SIGNAL},
};
static const block_rule_t rules_superimposed[CM1E_AXIS_STATE_COUNT] = {
    [CM1E_AXIS_DISABLED] = {.refusal = CM1E_ERROR_AXIS_NOT_POWERED},
    [CM1E_AXIS_STANDSTILL] = {.next = CM1E_AXIS_DISCRETE_MOTION},
    [CM1E_AXIS_HOMING] = {.refusal = CM1E_ERROR_AXIS_HOMING},
    [CM1E_AXIS_DISCRETE_MOTION] = {.next = CM1E_AXIS_DISCRETE_MOTION},
    [CM1E_AXIS_CONTINUOUS_MOTION] = {.next = CM1E_AXIS_CONTINUOUS_MOTION},
    [CM1E_AXIS_SYNCHRONIZED_MOTION] = {.next = CM1E_AXIS_SYNCHRONIZED_MOTION},
    [CM1E_AXIS_STOPPING] = {.refusal = CM1E_ERROR_AXIS_STOPPING},
    [CM1E_AXIS_ERROR_STOP] = {.refusal = CM1E_ERROR_AXIS_ERROR_STOP},
};
static const block_rule_t rules_halt_superimposed[CM1E_AXIS_STATE_COUNT] = {
    [CM1E_AXIS_DISABLED] = {.refusal = CM1E_ERROR_AXIS_NOT_POWERED},
    [CM1E_AXIS_STANDSTILL] = {.next = CM1E_AXIS_STANDSTILL},
    [CM1E_AXIS_HOMING] = {.refusal = CM1E_ERROR_AXIS_HOMING},
    [CM1E_AXIS_DISCRETE_MOTION] = {.next = CM1E_AXIS_DISCRETE_MOTION},
    [CM1E_AXIS_CONTINUOUS_MOTION] = {.next = CM1E_AXIS_CONTINUOUS_MOTION},
    [CM1E_AXIS_SYNCHRONIZED_MOTION] = {.next = CM1E_AXIS_SYNCHRONIZED_MOTION},
    [CM1E_AXIS_STOPPING] = {.refusal = CM1E_ERROR_AXIS_STOPPING},
    [CM1E_AXIS_ERROR_STOP] = {.refusal = CM1E_ERROR_AXIS_ERROR_STOP},
};
static const block_rule_t rules_couple[CM1E_AXIS_STATE_COUNT] = {
    [CM1E_AXIS_DISABLED] = {.refusal = CM1E_ERROR_AXIS_NOT_POWERED},
    [CM1E_AXIS_STANDSTILL] = {.next = CM1E_AXIS_SYNCHRONIZED_MOTION},
    [CM1E_AXIS_HOMING] = {.refusal = CM1E_ERROR_AXIS_HOMING},
    [CM1E_AXIS_DISCRETE_MOTION] = {.next = CM1E_AXIS_SYNCHRONIZED_MOTION},
    [CM1E_AXIS_CONTINUOUS_MOTION] = {.next = CM1E_AXIS_SYNCHRONIZED_MOTION},
    [CM1E_AXIS_SYNCHRONIZED_MOTION] = {.next = CM1E_AXIS_SYNCHRONIZED_MOTION},
    [CM1E_AXIS_STOPPING] = {.refusal = CM1E_ERROR_AXIS_STOPPING},
    [CM1E_AXIS_ERROR_STOP] = {.refusal = CM1E_ERROR_AXIS_ERROR_STOP},
};
static const block_rule_t rules_follow_position[CM1E_AXIS_STATE_COUNT] = {
    [CM1E_AXIS_DISABLED] = {.refusal = CM1E_ERROR_AXIS_NOT_POWERED},
    [CM1E_AXIS_STANDSTILL] = {.next = CM1E_AXIS_SYNCHRONIZED_MOTION},
    [CM1E_AXIS_HOMING] = {.refusal = CM1E_ERROR_AXIS_HOMING},
    [CM1E_AXIS_DISCRETE_MOTION] = {.refusal = CM1E_ERROR_AXIS_STATE},
    [CM1E_AXIS_CONTINUOUS_MOTION] = {.refusal = CM1E_ERROR_AXIS_STATE},
    [CM1E_AXIS_SYNCHRONIZED_MOTION] = {.refusal = CM1E_ERROR_AXIS_STATE},
    [CM1E_AXIS_STOPPING] = {.refusal = CM1E_ERROR_AXIS_STOPPING},
    [CM1E_AXIS_ERROR_STOP] = {.refusal = CM1E_ERROR_AXIS_ERROR_STOP},
};
static const block_rule_t rules_phasing[CM1E_AXIS_STATE_COUNT] = {
    [CM1E_AXIS_DISABLED] = {.refusal = CM1E_ERROR_AXIS_NOT_POWERED},
    [CM1E_AXIS_STANDSTILL] = {.refusal = CM1E_ERROR_AXIS_NOT_COUPLED},
    [CM1E_AXIS_HOMING] = {.refusal = CM1E_ERROR_AXIS_HOMING},
    [CM1E_AXIS_DISCRETE_MOTION] = {.refusal = CM1E_ERROR_AXIS_NOT_COUPLED},
    [CM1E_AXIS_CONTINUOUS_MOTION] = {.refusal = CM1E_ERROR_AXIS_NOT_COUPLED},
    [CM1E_AXIS_SYNCHRONIZED_MOTION] = {.next = CM1E_AXIS_SYNCHRONIZED_MOTION},
    [CM1E_AXIS_STOPPING] = {.refusal = CM1E_ERROR_AXIS_STOPPING},
    [CM1E_AXIS_ERROR_STOP] = {.refusal = CM1E_ERROR_AXIS_ERROR_STOP},
};
static const block_rule_t rules_decouple[CM1E_AXIS_STATE_COUNT] = {
    [CM1E_AXIS_DISABLED] = {.refusal = CM1E_ERROR_AXIS_NOT_POWERED},
    [CM1E_AXIS_STANDSTILL] = {.refusal = CM1E_ERROR_AXIS_NOT_COUPLED},
    [CM1E_AXIS_HOMING] = {.refusal = CM1E_ERROR_AXIS_HOMING},
    [CM1E_AXIS_DISCRETE_MOTION] = {.refusal = CM1E_ERROR_AXIS_NOT_COUPLED},
    [CM1E_AXIS_CONTINUOUS_MOTION] = {.refusal = CM1E_ERROR_AXIS_NOT_COUPLED},
    [CM1E_AXIS_SYNCHRONIZED_MOTION] = {.next = CM1E_AXIS_CONTINUOUS_MOTION},
    [CM1E_AXIS_STOPPING] = {.refusal = CM1E_ERROR_AXIS_STOPPING},
    [CM1E_AXIS_ERROR_STOP] = {.refusal = CM1E_ERROR_AXIS_ERROR_STOP},
};
static const block_rule_t rules_unsupported[CM1E_AXIS_STATE_COUNT] = {
    [CM1E_AXIS_DISABLED] = {.refusal = CM1E_ERROR_UNSUPPORTED},
    [CM1E_AXIS_STANDSTILL] = {.refusal = CM1E_ERROR_UNSUPPORTED},
    [CM1E_AXIS_HOMING] = {.refusal = CM1E_ERROR_UNSUPPORTED},
    [CM1E_AXIS_DISCRETE_MOTION] = {.refusal = CM1E_ERROR_UNSUPPORTED},
    [CM1E_AXIS_CONTINUOUS_MOTION] = {.refusal = CM1E_ERROR_UNSUPPORTED},
    [CM1E_AXIS_SYNCHRONIZED_MOTION] = {.refusal = CM1E_ERROR_UNSUPPORTED},
    [CM1E_AXIS_STOPPING] = {.refusal = CM1E_ERROR_UNSUPPORTED},
    [CM1E_AXIS_ERROR_STOP] = {.refusal = CM1E_ERROR_UNSUPPORTED},
};
static const block_rule_t rules_no_torque_mode[CM1E_AXIS_STATE_COUNT] = {
    [CM1E_AXIS_DISABLED] = {.refusal = CM1E_ERROR_AXIS_NO_TORQUE_MODE},
    [CM1E_AXIS_STANDSTILL] = {.refusal = CM1E_ERROR_AXIS_NO_TORQUE_MODE},
    [CM1E_AXIS_HOMING] = {.refusal = CM1E_ERROR_AXIS_NO_TORQUE_MODE},
    [CM1E_AXIS_DISCRETE_MOTION] = {.refusal = CM1E_ERROR_AXIS_NO_TORQUE_MODE},
    [CM1E_AXIS_CONTINUOUS_MOTION] = {.refusal = CM1E_ERROR_AXIS_NO_TORQUE_MODE},
    [CM1E_AXIS_SYNCHRONIZED_MOTION] = {.refusal = CM1E_ERROR_AXIS_NO_TORQUE_MODE},
    [CM1E_AXIS_STOPPING] = {.refusal = CM1E_ERROR_AXIS_NO_TORQUE_MODE},
    [CM1E_AXIS_ERROR_STOP] = {.refusal = CM1E_ERROR_AXIS_NO_TORQUE_MODE},
};
static const block_rule_t rules_any[CM1E_AXIS_STATE_COUNT] = {
    [CM1E_AXIS_DISABLED] = {.unchanged = true},
    [CM1E_AXIS_STANDSTILL] = {.unchanged = true},
    [CM1E_AXIS_HOMING] = {.unchanged = true},
    [CM1E_AXIS_DISCRETE_MOTION] = {.unchanged = true},
    [CM1E_AXIS_CONTINUOUS_MOTION] = {.unchanged = true},
    [CM1E_AXIS_SYNCHRONIZED_MOTION] = {.unchanged = true},
    [CM1E_AXIS_STOPPING] = {.unchanged = true},
    [CM1E_AXIS_ERROR_STOP] = {.unchanged = true},
};

static const block_member_t members_of_MC_Power[] = {
    MEMBER(MC_Power, Axis, IN_OUT, POINTER),
    MEMBER(MC_Power, Enable, INPUT, BOOL),
    MEMBER(MC_Power, EnablePositive, INPUT, BOOL),
    MEMBER(MC_Power, EnableNegative, INPUT, BOOL),
    MEMBER(MC_Power, Status, OUTPUT, BOOL),
    MEMBER(MC_Power, Valid, OUTPUT, BOOL),
    MEMBER(MC_Power, Error, OUTPUT, BOOL),
    MEMBER(MC_Power, ErrorID, OUTPUT, WORD),
};
static void call_MC_Power(void *fb) { MC_Power(fb); }
static const cm1e_error_t errors_of_MC_Power[] = {
    CM1E_ERROR_AXIS_SET_POINT_MISSING,
    CM1E_ERROR_AXIS_SET_POINT_LIMIT,
    CM1E_ERROR_AXIS_VIRTUAL,
    CM1E_ERROR_AXIS_COUPLED,
    CM1E_ERROR_AXIS_COUPLING_LIMIT,
    CM1E_ERROR_AXIS_MASTER_LOST,
    CM1E_ERROR_FB_SECOND_POWER,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_NOT_AT_REST,
    CM1E_ERROR_AXIS_OFFLINE,
    CM1E_ERROR_AXIS_HOMING_TIMEOUT,
    CM1E_ERROR_AXIS_HOMING_FAILED,
    CM1E_ERROR_AXIS_LAG,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_DRIVE_KEEPS_TORQUE,
    CM1E_ERROR_DRIVE_POSITION,
    CM1E_ERROR_DRIVE_MODE_LOST,
    CM1E_ERROR_DRIVE_MODE_TIMEOUT,
    CM1E_ERROR_DRIVE_ENABLE_TIMEOUT,
    CM1E_ERROR_DRIVE_ENABLE_LOST,
    CM1E_ERROR_DRIVE_POWER,
    CM1E_ERROR_DRIVE_FAULT,
    CM1E_ERROR_BUS_WORKING_COUNTER,
    CM1E_ERROR_BUS_LOST,
    CM1E_ERROR_BUS_STATE,
    CM1E_ERROR_PROGRAM,
    CM1E_OK,
};
static const block_member_t members_of_MC_Home[] = {
    MEMBER(MC_Home, Axis, IN_OUT, POINTER),
    MEMBER(MC_Home, Execute, INPUT, BOOL),
    MEMBER(MC_Home, Position, INPUT, LREAL),
    MEMBER(MC_Home, BufferMode, INPUT, ENUM),
    MEMBER(MC_Home, Done, OUTPUT, BOOL),
    MEMBER(MC_Home, Busy, OUTPUT, BOOL),
    MEMBER(MC_Home, Active, OUTPUT, BOOL),
    MEMBER(MC_Home, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_Home, Error, OUTPUT, BOOL),
    MEMBER(MC_Home, ErrorID, OUTPUT, WORD),
    MEMBER(MC_Home, Parameters, INPUT, POINTER),
};
static void call_MC_Home(void *fb) { MC_Home(fb); }
static const cm1e_error_t errors_of_MC_Home[] = {
    CM1E_ERROR_AXIS_VIRTUAL,
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_NOT_IN_POSITION,
    CM1E_ERROR_AXIS_HOMING_PARAMETER,
    CM1E_ERROR_AXIS_HOMING_METHOD,
    CM1E_ERROR_AXIS_HOMING_TIMEOUT,
    CM1E_ERROR_AXIS_HOMING_FAILED,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_AXIS_STATE,
    CM1E_ERROR_DRIVE_MODE_TIMEOUT,
    CM1E_ERROR_SDO_ABORT,
    CM1E_ERROR_BUS_MAILBOX,
    CM1E_ERROR_BUSY,
    CM1E_ERROR_FULL,
    CM1E_ERROR_TIMEOUT,
    CM1E_OK,
};
static const block_member_t members_of_MC_Stop[] = {
    MEMBER(MC_Stop, Axis, IN_OUT, POINTER),
    MEMBER(MC_Stop, Execute, INPUT, BOOL),
    MEMBER(MC_Stop, Deceleration, INPUT, LREAL),
    MEMBER(MC_Stop, Jerk, INPUT, LREAL),
    MEMBER(MC_Stop, Done, OUTPUT, BOOL),
    MEMBER(MC_Stop, Busy, OUTPUT, BOOL),
    MEMBER(MC_Stop, Active, OUTPUT, BOOL),
    MEMBER(MC_Stop, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_Stop, Error, OUTPUT, BOOL),
    MEMBER(MC_Stop, ErrorID, OUTPUT, WORD),
};
static void call_MC_Stop(void *fb) { MC_Stop(fb); }
static const cm1e_error_t errors_of_MC_Stop[] = {
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_OK,
};
static const block_member_t members_of_MC_Halt[] = {
    MEMBER(MC_Halt, Axis, IN_OUT, POINTER),
    MEMBER(MC_Halt, Execute, INPUT, BOOL),
    MEMBER(MC_Halt, Deceleration, INPUT, LREAL),
    MEMBER(MC_Halt, Jerk, INPUT, LREAL),
    MEMBER(MC_Halt, BufferMode, INPUT, ENUM),
    MEMBER(MC_Halt, Done, OUTPUT, BOOL),
    MEMBER(MC_Halt, Busy, OUTPUT, BOOL),
    MEMBER(MC_Halt, Active, OUTPUT, BOOL),
    MEMBER(MC_Halt, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_Halt, Error, OUTPUT, BOOL),
    MEMBER(MC_Halt, ErrorID, OUTPUT, WORD),
};
static void call_MC_Halt(void *fb) { MC_Halt(fb); }
static const cm1e_error_t errors_of_MC_Halt[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_MoveAbsolute[] = {
    MEMBER(MC_MoveAbsolute, Axis, IN_OUT, POINTER),
    MEMBER(MC_MoveAbsolute, Execute, INPUT, BOOL),
    MEMBER(MC_MoveAbsolute, ContinuousUpdate, INPUT, BOOL),
    MEMBER(MC_MoveAbsolute, Position, INPUT, LREAL),
    MEMBER(MC_MoveAbsolute, Velocity, INPUT, LREAL),
    MEMBER(MC_MoveAbsolute, Acceleration, INPUT, LREAL),
    MEMBER(MC_MoveAbsolute, Deceleration, INPUT, LREAL),
    MEMBER(MC_MoveAbsolute, Jerk, INPUT, LREAL),
    MEMBER(MC_MoveAbsolute, Direction, INPUT, ENUM),
    MEMBER(MC_MoveAbsolute, BufferMode, INPUT, ENUM),
    MEMBER(MC_MoveAbsolute, Done, OUTPUT, BOOL),
    MEMBER(MC_MoveAbsolute, Busy, OUTPUT, BOOL),
    MEMBER(MC_MoveAbsolute, Active, OUTPUT, BOOL),
    MEMBER(MC_MoveAbsolute, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_MoveAbsolute, Error, OUTPUT, BOOL),
    MEMBER(MC_MoveAbsolute, ErrorID, OUTPUT, WORD),
};
static void call_MC_MoveAbsolute(void *fb) { MC_MoveAbsolute(fb); }
static const cm1e_error_t errors_of_MC_MoveAbsolute[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_NOT_IN_POSITION,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_DIRECTION,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_VELOCITY_RANGE,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_MoveRelative[] = {
    MEMBER(MC_MoveRelative, Axis, IN_OUT, POINTER),
    MEMBER(MC_MoveRelative, Execute, INPUT, BOOL),
    MEMBER(MC_MoveRelative, ContinuousUpdate, INPUT, BOOL),
    MEMBER(MC_MoveRelative, Distance, INPUT, LREAL),
    MEMBER(MC_MoveRelative, Velocity, INPUT, LREAL),
    MEMBER(MC_MoveRelative, Acceleration, INPUT, LREAL),
    MEMBER(MC_MoveRelative, Deceleration, INPUT, LREAL),
    MEMBER(MC_MoveRelative, Jerk, INPUT, LREAL),
    MEMBER(MC_MoveRelative, BufferMode, INPUT, ENUM),
    MEMBER(MC_MoveRelative, Done, OUTPUT, BOOL),
    MEMBER(MC_MoveRelative, Busy, OUTPUT, BOOL),
    MEMBER(MC_MoveRelative, Active, OUTPUT, BOOL),
    MEMBER(MC_MoveRelative, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_MoveRelative, Error, OUTPUT, BOOL),
    MEMBER(MC_MoveRelative, ErrorID, OUTPUT, WORD),
};
static void call_MC_MoveRelative(void *fb) { MC_MoveRelative(fb); }
static const cm1e_error_t errors_of_MC_MoveRelative[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_NOT_IN_POSITION,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_VELOCITY_RANGE,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_MoveAdditive[] = {
    MEMBER(MC_MoveAdditive, Axis, IN_OUT, POINTER),
    MEMBER(MC_MoveAdditive, Execute, INPUT, BOOL),
    MEMBER(MC_MoveAdditive, ContinuousUpdate, INPUT, BOOL),
    MEMBER(MC_MoveAdditive, Distance, INPUT, LREAL),
    MEMBER(MC_MoveAdditive, Velocity, INPUT, LREAL),
    MEMBER(MC_MoveAdditive, Acceleration, INPUT, LREAL),
    MEMBER(MC_MoveAdditive, Deceleration, INPUT, LREAL),
    MEMBER(MC_MoveAdditive, Jerk, INPUT, LREAL),
    MEMBER(MC_MoveAdditive, BufferMode, INPUT, ENUM),
    MEMBER(MC_MoveAdditive, Done, OUTPUT, BOOL),
    MEMBER(MC_MoveAdditive, Busy, OUTPUT, BOOL),
    MEMBER(MC_MoveAdditive, Active, OUTPUT, BOOL),
    MEMBER(MC_MoveAdditive, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_MoveAdditive, Error, OUTPUT, BOOL),
    MEMBER(MC_MoveAdditive, ErrorID, OUTPUT, WORD),
};
static void call_MC_MoveAdditive(void *fb) { MC_MoveAdditive(fb); }
static const cm1e_error_t errors_of_MC_MoveAdditive[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_NOT_IN_POSITION,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_VELOCITY_RANGE,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_MoveSuperimposed[] = {
    MEMBER(MC_MoveSuperimposed, Axis, IN_OUT, POINTER),
    MEMBER(MC_MoveSuperimposed, Execute, INPUT, BOOL),
    MEMBER(MC_MoveSuperimposed, ContinuousUpdate, INPUT, BOOL),
    MEMBER(MC_MoveSuperimposed, Distance, INPUT, LREAL),
    MEMBER(MC_MoveSuperimposed, VelocityDiff, INPUT, LREAL),
    MEMBER(MC_MoveSuperimposed, Acceleration, INPUT, LREAL),
    MEMBER(MC_MoveSuperimposed, Deceleration, INPUT, LREAL),
    MEMBER(MC_MoveSuperimposed, Jerk, INPUT, LREAL),
    MEMBER(MC_MoveSuperimposed, Done, OUTPUT, BOOL),
    MEMBER(MC_MoveSuperimposed, Busy, OUTPUT, BOOL),
    MEMBER(MC_MoveSuperimposed, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_MoveSuperimposed, Error, OUTPUT, BOOL),
    MEMBER(MC_MoveSuperimposed, ErrorID, OUTPUT, WORD),
    MEMBER(MC_MoveSuperimposed, CoveredDistance, OUTPUT, LREAL),
};
static void call_MC_MoveSuperimposed(void *fb) { MC_MoveSuperimposed(fb); }
static const cm1e_error_t errors_of_MC_MoveSuperimposed[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_VELOCITY_RANGE,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_AXIS_STATE,
    CM1E_OK,
};
static const block_member_t members_of_MC_HaltSuperimposed[] = {
    MEMBER(MC_HaltSuperimposed, Axis, IN_OUT, POINTER),
    MEMBER(MC_HaltSuperimposed, Execute, INPUT, BOOL),
    MEMBER(MC_HaltSuperimposed, Deceleration, INPUT, LREAL),
    MEMBER(MC_HaltSuperimposed, Jerk, INPUT, LREAL),
    MEMBER(MC_HaltSuperimposed, Done, OUTPUT, BOOL),
    MEMBER(MC_HaltSuperimposed, Busy, OUTPUT, BOOL),
    MEMBER(MC_HaltSuperimposed, Active, OUTPUT, BOOL),
    MEMBER(MC_HaltSuperimposed, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_HaltSuperimposed, Error, OUTPUT, BOOL),
    MEMBER(MC_HaltSuperimposed, ErrorID, OUTPUT, WORD),
};
static void call_MC_HaltSuperimposed(void *fb) { MC_HaltSuperimposed(fb); }
static const cm1e_error_t errors_of_MC_HaltSuperimposed[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_OK,
};
static const block_member_t members_of_MC_MoveVelocity[] = {
    MEMBER(MC_MoveVelocity, Axis, IN_OUT, POINTER),
    MEMBER(MC_MoveVelocity, Execute, INPUT, BOOL),
    MEMBER(MC_MoveVelocity, ContinuousUpdate, INPUT, BOOL),
    MEMBER(MC_MoveVelocity, Velocity, INPUT, LREAL),
    MEMBER(MC_MoveVelocity, Acceleration, INPUT, LREAL),
    MEMBER(MC_MoveVelocity, Deceleration, INPUT, LREAL),
    MEMBER(MC_MoveVelocity, Jerk, INPUT, LREAL),
    MEMBER(MC_MoveVelocity, Direction, INPUT, ENUM),
    MEMBER(MC_MoveVelocity, BufferMode, INPUT, ENUM),
    MEMBER(MC_MoveVelocity, InVelocity, OUTPUT, BOOL),
    MEMBER(MC_MoveVelocity, Busy, OUTPUT, BOOL),
    MEMBER(MC_MoveVelocity, Active, OUTPUT, BOOL),
    MEMBER(MC_MoveVelocity, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_MoveVelocity, Error, OUTPUT, BOOL),
    MEMBER(MC_MoveVelocity, ErrorID, OUTPUT, WORD),
};
static void call_MC_MoveVelocity(void *fb) { MC_MoveVelocity(fb); }
static const cm1e_error_t errors_of_MC_MoveVelocity[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_DIRECTION,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_VELOCITY_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_MoveContinuousAbsolute[] = {
    MEMBER(MC_MoveContinuousAbsolute, Axis, IN_OUT, POINTER),
    MEMBER(MC_MoveContinuousAbsolute, Execute, INPUT, BOOL),
    MEMBER(MC_MoveContinuousAbsolute, ContinuousUpdate, INPUT, BOOL),
    MEMBER(MC_MoveContinuousAbsolute, Position, INPUT, LREAL),
    MEMBER(MC_MoveContinuousAbsolute, EndVelocity, INPUT, LREAL),
    MEMBER(MC_MoveContinuousAbsolute, Velocity, INPUT, LREAL),
    MEMBER(MC_MoveContinuousAbsolute, Acceleration, INPUT, LREAL),
    MEMBER(MC_MoveContinuousAbsolute, Deceleration, INPUT, LREAL),
    MEMBER(MC_MoveContinuousAbsolute, Jerk, INPUT, LREAL),
    MEMBER(MC_MoveContinuousAbsolute, Direction, INPUT, ENUM),
    MEMBER(MC_MoveContinuousAbsolute, BufferMode, INPUT, ENUM),
    MEMBER(MC_MoveContinuousAbsolute, InEndVelocity, OUTPUT, BOOL),
    MEMBER(MC_MoveContinuousAbsolute, Busy, OUTPUT, BOOL),
    MEMBER(MC_MoveContinuousAbsolute, Active, OUTPUT, BOOL),
    MEMBER(MC_MoveContinuousAbsolute, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_MoveContinuousAbsolute, Error, OUTPUT, BOOL),
    MEMBER(MC_MoveContinuousAbsolute, ErrorID, OUTPUT, WORD),
};
static void call_MC_MoveContinuousAbsolute(void *fb) { MC_MoveContinuousAbsolute(fb); }
static const cm1e_error_t errors_of_MC_MoveContinuousAbsolute[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_DIRECTION,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_VELOCITY_RANGE,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_MoveContinuousRelative[] = {
    MEMBER(MC_MoveContinuousRelative, Axis, IN_OUT, POINTER),
    MEMBER(MC_MoveContinuousRelative, Execute, INPUT, BOOL),
    MEMBER(MC_MoveContinuousRelative, ContinuousUpdate, INPUT, BOOL),
    MEMBER(MC_MoveContinuousRelative, Distance, INPUT, LREAL),
    MEMBER(MC_MoveContinuousRelative, EndVelocity, INPUT, LREAL),
    MEMBER(MC_MoveContinuousRelative, Velocity, INPUT, LREAL),
    MEMBER(MC_MoveContinuousRelative, Acceleration, INPUT, LREAL),
    MEMBER(MC_MoveContinuousRelative, Deceleration, INPUT, LREAL),
    MEMBER(MC_MoveContinuousRelative, Jerk, INPUT, LREAL),
    MEMBER(MC_MoveContinuousRelative, BufferMode, INPUT, ENUM),
    MEMBER(MC_MoveContinuousRelative, InEndVelocity, OUTPUT, BOOL),
    MEMBER(MC_MoveContinuousRelative, Busy, OUTPUT, BOOL),
    MEMBER(MC_MoveContinuousRelative, Active, OUTPUT, BOOL),
    MEMBER(MC_MoveContinuousRelative, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_MoveContinuousRelative, Error, OUTPUT, BOOL),
    MEMBER(MC_MoveContinuousRelative, ErrorID, OUTPUT, WORD),
};
static void call_MC_MoveContinuousRelative(void *fb) { MC_MoveContinuousRelative(fb); }
static const cm1e_error_t errors_of_MC_MoveContinuousRelative[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_VELOCITY_RANGE,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_TorqueControl[] = {
    MEMBER(MC_TorqueControl, Axis, IN_OUT, POINTER),
    MEMBER(MC_TorqueControl, Execute, INPUT, BOOL),
    MEMBER(MC_TorqueControl, ContinuousUpdate, INPUT, BOOL),
    MEMBER(MC_TorqueControl, Torque, INPUT, LREAL),
    MEMBER(MC_TorqueControl, TorqueRamp, INPUT, LREAL),
    MEMBER(MC_TorqueControl, Velocity, INPUT, LREAL),
    MEMBER(MC_TorqueControl, Acceleration, INPUT, LREAL),
    MEMBER(MC_TorqueControl, Deceleration, INPUT, LREAL),
    MEMBER(MC_TorqueControl, Jerk, INPUT, LREAL),
    MEMBER(MC_TorqueControl, Direction, INPUT, ENUM),
    MEMBER(MC_TorqueControl, BufferMode, INPUT, ENUM),
    MEMBER(MC_TorqueControl, InTorque, OUTPUT, BOOL),
    MEMBER(MC_TorqueControl, Busy, OUTPUT, BOOL),
    MEMBER(MC_TorqueControl, Active, OUTPUT, BOOL),
    MEMBER(MC_TorqueControl, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_TorqueControl, Error, OUTPUT, BOOL),
    MEMBER(MC_TorqueControl, ErrorID, OUTPUT, WORD),
};
static void call_MC_TorqueControl(void *fb) { MC_TorqueControl(fb); }
static const cm1e_error_t errors_of_MC_TorqueControl[] = {
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_NO_TORQUE_MODE,
    CM1E_OK,
};
static const block_member_t members_of_MC_PositionProfile[] = {
    MEMBER(MC_PositionProfile, Axis, IN_OUT, POINTER),
    MEMBER(MC_PositionProfile, TimePosition, IN_OUT, POINTER),
    MEMBER(MC_PositionProfile, Execute, INPUT, BOOL),
    MEMBER(MC_PositionProfile, ContinuousUpdate, INPUT, BOOL),
    MEMBER(MC_PositionProfile, TimeScale, INPUT, LREAL),
    MEMBER(MC_PositionProfile, PositionScale, INPUT, LREAL),
    MEMBER(MC_PositionProfile, Offset, INPUT, LREAL),
    MEMBER(MC_PositionProfile, BufferMode, INPUT, ENUM),
    MEMBER(MC_PositionProfile, Done, OUTPUT, BOOL),
    MEMBER(MC_PositionProfile, Busy, OUTPUT, BOOL),
    MEMBER(MC_PositionProfile, Active, OUTPUT, BOOL),
    MEMBER(MC_PositionProfile, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_PositionProfile, Error, OUTPUT, BOOL),
    MEMBER(MC_PositionProfile, ErrorID, OUTPUT, WORD),
};
static void call_MC_PositionProfile(void *fb) { MC_PositionProfile(fb); }
static const cm1e_error_t errors_of_MC_PositionProfile[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_AXIS_NO_TABLES,
    CM1E_ERROR_AXIS_TABLE_LATE,
    CM1E_ERROR_AXIS_TABLE,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_VELOCITY_RANGE,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_UNSUPPORTED,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_VelocityProfile[] = {
    MEMBER(MC_VelocityProfile, Axis, IN_OUT, POINTER),
    MEMBER(MC_VelocityProfile, TimeVelocity, IN_OUT, POINTER),
    MEMBER(MC_VelocityProfile, Execute, INPUT, BOOL),
    MEMBER(MC_VelocityProfile, ContinuousUpdate, INPUT, BOOL),
    MEMBER(MC_VelocityProfile, TimeScale, INPUT, LREAL),
    MEMBER(MC_VelocityProfile, VelocityScale, INPUT, LREAL),
    MEMBER(MC_VelocityProfile, Offset, INPUT, LREAL),
    MEMBER(MC_VelocityProfile, BufferMode, INPUT, ENUM),
    MEMBER(MC_VelocityProfile, ProfileCompleted, OUTPUT, BOOL),
    MEMBER(MC_VelocityProfile, Busy, OUTPUT, BOOL),
    MEMBER(MC_VelocityProfile, Active, OUTPUT, BOOL),
    MEMBER(MC_VelocityProfile, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_VelocityProfile, Error, OUTPUT, BOOL),
    MEMBER(MC_VelocityProfile, ErrorID, OUTPUT, WORD),
};
static void call_MC_VelocityProfile(void *fb) { MC_VelocityProfile(fb); }
static const cm1e_error_t errors_of_MC_VelocityProfile[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_AXIS_NO_TABLES,
    CM1E_ERROR_AXIS_TABLE_LATE,
    CM1E_ERROR_AXIS_TABLE,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_VELOCITY_RANGE,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_UNSUPPORTED,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_AccelerationProfile[] = {
    MEMBER(MC_AccelerationProfile, Axis, IN_OUT, POINTER),
    MEMBER(MC_AccelerationProfile, TimeAcceleration, IN_OUT, POINTER),
    MEMBER(MC_AccelerationProfile, Execute, INPUT, BOOL),
    MEMBER(MC_AccelerationProfile, ContinuousUpdate, INPUT, BOOL),
    MEMBER(MC_AccelerationProfile, TimeScale, INPUT, LREAL),
    MEMBER(MC_AccelerationProfile, AccelerationScale, INPUT, LREAL),
    MEMBER(MC_AccelerationProfile, Offset, INPUT, LREAL),
    MEMBER(MC_AccelerationProfile, BufferMode, INPUT, ENUM),
    MEMBER(MC_AccelerationProfile, ProfileCompleted, OUTPUT, BOOL),
    MEMBER(MC_AccelerationProfile, Busy, OUTPUT, BOOL),
    MEMBER(MC_AccelerationProfile, Active, OUTPUT, BOOL),
    MEMBER(MC_AccelerationProfile, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_AccelerationProfile, Error, OUTPUT, BOOL),
    MEMBER(MC_AccelerationProfile, ErrorID, OUTPUT, WORD),
};
static void call_MC_AccelerationProfile(void *fb) { MC_AccelerationProfile(fb); }
static const cm1e_error_t errors_of_MC_AccelerationProfile[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_AXIS_NO_TABLES,
    CM1E_ERROR_AXIS_TABLE_LATE,
    CM1E_ERROR_AXIS_TABLE,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_VELOCITY_RANGE,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_UNSUPPORTED,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_Jog[] = {
    MEMBER(MC_Jog, Axis, IN_OUT, POINTER),
    MEMBER(MC_Jog, JogForward, INPUT, BOOL),
    MEMBER(MC_Jog, JogBackwards, INPUT, BOOL),
    MEMBER(MC_Jog, Mode, INPUT, ENUM),
    MEMBER(MC_Jog, Position, INPUT, LREAL),
    MEMBER(MC_Jog, Velocity, INPUT, LREAL),
    MEMBER(MC_Jog, Acceleration, INPUT, LREAL),
    MEMBER(MC_Jog, Deceleration, INPUT, LREAL),
    MEMBER(MC_Jog, Jerk, INPUT, LREAL),
    MEMBER(MC_Jog, Done, OUTPUT, BOOL),
    MEMBER(MC_Jog, Busy, OUTPUT, BOOL),
    MEMBER(MC_Jog, Active, OUTPUT, BOOL),
    MEMBER(MC_Jog, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_Jog, Error, OUTPUT, BOOL),
    MEMBER(MC_Jog, ErrorID, OUTPUT, WORD),
};
static void call_MC_Jog(void *fb) { MC_Jog(fb); }
static const cm1e_error_t errors_of_MC_Jog[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_VELOCITY_RANGE,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_INVALID_ARGUMENT,
    CM1E_OK,
};
static const block_member_t members_of_CM_FollowPosition[] = {
    MEMBER(CM_FollowPosition, Axis, IN_OUT, POINTER),
    MEMBER(CM_FollowPosition, Execute, INPUT, BOOL),
    MEMBER(CM_FollowPosition, Position, INPUT, LREAL),
    MEMBER(CM_FollowPosition, Busy, OUTPUT, BOOL),
    MEMBER(CM_FollowPosition, Active, OUTPUT, BOOL),
    MEMBER(CM_FollowPosition, CommandAborted, OUTPUT, BOOL),
    MEMBER(CM_FollowPosition, Error, OUTPUT, BOOL),
    MEMBER(CM_FollowPosition, ErrorID, OUTPUT, WORD),
};
static void call_CM_FollowPosition(void *fb) { CM_FollowPosition(fb); }
static const cm1e_error_t errors_of_CM_FollowPosition[] = {
    CM1E_ERROR_AXIS_SET_POINT_MISSING,
    CM1E_ERROR_AXIS_SET_POINT_LIMIT,
    CM1E_ERROR_AXIS_SET_POINT_JUMP,
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_AXIS_STATE,
    CM1E_OK,
};
static const block_member_t members_of_MC_CamTableSelect[] = {
    MEMBER(MC_CamTableSelect, Master, IN_OUT, POINTER),
    MEMBER(MC_CamTableSelect, Slave, IN_OUT, POINTER),
    MEMBER(MC_CamTableSelect, CamTable, IN_OUT, POINTER),
    MEMBER(MC_CamTableSelect, Execute, INPUT, BOOL),
    MEMBER(MC_CamTableSelect, Periodic, INPUT, BOOL),
    MEMBER(MC_CamTableSelect, MasterAbsolute, INPUT, BOOL),
    MEMBER(MC_CamTableSelect, SlaveAbsolute, INPUT, BOOL),
    MEMBER(MC_CamTableSelect, ExecutionMode, INPUT, ENUM),
    MEMBER(MC_CamTableSelect, Done, OUTPUT, BOOL),
    MEMBER(MC_CamTableSelect, Busy, OUTPUT, BOOL),
    MEMBER(MC_CamTableSelect, Error, OUTPUT, BOOL),
    MEMBER(MC_CamTableSelect, ErrorID, OUTPUT, WORD),
    MEMBER(MC_CamTableSelect, CamTableID, OUTPUT, UDINT),
};
static void call_MC_CamTableSelect(void *fb) { MC_CamTableSelect(fb); }
static const cm1e_error_t errors_of_MC_CamTableSelect[] = {
    CM1E_ERROR_AXIS_CAM_TABLE,
    CM1E_ERROR_AXIS_NO_COUPLINGS,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_UNSUPPORTED,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_CamIn[] = {
    MEMBER(MC_CamIn, Master, IN_OUT, POINTER),
    MEMBER(MC_CamIn, Slave, IN_OUT, POINTER),
    MEMBER(MC_CamIn, Execute, INPUT, BOOL),
    MEMBER(MC_CamIn, ContinuousUpdate, INPUT, BOOL),
    MEMBER(MC_CamIn, MasterOffset, INPUT, LREAL),
    MEMBER(MC_CamIn, SlaveOffset, INPUT, LREAL),
    MEMBER(MC_CamIn, MasterScaling, INPUT, LREAL),
    MEMBER(MC_CamIn, SlaveScaling, INPUT, LREAL),
    MEMBER(MC_CamIn, MasterStartDistance, INPUT, LREAL),
    MEMBER(MC_CamIn, MasterSyncPosition, INPUT, LREAL),
    MEMBER(MC_CamIn, StartMode, INPUT, ENUM),
    MEMBER(MC_CamIn, MasterValueSource, INPUT, ENUM),
    MEMBER(MC_CamIn, CamTableID, INPUT, UDINT),
    MEMBER(MC_CamIn, BufferMode, INPUT, ENUM),
    MEMBER(MC_CamIn, InSync, OUTPUT, BOOL),
    MEMBER(MC_CamIn, Busy, OUTPUT, BOOL),
    MEMBER(MC_CamIn, Active, OUTPUT, BOOL),
    MEMBER(MC_CamIn, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_CamIn, Error, OUTPUT, BOOL),
    MEMBER(MC_CamIn, ErrorID, OUTPUT, WORD),
    MEMBER(MC_CamIn, EndOfProfile, OUTPUT, BOOL),
};
static void call_MC_CamIn(void *fb) { MC_CamIn(fb); }
static const cm1e_error_t errors_of_MC_CamIn[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_AXIS_CAM_START,
    CM1E_ERROR_AXIS_CAM_ID,
    CM1E_ERROR_AXIS_SYNC_WAY,
    CM1E_ERROR_AXIS_RATIO,
    CM1E_ERROR_AXIS_COUPLING_LIMIT,
    CM1E_ERROR_AXIS_MASTER_LOST,
    CM1E_ERROR_AXIS_COUPLING_CYCLE,
    CM1E_ERROR_AXIS_MASTER,
    CM1E_ERROR_AXIS_NO_COUPLINGS,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_FULL,
    CM1E_ERROR_INVALID_ARGUMENT,
    CM1E_OK,
};
static const block_member_t members_of_MC_CamOut[] = {
    MEMBER(MC_CamOut, Slave, IN_OUT, POINTER),
    MEMBER(MC_CamOut, Execute, INPUT, BOOL),
    MEMBER(MC_CamOut, Done, OUTPUT, BOOL),
    MEMBER(MC_CamOut, Busy, OUTPUT, BOOL),
    MEMBER(MC_CamOut, Error, OUTPUT, BOOL),
    MEMBER(MC_CamOut, ErrorID, OUTPUT, WORD),
};
static void call_MC_CamOut(void *fb) { MC_CamOut(fb); }
static const cm1e_error_t errors_of_MC_CamOut[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_AXIS_NOT_COUPLED,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_CANCELLED,
    CM1E_OK,
};
static const block_member_t members_of_MC_GearIn[] = {
    MEMBER(MC_GearIn, Master, IN_OUT, POINTER),
    MEMBER(MC_GearIn, Slave, IN_OUT, POINTER),
    MEMBER(MC_GearIn, Execute, INPUT, BOOL),
    MEMBER(MC_GearIn, ContinuousUpdate, INPUT, BOOL),
    MEMBER(MC_GearIn, RatioNumerator, INPUT, DINT),
    MEMBER(MC_GearIn, RatioDenominator, INPUT, UDINT),
    MEMBER(MC_GearIn, MasterValueSource, INPUT, ENUM),
    MEMBER(MC_GearIn, Acceleration, INPUT, LREAL),
    MEMBER(MC_GearIn, Deceleration, INPUT, LREAL),
    MEMBER(MC_GearIn, Jerk, INPUT, LREAL),
    MEMBER(MC_GearIn, BufferMode, INPUT, ENUM),
    MEMBER(MC_GearIn, InGear, OUTPUT, BOOL),
    MEMBER(MC_GearIn, Busy, OUTPUT, BOOL),
    MEMBER(MC_GearIn, Active, OUTPUT, BOOL),
    MEMBER(MC_GearIn, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_GearIn, Error, OUTPUT, BOOL),
    MEMBER(MC_GearIn, ErrorID, OUTPUT, WORD),
};
static void call_MC_GearIn(void *fb) { MC_GearIn(fb); }
static const cm1e_error_t errors_of_MC_GearIn[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_AXIS_RATIO,
    CM1E_ERROR_AXIS_COUPLING_LIMIT,
    CM1E_ERROR_AXIS_MASTER_LOST,
    CM1E_ERROR_AXIS_COUPLING_CYCLE,
    CM1E_ERROR_AXIS_MASTER,
    CM1E_ERROR_AXIS_NO_COUPLINGS,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_FULL,
    CM1E_ERROR_INVALID_ARGUMENT,
    CM1E_OK,
};
static const block_member_t members_of_MC_GearOut[] = {
    MEMBER(MC_GearOut, Slave, IN_OUT, POINTER),
    MEMBER(MC_GearOut, Execute, INPUT, BOOL),
    MEMBER(MC_GearOut, Done, OUTPUT, BOOL),
    MEMBER(MC_GearOut, Busy, OUTPUT, BOOL),
    MEMBER(MC_GearOut, Error, OUTPUT, BOOL),
    MEMBER(MC_GearOut, ErrorID, OUTPUT, WORD),
};
static void call_MC_GearOut(void *fb) { MC_GearOut(fb); }
static const cm1e_error_t errors_of_MC_GearOut[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_AXIS_NOT_COUPLED,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_CANCELLED,
    CM1E_OK,
};
static const block_member_t members_of_MC_GearInPos[] = {
    MEMBER(MC_GearInPos, Master, IN_OUT, POINTER),
    MEMBER(MC_GearInPos, Slave, IN_OUT, POINTER),
    MEMBER(MC_GearInPos, Execute, INPUT, BOOL),
    MEMBER(MC_GearInPos, RatioNumerator, INPUT, DINT),
    MEMBER(MC_GearInPos, RatioDenominator, INPUT, UDINT),
    MEMBER(MC_GearInPos, MasterValueSource, INPUT, ENUM),
    MEMBER(MC_GearInPos, MasterSyncPosition, INPUT, LREAL),
    MEMBER(MC_GearInPos, SlaveSyncPosition, INPUT, LREAL),
    MEMBER(MC_GearInPos, SyncMode, INPUT, ENUM),
    MEMBER(MC_GearInPos, MasterStartDistance, INPUT, LREAL),
    MEMBER(MC_GearInPos, Velocity, INPUT, LREAL),
    MEMBER(MC_GearInPos, Acceleration, INPUT, LREAL),
    MEMBER(MC_GearInPos, Deceleration, INPUT, LREAL),
    MEMBER(MC_GearInPos, Jerk, INPUT, LREAL),
    MEMBER(MC_GearInPos, BufferMode, INPUT, ENUM),
    MEMBER(MC_GearInPos, StartSync, OUTPUT, BOOL),
    MEMBER(MC_GearInPos, InSync, OUTPUT, BOOL),
    MEMBER(MC_GearInPos, Busy, OUTPUT, BOOL),
    MEMBER(MC_GearInPos, Active, OUTPUT, BOOL),
    MEMBER(MC_GearInPos, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_GearInPos, Error, OUTPUT, BOOL),
    MEMBER(MC_GearInPos, ErrorID, OUTPUT, WORD),
};
static void call_MC_GearInPos(void *fb) { MC_GearInPos(fb); }
static const cm1e_error_t errors_of_MC_GearInPos[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_AXIS_SYNC_WAY,
    CM1E_ERROR_AXIS_RATIO,
    CM1E_ERROR_AXIS_COUPLING_LIMIT,
    CM1E_ERROR_AXIS_MASTER_LOST,
    CM1E_ERROR_AXIS_COUPLING_CYCLE,
    CM1E_ERROR_AXIS_MASTER,
    CM1E_ERROR_AXIS_NO_COUPLINGS,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_VELOCITY_RANGE,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_FULL,
    CM1E_ERROR_INVALID_ARGUMENT,
    CM1E_OK,
};
static const block_member_t members_of_MC_PhasingAbsolute[] = {
    MEMBER(MC_PhasingAbsolute, Master, IN_OUT, POINTER),
    MEMBER(MC_PhasingAbsolute, Slave, IN_OUT, POINTER),
    MEMBER(MC_PhasingAbsolute, Execute, INPUT, BOOL),
    MEMBER(MC_PhasingAbsolute, PhaseShift, INPUT, LREAL),
    MEMBER(MC_PhasingAbsolute, Velocity, INPUT, LREAL),
    MEMBER(MC_PhasingAbsolute, Acceleration, INPUT, LREAL),
    MEMBER(MC_PhasingAbsolute, Deceleration, INPUT, LREAL),
    MEMBER(MC_PhasingAbsolute, Jerk, INPUT, LREAL),
    MEMBER(MC_PhasingAbsolute, BufferMode, INPUT, ENUM),
    MEMBER(MC_PhasingAbsolute, Done, OUTPUT, BOOL),
    MEMBER(MC_PhasingAbsolute, Busy, OUTPUT, BOOL),
    MEMBER(MC_PhasingAbsolute, Active, OUTPUT, BOOL),
    MEMBER(MC_PhasingAbsolute, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_PhasingAbsolute, Error, OUTPUT, BOOL),
    MEMBER(MC_PhasingAbsolute, ErrorID, OUTPUT, WORD),
    MEMBER(MC_PhasingAbsolute, AbsolutePhaseShift, OUTPUT, LREAL),
};
static void call_MC_PhasingAbsolute(void *fb) { MC_PhasingAbsolute(fb); }
static const cm1e_error_t errors_of_MC_PhasingAbsolute[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_AXIS_NOT_COUPLED,
    CM1E_ERROR_AXIS_MASTER,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_VELOCITY_RANGE,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_PhasingRelative[] = {
    MEMBER(MC_PhasingRelative, Master, IN_OUT, POINTER),
    MEMBER(MC_PhasingRelative, Slave, IN_OUT, POINTER),
    MEMBER(MC_PhasingRelative, Execute, INPUT, BOOL),
    MEMBER(MC_PhasingRelative, PhaseShift, INPUT, LREAL),
    MEMBER(MC_PhasingRelative, Velocity, INPUT, LREAL),
    MEMBER(MC_PhasingRelative, Acceleration, INPUT, LREAL),
    MEMBER(MC_PhasingRelative, Deceleration, INPUT, LREAL),
    MEMBER(MC_PhasingRelative, Jerk, INPUT, LREAL),
    MEMBER(MC_PhasingRelative, BufferMode, INPUT, ENUM),
    MEMBER(MC_PhasingRelative, Done, OUTPUT, BOOL),
    MEMBER(MC_PhasingRelative, Busy, OUTPUT, BOOL),
    MEMBER(MC_PhasingRelative, Active, OUTPUT, BOOL),
    MEMBER(MC_PhasingRelative, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_PhasingRelative, Error, OUTPUT, BOOL),
    MEMBER(MC_PhasingRelative, ErrorID, OUTPUT, WORD),
    MEMBER(MC_PhasingRelative, CoveredPhaseShift, OUTPUT, LREAL),
};
static void call_MC_PhasingRelative(void *fb) { MC_PhasingRelative(fb); }
static const cm1e_error_t errors_of_MC_PhasingRelative[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_AXIS_NOT_COUPLED,
    CM1E_ERROR_AXIS_MASTER,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_VELOCITY_RANGE,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_CombineAxes[] = {
    MEMBER(MC_CombineAxes, Master1, IN_OUT, POINTER),
    MEMBER(MC_CombineAxes, Master2, IN_OUT, POINTER),
    MEMBER(MC_CombineAxes, Slave, IN_OUT, POINTER),
    MEMBER(MC_CombineAxes, Execute, INPUT, BOOL),
    MEMBER(MC_CombineAxes, ContinuousUpdate, INPUT, BOOL),
    MEMBER(MC_CombineAxes, CombineMode, INPUT, ENUM),
    MEMBER(MC_CombineAxes, GearRatioNumeratorM1, INPUT, DINT),
    MEMBER(MC_CombineAxes, GearRatioDenominatorM1, INPUT, DINT),
    MEMBER(MC_CombineAxes, GearRatioNumeratorM2, INPUT, DINT),
    MEMBER(MC_CombineAxes, GearRatioDenominatorM2, INPUT, DINT),
    MEMBER(MC_CombineAxes, MasterValueSourceM1, INPUT, ENUM),
    MEMBER(MC_CombineAxes, MasterValueSourceM2, INPUT, ENUM),
    MEMBER(MC_CombineAxes, BufferMode, INPUT, ENUM),
    MEMBER(MC_CombineAxes, InSync, OUTPUT, BOOL),
    MEMBER(MC_CombineAxes, Busy, OUTPUT, BOOL),
    MEMBER(MC_CombineAxes, Active, OUTPUT, BOOL),
    MEMBER(MC_CombineAxes, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_CombineAxes, Error, OUTPUT, BOOL),
    MEMBER(MC_CombineAxes, ErrorID, OUTPUT, WORD),
};
static void call_MC_CombineAxes(void *fb) { MC_CombineAxes(fb); }
static const cm1e_error_t errors_of_MC_CombineAxes[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_AXIS_RATIO,
    CM1E_ERROR_AXIS_COUPLING_LIMIT,
    CM1E_ERROR_AXIS_MASTER_LOST,
    CM1E_ERROR_AXIS_COUPLING_CYCLE,
    CM1E_ERROR_AXIS_MASTER,
    CM1E_ERROR_AXIS_NO_COUPLINGS,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_FULL,
    CM1E_ERROR_INVALID_ARGUMENT,
    CM1E_OK,
};
static const block_member_t members_of_MC_AddAxisToGroup[] = {
    MEMBER(MC_AddAxisToGroup, AxesGroup, IN_OUT, POINTER),
    MEMBER(MC_AddAxisToGroup, Axis, IN_OUT, POINTER),
    MEMBER(MC_AddAxisToGroup, Execute, INPUT, BOOL),
    MEMBER(MC_AddAxisToGroup, IdentInGroup, INPUT, UINT),
    MEMBER(MC_AddAxisToGroup, Done, OUTPUT, BOOL),
    MEMBER(MC_AddAxisToGroup, Busy, OUTPUT, BOOL),
    MEMBER(MC_AddAxisToGroup, Error, OUTPUT, BOOL),
    MEMBER(MC_AddAxisToGroup, ErrorID, OUTPUT, WORD),
};
static void call_MC_AddAxisToGroup(void *fb) { MC_AddAxisToGroup(fb); }
static const cm1e_error_t errors_of_MC_AddAxisToGroup[] = {
    CM1E_ERROR_GROUP_MEMBER,
    CM1E_ERROR_GROUP_STOPPING,
    CM1E_ERROR_GROUP_ERROR_STOP,
    CM1E_ERROR_GROUP_STATE,
    CM1E_ERROR_GROUP_REF,
    CM1E_ERROR_AXIS_VIRTUAL,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_UNSUPPORTED,
    CM1E_OK,
};
static const block_member_t members_of_MC_RemoveAxisFromGroup[] = {
    MEMBER(MC_RemoveAxisFromGroup, AxesGroup, IN_OUT, POINTER),
    MEMBER(MC_RemoveAxisFromGroup, Execute, INPUT, BOOL),
    MEMBER(MC_RemoveAxisFromGroup, IdentInGroup, INPUT, UINT),
    MEMBER(MC_RemoveAxisFromGroup, Done, OUTPUT, BOOL),
    MEMBER(MC_RemoveAxisFromGroup, Busy, OUTPUT, BOOL),
    MEMBER(MC_RemoveAxisFromGroup, Error, OUTPUT, BOOL),
    MEMBER(MC_RemoveAxisFromGroup, ErrorID, OUTPUT, WORD),
};
static void call_MC_RemoveAxisFromGroup(void *fb) { MC_RemoveAxisFromGroup(fb); }
static const cm1e_error_t errors_of_MC_RemoveAxisFromGroup[] = {
    CM1E_ERROR_GROUP_MEMBER,
    CM1E_ERROR_GROUP_STOPPING,
    CM1E_ERROR_GROUP_ERROR_STOP,
    CM1E_ERROR_GROUP_STATE,
    CM1E_ERROR_GROUP_REF,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_OK,
};
static const block_member_t members_of_MC_UngroupAllAxes[] = {
    MEMBER(MC_UngroupAllAxes, AxesGroup, IN_OUT, POINTER),
    MEMBER(MC_UngroupAllAxes, Execute, INPUT, BOOL),
    MEMBER(MC_UngroupAllAxes, Done, OUTPUT, BOOL),
    MEMBER(MC_UngroupAllAxes, Busy, OUTPUT, BOOL),
    MEMBER(MC_UngroupAllAxes, Error, OUTPUT, BOOL),
    MEMBER(MC_UngroupAllAxes, ErrorID, OUTPUT, WORD),
};
static void call_MC_UngroupAllAxes(void *fb) { MC_UngroupAllAxes(fb); }
static const cm1e_error_t errors_of_MC_UngroupAllAxes[] = {
    CM1E_ERROR_GROUP_REF,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_OK,
};
static const block_member_t members_of_MC_GroupReadConfiguration[] = {
    MEMBER(MC_GroupReadConfiguration, AxesGroup, IN_OUT, POINTER),
    MEMBER(MC_GroupReadConfiguration, Enable, INPUT, BOOL),
    MEMBER(MC_GroupReadConfiguration, IdentInGroup, INPUT, UINT),
    MEMBER(MC_GroupReadConfiguration, CoordSystem, INPUT, ENUM),
    MEMBER(MC_GroupReadConfiguration, Valid, OUTPUT, BOOL),
    MEMBER(MC_GroupReadConfiguration, Busy, OUTPUT, BOOL),
    MEMBER(MC_GroupReadConfiguration, Error, OUTPUT, BOOL),
    MEMBER(MC_GroupReadConfiguration, ErrorID, OUTPUT, WORD),
    MEMBER(MC_GroupReadConfiguration, Axis, OUTPUT, STRUCT),
    MEMBER(MC_GroupReadConfiguration, AxisID, OUTPUT, UINT),
};
static void call_MC_GroupReadConfiguration(void *fb) { MC_GroupReadConfiguration(fb); }
static const cm1e_error_t errors_of_MC_GroupReadConfiguration[] = {
    CM1E_ERROR_GROUP_COORD_SYSTEM,
    CM1E_ERROR_GROUP_MEMBER,
    CM1E_ERROR_GROUP_REF,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_OK,
};
static const block_member_t members_of_MC_GroupEnable[] = {
    MEMBER(MC_GroupEnable, AxesGroup, IN_OUT, POINTER),
    MEMBER(MC_GroupEnable, Execute, INPUT, BOOL),
    MEMBER(MC_GroupEnable, Done, OUTPUT, BOOL),
    MEMBER(MC_GroupEnable, Busy, OUTPUT, BOOL),
    MEMBER(MC_GroupEnable, Error, OUTPUT, BOOL),
    MEMBER(MC_GroupEnable, ErrorID, OUTPUT, WORD),
};
static void call_MC_GroupEnable(void *fb) { MC_GroupEnable(fb); }
static const cm1e_error_t errors_of_MC_GroupEnable[] = {
    CM1E_ERROR_GROUP_MEMBER,
    CM1E_ERROR_GROUP_STOPPING,
    CM1E_ERROR_GROUP_ERROR_STOP,
    CM1E_ERROR_GROUP_STATE,
    CM1E_ERROR_GROUP_REF,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_OK,
};
static const block_member_t members_of_MC_GroupDisable[] = {
    MEMBER(MC_GroupDisable, AxesGroup, IN_OUT, POINTER),
    MEMBER(MC_GroupDisable, Execute, INPUT, BOOL),
    MEMBER(MC_GroupDisable, Done, OUTPUT, BOOL),
    MEMBER(MC_GroupDisable, Busy, OUTPUT, BOOL),
    MEMBER(MC_GroupDisable, Error, OUTPUT, BOOL),
    MEMBER(MC_GroupDisable, ErrorID, OUTPUT, WORD),
};
static void call_MC_GroupDisable(void *fb) { MC_GroupDisable(fb); }
static const cm1e_error_t errors_of_MC_GroupDisable[] = {
    CM1E_ERROR_GROUP_REF,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_OK,
};
static const block_member_t members_of_MC_GroupReset[] = {
    MEMBER(MC_GroupReset, AxesGroup, IN_OUT, POINTER),
    MEMBER(MC_GroupReset, Execute, INPUT, BOOL),
    MEMBER(MC_GroupReset, Done, OUTPUT, BOOL),
    MEMBER(MC_GroupReset, Busy, OUTPUT, BOOL),
    MEMBER(MC_GroupReset, Error, OUTPUT, BOOL),
    MEMBER(MC_GroupReset, ErrorID, OUTPUT, WORD),
};
static void call_MC_GroupReset(void *fb) { MC_GroupReset(fb); }
static const cm1e_error_t errors_of_MC_GroupReset[] = {
    CM1E_ERROR_GROUP_AXIS,
    CM1E_ERROR_GROUP_REF,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_AXIS_OFFLINE,
    CM1E_ERROR_DRIVE_RESET_TIMEOUT,
    CM1E_ERROR_BUS_STATE,
    CM1E_ERROR_CANCELLED,
    CM1E_OK,
};
static const block_member_t members_of_MC_GroupReadStatus[] = {
    MEMBER(MC_GroupReadStatus, AxesGroup, IN_OUT, POINTER),
    MEMBER(MC_GroupReadStatus, Enable, INPUT, BOOL),
    MEMBER(MC_GroupReadStatus, Valid, OUTPUT, BOOL),
    MEMBER(MC_GroupReadStatus, Busy, OUTPUT, BOOL),
    MEMBER(MC_GroupReadStatus, Error, OUTPUT, BOOL),
    MEMBER(MC_GroupReadStatus, ErrorID, OUTPUT, WORD),
    MEMBER(MC_GroupReadStatus, GroupMoving, OUTPUT, BOOL),
    MEMBER(MC_GroupReadStatus, GroupHoming, OUTPUT, BOOL),
    MEMBER(MC_GroupReadStatus, GroupErrorStop, OUTPUT, BOOL),
    MEMBER(MC_GroupReadStatus, GroupStandby, OUTPUT, BOOL),
    MEMBER(MC_GroupReadStatus, GroupStopping, OUTPUT, BOOL),
    MEMBER(MC_GroupReadStatus, GroupDisabled, OUTPUT, BOOL),
};
static void call_MC_GroupReadStatus(void *fb) { MC_GroupReadStatus(fb); }
static const cm1e_error_t errors_of_MC_GroupReadStatus[] = {
    CM1E_ERROR_GROUP_REF,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_OK,
};
static const block_member_t members_of_MC_GroupReadError[] = {
    MEMBER(MC_GroupReadError, AxesGroup, IN_OUT, POINTER),
    MEMBER(MC_GroupReadError, Enable, INPUT, BOOL),
    MEMBER(MC_GroupReadError, Valid, OUTPUT, BOOL),
    MEMBER(MC_GroupReadError, Busy, OUTPUT, BOOL),
    MEMBER(MC_GroupReadError, Error, OUTPUT, BOOL),
    MEMBER(MC_GroupReadError, ErrorID, OUTPUT, WORD),
    MEMBER(MC_GroupReadError, GroupErrorID, OUTPUT, WORD),
};
static void call_MC_GroupReadError(void *fb) { MC_GroupReadError(fb); }
static const cm1e_error_t errors_of_MC_GroupReadError[] = {
    CM1E_ERROR_GROUP_REF,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_OK,
};
static const block_member_t members_of_MC_GroupStop[] = {
    MEMBER(MC_GroupStop, AxesGroup, IN_OUT, POINTER),
    MEMBER(MC_GroupStop, Execute, INPUT, BOOL),
    MEMBER(MC_GroupStop, Deceleration, INPUT, LREAL),
    MEMBER(MC_GroupStop, Jerk, INPUT, LREAL),
    MEMBER(MC_GroupStop, Done, OUTPUT, BOOL),
    MEMBER(MC_GroupStop, Busy, OUTPUT, BOOL),
    MEMBER(MC_GroupStop, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_GroupStop, Error, OUTPUT, BOOL),
    MEMBER(MC_GroupStop, ErrorID, OUTPUT, WORD),
};
static void call_MC_GroupStop(void *fb) { MC_GroupStop(fb); }
static const cm1e_error_t errors_of_MC_GroupStop[] = {
    CM1E_ERROR_GROUP_STOPPING,
    CM1E_ERROR_GROUP_ERROR_STOP,
    CM1E_ERROR_GROUP_DISABLED,
    CM1E_ERROR_GROUP_REF,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_OK,
};
static const block_member_t members_of_MC_GroupHalt[] = {
    MEMBER(MC_GroupHalt, AxesGroup, IN_OUT, POINTER),
    MEMBER(MC_GroupHalt, Execute, INPUT, BOOL),
    MEMBER(MC_GroupHalt, Deceleration, INPUT, LREAL),
    MEMBER(MC_GroupHalt, Jerk, INPUT, LREAL),
    MEMBER(MC_GroupHalt, BufferMode, INPUT, ENUM),
    MEMBER(MC_GroupHalt, Done, OUTPUT, BOOL),
    MEMBER(MC_GroupHalt, Busy, OUTPUT, BOOL),
    MEMBER(MC_GroupHalt, Active, OUTPUT, BOOL),
    MEMBER(MC_GroupHalt, CommandAccepted, OUTPUT, BOOL),
    MEMBER(MC_GroupHalt, CommandID, OUTPUT, UDINT),
    MEMBER(MC_GroupHalt, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_GroupHalt, Error, OUTPUT, BOOL),
    MEMBER(MC_GroupHalt, ErrorID, OUTPUT, WORD),
};
static void call_MC_GroupHalt(void *fb) { MC_GroupHalt(fb); }
static const cm1e_error_t errors_of_MC_GroupHalt[] = {
    CM1E_ERROR_GROUP_STOPPING,
    CM1E_ERROR_GROUP_ERROR_STOP,
    CM1E_ERROR_GROUP_DISABLED,
    CM1E_ERROR_GROUP_REF,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_GroupInterrupt[] = {
    MEMBER(MC_GroupInterrupt, AxesGroup, IN_OUT, POINTER),
    MEMBER(MC_GroupInterrupt, Execute, INPUT, BOOL),
    MEMBER(MC_GroupInterrupt, Deceleration, INPUT, LREAL),
    MEMBER(MC_GroupInterrupt, Jerk, INPUT, LREAL),
    MEMBER(MC_GroupInterrupt, Done, OUTPUT, BOOL),
    MEMBER(MC_GroupInterrupt, Busy, OUTPUT, BOOL),
    MEMBER(MC_GroupInterrupt, Error, OUTPUT, BOOL),
    MEMBER(MC_GroupInterrupt, ErrorID, OUTPUT, WORD),
};
static void call_MC_GroupInterrupt(void *fb) { MC_GroupInterrupt(fb); }
static const cm1e_error_t errors_of_MC_GroupInterrupt[] = {
    CM1E_ERROR_GROUP_STOPPING,
    CM1E_ERROR_GROUP_ERROR_STOP,
    CM1E_ERROR_GROUP_DISABLED,
    CM1E_ERROR_GROUP_STATE,
    CM1E_ERROR_GROUP_REF,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_CANCELLED,
    CM1E_OK,
};
static const block_member_t members_of_MC_GroupContinue[] = {
    MEMBER(MC_GroupContinue, AxesGroup, IN_OUT, POINTER),
    MEMBER(MC_GroupContinue, Execute, INPUT, BOOL),
    MEMBER(MC_GroupContinue, Done, OUTPUT, BOOL),
    MEMBER(MC_GroupContinue, Busy, OUTPUT, BOOL),
    MEMBER(MC_GroupContinue, Error, OUTPUT, BOOL),
    MEMBER(MC_GroupContinue, ErrorID, OUTPUT, WORD),
};
static void call_MC_GroupContinue(void *fb) { MC_GroupContinue(fb); }
static const cm1e_error_t errors_of_MC_GroupContinue[] = {
    CM1E_ERROR_GROUP_STOPPING,
    CM1E_ERROR_GROUP_ERROR_STOP,
    CM1E_ERROR_GROUP_DISABLED,
    CM1E_ERROR_GROUP_STATE,
    CM1E_ERROR_GROUP_REF,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_OK,
};
static const block_member_t members_of_MC_MoveLinearAbsolute[] = {
    MEMBER(MC_MoveLinearAbsolute, AxesGroup, IN_OUT, POINTER),
    MEMBER(MC_MoveLinearAbsolute, Execute, INPUT, BOOL),
    MEMBER(MC_MoveLinearAbsolute, Position, INPUT, LREAL),
    MEMBER(MC_MoveLinearAbsolute, Velocity, INPUT, LREAL),
    MEMBER(MC_MoveLinearAbsolute, Acceleration, INPUT, LREAL),
    MEMBER(MC_MoveLinearAbsolute, Deceleration, INPUT, LREAL),
    MEMBER(MC_MoveLinearAbsolute, Jerk, INPUT, LREAL),
    MEMBER(MC_MoveLinearAbsolute, CoordSystem, INPUT, ENUM),
    MEMBER(MC_MoveLinearAbsolute, BufferMode, INPUT, ENUM),
    MEMBER(MC_MoveLinearAbsolute, TransitionMode, INPUT, ENUM),
    MEMBER(MC_MoveLinearAbsolute, TransitionParameter, INPUT, LREAL),
    MEMBER(MC_MoveLinearAbsolute, Done, OUTPUT, BOOL),
    MEMBER(MC_MoveLinearAbsolute, Busy, OUTPUT, BOOL),
    MEMBER(MC_MoveLinearAbsolute, Active, OUTPUT, BOOL),
    MEMBER(MC_MoveLinearAbsolute, CommandAccepted, OUTPUT, BOOL),
    MEMBER(MC_MoveLinearAbsolute, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_MoveLinearAbsolute, Error, OUTPUT, BOOL),
    MEMBER(MC_MoveLinearAbsolute, ErrorID, OUTPUT, WORD),
    MEMBER(MC_MoveLinearAbsolute, CommandID, OUTPUT, UDINT),
};
static void call_MC_MoveLinearAbsolute(void *fb) { MC_MoveLinearAbsolute(fb); }
static const cm1e_error_t errors_of_MC_MoveLinearAbsolute[] = {
    CM1E_ERROR_GROUP_COORD_SYSTEM,
    CM1E_ERROR_GROUP_TRANSITION,
    CM1E_ERROR_GROUP_PATH,
    CM1E_ERROR_GROUP_AXIS,
    CM1E_ERROR_GROUP_STOPPING,
    CM1E_ERROR_GROUP_ERROR_STOP,
    CM1E_ERROR_GROUP_DISABLED,
    CM1E_ERROR_GROUP_REF,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_VELOCITY_RANGE,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_MoveLinearRelative[] = {
    MEMBER(MC_MoveLinearRelative, AxesGroup, IN_OUT, POINTER),
    MEMBER(MC_MoveLinearRelative, Execute, INPUT, BOOL),
    MEMBER(MC_MoveLinearRelative, Distance, INPUT, LREAL),
    MEMBER(MC_MoveLinearRelative, Velocity, INPUT, LREAL),
    MEMBER(MC_MoveLinearRelative, Acceleration, INPUT, LREAL),
    MEMBER(MC_MoveLinearRelative, Deceleration, INPUT, LREAL),
    MEMBER(MC_MoveLinearRelative, Jerk, INPUT, LREAL),
    MEMBER(MC_MoveLinearRelative, CoordSystem, INPUT, ENUM),
    MEMBER(MC_MoveLinearRelative, BufferMode, INPUT, ENUM),
    MEMBER(MC_MoveLinearRelative, TransitionMode, INPUT, ENUM),
    MEMBER(MC_MoveLinearRelative, TransitionParameter, INPUT, LREAL),
    MEMBER(MC_MoveLinearRelative, Done, OUTPUT, BOOL),
    MEMBER(MC_MoveLinearRelative, Busy, OUTPUT, BOOL),
    MEMBER(MC_MoveLinearRelative, Active, OUTPUT, BOOL),
    MEMBER(MC_MoveLinearRelative, CommandAccepted, OUTPUT, BOOL),
    MEMBER(MC_MoveLinearRelative, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_MoveLinearRelative, Error, OUTPUT, BOOL),
    MEMBER(MC_MoveLinearRelative, ErrorID, OUTPUT, WORD),
    MEMBER(MC_MoveLinearRelative, CommandID, OUTPUT, UDINT),
};
static void call_MC_MoveLinearRelative(void *fb) { MC_MoveLinearRelative(fb); }
static const cm1e_error_t errors_of_MC_MoveLinearRelative[] = {
    CM1E_ERROR_GROUP_COORD_SYSTEM,
    CM1E_ERROR_GROUP_TRANSITION,
    CM1E_ERROR_GROUP_PATH,
    CM1E_ERROR_GROUP_AXIS,
    CM1E_ERROR_GROUP_STOPPING,
    CM1E_ERROR_GROUP_ERROR_STOP,
    CM1E_ERROR_GROUP_DISABLED,
    CM1E_ERROR_GROUP_REF,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_VELOCITY_RANGE,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_MoveCircularAbsolute[] = {
    MEMBER(MC_MoveCircularAbsolute, AxesGroup, IN_OUT, POINTER),
    MEMBER(MC_MoveCircularAbsolute, Execute, INPUT, BOOL),
    MEMBER(MC_MoveCircularAbsolute, CircMode, INPUT, ENUM),
    MEMBER(MC_MoveCircularAbsolute, AuxPoint, INPUT, LREAL),
    MEMBER(MC_MoveCircularAbsolute, EndPoint, INPUT, LREAL),
    MEMBER(MC_MoveCircularAbsolute, PathChoice, INPUT, ENUM),
    MEMBER(MC_MoveCircularAbsolute, Velocity, INPUT, LREAL),
    MEMBER(MC_MoveCircularAbsolute, Acceleration, INPUT, LREAL),
    MEMBER(MC_MoveCircularAbsolute, Deceleration, INPUT, LREAL),
    MEMBER(MC_MoveCircularAbsolute, Jerk, INPUT, LREAL),
    MEMBER(MC_MoveCircularAbsolute, CoordSystem, INPUT, ENUM),
    MEMBER(MC_MoveCircularAbsolute, BufferMode, INPUT, ENUM),
    MEMBER(MC_MoveCircularAbsolute, TransitionMode, INPUT, ENUM),
    MEMBER(MC_MoveCircularAbsolute, TransitionParameter, INPUT, LREAL),
    MEMBER(MC_MoveCircularAbsolute, Done, OUTPUT, BOOL),
    MEMBER(MC_MoveCircularAbsolute, Busy, OUTPUT, BOOL),
    MEMBER(MC_MoveCircularAbsolute, Active, OUTPUT, BOOL),
    MEMBER(MC_MoveCircularAbsolute, CommandAccepted, OUTPUT, BOOL),
    MEMBER(MC_MoveCircularAbsolute, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_MoveCircularAbsolute, Error, OUTPUT, BOOL),
    MEMBER(MC_MoveCircularAbsolute, ErrorID, OUTPUT, WORD),
    MEMBER(MC_MoveCircularAbsolute, CommandID, OUTPUT, UDINT),
};
static void call_MC_MoveCircularAbsolute(void *fb) { MC_MoveCircularAbsolute(fb); }
static const cm1e_error_t errors_of_MC_MoveCircularAbsolute[] = {
    CM1E_ERROR_GROUP_COORD_SYSTEM,
    CM1E_ERROR_GROUP_TRANSITION,
    CM1E_ERROR_GROUP_PATH,
    CM1E_ERROR_GROUP_AXIS,
    CM1E_ERROR_GROUP_STOPPING,
    CM1E_ERROR_GROUP_ERROR_STOP,
    CM1E_ERROR_GROUP_DISABLED,
    CM1E_ERROR_GROUP_REF,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_VELOCITY_RANGE,
    CM1E_ERROR_UNSUPPORTED,
    CM1E_ERROR_FULL,
    CM1E_ERROR_INVALID_ARGUMENT,
    CM1E_OK,
};
static const block_member_t members_of_MC_MoveCircularRelative[] = {
    MEMBER(MC_MoveCircularRelative, AxesGroup, IN_OUT, POINTER),
    MEMBER(MC_MoveCircularRelative, Execute, INPUT, BOOL),
    MEMBER(MC_MoveCircularRelative, CircMode, INPUT, ENUM),
    MEMBER(MC_MoveCircularRelative, AuxPoint, INPUT, LREAL),
    MEMBER(MC_MoveCircularRelative, EndPoint, INPUT, LREAL),
    MEMBER(MC_MoveCircularRelative, PathChoice, INPUT, ENUM),
    MEMBER(MC_MoveCircularRelative, Velocity, INPUT, LREAL),
    MEMBER(MC_MoveCircularRelative, Acceleration, INPUT, LREAL),
    MEMBER(MC_MoveCircularRelative, Deceleration, INPUT, LREAL),
    MEMBER(MC_MoveCircularRelative, Jerk, INPUT, LREAL),
    MEMBER(MC_MoveCircularRelative, CoordSystem, INPUT, ENUM),
    MEMBER(MC_MoveCircularRelative, BufferMode, INPUT, ENUM),
    MEMBER(MC_MoveCircularRelative, TransitionMode, INPUT, ENUM),
    MEMBER(MC_MoveCircularRelative, TransitionParameter, INPUT, LREAL),
    MEMBER(MC_MoveCircularRelative, Done, OUTPUT, BOOL),
    MEMBER(MC_MoveCircularRelative, Busy, OUTPUT, BOOL),
    MEMBER(MC_MoveCircularRelative, Active, OUTPUT, BOOL),
    MEMBER(MC_MoveCircularRelative, CommandAccepted, OUTPUT, BOOL),
    MEMBER(MC_MoveCircularRelative, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_MoveCircularRelative, Error, OUTPUT, BOOL),
    MEMBER(MC_MoveCircularRelative, ErrorID, OUTPUT, WORD),
    MEMBER(MC_MoveCircularRelative, CommandID, OUTPUT, UDINT),
};
static void call_MC_MoveCircularRelative(void *fb) { MC_MoveCircularRelative(fb); }
static const cm1e_error_t errors_of_MC_MoveCircularRelative[] = {
    CM1E_ERROR_GROUP_COORD_SYSTEM,
    CM1E_ERROR_GROUP_TRANSITION,
    CM1E_ERROR_GROUP_PATH,
    CM1E_ERROR_GROUP_AXIS,
    CM1E_ERROR_GROUP_STOPPING,
    CM1E_ERROR_GROUP_ERROR_STOP,
    CM1E_ERROR_GROUP_DISABLED,
    CM1E_ERROR_GROUP_REF,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_VELOCITY_RANGE,
    CM1E_ERROR_UNSUPPORTED,
    CM1E_ERROR_FULL,
    CM1E_ERROR_INVALID_ARGUMENT,
    CM1E_OK,
};
static const block_member_t members_of_MC_MoveDirectAbsolute[] = {
    MEMBER(MC_MoveDirectAbsolute, AxesGroup, IN_OUT, POINTER),
    MEMBER(MC_MoveDirectAbsolute, Execute, INPUT, BOOL),
    MEMBER(MC_MoveDirectAbsolute, Position, INPUT, LREAL),
    MEMBER(MC_MoveDirectAbsolute, CoordSystem, INPUT, ENUM),
    MEMBER(MC_MoveDirectAbsolute, BufferMode, INPUT, ENUM),
    MEMBER(MC_MoveDirectAbsolute, TransitionMode, INPUT, ENUM),
    MEMBER(MC_MoveDirectAbsolute, TransitionParameter, INPUT, LREAL),
    MEMBER(MC_MoveDirectAbsolute, Done, OUTPUT, BOOL),
    MEMBER(MC_MoveDirectAbsolute, Busy, OUTPUT, BOOL),
    MEMBER(MC_MoveDirectAbsolute, Active, OUTPUT, BOOL),
    MEMBER(MC_MoveDirectAbsolute, CommandAccepted, OUTPUT, BOOL),
    MEMBER(MC_MoveDirectAbsolute, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_MoveDirectAbsolute, Error, OUTPUT, BOOL),
    MEMBER(MC_MoveDirectAbsolute, ErrorID, OUTPUT, WORD),
    MEMBER(MC_MoveDirectAbsolute, CommandID, OUTPUT, UDINT),
};
static void call_MC_MoveDirectAbsolute(void *fb) { MC_MoveDirectAbsolute(fb); }
static const cm1e_error_t errors_of_MC_MoveDirectAbsolute[] = {
    CM1E_ERROR_GROUP_COORD_SYSTEM,
    CM1E_ERROR_GROUP_TRANSITION,
    CM1E_ERROR_GROUP_PATH,
    CM1E_ERROR_GROUP_AXIS,
    CM1E_ERROR_GROUP_STOPPING,
    CM1E_ERROR_GROUP_ERROR_STOP,
    CM1E_ERROR_GROUP_DISABLED,
    CM1E_ERROR_GROUP_REF,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_MoveDirectRelative[] = {
    MEMBER(MC_MoveDirectRelative, AxesGroup, IN_OUT, POINTER),
    MEMBER(MC_MoveDirectRelative, Execute, INPUT, BOOL),
    MEMBER(MC_MoveDirectRelative, Distance, INPUT, LREAL),
    MEMBER(MC_MoveDirectRelative, CoordSystem, INPUT, ENUM),
    MEMBER(MC_MoveDirectRelative, BufferMode, INPUT, ENUM),
    MEMBER(MC_MoveDirectRelative, TransitionMode, INPUT, ENUM),
    MEMBER(MC_MoveDirectRelative, TransitionParameter, INPUT, LREAL),
    MEMBER(MC_MoveDirectRelative, Done, OUTPUT, BOOL),
    MEMBER(MC_MoveDirectRelative, Busy, OUTPUT, BOOL),
    MEMBER(MC_MoveDirectRelative, Active, OUTPUT, BOOL),
    MEMBER(MC_MoveDirectRelative, CommandAccepted, OUTPUT, BOOL),
    MEMBER(MC_MoveDirectRelative, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_MoveDirectRelative, Error, OUTPUT, BOOL),
    MEMBER(MC_MoveDirectRelative, ErrorID, OUTPUT, WORD),
    MEMBER(MC_MoveDirectRelative, CommandID, OUTPUT, UDINT),
};
static void call_MC_MoveDirectRelative(void *fb) { MC_MoveDirectRelative(fb); }
static const cm1e_error_t errors_of_MC_MoveDirectRelative[] = {
    CM1E_ERROR_GROUP_COORD_SYSTEM,
    CM1E_ERROR_GROUP_TRANSITION,
    CM1E_ERROR_GROUP_PATH,
    CM1E_ERROR_GROUP_AXIS,
    CM1E_ERROR_GROUP_STOPPING,
    CM1E_ERROR_GROUP_ERROR_STOP,
    CM1E_ERROR_GROUP_DISABLED,
    CM1E_ERROR_GROUP_REF,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_GroupReadPosition[] = {
    MEMBER(MC_GroupReadPosition, AxesGroup, IN_OUT, POINTER),
    MEMBER(MC_GroupReadPosition, Enable, INPUT, BOOL),
    MEMBER(MC_GroupReadPosition, CoordSystem, INPUT, ENUM),
    MEMBER(MC_GroupReadPosition, Source, INPUT, ENUM),
    MEMBER(MC_GroupReadPosition, Valid, OUTPUT, BOOL),
    MEMBER(MC_GroupReadPosition, Busy, OUTPUT, BOOL),
    MEMBER(MC_GroupReadPosition, Error, OUTPUT, BOOL),
    MEMBER(MC_GroupReadPosition, ErrorID, OUTPUT, WORD),
    MEMBER(MC_GroupReadPosition, Position, OUTPUT, LREAL),
};
static void call_MC_GroupReadPosition(void *fb) { MC_GroupReadPosition(fb); }
static const cm1e_error_t errors_of_MC_GroupReadPosition[] = {
    CM1E_ERROR_GROUP_COORD_SYSTEM,
    CM1E_ERROR_GROUP_REF,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_AXIS_OFFLINE,
    CM1E_ERROR_UNSUPPORTED,
    CM1E_OK,
};
static const block_member_t members_of_MC_GroupReadVelocity[] = {
    MEMBER(MC_GroupReadVelocity, AxesGroup, IN_OUT, POINTER),
    MEMBER(MC_GroupReadVelocity, Enable, INPUT, BOOL),
    MEMBER(MC_GroupReadVelocity, CoordSystem, INPUT, ENUM),
    MEMBER(MC_GroupReadVelocity, Source, INPUT, ENUM),
    MEMBER(MC_GroupReadVelocity, Valid, OUTPUT, BOOL),
    MEMBER(MC_GroupReadVelocity, Busy, OUTPUT, BOOL),
    MEMBER(MC_GroupReadVelocity, Error, OUTPUT, BOOL),
    MEMBER(MC_GroupReadVelocity, ErrorID, OUTPUT, WORD),
    MEMBER(MC_GroupReadVelocity, Velocity, OUTPUT, LREAL),
    MEMBER(MC_GroupReadVelocity, PathVelocity, OUTPUT, LREAL),
};
static void call_MC_GroupReadVelocity(void *fb) { MC_GroupReadVelocity(fb); }
static const cm1e_error_t errors_of_MC_GroupReadVelocity[] = {
    CM1E_ERROR_GROUP_COORD_SYSTEM,
    CM1E_ERROR_GROUP_REF,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_AXIS_OFFLINE,
    CM1E_ERROR_UNSUPPORTED,
    CM1E_OK,
};
static const block_member_t members_of_MC_GroupSetOverride[] = {
    MEMBER(MC_GroupSetOverride, AxesGroup, IN_OUT, POINTER),
    MEMBER(MC_GroupSetOverride, Enable, INPUT, BOOL),
    MEMBER(MC_GroupSetOverride, VelFactor, INPUT, LREAL),
    MEMBER(MC_GroupSetOverride, AccFactor, INPUT, LREAL),
    MEMBER(MC_GroupSetOverride, JerkFactor, INPUT, LREAL),
    MEMBER(MC_GroupSetOverride, Enabled, OUTPUT, BOOL),
    MEMBER(MC_GroupSetOverride, Busy, OUTPUT, BOOL),
    MEMBER(MC_GroupSetOverride, Error, OUTPUT, BOOL),
    MEMBER(MC_GroupSetOverride, ErrorID, OUTPUT, WORD),
};
static void call_MC_GroupSetOverride(void *fb) { MC_GroupSetOverride(fb); }
static const cm1e_error_t errors_of_MC_GroupSetOverride[] = {
    CM1E_ERROR_GROUP_REF,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_AXIS_OVERRIDE,
    CM1E_OK,
};
static const block_member_t members_of_MC_SetPosition[] = {
    MEMBER(MC_SetPosition, Axis, IN_OUT, POINTER),
    MEMBER(MC_SetPosition, Execute, INPUT, BOOL),
    MEMBER(MC_SetPosition, Position, INPUT, LREAL),
    MEMBER(MC_SetPosition, Relative, INPUT, BOOL),
    MEMBER(MC_SetPosition, ExecutionMode, INPUT, ENUM),
    MEMBER(MC_SetPosition, Done, OUTPUT, BOOL),
    MEMBER(MC_SetPosition, Busy, OUTPUT, BOOL),
    MEMBER(MC_SetPosition, Error, OUTPUT, BOOL),
    MEMBER(MC_SetPosition, ErrorID, OUTPUT, WORD),
};
static void call_MC_SetPosition(void *fb) { MC_SetPosition(fb); }
static const cm1e_error_t errors_of_MC_SetPosition[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_OFFLINE,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STATE,
    CM1E_ERROR_UNSUPPORTED,
    CM1E_OK,
};
static const block_member_t members_of_MC_SetOverride[] = {
    MEMBER(MC_SetOverride, Axis, IN_OUT, POINTER),
    MEMBER(MC_SetOverride, Enable, INPUT, BOOL),
    MEMBER(MC_SetOverride, VelFactor, INPUT, LREAL),
    MEMBER(MC_SetOverride, AccFactor, INPUT, LREAL),
    MEMBER(MC_SetOverride, JerkFactor, INPUT, LREAL),
    MEMBER(MC_SetOverride, Enabled, OUTPUT, BOOL),
    MEMBER(MC_SetOverride, Busy, OUTPUT, BOOL),
    MEMBER(MC_SetOverride, Error, OUTPUT, BOOL),
    MEMBER(MC_SetOverride, ErrorID, OUTPUT, WORD),
};
static void call_MC_SetOverride(void *fb) { MC_SetOverride(fb); }
static const cm1e_error_t errors_of_MC_SetOverride[] = {
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_OVERRIDE,
    CM1E_OK,
};
static const block_member_t members_of_MC_ReadParameter[] = {
    MEMBER(MC_ReadParameter, Axis, IN_OUT, POINTER),
    MEMBER(MC_ReadParameter, Enable, INPUT, BOOL),
    MEMBER(MC_ReadParameter, ParameterNumber, INPUT, INT),
    MEMBER(MC_ReadParameter, Valid, OUTPUT, BOOL),
    MEMBER(MC_ReadParameter, Busy, OUTPUT, BOOL),
    MEMBER(MC_ReadParameter, Error, OUTPUT, BOOL),
    MEMBER(MC_ReadParameter, ErrorID, OUTPUT, WORD),
    MEMBER(MC_ReadParameter, Value, OUTPUT, LREAL),
};
static void call_MC_ReadParameter(void *fb) { MC_ReadParameter(fb); }
static const cm1e_error_t errors_of_MC_ReadParameter[] = {
    CM1E_ERROR_AXIS_VIRTUAL,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_PARAMETER,
    CM1E_ERROR_AXIS_OFFLINE,
    CM1E_ERROR_SDO_ABORT,
    CM1E_ERROR_UNSUPPORTED,
    CM1E_OK,
};
static const block_member_t members_of_MC_ReadBoolParameter[] = {
    MEMBER(MC_ReadBoolParameter, Axis, IN_OUT, POINTER),
    MEMBER(MC_ReadBoolParameter, Enable, INPUT, BOOL),
    MEMBER(MC_ReadBoolParameter, ParameterNumber, INPUT, INT),
    MEMBER(MC_ReadBoolParameter, Valid, OUTPUT, BOOL),
    MEMBER(MC_ReadBoolParameter, Busy, OUTPUT, BOOL),
    MEMBER(MC_ReadBoolParameter, Error, OUTPUT, BOOL),
    MEMBER(MC_ReadBoolParameter, ErrorID, OUTPUT, WORD),
    MEMBER(MC_ReadBoolParameter, Value, OUTPUT, BOOL),
};
static void call_MC_ReadBoolParameter(void *fb) { MC_ReadBoolParameter(fb); }
static const cm1e_error_t errors_of_MC_ReadBoolParameter[] = {
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_PARAMETER,
    CM1E_OK,
};
static const block_member_t members_of_MC_WriteParameter[] = {
    MEMBER(MC_WriteParameter, Axis, IN_OUT, POINTER),
    MEMBER(MC_WriteParameter, Execute, INPUT, BOOL),
    MEMBER(MC_WriteParameter, ParameterNumber, INPUT, INT),
    MEMBER(MC_WriteParameter, Value, INPUT, LREAL),
    MEMBER(MC_WriteParameter, ExecutionMode, INPUT, ENUM),
    MEMBER(MC_WriteParameter, Done, OUTPUT, BOOL),
    MEMBER(MC_WriteParameter, Busy, OUTPUT, BOOL),
    MEMBER(MC_WriteParameter, Error, OUTPUT, BOOL),
    MEMBER(MC_WriteParameter, ErrorID, OUTPUT, WORD),
};
static void call_MC_WriteParameter(void *fb) { MC_WriteParameter(fb); }
static const cm1e_error_t errors_of_MC_WriteParameter[] = {
    CM1E_ERROR_AXIS_VIRTUAL,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_PARAMETER_RANGE,
    CM1E_ERROR_AXIS_PARAMETER_READ_ONLY,
    CM1E_ERROR_AXIS_PARAMETER,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_SDO_ABORT,
    CM1E_ERROR_UNSUPPORTED,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_WriteBoolParameter[] = {
    MEMBER(MC_WriteBoolParameter, Axis, IN_OUT, POINTER),
    MEMBER(MC_WriteBoolParameter, Execute, INPUT, BOOL),
    MEMBER(MC_WriteBoolParameter, ParameterNumber, INPUT, INT),
    MEMBER(MC_WriteBoolParameter, Value, INPUT, BOOL),
    MEMBER(MC_WriteBoolParameter, ExecutionMode, INPUT, ENUM),
    MEMBER(MC_WriteBoolParameter, Done, OUTPUT, BOOL),
    MEMBER(MC_WriteBoolParameter, Busy, OUTPUT, BOOL),
    MEMBER(MC_WriteBoolParameter, Error, OUTPUT, BOOL),
    MEMBER(MC_WriteBoolParameter, ErrorID, OUTPUT, WORD),
};
static void call_MC_WriteBoolParameter(void *fb) { MC_WriteBoolParameter(fb); }
static const cm1e_error_t errors_of_MC_WriteBoolParameter[] = {
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_PARAMETER_RANGE,
    CM1E_ERROR_AXIS_PARAMETER,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_UNSUPPORTED,
    CM1E_OK,
};
static const block_member_t members_of_MC_ReadDigitalInput[] = {
    MEMBER(MC_ReadDigitalInput, Input, IN_OUT, POINTER),
    MEMBER(MC_ReadDigitalInput, Enable, INPUT, BOOL),
    MEMBER(MC_ReadDigitalInput, InputNumber, INPUT, INT),
    MEMBER(MC_ReadDigitalInput, Valid, OUTPUT, BOOL),
    MEMBER(MC_ReadDigitalInput, Busy, OUTPUT, BOOL),
    MEMBER(MC_ReadDigitalInput, Error, OUTPUT, BOOL),
    MEMBER(MC_ReadDigitalInput, ErrorID, OUTPUT, WORD),
    MEMBER(MC_ReadDigitalInput, Value, OUTPUT, BOOL),
};
static void call_MC_ReadDigitalInput(void *fb) { MC_ReadDigitalInput(fb); }
static const cm1e_error_t errors_of_MC_ReadDigitalInput[] = {
    CM1E_ERROR_AXIS_VIRTUAL,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_SIGNAL_AWAY,
    CM1E_ERROR_AXIS_SIGNAL,
    CM1E_ERROR_AXIS_OFFLINE,
    CM1E_ERROR_PDO_MAPPING,
    CM1E_OK,
};
static const block_member_t members_of_MC_ReadDigitalOutput[] = {
    MEMBER(MC_ReadDigitalOutput, Output, IN_OUT, POINTER),
    MEMBER(MC_ReadDigitalOutput, Enable, INPUT, BOOL),
    MEMBER(MC_ReadDigitalOutput, OutputNumber, INPUT, INT),
    MEMBER(MC_ReadDigitalOutput, Valid, OUTPUT, BOOL),
    MEMBER(MC_ReadDigitalOutput, Busy, OUTPUT, BOOL),
    MEMBER(MC_ReadDigitalOutput, Error, OUTPUT, BOOL),
    MEMBER(MC_ReadDigitalOutput, ErrorID, OUTPUT, WORD),
    MEMBER(MC_ReadDigitalOutput, Value, OUTPUT, BOOL),
};
static void call_MC_ReadDigitalOutput(void *fb) { MC_ReadDigitalOutput(fb); }
static const cm1e_error_t errors_of_MC_ReadDigitalOutput[] = {
    CM1E_ERROR_AXIS_VIRTUAL,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_SIGNAL_AWAY,
    CM1E_ERROR_AXIS_SIGNAL,
    CM1E_ERROR_PDO_MAPPING,
    CM1E_OK,
};
static const block_member_t members_of_MC_WriteDigitalOutput[] = {
    MEMBER(MC_WriteDigitalOutput, Output, IN_OUT, POINTER),
    MEMBER(MC_WriteDigitalOutput, Execute, INPUT, BOOL),
    MEMBER(MC_WriteDigitalOutput, OutputNumber, INPUT, INT),
    MEMBER(MC_WriteDigitalOutput, Value, INPUT, BOOL),
    MEMBER(MC_WriteDigitalOutput, ExecutionMode, INPUT, ENUM),
    MEMBER(MC_WriteDigitalOutput, Done, OUTPUT, BOOL),
    MEMBER(MC_WriteDigitalOutput, Busy, OUTPUT, BOOL),
    MEMBER(MC_WriteDigitalOutput, Error, OUTPUT, BOOL),
    MEMBER(MC_WriteDigitalOutput, ErrorID, OUTPUT, WORD),
};
static void call_MC_WriteDigitalOutput(void *fb) { MC_WriteDigitalOutput(fb); }
static const cm1e_error_t errors_of_MC_WriteDigitalOutput[] = {
    CM1E_ERROR_AXIS_VIRTUAL,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_SIGNAL_AWAY,
    CM1E_ERROR_AXIS_SIGNAL,
    CM1E_ERROR_AXIS_OFFLINE,
    CM1E_ERROR_PDO_MAPPING,
    CM1E_ERROR_UNSUPPORTED,
    CM1E_OK,
};
static const block_member_t members_of_MC_ReadActualPosition[] = {
    MEMBER(MC_ReadActualPosition, Axis, IN_OUT, POINTER),
    MEMBER(MC_ReadActualPosition, Enable, INPUT, BOOL),
    MEMBER(MC_ReadActualPosition, Valid, OUTPUT, BOOL),
    MEMBER(MC_ReadActualPosition, Busy, OUTPUT, BOOL),
    MEMBER(MC_ReadActualPosition, Error, OUTPUT, BOOL),
    MEMBER(MC_ReadActualPosition, ErrorID, OUTPUT, WORD),
    MEMBER(MC_ReadActualPosition, Position, OUTPUT, LREAL),
};
static void call_MC_ReadActualPosition(void *fb) { MC_ReadActualPosition(fb); }
static const cm1e_error_t errors_of_MC_ReadActualPosition[] = {
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_OFFLINE,
    CM1E_OK,
};
static const block_member_t members_of_MC_ReadActualVelocity[] = {
    MEMBER(MC_ReadActualVelocity, Axis, IN_OUT, POINTER),
    MEMBER(MC_ReadActualVelocity, Enable, INPUT, BOOL),
    MEMBER(MC_ReadActualVelocity, Valid, OUTPUT, BOOL),
    MEMBER(MC_ReadActualVelocity, Busy, OUTPUT, BOOL),
    MEMBER(MC_ReadActualVelocity, Error, OUTPUT, BOOL),
    MEMBER(MC_ReadActualVelocity, ErrorID, OUTPUT, WORD),
    MEMBER(MC_ReadActualVelocity, Velocity, OUTPUT, LREAL),
};
static void call_MC_ReadActualVelocity(void *fb) { MC_ReadActualVelocity(fb); }
static const cm1e_error_t errors_of_MC_ReadActualVelocity[] = {
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_OFFLINE,
    CM1E_OK,
};
static const block_member_t members_of_MC_ReadActualTorque[] = {
    MEMBER(MC_ReadActualTorque, Axis, IN_OUT, POINTER),
    MEMBER(MC_ReadActualTorque, Enable, INPUT, BOOL),
    MEMBER(MC_ReadActualTorque, Valid, OUTPUT, BOOL),
    MEMBER(MC_ReadActualTorque, Busy, OUTPUT, BOOL),
    MEMBER(MC_ReadActualTorque, Error, OUTPUT, BOOL),
    MEMBER(MC_ReadActualTorque, ErrorID, OUTPUT, WORD),
    MEMBER(MC_ReadActualTorque, Torque, OUTPUT, LREAL),
};
static void call_MC_ReadActualTorque(void *fb) { MC_ReadActualTorque(fb); }
static const cm1e_error_t errors_of_MC_ReadActualTorque[] = {
    CM1E_ERROR_AXIS_VIRTUAL,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_OFFLINE,
    CM1E_OK,
};
static const block_member_t members_of_MC_ReadStatus[] = {
    MEMBER(MC_ReadStatus, Axis, IN_OUT, POINTER),
    MEMBER(MC_ReadStatus, Enable, INPUT, BOOL),
    MEMBER(MC_ReadStatus, Valid, OUTPUT, BOOL),
    MEMBER(MC_ReadStatus, Busy, OUTPUT, BOOL),
    MEMBER(MC_ReadStatus, Error, OUTPUT, BOOL),
    MEMBER(MC_ReadStatus, ErrorID, OUTPUT, WORD),
    MEMBER(MC_ReadStatus, ErrorStop, OUTPUT, BOOL),
    MEMBER(MC_ReadStatus, Disabled, OUTPUT, BOOL),
    MEMBER(MC_ReadStatus, Stopping, OUTPUT, BOOL),
    MEMBER(MC_ReadStatus, Homing, OUTPUT, BOOL),
    MEMBER(MC_ReadStatus, Standstill, OUTPUT, BOOL),
    MEMBER(MC_ReadStatus, DiscreteMotion, OUTPUT, BOOL),
    MEMBER(MC_ReadStatus, ContinuousMotion, OUTPUT, BOOL),
    MEMBER(MC_ReadStatus, SynchronizedMotion, OUTPUT, BOOL),
};
static void call_MC_ReadStatus(void *fb) { MC_ReadStatus(fb); }
static const cm1e_error_t errors_of_MC_ReadStatus[] = {
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_OK,
};
static const block_member_t members_of_MC_ReadMotionState[] = {
    MEMBER(MC_ReadMotionState, Axis, IN_OUT, POINTER),
    MEMBER(MC_ReadMotionState, Enable, INPUT, BOOL),
    MEMBER(MC_ReadMotionState, Source, INPUT, ENUM),
    MEMBER(MC_ReadMotionState, Valid, OUTPUT, BOOL),
    MEMBER(MC_ReadMotionState, Busy, OUTPUT, BOOL),
    MEMBER(MC_ReadMotionState, Error, OUTPUT, BOOL),
    MEMBER(MC_ReadMotionState, ErrorID, OUTPUT, WORD),
    MEMBER(MC_ReadMotionState, ConstantVelocity, OUTPUT, BOOL),
    MEMBER(MC_ReadMotionState, Accelerating, OUTPUT, BOOL),
    MEMBER(MC_ReadMotionState, Decelerating, OUTPUT, BOOL),
    MEMBER(MC_ReadMotionState, DirectionPositive, OUTPUT, BOOL),
    MEMBER(MC_ReadMotionState, DirectionNegative, OUTPUT, BOOL),
};
static void call_MC_ReadMotionState(void *fb) { MC_ReadMotionState(fb); }
static const cm1e_error_t errors_of_MC_ReadMotionState[] = {
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_OFFLINE,
    CM1E_ERROR_INVALID_ARGUMENT,
    CM1E_OK,
};
static const block_member_t members_of_MC_ReadAxisInfo[] = {
    MEMBER(MC_ReadAxisInfo, Axis, IN_OUT, POINTER),
    MEMBER(MC_ReadAxisInfo, Enable, INPUT, BOOL),
    MEMBER(MC_ReadAxisInfo, Valid, OUTPUT, BOOL),
    MEMBER(MC_ReadAxisInfo, Busy, OUTPUT, BOOL),
    MEMBER(MC_ReadAxisInfo, Error, OUTPUT, BOOL),
    MEMBER(MC_ReadAxisInfo, ErrorID, OUTPUT, WORD),
    MEMBER(MC_ReadAxisInfo, HomeAbsSwitch, OUTPUT, BOOL),
    MEMBER(MC_ReadAxisInfo, LimitSwitchPos, OUTPUT, BOOL),
    MEMBER(MC_ReadAxisInfo, LimitSwitchNeg, OUTPUT, BOOL),
    MEMBER(MC_ReadAxisInfo, Simulation, OUTPUT, BOOL),
    MEMBER(MC_ReadAxisInfo, CommunicationReady, OUTPUT, BOOL),
    MEMBER(MC_ReadAxisInfo, ReadyForPowerOn, OUTPUT, BOOL),
    MEMBER(MC_ReadAxisInfo, PowerOn, OUTPUT, BOOL),
    MEMBER(MC_ReadAxisInfo, IsHomed, OUTPUT, BOOL),
    MEMBER(MC_ReadAxisInfo, AxisWarning, OUTPUT, BOOL),
};
static void call_MC_ReadAxisInfo(void *fb) { MC_ReadAxisInfo(fb); }
static const cm1e_error_t errors_of_MC_ReadAxisInfo[] = {
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_OK,
};
static const block_member_t members_of_MC_ReadAxisError[] = {
    MEMBER(MC_ReadAxisError, Axis, IN_OUT, POINTER),
    MEMBER(MC_ReadAxisError, Enable, INPUT, BOOL),
    MEMBER(MC_ReadAxisError, Valid, OUTPUT, BOOL),
    MEMBER(MC_ReadAxisError, Busy, OUTPUT, BOOL),
    MEMBER(MC_ReadAxisError, Error, OUTPUT, BOOL),
    MEMBER(MC_ReadAxisError, ErrorID, OUTPUT, WORD),
    MEMBER(MC_ReadAxisError, AxisErrorID, OUTPUT, WORD),
    MEMBER(MC_ReadAxisError, DeviceErrorCode, OUTPUT, WORD),
};
static void call_MC_ReadAxisError(void *fb) { MC_ReadAxisError(fb); }
static const cm1e_error_t errors_of_MC_ReadAxisError[] = {
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_OK,
};
static const block_member_t members_of_MC_Reset[] = {
    MEMBER(MC_Reset, Axis, IN_OUT, POINTER),
    MEMBER(MC_Reset, Execute, INPUT, BOOL),
    MEMBER(MC_Reset, Done, OUTPUT, BOOL),
    MEMBER(MC_Reset, Busy, OUTPUT, BOOL),
    MEMBER(MC_Reset, Error, OUTPUT, BOOL),
    MEMBER(MC_Reset, ErrorID, OUTPUT, WORD),
};
static void call_MC_Reset(void *fb) { MC_Reset(fb); }
static const cm1e_error_t errors_of_MC_Reset[] = {
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_OFFLINE,
    CM1E_ERROR_DRIVE_RESET_TIMEOUT,
    CM1E_ERROR_BUS_WORKING_COUNTER,
    CM1E_ERROR_BUS_LOST,
    CM1E_ERROR_BUS_STATE,
    CM1E_ERROR_CANCELLED,
    CM1E_OK,
};
static const block_member_t members_of_MC_DigitalCamSwitch[] = {
    MEMBER(MC_DigitalCamSwitch, Axis, IN_OUT, POINTER),
    MEMBER(MC_DigitalCamSwitch, Switches, IN_OUT, POINTER),
    MEMBER(MC_DigitalCamSwitch, Outputs, IN_OUT, POINTER),
    MEMBER(MC_DigitalCamSwitch, TrackOptions, IN_OUT, POINTER),
    MEMBER(MC_DigitalCamSwitch, Enable, INPUT, BOOL),
    MEMBER(MC_DigitalCamSwitch, EnableMask, INPUT, DWORD),
    MEMBER(MC_DigitalCamSwitch, ValueSource, INPUT, ENUM),
    MEMBER(MC_DigitalCamSwitch, InOperation, OUTPUT, BOOL),
    MEMBER(MC_DigitalCamSwitch, Busy, OUTPUT, BOOL),
    MEMBER(MC_DigitalCamSwitch, Error, OUTPUT, BOOL),
    MEMBER(MC_DigitalCamSwitch, ErrorID, OUTPUT, WORD),
};
static void call_MC_DigitalCamSwitch(void *fb) { MC_DigitalCamSwitch(fb); }
static const cm1e_error_t errors_of_MC_DigitalCamSwitch[] = {
    CM1E_ERROR_AXIS_VIRTUAL,
    CM1E_ERROR_FB_CAM_SWITCH,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_SIGNAL_AWAY,
    CM1E_ERROR_AXIS_SIGNAL,
    CM1E_ERROR_AXIS_OFFLINE,
    CM1E_ERROR_PDO_MAPPING,
    CM1E_ERROR_INVALID_ARGUMENT,
    CM1E_OK,
};
static const block_member_t members_of_MC_TouchProbe[] = {
    MEMBER(MC_TouchProbe, Axis, IN_OUT, POINTER),
    MEMBER(MC_TouchProbe, TriggerInput, IN_OUT, POINTER),
    MEMBER(MC_TouchProbe, Execute, INPUT, BOOL),
    MEMBER(MC_TouchProbe, WindowOnly, INPUT, BOOL),
    MEMBER(MC_TouchProbe, FirstPosition, INPUT, LREAL),
    MEMBER(MC_TouchProbe, LastPosition, INPUT, LREAL),
    MEMBER(MC_TouchProbe, Done, OUTPUT, BOOL),
    MEMBER(MC_TouchProbe, Busy, OUTPUT, BOOL),
    MEMBER(MC_TouchProbe, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_TouchProbe, Error, OUTPUT, BOOL),
    MEMBER(MC_TouchProbe, ErrorID, OUTPUT, WORD),
    MEMBER(MC_TouchProbe, RecordedPosition, OUTPUT, LREAL),
    MEMBER(MC_TouchProbe, Uncertainty, OUTPUT, LREAL),
};
static void call_MC_TouchProbe(void *fb) { MC_TouchProbe(fb); }
static const cm1e_error_t errors_of_MC_TouchProbe[] = {
    CM1E_ERROR_AXIS_VIRTUAL,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_SIGNAL_AWAY,
    CM1E_ERROR_AXIS_PROBE,
    CM1E_ERROR_AXIS_SIGNAL,
    CM1E_ERROR_AXIS_OFFLINE,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_PDO_MAPPING,
    CM1E_ERROR_UNSUPPORTED,
    CM1E_OK,
};
static const block_member_t members_of_MC_AbortTrigger[] = {
    MEMBER(MC_AbortTrigger, Axis, IN_OUT, POINTER),
    MEMBER(MC_AbortTrigger, TriggerInput, IN_OUT, POINTER),
    MEMBER(MC_AbortTrigger, Execute, INPUT, BOOL),
    MEMBER(MC_AbortTrigger, Done, OUTPUT, BOOL),
    MEMBER(MC_AbortTrigger, Busy, OUTPUT, BOOL),
    MEMBER(MC_AbortTrigger, Error, OUTPUT, BOOL),
    MEMBER(MC_AbortTrigger, ErrorID, OUTPUT, WORD),
};
static void call_MC_AbortTrigger(void *fb) { MC_AbortTrigger(fb); }
static const cm1e_error_t errors_of_MC_AbortTrigger[] = {
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_SIGNAL,
    CM1E_ERROR_PDO_MAPPING,
    CM1E_ERROR_UNSUPPORTED,
    CM1E_OK,
};
static const block_member_t members_of_MC_StepAbsoluteSwitch[] = {
    MEMBER(MC_StepAbsoluteSwitch, Axis, IN_OUT, POINTER),
    MEMBER(MC_StepAbsoluteSwitch, Execute, INPUT, BOOL),
    MEMBER(MC_StepAbsoluteSwitch, Direction, INPUT, ENUM),
    MEMBER(MC_StepAbsoluteSwitch, SwitchMode, INPUT, ENUM),
    MEMBER(MC_StepAbsoluteSwitch, ReferenceSignal, INPUT, STRUCT),
    MEMBER(MC_StepAbsoluteSwitch, Velocity, INPUT, LREAL),
    MEMBER(MC_StepAbsoluteSwitch, SetPosition, INPUT, LREAL),
    MEMBER(MC_StepAbsoluteSwitch, TorqueLimit, INPUT, LREAL),
    MEMBER(MC_StepAbsoluteSwitch, TimeLimit, INPUT, TIME),
    MEMBER(MC_StepAbsoluteSwitch, DistanceLimit, INPUT, LREAL),
    MEMBER(MC_StepAbsoluteSwitch, BufferMode, INPUT, ENUM),
    MEMBER(MC_StepAbsoluteSwitch, Done, OUTPUT, BOOL),
    MEMBER(MC_StepAbsoluteSwitch, Busy, OUTPUT, BOOL),
    MEMBER(MC_StepAbsoluteSwitch, Active, OUTPUT, BOOL),
    MEMBER(MC_StepAbsoluteSwitch, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_StepAbsoluteSwitch, Error, OUTPUT, BOOL),
    MEMBER(MC_StepAbsoluteSwitch, ErrorID, OUTPUT, WORD),
};
static void call_MC_StepAbsoluteSwitch(void *fb) { MC_StepAbsoluteSwitch(fb); }
static const cm1e_error_t errors_of_MC_StepAbsoluteSwitch[] = {
    CM1E_ERROR_AXIS_VIRTUAL,
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_AXIS_STEP_LIMIT_SWITCH,
    CM1E_ERROR_AXIS_STEP_TORQUE,
    CM1E_ERROR_AXIS_STEP_DISTANCE,
    CM1E_ERROR_AXIS_STEP_TIME,
    CM1E_ERROR_AXIS_STEP_SWITCH,
    CM1E_ERROR_AXIS_STEP_INPUT,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_DIRECTION,
    CM1E_ERROR_AXIS_VELOCITY_RANGE,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_AXIS_STATE,
    CM1E_ERROR_PDO_MAPPING,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_StepLimitSwitch[] = {
    MEMBER(MC_StepLimitSwitch, Axis, IN_OUT, POINTER),
    MEMBER(MC_StepLimitSwitch, Execute, INPUT, BOOL),
    MEMBER(MC_StepLimitSwitch, Direction, INPUT, ENUM),
    MEMBER(MC_StepLimitSwitch, LimitSwitchMode, INPUT, ENUM),
    MEMBER(MC_StepLimitSwitch, Velocity, INPUT, LREAL),
    MEMBER(MC_StepLimitSwitch, SetPosition, INPUT, LREAL),
    MEMBER(MC_StepLimitSwitch, TorqueLimit, INPUT, LREAL),
    MEMBER(MC_StepLimitSwitch, TimeLimit, INPUT, TIME),
    MEMBER(MC_StepLimitSwitch, DistanceLimit, INPUT, LREAL),
    MEMBER(MC_StepLimitSwitch, BufferMode, INPUT, ENUM),
    MEMBER(MC_StepLimitSwitch, Done, OUTPUT, BOOL),
    MEMBER(MC_StepLimitSwitch, Busy, OUTPUT, BOOL),
    MEMBER(MC_StepLimitSwitch, Active, OUTPUT, BOOL),
    MEMBER(MC_StepLimitSwitch, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_StepLimitSwitch, Error, OUTPUT, BOOL),
    MEMBER(MC_StepLimitSwitch, ErrorID, OUTPUT, WORD),
};
static void call_MC_StepLimitSwitch(void *fb) { MC_StepLimitSwitch(fb); }
static const cm1e_error_t errors_of_MC_StepLimitSwitch[] = {
    CM1E_ERROR_AXIS_VIRTUAL,
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_AXIS_STEP_LIMIT_SWITCH,
    CM1E_ERROR_AXIS_STEP_TORQUE,
    CM1E_ERROR_AXIS_STEP_DISTANCE,
    CM1E_ERROR_AXIS_STEP_TIME,
    CM1E_ERROR_AXIS_STEP_SWITCH,
    CM1E_ERROR_AXIS_STEP_INPUT,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_DIRECTION,
    CM1E_ERROR_AXIS_VELOCITY_RANGE,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_AXIS_STATE,
    CM1E_ERROR_PDO_MAPPING,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_StepBlock[] = {
    MEMBER(MC_StepBlock, Axis, IN_OUT, POINTER),
    MEMBER(MC_StepBlock, Execute, INPUT, BOOL),
    MEMBER(MC_StepBlock, Direction, INPUT, ENUM),
    MEMBER(MC_StepBlock, Velocity, INPUT, LREAL),
    MEMBER(MC_StepBlock, SetPosition, INPUT, LREAL),
    MEMBER(MC_StepBlock, DetectionVelocityLimit, INPUT, LREAL),
    MEMBER(MC_StepBlock, DetectionVelocityTime, INPUT, TIME),
    MEMBER(MC_StepBlock, TorqueLimit, INPUT, LREAL),
    MEMBER(MC_StepBlock, TimeLimit, INPUT, TIME),
    MEMBER(MC_StepBlock, DistanceLimit, INPUT, LREAL),
    MEMBER(MC_StepBlock, BufferMode, INPUT, ENUM),
    MEMBER(MC_StepBlock, Done, OUTPUT, BOOL),
    MEMBER(MC_StepBlock, Busy, OUTPUT, BOOL),
    MEMBER(MC_StepBlock, Active, OUTPUT, BOOL),
    MEMBER(MC_StepBlock, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_StepBlock, Error, OUTPUT, BOOL),
    MEMBER(MC_StepBlock, ErrorID, OUTPUT, WORD),
};
static void call_MC_StepBlock(void *fb) { MC_StepBlock(fb); }
static const cm1e_error_t errors_of_MC_StepBlock[] = {
    CM1E_ERROR_AXIS_VIRTUAL,
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_AXIS_STEP_LIMIT_SWITCH,
    CM1E_ERROR_AXIS_STEP_DISTANCE,
    CM1E_ERROR_AXIS_STEP_TIME,
    CM1E_ERROR_AXIS_STEP_INPUT,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_DIRECTION,
    CM1E_ERROR_AXIS_VELOCITY_RANGE,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_AXIS_STATE,
    CM1E_ERROR_PDO_MAPPING,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_StepReferencePulse[] = {
    MEMBER(MC_StepReferencePulse, Axis, IN_OUT, POINTER),
    MEMBER(MC_StepReferencePulse, Execute, INPUT, BOOL),
    MEMBER(MC_StepReferencePulse, Direction, INPUT, ENUM),
    MEMBER(MC_StepReferencePulse, ReferenceSignal, INPUT, STRUCT),
    MEMBER(MC_StepReferencePulse, Velocity, INPUT, LREAL),
    MEMBER(MC_StepReferencePulse, SetPosition, INPUT, LREAL),
    MEMBER(MC_StepReferencePulse, TorqueLimit, INPUT, LREAL),
    MEMBER(MC_StepReferencePulse, TimeLimit, INPUT, TIME),
    MEMBER(MC_StepReferencePulse, DistanceLimit, INPUT, LREAL),
    MEMBER(MC_StepReferencePulse, BufferMode, INPUT, ENUM),
    MEMBER(MC_StepReferencePulse, Done, OUTPUT, BOOL),
    MEMBER(MC_StepReferencePulse, Busy, OUTPUT, BOOL),
    MEMBER(MC_StepReferencePulse, Active, OUTPUT, BOOL),
    MEMBER(MC_StepReferencePulse, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_StepReferencePulse, Error, OUTPUT, BOOL),
    MEMBER(MC_StepReferencePulse, ErrorID, OUTPUT, WORD),
};
static void call_MC_StepReferencePulse(void *fb) { MC_StepReferencePulse(fb); }
static const cm1e_error_t errors_of_MC_StepReferencePulse[] = {
    CM1E_ERROR_AXIS_NO_SUCH_SIGNAL,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_OK,
};
static const block_member_t members_of_MC_StepDistanceCoded[] = {
    MEMBER(MC_StepDistanceCoded, Axis, IN_OUT, POINTER),
    MEMBER(MC_StepDistanceCoded, Execute, INPUT, BOOL),
    MEMBER(MC_StepDistanceCoded, Direction, INPUT, ENUM),
    MEMBER(MC_StepDistanceCoded, Velocity, INPUT, LREAL),
    MEMBER(MC_StepDistanceCoded, TorqueLimit, INPUT, LREAL),
    MEMBER(MC_StepDistanceCoded, TimeLimit, INPUT, TIME),
    MEMBER(MC_StepDistanceCoded, DistanceLimit, INPUT, LREAL),
    MEMBER(MC_StepDistanceCoded, BufferMode, INPUT, ENUM),
    MEMBER(MC_StepDistanceCoded, Done, OUTPUT, BOOL),
    MEMBER(MC_StepDistanceCoded, Busy, OUTPUT, BOOL),
    MEMBER(MC_StepDistanceCoded, Active, OUTPUT, BOOL),
    MEMBER(MC_StepDistanceCoded, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_StepDistanceCoded, Error, OUTPUT, BOOL),
    MEMBER(MC_StepDistanceCoded, ErrorID, OUTPUT, WORD),
};
static void call_MC_StepDistanceCoded(void *fb) { MC_StepDistanceCoded(fb); }
static const cm1e_error_t errors_of_MC_StepDistanceCoded[] = {
    CM1E_ERROR_AXIS_NO_SUCH_SIGNAL,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_OK,
};
static const block_member_t members_of_MC_HomeDirect[] = {
    MEMBER(MC_HomeDirect, Axis, IN_OUT, POINTER),
    MEMBER(MC_HomeDirect, Execute, INPUT, BOOL),
    MEMBER(MC_HomeDirect, SetPosition, INPUT, LREAL),
    MEMBER(MC_HomeDirect, BufferMode, INPUT, ENUM),
    MEMBER(MC_HomeDirect, Done, OUTPUT, BOOL),
    MEMBER(MC_HomeDirect, Busy, OUTPUT, BOOL),
    MEMBER(MC_HomeDirect, Active, OUTPUT, BOOL),
    MEMBER(MC_HomeDirect, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_HomeDirect, Error, OUTPUT, BOOL),
    MEMBER(MC_HomeDirect, ErrorID, OUTPUT, WORD),
};
static void call_MC_HomeDirect(void *fb) { MC_HomeDirect(fb); }
static const cm1e_error_t errors_of_MC_HomeDirect[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_AXIS_STATE,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_HomeAbsolute[] = {
    MEMBER(MC_HomeAbsolute, Axis, IN_OUT, POINTER),
    MEMBER(MC_HomeAbsolute, Execute, INPUT, BOOL),
    MEMBER(MC_HomeAbsolute, BufferMode, INPUT, ENUM),
    MEMBER(MC_HomeAbsolute, Done, OUTPUT, BOOL),
    MEMBER(MC_HomeAbsolute, Busy, OUTPUT, BOOL),
    MEMBER(MC_HomeAbsolute, Active, OUTPUT, BOOL),
    MEMBER(MC_HomeAbsolute, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_HomeAbsolute, Error, OUTPUT, BOOL),
    MEMBER(MC_HomeAbsolute, ErrorID, OUTPUT, WORD),
};
static void call_MC_HomeAbsolute(void *fb) { MC_HomeAbsolute(fb); }
static const cm1e_error_t errors_of_MC_HomeAbsolute[] = {
    CM1E_ERROR_AXIS_NO_SUCH_SIGNAL,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_OK,
};
static const block_member_t members_of_MC_FinishHoming[] = {
    MEMBER(MC_FinishHoming, Axis, IN_OUT, POINTER),
    MEMBER(MC_FinishHoming, Execute, INPUT, BOOL),
    MEMBER(MC_FinishHoming, Distance, INPUT, LREAL),
    MEMBER(MC_FinishHoming, Velocity, INPUT, LREAL),
    MEMBER(MC_FinishHoming, Acceleration, INPUT, LREAL),
    MEMBER(MC_FinishHoming, Deceleration, INPUT, LREAL),
    MEMBER(MC_FinishHoming, Jerk, INPUT, LREAL),
    MEMBER(MC_FinishHoming, BufferMode, INPUT, ENUM),
    MEMBER(MC_FinishHoming, Done, OUTPUT, BOOL),
    MEMBER(MC_FinishHoming, Busy, OUTPUT, BOOL),
    MEMBER(MC_FinishHoming, Active, OUTPUT, BOOL),
    MEMBER(MC_FinishHoming, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_FinishHoming, Error, OUTPUT, BOOL),
    MEMBER(MC_FinishHoming, ErrorID, OUTPUT, WORD),
};
static void call_MC_FinishHoming(void *fb) { MC_FinishHoming(fb); }
static const cm1e_error_t errors_of_MC_FinishHoming[] = {
    CM1E_ERROR_AXIS_IN_GROUP,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_BUFFER_MODE,
    CM1E_ERROR_AXIS_DIRECTION_DISABLED,
    CM1E_ERROR_AXIS_DYNAMICS_RANGE,
    CM1E_ERROR_AXIS_VELOCITY_RANGE,
    CM1E_ERROR_AXIS_POSITION_RANGE,
    CM1E_ERROR_AXIS_HOMING,
    CM1E_ERROR_AXIS_STOPPING,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_AXIS_NOT_POWERED,
    CM1E_ERROR_AXIS_STATE,
    CM1E_ERROR_FULL,
    CM1E_OK,
};
static const block_member_t members_of_MC_StepReferenceFlyingSwitch[] = {
    MEMBER(MC_StepReferenceFlyingSwitch, Axis, IN_OUT, POINTER),
    MEMBER(MC_StepReferenceFlyingSwitch, Execute, INPUT, BOOL),
    MEMBER(MC_StepReferenceFlyingSwitch, SwitchMode, INPUT, ENUM),
    MEMBER(MC_StepReferenceFlyingSwitch, ReferenceSignal, INPUT, STRUCT),
    MEMBER(MC_StepReferenceFlyingSwitch, SetPosition, INPUT, LREAL),
    MEMBER(MC_StepReferenceFlyingSwitch, TimeLimit, INPUT, TIME),
    MEMBER(MC_StepReferenceFlyingSwitch, DistanceLimit, INPUT, LREAL),
    MEMBER(MC_StepReferenceFlyingSwitch, BufferMode, INPUT, ENUM),
    MEMBER(MC_StepReferenceFlyingSwitch, Done, OUTPUT, BOOL),
    MEMBER(MC_StepReferenceFlyingSwitch, Busy, OUTPUT, BOOL),
    MEMBER(MC_StepReferenceFlyingSwitch, Active, OUTPUT, BOOL),
    MEMBER(MC_StepReferenceFlyingSwitch, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_StepReferenceFlyingSwitch, Error, OUTPUT, BOOL),
    MEMBER(MC_StepReferenceFlyingSwitch, ErrorID, OUTPUT, WORD),
};
static void call_MC_StepReferenceFlyingSwitch(void *fb) { MC_StepReferenceFlyingSwitch(fb); }
static const cm1e_error_t errors_of_MC_StepReferenceFlyingSwitch[] = {
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_UNSUPPORTED,
    CM1E_OK,
};
static const block_member_t members_of_MC_StepReferenceFlyingRefPulse[] = {
    MEMBER(MC_StepReferenceFlyingRefPulse, Axis, IN_OUT, POINTER),
    MEMBER(MC_StepReferenceFlyingRefPulse, Execute, INPUT, BOOL),
    MEMBER(MC_StepReferenceFlyingRefPulse, ReferenceSignal, INPUT, STRUCT),
    MEMBER(MC_StepReferenceFlyingRefPulse, SetPosition, INPUT, LREAL),
    MEMBER(MC_StepReferenceFlyingRefPulse, TimeLimit, INPUT, TIME),
    MEMBER(MC_StepReferenceFlyingRefPulse, DistanceLimit, INPUT, LREAL),
    MEMBER(MC_StepReferenceFlyingRefPulse, BufferMode, INPUT, ENUM),
    MEMBER(MC_StepReferenceFlyingRefPulse, Done, OUTPUT, BOOL),
    MEMBER(MC_StepReferenceFlyingRefPulse, Busy, OUTPUT, BOOL),
    MEMBER(MC_StepReferenceFlyingRefPulse, Active, OUTPUT, BOOL),
    MEMBER(MC_StepReferenceFlyingRefPulse, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_StepReferenceFlyingRefPulse, Error, OUTPUT, BOOL),
    MEMBER(MC_StepReferenceFlyingRefPulse, ErrorID, OUTPUT, WORD),
};
static void call_MC_StepReferenceFlyingRefPulse(void *fb) { MC_StepReferenceFlyingRefPulse(fb); }
static const cm1e_error_t errors_of_MC_StepReferenceFlyingRefPulse[] = {
    CM1E_ERROR_AXIS_NO_SUCH_SIGNAL,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_OK,
};
static const block_member_t members_of_MC_AbortPassiveHoming[] = {
    MEMBER(MC_AbortPassiveHoming, Axis, IN_OUT, POINTER),
    MEMBER(MC_AbortPassiveHoming, Execute, INPUT, BOOL),
    MEMBER(MC_AbortPassiveHoming, Done, OUTPUT, BOOL),
    MEMBER(MC_AbortPassiveHoming, Busy, OUTPUT, BOOL),
    MEMBER(MC_AbortPassiveHoming, CommandAborted, OUTPUT, BOOL),
    MEMBER(MC_AbortPassiveHoming, Error, OUTPUT, BOOL),
    MEMBER(MC_AbortPassiveHoming, ErrorID, OUTPUT, WORD),
};
static void call_MC_AbortPassiveHoming(void *fb) { MC_AbortPassiveHoming(fb); }
static const cm1e_error_t errors_of_MC_AbortPassiveHoming[] = {
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_UNSUPPORTED,
    CM1E_OK,
};
static const block_member_t members_of_CM_SendCML[] = {
    MEMBER(CM_SendCML, Axis, IN_OUT, POINTER),
    MEMBER(CM_SendCML, Execute, INPUT, BOOL),
    MEMBER(CM_SendCML, Command, INPUT, STRING),
    MEMBER(CM_SendCML, Timeout, INPUT, TIME),
    MEMBER(CM_SendCML, AllowMotion, INPUT, BOOL),
    MEMBER(CM_SendCML, Line, INPUT, INT),
    MEMBER(CM_SendCML, Done, OUTPUT, BOOL),
    MEMBER(CM_SendCML, Busy, OUTPUT, BOOL),
    MEMBER(CM_SendCML, Error, OUTPUT, BOOL),
    MEMBER(CM_SendCML, ErrorID, OUTPUT, WORD),
    MEMBER(CM_SendCML, Response, OUTPUT, STRING),
    MEMBER(CM_SendCML, Lines, OUTPUT, INT),
    MEMBER(CM_SendCML, Strays, OUTPUT, INT),
};
static void call_CM_SendCML(void *fb) { CM_SendCML(fb); }
static const cm1e_error_t errors_of_CM_SendCML[] = {
    CM1E_ERROR_AXIS_VIRTUAL,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_OFFLINE,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_CM_NO_BRIDGE,
    CM1E_ERROR_CM_NOT_DISABLED,
    CM1E_ERROR_CM_MODE,
    CM1E_ERROR_CM_SEARCH_TIMEOUT,
    CM1E_ERROR_CM_SEARCH,
    CM1E_ERROR_CML_ANSWER,
    CM1E_ERROR_CML_TIMEOUT,
    CM1E_ERROR_CML_MOTION,
    CM1E_ERROR_CML_STRING,
    CM1E_ERROR_DRIVE_MODE_LOST,
    CM1E_ERROR_DRIVE_MODE_TIMEOUT,
    CM1E_ERROR_SDO_ABORT,
    CM1E_ERROR_BUS_MAILBOX,
    CM1E_ERROR_BUS_LOST,
    CM1E_ERROR_CANCELLED,
    CM1E_ERROR_STATE,
    CM1E_ERROR_FULL,
    CM1E_ERROR_INVALID_ARGUMENT,
    CM1E_OK,
};
static const block_member_t members_of_CM_SetMode[] = {
    MEMBER(CM_SetMode, Axis, IN_OUT, POINTER),
    MEMBER(CM_SetMode, Execute, INPUT, BOOL),
    MEMBER(CM_SetMode, Mode, INPUT, ENUM),
    MEMBER(CM_SetMode, Insist, INPUT, BOOL),
    MEMBER(CM_SetMode, Done, OUTPUT, BOOL),
    MEMBER(CM_SetMode, Busy, OUTPUT, BOOL),
    MEMBER(CM_SetMode, Error, OUTPUT, BOOL),
    MEMBER(CM_SetMode, ErrorID, OUTPUT, WORD),
};
static void call_CM_SetMode(void *fb) { CM_SetMode(fb); }
static const cm1e_error_t errors_of_CM_SetMode[] = {
    CM1E_ERROR_AXIS_VIRTUAL,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_OFFLINE,
    CM1E_ERROR_AXIS_ERROR_STOP,
    CM1E_ERROR_CM_NO_BRIDGE,
    CM1E_ERROR_CM_NOT_DISABLED,
    CM1E_ERROR_CM_MODE,
    CM1E_ERROR_DRIVE_MODE_TIMEOUT,
    CM1E_ERROR_DRIVE_FAULT,
    CM1E_ERROR_CANCELLED,
    CM1E_ERROR_INVALID_ARGUMENT,
    CM1E_OK,
};
static const block_member_t members_of_CM_Command[] = {
    MEMBER(CM_Command, Axis, IN_OUT, POINTER),
    MEMBER(CM_Command, Execute, INPUT, BOOL),
    MEMBER(CM_Command, Command, INPUT, ENUM),
    MEMBER(CM_Command, Timeout, INPUT, TIME),
    MEMBER(CM_Command, Done, OUTPUT, BOOL),
    MEMBER(CM_Command, Busy, OUTPUT, BOOL),
    MEMBER(CM_Command, Error, OUTPUT, BOOL),
    MEMBER(CM_Command, ErrorID, OUTPUT, WORD),
};
static void call_CM_Command(void *fb) { CM_Command(fb); }
static const cm1e_error_t errors_of_CM_Command[] = {
    CM1E_ERROR_AXIS_VIRTUAL,
    CM1E_ERROR_FB_AXIS_CHANGED,
    CM1E_ERROR_FB_AXIS_REF,
    CM1E_ERROR_AXIS_OFFLINE,
    CM1E_ERROR_CM_NO_BRIDGE,
    CM1E_ERROR_CM_MODE,
    CM1E_ERROR_CM_COMMAND,
    CM1E_ERROR_CM_SEARCH_TIMEOUT,
    CM1E_ERROR_CM_SEARCH,
    CM1E_ERROR_CANCELLED,
    CM1E_ERROR_BUSY,
    CM1E_ERROR_INVALID_ARGUMENT,
    CM1E_OK,
};
static const block_member_t members_of_TON[] = {
    MEMBER(TON, IN, INPUT, BOOL),
    MEMBER(TON, PT, INPUT, TIME),
    MEMBER(TON, Q, OUTPUT, BOOL),
    MEMBER(TON, ET, OUTPUT, TIME),
};
static void call_TON(void *fb) { TON(fb); }
static const cm1e_error_t errors_of_TON[] = {
    CM1E_OK,
};
static const block_member_t members_of_TOF[] = {
    MEMBER(TOF, IN, INPUT, BOOL),
    MEMBER(TOF, PT, INPUT, TIME),
    MEMBER(TOF, Q, OUTPUT, BOOL),
    MEMBER(TOF, ET, OUTPUT, TIME),
};
static void call_TOF(void *fb) { TOF(fb); }
static const cm1e_error_t errors_of_TOF[] = {
    CM1E_OK,
};
static const block_member_t members_of_TP[] = {
    MEMBER(TP, IN, INPUT, BOOL),
    MEMBER(TP, PT, INPUT, TIME),
    MEMBER(TP, Q, OUTPUT, BOOL),
    MEMBER(TP, ET, OUTPUT, TIME),
};
static void call_TP(void *fb) { TP(fb); }
static const cm1e_error_t errors_of_TP[] = {
    CM1E_OK,
};
static const block_member_t members_of_R_TRIG[] = {
    MEMBER(R_TRIG, CLK, INPUT, BOOL),
    MEMBER(R_TRIG, Q, OUTPUT, BOOL),
};
static void call_R_TRIG(void *fb) { R_TRIG(fb); }
static const cm1e_error_t errors_of_R_TRIG[] = {
    CM1E_OK,
};
static const block_member_t members_of_F_TRIG[] = {
    MEMBER(F_TRIG, CLK, INPUT, BOOL),
    MEMBER(F_TRIG, Q, OUTPUT, BOOL),
};
static void call_F_TRIG(void *fb) { F_TRIG(fb); }
static const cm1e_error_t errors_of_F_TRIG[] = {
    CM1E_OK,
};
static const block_member_t members_of_SR[] = {
    MEMBER(SR, S1, INPUT, BOOL),
    MEMBER(SR, R, INPUT, BOOL),
    MEMBER(SR, Q1, OUTPUT, BOOL),
};
static void call_SR(void *fb) { SR(fb); }
static const cm1e_error_t errors_of_SR[] = {
    CM1E_OK,
};
static const block_member_t members_of_RS[] = {
    MEMBER(RS, S, INPUT, BOOL),
    MEMBER(RS, R1, INPUT, BOOL),
    MEMBER(RS, Q1, OUTPUT, BOOL),
};
static void call_RS(void *fb) { RS(fb); }
static const cm1e_error_t errors_of_RS[] = {
    CM1E_OK,
};
static const block_member_t members_of_CTU[] = {
    MEMBER(CTU, CU, INPUT, BOOL),
    MEMBER(CTU, R, INPUT, BOOL),
    MEMBER(CTU, PV, INPUT, INT),
    MEMBER(CTU, Q, OUTPUT, BOOL),
    MEMBER(CTU, CV, OUTPUT, INT),
};
static void call_CTU(void *fb) { CTU(fb); }
static const cm1e_error_t errors_of_CTU[] = {
    CM1E_OK,
};
static const block_member_t members_of_CTD[] = {
    MEMBER(CTD, CD, INPUT, BOOL),
    MEMBER(CTD, LD, INPUT, BOOL),
    MEMBER(CTD, PV, INPUT, INT),
    MEMBER(CTD, Q, OUTPUT, BOOL),
    MEMBER(CTD, CV, OUTPUT, INT),
};
static void call_CTD(void *fb) { CTD(fb); }
static const cm1e_error_t errors_of_CTD[] = {
    CM1E_OK,
};
static const block_member_t members_of_CTUD[] = {
    MEMBER(CTUD, CU, INPUT, BOOL),
    MEMBER(CTUD, CD, INPUT, BOOL),
    MEMBER(CTUD, R, INPUT, BOOL),
    MEMBER(CTUD, LD, INPUT, BOOL),
    MEMBER(CTUD, PV, INPUT, INT),
    MEMBER(CTUD, QU, OUTPUT, BOOL),
    MEMBER(CTUD, QD, OUTPUT, BOOL),
    MEMBER(CTUD, CV, OUTPUT, INT),
};
static void call_CTUD(void *fb) { CTUD(fb); }
static const cm1e_error_t errors_of_CTUD[] = {
    CM1E_OK,
};

const block_t block_table[] = {
    BLOCK(MC_Power, NULL),
    BLOCK(MC_Home, rules_home),
    BLOCK(MC_Stop, rules_stop),
    BLOCK(MC_Halt, rules_halt),
    BLOCK(MC_MoveAbsolute, rules_discrete),
    BLOCK(MC_MoveRelative, rules_discrete),
    BLOCK(MC_MoveAdditive, rules_discrete),
    BLOCK(MC_MoveSuperimposed, rules_superimposed),
    BLOCK(MC_HaltSuperimposed, rules_halt_superimposed),
    BLOCK(MC_MoveVelocity, rules_continuous),
    BLOCK(MC_MoveContinuousAbsolute, rules_continuous),
    BLOCK(MC_MoveContinuousRelative, rules_continuous),
    BLOCK(MC_TorqueControl, rules_no_torque_mode),
    BLOCK(MC_PositionProfile, rules_discrete),
    BLOCK(MC_VelocityProfile, rules_continuous),
    BLOCK(MC_AccelerationProfile, rules_continuous),
    BLOCK(MC_Jog, NULL),
    BLOCK(CM_FollowPosition, rules_follow_position),
    BLOCK(MC_CamTableSelect, rules_any),
    BLOCK(MC_CamIn, rules_couple),
    BLOCK(MC_CamOut, rules_decouple),
    BLOCK(MC_GearIn, rules_couple),
    BLOCK(MC_GearOut, rules_decouple),
    BLOCK(MC_GearInPos, rules_couple),
    BLOCK(MC_PhasingAbsolute, rules_phasing),
    BLOCK(MC_PhasingRelative, rules_phasing),
    BLOCK(MC_CombineAxes, rules_couple),
    BLOCK(MC_AddAxisToGroup, NULL),
    BLOCK(MC_RemoveAxisFromGroup, NULL),
    BLOCK(MC_UngroupAllAxes, NULL),
    BLOCK(MC_GroupReadConfiguration, NULL),
    BLOCK(MC_GroupEnable, NULL),
    BLOCK(MC_GroupDisable, NULL),
    BLOCK(MC_GroupReset, NULL),
    BLOCK(MC_GroupReadStatus, NULL),
    BLOCK(MC_GroupReadError, NULL),
    BLOCK(MC_GroupStop, NULL),
    BLOCK(MC_GroupHalt, NULL),
    BLOCK(MC_GroupInterrupt, NULL),
    BLOCK(MC_GroupContinue, NULL),
    BLOCK(MC_MoveLinearAbsolute, NULL),
    BLOCK(MC_MoveLinearRelative, NULL),
    BLOCK(MC_MoveCircularAbsolute, NULL),
    BLOCK(MC_MoveCircularRelative, NULL),
    BLOCK(MC_MoveDirectAbsolute, NULL),
    BLOCK(MC_MoveDirectRelative, NULL),
    BLOCK(MC_GroupReadPosition, NULL),
    BLOCK(MC_GroupReadVelocity, NULL),
    BLOCK(MC_GroupSetOverride, NULL),
    BLOCK(MC_SetPosition, rules_any),
    BLOCK(MC_SetOverride, rules_any),
    BLOCK(MC_ReadParameter, rules_any),
    BLOCK(MC_ReadBoolParameter, rules_any),
    BLOCK(MC_WriteParameter, rules_any),
    BLOCK(MC_WriteBoolParameter, rules_any),
    BLOCK(MC_ReadDigitalInput, rules_any),
    BLOCK(MC_ReadDigitalOutput, rules_any),
    BLOCK(MC_WriteDigitalOutput, rules_any),
    BLOCK(MC_ReadActualPosition, rules_any),
    BLOCK(MC_ReadActualVelocity, rules_any),
    BLOCK(MC_ReadActualTorque, rules_any),
    BLOCK(MC_ReadStatus, rules_any),
    BLOCK(MC_ReadMotionState, rules_any),
    BLOCK(MC_ReadAxisInfo, rules_any),
    BLOCK(MC_ReadAxisError, rules_any),
    BLOCK(MC_Reset, NULL),
    BLOCK(MC_DigitalCamSwitch, rules_any),
    BLOCK(MC_TouchProbe, rules_any),
    BLOCK(MC_AbortTrigger, rules_any),
    BLOCK(MC_StepAbsoluteSwitch, rules_step),
    BLOCK(MC_StepLimitSwitch, rules_step),
    BLOCK(MC_StepBlock, rules_step),
    BLOCK(MC_StepReferencePulse, rules_no_such_signal),
    BLOCK(MC_StepDistanceCoded, rules_no_such_signal),
    BLOCK(MC_HomeDirect, rules_direct),
    BLOCK(MC_HomeAbsolute, rules_no_such_signal),
    BLOCK(MC_FinishHoming, rules_finish),
    BLOCK(MC_StepReferenceFlyingSwitch, rules_unsupported),
    BLOCK(MC_StepReferenceFlyingRefPulse, rules_no_such_signal),
    BLOCK(MC_AbortPassiveHoming, rules_unsupported),
    BLOCK(CM_SendCML, NULL),
    BLOCK(CM_SetMode, NULL),
    BLOCK(CM_Command, NULL),
    BLOCK(TON, NULL),
    BLOCK(TOF, NULL),
    BLOCK(TP, NULL),
    BLOCK(R_TRIG, NULL),
    BLOCK(F_TRIG, NULL),
    BLOCK(SR, NULL),
    BLOCK(RS, NULL),
    BLOCK(CTU, NULL),
    BLOCK(CTD, NULL),
    BLOCK(CTUD, NULL),
};
const size_t block_count = sizeof block_table / sizeof *block_table;
