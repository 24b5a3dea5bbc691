/*
 * The bus of LinuxCNC, as a process of its own. The HAL component cm1e starts it, and shares a stream_link_t with it. A
 * process of its own stops the axes in order also if LinuxCNC is killed, and it needs no rights of rtapi_app.
 */
#include <argp.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

#include "stream_bus.h"

typedef struct options {
    stream_options_t stream;
    int link;
} options_t;

enum { LINK = 256, DELAY, TOLERANCE, TIMEOUT };

static const struct argp_option list[] = {
    {"bus", 'b', "FILE", 0, "bus file", 0},
    {"interface", 'i', "NAME", 0, "network interface; default: that of the bus file", 0},
    {"delay", DELAY, "PERIODS", 0, "servo periods that the axes are behind LinuxCNC; default: 4", 0},
    {"tolerance", TOLERANCE, "UNITS", 0, "distance from LinuxCNC to an axis at machine-on; default: 1000 counts", 0},
    {"timeout", TIMEOUT, "MS", 0, "silence of LinuxCNC that stops all axes; default: 20", 0},
    {"link", LINK, "NUMBER", 0, "file descriptor that is shared with the HAL component", 0},
    {0},
};

static double number(const char *text, struct argp_state *state)
{
    char *end;
    const double value = strtod(text, &end);
    if (end == text || *end || !(value >= 0.0 && value <= 1e9))
        argp_error(state, "\"%s\" is not a number from 0 to 1e9", text);
    return value;
}

static error_t parse(int key, char *argument, struct argp_state *state)
{
    options_t *o = state->input;
    switch (key) {
    case 'b': o->stream.bus_file = argument; return 0;
    case 'i': o->stream.interface_name = argument; return 0;
    case DELAY: o->stream.delay_periods = number(argument, state); return 0;
    case TOLERANCE: o->stream.tolerance = number(argument, state); return 0;
    case TIMEOUT: o->stream.timeout_ns = (int64_t)(number(argument, state) * 1e6); return 0;
    case LINK: o->link = (int)number(argument, state); return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

int main(int argc, char **argv)
{
    const struct argp argp = {list, parse, NULL, "The EtherCAT bus of the HAL component cm1e, which starts it.", NULL,
                              NULL, NULL};
    options_t options = {.link = -1};
    argp_parse(&argp, argc, argv, 0, NULL, &options);
    const pid_t starter = getppid();
    if (prctl(PR_SET_PDEATHSIG, SIGTERM) != 0 || getppid() != starter)
        return EXIT_FAILURE;
    stream_link_t *link = mmap(NULL, sizeof *link, PROT_READ | PROT_WRITE, MAP_SHARED, options.link, 0);
    if (link == MAP_FAILED || link->version != STREAM_VERSION || link->bytes != sizeof *link) {
        fprintf(stderr, "cm1e-linuxcnc: it is started by the HAL component cm1e of the same version: loadrt cm1e "
                        "bus=FILE\n");
        return EXIT_FAILURE;
    }
    const cm1e_error_t error = stream_bus_run(link, &options.stream, true);
    if (getppid() != starter)
        fprintf(stderr, "cm1e: LinuxCNC ended without unloading cm1e. All axes were ramped down and disabled.\n");
    fprintf(stderr, "cm1e: %s\n", link->text);
    return error == CM1E_OK ? EXIT_SUCCESS : EXIT_FAILURE;
}
