/** cm1e trace: records the signals of the program that runs the network, or runs it itself, with every motor without
 *  torque, and records that. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "attach.h"
#include "axis_run.h"
#include "cm1e/plot.h"
#include "core/json_text.h"
#include "end_signals.h"
#include "plot/plot_files.h"
#include "recording.h"
#include "trace_file.h"
#include "trace_server.h"

enum { KEY_FOR = 0x600, KEY_EVERY, KEY_OBJECT, KEY_VARIABLE, KEY_TRIGGER, KEY_BEFORE, KEY_LIST, KEY_CSV, KEY_SVG, KEY_HTML, KEY_NPY,
       KEY_LIVE, LONGEST_S = 86400, EVERY_MOST = 10000, PAUSE_US = 20000,
       LIVE_SAMPLES = 40000 };

static cm1e_error_t (*const writers[TRACE_FILES])(const trace_t *trace, const char *path, cm1e_diag_t *diag) = {
    cm1e_trace_write_csv, cm1e_plot_write_svg, cm1e_plot_write_html, cm1e_trace_write_npy};
enum { OBJECTS = 64, PATHS = 64 };

typedef struct trace_options {
    common_options_t common;
    const char *files[TRACE_FILES]; /* NULL: not wanted */
    const char *objects[OBJECTS];   /* AXIS:INDEX[:SUBINDEX] */
    int object_count;
    const char *paths[PATHS];       /* of variables; none: those that the program chose */
    int path_count;
    double seconds, before_s;
    uint32_t every;
    bool list, live;
    uint16_t port;                  /* of the live page; 0: a free one */
    cm1e_trace_trigger_t trigger;
    char signal[CM1E_TRACE_NAME_BYTES];
} trace_options_t;

/* ---- options ----------------------------------------------------------------------------------------------------- */

/** error-stop, rising:SIGNAL:LEVEL, falling:SIGNAL:LEVEL, change:SIGNAL */
static error_t parse_trigger(trace_options_t *options, const char *arg)
{
    static const cm1e_trace_trigger_kind_t kinds[] = {CM1E_TRACE_ON_ERROR_STOP, CM1E_TRACE_ON_RISING,
                                                      CM1E_TRACE_ON_FALLING, CM1E_TRACE_ON_CHANGE};
    char word[16];
    const size_t bytes = strcspn(arg, ":");
    const char *signal = arg[bytes] ? arg + bytes + 1 : "", *level = strrchr(signal, ':');
    snprintf(word, sizeof word, "%.*s", (int)(bytes < sizeof word ? bytes : sizeof word - 1), arg);
    const int kind = choose_word("kind of trigger", word, "error-stop|rising|falling|change");
    if (kind < 0)
        return EINVAL;
    options->trigger.kind = kinds[kind];
    options->trigger.signal = options->signal;
    const bool has_level = kinds[kind] == CM1E_TRACE_ON_RISING || kinds[kind] == CM1E_TRACE_ON_FALLING;
    if (kinds[kind] == CM1E_TRACE_ON_ERROR_STOP ? signal[0] != '\0' : signal[0] == '\0' || (has_level && !level)) {
        complain("the trigger is \"%s\"; expected error-stop, rising:SIGNAL:LEVEL, falling:SIGNAL:LEVEL or "
                 "change:SIGNAL", arg);
        return EINVAL;
    }
    const size_t length = has_level ? (size_t)(level - signal) : strlen(signal);
    if (length >= sizeof options->signal) {
        complain("the signal of the trigger is longer than %zu bytes", sizeof options->signal - 1);
        return EINVAL;
    }
    snprintf(options->signal, sizeof options->signal, "%.*s", (int)length, signal);
    return !has_level || parse_real(level + 1, "the level of the trigger", &options->trigger.level) ? 0 : EINVAL;
}

