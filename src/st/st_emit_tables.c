/* Tasks, and the tables by which others find the variables of a program. */
#include "st/st_emit.h"

#include <inttypes.h>
#include <string.h>

enum { VARIABLES = 4096, ELEMENTS = 64, NAME_BYTES = 79 };

typedef enum table { TABLE_VARIABLES, TABLE_AXES, TABLE_GROUPS, TABLE_LOCATED, TABLE_RETAINED, TABLES } table_t;

static const char *const tables[TABLES] = {"variables", "axes", "groups", "located", "retained"};

typedef struct listing {
    st_t *st;
    table_t table;
    unsigned count;
    uint64_t layout; /* hash of names, types and sizes */
} listing_t;

static const char *kind_of(const type_t *type)
{
    switch (type->kind == T_ENUM ? type->element->kind : type->kind) {
    case T_BOOL: return "BOOL";
    case T_SINT: return "SINT";
    case T_INT: return "INT";
    case T_DINT: return "DINT";
    case T_LINT: return "LINT";
    case T_BYTE:
    case T_USINT: return "USINT";
    case T_WORD:
    case T_UINT: return "UINT";
    case T_DWORD:
    case T_UDINT: return "UDINT";
    case T_LWORD:
    case T_ULINT: return "ULINT";
    case T_REAL: return "REAL";
    case T_LREAL: return "LREAL";
    case T_TIME: return "TIME";
    case T_STRING: return "STRING";
    default: return "OTHER";
    }
}

static void note_layout(listing_t *l, const char *text)
{
    for (; *text; text++)
        l->layout = (l->layout ^ (unsigned char)*text) * UINT64_C(1099511628211);
}

static void row(listing_t *l, const char *name, const char *c_name, const type_t *type, const char *detail)
{
    l->count++;
    cm1e_st_put(l->st, "    {");
    cm1e_st_put_quoted(l->st, name);
    cm1e_st_put(l->st, ", &%s, sizeof %s, ST_KIND_%s, ", c_name, c_name, kind_of(type));
    cm1e_st_put_quoted(l->st, detail);
    cm1e_st_put(l->st, "},\n");
    note_layout(l, cm1e_st_format(l->st->arena, "%s:%s:%llu;", name, type->name, (unsigned long long)type->size));
}

/** All elementary parts of a variable, by name. */
static void list_values(listing_t *l, const char *name, const char *c_name, const type_t *type)
{
    arena_t *arena = l->st->arena;
    const bool handle = type->kind == T_STRUCT && type->external && type->members && !type->members->next &&
        strcmp(type->members->name, "Handle") == 0; /* of an axis or a group: a number that says nothing */
    if (l->count >= VARIABLES || strlen(name) > NAME_BYTES || handle)
        return;
    if (type->kind <= T_LREAL || type->kind == T_TIME || type->kind == T_ENUM || type->kind == T_STRING) {
        row(l, name, c_name, type, type->name);
    } else if (type->kind == T_ARRAY && type->dimension_count == 1) {
        const dimension_t *d = &type->dimensions[0];
        for (int64_t i = d->first; i <= d->last && i < d->first + ELEMENTS; i++)
            list_values(l, cm1e_st_format(arena, "%s[%lld]", name, (long long)i),
                        cm1e_st_format(arena, "%s.at[%lld]", c_name, (long long)(i - d->first)), type->element);
    } else if (type->kind == T_STRUCT || type->kind == T_BLOCK) {
        for (const var_t *var = type->members; var; var = var->next) {
            const bool inner = type->external && type->kind == T_BLOCK && var->section == V_LOCAL;
            if (inner || var->section == V_TEMP || var->section == V_EXTERNAL || var->section == V_IN_OUT)
                continue;
            list_values(l, cm1e_st_format(arena, "%s.%s", name, var->name),
                        cm1e_st_format(arena, "%s.%s", c_name, var->c_name), var->type);
        }
    }
}

/** What a table says of a variable of a program, or of a global one. */
static void list_variable(listing_t *l, const char *name, const char *c_name, const var_t *var)
{
    const type_t *type = var->type;
    const bool named = type->kind == T_STRUCT && type->external;
    switch (l->table) {
    case TABLE_VARIABLES:
        if (!(var->qualifiers & Q_CONSTANT))
            list_values(l, name, c_name, type);
        break;
    case TABLE_AXES:
        if (named && strcmp(type->name, "AXIS_REF") == 0)
            row(l, var->name, c_name, type, name);
        break;
    case TABLE_GROUPS:
        if (named && strcmp(type->name, "AXES_GROUP_REF") == 0)
            row(l, var->name, c_name, type, name);
        break;
    case TABLE_LOCATED:
        if (var->address)
            row(l, name, c_name, type, var->address->name);
        break;
    default:
        if (var->qualifiers & Q_RETAIN)
            row(l, name, c_name, type, type->name);
        break;
    }
}

