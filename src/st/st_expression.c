/* The types of expressions: names, members, elements, operations. Calls are in st_call.c, conversions in
 * st_conversion.c. */
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "core/near.h"
#include "st/st_parsing.h"
#include "st/st_standard.h"

static const char *const operators[] = {
    "OR", "OR_ELSE", "XOR", "AND", "AND_THEN", "=", "<>", "<", ">", "<=", ">=", "+", "-", "*", "/", "MOD", "**", "-",
    "NOT",
};

static void set_wrong(st_t *st, expr_t *expr) { expr->type = st->elementary[T_WRONG]; }

/* ---- names ------------------------------------------------------------------------------------------------------- */

static void look_at(const char *name, void *value, void *context)
{
    (void)value;
    cm1e_near_look(context, name);
}

static void unknown_name(st_t *st, expr_t *expr)
{
    char text[CM1E_NEAR_TEXT_BYTES];
    cm1e_near_t near = {.word = expr->name};
    if (st->unit)
        cm1e_st_map_each(st->unit->names, look_at, &near);
    cm1e_st_map_each(st->globals, look_at, &near);
    cm1e_st_map_each(st->enumerators, look_at, &near);
    const char *what = cm1e_st_map_get(st->units, expr->name) ? "variable (it is called, or an instance of it is)"
                                                                   : "variable or enumerator";
    cm1e_st_report(st, expr->place, "there is no %s \"%s\"%s", what, expr->name,
                   cm1e_near_text(&near, text, sizeof text));
    set_wrong(st, expr);
}

static void use_enumerator(expr_t *expr, var_t *var)
{
    expr->var = var;
    expr->type = var->owner;
    expr->value = var->value;
}

/** Of an enumeration that the unit, or the block of a method, has without a name; NULL: none. */
static var_t *own_enumerator(const unit_t *unit, const char *name)
{
    var_t *found = NULL;
    for (const var_t *var = unit ? unit->vars : NULL; var && !found; var = var->next)
        if (var->type && var->type->kind == T_ENUM && var->type->unnamed)
            found = cm1e_st_member(var->type, name);
    return found || !unit ? found : own_enumerator(unit->object.owner, name);
}

static void name(st_t *st, expr_t *expr)
{
    var_t *var = expr->var ? expr->var : cm1e_st_find_var(st, expr->name);
    if (!var && cm1e_st_read_property(st, expr))
        return;
    if (!var && cm1e_st_this(st) && strcasecmp(expr->name, "THIS") == 0) { /* of the standard; TwinCAT has THIS^ */
        expr->kind = E_THIS;
        expr->type = cm1e_st_resolve(st, cm1e_st_this(st)->type);
        return;
    }
    if (var) {
        expr->var = var;
        expr->type = var->type;
        expr->value = *cm1e_st_constant_of(st, var);
        expr->type = var->type;
        cm1e_st_take_from_memory(st, expr);
        return;
    }
    var = own_enumerator(st->unit, expr->name);
    if (!var)
        var = cm1e_st_lookup(st, st->enumerators, expr->scope, expr->place, expr->name);
    if (var && var->owner) {
        cm1e_st_resolve(st, var->owner);
        use_enumerator(expr, var);
    } else if (var) {
        cm1e_st_report(st, expr->place, "several enumerations have \"%s\": write the type too, TYPE#%s. One "
                       "without a name gets one by TYPE name : (...); END_TYPE", expr->name, expr->name);
        set_wrong(st, expr);
    } else {
        unknown_name(st, expr);
    }
}

static void look_at_enumeration(const char *name, void *value, void *context)
{
    const type_t *type = value;
    if (type->kind == T_ENUM)
        cm1e_near_look(context, name);
}

