/* What the names of types, aliases, arrays and structures mean. */
#include <string.h>

#include "core/near.h"
#include "st/st_parsing.h"

#define MAX_BYTES (UINT64_C(64) << 20) /* of one variable */

static bool same_dimensions(const type_t *a, const type_t *b)
{
    for (int i = 0; i < a->dimension_count; i++)
        if (a->dimensions[i].first != b->dimensions[i].first || a->dimensions[i].last != b->dimensions[i].last)
            return false;
    return a->dimension_count == b->dimension_count && a->open == b->open;
}

static void name_array(st_t *st, type_t *type)
{
    const char *bounds = "", *parts = "";
    if (type->open) {
        type->name = cm1e_st_format(st->arena, "ARRAY [*%.*s] OF %s", 3 * (type->dimension_count - 1), ", *, *, *",
                                    cm1e_st_type_name(type->element));
        type->c_name = "st_open_t";
        return;
    }
    for (int i = 0; i < type->dimension_count; i++) {
        const dimension_t *d = &type->dimensions[i];
        bounds = cm1e_st_format(st->arena, "%s%s%lld..%lld", bounds, i ? ", " : "", (long long)d->first,
                                (long long)d->last);
        parts = cm1e_st_format(st->arena, "%s_%s%lld_%s%lld", parts, d->first < 0 ? "m" : "",
                               (long long)(d->first < 0 ? -d->first : d->first), d->last < 0 ? "m" : "",
                               (long long)(d->last < 0 ? -d->last : d->last));
    }
    type->name = cm1e_st_format(st->arena, "ARRAY [%s] OF %s", bounds, cm1e_st_type_name(type->element));
    /* C has no name for each. */
    const bool unnamed = type->element->kind == T_REF || type->element->kind == T_INTERFACE;
    unsigned same = 0;
    for (const type_t *other = st->made; other; other = other->next)
        same += other->kind == T_ARRAY && unnamed;
    type->c_name = unnamed ? cm1e_st_format(st->arena, "ARRAY%s_OF_REF_%u", parts, same)
                           : cm1e_st_format(st->arena, "ARRAY%s_OF_%s", parts, type->element->c_name);
}

/** Bounds, element and size of an array; the one with these that is there already. */
static type_t *resolve_array(st_t *st, type_t *type)
{
    uint64_t count = 1;
    type->element = cm1e_st_resolve(st, type->element);
    for (int i = 0; i < type->dimension_count && !type->open; i++) {
        dimension_t *d = &type->dimensions[i];
        if (!cm1e_st_integer_constant(st, d->low, &d->first, "the lower bound of an array") ||
            !cm1e_st_integer_constant(st, d->high, &d->last, "the upper bound of an array"))
            return st->elementary[T_WRONG];
        if (d->first > d->last || d->first < INT32_MIN || d->last > INT32_MAX) {
            cm1e_st_report(st, d->low->place, "the bounds %lld..%lld are no range of DINT values", (long long)d->first,
                           (long long)d->last);
            return st->elementary[T_WRONG];
        }
        count *= (uint64_t)(d->last - d->first + 1);
        if (count * type->element->size > MAX_BYTES) {
            cm1e_st_report(st, d->low->place, "this array is larger than %d MB", (int)(MAX_BYTES >> 20));
            return st->elementary[T_WRONG];
        }
    }
    if (type->element->kind == T_WRONG)
        return st->elementary[T_WRONG];
    for (type_t *other = st->made; other; other = other->next)
        if (other->kind == T_ARRAY && other->element == type->element && same_dimensions(other, type))
            return other;
    type->size = count * type->element->size;
    type->alignment = type->element->alignment;
    name_array(st, type);
    type->next = st->made;
    return st->made = type;
}

static type_t *resolve_string(st_t *st, type_t *type)
{
    int64_t length = 80;
    if (type->length_expr && !cm1e_st_integer_constant(st, type->length_expr, &length, "the length of a text"))
        return st->elementary[T_WRONG];
    if (length >= 1 && length <= ST_STRING_BYTES)
        return cm1e_st_text_type(st, length, type->wide);
    cm1e_st_report(st, type->place, "a text has 1 to %d characters, not %lld", ST_STRING_BYTES, (long long)length);
    return st->elementary[T_WRONG];
}

/* ---- declared types --------------------------------------------------------------------------------------------- */

static void look_at(const char *name, void *value, void *context)
{
    (void)value;
    cm1e_near_look(context, name);
}

/** A type of the standard that this translator has not. */
static bool is_missing(const char *name)
{
    return strcasecmp(name, "BIT") == 0 || strcasecmp(name, "CHAR") == 0 || strcasecmp(name, "WCHAR") == 0 ||
           strcasecmp(name, "ANY") == 0 || strncasecmp(name, "ANY_", 4) == 0;
}

