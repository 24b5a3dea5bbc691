/** cm1e st: checks programs in Structured Text, and translates them into programs that `cm1e run` runs. */
#include <errno.h>
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "command.h"
#include "core/json_text.h"
#include "core/output.h"
#include "end_signals.h"
#include "files.h"
#include "st/st.h"

enum { SOURCES = 200, ARGUMENTS = 32, KEY_C = 0x700, KEY_JSON, KEY_VARIABLES };

typedef struct st_options {
    const char *word, *output, *c_file;
    const char *sources[SOURCES];
    int source_count;
    long long variables;
    bool json;
} st_options_t;

static error_t parse(int key, char *arg, struct argp_state *state)
{
    st_options_t *options = state->input;
    switch (key) {
    case 'o':
    case KEY_C:
        need_name(state, "the file", arg);
        *(key == 'o' ? &options->output : &options->c_file) = arg;
        return 0;
    case KEY_JSON: options->json = want_json(); return 0;
    case KEY_VARIABLES:
        return parse_number(arg, "the number of variables", 0, 10000000, &options->variables) ? 0 : EINVAL;
    case ARGP_KEY_ARG:
        if (!options->word)
            options->word = arg;
        else if (options->source_count < SOURCES)
            options->sources[options->source_count++] = arg;
        else
            argp_error(state, "at most %d sources", SOURCES);
        return 0;
    case ARGP_KEY_END:
        if (!options->word || choose_word("action", options->word, "check|build") < 0)
            argp_error(state, "what is to be done? check or build");
        if (options->source_count == 0)
            argp_error(state, "which program? Name its sources, for instance machine.st");
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_option table[] = {
    {"output", 'o', "FILE", 0, "build: the translated program (default: the first source, with .so)", 0},
    {"c", KEY_C, "FILE", 0, "build: keep the C that the program became", 0},
    {"variables", KEY_VARIABLES, "N", 0, "build: most variables that others see while the program runs (10000)", 0},
    {"json", KEY_JSON, NULL, 0, "check: write JSON", 0},
    {0},
};
const struct argp argp_st = {
    table, parse, "check SOURCE...\nbuild SOURCE... [-o PROGRAM.so]",
    "Checks sources in Structured Text (IEC 61131-3), or translates them to C and compiles that with the C compiler of "
    "the machine (CC, else cc) into a program for `cm1e run`. All function blocks of the library are known. An error "
    "is told with file, line and column. docs/STRUCTURED-TEXT.md describes the language.", NULL, NULL, NULL};

/* ---- errors ------------------------------------------------------------------------------------------------------ */

static void print_errors(const st_t *st, bool json)
{
    json_t *all = json ? json_array() : NULL;
    for (unsigned i = 0; i < cm1e_st_errors(st); i++) {
        const st_error_t error = cm1e_st_error(st, i);
        if (json)
            json_array_append_new(all, json_pack("{s:o, s:I, s:I, s:o}", "file", cm1e_json_text(error.file), "line",
                                                 (json_int_t)error.line, "column", (json_int_t)error.column, "text",
                                                 cm1e_json_text(error.text)));
        else
            cm1e_st_print_error(st, i, stderr);
    }
    if (json)
        print_json(all);
    else if (cm1e_st_suppressed(st) > 0)
        fprintf(stderr, "and %u more\n", cm1e_st_suppressed(st));
}

/* ---- the compiler ------------------------------------------------------------------------------------------------ */

/** Runs the C compiler; its output is the user's to see, for a complaint of it is a fault of ours. */
static int compile(const char *c_file, const char *folder, const char *output)
{
    /* GCC 12 makes -x of 0.0 - x, which has another sign for 0, unless the rounding may change. */
    static const char *const flags[] = {"-std=c11", "-O2", "-g", "-fwrapv", "-fno-strict-aliasing", "-ffp-contract=off", "-frounding-math",
                                        "-fPIC", "-shared"};
    const char *compiler = getenv("CC");
    char map[PATH_MAX + 60]; /* the name of the folder is another one each time, and is not to be in the program */
    const char *arguments[ARGUMENTS];
    size_t count = 0;
    arguments[count++] = compiler && compiler[0] ? compiler : "cc";
    for (size_t i = 0; i < sizeof flags / sizeof flags[0]; i++)
        arguments[count++] = flags[i];
    snprintf(map, sizeof map, "-ffile-prefix-map=%s=.", folder);
    arguments[count++] = map;
    arguments[count++] = "-o";
    arguments[count++] = output;
    arguments[count++] = "-x";
    arguments[count++] = "c";
    arguments[count++] = c_file;
    arguments[count++] = "-lm";
    arguments[count] = NULL;
    int status = 0;
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        execvp(arguments[0], (char *const *)(uintptr_t)arguments);
        _exit(127);
    }
    pid_t ended;
    while ((ended = child < 0 ? -1 : waitpid(child, &status, 0)) < 0 && child > 0 && errno == EINTR)
        kill(child, SIGTERM); /* the compiler removes its own files then */
    if (ended < 0) {
        complain("the compiler %s cannot be started: %s", arguments[0], strerror(errno));
        return EXIT_FAILED;
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
        complain("there is no C compiler \"%s\"; install one (Debian: apt install gcc), or name it in the environment "
                 "variable CC", arguments[0]);
    else if (told_to_end() && !(WIFEXITED(status) && WEXITSTATUS(status) == 0))
        complain("interrupted: no program was made");
    else if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        complain("the compiler %s could not compile %s", arguments[0], c_file);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? EXIT_OK : EXIT_FAILED;
}

/** The name of the first source with another ending. */
static void name_beside(const char *source, const char *ending, char *name, size_t size)
{
    const char *dot = strrchr(source, '.'), *slash = strrchr(source, '/');
    const size_t length = dot && (!slash || dot > slash + 1) && dot != source ? (size_t)(dot - source) : strlen(source);
    snprintf(name, size, "%.*s%s", (int)length, source, ending);
}

static int refuse_to_build(const st_options_t *options)
{
    complain("%s%s without a PROGRAM: nothing would run. Write PROGRAM name ... END_PROGRAM; types, functions and "
             "function blocks alone are checked with \"cm1e st check\"", options->sources[0],
             options->source_count == 1 ? " is" : " and the other sources are");
    return EXIT_FAILED;
}

/** What is written is no device, and none of the sources. */
static bool may_write(const char *path, const st_options_t *options)
{
    struct stat present, source;
    if (stat(path, &present) != 0)
        return true;
    if (!S_ISREG(present.st_mode)) {
        complain("%s is there already, and is not a file: name the file that is to be made", path);
        return false;
    }
    for (int i = 0; i < options->source_count; i++)
        if (stat(options->sources[i], &source) == 0 && source.st_dev == present.st_dev && source.st_ino == present.st_ino) {
            complain("%s is a source of the program, and would be lost: name another file", path);
            return false;
        }
    return true;
}

static bool write_c(st_t *st, const char *c_file, const char *program)
{
    cm1e_diag_t diag = {0};
    cm1e_output_t file;
    const char *slash = strrchr(program, '/');
    if (cm1e_output_open(&file, c_file, &diag) == CM1E_OK) {
        cm1e_st_emit(st, file.file, slash ? slash + 1 : program);
        if (cm1e_output_close(&file, &diag) == CM1E_OK)
            return true;
    }
    fail(&diag);
    return false;
}

/** Makes the program, and its C without --c, in a folder of their own; the program is put in its place when it is complete.
 *  The debugger needs the C no longer, thanks to #line. */
static int build_in(const char *folder, st_t *st, const st_options_t *options, const char *output)
{
    char own_c[PATH_MAX + 40], made[PATH_MAX + 40];
    snprintf(own_c, sizeof own_c, "%s/program.c", folder);
    snprintf(made, sizeof made, "%s/program.so", folder);
    const char *c_file = options->c_file ? options->c_file : own_c;
    int status = write_c(st, c_file, output) ? compile(c_file, folder, made) : EXIT_FAILED;
    if (status == EXIT_OK && rename(made, output) != 0) {
        complain("%s cannot be written: %s", output, strerror(errno));
        status = EXIT_FAILED;
    }
    unlink(made);
    unlink(own_c);
    return status;
}

static int build(st_t *st, const st_options_t *options)
{
    char output[PATH_MAX], place[PATH_MAX], folder[PATH_MAX + 20];
    if (options->output)
        snprintf(output, sizeof output, "%s", options->output);
    else
        name_beside(options->sources[0], ".so", output, sizeof output);
    if (!may_write(output, options) || (options->c_file && !may_write(options->c_file, options)))
        return EXIT_WRONG_USE;
    if (options->c_file && same_file(options->c_file, output)) {
        complain("--c and -o name the same file, %s: the program would replace its C", output);
        return EXIT_WRONG_USE;
    }
    const char *target = realpath(output, place) ? place : output; /* a link stays a link */
    snprintf(folder, sizeof folder, "%s.XXXXXX", target);
    catch_signals(); /* they end the compiler, and what is there by then is removed */
    if (!mkdtemp(folder)) {
        complain("%s cannot be written: %s", output, strerror(errno));
        return EXIT_FAILED;
    }
    const int status = build_in(folder, st, options, target);
    rmdir(folder);
    return status;
}

int command_st(int argc, char **argv)
{
    st_options_t options = {.variables = 10000};
    cm1e_diag_t diag = {0};
    if (parse_options(&argp_st, argc, argv, &options))
        return EXIT_WRONG_USE;
    st_t *st = cm1e_st_new();
    if (!st) {
        complain("out of memory");
        return EXIT_FAILED;
    }
    int status = EXIT_OK;
    cm1e_st_list_most(st, (uint64_t)options.variables);
    for (int i = 0; i < options.source_count && status == EXIT_OK; i++)
        if (cm1e_st_add_file(st, options.sources[i], &diag) != CM1E_OK) {
            (void)fail(&diag);
            status = EXIT_WRONG_USE;
        }
    if (status == EXIT_OK && !cm1e_st_check(st))
        status = EXIT_FAILED;
    if (status == EXIT_OK && strcmp(options.word, "build") == 0)
        status = cm1e_st_runs(st) ? build(st, &options) : refuse_to_build(&options);
    else if (diag.text[0] == '\0')
        print_errors(st, options.json);
    cm1e_st_free(st);
    return status;
}
