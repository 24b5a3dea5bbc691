#include "scheduler/signals.h"

#include <signal.h>
#include <stdatomic.h>

static const int signals[] = {SIGINT, SIGTERM};
enum { SIGNALS = sizeof signals / sizeof signals[0] };

static _Atomic(cm1e_scheduler_t *) attached;
static struct sigaction before[SIGNALS];

/** Only what is async-signal-safe: two lock-free atomic accesses. */
static void on_signal(int number)
{
    (void)number;
    cm1e_scheduler_t *scheduler = atomic_load(&attached);
    if (scheduler)
        cm1e_scheduler_stop(scheduler);
}

void signals_attach(cm1e_scheduler_t *scheduler)
{
    struct sigaction action = {.sa_handler = on_signal, .sa_flags = SA_RESTART};
    const bool already = atomic_exchange(&attached, scheduler) != NULL;
    sigemptyset(&action.sa_mask);
    for (int i = 0; i < SIGNALS && !already; i++)
        sigaction(signals[i], &action, &before[i]);
}

void signals_detach(const cm1e_scheduler_t *scheduler)
{
    if (atomic_load(&attached) != scheduler)
        return;
    for (int i = 0; i < SIGNALS; i++)
        sigaction(signals[i], &before[i], NULL);
    atomic_store(&attached, NULL);
}
