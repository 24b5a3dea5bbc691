#include "core/output.h"

#include <errno.h>
#include <limits.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static cm1e_error_t cannot_write(const char *path, int error, cm1e_diag_t *diag)
{
    return cm1e_diag_set(diag, CM1E_ERROR_IO, 0, "%s cannot be written: %s.", path, strerror(error));
}

static void forget(cm1e_output_t *output)
{
    free(output->path);
    free(output->temporary);
    *output = (cm1e_output_t){0};
}

/** Creates a new file beside the final one, with the rights of the present file or of a new one. NULL: see errno. */
static FILE *create_beside(char *temporary, const struct stat *present)
{
    const int descriptor = mkstemp(temporary); /* creates exclusively: follows no link, overwrites no file */
    const mode_t mask = umask(0);
    umask(mask);
    FILE *file = descriptor >= 0 ? fdopen(descriptor, "wb") : NULL;
    if (file && fchmod(descriptor, present ? present->st_mode & 07777 : 0666 & ~mask) == 0)
        return file;
    const int error = errno;
    if (file)
        fclose(file);
    else if (descriptor >= 0)
        close(descriptor);
    if (descriptor >= 0)
        unlink(temporary);
    errno = error;
    return NULL;
}

/** Resolves the final place of the file and what exists there. false: see errno. */
static bool find_place(cm1e_output_t *output, const char *path, struct stat *present, bool *there)
{
    *there = stat(path, present) == 0;
    output->path = *there ? realpath(path, NULL) : strdup(path);
    if (output->path && *there && S_ISDIR(present->st_mode))
        errno = EISDIR;
    return output->path && !(*there && S_ISDIR(present->st_mode));
}

cm1e_error_t cm1e_output_open(cm1e_output_t *output, const char *path, cm1e_diag_t *diag)
{
    static const char suffix[] = ".XXXXXX";
    struct stat present;
    bool there;
    *output = (cm1e_output_t){0};
    if (!path || !path[0] || strlen(path) >= PATH_MAX)
        return cm1e_diag_set(diag, CM1E_ERROR_INVALID_ARGUMENT, 0, "The name of the file is missing or too long.");
    if (find_place(output, path, &present, &there)) {
        const bool direct = there && !S_ISREG(present.st_mode);
        output->temporary = direct ? NULL : malloc(strlen(output->path) + sizeof suffix);
        if (direct)
            output->file = fopen(output->path, "wb");
        else if (output->temporary)
            output->file = create_beside(strcat(strcpy(output->temporary, output->path), suffix),
                                         there ? &present : NULL);
    }
    if (output->file)
        return CM1E_OK;
    const int error = errno;
    forget(output);
    return cannot_write(path, error, diag);
}

cm1e_error_t cm1e_output_close(cm1e_output_t *output, cm1e_diag_t *diag)
{
    bool whole = fflush(output->file) == 0 && !ferror(output->file);
    int error = errno;
    if (fclose(output->file) != 0 && whole) {
        whole = false;
        error = errno;
    }
    if (whole && output->temporary && rename(output->temporary, output->path) != 0) {
        whole = false;
        error = errno;
    }
    if (!whole && output->temporary)
        unlink(output->temporary);
    const cm1e_error_t result = whole ? CM1E_OK : cannot_write(output->path, error, diag);
    forget(output);
    return result;
}

/** A device or a pipe is not opened, because its other end would notice. */
cm1e_error_t cm1e_output_check(const char *path, cm1e_diag_t *diag)
{
    cm1e_output_t output;
    struct stat present;
    if (path && stat(path, &present) == 0 && !S_ISREG(present.st_mode) && !S_ISDIR(present.st_mode))
        return access(path, W_OK) == 0 ? CM1E_OK : cannot_write(path, errno, diag);
    const cm1e_error_t error = cm1e_output_open(&output, path, diag);
    if (error != CM1E_OK)
        return error;
    fclose(output.file);
    if (output.temporary) /* none, where a device has taken the place of the file meanwhile */
        unlink(output.temporary);
    forget(&output);
    return CM1E_OK;
}
