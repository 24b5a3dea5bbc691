#include <stddef.h>

#include "cm1e/bus.h"

typedef struct cm1e_text {
    uint32_t code;
    const char *text;
} cm1e_text_t;

/** ETG.1000.6 table 41. */
static const cm1e_text_t abort_texts[] = {
    {0x05030000, "toggle bit not changed"},
    {0x05040000, "SDO protocol timeout"},
    {0x05040001, "client/server command specifier not valid or unknown"},
    {0x05040005, "out of memory"},
    {0x06010000, "unsupported access to an object"},
    {0x06010001, "attempt to read a write-only object"},
    {0x06010002, "attempt to write a read-only object"},
    {0x06010003, "sub-index cannot be written: sub-index 0 must be 0 for that"},
    {0x06010004, "complete access is not supported for this object"},
    {0x06010005, "object length exceeds the mailbox size"},
    {0x06010006, "object is mapped to an RxPDO: SDO download blocked"},
    {0x06020000, "the object does not exist in the object dictionary"},
    {0x06040041, "the object cannot be mapped into a PDO"},
    {0x06040042, "number and length of the mapped objects would exceed the PDO length"},
    {0x06040043, "general parameter incompatibility"},
    {0x06040047, "general internal incompatibility in the device"},
    {0x06060000, "access failed due to a hardware error"},
    {0x06070010, "data type does not match, length of service parameter does not match"},
    {0x06070012, "data type does not match, length of service parameter too high"},
    {0x06070013, "data type does not match, length of service parameter too low"},
    {0x06090011, "sub-index does not exist"},
    {0x06090030, "value range of parameter exceeded"},
    {0x06090031, "value of parameter written too high"},
    {0x06090032, "value of parameter written too low"},
    {0x06090033, "configured module list does not match the detected one"},
    {0x06090036, "maximum value is less than minimum value"},
    {0x08000000, "general error"},
    {0x08000020, "data cannot be transferred or stored to the application"},
    {0x08000021, "data cannot be transferred or stored to the application because of local control"},
    {0x08000022, "data cannot be transferred or stored to the application in the present device state"},
    {0x08000023, "object dictionary dynamic generation failed or no object dictionary is present"},
};

/** ETG.1000.6 table 11, ETG.1020. */
static const cm1e_text_t al_texts[] = {
    {0x0000, "no error"},
    {0x0001, "unspecified error"},
    {0x0002, "no memory"},
    {0x0003, "invalid device setup"},
    {0x0004, "invalid revision"},
    {0x0006, "SII/EEPROM information does not match the firmware"},
    {0x0007, "firmware update not successful"},
    {0x000E, "license error"},
    {0x0011, "invalid requested state change"},
    {0x0012, "unknown requested state"},
    {0x0013, "bootstrap not supported"},
    {0x0014, "no valid firmware"},
    {0x0015, "invalid mailbox configuration (bootstrap)"},
    {0x0016, "invalid mailbox configuration (Pre-Operational)"},
    {0x0017, "invalid sync manager configuration"},
    {0x0018, "no valid inputs available"},
    {0x0019, "no valid outputs"},
    {0x001A, "synchronization error"},
    {0x001B, "sync manager watchdog: no process data came in time"},
    {0x001C, "invalid sync manager types"},
    {0x001D, "invalid output configuration"},
    {0x001E, "invalid input configuration"},
    {0x001F, "invalid watchdog configuration"},
    {0x0020, "slave needs a cold start"},
    {0x0021, "slave needs Init"},
    {0x0022, "slave needs Pre-Operational"},
    {0x0023, "slave needs Safe-Operational"},
    {0x0024, "invalid input mapping"},
    {0x0025, "invalid output mapping"},
    {0x0026, "inconsistent settings"},
    {0x0027, "free run not supported"},
    {0x0028, "synchronous operation not supported"},
    {0x0029, "free run needs 3-buffer mode"},
    {0x002A, "background watchdog"},
    {0x002B, "no valid inputs and outputs"},
    {0x002C, "fatal synchronization error"},
    {0x002D, "no synchronization error: sync signal missing"},
    {0x002E, "cycle time too small"},
    {0x0030, "invalid DC SYNC configuration"},
    {0x0031, "invalid DC latch configuration"},
    {0x0032, "PLL error"},
    {0x0033, "DC sync I/O error"},
    {0x0034, "DC sync timeout error"},
    {0x0035, "DC invalid sync cycle time"},
    {0x0036, "DC SYNC0 cycle time"},
    {0x0037, "DC SYNC1 cycle time"},
    {0x0041, "mailbox AoE error"},
    {0x0042, "mailbox EoE error"},
    {0x0043, "mailbox CoE error"},
    {0x0044, "mailbox FoE error"},
    {0x0045, "mailbox SoE error"},
    {0x004F, "mailbox VoE error"},
    {0x0050, "EEPROM: no access"},
    {0x0051, "EEPROM error"},
    {0x0060, "slave restarted locally"},
    {0x0061, "device identification value updated"},
    {0x00F0, "application controller available"},
};

static const char *find(const cm1e_text_t *texts, size_t count, uint32_t code, const char *otherwise)
{
    for (size_t i = 0; i < count; i++) {
        if (texts[i].code == code)
            return texts[i].text;
    }
    return otherwise;
}

const char *cm1e_sdo_abort_text(uint32_t abort_code)
{
    return find(abort_texts, sizeof abort_texts / sizeof abort_texts[0], abort_code,
                "an abort code of the device's own");
}

const char *cm1e_al_status_text(uint16_t al_status_code)
{
    return find(al_texts, sizeof al_texts / sizeof al_texts[0], al_status_code, "a status code of the device's own");
}
