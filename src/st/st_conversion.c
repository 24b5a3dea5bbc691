/* Implicit conversions, which never lose anything, and what can be assigned to. */
#include <string.h>
#include <strings.h>

#include "st/st_parsing.h"
#include "st/st_standard.h"

expr_t *cm1e_st_convert_node(st_t *st, expr_t *expr, type_t *type)
{
    expr_t *node = cm1e_st_node(st, E_CONVERT, expr->place, expr, NULL);
    if (node->kind != E_CONVERT)
        return node;
    node->type = type;
    node->impure = expr->impure;
    node->value = expr->value;
    const type_kind_t from = expr->type->kind;
    if (cm1e_st_is_floating(type->kind) && !cm1e_st_is_floating(from))
        node->value.real = expr->value.huge ? (double)(uint64_t)expr->value.integer : (double)expr->value.integer;
    if (type->kind == T_REAL)
        node->value.real = (float)node->value.real;
    return node;
}

expr_t *cm1e_st_as_integer(st_t *st, expr_t *expr)
{
    return expr->type->kind == T_ENUM ? cm1e_st_convert_node(st, expr, expr->type->element) : expr;
}

static const char *plain_name(const type_t *type) 
{
    return type->kind != T_STRING ? type->name : type->wide ? "WSTRING" : "STRING";
}

/** An enumerator that is known is judged by its value, as a literal is, where a number or bits are wanted. */
static bool is_constant_enumerator(const expr_t *expr, type_kind_t to)
{
    return expr->type->kind == T_ENUM && cm1e_st_is_fixed(expr) && to > T_BOOL && to <= T_LREAL;
}

const char *cm1e_st_hidden_enumerator(const type_t *type, const expr_t *expr, char *text, size_t size)
{
    text[0] = '\0';
    for (const var_t *one = type->kind == T_ENUM && expr->kind == E_NAME ? type->members : NULL; one; one = one->next)
        if (strcasecmp(one->name, expr->name) == 0)
            snprintf(text, size, type->shown ? "; \"%.60s\" is the variable here, and hides the enumerator" :
                     "; \"%.60s\" is the variable here, the enumerator is %.60s#%.60s",
                      expr->name, type->name, one->name);
    return text;
}

static expr_t *refuse(st_t *st, expr_t *expr, const type_t *type, const char *what)
{
    char hidden[240];
    const type_kind_t from = expr->type->kind, to = type->kind;
    if ((from == T_ANY_INT && to <= T_LREAL && expr->value.known) || is_constant_enumerator(expr, to))
        cm1e_st_report(st, expr->place, "%s%lld is not a value of %s, which \"%s\" is",
                       expr->value.huge ? "(as LINT) " : "", (long long)expr->value.integer, type->name, what);
    else if (to == T_TIME && (from == T_ANY_INT || from == T_ANY_REAL))
        cm1e_st_report(st, expr->place, "\"%s\" is TIME, and this is %s: a time is written as T#1s500ms", what,
                       cm1e_st_type_name(expr->type));
    else if (from == T_NONE)
        cm1e_st_report(st, expr->place, "this has no value, and \"%s\" is %s", what, cm1e_st_type_name(type));
    else if ((from <= T_DT || from == T_STRING) && (to <= T_DT || to == T_STRING) && (from != to || from == T_STRING))
        cm1e_st_report(st, expr->place, "\"%s\" is %s, and this is %s: without a conversion a value could be lost or "
                       "change its meaning; %s_TO_%s(...) converts it", what, cm1e_st_type_name(type),
                       cm1e_st_type_name(expr->type), plain_name(expr->type), plain_name(type));
    else if (to == T_ENUM && from != T_ENUM)
        cm1e_st_report(st, expr->place, "\"%s\" is %s, and takes its enumerators, for instance %s%s%s", what,
                       cm1e_st_type_name(type), type->members ? type->members->name : "none", cm1e_st_is_integer(from) ?
                       "; an integer may be none of them: choose one by CASE" : "",
                       cm1e_st_hidden_enumerator(type, expr, hidden, sizeof hidden));
    else if (from == T_ENUM && to > T_BOOL && to <= T_LREAL)
        cm1e_st_report(st, expr->place, "\"%s\" is %s, and %s has values of %s, which could be lost or change their "
                       "meaning: TO_%s(...) converts them", what, cm1e_st_type_name(type),
                       cm1e_st_type_name(expr->type), expr->type->element->name, plain_name(type));
    else
        cm1e_st_report(st, expr->place, "\"%s\" is %s, and this is %s", what, cm1e_st_type_name(type),
                       cm1e_st_type_name(expr->type));
    expr_t *wrong = cm1e_st_node(st, E_LITERAL, expr->place, NULL, NULL);
    wrong->type = st->elementary[T_WRONG];
    return wrong;
}

