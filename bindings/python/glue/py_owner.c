#include "py_owner.h"

#include <signal.h>
#include <time.h>

enum { POLL_NS = 100000 };

static void rest(void)
{
    const struct timespec time = {.tv_nsec = POLL_NS};
    nanosleep(&time, NULL);
}

/* ---- the owner --------------------------------------------------------------------------------------------------- */

/** Does the job that was handed over, if there is one. */
static bool do_one(cm1e_py_session_t *s)
{
    py_job_t *job = atomic_exchange_explicit(&s->job, NULL, memory_order_acquire);
    if (!job)
        return false;
    s->bus = job->network < s->bus_count ? s->buses[job->network] : s->bus;
    job->result = job->act(s, job->argument);
    s->bus = s->buses[0];
    atomic_store_explicit(&job->done, true, memory_order_release);
    return true;
}

static bool may_go_on(const cm1e_py_session_t *s, bool in_program)
{
    return in_program ? s->granted > 0 || atomic_load(&s->stopping) : s->begin || s->quit;
}

/** Waits and does jobs until the owner may go on. */
static void serve(cm1e_py_session_t *s, bool in_program)
{
    pthread_mutex_lock(&s->mutex);
    s->waits = true;
    pthread_cond_broadcast(&s->changed);
    while (!may_go_on(s, in_program)) {
        if (do_one(s))
            pthread_cond_broadcast(&s->changed);
        else
            pthread_cond_wait(&s->changed, &s->mutex);
    }
    s->waits = false;
    if (in_program && s->granted > 0) {
        s->granted--;
        s->advanced++;
    }
    pthread_mutex_unlock(&s->mutex);
}

static void call_blocks(cm1e_py_session_t *s)
{
    for (uint32_t i = 0; i < s->block_count; i++) {
        cm1e_py_block_t *block = s->blocks[i];
        int ended = 0;
        block->call(block->fb);
        for (uint32_t n = 0; n < block->end_count; n++)
            ended |= ((const BOOL *)block->fb)[block->ends[n]];
        __atomic_store_n(&block->ended, ended, __ATOMIC_RELEASE);
    }
}

/** Whoever waits for a block gets the cycle in which it ended, and no later one. */
static void look_at_watched(cm1e_py_session_t *s)
{
    pthread_mutex_lock(&s->mutex);
    if (s->watched && cm1e_py_block_ended(s->watched))
        s->granted = 0;
    pthread_mutex_unlock(&s->mutex);
}

/** The program of the scheduler. */
static void program(void *context)
{
    cm1e_py_session_t *s = context;
    atomic_store_explicit(&s->in_cycle, true, memory_order_release);
    if (s->virtual_time)
        serve(s, true);
    else
        do_one(s);
    call_blocks(s);
    if (s->virtual_time)
        look_at_watched(s);
}

static void run(cm1e_py_session_t *s)
{
    const cm1e_task_config_t task = {.name = "python", .program = program, .context = s};
    cm1e_diag_t diag = {0};
    cm1e_error_t error = cm1e_scheduler_add_task(s->scheduler, &task, &diag);
    if (error == CM1E_OK)
        error = cm1e_scheduler_run(s->scheduler, 0, &diag);
    pthread_mutex_lock(&s->mutex);
    s->result = error;
    s->diag = diag;
    s->begin = false;
    atomic_store(&s->running, false);
    pthread_cond_broadcast(&s->changed);
    pthread_mutex_unlock(&s->mutex);
}

static void *own(void *context)
{
    cm1e_py_session_t *s = context;
    for (;;) {
        serve(s, false);
        if (s->quit)
            return NULL;
        run(s);
    }
}

static _Thread_local uint32_t selected;

void cm1e_py_select(uint32_t network) { selected = network; }
uint32_t py_owner_selected(void) { return selected; }

/* ---- the callers ------------------------------------------------------------------------------------------------- */

cm1e_error_t py_owner_begin(cm1e_py_session_t *s, cm1e_diag_t *diag)
{
    sigset_t all, before;
    pthread_mutex_init(&s->callers, NULL);
    pthread_mutex_init(&s->mutex, NULL);
    pthread_cond_init(&s->changed, NULL);
    sigfillset(&all); /* signals are for Python's threads */
    pthread_sigmask(SIG_SETMASK, &all, &before);
    const int failed = pthread_create(&s->owner, NULL, own, s);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (failed)
        s->quit = s->joined = true;
    return failed ? cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "The thread of the bus cannot be made.") : CM1E_OK;
}

