/* Types in C, and the initial values of what has them. Arrays and texts are structs, so that C can assign them. */
#include "st/st_emit.h"

#include <string.h>

static bool is_stored(const var_t *var) { return var->section != V_TEMP && var->section != V_EXTERNAL; }

bool cm1e_st_needs_initial(const type_t *type)
{
    if (type->kind == T_ARRAY)
        return cm1e_st_needs_initial(type->element);
    if (type->kind == T_ENUM) /* without a 0 among its values the first one is the initial value */
        return type->members && type->members->value.integer != 0;
    if (type->kind != T_STRUCT && type->kind != T_BLOCK)
        return false;
    if (type->kind == T_BLOCK && type->unit->object.has_class)
        return true;
    for (const var_t *var = type->members; var; var = var->next)
        if (is_stored(var) && var->section != V_IN_OUT && (var->initial || cm1e_st_needs_initial(var->type)))
            return true;
    return false;
}

static void emit_members(st_t *st, type_t *type)
{
    cm1e_st_put(st, "typedef struct %s {\n", type->c_name);
    bool empty = true;
    if (type->kind == T_BLOCK && type->unit->object.has_class) {
        cm1e_st_put(st, "    uint32_t class_;\n");
        empty = false;
    }
    for (const var_t *var = type->members; var; var = var->next) {
        if (!is_stored(var))
            continue;
        const char *c_type = cm1e_st_c_type(st, var->type);
        const bool pointer = var->section == V_IN_OUT;
        const char *space = c_type[strlen(c_type) - 1] == '*' ? "" : " ";
        cm1e_st_put(st, "    %s%s%s%s;\n", c_type, pointer ? " " : space, pointer ? "*" : "", var->c_name);
        empty = false;
    }
    if (empty)
        cm1e_st_put(st, "    BOOL nothing;\n");
    cm1e_st_put(st, "} %s;\n", type->c_name);
}

static void emit_init_function(st_t *st, type_t *type)
{
    if (!cm1e_st_needs_initial(type))
        return;
    cm1e_st_put(st, "ST_UNUSED static void init_%s(%s *self)\n{\n", type->c_name, type->c_name);
    st->indent++;
    if (type->kind == T_BLOCK && type->unit->object.has_class)
        cm1e_st_line(st, "self->class_ = %d;\n", type->unit->object.class_id);
    for (const var_t *var = type->members; var; var = var->next)
        if (is_stored(var) && var->section != V_IN_OUT)
            cm1e_st_emit_initial(st, cm1e_st_format(st->arena, "self->%s", var->c_name), var->type, var->initial);
    st->indent--;
    cm1e_st_put(st, "}\n");
}

/** What a reference refers to may be declared later, and is a struct then. */
static void emit_reference(st_t *st, type_t *type)
{
    type_t *to = type->element;
    while (to->kind == T_REF)
        to = to->element;
    if (to->kind == T_STRUCT || to->kind == T_BLOCK)
        cm1e_st_put(st, "typedef struct %s %s;\n", to->c_name, to->c_name);
    else
        cm1e_st_emit_type(st, to);
}

static void emit_enum(st_t *st, type_t *type)
{
    cm1e_st_put(st, "typedef %s %s;\nenum {", type->element->name, type->c_name);
    for (const var_t *var = type->members; var; var = var->next)
        if (var->value.integer >= INT32_MIN && var->value.integer <= INT32_MAX) /* C's enumerators are int */
            cm1e_st_put(st, "%s%s = %lld", var == type->members ? " " : ", ", var->c_name,
                        (long long)var->value.integer);
    cm1e_st_put(st, " };\n");
}

