/* Calls of functions, and conversions, in C. */
#include "st/st_emit.h"

#include <ctype.h>
#include <string.h>

static const arg_t *arg_of(const expr_t *call, const var_t *var)
{
    for (const arg_t *arg = call->args; arg; arg = arg->next)
        if (arg->parameter == var)
            return arg;
    return NULL;
}

bool cm1e_st_is_variable(const expr_t *expr)
{
    return cm1e_st_is_place(expr) && (!expr->value.known || expr->type->kind == T_STRING);
}

void cm1e_st_emit_address(st_t *st, const expr_t *expr)
{
    const bool variable = cm1e_st_is_variable(expr);
    cm1e_st_put(st, "&");
    if (!variable)
        cm1e_st_put(st, "(%s){", cm1e_st_c_type(st, expr->type));
    cm1e_st_emit_expression(st, expr);
    cm1e_st_put(st, variable ? "" : "}");
}

static void emit_bounds(st_t *st, const type_t *array, bool last)
{
    cm1e_st_put(st, ", {");
    for (int i = 0; i < array->dimension_count; i++) {
        const dimension_t *d = &array->dimensions[i];
        cm1e_st_put(st, "%s%lld", i ? ", " : "", (long long)(last ? d->last : d->first));
    }
    cm1e_st_put(st, "}");
}

void cm1e_st_emit_given(st_t *st, const var_t *parameter, const expr_t *expr)
{
    const bool opens = parameter->type->open && !expr->type->open;
    cm1e_st_put(st, opens ? "&(st_open_t){" : "");
    cm1e_st_emit_address(st, expr);
    if (!opens)
        return;
    emit_bounds(st, expr->type, false);
    emit_bounds(st, expr->type, true);
    cm1e_st_put(st, "}");
}

/** An input that a call leaves out has its initial value, or 0. */
static void emit_missing(st_t *st, const expr_t *call, const var_t *var)
{
    if (var->type->kind == T_STRING) {
        if (var->initial)
            cm1e_st_emit_text(st, var->initial);
        else
            cm1e_st_put(st, "%s", var->type->wide ? "(const uint16_t[1]){0}" : "\"\"");
    } else if (cm1e_st_has_default_function(var)) {
        cm1e_st_put(st, "%s(", cm1e_st_default_function(st, var));
        cm1e_st_emit_instance(st, call);
        cm1e_st_put(st, ")");
    } else if (var->initial)
        cm1e_st_emit_expression(st, var->initial);
    else if (var->type->kind == T_STRUCT || var->type->kind == T_ARRAY)
        cm1e_st_put(st, "(%s){0}", var->type->c_name);
    else if (cm1e_st_needs_initial(var->type))
        cm1e_st_put(st, "%s", cm1e_st_int64(st, cm1e_st_default_of(var->type)));
    else
        cm1e_st_put(st, "0");
}

static void emit_function_call(st_t *st, const expr_t *call)
{
    const char *comma = "";
    if (call->unit->kind == U_METHOD) {
        cm1e_st_emit_method(st, call);
        comma = ", ";
    } else {
        cm1e_st_put(st, "%s(", call->unit->c_name);
    }
    for (const var_t *var = call->unit->vars; var; var = var->next) {
        const arg_t *arg = arg_of(call, var);
        if (var->section != V_INPUT && var->section != V_OUTPUT && var->section != V_IN_OUT)
            continue;
        cm1e_st_put(st, "%s", comma);
        comma = ", ";
        if (var->section == V_INPUT && (!arg || !arg->value))
            emit_missing(st, call, var);
        else if (var->section == V_INPUT && var->type->kind == T_STRING)
            cm1e_st_emit_text(st, arg->value);
        else if (var->section == V_INPUT)
            cm1e_st_emit_expression(st, arg->value);
        else if (arg && arg->value)
            cm1e_st_emit_given(st, var, arg->value);
        else
            cm1e_st_put(st, "NULL");
    }
    cm1e_st_put(st, ")");
}

/* ---- standard functions ------------------------------------------------------------------------------------------ */

static void emit_lower(st_t *st, const char *name)
{
    for (; *name; name++)
        cm1e_st_put(st, "%c", tolower((unsigned char)*name));
}

