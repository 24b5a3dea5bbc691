#include "scheduler/task_watch.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "core/in_task.h"

#define MS INT64_C(1000000)

/** A call of a block takes some microseconds. After so much processor time a call that passed no gate is in none. */
static const int64_t grace_ns = 5 * MS;
static const int64_t period_minimum_ns = 1 * MS, period_maximum_ns = 5 * MS;
enum { LOOKS = 5 /* within a limit */, STACK = 64 * 1024 };

/** A signal that ends a program by default and that few programs use for themselves. */
static int own_signal(void) { return SIGRTMAX - 3; }

/* ---- the signal -------------------------------------------------------------------------------------------------- */

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static unsigned watches; /**< under the lock */
static struct sigaction before;

static void on_signal(int number)
{
    const int kept = errno;
    (void)number;
    cm1e_in_task_leave();
    errno = kept;
}

/** SA_NODEFER: the handler may be left by a jump, which keeps the mask of signals. */
static void take_signal(void)
{
    struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_RESTART | SA_NODEFER};
    sigemptyset(&action.sa_mask);
    pthread_mutex_lock(&lock);
    if (watches++ == 0)
        sigaction(own_signal(), &action, &before);
    pthread_mutex_unlock(&lock);
}

static void give_signal_back(void)
{
    pthread_mutex_lock(&lock);
    if (--watches == 0)
        sigaction(own_signal(), &before, NULL);
    pthread_mutex_unlock(&lock);
}

/** In this thread. true: it was allowed before. */
static bool allow_signal(bool allowed)
{
    sigset_t set, kept;
    sigemptyset(&set);
    sigaddset(&set, own_signal());
    pthread_sigmask(allowed ? SIG_UNBLOCK : SIG_BLOCK, &set, &kept);
    return sigismember(&kept, own_signal()) == 0;
}

/** What was taken for the watch, and opened. */
static void give_back(const task_watch_t *watch)
{
    cm1e_in_task_watched(NULL);
    allow_signal(watch->signal_allowed);
    give_signal_back();
    if (watch->state_file >= 0)
        close(watch->state_file);
}

/* ---- the thread -------------------------------------------------------------------------------------------------- */

static int64_t read_clock(clockid_t clock)
{
    struct timespec t = {0};
    clock_gettime(clock, &t);
    return t.tv_sec * INT64_C(1000000000) + t.tv_nsec;
}

/** Whether the thread of the cycle waits in the kernel ("S" in its stat file); not if it only lacks a processor. */
static bool waits(const task_watch_t *watch)
{
    char text[128];
    const ssize_t length = watch->state_file < 0 ? 0 : pread(watch->state_file, text, sizeof text - 1, 0);
    if (length <= 0)
        return false;
    text[length] = '\0';
    const char *end = strrchr(text, ')'); /* "17 (name of the thread) S ..." */
    return end && strncmp(end, ") S", 3) == 0;
}

static void disarm(task_watch_t *watch)
{
    if (watch->armed_ns == 0)
        return;
    watch->armed_ns = 0;
    atomic_fetch_sub(&cm1e_in_task_over, 1);
}

static void arm(task_watch_t *watch)
{
    watch->armed_ns = watch->spent_ns;
    atomic_store(&watch->tasks->leave.over, watch->seen);
    atomic_fetch_add(&cm1e_in_task_over, 1);
}

/** What the call has spent since the last look. */
static int64_t spent_now(task_watch_t *watch)
{
    const int64_t now_ns = read_clock(CLOCK_MONOTONIC), computed_ns = read_clock(watch->clock);
    const int64_t elapsed = now_ns - watch->at_ns, computed = computed_ns - watch->computed_ns;
    watch->at_ns = now_ns;
    watch->computed_ns = computed_ns;
    if (computed < elapsed / 2 && waits(watch))
        return elapsed < 2 * watch->period_ns ? elapsed : 2 * watch->period_ns; /* the machine may have stood still */
    return computed;
}

