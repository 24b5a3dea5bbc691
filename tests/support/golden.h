/**
 * @file golden.h
 * Comparison of a generated file with the one in tests/golden/ (Unity). CM1E_GOLDEN_UPDATE=1 in the environment
 * rewrites the files instead: look at the difference before you commit it.
 */
#ifndef CM1E_TEST_GOLDEN_H
#define CM1E_TEST_GOLDEN_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unity.h"

/* The number of the first line that is not the same, or 0. */
unsigned golden_differing_line(const char *a, size_t a_size, const char *b, size_t b_size);

void golden_compare(const char *name, const void *bytes, size_t size);

#endif