/** TYPE#NAME, and TYPE.NAME as in TwinCAT. */
static void enumerator_of(st_t *st, expr_t *expr, const char *type_name)
{
    char text[CM1E_NEAR_TEXT_BYTES];
    type_t *type = cm1e_st_lookup(st, st->types, expr->scope, expr->place, type_name);
    type = type ? cm1e_st_resolve(st, type) : NULL;
    if (!type || type->kind != T_ENUM) {
        cm1e_near_t near = {.word = type_name};
        cm1e_st_map_each(st->types, look_at_enumeration, &near);
        if (type && type->kind != T_WRONG)
            cm1e_st_report(st, expr->place, "\"%s\" is a type, and no enumeration: name a variable of it", type_name);
        else if (!type)
            cm1e_st_report(st, expr->place, "there is no enumeration \"%s\"%s", type_name, cm1e_st_meant(st, &near));
        set_wrong(st, expr);
        return;
    }
    var_t *var = cm1e_st_member(type, expr->name);
    if (var) {
        use_enumerator(expr, var);
        return;
    }
    /* MC_Direction.MC_Shortest_Way: a constant of that type (Tc2_MC2). */
    var = cm1e_st_map_get(st->globals, expr->name);
    if (var && (var->qualifiers & Q_CONSTANT) && cm1e_st_resolve(st, var->type) == type) {
        expr->kind = E_NAME;
        expr->a = NULL;
        name(st, expr);
        return;
    }
    cm1e_near_t near = {.word = expr->name};
    for (const var_t *other = type->members; other; other = other->next)
        cm1e_near_look(&near, other->name);
    cm1e_st_report(st, expr->place, "%s has no \"%s\"%s", type->name, expr->name,
                   cm1e_near_text(&near, text, sizeof text));
    set_wrong(st, expr);
}

static bool has_single_bits(const type_t *type)
{
    return type->kind != T_BOOL && (cm1e_st_is_bits(type->kind) || cm1e_st_is_integer(type->kind));
}

/** word.Ready: a CONSTANT says which bit (TwinCAT, CODESYS). */
static void bit_of_constant(st_t *st, expr_t *expr)
{
    var_t *var = has_single_bits(expr->a->type) ? cm1e_st_find_var(st, expr->name) : NULL;
    const constant_t *value = var && cm1e_st_is_integer(var->type->kind) ? cm1e_st_constant_of(st, var) : NULL;
    if (!value || !value->known)
        return;
    expr->name = cm1e_st_format(st->arena, "%lld", (long long)value->integer);
    expr->bit = true;
}

static void bit(st_t *st, expr_t *expr)
{
    const type_t *type = expr->a->type;
    const long number = strtol(expr->name, NULL, 10);
    const bool has_bits = has_single_bits(type);
    expr->type = st->elementary[T_BOOL];
    if (has_bits && strspn(expr->name, "0123456789") == strlen(expr->name) && number < cm1e_st_bits(type->kind))
        return;
    if (has_bits)
        cm1e_st_report(st, expr->place, "%s has the bits .0 to .%d", type->name, cm1e_st_bits(type->kind) - 1);
    else
        cm1e_st_report(st, expr->place, "%s has no single bits", cm1e_st_type_name(type));
    set_wrong(st, expr);
}

static void unknown_member(st_t *st, expr_t *expr, const type_t *type)
{
    char text[CM1E_NEAR_TEXT_BYTES];
    cm1e_near_t near = {.word = expr->name};
    for (const var_t *other = type->members; other; other = other->next)
        if (expr->a->kind == E_THIS || (other->section != V_LOCAL && other->section != V_TEMP))
            cm1e_near_look(&near, other->name);
    if (type->kind == T_BLOCK && type->unit && cm1e_st_find_method(type->unit, expr->name))
        cm1e_st_report(st, expr->place, "\"%s\" is a method of %s: it is called, %s(...)", expr->name, type->name,
                       expr->name);
    else
        cm1e_st_report(st, expr->place, "%s has no \"%s\"%s", type->name, expr->name,
                       cm1e_near_text(&near, text, sizeof text));
    set_wrong(st, expr);
}

/** The program of this name, or of the instance of this name. */
static unit_t *program_named(const st_t *st, const char *name)
{
    unit_t *unit = cm1e_st_map_get(st->units, name);
    for (const instance_t *instance = st->tree.instances; instance && !unit; instance = instance->next)
        if (strcasecmp(instance->name, name) == 0)
            unit = cm1e_st_map_get(st->units, instance->program_name);
    return unit;
}

