/* Declarations: names of types, units and variables, their types, and the values of constants. */
#include <string.h>
#include <strings.h>

#include "st/st_parsing.h"

/* ---- names of the emitted C -------------------------------------------------------------------------------------- */

/** A prefix by kind, or an underscore behind it: no name of a program is a word of C, or a name of ours. */
static void name_types(st_t *st)
{
    static const char *const prefixes[] = {[T_STRUCT] = "T", [T_ENUM] = "E"};
    for (type_t *type = st->tree.types; type; type = type->next) {
        if (type->kind == T_STRUCT || type->kind == T_ENUM)
            type->c_name = cm1e_st_format(st->arena, "%s_%s", prefixes[type->kind], cm1e_st_c_name(st, type->name));
        for (var_t *var = type->kind == T_STRUCT ? type->members : NULL; var; var = var->next)
            var->c_name = cm1e_st_format(st->arena, "%s_", var->name);
        for (var_t *var = type->kind == T_ENUM ? type->members : NULL; var; var = var->next) {
            var->c_name = cm1e_st_format(st->arena, "%s__%s", type->c_name, var->name);
            var->owner = type;
        }
    }
}

/** No variable of a program ends in such a letter in C. */
static const char *kept_name(st_t *st, const var_t *var)
{
    const char *plain = strrchr(var->name, '.') ? strrchr(var->name, '.') + 1 : var->name;
    const char *keeper = cm1e_st_c_name(st, cm1e_st_shown_name(st, var->keeper));
    return cm1e_st_format(st->arena, "K%zu_%s_%s_k", strlen(keeper), keeper, plain);
}

static void name_units(st_t *st)
{
    static const char *const prefixes[] = {[U_FUNCTION] = "FUN", [U_BLOCK] = "FB", [U_PROGRAM] = "PRG",
                                           [U_METHOD] = "MET", [U_INTERFACE] = "ITF"};
    for (unit_t *unit = st->tree.units; unit; unit = unit->next) {
        const char *symbol = st->sources[unit->place.file].symbol, *name = cm1e_st_c_name(st, unit->name);
        unit->c_name = unit->external ? cm1e_st_format(st->arena, "%s%s", symbol, unit->name)
            : unit->kind == U_METHOD ? cm1e_st_method_name(st, "MET", unit->object.owner, unit->name)
            : unit->kind == U_FUNCTION ? cm1e_st_format(st->arena, "FUN_%s", name)
            : cm1e_st_format(st->arena, "run_%s", name);
        unit->c_type = cm1e_st_format(st->arena, "%s_%s", prefixes[unit->kind], name);
        if (unit->kind == U_METHOD)
            unit->c_type = cm1e_st_format(st->arena, "%s_%s", prefixes[unit->object.owner->kind],
                                          cm1e_st_c_name(st, unit->object.owner->name));
        if (unit->type)
            unit->type->c_name = unit->kind == U_INTERFACE ? "st_interface_t" : unit->c_type;
        for (var_t *var = unit->vars; var; var = var->next) {
            var->c_name = var->keeper ? kept_name(st, var) : cm1e_st_format(st->arena, "%s_", var->name);
            var->unit = unit;
        }
    }
    for (var_t *var = st->tree.globals; var; var = var->next)
        if (var->keeper) {
            var->list = cm1e_st_shown_name(st, var->keeper);
            var->c_name = kept_name(st, var);
        } else
            var->c_name = var->list ? cm1e_st_format(st->arena, "G_%s__%s", var->list, var->name)
                                : cm1e_st_format(st->arena, "G_%s", var->name);
}

/* ---- maps of names ----------------------------------------------------------------------------------------------- */

static void map_vars(st_t *st, map_t *map, var_t *vars, const char *where)
{
    for (var_t *var = vars; var; var = var->next) {
        if (cm1e_st_map_get(map, var->name))
            cm1e_st_report(st, var->place, "%s has \"%s\" already", where, var->name);
        else
            cm1e_st_map_put(map, var->name, var);
    }
}