/** st_max_INT(st_max_INT(a, b), c) */
static void emit_chain(st_t *st, const char *function, const arg_t *args)
{
    int count = 0;
    for (const arg_t *arg = args; arg; arg = arg->next)
        count++;
    for (int i = 1; i < count; i++)
        cm1e_st_put(st, "%s(", function);
    for (const arg_t *arg = args; arg; arg = arg->next) {
        if (arg != args)
            cm1e_st_put(st, ", ");
        if (arg->value->type->kind == T_STRING)
            cm1e_st_emit_text(st, arg->value);
        else
            cm1e_st_emit_expression(st, arg->value);
        if (arg != args)
            cm1e_st_put(st, arg->value->type->kind == T_STRING && arg->next ? ").text" : ")");
    }
}

static void emit_args(st_t *st, const arg_t *args)
{
    for (const arg_t *arg = args; arg; arg = arg->next) {
        if (arg->value->type->kind == T_STRING)
            cm1e_st_emit_text(st, arg->value);
        else
            cm1e_st_emit_expression(st, arg->value);
        if (arg->next)
            cm1e_st_put(st, ", ");
    }
}

/** MUX, and SEL of texts. */
static void emit_mux(st_t *st, const expr_t *call)
{
    const bool text = call->type->kind == T_STRING;
    const char *type = text ? cm1e_st_text_unit(call->type) : cm1e_st_plain_type(call->type);
    int count = 0;
    for (const arg_t *arg = call->args->next; arg; arg = arg->next)
        count++;
    cm1e_st_put(st, "st_%s((int64_t)", text ? (call->type->wide ? "wmux" : "mux") :
                cm1e_st_format(st->arena, "mux_%s", type));
    cm1e_st_emit_expression(st, call->args->value);
    cm1e_st_put(st, text ? ", %d, (%s *const[]){" : ", %d, (const %s[]){", count, type);
    emit_args(st, call->args->next);
    cm1e_st_put(st, "}, ST_HERE)");
}

static void emit_real_function(st_t *st, const expr_t *call, const char *name)
{
    static const struct { const char *st, *c; } names[] = {{"LN", "log"}, {"LOG", "log10"}};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (strcmp(name, names[i].st) == 0)
            name = names[i].c;
    emit_lower(st, name);
    cm1e_st_put(st, call->type->kind == T_REAL ? "f(" : "(");
    emit_args(st, call->args);
    cm1e_st_put(st, ")");
}

static void emit_standard(st_t *st, const expr_t *call)
{
    static const char *const typed[] = {"ABS", "LIMIT", "SEL", "SHL", "SHR", "ROL", "ROR", NULL};
    static const char *const plain[] = {"LEFT", "RIGHT", "MID", "INSERT", "DELETE", "REPLACE", "FIND", NULL};
    const char *name = cm1e_st_standard_name(call->standard);
    const char *type = cm1e_st_plain_type(call->type);
    const bool text = call->type->kind == T_STRING;
    if (strcmp(name, "MUX") == 0 || (strcmp(name, "SEL") == 0 && text)) {
        emit_mux(st, call);
        return;
    }
    for (int i = 0; typed[i]; i++)
        if (strcmp(name, typed[i]) == 0) {
            cm1e_st_put(st, "st_");
            emit_lower(st, name);
            cm1e_st_put(st, "_%s(", strcmp(name, "ABS") == 0 ? call->type->name : type);
            emit_args(st, call->args);
            cm1e_st_put(st, ")");
            return;
        }
    for (int i = 0; plain[i]; i++)
        if (strcmp(name, plain[i]) == 0) {
            cm1e_st_put(st, call->args->value->type->wide ? "st_w" : "st_");
            emit_lower(st, name);
            cm1e_st_put(st, "(");
            emit_args(st, call->args);
            cm1e_st_put(st, ")");
            return;
        }
    if (strcmp(name, "MIN") == 0 || strcmp(name, "MAX") == 0)
        emit_chain(st, cm1e_st_format(st->arena, "st_%s_%s", strcmp(name, "MIN") == 0 ? "min" : "max", type),
                   call->args);
    else if (strcmp(name, "CONCAT") == 0)
        emit_chain(st, call->type->wide ? "st_wconcat" : "st_concat", call->args);
    else if (strcmp(name, "LEN") == 0) {
        cm1e_st_put(st, call->args->value->type->wide ? "(INT)st_wlength(" : "(INT)strlen(");
        emit_args(st, call->args);
        cm1e_st_put(st, ")");
    } else if (strcmp(name, "TRUNC") == 0) {
        cm1e_st_put(st, "(DINT)st_round(trunc((double)");
        emit_args(st, call->args);
        cm1e_st_put(st, "), INT32_MIN, INT32_MAX)");
    } else if (call->args && call->args->value->type->open) { /* LOWER_BOUND, UPPER_BOUND */
        cm1e_st_emit_expression(st, call->args->value);
        cm1e_st_put(st, ".%s[%lld]", name[0] == 'L' ? "first" : "last",
                    (long long)call->args->next->value->value.integer - 1);
    } else if (strcmp(name, "TIME") == 0) {
        cm1e_st_put(st, "cm1e_scan_time()");
    } else if (strcmp(name, "__ISVALIDREF") == 0) {
        cm1e_st_put(st, "(BOOL)(NULL != ");
        emit_args(st, call->args);
        cm1e_st_put(st, ")");
    } else if (strcmp(name, "REF") == 0 || strcmp(name, "ADR") == 0) {
        cm1e_st_emit_address(st, call->args->value);
    } else {
        emit_real_function(st, call, name);
    }
}

