/* Pulses of distributed clocks, in step with the cycle of the bus. */
#include <math.h>
#include <stdio.h>

#include "config/ranges.h"

#define SYNC0_MINIMUM_US 62.5
#define PERIOD_MAXIMUM_US 1e6

const char *cm1e_config_wrong_pulses(const cm1e_bus_config_t *config, const cm1e_dc_config_t *dc,
                                     char text[CM1E_WRONG_PULSES])
{
    const double cycle_us = (config->cycle_time_ns ? (double)config->cycle_time_ns : 1e6) / 1000;
    const double part = dc->sync0_us > cycle_us ? dc->sync0_us / cycle_us : cycle_us / dc->sync0_us;
    if (!cm1e_config_has_pulses(dc))
        return NULL;
    if (!(dc->sync0_us >= SYNC0_MINIMUM_US && dc->sync0_us <= PERIOD_MAXIMUM_US) || part != floor(part)) {
        snprintf(text, CM1E_WRONG_PULSES, "is %g; expected the cycle time of %g us, a whole part of it from %g us on, "
                 "or a multiple up to 1 s", dc->sync0_us, cycle_us, SYNC0_MINIMUM_US);
        return "dc.sync0_us";
    }
    if (!(dc->sync1_us >= 0 && dc->sync1_us <= PERIOD_MAXIMUM_US)) {
        snprintf(text, CM1E_WRONG_PULSES, "is %g; expected 0 ... 1000000 us behind SYNC0", dc->sync1_us);
        return "dc.sync1_us";
    }
    if (dc->shift_us > -cycle_us && dc->shift_us < cycle_us)
        return NULL;
    snprintf(text, CM1E_WRONG_PULSES, "is %g; expected less than the cycle time of %g us to both sides", dc->shift_us,
             cycle_us);
    return "dc.shift_us";
}

bool cm1e_config_uses_clocks(const cm1e_bus_config_t *config)
{
    bool used = config->distributed_clocks;
    for (uint32_t i = 0; i < config->axis_count; i++)
        used |= cm1e_config_has_pulses(&config->axes[i].dc);
    for (uint32_t i = 0; i < config->slave_count; i++)
        used |= cm1e_config_has_pulses(&config->slaves[i].dc);
    return used;
}
