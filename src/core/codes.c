#include "core/codes.h"

#include "cm1e/foe.h"

/* CM1E_SDO_ABORT_CLAUSE */
static const cm1e_code_t abort_texts[] = {
    {0x05030000, "toggle bit not changed",
     "repeat the transfer; if it comes back, look at the cable and for a second master"},
    {0x05040000, "SDO protocol timeout",
     "the slave was waiting for the master: repeat the transfer, and look for lost frames"},
    {0x05040001, "client/server command specifier not valid or unknown",
     "the slave does not know this kind of transfer: update its firmware, or transfer without complete access"},
    {0x05040005, "out of memory", "repeat it later, with fewer transfers at once"},
    {0x06010000, "unsupported access to an object", "look up the access of the object: cm1e sdo list"},
    {0x06010001, "attempt to read a write-only object", "the object can only be written"},
    {0x06010002, "attempt to write a read-only object",
     "the object can only be read; or it can be written in Pre-Operational only (cm1e sdo list shows the access)"},
    {0x06010003, "sub-index cannot be written: sub-index 0 must be 0 for that",
     "write 0 to sub-index 0 first, then the others, then their number to sub-index 0"},
    {0x06010004, "complete access is not supported for this object", "transfer its sub-indexes one by one"},
    {0x06010005, "object length exceeds the mailbox size", "transfer less at once"},
    {0x06010006, "object is mapped to an RxPDO: SDO download blocked",
     "its value comes with the process data: write it there, or use a mapping without it"},
    {0x06020000, "the object does not exist in the object dictionary",
     "check the index; a firmware or a model may lack the object (cm1e sdo list)"},
    {0x06040041, "the object cannot be mapped into a PDO",
     "map another object: cm1e sdo list shows which can be mapped"},
    {0x06040042, "number and length of the mapped objects would exceed the PDO length",
     "map fewer objects, or shorter ones"},
    {0x06040043, "general parameter incompatibility", "check the value against the guide of the device"},
    {0x06040047, "general internal incompatibility in the device",
     "switch the device off and on; if it comes back, ask its maker"},
    {0x06060000, "access failed due to a hardware error", "switch the device off and on; if it comes back, replace it"},
    {0x06070010, "data type does not match, length of service parameter does not match",
     "write the size that cm1e sdo list shows for the object"},
    {0x06070012, "data type does not match, length of service parameter too high",
     "write the size that cm1e sdo list shows for the object"},
    {0x06070013, "data type does not match, length of service parameter too low",
     "write the size that cm1e sdo list shows for the object"},
    {0x06090011, "sub-index does not exist", "check the sub-index: cm1e sdo list shows which the object has"},
    {0x06090030, "value range of parameter exceeded",
     "write a value within the range of the object: cm1e params list shows those of a CM1-E"},
    {0x06090031, "value of parameter written too high",
     "write a smaller value: cm1e params list shows the ranges of a CM1-E"},
    {0x06090032, "value of parameter written too low",
     "write a larger value: cm1e params list shows the ranges of a CM1-E"},
    {0x06090033, "configured module list does not match the detected one",
     "make the configured module list the detected one"},
    {0x06090036, "maximum value is less than minimum value", "write the maximum first"},
    {0x08000000, "general error", "check the value and the state of the device; then switch it off and on"},
    {0x08000020, "data cannot be transferred or stored to the application",
     "repeat it; disable the drive first, or use another EtherCAT state"},
    {0x08000021, "data cannot be transferred or stored to the application because of local control",
     "end local control of the device first"},
    {0x08000022, "data cannot be transferred or stored to the application in the present device state",
     "disable the drive, or bring the slave to Pre-Operational, and write then"},
    {0x08000023, "object dictionary dynamic generation failed or no object dictionary is present",
     "restart the device; its firmware may be damaged"},
};

