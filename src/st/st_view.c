/* Members of AXIS_REF that TwinCAT has, and programs read: they become values of the axis. */
#include <strings.h>

#include "core/near.h"
#include "core/tc2_axis.h"
#include "st/st_parsing.h"

static const struct { const char *group, *name; type_kind_t type; } members[] = {
#define ROW(group, name, type, value) {#group, #name, T_##type},
    CM1E_TC2_AXIS(ROW)
#undef ROW
};
enum { MEMBERS = sizeof members / sizeof members[0] };

static bool is_axis(const type_t *type)
{
    return type->kind == T_STRUCT && type->external && strcasecmp(type->name, "AXIS_REF") == 0;
}

static void unknown(st_t *st, expr_t *expr, const char *group)
{
    char text[CM1E_NEAR_TEXT_BYTES];
    cm1e_near_t near = {.word = expr->name};
    for (int i = 0; i < MEMBERS; i++)
        if (strcasecmp(members[i].group, group) == 0)
            cm1e_near_look(&near, members[i].name);
    cm1e_st_report(st, expr->place, "\"%s\" of %s is not known here%s: read the axis by MC_ReadStatus, MC_ReadAxisInfo "
                   "and the like", expr->name, group, cm1e_near_text(&near, text, sizeof text));
    expr->type = st->elementary[T_WRONG];
}

bool cm1e_st_view(st_t *st, expr_t *expr)
{
    const expr_t *structure = expr->a;
    const bool group = structure->kind == E_MEMBER && !structure->bit &&
        (strcasecmp(structure->name, "NcToPlc") == 0 || strcasecmp(structure->name, "Status") == 0);
    if (expr->bit || !group)
        return false;
    cm1e_st_expression(st, structure->a);
    if (!is_axis(structure->a->type))
        return false;
    for (int i = 0; i < MEMBERS; i++)
        if (strcasecmp(members[i].group, structure->name) == 0 && strcasecmp(members[i].name, expr->name) == 0) {
            expr->kind = E_VIEW;
            expr->view = i;
            expr->type = st->elementary[members[i].type];
            expr->a = structure->a;
            expr->impure = expr->a->impure;
            return true;
        }
    unknown(st, expr, structure->name);
    return true;
}

bool cm1e_st_only_updates(st_t *st, const expr_t *call)
{
    expr_t *axis = call->a;
    const bool reads = axis->kind == E_MEMBER && !axis->bit && strcasecmp(axis->name, "ReadStatus") == 0;
    if (reads)
        axis = axis->a;
    const expr_t *root = axis;
    while ((root->kind == E_INDEX || root->kind == E_MEMBER) && root->a)
        root = root->a;
    if (call->args || root->kind != E_NAME || (!reads && axis->kind == E_MEMBER && !cm1e_st_in_list(st, axis)) ||
        (!cm1e_st_find_var(st, root->name) && !(axis->kind == E_MEMBER && cm1e_st_in_list(st, axis))))
        return false;
    cm1e_st_expression(st, axis);
    return is_axis(axis->type);
}
