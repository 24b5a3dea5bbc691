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

static bool is_pure_callee(st_t *st, const expr_t *callee)
{
    const unit_t *function = callee->kind == E_NAME ? cm1e_st_map_get(st->units, callee->name) : NULL;
    if (function && function->kind == U_FUNCTION)
        return true; /* a function changes no global variable, and VAR_IN_OUT is seen by its caller */
    if (callee->kind == E_NAME || callee->kind == E_MEMBER)
        return !cm1e_st_changes(st, callee->name);
    return false;
}

static bool expression_changes(st_t *st, const expr_t *expr)
{
    if (!expr)
        return false;
    bool changes = expr->kind == E_CALL && expr->a && !is_pure_callee(st, expr->a);
    for (const arg_t *arg = expr->args; arg && !changes; arg = arg->next)
        changes = arg->output || expression_changes(st, arg->value);
    return changes || expression_changes(st, expr->a) || expression_changes(st, expr->b);
}

static bool statement_changes(st_t *st, const unit_t *unit, const stmt_t *stmt)
{
    bool changes = stmt->kind == S_CALL || (stmt->target && !is_own(unit, stmt->target)) ||
                   expression_changes(st, stmt->target) || expression_changes(st, stmt->value) ||
                   expression_changes(st, stmt->to) || expression_changes(st, stmt->by) ||
                   changes_in(st, unit, stmt->body);
    for (const branch_t *branch = stmt->branches; branch && !changes; branch = branch->next)
        changes = expression_changes(st, branch->condition) || changes_in(st, unit, branch->body);
    return changes;
}

static bool changes_in(st_t *st, const unit_t *unit, const stmt_t *list)
{
    for (; list; list = list->next)
        if (statement_changes(st, unit, list))
            return true;
    return false;
}

/** Any method of this name, because which one is called may be known when the program runs only. A name that is no method
 *  is one of a standard function or an error. */
bool cm1e_st_changes(st_t *st, const char *name)
{
    bool changes = false;
    for (unit_t *unit = st->tree.units; unit && !changes; unit = unit->next) {
        if (unit->kind != U_METHOD || strcasecmp(unit->name, name) != 0)
            continue;
        if (unit->object.purity == UNKNOWN) {
            unit->object.purity = BUSY;
            unit->object.purity = changes_in(st, unit, unit->body) ? CHANGES : PURE;
        }
        changes = unit->object.purity != PURE;
        for (const var_t *var = unit->vars; var && !changes; var = var->next)
            changes = var->section == V_OUTPUT || var->section == V_IN_OUT;
    }
    return changes;
}
