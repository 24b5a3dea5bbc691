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

bool write_output(const char *path, const void *bytes, size_t size)
{
    char temporary[4096];
    if (strcmp(path, "-") == 0) {
        const bool written = write_all(stdout, bytes, size);
        if (!written)
            complain("cannot write to standard output: %s", strerror(errno));
        return written;
    }
    /* Not a plain file (a device, a pipe): nothing to rename. */
    struct stat about;
    const bool special = stat(path, &about) == 0 && !S_ISREG(about.st_mode);
    if ((size_t)snprintf(temporary, sizeof temporary, special ? "%s" : "%s.part", path) >= sizeof temporary) {
        complain("the file name is too long");
        return false;
    }
    FILE *file = fopen(temporary, "wb");
    bool good = file && write_all(file, bytes, size);
    good = file && fclose(file) == 0 && good && (special || rename(temporary, path) == 0);
    if (!good) {
        complain("cannot write %s: %s", path, strerror(errno));
        if (file && !special)
            remove(temporary);
    }
    return good;
}
