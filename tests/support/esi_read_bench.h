/**
 * @file esi_read_bench.h
 * A file with every element that the ESI reader knows, changed text by text, and read (Unity).
 */
#ifndef CM1E_TEST_ESI_READ_BENCH_H
#define CM1E_TEST_ESI_READ_BENCH_H

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "generate/esi.h"
#include "unity.h"

extern cm1e_description_file_t parsed;
extern cm1e_diag_t diag;
extern char *every;           /* the whole file */
extern char changed[1 << 16]; /* another version of it */

char *load(const char *path);
cm1e_error_t read_bytes(const void *bytes, size_t size);
cm1e_error_t read_text(const char *text);

/* The file with one text in the place of another, which must stand there once. */
const char *with(const char *what, const char *instead);

/* Line of a text that stands there once. */
unsigned line_of(const char *what);
void good(const char *text);

/* An error in that line, with these words. */
void bad(const char *text, unsigned line, const char *words);

#endif
