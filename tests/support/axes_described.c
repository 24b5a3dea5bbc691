#include "axes_described.h"

void describe_axes(cm1e_bus_config_t *config, uint32_t axis_count)
{
    cm1e_bus_config_free(config);
    cm1e_bus_config_init(config, "sim", axis_count);
    config->virtual_time = true;
    for (uint32_t i = 0; i < axis_count; i++) {
        cm1e_axis_config_t *axis = &config->axes[i];
        axis->counts_per_unit = 1000;
        axis->homing = (cm1e_homing_config_t){.method = -2, .velocity = 100, .acceleration = 2000, .torque = 30};
        axis->inputs = (cm1e_input_config_t){.limit_positive = 2, .limit_negative = 3, .home = 4}; /* all are off */
        axis->table_profiles = true;
        axis->sim.stop_negative = -10000;
        axis->sim.stop_positive = 10000;
    }
}
