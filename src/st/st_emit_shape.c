/* What several parts of the emitter ask: the heads of functions, what has initial values, what has edges. */
#include "st/st_emit.h"

bool cm1e_st_is_stored(const var_t *var)
{
    return var->section != V_TEMP && var->section != V_EXTERNAL && !var->in_memory;
}

int64_t cm1e_st_default_of(const type_t *type)
{
    if (type->ranged)
        return type->first;
    const var_t *first = type->kind == T_ENUM ? type->members : NULL;
    return first ? type->initial ? type->initial->value.integer : first->value.integer : 0;
}

/** An enumeration in a block or a structure of the library begins with 0, as in C, also where no enumerator is 0: then
 *  the page of the block says what 0 means. Elsewhere it begins with its first enumerator. */
bool cm1e_st_begins_with_zero(const type_t *owner, const var_t *var)
{
    return owner->external && var->type->kind == T_ENUM && !var->initial;
}

bool cm1e_st_needs_initial(const type_t *type)
{
    if (type->kind == T_ARRAY)
        return cm1e_st_needs_initial(type->element);
    if (type->kind == T_ENUM || type->ranged)
        return cm1e_st_default_of(type) != 0;
    if (type->kind != T_STRUCT && type->kind != T_BLOCK)
        return false;
    if (type->kind == T_BLOCK && (type->unit->object.has_class || cm1e_st_has_init(type->unit)))
        return true;
    for (const var_t *var = type->members; var; var = var->next)
        if (cm1e_st_is_stored(var) && var->section != V_IN_OUT && !cm1e_st_begins_with_zero(type, var) &&
            (var->initial || cm1e_st_needs_initial(var->type)))
            return true;
    return false;
}

bool cm1e_st_has_default_function(const var_t *var)
{
    const type_kind_t kind = var->type->kind;
    if (kind == T_STRUCT || kind == T_ARRAY)
        return var->initial || cm1e_st_needs_initial(var->type);
    return kind != T_STRING && var->initial && !var->initial->value.known;
}

const char *cm1e_st_default_function(st_t *st, const var_t *var)
{
    return cm1e_st_format(st->arena, "default_%s__%s", var->unit->c_name, var->c_name);
}

bool cm1e_st_has_edges(const unit_t *unit)
{
    for (const var_t *var = unit->vars; var; var = var->next)
        if (var->qualifiers & Q_EDGE)
            return true;
    return false;
}

const char *cm1e_st_text_unit(const type_t *type) { return type->wide ? "const uint16_t" : "const char"; }
const char *cm1e_st_text_assign(const type_t *type) { return type->wide ? "st_wassign" : "st_assign"; }

/* ---- heads of functions ------------------------------------------------------------------------------------------ */

static void emit_parameters(st_t *st, const unit_t *unit, const char *comma)
{
    for (const var_t *var = unit->vars; var; var = var->next) {
        const char *type = cm1e_st_c_type(st, var->type);
        if (var->section == V_INPUT && var->type->kind == T_STRING)
            cm1e_st_put(st, "%s%s *%sin", comma, cm1e_st_text_unit(var->type), var->c_name);
        else if (var->section == V_INPUT)
            cm1e_st_put(st, "%s%s %s", comma, type, var->c_name);
        else if (var->section == V_OUTPUT)
            cm1e_st_put(st, "%s%s *%sout", comma, type, var->c_name);
        else if (var->section == V_IN_OUT)
            cm1e_st_put(st, "%s%s *%s", comma, type, var->c_name);
        else
            continue;
        comma = ", ";
    }
    if (!*comma)
        cm1e_st_put(st, "void");
}

void cm1e_st_emit_head(st_t *st, const unit_t *unit)
{
    if (cm1e_st_is_function(unit)) {
        cm1e_st_put(st, "ST_UNUSED static %s %s(",
                    unit->result_type ? cm1e_st_c_type(st, unit->result_type) : "void", unit->c_name);
        if (unit->kind == U_METHOD)
            cm1e_st_put(st, "ST_UNUSED %s *self", unit->c_type);
        emit_parameters(st, unit, unit->kind == U_METHOD ? ", " : "");
        cm1e_st_put(st, ")");
    } else {
        cm1e_st_put(st, "ST_UNUSED static void %s(ST_UNUSED %s *self)", unit->c_name, unit->c_type);
    }
}

void cm1e_st_emit_prototype(st_t *st, const unit_t *unit)
{
    cm1e_st_emit_head(st, unit);
    cm1e_st_put(st, ";\n");
}
