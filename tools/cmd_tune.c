/** cm1e tune: moves one axis within limits and measures how it follows, before and after a change of its parameters. */
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "attach.h"
#include "axis_run.h"
#include "end_signals.h"
#include "params.h"
#include "trace_file.h"
#include "tune.h"
#include "tune_page.h"

enum { KEY_TRAVEL = 0xA00, KEY_VELOCITY, KEY_FREQUENCY, KEY_TO, KEY_STEPS, KEY_SET, KEY_KEEP, KEY_HTML, KEY_WINDOW,
       KEY_JERK, SETTINGS_MAX = 16 };
#define KINDS "step|ramp|sine|chirp"
#define PAUSE_S 0.3        /* at standstill, before a part and behind it */
#define BEYOND_TRAVEL 1.1  /* what a motor that overshoots may use of it */
#define DEFAULT_ACCELERATION_COUNTS 5e6 /* counts/s2 and counts/s3: defaults of the configuration */
#define DEFAULT_JERK_COUNTS 1e8
#define SMALLEST_AMPLITUDE_COUNTS 20

typedef struct tune_options {
    common_options_t common;
    int kind; /* tune_kind_t; -1: not given yet */
    const char *axis_word, *html, *settings[SETTINGS_MAX];
    int setting_count;
    tune_limits_t limits;
    double frequency, to, window;
    long long steps;
    bool keep;
} tune_options_t;

typedef enum tune_step {
    TUNE_POWER = 0, TUNE_REST, TUNE_MOVE, TUNE_AFTER, TUNE_RETURN, TUNE_OFF, TUNE_END,
} tune_step_t;

/** One run: the program, and what it recorded. */
typedef struct tune_run {
    const tune_options_t *options;
    cm1e_scheduler_t *scheduler;
    AXIS_REF_t axis;
    uint32_t axis_number;
    const cm1e_axis_config_t *config;
    tune_part_t parts[TUNE_PARTS_MAX];
    uint32_t part_count, part;
    tune_record_t record;
    tune_step_t step;
    MC_Power_t power;
    MC_MoveRelative_t move;
    MC_PositionProfile_t profile;
    MC_MoveRelative_t back;
    MC_Stop_t stop;
    MC_TP_REF table;
    double start, set, actual; /* positions that go on counting where a modulo axis begins again */
    int64_t since_ns;
    bool done, failed, left_travel, outside_limits;
    WORD error_id;
    params_t known, before, after; /* of the motor; those of --set with both values */
    bool written;                  /* the motor has the values of --set */
    bool sets;                     /* this run writes them before */
    uint16_t position;
    progress_t progress;
    char name[CM1E_NAME_LENGTH];
} tune_run_t;

static struct argp_state *parser;

static error_t parse_word(tune_options_t *options, char *arg)
{
    if (options->kind < 0) {
        options->kind = choose_word("signal", arg, KINDS);
        return options->kind < 0 ? EINVAL : 0;
    }
    if (options->axis_word)
        argp_error(parser, "one axis at a time; \"%s\" is too many", arg);
    options->axis_word = arg;
    return 0;
}

