#include "core/regular_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

cm1e_error_t cm1e_regular_file_error(int number, char *why, size_t size)
{
    snprintf(why, size, "cannot be read: %s", strerror(number));
    return number == ENOENT || number == ENOTDIR ? CM1E_ERROR_NOT_FOUND
           : number == EACCES || number == EPERM ? CM1E_ERROR_PERMISSION
                                                 : CM1E_ERROR_IO;
}

cm1e_error_t cm1e_regular_file_open(const char *path, int *file, char *why, size_t size)
{
    struct stat about;
    cm1e_error_t error = CM1E_OK;
    *file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (*file < 0)
        return cm1e_regular_file_error(errno, why, size);
    if (fstat(*file, &about) != 0) {
        error = cm1e_regular_file_error(errno, why, size);
    } else if (!S_ISREG(about.st_mode)) {
        snprintf(why, size, "is %s", S_ISDIR(about.st_mode) ? "a folder" : "not a regular file");
        error = CM1E_ERROR_IO;
    }
    if (error == CM1E_OK)
        return CM1E_OK;
    close(*file);
    *file = -1;
    return error;
}