static void check(const trace_options_t *options, struct argp_state *state)
{
    if (need_trace_files(state, options->files, TRACE_FILES) == 0 && !options->list && !options->live)
        argp_error(state, "say what to write: --csv, --svg, --html or --npy FILE, or --list, or --live");
    if (options->list && options->live)
        argp_error(state, "--list ends at once, and --live shows what goes on: choose one");
    if (options->before_s > 0 && (options->trigger.kind == CM1E_TRACE_NO_TRIGGER ||
                                  options->before_s >= options->seconds))
        argp_error(state, "--before is for a --trigger, and shorter than --for");
    if (options->trigger.kind != CM1E_TRACE_NO_TRIGGER && options->seconds == 0)
        argp_error(state, "--trigger needs --for SECONDS, the time that is kept");
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    trace_options_t *options = state->input;
    long long number;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case KEY_FOR: return parse_seconds(arg, LONGEST_S, &options->seconds) ? 0 : EINVAL;
    case KEY_BEFORE: return parse_seconds(arg, LONGEST_S, &options->before_s) ? 0 : EINVAL;
    case KEY_EVERY:
        if (!parse_number(arg, "the number of cycles between samples", 1, EVERY_MOST, &number))
            return EINVAL;
        options->every = (uint32_t)number;
        return 0;
    case KEY_OBJECT:
        if (options->object_count == OBJECTS)
            argp_error(state, "at most %d objects", OBJECTS);
        options->objects[options->object_count++] = arg;
        return 0;
    case KEY_VARIABLE:
        if (options->path_count == PATHS)
            argp_error(state, "at most %d --variable", PATHS);
        options->paths[options->path_count++] = arg;
        return 0;
    case KEY_TRIGGER: return parse_trigger(options, arg);
    case KEY_LIVE:
        if (arg && !parse_number(arg, "the port of the live page", 1, UINT16_MAX, &number))
            return EINVAL;
        options->live = true;
        options->port = arg ? (uint16_t)number : 0;
        return 0;
    case KEY_LIST: options->list = true; return 0;
    case KEY_CSV: case KEY_SVG: case KEY_HTML: case KEY_NPY: options->files[key - KEY_CSV] = arg; return 0;
    case ARGP_KEY_ARG: argp_error(state, "trace records all axes; \"%s\" is too many", arg); return EINVAL;
    case ARGP_KEY_END: check(options, state); return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_option table[] = {
    {"for", KEY_FOR, "SECONDS", 0, "Time to record, or to keep around a trigger; default: until Ctrl-C", 0},
    {"every", KEY_EVERY, "N", 0, "Record every N-th cycle; default 1", 0},
    {"object", KEY_OBJECT, "AXIS:INDEX[:SUB]", 0, "Also an object in the process data, like 1:0x603F", 0},
    {"variable", KEY_VARIABLE, "NAME", 0, "Of the variables of a program in Structured Text this one, or all of this "
     "instance or structure; again for more (default: those that the program records)", 0},
    {"trigger", KEY_TRIGGER, "KIND[:SIGNAL[:LEVEL]]", 0,
     "End --for SECONDS after it: error-stop, rising:SIGNAL:LEVEL, falling:SIGNAL:LEVEL, change:SIGNAL", 0},
    {"before", KEY_BEFORE, "SECONDS", 0, "Of that time, so much before the trigger", 0},
    {"list", KEY_LIST, NULL, 0, "Print the names of the signals and end", 0},
    {"csv", KEY_CSV, "FILE", 0, "Write a trace", 0},
    {"svg", KEY_SVG, "FILE", 0, "Write a plot", 0},
    {"html", KEY_HTML, "FILE", 0, "Write the trace as a page for a browser: zoom, cursors, events", 0},
    {"npy", KEY_NPY, "FILE", 0, "Write the trace for NumPy", 0},
    {"live", KEY_LIVE, "PORT", OPTION_ARG_OPTIONAL,
     "Show the trace while it is recorded, in a browser on this machine: print the address of a page", 0},
    {0}};
const struct argp argp_trace = {
    table, parse, NULL,
    "Records all signals of the program that runs the network: axes, timing, the variables and objects that the "
    "program has named, and objects of --object. Without such a program it runs the network itself, with every motor "
    "without torque.\vNo cycle is left out. If this program is too slow to take them, the samples that are lost are "
    "counted and said, and the place is marked.", attach_children, NULL, NULL};

/* ---- recording --------------------------------------------------------------------------------------------------- */

/** NULL, with a complaint: one of them is no object. */
static json_t *objects_as_json(const trace_options_t *options, const json_t *axes)
{
    json_t *all = json_array();
    for (int i = 0; i < options->object_count; i++) {
        char name[64];
        uint16_t index = 0;
        uint8_t subindex = 0;
        const char *colon = strchr(options->objects[i], ':');
        const size_t bytes = colon ? (size_t)(colon - options->objects[i]) : 0;
        snprintf(name, sizeof name, "%.*s", (int)(bytes < sizeof name ? bytes : 0), options->objects[i]);
        const size_t axis = axis_of_program(axes, name);
        if (!colon || axis == 0 || !read_object(colon + 1, &index, &subindex) || index == 0) {
            complain("the object is \"%s\"; expected AXIS:INDEX or AXIS:INDEX:SUBINDEX, like 1:0x603F, with a name or "
                     "number of an axis", options->objects[i]);
            json_decref(all);
            return NULL;
        }
        json_array_append_new(all, json_pack("{s:I, s:i, s:i}", "axis", (json_int_t)axis, "index", index, "subindex",
                                             subindex));
    }
    return all;
}

/** NULL: the program chooses. */
static json_t *paths_as_json(const trace_options_t *options)
{
    json_t *paths = options->path_count > 0 ? json_array() : NULL;
    for (int i = 0; i < options->path_count; i++)
        json_array_append_new(paths, json_string(options->paths[i]));
    return paths;
}

/** Nothing is written: only what a live page has not been shown yet needs to be kept. */
static bool is_only_live(const trace_options_t *options)
{
    bool writes = options->seconds > 0;
    for (int i = 0; i < TRACE_FILES; i++)
        writes = writes || options->files[i];
    return options->live && !writes;
}

/** Returns the exit status. */
static int begin_live(trace_server_t **server, const recording_t *recording, const trace_options_t *options)
{
    cm1e_diag_t diag = {0};
    if (!options->live)
        return EXIT_OK;
    if (trace_server_begin(server, recording, options->port, &diag) != CM1E_OK)
        return fail(&diag);
    /* The result follows when the recording has ended, so a program has to be able to read this by itself: one line. */
    printf(options->common.json ? "{\"url\": \"%s\"}\n" : "%s\n", trace_server_url(*server));
    fflush(stdout);
    return EXIT_OK;
}

/** Returns the exit status. `*server` is set for a live page. */
static int begin(recording_t *recording, trace_server_t **server, const trace_options_t *options,
                 cm1e_control_t *control)
{
    cm1e_diag_t diag = {0};
    json_t *axes = ask_program(control, json_pack("{s:s}", "request", "axes"), "axes", &diag);
    json_t *objects = axes ? objects_as_json(options, axes) : NULL;
    const bool answered = axes != NULL;
    json_decref(axes);
    if (!answered)
        return fail(&diag);
    if (!objects)
        return EXIT_WRONG_USE;
    recording->seconds = options->seconds;
    recording->before_s = options->before_s;
    recording->kept = is_only_live(options) ? LIVE_SAMPLES : 0;
    if (!recording_begin(recording, control, options->every, objects, paths_as_json(options), &options->trigger,
                         &diag))
        return fail_at_once(&diag);
    return begin_live(server, recording, options);
}

/** Takes what has come, and shows it. false: it is over, `diag` says why, or nothing if all is recorded. */
static bool go_on(recording_t *recording, trace_server_t *server, cm1e_control_t *control, cm1e_diag_t *diag)
{
    const bool answers = recording_take(recording, control, diag);
    if (server)
        trace_server_show(server, recording);
    return answers && !recording->full;
}

static void end_live(trace_server_t *server, const recording_t *recording, const char *why)
{
    trace_server_end(server, recording, recording->full ? "The recording is complete." : why[0] ? why
                                                        : "The recording was ended.");
}

static int write_files(const recording_t *recording, const trace_options_t *options)
{
    cm1e_diag_t diag = {0};
    int status = EXIT_OK;
    for (int i = 0; i < TRACE_FILES; i++)
        if (options->files[i] && writers[i](&recording->trace, options->files[i], &diag) != CM1E_OK)
            status = fail(&diag);
    return status;
}

static int report(const recording_t *recording, const trace_options_t *options)
{
    const trace_trigger_t *trigger = &recording->trace.trigger;
    const bool came = trigger->kind == CM1E_TRACE_NO_TRIGGER || trigger->seen;
    const int status = write_files(recording, options);
    if (options->common.json)
        print_json(json_pack("{s:I, s:I, s:i, s:b}", "samples", (json_int_t)recording->trace.used, "lost",
                             (json_int_t)recording->lost, "signals", (int)recording->trace.column_count, "triggered",
                             trigger->seen));
    else
        printf("%u samples of %u signals recorded\n", recording->trace.used, recording->trace.column_count);
    if (recording->lost > 0)
        complain("%llu samples were lost, because this program took them too slowly; the gaps are marked. Record fewer "
                 "with --every", (unsigned long long)recording->lost);
    if (!came)
        complain("the trigger did not come");
    return came ? status : EXIT_FAILED;
}

static int list(const recording_t *recording, const trace_options_t *options)
{
    json_t *all = json_array();
    for (uint32_t i = 0; i < recording->trace.column_count; i++) {
        const trace_column_t *column = &recording->trace.columns[i];
        json_array_append_new(all, json_pack("{s:o, s:o}", "name", cm1e_json_text(column->name), "unit",
                                             cm1e_json_text(column->unit)));
        if (!options->common.json)
            printf("%s%s%s%s\n", column->name, column->unit[0] ? " [" : "", column->unit, column->unit[0] ? "]" : "");
    }
    if (options->common.json)
        print_json(all);
    else
        json_decref(all);
    return EXIT_OK;
}

static int trace_other(const trace_options_t *options, cm1e_control_t *control)
{
    static recording_t recording;
    trace_server_t *server = NULL;
    cm1e_diag_t diag = {0};
    catch_signals();
    int status = begin(&recording, &server, options, control);
    if (status == EXIT_OK && options->list) {
        status = list(&recording, options);
    } else if (status == EXIT_OK) {
        while (!told_to_end() && go_on(&recording, server, control, &diag))
            usleep(PAUSE_US);
        end_live(server, &recording, diag.text);
        if (diag.text[0])
            complain("%s What came until then is written.", diag.text);
        status = report(&recording, options);
    }
    recording_free(&recording);
    cm1e_control_close(control);
    return status;
}

/* ---- alone ------------------------------------------------------------------------------------------------------- */

typedef struct alone {
    const trace_options_t *options;
    cm1e_scheduler_t *scheduler;
    cm1e_control_t *control;
    recording_t recording;
    trace_server_t *server;
    int status;
    bool over;
} alone_t;

static void do_nothing(void *context) { (void)context; }
static void prepare(cm1e_scheduler_t *scheduler, void *context) { ((alone_t *)context)->scheduler = scheduler; }

/** After the last cycle. */
static int end_alone(void *context)
{
    alone_t *alone = context;
    if (alone->status == EXIT_OK && !alone->recording.told) {
        complain("nothing was recorded, because the run ended too early");
        alone->status = EXIT_FAILED;
    } else if (alone->status == EXIT_OK) {
        alone->status = alone->options->list ? list(&alone->recording, alone->options)
                                             : report(&alone->recording, alone->options);
    }
    recording_free(&alone->recording);
    return alone->status;
}

static void end_run(alone_t *alone)
{
    alone->over = true;
    cm1e_scheduler_stop(alone->scheduler);
}

static void watch(void *context, bool last)
{
    alone_t *alone = context;
    cm1e_diag_t diag = {0};
    if (last) {
        end_live(alone->server, &alone->recording, "");
        cm1e_control_close(alone->control);
        return;
    }
    if (alone->over)
        return;
    if (!alone->control) {
        cm1e_scheduler_statistics_t statistics;
        cm1e_scheduler_statistics(alone->scheduler, &statistics);
        if (has_no_socket(&statistics))
            end_run(alone);
        if (statistics.cycles == 0 ||
            cm1e_control_connect(&alone->control, statistics.control_socket, NULL, &diag) != CM1E_OK)
            return;
        alone->status = begin(&alone->recording, &alone->server, alone->options, alone->control);
        if (alone->status != EXIT_OK || alone->options->list)
            end_run(alone);
        return;
    }
    if (!go_on(&alone->recording, alone->server, alone->control, &diag))
        end_run(alone);
}

static int trace_alone(const trace_options_t *options, cm1e_bus_config_t *config)
{
    static alone_t alone;
    const int loaded = load_axes(&options->common, config);
    if (loaded != EXIT_OK)
        return loaded;
    alone.options = options;
    cm1e_control_serve_own(true);
    const axis_run_t run = {.what = "trace", .program = do_nothing, .prepare = prepare, .report = end_alone,
                            .watch = watch, .context = &alone, .by_person = true};
    return run_on_axes(&run, &options->common, config);
}

int command_trace(int argc, char **argv)
{
    static cm1e_bus_config_t config;
    static trace_options_t options;
    cm1e_control_t *control;
    options = (trace_options_t){.every = 1};
    if (parse_options(&argp_trace, argc, argv, &options))
        return EXIT_WRONG_USE;
    int status = check_trace_files(options.files, TRACE_FILES);
    if (status != EXIT_OK)
        return status;
    status = attach_if_running(&options.common, &config, &control);
    if (status != EXIT_OK)
        return status;
    return control ? trace_other(&options, control) : trace_alone(&options, &config);
}