/** An enumerator can be written without its type where only one type of its namespace has it. */
static void map_enumerators(st_t *st, type_t *type)
{
    static var_t several;
    const char *space = type->scope ? type->scope->space : "";
    for (var_t *var = type->members; var; var = var->next) {
        const char *name = *space ? cm1e_st_format(st->arena, "%s.%s", space, var->name) : var->name;
        cm1e_st_map_put(st->enumerators, name, cm1e_st_map_get(st->enumerators, name) ? &several : var);
    }
}

static void map_names(st_t *st)
{
    for (unit_t *unit = st->tree.units; unit; unit = unit->next) {
        unit->names = cm1e_st_map_new(st->arena);
        map_vars(st, unit->names, unit->vars, unit->name);
    }
    for (type_t *type = st->tree.types; type; type = type->next) {
        if (type->kind == T_ENUM && !type->unnamed)
            map_enumerators(st, type);
        if (type->kind == T_STRUCT || type->kind == T_ENUM)
            map_vars(st, cm1e_st_map_new(st->arena), type->members, cm1e_st_type_name(type));
    }
    for (unit_t *unit = st->tree.units; unit; unit = unit->next)
        if (cm1e_st_map_get(st->globals, unit->name))
            cm1e_st_report(st, unit->place, "there is a global variable \"%s\" already", unit->name);
}

/* ---- variables --------------------------------------------------------------------------------------------------- */

static void check_section(st_t *st, var_t *var)
{
    const unit_t *unit = var->unit;
    if ((var->qualifiers & Q_RETAIN) && var->section != V_LOCAL && var->section != V_GLOBAL)
        cm1e_st_report(st, var->place, "RETAIN is for VAR and VAR_GLOBAL only");
    if ((var->qualifiers & Q_RETAIN) && (var->qualifiers & (Q_NON_RETAIN | Q_CONSTANT)))
        cm1e_st_report(st, var->place, "RETAIN contradicts %s",
                       var->qualifiers & Q_CONSTANT ? "CONSTANT: a constant needs no file" : "NON_RETAIN");
    if ((var->qualifiers & Q_RETAIN) && unit && cm1e_st_is_function(unit))
        cm1e_st_report(st, var->place, "a function keeps nothing: RETAIN is for programs, blocks and global variables");
    if ((var->qualifiers & Q_CONSTANT) && (var->section == V_OUTPUT || var->section == V_TEMP))
        cm1e_st_report(st, var->place, "an output or a temporary variable cannot be CONSTANT");
    if ((var->qualifiers & Q_CONSTANT) && var->section != V_EXTERNAL && var->section != V_IN_OUT && !var->initial)
        cm1e_st_report(st, var->place, "the constant \"%s\" needs a value: := ...", var->name);
    if (unit && unit->object.is_class && var->section != V_LOCAL && var->section != V_EXTERNAL)
        cm1e_st_report(st, var->place, "a CLASS has variables (VAR), and no inputs and outputs: its methods have");
    if ((var->qualifiers & Q_EDGE) &&
        (var->section != V_INPUT || var->type->kind != T_BOOL || !unit || cm1e_st_is_function(unit)))
        cm1e_st_report(st, var->place, "R_EDGE and F_EDGE are for inputs of type BOOL of function blocks and programs");
    if (var->section == V_IN_OUT && var->initial)
        cm1e_st_report(st, var->place, "a VAR_IN_OUT has no initial value: the call gives the variable");
    if (var->address && var->section != V_LOCAL && var->section != V_GLOBAL)
        cm1e_st_report(st, var->address->place, "only variables of VAR and VAR_GLOBAL are at an address");
    if (var->address && unit && unit->kind != U_PROGRAM)
        cm1e_st_report(st, var->address->place, "an address is for variables of a program and global ones: a %s may "
                       "have several instances", unit->kind == U_BLOCK ? "function block" : "function");
    else if (var->address && (var->qualifiers & (Q_CONSTANT | Q_RETAIN)))
        cm1e_st_report(st, var->address->place, "a variable at an address is neither CONSTANT nor RETAIN");
    else if (var->address)
        cm1e_st_check_address(st, var);
    if ((var->qualifiers & Q_RETAIN) && !(unit && unit->kind == U_BLOCK) && !cm1e_st_can_be_kept(var->type))
        cm1e_st_report(st, var->place, "RETAIN keeps values, not %s: it is for elementary types, enumerations, texts, "
                       "and arrays and structures of these", cm1e_st_type_name(var->type));
    if ((var->qualifiers & Q_RETAIN) && unit && unit->kind == U_BLOCK)
        cm1e_st_report(st, var->place, "RETAIN in a function block is not supported: put the variable into the "
                       "program, or VAR_GLOBAL, and give it as VAR_IN_OUT");
}

