/** cm1e diff: compares a file with the live devices that it describes. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>

#include "attach.h"
#include "cm1e/generate.h"
#include "command.h"
#include "files.h"
#include "which_slave.h"

typedef struct diff_options {
    common_options_t common;
    const char *file;
    const char *where; /* NULL: every slave that the file describes */
} diff_options_t;

static error_t parse(int key, char *arg, struct argp_state *state)
{
    diff_options_t *options = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case 'p': {
        uint16_t position;
        options->where = arg;
        return is_position(arg) && !parse_position(arg, &position) ? EINVAL : 0;
    }
    case ARGP_KEY_ARG:
    case ARGP_KEY_END: return parse_file_word(key, arg, state, &options->file);
    default: return ARGP_ERR_UNKNOWN;
    }
}

/** Compares with one slave and prints it, or appends it to `json`. EXIT_WRONG_USE: it could not be compared;
 *  `*described` says whether the file describes this slave. */
static int diff_slave(cm1e_bus_t *bus, const diff_options_t *options, const input_t *input, uint16_t position,
                      json_t *json, bool *described, cm1e_diag_t *diag)
{
    char title[64];
    cm1e_findings_t *findings = NULL;
    const cm1e_error_t error = cm1e_diff_file(&findings, input->bytes, input->size, bus, position, diag);
    *described = error != CM1E_ERROR_NOT_FOUND;
    if (error != CM1E_OK)
        return EXIT_WRONG_USE;
    const char *format = cm1e_file_format_name(cm1e_file_recognise(input->bytes, input->size));
    snprintf(title, sizeof title, "%s beside slave %u", format, position);
    const int status = json ? findings_status(findings) : print_findings(options->file, title, findings, false);
    if (json) {
        json_t *object = findings_as_json(options->file, format, findings);
        json_object_set_new(object, "position", json_integer(position));
        json_array_append_new(json, object);
    }
    cm1e_findings_free(findings);
    return status;
}

static int run(cm1e_bus_t *bus, const cm1e_bus_config_t *config, const diff_options_t *options, const input_t *input,
               json_t *json)
{
    cm1e_diag_t diag = {0};
    const uint32_t count = cm1e_bus_slave_count(bus);
    int status = EXIT_OK;
    uint32_t compared = 0;
    uint16_t wanted = 0;
    if (options->where && find_slave(bus, axes_to_name(&options->common, config), options->where, &wanted) != EXIT_OK)
        return EXIT_WRONG_USE;
    for (uint32_t position = 1; position <= count; position++) {
        bool described;
        if (wanted && position != wanted)
            continue;
        const int of_slave = diff_slave(bus, options, input, (uint16_t)position, json, &described, &diag);
        if (of_slave == EXIT_WRONG_USE && (described || wanted)) {
            complain("%s: slave %u: %s", options->file, position, diag.text);
            return EXIT_WRONG_USE;
        }
        compared += described;
        if (of_slave == EXIT_FAILED)
            status = EXIT_FAILED;
    }
    if (compared > 0)
        return status;
    complain("%s does not describe any slave of the network: %s", options->file, diag.text);
    return EXIT_WRONG_USE;
}

static const struct argp_option table[] = {
    {"position", 'p', "POSITION|AXIS", 0, "Compare only this slave; default: every slave that the file "
                                     "describes", 0}, {0}};
const struct argp argp_diff = {
    table, parse, "FILE",
    "Compares an ESI, EC_EXTEND, SII or ENI file with live devices: identity, EEPROM, mailbox, sync managers, PDO "
    "mapping and assignment, dictionary (docs/CHECK-RULES.md). Exit status 0: no difference, or warnings only; 1: "
    "differences; 2: not compared.", attach_children, NULL, NULL};

int command_diff(int argc, char **argv)
{
    diff_options_t options = {0};
    if (parse_options(&argp_diff, argc, argv, &options))
        return EXIT_WRONG_USE;
    static cm1e_bus_config_t config;
    input_t input;
    if (!load_network(&options.common, &config) || !read_input(options.file, &input))
        return EXIT_WRONG_USE;
    cm1e_diag_t diag = {0};
    cm1e_bus_t *bus = NULL;
    json_t *json = options.common.json ? json_array() : NULL;
    int status = EXIT_WRONG_USE;
    if (open_network(&options.common, &config, &bus, &diag) == CM1E_OK)
        status = run(bus, &config, &options, &input, json);
    else
        fail(&diag);
    status = close_bus(bus, &options.common, status);
    if (json && status != EXIT_WRONG_USE)
        print_json(json);
    else
        json_decref(json);
    free(input.bytes);
    return status;
}
