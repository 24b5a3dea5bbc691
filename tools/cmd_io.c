/** cm1e io: the inputs and outputs of all slaves with their values, and the inputs of the motors with what the bus file
 *  has wired to them; writes outputs for a while. No motor gets torque. */
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "attach.h"
#include "axis_run.h"
#include "config/io_types.h"
#include "config/switches.h"
#include "device/device.h"
#include "io_rows.h"

enum { KEY_ALLOW = 0xB00, KEY_FOR, KEY_ALL, LONGEST_S = 1000000 };
#define LOOK_S 0.2

typedef struct io_program {
    io_options_t options;
    const cm1e_bus_config_t *config;
    cm1e_scheduler_t *scheduler;
    cm1e_bus_t *bus;
    bool ended, refused;
    bool wrong;                /**< refused because of a word of the user */
    cm1e_io_t *signals;
    cm1e_io_info_t *infos;
    char (*values)[IO_SIGNAL_NAME];
    cm1e_axis_info_t *axes;
    uint32_t count;
} io_program_t;

static error_t add_write(io_options_t *p, char *arg, struct argp_state *state)
{
    const char *equals = strrchr(arg, '=');
    if (!equals || equals == arg || equals - arg >= IO_SIGNAL_NAME)
        argp_error(state, "\"%s\": expected NAME=VALUE, as \"2.Output 1=1\"", arg);
    if (p->write_count == IO_WRITES_MAX)
        argp_error(state, "more than %d outputs", IO_WRITES_MAX);
    io_write_t *write = &p->writes[p->write_count++];
    *write = (io_write_t){.word = arg, .equals = equals};
    return parse_real(equals + 1, "the value of the output", &write->value) ? 0 : EINVAL;
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    io_options_t *p = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &p->common);
    case KEY_ALLOW: p->allow = true; return 0;
    case KEY_ALL: p->all = true; return 0;
    case KEY_FOR: return parse_seconds(arg, LONGEST_S, &p->seconds) ? 0 : EINVAL;
    case ARGP_KEY_ARG: return add_write(p, arg, state);
    case ARGP_KEY_END:
        if (p->write_count > 0 && !p->allow)
            argp_error(state, "writing an output moves what is wired to it: --allow-output");
        if (p->write_count > 0 && p->seconds == 0)
            argp_error(state, "how long? --for SECONDS; the outputs are off afterwards");
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

/* ---- the run ----------------------------------------------------------------------------------------------------- */

/** Whether an axis drives the output that was found. */
static bool is_driven(const io_program_t *p, const cm1e_io_t *io, char use[IO_USE])
{
    for (uint32_t i = 0; i < p->count; i++)
        if (p->infos[i].output && p->signals[i].byte == io->byte && p->signals[i].shift == io->shift &&
            cm1e_io_use(p->bus, &p->infos[i], use, IO_USE))
            return true;
    return false;
}

/** What is to be written is found before anything is sent. */
static void find_writes(io_program_t *p)
{
    for (int i = 0; i < p->options.write_count && !p->refused; i++) {
        char name[IO_SIGNAL_NAME], use[IO_USE];
        cm1e_diag_t diag = {0};
        io_write_t *write = &p->options.writes[i];
        io_name(write, name);
        p->refused = p->wrong = cm1e_io_find(p->bus, name, &write->io, &diag) != CM1E_OK;
        if (p->refused)
            fail(&diag);
        else if ((p->refused = is_driven(p, &write->io, use)))
            complain("%s belongs to an axis (%s): its blocks write it, MC_WriteDigitalOutput or MC_DigitalCamSwitch",
                     name, use);
        else if ((p->refused = p->wrong = cm1e_io_set_real(&write->io, write->value) != CM1E_OK)) {
            cm1e_io_say_refusal(&write->io, write->value, use, sizeof use);
            complain("%s cannot be written with %s: %s", name, write->equals + 1, use);
        }
    }
    for (int i = 0; i < p->options.write_count && p->refused; i++) /* none of them is sent */
        cm1e_io_set_real(&p->options.writes[i].io, 0);
}

