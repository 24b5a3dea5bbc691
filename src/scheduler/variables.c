#include "scheduler/variables.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/** From here on a double does not hold every whole number; without the low bits it holds those of 64 bits. */
#define EXACT 9007199254740992.0
enum { LOW_BITS = 0x7FF };

static size_t size_of(cm1e_trace_type_t type)
{
    static const uint8_t sizes[] = {1, 1, 2, 4, 8, 1, 2, 4, 8, 4, 8};
    return sizes[type];
}

uint32_t cm1e_variables_find(const variables_t *variables, const char *name)
{
    uint32_t i = 0;
    while (i < variables->count && strcasecmp(variables->rows[i].name, name) != 0)
        i++;
    return i;
}

bool cm1e_variable_is_within(const char *name, const char *path)
{
    const size_t length = strlen(path);
    return strncasecmp(name, path, length) == 0 && (!name[length] || name[length] == '.' || name[length] == '[');
}

double cm1e_variable_number(const variable_t *variable)
{
    const trace_column_t column = {.type = variable->type, .value = variable->data};
    if (variable->bit)
        return *(const uint8_t *)variable->data >> (variable->bit - 1) & 1;
    return variable->form == VARIABLE_NUMBER ? cm1e_trace_value(&column) : 0;
}

double cm1e_variable_number_of(const variable_t *variable, const variable_value_t *value, double *rest)
{
    const trace_column_t column = {.type = variable->type, .value = value->bytes};
    const double number = variable->form == VARIABLE_NUMBER ? cm1e_trace_value(&column) : 0;
    uint64_t whole;
    *rest = 0;
    if ((column.type != CM1E_TRACE_LINT && column.type != CM1E_TRACE_ULINT) || fabs(number) < EXACT)
        return number;
    memcpy(&whole, value->bytes, sizeof whole);
    const uint64_t low = whole & LOW_BITS;
    *rest = (double)low;
    return column.type == CM1E_TRACE_LINT ? (double)(int64_t)(whole - low) : (double)(whole - low);
}

double cm1e_variable_decimal(float value)
{
    char text[40];
    int digits = FLT_DIG;
    do
        snprintf(text, sizeof text, "%.*g", digits, (double)value);
    while (strtof(text, NULL) != value && digits++ < FLT_DECIMAL_DIG);
    return strtod(text, NULL);
}

const char *cm1e_variable_enumerator(const variable_t *variable, int64_t value)
{
    uint32_t i = 0;
    while (i < variable->name_count && variable->values[i] != value)
        i++;
    return i < variable->name_count ? variable->names[i] : NULL;
}

/** The bytes of a text up to its final 0. */
static size_t used_bytes(const variable_t *variable, const uint8_t *bytes)
{
    const size_t step = variable->form == VARIABLE_WSTRING ? 2 : 1;
    size_t used = 0;
    while (used + step < variable->bytes && (bytes[used] || bytes[used + step - 1]))
        used += step;
    return used;
}

void cm1e_variable_read(const variable_t *variable, variable_value_t *value)
{
    if (variable->bit) {
        value->bytes[0] = cm1e_variable_number(variable) != 0;
        return;
    }
    if (variable->form == VARIABLE_NUMBER) {
        memcpy(value->bytes, variable->data, size_of(variable->type));
        return;
    }
    const size_t used = used_bytes(variable, variable->data);
    memcpy(value->bytes, variable->data, used);
    value->bytes[used] = value->bytes[used + 1] = 0;
}

void cm1e_variable_write(const variable_t *variable, const variable_value_t *value)
{
    uint8_t *const data = variable->data;
    if (variable->bit)
        *data = (uint8_t)((*data & ~(1u << (variable->bit - 1))) |
                          (unsigned)(value->bytes[0] != 0) << (variable->bit - 1));
    else
        memcpy(data, value->bytes, variable->form == VARIABLE_NUMBER ? size_of(variable->type) : variable->bytes);
}

cm1e_error_t cm1e_variable_trace(const variable_t *variable, trace_t *trace, cm1e_diag_t *diag)
{
    trace_column_t column = {.type = variable->type, .value = variable->data, .bit = variable->bit};
    if (variable->form != VARIABLE_NUMBER)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "\"%s\" is a text; a trace records numbers.",
                             variable->name);
    if (strlen(variable->name) >= sizeof column.name)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "The name \"%s\" is longer than the %zu bytes of a "
                             "signal in a trace.", variable->name, sizeof column.name - 1);
    snprintf(column.name, sizeof column.name, "%s", variable->name);
    snprintf(column.unit, sizeof column.unit, "%s", variable->unit);
    return cm1e_trace_add(trace, &column, diag);
}

cm1e_error_t cm1e_scheduler_trace_number(cm1e_scheduler_t *scheduler, const variable_t *variable, cm1e_diag_t *diag)
{
    return cm1e_variable_trace(variable, (trace_t *)(uintptr_t)cm1e_scheduler_trace(scheduler), diag);
}
