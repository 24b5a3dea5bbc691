#include "scheduler/signals.h"

#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <time.h>

/** Signals that end or suspend a program by default, from outside or because of its own write. During a motion each of
 *  them would leave the motor without a ramp. Not in the list: SIGKILL and SIGSTOP, which cannot be caught, signals of
 *  a crash, and signals that a program uses for itself (SIGUSR1, SIGALRM ...). */
static const struct {
    int number;
    bool is_order; /**< true: it acts even if it was ignored before, because a shell ignores SIGINT for background
                        programs. The others stay ignored if they were (nohup) */
} signals[] = {
    {SIGINT, true},   {SIGTERM, true},
    {SIGHUP, false},  /* the terminal is closed, the connection to it is lost */
    {SIGQUIT, false}, {SIGTSTP, false}, /* Ctrl-\, Ctrl-Z: while the program is suspended, no frame is sent */
    {SIGPIPE, false}, /* the reader of our output has closed it */
    {SIGXCPU, false}, {SIGXFSZ, false}, /* limits of time and of the size of a file (trace, pcap) */
};
enum { SIGNALS = sizeof signals / sizeof signals[0] };

static _Atomic(cm1e_scheduler_t *) attached;
static atomic_int handlers; /**< that are running: in any thread, while another one may destroy the scheduler */
static struct sigaction before[SIGNALS];
static bool taken[SIGNALS];

/** Async-signal-safe: lock-free atomic accesses. A second signal changes nothing, because the run is ending already and
 *  the ramp is bounded. */
static void on_signal(int number)
{
    (void)number;
    atomic_fetch_add(&handlers, 1);
    cm1e_scheduler_t *scheduler = atomic_load(&attached);
    if (scheduler)
        cm1e_scheduler_stop(scheduler);
    atomic_fetch_sub(&handlers, 1);
}

void cm1e_signals_attach(cm1e_scheduler_t *scheduler)
{
    struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_RESTART};
    if (atomic_exchange(&attached, scheduler) != NULL)
        return;
    sigemptyset(&action.sa_mask);
    for (int i = 0; i < SIGNALS; i++) {
        sigaction(signals[i].number, NULL, &before[i]);
        taken[i] = signals[i].is_order || before[i].sa_handler != SIG_IGN;
        if (taken[i])
            sigaction(signals[i].number, &action, NULL);
    }
}

void cm1e_signals_detach(const cm1e_scheduler_t *scheduler)
{
    if (atomic_load(&attached) == scheduler) {
        for (int i = 0; i < SIGNALS; i++)
            if (taken[i])
                sigaction(signals[i].number, &before[i], NULL);
        atomic_store(&attached, NULL);
    }
    /* One that began before has the scheduler, also where another one has replaced it since; its thread may need our
     * processor. */
    while (atomic_load(&handlers) > 0)
        nanosleep(&(struct timespec){.tv_nsec = 100000}, NULL);
}