/* CM1E_AL_STATUS_CLAUSE */
static const cm1e_code_t al_texts[] = {
    {0x0000, "no error", ""},
    {0x0001, "unspecified error", "look into the log or the guide of the device; then switch it off and on"},
    {0x0002, "no memory", "switch the device off and on; map fewer objects"},
    {0x0003, "invalid device setup", "check the modules and settings of the device"},
    {0x0004, "invalid revision", "use the device description of this revision"},
    {0x0006, "SII/EEPROM information does not match the firmware",
     "write the SII that belongs to the firmware: cm1e generate sii, cm1e sii write"},
    {0x0007, "firmware update not successful", "repeat the update of the firmware"},
    {0x000E, "license error", "get a licence from the maker of the device"},
    {0x0011, "invalid requested state change",
     "go by way of the states between: Init, Pre-Operational, Safe-Operational, Operational"},
    {0x0012, "unknown requested state", "the master is wrong: it requested a state that EtherCAT does not have"},
    {0x0013, "bootstrap not supported", "the device has no Bootstrap: update it as its maker says"},
    {0x0014, "no valid firmware", "load a firmware"},
    {0x0015, "invalid mailbox configuration (bootstrap)", "use the mailbox sizes for Bootstrap of the SII"},
    {0x0016, "invalid mailbox configuration (Pre-Operational)",
     "use the mailbox sizes of the SII: cm1e check, cm1e diff compare a description with the device"},
    {0x0017, "invalid sync manager configuration",
     "sync managers do not fit the mapping: read the mapping of the device, as this library does; cm1e diff shows it"},
    {0x0018, "no valid inputs available", "wait until the device has inputs; look at its own error"},
    {0x0019, "no valid outputs",
     "outputs must come before and in Operational: send process data in every cycle from Safe-Operational on"},
    {0x001A, "synchronization error", "look at the jitter of the master and at the cycle time of the device"},
    {0x001B, "sync manager watchdog: no process data came in time",
     "the master was too slow or its frames were lost: look at overruns, cable and watchdog time; then start again"},
    {0x001C, "invalid sync manager types", "use the sync manager types of the SII"},
    {0x001D, "invalid output configuration",
     "the outputs that the master maps are not those of the device: cm1e diff shows the difference"},
    {0x001E, "invalid input configuration",
     "the inputs that the master maps are not those of the device: cm1e diff shows the difference"},
    {0x001F, "invalid watchdog configuration", "set a watchdog time that the device takes"},
    {0x0020, "slave needs a cold start", "switch the device off and on"},
    {0x0021, "slave needs Init", "bring the slave to Init, then up again"},
    {0x0022, "slave needs Pre-Operational", "bring the slave to Pre-Operational, then up again"},
    {0x0023, "slave needs Safe-Operational", "bring the slave to Safe-Operational, then up again"},
    {0x0024, "invalid input mapping", "check the objects in 0x1C13 and in its mappings"},
    {0x0025, "invalid output mapping", "check the objects in 0x1C12 and in its mappings"},
    {0x0026, "inconsistent settings", "check the settings against each other; restart the device"},
    {0x0027, "free run not supported", "use a synchronous mode of operation"},
    {0x0028, "synchronous operation not supported", "use free run"},
    {0x0029, "free run needs 3-buffer mode", "use a device or a mode with three buffers"},
    {0x002A, "background watchdog", "switch the device off and on; if it comes back, update its firmware"},
    {0x002B, "no valid inputs and outputs", "look at the device's own error; switch it off and on"},
    {0x002C, "fatal synchronization error", "look at the SYNC signals and the jitter of the master; then start again"},
    {0x002D, "no synchronization error: sync signal missing",
     "check the distributed clocks of the configuration: SYNC0 does not come"},
    {0x002E, "cycle time too small", "use a longer cycle time: the CM1-E takes 200, 250, 500 and 1000 us"},
    {0x0030, "invalid DC SYNC configuration", "check the settings of distributed clocks in the master"},
    {0x0031, "invalid DC latch configuration", "check the settings of the latch inputs in the master"},
    {0x0032, "PLL error", "reduce the jitter of the master; wait for the clocks to settle before Operational"},
    {0x0033, "DC sync I/O error", "check the settings of distributed clocks; start again"},
    {0x0034, "DC sync timeout error",
     "SYNC signals or frames are missing: look at lost frames and at the start of the clocks"},
    {0x0035, "DC invalid sync cycle time", "use a SYNC cycle time that the device takes"},
    {0x0036, "DC SYNC0 cycle time", "use a SYNC0 cycle time that the device takes"},
    {0x0037, "DC SYNC1 cycle time", "use a SYNC1 cycle time that the device takes"},
    {0x0041, "mailbox AoE error", "check the AoE request of the master"},
    {0x0042, "mailbox EoE error", "check the EoE request of the master"},
    {0x0043, "mailbox CoE error", "check the CoE start-up commands of the master"},
    {0x0044, "mailbox FoE error", "repeat the file transfer"},
    {0x0045, "mailbox SoE error", "check the SoE request of the master"},
    {0x004F, "mailbox VoE error", "check the VoE request of the master"},
    {0x0050, "EEPROM: no access",
     "the EEPROM is assigned to somebody else: end the other master, switch the device off and on"},
    {0x0051, "EEPROM error", "read the EEPROM with cm1e sii read and compare it; write a good one"},
    {0x0060, "slave restarted locally",
     "the device has restarted by itself: look at its supply, then start the bus again"},
    {0x0061, "device identification value updated",
     "the rotary switches or the alias have changed: switch the device off and on"},
    {0x0070, "detected and configured modules differ",
     "compare 0xF050 with 0xF030, and `modules` of the bus file with what is plugged in"},
    {0x00F0, "application controller available", "nothing: the device says that its controller runs"},
};

