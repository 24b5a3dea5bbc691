#include "attach.h"
#include "which_slave.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { KEY_ATTACH = 0x700 };

static const struct argp_option option_table[] = {
    {"attach", KEY_ATTACH, "PROGRAM", 0,
     "Ask the program that runs the network: its process number, or the path of its control socket. Without this "
     "option the program is found by the network interface", 1},
    {0},
};

static error_t parse_attach(int key, char *arg, struct argp_state *state)
{
    common_options_t *options = state->input;
    if (key != KEY_ATTACH)
        return ARGP_ERR_UNKNOWN;
    if (!arg[0])
        argp_error(state, "--attach needs a process number or a path; it is empty");
    options->attach = arg;
    return 0;
}

static const struct argp attach_argp = {option_table, parse_attach, NULL, NULL, NULL, NULL, NULL};

static error_t parse_both(int key, char *arg, struct argp_state *state)
{
    (void)arg;
    if (key != ARGP_KEY_INIT)
        return ARGP_ERR_UNKNOWN;
    state->child_inputs[0] = state->child_inputs[1] = state->input;
    return 0;
}

static const struct argp_child both_children[] = {{&common_argp, 0, NULL, 0}, {&attach_argp, 0, NULL, 0}, {0}};
static const struct argp both_argp = {NULL, parse_both, NULL, NULL, both_children, NULL, NULL};
const struct argp_child attach_children[] = {{&both_argp, 0, NULL, 0}, {0}};

bool load_network(const common_options_t *options, cm1e_bus_config_t *config)
{
    if (!options->attach || options->interface_name || options->bus_file)
        return load_configuration(options, config);
    return cm1e_bus_config_init(config, NULL, 0) == CM1E_OK;
}

cm1e_error_t connect_network(const common_options_t *options, const cm1e_bus_config_t *config,
                             cm1e_control_t **control, cm1e_diag_t *diag)
{
    /* A stated program may call the network otherwise than a bus file. */
    const char *stated = options->network ? options->network : options->interface_name;
    const char *of_several = config->name[0] ? config->name : stated;
    return cm1e_control_connect(control, options->attach, options->attach ? of_several : config->interface_name, diag);
}

static cm1e_error_t attach(const common_options_t *options, const cm1e_bus_config_t *config, cm1e_control_t *control,
                           cm1e_bus_t **bus, cm1e_diag_t *diag)
{
    if (options->pcap_file) {
        cm1e_control_close(control);
        return cm1e_diag_set(diag, CM1E_ERROR_UNSUPPORTED, 0, "--pcap records the frames of this program, and another "
                             "one runs the network: leave it out.");
    }
    /* Its interface, whatever we were told: --attach alone tells none, and a bus file may be made for another one. */
    cm1e_bus_config_t of_program = *config;
    json_t *hello = ask_program(control, json_pack("{s:s}", "request", "hello"), "hello", diag);
    if (!hello) {
        cm1e_control_close(control);
        return diag->error;
    }
    snprintf(of_program.interface_name, sizeof of_program.interface_name, "%s", text_of(hello, "interface"));
    json_decref(hello);
    return cm1e_bus_open_attached(bus, &of_program, control, diag);
}

cm1e_error_t open_unscanned(const common_options_t *options, const cm1e_bus_config_t *config, cm1e_bus_t **bus,
                            cm1e_diag_t *diag)
{
    cm1e_control_t *control;
    *bus = NULL;
    cm1e_error_t error = connect_network(options, config, &control, diag);
    if (error == CM1E_OK)
        error = attach(options, config, control, bus, diag);
    else if (error == CM1E_ERROR_NOT_FOUND && !options->attach)
        error = cm1e_bus_open(bus, config, diag);
    return error;
}

cm1e_error_t refuse_to_attach(const common_options_t *options, const cm1e_bus_config_t *config, const char *what,
                              const char *why, cm1e_diag_t *diag)
{
    cm1e_control_t *control;
    cm1e_diag_t told = {0};
    const cm1e_error_t error = connect_network(options, config, &control, &told);
    if (error == CM1E_ERROR_NOT_FOUND && !options->attach)
        return CM1E_OK;
    if (error != CM1E_OK)
        return cm1e_diag_set(diag, error, told.foreign_code, "%s needs the network for itself: %s. %.300s", what, why,
                             told.text);
    json_t *hello = ask_program(control, json_pack("{s:s}", "request", "hello"), "hello", &told);
    const char *program = json_string_value(json_object_get(hello, "program"));
    const time_t since = (time_t)json_integer_value(json_object_get(hello, "since"));
    char began[40] = "";
    struct tm local;
    if (since > 0 && localtime_r(&since, &local))
        strftime(began, sizeof began, " since %Y-%m-%d %H:%M:%S", &local);
    cm1e_diag_set(diag, CM1E_ERROR_INTERFACE_IN_USE, 0, "%s needs the network for itself: %s. It is in use by %s "
                  "(process %d)%s: end that program%s.", what, why, program ? program : "a program",
                  (int)json_integer_value(json_object_get(hello, "pid")), began,
                  options->attach ? ", and leave --attach out" : "");
    json_decref(hello);
    cm1e_control_close(control);
    return diag->error;
}

