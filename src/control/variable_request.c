#include "control/variable_request.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "control/arguments.h"
#include "control/show.h"
#include "control/variable_number.h"
#include "control/variable_text.h"
#include "core/json_text.h"
#include "core/near.h"

enum { KEEP_LEAST_MS = 100, KEEP_MOST_MS = 5000, KEEP_MS = 1000 };

_Static_assert((int)VARIABLES_OF_REPLY >= (int)CM1E_FORCED, "all forced variables are in one reply");

/** What the cycle reads: the first `count` rows are wanted, of which only the forced ones may be. */
typedef struct variable_values {
    uint32_t from, count;
    bool only_forced, only_one;
    uint32_t rows[VARIABLES_OF_REPLY];
    bool forced[VARIABLES_OF_REPLY];
    variable_value_t values[VARIABLES_OF_REPLY];
} variable_values_t;

/* ---- the list ---------------------------------------------------------------------------------------------------- */

/** @rt cycle */
static void read_values(view_t *view, view_order_t *order)
{
    variable_values_t *of = ((variable_order_t *)order)->values;
    const variables_t *variables = cm1e_scheduler_variables(view->scheduler);
    if (of->only_forced)
        of->count = cm1e_scheduler_list_forced(view->scheduler, of->rows);
    for (uint32_t i = 0; i < of->count; i++) {
        cm1e_variable_read(&variables->rows[of->rows[i]], &of->values[i]);
        of->forced[i] = of->only_forced || cm1e_scheduler_is_forced(view->scheduler, of->rows[i]);
    }
}

bool cm1e_variables_begin(variable_order_t *order, const view_t *view, uint32_t from, uint32_t most, bool forced)
{
    const uint32_t count = cm1e_scheduler_variables(view->scheduler)->count;
    *order = (variable_order_t){.order.decide = read_values, .values = malloc(sizeof(variable_values_t))};
    if (!order->values)
        return false;
    memset(order->values, 0xFF, sizeof *order->values); /* so that the cycle does not wait for its pages */
    order->values->count = 0;
    order->values->from = from;
    order->values->only_forced = forced;
    order->values->only_one = most == 1;
    for (uint32_t i = from; i < count && order->values->count < most && !forced; i++)
        order->values->rows[order->values->count++] = i;
    return true;
}

static json_t *show_one(const variable_values_t *values, const variable_t *variable, uint32_t i)
{
    const bool number = variable->form == VARIABLE_NUMBER;
    const variable_value_t *value = &values->values[i];
    json_t *row = json_pack("{s:o, s:o, s:s, s:o, s:o, s:b}", "name", cm1e_json_text(variable->name), "unit",
                            cm1e_json_text(variable->unit), "type", cm1e_variable_type(variable), "declared",
                            cm1e_json_text(variable->declared), "value",
                            number ? cm1e_variable_number_show(variable, value)
                                   : cm1e_variable_text_show(variable, value->bytes),
                            "forced", values->forced[i]);
    if (variable->name_count > 0)
        json_object_set_new(row, "enumerator", cm1e_variable_enumerator_show(variable, value));
    return row;
}

json_t *cm1e_variables_show(const variable_order_t *order, const view_t *view)
{
    const variables_t *variables = cm1e_scheduler_variables(view->scheduler);
    json_t *list = json_array();
    for (uint32_t i = 0; i < order->values->count; i++)
        json_array_append_new(list, show_one(order->values, &variables->rows[order->values->rows[i]], i));
    return list;
}

uint32_t cm1e_variables_next(const variable_order_t *order, const view_t *view)
{
    const uint32_t next = order->values->from + order->values->count;
    const bool whole = order->values->only_forced || order->values->only_one;
    return whole || next >= cm1e_scheduler_variables(view->scheduler)->count ? 0 : next;
}

void cm1e_variables_free(variable_order_t *order)
{
    free(order->values);
    order->values = NULL;
}

/* ---- one variable ------------------------------------------------------------------------------------------------ */

