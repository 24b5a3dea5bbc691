/**
 * @file switches.h
 * The switches of an axis, and the inputs to which they are wired.
 */
#ifndef CM1E_CONFIG_SWITCHES_H
#define CM1E_CONFIG_SWITCHES_H

#include "cm1e/config.h"

enum { CM1E_SWITCHES = 3 };

typedef struct cm1e_switch {
    int input;        /**< 0: there is none */
    const char *name;
    bool closed;      /**< normally closed */
} cm1e_switch_t;

static inline void cm1e_switches_of(const cm1e_input_config_t *inputs, cm1e_switch_t switches[CM1E_SWITCHES])
{
    switches[0] = (cm1e_switch_t){inputs->home, "home switch", inputs->home_normally_closed};
    switches[1] = (cm1e_switch_t){inputs->limit_positive, "positive limit switch", inputs->limits_normally_closed};
    switches[2] = (cm1e_switch_t){inputs->limit_negative, "negative limit switch", inputs->limits_normally_closed};
}

#endif
