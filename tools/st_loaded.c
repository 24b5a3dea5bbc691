#include "st_loaded.h"

#include <dlfcn.h>
#include <errno.h>
#include <link.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cm1e/axis.h"
#include "cm1e/group.h"
#include "cm1e/trace.h"
#include "core/near.h"
#include "scheduler/forcing.h"
#include "st/st.h"

/** Why there is nothing to be loaded; NULL: a file can be read. */
static const char *why_unreadable(const char *path)
{
    struct stat about;
    if (stat(path, &about) != 0 || access(path, R_OK) != 0)
        return strerror(errno);
    return S_ISREG(about.st_mode) ? NULL : "it is no file";
}

/** The table at the end of the file is not all there. dlopen() does not look, and the process would die of SIGBUS. */
static bool is_cut_off(const char *path)
{
    ElfW(Ehdr) head;
    FILE *file = fopen(path, "rb");
    bool result = false;
    if (file && fread(&head, sizeof head, 1, file) == 1 && memcmp(head.e_ident, ELFMAG, SELFMAG) == 0 &&
        fseek(file, 0, SEEK_END) == 0) {
        const long size = ftell(file);
        const uint64_t needed = (uint64_t)head.e_shoff + (uint64_t)head.e_shnum * head.e_shentsize;
        result = size >= 0 && needed > (uint64_t)size;
    }
    if (file)
        fclose(file);
    return result;
}

cm1e_error_t st_load(st_loaded_t *loaded, const char *path, cm1e_diag_t *diag)
{
    *loaded = (st_loaded_t){0};
    const char *end = strrchr(path, '.');
    if (end && (strcasecmp(end, ".st") == 0 || strcasecmp(end, ".TcPOU") == 0))
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "%s is a source: \"cm1e st build %s\" makes %.*s.so of it, which "
                             "runs.", path, path, (int)(end - path), path);
    const char *why = why_unreadable(path);
    if (why)
        return cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "%s cannot be loaded: %s. Programs are made by `cm1e st build`.",
                             path, why);
    if (is_cut_off(path))
        return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "%s is cut off: its end is missing. Copy it again, or make it again "
                             "by `cm1e st build`.", path);
    char *full = realpath(path, NULL); /* a name without a slash would be looked for in the folders of libraries */
    loaded->library = dlopen(full ? full : path, RTLD_NOW | RTLD_LOCAL);
    free(full);
    if (!loaded->library)
        return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "%s cannot be loaded: %s. Programs are made by `cm1e st build`.",
                             path, dlerror());
    loaded->program = dlsym(loaded->library, "cm1e_st_program");
    if (!loaded->program)
        return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "%s is no program that `cm1e st build` made", path);
    if (loaded->program->version != ST_PROGRAM_VERSION || loaded->program->interface != cm1e_st_interface())
        return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "%s was made for another version of the library: translate "
                             "it again with `cm1e st build`", path);
    return CM1E_OK;
}

cm1e_error_t st_begin(st_loaded_t *loaded, const char *retain_path, bool cold, cm1e_diag_t *diag)
{
    char text[400];
    loaded->program->begin();
    st_fault_text(loaded, text, sizeof text);
    if (text[0])
        return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "the program was stopped while it got its initial values, before "
                             "anything was started: %s", text);
    return st_retain_begin(&loaded->retain, loaded->program, retain_path, cold, diag);
}

void st_unload(st_loaded_t *loaded)
{
    st_located_free(&loaded->located);
    free(loaded->variables);
    if (loaded->library)
        dlclose(loaded->library);
    *loaded = (st_loaded_t){0};
}

void st_fault_text(const st_loaded_t *loaded, char *text, size_t size)
{
    const st_fault_t *fault = loaded->program->fault;
    text[0] = '\0';
    if (!fault->happened)
        return;
    const int used = snprintf(text, size, "%s:%u: ", fault->file, fault->line);
    if (used < 0 || (size_t)used >= size)
        return;
    /* The texts are those of st_runtime.h, with up to three %lld. */
    char *at = text + used;
    const char *from = fault->text;
    int value = 0;
    while (*from && (size_t)(at - text) + 24 < size) {
        if (strncmp(from, "%lld", 4) == 0 && value < 3) {
            at += snprintf(at, size - (size_t)(at - text), "%lld", fault->values[value++]);
            from += 4;
        } else {
            *at++ = *from++;
        }
    }
    *at = '\0';
}

/** Task of the scheduler: the task of the program between its inputs and outputs, and the end of the run after a fault. */
static void run_task(void *context)
{
    const struct st_running_task *task = context;
    st_located_read(&task->loaded->located);
    cm1e_scheduler_apply_forced(task->loaded->scheduler);
    task->run();
    cm1e_scheduler_apply_forced(task->loaded->scheduler);
    st_located_write(&task->loaded->located);
    st_retain_cycle(&task->loaded->retain, cm1e_scheduler_time_ns(task->loaded->scheduler));
    if (task->loaded->program->fault->happened)
        cm1e_scheduler_stop(task->loaded->scheduler);
}

