/** cm1e sim: a simulated network on a network interface, for any master. */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cm1e/sim.h"
#include "choose_bus.h"
#include "files.h"
#include "prove/prove_play.h"

static volatile int stop_requested;

static void request_stop(int signal_number)
{
    (void)signal_number;
    stop_requested = 1;
}

enum { KEY_SII = 0x400, KEY_BRIDGE, KEY_IO, KEY_PROFILE, KEY_SECOND, KEY_NETWORK };

typedef struct sim_options {
    const char *interface_name, *second, *bus_file, *order, *network;
    const char *sii[CM1E_MAX_SLAVES]; /* files, by place on the line */
    const char *profiles[CM1E_MAX_SLAVES]; /* likewise */
    uint32_t sii_count, profile_count;
    const struct extra *extras[CM1E_MAX_SLAVES]; /* behind the other slaves, in the order of the command line */
    uint32_t extra_count;
    bool has_bridges;
} sim_options_t;

static const struct extra {
    int key;
    const char *word;
    int model; /* cm1e_device_model_t of a bridge, cm1e_sim_io_t */
} extras[] = {
    {KEY_BRIDGE, "eb01", CM1E_DEVICE_EB01}, {KEY_BRIDGE, "eb02", CM1E_DEVICE_EB02},
    {KEY_BRIDGE, "eb12", CM1E_DEVICE_EB12}, {KEY_IO, "module", CM1E_SIM_IO_MODULE},
    {KEY_IO, "terminal", CM1E_SIM_IO_TERMINAL}, {KEY_IO, "coupler", CM1E_SIM_IO_COUPLER},
};
enum { EXTRAS = sizeof extras / sizeof extras[0] };

#define ORDERS "ug-4.4|ug-7.2"
#define BRIDGES "eb01|eb02|eb12"
#define IO_KINDS "module|terminal|coupler"

