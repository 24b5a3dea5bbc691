/**
 * @file axis_run.h
 * Runs a program of function blocks on a started bus, for the commands that act on motors; what a person at a terminal
 * sees meanwhile, and what the machine did to the timing.
 */
#ifndef CM1E_TOOLS_AXIS_RUN_H
#define CM1E_TOOLS_AXIS_RUN_H

#include <stdatomic.h>

#include "cm1e/plcopen.h"
#include "cm1e/scheduler.h"
#include "command.h"

/** What a run consists of; the functions get `context`. */
typedef struct axis_run {
    const char *what;                    /**< name of the command */
    void (*program)(void *context);      /**< every cycle */
    /** Before the first cycle. */
    void (*prepare)(cm1e_scheduler_t *scheduler, void *context);
    /** After the last cycle. Returns the exit status. */
    int (*report)(void *context);
    /** Beside the cycle, from another thread, every 50 ms; `end` is true at the last call. NULL: nothing. */
    void (*watch)(void *context, bool end);
    /** After the bus was opened, before it starts. Returns the exit status. NULL: nothing. */
    int (*ready)(cm1e_bus_t *bus, void *context);
    /** After the report, with the scheduler still there: traces. NULL: nothing. */
    bool (*keep)(cm1e_scheduler_t *scheduler, void *context);
    cm1e_scheduler_config_t settings;
    void *context;
    bool by_person;                      /**< a person looks on or presses keys: in real time, whatever the bus file says */
} axis_run_t;

/** Starts the bus, runs, closes the bus. Returns the exit status. */
int run_on_axes(const axis_run_t *run, const common_options_t *options, cm1e_bus_config_t *config);

/** Takes the argument AXIS of a command that acts on one axis: a second one is too many. For argp parsers. */
error_t parse_axis_word(char *arg, struct argp_state *state, const char **word);

/** Loads the configuration as load_axes() does, and finds the axis of `word` in it (NULL: the first axis). Returns the
 *  exit status; it has complained if that is not EXIT_OK. */
int load_one_axis(const common_options_t *options, const char *word, cm1e_bus_config_t *config, uint32_t *number);

/** Jitter, overruns and lost frames of the last run as JSON. */
json_t *timing_as_json(void);

/** A line on standard error that overwrites itself, if that is a terminal: position and time. The cycle writes the two
 *  numbers, another thread prints them. */
typedef struct progress {
    _Atomic double position, seconds;
    double from, to;  /**< for the bar; equal: none */
    const char *name;
    bool shown;
} progress_t;
void progress_show(progress_t *progress);
void progress_clear(progress_t *progress);

/** Finds the axis of a number before the first cycle. Gives it to `power`, and its name to `progress`. */
void take_axis(cm1e_scheduler_t *scheduler, uint32_t number, AXIS_REF_t *axis, MC_Power_t *power,
               progress_t *progress);

#endif
