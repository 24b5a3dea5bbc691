/**
 * @file example.h
 * What the examples from 04 on have in common: options, a bus of one axis, a scheduler with a trace, run and files.
 * The idea of each is in its own file.
 */
#ifndef CM1E_EXAMPLES_EXAMPLE_H
#define CM1E_EXAMPLES_EXAMPLE_H

#include <argp.h>
#include <stdio.h>
#include <stdlib.h>

#include <cm1e/plcopen.h>
#include <cm1e/plot.h>
#include <cm1e/scheduler.h>

enum { EXAMPLE_TRACE_SAMPLES = 120000, EXAMPLE_VIRTUAL_TIME = 256, EXAMPLE_CSV, EXAMPLE_SVG, EXAMPLE_HTML };

/** The files of a trace, in the order of their options. */
enum { EXAMPLE_FILES = 3 };
static cm1e_error_t (*const example_writers[EXAMPLE_FILES])(const cm1e_scheduler_t *scheduler, const char *path,
                                                            cm1e_diag_t *why) = {
    cm1e_scheduler_write_csv, cm1e_scheduler_write_svg, cm1e_scheduler_write_html,
};

typedef struct example {
    const char *interface_name;                 /**< NULL: that of the bus file, or sim */
    const char *files[EXAMPLE_FILES];           /**< NULL: not wanted */
    bool virtual_time;
    void (*describe)(cm1e_axis_config_t *axis); /**< what is special about the axis; NULL: nothing */
    uint32_t axis_count;                        /**< 0: 1 */
    const char *bus_file;                       /**< describes the network; NULL: it has axes with defaults */
    void (*describe_network)(cm1e_bus_config_t *config); /**< what is special about several axes; NULL: nothing */
    cm1e_bus_t *bus;
    cm1e_scheduler_t *scheduler;
    AXIS_REF_t axis;
    bool finished;     /**< the program ended by itself, not by a signal */
    AXIS_REF_t wrong;  /**< the first axis of which a block had an error, and which one */
    WORD error_id;
} example_t;