static int take_bus(cm1e_bus_t *bus, void *context)
{
    ((io_program_t *)context)->bus = bus;
    return EXIT_OK;
}

static void prepare(cm1e_scheduler_t *scheduler, void *context)
{
    io_program_t *p = context;
    p->scheduler = scheduler;
    p->count = cm1e_io_count(p->bus);
    p->infos = calloc(p->count + 1, sizeof *p->infos);
    p->signals = calloc(p->count + 1, sizeof *p->signals);
    p->values = calloc(p->count + 1, sizeof *p->values);
    p->axes = calloc(p->config->axis_count + 1, sizeof *p->axes);
    if (!p->infos || !p->signals || !p->values || !p->axes) {
        complain("out of memory");
        p->refused = true;
        p->count = 0;
    }
    for (uint32_t i = 0; i < p->count; i++) {
        const cm1e_io_info_t *info = &p->infos[i];
        cm1e_io_at(p->bus, i, &p->infos[i]);
        if (cm1e_io_find_bits(p->bus, info->position, info->output, info->bit_offset, info->bits, info->type,
                              &p->signals[i], NULL) != CM1E_OK)
            p->signals[i] = (cm1e_io_t){0};
    }
    find_writes(p);
}

static void program(void *context)
{
    io_program_t *p = context;
    const double seconds = (double)cm1e_scheduler_time_ns(p->scheduler) * 1e-9;
    for (int i = 0; i < p->options.write_count && !p->refused; i++)
        if (cm1e_io_set_real(&p->options.writes[i].io, p->ended ? 0 : p->options.writes[i].value) != CM1E_OK)
            p->refused = true;
    for (uint32_t i = 0; i < p->config->axis_count && !p->ended && p->axes; i++)
        cm1e_axis_read(cm1e_scheduler_axis(p->scheduler, i), &p->axes[i]);
    if (p->ended || p->refused) {
        cm1e_scheduler_stop(p->scheduler);
        return;
    }
    if (seconds < fmax(LOOK_S, p->options.seconds))
        return;
    for (uint32_t i = 0; i < p->count; i++) { /* the last values; the cycle after it sends zeros */
        const cm1e_io_t *io = &p->signals[i];
        const bool whole = io->type != CM1E_IO_REAL && io->type != CM1E_IO_LREAL;
        if (cm1e_io_quality(io) == CM1E_IO_INVALID || io->type == CM1E_IO_BYTES)
            snprintf(p->values[i], IO_SIGNAL_NAME, "-");
        else if (whole)
            snprintf(p->values[i], IO_SIGNAL_NAME, "%" PRId64, cm1e_io_integer(io));
        else
            snprintf(p->values[i], IO_SIGNAL_NAME, "%.6g", cm1e_io_real(io));
    }
    p->ended = true;
}

/* ---- report ------------------------------------------------------------------------------------------------------ */

/** What the bus file has wired to an input of a motor. */
static void say_switch(const cm1e_input_config_t *inputs, int number, char *text, size_t size)
{
    cm1e_switch_t switches[CM1E_SWITCHES];
    cm1e_switches_of(inputs, switches);
    text[0] = 0;
    for (int i = 0; i < CM1E_SWITCHES; i++)
        if (switches[i].input == number)
            io_add_switch(text, size, switches[i].name, switches[i].closed);
}

static void list_axis(const io_program_t *p, uint32_t number, json_t *list)
{
    const cm1e_axis_config_t *config = &p->config->axes[number];
    const cm1e_axis_info_t *info = &p->axes[number];
    char axis[CM1E_NAME_LENGTH + 8], wired[96];
    snprintf(axis, sizeof axis, config->name[0] ? "%s" : "axis%.0s%u", config->name, number + 1);
    for (int n = 1; n <= IO_INPUTS && config->type == CM1E_AXIS_MOTOR; n++) {
        const bool on = info->digital_inputs >> (n - 1) & 1;
        say_switch(&config->inputs, n, wired, sizeof wired);
        json_array_append_new(list, io_input_row(axis, n, info->digital_known ? json_boolean(on) : NULL, wired));
    }
}

