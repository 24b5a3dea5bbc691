/* Builds the tree: what the actions of the parser call. */
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "st/st_parsing.h"

enum { STATEMENT_DEPTH = 60 };

expr_t *cm1e_st_qualified(st_t *st, place_t place, const char *text)
{
    const char *mark = strchr(text, '#');
    if (strncasecmp(text, "BOOL#", 5) == 0)
        return cm1e_st_literal(st, place, text);
    expr_t *expr = cm1e_st_named(st, E_QUALIFIED, place, NULL, mark + 1);
    expr->prefix = cm1e_st_copy(st->arena, text, (size_t)(mark - text));
    return expr;
}

expr_t *cm1e_st_qualified_in(st_t *st, place_t place, const expr_t *space, const char *text)
{
    const char *prefix = cm1e_st_dotted(st, space);
    expr_t *expr = cm1e_st_qualified(st, place, text);
    if (prefix && expr->kind == E_QUALIFIED)
        expr->prefix = cm1e_st_format(st->arena, "%s.%s", prefix, expr->prefix);
    else
        cm1e_st_report(st, place, "only the name of a namespace can stand in front of the type");
    return expr;
}

void cm1e_st_deepen(st_t *st, stmt_t *stmt)
{
    for (const branch_t *branch = stmt->branches; branch; branch = branch->next)
        for (const stmt_t *inner = branch->body; inner; inner = inner->next)
            if (inner->depth >= stmt->depth)
                stmt->depth = inner->depth + 1;
    for (const stmt_t *inner = stmt->body; inner; inner = inner->next)
        if (inner->depth >= stmt->depth)
            stmt->depth = inner->depth + 1;
    if (stmt->depth <= STATEMENT_DEPTH)
        return;
    cm1e_st_report(st, stmt->place, "this statement has more than %d others around what is within it", STATEMENT_DEPTH);
    stmt->depth = 1;
    stmt->branches = NULL;
    stmt->body = NULL;
}

stmt_t *cm1e_st_stmt(st_t *st, stmt_kind_t kind, place_t place, expr_t *value, stmts_t body)
{
    stmt_t *stmt = cm1e_st_take(st->arena, sizeof *stmt);
    *stmt = (stmt_t){.kind = kind, .place = place, .value = value, .body = body.first, .depth = 1};
    cm1e_st_deepen(st, stmt);
    return stmt;
}

branch_t *cm1e_st_branch(st_t *st, place_t place, expr_t *condition, stmt_t *body)
{
    branch_t *branch = cm1e_st_take(st->arena, sizeof *branch);
    *branch = (branch_t){.condition = condition, .body = body, .place = place};
    return branch;
}

stmt_t *cm1e_st_latch(st_t *st, place_t place, expr_t *target, const char *word)
{
    const char *given = strcasecmp(word, "S") == 0 ? "TRUE" : "FALSE";
    stmt_t *stmt = cm1e_st_stmt(st, S_ASSIGN, place, cm1e_st_literal(st, place, given), (stmts_t){0});
    stmt->target = target;
    return stmt;
}

void cm1e_st_group_case(st_t *st, stmt_t *stmt, stmts_t items, stmts_t otherwise, bool has_else, place_t place)
{
    branches_t branches = {0};
    stmts_t body = {0};
    for (stmt_t *item = items.first, *next; item; item = next) {
        next = item->next;
        item->next = NULL;
        if (item->kind == S_LABEL) {
            if (branches.last)
                branches.last->body = body.first;
            body = (stmts_t){0};
            ST_APPEND(branches, item->branches);
        } else if (branches.last) {
            ST_APPEND(body, item);
        } else {
            cm1e_st_report(st, item->place, "a statement within CASE stands behind a label, as in \"1: x := 2;\"");
        }
    }
    if (branches.last)
        branches.last->body = body.first;
    if (has_else) {
        branch_t *branch = cm1e_st_branch(st, place, NULL, otherwise.first);
        ST_APPEND(branches, branch);
    }
    stmt->branches = branches.first;
    cm1e_st_deepen(st, stmt);
}

/* ---- declarations ------------------------------------------------------------------------------------------------ */

var_t *cm1e_st_var_name(parsing_t *parsing, place_t place, const char *name)
{
    var_t *var = cm1e_st_take(parsing->st->arena, sizeof *var);
    *var = (var_t){.name = name, .place = place};
    return var;
}

