/**
 * @file generate_options.h
 * The options of a program in the sizes that the library has. Private to this room.
 */
#ifndef CM1E_GENERATE_OPTIONS_H
#define CM1E_GENERATE_OPTIONS_H

#include "cm1e/generate.h"

typedef cm1e_error_t cm1e_generator_t(cm1e_file_t *file, const cm1e_generate_options_t *options, cm1e_diag_t *diag);

/** Calls a generator with options of the library's sizes. */
cm1e_error_t cm1e_generate_with(cm1e_generator_t *generator, cm1e_file_t *file, const cm1e_generate_options_t *options,
                                size_t size, size_t device_size, cm1e_diag_t *diag);

#endif