/** The output of a CM1-E, as it is sent (UG 7.3.25: bit 0). */
static void list_output(const io_program_t *p, uint32_t number, json_t *list)
{
    char axis[CM1E_NAME_LENGTH + 8];
    const cm1e_axis_config_t *config = &p->config->axes[number];
    snprintf(axis, sizeof axis, config->name[0] ? "%s" : "axis%.0s%u", config->name, number + 1);
    for (uint32_t i = 0; i < p->count; i++) {
        const cm1e_io_info_t *info = &p->infos[i];
        if (!info->of_axis || !info->output || info->index != OBJ_60FE_DIGITAL_OUTPUTS || config->channel ||
            info->position != cm1e_bus_axis_position(p->bus, number))
            continue;
        json_array_append_new(list, io_output_row(axis, strtoul(p->values[i], NULL, 10) & 1));
    }
}

static json_t *signal_row(const io_program_t *p, uint32_t i)
{
    char use[IO_USE];
    const cm1e_io_info_t *info = &p->infos[i];
    cm1e_io_use(p->bus, info, use, sizeof use);
    return io_signal_row(info->position, cm1e_bus_slave_name(p->bus, info->position), info->name,
                         cm1e_io_type_name(info->type), info->output, info->of_axis, p->values[i], use);
}

static int report(void *context)
{
    io_program_t *p = context;
    if (p->refused)
        return p->wrong ? EXIT_WRONG_USE : EXIT_FAILED;
    if (!p->ended) {
        complain("interrupted");
        return EXIT_FAILED;
    }
    json_t *axes = json_array(), *signals = json_array();
    for (uint32_t i = 0; i < p->config->axis_count; i++) {
        list_axis(p, i, axes);
        list_output(p, i, axes);
    }
    for (uint32_t i = 0; i < p->count; i++)
        if (p->options.all || !p->infos[i].of_axis)
            json_array_append_new(signals, signal_row(p, i));
    io_print(axes, signals, p->options.common.json, is_simulated(p->config));
    if (!p->options.common.json)
        tell_simulated(p->config);
    return EXIT_OK;
}

static const struct argp_option table[] = {
    {"allow-output", KEY_ALLOW, NULL, 0, "Write the outputs that are given: what is wired to them moves", 0},
    {"all", KEY_ALL, NULL, 0, "Also list the process data of motors", 0},
    {"for", KEY_FOR, "SECONDS", 0, "How long the outputs have their values; they are 0 afterwards", 0},
    {0}};
const struct argp argp_io = {
    table, parse, "[NAME=VALUE...]",
    "Lists the digital inputs and outputs of the motors, with the switches that the bus file names, and the inputs and "
    "outputs of all other slaves with name, type and value. With NAME=VALUE, as \"2.Output 1=1\", it writes outputs of "
    "slaves without a motor. It brings the slaves to Operational; no motor gets torque. Where a program runs "
    "the network, it attaches to it: it writes only outputs that the program does not use, with control: maintain.",
    attach_children, NULL, NULL};

int command_io(int argc, char **argv)
{
    static io_program_t p;
    static cm1e_bus_config_t config;
    cm1e_control_t *control;
    p = (io_program_t){0};
    if (parse_options(&argp_io, argc, argv, &p.options))
        return EXIT_WRONG_USE;
    const int found = attach_if_running(&p.options.common, &config, &control);
    if (found != EXIT_OK || control)
        return found == EXIT_OK ? io_attached(&p.options, control) : found;
    const int loaded = load_axes(&p.options.common, &config);
    if (loaded != EXIT_OK)
        return loaded;
    p.config = &config;
    const axis_run_t run = {.what = "io", .program = program, .prepare = prepare, .report = report,
                            .ready = take_bus, .context = &p};
    const int status = run_on_axes(&run, &p.options.common, &config);
    free(p.infos);
    free(p.signals);
    free(p.values);
    free(p.axes);
    return status;
}
