#include "device/device.h"

#include <string.h>

/* UG 4.3 */
const int64_t cm1e_device_cycle_times_ns[4] = {200000, 250000, 500000, 1000000};

/* UG 3.2 table 1 and UG 6.3. UG 6.2.6 gives 1,666,667 for the 23L20D; the smaller number can never be exceeded. */
const cm1e_motor_t cm1e_device_motors[4] = {
    {"CM1-E-17S30D", 0.117, 1.0, 2500000},
    {"CM1-E-17L30D", 0.54, 1.8, 2500000},
    {"CM1-E-23S30D", 0.46, 5.1, 2500000},
    {"CM1-E-23L20D", 1.24, 3.4, 1666666},
};

const cm1e_motor_t *cm1e_device_motor(const char *name)
{
    if (!name || name[0] == '\0')
        return &cm1e_device_motors[0];
    for (size_t i = 0; i < sizeof cm1e_device_motors / sizeof cm1e_device_motors[0]; i++)
        if (strcmp(cm1e_device_motors[i].name, name) == 0)
            return &cm1e_device_motors[i];
    return NULL;
}
