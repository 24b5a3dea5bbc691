/**
 * @file files.h
 * Reading and writing whole files for the subcommands that need it.
 */
#ifndef CM1E_TOOLS_FILES_H
#define CM1E_TOOLS_FILES_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "cm1e/generate.h"

typedef struct input {
    uint8_t *bytes; /**< the caller frees it */
    size_t size;
} input_t;

/** Reads a whole file ("-": standard input); false and a complaint: it cannot be read, or is larger than any file that
 *  the library reads. */
bool read_input(const char *path, input_t *input);

/** Writes a whole file ("-": standard output) under a temporary name beside it, then renames: nobody sees half a file.
 *  False and a complaint: it cannot be written. */
bool write_output(const char *path, const void *bytes, size_t size);

/** Prints findings as compilers do, "FILE:LINE: error: text [rule]", and how many there are; or as JSON. Returns the
 *  exit status: EXIT_FAILED where there is an error among them. */
int print_findings(const char *path, const char *format, const cm1e_findings_t *findings, bool json);
/** "error" or "warning". */
const char *finding_severity(const cm1e_finding_t *finding);
/** A JSON array of them; `place` is what their lines are called. */
json_t *findings_as_list(const cm1e_findings_t *findings, const char *place);
/** What print_findings() prints as one JSON object, and its exit status alone. */
json_t *findings_as_json(const char *path, const char *format, const cm1e_findings_t *findings);
int findings_status(const cm1e_findings_t *findings);

#endif
