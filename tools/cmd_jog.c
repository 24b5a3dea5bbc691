/** cm1e jog: moves one axis while an arrow key is held. A terminal tells of keys that repeat, and not of keys that are
 *  let go: the motor stops when no repetition has come for a short time. */
#include <errno.h>
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>

#include "axis_run.h"
#include "by_hand.h"
#include "core/json_text.h"
#include "jog_keys.h"
#include "terminal.h"

enum { KEY_DEAD_MAN = 0x600, KEY_MS = 5 };
#define DEAD_MAN_S 0.2
#define LEAST_DEAD_MAN_S 0.05
#define LONGEST_DEAD_MAN_S 1.0

typedef struct jog_program {
    common_options_t common;
    const char *axis_word, *simulated;
    double velocity, acceleration, dead_man_s;
    uint32_t axis_number;
    cm1e_scheduler_t *scheduler;
    AXIS_REF_t axis;
    MC_Power_t power;
    MC_Jog_t jog;
    bool failed, off;
    WORD error_id;
    double from, to;
    int64_t heard_ns[2];              /* forward, backwards: when the key came last */
    unsigned heard[2];
    atomic_uint keys[2];              /* counted by the thread that reads them */
    atomic_bool end_wanted, enabled, moving;
    _Atomic double factor;            /* of the velocity */
    jog_keys_t read;                  /* by that thread */
    progress_t progress;
} jog_program_t;

static error_t parse(int key, char *arg, struct argp_state *state)
{
    jog_program_t *p = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &p->common);
    case 'v': return parse_positive(arg, "the velocity", &p->velocity) ? 0 : EINVAL;
    case 'a': return parse_positive(arg, "the acceleration", &p->acceleration) ? 0 : EINVAL;
    case KEY_DEAD_MAN:
        if (!parse_real(arg, "the dead-man time", &p->dead_man_s))
            return EINVAL;
        if (p->dead_man_s >= LEAST_DEAD_MAN_S && p->dead_man_s <= LONGEST_DEAD_MAN_S)
            return 0;
        complain("the dead-man time is %s s; expected %g ... %g", arg, LEAST_DEAD_MAN_S, LONGEST_DEAD_MAN_S);
        return EINVAL;
    case ARGP_KEY_ARG: return parse_axis_word(arg, state, &p->axis_word);
    default: return ARGP_ERR_UNKNOWN;
    }
}

static void prepare(cm1e_scheduler_t *scheduler, void *context)
{
    jog_program_t *p = context;
    p->scheduler = scheduler;
    take_axis(scheduler, p->axis_number, &p->axis, &p->power, &p->progress);
    p->jog = (MC_Jog_t){.Axis = &p->axis, .Mode = MC_JOGMODE_CONTINOUS, .Velocity = p->velocity,
                        .Acceleration = p->acceleration, .Deceleration = p->acceleration};
}

/* ---- in the cycle ------------------------------------------------------------------------------------------------ */

/** Whether the key of a direction was pressed or repeated within the dead-man time. */
static bool is_held(jog_program_t *p, int direction, int64_t now)
{
    const unsigned keys = p->keys[direction];
    if (keys != p->heard[direction]) {
        p->heard[direction] = keys;
        p->heard_ns[direction] = now;
        p->heard_ns[!direction] = 0; /* the other direction ends at once */
    }
    return p->heard_ns[direction] != 0 && now - p->heard_ns[direction] < (int64_t)(p->dead_man_s * 1e9);
}

static void end(jog_program_t *p, bool failed, WORD error_id)
{
    p->off = true;
    p->failed = failed;
    p->error_id = error_id;
}

static void program(void *context)
{
    jog_program_t *p = context;
    const int64_t now = cm1e_scheduler_time_ns(p->scheduler);
    cm1e_axis_info_t info;
    cm1e_axis_read(p->axis, &info);
    const bool forward = is_held(p, 0, now), backwards = is_held(p, 1, now);
    const bool may_move = p->power.Status && !p->end_wanted && !p->off;
    if (!p->jog.JogForward && !p->jog.JogBackwards)
        p->jog.Velocity = p->velocity * p->factor;
    p->jog.JogForward = may_move && forward;
    p->jog.JogBackwards = may_move && backwards;
    p->power.Enable = !p->off;
    MC_Power(&p->power);
    MC_Jog(&p->jog);
    p->to = info.actual_position;
    p->progress.position = info.actual_position;
    p->progress.seconds = (double)now * 1e-9;
    p->moving = info.set_velocity != 0;
    if (p->power.Status && !p->enabled) {
        p->from = info.actual_position;
        p->enabled = true;
    }
    if (p->off && !p->power.Status)
        cm1e_scheduler_stop(p->scheduler);
    else if (p->off)
        return;
    else if (p->power.Error || info.state == CM1E_AXIS_ERROR_STOP)
        end(p, true, p->power.Error ? p->power.ErrorID : cm1e_error_id(info.error));
    else if (p->jog.Error)
        end(p, true, p->jog.ErrorID);
    else if (p->end_wanted && !p->jog.Busy && !p->moving)
        end(p, false, 0);
}

