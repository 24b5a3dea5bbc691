#include "control/variable_number.h"

#include <errno.h>
#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "control/show.h"
#include "core/json_text.h"

/** A type, its name, and the range of its whole numbers; 0: it is none. */
static const struct { const char *name; int bits; bool is_signed; } types[] = {
    [CM1E_TRACE_BOOL] = {"BOOL", 1, false}, [CM1E_TRACE_SINT] = {"SINT", 8, true}, [CM1E_TRACE_INT] = {"INT", 16, true},
    [CM1E_TRACE_DINT] = {"DINT", 32, true}, [CM1E_TRACE_LINT] = {"LINT", 64, true},
    [CM1E_TRACE_USINT] = {"USINT", 8, false}, [CM1E_TRACE_UINT] = {"UINT", 16, false},
    [CM1E_TRACE_UDINT] = {"UDINT", 32, false}, [CM1E_TRACE_ULINT] = {"ULINT", 64, false},
    [CM1E_TRACE_REAL] = {"REAL", 0, true}, [CM1E_TRACE_LREAL] = {"LREAL", 0, true},
};

const char *cm1e_variable_type(const variable_t *variable)
{
    static const char *const texts[] = {[VARIABLE_STRING] = "STRING", [VARIABLE_WSTRING] = "WSTRING"};
    return variable->form == VARIABLE_NUMBER ? types[variable->type].name : texts[variable->form];
}

/* ---- shown ------------------------------------------------------------------------------------------------------- */

/** JSON has integers of 64 bits with a sign: a ULINT above them is the text of its digits. */
json_t *cm1e_variable_number_show(const variable_t *variable, const variable_value_t *value)
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

json_t *cm1e_variable_enumerator_show(const variable_t *variable, const variable_value_t *value)
{
    json_t *number = cm1e_variable_number_show(variable, value);
    const char *name = cm1e_variable_enumerator(variable, json_integer_value(number));
    json_decref(number);
    return name ? cm1e_json_text(name) : json_null();
}

/* ---- taken ------------------------------------------------------------------------------------------------------- */

/** The bytes of a number in its type; false: it is no value of it. */
static bool encode(const json_t *value, cm1e_trace_type_t type, variable_value_t *out)
{
    const double real = json_is_boolean(value) ? json_is_true(value) : json_number_value(value);
    const int64_t whole = json_is_boolean(value) ? json_is_true(value) : json_integer_value(value); /* 0: none */
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

/** The name behind its type: A of "E.A" and "E#A", if E is the type; else the whole. */
static const char *bare_name(const variable_t *variable, const char *word)
{
    const size_t length = strlen(variable->declared);
    const bool qualified = strncasecmp(word, variable->declared, length) == 0 &&
                           (word[length] == '.' || word[length] == '#');
    return qualified ? word + length + 1 : word;
}

/** A value of an enumeration, by name or as a number. */
static bool take_enumerator(const variable_t *variable, const json_t *value, variable_value_t *out)
{
    const char *word = json_is_string(value) ? bare_name(variable, json_string_value(value)) : NULL;
    int64_t whole = json_integer_value(value);
    bool good = json_is_integer(value) && cm1e_variable_enumerator(variable, whole);
    for (uint32_t i = 0; i < variable->name_count && word && !good; i++) {
        good = strcasecmp(variable->names[i], word) == 0;
        whole = variable->values[i];
    }
    *out = (variable_value_t){{0}};
    memcpy(out->bytes, &whole, sizeof whole);
    return good;
}

bool cm1e_variable_number_take(const variable_t *variable, const json_t *value, variable_value_t *out)
{
    if (variable->name_count > 0)
        return take_enumerator(variable, value, out);
    if (json_is_string(value))
        return variable->type == CM1E_TRACE_ULINT && !variable->ranged && encode_digits(json_string_value(value), out);
    if (json_is_boolean(value) && variable->type != CM1E_TRACE_BOOL)
        return false;
    if (!(json_is_number(value) || json_is_boolean(value)) || !encode(value, variable->type, out))
        return false;
    const json_int_t whole = json_integer_value(value);
    return !variable->ranged || (json_is_integer(value) && whole >= variable->first && whole <= variable->last);
}

/* ---- expected ---------------------------------------------------------------------------------------------------- */

static void whole_range(const variable_t *variable, char *text, size_t size)
{
    const int bits = types[variable->type].bits, magnitude = bits - types[variable->type].is_signed;
    const uint64_t last = magnitude == 64 ? UINT64_MAX : (UINT64_C(1) << magnitude) - 1;
    if (variable->ranged)
        snprintf(text, size, "%" PRId64 " ... %" PRId64, variable->first, variable->last);
    else if (types[variable->type].is_signed)
        snprintf(text, size, "%" PRId64 " ... %" PRIu64, -(int64_t)last - 1, last);
    else
        snprintf(text, size, "0 ... %" PRIu64, last);
}

/** As many as there is room for. */
static void enumerators(const variable_t *variable, char *text, size_t size)
{
    size_t used = 0;
    for (uint32_t i = 0; i < variable->name_count; i++) {
        const size_t length = strlen(variable->names[i]);
        if (used + length + 8 > size) {
            snprintf(text + used, size - used, ", ...");
            return;
        }
        used += (size_t)snprintf(text + used, size - used, "%s%s", i ? ", " : "", variable->names[i]);
    }
}

void cm1e_variable_expected(const variable_t *variable, char *text, size_t size)
{
    char values[200] = "";
    if (variable->form != VARIABLE_NUMBER)
        snprintf(values, sizeof values, "a text of at most %u %s",
                 variable->bytes / (variable->form == VARIABLE_WSTRING ? 2 : 1) - 1,
                 variable->form == VARIABLE_WSTRING ? "characters of 16 bits" : "bytes");
    else if (variable->name_count > 0)
        enumerators(variable, values, sizeof values);
    else if (variable->type == CM1E_TRACE_BOOL)
        snprintf(values, sizeof values, "TRUE or FALSE");
    else if (types[variable->type].bits == 0)
        snprintf(values, sizeof values, "a finite number%s",
                 variable->type == CM1E_TRACE_REAL ? " up to 3.402823e+38" : "");
    else
        whole_range(variable, values, sizeof values);
    snprintf(text, size, "%.100s (%.60s) takes %s%s%s.", variable->name, variable->declared, values,
             variable->unit[0] ? " " : "", variable->unit);
}
