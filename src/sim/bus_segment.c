/* The simulated segment behind a bus. */
#include <stdio.h>

#include "bus/bus_image.h"
#include "sim/segment_backend.h"

cm1e_sim_segment_t *cm1e_bus_segment(cm1e_bus_t *bus)
{
    return bus ? cm1e_sim_segment_of(cm1e_bus_nic(bus)) : NULL;
}

cm1e_error_t cm1e_bus_simulate(cm1e_bus_t *bus, const char *line, char *answer, size_t size)
{
    cm1e_sim_segment_t *segment = cm1e_bus_segment(bus);
    if (segment || !bus)
        return cm1e_sim_console(segment, line, answer, size);
    snprintf(answer, answer ? size : 0, "%s is a network interface, not a simulation",
             cm1e_bus_configuration(bus)->interface_name);
    return CM1E_ERROR_UNSUPPORTED;
}
