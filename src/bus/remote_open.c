#include "bus/bus_internal.h"

cm1e_error_t cm1e_bus_open_remote(cm1e_bus_t **bus, const cm1e_bus_config_t *config, const cm1e_bus_remote_t *remote,
                                  void *state, cm1e_diag_t *diag)
{
    *bus = NULL;
    cm1e_bus_t *made = NULL;
    cm1e_error_t error = cm1e_bus_config_check(config, diag);
    if (error == CM1E_OK)
        error = cm1e_bus_make(&made, config, diag);
    if (error != CM1E_OK) {
        remote->close(state);
        return error;
    }
    made->remote = remote;
    made->remote_state = state;
    made->clock = cm1e_clock_monotonic();
    cm1e_bus_set_phase(made, BUS_OPEN);
    *bus = made;
    return CM1E_OK;
}
