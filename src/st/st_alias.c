/* Inputs and outputs that have another name in TwinCAT's library Tc2_MC2, or in the standard library of TwinCAT and
 * CODESYS, and what programs for these look for in vain. */
#include <strings.h>

#include "st/st_state.h"

static const struct { const char *block, *name, *ours, *hint; } aliases[] = {
    {"MC_Power", "Enable_Positive", "EnablePositive", NULL},
    {"MC_Power", "Enable_Negative", "EnableNegative", NULL},
    {"MC_Power", "Active", "Status", NULL},
    {"MC_Power", "Busy", "Valid", NULL},
    {"MC_Power", "bRegulatorOn", NULL, "Enable switches the power on"},
    {"MC_Power", "bDriveStart", NULL, "EnablePositive and EnableNegative permit motion"},
    {"MC_Power", "bRegulatorRealState", NULL, "Status is TRUE while the power is on"},
    {"MC_Power", "bDriveStartRealState", NULL, "Status is TRUE while set-points act"},
    {"MC_SetPosition", "Mode", "Relative", NULL},
    {"MC_ReadActualVelocity", "ActualVelocity", "Velocity", NULL},
    {"MC_ReadStatus", "ConstantVelocity", NULL, "MC_ReadMotionState has it"},
    {"MC_ReadStatus", "Accelerating", NULL, "MC_ReadMotionState has it"},
    {"MC_ReadStatus", "Decelerating", NULL, "MC_ReadMotionState has it"},
    {"MC_Home", "HomingMode", NULL, "the bus file says how the axis is homed"},
    {"AXIS_REF", "nAxisState", NULL, "MC_ReadStatus shows the state"},
    {"AXIS_REF", "fActPosition", NULL, "NcToPlc.ActPos, or MC_ReadActualPosition"},
    {"AXIS_REF", "fSetPosition", NULL, "NcToPlc.SetPos"},
    {"AXIS_REF", "fActVelocity", NULL, "NcToPlc.ActVelo, or MC_ReadActualVelocity"},
    {"AXIS_REF", "fSetVelocity", NULL, "NcToPlc.SetVelo"},
    {"AXIS_REF", "bError", NULL, "Status.Error"},
    {"AXIS_REF", "dwErrorID", NULL, "NcToPlc.ErrorCode, or MC_ReadAxisError"},
    {"AXIS_REF", "NcToPlc", NULL, "some of its members are known, as NcToPlc.ActPos; it is not as a whole"},
    {"AXIS_REF", "PlcToNc", NULL, "command the axis by function blocks"},
    {"CTU", "RESET", "R", NULL}, {"CTD", "LOAD", "LD", NULL}, {"CTUD", "RESET", "R", NULL},
    {"CTUD", "LOAD", "LD", NULL},
    {"SR", "SET1", "S1", NULL}, {"SR", "RESET", "R", NULL}, {"RS", "SET", "S", NULL}, {"RS", "RESET1", "R1", NULL},
    {"LEN", "STR", "IN", NULL}, {"LEFT", "STR", "IN", NULL}, {"LEFT", "SIZE", "L", NULL}, {"RIGHT", "STR", "IN", NULL},
    {"RIGHT", "SIZE", "L", NULL}, {"MID", "STR", "IN", NULL}, {"MID", "LEN", "L", NULL}, {"MID", "POS", "P", NULL},
    {"CONCAT", "STR1", "IN1", NULL}, {"CONCAT", "STR2", "IN2", NULL}, {"INSERT", "STR1", "IN1", NULL},
    {"INSERT", "STR2", "IN2", NULL}, {"INSERT", "POS", "P", NULL}, {"DELETE", "STR", "IN", NULL},
    {"DELETE", "LEN", "L", NULL}, {"DELETE", "POS", "P", NULL}, {"REPLACE", "STR1", "IN1", NULL},
    {"REPLACE", "STR2", "IN2", NULL}, {"FIND", "STR1", "IN1", NULL}, {"FIND", "STR2", "IN2", NULL},
    {"", "__NEW", NULL, "memory is not allocated while a program runs; declare a variable"},
    {"", "__DELETE", NULL, "memory is not allocated while a program runs"},
    {"", "__QUERYINTERFACE", NULL, "keep a variable of the other interface beside this one"},
    {"", "__QUERYPOINTER", NULL, "keep a reference to the instance"},
    {"", "MEMCPY", NULL, "assign the whole variable, array or structure"},
    {"", "MEMMOVE", NULL, "assign the whole variable, array or structure"},
    {"", "MEMSET", NULL, "assign a variable of the same type that has its initial value"},
    {"AXIS_REF", "Status", NULL, "some of its members are known, as Status.Error; it is not as a whole"},
};

const char *cm1e_st_alias(const char *block, const char *name, const char **hint)
{
    *hint = NULL;
    for (size_t i = 0; i < sizeof aliases / sizeof aliases[0]; i++)
        if (strcasecmp(aliases[i].block, block) == 0 && strcasecmp(aliases[i].name, name) == 0) {
            *hint = aliases[i].hint;
            return aliases[i].ours;
        }
    return NULL;
}
