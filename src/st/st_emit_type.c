/* Types in C, and the initial values of what has them. Arrays and texts are structs, so that C can assign them. */
#include "st/st_emit.h"

#include <string.h>

static void emit_struct(st_t *st, type_t *type)
{
    cm1e_st_put(st, "typedef %s %s {\n", type->overlay ? "union" : "struct", type->c_name);
    bool empty = true;
    if (type->overlay) /* {0} makes all bytes of the first member 0 */
        cm1e_st_put(st, "    uint8_t bytes[%llu];\n", (unsigned long long)type->size);
    if (type->kind == T_BLOCK && type->unit->object.has_class) {
        cm1e_st_put(st, "    uint32_t the_class;\n");
        empty = false;
    }
    for (const var_t *var = type->members; var; var = var->next) {
        if (!cm1e_st_is_stored(var))
            continue;
        const char *c_type = cm1e_st_c_type(st, var->type);
        const bool pointer = var->section == V_IN_OUT;
        const char *space = c_type[strlen(c_type) - 1] == '*' ? "" : " ";
        cm1e_st_put(st, "    %s%s%s%s;\n", c_type, pointer ? " " : space, pointer ? "*" : "", var->c_name);
        if (var->qualifiers & Q_EDGE)
            cm1e_st_put(st, "    BOOL %sedge, %sbefore;\n", var->c_name, var->c_name);
        empty = false;
    }
    if (empty)
        cm1e_st_put(st, "    BOOL nothing;\n");
    cm1e_st_put(st, "} %s;\n", type->c_name);
}

/** Before a call: the edges of its inputs. Not a part of the block: SUPER^() is no call of its own. */
static void emit_edges(st_t *st, const type_t *type)
{
    cm1e_st_put(st, "ST_UNUSED static void edges_%s(%s *self)\n{\n", type->c_name, type->c_name);
    for (const var_t *var = type->members; var; var = var->next) {
        if (!(var->qualifiers & Q_EDGE))
            continue;
        const bool rising = var->qualifiers & Q_R_EDGE;
        cm1e_st_put(st, "    self->%sedge = %sself->%s && %sself->%sbefore;\n", var->c_name, rising ? "" : "!",
                    var->c_name, rising ? "!" : "", var->c_name);
        cm1e_st_put(st, "    self->%sbefore = self->%s;\n", var->c_name, var->c_name);
    }
    cm1e_st_put(st, "}\n");
}

/** Calls of FB_Init, the one of the base first. `instance` has what the declaration gives; NULL: nothing. */
static void emit_init_calls(st_t *st, const unit_t *unit, const char *target, const var_t *instance)
{
    if (unit->object.base)
        emit_init_calls(st, unit->object.base, target, instance);
    const unit_t *method = cm1e_st_init_method(unit);
    if (!method)
        return;
    cm1e_st_line(st, "(void)%s((%s *)%s", method->c_name, method->c_type, target);
    for (const var_t *var = method->vars; var; var = var->next) {
        const expr_t *value = var->section == V_INPUT ? cm1e_st_init_arg(instance, var) : NULL;
        if (var->section != V_INPUT && var->section != V_OUTPUT && var->section != V_IN_OUT)
            continue;
        cm1e_st_put(st, ", ");
        if (value && var->type->kind == T_STRING)
            cm1e_st_emit_text(st, value);
        else if (value)
            cm1e_st_emit_expression(st, value);
        else
            cm1e_st_put(st, "FALSE");
    }
    cm1e_st_put(st, ");\n");
}

/** Its name is known from here on; what it does is written by cm1e_st_emit_init_functions(). */
static void declare_init_function(st_t *st, type_t *type)
{
    if (!cm1e_st_needs_initial(type))
        return;
    cm1e_st_put(st, "ST_UNUSED static void init_%s(%s *self);\n", type->c_name, type->c_name);
    type->next_initial = st->initials;
    st->initials = type;
}

static void emit_init_function(st_t *st, const type_t *type)
{
    const unit_t *unit = type->kind == T_BLOCK ? type->unit : NULL;
    cm1e_st_put(st, "ST_UNUSED static void init_%s(%s *self)\n{\n", type->c_name, type->c_name);
    st->indent++;
    if (unit && unit->object.has_class)
        cm1e_st_line(st, "self->the_class = %d;\n", unit->object.class_id);
    for (const var_t *var = type->members; var; var = var->next)
        if (cm1e_st_is_stored(var) && var->section != V_IN_OUT && !cm1e_st_begins_with_zero(type, var))
            cm1e_st_emit_var_initial(st, cm1e_st_format(st->arena, "self->%s", var->c_name), var);
    if (unit && cm1e_st_has_init(unit) && !cm1e_st_init_takes(unit))
        emit_init_calls(st, unit, "self", NULL);
    st->indent--;
    cm1e_st_put(st, "}\n");
}

