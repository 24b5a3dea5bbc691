/* Types: the elementary ones and what converts into what, and the meaning of names and aliases. */
#include <math.h>
#include <float.h>
#include <string.h>
#include <strings.h>

#include "core/near.h"
#include "st/st_parsing.h"

enum { BITS = 1, SIGNED, UNSIGNED, FLOATING, TIMES };
enum { NEW, BUSY, READY };
#define MAX_BYTES (UINT64_C(64) << 20) /* of one variable */

static const struct { const char *name; int bits, class; } elementary[] = {
#define X(name, bits, class) [T_##name] = {#name, bits, class},
    ST_ELEMENTARY(X)
#undef X
    [T_ANY_INT] = {"an integer", 64, SIGNED}, [T_ANY_REAL] = {"a real number", 64, FLOATING}, [T_NULL] = {"NULL", 64, 0},
    [T_STRING] = {"STRING", 0, 0}, [T_WRONG] = {"?", 0, 0},
};

static const struct { const char *name; type_kind_t kind; } other_names[] = {
    {"LTIME", T_TIME}, {"LDATE", T_DATE}, {"TIME_OF_DAY", T_TOD}, {"LTOD", T_TOD}, {"LTIME_OF_DAY", T_TOD},
    {"DATE_AND_TIME", T_DT}, {"LDT", T_DT}, {"LDATE_AND_TIME", T_DT},
};
enum { OTHER_NAMES = sizeof other_names / sizeof other_names[0] };

void cm1e_st_begin_types(st_t *st)
{
    for (type_kind_t kind = T_NONE; kind <= T_WRONG; kind++) {
        const char *name = elementary[kind].name ? elementary[kind].name : "no value";
        type_t *type = cm1e_st_take(st->arena, sizeof *type);
        *type = (type_t){.kind = kind, .name = name, .c_name = name, .state = READY,
                         .size = (uint64_t)elementary[kind].bits / 8, .alignment = (uint64_t)elementary[kind].bits / 8};
        st->elementary[kind] = type;
    }
}

type_t *cm1e_st_elementary(const st_t *st, const char *name)
{
    for (type_kind_t kind = T_BOOL; kind <= T_DT; kind++)
        if (strcasecmp(elementary[kind].name, name) == 0)
            return st->elementary[kind];
    for (size_t i = 0; i < OTHER_NAMES; i++)
        if (strcasecmp(other_names[i].name, name) == 0)
            return st->elementary[other_names[i].kind];
    return NULL;
}

int cm1e_st_bits(type_kind_t kind) { return elementary[kind].bits; }
static int class_of(type_kind_t kind) { return kind <= T_WRONG ? elementary[kind].class : 0; }
bool cm1e_st_is_signed(type_kind_t kind) { return class_of(kind) == SIGNED && kind != T_ANY_INT; }
bool cm1e_st_is_unsigned(type_kind_t kind) { return class_of(kind) == UNSIGNED; }
bool cm1e_st_is_bits(type_kind_t kind) { return class_of(kind) == BITS; }
bool cm1e_st_is_integer(type_kind_t kind) { return class_of(kind) == SIGNED || class_of(kind) == UNSIGNED; }
bool cm1e_st_is_floating(type_kind_t kind) { return class_of(kind) == FLOATING; }
bool cm1e_st_is_number(type_kind_t kind) { return cm1e_st_is_integer(kind) || cm1e_st_is_floating(kind); }
bool cm1e_st_is_time(type_kind_t kind) { return class_of(kind) == TIMES; }

bool cm1e_st_fits(type_kind_t kind, const constant_t *value)
{
    const int bits = cm1e_st_bits(kind);
    if (kind == T_BOOL)
        return !value->huge && (value->integer == 0 || value->integer == 1);
    if (cm1e_st_is_signed(kind))
        return !value->huge && (bits == 64 || (value->integer >= -(INT64_C(1) << (bits - 1)) &&
                                               value->integer < INT64_C(1) << (bits - 1)));
    if (cm1e_st_is_unsigned(kind) || cm1e_st_is_bits(kind))
        return bits == 64 ? value->huge || value->integer >= 0
                          : !value->huge && value->integer >= 0 && value->integer < INT64_C(1) << bits;
    if (kind == T_REAL)
        return fabs(value->real) <= FLT_MAX;
    return true;
}

int64_t cm1e_st_wrap(type_kind_t kind, int64_t value)
{
    const int bits = cm1e_st_bits(kind);
    if (kind == T_BOOL)
        return value & 1;
    if (bits == 64)
        return value;
    const uint64_t kept = (uint64_t)value & ((UINT64_C(1) << bits) - 1);
    const bool negative = cm1e_st_is_signed(kind) && (kept >> (bits - 1)) != 0;
    return (int64_t)(negative ? kept | ~((UINT64_C(1) << bits) - 1) : kept);
}

