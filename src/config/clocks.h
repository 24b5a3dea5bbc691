/**
 * @file config/clocks.h
 * Which distributed clocks a configuration asks for.
 */
#ifndef CM1E_CONFIG_CLOCKS_H
#define CM1E_CONFIG_CLOCKS_H

#include "cm1e/config.h"

/** Any of its keys is given. */
static inline bool cm1e_config_has_pulses(const cm1e_dc_config_t *dc)
{
    return dc->sync0_us != 0 || dc->sync1_us != 0 || dc->shift_us != 0;
}
/** The clocks of the bus are to be used. */
bool cm1e_config_uses_clocks(const cm1e_bus_config_t *config);

#endif
