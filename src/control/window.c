/* The control socket registers itself as a window into every run (scheduler_window.h). */
#include <stdio.h>

#include "cm1e/control.h"
#include "control/server.h"

static bool serves_own;

void cm1e_control_serve_own(bool serve) { serves_own = serve; }
bool cm1e_control_serves_own(void) { return serves_own; }

static void *open_window(cm1e_scheduler_t *scheduler, uint32_t bus, cm1e_window_told_t *told)
{
    cm1e_control_server_t *server;
    cm1e_diag_t diag = {0};
    /* Virtual time is over before anybody could look. */
    const bool wanted = cm1e_bus_configuration(cm1e_scheduler_bus_at(scheduler, bus))->control != CM1E_CONTROL_NONE;
    if (cm1e_scheduler_is_virtual(scheduler) || (!wanted && !serves_own))
        return NULL;
    if (cm1e_control_server_start(&server, scheduler, bus, told->socket, told->socket_size, &diag) != CM1E_OK)
        snprintf(told->advice, told->advice_size, "No control socket, so cm1e cannot watch this run: %.340s",
                 diag.text);
    return server;
}

static void look(void *window) { cm1e_view_cycle(cm1e_control_server_view(window)); }

static void close_window(void *window) { cm1e_control_server_stop(window); }

static const cm1e_window_t window_of_control = {open_window, look, close_window};

void cm1e_control_register(void) { cm1e_scheduler_register_window(&window_of_control); }

/* Runs before main(). The target cm1e::control has the linker ask for cm1e_control_register(), which brings this
 * object. */
__attribute__((constructor)) static void register_at_start(void) { cm1e_control_register(); }
