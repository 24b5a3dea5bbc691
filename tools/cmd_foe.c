/** cm1e foe read|write: a file in a slave (FoE, ETG.1000.6 section 5.8). */
#include "cm1e/foe.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "attach.h"
#include "command.h"
#include "core/json_text.h"
#include "end_signals.h"
#include "files.h"
#include "terminal.h"

enum { KEY_NAME = 0x980, KEY_PASSWORD, KEY_BOOTSTRAP, KEY_TIMEOUT, KEY_MAXIMUM, KEY_ALLOW };
enum { WORDS = 3, MAXIMUM_DEFAULT = 1 << 24, MAXIMUM_LARGEST = 1 << 28 };

typedef struct foe_options {
    common_options_t common;
    const char *words[WORDS]; /* read or write, slave, file */
    int word_count;
    const char *name;
    long long password, maximum;
    double timeout_s;
    bool bootstrap, allow;
} foe_options_t;

static bool is_writing(const foe_options_t *options) { return strcmp(options->words[0], "write") == 0; }

static void check_words(const foe_options_t *options, struct argp_state *state)
{
    if (options->word_count != WORDS)
        argp_error(state, "expected: read POSITION|AXIS FILE, or write POSITION|AXIS FILE");
    need_name(state, "the file", options->words[2]);
    if (is_writing(options) && !options->allow)
        argp_error(state, "writing a file changes the slave, and no backup is possible: --allow-write");
    if (!options->name && strcmp(options->words[2], "-") == 0)
        argp_error(state, "the slave knows a file by its name: --name NAME");
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    foe_options_t *options = state->input;
    switch (key) {
    case ARGP_KEY_INIT: return give_options(state, &options->common);
    case KEY_NAME: options->name = arg; return 0;
    case KEY_PASSWORD: return parse_number(arg, "the password", 0, 0xFFFFFFFF, &options->password) ? 0 : EINVAL;
    case KEY_MAXIMUM: return parse_number(arg, "the maximum", 1, MAXIMUM_LARGEST, &options->maximum) ? 0 : EINVAL;
    case KEY_TIMEOUT: return parse_seconds(arg, 600, &options->timeout_s) ? 0 : EINVAL;
    case KEY_BOOTSTRAP: options->bootstrap = true; return 0;
    case KEY_ALLOW: options->allow = true; return 0;
    case ARGP_KEY_ARG:
        if (options->word_count == WORDS)
            argp_error(state, "one file at a time; \"%s\" is too many", arg);
        if (options->word_count == 0 && choose_word("action", arg, "read|write") < 0)
            return EINVAL;
        options->words[options->word_count++] = arg;
        return 0;
    case ARGP_KEY_END: check_words(options, state); return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static bool show_progress(void *context, size_t done, size_t size)
{
    size_t *shown = context;
    const size_t step = size ? size / 100 + 1 : 10000;
    if (at_a_terminal() && (done / step != *shown / step || done == size))
        fprintf(stderr, "\r\033[K%zu bytes%s", done, done == size ? "\n" : "");
    *shown = done;
    return !told_to_end();
}

/** The name by which the slave knows the file: that of the file without its folders. */
static const char *name_of(const foe_options_t *options)
{
    const char *slash = strrchr(options->words[2], '/');
    return options->name ? options->name : slash ? slash + 1 : options->words[2];
}

static int tell(const foe_options_t *options, uint16_t position, size_t size)
{
    const bool writing = is_writing(options);
    if (options->common.json)
        print_json(json_pack("{s:i, s:s, s:o, s:I}", "position", position, "action", writing ? "write" : "read",
                             "name", cm1e_json_text(name_of(options)), "bytes", (json_int_t)size));
    else
        fprintf(stderr, "slave %u: %s of %zu bytes was %s\n", position, name_of(options), size,
                writing ? "written" : "read");
    return EXIT_OK;
}

static int read_file(cm1e_bus_t *bus, uint16_t position, const foe_options_t *options,
                     const cm1e_foe_options_t *transfer)
{
    size_t size = (size_t)options->maximum;
    uint8_t *bytes = malloc(size);
    cm1e_diag_t diag = {0};
    int status = EXIT_FAILED;
    if (!bytes)
        complain("no memory for a file of up to %zu bytes: give a smaller --maximum", size);
    else if (cm1e_foe_read(bus, position, name_of(options), bytes, &size, transfer, &diag) != CM1E_OK)
        status = fail(&diag);
    else if (write_output(options->words[2], bytes, size))
        status = tell(options, position, size);
    free(bytes);
    return status;
}

static int write_file(cm1e_bus_t *bus, uint16_t position, const foe_options_t *options,
                      const cm1e_foe_options_t *transfer)
{
    cm1e_diag_t diag = {0};
    input_t file;
    if (!read_input(options->words[2], &file))
        return EXIT_WRONG_USE;
    int status = EXIT_OK;
    if (cm1e_foe_write(bus, position, name_of(options), file.bytes, file.size, transfer, &diag) != CM1E_OK)
        status = fail(&diag);
    else
        tell(options, position, file.size);
    free(file.bytes);
    return status;
}

static int transfer_file(cm1e_bus_t *bus, const cm1e_bus_config_t *config, const void *context, uint16_t position)
{
    const foe_options_t *options = context;
    size_t shown = 0;
    const cm1e_foe_options_t transfer = {.password = (uint32_t)options->password, .bootstrap = options->bootstrap,
                                         .answer_ns = (int64_t)(options->timeout_s * 1e9),
                                         .progress = show_progress, .context = &shown};
    (void)config;
    catch_signals();
    return is_writing(options) ? write_file(bus, position, options, &transfer)
                               : read_file(bus, position, options, &transfer);
}

/** Of the network, or of the program that runs it. */
static int transfer_of_network(const foe_options_t *options)
{
    static cm1e_bus_config_t config;
    cm1e_diag_t diag = {0};
    if (!load_network(&options->common, &config))
        return EXIT_WRONG_USE;
    if (options->bootstrap && refuse_to_attach(&options->common, &config, "Bootstrap", "it takes the slave out of the "
                                               "cycle", &diag) != CM1E_OK)
        return fail(&diag);
    return look_at_loaded(&options->common, &config, options->words[1], transfer_file, options);
}

static const struct argp_option table[] = {
    {"name", KEY_NAME, "NAME", 0, "Name by which the slave knows the file; default: that of FILE", 0},
    {"password", KEY_PASSWORD, "NUMBER", 0, "Password that the slave wants; default: 0", 0},
    {"bootstrap", KEY_BOOTSTRAP, NULL, 0, "In the state Bootstrap, with its mailbox", 0},
    {"timeout", KEY_TIMEOUT, "S", 0, "Longest time for one answer, or for being busy; default: 5", 0},
    {"maximum", KEY_MAXIMUM, "BYTES", 0, "Most bytes that are read; default: 16777216", 0},
    {"allow-write", KEY_ALLOW, NULL, 0, "Write: what the file does in the slave is in its manual", 0},
    {0}};
const struct argp argp_foe = {
    table, parse, "read|write POSITION|AXIS FILE",
    "Reads a file of a slave into FILE, or writes FILE into it (FoE), in Pre-Operational or, with --bootstrap, in "
    "Bootstrap. FILE may be -, with --name. Where a program runs the network with `control: maintain`, it transfers "
    "the file beside its cycle; Bootstrap needs the network for itself. For the firmware of a CM1-E use "
    "`cm1e firmware update`.", attach_children, NULL, NULL};

int command_foe(int argc, char **argv)
{
    foe_options_t options = {.timeout_s = 5, .maximum = MAXIMUM_DEFAULT};
    if (parse_options(&argp_foe, argc, argv, &options))
        return EXIT_WRONG_USE;
    return transfer_of_network(&options);
}
