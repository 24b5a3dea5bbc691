#include "control/io_request.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "config/io_types.h"
#include "control/arguments.h"
#include "control/show.h"
#include "core/json_text.h"

enum { KEEP_LEAST_MS = 100, KEEP_MOST_MS = 5000, KEEP_MS = 1000, USE_TEXT = 256 };

/* ---- all signals ------------------------------------------------------------------------------------------------ */

/** @rt cycle */
static void read_values(view_t *view, view_order_t *order)
{
    io_values_t *values = (io_values_t *)order;
    (void)view;
    for (uint32_t i = 0; i < values->count; i++) {
        const cm1e_io_t *io = &values->signals[i];
        const bool fits = io->type != CM1E_IO_BYTES;
        values->qualities[i] = cm1e_io_quality(io);
        values->integers[i] = fits ? cm1e_io_integer(io) : 0;
        values->reals[i] = fits ? cm1e_io_real(io) : 0.0;
    }
}

io_list_t *cm1e_io_list_begin(void)
{
    io_list_t *list = calloc(1, sizeof *list);
    if (list)
        list->told = json_array();
    return list;
}

bool cm1e_io_list_next(io_list_t *list, const view_t *view)
{
    io_values_t *values = &list->values;
    cm1e_io_info_t *last = &list->last;
    values->count = 0;
    while (values->count < IO_AT_ONCE && !list->complete) {
        list->complete = !cm1e_io_guest_next(view->bus, last);
        list->infos[values->count] = *last;
        if (!list->complete &&
            cm1e_io_guest_take(view->bus, last, &values->signals[values->count], NULL) == CM1E_OK)
            values->count++;
    }
    values->order.decide = read_values;
    return values->count > 0;
}

static json_t *value_of(const io_values_t *values, uint32_t i)
{
    const cm1e_io_type_t type = (cm1e_io_type_t)values->signals[i].type;
    if (type == CM1E_IO_BYTES || values->qualities[i] == CM1E_IO_INVALID)
        return json_null();
    return type == CM1E_IO_REAL || type == CM1E_IO_LREAL ? cm1e_show_real(values->reals[i])
                                                         : json_integer(values->integers[i]);
}

static json_t *show_signal(const io_list_t *list, const view_t *view, uint32_t i)
{
    char use[USE_TEXT];
    const cm1e_io_info_t *info = &list->infos[i];
    cm1e_io_use(view->bus, info, use, sizeof use);
    json_t *signal = json_object();
    json_object_set_new(signal, "slave", json_integer(info->position));
    json_object_set_new(signal, "slave_name", cm1e_json_text(cm1e_bus_slave_name(view->bus, info->position)));
    json_object_set_new(signal, "name", cm1e_json_text(info->name));
    json_object_set_new(signal, "number", json_integer(info->number));
    json_object_set_new(signal, "output", json_boolean(info->output));
    json_object_set_new(signal, "of_axis", json_boolean(info->of_axis));
    json_object_set_new(signal, "of_program", json_boolean(cm1e_io_is_claimed(&list->values.signals[i])));
    json_object_set_new(signal, "index", json_integer(info->index));
    json_object_set_new(signal, "subindex", json_integer(info->subindex));
    json_object_set_new(signal, "type", json_string(cm1e_io_type_name(info->type)));
    json_object_set_new(signal, "bits", json_integer(info->bits));
    json_object_set_new(signal, "quality", json_string(cm1e_io_quality_name(list->values.qualities[i])));
    json_object_set_new(signal, "value", value_of(&list->values, i));
    json_object_set_new(signal, "use", cm1e_json_text(use));
    return signal;
}

void cm1e_io_list_take(io_list_t *list, const view_t *view)
{
    for (uint32_t i = 0; i < list->values.count; i++)
        json_array_append_new(list->told, show_signal(list, view, i));
}

void cm1e_io_list_free(io_list_t *list)
{
    if (list)
        json_decref(list->told);
    free(list);
}

/* ---- one output ------------------------------------------------------------------------------------------------- */

