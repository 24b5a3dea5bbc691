/** cm1e prove: the acceptance of a real device: every point of a table is compared with our tables. */
#include <errno.h>
#include <fnmatch.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "attach.h"
#include "core/json_text.h"
#include "core/near.h"
#include "core/output.h"
#include "end_signals.h"
#include "files.h"
#include "prove/prove.h"
#include "which_slave.h"

enum { KEY_LIST = 0x800, KEY_WRITES, KEY_MOTION, KEY_VELOCITY, KEY_TRAVEL, KEY_PROFILE, KEY_POINT, KEY_DEAD_ENDS };

static bool names_point(const char *pattern, const point_t *point) { return fnmatch(pattern, point->id, 0) == 0; }

/** A pattern that names no point would prove nothing, with status 0. */
static void need_point(struct argp_state *state, const char *pattern)
{
    char text[CM1E_NEAR_TEXT_BYTES];
    cm1e_near_t near = {.word = pattern};
    bool found = false;
    for (size_t n = 0; prove_point(n) && !found; n++) {
        found = names_point(pattern, prove_point(n));
        cm1e_near_look(&near, prove_point(n)->id);
    }
    if (!found)
        argp_error(state, "there is no point \"%s\"%s (--list shows them)", pattern, cm1e_near_text(&near, text, sizeof text));
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    prove_options_t *options = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case KEY_LIST: options->list = true; return 0;
    case KEY_WRITES: options->allow_writes = true; return 0;
    case KEY_DEAD_ENDS: options->allow_dead_ends = true; return 0;
    case KEY_MOTION: options->allow_motion = true; return 0;
    case KEY_VELOCITY: return parse_positive(arg, "the maximum velocity", &options->max_velocity) ? 0 : EINVAL;
    case KEY_TRAVEL: return parse_positive(arg, "the maximum travel", &options->max_travel) ? 0 : EINVAL;
    case KEY_PROFILE: options->profile = arg; return 0;
    case KEY_POINT:
        if (options->pattern_count == PROVE_PATTERNS)
            argp_error(state, "%d --point at most", PROVE_PATTERNS);
        need_point(state, arg);
        options->patterns[options->pattern_count++] = arg;
        return 0;
    case 'o':
        need_name(state, "-o", arg);
        options->output = arg;
        return 0;
    case ARGP_KEY_ARG:
        if (options->where)
            argp_error(state, "one device at a time; \"%s\" is too many", arg);
        options->where = arg;
        return 0;
    case ARGP_KEY_END:
        if (options->allow_motion && (options->max_velocity == 0 || options->max_travel == 0))
            argp_error(state, "--allow-motion needs limits: --max-velocity REVOLUTIONS/S and --max-travel REVOLUTIONS");
        if (options->profile && options->where && !is_position(options->where))
            argp_error(state, "--profile needs the position of the device, not its name");
        if (!options->allow_motion && (options->max_velocity > 0 || options->max_travel > 0))
            argp_error(state, "--max-velocity and --max-travel are for --allow-motion");
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static int list_points(bool json)
{
    static const char *const levels[] = {"", "--allow-writes", "--allow-motion", "--allow-dead-ends"};
    json_t *all = json_array();
    for (size_t n = 0; prove_point(n); n++) {
        const point_t *point = prove_point(n);
        json_array_append_new(all, json_pack("{s:s, s:s, s:s, s:s, s:s, s:s}", "id", point->id, "what", point->what,
                                             "clause", point->clause, "how", point->how, "device",
                                             point->kind ? point->kind : "", "needs", levels[point->level]));
        if (!json)
            printf("%-18s %s (%s)%s%s\n", point->id, point->what, point->clause, point->level ? "; needs " : "",
                   levels[point->level]);
    }
    if (json)
        print_json(all);
    else
        json_decref(all);
    return EXIT_OK;
}

/* ---- the device -------------------------------------------------------------------------------------------------- */

bool prove_scan(prove_t *prove)
{
    cm1e_diag_t diag = {0};
    if (cm1e_bus_scan(prove->bus, &diag) == CM1E_OK) {
        prove->slave = prove->position ? cm1e_bus_slave(prove->bus, prove->position) : NULL;
        if (prove->slave || !prove->position)
            return true;
        cm1e_diag_set(&diag, CM1E_ERROR_BUS_LOST, 0, "Slave %u is gone.", prove->position);
    }
    if (prove->differences)
        prove_note(prove, "%.300s", diag.text);
    else
        fail(&diag);
    return false;
}

bool prove_open(prove_t *prove)
{
    cm1e_diag_t diag = {0};
    if (cm1e_bus_open(&prove->bus, prove->config, &diag) != CM1E_OK) {
        fail(&diag);
        return false;
    }
    return prove_play(prove->options, prove->bus) && prove_is_at_rest(prove) && prove_scan(prove);
}

/** Returns the exit status. */
static int choose(prove_t *prove)
{
    unsigned known = 0;
    uint16_t wanted = 0;
    uint8_t channel; /* of an axis behind a bridge: the bridge is compared as a whole */
    const int found = prove->options->where ? find_motor_of(prove->bus, prove->config, prove->options->where, &wanted,
                                                            &channel) : EXIT_OK;
    if (found != EXIT_OK)
        return found;
    for (uint32_t position = 1; position <= cm1e_bus_slave_count(prove->bus); position++)
        if (cm1e_bus_slave(prove->bus, position)->device && (wanted == 0 || wanted == position)) {
            prove->position = (uint16_t)position;
            known++;
        }
    if (known != 1) {
        complain(known > 1 ? "there are %u devices: say which one by its position"
                           : "there is no device that our tables know%.0u", known);
        return EXIT_FAILED;
    }
    prove->slave = cm1e_bus_slave(prove->bus, prove->position);
    prove->device = prove->slave->device;
    if (prove->device->firmware) {
        prove->firmware = prove->device->firmware(prove->slave->software_version);
        if (!prove->firmware)
            prove->firmware = cm1e_firmware_info(CM1E_FIRMWARE_COUNT - 1);
    }
    return EXIT_OK;
}

/* ---- the points -------------------------------------------------------------------------------------------------- */

static bool is_allowed(const prove_t *prove, const point_t *point)
{
    return point->level == LEVEL_READ || (point->level == LEVEL_WRITE && prove->options->allow_writes)
           || (point->level == LEVEL_MOTION && prove->options->allow_motion)
           || (point->level == LEVEL_DEAD_END && prove->options->allow_dead_ends);
}

static bool has_point(const prove_t *prove, const point_t *point)
{
    return !point->kind || strcmp(point->kind, prove->device->kind) == 0;
}

/** By the patterns of the options. */
static bool is_named(const prove_t *prove, const point_t *point)
{
    const prove_options_t *options = prove->options;
    bool named = options->pattern_count == 0;
    for (int i = 0; i < options->pattern_count; i++)
        named |= names_point(options->patterns[i], point);
    return named && has_point(prove, point);
}

/** The motor is always enabled at rest before it moves. */
static bool is_chosen(const prove_t *prove, const point_t *point)
{
    const bool enables = prove->options->allow_motion && strcmp(point->id, "move.enable") == 0;
    return is_named(prove, point) || (enables && has_point(prove, point));
}

static bool is_any_named(const prove_t *prove)
{
    bool any = false;
    for (size_t n = 0; prove_point(n) && !any; n++)
        any = is_named(prove, prove_point(n));
    return any;
}

bool prove_is_told_to_end(prove_t *prove)
{
    prove->interrupted |= told_to_end();
    return prove->interrupted;
}

static void look_at(prove_t *prove, const point_t *point)
{
    const char *verdict = "not tried";
    prove->compared = 0;
    prove->note[0] = '\0';
    prove->differences = json_array();
    if (prove_is_told_to_end(prove)) {
        prove_note(prove, "the program was told to end, or the device is gone");
    } else if (is_allowed(prove, point)) {
        point->look(prove, point);
        verdict = json_array_size(prove->differences) > 0 ? "differs" : prove->compared > 0 ? "agrees" : "unknown";
    } else {
        static const char *const needs[] = {[LEVEL_WRITE] = "writes", [LEVEL_MOTION] = "motion",
                                            [LEVEL_DEAD_END] = "dead-ends"};
        prove_note(prove, "needs --allow-%s", needs[point->level]);
    }
    json_array_append_new(prove->results,
                          json_pack("{s:s, s:s, s:s, s:s, s:s, s:i, s:o, s:o}", "id", point->id, "what", point->what,
                                    "clause", point->clause, "how", point->how, "verdict", verdict, "compared",
                                    (int)prove->compared, "differences", prove->differences, "note",
                                    cm1e_json_text(prove->note)));
    prove->differences = NULL;
}

/* ---- output ------------------------------------------------------------------------------------------------------ */

enum { PATH_BYTES = 4096 };

static bool report_path(const prove_options_t *options, const char *ending, char path[PATH_BYTES])
{
    const int length = snprintf(path, PATH_BYTES, "%s%s", options->output, ending);
    const bool fits = length >= 0 && length < PATH_BYTES;
    if (!fits)
        complain("the name of the report is too long");
    return fits;
}

/** Before anything is looked at: a report that cannot be written is not to be found out behind an hour. */
static bool can_report(const prove_options_t *options)
{
    static const char *const endings[] = {".md", ".json", ".profile.json"};
    bool good = true;
    for (size_t i = 0; i < sizeof endings / sizeof endings[0] && options->output && good; i++) {
        char path[PATH_BYTES];
        cm1e_diag_t diag = {0};
        good = report_path(options, endings[i], path);
        if (good && cm1e_output_check(path, &diag) != CM1E_OK) {
            fail(&diag);
            good = false;
        }
    }
    return good;
}

static bool write_text(const prove_t *prove, const char *ending, const char *text)
{
    char path[PATH_BYTES];
    if (!text)
        complain("out of memory");
    if (!text || !report_path(prove->options, ending, path))
        return false;
    if (!write_output(path, text, strlen(text)))
        return false;
    if (!prove->options->common.json)
        printf("%s\n", path);
    return true;
}

static bool write_json(const prove_t *prove, const char *ending, const json_t *value)
{
    char *text = json_dumps(value, JSON_INDENT(1) | JSON_SORT_KEYS);
    const bool good = write_text(prove, ending, text);
    free(text);
    return good;
}

static int write_results(const prove_t *prove)
{
    json_t *report = prove_report(prove), *profile = prove_profile(prove);
    bool good = report && profile;
    if (good && prove->options->common.json)
        print_json(json_incref(report));
    else if (good)
        prove_print(report);
    if (good && prove->options->output) {
        char *markdown = prove_markdown(report);
        good = write_text(prove, ".md", markdown) && write_json(prove, ".json", report)
               && write_json(prove, ".profile.json", profile);
        free(markdown);
    }
    const bool agrees = json_integer_value(json_object_get(json_object_get(report, "counts"), "differs")) == 0;
    json_decref(report);
    json_decref(profile);
    return good && agrees && !prove->interrupted ? EXIT_OK : EXIT_FAILED;
}

static int prove_device(prove_t *prove)
{
    const int found = prove_open(prove) ? choose(prove) : EXIT_FAILED;
    if (found != EXIT_OK)
        return found;
    if (!is_any_named(prove)) {
        complain("--point names no point of a %s (--list --json shows of which device each is)", prove->device->kind);
        return EXIT_WRONG_USE;
    }
    prove->results = json_array();
    prove->profile_codes = json_object();
    prove_read_all(prove);
    catch_signals(); /* from here on something may have to be written back */
    for (size_t n = 0; prove_point(n); n++) {
        const point_t *point = prove_point(n);
        if (is_chosen(prove, point))
            look_at(prove, point);
    }
    const int status = write_results(prove);
    json_decref(prove->results);
    json_decref(prove->profile_codes);
    return status;
}

static const struct argp_option table[] = {
    {"list", KEY_LIST, NULL, 0, "List the points, and look at nothing", 0},
    {"point", KEY_POINT, "PATTERN", 0, "Look only at points of this name, as state.op or \"move.*\"; repeat it "
     "for more", 0},
    {"output", 'o', "NAME", 0, "Write NAME.md and NAME.json, the report, and NAME.profile.json, the device profile for "
     "`cm1e sim --profile`", 0},
    {"allow-writes", KEY_WRITES, NULL, 0, "Also write settings, at and beyond their bounds, and then what was there "
     "before", 0},
    {"allow-motion", KEY_MOTION, NULL, 0, "Also enable the motor and move it, within the next two limits; homing runs "
     "against the hard stops or to the switches, as far as the travel allows", 0},
    {"allow-dead-ends", KEY_DEAD_ENDS, NULL, 0, "Also bring a motor behind a bridge to modes that only switching the "
     "bridge off and on ends", 0},
    {"max-velocity", KEY_VELOCITY, "REV/S", 0, "With --allow-motion: revolutions of the motor a second", 0},
    {"max-travel", KEY_TRAVEL, "REV", 0, "With --allow-motion: revolutions of the motor to either side", 0},
    {"profile", KEY_PROFILE, "FILE", 0, "With -i sim: the simulated motor behaves as this device", 0},
    {0}};
const struct argp argp_prove = {
    table, parse, "[POSITION|AXIS]",
    "Compares a device with what this program knows of its kind: identity, EEPROM, the whole dictionary, mappings, "
    "registers, EtherCAT states, and requests that must be refused. Each point is told as agrees, differs or unknown, "
    "with the clause of the guide. Without --allow-motion nothing is enabled, and nothing is written that is kept or "
    "could move the motor. The network must not be in use: its slaves go to Init and to Operational and back. Exit "
    "status 1: a point differs.", common_children, NULL, NULL};

int command_prove(int argc, char **argv)
{
    static prove_options_t options;
    static cm1e_bus_config_t config;
    static prove_t prove;
    if (parse_options(&argp_prove, argc, argv, &options))
        return EXIT_WRONG_USE;
    if (options.list)
        return list_points(options.common.json);
    if (!load_configuration(&options.common, &config))
        return EXIT_WRONG_USE;
    if (options.profile && !is_simulated(&config)) {
        complain("--profile is for the simulated segment; on a network interface use `cm1e sim --profile`");
        return EXIT_WRONG_USE;
    }
    if (!can_report(&options))
        return EXIT_FAILED;
    prove.options = &options;
    prove.config = &config;
    const int status = prove_device(&prove);
    return close_bus(prove.bus, &options.common, status);
}
