/** cm1e check: the cross-checker for files of all formats. */
#include <stdio.h>
#include <stdlib.h>

#include "cm1e/generate.h"
#include "command.h"
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

static const struct argp_option table[] = {{"json", 'j', NULL, 0, "Write JSON", 0}, {0}};
const struct argp argp_check = {table, parse, "FILE",
                                 "Checks an ESI, EC_EXTEND, SII or ENI file from any source for errors that a "
                                 "schema does not find (docs/CHECK-RULES.md). Exit status 0: no finding, or "
                                 "warnings only; 1: errors, or a file of no known format; 2: it cannot be read.", NULL, NULL, NULL};

int command_check(int argc, char **argv)
{
    check_options_t options = {0};
    if (parse_options(&argp_check, argc, argv, &options))
        return EXIT_WRONG_USE;
    input_t input;
    if (!read_input(options.file, &input))
        return EXIT_WRONG_USE;
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