/** @rt cycle */
static void set_output(view_t *view, view_order_t *order)
{
    output_order_t *output = (output_order_t *)order;
    output->refusal = OUTPUT_DONE;
    if (output->release)
        cm1e_guest_output_release(&view->outputs, output->client, &output->io);
    else if (cm1e_scheduler_is_ending(view->scheduler))
        output->refusal = OUTPUT_ENDING;
    else
        output->refusal = cm1e_guest_output_set(&view->outputs, output->client, &output->io, output->value,
                                                cm1e_scheduler_time_ns(view->scheduler) + output->keep_ns);
}

/** How the axes use the output that was found, as half a sentence. */
static void say_use(const view_t *view, const cm1e_io_t *io, char *text, size_t size)
{
    cm1e_io_info_t info = {0};
    char use[USE_TEXT] = "";
    while (!use[0] && cm1e_io_guest_next(view->bus, &info)) {
        cm1e_io_t listed;
        if (info.output && cm1e_io_guest_take(view->bus, &info, &listed, NULL) == CM1E_OK &&
            listed.byte == io->byte && listed.shift == io->shift)
            cm1e_io_use(view->bus, &info, use, sizeof use);
    }
    if (use[0])
        snprintf(text, size, "whose axis drives it (%s)", use);
    else
        snprintf(text, size, "which uses it (cm1e/io.h)");
}

static const char *wrong(cm1e_error_t *error, cm1e_error_t value, const char *text)
{
    *error = value;
    return text;
}

const char *cm1e_output_take(output_order_t *order, view_t *view, const json_t *message, cm1e_error_t *error,
                             char *text, size_t size)
{
    const char *name = json_string_value(json_object_get(message, "name"));
    const json_t *value = json_object_get(message, "value");
    cm1e_diag_t diag = {0};
    *order = (output_order_t){.order.decide = set_output, .client = order->client, .release = json_is_null(value),
                              .value = json_number_value(value)};
    if (!name)
        return wrong(error, CM1E_ERROR_INVALID_ARGUMENT, "\"name\" is expected to be that of a signal, as "
                     "\"2.output 1\".");
    if (!order->release && (!json_is_number(value) || !isfinite(order->value)))
        return wrong(error, CM1E_ERROR_INVALID_ARGUMENT, "\"value\" is expected to be a number, or null to let go.");
    if (!cm1e_take_keep(message, KEEP_LEAST_MS, KEEP_MOST_MS, KEEP_MS, &order->keep_ns))
        return wrong(error, CM1E_ERROR_INVALID_ARGUMENT, "\"keep_ms\" is expected to be 100 ... 5000, or to be left "
                     "out.");
    *error = cm1e_io_guest_find(view->bus, name, &order->io, &diag);
    if (*error == CM1E_OK && !cm1e_io_is_claimed(&order->io))
        return NULL;
    if (*error == CM1E_OK) {
        char use[USE_TEXT + 32];
        say_use(view, &order->io, use, sizeof use);
        *error = CM1E_ERROR_AXIS_STATE;
        snprintf(text, size, "The output \"%.100s\" belongs to the program, %.150s: no other program writes it.", name,
                 use);
    } else {
        snprintf(text, size, "%s", diag.text);
    }
    return text;
}

const char *cm1e_output_refusal(const output_order_t *order, char *text, size_t size)
{
    char why[160];
    static const char *const texts[] = {
        [OUTPUT_DONE] = NULL,
        [OUTPUT_HELD] = "Another connection holds this output, or a part of it.",
        [OUTPUT_OFFLINE] = "The slave of this output does not take part in the cycle.",
        [OUTPUT_FULL] = "64 outputs are held already.",
        [OUTPUT_ENDING] = "The program ends.",
    };
    if (order->refusal != OUTPUT_BY_BUS)
        return texts[order->refusal];
    cm1e_io_say_refusal(&order->io, order->value, why, sizeof why);
    snprintf(text, size, "It cannot be written with %.15g: %s.", order->value, why);
    return text;
}