static type_t *unknown(st_t *st, type_t *type)
{
    if (is_missing(type->name)) {
        cm1e_st_report(st, type->place, "the type %s is not supported by this translator", type->name);
        return st->elementary[T_WRONG];
    }
    char text[CM1E_NEAR_TEXT_BYTES];
    cm1e_near_t near = {.word = type->name};
    cm1e_st_map_each(st->types, look_at, &near);
    for (type_kind_t kind = T_BOOL; kind <= T_DT; kind++)
        cm1e_near_look(&near, st->elementary[kind]->name);
    cm1e_near_look(&near, "STRING");
    cm1e_st_report(st, type->place, "there is no type \"%s\"%s", type->name, cm1e_near_text(&near, text, sizeof text));
    return st->elementary[T_WRONG];
}

/** TYPE t : INT := 5: a variable without an initial value has that of its type, or of the type that this one is. */
void cm1e_st_inherit_initial(st_t *st, var_t *var)
{
    const type_t *type = var->type;
    const bool has_none = var->section == V_IN_OUT || var->section == V_EXTERNAL || var->section == V_ENUMERATOR;
    for (int depth = 0; type && !var->initial && !has_none && depth < ST_DEPTH; depth++) {
        if (type->kind != T_NONE)
            return;
        /* By its name also where it is resolved, as for the second one of "a, b : t": that leads past its initial
         * value. */
        const type_t *named = type->name ? cm1e_st_lookup(st, st->types, type->scope, type->place, type->name) : NULL;
        type = named && named != type ? named : type->same;
        if (type && type->initial && type->kind != T_ENUM)
            var->initial = type->initial;
    }
}

/** Whether any bits are a value of a type, so that it may be a member of a UNION. A structure of the library may be a
 *  reference, as AXIS_REF. */
static bool takes_any_bits(const type_t *type)
{
    if (type->kind == T_ARRAY)
        return takes_any_bits(type->element);
    if (type->kind == T_STRUCT && type->external)
        return false;
    for (const var_t *var = type->kind == T_STRUCT ? type->members : NULL; var; var = var->next)
        if (var->initial || !takes_any_bits(var->type))
            return false;
    const bool number = cm1e_st_is_bits(type->kind) || cm1e_st_is_number(type->kind);
    return type->kind == T_STRUCT || type->kind == T_TIME || type->kind == T_DT ||
           (number && type->kind != T_BOOL && !type->ranged);
}

static void resolve_union(st_t *st, type_t *type)
{
    type->size = type->alignment = 1;
    for (var_t *var = type->members; var; var = var->next) {
        cm1e_st_inherit_initial(st, var);
        var->type = cm1e_st_resolve(st, var->type);
        if (var->type->kind != T_WRONG && (var->initial || !takes_any_bits(var->type)))
            cm1e_st_report(st, var->place, "a UNION has numbers, BYTE ... LWORD, TIME and DT, and arrays and "
                           "structures of these, without initial values: not all bits are a value of %s",
                           var->initial ? "this" : cm1e_st_type_name(var->type));
        const uint64_t align = var->type->alignment ? var->type->alignment : 1;
        type->alignment = align > type->alignment ? align : type->alignment;
        type->size = var->type->size > type->size ? var->type->size : type->size;
    }
    type->size = (type->size + type->alignment - 1) / type->alignment * type->alignment;
}

/** Sizes and alignments of the members, in the order of declaration, as C lays them out. */
static void resolve_members(st_t *st, type_t *type)
{
    const bool has_class = type->kind == T_BLOCK && type->unit->object.has_class;
    uint64_t size = has_class ? sizeof(uint32_t) : 0, alignment = has_class ? sizeof(uint32_t) : 1;
    for (var_t *var = type->members; var; var = var->next) {
        if (var->section == V_TEMP || var->section == V_EXTERNAL)
            continue;
        cm1e_st_inherit_initial(st, var);
        var->type = cm1e_st_resolve(st, var->type);
        const bool pointer = var->section == V_IN_OUT;
        const uint64_t align = pointer ? sizeof(void *) : var->type->alignment ? var->type->alignment : 1;
        const uint64_t bytes = pointer ? sizeof(void *) : var->type->size;
        size = (size + align - 1) / align * align + bytes + (var->qualifiers & Q_EDGE ? 2 : 0); /* st_emit_type.c */
        alignment = align > alignment ? align : alignment;
        if (size > MAX_BYTES) {
            cm1e_st_report(st, var->place, "\"%s\" becomes larger than %d MB", type->name, (int)(MAX_BYTES >> 20));
            size = 0;
        }
    }
    size = size ? size : 1; /* C has no empty struct */
    type->size = (size + alignment - 1) / alignment * alignment;
    type->alignment = alignment;
}