/** @rt cycle */
static void change(view_t *view, view_order_t *order)
{
    variable_order_t *of = (variable_order_t *)order;
    of->result = FORCING_DONE;
    of->forced.owner = view;
    of->forced.until_ns = cm1e_scheduler_time_ns(view->scheduler) + of->keep_ns;
    if (of->check)
        of->result = of->release ? FORCING_DONE : cm1e_scheduler_would_take(view->scheduler, &of->forced, of->force);
    else if (of->release)
        cm1e_scheduler_release(view->scheduler, &of->forced);
    else if (of->force)
        of->result = cm1e_scheduler_force(view->scheduler, &of->forced);
    else
        of->result = cm1e_scheduler_write(view->scheduler, of->forced.variable, &of->forced.value);
}

/** false: it is no value of the variable. */
static bool take_value(const json_t *value, const variable_t *variable, variable_value_t *out)
{
    if (variable->form == VARIABLE_NUMBER)
        return cm1e_variable_number_take(variable, value, out);
    return json_is_string(value) && cm1e_variable_text_take(variable, value, out->bytes);
}

/** The last name of a path is meant where it is all that was typed: go for Main.go. */
static bool ends_with(const char *path, const char *name)
{
    const char *dot = strrchr(path, '.');
    return dot && strcasecmp(dot + 1, name) == 0;
}

void cm1e_variable_unknown(const variables_t *variables, const char *name, char *text, size_t size)
{
    char meant[CM1E_NEAR_TEXT_BYTES];
    cm1e_near_t near = {.word = name};
    for (uint32_t i = 0; i < variables->count; i++)
        cm1e_near_look(&near, variables->rows[i].name);
    for (uint32_t i = 0; i < variables->count && !near.nearest; i++)
        near.nearest = ends_with(variables->rows[i].name, name) ? variables->rows[i].name : NULL;
    snprintf(text, size, "The program has no variable \"%.200s\"%s", name, cm1e_near_text(&near, meant, sizeof meant));
}

bool cm1e_variable_named(const view_t *view, const char *name, uint32_t *row, char *text, size_t size)
{
    const variables_t *variables = cm1e_scheduler_variables(view->scheduler);
    *row = cm1e_variables_find(variables, name);
    if (*row == variables->count)
        cm1e_variable_unknown(variables, name, text, size);
    return *row < variables->count;
}

static const char *wrong(cm1e_error_t *error, cm1e_error_t value, const char *text)
{
    *error = value;
    return text;
}

const char *cm1e_variable_take(variable_order_t *order, const view_t *view, const json_t *message, cm1e_error_t *error,
                               char *text, size_t size)
{
    const variables_t *variables = cm1e_scheduler_variables(view->scheduler);
    const char *name = json_string_value(json_object_get(message, "name"));
    const json_t *value = json_object_get(message, "value");
    const uint32_t client = order->forced.client;
    *order = (variable_order_t){.order.decide = change, .force = json_is_true(json_object_get(message, "force")),
                                .check = json_is_true(json_object_get(message, "check")),
                                .release = json_is_null(value),
                                .forced.client = client};
    if (!cm1e_variable_named(view, name ? name : "", &order->forced.variable, text, size))
        return wrong(error, CM1E_ERROR_NOT_FOUND, text);
    if (!cm1e_take_keep(message, KEEP_LEAST_MS, KEEP_MOST_MS, KEEP_MS, &order->keep_ns))
        return wrong(error, CM1E_ERROR_INVALID_ARGUMENT,
                     "\"keep_ms\" is expected to be 100 ... 5000, or to be left out.");
    const variable_t *variable = &variables->rows[order->forced.variable];
    if (order->release || take_value(value, variable, &order->forced.value))
        return NULL;
    cm1e_variable_expected(variable, text, size);
    return wrong(error, CM1E_ERROR_INVALID_ARGUMENT, text);
}

const char *cm1e_variable_refusal(const variable_order_t *order)
{
    static const char *const texts[] = {
        [FORCING_DONE] = NULL,
        [FORCING_HELD] = "The variable is forced, by another connection or by this one.",
        [FORCING_FULL] = "64 variables are forced already.",
        [FORCING_ENDING] = "The program ends.",
        [FORCING_TAKEN] = "Another connection has released the variable. This one can force it again when it has "
                          "released it too, or has not asked for it for \"keep_ms\".",
    };
    return texts[order->result];
}
