#include "control/recover_request.h"

#include <stdio.h>
#include <string.h>

#include "cm1e/hot_connect.h"
#include "control/arguments.h"

/** The slave with this name, or of the axis with this name; 0: there is none. */
static uint32_t find_named(const view_t *view, const char *name)
{
    for (uint32_t i = 1; name[0] && i <= view->slave_count; i++)
        if (strcmp(cm1e_bus_slave_name(view->bus, i), name) == 0)
            return i;
    for (uint32_t i = 0; i < view->axis_count; i++)
        if (strcmp(cm1e_axis_configuration(view->axes[i])->name, name) == 0)
            return cm1e_bus_axis_position(view->bus, i);
    return 0;
}

static uint32_t find_slave(const view_t *view, const json_t *slave)
{
    const json_int_t position = json_integer_value(slave);
    if (json_is_string(slave))
        return find_named(view, json_string_value(slave));
    return position >= 1 && position <= (json_int_t)view->slave_count ? (uint32_t)position : 0;
}

json_t *cm1e_recover_slave(control_request_t *request, control_run_t *run, const json_t *message)
{
    char text[160];
    cm1e_diag_t diag = {0};
    const uint32_t position = find_slave(&run->view, json_object_get(message, "slave"));
    if (position == 0) {
        snprintf(text, sizeof text, "\"slave\" is expected to be a position, 1 ... %u, or the name of a slave or of an "
                 "axis with a motor, as the program's bus file has it.", (unsigned)run->view.slave_count);
        return wrong(request, text);
    }
    const cm1e_error_t error = cm1e_bus_recover(run->view.bus, position, &diag);
    if (error != CM1E_OK)
        return refuse(request, error, diag.text);
    return cm1e_request_accept(request->id, "recover", json_integer(position));
}