vars_t cm1e_st_vars(parsing_t *parsing, vars_t names, expr_t *address, type_t *type, expr_t *initial)
{
    for (var_t *var = names.first; var; var = var->next) {
        var->section = parsing->section;
        var->qualifiers |= parsing->qualifiers;
        var->address = address;
        var->type = type;
        var->initial = initial;
    }
    if (address && names.first && names.first->next)
        cm1e_st_report(parsing->st, names.first->next->place, "only one variable can be at an address");
    if (address && parsing->section == V_MEMBER)
        cm1e_st_report(parsing->st, address->place, "a member of a structure is at no address: a variable that has the "
                       "structure can be, AT %%MB4");
    return names;
}

void cm1e_st_edge(parsing_t *parsing, place_t place, const char *word, vars_t vars)
{
    const bool rising = strcasecmp(word, "R_EDGE") == 0;
    if (!rising && strcasecmp(word, "F_EDGE") != 0) {
        cm1e_st_report(parsing->st, place, "\"%s\" cannot stand here; expected \";\" or \":=\"", word);
        return;
    }
    if (parsing->section == V_MEMBER)
        cm1e_st_report(parsing->st, place, "%s is for inputs of function blocks and programs, not for members", word);
    for (var_t *var = vars.first; var; var = var->next)
        var->qualifiers |= rising ? Q_R_EDGE : Q_F_EDGE;
}

static bool is_external(const st_t *st, place_t place) { return st->sources[place.file].external; }

/** In our interface the type CM_COMMAND and the block CM_Command differ in case only. The later one is kept under a
 * name that nobody can write, where cm1e_st_resolve() finds it by its exact spelling. */
static bool keep_beside(st_t *st, map_t *map, place_t place, const char *name, void *value)
{
    if (map != st->types || !is_external(st, place))
        return false;
    cm1e_st_map_put(map, cm1e_st_format(st->arena, "%s'", ((type_t *)cm1e_st_map_get(map, name))->name),
                    cm1e_st_map_get(map, name));
    cm1e_st_map_put(map, name, value);
    return true;
}

/** A block of our library in Structured Text: a program may have its own one of this name. */
static bool of_library(const st_t *st, const map_t *map, const char *name)
{
    void *value = cm1e_st_map_get(map, name);
    const place_t place = map == st->units ? ((unit_t *)value)->place : ((type_t *)value)->place;
    return st->sources[place.file].library && !st->sources[st->source].library;
}

/** Enters a name; an earlier one of the same kind is an error. */
static bool enter(st_t *st, map_t *map, const char *what, place_t place, const char *name, void *value)
{
    const bool ours = map != st->globals && cm1e_st_map_get(map, name) && of_library(st, map, name);
    if (!ours && cm1e_st_map_get(map, name) && !keep_beside(st, map, place, name, value)) {
        cm1e_st_report(st, place, "there is a %s \"%s\" already", what, name);
        return false;
    }
    cm1e_st_map_put(map, name, value);
    return true;
}

type_t *cm1e_st_unnamed_enum(parsing_t *parsing, place_t place, vars_t enumerators, type_t *base)
{
    st_t *st = parsing->st;
    const char *name = cm1e_st_format(st->arena, "unnamed.%u_%u_%u", place.file, place.line, place.column);
    type_t *type = cm1e_st_type_node(st, T_ENUM, place, name);
    type->members = enumerators.first;
    type->element = base;
    type->unnamed = parsing->section != V_GLOBAL && parsing->section != V_MEMBER;
    type->shown = cm1e_st_format(st->arena, "(%s%s)", enumerators.first->name, enumerators.first->next ? ", ..." : "");
    type->next = st->tree.types;
    st->tree.types = type;
    return type;
}

void cm1e_st_add_type(parsing_t *parsing, place_t place, const char *name, type_t *type, expr_t *initial)
{
    st_t *st = parsing->st;
    if (!type->name || type->kind == T_NONE || type->ranged) { /* an alias */
        type_t *alias = cm1e_st_type_node(st, T_NONE, place, name);
        alias->same = type;
        type = alias;
    }
    name = cm1e_st_full_name(st, name);
    type->name = name;
    type->initial = initial;
    type->place = place;
    type->external = is_external(st, place);
    if (cm1e_st_elementary(st, name))
        cm1e_st_report(st, place, "\"%s\" is an elementary type", name);
    else if (enter(st, st->types, "type", place, name, type)) {
        type->next = st->tree.types;
        st->tree.types = type;
    }
}

/** A VAR_STAT or VAR_INST becomes the name of a variable that is elsewhere. */
static var_t *keep(st_t *st, unit_t *unit, var_t *var, section_t section)
{
    var_t *kept = cm1e_st_take(st->arena, sizeof *kept);
    *kept = *var;
    kept->section = section;
    kept->keeper = unit;
    kept->next = NULL;
    var->section = V_EXTERNAL;
    var->global = kept;
    var->initial = var->address = NULL;
    var->init_args = var->init_elements = NULL;
    return kept;
}

