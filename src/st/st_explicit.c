/* Explicit conversions: INT_TO_REAL(x), TO_REAL(x). What they do is told in docs/STRUCTURED-TEXT.md. */
#include <string.h>
#include <strings.h>

#include "st/st_parsing.h"
#include "st/st_standard.h"

static type_t *named(st_t *st, const char *name)
{
    const bool wide = strcasecmp(name, "WSTRING") == 0;
    return wide || strcasecmp(name, "STRING") == 0 ? cm1e_st_text_type(st, ST_STRING_BYTES, wide)
                                                   : cm1e_st_elementary(st, name);
}

/** Whether there is a conversion at all. */
static bool is_possible(type_kind_t from, type_kind_t to)
{
    const bool from_number = cm1e_st_is_number(from), to_number = cm1e_st_is_number(to);
    if (from == to)
        return true;
    if (from == T_STRING || to == T_STRING)
        return from == T_STRING ? to_number || cm1e_st_is_bits(to) || to == T_TIME : from <= T_DT;
    if (cm1e_st_is_time(from) || cm1e_st_is_time(to)) {
        const type_kind_t other = cm1e_st_is_time(from) ? to : from;
        if (cm1e_st_is_integer(other) || (cm1e_st_is_bits(other) && other != T_BOOL))
            return true;
        if (from == T_TIME || to == T_TIME)
            return from_number || to_number || cm1e_st_is_bits(from) || cm1e_st_is_bits(to);
        return (from == T_DT && (to == T_DATE || to == T_TOD)) || (from == T_DATE && to == T_DT);
    }
    if (cm1e_st_is_floating(from) || cm1e_st_is_floating(to)) {
        const type_kind_t other = cm1e_st_is_floating(from) ? to : from;
        return !cm1e_st_is_bits(other) || other == T_BOOL;
    }
    return from <= T_LREAL && to <= T_LREAL;
}

static void convert(st_t *st, expr_t *call, type_t *from, type_t *to)
{
    arg_t *arg = call->args;
    if (!arg || arg->next || arg->output || !arg->value) {
        cm1e_st_report(st, call->place, "%s takes one argument", call->a->name);
        call->type = st->elementary[T_WRONG];
        return;
    }
    cm1e_st_expression(st, arg->value);
    expr_t *value = from ? cm1e_st_coerce(st, arg->value, from, "the argument") : cm1e_st_settle(st, arg->value);
    const type_kind_t kind = cm1e_st_plain_kind(value->type);
    if (kind != T_WRONG && !is_possible(kind, to->kind)) {
        cm1e_st_report(st, call->place, "there is no conversion of %s to %s", cm1e_st_type_name(value->type), to->name);
        value->type = st->elementary[T_WRONG];
    }
    *call = (expr_t){.kind = E_CONVERT, .place = call->place, .depth = call->depth, .a = value, .impure = value->impure,
                     .type = value->type->kind == T_WRONG ? value->type : to, .explicitly = true};
}

bool cm1e_st_conversion_call(st_t *st, expr_t *call, const char *name)
{
    type_t *from = NULL;
    const char *to = strncasecmp(name, "TO_", 3) == 0 ? name + 3 : NULL;
    for (const char *at = name; !to && *at; at++) {
        if (strncasecmp(at, "_TO_", 4) != 0)
            continue;
        from = named(st, cm1e_st_copy(st->arena, name, (size_t)(at - name)));
        to = from ? at + 4 : NULL;
        break;
    }
    type_t *target = to ? named(st, to) : NULL;
    if (!target)
        return false;
    convert(st, call, from, target);
    return true;
}
