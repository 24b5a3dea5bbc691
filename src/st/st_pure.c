/* Whether a method changes more than its own variables. It is found in the statements as they were read, before they
 * are checked, because an expression may call a method that is checked later. */
#include <strings.h>

#include "st/st_parsing.h"

enum { UNKNOWN = 0, BUSY, PURE, CHANGES };

static bool changes_in(st_t *st, const unit_t *unit, const stmt_t *list);

/** A variable of the method itself. */
static bool is_own(const unit_t *unit, const expr_t *target)
{
    while ((target->kind == E_MEMBER || target->kind == E_INDEX) && target->a)
        target = target->a;
    const var_t *var = target->kind == E_NAME ? cm1e_st_map_get(unit->names, target->name) : NULL;
    return var && var->section != V_IN_OUT && var->section != V_EXTERNAL;
}

/** The parameter that an argument of a function is for; NULL: an error that is reported elsewhere. */
static var_t *parameter_of(const unit_t *function, const expr_t *call, const arg_t *wanted)
{
    if (wanted->name)
        return cm1e_st_map_get(function->names, wanted->name);
    var_t *var = function->vars;
    for (const arg_t *arg = call->args; var; var = var->next) {
        if (var->section != V_INPUT && var->section != V_IN_OUT)
            continue;
        if (arg == wanted)
            return var;
        arg = arg->next;
    }
    return NULL;
}

/** A function changes no global variable, but what it gets by VAR_IN_OUT, by reference or by an interface. */
static bool function_changes(st_t *st, const unit_t *unit, unit_t *function, const expr_t *call)
{
    for (const arg_t *arg = call->args; arg; arg = arg->next) {
        var_t *var = parameter_of(function, call, arg);
        const type_kind_t kind = var && var->section == V_INPUT ? cm1e_st_resolve(st, var->type)->kind : T_NONE;
        const bool given = var && (cm1e_st_gives_back(var) || kind == T_REF);
        if (given && arg->value && !is_own(unit, arg->value))
            return true;
        if (kind == T_INTERFACE && cm1e_st_body_changes(st, function))
            return true;
    }
    return false;
}

static bool call_changes(st_t *st, const unit_t *unit, const expr_t *call)
{
    const expr_t *callee = call->a;
    unit_t *function = callee->kind == E_NAME ? cm1e_st_map_get(st->units, callee->name) : NULL;
    if (function && function->kind == U_FUNCTION)
        return function_changes(st, unit, function, call);
    return (callee->kind != E_NAME && callee->kind != E_MEMBER) || cm1e_st_changes(st, callee->name);
}

static var_t *variable_named(const st_t *st, const unit_t *unit, const char *name)
{
    var_t *var = cm1e_st_map_get(unit->names, name);
    if (!var && unit->object.owner && unit->object.owner->names)
        var = cm1e_st_map_get(unit->object.owner->names, name);
    return var ? var : cm1e_st_map_get(st->globals, name);
}

static type_t *type_of(st_t *st, const unit_t *unit, const expr_t *expr);

/** NULL: it is none, or what it is of is not known here. */
static var_t *member_of(st_t *st, const unit_t *unit, const expr_t *expr)
{
    const type_t *type = expr->kind == E_MEMBER && expr->a ? type_of(st, unit, expr->a) : NULL;
    const bool has = type && (type->kind == T_STRUCT || type->kind == T_BLOCK);
    for (var_t *var = has ? type->members : NULL; var; var = var->next)
        if (expr->name && strcasecmp(var->name, expr->name) == 0)
            return var;
    return NULL;
}

/** The type of variables and their parts, as they were read; NULL: another expression. */
static type_t *type_of(st_t *st, const unit_t *unit, const expr_t *expr)
{
    const bool this = expr->kind == E_THIS || (expr->kind == E_NAME && strcasecmp(expr->name, "THIS") == 0);
    type_t *type = NULL;
    if (this)
        return unit->object.owner ? unit->object.owner->type : NULL;
    if (expr->kind == E_NAME || expr->kind == E_MEMBER) {
        const var_t *var = expr->kind == E_NAME ? variable_named(st, unit, expr->name) : member_of(st, unit, expr);
        type = var ? cm1e_st_resolve(st, var->type) : NULL;
    } else if ((expr->kind == E_INDEX || expr->kind == E_DEREF) && expr->a) {
        type = type_of(st, unit, expr->a);
        if (type && type->kind == T_ARRAY && expr->kind == E_INDEX)
            type = cm1e_st_resolve(st, type->element);
    }
    return type && type->kind == T_REF ? cm1e_st_resolve(st, type->element) : type;
}

/** A name that is no variable may be a property, whose GET changes something. */
static bool property_changes(st_t *st, const unit_t *unit, const expr_t *expr)
{
    if ((expr->kind != E_NAME && expr->kind != E_MEMBER) || expr->bit || !expr->name || member_of(st, unit, expr))
        return false;
    const unit_t *owner = unit->object.owner;
    const char *get = cm1e_st_format(st->arena, "get %s", expr->name);
    if (expr->kind == E_NAME && (!owner || variable_named(st, unit, expr->name) || !cm1e_st_find_method(owner, get)))
        return false;
    return cm1e_st_changes(st, get);
}

static bool expression_changes(st_t *st, const unit_t *unit, const expr_t *expr)
{
    if (!expr)
        return false;
    bool changes = expr->kind == E_CALL && expr->a ? call_changes(st, unit, expr) : property_changes(st, unit, expr);
    for (const arg_t *arg = expr->args; arg && !changes; arg = arg->next)
        changes = arg->output || expression_changes(st, unit, arg->value);
    return changes || expression_changes(st, unit, expr->a) || expression_changes(st, unit, expr->b);
}

static bool statement_changes(st_t *st, const unit_t *unit, const stmt_t *stmt)
{
    bool changes = stmt->kind == S_CALL || (stmt->target && !is_own(unit, stmt->target)) ||
                   expression_changes(st, unit, stmt->target) || expression_changes(st, unit, stmt->value) ||
                   expression_changes(st, unit, stmt->to) || expression_changes(st, unit, stmt->by) ||
                   changes_in(st, unit, stmt->body);
    for (const branch_t *branch = stmt->branches; branch && !changes; branch = branch->next)
        changes = expression_changes(st, unit, branch->condition) || changes_in(st, unit, branch->body);
    return changes;
}

static bool changes_in(st_t *st, const unit_t *unit, const stmt_t *list)
{
    for (; list; list = list->next)
        if (statement_changes(st, unit, list))
            return true;
    return false;
}

bool cm1e_st_body_changes(st_t *st, unit_t *unit)
{
    if (unit->object.purity == UNKNOWN) {
        unit->object.purity = BUSY;
        unit->object.purity = changes_in(st, unit, unit->body) ? CHANGES : PURE;
    }
    return unit->object.purity == CHANGES; /* BUSY: a method of this name that calls another one of it, as by SUPER^ */
}

/** Any method of this name, because which one is called may be known when the program runs only. A name that is no
 *  method is one of a standard function or an error. */
bool cm1e_st_changes(st_t *st, const char *name)
{
    bool changes = false;
    for (unit_t *unit = st->tree.units; unit && !changes; unit = unit->next) {
        if (unit->kind != U_METHOD || strcasecmp(unit->name, name) != 0)
            continue;
        changes = cm1e_st_body_changes(st, unit);
        for (const var_t *var = unit->vars; var && !changes; var = var->next)
            changes = cm1e_st_gives_back(var);
    }
    return changes;
}