void cm1e_st_emit_call(st_t *st, const expr_t *call)
{
    if (call->standard)
        emit_standard(st, call);
    else
        emit_function_call(st, call);
}

/* ---- conversions ------------------------------------------------------------------------------------------------- */

static void around(st_t *st, const char *before, const expr_t *expr, const char *after)
{
    cm1e_st_put(st, "%s", before);
    if (expr->type->kind == T_STRING)
        cm1e_st_emit_text(st, expr);
    else
        cm1e_st_emit_expression(st, expr);
    cm1e_st_put(st, "%s", after);
}

/** The ends of an integer type, as C. */
static const char *ends_of(type_kind_t kind)
{
    switch (kind) {
    case T_SINT: return "INT8_MIN, INT8_MAX";
    case T_INT: return "INT16_MIN, INT16_MAX";
    case T_DINT: return "INT32_MIN, INT32_MAX";
    case T_BYTE:
    case T_USINT: return "0, UINT8_MAX";
    case T_WORD:
    case T_UINT: return "0, UINT16_MAX";
    case T_DWORD:
    case T_UDINT: return "0, UINT32_MAX";
    default: return "INT64_MIN, INT64_MAX";
    }
}

/** A WSTRING becomes a STRING first. */
static void from_text(st_t *st, const expr_t *expr)
{
    const type_kind_t to = expr->type->kind;
    const bool wide = expr->a->type->wide;
    const char *narrow = wide ? "st_narrow(" : "", *end = wide ? ").text" : "";
    const char *reads = to == T_BOOL ? "bool" : to == T_TIME ? "time" : to == T_ULINT || to == T_LWORD ? "unsigned" :
                        cm1e_st_is_floating(to) ? "real" : NULL;
    if (reads)
        around(st, cm1e_st_format(st->arena, "(%s)st_%s_of(%s", expr->type->name, reads, narrow), expr->a,
               cm1e_st_format(st->arena, "%s)", end));
    else
        around(st, cm1e_st_format(st->arena, "(%s)st_integer_of(%s", expr->type->name, narrow), expr->a,
               cm1e_st_format(st->arena, "%s, %s)", end, ends_of(to)));
}

static void to_string(st_t *st, const expr_t *expr)
{
    const type_kind_t from = cm1e_st_plain_kind(expr->a->type);
    if (from == T_BOOL)
        around(st, "st_text_of_bool(", expr->a, ")");
    else if (from == T_TIME)
        around(st, "st_text_of_time(", expr->a, ")");
    else if (cm1e_st_is_time(from))
        around(st, "st_text_of_date(", expr->a, from == T_DATE ? ", 1, 0)" : from == T_TOD ? ", 0, 1)" : ", 1, 1)");
    else if (cm1e_st_is_floating(from))
        around(st, "st_text_of_real(", expr->a, from == T_REAL ? ", 7)" : ", 15)");
    else if (cm1e_st_is_signed(from))
        around(st, "st_text_of_integer(", expr->a, ")");
    else
        around(st, "st_text_of_unsigned(", expr->a, ")");
}

