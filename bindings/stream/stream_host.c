#include "stream_host.h"

#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "stream_bus.h"

enum { POLL_NS = 5000000 };

struct stream_host {
    stream_link_t link;
    stream_options_t options;
    char *bus_file, *interface_name;
    pthread_t thread;
    bool started;
};

static void *own(void *context)
{
    stream_host_t *host = context;
    (void)stream_bus_run(&host->link, &host->options, false);
    return NULL;
}

static void destroy(stream_host_t *host)
{
    free(host->bus_file);
    free(host->interface_name);
    free(host);
}

static stream_phase_t phase_of(const stream_host_t *host)
{
    return (stream_phase_t)atomic_load_explicit(&host->link.phase, memory_order_acquire);
}

/* Signals are for the threads of the control. */
static bool start(stream_host_t *host)
{
    const struct timespec pause = {.tv_nsec = POLL_NS};
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    host->started = pthread_create(&host->thread, NULL, own, host) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    while (host->started && phase_of(host) == STREAM_STARTING)
        nanosleep(&pause, NULL);
    return host->started && phase_of(host) == STREAM_RUNNING;
}

stream_host_t *stream_host_open(const stream_host_config_t *config, char *why, size_t size)
{
    stream_host_t *host = aligned_alloc(_Alignof(stream_host_t), sizeof *host);
    if (!host) {
        snprintf(why, size, "No memory for the bus.");
        return NULL;
    }
    memset(host, 0, sizeof *host);
    stream_link_init(&host->link, config->period_ns);
    host->bus_file = strdup(config->bus_file ? config->bus_file : "");
    host->interface_name = config->interface_name && config->interface_name[0] ? strdup(config->interface_name) : NULL;
    host->options = (stream_options_t){
        .bus_file = host->bus_file, .interface_name = host->interface_name, .delay_periods = config->delay_periods,
        .tolerance = config->tolerance, .timeout_ns = config->timeout_ns,
        .realtime_priority = config->realtime_priority, .cpu = config->cpu, .say = config->say,
        .context = config->context};
    if (start(host))
        return host;
    snprintf(why, size, "%s", host->started ? host->link.text : "No thread for the bus.");
    stream_host_close(host);
    return NULL;
}

void stream_host_close(stream_host_t *host)
{
    if (!host)
        return;
    atomic_store(&host->link.quit, 1);
    if (host->started)
        pthread_join(host->thread, NULL);
    destroy(host);
}

bool stream_host_runs(const stream_host_t *host) { return phase_of(host) == STREAM_RUNNING; }

uint32_t stream_host_axis_count(const stream_host_t *host) { return host->link.axis_count; }

const char *stream_host_axis_name(const stream_host_t *host, uint32_t axis)
{
    return axis < host->link.axis_count ? host->link.axis_names[axis] : "";
}

bool stream_host_write(stream_host_t *host, const stream_command_t *command)
{
    return stream_put_command(&host->link, command);
}

bool stream_host_read(stream_host_t *host, stream_state_t *state) { return stream_take_state(&host->link, state); }
