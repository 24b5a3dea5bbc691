/**
 * @file sensors.h
 * The sensors of a simulated axis, wired to the motor's inputs 2 and 3, and the inputs that the console holds. @rt
 * cycle.
 */
#ifndef CM1E_SIM_SENSORS_H
#define CM1E_SIM_SENSORS_H

#include <stdbool.h>
#include <stdint.h>

#include "cm1e/config.h"

enum { CM1E_SIM_INPUT_2 = 0x02, CM1E_SIM_INPUT_3 = 0x04 };

typedef struct cm1e_sim_sensors {
    double edges[2];         /**< IN2, IN3: counts on the scale of the mechanics, on beyond it, away from 0 */
    bool none;               /**< nothing is wired */
    uint8_t held, values;    /**< inputs that the console holds, and how; bit 0: input 1 */
} cm1e_sim_sensors_t;

void cm1e_sim_sensors_init(cm1e_sim_sensors_t *sensors, const cm1e_sim_axis_config_t *config);
/** Bit 0: input 1. */
uint8_t cm1e_sim_sensors_inputs(const cm1e_sim_sensors_t *sensors, double position);
/** Position at which input 2 or 3 switches; NAN: none, because the console holds it. */
double cm1e_sim_sensors_edge(const cm1e_sim_sensors_t *sensors, unsigned input);
/** Holds an input on or off, or lets it follow its sensor again. */
void cm1e_sim_sensors_hold(cm1e_sim_sensors_t *sensors, uint8_t input, bool held, bool on);

#endif