/** Without a stated base it is INT, as in TwinCAT and CODESYS, or DINT if INT lacks a value. */
static void resolve_enum(st_t *st, type_t *type)
{
    int64_t next = 0;
    const bool stated = type->element;
    type_t *base = stated ? cm1e_st_resolve(st, type->element) : st->elementary[type->external ? T_DINT : T_INT];
    const bool good = cm1e_st_is_integer(base->kind) || (cm1e_st_is_bits(base->kind) && base->kind != T_BOOL);
    if (!good && base->kind != T_WRONG)
        cm1e_st_report(st, type->place, "the values of an enumeration are integers or BYTE ... LWORD, not %s",
                       cm1e_st_type_name(base));
    type->element = good ? base : st->elementary[T_DINT];
    for (var_t *var = type->members; var; var = var->next) {
        if (var->initial && !cm1e_st_integer_constant(st, var->initial, &next, "the value of an enumerator"))
            continue;
        var->value = (constant_t){.known = true, .integer = next};
        if (!stated && !cm1e_st_fits(type->element->kind, &var->value))
            type->element = st->elementary[T_DINT];
        if (!cm1e_st_fits(type->element->kind, &var->value))
            cm1e_st_report(st, var->place, "%lld is not a value of %s", (long long)next, type->element->name);
        next = (int64_t)((uint64_t)next + 1);
    }
    type->size = type->element->size;
    type->alignment = type->element->alignment;
}

/** INT (0..100) */
static type_t *resolve_range(st_t *st, type_t *type, type_t *base)
{
    int64_t first, last;
    if (!cm1e_st_integer_constant(st, type->low, &first, "the lower limit of a range") ||
        !cm1e_st_integer_constant(st, type->high, &last, "the upper limit of a range") || base->kind == T_WRONG)
        return st->elementary[T_WRONG];
    const constant_t low = {.integer = first}, high = {.integer = last};
    if (cm1e_st_is_integer(base->kind) && !base->ranged && first <= last && cm1e_st_fits(base->kind, &low) &&
        cm1e_st_fits(base->kind, &high))
        return cm1e_st_range_type(st, base, first, last);
    cm1e_st_report(st, type->place, "%lld..%lld is no range of %s: a range has two values of a type of integers, the "
                   "lower one first", (long long)first, (long long)last, cm1e_st_type_name(base));
    return st->elementary[T_WRONG];
}

static type_t *resolve_name(st_t *st, type_t *type)
{
    type_t *base = type->same ? type->same : cm1e_st_elementary(st, type->name);
    if (!base)
        base = cm1e_st_lookup(st, st->types, type->scope, type->place, type->name);
    if (base && base->name && strcmp(base->name, type->name ? type->name : base->name) != 0) {
        type_t *exact = cm1e_st_map_get(st->types, cm1e_st_format(st->arena, "%s'", type->name));
        base = exact ? exact : base;
    }
    base = base && base != type ? cm1e_st_resolve(st, base) : unknown(st, type);
    return type->low ? resolve_range(st, type, base) : base;
}

/** A reference to a structure or a block does not need its size: the structure may have a reference to itself. */
static type_t *resolve_reference(st_t *st, type_t *type)
{
    type_t *named = type->element->kind == T_NONE && type->element->name
        ? cm1e_st_lookup(st, st->types, type->element->scope, type->element->place, type->element->name) : NULL;
    const bool is_open = named && (named->kind == T_STRUCT || named->kind == T_BLOCK);
    return cm1e_st_any_ref_type(st, is_open ? named : cm1e_st_resolve(st, type->element), type->automatic);
}

static type_t *resolve_new(st_t *st, type_t *type)
{
    unit_t *const unit = st->unit;
    type_t *result = type;
    switch (type->kind) {
    case T_NONE: result = resolve_name(st, type); break;
    case T_STRING: result = resolve_string(st, type); break;
    case T_ARRAY: result = resolve_array(st, type); break;
    case T_REF: result = resolve_reference(st, type); break;
    case T_ENUM: resolve_enum(st, type); break;
    case T_BLOCK: st->unit = type->unit; resolve_members(st, type); break;
    case T_STRUCT: (type->overlay ? resolve_union : resolve_members)(st, type); break;
    default: break;
    }
    st->unit = unit;
    return result;
}

type_t *cm1e_st_resolve(st_t *st, type_t *type)
{
    if (type->state == ST_READY)
        return type->same ? type->same : type;
    if (type->state == ST_BUSY || st->resolving == ST_DEPTH) {
        cm1e_st_report(st, type->place, "\"%s\" %s", type->name ? type->name : "this type",
                       type->state == ST_BUSY ? "contains itself" : "is nested too deeply");
        return st->elementary[T_WRONG];
    }
    type->state = ST_BUSY;
    st->resolving++;
    type_t *result = resolve_new(st, type);
    st->resolving--;
    type->state = ST_READY;
    type->same = result == type ? NULL : result;
    return result;
}
