#include "served_drives.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cm1e/config.h"
#include "cm1e/sim.h"

static volatile int stop_serving;
static void on_signal(int number) { stop_serving = number; }

static void fail(const char *why)
{
    fprintf(stderr, "the simulated drives: %s\n", why);
    exit(1);
}

static void serve(unsigned drives, int ready)
{
    static const cm1e_sim_streams_t nowhere = {-1, -1, -1};
    cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    cm1e_sim_server_t *server;
    signal(SIGTERM, on_signal);
    if (cm1e_bus_config_init(&config, "sim", drives) != CM1E_OK)
        fail("so many cannot be configured");
    config.virtual_time = true;
    cm1e_sim_segment_t *segment = cm1e_sim_segment_create(&config, &diag);
    if (!segment || cm1e_sim_server_open(&server, segment, "wire1", &diag) != CM1E_OK)
        fail(diag.text);
    if (write(ready, "", 1) != 1)
        fail("nobody waits");
    cm1e_sim_server_run(server, &nowhere, &stop_serving);
    cm1e_sim_server_close(server);
    cm1e_sim_segment_destroy(segment);
    cm1e_bus_config_free(&config);
    exit(0);
}

pid_t served_drives_begin(unsigned drives)
{
    int ready[2];
    char byte;
    if (pipe(ready) != 0)
        fail("no pipe");
    fflush(stdout);
    const pid_t child = fork();
    if (child == 0)
        serve(drives, ready[1]);
    close(ready[1]);
    if (child < 0 || read(ready[0], &byte, 1) != 1)
        fail("they do not start");
    close(ready[0]);
    return child;
}

void served_drives_end(pid_t server)
{
    kill(server, SIGTERM);
    waitpid(server, NULL, 0);
}
