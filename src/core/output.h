/**
 * @file output.h
 * A file that nobody ever sees half written: it is made beside its place, under a name that nobody has, and renamed
 * when it is whole. An existing file keeps its rights, a link stays a link; a device or a pipe is written to directly.
 */
#ifndef CM1E_CORE_OUTPUT_H
#define CM1E_CORE_OUTPUT_H

#include <stdio.h>

#include "cm1e/error.h"

typedef struct cm1e_output {
    FILE *file;              /**< to write to */
    char *path, *temporary;  /**< its own; `temporary` NULL: a device or a pipe */
} cm1e_output_t;

/** CM1E_ERROR_IO: `path` cannot be written, `diag` says why; CM1E_ERROR_INVALID_ARGUMENT: it is NULL, "" or
 *  too long. Nothing is to be closed then. @rt block */
cm1e_error_t cm1e_output_open(cm1e_output_t *output, const char *path, cm1e_diag_t *diag);
/** Puts the file in its place. CM1E_ERROR_IO: not everything arrived, and what was there before stays. @rt block */
cm1e_error_t cm1e_output_close(cm1e_output_t *output, cm1e_diag_t *diag);
/** What cm1e_output_open() would say; leaves nothing behind. @rt block */
cm1e_error_t cm1e_output_check(const char *path, cm1e_diag_t *diag);

#endif