/* ---- beside the cycle -------------------------------------------------------------------------------------------- */

static void watch(void *context, bool last)
{
    jog_program_t *p = context;
    if (last) {
        jog_line_clear();
        return;
    }
    jog_keys_read(&p->read, KEY_MS);
    p->keys[0] = p->read.forward;
    p->keys[1] = p->read.backwards;
    p->factor = p->read.factor;
    if (p->read.end)
        p->end_wanted = true;
    if (p->enabled)
        jog_line(p->progress.name, p->progress.position, p->moving, p->velocity * p->factor);
}

static int report(void *context)
{
    jog_program_t *p = context;
    char text[CM1E_AXIS_ERROR_TEXT_BYTES] = "";
    if (p->failed)
        cm1e_axis_error_text(p->axis, text, sizeof text);
    if (p->common.json)
        print_json(json_pack("{s:s, s:b, s:f, s:f, s:s, s:o, s:b, s:o}", "axis", cm1e_axis_name(p->axis), "done",
                             !p->failed, "from", p->from, "to", p->to, "error",
                             p->failed ? cm1e_strerror(cm1e_error_from_id(p->error_id)) : "", "details",
                             cm1e_json_text(text), "simulated", p->simulated[0] != '\0', "timing", timing_as_json()));
    else if (!p->failed)
        printf("%s: jogged from %.6g to %.6g%s\n", cm1e_axis_name(p->axis), p->from, p->to, p->simulated);
    if (p->failed)
        complain_of_axis(cm1e_axis_name(p->axis), cm1e_strerror(cm1e_error_from_id(p->error_id)), text);
    return p->failed ? EXIT_FAILED : EXIT_OK;
}

static const struct argp_option table[] = {
    {"velocity", 'v', "VELOCITY", 0, "Units/s; default 0.5", 0},
    {"acceleration", 'a', "ACCELERATION", 0, "Units/s2, also for stopping; default: the axis's maximum", 0},
    {"dead-man", KEY_DEAD_MAN, "SECONDS", 0, "The motor stops when the key has not repeated for so long, 0.05 ... 1; "
                                             "default 0.2", 0},
    {0}};
const struct argp argp_jog = {
    table, parse, "[AXIS]",
    "Enables one axis (name or number, default 1) and moves it while an arrow key is held: right or up in positive "
    "direction, left or down in negative direction. [ and ] halve and double the velocity for the next motion, q "
    "ends.\vThe dead-man is the repetition of the key: the motor stops when none has come for the time of "
    "--dead-man. A "
    "terminal pauses between a key and its first repetition, so a motion begins with a short step. It needs a "
    "terminal.",
    attach_children, NULL, NULL};

int command_jog(int argc, char **argv)
{
    static jog_program_t p;
    static cm1e_bus_config_t config;
    p = (jog_program_t){.velocity = 0.5, .dead_man_s = DEAD_MAN_S, .factor = 1, .read.factor = 1};
    if (parse_options(&argp_jog, argc, argv, &p))
        return EXIT_WRONG_USE;
    if (!at_a_terminal()) {
        complain("jog needs a terminal: a person must hold a key while the motor moves. `cm1e move` needs none");
        return EXIT_WRONG_USE;
    }
    cm1e_control_t *control;
    const int attached = attach_if_running(&p.common, &config, &control);
    if (attached != EXIT_OK)
        return attached;
    if (control)
        return jog_attached(&(by_hand_t){.common = &p.common, .axis_word = p.axis_word, .velocity = p.velocity,
                                         .acceleration = p.acceleration, .dead_man_s = p.dead_man_s}, control);
    const int loaded = load_one_axis(&p.common, p.axis_word, &config, &p.axis_number);
    if (loaded != EXIT_OK)
        return loaded;
    p.simulated = simulated_mark(&config);
    if (!terminal_begin())
        return EXIT_FAILED;
    const axis_run_t run = {.what = "jog", .program = program, .prepare = prepare, .report = report, .watch = watch,
                            .context = &p, .by_person = true};
    const int status = run_on_axes(&run, &p.common, &config);
    terminal_end();
    return status;
}
