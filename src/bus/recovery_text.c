/* Why a slave that answers was not brought back, in words. */
#include <stddef.h>

#include "bus/recovery.h"

const char *cm1e_recovery_reason(cm1e_recovery_step_t step)
{
    static const char *const reasons[RECOVERY_STEPS] = {
        [RECOVERY_INIT] = "it does not go to Init", [RECOVERY_PRE_OP] = "it does not go to Pre-Operational",
        [RECOVERY_ID] = "its explicit device ID is another one",
        [RECOVERY_VENDOR] = "its vendor (0x1018:1) is not that of its EEPROM",
        [RECOVERY_PRODUCT] = "its product code (0x1018:2) is not that of its EEPROM",
        [RECOVERY_SERIAL] = "its serial number (0x1018:4) is not that of its EEPROM",
        [RECOVERY_OBJECTS] = "it is not of the expected kind, or its motors are others",
        [RECOVERY_VERSION] = "its firmware is not the expected one",
        [RECOVERY_SETUP] = "it does not take what the configuration writes into it",
        [RECOVERY_MAPPING] = "its PDO mapping cannot be used, or is another one than before",
        [RECOVERY_SAFE_OP] = "it does not go to Safe-Operational",
        [RECOVERY_SETUP_OP] = "it does not take what the configuration writes into it",
        [RECOVERY_OP] = "it does not go to Operational",
    };
    return reasons[step] ? reasons[step] : "it cannot be configured";
}

const char *cm1e_recovery_failure(const cm1e_recovery_t *recovery)
{
    const cm1e_recovery_step_t step = recovery->failed_at;
    return step >= RECOVERY_EEPROM && step < RECOVERY_RELEASE ? cm1e_recovery_reason(step) : NULL;
}
