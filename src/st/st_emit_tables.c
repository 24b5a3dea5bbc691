/* Tasks, and the tables by which others find the variables of a program. */
#include "st/st_emit.h"

#include <inttypes.h>
#include <string.h>

enum { LARGE = 256 }; /* elements of an array that is listed behind all others */

#define DAY_NS (INT64_C(86400) * 1000000000)

typedef enum table { TABLE_VARIABLES, TABLE_AXES, TABLE_GROUPS, TABLE_LOCATED, TABLE_RETAINED, TABLES } table_t;

static const char *const tables[TABLES] = {"variables", "axes", "groups", "located", "retained"};

typedef struct listing {
    st_t *st;
    table_t table;
    unsigned count;
    bool large, within_large; /* elements of large arrays are listed now; this is one */
    uint64_t unlisted;
    uint64_t layout; /* hash of names, types and sizes */
} listing_t;

static const char *kind_of(const type_t *type)
{
    switch (cm1e_st_plain_kind(type)) {
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
    case T_TIME:
    case T_DATE:
    case T_TOD:
    case T_DT: return "TIME";
    case T_STRING: return type->wide ? "WSTRING" : "STRING";
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
    const bool of_day = type->kind == T_TOD;
    if (type->ranged || of_day)
        cm1e_st_put(l->st, ", 0, 1, %s, %s", cm1e_st_int64(l->st, of_day ? 0 : type->first),
                    cm1e_st_int64(l->st, of_day ? DAY_NS - 1 : type->last));
    if (type->kind == T_ENUM)
        cm1e_st_put(l->st, ", .names = names_%s, .values = values_%s, .name_count = sizeof names_%s / sizeof *names_%s",
                    type->c_name, type->c_name, type->c_name, type->c_name);
    cm1e_st_put(l->st, "},\n");
}

/** What a value consists of, with the names of its parts: a file of RETAIN variables must mean the same. */
static void note_shape(listing_t *l, const char *name, const type_t *type)
{
    note_layout(l, cm1e_st_format(l->st->arena, "%s:%s:%llu", name, cm1e_st_type_name(type),
                                  (unsigned long long)type->size));
    if (type->kind == T_ARRAY)
        note_shape(l, "", type->element);
    for (const var_t *var = type->kind == T_STRUCT || type->kind == T_ENUM ? type->members : NULL; var; var = var->next)
        if (type->kind == T_ENUM)
            note_layout(l, cm1e_st_format(l->st->arena, ",%s=%" PRId64, var->name, var->value.integer));
        else
            note_shape(l, cm1e_st_format(l->st->arena, ",%s", var->name), var->type);
    note_layout(l, ";");
}

/** A BOOL AT %MX is a bit of a byte. */
static void bit_row(listing_t *l, const char *name, const var_t *var)
{
    l->count++;
    cm1e_st_put(l->st, "    {");
    cm1e_st_put_quoted(l->st, name);
    cm1e_st_put(l->st, ", &%s, 1, ST_KIND_BOOL, \"BOOL\", %d},\n", var->c_name, var->memory_bit);
}

static bool is_handle(const type_t *type)
{
    return type->kind == T_STRUCT && type->external && type->members && !type->members->next &&
           strcmp(type->members->name, "Handle") == 0; /* of an axis or a group: a number that says nothing */
}

static void list_values(listing_t *l, const char *name, const char *c_name, const type_t *type);

/** The indices of an element in ST: "2,-1". */
static const char *indices_of(const listing_t *l, const type_t *type, uint64_t element)
{
    const char *text = "";
    for (int i = type->dimension_count - 1; i >= 0; i--) {
        const dimension_t *d = &type->dimensions[i];
        const uint64_t length = (uint64_t)(d->last - d->first + 1);
        text = cm1e_st_format(l->st->arena, "%lld%s%s", (long long)(d->first + (int64_t)(element % length)),
                              *text ? "," : "", text);
        element /= length;
    }
    return text;
}

static void list_elements(listing_t *l, const char *name, const char *c_name, const type_t *type)
{
    const uint64_t count = type->element->size ? type->size / type->element->size : 0;
    const bool outer = l->within_large;
    l->within_large = outer || count > LARGE;
    for (uint64_t i = 0; i < count && (l->large || !l->within_large); i++) {
        if (l->count >= l->st->listed_most && l->within_large) {
            l->unlisted += count - i; /* without looking into each */
            break;
        }
        list_values(l, cm1e_st_format(l->st->arena, "%s[%s]", name, indices_of(l, type, i)),
                    cm1e_st_format(l->st->arena, "%s.at[%llu]", c_name, (unsigned long long)i), type->element);
    }
    l->within_large = outer;
}

/** All parts of a variable that have a value, by name: in a second pass those in large arrays. */
static void list_values(listing_t *l, const char *name, const char *c_name, const type_t *type)
{
    arena_t *arena = l->st->arena;
    const bool block = type->kind == T_BLOCK;
    if (is_handle(type))
        return;
    if (type->kind <= T_DT || type->kind == T_ENUM || type->kind == T_STRING) {
        if (l->large != l->within_large)
            return;
        if (l->count < l->st->listed_most)
            row(l, name, c_name, type, cm1e_st_type_name(type));
        else
            l->unlisted++;
    } else if (type->kind == T_ARRAY) {
        list_elements(l, name, c_name, type);
    } else if (type->kind == T_STRUCT || block) {
        for (const var_t *var = type->members; var; var = var->next) {
            const bool inner = type->external && block && var->section == V_LOCAL;
            const bool constant = (var->qualifiers & Q_CONSTANT) && var->section != V_INPUT;
            if (inner || constant || var->section == V_TEMP || var->section == V_EXTERNAL ||
                var->section == V_IN_OUT)
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
    c_name = var->in_memory ? var->c_name : c_name;
    const bool named = type->kind == T_STRUCT && type->external;
    switch (l->table) {
    case TABLE_VARIABLES:
        if (var->memory_bit && l->large)
            break;
        if (var->memory_bit)
            bit_row(l, name, var);
        else if (!(var->qualifiers & Q_CONSTANT))
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
        if (var->address && !var->in_memory)
            row(l, name, c_name, type, var->address->name);
        break;
    default:
        if (var->qualifiers & Q_RETAIN) {
            row(l, name, c_name, type, cm1e_st_type_name(type));
            note_shape(l, name, type);
        }
        break;
    }
}

static void list_all(listing_t *l)
{
    st_t *st = l->st;
    for (const var_t *var = st->tree.globals; var; var = var->next)
        if (!st->sources[var->place.file].external)
            list_variable(l, var->list ? cm1e_st_format(st->arena, "%s.%s", var->list, var->name) : var->name,
                          var->c_name, var);
    for (const instance_t *instance = st->tree.instances; instance; instance = instance->next)
        for (const var_t *var = instance->unit->vars; var; var = var->next)
            if (var->section == V_LOCAL || var->section == V_INPUT || var->section == V_OUTPUT)
                list_variable(l, cm1e_st_format(st->arena, "%s.%s", instance->name, var->name),
                              cm1e_st_format(st->arena, "I_%s.%s", instance->name, var->c_name), var);
}

static listing_t emit_table(st_t *st, table_t table)
{
    listing_t l = {.st = st, .table = table, .layout = UINT64_C(14695981039346656037)};
    cm1e_st_put(st, "static const st_variable_t st_%s[] = {\n", tables[table]);
    list_all(&l);
    l.large = table == TABLE_VARIABLES;
    if (l.large)
        list_all(&l);
    cm1e_st_put(st, "    {.kind = ST_KIND_OTHER}\n};\n");
    cm1e_st_put(st, "enum { ST_COUNT_%s = %u };\n", tables[table], l.count);
    return l;
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
    if (cm1e_st_has_edges(instance->unit))
        cm1e_st_line(st, "edges_%s(&I_%s);\n", instance->unit->c_type, instance->name);
    cm1e_st_line(st, "%s(&I_%s);\n", instance->unit->c_name, instance->name);
    for (const arg_t *arg = instance->args; arg; arg = arg->next) {
        if (!arg->output)
            continue;
        const char *c_name = cm1e_st_format(st->arena, "I_%s.%s", instance->name, arg->parameter->c_name);
        var_t of_instance = {.section = V_GLOBAL, .c_name = c_name, .type = arg->parameter->type};
        const expr_t output = {.kind = E_NAME, .type = of_instance.type, .var = &of_instance};
        cm1e_st_emit_assignment(st, arg->value, &output);
    }
}

/** The function of a task: all its programs; of `alone`, a program without a task. */
static void emit_task(st_t *st, const char *name, const task_t *task, const instance_t *alone)
{
    cm1e_st_put(st, "static void %s(void)\n{\n", name);
    st->indent = 1;
    cm1e_st_line(st, "if (st_fault.happened || setjmp(st_leave) != 0)\n        return;\n");
    cm1e_st_line(st, "st_loops_left = st_loop_limit;\n");
    for (const instance_t *instance = st->tree.instances; instance; instance = instance->next)
        if (alone ? instance == alone : instance->task == task)
            emit_program(st, instance);
    st->indent = 0;
    cm1e_st_put(st, "}\n");
}

/** A task with SINGLE runs at its rising edge; with an INTERVAL too, periodically in between (IEC 61131-3). */
static void emit_event(st_t *st, const task_t *task)
{
    cm1e_st_put(st, "static void edge_task_%s(void)\n{\n    static BOOL before;\n    const BOOL now = ", task->name);
    cm1e_st_emit_expression(st, task->single);
    cm1e_st_put(st, ", edge = now && !before;\n    before = now;\n    if (edge)\n        task_%s();\n}\n", task->name);
    if (task->interval_ns == 0)
        return;
    cm1e_st_put(st, "static void between_task_%s(void)\n{\n    if (!", task->name);
    cm1e_st_emit_expression(st, task->single);
    cm1e_st_put(st, ")\n        task_%s();\n}\n", task->name);
}

static void emit_task_row(st_t *st, unsigned *count, const char *name, const task_t *task, const char *before,
                          int64_t interval_ns)
{
    cm1e_st_put(st, "    {\"%s\", INT64_C(%" PRId64 "), %" PRId64 ", %stask_%s},\n", name, interval_ns, task->priority,
                before, task->name);
    ++*count;
}

/** Neither a task nor another program calls it: it is a task of its own. */
static bool runs_alone(const instance_t *instance) { return !instance->task && !instance->unit->called; }

static void emit_tasks(st_t *st)
{
    unsigned count = 0;
    for (const task_t *task = st->tree.tasks; task; task = task->next) {
        emit_task(st, cm1e_st_format(st->arena, "task_%s", task->name), task, NULL);
        if (task->single)
            emit_event(st, task);
    }
    for (const instance_t *instance = st->tree.instances; instance; instance = instance->next)
        if (runs_alone(instance))
            emit_task(st, cm1e_st_format(st->arena, "program_task_%s", instance->name), NULL, instance);
    cm1e_st_put(st, "static const st_task_t st_tasks[] = {\n");
    for (const task_t *task = st->tree.tasks; task; task = task->next) {
        if (task->single)
            emit_task_row(st, &count, cm1e_st_format(st->arena, "%s (SINGLE)", task->name), task, "edge_", 0);
        if (task->interval_ns > 0 || !task->single)
            emit_task_row(st, &count, task->name, task, task->single ? "between_" : "", task->interval_ns);
    }
    for (const instance_t *instance = st->tree.instances; instance; instance = instance->next)
        if (runs_alone(instance)) {
            cm1e_st_put(st, "    {\"%s\", 0, 65535, program_task_%s},\n", instance->name, instance->name);
            count++;
        }
    cm1e_st_put(st, "    {0, 0, 0, 0}\n};\nenum { ST_COUNT_tasks = %u };\n", count);
}

static void emit_memory_initial(st_t *st, const var_t *var)
{
    if (var->memory_bit == 0)
        cm1e_st_emit_var_initial(st, var->c_name, var);
    else if (var->initial && var->initial->value.integer)
        cm1e_st_line(st, "%s |= 1u << %d;\n", var->c_name, var->memory_bit - 1);
}

/** An FB_Init is called for it, or for a part of it. */
static bool calls_init(const type_t *type)
{
    if (type->kind == T_ARRAY)
        return calls_init(type->element);
    if (type->kind == T_BLOCK && cm1e_st_has_init(type->unit))
        return true;
    const bool has_members = type->kind == T_BLOCK || type->kind == T_STRUCT;
    for (const var_t *var = has_members ? type->members : NULL; var; var = var->next)
        if (cm1e_st_is_stored(var) && var->section != V_IN_OUT && calls_init(var->type))
            return true;
    return false;
}

static void emit_global_initial(st_t *st, const var_t *var, bool with_init)
{
    const bool init = !var->in_memory && calls_init(var->type);
    if (init != with_init)
        return;
    if (var->in_memory)
        emit_memory_initial(st, var);
    else if (!st->sources[var->place.file].external)
        cm1e_st_emit_var_initial(st, var->c_name, var);
}

/** In the order of their declaration, which that of the list is not; at last those with FB_Init, which may use
 *  others. */
static void emit_globals_initial(st_t *st)
{
    size_t count = 0;
    for (const var_t *var = st->tree.globals; var; var = var->next)
        count++;
    const var_t **vars = cm1e_st_take(st->arena, (count + 1) * sizeof(const var_t *));
    size_t at = count;
    for (const var_t *var = st->tree.globals; var; var = var->next)
        vars[--at] = var;
    for (; at < count; at++)
        emit_global_initial(st, vars[at], false);
    for (at = 0; at < count; at++)
        emit_global_initial(st, vars[at], true);
}

static void emit_begin(st_t *st)
{
    cm1e_st_put(st, "static void begin(void)\n{\n");
    st->indent = 1;
    /* FB_Init may fail. */
    cm1e_st_line(st, "if (setjmp(st_leave) != 0)\n        return;\n    st_loops_left = st_loop_limit;\n");
    emit_globals_initial(st);
    for (const unit_t *unit = st->tree.units; unit; unit = unit->next)
        for (const var_t *var = unit->vars; var; var = var->next)
            if (var->in_memory)
                emit_memory_initial(st, var);
    for (const instance_t *instance = st->tree.instances; instance; instance = instance->next)
        if (cm1e_st_needs_initial(instance->unit->type))
            cm1e_st_line(st, "init_%s(&I_%s);\n", instance->unit->c_type, instance->name);
    st->indent = 0;
    cm1e_st_put(st, "}\n");
}

void cm1e_st_emit_tables(st_t *st, const char *name)
{
    uint64_t layout = 0, unlisted = 0;
    emit_begin(st);
    for (table_t table = 0; table < TABLES; table++) {
        const listing_t l = emit_table(st, table);
        layout = l.layout; /* that of the last one, the retained variables, counts */
        unlisted += l.unlisted;
    }
    emit_tasks(st);
    cm1e_st_put(st, "ST_EXPORT extern const st_program_t cm1e_st_program;\n"
                "const st_program_t cm1e_st_program = {\n    ST_PROGRAM_VERSION, UINT64_C(0x%" PRIx64 "), "
                "UINT64_C(0x%" PRIx64 "), ", cm1e_st_interface(), layout);
    cm1e_st_put_quoted(st, name);
    cm1e_st_put(st, ",\n    begin, st_tasks, ST_COUNT_tasks,\n");
    for (table_t table = 0; table < TABLES; table++)
        cm1e_st_put(st, "    {st_%s, ST_COUNT_%s},\n", tables[table], tables[table]);
    cm1e_st_put(st, "    %" PRIu64 "u, &st_fault, &st_loop_limit,\n};\n", unlisted);
}
