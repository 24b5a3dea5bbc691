/* The check of all sources together: declarations, bodies, who calls whom, tasks. */
#include <string.h>
#include <strings.h>

#include "st/st_parsing.h"

enum { CALL_DEPTH = 100, STACK_BYTES = 256 * 1024 };
#define MS INT64_C(1000000)

/** Bytes of the locals of a function, which are on the stack. */
static uint64_t locals_of(const unit_t *unit)
{
    uint64_t bytes = 0;
    for (const var_t *var = unit->vars; var; var = var->next)
        if ((cm1e_st_is_function(unit) && var->section != V_EXTERNAL) || var->section == V_TEMP)
            bytes += var->type->size;
    return bytes;
}

/** Follows the calls of a unit: nothing calls itself, and the stack they need is bounded. */
static uint64_t follow_calls(st_t *st, unit_t *unit, int depth)
{
    if (unit->mark == 2)
        return unit->stack;
    if (unit->mark == 1 || depth > CALL_DEPTH) {
        cm1e_st_report(st, unit->place, unit->mark == 1 ? "\"%s\" calls itself, over others or directly: recursion is "
                       "not permitted (IEC 61131-3), because its end is not known" :
                       "calls are nested too deeply below \"%s\"", unit->name);
        return 0;
    }
    uint64_t deepest = 0;
    unit->mark = 1;
    for (size_t i = 0; i < unit->call_count; i++) {
        const uint64_t below = follow_calls(st, unit->calls[i], depth + 1);
        deepest = below > deepest ? below : deepest;
    }
    unit->mark = 2;
    unit->stack = deepest + locals_of(unit);
    if (unit->stack > STACK_BYTES)
        cm1e_st_report(st, unit->place, "the local variables of \"%s\" and of the functions that it calls need %llu "
                       "bytes; %d are the most: make large ones variables of a function block or a program", unit->name,
                       (unsigned long long)unit->stack, STACK_BYTES);
    return unit->stack;
}

static void check_units(st_t *st)
{
    for (st->unit = st->tree.units; st->unit; st->unit = st->unit->next) {
        st->loops = 0;
        cm1e_st_statements(st, st->unit->body);
    }
    for (unit_t *unit = st->tree.units; unit; unit = unit->next)
        follow_calls(st, unit, 0);
}

/* ---- tasks ------------------------------------------------------------------------------------------------------- */

/** SINGLE := variable: a BOOL that is read in every cycle. An index could stop the program there. */
static void single(st_t *st, task_t *task, arg_t *arg)
{
    const expr_t *at = arg->value;
    task->single = arg->value;
    while (at->kind == E_MEMBER && at->a)
        at = at->a;
    if (arg->value->type->kind != T_WRONG && (arg->value->type->kind != T_BOOL || at->kind != E_NAME))
        cm1e_st_report(st, arg->place, "SINGLE is a global variable of type BOOL, or an output or variable of a "
                       "program: its rising edge runs the task");
}

static void setting(st_t *st, task_t *task, arg_t *arg)
{
    cm1e_st_expression(st, arg->value);
    int64_t value = 0;
    for (const arg_t *other = task->settings; other != arg; other = other->next)
        if (strcasecmp(other->name, arg->name) == 0)
            cm1e_st_report(st, arg->place, "%s stands here twice", arg->name);
    if (strcasecmp(arg->name, "SINGLE") == 0) {
        single(st, task, arg);
    } else if (strcasecmp(arg->name, "INTERVAL") == 0) {
        const expr_t *expr = cm1e_st_coerce(st, arg->value, st->elementary[T_TIME], "INTERVAL");
        task->interval_ns = expr->value.integer;
        if (expr->type->kind != T_WRONG && (!expr->value.known || expr->value.integer <= 0))
            cm1e_st_report(st, arg->place, "INTERVAL is a time above 0, for instance T#10ms");
    } else if (strcasecmp(arg->name, "PRIORITY") != 0) {
        cm1e_st_report(st, arg->place, "a task has INTERVAL, SINGLE and PRIORITY, not %s", arg->name);
    } else if (cm1e_st_integer_constant(st, arg->value, &value, "PRIORITY")) {
        task->priority = value;
        if (value < 0 || value > 65535)
            cm1e_st_report(st, arg->place, "PRIORITY is 0 (the highest) to 65535");
    }
}

