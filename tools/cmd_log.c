/** cm1e log: what has happened to the axes and the bus of a running program. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "attach.h"

#define NS_PER_S 1000000000
#define FOLLOW_US 200000

typedef struct log_options {
    common_options_t common;
    bool follow;
} log_options_t;

static const struct argp_option option_table[] = {
    {"follow", 'f', NULL, 0, "Go on with what happens, until the program ends", 1},
    {0},
};

static error_t parse(int key, char *arg, struct argp_state *state)
{
    log_options_t *options = state->input;
    (void)arg;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case 'f': options->follow = true; return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static void print_event(const json_t *event)
{
    char day[32] = "";
    struct tm local;
    const int64_t time_ns = json_integer_value(json_object_get(event, "time_ns"));
    const time_t seconds = (time_t)(time_ns / NS_PER_S);
    if (localtime_r(&seconds, &local))
        strftime(day, sizeof day, "%Y-%m-%d %H:%M:%S", &local);
    printf("%s.%03d  %-15s %s\n", day, (int)(time_ns % NS_PER_S / 1000000), text_of(event, "kind"),
           text_of(event, "text"));
}

/** How far the log has been shown. */
typedef struct progress {
    json_int_t last, lost; /**< lost: those that were overwritten before they could be shown */
    bool more, ended; /**< ended: the run has */
} progress_t;

static bool is_end(const json_t *event)
{
    return strcmp(text_of(event, "kind"), "run") == 0 && json_integer_value(json_object_get(event, "code")) == 0;
}

static cm1e_error_t show_more(cm1e_control_t *control, json_t *all, progress_t *progress, cm1e_diag_t *diag)
{
    char request[80], *text = NULL;
    snprintf(request, sizeof request, "{\"request\": \"log\", \"after\": %" JSON_INTEGER_FORMAT "}", progress->last);
    const cm1e_error_t error = cm1e_control_ask(control, request, &text, diag);
    json_t *reply = text ? json_loads(text, 0, NULL) : NULL;
    free(text);
    if (error == CM1E_OK) {
        json_t *told = json_object_get(reply, "log"), *events = json_object_get(told, "events");
        const json_int_t lost = json_integer_value(json_object_get(told, "lost"));
        size_t i;
        json_t *event;
        progress->lost += lost;
        if (lost > 0 && !all)
            printf("... %" JSON_INTEGER_FORMAT " earlier records are no longer there\n", lost);
        json_array_foreach (events, i, event) {
            progress->ended |= is_end(event);
            if (all)
                json_array_append(all, event);
            else
                print_event(event);
        }
        progress->more = json_array_size(events) > 0;
        progress->last = json_integer_value(json_object_get(told, "last"));
    }
    json_decref(reply);
    return error;
}

/** true: the program has ended, which ends --follow in order. */
static bool has_ended(cm1e_error_t error) { return error == CM1E_ERROR_IO; }

const struct argp argp_log = {option_table, parse, NULL,
                              "Shows the event log of the program that runs the network: states, errors, commands, "
                              "overruns, lost frames. Errors stay in it when they are reset.",
                              attach_children, NULL, NULL};

int command_log(int argc, char **argv)
{
    log_options_t options = {0};
    if (parse_options(&argp_log, argc, argv, &options))
        return EXIT_WRONG_USE;
    static cm1e_bus_config_t config;
    if (!load_network(&options.common, &config))
        return EXIT_WRONG_USE;
    cm1e_diag_t diag = {0};
    cm1e_control_t *control;
    cm1e_error_t error = connect_network(&options.common, &config, &control, &diag);
    if (error != CM1E_OK)
        return fail(&diag);
    json_t *all = options.common.json ? json_array() : NULL;
    progress_t progress = {.more = true};
    while (error == CM1E_OK && (progress.more || (options.follow && !progress.ended))) {
        error = show_more(control, all, &progress, &diag);
        fflush(stdout);
        if (!progress.more && options.follow)
            usleep(FOLLOW_US);
    }
    cm1e_control_close(control);
    if (all)
        print_json(json_pack("{s:I, s:o}", "lost", progress.lost, "events", all));
    return error == CM1E_OK || (options.follow && has_ended(error)) ? EXIT_OK : fail(&diag);
}