static void look(task_watch_t *watch)
{
    const uint64_t call = atomic_load(&watch->tasks->leave.call);
    const int64_t spent = spent_now(watch);
    if (call != watch->seen) {
        disarm(watch);
        watch->seen = call;
        watch->spent_ns = 0;
        return;
    }
    const task_t *task = cm1e_tasks_called(watch->tasks, call);
    if (!task || task->limit_ns == 0)
        return;
    watch->spent_ns += spent;
    if (watch->spent_ns < task->limit_ns)
        return;
    if (watch->armed_ns == 0)
        arm(watch);
    else if (watch->spent_ns - watch->armed_ns >= grace_ns)
        pthread_kill(watch->cycle, own_signal());
}

static void *run(void *context)
{
    task_watch_t *watch = context;
    const struct timespec period = {.tv_nsec = (long)watch->period_ns};
    while (!atomic_load(&watch->ends)) {
        clock_nanosleep(CLOCK_MONOTONIC, 0, &period, NULL);
        look(watch);
    }
    disarm(watch);
    return NULL;
}

/* ---- begin and end ----------------------------------------------------------------------------------------------- */

static int64_t shortest_limit(const task_list_t *tasks)
{
    int64_t shortest = 0;
    for (uint32_t i = 0; i < tasks->count; i++)
        if (tasks->tasks[i].limit_ns && (!shortest || tasks->tasks[i].limit_ns < shortest))
            shortest = tasks->tasks[i].limit_ns;
    return shortest;
}

static int open_state(void)
{
    char path[64];
    snprintf(path, sizeof path, "/proc/self/task/%ld/stat", (long)syscall(SYS_gettid));
    return open(path, O_RDONLY | O_CLOEXEC);
}

/** A small stack: memory may be locked, and that of the thread with it. */
static bool start(task_watch_t *watch)
{
    pthread_attr_t attributes;
    sigset_t all, kept;
    if (pthread_attr_init(&attributes) != 0)
        return false;
    pthread_attr_setstacksize(&attributes, (size_t)PTHREAD_STACK_MIN + STACK);
    sigfillset(&all); /* signals of the program are for its own threads */
    pthread_sigmask(SIG_SETMASK, &all, &kept);
    watch->runs = pthread_create(&watch->thread, &attributes, run, watch) == 0;
    pthread_sigmask(SIG_SETMASK, &kept, NULL);
    pthread_attr_destroy(&attributes);
    return watch->runs;
}

cm1e_error_t cm1e_task_watch_begin(task_watch_t *watch, task_list_t *tasks, cm1e_diag_t *diag)
{
    const int64_t shortest = shortest_limit(tasks), period_ns = shortest / LOOKS;
    if (shortest == 0)
        return CM1E_OK;
    *watch = (task_watch_t){.tasks = tasks, .cycle = pthread_self()};
    watch->period_ns = period_ns < period_minimum_ns ? period_minimum_ns
                       : period_ns > period_maximum_ns ? period_maximum_ns : period_ns;
    if (pthread_getcpuclockid(watch->cycle, &watch->clock) != 0)
        return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "The watch over the tasks cannot read processor times.");
    watch->state_file = open_state();
    take_signal();
    watch->signal_allowed = allow_signal(true);
    cm1e_in_task_watched(&tasks->leave);
    if (start(watch))
        return CM1E_OK;
    give_back(watch);
    return cm1e_diag_set(diag, CM1E_ERROR_NO_MEMORY, 0, "No thread for the watch over the tasks. Without it a program "
                         "that does not return would take the set-points from the motors. Raise the limits of the "
                         "process (ulimit -u, memory), or set watchdog_cycles of its tasks to -1.");
}

void cm1e_task_watch_raise(const task_watch_t *watch, int priority)
{
    const struct sched_param parameters = {.sched_priority = priority + 1};
    if (watch->runs)
        pthread_setschedparam(watch->thread, SCHED_FIFO, &parameters);
}

void cm1e_task_watch_end(task_watch_t *watch)
{
    if (!watch->runs)
        return;
    atomic_store(&watch->ends, true);
    pthread_join(watch->thread, NULL);
    watch->runs = false;
    give_back(watch);
}