bool cm1e_st_widens(type_kind_t from, type_kind_t to)
{
    const int a = cm1e_st_bits(from), b = cm1e_st_bits(to);
    if (from == to)
        return true;
    if (from > T_DT || to > T_DT || cm1e_st_is_time(from) || cm1e_st_is_time(to))
        return false;
    if (from == T_BOOL || to == T_BOOL)
        return false;
    if (cm1e_st_is_floating(to)) /* the mantissa has 24 or 53 bits */
        return cm1e_st_is_floating(from) ? a <= b : cm1e_st_is_integer(from) && a <= b / 2;
    if (cm1e_st_is_floating(from))
        return false;
    if (cm1e_st_is_bits(to))
        return cm1e_st_is_bits(from) && a <= b;
    if (cm1e_st_is_signed(from))
        return cm1e_st_is_signed(to) && a <= b;
    return cm1e_st_is_signed(to) ? a < b : a <= b; /* from unsigned integers and bits */
}

type_kind_t cm1e_st_common(type_kind_t a, type_kind_t b)
{
    if (cm1e_st_widens(a, b))
        return b;
    if (cm1e_st_widens(b, a))
        return a;
    for (type_kind_t kind = T_BYTE; kind <= T_LREAL; kind++) /* smaller ones of a class stand first */
        if (cm1e_st_widens(a, kind) && cm1e_st_widens(b, kind))
            return kind;
    return T_NONE;
}

/* ---- made types: each once -------------------------------------------------------------------------------------- */

type_t *cm1e_st_string_type(st_t *st, int64_t length)
{
    for (type_t *type = st->made; type; type = type->next)
        if (type->kind == T_STRING && type->length == length)
            return type;
    type_t *type = cm1e_st_type_node(st, T_STRING, (place_t){0}, NULL);
    type->length = length;
    type->name = cm1e_st_format(st->arena, "STRING[%lld]", (long long)length);
    type->c_name = cm1e_st_format(st->arena, "STRING_%lld", (long long)length);
    type->state = READY;
    type->size = (uint64_t)length + 1;
    type->alignment = 1;
    type->next = st->made;
    return st->made = type;
}

type_t *cm1e_st_ref_type(st_t *st, type_t *to)
{
    for (type_t *type = st->made; type; type = type->next)
        if (type->kind == T_REF && type->element == to)
            return type;
    type_t *type = cm1e_st_type_node(st, T_REF, (place_t){0}, NULL);
    type->element = to;
    type->name = cm1e_st_format(st->arena, "REF_TO %s", to->name);
    type->state = READY;
    type->size = type->alignment = sizeof(void *);
    type->next = st->made;
    return st->made = type;
}

static bool same_dimensions(const type_t *a, const type_t *b)
{
    for (int i = 0; i < a->dimension_count; i++)
        if (a->dimensions[i].first != b->dimensions[i].first || a->dimensions[i].last != b->dimensions[i].last)
            return false;
    return a->dimension_count == b->dimension_count;
}

static void name_array(st_t *st, type_t *type)
{
    const char *bounds = "", *parts = "";
    for (int i = 0; i < type->dimension_count; i++) {
        const dimension_t *d = &type->dimensions[i];
        bounds = cm1e_st_format(st->arena, "%s%s%lld..%lld", bounds, i ? ", " : "", (long long)d->first,
                                (long long)d->last);
        parts = cm1e_st_format(st->arena, "%s_%s%lld_%s%lld", parts, d->first < 0 ? "m" : "",
                               (long long)(d->first < 0 ? -d->first : d->first), d->last < 0 ? "m" : "",
                               (long long)(d->last < 0 ? -d->last : d->last));
    }
    type->name = cm1e_st_format(st->arena, "ARRAY [%s] OF %s", bounds, type->element->name);
    const char *element = type->element->kind == T_REF ? "REF" : type->element->c_name;
    unsigned same = 0;
    for (const type_t *other = st->made; other; other = other->next)
        same += other->kind == T_ARRAY && type->element->kind == T_REF;
    type->c_name = type->element->kind == T_REF ? cm1e_st_format(st->arena, "ARRAY%s_OF_REF_%u", parts, same)
                                                : cm1e_st_format(st->arena, "ARRAY%s_OF_%s", parts, element);
}

