/* Calls of functions and function blocks: which argument is for which parameter, and its type. */
#include <string.h>
#include <strings.h>

#include "core/near.h"
#include "st/st_parsing.h"

static void look_at_unit(const char *name, void *value, void *context)
{
    const unit_t *unit = value;
    if (unit->kind == U_FUNCTION)
        cm1e_near_look(context, name);
}
static void look_at_standard(const char *name, void *context) { cm1e_near_look(context, name); }

static void unknown_function(st_t *st, expr_t *call, const char *name)
{
    char text[CM1E_NEAR_TEXT_BYTES];
    cm1e_near_t near = {.word = name};
    const char *hint;
    cm1e_st_alias("", name, &hint);
    if (hint) {
        cm1e_st_report(st, call->place, "%s of TwinCAT and CODESYS is not supported: %s", name, hint);
        call->type = st->elementary[T_WRONG];
        return;
    }
    cm1e_st_map_each(st->units, look_at_unit, &near);
    cm1e_st_standard_names(look_at_standard, &near);
    cm1e_st_report(st, call->place, "there is no function or instance \"%s\"%s", name,
                   cm1e_near_text(&near, text, sizeof text));
    call->type = st->elementary[T_WRONG];
}

/** Notes that the present unit calls another one. */
void cm1e_st_note_call(st_t *st, unit_t *callee)
{
    unit_t *unit = st->unit;
    if (!unit || callee->external)
        return;
    for (size_t i = 0; i < unit->call_count; i++)
        if (unit->calls[i] == callee)
            return;
    if (unit->call_count == unit->call_capacity) {
        unit_t **calls = cm1e_st_take(st->arena, (unit->call_capacity * 2 + 8) * sizeof(unit_t *));
        if (unit->call_count)
            memcpy(calls, unit->calls, unit->call_count * sizeof(unit_t *));
        unit->call_capacity = unit->call_capacity * 2 + 8;
        unit->calls = calls;
    }
    unit->calls[unit->call_count++] = callee;
}

/* ---- parameters -------------------------------------------------------------------------------------------------- */

static var_t *named_parameter(st_t *st, const unit_t *unit, const arg_t *arg)
{
    char text[CM1E_NEAR_TEXT_BYTES];
    cm1e_near_t near = {.word = arg->name};
    const char *hint, *ours = cm1e_st_alias(unit->name, arg->name, &hint);
    var_t *var = cm1e_st_map_get(unit->names, ours ? ours : arg->name);
    if (var && cm1e_st_is_parameter(var) && arg->output == (var->section == V_OUTPUT))
        return var;
    if (var && cm1e_st_is_parameter(var)) {
        cm1e_st_report(st, arg->place, arg->output ? "\"%s\" is an input of %s: use :="
                                                   : "\"%s\" is an output of %s: use =>", var->name, unit->name);
        return NULL;
    }
    if (hint) {
        cm1e_st_report(st, arg->place, "%s has no input \"%s\": %s", unit->name, arg->name, hint);
        return NULL;
    }
    for (const var_t *other = unit->vars; other; other = other->next)
        if (cm1e_st_is_parameter(other))
            cm1e_near_look(&near, other->name);
    cm1e_st_report(st, arg->place, "%s has no %s \"%s\"%s", unit->name, arg->output ? "output" : "input", arg->name,
                   cm1e_near_text(&near, text, sizeof text));
    return NULL;
}

/** By position: inputs and VAR_IN_OUT in the order of their declaration. What has an initial value may be left out at
 *  the end. */
static void match_positions(st_t *st, const unit_t *unit, expr_t *call)
{
    var_t *var = unit->vars;
    unsigned count = 0;
    for (arg_t *arg = call->args; arg; arg = arg->next) {
        if (arg->name) {
            cm1e_st_report(st, arg->place, "arguments are either all by position or all by name");
            return;
        }
        while (var && var->section != V_INPUT && var->section != V_IN_OUT)
            var = var->next;
        if (!var) {
            cm1e_st_report(st, arg->place, "%s takes %u argument%s", unit->name, count, count == 1 ? "" : "s");
            return;
        }
        arg->parameter = var;
        var = var->next;
        count++;
    }
    for (; var && cm1e_st_is_function(unit); var = var->next)
        if ((var->section == V_INPUT && !var->initial) || var->section == V_IN_OUT) {
            cm1e_st_report(st, call->place, "%s needs a value for \"%s\" too", unit->name, var->name);
            return;
        }
}

