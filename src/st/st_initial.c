/* Initial values: expressions, and lists of the members of a structure or of the elements of an array. */
#include "st/st_parsing.h"

enum { MAX_ELEMENTS = 1000000 };

static void initialise_struct(st_t *st, expr_t *initial, type_t *type)
{
    if (type->kind != T_STRUCT && type->kind != T_BLOCK) {
        cm1e_st_report(st, initial->place, "%s has no members that could get values", cm1e_st_type_name(type));
        return;
    }
    if (type->overlay && initial->args && initial->args->next)
        cm1e_st_report(st, initial->args->next->place, "one member of a UNION gets a value: that is the value of all");
    for (arg_t *arg = initial->args; arg; arg = arg->next) {
        const char *hint, *ours = cm1e_st_alias(type->name, arg->name, &hint);
        arg->parameter = cm1e_st_member(type, ours ? ours : arg->name);
        if (!arg->parameter || arg->parameter->section == V_IN_OUT || arg->parameter->section == V_EXTERNAL) {
            cm1e_st_report(st, arg->place, "%s has no member \"%s\" that could get a value%s",
                           cm1e_st_type_name(type), arg->name,
                           cm1e_st_meant_var(st, arg->name, type->members, ~(1u << V_IN_OUT | 1u << V_EXTERNAL)));
            arg->parameter = NULL;
            continue;
        }
        for (const arg_t *other = initial->args; other != arg; other = other->next)
            if (other->parameter == arg->parameter)
                cm1e_st_report(st, arg->place, "\"%s\" has a value already", arg->name);
        arg->value = cm1e_st_initialiser(st, arg->value, cm1e_st_resolve(st, arg->parameter->type), arg->name);
    }
}

/** Type of what one index list selects: arrays of several dimensions are initialised in one flat list. */
static void initialise_array(st_t *st, expr_t *initial, type_t *type)
{
    if (type->kind != T_ARRAY) {
        cm1e_st_report(st, initial->place, "%s has no elements that could get values", cm1e_st_type_name(type));
        return;
    }
    int64_t count = 0, most = type->element->size ? (int64_t)(type->size / type->element->size) : 0;
    for (arg_t *arg = initial->args; arg; arg = arg->next) {
        int64_t times = 1;
        if (arg->value->kind == E_REPEAT) {
            if (!cm1e_st_integer_constant(st, arg->value->a, &times, "the number of repetitions"))
                return;
            arg->value->b = cm1e_st_initialiser(st, arg->value->b, type->element, "the element");
        } else {
            arg->value = cm1e_st_initialiser(st, arg->value, type->element, "the element");
        }
        if (times < 0 || times > MAX_ELEMENTS || (count += times) > most) {
            cm1e_st_report(st, arg->place, "there are more values than the %lld elements of the array",
                           (long long)most);
            return;
        }
    }
    st->elements += (uint64_t)count;
    if (st->elements > MAX_ELEMENTS)
        cm1e_st_report(st, initial->place, "the program has more than %d initial values of elements", MAX_ELEMENTS);
}

expr_t *cm1e_st_initialiser(st_t *st, expr_t *initial, type_t *type, const char *what)
{
    if (type->kind == T_WRONG)
        return initial;
    if (initial->kind == E_STRUCT_INIT || initial->kind == E_ARRAY_INIT)
        initial->type = type;
    if (initial->kind == E_STRUCT_INIT) {
        initialise_struct(st, initial, type);
        return initial;
    }
    if (initial->kind == E_ARRAY_INIT) {
        initialise_array(st, initial, type);
        return initial;
    }
    cm1e_st_expression(st, initial);
    expr_t *value = cm1e_st_coerce(st, initial, type, what);
    if (st->before_all && (type->kind == T_REF || type->kind == T_INTERFACE) && value->type->kind != T_NULL)
        cm1e_st_report(st, value->place, "a VAR_STAT exists before there is an instance: it begins as a reference to "
                       "nothing, and gets its value in a statement");
    if (!value->value.known && value->type->kind != T_WRONG && !value->bit && type->kind != T_REF &&
        type->kind != T_INTERFACE)
        cm1e_st_report(st, value->place, "the initial value of \"%s\" is not known before the program runs: only "
                       "literals, constants and what is computed of them are", what);
    return value;
}
