/**
 * @file seeds.h
 * Which seeds a random test runs. CM1E_TEST_SEED=<n> in the environment repeats one run, CM1E_TEST_SEEDS=<count> as many
 * from there on (from 1 without CM1E_TEST_SEED). Else a test has seeds of its own, from 1 on.
 */
#ifndef CM1E_TESTS_SEEDS_H
#define CM1E_TESTS_SEEDS_H

#include <stdbool.h>
#include <stdlib.h>

#include "effort.h"

/** The environment says which seeds: what only all seeds together reach is not judged. */
bool seeds_given(void);

/** How many seeds there are: those of the environment, or `all`. */
int seeds_of(int all);

/** Number of seeds of a long test: as many of its own seeds as the effort allows (effort.h). */
int seed_count(int count);

unsigned seed_of(int run);

#endif