static task_t *find_task(st_t *st, const instance_t *instance)
{
    cm1e_near_t near = {.word = instance->task_name};
    for (task_t *task = st->tree.tasks; task; task = task->next) {
        if (strcasecmp(task->name, instance->task_name) == 0)
            return task;
        cm1e_near_look(&near, task->name);
    }
    cm1e_st_report(st, instance->place, "there is no task \"%s\"%s", instance->task_name, cm1e_st_meant(st, &near));
    return NULL;
}

/** PROGRAM x : Type (input := constant or global variable, ...): what the task does before and behind the program. */
static void instance_args(st_t *st, instance_t *instance)
{
    for (arg_t *arg = instance->args; arg; arg = arg->next) {
        var_t *var = arg->name ? cm1e_st_map_get(instance->unit->names, arg->name) : NULL;
        if (!var || var->section != (arg->output ? V_OUTPUT : V_INPUT) || !arg->value) {
            cm1e_st_report(st, arg->place, "the program \"%s\" has no %s \"%s\"%s", instance->unit->name,
                           arg->output ? "output" : "input", arg->name ? arg->name : "?",
                           cm1e_st_meant_var(st, arg->name ? arg->name : "", instance->unit->vars,
                                             1u << (arg->output ? V_OUTPUT : V_INPUT)));
            continue;
        }
        arg->parameter = var;
        cm1e_st_expression(st, arg->value);
        if (!arg->output) {
            arg->value = cm1e_st_coerce(st, arg->value, var->type, var->name);
        } else if (cm1e_st_assignable(st, arg->value) && arg->value->type != var->type) {
            cm1e_st_report(st, arg->place, "the output \"%s\" needs a variable of type %s", var->name,
                           cm1e_st_type_name(var->type));
        }
    }
}

static void look_at_program(const char *name, void *value, void *context)
{
    const unit_t *unit = value;
    if (unit->kind == U_PROGRAM)
        cm1e_near_look(context, name);
}

static const char *meant_program(st_t *st, const char *word)
{
    cm1e_near_t near = {.word = word};
    cm1e_st_map_each(st->units, look_at_program, &near);
    return cm1e_st_meant(st, &near);
}

static void check_instance(st_t *st, instance_t *instance)
{
    unit_t *unit = cm1e_st_map_get(st->units, instance->program_name);
    if (!unit || unit->kind != U_PROGRAM) {
        cm1e_st_report(st, instance->place, "there is no program \"%s\"%s", instance->program_name,
                       meant_program(st, instance->program_name));
        return;
    }
    instance->unit = unit;
    if (instance->task_name)
        instance->task = find_task(st, instance);
    for (const instance_t *other = st->tree.instances; other != instance; other = other->next)
        if (strcasecmp(other->name, instance->name) == 0)
            cm1e_st_report(st, instance->place, "there is an instance \"%s\" already", instance->name);
    instance_args(st, instance);
    for (const var_t *var = unit->vars; var; var = var->next)
        if (var->section == V_IN_OUT)
            cm1e_st_report(st, var->place, "a program has no VAR_IN_OUT here: use VAR_EXTERNAL");
}

/** Without a CONFIGURATION every program has one instance of its own name, in every cycle of the bus. */
static void default_instances(st_t *st)
{
    args_t none = {0};
    size_t count = 0;
    for (const unit_t *unit = st->tree.units; unit; unit = unit->next)
        count += unit->kind == U_PROGRAM;
    unit_t **units = cm1e_st_take(st->arena, (count + 1) * sizeof(unit_t *));
    count = 0;
    for (unit_t *unit = st->tree.units; unit; unit = unit->next)
        if (unit->kind == U_PROGRAM)
            units[count++] = unit;
    while (count-- > 0) /* the list has the last one first */
        cm1e_st_add_instance(st, units[count]->place, units[count]->name, NULL, units[count]->name, none);
}

/** A program that another one calls has one instance, of its own name, which no task runs. */
static void called_instance(st_t *st, const unit_t *unit)
{
    args_t none = {0};
    for (const instance_t *instance = st->tree.instances; instance; instance = instance->next)
        if (strcasecmp(instance->program_name, unit->name) == 0) {
            cm1e_st_report(st, instance->place, "the program \"%s\" is called in the statements of another one: no "
                           "task runs it, too. Remove it here, or the call", unit->name);
            return;
        }
    cm1e_st_add_instance(st, unit->place, unit->name, NULL, unit->name, none);
}