/** Override of MC_Power, which TwinCAT has: the velocity of the axis in percent. */
static bool is_override(st_t *st, const unit_t *unit, expr_t *call, arg_t *arg)
{
    if (!unit->external || strcasecmp(unit->name, "MC_Power") != 0 || strcasecmp(arg->name, "Override") != 0 ||
        arg->output)
        return false;
    if (arg->value) {
        cm1e_st_expression(st, arg->value);
        call->override = cm1e_st_coerce(st, arg->value, st->elementary[T_LREAL], "Override");
        arg->value = NULL;
    }
    return true;
}

/** EN := condition and ENO => variable, which every function, method and block has. */
static bool is_enable(st_t *st, const unit_t *unit, expr_t *call, arg_t *arg)
{
    const bool in = strcasecmp(arg->name, "EN") == 0 && !arg->output;
    const bool out = strcasecmp(arg->name, "ENO") == 0 && arg->output;
    if (!(in || out) || cm1e_st_map_get(unit->names, arg->name))
        return false;
    if (!arg->value)
        return true;
    cm1e_st_expression(st, arg->value);
    arg->value = in ? cm1e_st_coerce(st, arg->value, st->elementary[T_BOOL], "EN") : arg->value;
    if (out && cm1e_st_assignable(st, arg->value) && (arg->value->type->kind != T_BOOL || arg->value->bit))
        cm1e_st_report(st, arg->place, "ENO is given to a BOOL that is no bit of something else");
    *(in ? &call->enable : &call->enabled) = arg->value;
    if (!call->may_be_skipped)
        cm1e_st_report(st, arg->place, "a call with EN or ENO is a statement of its own, or all that is behind :=");
    arg->value = NULL;
    return true;
}

static void match_names(st_t *st, const unit_t *unit, expr_t *call)
{
    for (arg_t *arg = call->args; arg; arg = arg->next) {
        if (!arg->name) {
            cm1e_st_report(st, arg->place, "arguments are either all by position or all by name");
            return;
        }
        const bool left_out = !arg->value && unit->external && !cm1e_st_map_get(unit->names, arg->name);
        if (left_out || is_enable(st, unit, call, arg) || is_override(st, unit, call, arg))
            continue; /* left out: an input of another library's block */
        arg->parameter = named_parameter(st, unit, arg);
        for (const arg_t *other = call->args; other != arg; other = other->next)
            if (other->parameter && other->parameter == arg->parameter)
                cm1e_st_report(st, arg->place, "\"%s\" is given twice", arg->name);
    }
}

/* ---- values ------------------------------------------------------------------------------------------------------ */

/** What an output is given to: the output converted to the type of the variable. */
static void check_output(st_t *st, const unit_t *unit, const expr_t *callee, arg_t *arg)
{
    cm1e_st_expression(st, arg->value);
    if (!cm1e_st_assignable(st, arg->value))
        return;
    cm1e_st_note_change(st, arg->value);
    var_t *var = arg->parameter;
    var->type = cm1e_st_resolve(st, var->type);
    if (cm1e_st_is_function(unit)) {
        if (arg->value->type != var->type || arg->value->bit || arg->inverted)
            cm1e_st_report(st, arg->place, "the output \"%s\" needs a variable of type %s", var->name,
                           cm1e_st_type_name(var->type));
        return;
    }
    expr_t *output = cm1e_st_node(st, E_MEMBER, arg->place, (expr_t *)(uintptr_t)callee, NULL);
    output->name = var->name;
    output->var = var;
    output->type = var->type;
    if (arg->inverted) {
        output = cm1e_st_operation(st, OP_NOT, arg->place, output, NULL);
        output->type = var->type;
        if (var->type->kind != T_BOOL)
            cm1e_st_report(st, arg->place, "NOT in front of an output is for BOOL; this is %s",
                           cm1e_st_type_name(var->type));
    }
    arg->source = cm1e_st_coerce(st, output, arg->value->type, "the variable behind =>");
}

/** An array of any length takes any array with its elements and dimensions. */
static bool takes_array(const type_t *open, const type_t *given)
{
    return open->open && given->kind == T_ARRAY && given->element == open->element &&
           given->dimension_count == open->dimension_count;
}

