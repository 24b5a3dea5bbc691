/* Calls of methods, and properties. A method is a function that gets its instance; which one is meant is known by the
 * class of the instance where blocks override each other. */
#include <strings.h>

#include "st/st_parsing.h"

/* ---- calls ------------------------------------------------------------------------------------------------------- */

/** SUPER^ in the statements of a block that extends another one. */
static bool is_super(st_t *st, const expr_t *expr)
{
    const unit_t *this = cm1e_st_this(st);
    const expr_t *name = expr->kind == E_DEREF ? expr->a : expr; /* SUPER of the standard, SUPER^ of TwinCAT */
    return this && this->object.base && name->kind == E_NAME && strcasecmp(name->name, "SUPER") == 0 &&
           !cm1e_st_find_var(st, "SUPER");
}

/** Whether the statements that are looked at may use a method, by the word in front of its name. */
static void check_access(st_t *st, const expr_t *call, const unit_t *method)
{
    static const char *const who[] = {[M_PRIVATE] = "PRIVATE: only this block itself",
                                      [M_PROTECTED] = "PROTECTED: only this block and those that extend it",
                                      [M_INTERNAL] = "INTERNAL: only its namespace"};
    const unit_t *this = cm1e_st_this(st), *owner = method->object.owner;
    const int access = method->object.access;
    if ((access == M_PRIVATE && this != owner) || (access == M_PROTECTED && !cm1e_st_is_a(st, this, owner)) ||
        (access == M_INTERNAL && !cm1e_st_same_namespace(st->unit ? st->unit->scope : NULL, method->scope)))
        cm1e_st_report(st, call->place, "\"%s\" of \"%s\" is %s can use it", cm1e_st_plain_name(method), owner->name,
                       who[access]);
}

static void finish(st_t *st, expr_t *call, unit_t *method, expr_t *object, unit_t *seen_as)
{
    check_access(st, call, method);
    if (call->super && method->object.abstract)
        cm1e_st_report(st, call->place, "\"%s\" of \"%s\" is ABSTRACT: there is nothing that could be called",
                       cm1e_st_plain_name(method), seen_as->name);
    call->unit = method;
    call->seen_as = seen_as;
    call->a = object;
    call->impure = cm1e_st_changes(st, method->name);
    call->kind = E_CALL;
    call->type = method->result_type ? cm1e_st_resolve(st, method->result_type) : st->elementary[T_NONE];
    if (object && call->impure)
        cm1e_st_note_change(st, object);
    if (call->super)
        cm1e_st_note_call(st, method);
    for (unit_t *other = st->tree.units; other && !call->super; other = other->next)
        if (other->kind == U_METHOD && strcasecmp(other->name, method->name) == 0 &&
            cm1e_st_is_a(st, other->object.owner, seen_as))
            cm1e_st_note_call(st, other); /* it may be the one that is called */
    cm1e_st_check_arguments(st, method, call);
}

/** An expression that can be looked at without an error if it is no object. */
static bool can_be_object(st_t *st, const expr_t *expr)
{
    const expr_t *root = expr;
    while ((root->kind == E_MEMBER || root->kind == E_INDEX || root->kind == E_DEREF) && root->a)
        root = root->a;
    if (root->kind != E_NAME)
        return root->kind == E_THIS || root->kind == E_CALL;
    const unit_t *this = cm1e_st_this(st);
    const unit_t *program = root != expr ? cm1e_st_map_get(st->units, root->name) : NULL;
    if (program && program->kind == U_PROGRAM)
        return true;
    return cm1e_st_find_var(st, root->name) || (this && strcasecmp(root->name, "THIS") == 0) ||
           (expr->kind == E_MEMBER && cm1e_st_in_list(st, expr)) ||
           (this && cm1e_st_find_method(this, cm1e_st_format(st->arena, "get %s", root->name)));
}

