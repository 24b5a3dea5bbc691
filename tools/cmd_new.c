/** cm1e new: a project that builds against the installed library and runs on the simulated network at once. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "command.h"
#include "files.h"
#include "template.h"

typedef struct new_options {
    const char *folder;
} new_options_t;

static error_t parse(int key, char *arg, struct argp_state *state)
{
    new_options_t *options = state->input;
    switch (key) {
    case ARGP_KEY_ARG:
        if (options->folder)
            argp_error(state, "one folder is enough; \"%s\" is too many", arg);
        if (!arg[0])
            argp_error(state, "the folder needs a name; it is empty");
        options->folder = arg;
        return 0;
    case ARGP_KEY_END:
        if (!options->folder)
            argp_error(state, "which folder? It is made, and must not exist");
        return 0;
    default: return ARGP_ERR_UNKNOWN;
    }
}

const struct argp argp_new = {
    NULL, parse, "DIR",
    "Makes the folder DIR with a project in it: a program that moves one motor there and back (main.c), its bus "
    "file, a "
    "CMakeLists.txt and a Makefile, which build it against the installed library. It runs on the simulated network at "
    "once. A folder that exists is left alone.", NULL, NULL, NULL};

int command_new(int argc, char **argv)
{
    new_options_t options = {0};
    if (parse_options(&argp_new, argc, argv, &options))
        return EXIT_WRONG_USE;
    if (mkdir(options.folder, 0777) != 0) {
        complain("cannot make the folder %s: %s", options.folder, strerror(errno));
        return EXIT_FAILED;
    }
    for (size_t i = 0; i < template_file_count; i++) {
        char path[4096];
        const int length = snprintf(path, sizeof path, "%s/%s", options.folder, template_files[i].name);
        if (length < 0 || (size_t)length >= sizeof path) {
            complain("the name of the folder is too long");
            return EXIT_FAILED;
        }
        if (!write_output(path, template_files[i].bytes, template_files[i].size))
            return EXIT_FAILED;
        printf("%s\n", path);
    }
    printf("\ncd %s && make && ./motion\n", options.folder);
    return EXIT_OK;
}
