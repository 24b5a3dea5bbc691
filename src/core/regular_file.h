/**
 * @file regular_file.h
 * Opens files that are read whole: a device is no such file, and opening a FIFO that nobody writes to would wait for
 * ever.
 */
#ifndef CM1E_CORE_REGULAR_FILE_H
#define CM1E_CORE_REGULAR_FILE_H

#include <stddef.h>

#include "cm1e/error.h"
#include "core/guest_api.h"

/** Opens a regular file for reading. Errors: CM1E_ERROR_NOT_FOUND, CM1E_ERROR_PERMISSION, CM1E_ERROR_IO; `why` gets
 *  what is wrong, as "is a folder", and *file is -1. @rt block */
CM1E_GUEST_API cm1e_error_t cm1e_regular_file_open(const char *path, int *file, char *why, size_t size);
/** The error for a number of the operating system, and its sentence. @rt block */
CM1E_GUEST_API cm1e_error_t cm1e_regular_file_error(int number, char *why, size_t size);

#endif
