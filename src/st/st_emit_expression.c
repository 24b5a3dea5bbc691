/* Expressions in C. Every operation has the type of ST: what C computes in a wider one is converted back. */
#include "st/st_emit.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const operators[] = {"|", "||", "^", "&", "&&", "==", "!=", "<", ">", "<=", ">=", "+", "-", "*", "/",
                                        "%", "**", "-", "~"};

static void emit_real(st_t *st, double value, const char *suffix, int digits)
{
    char text[40];
    snprintf(text, sizeof text, "%.*g", digits, value);
    cm1e_st_put(st, value < 0 || signbit(value) ? "(%s%s%s)" : "%s%s%s", text, strpbrk(text, ".e") ? "" : ".0", suffix);
}

void cm1e_st_emit_constant(st_t *st, const type_t *type, const constant_t *value)
{
    const type_kind_t kind = cm1e_st_plain_kind(type);
    const int bits = cm1e_st_bits(kind);
    if (kind == T_NULL)
        cm1e_st_put(st, "NULL");
    else if (kind == T_REAL)
        emit_real(st, value->real, "f", 9);
    else if (cm1e_st_is_floating(kind))
        emit_real(st, value->real, "", 17);
    else if (kind == T_BOOL)
        cm1e_st_put(st, value->integer ? "TRUE" : "FALSE");
    else if (cm1e_st_is_unsigned(kind) || cm1e_st_is_bits(kind))
        cm1e_st_put(st, bits == 64 ? "%" PRIu64 "ULL" : "%" PRIu64 "u", (uint64_t)value->integer);
    else if (value->integer == INT64_MIN || (bits == 32 && value->integer == INT32_MIN))
        cm1e_st_put(st, bits == 64 ? "(%" PRId64 "LL - 1)" : "(%" PRId64 " - 1)", value->integer + 1);
    else
        cm1e_st_put(st, value->integer < 0 ? "(%" PRId64 "%s)" : "%" PRId64 "%s", value->integer,
                    bits == 64 ? "LL" : "");
}

/* ---- variables --------------------------------------------------------------------------------------------------- */

static const char *instance_of(const st_t *st, const unit_t *unit)
{
    const instance_t *instance = st->tree.instances;
    while (instance->unit != unit)
        instance = instance->next;
    return instance->name;
}

void cm1e_st_emit_in_out(st_t *st, const var_t *var)
{
    const char *says = cm1e_st_format(st->arena, "\"%s\" is a VAR_IN_OUT of %s and has no variable yet: call the "
                                      "instance with %s := ... before its methods", var->name, var->unit->name,
                                      var->name);
    cm1e_st_put(st, "(*(%s *)st_given(self->%s, ", cm1e_st_c_type(st, var->type), var->c_name);
    cm1e_st_put_quoted(st, says);
    cm1e_st_put(st, ", ST_HERE))");
}

static void emit_variable(st_t *st, const var_t *var)
{
    if (var->section == V_EXTERNAL)
        var = var->global;
    if (var->in_memory) {
        cm1e_st_put(st, "%s", var->c_name);
        return;
    }
    if (!var->unit && var->type->kind == T_BLOCK && var->type->unit->kind == U_PROGRAM) {
        cm1e_st_put(st, "I_%s", instance_of(st, var->type->unit));
        return;
    }
    if (var->unit && var->unit->kind == U_PROGRAM &&
        !(st->unit && (st->unit == var->unit || st->unit->object.owner == var->unit))) {
        cm1e_st_put(st, "I_%s.%s", instance_of(st, var->unit), var->c_name);
        return;
    }
    const bool pointer = var->section == V_IN_OUT;
    if (!var->unit)
        cm1e_st_put(st, "%s", var->c_name);
    else if (cm1e_st_is_function(var->unit))
        cm1e_st_put(st, pointer ? "(*%s)" : "%s", var->c_name);
    else if (var->section == V_TEMP)
        cm1e_st_put(st, "%s", var->c_name);
    else if (pointer && st->unit && st->unit->kind == U_METHOD)
        cm1e_st_emit_in_out(st, var);
    else
        cm1e_st_put(st, pointer ? "(*self->%s)" : "self->%s%s", var->c_name, var->qualifiers & Q_EDGE ? "edge" : "");
}

