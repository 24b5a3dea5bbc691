/* Methods in C: a function that gets its instance. Where blocks override a method, a function chooses by the class that
 * the instance has as its first member. */
#include <strings.h>

#include "st/st_emit.h"

/** A block that extends `unit` has its own one. Of an interface every block does. */
static bool is_overridden(const st_t *st, const unit_t *unit, const char *name)
{
    const unit_t *ours = cm1e_st_find_method(unit, name);
    if (strcasecmp(name, "FB_Init") == 0) /* each block has its own one, with inputs of its own */
        return false;
    for (const unit_t *other = st->tree.units; other; other = other->next)
        if (other->kind == U_BLOCK && other->object.has_class && cm1e_st_is_a(st, other, unit) &&
            cm1e_st_find_method(other, name) != ours)
            return true;
    return unit->kind == U_INTERFACE || (ours && ours->object.abstract);
}

void cm1e_st_emit_instance(st_t *st, const expr_t *call)
{
    if (call->unit->kind != U_METHOD) {
        cm1e_st_put(st, "NULL");
    } else if (!call->a) {
        cm1e_st_put(st, "self");
    } else if (call->a->type->kind == T_INTERFACE) {
        cm1e_st_put(st, "st_reach(");
        cm1e_st_emit_expression(st, call->a);
        cm1e_st_put(st, ", ST_HERE)");
    } else {
        cm1e_st_put(st, "&");
        cm1e_st_emit_expression(st, call->a);
    }
}

void cm1e_st_emit_method(st_t *st, const expr_t *call)
{
    const unit_t *method = call->unit;
    const bool chosen = !call->super && is_overridden(st, call->seen_as, method->name);
    if (chosen)
        cm1e_st_put(st, "%s(", cm1e_st_method_name(st, "CALL", call->seen_as, method->name));
    else
        cm1e_st_put(st, "%s((%s *)", method->c_name, method->c_type);
    cm1e_st_emit_instance(st, call);
}

static void emit_arguments(st_t *st, const unit_t *method, bool declare)
{
    for (const var_t *var = method->vars; var; var = var->next) {
        const bool text = var->section == V_INPUT && var->type->kind == T_STRING;
        if (var->section != V_INPUT && var->section != V_OUTPUT && var->section != V_IN_OUT)
            continue;
        cm1e_st_put(st, ", ");
        if (declare)
            cm1e_st_put(st, "%s %s", text ? cm1e_st_text_unit(var->type) : cm1e_st_c_type(st, var->type),
                        text || var->section != V_INPUT ? "*" : "");
        cm1e_st_put(st, "%s%s", var->c_name, text ? "in" : var->section == V_OUTPUT ? "out" : "");
    }
}

static void emit_case(st_t *st, const unit_t *class, const char *name)
{
    const unit_t *method = cm1e_st_find_method(class, name);
    if (!method || method->object.abstract)
        return;
    cm1e_st_put(st, "    case %d: %s%s((%s *)self", class->object.class_id, method->result_type ? "return " : "",
                method->c_name, method->c_type);
    emit_arguments(st, method, false);
    cm1e_st_put(st, ");%s\n", method->result_type ? "" : " return;");
}

static void emit_dispatcher(st_t *st, const unit_t *unit, const unit_t *method, bool body)
{
    cm1e_st_put(st, "ST_UNUSED static %s %s(void *self",
                method->result_type ? cm1e_st_c_type(st, method->result_type) : "void",
                cm1e_st_method_name(st, "CALL", unit, method->name));
    emit_arguments(st, method, true);
    if (!body) {
        cm1e_st_put(st, ");\n");
        return;
    }
    cm1e_st_put(st, ")\n{\n    switch (*(const uint32_t *)self) {\n");
    for (const unit_t *class = st->tree.units; class; class = class->next)
        if (class->kind == U_BLOCK && class->object.has_class && !class->object.abstract &&
            cm1e_st_is_a(st, class, unit))
            emit_case(st, class, method->name);
    cm1e_st_put(st, "    default: st_fail(ST_HERE, \"this object has no such method\", 0, 0, 0);\n    }\n}\n");
}

/** All methods that `unit` can be asked for: its own, and those that it inherits. */
static void emit_of(st_t *st, const unit_t *unit, const unit_t *from, bool bodies)
{
    for (const unit_t *method = from->object.methods; method; method = method->object.next_method)
        if (from->kind == U_INTERFACE || cm1e_st_find_method(unit, method->name) == method)
            if (is_overridden(st, unit, method->name))
                emit_dispatcher(st, unit, method, bodies);
    if (from->object.base)
        emit_of(st, unit, from->object.base, bodies);
    for (const arg_t *arg = from->kind == U_INTERFACE ? from->object.interfaces : NULL; arg; arg = arg->next) {
        const unit_t *base = cm1e_st_map_get(st->units, arg->name);
        if (base && base->kind == U_INTERFACE)
            emit_of(st, unit, base, bodies);
    }
}

void cm1e_st_emit_dispatchers(st_t *st, bool bodies)
{
    for (const unit_t *unit = st->tree.units; unit; unit = unit->next)
        if (unit->kind == U_INTERFACE || (unit->kind == U_BLOCK && unit->object.has_class))
            emit_of(st, unit, unit, bodies);
}