static void check_options(const tune_options_t *options)
{
    if (options->kind < 0)
        argp_error(parser, "which signal? expected %s, then the axis", KINDS);
    if (options->limits.travel == 0 || options->limits.velocity == 0)
        argp_error(parser, "--max-travel and --max-velocity are needed: the motor moves as far and as fast as they "
                           "allow");
    if (options->kind == TUNE_CHIRP && options->to <= options->frequency)
        argp_error(parser, "--to must be above --frequency");
    if (options->keep && options->setting_count == 0)
        argp_error(parser, "--keep is for --set");
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    tune_options_t *options = state->input;
    parser = state;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case KEY_TRAVEL: return parse_positive(arg, "the travel", &options->limits.travel) ? 0 : EINVAL;
    case KEY_VELOCITY: return parse_positive(arg, "the velocity", &options->limits.velocity) ? 0 : EINVAL;
    case 'a': return parse_positive(arg, "the acceleration", &options->limits.acceleration) ? 0 : EINVAL;
    case KEY_JERK: return parse_positive(arg, "the jerk", &options->limits.jerk) ? 0 : EINVAL;
    case KEY_FREQUENCY: return parse_positive(arg, "the frequency", &options->frequency) ? 0 : EINVAL;
    case KEY_TO: return parse_positive(arg, "the last frequency", &options->to) ? 0 : EINVAL;
    case KEY_STEPS: return parse_number(arg, "the number of steps", 2, TUNE_PARTS_MAX, &options->steps) ? 0 : EINVAL;
    case KEY_WINDOW: return parse_positive(arg, "the window", &options->window) ? 0 : EINVAL;
    case KEY_KEEP: options->keep = true; return 0;
    case KEY_HTML:
        need_name(state, "--html", arg);
        options->html = arg;
        return 0;
    case KEY_SET:
        if (options->setting_count == SETTINGS_MAX)
            argp_error(state, "more than %d settings", SETTINGS_MAX);
        options->settings[options->setting_count++] = arg;
        return 0;
    case ARGP_KEY_ARG: return parse_word(options, arg);
    case ARGP_KEY_END: check_options(options); return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

/* ---- the parts --------------------------------------------------------------------------------------------------- */

static double counts_per_unit(const cm1e_axis_config_t *config)
{
    const double gear = (double)(config->gear_numerator ? config->gear_numerator : 1) /
                        (config->gear_denominator ? config->gear_denominator : 1);
    const double units = config->units_per_revolution > 0 ? config->units_per_revolution : 1;
    return config->counts_per_unit > 0 ? config->counts_per_unit : 50000 * gear / units;
}

/** The limits of the axis where the user gave none, or larger ones. */
static tune_limits_t limits_of(const tune_options_t *options, const cm1e_axis_config_t *config)
{
    const double counts = counts_per_unit(config);
    const double acceleration = config->max_acceleration > 0 ? config->max_acceleration
                                                             : DEFAULT_ACCELERATION_COUNTS / counts;
    const double braking = config->max_deceleration > 0 ? config->max_deceleration : acceleration;
    const double jerk = config->max_jerk > 0 ? config->max_jerk : DEFAULT_JERK_COUNTS / counts;
    tune_limits_t limits = options->limits;
    if (limits.acceleration == 0)
        limits.acceleration = acceleration;
    limits.acceleration = fmin(limits.acceleration, fmin(acceleration, braking));
    limits.jerk = fmin(limits.jerk > 0 ? limits.jerk : jerk, jerk);
    return limits;
}

/** Sines that are longer than the record could not be measured after the motor has made them. */
static bool fits_record(const tune_run_t *run, double cycle_s)
{
    double time_s = 0;
    for (uint32_t i = 0; i < run->part_count; i++)
        time_s += TUNE_PERIODS / run->parts[i].frequency + 2 * PAUSE_S;
    const double most_s = TUNE_SAMPLES_MAX * cycle_s;
    if (time_s <= most_s)
        return true;
    complain("the sines would take %.4g s, and %.4g s are recorded at most: take a higher frequency or fewer steps",
             time_s, most_s);
    return false;
}

static bool plan(tune_run_t *run, double cycle_s)
{
    const tune_options_t *options = run->options;
    const tune_limits_t limits = limits_of(options, run->config);
    const bool waves = options->kind >= TUNE_SINE;
    run->part_count = options->kind == TUNE_CHIRP ? (uint32_t)options->steps : 1;
    for (uint32_t i = 0; i < run->part_count; i++) {
        tune_part_t *part = &run->parts[i];
        *part = (tune_part_t){.distance = limits.travel, .velocity = limits.velocity};
        if (!waves)
            continue;
        const double share = run->part_count > 1 ? (double)i / (run->part_count - 1) : 0;
        part->frequency = options->frequency * pow(options->to / options->frequency, share);
        part->amplitude = tune_amplitude(part->frequency, &limits);
        if (part->amplitude * counts_per_unit(run->config) >= SMALLEST_AMPLITUDE_COUNTS)
            continue;
        complain("at %.4g Hz the limits allow an amplitude of %.3g u only, which is less than %d counts: allow a "
                 "larger velocity, acceleration or jerk, or take a lower frequency", part->frequency, part->amplitude,
                 SMALLEST_AMPLITUDE_COUNTS);
        return false;
    }
    return !waves || fits_record(run, cycle_s);
}

/* ---- in the cycle ------------------------------------------------------------------------------------------------ */

static void end(tune_run_t *run, bool failed, WORD error_id)
{
    run->failed = failed;
    run->done = !failed;
    run->error_id = error_id;
    run->step = TUNE_OFF;
}

/** All of the travel lies within the software limits, before anything moves. */
static bool travel_is_free(const tune_run_t *run)
{
    const cm1e_axis_config_t *c = run->config;
    const double way = run->options->limits.travel, low = run->options->kind >= TUNE_SINE ? way : 0;
    return (c->software_limit_positive == 0 && c->software_limit_negative == 0) ||
           (run->start + way <= c->software_limit_positive && run->start - low >= c->software_limit_negative);
}

static void enter(tune_run_t *run, tune_step_t step)
{
    run->step = step;
    run->since_ns = cm1e_scheduler_time_ns(run->scheduler);
}

static bool has_paused(const tune_run_t *run)
{
    return cm1e_scheduler_time_ns(run->scheduler) - run->since_ns > (int64_t)(PAUSE_S * 1e9);
}

static void begin_part(tune_run_t *run)
{
    tune_part_t *part = &run->parts[run->part];
    const bool waves = run->options->kind >= TUNE_SINE;
    part->begin = run->record.count;
    if (waves)
        tune_table(&run->table, part->frequency, part->amplitude);
    run->move.Distance = part->distance;
    run->move.Velocity = part->velocity;
    run->move.Execute = !waves;
    run->profile.Execute = waves;
    enter(run, TUNE_MOVE);
}

static void watch_part(tune_run_t *run)
{
    tune_part_t *part = &run->parts[run->part];
    if (run->move.Error || run->profile.Error) {
        end(run, true, run->move.Error ? run->move.ErrorID : run->profile.ErrorID);
    } else if (run->move.Done || run->profile.Done) {
        part->arrived = run->record.count;
        run->move.Execute = run->profile.Execute = FALSE;
        enter(run, TUNE_AFTER);
    }
}

static void follow_part(tune_run_t *run)
{
    if (!has_paused(run))
        return;
    run->parts[run->part].end = run->record.count;
    run->part++;
    if (run->part < run->part_count) {
        begin_part(run);
    } else {
        run->back.Distance = run->start - run->set;
        run->back.Execute = TRUE;
        enter(run, TUNE_RETURN);
    }
}

/** Of all places at which an axis shows `position`, the one nearest to `before`. */
static double go_on(double before, double position, double modulo_range)
{
    return modulo_range > 0 ? before + remainder(position - before, modulo_range) : position;
}

static void follow(tune_run_t *run, const cm1e_axis_info_t *info)
{
    run->set = go_on(run->set, info->set_position, run->config->modulo_range);
    run->actual = go_on(run->actual, info->actual_position, run->config->modulo_range);
}

static void record(tune_run_t *run)
{
    tune_record_t *record = &run->record;
    if ((run->step != TUNE_MOVE && run->step != TUNE_AFTER) || record->count == TUNE_SAMPLES_MAX)
        return;
    record->time_s[record->count] = (double)cm1e_scheduler_time_ns(run->scheduler) * 1e-9;
    record->set[record->count] = run->set - run->start;
    record->actual[record->count] = run->actual - run->start;
    record->count++;
}

/** A motor that leaves the travel is stopped. */
static void guard(tune_run_t *run)
{
    const double way = fabs(run->actual - run->start);
    if (run->step < TUNE_MOVE || run->step > TUNE_RETURN || way <= BEYOND_TRAVEL * run->options->limits.travel)
        return;
    run->left_travel = true;
    run->stop.Execute = TRUE;
    end(run, true, 0);
}

static void call_blocks(tune_run_t *run)
{
    run->power.Enable = run->step < TUNE_OFF || (run->stop.Execute && !run->stop.Done && !run->stop.Error);
    MC_Power(&run->power);
    MC_MoveRelative(&run->move);
    MC_PositionProfile(&run->profile);
    MC_MoveRelative(&run->back);
    MC_Stop(&run->stop);
}

static void wait_for_power(tune_run_t *run, const cm1e_axis_info_t *info)
{
    if (run->power.Error || info->state == CM1E_AXIS_ERROR_STOP) {
        end(run, true, run->power.Error ? run->power.ErrorID : cm1e_error_id(info->error));
    } else if (run->power.Status) {
        run->start = run->set = info->set_position;
        run->actual = go_on(run->start, info->actual_position, run->config->modulo_range);
        run->outside_limits = !travel_is_free(run);
        if (run->outside_limits)
            end(run, true, 0);
        else
            enter(run, TUNE_REST);
    }
}

static void program(void *context)
{
    tune_run_t *run = context;
    cm1e_axis_info_t info;
    cm1e_axis_read(run->axis, &info);
    follow(run, &info);
    guard(run);
    record(run);
    call_blocks(run);
    run->progress.position = info.actual_position;
    run->progress.seconds = (double)cm1e_scheduler_time_ns(run->scheduler) * 1e-9;
    if (run->step > TUNE_POWER && run->step < TUNE_OFF && info.state == CM1E_AXIS_ERROR_STOP)
        end(run, true, cm1e_error_id(info.error));
    switch (run->step) {
    case TUNE_POWER: wait_for_power(run, &info); break;
    case TUNE_REST:
        if (has_paused(run))
            begin_part(run);
        break;
    case TUNE_MOVE: watch_part(run); break;
    case TUNE_AFTER: follow_part(run); break;
    case TUNE_RETURN:
        if (run->back.Done || run->back.Error)
            end(run, run->back.Error, run->back.ErrorID);
        break;
    case TUNE_OFF:
        if (!run->power.Status)
            enter(run, TUNE_END);
        break;
    case TUNE_END: cm1e_scheduler_stop(run->scheduler); break;
    }
}

static void prepare(cm1e_scheduler_t *scheduler, void *context)
{
    tune_run_t *run = context;
    const tune_limits_t limits = limits_of(run->options, run->config);
    run->scheduler = scheduler;
    run->axis = cm1e_scheduler_axis(scheduler, run->axis_number);
    snprintf(run->name, sizeof run->name, "%s", cm1e_axis_name(run->axis));
    run->progress.name = run->name;
    run->power = (MC_Power_t){.Axis = &run->axis, .EnablePositive = TRUE, .EnableNegative = TRUE};
    run->move = (MC_MoveRelative_t){.Axis = &run->axis, .Acceleration = limits.acceleration,
                                    .Deceleration = limits.acceleration, .Jerk = limits.jerk};
    run->profile = (MC_PositionProfile_t){.Axis = &run->axis, .TimePosition = &run->table};
    run->back = (MC_MoveRelative_t){.Axis = &run->axis, .Velocity = limits.velocity,
                                    .Acceleration = limits.acceleration, .Deceleration = limits.acceleration,
                                    .Jerk = limits.jerk};
    run->stop = (MC_Stop_t){.Axis = &run->axis};
    if (told_to_end())
        cm1e_scheduler_stop(scheduler);
}

/* ---- parameters of the motor ------------------------------------------------------------------------------------- */

static bool read_settings(tune_run_t *run, cm1e_bus_t *bus)
{
    cm1e_diag_t diag = {0};
    run->after.count = 0;
    for (int i = 0; i < run->options->setting_count; i++)
        if (!param_parse_setting(&run->known, run->options->settings[i], &run->after.at[run->after.count++]))
            return false;
    run->before = run->after;
    for (size_t i = 0; i < run->before.count; i++)
        if (!param_read(bus, run->position, run->before.at[i].entry, &run->before.at[i].value, &diag)) {
            fail(&diag);
            return false;
        }
    return true;
}

static bool write_settings(const tune_run_t *run, cm1e_bus_t *bus, const params_t *values)
{
    cm1e_diag_t diag = {0};
    for (size_t i = 0; i < values->count; i++) {
        param_t param = values->at[i];
        if (!param_write(bus, run->position, &param, &diag)) {
            fail(&diag);
            return false;
        }
    }
    return true;
}

/** Before the bus starts: the values of --set are read in the first run and written in the second. */
static int ready(cm1e_bus_t *bus, void *context)
{
    tune_run_t *run = context;
    cm1e_diag_t diag = {0};
    if (run->options->setting_count == 0)
        return EXIT_OK;
    if (cm1e_bus_scan(bus, &diag) != CM1E_OK || cm1e_bus_identify(bus, &diag) != CM1E_OK)
        return fail(&diag);
    run->position = cm1e_bus_axis_position(bus, run->axis_number);
    params_of(cm1e_bus_slave(bus, run->position), 0, &run->known);
    if (run->known.count == 0 || run->config->channel) {
        complain("--set is for a CM1-E: of other motors no parameters are known");
        return EXIT_WRONG_USE;
    }
    if (!run->sets)
        return read_settings(run, bus) ? EXIT_OK : EXIT_WRONG_USE;
    run->written = true;
    return write_settings(run, bus, &run->after) ? EXIT_OK : EXIT_FAILED;
}

/** The motor gets back what it had. */
static int restore(const tune_run_t *run, const cm1e_bus_config_t *config)
{
    cm1e_diag_t diag = {0};
    cm1e_bus_t *bus = NULL;
    const bool good = cm1e_bus_open(&bus, config, &diag) == CM1E_OK && cm1e_bus_scan(bus, &diag) == CM1E_OK;
    if (!good)
        fail(&diag);
    const bool written = good && write_settings(run, bus, &run->before);
    cm1e_bus_close(bus);
    for (size_t i = 0; i < run->before.count && !written; i++)
        complain("%s was not restored: it was %" PRId64, run->before.at[i].entry->name, run->before.at[i].value);
    return written ? EXIT_OK : EXIT_FAILED;
}

/* ---- report ------------------------------------------------------------------------------------------------------ */

static int report(void *context)
{
    tune_run_t *run = context;
    char text[CM1E_AXIS_ERROR_TEXT_BYTES] = "";
    progress_clear(&run->progress);
    if (run->failed)
        cm1e_axis_error_text(run->axis, text, sizeof text);
    if (run->left_travel)
        complain("%s: the motor left the travel of %g u around its start, and was stopped", run->name,
                 run->options->limits.travel);
    else if (run->outside_limits)
        complain("%s: from %.6g on, a travel of %g u leaves the software limits; nothing was moved", run->name,
                 run->start, run->options->limits.travel);
    else if (run->failed)
        complain_of_axis(run->name, cm1e_strerror(cm1e_error_from_id(run->error_id)), text);
    else if (!run->done)
        complain("%s: tune was interrupted", run->name);
    return run->done ? EXIT_OK : EXIT_FAILED;
}

static void watch(void *context, bool last)
{
    tune_run_t *run = context;
    if (!last && run->progress.seconds > 0)
        progress_show(&run->progress);
}

/** One row of numbers: of the run before and, if there is one, of the run after. */
static void print_row(const char *name, const char *unit, double before, const double *after)
{
    if (isnan(before) && (!after || isnan(*after)))
        return;
    printf("  %-28s %12.5g", name, before);
    if (after)
        printf(" %12.5g", *after);
    printf("  %s\n", unit);
}

static void results_of(const tune_run_t *run, uint32_t part, tune_result_t *result)
{
    const tune_options_t *options = run->options;
    const double window = options->window > 0 ? options->window : 0.01 * run->parts[part].distance;
    tune_measure(result, (tune_kind_t)options->kind, &run->parts[part], &run->record, window);
}

static json_t *number_or_null(double value) { return isnan(value) ? json_null() : json_real(value); }

static json_t *run_as_json(const tune_run_t *run, const params_t *params)
{
    json_t *parts = json_array(), *values = json_object();
    for (size_t i = 0; i < params->count; i++)
        json_object_set_new(values, params->at[i].entry->name, json_integer(params->at[i].value));
    for (uint32_t i = 0; i < run->part_count; i++) {
        tune_result_t r;
        results_of(run, i, &r);
        const bool waves = run->options->kind >= TUNE_SINE;
        json_array_append_new(parts, json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "frequency",
            waves ? json_real(run->parts[i].frequency) : json_null(), "amplitude",
            waves ? json_real(run->parts[i].amplitude) : json_null(), "rise_s", number_or_null(r.rise_s),
            "overshoot_percent", number_or_null(r.overshoot_percent), "settling_s", number_or_null(r.settling_s),
            "largest_lag", number_or_null(r.largest_lag), "steady_lag", number_or_null(r.steady_lag), "gain",
            number_or_null(r.gain), "phase_degrees", number_or_null(r.phase_degrees)));
    }
    return json_pack("{s:o, s:o}", "parameters", values, "parts", parts);
}

