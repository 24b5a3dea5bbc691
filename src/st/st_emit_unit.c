/* Functions, function blocks and programs in C. A block is a struct and a function that gets it as `self`. */
#include "st/st_emit.h"

/** Locals, outputs and the result begin anew in every call. */
static void emit_locals(st_t *st, const unit_t *unit)
{
    for (const var_t *var = unit->vars; var; var = var->next) {
        const bool text_input = cm1e_st_is_function(unit) && var->section == V_INPUT && var->type->kind == T_STRING;
        const bool local = cm1e_st_is_function(unit) ? var->section == V_LOCAL || var->section == V_OUTPUT ||
                                                      var->section == V_RESULT || var->section == V_TEMP
                                                    : var->section == V_TEMP;
        if (!local && !text_input)
            continue;
        const bool pointer = var->type->kind == T_REF;
        const bool aggregate = var->type->kind == T_STRUCT || var->type->kind == T_ARRAY || var->type->kind == T_STRING;
        cm1e_st_line(st, "ST_UNUSED %s%s%s = %s;\n", cm1e_st_c_type(st, var->type), pointer ? "" : " ", var->c_name,
                     aggregate ? "{0}" : pointer ? "NULL" : "0");
        if (text_input)
            cm1e_st_line(st, "%s(%s.text, sizeof %s.text, %sin);\n", cm1e_st_text_assign(var->type), var->c_name,
                         var->c_name, var->c_name);
        else
            cm1e_st_emit_initial(st, var->c_name, var->type, var->initial);
    }
}

static void emit_end(st_t *st, const unit_t *unit)
{
    if (st->leaves)
        cm1e_st_put(st, "leave:;\n");
    if (!cm1e_st_is_function(unit))
        return;
    for (const var_t *var = unit->vars; var; var = var->next)
        if (var->section == V_OUTPUT)
            cm1e_st_line(st, "if (%sout)\n        *%sout = %s;\n", var->c_name, var->c_name, var->c_name);
    if (unit->result)
        cm1e_st_line(st, "return %s;\n", unit->result->c_name);
}

/** `instance` is that of a method, whose block's variables an initial value may refer to. */
static void emit_default_function(st_t *st, const unit_t *unit, const var_t *var)
{
    const char *c_type = cm1e_st_c_type(st, var->type);
    const bool of_block = unit->kind == U_METHOD && unit->object.owner->kind == U_BLOCK;
    cm1e_st_put(st, "ST_UNUSED static %s %s(ST_UNUSED void *instance)\n{\n", c_type, cm1e_st_default_function(st, var));
    st->indent = 1;
    if (of_block)
        cm1e_st_line(st, "ST_UNUSED %s *const self = instance;\n", unit->c_type);
    cm1e_st_line(st, "%s %s;\n    memset(&%s, 0, sizeof %s);\n", c_type, var->c_name, var->c_name, var->c_name);
    cm1e_st_emit_initial(st, var->c_name, var->type, var->initial);
    cm1e_st_line(st, "return %s;\n", var->c_name);
    st->indent = 0;
    cm1e_st_put(st, "}\n");
}

void cm1e_st_emit_default_functions(st_t *st, unit_t *unit)
{
    st->unit = unit;
    for (const var_t *var = cm1e_st_is_function(unit) ? unit->vars : NULL; var; var = var->next)
        if (var->section == V_INPUT && cm1e_st_has_default_function(var))
            emit_default_function(st, unit, var);
    st->unit = NULL;
}

void cm1e_st_emit_unit(st_t *st, unit_t *unit)
{
    st->unit = unit;
    st->leaves = false;
    cm1e_st_put(st, "\n");
    cm1e_st_place(st, unit->place);
    cm1e_st_emit_head(st, unit);
    cm1e_st_put(st, "\n{\n");
    st->indent = 1;
    emit_locals(st, unit);
    cm1e_st_emit_statements(st, unit->body);
    emit_end(st, unit);
    st->indent = 0;
    cm1e_st_put(st, "}\n");
}
