/* Files in slaves (FoE), and files of other masters beside the devices that they describe. */
#include <signal.h>

#include "cm1e/foe.h"
#include "py_owner.h"

typedef struct transfer {
    cm1e_bus_t *bus;             /**< of a run */
    cm1e_py_file_t *file;
    cm1e_diag_t *diag;
    cm1e_error_t result;
    atomic_bool done;
} transfer_t;

static cm1e_error_t transfer_file(cm1e_bus_t *bus, const transfer_t *transfer)
{
    cm1e_py_file_t *file = transfer->file;
    const cm1e_foe_options_t options = {.password = file->password, .bootstrap = file->bootstrap,
                                        .answer_ns = file->answer_ns};
    return file->write ? cm1e_foe_write(bus, file->position, file->name, file->data, file->size, &options, transfer->diag)
                       : cm1e_foe_read(bus, file->position, file->name, file->data, &file->size, &options, transfer->diag);
}

/** Before a run, and behind it, the owner does it. */
static cm1e_error_t transfer_by_owner(cm1e_py_session_t *s, void *argument)
{
    const transfer_t *transfer = argument;
    return s->bus ? transfer_file(s->bus, transfer) : CM1E_ERROR_STATE;
}

/** In a run the cycle transfers the file; a thread of its own waits for it, so that virtual time can pass. */
static void *transfer_in_run(void *argument)
{
    transfer_t *transfer = argument;
    transfer->result = transfer_file(transfer->bus, transfer);
    atomic_store_explicit(&transfer->done, true, memory_order_release);
    return NULL;
}

/** The bus is not closed before the guest has left. */
static bool enter_run(cm1e_py_session_t *s, cm1e_bus_t **bus)
{
    pthread_mutex_lock(&s->mutex);
    *bus = s->buses[py_owner_selected()];
    const bool enters = *bus && atomic_load(&s->running);
    s->guests += enters;
    pthread_mutex_unlock(&s->mutex);
    return enters;
}

static void leave_run(cm1e_py_session_t *s)
{
    pthread_mutex_lock(&s->mutex);
    s->guests--;
    pthread_cond_broadcast(&s->changed);
    pthread_mutex_unlock(&s->mutex);
}

cm1e_error_t cm1e_py_file(cm1e_py_session_t *s, cm1e_py_file_t *file, cm1e_diag_t *diag)
{
    transfer_t transfer = {.file = file, .diag = diag};
    sigset_t all, before;
    pthread_t thread;
    diag->text[0] = '\0';
    if (!enter_run(s, &transfer.bus)) {
        const cm1e_error_t error = py_owner_do(s, transfer_by_owner, &transfer);
        return error == CM1E_ERROR_STATE && !diag->text[0] ? cm1e_diag_set(diag, error, 0, "The bus is closed.") : error;
    }
    sigfillset(&all); /* signals are for Python's threads */
    pthread_sigmask(SIG_SETMASK, &all, &before);
    const int failed = pthread_create(&thread, NULL, transfer_in_run, &transfer);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (failed) {
        leave_run(s);
        return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "The thread of a transfer cannot be made.");
    }
    while (!atomic_load_explicit(&transfer.done, memory_order_acquire))
        py_owner_let_a_cycle_pass(s);
    pthread_join(thread, NULL);
    leave_run(s);
    return transfer.result;
}

/* ---- comparison -------------------------------------------------------------------------------------------------- */

typedef struct comparison {
    cm1e_findings_t **findings;
    const void *bytes;
    size_t size;
    uint16_t position;
    cm1e_diag_t *diag;
} comparison_t;

static cm1e_error_t compare(cm1e_py_session_t *s, void *argument)
{
    const comparison_t *c = argument;
    if (!s->bus || s->ran)
        return cm1e_diag_set(c->diag, CM1E_ERROR_STATE, 0, "Devices are compared before the bus is started, after a scan.");
    return cm1e_diff_file(c->findings, c->bytes, c->size, s->bus, c->position, c->diag);
}

cm1e_error_t cm1e_py_compare(cm1e_py_session_t *session, cm1e_findings_t **findings, const void *bytes, size_t size,
                             uint16_t position, cm1e_diag_t *diag)
{
    diag->text[0] = '\0';
    return py_owner_do(session, compare, &(comparison_t){findings, bytes, size, position, diag});
}