static void print_waves(const tune_run_t *before, const tune_run_t *after)
{
    printf("  %10s %10s %10s %10s%s\n", "Hz", "amplitude", "gain", "phase", after ? "   gain after phase after" : "");
    for (uint32_t i = 0; i < before->part_count; i++) {
        tune_result_t one, other;
        results_of(before, i, &one);
        printf("  %10.4g %10.4g %10.4f %10.2f", before->parts[i].frequency, before->parts[i].amplitude, one.gain,
               one.phase_degrees);
        if (after) {
            results_of(after, i, &other);
            printf("   %10.4f  %10.2f", other.gain, other.phase_degrees);
        }
        putchar('\n');
    }
}

static void print_result(const tune_run_t *before, const tune_run_t *after, const char *simulated)
{
    static const char *const names[] = {"step", "ramp", "sine", "chirp"};
    printf("%s: %s%s%s\n", before->name, names[before->options->kind], after ? ", before and after" : "",
           simulated);
    for (size_t i = 0; after && i < after->after.count; i++)
        printf("  %-28s %12" PRId64 " %12" PRId64 "  %s\n", after->after.at[i].entry->name, after->before.at[i].value,
               after->after.at[i].value, after->after.at[i].entry->unit);
    if (before->options->kind >= TUNE_SINE) {
        print_waves(before, after);
        return;
    }
    tune_result_t one, other = {0};
    results_of(before, 0, &one);
    if (after)
        results_of(after, 0, &other);
    print_row("rise time, 10 to 90 %", "s", one.rise_s, after ? &other.rise_s : NULL);
    print_row("overshoot", "%", one.overshoot_percent, after ? &other.overshoot_percent : NULL);
    print_row("settling behind set-point", "s", one.settling_s, after ? &other.settling_s : NULL);
    print_row("lag at constant velocity", "u", one.steady_lag, after ? &other.steady_lag : NULL);
    print_row("largest lag", "u", one.largest_lag, after ? &other.largest_lag : NULL);
}