static error_t take_extra(sim_options_t *options, int key, const char *word, struct argp_state *state)
{
    const bool bridge = key == KEY_BRIDGE;
    if (choose_word(bridge ? "bridge" : "simple device", word, bridge ? BRIDGES : IO_KINDS) < 0)
        return EINVAL;
    int i = 0;
    while (i < EXTRAS && (extras[i].key != key || strcasecmp(extras[i].word, word) != 0))
        i++;
    if (options->extra_count == CM1E_MAX_SLAVES)
        argp_error(state, "a segment has %d slaves at most", CM1E_MAX_SLAVES);
    else
        options->extras[options->extra_count++] = &extras[i];
    options->has_bridges |= bridge;
    return 0;
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    sim_options_t *options = state->input;
    switch (key) {
    case 'i':
        if (!arg[0])
            argp_error(state, "-i needs a name; it is empty");
        options->interface_name = arg;
        return 0;
    case KEY_SECOND: options->second = arg; return 0;
    case 'o': options->order = arg; return 0;
    case KEY_NETWORK: options->network = arg; return 0;
    case KEY_SII:
        if (options->sii_count == CM1E_MAX_SLAVES)
            argp_error(state, "a segment has %d slaves at most", CM1E_MAX_SLAVES);
        options->sii[options->sii_count++] = arg;
        return 0;
    case KEY_PROFILE:
        if (options->profile_count == CM1E_MAX_SLAVES)
            argp_error(state, "a segment has %d slaves at most", CM1E_MAX_SLAVES);
        options->profiles[options->profile_count++] = arg;
        return 0;
    case KEY_BRIDGE:
    case KEY_IO: return take_extra(options, key, arg, state);
    case ARGP_KEY_ARG:
        if (options->bus_file)
            argp_error(state, "one bus file is enough; \"%s\" is too many", arg);
        options->bus_file = arg;
        return 0;
    case ARGP_KEY_END:
        if (!options->interface_name)
            argp_error(state, "the network interface is missing: -i INTERFACE");
        if (strcmp(options->interface_name, "sim") == 0)
            argp_error(state, "\"sim\" is a network within the program that uses it (cm1e scan -i sim); cm1e sim serves one "
                       "on a network interface");
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static bool describe(const sim_options_t *options, cm1e_bus_config_t *config)
{
    const uint32_t axes = options->has_bridges ? 0 : options->sii_count > options->profile_count ? options->sii_count
                          : options->profile_count > 0 ? options->profile_count : 1;
    const common_options_t network = {.bus_file = options->bus_file, .network = options->network};
    if (options->bus_file ? !load_chosen_bus(&network, config) : cm1e_bus_config_init(config, "sim", axes) != CM1E_OK)
        return false;
    const int order = options->order ? choose_word("PDO order", options->order, ORDERS) : 0;
    if (order < 0)
        return false;
    config->sim_pdo_order = options->order ? (cm1e_pdo_order_t)order : config->sim_pdo_order;
    return true;
}

static cm1e_error_t add_extra(cm1e_sim_segment_t *segment, const struct extra *extra)
{
    return extra->key == KEY_BRIDGE ? cm1e_sim_segment_add_bridge(segment, (cm1e_device_model_t)extra->model)
                                    : cm1e_sim_segment_add_io(segment, (cm1e_sim_io_t)extra->model);
}

static bool add_extras(cm1e_sim_segment_t *segment, const sim_options_t *options)
{
    for (uint32_t i = 0; i < options->extra_count; i++) {
        const struct extra *extra = options->extras[i];
        if (add_extra(segment, extra) != CM1E_OK) {
            complain("the simulated slave \"%s\" cannot be made: out of memory, or more than %d slaves", extra->word,
                     CM1E_MAX_SLAVES);
            return false;
        }
    }
    return true;
}

static bool can_read(const char *const *files, uint32_t count)
{
    bool good = true;
    for (uint32_t i = 0; i < count && good; i++) {
        input_t input;
        good = read_input(files[i], &input);
        free(input.bytes);
    }
    return good;
}

/* The nth file is the SII of the nth slave. */
static bool boot(cm1e_sim_segment_t *segment, const sim_options_t *options)
{
    bool good = true;
    for (uint32_t i = 0; i < options->sii_count && good; i++) {
        cm1e_diag_t diag = {0};
        input_t image;
        good = read_input(options->sii[i], &image);
        if (good && cm1e_sim_segment_boot(segment, i + 1, image.bytes, image.size, &diag) != CM1E_OK) {
            complain("%s: %s", options->sii[i], diag.text);
            good = false;
        }
        free(image.bytes);
    }
    return good;
}

/* The nth file is the profile of the nth slave. */
static bool play(cm1e_sim_segment_t *segment, const sim_options_t *options)
{
    for (uint32_t i = 0; i < options->profile_count; i++)
        if (!play_profile(segment, i + 1, options->profiles[i]))
            return false;
    return true;
}

static void end_by_signals(void)
{
    static const int ends[] = {SIGINT, SIGTERM, SIGQUIT, SIGPIPE};
    const struct sigaction action = {.sa_handler = request_stop};
    struct sigaction before;
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++)
        sigaction(ends[i], &action, NULL);
    if (sigaction(SIGHUP, NULL, &before) == 0 && before.sa_handler != SIG_IGN) /* else: nohup */
        sigaction(SIGHUP, &action, NULL);
}

static cm1e_error_t open_server(cm1e_sim_server_t **server, cm1e_sim_segment_t *segment, const sim_options_t *options,
                                cm1e_diag_t *diag)
{
    return options->second ? cm1e_sim_server_open_ring(server, segment, options->interface_name, options->second, diag)
                           : cm1e_sim_server_open(server, segment, options->interface_name, diag);
}

static cm1e_error_t serve(cm1e_sim_segment_t *segment, const sim_options_t *options, cm1e_diag_t *diag)
{
    static const cm1e_sim_streams_t console = {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO};
    cm1e_sim_server_t *server;
    const cm1e_error_t error = open_server(&server, segment, options, diag);
    if (error != CM1E_OK)
        return error;
    end_by_signals();
    printf("%u simulated slave%s on %s%s%s; `help` lists the commands\n", cm1e_sim_segment_slave_count(segment),
           cm1e_sim_segment_slave_count(segment) == 1 ? "" : "s", options->interface_name,
           options->second ? " and " : "", options->second ? options->second : "");
    fflush(stdout);
    cm1e_sim_server_run(server, &console, &stop_requested);
    cm1e_sim_server_close(server);
    return CM1E_OK;
}

static const struct argp_option table[] = {
    {"interface", 'i', "INTERFACE", 0, "Network interface to answer on", 0},
    {"second-interface", KEY_SECOND, "INTERFACE", 0, "Network interface at the other end of a redundant ring, behind the "
     "last slave", 0},
    {"pdo-order", 'o', ORDERS, 0, "The order of objects in the PDO mappings; default ug-4.4", 0},
    {"network", KEY_NETWORK, "NAME", 0, "Of a bus file with several buses: this one, by its name or interface", 0},
    {"sii", KEY_SII, "FILE", 0, "A slave boots from this SII image instead of the tables; the first option is for "
     "the first slave, the second for the second, and so on", 0},
    {"profile", KEY_PROFILE, "FILE", 0, "A slave behaves as the device of this profile, which `cm1e prove` has "
     "written; the first option is for the first slave, the second for the second, and so on", 0},
    {"bridge", KEY_BRIDGE, BRIDGES, 0, "A Cool MUSCLE Bridge with four motors behind the other slaves; repeat it for "
     "another one", 0},
    {"io", KEY_IO, IO_KINDS, 0, "A simple device behind the other slaves: module (8 outputs wired to 8 inputs), "
     "terminal (4 and 4, with device emulation) or coupler (no process data, with device emulation); repeat it for "
     "another one", 0},
    {0}};
const struct argp argp_sim = {
    table, parse, "[BUS-FILE]",
    "Serves a simulated network until Ctrl-C, or until its terminal is closed. Without a bus file it has one "
    "CM1-E-17S30D, firmware 1.3.5, or one for each SII image, or none with --bridge. It takes commands on standard "
    "input; `help` lists them.", NULL, NULL, NULL};

int command_sim(int argc, char **argv)
{
    sim_options_t options = {0};
    if (parse_options(&argp_sim, argc, argv, &options))
        return EXIT_WRONG_USE;

    static cm1e_bus_config_t config;
    if (!can_read(options.sii, options.sii_count) || !can_read(options.profiles, options.profile_count) ||
        !describe(&options, &config))
        return EXIT_WRONG_USE;
    cm1e_diag_t diag = {0};
    cm1e_sim_segment_t *segment = cm1e_sim_segment_create(&config, &diag);
    if (!segment)
        return fail(&diag);
    if (!add_extras(segment, &options) || !boot(segment, &options) || !play(segment, &options)) {
        cm1e_sim_segment_destroy(segment);
        return EXIT_FAILED;
    }
    const cm1e_error_t error = serve(segment, &options, &diag);
    cm1e_sim_segment_destroy(segment);
    return error == CM1E_OK ? EXIT_OK : fail(&diag);
}
