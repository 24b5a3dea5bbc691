#include "device/emergency_codes.h"

#include <stdio.h>
#include <string.h>

/* The classes of CiA 301 (table of emergency error codes), of CiA 402 and of ETG.1000.6 section 5.6.4. The narrower
 * class comes first. */
static const struct {
    uint16_t first, last;
    const char *text;
} classes[] = {
    {0x0000, 0x00FF, "no error, or error reset"},
    {0x1000, 0x10FF, "generic error"},
    {0x2100, 0x21FF, "current at the input of the device"},
    {0x2200, 0x22FF, "current inside the device"},
    {0x2300, 0x23FF, "current at the output of the device"},
    {0x2000, 0x2FFF, "current"},
    {0x3100, 0x31FF, "mains voltage"},
    {0x3200, 0x32FF, "voltage inside the device"},
    {0x3300, 0x33FF, "output voltage"},
    {0x3000, 0x3FFF, "voltage"},
    {0x4100, 0x41FF, "ambient temperature"},
    {0x4200, 0x42FF, "temperature of the device"},
    {0x4300, 0x43FF, "temperature of the drive"},
    {0x4400, 0x44FF, "temperature of the supply"},
    {0x4000, 0x4FFF, "temperature"},
    {0x5000, 0x5FFF, "hardware of the device"},
    {0x6100, 0x61FF, "internal software"},
    {0x6200, 0x62FF, "user software"},
    {0x6300, 0x63FF, "data set"},
    {0x6000, 0x6FFF, "software of the device"},
    {0x7100, 0x71FF, "power modules"},
    {0x7200, 0x72FF, "measurement"},
    {0x7300, 0x73FF, "sensor"},
    {0x7400, 0x74FF, "computation"},
    {0x7500, 0x75FF, "communication between modules"},
    {0x7600, 0x76FF, "data storage"},
    {0x7000, 0x7FFF, "additional modules"},
    {0x8100, 0x81FF, "monitoring of the communication"},
    {0x8200, 0x82FF, "protocol, or length of process data"},
    {0x8300, 0x83FF, "monitoring of the torque"},
    {0x8400, 0x84FF, "monitoring of the velocity"},
    {0x8500, 0x85FF, "monitoring of the position controller"},
    {0x8600, 0x86FF, "monitoring of the position"},
    {0x8700, 0x87FF, "monitoring of the synchronisation"},
    {0x8000, 0x8FFF, "monitoring"},
    {0x9000, 0x90FF, "external error"},
    {0xA000, 0xA000, "the transition from Pre-Operational to Safe-Operational failed"},
    {0xA001, 0xA001, "the transition from Safe-Operational to Operational failed"},
    {0xF000, 0xF0FF, "additional functions"},
    {0xFF00, 0xFFFF, "a code of the maker: it is in the manual of the device"},
};

const char *cm1e_emergency_class(uint16_t code)
{
    for (size_t i = 0; i < sizeof classes / sizeof classes[0]; i++)
        if (code >= classes[i].first && code <= classes[i].last)
            return classes[i].text;
    return "a code that no standard has: look into the manual of the device";
}

void cm1e_error_register_text(uint8_t error_register, char *text, size_t size)
{
    static const char *const bits[8] = { /* object 0x1001 (CiA 301) */
        "generic error", "current", "voltage", "temperature", "communication", "device profile", "reserved bit 6",
        "maker's own",
    };
    text[0] = 0;
    for (size_t bit = 0; bit < 8; bit++) {
        const size_t used = strlen(text);
        if (error_register >> bit & 1)
            snprintf(text + used, size - used, "%s%s", used ? ", " : "", bits[bit]);
    }
}