/* ---- the command ------------------------------------------------------------------------------------------------- */

static const struct argp_option table[] = {
    {"max-travel", KEY_TRAVEL, "DISTANCE", 0, "How far the motor may go from its start, in units of the axis; needed",
     0},
    {"max-velocity", KEY_VELOCITY, "VELOCITY", 0, "Units/s; needed", 0},
    {"acceleration", 'a', "ACCELERATION", 0, "Units/s2; default and maximum: that of the axis", 0},
    {"jerk", KEY_JERK, "JERK", 0, "Units/s3; default and maximum: that of the axis", 0},
    {"frequency", KEY_FREQUENCY, "HZ", 0, "sine: its frequency; chirp: the first one; default 1", 0},
    {"to", KEY_TO, "HZ", 0, "chirp: the last frequency; default 10", 0},
    {"steps", KEY_STEPS, "N", 0, "chirp: number of frequencies; default 8", 0},
    {"window", KEY_WINDOW, "DISTANCE", 0, "step: settled within this of the target; default: 1 % of the travel", 0},
    {"set", KEY_SET, "NAME=VALUE", 0, "Run, write this parameter, run again; the motor then gets its value back", 0},
    {"keep", KEY_KEEP, NULL, 0, "Let the motor keep the values of --set", 0},
    {"html", KEY_HTML, "FILE", 0, "Write both runs as a page for a browser", 0},
    {0}};
