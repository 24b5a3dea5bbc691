/**
 * @file config/clock_pulses.h
 * Which distributed clocks a configuration asks for.
 */
#ifndef CM1E_CONFIG_CLOCK_PULSES_H
#define CM1E_CONFIG_CLOCK_PULSES_H

#include "cm1e/config.h"

/** Any of its keys is given. */
static inline bool cm1e_config_has_pulses(const cm1e_dc_config_t *dc)
{
    return dc->sync0_us != 0 || dc->sync1_us != 0 || dc->shift_us != 0 || dc->mode[0] != 0;
}

/** What an operation mode states of its pulses: OpMode of an ESI (ETG.2000), or an entry of category 60 of an SII
 *  (ETG.2010). */
typedef struct cm1e_dc_facts {
    uint16_t assign_activate;  /**< registers 0x0980, 0x0981 */
    int64_t sync0_cycle_ns;    /**< 0: the cycle time times the factor */
    int32_t sync0_factor;      /**< negative: a part of the cycle time; 0 is 1 */
    int64_t sync0_shift_ns;
    int32_t sync1_factor;      /**< SYNC1 comes with every so many SYNC0; 0 is 1 */
    int64_t sync1_shift_ns;    /**< behind that SYNC0 */
} cm1e_dc_facts_t;
/** The mode runs by SYNC0. */
bool cm1e_config_mode_has_sync0(const cm1e_dc_facts_t *facts);
/** The pulses that a mode asks for at this cycle time; all zero: it has none. The shift of the mode is added to
 *  `shift_us` of the configuration, 0: to half a cycle time. */
cm1e_dc_config_t cm1e_config_pulses_of_mode(const cm1e_dc_facts_t *facts, double shift_us, int64_t cycle_time_ns);

/** The clocks of the bus are to be used. */
bool cm1e_config_uses_clocks(const cm1e_bus_config_t *config);

#endif
