/** cm1e monitor: a screen of all axes, with keys that act on one of them. It asks the program that runs the network;
 *  alone it runs the network itself, and asks itself. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "attach.h"
#include "axis_run.h"
#include "core/clock.h"
#include "end_signals.h"
#include "monitor.h"

enum { ENABLE_MS = 2000, PAUSE_US = 20000 };
#define LOOK_NS (100 * MS_IN_NS)
#define JUDGE_NS (500 * MS_IN_NS)
#define SLOWEST 1e-6

typedef struct monitor_options {
    common_options_t common;
    double velocity, acceleration;
} monitor_options_t;

static monitor_t monitor;

/* ---- asking ------------------------------------------------------------------------------------------------------ */

json_t *monitor_ask(monitor_t *m, json_t *request, const char *member, cm1e_diag_t *diag)
{
    json_t *value = ask_program(m->control, request, member, diag);
    if (!value)
        snprintf(m->message, sizeof m->message, "%s", diag->text);
    return value;
}

/** Replaces what was told before; false: nothing was told. */
static bool renew(monitor_t *m, json_t **place, const char *request, cm1e_diag_t *diag)
{
    json_t *value = monitor_ask(m, json_pack("{s:s}", "request", request), request, diag);
    if (!value)
        return false;
    json_decref(*place);
    *place = value;
    return true;
}

static bool renew_variables(monitor_t *m, cm1e_diag_t *diag)
{
    json_t *forced = monitor_ask(m, json_pack("{s:s, s:b}", "request", "variables", "forced", 1), "variables", diag);
    json_t *page = forced && m->shows_variables
        ? monitor_ask(m, json_pack("{s:s, s:I}", "request", "variables", "from", (json_int_t)m->first_variable), "variables",
                      diag) : NULL;
    json_decref(m->forced);
    json_decref(m->variables);
    m->forced = forced;
    m->variables = page;
    return forced && (page || !m->shows_variables);
}

static bool look(monitor_t *m, cm1e_diag_t *diag)
{
    const int64_t now = cm1e_clock_now(cm1e_clock_monotonic());
    if (m->axes && now - m->looked_ns < LOOK_NS)
        return true;
    m->looked_ns = now;
    if (m->holds) {
        json_t *kept = monitor_ask(m, json_pack("{s:s}", "request", "keep"), "keep", diag);
        m->holds = json_integer_value(kept) > 0;
        json_decref(kept);
    }
    if (!m->statistics || now - m->judged_ns >= JUDGE_NS) {
        m->judged_ns = now;
        if (!renew(m, &m->statistics, "statistics", diag))
            return false;
    }
    return (m->hello || renew(m, &m->hello, "hello", diag)) && renew(m, &m->axes, "axes", diag) && renew_variables(m, diag);
}

static void forget(monitor_t *m)
{
    cm1e_control_close(m->control);
    m->control = NULL;
    json_decref(m->hello);
    json_decref(m->axes);
    json_decref(m->statistics);
    json_decref(m->forced);
    json_decref(m->variables);
    m->hello = m->axes = m->statistics = m->forced = m->variables = NULL;
}

/* ---- keys -------------------------------------------------------------------------------------------------------- */

static bool is_true(const monitor_t *m, const char *member)
{
    return json_is_true(json_object_get(json_array_get(m->axes, m->selected), member));
}

static void act(monitor_t *m, const char *what, json_t *request)
{
    const json_t *axis = json_array_get(m->axes, m->selected);
    const char *name = json_string_value(json_object_get(axis, "name"));
    cm1e_diag_t diag = {0};
    json_object_set_new(request, "request", json_string(what));
    json_object_set_new(request, "axis", json_integer((json_int_t)m->selected + 1));
    snprintf(m->message, sizeof m->message, "%s: %s", name ? name : "", what);
    json_t *value = monitor_ask(m, request, what, &diag);
    m->holds |= value && (strcmp(what, "enable") == 0 || strcmp(what, "jog") == 0 || strcmp(what, "home") == 0);
    json_decref(value);
}

static void jog(monitor_t *m, double sign)
{
    act(m, "jog", json_pack("{s:f, s:f}", "velocity", sign * m->velocity, "acceleration", m->acceleration));
}

