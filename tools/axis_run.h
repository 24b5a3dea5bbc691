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
    /** After the report, with the scheduler still there: traces. NULL: nothing. */
    bool (*keep)(cm1e_scheduler_t *scheduler, void *context);
    cm1e_scheduler_config_t settings;
    void *context;
} axis_run_t;

/** Starts the bus, runs, closes the bus. Returns the exit status. */
int run_on_axes(const axis_run_t *run, const common_options_t *options, const cm1e_bus_config_t *config);

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

#endif