/** MAIN.x: a variable of a program, in another one. The program has one instance then. */
static bool of_program(st_t *st, expr_t *expr)
{
    unit_t *unit = !expr->bit && expr->a->kind == E_NAME && !cm1e_st_find_var(st, expr->a->name)
        ? program_named(st, expr->a->name) : NULL;
    var_t *var = unit && unit->kind == U_PROGRAM ? cm1e_st_map_get(unit->names, expr->name) : NULL;
    if (!var || var->section == V_TEMP || var->section == V_EXTERNAL || var->section == V_IN_OUT)
        return false;
    unit->reached = expr->place;
    var->type = cm1e_st_resolve(st, var->type);
    expr->kind = E_NAME;
    expr->a = NULL;
    expr->var = var;
    expr->type = var->type;
    expr->value = *cm1e_st_constant_of(st, var);
    cm1e_st_take_from_memory(st, expr);
    return true;
}

/** MAIN.x where that program has no such variable. */
static bool unknown_in_program(st_t *st, expr_t *expr)
{
    const unit_t *unit = !expr->bit && expr->a->kind == E_NAME && !cm1e_st_find_var(st, expr->a->name)
        ? program_named(st, expr->a->name) : NULL;
    if (!unit || unit->kind != U_PROGRAM)
        return false;
    cm1e_st_report(st, expr->place, "the program \"%s\" has no variable \"%s\" that others could reach%s", unit->name,
                   expr->name, cm1e_st_meant_var(st, expr->name, unit->vars,
                                                 ~(1u << V_TEMP | 1u << V_EXTERNAL | 1u << V_IN_OUT)));
    set_wrong(st, expr);
    return true;
}

/** A member that is found: where it lies, and whether it can be reached from here. */
static void found_member(st_t *st, expr_t *expr, const type_t *type)
{
    expr->type = expr->var->type = cm1e_st_resolve(st, expr->var->type);
    if (expr->var->in_memory) { /* THIS^.x of a program */
        expr->kind = E_NAME;
        cm1e_st_take_from_memory(st, expr);
        return;
    }
    if (expr->a->kind == E_THIS && expr->var->section == V_EXTERNAL) { /* VAR_STAT, VAR_EXTERNAL: not in the instance */
        expr->kind = E_NAME;
        expr->a = NULL;
        name(st, expr);
        return;
    }
    if (expr->var->section == V_TEMP) {
        cm1e_st_report(st, expr->place, "\"%s\" is VAR_TEMP of %s: its statements know it, by its name alone",
                       expr->var->name, type->name);
        set_wrong(st, expr);
        return;
    }
    if (type->kind == T_BLOCK && expr->a->kind != E_THIS && expr->var->section != V_INPUT &&
        expr->var->section != V_OUTPUT && !(expr->var->qualifiers & Q_PUBLIC)) {
        cm1e_st_report(st, expr->place, expr->var->section == V_IN_OUT ?
                       "\"%s\" is a VAR_IN_OUT of %s: it gets its variable in the call, ...(%s := variable)" :
                       "\"%s\" is within %s: from outside its inputs, outputs and VAR PUBLIC can be reached",
                       expr->var->name, type->name, expr->var->name);
        set_wrong(st, expr);
    }
}

/** What the name before the point has a value for: a member of it, or a bit. */
static void member_of_value(st_t *st, expr_t *expr)
{
    cm1e_st_expression(st, expr->a);
    type_t *type = expr->a->type;
    expr->impure = expr->a->impure;
    if (type->kind == T_WRONG) {
        set_wrong(st, expr);
        return;
    }
    if (!expr->bit)
        bit_of_constant(st, expr);
    if (expr->bit) {
        bit(st, expr);
        return;
    }
    if (type->kind == T_ENUM && cm1e_st_member(type, expr->name)) {
        cm1e_st_report(st, expr->place, "\"%s\" is the variable here; the enumerator is %s%s%s",
                       expr->a->name ? expr->a->name : "this", type->shown ? "" : type->name, type->shown ? "" : "#",
                       expr->name);
        set_wrong(st, expr);
        return;
    }
    if (type->kind != T_STRUCT && type->kind != T_BLOCK) {
        cm1e_st_report(st, expr->place, "%s has no members%s", cm1e_st_type_name(type),
                       type->kind == T_REF ? "; write ^ in front of the point" : has_single_bits(type) ?
                       "; a single bit is chosen by a number, or an integer CONSTANT" : "");
        set_wrong(st, expr);
        return;
    }
    const char *hint, *ours = cm1e_st_alias(type->name, expr->name, &hint);
    expr->var = cm1e_st_member(type, ours ? ours : expr->name);
    if (expr->var) {
        found_member(st, expr, type);
    } else if (hint) {
        cm1e_st_report(st, expr->place, "%s has no \"%s\": %s", type->name, expr->name, hint);
        set_wrong(st, expr);
    } else {
        unknown_member(st, expr, type);
    }
}

