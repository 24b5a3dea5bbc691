#include "control/variable_request.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "control/show.h"

enum { KEEP_LEAST_MS = 100, KEEP_MOST_MS = 5000, KEEP_MS = 1000 };
#define NS_PER_MS INT64_C(1000000)

typedef struct variable_values {
    double values[CM1E_TRACE_VARIABLES];
    bool forced[CM1E_TRACE_VARIABLES];
} variable_values_t;

/** The type, its name, and the range of its whole numbers; 0: it is none. */
static const struct { const char *name; int bits; bool is_signed; } types[] = {
    [CM1E_TRACE_BOOL] = {"BOOL", 1, false}, [CM1E_TRACE_SINT] = {"SINT", 8, true}, [CM1E_TRACE_INT] = {"INT", 16, true},
    [CM1E_TRACE_DINT] = {"DINT", 32, true}, [CM1E_TRACE_LINT] = {"LINT", 64, true},
    [CM1E_TRACE_USINT] = {"USINT", 8, false}, [CM1E_TRACE_UINT] = {"UINT", 16, false},
    [CM1E_TRACE_UDINT] = {"UDINT", 32, false}, [CM1E_TRACE_ULINT] = {"ULINT", 64, false},
    [CM1E_TRACE_REAL] = {"REAL", 0, true}, [CM1E_TRACE_LREAL] = {"LREAL", 0, true},
};

static bool is_variable(const trace_column_t *column) { return column->writable != NULL; }

/* ---- the list ---------------------------------------------------------------------------------------------------- */

/** @rt cycle */
static void read_values(view_t *view, view_order_t *order)
{
    variable_order_t *of = (variable_order_t *)order;
    const trace_t *trace = cm1e_scheduler_trace(view->scheduler);
    uint32_t count = 0;
    for (uint32_t i = 0; i < trace->column_count && count < CM1E_TRACE_VARIABLES; i++) {
        if (!is_variable(&trace->columns[i]))
            continue;
        of->values->values[count] = cm1e_trace_value(&trace->columns[i]);
        of->values->forced[count++] = cm1e_scheduler_is_forced(view->scheduler, i);
    }
}

bool cm1e_variables_begin(variable_order_t *order)
{
    *order = (variable_order_t){.order.decide = read_values, .values = calloc(1, sizeof(variable_values_t))};
    return order->values != NULL;
}

json_t *cm1e_variables_show(const variable_order_t *order, const view_t *view)
{
    const trace_t *trace = cm1e_scheduler_trace(view->scheduler);
    json_t *list = json_array();
    uint32_t count = 0;
    for (uint32_t i = 0; i < trace->column_count && count < CM1E_TRACE_VARIABLES; i++) {
        const trace_column_t *column = &trace->columns[i];
        if (!is_variable(column))
            continue;
        json_array_append_new(list, json_pack("{s:o, s:o, s:s, s:o, s:b}", "name", cm1e_show_text(column->name), "unit",
                                              cm1e_show_text(column->unit), "type", types[column->type].name, "value",
                                              cm1e_show_real(order->values->values[count]), "forced",
                                              order->values->forced[count]));
        count++;
    }
    return list;
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
    if (of->release)
        cm1e_scheduler_release(view->scheduler, of->forced.column);
    else if (of->force)
        of->result = cm1e_scheduler_force(view->scheduler, &of->forced);
    else
        of->result = cm1e_scheduler_write(view->scheduler, of->forced.column, &of->forced.value);
}

/** The bytes of a number in its type; false: it is no value of it. */
static bool encode(const json_t *value, cm1e_trace_type_t type, forced_value_t *out)
{
    const double real = json_is_boolean(value) ? json_is_true(value) : json_number_value(value);
    const int64_t whole = json_is_integer(value) ? json_integer_value(value) : json_is_boolean(value) ? json_is_true(value) : 0;
    const int bits = types[type].bits;
    const float narrow = (float)real;
    *out = (forced_value_t){.shown = real};
    if (type == CM1E_TRACE_REAL) {
        memcpy(out->bytes, &narrow, sizeof narrow);
        return fabs(real) <= (double)FLT_MAX;
    }
    if (type == CM1E_TRACE_LREAL) {
        memcpy(out->bytes, &real, sizeof real);
        return isfinite(real);
    }
    memcpy(out->bytes, &whole, sizeof whole);
    if (json_is_real(value))
        return false;
    if (bits == 64)
        return types[type].is_signed || whole >= 0;
    const int64_t limit = INT64_C(1) << (bits - types[type].is_signed);
    return whole < limit && whole >= (types[type].is_signed ? -limit : 0);
}

static uint32_t find_column(const trace_t *trace, const char *name)
{
    uint32_t i = 0;
    while (i < trace->column_count && (!is_variable(&trace->columns[i]) || strcmp(trace->columns[i].name, name) != 0))
        i++;
    return i;
}

static const char *wrong(cm1e_error_t *error, cm1e_error_t value, const char *text)
{
    *error = value;
    return text;
}

const char *cm1e_variable_take(variable_order_t *order, const view_t *view, const json_t *message, cm1e_error_t *error,
                               char *text, size_t size)
{
    const trace_t *trace = cm1e_scheduler_trace(view->scheduler);
    const char *name = json_string_value(json_object_get(message, "name"));
    const json_t *value = json_object_get(message, "value"), *keep = json_object_get(message, "keep_ms");
    const json_int_t keep_ms = keep ? json_integer_value(keep) : KEEP_MS;
    const uint32_t client = order->forced.client;
    *order = (variable_order_t){.order.decide = change, .force = json_is_true(json_object_get(message, "force")),
                                .release = json_is_null(value), .keep_ns = keep_ms * NS_PER_MS,
                                .forced.client = client};
    order->forced.column = name ? find_column(trace, name) : trace->column_count;
    if (order->forced.column == trace->column_count) {
        snprintf(text, size, "The program has no variable \"%.100s\" that others may write: `variables` lists them.",
                 name ? name : "");
        return wrong(error, CM1E_ERROR_NOT_FOUND, text);
    }
    if ((keep && !json_is_integer(keep)) || keep_ms < KEEP_LEAST_MS || keep_ms > KEEP_MOST_MS)
        return wrong(error, CM1E_ERROR_INVALID_ARGUMENT, "\"keep_ms\" is expected to be 100 ... 5000, or to be left out.");
    const cm1e_trace_type_t type = trace->columns[order->forced.column].type;
    const bool number = json_is_number(value) || json_is_boolean(value);
    if (order->release || (number && encode(value, type, &order->forced.value)))
        return NULL;
    snprintf(text, size, "\"value\" is expected to be a value of %s, or null to release the variable.", types[type].name);
    return wrong(error, CM1E_ERROR_INVALID_ARGUMENT, text);
}

const char *cm1e_variable_refusal(const variable_order_t *order)
{
    static const char *const texts[] = {
        [FORCING_DONE] = NULL,
        [FORCING_HELD] = "The variable is forced, by another connection or by this one.",
        [FORCING_FULL] = "64 variables are forced already.",
        [FORCING_ENDING] = "The program ends.",
    };
    return texts[order->result];
}
