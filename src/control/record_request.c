/* The requests of a recording. */
#include "control/record_request.h"

#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "axis/axis_api.h"
#include "control/variable_request.h"
#include "scheduler/variables.h"

enum { EVERY_MOST = 10000 };

/** The variables and objects that the program records itself. */
static cm1e_error_t add_own(recorder_t *recorder, const cm1e_scheduler_t *scheduler, cm1e_diag_t *diag)
{
    const trace_t *own = cm1e_scheduler_trace(scheduler);
    cm1e_error_t error = CM1E_OK;
    for (uint32_t i = own->column_count - own->variables; i < own->column_count && error == CM1E_OK; i++)
        error = cm1e_trace_add(&recorder->trace, &own->columns[i], diag);
    return error;
}

/** A variable by its whole path; all numbers within it, of an instance or a structure. */
static cm1e_error_t add_within(recorder_t *recorder, const variables_t *variables, const char *path, cm1e_diag_t *diag)
{
    cm1e_error_t error = CM1E_OK;
    bool found = false;
    for (uint32_t i = 0; i < variables->count && error == CM1E_OK; i++) {
        const variable_t *variable = &variables->rows[i];
        if (!cm1e_variable_is_within(variable->name, path))
            continue;
        found = true;
        if (variable->form == VARIABLE_NUMBER || strcasecmp(variable->name, path) == 0)
            error = cm1e_variable_trace(variable, &recorder->trace, diag);
    }
    if (found)
        return error;
    char text[500];
    cm1e_variable_unknown(variables, path, text, sizeof text);
    return cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "%s", text);
}

/** Those that the request names, or else those that the program records. */
static cm1e_error_t add_variables(recorder_t *recorder, const cm1e_scheduler_t *scheduler, const json_t *paths,
                                  cm1e_diag_t *diag)
{
    cm1e_error_t error = paths ? CM1E_OK : add_own(recorder, scheduler, diag);
    for (size_t i = 0; i < json_array_size(paths) && error == CM1E_OK; i++) {
        const char *path = json_string_value(json_array_get(paths, i));
        error = add_within(recorder, cm1e_scheduler_variables(scheduler), path ? path : "", diag);
    }
    return error;
}

static bool is_within(const json_t *value, json_int_t least, json_int_t most)
{
    return json_is_integer(value) && json_integer_value(value) >= least && json_integer_value(value) <= most;
}

static cm1e_error_t add_objects(recorder_t *recorder, const view_t *view, const json_t *objects, cm1e_diag_t *diag)
{
    size_t i;
    json_t *object;
    json_array_foreach ((json_t *)(uintptr_t)objects, i, object) {
        const json_t *axis = json_object_get(object, "axis"), *index = json_object_get(object, "index"),
                     *subindex = json_object_get(object, "subindex");
        if (!is_within(axis, 1, view->axis_count) || !is_within(index, 1, 0xFFFF) ||
            (subindex && !is_within(subindex, 0, 0xFF)))
            return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "An object is expected to have \"axis\", "
                                 "\"index\" and \"subindex\".");
        const uint32_t n = (uint32_t)json_integer_value(axis) - 1;
        const cm1e_error_t error = cm1e_trace_add_object(
            &recorder->trace, view->bus, cm1e_bus_axis_position(view->bus, n), recorder->trace.names[n],
            (uint16_t)json_integer_value(index), (uint8_t)json_integer_value(subindex), diag);
        if (error != CM1E_OK)
            return error;
    }
    return CM1E_OK;
}

static cm1e_error_t make(recorder_t *recorder, const view_t *view, const json_t *message, uint32_t every,
                         cm1e_diag_t *diag)
{
    const char *names[CM1E_MAX_AXES];
    for (uint32_t i = 0; i < view->axis_count; i++)
        names[i] = cm1e_axis_configuration(view->axes[i])->name;
    cm1e_error_t error = cm1e_trace_init(&recorder->trace, names, view->axis_count, 1, 1, diag);
    if (error == CM1E_OK)
        error = add_variables(recorder, view->scheduler, json_object_get(message, "variables"), diag);
    if (error == CM1E_OK)
        error = add_objects(recorder, view, json_object_get(message, "objects"), diag);
    if (error == CM1E_OK)
        error = cm1e_recorder_init(recorder, view->scheduler, every, cm1e_bus_configuration(view->bus)->cycle_time_ns,
                                   diag);
    return error;
}

json_t *cm1e_record_begin(control_request_t *request, control_run_t *run, const json_t *message)
{
    const json_t *every = json_object_get(message, "every"), *objects = json_object_get(message, "objects"),
                 *variables = json_object_get(message, "variables");
    cm1e_diag_t diag = {0};
    if (run->view.recorders[request->client])
        return refuse(request, CM1E_ERROR_BUSY, "This connection records already. A "
                      "recording ends with its connection: open another one.");
    if (every && !is_within(every, 1, EVERY_MOST))
        return refuse(request, CM1E_ERROR_INVALID_ARGUMENT, "\"every\" is expected to be 1 ... 10000 cycles, or to be "
                      "left out.");
    if (objects && !json_is_array(objects))
        return refuse(request, CM1E_ERROR_INVALID_ARGUMENT, "\"objects\" is expected to be a list, or to be left out.");
    if (variables && !json_is_array(variables))
        return refuse(request, CM1E_ERROR_INVALID_ARGUMENT, "\"variables\" is expected to be a list of names, or to be "
                      "left out.");
    recorder_t *recorder = calloc(1, sizeof *recorder);
    if (!recorder)
        return refuse(request, CM1E_ERROR_NO_MEMORY, "No memory for a recording.");
    const cm1e_error_t error = make(recorder, &run->view, message,
                                    every ? (uint32_t)json_integer_value(every) : 1, &diag);
    const int64_t cycle_ns = cm1e_bus_configuration(run->view.bus)->cycle_time_ns;
    json_t *reply = error == CM1E_OK
                        ? cm1e_request_accept(request->id, "record", cm1e_recorder_show(recorder, cycle_ns))
                        : refuse(request, error, diag.text);
    if (json_is_true(json_object_get(reply, "ok")))
        cm1e_recorder_begin(&run->view, request->client, recorder);
    else
        cm1e_recorder_free(recorder);
    return reply;
}

json_t *cm1e_record_samples(control_request_t *request, control_run_t *run, const json_t *message)
{
    (void)message;
    recorder_t *recorder = run->view.recorders[request->client];
    if (!recorder)
        return refuse(request, CM1E_ERROR_STATE, "This connection records nothing: send \"record\" before.");
    return cm1e_request_accept(request->id, "samples", cm1e_recorder_take(recorder));
}