static void check_in_out(st_t *st, arg_t *arg)
{
    var_t *var = arg->parameter;
    cm1e_st_expression(st, arg->value);
    var->type = cm1e_st_resolve(st, var->type);
    const bool constant = var->qualifiers & Q_CONSTANT, value = constant && cm1e_st_plain_kind(var->type) <= T_DT;
    if (value) /* a number can be given, too */
        arg->value = cm1e_st_coerce(st, arg->value, var->type, var->name);
    if (arg->value->type->kind == T_WRONG || var->type->kind == T_WRONG)
        return;
    const bool same = arg->value->type == var->type || takes_array(var->type, arg->value->type);
    if (!same || (!value && !cm1e_st_is_place(arg->value)))
        cm1e_st_report(st, arg->place, "\"%s\" is a VAR_IN_OUT of type %s and needs a variable of this type, not %s",
                       var->name, cm1e_st_type_name(var->type), cm1e_st_type_name(arg->value->type));
    else if (arg->value->bit)
        cm1e_st_report(st, arg->place, "a single bit cannot be a VAR_IN_OUT");
    else if (!constant && cm1e_st_assignable(st, arg->value) && st->unit)
        cm1e_st_note_change(st, arg->value);
}

static void check_arg(st_t *st, const unit_t *unit, expr_t *call, arg_t *arg)
{
    var_t *var = arg->parameter;
    if (!arg->value && (var->section == V_IN_OUT || (var->section == V_INPUT && cm1e_st_is_function(unit))))
        cm1e_st_report(st, arg->place, "a %s for \"%s\" is missing behind :=",
                       var->section == V_IN_OUT ? "variable" : "value", var->name);
    if (!arg->value)
        return;
    if (var->section == V_OUTPUT) {
        check_output(st, unit, call->a, arg);
    } else if (var->section == V_IN_OUT) {
        check_in_out(st, arg);
    } else {
        cm1e_st_expression(st, arg->value);
        var->type = cm1e_st_resolve(st, var->type);
        arg->value = cm1e_st_coerce(st, arg->value, var->type, var->name);
    }
}

static void check_args(st_t *st, const unit_t *unit, expr_t *call)
{
    if (call->args ? !call->args->name : cm1e_st_is_function(unit))
        match_positions(st, unit, call);
    else
        match_names(st, unit, call);
    for (arg_t *arg = call->args; arg; arg = arg->next) {
        if (arg->parameter)
            check_arg(st, unit, call, arg);
        else if (arg->value)
            cm1e_st_expression(st, arg->value);
        if (arg->value && arg->value->type)
            call->impure |= arg->value->impure;
        for (const arg_t *other = call->args; cm1e_st_is_function(unit) && other != arg; other = other->next)
            if (other->value && arg->value && !cm1e_st_alone(st, other->value, arg->value))
                return;
    }
    for (const var_t *var = unit->vars; var; var = var->next) {
        bool given = var->section != V_IN_OUT;
        for (const arg_t *arg = call->args; arg && !given; arg = arg->next)
            given = arg->parameter == var;
        if (!given)
            cm1e_st_report(st, call->place, "%s needs a variable for its VAR_IN_OUT \"%s\" in every call", unit->name,
                           var->name);
    }
}

static void call_block(st_t *st, expr_t *call, bool statement)
{
    unit_t *unit = call->a->type->unit;
    call->type = st->elementary[T_NONE];
    if (unit->object.is_class)
        cm1e_st_report(st, call->place, "\"%s\" is a CLASS, which has no statements of its own: call a method of it",
                       unit->name);
    call->unit = unit;
    call->impure = true;
    if (!statement)
        cm1e_st_report(st, call->place, "a %s has no result: call it in a statement of its own, and then read its "
                       "outputs", unit->kind == U_PROGRAM ? "program" : "function block");
    cm1e_st_note_call(st, unit);
    cm1e_st_note_change(st, call->a);
    check_args(st, unit, call);
}

void cm1e_st_take_program(st_t *st, expr_t *expr, unit_t *program)
{
    var_t *instance = cm1e_st_take(st->arena, sizeof *instance);
    *instance = (var_t){.name = program->name, .section = V_GLOBAL, .type = cm1e_st_resolve(st, program->type)};
    program->reached = expr->place;
    expr->var = instance;
    expr->type = instance->type;
}

