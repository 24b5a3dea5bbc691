#include "scheduler/signals.h"

#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>

/** What ends or suspends a program by default, from outside or from a write of its own; any of it while a motor moves
 *  would leave that motor without a ramp. Not here: SIGKILL and SIGSTOP, which nobody can take; signals of a crash; and
 *  those that a program uses for itself (SIGUSR1, SIGALRM ...). */
static const struct {
    int number;
    bool is_order; /**< to end: it counts also where it was ignored before, as a shell ignores SIGINT of what it runs in
                        the background. The others end nothing while they are ignored (nohup), so they stay so */
} signals[] = {
    {SIGINT, true},   {SIGTERM, true},
    {SIGHUP, false},  /* the terminal is closed, the connection to it is lost */
    {SIGQUIT, false}, {SIGTSTP, false}, /* Ctrl-\, Ctrl-Z: while the program is suspended, no frame is sent */
    {SIGPIPE, false}, /* whoever read our output is gone */
    {SIGXCPU, false}, {SIGXFSZ, false}, /* limits of time and of the size of a file (trace, pcap) */
};
enum { SIGNALS = sizeof signals / sizeof signals[0] };

static _Atomic(cm1e_scheduler_t *) attached;
static struct sigaction before[SIGNALS];
static bool taken[SIGNALS];

/** Only what is async-signal-safe: two lock-free atomic accesses. A second signal finds the run ending already and
 *  changes nothing: the ramp is bounded by itself. */
static void on_signal(int number)
{
    (void)number;
    cm1e_scheduler_t *scheduler = atomic_load(&attached);
    if (scheduler)
        cm1e_scheduler_stop(scheduler);
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
    if (atomic_load(&attached) != scheduler)
        return;
    for (int i = 0; i < SIGNALS; i++)
        if (taken[i])
            sigaction(signals[i].number, &before[i], NULL);
    atomic_store(&attached, NULL);
}
