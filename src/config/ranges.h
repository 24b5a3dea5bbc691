/**
 * @file ranges.h
 * Shared declarations of the check; private to this room.
 */
#ifndef CM1E_CONFIG_RANGES_H
#define CM1E_CONFIG_RANGES_H

#include "config/problem.h"

/* Every check returns false with the problem filled. Paths and key names are those of a bus file; a configuration made
 * by hand has the same names in other places. */
typedef struct check {
    const cm1e_bus_config_t *config;
    cm1e_config_problem_t *problem;
    const cm1e_axis_config_t *axis; /* the axis being checked */
    uint32_t index;
    double counts_per_unit;
    double most_velocity; /* counts/s of the axis */
    char name[CM1E_NAME_LENGTH + 8];
} check_t;

/** Returns false, with the fault in the problem, after the names of axis and key. */
__attribute__((format(printf, 3, 4)))
bool cm1e_config_axis_wrong(const check_t *check, const char *key, const char *format, ...);
#define axis_wrong cm1e_config_axis_wrong

/** Checks that a virtual axis or an encoder has no keys of a motor. */
bool cm1e_config_check_without_motor(const check_t *check);

#endif
