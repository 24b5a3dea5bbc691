/* What extends what, and which interfaces a block has: by name, before anything is checked. */
#include <string.h>
#include <strings.h>

#include "st/st_parsing.h"

/** The length of the first name says where the second begins: B__C of A is not C of A__B. */
const char *cm1e_st_method_name(st_t *st, const char *prefix, const unit_t *owner, const char *name)
{
    const bool get = strncmp(name, "get ", 4) == 0, set = strncmp(name, "set ", 4) == 0;
    const char *class_name = cm1e_st_c_name(st, owner->name);
    return cm1e_st_format(st->arena, "%s%s%zu_%s_%s", prefix, get ? "_GET" : set ? "_SET" : "", strlen(class_name),
                          class_name, get || set ? name + 4 : name);
}

/* ---- links ------------------------------------------------------------------------------------------------------- */

typedef struct wanted {
    cm1e_near_t near;
    const unit_t *asks;
    unit_kind_t kind;
} wanted_t;

static void look_at_unit(const char *name, void *value, void *context)
{
    const unit_t *unit = value;
    wanted_t *wanted = context;
    if (unit != wanted->asks && unit->kind == wanted->kind && !unit->external)
        cm1e_near_look(&wanted->near, name);
}

static unit_t *named_unit(st_t *st, const unit_t *unit, const char *name, unit_kind_t kind, const char *what)
{
    unit_t *found = cm1e_st_lookup(st, st->units, unit->scope, unit->place, name);
    if (found && found->kind == kind && !found->external)
        return found;
    wanted_t wanted = {.near = {.word = name}, .asks = unit, .kind = kind};
    cm1e_st_map_each(st->units, look_at_unit, &wanted);
    cm1e_st_report(st, unit->place, "there is no %s \"%s\" that \"%s\" could %s%s", what, name, unit->name,
                   kind == U_INTERFACE && unit->kind == U_BLOCK ? "implement" : "extend",
                   cm1e_st_meant(st, &wanted.near));
    return NULL;
}

/** Of a variable that is inherited, in no list yet. */
static var_t *copy_of(st_t *st, const var_t *var)
{
    var_t *copy = cm1e_st_take(st->arena, sizeof *copy);
    *copy = *var;
    copy->next = NULL;
    return copy;
}

/** The variables of the base stand first, so that an instance begins as one of the base. */
static void inherit_vars(st_t *st, unit_t *unit)
{
    vars_t vars = {0};
    for (const var_t *var = unit->object.base->vars; var; var = var->next) {
        const bool is_kept = var->global && var->global->keeper; /* VAR_STAT */
        if (var->section == V_TEMP || (var->section == V_EXTERNAL && !is_kept))
            continue;
        var_t *copy = copy_of(st, var);
        ST_APPEND(vars, copy);
    }
    if (!vars.last)
        return;
    vars.last->next = unit->vars;
    unit->vars = vars.first;
    unit->type->members = unit->vars;
}

static void look_at_struct(const char *name, void *value, void *context)
{
    const type_t *type = value;
    if (type->kind == T_STRUCT)
        cm1e_near_look(context, name);
}

/** The type that a name means, also by the names of aliases; NULL: there is none. */
static type_t *named_type(st_t *st, const type_t *type, const char *name)
{
    type_t *found = cm1e_st_lookup(st, st->types, type->scope, type->place, name);
    for (int depth = 0; found && found->same && depth < ST_DEPTH; depth++)
        found = found->same->kind == T_NONE && !found->same->low
            ? cm1e_st_lookup(st, st->types, found->same->scope, found->same->place, found->same->name) : found->same;
    return found;
}

/** STRUCT EXTENDS: the members of the base stand first. */
static void extend_struct(st_t *st, type_t *type, int depth)
{
    const char *name = type->base_name;
    type_t *base = named_type(st, type, name);
    type->base_name = NULL;
    if (base && base->state == ST_BUSY) {
        cm1e_st_report(st, type->place, "\"%s\" extends itself", type->name);
        return;
    }
    const bool is_structure = base && base->kind == T_STRUCT && !base->overlay && !base->external;
    if (!is_structure || base == type || depth == ST_DEPTH) {
        cm1e_near_t near = {.word = name};
        cm1e_st_map_each(st->types, look_at_struct, &near);
        cm1e_st_report(st, type->place, "there is no structure \"%s\" that \"%s\" could extend%s", name, type->name,
                       base == type ? "" : cm1e_st_meant(st, &near));
        return;
    }
    type->state = ST_BUSY;
    if (base->base_name)
        extend_struct(st, base, depth + 1);
    type->state = ST_NEW;
    vars_t members = {0};
    for (const var_t *var = base->members; var; var = var->next) {
        var_t *copy = copy_of(st, var);
        ST_APPEND(members, copy);
    }
    if (!members.last)
        return;
    members.last->next = type->members;
    type->members = members.first;
}