const struct argp argp_tune = {
    table, parse, "step [AXIS]\nramp [AXIS]\nsine [AXIS]\nchirp [AXIS]",
    "Enables one axis (name or number, default 1), moves it within the limits given, and measures: step: rise time, "
    "overshoot, settling time; ramp: lag at constant velocity; sine, chirp: gain and phase of the actual position "
    "beside the set position. A chirp is a series of sines, each of five periods. The axis ends where it began. Refused "
    "while a program has the network.",
    attach_children, NULL, NULL};

static bool make_records(tune_run_t runs[2], double cycle_s)
{
    for (int i = 0; i < 2; i++) {
        runs[i].record.cycle_s = cycle_s;
        runs[i].record.time_s = calloc(TUNE_SAMPLES_MAX, sizeof(double));
        runs[i].record.set = calloc(TUNE_SAMPLES_MAX, sizeof(double));
        runs[i].record.actual = calloc(TUNE_SAMPLES_MAX, sizeof(double));
        if (!runs[i].record.time_s || !runs[i].record.set || !runs[i].record.actual)
            return complain("out of memory"), false;
    }
    return true;
}

static int run_one(tune_run_t *run, cm1e_bus_config_t *config)
{
    const axis_run_t settings = {.what = "tune", .program = program, .prepare = prepare, .report = report,
                                 .watch = watch, .ready = ready, .context = run};
    return run_on_axes(&settings, &run->options->common, config);
}

