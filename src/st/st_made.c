/* Types without a declaration: texts and references, each once. */
#include "st/st_parsing.h"

type_t *cm1e_st_text_type(st_t *st, int64_t length, bool wide)
{
    const char *word = wide ? "WSTRING" : "STRING";
    for (type_t *type = st->made; type; type = type->next)
        if (type->kind == T_STRING && type->length == length && type->wide == wide)
            return type;
    type_t *type = cm1e_st_type_node(st, T_STRING, (place_t){0}, NULL);
    type->length = length;
    type->wide = wide;
    type->name = cm1e_st_format(st->arena, "%s[%lld]", word, (long long)length);
    type->c_name = cm1e_st_format(st->arena, "%s_%lld", word, (long long)length);
    type->state = ST_READY;
    type->alignment = wide ? 2 : 1;
    type->size = ((uint64_t)length + 1) * type->alignment;
    type->next = st->made;
    return st->made = type;
}

type_t *cm1e_st_range_type(st_t *st, const type_t *base, int64_t first, int64_t last)
{
    for (type_t *type = st->made; type; type = type->next)
        if (type->ranged && type->kind == base->kind && type->first == first && type->last == last)
            return type;
    type_t *type = cm1e_st_type_node(st, base->kind, (place_t){0}, base->name);
    const uint64_t low = first < 0 ? 0 - (uint64_t)first : (uint64_t)first;
    const uint64_t high = last < 0 ? 0 - (uint64_t)last : (uint64_t)last;
    type->ranged = true;
    type->first = first;
    type->last = last;
    type->shown = cm1e_st_format(st->arena, "%s (%lld..%lld)", base->name, (long long)first, (long long)last);
    type->c_name = cm1e_st_format(st->arena, "%s_%s%llu_%s%llu", base->name, first < 0 ? "m" : "",
                                  (unsigned long long)low, last < 0 ? "m" : "", (unsigned long long)high);
    type->state = ST_READY;
    type->size = base->size;
    type->alignment = base->alignment;
    type->next = st->made;
    return st->made = type;
}

type_t *cm1e_st_ref_type(st_t *st, type_t *to) { return cm1e_st_any_ref_type(st, to, false); }

type_t *cm1e_st_any_ref_type(st_t *st, type_t *to, bool automatic)
{
    for (type_t *type = st->made; type; type = type->next)
        if (type->kind == T_REF && type->element == to && type->automatic == automatic)
            return type;
    type_t *type = cm1e_st_type_node(st, T_REF, (place_t){0}, NULL);
    type->element = to;
    type->automatic = automatic;
    type->name = cm1e_st_format(st->arena, automatic ? "REFERENCE TO %s" : "REF_TO %s",
                                cm1e_st_type_name(to));
    type->state = ST_READY;
    type->size = type->alignment = sizeof(void *);
    type->next = st->made;
    return st->made = type;
}