/* ---- a simulated machine ----------------------------------------------------------------------------------------- */

static bool has_axis(const cm1e_bus_config_t *config, const char *name)
{
    for (uint32_t i = 0; i < config->axis_count; i++)
        if (strcasecmp(config->axes[i].name, name) == 0)
            return true;
    return false;
}

cm1e_error_t st_simulated_machine(const st_loaded_t *loaded, cm1e_bus_config_t *config, cm1e_diag_t *diag)
{
    const st_list_t *axes = &loaded->program->axes;
    for (uint32_t i = 0; i < axes->count || config->axis_count == 0; i++) {
        const char *name = i < axes->count ? axes->first[i].name : "X";
        if (has_axis(config, name))
            continue;
        cm1e_axis_config_t *axis = cm1e_bus_config_add_axis(config, name);
        if (!axis)
            return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "the program has more than %d axes", CM1E_MAX_AXES);
        axis->address = (uint16_t)config->axis_count;
        axis->sim.no_stops = true;
    }
    return CM1E_OK;
}

/* ---- axes and groups --------------------------------------------------------------------------------------------- */

static AXIS_REF_t axis_named(const cm1e_scheduler_t *scheduler, const char *name, cm1e_near_t *near)
{
    AXIS_REF_t axis = {0};
    for (uint32_t i = 0; i < CM1E_MAX_AXES; i++) {
        axis = cm1e_scheduler_axis(scheduler, i);
        if (axis.Handle == 0 || strcasecmp(cm1e_axis_name(axis), name) == 0)
            break;
        cm1e_near_look(near, cm1e_axis_name(axis));
    }
    return axis;
}

static cm1e_error_t bind_axes(const st_loaded_t *loaded, cm1e_diag_t *diag)
{
    const st_list_t *axes = &loaded->program->axes;
    for (uint32_t i = 0; i < axes->count; i++) {
        char text[CM1E_NEAR_TEXT_BYTES];
        cm1e_near_t near = {.word = axes->first[i].name};
        const AXIS_REF_t axis = axis_named(loaded->scheduler, axes->first[i].name, &near);
        if (axis.Handle == 0)
            return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "the program has the axis \"%s\" (%s : AXIS_REF), which the "
                                 "bus file has not%s", axes->first[i].name, axes->first[i].detail,
                                 cm1e_near_text(&near, text, sizeof text));
        *(AXIS_REF_t *)axes->first[i].data = axis;
    }
    return CM1E_OK;
}

static cm1e_error_t make_groups(const st_loaded_t *loaded, cm1e_diag_t *diag)
{
    const st_list_t *groups = &loaded->program->groups;
    for (uint32_t i = 0; i < groups->count; i++) {
        cm1e_group_config_t config = {{0}};
        snprintf(config.name, sizeof config.name, "%s", groups->first[i].name);
        const cm1e_error_t error = cm1e_group_create(groups->first[i].data, &config, diag);
        if (error != CM1E_OK)
            return error;
    }
    return CM1E_OK;
}

/* ---- variables --------------------------------------------------------------------------------------------------- */

static variable_t variable_of(const st_variable_t *from)
{
    static const cm1e_trace_type_t types[] = {
        [ST_KIND_BOOL] = CM1E_TRACE_BOOL, [ST_KIND_SINT] = CM1E_TRACE_SINT, [ST_KIND_INT] = CM1E_TRACE_INT,
        [ST_KIND_DINT] = CM1E_TRACE_DINT, [ST_KIND_LINT] = CM1E_TRACE_LINT, [ST_KIND_USINT] = CM1E_TRACE_USINT,
        [ST_KIND_UINT] = CM1E_TRACE_UINT, [ST_KIND_UDINT] = CM1E_TRACE_UDINT, [ST_KIND_ULINT] = CM1E_TRACE_ULINT,
        [ST_KIND_REAL] = CM1E_TRACE_REAL, [ST_KIND_LREAL] = CM1E_TRACE_LREAL, [ST_KIND_TIME] = CM1E_TRACE_LINT,
    };
    return (variable_t){
        .name = from->name, .unit = from->kind == ST_KIND_TIME ? "ns" : "", .declared = from->detail,
        .form = from->kind == ST_KIND_STRING ? VARIABLE_STRING : from->kind == ST_KIND_WSTRING ? VARIABLE_WSTRING
                                                                                               : VARIABLE_NUMBER,
        .type = from->kind <= ST_KIND_TIME ? types[from->kind] : CM1E_TRACE_LREAL, .data = from->data,
        .bytes = from->size, .bit = (uint8_t)from->bit, .ranged = from->ranged, .first = from->first, .last = from->last,
        .names = from->names, .values = from->values, .name_count = from->name_count};
}

