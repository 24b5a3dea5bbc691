/** cm1e new: a project that builds against the installed library and runs on the simulated network at once. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "command.h"
#include "files.h"
#include "template.h"

enum { PATH_BYTES = 4096 };

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

/* Whether there is room for it. */
static bool path_of(const new_options_t *options, size_t file, char *path, size_t size)
{
    const int length = snprintf(path, size, "%s/%s", options->folder, template_files[file].name);
    return length >= 0 && (size_t)length < size;
}

/* Half a project would be left alone the next time. */
static int take_away(const new_options_t *options, size_t files)
{
    char path[PATH_BYTES];
    while (files-- > 0)
        if (path_of(options, files, path, sizeof path))
            (void)unlink(path);
    (void)rmdir(options->folder);
    return EXIT_FAILED;
}

int command_new(int argc, char **argv)
{
    new_options_t options = {0};
    char path[PATH_BYTES];
    if (parse_options(&argp_new, argc, argv, &options))
        return EXIT_WRONG_USE;
    if (mkdir(options.folder, 0777) != 0) {
        complain("cannot make the folder %s: %s", options.folder, strerror(errno));
        return EXIT_FAILED;
    }
    for (size_t i = 0; i < template_file_count; i++) {
        const bool fits = path_of(&options, i, path, sizeof path);
        if (!fits)
            complain("the name of the folder is too long");
        if (!fits || !write_output(path, template_files[i].bytes, template_files[i].size))
            return take_away(&options, i);
        printf("%s\n", path);
    }
    printf("\ncd %s && make && ./motion\n", options.folder);
    return EXIT_OK;
}
