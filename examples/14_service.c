/*
 * A program as a service of systemd: it says when it is ready, and as long as its cycle goes on. The drive is enabled
 * and holds its position; SIGTERM ends it in order. docs/REALTIME.md has the unit.
 *
 *     14_service           the simulated segment
 *     14_service eth1      the first slave on that network interface gets torque!
 */
#include <pthread.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

#include <cm1e/plcopen.h>
#include <cm1e/scheduler.h>

static cm1e_scheduler_t *scheduler;
static AXIS_REF_t axis;
static MC_Power_t power = {.Axis = &axis, .EnablePositive = TRUE, .EnableNegative = TRUE};
static atomic_bool ready, over;

static void program(void *context)
{
    (void)context;
    power.Enable = TRUE;
    MC_Power(&power);
    ready = power.Status;
}

/* Tells systemd a line, without libsystemd: a datagram to the socket that it names. */
static void notify(const char *line)
{
    const char *path = getenv("NOTIFY_SOCKET");
    struct sockaddr_un address = {.sun_family = AF_UNIX};
    if (!path || !path[0] || strlen(path) >= sizeof address.sun_path)
        return;
    strcpy(address.sun_path, path);
    if (path[0] == '@') /* an abstract name */
        address.sun_path[0] = '\0';
    const socklen_t length = (socklen_t)(offsetof(struct sockaddr_un, sun_path) + strlen(path));
    const int file = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (file >= 0) {
        sendto(file, line, strlen(line), MSG_NOSIGNAL, (struct sockaddr *)&address, length);
        close(file);
    }
}

/* Beside the cycle, ten times a second: the watchdog is fed only if the cycle has gone on since the last look. */
static void *watch(void *context)
{
    (void)context;
    const struct timespec pause = {.tv_nsec = 100000000};
    bool told = false;
    uint64_t before = 0;
    while (!over) {
        cm1e_scheduler_statistics_t statistics;
        cm1e_scheduler_statistics(scheduler, &statistics);
        if (ready && !told)
            notify("READY=1\nSTATUS=the motor holds its position");
        told = told || ready;
        if (statistics.cycles != before)
            notify("WATCHDOG=1");
        before = statistics.cycles;
        nanosleep(&pause, NULL);
    }
    notify("STOPPING=1");
    return NULL;
}

static cm1e_error_t run(const char *interface_name, cm1e_bus_t **bus, cm1e_diag_t *why)
{
    cm1e_bus_config_t config;
    const cm1e_task_config_t task = {.name = "hold", .program = program};
    cm1e_error_t error = cm1e_bus_config_init(&config, interface_name, 1);
    if (error != CM1E_OK)
        return cm1e_diag_set(why, error, 0, "%s", cm1e_strerror(error));
    error = cm1e_bus_open(bus, &config, why);
    cm1e_bus_config_free(&config);
    if (error == CM1E_OK)
        error = cm1e_bus_start(*bus, why);
    if (error == CM1E_OK)
        error = cm1e_scheduler_create(&scheduler, *bus, NULL, why);
    if (error != CM1E_OK)
        return error;
    axis = cm1e_scheduler_axis(scheduler, 0);
    cm1e_scheduler_stop_on_signals(scheduler); /* SIGTERM: ramps down, disables, takes the slaves down */
    error = cm1e_scheduler_add_task(scheduler, &task, why);
    pthread_t thread;
    if (error != CM1E_OK || pthread_create(&thread, NULL, watch, NULL) != 0)
        return error;
    error = cm1e_scheduler_run(scheduler, 0, why);
    over = true;
    pthread_join(thread, NULL);
    return error;
}

int main(int argc, char **argv)
{
    cm1e_diag_t why = {0};
    cm1e_bus_t *bus = NULL;
    const cm1e_error_t error = run(argc > 1 ? argv[1] : "sim", &bus, &why);
    if (error != CM1E_OK)
        fprintf(stderr, "%s\n", why.text);
    cm1e_scheduler_destroy(scheduler);
    cm1e_bus_close(bus);
    return error == CM1E_OK ? 0 : 1;
}
