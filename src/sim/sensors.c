#include "sim/sensors.h"

#include <math.h>

/* cm1e_sim_axis_config_t's defaults. */
#define DEFAULT_EDGE 150000.0

void cm1e_sim_sensors_init(cm1e_sim_sensors_t *sensors, const cm1e_sim_axis_config_t *config)
{
    *sensors = (cm1e_sim_sensors_t){
        .edges = {config->sensor_input2 != 0 ? config->sensor_input2 : DEFAULT_EDGE,
                  config->sensor_input3 != 0 ? config->sensor_input3 : -DEFAULT_EDGE},
        .none = config->no_sensors,
    };
}

static bool beyond(double position, double edge) { return edge < 0 ? position <= edge : position >= edge; }

uint8_t cm1e_sim_sensors_inputs(const cm1e_sim_sensors_t *sensors, double position)
{
    unsigned inputs = 0;
    if (!sensors->none)
        inputs = (beyond(position, sensors->edges[0]) ? CM1E_SIM_INPUT_2 : 0u) |
                 (beyond(position, sensors->edges[1]) ? CM1E_SIM_INPUT_3 : 0u);
    return (uint8_t)((inputs & ~(unsigned)sensors->held) | sensors->values);
}

double cm1e_sim_sensors_edge(const cm1e_sim_sensors_t *sensors, unsigned input)
{
    return sensors->held & input ? NAN : sensors->edges[input == CM1E_SIM_INPUT_2 ? 0 : 1];
}

void cm1e_sim_sensors_hold(cm1e_sim_sensors_t *sensors, uint8_t input, bool held, bool on)
{
    sensors->held = (uint8_t)(held ? sensors->held | input : sensors->held & ~input);
    sensors->values = (uint8_t)(held && on ? sensors->values | input : sensors->values & ~input);
}
