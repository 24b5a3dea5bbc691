/**
 * @file options.h
 * The options of a program in the sizes that the library has. Private to this room.
 */
#ifndef CM1E_GENERATE_OPTIONS_H
#define CM1E_GENERATE_OPTIONS_H

#include "cm1e/generate.h"

typedef struct cm1e_own_options {
    cm1e_generate_options_t options;
    cm1e_device_options_t *devices;  /**< NULL: those of the program are used */
} cm1e_own_options_t;

/** Returns CM1E_ERROR_NO_MEMORY, or CM1E_OK; free the options then. */
cm1e_error_t cm1e_own_options_take(cm1e_own_options_t *own, const cm1e_generate_options_t *options, size_t size,
                                   size_t device_size, cm1e_diag_t *diag);
void cm1e_own_options_free(cm1e_own_options_t *own);

#endif