/** The method of an object by name, and as what the object is seen. */
static unit_t *method_of(st_t *st, expr_t *object, const char *name, unit_t **seen_as)
{
    unit_t *program = object->kind == E_NAME && !cm1e_st_find_var(st, object->name)
        ? cm1e_st_map_get(st->units, object->name) : NULL;
    if (program && program->kind == U_PROGRAM && cm1e_st_find_method(program, name))
        cm1e_st_take_program(st, object, program);
    else if (!can_be_object(st, object))
        return NULL;
    cm1e_st_expression(st, object);
    const type_t *type = object->type;
    if (type->kind != T_BLOCK && type->kind != T_INTERFACE)
        return NULL;
    *seen_as = type->unit;
    return type->kind == T_INTERFACE ? cm1e_st_interface_method(st, type->unit, name)
                                     : cm1e_st_find_method(type->unit, name);
}

static bool call_base(st_t *st, expr_t *call, const char *name)
{
    unit_t *base = cm1e_st_this(st)->object.base;
    unit_t *method = name ? cm1e_st_find_method(base, name) : base;
    call->super = true;
    if (!method) {
        /* NOLINTNEXTLINE(clang-analyzer-core.NullDereference): SUPER is known where there is a base only */
        cm1e_st_report(st, call->place, "\"%s\" has no method \"%s\" that could be called", base->name,
                       name ? name : "");
        call->type = st->elementary[T_WRONG];
        return true;
    }
    if (name) {
        finish(st, call, method, NULL, base);
        return true;
    }
    cm1e_st_note_call(st, base);
    call->unit = base;
    call->a = NULL;
    call->seen_as = base;
    call->impure = true;
    call->type = st->elementary[T_NONE];
    return true;
}

bool cm1e_st_call_method(st_t *st, expr_t *call, bool statement)
{
    expr_t *callee = call->a;
    unit_t *this = cm1e_st_this(st), *seen_as = this, *method = NULL;
    expr_t *object = NULL;
    if (is_super(st, callee) && statement)
        return call_base(st, call, NULL);
    if (callee->kind == E_MEMBER && !callee->bit && is_super(st, callee->a))
        return call_base(st, call, callee->name);
    if (callee->kind == E_NAME && this && !(cm1e_st_find_var(st, callee->name) &&
                                            cm1e_st_find_var(st, callee->name)->section != V_RESULT)) {
        method = cm1e_st_find_method(this, callee->name);
    } else if (callee->kind == E_MEMBER && !callee->bit) {
        object = callee->a;
        method = method_of(st, object, callee->name, &seen_as);
    }
    if (!method)
        return false;
    finish(st, call, method, object, seen_as);
    return true;
}

/* ---- properties -------------------------------------------------------------------------------------------------- */

/** GET or SET of a property; NULL: it is none. With SUPER^ that of the base, whatever overrides it. */
static unit_t *accessor(st_t *st, expr_t *expr, const char *what, expr_t **object, unit_t **seen_as)
{
    const char *name = expr->name ? cm1e_st_format(st->arena, "%s %s", what, expr->name) : "";
    unit_t *this = cm1e_st_this(st);
    *object = expr->kind == E_MEMBER ? expr->a : NULL;
    *seen_as = this;
    if (expr->kind == E_MEMBER && !expr->bit && is_super(st, expr->a)) {
        *object = NULL;
        *seen_as = this->object.base;
        expr->super = true;
        return cm1e_st_find_method(this->object.base, name);
    }
    if (expr->kind == E_NAME)
        return this && !cm1e_st_find_var(st, expr->name) ? cm1e_st_find_method(this, name) : NULL;
    return expr->kind == E_MEMBER && !expr->bit ? method_of(st, expr->a, name, seen_as) : NULL;
}

bool cm1e_st_read_property(st_t *st, expr_t *expr)
{
    expr_t *object;
    unit_t *seen_as, *method = accessor(st, expr, "get", &object, &seen_as);
    if (!method)
        return false;
    expr->args = NULL;
    finish(st, expr, method, object, seen_as);
    return true;
}

bool cm1e_st_write_property(st_t *st, stmt_t *stmt)
{
    expr_t *object;
    unit_t *seen_as, *method = accessor(st, stmt->target, "set", &object, &seen_as);
    if (!method)
        return false;
    args_t args = {0};
    arg_t *arg = cm1e_st_arg(st, stmt->place, NULL, stmt->value);
    ST_APPEND(args, arg);
    stmt->value = cm1e_st_with_args(st, E_CALL, stmt->target->place, NULL, args);
    stmt->value->super = stmt->target->super;
    stmt->kind = S_CALL;
    finish(st, stmt->value, method, object, seen_as);
    return true;
}
