/* FB_Init of TwinCAT: a method that is called when an instance gets its initial values, first that of the base. What it
 * takes beyond the two inputs that all have is given in the declaration: fb : FB_X(number := 3), of an array
 * fbs : ARRAY[1..2] OF FB_X[(number := 3), (number := 4)]. */
#include <strings.h>

#include "st/st_parsing.h"

static bool is_standard(const var_t *var)
{
    return var->section == V_INPUT &&
           (strcasecmp(var->name, "bInitRetains") == 0 || strcasecmp(var->name, "bInCopyCode") == 0);
}

unit_t *cm1e_st_init_method(const unit_t *unit)
{
    return unit->object.names ? cm1e_st_map_get(unit->object.names, "FB_Init") : NULL;
}

bool cm1e_st_has_init(const unit_t *unit)
{
    for (; unit; unit = unit->object.base)
        if (cm1e_st_init_method(unit))
            return true;
    return false;
}

bool cm1e_st_init_takes(const unit_t *unit)
{
    for (; unit; unit = unit->object.base) {
        const unit_t *method = cm1e_st_init_method(unit);
        for (const var_t *var = method ? method->vars : NULL; var; var = var->next)
            if (cm1e_st_is_parameter(var) && !is_standard(var))
                return true;
    }
    return false;
}

static const var_t *parameter_named(const unit_t *unit, const char *name)
{
    for (; unit; unit = unit->object.base) {
        const unit_t *method = cm1e_st_init_method(unit);
        for (const var_t *var = method ? method->vars : NULL; var; var = var->next)
            if (var->section == V_INPUT && !is_standard(var) && strcasecmp(var->name, name) == 0)
                return var;
    }
    return NULL;
}

static const char *meant_parameter(st_t *st, const unit_t *unit, const char *name)
{
    cm1e_near_t near = {.word = name};
    for (; unit; unit = unit->object.base) {
        const unit_t *method = cm1e_st_init_method(unit);
        for (const var_t *var = method ? method->vars : NULL; var; var = var->next)
            if (var->section == V_INPUT && !is_standard(var))
                cm1e_near_look(&near, var->name);
    }
    return cm1e_st_meant(st, &near);
}

static const arg_t *given(const var_t *instance, const char *name)
{
    for (const arg_t *arg = instance->init_args; arg; arg = arg->next)
        if (strcasecmp(arg->name, name) == 0)
            return arg;
    return NULL;
}

static void check_given(st_t *st, const var_t *var)
{
    const unit_t *unit = var->type->kind == T_BLOCK ? var->type->unit : NULL;
    for (arg_t *arg = var->init_args; arg; arg = arg->next) {
        const var_t *parameter = unit ? parameter_named(unit, arg->name) : NULL;
        if (given(var, arg->name) != arg)
            cm1e_st_report(st, arg->place, "\"%s\" is given twice", arg->name);
        else if (parameter)
            arg->value = cm1e_st_initialiser(st, arg->value, cm1e_st_resolve(st, parameter->type), arg->name);
        else
            cm1e_st_report(st, arg->place,
                           "%s has no FB_Init with an input \"%s\"%s; initial values of inputs stand behind :=",
                           cm1e_st_type_name(var->type), arg->name, meant_parameter(st, unit, arg->name));
    }
    for (const unit_t *at = unit; at && var->section != V_IN_OUT; at = at->object.base) {
        const unit_t *method = cm1e_st_init_method(at);
        for (const var_t *parameter = method ? method->vars : NULL; parameter; parameter = parameter->next)
            if (cm1e_st_is_parameter(parameter) && !is_standard(parameter) && !given(var, parameter->name))
                cm1e_st_report(st, var->place, "FB_Init of %s needs \"%s\": %s : %s(%s := ...)", at->name,
                               parameter->name, var->name, unit->name, parameter->name);
    }
}

var_t cm1e_st_init_element(const var_t *array, const arg_t *inputs)
{
    var_t element = *array;
    element.place = inputs->place;
    element.type = array->type->element;
    element.init_args = inputs->value->args;
    return element;
}

static void check_elements(st_t *st, const var_t *var)
{
    const uint64_t elements = var->type->element->size ? var->type->size / var->type->element->size : 0;
    uint64_t count = 0;
    for (const arg_t *arg = var->init_elements; arg; arg = arg->next) {
        count++;
        if (arg->value->kind != E_STRUCT_INIT) {
            cm1e_st_report(st, arg->place, "the inputs of FB_Init stand in parentheses, once for each element: "
                           "(number := 1), (number := 2)");
            return;
        }
        const var_t element = cm1e_st_init_element(var, arg);
        check_given(st, &element);
    }
    if (count != elements)
        cm1e_st_report(st, var->init_elements->place, "the array has %llu elements, and the inputs of FB_Init are "
                       "given for %llu", (unsigned long long)elements, (unsigned long long)count);
}

void cm1e_st_check_init_args(st_t *st, var_t *var)
{
    if (var->section == V_IN_OUT && (var->init_args || var->init_elements)) {
        cm1e_st_report(st, var->place, "a VAR_IN_OUT is an instance of the caller, which has given it the inputs of "
                       "its FB_Init");
        return;
    }
    check_given(st, var);
    const type_t *element = var->type;
    while (element->kind == T_ARRAY)
        element = element->element;
    const bool takes = element->kind == T_BLOCK && cm1e_st_init_takes(element->unit) && var->section != V_IN_OUT;
    if (takes && var->type->kind == T_ARRAY && element != var->type->element)
        cm1e_st_report(st, var->place, "FB_Init of %s needs inputs, which an array of arrays cannot be given: give it "
                       "more dimensions, ARRAY[1..2, 1..3] OF %s", element->name, element->name);
    else if (takes && var->init_elements)
        check_elements(st, var);
    else if (takes && element != var->type)
        cm1e_st_report(st, var->place, "FB_Init of %s needs inputs for each element: ARRAY[1..2] OF %s[(number := 1), "
                       "(number := 2)]", element->name, element->name);
    else if (var->init_elements && element->kind != T_WRONG)
        cm1e_st_report(st, var->init_elements->place, "%s has no FB_Init with inputs; initial values stand behind :=",
                       cm1e_st_type_name(element));
}

const expr_t *cm1e_st_init_arg(const var_t *instance, const var_t *parameter)
{
    const arg_t *arg = instance && !is_standard(parameter) ? given(instance, parameter->name) : NULL;
    return arg ? arg->value : NULL;
}
