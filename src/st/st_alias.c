/* Inputs that have another name in TwinCAT's library Tc2_MC2. */
#include <strings.h>

#include "st/st_state.h"

static const struct { const char *block, *name, *ours, *hint; } aliases[] = {
    {"MC_Power", "Enable_Positive", "EnablePositive", NULL},
    {"MC_Power", "Enable_Negative", "EnableNegative", NULL},
    {"MC_Power", "Active", "Status", NULL},
    {"MC_Power", "Busy", "Valid", NULL},
    {"MC_Home", "HomingMode", NULL, "the bus file says how the axis is homed"},
    {"AXIS_REF", "NcToPlc", NULL, "some of its members are known, as NcToPlc.ActPos; it is not as a whole"},
    {"AXIS_REF", "PlcToNc", NULL, "command the axis by function blocks"},
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
