/* Pulses of distributed clocks, in step with the cycle of the bus. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "config/clock_pulses.h"
#include "config/ranges.h"

#define SYNC0_MINIMUM_US 62.5
#define PERIOD_MAXIMUM_US 1e6

static const char *wrong_shift(const cm1e_dc_config_t *dc, double cycle_us, char text[CM1E_WRONG_PULSES])
{
    if (dc->shift_us > -cycle_us && dc->shift_us < cycle_us)
        return NULL;
    snprintf(text, CM1E_WRONG_PULSES, "is %g; expected less than the cycle time of %g us to both sides", dc->shift_us,
             cycle_us);
    return "dc.shift_us";
}

const char *cm1e_config_wrong_pulses(const cm1e_bus_config_t *config, const cm1e_dc_config_t *dc,
                                     char text[CM1E_WRONG_PULSES])
{
    const double cycle_us = (config->cycle_time_ns ? (double)config->cycle_time_ns : 1e6) / 1000;
    const double part = dc->sync0_us > cycle_us ? dc->sync0_us / cycle_us : cycle_us / dc->sync0_us;
    if (!cm1e_config_has_pulses(dc))
        return NULL;
    if (!memchr(dc->mode, 0, sizeof dc->mode)) {
        snprintf(text, CM1E_WRONG_PULSES, "is not a text that ends within %zu bytes", sizeof dc->mode);
        return "dc.mode";
    }
    if (dc->mode[0] && (dc->sync0_us != 0 || dc->sync1_us != 0)) {
        snprintf(text, CM1E_WRONG_PULSES, "is given together with sync0_us or sync1_us; expected either the name of a "
                 "mode, which has both, or the periods");
        return "dc.mode";
    }
    if (dc->mode[0])
        return wrong_shift(dc, cycle_us, text);
    if (!(dc->sync0_us >= SYNC0_MINIMUM_US && dc->sync0_us <= PERIOD_MAXIMUM_US) || part != floor(part)) {
        snprintf(text, CM1E_WRONG_PULSES, "is %g; expected the cycle time of %g us, a whole part of it from %g us on, "
                 "or a multiple up to 1 s", dc->sync0_us, cycle_us, SYNC0_MINIMUM_US);
        return "dc.sync0_us";
    }
    if (!(dc->sync1_us >= 0 && dc->sync1_us <= PERIOD_MAXIMUM_US)) {
        snprintf(text, CM1E_WRONG_PULSES, "is %g; expected 0 ... 1000000 us behind SYNC0", dc->sync1_us);
        return "dc.sync1_us";
    }
    return wrong_shift(dc, cycle_us, text);
}

/* ---- operation modes --------------------------------------------------------------------------------------------- */

enum { ACTIVATES_SYNC0 = 0x0200, ACTIVATES_SYNC1 = 0x0400 };

bool cm1e_config_mode_has_sync0(const cm1e_dc_facts_t *facts) { return facts->assign_activate & ACTIVATES_SYNC0; }

static double times(double value, int32_t factor)
{
    return factor > 0 ? value * factor : factor < 0 ? value / -(double)factor : value;
}

/* Register 0x09A4 holds what SYNC1 is behind its first SYNC0: with a factor it waits for further ones (ETG.1000.4). */
cm1e_dc_config_t cm1e_config_pulses_of_mode(const cm1e_dc_facts_t *facts, double shift_us, int64_t cycle_time_ns)
{
    const double cycle_us = (double)cycle_time_ns / 1000;
    const double behind_us = (double)facts->sync1_shift_ns / 1000;
    cm1e_dc_config_t pulses = {0};
    if (!cm1e_config_mode_has_sync0(facts))
        return pulses;
    pulses.sync0_us = facts->sync0_cycle_ns > 0 ? (double)facts->sync0_cycle_ns / 1000
                                                : times(cycle_us, facts->sync0_factor);
    pulses.shift_us = (shift_us != 0 ? shift_us : cycle_us / 2) + (double)facts->sync0_shift_ns / 1000;
    if (facts->assign_activate & ACTIVATES_SYNC1)
        pulses.sync1_us = (facts->sync1_factor > 1 ? facts->sync1_factor - 1 : 0) * pulses.sync0_us + behind_us;
    return pulses;
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