/** A program calls others in TwinCAT and CODESYS. */
static bool call_program(st_t *st, expr_t *call, bool statement)
{
    unit_t *program = cm1e_st_map_get(st->units, call->a->name);
    if (!program || program->kind != U_PROGRAM)
        return false;
    if (st->unit && st->unit->kind == U_FUNCTION)
        cm1e_st_report(st, call->place, "a function keeps nothing, and calls no program");
    program->called = true;
    cm1e_st_take_program(st, call->a, program);
    call_block(st, call, statement);
    return true;
}

static void call_function(st_t *st, expr_t *call, unit_t *unit)
{
    call->unit = unit;
    call->type = unit->result_type ? cm1e_st_resolve(st, unit->result_type) : st->elementary[T_NONE];
    for (var_t *var = unit->vars; var; var = var->next) {
        const type_kind_t kind = var->section == V_INPUT ? cm1e_st_resolve(st, var->type)->kind : T_NONE;
        call->impure |= cm1e_st_gives_back(var) || kind == T_REF ||
                        (kind == T_INTERFACE && cm1e_st_body_changes(st, unit));
    }
    cm1e_st_note_call(st, unit);
    check_args(st, unit, call);
}

void cm1e_st_check_arguments(st_t *st, unit_t *unit, expr_t *call)
{
    cm1e_st_note_call(st, unit);
    check_args(st, unit, call);
}

/** Machines.Axes.Limit(x) */
static bool call_in_namespace(st_t *st, expr_t *call)
{
    const char *name = call->a->kind == E_MEMBER ? cm1e_st_dotted(st, call->a) : NULL;
    const expr_t *root = call->a;
    while (root->kind == E_MEMBER && root->a)
        root = root->a;
    unit_t *unit = name && !cm1e_st_find_var(st, root->name)
        ? cm1e_st_lookup(st, st->units, root->scope, root->place, name) : NULL;
    if (!unit || unit->kind != U_FUNCTION)
        return false;
    call_function(st, call, unit);
    return true;
}

/** An instance, also by REFERENCE TO. */
static bool is_instance(st_t *st, const var_t *var)
{
    type_t *type = var ? cm1e_st_resolve(st, var->type) : NULL;
    if (type && type->kind == T_REF && type->automatic)
        type = cm1e_st_resolve(st, type->element);
    return type && type->kind == T_BLOCK;
}

void cm1e_st_call(st_t *st, expr_t *call, bool statement)
{
    if (st->checker->call_method(st, call, statement))
        return;
    if (call->a->kind == E_NAME) {
        unit_t *unit = cm1e_st_lookup(st, st->units, call->a->scope, call->a->place, call->a->name);
        const var_t *var = cm1e_st_find_var(st, call->a->name);
        const bool is_function = unit && unit->kind == U_FUNCTION;
        const bool instance = is_instance(st, var);
        if (!instance && is_function) {
            call_function(st, call, unit);
            return;
        }
        if (!var && call_program(st, call, statement))
            return;
        if (!instance && cm1e_st_standard_call(st, call, call->a->name))
            return;
        if (!var) {
            if (unit)
                cm1e_st_report(st, call->place, unit->kind == U_BLOCK ?
                               "\"%s\" is a function block: declare an instance of it, and call that" :
                               "\"%s\" is an interface: declare a variable of it, and call its methods", unit->name);
            else
                unknown_function(st, call, call->a->name);
            call->type = st->elementary[T_WRONG];
            return;
        }
    }
    if (call_in_namespace(st, call))
        return;
    const char *dotted = call->a->kind == E_MEMBER ? cm1e_st_dotted(st, call->a->a) : NULL;
    if (dotted && cm1e_st_map_get(st->spaces, dotted) && !cm1e_st_find_var(st, dotted)) {
        unknown_function(st, call, cm1e_st_dotted(st, call->a));
        return;
    }
    cm1e_st_expression(st, call->a);
    if (call->a->type->kind == T_BLOCK) {
        call_block(st, call, statement);
        return;
    }
    if (call->a->type->kind != T_WRONG)
        cm1e_st_report(st, call->place, "%s cannot be called", cm1e_st_type_name(call->a->type));
    call->type = st->elementary[T_WRONG];
}
