/** cm1e move, cm1e home: a program of function blocks enables one axis, moves or homes it, and disables it. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cm1e/plcopen.h"
#include "cm1e/plot.h"
#include "cm1e/scheduler.h"
#include "cm1e/trace.h"
#include "axis_run.h"
#include "command.h"
#include "trace_file.h"

enum { KEY_TO = 0x300, KEY_BY, KEY_SPEED, KEY_FOR, KEY_JERK, KEY_METHOD, KEY_OFFSET, KEY_TORQUE, KEY_POSITION, KEY_CSV,
       KEY_SVG, KEY_HTML, KEY_NPY, KEY_RESET };

static cm1e_error_t (*const writers[TRACE_FILES])(const cm1e_scheduler_t *scheduler, const char *path, cm1e_diag_t *diag) = {
    cm1e_scheduler_write_csv, cm1e_scheduler_write_svg, cm1e_scheduler_write_html, cm1e_scheduler_write_npy};
enum { TRACE_SAMPLES = 60000, LONGEST_S = 1000000 };

#define DETAILS_NS INT64_C(200000000)

typedef enum motion_kind { MOTION_NONE = 0, MOTION_TO, MOTION_BY, MOTION_SPEED, MOTION_HOME } motion_kind_t;

typedef struct motion_options {
    common_options_t common;
    const char *axis_word, *files[TRACE_FILES]; /**< NULL: not wanted */
    motion_kind_t kind;
    double target, velocity, speed, acceleration, deceleration, jerk, seconds; /**< 0: not given */
    double home_position, modulo_range;
    cm1e_homing_config_t homing; /**< NAN: not given */
    bool velocity_given, method_given, reset;
} motion_options_t;

typedef enum motion_step { STEP_POWER, STEP_RESET, STEP_RUN, STEP_HALT, STEP_SETTLE, STEP_POWER_OFF, STEP_END
} motion_step_t;

/** The program: its blocks, its step, and its result. */
typedef struct motion_program {
    const motion_options_t *options;
    cm1e_scheduler_t *scheduler;
    AXIS_REF_t axis;
    motion_step_t step;
    MC_Power_t power;
    MC_Reset_t reset;
    MC_MoveAbsolute_t move_absolute;
    MC_MoveRelative_t move_relative;
    MC_MoveVelocity_t move_velocity;
    MC_Halt_t halt;
    MC_MoveRelative_t settle; /**< Distance 0 behind the halt: the halt is done with its set-point, this move when
                                   the motor has arrived */
    MC_Home_t home;
    cm1e_axis_info_t before, after;
    uint32_t axis_number;
    const char *what, *simulated;
    progress_t progress;
    int64_t started_ns, ended_ns;
    WORD error_id;
    BOOL failed, done, before_power_failed;
} motion_program_t;

static error_t set_kind(struct argp_state *state, motion_options_t *options, motion_kind_t kind, double *value,
                        char *arg, const char *what)
{
    if (options->kind != MOTION_NONE)
        argp_error(state, "--to, --by and --speed exclude each other");
    options->kind = kind;
    return parse_real(arg, what, value) ? 0 : EINVAL;
}

static error_t parse_real_option(char *arg, const char *what, double *value)
{
    return parse_real(arg, what, value) ? 0 : EINVAL;
}

static error_t parse_speed(char *arg, double *value)
{
    if (*value != 0)
        return 0;
    complain("the speed is %s; expected another number than 0, below 0 for the negative direction", arg);
    return EINVAL;
}

static error_t parse_torque(char *arg, double *value)
{
    if (!parse_real(arg, "the torque", value))
        return EINVAL;
    if (*value >= 10 && *value <= 100)
        return 0;
    complain("the torque is %s %%; expected 10 ... 100", arg);
    return EINVAL;
}

