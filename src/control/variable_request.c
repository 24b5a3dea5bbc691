#include "control/variable_request.h"

#include <errno.h>
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "control/show.h"
#include "control/variable_text.h"

enum { KEEP_LEAST_MS = 100, KEEP_MOST_MS = 5000, KEEP_MS = 1000 };
#define NS_PER_MS INT64_C(1000000)

_Static_assert((int)VARIABLES_OF_REPLY >= (int)CM1E_FORCED, "all forced variables are in one reply");

/** What the cycle reads: the first `count` rows are wanted, of which only the forced ones may be. */
typedef struct variable_values {
    uint32_t from, count;
    bool only_forced;
    uint32_t rows[VARIABLES_OF_REPLY];
    bool forced[VARIABLES_OF_REPLY];
    variable_value_t values[VARIABLES_OF_REPLY];
} variable_values_t;

/** The type, its name, and the range of its whole numbers; 0: it is none. */
static const struct { const char *name; int bits; bool is_signed; } types[] = {
    [CM1E_TRACE_BOOL] = {"BOOL", 1, false}, [CM1E_TRACE_SINT] = {"SINT", 8, true}, [CM1E_TRACE_INT] = {"INT", 16, true},
    [CM1E_TRACE_DINT] = {"DINT", 32, true}, [CM1E_TRACE_LINT] = {"LINT", 64, true},
    [CM1E_TRACE_USINT] = {"USINT", 8, false}, [CM1E_TRACE_UINT] = {"UINT", 16, false},
    [CM1E_TRACE_UDINT] = {"UDINT", 32, false}, [CM1E_TRACE_ULINT] = {"ULINT", 64, false},
    [CM1E_TRACE_REAL] = {"REAL", 0, true}, [CM1E_TRACE_LREAL] = {"LREAL", 0, true},
};

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

bool cm1e_variables_begin(variable_order_t *order, const view_t *view, uint32_t from, bool forced)
{
    const uint32_t count = cm1e_scheduler_variables(view->scheduler)->count;
    *order = (variable_order_t){.order.decide = read_values, .values = malloc(sizeof(variable_values_t))};
    if (!order->values)
        return false;
    memset(order->values, 0xFF, sizeof *order->values); /* so that the cycle does not wait for its pages */
    order->values->count = 0;
    order->values->from = from;
    order->values->only_forced = forced;
    for (uint32_t i = from; i < count && order->values->count < VARIABLES_OF_REPLY && !forced; i++)
        order->values->rows[order->values->count++] = i;
    return true;
}

/** JSON has integers of 64 bits with a sign: a ULINT above them is the text of its digits. */
static json_t *show_number(const variable_t *variable, const variable_value_t *value)
{
    char digits[24];
    double rest;
    uint64_t whole;
    const double real = cm1e_variable_number_of(variable, value, &rest);
    memcpy(&whole, value->bytes, sizeof whole);
    if (types[variable->type].bits == 0)
        return cm1e_show_real(variable->type == CM1E_TRACE_REAL ? cm1e_variable_decimal((float)real) : real);
    if (types[variable->type].bits < 64)
        return json_integer((json_int_t)real);
    if (types[variable->type].is_signed || whole <= INT64_MAX)
        return json_integer((json_int_t)whole);
    snprintf(digits, sizeof digits, "%" PRIu64, whole);
    return json_string(digits);
}

static json_t *show_one(const variable_values_t *values, const variable_t *variable, uint32_t i)
{
    static const char *const texts[] = {[VARIABLE_STRING] = "STRING", [VARIABLE_WSTRING] = "WSTRING"};
    const bool number = variable->form == VARIABLE_NUMBER;
    return json_pack("{s:o, s:o, s:s, s:o, s:o, s:b}", "name", cm1e_show_text(variable->name), "unit",
                     cm1e_show_text(variable->unit), "type", number ? types[variable->type].name : texts[variable->form],
                     "declared", cm1e_show_text(variable->declared), "value",
                     number ? show_number(variable, &values->values[i])
                            : cm1e_variable_text_show(variable, values->values[i].bytes),
                     "forced", values->forced[i]);
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
    return order->values->only_forced || next >= cm1e_scheduler_variables(view->scheduler)->count ? 0 : next;
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
        cm1e_scheduler_release(view->scheduler, of->forced.variable);
    else if (of->force)
        of->result = cm1e_scheduler_force(view->scheduler, &of->forced);
    else
        of->result = cm1e_scheduler_write(view->scheduler, of->forced.variable, &of->forced.value);
}

/** The bytes of a number in its type; false: it is no value of it. */
static bool encode(const json_t *value, cm1e_trace_type_t type, variable_value_t *out)
{
    const double real = json_is_boolean(value) ? json_is_true(value) : json_number_value(value);
    const int64_t whole = json_is_integer(value) ? json_integer_value(value) : json_is_boolean(value) ? json_is_true(value) : 0;
    const int bits = types[type].bits;
    const float narrow = (float)real;
    *out = (variable_value_t){{0}};
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

/** A ULINT as the text of its digits. */
static bool encode_digits(const char *text, variable_value_t *out)
{
    errno = 0;
    const uint64_t whole = strtoull(text, NULL, 10);
    *out = (variable_value_t){{0}};
    memcpy(out->bytes, &whole, sizeof whole);
    return *text && text[strspn(text, "0123456789")] == '\0' && errno == 0;
}

/** false: it is no value of the variable. */
static bool take_value(const json_t *value, const variable_t *variable, variable_value_t *out)
{
    if (variable->form != VARIABLE_NUMBER)
        return json_is_string(value) && cm1e_variable_text_take(variable, value, out->bytes);
    if (json_is_string(value))
        return variable->type == CM1E_TRACE_ULINT && !variable->ranged && encode_digits(json_string_value(value), out);
    if (!(json_is_number(value) || json_is_boolean(value)) || !encode(value, variable->type, out))
        return false;
    const json_int_t whole = json_integer_value(value);
    return !variable->ranged || (json_is_integer(value) && whole >= variable->first && whole <= variable->last);
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
    const json_t *value = json_object_get(message, "value"), *keep = json_object_get(message, "keep_ms");
    const json_int_t keep_ms = keep ? json_integer_value(keep) : KEEP_MS;
    const uint32_t client = order->forced.client;
    *order = (variable_order_t){.order.decide = change, .force = json_is_true(json_object_get(message, "force")),
                                .release = json_is_null(value), .keep_ns = keep_ms * NS_PER_MS,
                                .forced.client = client};
    order->forced.variable = name ? cm1e_variables_find(variables, name) : variables->count;
    if (order->forced.variable == variables->count) {
        snprintf(text, size, "The program has no variable \"%.100s\" that others may write: `variables` lists them.",
                 name ? name : "");
        return wrong(error, CM1E_ERROR_NOT_FOUND, text);
    }
    if ((keep && !json_is_integer(keep)) || keep_ms < KEEP_LEAST_MS || keep_ms > KEEP_MOST_MS)
        return wrong(error, CM1E_ERROR_INVALID_ARGUMENT, "\"keep_ms\" is expected to be 100 ... 5000, or to be left out.");
    const variable_t *variable = &variables->rows[order->forced.variable];
    if (order->release || take_value(value, variable, &order->forced.value))
        return NULL;
    snprintf(text, size, "\"value\" is expected to be a value of %.80s, or null to release the variable.",
             variable->declared);
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
