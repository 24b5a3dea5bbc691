#include "files.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "command.h"
#include "core/output.h"

/* More than any reader accepts, so that the readers report their own limits. */
enum { INPUT_LIMIT = 64 << 20, PIECE = 65536, LINKS_MAX = 40 };

error_t parse_file_word(int key, char *arg, struct argp_state *state, const char **file)
{
    if (key == ARGP_KEY_ARG && *file)
        argp_error(state, "one file at a time; \"%s\" is too many", arg);
    if (key == ARGP_KEY_ARG)
        *file = arg;
    else if (!*file)
        argp_error(state, "which file?");
    return 0;
}

static bool read_all(FILE *file, const char *path, input_t *input)
{
    size_t room = 0;
    *input = (input_t){0};
    for (;;) {
        if (input->size + PIECE > room) {
            room = 2 * room + 2 * PIECE;
            uint8_t *larger = realloc(input->bytes, room);
            if (!larger) {
                complain("%s: out of memory", path);
                return false;
            }
            input->bytes = larger;
        }
        const size_t got = fread(input->bytes + input->size, 1, PIECE, file);
        input->size += got;
        if (input->size > INPUT_LIMIT) {
            complain("%s is larger than %d MB", path, INPUT_LIMIT >> 20);
            return false;
        }
        if (got < PIECE)
            break;
    }
    if (ferror(file))
        complain("cannot read %s: %s", path, strerror(errno));
    return !ferror(file);
}

bool read_input(const char *path, input_t *input)
{
    const bool standard = strcmp(path, "-") == 0;
    struct stat about;
    FILE *file = standard ? stdin : fopen(path, "rb");
    *input = (input_t){0};
    if (!file || (!standard && fstat(fileno(file), &about) == 0 && S_ISDIR(about.st_mode))) {
        complain("cannot read %s: %s", path, file ? "it is a folder" : strerror(errno));
        if (file)
            fclose(file);
        return false;
    }
    const bool good = read_all(file, path, input);
    if (!good) {
        free(input->bytes);
        *input = (input_t){0};
    }
    if (!standard)
        fclose(file);
    return good;
}

/** The path without links and dots up to its last name, which need not exist. */
static bool resolve_folder(const char *path, char resolved[PATH_MAX])
{
    char folder[PATH_MAX], place[PATH_MAX];
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const int length = slash ? (int)(slash - path) + 1 : 1;
    if (snprintf(folder, sizeof folder, "%.*s", length, slash ? path : ".") >= PATH_MAX || !realpath(folder, place))
        return false;
    return snprintf(resolved, PATH_MAX, "%s/%s", place, name) < PATH_MAX;
}

/** The path without links and dots. Where nothing is there yet, a link leads to where it will be. */
static bool resolve(const char *path, char resolved[PATH_MAX])
{
    char target[PATH_MAX], next[PATH_MAX];
    if (realpath(path, resolved))
        return true;
    bool good = resolve_folder(path, resolved);
    ssize_t length;
    for (int links = 0; good && links < LINKS_MAX && (length = readlink(resolved, target, sizeof target - 1)) > 0; links++) {
        target[length] = '\0';
        *strrchr(resolved, '/') = '\0'; /* a link counts from its folder */
        const int size = snprintf(next, sizeof next, target[0] == '/' ? "%.0s%s" : "%s/%s", resolved, target);
        good = size < PATH_MAX && resolve_folder(next, resolved);
    }
    return good;
}

bool same_file(const char *left, const char *right)
{
    char of_left[PATH_MAX], of_right[PATH_MAX];
    if (strcmp(left, right) == 0)
        return true;
    return strcmp(left, "-") != 0 && strcmp(right, "-") != 0 && resolve(left, of_left) && resolve(right, of_right) &&
           strcmp(of_left, of_right) == 0;
}

bool may_overwrite(const char *path, bool force)
{
    struct stat found;
    const bool good = force || strcmp(path, "-") == 0 || lstat(path, &found) != 0 || S_ISCHR(found.st_mode);
    if (!good)
        complain("%s exists; --force writes over it", path);
    return good;
}

static bool write_all(FILE *file, const void *bytes, size_t size)
{
    return fwrite(bytes, 1, size, file) == size && fflush(file) == 0;
}

bool write_output(const char *path, const void *bytes, size_t size)
{
    if (strcmp(path, "-") == 0) {
        const bool written = write_all(stdout, bytes, size);
        if (!written)
            complain("cannot write to standard output: %s", strerror(errno));
        return written;
    }
    cm1e_diag_t diag = {0};
    cm1e_output_t output;
    cm1e_error_t error = cm1e_output_open(&output, path, &diag);
    if (error == CM1E_OK) {
        fwrite(bytes, 1, size, output.file); /* a failed write is reported at the end */
        error = cm1e_output_close(&output, &diag);
    }
    if (error != CM1E_OK)
        fail(&diag);
    return error == CM1E_OK;
}