void cm1e_st_emit_init_functions(st_t *st)
{
    for (const type_t *type = st->initials; type; type = type->next_initial) {
        st->unit = type->kind == T_BLOCK ? type->unit : NULL; /* whose variables are those of `self` */
        emit_init_function(st, type);
    }
    st->unit = NULL;
}

/** What a reference refers to may be declared later, and is a struct then. */
static void emit_reference(st_t *st, type_t *type)
{
    type_t *to = type->element;
    while (to->kind == T_REF)
        to = to->element;
    if (to->kind == T_STRUCT || to->kind == T_BLOCK)
        cm1e_st_put(st, "typedef %s %s %s;\n", to->overlay ? "union" : "struct", to->c_name, to->c_name);
    else
        cm1e_st_emit_type(st, to);
}

/** For the table of variables: others see and write enumerators by name. */
static void emit_names(st_t *st, const type_t *type)
{
    cm1e_st_put(st, "ST_UNUSED static const char *const names_%s[] = {", type->c_name);
    for (const var_t *var = type->members; var; var = var->next) {
        cm1e_st_put_quoted(st, var->name);
        cm1e_st_put(st, var->next ? ", " : "};\n");
    }
    cm1e_st_put(st, "ST_UNUSED static const int64_t values_%s[] = {", type->c_name);
    for (const var_t *var = type->members; var; var = var->next)
        cm1e_st_put(st, "%s%s", cm1e_st_int64(st, var->value.integer), var->next ? ", " : "};\n");
}

static void emit_enum(st_t *st, type_t *type)
{
    cm1e_st_put(st, "typedef %s %s;\n", type->element->name, type->c_name);
    for (const var_t *var = type->members; var; var = var->next)
        if (var->value.integer >= INT32_MIN && var->value.integer <= INT32_MAX) /* C's enumerators are int */
            cm1e_st_put(st, "enum { %s = %lld };\n", var->c_name, (long long)var->value.integer);
    emit_names(st, type);
}

void cm1e_st_emit_type(st_t *st, type_t *type)
{
    if (type->ranged && !type->emitted)
        cm1e_st_put(st, "typedef %s %s;\n", type->name, type->c_name);
    type->emitted = type->emitted || type->ranged;
    if (type->emitted || type->kind <= T_NULL || type->kind == T_WRONG || type->kind == T_INTERFACE)
        return;
    type->emitted = true;
    if (type->kind == T_REF) {
        emit_reference(st, type);
        return;
    }
    if (type->open) {
        cm1e_st_emit_type(st, type->element);
    } else if (type->kind == T_ARRAY) {
        cm1e_st_emit_type(st, type->element);
        const char *element = cm1e_st_c_type(st, type->element);
        cm1e_st_put(st, "typedef struct %s {\n    %s at[%llu];\n} %s;\n", type->c_name, element,
                    (unsigned long long)(type->element->size ? type->size / type->element->size : 1), type->c_name);
    } else if (type->kind == T_STRING) {
        if (type->length != ST_STRING_BYTES) /* that one is a part of the run-time */
            cm1e_st_put(st, "typedef struct %s {\n    %s text[%lld];\n} %s;\n", type->c_name,
                        type->wide ? "uint16_t" : "char", (long long)type->length + 1, type->c_name);
    } else if (type->kind == T_ENUM) {
        emit_enum(st, type);
    } else {
        if (type->kind == T_BLOCK && type->unit->object.base)
            cm1e_st_emit_type(st, type->unit->object.base->type);
        for (var_t *var = type->members; var; var = var->next)
            cm1e_st_emit_type(st, var->type);
        emit_struct(st, type);
        declare_init_function(st, type);
        if (type->kind == T_BLOCK && cm1e_st_has_edges(type->unit))
            emit_edges(st, type);
        if (type->kind == T_BLOCK && type->external)
            cm1e_st_put(st, "void %s(%s *fb);\n", type->unit->c_name, type->c_name);
    }
}

/* ---- initial values ---------------------------------------------------------------------------------------------- */