static void member(st_t *st, expr_t *expr)
{
    if (of_program(st, expr))
        return;
    var_t *listed = cm1e_st_in_list(st, expr);
    if (listed && !cm1e_st_find_var(st, expr->a->name)) {
        expr->kind = E_NAME;
        expr->name = cm1e_st_format(st->arena, "%s.%s", expr->a->name, expr->name);
        expr->a = NULL;
        name(st, expr);
        return;
    }
    if (cm1e_st_view(st, expr) || cm1e_st_read_property(st, expr))
        return;
    if (unknown_in_program(st, expr))
        return;
    if (!expr->bit && expr->a->kind == E_NAME && !cm1e_st_find_var(st, expr->a->name) &&
        !cm1e_st_map_get(st->enumerators, expr->a->name) &&
        cm1e_st_lookup(st, st->types, expr->scope, expr->place, expr->a->name))
        enumerator_of(st, expr, expr->a->name);
    else
        member_of_value(st, expr);
}

static void element(st_t *st, expr_t *expr)
{
    int count = 0;
    cm1e_st_expression(st, expr->a);
    const type_t *type = expr->a->type;
    expr->impure = expr->a->impure;
    for (arg_t *arg = expr->args; arg; arg = arg->next, count++) {
        cm1e_st_expression(st, arg->value);
        arg->value = cm1e_st_settle(st, arg->value);
        if (arg->value->impure)
            cm1e_st_report(st, arg->value->place, "this call can change variables: give its result to a variable "
                           "first, and use that as the index");
        const type_kind_t kind = arg->value->type->kind;
        if (!cm1e_st_is_integer(kind) && !(cm1e_st_is_bits(kind) && kind != T_BOOL) && kind != T_ENUM &&
            kind != T_WRONG)
            cm1e_st_report(st, arg->value->place, "an index is an integer, not %s",
                           cm1e_st_type_name(arg->value->type));
        if (kind == T_ULINT || kind == T_LWORD)
            cm1e_st_report(st, arg->value->place, "an index has at most the range of LINT, not %s",
                           arg->value->type->name);
    }
    if (type->kind == T_WRONG) {
        set_wrong(st, expr);
        return;
    }
    if (type->kind != T_ARRAY || count != type->dimension_count) {
        if (type->kind == T_ARRAY)
            cm1e_st_report(st, expr->place, "%s takes %d %s; found %d", type->name, type->dimension_count,
                           type->dimension_count == 1 ? "index" : "indices", count);
        else
            cm1e_st_report(st, expr->place, "%s is no array%s", cm1e_st_type_name(type), type->kind == T_STRING ?
                           "; MID(s, 1, n) is its character n" : "");
        set_wrong(st, expr);
        return;
    }
    const arg_t *arg = expr->args;
    for (int i = 0; i < count; i++, arg = arg->next)
        if (arg->value->value.known && !type->open && (arg->value->value.integer < type->dimensions[i].first ||
                                        arg->value->value.integer > type->dimensions[i].last))
            cm1e_st_report(st, arg->value->place, "the index %lld is outside %lld..%lld",
                           (long long)arg->value->value.integer, (long long)type->dimensions[i].first,
                           (long long)type->dimensions[i].last);
    expr->type = type->element;
}

void cm1e_st_follow_reference(st_t *st, expr_t *expr)
{
    if (expr->type->kind != T_REF || !expr->type->automatic)
        return;
    expr_t *reference = cm1e_st_take(st->arena, sizeof *reference);
    *reference = *expr;
    *expr = (expr_t){.kind = E_DEREF, .place = expr->place, .depth = expr->depth, .a = reference, .name = expr->name,
                     .impure = expr->impure, .type = cm1e_st_resolve(st, reference->type->element)};
}

