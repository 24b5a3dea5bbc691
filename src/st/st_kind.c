/* The elementary types: their names, their ranges, and what converts into what without loss. */
#include <float.h>
#include <math.h>
#include <strings.h>

#include "st/st_parsing.h"

enum { BITS = 1, SIGNED, UNSIGNED, FLOATING, TIMES };

static const struct { const char *name; int bits, class; } elementary[] = {
#define X(name, bits, class) [T_##name] = {#name, bits, class},
    ST_ELEMENTARY(X)
#undef X
    [T_ANY_INT] = {"an integer", 64, SIGNED}, [T_ANY_REAL] = {"a real number", 64, FLOATING},
    [T_NULL] = {"NULL", 64, 0}, [T_STRING] = {"STRING", 0, 0}, [T_WRONG] = {"?", 0, 0},
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
        *type = (type_t){.kind = kind, .name = name, .c_name = name, .state = ST_READY,
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

const char *cm1e_st_type_name(const type_t *type) 
{
    return type->shown ? type->shown : type->name ? type->name : "this type";
}

type_kind_t cm1e_st_plain_kind(const type_t *type) { return type->kind == T_ENUM ? type->element->kind : type->kind; }
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