/** A number without a type gets one. */
static expr_t *give_type(st_t *st, expr_t *expr, type_t *type)
{
    expr_t *node = cm1e_st_node(st, E_LITERAL, expr->place, NULL, NULL);
    node->type = type;
    node->value = expr->value;
    if (cm1e_st_is_floating(type->kind) && !cm1e_st_is_floating(expr->type->kind))
        node->value = (constant_t){.known = true, .real = expr->value.huge ? (double)(uint64_t)expr->value.integer
                                                                          : (double)expr->value.integer};
    if (type->kind == T_REAL)
        node->value.real = (float)node->value.real;
    return node;
}

static bool takes_literal(const expr_t *expr, type_kind_t to)
{
    const type_kind_t from = expr->type->kind;
    if (!expr->value.known || to > T_ANY_REAL || cm1e_st_is_time(to))
        return false;
    if (from == T_ANY_REAL)
        return cm1e_st_is_floating(to) && cm1e_st_fits(to, &expr->value);
    if (is_constant_enumerator(expr, to))
        return cm1e_st_fits(to, &expr->value);
    return from == T_ANY_INT && (cm1e_st_is_floating(to) || to == T_ANY_INT || cm1e_st_fits(to, &expr->value));
}

/** Whether a call of literals only, MAX(1, 2) or SIN(0.5), can have another type. */
static bool can_retype(const expr_t *call, type_kind_t to)
{
    if (!call->untyped || to > T_LREAL || (cm1e_st_is_floating(call->type->kind) && !cm1e_st_is_floating(to)))
        return false;
    for (const arg_t *arg = call->typed_args; arg; arg = arg->next)
        if (!takes_literal(arg->value, to))
            return false;
    return true;
}

/** The literals, and with them the result, take the type that is wanted. */
static void retype(st_t *st, expr_t *call, type_t *type)
{
    if (!can_retype(call, type->kind))
        return;
    for (arg_t *arg = call->typed_args; arg; arg = arg->next)
        arg->value = give_type(st, arg->value, type);
    call->type = type;
    call->untyped = false;
}

/** A REFERENCE TO gets the reference that is behind the name, or the address of a variable. */
static expr_t *refer(st_t *st, expr_t *expr, type_t *type, const char *what)
{
    if (expr->type->kind == T_NULL || (expr->type->kind == T_REF && expr->type->element == type->element))
        return expr;
    if (expr->type != cm1e_st_resolve(st, type->element))
        return refuse(st, expr, type, what);
    if (expr->kind == E_DEREF)
        return expr->a;
    args_t args = {0};
    arg_t *arg = cm1e_st_arg(st, expr->place, NULL, expr);
    ST_APPEND(args, arg);
    expr_t *call = cm1e_st_with_args(st, E_CALL, expr->place, cm1e_st_named(st, E_NAME, expr->place, NULL, "REF"),
                                     args);
    st->checker->standard_call(st, call, "REF");
    return call;
}

bool cm1e_st_is_place(const expr_t *expr)
{
    return expr->kind == E_NAME || expr->kind == E_MEMBER || expr->kind == E_INDEX || expr->kind == E_DEREF ||
           expr->kind == E_THIS;
}