static void dereference(st_t *st, expr_t *expr)
{
    unit_t *this = cm1e_st_this(st);
    if (this && expr->a->kind == E_NAME && strcasecmp(expr->a->name, "THIS") == 0 && !cm1e_st_find_var(st, "THIS")) {
        expr->kind = E_THIS;
        expr->a = NULL;
        expr->type = cm1e_st_resolve(st, this->type);
        return;
    }
    cm1e_st_expression(st, expr->a);
    expr->impure = expr->a->impure;
    if (expr->a->type->kind == T_REF) {
        expr->type = cm1e_st_resolve(st, expr->a->type->element);
        return;
    }
    if (expr->a->type->kind != T_WRONG)
        cm1e_st_report(st, expr->place, "^ is for REF_TO; this is %s", cm1e_st_type_name(expr->a->type));
    set_wrong(st, expr);
}

/* ---- operations -------------------------------------------------------------------------------------------------- */

static void wrong_operands(st_t *st, expr_t *expr)
{
    const char *a = cm1e_st_type_name(expr->a->type), *b = expr->b ? cm1e_st_type_name(expr->b->type) : "";
    const char *op = operators[expr->op];
    const char *hint = "";
    const type_kind_t ka = expr->a->type->kind, kb = expr->b ? expr->b->type->kind : T_NONE;
    if (expr->op == OP_POWER)
        hint = "; the base is REAL or LREAL";
    else if (cm1e_st_is_number(ka) && cm1e_st_is_number(kb) && expr->op >= OP_EQ)
        hint = "; no type has all values of both: convert one of them";
    else if ((ka == T_BOOL || kb == T_BOOL) && expr->op >= OP_ADD && expr->op <= OP_MOD)
        hint = "; BOOL_TO_INT(...) makes a number of a BOOL";
    else if ((cm1e_st_is_bits(ka) || cm1e_st_is_bits(kb)) && expr->op >= OP_ADD && expr->op <= OP_MOD)
        hint = "; bits are no number: convert them, as in WORD_TO_UINT(...)";
    else if (expr->op <= OP_AND_THEN || expr->op == OP_NOT)
        hint = ka == T_ANY_INT && expr->op == OP_NOT ? "; of how many bits is not known: write the type too, as in "
                                                       "NOT WORD#16#1"
                                                     : "; it is for BOOL, BYTE, WORD, DWORD and LWORD";
    if (expr->b) {
        char left[240], right[240];
        cm1e_st_report(st, expr->place, "%s %s %s is not defined%s%s%s", a, op, b, hint,
                       cm1e_st_hidden_enumerator(expr->a->type, expr->b, right, sizeof right),
                       cm1e_st_hidden_enumerator(expr->b->type, expr->a, left, sizeof left));
    }
    else
        cm1e_st_report(st, expr->place, "%s %s is not defined%s", op, a, hint);
    set_wrong(st, expr);
}

static void both_as(st_t *st, expr_t *expr, type_kind_t kind)
{
    expr->a = cm1e_st_coerce(st, expr->a, st->elementary[kind], "the left side");
    expr->b = cm1e_st_coerce(st, expr->b, st->elementary[kind], "the right side");
}

static bool is_number_or_bits(const expr_t *expr)
{
    const type_kind_t kind = expr->type->kind;
    return cm1e_st_is_number(kind) || (cm1e_st_is_bits(kind) && kind != T_BOOL);
}

/** An enumeration whose base is BYTE ... LWORD has bits. */
static expr_t *as_bits(st_t *st, expr_t *expr)
{
    return cm1e_st_is_bits(cm1e_st_plain_kind(expr->type)) ? cm1e_st_as_integer(st, expr) : expr;
}

static void logical(st_t *st, expr_t *expr)
{
    expr->a = as_bits(st, expr->a);
    expr->b = as_bits(st, expr->b);
    const type_kind_t kind = cm1e_st_type_for_both(expr->a, expr->b);
    const bool lazy = expr->op == OP_AND_THEN || expr->op == OP_OR_ELSE;
    if (!(cm1e_st_is_bits(kind) || kind == T_ANY_INT) || (lazy && kind != T_BOOL)) {
        wrong_operands(st, expr);
        return;
    }
    both_as(st, expr, kind);
    expr->type = st->elementary[kind];
    cm1e_st_fold(st, expr);
}

