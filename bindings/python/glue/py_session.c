#include "py_session.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>

#include "cm1e/plot.h"
#include "cm1e/trace.h"
#include "py_owner.h"

static cm1e_error_t closed(cm1e_diag_t *diag)
{
    return cm1e_diag_set(diag, CM1E_ERROR_STATE, 0, "The bus is closed.");
}

/** What most jobs bring and fetch. */
typedef struct call {
    const void *in;
    void *out;
    cm1e_diag_t *diag;
} call_t;

/** Does a job; a closed session says so. */
static cm1e_error_t ask(cm1e_py_session_t *s, cm1e_error_t (*act)(cm1e_py_session_t *, void *), call_t *call)
{
    if (call->diag)
        call->diag->text[0] = '\0';
    const cm1e_error_t error = py_owner_do(s, act, call);
    return error == CM1E_ERROR_STATE && call->diag && !call->diag->text[0] ? closed(call->diag) : error;
}

/* ---- open ... close ---------------------------------------------------------------------------------------------- */

static cm1e_error_t open_bus(cm1e_py_session_t *s, void *argument)
{
    const call_t *call = argument;
    if (s->bus_count == CM1E_MAX_BUSES || s->ran)
        return cm1e_diag_set(call->diag, CM1E_ERROR_STATE, 0, "A program has at most %d networks, opened before its run.",
                             CM1E_MAX_BUSES);
    const cm1e_error_t error = cm1e_bus_open(&s->buses[s->bus_count], call->in, call->diag);
    s->bus_count += error == CM1E_OK;
    return error;
}

cm1e_error_t cm1e_py_add(cm1e_py_session_t *session, const cm1e_bus_config_t *config, cm1e_diag_t *diag)
{
    return ask(session, open_bus, &(call_t){.in = config, .diag = diag});
}

cm1e_error_t cm1e_py_open(cm1e_py_session_t **session, const cm1e_bus_config_t *config, cm1e_diag_t *diag)
{
    cm1e_py_session_t *s = calloc(1, sizeof *s);
    call_t call = {.in = config, .diag = diag};
    *session = NULL;
    if (!s)
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No memory for the bus.");
    s->virtual_time = config->virtual_time;
    cm1e_error_t error = py_owner_begin(s, diag);
    if (error == CM1E_OK)
        error = ask(s, open_bus, &call);
    if (error == CM1E_OK)
        *session = s;
    else
        cm1e_py_free(s);
    return error;
}

static cm1e_error_t scan_bus(cm1e_py_session_t *s, void *argument)
{
    const call_t *call = argument;
    if (s->scheduler)
        return cm1e_diag_set(call->diag, CM1E_ERROR_STATE, 0, "The bus is scanned before it is started.");
    return cm1e_bus_scan(s->bus, call->diag);
}

cm1e_error_t cm1e_py_scan(cm1e_py_session_t *session, cm1e_diag_t *diag)
{
    return ask(session, scan_bus, &(call_t){.diag = diag});
}

static cm1e_error_t trace_objects(cm1e_py_session_t *s, cm1e_diag_t *diag)
{
    for (uint32_t i = 0; i < s->traced_count; i++) {
        const py_traced_t *t = &s->traced[i];
        const AXIS_REF_t axis = cm1e_scheduler_axis_by_name(s->scheduler, t->axis);
        const cm1e_error_t error = cm1e_scheduler_trace_object(s->scheduler, axis, t->index, t->subindex, diag);
        if (error != CM1E_OK)
            return error;
    }
    return CM1E_OK;
}

/** The scheduler locks the memory of the process when the watchdogs of the slaves run already. That of an interpreter is
 *  large: what is locked before does not delay the first cycle. A refusal is told by the scheduler. */
static void lock_memory(const cm1e_py_session_t *s, const cm1e_scheduler_config_t *config)
{
    if (!s->virtual_time && config->realtime_priority >= 0)
        mlockall(MCL_CURRENT);
}

static cm1e_error_t begin_run(cm1e_py_session_t *s, void *argument)
{
    const call_t *call = argument;
    if (s->ran)
        return cm1e_diag_set(call->diag, CM1E_ERROR_STATE, 0, "This bus has been started before: open it again.");
    s->ran = true;
    lock_memory(s, call->in);
    cm1e_error_t error = CM1E_OK;
    for (uint32_t i = 0; i < s->bus_count && error == CM1E_OK; i++)
        error = cm1e_bus_start(s->buses[i], call->diag);
    if (error == CM1E_OK)
        error = cm1e_scheduler_create(&s->scheduler, s->buses[0], call->in, call->diag);
    for (uint32_t i = 1; i < s->bus_count && error == CM1E_OK; i++)
        error = cm1e_scheduler_add_bus(s->scheduler, s->buses[i], call->diag);
    if (error == CM1E_OK)
        error = trace_objects(s, call->diag);
    if (error == CM1E_OK) {
        atomic_store(&s->running, true);
        s->begin = true;
    }
    return error;
}