cm1e_error_t py_owner_do(cm1e_py_session_t *s, cm1e_error_t (*act)(cm1e_py_session_t *, void *), void *argument)
{
    py_job_t job = {.act = act, .argument = argument, .network = selected};
    cm1e_error_t result = CM1E_ERROR_STATE;
    pthread_mutex_lock(&s->callers);
    pthread_mutex_lock(&s->mutex);
    if (!s->quit && !s->joined) {
        atomic_store_explicit(&s->job, &job, memory_order_release);
        pthread_cond_broadcast(&s->changed);
        while (!atomic_load_explicit(&job.done, memory_order_acquire)) {
            if (s->waits) {
                pthread_cond_wait(&s->changed, &s->mutex);
                continue;
            }
            pthread_mutex_unlock(&s->mutex); /* the cycle in real time tells nobody: that would be a system call */
            rest();
            pthread_mutex_lock(&s->mutex);
        }
        result = job.result;
    }
    pthread_mutex_unlock(&s->mutex);
    pthread_mutex_unlock(&s->callers);
    return result;
}

void py_owner_end_run(cm1e_py_session_t *s)
{
    pthread_mutex_lock(&s->mutex);
    atomic_store(&s->stopping, true);
    if (s->scheduler)
        cm1e_scheduler_stop(s->scheduler);
    pthread_cond_broadcast(&s->changed);
    while (atomic_load(&s->running) || (!s->waits && !s->quit)) /* behind a run it takes jobs again */
        pthread_cond_wait(&s->changed, &s->mutex);
    pthread_mutex_unlock(&s->mutex);
}

void py_owner_join(cm1e_py_session_t *s)
{
    pthread_mutex_lock(&s->callers);
    pthread_mutex_lock(&s->mutex);
    const bool joins = !s->joined;
    s->quit = s->joined = true;
    pthread_cond_broadcast(&s->changed);
    pthread_mutex_unlock(&s->mutex);
    if (joins)
        pthread_join(s->owner, NULL);
    pthread_mutex_unlock(&s->callers);
}

bool cm1e_py_runs(cm1e_py_session_t *s) { return atomic_load(&s->running); }

bool cm1e_py_block_ended(const cm1e_py_block_t *block) { return __atomic_load_n(&block->ended, __ATOMIC_ACQUIRE) != 0; }

cm1e_error_t cm1e_py_advance(cm1e_py_session_t *s, uint64_t cycles, const cm1e_py_block_t *block, uint64_t *advanced)
{
    cm1e_error_t result = CM1E_ERROR_STATE;
    *advanced = 0;
    pthread_mutex_lock(&s->callers);
    pthread_mutex_lock(&s->mutex);
    if (s->virtual_time && atomic_load(&s->running) && cycles > 0) {
        s->granted = cycles;
        s->advanced = 0;
        s->watched = block;
        pthread_cond_broadcast(&s->changed);
        while (atomic_load(&s->running) && !(s->waits && s->granted == 0))
            pthread_cond_wait(&s->changed, &s->mutex);
        *advanced = s->advanced;
        s->watched = NULL;
        s->granted = 0;
        result = CM1E_OK;
    }
    pthread_mutex_unlock(&s->mutex);
    pthread_mutex_unlock(&s->callers);
    return result;
}

bool cm1e_py_wait(cm1e_py_session_t *s, const cm1e_py_block_t *block, int64_t timeout_ns)
{
    for (int64_t waited_ns = 0; waited_ns < timeout_ns && cm1e_py_runs(s); waited_ns += POLL_NS) {
        if (cm1e_py_block_ended(block))
            return true;
        rest();
    }
    return cm1e_py_block_ended(block);
}

void py_owner_let_a_cycle_pass(cm1e_py_session_t *s)
{
    const struct timespec moment = {.tv_nsec = 500000};
    uint64_t advanced;
    if (cm1e_py_advance(s, 1, NULL, &advanced) != CM1E_OK)
        nanosleep(&moment, NULL);
}