static bool is_comparable(const expr_t *expr, type_kind_t kind)
{
    const type_t *a = expr->a->type, *b = expr->b->type;
    const bool equality = expr->op == OP_EQ || expr->op == OP_NE;
    if (a->kind == T_STRING)
        return b->kind == T_STRING && a->wide == b->wide;
    if (a->kind == T_ENUM || b->kind == T_ENUM)
        return a == b;
    if (a->kind == T_INTERFACE || b->kind == T_INTERFACE)
        return equality && (a == b || a->kind == T_NULL || b->kind == T_NULL);
    if (a->kind == T_REF || b->kind == T_REF)
        return equality && (a == b || a->kind == T_NULL || b->kind == T_NULL);
    return kind != T_NONE && kind <= T_ANY_REAL && (equality || kind != T_BOOL);
}

/** 0 beside an interface is NULL (TwinCAT). */
static void zero_as_null(st_t *st, expr_t *zero, const expr_t *beside)
{
    if (beside->type->kind == T_INTERFACE && zero->type->kind == T_ANY_INT && zero->value.known &&
        zero->value.integer == 0)
        zero->type = st->elementary[T_NULL];
}

static void comparison(st_t *st, expr_t *expr)
{
    zero_as_null(st, expr->a, expr->b);
    zero_as_null(st, expr->b, expr->a);
    if (is_number_or_bits(expr->a) || is_number_or_bits(expr->b)) {
        expr->a = cm1e_st_as_integer(st, expr->a);
        expr->b = cm1e_st_as_integer(st, expr->b);
    }
    type_kind_t kind = cm1e_st_type_for_both(expr->a, expr->b);
    if (!is_comparable(expr, kind)) {
        wrong_operands(st, expr);
        return;
    }
    if (kind == T_ANY_INT && !expr->a->value.huge && !expr->b->value.huge)
        kind = T_LINT;
    else if (kind == T_ANY_INT)
        kind = T_ULINT;
    if (kind == T_ANY_REAL)
        kind = T_LREAL;
    if (kind <= T_DT && kind != T_NONE)
        both_as(st, expr, kind);
    expr->type = st->elementary[T_BOOL];
    cm1e_st_fold_comparison(expr);
}

/** + - * / with times: what comes out, T_NONE if nothing. */
static type_kind_t time_result(const expr_t *expr)
{
    const type_kind_t a = expr->a->type->kind, b = expr->b->type->kind;
    switch (expr->op) {
    case OP_ADD:
        return b == T_TIME && a != T_DATE && cm1e_st_is_time(a) ? a
               : a == T_TIME && (b == T_TOD || b == T_DT)       ? b
                                                                : T_NONE;
    case OP_SUB:
        return b == T_TIME && a != T_DATE && cm1e_st_is_time(a) ? a : a == b ? T_TIME : T_NONE;
    case OP_MUL:
        return a == T_TIME && cm1e_st_is_number(b) ? T_TIME : b == T_TIME && cm1e_st_is_number(a) ? T_TIME : T_NONE;
    case OP_DIV: return a == T_TIME && cm1e_st_is_number(b) && b != T_ULINT ? T_TIME : T_NONE;
    default: return T_NONE;
    }
}

static void arithmetic(st_t *st, expr_t *expr)
{
    expr->a = cm1e_st_as_integer(st, expr->a);
    expr->b = cm1e_st_as_integer(st, expr->b);
    if (cm1e_st_is_time(expr->a->type->kind) || cm1e_st_is_time(expr->b->type->kind)) {
        const type_kind_t result = time_result(expr);
        if (result == T_NONE) {
            wrong_operands(st, expr);
            return;
        }
        expr->a = cm1e_st_settle(st, expr->a);
        expr->b = cm1e_st_settle(st, expr->b);
        expr->type = st->elementary[result];
        cm1e_st_fold(st, expr);
        return;
    }
    const type_kind_t kind = cm1e_st_type_for_both(expr->a, expr->b);
    const bool bits = cm1e_st_is_bits(expr->a->type->kind) || cm1e_st_is_bits(expr->b->type->kind);
    if (!cm1e_st_is_number(kind) || bits || (expr->op == OP_MOD && cm1e_st_is_floating(kind))) {
        wrong_operands(st, expr);
        return;
    }
    both_as(st, expr, kind);
    expr->type = st->elementary[kind];
    if (expr->op == OP_DIV && cm1e_st_is_integer(kind) && expr->b->value.known && expr->b->value.integer == 0)
        cm1e_st_report(st, expr->place, "this divides by zero");
    cm1e_st_fold(st, expr);
}