/** An element of an array of any length. */
static void emit_open_index(st_t *st, const expr_t *expr)
{
    int dimension = 0;
    cm1e_st_put(st, "((%s *)", cm1e_st_c_type(st, expr->a->type->element));
    cm1e_st_emit_expression(st, expr->a);
    cm1e_st_put(st, ".at)[");
    for (int i = 1; i < expr->a->type->dimension_count; i++)
        cm1e_st_put(st, "(");
    for (const arg_t *arg = expr->args; arg; arg = arg->next, dimension++) {
        cm1e_st_put(st, dimension > 0 ? ") * st_width(&" : "st_open_at((int64_t)(");
        if (dimension > 0) {
            cm1e_st_emit_expression(st, expr->a);
            cm1e_st_put(st, ", %d) + st_open_at((int64_t)(", dimension);
        }
        cm1e_st_emit_expression(st, arg->value);
        cm1e_st_put(st, "), &");
        cm1e_st_emit_expression(st, expr->a);
        cm1e_st_put(st, ", %d, ST_HERE)", dimension);
    }
    cm1e_st_put(st, "]");
}

static void emit_index(st_t *st, const expr_t *expr)
{
    const type_t *type = expr->a->type;
    int dimension = 0;
    if (type->open) {
        emit_open_index(st, expr);
        return;
    }
    cm1e_st_emit_expression(st, expr->a);
    cm1e_st_put(st, ".at[");
    for (int i = 1; i < type->dimension_count; i++)
        cm1e_st_put(st, "(");
    for (const arg_t *arg = expr->args; arg; arg = arg->next, dimension++) {
        const dimension_t *d = &type->dimensions[dimension];
        if (dimension > 0)
            cm1e_st_put(st, ") * %llu + ", (unsigned long long)(d->last - d->first + 1));
        if (arg->value->value.known) {
            cm1e_st_put(st, "%llu", (unsigned long long)(arg->value->value.integer - d->first));
            continue;
        }
        cm1e_st_put(st, "ST_AT(");
        cm1e_st_emit_expression(st, arg->value);
        cm1e_st_put(st, ", %lld, %lld)", (long long)d->first, (long long)d->last);
    }
    cm1e_st_put(st, "]");
}

static void emit_member(st_t *st, const expr_t *expr)
{
    if (expr->bit) {
        cm1e_st_put(st, "(BOOL)(((ULINT)");
        cm1e_st_emit_expression(st, expr->a);
        cm1e_st_put(st, " >> %ld) & 1u)", strtol(expr->name, NULL, 10));
    } else if (expr->a->kind == E_THIS && expr->var->section == V_IN_OUT) {
        emit_variable(st, expr->var);
    } else if (expr->a == st->callee) {
        cm1e_st_put(st, "fb->%s", expr->var->c_name);
    } else {
        cm1e_st_emit_expression(st, expr->a);
        cm1e_st_put(st, ".%s", expr->var->c_name);
    }
}

/* ---- operations -------------------------------------------------------------------------------------------------- */

static void emit_pair(st_t *st, const char *before, const expr_t *a, const char *between, const expr_t *b,
                      const char *after)
{
    cm1e_st_put(st, "%s", before);
    cm1e_st_emit_expression(st, a);
    cm1e_st_put(st, "%s", between);
    cm1e_st_emit_expression(st, b);
    cm1e_st_put(st, "%s", after);
}

static void emit_comparison(st_t *st, const expr_t *expr)
{
    if (expr->a->type->kind == T_STRING) {
        cm1e_st_put(st, expr->a->type->wide ? "(st_wcompare(" : "(strcmp(");
        cm1e_st_emit_text(st, expr->a);
        cm1e_st_put(st, ", ");
        cm1e_st_emit_text(st, expr->b);
        cm1e_st_put(st, ") %s 0)", operators[expr->op]);
        return;
    }
    emit_pair(st, "(", expr->a, cm1e_st_format(st->arena, " %s ", operators[expr->op]), expr->b, ")");
}

/** A time with a number: TIME * 2, 1.5 * TIME, TIME / 3. */
static void emit_time_operation(st_t *st, const expr_t *expr)
{
    const bool swapped = !cm1e_st_is_time(expr->a->type->kind);
    const expr_t *time = swapped ? expr->b : expr->a, *number = swapped ? expr->a : expr->b;
    const bool floating = cm1e_st_is_floating(number->type->kind);
    if (expr->op == OP_MUL && floating)
        emit_pair(st, "st_time_scaled(", time, ", ", number, ")");
    else if (expr->op == OP_MUL)
        emit_pair(st, "(", time, " * (TIME)", number, ")");
    else if (floating)
        emit_pair(st, "st_time_divided(", time, ", ", number, ", ST_HERE)");
    else
        emit_pair(st, "st_div_LINT(", time, ", (LINT)", number, ", ST_HERE)");
}

