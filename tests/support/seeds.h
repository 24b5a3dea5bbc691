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
static inline bool seeds_given(void) { return getenv("CM1E_TEST_SEED") || getenv("CM1E_TEST_SEEDS"); }

/** How many seeds there are: those of the environment, or `all`. */
static inline int seeds_of(int all)
{
    const char *count = getenv("CM1E_TEST_SEEDS");
    return count ? atoi(count) : getenv("CM1E_TEST_SEED") ? 1 : all;
}

/** Number of seeds of a long test: as many of its own seeds as the effort allows (effort.h). */
static inline int seed_count(int count)
{
    const int some = count / slowness();
    return seeds_of(some > 0 ? some : 1);
}

static inline unsigned seed_of(int run)
{
    const char *word = getenv("CM1E_TEST_SEED");
    return (word ? (unsigned)strtoul(word, NULL, 0) : 1u) + (unsigned)run;
}

#endif
