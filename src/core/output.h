/**
 * @file output.h
 * Writes a file so that no reader sees it incomplete: it is made beside its place under a unique name, and renamed when
 * it is complete. An existing file keeps its rights, and a link to it stays a link; a link that leads to nothing is
 * replaced. A device or a pipe is written directly.
 */
#ifndef CM1E_CORE_OUTPUT_H
#define CM1E_CORE_OUTPUT_H

#include <stdio.h>

#include "cm1e/error.h"

typedef struct cm1e_output {
    FILE *file;              /**< to write to */
    char *path, *temporary;  /**< owned; `temporary` NULL: a device or a pipe */
} cm1e_output_t;

/** CM1E_ERROR_IO: `path` cannot be written, `diag` says why; CM1E_ERROR_INVALID_ARGUMENT: it is NULL, "" or too long.
 *  After an error nothing must be closed. @rt block */
cm1e_error_t cm1e_output_open(cm1e_output_t *output, const char *path, cm1e_diag_t *diag);
/** Puts the file in its place. CM1E_ERROR_IO: the data is incomplete, and the earlier file stays. @rt block */
cm1e_error_t cm1e_output_close(cm1e_output_t *output, cm1e_diag_t *diag);
/** Returns the error that cm1e_output_open() would return; leaves no file behind. @rt block */
cm1e_error_t cm1e_output_check(const char *path, cm1e_diag_t *diag);

#endif