static uint64_t emit_table(st_t *st, table_t table)
{
    listing_t l = {.st = st, .table = table, .layout = UINT64_C(14695981039346656037)};
    cm1e_st_put(st, "static const st_variable_t st_%s[] = {\n", tables[table]);
    for (const var_t *var = st->tree.globals; var; var = var->next)
        if (!st->sources[var->place.file].external)
            list_variable(&l, var->list ? cm1e_st_format(st->arena, "%s.%s", var->list, var->name) : var->name, var->c_name,
                          var);
    for (const instance_t *instance = st->tree.instances; instance; instance = instance->next)
        for (const var_t *var = instance->unit->vars; var; var = var->next)
            if (var->section == V_LOCAL || var->section == V_INPUT || var->section == V_OUTPUT)
                list_variable(&l, cm1e_st_format(st->arena, "%s.%s", instance->name, var->name),
                              cm1e_st_format(st->arena, "I_%s.%s", instance->name, var->c_name), var);
    cm1e_st_put(st, "    {0, 0, 0, ST_KIND_OTHER, 0}\n};\n");
    cm1e_st_put(st, "enum { ST_COUNT_%s = %u };\n", tables[table], l.count);
    return l.layout;
}

/* ---- tasks ------------------------------------------------------------------------------------------------------- */

static void emit_program(st_t *st, const instance_t *instance)
{
    for (const arg_t *arg = instance->args; arg; arg = arg->next) {
        if (arg->output)
            continue;
        cm1e_st_line(st, "I_%s.%s = ", instance->name, arg->parameter->c_name);
        cm1e_st_emit_expression(st, arg->value);
        cm1e_st_put(st, ";\n");
    }
    cm1e_st_line(st, "%s(&I_%s);\n", instance->unit->c_name, instance->name);
    for (const arg_t *arg = instance->args; arg; arg = arg->next) {
        if (!arg->output)
            continue;
        cm1e_st_begin_line(st);
        cm1e_st_emit_expression(st, arg->value);
        cm1e_st_put(st, " = I_%s.%s;\n", instance->name, arg->parameter->c_name);
    }
}

/** The function of a task: all its programs; of `alone`, a program without a task. */
static void emit_task(st_t *st, const char *name, const task_t *task, const instance_t *alone)
{
    cm1e_st_put(st, "static void task_%s(void)\n{\n", name);
    st->indent = 1;
    cm1e_st_line(st, "if (st_fault.happened || setjmp(st_leave) != 0)\n        return;\n");
    cm1e_st_line(st, "st_loops_left = st_loop_limit;\n");
    for (const instance_t *instance = st->tree.instances; instance; instance = instance->next)
        if (alone ? instance == alone : instance->task == task)
            emit_program(st, instance);
    st->indent = 0;
    cm1e_st_put(st, "}\n");
}

static void emit_tasks(st_t *st)
{
    unsigned count = 0;
    for (const task_t *task = st->tree.tasks; task; task = task->next)
        emit_task(st, task->name, task, NULL);
    for (const instance_t *instance = st->tree.instances; instance; instance = instance->next)
        if (!instance->task)
            emit_task(st, cm1e_st_format(st->arena, "of_%s", instance->name), NULL, instance);
    cm1e_st_put(st, "static const st_task_t st_tasks[] = {\n");
    for (const task_t *task = st->tree.tasks; task; task = task->next, count++)
        cm1e_st_put(st, "    {\"%s\", INT64_C(%" PRId64 "), %" PRId64 ", task_%s},\n", task->name, task->interval_ns,
                    task->priority, task->name);
    for (const instance_t *instance = st->tree.instances; instance; instance = instance->next)
        if (!instance->task) {
            cm1e_st_put(st, "    {\"%s\", 0, 65535, task_of_%s},\n", instance->name, instance->name);
            count++;
        }
    cm1e_st_put(st, "    {0, 0, 0, 0}\n};\nenum { ST_COUNT_tasks = %u };\n", count);
}

static void emit_begin(st_t *st)
{
    cm1e_st_put(st, "static void begin(void)\n{\n");
    st->indent = 1;
    for (const var_t *var = st->tree.globals; var; var = var->next)
        if (!st->sources[var->place.file].external)
            cm1e_st_emit_initial(st, var->c_name, var->type, var->initial);
    for (const instance_t *instance = st->tree.instances; instance; instance = instance->next)
        if (cm1e_st_needs_initial(instance->unit->type))
            cm1e_st_line(st, "init_%s(&I_%s);\n", instance->unit->c_type, instance->name);
    st->indent = 0;
    cm1e_st_put(st, "}\n");
}

void cm1e_st_emit_tables(st_t *st, const char *name)
{
    uint64_t layout = 0;
    emit_begin(st);
    for (table_t table = 0; table < TABLES; table++)
        layout = emit_table(st, table); /* that of the last one, the retained variables, counts */
    emit_tasks(st);
    cm1e_st_put(st, "ST_EXPORT extern const st_program_t cm1e_st_program;\n"
                "const st_program_t cm1e_st_program = {\n    ST_PROGRAM_VERSION, UINT64_C(0x%" PRIx64 "), "
                "UINT64_C(0x%" PRIx64 "), ", cm1e_st_interface(), layout);
    cm1e_st_put_quoted(st, name);
    cm1e_st_put(st, ",\n    begin, st_tasks, ST_COUNT_tasks,\n");
    for (table_t table = 0; table < TABLES; table++)
        cm1e_st_put(st, "    {st_%s, ST_COUNT_%s},\n", tables[table], tables[table]);
    cm1e_st_put(st, "    &st_fault, &st_loop_limit,\n};\n");
}
