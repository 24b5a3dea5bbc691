/**
 * @file problem.h
 * A fault of a configuration, found by its check or by the reader of a bus file.
 */
#ifndef CM1E_CONFIG_PROBLEM_H
#define CM1E_CONFIG_PROBLEM_H

#include <stdbool.h>
#include <stddef.h>

#include "cm1e/config.h"

/** The fault and its place: line and column if they are known, otherwise the path of a key. */
typedef struct cm1e_config_problem {
    size_t line, column; /**< 1 ...; line 0: not known */
    char path[96];       /**< "axes[0].limits.velocity"; "": the configuration as a whole */
    char text[480];
    bool no_memory;      /**< nothing is wrong with the configuration: there was no memory to load it */
} cm1e_config_problem_t;

enum { CM1E_CAM_POINTS_MINIMUM = 2, CM1E_CAM_POINTS_MAXIMUM = 4096 };

/** Checks ranges and contradictions. Returns true if there is no fault. After false the problem has a path, but no
 *  line. */
bool cm1e_config_find_problem(const cm1e_bus_config_t *config, cm1e_config_problem_t *problem);

#endif