/** VAR_STAT: a global variable that only this unit knows. */
static void keep_statics(st_t *st, unit_t *unit)
{
    for (var_t *var = unit->vars; var; var = var->next) {
        if (var->section != V_STATIC)
            continue;
        if (unit->kind == U_FUNCTION && !(var->qualifiers & Q_CONSTANT))
            cm1e_st_report(st, var->place, "a function keeps nothing: VAR_STAT is for function blocks, methods and "
                           "programs. Make a function block of \"%s\"", unit->name);
        var_t *kept = keep(st, unit, var, V_GLOBAL);
        kept->next = st->tree.globals;
        st->tree.globals = kept;
    }
}

/** VAR_INST of a method: a variable of its block, under a name that nobody can write. */
static void keep_in_instance(st_t *st, unit_t *method, vars_t *vars)
{
    for (var_t *var = method->vars; var; var = var->next) {
        if (var->section != V_INSTANCE)
            continue;
        var_t *kept = keep(st, method, var, V_LOCAL);
        kept->name = cm1e_st_format(st->arena, "%s.%s", cm1e_st_shown_name(st, method), var->name);
        ST_APPEND(*vars, kept);
    }
}

/** A method of an interface has its parameters only: what implements it has the rest. */
static void check_prototype(st_t *st, const unit_t *method)
{
    for (const var_t *var = method->vars; var; var = var->next)
        if (!cm1e_st_is_parameter(var) && var->section != V_RESULT)
            cm1e_st_report(st, var->place, "a method of an interface has VAR_INPUT, VAR_OUTPUT and VAR_IN_OUT only: "
                           "other variables are of the method of the block that implements it");
    if (method->body)
        cm1e_st_report(st, method->body->place, "a method of an interface has no statements: the method of the block "
                       "that implements it has");
}

void cm1e_st_add_unit(parsing_t *parsing, unit_kind_t kind, place_t place, const char *name, type_t *result,
                      vars_t vars, stmts_t body)
{
    static const char *const kinds[] = {"function", "function block", "program", "method", "interface"};
    st_t *st = parsing->st;
    unit_t *unit = cm1e_st_take(st->arena, sizeof *unit);
    const char *const own = name;
    name = cm1e_st_full_name(st, name);
    *unit = (unit_t){.kind = kind, .name = name, .place = place, .vars = vars.first, .body = body.first,
                     .result_type = result, .external = is_external(st, place), .scope = st->scope};
    if (kind == U_PROGRAM && name != own)
        cm1e_st_report(st, place, "a program is in no namespace: its configuration is not either");
    if (kind != U_FUNCTION) {
        unit->object = parsing->object;
        unit->object.methods = parsing->methods;
        for (unit_t *method = parsing->methods; method; method = method->object.next_method) {
            method->object.owner = unit;
            if (kind == U_INTERFACE)
                check_prototype(st, method);
            keep_in_instance(st, method, &vars);
        }
        parsing->methods = NULL;
    }
    for (var_t *var = vars.first; var; var = var->next)
        if (var->section == V_INSTANCE)
            cm1e_st_report(st, var->place, "VAR_INST is for methods; the variables of a block or a program (VAR) keep "
                           "their values anyway");
    unit->vars = vars.first;
    keep_statics(st, unit);
    if (kind == U_FUNCTION && result) {
        var_t *var = cm1e_st_var_name(parsing, place, own);
        var->section = V_RESULT;
        var->type = result;
        unit->result = var;
        ST_APPEND(vars, var);
        unit->vars = vars.first;
    }
    if (kind != U_FUNCTION) {
        unit->type = cm1e_st_type_node(st, kind == U_INTERFACE ? T_INTERFACE : T_BLOCK, place, name);
        unit->type->size = unit->type->alignment = kind == U_INTERFACE ? sizeof(void *) : 0;
        unit->type->unit = unit;
        unit->type->members = unit->vars;
        unit->type->external = unit->external;
    }
    if (!enter(st, st->units, kinds[kind], place, name, unit))
        return;
    if (kind != U_FUNCTION && enter(st, st->types, "type", place, name, unit->type)) {
        unit->type->next = st->tree.types;
        st->tree.types = unit->type;
    }
    unit->next = st->tree.units;
    st->tree.units = unit;
}