static expr_t *coerce(st_t *st, expr_t *expr, type_t *type, const char *what)
{
    retype(st, expr, type);
    const type_kind_t from = expr->type->kind, to = type->kind;
    if (expr->type == type || from == T_WRONG || to == T_WRONG)
        return expr;
    if (takes_literal(expr, to))
        return give_type(st, expr, type);
    if (from <= T_DT && to <= T_DT && cm1e_st_widens(from, to))
        return cm1e_st_convert_node(st, expr, type);
    if (from == T_ENUM && to <= T_DT && cm1e_st_widens(expr->type->element->kind, to))
        return cm1e_st_convert_node(st, expr, type);
    if (to == T_REF && type->automatic)
        return refer(st, expr, type, what);
    if ((from == T_STRING && to == T_STRING && expr->type->wide == type->wide) ||
        (from == T_NULL && (to == T_REF || to == T_INTERFACE)))
        return expr;
    const bool object = (from == T_BLOCK || from == T_INTERFACE) && to == T_INTERFACE;
    if (object && cm1e_st_is_a(st, expr->type->unit, type->unit) && (from == T_INTERFACE || cm1e_st_is_place(expr)))
        return cm1e_st_convert_node(st, expr, type);
    return refuse(st, expr, type, what);
}

/** What is no value of a subrange is an error where it is known, and else a fault when the program runs. */
static expr_t *confine(st_t *st, expr_t *expr, type_t *type, const char *what)
{
    if (expr->type->kind == T_WRONG)
        return expr;
    if (!expr->value.known)
        return cm1e_st_convert_node(st, expr, type);
    if (expr->value.huge || expr->value.integer < type->first || expr->value.integer > type->last)
        cm1e_st_report(st, expr->place, "%lld is not a value of %s, which \"%s\" is", (long long)expr->value.integer,
                       type->shown, what);
    return give_type(st, expr, type);
}

expr_t *cm1e_st_coerce(st_t *st, expr_t *expr, type_t *type, const char *what)
{
    if (!type->ranged)
        return coerce(st, expr, type, what);
    if (expr->type == type && (cm1e_st_is_place(expr) || (expr->kind == E_CALL && expr->unit)))
        return expr;
    return confine(st, coerce(st, expr, st->elementary[type->kind], what), type, what);
}

expr_t *cm1e_st_settle(st_t *st, expr_t *expr)
{
    if (expr->untyped)
        return cm1e_st_coerce(st, expr, expr->type, "the value");
    if (expr->type->kind == T_ANY_REAL)
        return give_type(st, expr, st->elementary[T_LREAL]);
    if (expr->type->kind != T_ANY_INT)
        return expr;
    type_kind_t kind = expr->value.huge ? T_ULINT : cm1e_st_fits(T_DINT, &expr->value) ? T_DINT : T_LINT;
    return give_type(st, expr, st->elementary[kind]);
}

static bool is_constant(const var_t *var)
{
    return (var->qualifiers & Q_CONSTANT) || (var->section == V_EXTERNAL && var->global &&
                                              (var->global->qualifiers & Q_CONSTANT));
}