static int tell(tune_run_t runs[2], bool two, const cm1e_bus_config_t *config)
{
    static const params_t none;
    const tune_options_t *options = runs[0].options;
    if (options->common.json)
        print_json(json_pack("{s:s, s:o, s:o, s:b}", "axis", runs[0].name, "before",
                             run_as_json(&runs[0], two ? &runs[1].before : &none), "after",
                             two ? run_as_json(&runs[1], &runs[1].after) : json_null(), "simulated",
                             is_simulated(config)));
    else
        print_result(&runs[0], two ? &runs[1] : NULL, simulated_mark(config));
    if (!options->html)
        return EXIT_OK;
    char names[2][TUNE_LABEL_BYTES];
    tune_label(names[0], two ? "before" : "run", two ? &runs[1].before : &none);
    tune_label(names[1], "after", two ? &runs[1].after : &none);
    const tune_record_t *other = two ? &runs[1].record : NULL;
    return tune_write_page(options->html, &runs[0].record, names[0], other, names[1]) ? EXIT_OK : EXIT_FAILED;
}

static int run_both(tune_run_t runs[2], cm1e_bus_config_t *config)
{
    const bool two = runs[0].options->setting_count > 0;
    int status = run_one(&runs[0], config);
    if (status == EXIT_OK && two) {
        runs[1].before = runs[0].before;
        runs[1].after = runs[0].after;
        runs[1].sets = true;
        catch_signals(); /* also before and behind the run: the motor must get its values back */
        status = run_one(&runs[1], config);
        if (runs[1].written && !runs[0].options->keep && restore(&runs[1], config) != EXIT_OK)
            status = EXIT_FAILED;
    }
    return status == EXIT_OK ? tell(runs, two, config) : status;
}

