/* What is computed while the program is translated: operations on values that are known. */
#include <math.h>

#include "st/st_parsing.h"

/** An integer without a type beyond 64 bits, or a division by zero: the expression has no value. */
static void no_value(st_t *st, expr_t *expr, const char *why)
{
    cm1e_st_report(st, expr->place, "%s", why);
    expr->type = st->elementary[T_WRONG];
}

static double real_operation(operation_t op, double a, double b)
{
    switch (op) {
    case OP_ADD: return a + b;
    case OP_SUB: return a - b;
    case OP_MUL: return a * b;
    case OP_DIV: return a / b;
    default: return pow(a, b);
    }
}

static void fold_real(st_t *st, expr_t *expr)
{
    const double a = expr->a->value.real, b = expr->b ? expr->b->value.real : 0;
    double result = expr->kind == E_UNARY ? -a : real_operation(expr->op, a, b);
    if (expr->type->kind == T_REAL)
        result = (float)result;
    if (!isfinite(result) && expr->type->kind == T_ANY_REAL) {
        no_value(st, expr, "the value of this expression is no finite number");
        return;
    }
    expr->value = (constant_t){.known = isfinite(result), .real = result};
}

/** Numbers without a type are computed exactly, in 64 bits with a sign. */
static void fold_any(st_t *st, expr_t *expr)
{
    const int64_t a = expr->a->value.integer, b = expr->b ? expr->b->value.integer : 0;
    int64_t result = 0;
    bool overflow = expr->a->value.huge || (expr->b && expr->b->value.huge);
    if ((expr->op == OP_DIV || expr->op == OP_MOD) && b == 0) {
        no_value(st, expr, "this divides by zero");
        return;
    }
    switch (expr->op) {
    case OP_NEGATE:
        overflow = expr->a->value.huge ? (uint64_t)a != (uint64_t)INT64_MAX + 1 : a == INT64_MIN;
        result = (int64_t)(0 - (uint64_t)a);
        break;
    case OP_ADD: overflow |= __builtin_add_overflow(a, b, &result); break;
    case OP_SUB: overflow |= __builtin_sub_overflow(a, b, &result); break;
    case OP_MUL: overflow |= __builtin_mul_overflow(a, b, &result); break;
    case OP_DIV: overflow |= a == INT64_MIN && b == -1; result = overflow ? 0 : a / b; break;
    case OP_MOD: result = b == -1 ? 0 : a % b; break;
    case OP_AND: result = a & b; break;
    case OP_OR: result = a | b; break;
    case OP_XOR: result = a ^ b; break;
    case OP_NOT: return; /* of how many bits is not known yet */
    default: return;
    }
    if (overflow)
        no_value(st, expr, "the value of this expression has more than 64 bits");
    else
        expr->value = (constant_t){.known = true, .integer = result};
}

/** Integers, bits and times with a type wrap, as they do in the running program. */
static void fold_typed(expr_t *expr)
{
    const type_kind_t kind = expr->type->kind;
    const uint64_t a = (uint64_t)expr->a->value.integer, b = expr->b ? (uint64_t)expr->b->value.integer : 0;
    const bool is_signed = cm1e_st_is_signed(kind) || cm1e_st_is_time(kind);
    uint64_t result;
    switch (expr->op) {
    case OP_NEGATE: result = 0 - a; break;
    case OP_NOT: result = ~a; break;
    case OP_ADD: result = a + b; break;
    case OP_SUB: result = a - b; break;
    case OP_MUL: result = a * b; break;
    case OP_AND: result = a & b; break;
    case OP_OR: result = a | b; break;
    case OP_XOR: result = a ^ b; break;
    case OP_DIV:
        if (b == 0)
            return; /* the running program stops there */
        result = !is_signed ? a / b : (int64_t)b == -1 ? 0 - a : (uint64_t)((int64_t)a / (int64_t)b);
        break;
    case OP_MOD:
        result = b == 0 || (is_signed && (int64_t)b == -1) ? 0
            : is_signed ? (uint64_t)((int64_t)a % (int64_t)b) : a % b;
        break;
    default: return;
    }
    const int64_t value = cm1e_st_wrap(kind, (int64_t)result);
    expr->value = (constant_t){.known = true, .integer = value, .huge = !is_signed && value < 0};
}

void cm1e_st_fold(st_t *st, expr_t *expr)
{
    const type_kind_t kind = expr->type->kind;
    if (!expr->a->value.known || (expr->b && !expr->b->value.known) || expr->type->kind > T_DT + 2)
        return;
    if (expr->b && (expr->a->type != expr->type || expr->b->type != expr->type))
        return; /* a comparison, or a time with a number */
    if (cm1e_st_is_floating(kind))
        fold_real(st, expr);
    else if (kind == T_ANY_INT)
        fold_any(st, expr);
    else
        fold_typed(expr);
}

bool cm1e_st_check_integer(st_t *st, expr_t *expr, int64_t *value, const char *what)
{
    cm1e_st_expression(st, expr);
    const type_kind_t kind = expr->type->kind;
    if (kind == T_WRONG)
        return false;
    const bool whole = cm1e_st_is_integer(kind) || cm1e_st_is_bits(kind) || kind == T_ENUM;
    if (whole && expr->value.known && !expr->value.huge) {
        *value = expr->value.integer;
        return true;
    }
    if (whole && expr->value.known)
        cm1e_st_report(st, expr->place, "%s is larger than the largest LINT", what);
    else if (whole)
        cm1e_st_report(st, expr->place, "%s must be known before the program runs: a number or a CONSTANT", what);
    else
        cm1e_st_report(st, expr->place, "%s is an integer, not %s", what, cm1e_st_type_name(expr->type));
    return false;
}

void cm1e_st_fold_comparison(expr_t *expr)
{
    const constant_t *a = &expr->a->value, *b = &expr->b->value;
    const type_kind_t kind = cm1e_st_plain_kind(expr->a->type);
    if (!a->known || !b->known || kind > T_ANY_REAL || expr->a->impure || expr->b->impure)
        return;
    const bool floating = cm1e_st_is_floating(kind), above = cm1e_st_is_unsigned(kind) || cm1e_st_is_bits(kind);
    const bool less = floating ? a->real < b->real
        : above ? (uint64_t)a->integer < (uint64_t)b->integer : a->integer < b->integer;
    const bool equal = floating ? a->real == b->real : a->integer == b->integer;
    const bool more = floating ? a->real > b->real : !less && !equal;
    const bool values[] = {[OP_EQ] = equal, [OP_NE] = !equal, [OP_LT] = less, [OP_GT] = more, [OP_LE] = less || equal,
                           [OP_GE] = more || equal};
    expr->value = (constant_t){.known = true, .integer = values[expr->op]};
}