/** Another axis; of a page of variables the lines above or below. */
static void choose(monitor_t *m, int step)
{
    if (m->shows_variables) {
        const bool more = json_array_size(m->variables) > 1;
        m->first_variable += step < 0 ? (m->first_variable > 0 ? (size_t)step : 0) : more;
        m->looked_ns = 0;
        return;
    }
    const size_t count = json_array_size(m->axes);
    if (count > 0)
        m->selected = (m->selected + count + (size_t)step) % count;
    m->message[0] = '\0';
}

static void take_key(monitor_t *m, int key)
{
    if (m->asks_home) {
        m->asks_home = false;
        if (key == 'y')
            act(m, "home", json_object());
        return;
    }
    switch (key) {
    case SCREEN_UP: case 'k': choose(m, -1); break;
    case SCREEN_DOWN: case 'j': case '\t': choose(m, 1); break;
    case '[': m->velocity = fmax(m->velocity / 2, SLOWEST); break;
    case ']': m->velocity *= 2; break;
    case 'e': act(m, is_true(m, "powered") ? "disable" : "enable",
                  json_pack("{s:i}", "keep_ms", ENABLE_MS)); break;
    case 'h': m->asks_home = true; break;
    case ' ': case 's': act(m, "stop", json_object()); break;
    case 'r': act(m, "reset", json_object()); break;
    case 'v': m->shows_variables = !m->shows_variables; m->looked_ns = 0; break;
    case 'q': case SCREEN_GONE: m->quit = true; break;
    default: break;
    }
}

/** All keys that wait. Of those that jog, the last one counts: a terminal repeats them faster than they are sent. */
static void take_keys(monitor_t *m)
{
    double sign = 0;
    for (int key; (key = screen_key()) != SCREEN_NO_KEY && !m->quit;) {
        if (!screen_is_usable() && key != 'q' && key != SCREEN_GONE)
            continue; /* nothing shows what it would do */
        if (key == SCREEN_RIGHT || key == 'l')
            sign = 1;
        else if (key == SCREEN_LEFT)
            sign = -1;
        else
            take_key(m, key);
    }
    if (sign != 0 && !m->asks_home && !m->quit)
        jog(m, sign);
}

/** false: the program does not answer any more; `diag` says why. */
static bool tick(monitor_t *m, cm1e_diag_t *diag)
{
    if (!look(m, diag))
        return false;
    take_keys(m);
    screen_draw(m);
    return true;
}

/* ---- attached ---------------------------------------------------------------------------------------------------- */

static void print_once(const monitor_t *m)
{
    print_json(json_pack("{s:O, s:O, s:O, s:O}", "program", m->hello, "axes", m->axes, "statistics", m->statistics,
                         "forced", m->forced));
}

static int watch_other(const monitor_options_t *options)
{
    cm1e_diag_t diag = {0};
    bool answered = look(&monitor, &diag);
    if (answered && options->common.json) {
        print_once(&monitor);
        forget(&monitor);
        return EXIT_OK;
    }
    const bool was_there = answered;
    catch_signals();
    if (answered && !screen_begin()) {
        forget(&monitor);
        return EXIT_WRONG_USE;
    }
    while (answered && !monitor.quit && !told_to_end()) {
        answered = tick(&monitor, &diag);
        usleep(PAUSE_US);
    }
    screen_end();
    forget(&monitor);
    if (answered || told_to_end() || !was_there)
        return answered || told_to_end() ? EXIT_OK : fail(&diag);
    complain("%s", diag.text); /* it has ended, as it may */
    return EXIT_OK;
}

/* ---- alone ------------------------------------------------------------------------------------------------------- */

typedef struct alone {
    const monitor_options_t *options;
    cm1e_scheduler_t *scheduler;
    int status;
} alone_t;

static void do_nothing(void *context) { (void)context; }

static void prepare(cm1e_scheduler_t *scheduler, void *context) { ((alone_t *)context)->scheduler = scheduler; }

static int report(void *context)
{
    const alone_t *alone = context;
    if (alone->options->common.json && !monitor.quit) {
        complain("nothing was shown, because the run ended too early");
        return EXIT_FAILED;
    }
    return alone->status;
}