enum { ABORTS = sizeof abort_texts / sizeof abort_texts[0], AL_CODES = sizeof al_texts / sizeof al_texts[0] };

const cm1e_code_t *cm1e_sdo_abort_codes(size_t *count)
{
    *count = ABORTS;
    return abort_texts;
}

/* CM1E_FOE_ERROR_CLAUSE */
static const cm1e_code_t foe_texts[] = {
    {0x8000, "not defined", "look at the text that the slave sends with it"},
    {0x8001, "file not found", "the slave knows the file by another name: --name; its manual has the names"},
    {0x8002, "access denied (wrong password?)", "give the password that the maker states: --password"},
    {0x8003, "memory full", "the file is too large for the slave: take the right one"},
    {0x8004, "illegal request", "repeat it; if it comes back, switch the slave off and on"},
    {0x8005, "wrong packet number", "repeat it; if it comes back, look for a second master"},
    {0x8006, "the file exists already", "give it another name, or remove it as the maker says"},
    {0x8007, "no user", "the slave wants a user to log in: do that as its maker says"},
    {0x8008, "in Bootstrap only", "transfer the file in Bootstrap: cm1e foe --bootstrap, or cm1e firmware update"},
    {0x8009, "not in Bootstrap", "transfer the file in Pre-Operational: without --bootstrap"},
    {0x800A, "no rights", "give the password that the maker states: --password"},
    {0x800B, "error of the program", "switch the slave off and on; if it comes back, ask its maker"},
    {0x800C, "wrong checksum", "the file is damaged: get it anew"},
    {0x800D, "not a firmware for this device", "take the firmware of this device and this hardware"},
    {0x800E, "unknown", "look at the text that the slave sends with it"},
    {0x800F, "no file to read", "the slave has no such file yet: write it first"},
    {0x8010, "the header of the file is missing", "the file is no file for this device: take the maker's"},
    {0x8011, "fault of the flash memory", "repeat it; if it comes back, the slave is defective"},
    {0x8012, "the file does not fit", "take the file for this device and this hardware"},
};
enum { FOE_CODES = sizeof foe_texts / sizeof foe_texts[0] };

const cm1e_code_t *cm1e_foe_error_codes(size_t *count)
{
    *count = FOE_CODES;
    return foe_texts;
}

const cm1e_code_t *cm1e_al_status_codes(size_t *count)
{
    *count = AL_CODES;
    return al_texts;
}

static const char *find(const cm1e_code_t *texts, size_t count, uint32_t code, const char *otherwise)
{
    for (size_t i = 0; i < count; i++) {
        if (texts[i].code == code)
            return texts[i].text;
    }
    return otherwise;
}

const char *cm1e_sdo_abort_text(uint32_t abort_code)
{
    return find(abort_texts, ABORTS, abort_code,
                "an abort code of the device's own");
}

const char *cm1e_al_status_text(uint16_t al_status_code)
{
    return find(al_texts, AL_CODES, al_status_code, "a status code of the device's own");
}

const char *cm1e_foe_error_text(uint32_t code) { return find(foe_texts, FOE_CODES, code, "unknown"); }