cm1e_error_t cm1e_py_begin(cm1e_py_session_t *s, const cm1e_scheduler_config_t *config, cm1e_diag_t *diag)
{
    const struct timespec moment = {.tv_nsec = 100000};
    const cm1e_error_t error = ask(s, begin_run, &(call_t){.in = config, .diag = diag});
    while (error == CM1E_OK && cm1e_py_runs(s) && !atomic_load_explicit(&s->in_cycle, memory_order_acquire))
        nanosleep(&moment, NULL);
    return error != CM1E_OK || atomic_load(&s->in_cycle) ? error : cm1e_py_end(s, diag);
}

cm1e_error_t cm1e_py_end(cm1e_py_session_t *s, cm1e_diag_t *diag)
{
    py_owner_end_run(s);
    pthread_mutex_lock(&s->mutex);
    const cm1e_error_t error = s->result;
    if (diag)
        *diag = s->diag;
    pthread_mutex_unlock(&s->mutex);
    return error;
}

static cm1e_error_t close_bus(cm1e_py_session_t *s, void *argument)
{
    (void)argument;
    for (uint32_t i = 0; i < s->group_count; i++)
        cm1e_group_destroy(s->groups[i]);
    cm1e_scheduler_destroy(s->scheduler);
    cm1e_error_t error = CM1E_OK;
    for (uint32_t i = 0; i < s->bus_count; i++) {
        const cm1e_error_t closed = cm1e_bus_close(s->buses[i]);
        error = error == CM1E_OK ? closed : error;
        s->buses[i] = NULL;
    }
    s->scheduler = NULL;
    s->bus = NULL;
    s->group_count = s->block_count = s->bus_count = 0;
    return error;
}

cm1e_error_t cm1e_py_close(cm1e_py_session_t *s, cm1e_diag_t *diag)
{
    cm1e_error_t error = cm1e_py_end(s, diag);
    pthread_mutex_lock(&s->mutex);
    while (s->guests > 0) /* the end of the run has cancelled what they wait for */
        pthread_cond_wait(&s->changed, &s->mutex);
    pthread_mutex_unlock(&s->mutex);
    const cm1e_error_t at_close = py_owner_do(s, close_bus, NULL);
    py_owner_join(s);
    if (error == CM1E_OK && at_close == CM1E_ERROR_IO)
        error = cm1e_diag_set(diag, at_close, 0, "Not every frame arrived in the pcap file.");
    return error;
}

void cm1e_py_free(cm1e_py_session_t *s)
{
    if (!s)
        return;
    cm1e_py_close(s, NULL);
    free(s);
}

/* ---- blocks ------------------------------------------------------------------------------------------------------ */

static uint32_t place_of(const cm1e_py_session_t *s, const cm1e_py_block_t *block)
{
    uint32_t i = 0;
    while (i < s->block_count && s->blocks[i] != block)
        i++;
    return i;
}

static cm1e_error_t add_block(cm1e_py_session_t *s, void *block)
{
    if (!s->bus)
        return CM1E_ERROR_STATE;
    if (place_of(s, block) < s->block_count)
        return CM1E_OK;
    if (s->block_count == CM1E_PY_BLOCKS + CM1E_PY_COMMANDS)
        return CM1E_ERROR_FULL;
    s->blocks[s->block_count++] = block;
    return CM1E_OK;
}

cm1e_error_t cm1e_py_block_add(cm1e_py_session_t *session, cm1e_py_block_t *block)
{
    return py_owner_do(session, add_block, block);
}

static cm1e_error_t remove_block(cm1e_py_session_t *s, void *block)
{
    const uint32_t place = place_of(s, block);
    if (place < s->block_count) {
        s->block_count--;
        memmove(&s->blocks[place], &s->blocks[place + 1], (s->block_count - place) * sizeof *s->blocks);
    }
    return CM1E_OK;
}

cm1e_error_t cm1e_py_block_remove(cm1e_py_session_t *session, cm1e_py_block_t *block)
{
    return py_owner_do(session, remove_block, block);
}

typedef struct transfer {
    const cm1e_py_copy_t *copies;
    size_t count;
    cm1e_py_block_t *block;
} transfer_t;

static cm1e_error_t make_copies(cm1e_py_session_t *s, void *argument)
{
    const transfer_t *transfer = argument;
    if (!s->bus)
        return CM1E_ERROR_STATE;
    for (size_t i = 0; i < transfer->count; i++)
        memcpy(transfer->copies[i].to, transfer->copies[i].from, transfer->copies[i].size);
    if (transfer->block)
        __atomic_store_n(&transfer->block->ended, 0, __ATOMIC_RELEASE);
    return CM1E_OK;
}

cm1e_error_t cm1e_py_transfer(cm1e_py_session_t *session, const cm1e_py_copy_t *copies, size_t count,
                              cm1e_py_block_t *block)
{
    return py_owner_do(session, make_copies, &(transfer_t){copies, count, block});
}

