/**
 * @file esi_read_bench.h
 * A file with every element that the ESI reader knows, changed text by text, and read (Unity). One test program
 * includes it once.
 */
#ifndef CM1E_TEST_ESI_READ_BENCH_H
#define CM1E_TEST_ESI_READ_BENCH_H

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "generate/esi.h"
#include "unity.h"

#define EVERY_ELEMENT CM1E_SOURCE_DIR "/tests/fuzz/seeds/esi/every_element.xml"

static cm1e_description_file_t read;
static cm1e_diag_t diag;
static char *every;           /* the whole file */
static char changed[1 << 16]; /* another version of it */

static char *load(const char *path)
{
    FILE *stream = fopen(path, "rb");
    if (!stream)
        return NULL;
    fseek(stream, 0, SEEK_END);
    const size_t size = (size_t)ftell(stream);
    rewind(stream);
    char *text = malloc(size + 1);
    TEST_ASSERT_NOT_NULL(text);
    TEST_ASSERT_EQUAL(size, fread(text, 1, size, stream));
    text[size] = '\0';
    fclose(stream);
    return text;
}

void setUp(void)
{
    diag = (cm1e_diag_t){0};
    every = load(EVERY_ELEMENT);
    TEST_ASSERT_NOT_NULL(every);
}

void tearDown(void)
{
    cm1e_description_file_free(&read);
    free(every);
    every = NULL;
}

static cm1e_error_t read_bytes(const void *bytes, size_t size)
{
    cm1e_description_file_free(&read);
    diag = (cm1e_diag_t){0};
    return cm1e_esi_read(&read, bytes, size, &diag);
}

static cm1e_error_t read_text(const char *text) { return read_bytes(text, strlen(text)); }

/* The file with one text in the place of another, which must stand there once. */
static inline const char *with(const char *what, const char *instead)
{
    const char *at = strstr(every, what);
    TEST_ASSERT_NOT_NULL_MESSAGE(at, what);
    TEST_ASSERT_NULL_MESSAGE(strstr(at + 1, what), what);
    snprintf(changed, sizeof changed, "%.*s%s%s", (int)(at - every), every, instead, at + strlen(what));
    return changed;
}

/* Line of a text that stands there once. */
static inline unsigned line_of(const char *what)
{
    const char *at = strstr(every, what);
    unsigned line = 1;
    TEST_ASSERT_NOT_NULL_MESSAGE(at, what);
    for (const char *c = every; c < at; c++)
        line += *c == '\n';
    return line;
}

static inline void good(const char *text) { TEST_ASSERT_EQUAL_MESSAGE(CM1E_OK, read_text(text), diag.text); }

/* An error in that line, with these words. */
static inline void bad(const char *text, unsigned line, const char *words)
{
    char beginning[64];
    snprintf(beginning, sizeof beginning, "line %u: ", line);
    TEST_ASSERT_EQUAL_MESSAGE(CM1E_ERROR_FILE, read_text(text), words);
    TEST_ASSERT_EQUAL(CM1E_ERROR_FILE, diag.error);
    TEST_ASSERT_EQUAL_STRING_LEN_MESSAGE(beginning, diag.text, strlen(beginning), diag.text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(diag.text, words), diag.text);
}

#endif