static void emit_binary(st_t *st, const expr_t *expr)
{
    const type_kind_t kind = expr->type->kind;
    const char *name = expr->type->name;
    if (expr->op >= OP_EQ && expr->op <= OP_GE)
        emit_comparison(st, expr);
    else if (cm1e_st_is_time(kind) && (expr->op == OP_MUL || expr->op == OP_DIV))
        emit_time_operation(st, expr);
    else if (expr->op == OP_DIV && cm1e_st_is_integer(kind))
        emit_pair(st, cm1e_st_format(st->arena, "st_div_%s(", name), expr->a, ", ", expr->b, ", ST_HERE)");
    else if (expr->op == OP_MOD)
        emit_pair(st, cm1e_st_format(st->arena, "st_mod_%s(", name), expr->a, ", ", expr->b, ")");
    else if (expr->op == OP_POWER)
        emit_pair(st, kind == T_REAL ? "powf(" : "pow(", expr->a, ", ", expr->b, ")");
    else if (cm1e_st_is_floating(kind) || kind == T_BOOL)
        emit_pair(st, "(", expr->a, cm1e_st_format(st->arena, " %s ", operators[expr->op]), expr->b, ")");
    else
        emit_pair(st, cm1e_st_format(st->arena, "(%s)(", name), expr->a,
                  cm1e_st_format(st->arena, " %s ", operators[expr->op]), expr->b, ")");
}

static void emit_unary(st_t *st, const expr_t *expr)
{
    const char *op = expr->op == OP_NEGATE ? "-" : expr->type->kind == T_BOOL ? "!" : "~";
    cm1e_st_put(st, "(%s)%s(", expr->type->name, op);
    cm1e_st_emit_expression(st, expr->a);
    cm1e_st_put(st, ")");
}

/** A constant in UTF-8 as characters of 16 bits. */
static void emit_wide(st_t *st, const char *text)
{
    cm1e_st_put(st, "(const uint16_t[]){");
    while (*text) {
        const unsigned char first = (unsigned char)*text;
        const int more = first < 0xC0 ? 0 : first < 0xE0 ? 1 : first < 0xF0 ? 2 : 3;
        unsigned c = more ? first & (0x3Fu >> more) : first;
        text++;
        for (int i = 0; i < more && ((unsigned char)*text & 0xC0) == 0x80; i++, text++)
            c = c << 6 | ((unsigned char)*text & 0x3Fu);
        if (c > 0xFFFF)
            cm1e_st_put(st, "0x%X, 0x%X, ", 0xD7C0 + (c >> 10), 0xDC00 | (c & 0x3FF));
        else
            cm1e_st_put(st, "0x%X, ", c);
    }
    cm1e_st_put(st, "0}");
}

void cm1e_st_emit_text(st_t *st, const expr_t *expr)
{
    if (expr->value.known && expr->value.text && expr->type->wide) {
        emit_wide(st, expr->value.text);
    } else if (expr->value.known && expr->value.text) {
        cm1e_st_put_quoted(st, expr->value.text);
    } else if (expr->kind == E_CONVERT && expr->a->type->kind == T_STRING && expr->a->type->wide == expr->type->wide) {
        cm1e_st_emit_text(st, expr->a);
    } else {
        cm1e_st_emit_expression(st, expr);
        cm1e_st_put(st, ".text");
    }
}

void cm1e_st_emit_expression(st_t *st, const expr_t *expr)
{
    if (expr->value.known && expr->type->kind == T_ENUM && expr->var && expr->var->owner &&
        expr->value.integer >= INT32_MIN && expr->value.integer <= INT32_MAX && expr->type->emitted) {
        cm1e_st_put(st, "%s", expr->var->c_name);
        return;
    }
    if (expr->value.known && expr->type->kind != T_STRING) {
        cm1e_st_emit_constant(st, expr->type, &expr->value);
        return;
    }
    switch (expr->kind) {
    case E_NAME: emit_variable(st, expr->var); break;
    case E_MEMBER: emit_member(st, expr); break;
    case E_INDEX: emit_index(st, expr); break;
    case E_DEREF:
        cm1e_st_put(st, "(*(%s *)st_reach(", cm1e_st_c_type(st, expr->type));
        cm1e_st_emit_expression(st, expr->a);
        cm1e_st_put(st, ", ST_HERE))");
        break;
    case E_THIS: cm1e_st_put(st, "(*self)"); break;
    case E_VIEW:
        cm1e_st_put(st, "(%s)cm1e_tc2_axis_value(", expr->type->name);
        cm1e_st_emit_expression(st, expr->a);
        cm1e_st_put(st, ".Handle_, %d)", expr->view);
        break;
    case E_CALL: cm1e_st_emit_call(st, expr); break;
    case E_UNARY: emit_unary(st, expr); break;
    case E_BINARY: emit_binary(st, expr); break;
    case E_CONVERT: cm1e_st_emit_conversion(st, expr); break;
    default: break;
    }
}