static inline error_t example_option(int key, char *argument, struct argp_state *state)
{
    example_t *e = state->input;
    switch (key) {
    case 'i':
        if (!argument[0])
            argp_error(state, "-i needs a name; it is empty");
        e->interface_name = argument;
        return 0;
    case EXAMPLE_VIRTUAL_TIME: e->virtual_time = true; return 0;
    case EXAMPLE_CSV:
    case EXAMPLE_SVG:
    case EXAMPLE_HTML: e->files[key - EXAMPLE_CSV] = argument; return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

/** A program with options of its own has these as its argp's child, and &example as what they fill in. */
static const struct argp_option example_option_list[] = {
    {"interface", 'i', "NAME", 0, "network interface (the motor turns!); default: sim, the simulated segment", 0},
    {"virtual-time", EXAMPLE_VIRTUAL_TIME, NULL, 0, "sim only: do not wait, run as fast as the machine can", 0},
    {"csv", EXAMPLE_CSV, "FILE", 0, "write the trace as CSV", 0},
    {"svg", EXAMPLE_SVG, "FILE", 0, "write the trace as a plot", 0},
    {"html", EXAMPLE_HTML, "FILE", 0, "write the trace as a page for a browser", 0},
    {0},
};

static inline void example_options(example_t *e, int argc, char **argv, const char *purpose)
{
    const struct argp argp = {example_option_list, example_option, NULL, purpose, NULL, NULL, NULL};
    argp_parse(&argp, argc, argv, 0, NULL, e);
}

static inline cm1e_error_t example_open_bus(example_t *e, cm1e_diag_t *why)
{
    cm1e_bus_config_t config;
    cm1e_error_t error = e->bus_file ? cm1e_bus_config_load(&config, e->bus_file, why)
                                     : cm1e_bus_config_init(&config, NULL, e->axis_count > 0 ? e->axis_count : 1);
    if (error != CM1E_OK)
        return e->bus_file ? error : cm1e_diag_set(why, error, 0, "%s", cm1e_strerror(error));
    if (e->interface_name)
        snprintf(config.interface_name, sizeof config.interface_name, "%s", e->interface_name);
    if (e->describe_network)
        e->describe_network(&config);
    config.virtual_time = config.virtual_time || e->virtual_time;
    if (e->describe)
        e->describe(&config.axes[0]);
    error = cm1e_bus_open(&e->bus, &config, why);
    cm1e_bus_config_free(&config); /* the bus has a copy */
    return error == CM1E_OK ? cm1e_bus_start(e->bus, why) : error;
}

/** Bus and scheduler stand afterwards, and e->axis is the first axis, or the only one. */
static inline cm1e_error_t example_open(example_t *e, cm1e_diag_t *why)
{
    cm1e_scheduler_config_t scheduler = {0};
    cm1e_error_t error = CM1E_OK; /* files that cannot be written are told before anything moves */
    for (int i = 0; i < EXAMPLE_FILES && error == CM1E_OK; i++)
        if (e->files[i]) {
            scheduler.trace_capacity = EXAMPLE_TRACE_SAMPLES;
            error = cm1e_scheduler_check_path(e->files[i], why);
        }
    if (error == CM1E_OK)
        error = example_open_bus(e, why);
    if (error == CM1E_OK)
        error = cm1e_scheduler_create(&e->scheduler, e->bus, &scheduler, why);
    if (error == CM1E_OK)
        e->axis = cm1e_scheduler_axis(e->scheduler, 0);
    return error;
}

/** Runs the program until it calls cm1e_scheduler_stop(), then writes the files asked for. */
static inline cm1e_error_t example_run(example_t *e, cm1e_program_t program, cm1e_diag_t *why)
{
    const cm1e_task_config_t task = {.name = "example", .program = program};
    cm1e_error_t error = cm1e_scheduler_add_task(e->scheduler, &task, why);
    cm1e_scheduler_stop_on_signals(e->scheduler); /* Ctrl-C, or a closed terminal, ramps down and disables */
    if (error == CM1E_OK)
        error = cm1e_scheduler_run(e->scheduler, 0, why);
    for (int i = 0; i < EXAMPLE_FILES && error == CM1E_OK; i++)
        if (e->files[i])
            error = example_writers[i](e->scheduler, e->files[i], why);
    return error;
}

/** The program's own end of the run. */
static inline void example_finish(example_t *e)
{
    e->finished = true;
    cm1e_scheduler_stop(e->scheduler);
}

/** Looks at a block of an axis. TRUE: this or an earlier one has an error; the first one is told at the end. */
static inline bool example_failed(example_t *e, AXIS_REF_t axis, BOOL error, WORD error_id)
{
    if (error && e->error_id == 0) {
        e->error_id = error_id;
        e->wrong = axis;
    }
    return e->error_id != 0;
}

/** The sentences about an axis on which something went wrong. In the program's end, not in the cycle. */
static inline void example_tell_error_of(AXIS_REF_t axis, WORD error_id)
{
    char text[CM1E_AXIS_ERROR_TEXT_BYTES];
    cm1e_axis_error_text(axis, text, sizeof text);
    fprintf(stderr, "%s\n", text[0] ? text : cm1e_strerror(cm1e_error_from_id(error_id)));
}
static inline void example_tell_error(const example_t *e, WORD error_id) { example_tell_error_of(e->axis, error_id); }

/** What follows a step that is done: the next one, with its mark in the plot; behind the last one the run ends. */
static inline int example_next_step(example_t *e, const char *const *marks, int step, int last)
{
    if (step == last) {
        example_finish(e);
        return step;
    }
    cm1e_scheduler_mark(e->scheduler, marks[step + 1]);
    return step + 1;
}

/** Whether a report of what was done makes sense. */
static inline bool example_is_done(const example_t *e, cm1e_error_t error)
{
    return error == CM1E_OK && e->finished && e->error_id == 0;
}

/** What main() returns; a run that was interrupted is no success. */
static inline int example_end(example_t *e, cm1e_error_t error, const cm1e_diag_t *why, bool well)
{
    if (error != CM1E_OK)
        fprintf(stderr, "%s\n", why->text);
    else if (!e->finished)
        fprintf(stderr, "Interrupted before its end.\n");
    if (e->error_id != 0)
        example_tell_error_of(e->wrong, e->error_id);
    cm1e_scheduler_destroy(e->scheduler);
    cm1e_bus_close(e->bus);
    return error == CM1E_OK && e->finished && e->error_id == 0 && well ? EXIT_SUCCESS : EXIT_FAILURE;
}

#endif