static void map_methods(st_t *st, unit_t *unit)
{
    unit->object.names = cm1e_st_map_new(st->arena);
    for (unit_t *method = unit->object.methods; method; method = method->object.next_method) {
        if (cm1e_st_map_get(unit->object.names, method->name))
            cm1e_st_report(st, method->place, "\"%s\" has \"%s\" already", unit->name, method->name);
        cm1e_st_map_put(unit->object.names, method->name, method);
    }
}

static void link_unit(st_t *st, unit_t *unit)
{
    object_t *object = &unit->object;
    if (object->linked == 2 || unit->external)
        return;
    if (object->linked == 1) {
        cm1e_st_report(st, unit->place, "\"%s\" extends itself", unit->name);
        object->base = NULL;
        return;
    }
    object->linked = 1;
    map_methods(st, unit);
    for (arg_t *arg = object->interfaces; arg; arg = arg->next) {
        unit_t *interface = named_unit(st, unit, arg->name, U_INTERFACE, "interface");
        if (interface) {
            arg->name = interface->name; /* with its namespace: others find it by that */
            link_unit(st, interface);
        }
    }
    object->base = object->base_name ? named_unit(st, unit, object->base_name, U_BLOCK, "function block") : NULL;
    if (object->base) {
        if (object->base->object.final)
            cm1e_st_report(st, unit->place, "\"%s\" is FINAL: nothing can extend it", object->base->name);
        link_unit(st, object->base);
        if (object->base)
            inherit_vars(st, unit);
    }
    object->linked = 2;
}

void cm1e_st_link_objects(st_t *st)
{
    int classes = 0;
    for (type_t *type = st->tree.types; type; type = type->next)
        if (type->base_name)
            extend_struct(st, type, 0);
    for (unit_t *unit = st->tree.units; unit; unit = unit->next)
        if (unit->kind == U_BLOCK || unit->kind == U_PROGRAM || unit->kind == U_INTERFACE)
            link_unit(st, unit);
    for (unit_t *unit = st->tree.units; unit; unit = unit->next) {
        if (unit->kind != U_BLOCK || !(unit->object.base || unit->object.interfaces))
            continue;
        for (unit_t *at = unit; at && !at->object.has_class; at = at->object.base) {
            at->object.has_class = true;
            at->object.class_id = ++classes;
        }
    }
}

unit_t *cm1e_st_find_method(const unit_t *unit, const char *name)
{
    unit_t *found = NULL;
    for (const unit_t *at = unit; at && at->object.names && !found; at = at->object.base)
        found = cm1e_st_map_get(at->object.names, name);
    return found;
}

const char *cm1e_st_shown_name(st_t *st, const unit_t *unit)
{
    const char *plain = cm1e_st_plain_name(unit);
    if (plain != unit->name)
        plain = cm1e_st_format(st->arena, "%s.%.3s", plain, unit->name);
    return unit->object.owner ? cm1e_st_format(st->arena, "%s.%s", unit->object.owner->name, plain) : plain;
}

const char *cm1e_st_plain_name(const unit_t *method)
{
    return strncmp(method->name, "get ", 4) == 0 || strncmp(method->name, "set ", 4) == 0 ? method->name + 4
                                                                                          : method->name;
}

unit_t *cm1e_st_this(const st_t *st)
{
    if (!st->unit)
        return NULL;
    if (st->unit->object.owner)
        return st->unit->object.owner;
    return st->unit->kind == U_BLOCK || st->unit->kind == U_PROGRAM ? st->unit : NULL;
}

bool cm1e_st_is_a(const st_t *st, const unit_t *unit, const unit_t *other)
{
    for (const unit_t *at = unit; at; at = at->object.base) {
        if (at == other)
            return true;
        for (const arg_t *arg = at->object.interfaces; arg; arg = arg->next) {
            const unit_t *interface = cm1e_st_map_get(st->units, arg->name);
            if (interface && interface != at && cm1e_st_is_a(st, interface, other))
                return true;
        }
    }
    return false;
}

unit_t *cm1e_st_interface_method(const st_t *st, const unit_t *interface, const char *name)
{
    unit_t *found = cm1e_st_find_method(interface, name);
    for (const arg_t *arg = interface->object.interfaces; arg && !found; arg = arg->next) {
        const unit_t *base = cm1e_st_map_get(st->units, arg->name);
        found = base && base->kind == U_INTERFACE ? cm1e_st_interface_method(st, base, name) : NULL;
    }
    return found;
}

