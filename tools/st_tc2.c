/* What programs for TwinCAT read of an axis without a block, and the input Override of its MC_Power. Programs that were
 * translated from Structured Text find these functions in the command that loads them; st_runtime.h declares them too. */
#include "core/tc2_axis.h"

#include <math.h>

#include "cm1e/axis.h"
#include "cm1e/plcopen.h"

/** A member of NcToPlc or Status of an axis, by its row in core/tc2_axis.h; 0: there is no such axis. @rt cycle */
CM1E_API LREAL cm1e_tc2_axis_value(UINT handle, UINT number);
/** The velocity of all commands in percent, 0 ... 100. @rt cycle */
CM1E_API void cm1e_tc2_override(UINT handle, LREAL percent);

LREAL cm1e_tc2_axis_value(UINT handle, UINT number)
{
    cm1e_axis_info_t i = {0};
    UINT row = 0;
    if (cm1e_axis_read((AXIS_REF_t){handle}, &i) != CM1E_OK)
        return 0;
#define ROW(group, name, type, value) if (row++ == number) return (LREAL)(value);
    CM1E_TC2_AXIS(ROW)
    return 0;
}

void cm1e_tc2_override(UINT handle, LREAL percent)
{
    AXIS_REF_t axis = {handle};
    MC_SetOverride_t block = {.Axis = &axis, .Enable = TRUE, .VelFactor = fmin(fmax(percent, 0), 100) / 100, .AccFactor = 1,
                              .JerkFactor = 1};
    MC_SetOverride(&block); /* its factors act at once and stay, and a new block in every cycle is a level */
}