/** A unit of its own, known by its block only; later ones of the same name are found by cm1e_st_link_objects(). */
static unit_t *add_part(parsing_t *parsing, place_t place, const char *name, type_t *result, vars_t vars, stmts_t body)
{
    st_t *st = parsing->st;
    unit_t *unit = cm1e_st_take(st->arena, sizeof *unit);
    *unit = (unit_t){.kind = U_METHOD, .name = name, .place = place, .body = body.first, .result_type = result,
                     .scope = st->scope};
    unit->object.next_method = parsing->methods;
    parsing->methods = unit;
    if (result) {
        const char *plain = strncmp(name, "get ", 4) == 0 ? name + 4 : name;
        unit->result = cm1e_st_var_name(parsing, place, plain);
        unit->result->section = V_RESULT;
        unit->result->type = result;
        ST_APPEND(vars, unit->result);
    }
    unit->vars = vars.first;
    keep_statics(st, unit);
    unit->next = st->tree.units;
    st->tree.units = unit;
    return unit;
}

int cm1e_st_with_modifier(parsing_t *parsing, place_t place, int modifiers, const char *word)
{
    static const struct {
        const char *word;
        int modifier;
    } words[] = {{"PUBLIC", M_PUBLIC},     {"PRIVATE", M_PRIVATE},   {"PROTECTED", M_PROTECTED},
                 {"INTERNAL", M_INTERNAL}, {"ABSTRACT", M_ABSTRACT}, {"FINAL", M_FINAL}};
    int modifier = 0; /* OVERRIDE needs none */
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (strcasecmp(word, words[i].word) == 0)
            modifier = words[i].modifier;
    if (modifiers & modifier)
        cm1e_st_report(parsing->st, place, "%s stands here twice", word);
    else if (modifier & M_ACCESS && modifiers & M_ACCESS)
        cm1e_st_report(parsing->st, place, "%s is too many: one of PUBLIC, PRIVATE, PROTECTED and INTERNAL", word);
    if (((modifiers | modifier) & (M_ABSTRACT | M_FINAL)) == (M_ABSTRACT | M_FINAL))
        cm1e_st_report(parsing->st, place, "ABSTRACT and FINAL contradict each other");
    return modifiers | modifier;
}

void cm1e_st_modify(object_t *object, int modifiers)
{
    object->abstract = modifiers & M_ABSTRACT;
    object->final = modifiers & M_FINAL;
    object->access = modifiers & M_ACCESS;
}

void cm1e_st_add_method(parsing_t *parsing, place_t place, const char *name, int modifiers, type_t *result, vars_t vars,
                        stmts_t body)
{
    cm1e_st_modify(&add_part(parsing, place, name, result, vars, body)->object, modifiers);
}

void cm1e_st_add_getter(parsing_t *parsing, place_t place, vars_t vars, stmts_t body)
{
    cm1e_st_add_method(parsing, place, cm1e_st_format(parsing->st->arena, "get %s", parsing->property),
                       parsing->property_modifiers, parsing->property_type, vars, body);
}

void cm1e_st_add_setter(parsing_t *parsing, place_t place, vars_t vars, stmts_t body)
{
    var_t *value = cm1e_st_var_name(parsing, place, parsing->property);
    value->section = V_INPUT;
    value->type = parsing->property_type;
    value->next = vars.first;
    vars.first = value;
    cm1e_st_add_method(parsing, place, cm1e_st_format(parsing->st->arena, "set %s", parsing->property),
                       parsing->property_modifiers, NULL, vars, body);
}

void cm1e_st_add_globals(st_t *st, vars_t vars)
{
    for (var_t *var = vars.first, *next; var; var = next) {
        next = var->next;
        var->next = NULL;
        var->list = st->sources[var->place.file].list;
        const char *name = var->list ? cm1e_st_format(st->arena, "%s.%s", var->list, var->name) : var->name;
        if (var->list && !st->sources[var->place.file].qualified)
            enter(st, st->globals, "global variable", var->place, var->name, var);
        if (enter(st, st->globals, "global variable", var->place, name, var)) {
            var->next = st->tree.globals;
            st->tree.globals = var;
        }
    }
}

void cm1e_st_add_task(st_t *st, place_t place, const char *name, args_t settings)
{
    task_t *task = cm1e_st_take(st->arena, sizeof *task);
    *task = (task_t){.name = name, .place = place, .settings = settings.first, .next = NULL};
    task_t **end = &st->tree.tasks;
    while (*end)
        end = &(*end)->next;
    *end = task;
}

void cm1e_st_add_instance(st_t *st, place_t place, const char *name, const char *task, const char *program,
                          args_t args)
{
    instance_t *instance = cm1e_st_take(st->arena, sizeof *instance);
    *instance = (instance_t){.name = name, .task_name = task, .program_name = program, .place = place,
                             .args = args.first};
    instance_t **end = &st->tree.instances;
    while (*end)
        end = &(*end)->next;
    *end = instance;
}
