/* Types without a declaration: texts and references, each once. */
#include "st/st_parsing.h"

type_t *cm1e_st_string_type(st_t *st, int64_t length)
{
    for (type_t *type = st->made; type; type = type->next)
        if (type->kind == T_STRING && type->length == length)
            return type;
    type_t *type = cm1e_st_type_node(st, T_STRING, (place_t){0}, NULL);
    type->length = length;
    type->name = cm1e_st_format(st->arena, "STRING[%lld]", (long long)length);
    type->c_name = cm1e_st_format(st->arena, "STRING_%lld", (long long)length);
    type->state = ST_READY;
    type->size = (uint64_t)length + 1;
    type->alignment = 1;
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
    type->name = cm1e_st_format(st->arena, automatic ? "REFERENCE TO %s" : "REF_TO %s", to->name);
    type->state = ST_READY;
    type->size = type->alignment = sizeof(void *);
    type->next = st->made;
    return st->made = type;
}