static void mark_run(unit_t *unit)
{
    if (unit->runs)
        return;
    unit->runs = true;
    for (size_t i = 0; i < unit->call_count; i++)
        mark_run(unit->calls[i]);
}

/** The first unit that calls another one. */
static const unit_t *caller_of(const st_t *st, const unit_t *callee)
{
    for (const unit_t *unit = st->tree.units; unit; unit = unit->next)
        for (size_t i = 0; i < unit->call_count; i++)
            if (unit->calls[i] == callee)
                return unit;
    return callee;
}

/** A program that does not run, or a method of one: that is what is to be told. */
static bool is_of_idle_program(const unit_t *unit)
{
    const unit_t *owner = unit->object.owner ? unit->object.owner : unit;
    return owner->kind == U_PROGRAM && !owner->runs;
}

/** A task of its own runs it, or it is called when instances get their initial values. */
static bool runs_uncalled(const unit_t *unit)
{
    const unit_t *owner = unit->object.owner;
    return (unit->kind == U_PROGRAM && !unit->called) || (owner && cm1e_st_init_method(owner) == unit);
}

/** Without a CONFIGURATION all programs run: a task runs them, or a call does. A call in what nobody calls does not,
 *  and a task of its own could move what the call was to decide about: the program has to say. */
static void check_all_run(st_t *st)
{
    for (unit_t *unit = st->tree.units; unit; unit = unit->next)
        if (runs_uncalled(unit))
            mark_run(unit);
    for (const unit_t *unit = st->tree.units; unit; unit = unit->next) {
        const unit_t *caller = unit->kind == U_PROGRAM && !unit->runs ? caller_of(st, unit) : NULL;
        if (caller && !is_of_idle_program(caller))
            cm1e_st_report(st, unit->place, "nothing runs the program \"%s\": it is called in \"%s\", and no program "
                           "that runs calls that. Call it from a program, remove that call, or let a CONFIGURATION say "
                           "which programs run", unit->name, cm1e_st_shown_name(st, caller));
    }
}

static void check_configuration(st_t *st)
{
    st->unit = NULL;
    if (!st->tree.configuration)
        default_instances(st);
    else if (!st->tree.instances)
        cm1e_st_report(st, st->tree.configuration_place, "this configuration runs no program: PROGRAM name WITH task : "
                       "Type;");
    for (const unit_t *unit = st->tree.units; unit && st->tree.configuration; unit = unit->next)
        if (unit->called)
            called_instance(st, unit);
    for (task_t *task = st->tree.tasks; task; task = task->next) {
        for (arg_t *arg = task->settings; arg; arg = arg->next)
            setting(st, task, arg);
        for (const task_t *other = st->tree.tasks; other != task; other = other->next)
            if (strcasecmp(other->name, task->name) == 0)
                cm1e_st_report(st, task->place, "there is a task \"%s\" already", task->name);
    }
    for (instance_t *instance = st->tree.instances; instance; instance = instance->next)
        check_instance(st, instance);
    for (const unit_t *unit = st->tree.units; unit; unit = unit->next) {
        int count = 0;
        for (const instance_t *instance = st->tree.instances; instance; instance = instance->next)
            count += instance->unit == unit;
        if (unit->reached.line > 0 && count != 1)
            cm1e_st_report(st, unit->reached, "a variable of the program \"%s\" can be used here if that has one "
                           "instance; it has %d", unit->name, count);
    }
    if (!st->tree.configuration && st->error_count == 0) /* else a call may lead in a circle */
        check_all_run(st);
}

bool cm1e_st_check(st_t *st)
{
    static const checker_t checker = {cm1e_st_check_expression, cm1e_st_check_integer, cm1e_st_call_method,
                                      cm1e_st_standard_call};
    st->checker = &checker;
    cm1e_st_parse(st);
    if (st->error_count > 0)
        return false;
    cm1e_st_declare(st);
    check_units(st);
    check_configuration(st);
    return st->error_count == 0;
}

bool cm1e_st_runs(const st_t *st) { return st->tree.instances != NULL; }
