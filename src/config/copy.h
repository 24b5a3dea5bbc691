/**
 * @file copy.h
 * Copies of configurations, also between a program and a library that know different members of them.
 */
#ifndef CM1E_CONFIG_COPY_H
#define CM1E_CONFIG_COPY_H

#include "cm1e/config.h"

/** A copy with the library's sizes and with axes and slaves of its own: cm1e_bus_config_free(). Whatever was in `to` is
 *  overwritten, but only if the copy succeeds. CM1E_ERROR_CONFIG: `from` has too many axes or slaves, or not those it
 *  counts; or it has slaves and `to` is too old to have any. */
cm1e_error_t cm1e_config_copy(cm1e_bus_config_t *to, const cm1e_bus_config_t *from);
/** Copies a configuration into one with the sizes of the program that gets it. */
cm1e_error_t cm1e_config_copy_sized(cm1e_bus_config_t *to, size_t size, size_t axis_size,
                                    const cm1e_bus_config_t *from);

#endif