cm1e_error_t own_network(const common_options_t *options, const cm1e_bus_config_t *config, const char *what,
                         const char *why, cm1e_bus_t **bus, cm1e_diag_t *diag)
{
    *bus = NULL;
    const cm1e_error_t error = refuse_to_attach(options, config, what, why, diag);
    return error == CM1E_OK ? cm1e_bus_open(bus, config, diag) : error;
}

cm1e_error_t open_network(const common_options_t *options, const cm1e_bus_config_t *config, cm1e_bus_t **bus,
                          cm1e_diag_t *diag)
{
    cm1e_error_t error = open_unscanned(options, config, bus, diag);
    if (error == CM1E_OK)
        error = cm1e_bus_scan(*bus, diag);
    if (error != CM1E_OK) {
        cm1e_bus_close(*bus);
        *bus = NULL;
    }
    return error;
}

static void add_axis(cm1e_bus_config_t *config, const json_t *told)
{
    const char *name = json_string_value(json_object_get(told, "name"));
    const char *type = json_string_value(json_object_get(told, "type"));
    cm1e_axis_config_t *axis = name ? cm1e_bus_config_add_axis(config, name) : NULL;
    if (!axis)
        return;
    axis->address_kind = CM1E_ADDRESS_POSITION;
    axis->address = (uint16_t)json_integer_value(json_object_get(told, "slave"));
    axis->channel = (uint8_t)json_integer_value(json_object_get(told, "channel"));
    strcpy(axis->device, "any"); /* the program has compared its devices with its bus file */
    if (!type || strcmp(type, "motor") != 0)
        axis->type = type && strcmp(type, "encoder") == 0 ? CM1E_AXIS_ENCODER : CM1E_AXIS_VIRTUAL;
}

const cm1e_bus_config_t *axes_to_name(const common_options_t *options, const cm1e_bus_config_t *config)
{
    static cm1e_bus_config_t named;
    cm1e_diag_t diag = {0};
    cm1e_control_t *control;
    if (config->axis_count + config->slave_count > 0 || cm1e_bus_config_init(&named, NULL, 0) != CM1E_OK ||
        connect_network(options, config, &control, &diag) != CM1E_OK)
        return config;
    json_t *axes = ask_program(control, json_pack("{s:s}", "request", "axes"), "axes", &diag);
    if (!axes)
        (void)fail(&diag);
    for (size_t i = 0; i < json_array_size(axes); i++)
        add_axis(&named, json_array_get(axes, i));
    json_decref(axes);
    cm1e_control_close(control);
    return &named;
}

int look_at_loaded(const common_options_t *common, const cm1e_bus_config_t *config, const char *where,
                   slave_action_t action, const void *options)
{
    cm1e_diag_t diag = {0};
    cm1e_bus_t *bus;
    uint16_t position = 0;
    if (open_network(common, config, &bus, &diag) != CM1E_OK)
        return fail(&diag);
    int status = where ? find_slave(bus, axes_to_name(common, config), where, &position) : EXIT_OK;
    if (status == EXIT_OK)
        status = action(bus, config, options, position);
    return close_bus(bus, common, status);
}

int look_at_network(const common_options_t *common, const char *where, slave_action_t action, const void *options)
{
    static cm1e_bus_config_t config;
    return load_network(common, &config) ? look_at_loaded(common, &config, where, action, options) : EXIT_WRONG_USE;
}

int attach_if_running(const common_options_t *options, cm1e_bus_config_t *config, cm1e_control_t **control)
{
    cm1e_diag_t diag = {0};
    *control = NULL;
    if (!load_network(options, config))
        return EXIT_WRONG_USE;
    const cm1e_error_t error = connect_network(options, config, control, &diag);
    cm1e_bus_config_free(config);
    return error == CM1E_OK || (error == CM1E_ERROR_NOT_FOUND && !options->attach) ? EXIT_OK : fail(&diag);
}

void lost_by_network(const json_t *statistics, char *text, size_t size)
{
    const json_t *networks = json_object_get(statistics, "networks"), *network;
    size_t i, at = 0;
    text[0] = '\0';
    if (json_array_size(networks) < 2)
        return;
    json_array_foreach (networks, i, network) {
        const char *name = json_string_value(json_object_get(network, "network"));
        const char *interface = json_string_value(json_object_get(network, "interface"));
        const json_int_t lost = json_integer_value(json_object_get(network, "lost_frames"));
        if (lost > 0 && at < size)
            at += (size_t)snprintf(text + at, size - at, "%s%s %lld", at ? ", " : " (",
                                   name && name[0] ? name : interface ? interface : "?", (long long)lost);
    }
    if (at > 0 && at < size)
        snprintf(text + at, size - at, ")");
}

void complain_of_control(const cm1e_scheduler_t *scheduler)
{
    cm1e_scheduler_statistics_t statistics;
    cm1e_scheduler_statistics(scheduler, &statistics);
    if (statistics.control_advice[0])
        complain("%s", statistics.control_advice);
}

bool has_no_socket(const cm1e_scheduler_statistics_t *statistics)
{
    return statistics->cycles > 0 && !statistics->control_socket[0];
}