static void check_external(st_t *st, var_t *var)
{
    var->type = cm1e_st_resolve(st, var->type);
    if (var->global) /* VAR_STAT, VAR_INST */
        return;
    if (var->initial || var->address || var->init_args || var->init_elements)
        cm1e_st_report(st, var->place, "VAR_EXTERNAL only names a global variable: its %s in VAR_GLOBAL",
                       var->initial ? "initial value stands" : var->address ? "address stands"
                                                                            : "inputs of FB_Init stand");
    var->global = cm1e_st_map_get(st->globals, var->name);
    if (!var->global) {
        cm1e_st_report(st, var->place, "there is no global variable \"%s\" (VAR_GLOBAL)%s", var->name,
                       cm1e_st_meant_name(st, var->name, st->globals));
        return;
    }
    var->global->type = cm1e_st_resolve(st, var->global->type);
    if (var->global->type != var->type && var->type->kind != T_WRONG && var->global->type->kind != T_WRONG)
        cm1e_st_report(st, var->place, "the global variable \"%s\" is %s, not %s", var->name,
                       cm1e_st_type_name(var->global->type), cm1e_st_type_name(var->type));
}

static void declare_var(st_t *st, var_t *var)
{
    if (var->section == V_EXTERNAL) {
        check_external(st, var);
        return;
    }
    cm1e_st_inherit_initial(st, var);
    var->type = cm1e_st_resolve(st, var->type);
    check_section(st, var);
    if (var->type->kind == T_BLOCK && var->type->unit->kind == U_PROGRAM)
        cm1e_st_report(st, var->place, "\"%s\" is a program: only a CONFIGURATION makes instances of programs",
                       var->type->name);
    if (var->type->kind == T_BLOCK && var->type->unit->object.abstract && var->section != V_IN_OUT)
        cm1e_st_report(st, var->place, "\"%s\" is ABSTRACT: only blocks that extend it have instances",
                       var->type->name);
    if (var->unit && cm1e_st_is_function(var->unit) && var->type->kind == T_BLOCK && var->section != V_IN_OUT)
        cm1e_st_report(st, var->place, "a function keeps nothing, so an instance of %s in it would begin anew in every "
                       "call: put it in a function block or a program, or take it as VAR_IN_OUT", var->type->name);
    if (var->section == V_TEMP && var->type->kind == T_BLOCK)
        cm1e_st_report(st, var->place, "an instance of a function block keeps its state: VAR_TEMP cannot");
}

static void check_initials(st_t *st, var_t *vars)
{
    for (var_t *var = vars; var; var = var->next)
        cm1e_st_check_initial(st, var);
}

