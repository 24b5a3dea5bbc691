#include <stdio.h>

#include "config/interface.h"
#include "config/problem.h"

void cm1e_bus_config_init(cm1e_bus_config_t *config, const char *interface_name, uint32_t axis_count)
{
    *config = (cm1e_bus_config_t){.axis_count = axis_count};
    snprintf(config->interface_name, sizeof config->interface_name, "%s", interface_name ? interface_name : CM1E_SIM_INTERFACE);
    /* A count above the maximum stays as it is, so that cm1e_bus_config_check() refuses it. */
    for (uint32_t i = 0; i < axis_count && i < CM1E_MAX_AXES; i++)
        snprintf(config->axes[i].name, sizeof config->axes[i].name, "axis%u", i + 1);
}

cm1e_error_t cm1e_bus_config_check(const cm1e_bus_config_t *config, cm1e_diag_t *diag)
{
    cm1e_config_problem_t problem = {0};
    if (cm1e_config_find_problem(config, &problem))
        return cm1e_diag_set(diag, CM1E_OK, 0, "%s", "");
    return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "%s", problem.text);
}
