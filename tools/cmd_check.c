/** cm1e check: the cross-checker for files of all formats, and bus files. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cm1e/generate.h"
#include "command.h"
#include "core/json_text.h"
#include "files.h"

typedef struct check_options {
    const char *file;
    bool json;
} check_options_t;

static error_t parse(int key, char *arg, struct argp_state *state)
{
    check_options_t *options = state->input;
    switch (key) {
    case 'j': options->json = want_json(); return 0;
    case ARGP_KEY_ARG:
    case ARGP_KEY_END: return parse_file_word(key, arg, state, &options->file);
    default: return ARGP_ERR_UNKNOWN;
    }
}

static bool ends_with(const char *text, const char *end)
{
    const size_t length = strlen(text), of_end = strlen(end);
    return length > of_end && strcmp(text + length - of_end, end) == 0;
}

/** What would be refused when a command or a program reads the bus file; the network is not looked at. */
static int check_bus_file(const char *path, bool json)
{
    static cm1e_bus_config_t buses[CM1E_MAX_BUSES];
    cm1e_diag_t diag = {0};
    uint32_t count = 0, axes = 0, slaves = 0;
    cm1e_error_t error = cm1e_bus_config_load_all(buses, CM1E_MAX_BUSES, &count, path, &diag);
    for (uint32_t i = 0; i < count; i++) { /* 0 after an error */
        axes += buses[i].axis_count;
        slaves += buses[i].slave_count;
        if (error == CM1E_OK)
            error = check_segment(buses[i].interface_name, &diag);
        cm1e_bus_config_free(&buses[i]);
    }
    if (json) {
        json_t *findings = json_array();
        if (error != CM1E_OK)
            json_array_append_new(findings, json_pack("{s:s, s:s}", "severity", "error", "text", diag.text));
        print_json(json_pack("{s:o, s:s, s:o}", "file", cm1e_json_text(path), "format", "bus file", "findings", findings));
    } else if (error == CM1E_OK) {
        printf("%s: bus file, %u ax%s, %u other slave%s, no error\n", path, axes, axes == 1 ? "is" : "es", slaves,
               slaves == 1 ? "" : "s");
    }
    return error == CM1E_OK ? EXIT_OK : json ? EXIT_FAILED : fail(&diag);
}

static const struct argp_option table[] = {{"json", 'j', NULL, 0, "Write JSON", 0}, {0}};
const struct argp argp_check = {table, parse, "FILE",
                                 "Checks an ESI, EC_EXTEND, SII or ENI file from any source for errors that a "
                                 "schema does not find (docs/CHECK-RULES.md). A file whose name ends in .yaml or .yml "
                                 "is checked as a bus file (docs/BUS-FILE.md), without its network, and so is the file "
                                 "of an interface sim:FILE. Exit status 0: no "
                                 "finding, or warnings only; 1: errors, or a file of no known format; 2: it cannot be "
                                 "read.", NULL, NULL, NULL};

int command_check(int argc, char **argv)
{
    check_options_t options = {0};
    if (parse_options(&argp_check, argc, argv, &options))
        return EXIT_WRONG_USE;
    input_t input;
    if (!read_input(options.file, &input))
        return EXIT_WRONG_USE;
    if (ends_with(options.file, ".yaml") || ends_with(options.file, ".yml")) {
        free(input.bytes);
        return check_bus_file(options.file, options.json);
    }
    cm1e_findings_t *findings = NULL;
    cm1e_diag_t diag = {0};
    const cm1e_file_format_t format = cm1e_file_recognise(input.bytes, input.size);
    const cm1e_error_t error = cm1e_check_file(&findings, input.bytes, input.size, &diag);
    free(input.bytes);
    if (error != CM1E_OK) {
        complain("%s: %s", options.file, diag.text);
        return EXIT_FAILED;
    }
    const int status = print_findings(options.file, cm1e_file_format_name(format), findings, options.json);
    cm1e_findings_free(findings);
    return status;
}