static void to_text(st_t *st, const expr_t *expr)
{
    if (expr->type->wide)
        cm1e_st_put(st, "st_widen(");
    to_string(st, expr);
    if (expr->type->wide)
        cm1e_st_put(st, ".text)");
}

/** DATE and DT are seconds since 1970 where they become integers, TOD is milliseconds, as in TwinCAT and CODESYS. */
static void with_date(st_t *st, const expr_t *expr)
{
    const type_kind_t from = expr->a->type->kind, to = expr->type->kind;
    const char *name = expr->type->name;
    if (cm1e_st_is_time(from))
        around(st, cm1e_st_format(st->arena, "(%s)(", name), expr->a, from == T_TOD ? " / 1000000)" : " / 1000000000)");
    else if (to == T_DT)
        around(st, "((DT)", expr->a, " * 1000000000)");
    else
        around(st, to == T_TOD ? "st_time_of_day((TOD)" : "st_date_of((DATE)", expr->a,
               to == T_TOD ? " * 1000000)" : " * 1000000000)");
}

/** TIME counts milliseconds where it becomes a number. */
static void with_time(st_t *st, const expr_t *expr)
{
    const type_kind_t from = expr->a->type->kind, to = expr->type->kind;
    const char *name = expr->type->name;
    if (from != T_TIME && to != T_TIME && cm1e_st_is_time(from) != cm1e_st_is_time(to))
        with_date(st, expr);
    else if (from == T_DT && to == T_DATE)
        around(st, "st_date_of(", expr->a, ")");
    else if (from == T_DT)
        around(st, "st_time_of_day(", expr->a, ")");
    else if (from == T_DATE)
        around(st, "(DT)", expr->a, "");
    else if (from == T_TIME && cm1e_st_is_floating(to))
        around(st, cm1e_st_format(st->arena, "(%s)((double)", name), expr->a, " / 1e6)");
    else if (from == T_TIME)
        around(st, cm1e_st_format(st->arena, "(%s)(", name), expr->a, to == T_BOOL ? " != 0)" : " / 1000000)");
    else if (cm1e_st_is_floating(from))
        around(st, "st_time_scaled(1000000, ", expr->a, ")");
    else
        around(st, "(TIME)((TIME)", expr->a, " * 1000000)");
}

void cm1e_st_emit_conversion(st_t *st, const expr_t *expr)
{
    const type_kind_t from = expr->a->type->kind, to = expr->type->kind;
    const char *name = expr->type->name;
    if (from == T_BLOCK)
        around(st, "(st_interface_t)&", expr->a, "");
    else if (expr->type->ranged)
        around(st, cm1e_st_format(st->arena, "(%s)st_within((int64_t)", name), expr->a,
               cm1e_st_format(st->arena, ", %s, %s, ST_HERE)", cm1e_st_int64(st, expr->type->first),
                              cm1e_st_int64(st, expr->type->last)));
    else if (from == T_STRING && to == T_STRING && expr->type->wide != expr->a->type->wide)
        around(st, expr->type->wide ? "st_widen(" : "st_narrow(", expr->a, ")");
    else if (from == to && from != T_ENUM)
        cm1e_st_emit_expression(st, expr->a);
    else if (from == T_STRING)
        from_text(st, expr);
    else if (to == T_STRING)
        to_text(st, expr);
    else if (cm1e_st_is_time(from) || cm1e_st_is_time(to))
        with_time(st, expr);
    else if (to == T_BOOL)
        around(st, "(BOOL)(", expr->a, " != 0)");
    else if (cm1e_st_is_floating(from) && to == T_ULINT)
        around(st, "st_round_unsigned(", expr->a, ")");
    else if (cm1e_st_is_floating(from) && !cm1e_st_is_floating(to))
        around(st, cm1e_st_format(st->arena, "(%s)st_round(", name), expr->a,
               cm1e_st_format(st->arena, ", %s)", ends_of(to)));
    else
        around(st, cm1e_st_format(st->arena, "(%s)", name), expr->a, "");
}
