/* The nodes of the tree. */
#include "st/st_parsing.h"

expr_t *cm1e_st_node(st_t *st, expr_kind_t kind, place_t place, expr_t *a, expr_t *b)
{
    expr_t *expr = cm1e_st_take(st->arena, sizeof *expr);
    const int left = a ? a->depth : 0, right = b ? b->depth : 0;
    *expr = (expr_t){.kind = kind, .place = place, .a = a, .b = b, .depth = 1 + (left > right ? left : right)};
    if (expr->depth <= ST_DEPTH)
        return expr;
    cm1e_st_report(st, place, "this expression is nested deeper than %d: divide it into several statements", ST_DEPTH);
    *expr = (expr_t){.kind = E_LITERAL, .place = place, .depth = 1, .type = st->elementary[T_WRONG]};
    return expr;
}

expr_t *cm1e_st_operation(st_t *st, operation_t op, place_t place, expr_t *a, expr_t *b)
{
    expr_t *expr = cm1e_st_node(st, b ? E_BINARY : E_UNARY, place, a, b);
    expr->op = op;
    return expr;
}

expr_t *cm1e_st_named(st_t *st, expr_kind_t kind, place_t place, expr_t *a, const char *name)
{
    expr_t *expr = cm1e_st_node(st, kind, place, a, NULL);
    expr->name = name;
    expr->scope = st->scope;
    return expr;
}

expr_t *cm1e_st_with_args(st_t *st, expr_kind_t kind, place_t place, expr_t *a, args_t args)
{
    expr_t *deepest = NULL;
    for (arg_t *arg = args.first; arg; arg = arg->next)
        if (arg->value && (!deepest || arg->value->depth > deepest->depth))
            deepest = arg->value;
    expr_t *expr = cm1e_st_node(st, kind, place, a, deepest);
    if (expr->kind != kind)
        return expr;
    expr->b = NULL;
    expr->args = args.first;
    return expr;
}

arg_t *cm1e_st_arg(st_t *st, place_t place, const char *name, expr_t *value)
{
    arg_t *arg = cm1e_st_take(st->arena, sizeof *arg);
    *arg = (arg_t){.name = name, .value = value, .place = place};
    return arg;
}

type_t *cm1e_st_type_node(st_t *st, type_kind_t kind, place_t place, const char *name)
{
    type_t *type = cm1e_st_take(st->arena, sizeof *type);
    *type = (type_t){.kind = kind, .place = place, .name = name, .scope = st->scope};
    return type;
}