static void end_run(alone_t *alone, int status)
{
    alone->status = status;
    monitor.quit = true;
    cm1e_scheduler_stop(alone->scheduler);
}

/** Connects as soon as the run has its socket. A run without one is ended. */
static bool connect_to_own(alone_t *alone, cm1e_diag_t *diag)
{
    cm1e_scheduler_statistics_t statistics;
    cm1e_scheduler_statistics(alone->scheduler, &statistics);
    if (has_no_socket(&statistics))
        end_run(alone, EXIT_FAILED);
    return statistics.cycles > 0 &&
           cm1e_control_connect(&monitor.control, statistics.control_socket, NULL, diag) == CM1E_OK;
}

static void watch(void *context, bool last)
{
    alone_t *alone = context;
    cm1e_diag_t diag = {0};
    if (last) {
        screen_end();
        forget(&monitor);
    }
    if (last || monitor.quit || (!monitor.control && !connect_to_own(alone, &diag)))
        return;
    if (alone->options->common.json) {
        const bool answered = look(&monitor, &diag);
        if (answered)
            print_once(&monitor);
        end_run(alone, answered ? EXIT_OK : fail(&diag));
    } else if (!screen_begin()) {
        end_run(alone, EXIT_WRONG_USE);
    } else if (!tick(&monitor, &diag) || monitor.quit) {
        end_run(alone, EXIT_OK);
    }
}

static int watch_alone(const monitor_options_t *options, cm1e_bus_config_t *config)
{
    alone_t alone = {.options = options, .status = EXIT_OK};
    const int loaded = load_axes(&options->common, config);
    if (loaded != EXIT_OK)
        return loaded;
    cm1e_control_serve_own(true);
    monitor.alone = true;
    const axis_run_t run = {.what = "monitor", .program = do_nothing, .prepare = prepare, .report = report,
                            .watch = watch, .context = &alone, .by_person = true};
    return run_on_axes(&run, &options->common, config);
}

/* ---- the command ------------------------------------------------------------------------------------------------- */

static error_t parse(int key, char *arg, struct argp_state *state)
{
    monitor_options_t *options = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case 'v': return parse_positive(arg, "the velocity", &options->velocity) ? 0 : EINVAL;
    case 'a': return parse_positive(arg, "the acceleration", &options->acceleration) ? 0 : EINVAL;
    case ARGP_KEY_ARG: argp_error(state, "monitor shows all axes; \"%s\" is too many", arg); return EINVAL;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_option table[] = {
    {"velocity", 'v', "VELOCITY", 0, "Units/s of a jog; default 0.5", 0},
    {"acceleration", 'a', "ACCELERATION", 0, "Units/s2 of a jog, also for stopping; default: the axis's maximum", 0},
    {0}};
const struct argp argp_monitor = {
    table, parse, NULL,
    "Shows all axes on the terminal: state, position, velocity, lag and torque with bars within their limits, errors "
    "in words, jitter, lost frames and overruns, and which variables somebody forces. It asks the program that runs the network, or runs the network "
    "itself.\v"
    "Keys: up and down choose an axis; e enables it, or ends that; left and right, held, jog it; [ and ] halve and "
    "double the velocity; h homes it, after a question; space stops it; r resets its error; v shows the variables of a program in "
    "Structured Text, or the axes again; q ends. In another program "
    "keys act with `control: maintain` in its bus file only, and on axes that it does not command. A motor moves while "
    "a key repeats, and stops 0.25 s after the last repetition; without the terminal or the connection it stops and "
    "loses its torque. Bars are empty where there is no limit.",
    attach_children, NULL, NULL};

int command_monitor(int argc, char **argv)
{
    static cm1e_bus_config_t config;
    monitor_options_t options = {.velocity = 0.5};
    if (parse_options(&argp_monitor, argc, argv, &options))
        return EXIT_WRONG_USE;
    if (!options.common.json && !screen_check())
        return EXIT_WRONG_USE;
    monitor = (monitor_t){.velocity = options.velocity, .acceleration = options.acceleration};
    const int status = attach_if_running(&options.common, &config, &monitor.control);
    if (status != EXIT_OK)
        return status;
    return monitor.control ? watch_other(&options) : watch_alone(&options, &config);
}
