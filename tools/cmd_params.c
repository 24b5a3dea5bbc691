/** cm1e params: the parameters of a motor with their meaning: listed, read, written, kept in a file, compared. */
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "attach.h"
#include "core/json_text.h"
#include "core/text.h"
#include "files.h"
#include "params.h"
#include "terminal.h"
#include "which_slave.h"

enum { KEY_YES = 0x600, KEY_DRY_RUN, KEY_OTHER_FIRMWARE, KEY_ALLOW, KEY_FORCE, MAX_NAMES = 32 };
enum { ABORT_NO_OBJECT = 0x06020000, ABORT_NO_SUBINDEX = 0x06090011 };
enum { LIST = 0, GET, SET, BACKUP, RESTORE, DIFF };
#define ACTIONS "list|get|set|backup|restore|diff"

typedef struct params_options {
    common_options_t common;
    int action; /* -1: not given yet */
    const char *where, *words[MAX_NAMES];
    int word_count;
    bool yes, dry_run, other_firmware, allow_motion, force;
} params_options_t;

static void check_words(const params_options_t *options, struct argp_state *state)
{
    const bool file = options->action >= BACKUP;
    if (options->action < 0 || !options->where)
        argp_error(state, "expected: %s, and the position or axis of a motor", ACTIONS);
    if (file && options->word_count != 1)
        argp_error(state, "expected one file behind the motor");
    if ((options->action == GET || options->action == SET) && options->word_count == 0)
        argp_error(state, options->action == GET ? "expected names of parameters behind the motor"
                                                 : "expected NAME=VALUE behind the motor");
    if ((options->dry_run || options->yes || options->other_firmware || options->allow_motion) &&
        options->action != SET && options->action != RESTORE)
        argp_error(state, "--yes, --dry-run, --other-firmware and --allow-motion are for set and restore");
    if (options->force && options->action != BACKUP)
        argp_error(state, "--force is for backup");
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    params_options_t *options = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case KEY_YES: options->yes = true; return 0;
    case KEY_DRY_RUN: options->dry_run = true; return 0;
    case KEY_ALLOW: options->allow_motion = true; return 0;
    case KEY_FORCE: options->force = true; return 0;
    case KEY_OTHER_FIRMWARE: options->other_firmware = true; return 0;
    case ARGP_KEY_ARG:
        if (options->action < 0) {
            options->action = choose_word("action", arg, ACTIONS);
            return options->action < 0 ? EINVAL : 0;
        }
        if (!options->where) {
            options->where = arg;
            return 0;
        }
        if (options->word_count == MAX_NAMES)
            argp_error(state, "more than %d words", MAX_NAMES);
        options->words[options->word_count++] = arg;
        return 0;
    case ARGP_KEY_END:
        check_words(options, state);
        if (options->action >= BACKUP)
            need_name(state, "the file", options->words[0]);
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

/* ---- the motor --------------------------------------------------------------------------------------------------- */

typedef struct motor {
    cm1e_bus_t *bus;
    uint16_t position;
    unsigned channel;    /* behind a bridge; 0: none */
    char label[40];      /* "slave 2", "slave 2, connector 1" */
    const cm1e_slave_info_t *slave;
    params_t params;     /* all that it has */
} motor_t;

/** The motor has no such object: the guide and the drive that it shows do not agree on H8 (UG 7.3.23, 7.5). */
static bool is_missing(const cm1e_diag_t *diag)
{
    return diag->error == CM1E_ERROR_SDO_ABORT
           && (diag->foreign_code == ABORT_NO_OBJECT || diag->foreign_code == ABORT_NO_SUBINDEX);
}

/** Reads the values; parameters that the motor lacks are left out, with a word about them. */
static bool read_values(const motor_t *motor, params_t *params)
{
    size_t kept = 0;
    for (size_t i = 0; i < params->count; i++) {
        cm1e_diag_t diag = {0};
        if (param_read(motor->bus, motor->position, params->at[i].entry, &params->at[i].value, &diag)) {
            params->at[kept++] = params->at[i];
        } else if (is_missing(&diag)) {
            complain("%s has no %s (0x%04X:%02X): it is left out", motor->label, params->at[i].entry->name,
                     params->at[i].entry->index, params->at[i].entry->subindex);
        } else {
            fail(&diag);
            return false;
        }
    }
    params->count = kept;
    return true;
}

static void head_of(const motor_t *motor, params_head_t *head)
{
    *head = (params_head_t){.serial = motor->slave->serial_number};
    snprintf(head->kind, sizeof head->kind, "%s", motor->slave->device->kind);
    snprintf(head->name, sizeof head->name, "%s", motor->slave->device->label);
    snprintf(head->firmware, sizeof head->firmware, "%s", motor->slave->software_version);
    cm1e_text_clean(head->firmware);
}

/* ---- list and get ------------------------------------------------------------------------------------------------ */

static json_t *param_as_json(const param_t *param)
{
    char number[16];
    const cm1e_entry_t *entry = param->entry;
    return json_pack("{s:s, s:s, s:I, s:s, s:I, s:I, s:b, s:s}", "name", entry->name, "number",
                     param_number(entry, number), "value", (json_int_t)param->value, "unit", entry->unit, "minimum",
                     (json_int_t)entry->minimum, "maximum", (json_int_t)entry->maximum, "kept",
                     entry->use == CM1E_USE_KEPT, "meaning", entry->meaning ? entry->meaning : "");
}

static int show(motor_t *motor, params_t *params, bool json)
{
    if (!read_values(motor, params))
        return EXIT_FAILED;
    json_t *all = json_array();
    for (size_t i = 0; i < params->count; i++) {
        const param_t *param = &params->at[i];
        char number[16], range[80];
        json_array_append_new(all, param_as_json(param));
        if (!json)
            printf("%s  %-30.30s %10" PRId64 "  %-34s %s\n", param_number(param->entry, number), param->entry->name,
                   param->value, param_range(param->entry, range, sizeof range),
                   param->entry->meaning ? param->entry->meaning : "");
    }
    if (json)
        print_json(all);
    else
        json_decref(all);
    return EXIT_OK;
}

/** The parameters that words name; without words all. */
static bool named(const motor_t *motor, const params_options_t *options, params_t *params)
{
    *params = motor->params;
    if (options->word_count == 0)
        return true;
    params->count = 0;
    for (int i = 0; i < options->word_count; i++) {
        const cm1e_entry_t *entry = param_find(&motor->params, options->words[i]);
        if (!entry && motor->channel)
            complain("the other parameters of a motor behind a bridge are read and written by `cm1e cml` (K37.1)");
        if (!entry)
            return false;
        params->at[params->count++] = (param_t){.entry = entry};
    }
    return true;
}

/* ---- set and restore --------------------------------------------------------------------------------------------- */

static bool parse_settings(const motor_t *motor, const params_options_t *options, params_t *params)
{
    params->count = 0;
    for (int i = 0; i < options->word_count; i++)
        if (!param_parse_setting(&motor->params, options->words[i], &params->at[params->count++]))
            return false;
    return true;
}

/** Reads the values of the motor beside those of `params`, which loses what the motor lacks. */
static bool read_beside(const motor_t *motor, params_t *params, params_t *now)
{
    *now = *params;
    if (!read_values(motor, now))
        return false;
    size_t kept = 0;
    for (size_t i = 0; i < params->count && kept < now->count; i++)
        if (params->at[i].entry == now->at[kept].entry)
            params->at[kept++] = params->at[i];
    params->count = kept;
    return true;
}

/** Keeps those whose value would change, and shows the changes. */
static bool keep_changes(const motor_t *motor, params_t *params, size_t *missing, bool json)
{
    params_t now;
    size_t changes = 0;
    const size_t wanted = params->count;
    if (!read_beside(motor, params, &now))
        return false;
    *missing = wanted - params->count;
    for (size_t i = 0; i < params->count; i++) {
        const cm1e_entry_t *entry = params->at[i].entry;
        const int64_t kept = cm1e_entry_round(entry, params->at[i].value);
        if (kept == now.at[i].value || params->at[i].value == now.at[i].value)
            continue;
        if (!json)
            printf("%-24s %" PRId64 " -> %" PRId64 " %s%s\n", entry->name, now.at[i].value, kept, entry->unit,
                   kept == params->at[i].value ? "" : " (rounded)");
        params->at[changes++] = params->at[i];
    }
    params->count = changes;
    return true;
}

static bool confirmed(const params_options_t *options, size_t count)
{
    if (options->yes || options->action == SET)
        return true;
    if (!at_a_terminal()) {
        complain("nothing was written: restore needs --yes where there is no terminal to ask, or --dry-run to look "
                 "only");
        return false;
    }
    fprintf(stderr, "Write %zu value%s? [y/N] ", count, count == 1 ? "" : "s");
    const int answer = getchar();
    if (answer == 'y' || answer == 'Y')
        return true;
    complain("nothing was written");
    return false;
}

static json_t *names_as_json(const params_t *params, size_t from, size_t to)
{
    json_t *names = json_array();
    for (size_t i = from; i < to; i++)
        json_array_append_new(names, json_string(params->at[i].entry->name));
    return names;
}

static void print_names(const char *what, const params_t *params, size_t from, size_t to)
{
    fprintf(stderr, "%s:", what);
    for (size_t i = from; i < to; i++)
        fprintf(stderr, "%s %s", i > from ? "," : "", params->at[i].entry->name);
    fputs(from == to ? " nothing\n" : "\n", stderr);
}

/** Writes one after the other, each read back; stops at the first that fails, and says exactly what was written. */
static int write_all(const motor_t *motor, params_t *params, bool json)
{
    cm1e_diag_t diag = {0};
    size_t written = 0;
    while (written < params->count && param_write(motor->bus, motor->position, &params->at[written], &diag))
        written++;
    /* A program that has the network, and did not pass the value on to the motor. */
    const bool refused = diag.error == CM1E_ERROR_AXIS_STATE || diag.error == CM1E_ERROR_PERMISSION;
    const bool good = written == params->count;
    if (!good) {
        fail(&diag);
        print_names("written and read back", params, 0, written);
        if (!refused)
            print_names("failed, its value is to be looked at", params, written, written + 1);
        print_names("not written", params, refused ? written : written + 1, params->count);
    }
    if (json)
        print_json(json_pack("{s:b, s:o, s:o, s:o}", "done", good, "written", names_as_json(params, 0, written),
                             "failed", good || refused ? json_null() : json_string(params->at[written].entry->name),
                             "not_written", names_as_json(params, good || refused ? written : written + 1,
                                                          params->count)));
    else if (good)
        printf("%zu value%s written to %s and read back\n", written, written == 1 ? "" : "s", motor->label);
    return good ? EXIT_OK : EXIT_FAILED;
}

/** false, with a complaint: one of them may move the motor. */
static bool no_motion(const params_t *params)
{
    for (size_t i = 0; i < params->count; i++)
        if (param_can_move(params->at[i].entry)) {
            complain("nothing was written: %s is what an input does, and if it is on, the motor may move at once "
                     "(--allow-motion)", params->at[i].entry->name);
            return false;
        }
    return true;
}

static int change(motor_t *motor, const params_options_t *options, params_t *params)
{
    const bool json = options->common.json;
    size_t missing;
    if (!keep_changes(motor, params, &missing, json))
        return EXIT_FAILED;
    const int complete = missing ? EXIT_FAILED : EXIT_OK;
    if (params->count == 0 && !json)
        puts("nothing to change: the motor has these values already");
    else if (options->dry_run && !json)
        puts("nothing was written (--dry-run)");
    if (options->dry_run && json)
        print_json(json_pack("{s:b, s:o}", "done", false, "would_write", names_as_json(params, 0, params->count)));
    if (options->dry_run || (params->count == 0 && !json))
        return complete;
    if (!options->allow_motion && !no_motion(params))
        return EXIT_WRONG_USE;
    if (params->count > 0 && !confirmed(options, params->count))
        return EXIT_FAILED;
    const int status = write_all(motor, params, json);
    return status == EXIT_OK ? complete : status;
}

/** What a file says of its motor is compared with this one. */
typedef struct comparison {
    const motor_t *motor;
    const params_options_t *options;
} comparison_t;

/** The file is of such a motor. */
static bool suits(const params_head_t *head, const void *context)
{
    const comparison_t *comparison = context;
    const motor_t *motor = comparison->motor;
    const params_options_t *options = comparison->options;
    params_head_t own;
    head_of(motor, &own);
    if (!head->kind[0]) {
        complain("%s does not say of which device it is: \"device: {kind: %s}\" is missing", options->words[0], own.kind);
        return false;
    }
    if (strcmp(head->kind, own.kind) != 0) {
        complain("%s is of a device \"%s\"; %s is a \"%s\"", options->words[0], head->kind, motor->label, own.kind);
        return false;
    }
    const bool same = strcmp(head->firmware, own.firmware) == 0;
    const char *firmware = head->firmware[0] ? head->firmware : "(not stated)";
    if (!same && options->action == DIFF)
        complain("%s is of firmware %s; %s has %s: units may differ (UG 10.1)", options->words[0], firmware,
                 motor->label, own.firmware);
    else if (!same && !options->other_firmware) {
        complain("%s is of firmware %s; %s has %s. Units may differ between firmwares (UG 10.1): look at the "
                 "values, then use --other-firmware", options->words[0], firmware, motor->label, own.firmware);
        return false;
    }
    return true;
}

/* ---- files ------------------------------------------------------------------------------------------------------- */

static int backup(motor_t *motor, const params_options_t *options)
{
    params_head_t head;
    if (!read_values(motor, &motor->params))
        return EXIT_FAILED;
    head_of(motor, &head);
    char *text = params_as_yaml(&head, &motor->params);
    const bool written = text && write_output(options->words[0], (const uint8_t *)text, strlen(text));
    if (!text)
        complain("out of memory");
    free(text);
    if (written && options->common.json)
        print_json(json_pack("{s:o, s:I}", "file", cm1e_json_text(options->words[0]), "parameters",
                             (json_int_t)motor->params.count));
    else if (written && strcmp(options->words[0], "-") != 0)
        printf("%s: %zu parameters of %s\n", options->words[0], motor->params.count, motor->label);
    return written ? EXIT_OK : EXIT_FAILED;
}

static int diff(motor_t *motor, const params_options_t *options, params_t *file)
{
    params_t now;
    size_t differences = 0;
    json_t *all = json_array();
    if (!read_beside(motor, file, &now)) {
        json_decref(all);
        return EXIT_FAILED;
    }
    for (size_t i = 0; i < file->count; i++) {
        const param_t *a = &file->at[i], *b = &now.at[i];
        if (a->value == b->value || cm1e_entry_round(a->entry, a->value) == b->value)
            continue;
        differences++;
        json_array_append_new(all, json_pack("{s:s, s:I, s:I, s:I}", "name", a->entry->name, "file",
                                             (json_int_t)a->value, "motor", (json_int_t)b->value, "line",
                                             (json_int_t)a->line));
        if (!options->common.json)
            printf("%s:%zu: %s: file %" PRId64 ", motor %" PRId64 " %s\n", options->words[0], a->line, a->entry->name,
                   a->value, b->value, a->entry->unit);
    }
    if (options->common.json)
        print_json(all);
    else
        json_decref(all);
    if (!options->common.json)
        printf("%zu of %zu parameters differ\n", differences, file->count);
    return differences ? EXIT_FAILED : EXIT_OK;
}

static int run_with_file(motor_t *motor, const params_options_t *options)
{
    static params_t file;
    const comparison_t comparison = {motor, options};
    if (options->action == BACKUP)
        return backup(motor, options);
    if (!params_read_file(options->words[0], &motor->params, suits, &comparison, &file))
        return EXIT_WRONG_USE;
    return options->action == DIFF ? diff(motor, options, &file) : change(motor, options, &file);
}

/** "2.1" is connector 1 of slave 2; an axis of the bus file may be behind a bridge. Returns the exit status. */
static int find_motor(motor_t *motor, const cm1e_bus_config_t *config, const char *where)
{
    char position[16], trail;
    unsigned slave = 0, channel = 0;
    const bool has_connector = sscanf(where, "%u.%u%c", &slave, &channel, &trail) == 2;
    uint8_t of_axis;
    snprintf(position, sizeof position, "%u", slave);
    const int status = find_motor_of(motor->bus, config, has_connector ? position : where, &motor->position, &of_axis);
    motor->channel = has_connector ? channel : of_axis;
    return status;
}

/** A bridge has connectors, and nothing else has. Returns the exit status. */
static int check_connector(motor_t *motor)
{
    const unsigned channels = motor->slave->device ? motor->slave->device->channels : 0;
    snprintf(motor->label, sizeof motor->label, motor->channel ? "slave %u, connector %u" : "slave %u",
             motor->position, motor->channel);
    if (channels == 0 && motor->channel == 0)
        return EXIT_OK;
    if (motor->channel >= 1 && motor->channel <= channels)
        return EXIT_OK;
    if (channels == 0)
        complain("slave %u is no bridge: it has no connector %u", motor->position, motor->channel);
    else
        complain("slave %u is a bridge: name the connector of the motor, %u.1 ... %u.%u", motor->position,
                 motor->position, motor->position, channels);
    return EXIT_WRONG_USE;
}

static int run(motor_t *motor, const params_options_t *options)
{
    static params_t params;
    params_of(motor->slave, motor->channel, &motor->params);
    if (motor->params.count == 0) {
        complain("the parameters of %s are not known: only those of a CM1-E and of motors behind a bridge are",
                 motor->label);
        return EXIT_FAILED;
    }
    switch (options->action) {
    case LIST:
    case GET: return named(motor, options, &params) ? show(motor, &params, options->common.json) : EXIT_WRONG_USE;
    case SET: return parse_settings(motor, options, &params) ? change(motor, options, &params) : EXIT_WRONG_USE;
    default: return run_with_file(motor, options);
    }
}

static const struct argp_option table[] = {
    {"yes", KEY_YES, NULL, 0, "restore: do not ask", 0},
    {"dry-run", KEY_DRY_RUN, NULL, 0, "set, restore: show what would change, write nothing", 0},
    {"allow-motion", KEY_ALLOW, NULL, 0, "set, restore: also what may move a motor behind a bridge at once", 0},
    {"other-firmware", KEY_OTHER_FIRMWARE, NULL, 0, "restore: allow a file of another firmware", 0},
    {"force", KEY_FORCE, NULL, 0, "backup: write over a file that exists", 0},
    {0}};
const struct argp argp_params = {
    table, parse,
    "list POSITION|AXIS [NAME...]\nget POSITION|AXIS NAME...\nset POSITION|AXIS NAME=VALUE...\n"
    "backup POSITION|AXIS FILE\nrestore POSITION|AXIS FILE\ndiff POSITION|AXIS FILE",
    "Lists, reads and writes the parameters of a CM1-E, or of a motor behind a bridge (2.1: connector 1 of slave 2; by "
    "SDO, those that the bridge has: cm1e cml has the others), keeps them in a file (YAML with comments), writes them back, "
    "compares. A parameter is given by name (K47, H3, \"Home offset\", home_offset) or number (0x60F6:1B). restore "
    "checks "
    "device, firmware and every range before it writes, shows what will change, reads back each value, and says what "
    "was written if it breaks off. If a program has the network, its motors are read through it; set and restore need "
    "`control: maintain` in its bus file and an axis that it does not command.", attach_children, NULL, NULL};

static int act(cm1e_bus_t *bus, const cm1e_bus_config_t *config, const void *context, uint16_t position)
{
    static motor_t motor;
    const params_options_t *options = context;
    (void)position;
    motor.bus = bus;
    int status = find_motor(&motor, axes_to_name(&options->common, config), options->where);
    motor.slave = status == EXIT_OK ? cm1e_bus_slave(bus, motor.position) : NULL;
    if (status == EXIT_OK)
        status = check_connector(&motor);
    if (status == EXIT_OK)
        status = run(&motor, options);
    return status;
}

int command_params(int argc, char **argv)
{
    static params_options_t options;
    options.action = -1;
    if (parse_options(&argp_params, argc, argv, &options) ||
        (options.action == BACKUP && !may_overwrite(options.words[0], options.force)))
        return EXIT_WRONG_USE;
    return look_at_network(&options.common, NULL, act, &options);
}
