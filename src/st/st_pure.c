/* Whether a method changes more than its own variables. It is found in the statements as they were read, before they are
 * checked, because an expression may call a method that is checked later. */
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

/** A name that is no variable may be a property, whose GET changes something. */
static bool property_changes(st_t *st, const unit_t *unit, const expr_t *expr)
{
    const unit_t *owner = unit->object.owner;
    if (expr->kind == E_NAME &&
        (!owner || cm1e_st_map_get(unit->names, expr->name) || cm1e_st_map_get(owner->names, expr->name)))
        return false;
    return (expr->kind == E_NAME || expr->kind == E_MEMBER) && !expr->bit &&
           cm1e_st_changes(st, cm1e_st_format(st->arena, "get %s", expr->name));
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

/** Any method of this name, because which one is called may be known when the program runs only. A name that is no method
 *  is one of a standard function or an error. */
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