static cm1e_error_t make_variables(st_loaded_t *loaded, cm1e_diag_t *diag)
{
    const st_list_t *from = &loaded->program->variables;
    loaded->variables = calloc(from->count + 1, sizeof *loaded->variables);
    if (!loaded->variables)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "%s", cm1e_strerror(CM1E_ERROR_NO_MEMORY));
    for (uint32_t i = 0; i < from->count; i++)
        loaded->variables[i] = variable_of(&from->first[i]);
    cm1e_scheduler_set_variables(loaded->scheduler, loaded->variables, from->count);
    return CM1E_OK;
}

/** How deep it is in its program: 1 for `Main.n`. */
static int depth_of(const char *name)
{
    int points = 0;
    for (; *name; name++)
        points += *name == '.' || *name == '[';
    return points;
}

/** Without a choice the trace has the first variables, those of the program before those within its blocks. */
static cm1e_error_t trace_first(st_loaded_t *loaded, cm1e_diag_t *diag)
{
    enum { DEPTHS = 8, MOST = CM1E_TRACE_VARIABLES / 2 }; /* the other half is for objects of drives */
    uint32_t traced = 0;
    cm1e_error_t error = CM1E_OK;
    for (int depth = 0; depth < DEPTHS; depth++)
        for (uint32_t i = 0; i < loaded->program->variables.count && error == CM1E_OK; i++) {
            const variable_t *variable = &loaded->variables[i];
            if (variable->form != VARIABLE_NUMBER || depth_of(variable->name) != depth ||
                strlen(variable->name) >= CM1E_TRACE_NAME_BYTES)
                continue;
            if (traced == MOST) {
                loaded->untraced++;
                continue;
            }
            error = cm1e_scheduler_trace_number(loaded->scheduler, variable, diag);
            traced++;
        }
    return error;
}

static cm1e_error_t trace_within(const st_loaded_t *loaded, const char *path, cm1e_diag_t *diag)
{
    char text[CM1E_NEAR_TEXT_BYTES];
    cm1e_near_t near = {.word = path};
    cm1e_error_t error = CM1E_OK;
    bool found = false;
    for (uint32_t i = 0; i < loaded->program->variables.count && error == CM1E_OK; i++) {
        const variable_t *variable = &loaded->variables[i];
        cm1e_near_look(&near, variable->name);
        if (!cm1e_variable_is_within(variable->name, path))
            continue;
        found = true;
        if (variable->form == VARIABLE_NUMBER || strcasecmp(variable->name, path) == 0)
            error = cm1e_scheduler_trace_number(loaded->scheduler, variable, diag);
    }
    if (found)
        return error;
    return cm1e_diag_set(diag, CM1E_ERROR_NOT_FOUND, 0, "The program has no variable \"%s\" that a trace could record%s", path,
                         cm1e_near_text(&near, text, sizeof text));
}

/** What others who attach see, and what a trace records. */
static cm1e_error_t register_variables(st_loaded_t *loaded, cm1e_diag_t *diag)
{
    cm1e_error_t error = make_variables(loaded, diag);
    if (error == CM1E_OK && loaded->path_count == 0)
        error = trace_first(loaded, diag);
    for (int i = 0; i < loaded->path_count && error == CM1E_OK; i++)
        error = trace_within(loaded, loaded->paths[i], diag);
    return error;
}

static cm1e_error_t add_tasks(st_loaded_t *loaded, cm1e_diag_t *diag)
{
    const st_program_t *program = loaded->program;
    cm1e_error_t error = CM1E_OK;
    if (program->task_count > CM1E_MAX_TASKS)
        return cm1e_diag_set(diag, CM1E_ERROR_CONFIG, 0, "the program has %u tasks; %d are the most: in a "
                             "CONFIGURATION several programs can run WITH the same TASK", program->task_count,
                             CM1E_MAX_TASKS);
    for (uint32_t i = 0; i < program->task_count && error == CM1E_OK; i++) {
        loaded->tasks[i].loaded = loaded;
        loaded->tasks[i].run = program->tasks[i].run;
        const cm1e_task_config_t task = {.name = program->tasks[i].name, .interval_ns = program->tasks[i].interval_ns,
                                         .priority = program->tasks[i].priority, .program = run_task,
                                         .context = &loaded->tasks[i]};
        error = cm1e_scheduler_add_task(loaded->scheduler, &task, diag);
    }
    return error;
}

cm1e_error_t st_attach(st_loaded_t *loaded, cm1e_scheduler_t *scheduler, cm1e_bus_t *bus, cm1e_diag_t *diag)
{
    loaded->scheduler = scheduler;
    cm1e_error_t error = bind_axes(loaded, diag);
    if (error == CM1E_OK)
        error = st_located_find(&loaded->located, &loaded->program->located, bus, diag);
    if (error == CM1E_OK)
        error = make_groups(loaded, diag);
    if (error == CM1E_OK)
        error = register_variables(loaded, diag);
    return error == CM1E_OK ? add_tasks(loaded, diag) : error;
}