/** Only in a cycle: blocks use the time of the scan. */
static cm1e_error_t call_block(cm1e_py_session_t *s, void *argument)
{
    const cm1e_py_block_t *block = argument;
    if (!s->bus || !atomic_load(&s->running) || !atomic_load(&s->in_cycle))
        return CM1E_ERROR_STATE;
    block->call(block->fb);
    return CM1E_OK;
}

cm1e_error_t cm1e_py_block_call(cm1e_py_session_t *session, cm1e_py_block_t *block)
{
    return py_owner_do(session, call_block, block);
}

typedef struct release {
    cm1e_py_block_t *block;
    void *saved;
    size_t size, input;
} release_t;

/** One job: what breaks the waiting off in Python cannot come between its steps. */
static cm1e_error_t release_block(cm1e_py_session_t *s, void *argument)
{
    const release_t *release = argument;
    memcpy(release->saved, release->block->fb, release->size);
    ((BOOL *)release->block->fb)[release->input] = FALSE;
    (void)call_block(s, release->block);
    memcpy(release->block->fb, release->saved, release->size);
    return remove_block(s, release->block);
}

cm1e_error_t cm1e_py_block_release(cm1e_py_session_t *session, cm1e_py_block_t *block, void *saved, size_t size,
                                   size_t input)
{
    return py_owner_do(session, release_block, &(release_t){block, saved, size, input});
}

/* ---- axes, groups ------------------------------------------------------------------------------------------------ */

typedef struct axes {
    AXIS_REF_t *references;
    cm1e_axis_info_t *infos;
    uint32_t *count;
} axes_t;

static cm1e_error_t read_axes(cm1e_py_session_t *s, void *argument)
{
    const axes_t *axes = argument;
    uint32_t count = 0;
    if (!s->scheduler)
        return CM1E_ERROR_STATE;
    for (AXIS_REF_t axis; count < *axes->count; count++) {
        axis = cm1e_scheduler_axis(s->scheduler, count);
        if (axis.Handle == 0 || cm1e_axis_read(axis, &axes->infos[count]) != CM1E_OK)
            break;
        axes->references[count] = axis;
    }
    *axes->count = count;
    return CM1E_OK;
}

cm1e_error_t cm1e_py_axes(cm1e_py_session_t *session, AXIS_REF_t *references, cm1e_axis_info_t *infos, uint32_t *count)
{
    return py_owner_do(session, read_axes, &(axes_t){references, infos, count});
}

static cm1e_error_t make_group(cm1e_py_session_t *s, void *argument)
{
    const call_t *call = argument;
    cm1e_group_config_t config = {0};
    if (!s->bus)
        return CM1E_ERROR_STATE;
    if (s->ran)
        return cm1e_diag_set(call->diag, CM1E_ERROR_STATE, 0, "Axes groups are made before the bus is started.");
    if (s->group_count == PY_GROUPS)
        return cm1e_diag_set(call->diag, CM1E_ERROR_FULL, 0, "A process has at most %d axes groups.", PY_GROUPS);
    snprintf(config.name, sizeof config.name, "%s", (const char *)call->in);
    AXES_GROUP_REF_t *group = call->out;
    const cm1e_error_t error = cm1e_group_create(group, &config, call->diag);
    if (error == CM1E_OK)
        s->groups[s->group_count++] = *group;
    return error;
}

cm1e_error_t cm1e_py_group(cm1e_py_session_t *session, AXES_GROUP_REF_t *group, const char *name, cm1e_diag_t *diag)
{
    return ask(session, make_group, &(call_t){name, group, diag});
}

static cm1e_error_t read_group(cm1e_py_session_t *s, void *argument)
{
    const call_t *call = argument;
    return s->bus ? cm1e_group_read(*(const AXES_GROUP_REF_t *)call->in, call->out) : CM1E_ERROR_STATE;
}

cm1e_error_t cm1e_py_group_read(cm1e_py_session_t *session, AXES_GROUP_REF_t group, cm1e_group_info_t *info)
{
    return py_owner_do(session, read_group, &(call_t){.in = &group, .out = info});
}

typedef struct error_text {
    AXIS_REF_t axis;
    AXES_GROUP_REF_t group;
    char *text;
    size_t size;
} error_text_t;

static cm1e_error_t read_error_text(cm1e_py_session_t *s, void *argument)
{
    const error_text_t *wanted = argument;
    if (s->scheduler && wanted->axis.Handle != 0)
        cm1e_axis_error_text(wanted->axis, wanted->text, wanted->size);
    else if (s->scheduler && wanted->group.Handle != 0)
        cm1e_group_error_text(wanted->group, wanted->text, wanted->size);
    return CM1E_OK;
}

void cm1e_py_error_text(cm1e_py_session_t *session, AXIS_REF_t axis, AXES_GROUP_REF_t group, char *text, size_t size)
{
    text[0] = '\0';
    (void)py_owner_do(session, read_error_text, &(error_text_t){axis, group, text, size});
}
