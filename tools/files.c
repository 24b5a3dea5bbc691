#include "files.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "command.h"

/* More than any of the readers takes, so that their own limit can be named. */
enum { INPUT_LIMIT = 64 << 20, PIECE = 65536 };

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

static bool write_all(FILE *file, const void *bytes, size_t size)
{
    return fwrite(bytes, 1, size, file) == size && fflush(file) == 0;
}

/* A new file beside `path`, under a name that nobody has, with the rights that `path` has or would get. NULL: errno. */
static FILE *create_beside(const char *path, const struct stat *present, char *temporary)
{
    sprintf(temporary, "%s.XXXXXX", path);
    const int descriptor = mkstemp(temporary);
    const mode_t mask = umask(0);
    umask(mask);
    FILE *file = descriptor >= 0 ? fdopen(descriptor, "wb") : NULL;
    if (file && fchmod(descriptor, present ? present->st_mode & 07777 : 0666 & ~mask) == 0)
        return file;
    const int error = errno;
    if (file)
        fclose(file);
    if (descriptor >= 0)
        remove(temporary);
    errno = error;
    return NULL;
}

static bool write_and_rename(const char *path, const struct stat *present, const void *bytes, size_t size)
{
    char *temporary = malloc(strlen(path) + sizeof ".XXXXXX");
    FILE *file = temporary ? create_beside(path, present, temporary) : NULL;
    bool good = file && write_all(file, bytes, size);
    good = file && fclose(file) == 0 && good && rename(temporary, path) == 0;
    if (file && !good) {
        const int error = errno;
        remove(temporary);
        errno = error;
    }
    free(temporary);
    return good;
}

bool write_output(const char *path, const void *bytes, size_t size)
{
    if (strcmp(path, "-") == 0) {
        const bool written = write_all(stdout, bytes, size);
        if (!written)
            complain("cannot write to standard output: %s", strerror(errno));
        return written;
    }
    struct stat about;
    const bool there = stat(path, &about) == 0;
    bool good;
    if (there && !S_ISREG(about.st_mode)) { /* a device, a pipe: nothing to rename */
        FILE *file = fopen(path, "wb");
        good = file && write_all(file, bytes, size);
        good = file && fclose(file) == 0 && good;
    } else {
        char *linked = there ? realpath(path, NULL) : NULL; /* a link stays one */
        good = write_and_rename(linked ? linked : path, there ? &about : NULL, bytes, size);
        free(linked);
    }
    if (!good)
        complain("cannot write %s: %s", path, strerror(errno));
    return good;
}