/** Returns the exit status. `config` is empty afterwards. */
static int check_alone(const common_options_t *options, cm1e_bus_config_t *config)
{
    cm1e_diag_t diag = {0};
    if (!load_network(options, config))
        return EXIT_WRONG_USE;
    const cm1e_error_t error = refuse_to_attach(options, config, "tune", "it moves the motor by a table with a target "
                                                "for every cycle, and only the program that runs the cycle can do that",
                                                &diag);
    cm1e_bus_config_free(config);
    return error == CM1E_OK ? EXIT_OK : fail(&diag);
}

int command_tune(int argc, char **argv)
{
    static cm1e_bus_config_t config;
    static tune_run_t runs[2];
    tune_options_t options = {.kind = -1, .frequency = 1, .to = 10, .steps = 8};
    if (parse_options(&argp_tune, argc, argv, &options))
        return EXIT_WRONG_USE;
    const char *const files[TRACE_FILES] = {[TRACE_HTML] = options.html};
    const int writable = check_trace_files(files, TRACE_FILES); /* before anything moves */
    if (writable != EXIT_OK)
        return writable;
    const int alone = check_alone(&options.common, &config);
    if (alone != EXIT_OK)
        return alone;
    const int loaded = load_axes(&options.common, &config);
    if (loaded != EXIT_OK)
        return loaded;
    const int axis = find_axis(&config, options.axis_word ? options.axis_word : "1");
    if (axis < 0)
        return EXIT_WRONG_USE;
    cm1e_axis_config_t *settings = &config.axes[axis];
    settings->table_profiles = true;
    if (settings->max_velocity == 0 || settings->max_velocity > options.limits.velocity)
        settings->max_velocity = options.limits.velocity; /* nothing is faster, whatever happens */
    const double cycle_s = (double)(config.cycle_time_ns ? config.cycle_time_ns : 1000000) * 1e-9;
    for (int i = 0; i < 2; i++) {
        runs[i].options = &options;
        runs[i].axis_number = (uint32_t)axis;
        runs[i].config = settings;
        if (!plan(&runs[i], cycle_s))
            /* NOLINTNEXTLINE(clang-analyzer-core.StackAddressEscape): the command ends here */
            return EXIT_WRONG_USE;
    }
    /* NOLINTNEXTLINE(clang-analyzer-core.StackAddressEscape): the command ends here */
    return make_records(runs, cycle_s) ? run_both(runs, &config) : EXIT_FAILED;
}
