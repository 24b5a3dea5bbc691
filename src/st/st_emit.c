/* The C file of a program: the run-time part, types, variables, units, tables. */
#include "st/st_emit.h"

#include <string.h>

#include "st/st_embedded.h"

static void emit_embedded(st_t *st, const char *name, const char *begin, const char *end)
{
    cm1e_st_put(st, "#line 1 \"%s\"\n", name);
    fwrite(begin, 1, (size_t)(end - begin), st->out);
}

/** What follows comes from no source. */
static void begin_own(st_t *st, const char *name)
{
    cm1e_st_put(st, "#line 1 ");
    cm1e_st_put_quoted(st, cm1e_st_format(st->arena, "%s.c", name));
    cm1e_st_put(st, "\n");
}

static void emit_functions(st_t *st, bool bodies)
{
    for (unit_t *unit = st->tree.units; unit; unit = unit->next) {
        const bool unused = st->sources[unit->place.file].library && !(unit->type && unit->type->emitted);
        const bool declared_only = unit->kind == U_INTERFACE ||
            (unit->kind == U_METHOD && (unit->object.abstract || unit->object.owner->kind == U_INTERFACE));
        if (unit->external || unused)
            continue;
        if (!bodies && !declared_only)
            cm1e_st_emit_prototype(st, unit);
        if (!bodies) /* a call over an interface or an ABSTRACT block leaves inputs out, too */
            cm1e_st_emit_default_functions(st, unit);
        else if (!declared_only)
            cm1e_st_emit_unit(st, unit);
    }
}

static void emit_types(st_t *st)
{
    for (unit_t *unit = st->tree.units; unit; unit = unit->next) {
        if (unit->external || st->sources[unit->place.file].library)
            continue;
        if (unit->type)
            cm1e_st_emit_type(st, unit->type);
        for (var_t *var = unit->vars; var; var = var->next)
            cm1e_st_emit_type(st, var->type);
    }
    for (var_t *var = st->tree.globals; var; var = var->next)
        if (!st->sources[var->place.file].external)
            cm1e_st_emit_type(st, var->type);
}

static void emit_variables(st_t *st)
{
    if (st->memory > 0)
        cm1e_st_line(st, "static _Alignas(8) BYTE st_memory[%llu];\n", (unsigned long long)st->memory);
    for (const var_t *var = st->tree.globals; var; var = var->next)
        if (!st->sources[var->place.file].external && !var->in_memory)
            cm1e_st_line(st, "static %s %s ST_UNUSED;\n", cm1e_st_c_type(st, var->type), var->c_name);
    for (const instance_t *instance = st->tree.instances; instance; instance = instance->next)
        cm1e_st_line(st, "static %s I_%s;\n", instance->unit->c_type, instance->name);
}

void cm1e_st_emit(st_t *st, FILE *file, const char *name)
{
    st->out = file;
    st->unit = NULL;
    cm1e_st_put(st, "/* Translated from Structured Text by cm1e st build. Compile with -std=c11 -fwrapv -fPIC "
                "-shared. */\n");
    emit_embedded(st, "st_program.h", cm1e_st_program_begin, cm1e_st_program_end);
    emit_embedded(st, "st_runtime.h", cm1e_st_runtime_begin, cm1e_st_runtime_end);
    cm1e_st_put(st, "\n");
    begin_own(st, name);
    cm1e_st_put(st, "/* ---- types ---- */\n\n");
    emit_types(st);
    cm1e_st_put(st, "\n/* ---- variables ---- */\n\n");
    emit_variables(st);
    emit_functions(st, false);
    cm1e_st_emit_dispatchers(st, false);
    cm1e_st_emit_dispatchers(st, true);
    cm1e_st_emit_init_functions(st);
    emit_functions(st, true);
    st->unit = NULL;
    begin_own(st, name);
    cm1e_st_emit_tables(st, name);
}