/* Whether the options of a move are consistent. */
static void check_move(const motion_options_t *options, struct argp_state *state)
{
    if (options->kind == MOTION_NONE)
        argp_error(state, "the motion is missing: --to POSITION, --by DISTANCE, or --speed VELOCITY --for SECONDS");
    if (options->kind == MOTION_SPEED && options->seconds == 0)
        argp_error(state, "--speed needs --for SECONDS, above 0");
    if (options->kind != MOTION_SPEED && options->seconds != 0)
        argp_error(state, "--for is only for --speed");
    if (options->kind == MOTION_SPEED && options->velocity_given)
        argp_error(state, "--speed already states the velocity: leave --velocity out");
}

/** What move and home have in common. */
static error_t parse_any(int key, char *arg, struct argp_state *state)
{
    motion_options_t *options = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case KEY_RESET: options->reset = true; return 0;
    case KEY_CSV:
    case KEY_SVG:
    case KEY_HTML:
    case KEY_NPY: options->files[key - KEY_CSV] = arg; return 0;
    case ARGP_KEY_ARG: return parse_axis_word(arg, state, &options->axis_word);
    case ARGP_KEY_END: need_trace_files(state, options->files, TRACE_FILES); return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static error_t parse_move(int key, char *arg, struct argp_state *state)
{
    motion_options_t *options = state->input;
    switch (key) {
    case KEY_TO: return set_kind(state, options, MOTION_TO, &options->target, arg, "the target position");
    case KEY_BY: return set_kind(state, options, MOTION_BY, &options->target, arg, "the distance");
    case KEY_SPEED:
        if (set_kind(state, options, MOTION_SPEED, &options->speed, arg, "the speed") != 0)
            return EINVAL;
        return parse_speed(arg, &options->speed);
    case KEY_FOR: return parse_seconds(arg, LONGEST_S, &options->seconds) ? 0 : EINVAL;
    case 'v':
        options->velocity_given = true;
        return parse_positive(arg, "the velocity", &options->velocity) ? 0 : EINVAL;
    case 'a': return parse_positive(arg, "the acceleration", &options->acceleration) ? 0 : EINVAL;
    case 'd': return parse_positive(arg, "the deceleration", &options->deceleration) ? 0 : EINVAL;
    case KEY_JERK: return parse_positive(arg, "the jerk", &options->jerk) ? 0 : EINVAL;
    case ARGP_KEY_END: check_move(options, state); return parse_any(key, arg, state);
    default: return parse_any(key, arg, state);
    }
}

static error_t parse_home(int key, char *arg, struct argp_state *state)
{
    motion_options_t *options = state->input;
    long long method;
    switch (key) {
    case KEY_METHOD:
        options->method_given = true;
        if (!parse_number(arg, "the homing method", -6, 4, &method))
            return EINVAL;
        options->homing.method = (int8_t)method;
        return 0;
    case 'v': return parse_positive(arg, "the velocity", &options->homing.velocity) ? 0 : EINVAL;
    case 'a': return parse_positive(arg, "the acceleration", &options->homing.acceleration) ? 0 : EINVAL;
    case KEY_OFFSET: return parse_real_option(arg, "the offset", &options->homing.offset);
    case KEY_TORQUE: return parse_torque(arg, &options->homing.torque);
    case KEY_FOR: return parse_seconds(arg, LONGEST_S, &options->homing.timeout_s) ? 0 : EINVAL;
    case KEY_POSITION: return parse_real_option(arg, "the position", &options->home_position);
    default: return parse_any(key, arg, state);
    }
}

static void finish(motion_program_t *p, BOOL done, BOOL failed, WORD error_id)
{
    p->done = done;
    p->before_power_failed = failed && p->step == STEP_POWER;
    p->failed = failed;
    p->error_id = error_id;
    p->step = STEP_POWER_OFF;
    p->ended_ns = cm1e_scheduler_time_ns(p->scheduler);
    cm1e_axis_read(p->axis, &p->after);
}

static void call_blocks(motion_program_t *p)
{
    MC_Power(&p->power);
    MC_Reset(&p->reset);
    MC_MoveAbsolute(&p->move_absolute);
    MC_MoveRelative(&p->move_relative);
    MC_MoveVelocity(&p->move_velocity);
    MC_Halt(&p->halt);
    MC_MoveRelative(&p->settle);
    MC_Home(&p->home);
}

static void start_motion(motion_program_t *p)
{
    cm1e_axis_read(p->axis, &p->before);
    p->started_ns = cm1e_scheduler_time_ns(p->scheduler);
    p->progress.from = p->before.actual_position;
    p->progress.to = p->options->kind == MOTION_TO   ? p->options->target
                     : p->options->kind == MOTION_BY ? p->before.set_position + p->options->target
                                                     : p->before.actual_position;
    p->move_absolute.Execute = p->options->kind == MOTION_TO;
    p->move_relative.Execute = p->options->kind == MOTION_BY;
    p->move_velocity.Execute = p->options->kind == MOTION_SPEED;
    p->home.Execute = p->options->kind == MOTION_HOME;
    p->step = STEP_RUN;
}

static void watch_motion(motion_program_t *p)
{
    const BOOL done = p->move_absolute.Done || p->move_relative.Done || p->home.Done || p->settle.Done;
    const BOOL failed = p->move_absolute.Error || p->move_relative.Error || p->move_velocity.Error || p->home.Error
                        || p->halt.Error || p->settle.Error;
    const WORD error_id = p->move_absolute.ErrorID | p->move_relative.ErrorID | p->move_velocity.ErrorID
                          | p->home.ErrorID | p->halt.ErrorID | p->settle.ErrorID;
    if (done || failed)
        finish(p, done && !failed, failed, error_id);
    else if (p->options->kind == MOTION_SPEED && p->step == STEP_RUN
             && cm1e_scheduler_time_ns(p->scheduler) - p->started_ns > (int64_t)(p->options->seconds * 1e9)) {
        p->halt.Execute = TRUE;
        p->step = STEP_HALT;
    } else if (p->step == STEP_HALT && p->halt.Done) {
        p->settle.Execute = TRUE;
        p->step = STEP_SETTLE;
    }
}

static void wait_for_power(motion_program_t *p, const cm1e_axis_info_t *info)
{
    if (info->state == CM1E_AXIS_ERROR_STOP && p->options->reset && !p->reset.Execute)
        p->step = STEP_RESET;
    else if (p->power.Error || info->state == CM1E_AXIS_ERROR_STOP)
        finish(p, FALSE, TRUE, p->power.Error ? p->power.ErrorID : cm1e_error_id(info->error));
    else if (p->power.Status)
        start_motion(p);
}

static void program(void *context)
{
    motion_program_t *p = context;
    cm1e_axis_info_t info;
    cm1e_axis_read(p->axis, &info);
    p->progress.position = info.actual_position;
    if (p->started_ns > 0 && p->step < STEP_POWER_OFF)
        p->progress.seconds = (double)(cm1e_scheduler_time_ns(p->scheduler) - p->started_ns) * 1e-9;
    p->power.Enable = p->step < STEP_POWER_OFF;
    call_blocks(p);
    switch (p->step) {
    case STEP_POWER:
        wait_for_power(p, &info);
        break;
    case STEP_RESET:
        p->reset.Execute = TRUE;
        if (p->reset.Done)
            p->step = STEP_POWER;
        else if (p->reset.Error)
            finish(p, FALSE, TRUE, p->reset.ErrorID);
        break;
    case STEP_RUN:
    case STEP_HALT:
    case STEP_SETTLE:
        watch_motion(p);
        break;
    case STEP_POWER_OFF:
        if (!p->power.Status)
            p->step = STEP_END;
        break;
    case STEP_END: /* the cause of a failure is known some ms later if a bridge has to ask its motor */
        if (!p->failed || cm1e_scheduler_time_ns(p->scheduler) - p->ended_ns > DETAILS_NS)
            cm1e_scheduler_stop(p->scheduler);
        break;
    }
}

static void prepare(motion_program_t *p, const motion_options_t *options)
{
    p->options = options;
    p->reset = (MC_Reset_t){.Axis = &p->axis};
    p->halt = (MC_Halt_t){.Axis = &p->axis, .Deceleration = options->deceleration, .Jerk = options->jerk};
    p->settle = (MC_MoveRelative_t){.Axis = &p->axis, .Velocity = fabs(options->velocity)};
    p->home = (MC_Home_t){.Axis = &p->axis, .Position = options->home_position,
                          .Parameters = &options->homing};
    p->move_absolute = (MC_MoveAbsolute_t){
        .Axis = &p->axis, .Position = options->target, .Velocity = options->velocity,
        .Acceleration = options->acceleration, .Deceleration = options->deceleration, .Jerk = options->jerk};
    p->move_relative = (MC_MoveRelative_t){
        .Axis = &p->axis, .Distance = options->target, .Velocity = options->velocity,
        .Acceleration = options->acceleration, .Deceleration = options->deceleration, .Jerk = options->jerk};
    p->move_velocity = (MC_MoveVelocity_t){
        .Axis = &p->axis, .Velocity = options->speed, .Direction = mcPositiveDirection,
        .Acceleration = options->acceleration, .Deceleration = options->deceleration, .Jerk = options->jerk};
}

/* Target of the motor; for --speed its set-point. */
static double target_of(const motion_program_t *p)
{
    switch (p->options->kind) {
    case MOTION_TO: return p->options->target;
    case MOTION_BY: return p->before.set_position + p->options->target;
    case MOTION_HOME: return p->options->home_position;
    default: return p->after.set_position;
    }
}

/* Deviation from the target; on a modulo axis the shorter one. NAN: there was no target. */
static double deviation_of(const motion_program_t *p)
{
    if (p->started_ns == 0 || (p->options->kind == MOTION_SPEED && !p->done))
        return NAN;
    const double deviation = p->after.actual_position - target_of(p), turn = p->options->modulo_range;
    return (turn > 0 ? remainder(deviation, turn) : deviation) + 0.0; /* no negative zero */
}

static json_t *report_as_json(const motion_program_t *p, const char *text)
{
    const double deviation = deviation_of(p), seconds = (double)(p->ended_ns - p->started_ns) * 1e-9;
    return json_pack("{s:s, s:s, s:b, s:f, s:f, s:o, s:f, s:s, s:s, s:b, s:o}", "axis", cm1e_axis_name(p->axis),
                     "command", p->what,
                     "done", p->done, "from", p->before.actual_position, "to", p->after.actual_position, "deviation",
                     isnan(deviation) ? json_null() : json_real(deviation), "seconds", p->done ? seconds : 0.0, "error",
                     p->failed ? cm1e_strerror(cm1e_error_from_id(p->error_id)) : "", "details", text,
                     "simulated", p->simulated[0] != '\0', "timing", timing_as_json());
}

static int report(const motion_program_t *p)
{
    const char *what = p->what;
    char text[CM1E_AXIS_ERROR_TEXT_BYTES] = "";
    cm1e_axis_error_text(p->axis, text, sizeof text);
    const bool stopped_well = !p->done && !p->failed && text[0] == '\0';
    if (stopped_well)
        snprintf(text, sizeof text, "%s was interrupted", what);
    if (p->options->common.json)
        print_json(report_as_json(p, text));
    else if (p->done)
        printf("%s: %s done in %.3f s, from %.6g to %.6g, deviation %.2g%s\n", cm1e_axis_name(p->axis), what,
               (double)(p->ended_ns - p->started_ns) * 1e-9, p->before.actual_position, p->after.actual_position,
               deviation_of(p), p->simulated);
    if (p->failed)
        complain_of_axis(cm1e_axis_name(p->axis), cm1e_strerror(cm1e_error_from_id(p->error_id)), text);
    else if (!p->done)
        complain("%s: %s was interrupted%s%s", cm1e_axis_name(p->axis), what, stopped_well ? "" : ", and then: ",
                 stopped_well ? "" : text);
    if (p->failed && p->before_power_failed)
        complain("--reset does that here");
    return p->done ? EXIT_OK : EXIT_FAILED;
}

static void prepare_run(cm1e_scheduler_t *scheduler, void *context)
{
    motion_program_t *p = context;
    p->scheduler = scheduler;
    take_axis(scheduler, p->axis_number, &p->axis, &p->power, &p->progress);
    prepare(p, p->options);
}

static int report_run(void *context)
{
    motion_program_t *p = context;
    if (p->ended_ns == 0) /* interrupted: it stands where the ramp of the run's end has left it */
        cm1e_axis_read(p->axis, &p->after);
    return report(p);
}

static void watch_run(void *context, bool end)
{
    motion_program_t *p = context;
    if (end)
        progress_clear(&p->progress);
    else if (p->progress.seconds > 0)
        progress_show(&p->progress);
}

static bool wants_trace(const motion_options_t *options)
{
    for (int i = 0; i < TRACE_FILES; i++)
        if (options->files[i])
            return true;
    return false;
}

static bool keep_traces(cm1e_scheduler_t *scheduler, void *context)
{
    const motion_options_t *options = ((motion_program_t *)context)->options;
    cm1e_diag_t diag = {0};
    bool kept = true;
    for (int i = 0; i < TRACE_FILES; i++)
        if (options->files[i] && writers[i](scheduler, options->files[i], &diag) != CM1E_OK)
            kept = fail(&diag) == EXIT_OK;
    if (kept && wants_trace(options))
        tell_missing_cycles(scheduler, TRACE_SAMPLES);
    return kept;
}

static void complete(double *value, double otherwise)
{
    if (isnan(*value))
        *value = otherwise;
}

/* Values that are not given are those of the bus file. With another method they are defaults, because the offset would
 * not fit. */
static void complete_homing(motion_options_t *options, const cm1e_homing_config_t *configured)
{
    static const cm1e_homing_config_t defaults;
    const cm1e_homing_config_t *rest = options->method_given ? &defaults : configured;
    cm1e_homing_config_t *homing = &options->homing;
    if (!options->method_given)
        homing->method = configured->method;
    complete(&homing->offset, rest->offset);
    complete(&homing->velocity, rest->velocity);
    complete(&homing->acceleration, rest->acceleration);
    complete(&homing->torque, rest->torque);
    complete(&homing->timeout_s, rest->timeout_s);
}

static bool has_homing_method(const motion_options_t *options)
{
    if (options->kind != MOTION_HOME || options->homing.method != 0)
        return true;
    complain("the homing method is missing: --method METHOD (-6 ... -1, behind a bridge 1 ... 4), or homing.method in "
             "the bus file");
    return false;
}

static int move_or_home(motion_options_t *options, const char *what)
{
    static cm1e_bus_config_t config;
    const int files = check_trace_files(options->files, TRACE_FILES);
    if (files != EXIT_OK)
        return files;
    static motion_program_t p;
    const int loaded = load_one_axis(&options->common, options->axis_word, &config, &p.axis_number);
    if (loaded != EXIT_OK)
        return loaded;
    cm1e_axis_config_t *axis = &config.axes[p.axis_number];
    if (options->kind == MOTION_HOME)
        complete_homing(options, &axis->homing);
    else if (options->velocity == 0)
        options->velocity = 1.0;
    if (!has_homing_method(options))
        return EXIT_WRONG_USE;
    axis->in_position_done_waits = axis->type == CM1E_AXIS_MOTOR;
    options->modulo_range = axis->modulo_range;
    p.options = options;
    p.what = what;
    p.simulated = simulated_mark(&config);
    const axis_run_t run = {.what = what, .program = program, .prepare = prepare_run, .report = report_run,
                            .watch = watch_run, .keep = keep_traces, .context = &p,
                            .settings = {.trace_capacity = wants_trace(options) ? TRACE_SAMPLES : 0}};
    return run_on_axes(&run, &options->common, &config);
}

/** Options that move and home have in common. */
#define OPTIONS_OF_BOTH \
    {"reset", KEY_RESET, NULL, 0, "Reset an error of the drive first", 0}, \
    {"csv", KEY_CSV, "FILE", 0, "Write a trace", 0}, \
    {"svg", KEY_SVG, "FILE", 0, "Write a plot", 0}, \
    {"html", KEY_HTML, "FILE", 0, "Write the trace as a page for a browser: zoom, cursors, events", 0}, \
    {"npy", KEY_NPY, "FILE", 0, "Write the trace for NumPy", 0}

static const struct argp_option move_table[] = {
    {"to", KEY_TO, "POSITION", 0, "Absolute target, in units of the axis", 0},
    {"by", KEY_BY, "DISTANCE", 0, "Relative distance", 0},
    {"speed", KEY_SPEED, "VELOCITY", 0, "Move at this velocity, then halt", 0},
    {"for", KEY_FOR, "SECONDS", 0, "Duration of --speed", 0},
    {"velocity", 'v', "VELOCITY", 0, "Units/s; default 1", 0},
    {"acceleration", 'a', "ACCELERATION", 0, "Units/s2; default: the axis's maximum", 0},
    {"deceleration", 'd', "DECELERATION", 0, "Units/s2; default: the axis's maximum", 0},
    {"jerk", KEY_JERK, "JERK", 0, "Units/s3; default: the axis's maximum", 0},
    OPTIONS_OF_BOTH,
    {0}};
const struct argp argp_move = {move_table, parse_move, "[AXIS]",
                                 "Enables one axis (name or number, default 1), moves it, disables it. The command "
                                 "is done when the motor is in position (in_position of the bus file). Without a "
                                 "bus file the unit is one revolution.", common_children, NULL, NULL};

int command_move(int argc, char **argv)
{
    motion_options_t options = {0};
    if (parse_options(&argp_move, argc, argv, &options))
        return EXIT_WRONG_USE;
    return move_or_home(&options, "move");
}

static const struct argp_option home_table[] = {
    {"method", KEY_METHOD, "METHOD", 0, "-1/-2 hard stop CW/CCW, -3/-4 input 2 CW/CCW, -5/-6 input 3 CW/CCW; "
                                        "behind a bridge 1/2 hard stop, 3/4 switch CW/CCW; default: the bus "
                                        "file's homing", 0},
    {"velocity", 'v', "VELOCITY", 0, "Units/s", 0},
    {"acceleration", 'a', "ACCELERATION", 0, "Units/s2", 0},
    {"offset", KEY_OFFSET, "OFFSET", 0, "Units from the reference to the home position", 0},
    {"torque", KEY_TORQUE, "PERCENT", 0, "10 ... 100 % of rated torque", 0},
    {"position", KEY_POSITION, "POSITION", 0, "Position of the axis at the home position; default 0", 0},
    {"for", KEY_FOR, "SECONDS", 0, "Maximum time; default 60", 0},
    OPTIONS_OF_BOTH,
    {0}};
const struct argp argp_home = {home_table, parse_home, "[AXIS]",
                                 "Enables one axis (name or number, default 1), homes it, disables it. Values that "
                                 "are not given are those of the bus file; with --method they are the defaults of "
                                 "the motor.",
                                 common_children, NULL, NULL};

int command_home(int argc, char **argv)
{
    motion_options_t options = {.kind = MOTION_HOME,
                                .homing = {.offset = NAN, .velocity = NAN, .acceleration = NAN, .torque = NAN,
                                           .timeout_s = NAN}};
    if (parse_options(&argp_home, argc, argv, &options))
        return EXIT_WRONG_USE;
    return move_or_home(&options, "home");
}
