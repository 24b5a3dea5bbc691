/** cm1e enable: gives one motor torque, so that it holds its position, until a key is pressed. It never moves. */
#include <errno.h>
#include <stdatomic.h>
#include <stdio.h>

#include "axis_run.h"
#include "by_hand.h"
#include "core/json_text.h"
#include "terminal.h"

enum { KEY_FOR = 0x600, LONGEST_S = 1000000 };

typedef struct enable_program {
    common_options_t common;
    const char *axis_word, *simulated;
    double seconds;       /* 0: until a key */
    uint32_t axis_number;
    cm1e_scheduler_t *scheduler;
    AXIS_REF_t axis;
    MC_Power_t power;
    cm1e_axis_info_t begin, end;
    int64_t enabled_ns, ended_ns;
    bool failed, told, off;
    WORD error_id;
    atomic_bool end_wanted, enabled;
    progress_t progress;
} enable_program_t;

static error_t parse(int key, char *arg, struct argp_state *state)
{
    enable_program_t *p = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &p->common);
    case KEY_FOR: return parse_seconds(arg, LONGEST_S, &p->seconds) ? 0 : EINVAL;
    case ARGP_KEY_ARG: return parse_axis_word(arg, state, &p->axis_word);
    default: return ARGP_ERR_UNKNOWN;
    }
}

static void prepare(cm1e_scheduler_t *scheduler, void *context)
{
    enable_program_t *p = context;
    p->scheduler = scheduler;
    take_axis(scheduler, p->axis_number, &p->axis, &p->power, &p->progress);
}

static void end(enable_program_t *p, bool failed, WORD error_id)
{
    p->off = true;
    p->failed = failed;
    p->error_id = error_id;
    p->ended_ns = cm1e_scheduler_time_ns(p->scheduler);
    cm1e_axis_read(p->axis, &p->end);
}

static void program(void *context)
{
    enable_program_t *p = context;
    const int64_t now = cm1e_scheduler_time_ns(p->scheduler);
    cm1e_axis_info_t info;
    cm1e_axis_read(p->axis, &info);
    p->power.Enable = !p->off;
    MC_Power(&p->power);
    p->progress.position = info.actual_position;
    if (p->off) {
        if (!p->power.Status)
            cm1e_scheduler_stop(p->scheduler);
        return;
    }
    if (p->power.Status && p->enabled_ns == 0) {
        p->begin = info;
        p->enabled_ns = now;
        p->enabled = true;
    }
    if (p->enabled_ns > 0)
        p->progress.seconds = (double)(now - p->enabled_ns) * 1e-9;
    if (p->power.Error || info.state == CM1E_AXIS_ERROR_STOP)
        end(p, true, p->power.Error ? p->power.ErrorID : cm1e_error_id(info.error));
    else if (p->end_wanted || (p->seconds > 0 && p->enabled_ns > 0 && now - p->enabled_ns > (int64_t)(p->seconds *
                               1e9)))
        end(p, false, 0);
}

/** Beside the cycle: keys end it. */
static void watch(void *context, bool last)
{
    enable_program_t *p = context;
    if (last) {
        progress_clear(&p->progress);
        return;
    }
    if (p->enabled && !p->told) {
        if (!p->common.json && p->seconds == 0)
            fprintf(stderr, "%s is enabled and holds its position. Any key ends it.\n", p->progress.name);
        p->told = true;
    }
    if (p->enabled)
        progress_show(&p->progress);
    if (p->seconds == 0 && terminal_key(0) != TERMINAL_NONE)
        p->end_wanted = true;
}

static int report(void *context)
{
    enable_program_t *p = context;
    char text[CM1E_AXIS_ERROR_TEXT_BYTES] = "";
    const bool was_enabled = p->enabled_ns > 0;
    if (p->ended_ns == 0) { /* a signal */
        cm1e_axis_read(p->axis, &p->end);
        p->ended_ns = cm1e_scheduler_time_ns(p->scheduler);
    }
    const double seconds = was_enabled ? (double)(p->ended_ns - p->enabled_ns) * 1e-9 : 0;
    const double way = was_enabled ? p->end.actual_position - p->begin.actual_position : 0;
    if (p->failed)
        cm1e_axis_error_text(p->axis, text, sizeof text);
    if (p->common.json)
        print_json(json_pack("{s:s, s:b, s:f, s:f, s:f, s:s, s:o, s:b, s:o}", "axis", cm1e_axis_name(p->axis),
                             "enabled",
                             was_enabled, "seconds", seconds, "position", p->end.actual_position, "way", way, "error",
                             p->failed ? cm1e_strerror(cm1e_error_from_id(p->error_id)) : "", "details",
                             cm1e_json_text(text), "simulated", p->simulated[0] != '\0', "timing", timing_as_json()));
    else if (was_enabled && !p->failed)
        printf("%s: was enabled for %.1f s, at %.6g, and was displaced by %.2g%s\n", cm1e_axis_name(p->axis), seconds,
               p->end.actual_position, way, p->simulated);
    if (p->failed)
        complain_of_axis(cm1e_axis_name(p->axis), cm1e_strerror(cm1e_error_from_id(p->error_id)), text);
    return was_enabled && !p->failed ? EXIT_OK : EXIT_FAILED;
}

static const struct argp_option table[] = {
    {"for", KEY_FOR, "SECONDS", 0, "End after this time instead of at a key", 0},
    {0}};
const struct argp argp_enable = {
    table, parse, "[AXIS]",
    "Enables one axis (name or number, default 1): the motor gets torque and holds its position, until a key is "
    "pressed or "
    "the time of --for is over. It never moves by itself. Without a terminal it needs --for.",
    attach_children, NULL, NULL};

int command_enable(int argc, char **argv)
{
    static enable_program_t p;
    static cm1e_bus_config_t config;
    if (parse_options(&argp_enable, argc, argv, &p))
        return EXIT_WRONG_USE;
    if (p.seconds == 0 && !at_a_terminal()) {
        complain("without a terminal no key can end it: give --for SECONDS");
        return EXIT_WRONG_USE;
    }
    cm1e_control_t *control;
    const int attached = attach_if_running(&p.common, &config, &control);
    if (attached != EXIT_OK)
        return attached;
    if (control)
        return enable_attached(&(by_hand_t){.common = &p.common, .axis_word = p.axis_word,
                                            .seconds = p.seconds}, control);
    const int loaded = load_one_axis(&p.common, p.axis_word, &config, &p.axis_number);
    if (loaded != EXIT_OK)
        return loaded;
    p.simulated = simulated_mark(&config);
    if (p.seconds == 0 && !terminal_begin())
        return EXIT_FAILED;
    const axis_run_t run = {.what = "enable", .program = program, .prepare = prepare, .report = report,
                            .watch = watch, .context = &p, .by_person = p.seconds == 0};
    const int status = run_on_axes(&run, &p.common, &config);
    terminal_end();
    return status;
}
