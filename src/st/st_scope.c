/* Namespaces (IEC 61131-3, 3rd edition): what is declared in one has its full name, "Machines.Axes.Speed". A name is
 * looked for from the inside to the outside. */
#include <string.h>
#include <strings.h>

#include "st/st_parsing.h"

/* ---- reading ----------------------------------------------------------------------------------------------------- */

const char *cm1e_st_full_name(st_t *st, const char *name)
{
    const char *space = st->scope ? st->scope->space : "";
    return *space ? cm1e_st_format(st->arena, "%s.%s", space, name) : name;
}

void cm1e_st_begin_namespace(st_t *st, place_t place, const char *name)
{
    scope_t *scope = cm1e_st_take(st->arena, sizeof *scope);
    *scope = (scope_t){.space = cm1e_st_full_name(st, name), .outer = st->scope};
    st->scope = scope;
    char *part = cm1e_st_copy(st->arena, scope->space, strlen(scope->space));
    for (char *dot = strchr(part, '.'); dot; dot = strchr(dot + 1, '.')) { /* a.b has a too */
        *dot = '\0';
        cm1e_st_map_put(st->spaces, cm1e_st_copy(st->arena, part, strlen(part)), scope);
        *dot = '.';
    }
    cm1e_st_map_put(st->spaces, part, scope);
    if (strlen(scope->space) > 200)
        cm1e_st_report(st, place, "the name of this namespace is too long");
}

void cm1e_st_end_namespace(st_t *st) { st->scope = st->scope->outer; }

void cm1e_st_use_namespace(st_t *st, place_t place, const char *name)
{
    struct used *made = cm1e_st_take(st->arena, sizeof *made);
    *made = (struct used){.space = name, .place = place, .next = st->scope->used};
    st->scope->used = made;
    cm1e_st_map_put(st->used, cm1e_st_format(st->arena, "%u:%u:%u", place.file, place.line, place.column), made);
}

static void check_one(const char *name, void *value, void *context)
{
    const struct used *used = value;
    st_t *st = context;
    (void)name;
    if (!cm1e_st_map_get(st->spaces, used->space))
        cm1e_st_report(st, used->place, "there is no NAMESPACE \"%s\"", used->space);
}

void cm1e_st_check_used(st_t *st) { cm1e_st_map_each(st->used, check_one, st); }

bool cm1e_st_same_namespace(const scope_t *scope, const scope_t *of)
{
    const char *space = of ? of->space : "";
    const scope_t *at = scope;
    while (*space && at && strcasecmp(at->space, space) != 0)
        at = at->outer;
    return !*space || at;
}

/* ---- names ------------------------------------------------------------------------------------------------------- */

static void *in_space(st_t *st, const map_t *map, const char *space, const char *name)
{
    return *space ? cm1e_st_map_get(map, cm1e_st_format(st->arena, "%s.%s", space, name)) : NULL;
}

void *cm1e_st_lookup(st_t *st, const map_t *map, const scope_t *scope, place_t place, const char *name)
{
    void *found = NULL;
    for (; scope && !found; scope = scope->outer) {
        /* NAMESPACE a.b is within a. */
        const char *space = scope->space;
        for (const char *dot = space + strlen(space); *space && !found;) {
            found = in_space(st, map, cm1e_st_copy(st->arena, space, (size_t)(dot - space)), name);
            while (dot > space && *--dot != '.')
                continue;
            if (dot == space)
                break;
        }
        for (const struct used *used = scope->used; used && !found; used = used->next) {
            found = in_space(st, map, used->space, name);
            for (const struct used *other = used->next; found && other; other = other->next) {
                void *second = strcasecmp(other->space, used->space) != 0 ? in_space(st, map, other->space, name)
                                                                          : NULL;
                if (second)
                    cm1e_st_report(st, place, "\"%s\" is in %s and in %s: write the namespace in front of it", name,
                                   other->space, used->space);
            }
        }
    }
    return found ? found : cm1e_st_map_get(map, name);
}

const char *cm1e_st_dotted(st_t *st, const expr_t *expr)
{
    if (expr->kind == E_NAME)
        return expr->name;
    const char *before = expr->kind == E_MEMBER && !expr->bit ? cm1e_st_dotted(st, expr->a) : NULL;
    return before ? cm1e_st_format(st->arena, "%s.%s", before, expr->name) : NULL;
}

const char *cm1e_st_c_name(st_t *st, const char *name)
{
    while (strchr(name, '.')) {
        const char *dot = strchr(name, '.');
        name = cm1e_st_format(st->arena, "%.*s__%s", (int)(dot - name), name, dot + 1);
    }
    return name;
}