bool cm1e_st_assignable(st_t *st, const expr_t *expr)
{
    const expr_t *at = expr;
    for (; at->kind == E_MEMBER || at->kind == E_INDEX; at = at->a) {
        if (at->type->kind == T_WRONG || !at->a)
            return false;
        if (at->kind == E_MEMBER && at->var && at->a->type->kind == T_BLOCK && at->var->section == V_OUTPUT) {
            cm1e_st_report(st, at->place, "\"%s\" is an output of %s, which only the block itself writes",
                           at->var->name, at->a->type->name);
            return false;
        }
    }
    if (at->type->kind == T_WRONG)
        return false;
    if (expr->kind == E_MEMBER && expr->bit && expr->a->type->ranged) {
        cm1e_st_report(st, expr->place, "a single bit of %s is not written: the value could leave its range",
                       expr->a->type->shown);
        return false;
    }
    if (at->kind == E_DEREF || at->kind == E_THIS)
        return true;
    if (at->kind != E_NAME || !at->var || at->var->owner) {
        cm1e_st_report(st, expr->place, "only a variable can get a value here");
        return false;
    }
    if (is_constant(at->var)) {
        cm1e_st_report(st, expr->place, "\"%s\" is CONSTANT", at->var->name);
        return false;
    }
    if ((at->var->qualifiers & Q_EDGE) && at->var->unit && cm1e_st_this(st) == at->var->unit) {
        cm1e_st_report(st, expr->place, "\"%s\" is TRUE for one call after an edge of the input, and is not written",
                       at->var->name);
        return false;
    }
    if (at->var->controls)
        cm1e_st_report(st, expr->place, "the FOR around this counts with \"%s\": it must not be changed within (EXIT "
                       "leaves the loop)", at->var->name);
    return !at->var->controls;
}

void cm1e_st_note_change(st_t *st, const expr_t *expr)
{
    const expr_t *at = expr;
    while ((at->kind == E_MEMBER || at->kind == E_INDEX || at->kind == E_DEREF) && at->a)
        at = at->a;
    if (!st->unit || st->unit->kind != U_FUNCTION || at->kind != E_NAME || !at->var)
        return;
    if (at->var->section == V_GLOBAL || at->var->section == V_EXTERNAL)
        cm1e_st_report(st, expr->place, "a function changes no global variable: take \"%s\" as VAR_IN_OUT, or make a "
                       "function block of the function", at->var->name);
}

/* ---- two operands ------------------------------------------------------------------------------------------------ */

/** A literal without a type beside an operand that has one. */
static type_kind_t literal_beside(const expr_t *literal, type_kind_t other)
{
    if (literal->type->kind == T_ANY_REAL)
        return cm1e_st_is_floating(other) ? other : !cm1e_st_is_integer(other) ? T_NONE
            : cm1e_st_widens(other, T_REAL) ? T_REAL : cm1e_st_widens(other, T_LREAL) ? T_LREAL : T_NONE;
    if (other == T_BOOL || other > T_LREAL)
        return T_NONE;
    if (cm1e_st_is_floating(other) || cm1e_st_fits(other, &literal->value))
        return other;
    for (type_kind_t kind = T_SINT; kind <= T_ULINT && !cm1e_st_is_bits(other); kind++)
        if (cm1e_st_widens(other, kind) && cm1e_st_fits(kind, &literal->value))
            return kind;
    return T_NONE;
}

type_kind_t cm1e_st_type_for_both(const expr_t *a, const expr_t *b)
{
    const type_kind_t ka = a->type->kind, kb = b->type->kind;
    if (ka == kb)
        return ka;
    if ((ka == T_ANY_INT || ka == T_ANY_REAL) && (kb == T_ANY_INT || kb == T_ANY_REAL))
        return T_ANY_REAL;
    if (ka == T_ANY_INT || ka == T_ANY_REAL)
        return literal_beside(a, kb);
    if (kb == T_ANY_INT || kb == T_ANY_REAL)
        return literal_beside(b, ka);
    return ka <= T_DT && kb <= T_DT ? cm1e_st_common(ka, kb) : T_NONE;
}

bool cm1e_st_is_fixed(const expr_t *expr) { return !expr || (expr->value.known && !expr->impure); }

bool cm1e_st_alone(st_t *st, const expr_t *a, const expr_t *b)
{
    if (!a || !b || !((a->impure && !cm1e_st_is_fixed(b)) || (b->impure && !cm1e_st_is_fixed(a))))
        return true;
    cm1e_st_report(st, (a->impure ? a : b)->place, "this call can change variables that the rest of the expression may "
                   "use: give its result to a variable in a statement of its own");
    return false;
}
