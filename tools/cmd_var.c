/** cm1e var: variables of a program that another process runs: their values, and values from outside, once or forced. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "attach.h"
#include "core/clock.h"
#include "core/near.h"
#include "command.h"
#include "end_signals.h"
#include "variable_value.h"

enum { KEY_ALLOW = 0xC00, KEY_FOR, NAMES = 64, KEEP_MS = 1000, PAUSE_US = 200000 };

typedef struct var_options {
    common_options_t common;
    const char *word;
    const char *names[NAMES]; /**< NAME, or NAME=VALUE */
    json_t *values[NAMES];    /**< of set, force and release */
    int count;
    double seconds;
    bool allow;
} var_options_t;

static bool writes(const var_options_t *options)
{
    return strcmp(options->word, "set") == 0 || strcmp(options->word, "force") == 0;
}

static void check(const var_options_t *options, struct argp_state *state)
{
    if (!options->word || choose_word("action", options->word, "list|get|set|force|release") < 0)
        argp_error(state, "what is to be done? list, get, set, force or release");
    if (options->count == 0 && strcmp(options->word, "list") != 0)
        argp_error(state, "which variable? `cm1e var list` shows them");
    for (int i = 0; i < options->count && writes(options); i++)
        if (!strchr(options->names[i], '=') || strchr(options->names[i], '=') == options->names[i])
            argp_error(state, "\"%s\": expected NAME=VALUE, as Main.start=TRUE", options->names[i]);
    if (writes(options) && !options->allow)
        argp_error(state, "a variable from outside may let the program move a motor: --allow-write");
    if (options->seconds > 0 && strcmp(options->word, "force") != 0)
        argp_error(state, "--for is for force");
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    var_options_t *options = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case KEY_ALLOW: options->allow = true; return 0;
    case KEY_FOR: return parse_seconds(arg, 1000000, &options->seconds) ? 0 : EINVAL;
    case ARGP_KEY_ARG:
        if (!options->word)
            options->word = arg;
        else if (options->count < NAMES)
            options->names[options->count++] = arg;
        else
            argp_error(state, "at most %d variables", NAMES);
        return 0;
    case ARGP_KEY_END: check(options, state); return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_option table[] = {
    {"allow-write", KEY_ALLOW, NULL, 0, "Give variables values: the program may move a motor by them", 0},
    {"for", KEY_FOR, "SECONDS", 0, "force: how long (default: until Ctrl-C)", 0},
    {0}};
const struct argp argp_var = {
    table, parse, "list [PART-OF-A-NAME...]\nget NAME...\nset NAME=VALUE...\nforce NAME=VALUE...\nrelease NAME...",
    "Variables of a running program in Structured Text (`cm1e run`). A value is written as in the program: TRUE, 12.5, 16#FF, "
    "T#1m5s, the name of an enumerator, a text in quotes. set writes once; force keeps the values, whatever the "
    "program writes, until this command ends. Forced variables are marked, and the event log has who was forced when. "
    "Both need control: maintain in the bus file of the program. release ends what anybody forces.",
    attach_children, NULL, NULL};

/* ---- values ------------------------------------------------------------------------------------------------------ */

static void print_row(const json_t *row)
{
    char value[VARIABLE_TEXT_BYTES];
    variable_text(row, value, sizeof value);
    printf("%-40s %-10s %s%s\n", text_of(row, "name"), text_of(row, "declared"), value,
           json_is_true(json_object_get(row, "forced")) ? "  FORCED" : "");
}

/** The name is wanted: one of those stated, or, of a list, with one of them in it. */
static bool is_wanted(const var_options_t *options, const char *name)
{
    const bool list = strcmp(options->word, "list") == 0;
    bool wanted = list && options->count == 0;
    for (int i = 0; i < options->count; i++)
        wanted = wanted || (list ? strcasestr(name, options->names[i]) != NULL : strcasecmp(name, options->names[i]) == 0);
    return wanted;
}

static bool refuse_unknown(const var_options_t *options, const json_t *all)
{
    bool good = true;
    for (int i = 0; i < options->count && strcmp(options->word, "get") == 0; i++) {
        char text[CM1E_NEAR_TEXT_BYTES];
        cm1e_near_t near = {.word = options->names[i]};
        bool found = false;
        for (size_t k = 0; k < json_array_size(all); k++) {
            const char *name = text_of(json_array_get(all, k), "name");
            found = found || strcasecmp(name, options->names[i]) == 0;
            cm1e_near_look(&near, name);
        }
        if (!found)
            complain("the program has no variable \"%s\"%s", options->names[i], cm1e_near_text(&near, text, sizeof text));
        good = good && found;
    }
    return good;
}

/** All variables, some in each reply, until one has none; NULL: `diag` says why. */
static json_t *all_variables(cm1e_control_t *control, cm1e_diag_t *diag)
{
    json_t *all = json_array();
    for (size_t came = 1; came > 0;) {
        json_t *part = ask_program(control, json_pack("{s:s, s:I}", "request", "variables", "from",
                                                      (json_int_t)json_array_size(all)), "variables", diag);
        if (!part) {
            json_decref(all);
            return NULL;
        }
        came = json_array_size(part);
        json_array_extend(all, part);
        json_decref(part);
    }
    return all;
}

static int show(const var_options_t *options, cm1e_control_t *control)
{
    cm1e_diag_t diag = {0};
    json_t *all = all_variables(control, &diag);
    if (!all)
        return fail(&diag);
    json_t *chosen = json_array();
    for (size_t i = 0; i < json_array_size(all); i++)
        if (is_wanted(options, text_of(json_array_get(all, i), "name")))
            json_array_append(chosen, json_array_get(all, i));
    const bool good = refuse_unknown(options, all), some = json_array_size(chosen) > 0;
    for (size_t i = 0; i < json_array_size(chosen) && !options->common.json; i++)
        print_row(json_array_get(chosen, i));
    if (json_array_size(all) == 0 && !options->common.json)
        complain("the program has named no variables; those of a program in Structured Text have names");
    if (options->common.json)
        print_json(json_incref(chosen));
    json_decref(chosen);
    json_decref(all);
    return good ? EXIT_OK : some ? EXIT_FAILED : EXIT_WRONG_USE;
}

/* ---- writing ----------------------------------------------------------------------------------------------------- */

static json_t *name_of(const char *word) { return json_stringn(word, strcspn(word, "=")); }

/** What a word NAME=VALUE gives its variable, which the program describes; NULL, with a complaint or `diag`. */
static json_t *value_of(const char *word, cm1e_control_t *control, cm1e_diag_t *diag)
{
    json_t *rows = ask_program(control, json_pack("{s:s, s:o}", "request", "variables", "name", name_of(word)), "variables",
                               diag);
    json_t *value = rows ? variable_value(json_array_get(rows, 0), strchr(word, '=') + 1) : NULL;
    json_decref(rows);
    return value;
}

/** The values of all words, of a release null; false: with a complaint or `diag`. */
static bool take_values(var_options_t *options, cm1e_control_t *control, cm1e_diag_t *diag)
{
    bool good = true;
    for (int i = 0; i < options->count && good; i++) {
        options->values[i] = writes(options) ? value_of(options->names[i], control, diag) : json_null();
        good = options->values[i] != NULL;
    }
    return good;
}

/** After a change that failed: the exit status. The connection ends, and with it what this command has forced. */
static int fail_of(int done, const cm1e_diag_t *diag) { return done == 0 ? fail_at_once(diag) : fail(diag); }

/** Writes, forces or releases one, or asks only whether that would be refused; false: `diag` says why. */
static bool change(const var_options_t *options, cm1e_control_t *control, int i, bool check, cm1e_diag_t *diag)
{
    json_t *done = ask_program(control, json_pack("{s:s, s:o, s:O, s:b, s:b, s:i}", "request", "variable", "name",
                                                  name_of(options->names[i]), "value", options->values[i], "check", check,
                                                  "force", strcmp(options->word, "force") == 0, "keep_ms", KEEP_MS),
                               "variable", diag);
    json_decref(done);
    return done != NULL;
}

/** Of several variables none is written if one of them is refused. */
static bool check_all(const var_options_t *options, cm1e_control_t *control, cm1e_diag_t *diag)
{
    bool good = true;
    for (int i = 0; i < options->count && options->count > 1 && writes(options) && good; i++)
        good = change(options, control, i, true, diag);
    return good;
}

/** Returns how many were changed; less than all: `diag` says why. */
static int change_all(const var_options_t *options, cm1e_control_t *control, cm1e_diag_t *diag)
{
    int done = 0;
    while (done < options->count && change(options, control, done, false, diag))
        done++;
    if (done < options->count && done > 0 && strcmp(options->word, "set") == 0)
        complain("the first %d of %d variables were written, the others were not", done, options->count);
    return done;
}

/** Renews what is forced. What somebody else has released is left out from then on; false: `diag` says what is wrong. */
static bool renew_all(var_options_t *options, cm1e_control_t *control, cm1e_diag_t *diag)
{
    for (int i = 0; i < options->count;) {
        if (change(options, control, i, false, diag)) {
            i++;
            continue;
        }
        if (diag->error != CM1E_ERROR_CANCELLED)
            return false;
        complain("somebody else has released %.*s", (int)strcspn(options->names[i], "="), options->names[i]);
        json_decref(options->values[i]);
        options->count--;
        options->names[i] = options->names[options->count];
        options->values[i] = options->values[options->count];
    }
    return true;
}

/** Renews what is forced until the end; the program ends it if this process is suspended or killed. */
static int force(var_options_t *options, cm1e_control_t *control)
{
    cm1e_diag_t diag = {0};
    const int64_t begin_ns = cm1e_clock_now(cm1e_clock_monotonic());
    const int done = change_all(options, control, &diag), forced = options->count;
    if (done < forced)
        return fail_of(done, &diag);
    fprintf(stderr, "%d variable%s forced; %s\n", forced, forced == 1 ? " is" : "s are",
            options->seconds > 0 ? "the program has them again afterwards" : "Ctrl-C gives them back to the program");
    fflush(stderr);
    bool good = true, ended = false;
    while (good && !ended && !told_to_end()) {
        usleep(PAUSE_US);
        good = renew_all(options, control, &diag);
        ended = options->count == 0 ||
                (options->seconds > 0 &&
                 (double)(cm1e_clock_now(cm1e_clock_monotonic()) - begin_ns) * 1e-9 >= options->seconds);
    }
    if (good)
        return options->count == forced ? EXIT_OK : EXIT_FAILED;
    return fail(&diag);
}

static int act(var_options_t *options, cm1e_control_t *control)
{
    cm1e_diag_t diag = {0};
    if (strcmp(options->word, "list") == 0 || strcmp(options->word, "get") == 0)
        return show(options, control);
    catch_signals();
    if (!take_values(options, control, &diag))
        return diag.text[0] ? fail_at_once(&diag) : EXIT_WRONG_USE;
    if (!check_all(options, control, &diag))
        return fail_at_once(&diag);
    if (strcmp(options->word, "force") == 0)
        return force(options, control);
    const int done = change_all(options, control, &diag);
    return done == options->count ? EXIT_OK : fail_of(done, &diag);
}

int command_var(int argc, char **argv)
{
    static cm1e_bus_config_t config;
    var_options_t options = {0};
    cm1e_diag_t diag = {0};
    cm1e_control_t *control;
    if (parse_options(&argp_var, argc, argv, &options) || !load_network(&options.common, &config))
        return EXIT_WRONG_USE;
    const cm1e_error_t error = connect_network(&options.common, &config, &control, &diag);
    cm1e_bus_config_free(&config);
    if (error != CM1E_OK)
        return fail(&diag);
    const int status = act(&options, control);
    for (int i = 0; i < options.count; i++)
        json_decref(options.values[i]);
    cm1e_control_close(control); /* with it, what is forced is the program's again */
    return status;
}