void cm1e_st_emit_type(st_t *st, type_t *type)
{
    if (type->emitted || type->kind <= T_NULL || type->kind == T_WRONG || type->kind == T_INTERFACE)
        return;
    type->emitted = true;
    if (type->kind == T_REF) {
        emit_reference(st, type);
        return;
    }
    if (type->kind == T_ARRAY) {
        cm1e_st_emit_type(st, type->element);
        const char *element = cm1e_st_c_type(st, type->element);
        cm1e_st_put(st, "typedef struct %s {\n    %s at[%llu];\n} %s;\n", type->c_name, element,
                    (unsigned long long)(type->element->size ? type->size / type->element->size : 1), type->c_name);
    } else if (type->kind == T_STRING) {
        if (type->length != ST_STRING_BYTES) /* that one is a part of the run-time */
            cm1e_st_put(st, "typedef struct %s {\n    char text[%lld];\n} %s;\n", type->c_name,
                        (long long)type->length + 1, type->c_name);
    } else if (type->kind == T_ENUM) {
        emit_enum(st, type);
    } else {
        for (var_t *var = type->members; var; var = var->next)
            cm1e_st_emit_type(st, var->type);
        emit_members(st, type);
        emit_init_function(st, type);
        if (type->kind == T_BLOCK && type->external)
            cm1e_st_put(st, "void %s(%s *fb);\n", type->unit->c_name, type->c_name);
    }
}

/* ---- initial values ---------------------------------------------------------------------------------------------- */

static void emit_default(st_t *st, const char *target, const type_t *type)
{
    if (!cm1e_st_needs_initial(type))
        return;
    if (type->kind == T_ENUM) {
        cm1e_st_line(st, "%s = %lld;\n", target, (long long)type->members->value.integer);
    } else if (type->kind == T_ARRAY) {
        const unsigned n = ++st->temporaries;
        cm1e_st_line(st, "for (size_t i%u = 0; i%u < %lluu; i%u++) {\n", n, n,
                     (unsigned long long)(type->size / type->element->size), n);
        st->indent++;
        emit_default(st, cm1e_st_format(st->arena, "%s.at[i%u]", target, n), type->element);
        st->indent--;
        cm1e_st_line(st, "}\n");
    } else {
        cm1e_st_line(st, "init_%s(&%s);\n", type->c_name, target);
    }
}

static void emit_elements(st_t *st, const char *target, type_t *type, const expr_t *initial)
{
    uint64_t at = 0;
    for (const arg_t *arg = initial->args; arg; arg = arg->next) {
        if (arg->value->kind != E_REPEAT) {
            cm1e_st_emit_initial(st, cm1e_st_format(st->arena, "%s.at[%llu]", target, (unsigned long long)at++),
                                 type->element, arg->value);
            continue;
        }
        const unsigned n = ++st->temporaries;
        const uint64_t times = (uint64_t)arg->value->a->value.integer;
        cm1e_st_line(st, "for (size_t i%u = %llu; i%u < %llu; i%u++) {\n", n, (unsigned long long)at, n,
                     (unsigned long long)(at + times), n);
        st->indent++;
        cm1e_st_emit_initial(st, cm1e_st_format(st->arena, "%s.at[i%u]", target, n), type->element, arg->value->b);
        st->indent--;
        cm1e_st_line(st, "}\n");
        at += times;
    }
}

void cm1e_st_emit_initial(st_t *st, const char *target, type_t *type, const expr_t *initial)
{
    if (!initial || initial->kind == E_STRUCT_INIT || initial->kind == E_ARRAY_INIT)
        emit_default(st, target, type);
    if (!initial)
        return;
    if (initial->kind == E_ARRAY_INIT) {
        emit_elements(st, target, type, initial);
    } else if (initial->kind == E_STRUCT_INIT) {
        for (const arg_t *arg = initial->args; arg; arg = arg->next)
            cm1e_st_emit_initial(st, cm1e_st_format(st->arena, "%s.%s", target, arg->parameter->c_name),
                                 arg->parameter->type, arg->value);
    } else if (type->kind == T_STRING) {
        cm1e_st_line(st, "st_assign(%s.text, sizeof %s.text, ", target, target);
        cm1e_st_emit_text(st, initial);
        cm1e_st_put(st, ");\n");
    } else {
        cm1e_st_line(st, "%s = ", target);
        cm1e_st_emit_expression(st, initial);
        cm1e_st_put(st, ";\n");
    }
}
