#include "control/maintain_request.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- what is asked for ------------------------------------------------------------------------------------------ */

static const struct {
    const char *name;
    bool has_axis, has_velocity;
    int keep_least, keep_most, keep_default; /**< ms; 0: nothing to renew */
    const char *keep_wrong;
} rows[MAINTAIN_COUNT] = {
    [MAINTAIN_ENABLE] = {"enable", true, false, 500, 10000, 2000,
                         "\"keep_ms\" is expected to be 500 ... 10000, or to be left out."},
    [MAINTAIN_DISABLE] = {"disable", true, false, 0, 0, 0, NULL},
    [MAINTAIN_JOG] = {"jog", true, true, 50, 1000, 250,
                      "\"keep_ms\" is expected to be 50 ... 1000, or to be left out."},
    [MAINTAIN_HOME] = {"home", true, false, 100, 5000, 1000,
                       "\"keep_ms\" is expected to be 100 ... 5000, or to be left out."},
    [MAINTAIN_STOP] = {"stop", true, false, 0, 0, 0, NULL},
    [MAINTAIN_RESET] = {"reset", true, false, 0, 0, 0, NULL},
    [MAINTAIN_KEEP] = {"keep", false, false, 0, 0, 0, NULL},
};

static const char *take_keep(maintain_order_t *order, const json_t *message)
{
    const bool good = rows[order->what].keep_most == 0 ||
                      cm1e_take_keep(message, rows[order->what].keep_least, rows[order->what].keep_most,
                                     rows[order->what].keep_default, &order->keep_ns);
    return good ? NULL : rows[order->what].keep_wrong;
}

static const char *take_motion(maintain_order_t *order, const json_t *message)
{
    const json_t *velocity = json_object_get(message, "velocity"), *acceleration = json_object_get(message,
                                                                                                   "acceleration");
    order->velocity = json_number_value(velocity);
    order->acceleration = json_number_value(acceleration);
    if (!json_is_number(velocity) || !isfinite(order->velocity) || order->velocity == 0.0)
        return "\"velocity\" is expected to be a number of units/s, below 0 for the negative direction, and not 0.";
    if ((acceleration && !json_is_number(acceleration)) || !isfinite(order->acceleration) || order->acceleration < 0.0)
        return "\"acceleration\" is expected to be a number of units/s2, or to be left out.";
    return NULL;
}

static maintain_what_t what_of(const control_request_t *request)
{
    maintain_what_t what = MAINTAIN_ENABLE;
    while (what < MAINTAIN_KEEP && strcmp(rows[what].name, request->name) != 0)
        what++;
    return what;
}

const char *cm1e_maintain_take(control_request_t *request, const control_run_t *run, const json_t *message)
{
    const maintain_what_t what = what_of(request);
    const json_t *axis = json_object_get(message, "axis");
    const json_int_t number = json_integer_value(axis);
    request->maintain = (maintain_order_t){.order.decide = cm1e_maintain_decide, .what = what,
                                           .client = request->client, .axis = number > 0 ? (uint32_t)number - 1 : 0};
    if (rows[what].has_axis && (!json_is_integer(axis) || number < 1 || number > (json_int_t)run->view.axis_count))
        return "\"axis\" is expected to be the number of an axis, 1 = first.";
    const char *wrong = rows[what].has_velocity ? take_motion(&request->maintain, message) : NULL;
    return wrong ? wrong : take_keep(&request->maintain, message);
}

/* ---- what the cycle has decided --------------------------------------------------------------------------------- */

static void commanded_text(const maintain_order_t *order, const char *name, char *text, size_t size)
{
    snprintf(text, size, "Axis \"%s\" is commanded by the program (%s%s%s): it has precedence. Wait until the axis "
             "is at standstill without a command.", name, cm1e_axis_state_name(order->state),
             order->command ? ", " : "", order->command ? cm1e_command_name(order->kind) : "");
}

static void guest_text(const maintain_order_t *order, const char *name, char *text, size_t size)
{
    static const char *const texts[] = {
        [CM1E_GUEST_NO_MOTOR] = "Axis \"%s\" is an encoder: it has no motor.",
        [CM1E_GUEST_FOLLOWED] = "Another axis of the program follows axis \"%s\", and would move with it.",
        [CM1E_GUEST_GROUPED] = "Axis \"%s\" belongs to an axes group of the program.",
        [CM1E_GUEST_POWER] = "The program decides on the power of axis \"%s\" by its MC_Power: enable it there.",
        [CM1E_GUEST_MODE] = "The motor of axis \"%s\" is in a mode from which no way leads to motion: switch the "
                            "bridge off and on.",
    };
    if (order->guest == CM1E_GUEST_COMMANDED)
        commanded_text(order, name, text, size);
    else
        snprintf(text, size, texts[order->guest], name);
}

/** Why the axis did not take it, in the words of its error. */
static void axis_text(const maintain_order_t *order, const char *name, char *text, size_t size)
{
    const char *advice = order->error == CM1E_ERROR_AXIS_NOT_POWERED ? " Enable it first."
                         : order->error == CM1E_ERROR_AXIS_ERROR_STOP ? " Reset it first."
                         : order->what == MAINTAIN_JOG && order->error == CM1E_ERROR_AXIS_POSITION_RANGE
                             ? " It is at its software limit." : "";
    snprintf(text, size, "Axis \"%s\", %s: %s.%s", name, cm1e_axis_state_name(order->state),
             cm1e_strerror(order->error), advice);
}

static json_t *refuse_order(const control_request_t *request, const char *name)
{
    const maintain_order_t *order = &request->maintain;
    char text[320] = "";
    cm1e_error_t error = CM1E_ERROR_AXIS_STATE;
    switch (order->refusal) {
    case MAINTAIN_BY_GUEST: guest_text(order, name, text, sizeof text); break;
    case MAINTAIN_BY_AXIS:
        error = order->error;
        axis_text(order, name, text, sizeof text);
        break;
    case MAINTAIN_HELD:
        error = CM1E_ERROR_BUSY;
        snprintf(text, sizeof text, "Axis \"%s\" is held by another connection, which moves or enables it.", name);
        break;
    case MAINTAIN_NOT_HELD:
        snprintf(text, sizeof text, "Axis \"%s\" was not %s through the control socket. The program %s what the "
                 "program has %s.",
                 name, order->what == MAINTAIN_STOP ? "moved" : "enabled",
                 order->what == MAINTAIN_STOP ? "stops" : "disables",
                 order->what == MAINTAIN_STOP ? "begun" : "enabled");
        break;
    case MAINTAIN_MOVES:
        snprintf(text, sizeof text, "Axis \"%s\" is already moved by this connection: stop it first.", name);
        break;
    case MAINTAIN_STOPPED:
        snprintf(text, sizeof text, "Another connection has stopped axis \"%s\": let go of the jog, then jog again.",
                 name);
        break;
    default: snprintf(text, sizeof text, "The program ends, and shuts its axes down."); break;
    }
    return refuse(request, error, text);
}

json_t *cm1e_maintain_reply(control_request_t *request, control_run_t *run)
{
    const maintain_order_t *order = &request->maintain;
    if (order->refusal)
        return refuse_order(request, cm1e_axis_configuration(run->view.axes[order->axis])->name);
    return cm1e_request_accept(request->id, request->name,
                               order->what == MAINTAIN_KEEP ? json_integer(order->kept) : json_null());
}
