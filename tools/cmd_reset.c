/** cm1e reset: acknowledges the errors of drives. Nothing moves, and no motor gets torque. */
#include <stdio.h>
#include <string.h>

#include "axis_run.h"
#include "by_hand.h"
#include "core/json_text.h"
#include "device/place.h"

enum { LOOK_NS = 300000000 }; /* until then a drive has shown the error that it has */

typedef struct axis_reset {
    AXIS_REF_t axis;
    MC_Reset_t reset;
    cm1e_axis_info_t before;
    bool looked_at, had_error, ended;
    char text[CM1E_AXIS_ERROR_TEXT_BYTES];
} axis_reset_t;

typedef struct reset_program {
    common_options_t common;
    const char *axis_word, *simulated;
    int only; /* axis; -1: all */
    const cm1e_bus_config_t *config;
    cm1e_scheduler_t *scheduler;
    axis_reset_t axes[CM1E_MAX_AXES];
    uint32_t count;
    int64_t started_ns;
} reset_program_t;

static error_t parse(int key, char *arg, struct argp_state *state)
{
    reset_program_t *p = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &p->common);
    case ARGP_KEY_ARG:
        if (p->axis_word)
            argp_error(state, "one axis, or none for all; \"%s\" is too many", arg);
        p->axis_word = arg;
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static void prepare(cm1e_scheduler_t *scheduler, void *context)
{
    reset_program_t *p = context;
    p->scheduler = scheduler;
    for (uint32_t i = 0; i < p->config->axis_count; i++) {
        if (!cm1e_axis_has_motor(&p->config->axes[i]) || (p->only >= 0 && p->only != (int)i))
            continue;
        axis_reset_t *a = &p->axes[p->count++];
        a->axis = cm1e_scheduler_axis(scheduler, i);
        a->reset = (MC_Reset_t){.Axis = &a->axis};
    }
}

static void look(axis_reset_t *a)
{
    cm1e_axis_read(a->axis, &a->before);
    a->looked_at = true;
    a->had_error = a->before.state == CM1E_AXIS_ERROR_STOP;
    a->reset.Execute = a->had_error;
    a->ended = !a->had_error;
    if (a->had_error)
        cm1e_axis_error_text(a->axis, a->text, sizeof a->text);
}

static void program(void *context)
{
    reset_program_t *p = context;
    const int64_t now = cm1e_scheduler_time_ns(p->scheduler);
    bool all = true;
    if (p->started_ns == 0)
        p->started_ns = now;
    for (uint32_t i = 0; i < p->count; i++) {
        axis_reset_t *a = &p->axes[i];
        if (!a->looked_at && now - p->started_ns >= LOOK_NS)
            look(a);
        MC_Reset(&a->reset);
        a->ended = a->ended || a->reset.Done || a->reset.Error;
        all = all && a->ended;
    }
    if (all)
        cm1e_scheduler_stop(p->scheduler);
}

static void tell_reset(const axis_reset_t *a, const char *simulated)
{
    char line[AXIS_LINE_BYTES];
    describe_error(line, sizeof line, cm1e_axis_name(a->axis), cm1e_strerror(a->before.error), a->text);
    printf("%s: error reset%s. It was: %s\n", cm1e_axis_name(a->axis), simulated, line);
}

static int report(void *context)
{
    reset_program_t *p = context;
    json_t *all = json_array();
    int status = EXIT_OK;
    for (uint32_t i = 0; i < p->count; i++) {
        const axis_reset_t *a = &p->axes[i];
        char why[CM1E_AXIS_ERROR_TEXT_BYTES] = "";
        const bool good = a->had_error ? a->reset.Done : a->ended;
        if (!good) {
            cm1e_axis_error_text(a->axis, why, sizeof why);
            status = EXIT_FAILED;
        }
        json_array_append_new(all, json_pack("{s:s, s:b, s:b, s:s, s:i, s:o, s:s}", "axis", cm1e_axis_name(a->axis),
                                             "had_error", a->had_error, "good", good, "error",
                                             a->had_error ? cm1e_strerror(a->before.error) : "", "device_error",
                                             a->before.device_error, "details", cm1e_json_text(a->text), "why", why));
        if (p->common.json)
            continue;
        if (!a->had_error && good)
            printf("%s: has no error%s\n", cm1e_axis_name(a->axis), p->simulated);
        else if (good)
            tell_reset(a, p->simulated);
        else if (a->reset.Error)
            complain_of_axis(cm1e_axis_name(a->axis), cm1e_strerror(cm1e_error_from_id(a->reset.ErrorID)), why);
        else if (a->had_error)
            complain("%s: the error is still there. %s", cm1e_axis_name(a->axis), why);
        else
            complain("%s: the command was ended before it knew whether there is an error", cm1e_axis_name(a->axis));
    }
    if (p->common.json)
        print_json(all);
    else
        json_decref(all);
    return status;
}

const struct argp argp_reset = {
    NULL, parse, "[AXIS]",
    "Resets the error of one axis (name or number), or of all axes, and says what it was. The cause must be gone: "
    "`cm1e "
    "status` shows it, `cm1e explain CODE` explains it. No motor moves or gets torque; if a "
    "program runs the network, that decides on the torque.", attach_children, NULL, NULL};

int command_reset(int argc, char **argv)
{
    static reset_program_t p;
    static cm1e_bus_config_t config;
    if (parse_options(&argp_reset, argc, argv, &p))
        return EXIT_WRONG_USE;
    cm1e_control_t *control;
    const int attached = attach_if_running(&p.common, &config, &control);
    if (attached != EXIT_OK)
        return attached;
    if (control)
        return reset_attached(&(by_hand_t){.common = &p.common, .axis_word = p.axis_word}, control);
    const int loaded = load_axes(&p.common, &config);
    if (loaded != EXIT_OK)
        return loaded;
    p.only = p.axis_word ? find_axis(&config, p.axis_word) : -1;
    if (p.axis_word && p.only < 0)
        return EXIT_WRONG_USE;
    p.config = &config;
    p.simulated = simulated_mark(&config);
    const axis_run_t run = {.what = "reset", .program = program, .prepare = prepare, .report = report, .context = &p};
    return run_on_axes(&run, &p.common, &config);
}