void cm1e_st_declare(st_t *st)
{
    cm1e_st_check_used(st);
    cm1e_st_link_objects(st);
    name_types(st);
    name_units(st);
    map_names(st);
    for (type_t *type = st->tree.types; type; type = type->next)
        cm1e_st_resolve(st, type);
    for (var_t *var = st->tree.globals; var; var = var->next) {
        st->unit = var->keeper;
        declare_var(st, var);
    }
    for (st->unit = st->tree.units; st->unit; st->unit = st->unit->next)
        for (var_t *var = st->unit->vars; var; var = var->next)
            declare_var(st, var);
    check_initials(st, st->tree.globals);
    for (type_t *type = st->tree.types; type; type = type->next)
        if (type->kind == T_STRUCT)
            check_initials(st, type->members);
        else if (type->kind == T_ENUM && type->initial)
            type->initial = cm1e_st_initialiser(st, type->initial, type, type->name);
    for (st->unit = st->tree.units; st->unit; st->unit = st->unit->next) {
        if (st->unit->result_type)
            st->unit->result_type = cm1e_st_resolve(st, st->unit->result_type);
        check_initials(st, st->unit->vars);
    }
    cm1e_st_check_objects(st);
}

var_t *cm1e_st_member(const type_t *type, const char *name)
{
    if (type->kind == T_BLOCK)
        return cm1e_st_map_get(type->unit->names, name);
    for (var_t *var = type->members; var; var = var->next)
        if (strcasecmp(var->name, name) == 0)
            return var;
    return NULL;
}

var_t *cm1e_st_find_var(st_t *st, const char *name)
{
    var_t *var = st->unit ? cm1e_st_map_get(st->unit->names, name) : NULL;
    if (!var && st->unit && st->unit->object.owner)
        var = cm1e_st_map_get(st->unit->object.owner->names, name);
    if (!var)
        var = cm1e_st_map_get(st->globals, name);
    if (var && var->section == V_EXTERNAL && !var->global)
        var->global = cm1e_st_map_get(st->globals, var->name);
    if (var && var->type->state != ST_READY)
        var->type = cm1e_st_resolve(st, var->type);
    else if (var && var->type->same)
        var->type = var->type->same;
    return var;
}

var_t *cm1e_st_in_list(const st_t *st, const expr_t *expr)
{
    if (expr->kind != E_MEMBER || expr->bit || expr->a->kind != E_NAME)
        return NULL;
    return cm1e_st_map_get(st->globals, cm1e_st_format(st->arena, "%s.%s", expr->a->name, expr->name));
}

const constant_t *cm1e_st_constant_of(st_t *st, var_t *var)
{
    if (var->section == V_EXTERNAL && var->global)
        return cm1e_st_constant_of(st, var->global);
    if (!(var->qualifiers & Q_CONSTANT) || var->section == V_IN_OUT || var->section == V_INPUT)
        return &var->value;
    if (var->state == ST_BUSY) {
        cm1e_st_report(st, var->place, "the value of \"%s\" depends on itself", var->name);
    } else if (var->state == ST_NEW) {
        var->state = ST_BUSY;
        cm1e_st_check_initial(st, var);
    }
    return &var->value;
}

void cm1e_st_check_initial(st_t *st, var_t *var)
{
    unit_t *const unit = st->unit;
    if (var->section != V_EXTERNAL && var->type->state == ST_READY && !var->init_checked) {
        var->init_checked = true;
        cm1e_st_check_init_args(st, var);
    }
    if (!var->initial || var->state == ST_READY || var->section == V_EXTERNAL || st->resolving == ST_DEPTH)
        return;
    var->state = ST_BUSY;
    st->resolving++;
    st->unit = var->unit ? var->unit : var->keeper;
    const bool before = st->before_all;
    st->before_all = var->keeper && !var->unit;
    var->type = cm1e_st_resolve(st, var->type);
    var->initial = cm1e_st_initialiser(st, var->initial, var->type, var->name);
    if (var->qualifiers & Q_CONSTANT)
        var->value = var->initial->value;
    st->unit = unit;
    st->before_all = before;
    st->resolving--;
    var->state = ST_READY;
}