/** Bounds, element and size of an array; the one with these that is there already. */
static type_t *resolve_array(st_t *st, type_t *type)
{
    uint64_t count = 1;
    type->element = cm1e_st_resolve(st, type->element);
    for (int i = 0; i < type->dimension_count; i++) {
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
    if (type->length_expr && !cm1e_st_integer_constant(st, type->length_expr, &length, "the length of a STRING"))
        return st->elementary[T_WRONG];
    if (length >= 1 && length <= ST_STRING_BYTES)
        return cm1e_st_string_type(st, length);
    cm1e_st_report(st, type->place, "a STRING has 1 to %d characters, not %lld", ST_STRING_BYTES, (long long)length);
    return st->elementary[T_WRONG];
}

/* ---- declared types --------------------------------------------------------------------------------------------- */

static void look_at(const char *name, void *value, void *context)
{
    (void)value;
    cm1e_near_look(context, name);
}

static type_t *unknown(st_t *st, type_t *type)
{
    char text[CM1E_NEAR_TEXT_BYTES];
    cm1e_near_t near = {.word = type->name};
    cm1e_st_map_each(st->types, look_at, &near);
    for (type_kind_t kind = T_BOOL; kind <= T_DT; kind++)
        cm1e_near_look(&near, elementary[kind].name);
    cm1e_near_look(&near, "STRING");
    cm1e_st_report(st, type->place, "there is no type \"%s\"%s", type->name, cm1e_near_text(&near, text, sizeof text));
    return st->elementary[T_WRONG];
}

/** Sizes and alignments of the members, in the order of declaration, as C lays them out. */
static void resolve_members(st_t *st, type_t *type)
{
    uint64_t size = 0, alignment = 1;
    for (var_t *var = type->members; var; var = var->next) {
        if (var->section == V_TEMP || var->section == V_EXTERNAL)
            continue;
        var->type = cm1e_st_resolve(st, var->type);
        const bool pointer = var->section == V_IN_OUT;
        const uint64_t align = pointer ? sizeof(void *) : var->type->alignment ? var->type->alignment : 1;
        const uint64_t bytes = pointer ? sizeof(void *) : var->type->size;
        size = (size + align - 1) / align * align + bytes;
        alignment = align > alignment ? align : alignment;
        if (size > MAX_BYTES) {
            cm1e_st_report(st, var->place, "\"%s\" becomes larger than %d MB", type->name, (int)(MAX_BYTES >> 20));
            size = 0;
        }
    }
    type->size = (size + alignment - 1) / alignment * alignment;
    type->alignment = alignment;
}

static void resolve_enum(st_t *st, type_t *type)
{
    int64_t next = 0;
    type_t *base = type->element ? cm1e_st_resolve(st, type->element) : st->elementary[T_DINT];
    if (!cm1e_st_is_integer(base->kind) && base->kind != T_WRONG)
        cm1e_st_report(st, type->place, "the values of an enumeration are integers, not %s", base->name);
    type->element = cm1e_st_is_integer(base->kind) ? base : st->elementary[T_DINT];
    for (var_t *var = type->members; var; var = var->next) {
        if (var->initial && !cm1e_st_integer_constant(st, var->initial, &next, "the value of an enumerator"))
            continue;
        var->value = (constant_t){.known = true, .integer = next};
        if (!cm1e_st_fits(type->element->kind, &var->value))
            cm1e_st_report(st, var->place, "%lld is not a value of %s", (long long)next, type->element->name);
        next = (int64_t)((uint64_t)next + 1);
    }
    type->size = type->element->size;
    type->alignment = type->element->alignment;
}

/** TYPE t : INT (0..100): the type with a range. */
static type_t *resolve_range(st_t *st, type_t *type, type_t *base)
{
    if (!cm1e_st_integer_constant(st, type->low, &type->first, "the lower limit of a range") ||
        !cm1e_st_integer_constant(st, type->high, &type->last, "the upper limit of a range"))
        return st->elementary[T_WRONG];
    const constant_t low = {.integer = type->first}, high = {.integer = type->last};
    if (!cm1e_st_is_integer(base->kind) || type->first > type->last || !cm1e_st_fits(base->kind, &low) ||
        !cm1e_st_fits(base->kind, &high))
        cm1e_st_report(st, type->place, "%lld..%lld is no range of %s", (long long)type->first, (long long)type->last,
                       base->name);
    cm1e_st_report(st, type->place, "a type with a range is not supported; use %s, and LIMIT where a value comes from "
                   "outside", base->name);
    return base;
}

static type_t *resolve_name(st_t *st, type_t *type)
{
    type_t *base = type->same ? type->same : cm1e_st_elementary(st, type->name);
    if (!base)
        base = cm1e_st_map_get(st->types, type->name);
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
        ? cm1e_st_map_get(st->types, type->element->name) : NULL;
    const bool is_open = named && (named->kind == T_STRUCT || named->kind == T_BLOCK);
    return cm1e_st_ref_type(st, is_open ? named : cm1e_st_resolve(st, type->element));
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
    case T_STRUCT: resolve_members(st, type); break;
    default: break;
    }
    st->unit = unit;
    return result;
}

type_t *cm1e_st_resolve(st_t *st, type_t *type)
{
    if (type->state == READY)
        return type->same ? type->same : type;
    if (type->state == BUSY || st->resolving == ST_DEPTH) {
        cm1e_st_report(st, type->place, "\"%s\" %s", type->name ? type->name : "this type",
                       type->state == BUSY ? "contains itself" : "is nested too deeply");
        return st->elementary[T_WRONG];
    }
    type->state = BUSY;
    st->resolving++;
    type_t *result = resolve_new(st, type);
    st->resolving--;
    type->state = READY;
    type->same = result == type ? NULL : result;
    return result;
}