static void emit_default(st_t *st, const char *target, const type_t *type)
{
    if (!cm1e_st_needs_initial(type))
        return;
    if (type->kind == T_ENUM || type->ranged) {
        cm1e_st_line(st, "%s = %s;\n", target, cm1e_st_int64(st, cm1e_st_default_of(type)));
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

static void emit_given(st_t *st, const char *target, type_t *type, const expr_t *initial);

/** An instance gets the values of its type, and its FB_Init, once. */
static bool has_instance(const type_t *type)
{
    if (type->kind == T_ARRAY)
        return has_instance(type->element);
    for (const var_t *var = type->kind == T_STRUCT ? type->members : NULL; var; var = var->next)
        if (has_instance(var->type))
            return true;
    return type->kind == T_BLOCK;
}

/** A member has the value that its own declaration gives: a list of values replaces all of it. */
static void emit_member(st_t *st, const char *target, const var_t *member, const expr_t *initial)
{
    const bool list = initial->kind == E_STRUCT_INIT || initial->kind == E_ARRAY_INIT;
    if (list && member->initial && !has_instance(member->type)) {
        cm1e_st_line(st, "memset(&%s, 0, sizeof %s);\n", target, target);
        emit_default(st, target, member->type);
    }
    emit_given(st, target, member->type, initial);
}

static void emit_elements(st_t *st, const char *target, type_t *type, const expr_t *initial)
{
    uint64_t at = 0;
    for (const arg_t *arg = initial->args; arg; arg = arg->next) {
        if (arg->value->kind != E_REPEAT) {
            emit_given(st, cm1e_st_format(st->arena, "%s.at[%llu]", target, (unsigned long long)at++), type->element,
                       arg->value);
            continue;
        }
        const unsigned n = ++st->temporaries;
        const uint64_t times = (uint64_t)arg->value->a->value.integer;
        cm1e_st_line(st, "for (size_t i%u = %llu; i%u < %llu; i%u++) {\n", n, (unsigned long long)at, n,
                     (unsigned long long)(at + times), n);
        st->indent++;
        emit_given(st, cm1e_st_format(st->arena, "%s.at[i%u]", target, n), type->element, arg->value->b);
        st->indent--;
        cm1e_st_line(st, "}\n");
        at += times;
    }
}

/** What a declaration gives, over the values of the type. */
static void emit_given(st_t *st, const char *target, type_t *type, const expr_t *initial)
{
    if (initial->kind == E_ARRAY_INIT) {
        emit_elements(st, target, type, initial);
    } else if (initial->kind == E_STRUCT_INIT) {
        for (const arg_t *arg = initial->args; arg; arg = arg->next)
            emit_member(st, cm1e_st_format(st->arena, "%s.%s", target, arg->parameter->c_name), arg->parameter,
                        arg->value);
    } else if (type->kind == T_STRING) {
        cm1e_st_line(st, "%s(%s.text, sizeof %s.text, ", cm1e_st_text_assign(type), target, target);
        cm1e_st_emit_text(st, initial);
        cm1e_st_put(st, ");\n");
    } else {
        cm1e_st_line(st, "%s = ", target);
        cm1e_st_emit_expression(st, initial);
        cm1e_st_put(st, ";\n");
    }
}

void cm1e_st_emit_initial(st_t *st, const char *target, type_t *type, const expr_t *initial)
{
    if (!initial || initial->kind == E_STRUCT_INIT || initial->kind == E_ARRAY_INIT)
        emit_default(st, target, type);
    if (initial)
        emit_given(st, target, type, initial);
}

void cm1e_st_emit_var_initial(st_t *st, const char *target, const var_t *var)
{
    const bool takes = var->type->kind == T_BLOCK && cm1e_st_init_takes(var->type->unit);
    if (!takes && !var->init_elements) {
        cm1e_st_emit_initial(st, target, var->type, var->initial);
        return;
    }
    emit_default(st, target, var->type);
    if (takes)
        emit_init_calls(st, var->type->unit, cm1e_st_format(st->arena, "&%s", target), var);
    unsigned n = 0;
    for (const arg_t *inputs = var->init_elements; inputs; inputs = inputs->next) {
        const var_t element = cm1e_st_init_element(var, inputs);
        emit_init_calls(st, element.type->unit, cm1e_st_format(st->arena, "&%s.at[%u]", target, n++), &element);
    }
    if (var->initial)
        emit_given(st, target, var->type, var->initial);
}