/** The base is real, the exponent any number; all is computed in the type of the base. */
static void power(st_t *st, expr_t *expr)
{
    expr->b = cm1e_st_as_integer(st, expr->b);
    const type_kind_t base = expr->a->type->kind, exponent = expr->b->type->kind;
    if (!(cm1e_st_is_floating(base) || base == T_ANY_INT) || !cm1e_st_is_number(exponent)) {
        wrong_operands(st, expr);
        return;
    }
    const bool literals = base > T_DT && exponent > T_DT;
    const type_kind_t kind = literals ? T_ANY_REAL : base == T_REAL && exponent != T_LREAL ? T_REAL : T_LREAL;
    expr->a = cm1e_st_coerce(st, expr->a, st->elementary[kind], "the base");
    if (cm1e_st_is_integer(exponent) && exponent != T_ANY_INT)
        expr->b = cm1e_st_convert_node(st, expr->b, st->elementary[kind]);
    else
        expr->b = cm1e_st_coerce(st, expr->b, st->elementary[kind], "the exponent");
    expr->type = st->elementary[kind];
    cm1e_st_fold(st, expr);
}

static void binary(st_t *st, expr_t *expr)
{
    cm1e_st_expression(st, expr->a);
    cm1e_st_expression(st, expr->b);
    expr->impure = expr->a->impure || expr->b->impure;
    const bool lazy = expr->op == OP_AND_THEN || expr->op == OP_OR_ELSE;
    if (expr->a->type->kind == T_WRONG || expr->b->type->kind == T_WRONG ||
        (!lazy && !cm1e_st_alone(st, expr->a, expr->b)))
        set_wrong(st, expr);
    else if (expr->op <= OP_AND_THEN)
        logical(st, expr);
    else if (expr->op <= OP_GE)
        comparison(st, expr);
    else if (expr->op == OP_POWER)
        power(st, expr);
    else
        arithmetic(st, expr);
}

static void unary(st_t *st, expr_t *expr)
{
    cm1e_st_expression(st, expr->a);
    if (expr->a->untyped)
        expr->a = cm1e_st_settle(st, expr->a);
    expr->a = cm1e_st_as_integer(st, expr->a);
    const type_kind_t kind = expr->a->type->kind;
    expr->type = expr->a->type;
    expr->impure = expr->a->impure;
    if (kind == T_WRONG)
        return;
    const bool good = expr->op == OP_NOT ? cm1e_st_is_bits(kind)
                                         : (cm1e_st_is_number(kind) && !cm1e_st_is_unsigned(kind)) || kind == T_TIME;
    if (good)
        cm1e_st_fold(st, expr);
    else
        wrong_operands(st, expr);
}

void cm1e_st_check_expression(st_t *st, expr_t *expr)
{
    if (expr->type)
        return;
    switch (expr->kind) {
    case E_NAME:
        name(st, expr);
        cm1e_st_follow_reference(st, expr);
        break;
    case E_QUALIFIED: enumerator_of(st, expr, expr->prefix); break;
    case E_MEMBER:
        member(st, expr);
        cm1e_st_follow_reference(st, expr);
        break;
    case E_INDEX:
        element(st, expr);
        cm1e_st_follow_reference(st, expr);
        break;
    case E_DEREF: dereference(st, expr); break;
    case E_CALL: cm1e_st_call(st, expr, false); break;
    case E_UNARY: unary(st, expr); break;
    case E_BINARY: binary(st, expr); break;
    case E_ADDRESS:
        cm1e_st_report(st, expr->place, "give the address %s a name: VAR_GLOBAL name AT %s : ...; END_VAR", expr->name,
                       expr->name);
        set_wrong(st, expr);
        break;
    default:
        cm1e_st_report(st, expr->place, "a list of values can only stand behind := in a declaration");
        set_wrong(st, expr);
        break;
    }
}