/* ---- conformance ------------------------------------------------------------------------------------------------- */

static const var_t *next_parameter(const var_t *var)
{
    while (var && !cm1e_st_is_parameter(var))
        var = var->next;
    return var;
}

static bool same_signature(st_t *st, const unit_t *a, const unit_t *b)
{
    const type_t *of_a = a->result_type ? cm1e_st_resolve(st, a->result_type) : NULL;
    const type_t *of_b = b->result_type ? cm1e_st_resolve(st, b->result_type) : NULL;
    const var_t *x = next_parameter(a->vars), *y = next_parameter(b->vars);
    for (; x && y; x = next_parameter(x->next), y = next_parameter(y->next))
        if (x->section != y->section || x->type != y->type)
            return false;
    return !x && !y && of_a == of_b;
}

static void check_override(st_t *st, const unit_t *method, const unit_t *of)
{
    const bool of_interface = of && of->object.owner->kind == U_INTERFACE;
    if (of && !of_interface && (of->object.final || of->object.access == M_PRIVATE))
        cm1e_st_report(st, method->place, "\"%s\" is %s in \"%s\": what extends it cannot have one of that name",
                       cm1e_st_plain_name(method), of->object.final ? "FINAL" : "PRIVATE", of->object.owner->name);
    if (of_interface && method->object.access & ~M_PUBLIC)
        cm1e_st_report(st, method->place, "\"%s\" is of the interface \"%s\", so it is PUBLIC",
                       cm1e_st_plain_name(method), of->object.owner->name);
    if (of && strcasecmp(method->name, "FB_Init") != 0 && !same_signature(st, method, of))
        cm1e_st_report(st, method->place, "\"%s\" has another result or other parameters than that of \"%s\"",
                       method->name, of->object.owner->name);
}

static void check_interface(st_t *st, const unit_t *unit, const unit_t *interface)
{
    for (const unit_t *method = interface->object.methods; method; method = method->object.next_method) {
        const unit_t *ours = cm1e_st_find_method(unit, method->name);
        if (!ours && !unit->object.abstract)
            cm1e_st_report(st, unit->place, "\"%s\" has no method \"%s\", which the interface \"%s\" wants", unit->name,
                           method->name, interface->name);
        else if (ours)
            check_override(st, ours, method);
    }
    for (const arg_t *arg = interface->object.interfaces; arg; arg = arg->next) {
        const unit_t *base = cm1e_st_map_get(st->units, arg->name);
        if (base && base->kind == U_INTERFACE && base != interface)
            check_interface(st, unit, base);
    }
}

/** The first method of its bases that a block without ABSTRACT leaves open. */
static void check_abstract(st_t *st, const unit_t *unit)
{
    for (const unit_t *at = unit; at; at = at->object.base)
        for (const unit_t *method = at->object.methods; method; method = method->object.next_method)
            if (cm1e_st_find_method(unit, method->name)->object.abstract)
                cm1e_st_report(st, unit->place, "\"%s\" needs its own method \"%s\", which is ABSTRACT in \"%s\"",
                               unit->name, method->name, at->name);
}

/** What implements an interface is called by it from anywhere. */
static void check_public(st_t *st, const unit_t *interface)
{
    for (const unit_t *method = interface->object.methods; method; method = method->object.next_method)
        if (method->object.final || method->object.access & ~M_PUBLIC)
            cm1e_st_report(st, method->place, "\"%s\" is of an interface: it is PUBLIC, and not FINAL",
                           cm1e_st_plain_name(method));
}

void cm1e_st_check_objects(st_t *st)
{
    for (unit_t *unit = st->tree.units; unit; unit = unit->next) {
        if (unit->kind == U_INTERFACE)
            check_public(st, unit);
        if (unit->kind != U_BLOCK || unit->external)
            continue;
        for (const unit_t *method = unit->object.methods; method; method = method->object.next_method)
            check_override(st, method, unit->object.base ? cm1e_st_find_method(unit->object.base, method->name) : NULL);
        for (const unit_t *at = unit; at; at = at->object.base)
            for (const arg_t *arg = at->object.interfaces; arg; arg = arg->next) {
                const unit_t *interface = cm1e_st_map_get(st->units, arg->name);
                if (interface && interface->kind == U_INTERFACE)
                    check_interface(st, unit, interface);
            }
        if (!unit->object.abstract)
            check_abstract(st, unit);
    }
}
